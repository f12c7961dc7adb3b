//! Adaptive normalisation of targets that preserves outputs (PopArt, van Hasselt et al. 2016).
//!
//! Rewards of 1 at the end of a long way make values from 0.01 to 1, each automaton state at another
//! height, and one step size serves all. With targets of mean 0 and deviation 1 it does.

use serde::{Deserialize, Serialize};
use std::vec::Vec;

/// The scale of the values of each automaton state: a network puts out `(value − μ) / σ`.
///
/// μ and σ are running moments of the targets. When they move, the heads are rewritten so that the
/// values stay what they were. Each automaton state has its own: values fall along the way to
/// acceptance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct PopArt {
    rate: f64,
    heads: Vec<TargetMoments>,
}

#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
struct TargetMoments {
    /// How much of a target has gone into the running sums so far: 1 − (1 − rate)^n.
    share: f64,
    sum: f64,
    squares: f64,
}

/// The least and the largest σ: where all targets are alike σ would be 0, and the loss infinite.
const RANGE: (f64, f64) = (1e-2, 1e6);

impl PopArt {
    /// No normalisation yet, for this number of heads; each update takes in new targets by the
    /// share `rate`, and 0 never normalises.
    pub(super) fn new(heads: usize, rate: f64) -> Self {
        Self { rate, heads: std::vec![TargetMoments::default(); heads] }
    }

    /// (μ, σ) of a head.
    ///
    /// # Panics
    /// If there is no such head.
    pub(super) fn scale(&self, head: usize) -> (f64, f64) {
        let TargetMoments { share, sum, squares } = self.heads[head];
        if share == 0.0 {
            return (0.0, 1.0);
        }
        let mean = sum / share;
        let variance = (squares / share - mean * mean).max(0.0);
        (mean, variance.sqrt().clamp(RANGE.0, RANGE.1))
    }

    /// Takes in some targets of a head.
    ///
    /// The sums start from 0 and are divided by `share`, which corrects the start as Adam's moments are
    /// corrected; so the first targets count in full.
    ///
    /// # Panics
    /// If there is no such head.
    pub(super) fn observe(&mut self, head: usize, targets: impl IntoIterator<Item = f64>) {
        let (mut n, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for target in targets {
            n += 1.0;
            sum += target;
            squares += target * target;
        }
        if n > 0.0 && self.rate > 0.0 {
            let TargetMoments { share, sum: s, squares: q } = &mut self.heads[head];
            let blend = |old: &mut f64, new: f64| *old += self.rate * (new - *old);
            blend(share, 1.0);
            blend(s, sum / n);
            blend(q, squares / n);
        }
    }
}
