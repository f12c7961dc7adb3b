//! What a policy is worth from every pair (q, s).
//!
//! [`Values`] are a number for each pair; an [`Evaluation`] is P(satisfied) and E\[steps\] of one
//! policy. Both know their problem, so they also have means over the starts.

use alloc::vec::Vec;

use super::Problem;
use super::bounded::Bounded;
use crate::policy::Policy;
use crate::reward::End;

/// A number for each automaton state q and world state s, s having been read.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Three cells; the only action walks from 0 to 1 and then to either side.
/// let fork = model::from_fn(4, 1, |s, _| if s == 1 { vec![(2, 0.5), (3, 0.5)] } else { vec![(s.max(1), 1.0)] });
/// let task = Labelled::of_model(&fork, &tltl! { |s: &usize| ({ *s } != 3) U ({ *s } == 2) })?;
/// let problem = Problem::new(&Dynamics::new(&fork)?, &task)?;
/// let satisfied = problem.largest_satisfied();
/// assert_eq!((satisfied.at(0, 0), satisfied.at(0, 1)), (0.5, 0.5));
/// assert_eq!(satisfied.mean(), (0.5 + 0.5 + 1.0 + 0.0) / 4.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Values {
    problem: Problem,
    /// Indexed `q * states + s`.
    values: Vec<f64>,
    error: f64,
}

impl Values {
    #[inline]
    pub(super) fn new(problem: &Problem, bounded: Bounded) -> Self {
        let Bounded { values, error, .. } = bounded;
        Self { problem: problem.clone(), values, error }
    }

    /// The same with 1 at an end.
    #[inline]
    pub(super) fn with_end(mut self, end: End) -> Self {
        self.problem.set_end(end, &mut self.values, 1.0);
        self
    }

    /// The number at (q, s).
    ///
    /// # Panics
    /// If there is no such pair.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn at(&self, q: u32, s: usize) -> f64 {
        self.values[self.problem.task.pair(q, s)]
    }

    /// All numbers, indexed `q * states + s`.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(3, 1, |s, _| [((s + 1).min(2), 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 1) U ({ *s } == 2) })?;
    /// let satisfied = Problem::new(&Dynamics::new(&row)?, &task)?.largest_satisfied();
    /// assert_eq!(satisfied.as_slice().len(), 3 * 3, "live, accepted or lost, in three cells");
    /// assert_eq!(satisfied.as_slice()[..3], [0.0, 1.0, 1.0], "from 0 the way leads through 1");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn as_slice(&self) -> &[f64] {
        &self.values
    }

    /// The mean over the starts, `s_0` read.
    #[must_use]
    #[inline]
    pub fn mean(&self) -> f64 {
        self.problem.mean(|pair| self.values[pair])
    }

    /// How far any of the numbers may be from the true one: a bound that holds, whatever the world is.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Of two ways of a long walk, one is lost one time in three.
    /// let walk = model::from_fn(41, 2, |s, a| match (s, a) {
    ///     (0 | 40, _) => vec![(s, 1.0)],
    ///     (_, 0) => vec![(s - 1, 0.5), (s + 1, 0.5)],
    ///     (_, _) => vec![(s - 1, 0.25), (s + 1, 0.75)],
    /// });
    /// let task = Labelled::of_model(&walk, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 40) })?;
    /// let problem = Problem::new(&Dynamics::new(&walk)?, &task)?;
    /// let satisfied = problem.largest_satisfied();
    /// // The ruin of a gambler: 1 - 3^-k, over 1 - 3^-40.
    /// let exact = (1.0 - 3.0_f64.powi(-2)) / (1.0 - 3.0_f64.powi(-40));
    /// assert!((satisfied.at(0, 2) - exact).abs() <= satisfied.error() + 1e-15);
    /// assert!(satisfied.error() < 1e-12);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub const fn error(&self) -> f64 {
        self.error
    }
}

/// P(satisfied) and E\[steps\] of a policy from every pair (q, s), s having been read.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
/// let timid = Policy::from_fn(&task, |_, s| usize::from(s > 1))?; // never leaves the left end
/// let worth = problem.evaluate(&timid)?;
/// assert_eq!((worth.satisfied().at(0, 1), worth.steps(0, 1)), (0.0, None));
/// assert_eq!((worth.satisfied().at(0, 2), worth.steps(0, 2)), (1.0, Some(2.0)));
/// assert!((worth.mean_satisfied() - 0.6).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evaluation {
    policy: Policy,
    satisfied: Values,
    /// NaN where the task is never satisfied.
    steps: Vec<f64>,
    /// Of steps times P: relative, and absolute beside.
    error: (f64, f64),
}

