//! Shields: "the behavior of the policy is strictly enforced by the FSA" (paper, Section 3).
//!
//! A [`Shield`] is a mask of actions for each pair (q, s). With a model it leaves only the actions
//! from which the trap is avoided in the long run with the largest possible probability; without
//! one it looks one step ahead in what was seen. It never leaves a pair without actions. What it
//! costs and gains is in [`Optimum::certify_shield`].
//!
//! A shield knows the trap, not the goal: where the goal itself lies beside the trap, staying away
//! for ever avoids it best, and the shield may do that. Laid over optimal safe policies of the three
//! compositions with traps in the study of rewards, each on 101 layouts, it gives away more than
//! 0.1 % of P(satisfied) in 58 of 303 cases, 3.6 % in the mean and up to 95 %: look at the
//! certificate before you take one.

use alloc::vec::Vec;

use crate::augmented::Labelled;
pub use crate::certificate::Shielded;
use crate::experience::Experience;
use crate::mismatch::Mismatch;
use crate::model::FiniteModel;
use crate::policy::Policy;
use crate::q::QTable;
use crate::reward::End;
use crate::solve::{Actions, Optimum, Problem};

/// Which actions are allowed where.
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
/// let shield = Shield::of_model(&problem);
/// assert!(!shield.allows(0, 1, 0) && shield.allows(0, 1, 1));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Shield {
    task: Labelled,
    actions: Actions,
}

impl Shield {
    /// The shield of a known model: the actions with which P(the trap is ever entered) can still be
    /// the smallest possible, within 1e-9.
    ///
    /// 1e-9 is ten times the error of the values: ties are common, and a shield must not bar an action
    /// for a rounding.
    #[must_use]
    #[inline]
    pub fn of_model(problem: &Problem) -> Self {
        let actions = problem.avoiding(&problem.smallest_lost());
        Self { task: problem.task().clone(), actions }
    }

    /// The shield of what was seen: the actions that entered the trap least often, as a fraction of
    /// the times that they were tried. It looks one step ahead only: it may lead to where every
    /// action is dangerous. An action never tried counts as harmless.
    ///
    /// ```
    /// use tltl::learn::Experience;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // Cell 2 is the goal, cell 0 is to be kept off. From 1, action 0 was seen to lead to 0.
    /// let careful = tltl! { |x: &i32| ({ *x } != 0) U ({ *x } == 2) };
    /// let task = Labelled::new(0..3, ["left", "right"], &careful)?;
    /// let mut seen = Experience::new(3, 2);
    /// seen.push(1, 0, 0);
    /// let shield = Shield::one_step(&seen, &task)?;
    /// assert!(!shield.allows(0, 1, 0) && shield.allows(0, 1, 1), "never tried counts as harmless");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the experience is of another world.
    #[inline]
    pub fn one_step(experience: &Experience, task: &Labelled) -> Result<Self, Mismatch> {
        task.check_world("experience", experience.states(), experience.actions())?;
        let mut actions = Actions::none(task.pairs(), task.actions());
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
                let risks: Vec<f64> = (0..task.actions()).map(risk).collect();
                let least = risks.iter().copied().fold(f64::INFINITY, f64::min);
                for (a, &risk) in risks.iter().enumerate() {
                    if risk <= least {
                        actions.insert(task.pair(q, s), a);
                    }
                }
            }
        }
        Ok(Self { task: task.clone(), actions })
    }

    /// The task that the shield is for.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// Whether action `a` is allowed in `s` at a live `q`.
    ///
    /// # Panics
    /// If there is no such pair or action.
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn allows(&self, q: u32, s: usize, a: usize) -> bool {
        assert!(s < self.task.states() && a < self.task.actions(), "a state and an action");
        self.actions.contains(self.task.pair(q, s), a)
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
    /// let shield = Shield::of_model(&Problem::new(&Dynamics::new(&row)?, &task)?);
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
        let allowed = (0..row.len()).filter(|&a| self.allows(q, s, a));
        let best = allowed.reduce(|best, a| if row[a] > row[best] { a } else { best });
        // Only at an end is nothing allowed, where the action does not matter.
        best.unwrap_or_else(|| table.greedy(q, s))
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
}

impl Optimum {
    /// What `shield` costs and gains when it is laid over the greedy policy of `table`.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let (optimum, shield) = (problem.optimum(&Rewards::default()), Shield::of_model(&problem));
    /// // An unlearned table goes left, into the trap, from the three cells between the ends. The shield
    /// // bars only the last step: it knows the trap, not the goal.
    /// let worth = optimum.certify_shield(&shield, &QTable::zeros(&task))?;
    /// assert!((worth.lost_before - 0.8).abs() < 1e-9 && (worth.lost_after - 0.2).abs() < 1e-9);
    /// assert!(worth.after.satisfied < 0.5 && worth.after.optimal_satisfied > 0.7);
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
        let (mut overruled, mut live) = (0, 0);
        for q in task.live() {
            let differ = |&s: &usize| before.act(q, s) != after.act(q, s);
            overruled += (0..task.states()).filter(differ).count();
            live += task.states();
        }
        Ok(Shielded {
            lost_before: problem.lost(&before)?.mean(),
            lost_after: problem.lost(&after)?.mean(),
            smallest_lost: problem.smallest_lost().mean(),
            overruled: overruled as f64 / live.max(1) as f64,
            before: self.certify(&before)?,
            after: self.certify(&after)?,
        })
    }
}
