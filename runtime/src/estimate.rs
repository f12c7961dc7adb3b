//! What a policy is worth in a world without a model: Monte-Carlo estimates with confidence
//! intervals.
//!
//! - Where the number of episodes is fixed beforehand ([`estimate()`]), probabilities get the exact
//!   interval of Clopper and Pearson, and the mean number of steps of the successful episodes gets
//!   Student's, which is approximate.
//! - Where somebody looks as the episodes come, and perhaps stops ([`estimate_until`], [`Tally`]), all
//!   intervals are *anytime-valid*: they hold after every episode at once.
//!
//! [`estimate_continuous`] and [`play`] are for worlds whose [actions are vectors](crate::env::ContinuousEnv).
//!
//! Each interval has its confidence by itself. All are estimates under the horizon that was run: an
//! episode that it cuts counts as not satisfied. Where the world has a model,
//! [`Optimum::report`](crate::solve::Optimum::report) is exact, and reads the same.

mod continuous;
mod interval;
mod special;
mod tally;

use alloc::format;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use rand::Rng;

use crate::certificate::Basis;
use crate::certificate::face::{Face, STEPS, satisfied_in};
use crate::env::Env;
use crate::monitor::Monitor;
use crate::range::checked;
use crate::reward::End;
use crate::task::Error;
#[cfg(feature = "falsify")]
pub(crate) use continuous::play_from;
pub use continuous::{Played, estimate_continuous, play};
pub use interval::Interval;
pub use tally::Tally;

/// A policy's worth as seen in episodes.
///
/// [`estimate()`] and [`estimate_until`] make it, or a [`Tally`] of episodes that you run. It prints as
/// a certificate does, with no more digits than its intervals support. With serde it is a field of
/// saved policies, beside or in place of a certificate.
///
/// ```
/// use tltl::estimate::{Estimate, Tally, Trials};
/// use tltl::reward::End;
///
/// let mut tally = Tally::new(Trials::default().with_horizon(200)?);
/// (0..100).for_each(|i| tally.count((i > 1).then_some(End::Accepted), 12 + i % 3));
/// let seen = tally.fixed();
/// assert!(seen.lost.high < 0.04, "never seen in 100 trials is not never");
/// assert_eq!(format!("\n{seen}"), "
///                            this policy   95 % interval
/// P(satisfied in 200 steps)        0.980  0.929 to 0.998
/// P(lost in 200 steps)             0.000  0.000 to 0.037
/// E[steps | satisfied]             13.00  12.83 to 13.17
/// Estimated from 100 episodes; their number was fixed beforehand.");
/// assert_eq!(serde_json::from_str::<Estimate>(&serde_json::to_string(&seen)?)?, seen);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Estimate {
    /// What the intervals rest on. A document without it is of a version that had Wilson's interval,
    /// which is approximate.
    #[cfg_attr(feature = "serde", serde(default = "Basis::unsaid", rename = "kind"))]
    pub basis: Basis,
    /// The number of episodes.
    pub episodes: u64,
    /// Steps after which one was cut.
    pub horizon: u64,
    /// The confidence of the intervals, 0.95 say.
    pub confidence: f64,
    /// P(satisfied within the horizon).
    pub satisfied: Interval,
    /// P(lost within the horizon): the trap was entered.
    pub lost: Interval,
    /// E\[steps\] of the episodes that satisfied the task; `None` if fewer than two did.
    pub steps: Option<Interval>,
}

impl fmt::Display for Estimate {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // Without the rounding of 100 * 0.07.
        let percent = (1e8 * self.confidence).round() / 1e6;
        let mut face = Face::new(&["", "this policy", &format!("{percent} % interval")]);
        let satisfied = satisfied_in(self.horizon);
        face.row(&satisfied, self.satisfied.cells());
        face.row(&satisfied.replace("satisfied", "lost"), self.lost.cells());
        if let Some(steps) = &self.steps {
            face.row(STEPS, steps.cells());
        }
        let promise = match self.basis {
            Basis::Trials => "their number was fixed beforehand",
            Basis::Anytime => "the intervals hold after each of them",
            Basis::Exact | Basis::Approximate => "the intervals are approximate",
        };
        face.below = format!("Estimated from {} episodes; {promise}.", self.episodes);
        write!(f, "{face}")
    }
}

/// How to estimate: how many episodes, how long, and how sure.
///
/// ```
/// use tltl::estimate::Trials;
///
/// let trials = Trials::default().with_episodes(500)?.with_confidence(0.99)?;
/// assert_eq!((trials.episodes(), trials.horizon()), (500, 1_000));
/// assert!(trials.with_confidence(99.0).is_err());
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trials {
    episodes: u64,
    horizon: u64,
    confidence: f64,
}

