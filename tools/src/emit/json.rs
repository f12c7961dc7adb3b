//! Automata and diagnostics for other programs, one JSON object each.
//!
//! The keys and their order are a contract. An automaton has `formula`, `propositions` (in order of
//! first appearance), `states`, `initial`, `accepting` (a list of at most one), `trap` (or null),
//! `edges` and `self_loops` (numbers of pairs q ≠ q' and q = q' of the complete automaton), and on
//! demand `guards`, or `transitions[q][v]` where bit i of v is proposition i. A mistake has
//! `formula`, and `error` with `kind`, `message` and `span`.
//!
//! Spans count bytes from the beginning of the text, the end excluded.

use std::fmt::Write as _;

use serde::Serialize;

use crate::emit::labels::{Labelled, Labels, Text, TooLarge};
use crate::emit::sum::Notation;
use tltl_compiler::dfa::{Dfa, Size, State};
use tltl_compiler::error::{Error, Kind};
use tltl_compiler::source::{Source, Span, is_hidden};

/// The most propositions of a table of all transitions: 65,536 entries for each state. The guards
/// of the edges have no such limit.
pub const MOST_PROPOSITIONS: usize = 16;

#[derive(Serialize)]
struct Automaton<'a> {
    formula: &'a str,
    propositions: Vec<&'a str>,
    states: usize,
    initial: State,
    accepting: Vec<State>,
    trap: Option<State>,
    edges: usize,
    self_loops: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    transitions: Option<Vec<Vec<State>>>,
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
    fn new(formula: &'a str, dfa: &'a Dfa, size: Size) -> Self {
        Self {
            formula,
            propositions: dfa.propositions.iter().map(|one| one.name.as_str()).collect(),
            states: size.states,
            initial: 0,
            accepting: dfa.accepting.into_iter().collect(),
            trap: dfa.trap,
            edges: size.edges,
            self_loops: size.self_loops,
            transitions: None,
        }
    }
}

/// The sizes of an automaton, on one line.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("F a", Budget::default())?;
/// assert_eq!(
///     tltlc::emit::json::summary("F a", task.dfa()),
///     r#"{"formula":"F a","propositions":["a"],"states":2,"initial":0,"accepting":[1],"trap":null,"edges":1,"self_loops":2}"#
/// );
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn summary(formula: &str, dfa: &Dfa) -> String {
    line(&Automaton::new(formula, dfa, dfa.size()))
}

/// The automaton with the table of all its transitions, on one line.
///
/// # Errors
/// If it has more than [`MOST_PROPOSITIONS`] propositions.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let table = tltlc::emit::json::explicit("a T b", task.dfa())?;
/// // From state 0 letters 1 and 3, which have `a`, lead to state 1.
/// assert!(table.ends_with(r#""transitions":[[0,1,0,1],[1,1,2,2],[2,2,2,2]]}"#));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    Ok(line(&Automaton { transitions, ..Automaton::new(formula, dfa, dfa.size()) }))
}

/// The automaton with the guards of its edges, self-loops included, one a line. A guard is a
/// formula of the language.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let json = tltlc::emit::json::automaton("a T b", task.dfa())?.to_string();
/// let read: serde_json::Value = serde_json::from_str(&json)?;
/// assert_eq!(read["states"], 3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::labels::MOST_PRODUCTS).
pub fn automaton<'a>(formula: &str, dfa: &'a Dfa) -> Result<Text<'a>, TooLarge> {
    let escaped = |text: &str| line(&text).trim_matches('"').to_owned();
    let labels = Labels::new(dfa, Notation::Ascii, &escaped)?;
    let mut head = pretty(&Automaton::new(formula, dfa, labels.size));
    head.truncate(head.len() - "\n}\n".len());
    Ok(Text::new(move |out| {
        write!(out, "{head},\n  \"guards\": [")?;
        labels.write(
            out,
            &|text, Labelled { from, ends: [number, to], guard, is_first, .. }| {
                let separator = if is_first && from == 0 { "\n" } else { ",\n" };
                let [from, to] =
                    [[separator, "    {\"from\": ", number], [", \"to\": ", to, ", \"guard\": \""]];
                for part in [from, to, [guard, "\"}", ""]].as_flattened() {
                    text.push_str(part);
                }
            },
        )?;
        out.write_str("\n  ]\n}\n")
    }))
}

/// A mistake of a formula, on one line: the form in which a list of formulas reports one of them.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let error = tltlc::task::compile("G a", Budget::default()).unwrap_err();
/// let line = tltlc::emit::json::failure("G a", error.errors().first());
/// assert!(line.starts_with(r#"{"formula":"G a","error":{"kind":"unsupported-operator","#));
/// ```
#[must_use]
pub fn failure(formula: &str, error: &Error) -> String {
    let span = [error.span().start, error.span().end];
    let error = Mistake { kind: error.kind().name(), message: error.message(), span };
    line(&Failure { formula, error })
}

/// A mistake or a warning of a file in the form that editors want, on one line.
///
/// It has the name of the file, the severity, the kind, the message, the span in bytes, the line
/// and the column of its start (both from 1; the column counts characters), the other places with
/// their labels, and the help lines.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::task::TaskFile;
///
/// let error = TaskFile::of_formula("F near && !F far", Budget::default()).unwrap_err();
/// let line = tltlc::emit::json::report(error.source_text(), error.errors().first());
/// let report: serde_json::Value = serde_json::from_str(&line)?;
/// assert_eq!((&report["kind"], &report["column"]), (&"negated-temporal".into(), &11.into()));
/// # Ok::<(), serde_json::Error>(())
/// ```
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

/// An object on one line, in characters that a terminal shows: JSON itself escapes only those below
/// U+0020, and the others that are obeyed stand in strings alone.
pub(crate) fn line(value: &impl Serialize) -> String {
    shown(serde_json::to_string(value).expect("strings and numbers are JSON"))
}

/// An object over several lines, with a line break at the end.
fn pretty(value: &impl Serialize) -> String {
    shown(serde_json::to_string_pretty(value).expect("strings and numbers are JSON")) + "\n"
}

fn shown(json: String) -> String {
    let is_obeyed = |c: char| c != '\n' && is_hidden(c);
    if !json.contains(is_obeyed) {
        return json;
    }
    json.chars().fold(String::new(), |mut shown, c| {
        // All of them are below U+10000.
        let _ = if is_obeyed(c) {
            write!(shown, "\\u{:04x}", u32::from(c))
        } else {
            write!(shown, "{c}")
        };
        shown
    })
}
