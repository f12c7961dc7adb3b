//! A task on the states of a model: the table that is solved and learned.

use pyo3::prelude::*;
use tltl::Acceptor;
use tltl::augmented::Labelled;
use tltl::reward::Rewards;
use tltl::robustness::{NotANumber, Predicates};

use super::error::wrong;
use super::labels;
use super::model::FiniteModel;
use super::task::Task;

/// The predicates of a task over rows of their own robustness.
struct Row;

impl Predicates<Vec<f64>> for Row {
    fn robustness(&self, i: usize, row: &Vec<f64>) -> f64 {
        row[i]
    }

    fn holds(&self, i: usize, row: &Vec<f64>) -> Result<bool, NotANumber> {
        Ok(row[i] > 0.0)
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

/// The robustness of the propositions in each state of the model: of an array of shape (states,
/// propositions), or by asking a function for each state, `labels(s)` or `labels(s, event)`.
fn rows(model: &FiniteModel, task: &Task, labels: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<f64>>> {
    if !labels.is_callable() {
        let (states, width) = (model.dynamics.states(), task.names().len());
        let all = task.rows_of(labels, states)?;
        return Ok((0..states).map(|s| all[s * width..][..width].to_vec()).collect());
    }
    let events = model.events(labels.py());
    let ask = |(s, &origin): (usize, &i32)| {
        let told = match events.is_empty() {
            true => labels.call1((origin,)),
            false => labels.call1((origin, events.get_item(s)?)),
        }?;
        labels::robustness(task.names(), &told)
    };
    model.origins().iter().enumerate().map(ask).collect()
}

/// The task on the states of `model`, with the robustness that `rewards` need.
pub(crate) fn labelled(
    model: &FiniteModel,
    task: &Task,
    labels: &Bound<'_, PyAny>,
    rewards: Option<&Rewards>,
) -> PyResult<Labelled> {
    let rows = rows(model, task, labels)?;
    let (formula, automaton) = (task.inner.formula().clone(), task.automaton().clone());
    let monitor = tltl::Task::new(task.inner.name().to_owned(), formula, automaton, Row);
    let monitor = monitor.map_err(|error| wrong(error.to_string()))?;
    let actions = (0..model.dynamics.actions()).map(|a| a.to_string());
    let needs_robustness = rewards.is_some_and(Rewards::needs_robustness);
    labels.py().detach(|| {
        let labelled = Labelled::new(rows.clone(), actions, &monitor);
        let labelled = match needs_robustness {
            true => labelled.and_then(|labelled| labelled.with_robustness(rows, &monitor)),
            false => labelled,
        };
        labelled.map_err(|error| wrong(error.to_string()))
    })
}
