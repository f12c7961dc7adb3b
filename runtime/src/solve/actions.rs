//! Sets of actions, one for each pair.
//!
//! One bit for each action, for there is a set for each pair of a table: for a million cells, 8
//! automaton states and 5 actions they take 5 MB, where lists would take a pointer for each.

use alloc::vec::Vec;

/// For each pair (q, s) a set of actions, as bits.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Actions {
    bits: Vec<u64>,
    actions: usize,
}

impl Actions {
    /// No action anywhere.
    #[inline]
    pub(crate) fn none(pairs: usize, actions: usize) -> Self {
        Self { bits: alloc::vec![0; (pairs * actions).div_ceil(64)], actions }
    }

    /// Adds action `a` to the set of `pair`.
    #[inline]
    pub(crate) fn insert(&mut self, pair: usize, a: usize) {
        let at = pair * self.actions + a;
        self.bits[at / 64] |= 1 << (at % 64);
    }

    /// Takes action `a` from the set of `pair`; whether it was there.
    #[inline]
    pub(crate) fn remove(&mut self, pair: usize, a: usize) -> bool {
        let at = pair * self.actions + a;
        let was = self.contains(pair, a);
        self.bits[at / 64] &= !(1 << (at % 64));
        was
    }

    /// Whether action `a` is in the set of `pair`, which is `q * states + s`.
    #[inline]
    pub(crate) fn contains(&self, pair: usize, a: usize) -> bool {
        let at = pair * self.actions + a;
        self.bits[at / 64] >> (at % 64) & 1 == 1
    }

    /// The first action in the set of `pair`.
    #[inline]
    pub(crate) fn first(&self, pair: usize) -> Option<usize> {
        (0..self.actions).find(|&a| self.contains(pair, a))
    }
}
