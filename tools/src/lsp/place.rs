//! Positions of the protocol, which count UTF-16 units within a line, and bytes of the source.

use serde::{Deserialize, Serialize};
use tltl_compiler::source::Span;

/// A place between two characters: the line and the UTF-16 units before it in the line, from 0.
#[derive(Clone, Copy, Debug, Deserialize, Serialize, PartialEq, Eq)]
pub(super) struct Position {
    line: u64,
    character: u64,
}

/// The part of a text between two places.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct Range {
    start: Position,
    end: Position,
}

/// Where the lines of a text begin. A line ends with `\n`, `\r\n` or `\r`.
pub(super) struct Lines(Vec<usize>);

impl Lines {
    pub(super) fn new(text: &str) -> Self {
        let bytes = text.as_bytes();
        let ends = |i: &usize| match bytes[*i] {
            b'\n' => true,
            b'\r' => bytes.get(i + 1) != Some(&b'\n'),
            _ => false,
        };
        let starts = (0..bytes.len()).filter(ends).map(|i| i + 1);
        Self(std::iter::once(0).chain(starts).collect())
    }

    /// The byte at a position. One behind the end of its line is at that end, one behind the last
    /// line at the end of the text, and one within a character before it.
    pub(super) fn byte(&self, text: &str, at: Position) -> usize {
        let line = usize::try_from(at.line).unwrap_or(usize::MAX);
        let Some(&start) = self.0.get(line) else { return text.len() };
        let end = self.0.get(line + 1).copied().unwrap_or(text.len());
        let mut left = at.character;
        let line = text[start..end].trim_end_matches(['\r', '\n']);
        for (i, c) in line.char_indices() {
            match left.checked_sub(c.len_utf16() as u64) {
                Some(rest) if left > 0 => left = rest,
                _ => return start + i,
            }
        }
        start + line.len()
    }

    /// The position of a byte that begins a character, or of the end of the text.
    pub(super) fn position(&self, text: &str, byte: usize) -> Position {
        let line = self.0.partition_point(|start| *start <= byte).saturating_sub(1);
        let before = text.get(self.0[line]..byte).unwrap_or_default();
        let character = before.chars().map(char::len_utf16).sum::<usize>() as u64;
        Position { line: line as u64, character }
    }

    pub(super) fn range(&self, text: &str, span: Span) -> Range {
        Range { start: self.position(text, span.start), end: self.position(text, span.end) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_count_utf_16() {
        let text = "a◇b\r\n𝄞x\ry\n\n🙂";
        let lines = Lines::new(text);
        // By hand: every boundary between two characters.
        for (byte, line, character) in [
            (0, 0, 0),
            (1, 0, 1),
            (4, 0, 2),
            (5, 0, 3),
            (7, 1, 0),
            (11, 1, 2),
            (12, 1, 3),
            (13, 2, 0),
            (14, 2, 1),
            (15, 3, 0),
            (16, 4, 0),
            (20, 4, 2),
        ] {
            let at = Position { line, character };
            assert_eq!(lines.position(text, byte), at);
            assert_eq!(lines.byte(text, at), byte);
        }
        // Within a character, behind a line, behind the text.
        for (line, character, byte) in [(1, 1, 7), (0, 99, 5), (3, 5, 15), (9, 0, 20)] {
            assert_eq!(lines.byte(text, Position { line, character }), byte);
        }
        assert_eq!(lines.byte(text, Position { line: u64::MAX, character: u64::MAX }), text.len());
    }
}
