//! The header of a HOA file: name, initial state, propositions, acceptance, aliases.
//!
//! By the format, a header that begins with a lower-case letter may be ignored, and one that begins
//! with a capital may change the meaning: unknown ones of the second kind are refused. `States:` is
//! read and not used, because the body says which states there are.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! // `Controllable:` could change the meaning, `tool:` cannot.
//! let text = "HOA: v1 tool: \"mine\" Controllable: 0 Start: 0 AP: 1 \"a\" Acceptance: 1 Inf(0)
//!     --BODY-- State: 0 {0} [t] 0 --END--";
//! let error = hoa::read(&Source::new("game.hoa", text)).unwrap_err();
//! assert_eq!(error.message(), "the header `Controllable:` is not known, and it may matter");
//! ```

use super::label::{Labels, no_proposition};
use super::token::{Token, Tokens};
use super::{MOST_PROPOSITIONS, refused, syntax};
use crate::ast::{Infix, ItemKind, Node, NodeId, Prefix};
use crate::error::Error;
use crate::parse;
use crate::proposition::{Proposition, Shape};
use crate::source::{Source, Span};

/// The acceptance condition, as a condition on the marks of a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Acceptance {
    /// Every state accepts: `t`.
    All,
    /// No state accepts: `f`.
    None,
    /// The states in the set accept: `Inf(0)`.
    In(u32),
    /// The states outside the set accept: `Fin(0)`.
    Outside(u32),
}

/// The parts of the header that matter.
pub(super) struct Header {
    /// The name, if there is one.
    pub(super) name: Option<String>,
    /// The initial state, by its number in the text, and the place where it is named.
    pub(super) start: (u32, Span),
    /// The names of the propositions, in the order of `AP:`.
    pub(super) propositions: Vec<Proposition>,
    /// The acceptance condition.
    pub(super) acceptance: Acceptance,
    /// Whether the properties promise that acceptance is decided at some instant.
    pub(super) is_terminal: bool,
    /// The aliases, and the diagram for all labels.
    pub(super) labels: Labels,
}

/// A header under construction. Some parts must come exactly once, and aliases may come before
/// `AP:`.
#[derive(Default)]
struct Draft {
    name: Option<String>,
    start: Option<(u32, Span)>,
    propositions: Option<Vec<Proposition>>,
    acceptance: Option<Acceptance>,
    is_terminal: bool,
    labels: Labels,
}

/// Reads the header, up to `--BODY--`.
pub(super) fn read(tokens: &mut Tokens) -> Result<Header, Error> {
    version(tokens)?;
    let mut draft = Draft::default();
    while *tokens.peek() != Token::Body {
        let span = tokens.span();
        match tokens.peek().clone() {
            Token::Header(name) => {
                tokens.next()?;
                draft.item(tokens, name, span)?;
            }
            _ => return Err(tokens.unexpected("a header such as `States:`, or `--BODY--`")),
        }
    }
    let body = tokens.span();
    tokens.next()?;
    draft.finish(body)
}

/// Reads `HOA: v1` or `HOA: v1.1`.
fn version(tokens: &mut Tokens) -> Result<(), Error> {
    if *tokens.peek() != Token::Header("HOA") {
        return Err(tokens.unexpected("`HOA: v1`"));
    }
    tokens.next()?;
    match tokens.peek() {
        Token::Word("v1" | "v1.1") => tokens.next().map(|_| ()),
        _ => Err(tokens.unexpected("version `v1` or `v1.1`")),
    }
}

