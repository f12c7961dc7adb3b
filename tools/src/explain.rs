//! What a task asks for, told to a person: in words, by shortest trajectories, and state by state.
//!
//! Everything but the words of the task comes from the automaton, so it is what will be rewarded,
//! not what the author meant. A reader who finds a surprise here has found the mistake before
//! training.

mod words;

use std::fmt;

use crate::emit::sum::{Notation, Sum, label};
use crate::emit::text;
use crate::trace::{Trace, shortest};
use tltl_compiler::bdd::Bdd;
use tltl_compiler::dfa::Edge;
use tltl_compiler::dfa::{Dfa, Guards, Size, State};
use tltl_compiler::spec::Spec;

/// A task explained.
#[derive(Clone, Debug)]
pub struct Explanation {
    /// The task in plain English, a string a line; empty if the formula is too large to retell.
    pub words: Vec<String>,
    /// How big the automaton is.
    pub size: Size,
    /// The shortest satisfying trajectory, if there is one.
    pub satisfying: Option<Trace>,
    /// The shortest trajectory after which the task is lost for good, if there is one.
    pub losing: Option<Trace>,
    /// The shortest trajectory that does not satisfy the task, if there is one.
    pub unsatisfying: Option<Trace>,
    /// What each state still asks for; only the first [`MOST_STATES`].
    pub states: Vec<StateExplanation>,
    /// How one falls into the trap: the states from which, and when.
    pub falls: Vec<(State, String)>,
}

/// What an automaton state still asks for.
#[derive(Clone, Debug)]
pub struct StateExplanation {
    /// The state.
    pub state: State,
    /// Its verdict.
    pub verdict: Verdict,
    /// The moves of the trajectory to acceptance, at least.
    pub moves: Option<u32>,
    /// What must hold at some instant still to come, whatever else happens.
    pub needs: Vec<String>,
    /// The guards of a shortest way to acceptance.
    pub way: Vec<String>,
    /// What would lose the task at the next instant.
    pub avoid: Option<String>,
}

/// What a state says about the trajectory so far.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Verdict {
    /// Not yet decided.
    Open,
    /// Satisfied for good.
    Satisfied,
    /// Lost for good.
    Lost,
}

/// The most states that are explained one by one.
pub const MOST_STATES: usize = 64;

/// Explains the task that `spec` says and `dfa` is.
#[must_use]
pub fn explain(spec: &Spec, dfa: &Dfa) -> Explanation {
    let edges = dfa.edges();
    let accepts = |q: State| dfa.accepting == Some(q);
    let distances = dfa.distances();
    let falls = edges.iter().filter(|edge| dfa.trap == Some(edge.to) && !edge.is_loop());
    Explanation {
        words: words::retell(spec),
        size: dfa.size(),
        satisfying: shortest(dfa, 0, &accepts),
        losing: dfa.trap.and_then(|trap| shortest(dfa, 0, &|q| q == trap)),
        unsatisfying: shortest(dfa, 0, &|q| !accepts(q)),
        states: (dfa.states().take(MOST_STATES))
            .map(|q| state(dfa, &edges, &distances, q))
            .collect(),
        falls: falls.map(|edge| (edge.from, label(dfa, edge, Notation::Ascii))).collect(),
    }
}

fn state(dfa: &Dfa, edges: &[Edge], distances: &[Option<u32>], q: State) -> StateExplanation {
    let verdict = match q {
        _ if dfa.accepting == Some(q) => Verdict::Satisfied,
        _ if dfa.trap == Some(q) => Verdict::Lost,
        _ => Verdict::Open,
    };
    let fall = edges.iter().find(|edge| edge.from == q && dfa.trap == Some(edge.to));
    let open = verdict == Verdict::Open;
    StateExplanation {
        state: q,
        verdict,
        moves: distances[q as usize],
        needs: if open { needs(dfa, q) } else { Vec::new() },
        way: if open { way(dfa, edges, distances, q) } else { Vec::new() },
        avoid: fall.filter(|_| open).map(|edge| label(dfa, edge, Notation::Ascii)),
    }
}

/// The literals without which acceptance cannot be reached from `q`. If a proposition and its
/// negation both are, one instant cannot give them, and that is told.
fn needs(dfa: &Dfa, q: State) -> Vec<String> {
    let mut literals = Vec::new();
    for proposition in 0..dfa.propositions.len() as u32 {
        let literal = |value: bool| {
            let cubes = [vec![(proposition, value)]];
            let needed = !reaches(dfa, q, (proposition, !value));
            needed.then(|| Sum::new(&dfa.propositions, &cubes).to_string())
        };
        literals.extend(match (literal(true), literal(false)) {
            (Some(yes), Some(no)) => Some(format!("{yes} at one instant and {no} at another")),
            (one, other) => one.or(other),
        });
    }
    literals
}

