//! Compiles scTLTL task specifications to minimal automata and Rust source.

pub mod dfa;
pub mod guard;
pub mod minimize;
pub mod product;
pub mod semantics;
pub mod source;
pub mod spec;
pub mod translate;
