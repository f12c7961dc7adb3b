//! The product of the specifications, and two anchors of the product routine.
//!
//! The paper reports 23 nodes and 110 edges for formulas that are lost. (a) and (b) are pairs that
//! give exactly these counts; they pin the routine, not the paper's formulas.

use tltl::product::Product;
use tltl_compiler::compile;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltl_kitchen::tasks::{phi_3, phi1_3};
use tltlc::product::{Operator, product};

fn automaton(formula: &str) -> Dfa {
    let source = Source::new("formula", formula);
    let compiled = compile::formula(&source, Budget::default()).unwrap();
    compiled.automata[0].dfa.clone()
}

/// States, edges without self-loops, self-loops.
fn size(dfa: &Dfa) -> (usize, usize, usize) {
    let size = dfa.size();
    (size.states, size.edges, size.self_loops)
}

fn conjunction(first: &str, second: &str) -> Dfa {
    product(Operator::And, &[&automaton(first), &automaton(second)]).dfa
}

#[test]
fn of_the_composition() {
    let (first, second) = (phi1_3(), phi_3(7, 20));
    let composition = Product::conjunction(&[&first, &second]);
    let raw = composition.size();
    assert_eq!((raw.states, raw.edges + raw.self_loops, raw.trap), (25, 81, false));

    let of = |o: &str, open: &str| format!("see{o} T hold{o} T {open} T in{o}");
    let disjoint = conjunction(&of("1", "open1"), &of("2", "open2"));
    assert_eq!(size(&disjoint), (25, 81 - 25, 25));
    let shared = conjunction(&of("1", "open"), &of("2", "open"));
    assert_eq!(size(&shared), (25, 79 - 25, 25));
}

#[test]
fn anchors_of_the_routine() {
    let a =
        conjunction("(hold1 T g) && (open T g)", "F(found2 && F g) && (hold2 T g) && (open T g)");
    let (states, edges, loops) = size(&a);
    assert_eq!((states, edges + loops), (23, 110));
    let (states, edges, loops) = size(&minimize(&a));
    assert_eq!((states, edges + loops), (17, 84));

    let b = conjunction(
        "(hold1 T in1) && F(open && F in1)",
        "F(found2 && F in2) && F(hold2 && F in2) && (open T in2)",
    );
    assert_eq!(size(&b), (23, 110, 23));
}
