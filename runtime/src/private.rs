//! What generated code calls. Not part of the public interface: it changes with the compiler, and
//! the two are released together.

use crate::robustness::{NotANumber, Predicate, Predicates};
use crate::task::{Formula, Task};

/// A predicate as two closures: its robustness, and whether it holds.
#[derive(Clone, Copy)]
pub struct Closures<F, G>(pub F, pub G);

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

/// There is no predicate of this number.
#[cold]
pub fn no_predicate(i: usize) -> ! {
    panic!("there is no predicate {i}")
}

/// Stands in for the predicates of a formula that did not compile.
#[derive(Clone, Copy, Debug)]
pub struct Invalid;

impl<S: ?Sized> Predicates<S> for Invalid {
    fn robustness(&self, i: usize, _: &S) -> f64 {
        no_predicate(i)
    }

    fn holds(&self, i: usize, _: &S) -> Result<bool, NotANumber> {
        no_predicate(i)
    }

    fn with_scratch<R>(&self, f: impl FnOnce(&mut [f64], &mut [f64]) -> R) -> R {
        f(&mut [], &mut [])
    }
}

/// Stands in for a task that did not compile, so that one mistake is one message.
#[must_use]
pub const fn invalid() -> Task<Invalid> {
    use crate::automaton::{Automaton, Transitions};
    static FORMULA: Formula = Formula { text: "", ops: &[] };
    static AUTOMATON: Automaton = Automaton {
        propositions: &[],
        states: 1,
        accepting: None,
        trap: Some(0),
        transitions: Transitions::Table { class: &[0], width: 1, next: &[0] },
        edges: &[],
        progress: &[&[]],
        distance: &[u32::MAX],
    };
    Task::from_parts("", &FORMULA, &AUTOMATON, Invalid)
}

/// `a < b`.
#[inline]
pub fn less(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho > 0.0)
}

/// `a <= b`.
#[inline]
pub fn at_most(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho >= 0.0)
}

/// `a == b`.
#[inline]
pub fn equal(a: f64, b: f64) -> Result<bool, NotANumber> {
    number_or_error(b - a).map(|rho| rho == 0.0)
}

#[inline]
fn number_or_error(rho: f64) -> Result<f64, NotANumber> {
    if rho.is_nan() { Err(NotANumber) } else { Ok(rho) }
}

/// The lesser of two numbers; NaN if one of them is.
#[inline]
#[must_use]
pub fn min(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The greater of two numbers; NaN if one of them is.
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

/// A value that arithmetic in a predicate reads.
#[inline]
pub fn number(value: impl Number) -> f64 {
    value.to_f64()
}

/// Floating-point functions that `core` lacks.
#[diagnostic::on_unimplemented(
    message = "this function needs floating-point routines that `core` lacks",
    label = "turn on the feature `std` or `libm` of the crate `tltl`"
)]
pub trait Math {
    /// √x
    fn sqrt(x: f64) -> f64;
    /// √(x² + y²), without undue overflow
    fn hypot(x: f64, y: f64) -> f64;
    /// sin x, x in radians
    fn sin(x: f64) -> f64;
    /// cos x, x in radians
    fn cos(x: f64) -> f64;
    /// tan x, x in radians
    fn tan(x: f64) -> f64;
    /// The angle in [-π/2, π/2] whose sine is x
    fn asin(x: f64) -> f64;
    /// The angle in [0, π] whose cosine is x
    fn acos(x: f64) -> f64;
    /// The angle in [-π/2, π/2] whose tangent is x
    fn atan(x: f64) -> f64;
    /// The angle of the point (x, y), in radians
    fn atan2(y: f64, x: f64) -> f64;
    /// e^x
    fn exp(x: f64) -> f64;
    /// The natural logarithm
    fn ln(x: f64) -> f64;
    /// x^y
    fn pow(x: f64, y: f64) -> f64;
    /// The largest integer not above x
    fn floor(x: f64) -> f64;
    /// The smallest integer not below x
    fn ceil(x: f64) -> f64;
}

/// |x|, which needs no library.
#[inline]
#[must_use]
pub fn abs(x: f64) -> f64 {
    x.abs()
}

/// Stands for the library that has the functions of [`Math`].
#[derive(Clone, Copy, Debug)]
pub struct Library;

macro_rules! functions {
    ($($name:ident($($argument:ident),*))*) => {
        $(
            #[doc = concat!("[`Math::", stringify!($name), "`]")]
            #[inline]
            pub fn $name($($argument: f64),*) -> f64
            where
                Library: Math,
            {
                <Library as Math>::$name($($argument),*)
            }
        )*
    };
}

functions! {
    sqrt(x) hypot(x, y) sin(x) cos(x) tan(x) asin(x) acos(x) atan(x) atan2(y, x) exp(x) ln(x) pow(x, y) floor(x) ceil(x)
}

macro_rules! library {
    ($($name:ident($($argument:ident),*) = $function:path;)*) => {
        impl Math for Library {
            $(
                #[inline]
                fn $name($($argument: f64),*) -> f64 {
                    $function($($argument),*)
                }
            )*
        }
    };
}

#[cfg(feature = "std")]
library! {
    sqrt(x) = f64::sqrt;
    hypot(x, y) = f64::hypot;
    sin(x) = f64::sin;
    cos(x) = f64::cos;
    tan(x) = f64::tan;
    asin(x) = f64::asin;
    acos(x) = f64::acos;
    atan(x) = f64::atan;
    atan2(y, x) = f64::atan2;
    exp(x) = f64::exp;
    ln(x) = f64::ln;
    pow(x, y) = f64::powf;
    floor(x) = f64::floor;
    ceil(x) = f64::ceil;
}

#[cfg(all(feature = "libm", not(feature = "std")))]
library! {
    sqrt(x) = libm::sqrt;
    hypot(x, y) = libm::hypot;
    sin(x) = libm::sin;
    cos(x) = libm::cos;
    tan(x) = libm::tan;
    asin(x) = libm::asin;
    acos(x) = libm::acos;
    atan(x) = libm::atan;
    atan2(y, x) = libm::atan2;
    exp(x) = libm::exp;
    ln(x) = libm::log;
    pow(x, y) = libm::pow;
    floor(x) = libm::floor;
    ceil(x) = libm::ceil;
}
