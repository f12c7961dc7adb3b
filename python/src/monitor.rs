//! `tltl.Monitor`: a task that reads one state after the other.

use pyo3::prelude::*;
use tltl::{Acceptor, Automaton};

use super::compiled::Compiled;
use super::task::Task;

/// A task on its way.
#[pyclass(module = "tltl")]
pub struct Monitor {
    task: Task,
    state: u32,
}

impl Monitor {
    pub(crate) const fn new(task: Task) -> Self {
        Self { task, state: Automaton::INITIAL }
    }
}

#[pymethods]
impl Monitor {
    /// The task that is monitored.
    #[getter]
    fn task(&self) -> Task {
        self.task.clone()
    }

    /// The automaton state now.
    #[getter]
    fn state(&self) -> u32 {
        self.state
    }

    /// Whether the task is satisfied.
    #[getter]
    fn satisfied(&self) -> bool {
        self.task.inner.is_accepting(self.state)
    }

    /// Whether the task is lost.
    #[getter]
    fn lost(&self) -> bool {
        self.task.inner.is_trap(self.state)
    }

    /// Reads what holds now; the state after it.
    fn observe(&mut self, labels: &Bound<'_, PyAny>) -> PyResult<u32> {
        self.state = self.task.moved(self.state, &self.task.row(labels)?);
        Ok(self.state)
    }

    /// Back to where nothing was read.
    fn reset(&mut self) {
        self.state = Automaton::INITIAL;
    }
}
