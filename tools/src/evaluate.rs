//! Predicates and robustness of recorded states, whole columns at a time, without a Rust compiler.
//!
//! An [`Evaluator`] is compiled once from the predicates of a task. It reads arrays where they lie:
//! [`Columns`] of any number type, with strides, as NumPy or Arrow have them. Three outputs are
//! offered for each row: [labels](Evaluator::labels) (truth values), [letters](Evaluator::letters)
//! (the same as bits) and [ρ](Evaluator::rho); and for the rows as a trajectory the
//! [robustness](Evaluator::robustness) of the formula.
//!
//! # Same bits as generated code
//!
//! The evaluator performs the operations of the generated code (`emit::predicates` of the
//! compiler), in the same order: `x < c` has robustness `c - x` and holds iff that is positive,
//! whatever the rounding. So labels and robustness equal those of the macros bit by bit; the tests
//! compare both. Subexpressions that predicates share are computed once.
//!
//! # Cost
//!
//! Each predicate becomes a straight-line program that runs over blocks of rows, column by column,
//! in the manner of MonetDB/X100 (Boncz, Zukowski and Nes, 2005): the choice of the operation is
//! paid once a block, and the inner loops are vectorised. Five comparisons take about 6 ns a row
//! (`cargo bench -p tltl-tests --bench columns`). Nothing is allocated for a row or a block. An
//! evaluator is never written to: threads share it, each with a [`Scratch`] of its own.
//!
//! The robustness of the formula takes one backward pass, with one number carried for each temporal
//! operator, or a [window](tltl::robustness::Window) of them if it has a bound (after Donzé, Ferrère
//! and Maler, "Efficient Robust Monitoring for STL", 2013): time and memory are linear in the rows,
//! whatever the formula. It needs no automaton, so a bound may be any:
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//! use tltlc::evaluate::{Columns, Evaluator, Scratch};
//!
//! let module = check::formula(&Source::new("formula", "F[2,1000000000] (x > 3)"))?;
//! let evaluator = Evaluator::new(&module, &module.tasks[0])?;
//! let columns = Columns::of_rows(4, 1, &[9.0, 9.0, 1.0, 5.0])?;
//! assert_eq!(evaluator.robustness(&columns, &mut Scratch::default())?, 2.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Limits
//!
//! It knows declared states and bare formulas. A predicate that is Rust code, that takes a
//! parameter without a value, or that indexes an array by a field of the state, is refused as
//! [`Unreadable`]. A value that is not a number is an error, [`NotANumber`], and never counts as
//! false.

mod column;
mod compile;
mod program;
mod steps;

use std::fmt;
use std::sync::Arc;

use tltl::robustness::{self, Predicates};
use tltl_compiler::predicate::{ConditionId, Module, PredicateId, Scalar, Task};
use tltl_compiler::proposition::Proposition;
use tltl_compiler::spec::Spec;

pub use column::{Column, Columns, Numbers, WrongLength};
pub use program::Scratch;

use compile::{Inputs, Reading};
use program::Program;
use steps::Steps;

/// One number that the predicates of a task read from a state: one column.
///
/// Two inputs of a task differ in their names.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::evaluate::InputKind;
/// use tltlc::task::{Bound, TaskFile};
///
/// let source = Source::new("kitchen.tltl", "
///     enum Object { apple, mug }
///     state Kitchen { holding: Object?, x: f64 in m }
///     task grasp = F (holding == mug && x < 2)");
/// let Bound::Plain(grasp) = TaskFile::new(source, Budget::default())?.find(None)?.bind(&[])? else {
///     panic!("it is plain");
/// };
/// let [x, holding] = grasp.inputs() else { panic!("two columns") };
/// assert_eq!((&x.name[..], x.unit.as_deref()), ("x", Some("m")));
/// assert_eq!((&holding.name[..], &holding.values.concat()[..]), ("holding", "applemug"));
/// // A formula without a file declares nothing.
/// let free = tltlc::task::compile("F (x > 2 && docked)", Budget::default())?;
/// let kinds: Vec<_> = free.inputs().iter().map(|input| input.kind).collect();
/// assert_eq!(kinds, [InputKind::Variable, InputKind::Proposition]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its name: `x`, `pose.x`, `joints[2]` for a place of the state, the variable or the
    /// proposition of a bare formula.
    pub name: String,
    /// Its kind, which says how a truth value is written as a number.
    pub kind: InputKind,
    /// The unit that the source declares for it, as text. Numbers are not converted.
    pub unit: Option<String>,
    /// The names of the values, in the order of their numbers, if it is one of an enumeration; else
    /// empty.
    pub values: Vec<String>,
}