impl Draft {
    /// Reads the rest of one header line.
    fn item<'a>(
        &mut self,
        tokens: &mut Tokens<'a>,
        name: &'a str,
        span: Span,
    ) -> Result<(), Error> {
        match name {
            "Start" => {
                if self.start.is_some() {
                    return Err(refused("the automaton has several initial states", span)
                        .help("make it deterministic first"));
                }
                self.start = Some(start(tokens)?);
                Ok(())
            }
            "AP" => {
                let propositions = propositions(tokens)?;
                once(&mut self.propositions, propositions, "AP", span)
            }
            "Acceptance" => {
                let acceptance = acceptance(tokens)?;
                once(&mut self.acceptance, acceptance, "Acceptance", span)
            }
            "Alias" => self.alias(tokens, span),
            "properties" => {
                self.is_terminal |= promises(tokens, "terminal")?;
                Ok(())
            }
            "States" => tokens.number("the number of states").map(|_| ()),
            "name" => {
                if let Token::Text(text) = tokens.peek() {
                    self.name = Some(text.clone());
                }
                skip(tokens)
            }
            _ if name.starts_with(|c: char| c.is_ascii_uppercase()) => {
                let message = format!("the header `{name}:` is not known, and it may matter");
                Err(refused(message, span))
            }
            _ => skip(tokens),
        }
    }

    /// Reads `@name label`. Before `AP:` the number of propositions is not known, so a label may
    /// then name any; [`finish`](Self::finish) checks it.
    fn alias(&mut self, tokens: &mut Tokens, span: Span) -> Result<(), Error> {
        let Token::Alias(name) = *tokens.peek() else {
            return Err(tokens.unexpected("a name that begins with `@`"));
        };
        tokens.next()?;
        let count = self.propositions.as_ref().map_or(MOST_PROPOSITIONS, Vec::len);
        let guard = self.labels.expression(tokens, count)?;
        match self.labels.name(name, guard) {
            false => Err(syntax(format!("the alias `@{name}` is defined twice"), span)),
            true => Ok(()),
        }
    }

    /// The header, once everything needed is there.
    fn finish(self, body: Span) -> Result<Header, Error> {
        let missing = |name: &str| syntax(format!("the header has no `{name}:`"), body);
        let propositions = self.propositions.unwrap_or_default();
        match self.labels.highest {
            Some((number, span)) if number as usize >= propositions.len() => {
                return Err(no_proposition(number, propositions.len(), span));
            }
            _ => {}
        }
        Ok(Header {
            name: self.name,
            start: self.start.ok_or_else(|| missing("Start"))?,
            propositions,
            acceptance: self.acceptance.ok_or_else(|| missing("Acceptance"))?,
            is_terminal: self.is_terminal,
            labels: self.labels,
        })
    }
}

/// Sets a part of the header that must not come twice.
fn once<T>(place: &mut Option<T>, value: T, name: &str, span: Span) -> Result<(), Error> {
    match place.replace(value) {
        Some(_) => Err(syntax(format!("the header `{name}:` comes twice"), span)),
        None => Ok(()),
    }
}

/// Skips the rest of a header line that does not matter.
fn skip(tokens: &mut Tokens) -> Result<(), Error> {
    while !matches!(tokens.peek(), Token::Header(_) | Token::Body | Token::End | Token::Nothing) {
        tokens.next()?;
    }
    Ok(())
}

/// Reads the properties of one line, and returns whether `property` is among them. Version 1.1 also
/// has negated ones.
fn promises(tokens: &mut Tokens, property: &str) -> Result<bool, Error> {
    let mut found = false;
    loop {
        let negated = tokens.eat('!')?;
        let Token::Word(word) = *tokens.peek() else { return skip(tokens).map(|()| found) };
        found |= word == property && !negated;
        tokens.next()?;
    }
}

/// Reads the initial state. A conjunction of several makes the automaton alternating.
fn start(tokens: &mut Tokens) -> Result<(u32, Span), Error> {
    let span = tokens.span();
    let state = tokens.number("the initial state")?;
    if *tokens.peek() == Token::Symbol('&') {
        return Err(refused("the automaton is alternating: it starts in several states", span)
            .help("make it deterministic first"));
    }
    Ok((state, span))
}

/// Reads the count and the names of the propositions.
fn propositions(tokens: &mut Tokens) -> Result<Vec<Proposition>, Error> {
    let span = tokens.span();
    let count = tokens.number("the number of propositions")? as usize;
    if count > MOST_PROPOSITIONS {
        let message = format!("{count} propositions are more than the {MOST_PROPOSITIONS} allowed");
        return Err(refused(message, span));
    }
    let mut names: Vec<Proposition> = Vec::new();
    while let Token::Text(name) = tokens.peek() {
        if names.iter().any(|known| known.name == *name) {
            return Err(syntax(format!("the proposition {name:?} comes twice"), tokens.span()));
        }
        names.push(Proposition { name: name.clone(), shape: shape(name) });
        tokens.next()?;
    }
    if names.len() == count {
        return Ok(names);
    }
    Err(syntax(format!("{count} propositions are announced, and {} follow", names.len()), span))
}

