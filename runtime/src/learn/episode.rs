//! Episodes: the one loop that every learner runs in.
//!
//! A [`World`] is an environment beside an automaton, an [`Agent`] what acts and learns in it, and
//! [`run`] brings them together: s_0 is read, then act, step, read, learn, until the task or the
//! environment ends or the horizon is reached. States are whatever the world says: numbers for
//! tables ([`Learner`](super::Learner), [`WholeLearner`](super::WholeLearner)), an environment's own
//! states for anything else; an [`Augmented`](crate::augmented::Augmented) environment is a world as it is.
//!
//! The loop alone holds q; a world only says where any q goes, so that an agent can learn from one
//! step what every automaton state would have (counterfactual updates, Toro Icarte et al. 2018).

use rand::Rng;
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::env::Step;

/// Episodes in a row that are over at reset before [`run`] gives up.
const IDLE: u32 = 100_000;

/// Where reading a state leads an automaton state, and what the task pays for it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Move {
    /// The next automaton state, q' = δ(q, s').
    pub to: u32,
    /// What the task pays.
    pub paid: f64,
    /// Whether the task ends at q', accomplished or lost: nothing can be had from there on.
    pub over: bool,
}

/// An environment beside an automaton: what episodes are run in.
pub trait World {
    /// What an agent tells situations apart by, beside q.
    type State;
    /// Why a state cannot be read: a predicate is not a number there. `Infallible` for tables.
    type Error;

    /// Starts an episode: s_0.
    ///
    /// # Errors
    /// As the world says.
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<Self::State, Self::Error>;

    /// Takes an action. The step's reward is what is paid whatever the automaton state; what the
    /// task pays says [`Self::read`].
    ///
    /// # Errors
    /// As the world says.
    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<Self::State>, Self::Error>;

    /// What reading `s` does at any automaton state `q`, not only the current one: counterfactual
    /// updates ask for all.
    ///
    /// # Errors
    /// If a predicate that decides the move is not a number at `s`.
    fn read(&self, q: u32, s: &Self::State) -> Result<Move, Self::Error>;
}

/// One step of a world, as it was seen.
#[derive(Debug)]
pub struct Seen<'a, S> {
    /// The state before.
    pub s: &'a S,
    /// The automaton state before.
    pub q: u32,
    /// The action.
    pub action: usize,
    /// The state after, s'.
    pub to: &'a S,
    /// What q did on reading s'.
    pub read: Move,
    /// What was paid whatever the automaton state; the reward is this and `read.paid`.
    pub paid: f64,
    /// Whether the environment ended: nothing can be had from s' on, at no automaton state.
    pub terminated: bool,
}

/// What acts and learns.
pub trait Agent {
    /// What it tells situations apart by, beside q.
    type State;
    /// Why it cannot go on: at least what stops its worlds.
    type Error;

    /// An episode starts in `s`.
    fn start(&mut self, _s: &Self::State) {}

    /// The action in `s` at `q`, after `steps` environment steps.
    fn act<R: Rng + ?Sized>(&mut self, s: &Self::State, q: u32, steps: u64, rng: &mut R) -> usize;

    /// Learns from a step of `world`.
    ///
    /// # Errors
    /// If it asks the world something that the world cannot say, or cannot go on itself.
    fn learn<W: World<State = Self::State, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        world: &W,
        seen: &Seen<'_, Self::State>,
        rng: &mut R,
    ) -> Result<(), Self::Error>;
}

/// How much was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Done {
    /// Environment steps.
    pub steps: u64,
    /// Episodes.
    pub episodes: u64,
}

/// Runs whole episodes of at most `horizon` steps until `total` environment steps have been taken,
/// those of `done` included; the last episode may exceed it by less than the horizon. An episode
/// that the horizon cuts is truncated: its last step is learned like any other.
///
/// Gives up early if 100,000 episodes in a row are over at their very first state.
///
/// # Errors
/// Those of the world and of the agent.
#[inline]
pub fn run<W: World<Error: Into<A::Error>>, A: Agent<State = W::State>, R: Rng + ?Sized>(
    world: &mut W,
    agent: &mut A,
    done: &mut Done,
    horizon: u32,
    total: u64,
    rng: &mut R,
) -> Result<(), A::Error> {
    let mut idle = 0;
    while done.steps < total && idle < IDLE {
        let steps = episode(world, agent, done.steps, horizon, rng)?;
        done.episodes += 1;
        idle = if steps == done.steps { idle + 1 } else { 0 };
        done.steps = steps;
    }
    Ok(())
}

/// One episode, begun after `steps` environment steps; their number after it.
#[inline(always)]
fn episode<W: World<Error: Into<A::Error>>, A: Agent<State = W::State>, R: Rng + ?Sized>(
    world: &mut W,
    agent: &mut A,
    mut steps: u64,
    horizon: u32,
    rng: &mut R,
) -> Result<u64, A::Error> {
    let mut s = world.reset(rng).map_err(Into::into)?;
    agent.start(&s);
    let Move { to: mut q, over, .. } = world.read(0, &s).map_err(Into::into)?;
    if over {
        return Ok(steps);
    }
    for _ in 0..horizon {
        let action = agent.act(&s, q, steps, rng);
        let step = world.step(action, rng).map_err(Into::into)?;
        let Step { state: to, reward: paid, terminated, truncated } = step;
        steps += 1;
        let read = world.read(q, &to).map_err(Into::into)?;
        let seen = Seen { s: &s, q, action, to: &to, read, paid, terminated };
        agent.learn(world, &seen, rng)?;
        (s, q) = (to, read.to);
        if read.over || terminated || truncated {
            break;
        }
    }
    Ok(steps)
}
