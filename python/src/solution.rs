//! `tltl.solve`: what is optimal, and what a policy is worth.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::Acceptor;
use tltl::augmented::Labelled;
use tltl::policy::Policy;
use tltl::reward;
use tltl::robustness::{NotANumber, Predicates};
use tltl::solve::{Optimum, Problem, Report, Within};

use super::array::{Array, frozen};
use super::error::wrong;
use super::labels;
use super::model::FiniteModel;
use super::rewards::Rewards;
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

/// The robustness of the propositions in each state of the model: of an array of shape (states,
/// propositions), or by asking a function for each state, `labels(s)` or `labels(s, event)`.
fn table(
    model: &FiniteModel,
    events: &Bound<'_, PyTuple>,
    task: &Task,
    labels: &Bound<'_, PyAny>,
) -> PyResult<Vec<Vec<f64>>> {
    if !labels.is_callable() {
        let states = model.dynamics.states();
        let width = task.names().len();
        let all = task.rows_of(labels, states)?;
        return Ok((0..states).map(|s| all[s * width..][..width].to_vec()).collect());
    }
    let ask = |(s, &origin): (usize, &i32)| {
        let told = match events.is_empty() {
            true => labels.call1((origin,)),
            false => labels.call1((origin, events.get_item(s)?)),
        }?;
        labels::robustness(task.names(), &told)
    };
    model.origins().iter().enumerate().map(ask).collect()
}

/// Solves a task in a model: the largest P(satisfied), and then the fewest steps.
///
/// `labels` says what holds in each state: a function of the state (and of the event, if the model
/// has events), as for `Task.step`, or an array of shape (states, propositions). Policies are judged
/// by `rewards` too, which count for `fraction_optimal` only.
#[pyfunction]
#[pyo3(signature = (model, task, labels, *, rewards=None))]
pub(crate) fn solve(
    py: Python<'_>,
    model: &Bound<'_, FiniteModel>,
    task: &Bound<'_, PyAny>,
    labels: &Bound<'_, PyAny>,
    rewards: Option<Rewards>,
) -> PyResult<Solution> {
    let task = match task.extract::<&str>() {
        Ok(_) => py.import("tltl")?.getattr("Task")?.call1((task,))?.cast_into::<Task>()?,
        Err(_) => task.clone().cast_into::<Task>()?,
    };
    let (task, world) = (task.get(), model.get());
    let rows = table(world, world.events(py), task, labels)?;
    let rewards = match rewards {
        Some(rewards) => rewards.0,
        None => reward::Rewards::acceptance()
            .with_gamma(GAMMA)
            .map_err(|error| wrong(error.to_string()))?,
    };
    if rewards.needs_robustness() {
        return Err(wrong("rewards: models are not solved for the mode `robustness`"));
    }
    let (formula, automaton) = (task.inner.formula().clone(), task.automaton().clone());
    let monitor = tltl::Task::new(task.inner.name().to_owned(), formula, automaton, Row);
    let monitor = monitor.map_err(|error| wrong(error.to_string()))?;
    let actions = (0..world.dynamics.actions()).map(|a| a.to_string());
    let optimum = py.detach(|| {
        let labelled = Labelled::new(rows, actions, &monitor).map_err(|error| error.to_string())?;
        let problem =
            Problem::new(&world.dynamics, &labelled).map_err(|error| error.to_string())?;
        Ok(problem.optimum(&rewards))
    });
    let optimum = optimum.map_err(|error: String| wrong(error))?;
    Ok(Solution { optimum, horizon: world.horizon })
}

/// γ where only the task counts: what is optimal for acceptance is then the largest P, but for cases
/// that no policy comes to.
const GAMMA: f64 = 0.99999;

/// A task that is solved in a model.
#[pyclass(frozen, module = "tltl")]
pub struct Solution {
    optimum: Optimum,
    horizon: Option<u64>,
}

impl Solution {
    /// A number for each automaton state and state.
    fn shape(&self) -> [usize; 2] {
        let task = self.optimum.problem().task();
        [task.automaton_states() as usize, task.states()]
    }

    /// A policy as an array of actions of shape (automaton states, states), or as a function of the
    /// two.
    fn policy_of(&self, policy: &Bound<'_, PyAny>) -> PyResult<Policy> {
        let task = self.optimum.problem().task();
        let [automaton, states] = self.shape();
        let actions: Vec<usize> = if policy.is_callable() {
            let pairs = (0..automaton).flat_map(|q| (0..states).map(move |s| (q, s)));
            pairs.map(|pair| policy.call1(pair)?.extract()).collect::<PyResult<_>>()?
        } else {
            let array = Array::new(policy, "policy")?;
            let shape = array.view().shape;
            if shape != [automaton, states] {
                return Err(wrong(format!(
                    "policy: an array of shape {shape:?}; wanted is ({automaton}, {states}), an \
                     action for each automaton state and state"
                )));
            }
            let actions = array.naturals();
            let actions =
                actions.ok_or_else(|| wrong("policy: actions are whole numbers from 0 on"))?;
            actions.into_iter().map(|a| usize::try_from(a).unwrap_or(usize::MAX)).collect()
        };
        Policy::new(task, actions).map_err(|error| wrong(error.to_string()))
    }
}

