//! The forms of a run: a table for people, CSV, JSON Lines.

use std::fmt::Write as _;

use serde::Serialize;

use crate::cli::{RowFormat, Run};
use crate::emit::json;
use crate::report::{MOST_TRAJECTORIES, Trajectory};
use crate::task::Verdict;

use super::followed::Followed;
use super::reading::Reading;

/// Text that waits to be printed, and the verdicts so far.
pub(super) struct Writer<'a> {
    reading: &'a Reading,
    format: RowFormat,
    /// Whether trajectories are named: there are several, or there may be.
    many: bool,
    text: String,
    /// Whether an automaton is followed.
    has_states: bool,
    /// The number of trajectories with each verdict: open, satisfied, lost. Without an automaton,
    /// what is not satisfied counts as open.
    verdicts: [usize; 3],
    /// Whether the last row had a final verdict, so that only the first such row is marked.
    marked: bool,
    /// The trajectories for the page.
    drawn: Vec<Trajectory>,
}

/// One row as JSON.
#[derive(Serialize)]
struct JsonRow<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    trajectory: Option<&'a str>,
    row: usize,
    /// `null` without an automaton, as is the progress, and the verdict until it is satisfied.
    state: Option<u32>,
    /// Infinite numbers are written as `null`, since JSON has none.
    progress: Option<f64>,
    verdict: Option<Verdict>,
    robustness: f64,
}

/// The last line of a trajectory as JSON: the verdict of the whole.
#[derive(Serialize)]
struct JsonEnd<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    trajectory: Option<&'a str>,
    /// `null` where it is not satisfied and no automaton says whether it is lost.
    verdict: Option<Verdict>,
    since: usize,
    robustness: f64,
}

impl<'a> Writer<'a> {
    pub(super) fn new(run: &Run, reading: &'a Reading) -> Self {
        let many = run.traces.len() > 1 || run.episode.is_some();
        let mut writer = Self {
            reading,
            format: run.format,
            many,
            text: String::new(),
            has_states: reading.automaton.is_some(),
            verdicts: [0; 3],
            marked: false,
            drawn: Vec::new(),
        };
        writer.start();
        writer
    }

    /// Writes what stands before the rows.
    fn start(&mut self) {
        match self.format {
            RowFormat::Text => {
                let _ = writeln!(self.text, "{}\n", self.reading.title);
                if self.has_table() {
                    let _ = writeln!(self.text, "{:>6}  {:>5}  {:>12}", "row", "state", "progress");
                }
            }
            RowFormat::Csv => {
                self.text.push_str(if self.many { "trajectory," } else { "" });
                self.text.push_str("row,state,progress,verdict,robustness\n");
            }
            RowFormat::Json | RowFormat::Html => {}
        }
    }

    /// The number of further trajectories that a page shows: none where no page is asked for.
    pub(super) fn drawn(&self) -> usize {
        match self.format {
            RowFormat::Html => MOST_TRAJECTORIES - self.drawn.len(),
            _ => 0,
        }
    }

    /// Whether the rows of one trajectory are shown as text.
    fn has_table(&self) -> bool {
        self.has_states && !self.many
    }

    /// Writes the row that a trajectory has read last. Zero has no sign here.
    pub(super) fn row(&mut self, followed: &mut Followed<'_>, progress: Option<f64>) {
        let is_shown = match self.format {
            RowFormat::Text => self.has_table(),
            RowFormat::Html => false,
            RowFormat::Csv | RowFormat::Json => true,
        };
        if !is_shown {
            return;
        }
        followed.look();
        let trajectory = self.many.then_some(&*followed.name);
        let (row, state) = (followed.rows() - 1, followed.state());
        let (progress, verdict) = (progress.map(|progress| progress + 0.0), followed.verdict());
        match self.format {
            RowFormat::Text => {
                let first = verdict != Some(Verdict::Open) && !self.marked;
                self.marked |= first;
                let mark = verdict.filter(|_| first).map(|one| format!("  {one}"));
                let (state, mark) = (shown(state), mark.unwrap_or_default());
                let progress = progress.map(short).unwrap_or_default();
                let _ = writeln!(self.text, "{row:>6}  {state:>5}  {progress:>12}{mark}");
            }
            RowFormat::Csv => {
                let before = trajectory.map(|name| field(name) + ",").unwrap_or_default();
                let (state, progress) = (shown(state), shown(progress));
                let (verdict, robustness) = (shown(verdict), followed.robustness());
                let _ =
                    writeln!(self.text, "{before}{row},{state},{progress},{verdict},{robustness}");
            }
            RowFormat::Json => {
                let robustness = followed.robustness();
                self.json(&JsonRow { trajectory, row, state, progress, verdict, robustness });
            }
            RowFormat::Html => {}
        }
    }

    /// Writes the verdict on a trajectory that has ended.
    pub(super) fn verdict(&mut self, followed: &mut Followed<'_>) {
        followed.look();
        let (verdict, since) = (followed.verdict(), followed.since().unwrap_or_default());
        let (name, robustness) = (&followed.name, followed.robustness());
        self.verdicts[verdict.unwrap_or(Verdict::Open) as usize] += 1;
        let told = match verdict {
            None => "not satisfied, and perhaps lost".to_owned(),
            Some(Verdict::Open) => "not satisfied yet, and not lost".to_owned(),
            Some(verdict) => format!("{verdict} at row {since}"),
        };
        match self.format {
            RowFormat::Text if self.many => {
                let _ = writeln!(self.text, "{name}: {told}; robustness {robustness}");
            }
            RowFormat::Text => {
                let gap = if self.has_states { "\n" } else { "" };
                let _ = writeln!(self.text, "{gap}{told}\nrobustness {robustness}");
                if self.has_states {
                    self.text.push_str(
                        "\nstate: the automaton's state after the row is read\n\
                         progress: by how much the row moves the automaton on, from the state before it\n",
                    );
                }
            }
            RowFormat::Csv => {}
            RowFormat::Html => self.drawn.extend(followed.drawn()),
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
            let others = match self.has_states {
                true => format!("{open} open, {lost} lost"),
                false => format!("{open} not, and perhaps lost"),
            };
            let _ = writeln!(self.text, "\n{satisfied} of {of} satisfied, {others}");
        }
        if self.format == RowFormat::Html {
            let of = self.verdicts.iter().sum();
            self.text = self.reading.page(of).html(&self.drawn);
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

/// What there is, or nothing.
fn shown(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
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
