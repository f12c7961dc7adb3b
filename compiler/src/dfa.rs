//! Deterministic automata over the valuations of propositions, with a shared decision diagram as
//! their transition function.
//!
//! A letter is a valuation: one truth value for each proposition. Over n propositions there are 2^n
//! of them, so a table would be hopeless beyond about ten; a diagram shares what the states have in
//! common.
//!
//! A [`Dfa`] may be raw (as [`translate`](crate::translate::translate) makes it) or canonical (as
//! [`minimize`](crate::minimize::minimize) makes it): complete, reachable, states numbered
//! breadth-first, letters in lexicographic order (proposition 0 first, false before true), the
//! nodes of the diagram in postorder. Two canonical automata over the same propositions are equal
//! iff their languages are.
//!
//! An automaton reads at least one letter: a trajectory has an initial state of the world. So the
//! initial state of the automaton accepts only if every first letter does.
//!
//! ```
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let source = Source::new("formula", "!water U home");
//! let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
//! let (accepting, trap) = (dfa.accepting.unwrap(), dfa.trap.unwrap());
//! // Proposition 0 is `water`, 1 is `home`.
//! assert_eq!(dfa.next(0, |proposition| proposition == 1), accepting);
//! assert_eq!(dfa.next(0, |proposition| proposition == 0), trap);
//! assert_eq!(dfa.distances(), [Some(1), Some(0), None]);
//! let edge = dfa.edges().into_iter().find(|edge| edge.to == trap).unwrap();
//! assert_eq!(edge.guard, [[(0, true), (1, false)]]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod edge;

use crate::bdd::{Bdd, Cover, Cube, Diagram, Literal, Node};
use crate::proposition::Proposition;

pub use edge::Edge;

/// A state of an automaton; the initial one is 0.
pub type State = u32;

/// A complete deterministic automaton with at most one accepting state and at most one trap, both
/// absorbing.
///
/// One accepting state suffices: a co-safe formula that is satisfied stays satisfied (Kupferman and
/// Vardi, "Model Checking of Safety Properties", 2001), so all good prefixes end in one state. For
/// the same reason one trap suffices.
///
/// Invariant: `transitions` is not empty, every leaf of it is below its length, and every level in
/// the diagram is below the number of propositions.
#[derive(Clone, Debug)]
pub struct Dfa {
    /// The propositions; bit i of a letter is proposition i.
    pub propositions: Vec<Proposition>,
    /// The nodes that the transitions of all states share. Levels are propositions, in the order in
    /// which the formula names them: formulas are mostly written in the order in which things shall
    /// happen, and later goals then share the diagrams of earlier ones. The opposite order makes
    /// nested goals cubic.
    pub diagram: Diagram,
    /// The transition function of each state; its leaves are states.
    pub transitions: Vec<Bdd>,
    /// The accepting state; `None` if no trajectory is accepted.
    pub accepting: Option<State>,
    /// The state from which acceptance cannot be reached; `None` if there is none.
    pub trap: Option<State>,
    /// The letters that can occur, as a Boolean function in `diagram`; `None` if all can. Guards
    /// are shortened by what cannot occur; transitions under such letters are arbitrary.
    pub possible: Option<Bdd>,
}

/// The two automata of a task. They are the same where arithmetic does not tie its predicates.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// // Two propositions to other tools. To arithmetic, no number is both.
/// let source = Source::new("formula", "F (x < 1 && x > 3) || F (x < 1)");
/// let automata = &compile::formula(&source, Budget::EMITTED)?.automata[0];
/// assert!(automata.propositional.possible.is_none());
/// let possible = automata.dfa.possible.expect("not every letter can occur");
/// assert_eq!(automata.dfa.diagram.evaluate(possible, &|_| true), 0);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Automata {
    /// Minimal with all predicates taken for free propositions: the automaton that other tools
    /// compute from the formula.
    pub propositional: Dfa,
    /// Minimal over the letters that can occur: the automaton that is emitted.
    pub dfa: Dfa,
}

