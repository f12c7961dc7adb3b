//! One step ahead in what was seen: a test on counts.

use alloc::vec::Vec;

use crate::augmented::Labelled;
use crate::reward::End;

/// How often each action was tried, and how often it entered the trap.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Indexed `s * actions + a`: a step in the world does not depend on q.
    tried: Vec<u64>,
    /// Indexed `(q * states + s) * actions + a`.
    lost: Vec<u64>,
}

impl Counts {
    #[inline]
    pub(super) fn new(task: &Labelled) -> Self {
        let size = |rows: usize| alloc::vec![0; rows * task.actions()];
        Self { tried: size(task.states()), lost: size(task.pairs()) }
    }

    /// Adds steps from `s` to `to` under `a`, at every automaton state.
    #[inline]
    pub(super) fn add(&mut self, task: &Labelled, (s, a, to): (usize, usize, usize), times: u64) {
        self.tried[s * task.actions() + a] += times;
        for q in task.live() {
            if task.end(task.next(q, to)) == Some(End::Lost) {
                self.lost[task.pair(q, s) * task.actions() + a] += times;
            }
        }
    }

    /// Whether `a` entered the trap no more often than the best of the others, by twice the standard
    /// error.
    #[inline]
    pub(super) fn allows(&self, task: &Labelled, (q, s): (u32, usize), a: usize) -> bool {
        let risks = (0..task.actions()).map(|a| self.risk(task, (q, s), a).0);
        let least = risks.fold(f64::INFINITY, f64::min);
        let (risk, variance) = self.risk(task, (q, s), a);
        let more = risk - least;
        more * more <= 4.0 * variance
    }

    /// How often the action entered the trap as a fraction of its tries, and the variance of that
    /// fraction. One try of each kind is assumed beside (Laplace's rule of succession), so that one
    /// accident bars nothing and an action without tries is not thought safe.
    #[inline]
    fn risk(&self, task: &Labelled, (q, s): (u32, usize), a: usize) -> (f64, f64) {
        let lost = self.lost[task.pair(q, s) * task.actions() + a] as f64;
        let tried = self.tried[s * task.actions() + a] as f64;
        let p = (lost + 1.0) / (tried + 2.0);
        (p, p * (1.0 - p) / (tried + 2.0))
    }
}
