//! Conjunctions whose parts run side by side.
//!
//! The automaton of n unordered goals has 2^n states; their n automata together have 2n. A
//! [`Factored`] task keeps the parts of a conjunction apart: its state is one automaton state for
//! each part, it is accepted when all parts are and lost when one is. Parts that share a
//! proposition can also be lost *together* while each could still go on alone (`!b U a` and
//! `!a U b`). The compiler joins such parts into one where their product is small enough, and then
//! nothing is missed; where it is not, [`Factored::joint_dead_ends`] says so.
//!
//! For learning in a finite world, `Labelled::of_factored` (module `augmented`, feature `alloc`)
//! numbers the joint states that the world reaches. [`Factored::part`] gives each part as a
//! [`Task`], of which a `Product` (module `product`) can be made where its size allows.

use crate::automaton::Automaton;
use crate::robustness::{NotANumber, Predicates};
use crate::task::{Error, Formula, Task};

/// One part of a factored task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Part {
    /// Its formula; propositions are numbered as in `automaton`.
    pub formula: &'static Formula,
    /// Its minimal automaton.
    pub automaton: &'static Automaton,
    /// The task's predicate that each proposition of the automaton is.
    pub predicates: &'static [u32],
}

/// Whether all dead ends of a factored task are traps of its parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointDeadEnds {
    /// They are: parts that share propositions have been joined.
    None,
    /// Some parts share propositions and their product is too large: states in which each part
    /// could go on but not all together are not recognised as lost.
    NotSearched,
}

/// A conjunction whose parts run side by side, over the predicates `P`.
#[derive(Clone, Copy, Debug)]
pub struct Factored<P> {
    name: &'static str,
    text: &'static str,
    parts: &'static [Part],
    joint: JointDeadEnds,
    predicates: P,
}

impl<P> Factored<P> {
    /// For generated code: the parts of a factored task.
    #[doc(hidden)]
    pub const fn from_parts(
        name: &'static str,
        text: &'static str,
        parts: &'static [Part],
        joint: JointDeadEnds,
        predicates: P,
    ) -> Self {
        Self { name, text, parts, joint, predicates }
    }

    /// The task's name.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        self.name
    }

    /// The formula as its author wrote it.
    #[must_use]
    pub const fn text(&self) -> &'static str {
        self.text
    }

    /// The number of parts, which is the length of a state.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.parts.len()
    }

    /// Whether there are no parts; never so for a compiled task.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.parts.is_empty()
    }

    /// Whether all dead ends are traps of the parts.
    #[must_use]
    pub const fn joint_dead_ends(&self) -> JointDeadEnds {
        self.joint
    }

    /// Part `i` as a task of its own.
    ///
    /// # Panics
    /// If there is no part `i`.
    #[must_use]
    pub fn part(&self, i: usize) -> Task<Select<'_, P>> {
        let Part { formula, automaton, predicates } = self.parts[i];
        let predicates = Select { predicates: &self.predicates, chosen: predicates };
        Task::from_parts(formula.text, formula, automaton, predicates)
    }

    /// Moves every part on `s`: `q[i] = δ_i(q[i], s)`. A state starts as all 0.
    ///
    /// # Errors
    /// If a predicate that decides a move is not a number; the parts before it have moved.
    ///
    /// # Panics
    /// If `q` does not have one state for each part.
    pub fn next<S: ?Sized>(&self, q: &mut [u32], s: &S) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        assert_eq!(q.len(), self.parts.len(), "one automaton state for each part");
        for (i, q) in q.iter_mut().enumerate() {
            *q = self.part(i).next(*q, s)?;
        }
        Ok(())
    }

    /// Whether all parts accept.
    #[must_use]
    pub fn is_accepting(&self, q: &[u32]) -> bool {
        self.automata().zip(q).all(|(automaton, &q)| automaton.is_accepting(q))
    }

    /// Whether a part is lost.
    #[must_use]
    pub fn is_lost(&self, q: &[u32]) -> bool {
        self.automata().zip(q).any(|(automaton, &q)| automaton.is_trap(q))
    }

    fn automata(&self) -> impl Iterator<Item = &'static Automaton> {
        self.parts.iter().map(|part| part.automaton)
    }

    /// Robustness of a whole trajectory: the least of the parts'; -∞ for an empty one.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn robustness<S>(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let parts = (0..self.parts.len()).map(|i| self.part(i).robustness(trajectory));
        parts.into_iter().try_fold(f64::INFINITY, |least, rho| Ok(least.min(rho?)))
    }

    /// Whether a trajectory satisfies the task: whether it satisfies every part.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn satisfied<S>(&self, trajectory: &[S]) -> Result<bool, Error>
    where
        P: Predicates<S>,
    {
        for i in 0..self.parts.len() {
            if !self.part(i).satisfied(trajectory)? {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

/// Some predicates of a task, numbered anew: those of one of its parts.
#[derive(Debug)]
pub struct Select<'a, P> {
    predicates: &'a P,
    chosen: &'static [u32],
}

impl<P> Clone for Select<'_, P> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Select<'_, P> {}

impl<S: ?Sized, P: Predicates<S>> Predicates<S> for Select<'_, P> {
    #[inline]
    fn robustness(&self, i: usize, s: &S) -> f64 {
        self.predicates.robustness(self.chosen[i] as usize, s)
    }

    #[inline]
    fn holds(&self, i: usize, s: &S) -> Result<bool, NotANumber> {
        self.predicates.holds(self.chosen[i] as usize, s)
    }

    // The whole formula has at least as many operators as a part of it.
    fn with_scratch<R>(&self, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        self.predicates.with_scratch(f)
    }
}
