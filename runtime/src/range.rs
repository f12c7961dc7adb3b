//! Ranges of settings, checked where a setting is made, so that a value of a settings type is valid.
//!
//! [`OutOfRange`] is the one error of all settings: those of rewards, learners, schedules and
//! estimates. Nothing that takes settings checks them again, and none of it panics on one.

use core::fmt;

/// A setting is outside of its range, or is not a number.
///
/// ```
/// use tltl::reward::Rewards;
///
/// let error = Rewards::progress().with_gamma(1.0).unwrap_err();
/// assert_eq!(error.to_string(), "`gamma` is 1, not in [0, 1)");
/// assert_eq!((error.field(), error.value()), ("gamma", 1.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OutOfRange {
    field: &'static str,
    value: f64,
    range: &'static str,
}

impl OutOfRange {
    /// The name of the setting, as its methods and saved documents have it.
    #[must_use]
    pub const fn field(&self) -> &'static str {
        self.field
    }

    /// The value that was refused; of a schedule, the first of its numbers that is out of range.
    #[must_use]
    pub const fn value(&self) -> f64 {
        self.value
    }

    /// The values that are allowed, in words: `in [0, 1)`.
    ///
    /// ```
    /// let error = tltl::learn::Settings::default().with_horizon(0).unwrap_err();
    /// assert_eq!((error.field(), error.range()), ("horizon", "at least 1"));
    /// ```
    #[must_use]
    pub const fn range(&self) -> &'static str {
        self.range
    }

    /// `Ok` if the value of `field` is `valid`.
    pub(crate) const fn check(
        field: &'static str,
        value: f64,
        valid: bool,
        range: &'static str,
    ) -> Result<(), Self> {
        if valid { Ok(()) } else { Err(Self { field, value, range }) }
    }
}

impl fmt::Display for OutOfRange {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` is {}, not {}", self.field, self.value, self.range)
    }
}

impl core::error::Error for OutOfRange {}

/// A getter and a checked setter for each number among the settings of a type.
///
/// One row is `field, with_field: type, "range in words", |value| whether it is in the range;`. A
/// macro, because forty pairs of methods that differ in these four things would hide a slip.
///
/// The name of the field in the error is the method's, so an author who reads the message has already
/// read the name of what to change. Setters are not `const`, for ranges are tested by closures.
macro_rules! checked {
    ($settings:ident {$(
        $(#[doc = $doc:literal])+
        $field:ident, $with:ident: $number:ty, $range:literal, $valid:expr;
    )*}) => {
        impl $settings {$(
            $(#[doc = $doc])+
            #[inline]
            #[must_use]
            pub const fn $field(&self) -> $number {
                self.$field
            }

            #[doc = concat!("The same with another [`", stringify!($field), "`](Self::",
                stringify!($field), ").")]
            #[doc = ""]
            #[doc = concat!("# Errors\nUnless it is ", $range, ".")]
            pub fn $with(mut self, $field: $number) -> Result<Self, $crate::range::OutOfRange> {
                let valid: fn($number) -> bool = $valid;
                let (name, value) = (stringify!($field), $field as f64);
                $crate::range::OutOfRange::check(name, value, valid($field), $range)?;
                self.$field = $field;
                Ok(self)
            }
        )*}
    };
}

pub(crate) use checked;
