//! Source text to [`Ast`].
//!
//! The grammar recognizes the tokens and the shape of items; the operator-precedence parser in
//! `expression` builds the arena. A grammar for all of the syntax would recurse once a bracket, and
//! overflow the stack on deep input; so the grammar sees an expression as a flat sequence of tokens.
//!
//! Items are parsed one by one: a mistake in one does not hide the mistakes in the next. Where an
//! item cannot be read, as much of it as possible is kept, at least its name, so that its uses are
//! not reported as unknown.
//!
//! Nothing here looks a name up or asks for a type.
//!
//! ```
//! use tltl_compiler::{ast::ItemKind, parse, source::Source};
//!
//! let ast = parse::file(&Source::new("room.tltl", "/// Go home.\ntask back = F home U b\n"))?;
//! let item = &ast.items()[0];
//! assert_eq!(item.docs, ["Go home."]);
//! let ItemKind::Task(_, root) = item.kind else { panic!() };
//! // `F` binds tighter than `U`.
//! assert_eq!(ast.display(root).to_string(), "(F home) U b");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod bound;
mod expression;
mod foreign;
mod item;
mod message;

use crate::ast::{Ast, Item, ItemKind, quoted};
use crate::error::{Error, Errors, Kind};
use crate::grammar::{self, Rule};
use crate::source::{Source, Span};
use crate::token;

/// The deepest nesting of braces. Verbatim Rust is the one recursive rule of the grammar.
const BRACES: usize = 64;

/// Parses a bare formula.
///
/// ```
/// use tltl_compiler::{parse, source::Source};
///
/// assert!(parse::formula(&Source::new("formula", "F a && b")).is_ok());
/// let errors = parse::formula(&Source::new("formula", "F a & & b")).unwrap_err();
/// assert_eq!(errors.first().kind().name(), "syntax");
/// // Operators of other logics have an error of their own.
/// let errors = parse::formula(&Source::new("formula", "a S b")).unwrap_err();
/// assert_eq!(errors.first().kind().name(), "unsupported-operator");
/// ```
///
/// # Errors
/// All mistakes of form that it has.
pub fn formula(source: &Source) -> Result<Ast, Errors> {
    finish(one(source, Rule::formula))
}

/// Parses a task file.
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let text = "//! Rooms.\nenum Room { hall, attic }\ntask up = F (at == attic)\n";
/// let ast = parse::file(&Source::new("rooms.tltl", text))?;
/// assert_eq!(ast.docs(), ["Rooms."]);
/// let kinds: Vec<bool> = ast.items().iter().map(|item| matches!(item.kind, ItemKind::Enum(_))).collect();
/// assert_eq!(kinds, [true, false]);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes of form that it has.
pub fn file(source: &Source) -> Result<Ast, Errors> {
    finish(items(source))
}

/// Parses the input of `tltl!{ … }`: a formula, a header `|s: &S|` and a formula, or items.
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let ast = parse::fragment(&Source::new("macro", "|s: &Robot| F s.docked"))?;
/// let kinds = ast.items().iter().map(|item| &item.kind);
/// assert!(matches!(kinds.collect::<Vec<_>>()[..], [ItemKind::Host(_), ItemKind::Task(..)]));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
///
/// # Errors
/// All mistakes of form that it has.
pub fn fragment(source: &Source) -> Result<Ast, Errors> {
    finish(recover_fragment(source))
}

/// Whether a word is an operator or a constant where a formula stands, and no name.
///
/// ```
/// use tltl_compiler::parse::is_keyword;
///
/// assert!(is_keyword("U") && is_keyword("true"));
/// assert!(!is_keyword("Fridge"), "operators are whole words");
/// ```
#[must_use]
pub fn is_keyword(word: &str) -> bool {
    token::keyword(word).is_some()
}

/// Operators of other logics and tools, for the stages that know what a name means.
pub(crate) use foreign::{foreign_call, unsupported};
pub(crate) use message::apart;

/// Parses a bare formula as far as possible, with its mistakes.
#[must_use]
pub fn recover_formula(source: &Source) -> (Ast, Vec<Error>) {
    one(source, Rule::formula)
}

