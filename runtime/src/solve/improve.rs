//! The values of a component: policy iteration with inexact evaluations.
//!
//! Each round looks at every action of every unknown once, takes those that are better, and corrects the
//! values of the policy that results by a [linear system](super::chain) (Howard 1960; Puterman and
//! Brumelle 1979: a Newton method, so that systems solved to four digits lose hardly a round). Residuals are
//! sums of p · (value there − value here), so a pair that hardly ever moves loses no digit to rounding.
//!
//! Undiscounted, a policy must leave in the end. The first one follows the search from the exits; a
//! later one that has a trap takes its former actions back there.

use alloc::vec::Vec;

use super::Rule;
use super::chain::{Chain, Factors, WIDE};
use super::component::{Component, NONE};
use super::eliminate::{SMALL, eliminate};
use super::rows::Rows;
use super::rule::Choice;

/// By how much an action must be better to be taken, relative to the values: ties are common, and rounding
/// must not decide them again and again.
const TIE: f64 = 1e-12;

/// By how much of the residual an action must be better to be taken in the first sweep, where values slope.
const NOTABLE: f64 = 1e-4;

/// The residual, relative to the values, below which there is nothing to correct but rounding. Where values
/// slope, ties leave more.
const DONE: f64 = 2e-15;

/// The residual that single precision is asked for in the end, and any that may not be the last.
const NOUGHT: f64 = 1e-14;

/// How far a system is solved while the policy changes, where values slope; else; and in the end.
const LOOSE: f64 = 1e-3;
const TIGHT: f64 = 1e-10;
const FULL: f64 = 1e-13;

/// The residual below which few actions still change, so that a system solved fully may be the last.
const CLOSE: f64 = 1e-5;

/// The changes of actions, for each unknown, before they are numbered anew; and in a wide world, where that is
/// dear.
const MOVED: f64 = 0.01;
const MOST_MOVED: f64 = 0.75;

/// Sweeps between two systems: what becomes better beside one unknown makes the next one better.
const SWEEPS: usize = 4;

/// As [`TIE`], where values are found by elimination: what rounding may do to them.
const FINE: f64 = 16.0 * f64::EPSILON;

/// The policies at most whose values are found so in the end.
const REFINEMENTS: usize = 20;

/// The rounds at most: policies improve each time, and few worlds take twenty.
const ROUNDS: usize = 1000;

/// Values and policy of the unknowns of a component.
pub(super) struct Solution<'a> {
    pub(super) component: Component<'a>,
    pub(super) rows: Rows<'a>,
    pub(super) rule: &'a Rule<'a>,
    pub(super) x: Vec<f64>,
    /// The action of each unknown.
    pub(super) policy: Vec<u32>,
    /// Whether the values are those of the policy by elimination.
    pub(super) eliminated: bool,
    places: Vec<f64>,
    /// By unknown: what the policy's action comes to, less the value.
    residual: Vec<f64>,
    /// The largest value; costs are compared with their own.
    scale: f64,
    factors: Factors,
}

impl<'a> Solution<'a> {
    /// The solution; `start` are first values, if there are any.
    #[inline]
    pub(super) fn new(
        component: Component<'a>,
        rule: &'a Rule<'a>,
        policy: Vec<u32>,
        start: Option<Vec<f64>>,
    ) -> Self {
        let n = component.unknowns().len();
        let x = start.unwrap_or_else(|| alloc::vec![0.0; n]);
        let (places, residual) = (Vec::new(), Vec::new());
        let (rows, factors) = (Rows::new(&component, rule.costs), Factors::Plain);
        let (eliminated, scale) = (false, 0.0);
        let mut solution =
            Self { component, rows, rule, x, policy, eliminated, places, residual, scale, factors };
        if n >= WIDE && solution.slopes() {
            solution.factors = Factors::SumPreserving;
        }
        solution.solve();
        solution
    }

