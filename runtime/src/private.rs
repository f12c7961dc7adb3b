//! What generated code calls. Not part of the public interface: it changes with the compiler, and
//! the two are released together.
//!
//! The compiler writes a predicate as a Rust expression over the author's own fields. What the
//! expression needs beyond Rust's operators is here: comparisons that report a NaN, `min` and `max`
//! that keep one, numbers of every type as `f64`, and functions that `core` lacks. All of it is
//! inlined, so that a predicate costs what the author would have written by hand.

use core::fmt;

use crate::automaton::{Automaton, Tables, Transitions};
use crate::formula::EMPTY;
use crate::robustness::{NotANumber, Predicate, Predicates};
use crate::shared::Shared;
use crate::task::Task;

/// A predicate as two closures: its robustness, and whether it holds. They are two because at
/// robustness 0 the comparison decides, which the number alone does not tell.
#[derive(Clone, Copy)]
pub struct Closures<F, G>(pub F, pub G);

impl<F, G> fmt::Debug for Closures<F, G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Closures")
    }
}

impl<S: ?Sized, F, G> Predicate<S> for Closures<F, G>
where
    F: Fn(&S) -> f64,
    G: Fn(&S) -> Result<bool, NotANumber>,
{
    #[inline]
    fn robustness(&self, s: &S) -> f64 {
        (self.0)(s)
    }

    #[inline]
    fn holds(&self, s: &S) -> Result<bool, NotANumber> {
        (self.1)(s)
    }
}

/// Calls `f` with two buffers that are too large for the stack: from the heap, of the `cells` that a
/// trajectory needs at most, if there is a heap.
#[cfg(feature = "alloc")]
pub fn large_scratch<const NOW: usize, const NEXT: usize, R>(
    cells: usize,
    f: impl FnOnce(&mut [f64], &mut [f64]) -> R,
) -> R {
    f(&mut alloc::vec![0.0; cells], &mut alloc::vec![0.0; NEXT])
}

/// Calls `f` with two buffers of the sizes that any trajectory needs at most.
#[cfg(not(feature = "alloc"))]
pub fn large_scratch<const NOW: usize, const NEXT: usize, R>(
    _: usize,
    f: impl FnOnce(&mut [f64], &mut [f64]) -> R,
) -> R {
    f(&mut [0.0; NOW], &mut [0.0; NEXT])
}

/// Stands in for the predicates of a formula that did not compile. It is a predicate of all states, so
/// that the code around the macro has no further error.
#[derive(Clone, Copy, Debug)]
pub struct Invalid;

impl<S: ?Sized> Predicates<S> for Invalid {
    fn robustness(&self, _: usize, _: &S) -> f64 {
        f64::NAN
    }

    fn holds(&self, _: usize, _: &S) -> Result<bool, NotANumber> {
        Err(NotANumber)
    }

    fn with_scratch<R>(&self, _: usize, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        f(&mut [], &mut [])
    }
}

/// Stands in for a task that did not compile, so that one mistake is one message. It is lost from the
/// start; no program that holds it compiles.
#[must_use]
pub const fn invalid() -> Task<Invalid> {
    static AUTOMATON: Automaton = Automaton::trusted(Tables {
        propositions: Shared::from_static(&[]),
        states: 1,
        accepting: None,
        trap: Some(0),
        transitions: Transitions::Table {
            class: Shared::from_static(&[0]),
            width: 1,
            next: Shared::from_static(&[0]),
        },
        edges: Shared::from_static(&[0, 1]),
        targets: Shared::from_static(&[0]),
        guards: Shared::from_static(&[0, 0, 1]),
        literals: Shared::from_static(&[0]),
        distance: Shared::from_static(&[u32::MAX]),
    });
    Task::trusted(
        Shared::from_static(""),
        Shared::from_static(&EMPTY),
        Shared::from_static(&AUTOMATON),
        Invalid,
    )
}

/// `a < b`, as the robustness `b - a` has it: the same rounding decides both, so ρ > 0 and truth
/// cannot disagree.
///
/// # Errors
/// If one of the two is not a number, or both are the same infinity.
#[inline]
pub fn less(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho > 0.0)
}

/// `a <= b`, as the robustness `b - a` has it.
///
/// # Errors
/// As [`less`].
#[inline]
pub fn at_most(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho >= 0.0)
}

/// `a == b`, as the robustness `-|a - b|` has it.
///
/// # Errors
/// As [`less`].
#[inline]
pub fn equal(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho == 0.0)
}

/// The same comparisons where one side is a finite number. The difference then has the sign that the
/// comparison says, for it is not rounded to 0, and is a number if the other side is. So nothing is
/// subtracted: a step of two predicates saves a quarter of its instructions.
#[expect(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "\"not at most\" is one comparison also where what is not a number counts as true"
)]
pub mod finite {
    use super::NotANumber;

