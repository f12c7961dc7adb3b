//! What moves of the automaton pay, and where they end the task.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::learn::episode::Move;
use crate::monitor::{Acceptor, Monitor};
use crate::task::Error;

/// What a move of the automaton pays.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase", deny_unknown_fields))]
pub enum Reward {
    /// 1 if the move leaves q, neither by a self-loop nor into the trap (the intent of the paper's
    /// Eq. 3A3).
    #[default]
    Progress,
    /// 1 if the move leaves q, the trap included (Eq. 3A3 to the letter). Unsafe: it pays for
    /// losing. Kept to reproduce the paper.
    Literal,
    /// 1 on entering the accepting state.
    Acceptance,
    /// ρ(s', D_φ^q), clamped to `[-bound, bound]`.
    Robustness {
        /// The largest reward or punishment of one step; see [`Reward::ROBUSTNESS`].
        bound: f64,
    },
    /// `Acceptance` plus γΦ(q') − Φ(q), where Φ falls evenly from nearly 1 beside the accepting
    /// state to nearly 0 at the state farthest from it, and is 0 at terminal states. It leaves the
    /// optimal policies of `Acceptance` unchanged (Ng et al. 1999).
    Shaped,
}

impl Reward {
    /// Robustness with the default bound, 1.
    pub const ROBUSTNESS: Self = Self::Robustness { bound: 1.0 };
}

/// The reward of the augmented MDP: a mode, and what is added to it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Rewards {
    /// What a move of the automaton pays.
    pub mode: Reward,
    /// Subtracted on entering the trap.
    pub trap_penalty: f64,
    /// Subtracted at every step.
    pub step_penalty: f64,
    /// How much of the environment's own reward (a cost of failed actions, say) is added. Solvers
    /// leave it out: models have no rewards of their own.
    pub environment: f64,
}

impl Rewards {
    /// `mode` alone.
    #[must_use]
    pub const fn of(mode: Reward) -> Self {
        Self { mode, trap_penalty: 0.0, step_penalty: 0.0, environment: 0.0 }
    }

    /// What the move from `q` to `to` pays, where `robustness` gives ρ(s', D_φ^q).
    pub(super) fn pays(&self, ends: &Ends, q: u32, to: u32, gamma: f64, robustness: f64) -> f64 {
        let entered = |end| ends.of(q).is_none() && ends.of(to) == Some(end);
        let lost = entered(End::Lost);
        let accepted = f64::from(u8::from(entered(End::Accepted)));
        let paid = match self.mode {
            Reward::Progress => f64::from(u8::from(q != to && !lost)),
            Reward::Literal => f64::from(u8::from(q != to)),
            Reward::Acceptance => accepted,
            Reward::Robustness { bound } => robustness.clamp(-bound, bound),
            Reward::Shaped => accepted + gamma * ends.potential(to) - ends.potential(q),
        };
        paid - self.step_penalty - if lost { self.trap_penalty } else { 0.0 }
    }

    /// Whether the reward needs ρ(s', D_φ^q), which depends on more than the class of s'.
    pub(super) const fn needs_robustness(&self) -> bool {
        matches!(self.mode, Reward::Robustness { .. })
    }
}

/// How an episode ended for the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The task is satisfied.
    Accepted,
    /// The task can never be satisfied any more.
    Lost,
}

/// Where episodes end, and how far each automaton state is from acceptance.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Ends {
    pub(super) of: Vec<Option<End>>,
    pub(super) distance: Vec<Option<u32>>,
    pub(super) farthest: u32,
}

impl Ends {
    pub(super) fn new(task: &(impl Acceptor + ?Sized)) -> Self {
        let end = |q| match (task.is_accepting(q), task.is_trap(q)) {
            (true, _) => Some(End::Accepted),
            (_, true) => Some(End::Lost),
            _ => None,
        };
        let states = 0..task.states();
        let distance = states.clone().map(|q| task.distance(q)).collect();
        Self::at(states.map(end).collect(), distance)
    }

    /// These ends, at these distances from acceptance.
    pub(super) fn at(of: Vec<Option<End>>, distance: Vec<Option<u32>>) -> Self {
        let farthest = distance.iter().copied().flatten().max().unwrap_or(0);
        Self { of, distance, farthest }
    }

    #[inline]
    pub(super) fn of(&self, q: u32) -> Option<End> {
        self.of[q as usize]
    }

    /// The potential Φ of `Shaped`.
    fn potential(&self, q: u32) -> f64 {
        match (self.of(q), self.distance[q as usize]) {
            (None, Some(distance)) => 1.0 - f64::from(distance) / f64::from(self.farthest + 1),
            _ => 0.0,
        }
    }
}

/// What the moves of one task pay, and where they end it.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    ends: Ends,
    pub(super) rewards: Rewards,
    gamma: f64,
}

impl Moves {
    pub(crate) fn new(task: &(impl Acceptor + ?Sized), rewards: Rewards, gamma: f64) -> Self {
        Self { ends: Ends::new(task), rewards, gamma }
    }

    /// How the task has ended at `q`, if it has.
    pub(crate) fn end(&self, q: u32) -> Option<End> {
        self.ends.of(q)
    }

    /// The automaton states in which the task goes on.
    #[cfg(feature = "deep")]
    pub(crate) fn live(&self) -> impl Iterator<Item = u32> {
        (0..self.ends.of.len() as u32).filter(|&q| self.end(q).is_none())
    }

    /// For each automaton state the most that can be had from there on, the environment's own
    /// rewards left aside: the optimum if every state of the world could be chosen at every step.
    /// 0 where the task has ended.
    #[cfg(feature = "deep")]
    pub(crate) fn most(&self, task: &(impl Acceptor + ?Sized)) -> Vec<f64> {
        let mut most = alloc::vec![0.0; self.ends.of.len()];
        let pays = |q, to| match self.rewards.mode {
            Reward::Robustness { bound } => self.rewards.pays(&self.ends, q, to, self.gamma, bound),
            _ => self.rewards.pays(&self.ends, q, to, self.gamma, 0.0),
        };
        // Value iteration; the error falls by γ each time.
        loop {
            let mut change: f64 = 0.0;
            for q in self.live() {
                let mut best = f64::NEG_INFINITY;
                task.successors(q, &mut |to| {
                    best = best.max(pays(q, to) + self.gamma * most[to as usize]);
                });
                change = change.max((best - most[q as usize]).abs());
                most[q as usize] = best;
            }
            if change < 1e-9 {
                return most;
            }
        }
    }

    /// What reading `s` does at `q`.
    pub(crate) fn read<S: ?Sized>(
        &self,
        monitor: &(impl Monitor<S> + ?Sized),
        q: u32,
        s: &S,
    ) -> Result<Move, Error> {
        let robustness =
            if self.rewards.needs_robustness() { monitor.progress_robustness(q, s)? } else { 0.0 };
        let to = monitor.next(q, s)?;
        let paid = self.rewards.pays(&self.ends, q, to, self.gamma, robustness);
        Ok(Move { to, paid, over: self.end(to).is_some() })
    }
}
