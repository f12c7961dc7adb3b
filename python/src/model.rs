//! `tltl.FiniteModel`: a finite world as sparse rows.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::learn::Experience;
use tltl::model::{Dynamics, FiniteModel as Model};

use super::array::{Array, frozen};
use super::error::wrong;

/// Sparse rows of outcomes, as they came.
pub(crate) struct Rows {
    actions: usize,
    first: Vec<usize>,
    to: Vec<usize>,
    probability: Vec<f64>,
    ends: Vec<bool>,
    starts: Option<Vec<f64>>,
}

impl Rows {
    fn outcomes(&self, s: usize, a: usize, ends: bool, mut outcome: impl FnMut(usize, f64)) {
        let row = s * self.actions + a;
        for at in self.first[row]..self.first[row + 1] {
            if self.ends[at] == ends {
                outcome(self.to[at], self.probability[at]);
            }
        }
    }
}

impl Model for Rows {
    type State = usize;

    fn states(&self) -> usize {
        (self.first.len() - 1) / self.actions
    }

    fn actions(&self) -> usize {
        self.actions
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        self.outcomes(s, a, false, outcome);
    }

    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        self.outcomes(s, a, true, outcome);
    }

    fn start(&self, s: usize) -> f64 {
        self.starts.as_ref().map_or(1.0, |starts| starts[s])
    }
}

/// Where a model comes from: what is sampled when a learner steps in it. A clone costs a reference
/// count.
#[derive(Clone)]
pub(crate) enum Source {
    Rows(Arc<Rows>),
    Seen(Arc<Experience>),
}

impl Model for Source {
    type State = usize;

    fn states(&self) -> usize {
        match self {
            Self::Rows(rows) => rows.states(),
            Self::Seen(seen) => seen.states(),
        }
    }

    fn actions(&self) -> usize {
        match self {
            Self::Rows(rows) => rows.actions(),
            Self::Seen(seen) => seen.actions(),
        }
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        match self {
            Self::Rows(rows) => rows.transitions(s, a, outcome),
            Self::Seen(seen) => seen.transitions(s, a, outcome),
        }
    }

    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        match self {
            Self::Rows(rows) => rows.endings(s, a, outcome),
            Self::Seen(seen) => seen.endings(s, a, outcome),
        }
    }

    fn start(&self, s: usize) -> f64 {
        match self {
            Self::Rows(rows) => rows.start(s),
            Self::Seen(seen) => seen.start(s),
        }
    }
}

/// A finite world whose probabilities are known.
///
/// Where an outcome ends the episode, its state is read, and nothing after it.
///
/// >>> from tltl import FiniteModel
/// >>> # Two states; the only action goes on, and ends in state 1.
/// >>> model = FiniteModel.from_arrays([0, 1, 2], [1, 1], [1.0, 1.0], actions=1, ends=[True, True])
/// >>> model.num_states, model.num_actions
/// (2, 1)
#[pyclass(frozen, module = "tltl")]
pub struct FiniteModel {
    pub(crate) source: Source,
    pub(crate) dynamics: Dynamics,
    /// The steps after which an episode is cut, if it is.
    #[pyo3(get)]
    pub(crate) horizon: Option<u64>,
    origin: Vec<i32>,
    /// What happened on the way into each state; nothing where it was not asked for.
    #[pyo3(get)]
    event: Py<PyTuple>,
}

impl FiniteModel {
    pub(crate) fn origins(&self) -> &[i32] {
        &self.origin
    }

    /// The world as it was seen in this one, with the frequencies as probabilities.
    pub(crate) fn as_seen(&self, py: Python<'_>, seen: Experience) -> PyResult<Self> {
        let (origin, event) = (self.origin.clone(), self.event.clone_ref(py));
        Ok(Self { origin, event, horizon: self.horizon, ..Self::seen(py, seen)? })
    }

    /// The world as it was seen: states are called by their numbers.
    pub(crate) fn seen(py: Python<'_>, seen: Experience) -> PyResult<Self> {
        let dynamics = py.detach(|| Dynamics::new(&seen));
        let dynamics = dynamics.map_err(|error| wrong(error.to_string()))?;
        Ok(Self {
            origin: (0..dynamics.states() as i32).collect(),
            event: PyTuple::empty(py).unbind(),
            horizon: None,
            source: Source::Seen(Arc::new(seen)),
            dynamics,
        })
    }

    pub(crate) fn events<'py>(&self, py: Python<'py>) -> &Bound<'py, PyTuple> {
        self.event.bind(py)
    }
}

/// The numbers of an argument, of one axis.
fn numbers(object: &Bound<'_, PyAny>, name: &str) -> PyResult<Vec<f64>> {
    let array = Array::new(object, name)?;
    match *array.shape() {
        [_] => Ok(array.robustness()),
        ref shape => Err(wrong(format!("{name}: an array of shape {shape:?}; wanted is one axis"))),
    }
}

