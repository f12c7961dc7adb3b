//! Files and sources, and the reports about them.

use std::io::{Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::error::{Error, Errors, Style};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::{MISTAKEN, Outcome, Report, print};

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
    reported(&source, compile::file(&source, Budget::default()), Report::Human)
}

/// Checks each file; the exit code says whether all are free of mistakes.
pub(super) fn check(paths: &[PathBuf], report: Report) -> Outcome {
    let mut all_well = true;
    for path in paths {
        let source = Source::new(path.display().to_string(), read(path)?);
        let result = compile::file(&source, Budget::default());
        all_well &= reported(&source, result, report)?.is_some();
    }
    Ok(if all_well { ExitCode::SUCCESS } else { ExitCode::from(MISTAKEN) })
}

/// Reports mistakes and warnings; `None` if there were mistakes.
pub(super) fn reported(
    source: &Source,
    result: Result<Compiled, Errors>,
    report: Report,
) -> Result<Option<Compiled>, String> {
    if let Ok(compiled) = &result {
        let mut warnings = [compiled.warnings.clone(), compiled.advice()].concat();
        warnings.sort_by_key(Error::span);
        warnings.iter().try_for_each(|warning| show(source, warning, report))?;
    }
    judged(source, result, report)
}

/// Reports mistakes; `None` if there were any.
pub(super) fn judged<T>(
    source: &Source,
    result: Result<T, Errors>,
    report: Report,
) -> Result<Option<T>, String> {
    match result {
        Ok(good) => Ok(Some(good)),
        Err(errors) => {
            errors.iter().try_for_each(|error| show(source, error, report))?;
            Ok(None)
        }
    }
}

fn show(source: &Source, error: &Error, report: Report) -> Result<(), String> {
    match report {
        Report::Json => print(&tltl_compiler::emit::json::report(source, error)).map(|_| ()),
        Report::Human => {
            let style = if colourful(&std::io::stderr()) { Style::Coloured } else { Style::Plain };
            complain(&error.render(source, style));
            Ok(())
        }
    }
}

/// Whether a stream shows colours: it is a terminal, and `NO_COLOR` is not set.
pub(super) fn colourful(stream: &impl std::io::IsTerminal) -> bool {
    stream.is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// Writes a line to the standard error; that nobody reads it is no fault.
pub(super) fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
