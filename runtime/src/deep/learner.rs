//! The deep learner: acts, remembers, learns.

use burn::tensor::Device;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::fmt;
use std::vec::Vec;

use super::model::{Batch, Descent, Model, Moments};
use super::popart::PopArt;
use super::replay::Replay;
use super::settings::Settings;
use super::trainer::{Heads, Optimum, Trainer, bounds};
use super::{Error, Goals, Skill};
use crate::augmented::Moves;
use crate::env::{Env, Step, below, unit};
use crate::learn::episode::{self, Agent, Done, Move, Seen, World};
use crate::monitor::Monitor;
use crate::network::{Dense, Features, Invalid, Network, Shape};
use crate::q::argmax;
use crate::task;

/// A double-DQN learner of one skill.
pub struct Learner<S, M, F, G> {
    skill: Skill<M, F, G>,
    moves: Moves,
    core: Core<S>,
    rng: Xoshiro256PlusPlus,
    done: Done,
}

impl<S, M, F, G> fmt::Debug for Learner<S, M, F, G> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Learner")
            .field("settings", &self.core.settings)
            .field("done", &self.done)
            .finish_non_exhaustive()
    }
}

/// All that learning changes, but for the random generator.
struct Core<S> {
    settings: Settings,
    actions: usize,
    /// The actions that exploration draws from, each as often as it is listed.
    explored: Vec<u32>,
    /// For each automaton state the most that its task pays from there on.
    most: Vec<f64>,
    /// The least and the largest that the environment has paid, 0 included.
    paid: (f64, f64),
    trainer: Trainer,
    replay: Replay<S>,
    single: Batch,
}

/// The learner while it plays.
struct Playing<'a, S, M, F, G> {
    skill: &'a Skill<M, F, G>,
    moves: &'a Moves,
    core: &'a mut Core<S>,
    /// Environment steps, the one that is being taken included.
    steps: u64,
    /// Why no action could be chosen.
    failure: Option<Error>,
}

/// An environment beside the task of a skill.
struct Beside<'a, E, M> {
    env: &'a mut E,
    task: &'a M,
    moves: &'a Moves,
}

impl<S, E: Env<State = S>, M: Monitor<S>> World for Beside<'_, E, M> {
    type State = S;
    type Error = task::Error;

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<S, task::Error> {
        Ok(self.env.reset(rng))
    }

    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<S>, task::Error> {
        Ok(self.env.step(action, rng))
    }

    fn read(&self, q: u32, s: &S) -> Result<Move, task::Error> {
        self.moves.read(self.task, q, s)
    }
}

impl<S, M, F, G> Agent for Playing<'_, S, M, F, G>
where
    S: Clone,
    M: Monitor<S>,
    F: Features<S>,
    G: Goals<S>,
{
    type State = S;
    type Error = Error;

    fn start(&mut self, s: &S) {
        self.core.replay.start(s.clone());
    }

    /// ε-greedy.
    fn act<R: Rng + ?Sized>(&mut self, s: &S, q: u32, steps: u64, rng: &mut R) -> usize {
        self.steps = steps + 1;
        if unit(rng) < self.core.settings.epsilon.at(steps) {
            return self.core.explored[below(self.core.explored.len(), rng)] as usize;
        }
        let values = self.core.values(&self.skill.features, q, s);
        values.map_or_else(
            |error| {
                self.failure = Some(error);
                0
            },
            |values| argmax(&values) as usize,
        )
    }

    /// Remembers the step, and makes an update if it is time for one.
    fn learn<W: World<State = S, Error: Into<Error>>, R: Rng + ?Sized>(
        &mut self,
        _: &W,
        seen: &Seen<'_, S>,
        rng: &mut R,
    ) -> Result<(), Error> {
        if let Some(failure) = self.failure.take() {
            return Err(failure);
        }
        let core = &mut *self.core;
        if !seen.paid.is_finite() {
            return Err(Error::Reward(self.steps));
        }
        let paid = core.settings.rewards.environment * seen.paid;
        core.paid = (core.paid.0.min(paid), core.paid.1.max(paid));
        let (action, to) = (seen.action as u32, seen.to.clone());
        core.replay.push(seen.q, action, seen.paid, seen.terminated, to);
        let Settings { warmup, steps_per_update, .. } = core.settings;
        if self.steps < warmup || !self.steps.is_multiple_of(steps_per_update.max(1)) {
            return Ok(());
        }
        let Skill { task, features, goals } = self.skill;
        let bounds = bounds(&core.most, &core.settings, core.paid);
        let objective = Optimum { task, moves: self.moves, bounds: &bounds };
        let from = (features, goals);
        core.trainer.update(&mut core.replay, from, &objective, &core.settings, rng)?;
        Ok(())
    }
}

