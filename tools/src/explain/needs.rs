//! The literals without which acceptance cannot be reached: "cannot do without".

use tltl_compiler::bdd::{Bdd, Literal, Operation};
use tltl_compiler::dfa::{Dfa, State};

use crate::emit::sum::Sum;

/// An automaton in which letters that cannot occur lead nowhere, to a state of its own, the last.
///
/// Elsewhere transitions under such letters are arbitrary: of two predicates that exclude each
/// other, they would make the negation of one a need, and not that of the other.
pub(super) struct Needs {
    dfa: Dfa,
    possible: Bdd,
}

impl Needs {
    pub(super) fn new(dfa: &Dfa) -> Self {
        let (mut dfa, possible) = (dfa.clone(), dfa.possible.unwrap_or(Bdd::TRUE));
        let nowhere = Bdd::leaf(dfa.len() as u32);
        for transition in &mut dfa.transitions {
            let operation = Operation::new(0);
            *transition =
                dfa.diagram.apply(operation, *transition, possible, &mut |_, f, care| match care {
                    Bdd::TRUE => Some(f),
                    Bdd::FALSE => Some(nowhere),
                    _ => None,
                });
        }
        dfa.transitions.push(nowhere);
        Self { dfa, possible }
    }

    /// The literals without which acceptance cannot be reached from `q`. If a proposition and its
    /// negation both are, no single instant has both, and the text says so.
    pub(super) fn of(&mut self, q: State) -> Vec<String> {
        let propositions = 0..self.dfa.propositions.len() as u32;
        let literals = propositions.clone().flat_map(|p| [(p, true), (p, false)]);
        let found = literals.filter(|&(p, value)| !reaches(&self.dfa, q, (p, !value)));
        let found = self.without_followers(found.collect());
        let literal = |p: u32, value: bool| {
            let cubes = [vec![(p, value)]];
            found
                .contains(&(p, value))
                .then(|| Sum::new(&self.dfa.propositions, &cubes).to_string())
        };
        let told = propositions.filter_map(|p| match (literal(p, true), literal(p, false)) {
            (Some(yes), Some(no)) => Some(format!("{yes} at one instant and {no} at another")),
            (one, other) => one.or(other),
        });
        told.collect()
    }

    /// The literals without those that hold wherever another of them does; of equal ones the first
    /// stays.
    fn without_followers(&mut self, mut literals: Vec<Literal>) -> Vec<Literal> {
        for place in (0..literals.len()).rev() {
            let leads = |this: &mut Self, other: usize| {
                other != place && this.implies(literals[other], literals[place])
            };
            if (0..literals.len()).any(|other| leads(self, other)) {
                literals.remove(place);
            }
        }
        literals
    }

    /// Whether no letter that can occur has the first literal and not the second.
    fn implies(&mut self, one: Literal, (p, value): Literal) -> bool {
        let diagram = &mut self.dfa.diagram;
        let (one, other) = (diagram.literal(one), diagram.literal((p, !value)));
        let both = diagram.and(one, other);
        diagram.and(both, self.possible) == Bdd::FALSE
    }
}

/// Whether acceptance can be reached from `q` while one proposition keeps one value for ever: a
/// walk over the diagram that follows only one side of its nodes.
fn reaches(dfa: &Dfa, q: State, (proposition, value): (u32, bool)) -> bool {
    let mut seen_states = vec![false; dfa.len()];
    let mut seen_nodes = vec![false; dfa.diagram.nodes().len()];
    let mut stack = vec![Bdd::leaf(q)];
    while let Some(f) = stack.pop() {
        match (f.index(), f.value()) {
            (Some(index), _) if !std::mem::replace(&mut seen_nodes[index as usize], true) => {
                let node = dfa.diagram.nodes()[index as usize];
                match node.level == proposition {
                    true => stack.push(if value { node.high } else { node.low }),
                    false => stack.extend([node.low, node.high]),
                }
            }
            (_, Some(state)) if dfa.accepting == Some(state) => return true,
            (_, Some(state)) if !std::mem::replace(&mut seen_states[state as usize], true) => {
                stack.push(dfa.transitions[state as usize]);
            }
            _ => {}
        }
    }
    false
}