/// Whether acceptance can be reached from `q` with one proposition fixed.
fn reaches(dfa: &Dfa, q: State, (proposition, value): (u32, bool)) -> bool {
    let mut seen_states = vec![false; dfa.len()];
    let mut seen_nodes = vec![false; dfa.diagram.nodes().len()];
    let mut stack = vec![Bdd::leaf(q)];
    while let Some(f) = stack.pop() {
        match (f.index(), f.value()) {
            (Some(index), _) if !std::mem::replace(&mut seen_nodes[index as usize], true) => {
                let node = dfa.diagram.nodes()[index as usize];
                match node.level == proposition {
                    true => stack.push(if value { node.high } else { node.low }),
                    false => stack.extend([node.low, node.high]),
                }
            }
            (_, Some(state)) if dfa.accepting == Some(state) => return true,
            (_, Some(state)) if !std::mem::replace(&mut seen_states[state as usize], true) => {
                stack.push(dfa.transitions[state as usize]);
            }
            _ => {}
        }
    }
    false
}

/// The guards along a shortest way from `q` to acceptance: of each the product that asks for least.
fn way(dfa: &Dfa, edges: &[Edge], distances: &[Option<u32>], mut q: State) -> Vec<String> {
    let mut guards = Vec::new();
    while let Some(left) = distances[q as usize].filter(|&left| left > 0) {
        let nearer = |edge: &&Edge| {
            edge.from == q && distances[edge.to as usize].is_some_and(|moves| moves < left)
        };
        let asks = |edge: &&Edge| edge.guard.iter().map(Vec::len).min();
        let Some(edge) = edges.iter().filter(nearer).min_by_key(asks) else { break };
        let least = edge.guard.iter().min_by_key(|cube| cube.len()).cloned();
        let cubes: Vec<_> = least.into_iter().collect();
        guards.push(Sum::new(&dfa.propositions, &cubes).to_string());
        q = edge.to;
    }
    guards
}

/// D_φ^q as text: what moves `q` on, and not into the trap.
#[must_use]
pub fn progress(dfa: &Dfa, q: State) -> String {
    let cubes = Guards::new(dfa).progress(q);
    Sum::new(&dfa.propositions, &cubes).to_string()
}

impl fmt::Display for Explanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.words.is_empty() {
            writeln!(f, "The task\n")?;
            self.words.iter().try_for_each(|line| writeln!(f, "  {line}"))?;
            writeln!(f)?;
        }
        writeln!(f, "Its automaton\n")?;
        text::sizes(self.size).lines().try_for_each(|line| writeln!(f, "  {}", line.trim_end()))?;
        writeln!(f, "\nTrajectories\n")?;
        self.traces(f)?;
        writeln!(f, "\nWhat each state still asks for\n")?;
        self.states.iter().try_for_each(|state| write!(f, "{state}"))?;
        if self.size.states > self.states.len() {
            writeln!(f, "  … and {} more", self.size.states - self.states.len())?;
        }
        self.trap(f)
    }
}

impl Explanation {
    fn traces(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.satisfying {
            Some(trace) => writeln!(f, "  shortest that satisfies the task:   {trace}")?,
            None => writeln!(f, "  no trajectory satisfies the task")?,
        }
        match (&self.losing, &self.unsatisfying) {
            (Some(trace), _) => writeln!(f, "  shortest that loses it for good:    {trace}"),
            (None, Some(trace)) => {
                writeln!(f, "  shortest that does not satisfy it:   {trace}")?;
                writeln!(f, "  none loses it for good")
            }
            (None, None) => writeln!(f, "  every trajectory satisfies it"),
        }
    }

    fn trap(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.falls.is_empty() {
            return Ok(());
        }
        writeln!(f, "\nHow the task is lost\n")?;
        self.falls.iter().try_for_each(|(q, when)| writeln!(f, "  in state {q} when {when}"))
    }
}

impl fmt::Display for StateExplanation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "  {:>3}  ", self.state)?;
        match (self.verdict, self.moves) {
            (Verdict::Satisfied, _) => return writeln!(f, "nothing: the task is satisfied"),
            (Verdict::Lost, _) => return writeln!(f, "the task is lost"),
            (Verdict::Open, None) => return writeln!(f, "the task cannot be satisfied any more"),
            (Verdict::Open, Some(_)) => writeln!(f, "quickest: {}", self.way.join(", then "))?,
        }
        if !self.needs.is_empty() {
            writeln!(f, "       cannot do without: {}", self.needs.join(", "))?;
        }
        match &self.avoid {
            Some(guard) => writeln!(f, "       lost by: {guard}"),
            None => Ok(()),
        }
    }
}
