//! Guards as text: sums of products over the names of the propositions.
//!
//! Every form of an automaton prints its guards through [`Sum`], or all edges in one go through
//! [`Labels`](super::labels::Labels). In [`Notation::Ascii`] the text is a formula of the language
//! again: a proposition may be a comparison (`x < 3`), and gets brackets where the language needs
//! them. Automata of other tools may name a proposition in a way that no formula can (`p 1`); such
//! names are quoted.
//!
//! The cubes come from the compiler (Minato, 1993; see [`bdd`](tltl_compiler::bdd)) and are printed
//! in its order.

use std::borrow::Cow;
use std::fmt;

use tltl_compiler::bdd::Cube;
use tltl_compiler::dfa::{Dfa, Edge};
use tltl_compiler::proposition::{Proposition, Shape};

/// The symbols in which a guard is printed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Notation {
    /// `!a && b || c`, the spelling of the language.
    #[default]
    Ascii,
    /// `¬a ∧ b ∨ c`, the spelling of the paper.
    Mathematical,
    /// `!0&1 | 2`: propositions by number, the spelling of HOA.
    Numbered,
}

impl Notation {
    pub(super) fn and(self) -> &'static str {
        match self {
            Self::Ascii => " && ",
            Self::Mathematical => " ∧ ",
            Self::Numbered => "&",
        }
    }

    /// The symbol between two products, with the blanks around it.
    #[must_use]
    pub fn or(self) -> &'static str {
        match self {
            Self::Ascii => " || ",
            Self::Mathematical => " ∨ ",
            Self::Numbered => " | ",
        }
    }

    fn not(self) -> &'static str {
        if self == Self::Mathematical { "¬" } else { "!" }
    }

    pub(super) fn truth(self, value: bool) -> &'static str {
        match (self, value) {
            (Self::Ascii, true) => "true",
            (Self::Ascii, false) => "false",
            (Self::Mathematical, true) => "⊤",
            (Self::Mathematical, false) => "⊥",
            (Self::Numbered, true) => "t",
            (Self::Numbered, false) => "f",
        }
    }
}

/// A guard that prints as a sum of products: an empty sum is false, an empty product true.
///
/// ```
/// use tltl_compiler::proposition::{Proposition, Shape};
/// use tltlc::emit::sum::{Notation, Sum};
///
/// let comparison = Proposition { name: "x < 3".to_owned(), shape: Shape::Comparison };
/// let propositions = [Proposition::from("a"), comparison];
/// let cubes = [vec![(0, true), (1, false)], vec![(0, false)]];
/// let sum = Sum::new(&propositions, &cubes);
/// assert_eq!(sum.to_string(), "a && !(x < 3) || !a");
/// assert_eq!(sum.notation(Notation::Mathematical).to_string(), "a ∧ ¬(x < 3) ∨ ¬a");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sum<'a> {
    propositions: &'a [Proposition],
    cubes: &'a [Cube],
    notation: Notation,
}

impl<'a> Sum<'a> {
    /// The sum of `cubes` over these propositions, in [`Notation::Ascii`].
    #[must_use]
    pub fn new(propositions: &'a [Proposition], cubes: &'a [Cube]) -> Self {
        Self { propositions, cubes, notation: Notation::Ascii }
    }

    /// The same sum in other symbols.
    #[must_use]
    pub fn notation(self, notation: Notation) -> Self {
        Self { notation, ..self }
    }

