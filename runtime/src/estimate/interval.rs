//! Confidence intervals for a probability and for a mean.

use alloc::format;
use alloc::string::String;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::special::{beta_below, ln_beta};

/// An estimated number and its confidence interval.
///
/// The mean lies between the two ends, not always in their middle: at 0 and 1 an interval for a
/// probability leans inwards.
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
    /// The exact interval for the probability of an event that was seen `hits` times in `trials`,
    /// whose number was fixed beforehand: Clopper and Pearson (1934).
    ///
    /// It holds the probability with `confidence` or more, whatever the probability is: each end is
    /// where what was seen, or more of it, has a chance of half of the rest. Whoever looks again and
    /// again and stops when the interval pleases needs [`Self::anytime`].
    ///
    /// ```
    /// # use tltl::estimate::Interval;
    /// let seen = Interval::exact(98, 100, 0.95);
    /// assert!((seen.low - 0.92961607).abs() < 1e-8 && (seen.high - 0.99756866).abs() < 1e-8);
    /// // Never in 100 trials: 1 - 0.025^(1/100).
    /// assert!((Interval::exact(0, 100, 0.95).high - 0.0362167).abs() < 1e-7);
    /// ```
    ///
    /// # Panics
    /// Unless there are trials, `hits` are not more of them, and 0 < `confidence` < 1.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn exact(hits: u64, trials: u64, confidence: f64) -> Self {
        let tail = 0.5 * (1.0 - checked(confidence));
        Self::of_share(hits, trials, |hits, misses| {
            // P(as many hits or more) under p, which grows with p.
            move |p| beta_below(p, hits, misses + 1.0) < tail
        })
    }

    /// An interval for the probability of an event that was seen `hits` times in `trials`, which
    /// may be looked at after each trial and used to stop.
    ///
    /// With probability `confidence` or more the intervals after 1, 2, 3, … trials *all* hold the
    /// probability (a confidence sequence). So they are wider than [exact](Self::exact) ones: at 95 %
    /// they are 1.2 times as wide after 10 trials, 1.8 times after 1,000 and 2.3 times after a million.
    ///
    /// The mixture of the likelihood ratios against p, with weights Beta(1/2, 1/2), is a martingale
    /// if p is the truth, and by Ville's inequality (1939) it ever reaches 1/α with probability at
    /// most α; the interval is where it has not (Robbins 1970; Howard, Ramdas, McAuliffe and Sekhon
    /// 2021). The weights are those of Krichevsky and Trofimov (1981), which lose least where p is
    /// near 0 or 1, as that of a good policy is.
    ///
    /// ```
    /// # use tltl::estimate::Interval;
    /// let seen = Interval::anytime(98, 100, 0.95);
    /// assert!((seen.low - 0.89532139).abs() < 1e-8 && (seen.high - 0.99952473).abs() < 1e-8);
    /// ```
    ///
    /// # Panics
    /// As [`Self::exact`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn anytime(hits: u64, trials: u64, confidence: f64) -> Self {
        let limit = -(1.0 - checked(confidence)).ln();
        Self::of_share(hits, trials, |hits, misses| {
            let mixture = ln_beta(hits + 0.5, misses + 0.5) - ln_beta(0.5, 0.5);
            move |p: f64| {
                let misses = if misses > 0.0 { misses * (-p).ln_1p() } else { 0.0 };
                mixture - hits * p.ln() - misses >= limit
            }
        })
    }

    /// The interval from what tells, of hits and misses, whether a probability below their share is
    /// too small. The other end is that of misses and hits.
    #[track_caller]
    #[inline]
    fn of_share<F: Fn(f64) -> bool>(
        hits: u64,
        trials: u64,
        too_small: impl Fn(f64, f64) -> F,
    ) -> Self {
        assert!(trials > 0 && hits <= trials, "a share of some trials");
        let (yes, no) = (hits as f64, (trials - hits) as f64);
        let end = |of: f64, others: f64| {
            if of == 0.0 { 0.0 } else { last(of / (of + others), too_small(of, others)) }
        };
        let mean = yes / trials as f64;
        Self { mean, low: end(yes, no), high: 1.0 - end(no, yes) }
    }

    /// Student's interval for a mean, from the number of values, their sum, and that of their
    /// squares; `None` for fewer than two values. It is approximate unless the values are normal.
    ///
    /// ```
    /// use tltl::estimate::Interval;
    ///
    /// // 3, 4 and 5 steps: their number, sum and sum of squares, as a running count keeps them.
    /// let seen = Interval::student(3, 12.0, 50.0, 0.95).unwrap();
    /// assert_eq!((seen.mean, Interval::of(&[3.0, 4.0, 5.0], 0.95)), (4.0, Some(seen)));
    /// assert!((seen.high - 6.48414).abs() < 1e-5); // 4 + 4.30265 / √3
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
        let half = quantile(n - 1.0, confidence) * (variance / n).sqrt();
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

    /// The mean, and the ends, rounded outwards: with as many digits as make the interval two digits
    /// wide, at most six behind the point.
    #[inline]
    pub(super) fn cells(&self) -> [String; 2] {
        let width = (self.high - self.low).max(1e-6);
        let digits = (1.0 - width.log10()).ceil().clamp(0.0, 6.0) as usize;
        let unit = 10_f64.powi(digits as i32);
        let low = (self.low * unit).floor() / unit;
        let high = (self.high * unit).ceil() / unit;
        [format!("{:.digits$}", self.mean), format!("{low:.digits$} to {high:.digits$}")]
    }
}

#[track_caller]
#[inline]
fn checked(confidence: f64) -> f64 {
    assert!(confidence > 0.0 && confidence < 1.0, "a confidence is between 0 and 1");
    confidence
}

/// The last number in [0, `high`] of which `holds` is true, rounded down, if it is true up to some
/// number and false from there on.
///
/// By bisection: it asks little of `holds`, and an interval is asked for once or twice. A hundred
/// halvings give all digits of numbers down to 1e-14.
#[inline]
fn last(mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    let mut low = 0.0;
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if holds(middle) { low = middle } else { high = middle }
    }
    low
}

/// The number that Student's variable stays within, either side, with probability `confidence`.
///
/// P(|T| > t) is I_x(ν/2, 1/2) with x = ν / (ν + t²) (Abramowitz and Stegun 26.7.1).
#[track_caller]
#[inline]
fn quantile(degrees: f64, confidence: f64) -> f64 {
    let rest = 1.0 - checked(confidence);
    let x = last(1.0, |x| beta_below(x, 0.5 * degrees, 0.5) < rest);
    (degrees * (1.0 - x) / x).sqrt()
}
