//! A formula as data: its operators, and the text that its author wrote.
//!
//! The runtime never parses: the compiler writes the operators, and
//! [`robustness::trajectory`](crate::robustness::trajectory) evaluates them.

#[cfg(feature = "alloc")]
use crate::automaton::{TableError, check_limit};
use crate::shared::Shared;

/// One operator of a formula in negation normal form; operands are indices of earlier operators, so
/// a formula is a slice and its last operator the whole.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Op {
    /// ⊤, robustness +∞.
    True,
    /// ⊥, robustness -∞.
    False,
    /// A proposition.
    Is(u32),
    /// A negated proposition.
    Not(u32),
    /// φ ∧ ψ.
    And(u32, u32),
    /// φ ∨ ψ.
    Or(u32, u32),
    /// ○φ, strong: there must be a next state.
    Next(u32),
    /// `X[n] φ`, strong: φ at the instant n steps later, which must exist. The bound comes before the
    /// operand, here and below.
    Delay(u32, u32),
    /// ◇φ.
    Eventually(u32),
    /// `F[0,n] φ`: φ now or at one of the next n instants.
    Within(u32, u32),
    /// `G[0,n] φ`, strong: φ now and at each of the next n instants, which must exist.
    Throughout(u32, u32),
    /// φ U ψ, strong.
    Until(u32, u32),
    /// φ T ψ: φ at some instant, ψ at a strictly later one. The operands are φ and ◇ψ.
    Then(u32, u32),
}

/// A formula as data: its text and its operators, children before parents.
///
/// ```
/// # #[cfg(feature = "macros")] {
/// use tltl::{Acceptor, robustness::Op, tltl};
///
/// let task = tltl! { |s: &(bool, bool)| F s.0 && F s.1 };
/// assert_eq!(task.formula().text(), "F s.0 && F s.1");
/// assert_eq!(task.formula().operators().last(), Some(&Op::And(1, 3)));
/// # }
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    pub(crate) text: Shared<str>,
    operators: Shared<[Op]>,
}

/// The formula of an automaton on its own.
pub(crate) static EMPTY: Formula =
    Formula::trusted(Shared::from_static(""), Shared::from_static(&[]));

impl Formula {
    /// The formula whose last operator is the whole, in negation normal form. Without operators it
    /// is only a text: that of a task whose automaton came without a formula.
    ///
    /// # Errors
    /// If an operand is not an earlier operator.
    ///
    /// ```
    /// use tltl::{Formula, robustness::Op};
    ///
    /// let eventually = Formula::new("F a", vec![Op::Is(0), Op::Eventually(0)])?;
    /// assert_eq!(eventually.text(), "F a");
    /// let error = Formula::new("F a", vec![Op::Eventually(0), Op::Is(0)]).unwrap_err();
    /// assert_eq!(error.to_string(), "`operators`, entry 0: 0 is not less than 0");
    /// # Ok::<(), tltl::automaton::TableError>(())
    /// ```
    #[cfg(feature = "alloc")]
    #[inline]
    pub fn new(
        text: impl Into<Shared<str>>,
        operators: impl Into<Shared<[Op]>>,
    ) -> Result<Self, TableError> {
        let operators = operators.into();
        // A task checks the propositions, of which the automaton has the number.
        check_operators(&operators, usize::MAX)?;
        Ok(Self { text: text.into(), operators })
    }

    /// For generated code, whose operators are in order by construction.
    #[doc(hidden)]
    #[must_use]
    pub const fn trusted(text: Shared<str>, operators: Shared<[Op]>) -> Self {
        Self { text, operators }
    }

    /// The formula as its author wrote it.
    #[must_use]
    #[inline]
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The operators in negation normal form; the last one is the whole formula. None: the
    /// automaton came without a formula.
    #[must_use]
    #[inline]
    pub fn operators(&self) -> &[Op] {
        &self.operators
    }
}

/// Whether operators are a formula over so many propositions: every operator comes after its
/// operands, so one pass in order has the operands' values when it needs them.
#[cfg(feature = "alloc")]
#[inline]
pub(crate) fn check_operators(ops: &[Op], propositions: usize) -> Result<(), TableError> {
    for (k, op) in ops.iter().enumerate() {
        let limited = |value: u32, limit: usize| check_limit("operators", k, value.into(), limit);
        match *op {
            Op::True | Op::False => {}
            Op::Is(i) | Op::Not(i) => limited(i, propositions)?,
            Op::Next(a) | Op::Eventually(a) => limited(a, k)?,
            Op::Delay(_, a) | Op::Within(_, a) | Op::Throughout(_, a) => limited(a, k)?,
            Op::And(a, b) | Op::Or(a, b) | Op::Until(a, b) | Op::Then(a, b) => {
                limited(a, k)?;
                limited(b, k)?;
            }
        }
    }
    Ok(())
}
