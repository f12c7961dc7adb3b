//! A source as it was written: items and expressions with their places.
//!
//! The tree keeps everything that messages and the formatter need: brackets, the author's spelling
//! of operators, docs, the order of items. It does not say what is meant: whether a name is a field
//! or a predicate is for [`resolve`](crate::resolve), and whether an operand is a number or a
//! formula for [`check`](crate::check).
//!
//! Expressions are stored in one arena, operands before the operators that use them. So every pass
//! is a loop and dropping is flat, however deep the author nested. The nodes of one expression are
//! neighbours, its root the last of them: a pass over an expression is a pass over a range.
//!
//! ```
//! use tltl_compiler::{ast::{ItemKind, Node}, parse, source::Source};
//!
//! let ast = parse::formula(&Source::new("formula", "a U  (b&&c)"))?;
//! let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
//! let [left, right] = ast.operands(root)[..] else { panic!() };
//! assert_eq!((ast.text(left), ast.text(right)), ("a", "b&&c"));
//! assert!(ast.entry(right).is_bracketed());
//! // Printed with the brackets and blanks that a reader wants.
//! assert_eq!(ast.display(root).to_string(), "a U (b && c)");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

mod print;

use std::ops::Range;

pub use print::Printed;

use crate::source::{Source, Span};

/// An expression of an [`Ast`]: an index into its arena.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId(pub u32);

/// An operator before its operand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Prefix {
    /// ¬φ
    Not,
    /// ◇φ
    Eventually,
    /// ○φ
    Next,
    /// □φ; of the language only with a bound, or where a negation makes it ◇¬φ.
    Always,
    /// −x
    Minus,
}

/// A comparison of two numbers or two values.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Comparison {
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    Greater,
    /// `>=`
    AtLeast,
    /// `==`
    Equal,
    /// `!=`
    Unequal,
}

/// A calculation with two numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// `+`
    Add,
    /// `-`
    Subtract,
    /// `*`
    Multiply,
    /// `/`
    Divide,
}

/// An operator between two operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Infix {
    /// φ `ensuring` p
    Ensuring,
    /// φ ⇒ ψ
    Implies,
    /// p ⇔ q, of state formulas
    Iff,
    /// φ ∨ ψ
    Or,
    /// φ ∧ ψ
    And,
    /// φ U ψ
    Until,
    /// φ T ψ
    Then,
    /// φ R ψ; of the language only under a negation, as the other two here.
    Release,
    /// φ W ψ
    WeakUntil,
    /// φ M ψ
    StrongRelease,
    /// `x < y` and its like
    Compare(Comparison),
    /// `x + y` and its like
    Calculate(Arithmetic),
}

impl Infix {
    /// Whether it relates instants.
    #[must_use]
    pub const fn is_temporal(self) -> bool {
        matches!(
            self,
            Self::Until
                | Self::Then
                | Self::Release
                | Self::WeakUntil
                | Self::StrongRelease
                | Self::Ensuring
        )
    }
}

/// One expression. The text of names and numbers is that of the source; see [`Ast::text`].
#[derive(Clone, Debug, PartialEq)]
pub enum Node {
    /// ⊤ or ⊥
    Truth(bool),
    /// A literal number.
    Number(f64),
    /// A name or a path.
    Name,
    /// A string literal. Only the calls of Rust expressions have them.
    Text,
    /// `{ … }`: a Rust expression, verbatim.
    Verbatim,
    /// `base.field`
    Field {
        /// The expression before the dot.
        base: NodeId,
        /// The name of the field.
        field: Span,
    },
    /// `base[index]`
    Index {
        /// The array.
        base: NodeId,
        /// The expression in the brackets.
        index: NodeId,
    },
    /// `callee(arguments)`
    Call {
        /// The function or method.
        callee: NodeId,
        /// Its arguments: a range of [`Ast::arguments`].
        arguments: Range<u32>,
    },
    /// `op operand`
    Prefix(Prefix, NodeId),
    /// `left op right`. A chain `a < b < c` is `(a < b) < c` whose left operand has no brackets.
    Infix(Infix, NodeId, NodeId),
    /// `for all name in set: body`, or `for some`
    Quantified(Quantifier),
}

