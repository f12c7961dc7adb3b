//! What a pair is worth, given what arriving at its successors is worth.
//!
//! Five problems are solved by the same sweeps: optimal values, the least chance of being lost, the
//! values and the costs of a given policy, and the least costs among actions that are allowed. They
//! differ in how a pair's value follows from those of its actions, and that is a [`Rule`]. A rule is
//! data and not a closure: closures made eight copies of the sweeps and three of the search.

use super::Actions;
use super::settle::{Guess, Lookahead};

/// How the value of a pair follows from those of its actions.
///
/// Costs are undiscounted and weighted by success: where a policy succeeds with probability P, each
/// step costs P, so that the sum divided by P is E\[steps\] given success.
pub(super) enum Rule<'a> {
    /// The largest.
    Largest,
    /// The least.
    Least,
    /// The largest of the actions that are allowed.
    LargestOf(&'a Actions),
    /// The least of the actions that are allowed.
    LeastOf(&'a Actions),
    /// That of a policy's action.
    Follow(&'a [u32]),
    /// The pair's cost, and what the action of a policy costs from there on.
    Cost { costs: &'a [f64], policy: &'a [u32] },
    /// The pair's cost, and the least that a safe action costs from there on.
    LeastCost { costs: &'a [f64], safe: &'a Actions },
}

impl Rule<'_> {
    /// The value of `pair`.
    #[inline]
    pub(super) fn value(&self, pair: usize, backup: &Backup<'_>) -> f64 {
        match *self {
            Self::Largest => backup.max_where(|_| true),
            Self::Least => backup.min_where(|_| true),
            Self::LargestOf(allowed) => backup.max_where(|a| allowed.contains(pair, a)),
            Self::LeastOf(allowed) => backup.min_where(|a| allowed.contains(pair, a)),
            Self::Follow(policy) => backup.of(policy[pair]),
            Self::Cost { costs, policy } => costs[pair] + backup.of(policy[pair]),
            Self::LeastCost { costs, safe } => {
                costs[pair] + backup.min_where(|a| safe.contains(pair, a))
            }
        }
    }

    /// A first value of `pair`. Costs are not discounted.
    #[inline]
    pub(super) fn guess(&self, pair: usize, known: &Lookahead<'_>, discount: f64) -> Guess {
        match *self {
            Self::Largest | Self::LargestOf(_) => known.best(discount),
            Self::Least | Self::LeastOf(_) => known.least(0.0, |_| true),
            Self::Follow(policy) => known.discounted(policy[pair] as usize, discount),
            Self::Cost { costs, policy } => known.cost(policy[pair] as usize, costs[pair]),
            Self::LeastCost { costs, safe } => known.least(costs[pair], |a| safe.contains(pair, a)),
        }
    }

    /// How late a pair of this value is settled.
    ///
    /// The largest values come first, for what leads to them is worth less; so do the least costs. A
    /// cost is divided by the weight of its pair, or pairs that seldom succeed would seem near.
    #[inline]
    pub(super) fn key(&self, pair: usize, value: f64) -> f64 {
        match *self {
            Self::Largest | Self::LargestOf(_) | Self::Follow(_) => -value,
            Self::Least | Self::LeastOf(_) => value,
            Self::Cost { costs, .. } | Self::LeastCost { costs, .. } => value / costs[pair],
        }
    }
}

/// What a backup sees: the probabilities of one state's successors, and what arriving is worth.
///
/// `matrix` has a row for each action, each with a probability for each successor; `arrivals` has
/// what arriving at each successor is worth, payment included, in the same order.
pub(super) struct Backup<'a> {
    pub(super) matrix: &'a [f64],
    pub(super) arrivals: &'a [f64],
}

impl Backup<'_> {
    /// The values of the actions.
    #[inline]
    pub(super) fn values(&self) -> impl Iterator<Item = f64> {
        self.matrix.chunks_exact(self.arrivals.len()).map(|row| mean(row, self.arrivals))
    }

    /// The value of one action.
    #[inline]
    fn of(&self, action: u32) -> f64 {
        let n = self.arrivals.len();
        mean(&self.matrix[action as usize * n..][..n], self.arrivals)
    }

    /// The largest value of the actions that are `allowed`.
    #[inline]
    fn max_where(&self, allowed: impl Fn(usize) -> bool) -> f64 {
        let values = self.values().enumerate().filter(|&(a, _)| allowed(a));
        values.fold(f64::NEG_INFINITY, |best, (_, value)| if value > best { value } else { best })
    }

    /// The least value of the actions that are `allowed`.
    ///
    /// Infinite where none is: such a pair is never chosen.
    #[inline]
    fn min_where(&self, allowed: impl Fn(usize) -> bool) -> f64 {
        let values = self.values().enumerate().filter(|&(a, _)| allowed(a));
        values.fold(f64::INFINITY, |best, (_, value)| if value < best { value } else { best })
    }
}

/// Σ p · arrival.
#[inline]
fn mean(row: &[f64], arrivals: &[f64]) -> f64 {
    row.iter().zip(arrivals).map(|(p, value)| p * value).sum()
}
