//! Factored tasks as tables, without multiplying out their automata.
//!
//! The product of n parts has as many states as the product of their sizes, but a world reaches only
//! some of them. This search starts from the initial states of all parts, reads every combination of
//! classes that some world state shows (a *letter*), and numbers the joint states as it finds them.
//! Cost: joint states × letters. All joint states that accept are one state, all that are lost
//! another, as in a product.

use alloc::string::String;
use alloc::vec::Vec;

use super::label::{LabelError, LabelTable, Labelled};
use crate::factored::Factored;
use crate::interner::Interner;
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
        let (class, letters) = letters(&parts);
        let letters = letters.items();
        let mut joint = JointStates::new(&parts);
        let (mut next, mut q) = (Vec::new(), 0);
        // Rows are made in the order of the numbers; each may find more.
        while let Some(&tuple) = joint.found.get(q) {
            let tuple = joint.tuples.items()[tuple].clone();
            for letter in letters {
                next.push(joint.read(&tuple, letter));
                if joint.numbers.len() > budget {
                    return Err(LabelError::TooLarge { parts: task.len(), budget });
                }
            }
            q += 1;
        }
        let classes = letters.len();
        let distance = LabelTable::distances(&joint.ends, &next);
        Self::from_tables(LabelTable {
            name: task.name().into(),
            formula: task.formula().text().into(),
            actions,
            classes,
            class,
            next,
            initial: 0,
            ends: Ends::new(joint.ends, distance),
            robustness: Vec::new(),
        })
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
    parts: &'a [Labelled],
    /// The parts' states.
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
    fn new(parts: &'a [Labelled]) -> Self {
        let mut joint = Self {
            parts,
            tuples: Interner::new(),
            numbers: Vec::new(),
            found: Vec::new(),
            ends: Vec::new(),
            accepted: None,
            lost: None,
        };
        joint.number(&alloc::vec![0; parts.len()]);
        joint
    }

    /// The number of the state that follows `q` on a letter.
    #[inline]
    fn read(&mut self, q: &[u32], letter: &[u32]) -> u32 {
        let mut next = Vec::with_capacity(q.len());
        for ((part, &q), &class) in self.parts.iter().zip(q).zip(letter) {
            let LabelTable { next: table, classes, .. } = part.tables();
            next.push(table[q as usize * classes + class as usize]);
        }
        self.number(&next)
    }

    /// The number of a tuple of the parts' states: the one it has, or the next.
    #[inline]
    fn number(&mut self, q: &[u32]) -> u32 {
        let tuple = self.tuples.number(q) as usize;
        if let Some(&number) = self.numbers.get(tuple) {
            return number;
        }
        let fresh = self.ends.len() as u32;
        let end = self.end(q);
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

    /// How a tuple ends: one lost part loses a conjunction, and only all together accept.
    #[inline]
    fn end(&self, q: &[u32]) -> Option<End> {
        let mut accepted = true;
        for (part, &q) in self.parts.iter().zip(q) {
            match part.end(q) {
                Some(End::Lost) => return Some(End::Lost),
                end => accepted &= end == Some(End::Accepted),
            }
        }
        accepted.then_some(End::Accepted)
    }
}
