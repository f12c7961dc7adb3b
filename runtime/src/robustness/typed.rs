//! A formula as a type, so that its robustness is straight-line code.
//!
//! Generated code names the type of its formula, such as `Until<Now<Is<0>>, Now<Is<1>>>`, and rustc
//! writes the loop: no operator is chosen while it runs, nothing but the numbers that temporal
//! operators carry is kept, and a predicate is inlined where it is read.
//!
//! | trait | what it computes |
//! | --- | --- |
//! | [`State`] | a state formula on each of some rows |
//! | [`Backward`] | a formula on each of some rows, from the last instant of a trajectory to the first |
//! | [`Forward`](forward::Forward) | a formula while a trajectory grows |
//!
//! # Blocks
//!
//! [`Backward`] takes four rows at once, for two reasons. The predicates of a block are
//! independent of each other, so the processor computes several at once. And a temporal operator
//! waits for its value at the next instant: one maximum takes four cycles before the next can begin.
//! So within a block it combines the rows first, which depends on nothing outside, and meets the
//! carried number once.
//!
//! # Modes
//!
//! Robustness is asked for at the first instant ([`Start`]) or at every one ([`Every`]). In the first
//! mode an operator with a bound needs no window, for it looks at the first instants only; its operands
//! are asked for at every instant. In the second its window is an array, which lies on the stack: the
//! compiler gives a type to formulas whose windows have up to 4,096 cells in all.

pub mod forward;
mod side;
#[cfg(feature = "std")]
pub(crate) mod split;

use core::array;
use core::marker::PhantomData;

use super::{Predicates, Window, max, min};
pub(crate) use side::by_time;

/// The rows of a block. `F (a && b)`, `a U b` and `F (a && F b)` take 0.52, 0.67 and 0.83 ns a row in
/// blocks of 4 rows, 0.60, 0.82 and 0.90 in blocks of 8, 0.63, 1.54 and 1.13 in blocks of 16: a larger
/// block no longer fits in the registers.
pub(crate) const BLOCK: usize = 4;

/// Some neighbouring states, read by number of the predicate.
pub trait Rows<const B: usize> {
    /// The instant of the first row.
    fn first(&self) -> usize;
    /// The number of states of the trajectory.
    fn length(&self) -> usize;
    /// The robustness of predicate `P` in each row.
    fn read<const P: usize>(&mut self) -> [f64; B];
}

/// A state formula.
pub trait State {
    /// Its robustness in each row.
    fn of<const B: usize>(rows: &mut impl Rows<B>) -> [f64; B];
}

/// The predicates of a task whose formula is a type.
pub trait Typed {
    /// The formula.
    type Formula;
}

/// A formula that is read from the last row to the first; `M` is [`Start`] or [`Every`].
pub trait Backward<M> {
    /// The numbers that are carried from a block to the one before it.
    type Carry: Carried;
    /// These numbers after the last state of a trajectory.
    const END: Self::Carry;
    /// The robustness at each row of a block, in which mode `Start` only the first instant counts.
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B];
}

/// The mode in which robustness is asked for at the first instant only.
#[derive(Debug)]
pub struct Start;
/// The mode in which robustness is asked for at every instant.
#[derive(Debug)]
pub struct Every;

