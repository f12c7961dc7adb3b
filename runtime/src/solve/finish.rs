//! The values that learning is finished with, on the world as it was seen.
//!
//! Probabilities that were counted are known up to sampling. Of two ways that are equally safe, chance
//! makes one look safer by 1e-4 or so; taken at its word, "the largest P, then the fewest steps" takes
//! that way however long it is. So each step costs a little of P: the acceptance that is maximised is
//! discounted by γ = 1 − λ, where all steps together cost at most [`TOLERANCE`].
//!
//! The price λ comes from a first solution, at a price λ₀ that is too low to matter. With T the steps to
//! acceptance (but the last: what it leads to is paid in full), and means over the starts,
//!
//! ```text
//! V(λ) = max over π of E[(1 − λ)^T; π],    V(0) = P, the largest,
//! λ = TOLERANCE · P · λ₀ / (P − V(λ₀)).
//! ```
//!
//! So λ times (P − V(λ₀)) / (λ₀ P), which are the steps to success of the best policy, is `TOLERANCE`. What
//! that gives away: V is a maximum of convex functions of λ, hence convex, and (P − V(λ)) / λ falls. For
//! the policy π that is the best at λ ≥ λ₀
//!
//! ```text
//! P(π) ≥ E[(1 − λ)^T; π] = V(λ) ≥ P − λ / λ₀ · (P − V(λ₀)) = (1 − TOLERANCE) · P.
//! ```

use alloc::vec::Vec;

use super::bounded::{Bounded, Near};
use super::{Problem, Rule};
use crate::augmented::Payment;
use crate::q::QTable;
use crate::reward::{End, Rewards};

/// The share of P(satisfied) that all steps are worth.
///
/// Measured by the study of tasks (`docs/studies/tasks.md`), on tasks that can be lost, by how many of
/// them then take more than 1 % more steps than the fewest, or lose more than 0.1 % of P. Tolerances of
/// single actions add up along the way and are worse.
const TOLERANCE: f64 = 6e-3;

/// The first price of a step: a hundredth of what it will be, for tasks of sixty steps.
const FIRST: f64 = 1e-6;

/// How much less all steps must cost at first than in the end.
const SMALL: f64 = 0.1;

/// The smallest price of a step: then values are known to about 1e-7 of it, at 10^9 steps.
const LEAST: f64 = 1e-9;

impl Problem {
    /// The action values of the largest P(satisfied) and then the fewest steps, P up to a tolerance,
    /// where the rewards pay acceptance alone; for other rewards the optimal ones.
    #[inline]
    pub(crate) fn finished(&self, rewards: &Rewards) -> QTable {
        if !rewards.pays_acceptance_alone() {
            return self.optimal_q(rewards);
        }
        let accept = self.acceptance();
        let mut largest = self.probability(&accept, &Rule::LARGEST).values;
        self.set_end(End::Accepted, &mut largest, 1.0);
        let near = Near { values: &largest, policy: None };
        let mut first = FIRST;
        let (start, steps) = loop {
            let found = self.priced(&accept, first, near);
            let steps = self.taken(&largest, &found.values) / first;
            if first * steps <= SMALL * TOLERANCE || first <= LEAST {
                break (found, steps.max(1.0));
            }
            first = (SMALL * SMALL * first).max(LEAST);
        };
        let price = (TOLERANCE / steps).max(LEAST);
        // As long as the steps cost little, values are nearly linear in the price.
        let linear = |(p, v): (&f64, &f64)| (p - price / first * (p - v)).max(0.0);
        let linear: Vec<f64> = largest.iter().zip(&start.values).map(linear).collect();
        let policy = start.policy();
        let near = Near { values: &linear, policy: Some(&policy) };
        let mut values = self.priced(&accept, price, near).values;
        self.set_end(End::Accepted, &mut values, 0.0);
        self.action_values(&self.arrivals(&accept, 1.0 - price, &values))
    }

    /// The largest values of acceptance where each step takes the share `price`, 1 at acceptance.
    #[inline]
    fn priced(&self, accept: &Payment, price: f64, near: Near<'_>) -> Bounded {
        let recipe = (accept, 1.0 - price, false);
        let mut found = self.discounted(recipe, Some(near), &Rule::LARGEST);
        self.set_end(End::Accepted, &mut found.values, 1.0);
        found
    }

    /// The share that `values` lack of the `largest`, in the mean over the starts.
    #[inline]
    fn taken(&self, largest: &[f64], values: &[f64]) -> f64 {
        let satisfied = self.mean(|pair| largest[pair]);
        let lacking = self.mean(|pair| largest[pair] - values[pair]);
        if satisfied > 0.0 { lacking / satisfied } else { 0.0 }
    }
}
