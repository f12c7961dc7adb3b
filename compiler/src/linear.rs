//! Whether a system of linear inequalities over the reals has a solution: Fourier–Motzkin
//! elimination in exact integer arithmetic.
//!
//! One variable after the other is eliminated by adding every upper bound on it to every lower one,
//! the variable with the fewest such pairs first. That can grow doubly exponentially, so systems
//! that outgrow [`MOST`] inequalities or 100 bits are given up; the systems that predicates make
//! have a handful of each.

use std::collections::{BTreeMap, BTreeSet};

use crate::predicate::TermId;

/// More inequalities than this are not looked at.
pub const MOST: usize = 512;
/// Coefficients stay below this, so that sums of two products do not overflow.
const LARGE: i128 = 1 << 62;

/// Σ coefficient × variable ≤ bound, or < bound.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Inequality {
    /// The coefficient of each variable; none is 0.
    pub coefficients: BTreeMap<TermId, i128>,
    /// The bound.
    pub bound: i128,
    /// Whether the bound itself is excluded.
    pub strict: bool,
}

/// Whether the system has a real solution; `None` if that would be too much work to find out.
#[must_use]
pub fn feasible(system: &[Inequality]) -> Option<bool> {
    let mut system: BTreeSet<Inequality> = system.iter().map(reduced).collect();
    while let Some(variable) = cheapest(&system) {
        let (with, mut rest): (BTreeSet<_>, BTreeSet<_>) =
            system.into_iter().partition(|row| row.coefficients.contains_key(&variable));
        let (upper, lower): (Vec<_>, Vec<_>) =
            with.iter().partition(|row| row.coefficients[&variable] > 0);
        for a in upper {
            for b in &lower {
                rest.insert(eliminated(a, b, variable)?);
            }
        }
        if rest.len() > MOST {
            return None;
        }
        system = rest;
    }
    Some(system.iter().all(|row| row.bound > 0 || row.bound == 0 && !row.strict))
}

/// The variable whose elimination makes the fewest new rows.
fn cheapest(system: &BTreeSet<Inequality>) -> Option<TermId> {
    let mut signs: BTreeMap<TermId, (usize, usize)> = BTreeMap::new();
    for (&variable, &coefficient) in system.iter().flat_map(|row| &row.coefficients) {
        let count = signs.entry(variable).or_default();
        *(if coefficient > 0 { &mut count.0 } else { &mut count.1 }) += 1;
    }
    signs.into_iter().min_by_key(|(_, (above, below))| above * below).map(|(variable, _)| variable)
}

/// The sum of an upper and a lower bound on `variable`, without it; `None` on overflow.
fn eliminated(upper: &Inequality, lower: &Inequality, variable: TermId) -> Option<Inequality> {
    let (up, down) = (-lower.coefficients[&variable], upper.coefficients[&variable]);
    let sum = |a: i128, b: i128| a.checked_mul(up)?.checked_add(b.checked_mul(down)?);
    let mut coefficients = BTreeMap::new();
    for &other in upper.coefficients.keys().chain(lower.coefficients.keys()) {
        let of = |row: &Inequality| row.coefficients.get(&other).copied().unwrap_or(0);
        let coefficient = sum(of(upper), of(lower))?;
        if coefficient != 0 {
            coefficients.insert(other, coefficient);
        }
    }
    let bound = sum(upper.bound, lower.bound)?;
    let row = reduced(&Inequality { coefficients, bound, strict: upper.strict || lower.strict });
    let small = |value: &i128| value.abs() < LARGE;
    (row.coefficients.values().all(small) && small(&row.bound)).then_some(row)
}

/// The same inequality without a common divisor.
fn reduced(row: &Inequality) -> Inequality {
    let divisor = row.coefficients.values().fold(row.bound.abs(), |a, &b| gcd(a, b.abs())).max(1);
    Inequality {
        coefficients: row.coefficients.iter().map(|(&term, &c)| (term, c / divisor)).collect(),
        bound: row.bound / divisor,
        strict: row.strict,
    }
}

/// The greatest common divisor of two numbers that are not negative.
#[must_use]
pub fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(coefficients: &[i128], bound: i128, strict: bool) -> Inequality {
        let terms = (0..).map(TermId).zip(coefficients.iter().copied());
        Inequality { coefficients: terms.filter(|(_, c)| *c != 0).collect(), bound, strict }
    }

    /// Systems over x, y, z as rows of coefficients, bound and strictness, and the verdict.
    #[test]
    fn verdicts() {
        let cases: [(&[Inequality], bool); 6] = [
            (&[], true),
            (&[row(&[1], 1, true), row(&[-1], -1, false)], false),
            (&[row(&[1], 1, false), row(&[-1], -1, false)], true),
            // x < 1, y < 1, x + y > 2
            (&[row(&[1], 1, true), row(&[0, 1], 1, true), row(&[-1, -1], -2, true)], false),
            // x ≤ 1, y ≤ 1, x + y ≥ 2
            (&[row(&[1], 1, false), row(&[0, 1], 1, false), row(&[-1, -1], -2, false)], true),
            // x < y < z < x
            (
                &[row(&[1, -1], 0, true), row(&[0, 1, -1], 0, true), row(&[-1, 0, 1], 0, true)],
                false,
            ),
        ];
        for (system, verdict) in cases {
            assert_eq!(feasible(system), Some(verdict), "{system:?}");
        }
    }

    /// Against all points of a small grid of halves: a grid solution is a solution.
    #[test]
    fn what_has_a_solution_is_feasible() {
        let mut random: u64 = 1;
        let mut next = |n: i128| {
            random = random.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            i128::from(random >> 33) % (2 * n + 1) - n
        };
        for _ in 0..300 {
            let system: Vec<Inequality> =
                (0..5).map(|_| row(&[next(2), next(2), next(2)], next(4), next(1) == 0)).collect();
            let point = |p: [i128; 3]| {
                system.iter().all(|row| {
                    let at = |(term, c): (&TermId, &i128)| c * p[term.0 as usize];
                    let value: i128 = row.coefficients.iter().map(at).sum();
                    value < 2 * row.bound || value == 2 * row.bound && !row.strict
                })
            };
            let all = -9..10;
            let solved =
                all.clone().any(|x| all.clone().any(|y| all.clone().any(|z| point([x, y, z]))));
            let verdict = feasible(&system).unwrap();
            assert!(verdict || !solved, "{system:?}");
        }
    }
}
