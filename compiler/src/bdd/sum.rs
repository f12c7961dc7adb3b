//! Irredundant sums of products of Boolean functions.
//!
//! Minato, "Fast Generation of Prime-Irredundant Covers from Binary Decision Diagrams" (1993),
//! after Morreale, "Recursive Operators for Prime Implicant and Irredundant Normal Form
//! Determination" (1970). Between two functions `lower` ⊆ `upper` it finds a sum in which no cube
//! and no literal can be dropped. The gap between the two is what cannot occur: it shortens guards.
//!
//! Why irredundant and not minimum: a minimum sum is NP-hard, and the guards that authors see are
//! small; irredundance already guarantees that every literal shown matters. The result depends only
//! on the functions and the order of their levels, so guards are the same for every build.
//!
//! Cubes are built as sets that share their parts (as in Minato's zero-suppressed diagrams), so
//! that their number is known before one of them is written out: a sum can have exponentially many.
//! The sets stay with the diagram, because most guards of an automaton are made of the same few
//! functions. The indicator of a leaf that stands on one side of a node only is that of the child
//! with one more literal, and so is its sum: the guards of n unordered goals, 3^n of them, are made
//! without a single operation on diagrams.

use super::{Bdd, Diagram, Node};
use crate::arena::{Memo, id};

/// A variable, by its level, and the value that it must have.
pub type Literal = (u32, bool);

/// A conjunction of literals, by rising level.
pub type Cube = Vec<Literal>;

/// An irredundant sum of products that a diagram keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cover(u32);

id!(Cover);

impl Cover {
    /// No cube: ⊥.
    pub const FALSE: Self = Self(0);
    /// The cube without literals: ⊤.
    pub const TRUE: Self = Self(1);
}

/// The parts that one sum may be made of, before it counts as too large: a quarter of a million
/// takes an unoptimized macro a second.
const MOST_PARTS: usize = 1 << 18;

/// The sums of a diagram.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    /// The sum for each pair of bounds that was asked for.
    known: Memo<(Bdd, Bdd), Cover>,
    /// All sums so far, each after those that it is made of.
    all: Vec<Parts>,
    /// How many more parts the sum that is being made may have.
    left: usize,
    /// Whether a sum was too large, and results are arbitrary.
    is_exhausted: bool,
}

/// A set of cubes, in three parts: those with the literal "`level` is false", those with "`level`
/// is true", those without a literal of this level.
#[derive(Clone, Copy, Debug)]
struct Parts {
    level: u32,
    /// The three parts, in this order.
    parts: [Cover; 3],
    /// The number of cubes, saturating: it can be exponential.
    count: usize,
    /// The disjunction of the cubes, once somebody asked for it.
    function: Option<Bdd>,
}

impl Covers {
    /// The two fixed sums.
    fn new() -> Self {
        let none = Some(Bdd::FALSE);
        let none = Parts { level: u32::MAX, parts: [Cover::FALSE; 3], count: 0, function: none };
        let empty_cube = Parts { count: 1, function: Some(Bdd::TRUE), ..none };
        Self { all: vec![none, empty_cube], ..Self::default() }
    }

    /// The parts of a sum.
    fn get(&self, cover: Cover) -> Parts {
        self.all[cover.0 as usize]
    }

    /// Adds a sum.
    fn add(&mut self, level: u32, parts: [Cover; 3], function: Option<Bdd>) -> Cover {
        let count = parts.iter().map(|&part| self.get(part).count);
        let count = count.fold(0, usize::saturating_add);
        self.all.push(Parts { level, parts, count, function });
        Cover(self.all.len() as u32 - 1)
    }

    /// Visits the cubes of a sum in lexicographic order. Cubes that have a literal of the level
    /// come before those without: in an irredundant sum no cube is the beginning of another.
    fn visit(&self, cover: Cover, prefix: &mut Cube, visit: &mut dyn FnMut(&[Literal])) {
        match cover {
            Cover::FALSE => {}
            Cover::TRUE => visit(prefix),
            _ => {
                let Parts { level, parts: [low, high, rest], .. } = self.get(cover);
                for (value, part) in [(true, high), (false, low)] {
                    if part != Cover::FALSE {
                        prefix.push((level, value));
                        self.visit(part, prefix, visit);
                        prefix.pop();
                    }
                }
                self.visit(rest, prefix, visit);
            }
        }
    }
}

