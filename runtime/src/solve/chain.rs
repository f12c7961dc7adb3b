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

//!
//! In a wide world memory is what takes the time, and a correction need not be good to many digits, for the
//! residual is computed anew after it. So there [`Factors::SumPreserving`] keep and compute with single precision.

use alloc::vec::Vec;
use core::iter::Sum;
use core::ops::{Add, Mul};

use super::component::NONE;
use super::rows::Rows;

/// The iterations of one correction at most: what they do not reach, the next correction does.
const ITERATIONS: usize = 60;

/// Unknowns from which on iterations are dear: their number grows with the way through the world, if factors
/// do not treat smooth errors exactly.
pub(super) const WIDE: usize = 1 << 17;

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

/// A number of some precision.
pub(super) trait Real:
    Copy + Default + Add<Output = Self> + Mul<Output = Self> + Sum
{
    /// The least part of a residual that a correction can leave.
    const LEAST: f64;

    fn of(value: f64) -> Self;

    fn wide(self) -> f64;
}

impl Real for f64 {
    const LEAST: Self = 0.0;

    #[inline]
    fn of(value: f64) -> Self {
        value
    }

    #[inline]
    fn wide(self) -> f64 {
        self
    }
}

impl Real for f32 {
    const LEAST: f64 = 1e-5;

    #[inline]
    fn of(value: f64) -> Self {
        value as Self
    }

    #[inline]
    fn wide(self) -> f64 {
        self.into()
    }
}

/// The equations of a policy, in the precision of their factors.
pub(super) enum Chain {
    Double(Equations<f64>),
    Single(Equations<f32>),
}

impl Chain {
    /// The system of a policy, which has an action for each unknown.
    #[inline]
    pub(super) fn new(rows: &Rows<'_>, policy: &[u32], factors: Factors) -> Self {
        if policy.len() >= WIDE && matches!(factors, Factors::SumPreserving) {
            return Self::Single(Equations::new(rows, policy, factors));
        }
        Self::Double(Equations::new(rows, policy, factors))
    }

    /// The least part of a residual that a correction can leave.
    #[inline]
    pub(super) const fn least(&self) -> f64 {
        match self {
            Self::Double(_) => <f64 as Real>::LEAST,
            Self::Single(_) => <f32 as Real>::LEAST,
        }
    }

    /// The probability of an unknown to lead elsewhere at all.
    #[inline]
    pub(super) fn moving(&self, i: usize) -> f64 {
        match self {
            Self::Double(equations) => equations.moving(i),
            Self::Single(equations) => equations.moving(i),
        }
    }

    /// The unknowns that never leave, of the chain of this policy.
    #[inline]
    pub(super) fn trapped(&self, rows: &Rows<'_>, policy: &[u32]) -> Vec<usize> {
        match self {
            Self::Double(equations) => equations.trapped(rows, policy),
            Self::Single(equations) => equations.trapped(rows, policy),
        }
    }

    /// Adds to `x` the correction for `residual`, which is b + P x − x: solved until what is left of the
    /// residual, preconditioned, is at most `reduction` of what it was, or as little as the precision allows.
    #[inline]
    pub(super) fn correct(&self, residual: Vec<f64>, x: &mut [f64], reduction: f64) -> bool {
        match self {
            Self::Double(equations) => equations.correct(residual, x, reduction),
            Self::Single(equations) => equations.correct(residual, x, reduction),
        }
    }
}

/// The equations, divided by d.
pub(super) struct Equations<T> {
    /// Where the row of each unknown begins, and where the last one ends.
    first: Vec<u32>,
    /// Where the entries above the diagonal begin.
    middle: Vec<u32>,
    column: Vec<u32>,
    entry: Vec<T>,
    /// 1 / d.
    scale: Vec<T>,
    /// The diagonal of I − P.
    diagonal: Vec<T>,
    /// Whether from each unknown there is a way out over those before it.
    leaves: bool,
}

impl<T: Real> Equations<T> {
    #[inline]
    fn new(rows: &Rows<'_>, policy: &[u32], factors: Factors) -> Self {
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
        let (mut below, mut above) = (Vec::new(), Vec::new());
        chain.first.push(0);
        for (i, &a) in policy.iter().enumerate() {
            let (mut leaving, mut moving, mut back, mut left) = (0.0, 0.0, 0.0, 0.0);
            let mut leaves = false;
            below.clear();
            above.clear();
            for (p, target, _) in rows.outcomes(i).of(a as usize) {
                let (j, inside) = (target as usize, rows.discount() * p);
                leaving += if target == NONE { p } else { (1.0 - rows.discount()) * p };
                leaves |= target == NONE || j < i && way[j];
                if j < i {
                    below.push((target, inside));
                    (moving, left) = (moving + inside, left + inside * sigma[j]);
                    if matches!(factors, Factors::Plain) {
                        let returns = chain.above(j).find(|&(k, _)| k == i);
                        back += inside * returns.map_or(0.0, |(_, p)| p.wide());
                    }
                } else if j > i && target != NONE {
                    above.push((target, inside));
                }
            }
            let up: f64 = above.iter().map(|(_, p)| p).sum();
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
            chain.scale.push(T::of(1.0 / d));
            chain.diagonal.push(T::of(diagonal / d));
            chain.middle.push((chain.column.len() + below.len()) as u32);
            for &(target, p) in below.iter().chain(&above) {
                chain.column.push(target);
                chain.entry.push(T::of(p / d));
            }
            chain.first.push(chain.column.len() as u32);
        }
        chain
    }

