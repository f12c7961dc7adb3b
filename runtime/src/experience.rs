//! What was seen of a world: a replay log that does not grow with its length.
//!
//! Replay of a tabular log needs no order, only counts; so the log of a million steps on the paper's
//! grid is 1,200 counts. Solving the counted world gives at once what endless replay of the log would
//! converge to. A step with which the environment itself ended the episode is counted apart from
//! one to the same state that went on, for nothing follows it.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::mismatch::{self, Mismatch};
use crate::model::FiniteModel;

/// The outcomes in one block: as many as make it one line of the cache. A grid with slip, which has five
/// outcomes, needs one block for each (s, a).
const SLOTS: usize = 8;

/// No outcome in a slot, no block in a chain.
const NONE: u32 = u32::MAX;

/// The bit of a key that says that the episode ended.
const ENDED: u32 = 1 << 31;

/// Some outcomes of one (s, a), in the order in which they were seen first.
///
/// An outcome is a key: the number of s', and a bit if the environment ended the episode there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(align(64))]
struct Block {
    keys: [u32; SLOTS],
    times: [u32; SLOTS],
}

impl Block {
    const EMPTY: Self = Self { keys: [NONE; SLOTS], times: [0; SLOTS] };

    /// The slot of `key`.
    ///
    /// All slots are compared, for which outcome comes nobody can predict: a search that stops where it
    /// finds one costs a wrong guess of the processor every few steps.
    #[inline(always)]
    fn slot(&self, key: u32) -> Option<usize> {
        let same = self.keys.iter().enumerate().map(|(i, &other)| u32::from(other == key) << i);
        let found = same.fold(0, core::ops::BitOr::bitor);
        (found != 0).then_some(found.trailing_zeros() as usize % SLOTS)
    }
}

/// How often each (s, a, s') and each start was seen.
///
/// ```
/// use tltl::learn::Experience;
/// use tltl::prelude::*;
///
/// let mut seen = Experience::new(3, 2);
/// seen.push_start(0);
/// for to in [1, 1, 2] {
///     seen.push(0, 1, to);
/// }
/// assert_eq!(seen.tried(0, 1), 3);
/// let world = Dynamics::new(&seen)?;
/// assert!(world.outcomes(0, 1).eq([(1, 2.0 / 3.0), (2, 1.0 / 3.0)]));
/// assert!(world.outcomes(0, 0).eq([(0, 1.0)]), "never tried: it stays");
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
///
/// A log of transitions, order forgotten. It names no automaton state: any task can be relabelled
/// onto it, so the experience of one skill serves every other. As a [`FiniteModel`] it is the
/// world with the frequencies as probabilities, and what is [solved](crate::solve::Problem) on it
/// is what endless replay of the log converges to. An action that was never tried in a state
/// counts as staying there.
///
/// Memory: 4 bytes for each (s, a), and 68 for each that was tried, or for each 8 outcomes of it.
#[derive(Clone, Debug)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Saved", into = "Saved"))]
pub struct Experience {
    actions: usize,
    /// The first block of each `s * actions + a`; none where it was never tried.
    first: Vec<u32>,
    blocks: Vec<Block>,
    /// The block with further outcomes of the same (s, a), for each block.
    next: Vec<u32>,
    starts: Vec<u32>,
}

