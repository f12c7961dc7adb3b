//! Temporal operators that order less than they seem to.
//!
//! They are about the formulas that authors of sequences get wrong: `F a T b` and `(a T b) T c`
//! ask for less order than one reads into them, and in `a U F b` the left side says nothing.

use tltl_compiler::ast::{Ast, Infix, Node, NodeId, Prefix};
use tltl_compiler::error::{Error, Kind};

/// The text of an expression, in brackets if it has an operator.
fn bracketed(ast: &Ast, id: NodeId) -> String {
    let text = ast.quote(id);
    match ast.node(id) {
        Node::Prefix(..) | Node::Infix(..) | Node::Quantified(_) => format!("({text})"),
        _ => text,
    }
}

/// A warning if the operator `id` orders less than its author seems to think.
pub(super) fn warning(ast: &Ast, id: NodeId) -> Option<Error> {
    match *ast.node(id) {
        Node::Infix(Infix::Until, left, right) => idle_until(ast, left, right),
        Node::Infix(Infix::Then, left, right) => early_then(ast, id, left, right),
        _ => None,
    }
}

/// A warning for `F a T b` without brackets, and for `(a T b) T c`.
fn early_then(ast: &Ast, id: NodeId, left: NodeId, right: NodeId) -> Option<Error> {
    let right = ast.quote(right);
    match *ast.node(left) {
        Node::Prefix(Prefix::Eventually, a) if !ast.entry(left).is_bracketed() => {
            let a = ast.quote(a);
            let f = ast.source().slice(ast.entry(left).operator);
            let message = format!(
                "`{f} {a} T {right}` reads `({f} {a}) T {right}`, which does not order {a} before {right}"
            );
            Some(Error::new(Kind::Intent, message, ast.span(left))
                .warning()
                .related(ast.entry(id).operator, "\"then\" waits only for \"eventually\" to be certain")
                .help(format!("for {a} and later {right}, write `{a} T {right}`; to keep this meaning, write the brackets")))
        }
        Node::Infix(Infix::Then, a, b) => {
            let (a, b) = (ast.quote(a), ast.quote(b));
            let message = format!("`({a} T {b}) T {right}` does not order {b} before {right}");
            Some(
                Error::new(Kind::Intent, message, ast.entry(left).outer)
                    .warning()
                    .label(format!("this holds from the start, before {b} has come"))
                    .help(format!("for the three in this order, write `{a} T ({b} T {right})`")),
            )
        }
        _ => None,
    }
}

/// A warning for `a U F b`, which says no more than `F b`.
fn idle_until(ast: &Ast, left: NodeId, right: NodeId) -> Option<Error> {
    let goal = match *ast.node(right) {
        // Within a bound, it has to come at the right time.
        Node::Prefix(Prefix::Eventually, _) if ast.entry(right).bound.is_some() => return None,
        Node::Prefix(Prefix::Eventually, goal) | Node::Infix(Infix::Then, goal, _) => goal,
        _ => return None,
    };
    let (kept, text) = (ast.quote(left), ast.quote(right));
    let operand = |id| match ast.node(id) {
        Node::Prefix(..) => ast.quote(id),
        _ => bracketed(ast, id),
    };
    let (keep, goal) = (operand(left), operand(goal));
    let message = format!(
        "`{kept}` does not matter: `{text}` already looks ahead, so `U` need not wait for it"
    );
    Some(
        Error::new(Kind::Vacuous, message, ast.entry(left).outer)
            .warning()
            .related(
                ast.entry(right).operator,
                "this is asked at the first state, not when it comes true",
            )
            .help(format!("to keep to {keep} until {goal} comes, write `{keep} U {goal}`")),
    )
}
