//! How far computed values are from the true ones: bounds that hold whatever computed the values.
//!
//! With T the backup of a rule and v* its values, three facts are used; residuals are computed for
//! every allowed action, and what rounding may do to them is added.
//!
//! - Discounted, |v − v*| ≤ max |T v − v| / (1 − γ), for T is a contraction.
//! - With costs c > 0, |T v − v| ≤ ε c gives T (1 + ε) v ≤ (1 + ε) v and T (1 − ε) v ≥ (1 − ε) v, up to ε²; so
//!   v* is within the factors 1 ± ε / (1 − ε).
//! - For probabilities v* is the least fixed point of T: u ≥ T u gives u ≥ v* (Park induction). The bound is
//!   u = v + δ w, with a w that falls by more than |T v − v| / δ at each step of every action that is nearly
//!   the best. First values of w are the policy's expected steps; where an action needs more, w is
//!   raised. Going round on a plateau, neither v nor w changes, and there is nothing to show. From
//!   below, v − δ w holds for the policy in the same way, and no policy is better than the best.
//!
//! Residuals are differences of rounded values, so all this is of use as long as the expected steps are below
//! 10¹³ or so, and as the values are good. Where a bound is poor, the policy is evaluated by elimination and
//! improved further. For a policy, the error of elimination is a bound by itself, in the slowest world.
//!
//! What is taken for granted: that the probabilities of an action sum to 1, what they miss being the
//! probability to stay.

use alloc::vec::Vec;

use super::chain::{Chain, Factors};
use super::component::NONE;
use super::eliminate::{eliminate, relative_error};
use super::improve::Solution;
use super::sets::plateaus;

/// Values that differ by no more may be on one plateau. (Where a world can hardly be lost, there are such
/// plateaus to the last digit that are none for the graph.)
const LEVEL: f64 = 8.0 * f64::EPSILON;

/// Residuals further than this below 0 are no near ties.
const NEAR: f64 = 1e-6;

/// Relative errors above this are worth eliminations.
const POOR: f64 = 1e-6;

/// Rounds in which w is raised before δ is.
const PATIENCE: usize = 64;

/// By how much δ is raised then, and how often: in the end δ w exceeds every probability.
const RAISE: f64 = 8.0;
const RAISES: usize = 24;

/// An action of an unknown with its residual: T v − v by that action, as it would be in the wrong
/// direction.
struct Action {
    i: u32,
    a: u32,
    wrong: f64,
}

impl Solution<'_> {
    /// The error of discounted values.
    #[inline]
    pub(super) fn discounted_error(&self) -> f64 {
        let mut largest: f64 = 0.0;
        self.residuals(|action| largest = largest.max(action.wrong));
        largest / (1.0 - self.component.discount())
    }

    /// The relative error of costs.
    #[inline]
    pub(super) fn relative_error(&mut self) -> f64 {
        let error = self.costs_error();
        if error <= POOR {
            return error;
        }
        self.refine();
        self.costs_error()
    }

    #[inline]
    fn costs_error(&self) -> f64 {
        let mut part = 0.0_f64;
        self.residuals(|Action { i, wrong, .. }| {
            part = part.max(wrong / self.rows.cost(i as usize));
        });
        let error = if part < 0.5 { part / (1.0 - part) } else { f64::INFINITY };
        error.min(self.eliminated_error())
    }

    /// The error of probabilities, and the most steps that the policy can be expected to make.
    #[inline]
    pub(super) fn probability_error(&mut self) -> (f64, f64) {
        let (error, steps) = self.error_and_steps(None);
        if error <= POOR && steps.is_finite() {
            return (error, steps);
        }
        self.refine();
        let own = self.eliminated.then(|| eliminate(&self.rows, &self.policy, |_, _| 1.0));
        let Some(own) = own.flatten() else { return (error, steps) };
        let top = largest(&own);
        let (error, steps) = self.error_and_steps(Some(own));
        (error, if self.eliminated_error() < 0.5 { steps.min(2.0 * top) } else { steps })
    }

    /// The same; `own` are the steps of the policy, if they are known.
    #[inline]
    fn error_and_steps(&mut self, own: Option<Vec<f64>>) -> (f64, f64) {
        let x = |i: u32| self.x[i as usize];
        let level = |i, j| (x(i) - x(j)).abs() <= LEVEL;
        let single = self.rule.is_policy();
        let plateaus =
            if single { Vec::new() } else { plateaus(&self.component, self.rule, level) };
        for members in &plateaus {
            let top = members.iter().map(|&i| self.x[i as usize]).fold(0.0, f64::max);
            members.iter().for_each(|&i| self.x[i as usize] = top);
        }
        // If what is no near tie turns out not to have the room that it was taken to have, with all.
        let steps = own.unwrap_or_else(|| self.steps());
        let mut bound = self.bound(Heights::new(&steps, &plateaus), NEAR);
        if bound.0 > NEAR {
            bound = self.bound(Heights::new(&steps, &plateaus), f64::INFINITY);
        }
        (bound.0.min(self.eliminated_error()), bound.1)
    }

    /// The error of values of a policy that were found by elimination.
    #[inline]
    fn eliminated_error(&self) -> f64 {
        let known = self.rule.is_policy() && self.eliminated;
        if known { relative_error(self.x.len()) } else { f64::INFINITY }
    }

    /// δ w where it is largest, and a bound on the policy's steps; only actions count whose residual is
    /// above −`near`.
    #[inline]
    fn bound(&self, mut heights: Heights<'_>, near: f64) -> (f64, f64) {
        let (mut actions, mut delta) = (Vec::new(), f64::MIN_POSITIVE);
        self.residuals(|action| {
            delta = delta.max(2.0 * action.wrong);
            if action.wrong > -near {
                actions.push(action);
            }
        });
        for _ in 0..RAISES {
            for _ in 0..PATIENCE {
                // To and fro: what an action needs depends on those before it as on those behind.
                actions.reverse();
                if !heights.raise(self, &actions, delta) {
                    return ((delta * heights.top()).min(1.0), 2.0 * heights.top());
                }
            }
            delta *= RAISE;
        }
        (1.0, f64::INFINITY)
    }

    /// The expected steps of the policy, nearly.
    #[inline]
    fn steps(&self) -> Vec<f64> {
        let mut steps = alloc::vec![0.0; self.x.len()];
        let chain = Chain::new(&self.rows, &self.policy, Factors::Plain);
        chain.correct(alloc::vec![1.0; self.x.len()], &mut steps, 1e-3);
        steps
    }

    /// The residuals of all allowed actions, each with what rounding may add to it.
    #[inline]
    fn residuals(&self, mut visit: impl FnMut(Action)) {
        let (component, rule) = (&self.component, self.rule);
        let mut places = Vec::new();
        self.rows.places(&self.x, &mut places);
        for (i, &code) in component.unknowns().iter().enumerate() {
            let (outcomes, x, cost) = (self.rows.outcomes(i), self.x[i], self.rows.cost(i));
            for a in component.allowed(rule, code) {
                let (mut gain, mut size) = (cost, cost);
                for (&at, p) in outcomes.successors.iter().zip(outcomes.row(a)) {
                    let part = p * (places[at as usize] - x);
                    (gain, size) = (gain + part, size + part.abs());
                }
                let own = self.policy[i] as usize == a;
                let wrong = if own { gain.abs() } else { rule.sign() * gain };
                // Each sum and product adds half of ε of what it comes to; arrivals are sums of two.
                let count = outcomes.successors.len() as f64 + 3.0;
                let wrong = wrong + count * f64::EPSILON * size;
                visit(Action { i: i as u32, a: a as u32, wrong });
            }
        }
    }
}

