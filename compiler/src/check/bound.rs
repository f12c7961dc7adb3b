//! Bounds: `[a,b]` as written to a [`Window`] of steps.
//!
//! An end is a written number, a constant of the file or a number that a `for` binds, so the window
//! is known when the source is compiled. An end in the unit of `step` is a time, and the instants
//! whose time lies in the interval count. Times are exact decimals and never doubles: with
//! `step 0.1 s`, `0.3 s` is three steps, though 0.3 / 0.1 is 2.9999999999999996 in doubles.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "step 0.1 s\nstate S { a: bool }\ntask soon = F[0.3 s, 0.5 s] a";
//! let module = check::file(&Source::new("s.tltl", text))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "F[3,5] a");
//! let errors = check::formula(&Source::new("formula", "F[3,1] a")).unwrap_err();
//! assert_eq!(errors.first().kind().name(), "bound");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::ops::RangeInclusive;

use crate::ast::{Bound, End, Infix, ItemKind, Node, Prefix};
use crate::error::{Error, Kind};
use crate::resolve::{Decimal, Expression, ExpressionId, Fraction, Name, Resolved};
use crate::source::Span;

/// The steps that a bounded operator looks ahead: the first and the last of them.
pub(super) type Window = RangeInclusive<u32>;

/// An end of a bound as a number of steps, which need not be whole.
struct Length {
    /// The steps, as a fraction.
    steps: Fraction,
    /// Whether it was written as a time.
    timed: bool,
    span: Span,
}

/// The window of the operator `id`, if it has a bound; or the mistake in it.
pub(super) fn window(resolved: &Resolved<'_>, id: ExpressionId) -> Result<Option<Window>, Error> {
    let entry = &resolved[id];
    let Some(bound) = &resolved.ast.entry(entry.node).bound else { return Ok(None) };
    let mut lengths = Vec::new();
    for (end, copy) in bound.ends.iter().zip(&entry.ends) {
        lengths.push(length(resolved, end, *copy)?);
    }
    match (&entry.expression, &lengths[..]) {
        (Expression::Prefix(Prefix::Next, _), [at]) if !bound.at_most => exact(resolved, at),
        (Expression::Prefix(Prefix::Next, _), _) => Err(misplaced(
            bound,
            "`X` looks at one instant, so its bound is one number",
            "write `X[2]`, or `F[1,2]` for one of several instants",
        )),
        (Expression::Infix(Infix::Then, ..), [_]) if !bound.at_most => {
            let text = resolved.ast.source().slice(lengths[0].span);
            Err(misplaced(
                bound,
                "the bound of `T` says from where it counts",
                &format!("for at most {text} steps later write `T[<={text}]`"),
            ))
        }
        (expression, lengths) => {
            let then = matches!(expression, Expression::Infix(Infix::Then, ..));
            interval(resolved, bound, lengths, then)
        }
    }
    .map(Some)
}

/// The one instant of the bound of `X`.
fn exact(resolved: &Resolved<'_>, at: &Length) -> Result<Window, Error> {
    let (below, above) = at.steps.around();
    if below != above {
        let text = resolved.ast.source().slice(at.span);
        let message = format!("`{text}` lies between two instants");
        return Err(Error::new(Kind::Bound, message, at.span)
            .help(format!("it is more than {below} steps and less than {above}")));
    }
    let at = small(below, at.span)?;
    Ok(at..=at)
}

/// The instants of an interval, of which there must be one.
fn interval(
    resolved: &Resolved<'_>,
    bound: &Bound,
    lengths: &[Length],
    then: bool,
) -> Result<Window, Error> {
    let (first, last) = match lengths {
        [last] => (u128::from(then), last),
        [first, last, ..] => {
            alike(resolved, first, last)?;
            (first.steps.around().1, last)
        }
        [] => return Ok(0..=0),
    };
    if then && first == 0 {
        return Err(misplaced(
            bound,
            "`T` asks for a later instant, so its bound begins at 1 step or more",
            "for the same instant too, write `F (a && F[0,3] b)`",
        ));
    }
    let end = last.steps.around().0;
    if first > end {
        return Err(empty(resolved, bound, lengths, first, end));
    }
    Ok(small(first, bound.ends[0].span)?..=small(end, last.span)?)
}

/// Refuses an interval from steps to a time, or from a time to steps: `[0.5, 2 s]` hardly means
/// so. Nothing is nothing in both.
fn alike(resolved: &Resolved<'_>, first: &Length, last: &Length) -> Result<(), Error> {
    let plain = match (first.timed, last.timed) {
        (true, false) => last,
        (false, true) => first,
        _ => return Ok(()),
    };
    if plain.steps.0 == 0 {
        return Ok(());
    }
    let text = resolved.ast.source().slice(plain.span);
    let message = format!("`{text}` counts steps, and the other end of this bound is a time");
    Err(Error::new(Kind::Syntax, message, plain.span).help("write the unit at both ends"))
}

