//! Predicates and tasks that always hold; in a bare formula also those that never do.
//!
//! What can never hold is an error of the compiler. A bare formula may be there to be explored, so
//! it is a warning there, in the same words.

use tltl_compiler::arithmetic;
use tltl_compiler::compile::{Compiled, Part};
use tltl_compiler::dfa::Automata;
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::judge;
use tltl_compiler::predicate::{Module, Task};

/// The predicates of one task that always hold; all that never holds of a formula without a name.
pub(super) fn predicates(module: &Module, task: &Task, automata: &Automata) -> Vec<Error> {
    let possible = arithmetic::possible(module, task);
    let mut warnings = Vec::new();
    if task.name.is_none() {
        let never = judge::task(module, task, &possible, automata);
        warnings.extend(never.into_iter().map(Error::warning));
    }
    for (values, &id) in possible.values().into_iter().zip(&task.predicates) {
        if values == (true, false) {
            let predicate = &module.predicates[id.0 as usize];
            let core =
                judge::contradiction(module, &[(predicate.condition, false, predicate.span)]);
            let message = format!("the predicate `{}` always holds", predicate.name);
            let warning = Error::new(Kind::Valid, message, predicate.span).label(reason(&core));
            warnings.push(judge::pointing(warning, &core).warning());
        }
    }
    warnings
}

/// The tasks that every trajectory satisfies. A factored one is such a task if all its parts are.
pub(super) fn tasks(compiled: &Compiled) -> impl Iterator<Item = Error> {
    let holds = |automata: &Automata| automata.dfa.accepting == Some(0);
    let whole = compiled.module.tasks.iter().zip(&compiled.automata);
    let whole = whole.filter(move |(_, automata)| holds(automata)).map(|(task, _)| task);
    let all = move |parts: &[Part]| parts.iter().all(|part| holds(&part.automata));
    let factored = compiled.factored.iter().filter(move |known| all(&known.parts));
    whole.chain(factored.map(|known| &known.task)).map(|task| {
        let message = format!("{} is always satisfied", task.title());
        let warning = Error::new(Kind::Valid, message, task.span);
        warning.label("every trajectory satisfies this").warning()
    })
}

/// The reason why a predicate always holds: its negation never does.
fn reason(core: &[judge::Part]) -> String {
    match core {
        [] => "every state satisfies this".to_owned(),
        [one] => format!("it fails only for {}, which no value of its type satisfies", one.text),
        all => format!("it fails only where {}", judge::failing(&judge::texts(all))),
    }
}
