//! Names: an [`Ast`] to [`Resolved`], in which every name stands for something.
//!
//! Three steps, in this order. `declare` reads the declarations of the items (names, types,
//! parameters and units) into a `scope`. `expand` goes through the expressions, writes quantifiers
//! out and answers each name once: a name that a quantifier binds, then parameters and items, then
//! the state (`place`) and the values of enumerations, or else whatever [`Names`] allow. `order`
//! sorts the items by their uses and refuses circles.
//!
//! A name that stands for nothing is an answer too, `Name::Unknown`, which holds its error. The
//! stage that reads the name reports it. If something else is wrong around the name, that stage
//! never reads it, so one mistake is reported once.
//!
//! Nothing here asks for types beyond the path of a place: whether a name may stand where it does
//! is for [`check`](crate::check). Cost: linear in the source with its quantifiers written out,
//! which is bounded.
//!
//! ```
//! use tltl_compiler::{parse, resolve::{Names, resolve}, source::Source};
//!
//! let ast = parse::file(&Source::new("loop.tltl", "const a = b\nconst b = a\n"))?;
//! let mut mistakes = Vec::new();
//! resolve(&ast, Names::Declared, &mut mistakes);
//! assert_eq!(mistakes[0].kind().name(), "cycle");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod decimal;
mod declare;
mod expand;
pub(crate) mod name;
mod order;
mod place;
mod scope;

use std::ops::Index;
use std::rc::Rc;

use crate::ast::{Ast, Comparison, Infix, Item, ItemKind, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{Function, ParameterType, Scalar, Type};
use crate::source::Span;
use crate::unit::Unit;
pub(crate) use decimal::{Decimal, Fraction};
pub(crate) use declare::large_unit;
use expand::{Binder, Environment};
pub(crate) use expand::{Bound, MOST_NODES};
pub(crate) use place::{a_type, elements};
pub(crate) use scope::Scope;

/// The meaning of names that the source does not declare.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Names {
    /// A bare formula: any name is a proposition, or a real variable inside a comparison.
    Free,
    /// The macro: a Rust value in scope, or an expression over the state.
    Host,
    /// A task file: nothing.
    Declared,
}

/// An expression of a [`Resolved`]: an index into its arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct ExpressionId(pub(crate) u32);

/// An expression without quantifiers, with its names resolved.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Expression {
    /// ⊤ or ⊥
    Truth(bool),
    /// A number, written or bound.
    Number(f64),
    /// A string literal.
    Text,
    /// A name, a path, or an expression that only Rust can read.
    Name(Name),
    /// A function or an item with arguments. Whether it takes these is not checked yet.
    Call(Callee, Vec<ExpressionId>),
    /// `op operand`
    Prefix(Prefix, ExpressionId),
    /// `left op right`
    Infix(Infix, ExpressionId, ExpressionId),
}

/// The target of a call: an item where a formula stands, a function of numbers where a number does.
/// A name may be both; its position decides, which is known later.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Callee {
    /// The item of this name.
    pub(crate) item: Option<usize>,
    /// The function of this name.
    pub(crate) function: Option<Function>,
}

/// The meaning of a name.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Name {
    /// A parameter of the item around it.
    Parameter {
        /// Its position among the parameters of the item.
        number: u32,
        /// Its type.
        ty: ParameterType,
        /// An item with the same name, which has been reported as an error; a formula then means
        /// the item.
        item: Option<usize>,
    },
    /// A constant, a predicate or a task, or an item that could not be parsed, by its position
    /// among the items. A value of an enumeration may have the same name; it is meant where one is
    /// expected.
    Item(usize, Vec<Value>),
    /// A place within the declared state, with the values of the same name.
    Place(Rc<Place>, Vec<Value>),
    /// One of the values with this name; the expected enumeration decides which.
    Values(Vec<Value>),
    /// The value that a quantifier binds to the name.
    Value(Value),
    /// `none`
    Absent,
    /// A function of numbers, which means nothing by itself.
    Function,
    /// A proposition or a variable of a bare formula.
    Free,
    /// A Rust expression.
    Rust,
    /// Nothing, with the error that says so. Shared: a path hands the error of its base on.
    Unknown(Rc<Error>),
}

/// A value of an enumeration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Value {
    /// The enumeration, counted in source order.
    pub(crate) of: u32,
    /// Its position among the values.
    pub(crate) number: u32,
}

