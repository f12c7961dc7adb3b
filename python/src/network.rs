//! `tltl.NetworkPolicy`: a network with a head for each automaton state.

use std::path::PathBuf;

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::network::policy::NetworkPolicy as Network;
use tltlc::emit;

use super::array::shaped;
use super::document;
use super::error::wrong;

/// A policy that is a network: features of a state in, for each automaton state in which the task
/// goes on a value of each action out. `tltl.sb3.export` makes it of what was learned elsewhere.
///
/// It does not move the automaton: the task does.
#[pyclass(frozen, eq, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct NetworkPolicy(Network);

impl NetworkPolicy {
    fn read(text: &str) -> PyResult<Self> {
        document::parsed(serde_json::from_str(text)).map(Self)
    }

    /// A state in which the task goes on, and inputs as many as the network reads.
    fn checked(&self, q: i64, inputs: &PyReadonlyArray1<'_, f32>) -> PyResult<(u32, Vec<f32>)> {
        let wanted = self.0.network().shape().inputs;
        let found = inputs.as_array().len();
        if found != wanted {
            return Err(wrong(format!("inputs: {found} numbers; the network reads {wanted}")));
        }
        let q = u32::try_from(q).ok().filter(|&q| q < self.0.document().automaton.states);
        let live = q.filter(|&q| self.0.head(q).is_some());
        let live = live.ok_or_else(|| {
            PyIndexError::new_err("q is not an automaton state in which the task goes on")
        })?;
        Ok((live, inputs.as_array().to_vec()))
    }
}

#[pymethods]
impl NetworkPolicy {
    /// The policy of a document, as `to_json` writes it.
    ///
    /// Raises `ValueError` if it is not one; the message names the field.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        Self::read(text)
    }

    /// The document of the policy, which `tltlc policy` reads too.
    fn to_json(&self) -> PyResult<String> {
        document::parsed(serde_json::to_string(&self.0))
    }

    /// Writes the document to a file, which is replaced as a whole.
    fn save(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        document::save(py, &path, &self.to_json()?)
    }

    /// The policy that `save` wrote.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        Self::read(&document::load(py, path)?)
    }

    /// The policy as Rust source that needs no standard library and nothing of this package; with a
    /// `path` it is written there too.
    #[pyo3(signature = (path=None))]
    fn emit_rust(&self, py: Python<'_>, path: Option<PathBuf>) -> PyResult<String> {
        document::emitted(py, emit::policy::rust(&self.to_json()?).map_err(wrong)?, path)
    }

    /// The values of the actions at `q`, of float32 inputs of shape (inputs,): float32, of shape
    /// (actions,).
    ///
    /// Raises `IndexError` if the task does not go on at `q`.
    fn values<'py>(
        &self,
        py: Python<'py>,
        q: i64,
        inputs: PyReadonlyArray1<'py, f32>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (q, inputs) = self.checked(q, &inputs)?;
        let values = self.0.values(q, &inputs, &[]);
        let count = values.len();
        shaped(py, values, &[count])
    }

    /// The action of the largest value at `q`.
    ///
    /// Raises `ValueError` if an action is numbers: `control` has them.
    fn act(&self, q: i64, inputs: PyReadonlyArray1<'_, f32>) -> PyResult<usize> {
        let (q, inputs) = self.checked(q, &inputs)?;
        if self.0.network().form().controls.is_some() {
            return Err(wrong("an action of this policy is numbers: use `control`"));
        }
        Ok(self.0.act(q, &inputs, &[]))
    }

    /// The numbers that the action at `q` is: float32, of shape (actions,). Only for networks of
    /// continuous actions, as those of SAC, TD3, and PPO in a `Box`.
    ///
    /// Raises `ValueError` if the policy chooses among actions: `act` does.
    fn control<'py>(
        &self,
        py: Python<'py>,
        q: i64,
        inputs: PyReadonlyArray1<'py, f32>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let (q, inputs) = self.checked(q, &inputs)?;
        let numbers = self.0.control(q, &inputs, &[]);
        let numbers =
            numbers.ok_or_else(|| wrong("this policy chooses among actions: use `act`"))?;
        let count = numbers.len();
        shaped(py, numbers, &[count])
    }

    /// The formula of its task.
    #[getter]
    fn formula(&self) -> &str {
        &self.0.document().formula
    }

    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let load = py.import("tltl")?.getattr("NetworkPolicy")?.getattr("from_json")?;
        Ok((load, PyTuple::new(py, [self.to_json()?])?))
    }

    fn __repr__(&self) -> String {
        let shape = self.0.network().shape();
        format!(
            "<NetworkPolicy for `{}`: {} inputs, {:?} hidden, {} actions>",
            self.0.document().task,
            shape.inputs,
            shape.hidden,
            shape.actions
        )
    }
}
