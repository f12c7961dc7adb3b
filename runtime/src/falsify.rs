//! Falsification: the starts and disturbances from which a controller of continuous actions does worst.
//!
//! Trials from random starts ([`estimate`](crate::estimate)) say how often a controller satisfies its task. A
//! controller that fails from one start in a thousand passes 200 of them four times in five. [`falsify`] searches
//! for that start: it minimises the robustness of the episode over where it starts and, within bounds, over what
//! disturbs it. Robustness says by how much an episode satisfied the task, so a search can follow it down where
//! a verdict would say nothing.
//!
//! That is the problem and the form of the input signals of S-TaLiRo and psy-taliro (Annpureddy et al. 2011,
//! Thibeault et al. 2021): a disturbance is constant over each of some pieces of the episode. The search is
//! CMA-ES ([`Method::Evolution`]), which compares points and needs no slope, for robustness jumps where a
//! controller turns from one side of an obstacle to the other; [`Method::Random`] is what it is measured against.
//!
//! A search that finds no violation proves nothing. For a certificate of a finite world there is
//! [`solve`](crate::solve).
//!
//! [`MixedStarts`] is a world in which a learner trains on the starts that were found.

mod mixed;
mod search;

use alloc::vec::Vec;
use core::fmt;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng as _};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::env::{ContinuousEnv, Step};
use crate::estimate::{Played, play_from};
use crate::mismatch::Mismatch;
use crate::monitor::{Acceptor as _, Monitor};
use crate::range::OutOfRange;
use crate::robustness::Predicates;
use crate::task::{self, Task};
pub use mixed::MixedStarts;
use search::{Explored, Space, evolve, sample};
pub use search::{Method, Search};

/// A world whose episodes can be started where one wants, and disturbed.
///
/// Starts and disturbances are vectors of numbers within bounds, in units of the world.
///
/// ```
/// use tltl::env::{ContinuousEnv, Step};
/// use tltl::falsify::DisturbedEnv;
/// use tltl::rand::{Rng, RngExt as _};
///
/// /// A cart on a rail of 2 m; the action is its speed, in metres for each step.
/// struct Cart(f64);
///
/// impl ContinuousEnv for Cart {
///     type State = f64;
///     fn bounds(&self) -> Vec<(f32, f32)> {
///         vec![(-0.2, 0.2)]
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> f64 {
///         self.0 = 2.0 * rng.random::<f64>() - 1.0;
///         self.0
///     }
///     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<f64> {
///         self.step_disturbed(action, &[0.0], rng)
///     }
/// }
///
/// impl DisturbedEnv for Cart {
///     fn start_bounds(&self) -> Vec<(f64, f64)> {
///         vec![(-1.0, 1.0)]
///     }
///     fn reset_at(&mut self, start: &[f64]) -> Option<f64> {
///         self.0 = start[0];
///         Some(self.0)
///     }
///     // A slope of the rail.
///     fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
///         vec![(-0.05, 0.05)]
///     }
///     fn step_disturbed<R: Rng + ?Sized>(&mut self, action: &[f32], slope: &[f64], _: &mut R) -> Step<f64> {
///         self.0 = (self.0 + f64::from(action[0]) + slope[0]).clamp(-1.0, 1.0);
///         Step::to(self.0)
///     }
/// }
/// ```
pub trait DisturbedEnv: ContinuousEnv {
    /// The least and the largest value of each number of a start: finite, and the first not above the second.
    fn start_bounds(&self) -> Vec<(f64, f64)>;

    /// Starts an episode there, and returns its first state; `None` where no episode starts, within an
    /// obstacle for example. `start` has a number within each of the [bounds](Self::start_bounds).
    fn reset_at(&mut self, start: &[f64]) -> Option<Self::State>;

    /// The least and the largest value of each component of a disturbance, as those of starts. None if the
    /// world is not disturbed.
    fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
        Vec::new()
    }

    /// [`step`](ContinuousEnv::step) under a disturbance within the [bounds](Self::disturbance_bounds).
    fn step_disturbed<R: Rng + ?Sized>(
        &mut self,
        action: &[f32],
        disturbance: &[f64],
        rng: &mut R,
    ) -> Step<Self::State> {
        let _ = disturbance;
        self.step(action, rng)
    }
}

/// Where an episode starts, and what disturbs it.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Scenario {
    /// The numbers of the start, as [`DisturbedEnv::start_bounds`] has them.
    pub start: Vec<f64>,
    /// The disturbance in each of the pieces of the episode, which are of equal length. None: the episode is
    /// not disturbed.
    pub disturbance: Vec<Vec<f64>>,
}

