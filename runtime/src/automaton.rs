//! Automata as data: tables that generated code holds in statics, and run-time tasks own.
//!
//! An [`Automaton`] is the minimal complete DFA of a task over the valuations of its propositions
//! (the FSA of the paper's Definition 2). It reads *every* state of a trajectory, `s_0` included,
//! has at most one accepting state, absorbing, and at most one trap.
//!
//! All data of an automaton is in [`Tables`]: flat arrays of integers, in which one table holds
//! offsets into the next. [`Edge`], [`Guard`] and [`Cube`] are views of them. The compiler writes
//! tables that are right by construction; tables from anywhere else pass through
//! `Automaton::new`, which checks them once. Reading an automaton neither allocates nor parses.

mod batch;
#[cfg(feature = "alloc")]
mod bytes;
#[cfg(feature = "alloc")]
mod check;

use core::fmt;

pub use batch::Letters;
#[cfg(feature = "alloc")]
pub use bytes::ByBytes;
#[cfg(feature = "alloc")]
pub use check::TableError;
#[cfg(feature = "alloc")]
pub(crate) use check::{length as check_length, limit_of as check_limit};

use crate::shared::Shared;

/// The data of an [`Automaton`], not checked yet.
///
/// `edges` and `guards` are offsets into the table after them: entry `i` is where item `i` begins,
/// one last entry is where the last item ends.
///
/// Flat arrays and not a structure of vectors: generated code holds them in statics, where nothing can
/// own anything, and reading one is a bounds check and a load. [`Automaton::new`] shows them all.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Tables {
    /// The names of the propositions, in order of first appearance in the source.
    pub propositions: Shared<[Shared<str>]>,
    /// The number of states, the trap included.
    pub states: u32,
    /// The accepting state, absorbing. `None`: no trajectory satisfies the task.
    pub accepting: Option<u32>,
    /// The rejecting state, absorbing. `None`: the task can never be lost.
    pub trap: Option<u32>,
    /// The transition function δ.
    pub transitions: Transitions,
    /// For each state where its edges begin in `targets`.
    pub edges: Shared<[u32]>,
    /// The state that each edge enters; ascending among the edges of one state.
    pub targets: Shared<[u32]>,
    /// For each guard where it begins in `literals`: first for each state q the guard D_φ^q of
    /// progress, then the guards ψ_{q,q'} of all edges, in their order.
    pub guards: Shared<[u32]>,
    /// All guards in DIMACS style: `3` is "proposition number 2 is true", `-3` "it is false", `0`
    /// ends a cube.
    pub literals: Shared<[i32]>,
    /// For each state the least number of moves to the accepting state; `u32::MAX` if there is no
    /// way.
    pub distance: Shared<[u32]>,
}

/// How an automaton finds the next state.
///
/// A table answers with one look-up, but needs all propositions and an entry for each of their
/// valuations. A diagram asks only those that decide the move, one after the other, and is small
/// for many propositions.
///
/// ```
/// use tltl::automaton::Transitions;
/// use tltl::tltl;
///
/// // Two propositions have 4 valuations, of which `F (a && b)` tells apart two classes.
/// let both = tltl! { |s: &[bool; 2]| F (s[0] && s[1]) };
/// let Transitions::Table { class, width, next } = &both.automaton().tables().transitions else {
///     panic!("few propositions are a table")
/// };
/// assert_eq!((class.len(), *width, next.len()), (4, 2, 2 * 2));
/// assert!(class[0b01] == class[0b10] && class[0b11] != class[0b00]);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Transitions {
    /// For few propositions: no state tells apart two valuations of one class.
    Table {
        /// The class of each valuation, `1 << propositions` of them; bit i is proposition i.
        class: Shared<[u16]>,
        /// The number of classes.
        width: u32,
        /// The next state, indexed `q * width + class`.
        next: Shared<[u32]>,
    },
    /// For many propositions: a decision diagram that all states share.
    Diagram {
        /// The nodes, children before parents: `[proposition, low, high]`. The next reference is
        /// `low` if the proposition is false, otherwise `high`. A reference below
        /// [`LEAF`](Self::LEAF) is the index of a node; any other is `LEAF + q` for a state q.
        nodes: Shared<[[u32; 3]]>,
        /// The reference at which each state starts.
        roots: Shared<[u32]>,
    },
}

