//! Tasks out of their sources: bound, pickled by what they were compiled from, and compiled again.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl_compiler::source::Source;
use tltlc::task::{self, Bound as Made, TaskFile, Value};

use super::compiled::Compiled;
use super::error::{mistaken, wrong};
use super::factored::Factored;
use super::task::Task;
use super::values::Budget;

/// The task of `file` with this name and these arguments.
pub(crate) fn bound(
    file: &TaskFile,
    name: Option<&str>,
    arguments: &[(String, Value)],
) -> PyResult<Made> {
    let entry = file.find(name).map_err(|error| wrong(error.to_string()))?;
    let arguments: Vec<_> =
        arguments.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    entry.bind(&arguments).map_err(|error| wrong(error.to_string()))
}

/// What `restore` makes a task of.
pub(crate) fn reduced<'py>(
    py: Python<'py>,
    entry: &task::Entry,
    values: &[(String, Value)],
    budget: &Budget,
    fingerprint: &str,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
    let restore = py.import("tltl._core")?.getattr("restore")?;
    let arguments = PyDict::new(py);
    for (name, value) in values {
        match value {
            Value::Number(number) => arguments.set_item(name, number)?,
            Value::Truth(truth) => arguments.set_item(name, truth)?,
            Value::Text(text) => arguments.set_item(name, text)?,
        }
    }
    let source = entry.file().source();
    let form = match (entry.is_bare(), entry.is_automaton()) {
        (true, _) => "formula",
        (_, true) => "automaton",
        _ => "file",
    };
    let source = (form, source.name(), source.text());
    let state = (source, entry.name(), arguments.items(), budget.clone(), fingerprint);
    Ok((restore, state.into_pyobject(py)?))
}

/// A task of yesterday: compiled again, and compared by its numbered automaton.
#[pyfunction]
pub(crate) fn restore(
    py: Python<'_>,
    source: (String, String, String),
    name: Option<String>,
    arguments: Vec<(String, super::file::Argument)>,
    budget: Budget,
    fingerprint: &str,
) -> PyResult<Py<PyAny>> {
    let ((form, source, text), limits) = (source, budget.limits());
    let compiled = match &*form {
        "formula" => TaskFile::of_formula(&text, limits),
        "automaton" => TaskFile::of_automaton(Source::new(source, text)),
        _ => TaskFile::new(Source::new(source, text), limits),
    };
    let compiled = compiled.map_err(|error| mistaken(py, &error))?;
    let arguments: Vec<_> = arguments.into_iter().map(|(name, value)| (name, value.0)).collect();
    match bound(&compiled, name.as_deref(), &arguments)? {
        Made::Plain(inner) => {
            let task = Task::of(inner, budget);
            expect(task.written(), &task.fingerprint(), fingerprint)?;
            Ok(task.into_pyobject(py)?.into_any().unbind())
        }
        Made::Factored(inner) => {
            let prints: Vec<_> = inner.parts().iter().map(task::Task::fingerprint).collect();
            expect(&inner.entry().task().text, &prints.join(" "), fingerprint)?;
            Ok(Factored::new(inner, budget).into_pyobject(py)?.into_any().unbind())
        }
    }
}

/// An error unless the automaton is numbered as it was.
fn expect(text: &str, found: &str, fingerprint: &str) -> PyResult<()> {
    if found == fingerprint {
        return Ok(());
    }
    Err(wrong(format!(
        "`{text}` has another numbered automaton in this version: what was learned with it does not fit"
    )))
}

/// A product of yesterday, made again.
#[pyfunction]
pub(crate) fn restore_product(
    py: Python<'_>,
    operator: &str,
    operands: Vec<Bound<'_, PyAny>>,
    fingerprint: &str,
) -> PyResult<Task> {
    let operands = operands.iter().map(super::labelled::task_of).collect::<PyResult<_>>()?;
    let (task, _) = Task::product(py, super::product::operator(operator)?, operands)?;
    expect(task.written(), &task.fingerprint(), fingerprint)?;
    Ok(task)
}
