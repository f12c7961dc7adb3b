//! What a formula means on a finite trajectory, Boolean and robust: the oracle against which every
//! automaton is tested.
//!
//! Both readings are one backward pass over the trajectory with one cell per subformula, straight
//! from the definitions (`φ U ψ` at i is ψ at i, or φ at i and `φ U ψ` at i+1, …). Nothing here
//! knows of automata.

use tltl_compiler::spec::{Formula, FormulaId, Spec};

/// The values that a reading of a formula takes: Booleans, or robustness.
trait Value: Copy {
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

/// Whether a trajectory of `length` states satisfies the formula; `holds(p, t)` is the value of
/// proposition `p` at instant `t`. An empty trajectory satisfies nothing.
#[must_use]
pub fn satisfied(spec: &Spec, length: usize, holds: impl Fn(u32, usize) -> bool) -> bool {
    evaluate(spec, length, holds)
}

/// The robustness of a trajectory of `length` states; `rho(p, t)` is that of proposition `p` at
/// instant `t`. An empty trajectory has -∞.
#[must_use]
pub fn robustness(spec: &Spec, length: usize, rho: impl Fn(u32, usize) -> f64) -> f64 {
    evaluate(spec, length, rho)
}

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
