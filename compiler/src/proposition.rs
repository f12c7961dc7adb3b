//! Propositions: the names of what formulas and automata are about, each with its form.
//!
//! A name may be a comparison (`x < 3`), which wants brackets where an operator binds tighter, and
//! automata of other tools have names that no formula can have (`p 1`). Whoever makes a proposition
//! knows its form; no printer reads the name again to guess it.
//!
//! ```
//! use tltl_compiler::proposition::{Proposition, Shape};
//!
//! let goal = Proposition::from("goal");
//! assert_eq!((goal.shape, goal.to_string()), (Shape::Atom, "goal".to_owned()));
//! // The name is its identity.
//! assert_eq!(goal, Proposition { shape: Shape::Foreign, ..goal.clone() });
//! ```

use std::fmt;

/// The form of a proposition's name, by what brackets it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// Binds tighter than every operator: a name, a field, a call.
    Atom,
    /// A comparison.
    Comparison,
    /// Has operators that bind less tightly than a comparison.
    Compound,
    /// Is not an expression of the language, or one that speaks of more than one state.
    Foreign,
}

/// A proposition. Two are equal if their names are.
#[derive(Clone, Debug)]
pub struct Proposition {
    /// What it is called: its text if nobody named it.
    pub name: String,
    /// The form of the name.
    pub shape: Shape,
}

/// A proposition called by a single name.
impl From<&str> for Proposition {
    fn from(name: &str) -> Self {
        Self { name: name.to_owned(), shape: Shape::Atom }
    }
}

impl PartialEq for Proposition {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Proposition {}

impl PartialEq<&str> for Proposition {
    fn eq(&self, name: &&str) -> bool {
        self.name == *name
    }
}

impl fmt::Display for Proposition {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.name)
    }
}
