//! One strongly connected component of the automaton over the whole world: sweeps and elimination.
//!
//! A [`Block`] takes the values of a component to the fixed point of a [`Rule`], given the values of
//! all that the component leads to. It does so in up to three ways:
//!
//! 1. *Over-relaxed sweeps*, where the pairs were [settled](mod@super::settle): Gauss-Seidel with a
//!    factor for each pair, first in a window that moves away from the exits. A correction then
//!    crosses the world in one pass, and pairs behind the window are not touched for nothing.
//! 2. *Plain Gauss-Seidel sweeps* in the same order until the error bound holds. They alone decide
//!    when to stop, so the result has the stated accuracy whatever the first step did.
//! 3. *Elimination*, for the values of a policy in a component of at most 1,024 pairs: where a policy
//!    goes round in circles a sweep gains little, and a dense system of that size is soon solved.
//!
//! How often a pair is backed up until the end, on the paper's composed task (8 automaton states, slip
//! 0.2) over 200 × 200 cells and, where two numbers stand, over 500 × 500:
//!
//! | | Q*, γ 0.95 | E\[steps\] |
//! | --- | --- | --- |
//! | as it is | 24, 27 | 18, 17 |
//! | over-relaxed, without the window | 21, 24 | 25, 38 |
//! | in the window, all factors 1 | 30 | 26 |
//! | plain sweeps in the settled order | 62, 66 | 80, 155 |
//! | plain sweeps in the order of distance | 68 | |
//!
//! So the window costs a tenth where values are discounted, and halves the work where they are not.
//!
//! All of it is deterministic: an order, no threads, no random numbers. The weak point is a large
//! component of a world that mixes slowly (a chance of leaving of a millionth a step): such sweeps
//! converge as slowly as the world does.

use alloc::vec::Vec;

use super::graph::{self, Order};
use super::rule::{Backup, Rule};
use super::settle::settle;
use super::{Problem, TOLERANCE};
use crate::augmented::Payment;
use crate::q::QTable;

/// Components of at most this many pairs may be solved by elimination: n³/3 multiplications, 0.36 · 10⁹
/// for 1,024, and 8 MB of coefficients.
const ELIMINATE: usize = 1024;

/// Sweeps after which a policy's values are found by elimination instead, where that is possible.
/// With five successors a state they are a million multiplications, a small part of what an elimination
/// takes.
const PATIENCE: usize = 200;

/// Over-relaxed sweeps in which the largest change must halve; else plain sweeps take over, since
/// over-relaxation may circle for ever where plain sweeps converge.
const PATIENCE_OVER: usize = 48;

/// How far the window of over-relaxed sweeps advances at each, in units of the square root of the
/// number of pairs: about one step from the exits in a plane.
const ADVANCE: usize = 2;

/// How often the window sweeps each pair. A pair also leans on those behind it, which come into the
/// window a little later: one pass is not enough (E\[steps\] on 200 × 200 cells then takes 25 backups a
/// pair, with 8 passes 21, with 32 and with 128 18), and later ones are cheap, for what did not change is
/// skipped.
const OVERLAP: usize = 32;

/// Changes below this, relative to the largest value, are not carried on by over-relaxed sweeps: a
/// hundredth of the error that is allowed, so that the plain sweeps find little left to do.
const RELAXED: f64 = 1e-13;

/// The most sweeps; reached only where probabilities of leaving are below about 1e-6.
const SWEEPS: usize = 1_000_000;

/// What over-relaxed sweeps change.
///
/// `arrivals` is kept beside the values and not computed from them, for a backup reads each successor
/// many times and payments cost a look-up.
struct Relaxation<'a> {
    values: &'a mut [f64],
    arrivals: &'a mut [f64],
    /// The pairs of which a successor has changed.
    stale: Vec<bool>,
    gathered: Vec<f64>,
    /// The largest value so far.
    top: f64,
}

/// A component: its members, and the order of its pairs.
///
/// `members` are ascending, so membership is a binary search. A pair is (k, s), with k the place of
/// its automaton state among the members.
pub(super) struct Block<'a> {
    pub(super) problem: &'a Problem,
    pub(super) members: Vec<u32>,
    payment: &'a Payment,
    pub(super) discount: f64,
    /// The automaton does not move: sub-policy values.
    fixed: bool,
    order: Order,
    /// How far to over-relax each pair of the order, once they are settled.
    over: Vec<f32>,
}

