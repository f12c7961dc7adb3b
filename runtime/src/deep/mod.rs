//! Deep Q-learning on the augmented MDP, for worlds whose states cannot be numbered (paper,
//! Section 5.2).
//!
//! A [`Skill`] is a task, what a network sees of a state, and which goals a step can be relabelled
//! with. A [`Learner`] trains its network by double DQN (van Hasselt et al. 2016) with prioritized
//! replay, targets normalised by PopArt (van Hasselt et al. 2016), n-step returns and a soft target network; a
//! [`Composition`] makes one skill of several from what they have seen, without a step in the world.
//!
//! The network has a [head](crate::network) for each live automaton state, and a step of the world
//! does not depend on q: so each replayed step updates *every* head (counterfactual updates), and,
//! where tasks have goals as parameters, it is relabelled with other goals ([`Relabel`]; universal
//! values, Schaul et al. 2015).
//!
//! The device is chosen at run time; everything random comes from the seed, so on the CPU the same
//! seed gives the same numbers. A loss, a weight or a feature that is not a finite number stops
//! learning with an [`Error`] that names it.

mod compose;
mod learner;
mod model;
mod popart;
mod replay;
mod settings;
#[cfg(test)]
mod tests;
mod trainer;

pub use burn::tensor::Device;

pub use compose::{Composition, Joint, Learned};
pub use learner::{Checkpoint, Learner};
pub use replay::Replay;
pub use settings::Settings;

use core::convert::Infallible;
use core::fmt;

use rand::Rng;

use crate::mismatch::Mismatch;
use crate::task;

/// What is to be learned: a task, and what a network sees of the world.
#[derive(Clone, Copy, Debug)]
pub struct Skill<M, F, G = AsGiven> {
    /// The task, a [`Monitor`](crate::monitor::Monitor) of the world's states.
    pub task: M,
    /// What the network sees, [`Features`](crate::network::Features).
    pub features: F,
    /// The goals that steps are relabelled with.
    pub goals: G,
}

impl<M, F> Skill<M, F> {
    /// A skill whose goal, if it has one, stays as the environment gives it.
    pub const fn new(task: M, features: F) -> Self {
        Self { task, features, goals: AsGiven }
    }
}

impl<M, F, G> Skill<M, F, G> {
    /// A skill whose steps are relabelled with `goals`.
    pub const fn with_goals(task: M, features: F, goals: G) -> Self {
        Self { task, features, goals }
    }
}

/// Goals that are part of the state, do not change what the world does, and may be exchanged in what
/// is replayed.
pub trait Relabel<S> {
    /// A goal.
    type Goal;

    /// A goal for a step from `state`; `None` leaves the one that was given. It must be chosen from
    /// what is known in `state` alone: by hindsight, what is hidden would seem to be wherever it was
    /// then found.
    fn choose<R: Rng + ?Sized>(&self, state: &S, rng: &mut R) -> Option<Self::Goal>;

    /// The state with another goal.
    fn give(&self, state: &S, goal: &Self::Goal) -> S;
}

/// No relabelling.
#[derive(Clone, Copy, Debug, Default)]
pub struct AsGiven;

impl<S: Clone> Relabel<S> for AsGiven {
    type Goal = Infallible;

    fn choose<R: Rng + ?Sized>(&self, _: &S, _: &mut R) -> Option<Infallible> {
        None
    }

    fn give(&self, state: &S, _: &Infallible) -> S {
        state.clone()
    }
}

/// Why learning stopped.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// A predicate is not a number.
    NotANumber(task::Error),
    /// A feature is not a finite number: the number of the feature, entities' after the state's.
    Feature(usize),
    /// The loss is not a finite number, at this update.
    Loss(u64),
    /// The environment paid what is not a finite number, at this step, counted from 1.
    Reward(u64),
    /// What belongs to different tasks or worlds was brought together.
    Mismatch(Mismatch),
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber(error) => error.fmt(f),
            Self::Feature(i) => write!(f, "feature {i} is not a finite number"),
            Self::Loss(update) => write!(
                f,
                "the loss of update {update} is not a finite number: learning has diverged; try a \
                 smaller learning rate"
            ),
            Self::Mismatch(error) => error.fmt(f),
            Self::Reward(step) => write!(f, "the reward of step {step} is not a finite number"),
        }
    }
}

impl std::error::Error for Error {}

impl From<Mismatch> for Error {
    fn from(error: Mismatch) -> Self {
        Self::Mismatch(error)
    }
}

impl From<task::Error> for Error {
    fn from(error: task::Error) -> Self {
        Self::NotANumber(error)
    }
}
