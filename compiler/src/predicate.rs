//! The meaning of a source: the state, the predicates over one state, and the tasks.
//!
//! A [`Module`] is typed: a [`Condition`] is true or false, a [`Term`] is a number or a value,
//! constants are folded, names are gone. It is the input of three later stages:
//! [`arithmetic`](crate::arithmetic) asks how its comparisons are related, [`emit`](crate::emit)
//! writes its conditions as Rust, and [`translate`](crate::translate) takes the [`Spec`] of each
//! task, in which predicates are nothing but numbers.
//!
//! Conditions and terms live in an [`Arena`], operands before the operators that use them, and
//! hash-consed: equal comparisons are equal ids. This is what makes `x < 3` in two tasks one
//! proposition.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state Cell { x: i32 }\nconst far = 2 * 5\npredicate out = x > far\ntask leave = F out\n";
//! let module = check::file(&Source::new("cell.tltl", text))?;
//! let out = &module.predicates[0];
//! assert_eq!(module.display(out.condition).to_string(), "x > 10");
//! assert_eq!(module.tasks[0].spec.propositions(), ["out"]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod build;
mod print;

pub use print::Printed;

use crate::arena;
use crate::ast::{Arithmetic, Comparison};
use crate::intern::{Index, Interner, hash_of};
use crate::source::Span;
use crate::spec::Spec;
use crate::unit::{Unit, Units};

/// A predicate of a [`Module`]: an index of [`Module::predicates`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct PredicateId(pub u32);

arena::id! { PredicateId }

/// A condition of a [`Module`]: an index of its [`Arena`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ConditionId(pub u32);

arena::id! { ConditionId }

/// A term of a [`Module`]: an index of its [`Arena`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TermId(pub u32);

/// A task of a [`Module`]: an index of [`Module::tasks`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TaskId(pub u32);

/// A number type of Rust that a state or a parameter may have.
///
/// `i128`, `u128`, `isize` and `usize` are not among them: the exact arithmetic of the analysis
/// needs room above the largest value, and a task must mean the same on every machine.
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
    /// All of them, with their names, in the order of the variants.
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

    /// Its name in Rust.
    #[must_use]
    pub const fn name(self) -> &'static str {
        Self::ALL[self as usize].0
    }

    /// The least and the greatest value of an integer type; `None` for floating point.
    ///
    /// ```
    /// use tltl_compiler::predicate::Numeric;
    ///
    /// assert_eq!(Numeric::I8.whole(), Some((-128, 127)));
    /// assert_eq!(Numeric::F32.whole(), None);
    /// ```
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

/// A scalar type of a field or a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// A number.
    Number(Numeric),
    /// `bool`
    Bool,
    /// A value of an enumeration.
    Enum {
        /// The enumeration: an index of [`Module::enums`].
        of: u32,
        /// Whether the value may be absent.
        optional: bool,
    },
}

impl Scalar {
    /// The scalar type that Rust calls `name`.
    ///
    /// ```
    /// use tltl_compiler::predicate::{Numeric, Scalar};
    ///
    /// assert_eq!(Scalar::named("u8"), Some(Scalar::Number(Numeric::U8)));
    /// assert_eq!(Scalar::named("usize"), None);
    /// ```
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        if name == "bool" {
            return Some(Self::Bool);
        }
        let found = Numeric::ALL.into_iter().find(|(known, _)| *known == name)?;
        Some(Self::Number(found.1))
    }

    /// The least and the greatest value of an integer type; `None` for other types. The values of
    /// an enumeration are not numbers here.
    #[must_use]
    pub const fn whole(self) -> Option<(i128, i128)> {
        match self {
            Self::Number(numeric) => numeric.whole(),
            _ => None,
        }
    }

    /// Its name in Rust; `enum` for a value of an enumeration, whose name the source gives.
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
    /// An array of this many elements.
    Array(Box<Type>, u32),
    /// An array with an element for each value of an enumeration: an index of [`Module::enums`].
    Table(Box<Type>, u32),
}

