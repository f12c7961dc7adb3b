//! A saved policy as a Rust source file that stands alone: `static` tables, no dependency, no
//! allocation, `no_std`.
//!
//! The file that comes in is the JSON that the runtime saves (its module `policy` has the schema).
//! It is checked in full before anything is written: a file that is cut short, of another format
//! or inconsistent is refused with the reason.

use std::fmt::Write as _;

use serde::Deserialize;
use serde_json::Value;

use super::network;

/// The value of the field `format`.
const FORMAT: &str = "tltl-policy";
/// The version that this compiler reads.
const VERSION: u64 = 2;
/// The worth from each start is written as a table for worlds of at most this many states.
const STARTS: usize = 256;

#[derive(Deserialize)]
struct Policy {
    task: String,
    formula: String,
    states: usize,
    actions: Vec<String>,
    automaton: States,
    classes: usize,
    class: Vec<u32>,
    next: Vec<u32>,
    action: Vec<u32>,
    training: Vec<Training>,
    certificate: Option<Value>,
    shield: Option<Shield>,
    starts: Option<Starts>,
}

#[derive(Deserialize)]
struct Training {
    task: String,
    settings: Value,
    steps: u64,
    episodes: u64,
    seed: u64,
}

#[derive(Deserialize)]
struct Shield {
    before: Value,
    lost_before: f64,
    lost_after: f64,
    smallest_lost: f64,
    overruled: f64,
}

#[derive(Deserialize)]
struct Starts {
    state: Vec<u32>,
    satisfied: Vec<f64>,
    steps: Vec<Option<f64>>,
}

#[derive(Deserialize)]
struct States {
    states: u32,
    initial: u32,
    accepting: Option<u32>,
    trap: Option<u32>,
}

/// The Rust source of the policy that `json` holds: a table here, or a [network].
///
/// # Errors
/// Says why `json` is not a policy.
pub fn rust(json: &str) -> Result<String, String> {
    let value: Value = serde_json::from_str(json).map_err(|error| format!("not JSON: {error}"))?;
    match value.get("format").and_then(Value::as_str) {
        Some(FORMAT) => {}
        Some(network::FORMAT) => return network::rust(json),
        Some(other) => {
            let known = format!("`{FORMAT}` or `{}`", network::FORMAT);
            return Err(format!("not a policy: format is `{other}`, not {known}"));
        }
        None => return Err(format!("not a policy: there is no `\"format\": \"{FORMAT}\"`")),
    }
    match value.get("version").and_then(Value::as_u64) {
        Some(VERSION) => {}
        Some(other) => {
            return Err(format!("policy version {other}; this compiler reads {VERSION}"));
        }
        None => return Err("the policy has no version".to_owned()),
    }
    let policy: Policy = serde_json::from_value(value).map_err(|error| error.to_string())?;
    policy.check()?;
    Ok(policy.write())
}

impl Policy {
    fn check(&self) -> Result<(), String> {
        let (n, States { initial, accepting, trap, .. }) =
            (self.automaton.states as usize, &self.automaton);
        for (field, count) in
            [("states", self.states), ("actions", self.actions.len()), ("classes", self.classes)]
        {
            if count == 0 {
                return Err(format!("`{field}` is empty"));
            }
        }
        length("class", &self.class, Some(self.states))?;
        length("next", &self.next, n.checked_mul(self.classes))?;
        length("action", &self.action, n.checked_mul(self.states))?;
        below("class", &self.class, self.classes)?;
        below("next", &self.next, n)?;
        below("action", &self.action, self.actions.len())?;
        below("automaton.initial", &[*initial], n)?;
        below("automaton.accepting", accepting.as_slice(), n)?;
        below("automaton.trap", trap.as_slice(), n)?;
        self.starts.as_ref().map_or(Ok(()), |starts| starts.check(self.states))
    }

    fn write(&self) -> String {
        let mut text = self.documentation();
        let _ = write!(
            text,
            "
/// The number of states of the world, numbered from 0.
pub const STATES: usize = {};
/// The number of automaton states.
pub const AUTOMATON_STATES: usize = {};
/// What the actions are called.
pub const ACTIONS: [&str; {}] = {:?};
/// The automaton state in which the task is accomplished.
pub const ACCEPTING: Option<usize> = {:?};
/// The automaton state in which the task is lost.
pub const TRAP: Option<usize> = {:?};

",
            self.states,
            self.automaton.states,
            self.actions.len(),
            self.actions,
            self.automaton.accepting,
            self.automaton.trap,
        );
        table(&mut text, "CLASS", "The class of each state of the world.", &self.class);
        let about = "The next automaton state, indexed `q * CLASSES + class`.";
        table(&mut text, "NEXT", about, &self.next);
        table(&mut text, "ACTION", "The action, indexed `q * STATES + s`.", &self.action);
        if let Some(starts) = self.starts.as_ref().filter(|_| self.states <= STARTS) {
            text.push_str(&starts.table(self.states));
        }
        let _ = write!(text, "\nconst CLASSES: usize = {};\n", self.classes);
        text.push_str(&FUNCTIONS.replace("INITIAL", &self.automaton.initial.to_string()));
        text
    }

