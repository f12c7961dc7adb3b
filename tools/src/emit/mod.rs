//! Automata in the forms that people and other tools read, and policies as Rust: one module each.
//!
//! Every function here is a function of its arguments alone: same automaton, same bytes.

pub mod dot;
pub mod hoa;
pub mod json;
mod layout;
pub mod mermaid;
pub mod network;
pub mod policy;
pub mod rust;
pub mod sum;
pub mod svg;
pub mod text;
