//! Operator precedence: from the flat sequence of operands and operators that the grammar gives to
//! a tree in the arena.
//!
//! Dijkstra's shunting yard (1961) with two stacks, so that depth costs heap and never stack.
//! Brackets, calls and indices are entries of the operator stack. Time is linear in the number of
//! tokens. Operands are pushed before their operators, which is the order that the arena requires.
//!
//! ```
//! use tltl_compiler::{ast::ItemKind, parse, source::Source};
//!
//! let shown = |formula: &str| {
//!     let ast = parse::formula(&Source::new("formula", formula)).unwrap();
//!     let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!() };
//!     ast.display(root).to_string()
//! };
//! // `F` is tighter than `U`; `U` and `T` are one level and associate to the right.
//! assert_eq!(shown("F a U b T c"), "(F a) U (b T c)");
//! assert_eq!(shown("(((a))) && ((b U c))"), "a && b U c");
//! ```

use super::item::place;
use super::{bound, foreign};
use crate::ast::{
    Arithmetic, Ast, Bound, Comparison, End, Infix, Node, NodeId, Prefix, Quantifier,
};
use crate::error::{Error, Kind};
use crate::grammar::{Pair, Rule};
use crate::source::Span;

/// Builds the expression of `pair`, whose text starts at byte `at`, and returns its root; `None` if
/// it has no shape. A number that cannot be represented is a mistake, and counts as 1 so that
/// checking can go on.
pub(super) fn build(
    ast: &mut Ast,
    pair: Pair<'_>,
    at: usize,
    mistakes: &mut Vec<Error>,
) -> Option<NodeId> {
    let mut yard = Yard { ast, at, operands: Vec::new(), pending: Vec::new(), mistakes };
    let root = yard.expression(pair);
    root.map_err(|error| mistakes.push(error)).ok()
}

/// An operator that waits for its right operand, or a bracket that waits for its end.
enum Pending {
    /// An operator before its operand.
    Prefix(Prefix, Span, Option<Box<Bound>>),
    /// A quantifier, which waits for its body.
    Quantifier {
        all: bool,
        name: Span,
        set: Span,
        /// The listed elements, or the ends of a range, by their place among the arguments.
        elements: (u32, u32),
        range: Option<bool>,
        span: Span,
    },
    /// An operator that has its left operand.
    Infix(Infix, Span, Option<Box<Bound>>),
    /// An opening bracket.
    Open(Span),
    /// A call; its arguments are the operands from `first` on.
    Call { first: usize, span: Span },
    /// An opening bracket after an array.
    Index(Span),
}

/// The two stacks.
struct Yard<'a> {
    /// The tree that is built.
    ast: &'a mut Ast,
    /// The byte at which the parsed text starts.
    at: usize,
    /// The operands that no operator has taken yet.
    operands: Vec<NodeId>,
    /// The operators and brackets that wait.
    pending: Vec<Pending>,
    mistakes: &'a mut Vec<Error>,
}

