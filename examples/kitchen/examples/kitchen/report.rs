//! What the trials have shown: the figure, the tables, the text.

use std::collections::BTreeMap;
use std::error::Error;
use std::fmt::Write as _;

use tltl::Monitor;
use tltl::env::Env;
use tltl::product::Product;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::planner::Planner;
use tltl_kitchen::searcher::Searcher;

use crate::figure::{self, Content, ROWS};
use crate::record::Record;
use crate::trial::{Curve, Experiment, Worth};

/// Starts that the planner and the searcher are tried on.
const STARTS: u64 = 500;

/// What others need for a problem, mean steps.
pub(crate) struct Reference {
    pub(crate) planner: f64,
    pub(crate) searcher: f64,
}

/// The references of all problems.
pub(crate) fn references(
    trials: &Experiment,
) -> Result<[Reference; 3], Box<dyn Error + Send + Sync>> {
    Ok([reference(trials, 0)?, reference(trials, 1)?, reference(trials, 2)?])
}

/// All curves, by name, one for each seed.
pub(crate) struct Report<'a> {
    curves: BTreeMap<&'a str, Vec<&'a Curve>>,
    references: &'a [Reference; 3],
}

impl<'a> Report<'a> {
    pub(crate) fn new(
        results: impl IntoIterator<Item = &'a Curve>,
        references: &'a [Reference; 3],
    ) -> Self {
        let mut curves: BTreeMap<&str, Vec<&Curve>> = BTreeMap::new();
        results.into_iter().for_each(|curve| curves.entry(&curve.name).or_default().push(curve));
        Self { curves, references }
    }

    /// What the figure shows.
    pub(crate) fn record(&self) -> Record {
        Record::new(&self.curves)
    }

    /// Mean and range of the last policies' `of`.
    fn last(&self, name: &str, of: fn(&Worth) -> f64) -> Option<[f64; 3]> {
        let values: Vec<f64> = self.curves.get(name)?.iter().map(|curve| of(&curve.last)).collect();
        let sum: f64 = values.iter().sum();
        let low = values.iter().copied().fold(f64::MAX, f64::min);
        let high = values.iter().copied().fold(f64::MIN, f64::max);
        Some([sum / values.len() as f64, low, high])
    }

    /// The tables, and what the paper saw beside what is seen here. In another kitchen than the paper's,
    /// `file` says which.
    pub(crate) fn text(&self, trials: &Experiment, seeds: u64, file: Option<&str>) -> String {
        let mut text = match file {
            None => format!("{HEAD}{IN_PAPER}{METHOD}{WRITTEN}"),
            // The notes are of the paper's kitchen.
            Some(file) => {
                let method = METHOD.replace(" ([the reasons](kitchen_notes.md))", "");
                format!("{HEAD}{}{method}", in_other(trials, file))
            }
        };
        let _ = write!(
            text,
            "\n\n## Results\n\nSeeds: {seeds}. The mean, and in brackets the range over the seeds.\n\n"
        );
        let rows = ROWS.iter().zip(self.references).enumerate();
        for (i, (Content { curves, .. }, reference)) in rows {
            let title = figure::title(i, &trials.first_words());
            let Reference { planner, searcher } = reference;
            let _ = writeln!(
                text,
                "### {title}\n\nThe planner, which sees everything, needs {planner:.2} steps; the searcher, \
                 which sees what the agent sees, {searcher:.2}.\n\n| | task success | action success | \
                 mean length | against the searcher |\n| --- | --- | --- | --- | --- |"
            );
            let run = curves.iter().filter(|(name, _)| self.curves.contains_key(name));
            for (name, _) in run {
                let share = |of| {
                    self.last(name, of).map_or(String::new(), |v| {
                        let [mean, low, high] = v.map(|v| 100.0 * v);
                        format!("{mean:.1} % ({low:.1}–{high:.1})")
                    })
                };
                let [length, low, high] = self.last(name, |w| w.length).unwrap_or_default();
                let _ = writeln!(
                    text,
                    "| {name} | {} | {} | {length:.2} ({low:.2}–{high:.2}) | {:.2} |",
                    share(|w| w.success),
                    share(|w| w.actions),
                    length / searcher
                );
            }
            text.push('\n');
        }
        if file.is_none() {
            self.compare(&mut text);
        }
        text
    }

    fn compare(&self, text: &mut String) {
        text.push_str("## What the paper saw, and what is seen here\n\n| the paper's Figure 3 | here |\n| --- | --- |\n");
        for (seen, names) in CLAIMS {
            let of = |name: &&str| {
                let success = self.last(name, |w| w.success)?;
                let actions = self.last(name, |w| w.actions)?;
                let length = self.last(name, |w| w.length)?;
                Some(format!(
                    "{name} {:.0} %, {:.1} steps, {:.1} % of actions succeed",
                    100.0 * success[0],
                    length[0],
                    100.0 * actions[0]
                ))
            };
            let here: Vec<String> = names.iter().filter_map(of).collect();
            let here = if here.is_empty() { "not run".to_owned() } else { here.join("; ") };
            let _ = writeln!(text, "| {seen} | {here} |");
        }
    }
}

