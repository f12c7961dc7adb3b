//! Any complete automaton to the canonical minimal one of its language.
//!
//! # Method
//!
//! Moore's partition refinement ("Gedanken-experiments on Sequential Machines", 1956) on the shared
//! diagram. In each round every node is rewritten with the classes of the states that it leads to,
//! and states are separated where their rewritten transitions differ. A round costs one hash per
//! node, however many letters there are. Afterwards states are numbered breadth-first, letters in
//! lexicographic order, and the diagram is laid out anew in that order: equal languages over equal
//! propositions give equal automata, byte for byte.
//!
//! # Why not Hopcroft
//!
//! Hopcroft's algorithm (1971) splits classes by the predecessors under one letter. Over 2^n
//! letters in a diagram it would need the preimage of a class under each path, where Moore needs
//! the nodes once. Its advantage, few rounds on long chains, comes here from the start: the first
//! partition is that by distance to acceptance (`distances`), which separates the states of a
//! sequence of goals at once.
//!
//! # Cost
//!
//! At most as many rounds as there are letters in the shortest word that separates two states, each
//! linear in the diagram. The known weakness is that every round rewrites all nodes, also those
//! whose classes did not change.
//!
//! ```
//! use tltl_compiler::{check, minimize::minimize, source::Source, translate::{Budget, translate}};
//!
//! let minimal = |text: &str| {
//!     let module = check::formula(&Source::new("formula", text)).unwrap();
//!     minimize(&translate(&module.tasks[0].spec, Budget::EMITTED).unwrap())
//! };
//! // Equal languages: equal automata, whatever the formula.
//! let [one, other] = ["F (a && F b)", "F (a && (true U b)) || F (a && b)"].map(minimal);
//! assert_eq!(one.transitions, other.transitions);
//! assert_eq!(one.diagram.nodes(), other.diagram.nodes());
//! ```

use crate::arena::Memo;
use crate::bdd::{Bdd, Diagram, Node};
use crate::dfa::{Dfa, State};

/// The minimal complete automaton with the same language, in canonical numbering.
///
/// Letters that cannot occur ([`Dfa::possible`]) must have been given away beforehand, see
/// [`Possible::restrict`](crate::arithmetic::Possible::restrict); the result has no `possible`.
#[must_use]
pub fn minimize(dfa: &Dfa) -> Dfa {
    let classes = classes(dfa);
    renumber(dfa, &classes)
}

/// The same states in canonical numbering, unreachable ones dropped, and the old number of each new
/// state. Merges nothing: for a raw automaton that is to be shown.
///
/// ```
/// use tltl_compiler::{check, minimize::canonical_order, source::Source};
/// use tltl_compiler::translate::{Budget, translate};
///
/// let module = check::formula(&Source::new("formula", "F a || F b"))?;
/// let raw = translate(&module.tasks[0].spec, Budget::EMITTED).unwrap();
/// let (ordered, numbers) = canonical_order(&raw);
/// assert_eq!(ordered.len(), numbers.len());
/// assert_eq!(numbers[0], 0);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn canonical_order(dfa: &Dfa) -> (Dfa, Vec<State>) {
    let apart: Vec<_> = dfa.states().collect();
    (renumber(dfa, &apart), breadth_first(dfa, &apart, &apart))
}

/// The coarsest partition that separates the accepting state from the others and is respected by
/// all transitions, as the class of each state.
///
/// Starts from the distances to acceptance, which equivalent states share. In a sequence of goals
/// these alone separate all states; without them it would take as many rounds as there are goals.
fn classes(dfa: &Dfa) -> Vec<State> {
    let order = dfa.diagram.postorder(&dfa.transitions);
    let mut classes = distances(dfa);
    let mut rewritten = Diagram::default();
    let mut count = 0;
    loop {
        rewritten.clear();
        let (refined, refined_count) = refine(dfa, &order, &classes, &mut rewritten);
        if refined_count == count {
            return refined;
        }
        (classes, count) = (refined, refined_count);
    }
}

