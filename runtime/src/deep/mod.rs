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
//! The default reward is potential shaping ([`Mode::Shaped`](crate::reward::Mode::Shaped)), whose best
//! policies are those of acceptance. The paper's `Progress` pays for each move of the automaton, and where
//! the automaton has a way back, for coming again: on `F (a && X a && X X a)` its optimum leaves a and
//! comes back for ever, and never satisfies the task. There it is refused ([`Error::WayBack`]). On a row of
//! nine cells, 1,500 steps and five seeds, the default reaches the fewest steps on that task with all seeds
//! (acceptance alone with three); on `F a || (b T (a || c))`, which has no way back, too, where `Progress`
//! takes 22 to 42 % more; on `a T b`, with the ends of the row, with four seeds, `Progress` with all five.
//!
//! ```
//! use tltl::deep::{Device, Error, Learner, Settings, Skill};
//! use tltl::model;
//! use tltl::network::Features;
//! use tltl::prelude::*;
//! # struct Place;
//! # impl Features<usize> for Place {
//! #     fn inputs(&self) -> usize { 3 }
//! #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
//! # }
//!
//! let a = |s: &usize| if *s == 2 { 1.0 } else { -1.0 };
//! let stay = tltl! { F (a && X a && X X a) };
//! let row = model::from_fn(3, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(2)][a], 1.0)]);
//! let mut env = ModelEnv::new(row)?;
//! let settings = Settings::default().with_hidden([8])?.with_rewards(Rewards::progress());
//! let mut learner = Learner::new(Skill::new(&stay, Place), &env, settings, &Device::flex(), 1);
//! assert!(matches!(learner.train(&mut env, 100), Err(Error::WayBack(_))));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The device is chosen at run time; everything random comes from the seed, so on the CPU the same
//! seed gives the same numbers. A loss, a weight or a feature that is not a finite number stops
//! learning with an [`Error`] that names it.
//!
//! Weak points: nothing here is guaranteed as it is for tables. Values are kept within what the task
//! can pay, which keeps learning from diverging, but what a network has learned is known only by trying
//! it: [`estimate`](crate::estimate::estimate()) with unseen starts. One seed says little; of five seeds
//! of the kitchen's hidden goals three reach 99 % and two stay at 92 and 96 %, for a policy may go round in
//! a circle (`docs/studies/kitchen_notes.md`).

pub mod actor;
mod compose;
mod layers;
mod learner;
mod model;
mod popart;
mod replay;
mod sample;
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
use std::string::String;

use rand::Rng;

use crate::mismatch::Mismatch;
use crate::task;

/// What is to be learned: a task, and what a network sees of the world.
///
/// Each part may be a reference. A step of the world is learned from for the task, with the features,
/// under the goals; nothing else is known of the world.
///
/// ```
/// use tltl::deep::Skill;
/// use tltl::network::Features;
/// use tltl::tltl;
///
/// struct Place;
///
/// impl Features<f64> for Place {
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn write(&self, s: &f64, inputs: &mut [f32], _: &mut [f32]) {
///         inputs[0] = *s as f32;
///     }
/// }
///
/// let far = tltl! { |x: &f64| F ({ *x } > 3) };
/// let skill = Skill::new(&far, Place);
/// assert_eq!((skill.features.inputs(), tltl::Acceptor::states(&skill.task)), (1, 2));
/// ```
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
///
/// This is how one network learns a task for all its goals: each replayed step is also a step on the way
/// to another goal, whose automaton moves and rewards are computed anew.
///
/// ```
/// use tltl::deep::{Relabel, Skill};
/// use tltl::network::Features;
/// use tltl::rand::{Rng, RngExt as _, SeedableRng, rngs::Xoshiro256PlusPlus};
/// use tltl::tltl;
///
/// /// A place among ten, and the one that is wanted.
/// #[derive(Clone, Copy, PartialEq, Debug)]
/// struct Walk {
///     place: u8,
///     wanted: u8,
/// }
///
/// /// Any place may be wanted.
/// struct Anywhere;
///
/// impl Relabel<Walk> for Anywhere {
///     type Goal = u8;
///     fn choose<R: Rng + ?Sized>(&self, _: &Walk, rng: &mut R) -> Option<u8> {
///         Some((rng.next_u32() % 10) as u8)
///     }
///     fn give(&self, s: &Walk, wanted: &u8) -> Walk {
///         Walk { wanted: *wanted, ..*s }
///     }
/// }
///
/// struct Distance;
///
/// impl Features<Walk> for Distance {
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn write(&self, s: &Walk, inputs: &mut [f32], _: &mut [f32]) {
///         inputs[0] = (f32::from(s.wanted) - f32::from(s.place)) / 10.0;
///     }
/// }
///
/// let arrive = tltl! { |s: &Walk| F (s.place == s.wanted) };
/// let skill = Skill::with_goals(arrive, Distance, Anywhere);
/// let s = Walk { place: 3, wanted: 7 };
/// assert_eq!(skill.goals.give(&s, &3), Walk { place: 3, wanted: 3 });
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// assert!(skill.goals.choose(&s, &mut rng).is_some_and(|goal| goal < 10));
/// ```
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
///
/// Of a task without goals, or with a goal that says something of the world and so cannot be exchanged.
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
///
/// What was learned until then is kept; after [`Error::Loss`] the network is as it was before that
/// update, which is seldom worth keeping.
///
/// ```
/// use tltl::deep::{Device, Error, Learner, Settings, Skill};
/// use tltl::model;
/// use tltl::network::Features;
/// use tltl::prelude::*;
///
/// /// A sensor that fails in cell 1.
/// struct Sensor;
///
/// impl Features<usize> for Sensor {
///     fn inputs(&self) -> usize {
///         2
///     }
///     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) {
///         inputs[1] = if *s == 1 { f32::NAN } else { 0.0 };
///     }
/// }
///
/// let env = ModelEnv::new(model::from_fn(3, 1, |s, _| [((s + 1).min(2), 1.0)]))?;
/// let skill = Skill::new(tltl! { |s: &usize| F ({ *s } == 2) }, Sensor);
/// let settings = Settings::default().with_hidden([4])?;
/// let mut learner = Learner::new(skill, &env, settings, &Device::flex(), 1);
/// assert!(learner.act(0, &0).is_ok());
/// assert_eq!(learner.act(0, &1), Err(Error::Feature(1)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// The reward pays for moves of the automaton, and the automaton of this task has a way back.
    WayBack(String),
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
                "the loss of update {update} is not a finite number: learning has diverged, for which a \
                 smaller learning rate may help, or a feature or a reward is too large"
            ),
            Self::WayBack(task) => write!(
                f,
                "`{task}`: its automaton has a way back, and `Progress` pays each time for coming again: the \
                 best policy for it need never satisfy the task; take `Rewards::of(Mode::Shaped)`, the default"
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
