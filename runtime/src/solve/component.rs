//! One strongly connected component of the automaton over the whole world, as a system of unknowns.
//!
//! A pair (q, s) is written as a *code*, `k * states + s`, with k the place of q among the members; an
//! arrival likewise, `k * width + at`. What an arrival leads to, and what it is worth where it leads out
//! of the system, is looked up once, so that nothing that follows asks the automaton or the reward. The
//! product with the world is never written out: a table for each arrival is all that is kept.

use alloc::vec::Vec;

use super::{Problem, Rule};
use crate::augmented::Payment;

/// No unknown.
pub(super) const NONE: u32 = u32::MAX;

/// The system of a component.
pub(super) struct Component<'a> {
    pub(super) problem: &'a Problem,
    members: &'a [u32],
    discount: f64,
    /// By arrival: the code of the pair that is entered, until the unknowns are chosen, then the number
    /// of the unknown; [`NONE`] if it leads out.
    target: Vec<u32>,
    /// By arrival: what it pays, and with it what it is worth where it leads out.
    worth: Vec<f64>,
    /// The codes of the unknowns.
    unknowns: Vec<u32>,
    /// By code: the number of the unknown, or [`NONE`]; the code itself until the unknowns are chosen.
    number: Vec<u32>,
}

impl<'a> Component<'a> {
    /// The system of `members`, given the `values` of all that they lead to. If `fixed`, the automaton
    /// stays where it is.
    #[inline]
    pub(super) fn new(
        problem: &'a Problem,
        members: &'a [u32],
        (payment, discount, fixed): (&Payment, f64, bool),
        values: &[f64],
    ) -> Self {
        let (task, dynamics) = (&problem.task, &problem.dynamics);
        let (states, width) = (task.states(), dynamics.arrivals());
        let mut target = Vec::with_capacity(members.len() * width);
        let mut worth = Vec::with_capacity(members.len() * width);
        for &q in members {
            for s in 0..states {
                let to = if fixed { q } else { task.next(q, s) };
                let inside = members.binary_search(&to);
                let paid = problem.paid(payment, q, s);
                target.push(inside.map_or(NONE, |k| (k * states + s) as u32));
                let later = if inside.is_ok() { 0.0 } else { values[task.pair(to, s)] };
                worth.push(paid + discount * later);
            }
            for at in states..width {
                target.push(NONE);
                worth.push(problem.paid_last(payment, q, at));
            }
        }
        let number = (0..(members.len() * states) as u32).collect();
        Self { problem, members, discount, target, worth, unknowns: Vec::new(), number }
    }

    /// How many codes there are.
    #[inline]
    pub(super) fn codes(&self) -> usize {
        self.members.len() * self.states()
    }

    #[inline]
    fn states(&self) -> usize {
        self.problem.task.states()
    }

    #[inline]
    pub(super) fn actions(&self) -> usize {
        self.problem.dynamics.actions()
    }

    #[inline]
    pub(super) const fn discount(&self) -> f64 {
        self.discount
    }

    /// The pair with a code.
    #[inline]
    pub(super) fn pair(&self, code: u32) -> usize {
        let (k, s) = self.split(code);
        self.problem.task.pair(self.members[k], s)
    }

    #[inline]
    pub(super) fn split(&self, code: u32) -> (usize, usize) {
        if self.members.len() == 1 {
            return (0, code as usize);
        }
        (code as usize / self.states(), code as usize % self.states())
    }

    /// The unknowns, by code.
    #[inline]
    pub(super) fn unknowns(&self) -> &[u32] {
        &self.unknowns
    }

