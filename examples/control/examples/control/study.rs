//! The tasks of two and three steps with ten seeds: curves with bands, and what each actor is worth.
//!
//! With the feature `rapier`, those of the rover are among them: `cargo run --release -p tltl-control
//! --features rapier --example control -- --study`. What is published is of all worlds, run so.
//!
//! What it writes: `docs/studies/control_seeds.{svg,md,jsonl}`, and `control_long.{svg,md,jsonl}` of what takes
//! longer to learn.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::json;
use tltl::env::ContinuousEnv;
use tltl::network::Features;
use tltl::robustness::Predicates;
use tltl_control::judge::Trialled;
use tltl_examples::chart::{self, Axis, Chart, Curve, Point, Row};
use tltl_examples::study::{Progress, Study, mean};

use crate::Failure;
use crate::case::{Case, STEPS, TRIALS};
use crate::worlds::{LONG, SHORT, Visitor, visit};

const SEEDS: u64 = 10;

/// Environment steps of a training where [`STEPS`] are not enough.
const MORE_STEPS: u64 = 150_000;

/// Environment steps between two points of a curve.
const BETWEEN: u64 = 5_000;

/// Trials for a point of a curve.
const FEW: u64 = 50;

/// What a controller is worth.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
struct Worth {
    satisfied: f64,
    lost: f64,
    /// The mean steps where the task is satisfied.
    steps: Option<f64>,
    /// The mean robustness of the episodes, in metres.
    robustness: f64,
}

impl Worth {
    fn of<S>(tried: &Trialled<S>) -> Self {
        let Trialled { estimate, robustness, .. } = tried;
        Self {
            satisfied: estimate.satisfied.mean,
            lost: estimate.lost.mean,
            steps: estimate.steps.map(|steps| steps.mean),
            robustness: mean(robustness),
        }
    }
}

/// What a seed comes to.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Learned {
    /// After each [`BETWEEN`] steps, in [`FEW`] trials.
    curve: Vec<Worth>,
    /// At the end, in [`TRIALS`] trials.
    last: Worth,
}

/// Learns the tasks, or one.
pub(crate) fn run(task: Option<&str>) -> Result<(), Failure> {
    let named = task.as_ref().map(core::slice::from_ref);
    if task.is_none_or(|task| !LONG.contains(&task)) {
        Group { name: "control_seeds", tasks: named.unwrap_or(SHORT), steps: STEPS }.run()?;
    }
    if task.is_none_or(|task| LONG.contains(&task)) && !LONG.is_empty() {
        Group { name: "control_long", tasks: named.unwrap_or(LONG), steps: MORE_STEPS }.run()?;
    }
    Ok(())
}

/// Tasks that are learned for as long as each other.
struct Group<'a> {
    name: &'static str,
    tasks: &'a [&'a str],
    steps: u64,
}

