//! Source text to [`Ast`].
//!
//! pest recognises the tokens and the shape of items; the operator-precedence parser in
//! `expression` builds the arena. Items are parsed one by one, so that a mistake in one does not
//! hide the mistakes in the next. Nothing here looks a name up.

mod expression;
mod item;
mod message;

use pest::Parser;

use crate::ast::{Ast, Item, ItemKind};
use crate::error::{Error, Errors, Kind};
use crate::grammar::{Grammar, Rule};
use crate::source::{Source, Span};
use crate::token;

type Pair<'a> = pest::iterators::Pair<'a, Rule>;

/// The deepest nesting of braces.
const BRACES: usize = 64;

/// Parses a bare formula.
///
/// # Errors
/// If it is not one.
pub fn formula(source: &Source) -> Result<Ast, Errors> {
    finish(one(source, Rule::formula))
}

/// Parses a task file.
///
/// # Errors
/// All mistakes of form that it has.
pub fn file(source: &Source) -> Result<Ast, Errors> {
    finish(items(source))
}

/// Parses what stands inside `tltl!{ … }`: a formula, a header `|s: &S|` and a formula, or items.
///
/// # Errors
/// All mistakes of form that it has.
pub fn fragment(source: &Source) -> Result<Ast, Errors> {
    finish(recover_fragment(source))
}

/// Parses as much of a bare formula as there is.
pub(crate) fn recover_formula(source: &Source) -> (Ast, Vec<Error>) {
    one(source, Rule::formula)
}

/// Parses as much of a task file as there is.
pub(crate) fn recover_file(source: &Source) -> (Ast, Vec<Error>) {
    items(source)
}

/// Parses as much of the macro's input as there is.
pub(crate) fn recover_fragment(source: &Source) -> (Ast, Vec<Error>) {
    if token::starts_with_item(source.text()) { items(source) } else { one(source, Rule::fragment) }
}

fn finish((ast, mistakes): (Ast, Vec<Error>)) -> Result<Ast, Errors> {
    Errors::split(mistakes).map(|_| ast)
}

fn one(source: &Source, rule: Rule) -> (Ast, Vec<Error>) {
    let mut ast = Ast::new(source.clone());
    if let Err(error) = shallow(source) {
        return (ast, vec![error]);
    }
    let pairs = match Grammar::parse(rule, source.text()) {
        Ok(pairs) => pairs,
        Err(error) => return (ast, vec![message::sentence(source, 0, &error)]),
    };
    let mut mistakes = Vec::new();
    let mut attributes = Vec::new();
    for pair in pairs {
        match pair.as_rule() {
            Rule::attribute => attributes.push(item::attribute(pair, 0)),
            Rule::header => item::header(&mut ast, &pair),
            Rule::expression => {
                if let Some(root) = expression::build(&mut ast, pair, 0, &mut mistakes) {
                    let (name, span) = (Span::default(), ast.entry(root).span);
                    let kind = ItemKind::Task(Vec::new(), root);
                    let attributes = std::mem::take(&mut attributes);
                    ast.push_item(Item { attributes, docs: Vec::new(), name, kind, span });
                }
            }
            _ => {}
        }
    }
    (ast, mistakes)
}

fn items(source: &Source) -> (Ast, Vec<Error>) {
    let mut ast = Ast::new(source.clone());
    if let Err(error) = shallow(source) {
        return (ast, vec![error]);
    }
    let mut mistakes = Vec::new();
    let mut at = prologue(&mut ast, source);
    while at < source.text().len() {
        at = match Grammar::parse(Rule::next, &source.text()[at..]) {
            Ok(pairs) => {
                let mut end = source.text().len();
                for pair in pairs.filter(|pair| pair.as_rule() == Rule::item) {
                    end = at + pair.as_span().end();
                    item::build(&mut ast, pair, at, &mut mistakes);
                }
                end
            }
            Err(error) => {
                let mistake = message::sentence(source, at, &error);
                let next = token::next_item(source.text(), at, mistake.span().start);
                let readable = &source.text()[at..mistake.span().start];
                match Grammar::parse(Rule::next, readable) {
                    Ok(pairs) => pairs
                        .filter(|pair| pair.as_rule() == Rule::item)
                        .for_each(|pair| item::build(&mut ast, pair, at, &mut mistakes)),
                    Err(_) => item::broken(&mut ast, Span::new(at, next), &mut mistakes),
                }
                mistakes.push(mistake);
                next
            }
        };
    }
    (ast, mistakes)
}

/// Reads the docs of the file and returns where they end.
fn prologue(ast: &mut Ast, source: &Source) -> usize {
    let Ok(pairs) = Grammar::parse(Rule::prologue, source.text()) else { return 0 };
    let mut end = 0;
    let mut docs = Vec::new();
    for pair in pairs.filter(|pair| pair.as_rule() == Rule::file_doc) {
        end = pair.as_span().end();
        docs.push(item::doc_text(pair.as_str()));
    }
    ast.set_docs(docs);
    end
}

/// Refuses braces so deep that the one recursive rule of the grammar would run out of stack.
fn shallow(source: &Source) -> Result<(), Error> {
    let mut depth = 0_usize;
    for (at, byte) in source.text().bytes().enumerate() {
        match byte {
            b'{' if depth == BRACES => {
                let message = format!("braces nest more than {BRACES} deep");
                return Err(Error::new(Kind::Nesting, message, Span::new(at, at + 1))
                    .help("name the inner expression in Rust and use the name here"));
            }
            b'{' => depth += 1,
            b'}' => depth = depth.saturating_sub(1),
            _ => {}
        }
    }
    Ok(())
}
