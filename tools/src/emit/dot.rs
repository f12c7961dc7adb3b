//! Graphviz, for readers who want its layouts or styles. [`svg`](super::svg) draws without it.

use std::fmt::Write as _;

use crate::emit::sum::{Labels, Notation, TooLarge, escaped, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A digraph, laid out from left to right: the accepting state has two circles, the trap and the
/// edges into it are grey, and an arrow from a point marks the initial state.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let dot = tltlc::emit::dot::automaton("order", task.dfa())?;
/// assert!(dot.starts_with("digraph \"order\" {"));
/// assert!(dot.contains("  0 -> 1 [label=\"a\"];"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::sum::MOST_PRODUCTS).
pub fn automaton(title: &str, dfa: &Dfa) -> Result<String, TooLarge> {
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
    Labels::new(dfa, Notation::Ascii, &escaped)?.visit(&mut |from, to, label| {
        let into_trap = dfa.trap == Some(to);
        let colour = if into_trap { ", color=gray40, fontcolor=gray40" } else { "" };
        let _ = writeln!(dot, "  {from} -> {to} [label=\"{label}\"{colour}];");
    });
    dot.push_str("}\n");
    Ok(dot)
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
