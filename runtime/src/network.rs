//! Networks of action values: their shape, their weights, and a forward pass in plain Rust.
//!
//! A [`Network`] maps what an agent sees of a state to Q(s, q, ·) for every live automaton state: a
//! trunk of dense layers with rectifiers, then one *head* for each automaton state. Choosing a head
//! is choosing the sub-policy of q, so the automaton state never has to be learned from an input.
//!
//! Worlds with many things of one kind (objects, places) have an action for each of them. Such an
//! action *points* at its entity: the head puts out a query, and the value of pointing is what
//! all pointing has in common and the product of the query with the entity's features, as in pointer networks (Vinyals et al. 2015).
//! What is learned of one entity so holds for all, and entities that look alike are worth the same,
//! which is what keeps the maximum over many actions from drowning in noise.
//!
//! This module learns nothing and needs nothing but an allocator; the learner is in `deep`, the saved
//! form in [`policy`].

mod form;
pub mod policy;

use alloc::vec::Vec;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::q::argmax;

pub use form::{Activation, Controls, Form, Scale, Squash};

/// What a network sees of a state of type `S`.
///
/// The features must be finite numbers, and of the size of 1.
///
/// The network never sees the automaton state: that chooses the head. So features say what the *world*
/// is like, and a task that depends on what was done needs no feature for it.
///
/// ```
/// use tltl::network::{Features, Shape};
///
/// /// A robot on a line of length 10, and the places of three boxes, each of which can be picked up.
/// struct Hall {
///     robot: f32,
///     boxes: [f32; 3],
/// }
///
/// /// The state is where the robot is; an entity is a box, and how far away it is.
/// struct Distances;
///
/// impl Features<Hall> for Distances {
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn entities(&self) -> usize {
///         3
///     }
///     fn channels(&self) -> usize {
///         1
///     }
///     fn write(&self, s: &Hall, inputs: &mut [f32], entities: &mut [f32]) {
///         inputs[0] = s.robot / 10.0;
///         for (seen, place) in entities.iter_mut().zip(s.boxes) {
///             *seen = (place - s.robot).abs() / 10.0;
///         }
///     }
/// }
///
/// let (mut inputs, mut entities) = ([0.0; 1], [0.0; 3]);
/// Distances.write(&Hall { robot: 5.0, boxes: [0.0, 5.0, 9.0] }, &mut inputs, &mut entities);
/// assert_eq!((inputs, entities), ([0.5], [0.5, 0.0, 0.4]));
/// // Two actions that move, and one for each box.
/// let shape = Shape::of(&Distances, &[32], 1, 2 + 3);
/// assert_eq!((shape.entities, shape.channels), (3, 1));
/// ```
pub trait Features<S: ?Sized> {
    /// The number of features of the state as a whole.
    fn inputs(&self) -> usize;

    /// The number of entities that actions point at: the last `entities()` actions, in order.
    fn entities(&self) -> usize {
        0
    }

    /// The number of features of each entity.
    fn channels(&self) -> usize {
        0
    }

    /// Writes the features of `s`: `inputs` has length `inputs()`, and `entities`, indexed
    /// `channel * entities() + entity`, has length `channels() * entities()`. Both are zeros before.
    ///
    /// A network that is learned refuses a feature that is not a finite number, by its number:
    /// entities' after the state's. Far from the size of 1 learning is slow, for one step size serves
    /// all weights.
    fn write(&self, s: &S, inputs: &mut [f32], entities: &mut [f32]);
}

impl<S: ?Sized, F: Features<S> + ?Sized> Features<S> for &F {
    fn inputs(&self) -> usize {
        (**self).inputs()
    }

    fn entities(&self) -> usize {
        (**self).entities()
    }

    fn channels(&self) -> usize {
        (**self).channels()
    }

    fn write(&self, s: &S, inputs: &mut [f32], entities: &mut [f32]) {
        (**self).write(s, inputs, entities);
    }
}

/// The sizes of a network.
///
/// Not every combination is a network; [`Network::new`] says which size is wrong. With entities, a
/// head puts out `actions - entities + 1 + channels` numbers, without them `actions`.
///
/// ```
/// use tltl::network::{Network, NetworkError, Shape};
///
/// // Four features, one hidden layer of eight units, two live automaton states, three actions.
/// let shape = Shape { inputs: 4, hidden: vec![8], heads: 2, actions: 3, entities: 0, channels: 0 };
/// let error = Network::new(Shape { heads: 0, ..shape.clone() }, vec![]).unwrap_err();
/// assert_eq!(error, NetworkError::Shape { field: "heads" });
/// let error = Network::new(shape, vec![]).unwrap_err();
/// assert_eq!(error.to_string(), "`network.layers` has 0 layers, not 2");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Shape {
    /// Features of the state.
    pub inputs: usize,
    /// Units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Heads: live automaton states.
    pub heads: usize,
    /// Actions, those that point at entities last.
    pub actions: usize,
    /// Entities.
    pub entities: usize,
    /// Features of each entity.
    pub channels: usize,
}

