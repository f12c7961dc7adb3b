//! Parts of formulas that do not matter: with a constant in their place the task means the same.

use tltl_compiler::arithmetic::{self, Possible};
use tltl_compiler::ast::quoted;
use tltl_compiler::compile::Compiled;
use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::minimize::minimize;
use tltl_compiler::predicate::{Module, Task};
use tltl_compiler::source::Span;
use tltl_compiler::spec::{Formula, FormulaId, Spec};
use tltl_compiler::translate::{Budget, translate};

/// Formulas with more operators and operands are not searched for parts that do not matter.
const MOST_OPERATORS: usize = 40;

/// Nor are automata with more states.
const MOST_STATES: usize = 64;

/// Warnings that cost a search: for each task, the largest parts of its formula that could as well
/// be left out.
///
/// Not part of compiling: the macros, which cannot warn, would search in vain. Deterministic, and
/// bounded: large formulas and automata are not searched.
#[must_use]
pub fn advice(compiled: &Compiled) -> Vec<Error> {
    let tasks = compiled.module.tasks.iter().zip(&compiled.automata);
    tasks.flat_map(|(task, automata)| parts(&compiled.module, task, automata)).collect()
}

fn parts(module: &Module, task: &Task, automata: &Automata) -> Vec<Error> {
    let spec = &task.spec;
    let reachable = spec.reachable();
    let count = reachable.iter().filter(|reachable| **reachable).count();
    let states = automata.propositional.len();
    let judged = matches!(automata.dfa.accepting, None | Some(0));
    if count > MOST_OPERATORS || states > MOST_STATES || judged {
        return Vec::new();
    }
    let mut possible = arithmetic::possible(module, task);
    let mut warnings = Vec::new();
    let mut within = vec![false; reachable.len()];
    for (id, formula) in spec.formulas().rev().filter(|(id, _)| reachable[id.0 as usize]) {
        let constant = match formula {
            Formula::True | Formula::False => true,
            Formula::Literal { proposition, .. } => possible.values(proposition) != (true, true),
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

fn vacuous_part(task: &Task, id: FormulaId, value: bool) -> Error {
    let text = quoted(&task.spec.text(id, 1024));
    let what = task.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"));
    let message = format!("`{text}` does not matter: {what} means the same without it");
    let span = task.spec.span(id);
    let span = if span == Span::default() { task.span } else { span };
    Error::new(Kind::Vacuous, message, span)
        .label(format!("with `{value}` here it would mean the same"))
        .help("leave it out, or look whether the rest says more than it should")
        .warning()
}

/// The constant that a part may be replaced by, if the automaton stays the same.
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

/// The formula with a constant in the place of a part.
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
