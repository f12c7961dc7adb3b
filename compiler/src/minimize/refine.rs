//! The coarsest partition of the states, by refinement that looks only at what changed.

use crate::bdd::{Bdd, Diagram};
use crate::dfa::{Dfa, State};

/// The coarsest partition that separates the accepting state from the others and is respected by
/// all transitions, as the class of each state.
///
/// An initial state from which every letter accepts counts as accepting, for a trajectory has at
/// least one letter. The accepting state is absorbing, so no trajectory meets that initial state
/// again.
pub(super) fn classes(dfa: &Dfa) -> Vec<State> {
    let mut refinement = Refinement::new(dfa);
    // At first nothing is known of any state.
    let mut changed = dfa.states().collect::<Vec<_>>();
    while !changed.is_empty() {
        let moved = refinement.split(changed);
        changed = refinement.rewrite(&moved);
    }
    refinement.classes
}

/// A partition of the states, and the nodes rewritten with its classes.
///
/// Invariant: between two rounds all states of a class had the same rewritten transitions when they
/// were last looked at. [`rewrite`](Self::rewrite) finds those that have not any more,
/// [`split`](Self::split) separates them.
struct Refinement<'a> {
    dfa: &'a Dfa,
    above: Above,
    /// The class of each state.
    classes: Vec<State>,
    /// The states, class by class.
    members: Vec<State>,
    /// The place of each state in `members`.
    places: Vec<u32>,
    /// Where the members of each class begin and end.
    ranges: Vec<(u32, u32)>,
    /// The nodes that the states need, children before parents.
    order: Vec<u32>,
    /// Functions with classes as leaves. Nothing is removed but all at once, so equal images are
    /// equal.
    rewritten: Diagram,
    /// The image in `rewritten` of each node.
    images: Vec<Bdd>,
    /// The image of the transitions of each state.
    signatures: Vec<Bdd>,
    /// The nodes to rewrite, by their level: a node is rewritten after all nodes below it.
    waiting: Vec<Vec<u32>>,
    /// Whether a node waits. Nodes that no state needs always do, and are never rewritten.
    waits: Vec<bool>,
}

impl<'a> Refinement<'a> {
    /// The partition into the accepting and the other states.
    fn new(dfa: &'a Dfa) -> Self {
        let order = dfa.diagram.postorder(&dfa.transitions);
        let accepts = |q: State| {
            let always = dfa.accepting.map(Bdd::leaf) == Some(dfa.transitions[q as usize]);
            dfa.accepting == Some(q) || q == 0 && always
        };
        let (mut members, accepting): (Vec<_>, Vec<_>) = dfa.states().partition(|&q| !accepts(q));
        let (others, all) = (members.len() as u32, dfa.len() as u32);
        members.extend(accepting);
        let mut places = vec![0; dfa.len()];
        (0..).zip(&members).for_each(|(place, &q)| places[q as usize] = place);
        let mut waits = vec![true; dfa.diagram.nodes().len()];
        order.iter().for_each(|&node| waits[node as usize] = false);
        let mut refinement = Self {
            dfa,
            above: Above::new(dfa, &order),
            classes: dfa.states().map(|q| u32::from(accepts(q))).collect(),
            members,
            places,
            ranges: vec![(0, others), (others, all)],
            rewritten: Diagram::default(),
            images: vec![Bdd::FALSE; dfa.diagram.nodes().len()],
            signatures: Vec::new(),
            waiting: vec![Vec::new(); dfa.propositions.len()],
            waits,
            order,
        };
        refinement.rewrite_all();
        refinement
    }

    /// Rewrites all nodes, in a diagram without the images of earlier rounds.
    fn rewrite_all(&mut self) {
        self.rewritten.clear();
        for place in 0..self.order.len() {
            let node = self.order[place];
            self.images[node as usize] = self.image(node);
        }
        self.signatures = self.dfa.transitions.iter().map(|&root| self.of(root)).collect();
    }

    /// The image of a function, whose nodes have theirs.
    fn of(&self, f: Bdd) -> Bdd {
        match f.index() {
            Some(node) => self.images[node as usize],
            None => Bdd::leaf(self.classes[f.value().expect("a state") as usize]),
        }
    }

    /// The image of a node from those of its children.
    fn image(&mut self, node: u32) -> Bdd {
        let node = self.dfa.diagram.nodes()[node as usize];
        let (low, high) = (self.of(node.low), self.of(node.high));
        self.rewritten.node(node.level, low, high)
    }

    /// Separates the states of each class whose transitions differ; those of `changed` are not what
    /// they were. Returns the states whose class has a new number: the largest part keeps the old
    /// one, so a state moves at most log₂ n times.
    fn split(&mut self, changed: Vec<State>) -> Vec<State> {
        let key = |q: State| (self.classes[q as usize], self.signatures[q as usize], q);
        let mut keys: Vec<_> = changed.into_iter().map(key).collect();
        keys.sort_unstable();
        let mut moved = Vec::new();
        for class in keys.chunk_by(|a, b| a.0 == b.0) {
            self.split_class(class, &mut moved);
        }
        moved
    }

