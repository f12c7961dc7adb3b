//! Exact solutions for finite models: what is optimal, and what a given policy is worth.
//!
//! A [`Problem`] is a world's [`Dynamics`] under a [`Labelled`] task. Automaton states are solved
//! one strongly connected component after the other, those that the others lead to first; within
//! a component, pairs (q, s) are swept Gauss-Seidel fashion, over-relaxed, along the flow of the
//! optimal policy and in a window that moves away from the exits; the stop is that of plain sweeps.
//! Measured with 8 automaton states: 0.3 ms on the paper's grid; on 1000 × 1000 cells 20 s for Q*,
//! and as much for E\[steps\], in 1.2 times the memory of the table.
//!
//! - *Flat* values bootstrap at q' ([`Problem::optimal_q`], the augmented MDP); *sub-policy* values
//!   at a fixed q ([`Problem::sub_policy_q`], the paper's Eq. 3A6). They are different.
//! - P(satisfied) and E\[steps\] are undiscounted and without horizon. Steps count from the first
//!   state, which is read and costs nothing, to acceptance; where P < 1 they are conditional on
//!   success. The smallest possible steps are those among the policies with the largest possible
//!   P. Weak point: in a world that mixes slowly, an undiscounted sweep gains little; components
//!   of up to 1024 pairs are then solved by elimination, larger ones are swept on.

mod actions;
mod block;
mod certificate;
mod graph;
mod rule;
mod settle;

use alloc::vec::Vec;

use crate::augmented::{End, Labelled, Payment, Rewards};
use crate::model::Dynamics;
use crate::q::QTable;
pub use actions::Actions;
use block::Block;
pub use certificate::{Certificate, Kind, Mistake, Start};
use rule::Rule;

/// The largest error of values, relative to them where they exceed 1.
const TOLERANCE: f64 = 1e-11;

/// A finite world under a task: the augmented MDP that is solved.
#[derive(Clone, Debug)]
pub struct Problem<'a> {
    dynamics: &'a Dynamics,
    labelled: &'a Labelled,
    predecessors: (Vec<u32>, Vec<u32>),
    /// The strongly connected components of live automaton states, those that others lead to first.
    components: Vec<Vec<u32>>,
}

/// P(satisfied) and E\[steps\] from every pair (q, s) after s was read, indexed `q * states + s`.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// The action in each pair.
    pub policy: Vec<u32>,
    /// The probability that the task is satisfied.
    pub satisfied: Vec<f64>,
    /// The expected steps to satisfaction, given that it comes; NaN where it never does.
    pub steps: Vec<f64>,
}

impl<'a> Problem<'a> {
    /// The world `dynamics` under the task `labelled`.
    ///
    /// # Panics
    /// If they do not have the same number of states.
    #[must_use]
    pub fn new(dynamics: &'a Dynamics, labelled: &'a Labelled) -> Self {
        assert_eq!(dynamics.states(), labelled.states(), "a task is labelled on its own world");
        let predecessors = dynamics.predecessors();
        let components = graph::components(labelled);
        Self { dynamics, labelled, predecessors, components }
    }

