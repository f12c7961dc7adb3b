//! What a run reads, and where it writes: the process's own streams, or others in their place.

use std::io::{ErrorKind, IsTerminal, Read, Write};
use std::path::Path;

use tltl_compiler::error::Style;

use super::{Exit, Outcome};

/// The streams of a run.
pub struct Streams<'a> {
    /// What is read for the path `-`.
    pub input: &'a mut dyn Read,
    /// Where results go.
    pub out: Output<'a>,
    /// Where messages go.
    pub err: Output<'a>,
}

/// One of the streams that are written.
pub struct Output<'a> {
    /// Where the text goes.
    pub stream: &'a mut dyn Write,
    /// Whether the text has colours.
    pub style: Style,
}

/// The style of a stream: coloured if it is a terminal, and `NO_COLOR` is not set.
#[must_use]
pub fn style(stream: &impl IsTerminal) -> Style {
    let allowed = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    if allowed && stream.is_terminal() { Style::Coloured } else { Style::Plain }
}

impl Streams<'_> {
    /// The text of a file, or of the input if the path is `-`.
    pub(super) fn read(&mut self, path: &Path) -> Result<String, String> {
        let mut text = String::new();
        if path == Path::new("-") {
            self.input.read_to_string(&mut text).map(|_| text)
        } else {
            std::fs::read_to_string(path)
        }
        .map_err(|error| format!("cannot read {}: {error}", path.display()))
    }

    /// Writes a result; a reader that went away is not a fault.
    pub(super) fn print(&mut self, text: &str) -> Outcome {
        let end = if text.ends_with('\n') || text.is_empty() { "" } else { "\n" };
        match write!(self.out.stream, "{text}{end}").and_then(|()| self.out.stream.flush()) {
            Err(error) if error.kind() != ErrorKind::BrokenPipe => {
                Err(format!("cannot write: {error}"))
            }
            _ => Ok(Exit::Success),
        }
    }

    /// Writes a line of a message; that nobody reads it is no fault.
    pub(super) fn complain(&mut self, text: &str) {
        let _ = writeln!(self.err.stream, "{text}");
    }
}
