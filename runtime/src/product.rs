//! The product of tasks at run time (paper, Definition 4), itself a [`Monitor`].
//!
//! A product turns several tasks into one, for which skills that were learned for the tasks are
//! composed. Composition has to know in which state each task is, so the states of a product are
//! *raw*: the tuples of the tasks' states that can be reached, not minimised, except that all tuples
//! that lose the product are one trap and all that accept it are one state.
//!
//! The tasks are treated as independent: the product has an edge for every combination of edges. A
//! product of tasks that share a predicate can so have edges that no state of the world takes, which
//! is sound (nothing is missed) and at worst larger. The minimal automaton of several formulas is
//! the compiler's work: write them as one formula.
//!
//! Tuples are found once, when the product is made: O(states × edges of a state × operands) time.
//! A move then reads the state with every operand and looks up the tuple.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use crate::monitor::{Acceptor, Monitor};
use crate::robustness;
use crate::shared::Shared;
use crate::task::{Error, Formula};

/// An operand of a product: any task, by reference. It is `Sync`, so that the product can be shared
/// between threads.
pub type Operand<'a, S> = &'a (dyn Monitor<S> + Sync + 'a);

/// How the operands make one task.
///
/// ```
/// use tltl::product::{Operand, Operator, Product};
/// use tltl::{Acceptor, Monitor, tltl};
///
/// let (a, b) = (tltl! { |x: &i32| F ({ *x } == 1) }, tltl! { |x: &i32| F ({ *x } == 2) });
/// let operands: [Operand<'_, i32>; 2] = [&a, &b];
/// let satisfied = |operator, walk: &[i32]| {
///     let product = Product::new(operator, &operands);
///     let q = walk.iter().try_fold(0, |q, x| product.next(q, x))?;
///     Ok::<bool, tltl::task::Error>(product.is_accepting(q))
/// };
/// assert!(satisfied(Operator::Conjunction, &[2, 1])? && !satisfied(Operator::Conjunction, &[2])?);
/// assert!(satisfied(Operator::Disjunction, &[2])?);
/// assert!(satisfied(Operator::Sequence, &[1, 2])? && !satisfied(Operator::Sequence, &[2, 1])?);
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// All of them.
    Conjunction,
    /// One of them.
    Disjunction,
    /// One after the other: the shortest prefix that satisfies the first operand ends at some s_k,
    /// and the trajectory from s_{k+1} on has to satisfy the rest. This is the task of running one
    /// skill until it is done, then the next.
    ///
    /// Of `F a` and `F b` it is `a T b`. It is not `(F a) T (F b)`, which b alone satisfies if a
    /// comes later: `T` asks when a formula *holds*, a sequence when it is *done*.
    Sequence,
}

impl Operator {
    /// What stands between two operands; `;` is what programs write between two steps.
    #[inline]
    pub(crate) const fn symbol(self) -> &'static str {
        match self {
            Self::Conjunction => " && ",
            Self::Disjunction => " || ",
            Self::Sequence => "; ",
        }
    }

    /// What a product of so many operands makes of how each of them has ended. `running` is the operand of
    /// a sequence that has just moved, `None` before the first state is read.
    ///
    /// A sequence of several skips no operand before the first state is read, also where that is satisfied
    /// by every state: each operand has a part of the trajectory of its own, of one state at least.
    #[inline]
    pub(crate) fn land(
        self,
        operands: usize,
        running: Option<usize>,
        accepting: impl Fn(usize) -> bool,
        lost: impl Fn(usize) -> bool,
    ) -> Landing {
        let mut all = 0..operands;
        match self {
            Self::Conjunction if all.clone().any(&lost) => Landing::Lost,
            Self::Conjunction if all.all(&accepting) => Landing::Accepted,
            Self::Disjunction if all.clone().any(&accepting) => Landing::Accepted,
            Self::Disjunction if all.all(&lost) => Landing::Lost,
            Self::Sequence => match running {
                None if operands == 1 && accepting(0) => Landing::Accepted,
                _ if all.any(&lost) => Landing::Lost,
                Some(i) if accepting(i) && i + 1 == operands => Landing::Accepted,
                Some(i) => Landing::To(i + usize::from(accepting(i))),
                None => Landing::To(0),
            },
            _ => Landing::To(0),
        }
    }

    /// Whether operand `i` reads states while `running` runs.
    #[inline]
    pub(crate) fn moves(self, i: usize, running: usize) -> bool {
        self != Self::Sequence || i == running
    }
}

