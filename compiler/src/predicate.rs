//! What a source declares: the state, the predicates over one state, and the tasks.
//!
//! A [`Module`] is typed: a [`Condition`] is true or false, a [`Term`] is a number, and constants
//! are folded. Both live in arenas, operands before the operators that use them, hash-consed,
//! so that equal comparisons are equal ids.

mod build;
mod print;

use rustc_hash::FxHashMap;

pub use print::Printed;

use crate::arena;
use crate::ast::{Arithmetic, Comparison};
use crate::error::Error;
use crate::source::Span;
use crate::spec::Spec;
use crate::unit::{Unit, Units};

/// A predicate of a [`Module`]: an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PredicateId(pub u32);

arena::id! { PredicateId }

/// A condition of a [`Module`]: an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ConditionId(pub u32);

arena::id! { ConditionId }

/// A term of a [`Module`]: an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TermId(pub u32);

/// A task of a [`Module`]: an index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TaskId(pub u32);

/// A number type of Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the type of its name")]
pub enum Numeric {
    F64,
    F32,
    I8,
    I16,
    I32,
    I64,
    U8,
    U16,
    U32,
    U64,
}

impl Numeric {
    /// All of them, with their names.
    const ALL: [(&str, Self); 10] = [
        ("f64", Self::F64),
        ("f32", Self::F32),
        ("i8", Self::I8),
        ("i16", Self::I16),
        ("i32", Self::I32),
        ("i64", Self::I64),
        ("u8", Self::U8),
        ("u16", Self::U16),
        ("u32", Self::U32),
        ("u64", Self::U64),
    ];

    /// What Rust calls it.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// The least and the greatest of its values if they are whole numbers.
    #[must_use]
    pub const fn whole(self) -> Option<(i128, i128)> {
        let bits = match self {
            Self::F64 | Self::F32 => return None,
            Self::I8 | Self::U8 => 8,
            Self::I16 | Self::U16 => 16,
            Self::I32 | Self::U32 => 32,
            Self::I64 | Self::U64 => 64,
        };
        Some(match self {
            Self::I8 | Self::I16 | Self::I32 | Self::I64 => {
                (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
            }
            _ => (0, (1 << bits) - 1),
        })
    }
}

/// A scalar type of a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// A number.
    Number(Numeric),
    /// `bool`
    Bool,
    /// A value of an enumeration.
    Enum {
        /// Which: an index of [`Module::enums`].
        of: u32,
        /// Whether there may be no value.
        optional: bool,
    },
}

impl Scalar {
    /// The scalar type that Rust calls `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        if name == "bool" {
            return Some(Self::Bool);
        }
        let found = Numeric::ALL.into_iter().find(|(known, _)| *known == name)?;
        Some(Self::Number(found.1))
    }

    /// The least and the greatest of its values if they are whole numbers. The values of an
    /// enumeration are not numbers here.
    #[must_use]
    pub const fn whole(self) -> Option<(i128, i128)> {
        match self {
            Self::Number(numeric) => numeric.whole(),
            _ => None,
        }
    }

    /// What Rust calls it; a value of an enumeration is called by what the source calls that.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Number(numeric) => numeric.name(),
            Self::Bool => "bool",
            Self::Enum { .. } => "enum",
        }
    }
}

/// The type of a field.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Type {
    /// A number, a truth value, or a value of an enumeration.
    Scalar(Scalar),
    /// A struct: an index of [`Module::structs`].
    Struct(u32),
    /// An array of so many elements.
    Array(Box<Type>, u32),
    /// An array with an element for each value of an enumeration: an index of [`Module::enums`].
    Table(Box<Type>, u32),
}

/// One field of a state or a struct.
#[derive(Clone, Debug)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// Its type.
    pub ty: Type,
    /// What its numbers are measured in, if the source says so.
    pub unit: Option<Unit>,
}

/// A struct that the source declares; the state is one too.
#[derive(Clone, Debug)]
pub struct Struct {
    /// Its name.
    pub name: String,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// Its fields.
    pub fields: Vec<Field>,
}

/// An enumeration that the source declares.
#[derive(Clone, Debug)]
pub struct Enum {
    /// Its name.
    pub name: String,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// The names of its values.
    pub variants: Vec<String>,
}

/// What predicates are about.
#[derive(Clone, Debug)]
pub enum State {
    /// Nothing is declared: propositions are free.
    Free,
    /// A struct that the source declares.
    Declared(Struct),
    /// A value of a Rust type of the user's.
    Host {
        /// The name that stands for the state.
        name: String,
        /// Where the source has the type.
        ty: Span,
        /// Where the source has the name.
        span: Span,
    },
    /// The macro without a header: the type is the one that the predicates take.
    Inferred,
}

