//! The declarations of a source, for looking names up.
//!
//! Filled once by `declare` and only read afterwards. Hash maps are for lookups alone; whatever is
//! listed or iterated is a vector in source order.

use std::borrow::Cow;
use std::cell::Cell;

use super::name::nearest;
use super::{Decimal, Names, Value};
use crate::ast::{Ast, ItemKind};
use crate::error::{Error, Kind};
use crate::intern::{Interner, Map};
use crate::predicate::{Enum, Field, Parameter, State, Struct, TaskId, Type};
use crate::reserved::{is_taken, rust_name};
use crate::source::Span;
use crate::unit::{Unit, Units};

/// The declared names and types.
pub(crate) struct Scope<'a> {
    pub(super) ast: &'a Ast,
    /// The meaning of undeclared names.
    pub(super) names: Names,
    /// The position of each item that can stand in an expression, by its name.
    pub(super) items: Map<&'a str, usize>,
    /// The declaration of each item.
    pub(super) declared: Vec<Declared>,
    /// The number of tasks.
    pub(super) tasks: u32,
    /// The structs, each after those that it holds.
    pub(crate) structs: Vec<Struct>,
    /// The deepest nesting of types in each struct.
    pub(super) nesting: Vec<usize>,
    /// The enumerations, in source order.
    pub(crate) enums: Vec<Enum>,
    /// The state, if the source declares its fields.
    pub(super) state: Option<Struct>,
    /// The place of the first declaration of each name that a formula can mention: items, fields of
    /// the state, the state itself.
    pub(super) first: Spans<'a>,
    /// The names of the state's fields, broken ones included.
    pub(super) fields: Interner<&'a str>,
    /// The values with each name; several enumerations may share one.
    pub(super) variants: Map<&'a str, Vec<Value>>,
    /// All names that can stand in a formula, for suggestions; in source order within each kind.
    pub(super) known: Vec<&'a str>,
    /// How many pairs of letters suggestions may still compare, see [`SUGGESTION_WORK`].
    pub(super) letters_left: Cell<usize>,
    /// How long a step lasts, if the source says so.
    pub(crate) step: Option<Duration>,
    /// The names of all units.
    pub(crate) units: Units,
    /// Whether anything has a declared unit; without one, units are not checked.
    pub(super) measured: bool,
    /// Whether an item that may declare a type could not be parsed.
    pub(super) incomplete: bool,
    /// The mistakes in the declarations.
    pub(super) mistakes: Vec<Error>,
}

/// The pairs of letters that all suggestions of one source may compare. Names of seven letters
/// compare 49 pairs, so this is enough for a hundred mistakes among a thousand names, and takes an
/// unoptimized macro a fifth of a second. Mistakes beyond it are reported without a suggestion.
pub(super) const SUGGESTION_WORK: usize = 5_000_000;

/// Places by the names that stand there, as Rust has them: two names of a source may be one there.
pub(super) type Spans<'a> = Map<Cow<'a, str>, Span>;

/// The declaration of one item.
#[derive(Clone, Default)]
pub(super) struct Declared {
    /// Its number among the tasks, if it is one.
    pub(super) task: Option<TaskId>,
    /// The parameters of a predicate or a task.
    pub(super) parameters: Vec<Parameter>,
    /// The parameters whose types have mistakes.
    pub(super) unclear: Vec<String>,
    /// The unit of a constant, and its place.
    pub(super) unit: Option<(Unit, Span)>,
}

/// How long a step lasts.
pub(crate) struct Duration {
    pub(crate) amount: Decimal,
    /// The name of its unit.
    pub(crate) unit: Span,
}

impl<'a> Scope<'a> {
    /// The item of this name; types and the state are not items here.
    pub(crate) fn item(&self, name: &str) -> Option<usize> {
        self.items.get(name).copied()
    }

    /// The number of an item among the tasks.
    pub(crate) fn task_id(&self, item: usize) -> Option<TaskId> {
        self.declared[item].task
    }

    /// The number of tasks.
    pub(crate) fn task_count(&self) -> usize {
        self.tasks as usize
    }

    /// The values with the name `name`, or `Enumeration::name`.
    pub(crate) fn variants(&self, name: &str) -> Vec<Value> {
        let (of, name) = name.rsplit_once("::").map_or((None, name), |(of, name)| (Some(of), name));
        let all = self.variants.get(name.trim()).map_or(&[][..], Vec::as_slice);
        let wanted = |at: &&Value| of.is_none_or(|of| self.enums[at.of as usize].name == of.trim());
        all.iter().filter(wanted).copied().collect()
    }

