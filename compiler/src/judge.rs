//! Predicates and tasks that can hardly be meant: never satisfied, or always; and why.
//!
//! The reasons come from the same arithmetic as the letters that can occur: a set of comparisons is
//! made smaller until each is needed for the contradiction.

use crate::arithmetic::{self, Possible};
use crate::dfa::{Automata, Dfa};
use crate::error::{Error, Kind};
use crate::predicate::{Condition, ConditionId, Module, Task};
use crate::source::Span;

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
    for edge in dfa.edges().iter().filter(|edge| nearer(edge.from, edge.to)) {
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
