//! A task: a compiled formula together with the predicates that it is about.
//!
//! `tltl!` and `include_tltl!` make tasks in constants, over static tables; a task that is compiled
//! at run time owns its tables. Both are [`Task`]. A task holds no automaton state: the state `q`
//! is the caller's, one `u32`, and one task serves any number of trajectories at once.

mod batch;
mod many;
mod online;
mod parametric;
mod run;

use core::fmt;

pub use online::{Interval, Online};
pub use parametric::Parametric;
pub use run::Run;

#[cfg(feature = "alloc")]
use crate::automaton::TableError;
use crate::automaton::{Automaton, Guard, proposition};
pub use crate::formula::Formula;
#[cfg(feature = "alloc")]
use crate::formula::check_operators;
use crate::monitor::{Acceptor, Monitor};
pub use crate::robustness::Error;
use crate::robustness::{self, NotANumber, Op, Predicates};
use crate::shared::Shared;

/// A compiled task over states of any type that its predicates `P` read.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, tltl};
///
/// let warm = |celsius: &f64| celsius - 60.0;
/// let hot = |celsius: &f64| celsius - 90.0;
/// // Warm up, and do not become hot before that.
/// let task = tltl! { !hot U warm };
/// let mut q = 0;
/// for celsius in [20.0, 45.0, 65.0] {
///     q = task.next(q, &celsius)?;
/// }
/// assert!(task.is_accepting(q));
/// assert_eq!(task.robustness(&[20.0, 45.0, 65.0])?, 5.0);
/// # }
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone)]
pub struct Task<P> {
    name: Shared<str>,
    formula: Shared<Formula>,
    automaton: Shared<Automaton>,
    predicates: P,
    /// Whether the predicates were generated with this formula, and not with another one.
    is_generated: bool,
}

/// Name, formula and size: predicates are code.
impl<P> fmt::Debug for Task<P> {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Task")
            .field("name", &self.name)
            .field("formula", &self.formula.text)
            .field("states", &self.automaton.states())
            .finish_non_exhaustive()
    }
}

impl<P> Task<P> {
    /// The task of tables that a program made at run time: predicate `i` is proposition `i` of the
    /// automaton.
    ///
    /// # Errors
    /// If the formula is about a proposition that the automaton does not have.
    ///
    /// ```
    /// # #[cfg(feature = "macros")] {
    /// use tltl::{Acceptor, Task, tltl};
    /// # use tltl::robustness::{NotANumber, Predicates};
    /// # struct Threshold(f64);
    /// # impl Predicates<f64> for Threshold {
    /// #     fn robustness(&self, _: usize, s: &f64) -> f64 { s - self.0 }
    /// #     fn holds(&self, _: usize, s: &f64) -> Result<bool, NotANumber> { Ok(*s > self.0) }
    /// # }
    ///
    /// // The same formula and automaton, over other predicates.
    /// let positive = tltl! { |x: &f64| F ({ *x } > 0) };
    /// let (formula, automaton) = (positive.formula().clone(), positive.automaton().clone());
    /// let above_3 = Task::new("above 3", formula, automaton, Threshold(3.0))?;
    /// assert_eq!(above_3.robustness(&[1.0, 5.0]), Ok(2.0));
    /// # }
    /// # Ok::<(), tltl::automaton::TableError>(())
    /// ```
    #[cfg(feature = "alloc")]
    #[inline]
    pub fn new(
        name: impl Into<Shared<str>>,
        formula: impl Into<Shared<Formula>>,
        automaton: impl Into<Shared<Automaton>>,
        predicates: P,
    ) -> Result<Self, TableError> {
        let (name, formula, automaton) = (name.into(), formula.into(), automaton.into());
        let propositions = automaton.propositions().len();
        check_operators(formula.operators(), propositions)?;
        Ok(Self { name, formula, automaton, predicates, is_generated: false })
    }

    /// For generated code, whose tables are right by construction.
    #[doc(hidden)]
    pub const fn trusted(
        name: Shared<str>,
        formula: Shared<Formula>,
        automaton: Shared<Automaton>,
        predicates: P,
    ) -> Self {
        Self { name, formula, automaton, predicates, is_generated: true }
    }

    /// The minimal automaton.
    #[must_use]
    #[inline]
    pub fn automaton(&self) -> &Automaton {
        &self.automaton
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
        self.reader().next(q, s)
    }

