//! Syntax mistakes as sentences: what is missing or superfluous, in the author's own words.
//!
//! The grammar reports a byte and a list of rules that could have come next. Neither means anything to an
//! author, so this module looks at the words around the place instead: the word before, the word at
//! the place, the word after. Common mistakes (an operator of another logic, `=` for `==`, `^` for
//! `pow`) have a sentence each; the rest is "expected …, found …".
//!
//! ```
//! use tltl_compiler::{parse, source::Source};
//!
//! let message = |formula: &str| {
//!     let errors = parse::formula(&Source::new("formula", formula)).unwrap_err();
//!     errors.first().message().to_owned()
//! };
//! assert!(message("F (a").contains('('), "{}", message("F (a"));
//! assert_ne!(message("a = b"), message("a b"), "a common slip has a sentence of its own");
//! ```

use super::bound;
use super::foreign::{BINARY, foreign, is_unsupported, letter, ours, unsupported};
use crate::error::{Error, Kind};
use crate::grammar::{Rule, Stopped};
use crate::source::{Source, Span};
use crate::token::{self, Tokens};

/// The words around the place at which parsing stopped.
pub(super) struct Found<'a> {
    /// The whole source.
    pub(super) text: &'a str,
    /// The word before the place.
    before: Option<Span>,
    /// The word at the place.
    pub(super) here: Option<Span>,
    /// The end of the word before.
    end: usize,
}

impl<'a> Found<'a> {
    /// The words around byte `at`, in the text from byte `from` on.
    fn new(text: &'a str, from: usize, at: usize) -> Self {
        let mut before = None;
        let mut here = None;
        for token in Tokens::new(text, from) {
            if token.end > at {
                here = Some(token);
                break;
            }
            before = Some(token);
        }
        let end = before.map_or(from, |token| token.end);
        Self { text, before, here, end }
    }

    /// The text of a token; empty if there is none.
    pub(super) fn word(&self, token: Option<Span>) -> &'a str {
        token.map_or("", |token| &self.text[token.start..token.end])
    }

    /// The place at which something is missing: after the word before.
    fn gap(&self) -> Span {
        self.before.or(self.here).unwrap_or(Span::new(self.end, self.end))
    }

    /// The word at the place, or the end of the text.
    pub(super) fn here_or_end(&self) -> Span {
        self.here.unwrap_or(Span::new(self.end, self.end))
    }

    /// Whether the parsed item ends at the place.
    fn at_end(&self) -> bool {
        matches!(self.word(self.here), "" | ";" | "///" | "//!")
            || token::starts_with_item(&self.text[self.here_or_end().start..])
    }
}

/// The mistake at which reading stopped, in a text parsed from byte `from` on.
pub(super) fn sentence(source: &Source, from: usize, stopped: &Stopped) -> Error {
    let found = Found::new(source.text(), from, from + stopped.at);
    let expected = &stopped.expected[..];
    let known = broken_step(&found, from, expected)
        .or_else(|| not_read(source, from, from + stopped.at))
        .or_else(|| bound::misplaced(&found, from))
        .or_else(|| unsupported_here(&found))
        .or_else(|| foreign_here(&found));
    if let Some(error) = known {
        return error;
    }
    if expected.contains(&Rule::truth) || expected.contains(&Rule::expression) {
        operand_missing(&found)
    } else if expected.contains(&Rule::until) {
        operator_missing(&found)
    } else {
        other(&found, expected)
    }
}

/// A mistake in `step 0.1 s`.
fn broken_step(found: &Found<'_>, from: usize, expected: &[Rule]) -> Option<Error> {
    let mut words = Tokens::new(found.text, from).map(|token| &found.text[token.start..token.end]);
    let is_step = words.next() == Some("step");
    let has_number = words.next()?.starts_with(|c: char| c.is_ascii_digit());
    let message = match found.word(found.here) {
        _ if !is_step || !has_number && !expected.contains(&Rule::amount) => return None,
        "/" | "*" | "^" | "×" | "÷" => "a step lasts a time, whose unit is one name, such as `s`",
        _ => "`step` takes a number and a unit, such as `step 0.1 s`",
    };
    Some(Error::new(Kind::Syntax, message, found.here_or_end()))
}

