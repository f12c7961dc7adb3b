//! Boolean functions of predicates: reduced ordered binary decision diagrams, and their
//! irredundant sums of products.
//!
//! A [`Store`] owns the nodes of many functions that share them; equal functions have equal
//! [`Guard`]s. Operations recurse once per level, never per path, so their cost is bounded by the
//! product of the diagrams' sizes; all levels are below [`Store::MAX_LEVELS`], which bounds the
//! recursion. Nothing depends on hash order.

use rustc_hash::FxHashMap;

use crate::arena;

/// A Boolean function in a [`Store`]. Equal functions of one store are equal values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Guard(u32);

arena::id! { Guard }

impl Guard {
    /// The function that is always false.
    pub const FALSE: Self = Self(0);
    /// The function that is always true.
    pub const TRUE: Self = Self(1);

    /// The number of the node, an index below [`Store::len`].
    #[must_use]
    pub fn index(self) -> usize {
        self.0 as usize
    }
}

/// A literal of a cube: a level and the value that it asks for.
pub type Literal = (u32, bool);

/// A conjunction of literals, by rising level.
pub type Cube = Vec<Literal>;

#[derive(Clone, Copy, PartialEq, Eq)]
struct Node {
    level: u32,
    low: Guard,
    high: Guard,
}

#[derive(Clone, Copy, PartialEq, Eq)]
struct Known {
    operation: Operation,
    a: Guard,
    b: Guard,
    result: Guard,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Operation {
    None,
    And,
    Or,
    Minus,
}

/// Shared decision diagrams over levels `0..`; lower levels are asked first.
pub struct Store {
    nodes: Vec<Node>,
    /// Open addressing, linear probing: indices into `nodes`, 0 for a free slot.
    unique: Vec<u32>,
    /// Direct-mapped and lossy: a forgotten result is computed again.
    known: Vec<Known>,
    /// The number of nodes beyond which nothing is computed any more.
    limit: usize,
}

impl Default for Store {
    fn default() -> Self {
        let leaf = |value| Node { level: u32::MAX, low: value, high: value };
        let mut store = Self {
            nodes: vec![leaf(Guard::FALSE), leaf(Guard::TRUE)],
            unique: Vec::new(),
            known: Vec::new(),
            limit: usize::MAX,
        };
        store.grow();
        store
    }
}

impl Store {
    /// The number of levels up to which no operation runs out of stack.
    pub const MAX_LEVELS: u32 = 4096;

    /// A store that stops growing soon after `limit` nodes: from then on, results are arbitrary and
    /// [`is_exhausted`](Self::is_exhausted) says so. No single operation can run away.
    #[must_use]
    pub fn with_limit(limit: usize) -> Self {
        Self { limit, ..Self::default() }
    }

    /// Whether the limit has been passed, and results are arbitrary.
    #[must_use]
    pub fn is_exhausted(&self) -> bool {
        self.nodes.len() > self.limit
    }

    /// The number of nodes made so far, the two constants included.
    #[must_use]
    #[allow(clippy::len_without_is_empty, reason = "a store always holds the constants")]
    pub fn len(&self) -> usize {
        self.nodes.len()
    }

    /// The level that a function asks first; `u32::MAX` for a constant.
    #[must_use]
    pub fn level(&self, f: Guard) -> u32 {
        self.nodes[f.index()].level
    }

    /// What a function becomes when its first level is false, and true.
    #[must_use]
    pub fn branches(&self, f: Guard) -> (Guard, Guard) {
        let node = self.nodes[f.index()];
        (node.low, node.high)
    }

    /// The function that is true iff `level` is.
    pub fn variable(&mut self, level: u32) -> Guard {
        self.node(level, Guard::FALSE, Guard::TRUE)
    }

    /// A literal.
    pub fn literal(&mut self, (level, value): Literal) -> Guard {
        let (low, high) =
            if value { (Guard::FALSE, Guard::TRUE) } else { (Guard::TRUE, Guard::FALSE) };
        self.node(level, low, high)
    }

