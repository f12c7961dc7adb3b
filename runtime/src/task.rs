//! A task: a compiled formula together with the predicates that it speaks of.

use core::fmt;

use crate::automaton::Automaton;
use crate::robustness::{self, NotANumber, Op, Predicates};

/// A formula as data: its text and its operators, children before parents.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Formula {
    /// The formula as its author wrote it.
    pub text: &'static str,
    /// Its operators in negation normal form; the last one is the formula itself. None: the
    /// automaton came without a formula.
    pub ops: &'static [Op],
}

/// A compiled task over states of any type that its predicates `P` accept.
///
/// Made by `tltl!` and `include_tltl!`. It holds no state of its own: the automaton state `q` is
/// the caller's.
#[derive(Clone, Copy, Debug)]
pub struct Task<P> {
    name: &'static str,
    formula: &'static Formula,
    automaton: &'static Automaton,
    predicates: P,
}

/// A predicate was not a number at some state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The predicate, as its author named it.
    pub predicate: &'static str,
    /// The instant of the trajectory, if the caller gave a whole one.
    pub instant: Option<usize>,
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "predicate `{}` is not a number (NaN)", self.predicate)?;
        match self.instant {
            Some(instant) => write!(f, " at instant {instant}"),
            None => Ok(()),
        }
    }
}

impl core::error::Error for Error {}

impl<P> Task<P> {
    /// For generated code: the parts of a task.
    #[doc(hidden)]
    pub const fn from_parts(
        name: &'static str,
        formula: &'static Formula,
        automaton: &'static Automaton,
        predicates: P,
    ) -> Self {
        Self { name, formula, automaton, predicates }
    }

    /// The task's name; its formula if it has none.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The formula.
    #[must_use]
    pub fn formula(&self) -> &'static Formula {
        self.formula
    }

    /// The minimal automaton.
    #[must_use]
    pub fn automaton(&self) -> &'static Automaton {
        self.automaton
    }

    /// Robustness of one predicate at `s`, ρ(s, p_i).
    ///
    /// # Errors
    /// If it is not a number.
    ///
    /// # Panics
    /// If there is no predicate `i`.
    pub fn predicate_robustness<S: ?Sized>(&self, i: usize, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let rho = self.predicates.robustness(i, s);
        if rho.is_nan() { Err(self.nan(i)) } else { Ok(rho) }
    }

    /// Robustness of moving from `q` to `to` at `s`, ρ(s, ψ_{q,to}); -∞ if there is no such edge.
    ///
    /// # Errors
    /// If a predicate is not a number.
    pub fn guard_robustness<S: ?Sized>(&self, q: u32, to: u32, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let edge = self.automaton.edges_from(q).iter().find(|edge| edge.to == to);
        self.robustness_of(edge.map_or(&[], |edge| edge.guard), s)
    }

    /// Robustness of progress from `q` at `s`, ρ(s, D_φ^q) of the paper's Eq. 3A3; -∞ at the
    /// accepting state and at the trap.
    ///
    /// # Errors
    /// If a predicate is not a number.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    pub fn progress_robustness<S: ?Sized>(&self, q: u32, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        self.robustness_of(self.automaton.progress[q as usize], s)
    }

    fn robustness_of<S: ?Sized>(&self, guard: crate::automaton::Guard, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let mut nan = None;
        let rho = robustness::guard(guard, |i| {
            let rho = self.predicates.robustness(i, s);
            if rho.is_nan() {
                nan = Some(i);
            }
            rho
        });
        nan.map_or(Ok(rho), |i| Err(self.nan(i)))
    }

    /// Robustness of a whole trajectory, ρ(s_{0:T}, φ), in O(N) time; -∞ for an empty one. Of an
    /// automaton that came without a formula it is that of the [best run](robustness::best_run).
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn robustness<S>(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let rho = |i: usize, t: usize| {
            let rho = self.predicates.robustness(i, &trajectory[t]);
            if rho.is_nan() { Err(Error { instant: Some(t), ..self.nan(i) }) } else { Ok(rho) }
        };
        let (ops, length) = (self.formula.ops, trajectory.len());
        self.predicates.with_scratch(|now, next| {
            if ops.is_empty() {
                robustness::best_run(self.automaton, length, now, next, rho)
            } else {
                robustness::trajectory(ops, length, now, next, rho)
            }
        })
    }

    /// Whether a trajectory satisfies the task; an empty one does not.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn satisfied<S>(&self, trajectory: &[S]) -> Result<bool, Error>
    where
        P: Predicates<S>,
    {
        let mut q = Automaton::INITIAL;
        for (t, s) in trajectory.iter().enumerate() {
            q = self.next(q, s).map_err(|error| Error { instant: Some(t), ..error })?;
        }
        Ok(!trajectory.is_empty() && self.automaton.is_accepting(q))
    }

    fn nan(&self, i: usize) -> Error {
        Error { predicate: self.automaton.propositions[i], instant: None }
    }

    /// The automaton state after `q` has read `s`, δ(q, s).
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    #[inline]
    pub fn next<S: ?Sized>(&self, q: u32, s: &S) -> Result<u32, Error>
    where
        P: Predicates<S>,
    {
        self.automaton.next(q, |i| self.predicates.holds(i, s).map_err(|NotANumber| self.nan(i)))
    }
}

