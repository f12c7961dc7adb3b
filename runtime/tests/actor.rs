//! The actor-critic learner against what is known exactly.
#![cfg(feature = "deep")]

use tltl::deep::actor::{Checkpoint, Learner, Settings};
use tltl::deep::{AsGiven, Device, Error, Skill};
use tltl::env::{ContinuousEnv, Step};
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::prelude::{Monitor, Rewards, tltl};
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

/// Two skills of a cart with so many motors; nothing was learned yet.
fn cart(motors: usize, seed: u64) -> Learner<f32, impl Monitor<f32> + Clone, Place, AsGiven> {
    let task = tltl! { |x: &f32| F ({ *x } > 0.5 && F { *x } < -0.5) };
    let settings =
        Settings::default().with_hidden([4]).and_then(|settings| settings.with_warmup(50));
    let world = Cart { motors, place: 0.0, broken: false };
    let skill = Skill::new(task, Place);
    Learner::new(skill, &world, settings.unwrap(), &Device::flex(), seed)
}

/// All motors push along one line; a broken sensor says so once.
struct Cart {
    motors: usize,
    place: f32,
    broken: bool,
}

impl ContinuousEnv for Cart {
    type State = f32;

    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-0.3, 0.9); self.motors]
    }

    fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 {
        self.place = 0.0;
        self.place
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
        assert!(action.iter().all(|a| (-0.3..=0.9).contains(a)), "{action:?}");
        self.place = (self.place + action.iter().sum::<f32>()).clamp(-1.0, 1.0);
        Step::to(if std::mem::take(&mut self.broken) { f32::INFINITY } else { self.place })
    }
}

fn trained(motors: usize) -> Learner<f32, impl Monitor<f32> + Clone, Place, AsGiven> {
    let mut learner = cart(motors, 1);
    learner.train(&mut Cart { motors, place: 0.0, broken: false }, 100).unwrap();
    learner
}

#[test]
fn what_was_seen_with_other_motors_is_not_remembered() {
    let (two, mut one) = (trained(2), trained(1));
    let before = one.checkpoint();
    let error = one.remember(&two).unwrap_err();
    assert!(error.to_string().contains("actions within [(-0.3, 0.9), (-0.3, 0.9)]"), "{error}");
    assert_eq!(one.checkpoint(), before);
    let (mut again, twin) = (cart(2, 2), trained(2));
    again.remember(&twin).unwrap();
    again.rehearse(10).unwrap();
    assert_eq!((again.steps(), again.updates()), (0, 10));
}

#[test]
fn a_sensor_that_fails_once_does_no_lasting_harm() {
    let mut learner = trained(1);
    let mut world = Cart { motors: 1, place: 0.0, broken: true };
    let steps = learner.steps();
    assert_eq!(learner.train(&mut world, steps + 20), Err(Error::Feature(0)));
    learner.train(&mut world, steps + 200).unwrap();
    assert!(learner.act(0, &0.0).unwrap()[0].is_finite());
}

#[test]
fn an_actor_that_has_diverged_says_so() {
    let settings = Settings::default()
        .with_hidden([4])
        .and_then(|settings| settings.with_warmup(50))
        .and_then(|settings| settings.with_actor_rate(Schedule::constant(1e39)?));
    let task = tltl! { |x: &f32| F ({ *x } > 9) };
    let mut world = Cart { motors: 1, place: 0.0, broken: false };
    let skill = Skill::new(task, Place);
    let mut learner = Learner::new(skill, &world, settings.unwrap(), &Device::flex(), 1);
    let error = learner.train(&mut world, 2_000).unwrap_err();
    assert!(matches!(error, Error::Loss(_)), "{error}");
}

#[test]
fn replays_that_were_edited_are_refused() {
    let learner = trained(1);
    let text = serde_json::to_value(learner.checkpoint()).unwrap();
    let load = |value: serde_json::Value| serde_json::from_value::<Checkpoint<f32>>(value);
    assert_eq!(load(text.clone()).unwrap(), learner.checkpoint());
    let edits: [(&str, serde_json::Value); 9] = [
        ("head", 7.into()),
        ("head", 1_000_000.into()),
        ("capacity", 0.into()),
        ("capacity", 5.into()),
        ("largest", (-1.0).into()),
        ("largest", 0.0.into()),
        ("age", 3.into()),
        ("moments", serde_json::json!([])),
        ("priorities", serde_json::json!({"sums": [], "leaves": 1})),
    ];
    for (field, value) in edits {
        let mut text = text.clone();
        text["replay"][field] = value;
        let error = load(text).unwrap_err().to_string();
        assert!(error.contains("a replay whose parts"), "{field}: {error}");
    }
    let mut short = text.clone();
    short["replay"]["moments"][3]["action"] = serde_json::json!([]);
    let short = load(short).unwrap();
    let world = Cart { motors: 1, place: 0.0, broken: false };
    let skill = Skill::new(learner.skill().task.clone(), Place);
    let error = Learner::resume(skill, &world, short, &Device::flex()).unwrap_err();
    assert!(error.to_string().contains("actions of 1 numbers"), "{error}");
}

#[test]
fn starts_that_are_decided_push_nothing_out() {
    let task = tltl! { |x: &f32| F ({ *x } < 0.5) };
    let world = Cart { motors: 1, place: 0.0, broken: false };
    let settings = Settings::default().with_capacity(50).unwrap();
    let mut learner = Learner::new(Skill::new(task, Place), &world, settings, &Device::flex(), 1);
    learner.train(&mut Cart { motors: 1, place: 0.0, broken: false }, 100).unwrap();
    assert_eq!((learner.steps(), learner.replay().len()), (0, 0));
}
