//! Declarations: from the items of a source to its [`Scope`].
//!
//! Names come first, because types and units mention them; then types, enumerations before the
//! structs that use them; then the state, the parameters of predicates and tasks, and the units of
//! constants. A declaration with a mistake is left out, and its name is remembered as broken, so
//! that its uses are not reported as well.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "enum Room { hall, attic }
//! struct Pose { x: f64, y: f64 }
//! state Robot { pose: Pose, at: Room, pose: f64 }
//! task up = F (at == attic && pose.z > 1)";
//! let errors = check::file(&Source::new("robot.tltl", text)).unwrap_err();
//! let kinds: Vec<&str> = errors.iter().map(|error| error.kind().name()).collect();
//! // The second `pose` is left out, and the first one has no `z`.
//! assert_eq!(kinds, ["duplicate-name", "unknown-name"]);
//! ```

use std::cell::Cell;

use super::scope::{Declared, Duration, SUGGESTION_WORK, Scope, Spans};
use super::{Decimal, Names, Value};
use crate::ast::{Ast, Declaration, FieldType, Item, ItemKind, WrittenUnit, quoted};
use crate::error::{Error, Kind};
use crate::intern::{Interner, Map};
use crate::predicate::{
    Enum, Field, Numeric, Parameter, ParameterType, Scalar, Struct, TaskId, Type,
};
use crate::reserved::rust_name;
use crate::source::Span;
use crate::unit::{MOST_NAMES, MOST_POWER, Unit, Units};

/// The deepest nesting of structs and arrays. rustc gives up on a type at 128 (arrays of arrays of
/// 120 compile, of 200 do not, nor do structs in structs of 130), and every part of a type that
/// holds the state adds to it.
const DEEPEST_TYPE: usize = 64;

/// Reads all declarations. Mistakes are in [`Scope::mistakes`].
pub(super) fn declare(ast: &Ast, names: Names) -> Scope<'_> {
    let mut scope = Scope {
        ast,
        names,
        items: Map::default(),
        declared: vec![Declared::default(); ast.items().len()],
        tasks: 0,
        structs: Vec::new(),
        nesting: Vec::new(),
        enums: Vec::new(),
        state: None,
        first: Spans::default(),
        fields: Interner::default(),
        variants: Map::default(),
        known: Vec::new(),
        letters_left: Cell::new(SUGGESTION_WORK),
        step: None,
        units: Units::default(),
        measured: false,
        incomplete: false,
        mistakes: Vec::new(),
    };
    scope.declare_names();
    scope.declare_types();
    scope.declare_state();
    scope.declare_parameters();
    scope.declare_constants();
    scope.declare_step();
    scope
}

impl<'a> Scope<'a> {
    /// Collects the names of the items, and refuses names that are declared twice. The first
    /// declaration counts.
    fn declare_names(&mut self) {
        let mut first = Spans::default();
        for (index, item) in self.ast.items().iter().enumerate() {
            let text = self.text(item.name);
            self.incomplete |= is_broken_type(self.ast, item);
            if matches!(item.kind, ItemKind::Task(..)) {
                self.declared[index].task = Some(TaskId(self.tasks));
                self.tasks += 1;
            }
            if text.is_empty() || !self.is_new(&mut first, item.name) {
                continue;
            }
            if matches!(item.kind, ItemKind::Host(_)) {
                self.first.get_or_insert(rust_name(text), item.name);
                self.mistakes.extend(self.unmentionable(item.name));
            }
            if is_value(&item.kind) {
                self.first.get_or_insert(rust_name(text), item.name);
                self.items.get_or_insert(text, index);
                self.known.push(text);
            }
        }
    }

    /// Reads the enumerations, then the structs. A struct may use any enumeration, and structs
    /// above it.
    fn declare_types(&mut self) {
        for item in self.ast.items() {
            if let ItemKind::Enum(variants) = &item.kind {
                self.declare_variants(item.name, variants);
                let (name, docs) = (self.text(item.name).to_owned(), item.docs.clone());
                let variants = variants.iter().map(|span| self.text(*span).to_owned()).collect();
                self.enums.push(Enum { name, docs, variants });
            }
        }
        for item in self.ast.items() {
            if let ItemKind::Struct(fields) = &item.kind {
                let declared = self.declare_struct(item, fields);
                let deepest = declared.fields.iter().map(|field| self.depth(&field.ty)).max();
                self.nesting.push(1 + deepest.unwrap_or_default());
                self.structs.push(declared);
            }
        }
    }

