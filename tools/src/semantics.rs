//! The meaning of a formula on a finite trajectory, Boolean and robust: the oracle against which
//! every automaton is tested.
//!
//! Both readings are one function, generic in the algebra of values: Booleans with `and`, `or` and
//! `not`, or the extended real numbers with `min`, `max` and negation. It passes once over the
//! trajectory, from its end, with one cell for each subformula, and follows the definitions of LTL
//! over finite traces (De Giacomo and Vardi, 2013) unrolled by one instant: `φ U ψ` at i is ψ at i,
//! or φ at i and `φ U ψ` at i + 1.
//!
//! Time is the number of subformulas times the length, memory two cells for each subformula.
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

/// The value of the whole formula at the first instant. After the end every formula has the value
/// of `false`: `X` is strong.
fn evaluate<V: Value>(spec: &Spec, length: usize, value: impl Fn(u32, usize) -> V) -> V {
    let mut now = vec![V::BOTTOM; spec.formulas().len()];
    let mut next = now.clone();
    for t in (0..length).rev() {
        for (id, formula) in spec.formulas() {
            let at = |values: &[V], id: FormulaId| values[id.0 as usize];
            now[id.0 as usize] = match formula {
                Formula::True => V::TOP,
                Formula::False => V::BOTTOM,
                Formula::Literal { proposition, negated: false } => value(proposition, t),
                Formula::Literal { proposition, negated: true } => value(proposition, t).not(),
                Formula::And(a, b) => at(&now, a).and(at(&now, b)),
                Formula::Or(a, b) => at(&now, a).or(at(&now, b)),
                Formula::Next(a) => at(&next, a),
                Formula::Eventually(a) => at(&now, a).or(at(&next, id)),
                Formula::Until(a, b) => at(&now, b).or(at(&now, a).and(at(&next, id))),
                Formula::Then(a, b) => at(&now, a).and(at(&next, b)).or(at(&next, id)),
            };
        }
        std::mem::swap(&mut now, &mut next);
    }
    next[spec.root().0 as usize]
}
