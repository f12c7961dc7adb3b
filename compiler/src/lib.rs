//! Compiles scTLTL task specifications to minimal automata and Rust source.

pub mod source;
pub mod spec;