/// A state of the product: the operand of a sequence that is running, and the operands' states as one
/// number. `usize::MAX` stands for no operand: the key of an end, which no other key equals.
///
/// The tuple as one number makes the look-up of a step a comparison of two words instead of one of
/// two lists; 2^128 tuples are more than can be explored.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    running: usize,
    code: u128,
}

/// Where a move of a product leads: to an end, or on with some operand running.
pub(crate) enum Landing {
    Accepted,
    Lost,
    To(usize),
}

/// How big a product is, under the usual conventions.
///
/// Papers count states with or without the trap, and edges with or without self-loops; all four can
/// be had from these numbers.
///
/// ```
/// use tltl::product::{Operand, Product, Size};
/// use tltl::tltl;
///
/// let careful = tltl! { |x: &i32| ({ *x } != 0) U ({ *x } == 1) };
/// let both = tltl! { |x: &i32| F ({ *x } == 2) && F ({ *x } == 3) };
/// let operands: [Operand<'_, i32>; 2] = [&careful, &both];
/// let Size { states, edges, self_loops, into_trap, trap } = Product::conjunction(&operands).size();
/// assert_eq!((states, trap), (9, true), "8 without the trap");
/// assert_eq!(edges - into_trap, 16, "without self-loops and without the trap");
/// assert_eq!(self_loops, 9);
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

/// A product of any number of tasks over the same states.
///
/// States are numbered breadth-first from the initial one, 0. At most one is accepting and at most
/// one a trap; both have a self-loop only.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::product::{Operand, Product};
/// use tltl::{Acceptor, Monitor, tltl};
///
/// struct Cell { coffee: bool, mail: bool, stairs: bool }
/// let coffee = tltl! { |s: &Cell| F s.coffee };
/// let mail = tltl! { |s: &Cell| !s.stairs U s.mail };
/// let operands: [Operand<'_, Cell>; 2] = [&coffee, &mail];
/// let both = Product::conjunction(&operands);
/// assert_eq!(both.formula().text(), "(F s.coffee) && (!s.stairs U s.mail)");
///
/// let q = both.next(0, &Cell { coffee: false, mail: true, stairs: false })?;
/// assert_eq!(both.components(q), [0, 1], "the mail is done");
/// assert!(both.is_accepting(both.next(q, &Cell { coffee: true, mail: false, stairs: true })?));
/// # }
/// # Ok::<(), tltl::task::Error>(())
/// ```
pub struct Product<'a, S: ?Sized> {
    operator: Operator,
    name: String,
    formula: Formula,
    operands: Vec<Operand<'a, S>>,
    /// The weight of each operand's state in the code of a tuple.
    strides: Vec<u128>,
    /// The state of each key, and the other way round.
    index: BTreeMap<Key, u32>,
    keys: Vec<Key>,
    /// The operands' states at each state, one after the other.
    components: Vec<u32>,
    /// Where the edges of each state begin in `successors`, and where the last end.
    first: Vec<u32>,
    successors: Vec<u32>,
    distance: Vec<Option<u32>>,
    accepting: Option<u32>,
    trap: Option<u32>,
}

impl<S: ?Sized> fmt::Debug for Product<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut product = f.debug_struct("Product");
        product.field("operator", &self.operator).field("name", &self.name);
        product.field("states", &self.keys.len()).finish_non_exhaustive()
    }
}

