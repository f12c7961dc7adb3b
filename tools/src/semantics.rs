//! The meaning of a formula on a finite trajectory, Boolean and robust: the oracle against which
//! every automaton is tested.
//!
//! Both readings are one function, generic in the algebra of values: Booleans with `and`, `or` and
//! `not`, or the extended real numbers with `min`, `max` and negation. Each subformula is a column
//! of values, computed from the end of the trajectory by the definitions of LTL over finite traces
//! (De Giacomo and Vardi, 2013) unrolled by one instant: `φ U ψ` at i is ψ at i, or φ at i and
//! `φ U ψ` at i + 1. An operator with a bound is the minimum or maximum over its window, taken anew
//! at each instant.
//!
//! Time and memory are the number of subformulas times the length, and the time of a bounded
//! operator its bound times more.
//! Nothing here knows of automata or diagrams, shares code with the translation, or is fast;
//! [`evaluate`](crate::evaluate) is the fast way.

use tltl_compiler::spec::{Formula, FormulaId, Spec};

/// An algebra in which formulas are read.
trait Value: Copy {
    /// The value of `true`.
    const TOP: Self;
    const BOTTOM: Self;
    fn not(self) -> Self;
    fn and(self, other: Self) -> Self;
    fn or(self, other: Self) -> Self;
}

impl Value for bool {
    const TOP: Self = true;
    const BOTTOM: Self = false;
    fn not(self) -> Self {
        !self
    }
    fn and(self, other: Self) -> Self {
        self && other
    }
    fn or(self, other: Self) -> Self {
        self || other
    }
}

impl Value for f64 {
    const TOP: Self = f64::INFINITY;
    const BOTTOM: Self = f64::NEG_INFINITY;
    fn not(self) -> Self {
        -self
    }
    fn and(self, other: Self) -> Self {
        self.min(other)
    }
    fn or(self, other: Self) -> Self {
        self.max(other)
    }
}

/// Whether a trajectory of `length` states satisfies the formula; `holds(p, t)` is the truth of
/// proposition `p` at instant `t`. An empty trajectory satisfies nothing.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{semantics, task};
///
/// let until = task::compile("!wet U home", Budget::default())?;
/// let spec = &until.entry().task().spec;
/// // Propositions are numbered in order of appearance: `wet` is 0, `home` is 1.
/// let trajectory = [[false, false], [false, true], [true, false]];
/// assert!(semantics::satisfied(spec, 3, |p, t| trajectory[t][p as usize]));
/// assert!(!semantics::satisfied(spec, 1, |p, t| trajectory[t][p as usize]));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn satisfied(spec: &Spec, length: usize, holds: impl Fn(u32, usize) -> bool) -> bool {
    evaluate(spec, length, holds)
}

/// The robustness of a trajectory of `length` states; `rho(p, t)` is that of proposition `p` at
/// instant `t`, and must not be NaN. An empty trajectory has -∞.
///
/// If the robustness is positive the trajectory satisfies the formula, if it is negative it does
/// not (Fainekos and Pappas, 2009); at 0 it decides nothing.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{semantics, task};
///
/// let until = task::compile("!wet U home", Budget::default())?;
/// let spec = &until.entry().task().spec;
/// let rho = [[-0.5, -2.0], [-3.0, 1.5]];
/// assert_eq!(semantics::robustness(spec, 2, |p, t| rho[t][p as usize]), 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn robustness(spec: &Spec, length: usize, rho: impl Fn(u32, usize) -> f64) -> f64 {
    evaluate(spec, length, rho)
}

/// The value of the whole formula at the first instant: a column of values for each operator,
/// operands first. After the end every formula has the value of `false`: `X` is strong.
fn evaluate<V: Value>(spec: &Spec, length: usize, value: impl Fn(u32, usize) -> V) -> V {
    let mut columns: Vec<Vec<V>> = Vec::new();
    for (_, formula) in spec.formulas() {
        let at =
            |id: FormulaId, t: usize| columns[id.0 as usize].get(t).copied().unwrap_or(V::BOTTOM);
        let mut column = vec![V::BOTTOM; length];
        for t in (0..length).rev() {
            let next = column.get(t + 1).copied().unwrap_or(V::BOTTOM);
            let until = |n: u32| t..=t.saturating_add(n as usize).min(length);
            column[t] = match formula {
                Formula::True => V::TOP,
                Formula::False => V::BOTTOM,
                Formula::Literal { proposition, negated: false } => value(proposition, t),
                Formula::Literal { proposition, negated: true } => value(proposition, t).not(),
                Formula::And(a, b) => at(a, t).and(at(b, t)),
                Formula::Or(a, b) => at(a, t).or(at(b, t)),
                Formula::Next(a) => at(a, t + 1),
                Formula::Delay(n, a) => at(a, t.saturating_add(n as usize)),
                Formula::Eventually(a) => at(a, t).or(next),
                Formula::Within(n, a) => until(n).map(|j| at(a, j)).fold(V::BOTTOM, V::or),
                Formula::Throughout(n, a) => until(n).map(|j| at(a, j)).fold(V::TOP, V::and),
                Formula::Until(a, b) => at(b, t).or(at(a, t).and(next)),
                Formula::UntilWithin(n, a, b) => {
                    until(n).rev().fold(V::BOTTOM, |later, j| at(b, j).or(at(a, j).and(later)))
                }
                Formula::Then(a, b) => at(a, t).and(at(b, t + 1)).or(next),
            };
        }
        columns.push(column);
    }
    columns[spec.root().0 as usize].first().copied().unwrap_or(V::BOTTOM)
}
