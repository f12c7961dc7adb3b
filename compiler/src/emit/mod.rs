//! Automata in the forms that people and other tools read, one module each.
//!
//! Every function here is a function of its arguments alone: same automaton, same bytes.

#[cfg(feature = "cli")]
pub mod dot;
pub mod edge;
pub mod foreign;
#[cfg(feature = "cli")]
pub mod hoa;
mod implementation;
#[cfg(feature = "cli")]
pub mod json;
#[cfg(feature = "cli")]
mod layout;
#[cfg(feature = "cli")]
pub mod mermaid;
#[cfg(feature = "cli")]
pub mod network;
#[cfg(feature = "cli")]
pub mod policy;
pub mod predicates;
pub mod rust;
#[cfg(feature = "cli")]
pub mod sum;
#[cfg(feature = "cli")]
pub mod svg;
pub mod tables;
#[cfg(feature = "cli")]
pub mod text;
