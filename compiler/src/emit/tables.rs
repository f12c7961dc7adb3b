//! The tables of an automaton and of its formula as Rust: data, not code.
//!
//! Tables are written as text and read back by the tokenizer, which in a procedural macro is the
//! compiler's own: one token of a table costs nanoseconds so, where building it tree by tree in an
//! unoptimised macro costs microseconds.

use std::fmt::Write as _;

use proc_macro2::TokenStream;
use rustc_hash::FxHashMap;

use crate::dfa::{Dfa, Guards, State, Target};
use crate::guard::Cube;
use crate::spec::{Formula, Spec};

/// A dense table is emitted up to this many entries; above it, the shared decision diagram.
const DENSE_LIMIT: usize = 4096;
/// And only up to this many propositions, for all of them are evaluated to index it.
const DENSE_PROPOSITIONS: usize = 10;

/// The expression that is the runtime's `Automaton`; `path` names the runtime crate.
#[must_use]
pub fn automaton(dfa: &Dfa, path: &str) -> TokenStream {
    let mut text = format!("{path}::Automaton {{ propositions: &{:?}, ", dfa.propositions);
    let option = |state: Option<State>| state.map_or("None".to_owned(), |q| format!("Some({q})"));
    let _ = write!(
        text,
        "states: {}, accepting: ::core::option::Option::{}, trap: ::core::option::Option::{}, ",
        dfa.len(),
        option(dfa.accepting),
        option(dfa.trap)
    );
    transitions(&mut text, dfa, path);
    guards(&mut text, dfa, path);
    let distances: Vec<u32> =
        dfa.distances().iter().map(|distance| distance.unwrap_or(u32::MAX)).collect();
    let _ = write!(text, "distance: &{distances:?} }}");
    tokens(&text)
}

/// The expression that is the runtime's `Formula`, with `written` as its text.
#[must_use]
pub fn formula(spec: &Spec, written: &str, path: &str) -> TokenStream {
    let mut text = format!("{path}::Formula {{ text: {written:?}, ops: &[");
    operators(spec).iter().for_each(|operator| {
        let _ = write!(text, "{path}::robustness::Op::{operator}, ");
    });
    text.push_str("] }");
    tokens(&text)
}

/// The number of operators that [`formula`] writes.
#[must_use]
pub fn operator_count(spec: &Spec) -> usize {
    operators(spec).len()
}

fn operators(spec: &Spec) -> Vec<String> {
    let reachable = spec.reachable();
    let mut place = vec![0_usize; reachable.len()];
    let mut operators = Vec::new();
    for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
        place[id.0 as usize] = operators.len();
        let mut text = match formula {
            Formula::True => "True".to_owned(),
            Formula::False => "False".to_owned(),
            Formula::Literal { proposition, negated: false } => format!("Is({proposition})"),
            Formula::Literal { proposition, negated: true } => format!("Not({proposition})"),
            Formula::And(..) => "And".to_owned(),
            Formula::Or(..) => "Or".to_owned(),
            Formula::Next(_) => "Next".to_owned(),
            Formula::Eventually(_) => "Eventually".to_owned(),
            Formula::Until(..) => "Until".to_owned(),
            Formula::Then(..) => "Then".to_owned(),
        };
        let operands: Vec<_> =
            formula.operands().map(|operand| place[operand.0 as usize].to_string()).collect();
        if !operands.is_empty() {
            let _ = write!(text, "({})", operands.join(", "));
        }
        operators.push(text);
    }
    operators
}

fn transitions(text: &mut String, dfa: &Dfa, path: &str) {
    let _ = match dense(dfa) {
        Some((class, width, next)) => write!(
            text,
            "transitions: {path}::automaton::Transitions::Table {{ class: &{class:?}, width: \
             {width}, next: &{next:?} }}, "
        ),
        None => {
            let node = format!("{path}::automaton::Node");
            let _ =
                write!(text, "transitions: {path}::automaton::Transitions::Diagram {{ nodes: &[");
            for asked in dfa.diagram.nodes() {
                let (low, high) = (reference(asked.low), reference(asked.high));
                let proposition = asked.proposition;
                let _ = write!(
                    text,
                    "{node} {{ proposition: {proposition}, low: {low}, high: {high} }}, "
                );
            }
            let roots: Vec<_> = dfa.transitions.iter().map(|&root| reference(root)).collect();
            write!(text, "], roots: &{roots:?} }}, ")
        }
    };
}

/// A target as the runtime's `Node` has it.
fn reference(target: Target) -> u32 {
    const LEAF: u32 = 1 << 31;
    target.node().or(target.state().map(|state| LEAF + state)).unwrap_or_default()
}

/// The class of each valuation, the number of classes, and the next states; `None` if too large.
fn dense(dfa: &Dfa) -> Option<(Vec<u16>, usize, Vec<State>)> {
    let count = dfa.propositions.len();
    if count > DENSE_PROPOSITIONS {
        return None;
    }
    let mut columns: FxHashMap<Vec<State>, u16> = FxHashMap::default();
    let mut order = Vec::new();
    let mut class = Vec::with_capacity(1 << count);
    for letter in 0..1_usize << count {
        let column: Vec<State> =
            dfa.states().map(|q| dfa.next(q, |i| letter >> i & 1 == 1)).collect();
        let fresh = columns.len() as u16;
        class.push(*columns.entry(column).or_insert_with_key(|column| {
            order.push(column.clone());
            fresh
        }));
        if class.len().max(order.len() * dfa.len()) > DENSE_LIMIT {
            return None;
        }
    }
    let next = dfa.states().flat_map(|q| order.iter().map(move |column| column[q as usize]));
    Some((class, order.len(), next.collect()))
}

fn guards(text: &mut String, dfa: &Dfa, path: &str) {
    let mut guards = Guards::new(dfa);
    text.push_str("edges: &[");
    for from in dfa.states() {
        for to in dfa.successors(from) {
            let guard = guard(&guards.edge(from, to));
            let _ = write!(
                text,
                "{path}::automaton::Edge {{ from: {from}, to: {to}, guard: {guard} }}, "
            );
        }
    }
    text.push_str("], progress: &[");
    for q in dfa.states() {
        let _ = write!(text, "{}, ", guard(&guards.progress(q)));
    }
    text.push_str("], ");
}

/// A sum of products in DIMACS style.
fn guard(cubes: &[Cube]) -> String {
    let literal = |&(proposition, value): &(u32, bool)| {
        format!("{}{}", if value { "" } else { "-" }, proposition + 1)
    };
    let cube =
        |cube: &Cube| format!("&[{}]", cube.iter().map(literal).collect::<Vec<_>>().join(", "));
    format!("&[{}]", cubes.iter().map(cube).collect::<Vec<_>>().join(", "))
}

fn tokens(text: &str) -> TokenStream {
    text.parse().expect("generated tables are Rust")
}