impl Experience {
    /// No experience of a world of this size.
    ///
    /// # Panics
    /// If there are 2^31 states or more.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn new(states: usize, actions: usize) -> Self {
        assert!(states < ENDED as usize, "less than 2^31 states");
        let first = alloc::vec![NONE; states * actions];
        let starts = alloc::vec![0; states];
        Self { actions, first, blocks: Vec::new(), next: Vec::new(), starts }
    }

    /// Whether it is of a world of this size: it may come from a file.
    #[inline]
    pub(crate) fn is_of(&self, states: usize, actions: usize) -> bool {
        (self.starts.len(), self.actions) == (states, actions)
    }

    /// Adds a start in `s`. Counts stay at their largest value when they reach it.
    #[inline]
    pub fn push_start(&mut self, s: usize) {
        self.starts[s] = self.starts[s].saturating_add(1);
    }

    /// Adds a step from `s` to `to` under action `a`.
    #[inline]
    pub fn push(&mut self, s: usize, a: usize, to: usize) {
        self.add(s * self.actions + a, to as u32, 1);
    }

    /// Adds a step from `s` to `to` under action `a` with which the environment ended the episode.
    ///
    /// ```
    /// use tltl::learn::Experience;
    /// use tltl::prelude::*;
    ///
    /// // A step to cell 1 goes on in one of four cases.
    /// let mut seen = Experience::new(2, 1);
    /// seen.push_start(0);
    /// seen.push(0, 0, 1);
    /// (0..3).for_each(|_| seen.push_ending(0, 0, 1));
    /// let world = Dynamics::new(&seen)?;
    /// assert!(world.outcomes(0, 0).eq([(1, 0.25), (1, 0.75)]));
    /// assert!(world.endings(0, 0).eq([(1, 0.75)]));
    /// # Ok::<(), tltl::model::ModelError>(())
    /// ```
    #[inline]
    pub fn push_ending(&mut self, s: usize, a: usize, to: usize) {
        self.add(s * self.actions + a, to as u32 | ENDED, 1);
    }

    /// Blocks and not a map: an action has few outcomes.
    #[inline(always)]
    fn add(&mut self, cell: usize, key: u32, times: u32) {
        let known = self.blocks.get_mut(self.first[cell] as usize);
        let known = known.and_then(|block| Some(&mut block.times[block.slot(key)?]));
        match known {
            Some(count) => *count = count.saturating_add(times),
            None => self.add_apart(cell, key, times),
        }
    }

    /// The same for an outcome that is new, or not in the first block.
    #[cold]
    #[inline]
    fn add_apart(&mut self, cell: usize, key: u32, times: u32) {
        if self.first[cell] == NONE {
            self.first[cell] = self.grow();
        }
        let mut at = self.first[cell] as usize;
        loop {
            let block = &mut self.blocks[at];
            // Slots are filled in order, so that no key stands behind a free one.
            if let Some(slot) = block.slot(key).or_else(|| block.slot(NONE)) {
                block.keys[slot] = key;
                block.times[slot] = block.times[slot].saturating_add(times);
                return;
            }
            if self.next[at] == NONE {
                self.next[at] = self.grow();
            }
            at = self.next[at] as usize;
        }
    }

    /// The number of another block.
    #[inline]
    fn grow(&mut self) -> u32 {
        self.blocks.push(Block::EMPTY);
        self.next.push(NONE);
        (self.blocks.len() - 1) as u32
    }

    /// What `cell` led to, as keys and counts, in the order in which it was first seen.
    #[inline]
    fn seen(&self, cell: usize) -> impl Iterator<Item = (u32, u32)> {
        let known = |at: u32| (at != NONE).then_some(at as usize);
        let chain =
            core::iter::successors(known(self.first[cell]), move |&at| known(self.next[at]));
        let all = chain.flat_map(|at| self.blocks[at].keys.into_iter().zip(self.blocks[at].times));
        all.filter(|&(key, _)| key != NONE)
    }

    /// Adds all of another experience of the same world: that of another learner, say, whatever its
    /// task was.
    ///
    /// ```
    /// use tltl::learn::Experience;
    /// use tltl::prelude::*;
    ///
    /// // Two learners, whatever their tasks, have tried the same action of the same world.
    /// let (mut one, mut other) = (Experience::new(2, 1), Experience::new(2, 1));
    /// one.push_start(0);
    /// one.push(0, 0, 1);
    /// other.push(0, 0, 0);
    /// one.extend(&other)?;
    /// assert!(Dynamics::new(&one)?.outcomes(0, 0).eq([(0, 0.5), (1, 0.5)]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the worlds differ in size.
    #[inline]
    pub fn extend(&mut self, other: &Self) -> Result<(), Mismatch> {
        if !self.is_of(other.starts.len(), other.actions) {
            let world = |e: &Self| mismatch::world(e.starts.len(), e.actions);
            return Err(Mismatch::new("experience", world(other), world(self)));
        }
        for cell in 0..other.first.len() {
            other.seen(cell).for_each(|(key, times)| self.add(cell, key, times));
        }
        self.starts.iter_mut().zip(&other.starts).for_each(|(n, m)| *n = n.saturating_add(*m));
        Ok(())
    }

    /// How often `a` was tried in `s`.
    #[must_use]
    #[inline]
    pub fn tried(&self, s: usize, a: usize) -> u64 {
        self.seen(s * self.actions + a).map(|(_, times)| u64::from(times)).sum()
    }

    /// Calls `outcome(s', p)` for the outcomes that ended the episode, or for the others.
    #[inline]
    fn frequencies(&self, s: usize, a: usize, ended: bool, mut outcome: impl FnMut(usize, f64)) {
        let total = self.tried(s, a) as f64;
        let same = |&(key, _): &(u32, u32)| (key & ENDED != 0) == ended;
        for (key, times) in self.seen(s * self.actions + a).filter(same) {
            outcome((key & !ENDED) as usize, f64::from(times) / total);
        }
    }
}

