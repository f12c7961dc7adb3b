//! The deep learner against exact values.
#![cfg(feature = "deep")]

use core::fmt::Debug;

use tltl::OutOfRange;
use tltl::compose::{self, Compose};
use tltl::deep::{
    AsGiven, Checkpoint, Composition, Device, Error, Joint, Learned, Learner, Replay, Settings,
    Skill,
};
use tltl::learn::{Schedule, Updates};
use tltl::network::Features;
use tltl::prelude::{
    Acceptor, Combine, Env, FiniteModel, Labelled, ModelEnv, Monitor, Problem, Product, Rewards,
    Step, tltl,
};
use tltl::rand::Rng;

/// The paper's reward, γ 0.9.
fn rewards() -> Rewards {
    Rewards::progress().with_gamma(0.9).unwrap()
}

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
    let settings = || -> Result<Settings, OutOfRange> {
        Settings::default()
            .with_rewards(rewards())
            .with_horizon(40)?
            .with_hidden([32])?
            .with_batch(64)?
            .with_warmup(100)?
            .with_capacity(2_000)?
            .with_steps(1)?
            .with_steps_per_update(1)?
            .with_advantage_learning(0.0)?
            .with_advantage_penalty(0.0)?
            .with_epsilon(Schedule::constant(1.0)?)?
            .with_learning_rate(Schedule::linear(3e-3, 1e-5, updates)?)
    };
    settings().unwrap()
}

/// All values against the optimum of the model, where state and automaton state can meet.
fn assert_optimal(
    task: &dyn Monitor<i32>,
    tolerance: f64,
    mut values: impl FnMut(u32, &i32) -> Vec<f32>,
) {
    let env = ModelEnv::new(Row).unwrap();
    let labelled = Labelled::of_env(&env, task).unwrap();
    let optimum = Problem::new(env.dynamics(), &labelled).unwrap().optimal_q(&rewards());
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
    let mut learner = Learner::new(skill, &env, settings(6_000), &Device::flex(), 1);
    learner.train(&mut env, 6_000).unwrap();
    assert_optimal(&task, 1e-2, |q, s| learner.values(q, s).unwrap());
    // The network alone says the same.
    let (network, mut inputs) = (learner.network().unwrap(), [0.0; 6]);
    inputs[3] = 1.0;
    for (a, b) in network.values(1, &inputs, &[]).iter().zip(learner.values(1, &3).unwrap()) {
        assert!((a - b).abs() < 1e-5, "{a} {b}");
    }
    // And so does the policy that is saved and emitted.
    let policy = learner.policy().unwrap();
    assert_eq!(
        (&*policy.document().task, policy.document().training[0].steps),
        (task.name(), learner.steps())
    );
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
    let plain = settings(8_000).with_updates(Updates::Current);
    let plain = plain.with_normalisation(0.0).unwrap().with_priority(0.0).unwrap();
    let skill = Skill::new(&task, OneHot);
    let mut learner = Learner::new(skill, &env, plain, &Device::flex(), 1);
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
    let mut whole = Learner::new(skill, &env, settings(1_000), &device, 1);
    whole.train(&mut env, 500).unwrap();
    let saved = serde_json::to_string(&whole.checkpoint()).unwrap();
    let checkpoint: Checkpoint<i32> = serde_json::from_str(&saved).unwrap();
    let mut resumed = Learner::resume(skill, &env, checkpoint, &device).unwrap();
    whole.train(&mut env, 1_000).unwrap();
    resumed.train(&mut env, 1_000).unwrap();
    assert_eq!(whole.checkpoint(), resumed.checkpoint());

    let mut broken: serde_json::Value = serde_json::from_str(&saved).unwrap();
    broken["moments"]["second"][0]["bias"].as_array_mut().unwrap().pop();
    let broken: Checkpoint<i32> = serde_json::from_value(broken).unwrap();
    assert!(Learner::resume(skill, &env, broken, &device).is_err(), "moments of another network");
    let once = tltl! { |x: &i32| F ({ *x } == 5) };
    let other = Skill::new(&once, OneHot);
    let error = Learner::resume(other, &env, whole.checkpoint(), &device).unwrap_err().to_string();
    for named in ["a checkpoint of `({* x} == 5) T", "2 heads", "does not fit `F ({", "1 heads"] {
        assert!(error.contains(named), "{error}");
    }
    // The same heads, but another task.
    let nearer = tltl! { |x: &i32| ({ *x } == 4) T ({ *x } == 0) };
    let other = Skill::new(&nearer, OneHot);
    let error = Learner::resume(other, &env, whole.checkpoint(), &device).unwrap_err().to_string();
    assert!(error.contains("== 4"), "{error}");
}