impl<'a> Block<'a> {
    /// The component of `members`, all actions allowed.
    #[inline]
    pub(super) fn new(
        problem: &'a Problem,
        members: &[u32],
        payment: &'a Payment,
        discount: f64,
    ) -> Self {
        let order = graph::order(problem, members, None);
        let members = members.to_vec();
        Self { problem, members, payment, discount, fixed: false, order, over: Vec::new() }
    }

    /// The component of `members` under a policy, undiscounted.
    #[inline]
    pub(super) fn following(
        problem: &'a Problem,
        members: &[u32],
        payment: &'a Payment,
        policy: &[u32],
    ) -> Self {
        let order = graph::order(problem, members, Some(policy));
        let members = members.to_vec();
        Self { problem, members, payment, discount: 1.0, fixed: false, order, over: Vec::new() }
    }

    /// One automaton state that never moves.
    ///
    /// The paper's Eq. 3A6: progress is paid again and again, and q stays.
    #[inline]
    pub(super) fn fixed(problem: &'a Problem, q: u32, payment: &'a Payment, discount: f64) -> Self {
        Self { fixed: true, ..Self::new(problem, &[q], payment, discount) }
    }

    /// The same component under another payment.
    #[inline]
    pub(super) fn paying(self, payment: &'a Payment) -> Self {
        Self { payment, ..self }
    }

    /// The same component, without the reachable pairs that `keep` refuses.
    ///
    /// Pairs that cannot reach an exit are dropped too: nothing is asked of them.
    pub(super) fn only(mut self, keep: impl Fn(usize) -> bool) -> Self {
        self.order.pairs.truncate(self.order.reached);
        let (problem, members) = (self.problem, &self.members);
        let pair = |k: u32, s: u32| problem.task.pair(members[k as usize], s as usize);
        let seeds = &self.order.pairs[..self.order.seeds];
        self.order.seeds = seeds.iter().filter(|&&(k, s)| keep(pair(k, s))).count();
        self.order.pairs.retain(|&(k, s)| keep(pair(k, s)));
        self.order.reached = self.order.pairs.len();
        self
    }

    /// The pairs from which an exit can be reached.
    #[inline]
    pub(super) fn pairs(&self) -> impl Iterator<Item = usize> {
        let reached = &self.order.pairs[..self.order.reached];
        reached.iter().map(|&(k, s)| self.pair(k, s))
    }

    /// Sets the values to 1 and returns true if success is almost sure from every pair: all can
    /// reach an exit, and every exit is worth 1. (Going to a pair nearer an exit then succeeds
    /// sooner or later.) It saves the sweeps, and is exact.
    #[inline]
    pub(super) fn succeeds(&self, values: &mut [f64]) -> bool {
        let labelled = &self.problem.task;
        let exits_well = |&q: &u32| {
            let inside = |s| self.members.binary_search(&labelled.next(q, s)).is_ok();
            // 1 exactly: such payments are 0 and 1, and the values behind were set here.
            let well = |at| self.problem.worth(self.payment, 1.0, values, q, at) == 1.0;
            (0..self.width()).all(|at| (at < self.states() && inside(at)) || well(at))
        };
        let sure = self.order.reached == self.order.pairs.len();
        let sure = sure && self.members.iter().all(exits_well);
        if sure {
            self.pairs().for_each(|pair| values[pair] = 1.0);
        }
        sure
    }

    /// Gives the pairs that can reach an exit first values, and the order of their sweeps; see
    /// [`settle`].
    #[inline]
    pub(super) fn settled(mut self, values: &mut [f64], rule: &Rule<'_>) -> Self {
        let settled = settle(&self, values, rule);
        self.order.pairs[..settled.pairs.len()].copy_from_slice(&settled.pairs);
        self.over = settled.over;
        self
    }

    /// Starts from the largest action values of `table`.
    ///
    /// A table that is near the result saves sweeps. It cannot change the result: discounted sweeps
    /// are a contraction, whatever they start from.
    #[inline]
    pub(super) fn start(&self, values: &mut [f64], table: &QTable) {
        for &(k, s) in &self.order.pairs {
            values[self.pair(k, s)] = table.max(self.members[k as usize], s as usize);
        }
    }

