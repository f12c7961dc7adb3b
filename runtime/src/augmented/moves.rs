//! What a step does at any automaton state, for worlds whose states have no numbers.
//!
//! [`Augmented`](super::Augmented) and the deep learner read states by the task's own predicates;
//! finite worlds read [tables](super::Labelled). Both pay by
//! [`Rewards::pay`](crate::reward::Rewards::pay), so they pay alike.

use crate::env::Step;
use crate::episode::Move;
use crate::monitor::{Acceptor, Monitor};
use crate::reward::{Arrival, Ends, Rewards};
use crate::task::Error;

/// The rewards of one task, with what they need to know of it.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    ends: Ends,
    rewards: Rewards,
}

impl Moves {
    pub(crate) fn new(task: &(impl Acceptor + ?Sized), rewards: Rewards) -> Self {
        Self { ends: Ends::of(task), rewards }
    }

    #[inline]
    pub(crate) const fn ends(&self) -> &Ends {
        &self.ends
    }

    /// What reading the state of `step` does at `q`, and what that pays. The robustness of progress
    /// is evaluated only where the mode of reward asks for it: it costs as much as the move itself.
    pub(crate) fn read<S>(
        &self,
        monitor: &(impl Monitor<S> + ?Sized),
        q: u32,
        step: &Step<S>,
    ) -> Result<Move, Error> {
        let needed = self.rewards.needs_robustness();
        let robustness = if needed { monitor.progress_robustness(q, &step.state)? } else { 0.0 };
        let to = monitor.next(q, &step.state)?;
        let (reward, terminated) = (step.reward, step.terminated);
        let arrival = Arrival { q, to, robustness, reward, terminated };
        let over = terminated || self.ends.end(to).is_some();
        Ok(Move { to, reward: self.rewards.pay(&self.ends, &arrival), over })
    }

    /// For each automaton state the most that can be had from there on, the environment's own
    /// rewards left aside: the optimum if every state of the world could be chosen at every step.
    /// 0 where the task has ended.
    ///
    /// Networks clamp their bootstrapped values to it: no true value is larger, and an error that
    /// would raise one cannot feed on itself.
    ///
    /// It is value iteration on the automaton alone, |Q| numbers; with γ 0.97 it takes about 700
    /// rounds, once for a learner.
    #[cfg(feature = "deep")]
    pub(crate) fn most(&self, task: &(impl Acceptor + ?Sized)) -> alloc::vec::Vec<f64> {
        let mut most = alloc::vec![0.0; self.ends.states() as usize];
        let robustness = self.rewards.bound();
        let pays = |q, to| {
            let arrival = Arrival { robustness, ..Arrival::at(q, to) };
            self.rewards.pay_for_move(&self.ends, &arrival)
        };
        // Value iteration on the automaton alone; the error falls by γ each time.
        loop {
            let mut change: f64 = 0.0;
            for q in self.ends.live() {
                let mut best = f64::NEG_INFINITY;
                task.successors(q, &mut |to| {
                    best = best.max(pays(q, to) + self.rewards.gamma() * most[to as usize]);
                });
                change = change.max((best - most[q as usize]).abs());
                most[q as usize] = best;
            }
            if change < 1e-9 {
                return most;
            }
        }
    }
}
