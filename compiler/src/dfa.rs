//! Deterministic automata over the valuations of propositions, with a shared decision diagram as
//! their transition function.
//!
//! A [`Dfa`] may be raw (as translated) or canonical (as [`minimize`](crate::minimize::minimize)
//! leaves it): complete, reachable, states numbered breadth-first,
//! letters in lexicographic order (proposition 0 first, false before true).

mod edge;

use rustc_hash::{FxHashMap, FxHashSet};

use crate::arena::{self, Memo};
use crate::guard::{Cube, Guard, Store};

pub use edge::Edge;

/// A state of an automaton; the initial one is 0.
pub type State = u32;

/// Where a transition goes: to a state, or first to a node that asks one more proposition.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Target(u32);

arena::id! { Target }

impl Target {
    const LEAF: u32 = 1 << 31;

    /// The state itself, whatever the remaining propositions.
    #[must_use]
    pub fn to_state(state: State) -> Self {
        Self(Self::LEAF | state)
    }

    /// A node of the automaton's diagram.
    #[must_use]
    pub fn to_node(index: u32) -> Self {
        Self(index)
    }

    /// The state, if no proposition is left to ask.
    #[must_use]
    pub fn state(self) -> Option<State> {
        (self.0 >= Self::LEAF).then_some(self.0 & !Self::LEAF)
    }

    /// The node's index, if one is to be asked.
    #[must_use]
    pub fn node(self) -> Option<u32> {
        (self.0 < Self::LEAF).then_some(self.0)
    }
}

/// A node: asks one proposition. Lower-numbered propositions are asked first: formulas are mostly
/// written in the order in which things shall happen, and then later goals share the diagrams of
/// earlier ones (the opposite order makes nested goals cubic).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Node {
    /// The proposition.
    pub proposition: u32,
    /// If it is false.
    pub low: Target,
    /// If it is true.
    pub high: Target,
}

/// The nodes of a transition function: reduced, shared, children before parents.
#[derive(Clone, Debug, Default)]
pub struct Diagram {
    nodes: Vec<Node>,
    unique: FxHashMap<Node, Target>,
}

impl Diagram {
    /// All nodes, children before parents.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The target that asks `proposition`, which must be lower than all that `low` and `high` ask.
    pub fn node(&mut self, proposition: u32, low: Target, high: Target) -> Target {
        if low == high {
            return low;
        }
        let fresh = Target(u32::try_from(self.nodes.len()).expect("fewer than 2^31 nodes"));
        let node = Node { proposition, low, high };
        *self.unique.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            fresh
        })
    }

    /// The proposition that a target asks first.
    #[must_use]
    pub fn proposition(&self, target: Target) -> Option<u32> {
        target.node().map(|index| self.nodes[index as usize].proposition)
    }

    /// What a target becomes when `proposition` is false, and true; it must be the first that the
    /// target asks, or lower.
    #[must_use]
    pub fn split(&self, target: Target, proposition: u32) -> (Target, Target) {
        match target.node().map(|index| self.nodes[index as usize]) {
            Some(node) if node.proposition == proposition => (node.low, node.high),
            _ => (target, target),
        }
    }
}