impl<'a, S: ?Sized> Product<'a, S> {
    /// The task of satisfying all `operands`.
    ///
    /// # Panics
    /// If there are no operands, or their state counts multiply to more than 2^128.
    #[must_use]
    pub fn conjunction(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Conjunction, operands)
    }

    /// The task of satisfying one of `operands`.
    ///
    /// An operand that is lost is out, and the others go on: the product is lost with the last of them.
    ///
    /// ```
    /// use tltl::product::{Operand, Product};
    /// use tltl::{Acceptor, Monitor, tltl};
    ///
    /// let door = tltl! { |x: &i32| ({ *x } != 9) U ({ *x } == 1) };
    /// let gate = tltl! { |x: &i32| F ({ *x } == 2) };
    /// let operands: [Operand<'_, i32>; 2] = [&door, &gate];
    /// let either = Product::disjunction(&operands);
    /// let q = either.next(0, &9)?;
    /// assert!(door.is_trap(either.components(q)[0]) && !either.is_trap(q), "the gate is left");
    /// assert!(either.is_accepting(either.next(q, &2)?));
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn disjunction(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Disjunction, operands)
    }

    /// The task of satisfying `operands` one after the other; see [`Operator::Sequence`].
    ///
    /// ```
    /// use tltl::product::{Operand, Product};
    /// use tltl::{Acceptor, Monitor, tltl};
    ///
    /// let fetch = tltl! { |x: &i32| F ({ *x } == 7) };
    /// let bring = tltl! { |x: &i32| F ({ *x } == 0) };
    /// let operands: [Operand<'_, i32>; 2] = [&fetch, &bring];
    /// let errand = Product::sequence(&operands);
    /// let mut q = 0;
    /// let running = [0, 3, 7, 4].map(|x| {
    ///     q = errand.next(q, &x).unwrap();
    ///     errand.running(q)
    /// });
    /// assert_eq!(running, [0, 0, 1, 1], "the 0 at the start does not count: nothing was fetched");
    /// assert!(errand.is_accepting(errand.next(q, &0)?));
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn sequence(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Sequence, operands)
    }

    /// The product of `operands` under `operator`.
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn new(operator: Operator, operands: &[Operand<'a, S>]) -> Self {
        assert!(!operands.is_empty(), "a product needs operands");
        let names: Vec<_> = operands.iter().map(|operand| operand.name()).collect();
        let texts = operands.iter().map(|operand| format!("({})", operand.formula().text()));
        let text = texts.collect::<Vec<_>>().join(operator.symbol());
        let mut product = Self {
            operator,
            name: names.join(operator.symbol()),
            formula: Formula::trusted(text.into(), Shared::from_static(&[])),
            operands: operands.to_vec(),
            strides: strides(operands),
            index: BTreeMap::new(),
            keys: Vec::new(),
            components: Vec::new(),
            first: alloc::vec![0],
            successors: Vec::new(),
            distance: Vec::new(),
            accepting: None,
            trap: None,
        };
        product.explore();
        product.distance = product.distances();
        product
    }

    /// How the operands make one task.
    #[must_use]
    pub const fn operator(&self) -> Operator {
        self.operator
    }

    /// The operands.
    #[must_use]
    pub fn operands(&self) -> &[Operand<'a, S>] {
        &self.operands
    }

    /// The state of each operand at `q`; for the accepting state and the trap, those of the tuple
    /// that was found first. An operand of a sequence that does not run yet is in its state 0.
    ///
    /// # Panics
    /// If `q` is not a state of the product.
    #[must_use]
    pub fn components(&self, q: u32) -> &[u32] {
        let n = self.operands.len();
        &self.components[q as usize * n..][..n]
    }

    /// Which operand of a sequence runs at `q`; 0 for the other operators.
    ///
    /// # Panics
    /// If `q` is not a state of the product.
    #[must_use]
    pub fn running(&self, q: u32) -> usize {
        self.keys[q as usize].running
    }

    /// The targets of the edges that leave `q`, self-loop included, ascending.
    ///
    /// # Panics
    /// If `q` is not a state of the product.
    #[must_use]
    pub fn edges(&self, q: u32) -> &[u32] {
        &self.successors[self.first[q as usize] as usize..self.first[q as usize + 1] as usize]
    }

    /// How big the product is.
    #[must_use]
    pub fn size(&self) -> Size {
        let (states, trap) = (self.keys.len(), self.trap.is_some());
        let mut size = Size { states, edges: 0, self_loops: 0, into_trap: 0, trap };
        for q in 0..states as u32 {
            for &to in self.edges(q) {
                size.self_loops += usize::from(to == q);
                size.edges += usize::from(to != q);
                size.into_trap += usize::from(to != q && self.trap == Some(to));
            }
        }
        size
    }

    /// Visits the reachable tuples breadth-first and lists their edges: `keys` is the queue as well.
    fn explore(&mut self) {
        let start = self.judge(&alloc::vec![0; self.operands.len()], None);
        self.number(Key { running: 0, code: 0 }, &alloc::vec![0; self.operands.len()]);
        match start {
            Landing::Accepted => self.accepting = Some(0),
            Landing::Lost => self.trap = Some(0),
            Landing::To(_) => {}
        }
        let mut q = 0;
        while q < self.keys.len() {
            let mut targets = self.targets(q as u32);
            // Several tuples end in the one accepting state or the one trap.
            targets.sort_unstable();
            targets.dedup();
            self.successors.extend(targets);
            self.first.push(self.successors.len() as u32);
            q += 1;
        }
    }

    /// The targets of all combinations of the operands' edges from `q`.
    ///
    /// Combinations are taken as if every one could occur: the operands' predicates are not compared.
    fn targets(&mut self, q: u32) -> Vec<u32> {
        if self.is_end(q) {
            return alloc::vec![q];
        }
        let running = self.keys[q as usize].running;
        let mut tuples = alloc::vec![Vec::new()];
        for (i, &at) in self.components(q).iter().enumerate() {
            let mut edges = Vec::new();
            if self.operator.moves(i, running) {
                self.operands[i].successors(at, &mut |to| edges.push(to));
            } else {
                edges.push(at);
            }
            tuples = combinations(&tuples, &edges);
        }
        tuples.into_iter().map(|tuple| self.state(tuple, running)).collect()
    }

    /// The number of the state that the operands' states make, found or new.
    fn state(&mut self, tuple: Vec<u32>, running: usize) -> u32 {
        let code = self.code(&tuple);
        match self.judge(&tuple, Some(running)) {
            Landing::To(running) => self.number(Key { running, code }, &tuple),
            Landing::Accepted => self.accepting.unwrap_or_else(|| {
                let q = self.number(Key { running: usize::MAX, code }, &tuple);
                *self.accepting.insert(q)
            }),
            Landing::Lost => self.trap.unwrap_or_else(|| {
                let q = self.number(Key { running: usize::MAX, code }, &tuple);
                *self.trap.insert(q)
            }),
        }
    }

    /// The number of a key, the next one if the key is new.
    fn number(&mut self, key: Key, tuple: &[u32]) -> u32 {
        let next = self.keys.len() as u32;
        let q = *self.index.entry(key).or_insert(next);
        if q == next {
            self.keys.push(key);
            self.components.extend_from_slice(tuple);
        }
        q
    }

    /// A tuple as one number.
    fn code(&self, tuple: &[u32]) -> u128 {
        tuple.iter().zip(&self.strides).map(|(&q, stride)| u128::from(q) * stride).sum()
    }

    /// What the product makes of the operands' states.
    fn judge(&self, tuple: &[u32], running: Option<usize>) -> Landing {
        let accepting = |i: usize| self.operands[i].is_accepting(tuple[i]);
        let lost = |i: usize| self.operands[i].is_trap(tuple[i]);
        self.operator.land(tuple.len(), running, accepting, lost)
    }

    fn is_end(&self, q: u32) -> bool {
        self.accepting == Some(q) || self.trap == Some(q)
    }

    /// The least number of moves to the accepting state, for all states. Rounds until nothing
    /// changes, from the last state back: breadth-first numbers mostly rise towards acceptance, so
    /// a few rounds are enough.
    fn distances(&self) -> Vec<Option<u32>> {
        let mut distance = alloc::vec![None; self.keys.len()];
        let Some(accepting) = self.accepting else { return distance };
        distance[accepting as usize] = Some(0);
        let mut changed = true;
        while changed {
            changed = false;
            for q in (0..self.keys.len()).rev() {
                let next = self.edges(q as u32).iter().filter_map(|&to| distance[to as usize]);
                let through = next.min().map(|nearest| nearest + 1);
                if through.is_some() && distance[q].is_none_or(|known| through < Some(known)) {
                    (distance[q], changed) = (through, true);
                }
            }
        }
        distance
    }

    /// Robustness of losing operand `i` at `s`, ρ(s, τ_i); +∞ if it is lost already.
    fn losing(&self, i: usize, q: u32, s: &S) -> Result<f64, Error> {
        let at = self.components(q)[i];
        let operand = self.operands[i];
        if operand.is_trap(at) { Ok(f64::INFINITY) } else { operand.trap_robustness(at, s) }
    }

    /// Robustness of losing each operand.
    fn losses(&self, q: u32, s: &S) -> impl Iterator<Item = Result<f64, Error>> {
        (0..self.operands.len()).map(move |i| self.losing(i, q, s))
    }

    /// Robustness of progress of each operand.
    fn progresses(&self, q: u32, s: &S) -> impl Iterator<Item = Result<f64, Error>> {
        let operands = self.operands.iter().zip(self.components(q));
        operands.map(move |(operand, &at)| operand.progress_robustness(at, s))
    }

    /// Robustness of progress of a disjunction: an operand moves on, or it is lost while another is
    /// not.
    fn progress_of_any(&self, q: u32, s: &S) -> Result<f64, Error> {
        let mut best = f64::NEG_INFINITY;
        for (i, progress) in self.progresses(q, s).enumerate() {
            // To be lost already is not a move.
            if !self.operands[i].is_trap(self.components(q)[i]) {
                let lost = self.losing(i, q, s)?.min(self.other_alive(i, q, s)?);
                best = best.max(progress?.max(lost));
            }
        }
        Ok(best)
    }

    /// Greatest of −ρ(s, τ_j) over the operands other than `i`: one of them is not lost.
    fn other_alive(&self, i: usize, q: u32, s: &S) -> Result<f64, Error> {
        let mut losses = self.losses(q, s).enumerate().filter(|(j, _)| *j != i);
        losses.try_fold(f64::NEG_INFINITY, |greatest, (_, lost)| Ok(greatest.max(-lost?)))
    }
}

