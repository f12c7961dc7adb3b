//! What a learner steps in: a model of probabilities, or an environment of Gymnasium.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::env::{FallibleEnv, ModelEnv, Step};
use tltl::learn::{Learner, TrainError};
use tltl::rand::Rng;

use super::error::wrong;
use super::labelled::States;
use super::model::{FiniteModel, Source};

/// Steps after which Python may interrupt learning in a model: some milliseconds.
const SLICE: u64 = 200_000;

/// The world of a learner.
pub(crate) enum World {
    Model(ModelEnv<Source>),
    Env(Environment),
}

impl World {
    /// Of a `FiniteModel`, or of an environment whose observations and actions can be numbered.
    pub(crate) fn new(world: &Bound<'_, PyAny>, seed: u64) -> PyResult<Self> {
        let Ok(model) = world.cast::<FiniteModel>() else {
            return Environment::new(world, seed).map(Self::Env);
        };
        let source = model.get().source.clone();
        let env = world.py().detach(|| ModelEnv::new(source));
        env.map(Self::Model).map_err(|error| wrong(error.to_string()))
    }

    /// The states as labels are asked for them: those of a model by number, those of an environment by
    /// observation.
    pub(crate) fn states<'py>(&self, given: &Bound<'py, PyAny>) -> PyResult<States<'py>> {
        let py = given.py();
        match self {
            Self::Model(_) => given.cast::<FiniteModel>()?.get().named(py),
            Self::Env(env) => {
                let one = |s| (env.observation.call1(py, (s,))?,).into_pyobject(py);
                let arguments = (0..env.states).map(one).collect::<PyResult<_>>()?;
                Ok(States { arguments, actions: env.actions })
            }
        }
    }

    /// Trains until so many steps have been taken in all, or a few milliseconds have passed.
    pub(crate) fn train(
        &mut self,
        py: Python<'_>,
        learner: &mut Learner,
        total: u64,
    ) -> PyResult<()> {
        let done = match self {
            Self::Model(env) => {
                let total = total.min(learner.steps() + SLICE);
                py.detach(|| learner.train(env, total))
            }
            Self::Env(env) => learner.train(env, total),
        };
        let failure = self.failure();
        done.map_err(|error| failure.unwrap_or_else(|| wrong(error.to_string())))
    }

    /// The exception that stopped training, if one did.
    fn failure(&mut self) -> Option<PyErr> {
        match self {
            Self::Model(_) => None,
            Self::Env(env) => env.failure.take(),
        }
    }
}

/// The exception is kept beside.
pub(crate) struct Failed;

impl From<Failed> for TrainError {
    fn from(_: Failed) -> Self {
        Self::Environment
    }
}

/// An environment of Gymnasium whose observations and actions are numbered.
pub(crate) struct Environment {
    env: Py<PyAny>,
    /// The number of an observation, and what has a number: `tltl._spaces`.
    number: Py<PyAny>,
    observation: Py<PyAny>,
    action: Py<PyAny>,
    states: usize,
    actions: usize,
    /// Of the first reset.
    seed: Option<u64>,
    failure: Option<PyErr>,
}

impl Environment {
    fn new(env: &Bound<'_, PyAny>, seed: u64) -> PyResult<Self> {
        let spaces = env.py().import("tltl._spaces")?;
        let of = |space: &str| -> PyResult<(usize, Bound<'_, PyAny>, Bound<'_, PyAny>)> {
            spaces.call_method1("numbered", (env.getattr(space)?,))?.extract()
        };
        let (states, number, observation) = of("observation_space")?;
        let (actions, _, action) = of("action_space")?;
        Ok(Self {
            env: env.clone().unbind(),
            number: number.unbind(),
            observation: observation.unbind(),
            action: action.unbind(),
            states,
            actions,
            seed: Some(seed),
            failure: None,
        })
    }

    fn keep<T>(&mut self, result: PyResult<T>) -> Result<T, Failed> {
        result.map_err(|error| {
            self.failure = Some(error);
            Failed
        })
    }

    fn state(&self, py: Python<'_>, observation: Bound<'_, PyAny>) -> PyResult<usize> {
        let state = self.number.call1(py, (observation,))?.extract(py)?;
        match state < self.states {
            true => Ok(state),
            false => Err(wrong(format!("an observation has number {state} of {}", self.states))),
        }
    }

    fn reset(&mut self) -> PyResult<usize> {
        Python::attach(|py| {
            // Between episodes Ctrl-C loses nothing.
            py.check_signals()?;
            let named = PyDict::new(py);
            named.set_item("seed", self.seed.take())?;
            let told = self.env.bind(py).call_method("reset", (), Some(&named))?;
            self.state(py, told.cast::<PyTuple>()?.get_item(0)?)
        })
    }

    fn step(&self, action: usize) -> PyResult<Step<usize>> {
        Python::attach(|py| {
            let action = self.action.call1(py, (action,))?;
            let told = self.env.bind(py).call_method1("step", (action,))?;
            let told = told.cast::<PyTuple>()?;
            Ok(Step {
                state: self.state(py, told.get_item(0)?)?,
                reward: told.get_item(1)?.extract()?,
                terminated: told.get_item(2)?.is_truthy()?,
                truncated: told.get_item(3)?.is_truthy()?,
            })
        })
    }
}

impl FallibleEnv for Environment {
    type Error = Failed;

    fn states(&self) -> usize {
        self.states
    }

    fn actions(&self) -> usize {
        self.actions
    }

    fn try_reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> Result<usize, Failed> {
        let start = self.reset();
        self.keep(start)
    }

    fn try_step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        _: &mut R,
    ) -> Result<Step<usize>, Failed> {
        let step = self.step(action);
        self.keep(step)
    }
}
