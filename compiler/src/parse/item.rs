//! Items: declarations around expressions, from the pairs of the grammar.
//!
//! Everything keeps its span, and nothing is looked up: a type is the span of its name. An item
//! that the grammar accepts in part becomes [`ItemKind::Broken`], so that uses of its name are not
//! reported.
//!
//! ```
//! use tltl_compiler::{ast::ItemKind, parse, source::Source};
//!
//! let text = "/// Far away.\npredicate far(d: f64 in m) = x > d";
//! let ast = parse::file(&Source::new("far.tltl", text))?;
//! let item = &ast.items()[0];
//! let ItemKind::Predicate(parameters, _) = &item.kind else { panic!("it is a predicate") };
//! let source = ast.source();
//! assert_eq!((&item.docs[..], source.slice(item.name)), (&["Far away.".to_owned()][..], "far"));
//! assert_eq!(source.slice(parameters[0].unit.as_ref().unwrap().span), "m");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::expression;
use crate::ast::{Ast, Attribute, Declaration, FieldType, Item, ItemKind, UnitFactor, WrittenUnit};
use crate::error::{Error, Kind};
use crate::grammar::{self, Pair, Rule, Tree};
use crate::source::Span;
use crate::token;

/// Adds the item of `pair`, whose text starts at byte `at` of the source.
pub(super) fn build(ast: &mut Ast, pair: Pair<'_>, at: usize, mistakes: &mut Vec<Error>) {
    let mut docs = Vec::new();
    let mut attributes = Vec::new();
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::doc => docs.push(doc_text(part.as_str())),
            Rule::attribute => attributes.push(attribute(part, at)),
            Rule::EOI => {}
            _ => {
                let span = place(&part, at);
                let (name, kind) = declaration(ast, part, at, mistakes);
                check_word(ast, name, mistakes);
                let (docs, attributes) =
                    (std::mem::take(&mut docs), std::mem::take(&mut attributes));
                ast.push_item(Item { attributes, docs, name, kind, span });
            }
        }
    }
}

/// Adds the header `|name: &Type|` as an item.
pub(super) fn header(ast: &mut Ast, pair: &Pair<'_>) {
    let mut parts = pair.clone().into_inner();
    let (Some(name), Some(ty)) = (parts.next(), parts.next()) else { return };
    let kind = ItemKind::Host(trimmed(ast, place(&ty, 0)));
    let (name, span) = (place(&name, 0), place(pair, 0));
    ast.push_item(Item { attributes: Vec::new(), docs: Vec::new(), name, kind, span });
}

/// The attribute of `pair`.
pub(super) fn attribute(pair: Pair<'_>, at: usize) -> Attribute {
    let mut name = Span::default();
    let mut settings = Vec::new();
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::identifier => name = place(&part, at),
            Rule::setting => {
                let mut sides = part.into_inner().map(|side| place(&side, at));
                settings.extend(sides.next().zip(sides.next()));
            }
            _ => {}
        }
    }
    Attribute { name, settings }
}

/// Adds an item that can only be read in part: its name, so that its uses are not reported as
/// unknown, and its parameters if they can be read.
pub(super) fn broken(ast: &mut Ast, span: Span, mistakes: &mut Vec<Error>) {
    let Some(name) = token::item_name(ast.source().text(), span) else { return };
    let source = ast.source().clone();
    let heading = grammar::parse(Rule::heading, source.slice(span)).ok();
    let parts = heading.iter().flat_map(Tree::pairs);
    let mut takes = parts.filter(|part| part.as_rule() == Rule::parameters);
    let fields = takes.next().map(|part| declarations(part, span.start)).unwrap_or_default();
    fields.iter().for_each(|field| check_word(ast, field.name, mistakes));
    let kind = ItemKind::Broken(fields);
    ast.push_item(Item { attributes: Vec::new(), docs: Vec::new(), name, kind, span });
}

/// The text of a doc comment: without slashes and without the blank after them.
pub(super) fn doc_text(comment: &str) -> String {
    let text = comment.get(3..).unwrap_or_default();
    text.strip_prefix(' ').unwrap_or(text).trim_end().to_owned()
}

/// The span of `pair`, whose text starts at byte `at` of the source.
pub(super) fn place(pair: &Pair<'_>, at: usize) -> Span {
    Span::new(pair.start(), pair.end()).shifted(at)
}