/// The kind of an input. Columns of truth values may have the type `bool` for every kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A place of the declared state, of this type. As a number, a truth value is 1 or 0, and a
    /// value of an enumeration is its index from 0, or -1 for `none`.
    Place(Scalar),
    /// A variable of a bare formula: any real number.
    Variable,
    /// A free proposition of a bare formula, given by its robustness: it holds iff that is
    /// positive. A truth value is 1 or -1.
    Proposition,
}

/// The part of a predicate that cannot be read without a Rust compiler.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
/// use tltlc::evaluate::{Evaluator, Unreadable};
///
/// let source = Source::new("reach.tltl", "
///     state Robot { places: [f64; 256], at: u8 }
///     task reach = F places[at] > 2");
/// let compiled = compile::file(&source, Budget::default())?;
/// let error = Evaluator::new(&compiled.module, &compiled.module.tasks[0]).unwrap_err();
/// assert!(matches!(error, Unreadable::Element(_)), "{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// A Rust expression, of this text.
    Rust(String),
    /// A parameter of the task that has no value.
    Parameter(String),
    /// An element of an array whose index depends on the state.
    Element(String),
}

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rust(text) => {
                write!(f, "`{text}` is Rust code, which only a Rust program can run")
            }
            Self::Parameter(name) => write!(f, "the task takes `{name}`, which has no value"),
            Self::Element(text) => {
                write!(f, "the index in `{text}` is a field, which only a Rust program can follow")
            }
        }
    }
}

impl std::error::Error for Unreadable {}

/// The first value of a predicate that is not a number: the earliest row, and in it the predicate
/// with the lowest number.
///
/// The outputs of the call that returns it are not to be used.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::evaluate::{Columns, NotANumber, Scratch};
///
/// let task = tltlc::task::compile("F (x > 1) && F (y < 0)", Budget::default())?;
/// let rows = Columns::of_rows(2, 2, &[3.0, 0.5, -3.0, f64::NAN])?;
/// let error = task.run(&rows, &mut Scratch::default()).unwrap_err();
/// assert_eq!(error, NotANumber { row: 1, predicate: 1 });
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NotANumber {
    /// The row, from 0.
    pub row: usize,
    /// The number of the predicate, which is that of its proposition.
    pub predicate: u32,
}

impl fmt::Display for NotANumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "predicate {} is not a number (NaN) in row {}", self.predicate, self.row)
    }
}

impl std::error::Error for NotANumber {}

/// The predicates of a task and its formula, compiled to read states. A clone costs one reference
/// count.
///
/// Outputs are written into the caller's slices, row after row. A [`Scratch`] may be used again for
/// other calls, rows and tasks.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
/// use tltlc::evaluate::{Column, Columns, Evaluator, Scratch};
///
/// let source = Source::new("formula", "(x < 1) T (y > 2)");
/// let compiled = compile::formula(&source, Budget::SHOWN)?;
/// let evaluator = Evaluator::new(&compiled.module, &compiled.module.tasks[0])?;
///
/// let (x, y) = ([0.0, 1.0, 2.0], [1_i32, 2, 3]);
/// let columns = [Column::from(&x[..]), Column::from(&y[..])];
/// let columns = Columns::new(3, &columns)?;
/// let mut scratch = Scratch::default();
/// let mut letters = [0; 3];
/// evaluator.letters(&columns, &mut scratch, &mut letters)?;
/// assert_eq!(letters, [0b01, 0b00, 0b10]);
/// assert_eq!(evaluator.robustness(&columns, &mut scratch)?, 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Evaluator(Arc<Programs>);

