//! Continuous control: learn a task with an actor, judge it against a controller written by hand, draw
//! it, emit it.
//!
//! `cargo run --release -p tltl-control --example control [-- TASK [SEED [STEPS]]]` for one of the tasks
//! `fetch`, `tour`, `park`, `hurry` (a point with inertia), `bring` and `bring_and_rest` (an arm); `fetch`
//! if left out. It writes into `target/control`. With `--study` in place of a task each is learned by ten
//! seeds, with `--compose` pairs of skills are composed without a step in the world: the numbers of
//! `docs/studies/control.md`.

use std::error::Error;
use std::time::Instant;

use tltl::deep::actor::{Learner, Settings};
use tltl::deep::{Device, Skill};
use tltl::env::ContinuousEnv;
use tltl::estimate::{Trials, estimate_continuous};
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::prelude::{Monitor, Product, Rewards};
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::reward::Mode;
use tltl::robustness::Predicates;
use tltl::{Acceptor as _, OutOfRange, Task};
use tltl_control::judge::{HORIZON, STARTS, Trialled, trials};
use tltl_control::picture::{Plane, Region};
use tltl_control::point::{Look, Point, Room};
use tltl_control::{arm, point};
use tltl_examples::show::Folder;

/// Environment steps of each training.
const STEPS: u64 = 60_000;

/// Trials of each policy, from starts that no learner has seen.
const TRIALS: u64 = 200;

/// A task in a world.
struct Case<E: ContinuousEnv, P, F> {
    world: E,
    task: Task<P>,
    look: F,
    /// The seconds of a step.
    step: f64,
    /// The places that it asks for, in order.
    goals: &'static [(f64, f64)],
    /// The controller written by hand: the state and the goal of the moment.
    by_hand: fn(&E::State, (f64, f64)) -> [f32; 2],
    plane: Plane<'static>,
    /// Where in the plane a state is drawn.
    at: fn(&E::State) -> (f64, f64),
}

const A: (f64, f64) = point::PLACES[0];
const B: (f64, f64) = point::PLACES[1];
const C: (f64, f64) = point::PLACES[2];
const CUP: (f64, f64) = arm::PLACES[0];
const SHELF: (f64, f64) = arm::PLACES[1];
const REST: (f64, f64) = arm::PLACES[2];

const ROOM: Plane<'static> = Plane {
    range: (-point::HALF, point::HALF),
    regions: &[
        Region { middle: A, radius: 0.25, name: "a", barred: false },
        Region { middle: B, radius: 0.25, name: "b", barred: false },
        Region { middle: C, radius: 0.25, name: "c", barred: false },
        Region { middle: (0.0, 0.0), radius: 0.3, name: "pillar", barred: true },
    ],
    edge: None,
};

const TABLE: Plane<'static> = Plane {
    range: (-0.6, 0.6),
    regions: &[
        Region { middle: CUP, radius: 0.08, name: "cup", barred: false },
        Region { middle: SHELF, radius: 0.08, name: "shelf", barred: false },
        Region { middle: REST, radius: 0.08, name: "rest", barred: false },
    ],
    edge: Some(-0.1),
};

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let task = arguments.next().unwrap_or_else(|| "fetch".into());
    let mut number = |or| arguments.next().map_or(Ok(or), |text| text.parse());
    let run = Run { task, seed: number(1)?, steps: number(STEPS)? };
    if run.task == "--compose" {
        if run.steps != STEPS && !(1..=3).contains(&run.steps) {
            return Err(format!("there is no pair {}; there are 1 to 3", run.steps).into());
        }
        // One pair, or all of them.
        let is_asked = |pair: u64| run.steps == STEPS || run.steps == pair;
        if is_asked(1) {
            compose(&point::to_a(), &point::to_b(), run.seed)?;
        }
        if is_asked(2) {
            compose(&point::to_b(), &point::to_c(), run.seed)?;
        }
        if is_asked(3) {
            compose(&point::to_a(), &point::to_c(), run.seed)?;
        }
        return Ok(());
    }
    let done = run.room(point::fetch(), &[A, B])?
        || run.room(point::tour(), &[A, B, C])?
        || run.room(point::park(), &[C])?
        || run.room(point::hurry(), &[B])?
        || run.arm(arm::bring(), &[CUP, SHELF])?
        || run.arm(arm::bring_and_rest(), &[CUP, SHELF, REST])?;
    if done || run.task == "--study" {
        return Ok(());
    }
    let known = "fetch, tour, park, hurry, bring and bring_and_rest";
    Err(format!("there is no task `{}`; there are {known}", run.task).into())
}