impl Diagram {
    /// An irredundant sum of products between `lower` and `upper`, of which the first implies the
    /// second: every cube is needed, and no literal of a cube can be dropped. The sum is determined
    /// by the two functions and the order of the levels.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let [a, b] = [0, 1].map(|level| diagram.variable(level));
    /// let both = diagram.and(a, b);
    /// // Where `a` without `b` cannot occur, `b` need not be asked.
    /// let impossible = diagram.minus(a, b);
    /// let upper = diagram.or(both, impossible);
    /// let [exact, shorter] = [both, upper].map(|upper| diagram.cover(both, upper));
    /// assert_eq!(diagram.cubes(exact), [[(0, true), (1, true)]]);
    /// assert_eq!(diagram.cubes(shorter), [[(0, true)]]);
    /// assert_eq!(diagram.products(shorter), 1);
    /// ```
    pub fn cover(&mut self, lower: Bdd, upper: Bdd) -> Cover {
        self.prepare();
        self.between(lower, upper)
    }

    /// The number of cubes of a sum, saturating. It is the largest number there is for every sum of
    /// a diagram once one of them had too many parts to be made.
    #[must_use]
    pub fn products(&self, cover: Cover) -> usize {
        if self.covers.is_exhausted { usize::MAX } else { self.covers.get(cover).count }
    }

    /// The cubes of a sum in the lexicographic order of their literals, lower levels first, true
    /// before false. They can be exponentially many: [`products`](Self::products) counts them.
    #[must_use]
    pub fn cubes(&self, cover: Cover) -> Vec<Cube> {
        let mut cubes = Vec::new();
        self.visit(cover, &mut |cube| cubes.push(cube.to_vec()));
        cubes
    }

    /// Visits the [`cubes`](Self::cubes) of a sum, without an allocation for each.
    pub fn visit(&self, cover: Cover, visit: &mut dyn FnMut(&[Literal])) {
        self.covers.visit(cover, &mut Cube::new(), visit);
    }

    /// The disjunction of the cubes of a sum. Recurses once a level.
    pub fn function(&mut self, cover: Cover) -> Bdd {
        let Parts { level, parts, function, .. } = self.covers.get(cover);
        if let Some(known) = function {
            return known;
        }
        let [low, high, rest] = parts.map(|part| self.function(part));
        let (low, high) = (self.or(low, rest), self.or(high, rest));
        let function = self.node(level, low, high);
        self.covers.all[cover.0 as usize].function = Some(function);
        function
    }

    /// Makes room for the parts of one more sum.
    fn prepare(&mut self) {
        if self.covers.all.is_empty() {
            self.covers = Covers::new();
        }
        self.covers.left = MOST_PARTS;
    }

    /// The sum between two functions: Minato's recursion, once a level.
    ///
    /// First the cubes that must have a literal of the level, then, for what these leave uncovered
    /// on both sides, the cubes that do not.
    fn between(&mut self, lower: Bdd, upper: Bdd) -> Cover {
        if lower == Bdd::FALSE {
            return Cover::FALSE;
        }
        if upper == Bdd::TRUE {
            return Cover::TRUE;
        }
        if let Some(known) = self.covers.known.get((lower, upper)) {
            return known;
        }
        self.covers.is_exhausted |= self.covers.left == 0;
        if self.covers.is_exhausted {
            return Cover::FALSE;
        }
        self.covers.left -= 1;
        let level = self.level(lower).min(self.level(upper));
        let (lower0, lower1) = self.cofactors(lower, level);
        let (upper0, upper1) = self.cofactors(upper, level);
        // The parts that only cubes with a literal of the level can cover.
        let (only0, only1) = (self.minus(lower0, upper1), self.minus(lower1, upper0));
        let (low, high) = (self.between(only0, upper0), self.between(only1, upper1));
        let (on_low, on_high) = (self.function(low), self.function(high));
        let (rest0, rest1) = (self.minus(lower0, on_low), self.minus(lower1, on_high));
        let (rest, both) = (self.or(rest0, rest1), self.and(upper0, upper1));
        let rest = self.between(rest, both);
        let cover = self.covers.add(level, [low, high, rest], None);
        self.covers.known.insert((lower, upper), cover);
        cover
    }

