//! Leaves of formulas: names, Boolean places, comparisons.

use super::role::{Role, Roles};
use super::term::Place;
use super::{Checker, Names};
use crate::ast::{Comparison, Infix, ItemKind, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{
    Arguments, Condition, ConditionId, ParameterType, Scalar, TaskId, Term, TermId,
};
use crate::source::Span;

/// What a leaf of a formula is.
#[derive(Clone, Debug)]
pub(super) enum Atom {
    /// All of these; none of them is a constant, unless it is the only one.
    Conditions(Vec<ConditionId>),
    /// The formula of another task, with what its parameters stand for.
    Task(TaskId, Arguments),
}

impl Checker<'_> {
    /// The leaf `id`; `None` if it is not one, or if there is a mistake in it.
    pub(super) fn atom(
        &mut self,
        id: NodeId,
        roles: &Roles,
        terms: &[Option<TermId>],
    ) -> Option<Atom> {
        let condition = match *self.ast.node(id) {
            Node::Truth(value) => Condition::Truth(value),
            Node::Infix(Infix::Compare(op), left, right)
                if roles.of(left) == Role::Part && roles.of(right) == Role::Part =>
            {
                let condition = self.compare_values(id, op, [left, right])?;
                self.placed(condition, self.ast.span(id));
                return Some(Atom::Conditions(vec![condition]));
            }
            Node::Infix(Infix::Compare(_), ..) => {
                return self.comparison(id, roles, terms).map(Atom::Conditions);
            }
            Node::Prefix(..) | Node::Infix(..) | Node::Quantified { .. } => return None,
            Node::Call { .. } if self.applied(id).is_some() => {
                return self.application(id, roles, terms);
            }
            _ => match self.item(id) {
                Some(item) if matches!(self.ast.node(id), Node::Name) => {
                    return self.formula_item(id, item);
                }
                _ => self.place_condition(id)?,
            },
        };
        let condition = self.module.arena.add_condition(condition);
        Some(Atom::Conditions(vec![self.placed(condition, self.ast.span(id))]))
    }

    /// Notes where a condition stands.
    pub(super) fn placed(&mut self, condition: ConditionId, span: Span) -> ConditionId {
        self.module.places.push((condition, span));
        condition
    }

    /// A condition that is not compared: a field, a free proposition, a Rust expression.
    fn place_condition(&mut self, id: NodeId) -> Option<Condition> {
        let span = self.ast.span(id);
        if let Some(ParameterType::Scalar(scalar @ (Scalar::Bool | Scalar::Number(_)))) =
            self.parameter(id).map(|parameter| parameter.ty)
        {
            return self.truth(id, scalar).then(|| {
                let (name, ty) = (self.ast.text(id).to_owned(), ParameterType::Scalar(scalar));
                Condition::Bool(self.module.arena.add_term(Term::Parameter { name, ty }))
            });
        }
        if let Some(sort) = self.sort(id) {
            let error = self.value_instead(id, sort, "a formula");
            self.mistakes.push(error);
            return None;
        }
        match self.names {
            Names::Free => self.free_name(id, true).map(Condition::Free),
            Names::Host => {
                self.refuse_unlike_rust(id)?;
                let text = self.compact(id);
                if self.host().is_some_and(|host| crate::token::mentions(&text, host)) {
                    return Some(Condition::Bool(self.host_term(id, false)));
                }
                let bindings = self.bindings(id);
                let (_, span) = *self.free.entry(text.clone()).or_insert((true, span));
                Some(Condition::Value { text, span, bindings })
            }
            Names::Declared => {
                let Place { steps, scalar } = self.place(id)?;
                if !self.truth(id, scalar) {
                    return None;
                }
                let term = self.module.arena.add_term(Term::Place { steps, scalar });
                Some(Condition::Bool(term))
            }
        }
    }

    /// Whether the place or parameter `id` is true or false; a number is a mistake.
    fn truth(&mut self, id: NodeId, scalar: Scalar) -> bool {
        if scalar != Scalar::Bool {
            let (text, name) = (self.ast.quote(id), scalar.name());
            let message = format!("`{text}` is a number ({name}), but a formula is needed here");
            self.mistakes.push(
                Error::new(Kind::Type, message, self.ast.span(id))
                    .help(format!("compare it with something, such as `{text} < 1`")),
            );
        }
        scalar == Scalar::Bool
    }

    fn formula_item(&mut self, id: NodeId, item: usize) -> Option<Atom> {
        self.items[item].used = true;
        let text = self.ast.text(id);
        if !self.scope.parameters(item).is_empty() {
            let error = self.without_arguments(id, item);
            self.mistakes.push(error);
            return None;
        }
        match self.ast.items()[item].kind {
            ItemKind::Predicate(..) => {
                let predicate = self.items[item].predicate?;
                let condition = self.module.arena.add_condition(Condition::Is(predicate));
                Some(Atom::Conditions(vec![condition]))
            }
            ItemKind::Task(..) => self.task_id(item).map(|task| Atom::Task(task, Vec::new())),
            ItemKind::Constant(..) => {
                let message = format!("`{text}` is a number, but a formula is needed here");
                let declared = self.ast.items()[item].name;
                self.mistakes.push(
                    Error::new(Kind::Type, message, self.ast.span(id))
                        .related(declared, "declared here")
                        .help(format!("compare something with it, such as `x < {text}`")),
                );
                None
            }
            _ => None,
        }
    }

    /// The comparisons of a chain, left to right.
    fn comparison(
        &mut self,
        id: NodeId,
        roles: &Roles,
        terms: &[Option<TermId>],
    ) -> Option<Vec<ConditionId>> {
        let mut links = Vec::new();
        let mut at = id;
        while let Node::Infix(Infix::Compare(op), left, right) = *self.ast.node(at) {
            let chained = self.is_chained(left);
            let before = match *self.ast.node(left) {
                Node::Infix(_, _, middle) if chained => middle,
                _ => left,
            };
            links.push((op, before, right, self.ast.entry(at).operator));
            if !chained {
                break;
            }
            at = left;
        }
        links.reverse();
        let operators: Vec<_> = links.iter().map(|link| (link.0, link.3)).collect();
        if let Some(error) = self.mixed(&operators) {
            self.mistakes.push(error);
            return None;
        }
        let of = |operand: NodeId| terms[roles.position(operand)];
        let mut conditions = Vec::new();
        for (op, left, right, _) in links {
            let condition = self.module.arena.compare(op, of(left)?, of(right)?);
            let [from, to] = [left, right].map(|side| self.ast.entry(side).outer);
            conditions.push(self.placed(condition, from.to(to)));
        }
        Some(self.without_constants(conditions))
    }

    /// Drops what is always true from a conjunction; what is never true is all of it.
    fn without_constants(&mut self, mut conditions: Vec<ConditionId>) -> Vec<ConditionId> {
        let never = self.module.arena.add_condition(Condition::Truth(false));
        let always = self.module.arena.add_condition(Condition::Truth(true));
        if conditions.contains(&never) {
            return vec![never];
        }
        conditions.retain(|condition| *condition != always);
        if conditions.is_empty() { vec![always] } else { conditions }
    }

    /// The error for a chain that points both ways.
    fn mixed(&self, operators: &[(Comparison, Span)]) -> Option<Error> {
        if operators.len() < 2 {
            return None;
        }
        let direction = |op: Comparison| match op {
            Comparison::Less | Comparison::AtMost => Some(true),
            Comparison::Greater | Comparison::AtLeast => Some(false),
            Comparison::Equal | Comparison::Unequal => None,
        };
        if let Some((_, span)) = operators.iter().find(|(op, _)| *op == Comparison::Unequal) {
            let message = "`!=` cannot stand in a chain of comparisons";
            return Some(Error::new(Kind::Chain, message, *span)
                .help("`x != y != z` says nothing about `x` and `z`: write each comparison with `&&` between them"));
        }
        let first = operators.iter().find(|(op, _)| direction(*op).is_some())?;
        let other = operators
            .iter()
            .find(|(op, _)| direction(*op).is_some_and(|way| Some(way) != direction(first.0)))?;
        let (one, two) = (first.0.symbol(), other.0.symbol());
        let message =
            format!("a chain of comparisons points one way, but this one has `{one}` and `{two}`");
        Some(Error::new(Kind::Chain, message, other.1).related(first.1, "the other way").help(
            "for \"between\" write `1 < x < 3`; else write two comparisons with `&&` between them",
        ))
    }

    /// The condition of one state that the expression `root` is.
    pub(super) fn condition(&mut self, root: NodeId) -> Option<ConditionId> {
        let roles = self.roles(root, Role::Condition);
        let terms = self.terms(root, &roles);
        self.units(root, &roles, &terms);
        let mut built: Vec<Option<ConditionId>> = Vec::new();
        for (id, role) in roles.iter() {
            let condition = match role {
                Role::Condition => self.build_condition(id, &roles, &terms, &built),
                _ => None,
            };
            built.push(condition);
        }
        built.last().copied().flatten()
    }

    fn build_condition(
        &mut self,
        id: NodeId,
        roles: &Roles,
        terms: &[Option<TermId>],
        built: &[Option<ConditionId>],
    ) -> Option<ConditionId> {
        let of = |operand: NodeId| built[roles.position(operand)];
        match *self.ast.node(id) {
            Node::Prefix(Prefix::Not, operand) => Some(self.module.arena.not(of(operand)?)),
            Node::Infix(Infix::And, left, right) => {
                Some(self.module.arena.and(of(left)?, of(right)?))
            }
            Node::Infix(Infix::Or, left, right) => {
                Some(self.module.arena.or(of(left)?, of(right)?))
            }
            Node::Infix(Infix::Implies, left, right) => {
                let left = self.module.arena.not(of(left)?);
                Some(self.module.arena.or(left, of(right)?))
            }
            _ => match self.atom(id, roles, terms)? {
                Atom::Conditions(all) => {
                    let first = *all.first()?;
                    Some(
                        all[1..]
                            .iter()
                            .fold(first, |left, right| self.module.arena.and(left, *right)),
                    )
                }
                Atom::Task(..) => {
                    let text = self.ast.quote(id);
                    let message =
                        format!("`{text}` is a task, and a predicate speaks of one state");
                    self.mistakes.push(
                        Error::new(Kind::Type, message, self.ast.span(id))
                            .help("declare this item as a `task` too"),
                    );
                    None
                }
            },
        }
    }
}
