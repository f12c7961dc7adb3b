//! `tltl.Factored`: a task whose parts run side by side.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::Acceptor;
use tltlc::evaluate::{self, Columns, Scratch};
use tltlc::task;

use super::array::{Array, shaped};
use super::error::{not_a_number, wrong};
use super::labels;
use super::states::States;
use super::task::Task;
use super::values::{Budget, Input};

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
    inner: task::Factored,
    budget: Budget,
}

impl Factored {
    pub(crate) const fn new(inner: task::Factored, budget: Budget) -> Self {
        Self { inner, budget }
    }

    fn names(&self) -> Vec<tltl::Shared<str>> {
        let spec = &self.inner.entry().task().spec;
        spec.propositions().iter().map(|one| tltl::Shared::from(one.name.clone())).collect()
    }

    /// States of shape (parts,) or (n, parts), checked, row after row, with their shape.
    fn states_of(&self, q: &Bound<'_, PyAny>) -> PyResult<(Vec<u32>, Vec<usize>)> {
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

    /// Computes for each trajectory, without the GIL.
    fn each<T: Send>(
        &self,
        py: Python<'_>,
        states: &States<'_>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, evaluate::NotANumber> + Sync,
    ) -> PyResult<Vec<T>> {
        let results = states.each(py, compute);
        results.map_err(|error| not_a_number(&self.names(), error))
    }
}

#[pymethods]
impl Factored {
    /// The formula, as it was written.
    #[getter]
    fn text(&self) -> &str {
        &self.inner.entry().task().text
    }

    /// Its name in the task file.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.inner.entry().name()
    }

    /// Its parts, each a task of its own.
    #[getter]
    fn parts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let parts = self.inner.parts().iter();
        PyTuple::new(py, parts.map(|part| Task::of(part.clone(), self.budget.clone())))
    }

    /// The names of what any part reads, in the order of the columns of labels.
    #[getter]
    fn propositions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.names().iter().map(|name| name.to_string()))
    }

    /// What the predicates read from a state, in the order of the columns.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.inner.inputs().iter().map(Input::new))
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
        let rho = labels::robustness(&self.names(), labels)?;
        let row: Vec<bool> = rho.iter().map(|&rho| rho > 0.0).collect();
        self.inner.step_batch(&mut states, &row);
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
        let (names, array) = (self.names(), Array::new(labels, "labels")?);
        let wanted = [shape[0], names.len()];
        if shape.len() != 2 || array.view().shape != wanted {
            let found = array.view().shape;
            return Err(wrong(format!(
                "labels: an array of shape {found:?}; wanted is {wanted:?}"
            )));
        }
        let rows = labels::truths(&names, &array)?;
        py.detach(|| self.inner.step_batch(&mut states, &rows));
        shaped(py, states, &shape)
    }

    /// Whether the task is satisfied at `q`, of shape (parts,), or at each of many, of shape (n, parts).
    fn is_satisfied<'py>(&self, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.judged(q, |q| self.inner.monitor().is_accepting(q))
    }

    /// Whether the task is lost at `q`, whatever comes after it; shapes as for `is_satisfied`.
    fn is_lost<'py>(&self, q: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        self.judged(q, |q| self.inner.monitor().is_lost(q))
    }

    /// Which propositions hold in each of `states`; arguments as for `Task.labels`.
    #[pyo3(signature = (states, *, columns=None))]
    fn labels<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (py, width) = (states.py(), self.names().len());
        let states = States::new(self.inner.inputs(), states, columns)?;
        let each = self.each(py, &states, |columns, scratch| {
            let mut out = vec![false; columns.rows() * width];
            self.inner.evaluator().labels(columns, scratch, &mut out).map(|()| out)
        })?;
        let shape: Vec<usize> = states.shape.iter().copied().chain([width]).collect();
        shaped(py, each.concat(), &shape)
    }

    /// A trajectory of shape (T, d), followed row by row; `states` of the result has shape (T, parts).
    #[pyo3(signature = (states, *, columns=None))]
    fn run(
        &self,
        py: Python<'_>,
        states: &Bound<'_, PyAny>,
        columns: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<super::values::Run> {
        let states = States::new(self.inner.inputs(), states, columns)?;
        if states.shape.len() != 1 {
            return Err(wrong("states: one trajectory is wanted, an array of shape (T, d)"));
        }
        let runs = self.each(py, &states, |columns, scratch| self.inner.run(columns, scratch))?;
        let run = runs.into_iter().next().expect("a shape of one axis is one trajectory");
        let (verdict, since, rows) = (run.verdict().to_string(), run.since(), run.verdicts.len());
        Ok(super::values::Run {
            states: shaped(py, run.states, &[rows, self.inner.parts().len()])?.unbind(),
            progress: shaped(py, run.progress, &[rows])?.unbind(),
            robustness: run.robustness,
            verdict,
            since,
        })
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let prints: Vec<_> = self.inner.parts().iter().map(task::Task::fingerprint).collect();
        let (entry, arguments) = (self.inner.entry(), self.inner.arguments());
        super::task::reduced(py, entry, arguments, &self.budget, &prints.join(" "))
    }

    fn __repr__(&self) -> String {
        let (name, parts) = (self.name().unwrap_or_default(), self.inner.parts().len());
        format!("<Factored {name} = {}: {parts} parts>", self.text())
    }
}
