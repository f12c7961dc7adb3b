//! What the studies share: layouts, families of specifications, judgement, where results go.

use std::error::Error;
use std::fmt::Debug;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::{fs, io};

use indicatif::{ProgressBar, ProgressStyle};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use tltl::learn::seeds;
use tltl::prelude::*;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::End;
use tltl::{checkpoint, file};

use crate::grid::{Cell, Grid};

/// A task on the grid.
pub type GridTask = Box<dyn Monitor<Cell> + Send + Sync>;

/// The paper's goal cells.
pub const PAPER: [Cell; 3] = [Cell { x: 2, y: 2 }, Cell { x: 5, y: 5 }, Cell { x: 2, y: 7 }];

/// A predicate: positive at one cell, and the less the farther away.
pub fn at(goal: Cell) -> impl Fn(&Cell) -> f64 + Copy + Send + Sync {
    move |s| f64::from(1 - (s.x - goal.x).abs().max((s.y - goal.y).abs()))
}

/// Three different cells of the paper's grid, by a seed.
#[must_use]
pub fn layout(seed: u64) -> [Cell; 3] {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut cell = || Cell { x: (rng.next_u32() % 8) as i32, y: (rng.next_u32() % 10) as i32 };
    loop {
        let cells = [cell(), cell(), cell()];
        if cells[0] != cells[1] && cells[0] != cells[2] && cells[1] != cells[2] {
            return cells;
        }
    }
}

/// Two skills that are to be composed, and how they are written.
pub struct Family {
    /// The skills' formulas.
    pub formulas: [&'static str; 2],
    /// The skills for goal cells a, b, c.
    pub skills: fn([Cell; 3]) -> [GridTask; 2],
}

/// The five families of specifications; the last three have traps.
pub const FAMILIES: [Family; 5] = [
    Family {
        formulas: ["F a && F b", "F c"],
        skills: |[a, b, c]| {
            let (a, b, c) = (at(a), at(b), at(c));
            [Box::new(tltl! { F a && F b }), Box::new(tltl! { F c })]
        },
    },
    Family {
        formulas: ["a T b", "F c"],
        skills: |[a, b, c]| {
            let (a, b, c) = (at(a), at(b), at(c));
            [Box::new(tltl! { a T b }), Box::new(tltl! { F c })]
        },
    },
    Family {
        formulas: ["!c U a", "F b"],
        skills: |[a, b, c]| {
            let (a, b, c) = (at(a), at(b), at(c));
            [Box::new(tltl! { !c U a }), Box::new(tltl! { F b })]
        },
    },
    Family {
        formulas: ["!c U a", "!c U b"],
        skills: |[a, b, c]| {
            let (a, b, c) = (at(a), at(b), at(c));
            [Box::new(tltl! { !c U a }), Box::new(tltl! { !c U b })]
        },
    },
    Family {
        formulas: ["!b U a", "!c U b"],
        skills: |[a, b, c]| {
            let (a, b, c) = (at(a), at(b), at(c));
            [Box::new(tltl! { !b U a }), Box::new(tltl! { !c U b })]
        },
    },
];

/// Expected steps of a policy where episodes are cut at `horizon`, over the starts, `s_0` read: the
/// one number that a policy has that never succeeds.
#[must_use]
pub fn capped_steps(problem: &Problem, policy: &Policy, horizon: u64) -> f64 {
    let (dynamics, task) = (problem.dynamics(), problem.task());
    let mut now = vec![0.0; task.pairs()];
    for (s, p) in dynamics.starts().iter().enumerate() {
        now[task.pair(task.start(s), s)] += p;
    }
    let mut steps = 0.0;
    for _ in 0..horizon {
        let mut then = vec![0.0; task.pairs()];
        for q in 0..task.automaton_states() {
            // Where the task is satisfied, time stands still; where it is lost, it goes on.
            if task.end(q) == Some(End::Accepted) {
                continue;
            }
            for s in 0..task.states() {
                let p = now[task.pair(q, s)];
                if p > 0.0 {
                    steps += p;
                    for (to, chance) in dynamics.outcomes(s, policy.act(q, s)) {
                        then[task.pair(task.next(q, to), to)] += p * chance;
                    }
                }
            }
        }
        now = then;
    }
    steps
}

/// The grid of all studies.
pub const GRID: Grid = Grid::PAPER;

/// A study: cases worked on one after the other, kept as they are done, and what is published.
///
/// After every few cases the results so far are a checkpoint beside what will be published: a study
/// that is killed at any point, by `kill -9` too, goes on where it was and ends as if it had not
/// been. A checkpoint of a study that was set up otherwise is refused.
pub struct Study {
    name: &'static str,
    folder: PathBuf,
    setup: String,
    interval: u64,
}

/// What is done of a study.
#[derive(Serialize, Deserialize)]
struct Done<T> {
    setup: String,
    results: Vec<T>,
}

impl Study {
    /// The study `name`, published under `docs/studies`; `setup` is all that its results depend on
    /// beside the library.
    #[must_use]
    pub fn new(name: &'static str, setup: &impl Debug) -> Self {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/studies");
        Self::at(folder, name, setup)
    }

