//! Trajectories that are still being read: one state at a time, in memory that does not grow with
//! them unless the [robustness](crate::online) needs it.

use std::convert::Infallible;

use tltl::automaton::Automaton;
use tltl::robustness;

use super::Verdict;
use super::run::verdict;

/// An automaton on its way through a trajectory.
///
/// [`Task::run`](super::Task::run) reads a whole trajectory at once and gives the same rows.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::task::{Running, Verdict, compile};
///
/// let task = compile("a T b", Budget::default())?;
/// let mut running = Running::new(task.automaton());
/// running.step(&[true, false], &[1.0, -0.5]);
/// assert_eq!((running.state(), running.verdict(), running.since()), (1, Verdict::Open, Some(0)));
/// assert_eq!(running.step(&[false, true], &[-1.0, 0.25]), 0.25);
/// assert_eq!((running.rows(), running.verdict(), running.since()), (2, Verdict::Satisfied, Some(1)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Running<'a> {
    automaton: &'a Automaton,
    q: u32,
    rows: usize,
    since: usize,
}

impl<'a> Running<'a> {
    /// The automaton before the first state.
    #[must_use]
    pub fn new(automaton: &'a Automaton) -> Self {
        Self { automaton, q: Automaton::INITIAL, rows: 0, since: 0 }
    }

    /// Reads one state: which propositions hold, and their robustness. Returns ρ(s, D_φ^q) of the
    /// automaton state before it: positive if the automaton moves on, and -∞ where the verdict was
    /// final.
    ///
    /// # Panics
    /// If a proposition of the automaton has no entry.
    pub fn step(&mut self, labels: &[bool], rho: &[f64]) -> f64 {
        let before = self.verdict();
        let progress = robustness::guard(self.automaton.progress(self.q), |i| rho[i]);
        let Ok(q) = self.automaton.next(self.q, |i| Ok::<_, Infallible>(labels[i]));
        self.q = q;
        if self.verdict() != before {
            self.since = self.rows;
        }
        self.rows += 1;
        progress
    }

    /// The automaton's state now.
    #[must_use]
    pub fn state(&self) -> u32 {
        self.q
    }

    /// The number of states that were read.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// The verdict on what was read; [open](Verdict::Open) before the first state.
    #[must_use]
    pub fn verdict(&self) -> Verdict {
        if self.rows == 0 { Verdict::Open } else { verdict(self.automaton, self.q) }
    }

    /// The first row, from 0, after which the verdict was what it is now; `None` before the first.
    #[must_use]
    pub fn since(&self) -> Option<usize> {
        (self.rows > 0).then_some(self.since)
    }
}
