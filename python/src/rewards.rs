//! `tltl.Rewards`: what a move of the automaton pays.

use std::fmt::Write as _;

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::OutOfRange;
use tltl::reward::{self, Arrivals, Mode};

use super::array::{Array, shaped};
use super::error::wrong;
use super::factored::Factored;
use super::follow::{Follows, with_task};
use super::task::Task;

const MODES: [(&str, Mode); 5] = [
    ("shaped", Mode::Shaped),
    ("acceptance", Mode::Acceptance),
    ("progress", Mode::Progress),
    ("robustness", Mode::Robustness),
    ("literal", Mode::Literal),
];

/// What a move of the automaton pays: the mode, the discount factor that a shaped reward needs, and
/// penalties.
///
/// `shaped`, the default, pays 1 for satisfying the task, and a potential on the way that leaves the
/// best policies as they are; its `gamma` must be the learner's. `acceptance` is the 1 alone.
/// `progress` pays 1 for every move that is not into the trap (the paper's reward); where the
/// automaton has a way back, its best policy need not satisfy the task. `robustness` pays by how much
/// a state makes the automaton move on, at most `bound`. `literal` pays for being lost too.
///
/// `environment` is the weight of the environment's own reward.
///
/// >>> from tltl import Rewards, Task
/// >>> task = Task("F a")
/// >>> Rewards("acceptance", trap_penalty=1.0).pay(task, 0, 1)
/// 1.0
#[pyclass(frozen, eq, from_py_object, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct Rewards(pub(crate) reward::Rewards);

fn out_of_range(error: OutOfRange) -> PyErr {
    wrong(error.to_string())
}

#[pymethods]
impl Rewards {
    #[new]
    #[pyo3(signature = (mode="shaped", *, gamma=0.99, bound=1.0, trap_penalty=0.0, step_penalty=0.0, environment=0.0))]
    fn new(
        mode: &str,
        gamma: f64,
        bound: f64,
        trap_penalty: f64,
        step_penalty: f64,
        environment: f64,
    ) -> PyResult<Self> {
        let known = MODES.iter().find(|(name, _)| *name == mode);
        let (_, mode) = known.ok_or_else(|| {
            let names: Vec<_> = MODES.iter().map(|(name, _)| *name).collect();
            wrong(format!("mode is `{mode}`, not one of {}", names.join(", ")))
        })?;
        let rewards = reward::Rewards::of(*mode).with_gamma(gamma).map_err(out_of_range)?;
        let rewards = rewards.with_bound(bound).map_err(out_of_range)?;
        let rewards = rewards.with_trap_penalty(trap_penalty).map_err(out_of_range)?;
        let rewards = rewards.with_step_penalty(step_penalty).map_err(out_of_range)?;
        rewards.with_environment(environment).map(Self).map_err(out_of_range)
    }

