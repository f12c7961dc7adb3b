//! Whether two automata mean the same, and a shortest trace on which they differ.
//!
//! Propositions are the same if they have the same name; one that only one automaton knows is free
//! to the other. Both automata are brought over the union of the propositions by a product with
//! the automaton of `true`, and pairs of states are searched breadth-first.

use std::collections::VecDeque;
use std::fmt;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::product::{Operator, product};
use crate::trace::{Letter, Trace};
use tltl_compiler::dfa::{Dfa, Diagram, State, Target};

/// What the comparison found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// Every trace has the same verdict.
    None,
    /// A trace tells them apart.
    Trace {
        /// A shortest such trace, over the propositions of both.
        trace: Trace,
        /// Whether the first accepts it.
        first: bool,
        /// Whether the second accepts it.
        second: bool,
    },
}

impl fmt::Display for Difference {
    /// One line if there is none; else the trace, an instant a line, and both verdicts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self::Trace { trace, first, second } = self else {
            return f.write_str("equal: every trajectory has the same verdict\n");
        };
        writeln!(f, "different: this trajectory tells them apart\n")?;
        for (t, letter) in trace.letters.iter().enumerate() {
            let one =
                Trace { propositions: trace.propositions.clone(), letters: vec![letter.clone()] };
            writeln!(f, "  {t:>3}  {one}")?;
        }
        let verdict = |accepts: bool| if accepts { "satisfied" } else { "not satisfied" };
        writeln!(f, "\nfirst:  {}\nsecond: {}", verdict(*first), verdict(*second))
    }
}

/// Compares two automata. Letters that cannot occur in one of them are left out.
#[must_use]
pub fn diff(first: &Dfa, second: &Dfa) -> Difference {
    let mut names = first.propositions.clone();
    names.extend(
        second.propositions.iter().filter(|name| !first.propositions.contains(name)).cloned(),
    );
    let sides = [Side::new(first, &names), Side::new(second, &names)];
    let mut search = Search { sides, found: FxHashMap::default(), parents: Vec::new() };
    search.run(names)
}

/// One automaton over all propositions, and the letters that can occur in it.
struct Side {
    dfa: Dfa,
    possible: Dfa,
}

impl Side {
    fn new(dfa: &Dfa, names: &[String]) -> Self {
        let possible = Dfa {
            transitions: vec![
                dfa.possible.map_or(Target::to_state(1), |target| target),
                Target::to_state(1),
            ],
            ..dfa.clone()
        };
        Self { dfa: over(dfa, names), possible: over(&letters(possible), names) }
    }

    fn accepts(&self, q: State) -> bool {
        self.dfa.accepting == Some(q)
    }
}

/// The automaton of "the first letter can occur": state 0 asks, 1 accepts, 2 is the trap.
fn letters(dfa: Dfa) -> Dfa {
    let asked = dfa.transitions[0];
    let mut diagram = Diagram::default();
    let mut moved: Vec<Target> = Vec::new();
    let place = |target: Target, moved: &[Target]| match (target.node(), target.state()) {
        (Some(node), _) => moved[node as usize],
        (_, state) => Target::to_state(if state == Some(1) { 1 } else { 2 }),
    };
    for node in dfa.diagram.nodes() {
        let (low, high) = (place(node.low, &moved), place(node.high, &moved));
        moved.push(diagram.node(node.proposition, low, high));
    }
    let transitions = vec![place(asked, &moved), Target::to_state(1), Target::to_state(2)];
    Dfa { diagram, transitions, accepting: Some(1), trap: Some(2), possible: None, ..dfa }
}

/// The same automaton over more propositions.
fn over(dfa: &Dfa, names: &[String]) -> Dfa {
    let truth = Dfa {
        propositions: names.to_vec(),
        diagram: Diagram::default(),
        transitions: vec![Target::to_state(0)],
        accepting: Some(0),
        trap: None,
        possible: None,
    };
    product(Operator::And, &[&truth, dfa]).dfa
}

struct Search {
    sides: [Side; 2],
    found: FxHashMap<[State; 2], usize>,
    /// For each pair found the pair before it and the letter between.
    parents: Vec<([State; 2], usize, Letter)>,
}

impl Search {
    fn run(&mut self, names: Vec<String>) -> Difference {
        let mut queue = VecDeque::from([self.add([0, 0], 0, Letter::new())]);
        while let Some(at) = queue.pop_front() {
            for (pair, letter) in self.successors(self.parents[at].0) {
                if self.found.contains_key(&pair) {
                    continue;
                }
                let [first, second] = [0, 1].map(|i| self.sides[i].accepts(pair[i]));
                let next = self.add(pair, at, letter);
                if first != second {
                    let trace = Trace { propositions: names, letters: self.letters(next) };
                    return Difference::Trace { trace, first, second };
                }
                queue.push_back(next);
            }
        }
        Difference::None
    }

    fn add(&mut self, pair: [State; 2], before: usize, letter: Letter) -> usize {
        let index = self.parents.len();
        // The start has read nothing yet: it may be met again, and counts only then.
        if index > 0 {
            self.found.insert(pair, index);
        }
        self.parents.push((pair, before, letter));
        index
    }

    /// The letters that lead to a pair.
    fn letters(&self, mut at: usize) -> Vec<Letter> {
        let mut letters = Vec::new();
        while at > 0 {
            let (_, before, letter) = &self.parents[at];
            letters.push(letter.clone());
            at = *before;
        }
        letters.reverse();
        letters
    }

    /// The pairs after a pair, each with the first letter that leads there.
    fn successors(&self, pair: [State; 2]) -> Vec<([State; 2], Letter)> {
        let [a, b] = &self.sides;
        let diagrams = [&a.dfa.diagram, &b.dfa.diagram, &a.possible.diagram, &b.possible.diagram];
        let start = [
            a.dfa.transitions[pair[0] as usize],
            b.dfa.transitions[pair[1] as usize],
            a.possible.transitions[0],
            b.possible.transitions[0],
        ];
        let mut seen = FxHashSet::default();
        let mut found: Vec<([State; 2], Letter)> = Vec::new();
        let mut stack = vec![(start, vec![false; a.dfa.propositions.len()])];
        while let Some((targets, letter)) = stack.pop() {
            if !seen.insert(targets) {
                continue;
            }
            let asked = targets.iter().zip(diagrams).filter_map(|(&t, d)| d.proposition(t)).min();
            let Some(asked) = asked else {
                found.extend(self.pair(targets).map(|pair| (pair, letter)));
                continue;
            };
            for value in [true, false] {
                let mut below = targets;
                let mut letter = letter.clone();
                letter[asked as usize] = value;
                for (target, diagram) in below.iter_mut().zip(diagrams) {
                    let (low, high) = diagram.split(*target, asked);
                    *target = if value { high } else { low };
                }
                stack.push((below, letter));
            }
        }
        found
    }

    /// The pair that four leaves are, if the letter can occur on both sides.
    fn pair(&self, targets: [Target; 4]) -> Option<[State; 2]> {
        let [a, b, possible_a, possible_b] = targets.map(Target::state);
        let possible = possible_a == self.sides[0].possible.accepting
            && possible_b == self.sides[1].possible.accepting;
        possible.then_some([a?, b?])
    }
}
