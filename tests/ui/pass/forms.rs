//! Every form of the macro, and what Rust allows around it.
#![deny(warnings)]

use std::marker::PhantomData;

use tltl::{Boolean, tltl};

struct Grid<'a, T: 'a> {
    x: f64,
    r#in: i32,
    cells: [[f32; 2]; 2],
    ok: bool,
    about: PhantomData<&'a T>,
}

impl<T> Grid<'_, T> {
    fn is_fine(&self) -> bool {
        self.ok
    }
}

fn a(s: &f64) -> f64 {
    s - 1.0
}

mod inner {
    pub(crate) fn b(s: &f64) -> f64 {
        s - 2.0
    }
    pub(crate) fn r#type(s: &f64) -> bool {
        *s > 3.0
    }
}

/// Tokens that come through another macro stand in invisible brackets.
macro_rules! eventually {
    ($e:expr, $name:ident, $p:path) => {
        tltl! { |s: &f64| F ($e < { *s }) && F $name && F $p }
    };
}

tltl! {
    /// The state is a type of ours.
    state s: Grid<'static, Vec<u8>>;
    /// A predicate over a field that has a keyword's name.
    predicate raw = s.r#in >= 3;
    /// Two lines
    /// of words.
    predicate near = 1.0 < s.x < 3.0 && s.cells[1][0] > 0.5;
    predicate fine = { s.is_fine() };
    /// Constants and parameters have units.
    const gap in m = 0.5;
    const rate in s^-1 = 2.0;
    predicate within(d: f64 in m, v: f64 in m/s) = s.x < d + v / rate + gap;
    predicate wide = within(2.0, 1.0);
    /// Both.
    task both = F raw && (F near || fine) && F wide;
    /// Bounds in steps and in times.
    step 0.5 s;
    const patience = 2;
    task soon = F[0, patience] fine && F [1] near && G[0.5 s, 1 s] raw ensuring !wide || fine;
    /// A name that is a keyword.
    task r#loop = !raw U near;
}

pub(crate) fn main() {
    let phi = tltl! { F a && F inner::b };
    assert_eq!(phi.satisfied(&[1.5, 2.5]), Ok(true));
    let wrapped = Boolean::new(inner::r#type);
    let psi = tltl! { "◇a ∧ ◇wrapped" };
    assert_eq!(psi.satisfied(&[1.5, 3.5]), Ok(true));
    let closure = |s: &f64| 5.0 - s;
    let chi = eventually!(1.0 + 1.0, closure, self::a);
    assert_eq!(chi.satisfied(&[2.5]), Ok(true));
    let within = tltl! { F[0,2] a && X[1] a && [][0, 1] a };
    assert_eq!(within.satisfied(&[1.5, 3.5]), Ok(true));
    let never = tltl! { (F inner::b && !G !a) ensuring !(closure <=> a) };
    assert_eq!(never.satisfied(&[0.5, 2.5]), Ok(false));
    let limit = 3.0;
    let captured = tltl! { |s: &f64| F ({ *s } > limit) };
    assert_eq!(captured.satisfied(&[2.5]), Ok(false));
    let grid = Grid { x: 2.0, r#in: 3, cells: [[1.0; 2]; 2], ok: true, about: PhantomData };
    assert_eq!(both().satisfied(&[grid]), Ok(true));
    assert_eq!(r#loop().automaton().tables().states, 3);
    assert!(
        raw(&Grid { x: 0.0, r#in: 1, cells: [[0.0; 2]; 2], ok: false, about: PhantomData }) < 0.0
    );
}
