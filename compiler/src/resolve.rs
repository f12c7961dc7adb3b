//! Names: an [`Ast`] to [`Resolved`], in which every name stands for something.
//!
//! Three steps, in this order. `declare` reads what the items declare, names, types, parameters and
//! units, into a `scope`. `expand` goes through the expressions, writes quantifiers out and answers each name once:
//! what a quantifier binds, then the parameters and items, then the state (`place`) and the values
//! of enumerations, or else what [`Names`] allow. `order` sorts the items by their uses and refuses
//! circles.
//!
//! A name that stands for nothing is an answer too, `Name::Unknown`, which holds its error. The
//! stage that reads the name reports it: where something else is wrong around the name, nobody
//! does, and one mistake is reported once.

mod declare;
mod expand;
pub(crate) mod name;
mod order;
mod place;
mod scope;

use std::ops::Index;
use std::rc::Rc;

use crate::ast::{Ast, Infix, Item, ItemKind, Node, NodeId, Prefix};
use crate::error::{Error, Kind};
use crate::predicate::{Function, ParameterType, Scalar, Type};
use crate::source::Span;
use crate::unit::Unit;
pub(crate) use declare::large_unit;
use expand::{Binder, Environment};
pub(crate) use expand::{Bound, MOST_NODES};
pub(crate) use place::{a_type, elements};
pub(crate) use scope::Scope;

/// What a name may be that the source does not declare.
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
    /// A name, a path, or anything else that only Rust can read.
    Name(Name),
    /// A function or an item with arguments; whether it takes these is not checked yet.
    Call(Callee, Vec<ExpressionId>),
    /// `op operand`
    Prefix(Prefix, ExpressionId),
    /// `left op right`
    Infix(Infix, ExpressionId, ExpressionId),
}

/// What a call calls: an item where a formula stands, a function of numbers where a number does.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Callee {
    pub(crate) item: Option<usize>,
    pub(crate) function: Option<Function>,
}

/// What a name stands for.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Name {
    /// A parameter of the item around it.
    Parameter {
        /// Which of them.
        number: u32,
        /// Its type.
        ty: ParameterType,
        /// An item that is called the same, which is an error already: a formula means that.
        item: Option<usize>,
    },
    /// A constant, a predicate or a task, or an item that could not be parsed: its place among the
    /// items. A value of an enumeration may be called the same; it is meant where that is expected.
    Item(usize, Vec<Value>),
    /// A place within the declared state; values may be called the same here too.
    Place(Box<Place>, Vec<Value>),
    /// One of the values that are called so, by what is expected.
    Values(Vec<Value>),
    /// The value that a quantifier binds to the name.
    Value(Value),
    /// `none`
    Absent,
    /// A function of numbers, which stands for nothing by itself.
    Function,
    /// A proposition or a variable of a bare formula.
    Free,
    /// A Rust expression; and the place that reads the same, if a state is declared beside it.
    Rust(Option<Box<Place>>),
    /// Nothing, and why.
    Unknown(Rc<Error>),
}

/// A value of an enumeration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Value {
    /// Which enumeration, counted in source order.
    pub(crate) of: u32,
    /// Which of its values.
    pub(crate) number: u32,
}

/// A place within the declared state.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Place {
    /// The way to it.
    pub(crate) segments: Vec<Segment>,
    /// What stands there.
    pub(crate) ty: Type,
    /// What its numbers are measured in, if the source says so.
    pub(crate) unit: Option<Unit>,
    /// How deep indices that are places themselves nest in it.
    depth: usize,
}

/// A part of the way to a [`Place`].
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Segment {
    /// A field: where its name stands.
    Field(Span),
    /// An element of an array.
    Index(u32),
    /// The element of a table at an index.
    Element {
        /// The index.
        index: ExpressionId,
        /// The enumeration whose value it has to be.
        of: u32,
    },
    /// The element of an array at a number that is known when the program runs.
    At {
        /// The number: a parameter, or a place.
        index: ExpressionId,
        /// How many elements there are.
        length: u32,
    },
}

/// What sort of value an expression is that is no number and no truth value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Sort {
    /// Of an enumeration, if it is not absent.
    Enum {
        /// Which enumeration.
        of: u32,
        /// Whether there may be no value.
        optional: bool,
    },
    /// The name of a value; what stands beside it may have to tell of which enumeration.
    Variant,
    /// `none`
    Absent,
    /// Of a Rust type of the user's.
    Host,
}

/// The sort of the values of a type.
pub(crate) fn sort_of(scalar: Scalar) -> Option<Sort> {
    match scalar {
        Scalar::Enum { of, optional } => Some(Sort::Enum { of, optional }),
        _ => None,
    }
}