    /// Reads the values of one enumeration.
    fn declare_variants(&mut self, of: Span, names: &[Span]) {
        if names.is_empty() {
            let message = format!("the enumeration `{}` has no values", self.text(of));
            self.mistakes.push(
                Error::new(Kind::Type, message, of)
                    .help("list them: `enum Room { kitchen, hall }`"),
            );
        }
        let of = index(self.enums.len());
        let mut first = Spans::default();
        for (number, span) in (0..).zip(names) {
            let name = self.text(*span);
            self.is_new(&mut first, *span);
            self.variants.get_or_insert(name, Vec::new()).push(Value { of, number });
            self.known.push(name);
        }
    }

    /// Reads the state; a second one is a mistake.
    fn declare_state(&mut self) {
        let mut first: Option<&Item> = None;
        for item in self.ast.items() {
            if !matches!(item.kind, ItemKind::State(_) | ItemKind::Host(_)) {
                continue;
            }
            if let Some(first) = first {
                self.mistakes.push(
                    Error::new(Kind::DuplicateName, "the state is declared twice", item.name)
                        .related(first.name, "first declared here"),
                );
                continue;
            }
            first = Some(item);
            let ItemKind::State(fields) = &item.kind else { continue };
            for field in fields {
                let name = self.text(field.name);
                self.fields.intern(name);
                self.known.push(name);
                if let Some(other) = self.first.get(&rust_name(name)) {
                    self.mistakes.push(self.duplicate(*other, field.name));
                }
            }
            for field in fields {
                self.first.get_or_insert(rust_name(self.text(field.name)), field.name);
            }
            self.state = Some(self.declare_struct(item, fields));
        }
    }

    /// Reads the fields of a struct or of the state.
    fn declare_struct(&mut self, item: &Item, declarations: &[Declaration]) -> Struct {
        let mut first = Spans::default();
        let mut fields = Vec::new();
        for field in declarations {
            let text = self.text(field.name);
            if !self.is_new(&mut first, field.name) {
                continue;
            }
            let ty = self.written_type(&field.ty).map_err(|error| self.mistakes.push(error)).ok();
            let unit = self.declared_unit(field, ty.as_ref().is_none_or(has_numbers));
            if let Some(ty) = ty {
                let docs = field.docs.clone();
                fields.push(Field { name: text.to_owned(), docs, ty, unit });
            }
        }
        Struct { name: self.text(item.name).to_owned(), docs: item.docs.clone(), fields }
    }

    /// Whether the name at `span` is new among `names`, to which it is added; reports it if it is
    /// not.
    fn is_new(&mut self, names: &mut Spans<'a>, span: Span) -> bool {
        let first = *names.get_or_insert(rust_name(self.text(span)), span);
        let is_new = first == span;
        if !is_new {
            self.mistakes.push(self.duplicate(span, first));
        }
        is_new
    }

    /// Reads the parameters of predicates and tasks. One whose type has a mistake is unclear:
    /// messages about it would follow from that mistake.
    fn declare_parameters(&mut self) {
        for (item, entry) in self.ast.items().iter().enumerate() {
            let (ItemKind::Predicate(declared, _)
            | ItemKind::Task(declared, _)
            | ItemKind::Broken(declared)) = &entry.kind
            else {
                continue;
            };
            let mut first = Spans::default();
            for declaration in declared {
                if self.is_new(&mut first, declaration.name) {
                    self.declare_parameter(item, declaration);
                }
            }
        }
    }

    fn declare_parameter(&mut self, item: usize, declaration: &Declaration) {
        let span = declaration.name;
        self.mistakes.extend(self.shadowed(span).or_else(|| self.unmentionable(span)));
        let ty = self.parameter_type(&declaration.ty);
        let scalar = |ty: &ParameterType| matches!(ty.scalar(), Some(Scalar::Number(_)));
        let unit = self.declared_unit(declaration, ty.as_ref().map_or(true, scalar));
        let name = self.text(span).to_owned();
        match ty {
            Ok(ty) => self.declared[item].parameters.push(Parameter { name, ty, unit, span }),
            Err(error) => {
                self.mistakes.push(error);
                self.declared[item].unclear.push(name);
            }
        }
    }

