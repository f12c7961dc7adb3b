//! `tltl.Policy`: an action for each automaton state and state, saved, loaded and emitted as Rust.

use std::path::PathBuf;

use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::policy::Policy as Table;
use tltl::solve::Problem;
use tltlc::emit;

use super::array::{Array, frozen, shaped};
use super::certificate::Certificate;
use super::document;
use super::error::wrong;
use super::labelled::{labelled, task_of};
use super::model::FiniteModel;

/// A policy for a task in a finite world: an action for each automaton state and state of the world.
///
/// It knows its task as a table, so it runs without the formula: `reset` reads the first state of an
/// episode, `next` each state that is arrived at, and `act` (or a call) gives the action.
///
/// >>> from tltl import FiniteModel, solve
/// >>> # Three cells in a row: action 0 stays, action 1 goes right.
/// >>> model = FiniteModel.from_arrays(
/// ...     [0, 1, 2, 3, 4, 5, 6], [0, 1, 1, 2, 2, 2], [1.0] * 6, actions=2
/// ... )
/// >>> policy = solve(model, "F end", lambda s: {"end": s == 2}).policy
/// >>> s, q = 0, policy.reset(0)
/// >>> while not policy.is_over(q):
/// ...     s += policy(q, s)
/// ...     q = policy.next(q, s)
/// >>> s
/// 2
#[pyclass(frozen, eq, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct Policy(pub(crate) Table);

/// A state of the automaton and one of the world, checked.
pub(crate) fn pair(task: &tltl::augmented::Labelled, q: i64, s: i64) -> PyResult<(u32, usize)> {
    let (automaton, states, given) = (task.automaton_states(), task.states(), (q, s));
    let outside = |name: &str, found: i64, what: &str, count: usize| {
        PyIndexError::new_err(format!("{name} is {found}, and the {what} has {count} states"))
    };
    let q = u32::try_from(q).ok().filter(|&q| q < automaton);
    let q = q.ok_or_else(|| outside("q", given.0, "automaton", automaton as usize))?;
    let s = usize::try_from(s).ok().filter(|&s| s < states);
    Ok((q, s.ok_or_else(|| outside("s", given.1, "world", states))?))
}

/// A policy for `task`: one of its own kind, an array of actions of shape (automaton states,
/// states), or a function of the two.
pub(crate) fn policy_of(
    task: &tltl::augmented::Labelled,
    policy: &Bound<'_, PyAny>,
) -> PyResult<Table> {
    if let Ok(policy) = policy.cast::<Policy>() {
        return Ok(policy.get().0.clone());
    }
    let (automaton, states) = (task.automaton_states() as usize, task.states());
    let actions: Vec<usize> = if policy.is_callable() {
        let pairs = (0..automaton).flat_map(|q| (0..states).map(move |s| (q, s)));
        pairs.map(|pair| policy.call1(pair)?.extract()).collect::<PyResult<_>>()?
    } else {
        let array = Array::new(policy, "policy")?;
        let shape = array.shape();
        if *shape != [automaton, states] {
            return Err(wrong(format!(
                "policy: an array of shape {shape:?}; wanted is ({automaton}, {states}), an action \
                 for each automaton state and state"
            )));
        }
        let actions = array.naturals();
        let actions =
            actions.ok_or_else(|| wrong("policy: actions are whole numbers from 0 on"))?;
        actions.iter().map(|&a| usize::try_from(a).unwrap_or(usize::MAX)).collect()
    };
    Table::new(task, actions).map_err(|error| wrong(error.to_string()))
}

impl Policy {
    fn shape(&self) -> [usize; 2] {
        [self.0.task().automaton_states() as usize, self.0.task().states()]
    }

    fn actions(&self) -> Vec<i64> {
        let [automaton, _] = self.shape();
        (0..automaton as u32).flat_map(|q| self.0.sub_policy(q)).map(|a| a as i64).collect()
    }

    fn read(text: &str) -> PyResult<Self> {
        document::parsed(serde_json::from_str(text)).map(Self)
    }
}

