//! `tltl.compose`: skills that were learned become a new one, without a step in the world.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::compose::{Combine, Composition as Composed, Operator, Steps};
use tltl::learn::Experience;
use tltl::model::Dynamics;
use tltl::q::QTable;
use tltl::reward::Rewards;
use tltl::solve::Problem;

use super::certificate::{Certificate, preformatted};
use super::error::wrong;
use super::learner::Learner;
use super::model::FiniteModel;
use super::policy::Policy;
use super::solution::Solution;

/// The states of the product that are made at most.
const BUDGET: usize = 100_000;

/// What composition needs of a skill.
struct Skill {
    q: QTable,
    rewards: Rewards,
    /// What was seen while it was learned, if it was learned.
    seen: Option<Experience>,
    world: Option<Dynamics>,
    horizon: Option<u64>,
}

impl Skill {
    fn of(object: &Bound<'_, PyAny>) -> PyResult<Self> {
        let py = object.py();
        if let Ok(solution) = object.cast::<Solution>() {
            let Solution { optimum, rewards, horizon, .. } = solution.get();
            return Ok(Self {
                q: optimum.q().clone(),
                rewards: *rewards,
                seen: None,
                world: Some(optimum.problem().dynamics().clone()),
                horizon: *horizon,
            });
        }
        let learner = object.cast::<Learner>()?.try_borrow()?;
        let inner = learner.inner();
        let remembers = inner.settings().memory() == tltl::learn::Memory::Experience;
        Ok(Self {
            q: py.detach(|| inner.q()),
            rewards: inner.rewards(),
            seen: remembers.then(|| inner.experience().clone()),
            world: None,
            horizon: learner.horizon(),
        })
    }
}

/// The world that is composed on, and whether it was counted: that of a solution, which is exact, or what
/// all learners have seen.
fn world_of(skills: &[Skill]) -> PyResult<(Dynamics, bool)> {
    if let Some(world) = skills.iter().find_map(|skill| skill.world.clone()) {
        return Ok((world, false));
    }
    let mut all: Option<Experience> = None;
    for seen in skills.iter().filter_map(|skill| skill.seen.as_ref()) {
        match &mut all {
            None => all = Some(seen.clone()),
            Some(all) => all.extend(seen).map_err(|error| wrong(error.to_string()))?,
        }
    }
    let all = all.ok_or_else(|| wrong("skills: none of the learners remembers what it saw"))?;
    let seen = Dynamics::new(&all).map_err(|error| wrong(error.to_string()))?;
    Ok((seen, true))
}

/// Composes skills (Algorithm 2 of the paper) without a step in the world: the conjunction (`"and"`),
/// disjunction (`"or"`) or sequence (`"then"`) of their tasks.
///
/// `skills` are learners or solutions of the same world. What was learned is composed on what was
/// seen, that of all learners together; with a solution among them, on its model, and then it is
/// exact.
///
/// Raises `ValueError` if the skills are of different worlds or learned for different rewards, or if
/// their product has more than 100,000 states.
#[pyfunction]
pub(crate) fn compose(
    py: Python<'_>,
    operator: &str,
    skills: Vec<Bound<'_, PyAny>>,
) -> PyResult<Composition> {
    let operator = match operator {
        "and" => Operator::Conjunction,
        "or" => Operator::Disjunction,
        "then" => Operator::Sequence,
        other => return Err(wrong(format!("operator is `{other}`, not `and`, `or` or `then`"))),
    };
    let skills = skills.iter().map(Skill::of).collect::<PyResult<Vec<_>>>()?;
    let Some(first) = skills.first() else {
        return Err(wrong("skills: none are given"));
    };
    if skills.iter().any(|skill| skill.rewards != first.rewards) {
        return Err(wrong("skills: their values are for different rewards, and cannot be added"));
    }
    let (world, is_counted) = world_of(&skills)?;
    let rewards = first.rewards;
    let steps = py.detach(|| {
        let tables: Vec<&QTable> = skills.iter().map(|skill| &skill.q).collect();
        let composed = Composed::of(operator, &tables, rewards, BUDGET);
        let composed = composed.map_err(|error| error.to_string())?;
        let steps = if is_counted {
            composed.run_on_seen(&world, Combine::Sum)
        } else {
            composed.run(&world, Combine::Sum)
        };
        steps.map_err(|error| error.to_string())
    });
    let steps = steps.map_err(|error: String| wrong(error))?;
    Ok(Composition { steps, rewards, horizon: first.horizon })
}

/// A skill that was composed of others.
#[pyclass(frozen, module = "tltl")]
pub struct Composition {
    steps: Steps,
    rewards: Rewards,
    horizon: Option<u64>,
}

#[pymethods]
impl Composition {
    /// The steps of Algorithm 2, each as (name, certificate): the skills' values combined, what they
    /// count twice taken off, and refined to the optimum of the product. The certificates are for the
    /// world that was composed on.
    #[getter]
    fn steps<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let steps = self.steps.all().iter();
        PyTuple::new(
            py,
            steps.map(|step| (step.stage.to_string(), Certificate::of(&step.certificate))),
        )
    }

    /// The policy of the best step.
    #[getter]
    fn policy(&self) -> Policy {
        Policy(self.steps.policy().clone())
    }

    /// What is optimal for the composed task in a model of the world, to certify `policy` by: its
    /// automaton is the product, whose states are not those of a formula that is compiled.
    ///
    /// Raises `ValueError` if the model is of another world.
    fn solve(&self, py: Python<'_>, model: &FiniteModel) -> PyResult<Solution> {
        let task = self.steps.policy().task();
        let optimum = py.detach(|| {
            Problem::new(&model.dynamics, task).map(|problem| problem.optimum(&self.rewards))
        });
        let optimum = Arc::new(optimum.map_err(|error| wrong(error.to_string()))?);
        let horizon = model.horizon.or(self.horizon);
        Ok(Solution::composed(optimum, self.rewards, horizon))
    }

    fn __str__(&self) -> String {
        self.steps.to_string()
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.steps.to_string())
    }

    fn __repr__(&self) -> String {
        let best = self.steps.best();
        format!("<Composition `{}`: {}>", best.policy.task().name(), best.stage)
    }
}
