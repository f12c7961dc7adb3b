//! Decides whether a system of linear inequalities over the reals has a solution: Fourier–Motzkin
//! elimination in exact integer arithmetic.
//!
//! # Method
//!
//! One variable after the other is eliminated by adding every upper bound on it to every lower
//! bound, the variable with the fewest such pairs first (Schrijver, "Theory of Linear and Integer
//! Programming", 1986, section 12.2). What is left are inequalities between numbers.
//!
//! # Why this way
//!
//! The simplex method has the better worst case and needs fractions, pivoting rules and strict
//! bounds as a special case. Elimination can grow doubly exponentially, so systems that outgrow
//! [`MOST`] inequalities, 62 bits or the caller's work are given up; the systems that predicates
//! make have a handful of each, and the code is a page.
//!
//! # Limits
//!
//! Solutions are real: `2*x == 1` has one although no integer satisfies it. The answer `None` means
//! "not known", and callers then treat the inequalities as independent.

use crate::predicate::TermId;

/// Systems with more inequalities than this are given up.
pub const MOST: usize = 512;
/// Coefficients stay below this, so that the sum of two products does not overflow an `i128`.
const LARGE: i128 = 1 << 62;

/// Variables with their coefficients, sorted by variable. No coefficient is 0 and no variable
/// stands twice, so equal forms are equal values.
pub type Form = Vec<(TermId, i128)>;

/// Σ coefficient × variable ≤ bound, or < bound.
///
/// ```
/// use tltl_compiler::linear::{Inequality, feasible};
/// use tltl_compiler::predicate::TermId;
///
/// // x ≤ 2 and -x ≤ -2 meet in one point, which strictness takes away.
/// let at_most = Inequality { form: vec![(TermId(0), 1)], bound: 2, strict: false };
/// let at_least = Inequality { form: vec![(TermId(0), -1)], bound: -2, strict: false };
/// let below = Inequality { strict: true, ..at_most.clone() };
/// let mut work = 100;
/// assert_eq!(feasible(&[at_most, at_least.clone()], &mut work), Some(true));
/// assert_eq!(feasible(&[below, at_least], &mut work), Some(false));
/// ```
#[derive(Clone, Debug)]
pub struct Inequality {
    /// The sum that is bounded.
    pub form: Form,
    /// The bound.
    pub bound: i128,
    /// Whether the bound itself is excluded.
    pub strict: bool,
}

/// Whether the system has a real solution; `None` if finding out would exceed a limit.
///
/// `work` is how many coefficients may be looked at: what is needed is taken from it, and it is 0
/// once it does not suffice.
///
/// ```
/// use tltl_compiler::linear::{Inequality, feasible};
/// use tltl_compiler::predicate::TermId;
///
/// let [x, y] = [0, 1].map(TermId);
/// let below = |form: &[(TermId, i128)], bound| Inequality { form: form.to_vec(), bound, strict: true };
/// // x < 1 and y < 1, and x + y > 2.
/// let system = [below(&[(x, 1)], 1), below(&[(y, 1)], 1), below(&[(x, -1), (y, -1)], -2)];
/// let mut work = 1000;
/// assert_eq!(feasible(&system[..2], &mut work), Some(true));
/// assert_eq!(feasible(&system, &mut work), Some(false));
/// assert_eq!(feasible(&system, &mut 5), None);
/// ```
#[must_use]
pub fn feasible(system: &[Inequality], work: &mut usize) -> Option<bool> {
    let mut system: Vec<Inequality> = system.iter().map(reduced).collect();
    while let Some(variable) = cheapest(&system) {
        let size = system.iter().map(|row| row.form.len() + 1).sum();
        spend(work, size)?;
        let (mut upper, mut lower, mut rest) = (Vec::new(), Vec::new(), Vec::new());
        for row in system {
            match coefficient(&row.form, variable) {
                0 => rest.push(row),
                above if above > 0 => upper.push(row),
                _ => lower.push(row),
            }
        }
        for a in &upper {
            for b in &lower {
                spend(work, a.form.len() + b.form.len())?;
                rest.push(eliminated(a, b, variable)?);
            }
        }
        keep_tightest(&mut rest);
        if rest.len() > MOST {
            return None;
        }
        system = rest;
    }
    Some(system.iter().all(|row| row.bound > 0 || row.bound == 0 && !row.strict))
}