    fn documentation(&self) -> String {
        let States { states, accepting, trap, .. } = &self.automaton;
        let known = |state: &Option<u32>| state.map_or("none".to_owned(), |q| q.to_string());
        let mut text = "// Generated by `tltlc policy`; do not edit.\n".to_owned();
        paragraph(
            &mut text,
            &format!("A policy for the task `{}`: `{}`.", self.task, self.formula),
        );
        paragraph(
            &mut text,
            &format!(
                "Automaton: {states} states, accepting {}, trap {}; {} states of the world in {} \
                 classes.",
                known(accepting),
                known(trap),
                self.states,
                self.classes
            ),
        );
        if !self.training.is_empty() {
            paragraph(&mut text, &trained(&self.training));
        }
        let worth = self.certificate.as_ref().map(certified);
        paragraph(&mut text, &worth.unwrap_or("Not judged against an exact optimum.".to_owned()));
        if let Some(shield) = &self.shield {
            paragraph(&mut text, &shield.documentation());
        }
        if let Some(starts) = &self.starts {
            paragraph(&mut text, &starts.documentation());
        }
        text.push_str(
            "//! An episode: `let mut q = reset(s)`; then, until `is_done(q)`, take the action\n\
             //! `act(q, s)`, observe the next state `s` and let `q = next(q, s)`.\n",
        );
        text
    }
}

/// A paragraph of module documentation, in lines of at most 96 columns.
pub(super) fn paragraph(text: &mut String, content: &str) {
    let mut column = 0;
    for word in content.split_whitespace() {
        // At the start of a line these would begin a quotation or a list.
        let mark = word.starts_with(['>', '-', '+', '*', '#', '=']);
        if column == 0 || column + word.chars().count() + 1 > 96 && !mark {
            text.push_str(if column == 0 { "//!" } else { "\n//!" });
            column = 3;
        }
        text.push(' ');
        text.push_str(word);
        column += word.chars().count() + 1;
    }
    text.push_str("\n//!\n");
}

/// How the policy was learned, each skill of a composition by its name.
fn trained(all: &[Training]) -> String {
    let entry = |training: &Training| {
        let Training { task, steps, episodes, seed, .. } = training;
        format!("on `{task}` for {steps} steps in {episodes} episodes with seed {seed}")
    };
    let settings = |training: &Training| format!("settings {}", summary(&training.settings));
    if all.iter().all(|training| training.settings == all[0].settings) {
        let entries: Vec<String> = all.iter().map(entry).collect();
        return format!("Trained {}; {}.", entries.join(", and "), settings(&all[0]));
    }
    let entries: Vec<String> =
        all.iter().map(|training| format!("{}, {}", entry(training), settings(training))).collect();
    format!("Trained {}.", entries.join("; and "))
}

impl Shield {
    fn documentation(&self) -> String {
        format!(
            "Under a shield, which overrules {:.2} % of the actions: the trap is entered with \
             probability {:.6} (smallest possible {:.6}); without it with {:.6}. {}",
            100.0 * self.overruled,
            self.lost_after,
            self.smallest_lost,
            self.lost_before,
            certified(&self.before).replace("Exact value", "Without it")
        )
    }
}

impl Starts {
    fn check(&self, states: usize) -> Result<(), String> {
        for (field, found) in [("satisfied", self.satisfied.len()), ("steps", self.steps.len())] {
            if found != self.state.len() {
                let expected = self.state.len();
                return Err(format!("`starts.{field}` has {found} entries, not {expected}"));
            }
        }
        below("starts.state", &self.state, states)
    }

    /// The ends of both columns.
    fn documentation(&self) -> String {
        let ends = |values: &mut dyn Iterator<Item = f64>| {
            values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
        };
        let (least, most) = ends(&mut self.satisfied.iter().copied());
        let (fewest, longest) = ends(&mut self.steps.iter().flatten().copied());
        let steps = format!(", E[steps | satisfied] from {fewest:.4} to {longest:.4}");
        format!(
            "From each of its {} starts: P(satisfied) from {least:.6} to {most:.6}{}.",
            self.state.len(),
            if longest.is_finite() { steps } else { String::new() }
        )
    }