    /// The outcomes of all actions of a pair.
    #[inline]
    pub(super) fn outcomes(&self, code: u32) -> Outcomes<'_> {
        let (k, s) = self.split(code);
        let dynamics = &self.problem.dynamics;
        let width = dynamics.arrivals();
        Outcomes {
            successors: dynamics.successors(s),
            matrix: dynamics.matrix(s),
            target: &self.target[k * width..][..width],
            worth: &self.worth[k * width..][..width],
        }
    }

    /// All arrivals: what they enter, as it is numbered, and what they pay, with what they are worth where they
    /// lead out.
    #[inline]
    pub(super) fn arrivals(&self) -> impl Iterator<Item = (u32, f64)> {
        self.target.iter().copied().zip(self.worth.iter().copied())
    }

    /// The arrivals that lead out of the system, with what they are worth.
    #[inline]
    pub(super) fn exits(&self) -> impl Iterator<Item = (usize, f64)> {
        let all = self.target.iter().zip(&self.worth).enumerate();
        all.filter(|(_, (target, _))| **target == NONE)
            .map(|(arrival, (_, worth))| (arrival, *worth))
    }

    /// The pairs from which some action leads to an arrival, and the arrival's place in the world.
    #[inline]
    pub(super) fn before(&self, arrival: usize) -> impl Iterator<Item = (u32, u32)> {
        let width = self.problem.dynamics.arrivals();
        let (k, at) = (arrival / width, arrival % width);
        let (first, list) = &*self.problem.predecessors;
        let from = &list[first[at] as usize..first[at + 1] as usize];
        let base = (k * self.states()) as u32;
        from.iter().map(move |&s| (base + s, at as u32))
    }

    /// The arrivals that enter the pair with a code.
    #[inline]
    pub(super) fn entries(&self, code: u32) -> impl Iterator<Item = usize> {
        let (width, (_, s)) = (self.problem.dynamics.arrivals(), self.split(code));
        let (all, number) =
            ((0..self.members.len()).map(move |j| j * width + s), self.number[code as usize]);
        all.filter(move |&arrival| self.target[arrival] == number)
    }

    /// The number of the unknown with a code, or [`NONE`]; the code itself until they are chosen.
    #[inline]
    pub(super) fn number(&self, code: u32) -> u32 {
        self.number[code as usize]
    }

    /// The code of what has a number.
    #[inline]
    pub(super) fn code(&self, number: u32) -> u32 {
        self.unknowns.get(number as usize).copied().unwrap_or(number)
    }

    /// Makes `unknowns`, which are codes, the unknowns: numbered in that order. What is no unknown is
    /// worth what `values` says.
    #[inline]
    pub(super) fn choose(&mut self, unknowns: Vec<u32>, values: &[f64]) {
        self.number.fill(NONE);
        unknowns.iter().zip(0..).for_each(|(&code, i)| self.number[code as usize] = i);
        for arrival in 0..self.target.len() {
            let code = self.target[arrival];
            if code != NONE {
                let number = self.number[code as usize];
                self.target[arrival] = number;
                if number == NONE {
                    self.worth[arrival] += self.discount * values[self.pair(code)];
                }
            }
        }
        self.unknowns = unknowns;
    }

    /// Numbers the unknowns anew: `order` has the old numbers in their new order.
    #[inline]
    pub(super) fn renumber(&mut self, order: &[u32]) {
        let mut number = alloc::vec![NONE; order.len()];
        order.iter().zip(0..).for_each(|(&old, new)| number[old as usize] = new);
        self.unknowns = order.iter().map(|&old| self.unknowns[old as usize]).collect();
        for old in self.target.iter_mut().chain(&mut self.number).filter(|old| **old != NONE) {
            *old = number[*old as usize];
        }
    }

    /// What belongs to the unknowns, of what belongs to all pairs.
    #[inline]
    pub(super) fn of<T: Copy>(&self, all: &[T]) -> Vec<T> {
        self.unknowns.iter().map(|&code| all[self.pair(code)]).collect()
    }

    /// The actions that `rule` allows in a pair.
    #[inline]
    pub(super) fn allowed<'b>(
        &'b self,
        rule: &'b Rule<'_>,
        code: u32,
    ) -> impl Iterator<Item = usize> + 'b {
        let pair = self.pair(code);
        (0..self.actions()).filter(move |&a| rule.allows(pair, a))
    }
}

/// The outcomes of a pair: for each action a row of probabilities over the same successors.
#[derive(Clone, Copy)]
pub(super) struct Outcomes<'a> {
    pub(super) successors: &'a [u32],
    pub(super) matrix: &'a [f64],
    pub(super) target: &'a [u32],
    pub(super) worth: &'a [f64],
}

impl<'a> Outcomes<'a> {
    /// The probabilities of an action.
    #[inline]
    pub(super) fn row(&self, a: usize) -> &'a [f64] {
        &self.matrix[a * self.successors.len()..][..self.successors.len()]
    }

    /// The outcomes of an action: probability, where it leads ([`NONE`] is out), and what that pays.
    #[inline]
    pub(super) fn of(&self, a: usize) -> impl Iterator<Item = (f64, u32, f64)> + 'a {
        let (target, worth) = (self.target, self.worth);
        let all = self.successors.iter().zip(self.row(a)).filter(|(_, p)| **p > 0.0);
        all.map(move |(&at, &p)| (p, target[at as usize], worth[at as usize]))
    }

    /// Whether an action may lead to the arrival at a place in the world.
    #[inline]
    pub(super) fn leads(&self, a: usize, at: u32) -> bool {
        self.successors.binary_search(&at).is_ok_and(|column| self.row(a)[column] > 0.0)
    }
}
