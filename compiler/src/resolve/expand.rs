//! Expressions: `for all` and `for some` written out as finite conjunctions and disjunctions, and
//! each name answered.
//!
//! Writing out is exact because every set is finite and known: an enumeration, a list, a range of
//! integers. Copies keep their places in the source, so a mistake in one is reported where its
//! author made it. A bound name becomes the value or the listed element that it stands for. Rust
//! expressions stay as they are; the environment of an expression says what the bound names in it
//! stand for.
//!
//! The size is the product of the sets of nested quantifiers, so it is bounded by [`MOST_NODES`]
//! and the nesting by [`DEEPEST`].
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "enum Room { hall, attic }
//! state Robot { at: Room }
//! task tour = for all r in Room: F at == r";
//! let module = check::file(&Source::new("tour.tltl", text))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "F (at == hall) && F (at == attic)");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use super::order::{self, Use};
use super::place::Part;
use super::{Entry, Expression, ExpressionId, Name, Names, Resolved, Value};
use crate::ast::{
    Ast, Comparison, Infix, Item, ItemKind, Node, NodeId, Prefix, Quantifier, quoted,
};
use crate::error::{Error, Kind};
use crate::reserved::rust_name;
use crate::source::Span;

/// The most operators and operands that all quantifiers of a source may have, written out; the same
/// bound holds for all conditions with arguments. With a hundred rooms times a hundred objects, a
/// body of twenty operators and operands stays within it.
pub(crate) const MOST_NODES: usize = 200_000;

/// The deepest nesting of `for`. The expansion recurses once a quantifier in a quantifier, and
/// nowhere else.
const DEEPEST: usize = 32;

/// The meaning of a name that a quantifier may bind.
#[derive(Clone, Copy)]
pub(crate) enum Bound {
    /// A value of an enumeration.
    Value(Value),
    /// An element of a listed set, which is a name or a number of the source. A free name stands
    /// for itself.
    Node(NodeId),
    /// A number of a range.
    Number(f64),
}

/// A name bound by a quantifier, inside other bound names.
pub(super) struct Binder {
    /// The place of the name; an empty span if the name is refused and binds nothing.
    name: Span,
    /// The value that it stands for in this copy.
    bound: Bound,
    /// The names bound around it.
    outer: Environment,
    /// The number of names bound around it.
    depth: usize,
}

/// The innermost bound name around an expression; `None` outside of quantifiers. Environments share
/// their outer parts, so there is one binder for each copy of a body, however large that is.
pub(crate) type Environment = Option<u32>;

impl Resolved<'_> {
    /// The bound names of an environment, innermost first.
    pub(crate) fn binders(&self, environment: Environment) -> impl Iterator<Item = (&str, Bound)> {
        let at = |at: Environment| at.map(|at| &self.binders[at as usize]);
        std::iter::successors(at(environment), move |binder| at(binder.outer))
            .map(|binder| (self.ast.source().slice(binder.name), binder.bound))
    }

    /// The meaning of `node` if it is a bound name, else `node` itself.
    fn bound(&self, node: NodeId, environment: Environment) -> Bound {
        let text = self.ast.text(node);
        let is_name = matches!(self.ast.node(node), Node::Name);
        let binder = self.binders(environment).find(|(name, _)| is_name && *name == text);
        binder.map_or(Bound::Node(node), |(_, bound)| bound)
    }
}

/// Writes the expressions of all items into `resolved`, and returns the items that each of them
/// uses.
pub(super) fn expand(resolved: &mut Resolved<'_>, mistakes: &mut Vec<Error>) -> Vec<Vec<Use>> {
    let ast = resolved.ast;
    let (constants, others) = constants_first(resolved);
    let uses = vec![Vec::new(); ast.items().len()];
    let mut expansion = Expansion { resolved, mistakes, item: 0, uses, copied: 0, full: false };
    for item in constants.into_iter().chain(others) {
        if let Some(root) = root(&ast.items()[item]) {
            expansion.item = item;
            let first = ExpressionId(expansion.resolved.entries.len() as u32);
            let root = expansion.copy(root, None);
            expansion.resolved.expressions[item] = Some((first, root));
        }
    }
    expansion.uses
}

/// The root of the expression of an item.
fn root(item: &Item) -> Option<NodeId> {
    match item.kind {
        ItemKind::Constant(_, root) | ItemKind::Predicate(_, root) | ItemKind::Task(_, root) => {
            Some(root)
        }
        _ => None,
    }
}

