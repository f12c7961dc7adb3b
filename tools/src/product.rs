//! Products: automata side by side, for conjunction or disjunction of any number of operands.
//!
//! The *raw* product (paper, Definition 4) has one state for each tuple of operand states that can
//! be reached, except that all tuples in which the verdict is final are one state: the accepting
//! state, or the trap. Composition of learned skills works on the raw product, since it must know
//! the state of every operand; [`minimize`](tltl_compiler::minimize::minimize) turns it into the
//! automaton of the formula.
//!
//! Operands share a proposition if they give it the same name. Arithmetic between the predicates of
//! different operands is not considered: letters that only their combination excludes stay in the
//! product.
//!
//! # Cost
//!
//! Operands are added from the left, one by one. Each step is a breadth-first search over pairs of
//! states, and for each pair one *apply* of the two transition diagrams (Bryant, 1986), at most the
//! product of their nodes. The number of states may be the product of the operands' numbers; a
//! [factored task](crate::task::Factored) avoids that.

use rustc_hash::FxHashMap;

use tltl_compiler::bdd::{Bdd, Diagram, Node, Operation};
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::minimize::canonical_order;
use tltl_compiler::proposition::Proposition;

/// The rule by which the verdicts of the operands become one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Operator {
    /// Conjunction: accepts where all operands accept, and is lost where one is.
    And,
    /// Disjunction: accepts where one operand accepts, and is lost where all are.
    Or,
}

/// A raw product, and the operand states that each of its states stands for.
#[derive(Clone, Debug)]
pub struct Product {
    /// The automaton, in canonical numbering, over the union of the propositions.
    pub dfa: Dfa,
    /// For each state of `dfa` the state of every operand. An accepting or lost state that stands
    /// for many tuples shows the first that was met, which is the one with the lowest letters.
    pub components: Vec<Vec<State>>,
}

/// The raw product of `operands` over the union of their propositions, in order of first
/// appearance.
///
/// # Panics
/// If there is no operand.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::product::{Operator, product};
/// use tltlc::task::compile;
///
/// let [a, b] = ["F a", "F b"].map(|formula| compile(formula, Budget::default()));
/// let (a, b) = (a?, b?);
/// let both = product(Operator::And, &[a.dfa(), b.dfa()]);
/// assert_eq!(both.dfa.propositions, ["a", "b"]);
/// assert_eq!(both.components, [[0, 0], [0, 1], [1, 0], [1, 1]]);
/// // Where one suffices, all tuples in which one accepts are one state.
/// assert_eq!(product(Operator::Or, &[a.dfa(), b.dfa()]).dfa.len(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn product(operator: Operator, operands: &[&Dfa]) -> Product {
    let (first, rest) = operands.split_first().expect("a product has operands");
    let single =
        Product { dfa: (*first).clone(), components: first.states().map(|q| vec![q]).collect() };
    rest.iter().fold(single, |left, right| pair(operator, &left, right))
}

/// The product of a product and one more operand.
fn pair(operator: Operator, left: &Product, right: &Dfa) -> Product {
    let propositions = union(&left.dfa.propositions, &right.propositions);
    let mut diagram = Diagram::default();
    let sides = [&left.dfa, right].map(|dfa| Aligned::new(dfa, &propositions, &mut diagram));
    let mut pairing =
        Pairing { operator, sides, pairs: Pairs::default(), accepting: None, trap: None };
    let operation = Operation::new(propositions.len() as u32);
    let mut transitions = Vec::new();
    pairing.state([0, 0]);
    while let Some([p, q]) = pairing.pairs.known.get(transitions.len()).copied() {
        let here = Some(transitions.len() as State);
        let [a, b] = &pairing.sides;
        let (f, g) = (a.transitions[p as usize], b.transitions[q as usize]);
        transitions.push(match pairing.accepting == here || pairing.trap == here {
            true => Bdd::leaf(transitions.len() as State),
            false => diagram.apply(operation, f, g, &mut |_, f, g| {
                Some(Bdd::leaf(pairing.state([f.value()?, g.value()?])))
            }),
        });
    }
    let Pairing { pairs, accepting, trap, .. } = pairing;
    let raw = Dfa { propositions, diagram, transitions, accepting, trap, possible: None };
    let (dfa, order) = canonical_order(&raw);
    let components = order.iter().map(|&q| {
        let [a, b] = pairs.get(q);
        let mut components = left.components[a as usize].clone();
        components.push(b);
        components
    });
    let components = components.collect();
    Product { dfa, components }
}

