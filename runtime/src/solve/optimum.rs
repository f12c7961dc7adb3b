//! What policies are judged against.
//!
//! Two things are meant by "optimal", and they differ: the largest value for some *rewards*, which is
//! what learners are trained for, and the largest P(satisfied) with the fewest steps, which is what
//! the *task* wants. An [`Optimum`] has both; a certificate says how far a policy is from each.

use alloc::vec::Vec;

use super::evaluation::finite;
use super::{Basis, Certificate, Evaluation, Mistake, Problem, Start};
use crate::mismatch::Mismatch;
use crate::policy::Policy;
use crate::q::QTable;
use crate::reward::Rewards;

/// By how much an action may be worse than the best and still counts as optimal: learned policies break
/// ties by rounding.
const TOLERANCE: f64 = 1e-6;

/// The optimum of a [`Problem`]: the optimal values for some rewards, and the policy that satisfies
/// the task most probably and then soonest. Policies are judged against it.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
/// let timid = Policy::from_fn(&task, |_, s| usize::from(s > 1))?; // never leaves the left end
/// let certificate = optimum.certify(&timid)?;
/// assert!((certificate.regret_satisfied - 0.4).abs() < 1e-9); // from two starts of five
/// assert_eq!(optimum.mistakes(&timid)?.len(), 2);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Optimum {
    problem: Problem,
    q: QTable,
    q_error: f64,
    best: Evaluation,
}

impl Optimum {
    #[inline]
    pub(super) fn new(problem: Problem, rewards: &Rewards) -> Self {
        let (q, q_error) = problem.bounded_q(rewards);
        Self { q, q_error, best: problem.best(), problem }
    }

