//! Predicates over one state, and the robustness of guards and trajectories.
//!
//! The robustness ρ of a predicate is by how much it holds (positive) or fails (negative):
//! ρ(f < c) = c − f. Conjunction is `min`, disjunction `max`, negation the opposite. So ρ > 0 implies
//! that a formula holds and ρ < 0 that it does not. Where ρ is 0 the *Boolean* comparison decides
//! (`x <= 3` holds at 3, `x < 3` does not); the automaton always moves on Booleans.
//!
//! A value that is not a number (NaN) is an error of the caller. It is reported and never taken as
//! false, which is why a predicate answers with a `Result`.
//!
//! The robustness of a compiled task is straight-line code, made from the type of its formula, if that
//! has at most 32 operators and its bounds add up to at most 4,000 steps; [`trajectory`] interprets all
//! others.
//!
//! [`guard`], [`trajectory`] and [`best_run`] work on the robustness of propositions, wherever that
//! comes from; [`Task`](crate::Task) applies them to states.

#[doc(hidden)]
pub mod typed;
mod window;

use core::{fmt, mem};

use crate::automaton::{Automaton, Guard, proposition};
pub use crate::formula::Op;
use crate::shared::Shared;
pub use window::Window;

/// A predicate met a value that is not a number. The task knows which one, and adds its name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotANumber;

/// A predicate was not a number at some state.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// let task = tltl::tltl! { |x: &f64| F ({ *x } < 3) };
/// let error = task.satisfied(&[4.0, f64::NAN]).unwrap_err();
/// assert_eq!((&*error.predicate, error.instant), ("{*x} < 3", Some(1)));
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    /// The predicate, as its author named it.
    pub predicate: Shared<str>,
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

/// A predicate over states of type `S`.
///
/// Every `Fn(&S) -> f64` is one: the function is the robustness, and the predicate holds iff it is
/// positive. A Boolean function becomes one through [`Boolean`].
///
/// ```
/// use tltl::Predicate;
/// use tltl::robustness::NotANumber;
///
/// let near = |x: &f64| 2.0 - x.abs();
/// assert_eq!((near.robustness(&0.5), near.holds(&0.5)), (1.5, Ok(true)));
/// assert_eq!(near.holds(&f64::NAN), Err(NotANumber));
/// ```
pub trait Predicate<S: ?Sized> {
    /// By how much the predicate holds at `s`; NaN if `s` holds one.
    fn robustness(&self, s: &S) -> f64;

    /// Whether the predicate holds at `s`.
    ///
    /// # Errors
    /// [`NotANumber`] if the answer depends on a value that is not a number.
    #[inline]
    fn holds(&self, s: &S) -> Result<bool, NotANumber> {
        let rho = self.robustness(s);
        if rho.is_nan() { Err(NotANumber) } else { Ok(rho > 0.0) }
    }
}

impl<S: ?Sized, F: Fn(&S) -> R, R: Robustness> Predicate<S> for F {
    #[inline]
    fn robustness(&self, s: &S) -> f64 {
        self(s).value()
    }
}

/// What a function gives that is a predicate: an `f64`, and nothing else. It is a trait so that rustc
/// says what to do with a function that gives a `bool`.
#[diagnostic::on_unimplemented(
    message = "a predicate gives its robustness as an `f64`, and this function gives `{Self}`",
    label = "read by a function that gives `{Self}`",
    note = "a function that gives a `bool` becomes a predicate by `tltl::Boolean::new(function)`"
)]
pub trait Robustness: sealed::Sealed {
    #[doc(hidden)]
    fn value(self) -> f64;
}

impl Robustness for f64 {
    #[inline]
    fn value(self) -> f64 {
        self
    }
}

mod sealed {
    pub trait Sealed {}
    impl Sealed for f64 {}
}

/// A Boolean function as a predicate: its robustness is `scale` where it is true, `-scale` where it
/// is false.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Boolean, tltl};
///
/// struct Robot { x: f64, holding: bool }
/// let holding = Boolean::new(|s: &Robot| s.holding);
/// let there = |s: &Robot| s.x - 3.0;
/// let task = tltl! { holding T there };
/// let walk = [Robot { x: 0.0, holding: true }, Robot { x: 3.5, holding: true }];
/// assert_eq!(task.robustness(&walk), Ok(0.5));
/// # }
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Boolean<F> {
    function: F,
    scale: f64,
}

