//! Temporal operators that cannot stand where they do, or hardly mean what they say.

use crate::ast::{Ast, Infix, Node, NodeId, Prefix};
use crate::error::{Error, Kind};

/// The error for the temporal operator `id` under the negation `by`.
pub(super) fn negated(ast: &Ast, id: NodeId, by: NodeId) -> Error {
    let operator = ast.entry(id).operator;
    let symbol = ast.source().slice(operator);
    let hidden = matches!(ast.node(by), Node::Infix(..));
    let message = if hidden {
        let text = bracketed(ast, id);
        format!("the left side of `=>` is negated, and `!{text}` is outside the language")
    } else {
        let direct = matches!(ast.node(by), Node::Prefix(_, operand) if *operand == id);
        let not = ast.source().slice(ast.entry(by).operator);
        if direct {
            format!("`{not}` cannot stand before `{symbol}`")
        } else {
            let text = bracketed(ast, id);
            format!("this `{not}` reaches `{symbol}`, and `!{text}` is outside the language")
        }
    };
    let negation = ast.entry(by).operator;
    let related = if hidden { "`φ => ψ` means `!φ || ψ`" } else { "this negation reaches it" };
    let (primary, other) = if hidden { (operator, negation) } else { (negation, operator) };
    let error = Error::new(Kind::NegatedTemporal, message, primary);
    let error = if hidden {
        error.label(what(ast.node(id))).related(other, related)
    } else {
        error.related(other, what(ast.node(id)))
    };
    advice(ast, id, error)
}

/// What a temporal operator says, for a label.
fn what(node: &Node) -> &'static str {
    match node {
        Node::Prefix(Prefix::Eventually, _) => "\"eventually\"",
        Node::Prefix(Prefix::Next, _) => "\"at the next state\"",
        Node::Infix(Infix::Until, ..) => "\"until\"",
        _ => "\"then\"",
    }
}

/// Why the negation is outside the language, and what to write instead.
fn advice(ast: &Ast, id: NodeId, error: Error) -> Error {
    match *ast.node(id) {
        Node::Prefix(Prefix::Next, operand) => {
            let text = bracketed(ast, operand);
            let next = ast.source().slice(ast.entry(id).operator);
            error
                .help(format!(
                    "`!{next} {text}` would hold at the end of a trajectory for want of a next state"
                ))
                .help(format!("to ask for a next state without it, write `{next} !{text}`"))
        }
        Node::Prefix(_, operand) => {
            let text = bracketed(ast, operand);
            error
                .help(format!(
                    "it is \"always not {text}\": no finite trajectory can ever establish it, for the next state may break it"
                ))
                .help(format!("to stay out of {text} until a goal is reached, write `!{text} U goal`"))
        }
        Node::Infix(_, _, right) => {
            let right = bracketed(ast, right);
            error
                .help(format!(
                    "it would hold as long as {right} has not come: no finite trajectory can ever \
                     establish it, for the next state may bring {right}"
                ))
                .help(format!(
                    "to stay out of {right} until a goal is reached, write `!{right} U goal`"
                ))
        }
        _ => error,
    }
}

/// The text of an expression, in brackets if it has an operator.
fn bracketed(ast: &Ast, id: NodeId) -> String {
    let text = ast.quote(id);
    match ast.node(id) {
        Node::Prefix(..) | Node::Infix(..) | Node::Quantified { .. } => format!("({text})"),
        _ => text,
    }
}

/// A warning if the operator `id` orders less than its author seems to think.
pub(super) fn warning(ast: &Ast, id: NodeId) -> Option<Error> {
    if let Node::Infix(Infix::Until, left, right) = *ast.node(id) {
        return idle_until(ast, left, right);
    }
    let Node::Infix(Infix::Then, left, right) = *ast.node(id) else { return None };
    let entry = ast.entry(left);
    let right = ast.quote(right);
    match *ast.node(left) {
        Node::Prefix(Prefix::Eventually, a) if !entry.is_bracketed() => {
            let a = ast.quote(a);
            let f = ast.source().slice(entry.operator);
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
                Error::new(Kind::Intent, message, entry.outer)
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
        Node::Prefix(Prefix::Eventually, goal) => goal,
        Node::Infix(Infix::Then, goal, _) => goal,
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
