//! Dense layers as tensors: forward passes, gradients, Adam.
//!
//! What the networks of all learners are made of. Nothing here is random, and on the CPU backend the same
//! numbers come out on every run; other devices may add up in another order.

use burn::optim::{Adam, AdamConfig, AdamState, AdaptiveMomentumState, Optimizer};
use burn::tensor::{Device, Tensor, TensorData, activation::relu};
use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::network::Dense;

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
pub(super) fn numbers<const D: usize>(tensor: Tensor<D>) -> Vec<f32> {
    tensor.into_data().try_to_vec().expect("networks are of f32")
}

/// The gradient of a layer: of its weights and of its bias.
pub(super) type Gradient = (Tensor<2>, Tensor<1>);

/// A batch on its way through all layers.
pub(super) struct Pass {
    /// What entered each layer.
    pub inputs: Vec<Tensor<2>>,
    /// What the last layer put out.
    pub out: Tensor<2>,
}

/// Dense layers one after the other, with rectifiers between them.
#[derive(Clone, Debug)]
pub(super) struct Layers(Vec<Layer>);

impl Layers {
    pub(super) fn of(layers: &[Dense], device: &Device) -> Self {
        Self(layers.iter().map(|dense| Layer::of(dense, device)).collect())
    }

    /// Their numbers.
    pub(super) fn dense(&self) -> Vec<Dense> {
        self.0.iter().map(Layer::dense).collect()
    }

    pub(super) fn device(&self) -> Device {
        self.0[0].bias.device()
    }

    /// Through all layers, from `[rows, inputs]`.
    pub(super) fn pass(&self, inputs: Tensor<2>) -> Pass {
        let (last, trunk) = self.0.split_last().expect("a network has a layer");
        let dense =
            |x: Tensor<2>, l: &Layer| x.matmul(l.weights.clone()) + l.bias.clone().unsqueeze();
        let mut inputs = std::vec![inputs];
        for layer in trunk {
            let x = relu(dense(inputs[inputs.len() - 1].clone(), layer));
            inputs.push(x);
        }
        let out = dense(inputs[inputs.len() - 1].clone(), last);
        Pass { inputs, out }
    }

    /// The gradients of all layers, from that of the outputs and what entered each layer.
    pub(super) fn back(&self, inputs: &[Tensor<2>], error: Tensor<2>) -> Vec<Gradient> {
        let mut gradients = Vec::new();
        self.descend(inputs, error, &mut |x, error| {
            let weights = x.clone().transpose().matmul(error.clone());
            gradients.push((weights, error.clone().sum_dim(0).squeeze_dim(0)));
        });
        gradients.reverse();
        gradients
    }

    /// The gradient of the inputs from `first` on, from that of the outputs.
    pub(super) fn back_to_inputs(
        &self,
        inputs: &[Tensor<2>],
        error: Tensor<2>,
        first: usize,
    ) -> Tensor<2> {
        let sums = self.descend(inputs, error, &mut |_, _| ());
        let width = inputs[0].dims()[1];
        sums.matmul(self.0[0].weights.clone().narrow(0, first, width - first).transpose())
    }

    /// Visits what entered each layer and the gradient of its sums, the last layer first; the gradient of
    /// the first layer's.
    fn descend(
        &self,
        inputs: &[Tensor<2>],
        mut error: Tensor<2>,
        visit: &mut dyn FnMut(&Tensor<2>, &Tensor<2>),
    ) -> Tensor<2> {
        for (i, (layer, x)) in self.0.iter().zip(inputs).enumerate().rev() {
            visit(x, &error);
            if i > 0 {
                error = error.matmul(layer.weights.clone().transpose());
                // Of a unit that is off nothing goes on: a factor, for a branch is mispredicted half of the time.
                error = error * x.clone().greater_elem(0.0).float();
            }
        }
        error
    }

    /// Moves every weight to `other`'s by the share `rate`.
    ///
    /// The soft target of Lillicrap et al. (2016): bootstrapping from a network that moves slowly keeps
    /// errors from chasing each other.
    pub(super) fn follow(&mut self, other: &Self, rate: f64) {
        for (layer, to) in self.0.iter_mut().zip(&other.0) {
            layer.weights = layer.weights.clone()
                + (to.weights.clone() - layer.weights.clone()).mul_scalar(rate);
            layer.bias =
                layer.bias.clone() + (to.bias.clone() - layer.bias.clone()).mul_scalar(rate);
        }
    }

    /// Makes each output 0.
    pub(super) fn silence(&mut self) {
        let last = self.0.last_mut().expect("a network has a layer");
        last.weights = last.weights.zeros_like();
        last.bias = last.bias.zeros_like();
    }

    /// Multiplies each output by `scale` and adds `shift` to it.
    pub(super) fn rescale(&mut self, scale: Tensor<1>, shift: Tensor<1>) {
        let last = self.0.last_mut().expect("a network has a layer");
        last.weights = last.weights.clone() * scale.clone().unsqueeze();
        last.bias = last.bias.clone() * scale + shift;
    }
}

/// Adam (Kingma and Ba 2015) on all layers of a network, with a bound on the norm of the gradient.
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
        layers: &mut Layers,
        gradients: Vec<Gradient>,
        rate: f64,
        bound: f64,
    ) -> f64 {
        let squares = |w: &Tensor<2>, b: &Tensor<1>| {
            let sum = w.clone().square().sum() + b.clone().square().sum();
            f64::from(sum.into_scalar::<f32>())
        };
        let norm = gradients.iter().map(|(w, b)| squares(w, b)).sum::<f64>().sqrt();
        let scale = if norm > bound { bound / norm } else { 1.0 };
        for ((layer, (w, b)), moments) in layers.0.iter_mut().zip(gradients).zip(&mut self.moments)
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