    /// The type of a parameter. `f32` is left out: its robustness would be computed in `f64`
    /// anyway, and an argument would be converted silently.
    fn parameter_type(&self, written: &FieldType) -> Result<ParameterType, Error> {
        let text = self.text(written.name);
        let known = Scalar::named(text).is_some() || self.enumeration(text).is_some();
        if self.names == Names::Host && !known && written.lengths.is_empty() && !written.optional {
            return Ok(ParameterType::Host(written.span));
        }
        match self.written_type(written)? {
            Type::Scalar(scalar) if scalar != Scalar::Number(Numeric::F32) => {
                Ok(ParameterType::Scalar(scalar))
            }
            _ => {
                let text = self.text(written.span);
                let message = format!("`{text}` cannot be the type of a parameter");
                Err(Error::new(Kind::Type, message, written.span)
                    .help("a parameter is a number (f64, i8 to i64, u8 to u64), a bool, or a value of an enumeration"))
            }
        }
    }

    /// The type that an author wrote. A struct can hold only structs that stand before it, so that
    /// none holds itself.
    fn written_type(&self, written: &FieldType) -> Result<Type, Error> {
        let text = self.text(written.name);
        let mut ty = if let Some(scalar) = Scalar::named(text) {
            Type::Scalar(scalar)
        } else if let Some(at) = self.structs.iter().position(|known| known.name == text) {
            Type::Struct(index(at))
        } else if let Some(of) = self.enumeration(text) {
            Type::Scalar(Scalar::Enum { of, optional: written.optional })
        } else {
            return Err(self.unknown_type(written.name));
        };
        if written.optional && !matches!(ty, Type::Scalar(Scalar::Enum { .. })) {
            let message = format!("`{text}` cannot be optional");
            return Err(Error::new(Kind::Type, message, written.span)
                .help("only a value of an enumeration can be absent: `Object?`"));
        }
        for length in &written.lengths {
            ty = match self.enumeration(self.text(*length)) {
                Some(of) => Type::Table(Box::new(ty), of),
                None => Type::Array(Box::new(ty), self.length(*length)?),
            };
        }
        if self.depth(&ty) > DEEPEST_TYPE {
            let message = format!("types nest more than {DEEPEST_TYPE} deep");
            return Err(Error::new(Kind::Nesting, message, written.span)
                .help("the numbers of a state need no more than a few structs and arrays"));
        }
        Ok(ty)
    }

    /// The number of structs and arrays that a type consists of, one in the other.
    fn depth(&self, mut ty: &Type) -> usize {
        let mut depth = 0;
        while let Type::Array(element, _) | Type::Table(element, _) = ty {
            depth += 1;
            ty = element;
        }
        depth + if let Type::Struct(of) = ty { self.nesting[*of as usize] } else { 0 }
    }

    /// The length of an array.
    fn length(&self, span: Span) -> Result<u32, Error> {
        let text = self.text(span).replace('_', "");
        text.parse().map_err(|_| {
            let message = format!("`{text}` is not a length");
            Error::new(Kind::Type, message, span)
                .help("the length of an array is a whole number, or the name of an enumeration")
        })
    }

    /// The error for a type that does not exist.
    fn unknown_type(&self, span: Span) -> Error {
        let text = self.text(span);
        let scalars = ["f64", "f32", "i32", "i64", "u32", "u64", "i8", "i16", "u8", "u16", "bool"];
        let structs = self.structs.iter().map(|known| known.name.as_str());
        let enums = self.enums.iter().map(|known| known.name.as_str());
        let error = Error::new(Kind::UnknownName, format!("there is no type `{text}`"), span);
        let near = self.suggestion(text, &mut scalars.into_iter().chain(structs).chain(enums));
        let types = "the types are f64, f32, i8 to i64, u8 to u64, bool, arrays such as `[f64; 6]`, \
                     enumerations, and structs declared above";
        error.help(near.unwrap_or_else(|| types.to_owned()))
    }

