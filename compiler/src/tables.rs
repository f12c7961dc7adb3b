//! An automaton and its formula as tables: flat arrays of integers, ready to be read by a program.
//!
//! The last stage before code: [`emit`](crate::emit) writes these tables as Rust, and a program that
//! compiles formulas while it runs hands the same tables to the runtime. They mirror the runtime's
//! `automaton::Tables` and `robustness::Op` field by field; the two crates do not know each other.

use rustc_hash::FxHashMap;

use crate::bdd::Cube;
use crate::dfa::{Dfa, Guards, State};
use crate::spec::{Formula, Spec};

/// A dense table has up to this many entries; a larger automaton keeps its decision diagram. 16 KB
/// are half of the first-level cache of a small processor.
const DENSE_LIMIT: usize = 4096;
/// And only up to this many propositions, for all of them are evaluated to index it.
const DENSE_PROPOSITIONS: usize = 10;

/// All data of an automaton.
///
/// `edges` and `guards` are offsets into the table after them: entry `i` is where item `i` begins,
/// one last entry is where the last item ends.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The names of the propositions.
    pub propositions: Vec<String>,
    /// The number of states.
    pub states: u32,
    /// The accepting state, if there is one.
    pub accepting: Option<State>,
    /// The trap, if there is one.
    pub trap: Option<State>,
    /// The transition function.
    pub transitions: Transitions,
    /// For each state where its edges begin in `targets`.
    pub edges: Vec<u32>,
    /// The state that each edge enters; ascending among the edges of one state.
    pub targets: Vec<State>,
    /// For each guard where it begins in `literals`: first for each state that of progress (paper,
    /// Eq. 3A3), then those of all edges.
    pub guards: Vec<u32>,
    /// All guards in DIMACS style: `3` is "proposition number 2 is true", `-3` "it is false", `0`
    /// ends a cube.
    pub literals: Vec<i32>,
    /// For each state the least number of moves to the accepting state; `u32::MAX` if there is no
    /// way.
    pub distance: Vec<u32>,
}

/// How the next state is found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transitions {
    /// For few propositions: no state tells apart two valuations of one class.
    Table {
        /// The class of each valuation; bit i is proposition i.
        class: Vec<u16>,
        /// The number of classes.
        width: u32,
        /// The next state, indexed `q * width + class`.
        next: Vec<State>,
    },
    /// For many propositions: the decision diagram that all states share.
    Diagram {
        /// The nodes, children before parents: `[proposition, low, high]`, where `low` and `high` are
        /// references. A reference is the index of a node, or [`LEAF`](Self::LEAF) plus a state.
        nodes: Vec<[u32; 3]>,
        /// The reference at which each state starts.
        roots: Vec<u32>,
    },
}

impl Transitions {
    /// The least reference that is a state.
    pub const LEAF: u32 = 1 << 31;
}

/// One operator of a formula; operands are indices of earlier operators.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// ⊤
    True,
    /// ⊥
    False,
    /// A proposition.
    Is(u32),
    /// A negated proposition.
    Not(u32),
    /// φ ∧ ψ
    And(u32, u32),
    /// φ ∨ ψ
    Or(u32, u32),
    /// ○φ, strong
    Next(u32),
    /// ◇φ
    Eventually(u32),
    /// φ U ψ, strong
    Until(u32, u32),
    /// φ T ψ; the operands are φ and ◇ψ
    Then(u32, u32),
}

/// The operators of a formula, operands first; the last one is the whole.
#[must_use]
pub fn operators(spec: &Spec) -> Vec<Operator> {
    let reachable = spec.reachable();
    let mut place = vec![0_u32; reachable.len()];
    let mut operators = Vec::new();
    for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
        place[id.0 as usize] = operators.len() as u32;
        let at = |operand: crate::spec::FormulaId| place[operand.0 as usize];
        operators.push(match formula {
            Formula::True => Operator::True,
            Formula::False => Operator::False,
            Formula::Literal { proposition, negated: false } => Operator::Is(proposition),
            Formula::Literal { proposition, negated: true } => Operator::Not(proposition),
            Formula::And(a, b) => Operator::And(at(a), at(b)),
            Formula::Or(a, b) => Operator::Or(at(a), at(b)),
            Formula::Next(a) => Operator::Next(at(a)),
            Formula::Eventually(a) => Operator::Eventually(at(a)),
            Formula::Until(a, b) => Operator::Until(at(a), at(b)),
            Formula::Then(a, b) => Operator::Then(at(a), at(b)),
        });
    }
    operators
}

/// The tables of an automaton.
#[must_use]
pub fn tables(dfa: &Dfa) -> Tables {
    let distance = dfa.distances().iter().map(|known| known.unwrap_or(u32::MAX)).collect();
    let mut tables = Tables {
        propositions: dfa.propositions.clone(),
        states: dfa.len() as u32,
        accepting: dfa.accepting,
        trap: dfa.trap,
        transitions: dense(dfa).unwrap_or_else(|| diagram(dfa)),
        edges: vec![0],
        targets: Vec::new(),
        guards: vec![0],
        literals: Vec::new(),
        distance,
    };
    let mut guards = Guards::new(dfa);
    dfa.states().for_each(|q| tables.push_guard(&guards.progress(q)));
    for from in dfa.states() {
        for to in dfa.successors(from) {
            tables.targets.push(to);
            tables.push_guard(&guards.edge(from, to));
        }
        tables.edges.push(tables.targets.len() as u32);
    }
    tables
}

impl Tables {
    fn push_guard(&mut self, cubes: &[Cube]) {
        for cube in cubes {
            let number = |proposition: u32| proposition as i32 + 1;
            let literals =
                cube.iter().map(|&(p, value)| if value { number(p) } else { -number(p) });
            self.literals.extend(literals.chain([0]));
        }
        self.guards.push(self.literals.len() as u32);
    }
}

/// The transitions as a dense table; `None` if it would be too large.
fn dense(dfa: &Dfa) -> Option<Transitions> {
    let count = dfa.propositions.len();
    if count > DENSE_PROPOSITIONS {
        return None;
    }
    let mut columns: FxHashMap<Vec<State>, u16> = FxHashMap::default();
    let mut order = Vec::new();
    let mut class = Vec::with_capacity(1 << count);
    for letter in 0..1_usize << count {
        let column: Vec<State> =
            dfa.states().map(|q| dfa.next(q, |i| letter >> i & 1 == 1)).collect();
        let fresh = columns.len() as u16;
        class.push(*columns.entry(column).or_insert_with_key(|column| {
            order.push(column.clone());
            fresh
        }));
        if class.len().max(order.len() * dfa.len()) > DENSE_LIMIT {
            return None;
        }
    }
    let next = dfa.states().flat_map(|q| order.iter().map(move |column| column[q as usize]));
    Some(Transitions::Table { class, width: order.len() as u32, next: next.collect() })
}

fn diagram(dfa: &Dfa) -> Transitions {
    let nodes = dfa.diagram.nodes().iter();
    Transitions::Diagram {
        nodes: nodes.map(|n| [n.level, n.low.code(), n.high.code()]).collect(),
        roots: dfa.transitions.iter().map(|root| root.code()).collect(),
    }
}
