//! A conjunction taken apart into parts that run side by side.
//!
//! n unordered goals have 2^n states in one automaton, and 2n in n automata. The price is that each
//! part knows only its own dead ends: two conjuncts can be lost together while each could still be
//! satisfied alone, as `!b U a` and `!a U b` once neither `a` nor `b` can come first.
//!
//! Only conjuncts that share a proposition can be lost together in this way. So they belong to one
//! group, and the joint automaton of a group is built if it stays within [`PART`]; its trap then
//! holds those dead ends. Conjuncts of a group that exceeds it run apart, and the task is marked:
//! its joint dead ends were not searched ([`Factors::joint`]).
//!
//! Known weakness: propositions that differ but are tied by arithmetic (`x < 1`, `x < 2`) do not
//! make a group, so dead ends that arithmetic alone makes are not seen.
//!
//! ```
//! use tltl_compiler::{check, factor::factors, source::Source, translate::Budget};
//!
//! let module = check::formula(&Source::new("formula", "F a && F b && (c U a)"))?;
//! let factors = factors(&module.tasks[0].spec, Budget::EMITTED).unwrap();
//! // `a` ties the first conjunct and the third.
//! let texts: Vec<String> = factors.parts.iter().map(|part| part.spec.to_string()).collect();
//! assert_eq!(texts, ["F a && (c U a)", "F b"]);
//! assert!(factors.joint);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use crate::arena;
use crate::intern::order;
use crate::spec::{Formula, FormulaId, Spec};
use crate::translate::{Budget, Exceeded, translate};

/// The budget of the joint automaton of conjuncts that share propositions.
///
/// Eight goals with one hazard in common have 257 states and run apart; seven have 129 and run as
/// one. A try that fails costs an unoptimized macro at most a fifth of a second (30 such goals: 0.1
/// s); with [`Budget::EMITTED`] these would cost 3.4 s.
pub const PART: Budget = Budget { states: 256, nodes: 1 << 16, ..Budget::EMITTED };

/// One part: its formula, over its own propositions.
///
/// ```
/// use tltl_compiler::{check, factor::factors, source::Source, translate::Budget};
///
/// let module = check::formula(&Source::new("formula", "F a && (F b) && (!c U b)"))?;
/// let factors = factors(&module.tasks[0].spec, Budget::EMITTED).unwrap();
/// // The second part is about `b` and `c`, which are its own propositions 0 and 1.
/// let part = &factors.parts[1];
/// assert_eq!((part.spec.propositions().len(), &part.propositions[..]), (2, &[1, 2][..]));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Factor {
    /// The formula of the part.
    pub spec: Spec,
    /// For each proposition of the part, its index among those of the whole formula; rising.
    pub propositions: Vec<u32>,
}

/// The parts of a conjunction. The conjunction of their formulas means the same as the whole.
#[derive(Clone, Debug)]
pub struct Factors {
    /// The parts, in the order in which the source has their first conjuncts.
    pub parts: Vec<Factor>,
    /// Whether every group of conjuncts that share propositions is one part.
    pub joint: bool,
}

/// Takes a conjunction apart. A formula that is not a conjunction is one part.
///
/// Each part is translated once to see that it stays within the budget; [`compile`](crate::compile)
/// translates it again, for its automata are a later stage.
///
/// ```
/// use tltl_compiler::{check, factor::factors, source::Source, translate::Budget};
///
/// let goals: Vec<String> = (0..12).map(|i| format!("(!hazard U g{i})")).collect();
/// let module = check::formula(&Source::new("formula", goals.join(" && ")))?;
/// let factors = factors(&module.tasks[0].spec, Budget::EMITTED).unwrap();
/// // 2^12 states are more than a part may have: the goals run apart.
/// assert_eq!((factors.parts.len(), factors.joint), (12, false));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// If the automaton of a single conjunct needs more than `budget`.
pub fn factors(spec: &Spec, budget: Budget) -> Result<Factors, Exceeded> {
    let mut factors = Factors { parts: Vec::new(), joint: true };
    for group in groups(spec) {
        let whole = extract(spec, &group);
        // A group of one is its own joint automaton, whatever its size: the caller's budget
        // decides.
        if group.len() > 1 && translate(&whole.spec, PART).is_err() {
            factors.joint = false;
            factors.parts.extend(group.iter().map(|&conjunct| extract(spec, &[conjunct])));
        } else {
            factors.parts.push(whole);
        }
    }
    factors.parts.iter().try_for_each(|part| translate(&part.spec, budget).map(drop))?;
    Ok(factors)
}

