//! Speed of tabular training, against flat-array loops written by hand for the very problem, and
//! against rurel.
//!
//! `cargo bench -p tltl-tests --bench learn`: φ₁ = ◇a ∧ ◇b on the paper's grid by the paper's recipe,
//! the automaton included. Runs alternate, and medians count: of each rate, and of the ratios of the
//! runs that stood side by side. Every rival must learn the task, and the library must reach 0.9 of
//! the loop by hand.

#[path = "../../runtime/tests/world/mod.rs"]
mod world;

use std::hash::{Hash, Hasher};
use std::hint::black_box;
use std::time::Instant;

use rurel::AgentTrainer;
use rurel::mdp::{Agent, State};
use rurel::strategy::explore::RandomExploration;
use rurel::strategy::learn::QLearning;
use rurel::strategy::terminate::TerminationStrategy;
use tltl::prelude::{FiniteEnv, Labelled, Learner, ModelEnv, Policy, Settings};
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use world::{A, B, Grid, PAPER, both, on_paper};

const STEPS: u64 = 5_000_000;
const REPETITIONS: u64 = 21;
const ALPHA: f64 = 0.1;
const GAMMA: f64 = 0.95;

fn below(n: u64, rng: &mut Xoshiro256PlusPlus) -> usize {
    ((u64::from(rng.next_u32()) * n) >> 32) as usize
}

/// The label of each cell: 1 at a, 2 at b.
fn labels() -> [u32; 80] {
    core::array::from_fn(|s| u32::from(s == 18) + 2 * u32::from(s == 45))
}

fn best(row: &[f64]) -> f64 {
    row.iter().fold(f64::NEG_INFINITY, |best, &v| if v > best { v } else { best })
}

/// The learning loop by hand, on any `step` of the world.
fn by_hand(
    rng: &mut Xoshiro256PlusPlus,
    mut reset: impl FnMut(&mut Xoshiro256PlusPlus) -> usize,
    mut step: impl FnMut(usize, usize, &mut Xoshiro256PlusPlus) -> usize,
) -> Vec<f64> {
    let (label, mut q, mut steps) = (labels(), vec![0.0f64; 4 * 80 * 5], 0);
    while steps < STEPS {
        let mut s = reset(rng);
        let mut done = label[s];
        for _ in 0..200 {
            let action = below(5, rng);
            let next = step(s, action, rng);
            let reached = done | label[next];
            let reward = if reached == done { 0.0 } else { 1.0 };
            let at = (reached as usize * 80 + next) * 5;
            let target = reward + GAMMA * best(&q[at..at + 5]);
            let value = &mut q[(done as usize * 80 + s) * 5 + action];
            *value += ALPHA * (target - *value);
            (s, done, steps) = (next, reached, steps + 1);
            if done == 3 {
                break;
            }
        }
    }
    q
}

/// By hand, the world too: a table of moves, and slips from one random word.
fn all_by_hand(seed: u64) -> Vec<f64> {
    let moves = [(0, 1), (0, -1), (-1, 0), (1, 0), (0, 0)];
    let mut to = [0usize; 400];
    for (at, to) in to.iter_mut().enumerate() {
        let (dx, dy) = moves[at % 5];
        let (x, y) = ((at / 5 % 8) as i32 + dx, (at / 40) as i32 + dy);
        let inside = (0..8).contains(&x) && (0..10).contains(&y);
        *to = if inside { (y * 8 + x) as usize } else { at / 5 };
    }
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let step = |s: usize, action: usize, rng: &mut Xoshiro256PlusPlus| {
        let word = rng.next_u64();
        let random = ((u64::from(word as u32) * 5) >> 32) as usize;
        let slips = (word >> 32) < 858_993_459;
        to[s * 5 + if slips { random } else { action }]
    };
    by_hand(&mut rng, |rng| below(80, rng), step)
}

/// The loop by hand, in the library's environment.
fn loop_by_hand(seed: u64) -> Vec<f64> {
    let env = core::cell::RefCell::new(ModelEnv::new(PAPER).unwrap());
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let reset = |rng: &mut Xoshiro256PlusPlus| env.borrow_mut().reset_index(rng);
    by_hand(&mut rng, reset, |_, action, rng| env.borrow_mut().step_index(action, rng).state)
}

fn library(task: &Labelled, settings: Settings, seed: u64) -> Vec<f64> {
    let mut env = ModelEnv::new(PAPER).unwrap();
    let mut learner = Learner::new(task, settings, seed);
    learner.train(&mut env, STEPS).unwrap();
    learner.q().values().to_vec()
}

/// A state as rurel wants it: what arriving paid is part of it, but does not tell states apart.
#[derive(Clone, Debug)]
struct Pair {
    s: usize,
    done: u32,
    paid: f64,
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        (self.s, self.done) == (other.s, other.done)
    }
}

impl Eq for Pair {}

impl Hash for Pair {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.s, self.done).hash(state);
    }
}

impl State for Pair {
    type A = usize;

    fn reward(&self) -> f64 {
        self.paid
    }

