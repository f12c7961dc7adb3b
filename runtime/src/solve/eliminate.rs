//! The system of a policy by complete elimination, without subtraction.
//!
//! Grassmann, Taksar and Heyman (1985): an unknown is eliminated from the equations of the others by
//! adding what its ways lead to, and what is left on the diagonal is the *sum* of what leads elsewhere. Each
//! number is a sum of products of probabilities, so that every result has a small *relative* error, however
//! slowly a world is left: of the order of n³ ε for n unknowns (O'Cinneide 1993; for probabilities of
//! leaving by the same argument, as quotients of sums over forests).
//!
//! Unknowns that are far from the exits are eliminated first. In a world in which steps are short, what is
//! added then stays near the diagonal; where it does not, rows fill, and what is left is eliminated as a full
//! matrix, unless there is too much of it.

use alloc::vec::Vec;

use super::component::NONE;
use super::rows::Rows;

/// The most unknowns of systems that are always eliminated.
pub(super) const SMALL: usize = 64;

/// The most entries that are added: a third of a second.
const WORK: usize = 30_000_000;

/// The most unknowns of a full matrix: half a second, and 8 MB.
const FULL: usize = 1000;

/// The relative error of what has no negative payment.
#[inline]
pub(super) fn relative_error(unknowns: usize) -> f64 {
    let n = unknowns as f64;
    let error = 4.0 * n * n * n * f64::EPSILON;
    if error < 0.5 { error / (1.0 - error) } else { f64::INFINITY }
}

/// One equation: s x = b + Σ p x, with s the sum of all p and of what leads out.
#[derive(Clone, Default)]
struct Row {
    /// By unknown, ascending.
    entries: Vec<(u32, f64)>,
    out: f64,
    b: f64,
    /// s, once those after it are eliminated.
    sum: f64,
}

/// The values of a policy that is paid `b` in each step, unless it is too much work. Every unknown leaves in
/// the end.
#[inline]
pub(super) fn eliminate(
    equations: &Rows<'_>,
    policy: &[u32],
    b: impl Fn(usize, u32) -> f64,
) -> Option<Vec<f64>> {
    let (n, mut work) = (policy.len(), 0);
    // By unknown, those with smaller numbers that lead to it.
    let mut before = alloc::vec![Vec::new(); n];
    let mut rows: Vec<Row> =
        policy.iter().enumerate().map(|(i, &a)| row(equations, i, a, b(i, a))).collect();
    for (i, row) in rows.iter().enumerate() {
        let later = row.entries.iter().filter(|(j, _)| *j as usize > i);
        later.for_each(|(j, _)| before[*j as usize].push(i));
    }
    for k in (0..n).rev() {
        if (SMALL..FULL).contains(&k) && rows[k].entries.len() > k / 4 {
            full(&mut rows[..=k]);
            break;
        }
        let mut own = core::mem::take(&mut rows[k]);
        own.sum = own.out + own.entries.iter().map(|(_, p)| p).sum::<f64>();
        for i in core::mem::take(&mut before[k]) {
            work += own.entries.len() + rows[i].entries.len();
            if work > WORK {
                return None;
            }
            add(&mut rows[i], i, &own, k as u32, |j| before[j as usize].push(i));
        }
        rows[k] = own;
    }
    let mut x: Vec<f64> = Vec::with_capacity(n);
    for row in &rows {
        let later: f64 = row.entries.iter().map(|&(j, p)| p * x[j as usize]).sum();
        x.push((row.b + later) / row.sum);
    }
    Some(x)
}

/// The equation of an unknown under an action.
#[inline]
fn row(equations: &Rows<'_>, i: usize, a: u32, b: f64) -> Row {
    let mut row = Row { b, ..Row::default() };
    for (p, target, _) in equations.outcomes(i).of(a as usize) {
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

/// Eliminates the unknowns of `rows`, which lead to no others, as a full matrix.
#[inline]
fn full(rows: &mut [Row]) {
    let n = rows.len();
    let mut matrix = alloc::vec![0.0; n * n];
    for (row, to) in rows.iter().zip(matrix.chunks_exact_mut(n)) {
        row.entries.iter().for_each(|&(j, p)| to[j as usize] = p);
    }
    for k in (0..n).rev() {
        let (above, own) = matrix.split_at_mut(k * n);
        let (before, own_row) = rows.split_at_mut(k);
        let (own, own_row) = (&own[..k], &mut own_row[0]);
        own_row.sum = own_row.out + own.iter().sum::<f64>();
        own_row.entries.clear();
        own_row.entries.extend((0..).zip(own.iter().copied()).filter(|&(_, p)| p > 0.0));
        for (i, (to, row)) in above.chunks_exact_mut(n).zip(before).enumerate() {
            if to[k] > 0.0 {
                let part = to[k] / own_row.sum;
                (row.out, row.b) = (row.out + part * own_row.out, row.b + part * own_row.b);
                to.iter_mut().zip(own).for_each(|(to, p)| *to += part * p);
                to[i] = 0.0;
            }
        }
    }
}

/// Replaces `k` in the row of `i` by what it leads to, and tells which unknowns after `i` are new in it.
#[inline]
fn add(row: &mut Row, i: usize, own: &Row, k: u32, mut tell: impl FnMut(u32)) {
    let Ok(at) = row.entries.binary_search_by_key(&k, |&(j, _)| j) else { return };
    let part = row.entries.remove(at).1 / own.sum;
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