    /// Reads the units of constants; their values are expressions and come later.
    fn declare_constants(&mut self) {
        for (item, entry) in self.ast.items().iter().enumerate() {
            if let ItemKind::Constant(Some(written), _) = &entry.kind {
                let unit = self.unit(written);
                self.declared[item].unit = unit.map(|unit| (unit, written.span));
            }
        }
    }

    /// Reads how long a step lasts; a second one is a mistake.
    fn declare_step(&mut self) {
        for item in self.ast.items() {
            let ItemKind::Step { amount, unit } = item.kind else { continue };
            if let Some(first) = &self.step {
                self.mistakes.push(
                    Error::new(Kind::DuplicateName, "the step is declared twice", unit)
                        .related(first.unit, "first declared here"),
                );
                continue;
            }
            let duration = Decimal::read(self.text(amount)).filter(|amount| !amount.is_zero());
            if duration.is_none() {
                let message = "a step lasts longer than nothing, and has at most 38 digits";
                self.mistakes.push(Error::new(Kind::Syntax, message, amount));
            }
            // Checking goes on with some step: that there is one is not the mistake.
            let amount = duration.unwrap_or(Decimal::ONE);
            self.step = Some(Duration { amount, unit });
        }
    }

    /// The unit of a field or a parameter. Anything that is not a number has none.
    fn declared_unit(&mut self, declaration: &Declaration, is_number: bool) -> Option<Unit> {
        let written = declaration.unit.as_ref()?;
        if is_number {
            return self.unit(written);
        }
        let (name, ty) = (self.text(declaration.name), declaration.ty.span);
        let message = format!("only numbers have units, and `{name}` is none");
        let label = format!("`{}` is no type of numbers", quoted(self.text(ty)));
        self.mistakes.push(Error::new(Kind::Unit, message, written.span).related(ty, label));
        None
    }

    /// The unit that an author wrote, or its mistake.
    fn unit(&mut self, written: &WrittenUnit) -> Option<Unit> {
        self.measured = true;
        self.written_unit(written).map_err(|error| self.mistakes.push(error)).ok()
    }

    /// The product of the factors of a unit.
    fn written_unit(&mut self, written: &WrittenUnit) -> Result<Unit, Error> {
        let mut powers = Vec::with_capacity(written.factors.len());
        for factor in &written.factors {
            let mut power = 1_i64;
            if let Some((digits, minus)) = factor.power {
                let digits = self.text(digits).replace('_', "");
                power = match digits.parse::<i64>() {
                    Ok(power) if power <= MOST_POWER.into() => power * if minus { -1 } else { 1 },
                    _ => return Err(large_unit("this power is too large".to_owned(), factor.span)),
                };
            }
            let name = self.units.name(self.text(factor.name));
            powers.push((name, if factor.divides { -power } else { power }));
        }
        let unit = Unit::product(powers);
        unit.ok_or_else(|| large_unit("this unit is too large".to_owned(), written.span))
    }
}

/// The error for a unit beyond the bounds.
pub(crate) fn large_unit(message: String, span: Span) -> Error {
    Error::new(Kind::Unit, message, span).help(format!(
        "a unit is made of at most {MOST_NAMES} names, with powers from -{MOST_POWER} to {MOST_POWER}"
    ))
}

/// A position as an index.
fn index(at: usize) -> u32 {
    u32::try_from(at).expect("fewer than 2^32 of a kind")
}

/// Whether a type is a number type, or an array of one.
fn has_numbers(mut ty: &Type) -> bool {
    while let Type::Array(element, _) | Type::Table(element, _) = ty {
        ty = element;
    }
    matches!(ty, Type::Scalar(Scalar::Number(_)))
}

/// Whether an item that could not be parsed may have declared a type: any type may then be unknown
/// only because of it.
fn is_broken_type(ast: &Ast, item: &Item) -> bool {
    let text = ast.source().slice(item.span);
    matches!(item.kind, ItemKind::Broken(_))
        && (["state", "struct", "enum"].iter().any(|word| text.contains(word)))
}

/// Whether an item's name can stand in an expression.
fn is_value(kind: &ItemKind) -> bool {
    matches!(
        kind,
        ItemKind::Constant(..) | ItemKind::Predicate(..) | ItemKind::Task(..) | ItemKind::Broken(_)
    )
}
