//! A formula in a string: rustc can underline the string only, so the message shows the place.

use tltl::tltl;

fn a(s: &f64) -> f64 {
    *s
}

fn main() {
    let _ = tltl! { "◇a ∧ □a" }; //~ an operator of another logic
    let _ = tltl! { r#"F a &&"# }; //~ an operand is missing
    let _ = tltl! { "F a ∧ ¬◇a" }; //~ a negated temporal operator
}
