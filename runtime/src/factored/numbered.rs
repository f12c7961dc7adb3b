//! Factored tasks as monitors: a number for every tuple of the parts' states.
//!
//! The number of the tuple (q₀, q₁, …) is q₀ + n₀ (q₁ + n₁ (q₂ + …)), where part i has nᵢ states: the
//! states are the digits of a number of mixed radix, the first part's is the lowest. Nothing is
//! explored or stored, so nothing is allocated, and a numbered task costs no more than its parts.
//!
//! The price is that all tuples have a number, also those that no trajectory reaches. What makes a
//! table of all states (`Labelled::new`) should take `Labelled::of_factored` instead, and what needs
//! few states a `Product` of the [parts](Factored::part).

use core::fmt;

use super::{Factored, Part};
use crate::monitor::{Acceptor, Monitor};
use crate::robustness::Predicates;
use crate::shared::Shared;
use crate::task::{Error, Formula};

/// A factored task whose state is one number: a [`Monitor`], for everything that takes one.
///
/// A part that is lost loses the task: all tuples with such a part are traps, and a move into one of
/// them leads to the one with the least number. The parts are treated as independent, as the operands
/// of a product are: `successors` lists every combination of the parts' moves, and `distance` takes
/// all parts to move at once.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, Monitor, tltl};
///
/// let goals = tltl! { #[factored] |s: &[bool; 3]| F s[0] && F s[1] && F s[2] };
/// let numbered = goals.numbered()?;
/// assert_eq!(numbered.states(), 8);
/// let q = numbered.next(0, &[true, false, true]).unwrap();
/// assert!(numbered.parts(q).eq([1, 0, 1]));
/// assert_eq!(numbered.distance(q), Some(1));
/// # }
/// # Ok::<(), tltl::factored::TooManyStates>(())
/// ```
#[derive(Clone)]
pub struct Numbered<P> {
    task: Factored<P>,
    states: u32,
    /// The least number of a tuple in which a part is lost.
    trap: Option<u32>,
}

impl<P> fmt::Debug for Numbered<P> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Numbered").field("task", &self.task).field("states", &self.states).finish()
    }
}

/// The parts of a factored task have so many states together that 32 bits do not number them.
///
/// The message names the numbers of states. Such a task is followed part by part
/// ([`Factored::next`]), and learned over the states that a world reaches (`Labelled::of_factored`).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TooManyStates {
    task: Shared<str>,
    parts: Shared<[Part]>,
}

impl fmt::Display for TooManyStates {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the parts of `{}` have ", self.task)?;
        for (i, part) in self.parts.iter().enumerate() {
            let times = if i == 0 { "" } else { " × " };
            write!(f, "{times}{}", part.automaton.states())?;
        }
        f.write_str(" states together, which is more than 2^32 - 1")
    }
}

impl core::error::Error for TooManyStates {}

impl<P> Factored<P> {
    /// The task with one number as its state.
    ///
    /// # Errors
    /// If the parts' numbers of states multiply to more than a `u32` holds: 32 goals do.
    pub fn numbered(self) -> Result<Numbered<P>, TooManyStates> {
        let (mut states, mut trap) = (1_u32, None);
        for part in &*self.parts {
            let lost = part.automaton.trap().and_then(|q| q.checked_mul(states));
            trap = trap.into_iter().chain(lost).min();
            let Some(more) = states.checked_mul(part.automaton.states()) else {
                return Err(TooManyStates { task: self.name, parts: self.parts });
            };
            states = more;
        }
        Ok(Numbered { task: self, states, trap })
    }
}

impl<P> Numbered<P> {
    /// The factored task.
    #[must_use]
    pub const fn task(&self) -> &Factored<P> {
        &self.task
    }

    /// The state of each part at `q`: the digits of the number.
    pub fn parts(&self, q: u32) -> impl Iterator<Item = u32> + Clone {
        let mut rest = q;
        self.task.automata().map(move |automaton| {
            let states = automaton.states();
            let part = rest % states;
            rest /= states;
            part
        })
    }

    /// Visits all tuples that `parts` reach from `q` in one move without being lost, by rising number:
    /// the last part, whose digit weighs most, moves slowest. `place` is the weight of the digit after
    /// it, `number` the digits from there on. The depth is the number of parts, of which there are
    /// fewer than 32 that have two states.
    fn walk(parts: &[Part], q: u32, place: u32, number: u32, visit: &mut dyn FnMut(u32)) {
        let Some((part, rest)) = parts.split_last() else { return visit(number) };
        let automaton = &part.automaton;
        let place = place / automaton.states();
        automaton.successors(q / place % automaton.states(), &mut |to| {
            if !automaton.is_trap(to) {
                Self::walk(rest, q, place, number + to * place, visit);
            }
        });
    }

    /// Whether a part can be lost by a move from `q`.
    fn is_at_risk(&self, q: u32) -> bool {
        let mut parts = self.task.automata().zip(self.parts(q));
        parts.any(|(automaton, q)| {
            let mut lost = false;
            automaton.successors(q, &mut |to| lost |= automaton.is_trap(to));
            lost
        })
    }
}

impl<P> Acceptor for Numbered<P> {
    fn states(&self) -> u32 {
        self.states
    }

    fn is_accepting(&self, q: u32) -> bool {
        self.task.automata().zip(self.parts(q)).all(|(automaton, q)| automaton.is_accepting(q))
    }

    fn is_trap(&self, q: u32) -> bool {
        self.task.automata().zip(self.parts(q)).any(|(automaton, q)| automaton.is_trap(q))
    }

    /// The greatest of the parts' distances: all move at once, and the ones that are done wait.
    fn distance(&self, q: u32) -> Option<u32> {
        let mut parts = self.task.automata().zip(self.parts(q));
        parts.try_fold(0, |most, (automaton, q)| Some(automaton.distance(q)?.max(most)))
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        let mut trap = self.trap.filter(|_| self.is_at_risk(q));
        Self::walk(&self.task.parts, q, self.states, 0, &mut |to| {
            trap.take_if(|trap| *trap < to).into_iter().for_each(&mut *visit);
            visit(to);
        });
        trap.into_iter().for_each(visit);
    }

    fn name(&self) -> &str {
        self.task.name()
    }

    fn formula(&self) -> &Formula {
        self.task.formula()
    }
}

impl<S: ?Sized, P: Predicates<S>> Monitor<S> for Numbered<P> {
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        let (mut number, mut place, mut lost) = (0, 1, false);
        for (part, at) in self.task.readers().zip(self.parts(q)) {
            let to = part.next(at, s)?;
            lost |= part.automaton.is_trap(to);
            number += to * place;
            // No overflow: after the last part it is the number of states, which fits.
            place *= part.automaton.states();
        }
        Ok(self.trap.filter(|_| lost).unwrap_or(number))
    }

    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_terminal(q) {
            return Ok(f64::NEG_INFINITY);
        }
        self.task.progress(self.parts(q), s)
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_terminal(q) {
            return Ok(f64::NEG_INFINITY);
        }
        let mut parts = self.task.readers().zip(self.parts(q));
        parts.try_fold(f64::NEG_INFINITY, |most, (part, q)| Ok(most.max(part.trap(q, s)?)))
    }

    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        self.task.robustness(trajectory)
    }
}
