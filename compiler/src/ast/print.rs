//! Expressions as text, with the brackets that a reader wants: `U` and `T` are never mixed without
//! them, and the reach of an operator before a comparison is shown.
//!
//! Parsing the text gives the same expression (a property that is tested over random formulas). A
//! stack of pieces takes the place of recursion, so any depth prints.
//!
//! ```
//! use tltl_compiler::{ast::ItemKind, parse, source::Source};
//!
//! let ast = parse::formula(&Source::new("formula", "◇(a∧¬b)  U  x<3"))?;
//! let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
//! assert_eq!(ast.display(root).to_string(), "(F (a && !b)) U (x < 3)");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::fmt;

use super::{Arithmetic, Ast, Infix, Node, NodeId, Prefix, Quantifier};
use crate::token::compact;

/// An expression of an [`Ast`] that can be printed.
pub struct Printed<'a> {
    ast: &'a Ast,
    root: NodeId,
}

/// A piece of the text that is still to be printed.
enum Piece {
    Node(NodeId),
    Text(&'static str),
    /// The bound of an expression's operator.
    Bound(NodeId),
}

impl Ast {
    /// The expression `root` as text; parsing it gives the same expression.
    #[must_use]
    pub fn display(&self, root: NodeId) -> Printed<'_> {
        Printed { ast: self, root }
    }

    /// An expression as text, with the brackets that it needs as an operand of `parent`, on its
    /// left or not.
    ///
    /// ```
    /// use tltl_compiler::{ast::{ItemKind, Node}, parse, source::Source};
    ///
    /// let ast = parse::formula(&Source::new("formula", "(a || b) && c"))?;
    /// let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
    /// let Node::Infix(_, either, _) = *ast.node(root) else { panic!() };
    /// assert_eq!(ast.within(ast.node(root), either, true), "(a || b)");
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn within(&self, parent: &Node, id: NodeId, left: bool) -> String {
        let text = self.display(id);
        if wants_brackets(parent, self, id, left) { format!("({text})") } else { text.to_string() }
    }

    /// An operand of `parent`, in brackets if it needs them.
    fn operand(&self, parent: &Node, id: NodeId, left: bool) -> [Piece; 3] {
        if wants_brackets(parent, self, id, left) {
            [Piece::Text("("), Piece::Node(id), Piece::Text(")")]
        } else {
            [Piece::Text(""), Piece::Node(id), Piece::Text("")]
        }
    }

    /// The base of a field, an index or a call, in brackets if it needs them.
    fn base(&self, id: NodeId) -> [Piece; 3] {
        let apart = matches!(
            self.node(id),
            Node::Number(_) | Node::Prefix(..) | Node::Infix(..) | Node::Quantified(_)
        );
        let [open, close] = if apart { ["(", ")"] } else { ["", ""] };
        [Piece::Text(open), Piece::Node(id), Piece::Text(close)]
    }

    /// The pieces of one expression, in order.
    fn pieces(&self, id: NodeId) -> Vec<Piece> {
        let node = self.node(id);
        let operand = |id, left| self.operand(node, id, left);
        let mut pieces = Vec::new();
        match *node {
            Node::Prefix(op, a) => {
                let blank = if op.is_word() { " " } else { "" };
                pieces.extend([Piece::Text(op.symbol()), Piece::Bound(id), Piece::Text(blank)]);
                pieces.extend(operand(a, false));
            }
            Node::Infix(op, a, b) => {
                pieces.extend(operand(a, true));
                pieces.extend([Piece::Text(" "), Piece::Text(op.symbol())]);
                pieces.extend([Piece::Bound(id), Piece::Text(" ")]);
                pieces.extend(operand(b, false));
            }
            Node::Index { base, index } => {
                pieces.extend(self.base(base));
                pieces.extend([Piece::Text("["), Piece::Node(index), Piece::Text("]")]);
            }
            Node::Call { callee, ref arguments } => {
                pieces.extend(self.base(callee));
                pieces.push(Piece::Text("("));
                for (i, argument) in self.arguments(arguments).iter().enumerate() {
                    pieces.push(Piece::Text(if i == 0 { "" } else { ", " }));
                    pieces.push(Piece::Node(*argument));
                }
                pieces.push(Piece::Text(")"));
            }
            _ => {}
        }
        pieces
    }

    /// Writes the text of an expression without operands.
    fn leaf(&self, id: NodeId, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.node(id) {
            Node::Truth(value) => write!(f, "{value}"),
            Node::Number(_) => f.write_str(self.text(id)),
            Node::Name => f.write_str(&compact(self.text(id))),
            Node::Text | Node::Verbatim => f.write_str(self.text(id)),
            _ => Ok(()),
        }
    }
}

