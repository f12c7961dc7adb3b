//! Automata as data: the static tables that generated code holds.
//!
//! An [`Automaton`] is the minimal complete DFA of a task over the valuations of its propositions
//! (the FSA of the paper's Definition 2). It reads *every* state of a trajectory, `s_0` included,
//! has at most one accepting state, absorbing, and at most one trap. Nothing here allocates or
//! parses: a `static Automaton` is written by the compiler and only read at run time.

/// A conjunction of literals in DIMACS style: `3` is proposition number 2 true, `-3` the same one
/// false. The empty cube is true.
pub type Cube = &'static [i32];

/// A Boolean function of the propositions as an irredundant sum of products: a disjunction of
/// cubes. The empty guard is false.
pub type Guard = &'static [Cube];

/// One edge of an automaton: the guard ψ_{q,q'} under which it moves (paper, Definition 2).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The state that the edge leaves.
    pub from: u32,
    /// The state that the edge enters; equal to `from` for a self-loop.
    pub to: u32,
    /// The valuations that take this edge.
    pub guard: Guard,
}

/// A node of a shared decision diagram: it asks one proposition.
///
/// `low` and `high` are references: below [`Node::LEAF`] the index of another node, from there on
/// an automaton state plus [`Node::LEAF`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// The proposition that is asked.
    pub proposition: u32,
    /// Where to go if it is false.
    pub low: u32,
    /// Where to go if it is true.
    pub high: u32,
}

impl Node {
    /// References from here on are automaton states: `LEAF + q`.
    pub const LEAF: u32 = 1 << 31;
}

/// How an automaton finds the next state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transitions {
    /// For few propositions: valuations collapse to classes that no state tells apart.
    Table {
        /// The class of each valuation, `1 << propositions` of them; bit i is proposition i.
        class: &'static [u16],
        /// The number of classes.
        width: u32,
        /// The next state, indexed `q * width + class`.
        next: &'static [u32],
    },
    /// For many propositions: a decision diagram that all states share.
    Diagram {
        /// The nodes; children stand before their parents.
        nodes: &'static [Node],
        /// Where each state starts, a reference as in [`Node`].
        roots: &'static [u32],
    },
}

/// A minimal complete DFA over the valuations of named propositions.
///
/// Invariants, kept by the compiler that writes it: states are numbered breadth-first from the
/// initial state 0; `edges` is sorted by `(from, to)`, and the guards that leave one state are
/// disjoint and cover all valuations that can occur; the accepting state and the trap have a
/// self-loop only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Automaton {
    /// The propositions, in order of first appearance in the source.
    pub propositions: &'static [&'static str],
    /// The number of states, the trap included.
    pub states: u32,
    /// The accepting state, absorbing. `None`: no trajectory satisfies the task.
    pub accepting: Option<u32>,
    /// The rejecting state, absorbing. `None`: the task can never be lost.
    pub trap: Option<u32>,
    /// The transition function δ.
    pub transitions: Transitions,
    /// All edges with their guards, self-loops included.
    pub edges: &'static [Edge],
    /// For each state the guard D_φ^q of leaving it for another state that is not the trap
    /// (paper, Eq. 3A3).
    pub progress: &'static [Guard],
    /// For each state the least number of moves to the accepting state; `u32::MAX` where there is
    /// no way.
    pub distance: &'static [u32],
}

impl Automaton {
    /// The state before the first state of the trajectory is read.
    pub const INITIAL: u32 = 0;

    /// The next state from `q` under the valuation that `holds` answers, one proposition at a time.
    ///
    /// # Errors
    /// The first error of `holds`. A [`Transitions::Diagram`] asks only for the propositions that
    /// decide the move.
    ///
    /// # Panics
    /// If `q` is not a state of this automaton.
    #[inline]
    pub fn next<E>(
        &self,
        q: u32,
        mut holds: impl FnMut(usize) -> Result<bool, E>,
    ) -> Result<u32, E> {
        match self.transitions {
            Transitions::Table { class, width, next } => {
                let mut valuation = 0;
                for i in 0..self.propositions.len() {
                    valuation |= usize::from(holds(i)?) << i;
                }
                Ok(next[(q * width) as usize + usize::from(class[valuation])])
            }
            Transitions::Diagram { nodes, roots } => {
                let mut at = roots[q as usize];
                while at < Node::LEAF {
                    let node = &nodes[at as usize];
                    at = if holds(node.proposition as usize)? { node.high } else { node.low };
                }
                Ok(at - Node::LEAF)
            }
        }
    }

    /// The edges that leave `q`, self-loop included, sorted by target.
    #[must_use]
    pub fn edges_from(&self, q: u32) -> &'static [Edge] {
        let start = self.edges.partition_point(|edge| edge.from < q);
        let end = self.edges.partition_point(|edge| edge.from <= q);
        &self.edges[start..end]
    }

    /// Whether `q` is the accepting state.
    #[inline]
    #[must_use]
    pub fn is_accepting(&self, q: u32) -> bool {
        self.accepting == Some(q)
    }

    /// Whether `q` is the trap.
    #[inline]
    #[must_use]
    pub fn is_trap(&self, q: u32) -> bool {
        self.trap == Some(q)
    }
}
