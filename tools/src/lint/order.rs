//! Temporal operators that order less than they seem to.
//!
//! They are about the formulas that authors of sequences get wrong: `F a T b` and `(a T b) T c`
//! ask for less order than one reads into them, and in `a U F b` the left side says nothing.

use tltl_compiler::ast::{Ast, Infix, Node, NodeId, Prefix};
use tltl_compiler::error::{Error, Kind};

/// A warning if the operator `id` orders less than its author seems to think.
pub(super) fn warning(ast: &Ast, id: NodeId) -> Option<Error> {
    match *ast.node(id) {
        Node::Infix(Infix::Until, left, right) => idle_until(ast, id, left, right),
        Node::Infix(Infix::Then, left, right) => early_then(ast, id, left, right),
        _ => None,
    }
}

/// A warning for `F a T b` without brackets, and for `(a T b) T c`.
fn early_then(ast: &Ast, id: NodeId, left: NodeId, right: NodeId) -> Option<Error> {
    let then = ast.node(id);
    let bound = bound(ast, id);
    let second = short(ast.within(then, right, false), "ψ");
    match *ast.node(left) {
        Node::Prefix(Prefix::Eventually, a) if !ast.entry(left).is_bracketed() => {
            let within = self::bound(ast, left);
            let f = ast.source().slice(ast.entry(left).operator);
            let (under, first) = (ast.within(ast.node(left), a, false), ast.within(then, a, true));
            let [under, first] = [under, first].map(|text| short(text, "φ"));
            let (message, plain) = (
                format!("`{f} {under} T{bound} {second}` reads `({f} {under}) T{bound} {second}`"),
                [a, right].map(|id| ast.quote(id)),
            );
            let message =
                format!("{message}, which does not order {} before {}", plain[0], plain[1]);
            let error = Error::new(Kind::Intent, message, ast.span(left)).warning().related(
                ast.entry(id).operator,
                "\"then\" waits only for \"eventually\" to be certain",
            );
            // A bound would be lost, and of three in a row the first two would not be in order.
            if !within.is_empty() || matches!(ast.node(a), Node::Infix(Infix::Then, ..)) {
                return Some(error.help("to keep this meaning, write the brackets"));
            }
            let [a, b] = plain;
            Some(error.help(format!("for {a} and later {b}, write `{first} T{bound} {second}`; to keep this meaning, write the brackets")))
        }
        Node::Infix(Infix::Then, a, b) => Some(unordered_then(ast, id, [left, a, b, right])),
        _ => None,
    }
}

/// The warning for `(a T b) T c`.
fn unordered_then(ast: &Ast, id: NodeId, [left, a, b, right]: [NodeId; 4]) -> Error {
    let (then, bound) = (ast.node(id), bound(ast, id));
    let second = short(ast.within(then, right, false), "ψ");
    let parent = Node::Infix(Infix::Then, a, b);
    let first = short(ast.within(&parent, a, true), "φ");
    let (between, middle) = (ast.within(&parent, b, false), ast.within(then, b, true));
    let [between, middle] = [between, middle].map(|text| short(text, "χ"));
    let inner = self::bound(ast, left);
    let rest = match (inner, bound) {
        ("", _) => format!("{middle} T{bound} {second}"),
        // `T` asks for the next two sometime; a bound is on the one that follows at once.
        _ => {
            let both = Node::Infix(Infix::And, b, right);
            let later = Node::Prefix(Prefix::Eventually, right);
            let middle = short(ast.within(&both, b, true), "χ");
            let second = short(ast.within(&later, right, false), "ψ");
            format!("{middle} && {} {second}", later_within(bound))
        }
    };
    let [plain, last] = [b, right].map(|id| ast.quote(id));
    let message = format!(
        "`({first} T{inner} {between}) T{bound} {second}` does not order {plain} before {last}"
    );
    Error::new(Kind::Intent, message, ast.entry(left).outer)
        .warning()
        .label(format!("this holds from the start, before {plain} has come"))
        .help(format!("for the three in this order, write `{first} T{inner} ({rest})`"))
}

/// The text of an operand, or a letter for one that nobody would read to its end.
fn short(text: String, letter: &str) -> String {
    if text.len() > 60 { letter.to_owned() } else { text }
}

/// The bound of an operator, as it was written.
fn bound(ast: &Ast, id: NodeId) -> &str {
    ast.entry(id).bound.as_ref().map_or("", |bound| ast.source().slice(bound.span))
}

/// The operators that ask for something after the first, within the bound of a `T`.
fn later_within(bound: &str) -> String {
    match bound {
        "" => "X F".to_owned(),
        // `T[<=b]` is `T[1,b]`.
        _ => format!("F{}", bound.replacen("<=", "1,", 1).replacen('≤', "1,", 1)),
    }
}

/// A warning for `a U F b`, which says no more than `F b`.
fn idle_until(ast: &Ast, id: NodeId, left: NodeId, right: NodeId) -> Option<Error> {
    let goal = match *ast.node(right) {
        // Within a bound, it has to come at the right time.
        Node::Prefix(Prefix::Eventually, _) if ast.entry(right).bound.is_some() => return None,
        Node::Prefix(Prefix::Eventually, goal) | Node::Infix(Infix::Then, goal, _) => goal,
        _ => return None,
    };
    let (kept, text) = (ast.quote(left), ast.quote(right));
    let until = ast.node(id);
    let (keep, goal) = (ast.within(until, left, true), ast.within(until, goal, false));
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
            .help(format!(
                "to keep to {keep} until {goal} comes, write `{keep} U{} {goal}`",
                bound(ast, id)
            )),
    )
}