    #[inline]
    fn moving(&self, i: usize) -> f64 {
        (self.diagonal[i].wide() / self.scale[i].wide()).max(f64::MIN_POSITIVE)
    }

    #[inline]
    fn below(&self, i: usize) -> impl Iterator<Item = (usize, T)> {
        self.entries(self.first[i] as usize, self.middle[i] as usize)
    }

    #[inline]
    fn above(&self, i: usize) -> impl Iterator<Item = (usize, T)> {
        self.entries(self.middle[i] as usize, self.first[i + 1] as usize)
    }

    #[inline]
    fn entries(&self, from: usize, to: usize) -> impl Iterator<Item = (usize, T)> {
        self.column[from..to].iter().map(|&j| j as usize).zip(self.entry[from..to].iter().copied())
    }

    #[inline]
    fn trapped(&self, rows: &Rows<'_>, policy: &[u32]) -> Vec<usize> {
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

    #[inline]
    fn correct(&self, residual: Vec<f64>, x: &mut [f64], reduction: f64) -> bool {
        let n = residual.len();
        let scaled = || residual.iter().zip(&self.scale).map(|(r, scale)| r * scale.wide());
        let unit = scaled().fold(0.0, |most: f64, r| most.max(r.abs()));
        if unit == 0.0 {
            return true;
        }
        let mut r: Vec<T> = scaled().map(|r| T::of(r / unit)).collect();
        drop(residual);
        self.forward(&mut r);
        let shadow = r.clone();
        let start = dot(&r, &r);
        let (mut p, mut y) = (r.clone(), alloc::vec![T::default(); n]);
        let (mut v, mut t, mut work) = (y.clone(), y.clone(), y.clone());
        let (mut rho, mut best) = (start, start);
        let reduction = reduction.max(T::LEAST);
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
            let less = T::of(-alpha);
            r.iter_mut().zip(&v).for_each(|(r, v)| *r = *r + less * *v);
            self.apply(&r, &mut t, &mut work);
            let (tr, tt) = (dot(&t, &r), dot(&t, &t));
            let omega = if tt > 0.0 { tr / tt } else { 0.0 };
            let (more, on, less) = (T::of(alpha), T::of(omega), T::of(-omega));
            for i in 0..n {
                y[i] = y[i] + (more * p[i] + on * r[i]);
                r[i] = r[i] + less * t[i];
            }
            best = dot(&r, &r);
            let next = dot(&shadow, &r);
            let beta = next / rho * (alpha / omega);
            rho = next;
            if !beta.is_finite() {
                break;
            }
            let beta = T::of(beta);
            for i in 0..n {
                p[i] = r[i] + beta * (p[i] + less * v[i]);
            }
        }
        self.backward(&mut y);
        let better = best < start && y.iter().all(|y| y.wide().is_finite());
        if better {
            x.iter_mut().zip(&y).for_each(|(x, y)| *x += unit * y.wide());
        }
        better && best <= limit
    }

    /// (I − L)⁻¹.
    #[inline]
    fn forward(&self, x: &mut [T]) {
        for i in 0..x.len() {
            x[i] = x[i] + self.below(i).map(|(j, p)| p * x[j]).sum();
        }
    }

    /// (I − U)⁻¹.
    #[inline]
    fn backward(&self, x: &mut [T]) {
        for i in (0..x.len()).rev() {
            x[i] = x[i] + self.above(i).map(|(j, p)| p * x[j]).sum();
        }
    }

    /// `to` = (I − L)⁻¹ A (I − U)⁻¹ `from`, with A = diagonal − L − U: as (I − L) + (I − U) + (diagonal − 2)
    /// it takes one look at each entry (Eisenstat 1981).
    #[inline]
    fn apply(&self, from: &[T], to: &mut [T], work: &mut [T]) {
        work.copy_from_slice(from);
        self.backward(work);
        let less = T::of(-2.0);
        for i in 0..from.len() {
            let own = (self.diagonal[i] + less) * work[i] + from[i];
            to[i] = own + self.below(i).map(|(j, p)| p * to[j]).sum();
        }
        to.iter_mut().zip(&*work).for_each(|(to, t)| *to = *to + *t);
    }
}

/// Σ a · b, in four sums of double precision.
#[inline]
fn dot<T: Real>(a: &[T], b: &[T]) -> f64 {
    let (mut sums, mut at) = ([0.0; 4], 0);
    for (a, b) in a.chunks_exact(4).zip(b.chunks_exact(4)) {
        (0..4).for_each(|i| sums[i] += a[i].wide() * b[i].wide());
        at += 4;
    }
    let rest: f64 = a[at..].iter().zip(&b[at..]).map(|(a, b)| a.wide() * b.wide()).sum();
    sums.iter().sum::<f64>() + rest
}
