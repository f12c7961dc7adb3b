//! A formula as a type, read from the first state on: robustness while a trajectory grows.
//!
//! The recursions of [`Backward`](super::Backward) need the last state first. Forward, a formula φ is
//! asked for the greatest min(w_j, ρ(φ, j)) over all instants j at which it may start, where the
//! *weight* w_j is what the operators around it have on the way to j. So an operator turns the weights
//! that it is given into those of its operand, and nothing is kept but a few weights: `F φ` hands on
//! the greatest so far, `p U φ` what p leaves of it, `X φ` the one before, an operator with a bound the
//! greatest of a window. At a state formula, weights become robustness.
//!
//! Each step also says what the robustness can still become if every later literal may have any
//! value: the upper end of the robust satisfaction interval (Deshmukh, Donzé, Ghosh, Jin, Juniwal and
//! Seshia, "Robust online monitoring of signal temporal logic", 2017). It is the greatest weight with
//! which an operand can still start, since what is unknown leaves a weight as it is. The lower end is
//! the robustness so far, which never falls.
//!
//! # Limits
//!
//! A maximum of minima is no minimum of maxima: where φ ∧ ψ may start at several instants, both must
//! start at the same one, and two numbers do not say whether they did. So below `F`, `U`, `T` and
//! bounds one side of a conjunction is a state formula, the left side of `U` and `T` always is, and so
//! is the operand of a bounded `G`. Formulas of other forms do not implement [`Forward`].

use super::{And, Delay, Eventually, Next, Now, Or, Rows, State, Then, Throughout, Until};
use super::{UntilWithin, Window, Within, max, min};

const NONE: f64 = f64::NEG_INFINITY;

/// How often a formula may start.
pub trait Mode {
    /// The weights of those starts that a bound still counts.
    type Starts<const C: usize>: Starts;
}

/// A formula that starts once: the whole one, and its operands below `&&`, `||` and `X`.
#[derive(Debug)]
pub struct Once;

/// A formula that may start at every instant.
#[derive(Debug)]
pub struct Often;

impl Mode for Once {
    type Starts<const C: usize> = Held;
}

impl Mode for Often {
    type Starts<const C: usize> = Queue<C>;
}

/// A formula that is read from the first state on; `M` is [`Once`] or [`Often`].
#[diagnostic::on_unimplemented(
    message = "this formula cannot be monitored online",
    label = "its type is `{Self}`",
    note = "below `F`, `U`, `T` and bounds, one side of `&&` must be a state formula; so must the left side of `U` and `T`, and the operand of `G[a,b]`",
    note = "`Task::robustness` reads whole trajectories, whatever the formula"
)]
pub trait Forward<M> {
    /// The weights that are kept from one state to the next.
    type Kept;
    /// These before the first state.
    const NEW: Self::Kept;
    /// Reads a state, where the formula starts with weight `now`, and can start later with at most
    /// `later`: the greatest min(weight, robustness) so far, and what that can still become.
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2];
}

/// Weights of starts, of which the old are forgotten.
pub trait Starts {
    /// No start.
    const NEW: Self;
    /// A start at instant `t`, the last so far.
    fn push(&mut self, weight: f64, t: usize);
    /// Forgets the starts before instant `t`.
    fn forget(&mut self, t: usize);
    /// What a state formula of robustness `rho` leaves of all weights.
    fn lower(&mut self, rho: f64);
    /// The greatest weight.
    fn best(&self) -> f64;
}

/// One start.
#[derive(Clone, Copy, Debug)]
pub struct Held {
    weight: f64,
    at: usize,
}

impl Starts for Held {
    const NEW: Self = Self { weight: NONE, at: 0 };

    #[inline(always)]
    fn push(&mut self, weight: f64, t: usize) {
        if weight > NONE {
            *self = Self { weight, at: t };
        }
    }

    #[inline(always)]
    fn forget(&mut self, t: usize) {
        if self.at < t {
            self.weight = NONE;
        }
    }

    #[inline(always)]
    fn lower(&mut self, rho: f64) {
        self.weight = min(rho, self.weight);
    }

    #[inline(always)]
    fn best(&self) -> f64 {
        self.weight
    }
}

/// A monotone queue (Lemire, "Streaming Maximum-Minimum Filter Using No More than Three Comparisons
/// per Element", 2006): weights that fall from the oldest to the newest, for a start that is older
/// than another and no heavier never counts again. To lower all weights at once makes the heaviest
/// equal, of which the newest alone stays; so each start is taken out once, and a step takes constant
/// time on average.
#[derive(Clone, Copy, Debug)]
pub struct Queue<const C: usize> {
    weights: [f64; C],
    instants: [usize; C],
    first: usize,
    length: usize,
}

impl<const C: usize> Queue<C> {
    /// The cell of entry `i`, of up to `C`. The least keeps a panic out of the code.
    #[inline(always)]
    fn cell(&self, i: usize) -> usize {
        let cell = self.first + i;
        if cell < C { cell } else { (cell - C).min(C - 1) }
    }