    /// The optimum of the same problem for other rewards. What the task itself wants is not solved
    /// again.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::reward::Mode;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let progress = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::progress());
    /// let shaped = progress.with_rewards(&Rewards::of(Mode::Shaped));
    /// assert_eq!(progress.q().greedy(0, 2), shaped.q().greedy(0, 2));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn with_rewards(&self, rewards: &Rewards) -> Self {
        let (problem, best) = (self.problem.clone(), self.best.clone());
        let (q, q_error) = problem.bounded_q(rewards);
        Self { q, q_error, best, problem }
    }

    /// The problem.
    #[must_use]
    #[inline]
    pub const fn problem(&self) -> &Problem {
        &self.problem
    }

    /// The optimal action values Q* for the rewards.
    #[must_use]
    #[inline]
    pub const fn q(&self) -> &QTable {
        &self.q
    }

    /// How far any of the [action values](Self::q) may be from the true one: a bound that holds.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // A step to the goal succeeds one time in four, and else stays.
    /// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
    /// let task = Labelled::of_model(&try_hard, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let rewards = Rewards::acceptance().with_gamma(0.5)?;
    /// let optimum = Problem::new(&Dynamics::new(&try_hard)?, &task)?.optimum(&rewards);
    /// // V = 0.25 + 0.75 · 0.5 V.
    /// assert!((optimum.q().max(0, 0) - 0.4).abs() <= optimum.q_error() + 1e-16);
    /// assert!(optimum.q_error() < 1e-14);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub const fn q_error(&self) -> f64 {
        self.q_error
    }

    /// The best policy for the task itself: see [`Problem::best`].
    #[must_use]
    #[inline]
    pub const fn best(&self) -> &Evaluation {
        &self.best
    }

    /// What `policy` is worth, against the best possible.
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn certify(&self, policy: &Policy) -> Result<Certificate, Mismatch> {
        self.certificate_of(&self.problem.evaluate(policy)?)
    }

    #[inline]
    pub(super) fn certificate_of(&self, own: &Evaluation) -> Result<Certificate, Mismatch> {
        let (satisfied, steps) = own.means();
        let (optimal_satisfied, optimal_steps) = self.best.means();
        let ratio = if steps > 0.0 { steps / optimal_steps - 1.0 } else { 0.0 };
        Ok(Certificate {
            basis: Basis::Exact,
            satisfied,
            steps: finite(steps),
            optimal_satisfied,
            optimal_steps: finite(optimal_steps),
            regret_satisfied: optimal_satisfied - satisfied,
            regret_steps: finite(steps).and(finite(ratio)),
            worst_regret_satisfied: self.worst_regret(own),
            fraction_optimal: self.fraction_optimal(own.policy())?,
            satisfied_error: Some(own.satisfied().error().max(self.best.satisfied().error())),
            steps_error: finite(own.steps_error().max(self.best.steps_error())),
            within: None,
        })
    }

    /// What `policy` is worth from each state in which an episode can start: a mean over the starts
    /// may hide one from which it fails.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
    /// let timid = Policy::from_fn(&task, |_, s| usize::from(s > 1))?; // never leaves the left end
    /// let fails = optimum.starts(&timid)?.into_iter().filter(|start| start.satisfied < 1.0);
    /// assert!(fails.map(|start| start.state).eq([0, 1]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn starts(&self, policy: &Policy) -> Result<Vec<Start>, Mismatch> {
        Ok(self.starts_of(&self.problem.evaluate(policy)?))
    }

    #[inline]
    pub(super) fn starts_of(&self, own: &Evaluation) -> Vec<Start> {
        let start = |(state, pair)| {
            let ((satisfied, steps), (optimal_satisfied, optimal_steps)) =
                (own.at_pair(pair), self.best.at_pair(pair));
            Start { state, satisfied, steps, optimal_satisfied, optimal_steps }
        };
        self.problem.start_pairs().map(start).collect()
    }

    /// The pairs of a live q and a state in which the action of `policy` is worse for the rewards
    /// than the best one by more than 1e-6, in the order of q, then s.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let optimum = problem.optimum(&Rewards::acceptance().with_gamma(0.5)?);
    /// let mistaken = optimum.mistakes(&Policy::from_fn(&task, |_, s| usize::from(s != 3))?)?;
    /// let (at, loss) = (&mistaken[0], mistaken[0].loss);
    /// assert_eq!((at.state, at.action, at.best, mistaken.len()), (3, 0, 1, 1));
    /// assert!((loss - 0.75).abs() < 1e-9, "1 now, or 0.25 after the way back");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn mistakes(&self, policy: &Policy) -> Result<Vec<Mistake>, Mismatch> {
        let task = self.problem.task();
        policy.must_be_for(task)?;
        let mut mistakes = Vec::new();
        for q in task.live() {
            for state in 0..task.states() {
                let (action, best) = (policy.act(q, state), self.q.greedy(q, state));
                let row = self.q.row(q, state);
                let loss = row[best] - row[action];
                if loss > TOLERANCE {
                    mistakes.push(Mistake { q, state, action, best, loss });
                }
            }
        }
        Ok(mistakes)
    }

    /// The fraction of pairs of a live q and a state in which the action of `policy` is optimal for
    /// the rewards, within 1e-6.
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn fraction_optimal(&self, policy: &Policy) -> Result<f64, Mismatch> {
        self.fraction_optimal_at(self.problem.task().live(), policy)
    }

    /// The same over the automaton states `at`; 1 if there are none.
    ///
    /// Composition is judged so where it is hard: at the automaton states in which more than one skill
    /// is still to be done.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row. First the right end, then the left one; this policy never turns round.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } == 4) T ({ *s } == 0) })?;
    /// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
    /// let right = Policy::from_fn(&task, |_, _| 1)?;
    /// assert_eq!(optimum.fraction_optimal_at([0], &right)?, 1.0);
    /// assert_eq!(optimum.fraction_optimal_at([1], &right)?, 0.0);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    pub fn fraction_optimal_at(
        &self,
        at: impl IntoIterator<Item = u32>,
        policy: &Policy,
    ) -> Result<f64, Mismatch> {
        policy.must_be_for(self.problem.task())?;
        let (states, mut pairs, mut optimal) = (self.problem.task().states(), 0, 0);
        for q in at {
            for s in 0..states {
                let chosen = self.q.row(q, s)[policy.act(q, s)];
                optimal += usize::from(chosen >= self.q.max(q, s) - TOLERANCE);
            }
            pairs += states;
        }
        Ok(if pairs == 0 { 1.0 } else { optimal as f64 / pairs as f64 })
    }

    #[inline]
    fn worst_regret(&self, own: &Evaluation) -> f64 {
        let mut worst: f64 = 0.0;
        for (_, pair) in self.problem.start_pairs() {
            worst = worst.max(self.best.at_pair(pair).0 - own.at_pair(pair).0);
        }
        worst
    }
}
