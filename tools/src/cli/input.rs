//! Reads sources and reports about them: `tltlc check`, and the first step of the other commands.
//!
//! Reports go to the error stream for people, and to the output as JSON for editors.

use std::path::{Path, PathBuf};

use tltl_compiler::dfa::Dfa;
use tltl_compiler::error::{Error, Errors};
use tltl_compiler::hoa;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use crate::emit::json;
use crate::task::{CompileError, TaskFile};

use super::{Exit, Outcome, Report, Streams};

/// A file without mistakes.
pub(super) enum File {
    /// A task file.
    Tasks(TaskFile),
    /// An automaton of another tool, in HOA.
    Automaton(Box<Foreign>),
}

/// An automaton that came without a formula.
pub(super) struct Foreign {
    /// What it is called: by its own name, or by the name of its file.
    pub(super) name: String,
    pub(super) dfa: Dfa,
}

/// Reads a file and reports its mistakes and warnings; `None` if there are mistakes.
pub(super) fn file(
    path: &Path,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Result<Option<File>, String> {
    let source = Source::new(path.display().to_string(), streams.read(path)?);
    compiled(path, source, budget, Report::Human, streams)
}

/// Checks each file; the exit code says whether all are free of mistakes. Warnings are reported and
/// do not count.
pub(super) fn check(
    paths: &[PathBuf],
    budget: Budget,
    report: Report,
    streams: &mut Streams<'_>,
) -> Outcome {
    let mut all_well = true;
    for path in paths {
        let source = Source::new(path.display().to_string(), streams.read(path)?);
        all_well &= compiled(path, source, budget, report, streams)?.is_some();
    }
    Ok(Exit::of(all_well))
}

/// Compiles a file. One that begins with `HOA:`, or is called so, is an automaton.
fn compiled(
    path: &Path,
    source: Source,
    budget: Budget,
    report: Report,
    streams: &mut Streams<'_>,
) -> Result<Option<File>, String> {
    let start = source.text().trim_start_matches('\u{feff}').trim_start();
    if start.starts_with("HOA:") || path.extension().is_some_and(|extension| extension == "hoa") {
        let read = hoa::read(&source).map_err(Errors::from);
        let read = judged(&source, read, report, streams)?;
        let stem = || path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let named =
            |read: hoa::Automaton| Foreign { name: read.name.unwrap_or_else(stem), dfa: read.dfa };
        return Ok(read.map(named).map(Box::new).map(File::Automaton));
    }
    let tasks = reported(TaskFile::new(source, budget), report, streams)?;
    Ok(tasks.map(File::Tasks))
}

/// Reports mistakes, or warnings if there are none; `None` if there are mistakes.
pub(super) fn reported(
    result: Result<TaskFile, CompileError>,
    report: Report,
    streams: &mut Streams<'_>,
) -> Result<Option<TaskFile>, String> {
    match result {
        Ok(file) => {
            let mut warnings = file.warnings().into_iter();
            warnings.try_for_each(|warning| show(file.source(), &warning, report, streams))?;
            Ok(Some(file))
        }
        Err(error) => judged(error.source_text(), Err(error.errors().clone()), report, streams),
    }
}

/// Reports the mistakes of any stage; `None` if there are any.
pub(super) fn judged<T>(
    source: &Source,
    result: Result<T, Errors>,
    report: Report,
    streams: &mut Streams<'_>,
) -> Result<Option<T>, String> {
    match result {
        Ok(good) => Ok(Some(good)),
        Err(errors) => {
            errors.iter().try_for_each(|error| show(source, error, report, streams))?;
            Ok(None)
        }
    }
}

/// Reports one mistake or warning.
fn show(
    source: &Source,
    error: &Error,
    report: Report,
    streams: &mut Streams<'_>,
) -> Result<(), String> {
    match report {
        Report::Json => streams.print(&json::report(source, error)).map(|_| ()),
        Report::Human => {
            let text = error.render(source, streams.err.style);
            streams.report(&text);
            Ok(())
        }
    }
}