impl Transitions {
    /// The least reference that is an automaton state: `LEAF + q`.
    ///
    /// Half of the references for each: neither nodes nor states ever come near 2^31. Walked by hand:
    ///
    /// ```
    /// use tltl::automaton::Transitions;
    /// use tltl::tltl;
    ///
    /// // Twelve goals, one after the other: too many valuations for a table.
    /// let tour = tltl! { |s: &[bool; 12]| s[0] T s[1] T s[2] T s[3] T s[4] T s[5] T s[6] T s[7]
    ///     T s[8] T s[9] T s[10] T s[11] };
    /// let Transitions::Diagram { nodes, roots } = &tour.automaton().tables().transitions else {
    ///     panic!("many propositions are a diagram")
    /// };
    /// let mut at = roots[0];
    /// while at < Transitions::LEAF {
    ///     at = nodes[at as usize][2]; // every proposition is true
    /// }
    /// assert_eq!(at - Transitions::LEAF, 1, "all at once is only the first of them");
    /// ```
    pub const LEAF: u32 = 1 << 31;
}

/// A conjunction of literals in DIMACS style: `3` is "proposition number 2 is true", `-3` "it is
/// false". The empty cube is true.
///
/// ```
/// use tltl::automaton::Cube;
/// use tltl::tltl;
///
/// let task = tltl! { |s: &[bool; 2]| F (s[0] && !s[1]) };
/// let cubes: Vec<Cube<'_>> = task.automaton().progress(0).cubes().collect();
/// assert_eq!(cubes, [&[1, -2]]);
/// ```
pub type Cube<'a> = &'a [i32];

/// A Boolean function of the propositions as an irredundant sum of products: a disjunction of
/// [cubes](Cube).
///
/// The form is fixed, since the size of the robustness of a guard depends on it: equal functions written
/// differently differ there, though never in sign.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Guard<'a> {
    /// The cubes, each with a 0 after it: one pass over one slice, which is nearly twice as fast as
    /// slices of slices.
    pub(crate) literals: &'a [i32],
}

impl<'a> Guard<'a> {
    /// The guard that no valuation satisfies: it has no cubes.
    pub const FALSE: Guard<'static> = Guard { literals: &[] };

    /// The cubes; the guard holds where one of them does.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// let task = tltl::tltl! { |s: &(bool, bool)| F (s.0 || !s.1) };
    /// let progress = task.automaton().progress(0);
    /// assert!(progress.cubes().eq([&[1], &[-2]]));
    /// # }
    /// ```
    #[inline]
    pub fn cubes(self) -> impl Iterator<Item = Cube<'a>> {
        let cubes = self.literals.split_inclusive(|&literal| literal == 0);
        cubes.map(|cube| &cube[..cube.len() - 1])
    }

    /// Whether the guard holds where proposition `i` is `value(i)`.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// let task = tltl::tltl! { |s: &(bool, bool)| F (s.0 || !s.1) };
    /// let progress = task.automaton().progress(0);
    /// assert!(progress.holds(|i| [false, false][i]));
    /// assert!(!progress.holds(|i| [false, true][i]));
    /// # }
    /// ```
    pub fn holds(self, mut value: impl FnMut(usize) -> bool) -> bool {
        self.cubes()
            .any(|cube| cube.iter().all(|&literal| value(proposition(literal)) == (literal > 0)))
    }
}

/// The number of the proposition that a literal is about.
#[inline]
pub(crate) const fn proposition(literal: i32) -> usize {
    literal.unsigned_abs() as usize - 1
}

impl fmt::Debug for Guard<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.cubes()).finish()
    }
}

/// One edge of an automaton.
///
/// ```
/// use tltl::automaton::Guard;
/// use tltl::tltl;
///
/// let task = tltl! { |s: &(bool, bool)| !s.0 U s.1 };
/// let automaton = task.automaton();
/// let to: Vec<u32> = automaton.edges_from(0).map(|edge| edge.to).collect();
/// assert_eq!(to, [0, 1, 2], "wait, accept, lose");
/// let guard = automaton.edge_guard(0, 2);
/// assert!(guard.cubes().eq([&[1, -2]]), "lost by the first without the second");
/// assert_eq!(automaton.edge_guard(1, 0), Guard::FALSE, "acceptance has no way back");
/// assert_eq!(automaton.edges().filter(|edge| edge.from == edge.to).count(), 3);
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge<'a> {
    /// The state that the edge leaves.
    pub from: u32,
    /// The state that the edge enters; equal to `from` for a self-loop.
    pub to: u32,
    /// The valuations under which the automaton takes the edge: ψ_{q,q'} of the paper's
    /// Definition 2.
    pub guard: Guard<'a>,
}