/// Parses a task file as far as possible, with its mistakes.
///
/// What can be read is kept, so that a formatter or an editor has something to show:
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let text = "task broken = F (\ntask whole = F a\n";
/// let (ast, mistakes) = parse::recover_file(&Source::new("two.tltl", text));
/// assert_eq!((ast.items().len(), mistakes[0].kind().name()), (2, "syntax"));
/// assert!(matches!(ast.items()[0].kind, ItemKind::Broken(_)), "its name is known all the same");
/// ```
#[must_use]
pub fn recover_file(source: &Source) -> (Ast, Vec<Error>) {
    items(source)
}

/// Parses the input of the macro as far as possible, with its mistakes.
#[must_use]
pub fn recover_fragment(source: &Source) -> (Ast, Vec<Error>) {
    if token::starts_with_item(source.text()) { items(source) } else { one(source, Rule::fragment) }
}

/// The tree, if there are no mistakes.
fn finish((ast, mistakes): (Ast, Vec<Error>)) -> Result<Ast, Errors> {
    Errors::check(mistakes).map(|()| ast)
}

/// Parses a source that is one formula.
fn one(source: &Source, rule: Rule) -> (Ast, Vec<Error>) {
    let mut ast = Ast::new(source.clone());
    if let Err(error) = shallow(source) {
        return (ast, vec![error]);
    }
    let tree = match grammar::parse(rule, source.text()) {
        Ok(tree) => tree,
        Err(stopped) => return (ast, vec![message::sentence(source, 0, &stopped)]),
    };
    let mut mistakes = Vec::new();
    let mut attributes = Vec::new();
    for pair in tree.pairs() {
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

/// Parses a source of items, one after the other. After a mistake, tries again with the text before
/// it: an item with rubbish behind it is still an item.
fn items(source: &Source) -> (Ast, Vec<Error>) {
    let mut ast = Ast::new(source.clone());
    if let Err(error) = shallow(source) {
        return (ast, vec![error]);
    }
    let mut mistakes = Vec::new();
    let mut at = prologue(&mut ast, source);
    while at < source.text().len() {
        at = match grammar::parse(Rule::next, &source.text()[at..]) {
            Ok(tree) => {
                let mut end = source.text().len();
                for pair in tree.pairs().filter(|pair| pair.as_rule() == Rule::item) {
                    end = at + pair.end();
                    item::build(&mut ast, pair, at, &mut mistakes);
                }
                end
            }
            Err(stopped) => {
                let mistake = message::sentence(source, at, &stopped);
                let next = token::next_item(source.text(), at, mistake.span().start);
                let mistake = lone_formula(source, Span::new(at, next)).unwrap_or(mistake);
                let readable = &source.text()[at..mistake.span().start];
                match grammar::parse(Rule::next, readable) {
                    Ok(tree) => tree
                        .pairs()
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

/// The error for a formula where an item should stand, as in a file that is only a formula.
fn lone_formula(source: &Source, span: Span) -> Option<Error> {
    let text = source.slice(span);
    grammar::parse(Rule::formula, text).ok()?;
    let formula = quoted(text.trim());
    let start = span.start + text.len() - text.trim_start().len();
    let span = Span::new(start, start + text.trim().len());
    Some(
        Error::new(Kind::Syntax, "this is a formula, and a task file is made of items", span)
            .help(format!("give it a name: `task go = {formula}`"))
            .help(format!("the command line takes formulas too: `--formula '{formula}'`")),
    )
}

/// Reads the docs of the file and returns the byte at which they end.
fn prologue(ast: &mut Ast, source: &Source) -> usize {
    let Ok(tree) = grammar::parse(Rule::prologue, source.text()) else { return 0 };
    let mut end = 0;
    let mut docs = Vec::new();
    for pair in tree.pairs().filter(|pair| pair.as_rule() == Rule::file_doc) {
        end = pair.end();
        docs.push(item::doc_text(pair.as_str()));
    }
    ast.set_docs(docs);
    end
}

/// Refuses braces that nest so deep that the grammar would run out of stack, and what is not text.
fn shallow(source: &Source) -> Result<(), Error> {
    let mut depth = 0_usize;
    for (at, byte) in source.text().bytes().enumerate() {
        match byte {
            0 => {
                let message = "this is not text in UTF-8, for it has a zero byte";
                return Err(Error::new(Kind::Syntax, message, Span::new(at, at + 1))
                    .help("if it is UTF-16, save it as UTF-8"));
            }
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
