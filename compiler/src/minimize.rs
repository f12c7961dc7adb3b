//! Any complete automaton to the canonical minimal one of its language.
//!
//! Moore's partition refinement on the shared diagram: in each round every node is rewritten with
//! the classes of the states that it leads to, and states fall apart where their rewritten
//! transitions differ. A round costs one hash per node, however many letters there are; there are
//! at most as many rounds as it takes letters to tell two states apart. Then states are numbered
//! breadth-first, letters in lexicographic order, and the diagram is laid out anew in that order: equal
//! languages over equal propositions give equal automata, byte for byte.

use crate::arena::Memo;
use crate::dfa::{Dfa, Diagram, State, Target};

/// The minimal complete automaton with the same language, in canonical numbering.
///
/// Letters that cannot occur ([`Dfa::possible`]) must have been given away beforehand, see
/// [`Possible::restrict`](crate::arithmetic::Possible::restrict).
#[must_use]
pub fn minimize(dfa: &Dfa) -> Dfa {
    let classes = classes(dfa);
    renumber(dfa, &classes)
}

/// The same states in canonical numbering, unreachable ones dropped, and the old number of each.
#[must_use]
pub fn canonical_order(dfa: &Dfa) -> (Dfa, Vec<State>) {
    let apart: Vec<_> = dfa.states().collect();
    (renumber(dfa, &apart), breadth_first(dfa, &apart, &apart))
}

/// The coarsest partition that separates the accepting state from the others and is respected by
/// all transitions, as the class of each state. It starts from the distances to acceptance, which
/// equivalent states share: in a sequence of goals these alone tell all states apart, and without
/// them it would take as many rounds as there are goals.
fn classes(dfa: &Dfa) -> Vec<State> {
    let mut classes = distances(dfa);
    let mut count = 0;
    loop {
        let (refined, refined_count) = refine(dfa, &classes);
        if refined_count == count {
            return refined;
        }
        (classes, count) = (refined, refined_count);
    }
}

