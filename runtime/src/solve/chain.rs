//! The linear system of a policy: x = b + P x, over the unknowns of a component.
//!
//! It is solved for corrections of x, by BiCGSTAB (van der Vorst 1992), preconditioned by an incomplete
//! elimination that changes the diagonal alone (Meijerink and van der Vorst 1977): with L and U the entries
//! of P below and above its diagonal, I − P is nearly (D − L) D⁻¹ (D − U), where
//!
//! ```text
//! d_i = 1 − p_ii − Σ_{j < i} p_ij p_ji / d_j
//! ```
//!
//! The better a numbering follows the ways of the policy, from the exits outwards, the less is left above
//! the diagonal; if nothing is, one iteration solves the system.

use alloc::vec::Vec;

use super::component::NONE;
use super::rows::Rows;

/// The iterations of one correction at most: what they do not reach, the next correction does.
const ITERATIONS: usize = 60;

/// How the diagonal of the incomplete elimination is found.
#[derive(Clone, Copy)]
pub(super) enum Factors {
    /// As above.
    Plain,
    /// So that the product has the row sums of I − P, and treats the constant vector exactly: the one that
    /// a slow world hardly changes (Gustafsson 1978). With σ_j the probability to have left when j is
    /// eliminated, d_i = leaving_i + Σ_{j < i} p_ij σ_j + Σ_{k > i} p_ik, without a subtraction.
    SumPreserving,
}

impl Factors {
    /// The others.
    #[inline]
    pub(super) const fn other(self) -> Self {
        match self {
            Self::Plain => Self::SumPreserving,
            Self::SumPreserving => Self::Plain,
        }
    }
}

/// The equations, divided by d.
pub(super) struct Chain {
    /// Where the row of each unknown begins, and where the last one ends.
    first: Vec<u32>,
    /// Where the entries above the diagonal begin.
    middle: Vec<u32>,
    column: Vec<u32>,
    entry: Vec<f64>,
    /// 1 / d.
    scale: Vec<f64>,
    /// The diagonal of I − P.
    diagonal: Vec<f64>,
    /// Whether from each unknown there is a way out over those before it.
    leaves: bool,
}

impl Chain {
    /// The system of a policy, which has an action for each unknown.
    #[inline]
    pub(super) fn new(rows: &Rows<'_>, policy: &[u32], factors: Factors) -> Self {
        let n = policy.len();
        let mut chain = Self {
            first: Vec::with_capacity(n + 1),
            middle: Vec::with_capacity(n),
            column: Vec::with_capacity(4 * n),
            entry: Vec::with_capacity(4 * n),
            scale: Vec::with_capacity(n),
            diagonal: Vec::with_capacity(n),
            leaves: true,
        };
        let (mut way, mut sigma) = (Vec::with_capacity(n), Vec::with_capacity(n));
        let mut above = Vec::new();
        chain.first.push(0);
        for (i, &a) in policy.iter().enumerate() {
            let (mut leaving, mut moving, mut back, mut left) = (0.0, 0.0, 0.0, 0.0);
            let mut leaves = false;
            above.clear();
            for (p, target, _) in rows.outcomes(i).of(a as usize) {
                let (j, inside) = (target as usize, rows.discount() * p);
                leaving += if target == NONE { p } else { (1.0 - rows.discount()) * p };
                leaves |= target == NONE || j < i && way[j];
                if j < i {
                    chain.column.push(target);
                    chain.entry.push(inside);
                    (moving, left) = (moving + inside, left + inside * sigma[j]);
                    let returns = chain.above(j).find(|&(k, _)| k == i).map_or(0.0, |(_, p)| p);
                    back += inside * returns;
                } else if j > i && target != NONE {
                    above.push((target, inside));
                }
            }
            chain.middle.push(chain.column.len() as u32);
            let up: f64 = above.iter().map(|(_, p)| p).sum();
            chain.column.extend(above.iter().map(|(target, _)| target));
            chain.entry.extend(above.iter().map(|(_, p)| p));
            let diagonal = leaving + moving + up;
            chain.leaves &= leaves;
            let d = match factors {
                // Above what rounding leaves of a difference.
                Factors::Plain => (diagonal - back).max(f64::EPSILON * diagonal),
                Factors::SumPreserving => leaving + left + up,
            };
            let d = d.max(f64::MIN_POSITIVE);
            sigma.push((leaving + left) / d);
            way.push(leaves);
            chain.scale.push(1.0 / d);
            chain.diagonal.push(diagonal / d);
            let from = chain.first[i] as usize;
            chain.entry[from..].iter_mut().for_each(|p| *p /= d);
            chain.first.push(chain.column.len() as u32);
        }
        chain
    }

    /// The probability of an unknown to lead elsewhere at all.
    #[inline]
    pub(super) fn moving(&self, i: usize) -> f64 {
        (self.diagonal[i] / self.scale[i]).max(f64::MIN_POSITIVE)
    }

    #[inline]
    fn below(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        self.entries(self.first[i] as usize, self.middle[i] as usize)
    }

    #[inline]
    fn above(&self, i: usize) -> impl Iterator<Item = (usize, f64)> {
        self.entries(self.middle[i] as usize, self.first[i + 1] as usize)
    }

