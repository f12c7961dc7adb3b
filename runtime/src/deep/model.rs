//! The network as tensors: batched forward passes, gradients, Adam.
//!
//! [`Network`] is the form that runs anywhere; a [`Model`] is the same on a device, in the form in which
//! it is trained: with a value for each state beside what actions add to it. Both turn into each other
//! without a loss but for rounding, so what is saved as a policy is what was trained. The forward pass
//! exists twice, here in batches and there in plain Rust; a test compares them.
//!
//! Shapes are written `[batch, heads, actions]`. Nothing here is random, and on the CPU backend the same
//! numbers come out on every run; other devices may add up in another order.

use burn::optim::{Adam, AdamConfig, AdamState, AdaptiveMomentumState, Optimizer};
use burn::tensor::{Device, Int, Tensor, TensorData, activation::relu};
use serde::{Deserialize, Serialize};
use std::vec::Vec;

use super::popart::PopArt;
use crate::network::{Dense, Features, Network, NetworkError, Shape};

/// The features of some states.
///
/// Features lie one state after the other in buffers that are used again for the next batch.
#[derive(Clone, Debug, Default)]
pub(super) struct Batch {
    len: usize,
    inputs: Vec<f32>,
    entities: Vec<f32>,
}

impl Batch {
    pub(super) fn clear(&mut self) {
        self.len = 0;
        self.inputs.clear();
        self.entities.clear();
    }

    /// Adds a state; the number of the feature that is not finite, if there is one.
    pub(super) fn push<S: ?Sized>(
        &mut self,
        features: &(impl Features<S> + ?Sized),
        s: &S,
    ) -> Result<(), usize> {
        let (from, entities_from) = (self.inputs.len(), self.entities.len());
        let entities = features.entities() * features.channels();
        self.len += 1;
        self.inputs.resize(from + features.inputs(), 0.0);
        self.entities.resize(entities_from + entities, 0.0);
        let (inputs, entities) = (&mut self.inputs[from..], &mut self.entities[entities_from..]);
        features.write(s, inputs, entities);
        let all = inputs.iter().chain(entities.iter());
        // Without an early end, so that many are looked at at once.
        if all.clone().fold(true, |finite, x| finite & x.is_finite()) {
            return Ok(());
        }
        Err(all.take_while(|x| x.is_finite()).count())
    }

    /// `[batch, inputs]` and `[batch, channels, entities]`, as [`Model::forward`] takes them.
    fn tensors(&self, shape: &Shape, device: &Device) -> (Tensor<2>, Tensor<3>) {
        let inputs = TensorData::new(self.inputs.clone(), [self.len, shape.inputs]);
        let entities =
            TensorData::new(self.entities.clone(), [self.len, shape.channels, shape.entities]);
        (Tensor::from_data(inputs, device), Tensor::from_data(entities, device))
    }
}

/// A dense layer as tensors.
#[derive(Clone, Debug)]
struct Layer {
    weights: Tensor<2>,
    bias: Tensor<1>,
}

impl Layer {
    fn of(dense: &Dense, device: &Device) -> Self {
        let (inputs, outputs) = (dense.weights.len() / dense.bias.len(), dense.bias.len());
        let weights = TensorData::new(dense.weights.clone(), [inputs, outputs]);
        let bias = TensorData::new(dense.bias.clone(), [outputs]);
        Self { weights: Tensor::from_data(weights, device), bias: Tensor::from_data(bias, device) }
    }

    fn dense(&self) -> Dense {
        Dense { weights: numbers(self.weights.clone()), bias: numbers(self.bias.clone()) }
    }
}

/// The numbers of a tensor, in row-major order.
fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("networks are of f32")
}

/// A network on a device, as it is trained: each head has, before the rest, the value of the state,
/// which is added to all actions (dueling networks, Wang et al. 2016). The differences between
/// actions are small beside it, and are so learned apart from it.
#[derive(Clone, Debug)]
pub(super) struct Model {
    shape: Shape,
    layers: Vec<Layer>,
}

/// What one value of the network is to become.
///
/// A weight of 0 leaves the value alone: the head was not to learn from this step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Target {
    /// What the value should be, normalised.
    pub value: f32,
    /// How much the error counts.
    pub weight: f32,
}