/// A place within the declared state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// The path to it, from the state.
    pub(crate) segments: Vec<Segment>,
    /// The type at the place.
    pub(crate) ty: Type,
    /// The unit of its numbers, if the source gives one.
    pub(crate) unit: Option<Unit>,
    /// The depth to which places nest as indices in its path.
    depth: usize,
}

/// A step of the path to a [`Place`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Segment {
    /// A field, by the place of its name in the source.
    Field(Span),
    /// An element of an array.
    Index(u32),
    /// The element of a table at an index.
    Element {
        /// The index.
        index: ExpressionId,
        /// The enumeration that the index must be a value of.
        of: u32,
    },
    /// The element of an array at a number that is known only when the program runs.
    At {
        /// The number: a parameter, or a place.
        index: ExpressionId,
        /// The number of elements.
        length: u32,
    },
}

/// The sort of an expression that is a value, neither a number nor a truth value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    /// A value of an enumeration, unless it is absent.
    Enum {
        /// Which enumeration.
        of: u32,
        /// Whether it may be absent.
        optional: bool,
    },
    /// The name of a value; its neighbour may have to say of which enumeration.
    Variant,
    /// `none`
    Absent,
    /// A value of a Rust type of the user's.
    Host,
}

/// The sort of the values of a type; `None` for numbers and truth values.
pub(crate) fn sort_of(scalar: Scalar) -> Option<Sort> {
    match scalar {
        Scalar::Enum { of, optional } => Some(Sort::Enum { of, optional }),
        _ => None,
    }
}

/// An expression with its places.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) expression: Expression,
    /// The node that was written there.
    pub(crate) node: NodeId,
    /// The whole expression, with the brackets around it if there are any.
    pub(crate) outer: Span,
    /// The first of the expressions that are parts of it, which are neighbours.
    pub(crate) first: ExpressionId,
    /// The ends of its operator's bound.
    pub(crate) ends: Vec<ExpressionId>,
    /// Its value, if it is a number made of numbers and constants alone.
    pub(crate) value: Option<f64>,
    /// Whether it holds, if it is made of truth values and comparisons of known values alone.
    truth: Option<bool>,
    /// The names that quantifiers bind around it.
    pub(crate) environment: Environment,
}

/// A source whose names are resolved and whose quantifiers are written out.
///
/// Invariants: operands stand before the expressions that use them, and the expressions of one item
/// are neighbours, its root the last of them.
pub struct Resolved<'a> {
    pub(crate) ast: &'a Ast,
    pub(crate) names: Names,
    pub(crate) scope: Scope<'a>,
    entries: Vec<Entry>,
    /// The bound names, once for each value that one takes.
    binders: Vec<Binder>,
    /// For each item with an expression, its first expression and its root.
    pub(crate) expressions: Vec<Option<(ExpressionId, ExpressionId)>>,
    /// The items, each after those that it uses.
    pub(crate) order: Vec<usize>,
}

/// Resolves the names of a source.
///
/// Mistakes in declarations and quantifiers, and circles of items, are added to `mistakes`.
/// Mistakes in names stay in the result, for the stage that reads them.
pub fn resolve<'a>(ast: &'a Ast, names: Names, mistakes: &mut Vec<Error>) -> Resolved<'a> {
    let mut scope = declare::declare(ast, names);
    mistakes.append(&mut scope.mistakes);
    let expressions = vec![None; ast.items().len()];
    let (entries, binders, order) = (Vec::new(), Vec::new(), Vec::new());
    let mut resolved = Resolved { ast, names, scope, entries, binders, expressions, order };
    let uses = expand::expand(&mut resolved, mistakes);
    let (order, circles) = order::order(&uses);
    mistakes.extend(circles.into_iter().map(|(item, span)| order::circle(ast, item, span)));
    resolved.order = order;
    resolved
}

/// One comparison of a chain.
pub(crate) struct Link {
    /// The comparison.
    pub(crate) op: Comparison,
    /// Its two sides.
    pub(crate) sides: [ExpressionId; 2],
    /// The place of its symbol.
    pub(crate) operator: Span,
}

impl Index<ExpressionId> for Resolved<'_> {
    type Output = Entry;

    fn index(&self, id: ExpressionId) -> &Entry {
        &self.entries[id.0 as usize]
    }
}

