//! The bridge from Python to the crates: it converts arguments and results, and nothing else.
//!
//! | module | converts |
//! | --- | --- |
//! | `array` | every NumPy array that enters, whatever its type and strides |
//! | `states` | recorded states, as arrays or mappings, into the columns that a task reads |
//! | `labels` | what holds in a state, as mappings, names or arrays |
//! | `compiled` | what tasks of either kind, plain and factored, have in common |
//! | `task`, `batch`, `shown`, `monitor`, `product`, `factored` | tasks |
//! | `file`, `restore` | their sources |
//! | `rewards` | what moves pay |
//! | `follow`, `replay` | what steps of a world, and stored ones, are for a task |
//! | `model`, `labelled` | finite worlds, and tasks on their states |
//! | `solution`, `certificate`, `shield` | what is optimal, what policies are worth, what is allowed |
//! | `settings`, `world`, `learner`, `policy`, `network` | learning, and what is learned |
//! | `composition` | skills that become new ones |
//! | `values` | what tasks take and give, as data |
//! | `error` | mistakes of a source into exceptions and warnings |
//!
//! What a formula means, and what a task does, is in the crates `tltl-compiler`, `tltl` and
//! `tltlc`. Every argument is checked before it is passed on: a panic would become an exception
//! that `except Exception` does not catch.
#![forbid(unsafe_code)]

mod array;
mod batch;
mod certificate;
mod compiled;
mod composition;
mod document;
mod error;
mod factored;
mod file;
mod follow;
mod labelled;
mod labels;
mod learner;
mod model;
mod monitor;
mod network;
mod policy;
mod product;
mod replay;
mod restore;
mod rewards;
mod settings;
mod shield;
mod shown;
mod solution;
mod states;
mod task;
mod values;
mod world;

use std::ffi::OsString;
use std::io::{stderr, stdin, stdout};

use pyo3::prelude::*;
use tltlc::cli::{self, Output, Streams};

/// What the package imports.
#[pymodule]
mod _core {
    use super::*;

    #[pymodule_export]
    use super::certificate::{Certificate, Mistake};
    #[pymodule_export]
    use super::composition::{Composition, compose};
    #[pymodule_export]
    use super::factored::Factored;
    #[pymodule_export]
    use super::file::{Parameter, TaskFile};
    #[pymodule_export]
    use super::follow::{follow, follow_all};
    #[pymodule_export]
    use super::learner::Learner;
    #[pymodule_export]
    use super::model::FiniteModel;
    #[pymodule_export]
    use super::monitor::Monitor;
    #[pymodule_export]
    use super::network::NetworkPolicy;
    #[pymodule_export]
    use super::policy::Policy;
    #[pymodule_export]
    use super::product::{Product, product};
    #[pymodule_export]
    use super::replay::relabelled;
    #[pymodule_export]
    use super::restore::{restore, restore_product};
    #[pymodule_export]
    use super::rewards::Rewards;
    #[pymodule_export]
    use super::settings::{Schedule, Settings};
    #[pymodule_export]
    use super::shield::{Shield, Shielded};
    #[pymodule_export]
    use super::solution::{Solution, solve};
    #[pymodule_export]
    use super::task::Task;
    #[pymodule_export]
    use super::values::{Budget, Edge, Input, Run};

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }

    /// Runs the command-line tool with these arguments, the name of the program first; its exit
    /// code.
    #[pyfunction]
    fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
        py.detach(|| {
            let (mut out, mut err) = (stdout().lock(), stderr().lock());
            let mut streams = Streams {
                input: &mut stdin().lock(),
                out: Output { style: cli::style(&out), stream: &mut out },
                err: Output { style: cli::style(&err), stream: &mut err },
            };
            cli::main(arguments, &mut streams).code()
        })
    }
}
