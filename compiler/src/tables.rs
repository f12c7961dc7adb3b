//! An automaton and its formula as tables: flat arrays of integers that a program can read without
//! preparation.
//!
//! This is the last stage before code. [`emit`](crate::emit) writes these tables as Rust, and a
//! program that compiles formulas while it runs hands the same tables to the runtime. They mirror
//! the runtime's `automaton::Tables` and `robustness::Op` field by field; the two crates do not
//! know each other, and the tests that compile generated code guard the names.
//!
//! There are two forms of the transition function. A dense table costs one lookup a step after all
//! propositions are evaluated; the decision diagram costs one branch a node but evaluates only the
//! propositions that it asks. Few propositions and states take the table, others the diagram.
//! Valuations that no state tells apart share a column, as bytes do in the DFAs of regular
//! expressions.
//!
//! ```
//! use tltl_compiler::{compile, source::Source, tables::{Transitions, tables}, translate::Budget};
//!
//! let source = Source::new("formula", "!water U home");
//! let compiled = compile::formula(&source, Budget::EMITTED)?;
//! let tables = tables(&compiled.automata[0].dfa);
//! assert_eq!((tables.states, tables.accepting, tables.trap), (3, Some(1), Some(2)));
//! // Where `home` holds, `water` does not matter: three classes of four valuations.
//! let Transitions::Table { class, width, next } = &tables.transitions else { panic!() };
//! assert_eq!((&class[..], *width), (&[0, 1, 2, 2][..], 3));
//! assert_eq!(next[..3], [0, 2, 1]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use crate::bdd::{Bdd, Cube};
use crate::dfa::{Dfa, Guards, State};
use crate::intern::Interner;
use crate::spec::{Formula, Spec};

/// A dense table has up to this many entries; a larger automaton keeps its decision diagram. 4,096
/// entries of four bytes are 16 KB, half of the first-level cache of a small processor: the table
/// must leave room for the program around it.
const DENSE_LIMIT: usize = 4096;
/// A dense table has up to this many propositions. All of them are evaluated to index it, while a
/// diagram evaluates only those on one path; and the array of classes has 2^n entries.
const DENSE_PROPOSITIONS: usize = 10;

/// All data of an automaton.
///
/// `edges` and `guards` are offsets into the table after them: entry `i` is where item `i` begins,
/// and one last entry is where the last item ends. All other arrays have one entry for each item
/// that their docs name.
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
    /// The state that each edge enters; rising among the edges of one state, that state included
    /// where it has a self-loop.
    pub targets: Vec<State>,
    /// For each guard where it begins in `literals`: first for each state that of progress (paper,
    /// Eq. 3A3), then for each edge its own.
    pub guards: Vec<u32>,
    /// All guards in DIMACS style: `3` means that proposition number 2 is true, `-3` that it is
    /// false, and `0` ends a cube. One array of integers rather than nested slices, each of which
    /// would need a pointer and a token tree of its own.
    pub literals: Vec<i32>,
    /// For each state the least number of transitions to the accepting state; `u32::MAX` if there
    /// is no way.
    pub distance: Vec<u32>,
}

/// The two forms of a transition function; see the module's docs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transitions {
    /// For few propositions. A class is a set of valuations that no state tells apart.
    Table {
        /// The class of each valuation; bit i of its index is proposition i.
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

/// One operator of a formula. Its operands are indices of earlier operators, so a formula is
/// evaluated by one pass over an array.
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
    /// X\[n\] φ, strong; the bound comes first, here and below
    Delay(u32, u32),
    /// ◇φ
    Eventually(u32),
    /// F\[0,n\] φ
    Within(u32, u32),
    /// G\[0,n\] φ, strong
    Throughout(u32, u32),
    /// φ U ψ, strong
    Until(u32, u32),
    /// φ T ψ; the operands are φ and ◇ψ
    Then(u32, u32),
}

