//! Tasks that are compiled while a program runs.
//!
//! The steps, each with a type of its own:
//!
//! 1. [`TaskFile`]: a source, compiled. It is a file of tasks, or one bare formula.
//! 2. [`Entry`]: one of its tasks as the author wrote it. Its parameters have no values yet.
//! 3. [`Bound`]: the entry with a value for each parameter. It is a [`Task`], which has one
//!    automaton, or a [`Factored`] task, whose parts run side by side.
//!
//! A bound task owns what it needs, is cheap to clone, and is `Send + Sync`: nothing is leaked and
//! nothing is locked. Many tasks may be compiled and dropped again; memory stays flat
//! (`tests/memory.rs` of this package measures it).
//!
//! A state of the world is a *row*: the numbers that the predicates read, in the order of
//! [`Task::inputs`]. A task is a [`Monitor`](tltl::Monitor) of the runtime over rows, so every
//! learner takes it, and it reads whole columns of rows through its
//! [`Evaluator`](crate::evaluate::Evaluator).
//!
//! What this module never does: it runs no Rust code. A predicate that is a Rust expression is a
//! mistake of the source here, for only the macro can read it; and a task that indexes an array by a
//! field of the state is refused when it is bound, with [`BindError::Unreadable`].

mod argument;
mod factored;
mod file;
mod foreign;
mod plain;
mod product;
mod run;
mod running;
mod unmade;

use tltl_compiler::translate::Budget;

pub use argument::{ArgumentError, Parameter, Value};
pub use factored::Factored;
pub use file::{BindError, CompileError, Entry, NoSuchTask, TaskFile};
pub use plain::Task;
pub use product::{NotBare, RawProduct};
pub use run::{Run, Verdict};
pub use running::Running;
pub use unmade::Unmade;

pub(crate) use argument::listed;

/// A task with values for its parameters, ready to run: what [`Entry::bind`] returns.
///
/// Which of the two it is, the source decides, by `#[factored]` before the task.
#[derive(Clone, Debug)]
pub enum Bound {
    /// One with one automaton.
    Plain(Task),
    /// One whose parts run side by side.
    Factored(Factored),
}

/// Compiles a bare formula into a task.
///
/// Names that stand for themselves are propositions and names in comparisons are numbers; both
/// become [inputs](Task::inputs) of the task. [`TaskFile`] is for formulas over declared states.
///
/// # Errors
/// Every mistake of the formula, or that its automaton is larger than the budget allows. The error
/// prints each mistake with the line of the source and carets.
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