    #[inline(always)]
    fn pop_first(&mut self) {
        self.first = self.cell(1);
        self.length -= 1;
    }
}

impl<const C: usize> Starts for Queue<C> {
    const NEW: Self = Self { weights: [NONE; C], instants: [0; C], first: 0, length: 0 };

    #[inline]
    fn push(&mut self, weight: f64, t: usize) {
        while self.length > 0 && self.weights[self.cell(self.length - 1)] <= weight {
            self.length -= 1;
        }
        if weight > NONE {
            let cell = self.cell(self.length);
            (self.weights[cell], self.instants[cell]) = (weight, t);
            self.length += 1;
        }
    }

    #[inline]
    fn forget(&mut self, t: usize) {
        while self.length > 0 && self.instants[self.cell(0)] < t {
            self.pop_first();
        }
    }

    #[inline]
    fn lower(&mut self, rho: f64) {
        let mut newest = None;
        while self.length > 0 && self.weights[self.cell(0)] > rho {
            newest = Some(self.instants[self.cell(0)]);
            self.pop_first();
        }
        if let Some(instant) = newest {
            self.first = self.first.checked_sub(1).unwrap_or(C - 1);
            (self.weights[self.cell(0)], self.instants[self.cell(0)]) = (rho, instant);
            self.length += 1;
        }
    }

    #[inline(always)]
    fn best(&self) -> f64 {
        if self.length > 0 { self.weights[self.cell(0)] } else { NONE }
    }
}

impl<M, P: State> Forward<M> for Now<P> {
    type Kept = f64;
    const NEW: f64 = NONE;
    #[inline(always)]
    fn step(best: &mut f64, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [rho] = P::of(row);
        *best = max(min(rho, now), *best);
        [*best, max(*best, later)]
    }
}

/// Both start once, so together.
impl<A: Forward<Once>, C: Forward<Once>> Forward<Once> for And<A, C> {
    type Kept = (A::Kept, C::Kept);
    const NEW: Self::Kept = (A::NEW, C::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [a, b] = A::step(&mut kept.0, now, later, row);
        let [c, d] = C::step(&mut kept.1, now, later, row);
        [min(a, c), min(b, d)]
    }
}

impl<P: State, C: Forward<Often>> Forward<Often> for And<Now<P>, C> {
    type Kept = C::Kept;
    const NEW: Self::Kept = C::NEW;
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [rho] = P::of(row);
        C::step(kept, min(rho, now), later, row)
    }
}

impl<M, A: Forward<M>, C: Forward<M>> Forward<M> for Or<A, C> {
    type Kept = (A::Kept, C::Kept);
    const NEW: Self::Kept = (A::NEW, C::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [a, b] = A::step(&mut kept.0, now, later, row);
        let [c, d] = C::step(&mut kept.1, now, later, row);
        [max(a, c), max(b, d)]
    }
}

impl<M, A: Forward<M>> Forward<M> for Next<A> {
    type Kept = (A::Kept, f64);
    const NEW: Self::Kept = (A::NEW, NONE);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let before = core::mem::replace(&mut kept.1, now);
        A::step(&mut kept.0, before, max(now, later), row)
    }
}

impl<const N: usize, const C: usize, A: Forward<Once>> Forward<Once> for Delay<N, C, A> {
    type Kept = (A::Kept, Held);
    const NEW: Self::Kept = (A::NEW, Held::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let (t, start) = (row.first(), &mut kept.1);
        start.push(now, t);
        let arrived = if start.at + N == t { start.weight } else { NONE };
        start.forget((t + 1).saturating_sub(N));
        A::step(&mut kept.0, arrived, max(start.weight, later), row)
    }
}

impl<const N: usize, const C: usize, A: Forward<Often>> Forward<Often> for Delay<N, C, A> {
    /// The weights on their way, and the window of their maximum.
    type Kept = (A::Kept, [f64; C], [f64; C]);
    const NEW: Self::Kept = (A::NEW, [NONE; C], [NONE; C]);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let t = row.first();
        let arrived = Window::Later(N as u32).push(&mut kept.1[..N], t, now);
        let window = Window::Greatest(N as u32 - 1);
        let coming = window.push(&mut kept.2[..=N], t, now);
        A::step(&mut kept.0, arrived, max(coming, later), row)
    }
}

impl<M, A: Forward<Often>> Forward<M> for Eventually<A> {
    type Kept = (A::Kept, f64);
    const NEW: Self::Kept = (A::NEW, NONE);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        kept.1 = max(now, kept.1);
        A::step(&mut kept.0, kept.1, max(kept.1, later), row)
    }
}

impl<const N: usize, const C: usize, M: Mode, A: Forward<Often>> Forward<M> for Within<N, C, A> {
    type Kept = (A::Kept, M::Starts<C>);
    const NEW: Self::Kept = (A::NEW, M::Starts::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let (t, starts) = (row.first(), &mut kept.1);
        starts.push(now, t);
        let weight = starts.best();
        starts.forget((t + 1).saturating_sub(N));
        A::step(&mut kept.0, weight, max(starts.best(), later), row)
    }
}

