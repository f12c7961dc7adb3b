//! Predicates and robustness of recorded states, without a Rust compiler: whole columns at a time.
//!
//! An [`Evaluator`] is compiled once from the predicates of a task, and reads arrays where they lie:
//! columns of any number type, with strides. It does, operation by operation, what the generated
//! code of [`emit::predicates`](tltl_compiler::emit) does, so both give the same bits: `x < c` has
//! robustness `c - x` and holds iff that is positive, whatever the rounding. It knows declared
//! states and bare formulas; a predicate that is Rust code is refused. Nothing is allocated for a
//! row or a block of rows, and an evaluator is never written to: threads share it, each with a
//! [`Scratch`] of its own. It also answers for one predicate in one row, as the runtime's tasks ask.

mod column;
mod compile;
mod program;

use std::fmt;
use std::sync::Arc;

use tltl::robustness::{self, Predicates};
use tltl_compiler::predicate::{ConditionId, Module, PredicateId, Scalar, Task};

pub use column::{Column, Columns, Numbers, WrongLength};
pub use program::Scratch;

use compile::{Inputs, Reading};
use program::Program;

/// One number that the predicates of a task read from a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its name: `x`, `pose.x`, `joints[2]`; the proposition's name if that is free.
    pub name: String,
    /// What it is.
    pub kind: InputKind,
    /// What it is measured in, if the source says so.
    pub unit: Option<String>,
    /// The names of the values, in order, if it is one of an enumeration.
    pub values: Vec<String>,
}

/// What an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A place of the declared state, of this type; a truth value is 1 or 0, a value of an
    /// enumeration its number, from 0, and -1 if there is none.
    Place(Scalar),
    /// A variable of a bare formula: any real number.
    Variable,
    /// A free proposition of a bare formula, by its robustness: it holds iff that is positive. A
    /// truth value is 1 or -1.
    Proposition,
}

/// A part of a predicate that cannot be read here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// It is Rust code.
    Rust(String),
    /// It is a parameter of the task, which has no value.
    Parameter(String),
    /// It is an element of an array whose index depends on the state.
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

/// A predicate whose value is not a number, in the first row in which there is one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct NotANumber {
    /// The row, from 0.
    pub row: usize,
    /// The predicate: the number of its proposition.
    pub predicate: u32,
}

impl fmt::Display for NotANumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "predicate {} is not a number (NaN) in row {}", self.predicate, self.row)
    }
}

impl std::error::Error for NotANumber {}

/// The predicates of a task and its formula, ready to read states. Cheap to clone.
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
    truth: Program,
    rho: Program,
    formula: Program,
    /// Each predicate on its own, for whoever asks for one in one row.
    predicates: Vec<Single>,
}

#[derive(Debug)]
struct Single {
    truth: Program,
    rho: Program,
}

impl Evaluator {
    /// The predicates and the formula of `task`, which is one of `module`.
    ///
    /// # Errors
    /// If a predicate is Rust code.
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

    /// What a row must give, in the order of the columns.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.0.inputs
    }

    /// The number of predicates.
    #[must_use]
    pub fn propositions(&self) -> usize {
        self.0.predicates.len()
    }

    /// Which predicates hold in each row: `labels` has, row after row, a truth value for each
    /// predicate.
    ///
    /// # Errors
    /// The first predicate that is not a number, in the first row in which there is one; `labels`
    /// then say nothing.
    ///
    /// # Panics
    /// If the columns are not as many as the inputs, or `labels` is not of that size.
    #[track_caller]
    pub fn labels(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        labels: &mut [bool],
    ) -> Result<(), NotANumber> {
        let width = self.propositions();
        assert_eq!(labels.len(), columns.rows() * width, "a label for each row and predicate");
        self.run(&self.0.truth, columns, scratch, &mut |first, predicate, truths| {
            let rows = labels[first * width..].chunks_exact_mut(width);
            rows.zip(truths).for_each(|(row, &truth)| row[predicate as usize] = truth > 0.0);
        })
    }

    /// Which predicates hold in each row, as bits: bit i is predicate i.
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the columns are not as many as the inputs, there is not a letter for each row, or there
    /// are more than 64 predicates.
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

    /// The robustness ρ(s, p) of each predicate in each row: `rho` has, row after row, a number for
    /// each predicate.
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the columns are not as many as the inputs, or `rho` is not of that size.
    #[track_caller]
    pub fn rho(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
        rho: &mut [f64],
    ) -> Result<(), NotANumber> {
        let width = self.propositions();
        assert_eq!(rho.len(), columns.rows() * width, "a number for each row and predicate");
        self.run(&self.0.rho, columns, scratch, &mut |first, predicate, numbers| {
            let rows = rho[first * width..].chunks_exact_mut(width);
            rows.zip(numbers).for_each(|(row, &number)| row[predicate as usize] = number);
        })
    }

    /// The robustness of the formula on the trajectory that the rows are, in one pass from its end;
    /// -∞ for an empty one.
    ///
    /// # Errors
    /// As for [`labels`](Self::labels).
    ///
    /// # Panics
    /// If the columns are not as many as the inputs.
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

/// A row is the [inputs](Evaluator::inputs) of one state, in their order. Only what the predicate reads
/// is looked at.
impl<S: AsRef<[f64]> + ?Sized> Predicates<S> for Evaluator {
    fn robustness(&self, i: usize, row: &S) -> f64 {
        self.0.predicates[i].rho.of_row(row.as_ref())
    }

    fn holds(&self, i: usize, row: &S) -> Result<bool, robustness::NotANumber> {
        let truth = self.0.predicates[i].truth.of_row(row.as_ref());
        if truth.is_nan() { Err(robustness::NotANumber) } else { Ok(truth > 0.0) }
    }
}

/// The place of the first NaN. To look for its place only if there is one is faster: that loop is
/// vectorised.
fn not_a_number(numbers: &[f64]) -> Option<usize> {
    let any = numbers.iter().fold(false, |any, number| any | number.is_nan());
    any.then(|| numbers.iter().position(|number| number.is_nan()))?
}
