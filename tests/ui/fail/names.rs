//! Names and types that only rustc knows: its own errors at the author's tokens.

use tltl::tltl;

struct Grid {
    x: f64,
}

fn right(s: &Grid) -> f64 {
    s.x - 3.0
}
fn truth(s: &Grid) -> bool {
    s.x > 3.0
}
fn other(s: &f64) -> f64 {
    *s
}

fn main() {
    let _ = tltl! { F rihgt }; //~ no such predicate
    let phi = tltl! { F right && F truth };
    let _ = phi.next(0, &Grid { x: 1.0 }); //~ a Boolean function that is not wrapped
    let psi = tltl! { F right };
    let _ = psi.next(0, &1.0_f64); //~ another state
    let chi = tltl! { F right && F other };
    let _ = chi.next(0, &Grid { x: 1.0 }); //~ predicates of two states
}