/// A minimal complete DFA over the valuations of named propositions.
///
/// Invariants: δ is total; the edges of a state lead to exactly the states that δ does, by rising
/// number; the accepting state and the trap have a self-loop only; `distance` is the distance. The
/// compiler numbers the states breadth-first from the initial state 0, and its guards of one state
/// are disjoint and cover all valuations that can occur.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, tltl};
///
/// // Dock, then the shelf.
/// let task = tltl! { |s: &(bool, bool)| s.0 T s.1 };
/// let automaton = task.automaton();
/// assert_eq!((automaton.states(), automaton.accepting(), automaton.trap()), (3, Some(2), None));
/// // Both at once is not one after the other.
/// assert_eq!(automaton.next(0, |_| Ok::<_, ()>(true)), Ok(1));
/// assert_eq!(automaton.distance(0), Some(2));
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Automaton {
    tables: Tables,
    /// The transition function once more, where it is small.
    shifts: Option<[u64; SMALL]>,
}

/// An automaton of up to so many states and valuations also has its transition function as shifts: a
/// number for each valuation, in which the four bits from 4q + 2 on are the state after q. A step then
/// waits for the state before it through a rotation and a mask, and not through a look-up. Rotated by
/// 4q, a number has four times the next state, so whoever keeps that rotates by it as it is.
const SMALL: usize = 16;

/// The bits of four times a state.
const PLACE: u32 = 4 * SMALL as u32 - 4;

/// The state after `q`.
#[inline(always)]
const fn shifted(shifts: &[u64; SMALL], q: u32, letter: usize) -> u32 {
    shifts[letter % SMALL].rotate_right(4 * q + 2) as u32 % SMALL as u32
}

#[cold]
#[inline(never)]
fn no_state(q: u32) -> ! {
    panic!("there is no state {q}")
}

/// The transition function as shifts.
const fn shifts(states: u32, class: &[u16], width: u32, next: &[u32]) -> Option<[u64; SMALL]> {
    if states as usize > SMALL || class.len() > SMALL {
        return None;
    }
    let (mut shifts, mut letter) = ([0; SMALL], 0);
    while letter < class.len() {
        let mut q = 0;
        while q < states {
            let to = next[q as usize * width as usize + class[letter] as usize];
            shifts[letter] |= (to as u64) << (4 * q);
            q += 1;
        }
        shifts[letter] = shifts[letter].rotate_left(2);
        letter += 1;
    }
    Some(shifts)
}

impl Automaton {
    /// The state before the first state of the trajectory is read.
    ///
    /// ```
    /// use tltl::{Acceptor, Automaton, tltl};
    ///
    /// let task = tltl! { |x: &f64| F ({ *x } > 3) };
    /// let q = task.next(Automaton::INITIAL, &5.0)?;
    /// assert!(task.is_accepting(q), "the first state is read too");
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    pub const INITIAL: u32 = 0;

