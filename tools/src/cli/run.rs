//! `tltlc run`: a recorded trajectory through the automaton of a task.

use std::fmt::Write as _;

use crate::evaluate::{Columns, Evaluator, Row, Scratch, run as run_automaton};
use serde::Serialize;
use tltl_compiler::dfa::{Automata, Dfa, State};
use tltl_compiler::predicate::Task;

use super::subject::{self, Subject};
use super::{Exit, Outcome, RowFormat, Run, Streams, arguments, record};

/// Runs the trajectory that the arguments name, and shows what becomes of the task.
pub(super) fn run(run: &Run, streams: &mut Streams<'_>) -> Outcome {
    let (subject, task) = subject::split(&run.subject);
    let (name, given) = match task.or(run.task.as_deref()) {
        Some(task) => arguments::split(task).map(|(name, given)| (Some(name), given))?,
        None => (None, None),
    };
    let entry = match subject::read(subject, name, streams)? {
        None => return Ok(Exit::Mistaken),
        Some(Subject::Task(entry)) => entry,
        Some(Subject::Automaton(_)) => {
            return Err("an automaton does not say how its propositions read a state".into());
        }
    };
    let (task, automata) = (entry.task(), subject::automata(&entry)?);
    let named = arguments::named(&entry, given.as_deref().unwrap_or_default())?;
    let evaluator = entry.evaluator(&named).map_err(|error| error.to_string())?;
    let recorded = streams.read(&run.trace)?;
    let name = run.trace.display().to_string();
    let result = judge(&evaluator, task, automata, (&name, &recorded))?;
    streams.print(&match run.format {
        RowFormat::Text => text(task, given.as_deref(), &result),
        RowFormat::Csv => csv(&result),
        RowFormat::Json => json(&result),
    })?;
    Ok(Exit::of(result.last() == Verdict::Satisfied))
}

/// What became of the task.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Verdict {
    Open,
    Satisfied,
    Lost,
}

impl Verdict {
    fn word(self) -> &'static str {
        match self {
            Self::Open => "open",
            Self::Satisfied => "satisfied",
            Self::Lost => "lost",
        }
    }
}

struct Judged {
    rows: Vec<Row>,
    verdicts: Vec<Verdict>,
    robustness: f64,
}

impl Judged {
    fn last(&self) -> Verdict {
        self.verdicts.last().copied().unwrap_or(Verdict::Open)
    }

    /// The first row at which the last verdict stood.
    fn since(&self) -> usize {
        let last = self.last();
        self.verdicts.iter().position(|verdict| *verdict == last).unwrap_or(0)
    }
}

fn judge(
    evaluator: &Evaluator,
    task: &Task,
    automata: &Automata,
    (name, recorded): (&str, &str),
) -> Result<Judged, String> {
    let record = record::read(name, recorded, evaluator.inputs())?;
    let rows = record.len();
    let numbers: Vec<f64> = record.iter().flat_map(|state| state.values.iter().copied()).collect();
    let columns = Columns::of_rows(rows, evaluator.inputs().len(), &numbers)
        .map_err(|error| error.to_string())?;
    let mut scratch = Scratch::default();
    let width = evaluator.propositions();
    let (mut labels, mut rho) = (vec![false; rows * width], vec![0.0; rows * width]);
    let robustness = evaluator.labels(&columns, &mut scratch, &mut labels).and_then(|()| {
        evaluator.rho(&columns, &mut scratch, &mut rho)?;
        evaluator.robustness(&columns, &mut scratch)
    });
    let robustness = robustness.map_err(|nan| {
        let predicate = &task.spec.propositions()[nan.predicate as usize];
        let line = record[nan.row].line;
        format!("{name}:{line}: the predicate `{predicate}` is not a number (NaN) there")
    })?;
    let rows = run_automaton(&automata.dfa, rows, &labels, &rho);
    let verdicts = rows.iter().map(|row| verdict(&automata.dfa, row.state)).collect();
    Ok(Judged { rows, verdicts, robustness })
}

fn verdict(dfa: &Dfa, q: State) -> Verdict {
    match q {
        _ if dfa.accepting == Some(q) => Verdict::Satisfied,
        _ if dfa.trap == Some(q) => Verdict::Lost,
        _ => Verdict::Open,
    }
}

fn text(task: &Task, given: Option<&[&str]>, judged: &Judged) -> String {
    let given = given.filter(|given| !given.is_empty());
    let mut text = match (&task.name, given) {
        (Some(name), Some(given)) => {
            let names = task.parameters.iter().map(|known| known.name.as_str());
            let with: Vec<_> =
                names.zip(given).map(|(name, value)| format!("{name} = {value}")).collect();
            format!("{name} = {}\nwith {}\n\n", task.text, with.join(", "))
        }
        (Some(name), None) => format!("{name} = {}\n\n", task.text),
        (None, _) => format!("{}\n\n", task.text),
    };
    let _ = writeln!(text, "{:>6}  {:>5}  {:>12}", "row", "state", "progress");
    for (t, row) in judged.rows.iter().enumerate() {
        let line = format!("{t:>6}  {:>5}  {:>12}", row.state, short(row.progress));
        let verdict = judged.verdicts[t];
        let first = verdict != Verdict::Open && t == judged.since();
        let mark = if first { format!("  {}", verdict.word()) } else { String::new() };
        let _ = writeln!(text, "{line}{mark}");
    }
    let since = judged.since();
    let _ = match judged.last() {
        Verdict::Open => writeln!(text, "\nnot satisfied yet, and not lost"),
        verdict => writeln!(text, "\n{} at row {since}", verdict.word()),
    };
    // Zero has no sign here.
    let _ = writeln!(text, "robustness {}", judged.robustness + 0.0);
    text.push_str(
        "\nstate: the automaton's state after the row is read\n\
         progress: by how much the row moves the automaton on, from the state before it\n",
    );
    text
}

/// A number as it fits into a column.
fn short(value: f64) -> String {
    let exact = (value + 0.0).to_string();
    if exact.len() <= 12 { exact } else { format!("{value:.5e}") }
}

fn csv(judged: &Judged) -> String {
    let mut text = String::from("row,state,progress,verdict\n");
    for (t, row) in judged.rows.iter().enumerate() {
        let verdict = judged.verdicts[t].word();
        let _ = writeln!(text, "{t},{},{},{verdict}", row.state, row.progress + 0.0);
    }
    text
}

#[derive(Serialize)]
struct JsonRow {
    row: usize,
    state: State,
    /// `null` if it is infinite.
    progress: f64,
    verdict: Verdict,
}

#[derive(Serialize)]
struct JsonEnd {
    verdict: Verdict,
    since: usize,
    robustness: f64,
}

fn json(judged: &Judged) -> String {
    let mut text = String::new();
    let rows = judged.rows.iter().zip(&judged.verdicts).enumerate();
    let rows = rows.map(|(t, (row, &verdict))| JsonRow {
        row: t,
        state: row.state,
        progress: row.progress + 0.0,
        verdict,
    });
    for row in rows {
        text.push_str(&serde_json::to_string(&row).unwrap_or_default());
        text.push('\n');
    }
    let end = JsonEnd {
        verdict: judged.last(),
        since: judged.since(),
        robustness: judged.robustness + 0.0,
    };
    text + &serde_json::to_string(&end).unwrap_or_default() + "\n"
}
