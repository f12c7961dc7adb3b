//! The pipeline: source to automata, in one place.
//!
//! Three entries ([`formula()`], [`file()`], [`fragment()`]) differ only in how they parse. After
//! checking, every task takes the same way: translate, minimize, ask arithmetic which letters can
//! occur, restrict and minimize again, check that the result can be written out, judge it. A task
//! marked `#[factored]` is taken apart first and each part takes that way alone.
//!
//! All mistakes are collected before one is reported: a task that exceeds its budget does not hide
//! the unsatisfiable predicate of the next one. No stage before the translation depends on the
//! budget, so mistakes of form and of type are the same for every budget.
//!
//! The cost is that of the translations; everything else is linear in what they produce. Where a
//! task exceeds its budget, `culprit` translates it O(log² n) times more to point at the subformula
//! that grows.
//!
//! ```
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let source = Source::new("tasks", "state Cell { y: f64 }\npredicate near = x < 1\ntask home = F near\n");
//! let errors = compile::file(&source, Budget::EMITTED).unwrap_err();
//! // `x` is not declared.
//! assert_eq!(errors.first().kind().name(), "unknown-name");
//! assert_eq!(source.slice(errors.first().span()), "x");
//! ```

use crate::arithmetic;
use crate::check;
use crate::dfa::{Automata, Dfa, Guards};
use crate::error::{Error, Errors, Kind};
use crate::factor::{Factor, conjunction, conjuncts, factors};
use crate::judge;
use crate::minimize::minimize;
use crate::predicate::{Module, Task};
use crate::source::{Source, Span};
use crate::spec::{Formula, FormulaId, Spec};
use crate::translate::{Budget, Exceeded, Resource, states_of_bound, translate};

/// A source and everything that it means.
///
/// Invariant: `module.tasks` and `automata` have the same length and order. Factored tasks are in
/// neither: they have several automata each, so they stand in `factored` with their parts.
#[derive(Clone, Debug)]
pub struct Compiled {
    /// The declarations of the source, checked.
    pub module: Module,
    /// The automata of each task of `module.tasks`, in the same order.
    pub automata: Vec<Automata>,
    /// The tasks marked `#[factored]`, in source order.
    pub factored: Vec<Factored>,
}

/// A conjunction whose parts run side by side, each with an automaton of its own.
///
/// n unordered goals are 2n states in n parts, and 2^n in one automaton.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let text = "state S { a: bool, b: bool }\n#[factored] task tour = F a && F b\n";
/// let compiled = compile::file(&Source::new("tour.tltl", text), Budget::EMITTED)?;
/// assert!(compiled.module.tasks.is_empty() && compiled.automata.is_empty());
/// let tour = &compiled.factored[0];
/// let sizes: Vec<usize> = tour.parts.iter().map(|part| part.automata.dfa.len()).collect();
/// assert_eq!((sizes, &tour.parts[1].propositions[..], tour.joint), (vec![2, 2], &[1][..], true));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Factored {
    /// The task as a whole.
    pub task: Task,
    /// Its parts, in source order.
    pub parts: Vec<Part>,
    /// Whether all conjuncts that share propositions are in one part. If so, the trap of a part
    /// holds every dead end of its conjuncts together; if not, dead ends of several parts together
    /// were not searched.
    pub joint: bool,
}

/// A part of a factored task.
///
/// Its propositions are numbered anew from 0, so its automaton does not depend on the parts beside
/// it.
#[derive(Clone, Debug)]
pub struct Part {
    /// The part as a task, over its own propositions.
    pub task: Task,
    /// Its automata.
    pub automata: Automata,
    /// For each proposition of the part, its index among the propositions of the whole task.
    pub propositions: Vec<u32>,
}

/// The formula of a part is quoted up to this length in bytes. A formula is a graph of shared
/// operators; written out, it can be exponentially longer, so some bound is needed.
const LONGEST: usize = 4096;

