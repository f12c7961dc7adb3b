//! Guards as text: sums of products over the names of the propositions.
//!
//! Every form of an automaton prints its guards through [`Sum`]. In [`Notation::Ascii`] the text is
//! a formula of the language again: a proposition may be a comparison (`x < 3`), and gets brackets
//! where the language needs them. Automata of other tools may name a proposition in a way that no
//! formula can (`p 1`); such names are quoted.
//!
//! The cubes come from the compiler (Minato, 1993; see [`bdd`](tltl_compiler::bdd)) and are printed
//! in its order.

use std::borrow::Cow;
use std::fmt;

use tltl_compiler::bdd::Cube;
use tltl_compiler::dfa::{Dfa, Edge};

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
    fn and(self) -> &'static str {
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

    fn truth(self, value: bool) -> &'static str {
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
/// use tltlc::emit::sum::{Notation, Sum};
///
/// let names = ["a", "x < 3"].map(str::to_owned);
/// let cubes = [vec![(0, true), (1, false)], vec![(0, false)]];
/// let sum = Sum::new(&names, &cubes);
/// assert_eq!(sum.to_string(), "a && !(x < 3) || !a");
/// assert_eq!(sum.notation(Notation::Mathematical).to_string(), "a ∧ ¬(x < 3) ∨ ¬a");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Sum<'a> {
    names: &'a [String],
    cubes: &'a [Cube],
    notation: Notation,
}

impl<'a> Sum<'a> {
    /// The sum of `cubes`, in [`Notation::Ascii`]; `names` are the names of the propositions by
    /// number.
    #[must_use]
    pub fn new(names: &'a [String], cubes: &'a [Cube]) -> Self {
        Self { names, cubes, notation: Notation::Ascii }
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
    fn literal(self, (proposition, value): (u32, bool)) -> String {
        let not = if value { "" } else { self.notation.not() };
        if self.notation == Notation::Numbered {
            return format!("{not}{proposition}");
        }
        let name = &self.names[proposition as usize];
        let shown = match self.notation {
            Notation::Mathematical => mathematical(name),
            _ => Cow::Borrowed(name.as_str()),
        };
        match (shape(name), value) {
            (Shape::Atom, _) | (Shape::Comparison, true) => format!("{not}{shown}"),
            (Shape::Comparison, false) | (Shape::Formula, _) => format!("{not}({shown})"),
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
    format!("\"{}\"", name.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The form of a proposition's text, by what brackets it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Shape {
    /// Binds tighter than every operator: a name, a field, a call.
    Atom,
    /// A comparison.
    Comparison,
    /// Has operators that bind less tightly than a comparison.
    Formula,
    /// Is not an expression of the language.
    Foreign,
}

/// The form of a proposition. It looks only outside of brackets, and takes no parser: names of
/// other tools are no formulas.
fn shape(name: &str) -> Shape {
    let Some(outside) = outside_brackets(name) else { return Shape::Foreign };
    let keyword = matches!(name, "F" | "X" | "U" | "T" | "true" | "false" | "not" | "and" | "or");
    let starts = |c: char| c.is_alphabetic() || matches!(c, '_' | '(' | '{' | ':');
    let continues = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | ':' | '#' | '{');
    let any = |parts: &[&str]| parts.iter().any(|part| outside.contains(part));
    if !keyword && name.starts_with(starts) && outside.chars().all(continues) {
        Shape::Atom
    } else if any(&["&", "|", "∧", "∨", "=>", "⇒", "->", "!("]) || name.starts_with(['!', '¬'])
    {
        Shape::Formula
    } else if any(&["<", ">", "==", "!=", "≤", "≥", "≠"]) {
        Shape::Comparison
    } else {
        Shape::Foreign
    }
}

/// The text without the parts in brackets; `None` if the brackets do not pair.
fn outside_brackets(text: &str) -> Option<String> {
    let mut depth = 0_usize;
    let mut outside = String::new();
    for c in text.chars() {
        match c {
            '(' | '[' | '{' => depth += 1,
            ')' | ']' | '}' => depth = depth.checked_sub(1)?,
            _ if depth == 0 => outside.push(c),
            _ => {}
        }
    }
    (depth == 0 && !text.is_empty()).then_some(outside)
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
        let names = ["a", "s.x < 3", "p 1", "f(x, y)[2]", "a || b", "x <= y", "F", "{ x }", "a=1"];
        let names = names.map(str::to_owned);
        Sum::new(&names, cubes).notation(notation).to_string()
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
