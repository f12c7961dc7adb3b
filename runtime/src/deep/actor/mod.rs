//! Continuous actions: an actor and critics on the augmented MDP (paper, Section 5.2: "for continuous
//! actions DDPG").
//!
//! [`Learner`] learns a [`Skill`](super::Skill) in a [`ContinuousEnv`](crate::env::ContinuousEnv). Its method is SAC (Haarnoja et al. 2018), whose
//! actor draws its actions while it learns; TD3 (Fujimoto et al. 2018) is the case of an actor that does not
//! ([`Settings::td3`]), and DDPG (Lillicrap et al. 2016) that with one critic ([`Settings::ddpg`]). What is judged, saved
//! and emitted draws nothing, whatever the method. Loop, replay, relabelling
//! of goals and rewards are those of the [learner of values](super::Learner), and so is the idea: the actor
//! and the critics have a head for each live automaton state, and each replayed step updates all of them.
//!
//! A [`Composition`] makes one skill of several from what they have seen, without a step in the world.
//!
//! Two potentials show the way, and leave the best policies what they are: that of the automaton
//! ([`Mode::Shaped`](crate::reward::Mode::Shaped), the default) and, with
//! [`Settings::with_robustness`], one within each automaton state, by how near the state of the world is to
//! a move that is progress.
//!
//! ```
//! use tltl::deep::actor::{Learner, Settings};
//! use tltl::deep::{Device, Skill};
//! use tltl::env::{ContinuousEnv, Step};
//! use tltl::network::Features;
//! use tltl::tltl;
//! use tltl::rand::Rng;
//!
//! /// A cart on a rail from -1 to 1 m, at most 0.2 m a step.
//! struct Cart(f32);
//!
//! impl ContinuousEnv for Cart {
//!     type State = f32;
//!     fn bounds(&self) -> Vec<(f32, f32)> {
//!         vec![(-0.2, 0.2)]
//!     }
//!     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 {
//!         self.0 = 0.0;
//!         self.0
//!     }
//!     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
//!         self.0 = (self.0 + action[0]).clamp(-1.0, 1.0);
//!         Step::to(self.0)
//!     }
//! }
//!
//! struct Place;
//!
//! impl Features<f32> for Place {
//!     fn inputs(&self) -> usize {
//!         1
//!     }
//!     fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) {
//!         inputs[0] = *s;
//!     }
//! }
//!
//! // To the right end, and back to the left one.
//! let task = tltl! { |x: &f32| F ({ *x } > 0.8 && F { *x } < -0.8) };
//! let settings = Settings::default()
//!     .with_hidden([32, 32])?
//!     .with_warmup(300)?
//!     .with_horizon(60)?
//!     .with_robustness(0.5)?;
//! let mut cart = Cart(0.0);
//! let mut learner = Learner::new(Skill::new(&task, Place), &cart, settings, &Device::flex(), 1);
//! learner.train(&mut cart, 1_500)?;
//! // Until it has been at the right end it drives right, then left.
//! assert!(learner.act(0, &0.0)?[0] > 0.05 && learner.act(1, &0.0)?[0] < -0.05);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod agent;
mod ascent;
mod compose;
mod learner;
mod settings;
mod stochastic;
mod sum;
#[cfg(test)]
mod tests;
mod trainer;

pub use compose::{Composition, Learned};
pub use learner::{Checkpoint, Learner};
pub use settings::Settings;