/// The constants, each after those that it uses, and the other items. Constants come first because
/// arrays are indexed by their values.
fn constants_first(resolved: &Resolved<'_>) -> (Vec<usize>, Vec<usize>) {
    let ast = resolved.ast;
    let constants = |item: &Item| match item.kind {
        ItemKind::Constant(_, root) => {
            let nodes = (ast.first(root).0..=root.0).map(NodeId);
            let uses = nodes.filter_map(|node| used(resolved, node));
            uses.filter(|(item, _)| resolved.is_constant(*item)).collect()
        }
        _ => Vec::new(),
    };
    let uses: Vec<Vec<Use>> = ast.items().iter().map(constants).collect();
    order::order(&uses).0.into_iter().partition(|item| resolved.is_constant(*item))
}

/// The item that a node names.
fn used(resolved: &Resolved<'_>, node: NodeId) -> Option<Use> {
    // Only the text of a name is short: that of an operator is all of its operands.
    if !matches!(resolved.ast.node(node), Node::Name) {
        return None;
    }
    Some((resolved.scope.item(resolved.ast.text(node))?, resolved.ast.span(node)))
}

/// The quantifiers of an expression that stand inside no other, last one first, each with its first
/// node and itself.
fn outermost(ast: &Ast, first: NodeId, root: NodeId) -> Vec<(NodeId, NodeId, &Quantifier)> {
    let mut quantifiers = Vec::new();
    let mut next = Some(root.0);
    while let Some(id) = next.filter(|id| *id >= first.0).map(NodeId) {
        let mut start = id;
        if let Node::Quantified(quantifier) = ast.node(id) {
            start = ast.first(id);
            quantifiers.push((start, id, quantifier));
        }
        next = start.0.checked_sub(1);
    }
    quantifiers
}

/// The state of an expansion.
struct Expansion<'r, 'a> {
    resolved: &'r mut Resolved<'a>,
    mistakes: &'r mut Vec<Error>,
    /// The item whose expression is being copied.
    item: usize,
    /// The items that each item uses, from left to right.
    uses: Vec<Vec<Use>>,
    /// The number of nodes that were copied within quantifiers.
    copied: usize,
    /// Whether a bound was passed; reported once.
    full: bool,
}

impl Expansion<'_, '_> {
    /// Copies the expression `root` with its quantifiers written out. Recurses for quantifiers
    /// inside quantifiers only, of which [`DEEPEST`] may nest.
    fn copy(&mut self, root: NodeId, environment: Environment) -> ExpressionId {
        let first = self.resolved.ast.first(root);
        let mut quantifiers = outermost(self.resolved.ast, first, root);
        let mut copies: Vec<ExpressionId> = Vec::with_capacity((root.0 - first.0 + 1) as usize);
        let mut at = first;
        while at <= root {
            if let Some((_, id, quantifier)) = quantifiers.pop_if(|(start, ..)| *start == at) {
                let copy = self.quantifier(id, quantifier, environment);
                copies.resize((id.0 - first.0 + 1) as usize, copy);
                at = id;
            } else {
                let copy = self.one(at, environment, &|id| copies[(id.0 - first.0) as usize]);
                copies.push(copy);
            }
            at = NodeId(at.0 + 1);
        }
        copies[copies.len() - 1]
    }

    /// Copies a node, given the copies of its operands. A bound name becomes what it stands for.
    fn one(
        &mut self,
        node: NodeId,
        environment: Environment,
        of: &dyn Fn(NodeId) -> ExpressionId,
    ) -> ExpressionId {
        let ast = self.resolved.ast;
        let mut place = node;
        let expression = match self.resolved.bound(node, environment) {
            Bound::Value(value) => Expression::Name(Name::Value(value)),
            Bound::Number(value) => Expression::Number(value),
            Bound::Node(node) => {
                place = node;
                self.uses[self.item].extend(used(self.resolved, node));
                self.expression(node, of)
            }
        };
        self.copied += usize::from(environment.is_some());
        let entry = ast.entry(node);
        let outer = if entry.is_bracketed() { entry.outer } else { ast.span(place) };
        let first = ast.leftmost(place).map(|operand| self.resolved[of(operand)].first);
        let mut copy = self.push(expression, place, outer, first, environment);
        if self.is_unequal_truths(copy) {
            let first = Some(self.resolved[copy].first);
            let not = Expression::Prefix(Prefix::Not, copy);
            copy = self.push(not, place, outer, first, environment);
        }
        if let Some(bound) = &ast.entry(node).bound {
            let ends = bound.ends.iter().map(|end| of(end.node)).collect();
            self.resolved.entries[copy.0 as usize].ends = ends;
        }
        copy
    }

