//! What a policy is worth against the best possible.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::{Outcome, Problem};
use crate::q::QTable;

/// What a certificate rests on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Kind {
    /// The world's model, solved.
    #[default]
    Exact,
}

/// What a policy is worth against the best possible: exact means over the starts, `s_0` read.
///
/// For a world without a model there is [`Estimate`](crate::estimate::Estimate).
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Certificate {
    /// What it rests on.
    #[cfg_attr(feature = "serde", serde(default))]
    pub kind: Kind,
    /// P(satisfied) of the policy.
    pub satisfied: f64,
    /// E\[steps\] of the policy, given success; `None` if it never succeeds.
    pub steps: Option<f64>,
    /// The largest possible P(satisfied).
    pub optimal_satisfied: f64,
    /// The smallest possible E\[steps\] among the policies of that P; `None` if that is 0.
    pub optimal_steps: Option<f64>,
    /// `optimal_satisfied - satisfied`.
    pub regret_satisfied: f64,
    /// `steps / optimal_steps - 1`; it can be negative where P is smaller than possible.
    pub regret_steps: Option<f64>,
    /// The largest regret in P(satisfied) of a single start: 0 if the policy is as safe as can be
    /// from everywhere.
    pub worst_regret_satisfied: f64,
    /// The fraction of pairs of a live q and a state in which the policy's action is optimal for
    /// the reward it was trained on, within 1e-6.
    pub fraction_optimal: f64,
}

/// What a policy is worth from one start, `s_0` read.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Start {
    /// The state's number.
    pub state: usize,
    /// P(satisfied).
    pub satisfied: f64,
    /// E\[steps\] given success; `None` if it never succeeds.
    pub steps: Option<f64>,
    /// The largest possible P(satisfied).
    pub optimal_satisfied: f64,
    /// The smallest possible E\[steps\] among the policies of that P.
    pub optimal_steps: Option<f64>,
}

/// A pair in which a policy's action is not optimal for a reward.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Mistake {
    /// The automaton state.
    pub q: u32,
    /// The state's number.
    pub state: usize,
    /// The policy's action.
    pub action: u32,
    /// The best action.
    pub best: u32,
    /// By how much the value of the best action is larger.
    pub loss: f64,
}