impl Model {
    /// The model of a network, with state values of 0.
    ///
    /// The last layer becomes wider by one column for each head, of weights 0: the values of states
    /// start as 0 and what the network says stays the same.
    pub(super) fn new(network: &Network, device: &Device) -> Self {
        let (shape, mut layers) = (network.shape().clone(), network.layers().to_vec());
        let width = shape.head_width();
        let heads = layers.last_mut().expect("a network has heads");
        let lead = |row: &[f32]| {
            let heads = row.chunks(width);
            heads
                .flat_map(|head| [0.0].into_iter().chain(head.iter().copied()))
                .collect::<Vec<f32>>()
        };
        heads.weights = lead(&heads.weights);
        heads.bias = lead(&heads.bias);
        Self::of(shape, &layers, device)
    }

    fn of(shape: Shape, layers: &[Dense], device: &Device) -> Self {
        Self { shape, layers: layers.iter().map(|dense| Layer::of(dense, device)).collect() }
    }

    /// The layers as they are trained, for [`Self::resume`].
    pub(super) fn dense(&self) -> Vec<Dense> {
        self.layers.iter().map(Layer::dense).collect()
    }

    /// The model that had these layers; `None` if they do not fit the shape.
    pub(super) fn resume(shape: Shape, layers: &[Dense], device: &Device) -> Option<Self> {
        let mut widths = shape.widths();
        *widths.last_mut()? += shape.heads;
        let sizes = widths.windows(2).map(|width| (width[0] * width[1], width[1]));
        let fits = layers.len() + 1 == widths.len()
            && sizes.zip(layers).all(|(size, l)| size == (l.weights.len(), l.bias.len()));
        fits.then(|| Self::of(shape, layers, device))
    }

    pub(super) const fn shape(&self) -> &Shape {
        &self.shape
    }

    /// The network: the values of states added to those of their actions. NetworkError if a weight has
    /// become infinite or no number.
    pub(super) fn network(&self) -> Result<Network, NetworkError> {
        let mut layers = self.dense();
        let (width, levels) = (self.shape.head_width(), self.shape.levels());
        let heads = layers.last_mut().expect("a network has heads");
        let fold = |row: &[f32]| {
            let fold = |head: &[f32]| {
                let (value, rest) = (head[0], &head[1..]);
                let add = |(i, x): (usize, &f32)| if i < levels { x + value } else { *x };
                rest.iter().enumerate().map(add).collect::<Vec<f32>>()
            };
            row.chunks(width + 1).flat_map(fold).collect::<Vec<f32>>()
        };
        heads.weights = fold(&heads.weights);
        heads.bias = fold(&heads.bias);
        Network::new(self.shape.clone(), layers)
    }

    fn device(&self) -> Device {
        self.layers[0].bias.device()
    }

    /// All heads' values of all states, indexed `(row * heads + head) * actions + action`.
    pub(super) fn values(&self, batch: &Batch) -> Vec<f32> {
        let (inputs, entities) = batch.tensors(&self.shape, &self.device());
        let (states, advantages) = self.forward(inputs, entities);
        numbers(states + advantages)
    }

    /// `[batch, inputs]` and `[batch, channels, entities]` to the values of states, `[batch, heads, 1]`,
    /// and what the actions add to them, `[batch, heads, actions]`.
    fn forward(&self, inputs: Tensor<2>, entities: Tensor<3>) -> (Tensor<3>, Tensor<3>) {
        let Shape { heads, entities: n, channels, .. } = self.shape;
        let (plain, width) = (self.shape.plain(), self.shape.head_width());
        let (last, trunk) = self.layers.split_last().expect("a network has heads");
        let dense =
            |x: Tensor<2>, l: &Layer| x.matmul(l.weights.clone()) + l.bias.clone().unsqueeze();
        let x = trunk.iter().fold(inputs, |x, layer| relu(dense(x, layer)));
        let rows = x.dims()[0];
        let out = dense(x, last).reshape([rows, heads, 1 + width]);
        let state = out.clone().narrow(2, 0, 1);
        if n == 0 {
            return (state, out.narrow(2, 1, plain));
        }
        // A head: the value of the state, those of plain actions, what pointing has in common, the query.
        let query = out.clone().narrow(2, plain + 2, channels);
        let pointing = out.clone().narrow(2, plain + 1, 1) + query.matmul(entities);
        if plain == 0 {
            return (state, pointing);
        }
        (state, Tensor::cat(std::vec![out.narrow(2, 1, plain), pointing], 2))
    }

