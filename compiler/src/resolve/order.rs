//! The order of the items: each after those that it uses.
//!
//! A depth-first search with a path of its own instead of recursion, so a chain of a hundred
//! thousand tasks needs no stack. A use that leads back into the path closes a circle; it is
//! reported and left out, and the search goes on.

use crate::ast::Ast;
use crate::error::{Error, Kind};
use crate::source::Span;

/// A use of an item: its position among the items, and the place of the use.
pub(super) type Use = (usize, Span);

/// How far the search has come with an item.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Mark {
    New,
    Open,
    Done,
}

/// Orders all items, given the uses of each. Returns the order and the uses that close a circle. An
/// item stands where the source has it, unless an earlier one uses it.
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
