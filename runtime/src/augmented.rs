//! The FSA-augmented MDP (paper, Definition 3): states (s, q) of a world and an automaton.
//!
//! [`Augmented`] runs any environment beside any [`Monitor`]. [`Labelled`] is the same for finite
//! worlds as tables: world states that no automaton state tells apart share a class, so that
//! learners and solvers evaluate no predicate in their loops.
//!
//! The automaton reads *every* state, `s_0` included: `q_0' = δ(q_0, s_0)` on reset, which pays
//! nothing and may already be accepted or lost, then `q_{t+1} = δ(q_t, s_{t+1})`. (The paper's
//! Eq. 3A2 moves on `s` and its Eq. 3A3 pays on `s'`; read literally a goal is paid twice.)
//! Reaching the accepting state or the trap terminates, and so does the environment's own end; a
//! horizon truncates. What a step pays is in [`reward`](crate::reward).

mod joint;
mod label;
mod moves;

use rand::Rng;

pub(crate) use joint::Joint;
pub use label::{LabelError, Labelled};
pub(crate) use label::{LabelTable, Payment};
pub(crate) use moves::Moves;

use crate::env::{Env, Step};
use crate::episode::{Monitored, Move};
use crate::monitor::Monitor;
use crate::reward::{End, Rewards};
use crate::task::Error;

/// Any environment beside any task: an environment over (s, q).
///
/// A predicate that is not a number at a state is an error, so its methods are those of [`Env`] with
/// a `Result`.
///
/// ```
/// use tltl::augmented::Augmented;
/// use tltl::prelude::*;
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// /// A counter that every action raises by one.
/// struct Counter(u32);
///
/// impl Env for Counter {
///     type State = u32;
///     fn actions(&self) -> usize {
///         1
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> u32 {
///         self.0 = 0;
///         0
///     }
///     fn step<R: Rng + ?Sized>(&mut self, _: usize, _: &mut R) -> Step<u32> {
///         self.0 += 1;
///         Step::to(self.0)
///     }
/// }
///
/// let three = tltl! { |s: &u32| F ({ *s } == 3) };
/// let mut world = Augmented::new(Counter(0), three, Rewards::acceptance());
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// world.reset(&mut rng)?;
/// let rewards = [1, 2, 3].map(|_| world.step(0, &mut rng).map(|step| step.reward));
/// assert_eq!(rewards, [Ok(0.0), Ok(0.0), Ok(1.0)]);
/// assert!(world.end().is_some());
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Augmented<E, M> {
    env: E,
    monitor: M,
    moves: Moves,
    q: u32,
}

impl<E: Env, M: Monitor<E::State>> Augmented<E, M> {
    /// `env` under the task `monitor`.
    ///
    /// The environment and the task are moved in; give references to keep them (`&task` is a
    /// [`Monitor`] too). Call [`Self::reset`] before the first step: until then the automaton has
    /// read nothing, and the first step would be read as an s_0.
    pub fn new(env: E, monitor: M, rewards: Rewards) -> Self {
        let moves = Moves::new(&monitor, rewards);
        Self { env, monitor, moves, q: 0 }
    }

    /// Starts an episode: the state s_0 and the automaton state that has read it. The episode may
    /// be over already; see [`Self::end`].
    ///
    /// # Errors
    /// If a predicate is not a number at s_0.
    pub fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<(E::State, u32), Error> {
        let state = self.env.reset(rng);
        self.q = self.monitor.next(0, &state)?;
        Ok((state, self.q))
    }

    /// Takes an action. The reward is that of the augmented MDP, the environment's own part
    /// included; the step is terminated where the task or the environment ended.
    ///
    /// # Errors
    /// If a predicate is not a number at s'.
    pub fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<(E::State, u32)>, Error> {
        let step = self.env.step(action, rng);
        let Move { to, reward, over } = self.moves.read(&self.monitor, self.q, &step)?;
        self.q = to;
        Ok(Step { state: (step.state, to), reward, terminated: over, truncated: step.truncated })
    }

    /// How the task has ended, if it has.
    pub fn end(&self) -> Option<End> {
        self.moves.ends().end(self.q)
    }

    /// The automaton state.
    ///
    /// ```
    /// use tltl::augmented::Augmented;
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
    ///
    /// // Two rooms and a door that never fails. Leave, and come back.
    /// let rooms = model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]);
    /// let there_and_back = tltl! { |s: &usize| ({ *s } == 1) T ({ *s } == 0) };
    /// let mut world = Augmented::new(ModelEnv::new(rooms).unwrap(), &there_and_back, Rewards::progress());
    /// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    /// let (mut room, _) = world.reset(&mut rng)?;
    /// while world.end().is_none() {
    ///     room = world.step(0, &mut rng)?.state.0;
    /// }
    /// assert_eq!((room, world.q(), world.monitor().is_accepting(world.q())), (0, 2, true));
    /// assert!((1..=2).contains(&world.env().steps()), "one if the episode starts in the other room");
    /// # Ok::<(), tltl::task::Error>(())
    /// ```
    pub const fn q(&self) -> u32 {
        self.q
    }

    /// The environment.
    pub const fn env(&self) -> &E {
        &self.env
    }

    /// The task.
    pub const fn monitor(&self) -> &M {
        &self.monitor
    }
}

/// Its states as they are. The loop of episodes holds q itself: reset before stepping by hand again.
impl<E: Env, M: Monitor<E::State>> Monitored for Augmented<E, M> {
    type State = E::State;
    type Error = Error;

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<E::State, Error> {
        Ok(self.env.reset(rng))
    }

    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<E::State>, Error> {
        Ok(self.env.step(action, rng))
    }

    fn read(&self, q: u32, step: &Step<E::State>) -> Result<Move, Error> {
        self.moves.read(&self.monitor, q, step)
    }
}
