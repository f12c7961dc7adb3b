//! The meaning of single names, and suggestions for names that are nearly right.
//!
//! The order of the answers in [`Resolved::name`] is the scoping of the language: parameters,
//! items, places of the state, values, `none`, functions. Names of the first three kinds cannot
//! coincide without an error, so their order matters only for what else is reported.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state Robot { battery: f64 }\ntask charge = F batery > 9";
//! let errors = check::file(&Source::new("robot.tltl", text)).unwrap_err();
//! assert_eq!(errors.first().message(), "nothing here is called `batery`");
//! assert_eq!(errors.first().helps(), ["did you mean `battery`?"]);
//! ```

use std::rc::Rc;

use super::{Callee, Expression, ExpressionId, Name, Names, Resolved};
use crate::ast::{Node, NodeId, quoted};
use crate::error::{Error, Kind};
use crate::parse;
use crate::predicate::Function;
use crate::source::Span;

impl Resolved<'_> {
    /// The meaning of a name, or of another leaf, in the expression of `item`.
    pub(super) fn name(&self, node: NodeId, item: usize) -> Name {
        let text = self.ast.text(node);
        if !matches!(self.ast.node(node), Node::Name) {
            return match self.names {
                Names::Host => Name::Rust,
                _ => Name::Unknown(Rc::new(self.only_rust(node))),
            };
        }
        let values = self.scope.variants(text);
        let used = self.scope.item(text);
        let mut parameters = (0..).zip(self.scope.parameters(item));
        if let Some((number, known)) = parameters.find(|(_, known)| known.name == text) {
            return Name::Parameter { number, ty: known.ty, item: used };
        }
        if let Some(item) = used {
            return Name::Item(item, values);
        }
        let place = self.field_of_state(self.ast.span(node));
        let is_scalar = place.as_ref().is_some_and(|place| place.scalar().is_some());
        match (self.names, place) {
            (Names::Free, _) => Name::Free,
            (Names::Declared, Some(place)) if is_scalar => Name::Place(Rc::new(place), values),
            _ if !values.is_empty() => Name::Values(values),
            _ if text == "none" => Name::Absent,
            (Names::Host, _) => Name::Rust,
            (_, Some(place)) => Name::Place(Rc::new(place), values),
            (_, None) if Function::named(text).is_some() => Name::Function,
            (_, None) => Name::Unknown(Rc::new(self.unknown(self.ast.span(node), item))),
        }
    }

    /// The item and the function with the name `id`; if there is neither, the meaning of a call of
    /// it.
    pub(super) fn callee(&self, id: ExpressionId) -> Result<Callee, Name> {
        let is_name = matches!(self.ast.node(self[id].node), Node::Name);
        let (item, is_free) = match &self[id].expression {
            Expression::Name(Name::Item(item, _)) => (Some(*item), true),
            Expression::Name(Name::Parameter { item, .. }) => (*item, true),
            Expression::Name(Name::Value(_)) | Expression::Number(_) => (None, false),
            _ => (None, is_name),
        };
        let function = Function::named(self.text(id)).filter(|_| is_free);
        match (item, function, self.names) {
            (None, None, Names::Host) => Err(Name::Rust),
            (None, None, _) => Err(Name::Unknown(Rc::new(self.unknown_function(id)))),
            _ => Ok(Callee { item, function }),
        }
    }

    /// The error for a name in the expression of `item` that nothing declares.
    pub(super) fn unknown(&self, span: Span, item: usize) -> Error {
        let name = self.ast.source().slice(span);
        let message = format!("nothing here is called `{}`", quoted(name));
        let error = Error::new(Kind::UnknownName, message, span);
        let parameters = self.scope.parameters(item).iter().map(|known| known.name.as_str());
        let declare = match self.scope.has_state() {
            true => "declare it: `predicate name = …`, or a field of the state",
            false => "declare the state first: `state Name { x: f64 }`",
        };
        let near = self.scope.suggestion(name, &mut self.scope.known().chain(parameters));
        error.help(near.unwrap_or_else(|| declare.to_owned()))
    }

    /// The error for a call of something that is not a function.
    pub(super) fn unknown_function(&self, callee: ExpressionId) -> Error {
        let text = self.quote(callee);
        if let Some(error) = parse::foreign_call(&text, self.ast.source().text(), self.span(callee))
        {
            return error;
        }
        let message = format!("there is no function `{text}`");
        let error = Error::new(Kind::UnknownName, message, self.span(callee));
        if let Some(operators) = parse::apart(&text) {
            return error.help(format!("for the operators, write `{operators} (…)`"));
        }
        let names = Function::ALL.map(|(name, ..)| name);
        let near = self.scope.suggestion(&text, &mut names.into_iter());
        error.help(near.unwrap_or_else(|| format!("the functions are {}", names.join(", "))))
    }

    /// The error for a Rust expression outside of the macro.
    pub(super) fn only_rust(&self, node: NodeId) -> Error {
        let text = self.ast.quote(node);
        let message = format!("`{text}` is a Rust expression, which only the macro can read");
        Error::new(Kind::Type, message, self.ast.span(node))
    }
}

/// The candidate at the least distance, if that is at most a third of the letters of `name`, the
/// limit that rustc uses. The first of several, so the answer does not depend on anything but the
/// source. `None` also once `left`, the pairs of letters that may still be compared, runs out.
pub(super) fn nearest<'a>(
    name: &str,
    candidates: &mut dyn Iterator<Item = &'a str>,
    left: &mut usize,
) -> Option<&'a str> {
    let name = letters(name);
    let limit = (name.len() / 3).max(1);
    let mut nearest = None;
    for candidate in candidates {
        *left = left.checked_sub(1)?;
        // The distance is at least the difference of the lengths.
        if name.len().abs_diff(candidate.chars().count()) > limit {
            continue;
        }
        let known = letters(candidate);
        *left = left.checked_sub(name.len() * known.len())?;
        let distance = distance(&name, &known);
        if distance <= limit && nearest.is_none_or(|(known, _)| distance < known) {
            nearest = Some((distance, candidate));
        }
    }
    nearest.map(|(_, candidate)| candidate)
}

/// The letters of a name, case aside.
fn letters(name: &str) -> Vec<char> {
    name.to_lowercase().chars().collect()
}

/// The number of letters to add, drop, change or swap with their neighbour (optimal string
/// alignment).
fn distance(a: &[char], b: &[char]) -> usize {
    let mut rows = vec![(0..=b.len()).collect::<Vec<_>>()];
    for i in 1..=a.len() {
        let mut row = vec![i];
        for j in 1..=b.len() {
            let change = rows[i - 1][j - 1] + usize::from(a[i - 1] != b[j - 1]);
            let mut least = change.min(rows[i - 1][j] + 1).min(row[j - 1] + 1);
            if i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1] {
                least = least.min(rows[i - 2][j - 2] + 1);
            }
            row.push(least);
        }
        rows.push(row);
    }
    rows[a.len()][b.len()]
}

/// Whether a word is a keyword of Rust; a name of the same letters is written with `r#`.
pub(crate) fn is_rust_word(word: &str) -> bool {
    crate::reserved::is_keyword(word) && !matches!(word, "true" | "false")
}
