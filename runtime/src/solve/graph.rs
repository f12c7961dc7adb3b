//! The strongly connected components of an automaton: the order in which to solve.
//!
//! Between two components the automaton only moves one way, so each is solved once, with everything
//! that it leads to known already; most automata of tasks have a component for each state.

use alloc::vec::Vec;

use crate::augmented::{LabelTable, Labelled};

/// The strongly connected components of the live automaton states, those that others lead to
/// first (Tarjan 1972, without recursion).
///
/// Ends are no components: their values are known, for nothing is paid after them. Tarjan's
/// algorithm closes a component only after all that it leads to, so its numbers are the order.
/// Without recursion, for a deadline of ten thousand steps is a path of as many states.
#[inline]
pub(super) fn components(labelled: &Labelled) -> Vec<Vec<u32>> {
    let n = labelled.automaton_states() as usize;
    let mut search = Tarjan {
        labelled,
        index: alloc::vec![u32::MAX; n],
        low: alloc::vec![0; n],
        component: alloc::vec![usize::MAX; n],
        stack: Vec::new(),
        entered: 0,
        components: 0,
    };
    for q in labelled.live() {
        if search.index[q as usize] == u32::MAX {
            search.visit(q);
        }
    }
    let mut components = alloc::vec![Vec::new(); search.components];
    for q in labelled.live() {
        components[search.component[q as usize]].push(q);
    }
    components
}

/// The search, with the names of Tarjan's paper: `index` is the order in which a state was entered
/// (`u32::MAX`: not yet), `low` the least index that it is known to reach among those on the stack.
struct Tarjan<'a> {
    labelled: &'a Labelled,
    index: Vec<u32>,
    low: Vec<u32>,
    /// `usize::MAX`: not known yet.
    component: Vec<usize>,
    stack: Vec<u32>,
    entered: u32,
    components: usize,
}

impl Tarjan<'_> {
    /// Searches from `root`. `path` holds each state on the way down with the next of its moves to
    /// look at, as the call stack would.
    #[inline]
    fn visit(&mut self, root: u32) {
        let mut path = alloc::vec![(root, 0)];
        self.enter(root);
        while let Some((q, at)) = path.pop() {
            let LabelTable { classes, next, .. } = self.labelled.tables();
            let row = &next[q as usize * classes..][..*classes];
            let Some(&to) = row.get(at) else {
                self.leave(q, path.last().map(|&(parent, _)| parent));
                continue;
            };
            // Come back here for the next move, whatever this one leads to.
            path.push((q, at + 1));
            if self.labelled.end(to).is_some() {
                continue;
            }
            if self.index[to as usize] == u32::MAX {
                self.enter(to);
                path.push((to, 0));
            } else if self.component[to as usize] == usize::MAX {
                self.low[q as usize] = self.low[q as usize].min(self.index[to as usize]);
            }
        }
    }

    /// Numbers a state that is met for the first time.
    #[inline]
    fn enter(&mut self, q: u32) {
        self.index[q as usize] = self.entered;
        self.low[q as usize] = self.entered;
        self.stack.push(q);
        self.entered += 1;
    }

    /// Hands `low` up to the parent, and closes the component if `q` is the first of it that was
    /// entered: then the component is what stands on the stack from there on.
    #[inline]
    fn leave(&mut self, q: u32, parent: Option<u32>) {
        if let Some(parent) = parent {
            let low = self.low[q as usize];
            self.low[parent as usize] = self.low[parent as usize].min(low);
        }
        if self.low[q as usize] == self.index[q as usize] {
            while self.component[q as usize] == usize::MAX
                && let Some(member) = self.stack.pop()
            {
                self.component[member as usize] = self.components;
            }
            self.components += 1;
        }
    }
}
