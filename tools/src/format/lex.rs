//! Splits a task file into tokens for layout: comments are tokens too, and Rust code is one token.
//!
//! The compiler's grammar is not used, since it drops comments and accepts only correct files. This
//! lexer accepts any text and loses nothing but blanks. What a character means depends on the
//! tokens before it (`*` in a unit, `{` after `state Name`, `[` after `F`), and only on these: it
//! never looks back at the text.

/// The kind of a token, as far as layout depends on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A name, a keyword or a number.
    Word,
    /// An operator or a bracket.
    Symbol,
    /// An operator written as a word. Some of the words are names elsewhere: `G`, `R`, `ensuring`.
    Operator,
    /// A bracket around the bound of an operator: `F[0,3]`.
    Bound,
    /// A part of a unit, which stands without blanks: `kg*m^2`.
    Unit,
    /// A comment.
    Comment,
    /// A doc comment, which belongs to the item after it.
    Doc,
    /// A Rust expression in braces, or a Rust type. Its inside is kept as it is.
    Rust,
}

/// A token and the number of line breaks before it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) kind: Kind,
    pub(super) newlines: usize,
}

impl Token<'_> {
    /// Whether the token ends an operand: a `-` after it is a difference, and a bracket after it a
    /// call or an index.
    pub(super) fn ends_operand(&self) -> bool {
        match self.kind {
            Kind::Word | Kind::Rust | Kind::Unit => true,
            Kind::Symbol => matches!(self.text, ")" | "]" | "⊤" | "⊥"),
            Kind::Comment | Kind::Doc | Kind::Operator | Kind::Bound => false,
        }
    }

    /// Whether the token is an operator that can have a bound.
    fn takes_bound(&self) -> bool {
        match self.kind {
            Kind::Operator => matches!(self.text, "F" | "X" | "U" | "T" | "G" | "R" | "W" | "M"),
            Kind::Symbol => matches!(self.text, "◇" | "<>" | "○" | "□" | "[]"),
            _ => false,
        }
    }
}

/// The symbols of several characters, a longer one before its beginnings.
const SYMBOLS: [&str; 15] =
    ["<=>", "<->", "..=", "..", "=>", "->", "&&", "||", "==", "!=", "<=", ">=", "<>", "[]", "::"];

/// The tokens of a task file, in order; every character that is not blank is in one of them.
pub(super) fn lex(text: &str) -> Vec<Token<'_>> {
    let mut tokens: Vec<Token<'_>> = Vec::new();
    let mut rest = text;
    loop {
        let trimmed = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
        let newlines = rest[..rest.len() - trimmed.len()].matches('\n').count();
        rest = trimmed;
        let Some(first) = rest.chars().next() else { return tokens };
        let (kind, length) = one(rest, first, &tokens);
        let token = rest[..length].trim_end();
        tokens.push(Token { text: token, kind, newlines });
        rest = &rest[token.len()..];
    }
}

/// The kind and the length of the token that `rest` starts with.
fn one(rest: &str, first: char, before: &[Token<'_>]) -> (Kind, usize) {
    // Asked only where it counts: a file may be one long line.
    let line = || rest.find('\n').unwrap_or(rest.len());
    let doc = rest.starts_with("///") && !rest.starts_with("////") || rest.starts_with("//!");
    if doc {
        (Kind::Doc, line())
    } else if rest.starts_with("//") {
        (Kind::Comment, line())
    } else if let Some(comment) = rest.strip_prefix("/*") {
        (Kind::Comment, comment.find("*/").map_or(rest.len(), |end| end + 4))
    } else if UNIT.contains(first) && unit_goes_on(first, before) {
        (Kind::Unit, first.len_utf8())
    } else if host_type_follows(before) {
        (Kind::Rust, rest.find([';', '\n', '=', '{']).unwrap_or(rest.len()).max(1))
    } else if first == '{' && !declares(before) {
        (Kind::Rust, braces(rest))
    } else if goes_on(first) && unit_goes_on(first, before) {
        (Kind::Unit, word(rest))
    } else if first.is_ascii_digit() || first == '.' && starts_fraction(rest, before) {
        (Kind::Word, number(rest, before))
    } else if first.is_alphabetic() || first == '_' {
        let length = word(rest);
        let is_operator = is_operator(&rest[..length], &rest[length..], before);
        (if is_operator { Kind::Operator } else { Kind::Word }, length)
    } else if first == '"' {
        (Kind::Word, quoted(rest, '"'))
    } else {
        let symbol = SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol));
        let length = symbol.map_or(first.len_utf8(), |symbol| symbol.len());
        (if bounds(&rest[..length], before) { Kind::Bound } else { Kind::Symbol }, length)
    }
}

