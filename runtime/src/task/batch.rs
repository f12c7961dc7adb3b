//! Many trajectories at once: one step of each.

use core::borrow::Borrow;

#[cfg(feature = "std")]
use super::many::{LEAST, joined};
use super::{Error, Reader, Task};
use crate::robustness::{Predicates, letter};

/// Above this bit of a state of the automaton its letter is kept, between the pass that evaluates all
/// predicates and the one that moves. Each pass is a loop without a branch: the first is vectorised where
/// states come from columns, and no buffer is needed. Tables have up to 4,096 states and 1,024 letters.
const LETTER: u32 = 16;

impl<P> Task<P> {
    /// Moves many automaton states, each on a state of its own world: `q[i] = δ(q[i], states[i])`.
    ///
    /// # Errors
    /// If a predicate is not a number: [`Error::instant`] is the place in `states`. The states before
    /// it have moved, the others have not.
    ///
    /// # Panics
    /// If `q` and `states` differ in length, or one of `q` is not a state of the automaton.
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
    #[inline(always)]
    pub fn step_batch<S>(&self, q: &mut [u32], states: &[S]) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        assert_eq!(q.len(), states.len(), "a state of the world for each of the automaton");
        self.reader().step_batch::<S, &S>(q, |i| &states[i])
    }

    /// The same, where `state(i)` makes state i: from columns, say, which need not become rows in
    /// memory first. It is called once for each i, in their order, and again from the start if a
    /// predicate is not a number.
    ///
    /// rustc makes vector instructions of it if it sees that indices are in range: slice the columns,
    /// `&x[..q.len()]`, before the call.
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
    #[inline(always)]
    pub fn step_batch_of<S>(&self, q: &mut [u32], state: impl Fn(usize) -> S) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        self.reader().step_batch::<S, S>(q, state)
    }

    /// [`step_batch`](Self::step_batch) in several threads, each for a part of the states. It pays where
    /// predicates take long or the batch is larger than the caches: a thread starts in some 20 µs, and
    /// gets at least 32,768 states.
    ///
    /// # Errors
    /// If a predicate is not a number: [`Error::instant`] is the first such place in `states`. The
    /// states before it have moved; of those behind it, some may have.
    ///
    /// # Panics
    /// If `q` and `states` differ in length, or one of `q` is not a state of the automaton.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
    /// let (mut q, states) = (vec![0; 100_000], vec![5.0; 100_000]);
    /// task.step_batch_on(2, &mut q, &states)?;
    /// assert!(q.iter().all(|&q| q == 1));
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[cfg(feature = "std")]
    #[track_caller]
    #[inline]
    pub fn step_batch_on<S: Sync>(
        &self,
        threads: usize,
        q: &mut [u32],
        states: &[S],
    ) -> Result<(), Error>
    where
        P: Predicates<S> + Sync,
    {
        assert_eq!(q.len(), states.len(), "a state of the world for each of the automaton");
        let part = q.len().div_ceil(threads.max(1)).max(LEAST);
        let found: std::vec::Vec<_> = std::thread::scope(|scope| {
            let parts = q.chunks_mut(part).zip(states.chunks(part)).enumerate();
            let parts = parts.map(|(i, (q, states))| {
                let place = move |error: Error| Error {
                    instant: error.instant.map(|at| i * part + at),
                    ..error
                };
                scope.spawn(move || self.step_batch(q, states).map_err(place))
            });
            let parts: std::vec::Vec<_> = parts.collect();
            parts.into_iter().map(joined).collect()
        });
        found.into_iter().collect()
    }
}

impl<P: Copy> Reader<'_, P> {
    // Inlined, so that rustc sees where the states come from.
    #[inline(always)]
    fn step_batch<S, B: Borrow<S>>(
        &self,
        q: &mut [u32],
        state: impl Fn(usize) -> B,
    ) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        if self.is_generated && P::DENSE > 0 && self.automaton.tables().states < 1 << LETTER {
            self.automaton.expect_states(q);
            let mut any = false;
            for (i, q) in q.iter_mut().enumerate() {
                let (letter, is_nan) = letter(&self.predicates, state(i).borrow());
                *q |= (letter as u32) << LETTER;
                any |= is_nan;
            }
            if !any {
                self.automaton.move_by_kept(q, LETTER);
                return Ok(());
            }
            q.iter_mut().for_each(|q| *q &= (1 << LETTER) - 1);
        }
        self.one_by_one(q, state)
    }

    /// Until there is an error.
    #[inline(never)]
    fn one_by_one<S, B: Borrow<S>>(
        &self,
        q: &mut [u32],
        state: impl Fn(usize) -> B,
    ) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        for (i, q) in q.iter_mut().enumerate() {
            let moved = self.next(*q, state(i).borrow());
            *q = moved.map_err(|error| Error { instant: Some(i), ..error })?;
        }
        Ok(())
    }
}
