//! `tltlc explain` and `tltlc diff`.

use std::io::{self, Write};
use std::path::Path;

use tltl_compiler::dfa::Dfa;
use tltl_compiler::error::Style;
use tltl_compiler::translate::Budget;

use crate::diff::{Difference, Side, of_definitions};
use crate::explain::{Explanation, explain as explanation, explain_automaton};
use crate::report;
use crate::task::Entry;

use super::streams::{read_once, shown};
use super::subject;
use super::{Exit, Outcome, Output, PageFormat, Streams};

/// Explains a task, under its formula as title.
pub(super) fn explain(
    text: &str,
    task: Option<&str>,
    format: PageFormat,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Outcome {
    match subject::read(text, task, budget, streams)? {
        None => Ok(Exit::Mistaken),
        Some(entry) => {
            let (task, automata) = (entry.task(), subject::automata(&entry)?);
            let title = match &task.name {
                Some(name) => format!("{name} = {}", task.text),
                None => task.text.clone(),
            };
            let told = match entry.is_automaton() {
                true => explain_automaton(&automata.dfa),
                false => explanation(&task.spec, &automata.dfa),
            };
            shown_as(format, &title, &automata.dfa, &told, streams)
        }
    }
}

/// Prints an explanation under its title.
fn shown_as(
    format: PageFormat,
    title: &str,
    dfa: &Dfa,
    told: &Explanation,
    streams: &mut Streams<'_>,
) -> Outcome {
    if format == PageFormat::Html {
        return streams.print(&report::explanation(title, dfa, told));
    }
    let (told, style) = (format!("{title}\n\n{told}"), streams.out.style);
    streams.out.print_raw(&headed(&shown(&told), style))
}

/// Compares two subjects, and shows a shortest trajectory on which they differ.
pub(super) fn difference(
    first: &str,
    second: &str,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Outcome {
    read_once([first, second].map(|text| Path::new(subject::split(text).0)).into_iter())?;
    let mut once = Once { stream: &mut *streams.err.stream, told: Vec::new() };
    let streams = &mut Streams {
        input: &mut *streams.input,
        out: Output { stream: &mut *streams.out.stream, style: streams.out.style },
        err: Output { stream: &mut once, style: streams.err.style },
    };
    let first = subject::read(first, None, budget, streams)?;
    let (Some(first), Some(second)) = (first, subject::read(second, None, budget, streams)?) else {
        return Ok(Exit::Mistaken);
    };
    let found = of_definitions(side(&first)?, side(&second)?);
    streams.print(&found.to_string())?;
    Ok(Exit::of(found == Difference::None))
}

/// A stream for messages that writes each of them once: two tasks of one file share its warnings.
struct Once<'a> {
    stream: &'a mut dyn Write,
    told: Vec<Vec<u8>>,
}

impl Write for Once<'_> {
    fn write(&mut self, message: &[u8]) -> io::Result<usize> {
        if !self.told.iter().any(|told| told == message) {
            self.stream.write_all(message)?;
            self.told.push(message.to_vec());
        }
        Ok(message.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        self.stream.flush()
    }
}

/// A subject as a side of a comparison, with its automaton after arithmetic.
fn side(subject: &Entry) -> Result<Side<'_>, String> {
    let dfa = &subject::automata(subject)?.dfa;
    if subject.is_automaton() {
        return Ok(Side::Automaton(dfa));
    }
    let module = &subject.file().compiled().module;
    Ok(Side::Task(module, subject.task(), dfa))
}

/// The text with its headings in bold on a terminal. Headings are the lines that are not indented.
fn headed(text: &str, style: Style) -> String {
    if style == Style::Plain {
        return text.to_owned();
    }
    let bold = |line: &str| match line {
        "" => "\n".to_owned(),
        line if line.starts_with(' ') => format!("{line}\n"),
        line => format!("\x1b[1m{line}\x1b[0m\n"),
    };
    text.lines().map(bold).collect()
}
