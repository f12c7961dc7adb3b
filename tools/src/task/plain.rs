//! Tasks with one automaton.
//!
//! A [`Task`] is the runtime's own task, over tables that it owns and an [`Evaluator`] in the place
//! of compiled predicates. So a formula from a file, a formula from Python and a formula in a macro
//! follow the same code over the same numbers; a test compares them bit by bit.

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

/// A task that was compiled while the program runs. A clone costs one reference count.
///
/// It is a [`Monitor`] of the runtime over rows, any type that gives `&[f64]`: the numbers of its
/// [inputs](Self::inputs) in their order. Whole columns are read through its
/// [`evaluator`](Self::evaluator), and a recorded trajectory in one call through
/// [`run`](Self::run).
///
/// ```
/// use tltl::{Acceptor, Monitor};
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("(x < 1) T (x > 2)", Budget::default())?;
/// assert_eq!(task.states(), 3);
/// let q = task.next(0, &[0.0])?;
/// // At q only a state with x > 2 moves the automaton on: ρ(s, D_φ^q) is x - 2.
/// assert_eq!(task.progress_robustness(q, &[1.5])?, -0.5);
/// // The trajectory as a whole: the least of 1 - 0 and 2.25 - 2.
/// assert_eq!(task.trajectory_robustness(&[[0.0], [2.25]])?, 0.25);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
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
    /// Binds the task of `entry`, whose automata these are; `module` has the arguments in its
    /// predicates already.
    ///
    /// # Errors
    /// If a predicate is Rust code, or indexes an array by a field.
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
        let formula = match entry.is_automaton() {
            // Without operators, as the runtime has it: robustness is that of the best run.
            true => Formula::new(task.text.clone(), Vec::new()),
            false => tables::formula(&task.spec, &task.text),
        };
        let formula = formula.expect(wrong);
        let automaton = tables::automaton(&automata.dfa).expect(wrong);
        let monitor = tltl::Task::new(name, formula, automaton, evaluator.clone()).expect(wrong);
        Ok(Self(Arc::new(Inner { entry, arguments, evaluator, monitor })))
    }

    /// The task as the author wrote it.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.0.entry
    }

    /// The names of its parameters, each with the value that was bound to it.
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::{Bound, TaskFile, Value};
    ///
    /// let source = Source::new("dock.tltl", "state Robot { x: f64 }\ntask dock(far: f64) = F x > far");
    /// let dock = TaskFile::new(source, Budget::default())?.find(None)?;
    /// let Bound::Plain(dock) = dock.bind(&[("far", 2.5.into())])? else { panic!("it is plain") };
    /// assert_eq!(dock.arguments(), [("far".to_owned(), Value::Number(2.5))]);
    /// assert_eq!((&dock.inputs()[0].name[..], dock.evaluator().propositions()), ("x", 1));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn arguments(&self) -> &[(String, Value)] {
        &self.0.arguments
    }

    /// The numbers that a row consists of, in order.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        self.0.evaluator.inputs()
    }

    /// Its predicates and its formula, to be evaluated over columns.
    #[must_use]
    pub fn evaluator(&self) -> &Evaluator {
        &self.0.evaluator
    }

    /// The automaton in the runtime's form: tables of numbers.
    #[must_use]
    pub fn automaton(&self) -> &Automaton {
        self.0.monitor.automaton()
    }

    /// The automaton in the compiler's form, which can be drawn, explained and compared.
    #[must_use]
    pub fn dfa(&self) -> &Dfa {
        &self.0.entry.automata().expect("a plain task has automata").dfa
    }

    /// A hash of the automaton as it is numbered: propositions, states, edges with their guards; 16
    /// hexadecimal digits.
    ///
    /// Where the number of a state is kept, in a policy or by another process, an equal fingerprint
    /// says that the number still means the same. The text of the
    /// formula is not part of it.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::task::compile;
    ///
    /// let print = |formula| compile(formula, Budget::default()).map(|task| task.fingerprint());
    /// assert_eq!(print("F a || F a")?, print("F a")?);
    /// assert_ne!(print("F a && F b")?, print("a T b")?);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
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
        // FNV-1a of 64 bits: the same on every machine and in every version of Rust, unlike the
        // hashers of the standard library. Nobody has a reason to forge a collision.
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
