//! Study of tasks: what the default settings learn, on 13 tasks in 15 small worlds, against the largest
//! P(satisfied) and the fewest steps.
//!
//! `cargo run --release --example study_tasks` writes `docs/studies/tasks.{md,jsonl}`.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::json;
use tltl::learn::{Exploration, Memory};
use tltl::prelude::*;
use tltl::reward::End;
use tltl_examples::places::{Place, World, worlds};
use tltl_examples::study::{self, Study};

include_tltl!("tasks/places.tltl", state = tltl_examples::places::Place);

const SEEDS: u64 = 5;
/// Environment steps of training for each place and action: of a task that cannot be lost, of one that
/// can, and of one that can in a world of at most 25 places, where one place is much of the mean.
const VISITS: [u64; 3] = [5_000, 20_000, 200_000];
/// What is given away at most: of P(satisfied), and of the steps.
const BOUNDS: [f64; 2] = [1e-3, 1e-2];
/// The γ with which a table alone learns.
const GAMMA: f64 = 0.99;

fn tasks() -> Vec<Box<dyn Monitor<Place> + Send + Sync>> {
    vec![
        Box::new(places::three_instants()),
        Box::new(places::either_way()),
        Box::new(places::in_order()),
        Box::new(places::then_next()),
        Box::new(places::one_of_three()),
        Box::new(places::may_be_lost()),
        Box::new(places::all_three()),
        Box::new(places::leave_and_return()),
        Box::new(places::soon()),
        Box::new(places::stay()),
        Box::new(places::soon_and_safe()),
        Box::new(places::soon_after()),
        Box::new(places::both_and_safe()),
    ]
}

/// Ways to explore: how, whether all episodes start at one place, and one of how many steps is taken.
const EXPLORED: [(Exploration, bool, u64); 5] = {
    use Exploration::{Coverage, Random};
    [
        (Coverage, false, 1),
        (Coverage, false, 16),
        (Random, false, 16),
        (Coverage, true, 16),
        (Random, true, 16),
    ]
};

/// Ways to choose a policy on the world as it was seen, and how many steps' worth of P each takes.
const WAYS: [(&str, Price); 9] = [
    ("none: the largest P, then the fewest steps", Price::Nothing),
    ("0.00001 a step", Price::Step(1e-5)),
    ("0.0001 a step", Price::Step(1e-4)),
    ("0.001 for all steps", Price::All(1e-3)),
    ("0.002 for all steps", Price::All(2e-3)),
    ("0.004 for all steps", Price::All(4e-3)),
    ("0.006 for all steps, the default", Price::All(6e-3)),
    ("0.008 for all steps", Price::All(8e-3)),
    ("0.01 for all steps", Price::All(1e-2)),
];

/// The price of a step at which the largest P is had with hardly more than the fewest steps.
const FIRST: f64 = 1e-6;

/// The one of them that finishes learning.
const DEFAULT: usize = 6;

/// What P(satisfied) is given for fewer steps.
#[derive(Clone, Copy, Debug)]
enum Price {
    /// None.
    Nothing,
    /// So much for each step.
    Step(f64),
    /// So much for all steps of the best policy.
    All(f64),
}

impl Price {
    /// The policy on `seen`.
    fn policy(self, seen: &Problem) -> Policy {
        let best = seen.best();
        let at = |price: f64| {
            let rewards = Rewards::acceptance().with_gamma(1.0 - price).expect("less than 1");
            seen.optimal_q(&rewards)
        };
        match self {
            Self::Nothing => best.policy().clone(),
            Self::Step(price) => at(price).policy(),
            Self::All(price) => {
                let satisfied = best.mean_satisfied();
                let taken = satisfied - mean(&at(FIRST), seen);
                at((price * satisfied * FIRST / taken).min(price)).policy()
            }
        }
    }
}

/// The mean of the values over the starts; 1 where the task is satisfied at once.
fn mean(q: &QTable, problem: &Problem) -> f64 {
    let task = problem.task();
    let starts = problem.dynamics().starts().iter().enumerate();
    let worth = |(s, weight): (usize, &f64)| match task.end(task.start(s)) {
        Some(End::Accepted) => *weight,
        Some(End::Lost) => 0.0,
        None => weight * q.max(task.start(s), s),
    };
    starts.map(worth).sum()
}