#[pymethods]
impl Policy {
    /// The policy of a document, as `to_json` writes it.
    ///
    /// Raises `ValueError` if it is not one; the message names the field.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        Self::read(text)
    }

    /// The document of the policy, which `tltlc policy` reads too.
    fn to_json(&self) -> PyResult<String> {
        document::parsed(serde_json::to_string(&self.0))
    }

    /// Writes the document to a file, which is replaced as a whole.
    ///
    /// Raises `OSError` if it cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        document::save(py, &path, &self.to_json()?)
    }

    /// The policy that `save` wrote.
    ///
    /// Raises `ValueError` if the file holds no policy, and `OSError` if it cannot be read.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Self::read(&document::load(py, path)?)
    }

    /// The policy as Rust source that needs no standard library and nothing of this package; with a
    /// `path` it is written there too.
    #[pyo3(signature = (path=None))]
    fn emit_rust(&self, py: Python<'_>, path: Option<PathBuf>) -> PyResult<String> {
        document::emitted(py, emit::policy::source(&self.0), path)
    }

    /// The action in state `s` of the world at state `q` of the automaton.
    ///
    /// Raises `IndexError` if there is no such state.
    fn act(&self, q: i64, s: i64) -> PyResult<usize> {
        let (q, s) = pair(self.0.task(), q, s)?;
        Ok(self.0.act(q, s))
    }

    fn __call__(&self, q: i64, s: i64) -> PyResult<usize> {
        self.act(q, s)
    }

    /// The automaton state after `s`, the first state of an episode, was read.
    fn reset(&self, s: i64) -> PyResult<u32> {
        let (_, s) = pair(self.0.task(), 0, s)?;
        Ok(self.0.reset(s))
    }

    /// The automaton state after `q` has read `s`.
    fn next(&self, q: i64, s: i64) -> PyResult<u32> {
        let (q, s) = pair(self.0.task(), q, s)?;
        Ok(self.0.next(q, s))
    }

    /// Whether the task is satisfied or lost at `q`.
    fn is_over(&self, q: i64) -> PyResult<bool> {
        let (q, _) = pair(self.0.task(), q, 0)?;
        Ok(self.0.end(q).is_some())
    }

    /// All actions: int64, of shape (automaton states, states).
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frozen(py, self.actions(), &self.shape())
    }

    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if copy == Some(false) {
            return Err(wrong("the table of a policy is copied into an array"));
        }
        let table = shaped(py, self.actions(), &self.shape())?;
        match dtype {
            Some(dtype) => table.call_method1("astype", (dtype,)),
            None => Ok(table),
        }
    }

    /// The name of its task.
    #[getter]
    fn name(&self) -> &str {
        self.0.task().name()
    }

    /// The formula of its task.
    #[getter]
    fn formula(&self) -> &str {
        self.0.task().formula()
    }

    /// What it is worth, if it says so.
    #[getter]
    fn certificate(&self) -> Option<Certificate> {
        self.0.certificate().map(Certificate::of)
    }

    /// How it was learned: for each skill a mapping with `task`, `steps`, `episodes` and `seed`;
    /// nothing if it was computed.
    #[getter]
    fn training<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let each = self.0.training().iter().map(|training| {
            let told = PyDict::new(py);
            told.set_item("task", &*training.task)?;
            told.set_item("steps", training.steps)?;
            told.set_item("episodes", training.episodes)?;
            told.set_item("seed", training.seed)?;
            Ok(told)
        });
        PyTuple::new(py, each.collect::<PyResult<Vec<_>>>()?)
    }

    /// Nothing, if it is a policy for this task in this world; `labels` as for `solve`.
    ///
    /// Raises `ValueError` if the automaton moves differently on some state of the world.
    fn check(
        &self,
        model: &FiniteModel,
        task: &Bound<'_, PyAny>,
        labels: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let own = labelled(&model.named(labels.py())?, &task_of(task)?, labels, None)?;
        let problem = Problem::new(&model.dynamics, &own);
        let fits = problem.and_then(|problem| problem.satisfied_within(&self.0, 0));
        fits.map(|_| ()).map_err(|error| wrong(error.to_string()))
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let load = py.import("tltl")?.getattr("Policy")?.getattr("from_json")?;
        Ok((load, PyTuple::new(py, [self.to_json()?])?))
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        (self.formula(), self.actions()).hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        let [automaton, states] = self.shape();
        format!(
            "<Policy for `{}`: {automaton} automaton states, {states} states>",
            self.0.task().name()
        )
    }
}
