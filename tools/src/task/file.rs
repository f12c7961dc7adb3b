//! Compiled sources, their mistakes, and the tasks in them.
//!
//! A [`TaskFile`] keeps the source beside the compiler's result, since reports quote its lines. An
//! [`Entry`] refers to a task by its index and keeps the file alive, so that it can be passed
//! around on its own.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use tltl_compiler::ast::{Item, ItemKind};
use tltl_compiler::check;
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::error::{Error, Errors, Kind, Style};
use tltl_compiler::hoa;
use tltl_compiler::parse;
use tltl_compiler::predicate::{self, Module};
use tltl_compiler::source::{Source, Span};
use tltl_compiler::translate::Budget;

use super::argument::{ArgumentError, Arguments, Parameter, Value, bind};
use super::{Bound, Factored, Task, foreign};
use crate::evaluate::Unreadable;
use crate::lint;

/// A task file, compiled. A clone costs a few reference counts.
///
/// Invariant: the source has no mistakes. It may have [warnings](Self::warnings).
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
    form: Form,
    /// The task that was asked for, if it was one.
    asked: Option<Arc<str>>,
}

/// The form of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    File,
    Formula,
    Automaton,
}

/// The warnings without those in other tasks than the one that was asked for.
fn about(asked: Option<&str>, source: &Source, mut warnings: Vec<Error>) -> Vec<Error> {
    let Some(asked) = asked else { return warnings };
    let (ast, _) = parse::recover_file(source);
    let is_other =
        |item: &&Item| matches!(item.kind, ItemKind::Task(..)) && source.slice(item.name) != asked;
    let others: Vec<Span> = ast.items().iter().filter(is_other).map(|item| item.span).collect();
    let is_in = |span: Span, item: &Span| item.start <= span.start && span.end <= item.end;
    warnings.retain(|warning| !others.iter().any(|item| is_in(warning.span(), item)));
    warnings
}

impl TaskFile {
    /// Compiles a task file.
    ///
    /// # Errors
    /// Every mistake of the source, in its order; or that an automaton is larger than the budget
    /// allows.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::TaskFile;
    ///
    /// let source = Source::new("dock.tltl", "state Robot { x: f64 }\ntask dock = F y > 2");
    /// let error = TaskFile::new(source, Budget::default()).unwrap_err();
    /// assert_eq!(error.errors().first().kind().name(), "unknown-name");
    /// assert!(error.to_string().contains("dock.tltl:2:15"));
    /// ```
    pub fn new(source: Source, budget: Budget) -> Result<Self, CompileError> {
        Self::file(source, budget, None)
    }

