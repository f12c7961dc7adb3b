//! Temporal operators that cannot stand where they do.
//!
//! The logic is co-safe: a finite trajectory must be able to establish a formula for good. A
//! negated temporal operator is a safety property, which none can. The errors here say so in terms
//! of the author's own formula, and offer the `U` that is usually meant.

use crate::ast::{Infix, Prefix};
use crate::error::{Error, Kind};
use crate::resolve::{Expression, ExpressionId, Resolved};

/// The error for the temporal operator `id` under the negation `by`.
pub(super) fn negated(resolved: &Resolved<'_>, id: ExpressionId, by: ExpressionId) -> Error {
    let (symbol, not, text) = (resolved.symbol(id), resolved.symbol(by), bracketed(resolved, id));
    let message = match resolved[by].expression {
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
        Expression::Prefix(Prefix::Next, _) => "\"at the next state\"",
        Expression::Infix(Infix::Until, ..) => "\"until\"",
        _ => "\"then\"",
    }
}

/// Adds the reason why the negation is outside the language, and what to write instead.
fn advice(resolved: &Resolved<'_>, id: ExpressionId, error: Error) -> Error {
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

/// The text of an expression, in brackets if it has an operator.
fn bracketed(resolved: &Resolved<'_>, id: ExpressionId) -> String {
    let text = resolved.quote(id);
    match &resolved[id].expression {
        Expression::Prefix(..) | Expression::Infix(..) => format!("({text})"),
        _ => text,
    }
}
