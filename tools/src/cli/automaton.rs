//! `tltlc automaton`: the automaton of a formula, of each formula of a list, or of a task, in one
//! of the forms of [`emit`](crate::emit).

use std::fmt::Display;

use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::error::{Error, Kind, Style};
use tltl_compiler::source::{Source, Span};
use tltl_compiler::translate::Budget;

use crate::emit::{c, dot, hoa, json, mermaid, rust, svg, text};
use crate::task::{Entry, TaskFile};

use super::input;
use super::{Automaton, Exit, Format, Outcome, Report, Streams, subject};

const NO_FORMULA: &str =
    "C is written of formulas and tasks, and an automaton of another tool has neither";

/// How one task of several is named.
const HOW: &str = " with --task";

/// Shows the automaton that the arguments name, in the form that they ask for.
pub(super) fn run(arguments: &Automaton, streams: &mut Streams<'_>) -> Outcome {
    // What becomes code is within the limits of the macros.
    let budget = match arguments.format {
        Format::Rust | Format::C => arguments.limits.over(Budget::EMITTED),
        _ => arguments.limits.shown(),
    };
    if let Some(list) = &arguments.formulas {
        let list = streams.read_lines(list)?;
        return formulas(arguments, &list, budget, streams);
    }
    if let Some(formula) = &arguments.formula {
        return single(arguments, formula, budget, streams);
    }
    let Some(path) = &arguments.file else { return Err("there is no formula and no file".into()) };
    if let (Some(text), None) = (path.to_str(), &arguments.task)
        && !subject::looks_like_file(text)
    {
        return single(arguments, text, budget, streams);
    }
    // Rust is of the file as a whole.
    let task = arguments.task.as_deref().filter(|_| arguments.format != Format::Rust);
    let mut file = input::file(path, task, budget, streams)?;
    if arguments.format != Format::Rust {
        file = subject::one(file, task, HOW)?;
    }
    match file.whole(streams)? {
        Some(file) if arguments.format == Format::Rust && !file.is_automaton() => {
            streams.print(&rust::file(file.compiled()))
        }
        Some(file) => {
            write(arguments, &subject::choose(&file, arguments.task.as_deref(), HOW)?, streams)
        }
        None => Ok(Exit::Mistaken),
    }
}

/// One formula, in any form. With `--format json` a mistake is JSON too, since a program reads it.
fn single(
    arguments: &Automaton,
    formula: &str,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Outcome {
    let result = TaskFile::of_formula(formula, budget);
    if let (Format::Json, Err(error)) = (arguments.format, &result) {
        streams.print(&json::failure(formula, error.errors().first()))?;
        return Ok(Exit::Mistaken);
    }
    match input::reported(result, Report::Human, streams)? {
        Some(file) => write(arguments, &subject::choose(&file, None, "")?, streams),
        None => Ok(Exit::Mistaken),
    }
}

/// A list of formulas, one a line, without its empty lines and comments (`#`, `//`). A bad one is
/// reported in its place and the rest goes on, so that in JSON there is a line for each formula.
fn formulas(
    arguments: &Automaton,
    list: &[String],
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Outcome {
    if !matches!(arguments.format, Format::Json | Format::Text) {
        return Err("a list of formulas is shown with `--format json` or `--format text`".into());
    }
    let mut all_well = true;
    let is_formula =
        |line: &str| !["#", "//"].iter().any(|mark| line.starts_with(mark)) && !line.is_empty();
    for (number, formula) in list.iter().enumerate().filter(|(_, line)| is_formula(line.trim())) {
        let shown = one_of_many(arguments, (number, formula), budget);
        all_well &= shown.is_ok();
        streams.print(&shown.unwrap_or_else(|failure| failure))?;
    }
    Ok(Exit::of(all_well))
}

/// One formula of a list, behind that many other lines; `Err` is the report of a mistake.
fn one_of_many(
    arguments: &Automaton,
    (line, formula): (usize, &str),
    budget: Budget,
) -> Result<String, String> {
    let file = TaskFile::of_formula(formula, budget).map_err(|error| {
        let first = error.errors().first();
        match (arguments.format, &arguments.formulas) {
            (Format::Text, Some(list)) => {
                let before = "\n".repeat(line);
                let source = Source::new(list.display().to_string(), before + formula);
                first.clone().moved(line).render(&source, Style::Plain)
            }
            _ => json::failure(formula, first),
        }
    })?;
    let entry = subject::choose(&file, None, "")?;
    let dfa = selected(arguments, subject::automata(&entry)?);
    match (arguments.format, arguments.explicit) {
        (Format::Json, true) => {
            json::explicit(formula, dfa).map_err(|error| json::failure(formula, &error))
        }
        (Format::Json, false) => Ok(json::summary(formula, dfa)),
        _ => Ok(text::automaton(formula, dfa)),
    }
}

/// The automaton over free propositions, or the one after arithmetic.
fn selected<'a>(arguments: &Automaton, automata: &'a Automata) -> &'a Dfa {
    if arguments.propositional { &automata.propositional } else { &automata.dfa }
}