    /// Whether an expression is `p != q` of truth values, of which it has become `p <=> q`.
    fn is_unequal_truths(&self, copy: ExpressionId) -> bool {
        let entry = &self.resolved[copy];
        let written = self.resolved.ast.node(entry.node);
        matches!(entry.expression, Expression::Infix(Infix::Iff, ..))
            && matches!(written, Node::Infix(Infix::Compare(Comparison::Unequal), ..))
    }

    /// Adds an expression.
    fn push(
        &mut self,
        expression: Expression,
        node: NodeId,
        outer: Span,
        first: Option<ExpressionId>,
        environment: Environment,
    ) -> ExpressionId {
        let id = u32::try_from(self.resolved.entries.len()).expect("fewer than 2^32 expressions");
        let value = self.resolved.calculated(&expression);
        let truth = self.resolved.known(&expression);
        let first = first.unwrap_or(ExpressionId(id));
        let ends = Vec::new();
        let entry = Entry { expression, node, outer, first, ends, value, truth, environment };
        self.resolved.entries.push(entry);
        ExpressionId(id)
    }

    /// The expression of a node, given the copies of its operands.
    fn expression(&self, node: NodeId, of: &dyn Fn(NodeId) -> ExpressionId) -> Expression {
        let resolved = &*self.resolved;
        match *resolved.ast.node(node) {
            Node::Truth(value) => Expression::Truth(value),
            Node::Number(value) => Expression::Number(value),
            // Names of other tools stand in quotes; a file declares its names, and has none.
            Node::Text if resolved.names == Names::Free => Expression::Name(Name::Free),
            Node::Text => Expression::Text,
            Node::Prefix(op, a) => Expression::Prefix(op, of(a)),
            Node::Infix(Infix::Compare(Comparison::Equal | Comparison::Unequal), a, b)
                if [a, b].into_iter().all(|side| resolved.is_truth(of(side))) =>
            {
                Expression::Infix(Infix::Iff, of(a), of(b))
            }
            Node::Infix(op, a, b) => Expression::Infix(op, of(a), of(b)),
            Node::Call { callee, ref arguments } => match resolved.callee(of(callee)) {
                Ok(callee) => {
                    let arguments = resolved.ast.arguments(arguments).iter();
                    Expression::Call(callee, arguments.map(|argument| of(*argument)).collect())
                }
                Err(name) => Expression::Name(name),
            },
            Node::Field { base, field } => {
                Expression::Name(resolved.part(of(base), Part::Field(field), self.item))
            }
            Node::Index { base, index } => {
                let part = Part::Index(node, of(index));
                Expression::Name(resolved.part(of(base), part, self.item))
            }
            _ => Expression::Name(resolved.name(node, self.item)),
        }
    }

    /// All copies of the body of a quantifier, joined by `&&` or `||`; of an empty set, true for
    /// `for all` and false for `for some`.
    fn quantifier(
        &mut self,
        id: NodeId,
        quantifier: &Quantifier,
        environment: Environment,
    ) -> ExpressionId {
        let Quantifier { all, name, set, ref elements, range, body } = *quantifier;
        let ast = self.resolved.ast;
        let (span, operator) = (ast.span(id), ast.entry(id).operator);
        let refused = self.refused(name, environment);
        // A refused name keeps its other meaning and binds nothing, but the quantifier still counts
        // as nesting.
        let name = if refused.is_some() { Span::default() } else { name };
        self.mistakes.extend(refused);
        let values = match (range, ast.arguments(elements)) {
            (Some(inclusive), &[first, end]) => {
                self.numbers(set, [first, end], inclusive, environment)
            }
            (_, listed) => self.values(set, listed, environment),
        };
        let op = if all { Infix::And } else { Infix::Or };
        let mut joined = None;
        for bound in values {
            if self.no_room(operator, environment) {
                break;
            }
            let inner = self.bind(name, bound, environment);
            let copy = self.copy(body, inner);
            joined = Some(match joined {
                None => copy,
                Some(before) => {
                    let first = Some(self.resolved[before].first);
                    self.push(Expression::Infix(op, before, copy), id, span, first, None)
                }
            });
        }
        joined.unwrap_or_else(|| self.push(Expression::Truth(all), id, span, None, None))
    }

    /// The environment within another in which a name is bound.
    fn bind(&mut self, name: Span, bound: Bound, outer: Environment) -> Environment {
        let depth = self.depth(outer) + 1;
        self.resolved.binders.push(Binder { name, bound, outer, depth });
        u32::try_from(self.resolved.binders.len() - 1).ok()
    }

    /// The number of names bound in an environment.
    fn depth(&self, environment: Environment) -> usize {
        environment.map_or(0, |at| self.resolved.binders[at as usize].depth)
    }

