//! `tltl.Task`: a task that is compiled while Python runs.

use std::collections::hash_map::DefaultHasher;
use std::convert::Infallible;
use std::hash::{Hash, Hasher};
use std::sync::{Arc, OnceLock};

use numpy::{PyArray1, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::basic::CompareOp;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::automaton::ByBytes;
use tltl::reward::Ends;
use tltl::{Acceptor, Automaton, Shared, robustness};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::source::Source;
use tltlc::diff::{Side, of_definitions};
use tltlc::emit;
use tltlc::explain;
use tltlc::product::Operator;
use tltlc::task::{self, Bound as Made, NotBare, RawProduct, TaskFile, Value, Verdict};

use super::array::{Array, frozen, shaped};
use super::certificate::preformatted;
use super::error::{diagnostics, mistaken, warn, wrong};
use super::factored::Factored;
use super::labels::{self, Names};
use super::states::States;
use super::values::{Budget, Edge, Input, Run};

/// The largest number of propositions whose table of all letters is given out: 65,536 columns.
const TABLE: usize = 16;

/// Units of time, in seconds.
const SECONDS: [(&str, f64); 6] =
    [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9), ("min", 60.0), ("h", 3600.0)];

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

    /// The truth values of `labels`, in the order of the propositions.
    pub(crate) fn row(&self, labels: &Bound<'_, PyAny>) -> PyResult<Vec<bool>> {
        labels::row((self.names(), &self.known.names), labels)
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

    fn dfa(&self) -> &Dfa {
        self.inner.dfa()
    }

    pub(crate) fn automaton(&self) -> &Automaton {
        self.inner.automaton()
    }

    pub(crate) fn names(&self) -> &[Shared<str>] {
        self.automaton().propositions()
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

    pub(crate) fn described(&self) -> &str {
        self.text()
    }

    fn title(&self) -> String {
        let task = self.inner.entry().task();
        task.name
            .as_ref()
            .map_or_else(|| task.text.clone(), |name| format!("{name} = {}", task.text))
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

    /// All moves, with their guards as text.
    fn moves(&self) -> Vec<Edge> {
        let dfa = self.dfa();
        let mut guards = tltl_compiler::dfa::Guards::new(dfa);
        let mut edges = Vec::new();
        for source in dfa.states() {
            for (target, guard) in guards.edges(source) {
                let cubes = guards.cubes(guard);
                let guard = emit::sum::Sum::new(&dfa.propositions, &cubes).to_string();
                edges.push(Edge { source, target, guard });
            }
        }
        edges
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
        let text = format!("({}) {operator} ({})", self.source().text(), other.source().text());
        Self::new(py, &text, Some(self.budget.clone()))
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
    /// There is no formula: `text` is the name in the file, and `robustness` that of the best run
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

    /// The formula, as it was written.
    #[getter]
    fn text(&self) -> &str {
        &self.inner.entry().task().text
    }

    /// Its name in the task file; `None` for a bare formula.
    #[getter]
    fn name(&self) -> Option<&str> {
        self.inner.entry().name()
    }

    /// The names of what the automaton reads, in the order of the bits of a letter.
    #[getter]
    fn propositions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.names().iter().map(|name| name.to_string()))
    }

    /// What the predicates read from a state, in the order of the columns.
    #[getter]
    fn inputs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.inner.inputs().iter().map(Input::new))
    }

    /// The number of automaton states, numbered from 0.
    #[getter]
    fn num_states(&self) -> u32 {
        self.inner.states()
    }

    /// The state before anything is read.
    #[getter]
    fn initial(&self) -> u32 {
        Automaton::INITIAL
    }

    /// The state in which the task is satisfied, for ever; `None` if there is none.
    #[getter]
    fn accepting(&self) -> Option<u32> {
        self.automaton().accepting()
    }

    /// The state in which the task is lost, for ever; `None` if it cannot be lost.
    #[getter]
    fn trap(&self) -> Option<u32> {
        self.automaton().trap()
    }

    /// How long a step lasts, in seconds, if the task file says it (`step 0.1 s`) in a unit of time:
    /// `s`, `ms`, `us`, `ns`, `min` or `h`.
    #[getter]
    fn step_seconds(&self) -> Option<f64> {
        let (amount, unit) = self.inner.entry().file().step()?;
        SECONDS.iter().find(|(name, _)| *name == unit).map(|(_, seconds)| seconds * amount)
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
        if self.names().len() > TABLE {
            return Ok(None);
        }
        let (states, letters) = (self.inner.states(), 1_u64 << self.names().len());
        let mut table: Vec<u32> = (0..states).flat_map(|q| (0..letters).map(move |_| q)).collect();
        let all: Vec<u64> = (0..states).flat_map(|_| 0..letters).collect();
        self.automaton().step_batch(&mut table, &all[..]);
        frozen(py, table, &[states as usize, letters as usize]).map(Some)
    }

    /// A number of 16 digits for the numbered automaton: what was learned with one automaton fits
    /// those of the same fingerprint.
    #[getter]
    fn fingerprint(&self) -> String {
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
            let row = labels::robustness(self.names(), labels)?;
            return Ok(rho(self.state(q)?, &row).into_pyobject(py)?.into_any());
        }
        let states = self.states_of(q)?;
        let rows = self.rows_of(labels, states.len())?;
        let width = self.names().len();
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
        py: Python<'py>,
        q: &Bound<'py, PyAny>,
        labels: &Bound<'py, PyAny>,
        out: Option<&Bound<'py, PyArray1<u32>>>,
    ) -> PyResult<Bound<'py, PyAny>> {
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
        self.by_row((states, columns), Some(self.names().len()), |columns, scratch, out| {
            self.inner.evaluator().labels(columns, scratch, out)
        })
    }

    /// The robustness of each proposition in each of `states`, as `labels`: float64.
    #[pyo3(signature = (states, *, columns=None))]
    fn rho<'py>(
        &self,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        self.by_row((states, columns), Some(self.names().len()), |columns, scratch, out| {
            self.inner.evaluator().rho(columns, scratch, out)
        })
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
    fn run<'py>(
        &self,
        py: Python<'py>,
        states: &Bound<'py, PyAny>,
        columns: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Run> {
        let states = States::new(self.inner.inputs(), states, columns)?;
        if states.shape.len() != 1 {
            return Err(wrong("states: one trajectory is wanted, an array of shape (T, d)"));
        }
        let runs = self.each(py, &states, |columns, scratch| self.inner.run(columns, scratch))?;
        let run = runs.into_iter().next().expect("a shape of one axis is one trajectory");
        let (verdict, since, rows) = (run.verdict().to_string(), run.since(), run.states.len());
        Ok(Run {
            states: shaped(py, run.states, &[rows])?.unbind(),
            progress: shaped(py, run.progress, &[rows])?.unbind(),
            robustness: run.robustness,
            verdict,
            since,
        })
    }

    /// The task on its way, to be told what holds, one state after the other.
    fn monitor(&self) -> super::monitor::Monitor {
        super::monitor::Monitor::new(self.clone())
    }

    /// The task in plain English, with shortest ways to satisfy it and to lose it.
    fn explain(&self) -> String {
        let entry = self.inner.entry();
        let told = match entry.is_automaton() {
            true => explain::explain_automaton(self.dfa()),
            false => explain::explain(&entry.task().spec, self.dfa()),
        };
        format!("{}\n\n{told}", self.title())
    }

    /// A shortest trajectory on which the two tasks differ, or that they are equal.
    fn diff(&self, other: &Self) -> String {
        let side = |task: &'_ Self| task.inner.entry().clone();
        let (first, second) = (side(self), side(other));
        let module = |entry: &'_ task::Entry| entry.file().clone();
        let (one, two) = (module(&first), module(&second));
        of_definitions(
            Side::Task(&one.compiled().module, first.task(), self.dfa()),
            Side::Task(&two.compiled().module, second.task(), other.dfa()),
        )
        .to_string()
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
        let graph = py.import("networkx")?.call_method0("MultiDiGraph")?;
        for q in 0..self.inner.states() {
            let named = PyDict::new(py);
            named.set_item("initial", q == self.initial())?;
            named.set_item("accepting", Some(q) == self.accepting())?;
            named.set_item("trap", Some(q) == self.trap())?;
            graph.call_method("add_node", (q,), Some(&named))?;
        }
        for Edge { source, target, guard } in self.moves() {
            let named = PyDict::new(py);
            named.set_item("guard", guard)?;
            graph.call_method("add_edge", (source, target), Some(&named))?;
        }
        Ok(graph)
    }

    /// The automaton for Graphviz.
    fn to_dot(&self) -> PyResult<String> {
        text(emit::dot::automaton(&self.title(), self.dfa()))
    }

    /// The automaton in the HOA format.
    fn to_hoa(&self) -> PyResult<String> {
        text(emit::hoa::automaton(&self.title(), self.dfa()))
    }

    /// The automaton as JSON.
    fn to_json(&self) -> PyResult<String> {
        text(emit::json::automaton(self.text(), self.dfa()))
    }

    /// The automaton for Mermaid.
    fn to_mermaid(&self) -> PyResult<String> {
        text(emit::mermaid::automaton(&self.title(), self.dfa()))
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

fn read_only() -> PyErr {
    wrong("out: the array is read-only")
}

/// A text that may be too large to be written.
fn text(written: Result<emit::labels::Text<'_>, emit::labels::TooLarge>) -> PyResult<String> {
    written.map(|text| text.to_string()).map_err(|error| wrong(error.to_string()))
}

/// The task of `file` with this name and these arguments.
pub(crate) fn bound(
    file: &TaskFile,
    name: Option<&str>,
    arguments: &[(String, Value)],
) -> PyResult<Made> {
    let entry = file.find(name).map_err(|error| wrong(error.to_string()))?;
    let arguments: Vec<_> =
        arguments.iter().map(|(name, value)| (name.as_str(), value.clone())).collect();
    entry.bind(&arguments).map_err(|error| wrong(error.to_string()))
}

/// What `restore` makes a task of.
pub(crate) fn reduced<'py>(
    py: Python<'py>,
    entry: &task::Entry,
    values: &[(String, Value)],
    budget: &Budget,
    fingerprint: &str,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
    let restore = py.import("tltl._core")?.getattr("restore")?;
    let arguments = PyDict::new(py);
    for (name, value) in values {
        match value {
            Value::Number(number) => arguments.set_item(name, number)?,
            Value::Truth(truth) => arguments.set_item(name, truth)?,
            Value::Text(text) => arguments.set_item(name, text)?,
        }
    }
    let source = entry.file().source();
    let form = match (entry.is_bare(), entry.is_automaton()) {
        (true, _) => "formula",
        (_, true) => "automaton",
        _ => "file",
    };
    let source = (form, source.name(), source.text());
    let state = (source, entry.name(), arguments.items(), budget.clone(), fingerprint);
    Ok((restore, state.into_pyobject(py)?))
}

