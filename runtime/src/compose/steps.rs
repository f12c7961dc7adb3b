//! The steps of Algorithm 2 with their certificates, and the best of them.

use alloc::vec::Vec;
use core::fmt;

use super::{Combine, Composition};
use crate::certificate::Certificate;
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::policy::Policy;
use crate::solve::Problem;

/// P(satisfied) that differ by less are equal, and so are steps that differ by as much of themselves: ten
/// times the error of the solver's values.
const EQUAL: f64 = 1e-9;

/// A part of Algorithm 2.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
    /// Step 2: the skills' values, [combined](Combine).
    Combined,
    /// Steps 3–5: the values of that policy in the product.
    Compensated,
    /// Step 6: the optimum of the product.
    Refined,
}

impl fmt::Display for Stage {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Self::Combined => "combined (step 2)",
            Self::Compensated => "compensated (steps 3-5)",
            Self::Refined => "refined (step 6)",
        })
    }
}

/// The policy that a stage comes to, and what it is worth.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// The stage.
    pub stage: Stage,
    /// Its greedy policy.
    pub policy: Policy,
    /// What that is worth in the world that was composed on.
    pub certificate: Certificate,
}

/// All stages in their order: the certificate of each is what the next one starts from. Printed, they are
/// a table.
///
/// [`Composition::run`] makes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Steps {
    all: Vec<Step>,
    best: usize,
}

impl Steps {
    /// The steps, in their order.
    #[must_use]
    #[inline]
    pub fn all(&self) -> &[Step] {
        &self.all
    }

    /// The best step: the largest P(satisfied), then the fewest steps; of equal ones the first. On
    /// [what was seen](Composition::run_on_seen), that of the largest P up to a tolerance.
    #[must_use]
    #[inline]
    pub fn best(&self) -> &Step {
        &self.all[self.best]
    }

    /// The policy of the best step.
    #[must_use]
    #[inline]
    pub fn policy(&self) -> &Policy {
        &self.best().policy
    }

    /// The best of them is the last where that has been chosen with more in view than the certificates.
    #[inline]
    fn new(all: Vec<Step>, is_last_best: bool) -> Self {
        let better = |one: &Certificate, other: &Certificate| {
            let (more, steps) = (one.satisfied - other.satisfied, |c: &Certificate| c.steps);
            let fewer = steps(one).unwrap_or(f64::INFINITY) * (1.0 + EQUAL)
                < steps(other).unwrap_or(f64::INFINITY);
            more > EQUAL || (more >= -EQUAL && fewer)
        };
        let best = match is_last_best {
            true => all.len() - 1,
            false => (0..all.len()).fold(0, |best, i| {
                if better(&all[i].certificate, &all[best].certificate) { i } else { best }
            }),
        };
        Self { all, best }
    }
}

impl fmt::Display for Steps {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, Step { stage, certificate, .. }) in self.all.iter().enumerate() {
            let Certificate { satisfied, regret_satisfied, steps, .. } = certificate;
            write!(
                f,
                "{stage:<24} P(satisfied) {satisfied:.6}, {regret_satisfied:.6} below the best"
            )?;
            match steps {
                Some(steps) => write!(f, ", E[steps] {steps:.4}")?,
                None => write!(f, ", never satisfied")?,
            }
            writeln!(f, "{}", if i == self.best { "  <- best" } else { "" })?;
        }
        Ok(())
    }
}