checked! { Trials {
    /// The number of episodes.
    episodes, with_episodes: u64, "at least 1", |episodes| episodes > 0;
    /// Steps after which an episode is cut.
    horizon, with_horizon: u64, "at least 1", |horizon| horizon > 0;
    /// The confidence of the intervals.
    confidence, with_confidence: f64, "in (0, 1)", |c| c > 0.0 && c < 1.0;
}}

impl Default for Trials {
    /// 10,000 episodes of at most 1,000 steps, 95 % confidence.
    #[inline]
    fn default() -> Self {
        Self { episodes: 10_000, horizon: 1_000, confidence: 0.95 }
    }
}

/// Runs a policy, `act(q, s)`, and counts.
///
/// ```
/// use tltl::estimate::{Trials, estimate};
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let end = tltl! { |s: &usize| F ({ *s } == 4) };
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// let right = |_: u32, _: &usize| Ok::<_, tltl::task::Error>(1);
/// let seen = estimate(&mut ModelEnv::new(row)?, &end, Trials::default(), &mut rng, right)?;
/// assert_eq!(seen.satisfied.mean, 1.0);
/// assert!(seen.steps.is_some_and(|steps| steps.low < 2.0 && 2.0 < steps.high));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
/// If a predicate is not a number at a state that was met, or the first error of `act`; no step is
/// taken then.
pub fn estimate<E: Env, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    env: &mut E,
    monitor: &M,
    trials: Trials,
    rng: &mut R,
    act: impl FnMut(u32, &E::State) -> Result<usize, F>,
) -> Result<Estimate, F> {
    Ok(tally(env, monitor, trials, rng, act, |_| false)?.fixed())
}

/// Runs a policy, `act(q, s)`, until `enough` of what was counted, at most as many episodes as
/// `trials` say. The intervals hold although they decide when to stop.
///
/// ```
/// use tltl::estimate::{Trials, estimate_until};
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// // A step to the goal succeeds one time in four, and else stays; the episode ends after 20.
/// let try_hard = model::from_fn(2, 1, |s, _| if s == 0 { [(1, 0.25), (0, 0.75)] } else { [(1, 1.0), (0, 0.0)] });
/// let goal = tltl! { |s: &usize| F ({ *s } == 1) };
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// let only = |_: u32, _: &usize| Ok::<_, tltl::task::Error>(0);
/// let trials = Trials::default().with_horizon(20)?;
/// // Is it satisfied 9 times in 10? It is asked until that is known, one way or the other.
/// let decided = |seen: tltl::estimate::Interval| seen.low > 0.9 || seen.high < 0.9;
/// let mut env = ModelEnv::new(try_hard)?;
/// let seen = estimate_until(&mut env, &goal, trials, &mut rng, only, |tally| decided(tally.anytime().satisfied))?;
/// assert!(seen.satisfied.low > 0.9 && seen.episodes < 100);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// # Errors
/// As [`estimate()`].
pub fn estimate_until<E: Env, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    env: &mut E,
    monitor: &M,
    trials: Trials,
    rng: &mut R,
    act: impl FnMut(u32, &E::State) -> Result<usize, F>,
    enough: impl FnMut(&Tally) -> bool,
) -> Result<Estimate, F> {
    Ok(tally(env, monitor, trials, rng, act, enough)?.anytime())
}

/// Counts episodes: one at least, and no more once there are `enough`.
fn tally<E: Env, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    env: &mut E,
    monitor: &M,
    trials: Trials,
    rng: &mut R,
    mut act: impl FnMut(u32, &E::State) -> Result<usize, F>,
    mut enough: impl FnMut(&Tally) -> bool,
) -> Result<Tally, F> {
    let mut tally = Tally::new(trials);
    while tally.episodes() < trials.episodes {
        let (q, steps) = episode(env, monitor, trials.horizon, rng, &mut act)?;
        tally.count(end(monitor, q), steps);
        if enough(&tally) {
            break;
        }
    }
    Ok(tally)
}

/// What `q` is the end of.
fn end<S: ?Sized, M: Monitor<S>>(monitor: &M, q: u32) -> Option<End> {
    if monitor.is_accepting(q) {
        return Some(End::Accepted);
    }
    monitor.is_trap(q).then_some(End::Lost)
}

/// One episode: the automaton state in which it ended, and its steps.
fn episode<E: Env, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    env: &mut E,
    monitor: &M,
    horizon: u64,
    rng: &mut R,
    act: &mut impl FnMut(u32, &E::State) -> Result<usize, F>,
) -> Result<(u32, u64), F> {
    let mut s = env.reset(rng);
    let mut q = monitor.next(0, &s)?;
    for t in 0..horizon {
        if monitor.is_terminal(q) {
            return Ok((q, t));
        }
        let step = env.step(act(q, &s)?, rng);
        s = step.state;
        q = monitor.next(q, &s)?;
        if step.terminated || step.truncated {
            return Ok((q, t + 1));
        }
    }
    Ok((q, horizon))
}