/// The propositions of both lists in order of first appearance.
pub(crate) fn union(first: &[Proposition], second: &[Proposition]) -> Vec<Proposition> {
    let mut both = first.to_vec();
    both.extend(second.iter().filter(|one| !first.contains(one)).cloned());
    both
}

/// Pairs of states, numbered in order of discovery.
#[derive(Default)]
pub(crate) struct Pairs {
    known: Vec<[State; 2]>,
    numbers: FxHashMap<[State; 2], State>,
}

impl Pairs {
    pub(crate) fn get(&self, number: State) -> [State; 2] {
        self.known[number as usize]
    }

    pub(crate) fn number(&mut self, pair: [State; 2]) -> State {
        *self.numbers.entry(pair).or_insert_with(|| {
            self.known.push(pair);
            self.known.len() as State - 1
        })
    }
}

/// The search for the pairs that can be reached. `pairs` is its queue as well: a pair is explored
/// in the order of its number.
struct Pairing {
    operator: Operator,
    sides: [Aligned; 2],
    pairs: Pairs,
    accepting: Option<State>,
    trap: Option<State>,
}

impl Pairing {
    /// The state that a pair is. All pairs in which the verdict is final share the state of the
    /// first of them.
    fn state(&mut self, pair: [State; 2]) -> State {
        let accepts = |side: usize| self.sides[side].accepting == Some(pair[side]);
        let lost = |side: usize| self.sides[side].trap == Some(pair[side]);
        let (accepted, trapped) = match self.operator {
            Operator::And => (accepts(0) && accepts(1), lost(0) || lost(1)),
            Operator::Or => (accepts(0) || accepts(1), lost(0) && lost(1)),
        };
        let pairs = &mut self.pairs;
        match (accepted, trapped) {
            (true, _) => *self.accepting.get_or_insert_with(|| pairs.number(pair)),
            (_, true) => *self.trap.get_or_insert_with(|| pairs.number(pair)),
            _ => pairs.number(pair),
        }
    }
}

/// An automaton over a longer list of propositions, in a diagram that others may share.
pub(crate) struct Aligned {
    pub(crate) transitions: Vec<Bdd>,
    pub(crate) possible: Bdd,
    pub(crate) accepting: Option<State>,
    trap: Option<State>,
}

impl Aligned {
    /// Moves an automaton into `diagram`, its propositions renumbered to their places in
    /// `propositions`. The new numbers may be in another order, so nodes are built anew from the
    /// leaves up.
    pub(crate) fn new(dfa: &Dfa, propositions: &[Proposition], diagram: &mut Diagram) -> Self {
        let place = |name| propositions.iter().position(|other| other == name);
        let places: Vec<_> =
            dfa.propositions.iter().filter_map(place).map(|place| place as u32).collect();
        let mut roots = dfa.transitions.clone();
        roots.push(dfa.possible.unwrap_or(Bdd::TRUE));
        let order = dfa.diagram.postorder(&roots);
        let images = dfa.diagram.fold(&order, &Bdd::leaf, &mut |Node { level, low, high }| {
            select(diagram, places[level as usize], low, high)
        });
        let mut transitions: Vec<Bdd> = roots.into_iter().map(|root| images.of(root)).collect();
        let possible = transitions.pop().unwrap_or(Bdd::TRUE);
        Self { transitions, possible, accepting: dfa.accepting, trap: dfa.trap }
    }
}

/// `high` where `level` is true and `low` where it is false, wherever the level stands in the
/// order: *ite* with a variable as its condition, for functions of states.
fn select(diagram: &mut Diagram, level: u32, low: Bdd, high: Bdd) -> Bdd {
    diagram.apply(Operation::new(level), low, high, &mut |diagram, low, high| {
        let first = diagram.level(low).min(diagram.level(high));
        (level < first).then(|| diagram.node(level, low, high))
    })
}
