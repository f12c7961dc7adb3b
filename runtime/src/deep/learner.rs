//! The deep learner: acts, remembers, learns.
//!
//! [`Learner`] runs in the loop of [`episode`], as tables do. It acts
//! ε-greedily by its network, puts every state into its [`Replay`], and after each few steps makes one
//! update (`trainer`). It never looks at the environment's model, and its task only through
//! [`Monitor`].

use burn::tensor::Device;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::string::{String, ToString};
use std::vec::Vec;

use super::layers::{AdamMoments, Optimiser};
use super::model::{Batch, Model};
use super::popart::PopArt;
use super::replay::Replay;
use super::sample::Heads;
use super::settings::Settings;
use super::trainer::{TaskObjective, Trainer, bounds, check_reward};
use super::{Error, Learned, Relabel, Skill};
use crate::augmented::Moves;
use crate::env::{Env, Step, below, unit};
use crate::learn::episode::{self, Agent, Elapsed, Monitored, Move, Transition};
use crate::mismatch::Mismatch;
use crate::monitor::{Acceptor, Monitor};
use crate::network::policy::{NetworkPolicy, NetworkPolicyError, NetworkTraining};
use crate::network::{Dense, Features, Network, NetworkError, Shape};
use crate::q::argmax;
use crate::task;

/// A double-DQN learner of one skill.
///
/// ```
/// use tltl::deep::{Device, Learner, Settings, Skill};
/// use tltl::model;
/// use tltl::network::Features;
/// use tltl::prelude::*;
///
/// /// What the network sees of a cell: where it is.
/// struct Place;
///
/// impl Features<usize> for Place {
///     fn inputs(&self) -> usize {
///         5
///     }
///     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) {
///         inputs[*s] = 1.0;
///     }
/// }
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let mut env = ModelEnv::new(row)?;
/// let skill = Skill::new(tltl! { |s: &usize| F ({ *s } == 4) }, Place);
/// let settings = Settings::default().with_hidden([16])?.with_batch(16)?.with_warmup(50)?;
/// let mut learner = Learner::new(skill, &env, settings, &Device::flex(), 1);
/// learner.train(&mut env, 1_000)?;
/// assert_eq!(learner.act(0, &3)?, 1);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// To watch or save it, train in slices; each call runs whole episodes.
pub struct Learner<S, M, F, G> {
    skill: Skill<M, F, G>,
    moves: Moves,
    core: Core<S>,
    rng: Xoshiro256PlusPlus,
    elapsed: Elapsed,
    seed: u64,
}

/// All that learning changes, but for the random generator.
///
/// Apart from the learner, so that it can be borrowed while the skill is read.
struct Core<S> {
    settings: Settings,
    /// What the actions are called.
    actions: Vec<String>,
    /// The actions that exploration draws from, each as often as it is listed.
    explored: Vec<usize>,
    /// For each automaton state the most that its task pays from there on.
    most: Vec<f64>,
    /// The least and the largest that the environment has paid, 0 included.
    paid: (f64, f64),
    trainer: Trainer,
    replay: Replay<S>,
    single: Batch,
}

impl<S, M: Monitor<S>, F, G> core::fmt::Debug for Learner<S, M, F, G> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Learner")
            .field("task", &self.skill.task.name())
            .field("shape", self.core.trainer.model.shape())
            .field("steps", &self.elapsed.steps)
            .finish_non_exhaustive()
    }
}

/// The learner while it plays.
struct Playing<'a, S, M, F, G> {
    skill: &'a Skill<M, F, G>,
    moves: &'a Moves,
    core: &'a mut Core<S>,
    /// Environment steps, the one that is being taken included.
    steps: u64,
}

/// An environment beside the task of a skill.
struct Beside<'a, E, M> {
    env: &'a mut E,
    task: &'a M,
    moves: &'a Moves,
}

impl<S, E: Env<State = S>, M: Monitor<S>> Monitored for Beside<'_, E, M> {
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

    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error> {
        self.moves.read(self.task, q, step)
    }
}

