//! Policies of continuous actions, played and counted.

use alloc::vec::Vec;

use rand::Rng;

use super::{Estimate, Tally, Trials, end};
use crate::env::{ContinuousEnv, Step};
use crate::monitor::Monitor;
use crate::task::Error;

/// What an episode went through.
///
/// [`play`] makes it. Its states are a trajectory: their
/// [robustness](crate::monitor::Monitor) says by how much the task was satisfied, or missed.
#[derive(Clone, Debug, PartialEq)]
pub struct Played<S> {
    /// The states, s_0 first.
    pub states: Vec<S>,
    /// The automaton state after each of them.
    pub q: Vec<u32>,
}

impl<S> Played<S> {
    /// The number of steps that were taken.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.states.len() as u64 - 1
    }

    /// The automaton state in which the episode ended.
    #[must_use]
    pub fn last(&self) -> u32 {
        self.q[self.q.len() - 1]
    }
}

/// Plays one episode of a policy, `act(q, s)`, until the task is decided, the world ends it, or
/// `horizon` steps have been taken.
///
/// ```
/// use tltl::env::{ContinuousEnv, Step};
/// use tltl::estimate::play;
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
/// use tltl::{Acceptor, tltl};
///
/// /// A cart on a rail, in metres; the action is its speed, in metres for each step.
/// struct Cart(f32);
///
/// impl ContinuousEnv for Cart {
///     type State = f32;
///     fn bounds(&self) -> Vec<(f32, f32)> {
///         vec![(-0.5, 0.5)]
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 {
///         self.0 = 0.0;
///         self.0
///     }
///     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
///         self.0 += action[0];
///         Step::to(self.0)
///     }
/// }
///
/// let task = tltl! { |x: &f32| F ({ *x } > 0.8) };
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// let right = |_: u32, _: &f32| Ok::<_, tltl::task::Error>(vec![0.5]);
/// let played = play(&mut Cart(0.0), &task, 100, &mut rng, right)?;
/// assert_eq!((&played.states[..], played.steps()), (&[0.0, 0.5, 1.0][..], 2));
/// assert!(task.is_accepting(played.last()));
/// // By 0.2 m; in f64, as the literals of the formula are.
/// assert!((task.robustness(&played.states)? - 0.2).abs() < 1e-6);
/// # Ok::<(), tltl::task::Error>(())
/// ```
///
/// # Errors
/// If a predicate is not a number at a state that was met, or the first error of `act`; no step is
/// taken then.
pub fn play<E: ContinuousEnv, M: Monitor<E::State>, R: Rng + ?Sized, F: From<Error>>(
    env: &mut E,
    monitor: &M,
    horizon: u64,
    rng: &mut R,
    act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, F>,
) -> Result<Played<E::State>, F> {
    let first = env.reset(rng);
    play_from(first, monitor, horizon, act, |_, action| env.step(action, rng))
}

/// Plays one episode from a first state, in a world that takes step t by `step(t, action)`.
pub(crate) fn play_from<S, M: Monitor<S>, F: From<Error>>(
    first: S,
    monitor: &M,
    horizon: u64,
    mut act: impl FnMut(u32, &S) -> Result<Vec<f32>, F>,
    mut step: impl FnMut(u64, &[f32]) -> Step<S>,
) -> Result<Played<S>, F> {
    let (mut now, mut states, mut all, mut q) = (Step::to(first), Vec::new(), Vec::new(), 0);
    loop {
        q = monitor.next(q, &now.state)?;
        let (t, over) = (states.len() as u64, now.terminated || now.truncated);
        let over = over || monitor.is_terminal(q) || t == horizon;
        let action = if over { None } else { Some(act(q, &now.state)?) };
        states.push(now.state);
        all.push(q);
        match action {
            Some(action) => now = step(t, &action),
            None => return Ok(Played { states, q: all }),
        }
    }
}

/// [`estimate`](super::estimate()) for a policy of continuous actions.
///
/// # Errors
/// As [`play`].
pub fn estimate_continuous<E: ContinuousEnv, M: Monitor<E::State>, R, F>(
    env: &mut E,
    monitor: &M,
    trials: Trials,
    rng: &mut R,
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, F>,
) -> Result<Estimate, F>
where
    R: Rng + ?Sized,
    F: From<Error>,
{
    let mut tally = Tally::new(trials);
    for _ in 0..trials.episodes() {
        let played = play(env, monitor, trials.horizon(), rng, &mut act)?;
        tally.count(end(monitor, played.last()), played.steps());
    }
    Ok(tally.fixed())
}
