//! Shields: "the behavior of the policy is strictly enforced by the FSA" (paper, Section 3).
//!
//! A [`Shield`] is a mask of actions for each pair (q, s). With a model it leaves only the actions
//! from which the trap is avoided in the long run with the largest possible probability; without
//! one it looks one step ahead in what was seen. It never leaves a pair without actions. What it
//! costs and gains is in [`Problem::certify_shield`].
//!
//! A shield knows the trap, not the goal: where the goal itself lies beside the trap, staying away
//! for ever avoids it best, and the shield may do that. Laid over optimal safe policies of the three
//! compositions with traps in the study of rewards, each on 101 layouts, it gives away more than
//! 0.1 % of P(satisfied) in 58 of 303 cases, 3.6 % in the mean and up to 95 %: look at the
//! certificate before you take one.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::augmented::{End, Labelled};
use crate::learn::Experience;
use crate::model::FiniteModel;
use crate::q::QTable;
use crate::solve::{Actions, Certificate, Problem};

/// Which actions are allowed where.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shield {
    actions: Actions,
    states: usize,
}

/// What a shield does to a policy: means over the starts, `s_0` read.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Shielded {
    /// The policy as it was.
    pub before: Certificate,
    /// The policy under the shield.
    pub after: Certificate,
    /// P(the trap is entered) before.
    pub lost_before: f64,
    /// P(the trap is entered) under the shield.
    pub lost_after: f64,
    /// The smallest possible P(the trap is entered).
    pub smallest_lost: f64,
    /// The fraction of live pairs in which the shield overrules the policy.
    pub overruled: f64,
}

impl Shield {
    /// The shield of a known model: the actions with which P(the trap is ever entered) can still be
    /// the smallest possible, within 1e-9.
    #[must_use]
    pub fn of_model(problem: &Problem<'_>) -> Self {
        let lost = problem.smallest_lost();
        Self { actions: problem.avoiding(&lost), states: problem.labelled().states() }
    }

    /// The shield of what was seen: the actions that entered the trap least often, as a fraction of
    /// the times that they were tried. It looks one step ahead only: it may lead to where every
    /// action is dangerous. An action never tried counts as harmless.
    ///
    /// # Panics
    /// If the experience is of another world.
    #[must_use]
    pub fn one_step(experience: &Experience, task: &Labelled) -> Self {
        assert_eq!(experience.states(), task.states(), "experience of the task's own world");
        let mut actions = Actions::none(task.pairs(), experience.actions());
        for q in task.live() {
            for s in 0..task.states() {
                let risk = |a| {
                    let mut risk = 0.0;
                    experience.transitions(s, a, |to, p| {
                        let lost = task.end(task.next(q, to)) == Some(End::Lost);
                        risk += if lost { p } else { 0.0 };
                    });
                    risk
                };
                let risks: Vec<f64> = (0..experience.actions()).map(risk).collect();
                let least = risks.iter().copied().fold(f64::INFINITY, f64::min);
                for (a, &risk) in risks.iter().enumerate() {
                    if risk <= least {
                        actions.insert(task.pair(q, s), a);
                    }
                }
            }
        }
        Self { actions, states: task.states() }
    }

    /// Whether action `a` is allowed in `s` at a live `q`.
    ///
    /// # Panics
    /// If there is no such pair.
    #[inline]
    #[must_use]
    pub fn allows(&self, q: u32, s: usize, a: usize) -> bool {
        self.actions.contains(q as usize * self.states + s, a)
    }

    /// The allowed action of the largest value; the lowest of equals.
    ///
    /// # Panics
    /// If there is no such pair.
    #[must_use]
    pub fn greedy(&self, table: &QTable, q: u32, s: usize) -> u32 {
        let row = table.row(q, s);
        let allowed = (0..row.len()).filter(|&a| self.allows(q, s, a));
        let best = allowed.reduce(|best, a| if row[a] > row[best] { a } else { best });
        best.map_or_else(|| table.greedy(q, s), |a| a as u32)
    }

    /// The greedy policy under the shield, indexed `q * states + s`.
    #[must_use]
    pub fn policy(&self, table: &QTable) -> Vec<u32> {
        let pairs = 0..table.automaton_states() as usize * self.states;
        pairs.map(|at| self.greedy(table, (at / self.states) as u32, at % self.states)).collect()
    }
}

impl Problem<'_> {
    /// What `shield` costs and gains when it is laid over the greedy policy of `table`; `q_star`
    /// are the optimal values for the reward that was trained on.
    ///
    /// # Panics
    /// If the shield or the tables are not of this problem.
    #[must_use]
    pub fn certify_shield(&self, shield: &Shield, table: &QTable, q_star: &QTable) -> Shielded {
        let (before, after) = (table.policy(), shield.policy(table));
        let labelled = self.labelled();
        let live: Vec<u32> = labelled.live().collect();
        let mut overruled = 0;
        for &q in &live {
            let layer = labelled.pair(q, 0)..labelled.pair(q + 1, 0);
            overruled += layer.filter(|&pair| before[pair] != after[pair]).count();
        }
        Shielded {
            lost_before: self.mean_of(&self.lost(&before)),
            lost_after: self.mean_of(&self.lost(&after)),
            smallest_lost: self.mean_of(&self.smallest_lost()),
            overruled: overruled as f64 / (live.len() * labelled.states()).max(1) as f64,
            before: self.certify(&before, q_star),
            after: self.certify(&after, q_star),
        }
    }
}