    /// Improves the policy and its values in turn, until neither gets better. A policy whose system cannot be
    /// solved is given up for the one before it.
    #[inline]
    fn solve(&mut self) {
        let mut solved = (self.x.clone(), self.policy.clone());
        let (mut kept, mut changed, mut before) = (None, true, f64::INFINITY);
        for round in 0..ROUNDS {
            let chain = kept.get_or_insert_with(|| self.chain(&solved.1));
            self.look();
            let size = self.size(chain);
            let small = self.x.len() <= SMALL;
            let settled = !changed && (small || size <= DONE || size > 0.5 * before);
            let last = !changed || self.rule.is_policy();
            let small_enough = self.slopes() && !small && !self.rule.is_policy() && size <= TIE;
            if settled || small_enough {
                break;
            }
            let full = (0.1 * DONE / size).max(FULL);
            let reduction = match self.slopes() {
                _ if last => full,
                false => TIGHT,
                true if size < CLOSE => (NOUGHT / size).max(FULL),
                true => LOOSE,
            };
            let converged = small && self.eliminate()
                || self.correct(chain, &solved.0, reduction)
                || self.eliminate();
            if !converged && changed && round > 0 {
                (self.x, self.policy) = solved;
                break;
            }
            before = if changed && converged { f64::INFINITY } else { size };
            changed = false;
            if converged {
                solved.0.copy_from_slice(&self.x);
                solved.1.copy_from_slice(&self.policy);
                let loose = if self.slopes() { NOTABLE } else { TIGHT };
                let taken = self.improve((loose * size.min(1.0)).max(TIE));
                changed = taken > 0;
                if changed {
                    kept = None;
                }
                let moved = if self.x.len() >= WIDE { MOST_MOVED } else { MOVED };
                if self.rule.costs.is_some() && taken as f64 > moved * self.x.len() as f64 {
                    self.sort(&mut solved);
                }
            }
        }
    }

    /// Sweeps while there are better actions, a few times; how many it took.
    #[inline]
    fn improve(&mut self, tie: f64) -> usize {
        let mut taken = self.sweep(tie);
        let more = if taken > 0 && self.slopes() { SWEEPS - 1 } else { 0 };
        for _ in 0..more {
            match self.sweep(TIE) {
                0 => break,
                found => taken += found,
            }
        }
        taken
    }

    /// Corrects the values, with the other factors where these fail; whether that was enough. `solved` are
    /// values to go back to.
    #[inline]
    fn correct(&mut self, chain: &mut Chain, solved: &[f64], reduction: f64) -> bool {
        self.eliminated = false;
        if self.attempt(chain, self.factors, solved, reduction) {
            return true;
        }
        let mut other = Chain::new(&self.rows, &self.policy, self.factors.other());
        self.look();
        let converged = self.attempt(&other, self.factors.other(), solved, reduction);
        if matches!(self.factors, Factors::SumPreserving) {
            // Where they failed once, they mostly do again.
            self.factors = Factors::Plain;
            core::mem::swap(chain, &mut other);
        }
        converged
    }

    /// Corrects the values; whether that was enough. What factors that preserve sums leave may be small where
    /// the true residuals are not, so these decide.
    #[inline]
    fn attempt(&mut self, chain: &Chain, factors: Factors, solved: &[f64], reduction: f64) -> bool {
        // What is not needed meanwhile makes room.
        self.places = Vec::new();
        if matches!(factors, Factors::Plain) {
            let residual = core::mem::take(&mut self.residual);
            return chain.correct(residual, &mut self.x, reduction);
        }
        let mut before = self.size(chain).min(1.0);
        let wanted = (reduction * before).max(NOUGHT);
        // Also where no more is wanted: in a slow world a small residual says little, and other ways are tried then.
        loop {
            let (residual, asked) = (core::mem::take(&mut self.residual), wanted / before);
            let converged = chain.correct(residual, &mut self.x, asked);
            self.look();
            let size = self.size(chain);
            if !(converged && size < before) {
                self.x.copy_from_slice(solved);
                self.look();
                return false;
            }
            if asked >= chain.least() || size <= wanted || size > 0.5 * before {
                return true;
            }
            before = size;
        }
    }

