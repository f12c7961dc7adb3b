//! Values of all pairs with a bound on their error, one component after the other.

use alloc::vec::Vec;

use super::cheapest::cheapest;
use super::component::{Component, NONE};
use super::improve::{Solution, outwards as policy};
use super::sets::{outwards, sets};
use super::{Actions, Problem, Rule};
use crate::augmented::{LabelTable, Payment};

/// A number for each pair, and how far they may be from the true ones.
pub(super) struct Bounded {
    pub(super) values: Vec<f64>,
    /// Absolute; relative for costs.
    pub(super) error: f64,
    /// For each pair the action by which its value comes about; none where there is nothing to choose.
    chosen: Actions,
    /// For probabilities, the pairs from which success is sure, by the graph: action 0 stands for it.
    pub(super) sure: Actions,
    /// For probabilities, the most steps that the policy can be expected to make where success is
    /// neither sure nor impossible.
    pub(super) doubt: f64,
}

/// What may be near a solution, for each pair: the values, and the actions if they are known.
#[derive(Clone, Copy)]
pub(super) struct Near<'a> {
    pub(super) values: &'a [f64],
    pub(super) policy: Option<&'a [u32]>,
}

impl Bounded {
    /// Values without an error but rounding.
    #[inline]
    pub(super) fn exact(values: Vec<f64>) -> Self {
        let none = || Actions::none(0, 1);
        Self { values, error: 0.0, chosen: none(), sure: none(), doubt: 0.0 }
    }

    /// The actions by which the values come about; 0 where there is nothing to choose.
    #[inline]
    pub(super) fn policy(&self) -> Vec<u32> {
        (0..self.values.len()).map(|pair| self.chosen.first(pair).unwrap_or(0) as u32).collect()
    }
}

/// Collects the values of components.
struct Collector<'a> {
    problem: &'a Problem,
    bounded: Bounded,
    /// By automaton state.
    errors: Vec<f64>,
}

impl Collector<'_> {
    #[inline]
    fn put(&mut self, solution: &Solution<'_>) {
        let unknowns = solution.component.unknowns().iter();
        for ((&code, &x), &a) in unknowns.zip(&solution.x).zip(&solution.policy) {
            let pair = solution.component.pair(code);
            self.bounded.values[pair] = x;
            self.bounded.chosen.insert(pair, a as usize);
        }
    }

    /// The error of a component adds to the largest of those that it leads to.
    #[inline]
    fn add_error(&mut self, members: &[u32], own: f64) {
        let LabelTable { classes, next, .. } = self.problem.task.tables();
        let row = |&q: &u32| &next[q as usize * classes..][..*classes];
        let behind = members.iter().flat_map(row).map(|&to| self.errors[to as usize]);
        let error = own + behind.fold(0.0, f64::max);
        members.iter().for_each(|&q| self.errors[q as usize] = error);
        self.bounded.error = self.bounded.error.max(error);
    }
}

impl Problem {
    #[inline]
    fn collector(&self) -> Collector<'_> {
        let pairs = self.task.pairs();
        let chosen = Actions::none(pairs, self.dynamics.actions());
        let bounded = Bounded { chosen, ..Bounded::exact(alloc::vec![0.0; pairs]) };
        let errors = alloc::vec![0.0; self.task.automaton_states() as usize];
        Collector { problem: self, bounded, errors }
    }

    /// Discounted values; `near` saves rounds. If `fixed`, the automaton stays
    /// where it is.
    #[inline]
    pub(super) fn discounted(
        &self,
        (payment, gamma, fixed): (&Payment, f64, bool),
        near: Option<Near<'_>>,
        rule: &Rule<'_>,
    ) -> Bounded {
        let mut all = self.collector();
        for members in self.components.iter() {
            let known = &all.bounded.values;
            let mut component = Component::new(self, members, (payment, gamma, fixed), known);
            component.choose(outwards(&component, rule), known);
            let first = near.and_then(|near| near.policy).map(|policy| component.of(policy));
            let first = first.unwrap_or_else(|| policy(&component, rule));
            let values = near.map(|near| component.of(near.values));
            let solution = Solution::new(component, rule, first, values);
            all.put(&solution);
            all.add_error(members, solution.discounted_error());
        }
        all.bounded
    }

    /// The probabilities of being paid 1, which comes once.
    #[inline]
    pub(super) fn probability(&self, payment: &Payment, rule: &Rule<'_>) -> Bounded {
        let mut all = self.collector();
        all.bounded.sure = Actions::none(self.task.pairs(), 1);
        for members in self.components.iter() {
            let known = &all.bounded.values;
            let mut component = Component::new(self, members, (payment, 1.0, false), known);
            let sets = sets(&component, rule);
            for &code in &sets.one {
                let pair = component.pair(code);
                all.bounded.values[pair] = 1.0;
                all.bounded.sure.insert(pair, 0);
            }
            component.choose(sets.between, &all.bounded.values);
            let first = policy(&component, rule);
            let mut solution = Solution::new(component, rule, first, None);
            let (error, doubt) = solution.probability_error();
            all.put(&solution);
            all.bounded.doubt += doubt;
            all.add_error(members, error);
        }
        all.bounded
    }

    /// What a policy of allowed actions costs until it leaves for good, where `costs` are positive: the
    /// least, with a relative error.
    #[inline]
    pub(super) fn costs(&self, costs: &[f64], rule: &Rule<'_>) -> Bounded {
        let mut all = self.collector();
        let (accept, nothing) = (self.acceptance(), self.task.payment_by(&|_, _| 0.0));
        for members in self.components.iter() {
            let good = self.good_exits(members, &accept, costs);
            let known = &all.bounded.values;
            let mut component = Component::new(self, members, (&nothing, 1.0, false), known);
            let (unknowns, first) = cheapest(&component, rule, &good, costs);
            component.choose(unknowns, known);
            let rule = rule.costing(costs);
            let mut solution = Solution::new(component, &rule, first, None);
            let error = solution.relative_error();
            all.put(&solution);
            all.add_error(members, error);
        }
        all.bounded
    }

    /// Which arrivals lead out of a component to where `satisfied` is positive.
    #[inline]
    fn good_exits(&self, members: &[u32], accept: &Payment, satisfied: &[f64]) -> Vec<bool> {
        let component = Component::new(self, members, (accept, 1.0, false), satisfied);
        component.arrivals().map(|(target, worth)| target == NONE && worth > 0.0).collect()
    }
}