/// A comment without an end, or a blank that is none here, where parsing stopped.
fn not_read(source: &Source, from: usize, at: usize) -> Option<Error> {
    let text = source.text();
    if let Some(start) = token::open_comment(text, from) {
        let message = "this comment is never closed";
        return Some(
            Error::new(Kind::Syntax, message, Span::new(start, start + 2))
                .help("it ends where `*/` stands"),
        );
    }
    let blank =
        text[at..].chars().next().filter(|c| c.is_whitespace() && !" \t\r\n".contains(*c))?;
    let message = format!("this blank is not an ordinary one, but U+{:04X}", u32::from(blank));
    Some(
        Error::new(Kind::Syntax, message, Span::new(at, at + blank.len_utf8()))
            .help("it came with text from elsewhere: write an ordinary blank"),
    )
}

/// An operator of another logic at the place where parsing stopped, or just before it.
fn unsupported_here(found: &Found<'_>) -> Option<Error> {
    let (before, here) = (found.word(found.before), found.word(found.here));
    let is_binary = |word| BINARY.contains(&letter(word));
    if is_unsupported(here) && is_binary(here) && !found.at_end() {
        return found.here.map(|span| unsupported(here, here, span));
    }
    let before_is = is_unsupported(before) && !is_binary(before);
    let goes_on = here.starts_with(token::is_word_start) || matches!(here, "!" | "(" | "◇" | "○");
    let operator = matches!(here, "U" | "T" | "and" | "or");
    (before_is && goes_on && !operator && !found.at_end())
        .then(|| found.before.map(|span| unsupported(before, before, span)))
        .flatten()
}

/// A word or a sign of another tool at the place where parsing stopped, or just before it.
fn foreign_here(found: &Found<'_>) -> Option<Error> {
    let goes_on = !found.at_end() && ours(found.word(found.before)).is_some();
    let here = found.here.filter(|here| ours(&found.text[here.start..here.end]).is_some());
    let span = here.or(found.before.filter(|_| goes_on))?;
    let word = &found.text[span.start..span.end];
    Some(foreign(word, found.text, span))
}

/// The error where an operand should start.
fn operand_missing(found: &Found<'_>) -> Error {
    let (before, here) = (found.word(found.before), found.word(found.here));
    let syntax = |message: String, span| Error::new(Kind::Syntax, message, span);
    match (before, here) {
        ("", "") => syntax("there is no formula here".into(), found.here_or_end())
            .help("write one, such as `F a`: \"eventually a\""),
        (_, "~") => syntax("negation is written `!`, not `~`".into(), found.here_or_end()),
        (_, "=") if before == "=" => equals(found),
        ("(" | "[", ")" | "]") => syntax(
            "nothing stands between the brackets".into(),
            found.gap().to(found.here_or_end()),
        ),
        (",", ")") => syntax("an argument is missing after the comma".into(), found.gap()),
        (_, "<>") => {
            syntax("`<>` is \"eventually\" and stands before a formula".into(), found.here_or_end())
                .help("to say \"different\", write `!=`")
        }
        (_, "{" | "\"") => syntax(format!("`{here}` cannot start a formula"), found.here_or_end()),
        _ if is_infix(here) && (before.is_empty() || matches!(before, "(" | "=" | "|")) => {
            let error = syntax(format!("`{here}` has nothing on its left"), found.here_or_end());
            rust_in_braces(word_as_name(error, here), here)
        }
        _ if is_infix(before) || is_prefix(before) => after_operator(found),
        ("=", _) => {
            syntax("nothing follows `=`".into(), found.gap()).label("a formula should stand here")
        }
        _ if found.at_end() => syntax(format!("nothing follows `{before}`"), found.gap())
            .label("an operand is missing after this"),
        _ => rust_in_braces(
            syntax(format!("`{here}` cannot stand here"), found.here_or_end())
                .help("a name, a number, a comparison, `!`, `F`, `X` or `(` can"),
            here,
        ),
    }
}

