//! What tasks take and give, as data.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl_compiler::translate;
use tltlc::evaluate::{self, InputKind};

/// How large an automaton may become.
#[pyclass(frozen, eq, hash, get_all, from_py_object, module = "tltl")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Budget {
    /// The most states, before the automaton is minimal.
    states: usize,
    /// The most nodes of its decision diagrams.
    nodes: usize,
    /// The most edges of the minimal automaton.
    edges: usize,
    /// The most products (cubes) of one guard.
    products: usize,
}

impl Budget {
    pub(crate) fn limits(&self) -> translate::Budget {
        let Self { states, nodes, edges, products } = *self;
        translate::Budget { states, nodes, edges, products }
    }
}

impl Default for Budget {
    fn default() -> Self {
        let translate::Budget { states, nodes, edges, products } = translate::Budget::default();
        Self { states, nodes, edges, products }
    }
}

#[pymethods]
impl Budget {
    #[new]
    #[pyo3(signature = (*, states=None, nodes=None, edges=None, products=None))]
    fn new(
        states: Option<usize>,
        nodes: Option<usize>,
        edges: Option<usize>,
        products: Option<usize>,
    ) -> Self {
        let known = Self::default();
        Self {
            states: states.unwrap_or(known.states),
            nodes: nodes.unwrap_or(known.nodes),
            edges: edges.unwrap_or(known.edges),
            products: products.unwrap_or(known.products),
        }
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        named.set_item("states", self.states)?;
        named.set_item("nodes", self.nodes)?;
        named.set_item("edges", self.edges)?;
        named.set_item("products", self.products)?;
        Ok((PyTuple::empty(py), named))
    }

    fn __repr__(&self) -> String {
        let Self { states, nodes, edges, products } = self;
        format!("Budget(states={states}, nodes={nodes}, edges={edges}, products={products})")
    }
}

/// A number that the predicates of a task read from a state.
#[pyclass(frozen, eq, get_all, module = "tltl")]
#[derive(Clone, PartialEq, Eq)]
pub struct Input {
    /// Its name: `x`, `pose.x`, `joints[2]`, or the proposition.
    name: String,
    /// The type that the task file declares, or `enum`; in a bare formula `variable`, any number, or
    /// `proposition`, which is given by its robustness.
    kind: &'static str,
    /// The unit that the task file declares.
    unit: Option<String>,
    /// The names of the values of an enumeration, in the order of their numbers; else empty.
    values: Vec<String>,
}

impl Input {
    pub(crate) fn new(input: &evaluate::Input) -> Self {
        let evaluate::Input { name, kind, unit, values } = input.clone();
        let kind = match kind {
            InputKind::Place(scalar) if values.is_empty() => scalar.name(),
            InputKind::Place(_) => "enum",
            InputKind::Variable => "variable",
            InputKind::Proposition => "proposition",
        };
        Self { name, kind, unit, values }
    }
}

#[pymethods]
impl Input {
    fn __repr__(&self) -> String {
        format!("Input(name={:?}, kind={:?})", self.name, self.kind)
    }
}

/// A move of the automaton, with its guard as text.
#[pyclass(frozen, eq, get_all, module = "tltl")]
#[derive(Clone, PartialEq, Eq)]
pub struct Edge {
    /// The state that it leaves.
    pub(crate) source: u32,
    /// The state that it enters.
    pub(crate) target: u32,
    /// The letters that take it, as a formula.
    pub(crate) guard: String,
}

#[pymethods]
impl Edge {
    fn __repr__(&self) -> String {
        format!("Edge(source={}, target={}, guard={:?})", self.source, self.target, self.guard)
    }
}

/// A trajectory that ran through a task: one entry for each row.
#[pyclass(frozen, get_all, module = "tltl")]
pub struct Run {
    /// The automaton state after each row: uint32, of shape (T,).
    pub(crate) states: Py<PyAny>,
    /// By how much each row makes the automaton move on: float64, of shape (T,); -inf where it is decided.
    pub(crate) progress: Py<PyAny>,
    /// The robustness of the whole trajectory; -inf if it is empty.
    pub(crate) robustness: f64,
    /// `satisfied`, `lost` or `open`.
    pub(crate) verdict: String,
    /// The first row after which the verdict was this one; `None` if there are no rows.
    pub(crate) since: Option<usize>,
}

#[pymethods]
impl Run {
    /// Whether it satisfies the task.
    #[getter]
    fn satisfied(&self) -> bool {
        self.verdict == "satisfied"
    }

    /// Whether the task is lost, whatever comes after it.
    #[getter]
    fn lost(&self) -> bool {
        self.verdict == "lost"
    }

    fn __repr__(&self) -> String {
        format!("Run(verdict={:?}, robustness={})", self.verdict, self.robustness)
    }
}