/// `for all name in set: body`, or `for some`: a finite conjunction or disjunction that resolving
/// writes out.
///
/// ```
/// use tltl_compiler::{ast::{ItemKind, Node}, parse, source::Source};
///
/// let ast = parse::formula(&Source::new("formula", "for all r in {hall, attic}: F clean(r)"))?;
/// let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
/// let Node::Quantified(quantifier) = ast.node(root) else { panic!("it is one") };
/// assert_eq!((quantifier.all, ast.source().slice(quantifier.name)), (true, "r"));
/// assert_eq!((ast.arguments(&quantifier.elements).len(), quantifier.range), (2, None));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Quantifier {
    /// Whether it is `for all`.
    pub all: bool,
    /// The bound name.
    pub name: Span,
    /// The set that it ranges over.
    pub set: Span,
    /// The elements of a set that lists them, or the two ends of a range of numbers: a range of
    /// [`Ast::arguments`].
    pub elements: Range<u32>,
    /// `None` for a set; for a range of numbers, whether its end is included.
    pub range: Option<bool>,
    /// The formula.
    pub body: NodeId,
}

/// The bound of a temporal operator, as written.
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let ast = parse::formula(&Source::new("formula", "a U[<=0.5 s] b"))?;
/// let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
/// let bound = ast.entry(root).bound.as_ref().unwrap();
/// assert_eq!((bound.at_most, bound.ends.len()), (true, 1));
/// assert_eq!(ast.source().slice(bound.ends[0].unit.unwrap()), "s");
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Bound {
    /// Its ends: two of `[a,b]`, one of `[<=b]` and of `[b]`.
    pub ends: Vec<End>,
    /// Whether it is `[<=b]`.
    pub at_most: bool,
    /// The whole bound, with its brackets.
    pub span: Span,
}

/// An end of a [`Bound`], as written: `3`, `0.5 s`, `-1`, or the name of a number.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// The number or the name, without sign and unit.
    pub node: NodeId,
    /// Whether a minus stands before it.
    pub negative: bool,
    /// The unit after a number.
    pub unit: Option<Span>,
    /// All of it.
    pub span: Span,
}

/// A node with its places in the source.
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let ast = parse::formula(&Source::new("formula", "F[0,5] (a)"))?;
/// let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
/// let entry = ast.entry(root);
/// assert_eq!(ast.source().slice(entry.operator), "F[0,5]");
/// assert!(entry.bound.is_some() && ast.entry(ast.operands(root)[0]).is_bracketed());
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Entry {
    /// The expression.
    pub node: Node,
    /// The bound of its operator.
    pub bound: Option<Box<Bound>>,
    /// The whole expression, without brackets around it.
    pub span: Span,
    /// The whole expression, with the brackets around it if there are any.
    pub outer: Span,
    /// Its operator, with the bound; the whole expression if it has none. Messages underline it.
    pub operator: Span,
}

impl Entry {
    /// Whether the author put brackets around it. Brackets mean nothing to the formula; the
    /// formatter keeps some, and a chain of comparisons is broken by them.
    #[must_use]
    pub fn is_bracketed(&self) -> bool {
        self.outer != self.span
    }
}

/// The type of a field, as written: a name within array brackets.
///
/// ```
/// use tltl_compiler::{ast::ItemKind, parse, source::Source};
///
/// let ast = parse::file(&Source::new("s.tltl", "state S { seen: [[Object?; Room]; 4] }"))?;
/// let ItemKind::State(fields) = &ast.items()[0].kind else { panic!() };
/// let ty = &fields[0].ty;
/// let lengths: Vec<_> = ty.lengths.iter().map(|length| ast.source().slice(*length)).collect();
/// assert!(ast.source().slice(ty.name) == "Object" && ty.optional);
/// assert_eq!(lengths, ["Room", "4"]);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct FieldType {
    /// The name of the element type.
    pub name: Span,
    /// Whether `?` follows the name: the value may be absent.
    pub optional: bool,
    /// The lengths, innermost first: numbers, or names of constants or enumerations.
    pub lengths: Vec<Span>,
    /// The whole type.
    pub span: Span,
}

/// A unit, as written: `N*m`, `1/s^2`.
#[derive(Clone, Debug)]
pub struct WrittenUnit {
    /// Its factors, in order. A factor `1` is left out.
    pub factors: Vec<UnitFactor>,
    /// The whole unit.
    pub span: Span,
}

/// A name in a unit, with its power.
#[derive(Clone, Debug)]
pub struct UnitFactor {
    /// The name.
    pub name: Span,
    /// Whether a `/` stands before it.
    pub divides: bool,
    /// The digits of its power, and whether a minus stands before them; `None` for the power 1.
    pub power: Option<(Span, bool)>,
    /// The whole factor.
    pub span: Span,
}