/// Takes `cost` from `work`; `None` if it does not suffice.
fn spend(work: &mut usize, cost: usize) -> Option<()> {
    *work = work.saturating_sub(cost);
    (*work > 0).then_some(())
}

/// Leaves the tightest of the bounds on each form: elimination makes the same form many times over.
fn keep_tightest(rows: &mut Vec<Inequality>) {
    rows.sort_by(|a, b| (&a.form, a.bound, b.strict).cmp(&(&b.form, b.bound, a.strict)));
    rows.dedup_by(|looser, tight| looser.form == tight.form);
}

/// The variable whose elimination makes the fewest new inequalities, the first of several; `None`
/// if no variable is left.
fn cheapest(system: &[Inequality]) -> Option<TermId> {
    // For each variable whether each row bounds it from above.
    let known = system.iter().flat_map(|row| &row.form);
    let mut bounds: Vec<(TermId, bool)> = known.map(|&(term, by)| (term, by > 0)).collect();
    bounds.sort_unstable();
    let made = |of: &[(TermId, bool)]| {
        let above = of.iter().filter(|bound| bound.1).count();
        (above * (of.len() - above), of[0].0)
    };
    bounds.chunk_by(|a, b| a.0 == b.0).map(made).min().map(|(_, variable)| variable)
}

/// For each of some forms the groups that it is in, by number: forms in no common group take values
/// that do not depend on each other.
///
/// The groups are the fundamental circuits of the linear matroid of the forms (Oxley, "Matroid
/// Theory", 2011, section 1.2): Gaussian elimination expresses each form that depends on those
/// before it by some of them, and these are one group. Forms that are independent map the reals
/// onto all joint values: a chain `x < y`, `y < z` makes no group although its forms share
/// variables. `None` if a number grows too large.
///
/// ```
/// use tltl_compiler::linear::circuits;
/// use tltl_compiler::predicate::TermId;
///
/// let [x, y, z] = [0, 1, 2].map(TermId);
/// let [xy, yz, xz] = [(x, y), (y, z), (x, z)].map(|(a, b)| vec![(a, 1), (b, -1)]);
/// assert_eq!(circuits(&[&xy, &yz]), Some(vec![vec![], vec![]]));
/// assert_eq!(circuits(&[&xy, &yz, &xz]), Some(vec![vec![2], vec![2], vec![2]]));
/// ```
#[must_use]
pub fn circuits(forms: &[&Form]) -> Option<Vec<Vec<u32>>> {
    // Each form carries a variable of its own behind all others. What is left of a form that
    // depends on others says which.
    let own = forms.iter().flat_map(|form| form.last()).map(|&(term, _)| term.0 + 1).max()?;
    let mut groups = vec![Vec::new(); forms.len()];
    let mut pivots: Vec<(TermId, Form)> = Vec::new();
    for (number, form) in (0..).zip(forms) {
        let mut row = (*form).clone();
        row.push((TermId(own + number), 1));
        loop {
            let (first, by) = row[0];
            if first.0 >= own {
                row.iter().for_each(|(term, _)| groups[(term.0 - own) as usize].push(number));
                break;
            }
            let place = pivots.binary_search_by_key(&first, |pivot| pivot.0);
            let Ok(place) = place else {
                pivots.insert(place.unwrap_err(), (first, row));
                break;
            };
            let pivot = &pivots[place].1;
            let sum = |a: i128, b: i128| {
                let sum = a.checked_mul(pivot[0].1)?.checked_sub(b.checked_mul(by)?);
                sum.filter(|value| value.abs() < LARGE)
            };
            row = combined(&row, pivot, &sum)?;
            let divisor = divisor(&row, 0);
            row.iter_mut().for_each(|(_, coefficient)| *coefficient /= divisor);
        }
    }
    Some(groups)
}

/// The coefficient of a variable; 0 if the form does not have it.
fn coefficient(form: &Form, variable: TermId) -> i128 {
    form.binary_search_by_key(&variable, |known| known.0).map_or(0, |place| form[place].1)
}

