//! Reads sources and reports about them: `tltlc check`, and the first step of the other commands.
//!
//! Reports go to the error stream for people, and to the output as JSON for editors.

use std::path::{Path, PathBuf};

use tltl_compiler::error::{Error, Errors};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use crate::emit::json;
use crate::task::{CompileError, TaskFile};

use super::{Exit, Outcome, Report, Streams};

/// Compiles a task file and reports its mistakes and warnings; `None` if there are mistakes.
pub(super) fn file(path: &Path, streams: &mut Streams<'_>) -> Result<Option<TaskFile>, String> {
    let source = Source::new(path.display().to_string(), streams.read(path)?);
    reported(TaskFile::new(source, Budget::default()), Report::Human, streams)
}

/// Checks each file; the exit code says whether all are free of mistakes. Warnings are reported and
/// do not count.
pub(super) fn check(paths: &[PathBuf], report: Report, streams: &mut Streams<'_>) -> Outcome {
    let mut all_well = true;
    for path in paths {
        let source = Source::new(path.display().to_string(), streams.read(path)?);
        let result = TaskFile::new(source, Budget::default());
        all_well &= reported(result, report, streams)?.is_some();
    }
    Ok(Exit::of(all_well))
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
