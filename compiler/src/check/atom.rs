//! Atoms: the leaves of formulas and conditions. Each is true or false of one state, or is another
//! task.
//!
//! A chain of comparisons `a < b < c` is one leaf with several conditions. Its negation is a
//! disjunction, so the conditions stay apart until the polarity of the leaf is applied.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "!(0 < x < 3) U (y > 1)"))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "(!(x > 0) || !(x < 3)) U (y > 1)");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::lower::Lowering;
use super::proposition::Propositions;
use super::role::{Role, Roles};
use crate::ast::{Comparison, Infix, ItemKind};
use crate::error::{Error, Kind};
use crate::predicate::{
    Arguments, Condition, ConditionId, ParameterType, Scalar, Task, TaskId, Term, TermId,
};
use crate::resolve::{Callee, Expression, ExpressionId, Link, Name, Names, Resolved};
use crate::token::mentions;

/// A leaf of a formula.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// The conjunction of these. None of them is a constant, unless it is the only one.
    Conditions(Vec<ConditionId>),
    /// The formula of another task, with its arguments.
    Task(TaskId, Arguments),
}

/// The inputs for the leaves of one item.
pub(super) struct Atoms<'c, 'r> {
    pub(super) resolved: &'r Resolved<'r>,
    pub(super) lowering: &'c mut Lowering<'r>,
    pub(super) propositions: &'c mut Propositions,
    /// The tasks checked so far.
    pub(super) tasks: &'c [Option<Task>],
    /// The role of each expression.
    pub(super) roles: &'c Roles,
    /// The terms of the expressions that are numbers, by their position in the item.
    pub(super) terms: &'c [Option<TermId>],
}

impl Atoms<'_, '_> {
    /// The leaf `id`; `None` if it is an operator, or if there is a mistake in it.
    pub(super) fn atom(&mut self, id: ExpressionId) -> Option<Atom> {
        let resolved = self.resolved;
        let condition = match &resolved[id].expression {
            Expression::Truth(value) => Condition::Truth(*value),
            Expression::Infix(Infix::Compare(op), left, right) => {
                return self.comparison(id, *op, [*left, *right]).map(Atom::Conditions);
            }
            Expression::Call(Callee { item: Some(item), .. }, arguments) => {
                return self.application(id, *item, arguments);
            }
            Expression::Name(Name::Item(item, _) | Name::Parameter { item: Some(item), .. }) => {
                return self.item(id, *item);
            }
            Expression::Name(name) => self.name(id, name)?,
            _ => return None,
        };
        let condition = self.lowering.arena.add_condition(condition);
        Some(Atom::Conditions(vec![self.lowering.placed(condition, resolved.span(id))]))
    }

    /// A name that is not an item: a parameter, a field, a free proposition, a Rust expression.
    fn name(&mut self, id: ExpressionId, name: &Name) -> Option<Condition> {
        let resolved = self.resolved;
        if let Name::Parameter { ty: ty @ ParameterType::Scalar(scalar), .. } = name
            && matches!(scalar, Scalar::Bool | Scalar::Number(_))
        {
            self.truth(id, *scalar)?;
            return Some(Condition::Bool(self.lowering.parameter(id, *ty)));
        }
        if *name == Name::Free {
            return self.lowering.free_name(id, true).map(Condition::Free);
        }
        if let Some(sort) = resolved.sort(id) {
            return self.lowering.refuse(self.lowering.value_instead(id, sort, "a formula"));
        }
        if resolved.names == Names::Host {
            return self.rust(id);
        }
        let (term, scalar) = self.lowering.place(id)?;
        self.truth(id, scalar)?;
        Some(Condition::Bool(term))
    }

    /// A Rust expression over the state, or a Rust value that is itself a predicate. It is the
    /// former iff it mentions the name of the state.
    fn rust(&mut self, id: ExpressionId) -> Option<Condition> {
        let (text, bindings) = self.lowering.rust_text(id)?;
        let span = self.resolved.span(id);
        let host = self.resolved.scope.host();
        if host.is_some_and(|(host, ..)| mentions(&text, host)) {
            let term = Term::Host { text, span, bindings, value: false };
            return Some(Condition::Bool(self.lowering.arena.add_term(term)));
        }
        let (_, span) = *self.lowering.free.get_or_insert(text.clone(), (true, span));
        Some(Condition::Value { text, span, bindings })
    }

