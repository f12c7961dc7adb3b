//! `tltlc run`: recorded trajectories through the automaton of a task.
//!
//! The exit code is that of the verdicts, so a script can test recordings: 0 if every trajectory
//! satisfies the task, 1 if one is open or lost.
//!
//! A recording is read, evaluated and written block by block, so memory does not grow with it.

mod followed;
mod reading;
mod written;

use std::path::{Path, PathBuf};

use rustc_hash::FxHashMap;

use crate::evaluate::{Input, Scratch};
use crate::task::{Bound, Unmade};

use super::input::Made;
use super::record::{At, Place, Record};
use super::streams::{open, read_once};
use super::subject;
use super::{Exit, Outcome, Run, Streams, arguments};

use followed::Followed;
use reading::{Read, Reading};
use written::Writer;

/// The rows of a block: as many as the evaluator has in one of its own, several times.
const BLOCK: usize = 1 << 12;

/// Runs the trajectories that the arguments name, and shows the results.
pub(super) fn run(run: &Run, streams: &mut Streams<'_>) -> Outcome {
    let subject = Path::new(subject::split(&run.subject).0);
    let paths = run.traces.iter().chain(&run.map_file).map(PathBuf::as_path);
    read_once(paths.chain([subject]))?;
    let Some(reading) = reading(run, streams)? else { return Ok(Exit::Mistaken) };
    let map = map(run, streams)?;
    let places = places(run, &reading.inputs, &map)?;
    let mut writer = Writer::new(run, &reading);
    for path in &run.traces {
        let name = path.display().to_string();
        let record = Record::new(&name, path, open(streams.input, path)?, &places)?;
        let episode = run.episode.as_deref();
        let mut following = Following::new(&reading, &name, episode, writer.drawn());
        following.read(record, &mut |text| streams.out.print(text), &mut writer)?;
        if following.followed.is_empty() {
            return Err(format!("{name}: a trajectory has at least one state, and this has none"));
        }
        following.followed.iter_mut().for_each(|followed| writer.verdict(followed));
    }
    streams.print(&writer.end())?;
    Ok(Exit::of(writer.all_satisfied()))
}

/// The task that the arguments name, with its own arguments, or the automaton; `None` if its source
/// has mistakes.
fn reading(run: &Run, streams: &mut Streams<'_>) -> Result<Option<Reading>, String> {
    let (subject, task) = subject::split(&run.subject);
    let (name, given) = match subject::once(task, run.task.as_deref())? {
        Some(task) => arguments::split(task).map(|(name, given)| (Some(name), given))?,
        None => (None, None),
    };
    let given = given.unwrap_or_default();
    match subject::read_any(subject, name, run.limits.with_guards(), streams)? {
        Made::Mistaken => Ok(None),
        Made::Whole(entry) if entry.is_factored() => {
            let reading = of_formula(&Unmade::of_entry(&entry), &given)?;
            let name = entry.name().unwrap_or_default();
            streams.complain(&without_automaton(&format!(
                "task `{name}` is factored: it has no automaton of its own"
            )));
            Ok(reading)
        }
        Made::Whole(entry) => {
            let parameters = entry.parameters();
            let named = arguments::named(entry.name(), &parameters, &given)?;
            match entry.bind(&named).map_err(|error| error.to_string())? {
                Bound::Plain(task) => Ok(Some(Reading::of_task(&task))),
                Bound::Factored(_) => unreachable!("a factored task is read by its formula"),
            }
        }
        Made::TooLarge(error, module) => {
            let unmade = Unmade::new(*module, name).map_err(|error| error.to_string())?;
            let reading = of_formula(&unmade, &given)?;
            streams.complain(&without_automaton(error.errors().first().message()));
            Ok(reading)
        }
    }
}

/// What a task without an automaton is read by, with its arguments.
fn of_formula(unmade: &Unmade, given: &[&str]) -> Result<Option<Reading>, String> {
    let parameters = unmade.parameters();
    let named = arguments::named(unmade.task().name.as_deref(), &parameters, given)?;
    let evaluator = unmade.bind(&named).map_err(|error| error.to_string())?;
    Ok(Some(Reading::of_unmade(unmade, evaluator, &named)))
}

/// What is missing where a task has no automaton, and why it has none.
fn without_automaton(why: &str) -> String {
    format!(
        "tltlc: {why}; without it there are verdict and robustness, but no states and no \
         progress, and what is not satisfied may be lost"
    )
}

