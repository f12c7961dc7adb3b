//! Predicates: an expression as a condition of one state. Conditions have no negation normal form:
//! `!` stays where robustness negates exactly, and a comparison absorbs it.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state S { x: f64, a: bool }\npredicate p = !(x < 3 && a)\ntask t = F p";
//! let module = check::file(&Source::new("s.tltl", text))?;
//! assert_eq!(module.display(module.predicates[0].condition).to_string(), "!(x < 3 && a)");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::atom::{Atom, Atoms};
use super::role::Role;
use crate::ast::{Infix, Prefix};
use crate::predicate::{Condition, ConditionId};
use crate::resolve::{Expression, ExpressionId};

impl Atoms<'_, '_> {
    /// The condition of the whole expression; `None` if there is a mistake in it.
    pub(super) fn condition(&mut self) -> Option<ConditionId> {
        let mut built: Vec<Option<ConditionId>> = Vec::new();
        let roles = self.roles;
        for (id, role) in roles.iter() {
            let condition = match role {
                Role::Condition => self.build(id, &|operand| built[roles.position(operand)]),
                Role::Idle => Some(self.lowering.arena.add_condition(Condition::Truth(true))),
                _ => None,
            };
            built.push(condition);
        }
        built.pop().flatten()
    }

    /// The condition of one expression, given those of its operands.
    fn build(
        &mut self,
        id: ExpressionId,
        of: &dyn Fn(ExpressionId) -> Option<ConditionId>,
    ) -> Option<ConditionId> {
        let arena = &mut self.lowering.arena;
        match self.resolved[id].expression {
            Expression::Prefix(Prefix::Not, operand) => Some(arena.not(of(operand)?)),
            // With a bound of 0, which is no operator.
            Expression::Prefix(Prefix::Eventually | Prefix::Next | Prefix::Always, operand) => {
                of(operand)
            }
            Expression::Infix(
                op @ (Infix::And | Infix::Or | Infix::Implies | Infix::Iff),
                left,
                right,
            ) => {
                let (left, right) = (of(left)?, of(right)?);
                Some(match op {
                    Infix::And => arena.and(left, right),
                    Infix::Or => arena.or(left, right),
                    Infix::Iff => {
                        let (not_left, not_right) = (arena.not(left), arena.not(right));
                        let both = arena.and(left, right);
                        let neither = arena.and(not_left, not_right);
                        arena.or(both, neither)
                    }
                    _ => {
                        let left = arena.not(left);
                        arena.or(left, right)
                    }
                })
            }
            _ => self.leaf(id),
        }
    }

    /// The condition of a leaf; a task is none.
    fn leaf(&mut self, id: ExpressionId) -> Option<ConditionId> {
        match self.atom(id)? {
            Atom::Conditions(all) => {
                all.into_iter().reduce(|left, right| self.lowering.arena.and(left, right))
            }
            Atom::Task(..) => {
                let text = self.resolved.quote(id);
                let message = format!("`{text}` is a task, and a predicate speaks of one state");
                let error = self.resolved.type_error(id, message);
                self.lowering.refuse(error.help("declare this item as a `task` too"))
            }
        }
    }
}
