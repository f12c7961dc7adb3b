//! Shields: "the behavior of the policy is strictly enforced by the FSA" (paper, Section 3).
//!
//! A [`Shield`] says which actions are allowed in each pair (q, s). It is made in three ways, and each
//! promises something else:
//!
//! | | needs | whoever keeps to allowed actions |
//! | --- | --- | --- |
//! | [`Shield::safest`] | a model | loses with at most the smallest possible P(lost) plus ε |
//! | [`Shield::keeping_best`] | a model | loses with at most the best policy's P(lost) plus ε, and can do all that the best policy does |
//! | [`Shield::one_step`] | what was seen | takes no step that was seen to be lost more often than another: no promise |
//!
//! The promise of the first two is about the long run, from every pair, of policies with a memory as of
//! those without. An action is allowed if it costs little P(lost) against a *baseline* policy, and
//! how little is decided by the worst that the allowed actions can do together. That this bounds every
//! policy takes five lines:
//!
//! 1. Let u(x) be the largest P(lost) from pair x of a *memoryless* policy of allowed actions; 1 at the trap.
//!    It solves u(x) = max over allowed a of Σ p(x' | x, a) u(x').
//! 2. Take any policy of allowed actions, and let P(n, x) be the largest probability, over what it may
//!    remember, that it is lost within n steps from x. Then P(0, x) ≤ u(x), for it is 1 at the trap and else 0.
//! 3. Its first action a is allowed, so P(n + 1, x) ≤ Σ p(x' | x, a) P(n, x') ≤ Σ p(x' | x, a) u(x') ≤ u(x).
//! 4. So P(lost) = lim P(n, x) ≤ u(x).
//! 5. u is solved for, and more actions are barred until u(x) ≤ P(lost) of the baseline + ε in every pair.
//!
//! The smallest P(lost) may be had by staying away from the goal for ever: on the paper's grid the safest
//! policy of `!c U a` waits where the trap is far. So a shield by [`Shield::safest`] can cost many steps, or
//! the goal itself; [`Optimum::certify_shield`] says how much. One by [`Shield::keeping_best`] costs
//! neither: the best policy is allowed under it.

mod around;
mod counts;
mod restricted;

use crate::augmented::Labelled;
pub use crate::certificate::{Allowed, Shielded};
use crate::experience::Experience;
use crate::mismatch::Mismatch;
use crate::model::FiniteModel;
use crate::policy::Policy;
use crate::q::QTable;
use crate::range::OutOfRange;
use crate::solve::{Actions, Objective, Optimum, Problem, Values};
use around::Around;
use counts::Counts;
use restricted::Restricted;

/// Which actions are allowed in each pair (q, s): at least one. Where the task has ended, all are.
///
/// What a shield promises depends on how it was [made](crate::shield).
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::shield::Shield;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end, and keep off the
/// // left one until then.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
/// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
/// let shield = Shield::safest(&problem, 0.0)?;
/// assert!(shield.allowed(0, 1).eq([1]) && shield.allowed(0, 2).eq([0, 1]));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Shield {
    task: Labelled,
    rule: Rule,
}

/// How a shield decides.
#[derive(Clone, Debug, PartialEq)]
enum Rule {
    /// By a model, for this ε.
    Exact { actions: Actions, epsilon: f64 },
    /// By counts.
    Seen(Counts),
}

impl Shield {
    /// The shield of the smallest P(lost): a policy of allowed actions, with or without a memory, loses
    /// with at most the smallest possible probability plus `epsilon`, from every pair.
    ///
    /// An `epsilon` below 1e-9, ten times the error of the solver's values, counts as 1e-9; but then no
    /// action is allowed that leaves a pair from which the trap can surely be avoided for one from which it
    /// cannot. The larger `epsilon` is, the more actions are allowed; with 1 all are.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // In 0: wait (action 0), or try for 1, which goes wrong one time in four (action 1).
    /// let risk = model::from_fn(3, 2, |s, a| match (s, a) {
    ///     (0, 1) => vec![(1, 0.75), (2, 0.25)],
    ///     _ => vec![(s, 1.0)],
    /// });
    /// let task = Labelled::of_model(&risk, &tltl! { |s: &usize| ({ *s } != 2) U ({ *s } == 1) })?;
    /// let problem = Problem::new(&Dynamics::new(&risk)?, &task)?;
    /// assert!(!Shield::safest(&problem, 0.2)?.allows(0, 0, 1), "who waits for ever is never lost");
    /// assert!(Shield::safest(&problem, 0.3)?.allows(0, 0, 1));
    /// assert!(Shield::safest(&problem, f64::NAN).is_err());
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `epsilon` is not in [0, 1].
    #[inline]
    pub fn safest(problem: &Problem, epsilon: f64) -> Result<Self, OutOfRange> {
        Self::around(problem, &around::safest(problem), epsilon)
    }

