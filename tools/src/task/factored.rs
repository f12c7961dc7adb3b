//! Factored tasks: conjunctions whose parts run side by side, each with an automaton of its own.
//!
//! The automaton of a conjunction can have as many states as the product of the parts' numbers of
//! states. A factored task never builds it: its state is a tuple, one automaton state for each
//! part. Predicates are evaluated once for the whole, and each part reads those that it has.

use std::sync::Arc;

use tltl::factored::{JointDeadEnds, Part};
use tltl::{Acceptor, Shared};
use tltl_compiler::compile;
use tltl_compiler::predicate::Module;

use super::argument::{Arguments, Value};
use super::{Entry, Task};
use crate::evaluate::{Evaluator, Input, Unreadable};

/// A factored task that was compiled while the program runs. A clone costs one reference count.
///
/// A state is a slice of [`parts`](Self::parts)`().len()` automaton states, all 0 before the first
/// row is read. The task is satisfied when every part is, and lost when one part is.
///
/// ```
/// use tltl_compiler::{source::Source, translate::Budget};
/// use tltlc::task::{Bound, TaskFile};
///
/// let source = Source::new("tour.tltl", "
///     state Robot { x: f64 }
///     predicate left = x < 0
///     predicate right = x > 9
///     #[factored] task tour = F left && F right");
/// let Bound::Factored(tour) = TaskFile::new(source, Budget::default())?.find(None)?.bind(&[])? else {
///     panic!("the task is factored");
/// };
/// assert_eq!(tour.parts().len(), 2);
/// // Two rows at once: the first state sees `left`, the second `right`.
/// let mut q = [0, 0, 0, 0];
/// tour.step_batch(&mut q, &[true, false, false, true]);
/// assert_eq!(q, [1, 0, 0, 1]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Factored(Arc<Inner>);

#[derive(Debug)]
struct Inner {
    entry: Entry,
    arguments: Arguments,
    evaluator: Evaluator,
    parts: Vec<Task>,
    /// For each part the index of each of its propositions among those of the whole.
    places: Vec<Shared<[u32]>>,
    monitor: tltl::Factored<Evaluator>,
}

impl Factored {
    /// Binds the factored task of `entry`; `module` has the arguments in its predicates already.
    ///
    /// # Errors
    /// If a predicate is Rust code, or indexes an array by a field.
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

    /// The task as the author wrote it.
    #[must_use]
    pub fn entry(&self) -> &Entry {
        &self.0.entry
    }

    /// The names of its parameters, each with the value that was bound to it.
    #[must_use]
    pub fn arguments(&self) -> &[(String, Value)] {
        &self.0.arguments
    }

    /// The numbers that a row consists of, in order: those that any part reads.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        self.0.evaluator.inputs()
    }

    /// The predicates and the formula of the whole task, to be evaluated over columns.
    #[must_use]
    pub fn evaluator(&self) -> &Evaluator {
        &self.0.evaluator
    }

    /// Its parts, each a task of its own. A part has an evaluator of its own, whose rows hold only
    /// what that part reads.
    #[must_use]
    pub fn parts(&self) -> &[Task] {
        &self.0.parts
    }

    /// The runtime's factored task over rows of the [inputs](Self::inputs).
    ///
    /// Its states are tuples. Where a single number is needed, as in a table of action values, its
    /// method `numbered` numbers the tuples that can be reached and is a
    /// [`Monitor`](tltl::Monitor).
    ///
    /// ```
    /// use tltl_compiler::{source::Source, translate::Budget};
    /// use tltlc::task::{Bound, TaskFile};
    ///
    /// let source = Source::new("tour.tltl", "
    ///     state Robot { x: f64 }
    ///     #[factored] task tour = F x < 0 && F x > 9");
    /// let Bound::Factored(tour) = TaskFile::new(source, Budget::default())?.find(None)?.bind(&[])? else {
    ///     panic!("the task is factored");
    /// };
    /// let mut q = [0, 0];
    /// tour.monitor().next(&mut q, &[-1.0])?;
    /// assert_eq!((q, tour.monitor().is_accepting(&q)), ([1, 0], false));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn monitor(&self) -> &tltl::Factored<Evaluator> {
        &self.0.monitor
    }

    /// Moves many states at once, each by its own labels.
    ///
    /// `q` has shape (rows, parts) and `labels` shape (rows, propositions of the whole), both row
    /// after row. Each part gathers its column of states and its labels into two buffers first, so
    /// that the automaton walks contiguous memory.
    ///
    /// # Panics
    /// If the lengths do not fit these shapes, or one of `q` is not a state of its part.
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

    /// The labels of one part, row after row, picked from those of the whole.
    pub(super) fn labels_of(&self, part: usize, labels: &[bool]) -> Vec<bool> {
        let places = &*self.0.places[part];
        let rows = labels.chunks_exact(self.0.evaluator.propositions().max(1));
        rows.flat_map(|row| places.iter().map(|&place| row[place as usize])).collect()
    }

    /// The index of a part's proposition among those of the whole.
    pub(super) fn place(&self, part: usize, proposition: usize) -> usize {
        self.0.places[part][proposition] as usize
    }
}
