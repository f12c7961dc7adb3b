//! Propositions: the predicates of a module, declared or not, and what they are with arguments.

use rustc_hash::FxHashMap;

use super::lower::Lowering;
use crate::error::{Error, Kind};
use crate::predicate::{Arguments, Condition, ConditionId, Predicate, PredicateId, Task};
use crate::resolve::{ExpressionId, MOST_NODES};
use crate::source::Span;

/// The predicates of a module in the making.
pub(super) struct Propositions {
    pub(super) predicates: Vec<Predicate>,
    /// The predicate that each item declares.
    pub(super) declared: Vec<Option<PredicateId>>,
    /// What conditions are known to be.
    known: FxHashMap<ConditionId, Literal>,
    /// What conditions with parameters are with arguments.
    instances: FxHashMap<(ConditionId, Arguments), ConditionId>,
    /// How many more operators and operands these may have, written out.
    room: Option<usize>,
}

/// What a condition is as a part of a formula.
#[derive(Clone, Copy)]
pub(super) enum Literal {
    /// A constant.
    Truth(bool),
    /// A predicate, or its negation.
    Proposition(PredicateId, bool),
}

impl Propositions {
    pub(super) fn new(items: usize) -> Self {
        Self {
            predicates: Vec::new(),
            declared: vec![None; items],
            known: FxHashMap::default(),
            instances: FxHashMap::default(),
            room: Some(MOST_NODES),
        }
    }

    pub(super) fn add(&mut self, predicate: Predicate) -> PredicateId {
        let id = u32::try_from(self.predicates.len()).expect("fewer than 2^32 predicates");
        self.predicates.push(predicate);
        PredicateId(id)
    }

    pub(super) fn predicate(&self, id: PredicateId) -> &Predicate {
        &self.predicates[id.0 as usize]
    }

    /// What a condition is: a predicate without a name of its own, if it is new.
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

    /// Notes all the ways to say that `condition` is the predicate `id` or its negation.
    fn remember(&mut self, lowering: &mut Lowering<'_>, condition: ConditionId, id: PredicateId) {
        self.known.insert(condition, Literal::Proposition(id, false));
        let Condition::Compare(op, left, right) = *lowering.arena.condition(condition) else {
            return;
        };
        for (op, left, right) in [(op, left, right), (op.mirrored(), right, left)] {
            for (op, negated) in [(op, false), (op.negated(), true)] {
                let same = lowering.arena.add_condition(Condition::Compare(op, left, right));
                self.known.insert(same, Literal::Proposition(id, negated));
            }
        }
    }

    /// A condition with arguments in the place of parameters; `None` where that is too large to be
    /// written out, which is reported once.
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
        self.instances.insert(key, condition);
        Some(condition)
    }

    /// What the predicates of a task are with the arguments that `id` gives.
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
