//! Conditions and terms as text: the names of predicates that have none.

use std::fmt;

use super::{Arena, Condition, ConditionId, Number, PredicateId, Term, TermId};
use crate::ast::{Arithmetic, Prefix};

/// A condition that can be printed.
pub struct Printed<'a> {
    arena: &'a Arena,
    root: ConditionId,
}

/// What is still to be printed; the number is how tightly the surroundings bind.
enum Piece {
    Condition(ConditionId, u8),
    Term(TermId, u8),
    Predicate(PredicateId),
    Text(&'static str),
}

impl Arena {
    /// The condition `root` as text. Other predicates are `#` and a number: they have names in the
    /// module only.
    #[must_use]
    pub fn display(&self, root: ConditionId) -> Printed<'_> {
        Printed { arena: self, root }
    }
}

impl fmt::Display for Printed<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut open = vec![Piece::Condition(self.root, 0)];
        while let Some(piece) = open.pop() {
            let pieces = match piece {
                Piece::Text(text) => {
                    f.write_str(text)?;
                    continue;
                }
                Piece::Predicate(id) => {
                    write!(f, "#{}", id.0)?;
                    continue;
                }
                Piece::Condition(id, outer) => {
                    let condition = self.arena.condition(id);
                    let (level, pieces) = condition_pieces(condition, f)?;
                    bracketed(level < outer, pieces)
                }
                Piece::Term(id, outer) => {
                    let term = self.arena.term(id);
                    // A bracket goes before what a leaf writes at once; leaves bind most tightly.
                    let (level, pieces) = term_pieces(term, f)?;
                    bracketed(level < outer, pieces)
                }
            };
            open.extend(pieces.into_iter().rev());
        }
        Ok(())
    }
}

fn bracketed(brackets: bool, mut pieces: Vec<Piece>) -> Vec<Piece> {
    if brackets {
        pieces.insert(0, Piece::Text("("));
        pieces.push(Piece::Text(")"));
    }
    pieces
}

fn condition_pieces(
    condition: &Condition,
    f: &mut fmt::Formatter<'_>,
) -> Result<(u8, Vec<Piece>), fmt::Error> {
    use Piece::{Predicate, Text};
    let between = |a, symbol, b, level| {
        let space = || Text(" ");
        vec![Piece::Condition(a, level), space(), Text(symbol), space(), Piece::Condition(b, level)]
    };
    Ok(match condition {
        Condition::Truth(value) => (9, vec![Text(if *value { "true" } else { "false" })]),
        Condition::Not(a) => (5, vec![Text("!"), Piece::Condition(*a, 9)]),
        Condition::And(a, b) => (3, between(*a, "&&", *b, 3)),
        Condition::Or(a, b) => (2, between(*a, "||", *b, 2)),
        Condition::Compare(op, a, b) => {
            let space = || Text(" ");
            (6, vec![Piece::Term(*a, 7), space(), Text(op.symbol()), space(), Piece::Term(*b, 7)])
        }
        Condition::Bool(term) => (9, vec![Piece::Term(*term, 9)]),
        Condition::Is(predicate) => (9, vec![Predicate(*predicate)]),
        Condition::Value { text, .. } | Condition::Free(text) => {
            f.write_str(text)?;
            (9, Vec::new())
        }
    })
}

fn term_pieces(term: &Term, f: &mut fmt::Formatter<'_>) -> Result<(u8, Vec<Piece>), fmt::Error> {
    use Piece::{Term as Inner, Text};
    Ok(match term {
        Term::Number(Number(value)) => {
            write!(f, "{value}")?;
            (12, Vec::new())
        }
        Term::Variable(text) | Term::Host { text, .. } => {
            f.write_str(text)?;
            (12, Vec::new())
        }
        Term::Place { steps, .. } => {
            let text: String = steps.iter().map(ToString::to_string).collect();
            f.write_str(text.strip_prefix('.').unwrap_or(&text))?;
            (12, Vec::new())
        }
        Term::Negate(a) => (9, vec![Text(Prefix::Minus.symbol()), Inner(*a, 10)]),
        Term::Calculate(op, a, b) => {
            let level = if matches!(op, Arithmetic::Add | Arithmetic::Subtract) { 7 } else { 8 };
            let symbol = Text(op.symbol());
            (level, vec![Inner(*a, level), Text(" "), symbol, Text(" "), Inner(*b, level + 1)])
        }
        Term::Call(function, a, b) => {
            let mut pieces = vec![Text(function.name()), Text("("), Inner(*a, 0)];
            pieces.extend(b.iter().flat_map(|b| [Text(", "), Inner(*b, 0)]));
            pieces.push(Text(")"));
            (12, pieces)
        }
    })
}