/// A field of a struct, or a parameter: `name: type in unit`.
#[derive(Clone, Debug)]
pub struct Declaration {
    /// The author's docs, a string a line.
    pub docs: Vec<String>,
    /// Its name.
    pub name: Span,
    /// Its type.
    pub ty: FieldType,
    /// Its unit, if the source gives one.
    pub unit: Option<WrittenUnit>,
}

/// The kind of an item, with the parts that only this kind has.
#[derive(Clone, Debug)]
pub enum ItemKind {
    /// `state Name { fields }`
    State(Vec<Declaration>),
    /// `state name: RustType;`, or the header `|name: &RustType|`
    Host(Span),
    /// `struct Name { fields }`
    Struct(Vec<Declaration>),
    /// `enum Name { variants }`
    Enum(Vec<Span>),
    /// `const name = value`, or `const name in unit = value`
    Constant(Option<WrittenUnit>, NodeId),
    /// `predicate name = condition`
    Predicate(Vec<Declaration>, NodeId),
    /// `task name = formula`; a bare formula is a task whose name is empty.
    Task(Vec<Declaration>, NodeId),
    /// `step 0.1 s`: how long a step lasts. It has no name.
    Step {
        /// The number.
        amount: Span,
        /// Its unit.
        unit: Span,
    },
    /// An item that could not be parsed. Its name is known, so uses of it are not reported, and
    /// perhaps its parameters.
    Broken(Vec<Declaration>),
}

/// An attribute before a task or a formula: `#[name(setting = number, …)]`.
///
/// ```
/// use tltl_compiler::{parse, source::Source};
///
/// let text = "#[budget(states = 9)] task t = F a";
/// let ast = parse::file(&Source::new("t.tltl", text))?;
/// let attribute = &ast.items()[0].attributes[0];
/// let (name, number) = attribute.settings[0];
/// let texts = [attribute.name, name, number].map(|span| ast.source().slice(span));
/// assert_eq!(texts, ["budget", "states", "9"]);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[derive(Clone, Debug)]
pub struct Attribute {
    /// Its name.
    pub name: Span,
    /// Its settings: names and numbers.
    pub settings: Vec<(Span, Span)>,
}

/// One declaration of a source.
#[derive(Clone, Debug)]
pub struct Item {
    /// Its attributes, in order. Only tasks may have them, which is checked later.
    pub attributes: Vec<Attribute>,
    /// The author's docs, a string a line.
    pub docs: Vec<String>,
    /// Its name; an empty span for a bare formula.
    pub name: Span,
    /// Its kind, and the parts that only this kind has.
    pub kind: ItemKind,
    /// The whole item, without its docs.
    pub span: Span,
}

/// A parsed source.
///
/// Invariants: operands stand before the nodes that use them; the nodes of one expression are
/// neighbours; every range of arguments lies within `arguments`.
#[derive(Clone, Debug)]
pub struct Ast {
    source: Source,
    docs: Vec<String>,
    items: Vec<Item>,
    entries: Vec<Entry>,
    arguments: Vec<NodeId>,
}

impl Ast {
    /// The tree of a source without items.
    pub(crate) fn new(source: Source) -> Self {
        Self {
            source,
            docs: Vec::new(),
            items: Vec::new(),
            entries: Vec::new(),
            arguments: Vec::new(),
        }
    }

    /// The text that was parsed.
    #[must_use]
    pub fn source(&self) -> &Source {
        &self.source
    }

    /// The author's docs of the whole file, a string a line.
    #[must_use]
    pub fn docs(&self) -> &[String] {
        &self.docs
    }

    /// The declarations, in source order.
    #[must_use]
    pub fn items(&self) -> &[Item] {
        &self.items
    }

    /// One expression.
    #[must_use]
    pub fn entry(&self, id: NodeId) -> &Entry {
        &self.entries[id.0 as usize]
    }

    /// The operator of one expression.
    #[must_use]
    pub fn node(&self, id: NodeId) -> &Node {
        &self.entry(id).node
    }

    /// The place of an expression, without brackets around it.
    #[must_use]
    pub fn span(&self, id: NodeId) -> Span {
        self.entry(id).span
    }

    /// The text of an expression as written.
    #[must_use]
    pub fn text(&self, id: NodeId) -> &str {
        self.source.slice(self.span(id))
    }

    /// The text of an expression as messages quote it: on one line, and not too long.
    #[must_use]
    pub fn quote(&self, id: NodeId) -> String {
        quoted(self.text(id))
    }

