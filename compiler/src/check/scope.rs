//! What the items of a source declare: their names, and the types of the state.

use std::collections::{BTreeMap, HashMap};

use super::{Names, name};
use crate::ast::{Ast, Declaration, FieldType, Item, ItemKind};
use crate::error::{Error, Kind};
use crate::predicate::{Enum, Field, Scalar, State, Struct, TaskId, Type};
use crate::source::Span;

/// The declared names and types.
pub(super) struct Scope<'a> {
    items: BTreeMap<&'a str, usize>,
    tasks: BTreeMap<usize, TaskId>,
    pub(super) structs: Vec<Struct>,
    pub(super) enums: Vec<Enum>,
    state: Option<Struct>,
    /// Where the fields of the state are declared.
    fields: BTreeMap<&'a str, Span>,
    variants: HashMap<&'a str, u32>,
    /// Whether an item of types could not be read.
    incomplete: bool,
}

impl<'a> Scope<'a> {
    pub(super) fn new(ast: &'a Ast, mistakes: &mut Vec<Error>) -> Self {
        let mut scope = Self {
            items: BTreeMap::new(),
            tasks: BTreeMap::new(),
            structs: Vec::new(),
            enums: Vec::new(),
            state: None,
            fields: BTreeMap::new(),
            variants: HashMap::new(),
            incomplete: false,
        };
        scope.declare(ast, mistakes);
        scope.declare_types(ast, mistakes);
        scope.declare_state(ast, mistakes);
        scope
    }

    /// The item called `name`, types and the state aside.
    pub(super) fn item(&self, name: &str) -> Option<usize> {
        self.items.get(name).copied()
    }

    pub(super) fn task_id(&self, item: usize) -> Option<TaskId> {
        self.tasks.get(&item).copied()
    }

    pub(super) fn task_count(&self) -> usize {
        self.tasks.len()
    }

    /// The number that an enumeration gives to the value called `name`.
    pub(super) fn variant(&self, name: &str) -> Option<u32> {
        self.variants.get(name).copied()
    }

    /// Whether `name` is unknown only because its declaration has a mistake.
    pub(super) fn is_broken(&self, name: &str) -> bool {
        self.incomplete || self.fields.contains_key(name)
    }

    pub(super) fn has_state(&self) -> bool {
        self.state.is_some()
    }

    /// The fields of the state, or of a struct.
    pub(super) fn fields_of(&self, ty: Option<&Type>) -> &[Field] {
        match ty {
            None => self.state.as_ref().map_or(&[], |state| &state.fields),
            Some(Type::Struct(index)) => &self.structs[*index as usize].fields,
            Some(_) => &[],
        }
    }

