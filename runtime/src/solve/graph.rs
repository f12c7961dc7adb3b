//! The order in which to solve: components of the automaton, and pairs within a component.
//!
//! Two facts make the order worth its cost. Between two components the automaton only moves one
//! way, so each is solved once, with everything that it leads to known already; most automata of
//! tasks have a component for each state. Within a component, values flow backwards from its exits,
//! so a sweep that starts beside them uses each value in the sweep in which it was found.
//!
//! Both are graph searches, linear in the edges. They decide the order alone, never a value: with
//! a wrong order the sweeps would be more, and the result the same within its error.

use alloc::vec::Vec;

use super::Problem;
use crate::augmented::{LabelTable, Labelled};
use crate::reward::End;

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

/// Pairs (member, s) in the order of their distance from the exits.
///
/// A pair is written (k, s): `k` is the place of the automaton state among the members of the
/// component. What cannot reach an exit is worth 0 undiscounted, and what it pays on its own when
/// discounted; such pairs come last, and undiscounted sweeps leave them out.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub(super) pairs: Vec<(u32, u32)>,
    /// How many pairs can reach an exit; the others follow in index order.
    pub(super) reached: usize,
    /// How many pairs can reach one in one step.
    pub(super) seeds: usize,
}

/// Searches backwards from the exits of `members`: pairs that read a state on which they go to an
/// automaton state outside, the trap excepted. Under a policy only its actions count.
///
/// The exits themselves are not pairs but moves out of the component: the seeds are the pairs from
/// which such a move is one step away. The trap is no exit, for nothing can be had there. A
/// breadth-first search, whose queue is the list of the pairs found so far; cost: one look at each
/// predecessor of each pair, and under a policy one binary search for its action's outcome.
#[inline]
pub(super) fn order(problem: &Problem, members: &[u32], policy: Option<&[u32]>) -> Order {
    let Problem { dynamics, task: labelled, .. } = problem;
    let (first, list) = &*problem.predecessors;
    let states = labelled.states();
    let uses = |k: usize, from: usize, to: usize| {
        policy.is_none_or(|policy| {
            let action = policy[labelled.pair(members[k], from)] as usize;
            let (successors, matrix) = (dynamics.successors(from), dynamics.matrix(from));
            let column = successors.binary_search(&(to as u32));
            column.is_ok_and(|column| matrix[action * successors.len() + column] > 0.0)
        })
    };
    let mut seen = alloc::vec![false; members.len() * states];
    let mut pairs: Vec<(u32, u32)> = Vec::with_capacity(seen.len());
    // Finds the pairs from which member `k` comes to an arrival.
    let mut arrive = |pairs: &mut Vec<(u32, u32)>, k: usize, at: usize| {
        for &from in &list[first[at] as usize..first[at + 1] as usize] {
            let pair = k * states + from as usize;
            if !seen[pair] && uses(k, from as usize, at) {
                seen[pair] = true;
                pairs.push((k as u32, from));
            }
        }
    };
    for (k, &member) in members.iter().enumerate() {
        for at in 0..dynamics.arrivals() {
            let to = labelled.next(member, dynamics.arrived(at));
            let leaves = if at < states {
                members.binary_search(&to).is_err() && labelled.end(to) != Some(End::Lost)
            } else {
                labelled.end(to) == Some(End::Accepted)
            };
            if leaves {
                arrive(&mut pairs, k, at);
            }
        }
    }
    let seeds = pairs.len();
    let mut at = 0;
    while let Some(&(k, s)) = pairs.get(at) {
        for (j, &member) in members.iter().enumerate() {
            if labelled.next(member, s as usize) == members[k as usize] {
                arrive(&mut pairs, j, s as usize);
            }
        }
        at += 1;
    }
    let reached = pairs.len();
    // Discounted sweeps need a value there too.
    let missing = (0..seen.len()).filter(|&at| !seen[at]);
    pairs.extend(missing.map(|at| ((at / states) as u32, (at % states) as u32)));
    Order { pairs, reached, seeds }
}