    fn actions(&self) -> Vec<usize> {
        (0..5).collect()
    }
}

/// An agent of rurel in the library's world.
struct Walker {
    env: ModelEnv<Grid>,
    rng: Xoshiro256PlusPlus,
    label: [u32; 80],
    at: Pair,
    steps: u64,
}

impl Walker {
    fn reset(&mut self) {
        let s = self.env.reset_index(&mut self.rng);
        self.at = Pair { s, done: self.label[s], paid: 0.0 };
    }
}

impl Agent<Pair> for Walker {
    fn current_state(&self) -> &Pair {
        &self.at
    }

    fn take_action(&mut self, action: &usize) {
        let s = self.env.step_index(*action, &mut self.rng).state;
        let done = self.at.done | self.label[s];
        self.at = Pair { s, done, paid: if done == self.at.done { 0.0 } else { 1.0 } };
        self.steps += 1;
    }
}

/// Ends an episode of rurel where the task is satisfied, or at the horizon.
struct Episode(u32);

impl TerminationStrategy<Pair> for Episode {
    fn should_stop(&mut self, state: &Pair) -> bool {
        self.0 += 1;
        self.0 >= 200 || state.done == 3
    }
}

fn rurel(seed: u64) -> Vec<f64> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut env = ModelEnv::new(PAPER).unwrap();
    let s = env.reset_index(&mut rng);
    let mut agent =
        Walker { env, rng, label: labels(), at: Pair { s, done: 0, paid: 0.0 }, steps: 0 };
    let mut trainer = AgentTrainer::new();
    while agent.steps < STEPS / 10 {
        agent.reset();
        if agent.at.done < 3 {
            let learning = QLearning::new(ALPHA, GAMMA, 0.0);
            trainer.train(&mut agent, &learning, &mut Episode(0), &RandomExploration::new());
        }
    }
    let first = Pair { s: 0, done: 0, paid: 0.0 };
    (0..5).map(|action| trainer.expected_value(&first, &action).unwrap_or(0.0)).collect()
}

/// One way to learn the task.
struct Rival<'a> {
    name: &'static str,
    steps: u64,
    run: &'a dyn Fn(u64) -> Vec<f64>,
}

impl Rival<'_> {
    /// Millions of steps a second at one seed; the value of the first pair must be that of the task.
    fn rate(&self, seed: u64) -> f64 {
        let start = Instant::now();
        let q = black_box((self.run)(seed));
        let rate = self.steps as f64 / start.elapsed().as_secs_f64() / 1e6;
        let (what, value) = (self.name, best(&q[..5]));
        assert!((1.2..1.6).contains(&value), "{what} did not learn: V = {value}, not near 1.376");
        rate
    }
}

fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    sorted[sorted.len() / 2]
}

/// Nanoseconds of `Policy::act` and `Policy::next` together.
fn act(task: &Labelled) {
    let q = library(task, Settings::default(), 1);
    let actions = q.chunks(5).map(|row| (0..5).max_by(|&i, &j| row[i].total_cmp(&row[j])).unwrap());
    let policy = Policy::new(task, actions).unwrap();
    let (start, mut sum, rounds) = (Instant::now(), 0, 20_000_000);
    for i in 0..rounds {
        let s = black_box(i % 80);
        let q = policy.next(0, s);
        sum += policy.act(q, s);
    }
    assert!(black_box(sum) > 0);
    let each = start.elapsed().as_secs_f64() * 1e9 / rounds as f64;
    println!("{:34} {each:7.2} ns", "policy: next and act");
}

fn main() {
    let Grid { width: 8, height: 10 } = PAPER else { panic!("the paper's grid") };
    let task = on_paper(&both(A, B));
    let paper = |seed| library(&task, Settings::paper(), seed);
    let default = |seed| library(&task, Settings::default(), seed);
    let rivals = [
        Rival { name: "all by hand", steps: STEPS, run: &all_by_hand },
        Rival { name: "loop by hand, library's world", steps: STEPS, run: &loop_by_hand },
        Rival { name: "library, the paper's recipe", steps: STEPS, run: &paper },
        Rival { name: "library, default settings", steps: STEPS, run: &default },
        Rival { name: "rurel", steps: STEPS / 10, run: &rurel },
    ];
    let rounds: Vec<[f64; 5]> =
        (0..REPETITIONS).map(|seed| rivals.each_ref().map(|rival| rival.rate(seed))).collect();
    for (i, rival) in rivals.iter().enumerate() {
        let rate = median(rounds.iter().map(|round| round[i]));
        println!("{:34} {rate:7.1} M steps/s", rival.name);
    }
    let [all, hand, rurel] =
        [0, 1, 4].map(|i| median(rounds.iter().map(|round| round[2] / round[i])));
    println!(
        "library: {hand:.2} of the loop by hand, {all:.2} of all by hand, {rurel:.1} times rurel"
    );
    assert!(hand >= 0.9, "the library is at {hand:.2} of the loop by hand");
    act(&task);
}
