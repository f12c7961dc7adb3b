//! Letters and traces: which propositions hold at which instant.

use std::collections::VecDeque;
use std::fmt;

use rustc_hash::FxHashSet;

use tltl_compiler::dfa::{Dfa, State, Target};

/// The values of all propositions at one instant.
pub type Letter = Vec<bool>;

/// A finite trajectory, as far as the propositions see it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Trace {
    /// The names of the propositions.
    pub propositions: Vec<String>,
    /// The letters, one an instant.
    pub letters: Vec<Letter>,
}

impl fmt::Display for Trace {
    /// What holds at each instant: `{a}; {}; {a, b}`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, letter) in self.letters.iter().enumerate() {
            let held = letter.iter().zip(&self.propositions).filter(|(holds, _)| **holds);
            let held: Vec<_> = held.map(|(_, name)| name.as_str()).collect();
            write!(f, "{}{{{}}}", if i == 0 { "" } else { "; " }, held.join(", "))?;
        }
        Ok(())
    }
}

/// The first letter, in lexicographic order (false before true), that can occur and under which
/// `from` leads to a selected state.
#[must_use]
pub fn letter(dfa: &Dfa, from: Target, select: &dyn Fn(State) -> bool) -> Option<Letter> {
    let mut letter = vec![false; dfa.propositions.len()];
    let possible = dfa.possible.unwrap_or(Target::to_state(1));
    let mut failed = FxHashSet::default();
    walk(dfa, from, possible, select, &mut letter, &mut failed).then_some(letter)
}

fn walk(
    dfa: &Dfa,
    from: Target,
    possible: Target,
    select: &dyn Fn(State) -> bool,
    letter: &mut Letter,
    failed: &mut FxHashSet<(Target, Target)>,
) -> bool {
    if possible.state() == Some(0) {
        return false;
    }
    let asked = [dfa.diagram.proposition(from), dfa.diagram.proposition(possible)];
    let Some(proposition) = asked.into_iter().flatten().min() else {
        return from.state().is_some_and(select);
    };
    if !failed.insert((from, possible)) {
        return false;
    }
    let (from0, from1) = dfa.diagram.split(from, proposition);
    let (possible0, possible1) = dfa.diagram.split(possible, proposition);
    for (value, from, possible) in [(false, from0, possible0), (true, from1, possible1)] {
        letter[proposition as usize] = value;
        if walk(dfa, from, possible, select, letter, failed) {
            return true;
        }
    }
    letter[proposition as usize] = false;
    false
}

/// The shortest trace of at least one letter after which `goal` holds of the state reached from
/// `from`; among equally short ones that with the lowest states and letters.
#[must_use]
pub fn shortest(dfa: &Dfa, from: State, goal: &dyn Fn(State) -> bool) -> Option<Trace> {
    let mut parents: Vec<Option<State>> = vec![None; dfa.len()];
    let mut queue = VecDeque::from([from]);
    let mut seen = vec![false; dfa.len()];
    seen[from as usize] = true;
    while let Some(q) = queue.pop_front() {
        let target = dfa.transitions[q as usize];
        if let Some(last) = letter(dfa, target, goal) {
            let mut letters = vec![last];
            let mut at = q;
            while let (false, Some(before)) = (at == from, parents[at as usize]) {
                letters.extend(letter(dfa, dfa.transitions[before as usize], &|to| to == at));
                at = before;
            }
            letters.reverse();
            return Some(Trace { propositions: dfa.propositions.clone(), letters });
        }
        for to in dfa.successors(q) {
            if !seen[to as usize] && letter(dfa, target, &|leaf| leaf == to).is_some() {
                seen[to as usize] = true;
                parents[to as usize] = Some(q);
                queue.push_back(to);
            }
        }
    }
    None
}