    /// Finds the values by elimination, unless it is too much work.
    #[inline]
    fn eliminate(&mut self) -> bool {
        let found = eliminate(&self.rows, &self.policy, |i, a| self.rows.paid(i, a));
        found.map(|x| (self.x, self.eliminated) = (x, true)).is_some()
    }

    /// Improves the policy further by eliminations, unless these are too much work: their values are good in
    /// the slowest world.
    #[inline]
    pub(super) fn refine(&mut self) {
        let mut former = self.policy.clone();
        for _ in 0..REFINEMENTS {
            drop(self.chain(&former));
            if !self.eliminate() {
                break;
            }
            former.copy_from_slice(&self.policy);
            let x = self.x.clone();
            let taken = self.sweep(FINE);
            self.x = x;
            if taken == 0 {
                break;
            }
        }
        self.policy = former;
    }

    /// Whether values change along the ways: where each step costs something, or is discounted. Where they
    /// do not, an error makes hills that are none, and a policy may stay on one for ever.
    #[inline]
    fn slopes(&self) -> bool {
        self.rule.costs.is_some() || self.component.discount() < 1.0
    }

    /// The system of the policy. Undiscounted, what would be trapped takes its former action back.
    #[inline]
    fn chain(&mut self, former: &[u32]) -> Chain {
        let chain = Chain::new(&self.rows, &self.policy, self.factors);
        let trapped = chain.trapped(&self.rows, &self.policy);
        if trapped.is_empty() || self.component.discount() < 1.0 {
            return chain;
        }
        trapped.iter().for_each(|&i| self.policy[i] = former[i]);
        Chain::new(&self.rows, &self.policy, self.factors)
    }

    /// Numbers the unknowns by their values, in the direction in which the policy goes.
    #[inline]
    fn sort(&mut self, solved: &mut (Vec<f64>, Vec<u32>)) {
        let sign = -self.rule.sign();
        let mut order: Vec<u32> = (0..self.x.len() as u32).collect();
        order.sort_by(|&i, &j| (sign * self.x[i as usize]).total_cmp(&(sign * self.x[j as usize])));
        self.component.renumber(&order);
        drop(core::mem::take(&mut self.rows));
        self.rows = Rows::new(&self.component, self.rule.costs);
        let new = |old: &Vec<f64>| order.iter().map(|&i| old[i as usize]).collect();
        (self.x, solved.0) = (new(&self.x), new(&solved.0));
        let new = |old: &Vec<u32>| order.iter().map(|&i| old[i as usize]).collect();
        (self.policy, solved.1) = (new(&self.policy), new(&solved.1));
    }

    /// The largest residual by what moves at all, relative to the values.
    #[inline]
    fn size(&self, chain: &Chain) -> f64 {
        let all = self.residual.iter().zip(&self.x).enumerate();
        let relative = all.map(|(i, (r, x))| r.abs() / (chain.moving(i) * self.unit(*x)));
        relative.fold(0.0, f64::max)
    }

    /// What residuals at a value are compared with.
    #[inline]
    fn unit(&self, x: f64) -> f64 {
        let unit = if self.rule.costs.is_some() { x.abs() } else { self.scale };
        unit.max(f64::MIN_POSITIVE)
    }

    #[inline]
    fn rescale(&mut self) {
        self.scale = self.x.iter().fold(0.0, |scale, x| scale.max(x.abs()));
    }

    /// Computes the residuals.
    #[inline]
    fn look(&mut self) {
        self.rows.places(&self.x, &mut self.places);
        self.rescale();
        let residual = |(i, &x): (usize, &f64)| {
            let outcomes = self.rows.outcomes(i);
            let row = outcomes.successors.iter().zip(outcomes.row(self.policy[i] as usize));
            let own: f64 = row.map(|(&at, p)| p * (self.places[at as usize] - x)).sum();
            own + self.rows.cost(i)
        };
        self.residual.clear();
        self.residual.extend(self.x.iter().enumerate().map(residual));
    }

