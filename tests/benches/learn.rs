//! Speed of tabular training, against loops written by hand on flat arrays that do the same, and
//! against rurel.
//!
//! `cargo bench -p tltl-tests --bench learn`. A floor draws the same random numbers in the same world,
//! keeps the same counts and makes the same updates; it must give the same table and the same counts, to the last
//! bit. It knows the task and the number of actions, and no settings. Runs alternate, and the fastest
//! of each counts, for what else the machine does can only add. The library must reach 0.9 of the
//! floor in the paper's recipe and 0.8 in all others (0.85 or more, measured beside much other work).
//!
//! The last line is what all of it is for: 100 × 100 cells and 16 automaton states, learned by coverage and
//! solved as they were seen within a second, and what the policy is worth.

#[path = "../../runtime/tests/world/mod.rs"]
mod world;

use std::hash::{Hash, Hasher};
use std::hint::{black_box, select_unpredictable};
use std::sync::LazyLock;
use std::time::Instant;

use rurel::AgentTrainer;
use rurel::mdp::{Agent, State};
use rurel::strategy::explore::RandomExploration;
use rurel::strategy::learn::QLearning;
use rurel::strategy::terminate::TerminationStrategy;
use tltl::learn::{Exploration, Schedule};
use tltl::model::{self, FiniteModel};
use tltl::prelude::*;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use world::{A, B, Grid, PAPER, both, on_paper};

const REPETITIONS: u64 = 15;
const RUREL_STEPS: u64 = 300_000;
const ALPHA: f64 = 0.1;
const GAMMA: f64 = 0.95;

/// Seconds that this thread has run, where the system tells them: what else the machine does takes no part
/// then. Else those of a clock.
fn seconds() -> f64 {
    // What has run is booked when a thread gives way.
    std::thread::yield_now();
    let booked = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let ran = booked.and_then(|text| text.split(' ').next()?.parse().ok());
    static CLOCK: LazyLock<Instant> = LazyLock::new(Instant::now);
    ran.map_or_else(|| CLOCK.elapsed().as_secs_f64(), |nanoseconds: f64| nanoseconds * 1e-9)
}

fn below(n: usize, rng: &mut Xoshiro256PlusPlus) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

/// The label of each cell: 1 at a, 2 at b.
fn labels() -> [u32; 80] {
    core::array::from_fn(|s| u32::from(s == 18) + 2 * u32::from(s == 45))
}

#[inline(always)]
fn largest(row: &[f64]) -> f64 {
    row.iter().fold(f64::NEG_INFINITY, |best, &v| select_unpredictable(v > best, v, best))
}

/// The index of the first of the largest, and of the smallest.
#[inline(always)]
fn first<T: PartialOrd + Copy>(row: &[T], better: impl Fn(T, T) -> bool) -> usize {
    (1..row.len()).fold(0, |best, i| select_unpredictable(better(row[i], row[best]), i, best))
}

/// What a loop does at each step.
trait Recipe {
    /// What the library calls it.
    fn settings() -> Settings;
    /// Whether values are updated.
    const VALUES: bool;
    /// Whether all automaton states are, with a step size that falls, and half of the actions greedy;
    /// else one is, with a constant one, and all actions are random.
    const ALL: bool;
    /// Whether outcomes are counted.
    const MEMORY: bool;
}

/// The paper's.
struct Paper;

impl Recipe for Paper {
    fn settings() -> Settings {
        Settings::paper()
    }
    const VALUES: bool = true;
    const ALL: bool = false;
    const MEMORY: bool = false;
}

/// A table that is read while it is learned.
struct Greedy;

impl Recipe for Greedy {
    fn settings() -> Settings {
        let rewards = Rewards::progress().with_gamma(GAMMA).unwrap();
        let half = Settings::default().with_epsilon(Schedule::constant(0.5).unwrap()).unwrap();
        half.with_exploration(Exploration::Random).with_rewards(rewards)
    }
    const VALUES: bool = true;
    const ALL: bool = true;
    const MEMORY: bool = true;
}

/// All actions explore, towards what was tried least, and what is seen is counted.
struct Survey;

impl Recipe for Survey {
    fn settings() -> Settings {
        Settings::default()
    }
    const VALUES: bool = false;
    const ALL: bool = false;
    const MEMORY: bool = true;
}

