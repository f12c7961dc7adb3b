//! Dense tables of action values Q(s, q, a), and the policies that are greedy in them.
//!
//! Learners fill a [`QTable`] from experience, the solver from a model, and compositions from the
//! tables of skills. The index is (q, s, a), with a last, because a backup reads all actions of a
//! pair at once.

use alloc::vec::Vec;

use crate::augmented::Labelled;
use crate::mismatch::Mismatch;
use crate::policy::Policy;

/// Action values for each automaton state q, world state s and action a of a task.
///
/// Rows of terminal automaton states are 0. Where an action is chosen, ties go to the lowest number.
///
/// ```
/// use tltl::prelude::*;
///
/// let task = Labelled::new(0..5, ["left", "right"], &tltl! { |x: &i32| F ({ *x } == 4) })?;
/// let mut table = QTable::zeros(&task);
/// table.row_mut(0, 3)[1] = 0.5;
/// assert_eq!((table.max(0, 3), table.greedy(0, 3)), (0.5, 1));
/// assert_eq!(table.policy().act(0, 3), 1);
/// # Ok::<(), tltl::augmented::LabelError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct QTable {
    task: Labelled,
    /// Indexed `((q * states) + s) * actions + a`.
    values: Vec<f64>,
}

impl QTable {
    /// A table of zeros.
    #[must_use]
    #[inline]
    pub fn zeros(task: &Labelled) -> Self {
        Self { values: alloc::vec![0.0; task.pairs() * task.actions()], task: task.clone() }
    }

    /// A table of `value` in all live automaton states: an optimistic start is one that no true
    /// value exceeds, and makes a greedy learner try everything.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// let task = Labelled::new(0..5, ["left", "right"], &tltl! { |x: &i32| F ({ *x } == 4) })?;
    /// let table = QTable::filled(&task, 1.0);
    /// assert_eq!((table.max(0, 2), table.max(1, 2)), (1.0, 0.0)); // q = 1 accepts
    /// # Ok::<(), tltl::augmented::LabelError>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn filled(task: &Labelled, value: f64) -> Self {
        let mut table = Self::zeros(task);
        let size = task.states() * task.actions();
        for q in task.live() {
            table.values[q as usize * size..][..size].fill(value);
        }
        table
    }

    /// The table of these `values`, indexed `((q * states) + s) * actions + a`: what
    /// [`Self::values`] gave, or what another program computed.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// let task = Labelled::new(0..5, ["left", "right"], &tltl! { |x: &i32| F ({ *x } == 4) })?;
    /// let table = QTable::from_values(&task, vec![0.5; 2 * 5 * 2])?;
    /// assert_eq!(table.row(0, 3), [0.5, 0.5]);
    /// let error = QTable::from_values(&task, vec![0.5; 7]).unwrap_err();
    /// assert!(error.to_string().starts_with("a table of 7 values does not fit"));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is not one value for each q, s and a.
    #[inline]
    pub fn from_values(task: &Labelled, values: Vec<f64>) -> Result<Self, Mismatch> {
        if values.len() != task.pairs() * task.actions() {
            let found = alloc::format!("{} values", values.len());
            return Err(Mismatch::new("a table", found, task.describe()));
        }
        Ok(Self { task: task.clone(), values })
    }

    /// The task that the values are for.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// All values, indexed `((q * states) + s) * actions + a`.
    #[inline]
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, to change them.
    #[inline]
    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Q(s, q, ·).
    ///
    /// # Panics
    /// If there is no such automaton state or state.
    #[inline]
    #[must_use]
    pub fn row(&self, q: u32, s: usize) -> &[f64] {
        let actions = self.task.actions();
        &self.values[self.task.pair(q, s) * actions..][..actions]
    }

    /// Q(s, q, ·), to change it.
    ///
    /// # Panics
    /// If there is no such automaton state or state.
    #[inline]
    pub fn row_mut(&mut self, q: u32, s: usize) -> &mut [f64] {
        let actions = self.task.actions();
        &mut self.values[self.task.pair(q, s) * actions..][..actions]
    }

    /// V(s, q): the largest value of an action.
    ///
    /// # Panics
    /// If there is no such automaton state or state.
    #[inline]
    #[must_use]
    pub fn max(&self, q: u32, s: usize) -> f64 {
        largest(self.row(q, s))
    }

    /// The action of the largest value; of equal ones that with the lowest number.
    ///
    /// # Panics
    /// If there is no such automaton state or state.
    #[inline]
    #[must_use]
    pub fn greedy(&self, q: u32, s: usize) -> usize {
        argmax(self.row(q, s))
    }

    /// The greedy policy: in each (q, s) the action of the largest value.
    #[must_use]
    #[inline]
    pub fn policy(&self) -> Policy {
        let rows = self.values.chunks(self.task.actions());
        Policy::from_table(&self.task, rows.map(|row| argmax(row) as u32).collect())
    }

    /// All (q, s, Q(s, q, ·)), to change them.
    #[inline]
    pub(crate) fn rows_mut(&mut self) -> impl Iterator<Item = (u32, usize, &mut [f64])> {
        let (states, actions) = (self.task.states(), self.task.actions());
        let rows = self.values.chunks_mut(actions).enumerate();
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

/// The larger of two. Branch prediction cannot guess which one it is, so this must not become a
/// branch.
#[inline]
fn more(a: f64, b: f64) -> f64 {
    core::hint::select_unpredictable(a > b, a, b)
}

#[inline]
fn largest_of(values: &[f64]) -> f64 {
    values.iter().fold(f64::NEG_INFINITY, |best, &v| if v > best { v } else { best })
}

/// The index of the smallest number, the lowest of equals, and the number. Nobody can predict which one it
/// is, so it must not become a branch.
#[inline(always)]
pub(crate) fn least(numbers: &[u32]) -> (usize, u32) {
    let smaller = |(best, least): (usize, u32), (i, &n): (usize, &u32)| {
        let best = core::hint::select_unpredictable(n < least, i, best);
        (best, core::hint::select_unpredictable(n < least, n, least))
    };
    numbers.iter().enumerate().fold((0, u32::MAX), smaller)
}

/// The index of the largest value, the lowest of equals: ties break the same way everywhere.
#[inline]
pub(crate) fn argmax<T: PartialOrd>(values: &[T]) -> usize {
    let mut best = 0;
    for (i, v) in values.iter().enumerate() {
        if *v > values[best] {
            best = i;
        }
    }
    best
}