    #[inline]
    fn entries(&self, from: usize, to: usize) -> impl Iterator<Item = (usize, f64)> {
        self.column[from..to].iter().map(|&j| j as usize).zip(self.entry[from..to].iter().copied())
    }

    /// The unknowns that never leave, of the chain of this policy.
    #[inline]
    pub(super) fn trapped(&self, rows: &Rows<'_>, policy: &[u32]) -> Vec<usize> {
        if self.leaves {
            return Vec::new();
        }
        let n = policy.len();
        let (mut first, mut found) = (alloc::vec![0_u32; n + 2], Vec::new());
        self.column.iter().for_each(|&j| first[j as usize + 2] += 1);
        (2..n + 2).for_each(|j| first[j] += first[j - 1]);
        let mut before = alloc::vec![0_u32; self.column.len()];
        let mut seen = alloc::vec![false; n];
        for i in 0..n {
            for &j in &self.column[self.first[i] as usize..self.first[i + 1] as usize] {
                let at = &mut first[j as usize + 1];
                before[*at as usize] = i as u32;
                *at += 1;
            }
            let mut outcomes = rows.outcomes(i).of(policy[i] as usize);
            if outcomes.any(|(_, target, _)| target == NONE) {
                seen[i] = true;
                found.push(i);
            }
        }
        while let Some(j) = found.pop() {
            for &i in &before[first[j] as usize..first[j + 1] as usize] {
                if !core::mem::replace(&mut seen[i as usize], true) {
                    found.push(i as usize);
                }
            }
        }
        (0..n).filter(|&i| !seen[i]).collect()
    }

    /// Adds to `x` the correction for `residual`, which is b + P x − x: solved until what is left of the
    /// residual, preconditioned, is at most `reduction` of what it was, if rounding allows.
    #[inline]
    pub(super) fn correct(&self, residual: &[f64], x: &mut [f64], reduction: f64) -> bool {
        let n = residual.len();
        let mut r: Vec<f64> =
            residual.iter().zip(&self.scale).map(|(r, scale)| r * scale).collect();
        self.forward(&mut r);
        let shadow = r.clone();
        let start = dot(&r, &r);
        let (mut p, mut y) = (r.clone(), alloc::vec![0.0; n]);
        let (mut v, mut t, mut work) = (y.clone(), y.clone(), y.clone());
        let (mut rho, mut best) = (start, start);
        let limit = reduction * reduction * start;
        for _ in 0..ITERATIONS {
            if !(rho != 0.0 && best > limit) {
                break;
            }
            self.apply(&p, &mut v, &mut work);
            let alpha = rho / dot(&shadow, &v);
            if !alpha.is_finite() {
                break;
            }
            r.iter_mut().zip(&v).for_each(|(r, v)| *r -= alpha * v);
            self.apply(&r, &mut t, &mut work);
            let (tr, tt) = (dot(&t, &r), dot(&t, &t));
            let omega = if tt > 0.0 { tr / tt } else { 0.0 };
            for i in 0..n {
                y[i] += alpha * p[i] + omega * r[i];
                r[i] -= omega * t[i];
            }
            best = dot(&r, &r);
            let next = dot(&shadow, &r);
            let beta = next / rho * (alpha / omega);
            rho = next;
            if !beta.is_finite() {
                break;
            }
            for i in 0..n {
                p[i] = r[i] + beta * (p[i] - omega * v[i]);
            }
        }
        self.backward(&mut y);
        let better = best < start && y.iter().all(|y| y.is_finite());
        if better {
            x.iter_mut().zip(&y).for_each(|(x, y)| *x += y);
        }
        better && best <= limit || start == 0.0
    }

    /// (I − L)⁻¹.
    #[inline]
    fn forward(&self, x: &mut [f64]) {
        for i in 0..x.len() {
            x[i] += self.below(i).map(|(j, p)| p * x[j]).sum::<f64>();
        }
    }

    /// (I − U)⁻¹.
    #[inline]
    fn backward(&self, x: &mut [f64]) {
        for i in (0..x.len()).rev() {
            x[i] += self.above(i).map(|(j, p)| p * x[j]).sum::<f64>();
        }
    }

    /// `to` = (I − L)⁻¹ A (I − U)⁻¹ `from`, with A = diagonal − L − U: as (I − L) + (I − U) + (diagonal − 2)
    /// it takes one look at each entry (Eisenstat 1981).
    #[inline]
    fn apply(&self, from: &[f64], to: &mut [f64], work: &mut [f64]) {
        work.copy_from_slice(from);
        self.backward(work);
        for i in 0..from.len() {
            let own = (self.diagonal[i] - 2.0) * work[i] + from[i];
            to[i] = own + self.below(i).map(|(j, p)| p * to[j]).sum::<f64>();
        }
        to.iter_mut().zip(&*work).for_each(|(to, t)| *to += t);
    }
}

#[inline]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let (mut sums, mut at) = ([0.0; 4], 0);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        (0..4).for_each(|i| sums[i] += a[i] * b[i]);
        at += 4;
    }
    let rest: f64 = a[at..].iter().zip(&b[at..]).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}
