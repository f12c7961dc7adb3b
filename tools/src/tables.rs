//! The compiler's tables as the runtime's automata and formulas, owned.
//!
//! The macros write these same tables as Rust source. Here they are handed over as data, so a
//! formula that is compiled while a program runs is followed by the same code over the same
//! numbers. The runtime checks every table that does not come from a macro, so a fault of the
//! compiler is reported here as an error.

use tltl::automaton::{self, Automaton, TableError};
use tltl::robustness::Op;
use tltl::{Formula, Shared};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::spec::Spec;
use tltl_compiler::tables::{Operator, Transitions, operators, tables};

/// The runtime's automaton for `dfa`: the one that a macro would hold in a static.
///
/// It costs a walk over the diagram, and the guards of all edges as sums of products.
///
/// # Errors
/// If the tables are not an automaton: a fault of the compiler, or of whoever built the [`Dfa`].
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "F a && F b");
/// let compiled = compile::formula(&source, Budget::default())?;
/// let automaton = tltlc::tables::automaton(&compiled.automata[0].dfa)?;
/// // Both hold at once.
/// assert_eq!(automaton.next(0, |_| Ok::<_, ()>(true)).ok(), automaton.accepting());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn automaton(dfa: &Dfa) -> Result<Automaton, TableError> {
    let tables = tables(dfa);
    Automaton::new(automaton::Tables {
        propositions: tables.propositions.into_iter().map(Shared::from).collect(),
        states: tables.states,
        accepting: tables.accepting,
        trap: tables.trap,
        transitions: match tables.transitions {
            Transitions::Table { class, width, next } => {
                automaton::Transitions::Table { class: class.into(), width, next: next.into() }
            }
            Transitions::Diagram { nodes, roots } => {
                automaton::Transitions::Diagram { nodes: nodes.into(), roots: roots.into() }
            }
        },
        edges: tables.edges.into(),
        targets: tables.targets.into(),
        guards: tables.guards.into(),
        literals: tables.literals.into(),
        distance: tables.distance.into(),
    })
}

/// The runtime's formula for `spec`; `text` is what it prints as, the author's own spelling.
///
/// # Errors
/// If the operators are not in order, which would be a fault of the compiler.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "F (a && X b)");
/// let compiled = compile::formula(&source, Budget::default())?;
/// let task = &compiled.module.tasks[0];
/// let formula = tltlc::tables::formula(&task.spec, &task.text)?;
/// assert_eq!(formula.text(), "F (a && X b)");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn formula(spec: &Spec, text: &str) -> Result<Formula, TableError> {
    let operators = operators(spec).into_iter().map(|operator| match operator {
        Operator::True => Op::True,
        Operator::False => Op::False,
        Operator::Is(p) => Op::Is(p),
        Operator::Not(p) => Op::Not(p),
        Operator::And(a, b) => Op::And(a, b),
        Operator::Or(a, b) => Op::Or(a, b),
        Operator::Next(a) => Op::Next(a),
        Operator::Delay(n, a) => Op::Delay(n, a),
        Operator::Eventually(a) => Op::Eventually(a),
        Operator::Within(n, a) => Op::Within(n, a),
        Operator::Throughout(n, a) => Op::Throughout(n, a),
        Operator::Until(a, b) => Op::Until(a, b),
        Operator::Then(a, b) => Op::Then(a, b),
    });
    Formula::new(String::from(text), operators.collect::<Shared<[Op]>>())
}
