//! Factored tasks as tables, without multiplying out their automata.

use alloc::vec::Vec;
use core::fmt;

use super::{End, Ends, Labelled};
use crate::factored::Factored;
use crate::interner::Interner;
use crate::robustness::Predicates;
use crate::task::Error;

/// Why a factored task has no table.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum JointError {
    /// A predicate is not a number at a state of the world.
    NotANumber(Error),
    /// More joint states can be reached than the budget allows.
    TooLarge {
        /// The number of parts.
        parts: usize,
        /// The most joint states that were allowed.
        budget: usize,
    },
}

impl fmt::Display for JointError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber(error) => error.fmt(f),
            Self::TooLarge { parts, budget } => write!(
                f,
                "the {parts} parts of the task reach more than {budget} states together; learn them as \
                 skills and compose those, or allow more"
            ),
        }
    }
}

impl core::error::Error for JointError {}

impl Labelled {
    /// The table of a factored task over a world's states, in the order of their numbers.
    ///
    /// Only joint states that some sequence of the world's states reaches are numbered, in the
    /// order in which they are found, 0 being the initial one; all that accept are one state, all
    /// in which a part is lost another. The work and the table are as large as those joint states
    /// times the classes of states: goals that lie apart in the world still reach 2^n.
    ///
    /// # Errors
    /// If a predicate is not a number at a state of the world, whose number `instant` then is; if
    /// there are more than `budget` joint states.
    pub fn of_factored<S: Clone, P: Predicates<S>>(
        states: impl IntoIterator<Item = S> + Clone,
        task: &Factored<P>,
        budget: usize,
    ) -> Result<Self, JointError> {
        let part = |i| Self::new(states.clone(), &task.part(i)).map_err(JointError::NotANumber);
        let parts = (0..task.len()).map(part).collect::<Result<Vec<_>, _>>()?;
        let (class, letters) = letters(&parts);
        let letters = letters.items();
        let mut joint = Joint::new(&parts);
        let (mut next, mut q) = (Vec::new(), 0);
        // Rows are made in the order of the numbers; each may find more.
        while let Some(&tuple) = joint.found.get(q) {
            let tuple = joint.tuples.items()[tuple].clone();
            for letter in letters {
                next.push(joint.read(&tuple, letter));
                if joint.numbers.len() > budget {
                    return Err(JointError::TooLarge { parts: task.len(), budget });
                }
            }
            q += 1;
        }
        let distance = distances(joint.ends.len(), joint.accepted, &next, letters.len());
        let ends = Ends::at(joint.ends, distance);
        Ok(Self { class, classes: letters.len(), next, ends, robustness: Vec::new() })
    }
}

/// The class of each state of the world, and what each part's class is in it.
fn letters(parts: &[Labelled]) -> (Vec<u32>, Interner<u32>) {
    let mut letters = Interner::new();
    let states = parts.first().map_or(0, Labelled::states);
    let mut class = Vec::with_capacity(states);
    for s in 0..states {
        let letter: Vec<u32> = parts.iter().map(|part| part.class[s]).collect();
        class.push(letters.number(&letter));
    }
    (class, letters)
}

/// The joint states found so far.
struct Joint<'a> {
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

impl<'a> Joint<'a> {
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
    fn read(&mut self, q: &[u32], letter: &[u32]) -> u32 {
        let mut next = Vec::with_capacity(q.len());
        for ((part, &q), &class) in self.parts.iter().zip(q).zip(letter) {
            next.push(part.next[q as usize * part.classes + class as usize]);
        }
        self.number(&next)
    }

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

/// The least number of moves from each state to acceptance.
fn distances(
    states: usize,
    accepted: Option<u32>,
    next: &[u32],
    classes: usize,
) -> Vec<Option<u32>> {
    let mut distance = alloc::vec![None; states];
    let Some(accepted) = accepted else { return distance };
    distance[accepted as usize] = Some(0);
    let mut changed = true;
    while core::mem::take(&mut changed) {
        for (q, row) in next.chunks(classes).enumerate() {
            for &to in row {
                let Some(through) = distance[to as usize].map(|moves| moves + 1) else { continue };
                if distance[q].is_none_or(|known| through < known) {
                    (distance[q], changed) = (Some(through), true);
                }
            }
        }
    }
    distance
}
