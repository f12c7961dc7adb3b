//! Environments whose actions are vectors: A ⊆ ℝᵐ.

use alloc::string::{String, ToString};
use alloc::vec::Vec;

use rand::Rng;

use super::Step;

/// An environment with actions in a box of ℝᵐ.
///
/// ```
/// use tltl::env::{ContinuousEnv, Step};
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// /// A cart on a rail, in metres; the action is its speed, in metres for each step.
/// struct Cart(f32);
///
/// impl ContinuousEnv for Cart {
///     type State = f32;
///     fn bounds(&self) -> Vec<(f32, f32)> {
///         vec![(-0.1, 0.1)]
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 {
///         self.0 = 0.0;
///         self.0
///     }
///     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
///         self.0 = (self.0 + action[0]).clamp(-1.0, 1.0);
///         Step::to(self.0)
///     }
/// }
///
/// let (mut cart, mut rng) = (Cart(0.0), Xoshiro256PlusPlus::seed_from_u64(1));
/// cart.reset(&mut rng);
/// assert_eq!(cart.step(&[0.05], &mut rng).state, 0.05);
/// ```
pub trait ContinuousEnv {
    /// What an agent observes and predicates read.
    type State;

    /// The least and the largest value of each component of an action, in its own unit: m pairs of
    /// numbers, the first below the second, whose difference is finite too.
    fn bounds(&self) -> Vec<(f32, f32)>;

    /// Starts an episode and returns its first state, s_0.
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Self::State;

    /// Takes an action, within the [bounds](Self::bounds).
    ///
    /// After a step that ends the episode nothing is promised until the next [`Self::reset`].
    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Self::State>;

    /// What component `i` of an action is called where it is shown.
    fn component_name(&self, i: usize) -> String {
        i.to_string()
    }
}