    /// The automaton of tables from anywhere, checked once: every index is in range, δ is total,
    /// edges and distances are those of δ, and the two ends are absorbing. Whether the guards agree
    /// with δ is *not* checked, which takes time exponential in the propositions.
    ///
    /// Costs O(states × (nodes + classes)) time.
    ///
    /// # Errors
    /// The first table that is wrong, and where.
    ///
    /// ```
    /// use tltl::automaton::{Automaton, Tables, Transitions};
    ///
    /// // `F a`: wait in 0 for a.
    /// let tables = Tables {
    ///     propositions: vec!["a".into()].into(),
    ///     states: 2,
    ///     accepting: Some(1),
    ///     trap: None,
    ///     transitions: Transitions::Table {
    ///         class: vec![0, 1].into(),
    ///         width: 2,
    ///         next: vec![0, 1, 1, 1].into(),
    ///     },
    ///     // State 0 has edges 0 and 1, state 1 has edge 2.
    ///     edges: vec![0, 2, 3].into(),
    ///     targets: vec![0, 1, 1].into(),
    ///     // Two guards of progress, of which the second has no cube, and three of edges.
    ///     guards: vec![0, 2, 2, 4, 6, 7].into(),
    ///     literals: vec![1, 0, -1, 0, 1, 0, 0].into(),
    ///     distance: vec![1, 0].into(),
    /// };
    /// let automaton = Automaton::new(tables.clone())?;
    /// assert_eq!(automaton.next(0, |_| Ok::<_, ()>(true)), Ok(1));
    ///
    /// let error = Automaton::new(Tables { distance: vec![2, 0].into(), ..tables }).unwrap_err();
    /// assert_eq!(error.to_string(), "`distance`, entry 0: not the distance to the accepting state");
    /// # Ok::<(), tltl::automaton::TableError>(())
    /// ```
    #[cfg(feature = "alloc")]
    pub fn new(tables: Tables) -> Result<Self, TableError> {
        check::automaton(&tables)?;
        let shifts = match &tables.transitions {
            Transitions::Table { class, width, next } => shifts(tables.states, class, *width, next),
            Transitions::Diagram { .. } => None,
        };
        Ok(Self { tables, shifts })
    }

    /// For generated code, whose tables are right by construction.
    #[doc(hidden)]
    #[must_use]
    pub const fn trusted(tables: Tables) -> Self {
        let shifts = match &tables.transitions {
            Transitions::Table { class, width, next } => {
                match (class.in_static(), next.in_static()) {
                    (Some(class), Some(next)) => shifts(tables.states, class, *width, next),
                    _ => None,
                }
            }
            Transitions::Diagram { .. } => None,
        };
        Self { tables, shifts }
    }

    /// All data of the automaton.
    #[inline]
    #[must_use]
    pub const fn tables(&self) -> &Tables {
        &self.tables
    }

    /// The names of the propositions, in order of first appearance in the source.
    #[must_use]
    pub fn propositions(&self) -> &[Shared<str>] {
        &self.tables.propositions
    }

    /// The accepting state, if a trajectory can satisfy the task.
    #[must_use]
    pub const fn accepting(&self) -> Option<u32> {
        self.tables.accepting
    }

    /// The trap, if the task can be lost.
    #[must_use]
    pub const fn trap(&self) -> Option<u32> {
        self.tables.trap
    }

    /// The next state from `q` under the valuation that `holds` answers, one proposition at a time.
    ///
    /// # Errors
    /// The first error of `holds`. A [`Transitions::Diagram`] asks only for the propositions that
    /// decide the move.
    ///
    /// # Panics
    /// If `q` is not a state of this automaton.
    // Left to itself the compiler makes it a function of its own for every task, which returns its
    // result in memory: up to a tenth of a step.
    #[inline(always)]
    pub fn next<E>(
        &self,
        q: u32,
        mut holds: impl FnMut(usize) -> Result<bool, E>,
    ) -> Result<u32, E> {
        self.expect_state(q);
        self.follow(q, &mut holds)
    }

    /// The same from `q` that is a state. It never panics.
    #[inline(always)]
    pub(crate) fn follow<E>(
        &self,
        q: u32,
        mut holds: impl FnMut(usize) -> Result<bool, E>,
    ) -> Result<u32, E> {
        match &self.tables.transitions {
            Transitions::Table { .. } => {
                let mut letter = 0;
                for i in 0..self.tables.propositions.len() {
                    letter |= usize::from(holds(i)?) << i;
                }
                Ok(self.of_letter(q, letter))
            }
            Transitions::Diagram { nodes, roots } => {
                let leaf = Transitions::LEAF | q;
                let mut at = roots.get(q as usize).copied().unwrap_or(leaf);
                // What is no node is a state.
                while let Some(&[proposition, low, high]) = nodes.get(at as usize) {
                    at = if holds(proposition as usize)? { high } else { low };
                }
                Ok(at & !Transitions::LEAF)
            }
        }
    }

    /// Panics if `q` is not a state of this automaton.
    #[inline(always)]
    pub(crate) fn expect_state(&self, q: u32) {
        if q >= self.tables.states {
            no_state(q);
        }
    }

