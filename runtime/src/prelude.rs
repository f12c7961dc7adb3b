//! The names that most programs need: `use tltl::prelude::*;`.
//!
//! Traits whose methods are called, macros, and the types of the main line: a world, a task on it, a
//! learner, its certificate. At most twenty, which a test counts, so that a glob import hides few names of
//! a program's own; everything else is imported from its module.
//!
//! ```
//! use tltl::prelude::*;
//!
//! let task = tltl! { |x: &f64| F ({ *x } > 3) };
//! let q = task.next(0, &4.0)?; // `Monitor`
//! assert!(task.is_accepting(q)); // `Acceptor`
//! # Ok::<(), tltl::task::Error>(())
//! ```

#[cfg(feature = "alloc")]
pub use crate::augmented::Labelled;
#[cfg(feature = "alloc")]
pub use crate::compose::{Combine, Composition};
#[cfg(feature = "alloc")]
pub use crate::env::{Env, FiniteEnv, ModelEnv, Step};
#[cfg(feature = "alloc")]
pub use crate::learn::{Learner, Settings};
#[cfg(feature = "alloc")]
pub use crate::model::{Dynamics, FiniteModel};
pub use crate::monitor::{Acceptor, Monitor};
#[cfg(feature = "alloc")]
pub use crate::policy::Policy;
#[cfg(feature = "alloc")]
pub use crate::product::Product;
#[cfg(feature = "alloc")]
pub use crate::q::QTable;
#[cfg(feature = "alloc")]
pub use crate::reward::Rewards;
#[cfg(feature = "alloc")]
pub use crate::solve::Problem;
#[cfg(feature = "macros")]
pub use tltl_macros::{include_tltl, tltl};
