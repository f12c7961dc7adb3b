//! Tasks with one automaton, ready to run.

use std::sync::Arc;

use tltl::automaton::Tables;
use tltl::task::Error;
use tltl::{Acceptor, Automaton, Formula, Monitor};
use tltl_compiler::dfa::{Automata, Dfa};
use tltl_compiler::predicate::Module;

use super::Entry;
use super::argument::{Arguments, Value};
use crate::evaluate::{Evaluator, Input, Unreadable};
use crate::tables;

/// A task that was compiled while the program runs, ready to run itself. Cheap to clone: one count of
/// references.
///
/// It is a [`Monitor`] of the runtime over rows, the numbers of its [inputs](Self::inputs) in their
/// order, and reads columns of them through its [`evaluator`](Self::evaluator).
#[derive(Clone, Debug)]
pub struct Task(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    entry: Entry,
    arguments: Arguments,
    evaluator: Evaluator,
    monitor: tltl::Task<Evaluator>,
}

impl Task {
    /// The task of an entry, which has `automata`, with its arguments in the predicates of `module`.
    pub(super) fn new(
        entry: Entry,
        automata: &Automata,
        arguments: Arguments,
        module: &Module,
    ) -> Result<Self, Unreadable> {
        let task = entry.task();
        let evaluator = Evaluator::new(module, task)?;
        let name = task.name.clone().unwrap_or_else(|| task.text.clone());
        let wrong = "the compiler's tables are an automaton and a formula over its propositions";
        let formula = tables::formula(&task.spec, &task.text).expect(wrong);
        let automaton = tables::automaton(&automata.dfa).expect(wrong);
        let monitor = tltl::Task::new(name, formula, automaton, evaluator.clone()).expect(wrong);
        Ok(Self(Arc::new(Inner { entry, arguments, evaluator, monitor })))
    }

    /// The task as it is written.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.0.entry
    }

    /// What its parameters stand for, by name.
    #[must_use]
    pub fn arguments(&self) -> &[(String, Value)] {
        &self.0.arguments
    }

    /// What a row consists of.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        self.0.evaluator.inputs()
    }

    /// Its predicates and its formula over columns.
    #[must_use]
    pub fn evaluator(&self) -> &Evaluator {
        &self.0.evaluator
    }

    /// The automaton as the runtime has it: tables of numbers.
    #[must_use]
    pub fn automaton(&self) -> &Automaton {
        self.0.monitor.automaton()
    }

    /// The automaton as the compiler has it, which can be drawn, explained and compared.
    #[must_use]
    pub fn dfa(&self) -> &Dfa {
        &self.0.entry.automata().expect("a plain task has automata").dfa
    }

    /// A hash of the automaton as it is numbered: propositions, states, edges with their guards. Where
    /// the number of a state is kept, in a policy or by another process, an equal fingerprint says
    /// that it still means the same.
    #[must_use]
    pub fn fingerprint(&self) -> String {
        let Tables { propositions, accepting, trap, edges, targets, guards, literals, .. } =
            self.automaton().tables();
        let ends = [accepting, trap].map(|q| q.unwrap_or(u32::MAX));
        let lengths = propositions.iter().map(|name| name.len() as u32);
        let tables = edges.iter().chain(&**targets).chain(&**guards).copied();
        let literals = literals.iter().map(|literal| literal.cast_unsigned());
        let numbers = ends.into_iter().chain(lengths).chain(tables).chain(literals);
        let names = propositions.iter().flat_map(|name| name.bytes());
        let bytes = numbers.flat_map(u32::to_le_bytes).chain(names);
        // FNV-1a of 64 bits: the same on every machine, and nobody tries to make two alike.
        let hash = bytes.fold(0xcbf2_9ce4_8422_2325, |hash: u64, byte| {
            (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
        });
        format!("{hash:016x}")
    }
}

impl Acceptor for Task {
    fn states(&self) -> u32 {
        self.0.monitor.states()
    }

    fn is_accepting(&self, q: u32) -> bool {
        self.0.monitor.is_accepting(q)
    }

    fn is_trap(&self, q: u32) -> bool {
        self.0.monitor.is_trap(q)
    }

    fn distance(&self, q: u32) -> Option<u32> {
        self.0.monitor.distance(q)
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.0.monitor.successors(q, visit);
    }

    fn name(&self) -> &str {
        self.0.monitor.name()
    }

    fn formula(&self) -> &Formula {
        self.0.monitor.formula()
    }
}

impl<S: AsRef<[f64]> + ?Sized> Monitor<S> for Task {
    fn next(&self, q: u32, row: &S) -> Result<u32, Error> {
        self.0.monitor.next(q, row)
    }

    fn progress_robustness(&self, q: u32, row: &S) -> Result<f64, Error> {
        self.0.monitor.progress_robustness(q, row)
    }

    fn trap_robustness(&self, q: u32, row: &S) -> Result<f64, Error> {
        self.0.monitor.trap_robustness(q, row)
    }

    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        self.0.monitor.robustness(trajectory)
    }
}
