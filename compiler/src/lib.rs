//! Compiles scTLTL task specifications to minimal automata and Rust source.
//!
//! # The pipeline
//!
//! ```text
//! Source ─ parse ─> Ast ─ resolve ─> Resolved ─ check ─> Module { predicates, tasks: Spec }
//!                                     │
//!                     Spec ─ translate ─> Dfa ─ minimize ─> Dfa      (predicates as propositions)
//!                                     │                      │
//!                     Module ─ arithmetic ─> possible ─ restrict, minimize ─> Dfa
//!                                                                            │
//!                                              emit::rust <── Tables <─ tables
//! ```
//!
//! [`compile`] runs it from end to end. A stage is a module, a function and a type; a later stage
//! never asks whether an earlier one did its work: a [`spec::Spec`] *is* typed, in negation normal
//! form and co-safe, a minimal [`dfa::Dfa`] *is* canonical. Everything depends on the source alone:
//! no clock, no randomness, no order of hashes. Expressions, formulas and diagrams live in arenas
//! of ids, operands first, so no pass recurses on what an author nests.
//!
//! Beside the pipeline stand [`factor`] (a conjunction taken apart), [`judge`] (predicates and
//! tasks that can never hold) and `hoa` (automata of other tools, with the feature of that name).
//! Every user of the macros builds this crate, so the parts that only the command line needs
//! (warnings, pictures, other formats, explanations) are in the package `tltlc`.
//!
//! The compiler never learns, and does not know the runtime: the Rust that it writes is their only
//! contract.
//!
//! # Where to change what
//!
//! | to change | start at |
//! | --- | --- |
//! | the syntax | `grammar.pest`, [`parse`], [`ast`] |
//! | what names mean | [`resolve`] |
//! | types, units, co-safety | [`check`] |
//! | a law of the logic | [`spec`], and [`translate`] for a new operator |
//! | what is known about numbers | [`arithmetic`], [`linear`] |
//! | generated code | [`tables`], [`emit`] |
//! | a message | the module that finds the mistake; [`error`] for the layout |
//!
//! ```
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let source = Source::new("formula", "F a && F b && F c");
//! let compiled = compile::formula(&source, Budget::SHOWN)?;
//! let size = compiled.automata[0].dfa.size();
//! assert_eq!((size.states, size.edges, size.self_loops), (8, 19, 8));
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]

mod arena;
pub mod arithmetic;
pub mod ast;
pub mod bdd;
pub mod check;
pub mod compile;
pub mod dfa;
pub mod emit;
pub mod error;
pub mod factor;
mod grammar;
#[cfg(feature = "hoa")]
pub mod hoa;
mod intern;
pub mod judge;
pub mod linear;
pub mod minimize;
pub mod parse;
pub mod predicate;
pub mod proposition;
mod reserved;
pub mod resolve;
pub mod source;
pub mod spec;
pub mod tables;
mod token;
pub mod translate;
pub mod unit;
