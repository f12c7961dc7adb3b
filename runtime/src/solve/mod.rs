//! Exact solutions for finite models: what is optimal, and what a given policy is worth.
//!
//! A [`Problem`] is a world's [`Dynamics`] under a [`Labelled`] task; its [`Optimum`] is what policies
//! are judged against. Automaton states are solved one strongly connected component (`graph`) after the
//! other, those that the others lead to first. In each, what the graph decides is found (`sets`) by searches:
//! where success is impossible, and where it is sure. For the pairs between, policies are
//! improved (`improve`; the fewest steps begin with a search by costs, `cheapest`), their linear systems
//! (`chain`) solved, small ones by elimination (`eliminate`), and the error of what results is bounded
//! (`bounds`), whatever computed it.
//!
//! - *Flat* values bootstrap at q' ([`Problem::optimal_q`], the augmented MDP); *sub-policy* values
//!   at a fixed q ([`Problem::sub_policy_q`], the paper's Eq. 3A6). They are different.
//! - P(satisfied) and E\[steps\] are undiscounted and without horizon. Steps count from the first
//!   state, which is read and costs nothing, to acceptance; where P < 1 they are conditional on
//!   success. The smallest possible steps are those among the policies with the largest possible
//!   P.
//! - Every number comes with a [bound on its error](Values::error) that holds in exact arithmetic. Where more
//!   than about 1,500 pairs are hardly ever left (once in 10^9 steps, on ways that lead back and forth), or
//!   the best steps are more than about 10^13, it may be wide, and then says so.

mod actions;
mod bounded;
mod bounds;
mod chain;
mod cheapest;
mod component;
mod eliminate;
mod evaluation;
mod finish;
mod graph;
mod improve;
mod optimum;
mod report;
mod rows;
mod rule;
mod sets;

use alloc::sync::Arc;
use alloc::vec::Vec;