    /// Robustness of one predicate at `s`, ρ(s, p_i).
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
    /// assert_eq!(task.automaton().propositions().len(), 2);
    /// assert_eq!(task.predicate_robustness(0, &5.0)?, 2.0);
    /// assert_eq!(task.predicate_robustness(1, &5.0)?, -4.0);
    /// assert!(task.predicate_robustness(0, &f64::NAN).is_err());
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
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
        let count = self.automaton.propositions().len();
        assert!(i < count, "there is no predicate {i}");
        self.reader().number(i, self.predicates.robustness(i, s))
    }

    /// Robustness of moving from `q` to `to` at `s`, ρ(s, ψ_{q,to}); -∞ if there is no such edge.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let careful = tltl! { |s: &[f64; 2]| (s[0] < 9) U (s[1] > 3) };
    /// let s = [5.0, 2.0]; // not there yet, by 1; not too near, by 4
    /// assert_eq!(careful.progress_robustness(0, &s)?, -1.0);
    /// assert_eq!(careful.guard_robustness(0, 0, &s)?, 1.0, "waiting");
    /// let lost = careful.automaton().trap().expect("this task can be lost");
    /// assert_eq!(careful.guard_robustness(0, lost, &s)?, -4.0);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    ///
    /// # Errors
    /// If a predicate is not a number.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    pub fn guard_robustness<S: ?Sized>(&self, q: u32, to: u32, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        self.reader().guard(self.automaton.edge_guard(q, to), s)
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
        self.reader().progress(q, s)
    }

    /// Robustness of a whole trajectory, ρ(s_{0:T}, φ), in O(N) time; -∞ for an empty one. If the
    /// automaton came without a formula, it is that of the [best run](robustness::best_run).
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn robustness<S>(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        self.reader().robustness(trajectory, &mut [])
    }

    /// The robustness of what is left of a trajectory at each of its instants, ρ(s_{t:T}, φ), in O(N)
    /// time for all of them: `signal[t]` gets that from instant t on.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant. `signal` is then not to be used.
    ///
    /// # Panics
    /// If `signal` does not have a place for each instant.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| F ({ *x } > 3) };
    /// let mut signal = [0.0; 4];
    /// task.robustness_signal(&[1.0, 5.0, 2.0, 4.0], &mut signal)?;
    /// assert_eq!(signal, [2.0, 2.0, 1.0, 1.0]);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[track_caller]
    pub fn robustness_signal<S>(&self, trajectory: &[S], signal: &mut [f64]) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        assert_eq!(signal.len(), trajectory.len(), "a place for each instant");
        self.reader().robustness(trajectory, signal).map(|_| ())
    }

    /// Whether a trajectory satisfies the task; an empty one does not.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    pub fn satisfied<S>(&self, trajectory: &[S]) -> Result<bool, Error>
    where
        P: Predicates<S>,
    {
        self.reader().satisfied(trajectory)
    }

    #[inline]
    fn reader(&self) -> Reader<'_, &P> {
        Reader {
            formula: &self.formula,
            automaton: &self.automaton,
            predicates: &self.predicates,
            is_generated: self.is_generated,
        }
    }
}

impl<P> Acceptor for Task<P> {
    #[inline]
    fn states(&self) -> u32 {
        self.automaton.states()
    }

    #[inline]
    fn is_accepting(&self, q: u32) -> bool {
        self.automaton.is_accepting(q)
    }

    #[inline]
    fn is_trap(&self, q: u32) -> bool {
        self.automaton.is_trap(q)
    }

    #[inline]
    fn distance(&self, q: u32) -> Option<u32> {
        self.automaton.distance(q)
    }

    #[inline]
    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.automaton.successors(q, visit);
    }

    #[inline]
    fn name(&self) -> &str {
        &self.name
    }

    #[inline]
    fn formula(&self) -> &Formula {
        &self.formula
    }
}

impl<S: ?Sized, P: Predicates<S>> Monitor<S> for Task<P> {
    #[inline]
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        self.reader().next(q, s)
    }

    #[inline]
    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        self.reader().progress(q, s)
    }

    #[inline]
    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        self.reader().trap(q, s)
    }

    #[inline]
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        self.reader().robustness(trajectory, &mut [])
    }
}

/// Reads states for an automaton that someone else holds: a task, or one of the parts of a factored
/// task, for which a [`Task`] would count references at every step.
#[derive(Clone, Copy)]
pub(crate) struct Reader<'a, P> {
    pub(crate) formula: &'a Formula,
    pub(crate) automaton: &'a Automaton,
    pub(crate) predicates: P,
    /// Whether the predicates were generated with this formula.
    pub(crate) is_generated: bool,
}

