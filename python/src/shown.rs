//! A task as people look at it: in words, as a graph, and beside another one.

use pyo3::prelude::*;
use pyo3::types::PyDict;
use tltl::Acceptor;
use tltlc::diff::{Side, of_definitions};
use tltlc::emit;
use tltlc::explain;
use tltlc::report;
use tltlc::task;

use super::error::wrong;
use super::task::Task;
use super::values::Edge;

impl Task {
    /// Its name, if it has one, and its formula.
    pub(crate) fn title(&self) -> String {
        let task = self.inner.entry().task();
        task.name
            .as_ref()
            .map_or_else(|| task.text.clone(), |name| format!("{name} = {}", task.text))
    }

    /// All moves, with their guards as text.
    pub(crate) fn moves(&self) -> Vec<Edge> {
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

    /// In plain English.
    pub(crate) fn explained(&self) -> String {
        format!("{}\n\n{}", self.title(), self.told())
    }

    fn told(&self) -> explain::Explanation {
        let entry = self.inner.entry();
        match entry.is_automaton() {
            true => explain::explain_automaton(self.dfa()),
            false => explain::explain(&entry.task().spec, self.dfa()),
        }
    }

    /// A page for a browser: what the task asks for, or how it followed some trajectories.
    pub(crate) fn page(
        &self,
        states: Option<&Bound<'_, PyAny>>,
        columns: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let Some(states) = states else {
            return Ok(report::explanation(&self.title(), self.dfa(), &self.told()));
        };
        let (followed, _) = self.of_trajectories(states, columns, |columns, scratch| {
            report::follow(&self.inner, "", columns, scratch)
        })?;
        let numbered = followed.into_iter().enumerate();
        let followed: Vec<_> =
            numbered.map(|(i, followed)| followed.named(format!("trajectory {i}"))).collect();
        Ok(report::Page::of_task(&self.inner).html(&followed))
    }

    /// A shortest trajectory that tells the two apart, in words.
    pub(crate) fn difference(&self, other: &Self) -> String {
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

    /// As a graph of networkx.
    pub(crate) fn graph<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
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
}

/// A text that may be too large to be written.
pub(crate) fn printed(
    written: Result<emit::labels::Text<'_>, emit::labels::TooLarge>,
) -> PyResult<String> {
    written.map(|text| text.to_string()).map_err(|error| wrong(error.to_string()))
}
