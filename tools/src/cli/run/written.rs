//! The forms of a run: a table for people, CSV, JSON Lines.

use std::fmt::Write as _;

use serde::Serialize;

use crate::cli::{RowFormat, Run};
use crate::emit::json;
use crate::task::Verdict;

use super::Followed;

/// Text that waits to be printed, and the verdicts so far.
pub(super) struct Writer<'a> {
    title: &'a str,
    format: RowFormat,
    /// Whether trajectories are named: there are several, or there may be.
    many: bool,
    text: String,
    /// The number of trajectories with each verdict: open, satisfied, lost.
    verdicts: [usize; 3],
    /// Whether the last row had a final verdict, so that only the first such row is marked.
    marked: bool,
}

/// One row as JSON.
#[derive(Serialize)]
struct JsonRow<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    trajectory: Option<&'a str>,
    row: usize,
    state: u32,
    /// Infinite numbers are written as `null`, since JSON has none.
    progress: f64,
    verdict: Verdict,
    robustness: f64,
}

/// The last line of a trajectory as JSON: the verdict of the whole.
#[derive(Serialize)]
struct JsonEnd<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    trajectory: Option<&'a str>,
    verdict: Verdict,
    since: usize,
    robustness: f64,
}

impl<'a> Writer<'a> {
    pub(super) fn new(run: &Run, title: &'a str) -> Self {
        let many = run.traces.len() > 1 || run.episode.is_some();
        let mut writer = Self {
            title,
            format: run.format,
            many,
            text: String::new(),
            verdicts: [0; 3],
            marked: false,
        };
        writer.start();
        writer
    }

    /// Writes what stands before the rows.
    fn start(&mut self) {
        match self.format {
            RowFormat::Text => {
                let _ = writeln!(self.text, "{}\n", self.title);
                if !self.many {
                    let _ = writeln!(self.text, "{:>6}  {:>5}  {:>12}", "row", "state", "progress");
                }
            }
            RowFormat::Csv => {
                self.text.push_str(if self.many { "trajectory," } else { "" });
                self.text.push_str("row,state,progress,verdict,robustness\n");
            }
            RowFormat::Json => {}
        }
    }

    /// Writes the row that a trajectory has read last. Zero has no sign here.
    pub(super) fn row(&mut self, followed: &Followed<'_>, progress: f64) {
        let Followed { name, running, online } = followed;
        let trajectory = self.many.then_some(&**name);
        let (row, state, progress) = (running.rows() - 1, running.state(), progress + 0.0);
        let verdict = running.verdict();
        match self.format {
            RowFormat::Text if self.many => {}
            RowFormat::Text => {
                let first = verdict != Verdict::Open && !self.marked;
                self.marked |= first;
                let mark = if first { format!("  {verdict}") } else { String::new() };
                let progress = short(progress);
                let _ = writeln!(self.text, "{row:>6}  {state:>5}  {progress:>12}{mark}");
            }
            RowFormat::Csv => {
                let before = trajectory.map(|name| field(name) + ",").unwrap_or_default();
                let robustness = online.robustness() + 0.0;
                let _ =
                    writeln!(self.text, "{before}{row},{state},{progress},{verdict},{robustness}");
            }
            RowFormat::Json => {
                let robustness = online.robustness() + 0.0;
                self.json(&JsonRow { trajectory, row, state, progress, verdict, robustness });
            }
        }
    }

    /// Writes the verdict on a trajectory that has ended.
    pub(super) fn verdict(&mut self, followed: &Followed<'_>) {
        let Followed { name, running, online } = followed;
        let (verdict, since) = (running.verdict(), running.since().unwrap_or_default());
        let robustness = online.robustness() + 0.0;
        self.verdicts[verdict as usize] += 1;
        let told = match verdict {
            Verdict::Open => "not satisfied yet, and not lost".to_owned(),
            verdict => format!("{verdict} at row {since}"),
        };
        match self.format {
            RowFormat::Text if self.many => {
                let _ = writeln!(self.text, "{name}: {told}; robustness {robustness}");
            }
            RowFormat::Text => {
                let _ = writeln!(self.text, "\n{told}\nrobustness {robustness}");
                self.text.push_str(
                    "\nstate: the automaton's state after the row is read\n\
                     progress: by how much the row moves the automaton on, from the state before it\n",
                );
            }
            RowFormat::Csv => {}
            RowFormat::Json => {
                let trajectory = self.many.then_some(&**name);
                self.json(&JsonEnd { trajectory, verdict, since, robustness });
            }
        }
    }

    /// The text since the last call.
    pub(super) fn take(&mut self) -> String {
        std::mem::take(&mut self.text)
    }

    /// The rest of the text: the summary, if there are several trajectories.
    pub(super) fn end(&mut self) -> String {
        if self.many && self.format == RowFormat::Text {
            let [open, satisfied, lost] = self.verdicts;
            let of = open + satisfied + lost;
            let _ =
                writeln!(self.text, "\n{satisfied} of {of} satisfied, {open} open, {lost} lost");
        }
        self.take()
    }

    /// Whether every trajectory satisfies the task.
    pub(super) fn all_satisfied(&self) -> bool {
        let [open, _, lost] = self.verdicts;
        open + lost == 0
    }

    fn json(&mut self, line: &impl Serialize) {
        self.text.push_str(&json::line(line));
        self.text.push('\n');
    }
}

/// A number in at most 12 characters.
fn short(value: f64) -> String {
    let exact = value.to_string();
    if exact.len() <= 12 { exact } else { format!("{value:.5e}") }
}

/// A field of CSV (RFC 4180).
fn field(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