impl fmt::Display for Printed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut open = vec![Step::Piece(Piece::Node(self.root))];
        while let Some(step) = open.pop() {
            match step {
                Step::Piece(Piece::Text(text)) => f.write_str(text)?,
                Step::Piece(Piece::Bound(id)) => {
                    if let Some(bound) = &self.ast.entry(id).bound {
                        f.write_str(&compact(self.ast.source().slice(bound.span)))?;
                    }
                }
                Step::Field(id) => {
                    if let Node::Field { field, .. } = self.ast.node(id) {
                        write!(f, ".{}", self.ast.source().slice(*field))?;
                    }
                }
                Step::Piece(Piece::Node(id)) => match *self.ast.node(id) {
                    Node::Field { base, .. } => {
                        open.push(Step::Field(id));
                        open.extend(self.ast.base(base).into_iter().rev().map(Step::Piece));
                    }
                    Node::Quantified(Quantifier { all, name, set, body, .. }) => {
                        let slice = |span| self.ast.source().slice(span);
                        let word = if all { "all" } else { "some" };
                        write!(f, "for {word} {} in {}: ", slice(name), slice(set))?;
                        open.push(Step::Piece(Piece::Node(body)));
                    }
                    _ => {
                        self.ast.leaf(id, f)?;
                        open.extend(self.ast.pieces(id).into_iter().rev().map(Step::Piece));
                    }
                },
            }
        }
        Ok(())
    }
}

/// A step of printing.
enum Step {
    Piece(Piece),
    /// The name of a field, after its base.
    Field(NodeId),
}

/// How tightly an expression binds; the same levels as in the parser.
fn level(node: &Node) -> u8 {
    match node {
        Node::Quantified(_) => 0,
        Node::Infix(Infix::Ensuring, ..) => 1,
        Node::Infix(Infix::Implies | Infix::Iff, ..) => 2,
        Node::Infix(Infix::Or, ..) => 3,
        Node::Infix(Infix::And, ..) => 4,
        Node::Prefix(Prefix::Minus, _) => 10,
        Node::Prefix(..) => 6,
        Node::Infix(Infix::Compare(_), ..) => 7,
        Node::Infix(Infix::Calculate(Arithmetic::Add | Arithmetic::Subtract), ..) => 8,
        Node::Infix(Infix::Calculate(_), ..) => 9,
        Node::Infix(..) => UNTIL,
        _ => 11,
    }
}

/// The level of `U`, `T` and their like.
const UNTIL: u8 = 5;

/// Whether the operand `id` of `parent` is printed in brackets: where the parser needs them, and
/// where a reader would otherwise have to know the precedence of temporal operators.
fn wants_brackets(parent: &Node, ast: &Ast, id: NodeId, left: bool) -> bool {
    let child = ast.node(id);
    let (outer, inner) = (level(parent), level(child));
    match (parent, child) {
        // A chain of comparisons; an author's brackets keep two comparisons apart.
        (Node::Infix(Infix::Compare(_), ..), Node::Infix(Infix::Compare(_), ..)) => {
            !left || ast.entry(id).is_bracketed()
        }
        (Node::Infix(one, ..), Node::Infix(two, ..))
            if outer == inner && (outer <= 2 || outer == UNTIL) =>
        {
            left || one != two || matches!(one, Infix::Ensuring | Infix::Iff)
        }
        (Node::Infix(..), Node::Prefix(Prefix::Eventually | Prefix::Next | Prefix::Always, _))
            if outer == UNTIL =>
        {
            left
        }
        (Node::Infix(..), Node::Infix(Infix::Compare(_), ..)) if outer == UNTIL => true,
        (Node::Prefix(Prefix::Always, _), Node::Infix(..)) => true,
        (Node::Prefix(Prefix::Always, _), _) if is_after_name(ast, id) => true,
        (Node::Prefix(op, _), Node::Infix(..)) => *op != Prefix::Minus || inner < 10,
        (_, Node::Quantified(_)) => true,
        (Node::Prefix(..), _) => inner < outer,
        (Node::Infix(Infix::Implies, ..), _) => inner < outer,
        _ => inner < outer || inner == outer && !left,
    }
}

/// Whether an expression reads on from a name before it, so that `G` would be one: `G R a` is `R`
/// between two names, and `G - x` a difference.
fn is_after_name(ast: &Ast, mut id: NodeId) -> bool {
    while let Node::Field { base, .. }
    | Node::Index { base, .. }
    | Node::Call { callee: base, .. } = ast.node(id)
    {
        id = *base;
    }
    let text = ast.text(id);
    match ast.node(id) {
        Node::Prefix(Prefix::Minus, _) => true,
        Node::Number(_) => text.starts_with('.'),
        Node::Name => matches!(text, "R" | "W" | "M" | "V" | "S" | "in" | "ensuring"),
        _ => false,
    }
}

impl Prefix {
    /// Its symbol.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Not => "!",
            Self::Eventually => "F",
            Self::Next => "X",
            Self::Always => "G",
            Self::Minus => "-",
        }
    }

    /// Whether its symbol is a word, after which a blank stands.
    const fn is_word(self) -> bool {
        !matches!(self, Self::Not | Self::Minus)
    }
}

impl Infix {
    /// Its symbol.
    #[must_use]
    pub const fn symbol(self) -> &'static str {
        match self {
            Self::Ensuring => "ensuring",
            Self::Implies => "=>",
            Self::Iff => "<=>",
            Self::Or => "||",
            Self::And => "&&",
            Self::Until => "U",
            Self::Then => "T",
            Self::Release => "R",
            Self::WeakUntil => "W",
            Self::StrongRelease => "M",
            Self::Compare(op) => op.symbol(),
            Self::Calculate(op) => op.symbol(),
        }
    }
}
