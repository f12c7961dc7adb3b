//! Temporal operators that cannot stand where they do.
//!
//! The logic is co-safe: a finite trajectory must be able to establish a formula for good. A
//! negated temporal operator is a safety property, which none can. The errors here say so in terms
//! of the author's own formula, and offer the `U` that is usually meant.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let errors = check::formula(&Source::new("formula", "F a && G !b")).unwrap_err();
//! assert_eq!(errors.first().kind().name(), "unsupported-operator");
//! assert!(!errors.first().helps().is_empty(), "it says what to write");
//! ```

use crate::ast::{Ast, Infix, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::parse;
use crate::resolve::{Expression, ExpressionId, Resolved};
use crate::token::{compact, is_word_start};

/// The error for an operator whose formulas no finite trajectory can establish.
pub(super) fn unsupported(resolved: &Resolved<'_>, id: ExpressionId) -> Error {
    match resolved[id].expression {
        Expression::Infix(op, ..) => refused(resolved, id, op.symbol()),
        _ if is_empty_bound(resolved, id) => refused(resolved, id, "G")
            .help("for a bound, say which states count: `F[0,5]`; else leave the brackets out"),
        _ => refused(resolved, id, "G").help(
            "to keep `c` until the goals are reached, write `F a && F b ensuring c`; for ten steps, `G[0,10] c`",
        ),
    }
}

/// Whether the author may have meant `[]` for the bound of an operator right before it.
fn is_empty_bound(resolved: &Resolved<'_>, id: ExpressionId) -> bool {
    let before = &resolved.ast.source().text()[..resolved.operator(id).start];
    let operator = before.trim_end_matches(['F', 'X', 'G']);
    let is_word = before.len() - operator.len() == 1 && !operator.ends_with(is_word_start);
    resolved.symbol(id) == "[]" && (is_word || before.ends_with(['◇', '○', '□']))
}

/// The error for an operator, without what to write instead.
fn refused(resolved: &Resolved<'_>, id: ExpressionId, word: &str) -> Error {
    parse::unsupported(word, resolved.symbol(id), resolved.operator(id))
}

/// The error for "always" beside goals, if the operand `always` of a conjunction is one: until they
/// are reached is what is meant.
pub(super) fn always_beside(
    resolved: &Resolved<'_>,
    always: ExpressionId,
    goals: ExpressionId,
) -> Option<Error> {
    let Expression::Prefix(Prefix::Always, kept) = resolved[always].expression else { return None };
    let ast = resolved.ast;
    let node = |id| resolved[id].node;
    let (node, goals, kept) = (node(always), node(goals), node(kept));
    if ast.entry(node).bound.is_some() || !is_of_a_state(ast, kept) || !can_be_goals(ast, goals) {
        return None;
    }
    let parent = Node::Infix(Infix::Ensuring, goals, kept);
    let (goals, kept) = (ast.within(&parent, goals, true), ast.within(&parent, kept, false));
    let help = format!("to keep it until the rest is reached, write `{goals} ensuring {kept}`");
    Some(refused(resolved, always, "G").help(help))
}

/// Whether an expression is short enough to repeat, and has no other "always" in it.
fn can_be_goals(ast: &Ast, root: NodeId) -> bool {
    /// More operators and operands than a message can show.
    const MOST: u32 = 40;
    let first = ast.first(root).0;
    let is_always = |id| {
        let always = matches!(ast.node(id), Node::Prefix(Prefix::Always, _));
        always && ast.entry(id).bound.is_none()
    };
    root.0 - first < MOST && !(first..=root.0).map(NodeId).any(is_always)
}

/// Whether an expression has no temporal operator; a task may still hide one.
fn is_of_a_state(ast: &Ast, root: NodeId) -> bool {
    let is_temporal = |node| match ast.node(node) {
        Node::Prefix(op, _) => !matches!(op, Prefix::Not | Prefix::Minus),
        Node::Infix(op, ..) => op.is_temporal(),
        _ => false,
    };
    !(ast.first(root).0..=root.0).map(NodeId).any(is_temporal)
}

/// The error for the temporal operator `id` where `by` needs a formula of one state.
pub(super) fn not_of_a_state(resolved: &Resolved<'_>, id: ExpressionId, by: ExpressionId) -> Error {
    let Expression::Infix(Infix::Ensuring, ..) = resolved[by].expression else {
        return negated(resolved, id, by);
    };
    let symbol = resolved.symbol(id);
    let message = format!(
        "the right side of `ensuring` speaks of one state, so `{symbol}` cannot stand in it"
    );
    Error::new(Kind::Syntax, message, resolved.operator(id))
        .related(
            resolved.operator(by),
            "what stands on its right must hold at every instant on the way",
        )
        .help("what is to be reached stands on its left: `F a && F b ensuring !c`")
}

/// The error for the temporal operator `id` under the negation `by`.
pub(super) fn negated(resolved: &Resolved<'_>, id: ExpressionId, by: ExpressionId) -> Error {
    let (symbol, not) = (resolved.symbol(id), resolved.symbol(by));
    let text = match resolved[id].expression {
        Expression::Prefix(..) => resolved.quote(id),
        _ => bracketed(resolved, id),
    };
    let message = match resolved[by].expression {
        Expression::Infix(Infix::Iff, ..) => {
            format!("`{not}` negates both its sides, and `!{text}` is outside the language")
        }
        Expression::Infix(..) => {
            format!("the left side of `=>` is negated, and `!{text}` is outside the language")
        }
        Expression::Prefix(_, operand) if operand == id => {
            format!("`{not}` cannot stand before `{symbol}`")
        }
        _ => format!("this `{not}` reaches `{symbol}`, and `!{text}` is outside the language"),
    };
    let (operator, negation) = (resolved.operator(id), resolved.operator(by));
    let what = what(&resolved[id].expression);
    let error = match resolved[by].expression {
        Expression::Infix(Infix::Iff, ..) => Error::new(Kind::NegatedTemporal, message, operator)
            .label(what)
            .related(negation, "`p <=> q` means `(p && q) || (!p && !q)`"),
        Expression::Infix(..) => Error::new(Kind::NegatedTemporal, message, operator)
            .label(what)
            .related(negation, "`φ => ψ` means `!φ || ψ`"),
        _ => Error::new(Kind::NegatedTemporal, message, negation).related(operator, what),
    };
    advice(resolved, id, error)
}

/// The reading of a temporal operator, for a label.
fn what(expression: &Expression) -> &'static str {
    match expression {
        Expression::Prefix(Prefix::Eventually, _) => "\"eventually\"",
        Expression::Prefix(Prefix::Always, _) => "\"always\"",
        Expression::Prefix(Prefix::Next, _) => "\"at the next state\"",
        Expression::Infix(Infix::Until, ..) => "\"until\"",
        Expression::Infix(Infix::Release, ..) => "\"release\"",
        Expression::Infix(Infix::WeakUntil, ..) => "\"weak until\"",
        Expression::Infix(Infix::StrongRelease, ..) => "\"strong release\"",
        Expression::Infix(Infix::Ensuring, ..) => "\"ensuring\"",
        _ => "\"then\"",
    }
}

