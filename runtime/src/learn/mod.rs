//! Tabular Q-learning on the FSA-augmented MDP.
//!
//! A [`Learner`] turns experience of a finite environment into a policy; its [`Settings`] say how, and
//! its [`Experience`] is what finishing and composition need. Behind a
//! [`Shield`](crate::shield::Shield) it explores by allowed actions only. [`TrajectoryLearner`] is the
//! baseline that is paid at the end of episodes only.
//! All learners run in the one loop of [`episode`]. Networks are trained in `deep`.
//!
//! [`Settings::default`] learns what the task wants, the largest P(satisfied) and then the fewest steps:
//! it pays for acceptance alone, and who asks for the [policy](Learner::policy) gets that of the world as
//! it was seen, solved. `docs/studies/tasks.md` has how near that comes to the best on 13 tasks in 15
//! worlds. What lies beside a trap must be visited often: where an action was tried 5,000 times, a risk
//! of 4 % is known to ±0.28 %.
//!
//! On the way no value is needed: actions explore, [towards what was tried least](Exploration::Coverage).
//! With ε < 1, or without experience, a table is updated. A world's step does not depend on q, so each one
//! updates *every* live automaton state (counterfactual updates, Toro Icarte et al. 2018), and the step
//! size falls with the visits. [`Settings::paper`] is the paper's recipe, and its policy the greedy one of
//! that table.

mod checkpoint;
mod coverage;
mod learner;
#[cfg(feature = "std")]
mod seeds;
mod shielding;
mod table;
mod trajectory;

use core::convert::Infallible;
use core::fmt;

pub use checkpoint::Checkpoint;
pub use learner::Learner;
#[cfg(feature = "std")]
pub use seeds::{seeds, seeds_on};
pub use trajectory::{Observation, TerminalReward, TrajectoryLearner};

pub use crate::episode;
pub use crate::experience::Experience;
use crate::mismatch::Mismatch;
pub use crate::settings::{Exploration, Memory, Schedule, Settings, Updates};
use crate::task;

/// Why training stopped.
///
/// What was learned until then is kept: the learner can be saved, or trained on in another environment.
///
/// ```
/// use tltl::learn::TrainError;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let task = Labelled::new(0..3, ["go"], &tltl! { |s: &usize| F ({ *s } == 2) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 1);
/// let mut larger = ModelEnv::new(model::from_fn(4, 1, |s, _| [(s, 1.0)]))?;
/// let error = learner.train(&mut larger, 100).unwrap_err();
/// assert!(matches!(error, TrainError::Mismatch(_)) && learner.steps() == 0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TrainError {
    /// The environment, or a shield, is of another world or task.
    Mismatch(Mismatch),
    /// A predicate is not a number at a state that was met.
    NotANumber(task::Error),
    /// The environment paid what is not a finite number, at this step, counted from 1.
    Reward(u64),
    /// The environment failed, and knows why: a [`FallibleEnv`](crate::env::FallibleEnv).
    Environment,
}

impl fmt::Display for TrainError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Mismatch(error) => error.fmt(f),
            Self::NotANumber(error) => error.fmt(f),
            Self::Environment => f.write_str("the environment failed"),
            Self::Reward(step) => write!(f, "the reward of step {step} is not a finite number"),
        }
    }
}

impl core::error::Error for TrainError {}

impl From<Mismatch> for TrainError {
    #[inline]
    fn from(error: Mismatch) -> Self {
        Self::Mismatch(error)
    }
}

impl From<task::Error> for TrainError {
    #[inline]
    fn from(error: task::Error) -> Self {
        Self::NotANumber(error)
    }
}

impl From<Infallible> for TrainError {
    #[inline]
    fn from(never: Infallible) -> Self {
        match never {}
    }
}
