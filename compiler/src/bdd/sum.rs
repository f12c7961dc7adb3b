//! Irredundant sums of products of Boolean functions, after Minato and Morreale.
//!
//! Cubes are built as sets that share their parts, so that their number is known before one of them
//! is written out. The sets stay with the diagram: most guards of an automaton are made of the same
//! few functions.

use super::{Bdd, Diagram};
use crate::arena::Memo;

/// A variable, by its level, and the value that it must have.
pub type Literal = (u32, bool);

/// A conjunction of literals, by rising level.
pub type Cube = Vec<Literal>;

/// Beyond this many remembered sets of cubes, which are 60 MB, they are forgotten.
const MOST_COVERS: usize = 1 << 20;

/// Sets of cubes, by their places.
#[derive(Clone, Debug, Default)]
pub(super) struct Covers {
    /// The set for each pair of bounds.
    known: Memo<(Bdd, Bdd), u32>,
    sets: Vec<Cover>,
}

/// A set of cubes: those that ask `level` to be false, those that ask it to be true, those that do
/// not ask it.
#[derive(Clone, Copy, Debug)]
struct Cover {
    level: u32,
    parts: [u32; 3],
    /// The number of cubes, saturating.
    count: usize,
    /// The disjunction of the cubes.
    function: Bdd,
}

impl Covers {
    /// The place of the set without cubes.
    const NONE: u32 = 0;
    /// The place of the set of the cube without literals.
    const EMPTY_CUBE: u32 = 1;

    /// The two sets that all others are made of.
    fn new() -> Self {
        let cover = Cover { level: u32::MAX, parts: [0; 3], count: 0, function: Bdd::FALSE };
        let empty_cube = Cover { count: 1, function: Bdd::TRUE, ..cover };
        Self { known: Memo::default(), sets: vec![cover, empty_cube] }
    }

    fn get(&self, set: u32) -> Cover {
        self.sets[set as usize]
    }

    /// Adds a set, and returns its place.
    fn add(&mut self, level: u32, parts: [u32; 3], function: Bdd) -> u32 {
        let [low, high, rest] = parts;
        let asking = self.get(low).count.saturating_add(self.get(high).count);
        let count = asking.saturating_add(self.get(rest).count);
        self.sets.push(Cover { level, parts, count, function });
        self.sets.len() as u32 - 1
    }

    /// Writes out the cubes of a set in order: what asks the level comes first, for no cube of an
    /// irredundant sum is the beginning of another.
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
    /// second: every cube is needed, and no literal of it can be dropped. The cubes stand in the
    /// lexicographic order of their literals, lower levels first, true before false. The sum is
    /// determined by the two functions and the order of the levels.
    pub fn sum_of_products(&mut self, lower: Bdd, upper: Bdd) -> Vec<Cube> {
        let set = self.sum(lower, upper);
        let mut cubes = Vec::new();
        self.covers.write(set, &mut Cube::new(), &mut cubes);
        cubes
    }

    /// The number of cubes of [`sum_of_products`](Self::sum_of_products), none of which is written
    /// out. Saturating.
    pub fn count_products(&mut self, lower: Bdd, upper: Bdd) -> usize {
        let set = self.sum(lower, upper);
        self.covers.get(set).count
    }

    fn sum(&mut self, lower: Bdd, upper: Bdd) -> u32 {
        if self.covers.sets.is_empty() || self.covers.sets.len() > MOST_COVERS {
            self.covers = Covers::new();
        }
        self.cover(lower, upper)
    }

    /// The place of the set of cubes of a sum.
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
        // What only cubes that ask the level can cover.
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
