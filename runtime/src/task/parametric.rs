//! Tasks whose arguments are read from the state.
//!
//! A task that takes parameters is one value for each choice of arguments. Where every episode has
//! its own (bring *this* object to *that* shelf, as the environment draws them), a learner still wants
//! one task for all episodes. [`Parametric`] is that: at each state it makes the task of the
//! arguments that the state names. To make a task costs nothing, for its tables are static.

use core::fmt;

use super::{Error, Formula, Task};
use crate::monitor::{Acceptor, Monitor};
use crate::robustness::Predicates;

/// A task whose arguments are read from the state: `deliver(s.wanted, s.target)`, say, if each
/// episode wants something else.
///
/// All arguments share one automaton, so an automaton state means the same for all of them. The
/// arguments must not change during an episode: a state that was reached for one object says nothing
/// about another.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, Monitor, task::Parametric};
///
/// struct Shelf { wanted: u8, seen: u8 }
/// tltl::tltl! {
///     state s: Shelf;
///     predicate see(o: u8) = { s.seen == o };
///     task find(o: u8) = F see(o);
/// }
/// let find = Parametric::new(find(0), |s: &Shelf| find(s.wanted));
/// let q = find.next(0, &Shelf { wanted: 7, seen: 7 })?;
/// assert!(find.is_accepting(q));
/// # }
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone)]
pub struct Parametric<P, F> {
    any: Task<P>,
    of: F,
}

impl<P, F> fmt::Debug for Parametric<P, F> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Parametric").field("any", &self.any).finish_non_exhaustive()
    }
}

impl<P, F> Parametric<P, F> {
    /// The task that is `of(s)` at state `s`. `any` is the same task with whatever arguments: it
    /// answers what does not depend on them, the size of the automaton and the name.
    pub fn new<S: ?Sized>(any: Task<P>, of: F) -> Self
    where
        F: Fn(&S) -> Task<P>,
    {
        Self { any, of }
    }
}

impl<P, F> Acceptor for Parametric<P, F> {
    #[inline]
    fn states(&self) -> u32 {
        self.any.states()
    }

    #[inline]
    fn is_accepting(&self, q: u32) -> bool {
        self.any.is_accepting(q)
    }

    #[inline]
    fn is_trap(&self, q: u32) -> bool {
        self.any.is_trap(q)
    }

    #[inline]
    fn distance(&self, q: u32) -> Option<u32> {
        self.any.distance(q)
    }

    #[inline]
    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.any.successors(q, visit);
    }

    #[inline]
    fn name(&self) -> &str {
        self.any.name()
    }

    #[inline]
    fn formula(&self) -> &Formula {
        self.any.formula()
    }
}

impl<S: ?Sized, P: Predicates<S>, F: Fn(&S) -> Task<P>> Monitor<S> for Parametric<P, F> {
    #[inline]
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        (self.of)(s).next(q, s)
    }

    #[inline]
    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (self.of)(s).progress_robustness(q, s)
    }

    #[inline]
    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (self.of)(s).trap_robustness(q, s)
    }

    /// With the arguments of the first state.
    #[inline]
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        match trajectory.first() {
            Some(s) => (self.of)(s).robustness(trajectory),
            None => self.any.robustness(trajectory),
        }
    }
}
