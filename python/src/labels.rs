//! What holds in a state: a mapping of names, the names of what holds, or an array in the order of
//! the propositions. A number is a robustness, and holds if it is positive.

use std::borrow::Cow;

use numpy::{PyArray1, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyFrozenSet, PyMapping, PySet, PyString};
use tltl::Shared;

use super::array::Array;
use super::error::wrong;
use super::states::missing;

/// What a task reads, with its names as Python has them: a dictionary finds those at once.
pub(crate) struct Names {
    names: Vec<Py<PyString>>,
}

impl Names {
    pub(crate) fn new(propositions: &[Shared<str>]) -> Self {
        let interned = |py: Python<'_>| {
            propositions.iter().map(|name| PyString::intern(py, name).unbind()).collect()
        };
        Self { names: Python::attach(interned) }
    }

    /// The truth values of what is asked for at every step: a dictionary of truth values and numbers,
    /// or an array of truth values. `None` for everything else, mistakes included.
    fn of_known(&self, labels: &Bound<'_, PyAny>) -> Option<Vec<bool>> {
        let py = labels.py();
        if let Ok(mapping) = labels.cast_exact::<PyDict>() {
            let truth = |name: &Py<PyString>| {
                let value = mapping.get_item(name.bind(py)).ok()??;
                if let Ok(truth) = value.cast_exact::<PyBool>() {
                    return Some(truth.is_true());
                }
                let number = value.cast_exact::<PyFloat>().ok()?.value();
                (!number.is_nan()).then_some(number > 0.0)
            };
            return self.names.iter().map(truth).collect();
        }
        let array = labels.cast::<PyArray1<bool>>().ok()?;
        if array.len() != self.names.len() {
            return None;
        }
        (0..self.names.len()).map(|i| array.get_owned(i)).collect()
    }
}

/// One truth value for each of `propositions`.
pub(crate) fn row(
    (propositions, names): (&[Shared<str>], &Names),
    labels: &Bound<'_, PyAny>,
) -> PyResult<Vec<bool>> {
    if let Some(row) = names.of_known(labels) {
        return Ok(row);
    }
    Ok(robustness(propositions, labels)?.into_iter().map(|rho| rho > 0.0).collect())
}

/// The robustness of each of `propositions`: 1 or -1 for a truth value.
pub(crate) fn robustness(
    propositions: &[Shared<str>],
    labels: &Bound<'_, PyAny>,
) -> PyResult<Vec<f64>> {
    // Asked first, for what is an array is asked at every step, and whether it is a mapping takes long.
    let is_array = labels.cast_exact::<PyUntypedArray>().is_ok();
    if !is_array && let Ok(mapping) = labels.cast::<PyMapping>() {
        return propositions.iter().map(|name| of_mapping(mapping, name)).collect();
    }
    if labels.is_instance_of::<PySet>() || labels.is_instance_of::<PyFrozenSet>() {
        return of_names(propositions, labels);
    }
    if labels.is_instance_of::<PyString>() {
        return Err(wrong("labels: a text; wanted is a set of names, a mapping or an array"));
    }
    let array = Array::new(labels, "labels")?;
    match *array.shape() {
        [count] if count == propositions.len() => {
            let rho = array.robustness();
            match rho.iter().position(|rho| rho.is_nan()) {
                Some(at) => Err(nan(&propositions[at])),
                None => Ok(rho),
            }
        }
        ref shape => Err(wrong(format!(
            "labels: an array of shape {shape:?}; wanted is one value for each of the {} \
             propositions ({})",
            propositions.len(),
            listed(propositions)
        ))),
    }
}

fn nan(name: &str) -> PyErr {
    wrong(format!("`{name}` is not a number (NaN)"))
}

fn of_mapping(mapping: &Bound<'_, PyMapping>, name: &str) -> PyResult<f64> {
    if !mapping.contains(name)? {
        let given: Vec<String> = mapping.keys()?.iter().map(|key| key.to_string()).collect();
        return Err(missing(name, &given));
    }
    let value = mapping.get_item(name)?;
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(sign(truth.is_true()));
    }
    let number = match value.cast::<PyFloat>() {
        Ok(number) => number.value(),
        // A scalar of NumPy, or a whole number.
        Err(_) => match Array::new(&value, &format!("`{name}`"))?.robustness()[..] {
            [number] => number,
            _ => return Err(wrong(format!("`{name}` is more than one number"))),
        },
    };
    if number.is_nan() { Err(nan(name)) } else { Ok(number) }
}

const fn sign(truth: bool) -> f64 {
    if truth { 1.0 } else { -1.0 }
}

/// Names of what holds. All must be propositions, or a typing mistake would mean "does not hold".
fn of_names(propositions: &[Shared<str>], names: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let mut row = vec![sign(false); propositions.len()];
    for name in names.try_iter()? {
        let name: String = name?.extract()?;
        let at = propositions.iter().position(|known| **known == *name);
        let at = at.ok_or_else(|| {
            wrong(format!("the task has no proposition `{name}`; it has: {}", listed(propositions)))
        })?;
        row[at] = sign(true);
    }
    Ok(row)
}

fn listed(propositions: &[Shared<str>]) -> String {
    propositions.iter().map(|name| &**name).collect::<Vec<_>>().join(", ")
}

/// The numbers of an array whose last axis are `propositions`, as truth values in C order.
pub(crate) fn truths<'a>(
    propositions: &[Shared<str>],
    array: &'a Array<'_>,
) -> PyResult<Cow<'a, [bool]>> {
    array.truths().map_err(|at| {
        let width = propositions.len().max(1);
        let (row, name) = (at / width, &propositions[at % width]);
        wrong(format!("labels: `{name}` is not a number (NaN) in row {row}"))
    })
}

/// The robustness of the propositions in so many rows.
pub(crate) fn rows(
    propositions: &[Shared<str>],
    labels: &Bound<'_, PyAny>,
    rows: usize,
) -> PyResult<Vec<f64>> {
    let array = Array::new(labels, "labels")?;
    let (shape, width) = (array.shape(), propositions.len());
    if *shape != [rows, width] {
        let wanted = format!("wanted is ({rows}, {width})");
        return Err(wrong(format!("labels: an array of shape {shape:?}; {wanted}")));
    }
    let rho = array.robustness();
    match rho.iter().position(|rho| rho.is_nan()) {
        None => Ok(rho),
        Some(at) => {
            let (row, name) = (at / width, &propositions[at % width]);
            Err(wrong(format!("labels: `{name}` is not a number (NaN) in row {row}")))
        }
    }
}
