//! `tltl.Task`: a task that is compiled while Python runs.

use std::collections::hash_map::DefaultHasher;
use std::convert::Infallible;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, OnceLock};

use numpy::PyArray1;
use pyo3::basic::CompareOp;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::automaton::ByBytes;
use tltl::reward::Ends;
use tltl::{Acceptor, Automaton, Shared, robustness};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::source::Source;
use tltlc::emit;
use tltlc::evaluate::{Columns, Evaluator, NotANumber, Scratch};
use tltlc::product::Operator;
use tltlc::task::{self, Bound as Made, NotBare, RawProduct, TaskFile, Verdict};

use super::array::{frozen, shaped};
use super::certificate::preformatted;
use super::compiled::Compiled;
use super::error::{diagnostics, mistaken, warn, wrong};
use super::labels::{self, Names};
use super::restore::{bound, reduced};
use super::shown::printed;
use super::values::{Budget, Run};

/// The largest number of propositions whose table of all letters is given out: 65,536 columns.
const TABLE: usize = 16;

/// A formula of temporal logic, compiled to its minimal automaton.
///
/// A task never changes. It is equal to others of the same source, name and arguments, and is
/// pickled by them. Threads may share it.
///
/// Raises `CompileError` if there is a mistake in the formula.
///
/// >>> from tltl import Task
/// >>> task = Task("!wet U home")
/// >>> task.step(task.initial, {"wet": False, "home": True}) == task.accepting
/// True
#[pyclass(frozen, module = "tltl")]
#[derive(Clone)]
pub struct Task {
    pub(crate) inner: task::Task,
    /// Where it ends, which rewards ask at every step.
    pub(crate) ends: Arc<Ends>,
    budget: Budget,
    /// The tasks that it is the raw product of, if it is one.
    factors: Option<Arc<(Operator, Vec<Self>)>>,
    known: Arc<Known>,
}

/// What is made once for all copies of a task.
struct Known {
    names: Names,
    bytes: OnceLock<Option<ByBytes>>,
}

impl Task {
    pub(crate) fn of(inner: task::Task, budget: Budget) -> Self {
        let names = Names::new(inner.automaton().propositions());
        let known = Arc::new(Known { names, bytes: OnceLock::new() });
        Self { ends: Arc::new(Ends::of(&inner)), inner, budget, known, factors: None }
    }

    /// The automaton by bytes, if it is a diagram that is worth it.
    pub(crate) fn by_bytes(&self) -> Option<&ByBytes> {
        self.known.bytes.get_or_init(|| self.automaton().by_bytes()).as_ref()
    }

    /// The state after `q`, which is one.
    pub(crate) fn moved(&self, q: u32, row: &[bool]) -> u32 {
        let next = self.automaton().next(q, |i| Ok::<_, Infallible>(row[i]));
        next.unwrap_or_else(|never| match never {})
    }

    /// The raw product of tasks, and for each of its states those of the tasks.
    pub(crate) fn product(
        py: Python<'_>,
        operator: Operator,
        operands: Vec<Self>,
    ) -> PyResult<(Self, Vec<Vec<u32>>)> {
        let Some(first) = operands.first() else { return Err(wrong("tasks: none are given")) };
        let (budget, limits) = (first.budget.clone(), first.budget.limits());
        let inner: Vec<&task::Task> = operands.iter().map(|operand| &operand.inner).collect();
        let whole = py.detach(|| RawProduct::new(operator, &inner, limits));
        let whole = whole.map_err(|error| wrong(error.to_string()))?;
        let RawProduct { task, components } = whole.map_err(|error| mistaken(py, &error))?;
        let factors = Some(Arc::new((operator, operands)));
        Ok((Self { factors, ..Self::of(task, budget) }, components))
    }

    fn source(&self) -> &Source {
        self.inner.entry().file().source()
    }

    pub(crate) fn dfa(&self) -> &Dfa {
        self.inner.dfa()
    }

    pub(crate) fn automaton(&self) -> &Automaton {
        self.inner.automaton()
    }

    /// The arguments of `product` that make a product again.
    pub(crate) fn factors<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let Some(factors) = &self.factors else { return Ok(PyTuple::empty(py)) };
        let (operator, operands) = &**factors;
        let mut arguments = vec![super::product::name(*operator).into_pyobject(py)?.into_any()];
        for operand in operands {
            arguments.push(operand.clone().into_pyobject(py)?.into_any());
        }
        PyTuple::new(py, arguments)
    }

    /// A state of the automaton, checked.
    pub(crate) fn state(&self, q: i64) -> PyResult<u32> {
        let count = self.inner.states();
        match u32::try_from(q) {
            Ok(q) if q < count => Ok(q),
            _ => Err(PyIndexError::new_err(format!(
                "q is {q}, and the automaton has {count} states"
            ))),
        }
    }

    /// A product has the text of the formula that it is the automaton of.
    fn key(&self) -> (&str, Option<&str>, String, bool) {
        let arguments = format!("{:?}", self.inner.arguments());
        (self.source().text(), self.inner.entry().name(), arguments, self.factors.is_some())
    }

    fn joined(&self, py: Python<'_>, operator: &str, other: &Self) -> PyResult<Self> {
        if [self, other].iter().any(|task| !task.inner.entry().is_bare()) {
            return Err(wrong(NotBare.to_string()));
        }
        let text = format!("({}) {operator} ({})", self.written(), other.written());
        Self::new(py, &text, Some(self.budget.clone()))
    }
}

