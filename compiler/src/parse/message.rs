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

use crate::error::{Error, Kind};
use crate::grammar::{self, Rule, Stopped};
use crate::source::{Source, Span};
use crate::token::{self, Tokens};

/// The words around the place at which parsing stopped.
struct Found<'a> {
    /// The whole source.
    text: &'a str,
    /// The word before the place.
    before: Option<Span>,
    /// The word at the place.
    here: Option<Span>,
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
    fn word(&self, token: Option<Span>) -> &'a str {
        token.map_or("", |token| &self.text[token.start..token.end])
    }

    /// The place at which something is missing: after the word before.
    fn gap(&self) -> Span {
        self.before.or(self.here).unwrap_or(Span::new(self.end, self.end))
    }

    /// The word at the place, or the end of the text.
    fn here_or_end(&self) -> Span {
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
    if let Some(error) = broken_step(&found, from) {
        return error;
    }
    if let Some(error) = open_bound(&found, from).or_else(|| unsupported_here(&found)) {
        return error;
    }
    if let Some(error) = foreign_here(&found) {
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

/// A mistake in `step 0.1 s`, after its number.
fn broken_step(found: &Found<'_>, from: usize) -> Option<Error> {
    let mut words = Tokens::new(found.text, from).map(|token| &found.text[token.start..token.end]);
    let is_step =
        words.next() == Some("step") && words.next()?.starts_with(|c: char| c.is_ascii_digit());
    is_step.then(|| {
        let message = "`step` takes a number and a unit, such as `step 0.1 s`";
        Error::new(Kind::Syntax, message, found.here_or_end())
    })
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

/// The error for the word or sign of another tool at `span` of a text.
fn foreign(word: &str, text: &str, span: Span) -> Error {
    let ours = ours(word).unwrap_or_default();
    let message = format!("`{word}` is not an operator of this language: it is written `{ours}`");
    let error = Error::new(Kind::Syntax, message, span);
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
    let wordy = |c: char| c.is_alphanumeric() || c == '_';
    for token in Tokens::new(text.get(..text.len().min(MOST + 1))?, 0) {
        rewritten.push_str(&text[end..token.start]);
        let word = &text[token.start..token.end];
        let word = ours(word).unwrap_or(word);
        if rewritten.ends_with(wordy) && word.starts_with(wordy) {
            rewritten.push(' ');
        }
        rewritten.push_str(word);
        end = token.end;
    }
    let is_one = text.len() <= MOST && grammar::parse(Rule::formula, &rewritten).is_ok();
    is_one.then(|| rewritten.trim().to_owned())
}

/// Our operator for a word or a sign that other tools, and papers, have for it.
fn ours(word: &str) -> Option<&'static str> {
    Some(match word {
        "eventually" | "finally" | "sometime" | "⋄" | "♢" | "◊" => "F",
        "next" => "X",
        "until" => "U",
        "implies" | "==>" | "⟹" => "=>",
        "iff" | "<==>" | "⟺" => "<=>",
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

/// A mistake in the brackets after an operator, which hold its bound.
fn open_bound(found: &Found<'_>, from: usize) -> Option<Error> {
    let at = found.here_or_end().start;
    let (mut before, mut open) = ("", None);
    for token in Tokens::new(found.text, from).take_while(|token| token.start < at) {
        let word = &found.text[token.start..token.end];
        match word {
            "[" if takes_bound(before) => open = Some((before, token)),
            "]" => open = None,
            _ => {}
        }
        before = word;
    }
    let (operator, bracket) = open?;
    let span = bracket.to(found.here_or_end());
    let here = found.word(found.here);
    Some(if here == "!" {
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

/// Whether `word` is an operator that can have a bound.
fn takes_bound(word: &str) -> bool {
    matches!(word, "F" | "X" | "G" | "U" | "T" | "R" | "W" | "M" | "◇" | "<>" | "○" | "□" | "[]")
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
        _ if takes_bound(before) && matches!(here, "<=" | "≤" | "<" | "{") => {
            syntax(format!("the bound of `{before}` stands in brackets"), found.here_or_end())
                .help(format!("such as `{before}[<=5]` or `{before}[1,5]`"))
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
    if let Some(error) = braced_bound(found) {
        return error;
    }
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

/// The error for `F{1,5} a`: other tools write bounds in braces.
fn braced_bound(found: &Found<'_>) -> Option<Error> {
    let end = found.before.filter(|_| found.word(found.before) == "}")?.start;
    let start = found.text[..end].rfind('{')?;
    let bound = found.text[start + 1..end].trim();
    let is_bound = bound.chars().all(|c| c.is_ascii_digit() || ", ".contains(c));
    let operator = Tokens::new(found.text, 0).take_while(|token| token.end <= start).last()?;
    let operator = &found.text[operator.start..operator.end];
    (is_bound && takes_bound(operator)).then(|| {
        let at_most = if operator == "T" && !bound.contains(',') { "<=" } else { "" };
        let message = format!("the bound of `{operator}` stands in square brackets");
        Error::new(Kind::Syntax, message, Span::new(start, end + 1))
            .help(format!("write `{operator}[{at_most}{bound}]`"))
    })
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

/// Those operators of other logics that stand between two operands.
const BINARY: [&str; 4] = ["R", "W", "M", "S"];

/// The letter of an operator of other logics, for which some tools have a word.
fn letter(word: &str) -> &str {
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
