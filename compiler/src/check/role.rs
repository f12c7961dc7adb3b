//! Roles: what each expression must be where it stands, and what negates it. From the root down.
//!
//! The position decides the type: the operands of `<` are numbers, those of `&&` are whatever the
//! whole must be. So types need no inference, and a mistake is reported at the operand that does
//! not fit. The same descent pushes negation inward, which makes the formula's negation normal form
//! a matter of reading roles.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! // The operand of `!` is a formula, and that of `-` a number.
//! let module = check::formula(&Source::new("formula", "!(a && -x < 1)"))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "!a || !(-x < 1)");
//! let errors = check::formula(&Source::new("formula", "F (a && x + 1)")).unwrap_err();
//! assert_eq!(errors.first().kind().name(), "type");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::ops::RangeInclusive;

use super::{bound, intent};
use crate::ast::{Comparison, Infix, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{ParameterType, Scalar};
use crate::resolve::{Callee, Expression, ExpressionId, Name, Resolved};

/// The role of an expression: the type that its position asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    /// A formula of a task.
    Formula {
        /// The negation that it is under: the `!`, or the `=>` whose left side it is. Two negations
        /// cancel.
        negated: Option<ExpressionId>,
        /// The `<=>` or `ensuring` that asks for a state formula here.
        state: Option<ExpressionId>,
    },
    /// A condition of one state: a formula without temporal operators.
    Condition,
    /// A number.
    Number,
    /// The left part of a chain of comparisons, which is read with the last comparison.
    Chain,
    /// A value, an argument or an index; the expression above reads it.
    Part,
    /// An expression with a mistake that has been reported.
    Broken,
    /// A formula or a condition of which nothing is asked: the operand beside it settles what they
    /// are together.
    Idle,
}

impl Role {
    /// A formula under no other operator.
    pub(super) const FORMULA: Self = Self::Formula { negated: None, state: None };
}

/// The roles of the expressions of one item.
pub(super) struct Roles {
    first: u32,
    roles: Vec<Role>,
}

impl Roles {
    /// The role of an expression.
    pub(super) fn of(&self, id: ExpressionId) -> Role {
        self.roles[self.position(id)]
    }

    /// The position of `id` among the expressions of the item.
    pub(super) fn position(&self, id: ExpressionId) -> usize {
        (id.0 - self.first) as usize
    }

    /// The expressions of the item with their roles, operands first.
    pub(super) fn iter(&self) -> impl Iterator<Item = (ExpressionId, Role)> {
        (self.first..).map(ExpressionId).zip(self.roles.iter().copied())
    }
}

/// The roles of the expressions from `first` to `root`, where the root must be a `role`. Parents
/// stand after their operands, so the pass goes backwards.
pub(super) fn roles(
    resolved: &Resolved<'_>,
    (first, root): (ExpressionId, ExpressionId),
    role: Role,
    mistakes: &mut Vec<Error>,
) -> Roles {
    let count = (root.0 - first.0 + 1) as usize;
    let roles = Roles { first: first.0, roles: vec![Role::Part; count] };
    let within = root..=first;
    let mut descent = Descent { resolved, roles, within, mistakes };
    descent.set(root, role);
    for id in (first.0..=root.0).rev().map(ExpressionId) {
        descent.descend(id);
    }
    descent.roles
}

/// The state of the descent.
struct Descent<'r> {
    resolved: &'r Resolved<'r>,
    roles: Roles,
    /// Expressions that were found to have their bounds and indices in order.
    within: RangeInclusive<ExpressionId>,
    mistakes: &'r mut Vec<Error>,
}