    /// The layers with gradients.
    fn tracked(&self) -> Self {
        let layers = self.layers.iter().map(|layer| Layer {
            weights: Tensor::from_inner(layer.weights.clone()).require_grad(),
            bias: Tensor::from_inner(layer.bias.clone()).require_grad(),
        });
        Self { shape: self.shape.clone(), layers: layers.collect() }
    }

    /// The weighted Huber loss of the values of `actions` (one a row) under all heads, with
    /// `targets` indexed `row * heads + head`, and `penalty` times the mean square of what the actions
    /// add to the values of states; the values; and the gradients, layer by layer.
    ///
    /// Huber's loss (1964) is quadratic near 0 and linear beyond 1, so that one surprising reward does
    /// not throw the weights about. The penalty is multiplied by the number of heads, for the loss is a
    /// sum over them.
    pub(super) fn gradients(
        &self,
        batch: &Batch,
        actions: &[u32],
        targets: &[Target],
        penalty: f64,
    ) -> (f32, Vec<f32>, Vec<(Tensor<2>, Tensor<1>)>) {
        let (rows, heads) = (batch.len, self.shape.heads);
        let model = self.tracked();
        let device = model.device();
        let (inputs, entities) = batch.tensors(&self.shape, &device);
        let (states, advantages) = model.forward(inputs, entities);
        let values = states + advantages.clone();
        let chosen = actions.iter().flat_map(|&a| core::iter::repeat_n(i64::from(a), heads));
        let chosen = TensorData::new(chosen.collect::<Vec<i64>>(), [rows, heads, 1]);
        let values = values.gather(2, Tensor::<3, Int>::from_data(chosen, &device));
        let of = |f: fn(&Target) -> f32| {
            let data = targets.iter().map(f).collect::<Vec<f32>>();
            Tensor::<3>::from_data(TensorData::new(data, [rows, heads, 1]), &device)
        };
        let error = (values.clone() - of(|target| target.value)).abs();
        // Huber's loss: e²/2 up to 1, then e − 1/2.
        let small = error.clone().clamp_max(1.0);
        let huber = small.clone() * (error - small.mul_scalar(0.5));
        let mut loss = (huber * of(|target| target.weight)).sum().div_scalar(rows as f32);
        if penalty > 0.0 {
            let squares = advantages.powi_scalar(2).mean();
            loss = loss + squares.mul_scalar(penalty * heads as f64);
        }
        let gradients = loss.backward();
        let of = |layer: &Layer| {
            let weights = layer.weights.grad(&gradients).expect("every layer is used");
            (weights, layer.bias.grad(&gradients).expect("every layer is used"))
        };
        let layers = model.layers.iter().map(of).collect();
        (loss.inner().into_scalar(), numbers(values.inner()), layers)
    }

    /// Moves every weight to `other`'s by the share `rate`.
    ///
    /// The soft target of Lillicrap et al. (2016): bootstrapping from a network that moves slowly keeps
    /// errors from chasing each other.
    pub(super) fn follow(&mut self, other: &Self, rate: f64) {
        for (layer, to) in self.layers.iter_mut().zip(&other.layers) {
            layer.weights = layer.weights.clone()
                + (to.weights.clone() - layer.weights.clone()).mul_scalar(rate);
            layer.bias =
                layer.bias.clone() + (to.bias.clone() - layer.bias.clone()).mul_scalar(rate);
        }
    }

    /// Rewrites the heads so that what they put out under the scales `new` is what they put out under
    /// `old`: `σ' y' + μ' = σ y + μ`.
    pub(super) fn rescale(&mut self, old: &PopArt, new: &PopArt) {
        let width = 1 + self.shape.head_width();
        let heads = 0..self.shape.heads;
        let (mut scale, mut shift) = (Vec::new(), Vec::new());
        for (old, new) in heads.map(|head| (old.scale(head), new.scale(head))) {
            let factor = (old.1 / new.1) as f32;
            scale.extend(core::iter::repeat_n(factor, width));
            // The value of the state shifts all others.
            shift.push(((old.0 - new.0) / new.1) as f32);
            shift.extend(core::iter::repeat_n(0.0, width - 1));
        }
        let device = self.device();
        let row = |numbers: Vec<f32>| {
            let length = numbers.len();
            Tensor::<1>::from_data(TensorData::new(numbers, [length]), &device)
        };
        let (scale, shift) = (row(scale), row(shift));
        let last = self.layers.last_mut().expect("a network has heads");
        last.weights = last.weights.clone() * scale.clone().unsqueeze();
        last.bias = last.bias.clone() * scale + shift;
    }
}

