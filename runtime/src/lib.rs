//! Temporal-logic tasks for reinforcement learning: *fetch a, then b, never touch c before that*.
//!
//! A task is a formula that `tltl!` (or, from a file, `include_tltl!`) compiles at build time into a
//! static [`Automaton`] and typed robustness functions; this crate runs it, learns policies for it
//! and judges them. It never parses. The paper is Li, Ma, Belta: *Automata-Guided Hierarchical
//! Reinforcement Learning for Skill Composition* (arXiv 1711.00129).
//!
//! | module | what it turns into what |
//! | --- | --- |
//! | [`automaton`], [`robustness`], [`task`], [`factored`] | states into automaton moves and robustness; no allocation |
//! | [`monitor`] | what all the rest needs of a task: [`Acceptor`], and [`Monitor`] over states of a type |
//! | `env`, `model` | a world of yours into an environment, and into exact tables |
//! | `augmented` | world × task into the FSA-augmented MDP (Definition 3), with rewards by mode |
//! | `learn`, `q` | experience into action values |
//! | `product`, `compose` | learned skills into new ones (Algorithm 2), without a step in the world |
//! | `solve`, `estimate` | any policy into its certificate: P(satisfied), E\[steps\], regret |
//! | `falsify` | a controller of continuous actions into the starts and disturbances from which it does worst |
//! | `deep` | experience of worlds whose states have no numbers into networks, and networks into new ones |
//! | `policy`, `network`, `controller`, `shield`, `checkpoint`, `file` | results into what runs, is safe, and is kept |
//!
//! Every function of the rooms that learn, or that few tasks need, is `#[inline]`, long ones too:
//! rustc then makes its code where it is called, and not in each cold build of a crate that only
//! monitors (two fifths of the CPU time of building this crate).
//!
//! Features: `std` and `macros` are on; `alloc` is all that owns tables; `serde` saves and loads;
//! `libm` has `sqrt` and the like without `std`; `deep` learns with networks (Rust 1.95); `falsify`
//! searches for a controller's worst starts; `hoa` lets `include_tltl!` read automata of other tools. Where tasks are only followed, `macros` alone is enough, and builds quickest: no allocation, no `std`.
//!
//! ```
//! use tltl::prelude::*;
//!
//! /// Ten cells in a row; a step goes wrong one time in ten.
//! struct Row;
//!
//! impl FiniteModel for Row {
//!     type State = i32;
//!     fn states(&self) -> usize {
//!         10
//!     }
//!     fn actions(&self) -> usize {
//!         2
//!     }
//!     fn state(&self, s: usize) -> i32 {
//!         s as i32
//!     }
//!     fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
//!         let (left, right) = (s.saturating_sub(1), (s + 1).min(9));
//!         let p = [0.9, 0.1][a];
//!         outcome(left, p);
//!         outcome(right, 1.0 - p);
//!     }
//! }
//!
//! // First the right end, later the left one.
//! let phi = tltl! { |x: &i32| ({ *x } == 9) T ({ *x } == 0) };
//! let mut env = ModelEnv::new(Row)?;
//! let task = Labelled::of_env(&env, &phi)?;
//! let mut learner = Learner::new(&task, Settings::default(), 1);
//! learner.train(&mut env, 100_000)?;
//!
//! // What is it worth, against the exact optimum?
//! let problem = Problem::new(env.dynamics(), &task)?;
//! let certificate = learner.certify(&problem)?;
//! assert!(certificate.satisfied > 0.999 && certificate.regret_steps < Some(0.01));
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(missing_debug_implementations)]
#![no_std]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(feature = "std")]
extern crate std;

