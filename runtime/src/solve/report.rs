//! What a policy is worth, in one call.

use super::{Certificate, Optimum, Report, Within};
use crate::mismatch::Mismatch;
use crate::policy::Policy;

impl Optimum {
    /// What `policy` is worth against the best possible, and from which starts it loses most: made to
    /// be printed.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // A step to the goal succeeds one time in four, and else stays.
    /// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
    /// let task = Labelled::of_model(&try_hard, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let optimum = Problem::new(&Dynamics::new(&try_hard)?, &task)?.optimum(&Rewards::default());
    /// let report = optimum.report(&Policy::from_fn(&task, |_, _| 0)?)?;
    /// assert_eq!(format!("\n{report}"), "
    ///                       this policy  best possible  regret
    /// P(satisfied)             1.000000       1.000000       0
    /// E[steps | satisfied]       2.0000         2.0000     0 %
    /// Computed from the model, mean over the starts: P to within 0, steps to within 7e-15.
    /// 100.00 % of the actions are best for the reward, to within 1e-6 of it.
    ///
    /// From every start it is as good as can be.");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn report(&self, policy: &Policy) -> Result<Report, Mismatch> {
        let own = self.problem().evaluate(policy)?;
        Ok(Report::new(self.certificate_of(&own)?, self.starts_of(&own)))
    }

    /// The same with P(satisfied) within so many steps, beside the largest possible: see [`Report`].
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn report_within(&self, policy: &Policy, steps: u64) -> Result<Report, Mismatch> {
        let Report { certificate, starts } = self.report(policy)?;
        let within = Some(self.within(policy, steps)?);
        Ok(Report { certificate: Certificate { within, ..certificate }, starts })
    }

    /// The [certificate](Self::certify) of `policy` with P(satisfied) within so many steps, beside the
    /// largest possible: where episodes are cut there, no policy has more.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // A step to the goal succeeds one time in four, and else stays.
    /// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
    /// let task = Labelled::of_model(&try_hard, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let optimum = Problem::new(&Dynamics::new(&try_hard)?, &task)?.optimum(&Rewards::default());
    /// let certificate = optimum.certify_within(&Policy::from_fn(&task, |_, _| 0)?, 1)?;
    /// // One start of two is at the goal, the other comes there one time in four.
    /// assert_eq!(certificate.within.map(|within| within.satisfied), Some(0.625));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If it is a policy for another task or another world.
    #[inline]
    pub fn certify_within(&self, policy: &Policy, steps: u64) -> Result<Certificate, Mismatch> {
        let within = Some(self.within(policy, steps)?);
        Ok(Certificate { within, ..self.certify(policy)? })
    }

    #[inline]
    fn within(&self, policy: &Policy, steps: u64) -> Result<Within, Mismatch> {
        let satisfied = self.problem().satisfied_within(policy, steps)?.mean();
        let optimal_satisfied = self.problem().largest_satisfied_within(steps).mean();
        Ok(Within { steps, satisfied, optimal_satisfied })
    }
}