/// Adam (Kingma and Ba 2015) on all layers of a model, with a bound on the norm of the gradient.
///
/// Adam's ε is 1e-8, the paper's: it is added to the root of the second moment, and larger ones slow down
/// weights with small gradients. The bound is on the norm over all layers together, so that a shortened
/// gradient keeps its direction.
pub(super) struct Optimiser {
    adam: Adam,
    moments: Vec<(Option<AdamState<2>>, Option<AdamState<1>>)>,
}

/// Adam's moments as numbers.
///
/// Saved with a learner, without which training would go on with other steps than before.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct AdamMoments {
    time: usize,
    first: Vec<Dense>,
    second: Vec<Dense>,
}

impl AdamMoments {
    /// Whether these are moments of such layers.
    pub(super) fn fit(&self, layers: &[Dense]) -> bool {
        let sizes = |layers: &[Dense]| {
            layers.iter().map(|l| (l.weights.len(), l.bias.len())).collect::<Vec<_>>()
        };
        [&self.first, &self.second].iter().all(|moments| sizes(moments) == sizes(layers))
    }
}

impl Optimiser {
    pub(super) fn new(layers: usize) -> Self {
        let moments = core::iter::repeat_with(|| (None, None)).take(layers).collect();
        Self { adam: AdamConfig::new().with_epsilon(1e-8).build(), moments }
    }

    /// One step of `rate` against `gradients`, which are shortened to the norm `bound`; the norm
    /// before.
    pub(super) fn step(
        &mut self,
        model: &mut Model,
        gradients: Vec<(Tensor<2>, Tensor<1>)>,
        rate: f64,
        bound: f64,
    ) -> f64 {
        let squares = |w: &Tensor<2>, b: &Tensor<1>| {
            let sum = w.clone().powi_scalar(2).sum() + b.clone().powi_scalar(2).sum();
            f64::from(sum.into_scalar::<f32>())
        };
        let norm = gradients.iter().map(|(w, b)| squares(w, b)).sum::<f64>().sqrt();
        let scale = if norm > bound { bound / norm } else { 1.0 };
        for ((layer, (w, b)), moments) in
            model.layers.iter_mut().zip(gradients).zip(&mut self.moments)
        {
            let (w, b) =
                if scale < 1.0 { (w.mul_scalar(scale), b.mul_scalar(scale)) } else { (w, b) };
            (layer.weights, moments.0) =
                self.adam.step(rate, layer.weights.clone(), w, moments.0.take());
            (layer.bias, moments.1) = self.adam.step(rate, layer.bias.clone(), b, moments.1.take());
        }
        norm
    }

    /// The moments; `None` before the first step.
    pub(super) fn moments(&self) -> Option<AdamMoments> {
        let mut all = AdamMoments { time: 0, first: Vec::new(), second: Vec::new() };
        for (w, b) in &self.moments {
            let (w, b) = (&w.as_ref()?.momentum, &b.as_ref()?.momentum);
            let dense = |w: &Tensor<2>, b: &Tensor<1>| Dense {
                weights: numbers(w.clone()),
                bias: numbers(b.clone()),
            };
            all.time = w.time;
            all.first.push(dense(&w.moment_1, &b.moment_1));
            all.second.push(dense(&w.moment_2, &b.moment_2));
        }
        Some(all)
    }

    /// An optimiser that goes on from `moments`.
    pub(super) fn resume(moments: &AdamMoments, device: &Device) -> Self {
        let mut descent = Self::new(moments.first.len());
        let layers = moments.first.iter().zip(&moments.second);
        for (state, (first, second)) in descent.moments.iter_mut().zip(layers) {
            let (first, second) = (Layer::of(first, device), Layer::of(second, device));
            let weights = AdaptiveMomentumState::new(moments.time, first.weights, second.weights);
            let bias = AdaptiveMomentumState::new(moments.time, first.bias, second.bias);
            *state = (Some(AdamState::new(weights)), Some(AdamState::new(bias)));
        }
        descent
    }
}
