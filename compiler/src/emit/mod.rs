//! Automata in the forms that people and other tools read, one module each.
//!
//! Every function here is a function of its arguments alone: same automaton, same bytes.

pub mod dot;
pub mod edge;
pub mod hoa;
#[cfg(feature = "cli")]
pub mod json;
mod layout;
pub mod mermaid;
#[cfg(feature = "cli")]
pub mod policy;
pub mod predicates;
pub mod rust;
pub mod sum;
pub mod svg;
pub mod tables;
pub mod text;
