//! Exploration that covers a world: towards what was tried least.

use alloc::vec::Vec;

use super::table::Width;
use crate::q::least;

/// How far each action is from what was tried least:
/// [`Exploration::Coverage`](super::Exploration::Coverage).
///
/// The numbers are those of the world alone: what an automaton state makes of a step is no reason to go
/// there again. It is empty, and costs nothing, where exploration is random.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Coverage {
    /// u, indexed `s * actions + a`.
    distance: Vec<u32>,
}

impl Coverage {
    #[inline]
    pub(super) fn new(states: usize, actions: usize) -> Self {
        Self { distance: alloc::vec![0; states * actions] }
    }

    /// As it was saved.
    #[inline]
    pub(super) const fn of(distance: Vec<u32>) -> Self {
        Self { distance }
    }

    /// The numbers, to be saved.
    #[inline]
    pub(super) fn distances(&self) -> &[u32] {
        &self.distance
    }

    /// The action to take in `s`; the number of actions is given, for it may be known.
    #[inline(always)]
    pub(super) fn act(&self, s: usize, width: impl Width) -> usize {
        self.least(s, width).0
    }

    /// Action `a` led from `s` to `to`, or to the end of the episode.
    ///
    /// Where an episode is over, what lies behind is not nearer: without this, a trap, whose own actions
    /// are never tried, would attract every episode.
    #[inline(always)]
    pub(super) fn learn(
        &mut self,
        (s, a): (usize, usize),
        to: usize,
        over: bool,
        width: impl Width,
    ) {
        let at = s * width.get() + a;
        let least = if over { self.distance[at] } else { self.least(to, width).1 };
        self.distance[at] = least.saturating_add(1);
    }

    #[inline(always)]
    fn least(&self, s: usize, width: impl Width) -> (usize, u32) {
        least(&self.distance[s * width.get()..][..width.get()])
    }
}