impl<M, P: State, A: Forward<Often>> Forward<M> for Until<Now<P>, A> {
    type Kept = (A::Kept, f64);
    const NEW: Self::Kept = (A::NEW, NONE);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let ([rho], weight) = (P::of(row), max(now, kept.1));
        kept.1 = min(rho, weight);
        A::step(&mut kept.0, weight, max(kept.1, later), row)
    }
}

impl<const N: usize, const C: usize, M: Mode, P: State, A: Forward<Often>> Forward<M>
    for UntilWithin<N, C, Now<P>, A>
{
    type Kept = (A::Kept, M::Starts<C>);
    const NEW: Self::Kept = (A::NEW, M::Starts::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let ([rho], t, starts) = (P::of(row), row.first(), &mut kept.1);
        starts.push(now, t);
        let weight = starts.best();
        starts.lower(rho);
        starts.forget((t + 1).saturating_sub(N));
        A::step(&mut kept.0, weight, max(starts.best(), later), row)
    }
}

impl<M, P: State, A: Forward<Often>> Forward<M> for Then<Now<P>, A> {
    /// The greatest weight so far, and what the first operand left of it in the state before.
    type Kept = (A::Kept, f64, f64);
    const NEW: Self::Kept = (A::NEW, NONE, NONE);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [rho] = P::of(row);
        kept.1 = max(now, kept.1);
        let before = core::mem::replace(&mut kept.2, min(rho, kept.1));
        A::step(&mut kept.0, before, max(kept.1, later), row)
    }
}

impl<const N: usize, const C: usize, P: State> Forward<Once> for Throughout<N, C, Now<P>> {
    /// The start, and the robustness once the window has passed.
    type Kept = (Held, f64);
    const NEW: Self::Kept = (Held::NEW, NONE);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let ([rho], t, (start, best)) = (P::of(row), row.first(), kept);
        start.push(now, t);
        start.lower(rho);
        if start.at + N == t {
            *best = max(start.weight, *best);
        }
        start.forget((t + 1).saturating_sub(N));
        [*best, max(*best, max(start.weight, later))]
    }
}

impl<const N: usize, const C: usize, P: State> Forward<Often> for Throughout<N, C, Now<P>> {
    type Kept = Holding<C>;
    const NEW: Self::Kept = Holding::NEW;
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        let [rho] = P::of(row);
        let done = kept.step::<N>(now, rho, row.first());
        kept.best = max(done, kept.best);
        [kept.best, max(kept.best, max(kept.starts.best(), later))]
    }
}

/// `G[0,n] p` from many starts.
#[derive(Clone, Copy, Debug)]
pub struct Holding<const C: usize> {
    /// What p has left so far of the starts whose windows are open.
    starts: Queue<C>,
    /// The weights of these starts, and the window of p: of two starts of the queue the lighter one is
    /// forgotten, though it may be done before p takes from the heavier one.
    weights: [f64; C],
    least: [f64; C],
    best: f64,
}

impl<const C: usize> Holding<C> {
    const NEW: Self = Self { starts: Queue::NEW, weights: [NONE; C], least: [NONE; C], best: NONE };

    /// What p leaves of the start whose window ends at `t`.
    #[inline(always)]
    fn step<const N: usize>(&mut self, now: f64, rho: f64, t: usize) -> f64 {
        let weight = Window::Later(N as u32).push(&mut self.weights[..N], t, now);
        let least = Window::Least(N as u32).push(&mut self.least, t, rho);
        self.starts.push(now, t);
        self.starts.lower(rho);
        self.starts.forget((t + 1).saturating_sub(N));
        min(weight, least)
    }
}

/// `G[0,n] p && X[m] φ` with n < m from many starts: what `U` becomes if its bound does not begin at 0.
impl<const N: usize, const C: usize, const M: usize, const D: usize, P: State, A> Forward<Often>
    for And<Throughout<N, C, Now<P>>, Delay<M, D, A>>
where
    A: Forward<Often>,
{
    type Kept = (Holding<C>, <Delay<M, D, A> as Forward<Often>>::Kept);
    const NEW: Self::Kept = (Holding::NEW, <Delay<M, D, A> as Forward<Often>>::NEW);
    #[inline(always)]
    fn step(kept: &mut Self::Kept, now: f64, later: f64, row: &mut impl Rows<1>) -> [f64; 2] {
        const { assert!(N < M, "X[m] starts after G[0,n] has ended") };
        let (([rho], t), (holding, (rest, weights, window))) = ((P::of(row), row.first()), kept);
        let held = holding.step::<N>(now, rho, t);
        let (ahead, bound) = (M - N, (M - N) as u32);
        let arrived = Window::Later(bound).push(&mut weights[..ahead], t, held);
        let coming = Window::Greatest(bound - 1).push(&mut window[..=ahead], t, held);
        let later = max(max(coming, holding.starts.best()), later);
        A::step(rest, arrived, later, row)
    }
}