impl Scenario {
    /// The disturbance of step `t`; the last piece lasts beyond the horizon.
    #[inline]
    fn disturbance(&self, t: u64, horizon: u64) -> Option<&[f64]> {
        let last = self.disturbance.len().checked_sub(1)?;
        let piece = u128::from(t) * self.disturbance.len() as u128 / u128::from(horizon.max(1));
        Some(&self.disturbance[last.min(piece as usize)])
    }

    /// `Ok` if it has as many numbers as the world wants.
    fn check<E: DisturbedEnv>(&self, world: &E) -> Result<(), Error> {
        let (start, disturbance) = (world.start_bounds().len(), world.disturbance_bounds().len());
        let odd = self.disturbance.iter().map(Vec::len).find(|&len| len != disturbance);
        if self.start.len() == start && odd.is_none() {
            return Ok(());
        }
        let of = |start, disturbance| {
            alloc::format!(
                "a world of {start} numbers of a start and {disturbance} of a disturbance"
            )
        };
        let found = of(self.start.len(), odd.unwrap_or(disturbance));
        Err(Mismatch::new("a scenario", found, of(start, disturbance)).into())
    }
}

/// Plays one episode of a policy, `act(q, s)`, in a scenario; `None` where no episode starts.
///
/// As [`play`](crate::estimate::play) does. The pieces of the disturbance are parts of `horizon` steps.
///
/// # Errors
/// If the scenario has more or fewer numbers than the world, a predicate is not a number at a state that was met,
/// or the first error of `act`; no step is taken then.
pub fn replay<E: DisturbedEnv, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    world: &mut E,
    monitor: &M,
    scenario: &Scenario,
    horizon: u64,
    rng: &mut R,
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, F>,
) -> Result<Option<Played<E::State>>, F> {
    scenario.check(world)?;
    let Some(first) = world.reset_at(&scenario.start) else {
        return Ok(None);
    };
    // Predicates fail in their own type, which `F` need not know.
    let act = |q, s: &E::State| act(q, s).map_err(Fault::Act);
    let step = |t, action: &[f32]| match scenario.disturbance(t, horizon) {
        Some(disturbance) => world.step_disturbed(action, disturbance, rng),
        None => world.step(action, rng),
    };
    match play_from(first, monitor, horizon, act, step) {
        Ok(played) => Ok(Some(played)),
        Err(Fault::Task(error)) => Err(Error::Task(error).into()),
        Err(Fault::Act(error)) => Err(error),
    }
}

/// What stops an episode.
enum Fault<F> {
    Task(task::Error),
    Act(F),
}

impl<F> From<task::Error> for Fault<F> {
    fn from(error: task::Error) -> Self {
        Self::Task(error)
    }
}

/// A scenario, and what came of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Found<S> {
    /// Where the episode started and what disturbed it.
    pub scenario: Scenario,
    /// The robustness of the episode, in the units of the predicates: by how much it satisfied the task or, if
    /// negative, missed it. An episode that was cut counts as what it is, a trajectory that ends there.
    pub robustness: f64,
    /// Whether the task was satisfied.
    pub satisfied: bool,
    /// The episode.
    pub episode: Played<S>,
}

/// What a search found.
#[derive(Clone, Debug, PartialEq)]
pub struct Falsified<S> {
    /// The worst scenarios, the worst of them first, apart from each other by [`Search::apart`]; one at least.
    pub worst: Vec<Found<S>>,
    /// The episodes that were played.
    pub episodes: u64,
    /// How many of them did not satisfy the task.
    pub violations: u64,
    /// Points of the search where no episode starts.
    pub refused: u64,
}

impl<S> Falsified<S> {
    /// The lowest robustness that was found.
    #[must_use]
    pub fn robustness(&self) -> f64 {
        self.worst[0].robustness
    }

    /// Whether an episode was found that does not satisfy the task.
    #[must_use]
    pub const fn is_falsified(&self) -> bool {
        self.violations > 0
    }
}