    /// The shield of the best policy for the task ([`Problem::best`]), whose actions are all allowed: the
    /// largest P(satisfied) and the fewest steps for it can be had under it. A policy of allowed actions
    /// loses with at most the best policy's probability plus `epsilon`, from every pair. (Where
    /// success is impossible, the safest policy is the best one.)
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // In 0: wait (0), try for 1, which goes wrong one time in four (1), or one time in two (2).
    /// let risk = model::from_fn(3, 3, |s, a| match (s, a) {
    ///     (0, 1) => vec![(1, 0.75), (2, 0.25)],
    ///     (0, 2) => vec![(1, 0.5), (2, 0.5)],
    ///     _ => vec![(s, 1.0)],
    /// });
    /// let task = Labelled::of_model(&risk, &tltl! { |s: &usize| ({ *s } != 2) U ({ *s } == 1) })?;
    /// let problem = Problem::new(&Dynamics::new(&risk)?, &task)?;
    /// assert!(Shield::keeping_best(&problem, 0.0)?.allowed(0, 0).eq([0, 1]));
    /// assert!(Shield::safest(&problem, 0.0)?.allowed(0, 0).eq([0]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `epsilon` is not in [0, 1].
    #[inline]
    pub fn keeping_best(problem: &Problem, epsilon: f64) -> Result<Self, OutOfRange> {
        Self::around(problem, &around::best(problem), epsilon)
    }

    /// The shield around a policy of this problem.
    #[inline]
    fn around(problem: &Problem, policy: &Policy, epsilon: f64) -> Result<Self, OutOfRange> {
        OutOfRange::check("epsilon", epsilon, (0.0..=1.0).contains(&epsilon), "in [0, 1]")?;
        let actions = Around::new(problem, policy).within(epsilon);
        Ok(Self { task: problem.task().clone(), rule: Rule::Exact { actions, epsilon } })
    }

