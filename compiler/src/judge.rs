//! Finds predicates and tasks that cannot be meant, because they never hold, and says why.
//!
//! Which letters can occur is known ([`Possible`]), so an unsatisfiable predicate is one that no
//! possible letter has, and an unsatisfiable task one whose automaton has no accepting state. The
//! work is the reason. It comes from the same arithmetic: a set of comparisons is reduced until
//! each of them is needed for the contradiction (an irreducible infeasible subset, by the deletion
//! filter of Chinneck and Dravnieks, 1991). The message then names those and points at them.
//!
//! ```text
//! error[unsatisfiable]: the predicate `stuck` can never hold
//!    `x < 1` and `x > 3` exclude each other
//! ```
//!
//! A bare formula is not judged when it is compiled: it may be there to be explored. Nothing here
//! changes an automaton. Cost: one emptiness test for each comparison of a contradiction.
//! Known weakness: a contradiction over several instants is found (the automaton shows it) but not
//! explained.
//!
//! ```
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let text = "state S { x: f64 }\npredicate stuck = x < 1 && x > 3\ntask t = F stuck\n";
//! let errors = compile::file(&Source::new("s.tltl", text), Budget::EMITTED).unwrap_err();
//! assert_eq!(errors.first().message(), "the predicate `stuck` can never hold");
//! assert_eq!(errors.first().place_label(), "`x < 1` and `x > 3` exclude each other");
//! ```

use crate::arithmetic::{self, Possible};
use crate::dfa::{Automata, Dfa, Guards};
use crate::error::{Error, Kind};
use crate::predicate::{Condition, ConditionId, Module, Task};
use crate::source::Span;

/// The mistakes of one task, its predicates first.
#[must_use]
pub fn task(module: &Module, task: &Task, possible: &Possible, automata: &Automata) -> Vec<Error> {
    let mut mistakes = predicates(module, task, possible);
    mistakes.extend(formula(module, task, possible, automata));
    mistakes
}

/// A mistake for each predicate that never holds.
fn predicates(module: &Module, task: &Task, possible: &Possible) -> Vec<Error> {
    let mut mistakes = Vec::new();
    for (values, &id) in possible.values().into_iter().zip(&task.predicates) {
        if values == (false, true) {
            let predicate = &module.predicates[id.0 as usize];
            let core = contradiction(module, &[(predicate.condition, true, predicate.span)]);
            let message = format!("the predicate `{}` can never hold", predicate.name);
            let error = Error::new(Kind::Unsatisfiable, message, predicate.span);
            mistakes.push(pointing(error.label(never(&core)), &core));
        }
    }
    mistakes
}

/// The error with the places of the parts of a contradiction; a contradiction of one part has no
/// place beside that of the error itself.
#[must_use]
pub fn pointing(error: Error, core: &[Part]) -> Error {
    let several = core.iter().filter(|_| core.len() > 1);
    several.fold(error, |error, part| match (part.place, part.holds) {
        (None, _) => error,
        (Some(place), true) => error.related(place, part.text.clone()),
        (Some(place), false) => error.related(place, format!("{} where this fails", part.text)),
    })
}

/// The reason why a predicate never holds.
fn never(core: &[Part]) -> String {
    match core {
        [] => "no state satisfies this".to_owned(),
        [one] => format!("no value of its type satisfies {}", one.text),
        all => excluding(&texts(all)),
    }
}

/// The texts of some parts.
#[must_use]
pub fn texts(parts: &[Part]) -> Vec<String> {
    parts.iter().map(|part| part.text.clone()).collect()
}

/// The sentence that some conditions cannot hold together.
fn excluding(all: &[String]) -> String {
    match all {
        [one, other] => format!("{one} and {other} exclude each other"),
        all => format!("{} cannot hold together", listed(all)),
    }
}

/// The same as the end of a sentence: "`a` and `b`, which exclude each other".
#[must_use]
pub fn failing(all: &[String]) -> String {
    match all {
        [one, other] => format!("{one} and {other}, which exclude each other"),
        all => format!("{}, which cannot hold together", listed(all)),
    }
}

/// A list of words: "a, b and c".
fn listed(all: &[String]) -> String {
    match all.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} and {last}", rest.join(", ")),
        _ => all.concat(),
    }
}

/// A part of a contradiction: a condition together with the value that it must have.
pub struct Part {
    /// The condition.
    pub id: ConditionId,
    /// Whether it must hold; it must fail otherwise.
    pub holds: bool,
    /// The condition that must hold, as text in backquotes.
    pub text: String,
    /// The place in the source that says so; `None` if it follows from a type.
    pub place: Option<Span>,
}