/// The indices of an argument, of one axis, none above `most`.
fn indices(object: &Bound<'_, PyAny>, name: &str, most: usize) -> PyResult<Vec<usize>> {
    let array = Array::new(object, name)?;
    if array.shape().len() != 1 {
        return Err(wrong(format!("{name}: wanted is an array of one axis")));
    }
    let found = array
        .naturals()
        .ok_or_else(|| wrong(format!("{name}: wanted are whole numbers from 0 on")))?;
    match found.iter().position(|&index| index > most as u64) {
        Some(at) => Err(wrong(format!("{name}[{at}] is {}, and the largest is {most}", found[at]))),
        None => Ok(found.iter().map(|&index| index as usize).collect()),
    }
}

/// A column that has an entry for each of `count`.
fn expect<T>(column: Vec<T>, name: &str, count: usize) -> PyResult<Vec<T>> {
    if column.len() == count {
        return Ok(column);
    }
    Err(wrong(format!("{name}: {} entries; wanted are {count}", column.len())))
}

#[pymethods]
impl FiniteModel {
    /// The world of sparse rows (CSR): row s * actions + a are the outcomes of action a in state s.
    ///
    /// `ends` says of each outcome whether the episode is over there, `starts` how probable each state
    /// is at first (equally, if left out), and `horizon` after how many steps an episode is cut.
    ///
    /// Raises `ValueError` if the outcomes of an action are not a distribution.
    #[staticmethod]
    #[pyo3(signature = (indptr, indices, probabilities, *, actions, ends=None, starts=None, horizon=None, origin=None, event=None))]
    #[allow(clippy::too_many_arguments, reason = "each is a column of the model")]
    fn from_arrays(
        py: Python<'_>,
        indptr: &Bound<'_, PyAny>,
        indices: &Bound<'_, PyAny>,
        probabilities: &Bound<'_, PyAny>,
        actions: usize,
        ends: Option<&Bound<'_, PyAny>>,
        starts: Option<&Bound<'_, PyAny>>,
        horizon: Option<u64>,
        origin: Option<Vec<i32>>,
        event: Option<Bound<'_, PyTuple>>,
    ) -> PyResult<Self> {
        let probability = numbers(probabilities, "probabilities")?;
        let count = probability.len();
        let first = self::indices(indptr, "indptr", count)?;
        if actions == 0 || first.len() < 2 || !(first.len() - 1).is_multiple_of(actions) {
            return Err(wrong("indptr: wanted is a row for each state and action, and the end"));
        }
        if first[0] != 0 || first[first.len() - 1] != count || !first.is_sorted() {
            return Err(wrong("indptr: rows must ascend from 0 to the number of outcomes"));
        }
        let states = (first.len() - 1) / actions;
        let to = expect(self::indices(indices, "indices", states - 1)?, "indices", count)?;
        let ends = ends.map(|ends| numbers(ends, "ends")).transpose()?;
        let ends = ends
            .map_or_else(|| vec![false; count], |ends| ends.iter().map(|end| *end > 0.0).collect());
        let ends = expect(ends, "ends", count)?;
        let starts = starts.map(|starts| expect(numbers(starts, "starts")?, "starts", states));
        let rows = Rows { actions, first, to, probability, ends, starts: starts.transpose()? };
        let source = Source::Rows(Arc::new(rows));
        let dynamics =
            py.detach(|| Dynamics::new(&source)).map_err(|error| wrong(error.to_string()))?;
        let origin = origin.unwrap_or_else(|| (0..states as i32).collect());
        let event = event.unwrap_or_else(|| PyTuple::empty(py));
        Ok(Self {
            source,
            dynamics,
            horizon,
            origin: expect(origin, "origin", states)?,
            event: event.unbind(),
        })
    }