/// Reads the number of acceptance sets and the condition.
fn acceptance(tokens: &mut Tokens) -> Result<Acceptance, Error> {
    let mut span = tokens.span();
    tokens.number("the number of acceptance sets")?;
    let read = condition(tokens)?;
    let simple =
        matches!(tokens.peek(), Token::Header(_) | Token::Body | Token::End | Token::Nothing);
    match read {
        Some(acceptance) if simple => Ok(acceptance),
        _ => {
            span.end = tokens.span().start.max(span.end);
            Err(refused("this acceptance condition is not one of finite traces", span).help(
                "`Inf(0)` (Büchi) and `Fin(0)` (co-Büchi) with an absorbing accepting state are read",
            ))
        }
    }
}

/// Reads an acceptance condition; `None` if it is not one that is understood.
fn condition(tokens: &mut Tokens) -> Result<Option<Acceptance>, Error> {
    let inside = match tokens.peek() {
        Token::Word("t") => return tokens.next().map(|_| Some(Acceptance::All)),
        Token::Word("f") => return tokens.next().map(|_| Some(Acceptance::None)),
        Token::Word("Inf") => true,
        Token::Word("Fin") => false,
        Token::Symbol('(') => return Ok(None),
        _ => return Err(tokens.unexpected("an acceptance condition such as `Inf(0)`")),
    };
    tokens.next()?;
    tokens.expect('(')?;
    let negated = tokens.eat('!')?;
    let set = tokens.number("the number of an acceptance set")?;
    tokens.expect(')')?;
    // Inf(!0) asks for marks outside the set, Fin(!0) forbids them in the long run.
    Ok(Some(if inside != negated { Acceptance::In(set) } else { Acceptance::Outside(set) }))
}

/// The form of a name, which may be a formula of the language or anything else.
fn shape(name: &str) -> Shape {
    let Ok(ast) = parse::formula(&Source::new("proposition", name)) else { return Shape::Foreign };
    let Some(ItemKind::Task(_, root)) = ast.items().last().map(|item| &item.kind) else {
        return Shape::Foreign;
    };
    let is_temporal = |id: u32| match ast.node(NodeId(id)) {
        Node::Prefix(op, _) => !matches!(op, Prefix::Not | Prefix::Minus),
        Node::Infix(op, ..) => op.is_temporal(),
        Node::Quantified(_) => true,
        _ => false,
    };
    // Blanks, comments and attributes are no part of an expression.
    if ast.entry(*root).outer != Span::new(0, name.len()) || (0..=root.0).any(is_temporal) {
        return Shape::Foreign;
    }
    match ast.node(*root) {
        Node::Truth(_) | Node::Number(_) | Node::Text => Shape::Foreign,
        _ if ast.entry(*root).is_bracketed() => Shape::Atom,
        Node::Infix(Infix::Compare(_), ..) => Shape::Comparison,
        Node::Prefix(Prefix::Minus, _) | Node::Infix(Infix::Calculate(_), ..) => Shape::Foreign,
        Node::Prefix(..) | Node::Infix(..) => Shape::Compound,
        _ => Shape::Atom,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_other_tools_are_formulas_or_foreign() {
        for (shape_of, names) in [
            (Shape::Atom, &["a", "f(x, y)[2]", "{ x < 1 }", "s.x", "m::n", "(a || b)"][..]),
            (Shape::Comparison, &["x < 3", "1 <= x + y < 2", "a == b", "x ≤ 3"]),
            (Shape::Compound, &["a || b", "!a", "a & b", "a -> b < 3"]),
            (
                Shape::Foreign,
                &["p 1", "F", "true", "a=1", "F a", "a && X b", "x + 1", " a", "a // b"],
            ),
        ] {
            for name in names {
                assert_eq!(shape(name), shape_of, "{name}");
            }
        }
    }
}