impl Composition<'_> {
    /// Algorithm 2 on `dynamics`: every stage with its certificate, and the best of them. The result is
    /// never worse than any stage of it.
    ///
    /// The certificates are exact for the world that `dynamics` is: that of a model; what was seen is for
    /// [`Self::run_on_seen`]. Where acceptance alone is paid, the last stage is the policy of the largest
    /// P(satisfied) and then of the fewest steps ([`Problem::best`]), for that is what such rewards stand
    /// for. Other rewards are taken at their word, and what is optimal for them may be worth less to the
    /// task than a stage before.
    ///
    /// ```
    /// use tltl::compose::Stage;
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Two skills: reach an end each.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let left = tltl! { |s: &usize| F ({ *s } == 0) };
    /// let right = tltl! { |s: &usize| F ({ *s } == 4) };
    /// let (world, rewards) = (Dynamics::new(&row)?, Rewards::acceptance());
    /// let one = Problem::new(&world, &Labelled::of_model(&row, &left)?)?.optimal_q(&rewards);
    /// let two = Problem::new(&world, &Labelled::of_model(&row, &right)?)?.optimal_q(&rewards);
    ///
    /// let product = Product::conjunction(&[&left, &right]);
    /// let task = Labelled::of_model(&row, &product)?;
    /// let composition = Composition::new(&product, &task, &[&one, &two], rewards)?;
    /// let steps = composition.run(&world, Combine::Sum)?;
    /// print!("{steps}");
    /// let stages = steps.all().iter().map(|step| step.stage);
    /// assert!(stages.eq([Stage::Combined, Stage::Compensated, Stage::Refined]));
    /// assert_eq!(steps.best().certificate.regret_steps, Some(0.0));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `dynamics` is of another world.
    #[inline]
    pub fn run(&self, dynamics: &Dynamics, combine: Combine) -> Result<Steps, Mismatch> {
        self.carry_out(dynamics, combine, false)
    }

    /// Algorithm 2 on what was seen: as [`Self::run`], but probabilities that were counted are known up to
    /// sampling, and so are the certificates.
    ///
    /// So where acceptance alone is paid, the last stage is [finished](Self::refined), and it is the best one:
    /// what another has more of P(satisfied) is within the tolerance, and may be chance. On `!c U a` and
    /// `!c U b` of the paper's grid, each seen for 3,000,000 steps, it gives 0.012 % of P away and takes no
    /// more than the fewest steps, where the largest P of what was seen gives 0.010 % away and takes 2.5 %
    /// more steps (the worst of 10 seeds).
    ///
    /// ```
    /// use tltl::compose::Operator;
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. A skill for each end, learned.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let left = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 0) })?;
    /// let right = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let mut one = Learner::new(&left, Settings::default(), 1);
    /// let mut two = Learner::new(&right, Settings::default(), 2);
    /// one.train(&mut env, 500)?;
    /// two.train(&mut env, 500)?;
    /// let (one_q, two_q) = (one.q(), two.q());
    ///
    /// let mut seen = one.experience().clone();
    /// seen.extend(two.experience())?;
    /// let both = Composition::of(Operator::Conjunction, &[&one_q, &two_q], one.rewards(), 100)?;
    /// let steps = both.run_on_seen(&Dynamics::new(&seen)?, Combine::Sum)?;
    /// let problem = Problem::new(env.dynamics(), both.task())?;
    /// let worth = problem.optimum(&one.rewards()).certify(steps.policy())?;
    /// assert_eq!((worth.regret_satisfied, worth.regret_steps), (0.0, Some(0.0)));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `seen` is of another world.
    #[inline]
    pub fn run_on_seen(&self, seen: &Dynamics, combine: Combine) -> Result<Steps, Mismatch> {
        self.carry_out(seen, combine, true)
    }

    #[inline]
    fn carry_out(
        &self,
        dynamics: &Dynamics,
        combine: Combine,
        is_counted: bool,
    ) -> Result<Steps, Mismatch> {
        let optimum = Problem::new(dynamics, &self.task)?.optimum(&self.rewards);
        let (combined, problem) = (self.initial(combine), optimum.problem());
        let compensated = self.compensated_on(problem, &combined);
        let for_task = self.rewards.pays_acceptance_alone();
        let refined = match (for_task, is_counted) {
            (true, true) => problem.finished(&self.rewards).policy(),
            (true, false) => optimum.best().policy().clone(),
            (false, _) => optimum.q().policy(),
        };
        let stages = [
            (Stage::Combined, combined.policy()),
            (Stage::Compensated, compensated.policy()),
            (Stage::Refined, refined),
        ];
        let step = |(stage, policy): (Stage, Policy)| {
            let certificate = optimum.certify(&policy)?;
            Ok(Step { stage, policy, certificate })
        };
        let all = stages.into_iter().map(step).collect::<Result<_, Mismatch>>()?;
        Ok(Steps::new(all, for_task && is_counted))
    }
}