#[derive(Debug)]
struct Programs {
    inputs: Vec<Input>,
    /// The programs of all predicates together, so that they share what they read: truth,
    /// robustness, and the robustness of the formula after that of the predicates.
    truth: Program,
    rho: Program,
    formula: Program,
    /// The programs of each predicate on its own, for whoever asks for one in one row.
    predicates: Vec<Single>,
}

/// The two readings of one predicate.
#[derive(Debug)]
struct Single {
    truth: Program,
    rho: Program,
}

impl Evaluator {
    /// Compiles the predicates and the formula of `task`, a task of `module` without parameters.
    ///
    /// # Errors
    /// If a predicate is Rust code, names a parameter, or indexes an array by a field.
    pub fn new(module: &Module, task: &Task) -> Result<Self, Unreadable> {
        let root = |id: &PredicateId| module.predicates[id.0 as usize].condition;
        let roots: Vec<ConditionId> = task.predicates.iter().map(root).collect();
        let inputs = Inputs::find(module, &roots)?;
        let programs = |reading, roots: &[_]| compile::predicates(module, &inputs, roots, reading);
        let single = |root: &ConditionId| Single {
            truth: programs(Reading::Truth, &[*root]),
            rho: programs(Reading::Robustness, &[*root]),
        };
        Ok(Self(Arc::new(Programs {
            truth: programs(Reading::Truth, &roots),
            rho: programs(Reading::Robustness, &roots),
            formula: compile::formula(module, &inputs, &roots, task),
            predicates: roots.iter().map(single).collect(),
            inputs: inputs.inputs,
        })))
    }

    /// The formula alone, over the robustness of its propositions: each of them is an input, and
    /// there are no predicates.
    #[must_use]
    pub(crate) fn of_formula(spec: &Spec) -> Self {
        let input = |one: &Proposition| Input {
            name: one.name.clone(),
            kind: InputKind::Proposition,
            unit: None,
            values: Vec::new(),
        };
        let none = || Steps::default().program();
        Self(Arc::new(Programs {
            inputs: spec.propositions().iter().map(input).collect(),
            truth: none(),
            rho: none(),
            formula: steps::over_propositions(spec),
            predicates: Vec::new(),
        }))
    }

