//! The names that most programs need: `use tltl::prelude::*;`.
//!
//! ```
//! use tltl::prelude::*;
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
