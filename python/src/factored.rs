//! `tltl.Factored`: a task whose parts run side by side.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::reward::{End, Ends, JointEnds};
use tltl::{Acceptor, Shared};
use tltlc::evaluate::{Columns, Evaluator, NotANumber, Scratch};
use tltlc::task;

use super::array::{Array, shaped};
use super::compiled::Compiled;
use super::error::wrong;
use super::labelled::Row;
use super::labels::{self, Names};
use super::task::Task;
use super::values::{Budget, Run};

/// A conjunction whose parts run side by side (`#[factored]` in a task file): n goals in any order are n
/// automata of two states, and not one of 2^n.
///
/// A state is an array of one automaton state for each part: uint32, of shape (parts,). The task is
/// satisfied when every part is, and lost when one part is.
///
/// >>> from tltl import TaskFile
/// >>> file = TaskFile.from_text("state S { a: bool, b: bool } #[factored] task tour = F a && F b")
/// >>> tour = file.task()
/// >>> q = tour.step(tour.initial, {"a": True, "b": False})
/// >>> q.tolist(), tour.is_satisfied(q), tour.is_satisfied(tour.step(q, {"b"}))
/// ([1, 0], False, True)
#[pyclass(frozen, module = "tltl")]
pub struct Factored {
    pub(crate) inner: task::Factored,
    budget: Budget,
    propositions: Vec<Shared<str>>,
    names: Names,
    /// Where its parts end, which rewards ask at every step.
    pub(crate) ends: JointEnds,
    /// The same task over rows of the robustness of its propositions.
    pub(crate) rows: tltl::Factored<Row>,
}

impl Factored {
    pub(crate) fn new(inner: task::Factored, budget: Budget) -> Self {
        let spec = &inner.entry().task().spec;
        let propositions: Vec<Shared<str>> =
            spec.propositions().iter().map(|one| Shared::from(one.name.clone())).collect();
        let ends = JointEnds::new(inner.parts().iter().map(Ends::of).collect());
        let rows = inner.monitor().with_predicates(Row);
        let names = Names::new(&propositions);
        Self { inner, budget, propositions, names, ends, rows }
    }

    /// States of shape (parts,) or (n, parts), checked, row after row, with their shape.
    pub(crate) fn states_of(&self, q: &Bound<'_, PyAny>) -> PyResult<(Vec<u32>, Vec<usize>)> {
        let array = Array::new(q, "q")?;
        let (shape, count) = (array.view().shape, self.inner.parts().len());
        if !matches!(shape[..], [parts] | [_, parts] if parts == count) {
            let wanted = format!("wanted is ({count},) or (n, {count})");
            return Err(wrong(format!("q: an array of shape {shape:?}; {wanted}")));
        }
        let states = array.naturals();
        let states =
            states.ok_or_else(|| wrong("q: automaton states are whole numbers from 0 on"))?;
        for (at, &q) in states.iter().enumerate() {
            let part = at % count;
            let states = self.inner.parts()[part].states();
            if q >= u64::from(states) {
                return Err(pyo3::exceptions::PyIndexError::new_err(format!(
                    "q is {q} in part {part}, whose automaton has {states} states"
                )));
            }
        }
        Ok((states.iter().map(|&q| q as u32).collect(), shape))
    }

    /// A truth value for each state.
    fn judged<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        judge: impl Fn(&[u32]) -> bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, (states, shape)) = (q.py(), self.states_of(q)?);
        if shape.len() == 1 {
            return Ok(judge(&states).into_pyobject(py)?.to_owned().into_any());
        }
        let rows = states.chunks_exact(self.inner.parts().len());
        let all: Vec<bool> = rows.map(judge).collect();
        let count = all.len();
        shaped(py, all, &[count])
    }
}

impl Compiled for Factored {
    fn entry(&self) -> &task::Entry {
        self.inner.entry()
    }

    fn evaluator(&self) -> &Evaluator {
        self.inner.evaluator()
    }

    fn propositions(&self) -> &[Shared<str>] {
        &self.propositions
    }

    fn names(&self) -> &Names {
        &self.names
    }

