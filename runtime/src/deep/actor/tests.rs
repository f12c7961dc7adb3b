//! Gradients of actor and critics against finite differences.

use std::vec::Vec;

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::Settings;
use super::sum::{Part, Sum};
use super::trainer::{Trained, Trainer, joined, shapes};
use crate::augmented::Moves;
use crate::compose::Combine;
use crate::deep::layers::{Gradient, Layers, numbers};
use crate::deep::sample::Heads;
use crate::env::unit;
use crate::monitor::Acceptor;
use crate::network::{Dense, Features, Network};
use crate::reward::Rewards;

const INPUTS: usize = 3;
const COMPONENTS: usize = 2;
const HEADS: usize = 2;
const ROWS: usize = 5;
const STEP: f32 = 2e-3;

/// An automaton that moves on twice.
struct Twice;

impl Acceptor for Twice {
    fn states(&self) -> u32 {
        3
    }

    fn is_accepting(&self, q: u32) -> bool {
        q == 2
    }

    fn is_trap(&self, _: u32) -> bool {
        false
    }

    fn distance(&self, q: u32) -> Option<u32> {
        Some(2 - q)
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        (q..=(q + 1).min(2)).for_each(visit);
    }
}

struct Given;

impl Features<[f32; INPUTS]> for Given {
    fn inputs(&self) -> usize {
        INPUTS
    }

    fn write(&self, s: &[f32; INPUTS], inputs: &mut [f32], _: &mut [f32]) {
        inputs.copy_from_slice(s);
    }
}

/// A random actor and critic with some random states, whose features the trainer has at hand.
fn case() -> (Trainer, Vec<[f32; INPUTS]>, Xoshiro256PlusPlus) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let heads = Heads::new(&Moves::new(&Twice, Rewards::default()), Twice.states());
    let settings = Settings::default().with_hidden([7, 6]).unwrap();
    let shapes = shapes(INPUTS, COMPONENTS, HEADS, &settings);
    let mut trainer = Trainer::new(shapes, 1, heads, &Device::flex(), &mut rng);
    let states: Vec<[f32; INPUTS]> =
        (0..ROWS).map(|_| [(); INPUTS].map(|()| 2.0 * unit(&mut rng) as f32 - 1.0)).collect();
    trainer.before.encode(&Given, &states).unwrap();
    trainer.critics[0].layers = loud(&trainer.critics[0].layers.dense());
    (trainer, states, rng)
}

/// Layers with larger weights of heads: those begin small, and their gradients could not be told from
/// noise.
fn loud(layers: &[Dense]) -> Layers {
    let mut layers = layers.to_vec();
    layers[2].weights.iter_mut().for_each(|w| *w *= 10.0);
    Layers::of(&layers, &Device::flex())
}

/// Two critics of skills, combined: of the first head both count, of the second one only the second.
fn sum(combine: Combine, rng: &mut Xoshiro256PlusPlus) -> Sum<'static, [f32; INPUTS]> {
    let mut part = |scale| {
        let critic = Network::random(critic_shape(), rng);
        Part { features: &Given, critic: loud(critic.layers()), heads: HEADS, scale }
    };
    let terms = std::vec![std::vec![(0, 1), (1, 0)], std::vec![(1, 1)]];
    Sum { parts: std::vec![part(0.7), part(1.3)], terms, combine }
}

/// Random actions, one for each state.
fn random_actions(rng: &mut Xoshiro256PlusPlus) -> Vec<[f32; COMPONENTS]> {
    (0..ROWS).map(|_| [(); COMPONENTS].map(|()| 2.0 * unit(rng) as f32 - 1.0)).collect()
}

/// Compares each gradient with the difference that a change of its weight makes in `loss`.
fn agree(layers: &[Dense], gradients: Vec<Gradient>, loss: impl Fn(Layers) -> f64) {
    for (layer, (weights, bias)) in gradients.into_iter().enumerate() {
        let moved = |change: &dyn Fn(&mut Dense, f32), size: f32| {
            let [up, down] = [size, -size].map(|step| {
                let mut layers = layers.to_vec();
                change(&mut layers[layer], step);
                loss(Layers::of(&layers, &Device::flex()))
            });
            (up - down) / f64::from(2.0 * size)
        };
        let check = |exact: f32, change: &dyn Fn(&mut Dense, f32)| {
            // Where a rectifier turns on or off within a step, a shorter one decides.
            let differences = [STEP, STEP / 4.0].map(|size| moved(change, size));
            let near = |difference: &f64| (f64::from(exact) - difference).abs() < 2e-3;
            assert!(differences.iter().any(near), "{exact} {differences:?}");
        };
        for (i, &exact) in numbers(weights).iter().enumerate() {
            check(exact, &|dense, step| dense.weights[i] += step);
        }
        for (i, &exact) in bias.into_data().try_to_vec().unwrap().iter().enumerate() {
            check(exact, &|dense, step| dense.bias[i] += step);
        }
    }
}

