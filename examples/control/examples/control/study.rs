//! The tasks of two and three steps with ten seeds: curves with bands, and what each actor is worth.
//!
//! With the feature `rapier`, those of the rover are among them: `cargo run --release -p tltl-control
//! --features rapier --example control -- --study`. What is published is of all worlds, run so.
//!
//! What it writes: `docs/studies/control_{sac,td3,td3_long}.{svg,md,jsonl}`.

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
use crate::case::{BETWEEN, Case, FEW, Method, TRIALS};
use crate::worlds::{LONG, SHORT, Visitor, visit};

const SEEDS: u64 = 10;

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

/// What is published: the tasks, learned by a method.
struct Page {
    name: &'static str,
    method: Method,
    /// Tasks, and the environment steps of a training.
    tasks: &'static [(&'static [&'static str], u64)],
}

const PAGES: [Page; 3] = [
    Page { name: "control_sac", method: Method::Sac, tasks: &[(SHORT, 40_000), (LONG, 60_000)] },
    Page { name: "control_td3", method: Method::Td3, tasks: &[(SHORT, 60_000)] },
    Page { name: "control_td3_long", method: Method::Td3, tasks: &[(LONG, 150_000)] },
];

/// Learns the tasks by both methods, or by one.
pub(crate) fn run(method: Option<Method>) -> Result<(), Failure> {
    if method == Some(Method::Ddpg) {
        Err("no study is of `ddpg`; there are those of sac and td3")?;
    }
    let wanted = |page: &&Page| method.is_none_or(|method| page.method == method);
    PAGES.iter().filter(wanted).try_for_each(Page::run)
}

/// A task, and the environment steps of its training.
type Work = (&'static str, u64);

impl Page {
    fn run(&self) -> Result<(), Failure> {
        let of = |(tasks, steps): &(&'static [&'static str], u64)| {
            let steps = *steps;
            tasks.iter().map(move |task| (*task, steps))
        };
        let tasks: Vec<Work> = self.tasks.iter().flat_map(of).collect();
        if tasks.is_empty() {
            return Ok(());
        }
        let hands: Vec<Worth> =
            tasks.iter().map(|(task, _)| visit(task, Hand)).collect::<Result<_, _>>()?;
        let study = Study::new(self.name, &(&tasks, SEEDS, BETWEEN, FEW, TRIALS)).every(2);
        let learned = study.run_in_parts(
            tasks.len() as u64 * SEEDS,
            |case| tasks[(case / SEEDS) as usize].1,
            |case, progress| {
                let ((task, steps), seed) = (tasks[(case / SEEDS) as usize], case % SEEDS + 1);
                visit(task, Seed { method: self.method, seed, steps, progress })
                    .map_err(|error| error.to_string())
            },
        )?;
        let learned: Vec<Learned> = learned.into_iter().collect::<Result<_, _>>()?;
        let seeds: Vec<&[Learned]> = learned.chunks(SEEDS as usize).collect();
        let lines = learned.iter().enumerate().map(|(case, learned)| {
            let ((task, _), seed) = (tasks[case / SEEDS as usize], case as u64 % SEEDS + 1);
            json!({"task": task, "seed": seed, "learned": learned})
        });
        study.publish_lines(lines)?;
        study.publish(".svg", &figure(&tasks, &hands, &seeds))?;
        study.publish(".md", &self.text(&tasks, &hands, &seeds))?;
        Ok(study.finish()?)
    }

    /// The table.
    fn text(&self, tasks: &[Work], hands: &[Worth], seeds: &[&[Learned]]) -> String {
        let (name, method) = (self.name, self.method);
        let mut text = format!(
            "# Ten seeds of continuous control by {}\n\n![P(satisfied) over the environment steps of each \
             task]({name}.svg)\n\nEach actor is tried from {TRIALS} starts that no learner has seen. Robustness is the \
             mean over the trials of all seeds, in metres. [The study](control.md) says how they learn. Written by \
             `cargo run --release -p tltl-control --features rapier --example control -- --by {} --study`.\n\n\
             | task | steps of learning | P(satisfied), mean of {SEEDS} seeds | each seed | P(lost) | \
             steps: learned, by hand | robustness: learned, by hand |\n{}\n",
            method.to_string().to_uppercase(),
            method,
            "| --- | --- | --- | --- | --- | --- | --- |"
        );
        for (((task, steps), hand), seeds) in tasks.iter().zip(hands).zip(seeds) {
            let each =
                |of: fn(&Worth) -> f64| seeds.iter().map(|s| of(&s.last)).collect::<Vec<_>>();
            let satisfied = each(|worth| worth.satisfied);
            let shown: Vec<String> = satisfied.iter().map(f64::to_string).collect();
            let [fewest, most] = ends(&each(|worth| worth.steps.unwrap_or(f64::NAN)));
            let _ = writeln!(
                text,
                "| `{task}` | {steps} | {:.3} | {} | {:.3} | {fewest:.1} to {most:.1}, {:.1} | {:.3}, {:.3} |",
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
    method: Method,
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
        let mut learner = case.learner(self.method, self.seed)?;
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
fn figure(tasks: &[Work], hands: &[Worth], seeds: &[&[Learned]]) -> String {
    let chart = |(i, &(task, _)): (usize, &Work)| {
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
