//! An automaton as a table that a person reads.

use std::fmt::Write as _;

use crate::emit::sum::{Notation, label};
use tltl_compiler::dfa::{Dfa, Edge, Size, State};

/// The sizes under every convention, then each state with its edges and their guards. The initial
/// state is marked `>`, the accepting one `*`, the trap `x`.
#[must_use]
pub fn automaton(title: &str, dfa: &Dfa) -> String {
    let mut text = format!("{title}\n\n{}\n", sizes(dfa.size()));
    let width = dfa.len().to_string().len().max(4);
    let _ = writeln!(text, "   {:>width$}  {:>width$}  when", "from", "to");
    for edge in dfa.edges() {
        let _ = writeln!(text, "{}", row(dfa, &edge, width));
    }
    text.push_str(legend(dfa));
    text
}

/// How many states and edges, with the trap and without.
#[must_use]
pub fn sizes(size: Size) -> String {
    let mut text = format!("{:<18}{:>8}{:>8}{:>14}\n", "", "states", "edges", "and loops");
    let mut row = |label: &str, states: usize, edges: usize, loops: usize| {
        let _ = writeln!(text, "{label:<18}{states:>8}{edges:>8}{:>14}", edges + loops);
    };
    let trap = usize::from(size.trap);
    row(
        if size.trap { "with the trap" } else { "no trap" },
        size.states,
        size.edges,
        size.self_loops,
    );
    if size.trap {
        let edges = size.edges - size.into_trap;
        row("without the trap", size.states - trap, edges, size.self_loops - trap);
    }
    text
}

fn row(dfa: &Dfa, edge: &Edge, width: usize) -> String {
    let guard = label(dfa, edge, Notation::Ascii);
    let first = dfa.successors(edge.from).first() == Some(&edge.to);
    let (mark, from) =
        if first { (mark(dfa, edge.from), edge.from.to_string()) } else { ("", String::new()) };
    format!("{mark:<2} {from:>width$}  {:>width$}  {guard}", edge.to)
}

fn mark(dfa: &Dfa, q: State) -> &'static str {
    match (q == 0, dfa.accepting == Some(q), dfa.trap == Some(q)) {
        (true, true, _) => ">*",
        (true, _, true) => ">x",
        (true, ..) => ">",
        (_, true, _) => "*",
        (_, _, true) => "x",
        _ => "",
    }
}

fn legend(dfa: &Dfa) -> &'static str {
    match (dfa.accepting, dfa.trap) {
        (Some(_), Some(_)) => "\n> initial   * accepting   x trap\n",
        (Some(_), None) => "\n> initial   * accepting\n",
        (None, _) => "\n> initial   x trap: nothing is ever accepted\n",
    }
}
