//! Source text and places in it.
//!
//! A [`Source`] is a text with a name. Every later stage keeps [`Span`]s (ranges of bytes) instead
//! of copies of the text, so that an error can underline the very characters that it is about.
//! Bytes become lines and columns only when an error is printed: [`Source::place`] scans the text,
//! which takes microseconds and happens once an error.
//!
//! The macros flatten their tokens to one text and keep a table from byte ranges back to tokens; so
//! files, the command line and the macros share one grammar and one set of messages.
//!
//! Nothing here panics on a span of another text: it is cut to what there is.
//!
//! ```
//! use tltl_compiler::source::{Source, Span};
//!
//! let source = Source::new("room.tltl", "task a = F b\ntask c = F d\n");
//! let d = Span::new(24, 25);
//! assert_eq!(source.slice(d), "d");
//! assert_eq!(source.place(d.start).to_string(), "2:12");
//! assert_eq!(source.slice(source.line(d.start)), "task c = F d");
//! assert_eq!(source.slice(Span::new(90, 99)), "");
//! ```

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// Whether a character is obeyed and not shown: a control character, a tab apart, or one that ends a
/// line or changes the direction of text, so that what is read is not what is there ("Trojan
/// Source", Boucher and Anderson, 2021). rustc refuses most of them in comments.
///
/// ```
/// use tltl_compiler::source::is_hidden;
///
/// assert!(is_hidden('\x1b') && is_hidden('\u{202e}') && !is_hidden('\t') && !is_hidden('é'));
/// ```
#[must_use]
pub fn is_hidden(c: char) -> bool {
    // Unicode's `Bidi_Control`, and its separators of lines and paragraphs.
    let directs = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c != '\t' && (directs || c.is_control())
}

/// A text in which [hidden](is_hidden) characters stand as `\u{…}`: for comments, and for terminals.
///
/// ```
/// use tltl_compiler::source::visible;
///
/// assert_eq!(visible("red \x1b[31m"), "red \\u{1b}[31m");
/// ```
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    let mut visible = String::new();
    for c in text.chars() {
        if is_hidden(c) { visible.extend(c.escape_unicode()) } else { visible.push(c) }
    }
    Cow::Owned(visible)
}

/// A range of bytes of a source. Ordered by its start, then by its end: the order in which errors
/// are reported.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Span {
    /// The first byte.
    pub start: usize,
    /// One past the last byte.
    pub end: usize,
}

impl Span {
    /// The bytes `start..end`.
    #[must_use]
    pub const fn new(start: usize, end: usize) -> Self {
        Self { start, end }
    }

    /// The smallest span that covers both.
    ///
    /// ```
    /// # use tltl_compiler::source::Span;
    /// assert_eq!(Span::new(4, 6).to(Span::new(0, 1)), Span::new(0, 6));
    /// ```
    #[must_use]
    pub fn to(self, other: Self) -> Self {
        Self { start: self.start.min(other.start), end: self.end.max(other.end) }
    }

    /// The same span `by` bytes further on: the place in the file of a span that was found in a
    /// part of it.
    ///
    /// ```
    /// # use tltl_compiler::source::Span;
    /// // An item that starts at byte 40 was parsed from a slice of its own.
    /// assert_eq!(Span::new(3, 5).shifted(40), Span::new(43, 45));
    /// ```
    #[must_use]
    pub const fn shifted(self, by: usize) -> Self {
        Self { start: self.start + by, end: self.end + by }
    }
}

impl From<Range<usize>> for Span {
    fn from(range: Range<usize>) -> Self {
        Self { start: range.start, end: range.end }
    }
}

/// A line and a column, both counted from 1. Columns count characters, as editors do, neither bytes
/// nor terminal cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Place {
    /// The line.
    pub line: usize,
    /// The column.
    pub column: usize,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.line, self.column)
    }
}

/// A text with the name under which errors show it.
///
/// Cheap to clone: the name and the text are shared. `Send` and `Sync`, because whatever was
/// compiled keeps its source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    name: Arc<str>,
    text: Arc<str>,
}

impl Source {
    /// The text `text`, called `name` in messages: a file's path, or something like `<formula>`.
    #[must_use]
    pub fn new(name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> Self {
        Self { name: name.into(), text: text.into() }
    }

    /// The name under which messages show it.
    #[must_use]
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The whole text.
    #[must_use]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text at `span`; empty if the span is not a part of this text.
    ///
    /// ```
    /// # use tltl_compiler::source::{Source, Span};
    /// let source = Source::new("formula", "F été");
    /// assert_eq!(source.slice(Span::new(2, 7)), "été");
    /// // Within a character there is no text.
    /// assert_eq!(source.slice(Span::new(2, 3)), "");
    /// ```
    #[must_use]
    pub fn slice(&self, span: Span) -> &str {
        self.text.get(span.start..span.end).unwrap_or_default()
    }

    /// The line and column of a byte; the end of the text if it lies beyond. Scans the text up to
    /// there.
    ///
    /// ```
    /// # use tltl_compiler::source::Source;
    /// let source = Source::new("formula", "F été &&\nF b");
    /// assert_eq!(source.place(8).to_string(), "1:7");
    /// assert_eq!(source.place(999).to_string(), "2:4");
    /// ```
    #[must_use]
    pub fn place(&self, byte: usize) -> Place {
        let before = self.before(byte);
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Place {
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
        }
    }

    /// The span of the line that holds `byte`, without its line break, be it `\n` or `\r\n`.
    ///
    /// ```
    /// # use tltl_compiler::source::Source;
    /// let source = Source::new("formula", "F a &&\r\nF b");
    /// let lines = [0, 9].map(|byte| source.slice(source.line(byte)));
    /// assert_eq!(lines, ["F a &&", "F b"]);
    /// ```
    #[must_use]
    pub fn line(&self, byte: usize) -> Span {
        let byte = self.before(byte).len();
        let start = self.text[..byte].rfind('\n').map_or(0, |newline| newline + 1);
        let end = self.text[byte..].find('\n').map_or(self.text.len(), |length| byte + length);
        let line = self.text[start..end].trim_end_matches('\r');
        Span::new(start, start + line.len())
    }

    /// The text up to `byte`. A byte inside a character counts as the start of that character.
    fn before(&self, byte: usize) -> &str {
        let mut byte = byte.min(self.text.len());
        while !self.text.is_char_boundary(byte) {
            byte -= 1;
        }
        &self.text[..byte]
    }
}