/// The least number of letters from each state to acceptance; a number that is no distance where
/// there is no way. An initial state from which every letter accepts counts as accepting, for a
/// trajectory has at least one letter; it is never met again, for the accepting state is absorbing.
fn distances(dfa: &Dfa) -> Vec<State> {
    let never = dfa.len() as State;
    let mut distances = vec![never; dfa.len()];
    let above = above(dfa);
    let mut frontier: Vec<State> = dfa.accepting.into_iter().collect();
    if dfa.accepting.is_some_and(|q| dfa.transitions[0] == Target::to_state(q)) {
        frontier.push(0);
    }
    frontier.iter().for_each(|&q| distances[q as usize] = 0);
    let mut seen = vec![false; dfa.diagram.nodes().len()];
    let mut stack = Vec::new();
    for distance in 1.. {
        stack.extend(frontier.drain(..).map(Target::to_state));
        while let Some(target) = stack.pop() {
            for &parent in above.of(target) {
                match (parent.node(), parent.state()) {
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

/// The nodes and states that lead to each node and state directly.
struct Above {
    states: usize,
    /// Where the parents of each begin, states first.
    starts: Vec<u32>,
    parents: Vec<Target>,
}

impl Above {
    fn place(states: usize, target: Target) -> usize {
        match target.node() {
            Some(node) => states + node as usize,
            None => target.state().expect("a node or a state") as usize,
        }
    }

    fn of(&self, target: Target) -> &[Target] {
        let place = Self::place(self.states, target);
        &self.parents[self.starts[place] as usize..self.starts[place + 1] as usize]
    }
}

fn above(dfa: &Dfa) -> Above {
    let states = dfa.len();
    let nodes = (0..).zip(dfa.diagram.nodes()).flat_map(|(index, node)| {
        [node.low, node.high].map(|child| (child, Target::to_node(index)))
    });
    let roots = (0..).zip(&dfa.transitions).map(|(q, &root)| (root, Target::to_state(q)));
    let pairs: Vec<_> = roots.chain(nodes).collect();
    let mut starts = vec![0; states + dfa.diagram.nodes().len() + 1];
    pairs.iter().for_each(|&(child, _)| starts[Above::place(states, child)] += 1);
    let mut total = 0;
    for start in &mut starts {
        total += *start;
        *start = total;
    }
    let mut parents = vec![Target::to_state(0); pairs.len()];
    for (child, parent) in pairs {
        let start = &mut starts[Above::place(states, child)];
        *start -= 1;
        parents[*start as usize] = parent;
    }
    Above { states, starts, parents }
}

fn refine(dfa: &Dfa, classes: &[State]) -> (Vec<State>, usize) {
    let rewritten = rewrite(&dfa.diagram, |state| classes[state as usize]).1;
    let mut known: Memo<(State, Target), State> = Memo::default();
    let refined = dfa
        .states()
        .map(|q| {
            let target =
                relocate(dfa.transitions[q as usize], &rewritten, |state| classes[state as usize]);
            let fresh = known.len() as State;
            known.get_or_insert((classes[q as usize], target), fresh)
        })
        .collect();
    (refined, known.len())
}

/// A diagram with its states renamed, reduced again, and where each of its nodes went.
fn rewrite(diagram: &Diagram, rename: impl Fn(State) -> State + Copy) -> (Diagram, Vec<Target>) {
    let mut rewritten = Diagram::default();
    let mut moved = Vec::with_capacity(diagram.nodes().len());
    for node in diagram.nodes() {
        let (low, high) = (relocate(node.low, &moved, rename), relocate(node.high, &moved, rename));
        moved.push(rewritten.node(node.proposition, low, high));
    }
    (rewritten, moved)
}

fn relocate(target: Target, moved: &[Target], rename: impl Fn(State) -> State) -> Target {
    match target.node() {
        Some(index) => moved[index as usize],
        None => Target::to_state(rename(target.state().expect("a node or a state"))),
    }
}

fn renumber(dfa: &Dfa, classes: &[State]) -> Dfa {
    let count = classes.iter().max().map_or(0, |&last| last as usize + 1);
    let mut representative = vec![0; count];
    dfa.states().rev().for_each(|q| representative[classes[q as usize] as usize] = q);
    let order = breadth_first(dfa, classes, &representative);
    let mut number = vec![0; count];
    (0..).zip(&order).for_each(|(fresh, &class)| number[class as usize] = fresh);
    let rename = |state: State| number[classes[state as usize] as usize];
    let roots = order.iter().map(|&class| dfa.transitions[representative[class as usize] as usize]);
    let (diagram, transitions) = lay_out(&dfa.diagram, roots, rename);
    let kept = |state: &State| order.contains(&classes[*state as usize]);
    let accepting = dfa.accepting.filter(kept).map(rename);
    let is_trap =
        |&q: &State| accepting != Some(q) && transitions[q as usize] == Target::to_state(q);
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
/// node that has been walked once leads to nothing new, so the walk is linear in the diagram.
fn breadth_first(dfa: &Dfa, classes: &[State], representative: &[State]) -> Vec<State> {
    let mut seen = vec![false; representative.len()];
    let mut walked = vec![false; dfa.diagram.nodes().len()];
    let mut order = vec![classes[0]];
    seen[classes[0] as usize] = true;
    let mut at = 0;
    while let Some(&class) = order.get(at) {
        at += 1;
        let mut stack = vec![dfa.transitions[representative[class as usize] as usize]];
        while let Some(target) = stack.pop() {
            if let Some(index) = target.node() {
                if !std::mem::replace(&mut walked[index as usize], true) {
                    let node = dfa.diagram.nodes()[index as usize];
                    stack.extend([node.high, node.low]);
                }
            } else if let Some(state) = target.state() {
                let to = classes[state as usize];
                if !std::mem::replace(&mut seen[to as usize], true) {
                    order.push(to);
                }
            }
        }
    }
    order
}

/// The part of a diagram that the roots need, with states renamed, in the order in which a walk
/// from the first root to the last finishes its nodes.
fn lay_out(
    diagram: &Diagram,
    roots: impl Iterator<Item = Target>,
    rename: impl Fn(State) -> State + Copy,
) -> (Diagram, Vec<Target>) {
    let mut fresh = Diagram::default();
    let mut moved = Memo::default();
    let roots = roots.map(|root| copy(diagram, root, &mut fresh, &mut moved, rename)).collect();
    (fresh, roots)
}

fn copy(
    diagram: &Diagram,
    target: Target,
    fresh: &mut Diagram,
    moved: &mut Memo<Target, Target>,
    rename: impl Fn(State) -> State + Copy,
) -> Target {
    if let Some(state) = target.state() {
        return Target::to_state(rename(state));
    }
    if let Some(known) = moved.get(target) {
        return known;
    }
    let proposition = diagram.proposition(target).expect("a node asks");
    let (low, high) = diagram.split(target, proposition);
    let low = copy(diagram, low, fresh, moved, rename);
    let high = copy(diagram, high, fresh, moved, rename);
    let copied = fresh.node(proposition, low, high);
    moved.insert(target, copied);
    copied
}