#[test]
fn the_gradient_of_a_critic_agrees_with_finite_differences() {
    let (trainer, _, mut rng) = case();
    let device = Device::flex();
    let actions = random_actions(&mut rng);
    let rows = || actions.iter().map(|action| &action[..]).enumerate();
    let targets: Vec<f32> = (0..ROWS * HEADS).map(|_| unit(&mut rng) as f32).collect();
    let counts: Vec<bool> = (0..ROWS * HEADS).map(|i| i % 3 > 0).collect();
    let found = |critic: &Trained| {
        let inputs = joined(&trainer.before, rows(), COMPONENTS, &device);
        critic.gradients(inputs, &targets, &counts)
    };
    let critic = &trainer.critics[0];
    agree(&critic.layers.dense(), found(critic).1, |layers| {
        let mut critic = Trained::resume(&critic.saved(), &critic_shape(), &device).unwrap();
        critic.layers = layers;
        f64::from(found(&critic).0)
    });
}

fn critic_shape() -> crate::network::Shape {
    let settings = Settings::default().with_hidden([7, 6]).unwrap();
    let [_, critic] = shapes(INPUTS, COMPONENTS, HEADS, &settings);
    critic
}

#[test]
fn the_slope_of_a_sum_of_critics_agrees_with_finite_differences() {
    let (_, states, mut rng) = case();
    for combine in [Combine::Sum, Combine::Max] {
        let sum = sum(combine, &mut rng);
        let actions = random_actions(&mut rng);
        let value = |row: usize, action: &[f32]| {
            f64::from(sum.values(&states, &[(row, action)]).unwrap()[row % HEADS])
        };
        let rows: Vec<_> = actions.iter().map(|action| &action[..]).enumerate().collect();
        let slopes = sum.slopes(&states, &rows).unwrap();
        for (i, exact) in slopes.into_iter().enumerate() {
            let (row, c) = (i / COMPONENTS, i % COMPONENTS);
            let [up, down] = [STEP, -STEP].map(|step| {
                let mut action = actions[row];
                action[c] += step;
                value(row, &action)
            });
            let difference = (up - down) / f64::from(2.0 * STEP);
            assert!((f64::from(exact) - difference).abs() < 2e-3, "{exact} {difference}");
        }
    }
}

#[test]
fn the_gradient_of_the_actor_agrees_with_finite_differences() {
    let (trainer, states, mut rng) = case();
    let device = Device::flex();
    let counts: Vec<bool> = (0..ROWS * HEADS).map(|i| i % 3 > 0).collect();
    for base in [None, Some(sum(Combine::Sum, &mut rng))] {
        // Minus the mean value of the actor's actions, of the heads that count.
        let regret = |actor: Layers| {
            let actions = Trainer::actions(&actor, &trainer.before);
            let row = |(i, action)| (i / HEADS, action);
            let rows: Vec<_> = actions.chunks(COMPONENTS).enumerate().map(row).collect();
            let inputs = joined(&trainer.before, rows.iter().copied(), COMPONENTS, &device);
            let mut values = numbers(trainer.critics[0].layers.pass(inputs).out);
            if let Some(base) = &base {
                let base = base.values(&states, &rows).unwrap();
                values.iter_mut().zip(base).for_each(|(value, base)| *value += base);
            }
            let own = values.chunks(HEADS).enumerate().map(|(i, row)| f64::from(row[i % HEADS]));
            let counted = own.zip(&counts).filter(|(_, counts)| **counts);
            -counted.map(|(v, _)| v).sum::<f64>() / ROWS as f64
        };
        let gradients = trainer.ascent(&states, &counts, base.as_ref()).unwrap();
        agree(&trainer.actor.layers.dense(), gradients, regret);
    }
}
