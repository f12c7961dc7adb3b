//! The deep learner: acts, remembers, learns.

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use serde::{Deserialize, Serialize};
use std::vec::Vec;

use super::model::{Batch, Descent, Model, Moments};
use super::popart::PopArt;
use super::replay::Replay;
use super::settings::Settings;
use super::trainer::{Heads, Optimum, Trainer, bounds};
use super::{Error, Goals, Skill};
use crate::augmented::Moves;
use crate::env::{Env, below, unit};
use crate::network::{Dense, Features, Network, Shape};
use crate::q::argmax;
use crate::task::Monitor;

/// Episodes in a row that are over at reset before training gives up.
const IDLE: u32 = 100_000;

/// A double-DQN learner of one skill.
pub struct Learner<S, M, F, G> {
    skill: Skill<M, F, G>,
    settings: Settings,
    actions: usize,
    /// The actions that exploration draws from, each as often as it is listed.
    explored: Vec<u32>,
    moves: Moves,
    /// For each automaton state the most that its task pays from there on.
    most: Vec<f64>,
    /// The least and the largest that the environment has paid, 0 included.
    paid: (f64, f64),
    trainer: Trainer,
    replay: Replay<S>,
    rng: Xoshiro256PlusPlus,
    steps: u64,
    episodes: u64,
    single: Batch,
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
        Self {
            trainer: Trainer::new(Model::new(&network, device), heads, settings.normalisation),
            replay: Replay::new(settings.capacity),
            explored: (0..actions as u32).collect(),
            most: moves.most(&skill.task),
            paid: (0.0, 0.0),
            moves,
            skill,
            settings,
            actions,
            rng,
            steps: 0,
            episodes: 0,
            single: Batch::default(),
        }
    }

    /// The same learner, which explores by drawing from `actions`, each as often as it is listed.
    /// (By default all are as likely, which wastes exploration where most actions are of one kind.)
    ///
    /// # Panics
    /// If the list is empty or has what is no action.
    #[must_use]
    pub fn exploring(mut self, actions: Vec<u32>) -> Self {
        let all = actions.iter().all(|&a| (a as usize) < self.actions);
        assert!(!actions.is_empty() && all, "exploration draws from the world's actions");
        self.explored = actions;
        self
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it. Gives up early if 100,000 episodes in a row are over at
    /// their very first state.
    ///
    /// # Errors
    /// If a predicate, a feature, a reward or the loss is not a finite number.
    pub fn train<E: Env<State = S>>(&mut self, env: &mut E, total: u64) -> Result<(), Error> {
        assert_eq!(env.actions(), self.actions, "a learner stays with its world");
        let mut idle = 0;
        while self.steps < total && idle < IDLE {
            let before = self.steps;
            self.episode(env)?;
            idle = if self.steps == before { idle + 1 } else { 0 };
        }
        Ok(())
    }

    fn episode<E: Env<State = S>>(&mut self, env: &mut E) -> Result<(), Error> {
        let mut s = env.reset(&mut self.rng);
        let mut q = self.skill.task.next(0, &s)?;
        self.episodes += 1;
        self.replay.start(s.clone(), q);
        for _ in 0..self.settings.horizon {
            if self.moves.end(q).is_some() {
                break;
            }
            let a = self.explore(q, &s)?;
            let step = env.step(a, &mut self.rng);
            if !step.reward.is_finite() {
                return Err(Error::Reward(self.steps));
            }
            let paid = self.settings.rewards.environment * step.reward;
            self.paid = (self.paid.0.min(paid), self.paid.1.max(paid));
            q = self.skill.task.next(q, &step.state)?;
            s = step.state;
            self.replay.push(a as u32, step.reward, step.terminated, s.clone(), q);
            self.steps += 1;
            self.learn()?;
            if step.terminated || step.truncated {
                break;
            }
        }
        self.replay.end();
        Ok(())
    }

    /// ε-greedy.
    fn explore(&mut self, q: u32, s: &S) -> Result<usize, Error> {
        if unit(&mut self.rng) < self.settings.epsilon.at(self.steps) {
            return Ok(self.explored[below(self.explored.len(), &mut self.rng)] as usize);
        }
        self.act(q, s)
    }

    /// An update, if it is time for one.
    fn learn(&mut self) -> Result<(), Error> {
        let Settings { warmup, steps_per_update, .. } = self.settings;
        if self.steps < warmup || !self.steps.is_multiple_of(steps_per_update.max(1)) {
            return Ok(());
        }
        let Skill { task, features, goals } = &self.skill;
        let bounds = bounds(&self.most, &self.settings, self.paid);
        let objective = Optimum { task, moves: &self.moves, bounds: &bounds };
        let (replay, settings) = (&mut self.replay, &self.settings);
        self.trainer.update(replay, (features, goals), &objective, settings, &mut self.rng)?;
        Ok(())
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
        let Some(head) = self.trainer.heads.of(q) else {
            return Ok(std::vec![0.0; self.actions]);
        };
        self.single.clear();
        self.single.push(&self.skill.features, s).map_err(Error::Feature)?;
        let values = self.trainer.values(&self.trainer.model, &self.single);
        Ok(values[head * self.actions..][..self.actions].to_vec())
    }

    /// The network; its heads are the automaton's live states, in order.
    #[must_use]
    pub fn network(&self) -> Network {
        self.trainer.network()
    }

    /// The skill.
    pub const fn skill(&self) -> &Skill<M, F, G> {
        &self.skill
    }

    /// The settings.
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What was seen.
    pub const fn replay(&self) -> &Replay<S> {
        &self.replay
    }

    /// Environment steps so far.
    pub const fn steps(&self) -> u64 {
        self.steps
    }

    /// Episodes so far.
    pub const fn episodes(&self) -> u64 {
        self.episodes
    }

    /// Updates of the network so far.
    pub const fn updates(&self) -> u64 {
        self.trainer.updates
    }

    /// All that learning has changed.
    pub fn checkpoint(&self) -> Checkpoint<S> {
        Checkpoint {
            settings: self.settings.clone(),
            explored: self.explored.clone(),
            paid: self.paid,
            shape: self.trainer.model.shape().clone(),
            network: self.trainer.model.dense(),
            target: self.trainer.target.dense(),
            moments: self.trainer.descent.moments(),
            popart: self.trainer.popart.clone(),
            updates: self.trainer.updates,
            replay: self.replay.clone(),
            rng: self.rng.clone(),
            steps: self.steps,
            episodes: self.episodes,
        }
    }

    /// A learner that goes on as the one would have that the checkpoint is of: between episodes, on
    /// the same kind of device, with the same numbers.
    ///
    /// # Errors
    /// If the checkpoint is of a network of another shape.
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
        let (true, Some(model), Some(target)) = (*shape == wanted, model(network), model(target))
        else {
            return Err(shape.clone());
        };
        let mut trainer = Trainer::new(model, heads, settings.normalisation);
        trainer.target = target;
        if let Some(moments) = &checkpoint.moments {
            trainer.descent = Descent::resume(moments, device);
        }
        (trainer.popart, trainer.updates) = (checkpoint.popart, checkpoint.updates);
        Ok(Self {
            most: moves.most(&skill.task),
            skill,
            settings: checkpoint.settings,
            actions,
            explored: checkpoint.explored,
            paid: checkpoint.paid,
            moves,
            trainer,
            replay: checkpoint.replay,
            rng: checkpoint.rng,
            steps: checkpoint.steps,
            episodes: checkpoint.episodes,
            single: Batch::default(),
        })
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
    steps: u64,
    episodes: u64,
}
