//! What is asked of a problem: the best or the worst of some actions, or what a policy comes to.

use super::Actions;

/// Which of several policies is asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Objective {
    /// The one of the smallest value.
    Smallest,
    /// The one of the largest value.
    Largest,
}

/// Which actions may be taken.
#[derive(Clone, Copy)]
pub(super) enum Choice<'a> {
    All,
    Of(&'a Actions),
    Policy(&'a [u32]),
}

/// How the value of a pair follows from those of its actions.
///
/// With `costs`, each step costs what they say of the pair, undiscounted: where a policy succeeds with
/// probability P and each step costs P, the sum divided by P is E\[steps\] given success.
#[derive(Clone, Copy)]
pub(super) struct Rule<'a> {
    pub(super) objective: Objective,
    pub(super) choice: Choice<'a>,
    /// By pair, positive where asked for.
    pub(super) costs: Option<&'a [f64]>,
}

impl<'a> Rule<'a> {
    /// The largest value of all actions.
    pub(super) const LARGEST: Self = Self::best(Objective::Largest, Choice::All);

    #[inline]
    pub(super) const fn best(objective: Objective, choice: Choice<'a>) -> Self {
        Self { objective, choice, costs: None }
    }

    /// The value of a policy.
    #[inline]
    pub(super) const fn follow(policy: &'a [u32]) -> Self {
        Self::best(Objective::Largest, Choice::Policy(policy))
    }

    #[inline]
    pub(super) const fn costing(self, costs: &'a [f64]) -> Self {
        Self { costs: Some(costs), ..self }
    }

    /// Whether an action may be taken.
    #[inline]
    pub(super) fn allows(&self, pair: usize, a: usize) -> bool {
        match self.choice {
            Choice::All => true,
            Choice::Of(allowed) => allowed.contains(pair, a),
            Choice::Policy(policy) => policy[pair] as usize == a,
        }
    }

    /// Whether there is nothing to choose.
    #[inline]
    pub(super) const fn is_policy(&self) -> bool {
        matches!(self.choice, Choice::Policy(_))
    }

    /// 1 if the largest value is asked for, −1 if the smallest is.
    #[inline]
    pub(super) const fn sign(&self) -> f64 {
        match self.objective {
            Objective::Largest => 1.0,
            Objective::Smallest => -1.0,
        }
    }

    /// The value of a pair of these action values.
    #[inline]
    pub(super) fn value(&self, pair: usize, mut values: impl Iterator<Item = f64>) -> f64 {
        if let Choice::Policy(policy) = self.choice {
            return values.nth(policy[pair] as usize).unwrap_or(f64::NAN);
        }
        let allowed = values.enumerate().filter(|&(a, _)| self.allows(pair, a));
        let best = allowed.map(|(_, value)| self.sign() * value).fold(f64::NEG_INFINITY, f64::max);
        self.sign() * best
    }
}
