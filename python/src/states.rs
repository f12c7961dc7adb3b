//! Recorded states: arrays with a state in each row, or mappings with an array for each name.

use std::collections::HashMap;

use pyo3::prelude::*;
use pyo3::types::PyMapping;
use tltlc::evaluate::{Column, Columns, Input, NotANumber, Scratch};

use super::array::{Array, View};
use super::error::wrong;

/// States, in an array of shape (…, d), or in one array of shape (…) for each name.
pub(crate) struct States<'py> {
    arrays: Vec<Array<'py>>,
    /// For each input: its array, and its index on the last axis, if the array has one for it.
    inputs: Vec<(usize, Option<usize>)>,
    /// The shape without the last axis of an array of states; empty for a single state.
    pub(crate) shape: Vec<usize>,
}

impl<'py> States<'py> {
    /// The numbers of `inputs` in `states`. `columns` says where they are in an array: a mapping of
    /// names to indices, or the names of all columns in their order; without it, the array has the
    /// inputs in their order and nothing else.
    pub(crate) fn new(
        inputs: &[Input],
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        match states.cast::<PyMapping>() {
            Ok(mapping) => Self::by_name(inputs, mapping),
            Err(_) => Self::of_array(inputs, states, columns),
        }
    }

    fn by_name(inputs: &[Input], mapping: &Bound<'py, PyMapping>) -> PyResult<Self> {
        let mut arrays = Vec::new();
        let mut shape: Option<Vec<usize>> = None;
        for input in inputs {
            let object = named(mapping, &input.name)?;
            let name = format!("`{}`", input.name);
            let own = Array::new(&object, &name)?.shape().to_vec();
            let array = Array::new(&at_least(&object, 1)?, &name)?;
            if shape.as_ref().is_some_and(|shape| *shape != own) {
                let (first, name) = (&inputs[0].name, &input.name);
                return Err(wrong(format!("`{first}` and `{name}` have different shapes")));
            }
            shape = Some(own);
            arrays.push(array);
        }
        let shape =
            shape.ok_or_else(|| wrong("the task reads nothing: give an array of shape (…, 0)"))?;
        let inputs = (0..arrays.len()).map(|array| (array, None)).collect();
        Ok(Self { arrays, inputs, shape })
    }

    fn of_array(
        inputs: &[Input],
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Self> {
        let array = Array::new(states, "states")?;
        let mut shape = array.shape().to_vec();
        let Some(width) = shape.pop() else {
            return Err(wrong("states: a number; wanted is an array whose last axis is a state"));
        };
        let places = places(inputs, columns, width)?;
        let inputs = places.into_iter().map(|place| (0, Some(place))).collect();
        let array = Array::new(&at_least(states, 2)?, "states")?;
        Ok(Self { arrays: vec![array], inputs, shape })
    }

    /// Computes for each trajectory, without the GIL: once for all of them, for threads that wait for it
    /// at every trajectory get in each other's way.
    pub(crate) fn each<T: Send>(
        &self,
        py: Python<'_>,
        compute: impl Fn(&Columns<'_>, &mut Scratch) -> Result<T, NotANumber> + Sync,
    ) -> Result<Vec<T>, NotANumber> {
        let rows = self.shape.last().copied().unwrap_or(1);
        let all = self.columns();
        py.detach(|| {
            let mut scratch = Scratch::default();
            let one = |columns: &Vec<Column<'_>>| {
                let columns = Columns::new(rows, columns);
                compute(&columns.expect("all have the rows of the shape"), &mut scratch)
            };
            all.iter().map(one).collect()
        })
    }

    /// The columns of every trajectory: the rows along the last axis of the shape, in C order of the
    /// others.
    fn columns(&self) -> Vec<Vec<Column<'_>>> {
        let views: Vec<View<'_>> = self.arrays.iter().map(Array::view).collect();
        let along = self.shape.len().saturating_sub(1);
        let outer: &[usize] = &self.shape[..along];
        let of_one = |trajectory| {
            let mut at = vec![0; along + 1];
            let mut rest: usize = trajectory;
            for axis in (0..along).rev() {
                at[axis] = rest % outer[axis];
                rest /= outer[axis];
            }
            let column = |&(array, place): &(usize, Option<usize>)| {
                let at: Vec<usize> = at.iter().copied().chain(place).collect();
                views[array].column(along, &at)
            };
            self.inputs.iter().map(column).collect()
        };
        (0..outer.iter().product()).map(of_one).collect()
    }
}

/// The array with so many axes at least, new ones first: a single state is a row.
fn at_least<'py>(object: &Bound<'py, PyAny>, axes: u8) -> PyResult<Bound<'py, PyAny>> {
    object.py().import("numpy")?.call_method1(format!("atleast_{axes}d").as_str(), (object,))
}

/// The value of `name`, or an error that lists what there is.
fn named<'py>(mapping: &Bound<'py, PyMapping>, name: &str) -> PyResult<Bound<'py, PyAny>> {
    if mapping.contains(name)? {
        return mapping.get_item(name);
    }
    let given: Vec<String> = mapping.keys()?.iter().map(|key| key.to_string()).collect();
    Err(missing(name, &given))
}

/// What is asked for and is not there: what was given, the most similar name first.
pub(crate) fn missing(name: &str, given: &[String]) -> PyErr {
    let apart = |other: &str| distance(&name.to_lowercase(), &other.to_lowercase());
    let nearest = given.iter().min_by_key(|other| apart(other));
    let hint = nearest.filter(|other| apart(other) <= name.len() / 3);
    let hint = hint.map_or(String::new(), |other| format!("; did you mean `{other}`?"));
    let given = if given.is_empty() { "nothing".to_owned() } else { given.join(", ") };
    wrong(format!("`{name}` is missing; given: {given}{hint}"))
}

/// How many letters must change, be added or left out (Levenshtein).
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (i, letter) in one.chars().enumerate() {
        let mut diagonal = std::mem::replace(&mut row[0], i + 1);
        for (j, &other) in other.iter().enumerate() {
            let change = diagonal + usize::from(letter != other);
            diagonal = row[j + 1];
            row[j + 1] = change.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row[other.len()]
}

/// The column of each input in an array of `width` columns.
fn places(
    inputs: &[Input],
    columns: Option<&Bound<'_, PyAny>>,
    width: usize,
) -> PyResult<Vec<usize>> {
    let Some(columns) = columns else {
        let names: Vec<&str> = inputs.iter().map(|input| input.name.as_str()).collect();
        return match names.len() == width {
            true => Ok((0..width).collect()),
            false => Err(wrong(format!(
                "states: the last axis has {width} columns, and the task reads {} ({}); say where \
                 they are with `columns`",
                names.len(),
                names.join(", ")
            ))),
        };
    };
    let places: HashMap<String, usize> = match columns.cast::<PyMapping>() {
        Ok(mapping) => mapping.items()?.extract::<Vec<(String, usize)>>()?.into_iter().collect(),
        Err(_) => {
            let names: Vec<String> = columns.extract()?;
            if names.len() != width {
                let found = names.len();
                return Err(wrong(format!("columns: {found} names for {width} columns")));
            }
            names.into_iter().enumerate().map(|(at, name)| (name, at)).collect()
        }
    };
    let place = |input: &Input| match places.get(&input.name) {
        Some(&at) if at < width => Ok(at),
        Some(at) => Err(wrong(format!("columns: `{}` is column {at} of {width}", input.name))),
        None => {
            let mut given: Vec<String> = places.keys().cloned().collect();
            given.sort();
            Err(missing(&input.name, &given))
        }
    };
    inputs.iter().map(place).collect()
}