/// What a learner needs of a task: a deterministic automaton that reads states of type `S`.
///
/// A [`Task`] is one, and so is a [product](crate::product::Product) of them. The paper calls it
/// the meta-controller.
pub trait Monitor<S: ?Sized> {
    /// The number of automaton states, the trap included; states are `0..states()` and the
    /// initial one is 0.
    fn states(&self) -> u32;

    /// The state after `q` has read `s`.
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number.
    fn next(&self, q: u32, s: &S) -> Result<u32, Error>;

    /// Whether `q` is accepting (and so absorbing).
    fn is_accepting(&self, q: u32) -> bool;

    /// Whether `q` is the trap.
    fn is_trap(&self, q: u32) -> bool;

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

    /// The least number of automaton moves from `q` to acceptance; `u32::MAX` if there is no way.
    fn distance(&self, q: u32) -> u32;

    /// Calls `visit` with the target of every edge that leaves `q`, self-loop included, in
    /// ascending order.
    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32));

    /// Whether an episode ends at `q`.
    fn is_terminal(&self, q: u32) -> bool {
        self.is_accepting(q) || self.is_trap(q)
    }

    /// Robustness of a whole trajectory (the terminal reward of Li et al. 2016).
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized;
}

impl<S: ?Sized, P: Predicates<S>> Monitor<S> for Task<P> {
    fn states(&self) -> u32 {
        self.automaton.states
    }

    #[inline]
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        Task::next(self, q, s)
    }

    fn is_accepting(&self, q: u32) -> bool {
        self.automaton.is_accepting(q)
    }

    fn is_trap(&self, q: u32) -> bool {
        self.automaton.is_trap(q)
    }

    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        Task::progress_robustness(self, q, s)
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        self.automaton.trap.map_or(Ok(f64::NEG_INFINITY), |trap| self.guard_robustness(q, trap, s))
    }

    fn distance(&self, q: u32) -> u32 {
        self.automaton.distance[q as usize]
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.automaton.edges_from(q).iter().for_each(|edge| visit(edge.to));
    }

    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        self.robustness(trajectory)
    }
}

impl<S: ?Sized, M: Monitor<S> + ?Sized> Monitor<S> for &M {
    fn states(&self) -> u32 {
        (**self).states()
    }

    #[inline]
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        (**self).next(q, s)
    }

    fn is_accepting(&self, q: u32) -> bool {
        (**self).is_accepting(q)
    }

    fn is_trap(&self, q: u32) -> bool {
        (**self).is_trap(q)
    }

    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (**self).progress_robustness(q, s)
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (**self).trap_robustness(q, s)
    }

    fn distance(&self, q: u32) -> u32 {
        (**self).distance(q)
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        (**self).successors(q, visit);
    }

    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        (**self).trajectory_robustness(trajectory)
    }
}

/// A task whose arguments are read from the state: `deliver(s.wanted, s.target)`, say, where each
/// episode wants something else.
///
/// All arguments share one automaton, so an automaton state means the same for all of them.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::task::{Monitor, Parametric};
///
/// struct Shelf { wanted: u8, seen: u8 }
/// tltl::tltl! {
///     state s: Shelf;
///     predicate see(o: u8) = { s.seen == o };
///     task find(o: u8) = F see(o);
/// }
/// let find = Parametric::new(find(0), |s: &Shelf| find(s.wanted));
/// let q = find.next(0, &Shelf { wanted: 7, seen: 7 }).unwrap();
/// assert!(Monitor::<Shelf>::is_accepting(&find, q));
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Parametric<P, F> {
    any: Task<P>,
    of: F,
}

impl<P, F> Parametric<P, F> {
    /// The task that is `of(s)` at state `s`; `any` is the same with whatever arguments.
    pub fn new<S: ?Sized>(any: Task<P>, of: F) -> Self
    where
        F: Fn(&S) -> Task<P>,
    {
        Self { any, of }
    }
}

impl<S: ?Sized, P: Predicates<S>, F: Fn(&S) -> Task<P>> Monitor<S> for Parametric<P, F> {
    fn states(&self) -> u32 {
        Monitor::<S>::states(&self.any)
    }

    #[inline]
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        (self.of)(s).next(q, s)
    }

    fn is_accepting(&self, q: u32) -> bool {
        Monitor::<S>::is_accepting(&self.any, q)
    }

    fn is_trap(&self, q: u32) -> bool {
        Monitor::<S>::is_trap(&self.any, q)
    }

    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (self.of)(s).progress_robustness(q, s)
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        (self.of)(s).trap_robustness(q, s)
    }

    fn distance(&self, q: u32) -> u32 {
        Monitor::<S>::distance(&self.any, q)
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        Monitor::<S>::successors(&self.any, q, visit);
    }

    /// With the arguments of the first state.
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