impl<F> Boolean<F> {
    /// The predicate of `function`, with robustness ±1.
    pub const fn new(function: F) -> Self {
        Self { function, scale: 1.0 }
    }

    /// The same predicate with robustness `±scale`. In a minimum with other predicates the least
    /// one counts: a scale larger than theirs leaves the robustness to them, a smaller one caps it.
    ///
    /// # Panics
    /// If `scale` is not a positive number.
    ///
    /// ```
    /// use tltl::{Boolean, Predicate};
    ///
    /// const HOLDING: Boolean<fn(&bool) -> bool> = Boolean::new(|s: &bool| *s);
    /// assert_eq!(HOLDING.scaled(0.1).robustness(&false), -0.1);
    /// ```
    #[must_use]
    pub const fn scaled(self, scale: f64) -> Self
    where
        F: Copy,
    {
        assert!(scale > 0.0, "the scale of a Boolean predicate is a positive number");
        Self { function: self.function, scale }
    }
}

impl<S: ?Sized, F: Fn(&S) -> bool> Predicate<S> for Boolean<F> {
    #[inline]
    fn robustness(&self, s: &S) -> f64 {
        if (self.function)(s) { self.scale } else { -self.scale }
    }

    #[inline]
    fn holds(&self, s: &S) -> Result<bool, NotANumber> {
        Ok((self.function)(s))
    }
}

/// The predicates of a task, numbered like its propositions. Generated code implements it.
///
/// ```
/// use tltl::robustness::{NotANumber, Predicates};
///
/// /// Two sensors; predicate `i` is "sensor `i` is above 0.5".
/// struct Above;
///
/// impl Predicates<[f64; 2]> for Above {
///     fn robustness(&self, i: usize, s: &[f64; 2]) -> f64 {
///         s[i] - 0.5
///     }
///     fn holds(&self, i: usize, s: &[f64; 2]) -> Result<bool, NotANumber> {
///         let rho = self.robustness(i, s);
///         if rho.is_nan() { Err(NotANumber) } else { Ok(rho > 0.0) }
///     }
/// }
/// assert_eq!(Above.holds(1, &[0.0, 0.75]), Ok(true));
/// ```
pub trait Predicates<S: ?Sized> {
    /// The number of predicates, if it is known and the automata they were generated with are tables:
    /// then a step reads all of them.
    #[doc(hidden)]
    const DENSE: usize = 0;

    /// Whether they are known to compare floats and nothing else.
    #[doc(hidden)]
    #[inline]
    fn floats() -> bool {
        false
    }

    /// Robustness of predicate `i` at `s`; NaN if `s` holds one, and of generated predicates also if
    /// there is no `i`: with a panic instead, every step of a diagram could panic.
    fn robustness(&self, i: usize, s: &S) -> f64;

    /// Whether predicate `i` holds at `s`.
    ///
    /// # Errors
    /// [`NotANumber`] if the answer depends on a value that is not a number, or if generated predicates
    /// have no `i`.
    fn holds(&self, i: usize, s: &S) -> Result<bool, NotANumber>;

    /// The robustness of the formula that these predicates were generated with, where its
    /// [type](typed) is known: of a whole trajectory, and where `signal` has a place for each instant,
    /// from each on. NaN if a predicate is.
    #[doc(hidden)]
    #[inline]
    fn straight(&self, trajectory: &[S], signal: &mut [f64]) -> Option<f64>
    where
        S: Sized,
    {
        let _ = (trajectory, signal);
        None
    }

    /// Calls `f` with two buffers, the first of at least `cells` numbers, the second with one for
    /// each operator of the formula or state of the automaton. Generated code that has no straight
    /// line knows the numbers and gives two arrays, so that robustness allocates nothing.
    #[doc(hidden)]
    fn with_scratch<R>(&self, cells: usize, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        #[cfg(feature = "alloc")]
        return f(&mut alloc::vec![0.0; cells], &mut alloc::vec![0.0; cells]);
        #[cfg(not(feature = "alloc"))]
        {
            let _ = cells;
            f(&mut [], &mut [])
        }
    }
}

