//! The streams of a run: those of the process, or others in their place.

use std::borrow::Cow;
use std::fmt;
use std::fs::File;
use std::io::{self, BufRead, BufReader, ErrorKind, IsTerminal, Read, Write};
use std::path::Path;

use tltl::file;
use tltl_compiler::error::Style;
use tltl_compiler::source::{is_hidden, visible};

use super::{Exit, Outcome};

/// The streams of a run. The binary passes those of the process; tests pass buffers.
pub struct Streams<'a> {
    /// The stream that is read for the path `-`.
    pub input: &'a mut dyn Read,
    /// The stream for results.
    pub out: Output<'a>,
    /// The stream for messages.
    pub err: Output<'a>,
}

/// A stream that is written, and whether it takes colours.
pub struct Output<'a> {
    /// The stream itself.
    pub stream: &'a mut dyn Write,
    /// The style of reports: coloured, or plain.
    pub style: Style,
}

/// The style for a stream: coloured if it is a terminal and `NO_COLOR` is not set
/// (<https://no-color.org>).
#[must_use]
pub fn style(stream: &impl IsTerminal) -> Style {
    let allowed = std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty());
    if allowed && stream.is_terminal() { Style::Coloured } else { Style::Plain }
}

impl Streams<'_> {
    /// The text of a file, or of the input if the path is `-`.
    pub(super) fn read(&mut self, path: &Path) -> Result<String, String> {
        let mut text = String::new();
        let read = open(self.input, path)?.read_to_string(&mut text);
        read.map(|_| text).map_err(|error| unreadable(path, &error))
    }

    /// The lines of such a text, without the byte order mark that some editors put before it.
    pub(super) fn read_lines(&mut self, path: &Path) -> Result<Vec<String>, String> {
        let text = self.read(path)?;
        Ok(text.trim_start_matches('\u{feff}').lines().map(str::to_owned).collect())
    }

    /// Writes a result; see [`Output::print`].
    pub(super) fn print(&mut self, text: &str) -> Outcome {
        self.out.print(text)
    }

    /// Writes a message. If nobody can read it, there is nobody to be told.
    pub(super) fn complain(&mut self, text: &str) {
        self.report(&shown(text));
    }

    /// Writes a message that has colours, and else only what a terminal shows. It is one write.
    pub(super) fn report(&mut self, text: &str) {
        let _ = self.err.stream.write_all(format!("{text}\n").as_bytes());
    }
}

impl Output<'_> {
    /// Writes a result, with a line break at its end. What a terminal would obey is shown.
    pub(super) fn print(&mut self, text: &str) -> Outcome {
        self.print_raw(&shown(text))
    }

    /// Writes a result piece by piece as it is made, with a line break at its end. What a terminal
    /// would obey is shown.
    pub(super) fn write(&mut self, text: &dyn fmt::Display) -> Outcome {
        let mut pieces = Pieces { stream: self.stream, failed: Ok(()), ends: true };
        // An error of the stream is kept; the text itself has none.
        let _ = fmt::Write::write_fmt(&mut pieces, format_args!("{text}"));
        let Pieces { failed, ends, .. } = pieces;
        ended(
            failed.and_then(|()| write!(self.stream, "{}", if ends { "" } else { "\n" })),
            self.stream,
        )
    }

    /// Writes a result as it is: a source that must not change, or a text with colours. A reader
    /// that has gone away, as `head` does, is no fault.
    pub(super) fn print_raw(&mut self, text: &str) -> Outcome {
        let end = if text.ends_with('\n') || text.is_empty() { "" } else { "\n" };
        ended(write!(self.stream, "{text}{end}"), self.stream)
    }
}

/// The end of a result.
fn ended(written: io::Result<()>, stream: &mut dyn Write) -> Outcome {
    match written.and_then(|()| stream.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(format!("cannot write: {error}"))
        }
        _ => Ok(Exit::Success),
    }
}

/// A stream that takes a text piece by piece.
struct Pieces<'a> {
    stream: &'a mut dyn Write,
    failed: io::Result<()>,
    /// Whether the text so far ends with a line break, or is empty.
    ends: bool,
}

impl fmt::Write for Pieces<'_> {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        self.ends = if piece.is_empty() { self.ends } else { piece.ends_with('\n') };
        self.failed = self.stream.write_all(shown(piece).as_bytes());
        if self.failed.is_ok() { Ok(()) } else { Err(fmt::Error) }
    }
}

/// Refuses paths of which two are the input: it can be read once.
pub(super) fn read_once<'a>(paths: impl Iterator<Item = &'a Path>) -> Result<(), String> {
    match paths.filter(|path| *path == Path::new("-")).count() {
        0 | 1 => Ok(()),
        _ => Err("the standard input can be read once, and `-` stands here twice".to_owned()),
    }
}

/// A file, or the input if the path is `-`, to be read piece by piece.
pub(super) fn open<'a>(
    input: &'a mut dyn Read,
    path: &Path,
) -> Result<Box<dyn BufRead + 'a>, String> {
    if path == Path::new("-") {
        return Ok(Box::new(BufReader::new(input)));
    }
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    Ok(Box::new(BufReader::with_capacity(1 << 16, file)))
}

/// Replaces a file, or makes it.
pub(super) fn write(path: &Path, text: &str) -> Outcome {
    let failed = |error| format!("cannot write {}: {error}", path.display());
    file::replace(path, text.as_bytes()).map(|()| Exit::Success).map_err(failed)
}

/// A text of several lines in which no character is obeyed, whatever it was made of.
pub(super) fn shown(text: &str) -> Cow<'_, str> {
    // Asked of bytes first, without a branch for each: results can be megabytes.
    let plain = |all, byte: &u8| all & matches!(byte, b' '..=b'~' | b'\n');
    if text.as_bytes().chunks(256).all(|bytes| bytes.iter().fold(true, plain))
        || !text.contains(|c| c != '\n' && is_hidden(c))
    {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.split('\n').map(visible).collect::<Vec<_>>().join("\n"))
}

/// Why a file cannot be read. What is no file's name may be a formula that was meant.
fn unreadable(path: &Path, error: &std::io::Error) -> String {
    let shown = path.display().to_string();
    let formula =
        error.kind() == std::io::ErrorKind::NotFound && shown.contains(['&', '|', '!', '(']);
    let hint = if formula { "; to check a formula, use `tltlc explain`" } else { "" };
    format!("cannot read {shown}: {error}{hint}")
}