/// The size of an automaton, under the usual conventions: parallel edges between two states count
/// as one.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "!water U home");
/// let size = compile::formula(&source, Budget::EMITTED)?.automata[0].dfa.size();
/// assert_eq!((size.states, size.edges, size.self_loops, size.into_trap), (3, 2, 3, 1));
/// assert!(size.trap, "2 states and 1 edge are left without it");
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// States, the trap included.
    pub states: usize,
    /// Distinct pairs (q, q') with q ≠ q', edges into the trap included.
    pub edges: usize,
    /// Distinct pairs (q, q), that of the trap included.
    pub self_loops: usize,
    /// Edges of `edges` that lead into the trap.
    pub into_trap: usize,
    /// Whether there is a trap.
    pub trap: bool,
}

impl Dfa {
    /// The number of states, the trap included.
    #[must_use]
    pub fn len(&self) -> usize {
        self.transitions.len()
    }

    /// Whether there is no state; never so for an automaton that came from a formula.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.transitions.is_empty()
    }

    /// All states.
    pub fn states(&self) -> impl DoubleEndedIterator<Item = State> + use<> {
        0..self.transitions.len() as State
    }

    /// The next state from `q` under the letter that `holds` gives, one proposition at a time; only
    /// those that matter in `q` are asked.
    ///
    /// ```
    /// # use tltl_compiler::{compile, source::Source, translate::Budget};
    /// let source = Source::new("formula", "a T b");
    /// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
    /// // Both at once is the first step only.
    /// let trace = [[true, true], [false, false], [false, true]];
    /// let last = trace.iter().fold(0, |q, letter| dfa.next(q, |proposition| letter[proposition as usize]));
    /// assert_eq!(Some(last), dfa.accepting);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    pub fn next(&self, q: State, holds: impl Fn(u32) -> bool) -> State {
        self.diagram.evaluate(self.transitions[q as usize], &holds)
    }

    /// The states that `q` can move to, itself included where it can stay; by rising number.
    ///
    /// ```
    /// # use tltl_compiler::{compile, source::Source, translate::Budget};
    /// let source = Source::new("formula", "!water U home");
    /// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
    /// assert_eq!(dfa.successors(0), [0, 1, 2]);
    /// let accepting = dfa.accepting.unwrap();
    /// assert_eq!(dfa.successors(accepting), [accepting]);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn successors(&self, q: State) -> Vec<State> {
        let mut found = self.diagram.leaves(self.transitions[q as usize]);
        found.sort_unstable();
        found
    }

    /// The size of the automaton.
    #[must_use]
    pub fn size(&self) -> Size {
        self.survey(usize::MAX, &mut |_| {})
    }

    /// The [size](Self::size) of the automaton. `again` gets each node and each leaf that some
    /// state reaches in more than one way, except those that it reaches only through another of
    /// them; it may get one several times. Counting ends at the first state with which there are
    /// more than `most` edges.
    ///
    /// ```
    /// # use tltl_compiler::{bdd::Bdd, compile, source::Source, translate::Budget};
    /// let source = Source::new("formula", "F (a && b)");
    /// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
    /// let mut again = Vec::new();
    /// assert_eq!(dfa.survey(usize::MAX, &mut |f| again.push(f)), dfa.size());
    /// // State 0 stays where it is without `a`, and with `a` but without `b`.
    /// assert_eq!(again, [Bdd::leaf(0)]);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    pub fn survey(&self, most: usize, again: &mut dyn FnMut(Bdd)) -> Size {
        let mut size = Size {
            states: self.len(),
            edges: 0,
            self_loops: 0,
            into_trap: 0,
            trap: self.trap.is_some(),
        };
        let mut edge = |q, to| {
            size.self_loops += usize::from(to == q);
            size.edges += usize::from(to != q);
            size.into_trap += usize::from(to != q && self.trap == Some(to));
            size.edges + size.self_loops <= most
        };
        self.each_edge(&mut edge, again);
        size
    }

    /// Visits each pair of a state and a successor once, states rising, until `edge` says after the
    /// last one of a state that it is enough, and hands what the walk of one state meets once more
    /// to `again`. One mark for each node and each state serves all
    /// walks: some automata have ten thousand times more edges than nodes.
    fn each_edge(&self, edge: &mut dyn FnMut(State, State) -> bool, again: &mut dyn FnMut(Bdd)) {
        let mut passed = vec![State::MAX; self.diagram.nodes().len()];
        let mut entered = vec![State::MAX; self.len()];
        let nodes = self.diagram.nodes();
        let (mut stack, mut more) = (Vec::new(), true);
        for q in self.states() {
            stack.push(self.transitions[q as usize]);
            while let Some(f) = stack.pop() {
                let (marks, at) = match f.value() {
                    Some(to) => (&mut entered, to as usize),
                    None => (&mut passed, f.code() as usize),
                };
                if std::mem::replace(&mut marks[at], q) == q {
                    again(f);
                } else if let Some(to) = f.value() {
                    more = edge(q, to);
                } else {
                    let Node { low, high, .. } = nodes[at];
                    stack.extend([high, low]);
                }
            }
            if !more {
                break;
            }
        }
    }

    /// For each state the least number of transitions to the accepting state; `None` if there is no
    /// way. Breadth-first and backwards; linear in the number of edges.
    #[must_use]
    pub fn distances(&self) -> Vec<Option<u32>> {
        let mut predecessors = vec![Vec::new(); self.len()];
        let mut edge = |q, to: State| {
            predecessors[to as usize].push(q);
            true
        };
        self.each_edge(&mut edge, &mut |_| {});
        let mut distances = vec![None; self.len()];
        let mut queue: std::collections::VecDeque<_> = self.accepting.into_iter().collect();
        queue.iter().for_each(|&q| distances[q as usize] = Some(0));
        while let Some(q) = queue.pop_front() {
            let further = distances[q as usize].map(|d| d + 1);
            for &p in &predecessors[q as usize] {
                if distances[p as usize].is_none() {
                    distances[p as usize] = further;
                    queue.push_back(p);
                }
            }
        }
        distances
    }
}