/// Nothing that can be an operand follows the operator before.
fn after_operator(found: &Found<'_>) -> Error {
    let (before, here) = (found.word(found.before), found.word(found.here));
    let side = if is_prefix(before) { "after it" } else { "on its right" };
    let error = Error::new(Kind::Syntax, format!("`{before}` has nothing {side}"), found.gap());
    let error = if found.at_end() || matches!(here, ")" | "]") {
        error.label("an operand is missing after this")
    } else {
        error.related(found.here_or_end(), format!("`{here}` cannot be its operand"))
    };
    if is_infix(here) { word_as_name(error, here) } else { word_as_name(error, before) }
}

/// Adds, for a symbol that Rust has before an operand, how to write Rust.
fn rust_in_braces(error: Error, symbol: &str) -> Error {
    if matches!(symbol, "&" | "*" | "|") {
        return error.help("inside the macro, a Rust expression stands in braces: `{ f(&s) }`");
    }
    error
}

/// Adds, for an operator that is a word, that it cannot be a name.
fn word_as_name(error: Error, word: &str) -> Error {
    match token::keyword(word) {
        Some(meaning) => {
            error.help(format!("`{word}` means {meaning} and cannot be the name of a proposition"))
        }
        None => error,
    }
}

/// The error where an operator should stand.
fn operator_missing(found: &Found<'_>) -> Error {
    let (before, here) = (found.word(found.before), found.word(found.here));
    let syntax = |message: String| Error::new(Kind::Syntax, message, found.here_or_end());
    match here {
        "=" => equals(found),
        "=<" => syntax("\"at most\" is written `<=`, not `=<`".into()),
        "^" | "xor" | "⊕" => syntax(format!("`{here}` is not an operator"))
            .help("for powers, write `pow(x, 2)`")
            .help("for one of two conditions and not both, write `!(p <=> q)`, or `p != q` for truth values of the state"),
        "**" => syntax(format!("`{here}` is not an operator")).help("for powers, write `pow(x, 2)`"),
        "%" => syntax("`%` is not an operator".into()),
        "!" | "F" | "X" | "¬" | "◇" | "○" | "not" => {
            between(found).help(format!("`{here}` stands before a formula, not after one"))
        }
        "" => syntax(format!("the source ends after `{before}`")),
        ":" | "?" | "." | "$" | "@" | "#" | "'" | "\\" | "`" => {
            syntax(format!("`{here}` is not part of the language"))
        }
        _ => between(found),
    }
}

/// The error for two operands with no operator between them.
fn between(found: &Found<'_>) -> Error {
    let (before, here) = (found.word(found.before), found.word(found.here));
    let message = format!("an operator is missing between `{before}` and `{here}`");
    Error::new(Kind::Syntax, message, found.here_or_end())
        .related(found.gap(), "this is complete")
        .help(match apart(before) {
            Some(operators) => format!("for the operators, write `{operators} {here}`"),
            None => "such as `&&`, `||`, `=>`, `U` (until) or `T` (then)".to_owned(),
        })
}

/// Operators that are written without a blank between them, with one: `FX` is a name.
pub(crate) fn apart(word: &str) -> Option<String> {
    let operators: Vec<String> = word.chars().map(String::from).collect();
    let glued =
        operators.len() > 1 && operators.iter().all(|one| matches!(&one[..], "F" | "X" | "G"));
    glued.then(|| operators.join(" "))
}

/// The error for `=` in an expression.
fn equals(found: &Found<'_>) -> Error {
    Error::new(
        Kind::Syntax,
        "`=` gives a name its meaning; to compare, write `==`",
        found.here_or_end(),
    )
}

