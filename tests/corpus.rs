//! The corpus: formulas with their minimal automata, as data.

use std::path::Path;

use serde::Deserialize;

/// One formula with its minimal automaton and traces with their verdicts.
#[derive(Deserialize)]
pub(crate) struct Row {
    pub(crate) id: String,
    pub(crate) formula: String,
    /// Propositions, sorted; proposition i is bit i of a letter.
    pub(crate) aps: Vec<String>,
    pub(crate) states: usize,
    pub(crate) accepting: Vec<u32>,
    pub(crate) trap: Option<u32>,
    pub(crate) edges: usize,
    pub(crate) self_loops: usize,
    /// Left out where the table is large; the checksum remains.
    pub(crate) transitions: Option<Vec<Vec<u32>>>,
    pub(crate) sha256: String,
    pub(crate) traces: Vec<Trace>,
}

/// A trace and when the formula is first satisfied on it.
#[derive(Deserialize)]
pub(crate) struct Trace {
    pub(crate) letters: Vec<u64>,
    pub(crate) accept: bool,
    /// The number of letters read when the automaton first accepts.
    pub(crate) first_accept: Option<usize>,
}

/// A formula with a trace and the robustness of every prefix of it.
#[derive(Deserialize)]
pub(crate) struct Robustness {
    pub(crate) formula: String,
    pub(crate) aps: Vec<String>,
    /// For each instant the robustness of each proposition.
    pub(crate) trace: Vec<Vec<f64>>,
    pub(crate) rho_prefixes: Vec<Rho>,
}

/// A number, or an infinity as text.
#[derive(Deserialize)]
#[serde(untagged)]
pub(crate) enum Rho {
    Number(f64),
    Infinite(String),
}

impl Rho {
    pub(crate) fn value(&self) -> f64 {
        match self {
            Self::Number(value) => *value,
            Self::Infinite(text) => text.parse().unwrap(),
        }
    }
}

/// A formula outside the language.
#[derive(Deserialize)]
pub(crate) struct Reject {
    pub(crate) formula: String,
    pub(crate) expect: String,
}

/// The rows of the corpus: without bounds, corner cases, with bounds.
pub(crate) fn rows() -> Vec<Row> {
    ["corpus.jsonl", "corner.jsonl", "bounded.jsonl"].into_iter().flat_map(read).collect()
}

/// Formulas with the robustness of every prefix of a trace.
pub(crate) fn robustness() -> Vec<Robustness> {
    read("robustness.jsonl")
}

/// The formulas outside the language.
pub(crate) fn rejects() -> Vec<Reject> {
    read("rejects.jsonl")
}

fn read<T: for<'de> Deserialize<'de>>(name: &str) -> Vec<T> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data").join(name);
    let text = std::fs::read_to_string(path).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}