#[cfg(feature = "alloc")]
pub mod augmented;
pub mod automaton;
#[cfg(feature = "alloc")]
mod certificate;
#[cfg(feature = "std")]
pub mod checkpoint;
#[cfg(feature = "alloc")]
mod checksum;
#[cfg(feature = "alloc")]
pub mod compose;
#[cfg(feature = "alloc")]
pub mod controller;
#[cfg(feature = "deep")]
pub mod deep;
#[cfg(feature = "alloc")]
pub mod env;
#[cfg(feature = "alloc")]
pub mod episode;
#[cfg(feature = "std")]
pub mod estimate;
#[cfg(feature = "alloc")]
mod experience;
pub mod factored;
#[cfg(feature = "falsify")]
pub mod falsify;
#[cfg(feature = "std")]
pub mod file;
mod formula;
#[cfg(feature = "alloc")]
mod interner;
#[cfg(feature = "alloc")]
pub mod learn;
#[cfg(feature = "alloc")]
mod mismatch;
#[cfg(feature = "alloc")]
pub mod model;
pub mod monitor;
#[cfg(feature = "alloc")]
pub mod network;
#[cfg(feature = "alloc")]
pub mod policy;
pub mod prelude;
#[doc(hidden)]
pub mod private;
#[cfg(feature = "alloc")]
pub mod product;
#[cfg(feature = "alloc")]
pub mod q;
#[cfg(feature = "alloc")]
mod range;
#[cfg(feature = "alloc")]
pub mod reward;
pub mod robustness;
#[cfg(feature = "alloc")]
mod settings;
mod shared;
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
#[cfg(feature = "alloc")]
pub use mismatch::Mismatch;
pub use monitor::{Acceptor, Monitor};
#[cfg(feature = "alloc")]
pub use range::OutOfRange;
pub use robustness::{Boolean, Predicate};
pub use shared::Shared;
pub use task::{Formula, Task};
/// A task file, or an automaton of another tool, as a module of tasks.
///
/// ```
/// use tltl::Acceptor;
///
/// // pub mod gridworld { pub struct Cell { … }, a function for each predicate and task }
/// tltl::include_tltl!("../examples/tasks/gridworld.tltl");
/// use gridworld::{Cell, visit_a_b};
///
/// let walk = [Cell { x: 0, y: 0 }, Cell { x: 5, y: 5 }, Cell { x: 2, y: 2 }];
/// assert_eq!(visit_a_b().satisfied(&walk), Ok(true));
/// assert_eq!(visit_a_b().name(), "visit_a_b");
/// ```
#[cfg(feature = "macros")]
pub use tltl_macros::include_tltl;
/// A formula as a task, or declarations of predicates and tasks as functions.
///
/// ```
/// use tltl::{Acceptor, Boolean, tltl};
///
/// struct Robot {
///     x: f64,
///     wet: bool,
/// }
///
/// // Names are predicates in scope: here functions that give a robustness, and one that gives a truth.
/// let (near, far) = (|s: &Robot| 1.0 - s.x, |s: &Robot| s.x - 3.0);
/// let wet = Boolean::new(|s: &Robot| s.wet);
/// let there_and_back = tltl! { (far T near) && (!wet U near) };
///
/// // With a header, comparisons of the state's fields; with a string, the symbols of the paper.
/// let again = tltl! { |s: &Robot| (s.x > 3 T s.x < 1) && (!s.wet U s.x < 1) };
/// let once_more = tltl! { "(far T near) ∧ (¬wet U near)" };
///
/// // Declarations are items: `dock(&Robot) -> f64`, and a function that gives the task.
/// tltl! {
///     state s: Robot;
///     predicate dock = s.x < 1;
///     task come = F dock;
/// }
///
/// let walk = [4.0, 2.0, 0.5].map(|x| Robot { x, wet: false });
/// assert_eq!(there_and_back.robustness(&walk), again.robustness(&walk));
/// assert_eq!((once_more.satisfied(&walk), come().satisfied(&walk)), (Ok(true), Ok(true)));
/// assert_eq!((dock(&walk[2]), come().states()), (0.5, 2));
/// ```
#[cfg(feature = "macros")]
pub use tltl_macros::tltl;

/// The example of the README runs.
#[cfg(all(doctest, feature = "std", feature = "macros"))]
#[doc = include_str!("../../README.md")]
pub struct Readme;
