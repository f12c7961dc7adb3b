//! The loop of episodes, with an agent whose states are not numbered.

mod world;

use std::collections::BTreeMap;

use tltl::augmented::Augmented;
use tltl::learn::episode::{self, Agent, Elapsed, Monitored, Transition};
use tltl::learn::{Memory, TrainError};
use tltl::prelude::*;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::{Mode, Rewards};
use world::{A, B, C, Cell, PAPER, avoid, both, on_paper};

/// The paper's recipe over cells as they are.
#[derive(Default)]
struct Explorer {
    values: BTreeMap<(u32, i32, i32), [f64; 5]>,
    starts: u64,
}

impl Explorer {
    fn row(&self, q: u32, s: &Cell) -> [f64; 5] {
        self.values.get(&(q, s.x, s.y)).copied().unwrap_or_default()
    }
}

impl Agent for Explorer {
    type State = Cell;
    type Error = tltl::task::Error;

    fn start(&mut self, _: &Cell) {
        self.starts += 1;
    }

    fn act<R: Rng + ?Sized>(
        &mut self,
        _: u32,
        _: &Cell,
        _: u64,
        rng: &mut R,
    ) -> Result<usize, Self::Error> {
        Ok(((u64::from(rng.next_u32()) * 5) >> 32) as usize)
    }

    fn learn<W: Monitored<State = Cell, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        world: &W,
        transition: &Transition<'_, Cell>,
        _: &mut R,
    ) -> Result<(), Self::Error> {
        let Transition { q, s, action, step, read } = *transition;
        assert_eq!(world.read(q, step).map_err(Into::into)?, read, "it can be read again");
        let row = self.row(read.to, &step.state);
        let rest = if read.over { 0.0 } else { row.into_iter().fold(f64::NEG_INFINITY, f64::max) };
        let target = read.reward + 0.95 * rest;
        let row = self.values.entry((q, s.x, s.y)).or_default();
        row[action] += 0.1 * (target - row[action]);
        Ok(())
    }
}

/// States by value or by number: same seed, same values.
#[test]
fn cells_and_numbers_learn_alike() {
    for (formula, steps) in [(both(A, B), 20_000), (avoid(C, A), 20_000)] {
        let env = || ModelEnv::new(PAPER).unwrap();
        let task = on_paper(&formula);
        let mut learner = Learner::new(&task, Settings::paper(), 3);
        learner.train(&mut env(), steps).unwrap();

        let mut world = Augmented::new(env(), formula, Rewards::progress());
        let (mut agent, mut elapsed) = (Explorer::default(), Elapsed::default());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        for total in [steps / 3, steps] {
            episode::run(&mut world, &mut agent, &mut elapsed, 200, total, &mut rng).unwrap();
        }
        assert_eq!((elapsed.steps, elapsed.episodes), (learner.steps(), learner.episodes()));
        assert_eq!(elapsed.episodes, agent.starts);
        for q in task.live() {
            for s in 0..task.states() {
                let cell = tltl::model::FiniteModel::state(&PAPER, s);
                assert_eq!(agent.row(q, &cell), learner.table().row(q, s), "q {q}, cell {cell:?}");
            }
        }
    }
}

/// Gives up after some actions.
struct Quitter(u64);

#[derive(Debug, PartialEq)]
struct Quits;

impl From<tltl::task::Error> for Quits {
    fn from(error: tltl::task::Error) -> Self {
        panic!("{error}")
    }
}

impl Agent for Quitter {
    type State = Cell;
    type Error = Quits;

    fn act<R: Rng + ?Sized>(
        &mut self,
        _: u32,
        _: &Cell,
        steps: u64,
        _: &mut R,
    ) -> Result<usize, Quits> {
        if steps < self.0 { Ok(0) } else { Err(Quits) }
    }

    fn learn<W: Monitored<State = Cell, Error: Into<Quits>>, R: Rng + ?Sized>(
        &mut self,
        _: &W,
        _: &Transition<'_, Cell>,
        _: &mut R,
    ) -> Result<(), Quits> {
        Ok(())
    }
}

#[test]
fn an_agent_that_cannot_act_takes_no_step() {
    for limit in [0, 1, 7] {
        let env = ModelEnv::new(PAPER).unwrap();
        let mut world = Augmented::new(env, both(A, B), Rewards::progress());
        let (mut elapsed, mut rng) = (Elapsed::default(), Xoshiro256PlusPlus::seed_from_u64(3));
        let result =
            episode::run(&mut world, &mut Quitter(limit), &mut elapsed, 200, 1_000, &mut rng);
        assert_eq!(result, Err(Quits));
        assert_eq!((world.env().steps(), elapsed.steps), (limit, limit), "steps are counted");
    }
}

