//! Automata as Rust: what the macros expand to.
//!
//! Every function here is a function of its arguments alone: same automaton, same bytes.

#[cfg(feature = "hoa")]
pub mod foreign;
mod implementation;
pub mod predicates;
pub mod rust;
pub mod tables;