/// An expression with where it stands.
#[derive(Debug)]
pub(crate) struct Entry {
    pub(crate) expression: Expression,
    /// What was written there.
    pub(crate) node: NodeId,
    /// All of it, with the brackets around it if there are any.
    pub(crate) outer: Span,
    /// The first of the expressions that are parts of it; they are neighbours.
    pub(crate) first: ExpressionId,
    /// Its value, if it is a number that is made of numbers and constants only.
    pub(crate) value: Option<f64>,
    pub(crate) environment: Environment,
}

/// A source whose names are resolved and whose quantifiers are written out.
///
/// Invariant: operands stand before the expressions that use them, and the expressions of one item
/// are neighbours, its root the last of them.
pub struct Resolved<'a> {
    pub(crate) ast: &'a Ast,
    pub(crate) names: Names,
    pub(crate) scope: Scope<'a>,
    entries: Vec<Entry>,
    binders: Vec<Binder>,
    /// The first expression of each item that has some, and its root.
    pub(crate) expressions: Vec<Option<(ExpressionId, ExpressionId)>>,
    /// The items, each after the ones that it uses.
    pub(crate) order: Vec<usize>,
}

/// Resolves the names of a source. Mistakes in declarations, quantifiers and circles of items are
/// reported here; those in names, by who reads them.
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

impl Index<ExpressionId> for Resolved<'_> {
    type Output = Entry;

    fn index(&self, id: ExpressionId) -> &Entry {
        &self.entries[id.0 as usize]
    }
}

impl Resolved<'_> {
    /// The value of an item, if it is a constant and has one.
    pub(crate) fn constant(&self, item: usize) -> Option<f64> {
        self.expressions[item]
            .filter(|_| self.is_constant(item))
            .and_then(|(_, root)| self[root].value)
    }

    pub(crate) fn is_constant(&self, item: usize) -> bool {
        matches!(self.item(item).kind, ItemKind::Constant(..))
    }

    /// The value of an expression of known numbers, if it is finite.
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
        // One zero: the sign of zero is no part of any meaning here.
        value.is_finite().then_some(value + 0.0)
    }

    /// Whether an expression is a name, or a path of fields and indices.
    pub(crate) fn is_path(&self, id: ExpressionId) -> bool {
        let node = self.ast.node(self[id].node);
        matches!(node, Node::Name | Node::Field { .. } | Node::Index { .. })
    }

    /// Where an expression stands.
    pub(crate) fn span(&self, id: ExpressionId) -> Span {
        self.ast.span(self[id].node)
    }

    /// The operator of an expression; the whole of it if it has none.
    pub(crate) fn operator(&self, id: ExpressionId) -> Span {
        self.ast.entry(self[id].node).operator
    }

    /// The operator of an expression as it was written.
    pub(crate) fn symbol(&self, id: ExpressionId) -> &str {
        self.ast.source().slice(self.operator(id))
    }

    /// Whether the author put brackets around an expression.
    pub(crate) fn is_bracketed(&self, id: ExpressionId) -> bool {
        self[id].outer != self.span(id)
    }

    /// The text of an expression.
    pub(crate) fn text(&self, id: ExpressionId) -> &str {
        self.ast.text(self[id].node)
    }

    /// The text of an expression as messages quote it: on one line, and not too long.
    pub(crate) fn quote(&self, id: ExpressionId) -> String {
        self.ast.quote(self[id].node)
    }

    /// The error for an expression that is not what it has to be.
    pub(crate) fn type_error(&self, id: ExpressionId, message: impl Into<String>) -> Error {
        Error::new(Kind::Type, message, self.span(id))
    }

    /// What sort of value an expression is; `None` if it is a number, a formula, or nothing.
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

    /// The operands of an expression, left to right; none of a name, whatever it is made of.
    pub(crate) fn operands(&self, id: ExpressionId) -> Vec<ExpressionId> {
        match &self[id].expression {
            Expression::Call(_, arguments) => arguments.clone(),
            Expression::Prefix(_, a) => vec![*a],
            Expression::Infix(_, a, b) => vec![*a, *b],
            _ => Vec::new(),
        }
    }

    /// Whether the left operand of a comparison is the part of a chain before it.
    pub(crate) fn is_chained(&self, left: ExpressionId) -> bool {
        matches!(&self[left].expression, Expression::Infix(Infix::Compare(_), ..))
            && !self.is_bracketed(left)
    }

    /// The declaration of an item.
    pub(crate) fn item(&self, item: usize) -> &Item {
        &self.ast.items()[item]
    }

    /// What an item is called.
    pub(crate) fn item_name(&self, item: usize) -> &str {
        self.ast.source().slice(self.item(item).name)
    }
}

#[cfg(test)]
pub(crate) mod tests;
