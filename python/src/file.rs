//! `tltl.load`: task files, whose tasks may take arguments.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use tltl_compiler::source::Source;
use tltlc::task::{self, Bound as Bind, Value};

use super::error::{diagnostics, mistaken, warn};
use super::factored::Factored;
use super::restore::bound;
use super::task::Task;
use super::values::Budget;

/// A value for a parameter.
pub(crate) struct Argument(pub(crate) Value);

impl<'py> FromPyObject<'_, 'py> for Argument {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(truth) = object.cast::<PyBool>() {
            return Ok(Self(Value::Truth(truth.is_true())));
        }
        if let Ok(text) = object.extract::<String>() {
            return Ok(Self(Value::Text(text)));
        }
        let number = object.extract::<f64>();
        number.map(|number| Self(Value::Number(number))).map_err(|_| {
            PyTypeError::new_err("an argument is a number, a truth value or the text of a value")
        })
    }
}

/// A parameter of a task.
#[pyclass(frozen, eq, get_all, module = "tltl")]
#[derive(Clone, PartialEq, Eq)]
pub struct Parameter {
    /// Its name.
    name: String,
    /// Its type, as text.
    r#type: String,
    /// Its unit, if the file gives one.
    unit: Option<String>,
    /// The names of the values of an enumeration; else empty.
    values: Vec<String>,
}

#[pymethods]
impl Parameter {
    fn __repr__(&self) -> String {
        format!("Parameter(name={:?}, type={:?})", self.name, self.r#type)
    }
}

/// A task file, compiled.
#[pyclass(frozen, module = "tltl")]
pub struct TaskFile {
    inner: task::TaskFile,
    budget: Budget,
}

#[pymethods]
impl TaskFile {
    /// The file of this text, which messages call `name`.
    #[staticmethod]
    #[pyo3(signature = (text, /, *, name="text", budget=None))]
    fn from_text(py: Python<'_>, text: &str, name: &str, budget: Option<Budget>) -> PyResult<Self> {
        let budget = budget.unwrap_or_default();
        let limits = budget.limits();
        let source = Source::new(name, text);
        let (inner, warnings) = py
            .detach(|| {
                let inner = task::TaskFile::new(source, limits)?;
                let warnings = inner.warnings();
                Ok((inner, warnings))
            })
            .map_err(|error| mistaken(py, &error))?;
        warn(py, inner.source(), &warnings)?;
        Ok(Self { inner, budget })
    }

    /// What the author should look at.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, pyo3::types::PyTuple>> {
        diagnostics(py, self.inner.source(), &self.inner.warnings())
    }

    /// The names of its tasks, each with its parameters.
    #[getter]
    fn tasks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tasks = PyDict::new(py);
        for entry in self.inner.entries() {
            let parameter = |known: task::Parameter| {
                let task::Parameter { name, ty, unit, values } = known;
                Parameter { name, r#type: ty, unit, values }
            };
            let parameters = entry.parameters().into_iter().map(parameter);
            let parameters = pyo3::types::PyTuple::new(py, parameters.collect::<Vec<_>>())?;
            tasks.set_item(entry.name(), parameters)?;
        }
        Ok(tasks)
    }

    /// The task of this name with these values for its parameters; without a name the only task.
    ///
    /// A task that is marked `#[factored]` is a `Factored`. A parameter is a number, a truth value, or the name of a value of its enumeration. Raises
    /// `ValueError` if the file has no such task, or it takes other arguments.
    ///
    /// >>> from tltl import TaskFile
    /// >>> file = TaskFile.from_text("state S { x: f64 } task far(d: f64) = F x > d")
    /// >>> file.task("far", d=2.5).satisfied([[1.0], [3.0]])
    /// True
    #[pyo3(signature = (name=None, /, **arguments))]
    fn task<'py>(
        &self,
        py: Python<'py>,
        name: Option<&str>,
        arguments: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let mut values = Vec::new();
        for (name, value) in arguments.into_iter().flatten() {
            values.push((name.extract()?, value.extract::<Argument>()?.0));
        }
        let budget = self.budget.clone();
        match bound(&self.inner, name, &values)? {
            Bind::Plain(inner) => Ok(Task::of(inner, budget).into_pyobject(py)?.into_any()),
            Bind::Factored(inner) => Ok(Factored::new(inner, budget).into_pyobject(py)?.into_any()),
        }
    }

    fn __repr__(&self) -> String {
        let names = self.inner.entries().filter_map(|entry| entry.name().map(str::to_owned));
        format!(
            "<TaskFile {}: {}>",
            self.inner.source().name(),
            names.collect::<Vec<_>>().join(", ")
        )
    }
}
