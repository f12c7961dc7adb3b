//! Labels: Boolean expressions over propositions by number, and aliases. They become decision
//! diagrams while they are read.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! let text = "HOA: v1 Start: 0 AP: 2 \"a\" \"b\" Acceptance: 1 Inf(0) Alias: @both 0 & 1 --BODY--
//!     State: 0 [@both] 1 [!@both] 0 State: 1 {0} [t] 1 --END--";
//! let automaton = hoa::read(&Source::new("both.hoa", text)).unwrap();
//! assert_eq!(automaton.dfa.edges()[1].guard, [[(0, true), (1, true)]]);
//! ```

use super::token::{Token, Tokens};
use super::{MOST_NODES, refused, syntax};
use crate::bdd::{Bdd, Diagram};
use crate::error::Error;
use crate::intern::Map;
use crate::source::Span;

/// The diagram of all labels, and the aliases.
#[derive(Default)]
pub(super) struct Labels {
    /// The diagram, which becomes that of the automaton.
    pub(super) diagram: Diagram,
    /// The function of each alias.
    aliases: Map<String, Bdd>,
    /// The highest proposition that a label names, and its place.
    pub(super) highest: Option<(u32, Span)>,
}

/// An operator or a bracket that waits for its operand.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Pending {
    /// A bracket, by its place.
    Open(Span),
    /// A disjunction, by its left operand.
    Or(Bdd),
    /// A conjunction, by its left operand.
    And(Bdd),
    /// A negation.
    Not,
}

impl Labels {
    /// Gives a function a name. Returns whether the name is new.
    pub(super) fn name(&mut self, name: &str, guard: Bdd) -> bool {
        let is_new = self.aliases.get(name).is_none();
        self.aliases.get_or_insert(name.to_owned(), guard);
        is_new
    }

    /// Reads `[label]`.
    pub(super) fn bracketed(&mut self, tokens: &mut Tokens, count: usize) -> Result<Bdd, Error> {
        tokens.expect('[')?;
        let guard = self.expression(tokens, count)?;
        tokens.expect(']')?;
        Ok(guard)
    }

    /// Reads an expression over `count` propositions: `!`, `&`, `|`, brackets. Operator precedence
    /// with a stack of its own, so brackets may nest to any depth.
    pub(super) fn expression(&mut self, tokens: &mut Tokens, count: usize) -> Result<Bdd, Error> {
        let mut pending = Vec::new();
        loop {
            while matches!(tokens.peek(), Token::Symbol('!' | '(')) {
                let span = tokens.span();
                let not = tokens.next()? == Token::Symbol('!');
                pending.push(if not { Pending::Not } else { Pending::Open(span) });
            }
            let mut value = self.operand(tokens, count)?;
            loop {
                let loosest = *tokens.peek() != Token::Symbol('&');
                let span = tokens.span();
                value = self.reduce(&mut pending, value, loosest, span)?;
                match (tokens.peek(), pending.last()) {
                    (Token::Symbol(')'), Some(Pending::Open(_))) => {
                        pending.pop();
                        tokens.next()?;
                    }
                    (Token::Symbol('&'), _) => {
                        pending.push(Pending::And(value));
                        break;
                    }
                    (Token::Symbol('|'), _) => {
                        pending.push(Pending::Or(value));
                        break;
                    }
                    (_, Some(Pending::Open(open))) => {
                        return Err(syntax("this bracket is not closed", *open));
                    }
                    _ => return Ok(value),
                }
            }
            tokens.next()?;
        }
    }

    /// Applies the waiting operators that bind tighter than the next token.
    fn reduce(
        &mut self,
        pending: &mut Vec<Pending>,
        mut value: Bdd,
        loosest: bool,
        span: Span,
    ) -> Result<Bdd, Error> {
        while let Some(&last) = pending.last() {
            value = match last {
                Pending::Not => self.diagram.not(value),
                Pending::And(left) => self.diagram.and(left, value),
                Pending::Or(left) if loosest => self.diagram.or(left, value),
                _ => break,
            };
            pending.pop();
            if self.diagram.nodes().len() > MOST_NODES {
                return Err(refused("the labels are too complex", span));
            }
        }
        Ok(value)
    }

    /// Reads a proposition, a constant or an alias.
    fn operand(&mut self, tokens: &mut Tokens, count: usize) -> Result<Bdd, Error> {
        let span = tokens.span();
        let guard = match tokens.peek() {
            Token::Word("t") => Bdd::TRUE,
            Token::Word("f") => Bdd::FALSE,
            Token::Number(number) if (*number as usize) < count => {
                self.highest = self.highest.max(Some((*number, span)));
                self.diagram.variable(*number)
            }
            Token::Number(number) => {
                return Err(no_proposition(*number, count, span));
            }
            Token::Alias(name) => match self.aliases.get(*name) {
                Some(&guard) => guard,
                None => return Err(syntax(format!("the alias `@{name}` is not defined"), span)),
            },
            _ => return Err(tokens.unexpected("a proposition's number, `t`, `f` or an alias")),
        };
        tokens.next()?;
        Ok(guard)
    }
}

/// The error for a label that names a proposition outside `AP:`.
pub(super) fn no_proposition(number: u32, count: usize, span: Span) -> Error {
    syntax(format!("there is no proposition {number}: `AP:` has {count}"), span)
}