impl<S> Core<S> {
    /// Q(s, q, ·); zeros where the task is decided.
    fn values(&mut self, features: &impl Features<S>, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        let Some(head) = self.trainer.heads.of(q) else {
            return Ok(std::vec![0.0; self.actions]);
        };
        self.single.clear();
        self.single.push(features, s).map_err(Error::Feature)?;
        let values = self.trainer.values(&self.trainer.model, &self.single);
        Ok(values[head * self.actions..][..self.actions].to_vec())
    }
}

impl<S, M, F, G> Learner<S, M, F, G>
where
    S: Clone,
    M: Monitor<S>,
    F: Features<S>,
    G: Goals<S>,
{
    /// A learner of `skill` with `actions` actions on `device`, seeded.
    ///
    /// # Panics
    /// If no state of the task's automaton is live, or there are more entities than actions.
    pub fn new(
        skill: Skill<M, F, G>,
        actions: usize,
        settings: Settings,
        device: &Device,
        seed: u64,
    ) -> Self {
        let moves = Moves::new(&skill.task, settings.rewards, settings.gamma);
        let heads = Heads::new(&moves, skill.task.states());
        assert!(!heads.states.is_empty(), "a task that is decided from the start");
        let shape = Shape::of(&skill.features, &settings.hidden, heads.states.len(), actions);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let network = Network::random(shape, &mut rng);
        let core = Core {
            trainer: Trainer::new(Model::new(&network, device), heads, settings.normalisation),
            replay: Replay::new(settings.capacity),
            explored: (0..actions as u32).collect(),
            most: moves.most(&skill.task),
            paid: (0.0, 0.0),
            settings,
            actions,
            single: Batch::default(),
        };
        Self { skill, moves, core, rng, done: Done::default() }
    }

    /// The same learner, which explores by drawing from `actions`, each as often as it is listed.
    /// (By default all are as likely, which wastes exploration where most actions are of one kind.)
    ///
    /// # Panics
    /// If the list is empty or has what is no action.
    #[must_use]
    pub fn exploring(mut self, actions: Vec<u32>) -> Self {
        let all = actions.iter().all(|&a| (a as usize) < self.core.actions);
        assert!(!actions.is_empty() && all, "exploration draws from the world's actions");
        self.core.explored = actions;
        self
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it. Gives up early if 100,000 episodes in a row are over at
    /// their very first state.
    ///
    /// # Errors
    /// If a predicate, a feature, a reward or the loss is not a finite number.
    pub fn train<E: Env<State = S>>(&mut self, env: &mut E, total: u64) -> Result<(), Error> {
        assert_eq!(env.actions(), self.core.actions, "a learner stays with its world");
        let Self { skill, moves, core, rng, done } = self;
        let horizon = core.settings.horizon;
        let mut world = Beside { env, task: &skill.task, moves };
        let mut agent = Playing { skill, moves, core, steps: done.steps, failure: None };
        episode::run(&mut world, &mut agent, done, horizon, total, rng)
    }

    /// The greedy action in (s, q); any where the task is decided.
    ///
    /// # Errors
    /// If a feature is not a finite number.
    pub fn act(&mut self, q: u32, s: &S) -> Result<usize, Error> {
        Ok(argmax(&self.values(q, s)?) as usize)
    }

    /// Q(s, q, ·); zeros where the task is decided.
    ///
    /// # Errors
    /// If a feature is not a finite number.
    pub fn values(&mut self, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        self.core.values(&self.skill.features, q, s)
    }

    /// The network; its heads are the automaton's live states, in order.
    ///
    /// # Errors
    /// If learning has diverged so far that a weight is infinite or not a number.
    pub fn network(&self) -> Result<Network, Invalid> {
        self.core.trainer.network()
    }

    /// The skill.
    pub const fn skill(&self) -> &Skill<M, F, G> {
        &self.skill
    }

    /// The settings.
    pub const fn settings(&self) -> &Settings {
        &self.core.settings
    }

    /// What was seen.
    pub const fn replay(&self) -> &Replay<S> {
        &self.core.replay
    }

    /// Environment steps so far.
    pub const fn steps(&self) -> u64 {
        self.done.steps
    }

    /// Episodes so far.
    pub const fn episodes(&self) -> u64 {
        self.done.episodes
    }

    /// Updates of the network so far.
    pub const fn updates(&self) -> u64 {
        self.core.trainer.updates
    }

    /// All that learning has changed.
    pub fn checkpoint(&self) -> Checkpoint<S> {
        Checkpoint {
            settings: self.core.settings.clone(),
            explored: self.core.explored.clone(),
            paid: self.core.paid,
            shape: self.core.trainer.model.shape().clone(),
            network: self.core.trainer.model.dense(),
            target: self.core.trainer.target.dense(),
            moments: self.core.trainer.descent.moments(),
            popart: self.core.trainer.popart.clone(),
            updates: self.core.trainer.updates,
            replay: self.core.replay.clone(),
            rng: self.rng.clone(),
            done: self.done,
        }
    }

    /// A learner that goes on as the one would have that the checkpoint is of: between episodes, on
    /// the same kind of device, with the same numbers.
    ///
    /// # Errors
    /// If the checkpoint, or the moments in it, are of a network of another shape: that shape.
    pub fn resume(
        skill: Skill<M, F, G>,
        checkpoint: Checkpoint<S>,
        device: &Device,
    ) -> Result<Self, Shape> {
        let Checkpoint { settings, shape, network, target, .. } = &checkpoint;
        let moves = Moves::new(&skill.task, settings.rewards, settings.gamma);
        let heads = Heads::new(&moves, skill.task.states());
        let actions = shape.actions;
        let wanted = Shape::of(&skill.features, &settings.hidden, heads.states.len(), actions);
        let model = |layers| Model::resume(wanted.clone(), layers, device);
        let fit = checkpoint.moments.as_ref().is_none_or(|moments| moments.fit(network));
        let (true, true, Some(model), Some(target)) =
            (*shape == wanted, fit, model(network), model(target))
        else {
            return Err(shape.clone());
        };
        let mut trainer = Trainer::new(model, heads, settings.normalisation);
        trainer.target = target;
        if let Some(moments) = &checkpoint.moments {
            trainer.descent = Descent::resume(moments, device);
        }
        (trainer.popart, trainer.updates) = (checkpoint.popart, checkpoint.updates);
        let core = Core {
            most: moves.most(&skill.task),
            paid: checkpoint.paid,
            settings: checkpoint.settings,
            actions,
            explored: checkpoint.explored,
            trainer,
            replay: checkpoint.replay,
            single: Batch::default(),
        };
        Ok(Self { skill, moves, core, rng: checkpoint.rng, done: checkpoint.done })
    }
}

/// All that learning changes, to be saved and resumed; see [`Learner::checkpoint`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<S> {
    settings: Settings,
    explored: Vec<u32>,
    paid: (f64, f64),
    shape: Shape,
    network: Vec<Dense>,
    target: Vec<Dense>,
    moments: Option<Moments>,
    popart: PopArt,
    updates: u64,
    replay: Replay<S>,
    rng: Xoshiro256PlusPlus,
    done: Done,
}
