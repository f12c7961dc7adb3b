//! Episodes, counted one by one.

use super::{Estimate, Interval, Trials};
use crate::certificate::Basis;
use crate::reward::End;

/// Outcomes of episodes, counted one by one, wherever they come from: a simulator, a robot, a log.
///
/// It may be looked at after each episode: [`Self::anytime`] says what is then known, and the
/// intervals still hold if it is this that decides when to stop.
///
/// ```
/// use tltl::estimate::{Tally, Trials};
/// use tltl::reward::End;
///
/// // A robot is tried until it is sure that 9 times in 10 it does what it should.
/// let mut tally = Tally::new(Trials::default().with_horizon(60)?);
/// while tally.episodes() == 0 || tally.anytime().satisfied.low < 0.9 {
///     tally.count(Some(End::Accepted), 25); // it took 25 steps
/// }
/// assert_eq!(tally.episodes(), 53);
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tally {
    trials: Trials,
    episodes: u64,
    satisfied: u64,
    lost: u64,
    /// The steps of those that were satisfied.
    steps: Mean,
}

impl Tally {
    /// Nothing counted yet. Of `trials` the horizon and the confidence count.
    #[must_use]
    #[inline]
    pub const fn new(trials: Trials) -> Self {
        let steps = Mean::new(trials.horizon() as f64);
        Self { trials, episodes: 0, satisfied: 0, lost: 0, steps }
    }

    /// The number of episodes so far.
    #[must_use]
    #[inline]
    pub const fn episodes(&self) -> u64 {
        self.episodes
    }

    /// Counts an episode that ended so after so many steps, or that ended by itself or was cut
    /// (`None`).
    ///
    /// # Panics
    /// If it has more steps than the horizon.
    #[track_caller]
    #[inline]
    pub fn count(&mut self, end: Option<End>, steps: u64) {
        let horizon = self.trials.horizon();
        assert!(steps <= horizon, "{steps} steps, but the horizon is {horizon}");
        self.episodes += 1;
        self.lost += u64::from(end == Some(End::Lost));
        if end == Some(End::Accepted) {
            self.satisfied += 1;
            self.steps.push(steps as f64, self.trials.confidence());
        }
    }

    /// What is known if the number of episodes was fixed beforehand.
    ///
    /// # Panics
    /// Before the first episode.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn fixed(&self) -> Estimate {
        let Mean { count, sum, squares, .. } = self.steps;
        let steps = Interval::student(count, sum, squares, self.trials.confidence());
        self.estimate(Basis::Trials, Interval::exact, steps)
    }

    /// What is known if the episodes are looked at as they come: with the confidence of the trials,
    /// each interval holds its number after every episode, however many there will be.
    ///
    /// # Panics
    /// Before the first episode.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn anytime(&self) -> Estimate {
        let steps = self.steps.anytime(self.trials.confidence());
        self.estimate(Basis::Anytime, Interval::anytime, steps)
    }

    #[track_caller]
    #[inline]
    fn estimate(
        &self,
        basis: Basis,
        share: impl Fn(u64, u64, f64) -> Interval,
        steps: Option<Interval>,
    ) -> Estimate {
        let (horizon, confidence) = (self.trials.horizon(), self.trials.confidence());
        Estimate {
            basis,
            episodes: self.episodes,
            horizon,
            confidence,
            satisfied: share(self.satisfied, self.episodes, confidence),
            lost: share(self.lost, self.episodes, confidence),
            steps,
        }
    }
}

/// What is known of the mean of numbers in [0, `range`] that come one by one.
///
/// The confidence sequence is the predictable plug-in one of Waudby-Smith and Ramdas (2024, Theorem
/// 2), after the empirical Bernstein inequality of Howard et al. (2021). For numbers x in [0, 1] with
/// mean μ, weights λ below 1 and guesses g of the mean, both chosen before x is seen,
/// exp(Σ λ (x - μ) - Σ (x - g)² (-ln(1 - λ) - λ)) is a supermartingale, and so is it for 1 - x. The
/// interval is wide for few numbers, and narrow where they vary little, as steps do beside their
/// horizon.
#[derive(Clone, Debug)]
struct Mean {
    range: f64,
    count: u64,
    sum: f64,
    squares: f64,
    /// Σ (x - g)² with the guess that includes x, which the weights are chosen by.
    deviations: f64,
    /// Σ λ
    weight: f64,
    /// Σ λ x
    weighted: f64,
    /// Σ (x - g)² (-ln(1 - λ) - λ) with the guess before x.
    spread: f64,
}

/// The largest weight. The authors advise 1/2 or 3/4. Where numbers vary little it decides how fast
/// the interval shrinks: 10,000 episodes of 12 ± 5 steps with a horizon of 1,000 give ± 0.76 with 1/2
/// and ± 0.55 with 3/4.
const LARGEST: f64 = 0.75;

impl Mean {
    #[inline]
    const fn new(range: f64) -> Self {
        let (sum, squares, deviations, weight, weighted, spread) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        Self { range, count: 0, sum, squares, deviations, weight, weighted, spread }
    }

    /// A guess of the mean, as a part of the range, that is never sure of 0 or 1.
    #[inline]
    fn guess(&self) -> f64 {
        (self.sum / self.range + 0.5) / (self.count as f64 + 1.0)
    }

    #[inline]
    fn push(&mut self, value: f64, confidence: f64) {
        let (x, next) = (value / self.range, self.count as f64 + 1.0);
        let variance = (self.deviations + 0.25) / next;
        let best = (2.0 * doubt(confidence) / (variance * next * next.ln_1p())).sqrt();
        let lambda = if best < LARGEST { best } else { LARGEST };
        self.spread += (x - self.guess()).powi(2) * (-(-lambda).ln_1p() - lambda);
        self.weight += lambda;
        self.weighted += lambda * x;
        self.count += 1;
        self.sum += value;
        self.squares += value * value;
        self.deviations += (x - self.guess()).powi(2);
    }

    /// The mean of what was seen, and an interval that holds after every number; `None` for fewer
    /// than two, as [`Interval::student`].
    #[inline]
    fn anytime(&self, confidence: f64) -> Option<Interval> {
        if self.count < 2 {
            return None;
        }
        let mean = self.sum / self.count as f64;
        let centre = self.range * self.weighted / self.weight;
        let half = self.range * (doubt(confidence) + self.spread) / self.weight;
        // Wider where the plain mean is not within: a wider interval holds what a narrow one does.
        let low = (centre - half).min(mean).max(0.0);
        let high = (centre + half).max(mean).min(self.range);
        Some(Interval { mean, low, high })
    }
}

/// ln(2/α): either side may be wrong.
#[inline]
fn doubt(confidence: f64) -> f64 {
    (2.0 / (1.0 - confidence)).ln()
}
