//! Random formulas and traces from any source of choices: a generator of numbers, or the bytes of a
//! test that is being shrunk or a fuzzer.
//!
//! ```
//! use tltl_fuzz::random::{Seeded, formula};
//!
//! // The same seed gives the same formula, of at most three operators over `a` and `b`.
//! assert_eq!(formula(&mut Seeded(7), 2, 3), formula(&mut Seeded(7), 2, 3));
//! ```

use tltl_compiler::proposition::Proposition;

/// A source of choices.
pub trait Choices {
    /// A number below `count`, which is at least 1.
    fn choose(&mut self, count: u32) -> u32;
}

/// Choices that bytes make; all are 0 when the bytes are used up.
pub struct Bytes<'a>(pub &'a [u8]);

impl Choices for Bytes<'_> {
    fn choose(&mut self, count: u32) -> u32 {
        let Some((&first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        u32::from(first) % count
    }
}

/// Choices of a small generator (SplitMix64).
pub struct Seeded(pub u64);

impl Choices for Seeded {
    fn choose(&mut self, count: u32) -> u32 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((mixed ^ (mixed >> 31)) % u64::from(count)) as u32
    }
}

/// The names of the propositions.
pub const NAMES: [&str; 5] = ["a", "b", "c", "d", "e"];

/// A co-safe formula with at most `operators` operators over the first `names` of [`NAMES`].
pub fn formula(choices: &mut impl Choices, names: u32, operators: u32) -> String {
    if operators == 0 {
        return leaf(choices, names);
    }
    let rest = operators - 1;
    match choices.choose(15) {
        0 => leaf(choices, names),
        1 => format!("!({})", condition(choices, names, rest)),
        2 => format!("X ({})", formula(choices, names, rest)),
        3 | 4 => format!("F ({})", formula(choices, names, rest)),
        5 => {
            let left = choices.choose(rest + 1);
            let before = condition(choices, names, left);
            format!("({before}) => ({})", formula(choices, names, rest - left))
        }
        6 | 7 => {
            let operator = ["F", "G"][choices.choose(2) as usize];
            let (first, last) = steps(choices, 0);
            format!("{operator}[{first},{last}] ({})", formula(choices, names, rest))
        }
        8 => {
            let left = choices.choose(rest + 1);
            let before = formula(choices, names, left);
            format!("(({before}) ensuring {})", condition(choices, names, rest - left))
        }
        9 | 10 => {
            let operator = choices.choose(2);
            let (first, last) = steps(choices, operator);
            let operator = ["U", "T"][operator as usize];
            binary(choices, names, rest, &format!("{operator}[{first},{last}]"))
        }
        other => binary(choices, names, rest, ["U", "T", "&&", "||"][other as usize - 11]),
    }
}

/// An operator between two formulas.
fn binary(choices: &mut impl Choices, names: u32, operators: u32, operator: &str) -> String {
    let left = choices.choose(operators + 1);
    let before = formula(choices, names, left);
    format!("({before}) {operator} ({})", formula(choices, names, operators - left))
}

/// The ends of a bound, the first at least `least`.
fn steps(choices: &mut impl Choices, least: u32) -> (u32, u32) {
    let first = least + choices.choose(3);
    (first, first + choices.choose(3))
}

/// A formula of one state.
pub fn condition(choices: &mut impl Choices, names: u32, operators: u32) -> String {
    if operators == 0 {
        return leaf(choices, names);
    }
    let rest = operators - 1;
    match choices.choose(5) {
        0 => leaf(choices, names),
        1 => format!("!({})", condition(choices, names, rest)),
        other => {
            let operator = ["&&", "||", "=>"][other as usize - 2];
            let left = choices.choose(rest + 1);
            let before = condition(choices, names, left);
            format!("({before}) {operator} ({})", condition(choices, names, rest - left))
        }
    }
}

fn leaf(choices: &mut impl Choices, names: u32) -> String {
    match choices.choose(16) {
        14 => "true".to_owned(),
        15 => "false".to_owned(),
        other => NAMES[(other % names) as usize].to_owned(),
    }
}

/// A trace of 1 to `longest` instants: the robustness of each of [`NAMES`], a small whole number.
pub fn trace(choices: &mut impl Choices, longest: u32) -> Vec<[f64; 5]> {
    let length = 1 + choices.choose(longest);
    (0..length).map(|_| [(); 5].map(|()| f64::from(choices.choose(7)) - 2.5)).collect()
}

/// The place among [`NAMES`] of each proposition.
pub fn places(propositions: &[Proposition]) -> Vec<usize> {
    let place = |one: &Proposition| NAMES.iter().position(|name| one == name).unwrap_or(0);
    propositions.iter().map(place).collect()
}