/// Compiles a bare formula, whose names are free: one task without a name.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "!unsafe_area U goal");
/// let compiled = compile::formula(&source, Budget::default())?;
/// let task = &compiled.module.tasks[0];
/// assert_eq!(task.spec.propositions(), ["unsafe_area", "goal"]);
/// // Initial, accepting, trap.
/// assert_eq!(compiled.automata[0].dfa.len(), 3);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn formula(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::formula(source).and_then(|checked| automata(checked, budget, Home::CommandLine))
}

/// Compiles a task file: declarations of a state, constants, predicates and tasks.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let text = "state Cell { x: i32 }\npredicate home = x == 0\ntask back = F (!home && F home)\n";
/// let compiled = compile::file(&Source::new("cell.tltl", text), Budget::EMITTED)?;
/// assert_eq!(compiled.module.predicates[0].name, "home");
/// assert_eq!(compiled.automata.len(), compiled.module.tasks.len());
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn file(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::file(source).and_then(|checked| module(checked, budget))
}

/// Compiles the input of `tltl!{ … }`: a formula with or without a header, or declarations. The
/// first token decides which of them it is.
///
/// ```
/// use tltl_compiler::{compile, predicate::State, source::Source, translate::Budget};
///
/// let source = Source::new("macro", "|cell: &Cell| F { cell.is_home() }");
/// let compiled = compile::fragment(&source, Budget::EMITTED)?;
/// let State::Host { name, .. } = &compiled.module.state else { panic!() };
/// assert_eq!(name, "cell");
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes of the source, or that the budget does not suffice.
pub fn fragment(source: &Source, budget: Budget) -> Result<Compiled, Errors> {
    check::fragment(source).and_then(|checked| module(checked, budget))
}

/// Compiles every task of a checked source; a task that fails leaves its mistake and the others go
/// on. Whoever wants one task only takes the others out of the module.
///
/// ```
/// use tltl_compiler::{check, compile, source::Source, translate::Budget};
///
/// let text = "state S { a: bool, b: bool }\ntask large = F[0,999] a\ntask small = F b\n";
/// let mut module = check::file(&Source::new("s.tltl", text))?;
/// let budget = Budget { states: 100, ..Budget::EMITTED };
/// assert!(compile::module(module.clone(), budget).is_err());
/// module.tasks.retain(|task| task.name.as_deref() == Some("small"));
/// assert_eq!(compile::module(module, budget)?.automata.len(), 1);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// That the budget does not suffice, or that a predicate or a task can never hold.
pub fn module(module: Module, budget: Budget) -> Result<Compiled, Errors> {
    automata(module, budget, Home::Source)
}

/// Where a task is written: it decides where its author can allow more.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Home {
    /// A file or a macro, which take attributes.
    Source,
    /// A bare formula, which does not.
    CommandLine,
}

/// Compiles every task of a module; a task that fails leaves its mistake and the others go on.
fn automata(mut module: Module, budget: Budget, home: Home) -> Result<Compiled, Errors> {
    let mut mistakes = Vec::new();
    let split = std::mem::take(&mut module.tasks);
    let (apart, whole): (Vec<_>, Vec<_>) =
        split.into_iter().partition(|task| task.options.factored);
    let mut automata = Vec::new();
    for task in &whole {
        let budget = allowed(task, budget);
        match task_automata(&module, task, budget, &mut mistakes) {
            Ok(pair) => automata.push(pair),
            Err(exceeded) => mistakes.push(exceeds(task, budget, exceeded, home)),
        }
    }
    let mut factored = Vec::new();
    for task in apart {
        let budget = allowed(&task, budget);
        match task_parts(&module, &task, budget, &mut mistakes) {
            Ok((parts, joint)) => factored.push(Factored { task, parts, joint }),
            Err(exceeded) => mistakes.push(exceeds(&task, budget, exceeded, home)),
        }
    }
    module.tasks = whole;
    Errors::check(mistakes)?;
    Ok(Compiled { module, automata, factored })
}

