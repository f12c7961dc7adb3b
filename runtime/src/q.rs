//! Dense tables of action values Q(s, q, a), and the policies that are greedy in them.

use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::augmented::Labelled;

/// Action values indexed (q, s, a): `((q * states) + s) * actions + a`.
///
/// Rows of terminal automaton states are 0. Where an action is chosen, ties go to the lowest
/// index.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct QTable {
    values: Vec<f64>,
    states: usize,
    actions: usize,
}

impl QTable {
    /// A table of zeros for a task over a world with `actions` actions.
    #[must_use]
    pub fn zeros(labelled: &Labelled, actions: usize) -> Self {
        let values = alloc::vec![0.0; labelled.pairs() * actions];
        Self { values, states: labelled.states(), actions }
    }

    /// A table of `value` in all live automaton states: an optimistic start is one that no true
    /// value exceeds.
    #[must_use]
    pub fn filled(labelled: &Labelled, actions: usize, value: f64) -> Self {
        let mut table = Self::zeros(labelled, actions);
        for q in labelled.live() {
            table.layer_mut(q).fill(value);
        }
        table
    }

    /// The number of states of the world.
    #[inline]
    #[must_use]
    pub const fn states(&self) -> usize {
        self.states
    }

    /// The number of actions.
    #[inline]
    #[must_use]
    pub const fn actions(&self) -> usize {
        self.actions
    }

    /// The number of automaton states.
    #[must_use]
    pub fn automaton_states(&self) -> u32 {
        (self.values.len() / (self.states * self.actions)) as u32
    }

    /// All values, in the order of the index.
    #[inline]
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, to change them.
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Q(s, q, ·).
    #[inline]
    #[must_use]
    pub fn row(&self, q: u32, s: usize) -> &[f64] {
        let start = (q as usize * self.states + s) * self.actions;
        &self.values[start..start + self.actions]
    }

    /// Q(s, q, ·), to change it.
    #[inline]
    pub fn row_mut(&mut self, q: u32, s: usize) -> &mut [f64] {
        let start = (q as usize * self.states + s) * self.actions;
        &mut self.values[start..start + self.actions]
    }

    /// Q(·, q, ·), the values by which the sub-policy of `q` is chosen (paper, Eq. 3A5).
    #[must_use]
    pub fn layer(&self, q: u32) -> &[f64] {
        let size = self.states * self.actions;
        &self.values[q as usize * size..][..size]
    }

    fn layer_mut(&mut self, q: u32) -> &mut [f64] {
        let size = self.states * self.actions;
        &mut self.values[q as usize * size..][..size]
    }

    /// V(s, q): the largest value of an action.
    #[inline]
    #[must_use]
    pub fn max(&self, q: u32, s: usize) -> f64 {
        largest(self.row(q, s))
    }

    /// The action of the largest value.
    #[inline]
    #[must_use]
    pub fn greedy(&self, q: u32, s: usize) -> u32 {
        argmax(self.row(q, s))
    }

    /// The greedy policy, indexed `q * states + s`.
    #[must_use]
    pub fn policy(&self) -> Vec<u32> {
        self.values.chunks(self.actions).map(argmax).collect()
    }

    /// The table divided by its largest value, as before a composition (paper, Section 5.1); the
    /// same table if that is not positive.
    #[must_use]
    pub fn normalised(&self) -> Self {
        let top = largest(&self.values);
        let scale = if top > 0.0 { 1.0 / top } else { 1.0 };
        Self { values: self.values.iter().map(|v| v * scale).collect(), ..*self }
    }

    /// All (q, s, Q(s, q, ·)), to change them.
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = (u32, usize, &mut [f64])> {
        let (states, rows) = (self.states, self.values.chunks_mut(self.actions).enumerate());
        rows.map(move |(pair, row)| ((pair / states) as u32, pair % states, row))
    }
}

/// The largest of some values. Lengths that many worlds have are unrolled, for this is the inner loop
/// of learning; one after the other, for vector loads would wait for the scalar store of the last
/// update.
#[inline]
pub(crate) fn largest(values: &[f64]) -> f64 {
    match *values {
        [a, b, c, d] => more(more(more(a, b), c), d),
        [a, b, c, d, e] => more(more(more(more(a, b), c), d), e),
        _ => largest_of(values),
    }
}

/// The larger; which one it is cannot be guessed, so it is not to become a branch.
#[inline]
fn more(a: f64, b: f64) -> f64 {
    core::hint::select_unpredictable(a > b, a, b)
}

fn largest_of(values: &[f64]) -> f64 {
    values.iter().fold(f64::NEG_INFINITY, |best, &v| if v > best { v } else { best })
}

/// The index of the largest value, the lowest of equals.
#[inline]
pub(crate) fn argmax<T: PartialOrd>(values: &[T]) -> u32 {
    let mut best = 0;
    for (i, v) in values.iter().enumerate() {
        if *v > values[best] {
            best = i;
        }
    }
    best as u32
}
