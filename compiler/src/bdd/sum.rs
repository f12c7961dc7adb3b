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
//! functions.

use super::{Bdd, Diagram};
use crate::arena::Memo;

/// A variable, by its level, and the value that it must have.
pub type Literal = (u32, bool);

/// A conjunction of literals, by rising level.
pub type Cube = Vec<Literal>;

/// The remembered sets of cubes are forgotten beyond this many: they take 60 MB then.
const MOST_COVERS: usize = 1 << 20;

/// Sets of cubes, by their index in `sets`. The first two are fixed: no cube, and the empty cube.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    /// The set for each pair of bounds that was asked for.
    known: Memo<(Bdd, Bdd), u32>,
    /// All sets so far, each after those that it is made of.
    sets: Vec<Cover>,
}

/// A set of cubes, in three parts: those with the literal "`level` is false", those with "`level`
/// is true", those without a literal of this level.
#[derive(Clone, Copy, Debug)]
struct Cover {
    level: u32,
    /// The indices of the three parts, in this order.
    parts: [u32; 3],
    /// The number of cubes, saturating: it can be exponential.
    count: usize,
    /// The disjunction of the cubes.
    function: Bdd,
}

impl Covers {
    /// The index of the set without cubes.
    const NONE: u32 = 0;
    /// The index of the set whose only cube has no literals.
    const EMPTY_CUBE: u32 = 1;

    /// The two fixed sets.
    fn new() -> Self {
        let cover = Cover { level: u32::MAX, parts: [0; 3], count: 0, function: Bdd::FALSE };
        let empty_cube = Cover { count: 1, function: Bdd::TRUE, ..cover };
        Self { known: Memo::default(), sets: vec![cover, empty_cube] }
    }

    /// The set at an index.
    fn get(&self, set: u32) -> Cover {
        self.sets[set as usize]
    }

    /// Adds a set, and returns its index.
    fn add(&mut self, level: u32, parts: [u32; 3], function: Bdd) -> u32 {
        let [low, high, rest] = parts;
        let asking = self.get(low).count.saturating_add(self.get(high).count);
        let count = asking.saturating_add(self.get(rest).count);
        self.sets.push(Cover { level, parts, count, function });
        self.sets.len() as u32 - 1
    }

    /// Writes out the cubes of a set in lexicographic order. Cubes that have a literal of the level
    /// come before those without: in an irredundant sum no cube is the beginning of another.
    fn write(&self, set: u32, prefix: &mut Cube, cubes: &mut Vec<Cube>) {
        match set {
            Self::NONE => {}
            Self::EMPTY_CUBE => cubes.push(prefix.clone()),
            _ => {
                let Cover { level, parts: [low, high, rest], .. } = self.get(set);
                for (value, part) in [(true, high), (false, low)] {
                    prefix.push((level, value));
                    self.write(part, prefix, cubes);
                    prefix.pop();
                }
                self.write(rest, prefix, cubes);
            }
        }
    }
}

impl Diagram {
    /// An irredundant sum of products between `lower` and `upper`, of which the first implies the
    /// second: every cube is needed, and no literal of a cube can be dropped. The cubes stand in
    /// the lexicographic order of their literals, lower levels first, true before false. The sum is
    /// determined by the two functions and the order of the levels.
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
    /// assert_eq!(diagram.sum_of_products(both, both), [[(0, true), (1, true)]]);
    /// assert_eq!(diagram.sum_of_products(both, upper), [[(0, true)]]);
    /// assert_eq!(diagram.count_products(both, upper), 1);
    /// ```
    pub fn sum_of_products(&mut self, lower: Bdd, upper: Bdd) -> Vec<Cube> {
        let set = self.sum(lower, upper);
        let mut cubes = Vec::new();
        self.covers.write(set, &mut Cube::new(), &mut cubes);
        cubes
    }

    /// The number of cubes of [`sum_of_products`](Self::sum_of_products), none of which is written
    /// out; saturating.
    pub fn count_products(&mut self, lower: Bdd, upper: Bdd) -> usize {
        let set = self.sum(lower, upper);
        self.covers.get(set).count
    }

    /// The index of the set of cubes of a sum; forgets the known sets first if they are too many.
    /// It never forgets within one sum, for its parts are indices into the sets.
    fn sum(&mut self, lower: Bdd, upper: Bdd) -> u32 {
        if self.covers.sets.is_empty() || self.covers.sets.len() > MOST_COVERS {
            self.covers = Covers::new();
        }
        self.cover(lower, upper)
    }

    /// The index of the set of cubes of a sum: Minato's recursion, once a level.
    ///
    /// First the cubes that must have a literal of the level, then, for what these leave uncovered
    /// on both sides, the cubes that do not.
    fn cover(&mut self, lower: Bdd, upper: Bdd) -> u32 {
        if lower == Bdd::FALSE {
            return Covers::NONE;
        }
        if upper == Bdd::TRUE {
            return Covers::EMPTY_CUBE;
        }
        if let Some(known) = self.covers.known.get((lower, upper)) {
            return known;
        }
        let level = self.level(lower).min(self.level(upper));
        let (lower0, lower1) = self.cofactors(lower, level);
        let (upper0, upper1) = self.cofactors(upper, level);
        // The parts that only cubes with a literal of the level can cover.
        let (only0, only1) = (self.minus(lower0, upper1), self.minus(lower1, upper0));
        let (low, high) = (self.cover(only0, upper0), self.cover(only1, upper1));
        let (on_low, on_high) = (self.covers.get(low).function, self.covers.get(high).function);
        let (rest0, rest1) = (self.minus(lower0, on_low), self.minus(lower1, on_high));
        let (rest, both) = (self.or(rest0, rest1), self.and(upper0, upper1));
        let rest = self.cover(rest, both);
        let on_rest = self.covers.get(rest).function;
        let (under0, under1) = (self.or(on_low, on_rest), self.or(on_high, on_rest));
        let function = self.node(level, under0, under1);
        let set = self.covers.add(level, [low, high, rest], function);
        self.covers.known.insert((lower, upper), set);
        set
    }
}