impl Shape {
    /// The sizes of a network that reads `features`.
    ///
    /// # Panics
    /// If there are more entities than actions.
    #[track_caller]
    pub fn of<S: ?Sized>(
        features: &impl Features<S>,
        hidden: &[usize],
        heads: usize,
        actions: usize,
    ) -> Self {
        let (inputs, entities) = (features.inputs(), features.entities());
        assert!(entities <= actions, "an action for each entity");
        let channels = if entities == 0 { 0 } else { features.channels() };
        Self { inputs, hidden: hidden.to_vec(), heads, actions, entities, channels }
    }

    /// The actions that point at nothing.
    #[inline]
    pub(crate) fn plain(&self) -> usize {
        self.actions - self.entities
    }

    /// What a head puts out as values: those of the plain actions, and what all pointing actions
    /// have in common.
    #[inline]
    pub(crate) fn levels(&self) -> usize {
        self.plain() + usize::from(self.entities > 0)
    }

    /// What a head puts out: the values, then the query.
    #[inline]
    pub(crate) fn head_width(&self) -> usize {
        self.levels() + self.channels
    }

    /// A size with which there is no network, of a shape that may come from a file.
    #[inline]
    fn fault(&self) -> Option<&'static str> {
        let columns = || self.levels().checked_add(self.channels)?.checked_mul(self.heads);
        let lone = self.entities == 0 && self.channels > 0;
        let faults = [
            ("heads", self.heads == 0),
            ("actions", self.actions == 0),
            ("entities", self.entities > self.actions),
            ("channels", lone || self.channels.checked_mul(self.entities).is_none()),
            ("hidden", self.hidden.contains(&0)),
        ];
        let fault = faults.iter().find(|(_, wrong)| *wrong).map(|(field, _)| *field);
        fault.or_else(|| columns().is_none().then_some("heads"))
    }

    /// The widths of all layers, the input first.
    #[inline]
    pub(crate) fn widths(&self) -> Vec<usize> {
        let ends = [self.inputs, self.heads * self.head_width()];
        let mut widths = alloc::vec![ends[0]];
        widths.extend(&self.hidden);
        widths.push(ends[1]);
        widths
    }
}

/// A dense layer: `y = x W + b`.
///
/// The numbers are 32 bits wide: half the size of a file and of an emitted table, and more than noise in
/// learned weights needs.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Dense {
    /// W, indexed `input * outputs + output`.
    pub weights: Vec<f32>,
    /// b, one for each output.
    pub bias: Vec<f32>,
}