/// A named constant.
#[derive(Clone, Debug)]
pub struct Constant {
    /// Its name.
    pub name: String,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// Its value.
    pub value: f64,
    /// What it is measured in, if the source says so.
    pub unit: Option<Unit>,
}

/// A part of a place within the state: `.pose`, `[2]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// A field.
    Field(String),
    /// An element of an array.
    Index(u32),
    /// The element of a table for a value of its enumeration.
    Element(TermId),
    /// The element of an array at a number that is not known.
    At {
        /// The number: a parameter, or a place.
        index: TermId,
        /// How many elements there are.
        length: u32,
    },
}

/// The type of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ParameterType {
    /// One of the source's own.
    Scalar(Scalar),
    /// A Rust type of the user's, where the source has it.
    Host(Span),
}

impl ParameterType {
    /// The type of the source's own that it is.
    #[must_use]
    pub const fn scalar(self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) => Some(scalar),
            Self::Host(_) => None,
        }
    }
}

/// What a predicate or a task takes when it is used.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its type.
    pub ty: ParameterType,
    /// What it is measured in, if the source says so.
    pub unit: Option<Unit>,
    /// Where the source has its name.
    pub span: Span,
}

/// What the names of parameters stand for.
pub type Arguments = Vec<(String, TermId)>;

/// What a name in a Rust expression stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Binding {
    /// The name.
    pub name: String,
    /// Its type, if it is a parameter with a type of the source's own.
    pub scalar: Option<Scalar>,
    /// What it stands for.
    pub term: TermId,
}

/// A function of numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs, reason = "each is the function of its name")]
pub enum Function {
    Abs,
    Min,
    Max,
    Sqrt,
    Hypot,
    Sin,
    Cos,
    Tan,
    Asin,
    Acos,
    Atan,
    Atan2,
    Exp,
    Ln,
    Pow,
    Floor,
    Ceil,
}

impl Function {
    /// All functions with their names and numbers of arguments; `min` and `max` take more too.
    pub const ALL: [(&'static str, Self, usize); 17] = [
        ("abs", Self::Abs, 1),
        ("min", Self::Min, 2),
        ("max", Self::Max, 2),
        ("sqrt", Self::Sqrt, 1),
        ("hypot", Self::Hypot, 2),
        ("sin", Self::Sin, 1),
        ("cos", Self::Cos, 1),
        ("tan", Self::Tan, 1),
        ("asin", Self::Asin, 1),
        ("acos", Self::Acos, 1),
        ("atan", Self::Atan, 1),
        ("atan2", Self::Atan2, 2),
        ("exp", Self::Exp, 1),
        ("ln", Self::Ln, 1),
        ("pow", Self::Pow, 2),
        ("floor", Self::Floor, 1),
        ("ceil", Self::Ceil, 1),
    ];

    /// The function called `name`.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(known, ..)| *known == name).map(|found| found.1)
    }

    /// How many arguments it takes.
    #[must_use]
    pub fn arity(self) -> usize {
        Self::ALL.into_iter().find(|(_, function, _)| *function == self).map_or(0, |found| found.2)
    }

    /// Whether it takes so many arguments.
    #[must_use]
    pub fn takes(self, count: usize) -> bool {
        count == self.arity() || matches!(self, Self::Min | Self::Max) && count > 2
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(_, function, _)| *function == self).map_or("", |found| found.0)
    }

    /// Its value at `x`, and at `y` if it takes two numbers.
    #[must_use]
    pub fn value(self, x: f64, y: f64) -> f64 {
        match self {
            Self::Abs => x.abs(),
            Self::Min => x.min(y),
            Self::Max => x.max(y),
            Self::Sqrt => x.sqrt(),
            Self::Hypot => x.hypot(y),
            Self::Sin => x.sin(),
            Self::Cos => x.cos(),
            Self::Tan => x.tan(),
            Self::Asin => x.asin(),
            Self::Acos => x.acos(),
            Self::Atan => x.atan(),
            Self::Atan2 => x.atan2(y),
            Self::Exp => x.exp(),
            Self::Ln => x.ln(),
            Self::Pow => x.powf(y),
            Self::Floor => x.floor(),
            Self::Ceil => x.ceil(),
        }
    }
}

/// A literal number, equal to another one if the bits are.
#[derive(Clone, Copy, Debug)]
pub struct Number(pub f64);

impl PartialEq for Number {
    fn eq(&self, other: &Self) -> bool {
        self.0.to_bits() == other.0.to_bits()
    }
}

