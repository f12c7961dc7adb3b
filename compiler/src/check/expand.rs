//! `for all` and `for some` written out as finite conjunctions and disjunctions.
//!
//! Copies keep their places in the source, so a mistake in one is told where its author made it. A
//! bound name becomes the value or the listed element that it stands for; Rust expressions are
//! left as they are, with what the names in them stand for beside them.

use std::rc::Rc;

use rustc_hash::FxHashMap;

use super::scope::Scope;
use crate::ast::{Ast, Infix, Item, ItemKind, Node, NodeId};
use crate::error::{Error, Kind};
use crate::source::Span;

/// The most operators and operands that all quantifiers of a source may have, written out; and all
/// conditions with arguments.
pub(super) const MOST_NODES: usize = 200_000;

/// The deepest nesting of `for`.
const DEEPEST: usize = 32;

/// What a bound name stands for.
#[derive(Clone, Copy)]
pub(super) enum Bound {
    /// A value of an enumeration.
    Variant(u32, u32),
    /// An element of a listed set, a name or a number of the source.
    Element(NodeId),
    /// A number of a range.
    Number(f64),
}

/// The bound names around an expression, innermost last.
pub(super) type Environment = Rc<Vec<(String, Bound)>>;

/// A source without quantifiers.
pub(super) struct Expanded {
    /// The source; nothing if it had none to begin with.
    pub(super) ast: Option<Ast>,
    /// What is bound around the expressions that stand within a quantifier.
    pub(super) bound: FxHashMap<NodeId, Environment>,
}

/// Writes all quantifiers out.
pub(super) fn expand(ast: &Ast, scope: &Scope<'_>, mistakes: &mut Vec<Error>) -> Expanded {
    let roots = ast.items().iter().filter_map(root);
    let quantified = |root| nodes(ast, root).any(|id| is_quantified(ast, id));
    if !roots.into_iter().any(quantified) {
        return Expanded { ast: None, bound: FxHashMap::default() };
    }
    let mut to = Ast::new(ast.source().clone());
    to.set_docs(ast.docs().to_vec());
    let mut expansion =
        Expansion { from: ast, scope, to, bound: FxHashMap::default(), mistakes, full: false };
    for item in ast.items() {
        let kind = match &item.kind {
            ItemKind::Constant(unit, root) => {
                ItemKind::Constant(unit.clone(), expansion.item(*root))
            }
            ItemKind::Predicate(takes, root) => {
                ItemKind::Predicate(takes.clone(), expansion.item(*root))
            }
            ItemKind::Task(takes, root) => ItemKind::Task(takes.clone(), expansion.item(*root)),
            other => other.clone(),
        };
        expansion.to.push_item(Item { docs: item.docs.clone(), kind, ..item.clone() });
    }
    Expanded { ast: Some(expansion.to), bound: expansion.bound }
}

fn root(item: &Item) -> Option<NodeId> {
    match item.kind {
        ItemKind::Constant(_, root) | ItemKind::Predicate(_, root) | ItemKind::Task(_, root) => {
            Some(root)
        }
        _ => None,
    }
}

fn nodes(ast: &Ast, root: NodeId) -> impl Iterator<Item = NodeId> {
    (ast.first(root).0..=root.0).map(NodeId)
}

fn is_quantified(ast: &Ast, id: NodeId) -> bool {
    matches!(ast.node(id), Node::Quantified { .. })
}

struct Expansion<'a, 'm> {
    from: &'a Ast,
    scope: &'a Scope<'a>,
    to: Ast,
    bound: FxHashMap<NodeId, Environment>,
    mistakes: &'m mut Vec<Error>,
    /// Whether there is no room for more.
    full: bool,
}

impl Expansion<'_, '_> {
    fn item(&mut self, root: NodeId) -> NodeId {
        self.copy(root, &Environment::default())
    }