/// Outcomes that are kept of each (s, a); the worlds here have no more.
const SLOTS: usize = 8;

/// What a loop by hand has learned.
struct Learned {
    steps: u64,
    /// Indexed `(mask * states + s) * A + a`.
    values: Vec<f64>,
    /// The outcomes of each `s * A + a`, and how often they came.
    to: Vec<u32>,
    times: Vec<u32>,
}

/// The loop by hand. Goals are visited in any order, so the automaton is a mask of those that are done.
///
/// Values stand by state where all automaton states of one are read together.
#[inline(never)]
fn by_hand<M: FiniteModel, R: Recipe, const A: usize>(
    env: &mut ModelEnv<M>,
    label: &[u32],
    total: u64,
    seed: u64,
) -> Learned {
    let full = label.iter().fold(0, |all, bits| all | bits) as usize;
    let (states, masks) = (label.len(), full + 1);
    let by_state = R::ALL && full >= 4;
    let row =
        |q: usize, s: usize| if by_state { (s * masks + q) * A } else { (q * states + s) * A };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut values = vec![0.0f64; masks * states * A];
    let mut visits = vec![0u32; states * A];
    let mut distance = vec![0u32; states * A];
    let mut to = vec![u32::MAX; if R::MEMORY { states * A * SLOTS } else { 0 }];
    let mut times = vec![0u32; to.len()];
    let (mut starts, mut steps) = (vec![0u32; states], 0);
    while steps < total {
        let mut s = env.reset_index(&mut rng);
        starts[s] += u32::from(R::MEMORY);
        let mut done = label[s] as usize;
        let end = if done == full { steps } else { steps + 200 };
        while steps < end {
            let action = if !R::VALUES {
                first(&distance[s * A..][..A], |one, other| one < other)
            } else if R::ALL && (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64 >= 0.5 {
                first(&values[row(done, s)..][..A], |one, other| one > other)
            } else {
                below(A, &mut rng)
            };
            let Step { state: next, terminated, .. } = env.step_index(action, &mut rng);
            let (cell, bits) = (s * A + action, label[next] as usize);
            let reached = done | bits;
            let over = reached == full || terminated;
            if R::MEMORY {
                let key = next as u32 | u32::from(terminated) << 31;
                let known = &mut to[cell * SLOTS..][..SLOTS];
                let slot = known.iter().position(|&t| t == key || t == u32::MAX).unwrap();
                known[slot] = key;
                times[cell * SLOTS + slot] += 1;
            }
            let mut update = |q: usize, alpha: f64| {
                let to = q | bits;
                let best = if to == full || terminated {
                    0.0
                } else {
                    largest(&values[row(to, next)..][..A])
                };
                let target = if to == q { 0.0 } else { 1.0 } + GAMMA * best;
                let value = &mut values[row(q, s) + action];
                *value += alpha * (target - *value);
            };
            if !R::VALUES {
                let row = &distance[next * A..][..A];
                let least = if over { distance[cell] } else { row[first(row, |a, b| a < b)] };
                distance[cell] = least + 1;
            } else if R::ALL {
                let alpha = 8.0 / (8.0 + f64::from(visits[cell]));
                visits[cell] += 1;
                (0..full).for_each(|q| update(q, alpha));
            } else {
                update(done, ALPHA);
            }
            (s, done, steps) = (next, reached, steps + 1);
            if over {
                break;
            }
        }
    }
    if by_state {
        let rows = (0..masks).flat_map(|q| (0..states).map(move |s| (q, s)));
        values = rows.flat_map(|(q, s)| values[row(q, s)..][..A].to_vec()).collect();
    }
    Learned { steps, values, to, times }
}

/// A world with goals, to be visited in any order.
struct Case<'a, M> {
    name: &'a str,
    world: &'a M,
    goals: &'a [usize],
    steps: u64,
}