    /// Refuses the place or parameter `id` if it is a number.
    fn truth(&mut self, id: ExpressionId, scalar: Scalar) -> Option<()> {
        if scalar == Scalar::Bool {
            return Some(());
        }
        let (text, name) = (self.resolved.quote(id), scalar.name());
        let message = format!("`{text}` is a number ({name}), but a formula is needed here");
        self.lowering.refuse(
            self.lowering
                .resolved
                .type_error(id, message)
                .help(format!("compare it with something, such as `{text} < 1`")),
        )
    }

    /// Another predicate or task, without arguments.
    fn item(&mut self, id: ExpressionId, item: usize) -> Option<Atom> {
        let resolved = self.resolved;
        if !resolved.scope.parameters(item).is_empty() {
            return self.lowering.refuse(self.without_arguments(id, item));
        }
        let entry = resolved.item(item);
        match entry.kind {
            ItemKind::Predicate(..) => {
                let predicate = self.propositions.declared[item]?;
                let condition = self.lowering.arena.add_condition(Condition::Is(predicate));
                Some(Atom::Conditions(vec![condition]))
            }
            ItemKind::Task(..) => {
                resolved.scope.task_id(item).map(|task| Atom::Task(task, Vec::new()))
            }
            ItemKind::Constant(..) => {
                let text = resolved.text(id);
                let message = format!("`{text}` is a number, but a formula is needed here");
                self.lowering.refuse(
                    resolved
                        .type_error(id, message)
                        .related(entry.name, "declared here")
                        .help(format!("compare something with it, such as `x < {text}`")),
                )
            }
            _ => None,
        }
    }

    /// The condition of a comparison of two values, or the conditions of a chain of numbers, left
    /// to right.
    fn comparison(
        &mut self,
        id: ExpressionId,
        op: Comparison,
        sides: [ExpressionId; 2],
    ) -> Option<Vec<ConditionId>> {
        if sides.iter().all(|side| self.roles.of(*side) == Role::Part) {
            let condition = self.lowering.compare_values(id, op, sides)?;
            return Some(vec![self.lowering.placed(condition, self.resolved.span(id))]);
        }
        let links = self.resolved.chain(id);
        if let Some(error) = mixed(&links) {
            return self.lowering.refuse(error);
        }
        let mut conditions = Vec::new();
        for Link { op, sides, .. } in links {
            let [left, right] = sides.map(|side| self.terms[self.roles.position(side)]);
            let condition = self.lowering.arena.compare(op, left?, right?);
            let [from, to] = sides.map(|side| self.resolved[side].outer);
            conditions.push(self.lowering.placed(condition, from.to(to)));
        }
        Some(self.without_constants(conditions))
    }

    /// Drops conditions that are always true from a conjunction; one that is never true is all of
    /// it.
    fn without_constants(&mut self, mut conditions: Vec<ConditionId>) -> Vec<ConditionId> {
        let never = self.lowering.arena.add_condition(Condition::Truth(false));
        let always = self.lowering.arena.add_condition(Condition::Truth(true));
        if conditions.contains(&never) {
            return vec![never];
        }
        conditions.retain(|condition| *condition != always);
        if conditions.is_empty() { vec![always] } else { conditions }
    }
}

/// The error for a chain that points both ways. `a < b > c` would be read as `a < c`, which it does
/// not say.
fn mixed(links: &[Link]) -> Option<Error> {
    if links.len() < 2 {
        return None;
    }
    if let Some(link) = links.iter().find(|link| link.op == Comparison::Unequal) {
        let message = "`!=` cannot stand in a chain of comparisons";
        return Some(Error::new(Kind::Chain, message, link.operator)
            .help("`x != y != z` says nothing about `x` and `z`: write each comparison with `&&` between them"));
    }
    let points = |op: Comparison| match op {
        Comparison::Less | Comparison::AtMost => Some(true),
        Comparison::Greater | Comparison::AtLeast => Some(false),
        Comparison::Equal | Comparison::Unequal => None,
    };
    let mut directed = links.iter().filter(|link| points(link.op).is_some());
    let first = directed.next()?;
    let other = directed.find(|link| points(link.op) != points(first.op))?;
    let (one, two) = (first.op.symbol(), other.op.symbol());
    let message =
        format!("a chain of comparisons points one way, but this one has `{one}` and `{two}`");
    Some(
        Error::new(Kind::Chain, message, other.operator)
            .related(first.operator, "the other way")
            .help(
            "for \"between\" write `1 < x < 3`; else write two comparisons with `&&` between them",
        ),
    )
}
