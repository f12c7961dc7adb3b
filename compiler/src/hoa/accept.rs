//! Which states accept, and that they accept for good.
//!
//! A formula of the language is co-safe, so its automaton has absorbing acceptance. An automaton
//! from elsewhere need not have it: this module finds the accepting states under each acceptance
//! condition, refuses those that can be left, and then merges them into one.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! // `GF a`: it accepts, and may be left again.
//! let text = "HOA: v1 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0) --BODY--
//!     State: 0 [0] 1 [!0] 0 State: 1 {0} [0] 1 [!0] 0 --END--";
//! let error = hoa::read(&Source::new("often.hoa", text)).unwrap_err();
//! assert_eq!(error.kind().name(), "automaton");
//! ```

use super::body::{Body, Described};
use super::header::{Acceptance, Header};
use super::refused;
use crate::bdd::Bdd;
use crate::dfa::{Dfa, State};
use crate::error::Error;

/// The automaton with one accepting state for all, and a trap for missing transitions.
pub(super) fn finish(header: &mut Header, body: Body) -> Result<Dfa, Error> {
    let states: Vec<Described> = body.states.into_iter().flatten().collect();
    let trap = states.len() as State;
    let mut transitions: Vec<Bdd> = states.iter().map(|state| state.transitions).collect();
    transitions.push(Bdd::leaf(trap));
    let dfa = Dfa {
        propositions: std::mem::take(&mut header.propositions),
        diagram: std::mem::take(&mut header.labels.diagram),
        transitions,
        accepting: None,
        trap: None,
        possible: None,
    };
    let accepting = accepting(header.acceptance, &dfa, &states)?;
    check(&dfa, &states, &accepting)?;
    Ok(merge(dfa, &accepting))
}

/// For each state whether a trace that ends in it is accepted.
///
/// With marks on edges, acceptance on infinite words alone would not say when a finite trace is
/// accepted. The accepting states are then the largest set that only good edges leave and that is
/// closed; an edge from outside must be good iff it enters the set, or the automaton is refused as
/// ambiguous.
fn accepting(acceptance: Acceptance, dfa: &Dfa, states: &[Described]) -> Result<Vec<bool>, Error> {
    let (set, inside) = match acceptance {
        Acceptance::All => return Ok(vec![true; states.len()]),
        Acceptance::None => return Ok(vec![false; states.len()]),
        Acceptance::In(set) => (set, true),
        Acceptance::Outside(set) => (set, false),
    };
    if states.iter().all(|state| state.edges.iter().all(|edge| edge.marks.is_empty())) {
        return Ok(states.iter().map(|state| state.marks.contains(&set) == inside).collect());
    }
    let good = |state: &Described, marks: &[u32]| {
        (marks.contains(&set) || state.marks.contains(&set)) == inside
    };
    let accepting =
        closed(dfa, states, &|state| state.edges.iter().all(|edge| good(state, &edge.marks)));
    for (state, here) in states.iter().zip(&accepting) {
        for edge in &state.edges {
            if good(state, &edge.marks) != accepting[edge.to as usize] && !here {
                return Err(ambiguous(edge.span));
            }
        }
    }
    Ok(accepting)
}

/// The largest set of states that satisfy `good` and lead only to each other: a greatest fixed
/// point, computed backwards from the states that fall out of it.
fn closed(dfa: &Dfa, states: &[Described], good: &dyn Fn(&Described) -> bool) -> Vec<bool> {
    let mut kept: Vec<bool> = states.iter().map(good).collect();
    let mut before = vec![Vec::new(); states.len()];
    let mut lost = Vec::new();
    for (q, state) in (0..).zip(states) {
        for to in dfa.diagram.leaves(state.transitions) {
            match before.get_mut(to as usize) {
                Some(before) => before.push(q),
                None => kept[q] = false,
            }
        }
    }
    lost.extend((0..kept.len()).filter(|&q| !kept[q]));
    while let Some(q) = lost.pop() {
        for &p in &before[q] {
            if std::mem::replace(&mut kept[p], false) {
                lost.push(p);
            }
        }
    }
    kept
}

/// The error for edge marks that do not determine acceptance of finite traces.
fn ambiguous(span: crate::source::Span) -> Error {
    refused(
        "the acceptance marks on edges do not tell when a finite trace is accepted for good",
        span,
    )
    .help("write the automaton with state-based acceptance (Spot: `-S` or `--state-based-acceptance`)")
}

/// Refuses an accepting state that can be left.
fn check(dfa: &Dfa, states: &[Described], accepting: &[bool]) -> Result<(), Error> {
    for (state, _) in states.iter().zip(accepting).filter(|(_, accepts)| **accepts) {
        for to in dfa.diagram.leaves(state.transitions) {
            let message = match states.get(to as usize) {
                Some(_) if accepting[to as usize] => continue,
                Some(to) => format!(
                    "state {} accepts, but can go on to state {}, which does not: what is true of \
                     a trace must stay true when it goes on",
                    state.number, to.number
                ),
                None => format!(
                    "state {} accepts, but some letters have no transition from it: what is true \
                     of a trace must stay true when it goes on",
                    state.number
                ),
            };
            return Err(refused(message, state.span).help(
                "only co-safe tasks can be used; on infinite traces the automaton may be \
                       one, with accepting states that matter only there",
            ));
        }
    }
    Ok(())
}

/// Merges all accepting states into one and lets missing transitions lead to the trap. The initial
/// state accepts too if every first letter is accepted.
fn merge(mut dfa: Dfa, accepting: &[bool]) -> Dfa {
    let trap = accepting.len() as State;
    let first = accepting.iter().position(|&accepts| accepts).map(|q| q as State);
    let rename = |state: State| match accepting.get(state as usize) {
        Some(true) => first.unwrap_or(state),
        Some(false) => state,
        None => trap,
    };
    let renamed = |state| Bdd::leaf(rename(state));
    (dfa.diagram, dfa.transitions) = dfa.diagram.map_leaves(&dfa.transitions, &renamed);
    dfa.accepting = first;
    if first.is_some_and(|first| dfa.transitions[0] == Bdd::leaf(first)) {
        dfa.accepting = Some(0);
        dfa.transitions[0] = Bdd::leaf(0);
    }
    dfa
}
