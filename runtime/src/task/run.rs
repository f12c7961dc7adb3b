//! The automaton's run on a trajectory, one state at a time.

use core::fmt;

use super::{Error, Task, not_a_number};
use crate::automaton::Automaton;
use crate::monitor::Acceptor;
use crate::robustness::{self, NotANumber, Predicates};

/// The run of a task's automaton on one trajectory: a state `q` that is never anything else.
///
/// [`Task::next`] takes the state from its caller and has to look whether it is one. Here it is known
/// to be, so a step of a compiled task has no panic in it, and a binary that only steps links none.
///
/// ```
/// use tltl::tltl;
///
/// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
/// let mut run = task.run();
/// assert_eq!(run.step(&5.0)?, None);
/// assert_eq!(run.step(&0.5)?, Some(true));
/// assert_eq!(run.state(), 2);
/// # Ok::<(), tltl::task::Error>(())
/// ```
pub struct Run<'a, P> {
    pub(super) task: &'a Task<P>,
    /// The [place](Automaton::place) of its state.
    place: u32,
}

/// Where it stands.
impl<P> fmt::Debug for Run<'_, P> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Run").field("task", &self.task).field("q", &self.state()).finish()
    }
}

impl<P> Clone for Run<'_, P> {
    #[inline]
    fn clone(&self) -> Self {
        *self
    }
}

impl<P> Copy for Run<'_, P> {}

impl<P> Task<P> {
    /// The run on a trajectory, before its first state.
    ///
    /// # Panics
    /// If the task was put together of predicates and another formula, by [`Task::new`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn run(&self) -> Run<'_, P> {
        assert!(self.is_generated, "the predicates were generated with another formula");
        Run { task: self, place: self.automaton.place(Automaton::INITIAL) }
    }
}

impl<P> Run<'_, P> {
    /// Reads the next state, and gives the [verdict](Self::verdict) after it.
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number. The run stays where it was.
    // Inlined, so that the state stays in a register.
    #[inline(always)]
    pub fn step<S: ?Sized>(&mut self, s: &S) -> Result<Option<bool>, Error>
    where
        P: Predicates<S>,
    {
        self.place = self.next(s)?;
        Ok(self.verdict())
    }

    /// The place after `s`.
    #[inline(always)]
    pub(super) fn next<S: ?Sized>(&self, s: &S) -> Result<u32, Error>
    where
        P: Predicates<S>,
    {
        // `Task::run` has asserted that predicates and automaton belong together.
        if P::DENSE > 0 {
            return match robustness::one_letter(&self.task.predicates, s) {
                (letter, false) => Ok(self.task.automaton.move_on(self.place, letter)),
                _ => Err(self.task.reader().unreadable(s)),
            };
        }
        let (predicates, automaton) = (&self.task.predicates, &self.task.automaton);
        let holds = |i| predicates.holds(i, s).map_err(|NotANumber| not_a_number(automaton, i));
        Ok(automaton.place(automaton.follow(self.state(), holds)?))
    }

    /// Moves to a place that [`next`](Self::next) gave.
    #[inline(always)]
    pub(super) fn set(&mut self, place: u32) {
        self.place = place;
    }

    /// Whether the task is satisfied (`true`) or lost (`false`), as soon as it is decided; `None`
    /// while it can still go either way.
    #[must_use]
    #[inline]
    pub fn verdict(&self) -> Option<bool> {
        let q = self.state();
        let is_accepting = self.task.is_accepting(q);
        (is_accepting || self.task.is_trap(q)).then_some(is_accepting)
    }

    /// The state of the automaton.
    #[must_use]
    #[inline]
    pub fn state(&self) -> u32 {
        self.task.automaton.state(self.place)
    }
}