    /// The function that asks `level`, which must stand before all levels of `low` and `high`.
    ///
    /// # Panics
    /// If `level` is not below [`Self::MAX_LEVELS`].
    pub fn node(&mut self, level: u32, low: Guard, high: Guard) -> Guard {
        if low == high {
            return low;
        }
        assert!(level < Self::MAX_LEVELS, "too many levels");
        debug_assert!(level < self.level(low) && level < self.level(high));
        let node = Node { level, low, high };
        let mask = self.unique.len() - 1;
        let mut slot = hash(level, low.0, high.0) as usize & mask;
        while self.unique[slot] != 0 {
            if self.nodes[self.unique[slot] as usize] == node {
                return Guard(self.unique[slot]);
            }
            slot = (slot + 1) & mask;
        }
        let fresh = u32::try_from(self.nodes.len()).expect("fewer than 2^32 nodes");
        self.unique[slot] = fresh;
        self.nodes.push(node);
        if self.nodes.len() * 2 > self.unique.len() {
            self.grow();
        }
        Guard(fresh)
    }

    fn grow(&mut self) {
        let size = (self.unique.len() * 4).max(1 << 8);
        self.unique = vec![0; size];
        for (index, node) in (0..).zip(&self.nodes).skip(2) {
            let mut slot = hash(node.level, node.low.0, node.high.0) as usize & (size - 1);
            while self.unique[slot] != 0 {
                slot = (slot + 1) & (size - 1);
            }
            self.unique[slot] = index;
        }
        let nothing = Known {
            operation: Operation::None,
            a: Guard::FALSE,
            b: Guard::FALSE,
            result: Guard::FALSE,
        };
        self.known = vec![nothing; size];
    }

    /// f ∧ g
    pub fn and(&mut self, f: Guard, g: Guard) -> Guard {
        match (f, g) {
            (Guard::FALSE, _) | (_, Guard::TRUE) => f,
            (Guard::TRUE, _) | (_, Guard::FALSE) => g,
            _ if f == g => f,
            _ => self.apply(Operation::And, f.min(g), f.max(g)),
        }
    }

    /// f ∨ g
    pub fn or(&mut self, f: Guard, g: Guard) -> Guard {
        match (f, g) {
            (Guard::TRUE, _) | (_, Guard::FALSE) => f,
            (Guard::FALSE, _) | (_, Guard::TRUE) => g,
            _ if f == g => f,
            _ => self.apply(Operation::Or, f.min(g), f.max(g)),
        }
    }

    /// f ∧ ¬g
    pub fn minus(&mut self, f: Guard, g: Guard) -> Guard {
        match (f, g) {
            (Guard::FALSE, _) | (_, Guard::FALSE) => f,
            (_, Guard::TRUE) => Guard::FALSE,
            _ if f == g => Guard::FALSE,
            _ => self.apply(Operation::Minus, f, g),
        }
    }

    /// ¬f
    pub fn not(&mut self, f: Guard) -> Guard {
        self.minus(Guard::TRUE, f)
    }

    fn apply(&mut self, operation: Operation, a: Guard, b: Guard) -> Guard {
        let key = hash(a.0, b.0, operation as u32) as usize;
        let known = self.known[key & (self.known.len() - 1)];
        if known.operation == operation && known.a == a && known.b == b {
            return known.result;
        }
        if self.is_exhausted() {
            return Guard::FALSE;
        }
        let level = self.level(a).min(self.level(b));
        let (a0, a1) = self.split(a, level);
        let (b0, b1) = self.split(b, level);
        let run = match operation {
            Operation::And => Self::and,
            Operation::Or => Self::or,
            Operation::None | Operation::Minus => Self::minus,
        };
        let low = run(self, a0, b0);
        let high = run(self, a1, b1);
        let result = self.node(level, low, high);
        let slot = key & (self.known.len() - 1);
        self.known[slot] = Known { operation, a, b, result };
        result
    }

    fn split(&self, f: Guard, level: u32) -> (Guard, Guard) {
        if self.level(f) == level { self.branches(f) } else { (f, f) }
    }