    /// Panics if one of `q` is not a state of this automaton.
    #[inline(always)]
    pub(crate) fn expect_states(&self, q: &[u32]) {
        // The highest bit of the difference tells, or that of q itself: a comparison without a sign takes
        // vectors of SSE2 several instructions.
        let last = self.tables.states - 1;
        if q.iter().fold(0, |all, &q| all | q | last.wrapping_sub(q)) >> 31 != 0 {
            q.iter().for_each(|&q| self.expect_state(q));
        }
    }

    /// Where a run is that is in state `q`: a number that [`move_on`](Self::move_on) takes.
    #[inline(always)]
    pub(crate) fn place(&self, q: u32) -> u32 {
        if self.shifts.is_some() { 4 * q } else { q }
    }

    /// The state of a place.
    #[inline(always)]
    pub(crate) fn state(&self, place: u32) -> u32 {
        if self.shifts.is_some() { place / 4 } else { place }
    }

    /// The next place of a run through a table under a valuation, of which bit i is proposition i. It
    /// never panics: what is no place leads anywhere.
    #[inline(always)]
    pub(crate) fn move_on(&self, place: u32, letter: usize) -> u32 {
        match &self.shifts {
            Some(shifts) => shifts[letter % SMALL].rotate_right(place) as u32 & PLACE,
            None => self.look_up(place, letter),
        }
    }

    /// The next state of a table from `q`, which is one, under a valuation. It never panics either.
    #[inline(always)]
    pub(crate) fn of_letter(&self, q: u32, letter: usize) -> u32 {
        match &self.shifts {
            Some(shifts) => shifted(shifts, q, letter),
            None => self.look_up(q, letter),
        }
    }

    #[inline(always)]
    fn look_up(&self, q: u32, letter: usize) -> u32 {
        match &self.tables.transitions {
            Transitions::Table { class, width, next } => {
                let class = class.get(letter).copied().unwrap_or_default();
                let entry = (q as usize).wrapping_mul(*width as usize) + usize::from(class);
                next.get(entry).copied().unwrap_or(q)
            }
            // What has a letter is a table.
            Transitions::Diagram { .. } => q,
        }
    }

    /// All edges, sorted by the states that they leave and enter.
    pub fn edges(&self) -> impl Iterator<Item = Edge<'_>> {
        (0..self.tables.states).flat_map(|q| self.edges_from(q))
    }

    /// The edges that leave `q`, self-loop included, sorted by the state that they enter.
    ///
    /// # Panics
    /// If `q` is not a state of this automaton.
    pub fn edges_from(&self, q: u32) -> impl Iterator<Item = Edge<'_>> {
        let (start, targets) = self.targets(q);
        let edge = move |(i, &to)| Edge { from: q, to, guard: self.of_edge(start + i) };
        targets.iter().enumerate().map(edge)
    }

    /// ψ_{q,to}, the guard of the edge from `q` to `to`; [`Guard::FALSE`] if there is no such edge.
    ///
    /// # Panics
    /// If `q` is not a state of this automaton.
    #[inline]
    #[must_use]
    pub fn edge_guard(&self, q: u32, to: u32) -> Guard<'_> {
        let (start, targets) = self.targets(q);
        targets.binary_search(&to).map_or(Guard::FALSE, |i| self.of_edge(start + i))
    }

    /// D_φ^q, the guard of leaving `q` for another state that is not the trap (paper, Eq. 3A3).
    ///
    /// # Panics
    /// If `q` is not a state of this automaton.
    #[inline]
    #[must_use]
    pub fn progress(&self, q: u32) -> Guard<'_> {
        self.guard(q as usize)
    }

    /// The number of the first edge of `q`, and what all its edges enter.
    #[inline]
    pub(crate) fn targets(&self, q: u32) -> (usize, &[u32]) {
        let q = q as usize;
        let (start, end) = (self.tables.edges[q] as usize, self.tables.edges[q + 1] as usize);
        (start, &self.tables.targets[start..end])
    }

    #[inline]
    fn of_edge(&self, edge: usize) -> Guard<'_> {
        self.guard(self.tables.states as usize + edge)
    }

    #[inline]
    fn guard(&self, index: usize) -> Guard<'_> {
        let Tables { guards, literals, .. } = &self.tables;
        let ends = &guards[index..index + 2];
        Guard { literals: &literals[ends[0] as usize..ends[1] as usize] }
    }
}