impl Compiled for Task {
    fn entry(&self) -> &task::Entry {
        self.inner.entry()
    }

    fn evaluator(&self) -> &Evaluator {
        self.inner.evaluator()
    }

    fn propositions(&self) -> &[Shared<str>] {
        self.automaton().propositions()
    }

    fn names(&self) -> &Names {
        &self.known.names
    }

    fn parts(&self) -> Option<usize> {
        None
    }

    fn follow(
        &self,
        columns: &Columns<'_>,
        scratch: &mut Scratch,
    ) -> Result<task::Run, NotANumber> {
        self.inner.run(columns, scratch)
    }
}

#[pymethods]
impl Task {
    #[new]
    #[pyo3(signature = (formula, /, *, budget=None))]
    fn new(py: Python<'_>, formula: &str, budget: Option<Budget>) -> PyResult<Self> {
        let budget = budget.unwrap_or_default();
        let limits = budget.limits();
        let (inner, warnings) = py
            .detach(|| {
                let inner = task::compile(formula, limits)?;
                let warnings = inner.entry().file().warnings();
                Ok((inner, warnings))
            })
            .map_err(|error| mistaken(py, &error))?;
        warn(py, inner.entry().file().source(), &warnings)?;
        Ok(Self::of(inner, budget))
    }

    /// The task of an automaton that another tool wrote in the HOA format (Spot, Owl, ltlf2dfa). It
    /// must be deterministic, and accept for good once it accepts.
    ///
    /// There is no formula: `text` is its own name or `name`, and `robustness` that of the best run
    /// through the automaton. States are given by the names of the propositions, as for a bare
    /// formula.
    ///
    /// Raises `CompileError` if the text is not such an automaton.
    ///
    /// >>> from tltl import Task
    /// >>> theirs = Task.from_hoa(Task("!wet U home").to_hoa())
    /// >>> theirs.fingerprint == Task("!wet U home").fingerprint
    /// True
    #[staticmethod]
    #[pyo3(signature = (text, /, *, name="automaton"))]
    fn from_hoa(py: Python<'_>, text: &str, name: &str) -> PyResult<Self> {
        let file = TaskFile::of_automaton(Source::new(name, text));
        let file = file.map_err(|error| mistaken(py, &error))?;
        match bound(&file, None, &[])? {
            Made::Plain(inner) => Ok(Self::of(inner, Budget::default())),
            Made::Factored(_) => Err(wrong("an automaton is not factored")),
        }
    }

    /// The formula, without comments and laid out anew.
    #[getter]
    fn text(&self) -> &str {
        self.written()
    }