    /// All names that can stand in a formula.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.items.keys().chain(self.fields.keys()).copied()
    }

    pub(super) fn state(&self, ast: &Ast, names: Names) -> State {
        let host = ast.items().iter().find_map(|item| match item.kind {
            ItemKind::Host(ty) => Some((ty, item.name)),
            _ => None,
        });
        match (&self.state, host, names) {
            (Some(state), ..) => State::Declared(state.clone()),
            (None, Some((ty, span)), _) => {
                State::Host { name: ast.source().slice(span).to_owned(), ty, span }
            }
            (None, None, Names::Host) => State::Inferred,
            (None, None, _) => State::Free,
        }
    }

    fn declare(&mut self, ast: &'a Ast, mistakes: &mut Vec<Error>) {
        let mut first: BTreeMap<&str, Span> = BTreeMap::new();
        for (index, item) in ast.items().iter().enumerate() {
            let text = ast.source().slice(item.name);
            self.incomplete |= is_broken_type(ast, item);
            if matches!(item.kind, ItemKind::Task(..)) {
                let count = u32::try_from(self.tasks.len()).expect("fewer than 2^32 tasks");
                self.tasks.insert(index, TaskId(count));
            }
            if text.is_empty() {
                continue;
            }
            if let Some(before) = first.get(text) {
                mistakes.push(duplicate(text, item.name, *before));
                continue;
            }
            first.insert(text, item.name);
            if is_value(&item.kind) {
                self.items.insert(text, index);
            }
        }
    }

    fn declare_types(&mut self, ast: &'a Ast, mistakes: &mut Vec<Error>) {
        for item in ast.items() {
            let name = ast.source().slice(item.name).to_owned();
            let docs = item.docs.clone();
            if let ItemKind::Enum(variants) = &item.kind {
                self.declare_variants(ast, variants, mistakes);
                let text = |span: &Span| ast.source().slice(*span).to_owned();
                let variants = variants.iter().map(text).collect();
                self.enums.push(Enum { name, docs, variants });
            }
        }
        for item in ast.items() {
            if let ItemKind::Struct(fields) = &item.kind {
                let fields = self.declare_fields(ast, fields, mistakes);
                let name = ast.source().slice(item.name).to_owned();
                self.structs.push(Struct { name, docs: item.docs.clone(), fields });
            }
        }
    }

    fn declare_variants(&mut self, ast: &'a Ast, names: &[Span], mistakes: &mut Vec<Error>) {
        for (number, span) in (0..).zip(names) {
            let name = ast.source().slice(*span);
            if self.variants.insert(name, number).is_some_and(|before| before != number) {
                let message = format!("`{name}` is declared twice with different positions");
                mistakes.push(Error::new(Kind::DuplicateName, message, *span));
            }
        }
    }

    fn declare_state(&mut self, ast: &'a Ast, mistakes: &mut Vec<Error>) {
        let mut first: Option<&Item> = None;
        for item in ast.items() {
            let fields = match &item.kind {
                ItemKind::State(fields) => &fields[..],
                ItemKind::Host(_) => &[],
                _ => continue,
            };
            if let Some(first) = first {
                mistakes.push(
                    Error::new(Kind::DuplicateName, "the state is declared twice", item.name)
                        .related(first.name, "first declared here"),
                );
                continue;
            }
            first = Some(item);
            if matches!(item.kind, ItemKind::Host(_)) {
                continue;
            }
            for field in fields {
                let name = ast.source().slice(field.name);
                self.fields.insert(name, field.name);
                if let Some(other) = self.items.get(name) {
                    mistakes.push(duplicate(name, ast.items()[*other].name, field.name));
                }
            }
            let fields = self.declare_fields(ast, fields, mistakes);
            let name = ast.source().slice(item.name).to_owned();
            self.state = Some(Struct { name, docs: item.docs.clone(), fields });
        }
    }

    fn declare_fields(
        &self,
        ast: &Ast,
        declarations: &[Declaration],
        mistakes: &mut Vec<Error>,
    ) -> Vec<Field> {
        let mut first: BTreeMap<&str, Span> = BTreeMap::new();
        let mut fields = Vec::new();
        for field in declarations {
            let text = ast.source().slice(field.name);
            if let Some(before) = first.insert(text, field.name) {
                mistakes.push(duplicate(text, field.name, before));
                continue;
            }
            match self.resolve(ast, &field.ty) {
                Ok(ty) => {
                    let docs = field.docs.clone();
                    fields.push(Field { name: text.to_owned(), docs, ty });
                }
                Err(error) => mistakes.push(error),
            }
        }
        fields
    }

    /// The type that an author wrote. A struct can hold only structs that stand before it, so that
    /// none holds itself.
    fn resolve(&self, ast: &Ast, written: &FieldType) -> Result<Type, Error> {
        let text = ast.source().slice(written.name);
        let position = |name: &str| self.structs.iter().position(|known| known.name == name);
        let index = |at: usize| u32::try_from(at).expect("fewer than 2^32 types");
        let mut ty = if let Some(scalar) = Scalar::named(text) {
            Type::Scalar(scalar)
        } else if let Some(at) = position(text) {
            Type::Struct(index(at))
        } else if let Some(at) = self.enums.iter().position(|known| known.name == text) {
            Type::Enum(index(at))
        } else {
            return Err(self.unknown_type(ast, written.name));
        };
        for length in &written.lengths {
            ty = Type::Array(Box::new(ty), self.length(ast, *length)?);
        }
        Ok(ty)
    }

    fn length(&self, ast: &Ast, span: Span) -> Result<u32, Error> {
        let text = ast.source().slice(span).replace('_', "");
        if let Some(known) = self.enums.iter().find(|known| known.name == text) {
            return Ok(u32::try_from(known.variants.len()).unwrap_or(u32::MAX));
        }
        text.parse().map_err(|_| {
            let message = format!("`{text}` is not a length");
            Error::new(Kind::Type, message, span)
                .help("the length of an array is a whole number, or the name of an enumeration")
        })
    }

    fn unknown_type(&self, ast: &Ast, span: Span) -> Error {
        let text = ast.source().slice(span);
        let scalars = ["f64", "f32", "i32", "i64", "u32", "u64", "i8", "i16", "u8", "u16", "bool"];
        let structs = self.structs.iter().map(|known| known.name.as_str());
        let enums = self.enums.iter().map(|known| known.name.as_str());
        let error = Error::new(Kind::UnknownName, format!("there is no type `{text}`"), span);
        match name::nearest(text, scalars.into_iter().chain(structs).chain(enums)) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(
                "the types are f64, f32, i8 to i64, u8 to u64, bool, arrays such as `[f64; 6]`, \
                 and structs declared above",
            ),
        }
    }
}

fn is_broken_type(ast: &Ast, item: &Item) -> bool {
    let text = ast.source().slice(item.span);
    matches!(item.kind, ItemKind::Broken) && (text.contains("state") || text.contains("struct"))
}

fn is_value(kind: &ItemKind) -> bool {
    matches!(
        kind,
        ItemKind::Constant(_) | ItemKind::Predicate(..) | ItemKind::Task(..) | ItemKind::Broken
    )
}

fn duplicate(name: &str, span: Span, first: Span) -> Error {
    Error::new(Kind::DuplicateName, format!("`{name}` is declared twice"), span)
        .label("declared again here")
        .related(first, "first declared here")
}