    /// Separates the states of one class: those that changed, by their transitions, and the others,
    /// which differ from all of these.
    fn split_class(&mut self, changed: &[(State, Bdd, State)], moved: &mut Vec<State>) {
        let class = changed[0].0 as usize;
        let (mut at, end) = self.ranges[class];
        let mut parts = Vec::new();
        for part in changed.chunk_by(|a, b| a.1 == b.1) {
            let first = at;
            for &(_, _, q) in part {
                self.swap(q, at);
                at += 1;
            }
            parts.push((first, at));
        }
        if at < end {
            parts.push((at, end));
        }
        let largest = (0..parts.len()).max_by_key(|&part| parts[part].1 - parts[part].0);
        self.ranges[class] = parts.swap_remove(largest.expect("a class has states"));
        for (first, end) in parts {
            let members = &self.members[first as usize..end as usize];
            let fresh = self.ranges.len() as State;
            members.iter().for_each(|&q| self.classes[q as usize] = fresh);
            moved.extend(members);
            self.ranges.push((first, end));
        }
    }

    /// Puts a state in a place among the members; the state that was there takes its place.
    fn swap(&mut self, q: State, place: u32) {
        let (from, other) = (self.places[q as usize], self.members[place as usize]);
        self.members.swap(from as usize, place as usize);
        self.places[q as usize] = place;
        self.places[other as usize] = from;
    }

    /// Rewrites the nodes above states whose class has a new number, lowest first and only as far
    /// up as images change. Returns the states whose transitions changed.
    fn rewrite(&mut self, moved: &[State]) -> Vec<State> {
        // Where most nodes are to be rewritten, to look for them costs more than to take all, and a
        // diagram that is small stays in the cache: the tool takes 170 ms for the 65,537 states of
        // `F (a && X[16] b)`, and took 200.
        if moved.len() > self.classes.len() / 8 {
            self.rewrite_all();
            return self.dfa.states().collect();
        }
        let mut roots = Vec::new();
        moved.iter().for_each(|&q| self.wake(Bdd::leaf(q), &mut roots));
        for level in (0..self.waiting.len()).rev() {
            while let Some(node) = self.waiting[level].pop() {
                self.waits[node as usize] = false;
                let image = self.image(node);
                if std::mem::replace(&mut self.images[node as usize], image) != image {
                    self.wake(Bdd::node(node), &mut roots);
                }
            }
        }
        roots.retain(|&q| {
            let signature = self.of(self.dfa.transitions[q as usize]);
            std::mem::replace(&mut self.signatures[q as usize], signature) != signature
        });
        roots
    }

    /// Lets the nodes directly above `f` wait, and adds the states that begin there to `roots`.
    fn wake(&mut self, f: Bdd, roots: &mut Vec<State>) {
        for &parent in self.above.of(f) {
            match (parent.index(), parent.value()) {
                (Some(node), _) if !std::mem::replace(&mut self.waits[node as usize], true) => {
                    let level = self.dfa.diagram.nodes()[node as usize].level;
                    self.waiting[level as usize].push(node);
                }
                (_, Some(q)) => roots.push(q),
                _ => {}
            }
        }
    }
}

/// For each node and each state, the nodes and states that lead to it directly, as one flat array
/// (compressed rows).
struct Above {
    /// The number of states: places of nodes follow on those of states.
    states: usize,
    /// For each place where its parents begin; one more entry ends the last.
    starts: Vec<u32>,
    parents: Vec<Bdd>,
}

impl Above {
    /// Collects the parents of every node of `order` and of every state by counting sort: one pass
    /// counts them, one writes them.
    fn new(dfa: &Dfa, order: &[u32]) -> Self {
        let roots = (0..).zip(&dfa.transitions).map(|(q, &root)| (root, Bdd::leaf(q)));
        let mut pairs: Vec<_> = roots.collect();
        for &index in order {
            let (node, parent) = (dfa.diagram.nodes()[index as usize], Bdd::node(index));
            pairs.extend([(node.low, parent), (node.high, parent)]);
        }
        let states = dfa.len();
        let mut starts = vec![0; states + dfa.diagram.nodes().len() + 1];
        pairs.iter().for_each(|&(child, _)| starts[Self::place(states, child)] += 1);
        let mut total = 0;
        for start in &mut starts {
            total += *start;
            *start = total;
        }
        let mut parents = vec![Bdd::leaf(0); pairs.len()];
        for (child, parent) in pairs {
            let start = &mut starts[Self::place(states, child)];
            *start -= 1;
            parents[*start as usize] = parent;
        }
        Self { states, starts, parents }
    }

    /// The place of a node or a state among the rows.
    fn place(states: usize, target: Bdd) -> usize {
        match target.index() {
            Some(node) => states + node as usize,
            None => target.value().expect("a node or a state") as usize,
        }
    }

    /// The nodes and states that lead to `target` directly.
    fn of(&self, target: Bdd) -> &[Bdd] {
        let place = Self::place(self.states, target);
        &self.parents[self.starts[place] as usize..self.starts[place + 1] as usize]
    }
}
