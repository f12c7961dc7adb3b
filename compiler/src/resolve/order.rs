//! The order of the items: each after the ones that it uses.

use crate::ast::Ast;
use crate::error::{Error, Kind};
use crate::source::Span;

/// The use of an item: which, and where.
pub(super) type Use = (usize, Span);

#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Done,
}

/// All items, given the uses in each, and the uses that close a circle.
pub(super) fn order(uses: &[Vec<Use>]) -> (Vec<usize>, Vec<Use>) {
    let mut marks = vec![Mark::New; uses.len()];
    let (mut order, mut circles) = (Vec::new(), Vec::new());
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
                Mark::Open => circles.push((used, span)),
                Mark::Done => {}
            }
        }
    }
    (order, circles)
}

/// The error for the use at `span`, which closes a circle.
pub(super) fn circle(ast: &Ast, item: usize, span: Span) -> Error {
    let entry = &ast.items()[item];
    let name = ast.source().slice(entry.name);
    Error::new(Kind::Cycle, format!("`{name}` is defined by itself"), span)
        .label("used here")
        .related(entry.name, "declared here")
        .help("an item can use others only if they do not use it in turn")
}
