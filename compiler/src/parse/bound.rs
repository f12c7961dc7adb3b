//! Bounds that are written as elsewhere: in other brackets, with other signs, after words.

use super::foreign::{foreign_bound, is_bounded_word};
use super::message::Found;
use crate::error::{Error, Kind};
use crate::source::Span;
use crate::token::Tokens;

/// A bracket after an operator, or after a word that elsewhere is one.
struct Bracket<'t> {
    text: &'t str,
    /// The word before the bracket.
    operator: &'t str,
    operator_at: Span,
    open: Span,
    /// What ends it, if it is not still open.
    close: Option<Span>,
}

impl<'t> Bracket<'t> {
    /// The last bracket before byte `at`, in the text from byte `from` on, that is open there or
    /// closed just before.
    fn before(text: &'t str, from: usize, at: usize) -> Option<Self> {
        let (mut open, mut closed, mut last) = (Vec::new(), None, None);
        for token in Tokens::new(text, from).take_while(|token| token.start < at) {
            closed = None;
            match &text[token.start..token.end] {
                "(" | "[" | "{" => open.push((last, token)),
                ")" | "]" | "}" => closed = open.pop().map(|opened| (opened, token)),
                _ => {}
            }
            last = Some(token);
        }
        let ((operator, open), close) = match closed {
            Some((opened, close)) => (opened, Some(close)),
            None => (open.pop()?, None),
        };
        let operator_at: Span = operator?;
        let operator = &text[operator_at.start..operator_at.end];
        Some(Self { text, operator, operator_at, open, close })
    }

    /// Its two signs.
    fn signs(&self) -> (&'t str, &'t str) {
        let sign = |span: Span| &self.text[span.start..span.end];
        (sign(self.open), self.close.map_or("", sign))
    }

    /// The bound that is meant, as `1,5`: at most two numbers between the brackets, of which a
    /// round one leaves the end itself out.
    fn meant(&self, end: usize) -> Option<String> {
        let inside = self.text.get(self.open.end..end)?.trim();
        // Rust would read a sign as well.
        let digits = |end: &&str| end.starts_with(|c: char| c.is_ascii_digit());
        let ends = inside.split([',', ':']).map(str::trim);
        let numbers = ends.map(|end| Some(end).filter(digits)?.parse().ok());
        let numbers: Vec<u64> = numbers.collect::<Option<_>>()?;
        let (first, last) = self.signs();
        // Round brackets on both sides are more often just another spelling.
        let (later, earlier) = match (first, last) {
            ("(", ")") => (0, 0),
            (first, last) => (u64::from(first == "("), u64::from(last == ")")),
        };
        match numbers[..] {
            [most] if self.operator == "T" => Some(format!("<={most}")),
            [most] => Some(most.to_string()),
            [least, most] => Some(format!("{},{}", least + later, most.checked_sub(earlier)?)),
            _ => None,
        }
    }
}

/// A mistake in the brackets after an operator, or after a word for one, that are open at byte `at`
/// or end just before.
pub(super) fn elsewhere(text: &str, from: usize, at: usize) -> Option<Error> {
    let bracket = Bracket::before(text, from, at)?;
    let operator = bracket.operator;
    if bracket.signs().0 == "[" && is_bounded_word(operator) {
        return Some(foreign_bound(operator, text, bracket.operator_at));
    }
    // As in `F_[0,3]`, which comes from TeX.
    let name = operator.strip_suffix('_').unwrap_or(operator);
    if !takes_bound(name) || name == operator && bracket.signs() == ("[", "]") {
        return None;
    }
    // Still open, the bracket ends where the text has the next sign that may end it.
    let rest = text.get(bracket.open.end..).unwrap_or_default();
    let ends = |sign: char| matches!(sign, ')' | ']' | '}' | '\n');
    let close = bracket.close.unwrap_or_else(|| {
        let end = bracket.open.end + rest.find(ends).unwrap_or(rest.len());
        let length =
            text[end..].chars().next().filter(|sign| *sign != '\n').map_or(0, char::len_utf8);
        Span::new(end, end + length)
    });
    let closed = Bracket { close: Some(close), ..bracket };
    let meant = closed.meant(close.start)?;
    let message = match closed.signs() {
        _ if name != operator => format!("the bound of `{name}` follows it in square brackets"),
        ("[", "]") => format!("the ends of a bound of `{name}` stand apart by a comma"),
        ("[", ")") | ("(", "]") => format!("a bound of `{name}` includes both of its ends"),
        _ => format!("the bound of `{name}` stands in square brackets"),
    };
    let span = closed.open.to(close);
    Some(Error::new(Kind::Syntax, message, span).help(format!("write `{name}[{meant}]`")))
}

