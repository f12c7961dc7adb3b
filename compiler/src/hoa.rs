//! Reads automata in the Hanoi Omega-Automata format, version 1, as Spot, Owl and others write it.
//!
//! What is read must be what a formula could be: deterministic, and once it accepts, it accepts
//! for good. Three ways to say so are understood, and mean the same here. *Finite-trace*: a
//! trace is accepted if its run ends in an accepting state. *Büchi*, `Inf(0)`: the states in set 0
//! accept. *Co-Büchi*, `Fin(0)`: the states outside set 0 accept. Letters without a
//! transition lead to a trap. Acceptance marks may stand on states, or on edges where both
//! readings of them agree: the edges into and among the accepting states carry them, and no
//! others. The result is minimal and canonical, so that it equals the automaton of the formula.
//!
//! Labels are Boolean functions from the start, never lists of letters; nothing here recurses on
//! the input's nesting, and its size is bounded by what the input says, not by its
//! headers' numbers.

mod accept;
mod body;
mod header;
mod label;
mod token;

use crate::dfa::Dfa;
use crate::error::{Error, Kind};
use crate::minimize::minimize;
use crate::source::{Source, Span};

/// The most propositions that are read.
pub const MOST_PROPOSITIONS: usize = 512;
/// The most nodes that the labels' decision diagrams may have together.
pub const MOST_NODES: usize = 2_000_000;

/// An automaton and what it is called.
#[derive(Clone, Debug)]
pub struct Automaton {
    /// The `name:` of the header, if there is one.
    pub name: Option<String>,
    /// The minimal automaton, over the propositions of `AP:` in their order.
    pub dfa: Dfa,
}

/// Reads one automaton.
///
/// # Errors
/// If the text is not HOA, or the automaton is not one that a formula could have: not
/// deterministic, alternating, of another acceptance, or accepting without staying so.
pub fn read(source: &Source) -> Result<Automaton, Error> {
    let mut tokens = token::Tokens::new(source.text())?;
    let mut header = header::read(&mut tokens)?;
    let body = body::read(&mut tokens, &mut header)?;
    tokens.finish()?;
    let dfa = accept::finish(&mut header, body)?;
    Ok(Automaton { name: header.name, dfa: minimize(&dfa) })
}

fn syntax(message: impl Into<String>, span: Span) -> Error {
    Error::new(Kind::Syntax, message, span)
}

fn refused(message: impl Into<String>, span: Span) -> Error {
    Error::new(Kind::Automaton, message, span)
}
