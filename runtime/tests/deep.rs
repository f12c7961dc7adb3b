//! The deep learner against exact values.
#![cfg(feature = "deep")]

use tltl::augmented::{Labelled, Rewards};
use tltl::compose::{self, Combine, Compose};
use tltl::deep::{
    AsGiven, Checkpoint, Composition, Device, Error, Learned, Learner, Replay, Settings, Skill,
    SumTree,
};
use tltl::env::{Env, ModelEnv, Step};
use tltl::learn::Schedule;
use tltl::model::FiniteModel;
use tltl::network::Features;
use tltl::network::policy::NetworkPolicy;
use tltl::policy::States;
use tltl::product::Product;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::solve::Problem;
use tltl::tltl;
use tltl::{Acceptor, Monitor};

const GAMMA: f64 = 0.9;

/// Six cells in a row, left and right, certain.
#[derive(Clone)]
struct Row;

impl FiniteModel for Row {
    type State = i32;

    fn states(&self) -> usize {
        6
    }

    fn actions(&self) -> usize {
        2
    }

    fn state(&self, s: usize) -> i32 {
        s as i32
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        outcome(if a == 0 { s.saturating_sub(1) } else { (s + 1).min(5) }, 1.0);
    }
}

#[derive(Clone, Copy)]
struct OneHot;

impl Features<i32> for OneHot {
    fn inputs(&self) -> usize {
        6
    }

    fn write(&self, s: &i32, inputs: &mut [f32], _: &mut [f32]) {
        inputs[*s as usize] = 1.0;
    }
}

/// Explores at random, and anneals until values stand still.
fn settings(updates: u64) -> Settings {
    Settings {
        gamma: GAMMA,
        horizon: 40,
        hidden: vec![32],
        batch: 64,
        warmup: 100,
        capacity: 2_000,
        steps: 1,
        steps_per_update: 1,
        advantage_learning: 0.0,
        advantage_penalty: 0.0,
        epsilon: Schedule::Constant(1.0),
        learning_rate: Schedule::Linear { from: 3e-3, to: 1e-5, steps: updates },
        ..Settings::default()
    }
}

/// All values against the optimum of the model, where state and automaton state can meet.
fn assert_optimal(
    task: &dyn Monitor<i32>,
    tolerance: f64,
    mut values: impl FnMut(u32, &i32) -> Vec<f32>,
) {
    let env = ModelEnv::new(Row).unwrap();
    let labelled = Labelled::of_env(&env, task).unwrap();
    let optimum = Problem::new(env.dynamics(), &labelled).optimal_q(&Rewards::default(), GAMMA);
    for q in labelled.live() {
        for s in 0..6 {
            let meets = |from| task.next(from, &(s as i32)).unwrap() == q;
            if !(0..task.states()).any(meets) {
                continue;
            }
            for (value, exact) in values(q, &(s as i32)).iter().zip(optimum.row(q, s)) {
                let error = (f64::from(*value) - exact).abs();
                assert!(error < tolerance, "Q({s}, {q}): {value} for {exact}");
            }
        }
    }
}

#[test]
fn a_chain_is_learned_to_its_exact_values() {
    let task = tltl! { |x: &i32| ({ *x } == 5) T ({ *x } == 0) };
    let mut env = ModelEnv::new(Row).unwrap();
    let skill = Skill::new(&task, OneHot);
    let mut learner = Learner::new(skill, env.actions(), settings(6_000), &Device::flex(), 1);
    learner.train(&mut env, 6_000).unwrap();
    assert_optimal(&task, 1e-2, |q, s| learner.values(q, s).unwrap());
    // The network alone says the same.
    let (network, mut inputs) = (learner.network().unwrap(), [0.0; 6]);
    inputs[3] = 1.0;
    for (a, b) in network.values(1, &inputs, &[]).iter().zip(learner.values(1, &3).unwrap()) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    // And so does the policy that is saved and emitted.
    let actions = vec!["left".into(), "right".into()];
    let states = States::of(&task);
    let text = task.formula().text();
    let policy = NetworkPolicy::new("there_and_back", text, states, actions, network).unwrap();
    for (q, s) in (0..2).flat_map(|q| (0..6).map(move |s| (q, s))) {
        let mut inputs = [0.0; 6];
        inputs[s as usize] = 1.0;
        assert_eq!(policy.act(q, &inputs, &[]), learner.act(q, &s).unwrap());
    }
}

