//! Temporal-logic tasks for reinforcement learning.
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "alloc")]
pub mod augmented;
pub mod automaton;
#[cfg(feature = "std")]
pub mod checkpoint;
#[cfg(feature = "alloc")]
pub mod compose;
#[cfg(feature = "alloc")]
pub mod controller;
#[cfg(feature = "alloc")]
pub mod env;
#[cfg(feature = "std")]
pub mod estimate;
pub mod factored;
#[cfg(feature = "alloc")]
pub mod learn;
#[cfg(feature = "alloc")]
pub mod model;
#[cfg(feature = "alloc")]
pub mod policy;
#[doc(hidden)]
pub mod private;
#[cfg(feature = "alloc")]
pub mod product;
#[cfg(feature = "alloc")]
pub mod q;
pub mod robustness;
#[cfg(feature = "alloc")]
pub mod shield;
#[cfg(feature = "alloc")]
pub mod solve;
pub mod task;

/// The crate whose `Rng` trait the environments and learners take their randomness from.
#[cfg(feature = "alloc")]
pub use rand;

pub use automaton::Automaton;
pub use factored::Factored;
pub use robustness::{Boolean, Predicate};
pub use task::{Formula, Monitor, Task};
#[cfg(feature = "macros")]
pub use tltl_macros::{include_tltl, tltl};