/// Why layers are no network.
///
/// It names the part as the document does, for layers mostly come from a file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NetworkError {
    /// There are not as many layers as the shape says.
    Layers {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// A layer has not the sizes that the shape says.
    Size {
        /// Which layer.
        layer: usize,
        /// Its weights, or its bias.
        part: &'static str,
        /// How many numbers there are.
        found: usize,
        /// How many there should be; `None`: more than fit into memory.
        expected: Option<usize>,
    },
    /// A weight is infinite or not a number.
    NotFinite {
        /// Of which layer.
        layer: usize,
    },
    /// A part of the form has not the size that the shape says.
    Form {
        /// The part.
        part: &'static str,
        /// How many numbers there are.
        found: usize,
        /// How many there should be; `None`: more than fit into memory.
        expected: Option<usize>,
    },
    /// The normalisation of inputs has a deviation or a clip that is not positive, or a number that is
    /// not finite.
    Scale,
    /// A control has no range: a bound is not finite, or the smallest is above the largest.
    Controls,
    /// There is no network of that shape.
    Shape {
        /// The size that does not go with the others.
        field: &'static str,
    },
}

impl fmt::Display for NetworkError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Layers { found, expected } => {
                write!(f, "`network.layers` has {found} layers, not {expected}")
            }
            Self::Size { layer, part, found, expected } => {
                write!(f, "`network.layers[{layer}].{part}` ")?;
                match expected {
                    Some(expected) => write!(f, "has {found} entries, not {expected}"),
                    None => f.write_str("would be too large"),
                }
            }
            Self::Form { part, found, expected } => {
                write!(f, "`network.{part}` has {found} entries")?;
                expected.map_or(Ok(()), |expected| write!(f, ", not {expected}"))
            }
            Self::Scale => f.write_str(
                "`network.scale` has a deviation or a clip that is not positive, or a number that is \
                 not finite",
            ),
            Self::Controls => f.write_str(
                "`network.controls` has a `low` above its `high`, or a range that is not a finite number",
            ),
            Self::NotFinite { layer } => {
                write!(f, "layer {layer} has a weight that is not a finite number")
            }
            Self::Shape { field } => write!(
                f,
                "`network.shape.{field}` cannot be: a network needs heads, actions, an action for each \
                 entity, units in each hidden layer, and channels only with entities"
            ),
        }
    }
}

impl core::error::Error for NetworkError {}

/// A network of action values. Its layers fit its shape, and its weights are finite.
///
/// ```
/// use tltl::network::{Dense, Network, Shape};
///
/// // One feature, no hidden layer, one head of two actions: Q = x · [1, -1] + [0, 0.5].
/// let shape = Shape { inputs: 1, hidden: vec![], heads: 1, actions: 2, entities: 0, channels: 0 };
/// let network = Network::new(shape, vec![Dense { weights: vec![1.0, -1.0], bias: vec![0.0, 0.5] }])?;
/// assert_eq!(network.values(0, &[0.5], &[]), [0.5, 0.0]);
/// assert_eq!((network.greedy(0, &[0.5], &[]), network.greedy(0, &[0.0], &[])), (0, 1));
/// # Ok::<(), tltl::network::NetworkError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Unchecked", into = "Unchecked"))]
pub struct Network {
    shape: Shape,
    layers: Vec<Dense>,
    form: Form,
}

impl Network {
    /// The network of these layers.
    ///
    /// # Errors
    /// If they do not fit the shape, or a weight is not finite.
    #[inline]
    pub fn new(shape: Shape, layers: Vec<Dense>) -> Result<Self, NetworkError> {
        Self::with_form(shape, layers, Form::default())
    }

