//! Enumerations, parameters and words of Rust: each module has one mistake.

use tltl::tltl;

struct House {
    x: f64,
    n: u8,
    r#type: f64,
}

fn near(s: &House) -> f64 {
    s.x
}

mod argument_count {
    tltl::tltl! {
        state s: super::House;
        predicate at(n: u8) = s.n == n;
        task go = F at(1, 2); //~ one argument
    }
}

mod argument_range {
    tltl::tltl! {
        state s: super::House;
        predicate at(n: u8) = s.n == n;
        task go = F at(256); //~ beyond a u8
    }
}

mod argument_missing {
    tltl::tltl! {
        state s: super::House;
        predicate at(n: u8) = s.n == n;
        task go = F at; //~ without an argument
    }
}

mod truth_argument {
    tltl::tltl! {
        state s: super::House;
        predicate at(n: u8, wanted: bool) = s.n == n && wanted;
        task go = F at(1, 2); //~ a number for a truth value
    }
}

mod parameter_type {
    tltl::tltl! {
        state s: super::House;
        task go(n: f32) = F s.x > 1; //~ no such parameter
    }
}

mod parameter_as_formula {
    tltl::tltl! {
        state s: super::House;
        task go(n: u8) = F n; //~ a number
    }
}

mod enumeration {
    tltl::tltl! {
        enum Room { kitchen, hall, kitchen } //~ twice
        state s: super::House;
        task go = F s.x > 1;
    }
}

mod value {
    tltl::tltl! {
        enum Room { kitchen, hall }
        state s: super::House;
        predicate at(r: Room) = { s.n == r.index() as u8 };
        task go = F at(Room::attic); //~ no such value
    }
}

fn main() {
    let _ = tltl! { F type }; //~ a word of Rust
    let _ = tltl! { |s: &House| F s.type > 1 }; //~ a word of Rust
    let _ = tltl! { |s: &House| F s.r#type > 1 };
    let _ = tltl! { for all i in 3..2: F near }; //~ no number
}