    /// The products, each as text: a drawing wraps between them.
    pub fn products(self) -> impl Iterator<Item = String> + use<'a> {
        self.cubes.iter().map(move |cube| self.product(cube))
    }

    /// A product as text.
    fn product(self, cube: &Cube) -> String {
        if cube.is_empty() {
            return self.notation.truth(true).to_owned();
        }
        let literals: Vec<_> = cube.iter().map(|&literal| self.literal(literal)).collect();
        literals.join(self.notation.and())
    }

    /// A literal as text, in brackets where `!` would bind tighter than the operators of the
    /// proposition.
    pub(super) fn literal(self, (proposition, value): (u32, bool)) -> String {
        let not = if value { "" } else { self.notation.not() };
        if self.notation == Notation::Numbered {
            return format!("{not}{proposition}");
        }
        let Proposition { name, shape } = &self.propositions[proposition as usize];
        let shown = match self.notation {
            Notation::Mathematical => mathematical(name),
            _ => Cow::Borrowed(name.as_str()),
        };
        match (shape, value) {
            (Shape::Atom, _) | (Shape::Comparison, true) => format!("{not}{shown}"),
            (Shape::Comparison, false) | (Shape::Compound, _) => format!("{not}({shown})"),
            (Shape::Foreign, _) => format!("{not}{}", quoted(name)),
        }
    }
}

impl fmt::Display for Sum<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.cubes.is_empty() {
            return f.write_str(self.notation.truth(false));
        }
        let products: Vec<_> = self.products().collect();
        f.write_str(&products.join(self.notation.or()))
    }
}

/// The guard of an edge as text.
#[must_use]
pub fn label(dfa: &Dfa, edge: &Edge, notation: Notation) -> String {
    Sum::new(&dfa.propositions, &edge.guard).notation(notation).to_string()
}

/// A name in double quotes, with `\` and `"` escaped as HOA, JSON and Graphviz want.
#[must_use]
pub fn quoted(name: &str) -> String {
    format!("\"{}\"", escaped(name))
}

/// The same without the quotes around it.
pub(super) fn escaped(text: &str) -> String {
    text.replace('\\', "\\\\").replace('"', "\\\"")
}

/// A name with the symbols of mathematics for its operators.
fn mathematical(name: &str) -> Cow<'_, str> {
    let symbols = [("<=", "≤"), (">=", "≥"), ("==", "="), ("!=", "≠"), ("&&", "∧"), ("||", "∨")];
    symbols.iter().fold(Cow::Borrowed(name), |name, (from, to)| {
        if name.contains(from) { Cow::Owned(name.replace(from, to)) } else { name }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn print(cubes: &[Cube], notation: Notation) -> String {
        use Shape::{Atom, Comparison, Compound, Foreign};
        let propositions = [
            ("a", Atom),
            ("s.x < 3", Comparison),
            ("p 1", Foreign),
            ("f(x, y)[2]", Atom),
            ("a || b", Compound),
            ("x <= y", Comparison),
            ("F", Foreign),
            ("{ x }", Atom),
            ("a=1", Foreign),
        ];
        let propositions =
            propositions.map(|(name, shape)| Proposition { name: name.to_owned(), shape });
        Sum::new(&propositions, cubes).notation(notation).to_string()
    }

    #[test]
    fn brackets_only_where_the_language_needs_them() {
        let cubes = [vec![(0, false), (1, true)], vec![(1, false), (3, false)]];
        assert_eq!(print(&cubes, Notation::Ascii), "!a && s.x < 3 || !(s.x < 3) && !f(x, y)[2]");
        let cubes = [vec![(4, true), (5, false)], vec![(7, false)]];
        assert_eq!(print(&cubes, Notation::Ascii), "(a || b) && !(x <= y) || !{ x }");
        assert_eq!(print(&cubes, Notation::Mathematical), "(a ∨ b) ∧ ¬(x ≤ y) ∨ ¬{ x }");
        assert_eq!(print(&cubes, Notation::Numbered), "4&!5 | !7");
    }

    #[test]
    fn names_that_no_formula_has_are_quoted() {
        let cubes = [vec![(2, false), (6, true), (8, true)]];
        assert_eq!(print(&cubes, Notation::Ascii), r#"!"p 1" && "F" && "a=1""#);
    }

    #[test]
    fn constants() {
        assert_eq!(print(&[], Notation::Ascii), "false");
        assert_eq!(print(&[vec![]], Notation::Ascii), "true");
        assert_eq!(print(&[vec![]], Notation::Numbered), "t");
    }
}