/// How all of them learn.
fn settings() -> Result<Settings, OutOfRange> {
    Settings::default()
        .with_rewards(Rewards::of(Mode::Shaped).with_gamma(0.98)?)
        .with_hidden([64, 64])?
        .with_horizon(HORIZON)?
        .with_steps(3)?
        .with_robustness(1.0)?
        .with_noise(Schedule::constant(0.3)?)?
        .with_noise_correlation(0.8)?
        .with_warmup(2_000)
}

/// Environment steps of a skill, and updates of a composition.
const SKILL: u64 = 20_000;

/// Learns two skills, makes both at once of what they saw, and learns the same from scratch with as many
/// steps as the two had.
fn compose<P, Q>(first: &Task<P>, second: &Task<Q>, seed: u64) -> Result<(), Box<dyn Error>>
where
    P: Predicates<Point> + Sync,
    Q: Predicates<Point> + Sync,
{
    let (mut room, settings, device) = (Room::default(), settings()?, Device::flex());
    let mut one = Learner::new(Skill::new(first, Look), &room, settings.clone(), &device, seed);
    one.train(&mut room, SKILL)?;
    let mut two =
        Learner::new(Skill::new(second, Look), &room, settings.clone(), &device, seed + 100);
    two.train(&mut room, SKILL)?;
    let both = Product::conjunction(&[first, second]);
    println!("{}", both.formula().text());
    let show = |name: &str, task: &dyn Monitor<Point>, act: &mut dyn FnMut(u32, &Point) -> _| {
        let trials = Trials::default().with_episodes(TRIALS)?.with_horizon(HORIZON)?;
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(STARTS);
        let seen = estimate_continuous(&mut Room::default(), &task, trials, &mut rng, act)?;
        let steps = seen.steps.map_or(f64::NAN, |steps| steps.mean);
        println!("{name:<24}{:>8.3}{:>8.3}{steps:>8.1}", seen.satisfied.mean, seen.lost.mean);
        Ok::<_, Box<dyn Error>>(())
    };
    show(first.name(), first, &mut |q, s| one.act(q, s))?;
    show(second.name(), second, &mut |q, s| two.act(q, s))?;
    let skill = || Skill::new(&both, Look);
    let mut composed = Learner::new(skill(), &room, settings.clone(), &device, seed + 200);
    composed.remember(&one)?;
    composed.remember(&two)?;
    composed.rehearse(SKILL)?;
    show("both, no further step", &both, &mut |q, s| composed.act(q, s))?;
    let mut scratch = Learner::new(skill(), &room, settings, &device, seed + 300);
    scratch.train(&mut room, 2 * SKILL)?;
    show("both, from scratch", &both, &mut |q, s| scratch.act(q, s))
}

/// What the user asked for.
struct Run {
    task: String,
    seed: u64,
    steps: u64,
}

impl Run {
    fn room<P: Predicates<point::Point> + Sync>(
        &self,
        task: Task<P>,
        goals: &'static [(f64, f64)],
    ) -> Result<bool, Box<dyn Error>> {
        self.case(Case {
            world: point::Room::default(),
            task,
            look: point::Look,
            step: point::STEP,
            goals,
            by_hand: point::steer,
            plane: ROOM,
            at: |s| (s.x, s.y),
        })
    }

    fn arm<P: Predicates<arm::Arm> + Sync>(
        &self,
        task: Task<P>,
        goals: &'static [(f64, f64)],
    ) -> Result<bool, Box<dyn Error>> {
        self.case(Case {
            world: arm::Table::default(),
            task,
            look: arm::Look,
            step: arm::STEP,
            goals,
            by_hand: arm::steer,
            plane: TABLE,
            at: |s| (s.x, s.y),
        })
    }

