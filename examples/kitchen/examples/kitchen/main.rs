//! The kitchen of the paper's Section 5.2: six specifications of two tasks, and their composition,
//! learned by networks and judged by what a planner that sees everything and a scripted searcher
//! need.
//!
//! `cargo run --release -p tltl-kitchen --example kitchen` runs a part of it in some minutes and writes
//! to `target/kitchen`; with `--full` it runs all with five seeds (or `--seeds N`) and writes to
//! `docs/studies`. A run that is killed goes on where it was. `--redraw` draws the figures in
//! `docs/studies` again, from the curves and the episode that are recorded there.

mod figure;
mod record;
mod report;
mod trial;

use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};

use serde_json::json;
use tltl_examples::study::Study;
use tltl_kitchen::strip;

use record::Record;
use report::Report;
use trial::{Budget, Experiment, Outcome};

/// A specification: task and number, both from 0, and whether failed actions cost something.
type Specification = (usize, usize, bool);

/// What is run.
#[derive(Debug)]
struct Plan {
    specifications: Vec<Specification>,
    seeds: u64,
    budget: Budget,
}

impl Plan {
    /// Some minutes: the sparse specification against the elaborate one, and the composition.
    fn quick() -> Self {
        let budget = Budget { steps: [30_000, 110_000], updates: [1_000, 9_000], points: 10 };
        Self { specifications: vec![(0, 0, true)], seeds: 1, budget }
    }

    /// Everything of the paper's Figure 3.
    fn full(seeds: u64) -> Self {
        let budget = Budget { steps: [60_000, 200_000], updates: [5_000, 25_000], points: 10 };
        let all = [0, 1].into_iter().flat_map(|task| {
            [0, 1, 2].into_iter().flat_map(move |j| [(task, j, false), (task, j, true)])
        });
        // φ1.3* and φ2.3* are learned to be composed.
        let others = all.filter(|&(_, j, starred)| (j, starred) != (2, true));
        Self { specifications: others.collect(), seeds, budget }
    }

    /// All of a seed come together, the composition first, so that more seeds can be added later.
    fn cases(&self) -> u64 {
        self.seeds * self.per_seed()
    }

    fn per_seed(&self) -> u64 {
        1 + self.specifications.len() as u64
    }

    fn run(&self, trials: &Experiment, case: u64) -> Result<Outcome, String> {
        let (seed, which) = (case / self.per_seed(), case % self.per_seed());
        let outcome = match which.checked_sub(1) {
            None => trials.compose(seed),
            Some(i) => trials.learn(self.specifications[i as usize], seed),
        };
        outcome.map_err(|error| error.to_string())
    }
}

fn main() -> Result<(), Box<dyn Error + Send + Sync>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (plan, folder) = match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => (Plan::quick(), PathBuf::from("target/kitchen")),
        ["--full"] => (Plan::full(5), studies()),
        ["--full", "--seeds", n] => match n.parse() {
            Ok(seeds) if seeds > 0 => (Plan::full(seeds), studies()),
            _ => return Err(format!("`{n}` is no number of seeds, from 1").into()),
        },
        ["--redraw"] => return draw(&Experiment::new(Plan::full(5).budget)?, &studies()),
        _ => return Err("usage: kitchen [--full [--seeds N] | --redraw]".into()),
    };
    let trials = Experiment::new(plan.budget)?;
    let study = Study::at(folder.clone(), "kitchen", &(&plan.specifications, plan.budget))
        .every(plan.per_seed());
    let results = study.run(plan.cases(), |case| plan.run(&trials, case));
    let results = results.map_err(|error| error.to_string())?;
    let results = results.into_iter().take(plan.cases() as usize);
    let results: Vec<Outcome> = results.collect::<Result<_, _>>()?;
    let lines = results.iter().enumerate().flat_map(|(case, outcome)| {
        let seed = case as u64 / plan.per_seed();
        outcome.curves.iter().map(move |curve| json!({"seed": seed, "curve": curve}))
    });
    study.publish_lines(lines)?;
    let references = report::references(&trials)?;
    let curves = results.iter().flat_map(|outcome| &outcome.curves);
    let report = Report::new(curves, &references);
    study.publish(".csv", &report.record().csv()?)?;
    study.publish(".md", &report.text(plan.seeds))?;
    for (name, content) in &results[0].shown {
        study.publish(name, content)?;
    }
    draw(&trials, &folder)?;
    Ok(study.finish()?)
}

/// Draws the figures in `folder` from what is recorded there.
fn draw(trials: &Experiment, folder: &Path) -> Result<(), Box<dyn Error + Send + Sync>> {
    let read = |name| fs::read_to_string(folder.join(name));
    let record = Record::read(&read("kitchen.csv")?)?;
    let figure = figure::svg(&record, &report::references(trials)?);
    tltl::file::replace(&folder.join("kitchen.svg"), figure.as_bytes())?;
    let episode = trials.replay(&read("kitchen_episode.txt")?)?;
    let strip = strip::svg(&episode, &trials.layout);
    Ok(tltl::file::replace(&folder.join("kitchen_episode.svg"), strip.as_bytes())?)
}

/// Where the studies are kept.
fn studies() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/studies")
}
