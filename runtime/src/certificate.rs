//! What a policy is worth against the best possible.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

/// What a certificate rests on.
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
