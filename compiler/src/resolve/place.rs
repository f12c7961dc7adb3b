//! Places: paths from the declared state down to a number, a truth value or a value of an
//! enumeration.
//!
//! In a task file, a path is resolved field by field against the declared types, and an index is
//! checked: a known one must lie within the array, an unknown one must have a type whose every
//! value does, or be a parameter, for which the generated code asserts it. So no step of a task can
//! read outside an array.
//!
//! In the macro, a path is Rust's to read. It is resolved beside that only if a state is declared,
//! to learn its unit.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state Arm { joints: [f64; 6] }\ntask up = F joints[6] > 1";
//! let errors = check::file(&Source::new("arm.tltl", text)).unwrap_err();
//! assert_eq!(errors.first().message(), "index 6 is beyond an array of 6 elements");
//! assert_eq!(errors.first().helps(), ["the elements are numbered from 0 to 5"]);
//! ```

use std::rc::Rc;

use super::{Expression, ExpressionId, Name, Names, Place, Resolved, Segment};
use crate::ast::{Node, NodeId};
use crate::error::{Error, Kind};
use crate::predicate::{Numeric, ParameterType, Scalar, Type};
use crate::source::Span;

/// The deepest nesting of places as indices, `a[b[c]]`. It bounds the one recursion over an input:
/// terms are made of places recursively.
const INDICES: usize = 4;

/// The part of a path after its base.
#[derive(Clone, Copy)]
pub(super) enum Part {
    /// `.field`
    Field(Span),
    /// `[index]`, with the node of the whole path up to there.
    Index(NodeId, ExpressionId),
}

impl Place {
    /// The type at the place; `None` if it is a struct or an array.
    pub(crate) fn scalar(&self) -> Option<Scalar> {
        match self.ty {
            Type::Scalar(scalar) => Some(scalar),
            _ => None,
        }
    }

    /// The place one step further, with the type there.
    fn then(&self, segment: Segment, ty: Type) -> Self {
        let segments = self.segments.iter().cloned().chain([segment]).collect();
        Self { segments, ty, unit: self.unit.clone(), depth: self.depth }
    }
}