impl<S, M, F, G> Agent for Playing<'_, S, M, F, G>
where
    S: Clone,
    M: Monitor<S>,
    F: Features<S>,
    G: Relabel<S>,
{
    type State = S;
    type Error = Error;

    fn start(&mut self, s: &S) {
        self.core.replay.start(s.clone());
    }

    /// ε-greedy.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        s: &S,
        steps: u64,
        rng: &mut R,
    ) -> Result<usize, Error> {
        self.steps = steps + 1;
        if unit(rng) < self.core.settings.epsilon().at(steps) {
            return Ok(self.core.explored[below(self.core.explored.len(), rng)]);
        }
        Ok(argmax(&self.core.values(&self.skill.features, q, s)?))
    }

    /// Remembers the step, and makes an update if it is time for one.
    fn learn<W: Monitored<State = S, Error: Into<Error>>, R: Rng + ?Sized>(
        &mut self,
        _: &W,
        transition: &Transition<'_, S>,
        rng: &mut R,
    ) -> Result<(), Error> {
        let (core, &Transition { q, action, step, .. }) = (&mut *self.core, transition);
        if !step.reward.is_finite() {
            return Err(Error::Reward(self.steps));
        }
        // What cannot be learned from is not remembered.
        core.single.clear();
        core.single.push(&self.skill.features, &step.state).map_err(Error::Feature)?;
        let rewards = core.settings.rewards();
        let paid = rewards.environment() * step.reward;
        core.paid = (core.paid.0.min(paid), core.paid.1.max(paid));
        core.replay.push(q, action as u32, Step { state: step.state.clone(), ..*step });
        let (warmup, between) = (core.settings.warmup(), core.settings.steps_per_update());
        if self.steps < warmup || !self.steps.is_multiple_of(between) {
            return Ok(());
        }
        let Skill { task, features, goals } = self.skill;
        let bounds = bounds(&core.most, &rewards, core.paid);
        let objective = TaskObjective { task, moves: self.moves, bounds: &bounds };
        let from = (features, goals);
        core.trainer.update(&mut core.replay, from, &objective, &core.settings, rng)?;
        Ok(())
    }
}

impl<S> Core<S> {
    /// Q(s, q, ·); zeros where the task is decided.
    fn values(&mut self, features: &impl Features<S>, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        let Some(head) = self.trainer.heads.of(q) else {
            return Ok(std::vec![0.0; self.actions.len()]);
        };
        self.single.clear();
        self.single.push(features, s).map_err(Error::Feature)?;
        Ok(self.trainer.values_of(head, &self.single))
    }
}