#[test]
fn without_counterfactual_updates_or_normalisation_it_learns_the_same() {
    let task = tltl! { |x: &i32| ({ *x } == 5) T ({ *x } == 0) };
    let mut env = ModelEnv::new(Row).unwrap();
    let plain =
        Settings { counterfactual: false, normalisation: 0.0, priority: 0.0, ..settings(8_000) };
    let skill = Skill::new(&task, OneHot);
    let mut learner = Learner::new(skill, env.actions(), plain, &Device::flex(), 1);
    learner.train(&mut env, 8_000).unwrap();
    let mut right = 0;
    for s in 0..6 {
        right += usize::from(learner.act(0, &s).unwrap() == 1 || s == 5);
        right += usize::from(learner.act(1, &s).unwrap() == 0);
    }
    assert_eq!(right, 12);
}

#[test]
fn a_learner_resumed_goes_on_bit_for_bit() {
    let task = tltl! { |x: &i32| ({ *x } == 5) T ({ *x } == 0) };
    let skill = Skill::new(&task, OneHot);
    let mut env = ModelEnv::new(Row).unwrap();
    let device = Device::flex();
    let mut whole = Learner::new(skill, 2, settings(1_000), &device, 1);
    whole.train(&mut env, 500).unwrap();
    let saved = serde_json::to_string(&whole.checkpoint()).unwrap();
    let checkpoint: Checkpoint<i32> = serde_json::from_str(&saved).unwrap();
    let mut resumed = Learner::resume(skill, checkpoint, &device).unwrap();
    whole.train(&mut env, 1_000).unwrap();
    resumed.train(&mut env, 1_000).unwrap();
    assert_eq!(whole.checkpoint(), resumed.checkpoint());

    let mut broken: serde_json::Value = serde_json::from_str(&saved).unwrap();
    broken["moments"]["second"][0]["bias"].as_array_mut().unwrap().pop();
    let broken: Checkpoint<i32> = serde_json::from_value(broken).unwrap();
    assert!(Learner::resume(skill, broken, &device).is_err(), "moments of another network");
    let other = tltl! { |x: &i32| F ({ *x } == 5) };
    let other = Skill::new(&other, OneHot);
    assert!(Learner::resume(other, whole.checkpoint(), &device).is_err(), "another task's heads");
}

/// All of Algorithm 2, whatever holds the values.
fn carry_out<C: Compose>(composition: &mut C) -> Result<(), C::Error> {
    composition.compensate(1_000)?;
    composition.refine(7_000)
}

#[test]
fn a_composition_reaches_the_optimum_without_a_step() {
    let left = tltl! { |x: &i32| F ({ *x } == 0) };
    let right = tltl! { |x: &i32| F ({ *x } == 5) };
    let device = Device::flex();
    let mut env = ModelEnv::new(Row).unwrap();
    let mut first = Learner::new(Skill::new(&left, OneHot), 2, settings(3_000), &device, 1);
    let mut second = Learner::new(Skill::new(&right, OneHot), 2, settings(3_000), &device, 2);
    first.train(&mut env, 3_000).unwrap();
    second.train(&mut env, 3_000).unwrap();
    let steps = env.steps();
    let product = Product::conjunction(&[&left, &right]);
    let networks = [first.network().unwrap(), second.network().unwrap()];
    let skills = [
        Learned {
            network: &networks[0],
            features: &OneHot,
            task: &left,
            experience: first.replay(),
        },
        Learned {
            network: &networks[1],
            features: &OneHot,
            task: &right,
            experience: second.replay(),
        },
    ];
    let compose = |combine, updates| {
        let settings = settings(updates);
        Composition::new(&product, &skills, AsGiven, combine, settings, &device, 3).unwrap()
    };
    let mut refined = compose(Combine::Sum, 8_000);
    // Step 2 is the sum: where one skill alone is pending, that skill's values.
    let pending = (0..product.states()).find(|&q| product.components(q)[1] == 1).unwrap();
    let sum = refined.values(pending, &3).unwrap();
    assert!((sum[0] - networks[0].values(0, &[0., 0., 0., 1., 0., 0.], &[])[0]).abs() < 1e-5);
    carry_out(&mut refined).unwrap();
    assert_optimal(&product, 2e-2, |q, s| refined.values(q, s).unwrap());
    // Advantage learning moves the other actions away, and leaves the values of states.
    let settings = Settings { advantage_learning: 0.8, ..settings(8_000) };
    let mut wide =
        Composition::new(&product, &skills, AsGiven, Combine::Sum, settings, &device, 3).unwrap();
    carry_out(&mut wide).unwrap();
    let both = (0..product.states()).find(|&q| product.components(q) == [0, 0]).unwrap();
    let values = [&refined, &wide].map(|composition| composition.values(both, &1).unwrap());
    assert!((values[0][0] - values[1][0]).abs() < 4e-2, "{values:?}");
    let [narrow, wider] = values.map(|values| values[0] - values[1]);
    assert!((wider / narrow - 5.0).abs() < 1.0, "{narrow} {wider}");

    // Tables go the same way.
    let labelled = |task: &dyn Monitor<i32>| Labelled::of_env(&env, task).unwrap();
    let (task, tasks) = (labelled(&product), [labelled(&left), labelled(&right)]);
    let rewards = Rewards::default();
    let [one, two] =
        [0, 1].map(|i| Problem::new(env.dynamics(), &tasks[i]).optimal_q(&rewards, GAMMA));
    let skills =
        [compose::Skill { q: &one, task: &tasks[0] }, compose::Skill { q: &two, task: &tasks[1] }];
    let mut tables = compose::Composition::new(&product, &task, &skills).on(
        env.dynamics(),
        rewards,
        GAMMA,
        Combine::Sum,
    );
    carry_out(&mut tables).unwrap();
    let exact = Problem::new(env.dynamics(), &task).optimal_q(&rewards, GAMMA);
    for s in 0..6 {
        let own = [tables.act(both, &(s as usize)).unwrap(), wide.act(both, &s).unwrap()];
        let row = exact.row(both, s as usize);
        // Both ends are as near in the middle of the row, and states at an end have been read.
        let best = (1..5).contains(&s).then(|| row.iter().copied().fold(f64::MIN, f64::max));
        let right = |a: usize| best.is_none_or(|best| best - row[a] < 2e-2);
        assert!(own.into_iter().all(right), "{own:?} of {row:?} at {s}");
    }
    assert_eq!(env.steps(), steps, "no step in the world");
}