impl Resolved<'_> {
    /// The meaning of a part of `base`, in the expression of `item`.
    pub(super) fn part(&self, base: ExpressionId, part: Part, item: usize) -> Name {
        match (self.names, &self[base].expression) {
            (_, Expression::Name(Name::Free)) => Name::Free,
            (Names::Host, Expression::Number(_)) => Name::Unknown(Rc::new(self.no_place(base))),
            (Names::Host, _) => Name::Rust,
            _ => match self.place(base, item).and_then(|base| self.extended(&base, part)) {
                Ok(place) => Name::Place(Rc::new(place), Vec::new()),
                Err(error) => Name::Unknown(error),
            },
        }
    }

    /// The place that an expression of `item` names, or the error that it names none.
    pub(crate) fn place(&self, id: ExpressionId, item: usize) -> Result<Rc<Place>, Rc<Error>> {
        let error = match (&self[id].expression, self.ast.node(self[id].node)) {
            (Expression::Name(Name::Place(place, _)), _) => return Ok(place.clone()),
            (Expression::Name(Name::Unknown(error)), _) => return Err(error.clone()),
            (Expression::Name(Name::Value(_)), _) => self.no_place(id),
            (Expression::Name(_), Node::Name) => match self.field_of_state(self.span(id)) {
                Some(place) => return Ok(Rc::new(place)),
                None => self.unknown(self.span(id), item),
            },
            (Expression::Call(..), _) => self.unknown_function(self[id].first),
            _ => self.no_place(id),
        };
        Err(Rc::new(error))
    }

    /// The field of the state whose name stands at `span`.
    pub(super) fn field_of_state(&self, span: Span) -> Option<Place> {
        let name = self.ast.source().slice(span);
        let field = self.scope.fields_of(None).iter().find(|field| field.name == name)?;
        let (ty, unit) = (field.ty.clone(), field.unit.clone());
        Some(Place { segments: vec![Segment::Field(span)], ty, unit, depth: 0 })
    }

    /// The place that a part leads to.
    fn extended(&self, base: &Place, part: Part) -> Result<Place, Rc<Error>> {
        let place = match part {
            Part::Field(name) => self.field(base, name),
            Part::Index(node, index) => self.element(base, node, index),
        };
        place.map_err(Rc::new)
    }

    /// The place of a field.
    fn field(&self, base: &Place, span: Span) -> Result<Place, Error> {
        let name = self.ast.source().slice(span);
        let fields = self.scope.fields_of(Some(&base.ty));
        if let Some(field) = fields.iter().find(|field| field.name == name) {
            let place = base.then(Segment::Field(span), field.ty.clone());
            return Ok(Place { unit: field.unit.clone(), ..place });
        }
        let error = Error::new(Kind::UnknownName, format!("there is no field `{name}`"), span);
        /// The most fields that the message lists.
        const MOST: usize = 32;
        let names: Vec<_> = fields.iter().map(|field| field.name.as_str()).collect();
        let near = self.scope.suggestion(name, &mut names.iter().copied());
        Err(error.help(near.unwrap_or_else(|| match &names[..] {
            [] => "this is not a struct".to_owned(),
            names if names.len() <= MOST => format!("the fields are {}", names.join(", ")),
            names => format!("the fields are {}, …", names[..MOST].join(", ")),
        })))
    }

    /// The place of an element.
    fn element(&self, base: &Place, node: NodeId, index: ExpressionId) -> Result<Place, Error> {
        let (Type::Table(element, _) | Type::Array(element, _)) = &base.ty else {
            let message = format!("`{}` indexes what is not an array", self.ast.quote(node));
            return Err(Error::new(Kind::Type, message, self.ast.span(node)));
        };
        let segment = match base.ty {
            Type::Table(_, of) => self.table_segment(index, of)?,
            Type::Array(_, length) => self.array_segment(index, length)?,
            _ => return Ok(base.clone()),
        };
        let (element, depth) = (Type::clone(element), base.depth.max(self.depth(&segment)));
        Ok(Place { depth, ..base.then(segment, element) })
    }

    /// The depth to which places nest as indices in a step.
    fn depth(&self, segment: &Segment) -> usize {
        let (Segment::Element { index, .. } | Segment::At { index, .. }) = segment else {
            return 0;
        };
        match (&self[*index].expression, segment) {
            (Expression::Name(Name::Place(place, _)), _) => place.depth + 1,
            (_, Segment::Element { .. }) => 1,
            _ => 0,
        }
    }

    /// Whether an index nests too deep already.
    fn is_too_deep(&self, index: ExpressionId) -> bool {
        matches!(&self[index].expression, Expression::Name(Name::Place(place, _)) if place.depth >= INDICES)
    }

    /// The step to an element of a table. Whether the index is a value of the right enumeration is
    /// checked later, with the value.
    fn table_segment(&self, index: ExpressionId, of: u32) -> Result<Segment, Error> {
        if self.sort(index).is_some() && !self.is_too_deep(index) {
            return Ok(Segment::Element { index, of });
        }
        let known = &self.scope.enums[of as usize];
        let text = self.quote(index);
        let message =
            format!("`{text}` is not a value of `{}`, which indexes this array", known.name);
        let error = self.type_error(index, message);
        let near = self.scope.suggestion(&text, &mut known.variants.iter().map(String::as_str));
        let help = "an index is a value of the enumeration, a parameter or a field";
        Err(error.help(near.unwrap_or_else(|| help.to_owned())))
    }

    /// The step to an element of an array: at a known number, or at one that is known only when the
    /// program runs.
    fn array_segment(&self, index: ExpressionId, length: u32) -> Result<Segment, Error> {
        let at = Segment::At { index, length };
        match &self[index].expression {
            Expression::Name(Name::Parameter { ty: ParameterType::Scalar(scalar), .. }) => {
                match scalar.whole() {
                    Some(_) => Ok(at),
                    None => Err(self.not_an_index(index, *scalar, length)),
                }
            }
            Expression::Name(Name::Place(place, _)) if !self.is_too_deep(index) => {
                match place.scalar() {
                    Some(scalar) => match scalar.whole() {
                        Some((0.., last)) if last < length.into() => Ok(at),
                        _ => Err(self.not_an_index(index, scalar, length)),
                    },
                    None => self.known_segment(index, length),
                }
            }
            _ => self.known_segment(index, length),
        }
    }

    /// The error for a place or a parameter that cannot index an array of `length`.
    pub(crate) fn not_an_index(&self, index: ExpressionId, scalar: Scalar, length: u32) -> Error {
        let (text, span) = (self.quote(index), self.span(index));
        if scalar.whole().is_none() {
            let message = format!("`{text}` is {}, and an index is a whole number", a_type(scalar));
            let error = Error::new(Kind::Type, message, span);
            return match &self[index].expression {
                Expression::Name(Name::Parameter { .. }) => {
                    error.help(format!("declare it as a whole number: `{text}: u8`"))
                }
                _ => error.help("an index is a whole number, a constant or a parameter"),
            };
        }
        let ty = scalar.name();
        let message = format!(
            "`{text}` may be beyond an array of {length} elements: it is {}",
            a_type(scalar)
        );
        Error::new(Kind::Type, message, span).help(format!(
            "index by a parameter, whose value the program vouches for: `predicate p(i: {ty}) = …[i]`"
        ))
    }

    /// The step to an element at a known number.
    fn known_segment(&self, index: ExpressionId, length: u32) -> Result<Segment, Error> {
        let (text, span) = (self.text(index), self.span(index));
        let value = match &self[index].expression {
            Expression::Number(_) | Expression::Name(Name::Item(..)) => self[index].value,
            _ => None,
        };
        let Some(value) = value.filter(|value| value.fract() == 0.0 && *value >= 0.0) else {
            let message = format!("`{text}` cannot be an index");
            return Err(Error::new(Kind::Type, message, span).help(
                "an index is a whole number, a constant or a parameter; declare the array as `[…; Room]` to index it by an enumeration",
            ));
        };
        if value >= f64::from(length) {
            let message = format!("index {value} is beyond an array of {length} elements");
            return Err(Error::new(Kind::Type, message, span).help(elements(length)));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
        Ok(Segment::Index(value as u32))
    }

    /// The error for a struct or an array that is read as a whole.
    pub(crate) fn not_a_scalar(&self, id: ExpressionId, ty: &Type) -> Error {
        let text = self.quote(id);
        let (what, example) = match ty {
            Type::Array(..) => ("an array", format!("`{text}[0]`")),
            Type::Table(_, of) => {
                let first = self.scope.first_variant(*of);
                ("an array", format!("`{text}[{first}]`"))
            }
            _ => {
                let field = self.scope.fields_of(Some(ty)).first();
                ("a struct", format!("`{text}.{}`", field.map_or("field", |field| &field.name)))
            }
        };
        let message = format!("`{text}` is {what}, but a number or a truth value is needed here");
        self.type_error(id, message).help(format!("name a part of it, such as {example}"))
    }

    /// The error for the parts of an expression that has none.
    fn no_place(&self, id: ExpressionId) -> Error {
        match &self[id].expression {
            Expression::Number(_) => {
                let message = format!("`{}` is a number, and has no parts", self.quote(id));
                self.type_error(id, message)
            }
            _ => self.only_rust(self[id].node),
        }
    }
}

/// The help on how the elements of an array are numbered.
pub(crate) fn elements(length: u32) -> String {
    format!("the elements are numbered from 0 to {}", length.saturating_sub(1))
}

/// A type as a sentence mentions it.
pub(crate) fn a_type(scalar: Scalar) -> String {
    let name = scalar.name();
    match scalar {
        Scalar::Number(Numeric::U8 | Numeric::U16 | Numeric::U32 | Numeric::U64) => {
            format!("a `{name}`")
        }
        Scalar::Number(_) => format!("an `{name}`"),
        Scalar::Bool => "true or false".to_owned(),
        Scalar::Enum { .. } => "a value of an enumeration".to_owned(),
    }
}
