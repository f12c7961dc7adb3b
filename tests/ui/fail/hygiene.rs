//! Names that are one in Rust, and names that Rust has taken.
#![allow(non_camel_case_types)]

tltl::include_tltl!("ui/tasks/twice.tltl"); //~ fields of one name

struct a {
    x: f64,
}
tltl::include_tltl!("ui/tasks/rust.tltl", state = a, mod = other); //~ a predicate of the same name

struct State {
    x: f64,
}

mod constructor {
    tltl::tltl! {
        state s: super::State;
        predicate above(Ok: f64) = s.x > Ok; //~ a constructor
        task t = F above(1);
    }
}

fn main() {
    let _ = tltl::tltl! { |self: &State| F self.x > 1 }; //~ a word that nothing can be called
}
