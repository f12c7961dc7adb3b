//! Tasks: an expression as a [`Spec`] in negation normal form.
//!
//! Propositions are numbered in the order of their first appearance, which becomes the order of the
//! decision diagrams' levels. Therefore the leaves are all read first, and the formula is built in
//! a second pass. A task that another one uses is copied into it, its propositions mapped: an
//! automaton is built for each task as a whole.

use super::atom::{Atom, Atoms};
use super::lower::Lowering;
use super::proposition::Literal;
use super::role::{Role, Roles};
use crate::arena::Memo;
use crate::ast::{Infix, ItemKind, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{Connective, PredicateId, Task, TaskId};
use crate::resolve::{Expression, ExpressionId, Name, Resolved};
use crate::source::Span;
use crate::spec::{Formula, FormulaId, Spec};

/// A leaf with its literals: those of its conditions, or those of the predicates of another task.
enum Leaf<'c> {
    Conditions(Vec<Literal>),
    Task(&'c Task, Vec<Literal>),
}

/// The formula of a task, and the predicate of each of its propositions; `None` if there is a
/// mistake in it.
pub(super) fn spec(mut atoms: Atoms<'_, '_>) -> Option<(Spec, Vec<PredicateId>)> {
    let roles = atoms.roles;
    let mut found = Vec::new();
    for (id, role) in roles.iter() {
        let is_formula = matches!(role, Role::Formula { .. });
        found.push(if is_formula { atoms.atom(id) } else { None });
    }
    let mut leaves = Vec::new();
    for ((id, _), atom) in roles.iter().zip(found) {
        leaves.push(leaf(&mut atoms, id, atom));
    }
    let Atoms { lowering, propositions, .. } = atoms;
    let (predicates, positions) = numbered(&leaves);
    let named = |id: &PredicateId| propositions.named(&lowering.arena, *id);
    let spec = Spec::new(predicates.iter().map(named).collect());
    let mut builder = Builder { lowering, roles, spec, positions, built: Vec::new() };
    for ((id, role), leaf) in roles.iter().zip(leaves) {
        let formula = match role {
            Role::Formula { negated } => builder.formula(id, leaf, negated),
            _ => None,
        };
        builder.built.push(formula);
    }
    let root = builder.built.pop().flatten()?;
    builder.spec.set_root(root);
    Some((builder.spec, predicates))
}

/// The predicates of all leaves in the order of their first appearance, and the place of each.
fn numbered(leaves: &[Option<Leaf<'_>>]) -> (Vec<PredicateId>, Memo<PredicateId, u32>) {
    let (mut predicates, mut positions) = (Vec::new(), Memo::default());
    for leaf in leaves.iter().flatten() {
        let (Leaf::Conditions(literals) | Leaf::Task(_, literals)) = leaf;
        for literal in literals {
            if let Literal::Proposition(predicate, _) = *literal
                && positions.get(predicate).is_none()
            {
                positions.insert(predicate, predicates.len() as u32);
                predicates.push(predicate);
            }
        }
    }
    (predicates, positions)
}

/// A leaf with its literals.
fn leaf<'c>(atoms: &mut Atoms<'c, '_>, id: ExpressionId, atom: Option<Atom>) -> Option<Leaf<'c>> {
    let span = atoms.lowering.resolved.span(id);
    match atom? {
        Atom::Conditions(all) => {
            let literal = |condition| atoms.propositions.literal(atoms.lowering, condition, span);
            Some(Leaf::Conditions(all.into_iter().map(literal).collect()))
        }
        Atom::Task(task, arguments) => {
            let task = atoms.tasks[task.0 as usize].as_ref()?;
            let literals = atoms.propositions.literals(atoms.lowering, task, &arguments, id);
            Some(Leaf::Task(task, literals))
        }
    }
}

/// A spec under construction.
struct Builder<'c, 'r> {
    lowering: &'c mut Lowering<'r>,
    roles: &'c Roles,
    spec: Spec,
    /// The proposition of each predicate.
    positions: Memo<PredicateId, u32>,
    /// The formula of each expression so far, by its position in the item.
    built: Vec<Option<FormulaId>>,
}

impl Builder<'_, '_> {
    /// The formula of an expression, given those of its operands.
    fn formula(
        &mut self,
        id: ExpressionId,
        leaf: Option<Leaf<'_>>,
        negated: Option<ExpressionId>,
    ) -> Option<FormulaId> {
        let resolved = self.lowering.resolved;
        let span = resolved.span(id);
        match leaf {
            Some(Leaf::Conditions(all)) => self.conditions(&all, negated.is_some(), span),
            Some(Leaf::Task(task, literals)) => {
                if let (Some(by), Some(temporal)) = (negated, temporal(&task.spec)) {
                    let temporal = task.spec.span(temporal);
                    return self.lowering.refuse(negated_task(resolved, id, by, temporal));
                }
                Some(self.import(&task.spec, &literals, negated.is_some(), span))
            }
            None => self.operator(id, negated.is_some(), span),
        }
    }

    /// The formula of an operator. Under a negation `&&` and `||` are exchanged; temporal operators
    /// are never negated here.
    fn operator(&mut self, id: ExpressionId, negated: bool, span: Span) -> Option<FormulaId> {
        let of = |id| self.built[self.roles.position(id)];
        let spec = &mut self.spec;
        match self.lowering.resolved[id].expression {
            Expression::Prefix(op, operand) => {
                let operand = of(operand)?;
                match op {
                    Prefix::Eventually => Some(spec.eventually(operand, span)),
                    Prefix::Next => Some(spec.next(operand, span)),
                    Prefix::Not => Some(operand),
                    Prefix::Minus => None,
                }
            }
            Expression::Infix(op, left, right) => {
                let (left, right) = (of(left)?, of(right)?);
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
    fn conditions(&mut self, all: &[Literal], negated: bool, span: Span) -> Option<FormulaId> {
        let (spec, positions) = (&mut self.spec, &self.positions);
        let mut joined = None;
        for one in all {
            let one = literal(spec, positions, *one, negated, span);
            joined = Some(match joined {
                None => one,
                Some(before) if negated => spec.or(before, one, span),
                Some(before) => spec.and(before, one, span),
            });
        }
        joined
    }

    /// The formula of another task in this one. If it is negated it has no temporal operator, which
    /// was checked.
    fn import(
        &mut self,
        other: &Spec,
        literals: &[Literal],
        negated: bool,
        span: Span,
    ) -> FormulaId {
        let positions = &self.positions;
        let ids: Vec<_> = other.formulas().map(|(id, _)| id).collect();
        let images = self.spec.rebuild(other, &ids, &mut |spec, _, formula| match formula {
            Formula::True => spec.truth(!negated, span),
            Formula::False => spec.truth(negated, span),
            Formula::Literal { proposition, negated: not } => {
                literal(spec, positions, literals[proposition as usize], not != negated, span)
            }
            Formula::And(a, b) if negated => spec.or(a, b, span),
            Formula::Or(a, b) if negated => spec.and(a, b, span),
            other => spec.add(other, span),
        });
        images[other.root().0 as usize]
    }
}

/// A literal as a formula, negated or not.
fn literal(
    spec: &mut Spec,
    positions: &Memo<PredicateId, u32>,
    literal: Literal,
    negated: bool,
    span: Span,
) -> FormulaId {
    match literal {
        Literal::Truth(value) => spec.truth(value != negated, span),
        Literal::Proposition(predicate, reversed) => {
            let position = positions.get(predicate).unwrap_or_default();
            spec.literal(position, reversed != negated, span)
        }
    }
}

/// The first temporal operator that the root of `spec` depends on.
fn temporal(spec: &Spec) -> Option<FormulaId> {
    let reachable = spec.reachable();
    let mut formulas = spec.formulas().filter(|(id, _)| reachable[id.0 as usize]);
    formulas.find(|(_, formula)| formula.is_temporal()).map(|(id, _)| id)
}

/// The error for a negated task with a temporal operator.
fn negated_task(
    resolved: &Resolved<'_>,
    id: ExpressionId,
    by: ExpressionId,
    temporal: Span,
) -> Error {
    let text = resolved.quote(id);
    let message = format!("the task `{text}` is negated, and it has a temporal operator");
    Error::new(Kind::NegatedTemporal, message, resolved.operator(by))
        .related(resolved.span(id), "the negation reaches this task")
        .related(temporal, "no finite trajectory can ever rule this out")
        .help("only formulas without F, X, U and T can be negated")
}

/// The tasks of which `root` is a plain conjunction or disjunction; `None` if anything else is in
/// it.
pub(super) fn parts(
    resolved: &Resolved<'_>,
    root: ExpressionId,
) -> Option<(Connective, Vec<TaskId>)> {
    let (op, connective) = match &resolved[root].expression {
        Expression::Infix(Infix::And, ..) => (Infix::And, Connective::And),
        Expression::Infix(Infix::Or, ..) => (Infix::Or, Connective::Or),
        _ => return None,
    };
    let mut parts = Vec::new();
    let mut open = vec![root];
    while let Some(id) = open.pop() {
        match resolved[id].expression {
            Expression::Infix(found, left, right) if found == op => open.extend([right, left]),
            Expression::Name(Name::Item(item, _)) => {
                let is_task = matches!(resolved.item(item).kind, ItemKind::Task(..));
                parts.push(resolved.scope.task_id(item).filter(|_| is_task)?);
            }
            _ => return None,
        }
    }
    Some((connective, parts))
}

#[cfg(test)]
mod tests {
    use crate::check;
    use crate::source::Source;

    const FILE: &str = "enum Room { hall, attic }
        state S { x: f64, on: bool, room: Room, a: [bool; 2], t: [bool; Room] }
        predicate near(d: f64) = x < d
        predicate lit(r: Room) = t[r]
        task away = F x > 1
        task reach(d: f64) = F near(d)
        ";

    /// The formula of the last task; or the first mistake.
    fn spec(text: &str) -> String {
        match check::file(&Source::new("source", format!("{FILE}task it = {text}"))) {
            Ok(module) => module.tasks.last().unwrap().spec.to_string(),
            Err(errors) => errors.first().message().to_owned(),
        }
    }

    #[test]
    fn negations_are_pushed_inward_and_tasks_written_out() {
        for (text, expected) in [
            ("!(on && x < 3) U on", "(!on || !(x < 3)) U on"),
            ("!(on => x < 3)", "on && !(x < 3)"),
            ("on => F on", "!on || F on"),
            ("F (x < 3) && F (3 <= x)", "F (x < 3) && F !(x < 3)"),
            ("1 < x < 3", "x > 1 && x < 3"),
            ("!(1 < x < 3)", "!(x > 1) || !(x < 3)"),
            ("1 < x < 3 && 2 < 1", "false"),
            ("F (room == hall) && F (hall != room)", "F (room == hall) && F !(room == hall)"),
            ("reach(2) && away", "F near(2) && F (x > 1)"),
            ("for all r in Room: r != hall => F lit(r)", "F lit(attic)"),
            ("for some i in 0..2: X a[i]", "X a[0] || X a[1]"),
            ("!away", "the task `away` is negated, and it has a temporal operator"),
            ("lit(x)", "`x` is a number, but a value of an enumeration is needed here"),
            ("near(on)", "`on` is true or false, but a number is needed here"),
            ("near(1, 2)", "`near` takes 1 argument (a number), and there are 2"),
            ("near", "`near` takes 1 argument (a number)"),
            ("1 < x > 0", "a chain of comparisons points one way, but this one has `<` and `>`"),
        ] {
            assert_eq!(spec(text), expected, "{text}");
        }
    }
}
