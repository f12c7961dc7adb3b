//! Any complete automaton to the canonical minimal one of its language.
//!
//! # Method
//!
//! Partition refinement on the shared diagram (`refine`). Every node is rewritten with the classes
//! of the states that it leads to, and states are separated where their rewritten transitions
//! differ: Moore's criterion ("Gedanken-experiments on Sequential Machines", 1956), at one hash a
//! node, however many letters there are. What a round rewrites are the nodes above states whose
//! class has a new number, and of the parts of a class the largest keeps the old one: Hopcroft's
//! idea ("An n log n Algorithm for Minimizing States in a Finite Automaton", 1971; for relations
//! Paige and Tarjan, 1987). Hopcroft splits by the predecessors under one letter; over 2^n letters
//! in a diagram these would be the preimage of a class under each path. Here the nodes above a
//! state are its predecessors under all letters at once, and the array of members that makes a
//! split cost its smaller parts is that of Valmari and Lehtinen ("Efficient Minimization of DFAs
//! with Partial Transition Functions", 2008).
//!
//! Afterwards states are numbered breadth-first, letters in lexicographic order, and the diagram is
//! laid out anew in that order: equal languages over equal propositions give equal automata, byte
//! for byte.
//!
//! # Cost
//!
//! A state moves to a class with a new number at most log₂ n times, and each time the nodes above
//! it are rewritten at most once. In the automaton of `F[0,n] a`, where all states but two are one
//! letter from acceptance and the n rounds separate one state each, that is linear: 10,003 states
//! take 2.5 ms, and took 2,850 ms while each round rewrote all nodes. The price is paid where few
//! rounds change most states: those of `F (a && X[16] b)`, 65,537, took 86 ms in rounds that rewrote all
//! nodes and 160 ms in rounds that looked for them. A round that moves many states takes all nodes again, which
//! gets a third of the difference back.
//!
//! ```
//! use tltl_compiler::{check, minimize::minimize, source::Source, translate::{Budget, translate}};
//!
//! let minimal = |text: &str| {
//!     let module = check::formula(&Source::new("formula", text)).unwrap();
//!     minimize(&translate(&module.tasks[0].spec, Budget::EMITTED).unwrap())
//! };
//! // Equal languages: equal automata, whatever the formula.
//! let [one, other] = ["F (a && F b)", "F (a && (true U b)) || F (a && b)"].map(minimal);
//! assert_eq!(one.transitions, other.transitions);
//! assert_eq!(one.diagram.nodes(), other.diagram.nodes());
//! ```

mod refine;

use crate::bdd::Bdd;
use crate::dfa::{Dfa, State};

/// The minimal complete automaton with the same language, in canonical numbering.
///
/// Letters that cannot occur ([`Dfa::possible`]) must have been given away beforehand, see
/// [`Possible::restrict`](crate::arithmetic::Possible::restrict); the result has no `possible`.
#[must_use]
pub fn minimize(dfa: &Dfa) -> Dfa {
    let classes = refine::classes(dfa);
    renumber(dfa, &classes)
}

/// The same states in canonical numbering, unreachable ones dropped, and the old number of each new
/// state. Merges nothing: for a raw automaton that is to be shown.
///
/// ```
/// use tltl_compiler::{check, minimize::canonical_order, source::Source};
/// use tltl_compiler::translate::{Budget, translate};
///
/// let module = check::formula(&Source::new("formula", "F a || F b"))?;
/// let raw = translate(&module.tasks[0].spec, Budget::EMITTED).unwrap();
/// let (ordered, numbers) = canonical_order(&raw);
/// assert_eq!(ordered.len(), numbers.len());
/// assert_eq!(numbers[0], 0);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn canonical_order(dfa: &Dfa) -> (Dfa, Vec<State>) {
    let apart: Vec<_> = dfa.states().collect();
    (renumber(dfa, &apart), breadth_first(dfa, &apart, &apart))
}

/// The automaton of the classes that the initial state reaches, numbered breadth-first. The trap is
/// found anew: a class may be one although no state of the raw automaton was marked.
fn renumber(dfa: &Dfa, classes: &[State]) -> Dfa {
    let count = classes.iter().max().map_or(0, |&last| last as usize + 1);
    let mut representative = vec![0; count];
    // Backwards, so that the first state of a class represents it.
    dfa.states().rev().for_each(|q| representative[classes[q as usize] as usize] = q);
    let order = breadth_first(dfa, classes, &representative);
    let mut number = vec![0; count];
    (0..).zip(&order).for_each(|(fresh, &class)| number[class as usize] = fresh);
    let rename = |state: State| number[classes[state as usize] as usize];
    let root = |&class: &State| dfa.transitions[representative[class as usize] as usize];
    let roots: Vec<Bdd> = order.iter().map(root).collect();
    let (diagram, transitions) = dfa.diagram.map_leaves(&roots, &|q| Bdd::leaf(rename(q)));
    let kept = |state: &State| order.contains(&classes[*state as usize]);
    let accepting = dfa.accepting.filter(kept).map(rename);
    let is_trap = |&q: &State| accepting != Some(q) && transitions[q as usize] == Bdd::leaf(q);
    Dfa {
        propositions: dfa.propositions.clone(),
        accepting,
        trap: (0..transitions.len() as State).find(is_trap),
        diagram,
        transitions,
        possible: None,
    }
}

/// The classes that the initial state reaches, breadth-first, letters in lexicographic order. A
/// node that has been walked leads to nothing new, so all walks together are linear in the diagram.
fn breadth_first(dfa: &Dfa, classes: &[State], representative: &[State]) -> Vec<State> {
    let mut seen = vec![false; representative.len()];
    let mut walked = vec![false; dfa.diagram.nodes().len()];
    let mut order = vec![classes[0]];
    seen[classes[0] as usize] = true;
    let mut at = 0;
    while let Some(&class) = order.get(at) {
        at += 1;
        let root = dfa.transitions[representative[class as usize] as usize];
        let enter = &mut |index| !std::mem::replace(&mut walked[index as usize], true);
        dfa.diagram.walk(root, enter, &mut |state| {
            let to = classes[state as usize];
            if !std::mem::replace(&mut seen[to as usize], true) {
                order.push(to);
            }
        });
    }
    order
}
