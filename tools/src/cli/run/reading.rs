//! What a recording is read by: a task, whose automaton may be too large.

use tltl::Automaton;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::predicate;
use tltl_compiler::spec::Spec;
use tltl_compiler::translate::Budget;

use crate::evaluate::{Columns, Evaluator, Input, NotANumber, Scratch};
use crate::explain::retold;
use crate::online::{Online, Recorded};
use crate::report::Page;
use crate::task::{Task, Unmade, Value};

/// An automaton, and the numbers that its propositions are read from.
pub(super) struct Reading {
    /// `None` if it is larger than the budget allows.
    pub(super) automaton: Option<Automaton>,
    /// The same as the compiler has it, for whoever shows it.
    dfa: Option<Dfa>,
    /// The names of its propositions.
    pub(super) propositions: Vec<String>,
    pub(super) inputs: Vec<Input>,
    /// The task as its author wrote it, with its arguments.
    pub(super) title: String,
    /// The predicates.
    evaluator: Evaluator,
    /// The robustness of a trajectory that has no state yet.
    pub(super) online: Online,
    /// The formula; `None` for an automaton of another tool.
    spec: Option<Spec>,
}

/// The propositions of a block of rows: truth and robustness, row after row.
pub(super) struct Read {
    pub(super) labels: Vec<bool>,
    pub(super) rho: Vec<f64>,
    /// The number of propositions.
    pub(super) width: usize,
}

impl Reading {
    pub(super) fn of_task(task: &Task) -> Self {
        let arguments = task.arguments().iter().map(|(name, value)| (&**name, value));
        let title = title(task.entry().task(), arguments);
        let automata = Some((task.automaton().clone(), task.dfa().clone()));
        let of_formula = match task.entry().is_automaton() {
            true => (Online::of_automaton(task.automaton()), None),
            false => of_formula(&task.entry().task().spec),
        };
        let evaluator = task.evaluator().clone();
        Self::new(task.entry().task(), title, automata, evaluator, of_formula)
    }

    /// A task without an automaton, with these values for its parameters.
    pub(super) fn of_unmade(
        unmade: &Unmade,
        evaluator: Evaluator,
        arguments: &[(&str, Value)],
    ) -> Self {
        let arguments = arguments.iter().map(|(name, value)| (*name, value));
        let (task, title) = (unmade.task(), title(unmade.task(), arguments));
        Self::new(task, title, None, evaluator, of_formula(&task.spec))
    }

    fn new(
        task: &predicate::Task,
        title: String,
        automata: Option<(Automaton, Dfa)>,
        evaluator: Evaluator,
        (online, spec): (Online, Option<Spec>),
    ) -> Self {
        let (automaton, dfa) = automata.unzip();
        let names = task.spec.propositions().iter().map(|one| one.name.clone());
        Self {
            automaton,
            dfa,
            propositions: names.collect(),
            inputs: evaluator.inputs().to_vec(),
            title,
            evaluator,
            online,
            spec,
        }
    }

    /// The truth of the formula on a trajectory without states.
    pub(super) fn truth(&self) -> Recorded {
        Recorded::new(self.spec.as_ref().expect("without an automaton there is a formula"))
    }

    /// The page that shows this task, and that many trajectories.
    pub(super) fn page(&self, of: usize) -> Page<'_> {
        Page {
            title: self.title.clone(),
            words: self.spec.as_ref().map(retold).unwrap_or_default(),
            propositions: self.propositions.clone(),
            dfa: self.dfa.as_ref(),
            of,
        }
    }

    /// Evaluates rows of the inputs.
    pub(super) fn read(
        &self,
        values: &[f64],
        rows: usize,
        scratch: &mut Scratch,
    ) -> Result<Read, NotANumber> {
        let evaluator = &self.evaluator;
        let columns =
            Columns::of_rows(rows, self.inputs.len(), values).expect("whole rows were read");
        let width = evaluator.propositions();
        let (mut labels, mut rho) = (vec![false; rows * width], vec![0.0; rows * width]);
        evaluator.labels(&columns, scratch, &mut labels)?;
        evaluator.rho(&columns, scratch, &mut rho)?;
        Ok(Read { labels, rho, width })
    }
}

/// What a formula is followed by, and itself.
fn of_formula(spec: &Spec) -> (Online, Option<Spec>) {
    (Online::new(spec, Budget::EMITTED), Some(spec.clone()))
}

/// A task as its author wrote it, with its arguments.
fn title<'a>(
    task: &predicate::Task,
    arguments: impl Iterator<Item = (&'a str, &'a Value)>,
) -> String {
    let name = task.name.as_ref().map(|name| format!("{name} = ")).unwrap_or_default();
    let with: Vec<_> = arguments.map(|(name, value)| format!("{name} = {value}")).collect();
    let with = if with.is_empty() { String::new() } else { format!("\nwith {}", with.join(", ")) };
    format!("{name}{}{with}", task.text)
}
