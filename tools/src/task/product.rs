//! Raw products of tasks: the formula of the whole, with the automaton of the pairs.

use std::fmt;

use tltl_compiler::dfa::State;
use tltl_compiler::translate::Budget;

use super::{Bound, CompileError, Task, TaskFile};
use crate::product::{Operator, Product, product};

/// The conjunction or disjunction of tasks, over the [raw product](mod@crate::product) of their
/// automata.
///
/// ```
/// use tltl::Acceptor;
/// use tltl_compiler::translate::Budget;
/// use tltlc::product::Operator;
/// use tltlc::task::{RawProduct, compile};
///
/// let [a, b] = ["F a", "F b"].map(|formula| compile(formula, Budget::default()));
/// let (a, b) = (a?, b?);
/// let either = RawProduct::new(Operator::Or, &[&a, &b], Budget::default())??;
/// assert_eq!(either.task.entry().task().text, "F a || F b");
/// assert_eq!(either.components, [[0, 0], [0, 1]]);
/// assert!(either.task.is_accepting(1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct RawProduct {
    /// The task as a whole: its formula, and in the place of its minimal automaton the product.
    pub task: Task,
    /// For each state the state of every operand.
    pub components: Vec<Vec<State>>,
}

/// An operand that is not a bare formula: the whole could not be written as one.
///
/// ```
/// assert!(tltlc::task::NotBare.to_string().contains("bare formulas"));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotBare;

impl fmt::Display for NotBare {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("only bare formulas are joined; write the task in the file")
    }
}

impl std::error::Error for NotBare {}

impl RawProduct {
    /// The product of `operands`, which are bare formulas.
    ///
    /// # Errors
    /// If one is not; or, within, that the automaton of the whole is larger than the budget allows.
    ///
    /// # Panics
    /// If there is no operand.
    pub fn new(
        operator: Operator,
        operands: &[&Task],
        budget: Budget,
    ) -> Result<Result<Self, CompileError>, NotBare> {
        if operands.iter().any(|operand| !operand.entry().is_bare()) {
            return Err(NotBare);
        }
        let sign = match operator {
            Operator::And => " && ",
            Operator::Or => " || ",
        };
        // A comment ends with its line.
        let text = |operand: &&Task| format!("({}\n)", operand.entry().file().source().text());
        let whole: Vec<String> = operands.iter().map(text).collect();
        Ok(TaskFile::of_formula(&whole.join(sign), budget).map(|file| {
            let dfas: Vec<_> = operands.iter().map(|operand| operand.dfa()).collect();
            let Product { dfa, components } = product(operator, &dfas);
            let entry = file.with_automaton(dfa).find(None).map(|entry| entry.bind(&[]));
            let Ok(Ok(Bound::Plain(task))) = entry else {
                unreachable!("a bare formula is one task, without parameters and Rust code")
            };
            Self { task, components }
        }))
    }
}
