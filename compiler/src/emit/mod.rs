//! A compiled source as Rust: what the macros expand to.
//!
//! | module | what it writes |
//! | --- | --- |
//! | [`rust`] | all of a source: an expression, or items |
//! | `foreign` | an automaton that came without a formula (feature `hoa`) |
//! | `declare` | the types that a source declares |
//! | `names` | names: the source's, and our own |
//! | `predicates` | conditions as expressions: robustness, and truth |
//! | `implementation` | the runtime's trait `Predicates` for the predicates of one task |
//! | [`tables`] | automata and formulas as constants |
//!
//! Every function here is a function of its arguments alone: same automaton, same bytes. What is
//! written has no `unsafe` and refers to nothing but `core`, the runtime and the author's own names.

mod declare;
#[cfg(feature = "hoa")]
pub mod foreign;
mod implementation;
mod names;
mod predicates;
pub mod rust;
pub mod tables;
