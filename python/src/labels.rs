//! What holds in a state: a mapping of names, the names of what holds, or an array in the order of
//! the propositions. A number is a robustness, and holds if it is positive.

use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFrozenSet, PyMapping, PySet, PyString};
use tltl::Shared;

use super::array::Array;
use super::error::wrong;
use super::states::missing;

/// One truth value for each of `propositions`.
pub(crate) fn row(propositions: &[Shared<str>], labels: &Bound<'_, PyAny>) -> PyResult<Vec<bool>> {
    if let Ok(mapping) = labels.cast::<PyMapping>() {
        return propositions.iter().map(|name| of_mapping(mapping, name)).collect();
    }
    if labels.is_instance_of::<PySet>() || labels.is_instance_of::<PyFrozenSet>() {
        return of_names(propositions, labels);
    }
    if labels.is_instance_of::<PyString>() {
        return Err(wrong("labels: a text; wanted is a set of names, a mapping or an array"));
    }
    let array = Array::new(labels, "labels")?;
    match array.view().shape[..] {
        [count] if count == propositions.len() => truths(propositions, &array),
        ref shape => Err(wrong(format!(
            "labels: an array of shape {shape:?}; wanted is one value for each of the {} \
             propositions ({})",
            propositions.len(),
            listed(propositions)
        ))),
    }
}

fn of_mapping(mapping: &Bound<'_, PyMapping>, name: &str) -> PyResult<bool> {
    if !mapping.contains(name)? {
        let given: Vec<String> = mapping.keys()?.iter().map(|key| key.to_string()).collect();
        return Err(missing(name, &given));
    }
    let value = mapping.get_item(name)?;
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(truth.is_true());
    }
    let number: f64 = value
        .extract()
        .map_err(|_| wrong(format!("`{name}` is neither a truth value nor a number: {value}")))?;
    if number.is_nan() {
        Err(wrong(format!("`{name}` is not a number (NaN)")))
    } else {
        Ok(number > 0.0)
    }
}

/// Names of what holds. All must be propositions, or a typing mistake would mean "does not hold".
fn of_names(propositions: &[Shared<str>], names: &Bound<'_, PyAny>) -> PyResult<Vec<bool>> {
    let mut row = vec![false; propositions.len()];
    for name in names.try_iter()? {
        let name: String = name?.extract()?;
        let at = propositions.iter().position(|known| **known == *name);
        let at = at.ok_or_else(|| {
            wrong(format!("the task has no proposition `{name}`; it has: {}", listed(propositions)))
        })?;
        row[at] = true;
    }
    Ok(row)
}

fn listed(propositions: &[Shared<str>]) -> String {
    propositions.iter().map(|name| &**name).collect::<Vec<_>>().join(", ")
}

/// The numbers of an array whose last axis are `propositions`, as truth values in C order.
pub(crate) fn truths(propositions: &[Shared<str>], array: &Array<'_>) -> PyResult<Vec<bool>> {
    array.truths().map_err(|at| {
        let width = propositions.len().max(1);
        let (row, name) = (at / width, &propositions[at % width]);
        wrong(format!("labels: `{name}` is not a number (NaN) in row {row}"))
    })
}