/// One field of a state or a struct.
#[derive(Clone, Debug)]
pub struct Field {
    /// Its name.
    pub name: String,
    /// The author's docs.
    pub docs: Vec<String>,
    /// Its type.
    pub ty: Type,
    /// The unit of its numbers, if the source gives one.
    pub unit: Option<Unit>,
}

/// A struct that the source declares. The declared state is one too.
#[derive(Clone, Debug)]
pub struct Struct {
    /// Its name.
    pub name: String,
    /// The author's docs.
    pub docs: Vec<String>,
    /// Its fields.
    pub fields: Vec<Field>,
}

/// An enumeration that the source declares.
#[derive(Clone, Debug)]
pub struct Enum {
    /// Its name.
    pub name: String,
    /// The author's docs.
    pub docs: Vec<String>,
    /// The names of its values.
    pub variants: Vec<String>,
}

/// The state that predicates read.
///
/// ```
/// use tltl_compiler::{check, predicate::{State, Type}, source::Source};
///
/// let text = "state Arm { joints: [f64; 6] in rad }\ntask up = F joints[2] > 1\n";
/// let module = check::file(&Source::new("arm.tltl", text))?;
/// let State::Declared(arm) = &module.state else { panic!("the source declares one") };
/// assert!(matches!(&arm.fields[0].ty, Type::Array(_, 6)) && arm.fields[0].unit.is_some());
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug, Default)]
pub enum State {
    /// Nothing is declared: propositions are free.
    #[default]
    Free,
    /// A struct that the source declares.
    Declared(Struct),
    /// A value of a Rust type of the user's.
    Host {
        /// The name that stands for the state.
        name: String,
        /// The place of the type in the source.
        ty: Span,
        /// The place of the name in the source.
        span: Span,
    },
    /// The input of the macro without a header: the type is the one that the predicates take.
    Inferred,
}

/// A named constant. Its value is already folded into the terms that use it.
#[derive(Clone, Debug)]
pub struct Constant {
    /// Its name.
    pub name: String,
    /// The author's docs.
    pub docs: Vec<String>,
    /// Its value.
    pub value: f64,
    /// Its unit, if the source gives one.
    pub unit: Option<Unit>,
}

/// A step of the path to a place within the state: `.pose`, `[2]`.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Step {
    /// A field.
    Field(String),
    /// An element of an array.
    Index(u32),
    /// The element of a table for a value of its enumeration.
    Element(TermId),
    /// The element of an array at a number that is known only when the program runs.
    At {
        /// The number: a parameter, or a place of an integer type.
        index: TermId,
        /// The number of elements.
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
    /// The type, if it is one of the source's own.
    #[must_use]
    pub const fn scalar(self) -> Option<Scalar> {
        match self {
            Self::Scalar(scalar) => Some(scalar),
            Self::Host(_) => None,
        }
    }
}

/// A parameter of a predicate or a task.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its type.
    pub ty: ParameterType,
    /// Its unit, if the source gives one.
    pub unit: Option<Unit>,
    /// The place of its name in the source.
    pub span: Span,
}

/// Arguments: the name of each parameter with the term that takes its place.
pub type Arguments = Vec<(String, TermId)>;

/// The meaning of a name in a Rust expression: a parameter, or a name that a quantifier binds.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Binding {
    /// The name.
    pub name: String,
    /// Its type, if it is a parameter with a type of the source's own.
    pub scalar: Option<Scalar>,
    /// The term that the name stands for.
    pub term: TermId,
}

