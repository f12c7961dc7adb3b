//! Temporal-logic tasks for reinforcement learning.
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

pub mod automaton;
pub mod robustness;
pub mod task;

pub use automaton::Automaton;
pub use robustness::{Boolean, Predicate};
pub use task::{Formula, Monitor, Task};
#[cfg(feature = "macros")]
pub use tltl_macros::{include_tltl, tltl};
