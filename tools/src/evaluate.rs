//! Predicates at a given state, without a Rust compiler: what reads recorded trajectories.
//!
//! The interpreter does, operation by operation, what the generated code of
//! [`emit::predicates`](tltl_compiler::emit) does, so both give the same bits: `x < c` has robustness
//! `c - x` and holds iff that is positive, whatever the rounding. It knows declared states and bare
//! formulas; a predicate that is Rust code is refused. One pass over the arenas a state, operands
//! first, without recursion.

use std::fmt;

use tltl_compiler::ast::Comparison;
use tltl_compiler::dfa::{Dfa, Guards, State};
use tltl_compiler::guard::Cube;
use tltl_compiler::predicate::{
    Condition, ConditionId, Function, Module, Number, Scalar, Task, Term, TermId,
};

/// One number that the predicates of a task read from a state.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Input {
    /// Its name: `x`, `pose.x`, `joints[2]`; the proposition's name if that is free.
    pub name: String,
    /// What it is.
    pub kind: InputKind,
    /// The names of the values, in order, if it is one of an enumeration.
    pub values: Vec<String>,
}

/// What an input is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputKind {
    /// A place of the declared state, of this type; a truth value is 1 or 0, a value of an
    /// enumeration its number, from 0, and -1 if there is none.
    Place(Scalar),
    /// A variable of a bare formula: any real number.
    Variable,
    /// A free proposition of a bare formula, by its robustness: it holds iff that is positive.
    Proposition,
}

/// A part of a predicate that cannot be read here.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Unreadable {
    /// It is Rust code.
    Rust(String),
    /// It is a parameter of the task, which has no value.
    Parameter(String),
    /// It is an element of an array whose index depends on the state.
    Element(String),
}

/// A predicate whose value is not a number: its proposition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NotANumber(pub u32);

impl fmt::Display for Unreadable {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rust(text) => {
                write!(f, "`{text}` is Rust code, which only a Rust program can run")
            }
            Self::Parameter(name) => write!(f, "the task takes `{name}`, which has no value"),
            Self::Element(text) => {
                write!(f, "the index in `{text}` is a field, which only a Rust program can follow")
            }
        }
    }
}

impl std::error::Error for Unreadable {}

/// What the predicates of a task say of one state, by proposition.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// The robustness of each.
    pub robustness: Vec<f64>,
    /// Whether each holds.
    pub holds: Vec<bool>,
}

impl Reading {
    /// The robustness of a guard: max over its cubes, min over their literals.
    #[must_use]
    pub fn guard(&self, cubes: &[Cube]) -> f64 {
        let literal = |&(proposition, value): &(u32, bool)| {
            let rho = self.robustness[proposition as usize];
            if value { rho } else { -rho }
        };
        let cube = |cube: &Cube| cube.iter().map(literal).fold(f64::INFINITY, f64::min);
        cubes.iter().map(cube).fold(f64::NEG_INFINITY, f64::max)
    }
}

/// The predicates of a task, ready to read states.
pub struct Evaluator<'a> {
    module: &'a Module,
    /// The condition of each proposition.
    roots: Vec<ConditionId>,
    /// What the roots need, operands first.
    conditions: Vec<ConditionId>,
    terms: Vec<TermId>,
    inputs: Vec<Input>,
    /// The input that a term is, and that a free proposition is.
    read_terms: Vec<(TermId, usize)>,
    read_conditions: Vec<(ConditionId, usize)>,
    /// The value of each term, the robustness and truth of each condition, by number.
    numbers: Vec<f64>,
    values: Vec<(f64, bool)>,
}

impl<'a> Evaluator<'a> {
    /// The predicates of `task`, which is one of `module`.
    ///
    /// # Errors
    /// If one of them is Rust code.
    pub fn new(module: &'a Module, task: &Task) -> Result<Self, Unreadable> {
        let root =
            |id: &tltl_compiler::predicate::PredicateId| module.predicates[id.0 as usize].condition;
        let mut evaluator = Self {
            module,
            roots: task.predicates.iter().map(root).collect(),
            conditions: Vec::new(),
            terms: Vec::new(),
            inputs: Vec::new(),
            read_terms: Vec::new(),
            read_conditions: Vec::new(),
            numbers: vec![0.0; module.arena.terms().len()],
            values: vec![(0.0, false); module.arena.conditions().len()],
        };
        evaluator.collect();
        evaluator.find_inputs()?;
        Ok(evaluator)
    }

    /// What a state must give, in the order in which [`read`](Self::read) takes it.
    #[must_use]
    pub fn inputs(&self) -> &[Input] {
        &self.inputs
    }

    fn collect(&mut self) {
        self.conditions = self.module.conditions_of(self.roots.clone());
        self.terms = self.module.terms_of(&self.conditions);
    }

