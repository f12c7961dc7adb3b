//! `tltlc automaton`.

use std::process::ExitCode;

use tltl_compiler::compile::{self, Automata, Compiled};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::emit::{dot, hoa, json, mermaid, rust, svg, text};
use tltl_compiler::error::{Error, Style};
use tltl_compiler::predicate::Task;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::subject::choose;
use super::{Automaton, Format, MISTAKEN, Outcome, Report, input, print};

/// Shows what the arguments ask for.
pub(super) fn run(arguments: &Automaton) -> Outcome {
    if let Some(list) = &arguments.formulas {
        return formulas(arguments, &input::read(list)?);
    }
    if let Some(formula) = &arguments.formula {
        return single(arguments, formula);
    }
    let Some(path) = &arguments.file else { return Err("there is no formula and no file".into()) };
    match input::file(path)? {
        // Rust is of the file as a whole.
        Some(compiled) if arguments.format == Format::Rust => print(&rust::file(&compiled)),
        Some(compiled) => {
            let (task, automata) = choose(&compiled, arguments.task.as_deref())?;
            show(arguments, &compiled, task, automata)
        }
        None => Ok(ExitCode::from(MISTAKEN)),
    }
}

/// One formula, in any form.
fn single(arguments: &Automaton, formula: &str) -> Outcome {
    let source = Source::new("formula", formula);
    let result = compile::formula(&source, Budget::SHOWN);
    if let (Format::Json, Err(errors)) = (arguments.format, &result) {
        print(&json::failure(formula, errors.first()))?;
        return Ok(ExitCode::from(MISTAKEN));
    }
    match input::reported(&source, result, Report::Human)? {
        Some(compiled) => {
            let (task, automata) = choose(&compiled, None)?;
            show(arguments, &compiled, task, automata)
        }
        None => Ok(ExitCode::from(MISTAKEN)),
    }
}

/// A list of formulas, one a line; a bad one is reported in its place and the rest goes on.
fn formulas(arguments: &Automaton, list: &str) -> Outcome {
    if !matches!(arguments.format, Format::Json | Format::Text) {
        return Err("a list of formulas is shown with `--format json` or `--format text`".into());
    }
    let mut all_well = true;
    for formula in list.lines() {
        let shown = one_of_many(arguments, formula);
        all_well &= shown.is_ok();
        print(&shown.unwrap_or_else(|failure| failure))?;
    }
    Ok(if all_well { ExitCode::SUCCESS } else { ExitCode::from(MISTAKEN) })
}

fn one_of_many(arguments: &Automaton, formula: &str) -> Result<String, String> {
    let source = Source::new("formula", formula);
    let failure = |error: &Error| match arguments.format {
        Format::Json => json::failure(formula, error),
        _ => error.render(&source, Style::Plain),
    };
    let compiled =
        compile::formula(&source, Budget::SHOWN).map_err(|errors| failure(errors.first()))?;
    let automata = compiled.automata.first().ok_or_else(String::new)?;
    let dfa = selected(arguments, automata);
    match (arguments.format, arguments.explicit) {
        (Format::Json, true) => json::explicit(formula, dfa).map_err(|error| failure(&error)),
        (Format::Json, false) => Ok(json::summary(formula, dfa)),
        _ => Ok(text::automaton(formula, dfa)),
    }
}

fn selected<'a>(arguments: &Automaton, automata: &'a Automata) -> &'a Dfa {
    if arguments.propositional { &automata.propositional } else { &automata.dfa }
}

fn show(arguments: &Automaton, compiled: &Compiled, task: &Task, automata: &Automata) -> Outcome {
    let dfa = selected(arguments, automata);
    let title = task.name.as_deref().unwrap_or(&task.text);
    let written = match arguments.format {
        Format::Text => sizes(arguments, &task.text, automata),
        Format::Json if arguments.explicit => {
            json::explicit(&task.text, dfa).map_err(|error| error.to_string())?
        }
        Format::Json => json::automaton(&task.text, dfa),
        Format::Dot => dot::automaton(title, dfa),
        Format::Svg => svg::automaton(title, dfa),
        Format::Mermaid => mermaid::automaton(title, dfa),
        Format::Hoa => hoa::automaton(title, dfa),
        Format::Rust => rust::file(compiled),
    };
    print(&written)
}

/// The table of the automaton; where arithmetic has made it smaller, with both sizes.
fn sizes(arguments: &Automaton, title: &str, automata: &Automata) -> String {
    let dfa = selected(arguments, automata);
    let mut written = text::automaton(title, dfa);
    if !arguments.propositional && automata.dfa.possible.is_some() {
        written.push_str("\nwith the predicates taken for free propositions:\n");
        written.push_str(&text::sizes(automata.propositional.size()));
    }
    written
}
