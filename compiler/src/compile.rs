//! The pipeline: source to automata, in one place.

use crate::arithmetic;
use crate::check;
use crate::dfa::{Automata, Dfa, Guards};
use crate::error::{Error, Errors, Kind};
use crate::factor::{Factor, factors};
use crate::judge;
use crate::minimize::minimize;
use crate::predicate::{Module, Task};
use crate::source::{Source, Span};
use crate::spec::{FormulaId, Spec};
use crate::translate::{Budget, Exceeded, Resource, translate};

/// A source and everything that it means.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// What it declares.
    pub module: Module,
    /// The automata of each of its tasks, in the same order.
    pub automata: Vec<Automata>,
    /// Its factored tasks, which are not among the others.
    pub factored: Vec<Factored>,
    /// What the author should look at.
    pub warnings: Vec<Error>,
}

/// A conjunction whose parts run side by side.
#[derive(Clone, Debug)]
pub struct Factored {
    /// The task as a whole.
    pub task: Task,
    /// Its parts, in source order.
    pub parts: Vec<Part>,
    /// Whether parts that share propositions are one, so that no dead end is missed.
    pub joint: bool,
}

/// A part of a factored task.
#[derive(Clone, Debug)]
pub struct Part {
    /// The part as a task, over its own propositions.
    pub task: Task,
    /// Its automata.
    pub automata: Automata,
    /// The place among the whole's propositions of each of its own.
    pub propositions: Vec<u32>,
}

/// The formula of a part is quoted up to this length in bytes.
const LONGEST: usize = 4096;

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
    let split = std::mem::take(&mut module.tasks);
    let (apart, whole): (Vec<_>, Vec<_>) =
        split.into_iter().partition(|task| task.options.factored);
    let mut automata = Vec::new();
    for task in &whole {
        let budget = allowed(task, budget);
        match task_automata(&module, task, budget, &mut mistakes) {
            Ok(pair) => automata.push(pair),
            Err(exceeded) => mistakes.push(exceeds(task, budget, exceeded)),
        }
    }
    let mut factored = Vec::new();
    for task in apart {
        let budget = allowed(&task, budget);
        match task_parts(&module, &task, budget, &mut mistakes) {
            Ok((parts, joint)) => factored.push(Factored { task, parts, joint }),
            Err(exceeded) => mistakes.push(exceeds(&task, budget, exceeded)),
        }
    }
    module.tasks = whole;
    let warnings = Errors::split(mistakes)?;
    Ok(Compiled { module, automata, factored, warnings })
}

/// The budget with what the task's attributes say.
fn allowed(task: &Task, budget: Budget) -> Budget {
    let options = task.options;
    Budget {
        states: options.states.unwrap_or(budget.states),
        nodes: options.nodes.unwrap_or(budget.nodes),
        edges: options.edges.unwrap_or(budget.edges),
        products: options.products.unwrap_or(budget.products),
    }
}

fn task_parts(
    module: &Module,
    task: &Task,
    budget: Budget,
    mistakes: &mut Vec<Error>,
) -> Result<(Vec<Part>, bool), Exceeded> {
    let factors = factors(&task.spec, budget)?;
    let mut parts = Vec::new();
    for Factor { spec, propositions } in factors.parts {
        let predicates = propositions.iter().map(|&p| task.predicates[p as usize]).collect();
        let text = spec.text(spec.root(), LONGEST);
        let part = Task { text, spec, predicates, ..task.clone() };
        let automata = task_automata(module, &part, budget, mistakes)?;
        parts.push(Part { task: part, automata, propositions });
    }
    Ok((parts, factors.joint))
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
    check_size(&dfa, budget)?;
    let automata = Automata { propositional, dfa };
    for mistake in judge::task(module, task, &mut possible, &automata) {
        if !mistakes.contains(&mistake) {
            mistakes.push(mistake);
        }
    }
    Ok(automata)
}

/// Whether an automaton can be written out: counts edges and the products of their guards, but
/// not far beyond the limits. Nothing to count where any number of edges will do.
fn check_size(dfa: &Dfa, budget: Budget) -> Result<(), Exceeded> {
    if budget.edges == usize::MAX {
        return Ok(());
    }
    let mut edges = 0;
    for &target in &dfa.transitions {
        edges += dfa.diagram.leaves(target).len();
        if edges > budget.edges {
            return Err(Exceeded { what: Resource::Edges, limit: budget.edges });
        }
    }
    check_guards(dfa, budget)
}

/// Whether the guards of an automaton can be written out.
///
/// # Errors
/// If one of them has more products than the budget allows.
pub fn check_guards(dfa: &Dfa, budget: Budget) -> Result<(), Exceeded> {
    let limit = budget.products;
    let fits = Guards::new(dfa).are_below(limit);
    if fits { Ok(()) } else { Err(Exceeded { what: Resource::Products, limit }) }
}

fn exceeds(task: &Task, budget: Budget, exceeded: Exceeded) -> Error {
    let Exceeded { what, limit } = exceeded;
    let name = task.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"));
    let setting = match what {
        Resource::States => Some("states"),
        Resource::Nodes => Some("nodes"),
        Resource::Edges => Some("edges"),
        Resource::Products => Some("products"),
        Resource::Operators => None,
    };
    let whole = matches!(what, Resource::Edges | Resource::Products);
    let span = if whole { task.span } else { culprit(&task.spec, budget) };
    let error = Error::new(
        Kind::Budget,
        format!("the automaton of {name} needs more than {limit} {what}"),
        span,
    );
    let error = error
        .label("this is what grows")
        .help("a conjunction can be kept factored, its parts side by side: write `#[factored]` before the task; n unordered goals are then 2n states, not 2^n");
    match setting {
        Some(setting) => {
            error.help(format!("or allow more: write `#[budget({setting} = …)]` before the task"))
        }
        None => error,
    }
}

/// Where a subformula stands whose own automaton is too large, but that of none of its parts.
///
/// Each try can cost the whole budget. So the parts are not tried one by one: on the way down, into
/// the larger operand each time, the last one that is too large is found by halving, and then the
/// smaller operand beside the way is tried. For n operators that makes O(log² n) tries.
fn culprit(spec: &Spec, budget: Budget) -> Span {
    let mut sizes: Vec<usize> = Vec::new();
    for (_, formula) in spec.formulas() {
        let parts = formula.operands().map(|part| sizes[part.0 as usize]);
        sizes.push(parts.fold(1, usize::saturating_add));
    }
    let larger =
        |id: FormulaId| spec.formula(id).operands().max_by_key(|part| sizes[part.0 as usize]);
    let mut part = spec.clone();
    let mut is_guilty = |id: FormulaId| {
        part.set_root(id);
        translate(&part, budget).is_err()
    };
    let mut guilty = spec.root();
    loop {
        let way: Vec<_> = std::iter::successors(Some(guilty), |&id| larger(id)).collect();
        let (mut last, mut innocent) = (0, way.len());
        while last + 1 < innocent {
            let middle = usize::midpoint(last, innocent);
            *(if is_guilty(way[middle]) { &mut last } else { &mut innocent }) = middle;
        }
        guilty = way[last];
        let beside = way.get(last + 1);
        match spec.formula(guilty).operands().find(|id| Some(id) != beside) {
            Some(other) if is_guilty(other) => guilty = other,
            _ => return spec.span(guilty),
        }
    }
}