    fn parts(&self) -> Option<usize> {
        Some(self.inner.parts().len())
    }

    fn follow(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
    ) -> Result<task::Run, NotANumber> {
        self.inner.run(columns, scratch)
    }
}

#[pymethods]
impl Factored {
    /// The formula, without comments and laid out anew.
    #[getter]
    fn text(&self) -> &str {
        self.written()
    }

    /// Its name in the task file.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.inner.entry().name()
    }

    /// Its parts, each a task of its own.
    #[getter]
    #[pyo3(name = "parts")]
    fn part_tasks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let parts = self.inner.parts().iter();
        PyTuple::new(py, parts.map(|part| Task::of(part.clone(), self.budget.clone())))
    }

    /// The names of what any part reads, in the order of the columns of labels.
    #[getter]
    fn propositions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.listed_propositions(py)
    }

    /// What the predicates read from a state, in the order of the columns.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.listed_inputs(py)
    }

    /// How long a step lasts, in seconds, if the task file says it; as for `Task`.
    #[getter]
    fn step_seconds(&self) -> Option<f64> {
        self.seconds()
    }

    /// The state before anything is read: uint32, of shape (parts,).
    #[getter]
    fn initial<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let count = self.inner.parts().len();
        shaped(py, vec![tltl::Automaton::INITIAL; count], &[count])
    }

    /// The state after `q` has read what holds; `labels` as for `Task.step`.
    ///
    /// Raises `ValueError` if a proposition is missing, `IndexError` if `q` is not a state.
    fn step<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (mut states, shape) = self.states_of(q)?;
        if shape.len() != 1 {
            return Err(wrong("q: one state is wanted; `step_batch` takes many"));
        }
        self.inner.step_batch(&mut states, &self.row(labels)?);
        shaped(q.py(), states, &shape)
    }

    /// The states after `q`, of shape (n, parts), has read `labels`, truth values of shape (n,
    /// propositions).
    fn step_batch<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, (mut states, shape)) = (q.py(), self.states_of(q)?);
        let array = Array::new(labels, "labels")?;
        let wanted = [shape[0], self.propositions.len()];
        if shape.len() != 2 || array.view().shape != wanted {
            let found = array.view().shape;
            return Err(wrong(format!(
                "labels: an array of shape {found:?}; wanted is {wanted:?}"
            )));
        }
        let rows = labels::truths(&self.propositions, &array)?;
        py.detach(|| self.inner.step_batch(&mut states, &rows));
        shaped(py, states, &shape)
    }

    /// Whether the task is satisfied at `q`, of shape (parts,), or at each of many, of shape (n, parts).
    fn is_satisfied<'py>(&self, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.judged(q, |q| self.ends.end(q) == Some(End::Accepted))
    }

    /// Whether the task is lost at `q`, whatever comes after it; shapes as for `is_satisfied`.
    fn is_lost<'py>(&self, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.judged(q, |q| self.ends.end(q) == Some(End::Lost))
    }

    /// Which propositions hold in each of `states`; arguments as for `Task.labels`.
    #[pyo3(signature = (states, *, columns=None))]
    fn labels<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.labels_of(states, columns)
    }

    /// The robustness of each proposition in each of `states`, as `labels`: float64.
    #[pyo3(signature = (states, *, columns=None))]
    fn rho<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.rho_of(states, columns)
    }

    /// A trajectory of shape (T, d), followed row by row; `states` of the result has shape (T, parts).
    #[pyo3(signature = (states, *, columns=None))]
    fn run(&self, states: &Bound<'_, PyAny>, columns: Option<&Bound<'_, PyAny>>) -> PyResult<Run> {
        self.run_of(states, columns)
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let prints: Vec<_> = self.inner.parts().iter().map(task::Task::fingerprint).collect();
        let (entry, arguments) = (self.inner.entry(), self.inner.arguments());
        super::restore::reduced(py, entry, arguments, &self.budget, &prints.join(" "))
    }

    fn __repr__(&self) -> String {
        let (name, parts) = (self.name().unwrap_or_default(), self.inner.parts().len());
        format!("<Factored {name} = {}: {parts} parts>", self.text())
    }
}
