//! Many trajectories at once: one step of each.

use core::borrow::Borrow;

use super::{Error, Reader, Task};
use crate::robustness::{Predicates, letter};

/// The states whose predicates are evaluated before any of them moves: the predicates of a block do
/// not depend on each other, so they are computed several at once.
const BLOCK: usize = 64;

impl<P> Task<P> {
    /// Moves many automaton states, each on a state of its own world: `q[i] = δ(q[i], states[i])`.
    ///
    /// # Errors
    /// If a predicate is not a number: [`Error::instant`] is the place in `states`. The states before
    /// it have moved, the others have not.
    ///
    /// # Panics
    /// If `q` and `states` differ in length, or one of `q` is not a state of the automaton: some of
    /// those before it have then moved.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
    /// let mut q = [0, 1, 1];
    /// task.step_batch(&mut q, &[5.0, 5.0, 0.0])?;
    /// assert_eq!(q, [1, 1, 2]);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[track_caller]
    pub fn step_batch<S>(&self, q: &mut [u32], states: &[S]) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        assert_eq!(q.len(), states.len(), "a state of the world for each of the automaton");
        self.reader().step_batch::<S, &S>(q, |i| &states[i])
    }

    /// The same, where `state(i)` makes state i: from columns, say, which need not become rows in
    /// memory first.
    ///
    /// # Errors
    /// As [`step_batch`](Self::step_batch).
    ///
    /// # Panics
    /// If one of `q` is not a state of the automaton.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// struct Robot { x: f64, y: f64 }
    /// let task = tltl! { |s: &Robot| F (s.x > 3 && s.y < 1) };
    /// let (x, y) = ([0.0, 4.0, 5.0], [0.0, 0.0, 2.0]);
    /// let mut q = [0; 3];
    /// task.step_batch_of(&mut q, |i| Robot { x: x[i], y: y[i] })?;
    /// assert_eq!(q, [0, 1, 0]);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    pub fn step_batch_of<S>(&self, q: &mut [u32], state: impl Fn(usize) -> S) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        self.reader().step_batch::<S, S>(q, state)
    }
}

impl<P: Copy> Reader<'_, P> {
    #[inline]
    fn step_batch<S, B: Borrow<S>>(
        &self,
        q: &mut [u32],
        state: impl Fn(usize) -> B,
    ) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        for (block, q) in q.chunks_mut(BLOCK).enumerate() {
            let first = block * BLOCK;
            if self.is_generated && P::DENSE > 0 {
                let (mut letters, mut any) = ([0; BLOCK], false);
                let letters = &mut letters[..q.len()];
                for (i, to) in letters.iter_mut().enumerate() {
                    let (letter, is_nan) = letter(&self.predicates, state(first + i).borrow());
                    *to = letter;
                    any |= is_nan;
                }
                if !any {
                    // Asked of all before any moves, so that the moves have no branch.
                    self.automaton.expect_state(q.iter().copied().fold(0, u32::max));
                    let moves = q.iter_mut().zip(letters);
                    moves.for_each(|(q, letter)| {
                        *q = self.automaton.of_letter(*q, (*letter).into())
                    });
                    continue;
                }
            }
            for (i, q) in q.iter_mut().enumerate() {
                let moved = self.next(*q, state(first + i).borrow());
                *q = moved.map_err(|error| Error { instant: Some(first + i), ..error })?;
            }
        }
        Ok(())
    }
}