impl Eq for Number {}

impl std::hash::Hash for Number {
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        self.0.to_bits().hash(state);
    }
}

/// A number or a value of an enumeration, as a function of one state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Term {
    /// A constant, finite.
    Number(Number),
    /// A place within the declared state.
    Place {
        /// The way to it.
        steps: Vec<Step>,
        /// What stands there.
        scalar: Scalar,
    },
    /// A free real variable of a bare formula.
    Variable(String),
    /// A Rust expression.
    Host {
        /// Its text without blanks; the same text is the same term.
        text: String,
        /// Where it stands first.
        span: Span,
        /// What the names of parameters in it stand for.
        bindings: Vec<Binding>,
        /// Whether it is a value that is no number.
        value: bool,
    },
    /// A value of an enumeration.
    Variant {
        /// Which enumeration: an index of [`Module::enums`].
        of: u32,
        /// Which of its values.
        number: u32,
        /// What that is called.
        name: String,
    },
    /// A truth value, as an argument.
    Truth(bool),
    /// `none`: what an optional place holds if it holds no value.
    Absent,
    /// A parameter of the predicate or task around it; a number, a truth value, or a value.
    Parameter {
        /// Its name.
        name: String,
        /// Its type.
        ty: ParameterType,
    },
    /// −x
    Negate(TermId),
    /// x + y and its like
    Calculate(Arithmetic, TermId, TermId),
    /// f(x), or f(x, y)
    Call(Function, TermId, Option<TermId>),
}

/// True or false, as a function of one state.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Condition {
    /// ⊤ or ⊥
    Truth(bool),
    /// Negation.
    Not(ConditionId),
    /// Conjunction.
    And(ConditionId, ConditionId),
    /// Disjunction.
    Or(ConditionId, ConditionId),
    /// A comparison of two numbers.
    Compare(Comparison, TermId, TermId),
    /// A Boolean place of the state, declared or Rust's.
    Bool(TermId),
    /// Another predicate of the module, without parameters.
    Is(PredicateId),
    /// Another predicate of the module with arguments.
    Apply {
        /// Which.
        predicate: PredicateId,
        /// What its parameters stand for, in order.
        arguments: Vec<TermId>,
        /// Its condition with the arguments in place of the parameters.
        meaning: ConditionId,
    },
    /// A Rust value in scope that is itself a predicate over the state.
    Value {
        /// Its text without blanks.
        text: String,
        /// Where it stands first.
        span: Span,
        /// What the names of parameters in it stand for.
        bindings: Vec<Binding>,
    },
    /// A free proposition of a bare formula: nothing is known of it but the predicate's name.
    Free(String),
}

/// The arenas of conditions and terms.
#[derive(Clone, Debug, Default)]
pub struct Arena {
    conditions: Vec<Condition>,
    terms: Vec<Term>,
    known_conditions: FxHashMap<Condition, ConditionId>,
    known_terms: FxHashMap<Term, TermId>,
    hosts: FxHashMap<(String, Vec<Binding>, bool), TermId>,
}

impl Arena {
    /// One condition.
    #[must_use]
    pub fn condition(&self, id: ConditionId) -> &Condition {
        &self.conditions[id.0 as usize]
    }

    /// One term.
    #[must_use]
    pub fn term(&self, id: TermId) -> &Term {
        &self.terms[id.0 as usize]
    }

