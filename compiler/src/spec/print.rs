//! Formulas as text, with the brackets that a reader wants: `U` and `T` are never mixed without
//! them, and a comparison is bracketed wherever an operator binds it.
//!
//! The text parses to a formula with the same meaning. It is written with a stack of pieces rather
//! than by recursion, so any depth prints. Shared operators are written out wherever they are used,
//! which can be exponentially long: [`Spec::text`] bounds it.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! // What is meant, and not what was written.
//! let module = check::formula(&Source::new("formula", "!(a => b) U c"))?;
//! assert_eq!(module.tasks[0].spec.to_string(), "(a && !b) U c");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::borrow::Cow;
use std::fmt;

use super::{Formula, FormulaId, Spec};
use crate::proposition::Shape;

/// A formula of a [`Spec`] that can be printed.
pub struct Printed<'a> {
    spec: &'a Spec,
    root: FormulaId,
}

/// A piece of the text that is still to be printed.
enum Piece {
    Formula(FormulaId),
    Text(Cow<'static, str>),
}

/// How tightly an operator binds, loosest first.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Level {
    Or,
    And,
    Until,
    Then,
    Prefix,
    Comparison,
    Name,
}

impl Spec {
    /// The formula `root` as text. Parsing the text gives a formula with the same meaning.
    #[must_use]
    pub fn display(&self, root: FormulaId) -> Printed<'_> {
        Printed { spec: self, root }
    }

    /// The formula `root` as text of about `most` bytes at most, then `…`.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["a".into(), "b".into()]);
    /// let at = Span::default();
    /// let mut all = spec.literal(0, false, at);
    /// for _ in 0..40 {
    ///     let (b, held) = (spec.literal(1, false, at), all);
    ///     let next = spec.next(held, at);
    ///     let until = spec.until(b, held, at);
    ///     all = spec.or(next, until, at);
    /// }
    /// // 2^40 leaves if it is written out.
    /// assert!(spec.text(all, 50).len() < 80);
    /// ```
    #[must_use]
    pub fn text(&self, root: FormulaId, most: usize) -> String {
        let mut short = Short { text: String::new(), most };
        if fmt::write(&mut short, format_args!("{}", self.display(root))).is_err() {
            short.text.push('…');
        }
        short.text
    }

    /// How tightly a formula binds.
    fn level(&self, id: FormulaId) -> Level {
        match self.formula(id) {
            Formula::True | Formula::False => Level::Name,
            Formula::Literal { negated: true, .. } => Level::Prefix,
            Formula::Literal { proposition, .. } if self.is_compound(proposition) => {
                Level::Comparison
            }
            Formula::Literal { .. } => Level::Name,
            Formula::And(..) => Level::And,
            Formula::Or(..) => Level::Or,
            Formula::Next(_) | Formula::Delay(..) | Formula::Eventually(_) => Level::Prefix,
            Formula::Within(..) | Formula::Throughout(..) => Level::Prefix,
            Formula::Until(..) | Formula::UntilWithin(..) => Level::Until,
            Formula::Then(..) => Level::Then,
        }
    }

    /// Whether the name of a proposition has operators.
    fn is_compound(&self, proposition: u32) -> bool {
        self.propositions()[proposition as usize].shape != Shape::Atom
    }

    /// ψ of a formula ◇ψ, which `T` implies; other formulas as they are.
    fn goal(&self, id: FormulaId) -> FormulaId {
        match self.formula(id) {
            Formula::Eventually(a) => a,
            _ => id,
        }
    }
}

/// A text that refuses more once it is long enough.
struct Short {
    text: String,
    most: usize,
}

impl fmt::Write for Short {
    fn write_str(&mut self, piece: &str) -> fmt::Result {
        if self.text.len() > self.most {
            return Err(fmt::Error);
        }
        self.text.push_str(piece);
        Ok(())
    }
}

impl fmt::Display for Spec {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.display(self.root()).fmt(f)
    }
}

impl fmt::Display for Printed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut open = vec![Piece::Formula(self.root)];
        while let Some(piece) = open.pop() {
            match piece {
                Piece::Text(text) => f.write_str(&text)?,
                Piece::Formula(id) => match self.spec.formula(id) {
                    Formula::True => f.write_str("true")?,
                    Formula::False => f.write_str("false")?,
                    Formula::Literal { proposition, negated } => {
                        self.literal(proposition, negated, f)?;
                    }
                    formula => open.extend(self.pieces(formula).into_iter().rev()),
                },
            }
        }
        Ok(())
    }
}

