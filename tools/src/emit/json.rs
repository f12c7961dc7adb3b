//! Automata for other programs, one JSON object each.
//!
//! The keys and their order are a contract: `formula`, `propositions` (by order of first
//! appearance), `states`, `initial`, `accepting`, `trap` (or null), `edges` (distinct pairs q ≠ q'
//! of the complete automaton), `self_loops`, and on demand `transitions[q][v]`, bit i of v being
//! proposition i, or `guards`. A mistake is `formula` and `error` with `kind`, `message` and `span`.

use serde::Serialize;

use crate::emit::sum::{Notation, label};
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::source::{Source, Span};

/// The most propositions of a table of all transitions: 65,536 letters a state.
pub const MOST_PROPOSITIONS: usize = 16;

#[derive(Serialize)]
struct Automaton<'a> {
    formula: &'a str,
    propositions: &'a [String],
    states: usize,
    initial: State,
    accepting: Vec<State>,
    trap: Option<State>,
    edges: usize,
    self_loops: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    guards: Option<Vec<Transition>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    transitions: Option<Vec<Vec<State>>>,
}

#[derive(Serialize)]
struct Transition {
    from: State,
    to: State,
    guard: String,
}

#[derive(Serialize)]
struct Failure<'a> {
    formula: &'a str,
    error: Mistake<'a>,
}

#[derive(Serialize)]
struct Mistake<'a> {
    kind: &'a str,
    message: &'a str,
    span: [usize; 2],
}

#[derive(Serialize)]
struct Diagnostic<'a> {
    file: &'a str,
    severity: &'a str,
    kind: &'a str,
    message: &'a str,
    span: [usize; 2],
    line: usize,
    column: usize,
    related: Vec<Related<'a>>,
    help: &'a [String],
}

#[derive(Serialize)]
struct Related<'a> {
    span: [usize; 2],
    label: &'a str,
}

impl<'a> Automaton<'a> {
    fn new(formula: &'a str, dfa: &'a Dfa) -> Self {
        let size = dfa.size();
        Self {
            formula,
            propositions: &dfa.propositions,
            states: size.states,
            initial: 0,
            accepting: dfa.accepting.into_iter().collect(),
            trap: dfa.trap,
            edges: size.edges,
            self_loops: size.self_loops,
            guards: None,
            transitions: None,
        }
    }
}

/// The automaton in numbers, on one line.
#[must_use]
pub fn summary(formula: &str, dfa: &Dfa) -> String {
    line(&Automaton::new(formula, dfa))
}

/// The automaton with the table of all its transitions, on one line.
///
/// # Errors
/// If it has more than [`MOST_PROPOSITIONS`] propositions.
pub fn explicit(formula: &str, dfa: &Dfa) -> Result<String, Error> {
    let count = dfa.propositions.len();
    if count > MOST_PROPOSITIONS {
        let message = format!(
            "a table of all transitions would need 2^{count} columns: the formula has {count} \
             propositions, and at most {MOST_PROPOSITIONS} are written out"
        );
        return Err(Error::new(Kind::Budget, message, Span::new(0, formula.len()))
            .help("leave `--explicit` out: the guards of the edges say the same"));
    }
    let row = |q| (0..1_u32 << count).map(|v| dfa.next(q, |p| v >> p & 1 == 1)).collect();
    let transitions = Some(dfa.states().map(row).collect());
    Ok(line(&Automaton { transitions, ..Automaton::new(formula, dfa) }))
}

/// The automaton with the guards of its edges, self-loops included, over several lines.
#[must_use]
pub fn automaton(formula: &str, dfa: &Dfa) -> String {
    let guards = dfa.edges().into_iter().map(|edge| Transition {
        from: edge.from,
        to: edge.to,
        guard: label(dfa, &edge, Notation::Ascii),
    });
    let guards = Some(guards.collect());
    pretty(&Automaton { guards, ..Automaton::new(formula, dfa) })
}

/// What is wrong with a formula, on one line.
#[must_use]
pub fn failure(formula: &str, error: &Error) -> String {
    let span = [error.span().start, error.span().end];
    let error = Mistake { kind: error.kind().name(), message: error.message(), span };
    line(&Failure { formula, error })
}

/// A mistake of a file as editors want it, on one line: the file's name, the severity, the kind,
/// the message, the span in bytes, the line and the column of its start (both from 1), the other
/// places with their labels, and the help lines.
#[must_use]
pub fn report(source: &Source, error: &Error) -> String {
    let span = error.span();
    let place = source.place(span.start);
    let related =
        error.places().iter().map(|(span, label)| Related { span: [span.start, span.end], label });
    line(&Diagnostic {
        file: source.name(),
        severity: if error.is_warning() { "warning" } else { "error" },
        kind: error.kind().name(),
        message: error.message(),
        span: [span.start, span.end],
        line: place.line,
        column: place.column,
        related: related.collect(),
        help: error.helps(),
    })
}

fn line(value: &impl Serialize) -> String {
    serde_json::to_string(value).expect("strings and numbers are JSON")
}

fn pretty(value: &impl Serialize) -> String {
    serde_json::to_string_pretty(value).expect("strings and numbers are JSON") + "\n"
}
