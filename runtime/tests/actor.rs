//! The actor-critic learner against what is known exactly.
#![cfg(feature = "deep")]

use tltl::compose::Compose;
use tltl::deep::actor::{Checkpoint, Composition, Learner, Settings};
use tltl::deep::{AsGiven, Device, Error, Skill};
use tltl::env::{ContinuousEnv, Step};
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::prelude::{Combine, Monitor, Product, Rewards, tltl};
use tltl::product::Operand;
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
    for settings in [Settings::td3(), Settings::ddpg(), Settings::sac()] {
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
    let settings = Settings::td3().with_hidden([4]).and_then(|settings| settings.with_warmup(50));
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
fn a_stochastic_actor_goes_on_from_its_checkpoint_and_its_policy_draws_nothing() {
    let (device, mut world) = (Device::flex(), Anywhere::default());
    let task = tltl! { |x: &f32| F ({ *x } > 0.5 && F { *x } < -0.5) };
    let settings = Settings::sac().with_hidden([8, 8]).and_then(|s| s.with_warmup(50)).unwrap();
    let mut learner = Learner::new(Skill::new(&task, Place), &world, settings, &device, 1);
    learner.train(&mut world, 200).unwrap();
    let text = serde_json::to_string(&learner.checkpoint()).unwrap();
    let load = |text: &str| serde_json::from_str::<Checkpoint<f32>>(text).unwrap();
    let resume = |saved| Learner::resume(Skill::new(&task, Place), &world, saved, &device);
    let mut resumed = resume(load(&text)).unwrap();
    learner.train(&mut Anywhere::default(), 400).unwrap();
    resumed.train(&mut Anywhere::default(), 400).unwrap();
    assert_eq!(learner.checkpoint(), resumed.checkpoint());
    let policy = learner.policy().unwrap();
    for x in [-0.7, 0.0, 0.3] {
        let (here, there) = (learner.act(1, &x).unwrap(), policy.control(1, &[x], &[]).unwrap());
        assert!((here[0] - there[0]).abs() < 1e-6, "{here:?} {there:?}");
        assert_eq!(learner.act(1, &x).unwrap(), here, "nothing is drawn");
    }
    // A temperature belongs to a stochastic actor, and to no other.
    let mut without: serde_json::Value = serde_json::from_str(&text).unwrap();
    without["temperature"] = serde_json::Value::Null;
    assert!(resume(load(&without.to_string())).is_err());
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

/// A cart with one motor whose episodes start anywhere.
struct Anywhere(Cart);

impl Default for Anywhere {
    fn default() -> Self {
        Self(Cart { motors: 1, place: 0.0, broken: false })
    }
}

impl ContinuousEnv for Anywhere {
    type State = f32;

    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-0.2, 0.2)]
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> f32 {
        self.0.place = 1.4 * rng.random::<f32>() - 0.7;
        self.0.place
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<f32> {
        self.0.step(action, rng)
    }
}

/// The steps that a controller takes for `task` from `x`, at most 30.
fn steps_from<M: Monitor<f32>>(task: &M, x: f32, mut act: impl FnMut(u32, &f32) -> f32) -> u32 {
    let (mut x, mut q) = (x, task.next(0, &x).unwrap());
    let mut steps = 0;
    while !task.is_accepting(q) && steps < 30 {
        x = (x + act(q, &x)).clamp(-1.0, 1.0);
        (q, steps) = (task.next(q, &x).unwrap(), steps + 1);
    }
    steps
}

#[test]
fn actors_compose_without_a_step() {
    let left = tltl! { |x: &f32| F ({ *x } < -0.8) };
    let right = tltl! { |x: &f32| F ({ *x } > 0.8) };
    let (device, mut world) = (Device::flex(), Anywhere::default());
    let settings = Settings::td3()
        .with_hidden([32, 32])
        .and_then(|settings| settings.with_warmup(300)?.with_horizon(30)?.with_robustness(0.5))
        .and_then(|settings| settings.with_batch(64))
        .and_then(|settings| settings.with_noise(Schedule::constant(0.5)?))
        .unwrap()
        .with_rewards(Rewards::of(Mode::Shaped).with_gamma(GAMMA).unwrap());
    let mut one = Learner::new(Skill::new(&left, Place), &world, settings.clone(), &device, 1);
    let mut two = Learner::new(Skill::new(&right, Place), &world, settings.clone(), &device, 2);
    one.train(&mut world, 1_500).unwrap();
    two.train(&mut world, 1_500).unwrap();
    let both = Product::conjunction(&[&left, &right]);
    let skills = || [one.learned().unwrap(), two.learned().unwrap()];
    let compose = |combine| {
        let (skill, settings) = (Skill::new(&both, Place), settings.clone());
        Composition::new(skill, &skills(), combine, settings, &device, 3).unwrap()
    };
    for combine in [Combine::Sum, Combine::NormalisedSum, Combine::Max] {
        let mut composed = compose(combine);
        composed.fit(400).unwrap();
        // Beside an end that end comes first.
        let first = |x| composed.act(0, &x).unwrap()[0];
        assert!(first(-0.5) < -0.05 && first(0.5) > 0.05, "{combine:?}");
        for x in [-0.5, 0.5] {
            let steps = steps_from(&both, x, |q, x| composed.act(q, x).unwrap()[0]);
            assert!(steps <= 14, "{combine:?}: {steps} steps from {x}, and 11 are the fewest");
        }
    }
    let (mut composed, mut again) = (compose(Combine::Sum), compose(Combine::Sum));
    let check = |composed: &Composition<'_, _, _, _>| {
        // Not in the middle: an actor is continuous, and hesitates there.
        for x in [-0.6, 0.6] {
            let steps = steps_from(&both, x, |q, x| composed.act(q, x).unwrap()[0]);
            assert!(steps < 30, "not in {steps} steps from {x}, and 11 are the fewest");
        }
    };
    composed.compensate(2_000).unwrap();
    check(&composed);
    composed.refine(2_000).unwrap();
    check(&composed);
    again.compensate(2_000).unwrap();
    again.refine(2_000).unwrap();
    for x in [-0.5, 0.0, 0.4] {
        assert_eq!(composed.value(0, &x), again.value(0, &x), "the same seed, the same numbers");
    }
    assert_eq!(composed.updates(), 4_000);
    let policy = composed.policy().unwrap();
    let steps: Vec<u64> = policy.document().training.iter().map(|skill| skill.steps).collect();
    assert_eq!(steps, [one.steps(), two.steps(), 0]);
}

