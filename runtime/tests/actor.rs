//! The actor-critic learner against what is known exactly.
#![cfg(feature = "deep")]

use tltl::deep::actor::{Learner, Settings};
use tltl::deep::{Device, Skill};
use tltl::env::{ContinuousEnv, Step};
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::prelude::{Rewards, tltl};
use tltl::rand::{Rng, RngExt as _, SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::reward::Mode;

/// x' = x + u/2, and each step costs x² + u²/10: what control calls a linear-quadratic regulator.
struct Regulator(f32);

const GAMMA: f64 = 0.9;

impl ContinuousEnv for Regulator {
    type State = f32;

    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-2.0, 2.0)]
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> f32 {
        self.0 = 2.0 * rng.random::<f32>() - 1.0;
        self.0
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
        let cost = f64::from(self.0.powi(2) + 0.1 * action[0].powi(2));
        self.0 = (self.0 + 0.5 * action[0]).clamp(-2.0, 2.0);
        Step { reward: -cost, ..Step::to(self.0) }
    }
}

struct Place;

impl Features<f32> for Place {
    fn inputs(&self) -> usize {
        1
    }

    fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) {
        inputs[0] = *s;
    }
}

/// The gain K of the best control u = -K x, and P, where P x² is what it costs: the fixed point of the
/// discounted Riccati equation.
fn riccati() -> (f64, f64) {
    let (a, b, cost, effort) = (1.0, 0.5, 1.0, 0.1);
    let (mut gain, mut p) = (0.0, 0.0);
    for _ in 0..1_000 {
        gain = GAMMA * a * b * p / (effort + GAMMA * b * b * p);
        p = cost + effort * gain * gain + GAMMA * p * (a - b * gain) * (a - b * gain);
    }
    (gain, p)
}

#[test]
fn a_linear_quadratic_problem_is_solved_to_its_optimum() {
    const STEPS: u64 = 15_000;
    let (gain, p) = riccati();
    let never = tltl! { |x: &f32| F ({ *x } > 9) };
    let falling = Schedule::linear(1e-3, 1e-5, STEPS).unwrap();
    let rewards =
        Rewards::of(Mode::Acceptance).with_gamma(GAMMA).unwrap().with_environment(1.0).unwrap();
    for settings in [Settings::default(), Settings::ddpg()] {
        let settings = settings
            .with_hidden([32, 32])
            .and_then(|settings| settings.with_batch(64)?.with_horizon(20)?.with_target_rate(0.02))
            .and_then(|settings| settings.with_actor_rate(falling)?.with_critic_rate(falling))
            .and_then(|settings| settings.with_noise(Schedule::constant(0.2)?))
            .unwrap()
            .with_rewards(rewards);
        let mut env = Regulator(0.0);
        let skill = Skill::new(&never, Place);
        let mut learner = Learner::new(skill, &env, settings, &Device::flex(), 3);
        learner.train(&mut env, STEPS).unwrap();

        let places: Vec<f32> = (-10..=10).map(|x| x as f32 / 10.0).collect();
        let actions: Vec<f32> = places.iter().map(|x| learner.act(0, x).unwrap()[0]).collect();
        // The slope of the line that fits the actions best is minus the gain.
        let [mut products, mut squares] = [0.0; 2];
        for (&x, &u) in places.iter().zip(&actions) {
            products += f64::from(x * u);
            squares += f64::from(x * x);
        }
        let slope = -products / squares;
        assert!((slope / gain - 1.0).abs() < 0.1, "{slope}, and {gain} is best");

        // What it costs from all places together, by playing it.
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(0);
        let mut cost = |mut s: f32| {
            let (mut env, mut total, mut weight) = (Regulator(s), 0.0, 1.0);
            for _ in 0..200 {
                let step = env.step(&learner.act(0, &s).unwrap(), &mut rng);
                (s, total, weight) = (step.state, total - weight * step.reward, weight * GAMMA);
            }
            total
        };
        let total: f64 = places.iter().map(|&x| cost(x)).sum();
        let optimum: f64 = places.iter().map(|&x| p * f64::from(x).powi(2)).sum();
        assert!(total > 0.999 * optimum, "nothing is better than the optimum");
        assert!(total < 1.2 * optimum, "{total}, and {optimum} is best");
        println!("slope {slope} of {gain}, cost {total} of {optimum}");
    }
}
