//! The system of a policy by complete elimination, without subtraction.
//!
//! Grassmann, Taksar and Heyman (1985): an unknown is eliminated from the equations of the others by
//! adding what its ways lead to, and what is left on the diagonal is the *sum* of what leads elsewhere. Each
//! number is a sum of products of probabilities, so that every result has a small *relative* error, however
//! slowly a world is left: of the order of n³ ε for n unknowns (O'Cinneide 1993; for probabilities of
//! leaving by the same argument, as quotients of sums over forests).
//!
//! Unknowns that are far from the exits are eliminated first. In a world in which steps are short, what is
//! added then stays near the diagonal; where it does not, the work is soon too much, and given up.

use alloc::vec::Vec;

use super::component::NONE;
use super::rows::Rows;

/// The most unknowns of systems that are always eliminated.
pub(super) const SMALL: usize = 64;

/// The most entries that are added: a third of a second.
const WORK: usize = 30_000_000;

/// The relative error of what has no negative payment.
#[inline]
pub(super) fn relative_error(unknowns: usize) -> f64 {
    let n = unknowns as f64;
    4.0 * n * n * n * f64::EPSILON
}

/// One equation: s x = b + Σ p x, with s the sum of all p and of what leads out.
#[derive(Clone, Default)]
struct Row {
    /// By unknown, ascending.
    entries: Vec<(u32, f64)>,
    out: f64,
    b: f64,
}

/// The values of a policy, unless it is too much work; `cost` by code. Every unknown leaves in the end.
#[inline]
pub(super) fn eliminate(equations: &Rows<'_>, policy: &[u32]) -> Option<Vec<f64>> {
    let (n, mut work) = (policy.len(), 0);
    // By unknown, those with smaller numbers that lead to it.
    let mut before = alloc::vec![Vec::new(); n];
    let mut rows: Vec<Row> = (0..n).map(|i| row(equations, policy, i)).collect();
    for (i, row) in rows.iter().enumerate() {
        let later = row.entries.iter().filter(|(j, _)| *j as usize > i);
        later.for_each(|(j, _)| before[*j as usize].push(i));
    }
    let mut sums = alloc::vec![0.0; n];
    for k in (0..n).rev() {
        let own = core::mem::take(&mut rows[k]);
        sums[k] = own.out + own.entries.iter().map(|(_, p)| p).sum::<f64>();
        for i in core::mem::take(&mut before[k]) {
            work += own.entries.len() + rows[i].entries.len();
            if work > WORK {
                return None;
            }
            add(&mut rows[i], i, &own, (k as u32, sums[k]), |j| before[j as usize].push(i));
        }
        rows[k] = own;
    }
    let mut x: Vec<f64> = Vec::with_capacity(n);
    for (row, sum) in rows.iter().zip(&sums) {
        let later: f64 = row.entries.iter().map(|&(j, p)| p * x[j as usize]).sum();
        x.push((row.b + later) / sum);
    }
    Some(x)
}

/// The equation of an unknown.
#[inline]
fn row(equations: &Rows<'_>, policy: &[u32], i: usize) -> Row {
    let mut row = Row { b: equations.cost(i), ..Row::default() };
    for (p, target, worth) in equations.outcomes(i).of(policy[i] as usize) {
        row.b += p * worth;
        if target == NONE {
            row.out += p;
        } else {
            row.out += (1.0 - equations.discount()) * p;
            row.entries.push((target, equations.discount() * p));
        }
    }
    row.entries.retain(|&(j, _)| j as usize != i);
    row.entries.sort_unstable_by_key(|&(j, _)| j);
    row
}

/// Replaces `k` in the row of `i` by what it leads to, and tells which unknowns after `i` are new in it.
#[inline]
fn add(row: &mut Row, i: usize, own: &Row, (k, sum): (u32, f64), mut tell: impl FnMut(u32)) {
    let Ok(at) = row.entries.binary_search_by_key(&k, |&(j, _)| j) else { return };
    let part = row.entries.remove(at).1 / sum;
    (row.out, row.b) = (row.out + part * own.out, row.b + part * own.b);
    let old = core::mem::take(&mut row.entries);
    let mut old = old.into_iter().peekable();
    for &(j, p) in &own.entries {
        while let Some(entry) = old.next_if(|&(other, _)| other < j) {
            row.entries.push(entry);
        }
        let there = old.next_if(|&(other, _)| other == j).map(|(_, p)| p);
        if j as usize != i {
            row.entries.push((j, there.unwrap_or(0.0) + part * p));
            if there.is_none() && j as usize > i {
                tell(j);
            }
        }
    }
    row.entries.extend(old);
}