    /// The numbers of a row, in the order of the columns. A place that several predicates read is
    /// there once.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.0.inputs
    }

    /// The number of predicates, each of which is a proposition of the automaton.
    #[must_use]
    pub fn propositions(&self) -> usize {
        self.0.predicates.len()
    }

    /// Computes which predicates hold in each row: `labels` has shape (rows, predicates).
    ///
    /// # Errors
    /// The first predicate that is not a number; `labels` are then not to be used.
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs, or `labels` has another size.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::evaluate::{Columns, Scratch};
    ///
    /// let task = tltlc::task::compile("F (x > 1) && F (x < 0)", Budget::default())?;
    /// let x = Columns::of_rows(2, 1, &[3.0, -3.0])?;
    /// let mut labels = [false; 4];
    /// task.evaluator().labels(&x, &mut Scratch::default(), &mut labels)?;
    /// assert_eq!(labels, [true, false, false, true]);
    ///
    /// let x = Columns::of_rows(1, 1, &[f64::NAN])?;
    /// let error = task.evaluator().labels(&x, &mut Scratch::default(), &mut labels[..2]).unwrap_err();
    /// assert_eq!((error.row, error.predicate), (0, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[track_caller]
    pub fn labels(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        labels: &mut [bool],
    ) -> Result<(), NotANumber> {
        let width = self.propositions();
        assert_eq!(labels.len(), columns.rows() * width, "a label for each row and predicate");
        self.run(&self.0.truth, columns, scratch, &mut transposed(width, labels, |x| x > 0.0))
    }

    /// Computes which predicates hold in each row, as bits: bit i of a letter is predicate i.
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs, there is not one letter for each row,
    /// or there are more than 64 predicates.
    #[track_caller]
    pub fn letters(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        letters: &mut [u64],
    ) -> Result<(), NotANumber> {
        assert!(self.propositions() <= 64, "a letter has at most 64 propositions");
        assert_eq!(letters.len(), columns.rows(), "a letter for each row");
        letters.fill(0);
        self.run(&self.0.truth, columns, scratch, &mut |first, predicate, truths| {
            for (letter, &truth) in letters[first..].iter_mut().zip(truths) {
                *letter |= u64::from(truth > 0.0) << predicate;
            }
        })
    }

    /// Computes the robustness ρ(s, p) of each predicate in each row: `rho` has shape (rows,
    /// predicates).
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs, or `rho` has another size.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::evaluate::{Columns, Scratch};
    ///
    /// let task = tltlc::task::compile("F (x > 1) && F (y < 0)", Budget::default())?;
    /// let rows = Columns::of_rows(2, 2, &[3.0, 0.5, -3.0, -2.0])?;
    /// let mut rho = [0.0; 4];
    /// task.evaluator().rho(&rows, &mut Scratch::default(), &mut rho)?;
    /// assert_eq!(rho, [2.0, -0.5, -4.0, 2.0]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[track_caller]
    pub fn rho(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        rho: &mut [f64],
    ) -> Result<(), NotANumber> {
        let width = self.propositions();
        assert_eq!(rho.len(), columns.rows() * width, "a number for each row and predicate");
        self.run(&self.0.rho, columns, scratch, &mut transposed(width, rho, |x| x))
    }

    /// Computes the robustness of the formula on the trajectory that the rows are, in one backward
    /// pass; -∞ for an empty one.
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the number of columns is not the number of inputs.
    #[track_caller]
    pub fn robustness(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
    ) -> Result<f64, NotANumber> {
        let mut whole = f64::NEG_INFINITY;
        self.run(&self.0.formula, columns, scratch, &mut |first, output, numbers| {
            if first == 0 && output as usize == self.propositions() {
                whole = numbers[0];
            }
        })?;
        Ok(whole)
    }

    /// Runs a program and gives its outputs to `emit`; the first predicate that is not a number is
    /// the error.
    #[track_caller]
    fn run(
        &self,
        program: &Program,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        emit: &mut dyn FnMut(usize, u32, &[f64]),
    ) -> Result<(), NotANumber> {
        assert_eq!(columns.width(), self.0.inputs.len(), "a column for each input");
        let mut first: Option<NotANumber> = None;
        program.run(columns, scratch, &mut |start, output, numbers| {
            // The formula is not a number only where a predicate is not.
            if (output as usize) < self.propositions()
                && let Some(at) = not_a_number(numbers)
            {
                let found = NotANumber { row: start + at, predicate: output };
                first = Some(first.map_or(found, |first| first.min(found)));
            }
            emit(start, output, numbers);
        });
        first.map_or(Ok(()), Err)
    }
}

/// A row is the [inputs](Evaluator::inputs) of one state, in their order. Only the numbers that the
/// predicate reads are looked at, so others may be NaN.
impl<S: AsRef<[f64]> + ?Sized> Predicates<S> for Evaluator {
    fn robustness(&self, i: usize, row: &S) -> f64 {
        self.0.predicates[i].rho.of_row(row.as_ref())
    }

    fn holds(&self, i: usize, row: &S) -> Result<bool, robustness::NotANumber> {
        let truth = self.0.predicates[i].truth.of_row(row.as_ref());
        if truth.is_nan() { Err(robustness::NotANumber) } else { Ok(truth > 0.0) }
    }
}

/// Writes the numbers of a predicate in a block of rows into a table with a row for each state and a
/// column for each predicate.
fn transposed<T>(
    width: usize,
    table: &mut [T],
    entry: impl Fn(f64) -> T,
) -> impl FnMut(usize, u32, &[f64]) {
    move |first, predicate, numbers| {
        let rows = table[first * width..].chunks_exact_mut(width);
        rows.zip(numbers).for_each(|(row, &number)| row[predicate as usize] = entry(number));
    }
}

/// The place of the first NaN. A search that stops early is not vectorised, and NaN is rare: so the
/// numbers are first asked all together whether one is NaN.
fn not_a_number(numbers: &[f64]) -> Option<usize> {
    let any = numbers.iter().fold(false, |any, number| any | number.is_nan());
    any.then(|| numbers.iter().position(|number| number.is_nan()))?
}
