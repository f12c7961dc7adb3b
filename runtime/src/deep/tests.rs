//! What no test from outside can see: gradients, normalisation, the order of weights.

use std::vec::Vec;

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::layers::Optimiser;
use super::model::{Batch, Model, Target};
use super::popart::PopArt;
use super::replay::{Replay, SumTree};
use crate::env::{Step, below, unit};
use crate::network::{Dense, Features, Network, Shape};

/// Features that are given as such.
struct Given {
    inputs: usize,
    entities: usize,
    channels: usize,
}

type State = (Vec<f32>, Vec<f32>);

impl Features<State> for Given {
    fn inputs(&self) -> usize {
        self.inputs
    }

    fn entities(&self) -> usize {
        self.entities
    }

    fn channels(&self) -> usize {
        self.channels
    }

    fn write(&self, s: &State, inputs: &mut [f32], entities: &mut [f32]) {
        inputs.copy_from_slice(&s.0);
        entities.copy_from_slice(&s.1);
    }
}

struct Case {
    shape: Shape,
    network: Network,
    states: Vec<State>,
    batch: Batch,
    rng: Xoshiro256PlusPlus,
}

/// A random network and some random states; with `entities`, the last actions point.
fn case(entities: usize, hidden: &[usize], seed: u64) -> Case {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let features = Given { inputs: 5, entities, channels: if entities > 0 { 3 } else { 0 } };
    let shape = Shape::of(&features, hidden, 2, entities + 2);
    let network = Network::random(shape.clone(), &mut rng);
    let mut random = |n: usize| (0..n).map(|_| unit(&mut rng) as f32 - 0.5).collect::<Vec<f32>>();
    let states: Vec<State> =
        (0..4).map(|_| (random(5), random(features.entities * features.channels))).collect();
    let mut batch = Batch::default();
    states.iter().for_each(|s| batch.push(&features, s).unwrap());
    Case { shape, network, states, batch, rng }
}

#[test]
fn the_plain_forward_pass_is_the_library_s() {
    for (seed, (entities, hidden)) in
        [(0, &[7][..]), (4, &[8, 6][..]), (4, &[][..]), (0, &[][..])].into_iter().enumerate()
    {
        let Case { network, states, batch, shape, .. } = case(entities, hidden, seed as u64);
        let values = Model::new(&network, &Device::flex()).values(&batch);
        for (row, (inputs, entities)) in states.iter().enumerate() {
            for head in 0..2 {
                let plain = network.values(head, inputs, entities);
                let from = (row * 2 + head) * shape.actions;
                for (a, b) in plain.iter().zip(&values[from..from + shape.actions]) {
                    assert!((a - b).abs() < 1e-5, "{a} {b}");
                }
            }
        }
    }
}

/// The loss of a model, of which the gradient is the gradient.
fn loss(model: &Model, batch: &Batch, actions: &[u32], targets: &[Target], penalty: f64) -> f64 {
    f64::from(model.gradients(batch, actions, targets, penalty).0)
}

#[test]
fn gradients_agree_with_finite_differences() {
    const STEP: f32 = 1e-2;
    for (entities, penalty) in [(0, 0.0), (4, 0.0), (4, 0.7)] {
        let Case { network, batch, shape, mut rng, .. } = case(entities, &[6], 3);
        let device = Device::flex();
        let model = Model::new(&network, &device);
        let actions = [0, 1, shape.actions as u32 - 1, 0];
        let target = |i: usize| Target { value: unit(&mut rng) as f32, weight: [1.0, 0.3][i % 2] };
        let targets: Vec<Target> = (0..8).map(target).collect();
        let (_, _, gradients) = model.gradients(&batch, &actions, &targets, penalty);
        let layers = model.dense();
        for (layer, (weights, bias)) in gradients.into_iter().enumerate() {
            let gradient = Dense {
                weights: weights.into_data().try_to_vec().unwrap(),
                bias: bias.into_data().try_to_vec().unwrap(),
            };
            let moved = |change: &dyn Fn(&mut Dense)| {
                let mut layers = layers.clone();
                change(&mut layers[layer]);
                let model = Model::resume(shape.clone(), &layers, &device).unwrap();
                loss(&model, &batch, &actions, &targets, penalty)
            };
            let check = |exact: f32, difference: f64| {
                let estimate = difference / f64::from(2.0 * STEP);
                assert!((f64::from(exact) - estimate).abs() < 2e-3, "{exact} {estimate}");
            };
            for i in 0..gradient.weights.len() {
                let up = moved(&|dense| dense.weights[i] += STEP);
                check(gradient.weights[i], up - moved(&|dense| dense.weights[i] -= STEP));
            }
            for i in 0..gradient.bias.len() {
                let up = moved(&|dense| dense.bias[i] += STEP);
                check(gradient.bias[i], up - moved(&|dense| dense.bias[i] -= STEP));
            }
        }
    }
}

