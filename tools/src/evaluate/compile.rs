//! Compiles the predicates of a task, and its formula, into straight-line programs.
//!
//! It walks the arenas of conditions and terms once, operands first, and emits one step for each
//! operation, so shared subexpressions are computed once. The steps are those of the generated
//! code, one by one (`emit::predicates` of the compiler): nothing is reordered, folded or
//! simplified, because rounding would differ then. The walks use no recursion: formulas nest as
//! deep as their authors like.

use std::hash::Hash;

use rustc_hash::{FxHashMap, FxHashSet};
use tltl_compiler::ast::{Arithmetic, Comparison};
use tltl_compiler::predicate::{
    Condition, ConditionId, Function, Module, Number, Scalar, State, Step as PlaceStep, Struct,
    Task, Term, TermId, Type,
};
use tltl_compiler::unit::Unit;

use super::program::{Operand, Operation, Program};
use super::steps::Steps;
use super::{Input, InputKind, Unreadable};

/// The reading of a predicate that is computed: a number, or a truth value.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Reading {
    Robustness,
    Truth,
}

/// The inputs of a task, and the input that each term and each free proposition is.
pub(super) struct Inputs {
    pub(super) inputs: Vec<Input>,
    of_terms: FxHashMap<TermId, usize>,
    of_conditions: FxHashMap<ConditionId, usize>,
}

impl Inputs {
    /// Finds the inputs of some conditions, in the order in which the arena has them.
    ///
    /// # Errors
    /// If one of the conditions is Rust code, names a parameter, or indexes an array by a field.
    pub(super) fn find(module: &Module, roots: &[ConditionId]) -> Result<Self, Unreadable> {
        let mut found = Self {
            inputs: Vec::new(),
            of_terms: FxHashMap::default(),
            of_conditions: FxHashMap::default(),
        };
        let conditions = module.conditions_of(roots.to_vec());
        for id in module.terms_of(&conditions) {
            if let Some(input) = term_input(module, id)? {
                let place = found.place(input);
                found.of_terms.insert(id, place);
            }
        }
        for id in conditions {
            match module.arena.condition(id) {
                Condition::Free(name) => {
                    let place = found.place(plain(name, InputKind::Proposition));
                    found.of_conditions.insert(id, place);
                }
                Condition::Value { text, .. } => return Err(Unreadable::Rust(text.clone())),
                _ => {}
            }
        }
        Ok(found)
    }

    /// The index of an input, which is added if it is new. Two terms with one text are one input.
    fn place(&mut self, input: Input) -> usize {
        let known = self.inputs.iter().position(|other| *other == input);
        known.unwrap_or_else(|| {
            self.inputs.push(input);
            self.inputs.len() - 1
        })
    }
}

/// The input that a term is; `None` if it is computed from others.
fn term_input(module: &Module, id: TermId) -> Result<Option<Input>, Unreadable> {
    match module.arena.term(id) {
        Term::Place { steps, scalar } => {
            let name = module.display_term(id).to_string();
            if !is_fixed(module, id) {
                return Err(Unreadable::Element(name));
            }
            let values = match *scalar {
                Scalar::Enum { of, .. } => module.enums[of as usize].variants.clone(),
                _ => Vec::new(),
            };
            let unit = unit(module, steps).map(|unit| module.units.text(unit));
            Ok(Some(Input { name, kind: InputKind::Place(*scalar), unit, values }))
        }
        Term::Variable(name) => Ok(Some(plain(name, InputKind::Variable))),
        Term::Host { text, .. } => Err(Unreadable::Rust(text.clone())),
        Term::Parameter { name, .. } => Err(Unreadable::Parameter(name.clone())),
        _ => Ok(None),
    }
}

/// An input of a bare formula: it has no unit and no named values. A name in quotes is a column
/// without them.
fn plain(name: &str, kind: InputKind) -> Input {
    let quoted = name.strip_prefix('"').and_then(|name| name.strip_suffix('"'));
    let name = quoted.unwrap_or(name).to_owned();
    Input { name, kind, unit: None, values: Vec::new() }
}

/// The unit of a place: that of the last field on the way to it.
fn unit<'a>(module: &'a Module, steps: &[PlaceStep]) -> Option<&'a Unit> {
    let State::Declared(state) = &module.state else { return None };
    let (mut declared, mut unit) = (state, None);
    for step in steps {
        let PlaceStep::Field(name) = step else { continue };
        let field = declared.fields.iter().find(|field| field.name == *name)?;
        unit = field.unit.as_ref();
        declared = structure(module, &field.ty).unwrap_or(declared);
    }
    unit
}