/// Searches for the scenarios in which a policy, `act(q, s)`, has the lowest robustness.
///
/// Each episode has the same random numbers, those of the [seed](Search::seed), so that a scenario has one
/// robustness. `act` must give the same action for the same state.
///
/// ```
/// use tltl::falsify::{Error, Method, Search, falsify};
/// # use tltl::env::{ContinuousEnv, Step};
/// # use tltl::falsify::DisturbedEnv;
/// # use tltl::rand::Rng;
/// use tltl::tltl;
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
/// #     fn disturbance_bounds(&self) -> Vec<(f64, f64)> { vec![(-0.05, 0.05)] }
/// #     fn step_disturbed<R: Rng + ?Sized>(&mut self, action: &[f32], slope: &[f64], _: &mut R) -> Step<f64> {
/// #         self.0 = (self.0 + f64::from(action[0]) + slope[0]).clamp(-1.0, 1.0);
/// #         Step::to(self.0)
/// #     }
/// # }
///
/// // The cart of `DisturbedEnv`: to the right end within two seconds of ten steps each.
/// let task = tltl! { |x: &f64| F[0,20] ({ *x } > 0.8) };
/// let slow = |_: u32, _: &f64| Ok::<_, Error>(vec![0.1]);
/// let search = Search::default().with_evaluations(300)?.with_horizon(20)?;
/// // It comes there from everywhere, in 18 steps from the left end ...
/// let found = falsify(&mut Cart(0.0), &task, &search, slow)?;
/// assert!(!found.is_falsified());
/// // ... but not up a slope that is steep enough. The worst start is the left end.
/// let found = falsify(&mut Cart(0.0), &task, &search.with_pieces(1)?, slow)?;
/// assert!(found.is_falsified() && found.robustness() < -0.7);
/// let worst = &found.worst[0].scenario;
/// assert!(worst.start[0] < -0.9 && worst.disturbance[0][0] < -0.045);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If a bound is not finite or the first of a pair is above the second, the world has nothing to be searched, no
/// start was found, a predicate is not a number at a state that was met, or the first error of `act`.
pub fn falsify<E, P, F>(
    world: &mut E,
    task: &Task<P>,
    search: &Search,
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, F>,
) -> Result<Falsified<E::State>, F>
where
    E: DisturbedEnv,
    P: Predicates<E::State>,
    F: From<Error>,
{
    let space = Space::of(world, search)?;
    let mut explored = Explored::new(search);
    let mut at = |point: &[f64]| -> Result<Option<f64>, F> {
        let scenario = space.scenario(point);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(search.seed());
        let Some(episode) = replay(world, task, &scenario, search.horizon(), &mut rng, &mut act)?
        else {
            explored.refused += 1;
            return Ok(None);
        };
        let robustness = task.robustness(&episode.states).map_err(Error::Task)?;
        let satisfied = task.is_accepting(episode.last());
        explored.add(point, Found { scenario, robustness, satisfied, episode });
        Ok(Some(robustness))
    };
    match search.method() {
        Method::Random => sample(&space.widths(), search, &mut at)?,
        Method::Evolution => evolve(&space.widths(), search, &mut at)?,
    }
    Ok(explored.finish()?)
}

/// Why nothing was found.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Error {
    /// A predicate is not a number at a state that was met.
    Task(task::Error),
    /// A bound of the world is not finite, or the first of a pair is above the second.
    Bounds {
        /// `start` or `disturbance`.
        of: &'static str,
        /// The place of the pair.
        index: usize,
        /// The pair.
        bounds: (f64, f64),
    },
    /// Starts have no numbers, and nothing is disturbed.
    Nothing,
    /// An episode starts nowhere that was tried.
    NoStart {
        /// The number of points that were tried.
        tried: u64,
    },
    /// A scenario is of another world.
    Mismatch(Mismatch),
    /// A setting is out of its range.
    Setting(OutOfRange),
}

impl fmt::Display for Error {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Task(error) => error.fmt(f),
            Self::Bounds { of, index, bounds: (low, high) } => write!(
                f,
                "the bounds of number {index} of a {of} are {low} and {high}, not two finite numbers in ascending order"
            ),
            Self::Nothing => f.write_str(
                "there is nothing to search: starts have no numbers, and nothing is disturbed",
            ),
            Self::NoStart { tried } => {
                write!(f, "no episode starts at any of the {tried} points that were tried")
            }
            Self::Mismatch(error) => error.fmt(f),
            Self::Setting(error) => error.fmt(f),
        }
    }
}

impl core::error::Error for Error {}

impl From<task::Error> for Error {
    #[inline]
    fn from(error: task::Error) -> Self {
        Self::Task(error)
    }
}

impl From<Mismatch> for Error {
    #[inline]
    fn from(error: Mismatch) -> Self {
        Self::Mismatch(error)
    }
}

impl From<OutOfRange> for Error {
    #[inline]
    fn from(error: OutOfRange) -> Self {
        Self::Setting(error)
    }
}
