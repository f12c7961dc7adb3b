//! Physical units: a type system for the numbers of a source.
//!
//! The names in a unit are opaque: `m` and `cm` are two units, and nothing is ever converted. A
//! conversion would change the numbers that an author wrote, and robustness values with them; a
//! mistake in units is an error instead. This is the dimension system of Kennedy, "Dimension Types"
//! (1994), with the author's names as the base and without inference: a number without a unit is
//! plain.
//!
//! A [`Unit`] is a product of powers of names in normal form: equal units are equal values, however
//! they were written (`N*m/s` and `m*N*s^-1`). Names are numbers here, in order of first
//! appearance; [`Units`] has their texts. Powers and the count of names are bounded, so a unit is
//! small and every operation takes constant time.
//!
//! ```
//! use tltl_compiler::unit::{Unit, Units};
//!
//! let mut units = Units::default();
//! let [m, s] = ["m", "s"].map(|name| units.name(name));
//! let speed = Unit::product([(m, 1), (s, -1)]).unwrap();
//! let time = Unit::product([(s, 1)]).unwrap();
//! assert_eq!(units.text(&speed), "m/s");
//! assert!(speed.times(&time).unwrap().is_name(m));
//! assert_eq!(units.text(&speed.over(&time).unwrap()), "m/s^2");
//! assert_eq!(speed.root(), None);
//! ```

use crate::ast::quoted;
use crate::intern::Interner;

/// The greatest power of a name; its negative is the least. Physics needs about 4; the bound keeps
/// a product of two powers far from overflow, and makes `pow(pow(x, 50), 50)` an error rather than
/// a unit.
pub const MOST_POWER: i32 = 99;

/// The most names that a unit is made of. The SI has seven base units; the bound makes every
/// operation on units take constant time.
pub const MOST_NAMES: usize = 16;

/// A unit: powers of names.
///
/// Invariant: sorted by name, no power is zero, each is within [`MOST_POWER`], and there are at
/// most [`MOST_NAMES`]. So equal units are equal values, and the unit of a plain number is the
/// empty one (the default).
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Unit(Vec<(u32, i32)>);

impl Unit {
    /// The product of some powers of names, a name being allowed several times; `None` if the
    /// result is beyond the bounds.
    ///
    /// ```
    /// use tltl_compiler::unit::Unit;
    ///
    /// let plain = Unit::product([(0, 2), (0, -2)]);
    /// assert!(plain.unwrap().is_plain());
    /// assert_eq!(Unit::product([(0, 100)]), None);
    /// ```
    pub fn product(powers: impl IntoIterator<Item = (u32, i64)>) -> Option<Self> {
        let mut sum: Vec<(u32, i64)> = Vec::new();
        for (name, power) in powers {
            match sum.binary_search_by_key(&name, |known| known.0) {
                Ok(place) => sum[place].1 = sum[place].1.checked_add(power)?,
                Err(place) => sum.insert(place, (name, power)),
            }
        }
        // Normal form: a name that cancels out leaves no trace.
        sum.retain(|(_, power)| *power != 0);
        if sum.len() > MOST_NAMES {
            return None;
        }
        let within = |power: i64| {
            i32::try_from(power).ok().filter(|power| (-MOST_POWER..=MOST_POWER).contains(power))
        };
        let powers = sum.into_iter().map(|(name, power)| Some((name, within(power)?)));
        powers.collect::<Option<_>>().map(Self)
    }

    /// Whether it is the unit of a plain number.
    #[must_use]
    pub fn is_plain(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether it is this one name to the power 1.
    #[must_use]
    pub fn is_name(&self, name: u32) -> bool {
        self.0 == [(name, 1)]
    }

    /// The unit of a product; `None` if that is beyond the bounds.
    #[must_use]
    pub fn times(&self, other: &Self) -> Option<Self> {
        Self::product(self.powers(1).chain(other.powers(1)))
    }

    /// The unit of a quotient; `None` if that is beyond the bounds.
    #[must_use]
    pub fn over(&self, other: &Self) -> Option<Self> {
        Self::product(self.powers(1).chain(other.powers(-1)))
    }

    /// The unit of a power; `None` if that is beyond the bounds.
    #[must_use]
    pub fn power(&self, power: i32) -> Option<Self> {
        Self::product(self.powers(power.into()))
    }

    /// The unit of the square root; `None` if a power is odd.
    #[must_use]
    pub fn root(&self) -> Option<Self> {
        let half = |&(name, power): &(u32, i32)| (power % 2 == 0).then_some((name, power / 2));
        self.0.iter().map(half).collect::<Option<_>>().map(Self)
    }

    /// The names `a` and `b` if it is `a/b`: what a message offers where a factor from `b` to `a`
    /// seems to be missing.
    ///
    /// ```
    /// use tltl_compiler::unit::Unit;
    ///
    /// let per = Unit::product([(7, 1), (3, -1)]).unwrap();
    /// assert_eq!(per.ratio(), Some((7, 3)));
    /// assert_eq!(per.power(2).unwrap().ratio(), None);
    /// ```
    #[must_use]
    pub fn ratio(&self) -> Option<(u32, u32)> {
        match self.0[..] {
            [(a, 1), (b, -1)] | [(b, -1), (a, 1)] => Some((a, b)),
            _ => None,
        }
    }

    /// The powers of its names, each multiplied by `times`.
    fn powers(&self, times: i64) -> impl Iterator<Item = (u32, i64)> {
        self.0.iter().map(move |&(name, power)| (name, times * i64::from(power)))
    }
}

/// The names of the units of a source, numbered in order of first appearance.
#[derive(Clone, Debug, Default)]
pub struct Units(Interner<String>);

impl Units {
    /// The number of a name, which is added if it is new.
    pub fn name(&mut self, text: &str) -> u32 {
        self.0.intern(text.to_owned())
    }

    /// The number of a name; `None` if no unit of the source mentions it.
    #[must_use]
    pub fn find(&self, text: &str) -> Option<u32> {
        self.0.find(text)
    }

    /// The text of a name as messages quote it: not too long.
    #[must_use]
    pub fn text_of(&self, name: u32) -> String {
        quoted(&self.0.things()[name as usize])
    }

    /// A unit as a source writes it: `N*m`, `kg*m/s^2`, `1/s`; `1` for a plain number. Names stand
    /// in alphabetical order, so the text does not depend on what was declared first.
    #[must_use]
    pub fn text(&self, unit: &Unit) -> String {
        let mut powers = unit.0.clone();
        powers.sort_unstable_by_key(|(name, _)| &self.0.things()[*name as usize]);
        let one = |(name, power): &(u32, i32)| match power.unsigned_abs() {
            1 => self.text_of(*name),
            power => format!("{}^{power}", self.text_of(*name)),
        };
        let (above, below): (Vec<_>, Vec<_>) = powers.iter().partition(|(_, power)| *power > 0);
        let above: Vec<String> = above.into_iter().map(one).collect();
        let below = below.into_iter().map(|power| format!("/{}", one(power)));
        let above = if above.is_empty() { "1".to_owned() } else { above.join("*") };
        above + &below.collect::<String>()
    }
}