    /// For each of `roots` its leaves that are wanted, rising, each with the sum of products, in
    /// `into`, that is true where the root leads to the leaf.
    ///
    /// All sums are built in one pass from those of the children; asking for each leaf by itself
    /// would walk the diagram once a leaf. Cost: the number of pairs of a node and a leaf that it
    /// leads to, and a sum between functions where a leaf is on both sides of a node.
    ///
    /// ```
    /// use tltl_compiler::bdd::{Bdd, Diagram};
    ///
    /// let mut diagram = Diagram::default();
    /// let f = diagram.node(0, Bdd::leaf(9), Bdd::leaf(4));
    /// let mut guards = Diagram::default();
    /// let [(four, when), (nine, _)] = diagram.leaf_covers(&[f], &|_| true, &mut guards)[0][..] else { panic!() };
    /// assert_eq!((four, nine), (4, 9));
    /// assert_eq!(guards.cubes(when), [[(0, true)]]);
    /// ```
    #[must_use]
    pub fn leaf_covers(
        &self,
        roots: &[Bdd],
        is_wanted: &dyn Fn(u32) -> bool,
        into: &mut Self,
    ) -> Vec<Vec<(u32, Cover)>> {
        into.prepare();
        let mut known: Vec<Vec<(u32, Cover)>> = vec![Vec::new(); self.nodes.len()];
        let leaf =
            |f: Bdd| f.value().filter(|&leaf| is_wanted(leaf)).map(|leaf| (leaf, Cover::TRUE));
        for place in self.postorder(roots) {
            let Node { level, low, high } = self.nodes[place as usize];
            let (on_low, on_high) = (leaf(low), leaf(high));
            let low = known.get(low.0 as usize).map_or(on_low.as_slice(), Vec::as_slice);
            let high = known.get(high.0 as usize).map_or(on_high.as_slice(), Vec::as_slice);
            known[place as usize] = into.merge(level, low, high);
        }
        let of = |root: &Bdd| known.get(root.0 as usize).cloned();
        roots.iter().map(|root| of(root).unwrap_or_else(|| Vec::from_iter(leaf(*root)))).collect()
    }

    /// The sums of a node from those of its children: a merge of two rising lists.
    fn merge(
        &mut self,
        level: u32,
        mut low: &[(u32, Cover)],
        mut high: &[(u32, Cover)],
    ) -> Vec<(u32, Cover)> {
        let mut merged = Vec::with_capacity(low.len().max(high.len()));
        let first = |side: &[(u32, Cover)]| side.first().map_or(u32::MAX, |&(leaf, _)| leaf);
        while !low.is_empty() || !high.is_empty() {
            let leaf = first(low).min(first(high));
            merged.push((leaf, self.join(level, take(&mut low, leaf), take(&mut high, leaf))));
        }
        merged
    }

    /// The sum that is `low` where `level` is false and `high` where it is true.
    fn join(&mut self, level: u32, low: Cover, high: Cover) -> Cover {
        if low == high {
            return low;
        }
        if low == Cover::FALSE || high == Cover::FALSE {
            return self.covers.add(level, [low, high, Cover::FALSE], None);
        }
        let (low, high) = (self.function(low), self.function(high));
        let function = self.node(level, low, high);
        self.cover(function, function)
    }
}

/// Takes the sum of `leaf` from the front of a list; false if the list does not have that leaf.
fn take(side: &mut &[(u32, Cover)], leaf: u32) -> Cover {
    match **side {
        [(first, cover), ref rest @ ..] if first == leaf => {
            *side = rest;
            cover
        }
        _ => Cover::FALSE,
    }
}
