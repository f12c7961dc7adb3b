//! Automata on infinite words whose acceptance is decided at some instant, wherever their marks
//! stand.
//!
//! An automaton is *terminal* if its accepting cycles lie in a set of states that is complete and
//! cannot be left, and in which every cycle accepts. Then a word is accepted iff its run enters that
//! set, and marks elsewhere change nothing (Černá and Pelánek, "Relating Hierarchy of Temporal
//! Properties to Model Checking", 2003). Other automata accept by what happens infinitely often, so
//! no finite trace decides.

use super::accept::{closed, is_good};
use super::body::{Described, Edge};
use super::header::Acceptance;
use crate::dfa::Dfa;

/// For each state whether it is in the closed set; `None` if the automaton is not terminal.
pub(super) fn accepting(
    acceptance: Acceptance,
    dfa: &Dfa,
    states: &[Described],
) -> Option<Vec<bool>> {
    let component = components(states);
    let mut inner: Vec<Vec<(usize, &Edge)>> = vec![Vec::new(); states.len()];
    for (q, state) in states.iter().enumerate() {
        let stays = |edge: &&Edge| component[edge.to as usize] == component[q];
        inner[component[q]].extend(state.edges.iter().filter(stays).map(|edge| (q, edge)));
    }
    let cycles = inner.iter().map(|edges| cycles(acceptance, states, edges));
    let cycles = cycles.collect::<Option<Vec<Cycles>>>()?;
    let of = |q: usize| cycles[component[q]];
    let is_candidate = |q: usize| match of(q) {
        Cycles::None => states[q].edges.iter().all(|edge| is_good(acceptance, &states[q], edge)),
        cycles => cycles == Cycles::Accepting,
    };
    let kept = closed(dfa, states, (0..states.len()).map(is_candidate).collect());
    let all_kept = (0..states.len()).all(|q| kept[q] || of(q) != Cycles::Accepting);
    all_kept.then_some(kept)
}

/// Which cycles a strongly connected component has.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Cycles {
    None,
    Accepting,
    Rejecting,
}

/// The cycles of a component with these edges; `None` if some accept and some do not.
fn cycles(
    acceptance: Acceptance,
    states: &[Described],
    edges: &[(usize, &Edge)],
) -> Option<Cycles> {
    let (good, bad): (Vec<_>, Vec<_>) =
        edges.iter().partition(|(q, edge)| is_good(acceptance, &states[*q], edge));
    match (good.is_empty(), bad.is_empty()) {
        (true, true) => Some(Cycles::None),
        (false, true) => Some(Cycles::Accepting),
        (true, false) => Some(Cycles::Rejecting),
        // `Inf` asks for one good edge on the cycle, `Fin` for no bad one.
        _ if matches!(acceptance, Acceptance::In(_)) => {
            is_acyclic(states.len(), &bad).then_some(Cycles::Accepting)
        }
        _ => is_acyclic(states.len(), &good).then_some(Cycles::Rejecting),
    }
}

/// Whether edges form no cycle: states without an edge into them are taken away until none is left
/// (Kahn, 1962).
fn is_acyclic(states: usize, edges: &[(usize, &Edge)]) -> bool {
    let (mut into, mut out) = (vec![0_usize; states], vec![Vec::new(); states]);
    for (from, edge) in edges {
        into[edge.to as usize] += 1;
        out[*from].push(edge.to as usize);
    }
    let mut free: Vec<usize> = (0..states).filter(|&q| into[q] == 0).collect();
    let mut taken = 0;
    while let Some(q) = free.pop() {
        taken += 1;
        for &to in &out[q] {
            into[to] -= 1;
            free.extend((into[to] == 0).then_some(to));
        }
    }
    taken == states
}

/// The strongly connected component of each state, by numbers below that of states: the states
/// that reach each other (Kosaraju, by Sharir, "A Strong-Connectivity Algorithm", 1981).
fn components(states: &[Described]) -> Vec<usize> {
    let mut before = vec![Vec::new(); states.len()];
    for (q, state) in states.iter().enumerate() {
        state.edges.iter().for_each(|edge| before[edge.to as usize].push(q));
    }
    let (mut component, mut count) = (vec![usize::MAX; states.len()], 0);
    for &root in finished(states).iter().rev() {
        let mut stack = vec![root];
        let is_new = component[root] == usize::MAX;
        while let Some(q) = stack.pop() {
            if component[q] == usize::MAX {
                component[q] = count;
                stack.extend(&before[q]);
            }
        }
        count += usize::from(is_new);
    }
    component
}

/// The states in the order in which a depth-first search leaves them.
fn finished(states: &[Described]) -> Vec<usize> {
    let (mut seen, mut order) = (vec![false; states.len()], Vec::new());
    for root in 0..states.len() {
        let mut stack = vec![(root, 0)];
        stack.truncate(usize::from(!std::mem::replace(&mut seen[root], true)));
        while let Some((q, next)) = stack.pop() {
            match states[q].edges.get(next) {
                None => order.push(q),
                Some(edge) => {
                    stack.push((q, next + 1));
                    let to = edge.to as usize;
                    if !std::mem::replace(&mut seen[to], true) {
                        stack.push((to, 0));
                    }
                }
            }
        }
    }
    order
}