    /// What is paid for: `shaped`, `acceptance`, `progress`, `robustness` or `literal`.
    #[getter]
    fn mode(&self) -> &'static str {
        MODES.iter().find(|(_, mode)| *mode == self.0.mode()).map_or("", |(name, _)| name)
    }

    /// The discount factor.
    #[getter]
    fn gamma(&self) -> f64 {
        self.0.gamma()
    }

    /// The most that `robustness` pays for a step.
    #[getter]
    fn bound(&self) -> f64 {
        self.0.bound()
    }

    /// What being lost costs.
    #[getter]
    fn trap_penalty(&self) -> f64 {
        self.0.trap_penalty()
    }

    /// What each step costs.
    #[getter]
    fn step_penalty(&self) -> f64 {
        self.0.step_penalty()
    }

    /// The weight of the environment's own reward.
    #[getter]
    fn environment(&self) -> f64 {
        self.0.environment()
    }

    /// What the move from `q` to `next_q` pays, or each of many moves: numbers, or arrays of shape
    /// (n,). States of a `Factored` are arrays of shape (parts,), or (n, parts).
    ///
    /// `rho` is ρ(s', D_φ^q), which the mode `robustness` needs; `reward` is what the environment pays,
    /// and `terminated` whether it ended the episode itself. Both default to nothing.
    #[pyo3(signature = (task, q, next_q, *, rho=None, reward=None, terminated=None))]
    fn pay<'py>(
        &self,
        task: &Bound<'py, PyAny>,
        q: &Bound<'py, PyAny>,
        next_q: &Bound<'py, PyAny>,
        rho: Option<&Bound<'py, PyAny>>,
        reward: Option<&Bound<'py, PyAny>>,
        terminated: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if self.0.needs_robustness() && rho.is_none() {
            return Err(wrong("rho is missing, and the mode `robustness` pays it"));
        }
        with_task!(task, task => self.paid(task, [q, next_q], [rho, reward, terminated]))
    }

    fn __getnewargs_ex__<'py>(
        &self,
        py: Python<'py>,
    ) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let named = PyDict::new(py);
        for (name, value) in self.numbers() {
            named.set_item(name, value)?;
        }
        Ok((PyTuple::new(py, [self.mode()])?, named))
    }

    fn __hash__(&self) -> u64 {
        use std::hash::{DefaultHasher, Hash, Hasher};
        let mut hasher = DefaultHasher::new();
        // 0 and -0 are equal.
        let numbers = self.numbers().map(|(_, value)| (value + 0.0).to_bits());
        (self.mode(), numbers).hash(&mut hasher);
        hasher.finish()
    }

    fn __repr__(&self) -> String {
        let mut text = format!("Rewards({:?}", self.mode());
        for (name, value) in self.numbers() {
            let _ = write!(text, ", {name}={value}");
        }
        text + ")"
    }
}

/// A column of so many numbers, or none.
pub(crate) fn column(
    given: Option<&Bound<'_, PyAny>>,
    name: &str,
    rows: usize,
) -> PyResult<Vec<f64>> {
    let Some(given) = given else { return Ok(Vec::new()) };
    let array = Array::new(given, name)?;
    match *array.shape() {
        [own] if own == rows => Ok(array.robustness()),
        ref shape => Err(wrong(format!("{name}: shape {shape:?}; wanted is ({rows},)"))),
    }
}

impl Rewards {
    /// What moves pay, one or many; the columns are ρ, the environment's reward, and its ends.
    fn paid<'py, T: Follows>(
        &self,
        task: &T,
        [q, to]: [&Bound<'py, PyAny>; 2],
        columns: [Option<&Bound<'py, PyAny>>; 3],
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = q.py();
        let ((q, rows), (to, own)) = (task.states_given(q)?, task.states_given(to)?);
        if own != rows {
            let count = |rows: Option<usize>| rows.map_or("one".to_owned(), |n| n.to_string());
            return Err(wrong(format!("next_q: {} states; q has {}", count(own), count(rows))));
        }
        let [rho, reward, ended] = columns;
        let number = |given: Option<&Bound<'py, PyAny>>, name: &str| match rows {
            Some(rows) => column(given, name, rows),
            None => given.map_or(Ok(Vec::new()), |given| Ok(vec![given.extract()?])),
        };
        let (robustness, reward) = (number(rho, "rho")?, number(reward, "reward")?);
        let ended = match (rows, ended) {
            (None, Some(ended)) => vec![f64::from(u8::from(ended.is_truthy()?))],
            _ => number(ended, "terminated")?,
        };
        let terminated: Vec<bool> = ended.iter().map(|end| *end > 0.0).collect();
        let moves = Arrivals {
            q: &q,
            to: &to,
            robustness: &robustness,
            reward: &reward,
            terminated: &terminated,
        };
        let mut out = vec![0.0; rows.unwrap_or(1)];
        match rows {
            None => {
                task.pay(&self.0, &moves, &mut out);
                Ok(out[0].into_pyobject(py)?.into_any())
            }
            Some(rows) => {
                py.detach(|| task.pay(&self.0, &moves, &mut out));
                shaped(py, out, &[rows])
            }
        }
    }

    fn numbers(&self) -> [(&'static str, f64); 5] {
        [
            ("gamma", self.0.gamma()),
            ("bound", self.0.bound()),
            ("trap_penalty", self.0.trap_penalty()),
            ("step_penalty", self.0.step_penalty()),
            ("environment", self.0.environment()),
        ]
    }
}
