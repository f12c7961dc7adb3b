//! Predicates and tasks that can hardly be meant: never satisfied, always satisfied, or with a part
//! that does not matter; and why.
//!
//! The reasons come from the same arithmetic as the letters that can occur: a set of comparisons is
//! made smaller until each is needed for the contradiction.

use rustc_hash::FxHashSet;

use crate::arithmetic::{self, Possible};
use crate::compile::Automata;
use crate::dfa::{Dfa, Target};
use crate::emit::edge::edges;
use crate::error::{Error, Kind};
use crate::minimize::minimize;
use crate::predicate::{Condition, ConditionId, Module, Task};
use crate::source::Span;
use crate::spec::{Formula, FormulaId, Spec};
use crate::translate::{Budget, translate};

/// Formulas with more operators and operands are not searched for parts that do not matter.
const MOST_OPERATORS: usize = 40;

/// Nor are automata with more states.
const MOST_STATES: usize = 64;

/// What the author of a task should look at. In a bare formula, which may be there to be explored,
/// all of it is a warning.
pub(crate) fn task(
    module: &Module,
    task: &Task,
    possible: &mut Possible,
    automata: &Automata,
) -> Vec<Error> {
    let mut mistakes = predicates(module, task, possible);
    mistakes.extend(formula(module, task, possible, automata));
    if task.name.is_none() {
        mistakes = mistakes.into_iter().map(Error::warning).collect();
    }
    mistakes
}

/// A predicate that never holds, or always does, is surely a mistake.
fn predicates(module: &Module, task: &Task, possible: &mut Possible) -> Vec<Error> {
    let mut mistakes = Vec::new();
    for (proposition, &id) in (0..).zip(&task.predicates) {
        let predicate = &module.predicates[id.0 as usize];
        let (name, condition) = (&predicate.name, predicate.condition);
        let (can_hold, can_fail) = possible.values(proposition);
        if can_hold && can_fail {
            continue;
        }
        let core = contradiction(module, &[(condition, can_fail, predicate.span)]);
        let error = match can_hold {
            false => {
                let message = format!("the predicate `{name}` can never hold");
                Error::new(Kind::Unsatisfiable, message, predicate.span).label(never(&core))
            }
            true => {
                let message = format!("the predicate `{name}` always holds");
                Error::new(Kind::Valid, message, predicate.span).warning().label(always(&core))
            }
        };
        mistakes.push(pointing(error, &core));
    }
    mistakes
}

/// The error with the places of what contradicts each other.
fn pointing(error: Error, core: &[Part]) -> Error {
    let several = core.iter().filter(|_| core.len() > 1);
    several.fold(error, |error, part| match (part.place, part.holds) {
        (None, _) => error,
        (Some(place), true) => error.related(place, part.text.clone()),
        (Some(place), false) => error.related(place, format!("{} where this fails", part.text)),
    })
}

fn never(core: &[Part]) -> String {
    match core {
        [] => "no state satisfies this".to_owned(),
        [one] => format!("no value of its type satisfies {}", one.text),
        all => excluding(&texts(all)),
    }
}

fn always(core: &[Part]) -> String {
    match core {
        [] => "every state satisfies this".to_owned(),
        [one] => format!("it fails only for {}, which no value of its type satisfies", one.text),
        all => format!("it fails only where {}", failing(&texts(all))),
    }
}

fn texts(parts: &[Part]) -> Vec<String> {
    parts.iter().map(|part| part.text.clone()).collect()
}

/// Why things cannot hold together.
fn excluding(all: &[String]) -> String {
    match all {
        [one, other] => format!("{one} and {other} exclude each other"),
        all => format!("{} cannot hold together", listed(all)),
    }
}

fn failing(all: &[String]) -> String {
    match all {
        [one, other] => format!("{one} and {other}, which exclude each other"),
        all => format!("{}, which cannot hold together", listed(all)),
    }
}

fn listed(all: &[String]) -> String {
    match all.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => all.concat(),
    }
}

/// A part of a contradiction: a condition that has to hold, or to fail.
struct Part {
    id: ConditionId,
    holds: bool,
    /// What has to hold.
    text: String,
    /// Where the source says so.
    place: Option<Span>,
}