/// A w for each unknown, the same on each plateau.
struct Heights<'a> {
    w: Vec<f64>,
    plateaus: &'a [Vec<u32>],
    /// The plateau of each unknown, or [`NONE`].
    of: Vec<u32>,
}

impl<'a> Heights<'a> {
    /// First heights: the expected `steps` of the policy.
    #[inline]
    fn new(steps: &[f64], plateaus: &'a [Vec<u32>]) -> Self {
        let mut w: Vec<f64> = steps.iter().map(|w| w.max(1.0)).collect();
        let mut of = alloc::vec![NONE; w.len()];
        for (number, members) in plateaus.iter().enumerate() {
            members.iter().for_each(|&i| of[i as usize] = number as u32);
            let top = members.iter().map(|&i| w[i as usize]).fold(0.0, f64::max);
            members.iter().for_each(|&i| w[i as usize] = top);
        }
        Self { w, plateaus, of }
    }

    #[inline]
    fn top(&self) -> f64 {
        largest(&self.w)
    }

    /// Raises w where v + δ w does not hold; whether there was such an action.
    #[inline]
    fn raise(&mut self, solution: &Solution<'_>, actions: &[Action], delta: f64) -> bool {
        let mut raised = false;
        for &Action { i, a, wrong } in actions {
            // No probability is outside 0 to 1: there is nothing to show.
            let room = if solution.rule.sign() > 0.0 {
                1.0 - solution.x[i as usize]
            } else {
                solution.x[i as usize]
            };
            let own = solution.policy[i as usize] == a;
            if !own && delta * self.w[i as usize] >= room {
                continue;
            }
            let plateau = self.of[i as usize];
            let of = |j: u32| self.of.get(j as usize).copied().unwrap_or(NONE);
            let same = |j: u32| j == i || (plateau != NONE && of(j) == plateau);
            let outcomes = solution.rows.outcomes(i as usize);
            // So that 2 w is more than the steps, too, that the policy can be expected to make.
            let least = if own { 0.5 } else { f64::NEG_INFINITY };
            let own = self.w[i as usize];
            let need = (wrong / delta).max(least);
            let (mut rise, mut size, mut moves) = (need, need.abs(), 0.0);
            for (p, target, _) in outcomes.of(a as usize).filter(|&(_, to, _)| !same(to)) {
                let step = p * (self.w.get(target as usize).copied().unwrap_or(0.0) - own);
                (rise, size, moves) = (rise + step, size + step.abs(), moves + p);
            }
            let count = outcomes.successors.len() as f64 + 3.0;
            rise += count * f64::EPSILON * size;
            if moves > 0.0 && rise > 0.0 {
                raised = true;
                let to = (own + rise / moves) * (1.0 + 1e-3);
                match self.plateaus.get(plateau as usize) {
                    Some(members) => members.iter().for_each(|&i| self.w[i as usize] = to),
                    None => self.w[i as usize] = to,
                }
            }
        }
        raised
    }
}

#[inline]
fn largest(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
