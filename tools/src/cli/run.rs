//! `tltlc run`: a recorded trajectory through the automaton of a task.
//!
//! The exit code is that of the verdict, so a script can test recordings: 0 if the task is
//! satisfied, 1 if it is open or lost.

use std::fmt::Write as _;

use serde::Serialize;
use tltl_compiler::translate::Budget;

use crate::evaluate::{Columns, Scratch};
use crate::task::{self, Bound, Task, Verdict};

use super::subject::{self, Subject};
use super::{Exit, Outcome, RowFormat, Run, Streams, arguments, record};

/// Runs the trajectory that the arguments name, and shows the result row by row.
pub(super) fn run(run: &Run, streams: &mut Streams<'_>) -> Outcome {
    let (subject, task) = subject::split(&run.subject);
    let (name, given) = match task.or(run.task.as_deref()) {
        Some(task) => arguments::split(task).map(|(name, given)| (Some(name), given))?,
        None => (None, None),
    };
    // Guards are needed, as in what becomes Rust.
    let entry = match subject::read(subject, name, Budget::EMITTED, streams)? {
        None => return Ok(Exit::Mistaken),
        Some(Subject::Task(entry)) => entry,
        Some(Subject::Automaton(_)) => {
            return Err("an automaton does not say how its propositions read a state".into());
        }
    };
    subject::automata(&entry)?;
    let named = arguments::named(&entry, given.as_deref().unwrap_or_default())?;
    let Bound::Plain(task) = entry.bind(&named).map_err(|error| error.to_string())? else {
        unreachable!("a task with automata of its own is not factored");
    };
    let recorded = streams.read(&run.trace)?;
    let name = run.trace.display().to_string();
    let result = followed(&task, (&name, &recorded))?;
    streams.print(&match run.format {
        RowFormat::Text => text(&task, &result),
        RowFormat::Csv => csv(&result),
        RowFormat::Json => json(&result),
    })?;
    Ok(Exit::of(result.verdict() == Verdict::Satisfied))
}

/// Reads the recorded trajectory and runs it through the task.
fn followed(task: &Task, (name, recorded): (&str, &str)) -> Result<task::Run, String> {
    let record = record::read(name, recorded, task.inputs())?;
    let numbers: Vec<f64> = record.iter().flat_map(|state| state.values.iter().copied()).collect();
    let columns = Columns::of_rows(record.len(), task.inputs().len(), &numbers)
        .map_err(|error| error.to_string())?;
    task.run(&columns, &mut Scratch::default()).map_err(|nan| {
        let predicate = &task.automaton().propositions()[nan.predicate as usize];
        let line = record[nan.row].line;
        format!("{name}:{line}: the predicate `{predicate}` is not a number (NaN) there")
    })
}

/// The run as a table for people, with the first row of a final verdict marked.
fn text(task: &Task, run: &task::Run) -> String {
    let formula = &task.entry().task().text;
    let mut text = match task.entry().name() {
        Some(name) => format!("{name} = {formula}\n"),
        None => format!("{formula}\n"),
    };
    if !task.arguments().is_empty() {
        let with = task.arguments().iter().map(|(name, value)| format!("{name} = {value}"));
        let _ = writeln!(text, "with {}", with.collect::<Vec<_>>().join(", "));
    }
    let _ = writeln!(text, "\n{:>6}  {:>5}  {:>12}", "row", "state", "progress");
    for (t, state, progress, verdict) in rows(run) {
        let first = verdict != Verdict::Open && Some(t) == run.since();
        let mark = if first { format!("  {verdict}") } else { String::new() };
        let _ = writeln!(text, "{t:>6}  {state:>5}  {:>12}{mark}", short(progress));
    }
    let _ = match (run.verdict(), run.since()) {
        (Verdict::Open, _) | (_, None) => writeln!(text, "\nnot satisfied yet, and not lost"),
        (verdict, Some(since)) => writeln!(text, "\n{verdict} at row {since}"),
    };
    // Zero has no sign here.
    let _ = writeln!(text, "robustness {}", run.robustness + 0.0);
    text.push_str(
        "\nstate: the automaton's state after the row is read\n\
         progress: by how much the row moves the automaton on, from the state before it\n",
    );
    text
}

/// The rows of a run with their numbers, from 0: state, progress, verdict.
fn rows(run: &task::Run) -> impl Iterator<Item = (usize, u32, f64, Verdict)> {
    let progress = run.progress.iter().zip(&run.verdicts);
    let rows = run.states.iter().zip(progress).enumerate();
    rows.map(|(t, (&state, (&progress, &verdict)))| (t, state, progress, verdict))
}

/// A number in at most 12 characters.
fn short(value: f64) -> String {
    let exact = (value + 0.0).to_string();
    if exact.len() <= 12 { exact } else { format!("{value:.5e}") }
}

/// The run as CSV, one line a row.
fn csv(run: &task::Run) -> String {
    let mut text = String::from("row,state,progress,verdict\n");
    for (t, state, progress, verdict) in rows(run) {
        let _ = writeln!(text, "{t},{state},{},{verdict}", progress + 0.0);
    }
    text
}

/// One row as JSON.
#[derive(Serialize)]
struct JsonRow {
    row: usize,
    state: u32,
    /// Written as `null` if it is infinite, since JSON has no infinity.
    progress: f64,
    verdict: Verdict,
}

/// The last line of JSON: the verdict of the whole.
#[derive(Serialize)]
struct JsonEnd {
    verdict: Verdict,
    since: usize,
    robustness: f64,
}

/// The run as JSON Lines: one object a row, and one at the end.
fn json(run: &task::Run) -> String {
    let mut text = String::new();
    for (row, state, progress, verdict) in rows(run) {
        let row = JsonRow { row, state, progress: progress + 0.0, verdict };
        text.push_str(&serde_json::to_string(&row).unwrap_or_default());
        text.push('\n');
    }
    let end = JsonEnd {
        verdict: run.verdict(),
        since: run.since().unwrap_or_default(),
        robustness: run.robustness + 0.0,
    };
    text + &serde_json::to_string(&end).unwrap_or_default() + "\n"
}