    /// The same, published elsewhere.
    #[must_use]
    pub fn at(folder: PathBuf, name: &'static str, setup: &impl Debug) -> Self {
        Self { name, folder, setup: format!("{setup:?}"), interval: 8 }
    }

    /// The same, with a checkpoint after every `cases` cases: fewer than 8 where each takes long.
    #[must_use]
    pub fn every(self, cases: u64) -> Self {
        Self { interval: cases.max(1), ..self }
    }

    /// Where the checkpoint is while the study goes on.
    #[must_use]
    pub fn checkpoint(&self) -> PathBuf {
        self.folder.join(format!("{}.checkpoint", self.name))
    }

    /// The results of cases `0..count`, in order; those that are done already come from the
    /// checkpoint, the others from `work`, on the cores that there are. A progress bar shows how
    /// far it is, silent in a pipe.
    ///
    /// # Errors
    /// If the checkpoint cannot be written, is broken, or is of another study or setup.
    pub fn run<T: Serialize + DeserializeOwned + Send>(
        &self,
        count: u64,
        work: impl Fn(u64) -> T + Sync,
    ) -> Result<Vec<T>, Box<dyn Error>> {
        self.run_in_parts(
            count,
            |_| 1,
            |case, progress| {
                let result = work(case);
                progress.add(1);
                result
            },
        )
    }

    /// The same where a case takes long: each has `parts`, and `work` says as they are done.
    ///
    /// # Errors
    /// As [`Self::run`].
    pub fn run_in_parts<T: Serialize + DeserializeOwned + Send>(
        &self,
        count: u64,
        parts: impl Fn(u64) -> u64,
        work: impl Fn(u64, &Progress) -> T + Sync,
    ) -> Result<Vec<T>, Box<dyn Error>> {
        fs::create_dir_all(&self.folder)?;
        let (path, kind) = (self.checkpoint(), format!("study-{}", self.name));
        let mut done = self.resume(&path, &kind)?;
        let before = (0..count.min(done.results.len() as u64)).map(&parts).sum();
        let progress = Progress::new((0..count).map(&parts).sum(), before)?;
        while (done.results.len() as u64) < count {
            let from = done.results.len() as u64;
            let cases = from..count.min(from + self.interval);
            done.results.extend(seeds(cases, |case| work(case, &progress)));
            checkpoint::write(&path, &kind, &serde_json::to_vec(&done)?)?;
        }
        progress.0.finish_and_clear();
        Ok(done.results)
    }

    fn resume<T: DeserializeOwned>(
        &self,
        path: &Path,
        kind: &str,
    ) -> Result<Done<T>, Box<dyn Error>> {
        let Some(content) = checkpoint::read(path, kind)? else {
            return Ok(Done { setup: self.setup.clone(), results: Vec::new() });
        };
        let done: Done<T> = serde_json::from_slice(&content)?;
        if done.setup == self.setup {
            return Ok(done);
        }
        let (path, found, expected) = (path.display(), &done.setup, &self.setup);
        Err(format!("{path}: of a study of {found}, not of {expected}; remove it to begin anew")
            .into())
    }

    /// Writes a result, `NAME` and what is added to it, and says where.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn publish(&self, added: &str, content: &str) -> io::Result<()> {
        let name = format!("{}{added}", self.name);
        let path = self.folder.join(&name);
        file::replace(&path, content.as_bytes())?;
        writeln!(io::stdout(), "{}", path.display())
    }

    /// Writes the results as JSON Lines, one object a line.
    ///
    /// # Errors
    /// If they cannot be written.
    pub fn publish_lines(&self, lines: impl IntoIterator<Item = Value>) -> io::Result<()> {
        let lines: String = lines.into_iter().map(|line| format!("{line}\n")).collect();
        self.publish(".jsonl", &lines)
    }

    /// Ends the study: all is published, and the checkpoint goes.
    ///
    /// # Errors
    /// If the checkpoint cannot be removed.
    pub fn finish(self) -> io::Result<()> {
        fs::remove_file(self.checkpoint())
    }
}

/// How far a study is: on the terminal in one line, with its rate and the time that is left; elsewhere
/// nothing.
pub struct Progress(ProgressBar);

impl Progress {
    fn new(parts: u64, done: u64) -> Result<Self, Box<dyn Error>> {
        let template = "{wide_bar} {percent} %, {per_sec}, {elapsed} so far, {eta} left";
        let style = ProgressStyle::with_template(template)?;
        Ok(Self(ProgressBar::new(parts).with_position(done).with_style(style)))
    }

    /// So many more parts are done.
    pub fn add(&self, parts: u64) {
        self.0.inc(parts);
    }
}

/// A share in percent, with no minus before what rounds to 0; `never` where there is none.
#[must_use]
pub fn percent(share: f64, digits: usize, never: &str) -> String {
    let value = 100.0 * share;
    let least = 0.5 * 0.1_f64.powi(digits as i32);
    if value.is_finite() {
        format!("{:.digits$}", if value.abs() < least { 0.0 } else { value })
    } else {
        never.to_owned()
    }
}

/// Mean of some numbers.
#[must_use]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The number below which a share of the values lies.
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}