/// The groups of conjuncts that share propositions, in source order.
fn groups(spec: &Spec) -> Vec<Vec<FormulaId>> {
    let conjuncts = conjuncts(spec);
    let ties: Vec<_> = conjuncts.iter().map(|&conjunct| propositions(spec, &[conjunct])).collect();
    let groups = arena::groups(&ties).into_iter();
    groups.map(|group| group.into_iter().map(|place| conjuncts[place]).collect()).collect()
}

/// The conjuncts: the operands of the outermost chain of `&&`, in source order, each once.
pub(crate) fn conjuncts(spec: &Spec) -> Vec<FormulaId> {
    let (_, conjuncts) = conjunction(spec);
    let spans = conjuncts.iter().map(|&id| spec.span(id));
    let places = order(spans.map(|span| (span.start, span.end)));
    places.into_iter().map(|place| conjuncts[place]).collect()
}

/// The conjunctions of the outermost chain of `&&`, and the operands of the chain.
pub(crate) fn conjunction(spec: &Spec) -> (Vec<FormulaId>, Vec<FormulaId>) {
    let chain = arena::needed(vec![spec.root().0], &mut |id, open| {
        if let Formula::And(a, b) = spec.formula(FormulaId(id)) {
            open.extend([a.0, b.0]);
        }
    });
    let is_and = |&id: &FormulaId| matches!(spec.formula(id), Formula::And(..));
    chain.into_iter().map(FormulaId).partition(is_and)
}

/// All subformulas of some formulas, operands first.
fn parts(spec: &Spec, roots: &[FormulaId]) -> Vec<FormulaId> {
    let roots = roots.iter().map(|root| root.0).collect();
    let parts = arena::needed(roots, &mut |id, open| {
        open.extend(spec.formula(FormulaId(id)).operands().map(|operand| operand.0));
    });
    parts.into_iter().map(FormulaId).collect()
}

/// The propositions of some formulas, rising.
fn propositions(spec: &Spec, roots: &[FormulaId]) -> Vec<u32> {
    let literal = |id: FormulaId| match spec.formula(id) {
        Formula::Literal { proposition, .. } => Some(proposition),
        _ => None,
    };
    let mut found: Vec<u32> = parts(spec, roots).into_iter().filter_map(literal).collect();
    found.sort_unstable();
    found.dedup();
    found
}

/// The conjunction of some subformulas, over the propositions that they mention, which are numbered
/// anew.
fn extract(spec: &Spec, roots: &[FormulaId]) -> Factor {
    let chosen = propositions(spec, roots);
    let names = chosen.iter().map(|&p| spec.propositions()[p as usize].clone()).collect();
    let mut part = Spec::new(names);
    let parts = parts(spec, roots);
    let copies = part.rebuild(spec, &parts, &mut |part, id, formula| {
        let formula = match formula {
            Formula::Literal { proposition, negated } => {
                let place = chosen.binary_search(&proposition).unwrap_or_default();
                Formula::Literal { proposition: place as u32, negated }
            }
            other => other,
        };
        part.add(formula, spec.span(id))
    });
    let span = roots.first().map_or_else(Default::default, |&root| spec.span(root));
    let mut root = part.truth(true, span);
    for conjunct in roots {
        let place = parts.binary_search(conjunct).expect("conjuncts are parts");
        root = part.and(root, copies[place], span);
    }
    part.set_root(root);
    Factor { spec: part, propositions: chosen }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile;
    use crate::source::Source;

    /// Formulas, the number of states of each part, and whether joint dead ends were searched.
    #[test]
    fn conjunctions_fall_apart_where_they_share_nothing() {
        let thirty: Vec<String> = (0..30).map(|i| format!("F g{i}")).collect();
        let hazard: Vec<String> = (0..12).map(|i| format!("(!h U g{i})")).collect();
        let cases: [(String, Vec<usize>, bool); 5] = [
            ("F a".into(), vec![2], true),
            ("F a && F b && (c U a)".into(), vec![3, 2], true),
            ("!b U a && !a U b".into(), vec![3], true),
            (thirty.join(" && "), vec![2; 30], true),
            (hazard.join(" && "), vec![3; 12], false),
        ];
        for (formula, states, joint) in cases {
            let source = Source::new("formula", formula.as_str());
            let module = crate::check::formula(&source).unwrap();
            let factors = factors(&module.tasks[0].spec, Budget::EMITTED).unwrap();
            let sizes: Vec<usize> = factors
                .parts
                .iter()
                .map(|part| {
                    let raw = translate(&part.spec, Budget::EMITTED).unwrap();
                    crate::minimize::minimize(&raw).len()
                })
                .collect();
            assert_eq!((sizes, factors.joint), (states, joint), "{formula}");
        }
        assert!(compile::formula(&Source::new("f", thirty.join(" && ")), Budget::EMITTED).is_err());
    }
}