impl<S: ?Sized, P: Predicates<S>> Predicates<S> for &P {
    const DENSE: usize = P::DENSE;

    #[inline]
    fn floats() -> bool {
        P::floats()
    }

    #[inline]
    fn robustness(&self, i: usize, s: &S) -> f64 {
        (**self).robustness(i, s)
    }

    #[inline]
    fn holds(&self, i: usize, s: &S) -> Result<bool, NotANumber> {
        (**self).holds(i, s)
    }

    #[inline]
    fn straight(&self, trajectory: &[S], signal: &mut [f64]) -> Option<f64>
    where
        S: Sized,
    {
        (**self).straight(trajectory, signal)
    }

    fn with_scratch<R>(&self, cells: usize, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        (**self).with_scratch(cells, f)
    }
}

/// The valuation of all predicates at `s`, where there are [so many](Predicates::DENSE): bit i is
/// predicate i. After it, whether one of them is not a number.
///
/// Each number is written out, so that each predicate is inlined, and errors are looked at together:
/// a branch for each costs more than the comparison.
#[inline(always)]
pub(crate) fn letter<S: ?Sized, P: Predicates<S>>(predicates: &P, s: &S) -> (usize, bool) {
    let (mut letter, mut is_nan) = (0, false);
    macro_rules! each {
        ($($i:literal)*) => {$(
            if $i < P::DENSE {
                let holds = predicates.holds($i, s);
                // What is not a number counts as true: "greater or unordered" is one comparison.
                letter |= usize::from(holds.unwrap_or(true)) << $i;
                is_nan |= holds.is_err();
            }
        )*};
    }
    each! { 0 1 2 3 4 5 6 7 8 9 }
    (letter, is_nan)
}

/// The same for one state, where predicates that compare floats become sums of powers of two. On x86-64
/// the truth of such a comparison comes into an integer register through the flags, which takes more
/// than two cycles each. But it masks a float where it is, and two floats are compared at once; so one
/// number is brought over in place of one for each predicate: of two and eight predicates a step takes
/// 1.36 and 3.7 ns, and 1.5 and 5.7 by flags. Integers and truth values do not mask floats.
#[inline(always)]
pub(crate) fn one_letter<S: ?Sized, P: Predicates<S>>(predicates: &P, s: &S) -> (usize, bool) {
    if !cfg!(target_arch = "x86_64") || !P::floats() {
        return letter(predicates, s);
    }
    const NAN: u32 = 1 << 10;
    let (mut sums, mut is_nan) = ([0.0; 2], [false; 5]);
    macro_rules! each {
        ($($i:literal)*) => {$(
            if $i < P::DENSE {
                let holds = predicates.holds($i, s);
                sums[$i % 2] += if holds.unwrap_or(true) { (1 << $i) as f64 } else { 0.0 };
                is_nan[$i / 2] |= holds.is_err();
            }
        )*};
    }
    each! { 0 1 2 3 4 5 6 7 8 9 }
    if P::DENSE > 2 {
        for (pair, &is_nan) in is_nan.iter().enumerate() {
            if 2 * pair < P::DENSE {
                sums[pair % 2] += if is_nan { f64::from(NAN) } else { 0.0 };
            }
        }
    }
    // Above 2^52 the last bits of a number are those of a whole number.
    let sum = (sums[0] + sums[1] + (1_u64 << 52) as f64).to_bits() as u32;
    (sum as usize & ((1 << P::DENSE) - 1), if P::DENSE > 2 { sum >= NAN } else { is_nan[0] })
}

/// The first of [so many](Predicates::DENSE) predicates that is not a number at `s`; each number is
/// written out here too, so that no predicate is asked for that there is not.
#[cold]
#[inline(never)]
pub(crate) fn unreadable<S: ?Sized, P: Predicates<S>>(predicates: &P, s: &S) -> usize {
    macro_rules! each {
        ($($i:literal)*) => {$(
            if $i < P::DENSE && predicates.holds($i, s).is_err() {
                return $i;
            }
        )*};
    }
    each! { 0 1 2 3 4 5 6 7 8 9 }
    0
}

