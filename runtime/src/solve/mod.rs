//! Exact solutions for finite models: what is optimal, and what a given policy is worth.
//!
//! A [`Problem`] is a world's [`Dynamics`] under a [`Labelled`] task; its [`Optimum`] is what policies
//! are judged against. Automaton states are solved
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
mod evaluation;
mod finish;
mod graph;
mod optimum;
mod report;
mod rule;
mod settle;

use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::augmented::{Labelled, Payment};
pub use crate::certificate::{Basis, Certificate, Mistake, Report, Start, Within};
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::policy::Policy;
use crate::q::QTable;
use crate::reward::{End, Rewards};
pub(crate) use actions::{Actions, Objective};
use block::Block;
pub use evaluation::{Evaluation, Values};
pub use optimum::Optimum;
use rule::{Backup, Rule};

/// The change at which sweeps stop, relative to values where they exceed 1. In worlds that are left
/// slowly the error is larger than the last change: 5e-9 on a grid of 100 × 100 with traps.
const TOLERANCE: f64 = 1e-11;

/// A finite world under a task: the augmented MDP that is solved. Cheap to clone: clones share the
/// tables.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
/// let best = problem.best();
/// assert_eq!(best.satisfied().at(0, 0), 1.0);
/// assert_eq!(best.steps(0, 1), Some(3.0));
/// // Over the starts: 4, 3, 2, 1 and 0 steps.
/// assert!(best.mean_steps().is_some_and(|steps| (steps - 2.0).abs() < 1e-9));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Problem {
    dynamics: Dynamics,
    task: Labelled,
    predecessors: Arc<(Vec<u32>, Vec<u32>)>,
    /// The strongly connected components of live automaton states, those that others lead to first.
    components: Arc<[Vec<u32>]>,
}

impl Problem {
    /// The world `dynamics` under `task`.
    ///
    /// # Errors
    /// If they have different numbers of states or actions.
    #[inline]
    pub fn new(dynamics: &Dynamics, task: &Labelled) -> Result<Self, Mismatch> {
        task.check_world("dynamics", dynamics.states(), dynamics.actions())?;
        Ok(Self::of_own_world(dynamics.clone(), task.clone()))
    }

    /// The same where the sizes are known to fit.
    #[inline]
    pub(crate) fn of_own_world(dynamics: Dynamics, task: Labelled) -> Self {
        let predecessors = Arc::new(dynamics.predecessors());
        let components = graph::components(&task).into();
        Self { dynamics, task, predecessors, components }
    }