/// ⊤
#[derive(Debug)]
pub struct True;
/// ⊥
#[derive(Debug)]
pub struct False;
/// Proposition `P`.
#[derive(Debug)]
pub struct Is<const P: usize>;
/// The negation of proposition `P`.
#[derive(Debug)]
pub struct Not<const P: usize>;
/// A state formula, as a formula.
#[derive(Debug)]
pub struct Now<P>(PhantomData<P>);
/// φ ∧ ψ
#[derive(Debug)]
pub struct And<A, B>(PhantomData<(A, B)>);
/// φ ∨ ψ
#[derive(Debug)]
pub struct Or<A, B>(PhantomData<(A, B)>);
/// ○φ
#[derive(Debug)]
pub struct Next<A>(PhantomData<A>);
/// ◇φ
#[derive(Debug)]
pub struct Eventually<A>(PhantomData<A>);
/// `X[n] φ`. The cells of a window are `C` = n + 2, here and below.
#[derive(Debug)]
pub struct Delay<const N: usize, const C: usize, A>(PhantomData<A>);
/// `F[0,n] φ`
#[derive(Debug)]
pub struct Within<const N: usize, const C: usize, A>(PhantomData<A>);
/// `G[0,n] φ`
#[derive(Debug)]
pub struct Throughout<const N: usize, const C: usize, A>(PhantomData<A>);
/// `φ U[0,n] ψ`
#[derive(Debug)]
pub struct UntilWithin<const N: usize, const C: usize, A, B>(PhantomData<(A, B)>);
/// φ U ψ
#[derive(Debug)]
pub struct Until<A, B>(PhantomData<(A, B)>);
/// φ T ψ; the operands are φ and ◇ψ.
#[derive(Debug)]
pub struct Then<A, B>(PhantomData<(A, B)>);

impl State for True {
    #[inline(always)]
    fn of<const B: usize>(_: &mut impl Rows<B>) -> [f64; B] {
        [f64::INFINITY; B]
    }
}

impl State for False {
    #[inline(always)]
    fn of<const B: usize>(_: &mut impl Rows<B>) -> [f64; B] {
        [f64::NEG_INFINITY; B]
    }
}

impl<const P: usize> State for Is<P> {
    #[inline(always)]
    fn of<const B: usize>(rows: &mut impl Rows<B>) -> [f64; B] {
        rows.read::<P>()
    }
}

impl<const P: usize> State for Not<P> {
    #[inline(always)]
    fn of<const B: usize>(rows: &mut impl Rows<B>) -> [f64; B] {
        rows.read::<P>().map(|rho| -rho)
    }
}

impl<A: State, C: State> State for And<A, C> {
    #[inline(always)]
    fn of<const B: usize>(rows: &mut impl Rows<B>) -> [f64; B] {
        zip(A::of(rows), C::of(rows), min)
    }
}

impl<A: State, C: State> State for Or<A, C> {
    #[inline(always)]
    fn of<const B: usize>(rows: &mut impl Rows<B>) -> [f64; B] {
        zip(A::of(rows), C::of(rows), max)
    }
}

impl<M, P: State> Backward<M> for Now<P> {
    type Carry = ();
    const END: () = ();
    #[inline(always)]
    fn block<const B: usize>((): &mut (), rows: &mut impl Rows<B>) -> [f64; B] {
        P::of(rows)
    }
}

impl<M, A: Backward<M>, C: Backward<M>> Backward<M> for And<A, C> {
    type Carry = (A::Carry, C::Carry);
    const END: Self::Carry = (A::END, C::END);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        zip(A::block(&mut carry.0, rows), C::block(&mut carry.1, rows), min)
    }
}

impl<M, A: Backward<M>, C: Backward<M>> Backward<M> for Or<A, C> {
    type Carry = (A::Carry, C::Carry);
    const END: Self::Carry = (A::END, C::END);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        zip(A::block(&mut carry.0, rows), C::block(&mut carry.1, rows), max)
    }
}

impl<M, A: Backward<Every>> Backward<M> for Next<A> {
    type Carry = (A::Carry, f64);
    const END: Self::Carry = (A::END, f64::NEG_INFINITY);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        later(A::block(&mut carry.0, rows), &mut carry.1)
    }
}

impl<A: Backward<Every>> Backward<Every> for Eventually<A> {
    type Carry = (A::Carry, f64);
    const END: Self::Carry = (A::END, f64::NEG_INFINITY);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        best(A::block(&mut carry.0, rows), &mut carry.1)
    }
}

