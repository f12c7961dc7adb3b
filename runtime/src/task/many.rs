//! The robustness of many trajectories at once, and of long ones in several threads.

use super::{Error, Task};
use crate::robustness::Predicates;
#[cfg(feature = "std")]
use crate::robustness::typed::Carried;
#[cfg(feature = "std")]
use crate::robustness::typed::split::{MOST_CARRIED, transfer};
use crate::robustness::typed::{Backward, Every, Start, Typed, by_time};

impl<P> Task<P> {
    /// The robustness of many trajectories of one length, which lie one after the other: trajectory i
    /// is the i-th part of `states`, of as many parts as `robustness` has places.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which place in `states`.
    ///
    /// # Panics
    /// If `states` cannot be cut into so many trajectories.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| F ({ *x } > 3) };
    /// let mut robustness = [0.0; 2];
    /// task.robustness_batch(&[1.0, 5.0, 2.0, 0.0, 1.0, 2.5], &mut robustness)?;
    /// assert_eq!(robustness, [2.0, -0.5]);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[track_caller]
    pub fn robustness_batch<S>(&self, states: &[S], robustness: &mut [f64]) -> Result<(), Error>
    where
        P: Predicates<S>,
    {
        let length = length(states, robustness);
        let mut found = Ok(());
        // Backward through all of them, as through each: the next states are then those before in memory.
        for (i, rho) in robustness.iter_mut().enumerate().rev() {
            let first = i * length;
            match self.robustness(&states[first..][..length]) {
                Ok(of_one) => *rho = of_one,
                Err(error) => {
                    let instant = error.instant.map(|t| first + t);
                    found = Err(Error { instant, ..error });
                }
            }
        }
        found
    }

    /// The same where the states of one instant lie side by side: state t of trajectory i is
    /// `states[t * n + i]` of n trajectories, as simulators that step many worlds write them.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which place in `states`.
    ///
    /// # Panics
    /// If `states` cannot be cut into so many trajectories, or the task was put together of predicates
    /// and another formula, by [`Task::new`].
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| F ({ *x } > 3) };
    /// let mut robustness = [0.0; 2];
    /// task.robustness_batch_by_time(&[1.0, 0.0, 5.0, 1.0, 2.0, 2.5], &mut robustness)?;
    /// assert_eq!(robustness, [2.0, -0.5]);
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    #[track_caller]
    pub fn robustness_batch_by_time<S>(
        &self,
        states: &[S],
        robustness: &mut [f64],
    ) -> Result<(), Error>
    where
        P: Predicates<S> + Typed,
        P::Formula: Backward<Start> + Backward<Every>,
    {
        assert!(self.is_generated, "the predicates were generated with another formula");
        length(states, robustness);
        match by_time(&self.predicates, states, robustness) {
            true => Ok(()),
            false => Err(self.reader().first_not_a_number(states)),
        }
    }

    /// The robustness of a whole trajectory in several threads: that of [`robustness`](Self::robustness).
    ///
    /// For up to three unbounded temporal operators each thread reads a part; other formulas are read by
    /// one thread.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which instant.
    ///
    /// ```
    /// use tltl::tltl;
    ///
    /// let task = tltl! { |x: &f64| ({ *x } < 9) U ({ *x } > 3) };
    /// let walk: Vec<f64> = (0..10_000).map(|i| f64::from(i % 700) / 100.0).collect();
    /// assert_eq!(task.robustness_on(4, &walk), task.robustness(&walk));
    /// ```
    #[cfg(feature = "std")]
    pub fn robustness_on<S: Sync>(&self, threads: usize, trajectory: &[S]) -> Result<f64, Error>
    where
        P: Predicates<S> + Typed + Sync,
        P::Formula: Backward<Every>,
    {
        let count = <P::Formula as Backward<Every>>::Carry::COUNT;
        let part = trajectory.len().div_ceil(threads.max(1)).max(LEAST);
        if !self.is_generated || count > MOST_CARRIED || part >= trajectory.len() {
            return self.robustness(trajectory);
        }
        let predicates = &self.predicates;
        let parts: std::vec::Vec<_> = std::thread::scope(|scope| {
            let parts = trajectory.chunks(part).enumerate().map(|(i, states)| {
                let (first, length) = (i * part, trajectory.len());
                scope.spawn(move || transfer(predicates, states, first, length))
            });
            let parts: std::vec::Vec<_> = parts.collect();
            parts.into_iter().map(joined).collect()
        });
        let mut carried = [f64::NEG_INFINITY; MOST_CARRIED];
        let mut whole = f64::NEG_INFINITY;
        for part in parts.iter().rev() {
            [whole, carried[0], carried[1], carried[2]] = part.of(count, &carried);
        }
        let is_nan = parts.iter().any(|part| part.is_nan);
        if is_nan { Err(self.reader().first_not_a_number(trajectory)) } else { Ok(whole) }
    }

    /// [`robustness_batch`](Self::robustness_batch) in several threads, each for a part of the
    /// trajectories.
    ///
    /// # Errors
    /// If a predicate is not a number: which, and at which place in `states`.
    ///
    /// # Panics
    /// If `states` cannot be cut into so many trajectories.
    #[cfg(feature = "std")]
    #[track_caller]
    pub fn robustness_batch_on<S: Sync>(
        &self,
        threads: usize,
        states: &[S],
        robustness: &mut [f64],
    ) -> Result<(), Error>
    where
        P: Predicates<S> + Sync,
    {
        let length = length(states, robustness);
        let part = robustness.len().div_ceil(threads.max(1)).max(1);
        let found: std::vec::Vec<_> = std::thread::scope(|scope| {
            let parts = robustness.chunks_mut(part).enumerate().map(|(i, robustness)| {
                let first = i * part * length;
                let states = &states[first..][..robustness.len() * length];
                let place = move |error: Error| Error {
                    instant: error.instant.map(|t| first + t),
                    ..error
                };
                scope.spawn(move || self.robustness_batch(states, robustness).map_err(place))
            });
            let parts: std::vec::Vec<_> = parts.collect();
            parts.into_iter().map(joined).collect()
        });
        found.into_iter().collect()
    }
}

/// What a thread has found; a panic of a predicate goes on here.
#[cfg(feature = "std")]
pub(super) fn joined<T>(thread: std::thread::ScopedJoinHandle<'_, T>) -> T {
    thread.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// A part for a thread has at least so many states: to start a thread takes some 20 µs.
#[cfg(feature = "std")]
pub(super) const LEAST: usize = 1 << 15;

/// The length of the trajectories.
#[track_caller]
fn length<S>(states: &[S], robustness: &[f64]) -> usize {
    let length = states.len().checked_div(robustness.len()).unwrap_or_default();
    assert_eq!(length * robustness.len(), states.len(), "trajectories of one length");
    length
}
