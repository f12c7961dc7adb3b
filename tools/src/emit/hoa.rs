//! The Hanoi Omega-Automata format, version 1, which Spot, Owl and others read.
//!
//! The automaton is written as a deterministic, complete, state-based Büchi automaton whose only
//! accepting state is absorbing. Read as finite-trace (a trace is accepted if its run ends in an
//! accepting state) it is the task's automaton; read as Büchi it accepts the infinite traces with
//! an accepted prefix.

use std::fmt::Write as _;

use crate::emit::sum::{Notation, Sum, quoted};
use tltl_compiler::dfa::{Dfa, Edge, State};

/// HOA v1. Letters that cannot occur go where the automaton sends them: edges stay disjoint.
#[must_use]
pub fn automaton(title: &str, dfa: &Dfa) -> String {
    let free = Dfa { possible: None, ..dfa.clone() };
    let mut hoa = header(title, dfa);
    let mut last = None;
    for edge in free.edges() {
        if last.replace(edge.from) != Some(edge.from) {
            let _ = writeln!(hoa, "State: {}{}", edge.from, mark(dfa, edge.from));
        }
        hoa.push_str(&row(dfa, &edge));
    }
    hoa.push_str("--END--\n");
    hoa
}

fn header(title: &str, dfa: &Dfa) -> String {
    let mut hoa = format!("HOA: v1\nname: {}\n", quoted(title));
    let _ = writeln!(hoa, "tool: \"tltlc\" \"{}\"", env!("CARGO_PKG_VERSION"));
    let _ = writeln!(hoa, "States: {}\nStart: 0", dfa.len());
    let _ = write!(hoa, "AP: {}", dfa.propositions.len());
    for name in &dfa.propositions {
        let _ = write!(hoa, " {}", quoted(name));
    }
    hoa.push_str("\nacc-name: Buchi\nAcceptance: 1 Inf(0)\n");
    hoa.push_str("properties: trans-labels explicit-labels state-acc\n");
    hoa.push_str("properties: deterministic complete terminal\n--BODY--\n");
    hoa
}

fn mark(dfa: &Dfa, q: State) -> &'static str {
    if dfa.accepting == Some(q) { " {0}" } else { "" }
}

fn row(dfa: &Dfa, edge: &Edge) -> String {
    let label = Sum::new(&dfa.propositions, &edge.guard).notation(Notation::Numbered);
    format!("[{label}] {}\n", edge.to)
}