/// The name of an item and its kind.
fn declaration(
    ast: &mut Ast,
    pair: Pair<'_>,
    at: usize,
    mistakes: &mut Vec<Error>,
) -> (Span, ItemKind) {
    let rule = pair.as_rule();
    let mut name = Span::default();
    let mut names = Vec::new();
    let mut fields = Vec::new();
    let mut root = None;
    let mut host = None;
    let mut measured = None;
    let mut amount = Span::default();
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::identifier if name == Span::default() => name = place(&part, at),
            Rule::identifier => names.push(place(&part, at)),
            Rule::fields | Rule::parameters => {
                fields = declarations(part, at);
                // What stands after a dot is no operator.
                let letter = |name: Span| name.end - name.start == 1;
                let named = |field: &&Declaration| rule != Rule::record || !letter(field.name);
                fields.iter().filter(named).for_each(|field| check_word(ast, field.name, mistakes));
            }
            Rule::amount => amount = place(&part, at),
            Rule::host_type => host = Some(trimmed(ast, place(&part, at))),
            Rule::unit => measured = Some(unit(part, at)),
            Rule::expression => root = expression::build(ast, part, at, mistakes),
            _ => {}
        }
    }
    let kind = match (rule, root, host) {
        (Rule::step, ..) => return (Span::default(), ItemKind::Step { amount, unit: name }),
        (Rule::state, _, Some(ty)) => ItemKind::Host(ty),
        (Rule::state, ..) => ItemKind::State(fields),
        (Rule::record, ..) => ItemKind::Struct(fields),
        (Rule::enumeration, ..) => ItemKind::Enum(names),
        (Rule::constant, Some(root), _) => ItemKind::Constant(measured, root),
        (Rule::predicate, Some(root), _) => ItemKind::Predicate(fields, root),
        (Rule::task, Some(root), _) => ItemKind::Task(fields, root),
        _ => ItemKind::Broken(fields),
    };
    (name, kind)
}

/// The fields of a struct, or the parameters of a predicate or task.
fn declarations(pair: Pair<'_>, at: usize) -> Vec<Declaration> {
    let mut fields = Vec::new();
    for field in pair.into_inner().filter(|part| part.as_rule() == Rule::field_declaration) {
        let mut docs = Vec::new();
        let mut name = Span::default();
        for part in field.into_inner() {
            match part.as_rule() {
                Rule::doc => docs.push(doc_text(part.as_str())),
                Rule::identifier => name = place(&part, at),
                Rule::field_type => {
                    let docs = std::mem::take(&mut docs);
                    let ty = field_type(part, at);
                    fields.push(Declaration { docs, name, ty, unit: None });
                }
                Rule::unit => {
                    if let Some(field) = fields.last_mut() {
                        field.unit = Some(unit(part, at));
                    }
                }
                _ => {}
            }
        }
    }
    fields
}

/// A type with its array lengths.
fn field_type(pair: Pair<'_>, at: usize) -> FieldType {
    let span = place(&pair, at);
    let mut name = Span::default();
    let mut optional = false;
    let mut lengths = Vec::new();
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::path => name = place(&part, at),
            Rule::optional => optional = true,
            Rule::array_close => lengths.extend(part.into_inner().map(|part| place(&part, at))),
            _ => {}
        }
    }
    FieldType { name, optional, lengths, span }
}

/// A unit as written.
fn unit(pair: Pair<'_>, at: usize) -> WrittenUnit {
    let span = place(&pair, at);
    let mut factors = Vec::new();
    let mut divides = false;
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::times => divides = false,
            Rule::divide => divides = true,
            Rule::unit_power => factors.push(unit_factor(part, at, divides)),
            _ => {}
        }
    }
    WrittenUnit { factors, span }
}

/// A name in a unit, with its power.
fn unit_factor(pair: Pair<'_>, at: usize, divides: bool) -> UnitFactor {
    let span = place(&pair, at);
    let (mut name, mut minus, mut power) = (span, false, None);
    for part in pair.into_inner() {
        match part.as_rule() {
            Rule::identifier => name = place(&part, at),
            Rule::minus => minus = true,
            Rule::digits => power = Some((place(&part, at), minus)),
            _ => {}
        }
    }
    UnitFactor { name, divides, power, span }
}

/// Refuses the word of an operator as a declared name.
fn check_word(ast: &Ast, name: Span, mistakes: &mut Vec<Error>) {
    let word = ast.source().slice(name);
    let Some(meaning) = token::keyword(word) else { return };
    mistakes.push(
        Error::new(Kind::Keyword, format!("`{word}` cannot be a name: it means {meaning}"), name)
            .help(format!("choose another name, such as `{word}_` or a longer word")),
    );
}

/// A span without the blanks at its ends.
fn trimmed(ast: &Ast, span: Span) -> Span {
    let text = ast.source().slice(span);
    let start = span.start + text.len() - text.trim_start().len();
    Span::new(start, start + text.trim().len())
}