    /// An irredundant sum of products between `lower` and `upper` (Minato and Morreale): every
    /// cube is needed and no literal can be dropped. `lower` must imply `upper`. The form is a
    /// function of the two bounds and the order of the levels alone. `None` if it has more than
    /// `most` cubes; they are counted before they are written out.
    pub fn sum_of_products(
        &mut self,
        lower: Guard,
        upper: Guard,
        most: usize,
    ) -> Option<Vec<Cube>> {
        let mut covers = Covers::default();
        let root = self.cover(lower, upper, &mut covers).1;
        if covers.count(root) > most {
            return None;
        }
        let mut cubes = Vec::new();
        covers.write(root, &mut Cube::new(), &mut cubes);
        Some(cubes)
    }

    /// The covered function and its cubes.
    fn cover(&mut self, lower: Guard, upper: Guard, covers: &mut Covers) -> (Guard, u32) {
        if lower == Guard::FALSE {
            return (Guard::FALSE, Covers::NONE);
        }
        if upper == Guard::TRUE {
            return (Guard::TRUE, Covers::EMPTY_CUBE);
        }
        if let Some(&known) = covers.known.get(&(lower, upper)) {
            return known;
        }
        let level = self.level(lower).min(self.level(upper));
        let (lower0, lower1) = self.split(lower, level);
        let (upper0, upper1) = self.split(upper, level);
        let only0 = self.minus(lower0, upper1);
        let only1 = self.minus(lower1, upper0);
        let (covered0, low) = self.cover(only0, upper0, covers);
        let (covered1, high) = self.cover(only1, upper1, covers);
        let rest0 = self.minus(lower0, covered0);
        let rest1 = self.minus(lower1, covered1);
        let rest = self.or(rest0, rest1);
        let both = self.and(upper0, upper1);
        let (covered, rest) = self.cover(rest, both, covers);
        let (under0, under1) = (self.or(covered0, covered), self.or(covered1, covered));
        let cover = (self.node(level, under0, under1), covers.add(level, low, high, rest));
        covers.known.insert((lower, upper), cover);
        cover
    }
}

/// Sets of cubes that share their parts: those that ask a level false, true, or not at all.
#[derive(Default)]
struct Covers {
    known: FxHashMap<(Guard, Guard), (Guard, u32)>,
    sets: Vec<CubeSet>,
}

struct CubeSet {
    level: u32,
    low: u32,
    high: u32,
    rest: u32,
    /// How many cubes, saturating.
    count: usize,
}

impl Covers {
    const NONE: u32 = 0;
    const EMPTY_CUBE: u32 = 1;

    fn add(&mut self, level: u32, low: u32, high: u32, rest: u32) -> u32 {
        let counts = [low, high, rest].map(|set| self.count(set));
        let count = counts.into_iter().fold(0, usize::saturating_add);
        self.sets.push(CubeSet { level, low, high, rest, count });
        self.sets.len() as u32 + 1
    }

    fn count(&self, set: u32) -> usize {
        match set {
            Self::NONE | Self::EMPTY_CUBE => set as usize,
            _ => self.sets[set as usize - 2].count,
        }
    }

    fn write(&self, set: u32, prefix: &mut Cube, cubes: &mut Vec<Cube>) {
        match set {
            Self::NONE => {}
            Self::EMPTY_CUBE => cubes.push(prefix.clone()),
            _ => {
                let CubeSet { level, low, high, rest, .. } = self.sets[set as usize - 2];
                for (value, set) in [(false, low), (true, high)] {
                    prefix.push((level, value));
                    self.write(set, prefix, cubes);
                    prefix.pop();
                }
                self.write(rest, prefix, cubes);
            }
        }
    }
}

/// Multiplicative mixing of three words; the low bits are good.
fn hash(a: u32, b: u32, c: u32) -> u64 {
    let mixed = (u64::from(a) ^ (u64::from(b) << 32) ^ (u64::from(b) >> 11))
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        ^ u64::from(c).wrapping_mul(0xd6e8_feb8_6659_fd93);
    let mixed = (mixed ^ (mixed >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    mixed ^ (mixed >> 29)
}
