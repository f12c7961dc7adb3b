//! The library behind the command-line tool `tltlc`: everything around the compiler that a user of
//! the macros does not build.
//!
//! It serves three users: the binary `tltlc`, the Python wheel, and Rust programs whose formulas
//! arrive while they run. It may depend on the compiler and on the runtime; neither depends on it.
//!
//! | module | turns | into |
//! | --- | --- | --- |
//! | [`task`] | a formula or a task file, read at run time | tasks that run, checked and bound to arguments |
//! | [`evaluate`] | the predicates of a task, and columns of recorded states | truth values, robustness |
//! | [`tables`] | the compiler's automaton | the runtime's automaton, owned |
//! | [`explain`] | a task | plain English, shortest trajectories, a line for each state |
//! | [`diff`](mod@diff) | two automata | "equal", or a shortest trajectory on which they differ |
//! | [`product`](mod@product) | automata side by side | one automaton that knows the state of each |
//! | [`trace`] | an automaton and a goal | the shortest trajectory that reaches it |
//! | [`lint`] | a source and what it compiles to | warnings about what is hardly meant |
//! | [`format`](mod@format) | a task file | the same file, laid out |
//! | [`online`] | states, one after the other | the robustness of the trajectory so far |
//! | [`report`] | a task and its trajectories | a page for a browser |
//! | [`names`] | the names of a task file | declarations, uses, other names |
//! | [`lsp`] | messages of an editor | diagnostics, explanations, completions |
//! | [`emit`] | automata, saved policies | pictures, HOA, JSON, Graphviz, Mermaid, Rust |
//! | [`semantics`] | a formula and a trajectory | its verdict and robustness by definition: the oracle of the tests |
//! | [`cli`] | arguments and streams | output and an exit code |
//!
//! Everything is a function of its arguments: the same input gives the same bytes. Only [`cli`]
//! reads and writes files, and nothing here opens a network connection, reads a clock or starts a
//! thread.
//!
//! ```
//! use tltl::{Acceptor, Monitor};
//! use tltl_compiler::translate::Budget;
//! use tltlc::{explain, task};
//!
//! // A formula that is known only while the program runs.
//! let task = task::compile("!wet U (x > 2)", Budget::default())?;
//! // Its automaton as a table of text, with guards over `wet` and `x > 2`.
//! let shown = tltlc::emit::text::automaton("stay dry", task.dfa());
//! assert!(shown.contains("x > 2"));
//! // A shortest way to lose it.
//! let explained = explain::explain(&task.entry().task().spec, task.dfa());
//! assert_eq!(explained.losing.map(|trace| trace.to_string()).as_deref(), Some("{wet}"));
//! // A state is a row of numbers, in the order of `task.inputs()`: x, and `wet` by its robustness.
//! assert!(task.is_accepting(task.next(0, &[2.5, -1.0])?));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]

pub mod cli;
pub mod diff;
pub mod emit;
pub mod evaluate;
pub mod explain;
pub mod format;
pub mod lint;
pub mod lsp;
pub mod names;
pub mod online;
pub mod product;
pub mod report;
pub mod semantics;
pub mod tables;
pub mod task;
pub mod trace;
