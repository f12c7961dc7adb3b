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

use super::body::{Body, Described, Edge};
use super::header::{Acceptance, Header};
use super::{refused, terminal};
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
    let marked = accepting(header.acceptance, &dfa, &states);
    let accepting = match marked.and_then(|marked| check(&dfa, &states, marked)) {
        Ok(accepting) => accepting,
        Err(error) => decided(header, &dfa, &states).ok_or(error)?,
    };
    Ok(merge(dfa, &accepting))
}

/// The accepting states of an automaton on infinite words that is [terminal]. Marks on states could
/// also mean that traces which end there are accepted, so it must say then that it is terminal.
fn decided(header: &Header, dfa: &Dfa, states: &[Described]) -> Option<Vec<bool>> {
    let is_infinite = header.acceptance == Acceptance::All || has_marked_edges(states);
    if !header.is_terminal && !is_infinite {
        return None;
    }
    let accepting = terminal::accepting(header.acceptance, dfa, states)?;
    (header.is_terminal || accepting.contains(&true)).then_some(accepting)
}

fn has_marked_edges(states: &[Described]) -> bool {
    states.iter().any(|state| state.edges.iter().any(|edge| !edge.marks.is_empty()))
}

/// Whether acceptance wants an edge to be taken: it has the mark, on itself or on its state, that
/// `Inf` asks for, or not the one that `Fin` forbids.
pub(super) fn is_good(acceptance: Acceptance, state: &Described, edge: &Edge) -> bool {
    let has = |set| edge.marks.contains(&set) || state.marks.contains(&set);
    match acceptance {
        Acceptance::All => true,
        Acceptance::None => false,
        Acceptance::In(set) => has(set),
        Acceptance::Outside(set) => !has(set),
    }
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
    if !has_marked_edges(states) {
        return Ok(states.iter().map(|state| state.marks.contains(&set) == inside).collect());
    }
    let good = |state: &Described, edge: &Edge| is_good(acceptance, state, edge);
    let all_good = |state: &Described| state.edges.iter().all(|edge| good(state, edge));
    let accepting = closed(dfa, states, states.iter().map(all_good).collect());
    for (state, here) in states.iter().zip(&accepting) {
        for edge in &state.edges {
            if good(state, edge) != accepting[edge.to as usize] && !here {
                return Err(ambiguous(edge.span));
            }
        }
    }
    Ok(accepting)
}

/// The largest set of states among `kept` that lead only to each other: a greatest fixed point,
/// computed backwards from the states that fall out of it.
pub(super) fn closed(dfa: &Dfa, states: &[Described], mut kept: Vec<bool>) -> Vec<bool> {
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
fn check(dfa: &Dfa, states: &[Described], accepting: Vec<bool>) -> Result<Vec<bool>, Error> {
    for (state, _) in states.iter().zip(&accepting).filter(|(_, accepts)| **accepts) {
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
    Ok(accepting)
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