/// The struct of a type, or of the elements of an array.
fn structure<'a>(module: &'a Module, ty: &Type) -> Option<&'a Struct> {
    match ty {
        Type::Scalar(_) => None,
        Type::Struct(place) => module.structs.get(*place as usize),
        Type::Array(element, _) | Type::Table(element, _) => structure(module, element),
    }
}

/// Whether no index on the way to a place depends on the state. An index that does would have to be
/// followed row by row.
fn is_fixed(module: &Module, place: TermId) -> bool {
    let varies = |id: &TermId| matches!(module.arena.term(*id), Term::Place { .. });
    !module.arena.term(place).operands().iter().any(varies)
}

/// Compiles predicates: predicate i of `roots` is output i.
pub(super) fn predicates(
    module: &Module,
    inputs: &Inputs,
    roots: &[ConditionId],
    reading: Reading,
) -> Program {
    let mut compiler = Compiler::new(module, inputs, reading);
    compiler.predicates(roots);
    compiler.steps.program()
}

/// Compiles the formula of a task: the outputs are the robustness of each predicate, and after
/// these the robustness of the formula on the trajectory from each row on.
pub(super) fn formula(
    module: &Module,
    inputs: &Inputs,
    roots: &[ConditionId],
    task: &Task,
) -> Program {
    let mut compiler = Compiler::new(module, inputs, Reading::Robustness);
    let predicates = compiler.predicates(roots);
    compiler.steps.formula(&task.spec, &predicates, predicates.len() as u32);
    compiler.steps.program()
}

/// The steps so far, and the results that are known.
struct Compiler<'a> {
    module: &'a Module,
    inputs: &'a Inputs,
    reading: Reading,
    steps: Steps,
    terms: FxHashMap<TermId, Operand>,
    conditions: FxHashMap<ConditionId, Operand>,
}

impl<'a> Compiler<'a> {
    fn new(module: &'a Module, inputs: &'a Inputs, reading: Reading) -> Self {
        Self {
            module,
            inputs,
            reading,
            steps: Steps::default(),
            terms: FxHashMap::default(),
            conditions: FxHashMap::default(),
        }
    }

    /// Emits every predicate as soon as it is known, so that its register is free again if the
    /// formula does not need it.
    fn predicates(&mut self, roots: &[ConditionId]) -> Vec<Operand> {
        let mut known = Vec::with_capacity(roots.len());
        for (output, &root) in (0..).zip(roots) {
            let operand = self.condition(root);
            let operand = self.steps.result(operand);
            self.steps.unary(Operation::Emit(output), operand);
            known.push(operand);
        }
        known
    }

    /// The operand that a condition is, after the steps for what it needs and is not known yet.
    fn condition(&mut self, root: ConditionId) -> Operand {
        for id in ordered(root, &self.conditions, |id| self.operands(id)) {
            let operand = self.one_condition(id);
            self.conditions.insert(id, operand);
        }
        self.conditions[&root]
    }

    /// The conditions that must be known first; a predicate by name stands for its own condition.
    fn operands(&self, id: ConditionId) -> Vec<ConditionId> {
        match self.module.arena.condition(id) {
            Condition::Is(predicate) => {
                vec![self.module.predicates[predicate.0 as usize].condition]
            }
            condition => condition.operands(),
        }
    }

    /// The steps for one condition whose operands are known.
    fn one_condition(&mut self, id: ConditionId) -> Operand {
        let of = |id: ConditionId| self.conditions[&id];
        match *self.module.arena.condition(id) {
            Condition::Truth(value) => self.truth(value),
            Condition::Not(a) => self.steps.unary(Operation::Negate, of(a)),
            Condition::And(a, b) => self.steps.step(Operation::Least, of(a), of(b)),
            Condition::Or(a, b) => self.steps.step(Operation::Greatest, of(a), of(b)),
            Condition::Compare(comparison, a, b) => {
                let operands = (self.term(a), self.term(b));
                if self.module.arena.is_value(a) {
                    self.values(comparison, operands)
                } else {
                    self.compare(comparison, operands)
                }
            }
            Condition::Apply { meaning, .. } => of(meaning),
            Condition::Bool(place) => {
                let place = self.term(place);
                self.values(Comparison::Unequal, (place, Operand::Constant(0.0)))
            }
            Condition::Is(predicate) => of(self.module.predicates[predicate.0 as usize].condition),
            Condition::Free(_) | Condition::Value { .. } => {
                let rho = self.input(self.inputs.of_conditions[&id]);
                self.compare(Comparison::Greater, (rho, Operand::Constant(0.0)))
            }
        }
    }

    /// A constant: ±∞ as robustness, ±1 as truth value.
    fn truth(&self, value: bool) -> Operand {
        let size = if self.reading == Reading::Robustness { f64::INFINITY } else { 1.0 };
        Operand::Constant(if value { size } else { -size })
    }

