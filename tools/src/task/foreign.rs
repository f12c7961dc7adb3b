//! Automata of other tools as compiled sources, so that they are tasks like any other.

use std::path::Path;

use tltl_compiler::compile::Compiled;
use tltl_compiler::dfa::Automata;
use tltl_compiler::hoa;
use tltl_compiler::predicate::{Condition, Module, Options, Predicate, PredicateId, Task};
use tltl_compiler::source::Span;
use tltl_compiler::spec::Spec;

/// An automaton as the task of a module without declarations, as a bare formula is one. It is called by
/// its name, or by that of its file. The formula of its spec means nothing, and nobody reads it.
pub(super) fn compiled(read: hoa::Automaton, file: &str) -> Compiled {
    let hoa::Automaton { name, dfa } = read;
    let stem = || Path::new(file).file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut module = Module::default();
    for proposition in &dfa.propositions {
        let name = proposition.name.clone();
        let condition = module.arena.add_condition(Condition::Free(name.clone()));
        let (declared, parameters, docs) = (false, Vec::new(), Vec::new());
        let predicate =
            Predicate { name, declared, parameters, docs, span: Span::default(), condition };
        module.predicates.push(predicate);
    }
    module.tasks.push(Task {
        name: None,
        docs: Vec::new(),
        span: Span::default(),
        parameters: Vec::new(),
        text: name.unwrap_or_else(stem),
        spec: Spec::new(dfa.propositions.clone()),
        predicates: (0..module.predicates.len() as u32).map(PredicateId).collect(),
        parts: None,
        options: Options::default(),
    });
    let automata = vec![Automata { propositional: dfa.clone(), dfa }];
    Compiled { module, automata, factored: Vec::new() }
}