    /// The network of these layers with another form than those that are learned here.
    ///
    /// # Errors
    /// If layers or form do not fit the shape, or a number is not finite.
    #[inline]
    pub fn with_form(shape: Shape, layers: Vec<Dense>, form: Form) -> Result<Self, NetworkError> {
        if let Some(field) = shape.fault() {
            return Err(NetworkError::Shape { field });
        }
        let mut widths = shape.widths();
        if let Some(last) = widths.last_mut() {
            *last = form.heads(&shape) * shape.head_width();
        }
        form.check(&shape)?;
        let (found, expected) = (layers.len(), widths.len() - 1);
        if found != expected {
            return Err(NetworkError::Layers { found, expected });
        }
        for (layer, (dense, width)) in layers.iter().zip(widths.windows(2)).enumerate() {
            let weights = width[0].checked_mul(width[1]);
            let parts =
                [("weights", &dense.weights, weights), ("bias", &dense.bias, Some(width[1]))];
            for (part, numbers, expected) in parts {
                let found = numbers.len();
                if expected != Some(found) {
                    return Err(NetworkError::Size { layer, part, found, expected });
                }
            }
            if !dense.weights.iter().chain(&dense.bias).all(|w| w.is_finite()) {
                return Err(NetworkError::NotFinite { layer });
            }
        }
        Ok(Self { shape, layers, form })
    }

    /// A network with random weights: uniform in ±√(6/inputs) (He et al. 2015), and a tenth of it in
    /// the heads, so that all values are near 0 at first.
    ///
    /// ```
    /// use tltl::network::{Network, Shape};
    /// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
    ///
    /// let shape = Shape { inputs: 6, hidden: vec![32], heads: 3, actions: 2, entities: 0, channels: 0 };
    /// let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    /// let network = Network::random(shape, &mut rng);
    /// let values = network.values(2, &[1.0, 0.0, 0.0, 0.0, 0.0, 0.0], &[]);
    /// assert!(values.iter().all(|value| value.abs() < 1.0) && values != [0.0, 0.0]);
    /// assert_eq!(network.silent().values(2, &[1.0; 6], &[]), [0.0, 0.0]);
    /// ```
    #[cfg(feature = "std")]
    pub fn random<R: rand::Rng + ?Sized>(shape: Shape, rng: &mut R) -> Self {
        let widths = shape.widths();
        let last = widths.len() - 2;
        let layers = widths.windows(2).enumerate().map(|(i, width)| {
            let bound = (6.0 / width[0].max(1) as f32).sqrt() * if i == last { 0.1 } else { 1.0 };
            let weight = |_| (2.0 * crate::env::unit(rng) as f32 - 1.0) * bound;
            let weights = (0..width[0] * width[1]).map(weight).collect();
            Dense { weights, bias: alloc::vec![0.0; width[1]] }
        });
        let layers = layers.collect();
        Self { shape, layers, form: Form::default() }
    }

    /// The same network with all values 0: the weights of the heads are.
    ///
    /// Composition starts from such a network, since it adds nothing to the skills until it has
    /// learned something; its hidden layers are random, so it can learn.
    #[must_use]
    #[inline]
    pub fn silent(mut self) -> Self {
        if let Some(heads) = self.layers.last_mut() {
            heads.weights.fill(0.0);
            heads.bias.fill(0.0);
        }
        self
    }

    /// The sizes.
    #[must_use]
    #[inline]
    pub const fn shape(&self) -> &Shape {
        &self.shape
    }

    /// What it does beside its sums.
    #[must_use]
    #[inline]
    pub const fn form(&self) -> &Form {
        &self.form
    }

    /// The layers, the heads last: the columns of head h start at
    /// `h * (actions - entities + 1 + channels)`; without entities, at
    /// `h * actions`.
    #[must_use]
    #[inline]
    pub fn layers(&self) -> &[Dense] {
        &self.layers
    }

