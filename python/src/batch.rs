//! What a task reads: states, letters and trajectories, and what it makes of all of them at once.

use std::borrow::Cow;

use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyIndexError, PyTypeError};
use pyo3::prelude::*;
use tltl::{Acceptor, automaton};
use tltlc::evaluate::{self, Columns, Scratch};

use super::array::{Array, shaped};
use super::compiled::Compiled;
use super::error::wrong;
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
        let (shape, width) = (labels.shape(), self.propositions().len());
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
                labels::truths(self.propositions(), labels).map(Letters::Labels)
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

    /// Moves many states, as `Task.step_batch` says.
    pub(crate) fn stepped<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyArray1<u32>>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = q.py();
        let labels = Array::new(labels, "labels")?;
        if let Some(out) = out.filter(|out| out.is(q)) {
            // In place, if that is an array of automaton states without gaps.
            let count = out.len();
            let letters = self.letters_in(&labels, count)?;
            let mut target = out.try_readwrite().map_err(|_| read_only())?;
            if let Ok(states) = target.as_slice_mut()
                && states.iter().all(|&q| q < self.inner.states())
            {
                self.step_all(py, states, &letters);
                return Ok(out.as_any().clone());
            }
        }
        let q = Array::new(q, "q")?;
        let states = self.states_in(&q)?;
        let letters = self.letters_in(&labels, states.len())?;
        let Some(out) = out else {
            let (count, mut states) = (states.len(), states.into_owned());
            self.step_all(py, &mut states, &letters);
            return shaped(py, states, &[count]);
        };
        if out.len() != states.len() {
            let (found, wanted) = (out.len(), states.len());
            return Err(wrong(format!("out: {found} states; wanted are {wanted}")));
        }
        if let Ok(mut target) = out.try_readwrite()
            && let Ok(target) = target.as_slice_mut()
        {
            target.copy_from_slice(&states);
            self.step_all(py, target, &letters);
            return Ok(out.as_any().clone());
        }
        // It has gaps, or shares its memory with what is read.
        let mut states = states.into_owned();
        self.step_all(py, &mut states, &letters);
        drop(letters);
        drop((labels, q));
        let mut target = out.try_readwrite().map_err(|_| read_only())?;
        target.as_array_mut().iter_mut().zip(states).for_each(|(to, q)| *to = q);
        Ok(out.as_any().clone())
    }

    pub(crate) fn few_enough(&self) -> PyResult<()> {
        let count = self.propositions().len();
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
        let (results, shape) = self.of_trajectories(states, columns, compute)?;
        if shape.is_empty() {
            let result = shaped(py, results, &[1])?;
            return result.call_method0("item").or_else(|_| result.get_item(0));
        }
        shaped(py, results, &shape)
    }

    /// The results, and the shape in which they are meant: that of the trajectories, empty for one.
    pub(crate) fn of_trajectories<T: Send>(
        &self,
        states: &Bound<'_, PyAny>,
        columns: Option<&Bound<'_, PyAny>>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, evaluate::NotANumber> + Sync,
    ) -> PyResult<(Vec<T>, Vec<usize>)> {
        let py = states.py();
        if let Some(all) = ragged(states)? {
            let mut results = Vec::new();
            for states in &all {
                let states = States::new(self.evaluator().inputs(), states, columns)?;
                results.extend(self.each(py, &states, &compute)?);
            }
            return Ok((results, vec![all.len()]));
        }
        let mut states = States::new(self.evaluator().inputs(), states, columns)?;
        let results = self.each(py, &states, &compute)?;
        match states.shape.pop() {
            None => {
                Err(wrong("states: one state; wanted is a trajectory, an array of shape (T, d)"))
            }
            Some(_) => Ok((results, states.shape)),
        }
    }
}

fn read_only() -> PyErr {
    wrong("out: the array is read-only")
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
