//! Words and symbols as a reader sees them.
//!
//! The parser does not use this module: the grammar recognizes the tokens of a source. Three jobs need
//! tokens without a grammar. Messages quote the word at which parsing failed and the word before
//! it. After a mistake, the next item must be found in text that has no parse ([`next_item`]). And
//! expressions of Rust, which the grammar takes verbatim, get other names for their parameters
//! ([`renamed`]).
//!
//! Any text is a sequence of tokens, broken ones included: an unclosed comment ends with the text,
//! and an unknown character is a token by itself. Nothing here fails.

use unicode_ident::is_xid_continue;

use crate::reserved::bare;
use crate::source::Span;

/// The words with which an item begins. None of them is reserved, so a name after them is what
/// makes an item ([`begins_item`]).
const ITEM_WORDS: [&str; 6] = ["state", "struct", "enum", "const", "predicate", "task"];

/// The symbols of more than one character, and those of one that begin them: the first that fits is
/// the token, so longer ones stand before their beginnings. Other characters are tokens by
/// themselves. Operators of other logics (`<>`, `[]`, `**`, `=<`) are among them, for a message
/// must quote them whole.
const SYMBOLS: [&str; 28] = [
    "<==>", "==>", "/\\", "\\/", "<=>", "<->", "///", "//!", "=>", "->", "&&", "||", "==", "!=",
    "<=", ">=", "<>", "[]", "::", "**", "=<", "&", "|", "<", ">", "=", "-", "/",
];

/// The meaning of a keyword, as messages give it; `None` if `word` is an ordinary name.
pub(crate) fn keyword(word: &str) -> Option<&'static str> {
    Some(match word {
        "F" => "\"eventually\"",
        "X" => "\"at the next state\"",
        "U" => "\"until\"",
        "T" => "\"then\"",
        "true" | "false" => "a truth value",
        "not" => "\"not\"",
        "and" => "\"and\"",
        "or" => "\"or\"",
        _ => return None,
    })
}

/// Whether `text` begins like an item, after its attributes: the input of the macro is then a file,
/// else a formula.
pub(crate) fn starts_with_item(text: &str) -> bool {
    let mut tokens = Tokens::new(text, 0);
    let Some(mut first) = tokens.next() else { return false };
    while &text[first.start..first.end] == "#" {
        tokens.find(|token| &text[token.start..token.end] == "]");
        let Some(next) = tokens.next() else { return false };
        first = next;
    }
    let word = &text[first.start..first.end];
    word == "///" || word == "//!" || begins_item(text, first)
}

/// The name of the item that starts in `span`; `None` if no item does.
pub(crate) fn item_name(text: &str, span: Span) -> Option<Span> {
    let mut tokens = Tokens::new(text, span.start);
    let word = tokens.find(|token| ITEM_WORDS.contains(&&text[token.start..token.end]))?;
    (word.end <= span.end && begins_item(text, word)).then(|| tokens.next()).flatten()
}

/// The byte at which the next item starts, at `from` or later but after the item that starts at
/// `at`; the end of the text if there is none.
///
/// An item starts where its word is the first of a line or follows a `;`, and its doc comments and
/// attributes belong to it. Requiring one of the two keeps a name like `state` inside a formula
/// from ending the item that is being skipped.
pub(crate) fn next_item(text: &str, at: usize, from: usize) -> usize {
    let mut first = true;
    let mut item_seen = false;
    let mut doc = None;
    let mut tokens = Tokens::new(text, at);
    while let Some(token) = tokens.next() {
        let word = &text[token.start..token.end];
        let new_line = text[..token.start].rfind(|c: char| !c.is_whitespace() || c == '\n');
        first |= new_line.is_none_or(|at| text[at..].starts_with('\n'));
        if first && matches!(word, "///" | "#") {
            doc = doc.or(Some(token.start));
            if word == "#" {
                tokens.find(|token| matches!(&text[token.start..token.end], "]" | "[]"));
                continue;
            }
        } else if first && begins_item(text, token) {
            if item_seen && token.start >= from || token.start > from {
                return doc.unwrap_or(token.start).max(at + 1);
            }
            item_seen = true;
            doc = None;
        } else {
            item_seen = true;
            doc = None;
        }
        first = word == ";";
    }
    text.len()
}

/// A text without the blanks and comments that make no difference, so that equal expressions of
/// Rust are equal texts. A text with quotes in it stays as it is, for blanks inside a literal
/// matter.
pub(crate) fn compact(text: &str) -> String {
    // Tokens know nothing of literals, in which every blank counts.
    if text.contains(['"', '\'']) {
        return text.trim().to_owned();
    }
    let mut compact = String::new();
    for token in Tokens::new(text, 0) {
        let word = &text[token.start..token.end];
        if compact.ends_with(goes_on) && word.starts_with(goes_on) {
            compact.push(' ');
        }
        compact.push_str(word);
    }
    compact
}

