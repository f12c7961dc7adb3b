//! The edges of an automaton with their guards, as every drawing and table lists them.

use super::{Dfa, Guards, State};
use crate::bdd::Cube;

/// All transitions from one state to one state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Edge {
    /// From.
    pub from: State,
    /// To; the same for a self-loop.
    pub to: State,
    /// When: an irredundant sum of products.
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
    /// All edges, self-loops included, by rising states. An edge that only letters take that cannot
    /// occur is none.
    #[must_use]
    pub fn edges(&self) -> Vec<Edge> {
        let mut guards = Guards::new(self);
        let mut edges = Vec::new();
        for from in self.states() {
            for (to, when) in guards.moves[from as usize].clone() {
                let guard = guards.sum(when);
                if !guard.is_empty() {
                    edges.push(Edge { from, to, guard });
                }
            }
        }
        edges
    }
}
