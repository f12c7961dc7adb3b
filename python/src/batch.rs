//! What a task reads: states, letters and trajectories, and what it makes of all of them at once.

use std::borrow::Cow;

use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use tltl::{Acceptor, automaton};
use tltlc::evaluate::{self, Columns, Scratch};

use super::array::{Array, shaped};
use super::error::{not_a_number, wrong};
use super::labels;
use super::states::States;
use super::task::Task;

/// What each row reads: bits, or a truth value for each proposition.
pub(crate) enum Letters<'a> {
    Bits(Cow<'a, [u64]>),
    Labels(Cow<'a, [bool]>),
}

/// Fewer moves than these are done before another thread could begin.
const FEW: usize = 10_000;

impl Task {
    /// Computes for each trajectory, without the GIL.
    pub(crate) fn each<T: Send>(
        &self,
        py: Python<'_>,
        states: &States<'_>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, evaluate::NotANumber> + Sync,
    ) -> PyResult<Vec<T>> {
        let results = states.each(py, compute);
        results.map_err(|error| not_a_number(self.names(), error))
    }

    /// An output of `width` numbers for each state.
    pub(crate) fn by_row<'py, T: numpy::Element + Copy + Default + Send>(
        &self,
        states: (&Bound<'py, PyAny>, Option<&Bound<'py, PyAny>>),
        width: Option<usize>,
        read: impl Fn(&Columns<'_>, &mut Scratch, &mut [T]) -> Result<(), evaluate::NotANumber> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = states.0.py();
        let states = States::new(self.inner.inputs(), states.0, states.1)?;
        let each = self.each(py, &states, |columns, scratch| {
            let mut out = vec![T::default(); columns.rows() * width.unwrap_or(1)];
            read(columns, scratch, &mut out).map(|()| out)
        })?;
        let shape: Vec<usize> = states.shape.iter().copied().chain(width).collect();
        shaped(py, each.concat(), &shape)
    }

    pub(crate) fn states_of(&self, q: &Bound<'_, PyAny>) -> PyResult<Vec<u32>> {
        self.states_in(&Array::new(q, "q")?).map(Cow::into_owned)
    }

    /// The automaton states of an array, in C order.
    pub(crate) fn states_in<'a>(&self, q: &'a Array<'_>) -> PyResult<Cow<'a, [u32]>> {
        if q.shape().len() != 1 {
            return Err(wrong("q: wanted is an array of shape (n,)"));
        }
        let count = u64::from(self.inner.states());
        if let Some(states) = q.states(self.inner.states()) {
            return Ok(states);
        }
        let states = q.naturals().ok_or_else(|| {
            PyTypeError::new_err("q: automaton states are whole numbers from 0 on")
        })?;
        match states.iter().position(|&q| q >= count) {
            Some(at) => Err(PyIndexError::new_err(format!(
                "q[{at}] is {}, and the automaton has {count} states",
                states[at]
            ))),
            None => Ok(states.iter().map(|&q| q as u32).collect()),
        }
    }

    pub(crate) fn letters_in<'a>(
        &self,
        labels: &'a Array<'_>,
        rows: usize,
    ) -> PyResult<Letters<'a>> {
        let (shape, width) = (labels.shape(), self.names().len());
        match *shape {
            [count] if count == rows => {
                self.few_enough()?;
                labels.naturals().map(Letters::Bits).ok_or_else(|| {
                    PyTypeError::new_err(
                        "labels: letters are whole numbers whose bit i is proposition i; truth \
                         values have the shape (n, propositions)",
                    )
                })
            }
            [count, own] if count == rows && own == width => {
                labels::truths(self.names(), labels).map(Letters::Labels)
            }
            _ => Err(wrong(format!(
                "labels: an array of shape {shape:?}; wanted is ({rows}, {width}), truth values of \
                 the propositions, or ({rows},), letters"
            ))),
        }
    }

    /// Moves states, each on its own letter; without the GIL, if there are many.
    pub(crate) fn step_all(&self, py: Python<'_>, q: &mut [u32], letters: &Letters<'_>) {
        if q.len() < FEW {
            self.move_all(q, letters)
        } else {
            py.detach(|| self.move_all(q, letters))
        }
    }

    /// Moves states, each on its own letter.
    pub(crate) fn move_all(&self, q: &mut [u32], letters: &Letters<'_>) {
        let letters = match letters {
            Letters::Bits(bits) => automaton::Letters::Bits(bits),
            Letters::Labels(labels) => automaton::Letters::Labels(labels),
        };
        // To make the tables takes as long as some hundred moves.
        match (q.len() >= 256).then(|| self.by_bytes()).flatten() {
            Some(bytes) => bytes.step_batch(q, letters),
            None => self.automaton().step_batch(q, letters),
        }
    }

    /// The robustness of the propositions in so many rows.
    pub(crate) fn rows_of(&self, labels: &Bound<'_, PyAny>, rows: usize) -> PyResult<Vec<f64>> {
        let array = Array::new(labels, "labels")?;
        let (shape, width) = (array.shape(), self.names().len());
        if *shape != [rows, width] {
            let wanted = format!("wanted is ({rows}, {width})");
            return Err(wrong(format!("labels: an array of shape {shape:?}; {wanted}")));
        }
        let rho = array.robustness();
        match rho.iter().position(|rho| rho.is_nan()) {
            None => Ok(rho),
            Some(at) => {
                let (row, name) = (at / width, &self.names()[at % width]);
                Err(wrong(format!("labels: `{name}` is not a number (NaN) in row {row}")))
            }
        }
    }

    pub(crate) fn few_enough(&self) -> PyResult<()> {
        let count = self.names().len();
        if count <= 64 {
            return Ok(());
        }
        Err(wrong(format!(
            "a letter has 64 bits, and there are {count} propositions: use rows of labels"
        )))
    }

    /// One result for each trajectory of an array (N, T, d), of a list of arrays (T_i, d), or for
    /// the one of an array (T, d).
    pub(crate) fn by_trajectory<'py, T: numpy::Element + Copy + Send + for<'a> IntoPyObject<'a>>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, evaluate::NotANumber> + Sync,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = states.py();
        if let Some(all) = ragged(states)? {
            let mut results = Vec::new();
            for states in &all {
                let states = States::new(self.inner.inputs(), states, columns)?;
                results.extend(self.each(py, &states, &compute)?);
            }
            return shaped(py, results, &[all.len()]);
        }
        let states = States::new(self.inner.inputs(), states, columns)?;
        let results = self.each(py, &states, &compute)?;
        match &states.shape[..] {
            [] => Err(wrong("states: one state; wanted is a trajectory, an array of shape (T, d)")),
            [_] => {
                let result = shaped(py, results, &[1])?;
                result.call_method0("item").or_else(|_| result.get_item(0))
            }
            [outer @ .., _] => shaped(py, results, outer),
        }
    }
}

/// The arrays of a list, if it is one of arrays with two axes each.
fn ragged<'py>(states: &Bound<'py, PyAny>) -> PyResult<Option<Vec<Bound<'py, PyAny>>>> {
    use pyo3::types::{PyList, PyTuple};
    if !states.is_instance_of::<PyList>() && !states.is_instance_of::<PyTuple>() {
        return Ok(None);
    }
    let all: Vec<Bound<'py, PyAny>> = states.try_iter()?.collect::<PyResult<_>>()?;
    let ndim =
        |one: &Bound<'py, PyAny>| one.getattr("ndim").and_then(|n| n.extract::<usize>()).ok();
    Ok((!all.is_empty() && all.iter().all(|one| ndim(one) == Some(2))).then_some(all))
}