/// Regret in P(satisfied), and in steps where it ever succeeds.
type Regret = (f64, Option<f64>);

/// A task in a world: what can be had, what was learned.
#[derive(Serialize, Deserialize)]
struct Case {
    /// Environment steps of each training.
    training: u64,
    can_be_lost: bool,
    satisfied: f64,
    steps: Option<f64>,
    /// One for each seed.
    learned: Vec<Regret>,
    /// For each seed one for each of the ways.
    ways: Vec<Vec<Regret>>,
    /// The same where the world is known and not only seen.
    known: Vec<Regret>,
    /// Of the table alone, at one seed.
    table: Regret,
    /// For each way to explore but the first, the default, one for each seed.
    explored: Vec<Vec<Regret>>,
}

/// What is learned of `task` by a way to explore, one for each seed.
fn explored(
    world: &World,
    task: &Labelled,
    training: u64,
    (exploration, one_start, part): (Exploration, bool, u64),
) -> Vec<Regret> {
    let world = if one_start { world.from_the_last() } else { world.clone() };
    let mut env = ModelEnv::new(&world).expect("a model");
    let problem = Problem::new(env.dynamics(), task).expect("its world");
    let optimum = problem.optimum(&Rewards::default());
    let settings = Settings::default().with_exploration(exploration);
    let learn = |seed| {
        let mut learner = Learner::new(task, settings, seed);
        learner.train(&mut env, training / part).expect("its world");
        let worth = optimum.certify(&learner.policy()).expect("its task");
        (worth.regret_satisfied, worth.regret_steps)
    };
    (0..SEEDS).map(learn).collect()
}

fn case(world: &World, task: &dyn Monitor<Place>) -> Case {
    let mut env = ModelEnv::new(world).expect("a model");
    let task = Labelled::of_env(&env, task).expect("numbers");
    let can_be_lost = (0..task.automaton_states()).any(|q| task.end(q) == Some(End::Lost));
    let small = world.states() <= 25;
    let visits = VISITS[if can_be_lost { 1 + usize::from(small) } else { 0 }];
    let training = visits * (world.states() * world.actions()) as u64;
    let optimum =
        Problem::new(env.dynamics(), &task).expect("its world").optimum(&Rewards::default());
    let regret = |policy: &Policy| -> Regret {
        let worth = optimum.certify(policy).expect("its task");
        (worth.regret_satisfied, worth.regret_steps)
    };
    let mut train = |settings, seed| {
        let mut learner = Learner::new(&task, settings, seed);
        learner.train(&mut env, training).expect("its world");
        learner
    };
    let (mut learned, mut ways) = (Vec::new(), Vec::new());
    for seed in 0..SEEDS {
        let learner = train(Settings::default(), seed);
        learned.push(regret(&learner.policy()));
        if can_be_lost {
            let seen = Dynamics::new(learner.experience()).expect("it was trained");
            let seen = Problem::new(&seen, &task).expect("its world");
            let found: Vec<Regret> =
                WAYS.iter().map(|(_, price)| regret(&price.policy(&seen))).collect();
            let (own, same) = (learned[learned.len() - 1], found[DEFAULT]);
            assert!((own.0 - same.0).abs() < 1e-6, "the default is another way: {own:?}, {same:?}");
            ways.push(found);
        }
    }
    let known = optimum.problem();
    let known = WAYS.iter().map(|(_, price)| regret(&price.policy(known))).collect();
    let slow = Rewards::acceptance().with_gamma(GAMMA).expect("less than 1");
    let alone = Settings::default().with_memory(Memory::None).with_rewards(slow);
    let (satisfied, steps) = (optimum.best().mean_satisfied(), optimum.best().mean_steps());
    let table = regret(&train(alone, 0).policy());
    let explored = EXPLORED[1..].iter().map(|&way| explored(world, &task, training, way)).collect();
    Case { training, can_be_lost, satisfied, steps, learned, ways, known, table, explored }
}

/// The worst of some regrets; in steps, of those that succeed.
fn worst<'a>(regrets: impl IntoIterator<Item = &'a Regret>) -> [f64; 2] {
    let larger = |[p, steps]: [f64; 2], regret: &Regret| {
        [p.max(regret.0), steps.max(regret.1.unwrap_or(f64::NEG_INFINITY))]
    };
    regrets.into_iter().fold([f64::NEG_INFINITY; 2], larger)
}

