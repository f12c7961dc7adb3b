//! Reads sources and reports about them: `tltlc check`, and the first step of the other commands.
//!
//! Reports go to the error stream for people, and to the output as JSON for editors.

use std::path::{Path, PathBuf};

use tltl_compiler::error::{Error, Errors};
use tltl_compiler::predicate::Module;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use crate::emit::json;
use crate::task::{CompileError, TaskFile};

use super::streams::read_once;
use super::{Exit, Outcome, Report, Streams};

/// What can be made of a source.
pub(super) enum Made<T> {
    /// All that was asked for.
    Whole(T),
    /// Nothing, for it has mistakes, which were reported.
    Mistaken,
    /// No automata, which are larger than the budget allows. This was not reported.
    TooLarge(CompileError, Box<Module>),
}

impl<T> Made<T> {
    /// The same, where only the whole will do: what is too large is reported as a mistake.
    pub(super) fn whole(self, streams: &mut Streams<'_>) -> Result<Option<T>, String> {
        match self {
            Self::Whole(whole) => Ok(Some(whole)),
            Self::Mistaken => Ok(None),
            Self::TooLarge(error, _) => mistaken(&error, Report::Human, streams),
        }
    }

    /// The same with something else in the place of the whole.
    pub(super) fn map<U>(
        self,
        map: impl FnOnce(T) -> Result<U, String>,
    ) -> Result<Made<U>, String> {
        Ok(match self {
            Self::Whole(whole) => Made::Whole(map(whole)?),
            Self::Mistaken => Made::Mistaken,
            Self::TooLarge(error, module) => Made::TooLarge(error, module),
        })
    }
}

/// Reads a file for one of its tasks, or for all of them, and reports its mistakes and warnings.
pub(super) fn file(
    path: &Path,
    task: Option<&str>,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Result<Made<TaskFile>, String> {
    let source = Source::new(path.display().to_string(), streams.read(path)?);
    let file = match task {
        _ if is_automaton(path, &source) => TaskFile::of_automaton(source),
        Some(task) => TaskFile::with_task(source, task, budget),
        None => TaskFile::new(source, budget),
    };
    made(file, streams)
}

/// Reports mistakes, or warnings if there are none, but not that an automaton is too large.
pub(super) fn made(
    result: Result<TaskFile, CompileError>,
    streams: &mut Streams<'_>,
) -> Result<Made<TaskFile>, String> {
    if let Err(error) = &result
        && let Some(module) = error.module()
    {
        return Ok(Made::TooLarge(error.clone(), Box::new(module)));
    }
    Ok(reported(result, Report::Human, streams)?.map_or(Made::Mistaken, Made::Whole))
}

/// Checks each file; the exit code says whether all are free of mistakes. Warnings are reported and
/// do not count.
pub(super) fn check(
    paths: &[PathBuf],
    budget: Budget,
    report: Report,
    streams: &mut Streams<'_>,
) -> Outcome {
    read_once(paths.iter().map(PathBuf::as_path))?;
    let mut all_well = true;
    for path in paths {
        let source = Source::new(path.display().to_string(), streams.read(path)?);
        let file = match is_automaton(path, &source) {
            true => TaskFile::of_automaton(source),
            false => TaskFile::new(source, budget),
        };
        all_well &= reported(file, report, streams)?.is_some();
    }
    Ok(Exit::of(all_well))
}

/// Whether a file is an automaton of another tool: it begins with `HOA:`, or is called so.
fn is_automaton(path: &Path, source: &Source) -> bool {
    let start = source.text().trim_start_matches('\u{feff}').trim_start();
    start.starts_with("HOA:") || path.extension().is_some_and(|extension| extension == "hoa")
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
        Err(error) => mistaken(&error, report, streams),
    }
}

/// Reports the mistakes of a source.
fn mistaken<T>(
    error: &CompileError,
    report: Report,
    streams: &mut Streams<'_>,
) -> Result<Option<T>, String> {
    judged(error.source_text(), Err(error.errors().clone()), report, streams)
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
