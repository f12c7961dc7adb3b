//! What the items of a source declare: their names, and the types of the state.

use rustc_hash::FxHashMap;

use super::{Names, name, unit};
use crate::ast::{Ast, Declaration, FieldType, Item, ItemKind, WrittenUnit, quoted};
use crate::error::{Error, Kind};
use crate::predicate::{
    Enum, Field, Numeric, Parameter, ParameterType, Scalar, State, Struct, TaskId, Type,
};
use crate::source::Span;
use crate::unit::{Unit, Units};

/// The declared names and types.
pub(super) struct Scope<'a> {
    items: FxHashMap<&'a str, usize>,
    /// What each item declares.
    declared: Vec<Declared>,
    tasks: u32,
    pub(super) structs: Vec<Struct>,
    pub(super) enums: Vec<Enum>,
    state: Option<Struct>,
    /// Where the fields of the state are declared.
    fields: FxHashMap<&'a str, Span>,
    variants: FxHashMap<&'a str, Vec<(u32, u32)>>,
    /// All names that can stand in a formula, in the order of the source within each kind.
    names: Vec<&'a str>,
    pub(super) units: Units,
    /// Whether anything has a declared unit.
    measured: bool,
    /// Whether an item of types could not be read.
    incomplete: bool,
}

/// What one item declares.
#[derive(Clone, Default)]
struct Declared {
    task: Option<TaskId>,
    /// What a predicate or a task takes.
    parameters: Vec<Parameter>,
    /// The parameters whose types have mistakes.
    unclear: Vec<String>,
    /// The unit of a constant, and where it stands.
    unit: Option<(Unit, Span)>,
}

impl<'a> Scope<'a> {
    pub(super) fn new(ast: &'a Ast, names: Names, mistakes: &mut Vec<Error>) -> Self {
        let mut scope = Self {
            items: FxHashMap::default(),
            declared: vec![Declared::default(); ast.items().len()],
            tasks: 0,
            structs: Vec::new(),
            enums: Vec::new(),
            state: None,
            fields: FxHashMap::default(),
            variants: FxHashMap::default(),
            names: Vec::new(),
            units: Units::default(),
            measured: false,
            incomplete: false,
        };
        scope.declare(ast, mistakes);
        scope.declare_types(ast, mistakes);
        scope.declare_state(ast, mistakes);
        scope.declare_parameters(ast, names, mistakes);
        scope.declare_constants(ast, mistakes);
        scope
    }

    /// The item called `name`, types and the state aside.
    pub(super) fn item(&self, name: &str) -> Option<usize> {
        self.items.get(name).copied()
    }

    pub(super) fn task_id(&self, item: usize) -> Option<TaskId> {
        self.declared[item].task
    }

    pub(super) fn task_count(&self) -> usize {
        self.tasks as usize
    }

    /// The values called `name`, or `Enumeration::name`: of which enumerations, and which there.
    pub(super) fn variants(&self, name: &str) -> Vec<(u32, u32)> {
        let (of, name) = name.rsplit_once("::").map_or((None, name), |(of, name)| (Some(of), name));
        let all = self.variants.get(name.trim()).map_or(&[][..], Vec::as_slice);
        let wanted =
            |at: &&(u32, u32)| of.is_none_or(|of| self.enums[at.0 as usize].name == of.trim());
        all.iter().filter(wanted).copied().collect()
    }

    /// The enumeration called `name`.
    pub(super) fn enumeration(&self, name: &str) -> Option<u32> {
        self.enums.iter().position(|known| known.name == name).map(index)
    }

    /// What the item takes when it is used.
    pub(super) fn parameters(&self, item: usize) -> &[Parameter] {
        &self.declared[item].parameters
    }

    /// The parameters of the item whose types have mistakes: nothing is known of them.
    pub(super) fn unclear(&self, item: usize) -> &[String] {
        &self.declared[item].unclear
    }

    /// The declared unit of the constant `item`, and where it stands.
    pub(super) fn constant_unit(&self, item: usize) -> Option<&(Unit, Span)> {
        self.declared[item].unit.as_ref()
    }

    /// Whether anything has a declared unit.
    pub(super) fn has_units(&self) -> bool {
        self.measured
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
        self.names.iter().copied()
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
        let mut first: FxHashMap<&str, Span> = FxHashMap::default();
        for (index, item) in ast.items().iter().enumerate() {
            let text = ast.source().slice(item.name);
            self.incomplete |= is_broken_type(ast, item);
            if matches!(item.kind, ItemKind::Task(..)) {
                self.declared[index].task = Some(TaskId(self.tasks));
                self.tasks += 1;
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
                self.names.push(text);
            }
        }
    }