/// A function of numbers, computed in `f64` like Rust's of the same name.
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
    /// All functions with their names and numbers of arguments; `min` and `max` also take more.
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

    /// The function of this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(known, ..)| *known == name).map(|found| found.1)
    }

    /// The number of arguments that it takes; the least one for `min` and `max`.
    ///
    /// ```
    /// use tltl_compiler::predicate::Function;
    ///
    /// assert_eq!((Function::Sqrt.arity(), Function::Hypot.arity(), Function::Max.arity()), (1, 2, 2));
    /// assert!(Function::ALL.iter().all(|(name, function, _)| Function::named(name) == Some(*function)));
    /// ```
    #[must_use]
    pub fn arity(self) -> usize {
        Self::ALL.into_iter().find(|(_, function, _)| *function == self).map_or(0, |found| found.2)
    }

    /// Whether it takes this many arguments.
    ///
    /// ```
    /// use tltl_compiler::predicate::Function;
    ///
    /// assert!(Function::Min.takes(3) && !Function::Hypot.takes(3));
    /// assert_eq!(Function::named("hypot").unwrap().value(3.0, 4.0), 5.0);
    /// ```
    #[must_use]
    pub fn takes(self, count: usize) -> bool {
        count == self.arity() || matches!(self, Self::Min | Self::Max) && count > 2
    }

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.into_iter().find(|(_, function, _)| *function == self).map_or("", |found| found.0)
    }

    /// Its value at `x`, and at `y` if it takes two numbers. A function of more arguments is a
    /// chain of itself.
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

/// A constant number. Equal to another if their bits are, so that it can be a key; there is one
/// zero, because folding leaves no negative one.
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
///
/// ```
/// use tltl_compiler::{check, predicate::{Step, Term}, source::Source};
///
/// let text = "state Arm { joints: [f64; 6] }\ntask up = F joints[2] > 1";
/// let module = check::file(&Source::new("arm.tltl", text))?;
/// let place = module.arena.terms().iter().find_map(|term| match term {
///     Term::Place { steps, .. } => Some(steps.clone()),
///     _ => None,
/// });
/// assert_eq!(place, Some(vec![Step::Field("joints".into()), Step::Index(2)]));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Term {
    /// A constant, finite.
    Number(Number),
    /// A place within the declared state.
    Place {
        /// The path to it, from the state.
        steps: Vec<Step>,
        /// The type of the value there.
        scalar: Scalar,
    },
    /// A free real variable of a bare formula.
    Variable(String),
    /// A Rust expression of the author's, which the compiler does not read.
    Host {
        /// Its text without superfluous blanks. Terms of the same text and bindings are one.
        text: String,
        /// Its first place in the source.
        span: Span,
        /// The meanings of the parameters and bound names in it.
        bindings: Vec<Binding>,
        /// Whether it is a value rather than a number.
        value: bool,
    },
    /// A value of an enumeration.
    Variant {
        /// The enumeration: an index of [`Module::enums`].
        of: u32,
        /// Which of its values, counted from 0.
        number: u32,
        /// What that is called.
        name: String,
    },
    /// A truth value, as an argument.
    Truth(bool),
    /// `none`: the value of an optional place that has none.
    Absent,
    /// A parameter of the predicate or task around it: a number, a truth value, or a value.
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
///
/// ```
/// use tltl_compiler::{check, predicate::Condition, source::Source};
///
/// let text = "state S { x: f64 }\npredicate near(d: f64) = x < d\ntask come = F near(2)";
/// let module = check::file(&Source::new("s.tltl", text))?;
/// let come = &module.predicates[module.tasks[0].predicates[0].0 as usize];
/// let Condition::Apply { meaning, .. } = module.arena.condition(come.condition) else { panic!() };
/// // What is called, and what it means.
/// assert_eq!(module.display(come.condition).to_string(), "near(2)");
/// assert_eq!(module.display(*meaning).to_string(), "x < 2");
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
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
        /// The arguments, in the order of the parameters.
        arguments: Vec<TermId>,
        /// Its condition with the arguments in place of the parameters. Analysis reads this;
        /// emission calls the predicate.
        meaning: ConditionId,
    },
    /// A Rust value in scope that is itself a predicate over the state.
    Value {
        /// Its text without blanks.
        text: String,
        /// Its first place in the source.
        span: Span,
        /// The meanings of the parameters and bound names in it.
        bindings: Vec<Binding>,
    },
    /// A free proposition of a bare formula: nothing is known about it but its name.
    Free(String),
}

