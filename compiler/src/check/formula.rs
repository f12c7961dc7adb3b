//! Tasks: an expression as a [`Spec`] in negation normal form.

use rustc_hash::FxHashSet;

use super::Checker;
use super::atom::Atom;
use super::role::{Role, Roles};
use crate::arena::Memo;
use crate::ast::{Infix, ItemKind, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{
    Arguments, Condition, ConditionId, Connective, Predicate, PredicateId, Task, TaskId,
};
use crate::source::Span;
use crate::spec::{Formula, FormulaId, Spec};

impl Checker<'_> {
    /// Checks the task that `item` declares.
    pub(super) fn task(&mut self, item: usize, root: NodeId) {
        let roles = self.roles(root, Role::Formula { negated: None });
        let terms = self.terms(root, &roles);
        self.units(root, &roles, &terms);
        let mut atoms = Vec::new();
        for (id, role) in roles.iter() {
            let atom = match role {
                Role::Formula { .. } => self.atom(id, &roles, &terms),
                _ => None,
            };
            atoms.push(atom);
        }
        let predicates = self.propositions(&roles, &atoms);
        let Some(spec) = self.spec(root, &roles, &atoms, &predicates) else { return };
        let entry = &self.ast.items()[item];
        let name = self.ast.source().slice(entry.name);
        let (name, span) = if name.is_empty() {
            (None, self.ast.entry(root).outer)
        } else {
            (Some(name.to_owned()), entry.name)
        };
        let task = Task {
            name,
            docs: entry.docs.clone(),
            span,
            parameters: self.parameters.clone(),
            text: self.text(item),
            spec,
            predicates,
            parts: self.parts(root),
            options: self.options(item),
        };
        if let Some(id) = self.task_id(item) {
            self.tasks[id.0 as usize] = Some(task);
        }
    }

    /// The formula of the task `item` as it was written.
    fn text(&self, item: usize) -> String {
        match self.written.items()[item].kind {
            ItemKind::Task(_, root) => self.written.display(root).to_string(),
            _ => String::new(),
        }
    }

    /// The predicates of the task in order of first appearance.
    fn propositions(&mut self, roles: &Roles, atoms: &[Option<Atom>]) -> Vec<PredicateId> {
        let mut predicates = Vec::new();
        let mut seen = FxHashSet::default();
        let mut add = |predicate: PredicateId| {
            if seen.insert(predicate.0) {
                predicates.push(predicate);
            }
        };
        for ((id, _), atom) in roles.iter().zip(atoms) {
            match atom {
                Some(Atom::Conditions(conditions)) => {
                    for condition in conditions {
                        if let Some((predicate, _)) =
                            self.proposition(*condition, self.ast.span(id))
                        {
                            add(predicate);
                        }
                    }
                }
                Some(Atom::Task(task, arguments)) => {
                    for literal in self.literals(*task, arguments, id) {
                        if let Literal::Proposition(predicate, _) = literal {
                            add(predicate);
                        }
                    }
                }
                None => {}
            }
        }
        predicates
    }

    /// What the predicates of a task are with the arguments that `id` gives.
    pub(super) fn literals(
        &mut self,
        task: TaskId,
        arguments: &Arguments,
        id: NodeId,
    ) -> Vec<Literal> {
        let Some(task) = &self.tasks[task.0 as usize] else { return Vec::new() };
        let predicates = task.predicates.clone();
        predicates.into_iter().map(|predicate| self.literal(predicate, arguments, id)).collect()
    }

    fn literal(&mut self, predicate: PredicateId, arguments: &Arguments, id: NodeId) -> Literal {
        let Predicate { declared, span, condition, .. } =
            self.module.predicates[predicate.0 as usize];
        if declared || arguments.is_empty() {
            return Literal::Proposition(predicate, false);
        }
        let Some(condition) = self.substituted(condition, arguments, id) else {
            return Literal::Truth(false);
        };
        if let Condition::Truth(value) = *self.module.arena.condition(condition) {
            return Literal::Truth(value);
        }
        match self.proposition(condition, span) {
            Some((predicate, negated)) => Literal::Proposition(predicate, negated),
            None => Literal::Truth(false),
        }
    }

    /// The predicate that a condition is, and whether it is its negation; `None` for a constant.
    fn proposition(&mut self, condition: ConditionId, span: Span) -> Option<(PredicateId, bool)> {
        if let Some(known) = self.known.get(&condition) {
            return Some(*known);
        }
        match *self.module.arena.condition(condition) {
            Condition::Truth(_) => None,
            Condition::Is(predicate) => Some((predicate, false)),
            _ => {
                let name = self.module.display(condition).to_string();
                let predicate = Predicate {
                    name,
                    declared: false,
                    parameters: Vec::new(),
                    docs: Vec::new(),
                    span,
                    condition,
                };
                let id = self.add_predicate(predicate);
                self.remember(condition, id);
                Some((id, false))
            }
        }
    }

    /// Notes all the ways to say that `condition` is the predicate `id` or its negation.
    fn remember(&mut self, condition: ConditionId, id: PredicateId) {
        self.known.insert(condition, (id, false));
        let Condition::Compare(op, left, right) = *self.module.arena.condition(condition) else {
            return;
        };
        for (op, left, right) in [(op, left, right), (op.mirrored(), right, left)] {
            for (op, negated) in [(op, false), (op.negated(), true)] {
                let same = self.module.arena.add_condition(Condition::Compare(op, left, right));
                self.known.insert(same, (id, negated));
            }
        }
    }

    fn spec(
        &mut self,
        root: NodeId,
        roles: &Roles,
        atoms: &[Option<Atom>],
        predicates: &[PredicateId],
    ) -> Option<Spec> {
        let name = |id: &PredicateId| self.module.predicates[id.0 as usize].name.clone();
        let mut positions = Memo::default();
        (0..).zip(predicates).for_each(|(place, &id)| positions.insert(id, place));
        let mut builder = Builder {
            spec: Spec::new(predicates.iter().map(name).collect()),
            positions,
            built: Vec::new(),
        };
        for ((id, role), atom) in roles.iter().zip(atoms) {
            let formula = match (role, atom) {
                (Role::Formula { negated }, Some(Atom::Conditions(conditions))) => {
                    Some(self.conditions(&mut builder, id, conditions, negated.is_some()))
                }
                (Role::Formula { negated }, Some(Atom::Task(task, arguments))) => {
                    self.inline(&mut builder, id, (*task, arguments), negated)
                }
                (Role::Formula { negated }, None) => {
                    self.operator(&mut builder, id, roles, negated.is_some())
                }
                _ => None,
            };
            builder.built.push(formula);
        }
        let formula = builder.built[roles.position(root)]?;
        builder.spec.set_root(formula);
        Some(builder.spec)
    }

    fn operator(
        &self,
        builder: &mut Builder,
        id: NodeId,
        roles: &Roles,
        negated: bool,
    ) -> Option<FormulaId> {
        let span = self.ast.span(id);
        let of = |builder: &Builder, id| builder.built[roles.position(id)];
        match *self.ast.node(id) {
            Node::Prefix(op, operand) => {
                let operand = of(builder, operand)?;
                match op {
                    Prefix::Eventually => Some(builder.spec.eventually(operand, span)),
                    Prefix::Next => Some(builder.spec.next(operand, span)),
                    Prefix::Not => Some(operand),
                    Prefix::Minus => None,
                }
            }
            Node::Infix(op, left, right) => {
                let (left, right) = (of(builder, left)?, of(builder, right)?);
                let spec = &mut builder.spec;
                Some(match (op, negated) {
                    (Infix::And, false) | (Infix::Or | Infix::Implies, true) => {
                        spec.and(left, right, span)
                    }
                    (Infix::Or | Infix::Implies, false) | (Infix::And, true) => {
                        spec.or(left, right, span)
                    }
                    (Infix::Until, _) => spec.until(left, right, span),
                    (Infix::Then, _) => spec.then(left, right, span),
                    (Infix::Compare(_) | Infix::Calculate(_), _) => return None,
                })
            }
            _ => None,
        }
    }

    /// The conjunction of the conditions of one leaf, or its negation.
    fn conditions(
        &mut self,
        builder: &mut Builder,
        id: NodeId,
        conditions: &[ConditionId],
        negated: bool,
    ) -> FormulaId {
        let span = self.ast.span(id);
        let mut all: Option<FormulaId> = None;
        for condition in conditions {
            let one = match *self.module.arena.condition(*condition) {
                Condition::Truth(value) => builder.spec.truth(value != negated, span),
                _ => match self.proposition(*condition, span) {
                    Some((predicate, reversed)) => {
                        builder.literal(predicate, reversed != negated, span)
                    }
                    None => continue,
                },
            };
            all = Some(match all {
                None => one,
                Some(before) if negated => builder.spec.or(before, one, span),
                Some(before) => builder.spec.and(before, one, span),
            });
        }
        all.unwrap_or_else(|| builder.spec.truth(!negated, span))
    }

    /// The formula of another task, or its negation.
    fn inline(
        &mut self,
        builder: &mut Builder,
        id: NodeId,
        (task, arguments): (TaskId, &Arguments),
        negated: Option<NodeId>,
    ) -> Option<FormulaId> {
        let literals = self.literals(task, arguments, id);
        let task = self.tasks[task.0 as usize].as_ref()?;
        let span = self.ast.span(id);
        if let (Some(by), Some(temporal)) = (negated, temporal(&task.spec)) {
            let text = self.ast.quote(id);
            let message = format!("the task `{text}` is negated, and it has a temporal operator");
            self.mistakes.push(
                Error::new(Kind::NegatedTemporal, message, self.ast.entry(by).operator)
                    .related(span, "the negation reaches this task")
                    .related(
                        task.spec.span(temporal),
                        "no finite trajectory can ever rule this out",
                    )
                    .help("only formulas without F, X, U and T can be negated"),
            );
            return None;
        }
        Some(builder.import(task, &literals, negated.is_some(), span))
    }

    /// The tasks that `root` is the plain conjunction or disjunction of.
    fn parts(&self, root: NodeId) -> Option<(Connective, Vec<TaskId>)> {
        let Node::Infix(connective @ (Infix::And | Infix::Or), ..) = *self.ast.node(root) else {
            return None;
        };
        let mut parts = Vec::new();
        let mut open = vec![root];
        while let Some(id) = open.pop() {
            match *self.ast.node(id) {
                Node::Infix(op, left, right) if op == connective => open.extend([right, left]),
                Node::Name => {
                    let item = self.item(id)?;
                    let is_task = matches!(self.ast.items()[item].kind, ItemKind::Task(..));
                    parts.push(self.task_id(item).filter(|_| is_task)?);
                }
                _ => return None,
            }
        }
        let connective = if connective == Infix::And { Connective::And } else { Connective::Or };
        Some((connective, parts))
    }
}

