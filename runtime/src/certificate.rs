//! What a policy is worth against the best possible, and how that is shown.

pub(crate) mod face;

use alloc::vec::Vec;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use face::Face;

/// What a certificate or an estimate rests on.
///
/// Documents say it, so that a reader knows whether a number was computed or seen, and what its
/// interval promises.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Basis {
    /// The world's model, solved.
    #[default]
    Exact,
    /// Episodes, whose number was fixed beforehand. The intervals of probabilities are exact: each
    /// holds its number with at least the confidence.
    Trials,
    /// Episodes, counted as they came. Each interval holds its number with at least the confidence
    /// after every episode at once, so that it may have decided when to stop.
    Anytime,
    /// Episodes, with intervals whose confidence is approximate.
    Approximate,
}

impl Basis {
    /// That of an estimate which does not say.
    #[cfg(all(feature = "serde", feature = "std"))]
    #[inline]
    pub(crate) const fn unsaid() -> Self {
        Self::Approximate
    }
}

/// What a policy is worth against the best possible: exact means over the starts, `s_0` read.
///
/// For a world without a model there is [`Estimate`](crate::estimate::Estimate).
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::solve::{Basis, Certificate};
///
/// // Five cells in a row. Reach the right end; this policy first goes to the left one from cell 1.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
/// let Certificate { basis, satisfied, regret_satisfied, worst_regret_satisfied, .. } =
///     optimum.certify(&Policy::from_fn(&task, |_, s| usize::from(s != 1))?)?;
/// assert_eq!(basis, Basis::Exact);
/// // From 0 and 1 it goes round for ever: two starts of five.
/// assert!((satisfied - 0.6).abs() < 1e-9 && (regret_satisfied - 0.4).abs() < 1e-9);
/// assert_eq!(worst_regret_satisfied, 1.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// It prints as a few lines; see [`Report`].
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Certificate {
    /// What it rests on.
    #[cfg_attr(feature = "serde", serde(default, rename = "kind"))]
    pub basis: Basis,
    /// P(satisfied) of the policy.
    pub satisfied: f64,
    /// E\[steps\] of the policy, given success; `None` if it never succeeds.
    pub steps: Option<f64>,
    /// The largest possible P(satisfied).
    pub optimal_satisfied: f64,
    /// The smallest possible E\[steps\] among the policies of that P; `None` if that is 0.
    pub optimal_steps: Option<f64>,
    /// `optimal_satisfied - satisfied`.
    pub regret_satisfied: f64,
    /// `steps / optimal_steps - 1`; it can be negative where P is smaller than possible.
    pub regret_steps: Option<f64>,
    /// The largest regret in P(satisfied) of a single start: 0 if the policy is as safe as can be
    /// from everywhere.
    pub worst_regret_satisfied: f64,
    /// The fraction of pairs of a live q and a state in which the policy's action is optimal for
    /// the reward it was trained on, within 1e-6.
    pub fraction_optimal: f64,
    /// How far `satisfied` and `optimal_satisfied` may be from the true numbers: a bound that holds. None
    /// in documents of earlier versions.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub satisfied_error: Option<f64>,
    /// The same of `steps` and `optimal_steps`; none too where success is about as improbable as the
    /// error of its probability.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub steps_error: Option<f64>,
    /// P(satisfied) within a horizon, if it was asked for.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub within: Option<Within>,
}

impl fmt::Display for Certificate {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Face::of(self).fmt(f)
    }
}

/// P(satisfied) within a number of steps: means over the starts, `s_0` read.
///
/// [`Optimum::certify_within`](crate::solve::Optimum::certify_within) makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Within {
    /// The number of steps.
    pub steps: u64,
    /// P(satisfied within them) of the policy.
    pub satisfied: f64,
    /// The largest possible one, that of the best policy which knows how many steps are left.
    pub optimal_satisfied: f64,
}

