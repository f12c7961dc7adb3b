//! Study (b): learning curves of φ₁ = ◇a ∧ ◇b on the paper's grid, with 95 % confidence bands over 20
//! seeds.
//!
//! `cargo run --release --example study_curves` writes `docs/studies/curves.{svg,md,jsonl}`.

use std::fmt::Write as _;

use serde_json::json;
use tltl::estimate::Interval;
use tltl::learn::{Observation, TerminalReward, TrajectoryLearner};
use tltl::prelude::*;
use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};
use tltl_examples::study::{GRID, PAPER, Study, at, capped_steps};

const SEEDS: u64 = 20;
const HORIZON: u64 = 200;
const STEPS: [u64; 11] =
    [1_000, 2_000, 5_000, 10_000, 20_000, 50_000, 100_000, 200_000, 340_000, 700_000, 1_000_000];
const METHODS: [&str; 5] = [
    "paper's recipe",
    "default",
    "terminal robustness, sees q",
    "terminal robustness, no q",
    "satisfaction, no q",
];

/// What the legend does not say.
const EXPLAINED: &str = "q: the automaton's state. Default: what was seen, solved. Terminal \
                         robustness, satisfaction: paid once, at the end.";

/// Expected steps, cut at the horizon, after each number of training steps.
fn curve(method: usize, seed: u64) -> Vec<f64> {
    let (a, b) = (at(PAPER[0]), at(PAPER[1]));
    let formula = tltl! { F a && F b };
    let task = Labelled::of_model(&GRID, &formula).expect("numbers");
    let mut env = ModelEnv::new(GRID).expect("a model");
    let problem = Problem::new(env.dynamics(), &task).expect("the same grid");
    let judge = |policy: &Policy| capped_steps(&problem, policy, HORIZON);
    let settings = if method == 1 { Settings::default() } else { Settings::paper() };
    if method < 2 {
        let mut learner = Learner::new(&task, settings, seed);
        let after = |steps: &u64| {
            learner.train(&mut env, *steps).expect("the same grid");
            judge(&learner.policy())
        };
        return STEPS.iter().map(after).collect();
    }
    let (paid, sees) = match method {
        2 => (TerminalReward::Robustness, Observation::WorldAndAutomaton),
        3 => (TerminalReward::Robustness, Observation::World),
        _ => (TerminalReward::Satisfaction, Observation::World),
    };
    let rewards = Rewards::progress().with_bound(10.0).expect("a bound");
    let mut learner =
        TrajectoryLearner::new(&task, settings.with_rewards(rewards), paid, sees, seed);
    let after = |steps: &u64| {
        learner.train(&mut env, &formula, *steps).expect("numbers");
        judge(&learner.policy())
    };
    STEPS.iter().map(after).collect()
}

fn points(runs: &[Vec<f64>]) -> Vec<Point> {
    let at = |(i, &steps): (usize, &u64)| {
        let values: Vec<f64> = runs.iter().map(|run| run[i]).collect();
        let Interval { mean, low, high } = Interval::of(&values, 0.95).expect("many seeds");
        Point { x: steps as f64, y: mean, low, high }
    };
    STEPS.iter().enumerate().map(at).collect()
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let study = Study::new("curves", &(METHODS, SEEDS, HORIZON, STEPS));
    let runs = study
        .run(METHODS.len() as u64 * SEEDS, |case| curve((case / SEEDS) as usize, case % SEEDS))?;
    let all: Vec<&[Vec<f64>]> = runs.chunks(SEEDS as usize).collect();
    let name = |i: usize| METHODS[i].to_owned();
    let curves: Vec<Curve> =
        (0..all.len()).map(|i| Curve { name: name(i), points: points(all[i]) }).collect();
    let mut table = "| environment steps |".to_owned();
    METHODS.iter().for_each(|method| table.push_str(&format!(" {method} |")));
    let _ = writeln!(table, "\n| --- |{}", " --- |".repeat(METHODS.len()));
    for (i, steps) in STEPS.iter().enumerate() {
        let _ = write!(table, "| {steps} |");
        for curve in &curves {
            let Point { y, low, high, .. } = curve.points[i];
            let _ = write!(table, " {y:.3} ± {:.3} |", (high - low) / 2.0);
        }
        table.push('\n');
    }
    let lines = runs.iter().enumerate().map(|(case, steps)| {
        let (method, seed) = (METHODS[case / SEEDS as usize], case as u64 % SEEDS);
        json!({"method": method, "seed": seed, "at": STEPS, "steps": steps})
    });
    let title = "F a && F b on the paper's grid".to_owned();
    let chart = Chart {
        title: format!("expected steps of the greedy policy, cut at {HORIZON}"),
        axis: Axis::Logarithmic(10.0, 250.0),
        curves,
        levels: vec![(12.2002, "optimum, 12.2002".to_owned())],
    };
    let x = "environment steps of training".to_owned();
    let row = Row { title: title.clone(), x, charts: vec![chart] };
    let bands = format!("Lines: means over {SEEDS} seeds; bands: their 95 % confidence intervals.");
    let remarks = [bands, EXPLAINED.to_owned()];
    let text = format!(
        "# Learning curves\n\n![Learning curves](curves.svg)\n\nThe curves show the expected \
         steps of the greedy policy on `F a && F b`, computed exactly for each policy, with \
         episodes cut at {HORIZON}. They are means over {SEEDS} seeds with Student's 95 % \
         interval. The default settings explore by coverage, the others at random. What the default \
         learns is the world as it was seen, solved; the others hand out the greedy policy of their \
         table. The optimum is 12.2002. Written by `cargo run \
         --release --example study_curves`.\n\n{table}"
    );
    study.publish(".svg", &chart::svg(&title, &[row], &remarks))?;
    study.publish(".md", &text)?;
    study.publish_lines(lines)?;
    Ok(study.finish()?)
}
