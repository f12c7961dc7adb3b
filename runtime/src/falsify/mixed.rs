//! A world in which some episodes start where a search has found.

use alloc::string::String;
use alloc::vec::Vec;

use rand::{Rng, RngExt as _};

use super::{DisturbedEnv, Error, Scenario};
use crate::env::{ContinuousEnv, Step, unit};
use crate::range::OutOfRange;

/// A world whose episodes start, a share of them, in given scenarios: to train on the worst.
///
/// The others start as the world has it and are not disturbed. Where no episode starts in a scenario, the
/// world's own start is taken.
///
/// ```
/// use tltl::env::ContinuousEnv;
/// use tltl::falsify::{MixedStarts, Scenario};
/// use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
/// # use tltl::env::Step;
/// # use tltl::falsify::DisturbedEnv;
/// # use tltl::rand::Rng;
/// # struct Cart(f64);
/// # impl ContinuousEnv for Cart {
/// #     type State = f64;
/// #     fn bounds(&self) -> Vec<(f32, f32)> { vec![(-0.2, 0.2)] }
/// #     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f64 { self.0 = 0.0; 0.0 }
/// #     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<f64> {
/// #         self.step_disturbed(action, &[0.0], rng)
/// #     }
/// # }
/// # impl DisturbedEnv for Cart {
/// #     fn start_bounds(&self) -> Vec<(f64, f64)> { vec![(-1.0, 1.0)] }
/// #     fn reset_at(&mut self, start: &[f64]) -> Option<f64> { self.0 = start[0]; Some(self.0) }
/// # }
///
/// let left = Scenario { start: vec![-1.0], disturbance: vec![] };
/// let mut world = MixedStarts::new(Cart(0.0), vec![left], 0.5, 100)?;
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// let starts: Vec<f64> = (0..1_000).map(|_| world.reset(&mut rng)).collect();
/// let share = starts.iter().filter(|&&x| x == -1.0).count();
/// assert!((450..550).contains(&share) && starts.contains(&0.0));
/// # Ok::<(), tltl::falsify::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct MixedStarts<E> {
    world: E,
    scenarios: Vec<Scenario>,
    share: f64,
    horizon: u64,
    /// The scenario of the episode and the steps it has taken.
    now: Option<usize>,
    taken: u64,
}

impl<E: DisturbedEnv> MixedStarts<E> {
    /// A world with a share of its episodes in one of the scenarios, each as likely; the disturbances are
    /// over `horizon` steps.
    ///
    /// # Errors
    /// If a scenario has more or fewer numbers than the world, or the share is not in \[0, 1\].
    pub fn new(
        world: E,
        scenarios: Vec<Scenario>,
        share: f64,
        horizon: u64,
    ) -> Result<Self, Error> {
        OutOfRange::check("share", share, (0.0..=1.0).contains(&share), "in [0, 1]")?;
        scenarios.iter().try_for_each(|scenario| scenario.check(&world))?;
        Ok(Self { world, scenarios, share, horizon, now: None, taken: 0 })
    }

    /// The world.
    #[must_use]
    pub fn into_inner(self) -> E {
        self.world
    }
}

impl<E: DisturbedEnv> ContinuousEnv for MixedStarts<E> {
    type State = E::State;

    fn bounds(&self) -> Vec<(f32, f32)> {
        self.world.bounds()
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> E::State {
        self.taken = 0;
        self.now = (!self.scenarios.is_empty() && unit(rng) < self.share)
            .then(|| rng.random_range(0..self.scenarios.len()));
        if let Some(i) = self.now
            && let Some(state) = self.world.reset_at(&self.scenarios[i].start)
        {
            return state;
        }
        self.now = None;
        self.world.reset(rng)
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<E::State> {
        let scenario = self.now.map(|i| &self.scenarios[i]);
        let disturbance = scenario.and_then(|s| s.disturbance(self.taken, self.horizon));
        self.taken += 1;
        match disturbance {
            Some(disturbance) => self.world.step_disturbed(action, disturbance, rng),
            None => self.world.step(action, rng),
        }
    }

    fn component_name(&self, i: usize) -> String {
        self.world.component_name(i)
    }
}
