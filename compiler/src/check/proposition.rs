//! Propositions: the predicates of a module, declared or not, and their instances with arguments.
//!
//! Every condition in a formula becomes a predicate, and equal conditions the same one. A
//! comparison is known in four ways (either side first, negated or not), so `x < 3` and `3 <= x`
//! are one proposition and its negation: this saves a proposition, and with it up to half of the
//! automaton's letters.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "F (x < 3) && F (3 <= x) && F (3 > x)"))?;
//! assert_eq!(module.tasks[0].spec.propositions(), ["x < 3"]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::lower::Lowering;
use crate::error::{Error, Kind};
use crate::intern::Map;
use crate::predicate::{Arena, Arguments, Condition, ConditionId, Predicate, PredicateId, Task};
use crate::proposition::{Proposition, Shape};
use crate::resolve::{ExpressionId, MOST_NODES};
use crate::source::Span;

/// The predicates of a module under construction.
pub(super) struct Propositions {
    pub(super) predicates: Vec<Predicate>,
    /// The predicate that each item declares, if it does.
    pub(super) declared: Vec<Option<PredicateId>>,
    /// The literals of conditions that have been met.
    known: Map<ConditionId, Literal>,
    /// The conditions that have been instantiated, so that equal uses are one.
    instances: Map<(ConditionId, Arguments), ConditionId>,
    /// The number of operators and operands that further instances may have, written out; `None`
    /// once it is exceeded.
    room: Option<usize>,
}

/// A condition as a part of a formula.
#[derive(Clone, Copy)]
pub(super) enum Literal {
    /// A constant.
    Truth(bool),
    /// A predicate, and whether it is negated.
    Proposition(PredicateId, bool),
}

impl Propositions {
    /// No predicates, for a source of this many items.
    pub(super) fn new(items: usize) -> Self {
        Self {
            predicates: Vec::new(),
            declared: vec![None; items],
            known: Map::default(),
            instances: Map::default(),
            room: Some(MOST_NODES),
        }
    }

    /// Adds a predicate.
    pub(super) fn add(&mut self, predicate: Predicate) -> PredicateId {
        let id = u32::try_from(self.predicates.len()).expect("fewer than 2^32 predicates");
        self.predicates.push(predicate);
        PredicateId(id)
    }

    /// One predicate.
    pub(super) fn predicate(&self, id: PredicateId) -> &Predicate {
        &self.predicates[id.0 as usize]
    }

    /// A predicate as a proposition.
    pub(super) fn named(&self, arena: &Arena, id: PredicateId) -> Proposition {
        let predicate = self.predicate(id);
        let shape = match arena.condition(predicate.condition) {
            _ if predicate.declared => Shape::Atom,
            Condition::Compare(..) => Shape::Comparison,
            Condition::Not(_) | Condition::And(..) | Condition::Or(..) => Shape::Compound,
            _ => Shape::Atom,
        };
        Proposition { name: predicate.name.clone(), shape }
    }

    /// The literal of a condition, which becomes a predicate without a name of its own if it is
    /// new.
    pub(super) fn literal(
        &mut self,
        lowering: &mut Lowering<'_>,
        condition: ConditionId,
        span: Span,
    ) -> Literal {
        if let Some(known) = self.known.get(&condition) {
            return *known;
        }
        match *lowering.arena.condition(condition) {
            Condition::Truth(value) => Literal::Truth(value),
            Condition::Is(predicate) => Literal::Proposition(predicate, false),
            _ => {
                let name = lowering.arena.display_condition(condition, &self.predicates);
                let id = self.add(Predicate {
                    name: name.to_string(),
                    declared: false,
                    parameters: Vec::new(),
                    docs: Vec::new(),
                    span,
                    condition,
                });
                self.remember(lowering, condition, id);
                Literal::Proposition(id, false)
            }
        }
    }

    /// Notes all the ways to write the predicate `id` and its negation.
    fn remember(&mut self, lowering: &mut Lowering<'_>, condition: ConditionId, id: PredicateId) {
        self.known.get_or_insert(condition, Literal::Proposition(id, false));
        let Condition::Compare(op, left, right) = *lowering.arena.condition(condition) else {
            return;
        };
        for (op, left, right) in [(op, left, right), (op.mirrored(), right, left)] {
            for (op, negated) in [(op, false), (op.negated(), true)] {
                let same = lowering.arena.add_condition(Condition::Compare(op, left, right));
                self.known.get_or_insert(same, Literal::Proposition(id, negated));
            }
        }
    }

    /// A condition with arguments in place of parameters; `None` if the conditions with arguments
    /// become too large when written out, which is reported once.
    pub(super) fn substituted(
        &mut self,
        lowering: &mut Lowering<'_>,
        condition: ConditionId,
        arguments: &Arguments,
        id: ExpressionId,
    ) -> Option<ConditionId> {
        let key = (condition, arguments.clone());
        if let Some(known) = self.instances.get(&key) {
            return Some(*known);
        }
        let room = self.room?;
        let condition = lowering.arena.substitute(condition, arguments);
        self.room = room.checked_sub(lowering.arena.written_size(condition));
        if self.room.is_none() {
            let message = format!(
                "written out, the predicates with arguments have more than {MOST_NODES} operators and operands"
            );
            return lowering.refuse(
                Error::new(Kind::Budget, message, lowering.resolved.span(id))
                    .label("up to here")
                    .help("each use of a predicate is written out with its arguments, so a chain of definitions that use one another twice doubles at each step"),
            );
        }
        self.instances.get_or_insert(key, condition);
        Some(condition)
    }

    /// The literals of the predicates of a task with the arguments that `id` gives.
    pub(super) fn literals(
        &mut self,
        lowering: &mut Lowering<'_>,
        task: &Task,
        arguments: &Arguments,
        id: ExpressionId,
    ) -> Vec<Literal> {
        let mut literal = |predicate: &PredicateId| {
            let Predicate { declared, span, condition, .. } = *self.predicate(*predicate);
            if declared || arguments.is_empty() {
                return Literal::Proposition(*predicate, false);
            }
            match self.substituted(lowering, condition, arguments, id) {
                Some(condition) => self.literal(lowering, condition, span),
                None => Literal::Truth(false),
            }
        };
        task.predicates.iter().map(&mut literal).collect()
    }
}
