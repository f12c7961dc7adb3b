//! The body of a HOA file: states and their transitions.
//!
//! The transitions of a state start as "everything leads nowhere", and each edge is laid over them
//! where its label holds. An edge that meets another one is what makes an automaton
//! nondeterministic, and it is found in that very step.
//!
//! ```
//! use tltl_compiler::{hoa, source::Source};
//!
//! // Where both hold, both edges could be taken.
//! let text = "HOA: v1 Start: 0 AP: 2 \"a\" \"b\" Acceptance: 1 Inf(0) --BODY--
//!     State: 0 [0] 1 [1] 0 State: 1 {0} [t] 1 --END--";
//! let error = hoa::read(&Source::new("choice.hoa", text)).unwrap_err();
//! assert!(error.message().contains("deterministic"), "{error}");
//! ```

use super::header::Header;
use super::token::{Token, Tokens};
use super::{MOST_NODES, refused, syntax};
use crate::arena::Memo;
use crate::bdd::{Bdd, Diagram, Operation};
use crate::dfa::State;
use crate::error::Error;
use crate::source::Span;

/// The destination of an edge, with its marks.
#[derive(Clone, Debug)]
pub(super) struct Edge {
    /// The state that it enters.
    pub(super) to: State,
    /// The acceptance sets on the edge itself.
    pub(super) marks: Vec<u32>,
    /// The place of the edge in the text.
    pub(super) span: Span,
}

/// A state as the text describes it.
#[derive(Clone, Debug)]
pub(super) struct Described {
    /// Its number in the text, for messages.
    pub(super) number: u32,
    /// The acceptance sets of the state.
    pub(super) marks: Vec<u32>,
    /// Its edges, in the order of the text.
    pub(super) edges: Vec<Edge>,
    /// Its transition function; letters without a transition lead to [`Body::NOWHERE`].
    pub(super) transitions: Bdd,
    /// The place of its number in the text.
    pub(super) span: Span,
}

/// The states, in the order in which the text names them.
///
/// States are renumbered so, because a number in the text may be anything: nothing here is as large
/// as one of them.
#[derive(Default)]
pub(super) struct Body {
    /// The states; `None` for one that is named but not described yet.
    pub(super) states: Vec<Option<Described>>,
    /// The state of each number in the text.
    numbers: Memo<u32, State>,
    /// For each state its number in the text and the place where it is named first.
    named: Vec<(u32, Span)>,
}

impl Body {
    /// The destination of missing transitions: a number that no state has.
    pub(super) const NOWHERE: State = (1 << 31) - 1;

    /// The state with this number in the text, added if it is new.
    fn state(&mut self, number: u32, span: Span) -> State {
        let fresh = self.named.len() as State;
        let state = self.numbers.get_or_insert(number, fresh);
        if state == fresh {
            self.named.push((number, span));
            self.states.push(None);
        }
        state
    }
}

/// Reads the body, up to `--END--`. Every state that is named must be described.
pub(super) fn read(tokens: &mut Tokens, header: &mut Header) -> Result<Body, Error> {
    let mut body = Body::default();
    body.state(header.start.0, header.start.1);
    while let Token::Header("State") = tokens.peek() {
        state(tokens, header, &mut body)?;
    }
    if *tokens.peek() != Token::End {
        return Err(tokens.unexpected("`State:` or `--END--`"));
    }
    tokens.next()?;
    let undescribed = body.states.iter().position(Option::is_none);
    match undescribed.map(|state| body.named[state]) {
        Some((number, span)) => Err(syntax(format!("state {number} is not described"), span)),
        None => Ok(body),
    }
}

/// Reads one state with its edges.
fn state(tokens: &mut Tokens, header: &mut Header, body: &mut Body) -> Result<(), Error> {
    tokens.next()?;
    let count = header.propositions.len();
    let label = match tokens.peek() {
        Token::Symbol('[') => Some(header.labels.bracketed(tokens, count)?),
        _ => None,
    };
    let span = tokens.span();
    let number = tokens.number("the number of a state")?;
    if let Token::Text(_) = tokens.peek() {
        tokens.next()?;
    }
    let marks = marks(tokens)?;
    let here = body.state(number, span);
    if body.states[here as usize].is_some() {
        return Err(syntax(format!("state {number} is described twice"), span));
    }
    let described =
        Described { number, marks, edges: Vec::new(), transitions: Bdd::leaf(Body::NOWHERE), span };
    let described = edges(tokens, header, body, described, label)?;
    body.states[here as usize] = Some(described);
    Ok(())
}