/// Five cells in a row; the task is at the right end, and at the left end the environment
/// terminates, which satisfies nothing.
#[derive(Clone, Copy)]
struct Cliff;

impl FiniteModel for Cliff {
    type State = usize;

    fn states(&self) -> usize {
        5
    }

    /// Steps left and right, of which one in five goes the other way.
    fn actions(&self) -> usize {
        2
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        // A model says that an end is absorbing: from there it stays.
        let (left, right) = if s == 0 { (0, 0) } else { (s - 1, (s + 1).min(4)) };
        outcome(left, [0.8, 0.2][a]);
        outcome(right, [0.2, 0.8][a]);
    }

    fn start(&self, s: usize) -> f64 {
        f64::from(u8::from(s > 0))
    }
}

/// The model as an environment that terminates, and pays for it.
struct Falling {
    env: ModelEnv<Cliff>,
    reward: f64,
}

impl Env for Falling {
    type State = usize;

    fn actions(&self) -> usize {
        2
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> usize {
        self.env.reset(rng)
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        let step = self.env.step(action, rng);
        let fell = step.state == 0;
        Step { terminated: fell, reward: if fell { self.reward } else { 0.0 }, ..step }
    }
}

impl FiniteEnv for Falling {
    fn states(&self) -> usize {
        5
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn state_index(&self) -> usize {
        self.env.state_index()
    }
}

fn falling() -> Falling {
    Falling { env: ModelEnv::new(Cliff).unwrap(), reward: 0.0 }
}

/// Visit cell 3 and then cell 4: an automaton with states at two distances from acceptance.
fn climb() -> impl Monitor<usize> + Clone {
    tltl! { |s: &usize| ({ *s } == 3) T ({ *s } == 4) }
}

/// What ends with the environment has no potential: else falling would be paid for.
#[test]
fn shaping_leaves_the_optimal_policies_of_acceptance() {
    let (env, climb) = (falling(), climb());
    let task = Labelled::of_env(&env, &climb).unwrap();
    let problem = Problem::new(env.env.dynamics(), &task).unwrap();
    let rewards = [Mode::Acceptance, Mode::Shaped].map(Rewards::of);
    let [plain, shaped] = rewards.map(|rewards| problem.optimal_q(&rewards));
    let cells = || task.live().flat_map(|q| (1..5).map(move |s| (q, s)));
    assert!(cells().all(|(q, s)| plain.greedy(q, s) == shaped.greedy(q, s)), "in the model");

    // Learned from steps that end: values differ from those of `Acceptance` by the potential of the
    // pair, the same for all its actions.
    let settings = Settings::default().with_memory(Memory::None);
    for rewards in rewards {
        let mut learner = Learner::new(&task, settings.with_rewards(rewards), 1);
        learner.train(&mut falling(), 400_000).unwrap();
        for (q, s) in cells() {
            assert_eq!(learner.table().greedy(q, s), plain.greedy(q, s), "{rewards:?} at {q}, {s}");
            let [left, right] = [0, 1].map(|a| learner.table().row(q, s)[a] - plain.row(q, s)[a]);
            assert!((left - right).abs() < 0.02, "{rewards:?} at {q}, {s}: {left}, {right}");
        }
    }

    // The same reward step by step: falling from beside the cliff costs the potential there.
    let mut world = Augmented::new(falling(), climb, Rewards::of(Mode::Shaped));
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut falls, mut sums) = (0, Vec::new());
    while falls < 20 {
        let (_, mut q) = world.reset(&mut rng).unwrap();
        let (start, mut sum, mut discount) = (q, 0.0, 1.0);
        loop {
            let step = world.step(0, &mut rng).unwrap();
            sum += discount * step.reward;
            discount *= 0.95;
            q = step.state.1;
            if step.terminated {
                break;
            }
        }
        if task.end(q).is_none() {
            falls += 1;
            sums.push((start, sum));
        }
    }
    for (start, sum) in sums {
        let potential = [1.0 / 3.0, 2.0 / 3.0][start as usize];
        assert!((sum + potential).abs() < 1e-9, "from {start} a fall is worth {sum}");
    }
}

#[test]
fn rewards_that_are_no_numbers_stop_learning() {
    let task = Labelled::of_env(&falling(), &climb()).unwrap();
    let settings = Settings::default().with_memory(Memory::None);
    let mut learner = Learner::new(&task, settings, 1);
    let mut env = Falling { reward: f64::NAN, ..falling() };
    let error = learner.train(&mut env, 1_000).unwrap_err();
    assert_eq!(error, TrainError::Reward(env.env.steps()), "at once");
    assert!(learner.table().values().iter().all(|value| value.is_finite()));
}
