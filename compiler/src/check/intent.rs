//! Temporal operators that cannot stand where they do, or that hardly mean what they seem to say.
//!
//! The logic is co-safe: a finite trajectory must be able to establish a formula for good. A
//! negated temporal operator is a safety property, which none can. The errors here say so in terms
//! of the author's own formula, and offer the `U` that is usually meant. The warnings are about the
//! two formulas that authors of sequences get wrong: `F a T b` and `(a T b) T c` order less than
//! they seem to.

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

/// A warning if the operator `id` orders less than its author seems to think.
pub(super) fn warning(resolved: &Resolved<'_>, id: ExpressionId) -> Option<Error> {
    if let Expression::Infix(Infix::Until, left, right) = resolved[id].expression {
        return idle_until(resolved, left, right);
    }
    let Expression::Infix(Infix::Then, left, right) = resolved[id].expression else { return None };
    let right = resolved.quote(right);
    match resolved[left].expression {
        Expression::Prefix(Prefix::Eventually, a) if !resolved.is_bracketed(left) => {
            let a = resolved.quote(a);
            let f = resolved.symbol(left);
            let message = format!(
                "`{f} {a} T {right}` reads `({f} {a}) T {right}`, which does not order {a} before {right}"
            );
            Some(Error::new(Kind::Intent, message, resolved.span(left))
                .warning()
                .related(resolved.operator(id), "\"then\" waits only for \"eventually\" to be certain")
                .help(format!("for {a} and later {right}, write `{a} T {right}`; to keep this meaning, write the brackets")))
        }
        Expression::Infix(Infix::Then, a, b) => {
            let (a, b) = (resolved.quote(a), resolved.quote(b));
            let message = format!("`({a} T {b}) T {right}` does not order {b} before {right}");
            Some(
                Error::new(Kind::Intent, message, resolved[left].outer)
                    .warning()
                    .label(format!("this holds from the start, before {b} has come"))
                    .help(format!("for the three in this order, write `{a} T ({b} T {right})`")),
            )
        }
        _ => None,
    }
}

/// A warning for `a U F b`, which says no more than `F b`.
fn idle_until(resolved: &Resolved<'_>, left: ExpressionId, right: ExpressionId) -> Option<Error> {
    let goal = match resolved[right].expression {
        Expression::Prefix(Prefix::Eventually, goal) => goal,
        Expression::Infix(Infix::Then, goal, _) => goal,
        _ => return None,
    };
    let (kept, text) = (resolved.quote(left), resolved.quote(right));
    let operand = |id| match &resolved[id].expression {
        Expression::Prefix(..) => resolved.quote(id),
        _ => bracketed(resolved, id),
    };
    let (keep, goal) = (operand(left), operand(goal));
    let message = format!(
        "`{kept}` does not matter: `{text}` already looks ahead, so `U` need not wait for it"
    );
    Some(
        Error::new(Kind::Vacuous, message, resolved[left].outer)
            .warning()
            .related(
                resolved.operator(right),
                "this is asked at the first state, not when it comes true",
            )
            .help(format!("to keep to {keep} until {goal} comes, write `{keep} U {goal}`")),
    )
}