/// Reads the edges of a state. A label stands on the state, or on every edge, or on none of them.
fn edges(
    tokens: &mut Tokens,
    header: &mut Header,
    body: &mut Body,
    mut state: Described,
    label: Option<Bdd>,
) -> Result<Described, Error> {
    let count = header.propositions.len();
    let mut implicit = Vec::new();
    while matches!(tokens.peek(), Token::Symbol('[') | Token::Number(_)) {
        let start = tokens.span();
        let own = match tokens.peek() {
            Token::Symbol('[') => Some(header.labels.bracketed(tokens, count)?),
            _ => None,
        };
        let edge = edge(tokens, body, start)?;
        match (label, own) {
            (Some(_), Some(_)) => {
                return Err(syntax("the state has a label, so its edges cannot have one", start));
            }
            (None, None) => implicit.push(edge.to),
            (Some(guard), _) | (_, Some(guard)) => {
                let laid = lay(&mut header.labels.diagram, state.transitions, guard, edge.to);
                state.transitions = laid.ok_or_else(|| nondeterministic(&state, start))?;
            }
        }
        state.edges.push(edge);
        if header.labels.diagram.nodes().len() > MOST_NODES {
            return Err(refused("the transitions are too complex", start));
        }
    }
    if !implicit.is_empty() {
        state.transitions = table(&mut header.labels.diagram, &state, &implicit, count)?;
    }
    Ok(state)
}

/// Reads the destination and the marks of an edge.
fn edge(tokens: &mut Tokens, body: &mut Body, start: Span) -> Result<Edge, Error> {
    let at = tokens.span();
    let number = tokens.number("the state to go to")?;
    if *tokens.peek() == Token::Symbol('&') {
        return Err(refused("the automaton is alternating: an edge leads to several states", at)
            .help("make it deterministic first"));
    }
    let to = body.state(number, at);
    let marks = marks(tokens)?;
    Ok(Edge { to, marks, span: start.to(at) })
}

/// Reads `{0 1}` if it comes next.
fn marks(tokens: &mut Tokens) -> Result<Vec<u32>, Error> {
    let mut marks = Vec::new();
    if tokens.eat('{')? {
        while *tokens.peek() != Token::Symbol('}') {
            marks.push(tokens.number("the number of an acceptance set, or `}`")?);
        }
        tokens.next()?;
    }
    Ok(marks)
}

/// The error for an edge that meets another one.
fn nondeterministic(state: &Described, span: Span) -> Error {
    let message = format!(
        "the automaton is not deterministic: state {} has another edge for some of these letters",
        state.number
    );
    refused(message, span).related(state.span, "this state").help("make it deterministic first")
}

/// The transitions of edges without labels: one for each letter, proposition 0 changing fastest.
fn table(
    diagram: &mut Diagram,
    state: &Described,
    implicit: &[State],
    count: usize,
) -> Result<Bdd, Error> {
    if implicit.len() < state.edges.len() {
        return Err(syntax("some edges of this state have labels and some have none", state.span));
    }
    if u32::try_from(count).ok().and_then(|count| 1_usize.checked_shl(count))
        != Some(implicit.len())
    {
        let message = format!(
            "edges without labels need one for each letter, 2^{count}; state {} has {}",
            state.number,
            implicit.len()
        );
        return Err(syntax(message, state.span));
    }
    let mut row: Vec<Bdd> = implicit.iter().map(|&to| Bdd::leaf(to)).collect();
    // The last proposition separates the first half of the row from the second.
    for proposition in (0..count as u32).rev() {
        let (low, high) = row.split_at(row.len() / 2);
        let join = |(&low, &high)| diagram.node(proposition, low, high);
        row = low.iter().zip(high).map(join).collect();
    }
    Ok(row[0])
}

/// The transitions with an edge to `to` laid over them where `guard` holds; `None` if another edge
/// is already there.
fn lay(diagram: &mut Diagram, below: Bdd, guard: Bdd, to: State) -> Option<Bdd> {
    let edge = Bdd::leaf(to);
    let mut is_free = true;
    let laid = diagram.apply(Operation::new(to), below, guard, &mut |_, below, guard| {
        if guard == Bdd::FALSE || below == edge {
            return Some(below);
        }
        let meets = guard == Bdd::TRUE && below.value().is_some();
        is_free &= !meets || below == Bdd::leaf(Body::NOWHERE);
        meets.then_some(edge)
    });
    is_free.then_some(laid)
}
