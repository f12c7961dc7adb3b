//! The network of action values as tensors: batched forward passes, gradients.
//!
//! [`Network`] is the form that runs anywhere; a [`Model`] is the same on a device, in the form in which
//! it is trained: with a value for each state beside what actions add to it. Both turn into each other
//! without a loss but for rounding, so what is saved as a policy is what was trained. The forward pass
//! exists twice, here in batches and there in plain Rust; a test compares them.
//!
//! Shapes are written `[batch, heads, actions]`. Nothing here is random, and on the CPU backend the same
//! numbers come out on every run; other devices may add up in another order.

use burn::tensor::{Device, Tensor, TensorData};
use std::vec::Vec;

use super::layers::{Gradient, Layers, Pass, numbers};
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

    /// The features of some states, in place of those that were there; the number of the feature that is
    /// not finite, if there is one.
    pub(super) fn encode<S>(
        &mut self,
        features: &(impl Features<S> + ?Sized),
        states: &[S],
    ) -> Result<(), usize> {
        self.clear();
        states.iter().try_for_each(|s| self.push(features, s))
    }

    /// The number of states.
    pub(super) const fn len(&self) -> usize {
        self.len
    }

    /// The features of a state, entities' left out.
    pub(super) fn row(&self, row: usize) -> &[f32] {
        let width = self.inputs.len() / self.len;
        &self.inputs[row * width..][..width]
    }

    /// `[batch, inputs]`.
    pub(super) fn tensor(&self, device: &Device) -> Tensor<2> {
        let width = self.inputs.len() / self.len;
        Tensor::from_data(TensorData::new(self.inputs.clone(), [self.len, width]), device)
    }

    /// `[batch, channels, entities]`.
    fn entities(&self, shape: &Shape, device: &Device) -> Tensor<3> {
        let sizes = [self.len, shape.channels, shape.entities];
        Tensor::from_data(TensorData::new(self.entities.clone(), sizes), device)
    }
}

/// A network on a device, as it is trained: each head has, before the rest, the value of the state,
/// which is added to all actions (dueling networks, Wang et al. 2016). The differences between
/// actions are small beside it, and are so learned apart from it.
#[derive(Clone, Debug)]
pub(super) struct Model {
    shape: Shape,
    pub(super) layers: Layers,
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

/// What the last layer says of some states: for each row and head the value of the state, those of plain
/// actions, what pointing has in common, and the query.
pub(super) struct Outputs<'a> {
    shape: &'a Shape,
    numbers: Vec<f32>,
    entities: &'a [f32],
}

