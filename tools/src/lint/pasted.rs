//! Names of bare formulas that are operators or constants in other tools.
//!
//! A word is a name here, so `Fa` is a proposition. Spot, Owl and most papers read it as `F a`, and
//! a formula that was pasted from there would silently mean something else. A bare formula declares
//! nothing, so its author is asked; in a file, a name that nothing declares is a mistake anyway.

use std::collections::BTreeSet;

use tltl_compiler::ast::{Ast, Node, NodeId};
use tltl_compiler::error::{Error, Kind};

/// A warning for the first use of each name that looks like glued operators, or that is a word of
/// another tool.
pub(super) fn warnings(ast: &Ast) -> Vec<Error> {
    let bound = super::nodes(ast).filter_map(|id| match ast.node(id) {
        Node::Quantified(quantifier) => Some(ast.source().slice(quantifier.name)),
        _ => None,
    });
    let bound: BTreeSet<&str> = bound.collect();
    let named = |id: &NodeId| matches!(ast.node(*id), Node::Name) && !bound.contains(ast.text(*id));
    let uses: Vec<NodeId> = super::nodes(ast).filter(named).collect();
    let names: BTreeSet<&str> = uses.iter().map(|id| ast.text(*id)).collect();
    let mut seen = BTreeSet::new();
    let first = uses.into_iter().filter(|id| seen.insert(ast.text(*id)));
    first.filter_map(|id| warning(ast, id, &names)).collect()
}

/// The warning for one name among all `names` of the formula.
fn warning(ast: &Ast, id: NodeId, names: &BTreeSet<&str>) -> Option<Error> {
    let name = ast.text(id);
    let (message, help) = if let Some((means, write)) = word(name) {
        (
            format!("`{name}` is a name here, though other tools read it as {means}"),
            write.to_owned(),
        )
    } else {
        let apart = glued(name, names)?;
        let message = format!("`{name}` is one name, though other tools read it as `{apart}`");
        (message, format!("for the operators, write `{apart}`"))
    };
    let keep = "if it is meant as a name, nothing needs to change";
    Some(Error::new(Kind::Intent, message, ast.span(id)).warning().help(help).help(keep))
}

/// What a word means to other tools, and what to write for that.
fn word(name: &str) -> Option<(&'static str, &'static str)> {
    Some(match name {
        "tt" | "TRUE" | "True" => ("\"true\"", "for that, write `true`"),
        "ff" | "FALSE" | "False" => ("\"false\"", "for that, write `false`"),
        "last" | "end" => (
            "the end of the trajectory",
            "there is no operator for that: no prefix knows that it is the last",
        ),
        _ => return None,
    })
}

/// A name with its operators apart, if it looks like glued ones: one or more of `F G X`, then a
/// name in lower case that
///
/// - has one letter, ends in a digit or stands in the formula too: `Fa`, `GFp0`, `Fgoal … goal`, or
/// - begins with letters that begin no English word together with the operator: `Fgoal`, `Xdone`,
///   but not `Fridge`.
fn glued(name: &str, names: &BTreeSet<&str>) -> Option<String> {
    let rest = name.trim_start_matches(['F', 'G', 'X']);
    let operators = &name[..name.len() - rest.len()];
    let last = operators.chars().last()?;
    let first = rest.chars().next().filter(char::is_ascii_lowercase)?;
    let is_goal = rest.len() == 1
        || rest.ends_with(|c: char| c.is_ascii_digit())
        || names.contains(rest)
        || operators.len() > 1
        || !begins_word(last, first);
    let apart = |operator| format!("{operator} ");
    is_goal.then(|| operators.chars().map(apart).collect::<String>() + rest)
}

/// Whether a word of English can begin with these two letters.
fn begins_word(capital: char, next: char) -> bool {
    let after = match capital {
        'F' => "aeiouylr",
        'G' => "aeiouyhlnrw",
        _ => "aeiouy",
    };
    after.contains(next)
}
