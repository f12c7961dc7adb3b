//! Many trajectories whose states of one instant lie side by side.

use core::array;

use super::{BLOCK, Backward, Block, Every, Predicates, Start, Typed};

/// Trajectories whose states of one instant lie side by side; whether all predicates were numbers.
/// Some trajectories are read together: their predicates and operators do not depend on each other.
#[inline]
pub(crate) fn by_time<S, P: Predicates<S> + Typed>(
    predicates: &P,
    states: &[S],
    robustness: &mut [f64],
) -> bool
where
    P::Formula: Backward<Start> + Backward<Every>,
{
    // One number for each operator is carried where each instant counts and no bound is there; then
    // trajectories are places of a vector.
    let every = size_of::<<P::Formula as Backward<Every>>::Carry>();
    let start = size_of::<<P::Formula as Backward<Start>>::Carry>();
    match every <= start {
        true => together::<Every, P::Formula, S, P>(predicates, states, robustness),
        false => together::<Start, P::Formula, S, P>(predicates, states, robustness),
    }
}

#[inline(always)]
fn together<M, F: Backward<M>, S, P: Predicates<S>>(
    predicates: &P,
    states: &[S],
    robustness: &mut [f64],
) -> bool {
    // What is carried of so many has to fit into the first-level cache, beside their states. Those of one
    // instant are read as one piece of memory, and the next piece lies far from it, so pieces are large:
    // 1.0 ns a state in pieces of 16 KB, and 1 to 6 in pieces of 2 KB.
    match size_of::<F::Carry>() {
        0..=16 => side_by_side::<M, F, S, P, 1024>(predicates, states, robustness),
        17..=64 => side_by_side::<M, F, S, P, 128>(predicates, states, robustness),
        65..=512 => side_by_side::<M, F, S, P, 16>(predicates, states, robustness),
        _ => side_by_side::<M, F, S, P, 1>(predicates, states, robustness),
    }
}

// Not inlined: of three frames, one is on the stack.
#[inline(never)]
fn side_by_side<M, F: Backward<M>, S, P: Predicates<S>, const W: usize>(
    predicates: &P,
    states: &[S],
    robustness: &mut [f64],
) -> bool {
    let (count, mut is_nan) = (robustness.len(), [0; BLOCK]);
    let length = states.len().checked_div(count).unwrap_or_default();
    for (i, robustness) in robustness.chunks_mut(W).enumerate() {
        let mut carry: [F::Carry; W] = array::from_fn(|_| F::END);
        let mut read = |first: usize, k: usize| {
            let rows = array::from_ref(&states[first * count + i * W + k]);
            let mut rows = Block { first, length, rows, predicates, is_nan: &mut is_nan };
            let [rho] = F::block(&mut carry[k], &mut rows);
            rho
        };
        // Backward within an instant too, so that memory is read in one direction.
        for first in (1..length).rev() {
            for k in (0..robustness.len()).rev() {
                read(first, k);
            }
        }
        for (k, rho) in robustness.iter_mut().enumerate() {
            *rho = if length > 0 { read(0, k) } else { f64::NEG_INFINITY };
        }
    }
    is_nan == [0; BLOCK]
}