impl Resolved<'_> {
    /// The value of an item; `None` if it is not a constant or has a mistake.
    pub(crate) fn constant(&self, item: usize) -> Option<f64> {
        self.expressions[item]
            .filter(|_| self.is_constant(item))
            .and_then(|(_, root)| self[root].value)
    }

    /// Whether an item is a constant.
    pub(crate) fn is_constant(&self, item: usize) -> bool {
        matches!(self.item(item).kind, ItemKind::Constant(..))
    }

    /// The value of an expression of known numbers, if it is finite. Arrays are indexed and ranges
    /// ended by such values, so they are needed before any type is checked.
    fn calculated(&self, expression: &Expression) -> Option<f64> {
        let of = |id: &ExpressionId| self[*id].value;
        let value = match expression {
            Expression::Number(value) => *value,
            Expression::Prefix(Prefix::Minus, a) => -of(a)?,
            Expression::Infix(Infix::Calculate(op), a, b) => op.value(of(a)?, of(b)?),
            Expression::Call(Callee { function: Some(function), .. }, arguments) => {
                let values: Vec<f64> = arguments.iter().map(of).collect::<Option<_>>()?;
                let (first, rest) = values.split_first()?;
                function.takes(values.len()).then_some(())?;
                match rest {
                    [] => function.value(*first, 0.0),
                    rest => rest.iter().fold(*first, |x, y| function.value(x, *y)),
                }
            }
            Expression::Name(Name::Item(item, _)) => self.constant(*item)?,
            _ => return None,
        };
        // Adding 0 makes -0 to 0: the sign of zero is not part of any meaning here.
        value.is_finite().then_some(value + 0.0)
    }

    /// Whether an expression holds, if it is made of truth values and comparisons of known values.
    fn known(&self, expression: &Expression) -> Option<bool> {
        let of = |id: ExpressionId| self[id].truth;
        match *expression {
            Expression::Truth(truth) => Some(truth),
            Expression::Prefix(Prefix::Not, a) => of(a).map(|truth| !truth),
            Expression::Infix(Infix::Compare(op), a, b) => self.compared(op, a, b),
            Expression::Infix(op, a, b) => self.settled(op, a, b).or_else(|| match op {
                Infix::And => Some(of(a)? && of(b)?),
                Infix::Or => Some(of(a)? || of(b)?),
                Infix::Implies => Some(!of(a)? || of(b)?),
                Infix::Iff => Some(of(a)? == of(b)?),
                _ => None,
            }),
            _ => None,
        }
    }

    /// Whether `a op b` holds, if one of the two says so whatever the other is.
    fn settled(&self, op: Infix, a: ExpressionId, b: ExpressionId) -> Option<bool> {
        let [first, second] = [a, b].map(|id| self[id].truth);
        match op {
            Infix::And => [first, second].contains(&Some(false)).then_some(false),
            Infix::Or => [first, second].contains(&Some(true)).then_some(true),
            Infix::Implies => (first == Some(false)).then_some(true),
            _ => None,
        }
    }

    /// The operand of an expression of which nothing depends: the other one settles what they are
    /// together, as `i > 0` does in `i > 0 => F[1,i] p` for an `i` of 0.
    pub(crate) fn idle(&self, id: ExpressionId) -> Option<ExpressionId> {
        let Expression::Infix(op, a, b) = self[id].expression else { return None };
        self.settled(op, a, b)?;
        [a, b].into_iter().find(|operand| self[*operand].truth.is_none())
    }

    /// The truth of a comparison of known numbers, of a chain of them, or of two values.
    fn compared(&self, op: Comparison, a: ExpressionId, b: ExpressionId) -> Option<bool> {
        let (before, a) = match self[a].expression {
            Expression::Infix(_, _, middle) if self.is_chained(a) => (self[a].truth?, middle),
            _ => (true, a),
        };
        if let (Some(x), Some(y)) = (self[a].value, self[b].value) {
            return Some(before && op.holds(x, y));
        }
        let is_equal = self.single(a, b).or_else(|| self.single(b, a))?;
        match op {
            Comparison::Equal => Some(is_equal),
            Comparison::Unequal => Some(!is_equal),
            _ => None,
        }
    }

    /// Whether two expressions are one value, if the first of them can only be a value.
    fn single(&self, a: ExpressionId, b: ExpressionId) -> Option<bool> {
        let values = |id| match &self[id].expression {
            Expression::Name(Name::Value(value)) => std::slice::from_ref(value),
            Expression::Name(
                Name::Values(values) | Name::Item(_, values) | Name::Place(_, values),
            ) => values,
            _ => &[],
        };
        let &[one] = values(a) else { return None };
        let other = values(b).iter().find(|other| other.of == one.of)?;
        let Expression::Name(Name::Value(_) | Name::Values(_)) = self[a].expression else {
            return None;
        };
        Some(*other == one)
    }

    /// Whether an expression is a truth value with a name: a field, a parameter, a predicate.
    fn is_truth(&self, id: ExpressionId) -> bool {
        let is_predicate = |item: usize| matches!(self.item(item).kind, ItemKind::Predicate(..));
        match &self[id].expression {
            Expression::Name(Name::Place(place, _)) => place.scalar() == Some(Scalar::Bool),
            Expression::Name(Name::Parameter { ty, .. }) => ty.scalar() == Some(Scalar::Bool),
            Expression::Name(Name::Item(item, _))
            | Expression::Call(Callee { item: Some(item), .. }, _) => is_predicate(*item),
            _ => false,
        }
    }

    /// Whether an expression is a name, or a path of fields and indices.
    pub(crate) fn is_path(&self, id: ExpressionId) -> bool {
        let node = self.ast.node(self[id].node);
        matches!(node, Node::Name | Node::Field { .. } | Node::Index { .. })
    }

    /// The place of an expression, without brackets around it.
    pub(crate) fn span(&self, id: ExpressionId) -> Span {
        self.ast.span(self[id].node)
    }

    /// The place of the operator of an expression; the whole of it if it has none.
    pub(crate) fn operator(&self, id: ExpressionId) -> Span {
        self.ast.entry(self[id].node).operator
    }

    /// The operator of an expression, as it was written.
    pub(crate) fn symbol(&self, id: ExpressionId) -> &str {
        self.ast.source().slice(self.operator(id))
    }

    /// Whether the author put brackets around an expression.
    pub(crate) fn is_bracketed(&self, id: ExpressionId) -> bool {
        self[id].outer != self.span(id)
    }

    /// The text of an expression, as it was written.
    pub(crate) fn text(&self, id: ExpressionId) -> &str {
        self.ast.text(self[id].node)
    }

    /// The text of an expression as messages quote it: on one line, and not too long.
    pub(crate) fn quote(&self, id: ExpressionId) -> String {
        self.ast.quote(self[id].node)
    }

    /// The error for an expression of the wrong type.
    pub(crate) fn type_error(&self, id: ExpressionId, message: impl Into<String>) -> Error {
        Error::new(Kind::Type, message, self.span(id))
    }

    /// The sort of a value; `None` if the expression is a number, a formula, or unknown.
    pub(crate) fn sort(&self, id: ExpressionId) -> Option<Sort> {
        let Expression::Name(name) = &self[id].expression else { return None };
        match name {
            Name::Parameter { ty, .. } => ty.scalar().map_or(Some(Sort::Host), sort_of),
            Name::Value(value) => Some(Sort::Enum { of: value.of, optional: false }),
            Name::Place(place, _) => place.scalar().and_then(sort_of),
            Name::Values(_) => Some(Sort::Variant),
            Name::Absent => Some(Sort::Absent),
            _ => None,
        }
    }

    /// Whether the left operand of a comparison is the chain before it, as `a < b` in `a < b < c`.
    pub(crate) fn is_chained(&self, left: ExpressionId) -> bool {
        matches!(self.ast.node(self[left].node), Node::Infix(Infix::Compare(_), ..))
            && !self.is_bracketed(left)
    }

    /// The comparisons of a chain, left to right.
    pub(crate) fn chain(&self, id: ExpressionId) -> Vec<Link> {
        let mut links = Vec::new();
        let mut at = id;
        while let Expression::Infix(Infix::Compare(op), left, right) = self[at].expression {
            let before = match self[left].expression {
                Expression::Infix(_, _, middle) if self.is_chained(left) => middle,
                _ => left,
            };
            links.push(Link { op, sides: [before, right], operator: self.operator(at) });
            if before == left {
                break;
            }
            at = left;
        }
        links.reverse();
        links
    }

    /// The declaration of an item.
    pub(crate) fn item(&self, item: usize) -> &Item {
        &self.ast.items()[item]
    }

    /// The name of an item.
    pub(crate) fn item_name(&self, item: usize) -> &str {
        self.ast.source().slice(self.item(item).name)
    }
}

#[cfg(test)]
pub(crate) mod tests;