    fn find_inputs(&mut self) -> Result<(), Unreadable> {
        for at in 0..self.terms.len() {
            let id = self.terms[at];
            let (name, kind) = match self.module.arena.term(id) {
                Term::Place { scalar, .. } if self.is_fixed(id) => {
                    (self.module.display_term(id).to_string(), InputKind::Place(*scalar))
                }
                Term::Place { .. } => {
                    let text = self.module.display_term(id).to_string();
                    return Err(Unreadable::Element(text));
                }
                Term::Variable(name) => (name.clone(), InputKind::Variable),
                Term::Host { text, .. } => return Err(Unreadable::Rust(text.clone())),
                Term::Parameter { name, .. } => return Err(Unreadable::Parameter(name.clone())),
                _ => continue,
            };
            let values = self.values_of(kind);
            let input = self.input(Input { name, kind, values });
            self.read_terms.push((id, input));
        }
        for at in 0..self.conditions.len() {
            let id = self.conditions[at];
            match self.module.arena.condition(id) {
                Condition::Free(name) => {
                    let name = name.clone();
                    let input = self.input(Input {
                        name,
                        kind: InputKind::Proposition,
                        values: Vec::new(),
                    });
                    self.read_conditions.push((id, input));
                }
                Condition::Value { text, .. } => return Err(Unreadable::Rust(text.clone())),
                _ => {}
            }
        }
        Ok(())
    }

    /// Whether no index on the way to a place depends on the state.
    fn is_fixed(&self, place: TermId) -> bool {
        let arena = &self.module.arena;
        let varies = |id: &TermId| matches!(arena.term(*id), Term::Place { .. });
        !arena.term(place).operands().iter().any(varies)
    }

    fn values_of(&self, kind: InputKind) -> Vec<String> {
        match kind {
            InputKind::Place(Scalar::Enum { of, .. }) => {
                self.module.enums[of as usize].variants.clone()
            }
            _ => Vec::new(),
        }
    }

    fn input(&mut self, input: Input) -> usize {
        let known = self.inputs.iter().position(|other| *other == input);
        known.unwrap_or_else(|| {
            self.inputs.push(input);
            self.inputs.len() - 1
        })
    }

    /// What the predicates say of the state with these [`inputs`](Self::inputs).
    ///
    /// # Errors
    /// The first predicate that is not a number there.
    ///
    /// # Panics
    /// If there are fewer values than inputs.
    pub fn read(&mut self, inputs: &[f64]) -> Result<Reading, NotANumber> {
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
                return Err(NotANumber(proposition));
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
            Term::Place { .. } | Term::Variable(_) | Term::Host { .. } | Term::Parameter { .. } => {
                of(id)
            }
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
        match *self.module.arena.condition(id) {
            Condition::Truth(true) => (f64::INFINITY, true),
            Condition::Truth(false) => (f64::NEG_INFINITY, false),
            Condition::Not(a) => (-of(a).0, !of(a).1),
            Condition::And(a, b) => (least(of(a).0, of(b).0), of(a).1 & of(b).1),
            Condition::Or(a, b) => (greatest(of(a).0, of(b).0), of(a).1 | of(b).1),
            Condition::Compare(comparison, a, b) if self.module.arena.is_value(a) => {
                let holds = comparison.holds(number(a), number(b));
                (if holds { 1.0 } else { -1.0 }, holds)
            }
            Condition::Compare(comparison, a, b) => compare(comparison, number(a), number(b)),
            Condition::Apply { meaning, .. } => of(meaning),
            Condition::Bool(place) => {
                let holds = number(place) != 0.0;
                (if holds { 1.0 } else { -1.0 }, holds)
            }
            Condition::Is(predicate) => of(self.module.predicates[predicate.0 as usize].condition),
            Condition::Free(_) | Condition::Value { .. } => of(id),
        }
    }
}

/// The lesser of two numbers; not a number if one of them is none.
fn least(a: f64, b: f64) -> f64 {
    if a < b || a.is_nan() { a } else { b }
}

/// The greater of two numbers; not a number if one of them is none.
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

/// One row of a trajectory, read by a task's automaton.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The automaton's state after the row is read.
    pub state: State,
    /// ρ(s, D_φ^q), q being the state before: by how much the row moves the automaton on.
    pub progress: f64,
    /// What the predicates say of the row.
    pub reading: Reading,
}

/// Runs the automaton of a task over the readings of a trajectory.
#[must_use]
pub fn run(dfa: &Dfa, readings: Vec<Reading>) -> Vec<Row> {
    let mut guards = Guards::new(dfa);
    let mut progress: Vec<Option<Vec<Cube>>> = vec![None; dfa.len()];
    let mut q = 0;
    let row = |reading: Reading| {
        let cubes = progress[q as usize].get_or_insert_with(|| guards.progress(q));
        let progress = reading.guard(cubes);
        q = dfa.next(q, |p| reading.holds[p as usize]);
        Row { state: q, progress, reading }
    };
    readings.into_iter().map(row).collect()
}
