//! Values of enumerations: what can only be equal to another or not, and be an index.

use super::term::Pending;
use super::{Checker, Names, name};
use crate::ast::{Comparison, Node, NodeId};
use crate::error::{Error, Kind};
use crate::predicate::{
    Binding, ConditionId, Parameter, ParameterType, Scalar, Step, Term, TermId,
};
use crate::source::Span;

use super::expand::Bound;

/// What sort of value an expression is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Sort {
    /// Of an enumeration, if it is not absent.
    Enum { of: u32, optional: bool },
    /// The name of a value; what stands beside it may have to tell of which enumeration.
    Variant,
    /// `none`
    Absent,
    /// Of a Rust type of the user's.
    Host,
}

impl Checker<'_> {
    /// The parameter that the name `id` is.
    pub(super) fn parameter(&self, id: NodeId) -> Option<&Parameter> {
        let is_name = matches!(self.ast.node(id), Node::Name);
        self.parameters.iter().find(|known| is_name && known.name == self.ast.text(id))
    }

    /// What sort of value `id` is; `None` if it is none, such as a number.
    pub(super) fn sort(&self, id: NodeId) -> Option<Sort> {
        self.sort_within(id, 0)
    }

    pub(super) fn sort_within(&self, id: NodeId, depth: usize) -> Option<Sort> {
        if let Some(parameter) = self.parameter(id) {
            return match parameter.ty {
                ParameterType::Host(_) => Some(Sort::Host),
                ParameterType::Scalar(scalar) => sort_of(scalar),
            };
        }
        match self.ast.node(id) {
            Node::Variant { of, .. } => Some(Sort::Enum { of: *of, optional: false }),
            Node::Name | Node::Field { .. } | Node::Index { .. } => {
                let text = self.ast.text(id);
                if self.names == Names::Free || self.scope.item(text).is_some() {
                    return None;
                }
                if self.names == Names::Declared
                    && let Ok((_, scalar)) = self.find_place(id, depth)
                {
                    return sort_of(scalar);
                }
                match text {
                    _ if !self.scope.variants(text).is_empty() => Some(Sort::Variant),
                    "none" => Some(Sort::Absent),
                    _ => None,
                }
            }
            _ => None,
        }
    }

    /// The value `id`, of the enumeration `expected` if that is known.
    pub(super) fn value(&mut self, id: NodeId, expected: Option<u32>) -> Option<TermId> {
        if let Some(parameter) = self.parameter(id) {
            let term = Term::Parameter { name: parameter.name.clone(), ty: parameter.ty };
            return Some(self.module.arena.add_term(term));
        }
        let found = match *self.ast.node(id) {
            Node::Variant { of, number } => Ok(Some((of, number))),
            Node::Name => self.variant(id, expected),
            _ => Ok(None),
        };
        match found {
            Ok(Some((of, number))) => Some(self.add_variant(of, number)),
            Ok(None) if self.names == Names::Host => {
                self.refuse_unlike_rust(id)?;
                Some(self.host_term(id, true))
            }
            Ok(None) if self.ast.text(id) == "none" => {
                Some(self.module.arena.add_term(Term::Absent))
            }
            Ok(None) => self.value_place(id, expected),
            Err(error) => {
                self.mistakes.push(error);
                None
            }
        }
    }

    fn add_variant(&mut self, of: u32, number: u32) -> TermId {
        let name = self.scope.enums[of as usize].variants[number as usize].clone();
        self.module.arena.add_term(Term::Variant { of, number, name })
    }

    /// The value that the name `id` is, if it is one.
    fn variant(&self, id: NodeId, expected: Option<u32>) -> Result<Option<(u32, u32)>, Error> {
        let text = self.ast.text(id);
        let all = self.scope.variants(text);
        if let Some(found) = all.iter().find(|(of, _)| Some(*of) == expected) {
            return Ok(Some(*found));
        }
        let is_place = self.names == Names::Declared && self.find_place(id, 0).is_ok();
        match all[..] {
            [first, second, ..] if expected.is_none() && !is_place => {
                let (one, two) = (self.enum_name(first.0), self.enum_name(second.0));
                let message = format!("`{text}` is a value of `{one}` and of `{two}`");
                Err(Error::new(Kind::Type, message, self.ast.span(id))
                    .help(format!("say which: `{one}::{text}`")))
            }
            [first, ..] if !is_place => Ok(Some(first)),
            _ => Ok(None),
        }
    }

    fn value_place(&mut self, id: NodeId, expected: Option<u32>) -> Option<TermId> {
        let text = self.ast.quote(id);
        let place =
            matches!(self.ast.node(id), Node::Name | Node::Field { .. } | Node::Index { .. });
        let known = place.then(|| self.find_place(id, 0).ok()).flatten();
        if let (None, Some(of)) = (&known, expected) {
            let error = self.not_a_value(&text, of, self.ast.span(id));
            self.mistakes.push(error);
            return None;
        }
        let place = self.place(id)?;
        if !matches!(place.scalar, Scalar::Enum { .. }) {
            let what = if place.scalar == Scalar::Bool { "true or false" } else { "a number" };
            let message =
                format!("`{text}` is {what}, but a value of an enumeration is needed here");
            self.mistakes.push(Error::new(Kind::Type, message, self.ast.span(id)));
            return None;
        }
        Some(self.module.arena.add_term(Term::Place { steps: place.steps, scalar: place.scalar }))
    }

    fn not_a_value(&self, text: &str, of: u32, span: Span) -> Error {
        let known = &self.scope.enums[of as usize];
        let message = format!("`{text}` is not a value of `{}`", known.name);
        let error = Error::new(Kind::UnknownName, message, span);
        match name::nearest(text, &mut known.variants.iter().map(String::as_str)) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!("its values are {}", listed(&known.variants))),
        }
    }

    pub(super) fn enum_name(&self, of: u32) -> &str {
        &self.scope.enums[of as usize].name
    }

    /// A Rust expression, with what the names of parameters in it stand for; a value, or a number.
    pub(super) fn host_term(&mut self, id: NodeId, value: bool) -> TermId {
        let (text, bindings) = (self.compact(id), self.bindings(id));
        let term = Term::Host { text, span: self.ast.span(id), bindings, value };
        self.module.arena.add_term(term)
    }

    /// Refuses what is no Rust in the name or the path `id`: a word that Rust has for itself, a part of
    /// a number, which may be written as Rust does not.
    pub(super) fn refuse_unlike_rust(&mut self, id: NodeId) -> Option<()> {
        for at in (self.ast.first(id).0..=id.0).map(NodeId) {
            let span = match *self.ast.node(at) {
                Node::Name => self.ast.span(at),
                Node::Field { base, .. } | Node::Index { base, .. }
                    if matches!(self.ast.node(base), Node::Number(_)) =>
                {
                    let error = self.not_a_place(base);
                    self.mistakes.push(error);
                    return None;
                }
                Node::Field { field, .. } => field,
                _ => continue,
            };
            let text = self.ast.source().slice(span);
            let words = text.split("::").map(str::trim);
            if let Some(word) = words.into_iter().find(|word| name::is_rust_word(word)) {
                let message = format!("`{word}` is a keyword of Rust, and no name");
                let error = Error::new(Kind::Keyword, message, span);
                self.mistakes
                    .push(error.help(format!("what is called so in Rust is written `r#{word}`")));
                return None;
            }
        }
        Some(())
    }

    /// What the parameters and the bound names stand for that the Rust expression `id` mentions.
    pub(super) fn bindings(&mut self, id: NodeId) -> Vec<Binding> {
        let text = self.compact(id);
        let mentioned = |name: &str| crate::token::mentions(&text, name);
        let mut bindings = Vec::new();
        for parameter in self.parameters.iter().filter(|known| mentioned(&known.name)) {
            let (name, ty) = (parameter.name.clone(), parameter.ty);
            let term = self.module.arena.add_term(Term::Parameter { name: name.clone(), ty });
            bindings.push(Binding { name, scalar: ty.scalar(), term });
        }
        let Some(environment) = self.bound.get(&id).cloned() else { return bindings };
        for (name, bound) in environment.iter().filter(|(name, _)| mentioned(name)) {
            let term = match *bound {
                Bound::Variant(of, number) => self.add_variant(of, number),
                Bound::Element(element) => {
                    let text = crate::token::compact(self.written.text(element));
                    let span = self.written.span(element);
                    let term = Term::Host { text, span, bindings: Vec::new(), value: true };
                    self.module.arena.add_term(term)
                }
                Bound::Number(value) => self.number(value),
            };
            bindings.push(Binding { name: name.clone(), scalar: None, term });
        }
        bindings
    }

    /// Whether two values are equal, or different.
    pub(super) fn compare_values(
        &mut self,
        id: NodeId,
        op: Comparison,
        sides: [NodeId; 2],
    ) -> Option<ConditionId> {
        let sorts = sides.map(|side| self.sort(side));
        let expected = sorts.into_iter().find_map(|sort| match sort {
            Some(Sort::Enum { of, .. }) => Some(of),
            _ => None,
        });
        let terms = sides.map(|side| self.value(side, expected));
        let [left, right] = [terms[0]?, terms[1]?];
        if let Some(error) = self.unlike(id, sides, [left, right]) {
            self.mistakes.push(error);
            return None;
        }
        Some(self.module.arena.compare(op, left, right))
    }

    /// The error for values that can never be equal because of what they are.
    fn unlike(&self, id: NodeId, sides: [NodeId; 2], terms: [TermId; 2]) -> Option<Error> {
        let span = self.ast.span(id);
        let texts = sides.map(|side| self.ast.quote(side));
        match terms.map(|term| self.term_sort(term)) {
            [Some(Sort::Enum { of: a, .. }), Some(Sort::Enum { of: b, .. })] if a != b => {
                let (a, b) = (self.enum_name(a), self.enum_name(b));
                let message = format!(
                    "`{}` is a value of `{a}`, and `{}` one of `{b}`: they cannot be compared",
                    texts[0], texts[1]
                );
                Some(Error::new(Kind::Type, message, span))
            }
            [Some(Sort::Enum { optional: false, .. }), Some(Sort::Absent)]
            | [Some(Sort::Absent), Some(Sort::Enum { optional: false, .. })] => {
                let always = if texts[0] == "none" { &texts[1] } else { &texts[0] };
                let message = format!("`{always}` always has a value, so it is never `none`");
                Some(Error::new(Kind::Type, message, span).help(
                    "a field that may have none is declared with `?`, as in `holding: Object?`",
                ))
            }
            _ => None,
        }
    }

    fn term_sort(&self, term: TermId) -> Option<Sort> {
        match self.module.arena.term(term) {
            Term::Variant { of, .. } => Some(Sort::Enum { of: *of, optional: false }),
            Term::Absent => Some(Sort::Absent),
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => sort_of(*scalar),
            _ => None,
        }
    }

    /// The value `id` where one of the enumeration `of` must stand, or `none` if that may be: an
    /// index or an argument.
    pub(super) fn value_of(&mut self, id: NodeId, of: u32, or_none: bool) -> Option<TermId> {
        let term = self.value(id, Some(of))?;
        let error = match self.term_sort(term) {
            Some(Sort::Enum { of: found, optional }) if found == of && (or_none || !optional) => {
                return Some(term);
            }
            Some(Sort::Absent) if or_none => return Some(term),
            None if self.names == Names::Host => return Some(term),
            sort => self.not_this_value(id, of, sort),
        };
        self.mistakes.push(error);
        None
    }

    fn not_this_value(&self, id: NodeId, of: u32, sort: Option<Sort>) -> Error {
        let (text, wanted) = (self.ast.quote(id), self.enum_name(of));
        let what = match sort {
            Some(Sort::Enum { of: found, .. }) if found == of => "may be `none`".to_owned(),
            Some(Sort::Enum { of: found, .. }) => {
                format!("is a value of `{}`", self.enum_name(found))
            }
            _ => "is none".to_owned(),
        };
        let message = format!("a value of `{wanted}` is needed here, but `{text}` {what}");
        Error::new(Kind::Type, message, self.ast.span(id))
    }

    /// The steps to a place, each index as a value.
    pub(super) fn steps(&mut self, pending: Vec<Pending>) -> Option<Vec<Step>> {
        pending
            .into_iter()
            .map(|step| match step {
                Pending::Step(step) => Some(step),
                Pending::Element(index, of) => self.value_of(index, of, false).map(Step::Element),
                Pending::At(index, length) => {
                    let index = self.index_term(index)?;
                    Some(Step::At { index, length })
                }
            })
            .collect()
    }

    /// The error for a value where `wanted` should stand.
    pub(super) fn value_instead(&self, id: NodeId, sort: Sort, wanted: &str) -> Error {
        let text = self.ast.quote(id);
        let (what, example) = match sort {
            Sort::Enum { of, .. } => {
                let known = &self.scope.enums[of as usize];
                let first = known.variants.first().map_or("value", String::as_str);
                (format!("a value of `{}`", known.name), format!("`{text} == {first}`"))
            }
            Sort::Variant | Sort::Absent => {
                ("a value of an enumeration".into(), format!("`place == {text}`"))
            }
            Sort::Host => ("a value".into(), format!("`{text} == …`")),
        };
        let message = format!("`{text}` is {what}, but {wanted} is needed here");
        Error::new(Kind::Type, message, self.ast.span(id))
            .help(format!("compare it with another, such as {example}"))
    }
}

fn sort_of(scalar: Scalar) -> Option<Sort> {
    match scalar {
        Scalar::Enum { of, optional } => Some(Sort::Enum { of, optional }),
        _ => None,
    }
}

/// Names as a message lists them: not too many.
fn listed(names: &[String]) -> String {
    const MOST: usize = 12;
    let shown = names.iter().take(MOST).map(|name| format!("`{name}`")).collect::<Vec<_>>();
    let more = if names.len() > MOST { ", …" } else { "" };
    shown.join(", ") + more
}