impl Group<'_> {
    fn run(&self) -> Result<(), Failure> {
        let &Self { name, tasks, steps } = self;
        // A name that is unknown is told before anything is learned.
        let hands: Vec<Worth> =
            tasks.iter().map(|task| visit(task, Hand)).collect::<Result<_, _>>()?;
        let study = Study::new(name, &(tasks, SEEDS, steps, BETWEEN, FEW, TRIALS)).every(2);
        let learned = study.run_in_parts(
            tasks.len() as u64 * SEEDS,
            |_| steps,
            |case, progress| {
                let (task, seed) = (tasks[(case / SEEDS) as usize], case % SEEDS + 1);
                visit(task, Seed { seed, steps, progress }).map_err(|error| error.to_string())
            },
        )?;
        let learned: Vec<Learned> = learned.into_iter().collect::<Result<_, _>>()?;
        let seeds: Vec<&[Learned]> = learned.chunks(SEEDS as usize).collect();
        let lines = learned.iter().enumerate().map(|(case, learned)| {
            let (task, seed) = (tasks[case / SEEDS as usize], case as u64 % SEEDS + 1);
            json!({"task": task, "seed": seed, "learned": learned})
        });
        study.publish_lines(lines)?;
        study.publish(".svg", &figure(tasks, &hands, &seeds))?;
        study.publish(".md", &self.text(&hands, &seeds))?;
        Ok(study.finish()?)
    }

    /// The table.
    fn text(&self, hands: &[Worth], seeds: &[&[Learned]]) -> String {
        let &Self { name, tasks, steps } = self;
        let mut text = format!(
            "# Ten seeds of continuous control\n\n![P(satisfied) over the environment steps of each \
             task]({name}.svg)\n\nEach actor has learned for {steps} steps and is tried from \
             {TRIALS} starts that no learner has seen. Robustness is the mean over the trials of all seeds, \
             in metres. [The study](control.md) says how they learn. Written by `cargo run --release -p \
             tltl-control --features rapier --example control -- --study`.\n\n| task | P(satisfied), mean of {SEEDS} seeds | \
             each seed | P(lost) | steps: learned, by hand | robustness: learned, by hand |\n{}\n",
            "| --- | --- | --- | --- | --- | --- |"
        );
        for ((task, hand), seeds) in tasks.iter().zip(hands).zip(seeds) {
            let each =
                |of: fn(&Worth) -> f64| seeds.iter().map(|s| of(&s.last)).collect::<Vec<_>>();
            let satisfied = each(|worth| worth.satisfied);
            let shown: Vec<String> = satisfied.iter().map(f64::to_string).collect();
            let [fewest, most] = ends(&each(|worth| worth.steps.unwrap_or(f64::NAN)));
            let _ = writeln!(
                text,
                "| `{task}` | {:.3} | {} | {:.3} | {fewest:.1} to {most:.1}, {:.1} | {:.3}, {:.3} |",
                mean(&satisfied),
                shown.join(", "),
                mean(&each(|worth| worth.lost)),
                hand.steps.unwrap_or(f64::NAN),
                mean(&each(|worth| worth.robustness)),
                hand.robustness,
            );
        }
        text
    }
}

/// The worth of the controller written by hand.
struct Hand;

impl Visitor for Hand {
    type Output = Worth;

    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<Worth, Failure>
    where
        E: ContinuousEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        Ok(Worth::of(&case.hand()?))
    }
}

/// One seed.
struct Seed<'a> {
    seed: u64,
    steps: u64,
    progress: &'a Progress,
}

impl Visitor for Seed<'_> {
    type Output = Learned;

    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<Learned, Failure>
    where
        E: ContinuousEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        let mut learner = case.learner(self.seed)?;
        let mut curve = Vec::new();
        for steps in (BETWEEN..=self.steps).step_by(BETWEEN as usize) {
            learner.train(&mut case.world.clone(), steps)?;
            curve.push(Worth::of(&case.tried(&mut learner, FEW)?));
            self.progress.add(BETWEEN);
        }
        Ok(Learned { curve, last: Worth::of(&case.tried(&mut learner, TRIALS)?) })
    }
}

/// A chart for each task, two in a row: the mean of the seeds in a band from the least to the most.
fn figure(tasks: &[&str], hands: &[Worth], seeds: &[&[Learned]]) -> String {
    let chart = |(i, &task): (usize, &&str)| {
        let point = |j: usize| {
            let values: Vec<f64> = seeds[i].iter().map(|seed| seed.curve[j].satisfied).collect();
            let [low, high] = ends(&values);
            Point { x: ((j as u64 + 1) * BETWEEN) as f64, y: mean(&values), low, high }
        };
        Chart {
            title: task.to_owned(),
            axis: Axis::Share,
            curves: vec![Curve {
                name: format!("learned, {SEEDS} seeds"),
                points: (0..seeds[i][0].curve.len()).map(point).collect(),
            }],
            levels: vec![(hands[i].satisfied, "controller written by hand".to_owned())],
        }
    };
    let charts: Vec<Chart> = tasks.iter().enumerate().map(chart).collect();
    let title = "P(satisfied) while an actor learns";
    let row = |(i, charts): (usize, &[Chart])| Row {
        title: if i == 0 { title.to_owned() } else { String::new() },
        x: "environment steps".to_owned(),
        charts: charts.to_vec(),
    };
    let rows: Vec<Row> = charts.chunks(2).enumerate().map(row).collect();
    let remarks =
        format!("Lines: means of {FEW} trials each; bands: from the worst seed to the best.");
    chart::svg(title, &rows, &[remarks])
}

/// The least and the largest.
fn ends(values: &[f64]) -> [f64; 2] {
    let over = |f: fn(f64, f64) -> f64, from| values.iter().copied().fold(from, f);
    [over(f64::min, f64::INFINITY), over(f64::max, f64::NEG_INFINITY)]
}
