//! Multi-terminal binary decision diagrams: functions of Booleans to numbers, shared and reduced.
//!
//! A [`Bdd`] is a function in a [`Diagram`]: a *leaf*, which is a number, or a *node*, which asks
//! one variable and goes on low where it is false and high where it is true. Variables are known by
//! their *level*; lower levels are asked first. A Boolean function is one whose leaves are 0 and 1;
//! the transition function of an automaton is one whose leaves are states. All functions of a
//! diagram share their nodes, and no node is there twice or asks in vain: equal functions are equal
//! `Bdd`s.
//!
//! ```
//! use tltl_compiler::bdd::{Bdd, Diagram};
//!
//! let mut diagram = Diagram::default();
//! let [a, b] = [0, 1].map(|level| diagram.variable(level));
//! let either = diagram.or(a, b);
//! let both = diagram.and(a, b);
//! let not_both = diagram.not(both);
//! assert_eq!(diagram.and(either, both), both);
//! // One of the two: a ∧ ¬b ∨ ¬a ∧ b.
//! let one = diagram.and(either, not_both);
//! let sum = diagram.cover(one, one);
//! assert_eq!(diagram.cubes(sum), [[(0, true), (1, false)], [(0, false), (1, true)]]);
//! // A transition function: to state 7 where exactly one holds, else to state 3.
//! let (states, moves) = diagram.map_leaves(&[one], &|leaf| Bdd::leaf(if leaf == 1 { 7 } else { 3 }));
//! assert_eq!(states.leaves(moves[0]), [3, 7]);
//! assert_eq!(states.evaluate(moves[0], &|level| level == 1), 7);
//! ```
//!
//! # Chains of levels
//!
//! The variables of a *chain*, a range of neighbouring levels, imply each other: each one all those
//! above it ("within 4 steps" implies "within 5"). So they have only n + 1 joint values for n
//! levels, the number of them that are true, and a function is a sequence g₀ … gₙ of functions of
//! the other variables. A node at level i of a chain goes to low where fewer than i are true: low
//! is all of g₀ … gᵢ₋₁, equal to each other, and asks no level of the chain. It goes to high
//! elsewhere, the rest of the sequence. A level that asks in vain is one with gᵢ₋₁ = gᵢ: its node
//! would go to the same low as the next node of the chain, which is its high, and that node is
//! taken in its place. So the nodes of a chain are the places where the sequence changes, they are
//! determined by the function, and equal functions are equal as ever. Minimum and maximum of
//! variables of one chain are one node, where free variables would need n: the obligations of an
//! operator with the bound 10,000 stay as small as those of one without.
//!
//! # Sources
//!
//! Reduced ordered diagrams and *apply*: Bryant, "Graph-Based Algorithms for Boolean Function
//! Manipulation" (1986). Unique table and operation cache: Brace, Rudell and Bryant, "Efficient
//! Implementation of a BDD Package" (1990). Leaves that are numbers: Fujita, McGeer and Yang,
//! "Multi-Terminal Binary Decision Diagrams" (1997). [Constrain](Diagram::constrain): Coudert,
//! Berthet and Madre (1989). [Sums of products](Diagram::cover): Minato, "Fast Generation
//! of Prime-Irredundant Covers from Binary Decision Diagrams" (1993), after Morreale (1970).
//!
//! # Cost
//!
//! An operation costs at most the product of the numbers of nodes of its operands, as long as the
//! cache remembers, never the number of paths, and recurses once a node on a path. Levels are never
//! reordered: a bad order can make a diagram exponential in them. Nodes are never freed; a diagram is dropped as a whole. Nothing depends on
//! the order of a hash table.
//!
//! # Why not a crate
//!
//! Every user of the macros would build it: on the machine where this crate and what it needs take
//! 6 seconds of CPU time, `biodivine-lib-bdd` 0.6 takes 9 (17 packages) and `oxidd` 0.13 with its
//! features for MTBDDs alone 17 (42 packages). The first has Boolean functions only, each with
//! nodes of its own. The second has leaves that are numbers, with arithmetic as its operations;
//! products of automata need [`apply`](Diagram::apply) with an operation of their own.

