//! Conditions and terms as text. This is the name of a predicate that the author did not name, so
//! equal conditions must print alike and different ones differently.
//!
//! Brackets are as few as Rust's precedence allows; numbers are printed so that they read as the
//! same number.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "F (2*(x+1) < min(y, 3) )"))?;
//! assert_eq!(module.tasks[0].spec.propositions(), ["2 * (x + 1) < min(y, 3)"]);
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::fmt;

use super::{Arena, Binding, Condition, ConditionId, Module, Number, Predicate, PredicateId};
use super::{Step, Term, TermId};
use crate::ast::{Arithmetic, Prefix};

/// A condition or a term that can be printed.
pub struct Printed<'a> {
    arena: &'a Arena,
    predicates: &'a [Predicate],
    root: Piece,
}

/// A piece of the text that is still to be printed. The number is how tightly its surroundings
/// bind: a looser piece gets brackets.
#[derive(Clone)]
enum Piece {
    Condition(ConditionId, u8),
    Term(TermId, u8),
    Text(&'static str),
    Word(String),
}

impl Module {
    /// The condition `root` as text.
    #[must_use]
    pub fn display(&self, root: ConditionId) -> Printed<'_> {
        self.arena.display_condition(root, &self.predicates)
    }

    /// The term `root` as text.
    #[must_use]
    pub fn display_term(&self, root: TermId) -> Printed<'_> {
        self.arena.display(root)
    }
}

impl Arena {
    /// The term `root` as text.
    #[must_use]
    pub fn display(&self, root: TermId) -> Printed<'_> {
        Printed { arena: self, predicates: &[], root: Piece::Term(root, 0) }
    }

    /// The condition `root` as text; `predicates` gives the names of other predicates in it.
    #[must_use]
    pub fn display_condition<'a>(
        &'a self,
        root: ConditionId,
        predicates: &'a [Predicate],
    ) -> Printed<'a> {
        Printed { arena: self, predicates, root: Piece::Condition(root, 0) }
    }
}

impl fmt::Display for Printed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut open = vec![self.root.clone()];
        while let Some(piece) = open.pop() {
            let (level, outer, pieces) = match piece {
                Piece::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Piece::Word(text) => {
                    f.write_str(&text)?;
                    continue;
                }
                Piece::Condition(id, outer) => {
                    let (level, pieces) = self.condition(self.arena.condition(id));
                    (level, outer, pieces)
                }
                Piece::Term(id, outer) => {
                    let (level, pieces) = self.term(self.arena.term(id));
                    (level, outer, pieces)
                }
            };
            open.extend(bracketed(level < outer, pieces).into_iter().rev());
        }
        Ok(())
    }
}

/// The pieces, in brackets or not.
fn bracketed(brackets: bool, mut pieces: Vec<Piece>) -> Vec<Piece> {
    if brackets {
        pieces.insert(0, Piece::Text("("));
        pieces.push(Piece::Text(")"));
    }
    pieces
}

