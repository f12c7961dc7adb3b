//! What a recording is read by: a task, or an automaton of another tool.

use tltl::Automaton;
use tltl_compiler::translate::Budget;

use crate::evaluate::{Columns, Evaluator, Input, InputKind, NotANumber, Scratch};
use crate::online::Online;
use crate::tables;
use crate::task::Task;

use super::Foreign;

/// An automaton, and the numbers that its propositions are read from.
pub(super) struct Reading {
    pub(super) automaton: Automaton,
    pub(super) inputs: Vec<Input>,
    /// The task as its author wrote it, with its arguments.
    pub(super) title: String,
    /// The predicates; `None` where the numbers themselves are the robustness of the propositions.
    evaluator: Option<Evaluator>,
    /// The robustness of a trajectory that has no state yet.
    pub(super) online: Online,
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
        let text = &task.entry().task().text;
        let name = task.entry().name().map(|name| format!("{name} = ")).unwrap_or_default();
        let with = task.arguments().iter().map(|(name, value)| format!("{name} = {value}"));
        let with: Vec<_> = with.collect();
        let with =
            if with.is_empty() { String::new() } else { format!("\nwith {}", with.join(", ")) };
        Self {
            automaton: task.automaton().clone(),
            inputs: task.inputs().to_vec(),
            title: format!("{name}{text}{with}"),
            evaluator: Some(task.evaluator().clone()),
            online: Online::new(&task.entry().task().spec, Budget::EMITTED),
        }
    }

    /// An automaton without a formula, over the columns that are called like its propositions, as a
    /// bare formula is read.
    pub(super) fn of_automaton(Foreign { name, dfa }: Foreign) -> Result<Self, String> {
        let input = |name: &str| Input {
            name: name.to_owned(),
            kind: InputKind::Proposition,
            unit: None,
            values: Vec::new(),
        };
        let automaton = tables::automaton(&dfa).map_err(|error| error.to_string())?;
        let online = Online::of_automaton(&automaton);
        let inputs = dfa.propositions.iter().map(|one| input(&one.name)).collect();
        Ok(Self { automaton, inputs, title: name, evaluator: None, online })
    }

    /// Evaluates rows of the inputs.
    pub(super) fn read(
        &self,
        values: &[f64],
        rows: usize,
        scratch: &mut Scratch,
    ) -> Result<Read, NotANumber> {
        let Some(evaluator) = &self.evaluator else {
            let labels = values.iter().map(|rho| *rho > 0.0).collect();
            return Ok(Read { labels, rho: values.to_vec(), width: self.inputs.len() });
        };
        let columns =
            Columns::of_rows(rows, self.inputs.len(), values).expect("whole rows were read");
        let width = evaluator.propositions();
        let (mut labels, mut rho) = (vec![false; rows * width], vec![0.0; rows * width]);
        evaluator.labels(&columns, scratch, &mut labels)?;
        evaluator.rho(&columns, scratch, &mut rho)?;
        Ok(Read { labels, rho, width })
    }
}
