//! What a network does beside its sums: to its inputs, in its hidden units, and for the automaton state.
//!
//! Networks of other libraries differ in these from those that are learned here. Everything is a
//! function of numbers that the document has, so emitted code says the same to the last bit.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::NetworkError;
use super::Shape;

/// What a hidden unit makes of its sum.
///
/// ```
/// use tltl::network::Activation;
///
/// assert_eq!([-2.0, 0.5].map(|x| Activation::Relu.of(x)), [0.0, 0.5]);
/// // Three units in the last place at most, and the same bits on every machine.
/// assert!((Activation::Tanh.of(0.5) - 0.5_f32.tanh()).abs() < 2e-7);
/// assert_eq!([-100.0, 0.0, 100.0].map(|x| Activation::Tanh.of(x)), [-1.0, 0.0, 1.0]);
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Activation {
    /// The positive part.
    #[default]
    Relu,
    /// The hyperbolic tangent.
    Tanh,
}

impl Activation {
    /// The output of a unit whose sum is `x`.
    #[must_use]
    #[inline]
    pub fn of(self, x: f32) -> f32 {
        match self {
            Self::Relu => x.max(0.0),
            Self::Tanh => tanh(x),
        }
    }
}

/// tanh x without a library, of which there is none where emitted code runs: Lambert's continued
/// fraction to its fifth term at x/4, doubled twice by tanh 2y = 2 tanh y / (1 + tanh² y), which makes
/// relative errors no larger. Beyond 9.5 it is 1. Measured at 400,000 points: 2.9e-7 relative at most.
#[inline]
fn tanh(x: f32) -> f32 {
    let y = x.clamp(-9.5, 9.5) * 0.25;
    let s = y * y;
    let t = y * (945.0 + s * (105.0 + s)) / (945.0 + s * (420.0 + s * 15.0));
    let t = 2.0 * t / (1.0 + t * t);
    2.0 * t / (1.0 + t * t)
}

/// How inputs are normalised: (x - mean) / deviation, within ±clip.
///
/// ```
/// use tltl::network::Scale;
///
/// let scale = Scale { mean: vec![1.0], deviation: vec![2.0], clip: 10.0 };
/// assert_eq!([2.0, 999.0].map(|x| scale.of(0, x)), [0.5, 10.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Scale {
    /// What is taken off, for each input.
    pub mean: Vec<f32>,
    /// What the rest is divided by, for each input; positive.
    pub deviation: Vec<f32>,
    /// The largest size of a normalised input; positive.
    pub clip: f32,
}

impl Scale {
    /// Input `i`, normalised.
    ///
    /// # Panics
    /// If there is no such input.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn of(&self, i: usize, x: f32) -> f32 {
        ((x - self.mean[i]) / self.deviation[i]).clamp(-self.clip, self.clip)
    }
}

/// What keeps a control between its bounds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase"))]
pub enum Squash {
    /// The hyperbolic tangent of the output, stretched from [-1, 1] to the bounds: SAC and TD3.
    Tanh,
    /// The output itself, cut off at the bounds: the mean of a normal distribution, as PPO has it.
    Clip,
}

/// What outputs are where an action is not one of several, but numbers: controls.
///
/// ```
/// use tltl::network::{Controls, Squash};
///
/// let controls = Controls { squash: Squash::Clip, low: vec![-1.0], high: vec![3.0] };
/// assert_eq!([0.5, 7.0].map(|x| controls.of(0, x)), [0.5, 3.0]);
/// let controls = Controls { squash: Squash::Tanh, ..controls };
/// assert_eq!([0.0, 100.0].map(|x| controls.of(0, x)), [1.0, 3.0]);
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Controls {
    /// What keeps them between their bounds.
    pub squash: Squash,
    /// The smallest of each control.
    pub low: Vec<f32>,
    /// The largest of each control; not below the smallest.
    pub high: Vec<f32>,
}