/// Steps that each start takes to satisfy `task`, acting greedily; `None` if it takes more than 30.
fn greedy_steps(
    task: &dyn Monitor<i32>,
    mut act: impl FnMut(u32, &i32) -> usize,
) -> [Option<usize>; 6] {
    [0, 1, 2, 3, 4, 5].map(|start| {
        let (mut s, mut q) = (start, task.next(0, &start).unwrap());
        let mut steps = 0;
        while !task.is_accepting(q) && steps < 30 {
            s = [(s - 1).max(0), (s + 1).min(5)][act(q, &s)];
            q = task.next(q, &s).unwrap();
            steps += 1;
        }
        task.is_accepting(q).then_some(steps)
    })
}

/// Stay in the last cell for three instants: its automaton has a way back, which `Progress` pays for.
#[test]
fn what_pays_for_coming_again_is_refused_and_not_the_default() {
    let last = |x: &i32| if *x == 5 { 1.0 } else { -1.0 };
    let task = tltl! { F (last && X last && X X last) };
    let mut env = ModelEnv::new(Row).unwrap();
    // What is optimal for `Progress` goes back and forth beside the last cell for ever.
    let labelled = Labelled::of_env(&env, &task).unwrap();
    let problem = Problem::new(env.dynamics(), &labelled).unwrap();
    let optimum = problem.optimal_q(&rewards());
    let best = greedy_steps(&task, |q, s| {
        usize::from(optimum.row(q, *s as usize)[1] > optimum.row(q, *s as usize)[0])
    });
    assert_eq!(best, [None; 6]);

    let device = Device::flex();
    let paid = settings(1_000);
    let mut learner = Learner::new(Skill::new(&task, OneHot), &env, paid.clone(), &device, 1);
    let error = learner.train(&mut env, 1_000).unwrap_err();
    assert_eq!(error, Error::WayBack(task.name().to_string()));
    assert!(error.to_string().contains("has a way back"), "{error}");
    assert_eq!(learner.steps(), 0);

    for seed in 0..5 {
        let shaped = paid.clone().with_rewards(Settings::default().rewards());
        let mut learner = Learner::new(Skill::new(&task, OneHot), &env, shaped, &device, seed);
        learner.train(&mut env, 1_500).unwrap();
        let steps = greedy_steps(&task, |q, s| learner.act(q, s).unwrap());
        assert_eq!(steps, [7, 6, 5, 4, 3, 2].map(Some), "seed {seed}");
    }
}