/// The budget of one task: what its attributes set, and `budget` for the rest. An attribute may
/// also allow more than the caller does: the author of a task knows what it is worth.
fn allowed(task: &Task, budget: Budget) -> Budget {
    let options = task.options;
    Budget {
        states: options.states.unwrap_or(budget.states),
        nodes: options.nodes.unwrap_or(budget.nodes),
        edges: options.edges.unwrap_or(budget.edges),
        products: options.products.unwrap_or(budget.products),
    }
}

/// The parts of a factored task with their automata, and whether they are [`Factored::joint`].
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

/// The automata of one task.
///
/// The propositional automaton is minimized first although the restricted one is minimized again:
/// restriction costs one *constrain* a state, and the minimal automaton has fewest. It is kept,
/// because it is what other tools compute from the formula alone and what [`judge`] asks for the
/// reason of a contradiction.
fn task_automata(
    module: &Module,
    task: &Task,
    budget: Budget,
    mistakes: &mut Vec<Error>,
) -> Result<Automata, Exceeded> {
    let propositional = minimize(&translate(&task.spec, budget)?);
    let possible = arithmetic::possible(module, task);
    let dfa = if possible.all() {
        propositional.clone()
    } else {
        // Restriction can make states equal that no possible letter separates.
        let mut dfa = minimize(&possible.restrict(&propositional));
        possible.attach(&mut dfa);
        dfa
    };
    check_size(&dfa, budget)?;
    let automata = Automata { propositional, dfa };
    // A formula without a name may be there to be explored.
    if task.name.is_some() {
        mistakes.extend(judge::task(module, task, &possible, &automata));
    }
    Ok(automata)
}

/// Checks that an automaton can be written out.
///
/// Counts edges and the products of their guards, and stops soon after a limit is passed: the count
/// of products can be exponential in the number of propositions. With an unlimited number of edges
/// there is nothing to count: the automaton is only looked at, and its guards are checked by those
/// who print them.
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
/// ```
/// use tltl_compiler::{compile, source::Source, translate::{Budget, Resource}};
///
/// // Written as a sum of products, n pairs joined by `&&` are 2^n products.
/// let pairs: Vec<String> = (0..6).map(|i| format!("(a{i} || b{i})")).collect();
/// let source = Source::new("formula", format!("F ({})", pairs.join(" && ")));
/// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
/// let budget = Budget { products: 63, ..Budget::EMITTED };
/// let exceeded = compile::check_guards(dfa, budget).unwrap_err();
/// assert_eq!(exceeded.what, Resource::Products);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// If one of them has more products than the budget allows.
pub fn check_guards(dfa: &Dfa, budget: Budget) -> Result<(), Exceeded> {
    let limit = budget.products;
    let fits = Guards::new(dfa).are_below(limit);
    if fits { Ok(()) } else { Err(Exceeded { what: Resource::Products, limit }) }
}

/// The error for a task that needs more than its budget, with what to write instead.
fn exceeds(task: &Task, budget: Budget, exceeded: Exceeded, home: Home) -> Error {
    let (spec, name) = (&task.spec, task.title());
    let Exceeded { what, limit } = exceeded;
    if matches!(what, Resource::Edges | Resource::Products) {
        return grows(task, None, exceeded, home);
    }
    let bound =
        |id| states_of_bound(&rooted(spec, id), budget).filter(|&n| n > budget.states as u64);
    let root = spec.root();
    if let Some(states) = bound(root) {
        let message = format!("the automaton of {name} needs {states} states, more than {limit}");
        return bounded(message, spec.span(root), &states.to_string(), home);
    }
    let guilty = culprit(task, budget);
    let Some(states) = bound(guilty) else { return grows(task, Some(guilty), exceeded, home) };
    let message = format!(
        "the automaton of {name} needs more than {} states: a bound in it needs {states} alone",
        budget.states
    );
    bounded(message, spec.span(guilty), "…", home)
}

/// The error for a bound that is too large.
fn bounded(message: String, span: Span, amount: &str, home: Home) -> Error {
    Error::new(Kind::Budget, message, span)
        .label("a bound needs a state for each of its steps")
        .help(format!("allow more: {}", more("states", amount, home)))
}