/// The byte at which a comment begins that nothing ends, in the text from byte `from` on.
pub(crate) fn open_comment(text: &str, from: usize) -> Option<usize> {
    let mut tokens = Tokens::new(text, from);
    tokens.by_ref().for_each(drop);
    tokens.open
}

/// The name in quotes, if it can do without them: `"goal"` is `goal`, and `"goal room"` stays.
pub(crate) fn unquoted(text: &str) -> &str {
    let name = text.strip_prefix('"').and_then(|text| text.strip_suffix('"')).unwrap_or(text);
    let is_plain = name.starts_with(is_word_start)
        && name.chars().all(is_xid_continue)
        && keyword(name).is_none();
    if is_plain { name } else { text }
}

/// The Rust expression `text` with other words in the place of some names. Works on tokens, so `x`
/// in `max` or in a comment stays.
pub(crate) fn renamed(text: &str, words: &[(&str, String)]) -> String {
    let mut renamed = String::new();
    let mut end = 0;
    for token in Tokens::new(text, 0) {
        let name = &text[token.start..token.end];
        if let Some((_, word)) = words.iter().find(|(known, _)| *known == name) {
            renamed.push_str(&text[end..token.start]);
            renamed.push_str(word);
            end = token.end;
        }
    }
    renamed + &text[end..]
}

/// Whether the Rust expression `text` has the word `name` in it. A field or a method of that name
/// counts too: without a parser for Rust the two cannot be told apart.
pub(crate) fn mentions(text: &str, name: &str) -> bool {
    let is_named = |token: Span| bare(&text[token.start..token.end]) == bare(name);
    Tokens::new(text, 0).any(is_named)
}

/// Whether the token is the word of an item: a name follows it, or, after `step`, a number.
fn begins_item(text: &str, token: Span) -> bool {
    let word = &text[token.start..token.end];
    let Some(next) = Tokens::new(text, token.end).next() else { return false };
    let next = &text[next.start..];
    ITEM_WORDS.contains(&word) && next.starts_with(is_word_start)
        || word == "step" && next.starts_with(|c: char| c.is_ascii_digit())
}

/// The tokens of a text from some byte on. Comments are skipped; a doc comment is one token, `///`
/// or `//!`, and its text is skipped.
pub(crate) struct Tokens<'a> {
    text: &'a str,
    at: usize,
    /// The byte at which a comment begins that nothing ends, once it was met.
    open: Option<usize>,
}

impl<'a> Tokens<'a> {
    /// The tokens of `text` from byte `at` on.
    pub(crate) fn new(text: &'a str, at: usize) -> Self {
        Self { text, at, open: None }
    }

    /// Skips blanks, a byte order mark, and comments. Four slashes begin an ordinary comment, as in
    /// Rust.
    fn skip_trivia(&mut self) {
        loop {
            let rest = &self.text[self.at..];
            let trimmed = rest.trim_start_matches(|c: char| c.is_whitespace() || c == '\u{feff}');
            self.at += rest.len() - trimmed.len();
            let doc = trimmed.starts_with("//!")
                || trimmed.starts_with("///") && !trimmed.starts_with("////");
            if trimmed.starts_with("//") && !doc {
                self.at += trimmed.find('\n').unwrap_or(trimmed.len());
            } else if let Some(comment) = trimmed.strip_prefix("/*") {
                let end = comment.find("*/");
                self.open = self.open.or(end.is_none().then_some(self.at));
                self.at += end.map_or(trimmed.len(), |end| end + 4);
            } else {
                return;
            }
        }
    }
}

impl Iterator for Tokens<'_> {
    type Item = Span;

    fn next(&mut self) -> Option<Span> {
        self.skip_trivia();
        let rest = &self.text[self.at..];
        let first = rest.chars().next()?;
        let raw = rest.strip_prefix("r#").filter(|word| word.starts_with(is_word_start));
        let length = if is_word_start(first) || first.is_ascii_digit() {
            let word = raw.unwrap_or(rest);
            let end = word.find(|c: char| !goes_on(c));
            rest.len() - word.len() + end.unwrap_or(word.len())
        } else {
            let symbol = SYMBOLS.iter().find(|symbol| rest.starts_with(**symbol));
            symbol.map_or(first.len_utf8(), |symbol| symbol.len())
        };
        let token = Span::new(self.at, self.at + length);
        self.at = token.end;
        if matches!(&self.text[token.start..token.end], "///" | "//!") {
            self.at += rest[length..].find('\n').unwrap_or(rest.len() - length);
        }
        Some(token)
    }
}

/// Whether a name or a number may have `c` after its first character: marks that combine with
/// letters are parts of names, and digits of any script.
pub(crate) fn goes_on(c: char) -> bool {
    c.is_alphanumeric() || is_xid_continue(c)
}

/// Whether a name can begin with `c`.
pub(crate) fn is_word_start(c: char) -> bool {
    c.is_alphabetic() || c == '_'
}