mod sum;
mod walk;

use crate::arena::{self, Memo};

pub use sum::{Cover, Cube, Literal};
pub use walk::Images;

use sum::Covers;

/// A function in a [`Diagram`]: a leaf or a node. Equal functions of one diagram are equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Bdd(u32);

arena::id! { Bdd }

impl Bdd {
    /// The bit that tells a leaf from a node.
    const LEAF: u32 = 1 << 31;
    /// The function that is always false: leaf 0.
    pub const FALSE: Self = Self::leaf(0);
    /// The function that is always true: leaf 1.
    pub const TRUE: Self = Self::leaf(1);

    /// The function that is `value` everywhere; `value` is below 2^31.
    #[must_use]
    pub const fn leaf(value: u32) -> Self {
        Self(Self::LEAF | value)
    }

    /// The node at `index` of [`Diagram::nodes`].
    #[must_use]
    pub const fn node(index: u32) -> Self {
        Self(index)
    }

    /// The number that a leaf is; `None` for a node.
    #[must_use]
    pub const fn value(self) -> Option<u32> {
        if self.0 >= Self::LEAF { Some(self.0 & !Self::LEAF) } else { None }
    }

    /// The index of a node in [`Diagram::nodes`]; `None` for a leaf.
    #[must_use]
    pub const fn index(self) -> Option<u32> {
        if self.0 < Self::LEAF { Some(self.0) } else { None }
    }

    /// The index of a node, or 2^31 plus the number of a leaf: how tables refer to a function.
    #[must_use]
    pub const fn code(self) -> u32 {
        self.0
    }
}

/// A node: `low` where the variable of `level` is false, `high` where it is true. Both are leaves
/// or ask higher levels only, and they differ.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Node {
    /// The level that is asked.
    pub level: u32,
    /// The function where it is false.
    pub low: Bdd,
    /// The function where it is true.
    pub high: Bdd,
}

impl Node {
    fn hash(self) -> usize {
        hash(self.level, self.low.0, self.high.0)
    }
}

/// An operation that [`Diagram::apply`] lifts. Results are remembered by it, so one operation of a
/// diagram always has one meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operation(u32);

impl Operation {
    const AND: Self = Self(0);
    const OR: Self = Self(1);
    const MINUS: Self = Self(2);
    const CONSTRAIN: Self = Self(3);

    /// An operation of the caller's, by a number that the caller gives it.
    #[must_use]
    pub const fn new(number: u32) -> Self {
        Self(number + 4)
    }
}

/// An entry of the operation cache.
#[derive(Clone, Copy, Debug)]
struct Known {
    operation: Operation,
    f: Bdd,
    g: Bdd,
    result: Bdd,
}

/// The nodes of many functions, which share them.
#[derive(Clone, Debug)]
pub struct Diagram {
    nodes: Vec<Node>,
    /// The unique table, by open addressing with linear probing. A leaf marks a free slot.
    unique: Vec<Bdd>,
    /// The operation cache: direct-mapped, so that a new result takes the slot of an old one, which
    /// is then computed again. Empty until the first operation, for most diagrams see none.
    cache: Vec<Known>,
    covers: Covers,
    limit: usize,
    /// The steps of all operations: pairs of functions that the cache did not know.
    steps: usize,
    /// The first and the last level of each chain, rising.
    chains: Vec<(u32, u32)>,
    /// How deep the operation that runs has gone.
    depth: u32,
    /// Whether an operation has gone too deep, and results are arbitrary.
    is_too_deep: bool,
}

impl Default for Diagram {
    /// A diagram without nodes that may grow without limit.
    fn default() -> Self {
        Self::with_limit(usize::MAX)
    }
}

impl Diagram {
    /// The number of levels on one path up to which no operation runs out of stack. Callers that
    /// take levels from an input check it; an [operation](Self::apply) that goes deeper stops, and
    /// [`is_too_deep`](Self::is_too_deep) says so. An unoptimized build needs a megabyte for this
    /// many, half of what a thread has.
    pub const MAX_LEVELS: u32 = 4096;