/// Robustness of a guard: max over its cubes, min over their literals, where `rho` gives the
/// robustness of each proposition. A guard without cubes is -∞, a cube without literals +∞.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::robustness;
///
/// let task = tltl::tltl! { |s: &[f64; 2]| F (s[0] > 0 && s[1] < 4) };
/// let progress = task.automaton().progress(0);
/// assert_eq!(robustness::guard(progress, |i| [0.5, 3.0][i]), 0.5);
/// # }
/// ```
#[inline]
pub fn guard(guard: Guard<'_>, mut rho: impl FnMut(usize) -> f64) -> f64 {
    let (mut best, mut least) = (f64::NEG_INFINITY, f64::INFINITY);
    for &literal in guard.literals {
        if literal == 0 {
            best = max(best, least);
            least = f64::INFINITY;
        } else {
            let value = rho(proposition(literal));
            least = min(least, if literal > 0 { value } else { -value });
        }
    }
    best
}

/// Robustness of progress of a conjunction, (D₁ ∧ ¬τ₂) ∨ (D₂ ∧ ¬τ₁) for two operands: one moves on
/// and none of the others is lost. `losing` gives ρ(s, τ_i), `progress` ρ(s, D_i) of each operand.
///
/// What all operands but one leave is the least of all −ρ(s, τ_j), or the second least for the
/// operand that has the least: two passes, not one for each operand.
///
/// ```
/// use tltl::robustness::progress_of_all;
///
/// // The first operand moves on by 3, but by then the second one is lost by 1.
/// let (losing, progress) = ([-4.0, 1.0], [3.0, -2.0]);
/// let rho = progress_of_all(losing.map(Ok::<_, ()>).into_iter(), progress.map(Ok).into_iter());
/// assert_eq!(rho, Ok(-1.0));
/// ```
///
/// # Errors
/// The first error of the operands.
pub fn progress_of_all<E>(
    losing: impl Iterator<Item = Result<f64, E>>,
    progress: impl Iterator<Item = Result<f64, E>>,
) -> Result<f64, E> {
    let (mut first, mut second) = ((f64::INFINITY, usize::MAX), f64::INFINITY);
    for (i, losing) in losing.enumerate() {
        let safe = -losing?;
        if safe < first.0 {
            (first, second) = ((safe, i), first.0);
        } else {
            second = min(safe, second);
        }
    }
    let mut best = f64::NEG_INFINITY;
    for (i, progress) in progress.enumerate() {
        let others = if i == first.1 { second } else { first.0 };
        best = max(best, min(progress?, others));
    }
    Ok(best)
}

/// Robustness of a formula, the last of `operators`, on a whole trajectory of `length` states, where
/// `rho(i, t)` is the robustness of proposition `i` at instant `t`. An empty trajectory or formula
/// gives -∞.
///
/// One backward pass: every temporal operator is a recursion on its value at the next instant
/// (ρ(◇φ, t) = max(ρ(φ, t), ρ(◇φ, t + 1))), so two columns of values are enough, with a cell for each
/// operator. Operators with a bound have a [`Window`] of cells each, after the values in `now`;
/// [`cells`] is the length that `now` needs. O(length × operators) time, whatever the bounds; no
/// allocation.
///
/// # Errors
/// The first error of `rho`.
///
/// # Panics
/// If `now` or `next` is too short, or an operand is not an earlier operator.
///
/// ```
/// use core::convert::Infallible;
/// use tltl::robustness::{Op, cells, trajectory};
///
/// // F (a && b), where a is −1, 2, 1 and b is 3, 0.5, −2.
/// let formula = [Op::Is(0), Op::Is(1), Op::And(0, 1), Op::Eventually(2)];
/// let values = [[-1.0, 2.0, 1.0], [3.0, 0.5, -2.0]];
/// let rho = |i: usize, t: usize| Ok::<f64, Infallible>(values[i][t]);
/// let (mut now, mut next) = ([0.0; 4], [0.0; 4]);
/// assert_eq!(trajectory(&formula, 3, &mut now, &mut next, rho), Ok(0.5));
///
/// // F[0,1] b: the last instant does not count.
/// let formula = [Op::Is(1), Op::Within(1, 0)];
/// assert_eq!(cells(&formula, 3), 5);
/// let (mut now, mut next) = ([0.0; 5], [0.0; 2]);
/// assert_eq!(trajectory(&formula, 3, &mut now, &mut next, rho), Ok(3.0));
/// ```
pub fn trajectory<E>(
    operators: &[Op],
    length: usize,
    now: &mut [f64],
    next: &mut [f64],
    rho: impl FnMut(usize, usize) -> Result<f64, E>,
) -> Result<f64, E> {
    signal(operators, length, now, next, &mut [], rho)
}

