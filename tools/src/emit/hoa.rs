//! The Hanoi Omega-Automata format, version 1 (Babiak et al., "The Hanoi Omega-Automata Format",
//! 2015), which Spot, Owl and others read.
//!
//! The automaton is written as a deterministic, complete, state-based Büchi automaton whose only
//! accepting state is absorbing. Read over finite traces (a trace is accepted if its run ends in an
//! accepting state) it is the task's automaton. Read as Büchi automaton it accepts the infinite
//! traces that have an accepted prefix. Both readings agree because a satisfied task stays
//! satisfied.
//!
//! The compiler reads the format again (feature `hoa`); the tests write automata and
//! read them back.

use std::fmt::Write as _;

use crate::emit::labels::{Labelled, Labels, Text, TooLarge};
use crate::emit::sum::{Notation, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// The automaton in HOA v1, with one label for each pair of states.
///
/// Letters that arithmetic excludes are written with the others, where the automaton sends them:
/// the format has no letters that cannot occur, and the labels of a state must cover all and be
/// disjoint.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("F a", Budget::default())?;
/// let hoa = tltlc::emit::hoa::automaton("reach", task.dfa())?.to_string();
/// assert!(hoa.ends_with("State: 0\n[!0] 0\n[0] 1\nState: 1 {0}\n[t] 1\n--END--\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::labels::MOST_PRODUCTS).
pub fn automaton<'a>(title: &str, dfa: &'a Dfa) -> Result<Text<'a>, TooLarge> {
    let header = header(title, dfa);
    let labels = Labels::of_all_letters(dfa, Notation::Numbered, &str::to_owned)?;
    Ok(Text::new(move |out| {
        out.write_str(&header)?;
        labels.write(
            out,
            &|text, Labelled { from, ends: [number, to], guard, is_first, .. }| {
                if is_first {
                    let _ = writeln!(text, "State: {number}{}", mark(dfa, from));
                }
                for part in ["[", guard, "] ", to, "\n"] {
                    text.push_str(part);
                }
            },
        )?;
        out.write_str("--END--\n")
    }))
}

/// Everything before the states. `terminal` says that accepting states are absorbing.
fn header(title: &str, dfa: &Dfa) -> String {
    let mut hoa = format!("HOA: v1\nname: {}\n", quoted(title));
    let _ = writeln!(hoa, "tool: \"tltlc\" \"{}\"", env!("CARGO_PKG_VERSION"));
    let _ = writeln!(hoa, "States: {}\nStart: 0", dfa.len());
    let _ = write!(hoa, "AP: {}", dfa.propositions.len());
    for one in &dfa.propositions {
        let _ = write!(hoa, " {}", quoted(&one.name));
    }
    hoa.push_str("\nacc-name: Buchi\nAcceptance: 1 Inf(0)\n");
    hoa.push_str("properties: trans-labels explicit-labels state-acc\n");
    hoa.push_str("properties: deterministic complete terminal\n--BODY--\n");
    hoa
}

/// The acceptance set of a state.
fn mark(dfa: &Dfa, q: State) -> &'static str {
    if dfa.accepting == Some(q) { " {0}" } else { "" }
}