    /// The steps that operations may make for each node of the limit. Where the cache forgets, they
    /// go over the same pairs again. The families of the translation bench take 0.8 to 1.5 steps a
    /// node, 500 comparisons of one variable in any order between 2 and 4, and the formulas that
    /// would take minutes to run out of nodes more than 100.
    const STEPS: usize = 4;

    /// A diagram without nodes that stops growing soon after `limit` of them, or after as many steps
    /// as such a diagram takes: from then on, results are arbitrary and
    /// [`is_exhausted`](Self::is_exhausted) says so. No operation can run away.
    ///
    /// ```
    /// use tltl_compiler::bdd::Diagram;
    ///
    /// let mut diagram = Diagram::with_limit(3);
    /// let [a, b, c] = [0, 1, 2].map(|level| diagram.variable(level));
    /// assert!(!diagram.is_exhausted());
    /// let both = diagram.and(a, b);
    /// let _arbitrary = diagram.or(both, c);
    /// assert!(diagram.is_exhausted());
    /// ```
    #[must_use]
    pub fn with_limit(limit: usize) -> Self {
        // A kilobyte: the automata of most tasks have fewer than 128 nodes.
        let unique = vec![Bdd::FALSE; 1 << 8];
        Self {
            nodes: Vec::new(),
            unique,
            cache: Vec::new(),
            covers: Covers::default(),
            limit,
            steps: 0,
            chains: Vec::new(),
            depth: 0,
            is_too_deep: false,
        }
    }

    /// The same diagram, still without nodes, with chains among its levels: in each range of
    /// levels, first to last, a variable is true only where those above it are. The ranges rise.
    ///
    /// ```
    /// use tltl_compiler::bdd::Diagram;
    ///
    /// let mut diagram = Diagram::default().chained(vec![(1, 9)]);
    /// let [weak, strong] = [2, 7].map(|level| diagram.variable(level));
    /// assert_eq!(diagram.and(weak, strong), strong);
    /// assert_eq!(diagram.or(weak, strong), weak);
    /// ```
    #[must_use]
    pub fn chained(self, chains: Vec<(u32, u32)>) -> Self {
        debug_assert!(self.nodes.is_empty());
        Self { chains, ..self }
    }

    /// Whether `strong`, a level below `weak`, is in one chain with it: it is true only where
    /// `weak` is.
    fn implies(&self, strong: u32, weak: u32) -> bool {
        if self.chains.is_empty() {
            return false;
        }
        let next = self.chains.partition_point(|&(first, _)| first <= weak);
        next > 0 && strong <= self.chains[next - 1].1
    }

    /// Forgets all functions, and keeps the memory.
    pub fn clear(&mut self) {
        self.nodes.clear();
        self.unique.fill(Bdd::FALSE);
        self.cache.clear();
        self.covers = Covers::default();
    }

