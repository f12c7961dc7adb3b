//! `tltl.solve`: what is optimal, and what a policy is worth.

use std::sync::Arc;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::policy;
use tltl::reward;
use tltl::solve::{Optimum, Problem, Report};

use super::array::{frozen, shaped};
use super::certificate::{Certificate, Mistake};
use super::compiled::Compiled;
use super::error::wrong;
use super::labelled::{of_rows, rows, task_of};
use super::model::FiniteModel;
use super::policy::{Policy, policy_of};
use super::rewards::Rewards;
use super::shield::Shield;
use super::task::Task;

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
    let (task, given, model) = (task_of(task)?, model, model.get());
    let rewards = rewards.map_or_else(reward::Rewards::acceptance, |rewards| rewards.0);
    if rewards.needs_robustness() {
        return Err(wrong("rewards: models are not solved for the mode `robustness`"));
    }
    let states = model.named(py)?;
    let rows = rows(&states, &task, labels)?;
    let labelled = of_rows(py, &states, &task, rows.clone(), None)?;
    let optimum = py.detach(|| {
        let problem = Problem::new(&model.dynamics, &labelled);
        problem.map(|problem| problem.optimum(&rewards))
    });
    let optimum = optimum.map_err(|error| wrong(error.to_string()))?;
    let optimum = Arc::new(optimum);
    let asked = Some(Asked { model: given.clone().unbind(), task, rows });
    Ok(Solution { optimum, rewards, horizon: model.horizon, asked })
}

/// What was solved.
struct Asked {
    model: Py<FiniteModel>,
    task: Task,
    /// The robustness of the propositions in each state.
    rows: Vec<Vec<f64>>,
}

/// A task that is solved in a model. It is pickled as what was asked, and solved again.
#[pyclass(frozen, module = "tltl")]
pub struct Solution {
    pub(crate) optimum: Arc<Optimum>,
    pub(crate) rewards: reward::Rewards,
    pub(crate) horizon: Option<u64>,
    /// Nothing for a composition, whose automaton is that of its raw pairs.
    asked: Option<Asked>,
}

impl Solution {
    /// That of a composition.
    pub(crate) const fn composed(
        optimum: Arc<Optimum>,
        rewards: reward::Rewards,
        horizon: Option<u64>,
    ) -> Self {
        Self { optimum, rewards, horizon, asked: None }
    }

    pub(crate) fn task(&self) -> Option<&Task> {
        self.asked.as_ref().map(|asked| &asked.task)
    }

    /// A number for each automaton state and state.
    fn shape(&self) -> [usize; 2] {
        let task = self.optimum.problem().task();
        [task.automaton_states() as usize, task.states()]
    }

    pub(crate) fn report(
        &self,
        py: Python<'_>,
        policy: &policy::Policy,
        within: Option<u64>,
    ) -> PyResult<Report> {
        let report = py.detach(|| match within.or(self.horizon) {
            Some(steps) => self.optimum.report_within(policy, steps),
            None => self.optimum.report(policy),
        });
        report.map_err(|error| wrong(error.to_string()))
    }

    pub(crate) fn policy_of(&self, policy: &Bound<'_, PyAny>) -> PyResult<policy::Policy> {
        policy_of(self.optimum.problem().task(), policy)
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

    /// The best policy.
    #[getter]
    fn policy(&self) -> Policy {
        Policy(self.optimum.best().policy().clone())
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

    /// What a policy is worth: a `Policy`, an array of actions of shape (automaton states, states), or
    /// a function of the two. `within` is a number of steps after which an episode is cut: the
    /// model's, if left out.
    #[pyo3(signature = (policy, *, within=None))]
    fn certify(
        &self,
        py: Python<'_>,
        policy: &Bound<'_, PyAny>,
        within: Option<u64>,
    ) -> PyResult<Certificate> {
        Ok(self.report(py, &self.policy_of(policy)?, within)?.into())
    }

    /// An array of actions or a function as a `Policy` that says what it is worth: so it is saved and
    /// becomes Rust. Arguments as for `certify`.
    #[pyo3(signature = (policy, *, within=None))]
    fn certified(
        &self,
        py: Python<'_>,
        policy: &Bound<'_, PyAny>,
        within: Option<u64>,
    ) -> PyResult<Policy> {
        let policy = self.policy_of(policy)?;
        let Report { certificate, starts } = self.report(py, &policy, within)?;
        Ok(Policy(policy.certified(certificate).from_starts(&starts)))
    }

    /// The pairs in which a policy takes an action that is worse for the rewards than the best one.
    fn mistakes<'py>(
        &self,
        py: Python<'py>,
        policy: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyTuple>> {
        let mistakes = self.optimum.mistakes(&self.policy_of(policy)?);
        let mistakes = mistakes.map_err(|error| wrong(error.to_string()))?;
        PyTuple::new(py, mistakes.into_iter().map(Mistake::from))
    }

    /// The shield that bounds what is lost: whoever keeps to allowed actions loses with at most the
    /// smallest possible probability plus `epsilon`, from every pair, whatever it remembers.
    ///
    /// `around="best"` bounds it by the best policy's probability instead, so that all that the best
    /// policy does is allowed; the safest policy may wait for ever where nothing can be lost.
    ///
    /// Raises `ValueError` if `epsilon` is not in [0, 1].
    #[pyo3(signature = (*, epsilon=0.0, around="safest"))]
    fn shield(slf: &Bound<'_, Self>, epsilon: f64, around: &str) -> PyResult<Shield> {
        let (name, around): (_, fn(&Problem, f64) -> _) = match around {
            "safest" => ("safest", tltl::shield::Shield::safest),
            "best" => ("best", tltl::shield::Shield::keeping_best),
            _ => return Err(wrong(format!("around is `{around}`, not `safest` or `best`"))),
        };
        let problem = slf.get().optimum.problem();
        let shield = slf.py().detach(|| around(problem, epsilon));
        let shield = shield.map_err(|error| wrong(error.to_string()))?;
        Ok(Shield::new(shield, slf.clone().unbind(), name))
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Some(Asked { model, task, rows }) = &self.asked else {
            return Err(PyTypeError::new_err(
                "the solution of a composition is not pickled: pickle the skills, and compose again",
            ));
        };
        let named = PyDict::new(py);
        named.set_item("rewards", Rewards(self.rewards))?;
        let solve = py.import("tltl")?.getattr("solve")?;
        let solve = py.import("functools")?.getattr("partial")?.call((solve,), Some(&named))?;
        let rows = shaped(py, rows.concat(), &[rows.len(), task.propositions().len()])?;
        Ok((solve, (model, task.clone(), rows).into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        let best = self.optimum.best();
        format!("<Solution: P(satisfied) {} at most>", best.mean_satisfied())
    }
}
