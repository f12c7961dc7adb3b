//! A part of a trajectory as a function of the numbers that are carried into it.
//!
//! From a block of states to the one before it, a formula without bounds carries one number for each
//! temporal operator. What a part makes of the numbers that come from behind it is a function of minima
//! and maxima, and such a function f of k numbers is known from what it gives where each of them is -∞ or
//! ∞: f(c) is the greatest, over all sets A of arguments, of the least of c_i with i in A and of f where
//! those in A are ∞ and the others -∞ (the normal form of a lattice polynomial; Birkhoff, "Lattice
//! Theory", 1967). So a part is read once, for 2^k corners side by side, and parts are put together
//! exactly.

use core::array;

use super::{BLOCK, Backward, Block, Carried, Every, Predicates, Typed, max, min};

/// What a part of a trajectory makes of the numbers that are carried into it from behind.
#[derive(Debug)]
pub(crate) struct Transfer {
    /// For each set of arguments that are ∞ while the others are -∞: the robustness at the first
    /// state, and the numbers that are carried on.
    corners: [[f64; 1 + MOST_CARRIED]; 1 << MOST_CARRIED],
    /// Whether a predicate was not a number.
    pub(crate) is_nan: bool,
}

/// A transfer function has up to so many arguments.
pub(crate) const MOST_CARRIED: usize = 3;

impl Transfer {
    /// Its values for the first `count` of these arguments.
    pub(crate) fn of(
        &self,
        count: usize,
        carried: &[f64; MOST_CARRIED],
    ) -> [f64; 1 + MOST_CARRIED] {
        let mut found = [f64::NEG_INFINITY; 1 + MOST_CARRIED];
        for (set, corner) in self.corners.iter().enumerate().take(1 << count) {
            let chosen = (0..count).filter(|i| set >> i & 1 == 1);
            let least = chosen.fold(f64::INFINITY, |least, i| min(carried[i], least));
            for (found, corner) in found.iter_mut().zip(corner) {
                *found = max(*found, min(*corner, least));
            }
        }
        found
    }
}

/// The transfer function of the states of a trajectory of `length` from instant `first` on.
#[inline]
pub(crate) fn transfer<S, P: Predicates<S> + Typed>(
    predicates: &P,
    rows: &[S],
    first: usize,
    length: usize,
) -> Transfer
where
    P::Formula: Backward<Every>,
{
    match <P::Formula as Backward<Every>>::Carry::COUNT {
        0 => corners::<P::Formula, S, P, 1>(predicates, rows, first, length),
        1 => corners::<P::Formula, S, P, 2>(predicates, rows, first, length),
        2 => corners::<P::Formula, S, P, 4>(predicates, rows, first, length),
        _ => corners::<P::Formula, S, P, 8>(predicates, rows, first, length),
    }
}

#[inline(always)]
fn corners<F: Backward<Every>, S, P: Predicates<S>, const K: usize>(
    predicates: &P,
    rows: &[S],
    start: usize,
    length: usize,
) -> Transfer {
    let mut is_nan = [0; BLOCK];
    let mut carries: [F::Carry; K] = array::from_fn(|set| {
        let (mut carry, mut i) = (F::END, 0);
        carry.each(&mut |number| {
            *number = if set >> i & 1 == 1 { f64::INFINITY } else { f64::NEG_INFINITY };
            i += 1;
        });
        carry
    });
    let mut corners = [[f64::NEG_INFINITY; 1 + MOST_CARRIED]; 1 << MOST_CARRIED];
    let (blocks, rest) = rows.as_chunks::<BLOCK>();
    for (i, row) in rest.iter().enumerate().rev() {
        let (first, rows) = (start + blocks.len() * BLOCK + i, array::from_ref(row));
        for (carry, corner) in carries.iter_mut().zip(&mut corners) {
            let mut rows = Block { first, length, rows, predicates, is_nan: &mut is_nan };
            [corner[0]] = F::block(carry, &mut rows);
        }
    }
    for (i, rows) in blocks.iter().enumerate().rev() {
        let first = start + i * BLOCK;
        for (carry, corner) in carries.iter_mut().zip(&mut corners) {
            let mut rows = Block { first, length, rows, predicates, is_nan: &mut is_nan };
            [corner[0], ..] = F::block(carry, &mut rows);
        }
    }
    for (carry, corner) in carries.iter_mut().zip(&mut corners) {
        let mut places = corner[1..].iter_mut();
        carry.each(&mut |number| {
            if let Some(place) = places.next() {
                *place = *number;
            }
        });
    }
    Transfer { corners, is_nan: is_nan != [0; BLOCK] }
}