/// Every tuple of `tuples` continued by every one of `edges`.
#[inline]
fn combinations(tuples: &[Vec<u32>], edges: &[u32]) -> Vec<Vec<u32>> {
    let mut longer = Vec::with_capacity(tuples.len() * edges.len());
    for tuple in tuples {
        for &to in edges {
            let mut tuple = tuple.clone();
            tuple.push(to);
            longer.push(tuple);
        }
    }
    longer
}

/// The weights of the operands' states in a number of mixed radix.
fn strides<S: ?Sized>(operands: &[Operand<'_, S>]) -> Vec<u128> {
    let mut stride: u128 = 1;
    let mut next = |operand: &Operand<'_, S>| {
        let this = stride;
        let states = u128::from(operand.states());
        stride = stride.checked_mul(states).expect("fewer than 2^128 tuples of states");
        this
    };
    operands.iter().map(&mut next).collect()
}

impl<S: ?Sized> Acceptor for Product<'_, S> {
    fn states(&self) -> u32 {
        self.keys.len() as u32
    }

    fn is_accepting(&self, q: u32) -> bool {
        self.accepting == Some(q)
    }

    fn is_trap(&self, q: u32) -> bool {
        self.trap == Some(q)
    }

    fn distance(&self, q: u32) -> Option<u32> {
        self.distance[q as usize]
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.edges(q).iter().for_each(|&to| visit(to));
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn formula(&self) -> &Formula {
        &self.formula
    }
}