/// Adds the reason why the negation is outside the language, and what to write instead.
fn advice(resolved: &Resolved<'_>, id: ExpressionId, error: Error) -> Error {
    if let Some(bound) = &resolved.ast.entry(resolved[id].node).bound {
        return bounded_advice(resolved, id, resolved.ast.source().slice(bound.span), error);
    }
    let (reason, goal) = match resolved[id].expression {
        Expression::Prefix(Prefix::Next, operand) => {
            let (text, next) = (bracketed(resolved, operand), resolved.symbol(id));
            return error
                .help(format!(
                    "`!{next} {text}` would hold at the end of a trajectory for want of a next state"
                ))
                .help(format!("to ask for a next state without it, write `{next} !{text}`"));
        }
        Expression::Prefix(_, operand) => {
            let text = bracketed(resolved, operand);
            let reason = format!(
                "it is \"always not {text}\": no finite trajectory can ever establish it, for the next state may break it"
            );
            (reason, text)
        }
        Expression::Infix(Infix::Ensuring, ..) => {
            return error.help("it would hold as long as the task is not satisfied: no finite trajectory can ever establish it");
        }
        Expression::Infix(Infix::StrongRelease, ..) => {
            return error.help("`a M b` is `b U (a && b)`, and no `U` can be negated");
        }
        Expression::Infix(_, _, right) => {
            let text = bracketed(resolved, right);
            let reason = format!(
                "it would hold as long as {text} has not come: no finite trajectory can ever establish it, for the next state may bring {text}"
            );
            (reason, text)
        }
        _ => return error,
    };
    let rewrite = format!("to stay out of {goal} until a goal is reached, write `!{goal} U goal`");
    error.help(reason).help(rewrite)
}

/// The same for an operator with a bound.
fn bounded_advice(resolved: &Resolved<'_>, id: ExpressionId, bound: &str, error: Error) -> Error {
    const WANT: &str = "it would hold at the end of a trajectory for want of states";
    let (operator, operand) = match resolved[id].expression {
        Expression::Prefix(Prefix::Eventually, operand) => ("G", operand),
        Expression::Prefix(Prefix::Always, operand) => ("F", operand),
        Expression::Prefix(_, operand) => ("X", operand),
        Expression::Infix(Infix::Until, _, right) => ("G", right),
        _ => return error.help(WANT),
    };
    let text = match resolved[operand].expression {
        Expression::Prefix(Prefix::Not, within) => bracketed(resolved, within),
        _ => format!("!{}", bracketed(resolved, operand)),
    };
    let bound = compact(bound);
    let help = format!("to say it of states that must come, write `{operator}{bound} {text}`");
    error.help(WANT).help(help)
}

/// The text of an expression, in brackets if it has an operator.
fn bracketed(resolved: &Resolved<'_>, id: ExpressionId) -> String {
    let text = resolved.quote(id);
    match &resolved[id].expression {
        Expression::Prefix(..) | Expression::Infix(..) => format!("({text})"),
        _ => text,
    }
}
