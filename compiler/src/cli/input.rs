//! Files and sources, and the reports about them.

use std::io::{IsTerminal as _, Read as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::error::{Error, Errors, Style};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::{Outcome, Report};

/// The text of a file, or of the standard input if the path is `-`.
pub(super) fn read(path: &Path) -> Result<String, String> {
    let mut text = String::new();
    if path == Path::new("-") {
        std::io::stdin().read_to_string(&mut text).map(|_| text)
    } else {
        std::fs::read_to_string(path)
    }
    .map_err(|error| format!("cannot read {}: {error}", path.display()))
}

/// Compiles a task file, its mistakes and warnings reported.
pub(super) fn file(path: &Path) -> Result<Option<Compiled>, String> {
    let source = Source::new(path.display().to_string(), read(path)?);
    Ok(reported(&source, compile::file(&source, Budget::default()), Report::Human))
}

/// Checks each file; the exit code says whether all are free of mistakes.
pub(super) fn check(paths: &[PathBuf], report: Report) -> Outcome {
    let mut all_well = true;
    for path in paths {
        let source = Source::new(path.display().to_string(), read(path)?);
        let result = compile::file(&source, Budget::default());
        all_well &= reported(&source, result, report).is_some();
    }
    Ok(if all_well { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// Reports mistakes and warnings; `None` if there were mistakes.
pub(super) fn reported(
    source: &Source,
    result: Result<Compiled, Errors>,
    report: Report,
) -> Option<Compiled> {
    match result {
        Ok(compiled) => {
            compiled.warnings.iter().for_each(|warning| show(source, warning, report));
            Some(compiled)
        }
        Err(errors) => {
            errors.iter().for_each(|error| show(source, error, report));
            None
        }
    }
}

fn show(source: &Source, error: &Error, report: Report) {
    match report {
        Report::Json => println!("{}", tltl_compiler::emit::json::report(source, error)),
        Report::Human => {
            let colour = std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
            let style = if colour { Style::Coloured } else { Style::Plain };
            eprintln!("{}", error.render(source, style));
        }
    }
}
