//! Sources, what is wrong with them, and the tasks in them.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::Automata;
use tltl_compiler::error::{Error, Errors, Style};
use tltl_compiler::predicate;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::argument::{ArgumentError, Arguments, Parameter, Value, bind};
use super::{Bound, Factored, Task};
use crate::evaluate::Unreadable;
use crate::vacuity::advice;

/// A task file, compiled: its tasks, plain and factored. Cheap to clone.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::TaskFile;
///
/// let source = Source::new("dock.tltl", "state Robot { x: f64, docked: bool }
///     task dock(far: f64) = (x > far) T docked");
/// let file = TaskFile::new(source, Budget::default())?;
/// let dock = file.find(Some("dock"))?;
/// assert_eq!(dock.parameters()[0].to_string(), "far: f64");
/// assert_eq!(file.find(Some("park")).unwrap_err().to_string(), "the file has no task `park`; it has: dock");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TaskFile {
    source: Source,
    compiled: Arc<Compiled>,
}

impl TaskFile {
    /// Compiles a task file.
    ///
    /// # Errors
    /// All mistakes of the source, or that the budget does not suffice.
    pub fn new(source: Source, budget: Budget) -> Result<Self, CompileError> {
        let compiled = compile::file(&source, budget);
        Self::compiled_from(source, compiled)
    }

    /// Compiles a bare formula: a file with one task, which has no name.
    ///
    /// # Errors
    /// All mistakes of the formula, or that the budget does not suffice.
    pub fn of_formula(formula: &str, budget: Budget) -> Result<Self, CompileError> {
        let source = Source::new("formula", formula);
        let compiled = compile::formula(&source, budget);
        Self::compiled_from(source, compiled)
    }

    fn compiled_from(
        source: Source,
        compiled: Result<Compiled, Errors>,
    ) -> Result<Self, CompileError> {
        match compiled {
            Ok(compiled) => Ok(Self { source, compiled: Arc::new(compiled) }),
            Err(errors) => Err(CompileError { source, errors }),
        }
    }

    /// The text.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// All that the compiler knows of it.
    #[must_use]
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// What the author should look at, in the order of the source; to find out which parts of
    /// formulas could be left out costs a search.
    #[must_use]
    pub fn warnings(&self) -> Vec<Error> {
        let mut warnings = [self.compiled.warnings.clone(), advice(&self.compiled)].concat();
        warnings.sort_by_key(Error::span);
        warnings
    }

    /// Its tasks in the order of the source, factored ones after the others.
    pub fn entries(&self) -> impl Iterator<Item = Entry> {
        let plain = (0..self.compiled.module.tasks.len()).map(Place::Plain);
        let factored = (0..self.compiled.factored.len()).map(Place::Factored);
        plain.chain(factored).map(|place| Entry { file: self.clone(), place })
    }

    /// The task of that name. Without a name it is the only one; factored tasks then count only
    /// where there are no others.
    ///
    /// # Errors
    /// If there is no such task, or more than one.
    pub fn find(&self, name: Option<&str>) -> Result<Entry, NoSuchTask> {
        let names = || self.entries().filter_map(|entry| Some(entry.name()?.to_owned())).collect();
        let mut entries = self.entries();
        let first = entries.next().ok_or(NoSuchTask::None)?;
        if let Some(name) = name {
            let named = self.entries().find(|entry| entry.name() == Some(name));
            return named.ok_or_else(|| NoSuchTask::Unknown(name.to_owned(), names()));
        }
        match entries.next() {
            Some(next) if next.is_factored() == first.is_factored() => {
                Err(NoSuchTask::Several(names()))
            }
            _ => Ok(first),
        }
    }
}

/// The place of a task among the plain or the factored ones of a file, or of a part of a factored
/// one among its parts.
#[derive(Clone, Copy, Debug)]
enum Place {
    Plain(usize),
    Factored(usize),
    Part(usize, usize),
}

/// A task of a file, as it is written: its parameters have no values. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Entry {
    file: TaskFile,
    place: Place,
}

/// What the compiler made of a task.
enum Made<'a> {
    Plain(&'a predicate::Task, &'a Automata),
    Factored(&'a compile::Factored),
}

impl Entry {
    /// The file.
    #[must_use]
    pub fn file(&self) -> &TaskFile {
        &self.file
    }