#[test]
fn skills_that_do_not_fit_are_not_composed() {
    let (one, two) = (trained(1), trained(2));
    let compose = |product: &Product<'_, f32>, skills: &[_]| {
        let (skill, settings) = (Skill::new(product, Place), one.settings().clone());
        let made = Composition::new(skill, skills, Combine::Sum, settings, &Device::flex(), 1);
        made.map(|_| ()).unwrap_err().to_string()
    };
    let tasks = [&one.skill().task, &one.skill().task];
    let operands: [Operand<'_, f32>; 2] = [tasks[0], tasks[1]];
    let both = Product::conjunction(&operands);
    let learned = || one.learned().unwrap();
    let error = compose(&both, &[learned()]);
    assert!(error.contains("1 tasks") && error.contains("2 tasks"), "{error}");
    let error = compose(&both, &[learned(), two.learned().unwrap()]);
    assert!(error.contains("1 actions") && error.contains("2 actions"), "{error}");
    let other = tltl! { |x: &f32| F ({ *x } > 0.5) };
    let skill = Skill::new(other.clone(), Place);
    let mut third =
        Learner::new(skill, &Anywhere::default(), one.settings().clone(), &Device::flex(), 1);
    third.train(&mut Anywhere::default(), 60).unwrap();
    let error = compose(&both, &[learned(), third.learned().unwrap()]);
    assert!(error.contains("1 live automaton states") && error.contains("2 live"), "{error}");
    let first = tltl! { |x: &f32| F ({ *x } > 0.5 && F { *x } < -0.5) };
    let mixed = Product::conjunction(&[&first, &other]);
    let error = compose(&mixed, &[learned(), third.learned().unwrap()]);
    assert!(error.contains("[(-0.2, 0.2)]") && error.contains("[(-0.3, 0.9)]"), "{error}");
}

#[test]
#[should_panic(expected = "skills that have seen something")]
fn skills_that_have_seen_nothing_are_not_composed() {
    let learner = cart(1, 1);
    let operands: [Operand<'_, f32>; 1] = [&learner.skill().task];
    let product = Product::conjunction(&operands);
    let (skills, settings) = ([learner.learned().unwrap()], learner.settings().clone());
    let _ = Composition::new(
        Skill::new(&product, Place),
        &skills,
        Combine::Sum,
        settings,
        &Device::flex(),
        1,
    );
}
