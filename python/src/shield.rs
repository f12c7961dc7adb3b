//! `tltl.Shield`: which actions are allowed.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};
use tltl::q::QTable;
use tltl::shield;

use super::array::{frozen, shaped};
use super::certificate::Certificate;
use super::error::wrong;
use super::policy::{Policy, pair, policy_of};
use super::solution::Solution;
use super::task::Task;

/// Which actions are allowed at each automaton state and state: at least one. `Solution.shield` makes
/// it.
///
/// >>> from tltl import FiniteModel, solve
/// >>> # Five cells in a row: action 0 goes left, action 1 right. Reach the right end, and keep off
/// >>> # the left one.
/// >>> ways = [cell for s in range(5) for cell in (max(s - 1, 0), min(s + 1, 4))]
/// >>> model = FiniteModel.from_arrays(range(11), ways, [1.0] * 10, actions=2)
/// >>> best = solve(model, "!left U right", lambda s: {"left": s == 0, "right": s == 4})
/// >>> best.shield().mask(0, 1).tolist(), best.shield().mask(0, 2).tolist()
/// ([False, True], [True, True])
#[pyclass(frozen, module = "tltl")]
pub struct Shield {
    inner: shield::Shield,
    solution: Py<Solution>,
    around: &'static str,
}

impl Shield {
    pub(crate) const fn new(
        inner: shield::Shield,
        solution: Py<Solution>,
        around: &'static str,
    ) -> Self {
        Self { inner, solution, around }
    }
}

#[pymethods]
impl Shield {
    /// The task that it is for; `None` for a composition.
    #[getter]
    fn task(&self) -> Option<Task> {
        self.solution.get().task().cloned()
    }

    /// What is promised: by how much P(lost) of any policy of allowed actions may exceed the smallest.
    #[getter]
    fn epsilon(&self) -> Option<f64> {
        self.inner.epsilon()
    }

    /// All that is allowed: bool, of shape (automaton states, states, actions).
    #[getter]
    fn masks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let task = self.inner.task();
        let (states, actions) = (task.states(), task.actions());
        let mut masks = Vec::with_capacity(task.pairs() * actions);
        for q in 0..task.automaton_states() {
            for s in 0..states {
                masks.extend((0..actions).map(|a| self.inner.allows(q, s, a)));
            }
        }
        frozen(py, masks, &[task.automaton_states() as usize, states, actions])
    }

    /// What is allowed in state `s` at `q`: bool, of shape (actions,).
    ///
    /// Raises `IndexError` if there is no such state.
    fn mask<'py>(&self, py: Python<'py>, q: i64, s: i64) -> PyResult<Bound<'py, PyAny>> {
        let (q, s) = pair(self.inner.task(), q, s)?;
        let actions = self.inner.task().actions();
        shaped(py, (0..actions).map(|a| self.inner.allows(q, s, a)).collect(), &[actions])
    }

    /// The policy under the shield: its own action where that is allowed, else the allowed one of the
    /// smallest number. What the shield costs and gains stands in its document.
    fn policy(&self, py: Python<'_>, policy: &Bound<'_, PyAny>) -> PyResult<Policy> {
        let table = self.table(policy)?;
        let shielded = py.detach(|| {
            let worth = self.solution.get().optimum.certify_shield(&self.inner, &table)?;
            Ok(self.inner.policy(&table)?.shielded(worth))
        });
        let shielded = shielded.map_err(|error: tltl::Mismatch| wrong(error.to_string()))?;
        Ok(Policy(shielded))
    }

    /// What the shield costs and gains when it is laid over a policy, given as for
    /// `Solution.certify`, and what the actions that it allows can come to.
    fn certify(&self, py: Python<'_>, policy: &Bound<'_, PyAny>) -> PyResult<Shielded> {
        let table = self.table(policy)?;
        let worth = py.detach(|| self.solution.get().optimum.certify_shield(&self.inner, &table));
        worth.map(Shielded).map_err(|error| wrong(error.to_string()))
    }

    /// It never changes.
    fn __copy__(slf: Py<Self>) -> Py<Self> {
        slf
    }

    fn __deepcopy__(slf: Py<Self>, _memo: &Bound<'_, PyAny>) -> Py<Self> {
        slf
    }

    /// By the solution, which is solved again.
    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, shield) = (slf.py(), slf.get());
        let named = PyDict::new(py);
        named.set_item("epsilon", shield.inner.epsilon())?;
        named.set_item("around", shield.around)?;
        let make = py.import("tltl")?.getattr("Solution")?.getattr("shield")?;
        let make = py.import("functools")?.getattr("partial")?.call((make,), Some(&named))?;
        Ok((make, PyTuple::new(py, [&shield.solution])?))
    }

    fn __repr__(&self) -> String {
        let (name, epsilon) = (self.inner.task().name(), self.inner.epsilon().unwrap_or(f64::NAN));
        format!("<Shield for `{name}`, epsilon {epsilon}>")
    }
}

impl Shield {
    /// A policy as action values: 1 for its own action, 0 for the others.
    fn table(&self, policy: &Bound<'_, PyAny>) -> PyResult<QTable> {
        let task = self.inner.task();
        let policy = policy_of(task, policy)?;
        let mut table = QTable::zeros(policy.task());
        for q in 0..task.automaton_states() {
            for (s, a) in policy.sub_policy(q).enumerate() {
                table.row_mut(q, s)[a] = 1.0;
            }
        }
        Ok(table)
    }
}

/// What a shield costs and gains over a policy: means over the starts.
#[pyclass(frozen, module = "tltl")]
pub struct Shielded(shield::Shielded);

#[pymethods]
impl Shielded {
    /// What the policy is worth without the shield.
    #[getter]
    fn before(&self) -> Certificate {
        Certificate::of(&self.0.before)
    }

    /// What it is worth under it.
    #[getter]
    fn after(&self) -> Certificate {
        Certificate::of(&self.0.after)
    }

    /// P(lost) without the shield.
    #[getter]
    fn lost_before(&self) -> f64 {
        self.0.lost_before
    }

    /// P(lost) under it.
    #[getter]
    fn lost_after(&self) -> f64 {
        self.0.lost_after
    }

    /// The smallest possible P(lost).
    #[getter]
    fn smallest_lost(&self) -> f64 {
        self.0.smallest_lost
    }

    /// The fraction of pairs in which the shield overrules the policy.
    #[getter]
    fn overruled(&self) -> f64 {
        self.0.overruled
    }

    /// The fraction of actions that are allowed.
    #[getter]
    fn fraction_allowed(&self) -> Option<f64> {
        self.0.allowed.map(|allowed| allowed.fraction)
    }

    /// The largest P(lost) of any policy of allowed actions.
    #[getter]
    fn lost_allowed(&self) -> Option<f64> {
        self.0.allowed.map(|allowed| allowed.lost)
    }

    /// The largest P(satisfied) of any policy of allowed actions.
    #[getter]
    fn satisfied_allowed(&self) -> Option<f64> {
        self.0.allowed.map(|allowed| allowed.satisfied)
    }

    fn __repr__(&self) -> String {
        format!("<Shielded: P(lost) {} before, {} after>", self.0.lost_before, self.0.lost_after)
    }
}