impl<S, M, F, G> Learner<S, M, F, G>
where
    S: Clone,
    M: Monitor<S>,
    F: Features<S>,
    G: Relabel<S>,
{
    /// A learner of `skill` in a world with the actions of `env`, on `device`; all that is random
    /// comes from `seed`.
    ///
    /// # Panics
    /// If no state of the task's automaton is live, or there are more entities than actions.
    #[track_caller]
    pub fn new(
        skill: Skill<M, F, G>,
        env: &impl Env<State = S>,
        settings: Settings,
        device: &Device,
        seed: u64,
    ) -> Self {
        let moves = Moves::new(&skill.task, settings.rewards());
        let heads = Heads::new(&moves, skill.task.states());
        assert!(!heads.states.is_empty(), "a task that is not decided from the start");
        let actions = env.actions();
        let shape = Shape::of(&skill.features, settings.hidden(), heads.states.len(), actions);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let network = Network::random(shape, &mut rng);
        let core = Core {
            trainer: Trainer::new(Model::new(&network, device), heads, settings.normalisation()),
            replay: Replay::new(settings.capacity()),
            explored: (0..actions).collect(),
            most: moves.most(&skill.task),
            paid: (0.0, 0.0),
            settings,
            actions: names(env),
            single: Batch::default(),
        };
        Self { skill, moves, core, rng, elapsed: Elapsed::default(), seed }
    }

    /// The same learner, which explores by drawing from `actions`, each as often as it is listed.
    /// (By default all are as likely, which wastes exploration where most actions are of one kind.)
    ///
    /// ```
    /// use tltl::deep::{Device, Learner, Settings, Skill};
    /// use tltl::model;
    /// use tltl::network::Features;
    /// use tltl::prelude::*;
    /// # struct Place;
    /// # impl Features<usize> for Place {
    /// #     fn inputs(&self) -> usize { 5 }
    /// #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
    /// # }
    ///
    /// // Action 2 looks around and never moves. It is explored too, but half as often as the others.
    /// let row = model::from_fn(5, 3, |s, a| [([s.saturating_sub(1), (s + 1).min(4), s][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let skill = Skill::new(tltl! { |s: &usize| F ({ *s } == 4) }, Place);
    /// let settings = Settings::default().with_hidden([4])?;
    /// let learner = Learner::new(skill, &env, settings, &Device::flex(), 1);
    /// let mut learner = learner.exploring(vec![0, 0, 1, 1, 2]);
    /// learner.train(&mut env, 100)?; // no update before the warm-up of 1,000 steps
    /// assert!(learner.steps() >= 100 && learner.updates() == 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If the list is empty, or names an action that the world does not have.
    #[must_use]
    #[track_caller]
    pub fn exploring(mut self, actions: Vec<usize>) -> Self {
        let all = actions.iter().all(|&a| a < self.core.actions.len());
        assert!(!actions.is_empty() && all, "exploration draws from the world's actions");
        self.core.explored = actions;
        self
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it. Gives up early if 100,000 episodes in a row are over at
    /// their very first state.
    ///
    /// # Errors
    /// If the environment has other actions, the reward pays for moves and the automaton has a way back
    /// ([`Error::WayBack`]), or a predicate, a feature, a reward or the loss is not a finite number. Where
    /// no action can be chosen, no step is taken.
    pub fn train<E: Env<State = S>>(&mut self, env: &mut E, total: u64) -> Result<(), Error> {
        check_actions(env, self.core.actions.len())?;
        check_reward(&self.skill.task, &self.core.settings.rewards())?;
        let Self { skill, moves, core, rng, elapsed, .. } = self;
        let horizon = core.settings.horizon();
        let mut world = Beside { env, task: &skill.task, moves };
        let mut agent = Playing { skill, moves, core, steps: elapsed.steps };
        episode::run(&mut world, &mut agent, elapsed, horizon, total, rng)
    }

    /// The greedy action in (s, q); any where the task is decided.
    ///
    /// # Errors
    /// If a feature is not a finite number.
    pub fn act(&mut self, q: u32, s: &S) -> Result<usize, Error> {
        Ok(argmax(&self.values(q, s)?))
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
    pub fn network(&self) -> Result<Network, NetworkError> {
        self.core.trainer.network()
    }

    /// The skill as it was learned, to be composed with others.
    ///
    /// [`Composition`](super::Composition) shows its use.
    ///
    /// # Errors
    /// As [`Self::network`].
    pub fn learned(&self) -> Result<Learned<'_, S>, NetworkError>
    where
        M: Sync,
        F: Sync,
    {
        let Skill { task, features, .. } = &self.skill;
        Ok(Learned { network: self.network()?, features, task, experience: &self.core.replay })
    }

    /// The greedy policy so far, saying how it was learned: to be saved, and emitted as Rust.
    ///
    /// ```
    /// use tltl::deep::{Device, Learner, Settings, Skill};
    /// use tltl::model;
    /// use tltl::network::Features;
    /// use tltl::network::policy::NetworkPolicy;
    /// use tltl::prelude::*;
    /// # struct Place;
    /// # impl Features<usize> for Place {
    /// #     fn inputs(&self) -> usize { 5 }
    /// #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
    /// # }
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let skill = Skill::new(tltl! { |s: &usize| F ({ *s } == 4) }, Place);
    /// let settings = Settings::default().with_hidden([16])?.with_batch(16)?.with_warmup(50)?;
    /// let mut learner = Learner::new(skill, &env, settings, &Device::flex(), 1);
    /// learner.train(&mut env, 300)?;
    /// // It needs no tensor library from here on.
    /// let text = serde_json::to_string(&learner.policy()?)?;
    /// let policy: NetworkPolicy = serde_json::from_str(&text)?;
    /// let mut inputs = [0.0; 5];
    /// inputs[2] = 1.0;
    /// assert_eq!(policy.act(0, &inputs, &[]), learner.act(0, &2)?);
    /// assert_eq!(policy.document().training[0], learner.training());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::network`].
    pub fn policy(&self) -> Result<NetworkPolicy, NetworkPolicyError> {
        let actions = self.core.actions.clone();
        let policy = NetworkPolicy::new(&self.skill.task, actions, self.network()?)?;
        Ok(policy.trained(self.training()))
    }

    /// How the network was learned so far, as policies say it.
    pub fn training(&self) -> NetworkTraining {
        NetworkTraining {
            task: self.skill.task.name().into(),
            steps: self.steps(),
            episodes: self.episodes(),
            updates: self.updates(),
            gamma: self.core.settings.rewards().gamma(),
            seed: self.seed,
        }
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
    ///
    /// ```
    /// use tltl::deep::{Device, Learner, Settings, Skill};
    /// use tltl::model;
    /// use tltl::network::Features;
    /// use tltl::prelude::*;
    /// # struct Place;
    /// # impl Features<usize> for Place {
    /// #     fn inputs(&self) -> usize { 5 }
    /// #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
    /// # }
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let skill = Skill::new(tltl! { |s: &usize| F ({ *s } == 4) }, Place);
    /// let settings = Settings::default().with_hidden([4])?.with_capacity(64)?;
    /// let mut learner = Learner::new(skill, &env, settings, &Device::flex(), 1);
    /// assert!(learner.replay().is_empty());
    /// learner.train(&mut env, 200)?;
    /// assert_eq!(learner.replay().len(), 64, "the last 64 states");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub const fn replay(&self) -> &Replay<S> {
        &self.core.replay
    }

    /// Environment steps so far.
    pub const fn steps(&self) -> u64 {
        self.elapsed.steps
    }

    /// Episodes so far.
    pub const fn episodes(&self) -> u64 {
        self.elapsed.episodes
    }

    /// Updates of the network so far.
    pub const fn updates(&self) -> u64 {
        self.core.trainer.updates
    }

    /// All that learning has changed, to be saved.
    ///
    /// ```
    /// use tltl::deep::{Checkpoint, Device, Learner, Settings, Skill};
    /// use tltl::model;
    /// use tltl::network::Features;
    /// use tltl::prelude::*;
    /// # #[derive(Clone, Copy)]
    /// # struct Place;
    /// # impl Features<usize> for Place {
    /// #     fn inputs(&self) -> usize { 5 }
    /// #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
    /// # }
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let (mut env, device) = (ModelEnv::new(row)?, Device::flex());
    /// let end = tltl! { |s: &usize| F ({ *s } == 4) };
    /// let settings = Settings::default().with_hidden([8])?.with_batch(8)?.with_warmup(50)?;
    /// let mut learner = Learner::new(Skill::new(&end, Place), &env, settings, &device, 1);
    /// learner.train(&mut env, 200)?;
    /// let text = serde_json::to_string(&learner.checkpoint())?;
    /// let saved: Checkpoint<usize> = serde_json::from_str(&text)?;
    /// let mut resumed = Learner::resume(Skill::new(&end, Place), &env, saved, &device)?;
    /// learner.train(&mut env.clone(), 300)?;
    /// resumed.train(&mut env, 300)?;
    /// assert_eq!(learner.checkpoint(), resumed.checkpoint());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn checkpoint(&self) -> Checkpoint<S>
    where
        S: Clone,
    {
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
            done: self.elapsed,
            task: Some(TaskName::of(&self.skill.task)),
            seed: self.seed,
        }
    }

    /// A learner of `skill` in the world of `env` that goes on as the one would have that the
    /// checkpoint is of: between episodes, on the same kind of device, with the same numbers.
    ///
    /// # Errors
    /// If the checkpoint is of another task or world, or of a network of another shape.
    pub fn resume(
        skill: Skill<M, F, G>,
        env: &impl Env<State = S>,
        checkpoint: Checkpoint<S>,
        device: &Device,
    ) -> Result<Self, Mismatch> {
        let Checkpoint { settings, shape, network, target, .. } = &checkpoint;
        let moves = Moves::new(&skill.task, settings.rewards());
        let heads = Heads::new(&moves, skill.task.states());
        check_actions(env, shape.actions)?;
        let (live, actions) = (heads.states.len(), shape.actions);
        let wanted = Shape::of(&skill.features, settings.hidden(), live, actions);
        let own = TaskName::of(&skill.task);
        let same = checkpoint.task.as_ref().is_none_or(|task| task.formula == own.formula);
        let model = |layers| Model::resume(wanted.clone(), layers, device);
        let fit = checkpoint.moments.as_ref().is_none_or(|moments| moments.fit(network));
        let (true, true, true, Some(model), Some(target)) =
            (same, *shape == wanted, fit, model(network), model(target))
        else {
            let found = checkpoint.task.as_ref().map_or("a task", |task| &task.name);
            let (found, expected) = (describe(found, shape), describe(&own.name, &wanted));
            return Err(Mismatch::new("a checkpoint", found, expected));
        };
        let mut trainer = Trainer::new(model, heads, settings.normalisation());
        trainer.target = target;
        if let Some(moments) = &checkpoint.moments {
            trainer.descent = Optimiser::resume(moments, device);
        }
        (trainer.popart, trainer.updates) = (checkpoint.popart, checkpoint.updates);
        let core = Core {
            most: moves.most(&skill.task),
            paid: checkpoint.paid,
            settings: checkpoint.settings,
            actions: names(env),
            explored: checkpoint.explored,
            trainer,
            replay: checkpoint.replay,
            single: Batch::default(),
        };
        let (rng, elapsed, seed) = (checkpoint.rng, checkpoint.done, checkpoint.seed);
        Ok(Self { skill, moves, core, rng, elapsed, seed })
    }
}

/// All that learning changes, and which task it was for; see [`Learner::checkpoint`].
///
/// The replay is most of it: its states are saved as serde writes them, so a state should be small, or
/// the capacity.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Checkpoint<S> {
    settings: Settings,
    explored: Vec<usize>,
    paid: (f64, f64),
    shape: Shape,
    network: Vec<Dense>,
    target: Vec<Dense>,
    moments: Option<AdamMoments>,
    popart: PopArt,
    updates: u64,
    replay: Replay<S>,
    rng: Xoshiro256PlusPlus,
    done: Elapsed,
    /// Not there in files of earlier versions, which are known by their shape alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    task: Option<TaskName>,
    #[serde(default)]
    seed: u64,
}

/// Which task a checkpoint is of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
struct TaskName {
    name: String,
    formula: String,
}

impl TaskName {
    fn of(task: &impl Acceptor) -> Self {
        Self { name: task.name().to_string(), formula: task.formula().text().to_string() }
    }
}

/// What the actions of a world are called.
fn names(env: &impl Env) -> Vec<String> {
    (0..env.actions()).map(|a| env.action_name(a)).collect()
}

/// `Ok` if the world has so many actions.
fn check_actions(env: &impl Env, expected: usize) -> Result<(), Mismatch> {
    if env.actions() == expected {
        return Ok(());
    }
    let count = |actions| std::format!("a world of {actions} actions");
    Err(Mismatch::new("an environment", count(env.actions()), count(expected)))
}

/// A task and the network that it is learned with, as errors show them.
fn describe(task: &str, shape: &Shape) -> String {
    let Shape { inputs, hidden, heads, actions, entities, channels } = shape;
    std::format!(
        "`{task}` (a network of {inputs} inputs, layers {hidden:?}, {heads} heads, {actions} actions, \
         {entities} entities of {channels} channels)"
    )
}