impl Controls {
    /// Control `i` of a network that puts out `x`.
    ///
    /// # Panics
    /// If there is no such control.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn of(&self, i: usize, x: f32) -> f32 {
        let (low, high) = (self.low[i], self.high[i]);
        match self.squash {
            // Rounding may lead over a bound.
            Squash::Tanh => (low + (tanh(x) + 1.0) * 0.5 * (high - low)).clamp(low, high),
            Squash::Clip => x.clamp(low, high),
        }
    }
}

/// The form of a network; the default is that of the networks that are learned here.
///
/// ```
/// use tltl::network::{Dense, Form, Network, Shape};
///
/// // One feature, a hidden unit, two automaton states, two actions.
/// let shape = Shape { inputs: 1, hidden: vec![1], heads: 2, actions: 2, entities: 0, channels: 0 };
/// let form = Form { states: vec![0.0, -1.0], ..Form::default() };
/// let layers = [[1.0].to_vec(), [1.0, -1.0].to_vec()];
/// let layers = layers.map(|weights| Dense { bias: vec![0.0; weights.len()], weights });
/// let network = Network::with_form(shape, layers.to_vec(), form)?;
/// // In the second state the unit has 1 less.
/// assert_eq!(network.values(0, &[3.0], &[]), [3.0, -3.0]);
/// assert_eq!(network.values(1, &[3.0], &[]), [2.0, -2.0]);
/// # Ok::<(), tltl::network::NetworkError>(())
/// ```
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Form {
    /// What hidden units make of their sums.
    pub activation: Activation,
    /// How inputs are normalised, if they are.
    pub scale: Option<Scale>,
    /// Where the automaton state is an input of the network: what each live state adds to the sums of
    /// the first hidden layer, indexed `head * units + unit`. All states then share one head. Empty where
    /// each state has a head of its own.
    pub states: Vec<f32>,
    /// Where an action is numbers: what its outputs become. `None` where they are values of actions.
    pub controls: Option<Controls>,
}

impl Form {
    /// A field of a document that has it, and that a document of version 1 has not.
    #[inline]
    pub(super) fn later_field(&self) -> Option<&'static str> {
        let fields = [
            ("network.activation", self.activation != Activation::default()),
            ("network.scale", self.scale.is_some()),
            ("network.states", !self.states.is_empty()),
            ("network.controls", self.controls.is_some()),
        ];
        fields.iter().find(|(_, is_there)| *is_there).map(|(field, _)| *field)
    }

    /// The heads of the last layer.
    #[inline]
    pub(super) fn heads(&self, shape: &Shape) -> usize {
        if self.states.is_empty() { shape.heads } else { 1 }
    }

    /// What does not fit the shape.
    #[inline]
    pub(super) fn check(&self, shape: &Shape) -> Result<(), NetworkError> {
        let size = |part, found, expected: Option<usize>| match expected {
            Some(expected) if expected == found => Ok(()),
            _ => Err(NetworkError::Form { part, found, expected }),
        };
        if !self.states.is_empty() {
            let units = shape.hidden.first().copied().unwrap_or(0);
            size("states", self.states.len(), units.checked_mul(shape.heads))?;
        }
        let scale = self.scale.iter();
        for Scale { mean, deviation, clip } in scale {
            size("scale.mean", mean.len(), Some(shape.inputs))?;
            size("scale.deviation", deviation.len(), Some(shape.inputs))?;
            let positive = |x: &f32| *x > 0.0 && x.is_finite();
            let sound = mean.iter().all(|x| x.is_finite()) && deviation.iter().all(positive);
            if !sound || !positive(clip) {
                return Err(NetworkError::Scale);
            }
        }
        if let Some(Controls { low, high, .. }) = &self.controls {
            size("controls.low", low.len(), Some(shape.actions))?;
            size("controls.high", high.len(), Some(shape.actions))?;
            let sound = |(low, high): (&f32, &f32)| low <= high && (high - low).is_finite();
            if !low.iter().zip(high).all(sound) {
                return Err(NetworkError::Controls);
            }
        }
        match self.states.iter().all(|x| x.is_finite()) {
            true => Ok(()),
            false => Err(NetworkError::NotFinite { layer: 0 }),
        }
    }
}
