//! Attributes of tasks: `#[factored]` and `#[budget(…)]`.

use crate::ast::{Ast, Attribute, ItemKind};
use crate::error::{Error, Kind};
use crate::predicate::Options;
use crate::source::Span;

/// The settings of a task's attributes; a later one overrides an earlier one.
pub(super) fn options(ast: &Ast, attributes: &[Attribute], mistakes: &mut Vec<Error>) -> Options {
    let mut options = Options::default();
    for attribute in attributes {
        match ast.source().slice(attribute.name) {
            "factored" if attribute.settings.is_empty() => options.factored = true,
            "budget" if !attribute.settings.is_empty() => {
                let setting = |setting: &(Span, Span)| budget(ast, *setting, &mut options).err();
                mistakes.extend(attribute.settings.iter().filter_map(setting));
            }
            _ => mistakes.push(unknown(ast, attribute.name)),
        }
    }
    options
}

/// Reads one setting of a budget.
fn budget(ast: &Ast, (name, value): (Span, Span), options: &mut Options) -> Result<(), Error> {
    let setting = match ast.source().slice(name) {
        "states" => &mut options.states,
        "nodes" => &mut options.nodes,
        "edges" => &mut options.edges,
        "products" => &mut options.products,
        _ => return Err(unknown(ast, name)),
    };
    let number = ast.source().slice(value).replace('_', "").parse::<usize>();
    let message = "this number is too large for a budget";
    *setting = Some(number.map_err(|_| Error::new(Kind::Number, message, value))?);
    Ok(())
}

/// The error for an attribute or a setting that does not exist.
fn unknown(ast: &Ast, span: Span) -> Error {
    let message = format!("`{}` is not an attribute of a task", ast.source().slice(span));
    Error::new(Kind::UnknownName, message, span).help(
        "write `#[factored]`, or `#[budget(states = 100000)]` with `states`, `nodes`, `edges` or `products`",
    )
}

/// The errors for attributes of items that are not tasks.
pub(super) fn misplaced(ast: &Ast) -> impl Iterator<Item = Error> {
    let items = ast.items().iter().filter(|item| !matches!(item.kind, ItemKind::Task(..)));
    items
        .filter_map(|item| item.attributes.first())
        .map(|attribute| Error::new(Kind::Syntax, "only a task has attributes", attribute.name))
}
