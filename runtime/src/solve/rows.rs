//! The equations of the unknowns, in their order.
//!
//! Unknowns are numbered so that what they lead to is near them; in the order of the states it is far from them,
//! and in a world of a million states each look would miss the cache. So all that belongs to an unknown stands
//! beside it here. An arrival is known by its *place*: first those that enter unknown 0, then those that enter
//! unknown 1, and in the end those that lead out.

use alloc::vec::Vec;
use core::ops::Range;

use super::component::{Component, NONE, Outcomes};

/// The equations of a component, numbered as its unknowns are.
#[derive(Default)]
pub(super) struct Rows<'a> {
    discount: f64,
    actions: usize,
    probabilities: &'a [f64],
    /// By unknown: where its matrix begins in `probabilities`, and where its successors do.
    matrix: Vec<u32>,
    first: Vec<u32>,
    /// The places of all successors.
    successors: Vec<u32>,
    /// By unknown: the first of the places that enter it; then the first that leads out.
    entered: Vec<u32>,
    /// By place: the unknown, or [`NONE`], and what is paid there, with what it is worth where it leads out.
    target: Vec<u32>,
    worth: Vec<f64>,
    /// By unknown: what a step costs; empty if it costs nothing.
    costs: Vec<f64>,
}

impl<'a> Rows<'a> {
    /// The equations of `component`, whose unknowns are chosen; `costs` are those of pairs.
    #[inline]
    pub(super) fn new(component: &Component<'a>, costs: Option<&[f64]>) -> Self {
        let (dynamics, n) = (&component.problem.dynamics, component.unknowns().len());
        let mut entered = alloc::vec![0; n + 3];
        let number = |target: u32| (target as usize).min(n);
        component.arrivals().for_each(|(target, _)| entered[number(target) + 2] += 1);
        (1..n + 3).for_each(|i| entered[i] += entered[i - 1]);
        let arrivals = entered[n + 2] as usize;
        let (mut place, mut worth) = (Vec::with_capacity(arrivals), alloc::vec![0.0; arrivals]);
        let mut targets = alloc::vec![NONE; arrivals];
        for (target, paid) in component.arrivals() {
            let next = &mut entered[number(target) + 1];
            (worth[*next as usize], targets[*next as usize]) = (paid, target);
            place.push(*next);
            *next += 1;
        }
        let (mut matrix, mut first) = (Vec::with_capacity(n), Vec::with_capacity(n + 1));
        let mut successors = Vec::with_capacity(4 * n);
        first.push(0);
        for &code in component.unknowns() {
            let (k, s) = component.split(code);
            let part = &place[k * dynamics.arrivals()..];
            successors.extend(dynamics.successors(s).iter().map(|&at| part[at as usize]));
            first.push(successors.len() as u32);
            matrix.push(dynamics.matrix_offset(s) as u32);
        }
        let cost = |costs: &[f64]| {
            component.unknowns().iter().map(|&code| costs[component.pair(code)]).collect()
        };
        Self {
            discount: component.discount(),
            actions: component.actions(),
            probabilities: dynamics.probabilities(),
            matrix,
            first,
            successors,
            entered,
            target: targets,
            worth,
            costs: costs.map_or(Vec::new(), cost),
        }
    }

    #[inline]
    pub(super) const fn discount(&self) -> f64 {
        self.discount
    }

    /// What a step from an unknown costs.
    #[inline]
    pub(super) fn cost(&self, i: usize) -> f64 {
        self.costs.get(i).copied().unwrap_or(0.0)
    }

    /// What a step from an unknown comes to in the mean, but for the unknowns that it leads to.
    #[inline]
    pub(super) fn paid(&self, i: usize, a: u32) -> f64 {
        self.outcomes(i).of(a as usize).fold(self.cost(i), |sum, (p, _, worth)| sum + p * worth)
    }

    /// The outcomes of an unknown, whose successors are places.
    #[inline]
    pub(super) fn outcomes(&self, i: usize) -> Outcomes<'_> {
        let successors = &self.successors[self.first[i] as usize..self.first[i + 1] as usize];
        let matrix = &self.probabilities[self.matrix[i] as usize..];
        Outcomes {
            successors,
            matrix: &matrix[..successors.len() * self.actions],
            target: &self.target,
            worth: &self.worth,
        }
    }

    /// What each place is worth, given the unknowns.
    #[inline]
    pub(super) fn places(&self, x: &[f64], places: &mut Vec<f64>) {
        let later = |&target: &u32| x.get(target as usize).map_or(0.0, |x| self.discount * x);
        places.clear();
        places.extend(self.worth.iter().zip(&self.target).map(|(worth, to)| worth + later(to)));
    }

    /// The places that enter an unknown.
    #[inline]
    pub(super) fn entries(&self, i: usize) -> Range<usize> {
        self.entered[i] as usize..self.entered[i + 1] as usize
    }

    /// What a place is worth that enters an unknown of this value.
    #[inline]
    pub(super) fn entering(&self, place: usize, x: f64) -> f64 {
        self.worth[place] + self.discount * x
    }
}
