//! The declarations of a source, for looking names up.
//!
//! Filled once by `declare` and only read afterwards. Hash maps are for lookups alone; whatever is
//! listed or iterated is a vector in source order.

use rustc_hash::FxHashMap;

use super::{Names, Value};
use crate::ast::{Ast, ItemKind};
use crate::error::{Error, Kind};
use crate::predicate::{Enum, Field, Parameter, State, Struct, TaskId, Type};
use crate::source::Span;
use crate::unit::{Unit, Units};

/// The declared names and types.
pub(crate) struct Scope<'a> {
    pub(super) ast: &'a Ast,
    /// The meaning of undeclared names.
    pub(super) names: Names,
    /// The position of each item that can stand in an expression, by its name.
    pub(super) items: FxHashMap<&'a str, usize>,
    /// The declaration of each item.
    pub(super) declared: Vec<Declared>,
    /// The number of tasks.
    pub(super) tasks: u32,
    /// The structs, each after those that it holds.
    pub(crate) structs: Vec<Struct>,
    /// The enumerations, in source order.
    pub(crate) enums: Vec<Enum>,
    /// The state, if the source declares its fields.
    pub(super) state: Option<Struct>,
    /// The places of the declarations of the state's fields, broken ones included.
    pub(super) fields: FxHashMap<&'a str, Span>,
    /// The values with each name; several enumerations may share one.
    pub(super) variants: FxHashMap<&'a str, Vec<Value>>,
    /// All names that can stand in a formula, for suggestions; in source order within each kind.
    pub(super) known: Vec<&'a str>,
    /// The names of all units.
    pub(crate) units: Units,
    /// Whether anything has a declared unit; without one, units are not checked.
    pub(super) measured: bool,
    /// Whether an item that may declare a type could not be parsed.
    pub(super) incomplete: bool,
    /// The mistakes in the declarations.
    pub(super) mistakes: Vec<Error>,
}

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
        self.incomplete || self.fields.contains_key(name)
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
        let name = self.text(span);
        let item = self.items.get(name).map(|item| self.ast.items()[*item].name);
        let host = || {
            let mut items = self.ast.items().iter();
            let is_host = |kind: &ItemKind| matches!(kind, ItemKind::Host(_));
            items.find(|item| is_host(&item.kind) && self.text(item.name) == name)
        };
        let first = item.or(self.fields.get(name).copied()).or_else(|| Some(host()?.name))?;
        Some(duplicate(name, span, first).help("give this one another name"))
    }

    /// The text at a place.
    pub(super) fn text(&self, span: Span) -> &'a str {
        self.ast.source().slice(span)
    }
}

/// The error for a name that was declared at `first` already.
pub(super) fn duplicate(name: &str, span: Span, first: Span) -> Error {
    Error::new(Kind::DuplicateName, format!("`{name}` is declared twice"), span)
        .label("declared again here")
        .related(first, "first declared here")
}