/// The error anywhere else: an item that is not well-formed.
fn other(found: &Found<'_>, expected: &[Rule]) -> Error {
    let here = found.word(found.here);
    if here == ":" && expected.contains(&Rule::fields) {
        let message = "the Rust type of the state needs a `;` after it";
        return Error::new(Kind::Syntax, message, found.here_or_end());
    }
    if matches!(found.word(found.before), "{" | "," | "(") && here.starts_with(token::is_word_start)
    {
        let message = format!("the field `{here}` needs a type");
        return Error::new(Kind::Syntax, message, found.here_or_end())
            .help(format!("such as `{here}: f64`"));
    }
    if found.word(found.before) == "in" && matches!(here, "-" | "−") {
        let message = "the numbers of a range are not negative";
        return Error::new(Kind::Syntax, message, found.here_or_end())
            .help("count from 0, and subtract where the number is used: `i - 2`");
    }
    if let Some(error) = broken_unit(found, expected) {
        return error;
    }
    let mut names: Vec<_> = expected.iter().filter_map(|rule| rule_name(*rule)).collect();
    names.dedup();
    let expected = match names.split_last() {
        None => "an item such as `task go = F done`".to_owned(),
        Some((last, [])) => (*last).to_owned(),
        Some((last, rest)) => format!("{} or {last}", rest.join(", ")),
    };
    let found_text = if here.is_empty() { "the end".to_owned() } else { format!("`{here}`") };
    let message = format!("expected {expected}, found {found_text}");
    Error::new(Kind::Syntax, message, found.here_or_end())
}

/// The error for a unit without its `in`, or with a power that is not an integer.
fn broken_unit(found: &Found<'_>, expected: &[Rule]) -> Option<Error> {
    let here = found.word(found.here);
    let error = |message: String| Error::new(Kind::Syntax, message, found.here_or_end());
    if here.starts_with(token::is_word_start)
        && expected.contains(&Rule::word_in)
        && expected.contains(&Rule::array_close)
    {
        return Some(error(format!("`in` is missing before the unit `{here}`")));
    }
    let power = found.word(found.before).starts_with(|c: char| c.is_ascii_digit());
    (here == "." && power && expected.contains(&Rule::times))
        .then(|| error("the power of a unit is a whole number".to_owned()))
}

/// What an author calls a rule of the grammar; `None` for rules that messages do not list.
fn rule_name(rule: Rule) -> Option<&'static str> {
    Some(match rule {
        Rule::word_state => "`state`",
        Rule::word_struct => "`struct`",
        Rule::word_enum => "`enum`",
        Rule::word_const => "`const`",
        Rule::word_predicate => "`predicate`",
        Rule::word_task => "`task`",
        Rule::identifier => "a name",
        Rule::fields => "`{`",
        Rule::field_declaration => "a field such as `x: f64`",
        Rule::field_type => "a type such as `f64`",
        Rule::header_type | Rule::host_type => "a type",
        Rule::array_close => "`; 6]`",
        Rule::digits | Rule::end => "a number",
        Rule::unit | Rule::unit_power => "a unit such as `m` or `m/s`",
        Rule::word_in => "`in`",
        Rule::times => "`*`",
        Rule::divide => "`/`",
        Rule::parameters => "`(`",
        Rule::expression => "a formula",
        _ => return None,
    })
}

/// Whether `word` is an operator that stands before its operand.
fn is_prefix(word: &str) -> bool {
    matches!(word, "!" | "F" | "X" | "not" | "¬" | "◇" | "○" | "<>")
}

/// Whether `word` is an operator that stands between two operands.
fn is_infix(word: &str) -> bool {
    const WORDS: [&str; 31] = [
        "=>", "->", "⇒", "||", "|", "∨", "or", "&&", "&", "∧", "and", "U", "T", "==", "!=", "≠",
        "<=", "≤", ">=", "≥", "<", ">", "+", "-", "−", "*", "×", "/", "÷", "<=>", "<->",
    ];
    WORDS.contains(&word)
}
