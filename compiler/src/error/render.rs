//! An error as text: the sentence, the lines of the source with carets under them, the help.
//!
//! The layout is that of rustc, with one line of carets for each label. A long line is cut to a
//! window around the place, tabs become four blanks, and control characters are replaced, so that
//! carets stand where the terminal shows the text.
//!
//! Written by hand although crates exist for it (annotate-snippets, ariadne): every user of the
//! macros would build them, and this is a page of code whose bytes the tests fix.

use std::fmt::Write;

use super::{Error, Severity};
use crate::intern::order;
use crate::source::{Source, Span, is_hidden, visible};

/// The look of a report.
///
/// ```
/// use tltl_compiler::error::{Error, Kind, Style};
/// use tltl_compiler::source::{Source, Span};
///
/// let source = Source::new("room.tltl", "task home = F hme\n");
/// let error = Error::new(Kind::UnknownName, "nothing here is called `hme`", Span::new(14, 17));
/// let [plain, coloured] = [Style::Plain, Style::Coloured].map(|style| error.render(&source, style));
/// assert!(!plain.contains('\x1b') && coloured.contains("\x1b[1;31merror[unknown-name]\x1b[0m"));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Style {
    /// For files, pipes and compilers.
    #[default]
    Plain,
    /// With ANSI colours, for terminals.
    Coloured,
}

/// ANSI codes, as rustc uses them: errors are red, warnings yellow, everything around the text
/// blue.
const BOLD: &str = "\x1b[1m";
const RED: &str = "\x1b[1;31m";
const YELLOW: &str = "\x1b[1;33m";
const BLUE: &str = "\x1b[1;34m";

/// The most columns of a source line that are shown: about the width of a terminal.
const WINDOW: usize = 100;

impl Style {
    /// The text in a colour, where the style has colours.
    fn paint(self, colour: &str, text: &str) -> String {
        match self {
            Self::Plain => text.to_owned(),
            Self::Coloured if text.is_empty() => String::new(),
            Self::Coloured => format!("{colour}{text}\x1b[0m"),
        }
    }
}

/// A place to underline.
struct Label<'a> {
    /// The place.
    span: Span,
    /// The text beside it.
    text: &'a str,
    /// Whether it is the place of the mistake itself.
    primary: bool,
}

