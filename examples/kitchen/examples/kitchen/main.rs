//! The kitchen of the paper's Section 5.2: six specifications of two tasks, and their composition,
//! learned by networks and judged by what a planner that sees everything and a scripted searcher
//! need.
//!
//! `cargo run --release -p tltl-kitchen --example kitchen` runs a part of it in some minutes and writes
//! to `target/kitchen`; with `--full` it runs all with five seeds (or `--seeds N`) and writes to
//! `docs/studies`. A run that is killed goes on where it was. `--redraw` draws the figures in
//! `docs/studies` again, from the curves and the episode that are recorded there.
//!
//! `--layout FILE` does all of that in another [kitchen](tltl_kitchen::format), and writes to
//! `target/kitchen/NAME`, where NAME is the file's. Task 1 is the apple into the fridge there, too; if
//! there is none, the first goal that has a start.

mod figure;
mod record;
mod report;
mod trial;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

use serde_json::json;
use tltl_examples::study::{Progress, Study};
use tltl_kitchen::strip;

use record::Record;
use report::Report;
use trial::{Budget, Experiment, Failure, Outcome};

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

    /// How much there is to do in a case, as [`Progress`] counts it.
    fn parts(&self, case: u64) -> u64 {
        match (case % self.per_seed()).checked_sub(1) {
            None => self.budget.of_composition(),
            Some(i) => self.budget.of_skill(self.specifications[i as usize].0),
        }
    }

    fn run(&self, trials: &Experiment, case: u64, progress: &Progress) -> Result<Outcome, String> {
        let (seed, which) = (case / self.per_seed(), case % self.per_seed());
        let outcome = match which.checked_sub(1) {
            None => trials.compose(seed, progress),
            Some(i) => trials.learn(self.specifications[i as usize], seed, progress),
        };
        outcome.map_err(|error| error.to_string())
    }
}

/// What the command line asks for.
#[derive(Debug, Default)]
struct Request {
    full: bool,
    seeds: Option<u64>,
    redraw: bool,
    layout: Option<PathBuf>,
}

const USAGE: &str = "usage: kitchen [--layout FILE] [--full [--seeds N] | --redraw], where FILE describes a kitchen";

impl Request {
    fn read(mut arguments: impl Iterator<Item = String>) -> Result<Self, String> {
        let mut request = Self::default();
        while let Some(argument) = arguments.next() {
            match argument.as_str() {
                "--full" => request.full = true,
                "--redraw" => request.redraw = true,
                "--layout" => request.layout = Some(arguments.next().ok_or(USAGE)?.into()),
                "--seeds" => {
                    let n = arguments.next().ok_or(USAGE)?;
                    let seeds = n.parse().ok().filter(|&n: &u64| n > 0);
                    request.seeds =
                        Some(seeds.ok_or(format!("`{n}` is no number of seeds, from 1"))?);
                }
                _ => return Err(USAGE.into()),
            }
        }
        let wrong = request.seeds.is_some() && !request.full || request.full && request.redraw;
        if wrong { Err(USAGE.into()) } else { Ok(request) }
    }

    fn plan(&self) -> Plan {
        if self.full { Plan::full(self.seeds.unwrap_or(5)) } else { Plan::quick() }
    }

    /// Where results go: what is committed belongs to a full study of the paper's kitchen.
    fn folder(&self) -> PathBuf {
        match &self.layout {
            Some(file) => {
                let name = file.file_stem().unwrap_or(file.as_os_str());
                Path::new("target/kitchen").join(name)
            }
            None if self.full || self.redraw => {
                Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/studies")
            }
            None => PathBuf::from("target/kitchen"),
        }
    }
}

fn main() -> ExitCode {
    match Request::read(env::args().skip(1)).map_err(Failure::from).and_then(|of| run(&of)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(request: &Request) -> Result<(), Failure> {
    let (plan, folder) = (request.plan(), request.folder());
    let trials = Experiment::new(plan.budget, request.layout.as_deref())?;
    if request.redraw {
        return draw(&trials, &folder);
    }
    let setup = (&plan.specifications, plan.budget, &request.layout, &trials.layout);
    let study = Study::at(folder.clone(), "kitchen", &setup).every(plan.per_seed());
    let results = study.run_in_parts(
        plan.cases(),
        |case| plan.parts(case),
        |case, progress| plan.run(&trials, case, progress),
    );
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
    let file = request.layout.as_ref().map(|file| file.display().to_string());
    study.publish(".md", &report.text(&trials, plan.seeds, file.as_deref()))?;
    for (name, content) in &results[0].shown {
        study.publish(name, content)?;
    }
    draw(&trials, &folder)?;
    Ok(study.finish()?)
}

/// Draws the figures in `folder` from what is recorded there.
fn draw(trials: &Experiment, folder: &Path) -> Result<(), Failure> {
    let read = |name| {
        let path = folder.join(name);
        fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
    };
    let record = Record::read(&read("kitchen.csv")?)?;
    let figure = figure::svg(&record, &report::references(trials)?, &trials.first_words());
    tltl::file::replace(&folder.join("kitchen.svg"), figure.as_bytes())?;
    let episode = trials.replay(&read("kitchen_episode.txt")?)?;
    let strip = strip::svg(&episode, &trials.layout);
    Ok(tltl::file::replace(&folder.join("kitchen_episode.svg"), strip.as_bytes())?)
}
