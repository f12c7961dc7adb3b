//! Names, lints and macros around the macros: nothing of the author's stands for anything of ours,
//! nor the reverse, and rustc has nothing to say.
#![deny(warnings)]

use tltl::tltl;

pub(crate) struct Rover {
    pub(crate) x: f64,
}

/// Locals of the generated code are called `t` and a number, conditions `c`, the state `s`.
mod locals {
    use super::Rover;

    pub(super) fn test() {
        let t14 = 100.0;
        let far = tltl::tltl! {
            |s: &Rover| F (s.x + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 + 1 > t14)
        };
        assert_eq!(far.robustness(&[Rover { x: 0.0 }]), Ok(-87.0));
        assert_eq!(far.satisfied(&[Rover { x: 1000.0 }]), Ok(true));
    }
}

/// A pattern that is called like a constant is no variable, hygienic or not.
mod constants {
    #![allow(non_upper_case_globals)]
    use super::Rover;

    const s: f64 = 1.0;
    const i: f64 = 2.0;
    const f: f64 = 3.0;
    const c1: f64 = 4.0;
    const d: f64 = 5.0;

    tltl::tltl! {
        state r: Rover;
        predicate low = r.x < 0 || r.x > 90;
        predicate near(d: f64, Limit: f64) = (low || r.x < d) && (low || r.x > { s - i + f - c1 })
            && r.x < Limit;
        task go(d: f64) = F near(d, 9);
    }

    pub(super) fn test() {
        assert_eq!(go(3.0).robustness(&[Rover { x: 1.0 }]), Ok(2.0));
        assert_eq!(d, 5.0);
    }
}

/// No name but those of the extern crates is in scope, and the macros of `std` are others.
mod bare {
    #![no_implicit_prelude]

    macro_rules! concat {
        ($($t:tt)*) => {
            0
        };
    }
    ::tltl::include_tltl!("ui/tasks/½step.tltl");

    pub(super) fn test() {
        let _: u8 = concat!(any);
        let near = |s: &f64| *s - 1.0;
        let braces = ::tltl::tltl! { F {near} };
        let walk = [2.0];
        ::core::assert!(::core::matches!(
            braces.satisfied(&walk),
            ::core::result::Result::Ok(true)
        ));
        let walk = [__step::S { x: 2.0, self_: 0.5 }];
        let task = __step::t(1.0, 9.0);
        ::core::assert!(::core::matches!(task.satisfied(&walk), ::core::result::Result::Ok(true)));
        ::core::assert!(::core::matches!(__step::Scope::ALL, __step::Scope::ALL));
    }
}

/// The arguments of `macro_rules!`: invisible brackets, and variables of the same letters.
mod fragments {
    use super::Rover;

    macro_rules! both {
        ($a:expr, $b:expr) => {
            tltl::tltl! { F $a && F $b }
        };
    }
    macro_rules! exceeds {
        ($s:ident, $t:ty, $l:literal, $e:expr) => {
            tltl::tltl! { |$s: &$t| F $s.x > $l && F ({ $e * 2.0 } > 3) }
        };
    }
    macro_rules! own {
        ($x:ident) => {{
            let near = |s: &f64| *s - 1.0;
            tltl::tltl! { F near && F $x }
        }};
    }
    macro_rules! formula {
        ($text:literal) => {
            tltl::tltl! { $text }
        };
    }

    pub(super) fn test() {
        let near = |s: &f64| -*s;
        assert_eq!(both!(near, |s: &f64| *s - 2.0).satisfied(&[-1.0, 3.0]), Ok(true));
        assert_eq!(exceeds!(q, Rover, 1.5, 1.0 + 1.0).satisfied(&[Rover { x: 2.0 }]), Ok(true));
        assert_eq!(own!(near).satisfied(&[2.0]), Ok(false));
        assert_eq!(own!(near).satisfied(&[2.0, -1.0]), Ok(true));
        assert_eq!(formula!("F near").satisfied(&[-1.0]), Ok(true));
    }
}

/// Another name for the runtime, through a macro and for a file.
mod renamed {
    mod dependencies {
        pub(super) use tltl as runtime;
    }
    macro_rules! wrapped {
        ($path:path, $($formula:tt)*) => {
            tltl::tltl! { #![crate = $path] $($formula)* }
        };
    }
    mod inner {
        pub(super) struct Mine {
            pub(super) x: f64,
        }
        tltl::include_tltl!(
            "ui/tasks/rust.tltl",
            state = self::Mine,
            crate = super::dependencies::runtime
        );
    }

    pub(super) fn test() {
        let a = |s: &f64| *s;
        assert_eq!(wrapped!(dependencies::runtime, F a && X a).satisfied(&[1.0, 1.0]), Ok(true));
        assert_eq!(inner::rust::t().satisfied(&[inner::Mine { x: 4.0 }]), Ok(false));
    }
}

/// With a state of its own, what stands in the macro is a file.
mod inline {
    tltl::tltl! {
        enum Mode { on, off }
        state Lamp { level: f64, mode: Mode }
        predicate is(m: Mode, other: Mode?) = mode == m || other == none && level > 1;
        task t(m: Mode) = F is(m, none);
    }

    pub(super) fn test() {
        assert_eq!(t(Mode::on).satisfied(&[Lamp { level: 0.0, mode: Mode::off }]), Ok(false));
    }
}

pub(crate) fn main() {
    locals::test();
    constants::test();
    bare::test();
    fragments::test();
    renamed::test();
    inline::test();
    let at = Rover { x: 3.0 };
    let task = tltl! { |at: &Rover| F at.x > { at.x } - 1 };
    assert_eq!(task.satisfied(&[at]), Ok(true));
}