/// The first temporal operator that the root of `spec` depends on.
fn temporal(spec: &Spec) -> Option<FormulaId> {
    let reachable = spec.reachable();
    spec.formulas()
        .filter(|(id, _)| reachable[id.0 as usize])
        .find(|(_, formula)| {
            use Formula::{Eventually, Next, Then, Until};
            matches!(formula, Next(_) | Eventually(_) | Until(..) | Then(..))
        })
        .map(|(id, _)| id)
}

/// What a predicate of a task is where the task is used.
#[derive(Clone, Copy)]
pub(super) enum Literal {
    /// A constant.
    Truth(bool),
    /// A predicate, or its negation.
    Proposition(PredicateId, bool),
}

/// A spec in the making, with the formula of each node.
struct Builder {
    spec: Spec,
    /// The place of each predicate among the propositions.
    positions: Memo<PredicateId, u32>,
    built: Vec<Option<FormulaId>>,
}

impl Builder {
    fn literal(&mut self, predicate: PredicateId, negated: bool, span: Span) -> FormulaId {
        let position = self.positions.get(predicate).unwrap_or_default();
        self.spec.literal(position, negated, span)
    }

    /// The formula of `task`; its negation, if `negated`, in which case it has no temporal
    /// operator.
    fn import(
        &mut self,
        task: &Task,
        literals: &[Literal],
        negated: bool,
        span: Span,
    ) -> FormulaId {
        let positions = &self.positions;
        let ids: Vec<_> = task.spec.formulas().map(|(id, _)| id).collect();
        let images = self.spec.rebuild(&task.spec, &ids, &mut |spec, _, formula| match formula {
            Formula::True => spec.truth(!negated, span),
            Formula::False => spec.truth(negated, span),
            Formula::Literal { proposition, negated: not } => {
                match literals[proposition as usize] {
                    Literal::Truth(value) => spec.truth(value != (not != negated), span),
                    Literal::Proposition(predicate, reversed) => {
                        let position = positions.get(predicate).unwrap_or_default();
                        spec.literal(position, reversed != (not != negated), span)
                    }
                }
            }
            Formula::And(a, b) if negated => spec.or(a, b, span),
            Formula::Or(a, b) if negated => spec.and(a, b, span),
            other => spec.add(other, span),
        });
        images[task.spec.root().0 as usize]
    }
}