/// Whether a word is an operator here, with `rest` after it. `G` is one before an operand, `R` and its
/// like are between two; after a dot all are names.
fn is_operator(word: &str, rest: &str, before: &[Token<'_>]) -> bool {
    let last = before.iter().rev().find(|token| token.kind != Kind::Comment);
    let after_operand = last.is_some_and(Token::ends_operand);
    if last.is_some_and(|last| matches!(last.text, "." | "::")) {
        return false;
    }
    match word {
        "F" | "X" | "U" | "T" | "not" | "and" | "or" | "in" => true,
        "R" | "W" | "M" | "ensuring" => after_operand,
        "G" => !after_operand && starts_operand(rest.trim_start()),
        _ => false,
    }
}

/// Whether a text starts as what `G` can stand before.
fn starts_operand(rest: &str) -> bool {
    let starts = |c: char| c.is_alphanumeric() || "_!¬(◇○□[⊤⊥".contains(c);
    rest.starts_with("<>") || rest.starts_with(starts) && !rest.starts_with("!=")
}

/// Whether a bracket stands around a bound: it follows an operator, or ends what does.
fn bounds(bracket: &str, before: &[Token<'_>]) -> bool {
    /// More tokens than a bound has.
    const MOST: usize = 16;
    match bracket {
        "[" => {
            let last = before.iter().rev().find(|token| token.kind != Kind::Comment);
            last.is_some_and(Token::takes_bound)
        }
        "]" => {
            let open = before.iter().rev().take(MOST).find(|token| matches!(token.text, "[" | "]"));
            open.is_some_and(|open| open.kind == Kind::Bound && open.text == "[")
        }
        _ => false,
    }
}

/// The operators of units, in all their spellings.
const UNIT: &str = "*×/÷^-−";

/// Whether the operator or the word that starts with `first` is a part of a unit: after the `in` of
/// a declaration, names and operators alternate.
fn unit_goes_on(first: char, before: &[Token<'_>]) -> bool {
    let last = before.iter().rev().find(|token| token.kind != Kind::Comment);
    let Some(last) = last else { return false };
    let after_operator = last.text.starts_with(|c| UNIT.contains(c));
    match (last.kind, UNIT.contains(first)) {
        (Kind::Unit, true) => !after_operator || last.text == "^",
        (Kind::Unit, false) => after_operator,
        (_, operator) => !operator && last.text == "in" && declares_unit(before),
    }
}

/// Whether the last `in` belongs to a declaration: it follows a type or a name, and is not the one
/// of `for all r in`.
fn declares_unit(before: &[Token<'_>]) -> bool {
    let mut last = before.iter().rev().filter(|token| token.kind != Kind::Comment).skip(1);
    let Some(name) = last.next() else { return false };
    let words = [Some(name), last.next(), last.next()].map(|token| token.map(|token| token.text));
    let quantified =
        |pair: &[Option<&str>]| matches!(pair[0], Some("all" | "some")) && pair[1] == Some("for");
    let declared = name.ends_operand() || name.text == "?";
    declared && !quantified(&words[..2]) && !quantified(&words[1..])
}

/// The length of a name or of digits.
fn word(rest: &str) -> usize {
    let name = |c: char| !goes_on(c);
    let raw = if rest.starts_with("r#") { 2 } else { 0 };
    raw + rest[raw..].find(name).unwrap_or(rest.len() - raw)
}

/// Whether a Rust type comes next, as after `state name :`.
fn host_type_follows(before: &[Token<'_>]) -> bool {
    let mut last = before.iter().rev().filter(|token| token.kind != Kind::Comment);
    let text = [last.next(), last.next(), last.next()].map(|token| token.map(|token| token.text));
    text[0] == Some(":") && text[2] == Some("state")
}

/// Whether a brace opens the fields of a declaration, as after `state Name`.
fn declares(before: &[Token<'_>]) -> bool {
    let mut last = before.iter().rev().filter(|token| token.kind != Kind::Comment);
    let (name, word) = (last.next(), last.next());
    name.is_some_and(|name| name.kind == Kind::Word)
        && word.is_some_and(|word| matches!(word.text, "state" | "struct" | "enum"))
}

/// Whether a dot begins a number, as in `.5`, and not a field.
fn starts_fraction(rest: &str, before: &[Token<'_>]) -> bool {
    rest[1..].starts_with(|c: char| c.is_ascii_digit())
        && before.last().is_none_or(|token| !token.ends_operand())
}

/// The length of a number. After a dot, digits are the position of a field (`pose.0.1`), which has
/// no fraction.
fn number(rest: &str, before: &[Token<'_>]) -> usize {
    let position = before.last().is_some_and(|token| token.text == ".");
    let mut length = 0;
    let mut last = ' ';
    for c in rest.chars() {
        let sign = matches!(c, '+' | '-') && matches!(last, 'e' | 'E') && length > 1;
        let dot = c == '.' && !position && !rest[length + 1..].starts_with('.');
        let method = dot && rest[length + 1..].starts_with(|c: char| c.is_alphabetic() || c == '_');
        if !(goes_on(c) || sign || dot && !method) {
            break;
        }
        length += c.len_utf8();
        last = c;
    }
    length
}

/// The length of a Rust expression in braces; braces in its strings and characters do not count.
fn braces(rest: &str) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while let Some(c) = rest[at..].chars().next() {
        at += match c {
            '"' => quoted(&rest[at..], '"'),
            '\'' => character(&rest[at..]),
            c => c.len_utf8(),
        };
        depth += i32::from(c == '{') - i32::from(c == '}');
        if depth == 0 {
            break;
        }
    }
    at
}

/// The length of a character literal; 1, the quote alone, if it is a lifetime.
fn character(rest: &str) -> usize {
    let mut chars = rest.chars().skip(1);
    match (chars.next(), chars.next()) {
        (Some('\\'), _) => quoted(rest, '\''),
        (Some(c), Some('\'')) => 2 + c.len_utf8(),
        _ => 1,
    }
}

/// The length of a literal in quotes, escapes included; to the end of the text if it is not closed.
fn quoted(rest: &str, quote: char) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        if c == quote && !escaped {
            return at + 1;
        }
        escaped = c == '\\' && !escaped;
    }
    rest.len()
}

/// Whether a name or a number may have this character after its first: marks that combine with
/// letters are part of names.
fn goes_on(c: char) -> bool {
    c.is_alphanumeric() || unicode_ident::is_xid_continue(c)
}