    /// The enumeration of this name.
    pub(crate) fn enumeration(&self, name: &str) -> Option<u32> {
        (0..).zip(&self.enums).find(|(_, known)| known.name == name).map(|(of, _)| of)
    }

    /// The first value of an enumeration, for an example.
    pub(crate) fn first_variant(&self, of: u32) -> &str {
        self.enums[of as usize].variants.first().map_or("value", String::as_str)
    }

    /// The parameters of an item.
    pub(crate) fn parameters(&self, item: usize) -> &[Parameter] {
        &self.declared[item].parameters
    }

    /// The parameters of an item whose types have mistakes; nothing is known about them.
    pub(crate) fn unclear(&self, item: usize) -> &[String] {
        &self.declared[item].unclear
    }

    /// The declared unit of the constant `item`, and its place.
    pub(crate) fn constant_unit(&self, item: usize) -> Option<&(Unit, Span)> {
        self.declared[item].unit.as_ref()
    }

    /// Whether anything has a declared unit.
    pub(crate) fn has_units(&self) -> bool {
        self.measured
    }

    /// Whether `name` is unknown only because its declaration has a mistake.
    pub(crate) fn is_broken(&self, name: &str) -> bool {
        self.incomplete || self.fields.find(name).is_some()
    }

    /// Whether the source declares the fields of the state.
    pub(crate) fn has_state(&self) -> bool {
        self.state.is_some()
    }

    /// The fields of the state, or of a struct.
    pub(crate) fn fields_of(&self, ty: Option<&Type>) -> &[Field] {
        match ty {
            None => self.state.as_ref().map_or(&[], |state| &state.fields),
            Some(Type::Struct(index)) => &self.structs[*index as usize].fields,
            Some(_) => &[],
        }
    }

    /// The help that offers the candidate nearest to `name`; `None` if none is near, or if the
    /// suggestions before have used all of [`SUGGESTION_WORK`].
    pub(crate) fn suggestion(
        &self,
        name: &str,
        candidates: &mut dyn Iterator<Item = &str>,
    ) -> Option<String> {
        let mut left = self.letters_left.get();
        let near = nearest(name, candidates, &mut left);
        self.letters_left.set(left);
        near.map(|near| format!("did you mean `{near}`?"))
    }

    /// All names that can stand in a formula.
    pub(crate) fn known(&self) -> impl Iterator<Item = &str> {
        self.known.iter().copied()
    }

    /// The state that predicates read.
    pub(crate) fn state(&self) -> State {
        match (&self.state, self.host(), self.names) {
            (Some(state), ..) => State::Declared(state.clone()),
            (None, Some((name, ty, span)), _) => State::Host { name: name.to_owned(), ty, span },
            (None, None, Names::Host) => State::Inferred,
            (None, None, _) => State::Free,
        }
    }

    /// The name of the state in Rust expressions, its type, and the place of the name.
    pub(crate) fn host(&self) -> Option<(&'a str, Span, Span)> {
        let host = self.ast.items().iter().find_map(|item| match item.kind {
            ItemKind::Host(ty) => Some((self.text(item.name), ty, item.name)),
            _ => None,
        });
        host.filter(|_| self.state.is_none())
    }

    /// The error for a parameter or a bound name that something else has too.
    pub(super) fn shadowed(&self, span: Span) -> Option<Error> {
        let first = self.first.get(&rust_name(self.text(span)))?;
        Some(self.duplicate(span, *first).help("give this one another name"))
    }

    /// The error for a name that Rust of the author's could not mention: the code around it has
    /// another meaning for it.
    pub(super) fn unmentionable(&self, span: Span) -> Option<Error> {
        let name = self.text(span);
        let message = format!("`{name}` is a word of Rust's own, and cannot be a name in a macro");
        (self.names == Names::Host && is_taken(name))
            .then(|| Error::new(Kind::Keyword, message, span).help("give it another name"))
    }

    /// The error for a name that is declared at `first` already.
    pub(super) fn duplicate(&self, span: Span, first: Span) -> Error {
        let (name, before) = (self.text(span), self.text(first));
        let known = if name == before { name.into() } else { rust_name(name) };
        let error = Error::new(Kind::DuplicateName, format!("`{known}` is declared twice"), span)
            .label("declared again here")
            .related(first, "first declared here");
        if name == before {
            return error;
        }
        error.help(format!("`{before}` and `{name}` are one name in Rust"))
    }

    /// The text at a place.
    pub(super) fn text(&self, span: Span) -> &'a str {
        self.ast.source().slice(span)
    }
}