impl<P: Copy> Reader<'_, P> {
    // Left to itself the compiler makes it a function of its own, which returns its result in memory:
    // a step then takes twice as long.
    #[inline(always)]
    pub(crate) fn next<S: ?Sized>(&self, q: u32, s: &S) -> Result<u32, Error>
    where
        P: Predicates<S>,
    {
        if self.is_generated && P::DENSE > 0 {
            self.automaton.expect_state(q);
            return match robustness::one_letter(&self.predicates, s) {
                (letter, false) => Ok(self.automaton.of_letter(q, letter)),
                _ => Err(self.unreadable(s)),
            };
        }
        let holds = |i| self.predicates.holds(i, s).map_err(|NotANumber| i);
        self.automaton.next(q, holds).map_err(|i| not_a_number(self.automaton, i))
    }

    pub(crate) fn progress<S: ?Sized>(&self, q: u32, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        self.guard(self.automaton.progress(q), s)
    }

    /// Robustness of being lost; -∞ where the task cannot be.
    pub(crate) fn trap<S: ?Sized>(&self, q: u32, s: &S) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let trap = self.automaton.trap();
        self.guard(trap.map_or(Guard::FALSE, |trap| self.automaton.edge_guard(q, trap)), s)
    }

    #[inline]
    fn guard<S: ?Sized>(&self, guard: Guard<'_>, s: &S) -> Result<f64, Error>
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
        match nan {
            None => Ok(rho),
            Some(i) => Err(not_a_number(self.automaton, i)),
        }
    }

    /// Robustness of a trajectory; where `signal` has a place for each instant, it gets that from each
    /// on.
    pub(crate) fn robustness<S>(&self, trajectory: &[S], signal: &mut [f64]) -> Result<f64, Error>
    where
        P: Predicates<S>,
    {
        let straight = self.is_generated.then(|| self.predicates.straight(trajectory, signal));
        let rho = straight.flatten().unwrap_or_else(|| self.interpreted(trajectory, signal));
        if rho.is_nan() { Err(self.first_not_a_number(trajectory)) } else { Ok(rho) }
    }

    /// The same, operator by operator; NaN if a predicate is.
    fn interpreted<S>(&self, trajectory: &[S], signal: &mut [f64]) -> f64
    where
        P: Predicates<S>,
    {
        let rho = |i: usize, t: usize| {
            let rho = self.predicates.robustness(i, &trajectory[t]);
            if rho.is_nan() { Err(rho) } else { Ok(rho) }
        };
        let (operators, length) = (self.formula.operators(), trajectory.len());
        // Of a run there is a cell for each state.
        let cells = match operators {
            [] => self.automaton.states() as usize,
            _ => robustness::cells(operators, length),
        };
        let found = self.predicates.with_scratch(cells, |now, next| match operators {
            [] => {
                robustness::best_runs(self.automaton, now, next, signal, rho)?;
                robustness::best_run(self.automaton, length, now, next, rho)
            }
            _ => robustness::signal(operators, length, now, next, signal, rho),
        });
        found.unwrap_or_else(|nan| nan)
    }

    /// The error of a trajectory on which a predicate is not a number: the earliest instant, and in it
    /// the predicate with the lowest number, of those that robustness reads. It is searched for only
    /// now: a loop that can stop anywhere is several times slower than one that cannot.
    #[cold]
    fn first_not_a_number<S>(&self, trajectory: &[S]) -> Error
    where
        P: Predicates<S>,
    {
        let count = self.automaton.propositions().len();
        let is_nan = |t: usize, i: usize| self.predicates.robustness(i, &trajectory[t]).is_nan();
        let of = |t: usize| (0..count).filter(|&i| self.reads(i)).find(|&i| is_nan(t, i));
        let first = (0..trajectory.len()).find_map(|t| Some((t, of(t)?)));
        let (instant, i) = first.unwrap_or_default();
        Error { instant: Some(instant), ..not_a_number(self.automaton, i) }
    }

    /// Whether the robustness of a trajectory depends on predicate `i`.
    fn reads(&self, i: usize) -> bool {
        match self.formula.operators() {
            [] => {
                let mut guards = self.automaton.edges().map(|edge| edge.guard);
                guards.any(|guard| guard.cubes().flatten().any(|&l| proposition(l) == i))
            }
            operators => operators.iter().any(|op| match *op {
                Op::Is(of) | Op::Not(of) => of as usize == i,
                _ => false,
            }),
        }
    }

    /// The error of a state at which a predicate is not a number.
    // Inlined but for the search: rustc then sees that it is an error, and a loop that ends with one keeps
    // what it knows of the task in registers.
    #[inline(always)]
    pub(crate) fn unreadable<S: ?Sized>(self, s: &S) -> Error
    where
        P: Predicates<S>,
    {
        not_a_number(self.automaton, robustness::unreadable(&self.predicates, s))
    }

    pub(crate) fn satisfied<S>(&self, trajectory: &[S]) -> Result<bool, Error>
    where
        P: Predicates<S>,
    {
        let mut q = Automaton::INITIAL;
        for (t, s) in trajectory.iter().enumerate() {
            q = self.next(q, s).map_err(|error| Error { instant: Some(t), ..error })?;
        }
        Ok(!trajectory.is_empty() && self.automaton.is_accepting(q))
    }

    #[inline]
    fn number(&self, i: usize, rho: f64) -> Result<f64, Error> {
        if rho.is_nan() { Err(not_a_number(self.automaton, i)) } else { Ok(rho) }
    }
}

/// The error of predicate `i`.
#[inline(always)]
fn not_a_number(automaton: &Automaton, i: usize) -> Error {
    let name = automaton.propositions().get(i).cloned();
    Error { predicate: name.unwrap_or(Shared::from_static("")), instant: None }
}
