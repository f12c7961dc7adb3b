//! The hierarchy of the paper: the automaton as meta-controller over low-level controllers.
//!
//! One low-level controller for each automaton state: an extracted sub-policy (Eq. 3A5), one that
//! was emitted as code, or any function of the state that a user wrote. The automaton alone decides
//! which one acts; it is deterministic, so the controllers need no notion of the task.

use alloc::boxed::Box;
use alloc::vec::Vec;

use crate::augmented::End;
use crate::task::{Error, Monitor};

/// A low-level controller: an action for a state.
pub type Controller<'a, S> = Box<dyn FnMut(&S) -> usize + 'a>;

/// Low-level controllers under an automaton.
///
/// ```
/// # use tltl::{automaton::*, controller::Hierarchy, robustness::*, Formula, Task};
/// # static A: Automaton = Automaton {
/// #     propositions: &["a"], states: 2, accepting: Some(1), trap: None,
/// #     transitions: Transitions::Table { class: &[0, 1], width: 2, next: &[0, 1, 1, 1] },
/// #     edges: &[], progress: &[&[&[1]], &[]], distance: &[1, 0],
/// # };
/// # static F: Formula = Formula { text: "F a", ops: &[Op::Is(0), Op::Eventually(0)] };
/// # struct At3;
/// # impl Predicates<i32> for At3 {
/// #     fn robustness(&self, _: usize, s: &i32) -> f64 { if *s == 3 { 1.0 } else { -1.0 } }
/// #     fn holds(&self, _: usize, s: &i32) -> Result<bool, NotANumber> { Ok(*s == 3) }
/// #     fn with_scratch<R>(&self, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
/// #         f(&mut [0.0; 2], &mut [0.0; 2])
/// #     }
/// # }
/// # let task = Task::from_parts("reach", &F, &A, At3);
/// // `task` is `F a`, where a holds at 3; action 1 goes right.
/// let mut hierarchy = Hierarchy::new(&task, |_: &i32| 0).with(0, |_: &i32| 1);
/// let mut s = 1;
/// while hierarchy.observe(&s).unwrap().is_none() {
///     s += hierarchy.act(&s) as i32;
/// }
/// assert_eq!(s, 3);
/// ```
pub struct Hierarchy<'a, S, M> {
    monitor: M,
    controllers: Vec<Option<Controller<'a, S>>>,
    otherwise: Controller<'a, S>,
    q: Option<u32>,
}

impl<'a, S, M: Monitor<S>> Hierarchy<'a, S, M> {
    /// The hierarchy of `monitor`, in which `otherwise` acts at every automaton state until that
    /// is given a [controller](Self::with) of its own.
    pub fn new(monitor: M, otherwise: impl FnMut(&S) -> usize + 'a) -> Self {
        let controllers = (0..monitor.states()).map(|_| None).collect();
        Self { monitor, controllers, otherwise: Box::new(otherwise), q: None }
    }

    /// The same with `controller` acting at `q`.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    #[must_use]
    pub fn with(mut self, q: u32, controller: impl FnMut(&S) -> usize + 'a) -> Self {
        self.controllers[q as usize] = Some(Box::new(controller));
        self
    }

    /// Forgets the episode: the next state that is observed is an s_0.
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

    /// What the controllers do in each of a world's states, in the order of their numbers; indexed
    /// `q * states + s`. As a table the hierarchy can be
    /// [certified](crate::solve::Problem::certify) exactly, and saved as a
    /// [`Policy`](crate::policy::Policy) with its certificate. Of a controller with a memory of its
    /// own the table says what it does when it is asked in this order.
    pub fn policy(&mut self, states: impl IntoIterator<Item = S>) -> Vec<u32> {
        let mut layers: Vec<Vec<u32>> = self.controllers.iter().map(|_| Vec::new()).collect();
        for s in states {
            for (layer, controller) in layers.iter_mut().zip(&mut self.controllers) {
                let controller = controller.as_mut().unwrap_or(&mut self.otherwise);
                layer.push(controller(&s) as u32);
            }
        }
        layers.concat()
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
