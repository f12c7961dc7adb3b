//! Predicates of a state one row at a time, straight from the arenas: the oracle of the evaluator
//! that works on columns, and what that is measured against.

use tltl_compiler::ast::Comparison;
use tltl_compiler::predicate::{
    Condition, ConditionId, Function, Module, Number, PredicateId, Task, Term, TermId,
};
use tltlc::evaluate::Input;

/// What the predicates of a task say of one state, by proposition.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Reading {
    /// The robustness of each.
    pub(crate) robustness: Vec<f64>,
    /// Whether each holds.
    pub(crate) holds: Vec<bool>,
}

/// The predicates of a task; one pass over the arenas a state, operands first.
pub(crate) struct Rowwise<'a> {
    module: &'a Module,
    /// The condition of each proposition.
    roots: Vec<ConditionId>,
    /// What the roots need, operands first.
    conditions: Vec<ConditionId>,
    terms: Vec<TermId>,
    /// The input that a term is, and that a free proposition is.
    read_terms: Vec<(TermId, usize)>,
    read_conditions: Vec<(ConditionId, usize)>,
    /// The value of each term, the robustness and truth of each condition, by number.
    numbers: Vec<f64>,
    values: Vec<(f64, bool)>,
}

impl<'a> Rowwise<'a> {
    /// The predicates of `task`, which is one of `module` and reads `inputs`.
    pub(crate) fn new(module: &'a Module, task: &Task, inputs: &[Input]) -> Self {
        let root = |id: &PredicateId| module.predicates[id.0 as usize].condition;
        let roots: Vec<_> = task.predicates.iter().map(root).collect();
        let conditions = module.conditions_of(roots.clone());
        let terms = module.terms_of(&conditions);
        let place = |name: &str| inputs.iter().position(|input| input.name == name);
        let read_term = |&id: &TermId| match module.arena.term(id) {
            Term::Place { .. } => Some((id, place(&module.display_term(id).to_string())?)),
            Term::Variable(name) => Some((id, place(name)?)),
            _ => None,
        };
        let read_condition = |&id: &ConditionId| match module.arena.condition(id) {
            Condition::Free(name) => Some((id, place(name)?)),
            _ => None,
        };
        Self {
            read_terms: terms.iter().filter_map(read_term).collect(),
            read_conditions: conditions.iter().filter_map(read_condition).collect(),
            numbers: vec![0.0; module.arena.terms().len()],
            values: vec![(0.0, false); module.arena.conditions().len()],
            module,
            roots,
            conditions,
            terms,
        }
    }

    /// What the predicates say of a state; the number of the first that is not a number.
    pub(crate) fn read(&mut self, inputs: &[f64]) -> Result<Reading, u32> {
        for &(id, input) in &self.read_terms {
            self.numbers[id.0 as usize] = inputs[input];
        }
        for &(id, input) in &self.read_conditions {
            self.values[id.0 as usize] = (inputs[input], inputs[input] > 0.0);
        }
        for &id in &self.terms {
            self.numbers[id.0 as usize] = self.number(id);
        }
        for &id in &self.conditions {
            self.values[id.0 as usize] = self.value(id);
        }
        let mut reading = Reading::default();
        for (proposition, root) in (0..).zip(&self.roots) {
            let (rho, holds) = self.values[root.0 as usize];
            if rho.is_nan() {
                return Err(proposition);
            }
            reading.robustness.push(rho);
            reading.holds.push(holds);
        }
        Ok(reading)
    }

    fn number(&self, id: TermId) -> f64 {
        let of = |id: TermId| self.numbers[id.0 as usize];
        match *self.module.arena.term(id) {
            Term::Number(Number(value)) => value,
            Term::Variant { number, .. } => f64::from(number),
            Term::Absent => -1.0,
            Term::Truth(value) => f64::from(u8::from(value)),
            Term::Place { .. } | Term::Variable(_) => of(id),
            Term::Host { .. } | Term::Parameter { .. } => panic!("this is not read here"),
            Term::Negate(a) => -of(a),
            Term::Calculate(operator, a, b) => operator.value(of(a), of(b)),
            Term::Call(Function::Min, a, Some(b)) => least(of(a), of(b)),
            Term::Call(Function::Max, a, Some(b)) => greatest(of(a), of(b)),
            Term::Call(function, a, b) => function.value(of(a), b.map_or(0.0, of)),
        }
    }

    fn value(&self, id: ConditionId) -> (f64, bool) {
        let of = |id: ConditionId| self.values[id.0 as usize];
        let number = |id: TermId| self.numbers[id.0 as usize];
        let truth = |holds: bool| (if holds { 1.0 } else { -1.0 }, holds);
        match *self.module.arena.condition(id) {
            Condition::Truth(true) => (f64::INFINITY, true),
            Condition::Truth(false) => (f64::NEG_INFINITY, false),
            Condition::Not(a) => (-of(a).0, !of(a).1),
            Condition::And(a, b) => (least(of(a).0, of(b).0), of(a).1 & of(b).1),
            Condition::Or(a, b) => (greatest(of(a).0, of(b).0), of(a).1 | of(b).1),
            Condition::Compare(comparison, a, b) if self.module.arena.is_value(a) => {
                truth(comparison.holds(number(a), number(b)))
            }
            Condition::Compare(comparison, a, b) => compare(comparison, number(a), number(b)),
            Condition::Apply { meaning, .. } => of(meaning),
            Condition::Bool(place) => truth(number(place) != 0.0),
            Condition::Is(predicate) => of(self.module.predicates[predicate.0 as usize].condition),
            Condition::Free(_) => of(id),
            Condition::Value { .. } => panic!("this is not read here"),
        }
    }
}

/// The lesser of two numbers; NaN if one of them is.
fn least(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The greater of two numbers; NaN if one of them is.
fn greatest(a: f64, b: f64) -> f64 {
    if a > b || a.is_nan() { a } else { b }
}

/// Robustness and truth; the truth is that of the difference, as generated code has it.
fn compare(comparison: Comparison, a: f64, b: f64) -> (f64, bool) {
    let rho = match comparison {
        Comparison::Less | Comparison::AtMost => b - a,
        Comparison::Greater | Comparison::AtLeast => a - b,
        Comparison::Equal => -(a - b).abs(),
        Comparison::Unequal => (a - b).abs(),
    };
    let holds = match comparison {
        Comparison::Less | Comparison::Greater | Comparison::Unequal => rho > 0.0,
        Comparison::AtMost | Comparison::AtLeast | Comparison::Equal => rho >= 0.0,
    };
    (rho, holds)
}
