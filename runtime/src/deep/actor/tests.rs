//! Gradients of actor and critics against finite differences.

use std::vec::Vec;

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::Settings;
use super::ascent::Hill;
use super::stochastic::{self, Drawn, Temperature};
use super::sum::{Part, Rows, Sum};
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

/// A random actor and critics with some random states, whose features the trainer has at hand.
fn case(settings: Settings) -> (Trainer, Vec<[f32; INPUTS]>, Xoshiro256PlusPlus) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let heads = Heads::new(&Moves::new(&Twice, Rewards::default()), Twice.states());
    let settings = settings.with_hidden([7, 6]).unwrap();
    let shapes = shapes(INPUTS, COMPONENTS, HEADS, &settings);
    let mut trainer = Trainer::new(shapes, &settings, heads, &Device::flex(), &mut rng);
    let states: Vec<[f32; INPUTS]> =
        (0..ROWS).map(|_| [(); INPUTS].map(|()| 2.0 * unit(&mut rng) as f32 - 1.0)).collect();
    trainer.before.encode(&Given, &states).unwrap();
    for critic in &mut trainer.critics {
        critic.layers = loud(&critic.layers.dense());
    }
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
    let (trainer, _, mut rng) = case(Settings::ddpg());
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
    let settings = Settings::td3().with_hidden([7, 6]).unwrap();
    let [_, critic] = shapes(INPUTS, COMPONENTS, HEADS, &settings);
    critic
}

#[test]
fn the_slope_of_a_sum_of_critics_agrees_with_finite_differences() {
    let (_, states, mut rng) = case(Settings::ddpg());
    for combine in [Combine::Sum, Combine::Max] {
        let sum = sum(combine, &mut rng);
        let actions = random_actions(&mut rng);
        let value = |row: usize, action: &[f32]| {
            f64::from(sum.values(&states, &[(row, action)]).unwrap()[row % HEADS])
        };
        let rows: Vec<_> = actions.iter().map(|action| &action[..]).enumerate().collect();
        let own: Vec<usize> = (0..ROWS).map(|row| row % HEADS).collect();
        let (values, slopes) = sum.slopes(&states, &rows, &own).unwrap();
        assert!((0..ROWS).all(|row| f64::from(values[row]) == value(row, &actions[row])));
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
    let (trainer, states, mut rng) = case(Settings::ddpg());
    let device = Device::flex();
    let counts: Vec<bool> = (0..ROWS * HEADS).map(|i| i % 3 > 0).collect();
    let others = random_actions(&mut rng);
    let taken: Vec<_> = others.iter().map(|action| &action[..]).enumerate().collect();
    let whole = sum(Combine::Sum, &mut rng);
    for (base, imitation) in [(None, 0.0), (Some(&whole), 0.0), (None, 2.0), (Some(&whole), 2.0)] {
        // What actions are worth, by row and head.
        let worth = |rows: Rows<'_>| {
            let inputs = joined(&trainer.before, rows.iter().copied(), COMPONENTS, &device);
            let mut values = numbers(trainer.critics[0].layers.pass(inputs).out);
            if let Some(base) = base {
                let base = base.values(&states, rows).unwrap();
                values.iter_mut().zip(base).for_each(|(value, base)| *value += base);
            }
            values
        };
        let own = |actions: &[f32]| {
            let rows =
                actions.chunks(COMPONENTS).enumerate().map(|(i, action)| (i / HEADS, action));
            let values = worth(&rows.collect::<Vec<_>>());
            values.chunks(HEADS).enumerate().map(|(i, row)| row[i % HEADS]).collect::<Vec<_>>()
        };
        let first = own(&Trainer::actions(&trainer.actor.layers, &trainer.before));
        let better: Vec<bool> = worth(&taken).iter().zip(first).map(|(a, b)| *a > b).collect();
        assert!(better.contains(&true) && better.contains(&false));
        // Minus the mean value of the actor's actions, of the heads that count, and what those are away from
        // others that are better.
        let regret = |actor: Layers| {
            let actions = Trainer::actions(&actor, &trainer.before);
            let away = |i: usize| {
                let pairs = actions[i * COMPONENTS..].iter().zip(&others[i / HEADS]);
                0.5 * imitation * pairs.map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>()
            };
            let all = own(&actions).into_iter().map(f64::from).enumerate();
            let all = all.map(|(i, v)| v - if better[i] { away(i) } else { 0.0 });
            -all.zip(&counts).filter(|(_, counts)| **counts).map(|(v, _)| v).sum::<f64>()
                / ROWS as f64
        };
        let imitation = imitation as f32;
        let hill = Hill { states: &states, taken: &taken, counts: &counts, base, imitation };
        let (gradients, _) = trainer.ascent(&hill, &mut rng).unwrap();
        agree(&trainer.actor.layers.dense(), gradients, regret);
    }
}