    /// The table of all states; not a number where no episode starts, or none succeeds.
    fn table(&self, states: usize) -> String {
        let mut entries = vec!["(f64::NAN, f64::NAN)".to_owned(); states];
        for ((&s, p), steps) in self.state.iter().zip(&self.satisfied).zip(&self.steps) {
            let rounded = |value: f64, unit: f64| (value * unit).round() / unit;
            let steps = steps.map_or("f64::NAN".to_owned(), |n| format!("{:?}", rounded(n, 1e4)));
            entries[s as usize] = format!("({:?}, {steps})", rounded(*p, 1e6));
        }
        let mut text = format!(
            "/// What an episode is worth that starts in each state: P(satisfied), and E[steps] given\n\
             /// success. Not a number where none starts, or none succeeds.\n#[rustfmt::skip]\n\
             pub static STARTS: [(f64, f64); {states}] = ["
        );
        let mut column = usize::MAX;
        for entry in entries {
            let fits = column < 95 - entry.len();
            text.push_str(if fits { " " } else { "\n    " });
            column = if fits { column + 1 } else { 4 } + entry.len() + 1;
            let _ = write!(text, "{entry},");
        }
        text.push_str("\n];\n");
        text
    }
}

/// What the policy is worth, as sentences.
fn certified(certificate: &Value) -> String {
    let number = |field: &str| certificate.get(field).and_then(Value::as_f64);
    let shown = |field: &str, digits: usize| {
        number(field).map_or("unknown".to_owned(), |value| format!("{value:.digits$}"))
    };
    format!(
        "Exact value, mean over the starts with the first state read: P(satisfied) = {} \
         (largest possible {}), E[steps | satisfied] = {} (smallest possible {}).",
        shown("satisfied", 6),
        shown("optimal_satisfied", 6),
        shown("steps", 4),
        shown("optimal_steps", 4)
    )
}

/// Nested fields as `name value`, in the order in which they were saved.
fn summary(value: &Value) -> String {
    match value {
        Value::Object(fields) => {
            let fields = fields.iter().map(|(name, value)| format!("{name} {}", summary(value)));
            fields.collect::<Vec<_>>().join(", ")
        }
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}

fn length(field: &str, entries: &[u32], expected: Option<usize>) -> Result<(), String> {
    match expected {
        Some(expected) if entries.len() == expected => Ok(()),
        Some(expected) => Err(format!("`{field}` has {} entries, not {expected}", entries.len())),
        None => Err(format!("`{field}` would be too large")),
    }
}

fn below(field: &str, entries: &[u32], limit: usize) -> Result<(), String> {
    match entries.iter().position(|&entry| entry as usize >= limit) {
        Some(at) => Err(format!("`{field}`, entry {at}: {} is not less than {limit}", entries[at])),
        None => Ok(()),
    }
}

/// A static array of the narrowest type that holds its entries, in rows.
fn table(text: &mut String, name: &str, about: &str, entries: &[u32]) {
    let most = entries.iter().copied().max().unwrap_or(0);
    let ty = match most {
        0..=0xff => "u8",
        0x100..=0xffff => "u16",
        _ => "u32",
    };
    let _ =
        write!(text, "/// {about}\n#[rustfmt::skip]\nstatic {name}: [{ty}; {}] = [", entries.len());
    let per_row = 90 / (most.to_string().len() + 2);
    for (i, entry) in entries.iter().enumerate() {
        text.push_str(if i % per_row == 0 { "\n    " } else { " " });
        let _ = write!(text, "{entry},");
    }
    text.push_str("\n];\n");
}

const FUNCTIONS: &str = "
/// The automaton state after the first state of an episode.
///
/// # Panics
/// If `s` is not below [`STATES`].
#[must_use]
pub fn reset(s: usize) -> usize {
    next(INITIAL, s)
}

/// The automaton state after `q` has read `s`.
///
/// # Panics
/// If `q` or `s` is out of range.
#[must_use]
pub fn next(q: usize, s: usize) -> usize {
    NEXT[q * CLASSES + CLASS[s] as usize] as usize
}

/// The action in `s` at `q`, an index of [`ACTIONS`].
///
/// # Panics
/// If `q` or `s` is out of range.
#[must_use]
pub fn act(q: usize, s: usize) -> usize {
    assert!(s < STATES, \"a state of the world\");
    ACTION[q * STATES + s] as usize
}

/// Whether an episode ends at `q`: accomplished, or lost.
#[must_use]
pub fn is_done(q: usize) -> bool {
    ACCEPTING == Some(q) || TRAP == Some(q)
}
";
