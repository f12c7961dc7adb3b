//! What a policy is worth against the best possible.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What a certificate rests on.
///
/// Documents say it, so that a reader knows whether a number was computed; every certificate that this
/// library makes is exact.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Basis {
    /// The world's model, solved.
    #[default]
    Exact,
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
}

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
}