/// What the paper says of its figure, and the curves that speak to it.
const CLAIMS: [(&str, &[&str]); 6] = [
    ("more prior knowledge, higher success", &["φ1.1", "φ1.2", "φ1.3"]),
    ("φ1.1 and φ1.1* fail", &["φ1.1", "φ1.1*"]),
    (
        "the penalty raises action success and shortens episodes",
        &["φ1.3", "φ1.3*", "φ2.3", "φ2.3*"],
    ),
    ("task 2 is less successful and much longer than task 1", &["φ1.3*", "φ2.3*"]),
    ("c1 is decent, c2 adds little, c3 adds much", &["c1", "c2", "c3"]),
    ("all beat learning from scratch on the same budget", &["c1", "c3", "from scratch"]),
];

const HEAD: &str = "# The kitchen\n\n\
![Success, action success and length of both tasks and of their composition](kitchen.svg)\n\n\
The curves as numbers: [kitchen.csv](kitchen.csv). An episode of the composed policy: [as a table](kitchen_episode.txt), [as pictures](kitchen_episode.svg).\n\n";

const IN_PAPER: &str = "\
This study repeats the paper's main experiment (Section 5.2, Figure 3) in an exact simulator with \
17 objects, 39 receptacles, 62 actions and hidden objects. The paper used AI2-THOR, and its \
specifications are lost with its supplement. The documentation of `tltl_kitchen` says what is \
known and what is reconstructed; the formulas are in `examples/kitchen/tasks/kitchen.tltl`. A \
star marks a penalty of 0.1 for each failed action.\n\n";

const METHOD: &str = "\
The learner is double DQN with prioritized replay and PopArt, with 2×128 units and one update \
every two steps. Each step updates the heads of all automaton states; in task 2 it is also \
relabelled with other goals. The network sees what the agent has observed, relative to the goal, \
and the public rules: which receptacles may hold which objects, and where the agent must look. \
Each point of a curve is the mean of 50 greedy episodes, with a band of one standard error over \
the seeds; each entry of a table is the mean of 500 (250 for the composition). All these episodes \
start at random states that were not trained on. The composition learns from the experience of \
the skills, without a step in the kitchen: c1 is their normalised sum, `max` their maximum, c2 \
the compensated sum, and c3 the whole of Algorithm 2, with advantage learning in both steps ([the \
reasons](kitchen_notes.md)). Learning from scratch has as many updates, with one environment step \
for each. An episode is cut at 100 steps in task 1 and at 200 elsewhere, and counts with that \
length.";

const WRITTEN: &str =
    " Written by `cargo run --release -p tltl-kitchen --example kitchen -- --full`.";

/// Which kitchen it is, where it is not the paper's.
fn in_other(trials: &Experiment, file: &str) -> String {
    let layout = &trials.layout;
    format!(
        "This study runs the paper's experiment in the kitchen of `{file}`: {} objects, {} receptacles, {} \
         actions. Task 1 asks for {}. A star marks a penalty of 0.1 for each failed action.\n\n",
        layout.objects(),
        layout.receptacles(),
        layout.actions(),
        trials.first_words()
    )
}

fn reference(
    trials: &Experiment,
    problem: usize,
) -> Result<Reference, Box<dyn Error + Send + Sync>> {
    let tasks = [trials.specification(0, 2), trials.specification(1, 2)];
    let both = Product::conjunction(&[&*tasks[0], &*tasks[1]]);
    let task: &dyn Monitor<_> = if problem == 2 { &both } else { &*tasks[problem] };
    let searcher = Searcher::new(trials.layout.clone(), (problem == 2).then_some(trials.first));
    let mut kitchen = trials.kitchen(problem)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3_000);
    let (mut planned, mut searched) = (0, 0);
    for _ in 0..STARTS {
        let mut known = kitchen.reset(&mut rng);
        let told = known.goal();
        let goals = if problem == 2 { vec![trials.first, told] } else { vec![told] };
        let plan = Planner::new(&trials.layout, task, &goals).plan(kitchen.truth())?;
        planned += plan.ok_or("a start without a plan")?.len();
        let mut q = task.next(0, &known)?;
        while !task.is_terminal(q) && kitchen.steps() < kitchen.horizon_steps() {
            known = kitchen.act(searcher.action(&known)).state;
            q = task.next(q, &known)?;
        }
        searched += kitchen.steps();
    }
    let mean = |n: f64| n / STARTS as f64;
    Ok(Reference { planner: mean(planned as f64), searcher: mean(f64::from(searched)) })
}