impl Descent<'_> {
    /// Gives an expression a role.
    fn set(&mut self, id: ExpressionId, role: Role) {
        let position = self.roles.position(id);
        self.roles.roles[position] = role;
    }

    /// Gives the operands of an expression their roles.
    fn descend(&mut self, id: ExpressionId) {
        match self.roles.of(id) {
            Role::Part | Role::Idle => {}
            Role::Broken => self.give(id, Role::Broken),
            Role::Number => self.number(id),
            Role::Chain => self.comparison(id),
            role @ (Role::Condition | Role::Formula { .. }) => self.formula(id, role),
        }
    }

    /// Gives all operands of `id` the same role.
    fn give(&mut self, id: ExpressionId, role: Role) {
        let resolved = self.resolved;
        match &resolved[id].expression {
            Expression::Call(_, arguments) => arguments.iter().for_each(|id| self.set(*id, role)),
            Expression::Prefix(_, a) => self.set(*a, role),
            Expression::Infix(_, a, b) => {
                self.set(*a, role);
                self.set(*b, role);
            }
            _ => {}
        }
    }

    /// Notes a mistake, and silences everything below it.
    fn refuse(&mut self, id: ExpressionId, error: Error) {
        self.mistakes.push(error);
        self.set(id, Role::Broken);
        self.give(id, Role::Broken);
    }

    /// The operands of a formula or a condition.
    fn formula(&mut self, id: ExpressionId, role: Role) {
        self.connective(id, role);
        if let Some(operand) = self.resolved.idle(id)
            && self.is_beyond(operand)
        {
            self.set(operand, Role::Idle);
        }
    }

    /// Whether a bound in an expression is empty or in the past, or an index is not one of its
    /// array.
    fn is_beyond(&mut self, id: ExpressionId) -> bool {
        let resolved = self.resolved;
        let is_beyond = |part| match &resolved[part].expression {
            Expression::Name(Name::Unknown(error)) => error.kind() == Kind::Type,
            _ => bound::window(resolved, part).is_err_and(|error| error.kind() == Kind::Bound),
        };
        // Of what is within all is within, and depth costs nothing.
        if self.within.contains(&id) {
            return false;
        }
        self.within = resolved[id].first..=id;
        (resolved[id].first.0..=id.0).map(ExpressionId).any(is_beyond)
    }

    /// The operands of a formula or a condition, whatever is known of them.
    fn connective(&mut self, id: ExpressionId, role: Role) {
        let flipped = match role {
            Role::Formula { negated, state } => {
                Role::Formula { negated: negated.xor(Some(id)), state }
            }
            other => other,
        };
        match &self.resolved[id].expression {
            Expression::Prefix(Prefix::Not, operand) => self.set(*operand, flipped),
            Expression::Infix(op @ (Infix::And | Infix::Or), left, right) => {
                self.give(id, role);
                if *op == Infix::And && role == Role::FORMULA {
                    self.beside(*left, *right);
                    self.beside(*right, *left);
                }
            }
            Expression::Infix(Infix::Implies, left, right) => {
                self.set(*left, flipped);
                self.set(*right, role);
            }
            Expression::Infix(Infix::Iff, ..) => match role {
                Role::Formula { .. } => {
                    self.give(id, Role::Formula { negated: None, state: Some(id) });
                }
                other => self.give(id, other),
            },
            Expression::Prefix(Prefix::Eventually | Prefix::Next | Prefix::Always, _)
            | Expression::Infix(
                Infix::Until
                | Infix::Then
                | Infix::Release
                | Infix::WeakUntil
                | Infix::StrongRelease
                | Infix::Ensuring,
                ..,
            ) => self.temporal(id, role),
            Expression::Infix(Infix::Compare(_), ..) => self.comparison(id),
            Expression::Call(Callee { item: Some(item), .. }, arguments) => {
                self.application(*item, arguments);
            }
            Expression::Truth(_) | Expression::Name(_) => {}
            Expression::Number(_)
            | Expression::Text
            | Expression::Call(..)
            | Expression::Prefix(Prefix::Minus, _)
            | Expression::Infix(Infix::Calculate(_), ..) => self.refuse(id, self.not_a_formula(id)),
        }
    }

    /// Refuses "always" beside goals: it is meant until they are reached, which can be said.
    fn beside(&mut self, always: ExpressionId, goals: ExpressionId) {
        if let Some(error) = intent::always_beside(self.resolved, always, goals) {
            self.refuse(always, error);
        }
    }

    /// The operands of a temporal operator; refused in a condition, under a negation that does not
    /// vanish, and where a state formula must stand.
    fn temporal(&mut self, id: ExpressionId, role: Role) {
        let window = match bound::window(self.resolved, id) {
            Ok(window) => window,
            Err(error) => return self.refuse(id, error),
        };
        let expression = &self.resolved[id].expression;
        if window == Some(0..=0) && matches!(expression, Expression::Prefix(..)) {
            // X[0], F[0,0] and G[0,0] say nothing.
            return self.give(id, role);
        }
        let Role::Formula { negated, state } = role else {
            return self.refuse(id, self.temporal_predicate(id));
        };
        if let Some(by) = state {
            self.mistakes.push(intent::not_of_a_state(self.resolved, id, by));
            return self.give(id, Role::FORMULA);
        }
        match (expression, &window, negated) {
            // The negation makes it `F` or `U`.
            (
                Expression::Prefix(Prefix::Always, _)
                | Expression::Infix(Infix::Release | Infix::WeakUntil, ..),
                None,
                Some(_),
            ) => return self.give(id, role),
            (Expression::Prefix(Prefix::Always, _), None, None)
            | (Expression::Infix(Infix::Release | Infix::WeakUntil, ..), ..)
            | (Expression::Infix(Infix::StrongRelease, ..), Some(_), _)
            | (Expression::Infix(Infix::StrongRelease, ..), _, None) => {
                return self.refuse(id, intent::unsupported(self.resolved, id));
            }
            _ => {}
        }
        self.mistakes.extend(negated.map(|by| intent::negated(self.resolved, id, by)));
        // The rest of the formula may hold mistakes of its own.
        self.give(id, Role::FORMULA);
        if let Expression::Infix(Infix::Ensuring, _, right) = *expression {
            self.set(right, Role::Formula { negated: None, state: Some(id) });
        }
    }

    /// The sides of a comparison: numbers, or two values.
    fn comparison(&mut self, id: ExpressionId) {
        let Expression::Infix(Infix::Compare(op), left, right) = self.resolved[id].expression
        else {
            return;
        };
        let is_truth =
            |side: &ExpressionId| matches!(&self.resolved[*side].expression, Expression::Truth(_));
        if let Some(truth) = [left, right].into_iter().find(is_truth) {
            return self.refuse(id, self.compared_truth(truth));
        }
        let chained = self.resolved.is_chained(left);
        let truths =
            !matches!(self.resolved[left].expression, Expression::Infix(Infix::Compare(_), ..));
        if chained && truths {
            return self.refuse(id, self.chained_truth(id));
        }
        let sides = if chained { &[right][..] } else { &[left, right] };
        match sides.iter().find(|side| self.resolved.sort(**side).is_some()) {
            Some(_) if !chained && matches!(op, Comparison::Equal | Comparison::Unequal) => {}
            Some(side) => self.refuse(id, self.ordered_values(id, *side, chained)),
            None => {
                self.set(left, if chained { Role::Chain } else { Role::Number });
                self.set(right, Role::Number);
            }
        }
    }

    /// The arguments of a predicate or a task. A number is an expression of its own; a value is
    /// read with the call.
    fn application(&mut self, item: usize, arguments: &[ExpressionId]) {
        for (argument, parameter) in arguments.iter().zip(self.resolved.scope.parameters(item)) {
            if let ParameterType::Scalar(Scalar::Number(_)) = parameter.ty {
                self.set(*argument, Role::Number);
            }
        }
    }

    /// The operands of a number.
    fn number(&mut self, id: ExpressionId) {
        match &self.resolved[id].expression {
            Expression::Prefix(Prefix::Minus, _)
            | Expression::Infix(Infix::Calculate(_), ..)
            | Expression::Call(Callee { function: Some(_), .. }, _) => self.give(id, Role::Number),
            Expression::Truth(_) | Expression::Prefix(..) | Expression::Infix(..) => {
                self.refuse(id, self.not_a_number(id));
            }
            _ => {}
        }
    }

    /// The error for values that are compared as if they had an order, or in a chain.
    fn ordered_values(&self, id: ExpressionId, side: ExpressionId, chained: bool) -> Error {
        let text = self.resolved.quote(side);
        let operator = self.resolved.operator(id);
        if chained {
            let message = format!("`{text}` is a value, and values are compared two at a time");
            return Error::new(Kind::Chain, message, operator)
                .help("write each comparison, with `&&` between them");
        }
        let symbol = self.resolved.symbol(id);
        let message =
            format!("`{text}` is a value and no number, so `{symbol}` says nothing about it");
        Error::new(Kind::Type, message, operator)
            .help("values are compared with `==` and `!=` only")
    }

    /// The error for `p == true`.
    fn compared_truth(&self, truth: ExpressionId) -> Error {
        let message = "truth values are not compared";
        self.resolved
            .type_error(truth, message)
            .help("for `p == true` write `p`, for `p == false` write `!p`")
    }

    /// The error for `p == q == r` of truth values.
    fn chained_truth(&self, id: ExpressionId) -> Error {
        let message = "truth values are compared two at a time";
        Error::new(Kind::Chain, message, self.resolved.operator(id))
            .help("write each comparison, with `&&` between them")
    }

    /// The error for a number where a formula must stand.
    fn not_a_formula(&self, id: ExpressionId) -> Error {
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is a number, but a formula is needed here");
        let error = Error::new(Kind::Type, message, self.resolved[id].outer);
        match &self.resolved[id].expression {
            Expression::Text => {
                let message = format!("`{text}` is a string, but a formula is needed here");
                Error::new(Kind::Type, message, self.resolved[id].outer)
                    .help("only a bare formula outside of the macro has names in quotes")
            }
            Expression::Number(0.0) => {
                error.help("the formula that never holds is written `false`")
            }
            Expression::Number(1.0) => {
                error.help("the formula that always holds is written `true`")
            }
            Expression::Number(_) => {
                error.help(format!("compare something with it, such as `x < {text}`"))
            }
            _ => error.help(format!("compare it with something, such as `{text} < 1`")),
        }
    }

    /// The error for a formula where a number must stand.
    fn not_a_number(&self, id: ExpressionId) -> Error {
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is true or false, but a number is needed here");
        Error::new(Kind::Type, message, self.resolved[id].outer)
            .help("comparisons and arithmetic take numbers; `!`, `&&` and `F` give none")
    }

    /// The error for a temporal operator in a predicate.
    fn temporal_predicate(&self, id: ExpressionId) -> Error {
        let symbol = self.resolved.symbol(id);
        let message = format!("a predicate speaks of one state, so `{symbol}` cannot stand in it");
        Error::new(Kind::Type, message, self.resolved.operator(id))
            .help("declare it as a `task`: a task can be used inside other tasks")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resolve::Names;
    use crate::resolve::tests::{messages, read};

    /// The roles of a formula's expressions, operands first, a letter each, and what is refused.
    fn found(text: &str, role: Role) -> (String, Vec<String>) {
        let (roles, mistakes) = read(Names::Free, text, |resolved, item, mistakes| {
            let expressions = resolved.expressions[item].unwrap();
            let letter = |role| match role {
                Role::Formula { negated: None, .. } => 'f',
                Role::Formula { negated: Some(_), .. } => '!',
                Role::Condition => 'c',
                Role::Number => 'n',
                Role::Chain => '-',
                Role::Part => '.',
                Role::Broken => 'x',
                Role::Idle => '0',
            };
            let roles = roles(resolved, expressions, role, mistakes);
            roles.iter().map(|(_, role)| letter(role)).collect()
        });
        (roles, messages(mistakes))
    }

    #[test]
    fn what_each_operand_has_to_be() {
        for (text, expected) in [
            ("F a && b", "ffff"),
            ("!(a && !b) || c", "!f!!fff"),
            ("(a => b) => c", "f!!ff"),
            ("x < 3", "nnf"),
            ("1 < x < -3", "nn-nnf"),
            ("min(x + 1, 2) < y", ".nnnnnnf"),
            ("x.y[i] == 2", "...nnf"),
        ] {
            let role = Role::FORMULA;
            assert_eq!(found(text, role), (expected.to_owned(), vec![]), "{text}");
        }
        assert_eq!(found("!a && x < 1", Role::Condition), ("ccnncc".to_owned(), vec![]));
    }

    #[test]
    fn what_cannot_be_it_is_refused_once() {
        for (text, roles, expected) in [
            ("x + 1", "xxx", "`x + 1` is a number, but a formula is needed here"),
            ("F (a && b) < 1", "xxxnff", "`a && b` is true or false, but a number is needed here"),
            ("!F a", "f!f", "`!` cannot stand before `F`"),
            ("!(b || F a)", "!f!!f", "this `!` reaches `F`, and `!F a` is outside the language"),
            ("x == true", "xxx", "truth values are not compared"),
        ] {
            let role = Role::FORMULA;
            assert_eq!(found(text, role), (roles.to_owned(), vec![expected.to_owned()]), "{text}");
        }
        let expected = "a predicate speaks of one state, so `F` cannot stand in it";
        let (roles, mistakes) = found("a && F (b && c)", Role::Condition);
        assert_eq!((roles.as_str(), mistakes), ("cxxxxc", vec![expected.to_owned()]));
    }
}