    /// `a < b`.
    ///
    /// # Errors
    /// If one of the two is not a number.
    #[inline]
    pub fn less(a: f64, b: f64) -> Result<bool, NotANumber> {
        if a.is_nan() | b.is_nan() { Err(NotANumber) } else { Ok(!(b <= a)) }
    }

    /// `a <= b`.
    ///
    /// # Errors
    /// As [`less`].
    #[inline]
    pub fn at_most(a: f64, b: f64) -> Result<bool, NotANumber> {
        if a.is_nan() | b.is_nan() { Err(NotANumber) } else { Ok(!(b < a)) }
    }

    /// `a == b`.
    ///
    /// # Errors
    /// As [`less`].
    #[inline]
    pub fn equal(a: f64, b: f64) -> Result<bool, NotANumber> {
        if a.is_nan() | b.is_nan() { Err(NotANumber) } else { Ok(a == b) }
    }
}

#[inline]
fn number_or_error(rho: f64) -> Result<f64, NotANumber> {
    if rho.is_nan() { Err(NotANumber) } else { Ok(rho) }
}

/// The lesser of two numbers; NaN if one of them is, unlike `f64::min`, which would hide a mistake in
/// the state behind the other operand.
#[inline]
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The greater of two numbers; NaN if one of them is, unlike `f64::max`.
#[inline]
#[must_use]
pub fn max(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// The robustness of a Boolean: ±1.
#[inline]
#[must_use]
pub fn truth(value: bool) -> f64 {
    if value { 1.0 } else { -1.0 }
}

/// Types that arithmetic in a predicate may read.
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not a number that a predicate can compare",
    label = "a comparison reads `f64`, `f32` or an integer"
)]
pub trait Number: Copy {
    /// The value as a real number; integers beyond 2^53 are rounded.
    fn to_f64(self) -> f64;
}

macro_rules! numbers {
    ($($number:ty)*) => {$(
        impl Number for $number {
            #[inline]
            fn to_f64(self) -> f64 {
                self as f64
            }
        }
        impl Number for &$number {
            #[inline]
            fn to_f64(self) -> f64 {
                *self as f64
            }
        }
    )*};
}

numbers! { f64 f32 i8 i16 i32 i64 i128 isize u8 u16 u32 u64 u128 usize }

/// A value that arithmetic in a predicate reads, as a real number.
#[inline]
pub fn number(value: impl Number) -> f64 {
    value.to_f64()
}

/// Whether a place of the state is a float. It is asked by name, for which a type needs no bound: a
/// bound would be one more error at a place that is no number. rustc folds the comparison.
#[inline]
pub fn is_float<S: ?Sized, T>(_: fn(&S) -> T) -> bool {
    matches!(core::any::type_name::<T>(), "f64" | "f32")
}

/// |x|, the one of these functions that `core` has.
#[inline]
#[must_use]
pub fn abs(x: f64) -> f64 {
    x.abs()
}

/// Floating-point functions that `core` lacks; `f64` has them if the feature `std` or `libm` is on.
/// A bound by this trait turns their absence into an error at the author's call, with what to do.
#[diagnostic::on_unimplemented(
    message = "this function needs floating-point routines that `core` lacks",
    label = "turn on the feature `std` or `libm` of the crate `tltl`"
)]
pub trait Math {}

#[cfg(any(feature = "std", feature = "libm"))]
impl Math for f64 {}

macro_rules! functions {
    ($($name:ident($x:ident $(, $y:ident)?) = $std:path, $libm:path;)*) => {$(
        #[doc = concat!("The function `", stringify!($name), "`; angles are in radians.")]
        #[inline]
        pub fn $name<X: Math + Into<f64>>($x: X $(, $y: f64)?) -> f64 {
            let $x: f64 = $x.into();
            #[cfg(feature = "std")]
            return $std($x $(, $y)?);
            #[cfg(all(feature = "libm", not(feature = "std")))]
            return $libm($x $(, $y)?);
            // Nothing is `Math` here, so nothing calls this.
            #[cfg(not(any(feature = "std", feature = "libm")))]
            return $x $(+ $y)?;
        }
    )*};
}

functions! {
    sqrt(x) = f64::sqrt, libm::sqrt;
    hypot(x, y) = f64::hypot, libm::hypot;
    sin(x) = f64::sin, libm::sin;
    cos(x) = f64::cos, libm::cos;
    tan(x) = f64::tan, libm::tan;
    asin(x) = f64::asin, libm::asin;
    acos(x) = f64::acos, libm::acos;
    atan(x) = f64::atan, libm::atan;
    atan2(y, x) = f64::atan2, libm::atan2;
    exp(x) = f64::exp, libm::exp;
    ln(x) = f64::ln, libm::log;
    pow(x, y) = f64::powf, libm::pow;
    floor(x) = f64::floor, libm::floor;
    ceil(x) = f64::ceil, libm::ceil;
}
