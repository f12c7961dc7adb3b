//! Reads automata in the Hanoi Omega-Automata format, versions 1 and 1.1, as Spot, Owl and others
//! write it (Babiak and others, "The Hanoi Omega-Automata Format", 2015).
//!
//! # What is read
//!
//! An automaton that a formula of the language could have: deterministic, and once it accepts, it
//! accepts for good. HOA describes automata on infinite words; three readings for finite traces are
//! understood, and they agree for such automata. *Finite-trace*: a trace is accepted if its run
//! ends in an accepting state. *Büchi*, `Inf(0)`: the states in set 0 accept. *Co-Büchi*, `Fin(0)`:
//! the states outside set 0 accept.
//!
//! Letters without a transition lead to a trap. Acceptance marks may stand on states, or on edges
//! where both readings agree: the edges into and among the accepting states carry them, and no
//! others. Where the marks do not say it so, but the automaton accepts infinite words and is
//! *terminal*, a trace is accepted once it has entered the closed accepting set; marks on states
//! alone are taken so only if the `properties:` have `terminal`. Everything else is refused with the
//! reason, and often with the option of Spot that helps.
//!
//! The result is minimal and canonical, so it equals the automaton of the formula byte for byte.
//!
//! # Bounds
//!
//! Labels are Boolean functions from the start, never lists of letters. Nothing recurses on the
//! input's nesting, and memory is bounded by the length of the text, not by the numbers in its
//! headers: a file that announces a billion states costs nothing.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! // The automaton of `F a`, as Spot writes it.
//! let text = "
//!     HOA: v1
//!     name: \"Fa\"
//!     States: 2
//!     Start: 1
//!     AP: 1 \"a\"
//!     Acceptance: 1 Inf(0)
//!     --BODY--
//!     State: 0 {0}
//!     [t] 0
//!     State: 1
//!     [0] 0
//!     [!0] 1
//!     --END--
//! ";
//! let automaton = hoa::read(&Source::new("eventually.hoa", text)).unwrap();
//! assert_eq!(automaton.name.as_deref(), Some("Fa"));
//! assert_eq!((automaton.dfa.len(), automaton.dfa.accepting), (2, Some(1)));
//! ```

mod accept;
mod body;
mod header;
mod label;
mod terminal;
mod token;

use crate::dfa::Dfa;
use crate::error::{Error, Kind};
use crate::minimize::minimize;
use crate::source::{Source, Span};

/// The most propositions that are read. Formulas written by hand have a few dozen; the bound keeps
/// every walk over a diagram, which recurses once a level, within a small stack.
pub const MOST_PROPOSITIONS: usize = 512;
/// The most nodes that the decision diagrams of all labels and transitions may have together. With
/// their tables they take about 100 MB at most.
pub const MOST_NODES: usize = 2_000_000;

/// An automaton together with its name.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// The `name:` of the header, if there is one.
    pub name: Option<String>,
    /// The minimal automaton, over the propositions of `AP:` in their order.
    pub dfa: Dfa,
}

/// Reads one automaton.
///
/// ```
/// use tltl_compiler::{hoa, source::Source};
///
/// // `G a` accepts as long as it waits: no finite trajectory ever establishes it.
/// let text = "HOA: v1 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0) --BODY-- State: 0 {0} [0] 0 --END--";
/// let error = hoa::read(&Source::new("always.hoa", text)).unwrap_err();
/// assert_eq!(error.kind().name(), "automaton");
/// ```
///
/// # Errors
/// If the text is not HOA, or the automaton is not one that a formula could have: not
/// deterministic, alternating, of another acceptance, or with an accepting state that can be left.
pub fn read(source: &Source) -> Result<Automaton, Error> {
    let mut tokens = token::Tokens::new(source.text())?;
    let mut header = header::read(&mut tokens)?;
    let body = body::read(&mut tokens, &mut header)?;
    tokens.finish()?;
    let dfa = accept::finish(&mut header, body)?;
    Ok(Automaton { name: header.name, dfa: minimize(&dfa) })
}

/// The error for a text that is not HOA.
fn syntax(message: impl Into<String>, span: Span) -> Error {
    Error::new(Kind::Syntax, message, span)
}

/// The error for an automaton that cannot be used.
fn refused(message: impl Into<String>, span: Span) -> Error {
    Error::new(Kind::Automaton, message, span)
}
