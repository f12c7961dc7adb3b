//! The error of bringing together what belongs to different tasks or worlds.
//!
//! Tables are indexed by automaton states, world states and actions. A table of another task may have
//! the same sizes, and then reading it gives nonsense without a panic; so whatever takes two things
//! compares their tasks first, and says which two did not fit.

use alloc::string::String;
use core::fmt;

/// Two things that must belong to the same task and world do not.
///
/// ```
/// use tltl::learn::Experience;
///
/// let (mut one, other) = (Experience::new(80, 5), Experience::new(64, 5));
/// assert_eq!(
///     one.extend(&other).unwrap_err().to_string(),
///     "experience of a world of 64 states and 5 actions does not fit a world of 80 states and 5 actions"
/// );
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mismatch {
    what: &'static str,
    found: String,
    expected: String,
    difference: Option<String>,
}

impl Mismatch {
    /// `what` belongs to `found`, and must belong to `expected`.
    pub(crate) const fn new(what: &'static str, found: String, expected: String) -> Self {
        Self { what, found, expected, difference: None }
    }

    /// The same, saying in what the two differ: for two of the same name and sizes.
    pub(crate) fn in_that(self, difference: String) -> Self {
        Self { difference: Some(difference), ..self }
    }

    /// The task or world that was found: its name and its sizes.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// let of = |cells| Labelled::new(0..cells, ["go"], &tltl! { |x: &i32| F ({ *x } == 2) });
    /// let policy = Policy::from_fn(&of(3)?, |_, _| 0)?;
    /// let five = tltl::model::from_fn(5, 1, |s, _| [(s, 1.0)]);
    /// let wider = Problem::new(&Dynamics::new(&five)?, &of(5)?)?;
    /// let error = wider.evaluate(&policy).unwrap_err();
    /// assert!(error.found().ends_with("(2 automaton states, 3 states, 1 actions)"));
    /// assert!(error.expected().ends_with("(2 automaton states, 5 states, 1 actions)"));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    pub fn found(&self) -> &str {
        &self.found
    }

    /// The task or world that was needed: its name and its sizes.
    #[must_use]
    pub fn expected(&self) -> &str {
        &self.expected
    }
}

impl fmt::Display for Mismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { what, found, expected, difference } = self;
        write!(f, "{what} of {found} does not fit {expected}")?;
        match difference {
            Some(difference) => write!(f, ": {difference}"),
            None => Ok(()),
        }
    }
}

impl core::error::Error for Mismatch {}

/// How a world is named where it does not fit: by its sizes.
pub(crate) fn world(states: usize, actions: usize) -> String {
    alloc::format!("a world of {states} states and {actions} actions")
}
