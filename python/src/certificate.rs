//! What policies are worth, as data that prints as a few lines.

use pyo3::prelude::*;
use pyo3::types::PyTuple;
use tltl::solve::{self, Report, Start, Within};

/// What a policy is worth against the best possible: exact means over the starts. It prints as a few
/// lines, with the starts that lose most.
#[pyclass(frozen, module = "tltl")]
pub struct Certificate {
    worth: solve::Certificate,
    /// Nothing where only the means are known.
    starts: Vec<Start>,
}

impl Certificate {
    pub(crate) fn of(worth: &solve::Certificate) -> Self {
        Self { worth: worth.clone(), starts: Vec::new() }
    }

    fn within_or_none(&self) -> Option<Within> {
        self.worth.within
    }
}

impl From<Report> for Certificate {
    fn from(Report { certificate, starts }: Report) -> Self {
        Self { worth: certificate, starts }
    }
}

#[pymethods]
impl Certificate {
    /// How it was come to: `exact`, computed from the model.
    #[getter]
    fn kind(&self) -> String {
        format!("{:?}", self.worth.basis).to_lowercase()
    }

    /// P(satisfied) of the policy.
    #[getter]
    fn satisfied(&self) -> f64 {
        self.worth.satisfied
    }

    /// E[steps] of the policy, given success; `None` if it never succeeds.
    #[getter]
    fn steps(&self) -> Option<f64> {
        self.worth.steps
    }

    /// The largest possible P(satisfied).
    #[getter]
    fn optimal_satisfied(&self) -> f64 {
        self.worth.optimal_satisfied
    }

    /// The smallest possible E[steps] among the policies of that P.
    #[getter]
    fn optimal_steps(&self) -> Option<f64> {
        self.worth.optimal_steps
    }

    /// By how much P(satisfied) is smaller than possible.
    #[getter]
    fn regret_satisfied(&self) -> f64 {
        self.worth.regret_satisfied
    }

    /// By which part of the fewest steps it needs more.
    #[getter]
    fn regret_steps(&self) -> Option<f64> {
        self.worth.regret_steps
    }

    /// The largest regret in P(satisfied) of a single start.
    #[getter]
    fn worst_regret_satisfied(&self) -> f64 {
        self.worth.worst_regret_satisfied
    }

    /// The fraction of pairs in which the action is optimal for the rewards.
    #[getter]
    fn fraction_optimal(&self) -> f64 {
        self.worth.fraction_optimal
    }

    /// How far P(satisfied), of the policy and the largest possible, may be from the true numbers: a
    /// bound that holds. `None` of a document of an earlier version.
    #[getter]
    fn satisfied_error(&self) -> Option<f64> {
        self.worth.satisfied_error
    }

    /// The same of the expected steps; `None` too where there is no bound.
    #[getter]
    fn steps_error(&self) -> Option<f64> {
        self.worth.steps_error
    }

    /// The number of steps after which an episode is cut, if there is one.
    #[getter]
    fn within(&self) -> Option<u64> {
        self.within_or_none().map(|within| within.steps)
    }

    /// P(satisfied) within that number of steps.
    #[getter]
    fn satisfied_within(&self) -> Option<f64> {
        self.within_or_none().map(|within| within.satisfied)
    }

    /// The largest possible P(satisfied) within that number of steps.
    #[getter]
    fn optimal_satisfied_within(&self) -> Option<f64> {
        self.within_or_none().map(|within| within.optimal_satisfied)
    }

    /// What it is worth from each start, those that lose most first: (state, P(satisfied), E[steps]
    /// or `None`). Nothing where only the means are known, as of a policy that was loaded.
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let starts = self.starts.iter();
        PyTuple::new(py, starts.map(|start| (start.state, start.satisfied, start.steps)))
    }

    fn __str__(&self) -> String {
        if self.starts.is_empty() {
            return self.worth.to_string();
        }
        let (certificate, starts) = (self.worth.clone(), self.starts.clone());
        Report { certificate, starts }.to_string()
    }

    fn _repr_html_(&self) -> String {
        preformatted(&self.__str__())
    }

    fn __repr__(&self) -> String {
        format!("<Certificate: P(satisfied) {}>", self.satisfied())
    }
}

/// Text for a notebook, as it is.
pub(crate) fn preformatted(text: &str) -> String {
    let escaped = text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    format!("<pre>{escaped}</pre>")
}

/// An action that is worse for the rewards than the best one: its pair, the action, the best one, and
/// by how much its value is smaller.
#[pyclass(frozen, eq, get_all, module = "tltl")]
#[derive(Clone, PartialEq)]
pub struct Mistake {
    /// The automaton state.
    q: u32,
    /// The state of the world.
    state: usize,
    /// What the policy does.
    action: usize,
    /// The best action.
    best: usize,
    /// What its value falls short of that of the best action.
    loss: f64,
}

impl From<solve::Mistake> for Mistake {
    fn from(found: solve::Mistake) -> Self {
        let solve::Mistake { q, state, action, best, loss } = found;
        Self { q, state, action, best, loss }
    }
}

#[pymethods]
impl Mistake {
    fn __repr__(&self) -> String {
        let Self { q, state, action, best, loss } = self;
        format!("Mistake(q={q}, state={state}, action={action}, best={best}, loss={loss})")
    }
}
