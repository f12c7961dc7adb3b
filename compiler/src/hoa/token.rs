//! The tokens of a HOA file.
//!
//! Written by hand: HOA has nine kinds of tokens and no recursion among them, except for comments,
//! which nest and are counted.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! let text = "HOA: v1 /* a /* nested */ comment */ Start: 0 AP: 0 Acceptance: 0 t
//!     --BODY-- State: 0 [t] 0 --END--";
//! assert_eq!(hoa::read(&Source::new("all.hoa", text)).unwrap().dfa.accepting, Some(0));
//! ```

use super::syntax;
use crate::error::Error;
use crate::source::Span;

/// A token of HOA.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Token<'a> {
    /// `name:`, without the colon.
    Header(&'a str),
    /// A word without a colon: `t`, `Inf`, `v1`.
    Word(&'a str),
    /// A string in quotes, its escapes resolved.
    Text(String),
    /// A number.
    Number(u32),
    /// `@name`, without the `@`.
    Alias(&'a str),
    /// A bracket or an operator.
    Symbol(char),
    /// `--BODY--`
    Body,
    /// `--END--`
    End,
    /// The end of the text.
    Nothing,
}

impl Token<'_> {
    /// The token as messages name it.
    pub(super) fn describe(&self) -> String {
        match self {
            Self::Header(name) => format!("`{name}:`"),
            Self::Word(name) => format!("`{name}`"),
            Self::Text(_) => "a string".to_owned(),
            Self::Number(number) => format!("`{number}`"),
            Self::Alias(name) => format!("`@{name}`"),
            Self::Symbol(symbol) => format!("`{symbol}`"),
            Self::Body => "`--BODY--`".to_owned(),
            Self::End => "`--END--`".to_owned(),
            Self::Nothing => "the end of the text".to_owned(),
        }
    }
}

/// The tokens of a text, with one token of lookahead.
pub(super) struct Tokens<'a> {
    /// The whole text.
    text: &'a str,
    /// The byte after the next token.
    at: usize,
    /// The next token.
    token: Token<'a>,
    /// The place of the next token.
    span: Span,
}

impl<'a> Tokens<'a> {
    /// The tokens of `text`; a byte order mark is skipped.
    pub(super) fn new(text: &'a str) -> Result<Self, Error> {
        let start = if text.starts_with('\u{feff}') { 3 } else { 0 };
        let mut tokens = Self { text, at: start, token: Token::Nothing, span: Span::default() };
        tokens.next()?;
        Ok(tokens)
    }

