//! Tasks that are made of others as tables, without multiplying out their automata.
//!
//! The product of n parts has as many states as the product of their sizes, but a world reaches only
//! some of them. This search starts from the initial states of all parts, reads every combination of
//! classes that some world state shows (a *letter*), and numbers the joint states as it finds them.
//! Cost: joint states × letters. All joint states that accept are one state, all that are lost
//! another, as in a product.
//!
//! Factored tasks are conjunctions; compositions of skills may be any product.

use alloc::string::String;
use alloc::vec::Vec;

use super::label::{LabelError, LabelTable, Labelled};
use crate::factored::Factored;
use crate::interner::Interner;
use crate::product::{Landing, Operator};
use crate::reward::{End, Ends};
use crate::robustness::Predicates;

impl Labelled {
    /// The table of a factored task over a world's states, in the order of their numbers; `actions`
    /// are what the world's actions are called.
    ///
    /// Only joint states that some sequence of the world's states reaches are numbered, in the
    /// order in which they are found, 0 being the initial one; all that accept are one state, all
    /// in which a part is lost another. The work and the table are as large as those joint states
    /// times the classes of states: goals that lie apart in the world still reach 2^n.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// // Five goals among six cells in a row, in any order: 2^5 states as one automaton.
    /// let goals = tltl! { #[factored] |x: &i32| F ({ *x } == 0) && F ({ *x } == 1) && F ({ *x } == 2)
    ///     && F ({ *x } == 3) && F ({ *x } == 4) };
    /// let task = Labelled::of_factored(0..6, ["left", "right"], &goals, 1_000)?;
    /// assert_eq!(task.automaton_states(), 32);
    /// let error = Labelled::of_factored(0..6, ["left", "right"], &goals, 8).unwrap_err();
    /// assert!(error.to_string().starts_with("the 5 parts of the task reach more than 8 states"));
    /// # Ok::<(), tltl::augmented::LabelError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::new`], or if there are more than `budget` joint states.
    pub fn of_factored<S, P: Predicates<S>>(
        states: impl IntoIterator<Item = S> + Clone,
        actions: impl IntoIterator<Item: Into<String>>,
        task: &Factored<P>,
        budget: usize,
    ) -> Result<Self, LabelError> {
        let actions: Vec<String> = actions.into_iter().map(Into::into).collect();
        let part = |i| Self::new(states.clone(), actions.clone(), &task.part(i));
        let parts = (0..task.len()).map(part).collect::<Result<Vec<_>, _>>()?;
        let names = (task.name().into(), task.formula().text().into());
        Ok(Joint::new(Operator::Conjunction, &parts, names, budget)?.task)
    }
}

/// A task that is made of others on the same world, and which states of them each of its states is.
pub(crate) struct Joint {
    pub(crate) task: Labelled,
    /// The parts' states at each state, one after the other.
    pub(crate) components: Vec<u32>,
    /// Which part of a sequence runs at each state; 0 for the other operators.
    pub(crate) running: Vec<usize>,
}

impl Joint {
    /// The product of `parts`, all of the same world; it is called by a name and a formula.
    #[inline]
    pub(crate) fn new(
        operator: Operator,
        parts: &[Labelled],
        (name, formula): (String, String),
        budget: usize,
    ) -> Result<Self, LabelError> {
        let (class, letters) = letters(parts);
        let letters = letters.items();
        let mut joint = JointStates::new(operator, parts);
        let (mut next, mut q) = (Vec::new(), 0);
        // Rows are made in the order of the numbers; each may find more.
        while let Some(&tuple) = joint.found.get(q) {
            let tuple = joint.tuples.items()[tuple].clone();
            for letter in letters {
                next.push(if joint.ends[q].is_some() {
                    q as u32
                } else {
                    joint.read(&tuple, letter)
                });
                if joint.numbers.len() > budget {
                    return Err(LabelError::TooLarge { parts: parts.len(), budget });
                }
            }
            q += 1;
        }
        let (components, running) = joint.parts_of_states();
        let distance = LabelTable::distances(&joint.ends, &next);
        let task = Labelled::from_tables(LabelTable {
            name,
            formula,
            actions: parts.first().map_or_else(Vec::new, |part| part.action_names().to_vec()),
            classes: letters.len(),
            class,
            next,
            initial: 0,
            ends: Ends::new(joint.ends, distance),
            robustness: Vec::new(),
        })?;
        Ok(Self { task, components, running })
    }
}