/// A mistake in the bound of an operator at the place where parsing stopped, or just before it.
pub(super) fn misplaced(found: &Found<'_>, from: usize) -> Option<Error> {
    let at = found.here_or_end().start;
    elsewhere(found.text, from, at)
        .or_else(|| open_bound(found, from))
        .or_else(|| bare(found, from))
}

/// A mistake in the square brackets after an operator.
fn open_bound(found: &Found<'_>, from: usize) -> Option<Error> {
    let bracket = Bracket::before(found.text, from, found.here_or_end().start)?;
    if bracket.signs() != ("[", "") || !takes_bound(bracket.operator) {
        return None;
    }
    let (operator, span) = (bracket.operator, bracket.open.to(found.here_or_end()));
    Some(if found.word(found.here) == "!" {
        let message =
            format!("`{operator}[!]` is strong elsewhere, and `{operator}` is always strong here");
        Error::new(Kind::Syntax, message, span)
            .help(format!("write `{operator}` without the brackets"))
    } else {
        let message = format!("this is not a bound of `{operator}`");
        Error::new(Kind::Syntax, message, span).help(format!(
            "a bound is written `{operator}[1,5]`, `{operator}[<=5]`, or with times `{operator}[0.1 s, 0.5 s]`"
        ))
    })
}

/// A bound without brackets: `F<=5 a`, `X^3 a`, `F_[0,3] a`.
fn bare(found: &Found<'_>, from: usize) -> Option<Error> {
    let mut last = [Span::default(); 4];
    let next = found.here.map_or(found.text.len(), |here| here.end);
    let words = Tokens::new(found.text, from).take_while(|token| token.start < next);
    let following = Tokens::new(found.text, next).next();
    for token in words.chain(following) {
        last = [last[1], last[2], last[3], token];
    }
    let word = |span: Span| &found.text[span.start..span.end];
    let is_number = |span: Span| word(span).starts_with(|c: char| c.is_ascii_digit());
    // The operator, its sign and the number may stand before the place, around it or behind it.
    let places = [
        (last[0], last[1], last[2]),
        (last[1], last[2], last[3]),
        (last[2], last[3], Span::default()),
    ];
    let stands = |message: String, help: String, span| {
        Some(Error::new(Kind::Syntax, message, span).help(help))
    };
    for (operator, sign, number) in places {
        let (name, mark) = (word(operator), word(sign));
        let subscript = name.strip_suffix('_').filter(|name| takes_bound(name));
        if takes_bound(name) && matches!(mark, "<=" | "≤" | "<" | "^" | "{" | "_") {
            let message = format!("the bound of `{name}` stands in square brackets");
            return match (is_number(number), mark) {
                (true, "^") => stands(message, format!("write `{name}[{}]`", word(number)), sign),
                (true, "<=" | "≤") => {
                    stands(message, format!("write `{name}[<={}]`", word(number)), sign)
                }
                _ => stands(message, format!("such as `{name}[<=5]` or `{name}[1,5]`"), sign),
            };
        }
        if let (Some(name), true) = (subscript, matches!(mark, "[" | "{")) {
            let message = format!("the bound of `{name}` follows it in square brackets");
            return stands(message, format!("such as `{name}[1,5]`"), operator);
        }
    }
    None
}

/// Whether `word` is an operator that can have a bound.
pub(super) fn takes_bound(word: &str) -> bool {
    matches!(word, "F" | "X" | "G" | "U" | "T" | "R" | "W" | "M" | "◇" | "<>" | "○" | "□" | "[]")
}