/// Writes a task in the form that the arguments ask for.
fn write(arguments: &Automaton, entry: &Entry, streams: &mut Streams<'_>) -> Outcome {
    let automata = subject::automata(entry)?;
    match shown(arguments, entry, automata) {
        Ok(text) => streams.out.write(&text),
        // There is no place in the text to show.
        Err(error) if entry.is_automaton() => {
            streams.complain(&format!("{}: {}", entry.file().source().name(), error.message()));
            Ok(Exit::Mistaken)
        }
        Err(error) => {
            let source = entry.file().source();
            input::judged::<()>(source, Err(error.into()), Report::Human, streams)?;
            Ok(Exit::Mistaken)
        }
    }
}

/// A task in the form that the arguments ask for.
fn shown<'a>(
    arguments: &Automaton,
    entry: &Entry,
    automata: &'a Automata,
) -> Result<Box<dyn Display + 'a>, Error> {
    let task = entry.task();
    let title = task.name.as_deref().unwrap_or(&task.text);
    let text = || sizes(arguments, &task.text, automata);
    let dfa = selected(arguments, automata);
    let compiled = entry.file().compiled();
    let code = || match arguments.format {
        Format::C if entry.is_automaton() => {
            Err(Error::new(Kind::Automaton, NO_FORMULA, Span::default()))
        }
        _ if entry.is_automaton() => Ok(rust::foreign(title, dfa)),
        Format::C => c::header(&compiled.module, task, dfa).map_err(|refused| {
            let kind = if let c::Refused::Large(..) = refused { Kind::Budget } else { Kind::Type };
            Error::new(kind, refused.to_string(), task.span)
        }),
        _ => Ok(rust::file(compiled)),
    };
    formatted(arguments, [title, &task.text], dfa, task.span, (&text, &code))
}

/// An automaton in the form that the arguments ask for; the table of text and the Rust are made by
/// the functions. `Err` says at `span` that it is too large for the form.
fn formatted<'a>(
    arguments: &Automaton,
    [title, formula]: [&str; 2],
    dfa: &'a Dfa,
    span: Span,
    (text, code): (&dyn Fn() -> String, &dyn Fn() -> Result<String, Error>),
) -> Result<Box<dyn Display + 'a>, Error> {
    let written = match arguments.format {
        Format::Text => return Ok(Box::new(text())),
        Format::Json if arguments.explicit => {
            return Ok(Box::new(json::explicit(formula, dfa)?));
        }
        Format::Json => json::automaton(formula, dfa),
        Format::Dot => dot::automaton(title, dfa),
        Format::Svg => return Ok(Box::new(svg::automaton(title, dfa))),
        Format::Mermaid => mermaid::automaton(title, dfa),
        Format::Hoa => hoa::automaton(title, dfa),
        Format::Rust | Format::C => return Ok(Box::new(code()?)),
    };
    match written {
        Ok(text) => Ok(Box::new(text)),
        Err(too_large) => Err(Error::new(Kind::Budget, too_large.to_string(), span)),
    }
}

/// The table of the automaton; if arithmetic has made it smaller, with both sizes.
fn sizes(arguments: &Automaton, title: &str, automata: &Automata) -> String {
    let dfa = selected(arguments, automata);
    let mut written = text::automaton(title, dfa);
    if !arguments.propositional && automata.dfa.possible.is_some() {
        written.push_str("\nwith the predicates taken for free propositions:\n");
        written.push_str(&text::sizes(automata.propositional.size()));
    }
    written
}
