//! Guards as text: sums of products over the names of the propositions.
//!
//! Every form of an automaton prints its guards through [`Sum`], or all edges in one go through
//! [`Labels`]. In [`Notation::Ascii`] the text is a formula of the language again: a proposition may be a comparison (`x < 3`), and gets brackets
//! where the language needs them. Automata of other tools may name a proposition in a way that no
//! formula can (`p 1`); such names are quoted.
//!
//! The cubes come from the compiler (Minato, 1993; see [`bdd`](tltl_compiler::bdd)) and are printed
//! in its order.

use std::borrow::Cow;
use std::fmt;

use tltl_compiler::bdd::{Cover, Cube};
use tltl_compiler::dfa::{Dfa, Edge, Guards, State};
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
    fn literal(self, (proposition, value): (u32, bool)) -> String {
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

/// The most products that the guards of one automaton may have where they are written out. Twelve
/// unordered goals have half as many, which are 50 MB of JSON.
pub const MOST_PRODUCTS: usize = 1 << 20;

/// The guards of an automaton have more than [`MOST_PRODUCTS`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TooLarge {
    /// How many they have at least; `usize::MAX` if nobody counted.
    pub products: usize,
}

impl fmt::Display for TooLarge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (least, products) = match self.products {
            usize::MAX => ("more than", MOST_PRODUCTS),
            products => ("at least", products),
        };
        write!(
            f,
            "the guards of this automaton have {least} {products} products, and at most \
             {MOST_PRODUCTS} are written out"
        )
    }
}

impl std::error::Error for TooLarge {}

/// The edges of an automaton with their guards as text, one after the other.
///
/// The text of a guard is put together from those of its literals, in a buffer that all edges
/// share: an automaton of half a million edges is written as fast as its text can be copied.
pub struct Labels<'a> {
    dfa: &'a Dfa,
    guards: Guards<'a>,
    /// For each proposition the text of its negation, and its own.
    literals: Vec<[String; 2]>,
    /// The texts of ∧, ∨, ⊤ and ⊥.
    symbols: [String; 4],
}

impl<'a> Labels<'a> {
    /// The labels of `dfa`. `escape` makes of a literal, an operator or a constant what the format
    /// around it wants.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::emit::sum::{Labels, Notation};
    ///
    /// let task = tltlc::task::compile("!wet U home", Budget::default())?;
    /// let mut edges = Vec::new();
    /// Labels::new(task.dfa(), Notation::Ascii, &str::to_owned)?
    ///     .visit(&mut |from, to, guard| edges.push(format!("{from} -> {to}: {guard}")));
    /// assert_eq!(edges[2], "0 -> 2: wet && !home");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the guards have more than [`MOST_PRODUCTS`].
    pub fn new(
        dfa: &'a Dfa,
        notation: Notation,
        escape: &dyn Fn(&str) -> String,
    ) -> Result<Self, TooLarge> {
        let size = dfa.size();
        let too_large = |products| match products {
            ..=MOST_PRODUCTS => Ok(()),
            products => Err(TooLarge { products }),
        };
        // Every edge has a product at least, and to count edges takes no guards.
        too_large(size.edges + size.self_loops)?;
        let mut guards = Guards::new(dfa);
        too_large(guards.products())?;
        let sum = Sum::new(&dfa.propositions, &[]).notation(notation);
        let literal = |proposition, value| escape(&sum.literal((proposition, value)));
        let literals = (0..dfa.propositions.len() as u32)
            .map(|proposition| [false, true].map(|value| literal(proposition, value)));
        let symbols = [notation.and(), notation.or(), notation.truth(true), notation.truth(false)];
        Ok(Self { dfa, guards, literals: literals.collect(), symbols: symbols.map(escape) })
    }

    /// Visits all edges, self-loops included, by rising states.
    pub fn visit(mut self, edge: &mut dyn FnMut(State, State, &str)) {
        let mut label = String::new();
        for from in self.dfa.states() {
            for (to, guard) in self.guards.edges(from) {
                label.clear();
                self.write(guard, &mut label);
                edge(from, to, &label);
            }
        }
    }

    /// Appends a guard.
    fn write(&self, guard: Cover, label: &mut String) {
        let [and, or, truth, falsity] = &self.symbols;
        if guard == Cover::FALSE {
            label.push_str(falsity);
        }
        self.guards.visit(guard, &mut |cube| {
            label.push_str(if label.is_empty() { "" } else { or });
            label.push_str(if cube.is_empty() { truth } else { "" });
            for (place, &(proposition, value)) in cube.iter().enumerate() {
                label.push_str(if place == 0 { "" } else { and });
                label.push_str(&self.literals[proposition as usize][usize::from(value)]);
            }
        });
    }
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