impl Printed<'_> {
    /// Writes a proposition or its negation.
    fn literal(&self, proposition: u32, negated: bool, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = &self.spec.propositions()[proposition as usize];
        match (negated, self.spec.is_compound(proposition)) {
            (true, true) => write!(f, "!({name})"),
            (true, false) => write!(f, "!{name}"),
            (false, _) => write!(f, "{name}"),
        }
    }

    /// The pieces of an operator and its operands, in order.
    fn pieces(&self, formula: Formula) -> Vec<Piece> {
        use Level::{And, Or};
        match formula {
            Formula::And(a, b) => self.between(a, " && ", b, And),
            Formula::Or(a, b) => self.between(a, " || ", b, Or),
            Formula::Until(a, b) => self.ordered(a, " U ".into(), b, Level::Until),
            Formula::UntilWithin(n, a, b) => {
                self.ordered(a, format!(" U[0,{n}] ").into(), b, Level::Until)
            }
            Formula::Then(a, b) => self.ordered(a, " T ".into(), self.spec.goal(b), Level::Then),
            Formula::Next(a) => self.later(1, a),
            Formula::Delay(n, a) => self.later(n, a),
            Formula::Eventually(a) => self.after("F ".into(), a),
            Formula::Within(n, a) => self.window('F', 0, n, a),
            Formula::Throughout(n, a) => self.window('G', 0, n, a),
            // A leaf is written at once and has no pieces.
            Formula::True | Formula::False | Formula::Literal { .. } => Vec::new(),
        }
    }

    /// `a && b` or `a || b`: operands with another operator between two operands of their own stand
    /// in brackets.
    fn between(&self, a: FormulaId, symbol: &'static str, b: FormulaId, own: Level) -> Vec<Piece> {
        let brackets = |id| {
            let level = self.spec.level(id);
            level < Level::Prefix && level != own
        };
        let mut pieces = self.operand(a, brackets(a));
        pieces.push(Piece::Text(symbol.into()));
        pieces.extend(self.operand(b, brackets(b)));
        pieces
    }

    /// `a U b` or `a T b`. Both group to the right, so a chain of one of the two needs no brackets
    /// on the right.
    fn ordered(
        &self,
        a: FormulaId,
        symbol: Cow<'static, str>,
        b: FormulaId,
        own: Level,
    ) -> Vec<Piece> {
        let loose = |level: Level| level < Level::Prefix || level == Level::Comparison;
        let mut pieces = self.operand(a, loose(self.spec.level(a)));
        pieces.push(Piece::Text(symbol));
        let level = self.spec.level(b);
        pieces.extend(self.operand(b, loose(level) && level != own));
        pieces
    }

    /// `X a` or `X[n] a`; before a window of `F` or `G`, its bounds say the delay.
    fn later(&self, n: u32, a: FormulaId) -> Vec<Piece> {
        match self.spec.formula(a) {
            Formula::Within(length, a) => self.window('F', n, length, a),
            Formula::Throughout(length, a) => self.window('G', n, length, a),
            _ if n == 1 => self.after("X ".into(), a),
            _ => self.after(format!("X[{n}] ").into(), a),
        }
    }

    /// `F[m,n] a` or `G[m,n] a`: a window that begins `first` steps from now.
    fn window(&self, letter: char, first: u32, length: u32, a: FormulaId) -> Vec<Piece> {
        let last = u64::from(first) + u64::from(length);
        self.after(format!("{letter}[{first},{last}] ").into(), a)
    }

    /// `F a` or `X a`.
    fn after(&self, symbol: Cow<'static, str>, a: FormulaId) -> Vec<Piece> {
        let level = self.spec.level(a);
        let mut pieces = vec![Piece::Text(symbol)];
        pieces.extend(self.operand(a, level < Level::Prefix || level == Level::Comparison));
        pieces
    }

    /// An operand, in brackets or not.
    fn operand(&self, id: FormulaId, brackets: bool) -> Vec<Piece> {
        match brackets {
            true => vec![Piece::Text("(".into()), Piece::Formula(id), Piece::Text(")".into())],
            false => vec![Piece::Formula(id)],
        }
    }
}