/// What a policy is worth, all of it: its certificate, and what it loses from each start.
///
/// [`Optimum::report`](crate::solve::Optimum::report) makes it. It is made to be printed.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row. Reach the right end; this policy first goes to the left one from cell 1.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
/// let report = optimum.report_within(&Policy::from_fn(&task, |_, s| usize::from(s != 1))?, 3)?;
/// assert_eq!(format!("\n{report}"), "
///                          this policy  best possible    regret
/// P(satisfied)                0.600000       1.000000  0.400000
/// P(satisfied in 3 steps)     0.600000       0.800000  0.200000
/// E[steps | satisfied]          1.0000         2.0000         -
/// Computed from the model, mean over the starts: P to within 0, steps to within 7e-15.
/// 80.00 % of the actions are best for the reward, to within 1e-6 of it.
///
/// worst starts  P(satisfied)  best possible  E[steps | satisfied]  best possible
/// state 0           0.000000       1.000000                     -         4.0000
/// state 1           0.000000       1.000000                     -         3.0000
/// 2 of 5 starts lose something: at most 1.000000 of P(satisfied).");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Report {
    /// Means over the starts.
    pub certificate: Certificate,
    /// What it is worth from each start, those that lose most first: P(satisfied), then steps.
    pub starts: Vec<Start>,
}

impl Report {
    /// The certificate, and the worth from each start in any order.
    #[must_use]
    #[inline]
    pub fn new(certificate: Certificate, mut starts: Vec<Start>) -> Self {
        let key = |start: &Start| {
            let (satisfied, steps) = start.losses();
            (if satisfied > NOTHING { satisfied } else { 0.0 }, steps)
        };
        starts.sort_by(|a, b| {
            let (a, b) = (key(a), key(b));
            b.0.total_cmp(&a.0).then(b.1.total_cmp(&a.1))
        });
        Self { certificate, starts }
    }
}

impl fmt::Display for Report {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n\n", self.certificate)?;
        face::starts(self, f)
    }
}

/// A loss of P(satisfied) below this is none: it is ten times the error of what is solved.
const NOTHING: f64 = 1e-9;

/// What a policy is worth from one start, `s_0` read.
///
/// [`Optimum::starts`](crate::solve::Optimum::starts) lists one for each start.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Start {
    /// The state's number.
    pub state: usize,
    /// P(satisfied).
    pub satisfied: f64,
    /// E\[steps\] given success; `None` if it never succeeds.
    pub steps: Option<f64>,
    /// The largest possible P(satisfied).
    pub optimal_satisfied: f64,
    /// The smallest possible E\[steps\] among the policies of that P.
    pub optimal_steps: Option<f64>,
}

impl Start {
    /// By how much P(satisfied) is smaller than possible, and E\[steps\] larger than the fewest; 0
    /// steps where one of the two is not defined.
    ///
    /// ```
    /// use tltl::solve::Start;
    ///
    /// let (satisfied, steps) = (0.75, Some(12.5));
    /// let start = Start { state: 3, satisfied, steps, optimal_satisfied: 1.0, optimal_steps: Some(12.0) };
    /// assert_eq!(start.losses(), (0.25, 0.5));
    /// ```
    #[must_use]
    #[inline]
    pub fn losses(&self) -> (f64, f64) {
        let steps = self.steps.zip(self.optimal_steps).map_or(0.0, |(own, best)| own - best);
        (self.optimal_satisfied - self.satisfied, steps)
    }
}

/// A pair in which a policy's action is not optimal for a reward.
///
/// [`Optimum::mistakes`](crate::solve::Optimum::mistakes) lists them. A policy may have many and lose
/// nothing: pairs that it never comes to count here, and in no mean over the starts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Mistake {
    /// The automaton state.
    pub q: u32,
    /// The state's number.
    pub state: usize,
    /// The policy's action.
    pub action: usize,
    /// The best action.
    pub best: usize,
    /// By how much the value of the best action is larger.
    pub loss: f64,
}

/// What a shield does to a policy: means over the starts, `s_0` read.
///
/// [`Optimum::certify_shield`](crate::solve::Optimum::certify_shield) makes it.
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
    /// What the allowed actions can come to; none in documents of earlier versions.
    #[cfg_attr(feature = "serde", serde(default))]
    pub allowed: Option<Allowed>,
}

/// What the actions that a shield allows can come to, at worst and at best: means over the starts,
/// `s_0` read.
///
/// The shield costs `satisfied` against [`Certificate::optimal_satisfied`], and `steps` against
/// [`Certificate::optimal_steps`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Allowed {
    /// The ε of the shield's promise; none if it was made of what was seen.
    pub epsilon: Option<f64>,
    /// The fraction of the actions of live pairs that is allowed.
    pub fraction: f64,
    /// The largest P(the trap is entered) of a policy of allowed actions, whatever it remembers.
    pub lost: f64,
    /// The largest P(satisfied) of a policy of allowed actions.
    pub satisfied: f64,
    /// The fewest E\[steps\] for it, given success; `None` if `satisfied` is 0.
    pub steps: Option<f64>,
}