/// The conditions and terms of a module.
///
/// Invariants: operands stand before the entries that use them; equal entries have equal ids. A
/// Rust expression is equal to another of the same text, wherever the two stand, so its place is
/// not part of its identity.
#[derive(Clone, Debug, Default)]
pub struct Arena {
    conditions: Interner<Condition>,
    terms: Vec<Term>,
    known: Index,
}

impl Arena {
    /// One condition.
    #[must_use]
    pub fn condition(&self, id: ConditionId) -> &Condition {
        &self.conditions.things()[id.0 as usize]
    }

    /// One term.
    #[must_use]
    pub fn term(&self, id: TermId) -> &Term {
        &self.terms[id.0 as usize]
    }

    /// All conditions, operands first.
    #[must_use]
    pub fn conditions(&self) -> &[Condition] {
        self.conditions.things()
    }

    /// All terms, operands first.
    #[must_use]
    pub fn terms(&self) -> &[Term] {
        &self.terms
    }

    /// The value of a term that is a number; `None` if it depends on the state.
    #[must_use]
    pub fn constant(&self, id: TermId) -> Option<f64> {
        match self.term(id) {
            Term::Number(Number(value)) => Some(*value),
            _ => None,
        }
    }

    /// Adds a condition as it is, and returns its id; an equal one has the same id.
    /// [`not`](Self::not), [`and`](Self::and) and [`or`](Self::or) simplify first.
    ///
    /// ```
    /// use tltl_compiler::predicate::{Arena, Condition};
    ///
    /// let mut arena = Arena::default();
    /// let [one, other] = [0, 1].map(|_| arena.add_condition(Condition::Free("docked".into())));
    /// assert_eq!((one, arena.conditions().len()), (other, 1));
    /// ```
    pub fn add_condition(&mut self, condition: Condition) -> ConditionId {
        ConditionId(self.conditions.intern(condition))
    }

    /// Adds a term as it is, and returns its id; an equal one has the same id.
    ///
    /// ```
    /// use tltl_compiler::predicate::{Arena, Term};
    ///
    /// let mut arena = Arena::default();
    /// let [one, other] = [0, 1].map(|_| arena.add_term(Term::Variable("x".into())));
    /// assert_eq!(one, other);
    /// assert_eq!(arena.terms().len(), 1);
    /// ```
    pub fn add_term(&mut self, term: Term) -> TermId {
        let hash = match term.host() {
            Some(host) => hash_of(&host),
            None => hash_of(&term),
        };
        let same = |known: &Term| match term.host() {
            Some(host) => known.host() == Some(host),
            None => *known == term,
        };
        let known = self.known.find(hash, |id| same(&self.terms[id as usize]));
        TermId(known.unwrap_or_else(|| {
            self.terms.push(term);
            self.known.add(hash)
        }))
    }
}

impl Term {
    /// What a Rust expression is known by: all but its place.
    fn host(&self) -> Option<(&str, &[Binding], bool)> {
        match self {
            Self::Host { text, bindings, value, .. } => Some((text, bindings, *value)),
            _ => None,
        }
    }
}

/// A predicate over one state.
///
/// A comparison in a formula is a predicate too, with its normalized text as its name.
#[derive(Clone, Debug)]
pub struct Predicate {
    /// The name that the author gave it, or the text of its condition.
    pub name: String,
    /// Whether an item of the source declares it.
    pub declared: bool,
    /// Its parameters.
    pub parameters: Vec<Parameter>,
    /// The author's docs.
    pub docs: Vec<String>,
    /// The place of its name in the source; of its first use if no item declares it.
    pub span: Span,
    /// The condition under which it holds.
    pub condition: ConditionId,
}

