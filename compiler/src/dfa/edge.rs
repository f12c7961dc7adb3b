//! The edges of an automaton with their guards, as drawings and tables list them.

use super::{Dfa, Guards, State};
use crate::bdd::Cube;

/// All transitions from one state to one state, as one edge.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "a T b");
/// let edges = compile::formula(&source, Budget::EMITTED)?.automata[0].dfa.edges();
/// let ends: Vec<_> = edges.iter().map(|edge| (edge.from, edge.to, edge.is_loop())).collect();
/// assert_eq!(ends, [(0, 0, true), (0, 1, false), (1, 1, true), (1, 2, false), (2, 2, true)]);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The state that it leaves.
    pub from: State,
    /// The state that it enters; the same one for a self-loop.
    pub to: State,
    /// The letters under which it is taken: an irredundant sum of products, never empty.
    pub guard: Vec<Cube>,
}

impl Edge {
    /// Whether it leads back to where it starts.
    #[must_use]
    pub fn is_loop(&self) -> bool {
        self.from == self.to
    }
}

impl Dfa {
    /// All edges, self-loops included, by rising states. An edge that only impossible letters take
    /// is left out.
    ///
    /// ```
    /// # use tltl_compiler::{compile, source::Source, translate::Budget};
    /// let source = Source::new("formula", "F (x < 1 || x > 3)");
    /// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
    /// let edges = dfa.edges();
    /// assert_eq!(edges.iter().filter(|edge| edge.is_loop()).count(), 2);
    /// // Both at once cannot occur, and the guard does not say so.
    /// assert_eq!(edges[1].guard, [vec![(0, true)], vec![(1, true)]]);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn edges(&self) -> Vec<Edge> {
        let mut guards = Guards::new(self);
        let mut edges = Vec::new();
        for from in self.states() {
            for (to, guard) in guards.edges(from) {
                edges.push(Edge { from, to, guard: guards.cubes(guard) });
            }
        }
        edges
    }
}
