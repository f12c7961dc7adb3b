//! Graphviz, for readers who want its layouts or styles. [`svg`](super::svg) draws without it.

use std::fmt::Write as _;

use crate::emit::labels::{Labelled, Labels, Text, TooLarge};
use crate::emit::sum::{Notation, escaped, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A digraph, laid out from left to right: the accepting state has two circles, the trap and the
/// edges into it are grey, and an arrow from a point marks the initial state.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let dot = tltlc::emit::dot::automaton("order", task.dfa())?.to_string();
/// assert!(dot.starts_with("digraph \"order\" {"));
/// assert!(dot.contains("  0 -> 1 [label=\"a\"];"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::labels::MOST_PRODUCTS).
pub fn automaton<'a>(title: &str, dfa: &'a Dfa) -> Result<Text<'a>, TooLarge> {
    let (head, labels) = (head(title, dfa), Labels::new(dfa, Notation::Ascii, &escaped)?);
    Ok(Text::new(move |out| {
        out.write_str(&head)?;
        labels.write(out, &|text, Labelled { to, ends: [from, into], guard, .. }| {
            let into_trap = dfa.trap == Some(to);
            let colour = if into_trap { ", color=gray40, fontcolor=gray40" } else { "" };
            for part in ["  ", from, " -> ", into, " [label=\"", guard, "\"", colour, "];\n"] {
                text.push_str(part);
            }
        })?;
        out.write_str("}\n")
    }))
}

/// Everything before the edges.
fn head(title: &str, dfa: &Dfa) -> String {
    let mut dot = format!("digraph {} {{\n", quoted(title));
    dot.push_str("  rankdir=LR;\n");
    dot.push_str("  node [shape=circle, fontname=\"Helvetica\"];\n");
    dot.push_str("  edge [fontname=\"Helvetica\", fontsize=11];\n");
    let _ = writeln!(dot, "  label={}; labelloc=t; fontname=\"Helvetica\";", quoted(title));
    dot.push_str("  start [shape=point, width=0.08, label=\"\"];\n");
    for q in dfa.states() {
        let _ = writeln!(dot, "  {q}{};", attributes(dfa, q));
    }
    dot.push_str("  start -> 0;\n");
    dot
}

/// The attributes by which the verdict of a state is seen.
fn attributes(dfa: &Dfa, q: State) -> &'static str {
    if dfa.accepting == Some(q) {
        " [shape=doublecircle]"
    } else if dfa.trap == Some(q) {
        " [style=dashed, color=gray40, fontcolor=gray40]"
    } else {
        ""
    }
}