    /// The shield of what was seen, at first of nothing: [`Self::observe`] and [`Self::extend`] tell it
    /// more, and a learner that [explores](crate::learn::Learner::train_shielded) behind it tells it
    /// each step.
    ///
    /// It bars the actions that entered the trap more often than another one in the same pair, by twice
    /// the standard error. It looks one step ahead only, and promises nothing: a trap must have been
    /// entered a few times by an action to be known there, and the way to where every action is dangerous
    /// is not barred.
    ///
    /// ```
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // Cell 2 is the goal, cell 0 is to be kept off. From 1, action 0 is seen to lead to 0.
    /// let careful = tltl! { |x: &i32| ({ *x } != 0) U ({ *x } == 2) };
    /// let task = Labelled::new(0..3, ["left", "right"], &careful)?;
    /// let mut shield = Shield::one_step(&task);
    /// shield.observe(1, 0, 0);
    /// assert!(shield.allowed(0, 1).eq([0, 1]), "once may be an accident");
    /// for _ in 0..5 {
    ///     shield.observe(1, 0, 0);
    ///     shield.observe(1, 1, 2);
    /// }
    /// assert!(shield.allowed(0, 1).eq([1]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn one_step(task: &Labelled) -> Self {
        Self { task: task.clone(), rule: Rule::Seen(Counts::new(task)) }
    }

    /// Tells the shield of a step from `s` to `to` under action `a`, at whatever automaton state. One
    /// that was made of a model knows it already.
    ///
    /// # Panics
    /// If there are no such states or action.
    #[track_caller]
    #[inline]
    pub fn observe(&mut self, s: usize, a: usize, to: usize) {
        assert!(s < self.task.states() && a < self.task.actions(), "a state and an action");
        if let Rule::Seen(counts) = &mut self.rule {
            counts.add(&self.task, (s, a, to), 1);
        }
    }

    /// Tells the shield of all steps of an experience.
    ///
    /// ```
    /// use tltl::learn::Experience;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// let careful = tltl! { |x: &i32| ({ *x } != 0) U ({ *x } == 2) };
    /// let task = Labelled::new(0..3, ["left", "right"], &careful)?;
    /// let (mut seen, mut shield) = (Experience::new(3, 2), Shield::one_step(&task));
    /// for (a, to) in [(0, 0), (1, 2)].repeat(6) {
    ///     seen.push(1, a, to);
    /// }
    /// shield.extend(&seen)?;
    /// assert!(shield.allowed(0, 1).eq([1]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the experience is of another world.
    #[inline]
    pub fn extend(&mut self, seen: &Experience) -> Result<(), Mismatch> {
        self.task.check_world("experience", seen.states(), seen.actions())?;
        let Rule::Seen(counts) = &mut self.rule else { return Ok(()) };
        for s in 0..seen.states() {
            for a in 0..seen.actions() {
                let tried = seen.tried(s, a) as f64;
                // A fraction of whole numbers, and 0 where nothing was tried.
                let mut add =
                    |to, p: f64| counts.add(&self.task, (s, a, to), (p * tried + 0.5) as u64);
                seen.transitions(s, a, &mut add);
                seen.endings(s, a, &mut add);
            }
        }
        Ok(())
    }

    /// The task that the shield is for.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// The ε of the promise; none if the shield was made of what was seen.
    #[must_use]
    #[inline]
    pub const fn epsilon(&self) -> Option<f64> {
        match self.rule {
            Rule::Exact { epsilon, .. } => Some(epsilon),
            Rule::Seen(_) => None,
        }
    }

    /// Whether action `a` is allowed in `s` at `q`.
    ///
    /// # Panics
    /// If there is no such pair or action.
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn allows(&self, q: u32, s: usize, a: usize) -> bool {
        assert!(s < self.task.states() && a < self.task.actions(), "a state and an action");
        let live = self.task.end(q).is_none();
        !live
            || match &self.rule {
                Rule::Exact { actions, .. } => actions.contains(self.task.pair(q, s), a),
                Rule::Seen(counts) => counts.allows(&self.task, (q, s), a),
            }
    }

    /// The actions that are allowed in `s` at `q`, ascending: at least one.
    ///
    /// # Panics
    /// If there is no such pair.
    #[track_caller]
    #[inline]
    pub fn allowed(&self, q: u32, s: usize) -> impl Iterator<Item = usize> {
        (0..self.task.actions()).filter(move |&a| self.allows(q, s, a))
    }

    /// The allowed action of the largest value in `table`; the lowest of equals.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let shield = Shield::safest(&Problem::new(&Dynamics::new(&row)?, &task)?, 0.0)?;
    /// let mut table = QTable::zeros(&task);
    /// for s in 1..4 {
    ///     table.row_mut(0, s)[0] = 1.0; // a table that likes the left, where the trap is
    /// }
    /// assert_eq!((table.greedy(0, 1), shield.greedy(&table, 0, 1)), (0, 1));
    /// assert_eq!((shield.policy(&table)?.act(0, 1), shield.policy(&table)?.act(0, 3)), (1, 0));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If there is no such pair in the shield's task or in the table's.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn greedy(&self, table: &QTable, q: u32, s: usize) -> usize {
        let row = table.row(q, s);
        let best = self.allowed(q, s).reduce(|best, a| if row[a] > row[best] { a } else { best });
        best.unwrap_or_default()
    }

    /// The greedy policy under the shield.
    ///
    /// # Errors
    /// If the table is of another task or another world.
    #[inline]
    pub fn policy(&self, table: &QTable) -> Result<Policy, Mismatch> {
        self.task.check("a table", table.task())?;
        let states = self.task.states();
        let greedy = |pair| self.greedy(table, (pair / states) as u32, pair % states) as u32;
        Ok(Policy::from_table(&self.task, (0..self.task.pairs()).map(greedy).collect()))
    }

    /// For each pair the largest P(the trap is ever entered) of a policy of allowed actions, whatever it
    /// remembers; 1 at the trap.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let safe = Shield::safest(&problem, 0.0)?.largest_lost(&problem)?;
    /// assert_eq!([1, 2, 3].map(|s| safe.at(0, s)), [0.0; 3]);
    /// let any = Shield::one_step(&task).largest_lost(&problem)?;
    /// assert_eq!([1, 2, 3].map(|s| any.at(0, s)), [1.0; 3], "a shield that has seen nothing");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the problem is another task or another world.
    #[inline]
    pub fn largest_lost(&self, problem: &Problem) -> Result<Values, Mismatch> {
        problem.task().check("a shield", &self.task)?;
        Ok(problem.lost_within(&self.actions(), Objective::Largest))
    }

    /// All that is allowed, as a table.
    #[inline]
    fn actions(&self) -> Actions {
        let mut actions = Actions::none(self.task.pairs(), self.task.actions());
        for q in self.task.live() {
            for s in 0..self.task.states() {
                self.allowed(q, s).for_each(|a| actions.insert(self.task.pair(q, s), a));
            }
        }
        actions
    }
}