/// The parts of some conditions, or of their negations, that contradict each other; none if one is
/// a constant, or if the contradiction is not one of their parts alone.
fn contradiction(module: &Module, conditions: &[(ConditionId, bool, Span)]) -> Vec<Part> {
    let mut parts = parts(module, conditions);
    let roots: Vec<_> = parts.iter().map(|part| part.id).collect();
    let mut possible = arithmetic::possible_conditions(module, &roots);
    let literals: Vec<_> = (0..).zip(parts.iter().map(|part| part.holds)).collect();
    let core = core(&mut possible, literals);
    let mut place = 0..;
    parts.retain(|_| place.next().is_some_and(|at| core.iter().any(|(kept, _)| *kept == at)));
    parts
}

/// What has to hold, or to fail, for conditions to have these values: a conjunction. Each condition
/// comes with the place of the predicate that it is.
fn parts(module: &Module, conditions: &[(ConditionId, bool, Span)]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    let open = conditions.iter().rev().map(|&(id, holds, from)| (id, holds, from, None));
    let mut open: Vec<(ConditionId, bool, Span, Option<Span>)> = open.collect();
    while let Some((id, holds, from, applied)) = open.pop() {
        let place = || applied.or_else(|| place(module, id, from));
        match (module.arena.condition(id), holds) {
            (Condition::Not(a), _) => open.push((*a, !holds, from, applied)),
            (Condition::And(a, b), true) | (Condition::Or(a, b), false) => {
                open.extend([(*b, holds, from, applied), (*a, holds, from, applied)]);
            }
            (Condition::Is(id), _) => {
                let predicate = &module.predicates[id.0 as usize];
                open.push((predicate.condition, holds, predicate.span, applied));
            }
            (Condition::Apply { meaning, .. }, _) => open.push((*meaning, holds, from, place())),
            (Condition::Truth(_), _) => {}
            _ if parts.iter().any(|part| (part.id, part.holds) == (id, holds)) => {}
            _ => {
                let text = part_text(module, id, holds);
                parts.push(Part { id, holds, text, place: place() });
            }
        }
    }
    parts
}

/// Where the source has a condition: the first place from there on, or the first of all.
fn place(module: &Module, id: ConditionId, from: Span) -> Option<Span> {
    let same = |known: ConditionId| known == id || negates(module, known, id);
    let places = || module.places.iter().filter(|(known, _)| same(*known)).map(|(_, span)| *span);
    places().filter(|span| span.start >= from.start).min().or_else(|| places().min())
}

/// Whether two comparisons are each other's negation.
fn negates(module: &Module, a: ConditionId, b: ConditionId) -> bool {
    match (module.arena.condition(a), module.arena.condition(b)) {
        (Condition::Compare(one, x, y), Condition::Compare(other, u, v)) => {
            (one.negated(), x, y) == (*other, u, v)
        }
        _ => false,
    }
}

fn part_text(module: &Module, part: ConditionId, holds: bool) -> String {
    let text = match (module.arena.condition(part), holds) {
        (_, true) => module.display(part).to_string(),
        (Condition::Compare(op, a, b), false) => {
            let [a, b] = [a, b].map(|term| module.display_term(*term));
            format!("{a} {} {b}", op.negated().symbol())
        }
        (Condition::Bool(_) | Condition::Value { .. }, false) => {
            format!("!{}", module.display(part))
        }
        (_, false) => format!("!({})", module.display(part)),
    };
    format!("`{text}`")
}

/// The literals without which the others can occur; none if all can occur together.
fn core(possible: &mut Possible, mut literals: Vec<(u32, bool)>) -> Vec<(u32, bool)> {
    if !possible.excludes(&literals) {
        return Vec::new();
    }
    let mut at = 0;
    while at < literals.len() {
        let literal = literals.remove(at);
        if !possible.excludes(&literals) {
            literals.insert(at, literal);
            at += 1;
        }
    }
    literals
}