    /// All conditions, operands first.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        &self.conditions
    }

    /// All terms, operands first.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The value of a term that does not depend on the state.
    #[must_use]
    pub fn constant(&self, id: TermId) -> Option<f64> {
        match self.term(id) {
            Term::Number(Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// A condition, shared with an equal one.
    pub fn add_condition(&mut self, condition: Condition) -> ConditionId {
        if let Some(id) = self.known_conditions.get(&condition) {
            return *id;
        }
        let id = ConditionId(index(self.conditions.len()));
        self.conditions.push(condition.clone());
        self.known_conditions.insert(condition, id);
        id
    }

    /// A term, shared with an equal one.
    pub fn add_term(&mut self, term: Term) -> TermId {
        if let Some(id) = self.find_term(&term) {
            return id;
        }
        let id = TermId(index(self.terms.len()));
        if let Term::Host { text, bindings, value, .. } = &term {
            self.hosts.insert((text.clone(), bindings.clone(), *value), id);
        }
        self.terms.push(term.clone());
        self.known_terms.insert(term, id);
        id
    }

    fn find_term(&self, term: &Term) -> Option<TermId> {
        match term {
            Term::Host { text, bindings, value, .. } => {
                self.hosts.get(&(text.clone(), bindings.clone(), *value)).copied()
            }
            _ => self.known_terms.get(term).copied(),
        }
    }
}

fn index(length: usize) -> u32 {
    u32::try_from(length).expect("fewer than 2^32 of a kind")
}

/// A predicate over one state.
#[derive(Clone, Debug)]
pub struct Predicate {
    /// The name that the author gave it; its normalised text if none.
    pub name: String,
    /// Whether an item of the source declares it.
    pub declared: bool,
    /// What it takes.
    pub parameters: Vec<Parameter>,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// Where the source has it first.
    pub span: Span,
    /// When it holds.
    pub condition: ConditionId,
}

/// How a task is made of other tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connective {
    /// All of them.
    And,
    /// At least one of them.
    Or,
}

/// A formula to satisfy.
#[derive(Clone, Debug)]
pub struct Task {
    /// Its name; `None` for a bare formula.
    pub name: Option<String>,
    /// What the author says about it.
    pub docs: Vec<String>,
    /// Where the source has its name; its formula if it has none.
    pub span: Span,
    /// What it takes when it is run.
    pub parameters: Vec<Parameter>,
    /// The formula, printed with the brackets that a reader wants.
    pub text: String,
    /// What it means.
    pub spec: Spec,
    /// The predicate of each proposition of the spec.
    pub predicates: Vec<PredicateId>,
    /// The tasks that it is the plain conjunction or disjunction of.
    pub parts: Option<(Connective, Vec<TaskId>)>,
    /// How it is compiled.
    pub options: Options,
}

/// How a task is compiled: what its attributes say.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// `#[factored]`: the conjuncts run side by side.
    pub factored: bool,
    /// `#[budget(states = …)]`
    pub states: Option<usize>,
    /// `#[budget(nodes = …)]`
    pub nodes: Option<usize>,
    /// `#[budget(edges = …)]`
    pub edges: Option<usize>,
    /// `#[budget(products = …)]`
    pub products: Option<usize>,
}

/// A checked source.
#[derive(Clone, Debug)]
pub struct Module {
    /// What the author says about the whole.
    pub docs: Vec<String>,
    /// What the predicates are about.
    pub state: State,
    /// The structs that the state is made of.
    pub structs: Vec<Struct>,
    /// The enumerations.
    pub enums: Vec<Enum>,
    /// The names that units are made of.
    pub units: Units,
    /// The constants.
    pub constants: Vec<Constant>,
    /// The predicates; one that another one uses stands before it.
    pub predicates: Vec<Predicate>,
    /// Their conditions and terms.
    pub arena: Arena,
    /// Where the source has comparisons and applied predicates, in the order in which they are
    /// checked; one may stand at several places.
    pub places: Vec<(ConditionId, Span)>,
    /// The tasks, in source order.
    pub tasks: Vec<Task>,
    /// What the author should look at.
    pub warnings: Vec<Error>,
}

impl Comparison {
    /// Its symbol.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Less => "<",
            Self::AtMost => "<=",
            Self::Greater => ">",
            Self::AtLeast => ">=",
            Self::Equal => "==",
            Self::Unequal => "!=",
        }
    }

    /// The comparison that holds iff this one does not.
    #[must_use]
    pub const fn negated(self) -> Self {
        match self {
            Self::Less => Self::AtLeast,
            Self::AtMost => Self::Greater,
            Self::Greater => Self::AtMost,
            Self::AtLeast => Self::Less,
            Self::Equal => Self::Unequal,
            Self::Unequal => Self::Equal,
        }
    }

    /// The comparison that says the same of the operands the other way round.
    #[must_use]
    pub const fn mirrored(self) -> Self {
        match self {
            Self::Less => Self::Greater,
            Self::AtMost => Self::AtLeast,
            Self::Greater => Self::Less,
            Self::AtLeast => Self::AtMost,
            Self::Equal | Self::Unequal => self,
        }
    }

    /// Whether it holds of two numbers.
    #[must_use]
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Less => left < right,
            Self::AtMost => left <= right,
            Self::Greater => left > right,
            Self::AtLeast => left >= right,
            Self::Equal => left == right,
            Self::Unequal => left != right,
        }
    }
}

impl Arithmetic {
    /// Its symbol.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Add => "+",
            Self::Subtract => "-",
            Self::Multiply => "*",
            Self::Divide => "/",
        }
    }

    /// Its value.
    #[must_use]
    pub fn value(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Add => left + right,
            Self::Subtract => left - right,
            Self::Multiply => left * right,
            Self::Divide => left / right,
        }
    }
}