    /// The world as stored steps show it, with frequencies as probabilities: step i is from `states[i]`
    /// under `actions[i]` to `next_states[i]`, all of shape (n,), and ends the episode where
    /// `terminated[i]`. `starts`, of any length, are first states of episodes; without them each state
    /// that was met is a start alike.
    ///
    /// An action that was never tried in a state stays there. The order of the steps does not matter,
    /// so they may come from any policy and any task: `solve` and `compose` on this world are learning
    /// and composition from stored experience.
    ///
    /// Raises `ValueError` if a state or an action is out of range.
    #[staticmethod]
    #[pyo3(signature = (states, actions, next_states, *, num_states, num_actions, terminated=None, starts=None))]
    #[allow(clippy::too_many_arguments, reason = "each is a column of the steps")]
    fn from_experience(
        py: Python<'_>,
        states: &Bound<'_, PyAny>,
        actions: &Bound<'_, PyAny>,
        next_states: &Bound<'_, PyAny>,
        num_states: usize,
        num_actions: usize,
        terminated: Option<&Bound<'_, PyAny>>,
        starts: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        // Numbers of states are 32 bits, one of which says whether the episode ended.
        let sized = (1..1 << 31).contains(&num_states) && num_actions > 0;
        if !sized || num_states.checked_mul(num_actions).is_none_or(|cells| cells > 1 << 32) {
            return Err(wrong("num_states, num_actions: a world needs some, and not so many"));
        }
        let from = self::indices(states, "states", num_states - 1)?;
        let count = from.len();
        let by = expect(self::indices(actions, "actions", num_actions - 1)?, "actions", count)?;
        let to = self::indices(next_states, "next_states", num_states - 1)?;
        let to = expect(to, "next_states", count)?;
        let ends = terminated.map(|ends| numbers(ends, "terminated")).transpose()?;
        let ends = ends.map(|ends| expect(ends, "terminated", count)).transpose()?;
        let starts =
            starts.map(|starts| self::indices(starts, "starts", num_states - 1)).transpose()?;
        let mut seen = Experience::new(num_states, num_actions);
        for (i, (&s, (&a, &next))) in from.iter().zip(by.iter().zip(&to)).enumerate() {
            match ends.as_ref().is_some_and(|ends| ends[i] > 0.0) {
                true => seen.push_ending(s, a, next),
                false => seen.push(s, a, next),
            }
        }
        let mut met = from;
        met.sort_unstable();
        met.dedup();
        starts.unwrap_or(met).into_iter().for_each(|s| seen.push_start(s));
        Self::seen(py, seen)
    }

    /// The world of Gymnasium's tables: `P[state][action]` are outcomes (probability, next state,
    /// reward, done), for states and actions numbered from 0.
    ///
    /// With `events`, a function of (state, action, next state, reward), a next state is split by what
    /// happened on the way to it, and labels may depend on that.
    #[staticmethod]
    #[pyo3(signature = (transitions, *, starts=None, events=None, horizon=None))]
    fn from_transitions<'py>(
        py: Python<'py>,
        transitions: &Bound<'py, PyAny>,
        starts: Option<&Bound<'py, PyAny>>,
        events: Option<&Bound<'py, PyAny>>,
        horizon: Option<u64>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let named = PyDict::new(py);
        named.set_item("starts", starts)?;
        named.set_item("events", events)?;
        named.set_item("horizon", horizon)?;
        let module = py.import("tltl._model")?;
        module.getattr("of_transitions")?.call((transitions,), Some(&named))
    }

    /// The world of a Gymnasium environment that has its tables (`env.unwrapped.P`), with its starts
    /// and its time limit.
    #[staticmethod]
    #[pyo3(signature = (env, *, events=None))]
    fn from_env<'py>(
        py: Python<'py>,
        env: &Bound<'py, PyAny>,
        events: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let named = PyDict::new(py);
        named.set_item("events", events)?;
        py.import("tltl._model")?.getattr("of_env")?.call((env,), Some(&named))
    }

    /// The number of states, terminal copies included.
    #[getter]
    fn num_states(&self) -> usize {
        self.dynamics.states()
    }

    /// The number of actions.
    #[getter]
    fn num_actions(&self) -> usize {
        self.dynamics.actions()
    }

    /// As its outcomes: what was seen is kept as frequencies.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (states, actions) = (self.source.states(), self.source.actions());
        let (mut first, mut to, mut probability, mut ends) = (vec![0], vec![], vec![], vec![]);
        for (s, a) in (0..states).flat_map(|s| (0..actions).map(move |a| (s, a))) {
            self.source.transitions(s, a, |next, p| {
                to.push(next);
                probability.push(p);
                ends.push(false);
            });
            self.source.endings(s, a, |next, p| {
                to.push(next);
                probability.push(p);
                ends.push(true);
            });
            first.push(to.len());
        }
        let named = PyDict::new(py);
        named.set_item("actions", actions)?;
        named.set_item("ends", ends)?;
        named.set_item("starts", (0..states).map(|s| self.source.start(s)).collect::<Vec<_>>())?;
        named.set_item("horizon", self.horizon)?;
        named.set_item("origin", &self.origin)?;
        named.set_item("event", &self.event)?;
        let make = py.import("tltl")?.getattr("FiniteModel")?.getattr("from_arrays")?;
        let make = py.import("functools")?.getattr("partial")?.call((make,), Some(&named))?;
        Ok((make, (first, to, probability).into_pyobject(py)?))
    }

    /// The state of the tables that each state is: int32, of shape (states,).
    #[getter]
    fn origin<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frozen(py, self.origin.clone(), &[self.origin.len()])
    }

    fn __repr__(&self) -> String {
        let (states, actions) = (self.num_states(), self.num_actions());
        format!("<FiniteModel of {states} states and {actions} actions>")
    }
}