    /// The next token.
    pub(super) fn peek(&self) -> &Token<'a> {
        &self.token
    }

    /// The place of the next token.
    pub(super) fn span(&self) -> Span {
        self.span
    }

    /// Reads and returns the next token.
    pub(super) fn next(&mut self) -> Result<Token<'a>, Error> {
        self.skip()?;
        let start = self.at;
        let token = self.scan()?;
        self.span = Span::new(start, self.at);
        Ok(std::mem::replace(&mut self.token, token))
    }

    /// Reads `symbol` if it comes next, and returns whether it did.
    pub(super) fn eat(&mut self, symbol: char) -> Result<bool, Error> {
        let found = self.token == Token::Symbol(symbol);
        if found {
            self.next()?;
        }
        Ok(found)
    }

    /// Reads `symbol`, which must come next.
    pub(super) fn expect(&mut self, symbol: char) -> Result<(), Error> {
        if self.eat(symbol)? { Ok(()) } else { Err(self.unexpected(&format!("`{symbol}`"))) }
    }

    /// Reads a number, which must come next; `what` names it in messages.
    pub(super) fn number(&mut self, what: &str) -> Result<u32, Error> {
        match self.token {
            Token::Number(number) => self.next().map(|_| number),
            _ => Err(self.unexpected(what)),
        }
    }

    /// The error that the next token is not what was expected.
    pub(super) fn unexpected(&self, expected: &str) -> Error {
        syntax(format!("expected {expected}, found {}", self.token.describe()), self.span)
    }

    /// Checks that the text ends here. A file may hold several automata; only one is read.
    pub(super) fn finish(&self) -> Result<(), Error> {
        match self.token {
            Token::Nothing => Ok(()),
            Token::Header("HOA") => {
                Err(syntax("a second automaton follows, and only one is read", self.span))
            }
            _ => Err(self.unexpected("the end of the text")),
        }
    }

    /// The text that is still to be read.
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    /// Skips blanks and comments.
    fn skip(&mut self) -> Result<(), Error> {
        loop {
            let rest = self.rest();
            self.at += rest.len() - rest.trim_start().len();
            if !self.rest().starts_with("/*") {
                return Ok(());
            }
            self.comment()?;
        }
    }

    /// Skips a comment. Comments nest, and are counted rather than entered.
    fn comment(&mut self) -> Result<(), Error> {
        let (start, mut depth) = (self.at, 0_usize);
        loop {
            let rest = self.rest();
            if rest.is_empty() {
                return Err(syntax("a comment does not end", Span::new(start, start + 2)));
            } else if rest.starts_with("/*") {
                depth += 1;
                self.at += 2;
            } else if rest.starts_with("*/") {
                depth -= 1;
                self.at += 2;
                if depth == 0 {
                    return Ok(());
                }
            } else {
                self.at += rest.chars().next().map_or(1, char::len_utf8);
            }
        }
    }

    /// Scans one token.
    fn scan(&mut self) -> Result<Token<'a>, Error> {
        let rest = self.rest();
        let Some(first) = rest.chars().next() else { return Ok(Token::Nothing) };
        match first {
            '-' => self.section(),
            '"' => self.string(),
            '0'..='9' => self.digits(),
            '@' => {
                self.at += 1;
                match self.word() {
                    "" => Err(syntax("expected a name after `@`", Span::new(self.at - 1, self.at))),
                    name => Ok(Token::Alias(name)),
                }
            }
            'a'..='z' | 'A'..='Z' | '_' => {
                let word = self.word();
                let header = self.rest().starts_with(':');
                self.at += usize::from(header);
                Ok(if header { Token::Header(word) } else { Token::Word(word) })
            }
            _ => {
                self.at += first.len_utf8();
                if "!&|()[]{}".contains(first) {
                    return Ok(Token::Symbol(first));
                }
                let span = Span::new(self.at - first.len_utf8(), self.at);
                Err(syntax(format!("unexpected character `{}`", first.escape_default()), span))
            }
        }
    }

    /// Scans `--BODY--` or `--END--`.
    fn section(&mut self) -> Result<Token<'a>, Error> {
        let rest = self.rest();
        let known = [("--BODY--", Token::Body), ("--END--", Token::End)];
        if let Some((text, token)) = known.into_iter().find(|(text, _)| rest.starts_with(text)) {
            self.at += text.len();
            return Ok(token);
        }
        let span = Span::new(self.at, self.at + 1);
        if rest.starts_with("--ABORT--") {
            return Err(syntax("the tool that wrote the automaton gave it up (`--ABORT--`)", span));
        }
        Err(syntax("expected `--BODY--` or `--END--`", span))
    }

    /// Scans a word; it may have hyphens in it, as in `acc-name`, and dots, as in `spot.highlight`.
    fn word(&mut self) -> &'a str {
        let rest = self.rest();
        let other = |c: char| !(c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.'));
        let word = &rest[..rest.find(other).unwrap_or(rest.len())];
        self.at += word.len();
        word
    }

    /// Scans a number.
    fn digits(&mut self) -> Result<Token<'a>, Error> {
        let (start, rest) = (self.at, self.rest());
        let other = |c: char| !c.is_ascii_digit();
        let digits = &rest[..rest.find(other).unwrap_or(rest.len())];
        self.at += digits.len();
        let large = |_| syntax("the number is too large", Span::new(start, self.at));
        digits.parse().map(Token::Number).map_err(large)
    }

    /// Scans a string with its escapes.
    fn string(&mut self) -> Result<Token<'a>, Error> {
        let start = self.at;
        let mut text = String::new();
        let mut escaped = false;
        for (offset, c) in self.rest().char_indices().skip(1) {
            match c {
                '"' if !escaped => {
                    self.at += offset + 1;
                    return Ok(Token::Text(text));
                }
                '\\' if !escaped => escaped = true,
                _ => {
                    text.push(c);
                    escaped = false;
                }
            }
        }
        Err(syntax("a string does not end", Span::new(start, start + 1)))
    }
}
