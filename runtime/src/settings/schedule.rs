//! Numbers that change while learning goes on: step sizes, exploration, the weights of replay.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::range::OutOfRange;

/// A number that changes while learning goes on; n counts what its user counts.
///
/// All its numbers are finite: a value of this type is valid. Whoever takes a schedule checks that
/// its numbers are in the range of the setting.
///
/// ```
/// use tltl::learn::Schedule;
///
/// let epsilon = Schedule::linear(1.0, 0.5, 1_000)?;
/// assert_eq!([0, 500, 9_999].map(|n| epsilon.at(n)), [1.0, 0.75, 0.5]);
/// assert!(Schedule::constant(f64::NAN).is_err());
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Form", into = "Form"))]
pub struct Schedule(Form);

/// The forms of a schedule, as they are saved.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase", deny_unknown_fields))]
enum Form {
    Constant(f64),
    Linear { from: f64, to: f64, steps: u64 },
    Harmonic { start: f64, half: f64 },
}

impl TryFrom<Form> for Schedule {
    type Error = OutOfRange;

    fn try_from(form: Form) -> Result<Self, OutOfRange> {
        match form {
            Form::Constant(value) => Self::constant(value),
            Form::Linear { from, to, steps } => Self::linear(from, to, steps),
            Form::Harmonic { start, half } => Self::harmonic(start, half),
        }
    }
}

impl From<Schedule> for Form {
    fn from(schedule: Schedule) -> Self {
        schedule.0
    }
}

impl Schedule {
    /// The same number for ever.
    ///
    /// # Errors
    /// Unless it is finite.
    pub const fn constant(value: f64) -> Result<Self, OutOfRange> {
        match finite("value", value) {
            Ok(()) => Ok(Self(Form::Constant(value))),
            Err(error) => Err(error),
        }
    }

    /// From one number at n = 0 to another at n = `steps`, then that.
    ///
    /// # Errors
    /// Unless both are finite.
    pub fn linear(from: f64, to: f64, steps: u64) -> Result<Self, OutOfRange> {
        finite("from", from)?;
        finite("to", to)?;
        Ok(Self(Form::Linear { from, to, steps }))
    }

    /// `start · half / (half + n)`: half of `start` at n = `half`. As a step size it satisfies the
    /// conditions of Robbins and Monro (1951), so that values converge.
    ///
    /// ```
    /// use tltl::learn::Schedule;
    ///
    /// let alpha = Schedule::harmonic(1.0, 8.0)?;
    /// assert_eq!([0, 8, 24].map(|n| alpha.at(n)), [1.0, 0.5, 0.25]);
    /// # Ok::<(), tltl::OutOfRange>(())
    /// ```
    ///
    /// # Errors
    /// Unless `start` is finite, and `half` finite and positive.
    pub fn harmonic(start: f64, half: f64) -> Result<Self, OutOfRange> {
        finite("start", start)?;
        let positive = half.is_finite() && half > 0.0;
        OutOfRange::check("half", half, positive, "a positive number")?;
        Ok(Self(Form::Harmonic { start, half }))
    }

    /// A constant that is known to be finite.
    pub(crate) const fn known(value: f64) -> Self {
        Self(Form::Constant(value))
    }

    /// A linear schedule whose numbers are known to be finite.
    #[cfg(feature = "deep")]
    pub(crate) const fn known_linear(from: f64, to: f64, steps: u64) -> Self {
        Self(Form::Linear { from, to, steps })
    }

    /// A harmonic schedule whose numbers are known to be in range.
    pub(crate) const fn known_harmonic(start: f64, half: f64) -> Self {
        Self(Form::Harmonic { start, half })
    }

    /// The number at `n`.
    #[inline]
    #[must_use]
    pub fn at(&self, n: u64) -> f64 {
        match self.0 {
            Form::Constant(value) => value,
            Form::Linear { from, to, steps } => {
                let done = if n < steps { n as f64 / steps as f64 } else { 1.0 };
                from + (to - from) * done
            }
            Form::Harmonic { start, half } => start * half / (half + n as f64),
        }
    }

    /// The number, if it never changes: what inner loops ask once.
    #[inline]
    pub(crate) const fn fixed(&self) -> Option<f64> {
        match self.0 {
            Form::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// `Ok` if all its numbers are `valid` as `field`.
    pub(crate) fn check(
        &self,
        field: &'static str,
        range: &'static str,
        valid: impl Fn(f64) -> bool,
    ) -> Result<(), OutOfRange> {
        // Between its ends a schedule is monotone; a harmonic one falls to 0 and never reaches it.
        let ends = match self.0 {
            Form::Constant(value) => [value; 2],
            Form::Linear { from, to, .. } => [from, to],
            Form::Harmonic { start, .. } => [start; 2],
        };
        let bad = ends.into_iter().find(|&end| !valid(end));
        bad.map_or(Ok(()), |value| OutOfRange::check(field, value, false, range))
    }
}

const fn finite(field: &'static str, value: f64) -> Result<(), OutOfRange> {
    OutOfRange::check(field, value, value.is_finite(), "a finite number")
}