/// The order of the rows does not matter: each place in a block has a maximum of its own.
impl<A: Backward<Every>> Backward<Start> for Eventually<A> {
    type Carry = (A::Carry, [f64; BLOCK]);
    const END: Self::Carry = (A::END, [f64::NEG_INFINITY; BLOCK]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        whole(A::block(&mut carry.0, rows), &mut carry.1, max)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Every> for Delay<N, C, A> {
    type Carry = (A::Carry, [f64; C]);
    const END: Self::Carry = (A::END, [f64::NEG_INFINITY; C]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        slide(Window::Later(N as u32), &mut carry.1[..N], now, rows)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Start> for Delay<N, C, A> {
    type Carry = (A::Carry, f64);
    const END: Self::Carry = (A::END, f64::NEG_INFINITY);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        if let Some(&then) = N.checked_sub(rows.first()).and_then(|i| now.get(i)) {
            carry.1 = then;
        }
        [carry.1; B]
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Every> for Within<N, C, A> {
    type Carry = (A::Carry, [f64; C]);
    const END: Self::Carry = (A::END, [f64::NEG_INFINITY; C]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        slide(Window::Greatest(N as u32), &mut carry.1, now, rows)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Start> for Within<N, C, A> {
    type Carry = (A::Carry, [f64; BLOCK]);
    const END: Self::Carry = (A::END, [f64::NEG_INFINITY; BLOCK]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        whole(until_instant(N, now, f64::NEG_INFINITY, rows), &mut carry.1, max)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Every> for Throughout<N, C, A> {
    type Carry = (A::Carry, [f64; C]);
    const END: Self::Carry = (A::END, [f64::NEG_INFINITY; C]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        slide(Window::Least(N as u32), &mut carry.1, now, rows)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>> Backward<Start> for Throughout<N, C, A> {
    type Carry = (A::Carry, [f64; BLOCK]);
    const END: Self::Carry = (A::END, [f64::INFINITY; BLOCK]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let now = A::block(&mut carry.0, rows);
        let least = whole(until_instant(N, now, f64::INFINITY, rows), &mut carry.1, min);
        if rows.length() > N { least } else { [f64::NEG_INFINITY; B] }
    }
}

/// It is (φ U ψ) ∧ F[0,n] ψ: if ψ comes within n instants, then so does its first instant, until
/// which φ holds.
impl<const N: usize, const C: usize, A: Backward<Every>, D: Backward<Every>> Backward<Every>
    for UntilWithin<N, C, A, D>
{
    type Carry = (A::Carry, D::Carry, f64, [f64; C]);
    const END: Self::Carry = (A::END, D::END, f64::NEG_INFINITY, [f64::NEG_INFINITY; C]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let (hold, goal) = (A::block(&mut carry.0, rows), D::block(&mut carry.1, rows));
        let soon = slide(Window::Greatest(N as u32), &mut carry.3, goal, rows);
        zip(until(hold, goal, &mut carry.2), soon, min)
    }
}

impl<const N: usize, const C: usize, A: Backward<Every>, D: Backward<Every>> Backward<Start>
    for UntilWithin<N, C, A, D>
{
    type Carry = (A::Carry, D::Carry, f64);
    const END: Self::Carry = (A::END, D::END, f64::NEG_INFINITY);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let (hold, goal) = (A::block(&mut carry.0, rows), D::block(&mut carry.1, rows));
        until(hold, until_instant(N, goal, f64::NEG_INFINITY, rows), &mut carry.2)
    }
}

impl<M, A: Backward<Every>, C: Backward<Every>> Backward<M> for Until<A, C> {
    type Carry = (A::Carry, C::Carry, f64);
    const END: Self::Carry = (A::END, C::END, f64::NEG_INFINITY);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let hold = A::block(&mut carry.0, rows);
        until(hold, C::block(&mut carry.1, rows), &mut carry.2)
    }
}

impl<M, A: Backward<Every>, C: Backward<Every>> Backward<M> for Then<A, C> {
    type Carry = (A::Carry, C::Carry, [f64; 2]);
    const END: Self::Carry = (A::END, C::END, [f64::NEG_INFINITY; 2]);
    #[inline(always)]
    fn block<const B: usize>(carry: &mut Self::Carry, rows: &mut impl Rows<B>) -> [f64; B] {
        let first = A::block(&mut carry.0, rows);
        let [after, whole] = &mut carry.2;
        let second = later(C::block(&mut carry.1, rows), after);
        best(zip(first, second, min), whole)
    }
}

#[inline(always)]
fn zip<const B: usize>(a: [f64; B], b: [f64; B], f: impl Fn(f64, f64) -> f64) -> [f64; B] {
    array::from_fn(|i| f(a[i], b[i]))
}

/// The value at the row after each; that after the last is carried.
#[inline(always)]
fn later<const B: usize>(a: [f64; B], carry: &mut f64) -> [f64; B] {
    let after = core::mem::replace(carry, a[0]);
    array::from_fn(|i| if i + 1 < B { a[i + 1] } else { after })
}

/// The greatest value from each row on.
#[inline(always)]
fn best<const B: usize>(mut a: [f64; B], carry: &mut f64) -> [f64; B] {
    for i in (1..B).rev() {
        a[i - 1] = max(a[i - 1], a[i]);
    }
    let all = a.map(|a| max(a, *carry));
    *carry = all[0];
    all
}

/// φ U ψ from each row on. Over several rows it is max(ψ', min(φ', carried)) again, for some ψ' and
/// φ' of these rows alone.
#[inline(always)]
fn until<const B: usize>(mut hold: [f64; B], mut goal: [f64; B], carry: &mut f64) -> [f64; B] {
    for i in (1..B).rev() {
        goal[i - 1] = max(goal[i - 1], min(hold[i - 1], goal[i]));
        hold[i - 1] = min(hold[i - 1], hold[i]);
    }
    let all = array::from_fn(|i| max(goal[i], min(hold[i], *carry)));
    *carry = all[0];
    all
}

/// The best of all rows so far, where the order does not matter: each place in a block has its own.
#[inline(always)]
fn whole<const B: usize>(
    now: [f64; B],
    carry: &mut [f64; BLOCK],
    best: impl Fn(f64, f64) -> f64,
) -> [f64; B] {
    for (carry, now) in carry.iter_mut().zip(now) {
        *carry = best(now, *carry);
    }
    let [a, b, c, d] = *carry;
    [best(best(a, c), best(b, d)); B]
}

/// The values up to instant `last`, and `neutral` after it.
#[inline(always)]
fn until_instant<const B: usize>(
    last: usize,
    now: [f64; B],
    neutral: f64,
    rows: &impl Rows<B>,
) -> [f64; B] {
    array::from_fn(|i| if rows.first() + i <= last { now[i] } else { neutral })
}

/// An operator with a bound.
#[inline(always)]
fn slide<const B: usize>(
    window: Window,
    cells: &mut [f64],
    mut now: [f64; B],
    rows: &impl Rows<B>,
) -> [f64; B] {
    for (i, value) in now.iter_mut().enumerate().rev() {
        *value = window.push(cells, rows.length() - 1 - rows.first() - i, *value);
    }
    now
}

/// Rows of a trajectory.
pub(crate) struct Block<'a, S, P, const B: usize> {
    pub(crate) first: usize,
    pub(crate) length: usize,
    pub(crate) rows: &'a [S; B],
    pub(crate) predicates: &'a P,
    /// For each place in a block whether a predicate was not a number; all bits, for which a
    /// vector of comparisons needs no further step.
    pub(crate) is_nan: &'a mut [u64; BLOCK],
}

impl<S, P: Predicates<S>, const B: usize> Rows<B> for Block<'_, S, P, B> {
    #[inline(always)]
    fn first(&self) -> usize {
        self.first
    }

    #[inline(always)]
    fn length(&self) -> usize {
        self.length
    }

    #[inline(always)]
    fn read<const I: usize>(&mut self) -> [f64; B] {
        let rho: [f64; B] = array::from_fn(|i| self.predicates.robustness(I, &self.rows[i]));
        for (is_nan, rho) in self.is_nan.iter_mut().zip(rho) {
            *is_nan |= if rho.is_nan() { u64::MAX } else { 0 };
        }
        rho
    }
}

/// The robustness of the formula of some predicates on a trajectory; -∞ if it is empty, NaN if a
/// predicate is. Where `signal` has a place for each instant, it gets the robustness from each on.
#[inline]
pub fn straight<S, P: Predicates<S> + Typed>(
    predicates: &P,
    rows: &[S],
    signal: &mut [f64],
) -> Option<f64>
where
    P::Formula: Backward<Start> + Backward<Every>,
{
    Some(if signal.is_empty() {
        backward::<Start, P::Formula, S, P>(predicates, rows, &mut [], &mut [])
    } else {
        let (blocks, rest) = signal.as_chunks_mut();
        backward::<Every, P::Formula, S, P>(predicates, rows, blocks, rest)
    })
}

/// From the last row to the first: those that fill no block one by one, then the blocks.
#[inline(always)]
fn backward<M, F: Backward<M>, S, P: Predicates<S>>(
    predicates: &P,
    rows: &[S],
    signal: &mut [[f64; BLOCK]],
    signal_rest: &mut [f64],
) -> f64 {
    let (length, mut carry, mut is_nan) = (rows.len(), F::END, [0; BLOCK]);
    let mut whole = f64::NEG_INFINITY;
    let (blocks, rest) = rows.as_chunks::<BLOCK>();
    for (i, row) in rest.iter().enumerate().rev() {
        let (first, rows) = (blocks.len() * BLOCK + i, array::from_ref(row));
        let mut rows = Block { first, length, rows, predicates, is_nan: &mut is_nan };
        let found = F::block(&mut carry, &mut rows);
        [whole] = found;
        if let Some(signal) = signal_rest.get_mut(i) {
            *signal = whole;
        }
    }
    for (i, rows) in blocks.iter().enumerate().rev() {
        let first = i * BLOCK;
        let mut rows = Block { first, length, rows, predicates, is_nan: &mut is_nan };
        let found = F::block(&mut carry, &mut rows);
        whole = found[0];
        if let Some(signal) = signal.get_mut(i) {
            *signal = found;
        }
    }
    if is_nan == [0; BLOCK] { whole } else { f64::NAN }
}

/// The numbers that a formula carries from a block to the one before it.
pub trait Carried {
    /// How many they are.
    const COUNT: usize;
    /// Shows each of them, always in the same order.
    fn each(&mut self, see: &mut impl FnMut(&mut f64));
}

impl Carried for () {
    const COUNT: usize = 0;
    #[inline]
    fn each(&mut self, _: &mut impl FnMut(&mut f64)) {}
}

impl Carried for f64 {
    const COUNT: usize = 1;
    #[inline]
    fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
        see(self);
    }
}

impl<const N: usize> Carried for [f64; N] {
    const COUNT: usize = N;
    #[inline]
    fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
        self.iter_mut().for_each(see);
    }
}

macro_rules! tuples {
    ($($($name:ident $place:tt),+;)*) => {$(
        impl<$($name: Carried),+> Carried for ($($name,)+) {
            const COUNT: usize = 0 $(+ $name::COUNT)+;
            #[inline]
            fn each(&mut self, see: &mut impl FnMut(&mut f64)) {
                $(self.$place.each(see);)+
            }
        }
    )*};
}

tuples! { A 0, B 1; A 0, B 1, C 2; A 0, B 1, C 2, D 3; }
