//! Tasks that are compiled while a program runs.
//!
//! A [`TaskFile`] is a source, compiled: a file of tasks, or one bare formula. An [`Entry`] is one of
//! its tasks as it is written; bound to values for its parameters it is a [`Task`], or a
//! [`Factored`] one, that runs. These own all that they need, are cheap to clone, and can be sent to
//! other threads and shared by them: nothing is leaked, nothing is locked. They are tasks of the
//! runtime over rows, the numbers that a state consists of, and read whole columns of them too.

mod argument;
mod factored;
mod file;
mod plain;
mod run;

use tltl_compiler::translate::Budget;

pub use argument::{ArgumentError, Parameter, Value};
pub use factored::Factored;
pub use file::{BindError, CompileError, Entry, NoSuchTask, TaskFile};
pub use plain::Task;
pub use run::{Run, Verdict};

pub(crate) use argument::listed;

/// A task that runs.
#[derive(Clone, Debug)]
pub enum Bound {
    /// One with one automaton.
    Plain(Task),
    /// One whose parts run side by side.
    Factored(Factored),
}

/// Compiles a bare formula.
///
/// # Errors
/// All mistakes of the formula, or that the budget does not suffice.
///
/// ```
/// use tltl::{Acceptor, Monitor};
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("(x > 2) T docked", Budget::default())?;
/// let names: Vec<_> = task.inputs().iter().map(|input| input.name.as_str()).collect();
/// assert_eq!(names, ["x", "docked"]);
/// let mut q = 0;
/// for row in [[1.0, -1.0], [2.5, -1.0], [0.0, 1.0]] {
///     q = task.next(q, &row)?;
/// }
/// assert!(task.is_accepting(q));
///
/// let error = tltlc::task::compile("G docked", Budget::default()).unwrap_err();
/// assert_eq!(error.errors().first().kind().name(), "unsupported-operator");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn compile(formula: &str, budget: Budget) -> Result<Task, CompileError> {
    let file = TaskFile::of_formula(formula, budget)?;
    match file.find(None).map(|formula| formula.bind(&[])) {
        Ok(Ok(Bound::Plain(task))) => Ok(task),
        _ => unreachable!("a bare formula is one task, without parameters and Rust code"),
    }
}