use crate::augmented::{Labelled, Payment};
pub use crate::certificate::{Basis, Certificate, Mistake, Report, Start, Within};
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::policy::Policy;
use crate::q::{QTable, largest};
use crate::reward::{End, Rewards};
pub(crate) use actions::Actions;
use bounded::{Bounded, Near};
pub use evaluation::{Evaluation, Values};
pub use optimum::Optimum;
pub(crate) use rule::Objective;
use rule::{Choice, Rule};

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

    /// The optimal flat action values Q* of the augmented MDP; [`Optimum::q_error`] bounds their error.
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
        self.bounded_q(rewards).0
    }

    /// The same with a bound on the error.
    #[track_caller]
    #[inline]
    fn bounded_q(&self, rewards: &Rewards) -> (QTable, f64) {
        let (payment, gamma) = (self.task.payment(rewards), rewards.gamma());
        let Bounded { values, error, .. } =
            self.discounted((&payment, gamma, false), None, &Rule::LARGEST);
        // A sum of products more.
        let largest = values.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
        let rounding = (self.dynamics.actions() as f64 + 16.0) * f64::EPSILON * largest;
        (self.action_values(&self.arrivals(&payment, gamma, &values)), error + rounding)
    }

    /// The same for any payment; `start` saves rounds if it is near the result, which is the same
    /// whatever it is, up to its error.
    #[inline]
    pub(crate) fn optimal_q_of(&self, payment: &Payment, gamma: f64, start: &QTable) -> QTable {
        let rows = start.values().chunks(self.task.actions());
        let (values, policy) = (rows.map(largest).collect::<Vec<f64>>(), start.policy());
        let near = Near { values: &values, policy: Some(policy.table()) };
        let recipe = (payment, gamma, false);
        let Bounded { values, .. } = self.discounted(recipe, Some(near), &Rule::LARGEST);
        self.action_values(&self.arrivals(payment, gamma, &values))
    }

    /// The flat action values Q^π of a policy of this problem, for any payment.
    #[inline]
    pub(crate) fn policy_q(&self, payment: &Payment, gamma: f64, policy: &Policy) -> QTable {
        let rule = Rule::follow(policy.table());
        let Bounded { values, .. } = self.discounted((payment, gamma, false), None, &rule);
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
        let Bounded { values, .. } = self.discounted((&payment, gamma, true), None, &Rule::LARGEST);
        let states = self.task.states();
        self.action_values(&|q, at| {
            if at >= states {
                return self.paid_last(&payment, q, at);
            }
            self.paid(&payment, q, at) + gamma * values[self.task.pair(q, at)]
        })
    }

    /// The policy of the largest possible P(satisfied), and among those of the smallest possible
    /// E\[steps\] (where success is not sure, actions that lose at most 1e-9 of P when they lead elsewhere
    /// count as reaching it).
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
        let largest = self.probability(&accept, &Rule::LARGEST);
        let safe = self.safe(&accept, &largest);
        let fewest = Rule::best(Objective::Smallest, Choice::Of(&safe));
        let weighted = self.costs(&largest.values, &fewest);
        let policy = Policy::from_table(&self.task, weighted.policy());
        if largest.doubt == 0.0 {
            return self.evaluation(policy, largest, weighted);
        }
        // Actions that are tied up to 1e-9 are not quite as good together.
        let rule = Rule::follow(policy.table());
        let own = self.probability(&accept, &rule);
        let weighted = self.costs(&own.values, &rule);
        let less = |(largest, own): (&f64, &f64)| (largest - own).abs();
        let less = largest.values.iter().zip(&own.values).map(less).fold(0.0, f64::max);
        self.evaluation(policy, own, weighted).standing_within(largest.error + less)
    }

    /// The largest possible P(satisfied): 1 at the accepting state, 0 at the trap.
    #[must_use]
    #[inline]
    pub fn largest_satisfied(&self) -> Values {
        let largest = self.probability(&self.acceptance(), &Rule::LARGEST);
        Values::new(self, largest).with_end(End::Accepted)
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
        let rule = Rule::follow(policy.table());
        let satisfied = self.probability(&self.acceptance(), &rule);
        let weighted = self.costs(&satisfied.values, &rule);
        Ok(self.evaluation(policy.clone(), satisfied, weighted))
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
        Ok(self.within(steps, &Rule::follow(policy.table())))
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
        self.within(steps, &Rule::LARGEST)
    }

    /// Finite-horizon dynamic programming; it stops where a further step changes nothing.
    #[inline]
    fn within(&self, steps: u64, rule: &Rule<'_>) -> Values {
        let (accept, mut values) = (self.acceptance(), self.zeros());
        let mut next = values.clone();
        for _ in 0..steps {
            let mut change = false;
            let arrival = self.arrivals(&accept, 1.0, &values);
            self.backups(&arrival, &mut |q, s, backup| {
                let pair = self.task.pair(q, s);
                next[pair] = rule.value(pair, backup.iter().copied());
                change |= next[pair] > values[pair];
            });
            drop(arrival);
            core::mem::swap(&mut values, &mut next);
            if !change {
                break;
            }
        }
        Values::new(self, Bounded::exact(values)).with_end(End::Accepted)
    }

    /// P(the trap is ever entered) under a policy; 1 at the trap. Where a policy may also go on for
    /// ever, this and P(satisfied) sum to less than 1.
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn lost(&self, policy: &Policy) -> Result<Values, Mismatch> {
        policy.must_be_for(&self.task)?;
        Ok(self.lost_by(&Rule::follow(policy.table())))
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
        self.lost_by(&Rule::best(Objective::Smallest, Choice::All))
    }

    /// The smallest or the largest P(the trap is ever entered) among the policies that use allowed
    /// actions only; 1 at the trap. Every live pair has an allowed action.
    #[inline]
    pub(crate) fn lost_within(&self, allowed: &Actions, objective: Objective) -> Values {
        self.lost_by(&Rule::best(objective, Choice::Of(allowed)))
    }

    #[inline]
    fn lost_by(&self, rule: &Rule<'_>) -> Values {
        let lost = self.probability(&self.entering(End::Lost), rule);
        Values::new(self, lost).with_end(End::Lost)
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

    /// 0 at every pair: at terminal ones, that is their value.
    #[inline]
    fn zeros(&self) -> Vec<f64> {
        alloc::vec![0.0; self.task.pairs()]
    }

    /// The actions that lose at most 1e-9 of the largest P each time that they lead elsewhere: ties are
    /// common, and rounding must not break them before the steps do. Where the graph makes success sure,
    /// those that lose nothing: a world may be slower than once in 1e9 steps.
    #[inline]
    fn safe(&self, accept: &Payment, largest: &Bounded) -> Actions {
        let satisfied = &*largest.values;
        let mut safe = Actions::none(self.task.pairs(), self.dynamics.actions());
        let arrival = self.arrivals(accept, 1.0, satisfied);
        for q in self.task.live() {
            let all: Vec<f64> = (0..self.dynamics.arrivals()).map(|at| arrival(q, at)).collect();
            for s in 0..self.task.states() {
                let (pair, stays) = (self.task.pair(q, s), self.task.next(q, s) == q);
                let tie = if largest.sure.contains(pair, 0) { 0.0 } else { 1e-9 };
                for a in 0..self.dynamics.actions() {
                    let (mut loss, mut moving) = (0.0, 0.0);
                    for (at, p) in self.dynamics.row(s, a).filter(|&(at, _)| at != s || !stays) {
                        loss += p * (satisfied[pair] - all[at]);
                        moving += p;
                    }
                    if loss <= tie * moving {
                        safe.insert(pair, a);
                    }
                }
            }
        }
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

    /// One backup of every action at every live pair: `visit(q, s, values)`. What arriving is worth is
    /// gathered once for each q, so that a pair reads its successors from one row.
    #[inline]
    fn backups(
        &self,
        arrival: &dyn Fn(u32, usize) -> f64,
        visit: &mut dyn FnMut(u32, usize, &[f64]),
    ) {
        let (mut arrivals, mut values) = (Vec::new(), alloc::vec![0.0; self.dynamics.actions()]);
        for q in self.task.live() {
            let all: Vec<f64> = (0..self.dynamics.arrivals()).map(|at| arrival(q, at)).collect();
            for s in 0..self.dynamics.states() {
                arrivals.clear();
                arrivals.extend(self.dynamics.successors(s).iter().map(|&to| all[to as usize]));
                let rows = self.dynamics.matrix(s).chunks_exact(arrivals.len());
                values.iter_mut().zip(rows).for_each(|(value, row)| *value = mean(row, &arrivals));
                visit(q, s, &values);
            }
        }
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
    fn evaluation(&self, policy: Policy, satisfied: Bounded, weighted: Bounded) -> Evaluation {
        let mut steps = weighted.values;
        let given = |(w, &p): (&mut f64, &f64)| *w = if p > 0.0 { *w / p } else { f64::NAN };
        steps.iter_mut().zip(&satisfied.values).for_each(given);
        self.set_end(End::Accepted, &mut steps, 0.0);
        let doubt = satisfied.error * satisfied.doubt;
        let satisfied = Values::new(self, satisfied).with_end(End::Accepted);
        Evaluation::new(policy, satisfied, steps, (weighted.error, doubt))
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

/// Σ p · value.
#[inline]
fn mean(row: &[f64], values: &[f64]) -> f64 {
    row.iter().zip(values).map(|(p, value)| p * value).sum()
}
