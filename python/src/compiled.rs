//! What plain and factored tasks have in common: a source, propositions, and rows of states that they read.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::Shared;
use tltlc::evaluate::{Columns, Evaluator, NotANumber, Scratch};
use tltlc::task;

use super::array::shaped;
use super::error::{not_a_number, wrong};
use super::labels::{self, Names};
use super::states::States;
use super::values::{Input, Run};

/// Units of time, in seconds.
const SECONDS: [(&str, f64); 6] =
    [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9), ("min", 60.0), ("h", 3600.0)];

/// A task of either kind.
pub(crate) trait Compiled: Sync {
    /// The task in its file.
    fn entry(&self) -> &task::Entry;
    /// What is evaluated of a state.
    fn evaluator(&self) -> &Evaluator;
    /// The names of what any automaton of it reads.
    fn propositions(&self) -> &[Shared<str>];
    /// The same as Python has them.
    fn names(&self) -> &Names;
    /// The automata of which a state has one state each; `None` if a state is a number.
    fn parts(&self) -> Option<usize>;
    /// A trajectory, followed row by row.
    fn follow(&self, columns: &Columns<'_>, scratch: &mut Scratch)
    -> Result<task::Run, NotANumber>;

    /// The formula, without comments and laid out anew.
    fn written(&self) -> &str {
        &self.entry().task().text
    }

    /// How long a step lasts, in seconds, if the file says it in a unit of time.
    fn seconds(&self) -> Option<f64> {
        let (amount, unit) = self.entry().file().step()?;
        SECONDS.iter().find(|(name, _)| *name == unit).map(|(_, seconds)| seconds * amount)
    }

    fn listed_propositions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.propositions().iter().map(|name| name.to_string()))
    }

    fn listed_inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.evaluator().inputs().iter().map(Input::new))
    }

    /// The truth values of `labels`, in the order of the propositions.
    fn row(&self, labels: &Bound<'_, PyAny>) -> PyResult<Vec<bool>> {
        labels::row((self.propositions(), self.names()), labels)
    }

    /// Computes for each trajectory, without the GIL.
    fn each<T: Send>(
        &self,
        py: Python<'_>,
        states: &States<'_>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, NotANumber> + Sync,
    ) -> PyResult<Vec<T>> {
        let results = states.each(py, compute);
        results.map_err(|error| not_a_number(self.propositions(), error))
    }

    /// An output of `width` numbers for each state.
    fn by_row<'py, T: numpy::Element + Copy + Default + Send>(
        &self,
        states: (&Bound<'py, PyAny>, Option<&Bound<'py, PyAny>>),
        width: Option<usize>,
        read: impl Fn(&Columns<'_>, &mut Scratch, &mut [T]) -> Result<(), NotANumber> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = states.0.py();
        let states = States::new(self.evaluator().inputs(), states.0, states.1)?;
        let each = self.each(py, &states, |columns, scratch| {
            let mut out = vec![T::default(); columns.rows() * width.unwrap_or(1)];
            read(columns, scratch, &mut out).map(|()| out)
        })?;
        let shape: Vec<usize> = states.shape.iter().copied().chain(width).collect();
        shaped(py, each.concat(), &shape)
    }

    /// Which propositions hold in each of `states`.
    fn labels_of<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.by_row((states, columns), Some(self.propositions().len()), |columns, scratch, out| {
            self.evaluator().labels(columns, scratch, out)
        })
    }

    /// The robustness of each proposition in each of `states`.
    fn rho_of<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.by_row((states, columns), Some(self.propositions().len()), |columns, scratch, out| {
            self.evaluator().rho(columns, scratch, out)
        })
    }

    /// One trajectory, of shape (T, d).
    fn run_of(
        &self,
        states: &Bound<'_, PyAny>,
        columns: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Run> {
        let py = states.py();
        let states = States::new(self.evaluator().inputs(), states, columns)?;
        if states.shape.len() != 1 {
            return Err(wrong("states: one trajectory is wanted, an array of shape (T, d)"));
        }
        let runs = self.each(py, &states, |columns, scratch| self.follow(columns, scratch))?;
        let run = runs.into_iter().next().expect("a shape of one axis is one trajectory");
        let (verdict, since, rows) = (run.verdict().to_string(), run.since(), run.verdicts.len());
        let shape: Vec<usize> = [rows].into_iter().chain(self.parts()).collect();
        Ok(Run {
            states: shaped(py, run.states, &shape)?.unbind(),
            progress: shaped(py, run.progress, &[rows])?.unbind(),
            robustness: run.robustness,
            verdict,
            since,
        })
    }
}