/// The error for an interval without an instant.
fn empty(
    resolved: &Resolved<'_>,
    bound: &Bound,
    lengths: &[Length],
    first: u128,
    last: u128,
) -> Error {
    let text = resolved.ast.source().slice(bound.span);
    let help = if lengths.iter().any(|length| length.timed) {
        format!(
            "the first instant after its beginning is {first} steps from now, the last one before its end {last}"
        )
    } else {
        format!("{first} is greater than {last}: the smaller number stands first")
    };
    let message = format!("the bound `{text}` is empty: no instant lies in it");
    let error = Error::new(Kind::Bound, message, bound.span).help(help);
    let named = bound.ends.iter().any(|end| matches!(resolved.ast.node(end.node), Node::Name));
    if !named {
        return error;
    }
    error
        .help("if `for` gives the number, let its range begin later, or leave it out: `i > 0 => …`")
}

/// The error for a bound that this operator cannot have.
fn misplaced(bound: &Bound, message: &str, help: &str) -> Error {
    Error::new(Kind::Bound, message, bound.span).help(help)
}

/// A number of steps that an automaton can count.
fn small(steps: u128, span: Span) -> Result<u32, Error> {
    u32::try_from(steps).map_err(|_| {
        let message =
            format!("an automaton that counts {steps} steps has more states than any budget");
        Error::new(Kind::Budget, message, span)
    })
}

/// One end of a bound in steps.
fn length(resolved: &Resolved<'_>, end: &End, copy: ExpressionId) -> Result<Length, Error> {
    let (source, scope) = (resolved.ast.source(), &resolved.scope);
    let written = source.slice(end.span);
    let (text, unit) = number(resolved, end, copy)?;
    let value = Decimal::read(text.trim_start_matches('-')).ok_or_else(|| too_long(end))?;
    if !value.is_zero() && end.negative != text.starts_with('-') {
        let message =
            format!("`{written}` lies in the past, and a bound counts the steps from now on");
        return Err(Error::new(Kind::Bound, message, end.span)
            .help("formulas look ahead: for `a` before `b`, write `a T b`"));
    }
    let Some(unit) = unit else {
        let steps = value.over(Decimal::ONE).ok_or_else(|| too_long(end))?;
        if steps.0 % steps.1 != 0 {
            return Err(not_whole(resolved, end));
        }
        return Ok(Length { steps, timed: false, span: end.span });
    };
    let Some(step) = &scope.step else {
        let message = format!("`{written}` is a time, and nothing says how long a step lasts");
        return Err(Error::new(Kind::Syntax, message, end.span)
            .help(format!("count steps, or declare the step in a task file: `step 0.1 {unit}`")));
    };
    let of = source.slice(step.unit);
    if unit != of {
        let message = format!("`{written}` is in {unit}, and a step in {of}");
        return Err(Error::new(Kind::Unit, message, end.span)
            .help("units are never converted: write the bound in the unit of `step`"));
    }
    let steps = value.over(step.amount).ok_or_else(|| too_long(end))?;
    Ok(Length { steps, timed: true, span: end.span })
}

/// The number at an end as text, with its unit. A number that is written somewhere stays as it is
/// written.
fn number(
    resolved: &Resolved<'_>,
    end: &End,
    copy: ExpressionId,
) -> Result<(String, Option<String>), Error> {
    let (ast, scope) = (resolved.ast, &resolved.scope);
    let literal = |node| match ast.node(node) {
        Node::Number(_) => {
            Some(ast.text(node).to_owned()).filter(|text| Decimal::read(text).is_some())
        }
        _ => None,
    };
    let entry = &resolved[copy];
    let (text, unit) = match &entry.expression {
        Expression::Name(Name::Unknown(error)) => return Err((**error).clone()),
        Expression::Name(Name::Item(item, _)) => {
            let root = match resolved.item(*item).kind {
                ItemKind::Constant(_, root) => literal(root),
                _ => None,
            };
            let unit = scope.constant_unit(*item).map(|(unit, _)| scope.units.text(unit));
            (root, unit)
        }
        _ => (literal(entry.node), end.unit.map(|unit| ast.source().slice(unit).to_owned())),
    };
    let text = text.or_else(|| entry.value.map(|value| value.to_string()));
    text.map(|text| (text, unit)).ok_or_else(|| {
        let message =
            format!("`{}` is not known when the source is compiled", ast.source().slice(end.span));
        Error::new(Kind::Syntax, message, end.span).help(ENDS)
    })
}

/// What an end of a bound can be.
const ENDS: &str =
    "an end of a bound is a written number, a constant of the file, or a number that `for` binds";

/// The error for an end that is not a whole number of steps.
fn not_whole(resolved: &Resolved<'_>, end: &End) -> Error {
    let text = resolved.ast.source().slice(end.span);
    let message = format!("`{text}` is not a whole number, and a bound counts steps");
    let error = Error::new(Kind::Syntax, message, end.span);
    match &resolved.scope.step {
        Some(step) if text.starts_with(|c: char| c.is_ascii_digit()) => {
            let unit = resolved.ast.source().slice(step.unit);
            error.help(format!("for a time, write the unit: `{text} {unit}`"))
        }
        _ => error.help(ENDS),
    }
}

/// The error for a number that is too large or too long to calculate with.
fn too_long(end: &End) -> Error {
    Error::new(Kind::Number, "this number is too large, or has too many digits", end.span)
}
