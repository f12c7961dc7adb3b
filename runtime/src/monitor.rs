//! What learners, solvers and products need of a task.
//!
//! [`Acceptor`] is the part that does not depend on the states of the world: how many automaton
//! states there are, where a task ends, how they are connected. [`Monitor`] adds what reads a state
//! of type `S`. So `task.is_accepting(q)` needs no word about `S`, and a function that only asks
//! where a task ends takes a `&dyn Acceptor`.

#[cfg(feature = "alloc")]
use alloc::{boxed::Box, rc::Rc, sync::Arc};

use crate::automaton::Automaton;
use crate::formula::{EMPTY, Formula};
use crate::robustness::Error;

/// A finite-state acceptor: the states of a task's automaton and how they are connected.
///
/// States are `0..states()`; the initial one, before the first state of the world is read, is 0.
/// Ends are absorbing: from an accepting state and from a trap all moves lead back to it.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, tltl};
///
/// let task = tltl! { |s: &(bool, bool)| !s.0 U s.1 };
/// let mut to = Vec::new();
/// task.successors(0, &mut |q| to.push(q));
/// assert_eq!(to, [0, 1, 2]);
/// assert!(task.is_accepting(1) && task.is_trap(2) && !task.is_terminal(0));
/// assert_eq!((task.distance(0), task.distance(2)), (Some(1), None));
/// assert_eq!(task.formula().text(), "!s.0 U s.1");
/// # }
/// ```
pub trait Acceptor {
    /// The number of automaton states, the trap included.
    fn states(&self) -> u32;

    /// Whether the task is satisfied at `q`.
    fn is_accepting(&self, q: u32) -> bool;

    /// Whether the task can never be satisfied any more at `q`.
    fn is_trap(&self, q: u32) -> bool;

    /// The least number of automaton moves from `q` to acceptance, if there is a way.
    fn distance(&self, q: u32) -> Option<u32>;

    /// Calls `visit` with the target of every edge that leaves `q`, self-loop included, in
    /// ascending order.
    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32));

    /// Whether an episode ends at `q`.
    fn is_terminal(&self, q: u32) -> bool {
        self.is_accepting(q) || self.is_trap(q)
    }

    /// The task's name; its formula if it has none. Empty for an automaton on its own.
    fn name(&self) -> &str {
        ""
    }

    /// The formula; empty for an automaton on its own.
    fn formula(&self) -> &Formula {
        &EMPTY
    }
}

/// A deterministic automaton that reads states of type `S`: what a learner needs of a task. The
/// paper calls it the meta-controller.
///
/// A [`Task`](crate::Task) is one, and so are a product of tasks (module `product`), a
/// [`Numbered`](crate::factored::Numbered) factored task, and references, boxes and counted references to
/// them.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Monitor, tltl};
///
/// /// The last automaton state of a trajectory, whatever the task.
/// fn last<S>(task: &dyn Monitor<S>, trajectory: &[S]) -> Result<u32, tltl::task::Error> {
///     trajectory.iter().try_fold(0, |q, s| task.next(q, s))
/// }
/// let task = tltl! { |x: &f64| F ({ *x } > 3) };
/// let q = last(&task, &[1.0, 5.0]).unwrap();
/// assert!(tltl::Acceptor::is_accepting(&task, q));
/// # }
/// ```
pub trait Monitor<S: ?Sized>: Acceptor {
    /// The state after `q` has read `s`, δ(q, s).
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number.
    fn next(&self, q: u32, s: &S) -> Result<u32, Error>;

    /// Robustness of progress, ρ(s, D_φ^q).
    ///
    /// # Errors
    /// If a predicate is not a number.
    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error>;

    /// Robustness of being lost, ρ(s, ψ_{q,trap}); -∞ if no edge of `q` leads into the trap.
    ///
    /// # Errors
    /// If a predicate is not a number.
    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error>;

    /// Robustness of a whole trajectory (the terminal reward of Li et al. 2016).
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized;
}

/// What a pointer refers to answers for it.
macro_rules! pointers {
    ($($(#[$if:meta])? $pointer:ty),*) => {$(
        $(#[$if])?
        impl<M: Acceptor + ?Sized> Acceptor for $pointer {
            fn states(&self) -> u32 {
                (**self).states()
            }
            fn is_accepting(&self, q: u32) -> bool {
                (**self).is_accepting(q)
            }
            fn is_trap(&self, q: u32) -> bool {
                (**self).is_trap(q)
            }
            fn distance(&self, q: u32) -> Option<u32> {
                (**self).distance(q)
            }
            fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
                (**self).successors(q, visit);
            }
            fn is_terminal(&self, q: u32) -> bool {
                (**self).is_terminal(q)
            }
            fn name(&self) -> &str {
                (**self).name()
            }
            fn formula(&self) -> &Formula {
                (**self).formula()
            }
        }

        $(#[$if])?
        impl<S: ?Sized, M: Monitor<S> + ?Sized> Monitor<S> for $pointer {
            #[inline]
            fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
                (**self).next(q, s)
            }
            fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
                (**self).progress_robustness(q, s)
            }
            fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
                (**self).trap_robustness(q, s)
            }
            fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
            where
                S: Sized,
            {
                (**self).trajectory_robustness(trajectory)
            }
        }
    )*};
}

pointers! {
    &M,
    #[cfg(feature = "alloc")] Box<M>,
    #[cfg(feature = "alloc")] Rc<M>,
    #[cfg(feature = "alloc")] Arc<M>
}

impl Acceptor for Automaton {
    fn states(&self) -> u32 {
        self.tables().states
    }

    #[inline]
    fn is_accepting(&self, q: u32) -> bool {
        self.tables().accepting == Some(q)
    }

    #[inline]
    fn is_trap(&self, q: u32) -> bool {
        self.tables().trap == Some(q)
    }

    fn distance(&self, q: u32) -> Option<u32> {
        Some(self.tables().distance[q as usize]).filter(|&distance| distance < u32::MAX)
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.targets(q).1.iter().for_each(|&to| visit(to));
    }
}