    /// Takes actions that are better by more than `tie` and their values, one unknown after the other, so
    /// that what is found near the exits is used further out; how many it took.
    #[inline]
    fn sweep(&mut self, tie: f64) -> usize {
        if self.rule.is_policy() {
            return 0;
        }
        self.rows.places(&self.x, &mut self.places);
        self.rescale();
        let slopes = self.slopes();
        let (mut gathered, mut gains) = (Vec::new(), alloc::vec![0.0; self.component.actions()]);
        let (mut taken, sign) = (0, self.rule.sign());
        for (i, &code) in self.component.unknowns().iter().enumerate() {
            let (outcomes, x) = (self.rows.outcomes(i), self.x[i]);
            gathered.clear();
            gathered.extend(outcomes.successors.iter().map(|&at| self.places[at as usize] - x));
            products(outcomes.matrix, &gathered, &mut gains);
            let own = gains[self.policy[i] as usize];
            let (mut best, mut most) = (self.policy[i], own);
            let tie = tie * self.unit(x);
            // An action that seldom moves is as good as what it comes to when it does.
            let moving = |a| {
                outcomes.of(a).filter(|&(_, to, _)| to != i as u32).map(|(p, ..)| p).sum::<f64>()
            };
            for (a, &gain) in gains.iter().enumerate() {
                let better = sign * (gain - own);
                if better > 0.0
                    && sign * gain > sign * most
                    && (better > tie || better > tie * moving(a))
                    && self.rule.allows(self.component.pair(code), a)
                {
                    (best, most) = (a as u32, gain);
                }
            }
            taken += usize::from(best != self.policy[i]);
            self.policy[i] = best;
            if !slopes {
                continue;
            }
            let value = x + most + self.rows.cost(i);
            self.x[i] = value;
            for place in self.rows.entries(i) {
                self.places[place] = self.rows.entering(place, value);
            }
        }
        taken
    }
}

/// The action that most probably leads to unknowns that are nearer to an exit, or to one that is worth
/// something.
#[inline]
pub(super) fn outwards(component: &Component<'_>, rule: &Rule<'_>) -> Vec<u32> {
    (0..component.unknowns().len()).map(|i| nearer(component, rule, i)).collect()
}

#[inline]
fn nearer(component: &Component<'_>, rule: &Rule<'_>, i: usize) -> u32 {
    let code = component.unknowns()[i];
    if let Choice::Policy(policy) = rule.choice {
        return policy[component.pair(code)];
    }
    let good = |&(_, target, worth): &(f64, u32, f64)| {
        if target == NONE { worth > 0.0 } else { (target as usize) < i }
    };
    let outcomes = component.outcomes(code);
    let (mut best, mut most) = (0, f64::NEG_INFINITY);
    for a in component.allowed(rule, code) {
        let nearer: f64 = outcomes.of(a).filter(good).map(|(p, ..)| p).sum();
        if nearer > most {
            (best, most) = (a as u32, nearer);
        }
    }
    best
}

/// Σ p · value of each row of a matrix. Most are of a few numbers, and known numbers of them are fast.
#[inline]
fn products(matrix: &[f64], values: &[f64], sums: &mut [f64]) {
    fn of<const N: usize>(matrix: &[f64], values: &[f64], sums: &mut [f64]) {
        let Some(values) = values.first_chunk::<N>() else { return };
        let rows = matrix.as_chunks::<N>().0;
        sums.iter_mut().zip(rows).for_each(|(at, row)| *at = sum(row, values));
    }
    match values.len() {
        2 => of::<2>(matrix, values, sums),
        3 => of::<3>(matrix, values, sums),
        4 => of::<4>(matrix, values, sums),
        5 => of::<5>(matrix, values, sums),
        n => {
            let rows = matrix.chunks_exact(n);
            sums.iter_mut().zip(rows).for_each(|(at, row)| *at = sum(row, values));
        }
    }
}

/// Σ p · value.
#[inline]
fn sum(row: &[f64], values: &[f64]) -> f64 {
    row.iter().zip(values).map(|(p, value)| p * value).sum()
}
