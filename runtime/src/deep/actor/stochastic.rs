//! The stochastic actor of SAC (Haarnoja et al. 2018): what it draws, and how much its entropy weighs.
//!
//! For each component of an action such an actor puts out the mean of a normal distribution and its spread; the
//! action is tanh of a number from it. That number is a function of both and of noise from outside (Kingma and
//! Welling 2014), so the slope of a critic in an action goes on into both.

use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::network::Activation;

/// The least and the largest logarithm of a deviation before tanh: 0.007 to 7.4. The spread that is put out goes
/// through a tanh between them, whose slope is never 0, as behind a cut it would be for good.
const LOG_DEVIATION: [f32; 2] = [-5.0, 2.0];

/// The temperature at first. Rewards here are potentials within about ±1, a few hundredths a step, and it takes a
/// thousand updates to fall by a factor of e.
const START: f64 = 0.01;

/// The logarithm of √(2π).
const LN_SQRT_TAU: f32 = 0.918_938_5;

/// The logarithm of a deviation, and its slope in the spread that was put out.
fn log_deviation(spread: f32) -> (f32, f32) {
    let [low, high] = LOG_DEVIATION;
    let (half, t) = (0.5 * (high - low), Activation::Tanh.of(spread));
    (low + half * (t + 1.0), half * (1.0 - t * t))
}

/// ln (1 - tanh² x), also where tanh x rounds to ±1.
fn log_slope(x: f32) -> f32 {
    let x = x.abs();
    2.0 * (core::f32::consts::LN_2 - x - (-2.0 * x).exp().ln_1p())
}

/// The action of an actor that puts out `mean` and `spread`, with `noise` of deviation 1.
pub(super) fn action(mean: f32, spread: f32, noise: f32) -> f32 {
    Activation::Tanh.of(mean + log_deviation(spread).0.exp() * noise)
}

/// Actions that were drawn, and how.
#[derive(Default)]
pub(super) struct Drawn {
    /// All components within ±1, of one row after the other.
    pub actions: Vec<f32>,
    /// The logarithms of their densities.
    pub densities: Vec<f32>,
    /// What was added to each mean.
    offsets: Vec<f32>,
    /// The slopes of the logarithms of the deviations in the spreads.
    slopes: Vec<f32>,
    /// The components of a row.
    width: usize,
}

impl Drawn {
    /// Draws by `out`, rows of `width` means and then as many spreads, and by `noise` of deviation 1.
    pub(super) fn new(out: &[f32], width: usize, mut noise: impl FnMut() -> f32) -> Self {
        let mut drawn = Self { width, ..Self::default() };
        for row in out.chunks(2 * width) {
            let (means, spreads) = row.split_at(width);
            for (&mean, &spread) in means.iter().zip(spreads) {
                drawn.push(mean, spread, noise());
            }
        }
        drawn
    }

    fn push(&mut self, mean: f32, spread: f32, noise: f32) {
        let (log, slope) = log_deviation(spread);
        let offset = log.exp() * noise;
        self.actions.push(Activation::Tanh.of(mean + offset));
        let normal = -0.5 * noise * noise - log - LN_SQRT_TAU;
        self.densities.push(normal - log_slope(mean + offset));
        self.offsets.push(offset);
        self.slopes.push(slope);
    }

    /// The entropies of the distributions of whole actions, of so many components, as one draw tells of each.
    pub(super) fn entropies(&self, components: usize) -> impl Iterator<Item = f32> {
        self.densities.chunks(components).map(|densities| -densities.iter().sum::<f32>())
    }

    /// The gradient of a loss in what was put out, from that in the actions and from `weights`, what the logarithm of
    /// each density counts in the loss.
    pub(super) fn back(&self, error: &[f32], weights: impl Fn(usize) -> f32) -> Vec<f32> {
        let mut gradient = std::vec![0.0; 2 * error.len()];
        for (i, (&error, &action)) in error.iter().zip(&self.actions).enumerate() {
            let (row, weight) = (i / self.width, weights(i));
            // Along tanh, whose slope the density has in its denominator.
            let mean = error * (1.0 - action * action) + weight * 2.0 * action;
            let at = row * self.width + i;
            gradient[at] = mean;
            gradient[at + self.width] = (mean * self.offsets[i] - weight) * self.slopes[i];
        }
        gradient
    }
}

/// What a nat of entropy weighs beside rewards: tuned by an Adam of its own, so that the actor keeps the entropy
/// that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Temperature {
    log: f64,
    first: f64,
    second: f64,
    time: i32,
}

impl Temperature {
    pub(super) fn new() -> Self {
        Self { log: START.ln(), first: 0.0, second: 0.0, time: 0 }
    }

    pub(super) fn weight(&self) -> f64 {
        self.log.exp()
    }

    /// Moves it up if the actor has less entropy than is wanted, and down if it has more.
    pub(super) fn tune(&mut self, lacking: f64, rate: f64) {
        const BETA: [f64; 2] = [0.9, 0.999];
        self.time += 1;
        self.first += (1.0 - BETA[0]) * (lacking - self.first);
        self.second += (1.0 - BETA[1]) * (lacking * lacking - self.second);
        let [first, second] = BETA.map(|beta| 1.0 - beta.powi(self.time));
        self.log += rate * (self.first / first) / ((self.second / second).sqrt() + 1e-8);
    }
}
