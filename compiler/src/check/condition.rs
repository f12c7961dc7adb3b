//! Predicates: an expression as a condition of one state. Conditions have no negation normal form:
//! `!` stays where robustness negates exactly, and a comparison absorbs it.

use super::atom::{Atom, Atoms};
use super::role::Role;
use crate::ast::{Infix, Prefix};
use crate::predicate::ConditionId;
use crate::resolve::{Expression, ExpressionId};

impl Atoms<'_, '_> {
    /// The condition of the whole expression; `None` if there is a mistake in it.
    pub(super) fn condition(&mut self) -> Option<ConditionId> {
        let mut built: Vec<Option<ConditionId>> = Vec::new();
        let roles = self.roles;
        for (id, role) in roles.iter() {
            let condition = match role {
                Role::Condition => self.build(id, &|operand| built[roles.position(operand)]),
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
        let resolved = self.resolved;
        match resolved[id].expression {
            Expression::Prefix(Prefix::Not, operand) => Some(self.lowering.arena.not(of(operand)?)),
            Expression::Infix(Infix::And, left, right) => {
                Some(self.lowering.arena.and(of(left)?, of(right)?))
            }
            Expression::Infix(Infix::Or, left, right) => {
                Some(self.lowering.arena.or(of(left)?, of(right)?))
            }
            Expression::Infix(Infix::Implies, left, right) => {
                let left = self.lowering.arena.not(of(left)?);
                Some(self.lowering.arena.or(left, of(right)?))
            }
            _ => match self.atom(id)? {
                Atom::Conditions(all) => {
                    let arena = &mut self.lowering.arena;
                    all.into_iter().reduce(|left, right| arena.and(left, right))
                }
                Atom::Task(..) => {
                    let text = resolved.quote(id);
                    let message =
                        format!("`{text}` is a task, and a predicate speaks of one state");
                    self.lowering.refuse(
                        resolved.type_error(id, message).help("declare this item as a `task` too"),
                    )
                }
            },
        }
    }
}
