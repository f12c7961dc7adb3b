//! Declarations: each module has one mistake.

struct Grid {
    x: f64,
    y: f64,
}

mod unknown {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = s.x < 1.0;
        task go = F left && F rihgt; //~ no such predicate
    }
}

mod duplicate {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = s.x < 1.0;
        predicate left = s.x < 2.0; //~ declared twice
        task go = F left;
    }
}

mod cycle {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = right && s.x < 1.0;
        predicate right = left || s.y < 1.0; //~ in a circle
        task go = F left;
    }
}

mod keyword {
    tltl::tltl! {
        state s: super::Grid;
        predicate U = s.x < 1.0; //~ a keyword for a name
        task go = F (s.x < 2.0);
    }
}

mod temporal {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = F (s.x < 1.0); //~ a predicate is about one state
        task go = F left;
    }
}

mod never {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = s.x < 1.0;
        predicate right = s.x > 2.0;
        /// Not possible.
        task go = F (left && right); //~ can never be satisfied
    }
}

mod incomplete {
    tltl::tltl! {
        state s: super::Grid;
        predicate left = ; //~ nothing there
        task go = F left;
    }
}

mod measured {
    tltl::tltl! {
        state s: super::Grid;
        const pause in s = 0.5;
        predicate near(d: f64 in m, v: f64 in m/s^1) = s.x < d - v / pause; //~ m and m/s^2
        task go = F near(1.0, 2.0);
    }
}

fn main() {}