    /// Copies the expression `root`, its quantifiers written out.
    fn copy(&mut self, root: NodeId, environment: &Environment) -> NodeId {
        let first = self.from.first(root);
        let mut quantifiers = self.outermost(first, root);
        let mut copies: Vec<NodeId> = Vec::with_capacity((root.0 - first.0 + 1) as usize);
        let mut at = first;
        while at <= root {
            if let Some((_, quantifier)) = quantifiers.pop_if(|(start, _)| *start == at) {
                let copy = self.quantifier(quantifier, environment);
                copies.resize((quantifier.0 - first.0 + 1) as usize, copy);
                at = NodeId(quantifier.0 + 1);
                continue;
            }
            let node = self.from.node(at).clone();
            let node = self.renewed(node, |id| copies[(id.0 - first.0) as usize]);
            copies.push(self.one(at, node, environment));
            at = NodeId(at.0 + 1);
        }
        copies[copies.len() - 1]
    }

    /// The quantifiers of an expression that stand within no other, and the first node of each; the
    /// last one first.
    fn outermost(&self, first: NodeId, root: NodeId) -> Vec<(NodeId, NodeId)> {
        let mut quantifiers = Vec::new();
        let mut next = Some(root.0);
        while let Some(id) = next.filter(|id| *id >= first.0).map(NodeId) {
            let mut start = id;
            if is_quantified(self.from, id) {
                start = self.from.first(id);
                quantifiers.push((start, id));
            }
            next = start.0.checked_sub(1);
        }
        quantifiers
    }

    /// A node with the copies of its operands.
    fn renewed(&mut self, node: Node, of: impl Fn(NodeId) -> NodeId) -> Node {
        match node {
            Node::Field { base, field } => Node::Field { base: of(base), field },
            Node::Index { base, index } => Node::Index { base: of(base), index: of(index) },
            Node::Call { callee, arguments } => {
                let arguments: Vec<_> =
                    self.from.arguments(&arguments).iter().map(|id| of(*id)).collect();
                let arguments = self.to.push_arguments(&arguments);
                Node::Call { callee: of(callee), arguments }
            }
            Node::Prefix(op, a) => Node::Prefix(op, of(a)),
            Node::Infix(op, a, b) => Node::Infix(op, of(a), of(b)),
            leaf => leaf,
        }
    }

    /// Adds the copy `node` of the node `id`, or what the name `id` stands for.
    fn one(&mut self, id: NodeId, node: Node, environment: &Environment) -> NodeId {
        let entry = self.from.entry(id);
        let bound = matches!(node, Node::Name).then(|| self.lookup(id, environment)).flatten();
        let copy = match bound {
            Some(Bound::Variant(of, number)) => {
                self.to.push(Node::Variant { of, number }, entry.span, entry.operator)
            }
            Some(Bound::Element(element)) => {
                let element = self.from.entry(element);
                self.to.push(element.node.clone(), element.span, element.operator)
            }
            Some(Bound::Number(value)) => {
                self.to.push(Node::Number(value), entry.span, entry.operator)
            }
            None => self.to.push(node, entry.span, entry.operator),
        };
        if entry.is_bracketed() {
            self.to.bracket(copy, entry.outer);
        }
        if !environment.is_empty() {
            self.bound.insert(copy, environment.clone());
        }
        copy
    }

    fn lookup(&self, id: NodeId, environment: &Environment) -> Option<Bound> {
        let text = self.from.text(id);
        environment.iter().rev().find(|(name, _)| name == text).map(|(_, bound)| *bound)
    }

    /// All copies of the body, joined.
    fn quantifier(&mut self, id: NodeId, environment: &Environment) -> NodeId {
        let entry = self.from.entry(id);
        let Node::Quantified { all, name, set, ref elements, range, body } = entry.node else {
            return id;
        };
        let (span, operator) = (entry.span, entry.operator);
        let refused = self.refused(name, environment);
        let taken = refused.is_some();
        self.mistakes.extend(refused);
        let listed = self.from.arguments(elements).to_vec();
        let values = match (range, &listed[..]) {
            (Some(inclusive), &[first, end]) => {
                self.numbers(set, [first, end], inclusive, environment)
            }
            _ => self.values(set, &listed, environment),
        };
        let op = if all { Infix::And } else { Infix::Or };
        let mut joined = None;
        for value in values {
            if self.no_room(operator, environment) {
                break;
            }
            let mut inner = Vec::clone(environment);
            // What is called like something else is that, and binds nothing; it still counts as deep.
            let text = if taken { "" } else { self.from.source().slice(name) };
            inner.push((text.to_owned(), value));
            let copy = self.copy(body, &Rc::new(inner));
            joined = Some(match joined {
                None => copy,
                Some(before) => self.to.push(Node::Infix(op, before, copy), span, operator),
            });
        }
        joined.unwrap_or_else(|| self.to.push(Node::Truth(all), span, operator))
    }