/// The sum of an upper and a lower bound on `variable` in which it cancels out; `None` if a number
/// grows too large.
fn eliminated(upper: &Inequality, lower: &Inequality, variable: TermId) -> Option<Inequality> {
    let up = -coefficient(&lower.form, variable);
    let down = coefficient(&upper.form, variable);
    let sum = |a: i128, b: i128| a.checked_mul(up)?.checked_add(b.checked_mul(down)?);
    let form = combined(&upper.form, &lower.form, &sum)?;
    let bound = sum(upper.bound, lower.bound)?;
    let row = reduced(&Inequality { form, bound, strict: upper.strict || lower.strict });
    let small = |value: i128| value.abs() < LARGE;
    (row.form.iter().all(|known| small(known.1)) && small(row.bound)).then_some(row)
}

/// Merges two forms; `sum` gives the coefficient of each variable from those in `left` and `right`.
/// `None` if `sum` returns it.
///
/// ```
/// use tltl_compiler::linear::combined;
/// use tltl_compiler::predicate::TermId;
///
/// let [x, y] = [0, 1].map(TermId);
/// // (x + 2y) - (x - y) = 3y
/// let minus = |a: i128, b: i128| a.checked_sub(b);
/// assert_eq!(combined(&vec![(x, 1), (y, 2)], &vec![(x, 1), (y, -1)], &minus), Some(vec![(y, 3)]));
/// ```
pub fn combined(
    left: &Form,
    right: &Form,
    sum: &dyn Fn(i128, i128) -> Option<i128>,
) -> Option<Form> {
    let (mut i, mut j) = (0, 0);
    let mut form = Form::new();
    while let Some(variable) =
        left.get(i).into_iter().chain(right.get(j)).map(|&(variable, _)| variable).min()
    {
        let take = |form: &Form, at: &mut usize| match form.get(*at) {
            Some(&(known, coefficient)) if known == variable => {
                *at += 1;
                coefficient
            }
            _ => 0,
        };
        let coefficient = sum(take(left, &mut i), take(right, &mut j))?;
        if coefficient != 0 {
            form.push((variable, coefficient));
        }
    }
    Some(form)
}

/// The same inequality divided by the greatest common divisor of its numbers: equal inequalities
/// are then equal values, and numbers grow slowly.
fn reduced(row: &Inequality) -> Inequality {
    let divisor = divisor(&row.form, row.bound.abs()).max(1);
    Inequality {
        form: row.form.iter().map(|&(variable, c)| (variable, c / divisor)).collect(),
        bound: row.bound / divisor,
        strict: row.strict,
    }
}

/// The greatest common divisor of all coefficients and of `other`.
///
/// ```
/// use tltl_compiler::linear::divisor;
/// use tltl_compiler::predicate::TermId;
///
/// assert_eq!(divisor(&vec![(TermId(0), 12), (TermId(1), -18)], 0), 6);
/// ```
#[must_use]
pub fn divisor(form: &Form, other: i128) -> i128 {
    form.iter().fold(other, |divisor, (_, coefficient)| gcd(divisor, coefficient.abs()))
}

/// The greatest common divisor of two numbers that are not negative.
fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(coefficients: &[i128], bound: i128, strict: bool) -> Inequality {
        let terms = (0..).map(TermId).zip(coefficients.iter().copied());
        Inequality { form: terms.filter(|(_, c)| *c != 0).collect(), bound, strict }
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
            assert_eq!(feasible(system, &mut usize::MAX.clone()), Some(verdict), "{system:?}");
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
                    let at = |&(term, c): &(TermId, i128)| c * p[term.0 as usize];
                    let value: i128 = row.form.iter().map(at).sum();
                    value < 2 * row.bound || value == 2 * row.bound && !row.strict
                })
            };
            let all = -9..10;
            let solved =
                all.clone().any(|x| all.clone().any(|y| all.clone().any(|z| point([x, y, z]))));
            let verdict = feasible(&system, &mut usize::MAX.clone()).unwrap();
            assert!(verdict || !solved, "{system:?}");
        }
    }
}