    /// The pairs from which an exit can be reached.
    #[inline]
    pub(super) fn reached_pairs(&self) -> &[(u32, u32)] {
        &self.order.pairs[..self.order.reached]
    }

    /// Those of them from which it can be reached in one step, unless they are settled.
    #[inline]
    pub(super) fn seeds(&self) -> &[(u32, u32)] {
        &self.order.pairs[..self.order.seeds]
    }

    #[inline]
    pub(super) fn states(&self) -> usize {
        self.problem.task.states()
    }

    /// The number of arrivals of each member.
    #[inline]
    pub(super) fn width(&self) -> usize {
        self.problem.dynamics.arrivals()
    }

    #[inline]
    pub(super) fn pair(&self, k: u32, s: u32) -> usize {
        self.problem.task.pair(self.members[k as usize], s as usize)
    }

    #[inline]
    pub(super) fn next(&self, q: u32, s: usize) -> u32 {
        if self.fixed { q } else { self.problem.task.next(q, s) }
    }

    /// What arriving in each state is worth to each member: payment plus discounted value.
    #[inline]
    pub(super) fn arrivals(&self, values: &[f64]) -> Vec<f64> {
        let mut arrivals = Vec::with_capacity(self.members.len() * self.width());
        for &q in &self.members {
            for s in 0..self.states() {
                let value = values[self.problem.task.pair(self.next(q, s), s)];
                arrivals.push(self.problem.paid(self.payment, q, s) + self.discount * value);
            }
            let last = self.states()..self.width();
            arrivals.extend(last.map(|at| self.problem.paid_last(self.payment, q, at)));
        }
        arrivals
    }

    /// Sweeps until `values` is the fixed point of `rule`; over all pairs, or only those that can
    /// reach an exit.
    #[inline]
    pub(super) fn sweep(&self, values: &mut [f64], all: bool, rule: &Rule<'_>) {
        self.sweep_at_most(SWEEPS, values, all, rule);
    }

    /// The same with a limit; whether it got there.
    #[inline]
    fn sweep_at_most(&self, limit: usize, values: &mut [f64], all: bool, rule: &Rule<'_>) -> bool {
        let count = if all { self.order.pairs.len() } else { self.order.reached };
        let pairs = &self.order.pairs[..count];
        let mut arrivals = self.arrivals(values);
        if !self.over.is_empty() {
            self.relax(pairs, values, &mut arrivals, rule);
        }
        let mut before = f64::INFINITY;
        for _ in 0..limit {
            let (change, top) = self.sweep_once(pairs, values, &mut arrivals, rule);
            if self.is_done(change, before, top) {
                return true;
            }
            before = change;
        }
        false
    }

    /// Over-relaxed sweeps of the pairs of which a successor has changed: first in a window that
    /// advances from the exits outwards, then everywhere, while that helps. What they leave, plain
    /// sweeps mend, for over-relaxation alone need not converge.
    #[inline]
    fn relax(
        &self,
        pairs: &[(u32, u32)],
        values: &mut [f64],
        arrivals: &mut [f64],
        rule: &Rule<'_>,
    ) {
        // At first all are: no value has been backed up yet.
        let stale = alloc::vec![true; self.members.len() * self.states()];
        let mut relaxed = Relaxation { values, arrivals, stale, gathered: Vec::new(), top: 1.0 };
        let step = (ADVANCE * pairs.len().isqrt()).max(1);
        for end in (step..pairs.len()).step_by(step) {
            let start = end.saturating_sub(OVERLAP * step);
            self.relax_once(pairs, start..end, &mut relaxed, rule);
        }
        let (mut least, mut idle) = (f64::INFINITY, 0);
        while idle < PATIENCE_OVER {
            let change = self.relax_once(pairs, 0..pairs.len(), &mut relaxed, rule);
            if change <= RELAXED * relaxed.top {
                return;
            }
            idle = if change < 0.5 * least { 0 } else { idle + 1 };
            least = if idle == 0 { change } else { least };
        }
    }

