//! Episodes: the one loop that every learner runs in.
//!
//! A [`Monitored`] world is an environment beside an automaton, an [`Agent`] acts and learns in it,
//! and [`run`] brings them together: s_0 is read, then act, step, read, learn, until the task or the
//! environment ends or the horizon is reached. States are whatever the world says: numbers for
//! tables ([`Learner`](crate::learn::Learner), [`TrajectoryLearner`](crate::learn::TrajectoryLearner)), an
//! environment's own states for anything else; an [`Augmented`](crate::augmented::Augmented)
//! environment is a monitored world as it is. Actions are numbers where they can be counted, and
//! vectors in a [`ContinuousEnv`](crate::env::ContinuousEnv).
//!
//! The loop alone holds q; a world only says where any q goes, so that an agent can learn from one
//! step what every automaton state would have learned (counterfactual updates, Toro Icarte et al.
//! 2018).

use rand::Rng;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::env::Step;

/// Episodes in a row that are over at reset before [`run`] gives up: a task that is decided at every
/// start would run for ever. Where one start in a thousand is not decided, the chance of giving up
/// by mistake is e^-100.
const IDLE: u32 = 100_000;

/// Where one step leads an automaton state, and what the step pays there.
///
/// ```
/// use tltl::augmented::Augmented;
/// use tltl::env::Step;
/// use tltl::episode::{Monitored, Move};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let still = ModelEnv::new(model::from_fn(3, 1, |s, _| [(s, 1.0)])).unwrap();
/// let task = tltl! { |s: &usize| F ({ *s } == 2) };
/// let world = Augmented::new(still, task, Rewards::acceptance());
/// assert_eq!(world.read(0, &Step::to(1))?, Move { to: 0, reward: 0.0, over: false });
/// assert_eq!(world.read(0, &Step::to(2))?, Move { to: 1, reward: 1.0, over: true });
/// # Ok::<(), tltl::task::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The next automaton state, q' = δ(q, s').
    pub to: u32,
    /// The reward of the step in the augmented MDP, the environment's own part included.
    pub reward: f64,
    /// Whether nothing can be had from (s', q') on: the task has ended there, or the environment.
    pub over: bool,
}

/// An environment beside an automaton: what episodes are run in.
///
/// [`Augmented`](crate::augmented::Augmented) is one for any environment and task; implement it for
/// worlds that read a state more cheaply than by predicates, as the tables of learners do. `read` must
/// not change the world, for it is asked about moves that are not taken.
pub trait Monitored<A = usize> {
    /// What an agent tells situations apart by, beside q.
    type State;
    /// Why a state cannot be read: a predicate is not a number there. `Infallible` for tables.
    type Error;

    /// Starts an episode: s_0.
    ///
    /// # Errors
    /// As the world says.
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<Self::State, Self::Error>;

    /// Takes an action. The step's reward is the environment's own, as the environment pays it.
    ///
    /// # Errors
    /// As the world says.
    fn step<R: Rng + ?Sized>(
        &mut self,
        action: A,
        rng: &mut R,
    ) -> Result<Step<Self::State>, Self::Error>;

    /// What a step does at any automaton state `q`, not only the current one: counterfactual
    /// updates ask for all. The first state of an episode is read as a step that pays nothing.
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number at the state of the step.
    fn read(&self, q: u32, step: &Step<Self::State>) -> Result<Move, Self::Error>;
}

/// One step of the augmented MDP: (s, q), a, (s', q') and the reward.
///
/// States are borrowed: an agent that keeps them clones what it needs, others pay nothing.
#[derive(Debug)]
pub struct Transition<'a, S, A = usize> {
    /// The automaton state before.
    pub q: u32,
    /// The state before.
    pub s: &'a S,
    /// The action.
    pub action: A,
    /// What the environment gave: s', its own reward, and whether it ended.
    pub step: &'a Step<S>,
    /// What the step did at q, and what it paid there.
    pub read: Move,
}

