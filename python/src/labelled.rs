//! A task on the states of a model: the table that is solved and learned.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::Acceptor;
use tltl::augmented::Labelled;
use tltl::reward::Rewards;
use tltl::robustness::{NotANumber, Predicates};

use super::compiled::Compiled;
use super::error::wrong;
use super::labels;
use super::model::FiniteModel;
use super::task::Task;

/// The predicates of a task over rows of their own robustness.
#[derive(Clone, Copy)]
pub(crate) struct Row;

impl<R: AsRef<[f64]> + ?Sized> Predicates<R> for Row {
    fn robustness(&self, i: usize, row: &R) -> f64 {
        row.as_ref()[i]
    }

    fn holds(&self, i: usize, row: &R) -> Result<bool, NotANumber> {
        Ok(row.as_ref()[i] > 0.0)
    }
}

/// A task that is given as one, or as the text of its formula.
pub(crate) fn task_of(task: &Bound<'_, PyAny>) -> PyResult<Task> {
    let task = match task.extract::<&str>() {
        Ok(_) => task.py().import("tltl")?.getattr("Task")?.call1((task,))?,
        Err(_) => task.clone(),
    };
    Ok(task.cast_into::<Task>()?.get().clone())
}

/// The states of a world as its labels are asked for them, and the number of its actions.
pub(crate) struct States<'py> {
    /// The arguments of the label function for each state.
    pub(crate) arguments: Vec<Bound<'py, PyTuple>>,
    pub(crate) actions: usize,
}

impl FiniteModel {
    /// A state is asked for by its number in the tables, and by its event if there are some.
    pub(crate) fn named<'py>(&self, py: Python<'py>) -> PyResult<States<'py>> {
        let events = self.events(py);
        let arguments = |(s, &origin): (usize, &i32)| match events.is_empty() {
            true => (origin,).into_pyobject(py),
            false => (origin, events.get_item(s)?).into_pyobject(py),
        };
        let arguments =
            self.origins().iter().enumerate().map(arguments).collect::<PyResult<_>>()?;
        Ok(States { arguments, actions: self.dynamics.actions() })
    }
}

/// The robustness of the propositions in each state: of an array of shape (states, propositions), or
/// by asking a function for each of them.
pub(crate) fn rows(
    states: &States<'_>,
    task: &Task,
    labels: &Bound<'_, PyAny>,
) -> PyResult<Vec<Vec<f64>>> {
    if !labels.is_callable() {
        let (count, width) = (states.arguments.len(), task.propositions().len());
        let all = labels::rows(task.propositions(), labels, count)?;
        return Ok((0..count).map(|s| all[s * width..][..width].to_vec()).collect());
    }
    let ask = |arguments: &Bound<'_, PyTuple>| {
        labels::robustness(task.propositions(), &labels.call1(arguments)?)
    };
    states.arguments.iter().map(ask).collect()
}

/// The task on these states, with the robustness that `rewards` need.
pub(crate) fn labelled(
    states: &States<'_>,
    task: &Task,
    labels: &Bound<'_, PyAny>,
    rewards: Option<&Rewards>,
) -> PyResult<Labelled> {
    of_rows(labels.py(), states, task, rows(states, task, labels)?, rewards)
}

/// The same of the robustness of the propositions in each state.
pub(crate) fn of_rows(
    py: Python<'_>,
    states: &States<'_>,
    task: &Task,
    rows: Vec<Vec<f64>>,
    rewards: Option<&Rewards>,
) -> PyResult<Labelled> {
    let (formula, automaton) = (task.inner.formula().clone(), task.automaton().clone());
    let monitor = tltl::Task::new(task.inner.name().to_owned(), formula, automaton, Row);
    let monitor = monitor.map_err(|error| wrong(error.to_string()))?;
    let actions = (0..states.actions).map(|a| a.to_string());
    let needs_robustness = rewards.is_some_and(Rewards::needs_robustness);
    py.detach(|| {
        let labelled = Labelled::new(rows.clone(), actions, &monitor);
        let labelled = match needs_robustness {
            true => labelled.and_then(|labelled| labelled.with_robustness(rows, &monitor)),
            false => labelled,
        };
        labelled.map_err(|error| wrong(error.to_string()))
    })
}
