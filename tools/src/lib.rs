//! What stands around the compiler: the command-line tool `tltlc`, and its parts as a library.
//!
//! [`emit`] draws automata and writes them in the formats of other tools, and turns saved policies
//! into Rust. [`explain`] and [`diff`] say what an automaton asks for, and where two differ;
//! [`product`] runs automata side by side. [`semantics`] is what a formula means on a trace, the
//! oracle of the tests; [`task`] compiles formulas and task files while a program runs and finds, binds
//! and runs their tasks, [`evaluate`] reads whole columns of recorded states for them, [`tables`]
//! makes the runtime's automata; [`trace`] finds the shortest trajectories.
//! [`vacuity`] finds the parts of a formula that could be left out, [`format`](mod@format) lays out task files.
//! [`cli`] is all of it on the command line.
//!
//! Nothing that a user of the macros builds depends on this package.

pub mod cli;
pub mod diff;
pub mod emit;
pub mod evaluate;
pub mod explain;
pub mod format;
pub mod product;
pub mod semantics;
pub mod tables;
pub mod task;
pub mod trace;
pub mod vacuity;