    /// The error for a name that cannot be bound: it is bound already, or means something else.
    fn refused(&self, name: Span, environment: Environment) -> Option<Error> {
        let text = self.resolved.ast.source().slice(name);
        let same = |known: &str| rust_name(known) == rust_name(text);
        if self.resolved.binders(environment).any(|(known, _)| same(known)) {
            let message = format!("`{text}` is bound twice");
            return Some(
                Error::new(Kind::DuplicateName, message, name)
                    .help("give the inner one another name"),
            );
        }
        let scope = &self.resolved.scope;
        scope.shadowed(name).or_else(|| scope.unmentionable(name))
    }

    /// Whether a bound is passed, which is reported once.
    fn no_room(&mut self, span: Span, environment: Environment) -> bool {
        let deep = self.depth(environment) >= DEEPEST;
        let many = self.copied > MOST_NODES;
        if (deep || many) && !std::mem::replace(&mut self.full, true) {
            let (kind, message) = match deep {
                true => (Kind::Nesting, format!("`for` nests more than {DEEPEST} deep")),
                false => (
                    Kind::Budget,
                    format!("written out, this has more than {MOST_NODES} operators and operands"),
                ),
            };
            self.mistakes.push(
                Error::new(kind, message, span).help("range over fewer values, or nest less"),
            );
        }
        self.full
    }

    /// The values of a set.
    fn values(&mut self, set: Span, listed: &[NodeId], environment: Environment) -> Vec<Bound> {
        let resolved = &*self.resolved;
        let text = resolved.ast.source().slice(set);
        if !listed.is_empty() {
            return listed.iter().map(|id| resolved.bound(*id, environment)).collect();
        }
        if let Some(of) = resolved.scope.enumeration(text) {
            let count = resolved.scope.enums[of as usize].variants.len();
            return (0..).take(count).map(|number| Bound::Value(Value { of, number })).collect();
        }
        self.mistakes.extend(not_a_set(resolved, text, set));
        Vec::new()
    }

    /// The numbers of a range; not many more than can be written out, so that `0..1e15` ends.
    fn numbers(
        &mut self,
        set: Span,
        ends: [NodeId; 2],
        inclusive: bool,
        environment: Environment,
    ) -> Vec<Bound> {
        let ends = ends.map(|end| self.end(end, environment));
        let [Some(first), Some(end)] = ends else { return Vec::new() };
        let end = if inclusive { end + 1.0 } else { end };
        if first >= end {
            let message = format!("no number is in `{}`", self.resolved.ast.source().slice(set));
            self.mistakes.push(
                Error::new(Kind::Type, message, set)
                    .help("`0..6` is from 0 to 5, and `0..=6` from 0 to 6"),
            );
        }
        let numbers = std::iter::successors(Some(first), |at| Some(at + 1.0));
        let numbers = numbers.take_while(|at| *at < end).take(MOST_NODES + 1);
        numbers.map(Bound::Number).collect()
    }

    /// The integer at an end of a range: written there, or the value of a constant.
    fn end(&mut self, id: NodeId, environment: Environment) -> Option<f64> {
        let (ast, scope) = (self.resolved.ast, &self.resolved.scope);
        let constant = || match ast.items()[scope.item(ast.text(id))?].kind {
            ItemKind::Constant(_, root) => Some(root),
            _ => None,
        };
        let written = match self.resolved.bound(id, environment) {
            Bound::Number(value) => return Some(value),
            Bound::Node(node) if node != id => node,
            _ => constant().unwrap_or(id),
        };
        if let Node::Number(value) = *ast.node(written)
            && value.fract() == 0.0
        {
            return Some(value);
        }
        let message = format!("`{}` cannot be the end of a range", quoted(ast.text(id)));
        self.mistakes.push(Error::new(Kind::Type, message, ast.span(id)).help(
            "a range goes from one whole number to another, or to a constant that is written as one",
        ));
        None
    }
}

/// The error for a quantifier over something that is not a set; `None` if that follows from another
/// mistake.
fn not_a_set(resolved: &Resolved<'_>, text: &str, set: Span) -> Option<Error> {
    if text.starts_with('{') {
        return Some(
            Error::new(Kind::Type, "this set lists nothing", set)
                .help("list what the name stands for: `{apple, mug}`"),
        );
    }
    let mut names = resolved.scope.enums.iter().map(|known| known.name.as_str());
    let message = format!("`{text}` is not an enumeration that is declared here");
    let error = Error::new(Kind::UnknownName, message, set);
    if resolved.scope.is_broken(text) {
        return None;
    }
    Some(error.help(resolved.scope.suggestion(text, &mut names).unwrap_or_else(|| {
        format!(
            "declare it, `enum {text} {{ … }}`, or list the elements: `for all x in {{a, b}}: …`"
        )
    })))
}