/// The same, and where `signal` has a place for each instant, the robustness from each on.
pub(crate) fn signal<E>(
    operators: &[Op],
    length: usize,
    now: &mut [f64],
    next: &mut [f64],
    signal: &mut [f64],
    mut rho: impl FnMut(usize, usize) -> Result<f64, E>,
) -> Result<f64, E> {
    now.fill(f64::NEG_INFINITY);
    let (now, windows) = now.split_at_mut(operators.len());
    let next = &mut next[..operators.len()];
    next.fill(f64::NEG_INFINITY);
    for t in (0..length).rev() {
        let mut windows = &mut *windows;
        let mut push = |window: Window, value| {
            let (cells, others) = mem::take(&mut windows).split_at_mut(window.cells(length));
            windows = others;
            window.push(cells, length - 1 - t, value)
        };
        for (k, op) in operators.iter().enumerate() {
            now[k] = match *op {
                Op::True => f64::INFINITY,
                Op::False => f64::NEG_INFINITY,
                Op::Is(i) => rho(i as usize, t)?,
                Op::Not(i) => -rho(i as usize, t)?,
                Op::And(a, b) => min(now[a as usize], now[b as usize]),
                Op::Or(a, b) => max(now[a as usize], now[b as usize]),
                Op::Next(a) => next[a as usize],
                Op::Eventually(a) => max(now[a as usize], next[k]),
                Op::Until(a, b) => max(now[b as usize], min(now[a as usize], next[k])),
                Op::Then(a, b) => max(min(now[a as usize], next[b as usize]), next[k]),
                Op::Delay(n, a) => push(Window::Later(n), now[a as usize]),
                Op::Within(n, a) => push(Window::Greatest(n), now[a as usize]),
                Op::Throughout(n, a) => push(Window::Least(n), now[a as usize]),
            };
        }
        next.copy_from_slice(now);
        if let (Some(signal), Some(whole)) = (signal.get_mut(t), now.last()) {
            *signal = *whole;
        }
    }
    Ok(now.last().copied().unwrap_or(f64::NEG_INFINITY))
}

/// The number of cells that the robustness of a formula needs on a trajectory of so many states: one
/// for each operator, and those of the windows.
///
/// ```
/// use tltl::robustness::{Op, cells};
///
/// let formula = [Op::Is(0), Op::Throughout(1000, 0)];
/// // A window is never longer than the trajectory.
/// assert_eq!((cells(&formula, 10), cells(&formula, 100_000)), (14, 1004));
/// ```
#[must_use]
pub fn cells(operators: &[Op], length: usize) -> usize {
    let windows = operators.iter().map(|op| match *op {
        Op::Delay(n, _) => Window::Later(n).cells(length),
        Op::Within(n, _) => Window::Greatest(n).cells(length),
        Op::Throughout(n, _) => Window::Least(n).cells(length),
        _ => 0,
    });
    windows.fold(operators.len(), usize::saturating_add)
}