#[test]
fn normalisation_preserves_outputs() {
    let Case { network, batch, shape, mut rng, .. } = case(4, &[6], 5);
    let mut model = Model::new(&network, &Device::flex());
    let mut scale = PopArt::new(2, 0.1);
    let outputs = |model: &Model, scale: &PopArt| -> Vec<f64> {
        let values = model.values(&batch).into_iter().enumerate();
        let scaled = |(i, value)| {
            let (mean, deviation) = scale.scale(i / shape.actions % 2);
            mean + deviation * f64::from(value)
        };
        values.map(scaled).collect()
    };
    let before = outputs(&model, &scale);
    for round in 0..50 {
        let old = scale.clone();
        for head in 0..2 {
            let targets = (0..8).map(|_| 3.0 * unit(&mut rng) + f64::from(round) / 10.0);
            scale.observe(head, targets.collect::<Vec<_>>());
        }
        model.rescale(&old, &scale);
    }
    assert!(scale.scale(0).0 > 3.0, "the mean has moved: {:?}", scale.scale(0));
    for (a, b) in before.iter().zip(outputs(&model, &scale)) {
        assert!((a - b).abs() < 1e-4, "{a} {b}");
    }
}

#[test]
fn descent_goes_on_from_its_moments() {
    let Case { network, batch, .. } = case(4, &[6], 7);
    let device = Device::flex();
    let targets = [Target { value: 1.0, weight: 1.0 }; 8];
    let step = |model: &mut Model, descent: &mut Optimiser| {
        let (_, _, gradients) = model.gradients(&batch, &[0, 1, 2, 3], &targets, 0.0);
        descent.step(&mut model.layers, gradients, 1e-2, 10.0)
    };
    let mut model = Model::new(&network, &device);
    let mut descent = Optimiser::new(2);
    (0..3).for_each(|_| assert!(step(&mut model, &mut descent) > 0.0));
    let mut again = Model::resume(model.shape().clone(), &model.dense(), &device).unwrap();
    let mut resumed = Optimiser::resume(&descent.moments().unwrap(), &device);
    (0..3).for_each(|_| assert!(step(&mut model, &mut descent) > 0.0));
    (0..3).for_each(|_| assert!(step(&mut again, &mut resumed) > 0.0));
    assert_eq!(model.dense(), again.dense());
}

#[test]
fn priorities_are_drawn_in_proportion() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut tree, mut naive) = (SumTree::new(100), std::vec![0.0; 100]);
    for _ in 0..1_000 {
        let (i, weight) = (below(100, &mut rng), below(8, &mut rng) as f64);
        tree.set(i, weight);
        naive[i] = weight;
    }
    let total: f64 = naive.iter().sum();
    assert!((tree.total() - total).abs() < 1e-9);
    for step in 0..10_000 {
        let mass = total * f64::from(step) / 10_000.0;
        let mut left = mass;
        let expected = naive.iter().position(|w| {
            left -= w;
            left < 0.0
        });
        assert_eq!(Some(tree.find(mass)), expected);
    }
}

#[test]
fn a_replay_keeps_its_last_states_in_order() {
    let mut replay = Replay::new(10);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    for episode in 0..50 {
        replay.start(episode * 100);
        for t in 1..=episode % 7 {
            replay.push(0, t as u32, Step::to(episode * 100 + t));
        }
        if (0..replay.len()).all(|i| replay.steps_from(i) == 0) {
            continue;
        }
        for _ in 0..20 {
            let (place, _) = replay.draw(&mut rng);
            let ahead = replay.steps_from(place);
            assert!(ahead > 0, "a last state has no step");
            for n in 0..=ahead {
                let expected = replay.moment(place).state + n as i32;
                assert_eq!(replay.moment(replay.after(place, n)).state, expected);
            }
        }
    }
    let mut copy = Replay::new(40);
    copy.extend(&replay, |q| q);
    let whole = |replay: &Replay<i32>| {
        let steps = (0..replay.len()).filter(|&i| replay.steps_from(i) > 0);
        let mut steps: Vec<_> =
            steps.map(|i| (replay.moment(i).state, replay.moment(i).action)).collect();
        steps.sort_unstable();
        steps
    };
    assert_eq!(whole(&copy), whole(&replay));
}