impl<M: FiniteModel> Case<'_, M> {
    fn task(&self) -> Labelled {
        let actions = (0..self.world.actions()).map(|a| a.to_string());
        let (states, goals) = (0..self.world.states(), self.goals.to_vec());
        let at = |i: usize| goals.get(i).or(goals.first()).copied().unwrap_or_default();
        let (a, b, c, d) = (at(0), at(1), at(2), at(3));
        let all = tltl! {
            |s: &usize| F ({ *s == a }) && F ({ *s == b }) && F ({ *s == c }) && F ({ *s == d })
        };
        let one = tltl! { |s: &usize| F ({ *s == a }) };
        let two = tltl! { |s: &usize| F ({ *s == a }) && F ({ *s == b }) };
        let task = match goals.len() {
            1 => Labelled::new(states, actions, &one),
            2 => Labelled::new(states, actions, &two),
            _ => Labelled::new(states, actions, &all),
        };
        task.unwrap()
    }

    fn label(&self) -> Vec<u32> {
        let mut label = vec![0; self.world.states()];
        self.goals.iter().enumerate().for_each(|(i, &s)| label[s] |= 1 << i);
        label
    }

    fn library<R: Recipe>(&self, env: &mut ModelEnv<&M>, task: &Labelled, seed: u64) -> Learner {
        let mut learner = Learner::new(task, R::settings(), seed);
        learner.train(env, self.steps).unwrap();
        learner
    }

    /// The ratio of the library's speed to the floor's, and both are shown.
    fn ratio<R: Recipe, const A: usize>(&self) -> f64 {
        let (task, label) = (self.task(), self.label());
        let mut env = ModelEnv::new(self.world).unwrap();
        let mut fastest = [f64::INFINITY; 2];
        for seed in 0..REPETITIONS {
            let start = seconds();
            let learner = self.library::<R>(&mut env, &task, seed);
            fastest[0] = fastest[0].min(seconds() - start);
            let start = seconds();
            let floor = by_hand::<_, R, A>(&mut env, &label, self.steps, seed);
            fastest[1] = fastest[1].min(seconds() - start);
            if seed == 0 {
                self.assert_same::<R, A>(&learner, &floor);
            }
        }
        let [own, floor] = fastest.map(|time| time * 1e9 / self.steps as f64);
        println!("{:44} {own:7.2} ns a step, by hand {floor:7.2}: {:.2}", self.name, floor / own);
        floor / own
    }

    fn assert_same<R: Recipe, const A: usize>(&self, learner: &Learner, floor: &Learned) {
        assert_eq!(learner.steps(), floor.steps, "{}", self.name);
        let (task, states) = (learner.task(), self.world.states());
        let full = (1 << self.goals.len()) - 1;
        for (mask, s) in (0..full).flat_map(|mask| (0..states).map(move |s| (mask, s))) {
            let done = (0..self.goals.len()).filter(|i| mask >> i & 1 == 1);
            let q = done.fold(0, |q, i| task.next(q, self.goals[i]));
            let by_hand = &floor.values[(mask * states + s) * A..][..A];
            assert_eq!(learner.table().row(q, s), by_hand, "{}: {mask} at {s}", self.name);
        }
        for cell in 0..floor.to.len() / SLOTS {
            let (s, a) = (cell / A, cell % A);
            let times = &floor.times[cell * SLOTS..][..SLOTS];
            let tried = f64::from(times.iter().sum::<u32>());
            let counted = floor.to[cell * SLOTS..].iter().zip(times).filter(|(_, n)| **n > 0);
            let mut counted = counted.map(|(&to, &n)| (to as usize, f64::from(n) / tried));
            if tried > 0.0 {
                learner
                    .experience()
                    .transitions(s, a, |to, p| assert_eq!(counted.next(), Some((to, p))));
            }
            assert_eq!(counted.next(), None, "{}: {a} at {s}", self.name);
        }
    }

    /// Learned to the end by the library, timed, and judged by the model.
    fn learned(&self) {
        let mut env = ModelEnv::new(self.world).unwrap();
        let task = self.task();
        let start = seconds();
        let learner = self.library::<Survey>(&mut env, &task, 1);
        let trained = seconds() - start;
        let policy = learner.policy();
        let total = seconds() - start;
        let problem = Problem::new(env.dynamics(), &task).unwrap();
        let worth = problem.optimum(&learner.rewards()).certify(&policy).unwrap();
        let (satisfied, steps) = (worth.regret_satisfied, worth.regret_steps.unwrap());
        println!(
            "{}: learned in {total:.2} s, {trained:.2} s of them {} M steps; P(satisfied) {:.4} % and steps \
             {:.2} % from the optimum",
            self.name,
            self.steps / 1_000_000,
            100.0 * satisfied,
            100.0 * steps
        );
        assert!(satisfied < 0.01 && steps < 0.01, "{worth:?}");
        assert!(total < 1.0, "learned in {total:.2} s");
    }
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
    while agent.steps < RUREL_STEPS {
        agent.reset();
        if agent.at.done < 3 {
            let learning = QLearning::new(ALPHA, GAMMA, 0.0);
            trainer.train(&mut agent, &learning, &mut Episode(0), &RandomExploration::new());
        }
    }
    let first = Pair { s: 0, done: 0, paid: 0.0 };
    (0..5).map(|action| trainer.expected_value(&first, &action).unwrap_or(0.0)).collect()
}