    /// Whether this was asked for, and then done.
    fn case<E, P, F>(&self, case: Case<E, P, F>) -> Result<bool, Box<dyn Error>>
    where
        E: ContinuousEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        if self.task == "--study" {
            case.study(self.steps)?;
            return Ok(false);
        }
        if self.task != case.task.name() {
            return Ok(false);
        }
        println!("{}: {}", case.task.name(), case.task.formula().text());
        header();
        let hand = case.hand()?;
        row("by hand", &hand);
        let start = Instant::now();
        let (learner, learned) = case.learned(self.seed, self.steps)?;
        row("learned", &learned);
        println!("{} steps in {:.0} s", learner.steps(), start.elapsed().as_secs_f64());
        let folder = Folder::at("target/control")?;
        let name = case.task.name().to_owned();
        let live = (0..case.task.states()).filter(|&q| !case.task.is_terminal(q));
        let texts: Vec<_> = live.map(|q| (q, format!("towards {}", case.towards(q)))).collect();
        let states: Vec<(u32, &str)> = texts.iter().map(|(q, text)| (*q, &**text)).collect();
        let few = &learned.episodes[..learned.episodes.len().min(12)];
        let drawn = case.plane.trajectories(&name, few, case.at, &states);
        folder.write(&format!("{name}.svg"), &drawn)?;
        let moving = case.plane.moving(&name, &few[0], case.at, case.step, &states);
        folder.write(&format!("{name}_moving.svg"), &moving)?;
        let policy = learner.policy()?.estimated(learned.estimate);
        folder.write(&format!("{name}.json"), &serde_json::to_string(&policy)?)?;
        folder.write(&format!("{name}.rs"), &tltlc::emit::network::source(&policy))?;
        Ok(true)
    }
}

impl<E, P, F> Case<E, P, F>
where
    E: ContinuousEnv<State: Clone> + Clone,
    P: Predicates<E::State> + Sync,
    F: Features<E::State> + Copy + Sync,
{
    /// Where one has to go at `q`: the live states are numbered in the order of the goals.
    fn goal(&self, q: u32) -> (f64, f64) {
        let before = (0..q).filter(|&q| !self.task.is_terminal(q)).count();
        self.goals[before.min(self.goals.len() - 1)]
    }

    /// What is there.
    fn towards(&self, q: u32) -> &'static str {
        let goal = self.goal(q);
        self.plane
            .regions
            .iter()
            .find(|region| region.middle == goal)
            .map_or("", |region| region.name)
    }

    /// Trials of the controller written by hand.
    fn hand(&self) -> Result<Trialled<E::State>, Box<dyn Error>> {
        let Self { world, task, by_hand, .. } = self;
        let act = |q, s: &E::State| Ok(by_hand(s, self.goal(q)).to_vec());
        trials(&mut world.clone(), task, TRIALS, act)
    }

    /// Learns, and tries what was learned.
    #[allow(clippy::type_complexity, reason = "the learner of this case and its trials")]
    fn learned(
        &self,
        seed: u64,
        steps: u64,
    ) -> Result<
        (Learner<E::State, &Task<P>, F, tltl::deep::AsGiven>, Trialled<E::State>),
        Box<dyn Error>,
    > {
        let Self { world, task, look, .. } = self;
        let settings = settings()?;
        let skill = Skill::new(task, *look);
        let mut learner = Learner::new(skill, world, settings, &Device::flex(), seed);
        learner.train(&mut world.clone(), steps)?;
        let act = |q, s: &E::State| Ok::<_, Box<dyn Error>>(learner.act(q, s)?);
        let tried = trials(&mut world.clone(), task, TRIALS, act)?;
        Ok((learner, tried))
    }

    /// Ten seeds.
    fn study(&self, steps: u64) -> Result<(), Box<dyn Error>> {
        println!("{}: {}", self.task.name(), self.task.formula().text());
        header();
        let hand = self.hand()?;
        row("by hand", &hand);
        for seed in 1..=10 {
            let (_, learned) = self.learned(seed, steps)?;
            row(&format!("seed {seed}"), &learned);
        }
        Ok(())
    }
}

fn header() {
    println!(
        "{:<10}{:>13}{:>10}{:>8}{:>12}{:>10}",
        "", "P(satisfied)", "P(lost)", "steps", "robustness", "least"
    );
}

fn row<S>(name: &str, tried: &Trialled<S>) {
    let (estimate, robustness) = (&tried.estimate, &tried.robustness);
    let mean = robustness.iter().sum::<f64>() / robustness.len() as f64;
    let least = robustness.iter().copied().fold(f64::INFINITY, f64::min);
    let steps = estimate.steps.map_or(f64::NAN, |steps| steps.mean);
    println!(
        "{name:<10}{:>13.3}{:>10.3}{steps:>8.1}{mean:>12.3}{least:>10.3}",
        estimate.satisfied.mean, estimate.lost.mean
    );
}
