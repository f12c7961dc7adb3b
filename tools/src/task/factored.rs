//! Conjunctions whose parts run side by side, ready to run.

use std::sync::Arc;

use tltl::factored::{JointDeadEnds, Part};
use tltl::{Acceptor, Shared};
use tltl_compiler::compile;
use tltl_compiler::predicate::Module;

use super::argument::{Arguments, Value};
use super::{Entry, Task};
use crate::evaluate::{Evaluator, Input, Unreadable};

/// A factored task that was compiled while the program runs, ready to run itself. Cheap to clone.
///
/// A state of it is one automaton state for each part; all are 0 at first.
#[derive(Clone, Debug)]
pub struct Factored(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    entry: Entry,
    arguments: Arguments,
    evaluator: Evaluator,
    parts: Vec<Task>,
    /// For each part the places of its propositions among those of the whole.
    places: Vec<Shared<[u32]>>,
    monitor: tltl::Factored<Evaluator>,
}

impl Factored {
    /// The task of an entry, which has `factored`, with its arguments in the predicates of `module`.
    pub(super) fn new(
        entry: &Entry,
        factored: &compile::Factored,
        arguments: Arguments,
        module: &Module,
    ) -> Result<Self, Unreadable> {
        let evaluator = Evaluator::new(module, entry.task())?;
        let part = |(place, part): (usize, &compile::Part)| {
            Task::new(entry.part(place), &part.automata, arguments.clone(), module)
        };
        let parts = factored.parts.iter().enumerate().map(part).collect::<Result<Vec<_>, _>>()?;
        let places = factored.parts.iter().map(|part| part.propositions.clone().into());
        let places: Vec<Shared<[u32]>> = places.collect();
        let joint = if factored.joint { JointDeadEnds::None } else { JointDeadEnds::NotSearched };
        let owned = |(part, places): (&Task, &Shared<[u32]>)| Part {
            formula: part.formula().clone(),
            automaton: part.automaton().clone(),
            predicates: places.clone(),
        };
        let owned: Shared<[Part]> = parts.iter().zip(&places).map(owned).collect();
        let name = entry.name().unwrap_or_default().to_owned();
        let text = entry.task().text.clone();
        let monitor = tltl::Factored::new(name, text, owned, joint, evaluator.clone())
            .expect("a part's propositions are the predicates that the compiler numbered");
        let entry = entry.clone();
        Ok(Self(Arc::new(Inner { entry, arguments, evaluator, parts, places, monitor })))
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

    /// The predicates and the formula of the whole over columns.
    #[must_use]
    pub fn evaluator(&self) -> &Evaluator {
        &self.0.evaluator
    }

    /// Its parts, each a task of its own that reads fewer inputs.
    #[must_use]
    pub fn parts(&self) -> &[Task] {
        &self.0.parts
    }

    /// The runtime's factored task over rows, the numbers of the [inputs](Self::inputs) in their order.
    /// Its `numbered` makes it a [`Monitor`](tltl::Monitor).
    #[must_use]
    pub fn monitor(&self) -> &tltl::Factored<Evaluator> {
        &self.0.monitor
    }

    /// Moves many states, each on its own labels: `q` has, row after row, a state for each part,
    /// `labels` a truth value for each proposition of the whole.
    ///
    /// # Panics
    /// If their lengths do not belong together, or one of `q` is not a state of its part.
    #[track_caller]
    pub fn step_batch(&self, q: &mut [u32], labels: &[bool]) {
        let (parts, width) = (self.0.parts.len(), self.0.evaluator.propositions());
        let rows = q.len() / parts;
        assert_eq!(q.len(), rows * parts, "a state for each part");
        assert_eq!(labels.len(), rows * width, "a label for each row and proposition");
        for (part, task) in self.0.parts.iter().enumerate() {
            let mut states: Vec<u32> = q.iter().skip(part).step_by(parts).copied().collect();
            task.automaton().step_batch(&mut states, &self.labels_of(part, labels)[..]);
            q.iter_mut().skip(part).step_by(parts).zip(states).for_each(|(q, state)| *q = state);
        }
    }

    /// The labels of a part's propositions, given those of the whole.
    pub(super) fn labels_of(&self, part: usize, labels: &[bool]) -> Vec<bool> {
        let places = &*self.0.places[part];
        let rows = labels.chunks_exact(self.0.evaluator.propositions().max(1));
        rows.flat_map(|row| places.iter().map(|&place| row[place as usize])).collect()
    }

    /// The place of a part's proposition among those of the whole.
    pub(super) fn place(&self, part: usize, proposition: usize) -> usize {
        self.0.places[part][proposition] as usize
    }
}
