//! A task of which no automaton is made: its predicates and its formula alone.

use tltl_compiler::predicate::{self, Module};

use super::argument::{Parameter, Value, bind};
use super::{BindError, Entry, NoSuchTask};
use crate::evaluate::Evaluator;

/// A checked task without an automaton, which is all that the robustness of a trajectory needs.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::evaluate::{Columns, Scratch};
/// use tltlc::task::{TaskFile, Unmade};
///
/// // Its automaton would have a billion states.
/// let error = TaskFile::of_formula("F[0,1000000000] near", Budget::default()).unwrap_err();
/// let module = error.module().expect("nothing else is wrong");
/// let near = Unmade::new(module, None)?.bind(&[])?;
/// let rows = Columns::of_rows(2, 1, &[-1.0, 0.5])?;
/// assert_eq!(near.robustness(&rows, &mut Scratch::default())?, 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Unmade {
    module: Module,
    task: predicate::Task,
}

impl Unmade {
    /// The task of that name, or the only one of the module.
    ///
    /// # Errors
    /// If no task, or more than one, is meant.
    pub fn new(module: Module, name: Option<&str>) -> Result<Self, NoSuchTask> {
        let names = || module.tasks.iter().filter_map(|task| task.name.clone()).collect();
        let is_meant = |task: &&predicate::Task| name.is_none() || task.name.as_deref() == name;
        let mut meant = module.tasks.iter().filter(is_meant);
        let task = match (meant.next(), meant.next(), name) {
            (Some(task), None, _) => task.clone(),
            (Some(_), Some(_), _) => return Err(NoSuchTask::Several(names())),
            (None, _, None) => return Err(NoSuchTask::None),
            (None, _, Some(name)) => return Err(NoSuchTask::Unknown(name.to_owned(), names())),
        };
        Ok(Self { module, task })
    }

    /// A factored task of a file, which has no automaton of its own.
    pub(crate) fn of_entry(entry: &Entry) -> Self {
        let module = entry.file().compiled().module.clone();
        Self { module, task: entry.task().clone() }
    }

    /// The task as the author wrote it.
    #[must_use]
    pub fn task(&self) -> &predicate::Task {
        &self.task
    }

    /// Its parameters, in the order of the declaration.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        self.task.parameters.iter().map(|known| Parameter::new(&self.module, known)).collect()
    }

    /// Its predicates and its formula with these values for its parameters.
    ///
    /// # Errors
    /// If the values are not those that the task takes, or a predicate is Rust code.
    pub fn bind(&self, arguments: &[(&str, Value)]) -> Result<Evaluator, BindError> {
        let mut module = self.module.clone();
        bind(&mut module, &self.task, arguments).map_err(BindError::Argument)?;
        Evaluator::new(&module, &self.task).map_err(BindError::Unreadable)
    }
}