/// A task of yesterday: compiled again, and compared by its numbered automaton.
#[pyfunction]
pub(crate) fn restore(
    py: Python<'_>,
    source: (String, String, String),
    name: Option<String>,
    arguments: Vec<(String, super::file::Argument)>,
    budget: Budget,
    fingerprint: &str,
) -> PyResult<Py<PyAny>> {
    let ((form, source, text), limits) = (source, budget.limits());
    let compiled = match &*form {
        "formula" => TaskFile::of_formula(&text, limits),
        "automaton" => TaskFile::of_automaton(Source::new(source, text)),
        _ => TaskFile::new(Source::new(source, text), limits),
    };
    let compiled = compiled.map_err(|error| mistaken(py, &error))?;
    let arguments: Vec<_> = arguments.into_iter().map(|(name, value)| (name, value.0)).collect();
    match bound(&compiled, name.as_deref(), &arguments)? {
        Made::Plain(inner) => {
            let task = Task::of(inner, budget);
            expect(task.text(), &task.fingerprint(), fingerprint)?;
            Ok(task.into_pyobject(py)?.into_any().unbind())
        }
        Made::Factored(inner) => {
            let prints: Vec<_> = inner.parts().iter().map(task::Task::fingerprint).collect();
            expect(&inner.entry().task().text, &prints.join(" "), fingerprint)?;
            Ok(Factored::new(inner, budget).into_pyobject(py)?.into_any().unbind())
        }
    }
}

/// An error unless the automaton is numbered as it was.
fn expect(text: &str, found: &str, fingerprint: &str) -> PyResult<()> {
    if found == fingerprint {
        return Ok(());
    }
    Err(wrong(format!(
        "`{text}` has another numbered automaton in this version: what was learned with it does not fit"
    )))
}

/// A product of yesterday, made again.
#[pyfunction]
pub(crate) fn restore_product(
    py: Python<'_>,
    operator: &str,
    operands: Vec<Bound<'_, PyAny>>,
    fingerprint: &str,
) -> PyResult<Task> {
    let operands = operands.iter().map(super::labelled::task_of).collect::<PyResult<_>>()?;
    let (task, _) = Task::product(py, super::product::operator(operator)?, operands)?;
    expect(task.text(), &task.fingerprint(), fingerprint)?;
    Ok(task)
}