/// The operator that makes a task of other tasks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Connective {
    /// All of them.
    And,
    /// At least one of them.
    Or,
}

/// A formula to satisfy.
///
/// Invariant: `predicates` has one entry for each proposition of `spec`, in order.
#[derive(Clone, Debug)]
pub struct Task {
    /// Its name; `None` for a bare formula.
    pub name: Option<String>,
    /// The author's docs.
    pub docs: Vec<String>,
    /// The place of its name in the source; of its formula if it has none.
    pub span: Span,
    /// Its parameters, which are given when it is run.
    pub parameters: Vec<Parameter>,
    /// The formula, printed with the brackets that a reader wants.
    pub text: String,
    /// The formula, over the propositions that `predicates` lists.
    pub spec: Spec,
    /// The predicate of each proposition of the spec.
    pub predicates: Vec<PredicateId>,
    /// The tasks of which it is a plain conjunction or disjunction: their automata can be compared
    /// with its own.
    pub parts: Option<(Connective, Vec<TaskId>)>,
    /// The settings of its attributes.
    pub options: Options,
}

impl Task {
    /// The task as the subject of a sentence.
    ///
    /// ```
    /// use tltl_compiler::{check, source::Source};
    ///
    /// let named = check::file(&Source::new("s.tltl", "state S { a: bool }\ntask dock = F a"))?;
    /// let bare = check::formula(&Source::new("formula", "F a"))?;
    /// assert_eq!([named, bare].map(|module| module.tasks[0].title()), ["task `dock`", "the formula"]);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn title(&self) -> String {
        self.name.as_ref().map_or("the formula".to_owned(), |name| format!("task `{name}`"))
    }
}

/// How a task is compiled: the settings of its attributes. `None` leaves a bound to the caller's
/// budget.
///
/// ```
/// use tltl_compiler::{check, predicate::Options, source::Source};
///
/// let text = "state S { a: bool }\n#[budget(states = 100_000)] task t = F a";
/// let module = check::file(&Source::new("s.tltl", text))?;
/// let wanted = Options { states: Some(100_000), ..Options::default() };
/// assert_eq!(module.tasks[0].options, wanted);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
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

/// A checked source: everything that it means.
///
/// Invariant: all ids in it are indices of its own vectors and of `arena`.
#[derive(Clone, Debug, Default)]
pub struct Module {
    /// The author's docs of the whole source.
    pub docs: Vec<String>,
    /// The state that predicates read.
    pub state: State,
    /// The structs that the state is made of; each after those that it holds.
    pub structs: Vec<Struct>,
    /// The enumerations.
    pub enums: Vec<Enum>,
    /// The names that units are made of.
    pub units: Units,
    /// The constants.
    pub constants: Vec<Constant>,
    /// The predicates; each after those that it uses.
    pub predicates: Vec<Predicate>,
    /// The conditions and terms of the predicates.
    pub arena: Arena,
    /// The places of comparisons and applied predicates in the source, in the order in which they
    /// were checked. One condition may stand at several places.
    pub places: Vec<(ConditionId, Span)>,
    /// The tasks, in source order.
    pub tasks: Vec<Task>,
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

    /// The comparison that holds iff this one does not. NaN is an error before it is compared, so
    /// `!(a < b)` is `a >= b`.
    ///
    /// ```
    /// use tltl_compiler::ast::Comparison;
    ///
    /// assert_eq!(Comparison::Less.negated(), Comparison::AtLeast);
    /// assert_eq!(Comparison::Less.mirrored(), Comparison::Greater);
    /// assert!(Comparison::AtMost.holds(1.0, 1.0));
    /// ```
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

    /// The comparison with the same meaning when its operands are swapped.
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

    /// Whether it holds between two numbers.
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