/// The parts of some conditions, or of their negations, that contradict each other. Each condition
/// comes with the value that it must have and the place of its predicate.
///
/// Empty if a condition is a constant, or if these parts alone do not contradict each other.
#[must_use]
pub fn contradiction(module: &Module, conditions: &[(ConditionId, bool, Span)]) -> Vec<Part> {
    let mut parts = parts(module, conditions);
    let roots: Vec<_> = parts.iter().map(|part| part.id).collect();
    let possible = arithmetic::possible_conditions(module, &roots);
    let literals: Vec<_> = (0..).zip(parts.iter().map(|part| part.holds)).collect();
    let core = core(&possible, literals);
    let mut place = 0..;
    parts.retain(|_| place.next().is_some_and(|at| core.iter().any(|(kept, _)| *kept == at)));
    parts
}

/// The parts that must hold, or fail, for conditions to have the given values: their conjuncts,
/// through negation and the conditions of other predicates. A disjunction that must hold is one
/// part.
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

/// The place of a condition in the source: the first from `from` on, or the first of all. Equal
/// comparisons are one condition, so the one that is meant is the one inside its own predicate.
fn place(module: &Module, id: ConditionId, from: Span) -> Option<Span> {
    let same = |known: ConditionId| known == id || negates(module, known, id);
    let places = || module.places.iter().filter(|(known, _)| same(*known)).map(|(_, span)| *span);
    places().filter(|span| span.start >= from.start).min().or_else(|| places().min())
}

/// Whether two comparisons are each other's negation. The source may have either, because `!`
/// before a comparison becomes the opposite comparison.
fn negates(module: &Module, a: ConditionId, b: ConditionId) -> bool {
    match (module.arena.condition(a), module.arena.condition(b)) {
        (Condition::Compare(one, x, y), Condition::Compare(other, u, v)) => {
            (one.negated(), x, y) == (*other, u, v)
        }
        _ => false,
    }
}

/// A condition that must hold, or the negation of one that must fail, in backquotes.
fn part_text(module: &Module, part: ConditionId, holds: bool) -> String {
    let text = match (module.arena.condition(part), holds) {
        (_, true) => module.display(part).to_string(),
        (Condition::Compare(op, a, b), false) => {
            let (a, b) = (module.display_term(*a), module.display_term(*b));
            format!("{a} {} {b}", op.negated().symbol())
        }
        (Condition::Bool(_) | Condition::Value { .. }, false) => {
            format!("!{}", module.display(part))
        }
        (_, false) => format!("!({})", module.display(part)),
    };
    format!("`{text}`")
}

/// A minimal subset of `literals` that no possible letter has, by deletion: each literal is left
/// out, and put back if the rest can occur. Empty if all can occur together.
fn core(possible: &Possible, mut literals: Vec<(u32, bool)>) -> Vec<(u32, bool)> {
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

/// The mistake of a formula that no trajectory satisfies.
fn formula(
    module: &Module,
    task: &Task,
    possible: &Possible,
    automata: &Automata,
) -> Option<Error> {
    if automata.dfa.accepting.is_some() {
        return None;
    }
    let message = format!("{} can never be satisfied", task.title());
    let error = Error::new(Kind::Unsatisfiable, message, task.span);
    let error = error.label("no trajectory satisfies this");
    match obstacle(possible, &automata.propositional).as_deref() {
        // The predicate itself has been reported.
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

/// The demand of a formula that no state meets at one instant: the literals of a guard of which a
/// subset cannot occur.
///
/// Looks at the edges of the propositional automaton that lead nearer to acceptance. One that no
/// possible letter takes is a reason; the first cube of its guard stands for all of them.
fn obstacle(possible: &Possible, dfa: &Dfa) -> Option<Vec<(u32, bool)>> {
    dfa.accepting?;
    let distances = dfa.distances();
    let mut dfa = dfa.clone();
    possible.attach(&mut dfa);
    let mut guards = Guards::new(&dfa);
    for q in dfa.states() {
        for to in dfa.successors(q) {
            let nearer = distances[to as usize] < distances[q as usize];
            if let Some(cube) = nearer.then(|| guards.impossible(q, to)).flatten() {
                return Some(core(possible, cube));
            }
        }
    }
    None
}

/// A literal as text, in backquotes.
fn name(task: &Task, (proposition, holds): (u32, bool)) -> String {
    let name = &task.spec.propositions()[proposition as usize];
    if holds { format!("`{name}`") } else { format!("`!({name})`") }
}