impl Optimum {
    /// What `shield` costs and gains when it is laid over the greedy policy of `table`, and what the
    /// actions that it allows can come to at worst and at best.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let (optimum, shield) = (problem.optimum(&Rewards::default()), Shield::safest(&problem, 0.0)?);
    /// // An unlearned table goes left, into the trap, from the three cells between the ends. The shield
    /// // bars only the last step: it knows the trap, not the goal.
    /// let worth = optimum.certify_shield(&shield, &QTable::zeros(&task))?;
    /// assert!((worth.lost_before - 0.8).abs() < 1e-9 && (worth.lost_after - 0.2).abs() < 1e-9);
    /// assert!(worth.after.satisfied < 0.5 && worth.after.optimal_satisfied > 0.7);
    /// // No policy under it loses more often, and the best one is as good as without it.
    /// let allowed = worth.allowed.expect("it is computed");
    /// assert!((allowed.lost - 0.2).abs() < 1e-9 && (allowed.satisfied - 0.8).abs() < 1e-9);
    /// assert_eq!(allowed.steps, worth.after.optimal_steps);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the shield or the table is of another task or another world.
    #[inline]
    pub fn certify_shield(&self, shield: &Shield, table: &QTable) -> Result<Shielded, Mismatch> {
        let (problem, task) = (self.problem(), self.problem().task());
        task.check("a shield", &shield.task)?;
        let (before, after) = (table.policy(), shield.policy(table)?);
        let mut overruled = 0;
        for q in task.live() {
            let differ = |&s: &usize| before.act(q, s) != after.act(q, s);
            overruled += (0..task.states()).filter(differ).count();
        }
        let live = task.live().count() * task.states();
        Ok(Shielded {
            lost_before: problem.lost(&before)?.mean(),
            lost_after: problem.lost(&after)?.mean(),
            smallest_lost: problem.smallest_lost().mean(),
            overruled: overruled as f64 / live.max(1) as f64,
            before: self.certify(&before)?,
            after: self.certify(&after)?,
            allowed: Some(self.worth_allowing(shield)),
        })
    }

    /// What the actions that `shield` allows can come to.
    #[inline]
    fn worth_allowing(&self, shield: &Shield) -> Allowed {
        let (problem, task, actions) = (self.problem(), self.problem().task(), shield.actions());
        let best = Restricted { problem, actions: &actions }.best();
        let count = |q| (0..task.states()).map(move |s| shield.allowed(q, s).count());
        let all = task.live().count() * task.states() * task.actions();
        Allowed {
            epsilon: shield.epsilon(),
            fraction: task.live().flat_map(count).sum::<usize>() as f64 / all.max(1) as f64,
            lost: problem.lost_within(&actions, Objective::Largest).mean(),
            satisfied: best.mean_satisfied(),
            steps: best.mean_steps(),
        }
    }
}