/// The guards of an automaton, each as an irredundant sum of products.
///
/// Making one computes for all states at once under which letters they move where, as sums that
/// share their parts ([`Diagram::leaf_covers`]); none is written out before it is asked for.
/// Letters that cannot occur may be in a guard or not, whichever is shorter.
///
/// ```
/// use tltl_compiler::{compile, dfa::Guards, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "F (a && F b)");
/// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
/// let mut guards = Guards::new(dfa);
/// // From the initial state: `a` alone is progress, `a` with `b` too.
/// assert_eq!(guards.progress(0), [[(0, true)]]);
/// assert!(guards.are_below(1));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
pub struct Guards<'a> {
    dfa: &'a Dfa,
    /// Boolean functions of the propositions.
    diagram: Diagram,
    /// The letters that can occur, in `diagram`.
    possible: Bdd,
    /// For each state its successors, rising, and the letters that lead there. Computed for all
    /// states in one pass, because states share most of their transition functions.
    moves: Vec<Vec<(State, Cover)>>,
}

impl<'a> Guards<'a> {
    /// The guards of `dfa`. Costs the number of pairs of a node and a state that it leads to.
    #[must_use]
    pub fn new(dfa: &'a Dfa) -> Self {
        Self::into_some(dfa, dfa.possible, &|_| true)
    }

    /// The guards of the edges into some states only, where `possible` holds the letters that can
    /// occur. Costs the number of pairs of a node and such a state that it leads to.
    #[must_use]
    pub fn into_some(
        dfa: &'a Dfa,
        possible: Option<Bdd>,
        is_wanted: &dyn Fn(State) -> bool,
    ) -> Self {
        let mut diagram = Diagram::default();
        let possible = possible.map_or(Bdd::TRUE, |f| diagram.import(&dfa.diagram, f));
        let moves = dfa.diagram.leaf_covers(&dfa.transitions, is_wanted, &mut diagram);
        Self { dfa, diagram, possible, moves }
    }

    /// The edges that leave `q`, its self-loop included, by rising states, each with its guard
    /// ψ_{q,q'}. An edge that only impossible letters take is left out.
    pub fn edges(&mut self, q: State) -> Vec<(State, Cover)> {
        let mut edges = self.moves[q as usize].clone();
        if self.possible != Bdd::TRUE {
            edges.iter_mut().for_each(|(_, guard)| *guard = self.guard(*guard));
            edges.retain(|&(_, guard)| guard != Cover::FALSE);
        }
        edges
    }