impl Outputs<'_> {
    /// The outputs of a row and head, `row * heads + head`.
    fn of(&self, i: usize) -> &[f32] {
        let width = 1 + self.shape.head_width();
        &self.numbers[i * width..][..width]
    }

    /// The features of the entity that an action points at, in the row of `i`.
    fn entity(&self, i: usize, action: usize) -> impl Iterator<Item = f32> {
        let Shape { heads, entities: n, channels, .. } = *self.shape;
        let features = &self.entities[i / heads * channels * n..][..channels * n];
        features.iter().copied().skip(action - self.shape.plain()).step_by(n)
    }

    /// The value of an action for a row and head.
    pub(super) fn value(&self, i: usize, action: usize) -> f32 {
        let (out, plain) = (self.of(i), self.shape.plain());
        if action < plain {
            return out[0] + out[1 + action];
        }
        // One rounding for each term, as the products of matrices have it.
        let products = out[2 + plain..].iter().zip(self.entity(i, action));
        out[0] + (out[1 + plain] + products.fold(0.0, |sum, (q, e)| q.mul_add(e, sum)))
    }

    /// The values of all actions for a row and head.
    pub(super) fn values(&self, i: usize) -> Vec<f32> {
        (0..self.shape.actions).map(|action| self.value(i, action)).collect()
    }

    /// Adds what the outputs have to do with the value of an action, times its `slope`.
    fn add_slope(&self, i: usize, action: usize, slope: f32, error: &mut [f32]) {
        let (plain, width) = (self.shape.plain(), 1 + self.shape.head_width());
        let error = &mut error[i * width..][..width];
        error[0] += slope;
        if action < plain {
            error[1 + action] += slope;
            return;
        }
        error[1 + plain] += slope;
        let query = error[2 + plain..].iter_mut().zip(self.entity(i, action));
        query.for_each(|(error, e)| *error += slope * e);
    }
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
        Self { shape, layers: Layers::of(layers, device) }
    }

    /// The layers as they are trained, for [`Self::resume`].
    pub(super) fn dense(&self) -> Vec<Dense> {
        self.layers.dense()
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
        self.layers.device()
    }

    /// All heads' values of all states, indexed `(row * heads + head) * actions + action`.
    pub(super) fn values(&self, batch: &Batch) -> Vec<f32> {
        let (actions, pass) = (self.shape.actions, self.pass(batch));
        let pointed = self.pointed(&pass.out, batch);
        let outputs = self.read(pass.out, batch);
        let mut values = self.advantages(&outputs, &pointed);
        for (i, row) in values.chunks_mut(actions).enumerate() {
            let state = outputs.of(i)[0];
            row.iter_mut().for_each(|value| *value += state);
        }
        values
    }

    /// What the last layer says of all states. Cheaper than [`Self::values`] where few are asked for.
    pub(super) fn outputs<'a>(&'a self, batch: &'a Batch) -> Outputs<'a> {
        self.read(self.pass(batch).out, batch)
    }

    fn read<'a>(&'a self, out: Tensor<2>, batch: &'a Batch) -> Outputs<'a> {
        Outputs { shape: &self.shape, numbers: numbers(out), entities: &batch.entities }
    }

    /// Through all layers.
    fn pass(&self, batch: &Batch) -> Pass {
        self.layers.pass(batch.tensor(&self.device()))
    }

    /// The products of all queries with all entities, `(row * heads + head) * entities + entity`.
    fn pointed(&self, out: &Tensor<2>, batch: &Batch) -> Vec<f32> {
        let Shape { heads, entities, channels, .. } = self.shape;
        if entities == 0 {
            return Vec::new();
        }
        let (first, width) = (1 + self.shape.levels(), 1 + self.shape.head_width());
        let query = out.clone().reshape([batch.len, heads, width]).narrow(2, first, channels);
        numbers(query.matmul(batch.entities(&self.shape, &self.device())))
    }

    /// What the actions add to the values of states, indexed as [`Self::values`].
    fn advantages(&self, outputs: &Outputs<'_>, pointed: &[f32]) -> Vec<f32> {
        let (plain, n, actions) = (self.shape.plain(), self.shape.entities, self.shape.actions);
        let rows = outputs.numbers.len() / (1 + self.shape.head_width());
        let mut advantages = std::vec![0.0; rows * actions];
        for (i, row) in advantages.chunks_mut(actions).enumerate() {
            let out = outputs.of(i);
            row[..plain].copy_from_slice(&out[1..=plain]);
            let pointed = pointed.get(i * n..(i + 1) * n).unwrap_or_default();
            row[plain..].iter_mut().zip(pointed).for_each(|(v, p)| *v = out[1 + plain] + p);
        }
        advantages
    }

    /// The weighted Huber loss of the values of `actions` (one a row) under all heads, with
    /// `targets` indexed `row * heads + head`, and `penalty` times the mean square of what the actions
    /// add to the values of states; the values; and the gradients, layer by layer.
    ///
    /// Huber's loss (1964) is quadratic near 0 and linear beyond 1, so that one surprising reward does
    /// not throw the weights about. The penalty is multiplied by the number of heads, for the loss is a
    /// sum over them.
    ///
    /// The chain rule is written out: only one action of each row and head has a gradient, unless there is
    /// a penalty, and a library that does not know so multiplies mostly zeros (its graph and those
    /// products were a third of an update of the kitchen's skills).
    pub(super) fn gradients(
        &self,
        batch: &Batch,
        actions: &[u32],
        targets: &[Target],
        penalty: f64,
    ) -> (f32, Vec<f32>, Vec<Gradient>) {
        let (rows, heads) = (batch.len, self.shape.heads);
        let Pass { inputs, out } = self.pass(batch);
        let pointed = if penalty > 0.0 { self.pointed(&out, batch) } else { Vec::new() };
        let outputs = self.read(out, batch);
        let chosen = |i: usize| actions[i / heads] as usize;
        let values: Vec<f32> = (0..rows * heads).map(|i| outputs.value(i, chosen(i))).collect();
        let mut error = std::vec![0.0; outputs.numbers.len()];
        let (mut loss, share) = (0.0, 1.0 / rows as f32);
        let slope = |(value, target): (&f32, &Target)| {
            // Huber's loss: e²/2 up to 1, then e − 1/2.
            let difference = value - target.value;
            let (size, weight) = (difference.abs(), share * target.weight);
            let small = size.min(1.0);
            // What is no number stays none, so that the loss shows it.
            loss += weight * small * (size - 0.5 * small);
            (weight * small).copysign(difference)
        };
        let slopes: Vec<f32> = values.iter().zip(targets).map(slope).collect();
        if penalty > 0.0 {
            let advantages = self.advantages(&outputs, &pointed);
            let weight = (penalty * heads as f64) as f32;
            let mean = 1.0 / advantages.len() as f32;
            loss += weight * mean * advantages.iter().map(|a| a * a).sum::<f32>();
            let mut all: Vec<f32> = advantages.iter().map(|a| weight * mean * (2.0 * a)).collect();
            let width = self.shape.actions;
            (0..rows * heads).for_each(|i| all[i * width + chosen(i)] += slopes[i]);
            self.spread(all, &slopes, batch, &mut error);
        } else {
            (0..rows * heads).for_each(|i| outputs.add_slope(i, chosen(i), slopes[i], &mut error));
        }
        (loss, values, self.back(&inputs, error))
    }

    /// The gradient of the outputs from that of all advantages, and of the values of states.
    fn spread(&self, advantages: Vec<f32>, states: &[f32], batch: &Batch, error: &mut [f32]) {
        let Shape { heads, entities: n, channels, actions, .. } = self.shape;
        let (plain, width) = (self.shape.plain(), 1 + self.shape.head_width());
        let rows = advantages.chunks(actions).zip(states).zip(error.chunks_mut(width));
        for ((advantages, state), error) in rows {
            error[0] = *state;
            error[1..=plain].copy_from_slice(&advantages[..plain]);
        }
        if n == 0 {
            return;
        }
        let device = self.device();
        let data = TensorData::new(advantages, [batch.len, heads, actions]);
        let pointing = Tensor::<3>::from_data(data, &device).narrow(2, plain, n);
        let common = numbers(pointing.clone().sum_dim(2));
        let query = numbers(pointing.matmul(batch.entities(&self.shape, &device).transpose()));
        for (i, error) in error.chunks_mut(width).enumerate() {
            error[1 + plain] = common[i];
            error[2 + plain..].copy_from_slice(&query[i * channels..(i + 1) * channels]);
        }
    }

    /// The gradients of all layers, from that of the outputs and what entered each layer.
    fn back(&self, inputs: &[Tensor<2>], error: Vec<f32>) -> Vec<Gradient> {
        let (rows, width) = (inputs[0].dims()[0], self.shape.heads * (1 + self.shape.head_width()));
        let data = TensorData::new(error, [rows, width]);
        self.layers.back(inputs, Tensor::from_data(data, &self.device()))
    }

    /// Moves every weight to `other`'s by the share `rate`.
    pub(super) fn follow(&mut self, other: &Self, rate: f64) {
        self.layers.follow(&other.layers, rate);
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
        self.layers.rescale(scale, shift);
    }
}