#[test]
fn a_composition_whose_product_has_a_way_back_is_refused() {
    let last = |x: &i32| if *x == 5 { 1.0 } else { -1.0 };
    let (first, stay) =
        (tltl! { |x: &i32| F ({ *x } == 0) }, tltl! { F (last && X last && X X last) });
    let (mut env, device) = (ModelEnv::new(Row).unwrap(), Device::flex());
    let shaped = settings(200).with_rewards(Settings::default().rewards());
    let mut one = Learner::new(Skill::new(&first, OneHot), &env, shaped.clone(), &device, 1);
    let mut two = Learner::new(Skill::new(&stay, OneHot), &env, shaped.clone(), &device, 2);
    one.train(&mut env, 200).unwrap();
    two.train(&mut env, 200).unwrap();
    let product = Product::conjunction(&[&first, &stay]);
    let skills = [one.learned().unwrap(), two.learned().unwrap()];
    let compose =
        |settings| Composition::new(&product, &skills, AsGiven, Combine::Sum, settings, &device, 3);
    assert!(compose(shaped).is_ok());
    let error = compose(settings(200)).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::WayBack(_)), "{error}");
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
    let mut first = Learner::new(Skill::new(&left, OneHot), &env, settings(3_000), &device, 1);
    let mut second = Learner::new(Skill::new(&right, OneHot), &env, settings(3_000), &device, 2);
    first.train(&mut env, 3_000).unwrap();
    second.train(&mut env, 3_000).unwrap();
    let steps = env.steps();
    let product = Product::conjunction(&[&left, &right]);
    let skills = [first.learned().unwrap(), second.learned().unwrap()];
    let compose = |combine, updates| {
        let settings = settings(updates);
        Composition::new(&product, &skills, AsGiven, combine, settings, &device, 3).unwrap()
    };
    let mut refined = compose(Combine::Sum, 8_000);
    // Steps 3–5 are the values of the sum's policy in the product, as those of tables are.
    let mut compensated = compose(Combine::Sum, 3_000);
    compensated.compensate(3_000).unwrap();
    let skill = |task: &dyn Monitor<i32>| {
        let task = Labelled::of_env(&env, task).unwrap();
        Problem::new(env.dynamics(), &task).unwrap().optimal_q(&rewards())
    };
    let (one, two, task) = (skill(&left), skill(&right), Labelled::of_env(&env, &product).unwrap());
    let tables = compose::Composition::new(&product, &task, &[&one, &two], rewards()).unwrap();
    let exact = tables.compensated(env.dynamics()).unwrap();
    let both = (0..product.states()).find(|&q| product.components(q) == [0, 0]).unwrap();
    // States at an end have been read, and are met by no step.
    for s in 1..5 {
        for (own, exact) in
            compensated.values(both, &s).unwrap().iter().zip(exact.row(both, s as usize))
        {
            assert!((f64::from(*own) - exact).abs() < 4e-2, "{own} {exact} at {s}");
        }
    }
    // Step 2 is the sum: where one skill alone is pending, that skill's values.
    let pending = (0..product.states()).find(|&q| product.components(q)[1] == 1).unwrap();
    let sum = refined.values(pending, &3).unwrap();
    assert!((sum[0] - skills[0].network.values(0, &[0., 0., 0., 1., 0., 0.], &[])[0]).abs() < 1e-5);
    carry_out(&mut refined).unwrap();
    assert_optimal(&product, 2e-2, |q, s| refined.values(q, s).unwrap());
    // Advantage learning moves the other actions away, and leaves the values of states.
    let settings = settings(8_000).with_advantage_learning(0.8).unwrap();
    let mut wide =
        Composition::new(&product, &skills, AsGiven, Combine::Sum, settings, &device, 3).unwrap();
    carry_out(&mut wide).unwrap();
    let both = (0..product.states()).find(|&q| product.components(q) == [0, 0]).unwrap();
    let values = [&refined, &wide].map(|composition| composition.values(both, &1).unwrap());
    assert!((values[0][0] - values[1][0]).abs() < 4e-2, "{values:?}");
    let [narrow, wider] = values.map(|values| values[0] - values[1]);
    assert!((wider / narrow - 5.0).abs() < 1.0, "{narrow} {wider}");

    // Tables go the same way.
    let problem = |task: &dyn Monitor<i32>| {
        Problem::new(env.dynamics(), &Labelled::of_env(&env, task).unwrap()).unwrap()
    };
    let [one, two] =
        [&left as &dyn Monitor<i32>, &right].map(|task| problem(task).optimal_q(&rewards()));
    let problem = problem(&product);
    let tables = compose::Composition::new(&product, problem.task(), &[&one, &two], rewards());
    let mut tables = tables.unwrap().on(env.dynamics(), Combine::Sum).unwrap();
    carry_out(&mut tables).unwrap();
    let exact = problem.optimal_q(&rewards());
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
fn values_are_printed_sent_and_shared() {
    fn is_shared<T: Debug + Send + Sync>() {}
    type Task<'a> = &'a (dyn Monitor<i32> + Sync);
    is_shared::<Learner<i32, Task<'_>, OneHot, AsGiven>>();
    is_shared::<(Checkpoint<i32>, Replay<i32>, Settings, Error)>();
    is_shared::<(Learned<'_, i32>, Joint<'_, i32>, Composition<'_, i32, AsGiven>)>();
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
    let settings = settings(1_000);
    let mut env = Broken { at: 200, steps: 0, reward: f64::NAN };
    let mut learner = Learner::new(Skill::new(&task, OneHot), &env, settings.clone(), &device, 1);
    assert_eq!(learner.train(&mut env, 1_000), Err(Error::Reward(201)));

    let mut env = Broken { at: 200, steps: 0, reward: 0.0 };
    let mut learner = Learner::new(Skill::new(&task, Bad), &env, settings.clone(), &device, 1);
    assert_eq!(learner.train(&mut env, 1_000), Err(Error::Feature(1)));

    // A greedy action cannot be chosen where the network sees no number: no step is taken there.
    let greedy = settings.clone().with_epsilon(Schedule::constant(0.0).unwrap()).unwrap();
    let mut env = Broken { at: 20, steps: 0, reward: 0.0 };
    let mut learner = Learner::new(Skill::new(&task, Bad), &env, greedy, &device, 1);
    assert_eq!(learner.train(&mut env, 1_000), Err(Error::Feature(1)));
    assert_eq!((env.steps, learner.steps()), (21, 21), "the step into that state is the last one");

    let wild = settings.with_learning_rate(Schedule::constant(1e300).unwrap()).unwrap();
    let mut env = ModelEnv::new(Row).unwrap();
    let mut learner = Learner::new(Skill::new(&task, OneHot), &env, wild, &device, 1);
    let error = learner.train(&mut env, 2_000).unwrap_err();
    assert!(matches!(error, Error::Loss(_)), "{error}");
    assert!(learner.network().is_err(), "weights that are no numbers are no network");
}