/// The operators of a formula, operands first; the last one is the whole formula. Operators that
/// the root does not need are left out, and shared ones stand there once.
///
/// There is none for φ U\[0,n\] ψ, which is (φ U ψ) ∧ F\[0,n\] ψ: if ψ comes at all and comes within n
/// instants, then so does its first instant, until which φ holds. Minima and maxima only select, so
/// the two have the same robustness too (each threshold on it is a Boolean reading; Donzé, Ferrère
/// and Maler, "Efficient Robust Monitoring for STL", 2013, Lemma 2).
///
/// ```
/// use tltl_compiler::{check, source::Source, tables::{Operator, operators}};
///
/// let module = check::formula(&Source::new("formula", "!a U (b && a)"))?;
/// let operators = operators(&module.tasks[0].spec);
/// assert_eq!(operators[..3], [Operator::Not(0), Operator::Is(1), Operator::Is(0)]);
/// assert_eq!(operators[3..], [Operator::And(1, 2), Operator::Until(0, 3)]);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn operators(spec: &Spec) -> Vec<Operator> {
    let reachable = spec.reachable();
    let mut place = vec![0_u32; reachable.len()];
    let mut operators = Vec::new();
    for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
        let at = |operand: crate::spec::FormulaId| place[operand.0 as usize];
        let operator = match formula {
            Formula::True => Operator::True,
            Formula::False => Operator::False,
            Formula::Literal { proposition, negated: false } => Operator::Is(proposition),
            Formula::Literal { proposition, negated: true } => Operator::Not(proposition),
            Formula::And(a, b) => Operator::And(at(a), at(b)),
            Formula::Or(a, b) => Operator::Or(at(a), at(b)),
            Formula::Next(a) => Operator::Next(at(a)),
            Formula::Delay(n, a) => Operator::Delay(n, at(a)),
            Formula::Eventually(a) => Operator::Eventually(at(a)),
            Formula::Within(n, a) => Operator::Within(n, at(a)),
            Formula::Throughout(n, a) => Operator::Throughout(n, at(a)),
            Formula::Until(a, b) => Operator::Until(at(a), at(b)),
            Formula::UntilWithin(n, a, b) => {
                let until = operators.len() as u32;
                operators.extend([Operator::Until(at(a), at(b)), Operator::Within(n, at(b))]);
                Operator::And(until, until + 1)
            }
            Formula::Then(a, b) => Operator::Then(at(a), at(b)),
        };
        place[id.0 as usize] = operators.len() as u32;
        operators.push(operator);
    }
    operators
}

/// The numbers that the robustness of a formula with these operators works on, on trajectories of
/// any length: one for each operator, and a window for each bound. The runtime's
/// `robustness::cells` says why these.
#[must_use]
pub fn cells(operators: &[Operator]) -> usize {
    let windows = operators.iter().map(|operator| match *operator {
        Operator::Delay(n, _) => n as usize,
        Operator::Within(n, _) | Operator::Throughout(n, _) => n as usize + 2,
        _ => 0,
    });
    windows.fold(operators.len(), usize::saturating_add)
}

/// The tables of an automaton, which should be minimal: the guards are written out, and there may
/// be exponentially many products in one. [`check_guards`](crate::compile::check_guards) tells
/// beforehand.
#[must_use]
pub fn tables(dfa: &Dfa) -> Tables {
    let distance = dfa.distances().iter().map(|known| known.unwrap_or(u32::MAX)).collect();
    let mut tables = Tables {
        propositions: dfa.propositions.iter().map(|one| one.name.clone()).collect(),
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
    /// Appends a guard, a list of cubes.
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
///
/// Compares whole columns of the table to find the classes, and gives up as soon as the columns
/// found so far are too many: the work is at most the size of a table that is kept, times the
/// number of valuations.
fn dense(dfa: &Dfa) -> Option<Transitions> {
    let count = dfa.propositions.len();
    if count > DENSE_PROPOSITIONS {
        return None;
    }
    let mut columns = Interner::default();
    let mut class = Vec::with_capacity(1 << count);
    for letter in 0..1_usize << count {
        let column: Vec<State> =
            dfa.states().map(|q| dfa.next(q, |i| letter >> i & 1 == 1)).collect();
        class.push(columns.intern(column) as u16);
        // Given up early: a large automaton would compute 2^10 columns for nothing.
        if class.len().max(columns.things().len() * dfa.len()) > DENSE_LIMIT {
            return None;
        }
    }
    let order = columns.into_things();
    let next = dfa.states().flat_map(|q| order.iter().map(move |column| column[q as usize]));
    Some(Transitions::Table { class, width: order.len() as u32, next: next.collect() })
}

/// The transitions as the nodes that they need. The automaton's diagram may hold more: the letters
/// that can occur, whose leaves are not states.
fn diagram(dfa: &Dfa) -> Transitions {
    let (needed, roots) = dfa.diagram.map_leaves(&dfa.transitions, &Bdd::leaf);
    Transitions::Diagram {
        nodes: needed.nodes().iter().map(|n| [n.level, n.low.code(), n.high.code()]).collect(),
        roots: roots.iter().map(|root| root.code()).collect(),
    }
}