    /// The world.
    #[must_use]
    #[inline]
    pub const fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// The task.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// What policies are judged against: the optimal values for `rewards`, the largest possible
    /// P(satisfied) and the fewest steps. All three are solved here, once for many policies.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
    /// assert_eq!(optimum.fraction_optimal(&Policy::from_fn(&task, |_, _| 1)?)?, 1.0);
    /// assert_eq!(optimum.fraction_optimal(&Policy::from_fn(&task, |_, _| 0)?)?, 0.0, "left is never best");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn optimum(&self, rewards: &Rewards) -> Optimum {
        Optimum::new(self.clone(), rewards)
    }

    /// The optimal flat action values Q* of the augmented MDP, to about 1e-10.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let q = problem.optimal_q(&Rewards::acceptance().with_gamma(0.5)?);
    /// // Paid 1 on arrival, which is 4 steps away: γ³.
    /// assert!((q.max(0, 0) - 0.125).abs() < 1e-9);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If the rewards need ρ and the task is labelled without it.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn optimal_q(&self, rewards: &Rewards) -> QTable {
        self.optimal_q_of(&self.task.payment(rewards), rewards.gamma(), None)
    }

    /// The same for any payment; `start` saves sweeps if it is near the result. (Whatever it is, the
    /// result is the same: the sweeps are a contraction.)
    #[inline]
    pub(crate) fn optimal_q_of(
        &self,
        payment: &Payment,
        gamma: f64,
        start: Option<&QTable>,
    ) -> QTable {
        let values = self.discounted(payment, gamma, start, &Rule::Largest);
        self.action_values(&self.arrivals(payment, gamma, &values))
    }

    /// The flat action values Q^π of a policy of this problem, for any payment.
    #[inline]
    pub(crate) fn policy_q(&self, payment: &Payment, gamma: f64, policy: &Policy) -> QTable {
        let values = self.discounted(payment, gamma, None, &Rule::Follow(policy.table()));
        self.action_values(&self.arrivals(payment, gamma, &values))
    }

    /// The optimal sub-policy values of the paper's Eq. 3A6: progress is paid, but q stays as it
    /// is for ever.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Two cells; each step changes sides. First the one, then the other.
    /// let cells = model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]);
    /// let task = Labelled::of_model(&cells, &tltl! { |s: &usize| ({ *s } == 1) T ({ *s } == 0) })?;
    /// let problem = Problem::new(&Dynamics::new(&cells)?, &task)?;
    /// let rewards = Rewards::progress().with_gamma(0.5)?;
    /// // Flat: 1 for this move, and half of the 1 for the next one.
    /// assert!((problem.optimal_q(&rewards).max(0, 0) - 1.5).abs() < 1e-9);
    /// // Sub-policy: the same move is paid again every other step, 1 + 0.25 + 0.0625 + …
    /// assert!((problem.sub_policy_q(&rewards).max(0, 0) - 4.0 / 3.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// As [`Self::optimal_q`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn sub_policy_q(&self, rewards: &Rewards) -> QTable {
        let (payment, gamma) = (self.task.payment(rewards), rewards.gamma());
        let mut values = alloc::vec![0.0; self.task.pairs()];
        for q in self.task.live() {
            Block::fixed(self, q, &payment, gamma).sweep(&mut values, true, &Rule::Largest);
        }
        let states = self.task.states();
        self.action_values(&|q, at| {
            if at >= states {
                return self.paid_last(&payment, q, at);
            }
            self.paid(&payment, q, at) + gamma * values[self.task.pair(q, at)]
        })
    }

    /// The policy of the largest possible P(satisfied), and among those of the smallest possible
    /// E\[steps\] (actions within 1e-9 of the largest P count as reaching it).
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // From 0 a short way (action 0) that is lost one time in ten, and a sure one over 1 (action 1).
    /// let ways = model::from_fn(4, 2, |s, a| match (s, a) {
    ///     (0, 0) => vec![(2, 0.9), (3, 0.1)],
    ///     (0, 1) => vec![(1, 1.0)],
    ///     (1, _) => vec![(2, 1.0)],
    ///     _ => vec![(s, 1.0)],
    /// });
    /// let task = Labelled::of_model(&ways, &tltl! { |s: &usize| ({ *s } != 3) U ({ *s } == 2) })?;
    /// let best = Problem::new(&Dynamics::new(&ways)?, &task)?.best();
    /// assert_eq!(best.policy().act(0, 0), 1, "P comes first, steps only then");
    /// assert_eq!((best.satisfied().at(0, 0), best.steps(0, 0)), (1.0, Some(2.0)));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn best(&self) -> Evaluation {
        let accept = self.acceptance();
        let satisfied = self.reach(&accept);
        let safe = self.safe(&accept, &satisfied);
        let weighted = self.fewest_steps(&satisfied, &safe);
        let policy = Policy::from_table(&self.task, self.fewest(&weighted, &safe));
        self.evaluation(policy, satisfied, &weighted)
    }

    /// The largest possible P(satisfied), to about 1e-10 (5e-9 in a world that is left slowly): 1 at the
    /// accepting state, 0 at the trap.
    #[must_use]
    #[inline]
    pub fn largest_satisfied(&self) -> Values {
        let mut satisfied = self.reach(&self.acceptance());
        self.set_end(End::Accepted, &mut satisfied, 1.0);
        Values::new(self, satisfied)
    }

    /// P(satisfied) and E\[steps\] of a policy, whatever it does: where it never succeeds, P is 0.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // A step to the goal succeeds one time in four, and else stays.
    /// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
    /// let task = Labelled::of_model(&try_hard, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let problem = Problem::new(&Dynamics::new(&try_hard)?, &task)?;
    /// let worth = problem.evaluate(&Policy::from_fn(&task, |_, _| 0)?)?;
    /// assert!((worth.satisfied().at(0, 0) - 1.0).abs() < 1e-9);
    /// assert!(worth.steps(0, 0).is_some_and(|steps| (steps - 4.0).abs() < 1e-9));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn evaluate(&self, policy: &Policy) -> Result<Evaluation, Mismatch> {
        policy.must_be_for(&self.task)?;
        let actions = policy.table();
        let (mut satisfied, mut weighted) = (self.zeros(), self.zeros());
        let (accept, nothing, none) = (self.acceptance(), self.nothing(), self.zeros());
        for members in self.components.iter() {
            let block = Block::following(self, members, &accept, actions);
            block.solve(&mut satisfied, &none, actions);
            block.paying(&nothing).solve(&mut weighted, &satisfied, actions);
        }
        Ok(self.evaluation(policy.clone(), satisfied, &weighted))
    }

    /// P(satisfied within so many steps) of a policy: 1 at the accepting state. Each step is one
    /// backup of every pair.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // A step to the goal succeeds one time in four, and else stays.
    /// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
    /// let task = Labelled::of_model(&try_hard, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let problem = Problem::new(&Dynamics::new(&try_hard)?, &task)?;
    /// let policy = Policy::from_fn(&task, |_, _| 0)?;
    /// assert_eq!(problem.satisfied_within(&policy, 0)?.at(0, 0), 0.0);
    /// assert_eq!(problem.satisfied_within(&policy, 2)?.at(0, 0), 0.25 + 0.75 * 0.25);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn satisfied_within(&self, policy: &Policy, steps: u64) -> Result<Values, Mismatch> {
        policy.must_be_for(&self.task)?;
        Ok(self.within(steps, &Rule::Follow(policy.table())))
    }

    /// The largest possible P(satisfied within so many steps): that of the best policy which knows how
    /// many are left.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // From 0 a leap that fails one time in two for ever, or a sure walk of two steps.
    /// let ways = model::from_fn(4, 2, |s, a| match (s, a) {
    ///     (0, 0) => vec![(2, 0.5), (3, 0.5)],
    ///     (0, 1) => vec![(1, 1.0)],
    ///     (1, _) => vec![(2, 1.0)],
    ///     _ => vec![(s, 1.0)],
    /// });
    /// let task = Labelled::of_model(&ways, &tltl! { |s: &usize| F ({ *s } == 2) })?;
    /// let problem = Problem::new(&Dynamics::new(&ways)?, &task)?;
    /// assert!([0, 1, 2].map(|steps| problem.largest_satisfied_within(steps).at(0, 0)) == [0.0, 0.5, 1.0]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn largest_satisfied_within(&self, steps: u64) -> Values {
        self.within(steps, &Rule::Largest)
    }

    /// Finite-horizon dynamic programming; it stops where a further step changes nothing.
    #[inline]
    fn within(&self, steps: u64, rule: &Rule<'_>) -> Values {
        let (accept, mut values) = (self.acceptance(), self.zeros());
        let mut next = values.clone();
        for _ in 0..steps {
            let mut change = false;
            let arrival = self.arrivals(&accept, 1.0, &values);
            self.gathered(&arrival, &mut |q, s, backup| {
                let pair = self.task.pair(q, s);
                next[pair] = rule.value(pair, backup);
                change |= next[pair] > values[pair];
            });
            drop(arrival);
            core::mem::swap(&mut values, &mut next);
            if !change {
                break;
            }
        }
        self.set_end(End::Accepted, &mut values, 1.0);
        Values::new(self, values)
    }

    /// P(the trap is ever entered) under a policy; 1 at the trap. Where a policy may also go on for
    /// ever, this and P(satisfied) sum to less than 1.
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn lost(&self, policy: &Policy) -> Result<Values, Mismatch> {
        policy.must_be_for(&self.task)?;
        let mut lost = self.lost_by(&self.entering(End::Lost), &Rule::Follow(policy.table()));
        self.set_end(End::Lost, &mut lost, 1.0);
        Ok(Values::new(self, lost))
    }

    /// The smallest possible P(the trap is ever entered); 1 at the trap. A policy that reaches it may
    /// stay away from the goal too: see [`shield`](crate::shield).
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // In 0: wait (action 0), or try for 1, which goes wrong one time in four (action 1).
    /// let risk = model::from_fn(3, 2, |s, a| match (s, a) {
    ///     (0, 1) => vec![(1, 0.75), (2, 0.25)],
    ///     _ => vec![(s, 1.0)],
    /// });
    /// let task = Labelled::of_model(&risk, &tltl! { |s: &usize| ({ *s } != 2) U ({ *s } == 1) })?;
    /// let problem = Problem::new(&Dynamics::new(&risk)?, &task)?;
    /// let try_it = Policy::from_fn(&task, |_, _| 1)?;
    /// assert_eq!(problem.lost(&try_it)?.at(0, 0), 0.25);
    /// assert_eq!(problem.smallest_lost().at(0, 0), 0.0, "who waits for ever is never lost");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn smallest_lost(&self) -> Values {
        let mut lost = self.lost_by(&self.entering(End::Lost), &Rule::Least);
        self.set_end(End::Lost, &mut lost, 1.0);
        Values::new(self, lost)
    }

    /// The smallest or the largest P(the trap is ever entered) among the policies that use allowed
    /// actions only; 1 at the trap. Every live pair has an allowed action.
    #[inline]
    pub(crate) fn lost_within(&self, allowed: &Actions, objective: Objective) -> Values {
        let rule = match objective {
            Objective::Smallest => Rule::LeastOf(allowed),
            Objective::Largest => Rule::LargestOf(allowed),
        };
        let mut lost = self.lost_by(&self.entering(End::Lost), &rule);
        self.set_end(End::Lost, &mut lost, 1.0);
        Values::new(self, lost)
    }

    /// Sweeps from 0, which is below: the least fixed point, for being lost needs an entry into the
    /// trap, and a cycle that never enters it must not count.
    #[inline]
    fn lost_by(&self, trapped: &Payment, rule: &Rule<'_>) -> Vec<f64> {
        let mut values = self.zeros();
        for members in self.components.iter() {
            Block::new(self, members, trapped, 1.0).sweep(&mut values, true, rule);
        }
        values
    }

    #[inline]
    fn paid(&self, payment: &Payment, q: u32, s: usize) -> f64 {
        payment.get(q, s, self.task.tables().class[s])
    }

    /// What the arrival `at` pays at `q`, the world ending the episode with it.
    #[inline]
    fn paid_last(&self, payment: &Payment, q: u32, at: usize) -> f64 {
        let s = self.dynamics.arrived(at);
        payment.get_last(q, s, self.task.tables().class[s])
    }

    /// Pays 1 for entering the accepting state: its undiscounted value is P(satisfied), as that of
    /// reachability in a Markov decision process (Baier and Katoen 2008, chapter 10).
    #[inline]
    fn acceptance(&self) -> Payment {
        self.entering(End::Accepted)
    }

    /// Pays 1 for entering an end.
    #[inline]
    fn entering(&self, end: End) -> Payment {
        let of = |q| self.task.end(q);
        let pays = |q, to| f64::from(u8::from(of(q).is_none() && of(to) == Some(end)));
        self.task.payment_by(&pays)
    }

    #[inline]
    fn nothing(&self) -> Payment {
        self.task.payment_by(&|_, _| 0.0)
    }

    /// 0 at every pair: at terminal ones, that is their value.
    #[inline]
    fn zeros(&self) -> Vec<f64> {
        alloc::vec![0.0; self.task.pairs()]
    }

    /// Values by sweeps, from `start` or from estimates.
    #[inline]
    fn discounted(
        &self,
        payment: &Payment,
        gamma: f64,
        start: Option<&QTable>,
        rule: &Rule<'_>,
    ) -> Vec<f64> {
        let mut values = self.zeros();
        for members in self.components.iter() {
            let block = Block::new(self, members, payment, gamma).settled(&mut values, rule);
            if let Some(table) = start {
                block.start(&mut values, table);
            }
            block.sweep(&mut values, true, rule);
        }
        values
    }

    /// The largest possible P(satisfied).
    #[inline]
    fn reach(&self, accept: &Payment) -> Vec<f64> {
        let mut values = self.zeros();
        for members in self.components.iter() {
            let block = Block::new(self, members, accept, 1.0);
            if !block.succeeds(&mut values) {
                // From 0, which is below: of several fixed points the least is P(satisfied).
                block.sweep(&mut values, false, &Rule::Largest);
            }
        }
        values
    }

    /// Least Σ steps · 1(success) with the actions that are `safe`: divided by P(success) it is
    /// E\[steps\] given success. Pairs from which success is impossible take no part, for there every
    /// number of steps would do.
    #[inline]
    fn fewest_steps(&self, satisfied: &[f64], safe: &Actions) -> Vec<f64> {
        let (mut values, nothing) = (self.zeros(), self.nothing());
        let rule = &Rule::LeastCost { costs: satisfied, safe };
        for members in self.components.iter() {
            let block = Block::new(self, members, &nothing, 1.0);
            let block = block.only(|pair| satisfied[pair] > 0.0).settled(&mut values, rule);
            block.sweep(&mut values, false, rule);
        }
        values
    }

    /// For each pair the safe action of the least cost.
    #[inline]
    fn fewest(&self, cost: &[f64], safe: &Actions) -> Vec<u32> {
        let mut policy = alloc::vec![0; self.task.pairs()];
        self.backups(&self.arrivals(&self.nothing(), 1.0, cost), &mut |q, s, actions| {
            let pair = self.task.pair(q, s);
            let allowed = (0..actions.len()).filter(|&a| safe.contains(pair, a));
            let best = allowed.reduce(|best, a| if actions[a] < actions[best] { a } else { best });
            policy[pair] = best.unwrap_or(0) as u32;
        });
        policy
    }

    /// The actions within 1e-9 of the largest P: ties are common, and rounding must not break them
    /// before the steps do.
    #[inline]
    fn safe(&self, accept: &Payment, satisfied: &[f64]) -> Actions {
        let mut safe = Actions::none(self.task.pairs(), self.dynamics.actions());
        self.backups(&self.arrivals(accept, 1.0, satisfied), &mut |q, s, actions| {
            let pair = self.task.pair(q, s);
            for (a, &p) in actions.iter().enumerate() {
                if p >= satisfied[pair] - 1e-9 {
                    safe.insert(pair, a);
                }
            }
        });
        safe
    }

    /// What the arrival `at` is worth to `q`: payment plus discounted value, which is 0 where the
    /// episode is over.
    #[inline]
    fn worth(&self, payment: &Payment, discount: f64, values: &[f64], q: u32, at: usize) -> f64 {
        if at >= self.task.states() {
            return self.paid_last(payment, q, at);
        }
        let to = self.task.pair(self.task.next(q, at), at);
        self.paid(payment, q, at) + discount * values[to]
    }

    /// The same as a function of q and arrival.
    #[inline]
    fn arrivals(
        &self,
        payment: &Payment,
        discount: f64,
        values: &[f64],
    ) -> impl Fn(u32, usize) -> f64 {
        move |q, at| self.worth(payment, discount, values, q, at)
    }

    /// What a backup of every live pair sees. What arriving is worth is gathered once for each q, so
    /// that a pair reads its successors from one row.
    #[inline]
    fn gathered(
        &self,
        arrival: &dyn Fn(u32, usize) -> f64,
        visit: &mut dyn FnMut(u32, usize, &Backup<'_>),
    ) {
        let mut arrivals = Vec::new();
        for q in self.task.live() {
            let all: Vec<f64> = (0..self.dynamics.arrivals()).map(|at| arrival(q, at)).collect();
            for s in 0..self.dynamics.states() {
                arrivals.clear();
                arrivals.extend(self.dynamics.successors(s).iter().map(|&to| all[to as usize]));
                let matrix = self.dynamics.matrix(s);
                visit(q, s, &Backup { matrix, arrivals: &arrivals });
            }
        }
    }

    /// One backup of every action at every live pair: `visit(q, s, values)`.
    #[inline]
    fn backups(
        &self,
        arrival: &dyn Fn(u32, usize) -> f64,
        visit: &mut dyn FnMut(u32, usize, &[f64]),
    ) {
        let mut actions = alloc::vec![0.0; self.dynamics.actions()];
        self.gathered(arrival, &mut |q, s, backup| {
            actions.iter_mut().zip(backup.values()).for_each(|(value, of)| *value = of);
            visit(q, s, &actions);
        });
    }

    /// Q(s, q, a) = E\[what arriving is worth\].
    #[inline]
    fn action_values(&self, arrival: &dyn Fn(u32, usize) -> f64) -> QTable {
        let mut table = QTable::zeros(&self.task);
        self.backups(arrival, &mut |q, s, row| table.row_mut(q, s).copy_from_slice(row));
        table
    }

    /// `satisfied` times the steps to satisfaction is `weighted`.
    #[inline]
    fn evaluation(&self, policy: Policy, mut satisfied: Vec<f64>, weighted: &[f64]) -> Evaluation {
        let steps = |(&w, &p): (&f64, &f64)| if p > 0.0 { w / p } else { f64::NAN };
        let mut steps: Vec<f64> = weighted.iter().zip(&satisfied).map(steps).collect();
        self.set_end(End::Accepted, &mut satisfied, 1.0);
        self.set_end(End::Accepted, &mut steps, 0.0);
        Evaluation::new(policy, Values::new(self, satisfied), steps)
    }

    /// Sets the values at an end.
    #[inline]
    fn set_end(&self, end: End, values: &mut [f64], value: f64) {
        for q in 0..self.task.automaton_states() {
            if self.task.end(q) == Some(end) {
                values[self.task.pair(q, 0)..self.task.pair(q + 1, 0)].fill(value);
            }
        }
    }
}
