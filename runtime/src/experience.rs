//! What was seen of a world: a replay log that does not grow with its length.
//!
//! Replay of a tabular log needs no order, only counts; so the log of a million steps on the paper's
//! grid is 1,200 counts. Solving the counted world gives at once what endless replay of the log would
//! converge to.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::mismatch::{self, Mismatch};
use crate::model::FiniteModel;

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
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Experience {
    actions: usize,
    /// The outcomes of each `s * actions + a`.
    outcomes: Vec<Vec<(u32, u32)>>,
    starts: Vec<u32>,
}

impl Experience {
    /// No experience of a world of this size.
    #[must_use]
    #[inline]
    pub fn new(states: usize, actions: usize) -> Self {
        let outcomes = alloc::vec![Vec::new(); states * actions];
        Self { actions, outcomes, starts: alloc::vec![0; states] }
    }

    /// Whether all of it is of a world of this size: it may come from a file.
    #[inline]
    pub(crate) fn is_of(&self, states: usize, actions: usize) -> bool {
        let inside = |list: &Vec<(u32, u32)>| list.iter().all(|&(to, _)| (to as usize) < states);
        (self.starts.len(), self.actions) == (states, actions)
            && Some(self.outcomes.len()) == states.checked_mul(actions)
            && self.outcomes.iter().all(inside)
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

    /// A list and not a map: an action has few outcomes, and in the order in which they were seen the most
    /// frequent ones mostly come first.
    #[inline]
    fn add(&mut self, cell: usize, to: u32, times: u32) {
        let list = &mut self.outcomes[cell];
        match list.iter_mut().find(|(seen, _)| *seen == to) {
            Some((_, count)) => *count = count.saturating_add(times),
            None => list.push((to, times)),
        }
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
        let world = |e: &Self| mismatch::world(e.starts.len(), e.actions);
        if world(self) != world(other) {
            return Err(Mismatch::new("experience", world(other), world(self)));
        }
        for (cell, list) in other.outcomes.iter().enumerate() {
            list.iter().for_each(|&(to, times)| self.add(cell, to, times));
        }
        self.starts.iter_mut().zip(&other.starts).for_each(|(n, m)| *n = n.saturating_add(*m));
        Ok(())
    }

    /// How often `a` was tried in `s`.
    #[must_use]
    #[inline]
    pub fn tried(&self, s: usize, a: usize) -> u64 {
        self.outcomes[s * self.actions + a].iter().map(|&(_, times)| u64::from(times)).sum()
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
        let total = self.tried(s, a);
        if total == 0 {
            outcome(s, 1.0);
        }
        for &(to, times) in &self.outcomes[s * self.actions + a] {
            outcome(to as usize, f64::from(times) / total as f64);
        }
    }

    #[inline]
    fn start(&self, s: usize) -> f64 {
        f64::from(self.starts[s])
    }
}