    /// The equality of two values of an enumeration or two truth values: its robustness is ±1.
    fn values(&mut self, comparison: Comparison, (a, b): (Operand, Operand)) -> Operand {
        let same = self.steps.step(Operation::Same, a, b);
        match comparison {
            Comparison::Unequal => self.steps.unary(Operation::Negate, same),
            _ => same,
        }
    }

    /// The comparison of two numbers. The difference decides its truth too, so that robustness and
    /// truth never disagree after rounding.
    fn compare(&mut self, comparison: Comparison, (a, b): (Operand, Operand)) -> Operand {
        let rho = match comparison {
            Comparison::Less | Comparison::AtMost => self.steps.step(Operation::Subtract, b, a),
            Comparison::Greater | Comparison::AtLeast => self.steps.step(Operation::Subtract, a, b),
            Comparison::Equal | Comparison::Unequal => {
                let difference = self.steps.step(Operation::Subtract, a, b);
                self.steps.unary(Operation::Absolute, difference)
            }
        };
        let rho = match comparison {
            Comparison::Equal => self.steps.unary(Operation::Negate, rho),
            _ => rho,
        };
        match (self.reading, comparison) {
            (Reading::Robustness, _) => rho,
            (_, Comparison::Less | Comparison::Greater | Comparison::Unequal) => {
                self.steps.unary(Operation::Positive, rho)
            }
            (_, Comparison::AtMost | Comparison::AtLeast | Comparison::Equal) => {
                self.steps.unary(Operation::NotNegative, rho)
            }
        }
    }

    /// The operand that a term is, after the steps for what it needs and is not known yet.
    fn term(&mut self, root: TermId) -> Operand {
        for id in ordered(root, &self.terms, |id| self.module.arena.term(id).operands()) {
            let operand = self.one_term(id);
            self.terms.insert(id, operand);
        }
        self.terms[&root]
    }

    /// The step for one term whose operands are known.
    fn one_term(&mut self, id: TermId) -> Operand {
        let of = |id: TermId| self.terms[&id];
        match *self.module.arena.term(id) {
            Term::Number(Number(value)) => Operand::Constant(value),
            Term::Variant { number, .. } => Operand::Constant(number.into()),
            Term::Absent => Operand::Constant(-1.0),
            Term::Truth(value) => Operand::Constant(f64::from(u8::from(value))),
            Term::Place { .. } | Term::Variable(_) | Term::Host { .. } | Term::Parameter { .. } => {
                self.input(self.inputs.of_terms[&id])
            }
            Term::Negate(a) => self.steps.unary(Operation::Negate, of(a)),
            Term::Calculate(operator, a, b) => self.steps.step(arithmetic(operator), of(a), of(b)),
            Term::Call(Function::Abs, a, _) => self.steps.unary(Operation::Absolute, of(a)),
            Term::Call(Function::Min, a, Some(b)) => {
                self.steps.step(Operation::Least, of(a), of(b))
            }
            Term::Call(Function::Max, a, Some(b)) => {
                self.steps.step(Operation::Greatest, of(a), of(b))
            }
            Term::Call(function, a, b) => {
                let b = b.map_or(Operand::Constant(0.0), of);
                self.steps.step(Operation::Call(function), of(a), b)
            }
        }
    }

    /// The step that reads an input. A truth value in the place of a free proposition is its
    /// robustness, 1 or -1; of a Boolean field it is 1 or 0.
    fn input(&mut self, place: usize) -> Operand {
        let free = self.inputs.inputs[place].kind == InputKind::Proposition;
        let (input, low) = (place as u32, if free { -1.0 } else { 0.0 });
        self.steps.unary(Operation::Input { input, low }, Operand::Constant(0.0))
    }
}

/// The ids that `root` is made of and that are not known yet, operands first, `root` last. An
/// explicit stack replaces recursion, which would overflow on deep formulas.
fn ordered<Id: Copy + Eq + Hash>(
    root: Id,
    known: &FxHashMap<Id, Operand>,
    operands: impl Fn(Id) -> Vec<Id>,
) -> Vec<Id> {
    let (mut order, mut seen) = (Vec::new(), FxHashSet::default());
    let mut open = vec![(root, false)];
    while let Some((id, operands_are_done)) = open.pop() {
        if operands_are_done {
            order.push(id);
        } else if !known.contains_key(&id) && seen.insert(id) {
            open.push((id, true));
            open.extend(operands(id).into_iter().map(|operand| (operand, false)));
        }
    }
    order
}

fn arithmetic(operator: Arithmetic) -> Operation {
    match operator {
        Arithmetic::Add => Operation::Add,
        Arithmetic::Subtract => Operation::Subtract,
        Arithmetic::Multiply => Operation::Multiply,
        Arithmetic::Divide => Operation::Divide,
    }
}
