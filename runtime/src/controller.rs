//! The hierarchy of the paper: the automaton as meta-controller over low-level controllers.
//!
//! One low-level controller for each automaton state: an extracted sub-policy (Eq. 3A5), one that
//! was emitted as code, or any function of the state that a user wrote. The automaton alone decides
//! which one acts; it is deterministic, so the controllers need no notion of the task.

use alloc::boxed::Box;
use alloc::vec::Vec;
use core::fmt;

use crate::augmented::Labelled;
use crate::monitor::Monitor;
use crate::policy::{Policy, PolicyError};
use crate::reward::End;
use crate::task::Error;

/// A low-level controller: an action for a state. It is `Send`, so that a hierarchy can be handed to the
/// thread that steps the robot.
///
/// Anything that can be called: a table, a planner, a PID loop with a state of its own. It is asked
/// only at the automaton states that it was given to, and never told of the task.
///
/// ```
/// use tltl::controller::{Controller, Hierarchy};
/// use tltl::tltl;
///
/// let task = tltl! { |x: &i32| ({ *x } == 2) T ({ *x } == 0) };
/// let controllers: Vec<Controller<'_, i32>> = vec![Box::new(|_| 1), Box::new(|x| usize::from(*x < 0))];
/// let mut hierarchy = Hierarchy::new(&task, |_: &i32| 0);
/// for (q, controller) in controllers.into_iter().enumerate() {
///     hierarchy = hierarchy.with(q as u32, controller);
/// }
/// hierarchy.observe(&2)?;
/// assert_eq!((hierarchy.q(), hierarchy.act(&2)), (Some(1), 0));
/// # Ok::<(), tltl::task::Error>(())
/// ```
pub type Controller<'a, S> = Box<dyn FnMut(&S) -> usize + Send + 'a>;

/// Low-level controllers under an automaton.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{controller::Hierarchy, tltl};
///
/// // Action 1 goes right.
/// let task = tltl! { |x: &i32| F ({ *x } == 3) };
/// let mut hierarchy = Hierarchy::new(&task, |_: &i32| 0).with(0, |_: &i32| 1);
/// let mut x = 1;
/// while hierarchy.observe(&x)?.is_none() {
///     x += hierarchy.act(&x) as i32;
/// }
/// assert_eq!(x, 3);
/// # }
/// # Ok::<(), tltl::task::Error>(())
/// ```
pub struct Hierarchy<'a, S, M> {
    monitor: M,
    controllers: Vec<Option<Controller<'a, S>>>,
    otherwise: Controller<'a, S>,
    q: Option<u32>,
}

impl<S, M: fmt::Debug> fmt::Debug for Hierarchy<'_, S, M> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let own = self.controllers.iter().enumerate().filter(|(_, known)| known.is_some());
        f.debug_struct("Hierarchy")
            .field("monitor", &self.monitor)
            .field("q", &self.q)
            .field("states_with_a_controller", &own.map(|(q, _)| q).collect::<Vec<_>>())
            .finish_non_exhaustive()
    }
}

impl<'a, S, M: Monitor<S>> Hierarchy<'a, S, M> {
    /// The hierarchy of `monitor`, in which `otherwise` acts at every automaton state until that
    /// is given a [controller](Self::with) of its own.
    pub fn new(monitor: M, otherwise: impl FnMut(&S) -> usize + Send + 'a) -> Self {
        let controllers = (0..monitor.states()).map(|_| None).collect();
        Self { monitor, controllers, otherwise: Box::new(otherwise), q: None }
    }

    /// The same with `controller` acting at `q`.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    #[must_use]
    #[track_caller]
    pub fn with(mut self, q: u32, controller: impl FnMut(&S) -> usize + Send + 'a) -> Self {
        self.controllers[q as usize] = Some(Box::new(controller));
        self
    }

    /// Forgets the episode: the next state that is observed is an s_0.
    ///
    /// ```
    /// use tltl::controller::Hierarchy;
    /// use tltl::reward::End;
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &i32| F ({ *x } == 3) };
    /// let mut hierarchy = Hierarchy::new(&task, |_: &i32| 1);
    /// assert_eq!(hierarchy.observe(&3)?, Some(End::Accepted));
    /// hierarchy.reset();
    /// assert_eq!((hierarchy.q(), hierarchy.end()), (None, None));
    /// assert_eq!(hierarchy.observe(&0)?, None, "a new episode");
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    pub fn reset(&mut self) {
        self.q = None;
    }

    /// Reads a state, s_0 included, and says how the task has ended, if it has.
    ///
    /// # Errors
    /// If a predicate is not a number there; the hierarchy then stays as it was.
    pub fn observe(&mut self, s: &S) -> Result<Option<End>, Error> {
        self.q = Some(self.monitor.next(self.q.unwrap_or(0), s)?);
        Ok(self.end())
    }

    /// The action of the controller whose turn it is.
    pub fn act(&mut self, s: &S) -> usize {
        match &mut self.controllers[self.q.unwrap_or(0) as usize] {
            Some(controller) => controller(s),
            None => (self.otherwise)(s),
        }
    }

    /// What the controllers do in each of a world's `states`, in the order of their numbers. As a
    /// [`Policy`] the hierarchy can be [certified](crate::solve::Optimum::certify) exactly, and
    /// saved. Of a controller with a memory of its own the policy says what the controller does when
    /// it is asked in this order.
    ///
    /// ```
    /// use tltl::controller::Hierarchy;
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let end = tltl! { |s: &usize| F ({ *s } == 4) };
    /// let task = Labelled::of_model(&row, &end)?;
    /// let mut hierarchy = Hierarchy::new(&end, |_: &usize| 0).with(0, |s: &usize| usize::from(*s > 0));
    /// let policy = hierarchy.policy(&task, 0..5)?;
    /// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
    /// assert_eq!(optimum.certify(&policy)?.satisfied, 0.8, "stuck in cell 0, sure from the others");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If states and controllers do not fit `task`, or an action is not one of the world's.
    pub fn policy(
        &mut self,
        task: &Labelled,
        states: impl IntoIterator<Item = S>,
    ) -> Result<Policy, PolicyError> {
        let mut layers: Vec<Vec<usize>> = self.controllers.iter().map(|_| Vec::new()).collect();
        for s in states {
            for (layer, controller) in layers.iter_mut().zip(&mut self.controllers) {
                let controller = controller.as_mut().unwrap_or(&mut self.otherwise);
                layer.push(controller(&s));
            }
        }
        Policy::new(task, layers.concat())
    }

    /// The automaton state; `None` before an episode's first state was observed.
    pub const fn q(&self) -> Option<u32> {
        self.q
    }

    /// How the task has ended, if it has.
    pub fn end(&self) -> Option<End> {
        match self.q? {
            q if self.monitor.is_accepting(q) => Some(End::Accepted),
            q if self.monitor.is_trap(q) => Some(End::Lost),
            _ => None,
        }
    }
}