#[test]
fn the_gradient_of_a_stochastic_actor_agrees_with_finite_differences() {
    let (mut trainer, states, rng) = case(Settings::sac());
    let device = Device::flex();
    trainer.actor.layers = loud(&trainer.actor.layers.dense());
    // As much as the values, so that the gradient of the entropy shows.
    trainer.temperature.as_mut().unwrap().tune(1.0, 5.0);
    let weight = trainer.temperature.as_ref().unwrap().weight();
    let counts: Vec<bool> = (0..ROWS * HEADS).map(|i| i % 3 > 0).collect();
    // Minus what actions that are drawn by the same noise are worth, their entropy included.
    let regret = |actor: Layers| {
        let out = actor.pass(trainer.before.tensor(&device)).out;
        let drawn = trainer.drawn(out, &mut rng.clone());
        let rows = drawn.actions.chunks(COMPONENTS).enumerate();
        let rows = rows.map(|(i, action)| (i / HEADS, action));
        let inputs = joined(&trainer.before, rows, COMPONENTS, &device);
        let pass = |critic: &Trained| numbers(critic.layers.pass(inputs.clone()).out);
        let values = trainer.critics.iter().map(pass).reduce(least).unwrap();
        let own = values.chunks(HEADS).enumerate().map(|(i, row)| f64::from(row[i % HEADS]));
        let entropies = drawn.entropies(COMPONENTS).map(f64::from);
        let counted = own.zip(entropies).zip(&counts).filter(|(_, counts)| **counts);
        -counted.map(|((value, entropy), _)| value + weight * entropy).sum::<f64>() / ROWS as f64
    };
    let (states, counts) = (&states[..], &counts[..]);
    let hill = Hill { states, taken: &[], counts, base: None, imitation: 0.0 };
    let (gradients, _) = trainer.ascent(&hill, &mut rng.clone()).unwrap();
    agree(&trainer.actor.layers.dense(), gradients, regret);
}

/// The least of each two numbers.
fn least(a: Vec<f32>, b: Vec<f32>) -> Vec<f32> {
    a.into_iter().zip(b).map(|(a, b)| a.min(b)).collect()
}

#[test]
fn the_density_of_an_action_is_that_of_its_noise_over_its_slope() {
    for (mean, spread) in [(0.0, 0.0), (0.7, -0.5), (-1.2, 0.6), (2.0, -2.0)] {
        for noise in [-1.5, -0.2, 0.0, 1.1] {
            // So far apart that narrow distributions differ by more than rounding.
            let far = 10.0 * STEP;
            let [here, up, down] =
                [0.0, far, -far].map(|step| Drawn::new(&[mean, spread], 1, || noise + step));
            let slope = f64::from(up.actions[0] - down.actions[0]) / f64::from(2.0 * far);
            let normal = (-0.5 * f64::from(noise).powi(2)).exp() / core::f64::consts::TAU.sqrt();
            let (found, exact) = (f64::from(here.densities[0]), (normal / slope).ln());
            assert!((found - exact).abs() < 1e-2, "{found} {exact} {mean} {spread} {noise}");
            assert_eq!(here.actions[0], stochastic::action(mean, spread, noise));
        }
    }
    // Also where tanh rounds to 1.
    let ends = Drawn::new(&[30.0, 0.0], 1, || 0.0);
    assert!((ends.densities[0] - (0.581_06 + 58.613_7)).abs() < 1e-3, "{}", ends.densities[0]);
}

#[test]
fn a_temperature_rises_while_entropy_is_lacking() {
    let mut temperature = Temperature::new();
    let mut after = |lacking: f64| {
        (0..10).for_each(|_| temperature.tune(lacking, 0.1));
        temperature.weight()
    };
    let (start, up) = (Temperature::new().weight(), after(0.5));
    assert!((up / start - 1.0_f64.exp()).abs() < 1e-6, "Adam's first steps are its rate");
    assert!((0..9).map(|_| after(-0.5)).last().unwrap() < start);
}