    /// The products of a guard; see [`Diagram::cubes`].
    #[must_use]
    pub fn cubes(&self, guard: Cover) -> Vec<Cube> {
        self.diagram.cubes(guard)
    }

    /// Visits the products of a guard, without an allocation for each.
    pub fn visit(&self, guard: Cover, visit: &mut dyn FnMut(&[Literal])) {
        self.diagram.visit(guard, visit);
    }

    /// ψ_{q,to}: the letters under which `q` moves to `to`, as a sum of products. Literals are
    /// `(proposition, value)`, by rising proposition; no products if there is no such edge.
    ///
    /// ```
    /// # use tltl_compiler::{compile, dfa::Guards, source::Source, translate::Budget};
    /// let source = Source::new("formula", "!water U home");
    /// let dfa = &compile::formula(&source, Budget::EMITTED)?.automata[0].dfa;
    /// let mut guards = Guards::new(dfa);
    /// // To the trap: in the water, and not at home.
    /// assert_eq!(guards.edge(0, dfa.trap.unwrap()), [[(0, true), (1, false)]]);
    /// assert!(guards.edge(dfa.trap.unwrap(), 0).is_empty());
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    pub fn edge(&mut self, q: State, to: State) -> Vec<Cube> {
        let guard = self.when(q, to);
        let guard = self.guard(guard);
        self.cubes(guard)
    }

    /// D_φ^q: the letters under which `q` moves to another state that is not the trap (paper, Eq.
    /// 3A3).
    pub fn progress(&mut self, q: State) -> Vec<Cube> {
        let guard = self.progresses(q);
        self.cubes(guard)
    }

    /// The first product of the guard of an edge that no possible letter takes: a demand that no
    /// state meets. `None` if one does, or if the guard has more than 4,096 products, which nobody
    /// would read.
    pub(crate) fn impossible(&mut self, q: State, to: State) -> Option<Cube> {
        let when = self.when(q, to);
        let is_impossible = self.guard(when) == Cover::FALSE;
        let is_short = self.diagram.products(when) <= 1 << 12;
        let mut cubes = if is_impossible && is_short { self.cubes(when) } else { Vec::new() };
        cubes.drain(..).next()
    }

    /// Whether no guard has more than `most` products. Counts them without writing one out.
    pub fn are_below(&mut self, most: usize) -> bool {
        self.dfa.states().all(|q| {
            let mut guards = self.edges(q);
            // The guard of progress is written out too, and can be larger than those of its edges.
            guards.push((q, self.progresses(q)));
            guards.iter().all(|&(_, guard)| self.diagram.products(guard) <= most)
        })
    }

    /// The number of products of a guard, saturating; see [`Diagram::products`].
    #[must_use]
    pub fn products(&self, guard: Cover) -> usize {
        self.diagram.products(guard)
    }

    /// The letters under which `q` moves to `to`; none if it does not.
    fn when(&self, q: State, to: State) -> Cover {
        let moves = &self.moves[q as usize];
        let place = moves.binary_search_by_key(&to, |&(state, _)| state);
        place.map_or(Cover::FALSE, |place| moves[place].1)
    }

    /// The letters under which `q` moves to another state that is not the trap, as a guard.
    fn progresses(&mut self, q: State) -> Cover {
        let stays = self.when(q, q);
        let falls = self.dfa.trap.map_or(Cover::FALSE, |trap| self.when(q, trap));
        let (stays, falls) = (self.diagram.function(stays), self.diagram.function(falls));
        let rests = self.diagram.or(stays, falls);
        let moves = self.diagram.not(rests);
        self.shortest(moves)
    }

    /// The letters of a sum as a guard.
    fn guard(&mut self, when: Cover) -> Cover {
        if self.possible == Bdd::TRUE {
            return when;
        }
        let when = self.diagram.function(when);
        self.shortest(when)
    }

    /// A guard for these letters: it must cover those of them that can occur, and may cover all
    /// letters that cannot.
    fn shortest(&mut self, when: Bdd) -> Cover {
        let impossible = self.diagram.not(self.possible);
        let lower = self.diagram.and(when, self.possible);
        let upper = self.diagram.or(when, impossible);
        self.diagram.cover(lower, upper)
    }
}