/// A formula that no trajectory satisfies, or every one.
fn formula(
    module: &Module,
    task: &Task,
    possible: &mut Possible,
    automata: &Automata,
) -> Option<Error> {
    let what = task.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"));
    match automata.dfa.accepting {
        None => {
            let message = format!("{what} can never be satisfied");
            let error = Error::new(Kind::Unsatisfiable, message, task.span)
                .label("no trajectory satisfies this");
            match obstacle(possible, &automata.propositional).as_deref() {
                // The predicate itself is told of.
                Some([_]) => None,
                Some(all) => {
                    let condition = |&(proposition, holds): &(u32, bool)| {
                        let id = task.predicates[proposition as usize];
                        let predicate = &module.predicates[id.0 as usize];
                        (predicate.condition, holds, predicate.span)
                    };
                    let conditions: Vec<_> = all.iter().map(condition).collect();
                    let error = pointing(error, &contradiction(module, &conditions));
                    let names: Vec<_> = all.iter().map(|one| name(task, *one)).collect();
                    Some(error.help(format!("at one instant it needs {}", failing(&names))))
                }
                None => Some(error),
            }
        }
        Some(0) => {
            let message = format!("{what} is always satisfied");
            Some(
                Error::new(Kind::Valid, message, task.span)
                    .label("every trajectory satisfies this")
                    .warning(),
            )
        }
        Some(_) => None,
    }
}

/// What a formula asks for at one instant that no state has.
fn obstacle(possible: &mut Possible, dfa: &Dfa) -> Option<Vec<(u32, bool)>> {
    dfa.accepting?;
    let distances = dfa.distances();
    let nearer = |from: u32, to: u32| distances[to as usize] < distances[from as usize];
    for edge in edges(dfa).iter().filter(|edge| nearer(edge.from, edge.to)) {
        let cubes = edge.guard.iter().map(|cube| core(possible, cube.clone()));
        let cores: Vec<_> = cubes.collect();
        if let (Some(first), true) = (cores.first(), cores.iter().all(|core| !core.is_empty())) {
            return Some(first.clone());
        }
    }
    None
}

fn name(task: &Task, (proposition, holds): (u32, bool)) -> String {
    let name = &task.spec.propositions()[proposition as usize];
    if holds { format!("`{name}`") } else { format!("`!({name})`") }
}

/// A warning for each largest part of a task's formula that could as well be left out.
///
/// Deterministic, and bounded: large formulas and automata are not searched.
#[must_use]
pub fn vacuous(module: &Module, task: &Task, automata: &Automata) -> Vec<Error> {
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
    let text = task.spec.display(id).to_string();
    let text = crate::ast::quoted(&text);
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
    let mut built: Vec<FormulaId> = Vec::new();
    for (id, formula) in spec.formulas() {
        let of = |id: FormulaId| built[id.0 as usize];
        let span = spec.span(id);
        built.push(match formula {
            _ if id == part => changed.truth(value, span),
            Formula::True => changed.truth(true, span),
            Formula::False => changed.truth(false, span),
            Formula::Literal { proposition, negated } => {
                changed.literal(proposition, negated, span)
            }
            Formula::And(a, b) => changed.and(of(a), of(b), span),
            Formula::Or(a, b) => changed.or(of(a), of(b), span),
            Formula::Next(a) => changed.next(of(a), span),
            Formula::Eventually(a) => changed.eventually(of(a), span),
            Formula::Until(a, b) => changed.until(of(a), of(b), span),
            Formula::Then(a, b) => changed.then(of(a), of(b), span),
        });
    }
    changed.set_root(built[spec.root().0 as usize]);
    changed
}

/// Whether two minimal automata over the same propositions, numbered alike, are the same.
fn same(a: &Dfa, b: &Dfa) -> bool {
    if (a.accepting, a.trap, a.len()) != (b.accepting, b.trap, b.len()) {
        return false;
    }
    let pairs = a.transitions.iter().copied().zip(b.transitions.iter().copied());
    let mut open: Vec<(Target, Target)> = pairs.collect();
    let mut seen = FxHashSet::default();
    while let Some((x, y)) = open.pop() {
        if !seen.insert((x, y)) {
            continue;
        }
        let (p, q) = (a.diagram.proposition(x), b.diagram.proposition(y));
        if p != q || (p.is_none() && x.state() != y.state()) {
            return false;
        }
        if let Some(p) = p {
            let ((x0, x1), (y0, y1)) = (a.diagram.split(x, p), b.diagram.split(y, p));
            open.extend([(x0, y0), (x1, y1)]);
        }
    }
    true
}