    /// One such sweep over a range of the pairs; the largest difference of a backup.
    #[inline]
    fn relax_once(
        &self,
        pairs: &[(u32, u32)],
        range: core::ops::Range<usize>,
        relaxed: &mut Relaxation<'_>,
        rule: &Rule<'_>,
    ) -> f64 {
        let Relaxation { values, arrivals, stale, gathered, top } = relaxed;
        let (mut change, small): (f64, f64) = (0.0, RELAXED * *top);
        for i in range {
            let (k, s) = pairs[i];
            if !core::mem::take(&mut stale[k as usize * self.states() + s as usize]) {
                continue;
            }
            let pair = self.pair(k, s);
            let difference = self.back_up(pair, (k, s), arrivals, gathered, rule) - values[pair];
            // Pairs that were not settled are swept plainly.
            let over = self.over.get(i).map_or(1.0, |&over| f64::from(over));
            values[pair] += over * difference;
            change = change.max(difference.abs());
            *top = top.max(values[pair].abs());
            self.arrive(self.members[k as usize], s as usize, values[pair], |at, worth| {
                arrivals[at] = worth;
                if difference.abs() > small {
                    self.spread(at, stale);
                }
            });
        }
        change
    }

    /// Marks the pairs that lead to the arrival `at`.
    #[inline]
    fn spread(&self, at: usize, stale: &mut [bool]) {
        let (first, list) = &*self.problem.predecessors;
        let (layer, s) = (at / self.width() * self.states(), at % self.width());
        for &from in &list[first[s] as usize..first[s + 1] as usize] {
            stale[layer + from as usize] = true;
        }
    }

    /// The new value of a pair.
    #[inline]
    fn back_up(
        &self,
        pair: usize,
        (k, s): (u32, u32),
        arrivals: &[f64],
        gathered: &mut Vec<f64>,
        rule: &Rule<'_>,
    ) -> f64 {
        let dynamics = &self.problem.dynamics;
        let layer = &arrivals[k as usize * self.width()..];
        gathered.clear();
        gathered.extend(dynamics.successors(s as usize).iter().map(|&to| layer[to as usize]));
        let backup = Backup { matrix: dynamics.matrix(s as usize), arrivals: gathered };
        rule.value(pair, &backup)
    }

    /// Whether the error is small enough (absolute for values up to 1, relative above), given the largest change of this sweep and the last.
    /// Discounted, the error is at most γ / (1 − γ) times the change; undiscounted, the rate at
    /// which changes shrink, taken as at least a half, takes the place of γ.
    ///
    /// The rate is taken as at least a half, for one lucky sweep must not end the search; where the
    /// change does not shrink at all the rate is 1 and nothing is ever small enough.
    #[inline]
    fn is_done(&self, change: f64, before: f64, top: f64) -> bool {
        let shrinks = if before.is_finite() { (change / before).clamp(0.5, 1.0) } else { 1.0 };
        let rate = if self.discount < 1.0 { self.discount } else { shrinks };
        change * rate <= TOLERANCE * top.max(1.0) * (1.0 - rate)
    }

    /// One pass in order; the largest change, and the largest value.
    #[inline]
    fn sweep_once(
        &self,
        pairs: &[(u32, u32)],
        values: &mut [f64],
        arrivals: &mut [f64],
        rule: &Rule<'_>,
    ) -> (f64, f64) {
        let mut gathered = Vec::new();
        let (mut change, mut top): (f64, f64) = (0.0, 0.0);
        for &(k, s) in pairs {
            let pair = self.pair(k, s);
            let value = self.back_up(pair, (k, s), arrivals, &mut gathered, rule);
            change = change.max((value - values[pair]).abs());
            top = top.max(value.abs());
            values[pair] = value;
            let entered = self.members[k as usize];
            self.arrive(entered, s as usize, value, |at, worth| arrivals[at] = worth);
        }
        (change, top)
    }

    /// Tells where, among the arrivals, reading `s` enters `q`, and what that is worth now that `q`
    /// at `s` is worth `value`.
    #[inline]
    pub(super) fn arrive(&self, q: u32, s: usize, value: f64, mut tell: impl FnMut(usize, f64)) {
        for (j, &member) in self.members.iter().enumerate() {
            if self.next(member, s) == q {
                let paid = self.problem.paid(self.payment, member, s);
                tell(j * self.width() + s, paid + self.discount * value);
            }
        }
    }