    /// Q(s, q, ·) of the head of q, from the features of s.
    ///
    /// An action that points at an entity is worth what all of them have in common, plus the product
    /// of the head's query with the entity's features:
    ///
    /// ```
    /// use tltl::network::{Dense, Network, Shape};
    ///
    /// // No feature of the state, two boxes with one feature each, and an action for each box.
    /// let shape = Shape { inputs: 0, hidden: vec![], heads: 1, actions: 2, entities: 2, channels: 1 };
    /// // The head puts out 0.5, which the boxes have in common, and the query -1.
    /// let network = Network::new(shape, vec![Dense { weights: vec![], bias: vec![0.5, -1.0] }])?;
    /// assert_eq!(network.values(0, &[], &[0.25, 1.0]), [0.25, -0.5], "the nearer box is worth more");
    /// # Ok::<(), tltl::network::NetworkError>(())
    /// ```
    ///
    /// # Panics
    /// If the features or the head do not fit the shape.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn values(&self, head: usize, inputs: &[f32], entities: &[f32]) -> Vec<f32> {
        let (plain, n) = (self.shape.plain(), self.shape.entities);
        assert_eq!(inputs.len(), self.shape.inputs, "as many features as the shape says");
        assert_eq!(entities.len(), self.shape.channels * n, "features of each entity");
        let (last, trunk) = self.layers.split_last().expect("a network has heads");
        let mut x = inputs.to_vec();
        if let Some(scale) = &self.form.scale {
            x.iter_mut().enumerate().for_each(|(i, x)| *x = scale.of(i, *x));
        }
        for (i, dense) in trunk.iter().enumerate() {
            let mut sums = dense.bias.clone();
            if i == 0 && !self.form.states.is_empty() {
                let added = self.form.states[head * sums.len()..].iter();
                sums.iter_mut().zip(added).for_each(|(sum, added)| *sum += added);
            }
            x = dense.forward(&x, 0, sums);
            x.iter_mut().for_each(|v| *v = self.form.activation.of(*v));
        }
        let width = self.shape.head_width();
        let from = if self.form.states.is_empty() { head * width } else { 0 };
        let mut out = last.forward(&x, from, last.bias[from..from + width].to_vec());
        // A head puts out its values first, and then the query.
        let query = out.split_off(self.shape.levels());
        let common = out.get(plain).copied().unwrap_or(0.0);
        out.resize(plain + n, common);
        for (q, features) in query.iter().zip(entities.chunks(n.max(1))) {
            out[plain..].iter_mut().zip(features).for_each(|(v, f)| *v += q * f);
        }
        out
    }

    /// The action of the largest value, the lowest of equals.
    ///
    /// # Panics
    /// As [`Self::values`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn greedy(&self, head: usize, inputs: &[f32], entities: &[f32]) -> usize {
        argmax(&self.values(head, inputs, entities))
    }
}

impl Dense {
    /// The outputs from `from` on, added to `y`.
    ///
    /// Inputs of 0 are skipped: features are mostly sparse (one of many is 1), and half of the units
    /// behind a rectifier are off. The order of the sum is that of the inputs, as in emitted code, so
    /// both give the same bits.
    #[inline]
    fn forward(&self, x: &[f32], from: usize, mut y: Vec<f32>) -> Vec<f32> {
        let width = y.len();
        for (&x, row) in x.iter().zip(self.weights.chunks(self.bias.len())) {
            if x != 0.0 {
                y.iter_mut().zip(&row[from..from + width]).for_each(|(y, w)| *y += x * w);
            }
        }
        y
    }
}

#[cfg(feature = "serde")]
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Unchecked {
    shape: Shape,
    #[serde(default, skip_serializing_if = "is_default")]
    activation: Activation,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    scale: Option<Scale>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    states: Vec<f32>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    controls: Option<Controls>,
    layers: Vec<Dense>,
}

#[cfg(feature = "serde")]
#[inline]
fn is_default(activation: &Activation) -> bool {
    *activation == Activation::default()
}

#[cfg(feature = "serde")]
impl TryFrom<Unchecked> for Network {
    type Error = NetworkError;

    #[inline]
    fn try_from(network: Unchecked) -> Result<Self, NetworkError> {
        let Unchecked { shape, activation, scale, states, controls, layers } = network;
        Self::with_form(shape, layers, Form { activation, scale, states, controls })
    }
}

#[cfg(feature = "serde")]
impl From<Network> for Unchecked {
    #[inline]
    fn from(network: Network) -> Self {
        let Network { shape, layers, form } = network;
        let Form { activation, scale, states, controls } = form;
        Self { shape, activation, scale, states, controls, layers }
    }
}
