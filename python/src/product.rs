//! `tltl.product`: the automata of several tasks side by side.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltlc::product::Operator;

use super::array::frozen;
use super::compiled::Compiled;
use super::error::wrong;
use super::labelled::task_of;
use super::task::Task;

const OPERATORS: [(&str, Operator); 2] = [("and", Operator::And), ("or", Operator::Or)];

pub(crate) fn operator(name: &str) -> PyResult<Operator> {
    let known = OPERATORS.iter().find(|(known, _)| *known == name);
    let known = known.map(|(_, operator)| *operator);
    known.ok_or_else(|| wrong(format!("operator is `{name}`, not `and` or `or`")))
}

pub(crate) fn name(operator: Operator) -> &'static str {
    OPERATORS.iter().find(|(_, known)| *known == operator).map_or("", |(name, _)| name)
}

/// The raw product of bare formulas (the paper's Definition 4): `"and"` is satisfied where all are,
/// `"or"` where one is.
///
/// Its states are the tuples of states that can be reached, so that what was learned for an operand
/// is looked up by the operand's own state; all tuples in which the verdict is final are one state.
/// The minimal automaton of the same formula may have fewer states: `a & b`.
///
/// Raises `ValueError` if an operand is not a bare formula, and `CompileError` if the automaton is
/// larger than the budget of the first allows.
///
/// >>> from tltl import Task, product
/// >>> both = product("and", Task("F a"), Task("F b"))
/// >>> both.components.tolist()
/// [[0, 0], [0, 1], [1, 0], [1, 1]]
/// >>> both.task.step(both.task.initial, {"a": False, "b": True})
/// 1
#[pyfunction]
#[pyo3(signature = (operator, /, *tasks))]
pub(crate) fn product(
    py: Python<'_>,
    operator: &str,
    tasks: Vec<Bound<'_, PyAny>>,
) -> PyResult<Product> {
    let operands = tasks.len();
    let tasks = tasks.iter().map(task_of).collect::<PyResult<_>>()?;
    let (task, components) = Task::product(py, self::operator(operator)?, tasks)?;
    let shape = [components.len(), operands];
    let components = frozen(py, components.concat(), &shape)?.unbind();
    Ok(Product { task, components })
}

/// A product of tasks. `product` makes it.
#[pyclass(frozen, get_all, module = "tltl")]
pub struct Product {
    /// The task as a whole, whose automaton is the product.
    task: Task,
    /// The state of each operand in each state: uint32, of shape (states, operands).
    components: Py<PyAny>,
}

#[pymethods]
impl Product {
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let product = py.import("tltl._core")?.getattr("product")?;
        Ok((product, self.task.factors(py)?))
    }

    fn __repr__(&self) -> String {
        format!("<Product {}>", self.task.written())
    }
}
