//! The order in which items are checked: each after the ones that it uses.

use super::scope::Scope;
use crate::ast::{Ast, ItemKind, Node, NodeId};
use crate::error::{Error, Kind};
use crate::source::Span;

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Done,
}

/// All items; the ones on a circle of uses are reported and left out.
pub(super) fn order(ast: &Ast, scope: &Scope<'_>, mistakes: &mut Vec<Error>) -> Vec<usize> {
    let uses: Vec<_> = (0..ast.items().len()).map(|item| uses(ast, scope, item)).collect();
    let mut marks = vec![Mark::New; uses.len()];
    let mut order = Vec::new();
    for start in 0..uses.len() {
        if marks[start] != Mark::New {
            continue;
        }
        marks[start] = Mark::Open;
        let mut path = vec![(start, 0)];
        while let Some((item, next)) = path.last_mut() {
            let Some(&(used, span)) = uses[*item].get(*next) else {
                marks[*item] = Mark::Done;
                order.push(*item);
                path.pop();
                continue;
            };
            *next += 1;
            match marks[used] {
                Mark::New => {
                    marks[used] = Mark::Open;
                    path.push((used, 0));
                }
                Mark::Open => mistakes.push(circle(ast, used, span)),
                Mark::Done => {}
            }
        }
    }
    order
}

/// The items that `item` uses, with the place of the use.
fn uses(ast: &Ast, scope: &Scope<'_>, item: usize) -> Vec<(usize, Span)> {
    let (ItemKind::Constant(_, root) | ItemKind::Predicate(_, root) | ItemKind::Task(_, root)) =
        ast.items()[item].kind
    else {
        return Vec::new();
    };
    let nodes = (ast.first(root).0..=root.0).map(NodeId);
    nodes
        .filter(|id| matches!(ast.node(*id), Node::Name))
        .filter_map(|id| Some((scope.item(ast.text(id))?, ast.span(id))))
        .collect()
}

fn circle(ast: &Ast, item: usize, span: Span) -> Error {
    let entry = &ast.items()[item];
    let name = ast.source().slice(entry.name);
    Error::new(Kind::Cycle, format!("`{name}` is defined by itself"), span)
        .label("used here")
        .related(entry.name, "declared here")
        .help("an item can use others only if they do not use it in turn")
}