/// Robustness of a whole trajectory of `length` states by an automaton that came without a formula:
/// max over the runs into the accepting state, min over the guards on the way. An empty trajectory
/// gives -∞.
///
/// It is positive only for trajectories that are accepted and negative only for others, as that of a
/// formula is, but its size is another one: a run also has to satisfy the guards of waiting. With a
/// formula at hand, [`trajectory`] is the better measure.
///
/// One forward pass, O(length × literals) time; `now` and `next` are scratch space with a cell for
/// each state.
///
/// # Errors
/// The first error of `rho`.
///
/// # Panics
/// If the scratch slices differ in length or are too short.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use core::convert::Infallible;
/// use tltl::robustness::best_run;
///
/// let task = tltl::tltl! { |s: &[f64; 1]| F (s[0] > 0) };
/// let rho = |_: usize, t: usize| Ok::<f64, Infallible>([-3.0, 2.0][t]);
/// // Wait at −3, with 3 to spare, then accept with 2.
/// assert_eq!(best_run(task.automaton(), 2, &mut [0.0; 2], &mut [0.0; 2], rho), Ok(2.0));
/// # }
/// ```
pub fn best_run<E>(
    automaton: &Automaton,
    length: usize,
    now: &mut [f64],
    next: &mut [f64],
    mut rho: impl FnMut(usize, usize) -> Result<f64, E>,
) -> Result<f64, E> {
    now.fill(f64::NEG_INFINITY);
    now[Automaton::INITIAL as usize] = f64::INFINITY;
    for t in 0..length {
        advance_runs(automaton, now, next, |i| rho(i, t))?;
        now.copy_from_slice(next);
    }
    let accepting = automaton.accepting().filter(|_| length > 0);
    Ok(accepting.map_or(f64::NEG_INFINITY, |q| now[q as usize]))
}

/// [`best_run`] from each instant on, in one backward pass: `now` and `next` have for each state of the
/// automaton the robustness of the best run from there into the accepting state.
pub(crate) fn best_runs<E>(
    automaton: &Automaton,
    now: &mut [f64],
    next: &mut [f64],
    signal: &mut [f64],
    mut rho: impl FnMut(usize, usize) -> Result<f64, E>,
) -> Result<(), E> {
    next.fill(f64::NEG_INFINITY);
    if let Some(accepting) = automaton.accepting() {
        next[accepting as usize] = f64::INFINITY;
    }
    for (t, signal) in signal.iter_mut().enumerate().rev() {
        now.fill(f64::NEG_INFINITY);
        for edge in automaton.edges() {
            let taken = try_guard(edge.guard, |i| rho(i, t))?;
            let from = &mut now[edge.from as usize];
            *from = max(*from, min(next[edge.to as usize], taken));
        }
        next.copy_from_slice(now);
        *signal = now[Automaton::INITIAL as usize];
    }
    Ok(())
}

/// Robustness of a guard whose propositions may have none.
fn try_guard<E>(of: Guard<'_>, mut rho: impl FnMut(usize) -> Result<f64, E>) -> Result<f64, E> {
    let mut error = None;
    let taken = guard(of, |i| {
        rho(i).unwrap_or_else(|e| {
            error = Some(e);
            f64::NEG_INFINITY
        })
    });
    error.map_or(Ok(taken), Err)
}

/// One state of [`best_run`]: `now` has the robustness of the best run into each automaton state,
/// and `next` gets that after one more state of the world, in which proposition `i` has robustness
/// `rho(i)`. Before the first, it is ∞ in the initial state and -∞ elsewhere.
///
/// # Errors
/// The first error of `rho`; `next` is then not to be used.
///
/// # Panics
/// If a slice has no entry for a state.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use core::convert::Infallible;
/// use tltl::robustness::advance_runs;
///
/// let task = tltl::tltl! { |s: &[f64; 1]| F (s[0] > 0) };
/// let (before, mut after) = ([f64::INFINITY, f64::NEG_INFINITY], [0.0; 2]);
/// let rho = |_: usize| Ok::<f64, Infallible>(2.0);
/// assert_eq!(advance_runs(task.automaton(), &before, &mut after, rho), Ok(()));
/// assert_eq!(after, [-2.0, 2.0]);
/// # }
/// ```
pub fn advance_runs<E>(
    automaton: &Automaton,
    now: &[f64],
    next: &mut [f64],
    mut rho: impl FnMut(usize) -> Result<f64, E>,
) -> Result<(), E> {
    next.fill(f64::NEG_INFINITY);
    for edge in automaton.edges() {
        let taken = try_guard(edge.guard, &mut rho)?;
        let to = &mut next[edge.to as usize];
        *to = max(*to, min(now[edge.from as usize], taken));
    }
    Ok(())
}

// Not `f64::max` and `f64::min`, which cost 2.2 to 2.9 times as much in these loops: their rule for
// NaN is not needed, because a NaN is an error before it gets here, or is reported after the loop.

#[inline]
fn max(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline]
fn min(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}