fn percent(value: f64, digits: usize) -> String {
    study::percent(value, digits, "–")
}

/// What was learned in each world, task by task.
fn regrets(cases: &[Case]) -> String {
    let (worlds, tasks) = (worlds(), tasks());
    let mut text = "| world |".to_owned();
    (1..=tasks.len()).for_each(|i| text.push_str(&format!(" {i} |")));
    let _ = writeln!(text, "\n| --- |{}", " --- |".repeat(tasks.len()));
    for (world, cases) in worlds.iter().zip(cases.chunks(tasks.len())) {
        let _ = write!(text, "| {} |", world.name);
        for case in cases {
            let [p, steps] = worst(&case.learned);
            let _ = write!(text, " {} / {} |", percent(p, 3), percent(steps, 1));
        }
        text.push('\n');
    }
    text
}

/// The worlds: how large they are, and how long was learned in them.
fn setup(cases: &[Case]) -> String {
    let mut text = "| world | places | actions | steps, cannot be lost | steps, can be lost |\n\
                    | --- | --- | --- | --- | --- |\n"
        .to_owned();
    for (world, cases) in worlds().iter().zip(cases.chunks(tasks().len())) {
        let steps = |lost| cases.iter().find(|case| case.can_be_lost == lost);
        let steps = [false, true].map(|lost| steps(lost).map_or(0, |case| case.training));
        let (name, places, actions) = (world.name, world.states(), world.actions());
        let _ = writeln!(text, "| {name} | {places} | {actions} | {} | {} |", steps[0], steps[1]);
    }
    text
}

/// The formulas, and what can be had of each.
fn formulas(cases: &[Case]) -> String {
    let mut text = "| | task | largest P | fewest steps | table alone, mean and worst |\n\
                    | --- | --- | --- | --- | --- |\n"
        .to_owned();
    let tasks = tasks();
    for (i, task) in tasks.iter().enumerate() {
        let own: Vec<&Case> = cases.iter().skip(i).step_by(tasks.len()).collect();
        let range = |values: &[f64], digits: usize| {
            let low = values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            format!("{low:.digits$} to {high:.digits$}")
        };
        let p: Vec<f64> = own.iter().map(|case| case.satisfied).collect();
        let steps: Vec<f64> = own.iter().filter_map(|case| case.steps).collect();
        let mean = own.iter().map(|case| case.table.0).sum::<f64>() / own.len() as f64;
        let alone = worst(own.iter().map(|case| &case.table))[0];
        let _ = writeln!(
            text,
            "| {} | `{}` | {} | {} | {}, {} |",
            i + 1,
            task.formula().text().replace('|', "\\|"),
            range(&p, 3),
            range(&steps, 1),
            percent(mean, 3),
            percent(alone, 3)
        );
    }
    text
}

/// What each way to choose a policy gives away, on the tasks that can be lost.
fn alternatives(cases: &[Case]) -> String {
    let mut text = "| what P gives for fewer steps | P regret where the world is known, worst % | \
                    P regret, worst % | steps regret, worst % | over 0.1 % of P | over 1 % of the \
                    steps |\n| --- | --- | --- | --- | --- | --- |\n"
        .to_owned();
    let lost: Vec<&Case> = cases.iter().filter(|case| case.can_be_lost).collect();
    for (i, (name, _)) in WAYS.iter().enumerate() {
        let each: Vec<[f64; 2]> =
            lost.iter().map(|case| worst(case.ways.iter().map(|ways| &ways[i]))).collect();
        let of = |j: usize| each.iter().map(|worst| worst[j]).fold(f64::NEG_INFINITY, f64::max);
        let over = |j: usize| each.iter().filter(|worst| worst[j] > BOUNDS[j]).count();
        let known = worst(lost.iter().map(|case| &case.known[i]))[0];
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} |",
            percent(known, 3),
            percent(of(0), 3),
            percent(of(1), 1),
            over(0),
            over(1)
        );
    }
    text
}