    /// Whether the limit has been passed, and results are arbitrary.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.nodes.len() > self.limit || self.steps / Self::STEPS > self.limit || self.is_too_deep
    }

    /// Whether an operation met a path of more than [`MAX_LEVELS`](Self::MAX_LEVELS), and results
    /// are arbitrary.
    #[must_use]
    pub fn is_too_deep(&self) -> bool {
        self.is_too_deep
    }

    /// All nodes, children before parents.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The node that `f` is; `None` for a leaf.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram, Node};
    ///
    /// let mut diagram = Diagram::default();
    /// let f = diagram.node(4, Bdd::leaf(7), Bdd::leaf(9));
    /// assert_eq!(diagram.get(f), Some(Node { level: 4, low: Bdd::leaf(7), high: Bdd::leaf(9) }));
    /// assert_eq!((diagram.get(Bdd::leaf(7)), diagram.level(Bdd::leaf(7))), (None, u32::MAX));
    /// assert_eq!(diagram.nodes().len(), 1, "leaves are not stored");
    /// ```
    #[must_use]
    pub fn get(&self, f: Bdd) -> Option<Node> {
        // The number of a leaf is beyond all nodes.
        self.nodes.get(f.0 as usize).copied()
    }

    /// The level that `f` asks first; `u32::MAX` for a leaf.
    #[must_use]
    pub fn level(&self, f: Bdd) -> u32 {
        self.get(f).map_or(u32::MAX, |node| node.level)
    }

    /// The two functions that `f` is where `level` is false, and where it is true. `f` asks no
    /// lower level.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let [a, b] = [0, 1].map(|level| diagram.variable(level));
    /// let both = diagram.and(a, b);
    /// assert_eq!(diagram.cofactors(both, 0), (Bdd::FALSE, b));
    /// assert_eq!(diagram.cofactors(b, 0), (b, b), "it does not ask `a`");
    /// ```
    #[must_use]
    pub fn cofactors(&self, f: Bdd, level: u32) -> (Bdd, Bdd) {
        match self.get(f) {
            Some(node) if node.level == level => (node.low, node.high),
            // Where a level is false, all below it in its chain are.
            Some(node) if self.implies(node.level, level) => (node.low, f),
            _ => (f, f),
        }
    }

    /// The number that `f` is where `holds` gives the values of the variables.
    #[must_use]
    pub fn evaluate(&self, mut f: Bdd, holds: &dyn Fn(u32) -> bool) -> u32 {
        while let Some(node) = self.get(f) {
            f = if holds(node.level) { node.high } else { node.low };
        }
        f.0 & !Bdd::LEAF
    }

    /// The function that is true iff `level` is.
    pub fn variable(&mut self, level: u32) -> Bdd {
        self.node(level, Bdd::FALSE, Bdd::TRUE)
    }

    /// The function that is true iff the literal is.
    pub fn literal(&mut self, (level, value): Literal) -> Bdd {
        let (low, high) = if value { (Bdd::FALSE, Bdd::TRUE) } else { (Bdd::TRUE, Bdd::FALSE) };
        self.node(level, low, high)
    }

    /// The function that is `low` where `level` is false and `high` where it is true. Both ask
    /// higher levels only, and `low` none of the level's chain.
    ///
    /// # Panics
    /// Beyond 2^31 nodes.
    pub fn node(&mut self, level: u32, low: Bdd, high: Bdd) -> Bdd {
        if low == high || self.asks_in_vain(level, low, high) {
            return high;
        }
        debug_assert!(level < self.level(low) && level < self.level(high));
        let node = Node { level, low, high };
        let mask = self.unique.len() - 1;
        let mut slot = node.hash() & mask;
        while let Some(known) = self.get(self.unique[slot]) {
            if known == node {
                return self.unique[slot];
            }
            slot = (slot + 1) & mask;
        }
        let fresh = Bdd(self.nodes.len() as u32);
        assert!(fresh.0 < Bdd::LEAF, "fewer than 2^31 nodes");
        self.unique[slot] = fresh;
        self.nodes.push(node);
        if self.nodes.len() * 2 > self.unique.len() {
            self.grow();
        }
        fresh
    }

    /// Whether the next node of the level's chain separates `low` from all else as well.
    fn asks_in_vain(&self, level: u32, low: Bdd, high: Bdd) -> bool {
        !self.chains.is_empty()
            && self.get(high).is_some_and(|n| n.low == low && self.implies(n.level, level))
    }

    /// Makes room in the unique table, and in the operation cache, which forgets.
    ///
    /// Each size was measured on the families of the translation bench: tables twice as large each
    /// time take 25 to 65 % more time than four times as large, for all nodes move more often;
    /// a table filled to three quarters takes 10 to 35 % more than one filled to half; a cache half
    /// as large 5 to 25 % more, and one twice as large no less.
    fn grow(&mut self) {
        let size = self.unique.len() * 4;
        self.unique = vec![Bdd::FALSE; size];
        for (index, node) in (0..).zip(&self.nodes) {
            let mut slot = node.hash() & (size - 1);
            while self.unique[slot].index().is_some() {
                slot = (slot + 1) & (size - 1);
            }
            self.unique[slot] = Bdd(index);
        }
        self.cache.clear();
    }

    /// The remembered result of an operation, whose [`hash`] is `key`.
    fn known(&mut self, key: usize, operation: Operation, f: Bdd, g: Bdd) -> Option<Bdd> {
        if self.cache.is_empty() {
            // ⊥ ∧ ⊥ = ⊥ holds, and is never looked up.
            let [f, g, result] = [Bdd::FALSE; 3];
            let free = Known { operation: Operation::AND, f, g, result };
            self.cache.resize(self.unique.len(), free);
        }
        let known = self.cache[key & (self.cache.len() - 1)];
        (known.operation == operation && known.f == f && known.g == g).then_some(known.result)
    }

    /// Remembers a result in the slot of its key; an older one there is lost.
    fn remember(&mut self, key: usize, known: Known) {
        let slot = key & (self.unique.len() - 1);
        // The table may have grown since the operation began.
        if let Some(entry) = self.cache.get_mut(slot) {
            *entry = known;
        }
    }

    /// f ∧ g
    pub fn and(&mut self, f: Bdd, g: Bdd) -> Bdd {
        self.apply(Operation::AND, f, g, &mut |_, f, g| match (f, g) {
            (Bdd::FALSE, _) | (_, Bdd::TRUE) => Some(f),
            (Bdd::TRUE, _) | (_, Bdd::FALSE) => Some(g),
            _ => (f == g).then_some(f),
        })
    }

    /// f ∨ g
    pub fn or(&mut self, f: Bdd, g: Bdd) -> Bdd {
        self.apply(Operation::OR, f, g, &mut |_, f, g| match (f, g) {
            (Bdd::TRUE, _) | (_, Bdd::FALSE) => Some(f),
            (Bdd::FALSE, _) | (_, Bdd::TRUE) => Some(g),
            _ => (f == g).then_some(f),
        })
    }

    /// f ∧ ¬g
    pub fn minus(&mut self, f: Bdd, g: Bdd) -> Bdd {
        self.apply(Operation::MINUS, f, g, &mut |_, f, g| match (f, g) {
            (Bdd::FALSE, _) | (_, Bdd::FALSE) => Some(f),
            (_, Bdd::TRUE) => Some(Bdd::FALSE),
            _ => (f == g).then_some(Bdd::FALSE),
        })
    }

    /// ¬f
    pub fn not(&mut self, f: Bdd) -> Bdd {
        self.minus(Bdd::TRUE, f)
    }

    /// Lifts an operation on leaves to functions: Bryant's *apply*.
    ///
    /// `terminal` is the operation. It gives the result of two leaves, and also of two functions if
    /// it can be seen without asking a variable; it gets the diagram, to make nodes. Each pair of
    /// functions is combined once, as long as the cache remembers it.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram, Operation};
    ///
    /// // The product of two automata moves to the pair of their next states.
    /// let mut diagram = Diagram::default();
    /// let f = diagram.node(0, Bdd::leaf(2), Bdd::leaf(3));
    /// let g = diagram.node(1, Bdd::leaf(4), Bdd::leaf(5));
    /// let pair = |f: Bdd, g: Bdd| Some(Bdd::leaf(10 * f.value()? + g.value()?));
    /// let product = diagram.apply(Operation::new(0), f, g, &mut |_, f, g| pair(f, g));
    /// assert_eq!(diagram.leaves(product), [24, 25, 34, 35]);
    /// ```
    pub fn apply(
        &mut self,
        operation: Operation,
        f: Bdd,
        g: Bdd,
        terminal: &mut impl FnMut(&mut Self, Bdd, Bdd) -> Option<Bdd>,
    ) -> Bdd {
        if let Some(result) = terminal(self, f, g) {
            return result;
        }
        let commutes = matches!(operation, Operation::AND | Operation::OR);
        let (f, g) = if commutes && g < f { (g, f) } else { (f, g) };
        let key = hash(f.0, g.0, operation.0);
        if let Some(known) = self.known(key, operation, f, g) {
            return known;
        }
        self.is_too_deep |= self.depth > Self::MAX_LEVELS;
        if self.is_exhausted() {
            return Bdd::FALSE;
        }
        let level = self.level(f).min(self.level(g));
        let (f0, f1) = self.cofactors(f, level);
        let (g0, g1) = self.cofactors(g, level);
        self.steps += 1;
        self.depth += 1;
        let low = self.apply(operation, f0, g0, terminal);
        let high = self.apply(operation, f1, g1, terminal);
        self.depth -= 1;
        let result = self.node(level, low, high);
        self.remember(key, Known { operation, f, g, result });
        result
    }

    /// The disjunction of the functions that `f` is for all values of a range of levels, first to
    /// last: no part of a chain, but chains as a whole may be among them.
    ///
    /// ```
    /// use tltl_compiler::bdd::Diagram;
    ///
    /// let mut diagram = Diagram::default();
    /// let [a, b, c] = [0, 1, 2].map(|level| diagram.variable(level));
    /// let [ab, bc] = [(a, b), (b, c)].map(|(f, g)| diagram.and(f, g));
    /// let either = diagram.or(ab, bc);
    /// let a_or_c = diagram.or(a, c);
    /// assert_eq!(diagram.exists(either, 1, 1), a_or_c);
    /// ```
    pub fn exists(&mut self, f: Bdd, first: u32, last: u32) -> Bdd {
        self.without(f, first, last, &mut Memo::default())
    }

    /// [`exists`](Self::exists), with the results so far.
    fn without(&mut self, f: Bdd, first: u32, last: u32, known: &mut Memo<Bdd, Bdd>) -> Bdd {
        let Some(Node { level, low, high }) = self.get(f).filter(|node| node.level <= last) else {
            return f;
        };
        if let Some(result) = known.get(f) {
            return result;
        }
        let low = self.without(low, first, last, known);
        let high = self.without(high, first, last, known);
        let result = if level < first { self.node(level, low, high) } else { self.or(low, high) };
        known.insert(f, result);
        result
    }

    /// The generalized cofactor: a function that is `f` wherever `care` is true, and the same one
    /// for all `f` that agree there. `f` itself if `care` is never true.
    ///
    /// ```
    /// use tltl_compiler::bdd::Diagram;
    ///
    /// let mut diagram = Diagram::default();
    /// let [a, b] = [0, 1].map(|level| diagram.variable(level));
    /// let either = diagram.or(a, b);
    /// // Where `a` does not hold, a ∨ b is b.
    /// let not_a = diagram.not(a);
    /// assert_eq!(diagram.constrain(either, not_a), b);
    /// ```
    pub fn constrain(&mut self, f: Bdd, care: Bdd) -> Bdd {
        if f.value().is_some() || care.value().is_some() {
            return f;
        }
        let operation = Operation::CONSTRAIN;
        let key = hash(f.0, care.0, operation.0);
        if let Some(known) = self.known(key, operation, f, care) {
            return known;
        }
        let level = self.level(f).min(self.level(care));
        let (f0, f1) = self.cofactors(f, level);
        let result = match self.cofactors(care, level) {
            (Bdd::FALSE, care1) => self.constrain(f1, care1),
            (care0, Bdd::FALSE) => self.constrain(f0, care0),
            (care0, care1) => {
                let (low, high) = (self.constrain(f0, care0), self.constrain(f1, care1));
                self.node(level, low, high)
            }
        };
        self.remember(key, Known { operation, f, g: care, result });
        result
    }
}

/// Mixes three words by multiplication; the low bits are good.
fn hash(a: u32, b: u32, c: u32) -> usize {
    let mixed = (u64::from(a) ^ (u64::from(b) << 32) ^ (u64::from(b) >> 11))
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ u64::from(c).wrapping_mul(0xd6e8_feb8_6659_fd93);
    let mixed = (mixed ^ (mixed >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    (mixed ^ (mixed >> 29)) as usize
}

#[cfg(test)]
mod tests;