/// The error for anything else that is too large: a subformula, or the whole.
fn grows(task: &Task, guilty: Option<FormulaId>, exceeded: Exceeded, home: Home) -> Error {
    let Exceeded { what, limit } = exceeded;
    let message = format!("the automaton of {} needs more than {limit} {what}", task.title());
    let span = guilty.map_or(task.span, |id| task.spec.span(id));
    let mut error = Error::new(Kind::Budget, message, span).label("this is what grows");
    // Parts that run side by side help where it is their product that grows.
    let (conjunctions, _) = conjunction(&task.spec);
    let helps =
        conjunctions.contains(&guilty.unwrap_or(task.spec.root())) && !task.options.factored;
    if helps {
        let place = if home == Home::CommandLine { "in a task file, " } else { "" };
        error = error.help(format!("{place}a conjunction can be kept factored, its parts side by side: write `#[factored]` before the task; n unordered goals are then 2n states, not 2^n"));
    }
    let setting = match what {
        Resource::States => "states",
        Resource::Nodes => "nodes",
        Resource::Edges => "edges",
        Resource::Products => "products",
        Resource::Operators => return error,
    };
    let or = if helps { "or " } else { "" };
    error.help(format!("{or}allow more: {}", more(setting, "…", home)))
}

/// What to write to allow more of something.
fn more(setting: &str, amount: &str, home: Home) -> String {
    let attribute = format!("`#[budget({setting} = {amount})]` before the task");
    match home {
        Home::Source => format!("write {attribute}"),
        Home::CommandLine => {
            format!("add `--budget {setting}={amount}`, or in a task file write {attribute}")
        }
    }
}

/// The place of a subformula whose own automaton exceeds the budget, while those of its operands do
/// not.
///
/// Each translation can cost the whole budget, so the subformulas are not tried one by one, and what
/// needs an eighth of the nodes counts as too large: the search costs little more than the failure
/// that led to it. The path down into the larger operand is searched by halving for its last subformula that exceeds
/// the budget; then the smaller operand beside the path is tried, and if it exceeds the budget too,
/// the search starts again there. Operands at least halve with each such step to the side, so n
/// operators make O(log² n) translations.
///
/// Halving assumes that an automaton grows with its formula. Where it does not (a large operand
/// under a conjunction with a small contradiction), the result is still a subformula that exceeds
/// the budget, but perhaps not the smallest.
///
/// Of a factored task it lies within the first conjunct that is too large by itself.
fn culprit(task: &Task, budget: Budget) -> FormulaId {
    let spec = &task.spec;
    let mut sizes: Vec<usize> = Vec::new();
    for (_, formula) in spec.formulas() {
        let parts = formula.operands().map(|part| sizes[part.0 as usize]);
        sizes.push(parts.fold(1, usize::saturating_add));
    }
    let larger =
        |id: FormulaId| spec.formula(id).operands().max_by_key(|part| sizes[part.0 as usize]);
    let budget = Budget { nodes: budget.nodes / 8, ..budget };
    let is_guilty = |id: FormulaId| translate(&rooted(spec, id), budget).is_err();
    let parts = if task.options.factored { conjuncts(spec) } else { Vec::new() };
    let mut guilty = parts.into_iter().find(|&id| is_guilty(id)).unwrap_or(spec.root());
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
            _ => return delayed(spec, guilty),
        }
    }
}

/// The operator with a bound that begins later, of which a formula is the inner part: `F[5,9] a` is
/// `F[0,4] a`, five steps from now. Another formula is its own.
fn delayed(spec: &Spec, id: FormulaId) -> FormulaId {
    let is_delay = |(outer, formula): &(FormulaId, Formula)| {
        let within = matches!(formula, Formula::Next(a) | Formula::Delay(_, a) if *a == id);
        within && spec.span(*outer) == spec.span(id)
    };
    spec.formulas().find(is_delay).map_or(id, |(outer, _)| outer)
}

/// A formula of its own.
fn rooted(spec: &Spec, root: FormulaId) -> Spec {
    let mut part = spec.clone();
    part.set_root(root);
    part
}
