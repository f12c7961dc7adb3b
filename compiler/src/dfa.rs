//! Deterministic automata over the valuations of propositions, with a shared decision diagram as
//! their transition function.
//!
//! A [`Dfa`] may be raw (as translated) or canonical (as [`minimize`](crate::minimize::minimize)
//! leaves it): complete, reachable, states numbered breadth-first, letters in lexicographic order
//! (proposition 0 first, false before true), the nodes of the diagram in postorder.

mod edge;

use crate::bdd::{Bdd, Cube, Diagram};

pub use edge::Edge;

/// A state of an automaton; the initial one is 0.
pub type State = u32;

/// A complete deterministic automaton with at most one accepting state and at most one trap, both
/// absorbing.
#[derive(Clone, Debug)]
pub struct Dfa {
    /// The propositions; bit i of a letter is proposition i.
    pub propositions: Vec<String>,
    /// The nodes that the transitions of all states share. Levels are propositions: formulas are
    /// mostly written in the order in which things shall happen, and then later goals share the
    /// diagrams of earlier ones (the opposite order makes nested goals cubic).
    pub diagram: Diagram,
    /// The transition function of each state, whose leaves are states.
    pub transitions: Vec<Bdd>,
    /// The accepting state, if there is one.
    pub accepting: Option<State>,
    /// The rejecting trap, if there is one.
    pub trap: Option<State>,
    /// The letters that can occur, as a Boolean function; `None` if all can.
    pub possible: Option<Bdd>,
}

/// The two automata of a task.
#[derive(Clone, Debug)]
pub struct Automata {
    /// Minimal with all predicates taken for free propositions: what other tools compute.
    pub propositional: Dfa,
    /// Minimal over the letters that can occur: what is emitted.
    pub dfa: Dfa,
}

/// How big an automaton is, under the usual conventions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// States, the trap included.
    pub states: usize,
    /// Distinct pairs (q, q') with q ≠ q', edges into the trap included.
    pub edges: usize,
    /// Distinct pairs (q, q), that of the trap included.
    pub self_loops: usize,
    /// Edges of `edges` that lead into the trap.
    pub into_trap: usize,
    /// Whether there is a trap.
    pub trap: bool,
}

impl Dfa {
    /// The number of states, the trap included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.transitions.len()
    }

    /// Whether there is no state; never so for an automaton that came from a formula.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.transitions.is_empty()
    }

    /// All states.
    pub fn states(&self) -> impl DoubleEndedIterator<Item = State> + use<> {
        0..self.transitions.len() as State
    }

    /// The next state from `q` under the letter that `holds` answers.
    ///
    /// # Panics
    /// If `q` is not a state.
    pub fn next(&self, q: State, holds: impl Fn(u32) -> bool) -> State {
        self.diagram.evaluate(self.transitions[q as usize], &holds)
    }

    /// The states that `q` can move to, itself included where it can stay; by rising number.
    #[must_use]
    pub fn successors(&self, q: State) -> Vec<State> {
        let mut found = self.diagram.leaves(self.transitions[q as usize]);
        found.sort_unstable();
        found
    }

    /// How big the automaton is.
    #[must_use]
    pub fn size(&self) -> Size {
        let mut size = Size {
            states: self.len(),
            edges: 0,
            self_loops: 0,
            into_trap: 0,
            trap: self.trap.is_some(),
        };
        for q in self.states() {
            for to in self.diagram.leaves(self.transitions[q as usize]) {
                size.self_loops += usize::from(to == q);
                size.edges += usize::from(to != q);
                size.into_trap += usize::from(to != q && self.trap == Some(to));
            }
        }
        size
    }

    /// For each state the least number of moves to the accepting state, if there is a way.
    #[must_use]
    pub fn distances(&self) -> Vec<Option<u32>> {
        let mut predecessors = vec![Vec::new(); self.len()];
        for q in self.states() {
            for to in self.successors(q) {
                predecessors[to as usize].push(q);
            }
        }
        let mut distances = vec![None; self.len()];
        let mut queue: std::collections::VecDeque<_> = self.accepting.into_iter().collect();
        queue.iter().for_each(|&q| distances[q as usize] = Some(0));
        while let Some(q) = queue.pop_front() {
            let further = distances[q as usize].map(|d| d + 1);
            for &p in &predecessors[q as usize] {
                if distances[p as usize].is_none() {
                    distances[p as usize] = further;
                    queue.push_back(p);
                }
            }
        }
        distances
    }
}

/// The guards of an automaton, each as an irredundant sum of products.
pub struct Guards<'a> {
    dfa: &'a Dfa,
    /// Boolean functions of the propositions.
    diagram: Diagram,
    possible: Bdd,
    /// For each state the states that it moves to, rising, and when: what states share of their
    /// transition functions is looked at once.
    moves: Vec<Vec<(State, Bdd)>>,
}

impl<'a> Guards<'a> {
    /// Guards of `dfa`; letters that cannot occur are used to shorten them.
    #[must_use]
    pub fn new(dfa: &'a Dfa) -> Self {
        let mut diagram = Diagram::default();
        let possible = dfa.possible.map_or(Bdd::TRUE, |f| diagram.import(&dfa.diagram, f));
        let moves = dfa.diagram.indicators(&dfa.transitions, &mut diagram);
        Self { dfa, diagram, possible, moves }
    }

    /// ψ_{q,to}: when `q` moves to `to`. Literals are `(proposition, value)`, by rising
    /// proposition.
    pub fn edge(&mut self, q: State, to: State) -> Vec<Cube> {
        let when = self.when(q, to);
        self.sum(when)
    }

    /// D_φ^q: when `q` moves to another state that is not the trap (paper, Eq. 3A3).
    pub fn progress(&mut self, q: State) -> Vec<Cube> {
        let when = self.progresses(q);
        self.sum(when)
    }

    /// Whether no guard has more than `most` products.
    pub fn are_below(&mut self, most: usize) -> bool {
        self.dfa.states().all(|q| {
            let mut guards = self.moves[q as usize].clone();
            guards.push((q, self.progresses(q)));
            guards.iter().all(|&(_, when)| {
                let (lower, upper) = self.bounds(when);
                self.diagram.count_products(lower, upper) <= most
            })
        })
    }

    /// The letters under which `q` moves to `to`.
    fn when(&self, q: State, to: State) -> Bdd {
        let moves = &self.moves[q as usize];
        let place = moves.binary_search_by_key(&to, |&(state, _)| state);
        place.map_or(Bdd::FALSE, |place| moves[place].1)
    }

    /// The letters under which `q` moves on, and not into the trap.
    fn progresses(&mut self, q: State) -> Bdd {
        let falls = self.dfa.trap.map_or(Bdd::FALSE, |trap| self.when(q, trap));
        let rests = self.diagram.or(self.when(q, q), falls);
        self.diagram.not(rests)
    }

    /// What a sum of products must cover, and what it may: all letters of `when` that can occur,
    /// and besides them any that cannot.
    fn bounds(&mut self, when: Bdd) -> (Bdd, Bdd) {
        let impossible = self.diagram.not(self.possible);
        (self.diagram.and(when, self.possible), self.diagram.or(when, impossible))
    }

    fn sum(&mut self, when: Bdd) -> Vec<Cube> {
        let (lower, upper) = self.bounds(when);
        self.diagram.sum_of_products(lower, upper)
    }
}