impl Yard<'_> {
    /// Reads all tokens: an operand and an operator in turn.
    fn expression(&mut self, pair: Pair<'_>) -> Result<NodeId, Error> {
        let mut operand_next = true;
        for token in pair.into_inner() {
            operand_next = if operand_next { self.prefix(token) } else { self.infix(token) }?;
        }
        self.finish()
    }

    /// A number, or its mistake.
    fn number(&mut self, number: Result<f64, Error>) -> Node {
        Node::Number(number.unwrap_or_else(|error| {
            self.mistakes.push(error);
            1.0
        }))
    }

    /// Reads a token where an operand may start. Returns whether an operand is still due.
    fn prefix(&mut self, token: Pair<'_>) -> Result<bool, Error> {
        let span = place(&token, self.at);
        let operator = match token.as_rule() {
            Rule::not => Pending::Prefix(Prefix::Not, span, None),
            Rule::eventually => Pending::Prefix(Prefix::Eventually, span, None),
            Rule::next_op => Pending::Prefix(Prefix::Next, span, None),
            Rule::always => Pending::Prefix(Prefix::Always, span, None),
            Rule::minus => Pending::Prefix(Prefix::Minus, span, None),
            Rule::open => Pending::Open(span),
            Rule::quantifier => self.quantifier(token),
            Rule::bound => {
                self.bound(token, span);
                return Ok(true);
            }
            _ => {
                let node = self.primary(&token, span);
                self.push(node, span, span);
                return Ok(false);
            }
        };
        self.pending.push(operator);
        Ok(true)
    }

    /// Reads the bound of the operator before it.
    fn bound(&mut self, token: Pair<'_>, span: Span) {
        let mut bound = Bound { ends: Vec::new(), at_most: false, span };
        for part in token.into_inner() {
            match part.as_rule() {
                Rule::at_most => bound.at_most = true,
                _ => bound.ends.push(self.end(part)),
            }
        }
        if let Some(Pending::Prefix(_, operator, place) | Pending::Infix(_, operator, place)) =
            self.pending.last_mut()
        {
            *operator = operator.to(span);
            *place = Some(Box::new(bound));
        }
    }

    /// Reads an end of a bound.
    fn end(&mut self, token: Pair<'_>) -> End {
        let (span, at) = (place(&token, self.at), self.at);
        let (mut negative, mut node, mut unit) = (false, None, None);
        for part in token.into_inner() {
            match part.as_rule() {
                Rule::minus => negative = true,
                Rule::identifier if node.is_some() => unit = Some(place(&part, at)),
                _ => node = Some(self.element(&part, count)),
            }
        }
        End { node: node.expect("an end is a number or a name"), negative, unit, span }
    }

    /// Reads `for all name in set:`.
    fn quantifier(&mut self, token: Pair<'_>) -> Pending {
        let span = place(&token, self.at);
        let (mut all, mut name, mut set) = (false, span, span);
        let (mut listed, mut range) = (Vec::new(), None);
        for part in token.into_inner() {
            match part.as_rule() {
                Rule::word_all => all = true,
                Rule::identifier => name = place(&part, self.at),
                Rule::set => {
                    set = place(&part, self.at);
                    for part in part.into_inner().flat_map(with_ends) {
                        match part.as_rule() {
                            Rule::range => range = Some(false),
                            Rule::inclusive => range = Some(true),
                            Rule::element => listed.push(self.element(&part, number)),
                            Rule::end => listed.push(self.element(&part, count)),
                            _ => {}
                        }
                    }
                }
                _ => {}
            }
        }
        let elements = self.ast.push_arguments(&listed);
        let elements = (elements.start, elements.end);
        Pending::Quantifier { all, name, set, elements, range, span }
    }

    /// An element of a listed set, or an end of a range or of a bound. A number is read by `read`.
    fn element(
        &mut self,
        element: &Pair<'_>,
        read: fn(&str, Span) -> Result<f64, Error>,
    ) -> NodeId {
        let span = place(element, self.at);
        let node = match element.as_str().starts_with(|c: char| c.is_ascii_digit()) {
            true => self.number(read(element.as_str(), span)),
            false => Node::Name,
        };
        self.ast.push(node, span, span)
    }

    /// The node of a token that is an operand by itself.
    fn primary(&mut self, token: &Pair<'_>, span: Span) -> Node {
        match token.as_rule() {
            Rule::truth => Node::Truth(true),
            Rule::falsity => Node::Truth(false),
            Rule::number => self.number(number(token.as_str(), span)),
            Rule::verbatim => Node::Verbatim,
            Rule::text => Node::Text,
            _ => Node::Name,
        }
    }

    /// Reads a token after an operand. Returns whether another operand is due.
    fn infix(&mut self, token: Pair<'_>) -> Result<bool, Error> {
        let span = place(&token, self.at);
        match token.as_rule() {
            Rule::field => self.field(token, span),
            Rule::empty_call => {
                self.pending.push(Pending::Call { first: self.operands.len(), span });
                self.close(span)?;
            }
            Rule::close => self.close(span)?,
            Rule::call => {
                self.pending.push(Pending::Call { first: self.operands.len(), span });
                return Ok(true);
            }
            Rule::index => {
                self.pending.push(Pending::Index(span));
                return Ok(true);
            }
            Rule::comma => {
                self.comma(span)?;
                return Ok(true);
            }
            rule => {
                let operator = infix_of(rule, token.as_str());
                self.reduce_above(operator);
                self.unchained(operator, span)?;
                self.pending.push(Pending::Infix(operator, span, None));
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Refuses a second `<=>` or `ensuring` beside the operator that waits, and `=>` beside `<=>`:
    /// neither reading is the one that all authors mean.
    fn unchained(&self, incoming: Infix, span: Span) -> Result<(), Error> {
        let Some(Pending::Infix(op, place, _)) = self.pending.last() else { return Ok(()) };
        let brackets = match (*op, incoming) {
            (Infix::Ensuring, Infix::Ensuring) => {
                "for two conditions write `… ensuring p && q`, or put the first `ensuring` in brackets"
            }
            (Infix::Iff, Infix::Iff | Infix::Implies) | (Infix::Implies, Infix::Iff) => {
                "write brackets: `a <=> (b <=> c)`, `(a => b) <=> c`"
            }
            _ => return Ok(()),
        };
        let source = self.ast.source();
        let (one, two) = (source.slice(*place), source.slice(span));
        let message = format!("`{one}` and `{two}` do not follow each other without brackets");
        Err(Error::new(Kind::Syntax, message, span).related(*place, "the first").help(brackets))
    }

    /// Reads `.field` after its base.
    fn field(&mut self, token: Pair<'_>, span: Span) {
        let base = self.pop();
        let field = token.into_inner().next().map_or(span, |name| place(&name, self.at));
        let whole = self.outer(base).to(span);
        self.push(Node::Field { base, field }, whole, field);
    }

    /// Ends an argument of a call.
    fn comma(&mut self, span: Span) -> Result<(), Error> {
        self.reduce_all();
        if let Some(Pending::Call { .. }) = self.pending.last() {
            return Ok(());
        }
        let text = self.ast.source().text();
        Err(bound::elsewhere(text, self.at, span.start).unwrap_or_else(|| {
            Error::new(
                Kind::Syntax,
                "a comma stands only between the arguments of a function",
                span,
            )
            .help("to ask for both, write `&&`; for one of the two, `||`")
        }))
    }

    /// Ends the innermost bracket with the `)` or `]` at `span`.
    fn close(&mut self, span: Span) -> Result<(), Error> {
        self.reduce_all();
        let found = self.ast.source().slice(span).chars().last().unwrap_or(')');
        let Some(open) = self.pending.pop() else {
            let message = format!("`{found}` closes nothing");
            let opening = if found == ')' { '(' } else { '[' };
            return Err(Error::new(Kind::Syntax, message, span)
                .help(format!("remove it, or put the missing `{opening}` before")));
        };
        match (open, found) {
            (Pending::Open(start), ')') => self.bracketed(start.to(span)),
            (Pending::Call { first, span: start }, ')') => self.call(first, start, span)?,
            (Pending::Index(_), ']') => {
                let (index, base) = (self.pop(), self.pop());
                let whole = self.outer(base).to(span);
                self.push(Node::Index { base, index }, whole, whole);
            }
            (open, _) => {
                let (start, symbol, end) = bracket(open);
                let message = format!("`{symbol}` is closed by `{found}`");
                return Err(Error::new(Kind::Syntax, message, span)
                    .label(format!("expected `{end}`"))
                    .related(start, "opened here"));
            }
        }
        Ok(())
    }

    /// Notes brackets around the last operand: messages and the printer need them, the tree does
    /// not.
    fn bracketed(&mut self, brackets: Span) {
        if let Some(&operand) = self.operands.last() {
            self.ast.bracket(operand, brackets);
        }
    }

    /// Ends a call.
    fn call(&mut self, first: usize, start: Span, end: Span) -> Result<(), Error> {
        let arguments = self.operands.split_off(first);
        let callee = self.pop();
        let name = self.ast.span(callee);
        match self.ast.node(callee) {
            Node::Name if foreign::is_unsupported(self.ast.text(callee)) => {
                let text = self.ast.text(callee);
                return Err(foreign::unsupported(text, text, name));
            }
            Node::Name | Node::Field { .. } => {}
            _ => {
                let text = self.ast.text(callee);
                let message = format!("an operator is missing between `{text}` and `(`");
                return Err(Error::new(Kind::Syntax, message, start)
                    .help("only a name can be called like a function; to multiply, write `*`"));
            }
        }
        let arguments = self.ast.push_arguments(&arguments);
        self.push(Node::Call { callee, arguments }, self.outer(callee).to(end), name);
        Ok(())
    }

    /// Ends the expression: no bracket may be open.
    fn finish(&mut self) -> Result<NodeId, Error> {
        self.reduce_all();
        match self.pending.pop() {
            None => Ok(self.pop()),
            Some(open) => {
                let (start, symbol, end) = bracket(open);
                Err(Error::new(Kind::Syntax, format!("`{symbol}` is never closed"), start)
                    .label(format!("the matching `{end}` is missing")))
            }
        }
    }

    /// Applies the waiting operators that bind more tightly than `incoming` does.
    fn reduce_above(&mut self, incoming: Infix) {
        let limit = level(incoming);
        while let Some(top) = self.pending.last() {
            let tighter = match top {
                Pending::Prefix(Prefix::Minus, ..) => true,
                Pending::Prefix(..) => PREFIX > limit,
                Pending::Infix(op, ..) if groups_right(incoming) => level(*op) > limit,
                Pending::Infix(op, ..) => level(*op) >= limit,
                _ => false,
            };
            if !tighter {
                return;
            }
            self.reduce();
        }
    }

    /// Applies all waiting operators up to the innermost bracket.
    fn reduce_all(&mut self) {
        while matches!(
            self.pending.last(),
            Some(Pending::Prefix(..) | Pending::Infix(..) | Pending::Quantifier { .. })
        ) {
            self.reduce();
        }
    }

    /// Applies the innermost waiting operator to its operands.
    fn reduce(&mut self) {
        match self.pending.pop() {
            Some(Pending::Prefix(op, span, bound)) => {
                let operand = self.pop();
                let whole = span.to(self.outer(operand));
                let id = self.push(Node::Prefix(op, operand), whole, span);
                self.ast.bind(id, bound);
            }
            Some(Pending::Infix(op, span, bound)) => {
                let (right, left) = (self.pop(), self.pop());
                let whole = self.outer(left).to(self.outer(right));
                let id = self.push(Node::Infix(op, left, right), whole, span);
                self.ast.bind(id, bound);
            }
            Some(Pending::Quantifier { all, name, set, elements, range, span }) => {
                let body = self.pop();
                let whole = span.to(self.outer(body));
                let elements = elements.0..elements.1;
                let quantifier = Quantifier { all, name, set, elements, range, body };
                self.push(Node::Quantified(quantifier), whole, span);
            }
            _ => {}
        }
    }

    /// The span of an operand with the brackets around it.
    fn outer(&self, operand: NodeId) -> Span {
        self.ast.entry(operand).outer
    }

    /// Adds a node and makes it an operand.
    fn push(&mut self, node: Node, span: Span, operator: Span) -> NodeId {
        let id = self.ast.push(node, span, operator);
        self.operands.push(id);
        id
    }

    /// The last operand. The grammar ensures that there is one.
    fn pop(&mut self) -> NodeId {
        self.operands.pop().expect("an operand before every operator that needs one")
    }
}

/// The binding strength of the prefix operators; see [`level`]. A minus binds tighter than all.
const PREFIX: u8 = 5;

/// The binding strength of an operator: `ensuring` binds loosest, arithmetic tightest. These are
/// the levels of LTL tools (Spot) with Rust's for numbers.
fn level(operator: Infix) -> u8 {
    match operator {
        Infix::Ensuring => 0,
        Infix::Implies | Infix::Iff => 1,
        Infix::Or => 2,
        Infix::And => 3,
        Infix::Until | Infix::Then | Infix::Release | Infix::WeakUntil | Infix::StrongRelease => 4,
        Infix::Compare(_) => 6,
        Infix::Calculate(Arithmetic::Add | Arithmetic::Subtract) => 7,
        Infix::Calculate(Arithmetic::Multiply | Arithmetic::Divide) => 8,
    }
}

/// Whether an operator groups to the right, as all operators of temporal logic do.
fn groups_right(operator: Infix) -> bool {
    level(operator) <= 1 || level(operator) == level(Infix::Until)
}

/// The operator of a rule of the grammar, written as `text`.
fn infix_of(rule: Rule, text: &str) -> Infix {
    match rule {
        Rule::ensuring => Infix::Ensuring,
        Rule::implies => Infix::Implies,
        Rule::iff => Infix::Iff,
        Rule::or => Infix::Or,
        Rule::and => Infix::And,
        Rule::until => match text {
            "U" => Infix::Until,
            "T" => Infix::Then,
            "R" => Infix::Release,
            "W" => Infix::WeakUntil,
            _ => Infix::StrongRelease,
        },
        Rule::equal => Infix::Compare(Comparison::Equal),
        Rule::unequal => Infix::Compare(Comparison::Unequal),
        Rule::at_most => Infix::Compare(Comparison::AtMost),
        Rule::at_least => Infix::Compare(Comparison::AtLeast),
        Rule::less => Infix::Compare(Comparison::Less),
        Rule::greater => Infix::Compare(Comparison::Greater),
        Rule::plus => Infix::Calculate(Arithmetic::Add),
        Rule::times => Infix::Calculate(Arithmetic::Multiply),
        Rule::divide => Infix::Calculate(Arithmetic::Divide),
        // The last operator of the grammar: `-`.
        _ => Infix::Calculate(Arithmetic::Subtract),
    }
}

/// A bracket, its symbol, and the symbol that ends it.
fn bracket(open: Pending) -> (Span, char, char) {
    match open {
        Pending::Index(span) => (span, '[', ']'),
        Pending::Open(span) | Pending::Call { span, .. } => (span, '(', ')'),
        Pending::Prefix(_, span, _)
        | Pending::Infix(_, span, _)
        | Pending::Quantifier { span, .. } => (span, '(', ')'),
    }
}

/// A part of a set, followed by its ends if it is a range.
fn with_ends(part: Pair<'_>) -> Vec<Pair<'_>> {
    let ends = if part.as_rule() == Rule::range { Some(part.clone().into_inner()) } else { None };
    std::iter::once(part).chain(ends.into_iter().flatten()).collect()
}

/// The largest integer up to which a double represents every integer.
const EXACT: u64 = 1 << 53;

/// The value of a literal number. An integer that a double would round is refused: the author would
/// compare with another number than the one written.
fn number(text: &str, span: Span) -> Result<f64, Error> {
    let digits = text.replace('_', "");
    let suffix = digits.find(['f', 'i', 'u']).unwrap_or(digits.len());
    let value: f64 = digits[..suffix].parse().unwrap_or(f64::INFINITY);
    let whole = !digits.contains(['.', 'e', 'E']);
    if !value.is_finite() {
        let message =
            format!("`{}` is larger than any number that a computer calculates with", short(text));
        return Err(Error::new(Kind::Number, message, span).help("the largest is about 1.8e308"));
    }
    if whole && digits[..suffix].parse::<u64>().map_or(true, |value| value > EXACT) {
        let message = format!("`{}` is too large to be exact", short(text));
        return Err(Error::new(Kind::Number, message, span)
            .help("whole numbers are exact up to 2^53 = 9007199254740992; write it with an exponent if a rounded value will do"));
    }
    Ok(value)
}

/// The value of an end of a bound or of a range: a number that the compiler counts to.
fn count(text: &str, span: Span) -> Result<f64, Error> {
    number(text, span).map_err(|_| {
        let message = format!("`{}` is too large to be counted to", short(text));
        Error::new(Kind::Number, message, span).help(
            "an automaton has a state for each step that a bound counts, and a range is written out number by number",
        )
    })
}

/// A literal, cut to what a message can show.
fn short(text: &str) -> String {
    if text.len() <= 40 { text.to_owned() } else { format!("{}…", &text[..40]) }
}
