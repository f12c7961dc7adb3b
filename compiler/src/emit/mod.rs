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
//! | `typed` | formulas as types |
//!
//! Every function here depends on its arguments alone: the same automaton gives the same bytes.
//! Generated code has no `unsafe`, allocates nothing, and refers to nothing but `core`, the runtime
//! and the author's own names.
//!
//! The compiler does not depend on the runtime: the names that appear in generated code are the
//! contract between the two, and the tests that compile generated code guard it.

mod declare;
#[cfg(feature = "hoa")]
pub mod foreign;
mod implementation;
mod names;
mod predicates;
pub mod rust;
pub mod tables;
mod typed;
