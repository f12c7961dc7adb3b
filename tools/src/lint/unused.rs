//! Predicates and constants that nothing uses.

use std::collections::BTreeSet;

use tltl_compiler::ast::{Ast, Declaration, ItemKind, Node};
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::predicate::Scalar;

/// A warning for each predicate and constant whose name stands in no expression. Not in a source
/// without tasks, which may be a library.
///
/// A constant may serve as an argument of a task, so nothing is said of constants where a task
/// takes a number.
pub(super) fn warnings(ast: &Ast) -> Vec<Error> {
    let tasks = ast.items().iter().filter_map(|item| match &item.kind {
        ItemKind::Task(parameters, _) => Some(parameters),
        _ => None,
    });
    let tasks: Vec<_> = tasks.collect();
    if tasks.is_empty() {
        return taskless(ast).into_iter().collect();
    }
    let is_number = |known: &Declaration| {
        matches!(Scalar::named(ast.source().slice(known.ty.name)), Some(Scalar::Number(_)))
    };
    let takes_numbers = tasks.iter().any(|parameters| parameters.iter().any(is_number));
    let names = super::nodes(ast).filter(|id| matches!(ast.node(*id), Node::Name));
    let used: BTreeSet<&str> = names.map(|id| ast.text(id)).collect();
    let mut warnings = Vec::new();
    for item in ast.items() {
        let what = match item.kind {
            ItemKind::Predicate(..) => "predicate",
            ItemKind::Constant(..) if !takes_numbers => "constant",
            _ => continue,
        };
        let name = ast.source().slice(item.name);
        if !used.contains(name) {
            let message = format!("{what} `{name}` is never used");
            warnings.push(Error::new(Kind::Unused, message, item.name).warning());
        }
    }
    warnings
}

/// A warning for a file without tasks and predicates, of which nothing can be made.
fn taskless(ast: &Ast) -> Option<Error> {
    let last = ast.items().last()?;
    let is_predicate = |kind: &ItemKind| matches!(kind, ItemKind::Predicate(..));
    if ast.items().iter().any(|item| is_predicate(&item.kind)) {
        return None;
    }
    let message = "this file declares no task, so there is nothing to do";
    let warning = Error::new(Kind::Unused, message, last.name).warning();
    Some(warning.help("declare one, such as `task go = F done`"))
}