/// What acts and learns.
///
/// An agent that cannot choose an action says so by an error, and then no step is taken.
///
/// Here one that learns nothing and always takes the same action:
///
/// ```
/// use tltl::augmented::Augmented;
/// use tltl::episode::{self, Agent, Elapsed, Monitored, Transition};
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// struct Always(usize);
///
/// impl Agent for Always {
///     type State = usize;
///     type Error = tltl::task::Error;
///
///     fn act<R: Rng + ?Sized>(
///         &mut self,
///         _: u32,
///         _: &usize,
///         _: u64,
///         _: &mut R,
///     ) -> Result<usize, Self::Error> {
///         Ok(self.0)
///     }
///
///     fn learn<W: Monitored<State = usize, Error: Into<Self::Error>>, R: Rng + ?Sized>(
///         &mut self,
///         _: &W,
///         transition: &Transition<'_, usize>,
///         _: &mut R,
///     ) -> Result<(), Self::Error> {
///         println!("{} -> {}", transition.s, transition.step.state);
///         Ok(())
///     }
/// }
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let end = tltl! { |s: &usize| F ({ *s } == 4) };
/// let mut world = Augmented::new(ModelEnv::new(row).unwrap(), end, Rewards::default());
/// let (mut elapsed, mut rng) = (Elapsed::default(), Xoshiro256PlusPlus::seed_from_u64(1));
/// episode::run(&mut world, &mut Always(1), &mut elapsed, 100, 1_000, &mut rng)?;
/// assert!(elapsed.steps >= 1_000 && elapsed.steps <= 4 * elapsed.episodes);
/// # Ok::<(), tltl::task::Error>(())
/// ```
pub trait Agent<A = usize> {
    /// What it tells situations apart by, beside q.
    type State;
    /// Why it cannot go on: at least what stops its worlds.
    type Error;

    /// An episode starts in `s`.
    fn start(&mut self, _s: &Self::State) {}

    /// The action in `s` at `q`, after `steps` environment steps.
    ///
    /// # Errors
    /// If it cannot choose. No step is taken then.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        s: &Self::State,
        steps: u64,
        rng: &mut R,
    ) -> Result<A, Self::Error>;

    /// Learns from a transition in `world`.
    ///
    /// # Errors
    /// If it asks the world something that the world cannot say, or cannot go on itself.
    fn learn<W: Monitored<A, State = Self::State, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        world: &W,
        transition: &Transition<'_, Self::State, A>,
        rng: &mut R,
    ) -> Result<(), Self::Error>;
}

/// How much was done: what training in slices goes on from.
///
/// Saved with a learner, so that exploration and step sizes that depend on the number of steps go on
/// where they stood.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Elapsed {
    /// Environment steps.
    pub steps: u64,
    /// Episodes that were run to their end.
    pub episodes: u64,
}

/// Runs whole episodes of at most `horizon` steps until `total` environment steps have been taken,
/// those of `elapsed` included; the last episode may exceed it by less than the horizon. An episode
/// that the horizon cuts is truncated: its last step is learned like any other.
///
/// Gives up early if 100,000 episodes in a row are over at their very first state.
///
/// # Errors
/// Those of the world and of the agent.
// Forced, as `episode` is: a call would keep the agent and the random generator in memory, and a step of
// the tabular learner would take a third longer.
#[inline(always)]
pub fn run<A, W, L, R>(
    world: &mut W,
    agent: &mut L,
    elapsed: &mut Elapsed,
    horizon: u64,
    total: u64,
    rng: &mut R,
) -> Result<(), L::Error>
where
    A: Clone,
    W: Monitored<A, Error: Into<L::Error>>,
    L: Agent<A, State = W::State>,
    R: Rng + ?Sized,
{
    let mut idle = 0;
    while elapsed.steps < total && idle < IDLE {
        let mut steps = elapsed.steps;
        let result = episode(world, agent, &mut steps, horizon, rng);
        idle = if steps == elapsed.steps { idle + 1 } else { 0 };
        // Counted before an error is passed on: the steps were taken.
        elapsed.steps = steps;
        result?;
        elapsed.episodes += 1;
    }
    Ok(())
}

/// One episode; adds its environment steps to `steps`.
#[inline(always)]
fn episode<A, W, L, R>(
    world: &mut W,
    agent: &mut L,
    steps: &mut u64,
    horizon: u64,
    rng: &mut R,
) -> Result<(), L::Error>
where
    A: Clone,
    W: Monitored<A, Error: Into<L::Error>>,
    L: Agent<A, State = W::State>,
    R: Rng + ?Sized,
{
    let mut at = Step::to(world.reset(rng).map_err(Into::into)?);
    agent.start(&at.state);
    let Move { to: mut q, over, .. } = world.read(0, &at).map_err(Into::into)?;
    if over {
        return Ok(());
    }
    // One counter for both.
    let end = steps.saturating_add(horizon);
    while *steps < end {
        let action = agent.act(q, &at.state, *steps, rng)?;
        let step = world.step(action.clone(), rng).map_err(Into::into)?;
        *steps += 1;
        let read = world.read(q, &step).map_err(Into::into)?;
        agent.learn(world, &Transition { q, s: &at.state, action, step: &step, read }, rng)?;
        let last = read.over || step.truncated;
        (at, q) = (step, read.to);
        if last {
            break;
        }
    }
    Ok(())
}