/// The class of each state of the world, and its letter: the class that each part has there.
///
/// Two states with the same letter are the same to every part, so the joint table has a column for
/// each letter, and not for each combination of classes that could be written down.
#[inline]
fn letters(parts: &[Labelled]) -> (Vec<u32>, Interner<u32>) {
    let mut letters = Interner::new();
    let states = parts.first().map_or(0, Labelled::states);
    let mut class = Vec::with_capacity(states);
    for s in 0..states {
        let letter: Vec<u32> = parts.iter().map(|part| part.tables().class[s]).collect();
        class.push(letters.number(&letter));
    }
    (class, letters)
}

/// The joint states found so far: a breadth-first search without a queue, for numbers are handed out
/// in the order in which rows are made.
///
/// A tuple and a number are two things: every tuple that loses has the one number of the trap, every
/// one that accepts that of acceptance, so `numbers` maps many tuples to one.
struct JointStates<'a> {
    operator: Operator,
    parts: &'a [Labelled],
    /// The parts' states, and after them the part that runs.
    tuples: Interner<u32>,
    /// The number of each tuple.
    numbers: Vec<u32>,
    /// The tuple by which each number was found.
    found: Vec<usize>,
    ends: Vec<Option<End>>,
    /// The one number of all that accept, of all that are lost.
    accepted: Option<u32>,
    lost: Option<u32>,
}

impl<'a> JointStates<'a> {
    #[inline]
    fn new(operator: Operator, parts: &'a [Labelled]) -> Self {
        let mut joint = Self {
            operator,
            parts,
            tuples: Interner::new(),
            numbers: Vec::new(),
            found: Vec::new(),
            ends: Vec::new(),
            accepted: None,
            lost: None,
        };
        joint.number(parts.iter().map(|part| part.tables().initial).collect(), None);
        joint
    }

    /// The number of the state that follows a tuple on a letter.
    #[inline]
    fn read(&mut self, tuple: &[u32], letter: &[u32]) -> u32 {
        let running = tuple[self.parts.len()] as usize;
        let mut next = Vec::with_capacity(tuple.len());
        for (i, ((part, &q), &class)) in self.parts.iter().zip(tuple).zip(letter).enumerate() {
            let LabelTable { next: table, classes, .. } = part.tables();
            let to = table[q as usize * classes + class as usize];
            next.push(if self.operator.moves(i, running) { to } else { q });
        }
        self.number(next, Some(running))
    }

    /// The number of the parts' states, of which `running` has just moved: the one they have, or the next.
    #[inline]
    fn number(&mut self, mut parts: Vec<u32>, running: Option<usize>) -> u32 {
        let accepting = |i: usize| self.parts[i].end(parts[i]) == Some(End::Accepted);
        let lost = |i: usize| self.parts[i].end(parts[i]) == Some(End::Lost);
        let landing = self.operator.land(parts.len(), running, accepting, lost);
        let (end, runs) = match landing {
            Landing::Accepted => (Some(End::Accepted), 0),
            Landing::Lost => (Some(End::Lost), 0),
            Landing::To(runs) => (None, runs),
        };
        parts.push(runs as u32);
        let tuple = self.tuples.number(&parts) as usize;
        if let Some(&number) = self.numbers.get(tuple) {
            return number;
        }
        let fresh = self.ends.len() as u32;
        let number = match end {
            Some(End::Accepted) => *self.accepted.get_or_insert(fresh),
            Some(End::Lost) => *self.lost.get_or_insert(fresh),
            None => fresh,
        };
        if number == fresh {
            self.ends.push(end);
            self.found.push(tuple);
        }
        self.numbers.push(number);
        number
    }

    /// The parts' states at each state, and which part runs.
    #[inline]
    fn parts_of_states(&self) -> (Vec<u32>, Vec<usize>) {
        let n = self.parts.len();
        let tuples = || self.found.iter().map(|&tuple| &self.tuples.items()[tuple]);
        let components = tuples().flat_map(|tuple| tuple[..n].iter().copied()).collect();
        (components, tuples().map(|tuple| tuple[n] as usize).collect())
    }
}
