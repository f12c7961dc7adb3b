//! A formula by itself: rustc underlines the very token.

use tltl::tltl;

fn a(s: &f64) -> f64 {
    *s
}
fn b(s: &f64) -> f64 {
    -s
}

fn main() {
    let _ = tltl! { F a && }; //~ an operand is missing
    let _ = tltl! { F a F b }; //~ an operator is missing
    let _ = tltl! { F (a b) }; //~ an operator is missing
    let _ = tltl! { G a }; //~ an operator of another logic
    let _ = tltl! { a U []b }; //~ another one
    let _ = tltl! { a W b }; //~ another one
    let _ = tltl! { F b && !F a }; //~ a negated temporal operator
    let _ = tltl! { !X a }; //~ one with a rewrite
    let _ = tltl! { F a => b }; //~ a hidden one
    let _ = tltl! { F U }; //~ a keyword for a name
    let _ = tltl! { F a <=> b }; //~ only between conditions on one state
    let _ = tltl! { F[3, 1] a }; //~ an interval without an instant
    let _ = tltl! { F (3 < 99999999999999999999999999999999999999999) }; //~ a number that is not exact
    let _ = tltl! {}; //~ nothing at all
    let phi = tltl! { F !F a }; //~ one message, though the value is used
    let q = phi.next(0, &1.0).unwrap();
    let _ = phi.automaton().accepting() == Some(q);
}
