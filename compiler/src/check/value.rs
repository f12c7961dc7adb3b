//! Values of enumerations, places of the state, and Rust expressions: the leaves that are not
//! simple numbers.
//!
//! The name of a value does not say its enumeration, because several may share the name. The
//! neighbour does: the other side of a comparison, the index of a table, the type of a parameter.
//! Only if none of them does is the name ambiguous.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "enum Room { hall, none_of_these }
//! enum Mood { hall, calm }
//! state Robot { at: Room, mood: Mood }
//! task settle = F (at == hall && mood == hall)";
//! let module = check::file(&Source::new("robot.tltl", text))?;
//! // One word, two values: the other side says which.
//! assert_eq!(module.tasks[0].spec.propositions(), ["at == hall", "mood == hall"]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::rc::Rc;

use super::lower::Lowering;
use crate::ast::{Comparison, Node};
use crate::error::{Error, Kind};
use crate::predicate::{Binding, ConditionId, ParameterType, Scalar, Step, Term, TermId};
use crate::resolve::{
    Bound, Expression, ExpressionId, Name, Names, Place, Segment, Sort, Value, name, sort_of,
};
use crate::token::{compact, mentions};

impl Lowering<'_> {
    /// The parameter that the name `id` stands for.
    pub(super) fn parameter(&mut self, id: ExpressionId, ty: ParameterType) -> TermId {
        let name = self.resolved.text(id).to_owned();
        self.arena.add_term(Term::Parameter { name, ty })
    }

    /// The value `id`, of the enumeration `expected` if that is known.
    pub(super) fn value(&mut self, id: ExpressionId, expected: Option<u32>) -> Option<TermId> {
        let resolved = self.resolved;
        let (values, may_be_place) = match &resolved[id].expression {
            Expression::Name(Name::Parameter { ty, .. }) => return Some(self.parameter(id, *ty)),
            Expression::Name(Name::Value(value)) => return Some(self.variant(*value)),
            Expression::Name(Name::Values(values)) => (&values[..], false),
            Expression::Name(Name::Item(_, values) | Name::Place(_, values)) => (&values[..], true),
            _ => (&[][..], false),
        };
        if let Some(value) = values.iter().find(|value| Some(value.of) == expected) {
            return Some(self.variant(*value));
        }
        let declared = may_be_place && resolved.names == Names::Declared;
        let is_place = declared && self.find_place(id).is_ok();
        // Beside Rust alone, `none` is a name of Rust.
        let is_known = expected.is_some() || resolved.names != Names::Host;
        match (values, expected) {
            ([first, second, ..], None) if !is_place => {
                self.refuse(self.ambiguous(id, *first, *second))
            }
            ([first, ..], _) if !is_place => Some(self.variant(*first)),
            _ if is_known && resolved[id].expression == Expression::Name(Name::Absent) => {
                Some(self.arena.add_term(Term::Absent))
            }
            _ if resolved.names == Names::Host => self.rust(id, true),
            (_, Some(of)) if !is_place => self.refuse(self.not_a_value(id, of)),
            _ => self.place_of_value(id),
        }
    }

    /// The place `id`, which must hold a value.
    fn place_of_value(&mut self, id: ExpressionId) -> Option<TermId> {
        let (term, scalar) = self.place(id)?;
        let what = match scalar {
            Scalar::Enum { .. } => return Some(term),
            Scalar::Bool => "true or false",
            Scalar::Number(_) => "a number",
        };
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is {what}, but a value of an enumeration is needed here");
        self.refuse(self.resolved.type_error(id, message))
    }

    /// A value as a term.
    fn variant(&mut self, Value { of, number }: Value) -> TermId {
        let name = self.resolved.scope.enums[of as usize].variants[number as usize].clone();
        self.arena.add_term(Term::Variant { of, number, name })
    }

    /// The error for a name that several enumerations have.
    fn ambiguous(&self, id: ExpressionId, first: Value, second: Value) -> Error {
        let text = self.resolved.text(id);
        let (one, two) = (self.enum_name(first.of), self.enum_name(second.of));
        let message = format!("`{text}` is a value of `{one}` and of `{two}`");
        self.resolved.type_error(id, message).help(format!("say which: `{one}::{text}`"))
    }

    /// The error for a name that the expected enumeration does not have.
    fn not_a_value(&self, id: ExpressionId, of: u32) -> Error {
        let known = &self.resolved.scope.enums[of as usize];
        let text = self.resolved.quote(id);
        let message = format!("`{text}` is not a value of `{}`", known.name);
        let error = Error::new(Kind::UnknownName, message, self.resolved.span(id));
        let near =
            self.resolved.scope.suggestion(&text, &mut known.variants.iter().map(String::as_str));
        error.help(near.unwrap_or_else(|| format!("its values are {}", listed(&known.variants))))
    }

    /// The name of an enumeration.
    pub(super) fn enum_name(&self, of: u32) -> &str {
        &self.resolved.scope.enums[of as usize].name
    }

    /// The condition that two values are equal, or different.
    pub(super) fn compare_values(
        &mut self,
        id: ExpressionId,
        op: Comparison,
        sides: [ExpressionId; 2],
    ) -> Option<ConditionId> {
        let expected = sides.into_iter().find_map(|side| match self.resolved.sort(side) {
            Some(Sort::Enum { of, .. }) => Some(of),
            _ => None,
        });
        let terms = sides.map(|side| self.value(side, expected));
        let [left, right] = [terms[0]?, terms[1]?];
        match self.unlike(id, sides, [left, right]) {
            Some(error) => self.refuse(error),
            None => Some(self.arena.compare(op, left, right)),
        }
    }

    /// The error for two values that can never be equal because of their types.
    fn unlike(
        &self,
        id: ExpressionId,
        sides: [ExpressionId; 2],
        terms: [TermId; 2],
    ) -> Option<Error> {
        let resolved = self.resolved;
        let [one, two] = sides.map(|side| resolved.quote(side));
        match terms.map(|term| self.term_sort(term)) {
            [Some(Sort::Enum { of: a, .. }), Some(Sort::Enum { of: b, .. })] if a != b => {
                let (a, b) = (self.enum_name(a), self.enum_name(b));
                let message = format!(
                    "`{one}` is a value of `{a}`, and `{two}` one of `{b}`: they cannot be compared"
                );
                Some(resolved.type_error(id, message))
            }
            [Some(Sort::Enum { optional: false, .. }), Some(Sort::Absent)]
            | [Some(Sort::Absent), Some(Sort::Enum { optional: false, .. })] => {
                let always = if one == "none" { two } else { one };
                let message = format!("`{always}` always has a value, so it is never `none`");
                Some(resolved.type_error(id, message).help(
                    "a field that may have none is declared with `?`, as in `holding: Object?`",
                ))
            }
            _ => None,
        }
    }

    /// The sort of a term that is a value.
    fn term_sort(&self, term: TermId) -> Option<Sort> {
        match self.arena.term(term) {
            Term::Variant { of, .. } => Some(Sort::Enum { of: *of, optional: false }),
            Term::Absent => Some(Sort::Absent),
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => sort_of(*scalar),
            _ => None,
        }
    }

    /// The value `id` as an index or an argument: it must be one of the enumeration `of`, or `none`
    /// where that is allowed.
    pub(super) fn value_of(&mut self, id: ExpressionId, of: u32, or_none: bool) -> Option<TermId> {
        let term = self.value(id, Some(of))?;
        let sort = self.term_sort(term);
        let fits = match sort {
            Some(Sort::Enum { of: found, optional }) => found == of && (or_none || !optional),
            Some(Sort::Absent) => or_none,
            None => self.resolved.names == Names::Host,
            _ => false,
        };
        if fits { Some(term) } else { self.refuse(self.not_this_value(id, of, sort)) }
    }

    /// The error for a value of another enumeration.
    fn not_this_value(&self, id: ExpressionId, of: u32, sort: Option<Sort>) -> Error {
        let (text, wanted) = (self.resolved.quote(id), self.enum_name(of));
        let what = match sort {
            Some(Sort::Enum { of: found, .. }) if found == of => "may be `none`".to_owned(),
            Some(Sort::Enum { of: found, .. }) => {
                format!("is a value of `{}`", self.enum_name(found))
            }
            _ => "is none".to_owned(),
        };
        let message = format!("a value of `{wanted}` is needed here, but `{text}` {what}");
        self.resolved.type_error(id, message)
    }

    /// The error for a value where `wanted` should stand.
    pub(super) fn value_instead(&self, id: ExpressionId, sort: Sort, wanted: &str) -> Error {
        let text = self.resolved.quote(id);
        let (what, example) = match sort {
            Sort::Enum { of, .. } => {
                let first = self.resolved.scope.first_variant(of);
                (format!("a value of `{}`", self.enum_name(of)), format!("`{text} == {first}`"))
            }
            Sort::Variant | Sort::Absent => {
                ("a value of an enumeration".into(), format!("`place == {text}`"))
            }
            Sort::Host => ("a value".into(), format!("`{text} == …`")),
        };
        let message = format!("`{text}` is {what}, but {wanted} is needed here");
        self.resolved
            .type_error(id, message)
            .help(format!("compare it with another, such as {example}"))
    }

    /// The place `id` as a term, and the type there.
    pub(super) fn place(&mut self, id: ExpressionId) -> Option<(TermId, Scalar)> {
        let found = self.find_place(id).map_err(|error| self.mistakes.extend(error));
        let (place, scalar) = found.ok()?;
        let steps = place.segments.iter().map(|segment| self.step(segment));
        let steps = steps.collect::<Option<_>>()?;
        Some((self.arena.add_term(Term::Place { steps, scalar }), scalar))
    }

    /// One step of a path. Recurses into places as indices, whose nesting is bounded.
    fn step(&mut self, segment: &Segment) -> Option<Step> {
        Some(match *segment {
            Segment::Field(name) => Step::Field(self.resolved.ast.source().slice(name).to_owned()),
            Segment::Index(index) => Step::Index(index),
            Segment::Element { index, of } => Step::Element(self.value_of(index, of, false)?),
            Segment::At { index, length } => {
                let index = match &self.resolved[index].expression {
                    Expression::Name(Name::Parameter { ty, .. }) => self.parameter(index, *ty),
                    _ => self.place(index)?.0,
                };
                Step::At { index, length }
            }
        })
    }

    /// The place `id` and the type there, or its error; `Err(None)` if that follows from a mistake
    /// in a declaration.
    fn find_place(&self, id: ExpressionId) -> Result<(Rc<Place>, Scalar), Option<Error>> {
        let resolved = self.resolved;
        let error = match resolved.place(id, self.item) {
            Ok(place) => match place.scalar() {
                Some(scalar) => return Ok((place, scalar)),
                None => resolved.not_a_scalar(id, &place.ty),
            },
            Err(error) => Rc::unwrap_or_clone(error),
        };
        let follows =
            error.kind() == Kind::UnknownName && resolved.scope.is_broken(resolved.text(id));
        Err((!follows).then_some(error))
    }

    /// A Rust expression as a term: a value, or a number.
    pub(super) fn rust(&mut self, id: ExpressionId, value: bool) -> Option<TermId> {
        let (text, bindings) = self.rust_text(id)?;
        let span = self.resolved.span(id);
        Some(self.arena.add_term(Term::Host { text, span, bindings, value }))
    }

    /// The text of a Rust expression, and the meaning of the parameters and bound names in it.
    pub(super) fn rust_text(&mut self, id: ExpressionId) -> Option<(String, Vec<Binding>)> {
        if let Some(error) = self.unlike_rust(id) {
            return self.refuse(error);
        }
        let resolved = self.resolved;
        let text = compact(resolved.text(id));
        let mut bindings = Vec::new();
        for parameter in resolved.scope.parameters(self.item) {
            let (name, ty) = (parameter.name.clone(), parameter.ty);
            if mentions(&text, &name) {
                let term = self.arena.add_term(Term::Parameter { name: name.clone(), ty });
                bindings.push(Binding { name, scalar: ty.scalar(), term });
            }
        }
        let binders: Vec<_> = resolved.binders(resolved[id].environment).collect();
        for (name, bound) in binders.into_iter().rev().filter(|(name, _)| mentions(&text, name)) {
            let (name, term) = (name.to_owned(), self.bound(bound));
            bindings.push(Binding { name, scalar: None, term });
        }
        Some((text, bindings))
    }

    /// The term of a bound name in a Rust expression.
    fn bound(&mut self, bound: Bound) -> TermId {
        match bound {
            Bound::Value(value) => self.variant(value),
            Bound::Number(value) => self.arena.number(value),
            Bound::Node(element) => {
                let ast = self.resolved.ast;
                let (text, span) = (compact(ast.text(element)), ast.span(element));
                self.arena.add_term(Term::Host { text, span, bindings: Vec::new(), value: true })
            }
        }
    }

    /// The error for something in an expression that Rust would not read so: a keyword as a name,
    /// an unknown part of a path.
    fn unlike_rust(&self, id: ExpressionId) -> Option<Error> {
        let resolved = self.resolved;
        for at in (resolved[id].first.0..=id.0).map(ExpressionId) {
            let span = match (&resolved[at].expression, resolved.ast.node(resolved[at].node)) {
                (Expression::Name(Name::Unknown(error)), _) => return Some((**error).clone()),
                (Expression::Name(Name::Value(_)), _) => continue,
                (Expression::Name(_), Node::Name) => resolved.span(at),
                (_, Node::Field { field, .. }) => *field,
                _ => continue,
            };
            let words = resolved.ast.source().slice(span).split("::").map(str::trim);
            if let Some(word) = words.into_iter().find(|word| name::is_rust_word(word)) {
                let message = format!("`{word}` is a keyword of Rust, and no name");
                return Some(
                    Error::new(Kind::Keyword, message, span)
                        .help(format!("what is called so in Rust is written `r#{word}`")),
                );
            }
        }
        None
    }
}

/// Names as a message lists them: at most twelve.
fn listed(names: &[String]) -> String {
    /// The most names that a message lists.
    const MOST: usize = 12;
    let shown = names.iter().take(MOST).map(|name| format!("`{name}`")).collect::<Vec<_>>();
    let more = if names.len() > MOST { ", …" } else { "" };
    shown.join(", ") + more
}
