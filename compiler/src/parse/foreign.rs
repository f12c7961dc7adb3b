//! Operators of other logics, and the words and signs that other tools have for ours.

use crate::error::{Error, Kind};
use crate::grammar::{self, Rule};
use crate::source::Span;
use crate::token::{self, Tokens};

/// The error for the word or sign of another tool at `span` of a text.
pub(super) fn foreign(word: &str, text: &str, span: Span) -> Error {
    let ours = ours(word).unwrap_or_default();
    let message = match word {
        "“" | "”" | "„" | "«" | "»" | "‘" | "’" => {
            format!("`{word}` is not a quotation mark of this language: it is written `{ours}`")
        }
        _ => format!("`{word}` is not an operator of this language: it is written `{ours}`"),
    };
    advised(Error::new(Kind::Syntax, message, span), text)
}

/// The error for a word with a bound that elsewhere is an operator: `always[0,5] a`.
pub(super) fn foreign_bound(word: &str, text: &str, span: Span) -> Error {
    let ours = ours(word).unwrap_or_else(|| letter(word));
    let message = format!("`{word}` is not an operator of this language: it is written `{ours}`");
    advised(Error::new(Kind::Syntax, message, span), text)
}

/// Whether a word is an operator elsewhere and can have a bound there.
pub(super) fn is_bounded_word(word: &str) -> bool {
    let letter = letter(word);
    matches!(ours(word), Some("F" | "X" | "U"))
        || letter != word && matches!(letter, "G" | "R" | "W")
}

/// The error with the whole text in our spelling, if it is a formula then.
fn advised(error: Error, text: &str) -> Error {
    match rewritten(text) {
        Some(text) => error.help(format!("write `{text}`")),
        None => error,
    }
}

/// A formula with our operators in the place of those of other tools, if that is one and short
/// enough to quote.
fn rewritten(text: &str) -> Option<String> {
    /// More than a reader takes in.
    const MOST: usize = 100;
    let mut rewritten = String::new();
    let mut end = 0;
    let mut tokens = Tokens::new(text.get(..text.len().min(MOST + 1))?, 0).peekable();
    while let Some(token) = tokens.next() {
        rewritten.push_str(&text[end..token.start]);
        let word = &text[token.start..token.end];
        let is_bounded = tokens.peek().is_some_and(|next| text[next.start..].starts_with('['));
        let word = match ours(word) {
            Some(ours) => ours,
            None if is_bounded && is_bounded_word(word) => letter(word),
            None => word,
        };
        if rewritten.ends_with(token::goes_on) && word.starts_with(token::goes_on) {
            rewritten.push(' ');
        }
        rewritten.push_str(word);
        end = token.end;
    }
    // A colon in a bound is a comma here.
    let mut texts = [rewritten.replace(':', ","), rewritten].into_iter().rev();
    let rewritten = texts.find(|text| grammar::parse(Rule::formula, text).is_ok())?;
    (text.len() <= MOST).then(|| rewritten.trim().to_owned())
}

/// Our operator for a word or a sign that other tools, and papers, have for it.
pub(super) fn ours(word: &str) -> Option<&'static str> {
    Some(match word {
        "eventually" | "finally" | "sometime" | "⋄" | "♢" | "◊" => "F",
        "next" => "X",
        "until" => "U",
        "implies" | "==>" | "⟹" | "→" | "⟶" | "⊃" => "=>",
        "iff" | "<==>" | "⟺" | "↔" | "⟷" | "≡" => "<=>",
        "“" | "”" | "„" | "«" | "»" | "‘" | "’" => "\"",
        "/\\" => "&&",
        "\\/" => "||",
        _ => return None,
    })
}

/// The error for a call of an operator that other tools write as a word, `always(p)`, at `span` of a
/// text.
pub(crate) fn foreign_call(word: &str, text: &str, span: Span) -> Option<Error> {
    if is_unsupported(word) {
        return Some(unsupported(word, word, span));
    }
    ours(word).map(|_| foreign(word, text, span))
}

/// Those operators of other logics that stand between two operands.
pub(super) const BINARY: [&str; 4] = ["R", "W", "M", "S"];

/// The letter of an operator of other logics, for which some tools have a word.
pub(super) fn letter(word: &str) -> &str {
    match word {
        "[]" | "□" | "always" | "globally" | "henceforth" => "G",
        "V" | "release" | "releases" => "R",
        "unless" => "W",
        "WX" => "N",
        "yesterday" | "previous" => "Y",
        "once" => "O",
        "historically" => "H",
        "since" => "S",
        other => other,
    }
}

/// Whether `word` is an operator of another temporal logic.
pub(super) fn is_unsupported(word: &str) -> bool {
    unsupported_reason(word).is_some()
}

/// The meaning of the operator elsewhere, the reason why it is not here, and what to write instead.
fn unsupported_reason(word: &str) -> Option<(&'static str, &'static str, &'static str)> {
    const NEVER: &str =
        "no finite trajectory can ever establish it, for the next state may break it";
    const PAST: &str = "it looks back, and the automaton reads the trajectory forwards";
    const AVOID: &str = "to stay out of `b` until `a`, write `!b U a`";
    Some(match letter(word) {
        "G" => ("always", NEVER, AVOID),
        "N" => (
            "weak next",
            "it would hold at the end of a trajectory, and no prefix knows that it is the whole",
            "`X` is strong: it asks for a next state",
        ),
        "R" => (
            "release",
            NEVER,
            "if `b` must hold up to and including an `a` that comes, write `b U (a && b)`",
        ),
        "W" => ("weak until", NEVER, "if `b` must come, write `a U b`"),
        "M" => ("strong release", "it is `U` in other words", "for `a M b` write `b U (a && b)`"),
        "Y" => ("yesterday", PAST, "for `a` and `b` in consecutive states, write `F (a && X b)`"),
        "O" => ("once in the past", PAST, "for `a` before `b`, write `a T b`"),
        "H" => (
            "always in the past",
            PAST,
            "to keep `c` until a goal is reached, write `F goal ensuring c`",
        ),
        "S" => ("since", PAST, "turn it around: `a U b` looks forwards"),
        _ => return None,
    })
}

/// What to write instead of an operator with a bound, which a finite trajectory can establish.
fn bounded_rewrite(word: &str) -> Option<&'static str> {
    match letter(word) {
        "R" => Some("for `a R[0,5] b` write `G[0,5] b || b U[0,5] (a && b)`"),
        "W" => Some("for `a W[0,5] b` write `G[0,5] a || a U[0,5] b`"),
        "M" => Some("for `a M[0,5] b` write `b U[0,5] (a && b)`"),
        _ => None,
    }
}

/// The error for the operator `word` of another temporal logic, which the source has as `text`.
pub(crate) fn unsupported(word: &str, text: &str, span: Span) -> Error {
    let (meaning, mut reason, mut rewrite) = unsupported_reason(word).unwrap_or(("", "", ""));
    if let Some(bounded) = text.ends_with(']').then(|| bounded_rewrite(word)).flatten() {
        (reason, rewrite) = ("with a bound it is `U` and `G` in other words", bounded);
    }
    let message = format!("`{text}` (\"{meaning}\") is not an operator of this language: {reason}");
    Error::new(Kind::UnsupportedOperator, message, span).help(rewrite)
}