    fn made(&self) -> Made<'_> {
        let Compiled { module, automata, factored, .. } = self.file.compiled();
        match self.place {
            Place::Plain(place) => Made::Plain(&module.tasks[place], &automata[place]),
            Place::Factored(place) => Made::Factored(&factored[place]),
            Place::Part(place, part) => {
                let part = &factored[place].parts[part];
                Made::Plain(&part.task, &part.automata)
            }
        }
    }

    /// The task as the compiler has it: name, formula, predicates.
    #[must_use]
    pub fn task(&self) -> &predicate::Task {
        match self.made() {
            Made::Plain(task, _) => task,
            Made::Factored(factored) => &factored.task,
        }
    }

    /// Its name; `None` for a bare formula.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.task().name.as_deref()
    }

    /// Whether its parts run side by side, and it has no automaton of its own.
    #[must_use]
    pub fn is_factored(&self) -> bool {
        matches!(self.place, Place::Factored(_))
    }

    /// Its automata, unless it is factored.
    #[must_use]
    pub fn automata(&self) -> Option<&Automata> {
        match self.made() {
            Made::Plain(_, automata) => Some(automata),
            Made::Factored(_) => None,
        }
    }

    /// A part of it, if it is factored, as a task.
    pub(super) fn part(&self, part: usize) -> Self {
        let place = match self.place {
            Place::Factored(place) => Place::Part(place, part),
            other => other,
        };
        Self { file: self.file.clone(), place }
    }

    /// What it takes.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let module = &self.file.compiled.module;
        self.task().parameters.iter().map(|known| Parameter::new(module, known)).collect()
    }

    /// The task with these values for its parameters, ready to run.
    ///
    /// # Errors
    /// If the values are not those that it takes, or a predicate is Rust code.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltl::Monitor;
    /// use tltlc::task::{Bound, TaskFile};
    ///
    /// let source = Source::new("dock.tltl", "state Robot { x: f64, docked: bool }
    ///     task dock(far: f64) = (x > far) T docked");
    /// let file = TaskFile::new(source, Budget::default())?;
    /// let Bound::Plain(dock) = file.find(Some("dock"))?.bind(&[("far", 2.5.into())])? else {
    ///     panic!("it is not factored");
    /// };
    /// assert_eq!(dock.next(0, &[3.0, 0.0])?, 1);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn bind(&self, arguments: &[(&str, Value)]) -> Result<Bound, BindError> {
        let mut module = Cow::Borrowed(&self.file.compiled.module);
        if !arguments.is_empty() || !self.task().parameters.is_empty() {
            bind(module.to_mut(), self.task(), arguments).map_err(BindError::Argument)?;
        }
        let own = |(name, value): &(&str, Value)| ((*name).to_owned(), value.clone());
        let arguments: Arguments = arguments.iter().map(own).collect();
        let bound = match self.made() {
            Made::Plain(_, automata) => {
                Task::new(self.clone(), automata, arguments, &module).map(Bound::Plain)
            }
            Made::Factored(factored) => {
                Factored::new(self, factored, arguments, &module).map(Bound::Factored)
            }
        };
        bound.map_err(BindError::Unreadable)
    }
}

/// A source with mistakes. Its text shows each of them, with the lines of the source.
#[derive(Clone, Debug)]
pub struct CompileError {
    source: Source,
    errors: Errors,
}

impl CompileError {
    /// The text with the mistakes.
    #[must_use]
    pub fn source_text(&self) -> &Source {
        &self.source
    }

    /// The mistakes, in the order of the source.
    #[must_use]
    pub fn errors(&self) -> &Errors {
        &self.errors
    }
}

impl fmt::Display for CompileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.errors.render(&self.source, Style::Plain).fmt(f)
    }
}

impl std::error::Error for CompileError {}

/// Why a task cannot be run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BindError {
    /// It does not take these arguments.
    Argument(ArgumentError),
    /// A predicate cannot be evaluated without a Rust compiler.
    Unreadable(Unreadable),
}

impl fmt::Display for BindError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Argument(error) => error.fmt(f),
            Self::Unreadable(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for BindError {}

/// Why a file does not have the task that is asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoSuchTask {
    /// It has no task.
    None,
    /// It has several, of these names, and none was named.
    Several(Vec<String>),
    /// It has none of the first name; the others are the names that it has.
    Unknown(String, Vec<String>),
}

impl fmt::Display for NoSuchTask {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("the file has no task"),
            Self::Several(names) => {
                write!(f, "the file has several tasks: {}", names.join(", "))
            }
            Self::Unknown(name, names) => {
                write!(f, "the file has no task `{name}`; it has: {}", names.join(", "))
            }
        }
    }
}

impl std::error::Error for NoSuchTask {}
