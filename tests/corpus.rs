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

/// A formula outside the language.
#[derive(Deserialize)]
pub(crate) struct Reject {
    pub(crate) formula: String,
    pub(crate) expect: String,
}

/// The rows of the corpus, corner cases last.
pub(crate) fn rows() -> Vec<Row> {
    let mut rows = read("corpus.jsonl");
    rows.extend(read("corner.jsonl"));
    rows
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
