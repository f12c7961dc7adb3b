//! `tltl.Settings` and `tltl.Schedule`: how a learner learns.

use pyo3::prelude::*;
use tltl::OutOfRange;
use tltl::learn::{self, Exploration, Memory, Updates};

use super::error::wrong;
use super::rewards::Rewards;

/// A number that changes while learning goes on.
#[pyclass(frozen, eq, from_py_object, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct Schedule(pub(crate) learn::Schedule);

fn out_of_range(error: OutOfRange) -> PyErr {
    wrong(error.to_string())
}

#[pymethods]
impl Schedule {
    /// Always the same.
    #[staticmethod]
    fn constant(value: f64) -> PyResult<Self> {
        learn::Schedule::constant(value).map(Self).map_err(out_of_range)
    }

    /// From one value to another in so many steps, and the other from then on.
    #[staticmethod]
    fn linear(start: f64, end: f64, steps: u64) -> PyResult<Self> {
        learn::Schedule::linear(start, end, steps).map(Self).map_err(out_of_range)
    }

    /// `start * half / (half + n)`: half of the start after `half`.
    #[staticmethod]
    fn harmonic(start: f64, half: f64) -> PyResult<Self> {
        learn::Schedule::harmonic(start, half).map(Self).map_err(out_of_range)
    }

    /// The value at `n`.
    fn at(&self, n: u64) -> f64 {
        self.0.at(n)
    }

    fn __repr__(&self) -> String {
        format!("<Schedule: {} at first, {} after 1000>", self.0.at(0), self.0.at(1000))
    }
}

/// A schedule, or a number that stays.
#[derive(FromPyObject)]
enum Given {
    Schedule(Schedule),
    Number(f64),
}

impl Given {
    fn schedule(self) -> PyResult<learn::Schedule> {
        match self {
            Self::Schedule(schedule) => Ok(schedule.0),
            Self::Number(value) => learn::Schedule::constant(value).map_err(out_of_range),
        }
    }
}

/// How a table is learned. The default learns what the task wants: it pays for acceptance, explores
/// towards what was tried least, and keeps its experience, so that the policy is that of the world as it
/// was seen, solved.
///
/// - `alpha`: the step size, at the number of earlier updates of the same entry.
/// - `epsilon`: the probability of an action that explores, at the number of earlier steps.
/// - `exploration`: `"coverage"`, towards what was tried least, or `"random"`.
/// - `horizon`: steps after which an episode is cut.
/// - `counterfactual`: whether a step updates all automaton states, or only the one it was taken in.
/// - `initial`: the value that entries start from.
/// - `remember`: whether experience is kept; without it the policy is the greedy one of the table.
///
/// Raises `ValueError` for what is out of its range, by its name.
///
/// >>> from tltl import Schedule, Settings
/// >>> Settings(epsilon=Schedule.linear(1.0, 0.05, 100_000), horizon=500).horizon
/// 500
#[pyclass(frozen, eq, from_py_object, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct Settings(pub(crate) learn::Settings);

#[pymethods]
impl Settings {
    #[new]
    #[pyo3(signature = (*, rewards=None, alpha=None, epsilon=None, exploration="coverage", horizon=200, counterfactual=true, initial=0.0, remember=true))]
    #[allow(clippy::too_many_arguments, reason = "each is a field")]
    fn new(
        rewards: Option<Rewards>,
        alpha: Option<Given>,
        epsilon: Option<Given>,
        exploration: &str,
        horizon: u64,
        counterfactual: bool,
        initial: f64,
        remember: bool,
    ) -> PyResult<Self> {
        let exploration = match exploration {
            "random" => Exploration::Random,
            "coverage" => Exploration::Coverage,
            other => {
                let message = format!("exploration is `{other}`, not `random` or `coverage`");
                return Err(wrong(message));
            }
        };
        let updates = if counterfactual { Updates::Counterfactual } else { Updates::Current };
        let memory = if remember { Memory::Experience } else { Memory::None };
        let mut settings = learn::Settings::default()
            .with_exploration(exploration)
            .with_updates(updates)
            .with_memory(memory);
        if let Some(rewards) = rewards {
            settings = settings.with_rewards(rewards.0);
        }
        if let Some(alpha) = alpha {
            settings = settings.with_alpha(alpha.schedule()?).map_err(out_of_range)?;
        }
        if let Some(epsilon) = epsilon {
            settings = settings.with_epsilon(epsilon.schedule()?).map_err(out_of_range)?;
        }
        let settings = settings.with_horizon(horizon).and_then(|s| s.with_initial(initial));
        settings.map(Self).map_err(out_of_range)
    }

    /// The recipe of the paper: `progress` with γ 0.95, α 0.1, random exploration, one update a step,
    /// no memory.
    #[staticmethod]
    fn paper() -> Self {
        Self(learn::Settings::paper())
    }

    /// What is paid, and the discount factor.
    #[getter]
    fn rewards(&self) -> Rewards {
        Rewards(self.0.rewards())
    }

    /// The learning rate, by the visits of a pair and action.
    #[getter]
    fn alpha(&self) -> Schedule {
        Schedule(self.0.alpha())
    }

    /// The probability of a random action, by steps.
    #[getter]
    fn epsilon(&self) -> Schedule {
        Schedule(self.0.epsilon())
    }

    /// `random`, or `coverage`: what was tried least.
    #[getter]
    fn exploration(&self) -> &'static str {
        match self.0.exploration() {
            Exploration::Random => "random",
            Exploration::Coverage => "coverage",
        }
    }

    /// The steps after which an episode is cut.
    #[getter]
    fn horizon(&self) -> u64 {
        self.0.horizon()
    }

    /// Whether each step updates all automaton states.
    #[getter]
    fn counterfactual(&self) -> bool {
        self.0.updates() == Updates::Counterfactual
    }

    /// The action values at the start.
    #[getter]
    fn initial(&self) -> f64 {
        self.0.initial()
    }

    /// Whether transitions are counted, so that the policy solves what was seen.
    #[getter]
    fn remember(&self) -> bool {
        self.0.memory() == Memory::Experience
    }

    fn __repr__(&self) -> String {
        format!(
            "Settings(rewards={:?}, exploration={:?}, horizon={})",
            self.0.rewards(),
            self.exploration(),
            self.0.horizon()
        )
    }
}
