//! What tasks take and give, as data.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl_compiler::translate;
use tltlc::evaluate::{self, InputKind};

/// How large an automaton may become.
#[pyclass(frozen, eq, hash, get_all, from_py_object, module = "tltl")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub struct Budget {
    states: usize,
    nodes: usize,
    edges: usize,
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
    name: String,
    kind: &'static str,
    unit: Option<String>,
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
    pub(crate) source: u32,
    pub(crate) target: u32,
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
    pub(crate) states: Py<PyAny>,
    pub(crate) progress: Py<PyAny>,
    pub(crate) robustness: f64,
    pub(crate) verdict: String,
    pub(crate) since: Option<usize>,
}

#[pymethods]
impl Run {
    #[getter]
    fn satisfied(&self) -> bool {
        self.verdict == "satisfied"
    }

    #[getter]
    fn lost(&self) -> bool {
        self.verdict == "lost"
    }

    fn __repr__(&self) -> String {
        format!("Run(verdict={:?}, robustness={})", self.verdict, self.robustness)
    }
}
