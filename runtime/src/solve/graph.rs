//! The order in which to solve: components of the automaton, and pairs within a component.

use alloc::collections::VecDeque;
use alloc::vec::Vec;

use crate::augmented::Labelled;

/// The strongly connected components of the live automaton states, those that others lead to
/// first (Tarjan 1972, without recursion).
pub(super) fn components(labelled: &Labelled) -> Vec<Vec<u32>> {
    let n = labelled.automaton_states() as usize;
    let mut search = Search {
        labelled,
        index: alloc::vec![u32::MAX; n],
        low: alloc::vec![0; n],
        open: alloc::vec![false; n],
        stack: Vec::new(),
        found: 0,
        components: Vec::new(),
    };
    for q in labelled.live() {
        if search.index[q as usize] == u32::MAX {
            search.visit(q);
        }
    }
    search.components
}

struct Search<'a> {
    labelled: &'a Labelled,
    index: Vec<u32>,
    low: Vec<u32>,
    open: Vec<bool>,
    stack: Vec<u32>,
    found: u32,
    components: Vec<Vec<u32>>,
}

impl Search<'_> {
    fn visit(&mut self, root: u32) {
        let mut path = alloc::vec![(root, 0)];
        self.enter(root);
        while let Some((q, at)) = path.pop() {
            let classes = self.labelled.classes();
            let row = &self.labelled.table()[q as usize * classes..][..classes];
            let Some(&to) = row.get(at) else {
                self.leave(q, path.last().map(|&(parent, _)| parent));
                continue;
            };
            path.push((q, at + 1));
            if self.labelled.end(to).is_some() {
                continue;
            }
            if self.index[to as usize] == u32::MAX {
                self.enter(to);
                path.push((to, 0));
            } else if self.open[to as usize] {
                self.low[q as usize] = self.low[q as usize].min(self.index[to as usize]);
            }
        }
    }

    fn enter(&mut self, q: u32) {
        self.index[q as usize] = self.found;
        self.low[q as usize] = self.found;
        self.open[q as usize] = true;
        self.stack.push(q);
        self.found += 1;
    }

    fn leave(&mut self, q: u32, parent: Option<u32>) {
        if let Some(parent) = parent {
            let low = self.low[q as usize];
            self.low[parent as usize] = self.low[parent as usize].min(low);
        }
        if self.low[q as usize] == self.index[q as usize] {
            let start = self.stack.iter().rposition(|&other| other == q).unwrap_or(0);
            let mut members = self.stack.split_off(start);
            members.iter().for_each(|&q| self.open[q as usize] = false);
            members.sort_unstable();
            self.components.push(members);
        }
    }
}

/// Pairs (member, s) in the order of their distance from the exits.
#[derive(Clone, Debug)]
pub(super) struct Order {
    pub(super) pairs: Vec<(u32, u32)>,
    /// How many pairs can reach an exit; the others follow in index order.
    pub(super) reached: usize,
    /// How many pairs can reach one in one step.
    pub(super) seeds: usize,
}

/// Searches backwards from the exits of `members`: pairs that read a state on which they go to an
/// automaton state outside, the trap excepted. `next(q, s)` is the automaton, `uses(k, from, to)`
/// says whether member k goes from state `from` to `to` at all.
pub(super) fn order(
    members: &[u32],
    states: usize,
    (first, list): &(Vec<u32>, Vec<u32>),
    is_trap: impl Fn(u32) -> bool,
    next: impl Fn(u32, usize) -> u32,
    uses: impl Fn(usize, usize, usize) -> bool,
) -> Order {
    let mut seen = alloc::vec![false; members.len() * states];
    let (mut pairs, mut seeds) = (Vec::with_capacity(seen.len()), 0);
    let mut queue = VecDeque::new();
    for k in 0..members.len() {
        for s in 0..states {
            let to = next(members[k], s);
            if members.binary_search(&to).is_err() && !is_trap(to) {
                queue.push_back((k, s, true));
            }
        }
    }
    while let Some((k, s, exit)) = queue.pop_front() {
        for &from in &list[first[s] as usize..first[s + 1] as usize] {
            let at = k * states + from as usize;
            if !seen[at] && uses(k, from as usize, s) {
                seen[at] = true;
                seeds += usize::from(exit);
                pairs.push((k as u32, from));
                let enters = |&j: &usize| next(members[j], from as usize) == members[k];
                (0..members.len()).filter(enters).for_each(|j| {
                    queue.push_back((j, from as usize, false));
                });
            }
        }
    }
    let reached = pairs.len();
    let missing = (0..seen.len()).filter(|&at| !seen[at]);
    pairs.extend(missing.map(|at| ((at / states) as u32, (at % states) as u32)));
    Order { pairs, reached, seeds }
}
