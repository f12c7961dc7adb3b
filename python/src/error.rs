//! Mistakes of a source, as Python's exceptions and warnings. Their classes are Python's, so that
//! they pickle and print as its own do: `tltl/_errors.py`.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::Shared;
use tltl_compiler::error::Error;
use tltl_compiler::source::{Source, Span};
use tltlc::evaluate::NotANumber;
use tltlc::task::CompileError;

/// A class of `tltl._errors`.
fn class<'py>(py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    py.import("tltl._errors")?.getattr(name)
}

/// A span in characters, which is how Python counts.
fn characters(source: &Source, span: Span) -> (usize, usize) {
    let count = |end: usize| source.text()[..end].chars().count();
    (count(span.start), count(span.end))
}

/// The mistakes and warnings of `source` as a tuple of `Diagnostic`.
pub(crate) fn diagnostics<'py, 'a>(
    py: Python<'py>,
    source: &Source,
    errors: impl IntoIterator<Item = &'a Error>,
) -> PyResult<Bound<'py, PyTuple>> {
    let class = class(py, "Diagnostic")?;
    let diagnostic = |error: &Error| {
        let place = source.place(error.span().start);
        let related = error.places().iter();
        let related = related.map(|(span, label)| (characters(source, *span), label.clone()));
        class.call1((
            error.kind().name(),
            if error.is_warning() { "warning" } else { "error" },
            error.message(),
            characters(source, error.span()),
            place.line,
            place.column,
            error.place_label(),
            PyTuple::new(py, related.collect::<Vec<_>>())?,
            PyTuple::new(py, error.helps())?,
        ))
    };
    let all: PyResult<Vec<_>> = errors.into_iter().map(diagnostic).collect();
    PyTuple::new(py, all?)
}

/// The exception of a source with mistakes.
pub(crate) fn mistaken(py: Python<'_>, error: &CompileError) -> PyErr {
    let make = || {
        let all = diagnostics(py, error.source_text(), error.errors().iter())?;
        let text = error.to_string();
        class(py, "CompileError")?.call1((text.trim_end(), all))
    };
    make().map_or_else(|error| error, PyErr::from_value)
}

/// Warns of each of the `warnings`, with its lines of the source.
pub(crate) fn warn(py: Python<'_>, source: &Source, warnings: &[Error]) -> PyResult<()> {
    let category = class(py, "TaskWarning")?;
    for warning in warnings {
        let text = warning.render(source, tltl_compiler::error::Style::Plain);
        let warn = py.import("warnings")?.getattr("warn")?;
        warn.call1((text.trim_end(), &category, 2))?;
    }
    Ok(())
}

/// An argument that is not one.
pub(crate) fn wrong(message: impl Into<String>) -> PyErr {
    PyValueError::new_err(message.into())
}

/// A predicate that is not a number in a row.
pub(crate) fn not_a_number(propositions: &[Shared<str>], error: NotANumber) -> PyErr {
    let name = propositions.get(error.predicate as usize).map_or("?", |name| name);
    wrong(format!("`{name}` is not a number (NaN) in row {}", error.row))
}
