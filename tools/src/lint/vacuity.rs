//! Vacuity: parts of a formula that do not matter, because a constant in their place gives a task
//! of the same meaning.
//!
//! Such a part is mostly a mistake: the author meant it to constrain something. Beer, Ben-David,
//! Eisner and Rodeh ("Efficient Detection of Vacuity in ACTL Formulas", 1997) call a formula
//! vacuous in a part if nothing that is put in its place changes the verdict; Kupferman and Vardi
//! ("Vacuity Detection in Temporal Model Checking", 2003) show that a constant, chosen by the
//! polarity of the part, is enough to try. They ask about a formula and a model; here the formula
//! alone is asked about, and either constant is reported: with `false` the part adds nothing, with
//! `true` it forbids nothing.
//!
//! Formulas here are in negation normal form and share their parts, so all occurrences of a part
//! are replaced as one. The comparison is exact: minimal automata in canonical numbering, after
//! arithmetic has removed the letters that no state can show, are equal iff the formulas have the
//! same meaning.
//!
//! # Cost
//!
//! One translation for each part and constant, within the bounds below; beyond them nothing is
//! reported. Only the largest parts are reported, not parts of these.

use tltl_compiler::arithmetic::{self, Possible};
use tltl_compiler::ast::quoted;
use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::minimize::minimize;
use tltl_compiler::predicate::{Module, Task};
use tltl_compiler::source::Span;
use tltl_compiler::spec::{Formula, FormulaId, Spec};
use tltl_compiler::translate::{Budget, translate};

/// The most operators and operands of a formula that is searched: each costs two translations.
const MOST_OPERATORS: usize = 40;

/// The most states of an automaton that is searched; a translation of more takes too long to repeat
/// for a warning.
const MOST_STATES: usize = 64;

/// The warnings for one task, about the largest parts of its formula that could be left out.
///
/// Formulas that always or never hold are skipped, since those are reported with better words. So are literals of predicates that have only one value. Parts are visited from the whole
/// to the operands; what lies within a part that was reported is marked and skipped.
pub(super) fn warnings(module: &Module, task: &Task, automata: &Automata) -> Vec<Error> {
    let spec = &task.spec;
    let reachable = spec.reachable();
    let count = reachable.iter().filter(|reachable| **reachable).count();
    let states = automata.propositional.len();
    let judged = matches!(automata.dfa.accepting, None | Some(0));
    if count > MOST_OPERATORS || states > MOST_STATES || judged {
        return Vec::new();
    }
    let possible = arithmetic::possible(module, task);
    let values = possible.values();
    let mut warnings = Vec::new();
    let mut within = vec![false; reachable.len()];
    for (id, formula) in spec.formulas().rev().filter(|(id, _)| reachable[id.0 as usize]) {
        let constant = match formula {
            Formula::True | Formula::False => true,
            Formula::Literal { proposition, .. } => values[proposition as usize] != (true, true),
            _ => false,
        };
        let matters = constant || within[id.0 as usize] || id == spec.root();
        if !matters && let Some(value) = indifferent(spec, id, &possible, &automata.dfa) {
            warnings.push(vacuous_part(task, id, value));
            within[id.0 as usize] = true;
        }
        if within[id.0 as usize] {
            formula.operands().for_each(|operand| within[operand.0 as usize] = true);
        }
    }
    warnings
}

/// The warning about a part that may be replaced by `value`. A part that the normal form made, and
/// no author wrote, has no span: the warning then stands at the task.
fn vacuous_part(task: &Task, id: FormulaId, value: bool) -> Error {
    let text = quoted(&task.spec.text(id, 1024));
    let title = task.title();
    let message = format!("`{text}` does not matter: {title} means the same without it");
    let span = task.spec.span(id);
    let span = if span == Span::default() { task.span } else { span };
    Error::new(Kind::Vacuous, message, span)
        .label(format!("with `{value}` here it would mean the same"))
        .help("leave it out, or look whether the rest says more than it should")
        .warning()
}

/// The constant that may replace a part without changing the automaton; `None` if the part matters.
fn indifferent(spec: &Spec, part: FormulaId, possible: &Possible, dfa: &Dfa) -> Option<bool> {
    [false, true].into_iter().find(|&value| {
        let changed = replaced(spec, part, value);
        translate(&changed, Budget::EMITTED).is_ok_and(|raw| {
            let minimal = minimize(&raw);
            let other = match possible.all() {
                true => minimal,
                false => minimize(&possible.restrict(&minimal)),
            };
            same(dfa, &other)
        })
    })
}

/// The formula with a constant in place of a part, rebuilt operands first.
fn replaced(spec: &Spec, part: FormulaId, value: bool) -> Spec {
    let mut changed = Spec::new(spec.propositions().to_vec());
    let ids: Vec<_> = spec.formulas().map(|(id, _)| id).collect();
    let images = changed.rebuild(spec, &ids, &mut |changed, id, formula| match id == part {
        true => changed.truth(value, spec.span(id)),
        false => changed.add(formula, spec.span(id)),
    });
    changed.set_root(images[spec.root().0 as usize]);
    changed
}

/// Whether two minimal automata over the same propositions are the same. They are canonical, so
/// that all is equal but the letters that can occur, whose nodes stand last in `dfa`.
fn same(dfa: &Dfa, other: &Dfa) -> bool {
    (dfa.accepting, dfa.trap) == (other.accepting, other.trap)
        && dfa.transitions == other.transitions
        && dfa.diagram.nodes().starts_with(other.diagram.nodes())
}
