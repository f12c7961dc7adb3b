//! Factored tasks as tables, without multiplying out their automata.

use alloc::collections::{BTreeMap, VecDeque};
use alloc::vec::Vec;
use core::fmt;

use super::{End, Ends, Labelled};
use crate::factored::Factored;
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
        let mut joint = Joint::new(&parts);
        let mut next = Vec::new();
        while let Some(q) = joint.pending.pop_front() {
            for letter in &letters {
                next.push(joint.read(&q, letter));
                if joint.numbers.len() > budget {
                    return Err(JointError::TooLarge { parts: task.len(), budget });
                }
            }
        }
        // Rows were made in the order of the numbers.
        let of = joint.ends;
        let (distance, farthest) = distances(&of, &next, letters.len());
        let ends = Ends { of, distance, farthest };
        Ok(Self { class, classes: letters.len(), next, ends, robustness: Vec::new() })
    }
}

/// The class of each state of the world, and what each part's class is in it.
fn letters(parts: &[Labelled]) -> (Vec<u32>, Vec<Vec<u32>>) {
    let (mut seen, mut letters) = (BTreeMap::new(), Vec::new());
    let states = parts.first().map_or(0, Labelled::states);
    let class = (0..states).map(|s| {
        let letter: Vec<u32> = parts.iter().map(|part| part.class[s]).collect();
        *seen.entry(letter.clone()).or_insert_with(|| {
            letters.push(letter);
            letters.len() as u32 - 1
        })
    });
    (class.collect(), letters)
}

/// The joint states found so far.
struct Joint<'a> {
    parts: &'a [Labelled],
    numbers: BTreeMap<Vec<u32>, u32>,
    ends: Vec<Option<End>>,
    /// Those whose moves are not known yet, in the order of their numbers.
    pending: VecDeque<Vec<u32>>,
    /// The one number of all that accept, of all that are lost.
    accepted: Option<u32>,
    lost: Option<u32>,
}

impl<'a> Joint<'a> {
    fn new(parts: &'a [Labelled]) -> Self {
        let (numbers, pending) = (BTreeMap::new(), VecDeque::new());
        let mut joint =
            Self { parts, numbers, ends: Vec::new(), pending, accepted: None, lost: None };
        joint.number(alloc::vec![0; parts.len()]);
        joint
    }

    /// The number of the state that follows `q` on a letter.
    fn read(&mut self, q: &[u32], letter: &[u32]) -> u32 {
        let next = self.parts.iter().zip(q).zip(letter);
        let next =
            next.map(|((part, &q), &class)| part.next[q as usize * part.classes + class as usize]);
        self.number(next.collect())
    }

    fn number(&mut self, q: Vec<u32>) -> u32 {
        if let Some(&number) = self.numbers.get(&q) {
            return number;
        }
        let fresh = self.ends.len() as u32;
        let end = self.end(&q);
        let number = match end {
            Some(End::Accepted) => *self.accepted.get_or_insert(fresh),
            Some(End::Lost) => *self.lost.get_or_insert(fresh),
            None => fresh,
        };
        if number == fresh {
            self.ends.push(end);
            self.pending.push_back(q.clone());
        }
        self.numbers.insert(q, number);
        number
    }

    fn end(&self, q: &[u32]) -> Option<End> {
        let ends = || self.parts.iter().zip(q).map(|(part, &q)| part.end(q));
        if ends().any(|end| end == Some(End::Lost)) {
            return Some(End::Lost);
        }
        ends().all(|end| end == Some(End::Accepted)).then_some(End::Accepted)
    }
}

/// The least number of moves from each state to acceptance, and the largest of those numbers.
fn distances(ends: &[Option<End>], next: &[u32], classes: usize) -> (Vec<u32>, u32) {
    let mut distance: Vec<u32> =
        ends.iter().map(|&end| if end == Some(End::Accepted) { 0 } else { u32::MAX }).collect();
    let (mut changed, mut farthest) = (true, 0);
    while core::mem::take(&mut changed) {
        for (q, row) in next.chunks(classes).enumerate() {
            let least = row.iter().map(|&to| distance[to as usize]).min().unwrap_or(u32::MAX);
            if least < u32::MAX && least + 1 < distance[q] {
                (distance[q], changed) = (least + 1, true);
            }
        }
    }
    for &distance in distance.iter().filter(|&&distance| distance < u32::MAX) {
        farthest = farthest.max(distance);
    }
    (distance, farthest)
}