/// The report of one error.
pub(super) fn report(error: &Error, source: &Source, style: Style) -> String {
    let (word, colour) = match error.severity {
        Severity::Error => ("error", RED),
        Severity::Warning => ("warning", YELLOW),
    };
    let error = &shown(error);
    let head = style.paint(colour, &format!("{word}[{}]", error.kind.name()));
    let mut out = format!("{head}{}\n", style.paint(BOLD, &format!(": {}", error.message)));
    let gutter = gutter_width(error, source);
    let bar = style.paint(BLUE, "|");
    let arrow = style.paint(BLUE, "-->");
    let place = source.place(error.span.start);
    let _ = writeln!(out, "{:gutter$}{arrow} {}:{place}", "", visible(source.name()));
    let _ = writeln!(out, "{:gutter$} {bar}", "");
    snippets(&mut out, error, source, style, colour);
    for help in &error.help {
        let lines = help.replace('\n', &format!("\n{:gutter$}         ", ""));
        let equals = style.paint(BLUE, "=");
        let _ = writeln!(out, "{:gutter$} {equals} {} {lines}", "", style.paint(BOLD, "help:"));
    }
    // Editors and snapshots strip trailing blanks, so none is written.
    out.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

/// The error with all its texts as a terminal may get them.
fn shown(error: &Error) -> Error {
    let lines = |text: &str| text.split('\n').map(visible).collect::<Vec<_>>().join("\n");
    let mut shown = error.clone();
    shown.message = lines(&error.message);
    shown.label = lines(&error.label);
    shown.related.iter_mut().for_each(|(_, text)| *text = lines(text));
    shown.help.iter_mut().for_each(|help| *help = lines(help));
    shown
}

/// The width of the largest line number.
fn gutter_width(error: &Error, source: &Source) -> usize {
    let spans = error.related.iter().map(|(span, _)| *span).chain([error.span]);
    let last = spans.map(|span| source.place(span.start).line).max().unwrap_or(1);
    last.to_string().len()
}

/// The lines of the labels in source order, each followed by its carets. `...` stands for lines
/// that are left out.
fn snippets(out: &mut String, error: &Error, source: &Source, style: Style, colour: &str) {
    let gutter = gutter_width(error, source);
    let mut labels = vec![Label { span: error.span, text: &error.label, primary: true }];
    let related = error.related.iter();
    labels.extend(related.map(|(span, text)| Label { span: *span, text, primary: false }));
    let lines = labels.iter().map(|label| source.line(label.span.start).start);
    let places = order(lines.zip(labels.iter().map(|label| usize::from(!label.primary))));
    let labels: Vec<&Label<'_>> = places.into_iter().map(|place| &labels[place]).collect();
    let bar = style.paint(BLUE, "|");
    let mut shown: Option<(Span, usize)> = None;
    for label in &labels {
        let line = source.line(label.span.start);
        let place = source.place(line.start).line;
        if shown.is_none_or(|(before, _)| before != line) {
            if shown.is_some_and(|(_, before)| before + 1 < place) {
                let _ = writeln!(out, "{:gutter$}{}", "", style.paint(BLUE, "..."));
            }
            let number = style.paint(BLUE, &format!("{place:gutter$}"));
            let text = window(source, line, labels[0].span).0;
            let _ = writeln!(out, "{number} {bar} {text}");
        }
        shown = Some((line, place));
        let (_, start) = window(source, line, labels[0].span);
        let carets = underline(source, line, start, label);
        let carets = style.paint(if label.primary { colour } else { BLUE }, &carets);
        let _ = writeln!(out, "{:gutter$} {bar} {carets}", "");
    }
}

/// The part of `line` that is shown, made printable, and the byte at which it starts. A line that
/// is too long is cut so that `focus` is in the middle.
fn window(source: &Source, line: Span, focus: Span) -> (String, usize) {
    let text = source.slice(line);
    if text.chars().count() <= WINDOW {
        return (printable(text), line.start);
    }
    let focus = if line.start <= focus.start && focus.start <= line.end {
        source.slice(Span::new(line.start, focus.start)).chars().count()
    } else {
        0
    };
    let skipped = focus.saturating_sub(WINDOW / 2);
    let start = line.start + text.chars().take(skipped).map(char::len_utf8).sum::<usize>();
    let shown: String = text.chars().skip(skipped).take(WINDOW).collect();
    let more = if start + shown.len() < line.end { "…" } else { "" };
    (printable(&shown) + more, start)
}

/// The carets of a label, with its text. A span that goes beyond its line is cut to the line.
fn underline(source: &Source, line: Span, start: usize, label: &Label<'_>) -> String {
    let (from, to) = (label.span.start.max(start), label.span.end.min(line.end));
    let indent = width(source.slice(Span::new(start, from.min(line.end))))
        + from.saturating_sub(line.end).min(1);
    let length = width(source.slice(Span::new(from, to.max(from)))).clamp(1, WINDOW);
    let mark = if label.primary { "^" } else { "-" };
    let text = if label.text.is_empty() { String::new() } else { format!(" {}", label.text) };
    format!("{}{}{text}", " ".repeat(indent.min(2 * WINDOW)), mark.repeat(length))
}

/// The text with a fixed width for each character.
fn printable(text: &str) -> String {
    text.replace('\t', "    ").replace(is_hidden, "\u{fffd}")
}

/// The number of terminal columns of `text`.
fn width(text: &str) -> usize {
    text.chars().map(columns).sum()
}

/// The number of terminal columns of a character: 0 for combining marks and joiners, 2 for wide
/// scripts and emoji. The ranges are those of Unicode's East Asian Width that occur in practice; a
/// table of all would be larger than this module.
fn columns(c: char) -> usize {
    match c {
        '\t' => 4,
        '\u{300}'..='\u{36f}' | '\u{200b}'..='\u{200d}' | '\u{fe00}'..='\u{fe0f}' => 0,
        '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}' => 2,
        '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}' => 2,
        '\u{1f300}'..='\u{1faff}' | '\u{20000}'..='\u{3fffd}' => 2,
        _ => 1,
    }
}
