//! Automata side by side: conjunction and disjunction of any number of operands.
//!
//! The raw product (paper, Definition 4) has one state for each reachable tuple of operand states,
//! except that all tuples in which the verdict has fallen are one: the accepting state, or the
//! trap. Composition of learned skills works on the raw product, for it must know every operand's
//! state; [`minimize`](tltl_compiler::minimize::minimize) gives the automaton of the formula. Operands
//! share a proposition if they give it the same name.

use rustc_hash::FxHashMap;

use tltl_compiler::dfa::{Dfa, Diagram, State, Target};
use tltl_compiler::minimize::canonical_order;

/// How the verdicts of the operands become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// Accepts where all operands accept, lost where one is.
    And,
    /// Accepts where one operand accepts, lost where all are.
    Or,
}

/// A raw product and the operand states that each of its states stands for.
#[derive(Clone, Debug)]
pub struct Product {
    /// The automaton, in canonical numbering.
    pub dfa: Dfa,
    /// For each state the state of every operand. An accepting or lost state that stands for many
    /// tuples shows the one with the lowest letters.
    pub components: Vec<Vec<State>>,
}

/// The raw product of `operands` over the union of their propositions, in order of first
/// appearance.
///
/// # Panics
/// If there is no operand.
#[must_use]
pub fn product(operator: Operator, operands: &[&Dfa]) -> Product {
    let (first, rest) = operands.split_first().expect("a product has operands");
    let single =
        Product { dfa: (*first).clone(), components: first.states().map(|q| vec![q]).collect() };
    rest.iter().fold(single, |left, right| pair(operator, &left, right))
}

fn pair(operator: Operator, left: &Product, right: &Dfa) -> Product {
    let mut propositions = left.dfa.propositions.clone();
    for name in &right.propositions {
        if !propositions.contains(name) {
            propositions.push(name.clone());
        }
    }
    let sides = [align(&left.dfa, &propositions), align(right, &propositions)];
    let mut pairing = Pairing { operator, sides, ..Pairing::default() };
    pairing.explore();
    pairing.finish(propositions, &left.components)
}

#[derive(Default)]
struct Pairing {
    operator: Operator,
    sides: [Aligned; 2],
    diagram: Diagram,
    known: FxHashMap<(Target, Target), Target>,
    states: FxHashMap<[State; 2], State>,
    /// The pair of each state, in order of discovery.
    pairs: Vec<[State; 2]>,
    accepting: Option<State>,
    trap: Option<State>,
}

impl Default for Operator {
    /// Conjunction, the paper's product.
    fn default() -> Self {
        Self::And
    }
}

/// An automaton over a longer list of propositions.
#[derive(Default)]
struct Aligned {
    diagram: Diagram,
    transitions: Vec<Target>,
    accepting: Option<State>,
    trap: Option<State>,
}

impl Pairing {
    fn explore(&mut self) {
        let mut transitions = Vec::new();
        self.state([0, 0]);
        while let Some(&[a, b]) = self.pairs.get(transitions.len()) {
            let here = transitions.len() as State;
            let target = if self.accepting == Some(here) || self.trap == Some(here) {
                Target::to_state(here)
            } else {
                let sides = &self.sides;
                let (a, b) = (sides[0].transitions[a as usize], sides[1].transitions[b as usize]);
                self.target(a, b)
            };
            transitions.push(target);
        }
        self.sides[0].transitions = transitions;
    }

    fn target(&mut self, a: Target, b: Target) -> Target {
        if let (Some(a), Some(b)) = (a.state(), b.state()) {
            return Target::to_state(self.state([a, b]));
        }
        if let Some(&known) = self.known.get(&(a, b)) {
            return known;
        }
        let [left, right] = &self.sides;
        let asked = [left.diagram.proposition(a), right.diagram.proposition(b)];
        let proposition = asked.into_iter().flatten().min().expect("one of the two asks");
        let (a0, a1) = left.diagram.split(a, proposition);
        let (b0, b1) = right.diagram.split(b, proposition);
        let (low, high) = (self.target(a0, b0), self.target(a1, b1));
        let target = self.diagram.node(proposition, low, high);
        self.known.insert((a, b), target);
        target
    }

    fn state(&mut self, pair: [State; 2]) -> State {
        let fresh = self.pairs.len() as State;
        let accepts = |side: usize| self.sides[side].accepting == Some(pair[side]);
        let lost = |side: usize| self.sides[side].trap == Some(pair[side]);
        let (accepted, trapped) = match self.operator {
            Operator::And => (accepts(0) && accepts(1), lost(0) || lost(1)),
            Operator::Or => (accepts(0) || accepts(1), lost(0) && lost(1)),
        };
        let state = if accepted {
            *self.accepting.get_or_insert(fresh)
        } else if trapped {
            *self.trap.get_or_insert(fresh)
        } else {
            *self.states.entry(pair).or_insert(fresh)
        };
        if state == fresh {
            self.pairs.push(pair);
        }
        state
    }

    fn finish(self, propositions: Vec<String>, left: &[Vec<State>]) -> Product {
        let [Aligned { transitions, .. }, _] = self.sides;
        let raw = Dfa {
            propositions,
            diagram: self.diagram,
            transitions,
            accepting: self.accepting,
            trap: self.trap,
            possible: None,
        };
        let (dfa, order) = canonical_order(&raw);
        let components = order.iter().map(|&q| {
            let [a, b] = self.pairs[q as usize];
            let mut components = left[a as usize].clone();
            components.push(b);
            components
        });
        let components = components.collect();
        Product { dfa, components }
    }
}

/// Renumbers the propositions of an automaton to their places in a longer list.
fn align(dfa: &Dfa, propositions: &[String]) -> Aligned {
    let place = |name: &String| propositions.iter().position(|other| other == name);
    let places: Vec<u32> = dfa.propositions.iter().filter_map(place).map(|i| i as u32).collect();
    let mut diagram = Diagram::default();
    let mut moved: Vec<Target> = Vec::with_capacity(dfa.diagram.nodes().len());
    let mut known = FxHashMap::default();
    let at = |target: Target, moved: &[Target]| match target.node() {
        Some(index) => moved[index as usize],
        None => target,
    };
    for node in dfa.diagram.nodes() {
        let (low, high) = (at(node.low, &moved), at(node.high, &moved));
        let place = places[node.proposition as usize];
        moved.push(select(&mut diagram, &mut known, place, low, high));
    }
    let transitions = dfa.transitions.iter().map(|&target| at(target, &moved)).collect();
    Aligned { diagram, transitions, accepting: dfa.accepting, trap: dfa.trap }
}

/// `high` where `proposition` is true and `low` where it is false, wherever it stands in the order.
fn select(
    diagram: &mut Diagram,
    known: &mut FxHashMap<(u32, Target, Target), Target>,
    proposition: u32,
    low: Target,
    high: Target,
) -> Target {
    let asked = [diagram.proposition(low), diagram.proposition(high)];
    let Some(first) = asked.into_iter().flatten().min().filter(|&first| first < proposition) else {
        return diagram.node(proposition, low, high);
    };
    if let Some(&target) = known.get(&(proposition, low, high)) {
        return target;
    }
    let (low0, low1) = diagram.split(low, first);
    let (high0, high1) = diagram.split(high, first);
    let below = select(diagram, known, proposition, low0, high0);
    let above = select(diagram, known, proposition, low1, high1);
    let target = diagram.node(first, below, above);
    known.insert((proposition, low, high), target);
    target
}