    /// The world.
    #[must_use]
    pub const fn dynamics(&self) -> &'a Dynamics {
        self.dynamics
    }

    /// The task.
    #[must_use]
    pub const fn labelled(&self) -> &'a Labelled {
        self.labelled
    }

    /// The optimal flat action values Q* of the augmented MDP, to 1e-10.
    ///
    /// # Panics
    /// Unless 0 ≤ `gamma` < 1.
    #[must_use]
    pub fn optimal_q(&self, rewards: &Rewards, gamma: f64) -> QTable {
        self.optimal_q_of(&self.labelled.payment(rewards, gamma), gamma, None)
    }

    /// The same for any payment; `start` saves sweeps if it is near.
    ///
    /// # Panics
    /// As [`Self::optimal_q`].
    #[must_use]
    pub fn optimal_q_of(&self, payment: &Payment, gamma: f64, start: Option<&QTable>) -> QTable {
        let values = self.discounted(payment, gamma, start, &Rule::Largest);
        self.action_values(&self.arrivals(payment, gamma, &values))
    }

    /// The flat action values Q^π of a policy, indexed `q * states + s`, for any payment.
    ///
    /// # Panics
    /// As [`Self::optimal_q`], or if the policy is not one of this problem.
    #[must_use]
    pub fn policy_q(&self, payment: &Payment, gamma: f64, policy: &[u32]) -> QTable {
        assert_eq!(policy.len(), self.labelled.pairs(), "a policy has an action for each (q, s)");
        let values = self.discounted(payment, gamma, None, &Rule::Follow(policy));
        self.action_values(&self.arrivals(payment, gamma, &values))
    }

    /// The optimal sub-policy values of the paper's Eq. 3A6: progress is paid, but q stays as it
    /// is for ever.
    ///
    /// # Panics
    /// As [`Self::optimal_q`].
    #[must_use]
    pub fn sub_policy_q(&self, rewards: &Rewards, gamma: f64) -> QTable {
        let payment = self.labelled.payment(rewards, gamma);
        let mut values = alloc::vec![0.0; self.labelled.pairs()];
        for q in self.labelled.live() {
            Block::fixed(self, q, &payment, gamma).sweep(&mut values, true, &Rule::Largest);
        }
        self.action_values(&|q, s| {
            self.paid(&payment, q, s) + gamma * values[self.labelled.pair(q, s)]
        })
    }

    /// The largest possible P(satisfied), and the smallest possible E\[steps\] among the policies
    /// that reach it (actions within 1e-9 of the largest P count as reaching it).
    #[must_use]
    pub fn best(&self) -> Outcome {
        let accept = self.acceptance();
        let satisfied = self.reach(&accept);
        let safe = self.safe(&accept, &satisfied);
        let weighted = self.fewest_steps(&satisfied, &safe);
        let policy = self.fewest(&weighted, &safe);
        self.outcome(policy, satisfied, &weighted)
    }

    /// The actions with which the largest possible P(satisfied) can still be reached, within 1e-9.
    #[must_use]
    pub fn safe_actions(&self) -> Actions {
        let accept = self.acceptance();
        self.safe(&accept, &self.reach(&accept))
    }

    /// The largest possible P(satisfied) of each pair, to 1e-10, indexed `q * states + s`: 1 at the
    /// accepting state, 0 at the trap.
    #[must_use]
    pub fn largest_p(&self) -> Vec<f64> {
        let mut satisfied = self.reach(&self.acceptance());
        self.set_end(End::Accepted, &mut satisfied, 1.0);
        satisfied
    }

    /// P(satisfied) and E\[steps\] of a policy, indexed `q * states + s`, whatever it does: where
    /// it never succeeds, P is 0.
    ///
    /// # Panics
    /// If the policy is not one of this problem.
    #[must_use]
    pub fn evaluate(&self, policy: &[u32]) -> Outcome {
        assert_eq!(policy.len(), self.labelled.pairs(), "a policy has an action for each (q, s)");
        let (mut satisfied, mut weighted) = (self.zeros(), self.zeros());
        let (accept, nothing, none) = (self.acceptance(), self.nothing(), self.zeros());
        for members in &self.components {
            let block = Block::following(self, members, &accept, policy);
            block.solve(&mut satisfied, &none, policy);
            block.paying(&nothing).solve(&mut weighted, &satisfied, policy);
        }
        self.outcome(policy.to_vec(), satisfied, &weighted)
    }

    /// P(the trap is ever entered) under a policy, for each pair; 1 at the trap.
    ///
    /// # Panics
    /// If the policy is not one of this problem.
    #[must_use]
    pub fn lost(&self, policy: &[u32]) -> Vec<f64> {
        let trapped = self.entering(End::Lost);
        let mut lost = self.lost_by(&trapped, &Rule::Follow(policy));
        self.set_end(End::Lost, &mut lost, 1.0);
        lost
    }

    /// The smallest possible P(the trap is ever entered), for each pair; 1 at the trap.
    #[must_use]
    pub fn smallest_lost(&self) -> Vec<f64> {
        let mut lost = self.lost_by(&self.entering(End::Lost), &Rule::Least);
        self.set_end(End::Lost, &mut lost, 1.0);
        lost
    }

    /// The actions with which P(the trap is ever entered) can stay `lost`, within 1e-9.
    pub(crate) fn avoiding(&self, lost: &[f64]) -> Actions {
        let mut avoiding = Actions::none(self.labelled.pairs(), self.dynamics.actions());
        self.backups(&self.arrivals(&self.nothing(), 1.0, lost), &mut |q, s, actions| {
            let pair = self.labelled.pair(q, s);
            for (a, &p) in actions.iter().enumerate() {
                if p <= lost[pair] + 1e-9 {
                    avoiding.insert(pair, a);
                }
            }
        });
        avoiding
    }

    /// Sweeps from 0, which is below: the least fixed point.
    fn lost_by(&self, trapped: &Payment, rule: &Rule<'_>) -> Vec<f64> {
        let mut values = self.zeros();
        for members in &self.components {
            Block::new(self, members, trapped, 1.0).sweep(&mut values, true, rule);
        }
        values
    }

    fn paid(&self, payment: &Payment, q: u32, s: usize) -> f64 {
        payment.get(q, s, self.labelled.class()[s])
    }

    /// Pays 1 for entering the accepting state: its undiscounted value is P(satisfied).
    fn acceptance(&self) -> Payment {
        self.entering(End::Accepted)
    }

    /// Pays 1 for entering an end.
    fn entering(&self, end: End) -> Payment {
        let of = |q| self.labelled.end(q);
        let pays = |q, to| f64::from(u8::from(of(q).is_none() && of(to) == Some(end)));
        self.labelled.payment_by(&pays)
    }

    fn nothing(&self) -> Payment {
        self.labelled.payment_by(&|_, _| 0.0)
    }

    /// 0 at every pair: at terminal ones, that is their value.
    fn zeros(&self) -> Vec<f64> {
        alloc::vec![0.0; self.labelled.pairs()]
    }

    /// Values by sweeps, from `start` or from estimates.
    fn discounted(
        &self,
        payment: &Payment,
        gamma: f64,
        start: Option<&QTable>,
        rule: &Rule<'_>,
    ) -> Vec<f64> {
        assert!((0.0..1.0).contains(&gamma), "a discount factor is at least 0 and less than 1");
        let mut values = self.zeros();
        for members in &self.components {
            let block = Block::new(self, members, payment, gamma).settled(&mut values, rule);
            if let Some(table) = start {
                block.start(&mut values, table);
            }
            block.sweep(&mut values, true, rule);
        }
        values
    }

    /// The largest possible P(satisfied).
    fn reach(&self, accept: &Payment) -> Vec<f64> {
        let mut values = self.zeros();
        for members in &self.components {
            let block = Block::new(self, members, accept, 1.0);
            if !block.succeeds(&mut values) {
                block.sweep(&mut values, false, &Rule::Largest);
            }
        }
        values
    }

    /// Least Σ steps · 1(success) with the actions that are `safe`.
    fn fewest_steps(&self, satisfied: &[f64], safe: &Actions) -> Vec<f64> {
        let (mut values, nothing) = (self.zeros(), self.nothing());
        let rule = &Rule::LeastCost { costs: satisfied, safe };
        for members in &self.components {
            let block = Block::new(self, members, &nothing, 1.0);
            let block = block.only(|pair| satisfied[pair] > 0.0).settled(&mut values, rule);
            block.sweep(&mut values, false, rule);
        }
        values
    }

    /// For each pair the safe action of the least cost.
    fn fewest(&self, cost: &[f64], safe: &Actions) -> Vec<u32> {
        let mut policy = alloc::vec![0; self.labelled.pairs()];
        self.backups(&self.arrivals(&self.nothing(), 1.0, cost), &mut |q, s, actions| {
            let pair = self.labelled.pair(q, s);
            let allowed = (0..actions.len()).filter(|&a| safe.contains(pair, a));
            let best = allowed.reduce(|best, a| if actions[a] < actions[best] { a } else { best });
            policy[pair] = best.unwrap_or(0) as u32;
        });
        policy
    }

    /// The actions within 1e-9 of the largest P.
    fn safe(&self, accept: &Payment, satisfied: &[f64]) -> Actions {
        let mut safe = Actions::none(self.labelled.pairs(), self.dynamics.actions());
        self.backups(&self.arrivals(accept, 1.0, satisfied), &mut |q, s, actions| {
            let pair = self.labelled.pair(q, s);
            for (a, &p) in actions.iter().enumerate() {
                if p >= satisfied[pair] - 1e-9 {
                    safe.insert(pair, a);
                }
            }
        });
        safe
    }

    /// What reading `s` at `q` is worth: payment plus discounted value.
    fn arrivals(
        &self,
        payment: &Payment,
        discount: f64,
        values: &[f64],
    ) -> impl Fn(u32, usize) -> f64 {
        move |q, s| {
            let to = self.labelled.pair(self.labelled.next(q, s), s);
            self.paid(payment, q, s) + discount * values[to]
        }
    }

    /// One backup of every action at every live pair: `visit(q, s, values)`.
    fn backups(
        &self,
        arrival: &dyn Fn(u32, usize) -> f64,
        visit: &mut dyn FnMut(u32, usize, &[f64]),
    ) {
        let mut actions = alloc::vec![0.0; self.dynamics.actions()];
        for q in self.labelled.live() {
            let arrivals: Vec<f64> = (0..self.dynamics.states()).map(|s| arrival(q, s)).collect();
            for s in 0..self.dynamics.states() {
                let successors = self.dynamics.successors(s);
                let rows = self.dynamics.matrix(s).chunks(successors.len());
                for (value, row) in actions.iter_mut().zip(rows) {
                    *value =
                        row.iter().zip(successors).map(|(p, &to)| p * arrivals[to as usize]).sum();
                }
                visit(q, s, &actions);
            }
        }
    }

    /// Q(s, q, a) = E\[arrival(q, s')\].
    fn action_values(&self, arrival: &dyn Fn(u32, usize) -> f64) -> QTable {
        let mut table = QTable::zeros(self.labelled, self.dynamics.actions());
        self.backups(arrival, &mut |q, s, row| table.row_mut(q, s).copy_from_slice(row));
        table
    }

    fn outcome(&self, policy: Vec<u32>, mut satisfied: Vec<f64>, weighted: &[f64]) -> Outcome {
        let steps = |(&w, &p): (&f64, &f64)| if p > 0.0 { w / p } else { f64::NAN };
        let mut steps: Vec<f64> = weighted.iter().zip(&satisfied).map(steps).collect();
        self.set_end(End::Accepted, &mut satisfied, 1.0);
        self.set_end(End::Accepted, &mut steps, 0.0);
        Outcome { policy, satisfied, steps }
    }

    /// Sets the values at an end.
    fn set_end(&self, end: End, values: &mut [f64], value: f64) {
        for q in 0..self.labelled.automaton_states() {
            if self.labelled.end(q) == Some(end) {
                values[self.labelled.pair(q, 0)..self.labelled.pair(q + 1, 0)].fill(value);
            }
        }
    }
}