    /// The arguments of a call.
    #[must_use]
    pub fn arguments(&self, range: &Range<u32>) -> &[NodeId] {
        &self.arguments[range.start as usize..range.end as usize]
    }

    /// The operands of an expression, left to right.
    ///
    /// ```
    /// use tltl_compiler::{ast::ItemKind, parse, source::Source};
    ///
    /// let ast = parse::formula(&Source::new("formula", "min(x, 2) < y"))?;
    /// let ItemKind::Task(_, less) = ast.items()[0].kind else { panic!() };
    /// let texts = |id| ast.operands(id).into_iter().map(|id| ast.text(id)).collect::<Vec<_>>();
    /// assert_eq!(texts(less), ["min(x, 2)", "y"]);
    /// assert_eq!(texts(ast.operands(less)[0]), ["min", "x", "2"]);
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn operands(&self, id: NodeId) -> Vec<NodeId> {
        match self.node(id) {
            Node::Truth(_) | Node::Number(_) | Node::Name | Node::Text | Node::Verbatim => vec![],
            Node::Field { base, .. } => vec![*base],
            Node::Index { base, index } => vec![*base, *index],
            Node::Call { callee, arguments } => [&[*callee], self.arguments(arguments)].concat(),
            Node::Prefix(_, a) => vec![*a],
            Node::Quantified(Quantifier { elements, body, .. }) => {
                [self.arguments(elements), &[*body]].concat()
            }
            Node::Infix(_, a, b) => vec![*a, *b],
        }
    }

    /// The first operand of an expression, where [`operands`](Self::operands) has one, or the first
    /// end of the bound that stands before it.
    pub(crate) fn leftmost(&self, id: NodeId) -> Option<NodeId> {
        let Entry { node, bound, .. } = self.entry(id);
        match node {
            Node::Prefix(_, a) => Some(bound.as_ref().map_or(*a, |bound| bound.ends[0].node)),
            Node::Field { base, .. } | Node::Index { base, .. } => Some(*base),
            Node::Call { callee, .. } => Some(*callee),
            Node::Infix(_, a, _) => Some(*a),
            Node::Quantified(Quantifier { elements, body, .. }) => {
                Some(*self.arguments(elements).first().unwrap_or(body))
            }
            _ => None,
        }
    }

    /// The first node of the expression `root`; its nodes are `first..=root`.
    #[must_use]
    pub fn first(&self, root: NodeId) -> NodeId {
        let mut id = root;
        while let Some(operand) = self.leftmost(id) {
            id = operand;
        }
        id
    }

    /// Adds an expression; its operands must be there already.
    pub(crate) fn push(&mut self, node: Node, span: Span, operator: Span) -> NodeId {
        let id = u32::try_from(self.entries.len()).expect("fewer than 2^32 expressions");
        self.entries.push(Entry { node, bound: None, span, outer: span, operator });
        NodeId(id)
    }

    /// Gives the operator of an expression its bound.
    pub(crate) fn bind(&mut self, id: NodeId, bound: Option<Box<Bound>>) {
        self.entries[id.0 as usize].bound = bound;
    }

    /// Notes the brackets around an expression.
    pub(crate) fn bracket(&mut self, id: NodeId, brackets: Span) {
        self.entries[id.0 as usize].outer = brackets;
    }

    /// Adds the arguments of one call, or the elements of one set.
    pub(crate) fn push_arguments(&mut self, arguments: &[NodeId]) -> Range<u32> {
        let end =
            |list: &Vec<NodeId>| u32::try_from(list.len()).expect("fewer than 2^32 arguments");
        let start = end(&self.arguments);
        self.arguments.extend_from_slice(arguments);
        start..end(&self.arguments)
    }

    /// Adds an item, after the items before it in the source.
    pub(crate) fn push_item(&mut self, item: Item) {
        self.items.push(item);
    }

    /// Sets the docs of the whole file.
    pub(crate) fn set_docs(&mut self, docs: Vec<String>) {
        self.docs = docs;
    }
}

/// The most characters of the source that a message quotes: more than that and the sentence around
/// the quotation is lost.
const QUOTED: usize = 60;

/// A text as messages quote it: on one line, and cut to a length that a sentence bears.
///
/// ```
/// assert_eq!(tltl_compiler::ast::quoted("F (a\n   && b)"), "F (a && b)");
/// ```
#[must_use]
pub fn quoted(text: &str) -> String {
    let mut short: String = text.chars().take(QUOTED).collect();
    if short.len() < text.len() {
        short.push('…');
    }
    short.split_whitespace().collect::<Vec<_>>().join(" ")
}