    /// The values of a policy: value(x) = cost(x) + E\[arrival\], over the pairs that can reach
    /// an exit under it.
    ///
    /// The system has one solution because every one of these pairs leaves in the end; pairs that
    /// cannot leave would make it singular, and are not part of it.
    #[inline]
    pub(super) fn solve(&self, values: &mut [f64], costs: &[f64], policy: &[u32]) {
        let rule = &Rule::Cost { costs, policy };
        let small = self.order.reached <= ELIMINATE;
        let limit = if small { PATIENCE } else { SWEEPS };
        if !self.sweep_at_most(limit, values, false, rule) && small {
            self.eliminate(values, costs, policy);
        }
    }

    /// The same by Gaussian elimination with pivoting.
    ///
    /// Unknown i is pair i of the order; what leads out of the component, or to a pair that is not in
    /// the system, is a constant of its equation. I − P is diagonally dominant by rows, the kind of
    /// system on which elimination loses little.
    #[inline]
    fn eliminate(&self, values: &mut [f64], costs: &[f64], policy: &[u32]) {
        self.pairs().for_each(|pair| values[pair] = 0.0);
        let outside = self.arrivals(values);
        let pairs = &self.order.pairs[..self.order.reached];
        let mut column = alloc::vec![usize::MAX; self.members.len() * self.states()];
        for (i, &(k, s)) in pairs.iter().enumerate() {
            column[k as usize * self.states() + s as usize] = i;
        }
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(pairs.len());
        for (i, &(k, s)) in pairs.iter().enumerate() {
            let pair = self.pair(k, s);
            let mut row = self.equation((k, s), policy[pair], &column, &outside, pairs.len());
            row[i] += 1.0;
            row[pairs.len()] += costs[pair];
            rows.push(row);
        }
        eliminate(&mut rows);
        for (&(k, s), row) in pairs.iter().zip(&rows) {
            values[self.pair(k, s)] = row[pairs.len()];
        }
    }

    /// −p for each unknown that the pair leads to; at `n`, what it gets from outside.
    ///
    /// `column` has the unknown of each pair of the component, `usize::MAX` for pairs without one.
    #[inline]
    fn equation(
        &self,
        (k, s): (u32, u32),
        action: u32,
        column: &[usize],
        outside: &[f64],
        n: usize,
    ) -> Vec<f64> {
        let mut row = alloc::vec![0.0; n + 1];
        let successors = self.problem.dynamics.successors(s as usize);
        let p = &self.problem.dynamics.matrix(s as usize)[action as usize * successors.len()..];
        for (&to, p) in successors.iter().zip(p) {
            let to = to as usize;
            row[n] += p * outside[k as usize * self.width() + to];
            if to >= self.states() {
                continue;
            }
            let q = self.next(self.members[k as usize], to);
            if let Ok(j) = self.members.binary_search(&q)
                && let Some(unknown) = row[..n].get_mut(column[j * self.states() + to])
            {
                *unknown -= p;
            }
        }
        row
    }
}

/// Solves the equations in place: the last column of each row becomes its unknown. Zeros are skipped,
/// for a state leads to few others, and rows fill up only as the elimination goes on.
#[inline]
fn eliminate(rows: &mut [Vec<f64>]) {
    let n = rows.len();
    for i in 0..n {
        let mut pivot = i;
        for j in i + 1..n {
            if rows[j][i].abs() > rows[pivot][i].abs() {
                pivot = j;
            }
        }
        rows.swap(i, pivot);
        let (above, below) = rows.split_at_mut(i + 1);
        // No pivot is 0: every pair leaves the component in the end, so the system has one solution.
        let pivot = &above[i];
        for row in below.iter_mut().filter(|row| row[i] != 0.0) {
            let factor = row[i] / pivot[i];
            row[i..].iter_mut().zip(&pivot[i..]).for_each(|(x, p)| *x -= factor * p);
        }
    }
    for i in (0..n).rev() {
        let (above, below) = rows.split_at_mut(i + 1);
        let row = &mut above[i];
        let known: f64 = (i + 1..n).map(|j| row[j] * below[j - i - 1][n]).sum();
        row[n] = (row[n] - known) / row[i];
    }
}