impl Evaluation {
    #[inline]
    pub(super) const fn new(
        policy: Policy,
        satisfied: Values,
        steps: Vec<f64>,
        error: (f64, f64),
    ) -> Self {
        Self { policy, satisfied, steps, error }
    }

    /// The same where `satisfied` stands for other numbers too, from which it is no further than `error`.
    #[inline]
    pub(super) fn standing_within(mut self, error: f64) -> Self {
        self.satisfied.error = self.satisfied.error.max(error);
        self
    }

    /// The policy.
    #[must_use]
    #[inline]
    pub const fn policy(&self) -> &Policy {
        &self.policy
    }

    /// The probability that the task is satisfied, within any number of steps.
    #[must_use]
    #[inline]
    pub const fn satisfied(&self) -> &Values {
        &self.satisfied
    }

    /// The expected steps to satisfaction from (q, s), given that it comes; `None` where it never
    /// does.
    ///
    /// # Panics
    /// If there is no such pair.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn steps(&self, q: u32, s: usize) -> Option<f64> {
        finite(self.steps[self.satisfied.problem.task.pair(q, s)])
    }

    /// P(satisfied), mean over the starts, `s_0` read.
    #[must_use]
    #[inline]
    pub fn mean_satisfied(&self) -> f64 {
        self.means().0
    }

    /// E\[steps\] given success, mean over the starts, `s_0` read; `None` if success is impossible.
    /// Starts count by how often they succeed.
    #[must_use]
    #[inline]
    pub fn mean_steps(&self) -> Option<f64> {
        finite(self.means().1)
    }

    /// Both means; infinite steps if success is impossible.
    #[inline]
    pub(super) fn means(&self) -> (f64, f64) {
        let problem = &self.satisfied.problem;
        let p = |pair: usize| self.satisfied.values[pair];
        let weighted = |pair| if p(pair) > 0.0 { p(pair) * self.steps[pair] } else { 0.0 };
        let (satisfied, weighted) = (problem.mean(p), problem.mean(weighted));
        (satisfied, if satisfied > 0.0 { weighted / satisfied } else { f64::INFINITY })
    }

    /// How far [`Self::mean_steps`] may be from the true mean: a bound that holds. Where success is about
    /// as improbable as the error of its probability it is infinite.
    #[must_use]
    #[inline]
    pub fn steps_error(&self) -> f64 {
        let (satisfied, steps) = self.means();
        let (relative, absolute) = self.error;
        let error = self.satisfied.error;
        if satisfied <= 0.0 && error == 0.0 {
            return 0.0;
        } else if error >= satisfied || !relative.is_finite() || !absolute.is_finite() {
            return f64::INFINITY;
        }
        let weighted = relative * satisfied * steps + (1.0 + relative) * absolute;
        (weighted + steps * error) / (satisfied - error)
    }

    /// P(satisfied) and E\[steps\] from the pair with a number.
    #[inline]
    pub(super) fn at_pair(&self, pair: usize) -> (f64, Option<f64>) {
        (self.satisfied.values[pair], finite(self.steps[pair]))
    }
}

impl Problem {
    /// The mean over the starts, `s_0` read: exact where all are worth the same, for it is divided by
    /// what the weights sum to.
    #[inline]
    pub(super) fn mean(&self, of: impl Fn(usize) -> f64) -> f64 {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (s, pair) in self.start_pairs() {
            let weight = self.dynamics.starts()[s];
            (sum, weights) = (sum + weight * of(pair), weights + weight);
        }
        sum / weights
    }

    /// The states in which an episode can start, with their pairs once they are read.
    #[inline]
    pub(super) fn start_pairs(&self) -> impl Iterator<Item = (usize, usize)> {
        let starts = self.dynamics.starts().iter().enumerate().filter(|&(_, &weight)| weight > 0.0);
        starts.map(|(s, _)| (s, self.task.pair(self.task.start(s), s)))
    }
}

#[inline]
pub(super) fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}
