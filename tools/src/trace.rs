//! Letters and traces, and the shortest traces of an automaton.
//!
//! A *letter* is a valuation of all propositions at one instant, a *trace* a finite sequence of
//! letters: a trajectory as the predicates see it. Searches go over the decision diagrams of the
//! transitions and never list the 2^n letters of n propositions. Where arithmetic has shown that
//! letters cannot occur, no trace has them.

use std::collections::VecDeque;
use std::fmt;

use rustc_hash::FxHashSet;

use tltl_compiler::bdd::{Bdd, Diagram};
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::proposition::Proposition;

/// The truth of every proposition at one instant, by its number.
pub type Letter = Vec<bool>;

/// A finite sequence of letters over named propositions.
///
/// It prints the propositions that hold at each instant.
///
/// ```
/// use tltl_compiler::proposition::Proposition;
/// use tltlc::trace::Trace;
///
/// let propositions = ["a", "b"].map(Proposition::from).to_vec();
/// let letters = vec![vec![true, false], vec![false, false], vec![true, true]];
/// assert_eq!(Trace { propositions, letters }.to_string(), "{a}; {}; {a, b}");
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// The propositions, by number.
    pub propositions: Vec<Proposition>,
    /// The letters, one an instant; each has a value for each proposition.
    pub letters: Vec<Letter>,
}

impl fmt::Display for Trace {
    /// What holds at each instant: `{a}; {}; {a, b}`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, letter) in self.letters.iter().enumerate() {
            let held = letter.iter().zip(&self.propositions).filter(|(holds, _)| **holds);
            let held: Vec<_> = held.map(|(_, one)| one.name.as_str()).collect();
            write!(f, "{}{{{}}}", if i == 0 { "" } else { "; " }, held.join(", "))?;
        }
        Ok(())
    }
}

/// The leaves that letters of `possible` lead to from `f`, each with the first of these letters, in
/// their lexicographic order (proposition 0 first, false before true). A letter has `width`
/// propositions.
///
/// It is a depth-first walk over pairs of nodes that visits none twice, so it costs at most the
/// product of their numbers, never the number of letters. Propositions that are not asked are false
/// in the letter.
///
/// ```
/// use tltl_compiler::{bdd::Bdd, translate::Budget};
/// use tltlc::trace::first_letters;
///
/// let task = tltlc::task::compile("!wet U home", Budget::default())?;
/// let dfa = task.dfa();
/// let mut found = first_letters(&dfa.diagram, 2, dfa.transitions[0], Bdd::TRUE);
/// found.sort();
/// // Stay, arrive and lose, each by the first letter over (wet, home) that does.
/// let letters: Vec<_> = found.into_iter().map(|(_, letter)| letter).collect();
/// assert_eq!(letters, [vec![false, false], vec![false, true], vec![true, false]]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn first_letters(diagram: &Diagram, width: usize, f: Bdd, possible: Bdd) -> Vec<(u32, Letter)> {
    let mut seen = FxHashSet::default();
    let mut found = Vec::new();
    let mut stack = vec![(f, possible, vec![false; width])];
    while let Some((f, possible, letter)) = stack.pop() {
        if possible == Bdd::FALSE || !seen.insert((f, possible)) {
            continue;
        }
        if let (Some(leaf), Bdd::TRUE) = (f.value(), possible) {
            found.push((leaf, letter));
            continue;
        }
        let level = diagram.level(f).min(diagram.level(possible));
        let (f0, f1) = diagram.cofactors(f, level);
        let (possible0, possible1) = diagram.cofactors(possible, level);
        let mut above = letter.clone();
        above[level as usize] = true;
        stack.extend([(f1, possible1, above), (f0, possible0, letter)]);
    }
    found
}

/// The shortest trace of at least one letter after which `goal` holds of the state reached from
/// `from`; among equally short ones the one with the lowest states and letters. `None` if no trace
/// leads there.
///
/// It is a breadth-first search over the states; each state costs one walk over the diagram of its
/// transitions.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{task, trace};
///
/// let order = task::compile("a T b", Budget::default())?;
/// let accepting = order.dfa().accepting;
/// let trace = trace::shortest(order.dfa(), 0, &|q| accepting == Some(q)).ok_or("unsatisfiable")?;
/// assert_eq!(trace.to_string(), "{a}; {b}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn shortest(dfa: &Dfa, from: State, goal: &dyn Fn(State) -> bool) -> Option<Trace> {
    let width = dfa.propositions.len();
    let possible = dfa.possible.unwrap_or(Bdd::TRUE);
    let mut before: Vec<Option<(State, Letter)>> = vec![None; dfa.len()];
    let mut seen = vec![false; dfa.len()];
    seen[from as usize] = true;
    let mut queue = VecDeque::from([from]);
    while let Some(q) = queue.pop_front() {
        let mut moves = first_letters(&dfa.diagram, width, dfa.transitions[q as usize], possible);
        if let Some((_, last)) = moves.iter().find(|(to, _)| goal(*to)) {
            let steps = std::iter::successors(before[q as usize].as_ref(), |(before_, _)| {
                before[*before_ as usize].as_ref()
            });
            let mut letters: Vec<Letter> = steps.map(|(_, letter)| letter.clone()).collect();
            letters.reverse();
            letters.push(last.clone());
            return Some(Trace { propositions: dfa.propositions.clone(), letters });
        }
        moves.sort_unstable_by_key(|(to, _)| *to);
        for (to, letter) in moves {
            if !std::mem::replace(&mut seen[to as usize], true) {
                before[to as usize] = Some((q, letter));
                queue.push_back(to);
            }
        }
    }
    None
}