/// The least number of letters from each state to acceptance; [`Dfa::len`] where there is no way.
///
/// An initial state from which every letter accepts counts as accepting, for a trajectory has at
/// least one letter. The accepting state is absorbing, so no trajectory meets that initial state
/// again.
///
/// Breadth-first and backwards through the nodes, each entered once: linear in the diagram.
/// [`Dfa::distances`] gives the same numbers from successors; this function also runs on raw
/// automata, where listing the successors of each state is quadratic.
fn distances(dfa: &Dfa) -> Vec<State> {
    let never = dfa.len() as State;
    let mut distances = vec![never; dfa.len()];
    let above = above(dfa);
    let mut frontier: Vec<State> = dfa.accepting.into_iter().collect();
    if dfa.accepting.is_some_and(|q| dfa.transitions[0] == Bdd::leaf(q)) {
        frontier.push(0);
    }
    frontier.iter().for_each(|&q| distances[q as usize] = 0);
    let mut seen = vec![false; dfa.diagram.nodes().len()];
    let mut stack = Vec::new();
    for distance in 1.. {
        stack.extend(frontier.drain(..).map(Bdd::leaf));
        while let Some(target) = stack.pop() {
            for &parent in above.of(target) {
                match (parent.index(), parent.value()) {
                    (Some(node), _) if !std::mem::replace(&mut seen[node as usize], true) => {
                        stack.push(parent);
                    }
                    (_, Some(q)) if distances[q as usize] == never => {
                        distances[q as usize] = distance;
                        frontier.push(q);
                    }
                    _ => {}
                }
            }
        }
        if frontier.is_empty() {
            break;
        }
    }
    distances
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

/// Collects the parents of every node and state by counting sort: one pass counts them, one writes
/// them.
fn above(dfa: &Dfa) -> Above {
    let states = dfa.len();
    let nodes = (0..)
        .zip(dfa.diagram.nodes())
        .flat_map(|(index, node)| [node.low, node.high].map(|child| (child, Bdd::node(index))));
    let roots = (0..).zip(&dfa.transitions).map(|(q, &root)| (root, Bdd::leaf(q)));
    let pairs: Vec<_> = roots.chain(nodes).collect();
    let mut starts = vec![0; states + dfa.diagram.nodes().len() + 1];
    pairs.iter().for_each(|&(child, _)| starts[Above::place(states, child)] += 1);
    let mut total = 0;
    for start in &mut starts {
        total += *start;
        *start = total;
    }
    let mut parents = vec![Bdd::leaf(0); pairs.len()];
    for (child, parent) in pairs {
        let start = &mut starts[Above::place(states, child)];
        *start -= 1;
        parents[*start as usize] = parent;
    }
    Above { states, starts, parents }
}

/// One round: the classes after it, and their number. Classes are numbered in the order in which
/// states meet them, so the numbering is a function of the automaton. `rewritten` is an empty diagram.
fn refine(
    dfa: &Dfa,
    order: &[u32],
    classes: &[State],
    rewritten: &mut Diagram,
) -> (Vec<State>, usize) {
    let class = |state: State| Bdd::leaf(classes[state as usize]);
    let images = dfa
        .diagram
        .fold(order, &class, &mut |Node { level, low, high }| rewritten.node(level, low, high));
    let mut known: Memo<(State, Bdd), State> = Memo::default();
    let refined = dfa.states().map(|q| {
        let fresh = known.len() as State;
        let image = images.of(dfa.transitions[q as usize]);
        known.get_or_insert((classes[q as usize], image), fresh)
    });
    let refined = refined.collect();
    (refined, known.len())
}

/// The automaton of the classes that the initial state reaches, numbered breadth-first. The trap is
/// found anew: a class may be one although no state of the raw automaton was marked.
fn renumber(dfa: &Dfa, classes: &[State]) -> Dfa {
    let count = classes.iter().max().map_or(0, |&last| last as usize + 1);
    let mut representative = vec![0; count];
    // Backwards, so that the first state of a class represents it.
    dfa.states().rev().for_each(|q| representative[classes[q as usize] as usize] = q);
    let order = breadth_first(dfa, classes, &representative);
    let mut number = vec![0; count];
    (0..).zip(&order).for_each(|(fresh, &class)| number[class as usize] = fresh);
    let rename = |state: State| number[classes[state as usize] as usize];
    let root = |&class: &State| dfa.transitions[representative[class as usize] as usize];
    let roots: Vec<Bdd> = order.iter().map(root).collect();
    let (diagram, transitions) = dfa.diagram.map_leaves(&roots, &|q| Bdd::leaf(rename(q)));
    let kept = |state: &State| order.contains(&classes[*state as usize]);
    let accepting = dfa.accepting.filter(kept).map(rename);
    let is_trap = |&q: &State| accepting != Some(q) && transitions[q as usize] == Bdd::leaf(q);
    Dfa {
        propositions: dfa.propositions.clone(),
        accepting,
        trap: (0..transitions.len() as State).find(is_trap),
        diagram,
        transitions,
        possible: None,
    }
}

/// The classes that the initial state reaches, breadth-first, letters in lexicographic order. A
/// node that has been walked leads to nothing new, so all walks together are linear in the diagram.
fn breadth_first(dfa: &Dfa, classes: &[State], representative: &[State]) -> Vec<State> {
    let mut seen = vec![false; representative.len()];
    let mut walked = vec![false; dfa.diagram.nodes().len()];
    let mut order = vec![classes[0]];
    seen[classes[0] as usize] = true;
    let mut at = 0;
    while let Some(&class) = order.get(at) {
        at += 1;
        let root = dfa.transitions[representative[class as usize] as usize];
        let enter = &mut |index| !std::mem::replace(&mut walked[index as usize], true);
        dfa.diagram.walk(root, enter, &mut |state| {
            let to = classes[state as usize];
            if !std::mem::replace(&mut seen[to as usize], true) {
                order.push(to);
            }
        });
    }
    order
}