    /// Compiles one task of a file, which is then the only one that it has: others may be larger
    /// than the budget allows, and nothing is said of them. Without a task of this name, all of the
    /// file.
    ///
    /// # Errors
    /// Every mistake of the source; or that the automaton of the task is larger than the budget
    /// allows.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::TaskFile;
    ///
    /// let source = Source::new("two.tltl", "state S { a: bool }\ntask far = F[0,9999999] a\ntask soon = X a");
    /// assert!(TaskFile::new(source.clone(), Budget::default()).is_err());
    /// let file = TaskFile::with_task(source, "soon", Budget::default())?;
    /// assert_eq!(file.find(None)?.name(), Some("soon"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_task(source: Source, name: &str, budget: Budget) -> Result<Self, CompileError> {
        Self::file(source, budget, Some(name))
    }

    fn file(source: Source, budget: Budget, name: Option<&str>) -> Result<Self, CompileError> {
        let compiled = check::file(&source).and_then(|mut module| {
            let is_meant = |task: &predicate::Task| task.name.as_deref() == name;
            if module.tasks.iter().any(is_meant) {
                module.tasks.retain(is_meant);
            }
            compile::module(module, budget)
        });
        let asked = name.map(Arc::from);
        Self::compiled_from(source, compiled, Form::File, asked)
    }

    /// Compiles a bare formula: a file with one task, which has no name and no parameters.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::task::TaskFile;
    ///
    /// let file = TaskFile::of_formula("F docked || true", Budget::default())?;
    /// assert_eq!((file.entries().count(), file.find(None)?.name()), (1, None));
    /// assert_eq!(file.warnings()[0].kind().name(), "valid");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Every mistake of the formula, or that its automaton is larger than the budget allows.
    pub fn of_formula(formula: &str, budget: Budget) -> Result<Self, CompileError> {
        let source = Source::new("formula", formula);
        let compiled = compile::formula(&source, budget);
        Self::compiled_from(source, compiled, Form::Formula, None)
    }

    /// Reads an automaton of another tool, in the [HOA format](hoa): a file with one task, which has
    /// no name, no parameters and no formula; what stands in the formula's place is the automaton's own
    /// name, or that of its file. Its inputs are its propositions, given by their
    /// robustness, and its robustness is that of the [best run](tltl::robustness::best_run).
    ///
    /// # Errors
    /// If the text is not HOA, or the automaton is not one that a formula could have.
    ///
    /// ```
    /// use tltl::Monitor;
    /// use tltl_compiler::source::Source;
    /// use tltlc::task::{Bound, TaskFile};
    ///
    /// let text = "HOA: v1 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0)
    ///     --BODY-- State: 0 [0] 1 [!0] 0 State: 1 {0} [t] 1 --END--";
    /// let file = TaskFile::of_automaton(Source::new("eventually.hoa", text))?;
    /// let Bound::Plain(task) = file.find(None)?.bind(&[])? else { panic!("it has one automaton") };
    /// assert_eq!((task.next(0, &[-1.0])?, task.next(0, &[1.0])?), (0, 1));
    /// assert!(task.entry().is_automaton());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of_automaton(source: Source) -> Result<Self, CompileError> {
        let compiled = hoa::read(&source).map(|read| foreign::compiled(read, source.name()));
        let compiled = compiled.map_err(Errors::from);
        Self::compiled_from(source, compiled, Form::Automaton, None)
    }

    /// The same source with another automaton, which accepts the same trajectories, in the place of
    /// that of its only task.
    pub(super) fn with_automaton(&self, dfa: Dfa) -> Self {
        let mut compiled = Compiled::clone(&self.compiled);
        compiled.automata = vec![Automata { propositional: dfa.clone(), dfa }];
        Self { compiled: Arc::new(compiled), ..self.clone() }
    }

    fn compiled_from(
        source: Source,
        compiled: Result<Compiled, Errors>,
        form: Form,
        asked: Option<Arc<str>>,
    ) -> Result<Self, CompileError> {
        match compiled {
            Ok(compiled) => Ok(Self { source, compiled: Arc::new(compiled), form, asked }),
            Err(errors) => {
                let warnings = match form {
                    Form::File => lint::written(&parse::recover_file(&source)),
                    Form::Formula => lint::written(&parse::recover_formula(&source)),
                    Form::Automaton => Vec::new(),
                };
                let errors = errors.with(about(asked.as_deref(), &source, warnings));
                Err(CompileError { source, errors, form })
            }
        }
    }

    /// The text that was compiled, with its name.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// Whether it is an automaton, without a formula.
    #[must_use]
    pub fn is_automaton(&self) -> bool {
        self.form == Form::Automaton
    }

    /// How long a step lasts, as the source says it: `step 0.1 s` is 0.1 and `s`.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::TaskFile;
    ///
    /// let source = Source::new("soon.tltl", "state S { a: bool }\nstep 0.1 s\ntask soon = F[0,2 s] a");
    /// assert_eq!(TaskFile::new(source, Budget::default())?.step(), Some((0.1, "s")));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn step(&self) -> Option<(f64, &str)> {
        if self.form != Form::File {
            return None;
        }
        let (ast, _) = parse::recover_file(&self.source);
        let text = |span: Span| &self.source.text()[span.start..span.end];
        ast.items().iter().find_map(|item| match item.kind {
            ItemKind::Step { amount, unit } => Some((text(amount).parse().ok()?, text(unit))),
            _ => None,
        })
    }

    /// The compiler's result: the module, and an automaton or a factored task for each task.
    #[must_use]
    pub fn compiled(&self) -> &Compiled {
        &self.compiled
    }

    /// What the author should look at, in the order of the source: the warnings of [`lint`].
    ///
    /// Some cost a search, so they are made on demand, and not when the file is compiled.
    #[must_use]
    pub fn warnings(&self) -> Vec<Error> {
        if self.is_automaton() {
            return Vec::new();
        }
        let warnings = lint::warnings(&self.source, &self.compiled);
        about(self.asked.as_deref(), &self.source, warnings)
    }

    /// Its tasks: the plain ones in the order of the source, then the factored ones in theirs.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::TaskFile;
    ///
    /// let source = Source::new("tour.tltl", "
    ///     state Robot { a: bool, b: bool }
    ///     #[factored] task tour = F a && F b
    ///     task order = a T b");
    /// let file = TaskFile::new(source, Budget::default())?;
    /// let names: Vec<_> = file.entries().map(|entry| entry.name().map(str::to_owned)).collect();
    /// assert_eq!(names, [Some("order".to_owned()), Some("tour".to_owned())]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn entries(&self) -> impl Iterator<Item = Entry> {
        let plain = (0..self.compiled.module.tasks.len()).map(Place::Plain);
        let factored = (0..self.compiled.factored.len()).map(Place::Factored);
        plain.chain(factored).map(|place| Entry { file: self.clone(), place })
    }

    /// The task called `name`. Without a name, the only task of the file; factored tasks count only
    /// where there are no plain ones.
    ///
    /// # Errors
    /// If no task, or more than one, is meant. The error lists the names that the file has.
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

/// The index of a task: among the plain ones of a file, among the factored ones, or of a part of a
/// factored one.
#[derive(Clone, Copy, Debug)]
enum Place {
    Plain(usize),
    Factored(usize),
    Part(usize, usize),
}