impl<S: ?Sized> Monitor<S> for Product<'_, S> {
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        if self.is_end(q) {
            return Ok(q);
        }
        let running = self.keys[q as usize].running;
        let mut tuple = self.components(q).to_vec();
        for (i, at) in tuple.iter_mut().enumerate() {
            if self.operator.moves(i, running) {
                *at = self.operands[i].next(*at, s)?;
            }
        }
        Ok(match self.judge(&tuple, Some(running)) {
            Landing::To(running) => self.index[&Key { running, code: self.code(&tuple) }],
            Landing::Accepted => self.accepting.expect("acceptance was reachable"),
            Landing::Lost => self.trap.expect("the trap was reachable"),
        })
    }

    /// For a conjunction (D₁ ∧ ¬τ₂) ∨ (D₂ ∧ ¬τ₁), where τᵢ is the guard into trap i: progress of
    /// one operand that loses none of the others.
    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_end(q) {
            return Ok(f64::NEG_INFINITY);
        }
        match self.operator {
            Operator::Conjunction => {
                robustness::progress_of_all(self.losses(q, s), self.progresses(q, s))
            }
            Operator::Disjunction => self.progress_of_any(q, s),
            Operator::Sequence => {
                let running = self.running(q);
                self.operands[running].progress_robustness(self.components(q)[running], s)
            }
        }
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_end(q) {
            return Ok(f64::NEG_INFINITY);
        }
        let mut losses = self.losses(q, s);
        match self.operator {
            Operator::Conjunction => {
                losses.try_fold(f64::NEG_INFINITY, |most, lost| Ok(most.max(lost?)))
            }
            Operator::Disjunction => {
                losses.try_fold(f64::INFINITY, |least, lost| Ok(least.min(lost?)))
            }
            Operator::Sequence => self.losing(self.running(q), q, s),
        }
    }

    /// Min over the operands of a conjunction, max over those of a disjunction. In a sequence each
    /// operand is judged on its own part of the trajectory, and the least counts. So, unlike that of a
    /// formula, it may fall while the trajectory grows: where one operand hands over to the next.
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        let fold = match self.operator {
            Operator::Sequence => return sequence_robustness(&self.operands, trajectory),
            Operator::Conjunction => f64::min,
            Operator::Disjunction => f64::max,
        };
        let mut all = self.operands.iter().map(|o| o.trajectory_robustness(trajectory));
        let first = all.next().unwrap_or(Ok(f64::NEG_INFINITY))?;
        all.try_fold(first, |sum, next| Ok(fold(sum, next?)))
    }
}

/// The least robustness of the operands, each on its own part of the trajectory.
fn sequence_robustness<S>(operands: &[Operand<'_, S>], trajectory: &[S]) -> Result<f64, Error> {
    let (mut least, mut start) = (f64::INFINITY, 0);
    for operand in operands {
        let (mut q, mut end) = (0, start);
        while end < trajectory.len() && (end == start || !operand.is_terminal(q)) {
            q = operand.next(q, &trajectory[end])?;
            end += 1;
        }
        least = least.min(operand.trajectory_robustness(&trajectory[start..end])?);
        if !operand.is_accepting(q) {
            break;
        }
        start = end;
    }
    Ok(least)
}