#[pymethods]
impl Solution {
    /// The largest P(satisfied) from each pair: float64, of shape (automaton states, states). The
    /// state has been read.
    #[getter]
    fn satisfied<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        frozen(py, self.optimum.best().satisfied().as_slice().to_vec(), &self.shape())
    }

    /// The fewest expected steps among the policies of that P, given success, from each pair; NaN
    /// where P is 0.
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [automaton, states] = self.shape();
        let pairs = (0..automaton as u32).flat_map(|q| (0..states).map(move |s| (q, s)));
        let steps = pairs.map(|(q, s)| self.optimum.best().steps(q, s).unwrap_or(f64::NAN));
        frozen(py, steps.collect(), &[automaton, states])
    }

    /// The best policy: int64, of shape (automaton states, states).
    #[getter]
    fn policy<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [automaton, states] = self.shape();
        let policy = self.optimum.best().policy();
        let pairs = (0..automaton as u32).flat_map(|q| (0..states).map(move |s| (q, s)));
        frozen(py, pairs.map(|(q, s)| policy.act(q, s) as i64).collect(), &[automaton, states])
    }

    /// The optimal action values for the rewards: float64, of shape (automaton states, states,
    /// actions).
    #[getter]
    #[allow(non_snake_case, reason = "the field's name")]
    fn Q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let [automaton, states] = self.shape();
        let actions = self.optimum.problem().task().actions();
        frozen(py, self.optimum.q().values().to_vec(), &[automaton, states, actions])
    }

    /// What a policy is worth: an array of actions of shape (automaton states, states), or a function
    /// of the two. `within` is a number of steps after which an episode is cut: the model's, if left
    /// out.
    #[pyo3(signature = (policy, *, within=None))]
    fn certify(
        &self,
        py: Python<'_>,
        policy: &Bound<'_, PyAny>,
        within: Option<u64>,
    ) -> PyResult<Certificate> {
        let policy = self.policy_of(policy)?;
        let report = py.detach(|| match within.or(self.horizon) {
            Some(steps) => self.optimum.report_within(&policy, steps),
            None => self.optimum.report(&policy),
        });
        report.map(Certificate).map_err(|error| wrong(error.to_string()))
    }

    fn __repr__(&self) -> String {
        let best = self.optimum.best();
        format!("<Solution: P(satisfied) {} at most>", best.mean_satisfied())
    }
}

/// What a policy is worth against the best possible: exact means over the starts. It prints as a few
/// lines, with the starts that lose most.
#[pyclass(frozen, module = "tltl")]
pub struct Certificate(Report);

impl Certificate {
    const fn within_or_none(&self) -> Option<Within> {
        self.0.certificate.within
    }
}

#[pymethods]
impl Certificate {
    /// P(satisfied) of the policy.
    #[getter]
    fn satisfied(&self) -> f64 {
        self.0.certificate.satisfied
    }

    /// E[steps] of the policy, given success; `None` if it never succeeds.
    #[getter]
    fn steps(&self) -> Option<f64> {
        self.0.certificate.steps
    }

    /// The largest possible P(satisfied).
    #[getter]
    fn optimal_satisfied(&self) -> f64 {
        self.0.certificate.optimal_satisfied
    }

    /// The smallest possible E[steps] among the policies of that P.
    #[getter]
    fn optimal_steps(&self) -> Option<f64> {
        self.0.certificate.optimal_steps
    }

    /// By how much P(satisfied) is smaller than possible.
    #[getter]
    fn regret_satisfied(&self) -> f64 {
        self.0.certificate.regret_satisfied
    }

    /// By which part of the fewest steps it needs more.
    #[getter]
    fn regret_steps(&self) -> Option<f64> {
        self.0.certificate.regret_steps
    }

    /// The largest regret in P(satisfied) of a single start.
    #[getter]
    fn worst_regret_satisfied(&self) -> f64 {
        self.0.certificate.worst_regret_satisfied
    }

    /// The fraction of pairs in which the action is optimal for the rewards.
    #[getter]
    fn fraction_optimal(&self) -> f64 {
        self.0.certificate.fraction_optimal
    }

    /// The number of steps after which an episode is cut, if there is one.
    #[getter]
    fn within(&self) -> Option<u64> {
        self.within_or_none().map(|within| within.steps)
    }

    /// P(satisfied) within that number of steps.
    #[getter]
    fn satisfied_within(&self) -> Option<f64> {
        self.within_or_none().map(|within| within.satisfied)
    }

    /// The largest possible P(satisfied) within that number of steps.
    #[getter]
    fn optimal_satisfied_within(&self) -> Option<f64> {
        self.within_or_none().map(|within| within.optimal_satisfied)
    }

    /// What it is worth from each start, those that lose most first: (state, P(satisfied), E[steps]
    /// or `None`).
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let starts = self.0.starts.iter();
        PyTuple::new(py, starts.map(|start| (start.state, start.satisfied, start.steps)))
    }

    fn __str__(&self) -> String {
        self.0.to_string()
    }

    fn __repr__(&self) -> String {
        format!("<Certificate: P(satisfied) {}>", self.satisfied())
    }
}