/// A task of a file as the author wrote it: its parameters have no values. It keeps its file alive.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::TaskFile;
///
/// let source = Source::new("tour.tltl", "
///     state Robot { a: bool, b: bool }
///     #[factored] task tour = F a && F b");
/// let tour = TaskFile::new(source, Budget::default())?.find(Some("tour"))?;
/// // The file is kept by its entry. Its automaton would have 4 states, and is never made.
/// assert!(tour.is_factored() && tour.automata().is_none());
/// assert_eq!((tour.file().source().name(), &tour.task().text[..]), ("tour.tltl", "F a && F b"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Entry {
    file: TaskFile,
    place: Place,
}

/// The compiler's result for one task.
enum Made<'a> {
    Plain(&'a predicate::Task, &'a Automata),
    Factored(&'a compile::Factored),
}

impl Entry {
    /// The file that it is a task of.
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

    /// The task in the compiler's terms: name, formula, predicates, parameters.
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

    /// Whether it is a bare formula, which declares nothing.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.file.form == Form::Formula
    }

    /// Whether it came as an automaton, without a formula.
    #[must_use]
    pub fn is_automaton(&self) -> bool {
        self.file.is_automaton()
    }

    /// Whether its parts run side by side. It then has no automaton of its own.
    #[must_use]
    pub fn is_factored(&self) -> bool {
        matches!(self.place, Place::Factored(_))
    }

    /// Its automata, over free propositions and after arithmetic; `None` if it is factored.
    #[must_use]
    pub fn automata(&self) -> Option<&Automata> {
        match self.made() {
            Made::Plain(_, automata) => Some(automata),
            Made::Factored(_) => None,
        }
    }

    /// A part of a factored task as an entry of its own.
    pub(super) fn part(&self, part: usize) -> Self {
        let place = match self.place {
            Place::Factored(place) => Place::Part(place, part),
            other => other,
        };
        Self { file: self.file.clone(), place }
    }

    /// Its parameters, in the order of the declaration.
    #[must_use]
    pub fn parameters(&self) -> Vec<Parameter> {
        let module = &self.file.compiled.module;
        self.task().parameters.iter().map(|known| Parameter::new(module, known)).collect()
    }

    /// The task with these values for its parameters, ready to run. Arguments are given by name, in
    /// any order.
    ///
    /// It costs a copy of the compiled module if there are parameters; the automaton is shared.
    ///
    /// # Errors
    /// If the values are not those that the task takes, or a predicate is Rust code.
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

/// A source with mistakes. It prints as the compiler reports: each mistake with its lines of the
/// source, carets under the place at fault, and help.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::task::TaskFile;
///
/// let error = TaskFile::of_formula("F near && !F far", Budget::default()).unwrap_err();
/// let first = error.errors().first();
/// assert_eq!((first.kind().name(), error.source_text().name()), ("negated-temporal", "formula"));
/// assert_eq!(&error.source_text().text()[first.span().start..], "!F far");
/// assert!(error.to_string().contains("^"), "the report has carets under the place");
/// ```
#[derive(Clone, Debug)]
pub struct CompileError {
    source: Source,
    errors: Errors,
    form: Form,
}

impl CompileError {
    /// The source that has the mistakes.
    #[must_use]
    pub fn source_text(&self) -> &Source {
        &self.source
    }

    /// The source without automata, if nothing is wrong with it but that they are larger than the
    /// budget allows. Robustness needs none: see [`Unmade`](super::Unmade).
    #[must_use]
    pub fn module(&self) -> Option<Module> {
        let is_wrong = |error: &Error| !error.is_warning() && error.kind() != Kind::Budget;
        if self.errors.iter().any(is_wrong) {
            return None;
        }
        match self.form {
            Form::File => check::file(&self.source).ok(),
            Form::Formula => check::formula(&self.source).ok(),
            Form::Automaton => None,
        }
    }

    /// The mistakes, in the order of the source; at least one. Warnings about the text may stand
    /// among them.
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

/// The reason why a task cannot be bound.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::{BindError, TaskFile};
///
/// let source = Source::new("reach.tltl", "
///     state Robot { places: [f64; 256], at: u8 }
///     task reach(far: f64) = F places[at] > far");
/// let reach = TaskFile::new(source, Budget::default())?.find(None)?;
/// assert!(matches!(reach.bind(&[]).unwrap_err(), BindError::Argument(_)));
/// let error = reach.bind(&[("far", 2.0.into())]).unwrap_err();
/// assert!(matches!(error, BindError::Unreadable(_)), "an index that is a field: {error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BindError {
    /// The task does not take these arguments.
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

/// The reason why a file does not have the task that was asked for.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::{NoSuchTask, TaskFile};
///
/// let source = Source::new("two.tltl", "state S { a: bool }\ntask one = F a\ntask two = X a");
/// let file = TaskFile::new(source, Budget::default())?;
/// let names = ["one", "two"].map(str::to_owned).to_vec();
/// assert_eq!(file.find(None).unwrap_err(), NoSuchTask::Several(names));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NoSuchTask {
    /// The file has no task at all.
    None,
    /// No name was given, and the file has several tasks, of these names.
    Several(Vec<String>),
    /// The file has no task of the first name; the others are the names that it has.
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