impl Problem<'_> {
    /// What `policy` is worth; `q_star` are the optimal values for the reward it was trained on.
    ///
    /// # Panics
    /// If the policy or the values are not of this problem.
    #[must_use]
    pub fn certify(&self, policy: &[u32], q_star: &QTable) -> Certificate {
        self.certify_against(policy, q_star, &self.best())
    }

    /// The same where the [best](Self::best) is known already, as for many policies of one problem.
    ///
    /// # Panics
    /// As [`Self::certify`].
    #[must_use]
    pub fn certify_against(&self, policy: &[u32], q_star: &QTable, best: &Outcome) -> Certificate {
        let own = self.evaluate(policy);
        let (satisfied, steps) = self.mean(&own);
        let (optimal_satisfied, optimal_steps) = self.mean(best);
        let ratio = if steps > 0.0 { steps / optimal_steps - 1.0 } else { 0.0 };
        Certificate {
            kind: Kind::Exact,
            satisfied,
            steps: finite(steps),
            optimal_satisfied,
            optimal_steps: finite(optimal_steps),
            regret_satisfied: optimal_satisfied - satisfied,
            regret_steps: finite(steps).and(finite(ratio)),
            worst_regret_satisfied: self.worst_regret(&own, best),
            fraction_optimal: self.fraction_optimal(policy, q_star, 1e-6),
        }
    }

    /// What `policy` is worth from each state in which an episode can start.
    ///
    /// # Panics
    /// If the policy is not one of this problem.
    #[must_use]
    pub fn starts(&self, policy: &[u32], best: &Outcome) -> Vec<Start> {
        let own = self.evaluate(policy);
        let mut starts = Vec::new();
        for (state, pair) in self.start_pairs() {
            starts.push(Start {
                state,
                satisfied: own.satisfied[pair],
                steps: finite(own.steps[pair]),
                optimal_satisfied: best.satisfied[pair],
                optimal_steps: finite(best.steps[pair]),
            });
        }
        starts
    }

    /// The pairs of a live q and a state in which the action of `policy` is worse than the best by
    /// more than `tolerance`, in the order of their index.
    ///
    /// # Panics
    /// If the policy or the values are not of this problem.
    #[must_use]
    pub fn mistakes(&self, policy: &[u32], q_star: &QTable, tolerance: f64) -> Vec<Mistake> {
        let mut mistakes = Vec::new();
        for q in self.labelled.live() {
            for state in 0..self.labelled.states() {
                let action = policy[self.labelled.pair(q, state)];
                let best = q_star.greedy(q, state);
                let row = q_star.row(q, state);
                let loss = row[best as usize] - row[action as usize];
                if loss > tolerance {
                    mistakes.push(Mistake { q, state, action, best, loss });
                }
            }
        }
        mistakes
    }

    /// Means over the starts, `s_0` read: P(satisfied), and E\[steps\] given success (infinite if
    /// that is impossible).
    #[must_use]
    pub fn mean(&self, outcome: &Outcome) -> (f64, f64) {
        let (mut satisfied, mut weighted) = (0.0, 0.0);
        for (s, pair) in self.start_pairs() {
            let p = self.dynamics.starts()[s] * outcome.satisfied[pair];
            if p > 0.0 {
                satisfied += p;
                weighted += p * outcome.steps[pair];
            }
        }
        (satisfied, if satisfied > 0.0 { weighted / satisfied } else { f64::INFINITY })
    }

    /// The mean of `values`, one for each pair, over the starts, `s_0` read.
    ///
    /// # Panics
    /// Unless there is one for each pair.
    #[must_use]
    pub fn mean_of(&self, values: &[f64]) -> f64 {
        assert_eq!(values.len(), self.labelled.pairs(), "a value for each (q, s)");
        self.start_pairs().map(|(s, pair)| self.dynamics.starts()[s] * values[pair]).sum()
    }

    /// The fraction of pairs of a live q and a state in which the action of `policy` is within
    /// `tolerance` of the best value.
    #[must_use]
    pub fn fraction_optimal(&self, policy: &[u32], q_star: &QTable, tolerance: f64) -> f64 {
        let live: Vec<u32> = self.labelled.live().collect();
        self.fraction_optimal_at(&live, policy, q_star, tolerance)
    }

    /// The same over the automaton states `at`; 1 if there are none.
    #[must_use]
    pub fn fraction_optimal_at(
        &self,
        at: &[u32],
        policy: &[u32],
        q_star: &QTable,
        tolerance: f64,
    ) -> f64 {
        let (states, mut optimal) = (self.labelled.states(), 0);
        for &q in at {
            for s in 0..states {
                let chosen = q_star.row(q, s)[policy[self.labelled.pair(q, s)] as usize];
                optimal += usize::from(chosen >= q_star.max(q, s) - tolerance);
            }
        }
        if at.is_empty() { 1.0 } else { optimal as f64 / (at.len() * states) as f64 }
    }

    fn worst_regret(&self, own: &Outcome, best: &Outcome) -> f64 {
        let mut worst: f64 = 0.0;
        for (_, pair) in self.start_pairs() {
            worst = worst.max(best.satisfied[pair] - own.satisfied[pair]);
        }
        worst
    }

    /// The states in which an episode can start, with their pairs once they are read.
    fn start_pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let starts = self.dynamics.starts().iter().enumerate().filter(|&(_, &weight)| weight > 0.0);
        starts.map(|(s, _)| (s, self.labelled.pair(self.labelled.start(s), s)))
    }
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
