//! A formula with a header: comparisons of Rust expressions.

use tltl::tltl;

struct Grid {
    x: f64,
    name: String,
}

fn main() {
    let _ = tltl! { |s: &Grid| F (1.0 < s.x > 3.0) }; //~ a chain that points both ways
    let _ = tltl! { |s: &Grid| F (s.x + 1) }; //~ a number where a formula is needed
}

fn rust() {
    let _ = tltl! { |s: &Grid| F (s.y < 3.0) }; //~ no such field, says rustc
    let _ = tltl! { |s: &Grid| F (s.name < 3.0) }; //~ not a number, says rustc
    let _ = tltl! { |s: &Girds| F (s.x < 3.0) }; //~ no such type, says rustc
}
