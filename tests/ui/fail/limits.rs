//! What grows or nests too much: each module has one mistake.

use tltl::tltl;

struct Grid {
    x: f64,
    lit: [bool; 40],
}

fn a(s: &Grid) -> f64 {
    s.x
}

mod states {
    tltl::tltl! {
        state s: super::Grid;
        predicate lit(i: usize) = { s.lit[i] == true };
        task all = for all i in 0..30: F lit(i); //~ 2^30 states
    }
}

mod allowed {
    tltl::tltl! {
        state s: super::Grid;
        #[budget(states = 3)]
        task four = F s.x > 1 && F s.x > 2 && F s.x > 3; //~ more than it is allowed
    }
}

mod unknown_setting {
    tltl::tltl! {
        state s: super::Grid;
        #[budget(stats = 3)] //~ no such setting
        task one = F s.x > 1;
    }
}

fn main() {
    let _ = tltl! { F a && X X X X X X X X X X X X X X X X X X X X (a && F (a && X X X X X X X X X X X X X X X X a)) }; //~ 2^16 states
    let _ = tltl! { F {{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{{ a }}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}}} }; //~ braces too deep
    let _ = tltl! { for all i in 0..100000000: F a }; //~ written out
}