impl Printed<'_> {
    /// How tightly a condition binds, and its pieces.
    fn condition(&self, condition: &Condition) -> (u8, Vec<Piece>) {
        use Piece::{Text, Word};
        let between = |a, symbol, b, level| {
            let (a, b) = (Piece::Condition(a, level), Piece::Condition(b, level));
            vec![a, Text(" "), Text(symbol), Text(" "), b]
        };
        match condition {
            Condition::Truth(value) => (9, vec![Text(if *value { "true" } else { "false" })]),
            Condition::Not(a) => (5, vec![Text("!"), Piece::Condition(*a, 9)]),
            Condition::And(a, b) => (3, between(*a, "&&", *b, 3)),
            Condition::Or(a, b) => (2, between(*a, "||", *b, 2)),
            Condition::Compare(op, a, b) => {
                let (a, b) = (Piece::Term(*a, 7), Piece::Term(*b, 7));
                (6, vec![a, Text(" "), Text(op.symbol()), Text(" "), b])
            }
            Condition::Bool(term) => (9, vec![Piece::Term(*term, 9)]),
            Condition::Is(predicate) => (9, vec![self.name(*predicate)]),
            Condition::Apply { predicate, arguments, .. } => {
                let mut pieces = vec![self.name(*predicate)];
                for (i, argument) in arguments.iter().enumerate() {
                    pieces.push(Text(if i == 0 { "(" } else { ", " }));
                    pieces.push(Piece::Term(*argument, 0));
                }
                pieces.push(Text(")"));
                (9, pieces)
            }
            Condition::Value { text, bindings, .. } => (9, vec![self.host(text, bindings)]),
            Condition::Free(text) => (9, vec![Word(text.clone())]),
        }
    }

    /// The name of another predicate.
    fn name(&self, predicate: PredicateId) -> Piece {
        Piece::Word(self.predicates[predicate.0 as usize].name.clone())
    }

    /// How tightly a term binds, and its pieces.
    fn term(&self, term: &Term) -> (u8, Vec<Piece>) {
        use Piece::{Term as Inner, Text, Word};
        match term {
            Term::Number(Number(value)) => (12, vec![Word(number(*value))]),
            Term::Variable(name) | Term::Variant { name, .. } | Term::Parameter { name, .. } => {
                (12, vec![Word(name.clone())])
            }
            Term::Absent => (12, vec![Text("none")]),
            Term::Truth(value) => (12, vec![Text(if *value { "true" } else { "false" })]),
            Term::Host { text, bindings, .. } => (12, vec![self.host(text, bindings)]),
            Term::Place { steps, .. } => (12, place(steps)),
            Term::Negate(a) => (9, vec![Text(Prefix::Minus.symbol()), Inner(*a, 10)]),
            Term::Calculate(op, a, b) => {
                let level =
                    if matches!(op, Arithmetic::Add | Arithmetic::Subtract) { 7 } else { 8 };
                let symbol = Text(op.symbol());
                (level, vec![Inner(*a, level), Text(" "), symbol, Text(" "), Inner(*b, level + 1)])
            }
            Term::Call(function, a, b) => {
                let mut pieces = vec![Text(function.name()), Text("("), Inner(*a, 0)];
                pieces.extend(b.iter().flat_map(|b| [Text(", "), Inner(*b, 0)]));
                pieces.push(Text(")"));
                (12, pieces)
            }
        }
    }

    /// A Rust expression with its parameters replaced by what they stand for.
    fn host(&self, text: &str, bindings: &[Binding]) -> Piece {
        let print = |root| {
            let root = Piece::Term(root, 0);
            Printed { arena: self.arena, predicates: self.predicates, root }.to_string()
        };
        let words: Vec<_> =
            bindings.iter().map(|one| (one.name.as_str(), print(one.term))).collect();
        Piece::Word(crate::token::renamed(text, &words))
    }
}

/// A number in the shorter of its two forms; both read as the same number. 17 digits identify a
/// double.
fn number(value: f64) -> String {
    let plain = value.to_string();
    let short = format!("{value:e}");
    if plain.len() > 17 && short.len() < plain.len() { short } else { plain }
}

/// The path of a place.
fn place(steps: &[Step]) -> Vec<Piece> {
    let mut pieces = Vec::new();
    for (i, step) in steps.iter().enumerate() {
        match step {
            Step::Field(name) if i == 0 => pieces.push(Piece::Word(name.clone())),
            Step::Field(name) => pieces.push(Piece::Word(format!(".{name}"))),
            Step::Index(index) => pieces.push(Piece::Word(format!("[{index}]"))),
            Step::Element(index) | Step::At { index, .. } => {
                pieces.extend([Piece::Text("["), Piece::Term(*index, 0), Piece::Text("]")]);
            }
        }
    }
    pieces
}
