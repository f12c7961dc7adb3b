//! Robustness and verdict while a trajectory grows.

use core::array;
use core::fmt;

use super::{Error, Run, Task, not_a_number};
use crate::robustness::Predicates;
use crate::robustness::typed::forward::{Forward, Once};
use crate::robustness::typed::{BLOCK, Block, Typed};

/// The robustness of a trajectory so far, and what it can still become.
///
/// `upper` is exact if every literal of later states may have any value: what arithmetic or the world
/// forbid is not known here. It never rises, and `lower` never falls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval {
    /// The robustness so far, ρ(s_{0:t}, φ); -∞ before the first state.
    pub lower: f64,
    /// The greatest robustness of any trajectory that goes on from here.
    pub upper: f64,
}

/// Follows one trajectory of a task: one state at a time, in constant memory and without allocation.
///
/// A state costs its predicates and one constant for each operator of the formula, on average,
/// whatever the length of the trajectory and the bounds.
///
/// ```
/// use tltl::task::Interval;
/// use tltl::tltl;
///
/// struct Robot { x: f64, water: f64 }
/// // Come within 1 m of home, never into the water before that.
/// let task = tltl! { |s: &Robot| s.water < 0.5 U s.x < 1 };
/// let mut online = task.online();
/// // Of 0.25 m to the water only that much can remain, however near it comes to home.
/// let after = online.step(&Robot { x: 5.0, water: 0.25 })?;
/// assert_eq!((after, online.verdict()), (Interval { lower: -4.0, upper: 0.25 }, None));
/// let after = online.step(&Robot { x: 0.5, water: 0.0 })?;
/// assert_eq!((after.lower, online.verdict()), (0.25, Some(true)));
/// # Ok::<(), tltl::task::Error>(())
/// ```
///
/// Not every formula can be followed so: below `F`, `U`, `T` and bounds, one side of a conjunction must
/// be a state formula, and so must the left side of `U` and `T` and the operand of a bounded `G`. rustc
/// refuses the others, and formulas of more than 32 operators or 4,000 steps of bounds together:
///
/// ```compile_fail
/// use tltl::tltl;
///
/// // Both goals from one and the same instant on.
/// let task = tltl! { |s: &[f64; 3]| F (s[0] > 0 && F s[1] > 0 && F s[2] > 0) };
/// let online = task.online();
/// ```
pub struct Online<'a, P: Typed>
where
    P::Formula: Forward<Once>,
{
    run: Run<'a, P>,
    kept: <P::Formula as Forward<Once>>::Kept,
    steps: usize,
    interval: Interval,
}

/// Where it stands.
impl<P: Typed> fmt::Debug for Online<'_, P>
where
    P::Formula: Forward<Once>,
{
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Online")
            .field("run", &self.run)
            .field("interval", &self.interval)
            .finish_non_exhaustive()
    }
}

impl<P> Task<P> {
    /// A monitor of one trajectory, before its first state.
    ///
    /// # Panics
    /// If the task was put together of predicates and another formula, by [`Task::new`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn online(&self) -> Online<'_, P>
    where
        P: Typed,
        P::Formula: Forward<Once>,
    {
        Online {
            run: self.run(),
            kept: P::Formula::NEW,
            steps: 0,
            interval: Interval { lower: f64::NEG_INFINITY, upper: f64::INFINITY },
        }
    }
}

impl<P: Typed> Online<'_, P>
where
    P::Formula: Forward<Once>,
{
    /// Reads the next state.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant. The monitor stays as it was.
    // Inlined, so that what is kept stays in registers: half the time of a call.
    #[inline(always)]
    pub fn step<S>(&mut self, s: &S) -> Result<Interval, Error>
    where
        P: Predicates<S>,
    {
        let (at, task) = (self.steps, self.run.task);
        let next = match self.run.next(s) {
            Ok(next) => next,
            Err(error) => return Err(at_instant(error, at)),
        };
        if P::DENSE == 0 {
            // The automaton has not looked at all predicates.
            for i in 0..task.automaton.propositions().len() {
                if task.predicates.robustness(i, s).is_nan() {
                    return Err(at_instant(not_a_number(&task.automaton, i), at));
                }
            }
        }
        let (rows, predicates) = (array::from_ref(s), &task.predicates);
        let (first, length, mut is_nan) = (at, at + 1, [0; BLOCK]);
        let mut row = Block { first, length, rows, predicates, is_nan: &mut is_nan };
        let (now, never) =
            (if at == 0 { f64::INFINITY } else { f64::NEG_INFINITY }, f64::NEG_INFINITY);
        let [lower, upper] = P::Formula::step(&mut self.kept, now, never, &mut row);
        self.run.set(next);
        (self.steps, self.interval) = (length, Interval { lower, upper });
        Ok(self.interval)
    }

    /// Whether the task is satisfied (`true`) or lost (`false`), as soon as it is decided; `None`
    /// while it can still go either way.
    ///
    /// It is that of the automaton, so also right where the robustness is 0.
    #[must_use]
    #[inline]
    pub fn verdict(&self) -> Option<bool> {
        self.run.verdict()
    }

    /// The robustness so far, and what it can still become.
    #[must_use]
    #[inline]
    pub fn interval(&self) -> Interval {
        self.interval
    }

    /// The state of the automaton.
    #[must_use]
    #[inline]
    pub fn state(&self) -> u32 {
        self.run.state()
    }
}

#[cold]
#[inline]
fn at_instant(error: Error, instant: usize) -> Error {
    Error { instant: Some(instant), ..error }
}