    /// The error for a name that cannot be bound.
    fn refused(&self, name: Span, environment: &Environment) -> Option<Error> {
        let text = self.from.source().slice(name);
        if environment.iter().any(|(known, _)| known == text) {
            let message = format!("`{text}` is bound twice");
            return Some(
                Error::new(Kind::DuplicateName, message, name)
                    .help("give the inner one another name"),
            );
        }
        self.scope.shadowed(self.from, name)
    }

    fn no_room(&mut self, span: Span, environment: &Environment) -> bool {
        let deep = environment.len() >= DEEPEST;
        let many = self.bound.len() > MOST_NODES;
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

    /// What a bound name ranges over.
    fn values(&mut self, set: Span, listed: &[NodeId], environment: &Environment) -> Vec<Bound> {
        let text = self.from.source().slice(set);
        if !listed.is_empty() {
            let value = |id: &NodeId| self.lookup(*id, environment).unwrap_or(Bound::Element(*id));
            return listed.iter().map(value).collect();
        }
        if let Some(of) = self.scope.enumeration(text) {
            let count = self.scope.enums[of as usize].variants.len();
            return (0..).take(count).map(|number| Bound::Variant(of, number)).collect();
        }
        if let Some(error) = self.not_a_set(text, set) {
            self.mistakes.push(error);
        }
        Vec::new()
    }

    /// The numbers of a range; not many more than can be written out.
    fn numbers(
        &mut self,
        set: Span,
        ends: [NodeId; 2],
        inclusive: bool,
        environment: &Environment,
    ) -> Vec<Bound> {
        let ends = ends.map(|end| self.end(end, environment));
        let [Some(first), Some(end)] = ends else { return Vec::new() };
        let end = if inclusive { end + 1.0 } else { end };
        if first >= end {
            let message = format!("no number is in `{}`", self.from.source().slice(set));
            self.mistakes.push(
                Error::new(Kind::Type, message, set)
                    .help("`0..6` is from 0 to 5, and `0..=6` from 0 to 6"),
            );
        }
        let numbers = std::iter::successors(Some(first), |at| Some(at + 1.0));
        let numbers = numbers.take_while(|at| *at < end).take(MOST_NODES + 1);
        numbers.map(Bound::Number).collect()
    }

    /// The whole number that an end of a range is: written there, or what its name stands for.
    fn end(&mut self, id: NodeId, environment: &Environment) -> Option<f64> {
        let (text, span) = (self.from.text(id), self.from.span(id));
        let mut node = self.from.node(id);
        match self.lookup(id, environment) {
            Some(Bound::Number(value)) => return Some(value),
            Some(Bound::Element(element)) => node = self.from.node(element),
            Some(Bound::Variant(..)) => {}
            None => {
                if let Some(item) = self.scope.item(text)
                    && let ItemKind::Constant(_, root) = self.from.items()[item].kind
                {
                    node = self.from.node(root);
                }
            }
        }
        if let Node::Number(value) = *node
            && value.fract() == 0.0
        {
            return Some(value);
        }
        let message = format!("`{}` cannot be the end of a range", crate::ast::quoted(text));
        self.mistakes.push(Error::new(Kind::Type, message, span).help(
            "a range goes from one whole number to another, or to a constant that is written as one",
        ));
        None
    }

    fn not_a_set(&self, text: &str, set: Span) -> Option<Error> {
        if text.starts_with('{') {
            return Some(
                Error::new(Kind::Type, "this set lists nothing", set)
                    .help("list what the name stands for: `{apple, mug}`"),
            );
        }
        let names = || self.scope.enums.iter().map(|known| known.name.as_str());
        let message = format!("`{text}` is not an enumeration that is declared here");
        let error = Error::new(Kind::UnknownName, message, set);
        if self.scope.is_broken(text) {
            return None;
        }
        Some(match super::name::nearest(text, &mut names()) {
            Some(near) => error.help(format!("did you mean `{near}`?")),
            None => error.help(format!(
                "declare it, `enum {text} {{ … }}`, or list the elements: `for all x in {{a, b}}: …`"
            )),
        })
    }
}