    /// Its name in the task file; `None` for a bare formula.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.inner.entry().name()
    }

    /// The names of what the automaton reads, in the order of the bits of a letter.
    #[getter]
    #[pyo3(name = "propositions")]
    fn own_propositions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.listed_propositions(py)
    }

    /// What the predicates read from a state, in the order of the columns.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.listed_inputs(py)
    }

    /// The number of automaton states, numbered from 0.
    #[getter]
    fn num_states(&self) -> u32 {
        self.inner.states()
    }

    /// The state before anything is read.
    #[getter]
    pub(crate) fn initial(&self) -> u32 {
        Automaton::INITIAL
    }

    /// The state in which the task is satisfied, for ever; `None` if there is none.
    #[getter]
    pub(crate) fn accepting(&self) -> Option<u32> {
        self.automaton().accepting()
    }

    /// The state in which the task is lost, for ever; `None` if it cannot be lost.
    #[getter]
    pub(crate) fn trap(&self) -> Option<u32> {
        self.automaton().trap()
    }

    /// How long a step lasts, in seconds, if the task file says it (`step 0.1 s`) in a unit of time:
    /// `s`, `ms`, `us`, `ns`, `min` or `h`.
    #[getter]
    fn step_seconds(&self) -> Option<f64> {
        self.seconds()
    }

    /// All moves, self-loops included, each with its guard as text.
    #[getter]
    fn edges<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.moves())
    }

    /// The fewest moves from each state to the accepting one: int32, -1 where there is no way.
    #[getter]
    fn distances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let distance = |q| self.inner.distance(q).map_or(-1, |distance| distance as i32);
        let distances: Vec<i32> = (0..self.inner.states()).map(distance).collect();
        let count = distances.len();
        frozen(py, distances, &[count])
    }

    /// The next state of each state (rows) and letter (columns): uint32; `None` for more than 16
    /// propositions.
    #[getter]
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        if self.propositions().len() > TABLE {
            return Ok(None);
        }
        let (states, letters) = (self.inner.states(), 1_u64 << self.propositions().len());
        let mut table: Vec<u32> = (0..states).flat_map(|q| (0..letters).map(move |_| q)).collect();
        let all: Vec<u64> = (0..states).flat_map(|_| 0..letters).collect();
        self.automaton().step_batch(&mut table, &all[..]);
        frozen(py, table, &[states as usize, letters as usize]).map(Some)
    }

    /// A number of 16 digits for the numbered automaton: what was learned with one automaton fits
    /// those of the same fingerprint.
    #[getter]
    pub(crate) fn fingerprint(&self) -> String {
        self.inner.fingerprint()
    }

    /// What the author should look at.
    #[getter]
    fn warnings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let warnings = self.inner.entry().file().warnings();
        diagnostics(py, self.source(), &warnings)
    }

    /// The state after `q` has read what holds: a mapping of names to truth values or robustness, a
    /// set of the names that hold, or an array in the order of `propositions`.
    ///
    /// Raises `ValueError` if a proposition is missing, `IndexError` if `q` is not a state.
    fn step(&self, q: i64, labels: &Bound<'_, PyAny>) -> PyResult<u32> {
        Ok(self.moved(self.state(q)?, &self.row(labels)?))
    }

    /// What holds, in the order of `propositions`: bool, of shape (propositions,). `labels` as for
    /// `step`.
    fn valuation<'py>(
        &self,
        py: Python<'py>,
        labels: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let row = self.row(labels)?;
        let count = row.len();
        shaped(py, row, &[count])
    }

    /// By how much a state makes the automaton move on from `q`, the trap apart: ρ(s, D_φ^q). `labels`
    /// as for `step`; numbers are the robustness of the propositions, and truth values 1 or -1.
    ///
    /// Or the same for many: `q` of shape (n,) and `labels` of shape (n, propositions).
    fn progress_robustness<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = q.py();
        let rho = |q, row: &[f64]| robustness::guard(self.automaton().progress(q), |i| row[i]);
        if let Ok(q) = q.extract() {
            let row = labels::robustness(self.propositions(), labels)?;
            return Ok(rho(self.state(q)?, &row).into_pyobject(py)?.into_any());
        }
        let states = self.states_of(q)?;
        let rows = labels::rows(self.propositions(), labels, states.len())?;
        let width = self.propositions().len();
        let row = |i: usize| &rows[i * width..][..width];
        let all = states.iter().enumerate().map(|(i, &q)| rho(q, row(i))).collect();
        shaped(py, all, &[states.len()])
    }

    /// The states after `q`, of shape (n,), has read `labels`: truth values of shape (n,
    /// propositions), or letters of shape (n,), whose bit i is proposition i.
    ///
    /// With `out`, a uint32 array, the result is written there; it may be `q`.
    #[pyo3(signature = (q, labels, *, out=None))]
    fn step_batch<'py>(
        &self,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyArray1<u32>>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.stepped(q, labels, out)
    }

    /// Which propositions hold in each of `states`, of shape (…, d): bool, of shape (…, propositions).
    ///
    /// `states` may also be a mapping of names to arrays of shape (…). `columns` says where an array
    /// has what the task reads: a mapping of names to indices, or the names of all columns.
    ///
    /// Raises `ValueError` if a predicate is not a number.
    #[pyo3(signature = (states, *, columns=None))]
    fn labels<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.labels_of(states, columns)
    }

    /// The robustness of each proposition in each of `states`, as `labels`: float64.
    #[pyo3(signature = (states, *, columns=None))]
    fn rho<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.rho_of(states, columns)
    }

    /// What holds in each of `states`, of shape (…, d), as bits: uint64, of shape (…).
    #[pyo3(signature = (states, *, columns=None))]
    fn letters<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.few_enough()?;
        self.by_row((states, columns), None, |columns, scratch, out: &mut [u64]| {
            self.inner.evaluator().letters(columns, scratch, out)
        })
    }

    /// The robustness of a trajectory of shape (T, d), or of each of many: of shape (N, T, d), or a
    /// list of arrays of shape (T_i, d).
    #[pyo3(signature = (states, *, columns=None))]
    fn robustness<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.by_trajectory(states, columns, |columns, scratch| {
            self.inner.robustness(columns, scratch)
        })
    }

    /// Whether a trajectory satisfies the task; shapes as for `robustness`.
    #[pyo3(signature = (states, *, columns=None))]
    fn satisfied<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.by_trajectory(states, columns, |columns, scratch| {
            Ok(self.inner.run(columns, scratch)?.verdict() == Verdict::Satisfied)
        })
    }

    /// A trajectory of shape (T, d), followed row by row.
    #[pyo3(signature = (states, *, columns=None))]
    fn run(&self, states: &Bound<'_, PyAny>, columns: Option<&Bound<'_, PyAny>>) -> PyResult<Run> {
        self.run_of(states, columns)
    }

    /// The task on its way, to be told what holds, one state after the other.
    fn monitor(&self) -> super::monitor::Monitor {
        super::monitor::Monitor::new(self.clone())
    }

    /// The task in plain English, with shortest ways to satisfy it and to lose it.
    fn explain(&self) -> String {
        self.explained()
    }

    /// A page for a browser, one file without a network: the automaton and what it asks for, and, with
    /// `states` (shapes as for `robustness`), how it followed these trajectories, with a slider.
    #[pyo3(signature = (states=None, *, columns=None))]
    fn to_html(
        &self,
        states: Option<&Bound<'_, PyAny>>,
        columns: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        self.page(states, columns)
    }

    /// A shortest trajectory on which the two tasks differ, or that they are equal.
    fn diff(&self, other: &Self) -> String {
        self.difference(other)
    }

    /// The automaton as a picture on a white ground.
    fn svg(&self) -> String {
        emit::svg::automaton(&self.title(), self.dfa())
    }

    fn _repr_svg_(&self) -> String {
        self.svg()
    }

    /// In a notebook: the automaton, and what it asks for.
    fn _repr_html_(&self) -> String {
        format!("<div>{}</div>{}", self.svg(), preformatted(&self.explain()))
    }

    /// The automaton as a `networkx.MultiDiGraph`: nodes are states, with `initial`, `accepting` and
    /// `trap`; each edge has its `guard`.
    ///
    /// Raises `ImportError` if networkx is not installed.
    fn to_networkx<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.graph(py)
    }

    /// The automaton for Graphviz.
    fn to_dot(&self) -> PyResult<String> {
        printed(emit::dot::automaton(&self.title(), self.dfa()))
    }

    /// The automaton in the HOA format.
    fn to_hoa(&self) -> PyResult<String> {
        printed(emit::hoa::automaton(&self.title(), self.dfa()))
    }

    /// The automaton as JSON.
    fn to_json(&self) -> PyResult<String> {
        printed(emit::json::automaton(self.text(), self.dfa()))
    }

    /// The automaton for Mermaid.
    fn to_mermaid(&self) -> PyResult<String> {
        printed(emit::mermaid::automaton(&self.title(), self.dfa()))
    }

    /// The task as Rust source.
    fn to_rust(&self) -> String {
        let entry = self.inner.entry();
        match entry.is_automaton() {
            true => emit::rust::foreign(self.text(), self.dfa()),
            false => emit::rust::file(entry.file().compiled()),
        }
    }

    fn __and__(&self, py: Python<'_>, other: &Self) -> PyResult<Self> {
        self.joined(py, "&&", other)
    }

    fn __or__(&self, py: Python<'_>, other: &Self) -> PyResult<Self> {
        self.joined(py, "||", other)
    }

    fn __richcmp__(&self, other: &Bound<'_, PyAny>, operator: CompareOp) -> PyResult<Py<PyAny>> {
        let py = other.py();
        let Ok(other) = other.cast::<Self>() else { return Ok(py.NotImplemented()) };
        let equal = self.key() == other.get().key();
        match operator {
            CompareOp::Eq => Ok(equal.into_pyobject(py)?.to_owned().into_any().unbind()),
            CompareOp::Ne => Ok((!equal).into_pyobject(py)?.to_owned().into_any().unbind()),
            _ => Ok(py.NotImplemented()),
        }
    }

    fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.key().hash(&mut hasher);
        hasher.finish()
    }

    /// By source: unpickling compiles.
    fn __reduce__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        if let Some(factors) = &self.factors {
            let restore = py.import("tltl._core")?.getattr("restore_product")?;
            let (operator, operands) = &**factors;
            let state = (super::product::name(*operator), operands.clone(), self.fingerprint());
            return Ok((restore, state.into_pyobject(py)?));
        }
        let (entry, arguments) = (self.inner.entry(), self.inner.arguments());
        reduced(py, entry, arguments, &self.budget, &self.fingerprint())
    }

    fn __repr__(&self) -> String {
        match self.name() {
            None if self.inner.entry().is_automaton() => format!("<Task {}>", self.text()),
            None => format!("Task({:?})", self.text()),
            Some(name) => format!("<Task {name} = {}>", self.text()),
        }
    }
}
