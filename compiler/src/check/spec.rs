//! Tasks: an expression as a [`Spec`] in negation normal form.
//!
//! Propositions are numbered in the order of their first appearance, which becomes the order of the
//! decision diagrams' levels. Therefore the leaves are all read first, and the formula is built in
//! a second pass. A task that another one uses is copied into it, its propositions mapped: an
//! automaton is built for each task as a whole.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state S { a: bool, b: bool, c: bool }
//! task both = F b && F a
//! task all = F c && both";
//! let module = check::file(&Source::new("s.tltl", text))?;
//! assert_eq!(module.tasks[1].spec.propositions(), ["c", "b", "a"]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::atom::{Atom, Atoms};
use super::bound;
use super::lower::Lowering;
use super::proposition::Literal;
use super::role::{Role, Roles};
use crate::arena::{self, Memo};
use crate::ast::{Infix, ItemKind, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{Connective, PredicateId, Task, TaskId};
use crate::resolve::{Expression, ExpressionId, MOST_NODES, Name, Resolved};
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
    let (built, negations, room) = (Vec::new(), Memo::default(), MOST_NODES);
    let mut builder = Builder { lowering, roles, spec, positions, built, negations, room };
    for ((id, role), leaf) in roles.iter().zip(leaves) {
        let formula = match role {
            Role::Formula { negated, state } => builder.formula(id, leaf, negated, state),
            Role::Idle => Some(builder.spec.truth(true, builder.lowering.resolved.span(id))),
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
    /// The negations of state formulas so far.
    negations: Memo<FormulaId, FormulaId>,
    /// The operators that `ensuring` may still go through: where one stands in another, each goes
    /// through all that is below it.
    room: usize,
}

impl Builder<'_, '_> {
    /// The formula of an expression, given those of its operands.
    fn formula(
        &mut self,
        id: ExpressionId,
        leaf: Option<Leaf<'_>>,
        negated: Option<ExpressionId>,
        state: Option<ExpressionId>,
    ) -> Option<FormulaId> {
        let resolved = self.lowering.resolved;
        let span = resolved.span(id);
        match leaf {
            Some(Leaf::Conditions(all)) => self.conditions(&all, negated.is_some(), span),
            Some(Leaf::Task(task, literals)) => {
                let temporal = || {
                    let operator = temporal(&task.spec).map(|temporal| task.spec.span(temporal));
                    operator.or_else(|| ensuring(resolved, id))
                };
                if let Some(by) = state.or(negated)
                    && let Some(temporal) = temporal()
                {
                    return self.lowering.refuse(temporal_task(resolved, id, by, temporal));
                }
                Some(self.import(&task.spec, &literals, negated.is_some(), span))
            }
            None => self.operator(id, negated.is_some(), span),
        }
    }

    /// The formula of an operator. Under a negation `&&` and `||` are exchanged; of the temporal
    /// operators, only those that a negation makes co-safe are negated here.
    fn operator(&mut self, id: ExpressionId, negated: bool, span: Span) -> Option<FormulaId> {
        let resolved = self.lowering.resolved;
        let of = |id| self.built[self.roles.position(id)];
        match resolved[id].expression {
            Expression::Prefix(op, operand) => self.prefix(id, op, of(operand)?, span),
            Expression::Infix(op, left, right) => {
                self.infix(id, (op, negated), [of(left)?, of(right)?], span)
            }
            _ => None,
        }
    }

    /// The formula of an operator before its operand.
    fn prefix(
        &mut self,
        id: ExpressionId,
        op: Prefix,
        a: FormulaId,
        span: Span,
    ) -> Option<FormulaId> {
        let spec = &mut self.spec;
        let window = bound::window(self.lowering.resolved, id).ok()?;
        Some(match (op, window) {
            (Prefix::Not, _) => a,
            (Prefix::Next, None) => spec.next(a, span),
            (Prefix::Next, Some(window)) => spec.delay(*window.start(), a, span),
            // `G` without a bound is negated: it is `F` of the negation.
            (Prefix::Eventually | Prefix::Always, None) => spec.eventually(a, span),
            (Prefix::Eventually, Some(window)) => spec.eventually_in(window, a, span),
            (Prefix::Always, Some(window)) => spec.throughout_in(window, a, span),
            (Prefix::Minus, _) => return None,
        })
    }

    /// The formula of an operator between its operands, which may be negated.
    fn infix(
        &mut self,
        id: ExpressionId,
        (op, negated): (Infix, bool),
        [a, b]: [FormulaId; 2],
        span: Span,
    ) -> Option<FormulaId> {
        let spec = &mut self.spec;
        let window = bound::window(self.lowering.resolved, id).ok()?;
        Some(match (op, window) {
            (Infix::And, _) if negated => spec.or(a, b, span),
            (Infix::And, _) => spec.and(a, b, span),
            (Infix::Or | Infix::Implies, _) if negated => spec.and(a, b, span),
            (Infix::Or | Infix::Implies, _) => spec.or(a, b, span),
            (Infix::Iff, _) => self.both_or_neither(a, b, negated, span),
            (Infix::Until, Some(window)) => spec.until_in(window, a, b, span),
            (Infix::Then, Some(window)) => spec.then_in(window, a, b, span),
            // Under a negation: !φ U !ψ.
            (Infix::Until | Infix::Release, None) => spec.until(a, b, span),
            (Infix::Then, None) => spec.then(a, b, span),
            // Under a negation: !ψ U (!φ && !ψ).
            (Infix::WeakUntil, _) => {
                let both = spec.and(a, b, span);
                spec.until(b, both, span)
            }
            (Infix::Ensuring, _) => return self.ensuring(id, [a, b], span),
            _ => return None,
        })
    }

    /// `a ensuring b`.
    fn ensuring(
        &mut self,
        id: ExpressionId,
        [a, b]: [FormulaId; 2],
        span: Span,
    ) -> Option<FormulaId> {
        let spec = &mut self.spec;
        let parts = arena::needed(vec![a.0], &mut |id, open| {
            open.extend(spec.formula(FormulaId(id)).operands().map(|operand| operand.0));
        });
        let Some(room) = self.room.checked_sub(parts.len()) else {
            let message =
                format!("written out, `ensuring` goes through more than {MOST_NODES} operators");
            let operator = self.lowering.resolved.operator(id);
            let error = Error::new(Kind::Budget, message, operator);
            return self
                .lowering
                .refuse(error.help(
                    "nest fewer of them: `(… ensuring p) ensuring q` is `… ensuring p && q`",
                ));
        };
        self.room = room;
        Some(spec.ensuring(a, b, span))
    }

    /// `a <=> b` of state formulas, or its negation.
    fn both_or_neither(
        &mut self,
        a: FormulaId,
        b: FormulaId,
        negated: bool,
        span: Span,
    ) -> FormulaId {
        let (not_a, not_b) = (self.negation(a, span), self.negation(b, span));
        let (b, not_b) = if negated { (not_b, b) } else { (b, not_b) };
        let (one, two) = (self.spec.and(a, b, span), self.spec.and(not_a, not_b, span));
        self.spec.or(one, two, span)
    }

    /// The negation of a state formula; what has been negated before is looked up, so a chain of
    /// `<=>` costs no more than its length.
    fn negation(&mut self, id: FormulaId, span: Span) -> FormulaId {
        let parts = arena::needed(vec![id.0], &mut |id, open| {
            if self.negations.get(FormulaId(id)).is_none() {
                open.extend(self.spec.formula(FormulaId(id)).operands().map(|operand| operand.0));
            }
        });
        for part in parts.into_iter().map(FormulaId) {
            if self.negations.get(part).is_none() {
                let negation = self.negated(part, span);
                self.negations.insert(part, negation);
            }
        }
        self.negations.get(id).expect("it has been negated")
    }

    /// The negation of one operator of a state formula, whose operands have been negated.
    fn negated(&mut self, id: FormulaId, span: Span) -> FormulaId {
        let of = |id| self.negations.get(id).expect("operands are negated first");
        match self.spec.formula(id) {
            Formula::True => self.spec.truth(false, span),
            Formula::False => self.spec.truth(true, span),
            Formula::Literal { proposition, negated } => {
                self.spec.literal(proposition, !negated, span)
            }
            Formula::And(a, b) => self.spec.or(of(a), of(b), span),
            Formula::Or(a, b) => self.spec.and(of(a), of(b), span),
            _ => id,
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

/// An `ensuring` in the task that `id` names. It makes a task of a state formula too, though nothing
/// of it is left in the spec then.
fn ensuring(resolved: &Resolved<'_>, id: ExpressionId) -> Option<Span> {
    let item = match &resolved[id].expression {
        Expression::Name(Name::Item(item, _)) => *item,
        Expression::Call(callee, _) => callee.item?,
        _ => return None,
    };
    let (first, root) = resolved.expressions[item]?;
    let is_one = |id: &ExpressionId| {
        matches!(resolved[*id].expression, Expression::Infix(Infix::Ensuring, ..))
    };
    (first.0..=root.0).map(ExpressionId).find(is_one).map(|id| resolved.operator(id))
}

/// The error for a task with a temporal operator under `by`, which negates it or needs a formula of
/// one state.
fn temporal_task(
    resolved: &Resolved<'_>,
    id: ExpressionId,
    by: ExpressionId,
    temporal: Span,
) -> Error {
    let text = resolved.quote(id);
    let (kind, message) = match resolved[by].expression {
        Expression::Infix(Infix::Ensuring, ..) => (
            Kind::Syntax,
            format!(
                "the right side of `ensuring` speaks of one state, and the task `{text}` of more"
            ),
        ),
        _ => (
            Kind::NegatedTemporal,
            format!("the task `{text}` is negated, and it has a temporal operator"),
        ),
    };
    let error = Error::new(kind, message, resolved.operator(by));
    if kind == Kind::Syntax {
        return error.related(temporal, "this looks at more than one state");
    }
    error
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
        struct Wrench { F: f64, T: [f64; 2] }
        enum Letter { F, G }
        state S { wrench: Wrench, letter: Letter, G: f64, x: f64, on: bool, room: Room, a: [bool; 2], t: [bool; Room] }
        step 0.1 s
        predicate held = wrench.F > 3 && wrench.T[1] > 0
        predicate calm = X[0] (x < 1) && !G[0 s] on
        const few = 2 + 1
        const late in s = 0.4
        const halved = few / 2
        predicate near(d: f64) = x < d
        predicate lit(r: Room) = t[r]
        task away = F x > 1
        task reach(d: f64) = F near(d)
        task kept = on ensuring x < 1
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
            ("kept", "on && x < 1"),
            ("!kept", "the task `kept` is negated, and it has a temporal operator"),
            ("!away", "the task `away` is negated, and it has a temporal operator"),
            ("lit(x)", "`x` is a number, but a value of an enumeration is needed here"),
            ("near(on)", "`on` is true or false, but a number is needed here"),
            ("near(1, 2)", "`near` takes 1 argument (a number), and there are 2"),
            ("near", "`near` takes 1 argument (a number)"),
            ("1 < x > 0", "a chain of comparisons points one way, but this one has `<` and `>`"),
            ("on == a[0]", "(on && a[0]) || (!on && !a[0])"),
            ("on != lit(hall)", "(on && !lit(hall)) || (!on && lit(hall))"),
            ("on == a[0] == a[1]", "truth values are compared two at a time"),
            ("on == x", "`on` is true or false, but a number is needed here"),
            ("F calm && !F[0,0] calm", "F calm && !calm"),
            ("F held && F (letter == Letter::F)", "F held && F (letter == F)"),
            ("F (G > 1) && F[1,2] (G[0,1] (G > 2))", "F (G > 1) && F[1,2] G[0,1] (G > 2)"),
            ("F[0,few] on", "F[0,3] on"),
            ("F[few, 0.4 s] on", "`few` counts steps, and the other end of this bound is a time"),
            ("F[0.1 s, late] on", "F[1,4] on"),
            ("X[0.45 s] on", "`0.45 s` lies between two instants"),
            (
                "F[0.41 s, 0.49 s] on",
                "the bound `[0.41 s, 0.49 s]` is empty: no instant lies in it",
            ),
            ("G[0 s, 0.399 s] on", "G[0,3] on"),
            ("for all i in 1..3: F[i, 4] on", "F[1,4] on && F[2,4] on"),
            ("for all i in {2, few}: X[i] on", "X[2] on && X[3] on"),
            ("F[room] on", "`room` is not known when the source is compiled"),
            ("F[halved] on", "`halved` is not a whole number, and a bound counts steps"),
            (
                "F on ensuring reach(2)",
                "the right side of `ensuring` speaks of one state, and the task `reach(2)` of more",
            ),
        ] {
            assert_eq!(spec(text), expected, "{text}");
        }
    }
}
