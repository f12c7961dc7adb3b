//! What a policy is worth in a world without a model: Monte-Carlo estimates with confidence
//! intervals.
//!
//! P(satisfied) gets the interval of Wilson (1927), which stays within [0, 1] and is honest at 0 and
//! 1; the mean number of steps of the successful episodes gets Student's interval. Both are
//! estimates under the horizon that was run: an episode that it cuts counts as not satisfied.
//! Where the world has a model, [`Optimum::certify`](crate::solve::Optimum::certify) is exact.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use rand::Rng;

use crate::env::Env;
use crate::monitor::Monitor;
use crate::range::checked;
use crate::task::Error;

/// An estimated number and its confidence interval.
///
/// The mean lies between the two ends, not always in their middle: Wilson's interval leans inwards at
/// 0 and 1.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Interval {
    /// The estimate.
    pub mean: f64,
    /// The lower end.
    pub low: f64,
    /// The upper end.
    pub high: f64,
}

impl Interval {
    /// Wilson's interval for the probability of an event that was seen `hits` times in `trials`.
    ///
    /// ```
    /// # use tltl::estimate::Interval;
    /// let seen = Interval::wilson(98, 100, 0.95);
    /// assert!(0.929 < seen.low && seen.low < 0.931 && seen.high < 0.995);
    /// ```
    ///
    /// # Panics
    /// Unless there are trials, and 0 < `confidence` < 1.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn wilson(hits: u64, trials: u64, confidence: f64) -> Self {
        assert!(trials > 0 && hits <= trials, "a share of some trials");
        let (n, p, z) = (trials as f64, hits as f64 / trials as f64, normal(confidence));
        let centre = p + z * z / (2.0 * n);
        let half = z * (p * (1.0 - p) / n + z * z / (4.0 * n * n)).sqrt();
        let at = |sum: f64| (sum / (1.0 + z * z / n)).clamp(0.0, 1.0);
        // Without rounding: what was never seen may be impossible.
        let low = if hits == 0 { 0.0 } else { at(centre - half) };
        let high = if hits == trials { 1.0 } else { at(centre + half) };
        Self { mean: p, low, high }
    }

    /// Student's interval for a mean, from the number of values, their sum, and that of their
    /// squares; `None` for fewer than two values.
    ///
    /// ```
    /// use tltl::estimate::Interval;
    ///
    /// // 3, 4 and 5 steps: their number, sum and sum of squares, as a running count keeps them.
    /// let seen = Interval::student(3, 12.0, 50.0, 0.95).unwrap();
    /// assert_eq!((seen.mean, Interval::of(&[3.0, 4.0, 5.0], 0.95)), (4.0, Some(seen)));
    /// assert!((seen.high - 6.484).abs() < 1e-3); // 4 + 4.303 / √3
    /// assert_eq!(Interval::student(1, 3.0, 9.0, 0.95), None, "one value says nothing of its spread");
    /// ```
    ///
    /// # Panics
    /// Unless 0 < `confidence` < 1.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn student(count: u64, sum: f64, squares: f64, confidence: f64) -> Option<Self> {
        if count < 2 {
            return None;
        }
        let (n, mean) = (count as f64, sum / count as f64);
        let variance = ((squares - n * mean * mean) / (n - 1.0)).max(0.0);
        let half = student(n - 1.0, confidence) * (variance / n).sqrt();
        Some(Self { mean, low: mean - half, high: mean + half })
    }

    /// Student's interval for the mean of `values`; `None` for fewer than two.
    ///
    /// # Panics
    /// As [`Self::student`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn of(values: &[f64], confidence: f64) -> Option<Self> {
        let squares = values.iter().map(|v| v * v).sum();
        Self::student(values.len() as u64, values.iter().sum(), squares, confidence)
    }
}

/// A policy's worth as seen in episodes.
///
/// [`estimate`] makes it. With serde it is a field of saved policies, beside or in place of a
/// certificate.
///
/// ```
/// use tltl::estimate::{Estimate, Interval};
///
/// let seen = Estimate {
///     episodes: 100,
///     horizon: 200,
///     confidence: 0.95,
///     satisfied: Interval::wilson(98, 100, 0.95),
///     lost: Interval::wilson(0, 100, 0.95),
///     steps: Interval::of(&[12.0, 14.0, 11.0], 0.95),
/// };
/// assert!(seen.lost.high < 0.04, "never seen in 100 trials is not never");
/// assert_eq!(serde_json::from_str::<Estimate>(&serde_json::to_string(&seen)?)?, seen);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Estimate {
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
    mut act: impl FnMut(u32, &E::State) -> Result<usize, F>,
) -> Result<Estimate, F> {
    let (mut satisfied, mut lost, mut sum, mut squares) = (0, 0, 0.0, 0.0);
    for _ in 0..trials.episodes {
        let (q, steps) = episode(env, monitor, trials.horizon, rng, &mut act)?;
        lost += u64::from(monitor.is_trap(q));
        if monitor.is_accepting(q) {
            satisfied += 1;
            sum += steps as f64;
            squares += (steps as f64) * (steps as f64);
        }
    }
    let Trials { episodes, horizon, confidence } = trials;
    Ok(Estimate {
        episodes,
        horizon,
        confidence,
        satisfied: Interval::wilson(satisfied, episodes, confidence),
        lost: Interval::wilson(lost, episodes, confidence),
        steps: Interval::student(satisfied, sum, squares, confidence),
    })
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

/// The number that a normal variable stays within, either side, with probability `confidence`.
///
/// By bisection: it is asked once or twice for an estimate, and needs no table and no second
/// approximation beside the series.
#[track_caller]
#[inline]
fn normal(confidence: f64) -> f64 {
    assert!(confidence > 0.0 && confidence < 1.0, "a confidence is between 0 and 1");
    let (mut low, mut high) = (0.0, 40.0);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if within(middle) < confidence { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// P(|Z| < x): the series 2 φ(x) (x + x³/3 + x⁵/15 + …).
#[inline]
fn within(x: f64) -> f64 {
    if x > 8.0 {
        return 1.0;
    }
    let (mut term, mut sum) = (x, x);
    for k in 1..200 {
        term *= x * x / f64::from(2 * k + 1);
        sum += term;
    }
    2.0 * sum * (-0.5 * x * x).exp() / (2.0 * core::f64::consts::PI).sqrt()
}

/// The same number for Student's distribution: exact for 1 and 2 degrees of freedom, else the
/// expansion of Fisher and Cornish, which errs by less than 0.5 % from 3 on at 95 %.
#[track_caller]
#[inline]
fn student(degrees: f64, confidence: f64) -> f64 {
    let p = confidence;
    if degrees < 1.5 {
        return (0.5 * core::f64::consts::PI * p).tan();
    }
    if degrees < 2.5 {
        return p * (2.0 / (1.0 - p * p)).sqrt();
    }
    let (z, n) = (normal(confidence), degrees);
    let (z3, z5, z7, z9) = (z.powi(3), z.powi(5), z.powi(7), z.powi(9));
    z + (z3 + z) / (4.0 * n)
        + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n)
        + (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n.powi(3))
        + (79.0 * z9 + 776.0 * z7 + 1482.0 * z5 - 1920.0 * z3 - 945.0 * z) / (92_160.0 * n.powi(4))
}