impl FiniteModel for Experience {
    type State = usize;

    #[inline]
    fn states(&self) -> usize {
        self.starts.len()
    }

    #[inline]
    fn actions(&self) -> usize {
        self.actions
    }

    #[inline]
    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        if self.first[s * self.actions + a] == NONE {
            outcome(s, 1.0);
        }
        self.frequencies(s, a, false, outcome);
    }

    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        self.frequencies(s, a, true, outcome);
    }

    #[inline]
    fn start(&self, s: usize) -> f64 {
        f64::from(self.starts[s])
    }
}

/// Equal are the same counts, seen first in the same order in each (s, a): what was saved and read
/// is equal to what it was, though its blocks stand in another order.
impl PartialEq for Experience {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        (self.actions, &self.starts) == (other.actions, &other.starts)
            && (0..self.first.len()).all(|cell| self.seen(cell).eq(other.seen(cell)))
    }
}

impl Eq for Experience {}

/// Experience as it is saved.
#[cfg(feature = "serde")]
#[derive(Serialize, Deserialize)]
struct Saved {
    actions: usize,
    /// The outcomes (s', times) of each `s * actions + a`, in the order in which they were first seen.
    outcomes: Vec<Vec<(u32, u32)>>,
    starts: Vec<u32>,
    /// Those that ended the episode, as (`s * actions + a`, place in the list); not there in files of
    /// earlier versions.
    #[serde(default)]
    ended: Vec<(usize, usize)>,
}

#[cfg(feature = "serde")]
impl From<Experience> for Saved {
    #[inline]
    fn from(seen: Experience) -> Self {
        let (mut outcomes, mut ended) = (Vec::with_capacity(seen.first.len()), Vec::new());
        for cell in 0..seen.first.len() {
            let keys = || seen.seen(cell).enumerate();
            ended.extend(keys().filter(|(_, (key, _))| key & ENDED != 0).map(|(i, _)| (cell, i)));
            outcomes.push(keys().map(|(_, (key, times))| (key & !ENDED, times)).collect());
        }
        Self { actions: seen.actions, outcomes, starts: seen.starts, ended }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved> for Experience {
    type Error = &'static str;

    #[inline]
    fn try_from(saved: Saved) -> Result<Self, &'static str> {
        let Saved { actions, mut outcomes, starts, ended } = saved;
        let states = starts.len();
        let inside = |list: &Vec<(u32, u32)>| list.iter().all(|&(to, _)| (to as usize) < states);
        let sized = Some(outcomes.len()) == states.checked_mul(actions);
        if !sized || states >= ENDED as usize || !outcomes.iter().all(inside) {
            return Err("the outcomes of an experience are not those of its world");
        }
        for (cell, at) in ended {
            let outcome = outcomes.get_mut(cell).and_then(|list| list.get_mut(at));
            outcome.ok_or("an episode of an experience ends where there is no outcome")?.0 |= ENDED;
        }
        let mut seen = Self { starts, ..Self::new(states, actions) };
        for (cell, list) in outcomes.into_iter().enumerate() {
            list.into_iter().for_each(|(key, times)| seen.add(cell, key, times));
        }
        Ok(seen)
    }
}
