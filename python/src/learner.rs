//! `tltl.Learner`: the tabular learner of the crate, in a finite model or in an environment.

use std::path::PathBuf;

use pyo3::prelude::*;
use tltl::augmented::Labelled;
use tltl::learn::{self, Checkpoint};

use super::array::frozen;
use super::certificate::Certificate;
use super::error::wrong;
use super::labelled::{labelled, task_of};
use super::model::FiniteModel;
use super::policy::Policy;
use super::settings::Settings;
use super::solution::Solution;
use super::task::Task;
use super::world::World;

/// A tabular learner of a task in a finite world, of which it sees samples only.
///
/// The world is a `FiniteModel`, and then no Python runs while it learns, and other threads do. Or it
/// is an environment of Gymnasium whose observations and actions are numbers (`Discrete`,
/// `MultiDiscrete`, `MultiBinary`, or `Tuple` of them), which are numbered from 0, the last axis
/// fastest. What ends an episode there is the environment's own matter, and an exception in it stops
/// training, with what was learned until then.
///
/// `labels` as for `solve`, of an observation for an environment. All that is random comes from
/// `seed`: the same arguments give the same policy.
///
/// >>> import gymnasium as gym
/// >>> from tltl import FiniteModel, Learner, solve
/// >>> model = FiniteModel.from_env(gym.make("FrozenLake-v1", is_slippery=False))
/// >>> task, labels = "corner T goal", lambda s: {"corner": s == 3, "goal": s == 15}
/// >>> learner = Learner(model, task, labels, seed=1).train(50_000)
/// >>> worth = learner.certify(solve(model, task, labels))
/// >>> worth.satisfied, worth.steps
/// (1.0, 8.0)
#[pyclass(module = "tltl")]
pub struct Learner {
    inner: learn::Learner,
    world: World,
    /// The world as it was given.
    given: Py<PyAny>,
    task: Task,
}

impl Learner {
    pub(crate) const fn inner(&self) -> &learn::Learner {
        &self.inner
    }

    pub(crate) fn horizon(&self) -> Option<u64> {
        Python::attach(|py| Some(self.given.bind(py).cast::<FiniteModel>().ok()?.get().horizon))?
    }

    fn labelled(&self) -> &Labelled {
        self.inner.task()
    }
}

#[pymethods]
impl Learner {
    #[new]
    #[pyo3(signature = (world, task, labels, *, settings=None, seed=0))]
    fn new(
        world: Bound<'_, PyAny>,
        task: &Bound<'_, PyAny>,
        labels: &Bound<'_, PyAny>,
        settings: Option<Settings>,
        seed: u64,
    ) -> PyResult<Self> {
        let task = task_of(task)?;
        let settings = settings.map_or_else(learn::Settings::default, |settings| settings.0);
        let (given, world) = (world.clone().unbind(), World::new(&world, seed)?);
        let states = world.states(given.bind(labels.py()))?;
        let labelled = labelled(&states, &task, labels, Some(&settings.rewards()))?;
        Ok(Self { inner: learn::Learner::new(&labelled, settings, seed), world, given, task })
    }

    /// Trains until so many steps have been taken in all, and returns the learner. Episodes are whole,
    /// so the last one may exceed it; slices change nothing.
    ///
    /// Ctrl-C stops between episodes: what was learned is kept.
    fn train(mut learner: PyRefMut<'_, Self>, steps: u64) -> PyResult<PyRefMut<'_, Self>> {
        let py = learner.py();
        while learner.inner.steps() < steps {
            let before = learner.inner.steps();
            let Self { inner, world, .. } = &mut *learner;
            world.train(py, inner, steps)?;
            py.check_signals()?;
            if learner.inner.steps() == before {
                return Err(wrong("the task is decided at every start that was drawn"));
            }
        }
        Ok(learner)
    }

    /// The policy that was learned: that of the world as it was seen, solved. It says how it was
    /// learned. Each call solves anew.
    fn policy(&self, py: Python<'_>) -> Policy {
        py.detach(|| Policy(self.inner.policy()))
    }

    /// What `policy` is worth in the model that was solved.
    ///
    /// Raises `ValueError` if that is another task or another world.
    fn certify(&self, py: Python<'_>, solution: &Solution) -> PyResult<Certificate> {
        let policy = py.detach(|| self.inner.policy());
        Ok(solution.report(py, &policy, None)?.into())
    }

    /// The action values of the world as it was seen: float64, of shape (automaton states, states,
    /// actions).
    #[getter]
    #[allow(non_snake_case, reason = "the field's name")]
    fn Q<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let q = py.detach(|| self.inner.q());
        let task = self.labelled();
        let shape = [task.automaton_states() as usize, task.states(), task.actions()];
        frozen(py, q.values().to_vec(), &shape)
    }

    /// The world as it was seen: a model with the frequencies as probabilities. An action that was
    /// never tried in a state stays there.
    ///
    /// Raises `ValueError` where nothing is remembered.
    #[getter]
    fn experience(&self, py: Python<'_>) -> PyResult<FiniteModel> {
        if self.inner.settings().memory() == learn::Memory::None {
            return Err(wrong("nothing is remembered: settings.remember is False"));
        }
        let seen = self.inner.experience().clone();
        match self.given.bind(py).cast::<FiniteModel>() {
            Ok(model) => model.get().as_seen(py, seen),
            Err(_) => FiniteModel::seen(py, seen),
        }
    }

    /// What it learns in.
    #[getter]
    fn world(&self, py: Python<'_>) -> Py<PyAny> {
        self.given.clone_ref(py)
    }

    /// The task that it learns.
    #[getter]
    fn task(&self) -> Task {
        self.task.clone()
    }

    /// How it learns.
    #[getter]
    fn settings(&self) -> Settings {
        Settings(*self.inner.settings())
    }

    /// The seed.
    #[getter]
    fn seed(&self) -> u64 {
        self.inner.training().seed
    }

    /// Steps so far.
    #[getter]
    fn steps(&self) -> u64 {
        self.inner.steps()
    }

    /// Episodes so far.
    #[getter]
    fn episodes(&self) -> u64 {
        self.inner.episodes()
    }

    /// Writes all that learning has changed to a file, which is replaced as a whole.
    ///
    /// Raises `OSError` if it cannot be written.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        let text = py.detach(|| serde_json::to_vec(&self.inner.checkpoint()));
        let text = text.map_err(|error| wrong(error.to_string()))?;
        Ok(py.detach(|| tltl::file::replace(&path, &text))?)
    }

    /// Goes on where the learner was that wrote the file, with its settings and its seed: the same
    /// numbers as without a break.
    ///
    /// Raises `ValueError` if that learner had another task or another world.
    fn load(mut learner: PyRefMut<'_, Self>, path: PathBuf) -> PyResult<PyRefMut<'_, Self>> {
        let py = learner.py();
        let text = py.detach(|| std::fs::read(path))?;
        let saved: Checkpoint =
            serde_json::from_slice(&text).map_err(|error| wrong(error.to_string()))?;
        let resumed = learn::Learner::resume(learner.labelled(), saved);
        learner.inner = resumed.map_err(|error| wrong(error.to_string()))?;
        Ok(learner)
    }

    fn __repr__(&self) -> String {
        let (steps, episodes) = (self.inner.steps(), self.inner.episodes());
        format!("<Learner of `{}`: {steps} steps, {episodes} episodes>", self.labelled().name())
    }
}