/// How many times as fast as rurel the paper's recipe is on the paper's grid. Both must learn the task.
fn against_rurel(task: &Labelled) -> f64 {
    let learned = |what: &str, value: f64| {
        assert!((1.2..1.6).contains(&value), "{what} did not learn: V = {value}, not near 1.376");
    };
    let times = (0..3).map(|seed| {
        let start = seconds();
        let mut learner = Learner::new(task, Settings::paper(), seed);
        learner.train(&mut ModelEnv::new(PAPER).unwrap(), 10 * RUREL_STEPS).unwrap();
        let own = (seconds() - start) / 10.0;
        learned("the library", learner.table().max(0, 0));
        let start = seconds();
        learned("rurel", largest(&black_box(rurel(seed))));
        (seconds() - start) / own
    });
    times.fold(0.0, f64::max)
}

/// Nanoseconds of `Policy::act` and `Policy::next` together.
fn act(task: &Labelled) {
    let mut learner = Learner::new(task, Settings::paper(), 1);
    learner.train(&mut ModelEnv::new(PAPER).unwrap(), 100_000).unwrap();
    let policy = learner.policy();
    let (start, mut sum, rounds) = (seconds(), 0, 20_000_000);
    for i in 0..rounds {
        let s = black_box(i % 80);
        let q = policy.next(0, s);
        sum += policy.act(q, s);
    }
    assert!(black_box(sum) > 0);
    let each = (seconds() - start) * 1e9 / rounds as f64;
    println!("{:44} {each:7.2} ns", "policy: next and act");
}

/// States with four random successors for each of six actions.
fn random(states: usize) -> impl FiniteModel {
    model::from_fn(states, 6, move |s, a| {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64((s * 6 + a) as u64);
        [0; 4].map(|_| (below(states, &mut rng), 0.25))
    })
}

fn main() {
    let Grid { width: 8, height: 10 } = PAPER else { panic!("the paper's grid") };
    let (ten, hundred) = (Grid { width: 10, height: 10 }, Grid { width: 100, height: 100 });
    let goals = [2_424, 1_974, 7_419, 7_979];
    let (paper, random) = (on_paper(&both(A, B)), random(1_000));
    let case = |name, world, goals, steps| Case { name, world, goals, steps };
    let papers = case("the paper's grid and recipe", &PAPER, &[18, 45][..], 3_000_000);
    let others = [
        case("greedy, 10 x 10 cells", &ten, &[22, 77], 1_000_000).ratio::<Greedy, 5>(),
        case("greedy, 100 x 100 cells, 16 q", &hundred, &goals, 300_000).ratio::<Greedy, 5>(),
        case("greedy, 100 x 100 cells, one q", &hundred, &goals[..1], 1_000_000)
            .ratio::<Greedy, 5>(),
        Case { name: "greedy, random world", world: &random, goals: &[100, 700], steps: 1_000_000 }
            .ratio::<Greedy, 6>(),
        case("coverage, the paper's grid", &PAPER, &[18, 45], 2_000_000).ratio::<Survey, 5>(),
        case("coverage, 100 x 100 cells, 16 q", &hundred, &goals, 2_000_000).ratio::<Survey, 5>(),
    ];
    let recipe = papers.ratio::<Paper, 5>();
    println!("{:44} {:7.1} times", "the paper's recipe, against rurel", against_rurel(&paper));
    act(&paper);
    case("coverage, 100 x 100 cells, 16 q", &hundred, &goals, 1_000_000).learned();
    assert!(recipe >= 0.9, "the paper's recipe is at {recipe:.2} of the loop by hand");
    assert!(others.iter().all(|&ratio| ratio >= 0.8), "{others:.2?} of the loops by hand");
}