/// A complete deterministic automaton with at most one accepting state and at most one trap, both
/// absorbing.
#[derive(Clone, Debug)]
pub struct Dfa {
    /// The propositions; bit i of a letter is proposition i.
    pub propositions: Vec<String>,
    /// The nodes that the transitions of all states share.
    pub diagram: Diagram,
    /// The transitions of each state.
    pub transitions: Vec<Target>,
    /// The accepting state, if there is one.
    pub accepting: Option<State>,
    /// The rejecting trap, if there is one.
    pub trap: Option<State>,
    /// The letters that can occur, as transitions to state 1 (possible) or 0 (impossible);
    /// `None` if all can.
    pub possible: Option<Target>,
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
        let mut at = self.transitions[q as usize];
        while let Some(index) = at.node() {
            let node = &self.diagram.nodes[index as usize];
            at = if holds(node.proposition) { node.high } else { node.low };
        }
        at.state().expect("a target is a node or a state")
    }

    /// The states that `q` can move to, itself included where it can stay; by rising number.
    #[must_use]
    pub fn successors(&self, q: State) -> Vec<State> {
        let mut found = self.leaves(self.transitions[q as usize]);
        found.sort_unstable();
        found
    }

    /// The distinct states that a target leads to, in lexicographic order of the first letter that
    /// does.
    #[must_use]
    pub fn leaves(&self, from: Target) -> Vec<State> {
        let mut seen = FxHashSet::default();
        let mut found = Vec::new();
        let mut stack = vec![from];
        while let Some(target) = stack.pop() {
            if !seen.insert(target.0) {
                continue;
            }
            match target.node().map(|index| self.diagram.nodes[index as usize]) {
                Some(node) => stack.extend([node.high, node.low]),
                None => found.extend(target.state()),
            }
        }
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
            for to in self.leaves(self.transitions[q as usize]) {
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
    store: Store,
    possible: Guard,
}

impl<'a> Guards<'a> {
    /// Guards of `dfa`; letters that cannot occur are used to shorten them.
    #[must_use]
    pub fn new(dfa: &'a Dfa) -> Self {
        let mut guards = Self { dfa, store: Store::default(), possible: Guard::TRUE };
        if let Some(possible) = dfa.possible {
            guards.possible = guards.when(possible, &|leaf| leaf == 1);
        }
        guards
    }

    /// ψ_{q,to}: when `q` moves to `to`. Literals are `(proposition, value)`, by rising
    /// proposition.
    pub fn edge(&mut self, q: State, to: State) -> Vec<Cube> {
        self.cubes(q, &|leaf| leaf == to, usize::MAX).unwrap_or_default()
    }

    /// D_φ^q: when `q` moves to another state that is not the trap (paper, Eq. 3A3).
    pub fn progress(&mut self, q: State) -> Vec<Cube> {
        let trap = self.dfa.trap;
        self.cubes(q, &|leaf| leaf != q && Some(leaf) != trap, usize::MAX).unwrap_or_default()
    }

    /// Whether no guard has more than `most` products.
    pub fn are_below(&mut self, most: usize) -> bool {
        let dfa = self.dfa;
        dfa.states().all(|q| {
            let progress = |leaf| leaf != q && Some(leaf) != dfa.trap;
            let mut successors = dfa.successors(q).into_iter();
            successors.all(|to| self.cubes(q, &|leaf| leaf == to, most).is_some())
                && self.cubes(q, &progress, most).is_some()
        })
    }

    fn cubes(
        &mut self,
        q: State,
        select: &dyn Fn(State) -> bool,
        most: usize,
    ) -> Option<Vec<Cube>> {
        let when = self.when(self.dfa.transitions[q as usize], select);
        let lower = self.store.and(when, self.possible);
        let impossible = self.store.not(self.possible);
        let upper = self.store.or(when, impossible);
        let mut cubes = self.store.sum_of_products(lower, upper, most)?;
        cubes.sort_by_key(|cube| cube.iter().map(|&(p, value)| (p, !value)).collect::<Vec<_>>());
        Some(cubes)
    }

    /// The letters under which a target leads to a selected state; levels are propositions.
    fn when(&mut self, target: Target, select: &dyn Fn(State) -> bool) -> Guard {
        let mut memo = Memo::default();
        self.build(target, select, &mut memo)
    }

    fn build(
        &mut self,
        target: Target,
        select: &dyn Fn(State) -> bool,
        memo: &mut Memo<Target, Guard>,
    ) -> Guard {
        if let Some(state) = target.state() {
            return if select(state) { Guard::TRUE } else { Guard::FALSE };
        }
        if let Some(known) = memo.get(target) {
            return known;
        }
        let proposition = self.dfa.diagram.proposition(target).expect("a node asks");
        let (low, high) = self.dfa.diagram.split(target, proposition);
        let (low, high) = (self.build(low, select, memo), self.build(high, select, memo));
        let guard = self.store.node(proposition, low, high);
        memo.insert(target, guard);
        guard
    }
}