    fn declare_types(&mut self, ast: &'a Ast, mistakes: &mut Vec<Error>) {
        for item in ast.items() {
            let name = ast.source().slice(item.name).to_owned();
            let docs = item.docs.clone();
            if let ItemKind::Enum(variants) = &item.kind {
                self.declare_variants(ast, item.name, variants, mistakes);
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

    fn declare_variants(
        &mut self,
        ast: &'a Ast,
        of: Span,
        names: &[Span],
        mistakes: &mut Vec<Error>,
    ) {
        if names.is_empty() {
            let message = format!("the enumeration `{}` has no values", ast.source().slice(of));
            mistakes.push(
                Error::new(Kind::Type, message, of)
                    .help("list them: `enum Room { kitchen, hall }`"),
            );
        }
        let of = index(self.enums.len());
        let mut first: FxHashMap<&str, Span> = FxHashMap::default();
        for (number, span) in (0..).zip(names) {
            let name = ast.source().slice(*span);
            if let Some(before) = first.insert(name, *span) {
                mistakes.push(duplicate(name, *span, before));
            }
            self.variants.entry(name).or_default().push((of, number));
            self.names.push(name);
        }
    }

    fn declare_parameters(&mut self, ast: &'a Ast, names: Names, mistakes: &mut Vec<Error>) {
        for (item, entry) in ast.items().iter().enumerate() {
            let (ItemKind::Predicate(declared, _)
            | ItemKind::Task(declared, _)
            | ItemKind::Broken(declared)) = &entry.kind
            else {
                continue;
            };
            let mut parameters: Vec<Parameter> = Vec::new();
            let mut unclear = Vec::new();
            let mut first: FxHashMap<&str, Span> = FxHashMap::default();
            for declaration in declared {
                let text = ast.source().slice(declaration.name);
                if let Some(before) = first.insert(text, declaration.name) {
                    mistakes.push(duplicate(text, declaration.name, before));
                    continue;
                }
                let name = text.to_owned();
                if let Some(error) = self.shadowed(ast, declaration.name) {
                    mistakes.push(error);
                }
                let ty = self.parameter_type(ast, names, &declaration.ty);
                let is_number = match &ty {
                    Ok(ty) => matches!(ty.scalar(), Some(Scalar::Number(_))),
                    Err(_) => true,
                };
                let unit = self.declared_unit(ast, declaration, is_number, mistakes);
                match ty {
                    Ok(ty) => {
                        parameters.push(Parameter { name, ty, unit, span: declaration.name });
                    }
                    Err(error) => {
                        mistakes.push(error);
                        unclear.push(name);
                    }
                }
            }
            self.declared[item].parameters = parameters;
            self.declared[item].unclear = unclear;
        }
    }

    /// The error for a parameter or a bound name that something else is called too.
    pub(super) fn shadowed(&self, ast: &Ast, span: Span) -> Option<Error> {
        let name = ast.source().slice(span);
        let item = self.items.get(name).map(|item| ast.items()[*item].name);
        let host = ast.items().iter().find(|item| {
            matches!(item.kind, ItemKind::Host(_)) && ast.source().slice(item.name) == name
        });
        let first = item.or(self.fields.get(name).copied()).or(host.map(|item| item.name))?;
        Some(duplicate(name, span, first).help("give this one another name"))
    }

    fn parameter_type(
        &self,
        ast: &Ast,
        names: Names,
        written: &FieldType,
    ) -> Result<ParameterType, Error> {
        let text = ast.source().slice(written.name);
        let known = Scalar::named(text).is_some() || self.enumeration(text).is_some();
        if names == Names::Host && !known && written.lengths.is_empty() && !written.optional {
            return Ok(ParameterType::Host(written.span));
        }
        match self.resolve(ast, written)? {
            Type::Scalar(scalar) if scalar != Scalar::Number(Numeric::F32) => {
                Ok(ParameterType::Scalar(scalar))
            }
            _ => {
                let text = ast.source().slice(written.span);
                let message = format!("`{text}` cannot be the type of a parameter");
                Err(Error::new(Kind::Type, message, written.span)
                    .help("a parameter is a number (f64, i8 to i64, u8 to u64), a bool, or a value of an enumeration"))
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
                self.names.push(name);
                if let Some(other) = self.items.get(name) {
                    mistakes.push(duplicate(name, ast.items()[*other].name, field.name));
                }
            }
            let fields = self.declare_fields(ast, fields, mistakes);
            let name = ast.source().slice(item.name).to_owned();
            self.state = Some(Struct { name, docs: item.docs.clone(), fields });
        }
    }

    fn declare_constants(&mut self, ast: &Ast, mistakes: &mut Vec<Error>) {
        for (item, entry) in ast.items().iter().enumerate() {
            let ItemKind::Constant(Some(written), _) = &entry.kind else { continue };
            let unit = self.unit(ast, written, mistakes);
            self.declared[item].unit = unit.map(|unit| (unit, written.span));
        }
    }

    fn unit(
        &mut self,
        ast: &Ast,
        written: &WrittenUnit,
        mistakes: &mut Vec<Error>,
    ) -> Option<Unit> {
        self.measured = true;
        let unit = unit::resolve(ast, written, &mut self.units);
        unit.map_err(|error| mistakes.push(error)).ok()
    }

    /// The unit of a field or a parameter; what is not a number has none.
    fn declared_unit(
        &mut self,
        ast: &Ast,
        declaration: &Declaration,
        is_number: bool,
        mistakes: &mut Vec<Error>,
    ) -> Option<Unit> {
        let written = declaration.unit.as_ref()?;
        if is_number {
            return self.unit(ast, written, mistakes);
        }
        let name = ast.source().slice(declaration.name);
        let ty = ast.source().slice(declaration.ty.span);
        let message = format!("only numbers have units, and `{name}` is none");
        mistakes.push(
            Error::new(Kind::Unit, message, written.span)
                .related(declaration.ty.span, format!("`{}` is no type of numbers", quoted(ty))),
        );
        None
    }

    fn declare_fields(
        &mut self,
        ast: &Ast,
        declarations: &[Declaration],
        mistakes: &mut Vec<Error>,
    ) -> Vec<Field> {
        let mut first: FxHashMap<&str, Span> = FxHashMap::default();
        let mut fields = Vec::new();
        for field in declarations {
            let text = ast.source().slice(field.name);
            if let Some(before) = first.insert(text, field.name) {
                mistakes.push(duplicate(text, field.name, before));
                continue;
            }
            let ty = self.resolve(ast, &field.ty).map_err(|error| mistakes.push(error)).ok();
            let is_number = ty.as_ref().is_none_or(has_numbers);
            let unit = self.declared_unit(ast, field, is_number, mistakes);
            if let Some(ty) = ty {
                let docs = field.docs.clone();
                fields.push(Field { name: text.to_owned(), docs, ty, unit });
            }
        }
        fields
    }

    /// The type that an author wrote. A struct can hold only structs that stand before it, so that
    /// none holds itself.
    fn resolve(&self, ast: &Ast, written: &FieldType) -> Result<Type, Error> {
        let text = ast.source().slice(written.name);
        let position = |name: &str| self.structs.iter().position(|known| known.name == name);
        let mut ty = if let Some(scalar) = Scalar::named(text) {
            Type::Scalar(scalar)
        } else if let Some(at) = position(text) {
            Type::Struct(index(at))
        } else if let Some(at) = self.enums.iter().position(|known| known.name == text) {
            Type::Scalar(Scalar::Enum { of: index(at), optional: written.optional })
        } else {
            return Err(self.unknown_type(ast, written.name));
        };
        if written.optional && !matches!(ty, Type::Scalar(Scalar::Enum { .. })) {
            let message = format!("`{text}` cannot be optional");
            return Err(Error::new(Kind::Type, message, written.span)
                .help("only a value of an enumeration can be absent: `Object?`"));
        }
        for length in &written.lengths {
            let text = ast.source().slice(*length);
            ty = match self.enumeration(text) {
                Some(of) => Type::Table(Box::new(ty), of),
                None => Type::Array(Box::new(ty), self.length(ast, *length)?),
            };
        }
        Ok(ty)
    }

    fn length(&self, ast: &Ast, span: Span) -> Result<u32, Error> {
        let text = ast.source().slice(span).replace('_', "");
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
        match name::nearest(text, &mut scalars.into_iter().chain(structs).chain(enums)) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(
                "the types are f64, f32, i8 to i64, u8 to u64, bool, arrays such as `[f64; 6]`, \
                 enumerations, and structs declared above",
            ),
        }
    }
}

fn index(at: usize) -> u32 {
    u32::try_from(at).expect("fewer than 2^32 of a kind")
}

/// Whether a type is that of numbers, or of an array of them.
fn has_numbers(mut ty: &Type) -> bool {
    while let Type::Array(element, _) | Type::Table(element, _) = ty {
        ty = element;
    }
    matches!(ty, Type::Scalar(Scalar::Number(_)))
}

fn is_broken_type(ast: &Ast, item: &Item) -> bool {
    let text = ast.source().slice(item.span);
    matches!(item.kind, ItemKind::Broken(_))
        && (["state", "struct", "enum"].iter().any(|word| text.contains(word)))
}

fn is_value(kind: &ItemKind) -> bool {
    matches!(
        kind,
        ItemKind::Constant(..) | ItemKind::Predicate(..) | ItemKind::Task(..) | ItemKind::Broken(_)
    )
}

fn duplicate(name: &str, span: Span, first: Span) -> Error {
    Error::new(Kind::DuplicateName, format!("`{name}` is declared twice"), span)
        .label("declared again here")
        .related(first, "first declared here")
}
