//! Tasks that are compiled while a program runs.
//!
//! A [`TaskFile`] is a source, compiled: a file of tasks, or one bare formula.

mod argument;
mod file;

pub use argument::{ArgumentError, Parameter, Value};
pub use file::{BindError, CompileError, Entry, NoSuchTask, TaskFile};

pub(crate) use argument::listed;
