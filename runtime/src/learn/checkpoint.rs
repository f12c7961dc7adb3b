//! What a saved learner holds.
//!
//! The fields and their order are those of earlier versions, whose files are read; the task, the seed and
//! the coverage came later, and stand at the end.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use rand::rngs::Xoshiro256PlusPlus;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::{Experience, Settings};
use crate::augmented::Labelled;
use crate::episode::Elapsed;
use crate::mismatch::Mismatch;

/// All that learning changes, and which task it was for: what is saved of a
/// [`Learner`](super::Learner) and resumed.
///
/// With serde it is saved in any format; serde_json reads floats back exactly only with its feature
/// `float_roundtrip`.
///
/// It holds no tables of the task: the one that is given on resuming is compared by a checksum over all
/// its moves, so a checkpoint is refused where the formula or the world has changed, even if all sizes
/// are the same.
///
/// ```
/// use tltl::learn::Checkpoint;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let mut env = ModelEnv::new(model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]))?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 1) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 7);
/// learner.train(&mut env, 100)?;
/// let text = serde_json::to_string(&learner.checkpoint())?;
/// let saved: Checkpoint = serde_json::from_str(&text)?;
/// assert_eq!(Learner::resume(&task, saved.clone())?, learner);
///
/// let other = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 0) })?;
/// assert!(Learner::resume(&other, saved).unwrap_err().to_string().contains("does not fit"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Checkpoint {
    pub(super) settings: Settings,
    pub(super) q: SavedValues,
    pub(super) visits: Vec<u32>,
    pub(super) experience: Experience,
    pub(super) rng: Xoshiro256PlusPlus,
    pub(super) done: Elapsed,
    /// Not there in files of earlier versions, which are known by their sizes alone.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub(super) task: Option<Identity>,
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) seed: u64,
    /// How far each (s, a) is from what was tried least; none where exploration is random.
    #[cfg_attr(feature = "serde", serde(default))]
    pub(super) coverage: Vec<u32>,
}

/// Action values as they are saved.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(super) struct SavedValues {
    pub(super) values: Vec<f64>,
    pub(super) states: usize,
    pub(super) actions: usize,
}

/// Which task on which world a checkpoint is of: a name to show, and a checksum to compare.
///
/// The name and the formula are not compared: one task may be written in several ways.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub(super) struct Identity {
    name: String,
    formula: String,
    automaton_states: u32,
    /// Of the automaton's moves on the states of the world.
    checksum: String,
}

impl Identity {
    #[inline]
    pub(super) fn of(task: &Labelled) -> Self {
        Self {
            name: task.name().to_string(),
            formula: task.formula().to_string(),
            automaton_states: task.automaton_states(),
            checksum: alloc::format!("{:016x}", task.checksum()),
        }
    }
}

impl Checkpoint {
    /// `Ok` if it is of `task`, whose updates are counted in so many `entries` and of which exploration
    /// covers so many states. It may come from a
    /// file, so sizes and entries are compared too: what passes cannot panic later.
    #[inline]
    pub(super) fn must_be_of(
        &self,
        task: &Labelled,
        entries: usize,
        covered: usize,
    ) -> Result<(), Mismatch> {
        let Self { q, visits, experience, .. } = self;
        let own = Identity::of(task);
        let same = self.task.as_ref().is_none_or(|found| {
            (found.automaton_states, &found.checksum) == (own.automaton_states, &own.checksum)
        });
        let remembered = if self.settings.remembers() { task.states() } else { 0 };
        let values = task.pairs() * task.actions();
        let (states, actions) = (task.states(), task.actions());
        let own_sizes = (q.values.len(), q.states, q.actions, visits.len(), self.coverage.len());
        let sized = own_sizes == (values, states, actions, entries, covered * actions);
        if same && sized && experience.is_of(remembered, actions) {
            return Ok(());
        }
        let mismatch = Mismatch::new("a checkpoint", self.describe(), task.describe());
        let alike = mismatch.found() == mismatch.expected();
        Err(if alike { mismatch.in_that("the automata move differently".into()) } else { mismatch })
    }

    #[inline]
    fn describe(&self) -> String {
        let SavedValues { values, states, actions } = &self.q;
        let (name, automaton) = match &self.task {
            Some(task) => (alloc::format!("`{}`", task.name), task.automaton_states as usize),
            None => ("a task".into(), values.len() / states.saturating_mul(*actions).max(1)),
        };
        alloc::format!("{name} ({automaton} automaton states, {states} states, {actions} actions)")
    }
}