/// The columns that the user has chosen, by field: those of the arguments, and those of the file for
/// fields that no argument names.
fn map(run: &Run, streams: &mut Streams<'_>) -> Result<Vec<(String, String)>, String> {
    let lines = run.map_file.as_deref().map_or(Ok(Vec::new()), |path| streams.read_lines(path))?;
    let name = run.map_file.as_deref().unwrap_or(Path::new("")).display();
    let lines = (1..).zip(&lines).map(|(number, line)| (format!("{name}:{number}: "), line.trim()));
    let file = pairs(lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#')))?;
    let mut map = pairs(run.map.iter().map(|text| (String::new(), text.as_str())))?;
    let is_new = |(field, _): &(String, String)| map.iter().all(|(other, _)| other != field);
    let added: Vec<_> = file.into_iter().filter(is_new).collect();
    map.extend(added);
    Ok(map)
}

/// Pairs of a field and its column, each written `FIELD=COLUMN`, each field once. Before each text
/// stands the beginning of a message about it.
fn pairs<'a>(
    texts: impl Iterator<Item = (String, &'a str)>,
) -> Result<Vec<(String, String)>, String> {
    let mut pairs: Vec<(String, String)> = Vec::new();
    for (at, text) in texts {
        let (field, column) = match text.split_once('=').map(|(a, b)| (a.trim(), b.trim())) {
            None | Some(("", _) | (_, "")) => {
                return Err(format!("{at}`{text}` maps nothing: write FIELD=COLUMN"));
            }
            Some(pair) => pair,
        };
        match pairs.iter().find(|(known, _)| known == field) {
            Some((_, other)) if other != column => {
                return Err(format!("{at}`{field}` is mapped to `{other}` and to `{column}`"));
            }
            Some(_) => {}
            None => pairs.push((field.to_owned(), column.to_owned())),
        }
    }
    Ok(pairs)
}

/// The columns to look for: one for each input of the task, and that of the episode.
fn places<'a>(
    run: &'a Run,
    inputs: &'a [Input],
    map: &'a [(String, String)],
) -> Result<Vec<Place<'a>>, String> {
    for (field, _) in map {
        if !inputs.iter().any(|input| input.name == *field) {
            let names: Vec<_> = inputs.iter().map(|input| &*input.name).collect();
            return Err(format!("the task does not read `{field}`; it reads {}", names.join(", ")));
        }
    }
    let chosen = |name: &str| map.iter().find(|(field, _)| field == name);
    let place = |input: &'a Input| {
        let column = chosen(&input.name).map(|(_, column)| column.as_str());
        Place::new(Some(input), column)
    };
    let episode = run.episode.as_deref().map(|column| Place::new(None, Some(column)));
    Ok(inputs.iter().map(place).chain(episode).collect())
}

/// The trajectories of one file: as many as it has episodes.
struct Following<'a> {
    reading: &'a Reading,
    file: &'a str,
    episode: Option<&'a str>,
    followed: Vec<Followed<'a>>,
    /// The number of further trajectories that a page shows.
    drawn: usize,
    /// The index of each episode among them, by its name in the file.
    known: FxHashMap<String, usize>,
}

/// Rows that were read and not yet evaluated.
#[derive(Default)]
struct Block {
    values: Vec<f64>,
    /// For each row its place in the file, and the index of its trajectory.
    rows: Vec<(At, usize)>,
}

impl<'a> Following<'a> {
    fn new(reading: &'a Reading, file: &'a str, episode: Option<&'a str>, drawn: usize) -> Self {
        let (followed, known) = (Vec::new(), FxHashMap::default());
        Self { reading, file, episode, followed, drawn, known }
    }

    /// Reads a record to its end, and prints the rows as `writer` writes them.
    fn read(
        &mut self,
        mut record: Record<'_>,
        print: &mut dyn FnMut(&str) -> Outcome,
        writer: &mut Writer<'_>,
    ) -> Result<(), String> {
        let (mut block, mut scratch) = (Block::default(), Scratch::default());
        loop {
            let mut trajectory = None;
            let more = record.next(&mut block.values, &mut |episode| {
                trajectory = Some(self.trajectory(episode));
            })?;
            if let Some(at) = more {
                let trajectory = trajectory.unwrap_or_else(|| self.trajectory(""));
                block.rows.push((at, trajectory));
            }
            if block.rows.len() == BLOCK || (more.is_none() && !block.rows.is_empty()) {
                self.follow(&block, &mut scratch, writer)?;
                print(&writer.take())?;
                block.values.clear();
                block.rows.clear();
            }
            if more.is_none() {
                return Ok(());
            }
        }
    }

    /// The index of the trajectory of an episode, which may be a new one.
    fn trajectory(&mut self, episode: &str) -> usize {
        if let Some(&known) = self.known.get(episode) {
            return known;
        }
        let name = match self.episode {
            Some(column) => format!("{}: {column} {episode}", self.file),
            None => self.file.to_owned(),
        };
        // A page shows no more, and a recording may have a million of them.
        let is_drawn = self.drawn > 0;
        self.drawn -= usize::from(is_drawn);
        self.followed.push(Followed::new(name, self.reading, is_drawn));
        self.known.insert(episode.to_owned(), self.followed.len() - 1);
        self.followed.len() - 1
    }

    /// Moves the trajectories on by the rows of a block.
    fn follow(
        &mut self,
        block: &Block,
        scratch: &mut Scratch,
        writer: &mut Writer<'_>,
    ) -> Result<(), String> {
        let read = self.reading.read(&block.values, block.rows.len(), scratch).map_err(|nan| {
            let predicate = &self.reading.propositions[nan.predicate as usize];
            let (file, at) = (self.file, block.rows[nan.row].0);
            format!("{file}{at}: the predicate `{predicate}` is not a number (NaN) there")
        })?;
        let Read { labels, rho, width } = read;
        for (row, &(_, trajectory)) in block.rows.iter().enumerate() {
            let (from, to) = (row * width, (row + 1) * width);
            let followed = &mut self.followed[trajectory];
            let progress = followed.step(&labels[from..to], &rho[from..to]);
            writer.row(followed, progress);
        }
        Ok(())
    }
}