/// What each way to explore gives away, on all tasks.
fn explorations(cases: &[Case]) -> String {
    let mut text = "| exploration | starts | steps | P regret, worst % | steps regret, worst % | \
                    over 0.1 % of P | over 1 % of the steps |\n\
                    | --- | --- | --- | --- | --- | --- | --- |\n"
        .to_owned();
    for (i, (exploration, one_start, part)) in EXPLORED.into_iter().enumerate() {
        let found = |case: &Case| match i.checked_sub(1) {
            None => worst(&case.learned),
            Some(i) => worst(&case.explored[i]),
        };
        let each: Vec<[f64; 2]> = cases.iter().map(found).collect();
        let of = |j: usize| each.iter().map(|worst| worst[j]).fold(f64::NEG_INFINITY, f64::max);
        let over = |j: usize| each.iter().filter(|worst| worst[j] > BOUNDS[j]).count();
        let starts = if one_start { "one" } else { "all" };
        let steps = if part == 1 { "as above".to_owned() } else { format!("1/{part} of that") };
        let _ = writeln!(
            text,
            "| {exploration:?} | {starts} | {steps} | {} | {} | {} | {} |",
            percent(of(0), 3),
            percent(of(1), 1),
            over(0),
            over(1)
        );
    }
    text
}

fn document(cases: &[Case]) -> String {
    let lost = cases.iter().filter(|case| case.can_be_lost).count();
    let mut text = format!(
        "# Tasks\n\nWhat the default settings learn (`Learner::new(&task, Settings::default(), seed)`, \
         `train`, `policy`), on {} tasks in {} worlds, against the largest P(satisfied) and the \
         fewest steps that allow it, computed exactly. A cell is the worst of {SEEDS} seeds: percent \
         of P given away / percent of steps more than the fewest (negative where a policy gives up \
         safety for speed; – where no policy can succeed). The worlds are in `examples/places.rs`. Written by `cargo run --release \
         --example study_tasks`.\n\n",
        tasks().len(),
        worlds().len()
    );
    text.push_str(&regrets(cases));
    text.push_str(
        "\n## The tasks\n\nThe last column is the P given away by the greedy policy of the \
        table alone (`Memory::None`, γ ",
    );
    let _ = writeln!(text, "{GAMMA}; one seed), in percent.\n\n{}", formulas(cases));
    let _ = writeln!(
        text,
        "## The worlds\n\nWhere a task can be lost, what lies beside the trap must be visited often: a \
         place and action {} times on average, {} times in a world of at most 25 places, and {} \
         times where nothing can be lost.\n\n{}",
        VISITS[1],
        VISITS[2],
        VISITS[0],
        setup(cases)
    );
    let _ = writeln!(
        text,
        "## Why steps cost a little of P\n\nProbabilities that were counted are known up to sampling: \
         of two ways that are equally safe chance makes one look safer, and it may be the longer one. \
         The table compares what P may give for fewer steps, on the same experience of the {lost} \
         cells whose task can be lost, and what that would cost who knows the world. A price that is the \
         same for each step is too high for long tasks and too low for short ones; so the price is for \
         all steps of the best policy together. Where it is too low, chance chooses the way; where it is \
         too high, safety is sold for speed.\n\n{}",
        alternatives(cases)
    );
    let _ = writeln!(
        text,
        "## Exploration\n\nAll {} cells, learned by chance and by coverage, with all starts and with \
         one, the last empty place.\n\n{}",
        cases.len(),
        explorations(cases)
    );
    text
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let (worlds, tasks) = (worlds(), tasks());
    let study = Study::new("tasks", &(SEEDS, VISITS, GAMMA, WAYS, EXPLORED, worlds.len()));
    let count = tasks.len();
    let cases = study.run((worlds.len() * count) as u64, |number| {
        let (world, task) = (number as usize / count, number as usize % count);
        case(&worlds[world], &*tasks[task])
    })?;
    study.publish(".md", &document(&cases))?;
    study.publish_lines(cases.iter().enumerate().map(|(number, case)| {
        let (world, task) = (worlds[number / count].name, tasks[number % count].formula().text());
        json!({"world": world, "task": task, "case": case})
    }))?;
    let all: Vec<[f64; 2]> = cases.iter().map(|case| worst(&case.learned)).collect();
    let over = |i: usize| all.iter().filter(|worst| worst[i] > BOUNDS[i]).count();
    assert!(over(0) == 0 && over(1) == 0, "{} and {} are over", over(0), over(1));
    Ok(study.finish()?)
}