#[test]
fn priorities_are_drawn_in_proportion() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut below = |n: u64| (rng.next_u64() % n) as usize;
    let (mut tree, mut naive) = (SumTree::new(100), vec![0.0; 100]);
    for _ in 0..1_000 {
        let (i, weight) = (below(100), below(8) as f64);
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
            replay.push(0, t as u32, 0.0, false, episode * 100 + t);
        }
        if (0..replay.len()).all(|i| replay.steps_from(i) == 0) {
            continue;
        }
        for _ in 0..20 {
            let (place, _) = replay.draw(false, &mut rng);
            let ahead = replay.steps_from(place);
            assert!(ahead > 0, "a last state has no step");
            for n in 0..=ahead {
                let expected = replay.moment(place).state + n as i32;
                assert_eq!(replay.moment(replay.after(place, n)).state, expected);
            }
        }
    }
    let mut copy = Replay::new(40);
    copy.extend(&replay);
    let whole = |replay: &Replay<i32>| {
        let steps = (0..replay.len()).filter(|&i| replay.steps_from(i) > 0);
        let mut steps: Vec<_> =
            steps.map(|i| (replay.moment(i).state, replay.moment(i).action)).collect();
        steps.sort_unstable();
        steps
    };
    assert_eq!(whole(&copy), whole(&replay));
}

/// A world whose reward or state breaks at some step.
struct Broken {
    at: u64,
    steps: u64,
    reward: f64,
}

impl Env for Broken {
    type State = i32;

    fn actions(&self) -> usize {
        2
    }

    fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> i32 {
        0
    }

    fn step<R: Rng + ?Sized>(&mut self, _: usize, _: &mut R) -> Step<i32> {
        self.steps += 1;
        let broken = self.steps > self.at;
        Step { reward: if broken { self.reward } else { 0.0 }, ..Step::to(i32::from(broken)) }
    }
}

/// What is no number at state 1.
struct Bad;

impl Features<i32> for Bad {
    fn inputs(&self) -> usize {
        2
    }

    fn write(&self, s: &i32, inputs: &mut [f32], _: &mut [f32]) {
        inputs[1] = if *s == 1 { f32::NAN } else { 1.0 };
    }
}

#[test]
fn what_is_not_finite_is_named_at_once() {
    let task = tltl! { |x: &i32| F ({ *x } == 5) };
    let device = Device::flex();
    let mut settings = settings(1_000);
    let mut env = Broken { at: 200, steps: 0, reward: f64::NAN };
    let mut learner = Learner::new(Skill::new(&task, OneHot), 2, settings.clone(), &device, 1);
    assert_eq!(learner.train(&mut env, 1_000), Err(Error::Reward(201)));

    let mut env = Broken { at: 200, steps: 0, reward: 0.0 };
    let mut learner = Learner::new(Skill::new(&task, Bad), 2, settings.clone(), &device, 1);
    assert_eq!(learner.train(&mut env, 1_000), Err(Error::Feature(1)));

    settings.learning_rate = Schedule::Constant(1e300);
    let mut env = ModelEnv::new(Row).unwrap();
    let mut learner = Learner::new(Skill::new(&task, OneHot), 2, settings, &device, 1);
    let error = learner.train(&mut env, 2_000).unwrap_err();
    assert!(matches!(error, Error::Loss(_)), "{error}");
    assert!(learner.network().is_err(), "weights that are no numbers are no network");
}
