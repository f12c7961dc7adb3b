//! The pipeline: source to automata, in one place.

use crate::arithmetic::{self, Possible};
use crate::check;
use crate::dfa::Dfa;
use crate::error::{Error, Errors, Kind};
use crate::minimize::minimize;
use crate::predicate::{Module, Task};
use crate::source::{Source, Span};
use crate::spec::Spec;
use crate::translate::{Budget, Exceeded, translate};

/// A source and everything that it means.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// What it declares.
    pub module: Module,
    /// The automata of each of its tasks, in the same order.
    pub automata: Vec<Automata>,
    /// What the author should look at.
    pub warnings: Vec<Error>,
}

/// The two automata of a task.
#[derive(Clone, Debug)]
pub struct Automata {
    /// Minimal with all predicates taken for free propositions: what other tools compute.
    pub propositional: Dfa,
    /// Minimal over the letters that can occur: what is emitted.
    pub dfa: Dfa,
}

/// Compiles a bare formula, whose names are free: one task without a name.
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn formula(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::formula(source).and_then(|module| automata(module, budget))
}

/// Compiles a task file.
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn file(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::file(source).and_then(|module| automata(module, budget))
}

/// Compiles what stands inside `tltl!{ … }`: a formula with or without a header, or declarations.
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn fragment(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::fragment(source).and_then(|module| automata(module, budget))
}

fn automata(mut module: Module, budget: Budget) -> Result<Compiled, Errors> {
    let mut mistakes = std::mem::take(&mut module.warnings);
    let mut automata = Vec::new();
    for task in &module.tasks {
        match task_automata(&module, task, budget, &mut mistakes) {
            Ok(pair) => automata.push(pair),
            Err(exceeded) => mistakes.push(exceeds(task, budget, exceeded)),
        }
    }
    let warnings = Errors::split(mistakes)?;
    Ok(Compiled { module, automata, warnings })
}

fn task_automata(
    module: &Module,
    task: &Task,
    budget: Budget,
    mistakes: &mut Vec<Error>,
) -> Result<Automata, Exceeded> {
    let propositional = minimize(&translate(&task.spec, budget)?);
    let mut possible = arithmetic::possible(module, task);
    let dfa = if possible.all() {
        propositional.clone()
    } else {
        let mut dfa = minimize(&possible.restrict(&propositional));
        possible.attach(&mut dfa);
        dfa
    };
    check_edges(&dfa, budget)?;
    judge_predicates(module, task, &mut possible, mistakes);
    judge(task, &dfa, mistakes);
    Ok(Automata { propositional, dfa })
}

/// A predicate that never holds, or always does, is surely a mistake; in a bare formula, which may
/// be there to be explored, only a warning.
fn judge_predicates(
    module: &Module,
    task: &Task,
    possible: &mut Possible,
    mistakes: &mut Vec<Error>,
) {
    for (proposition, &id) in (0..).zip(&task.predicates) {
        let predicate = &module.predicates[id.0 as usize];
        let name = &predicate.name;
        let mistake = match possible.values(proposition) {
            (true, true) => continue,
            (false, _) => Error::new(
                Kind::Unsatisfiable,
                format!("the predicate `{name}` can never hold"),
                predicate.span,
            ),
            (true, false) => Error::new(
                Kind::Valid,
                format!("the predicate `{name}` always holds"),
                predicate.span,
            )
            .warning(),
        };
        let mistake = if task.name.is_none() { mistake.warning() } else { mistake };
        if !mistakes.contains(&mistake) {
            mistakes.push(mistake);
        }
    }
}

/// So is a formula that no trajectory satisfies, or every one.
fn judge(task: &Task, dfa: &Dfa, mistakes: &mut Vec<Error>) {
    let what = task.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"));
    if dfa.accepting.is_none() {
        let mistake =
            Error::new(Kind::Unsatisfiable, format!("{what} can never be satisfied"), task.span)
                .label("no trajectory satisfies this");
        mistakes.push(if task.name.is_none() { mistake.warning() } else { mistake });
    } else if dfa.accepting == Some(0) {
        mistakes.push(
            Error::new(Kind::Valid, format!("{what} is always satisfied"), task.span)
                .label("every trajectory satisfies this")
                .warning(),
        );
    }
}

/// Counts edges, but not far beyond the limit.
fn check_edges(dfa: &Dfa, budget: Budget) -> Result<(), Exceeded> {
    let limit = budget.edges;
    if dfa.len().saturating_mul(dfa.len()) <= limit {
        return Ok(());
    }
    let mut edges = 0;
    for &target in &dfa.transitions {
        edges += dfa.leaves(target).len();
        if edges > limit {
            return Err(Exceeded { what: "edges", limit });
        }
    }
    Ok(())
}

fn exceeds(task: &Task, budget: Budget, exceeded: Exceeded) -> Error {
    let Exceeded { what, limit } = exceeded;
    let name = task.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"));
    let span = if what == "edges" { task.span } else { culprit(&task.spec, budget) };
    Error::new(Kind::Budget, format!("the automaton of {name} needs more than {limit} {what}"), span)
        .label("this is what grows")
        .help("split the task into smaller ones and watch them side by side: n unordered goals are 2^n states as one task, and 2n as n tasks")
}

/// Where the smallest subformula stands whose own automaton is too large.
fn culprit(spec: &Spec, budget: Budget) -> Span {
    let mut spec = spec.clone();
    loop {
        let whole = spec.root();
        let guilty = spec.formula(whole).operands().find(|&part| {
            spec.set_root(part);
            translate(&spec, budget).is_err()
        });
        match guilty {
            Some(part) => spec.set_root(part),
            None => return spec.span(whole),
        }
    }
}
