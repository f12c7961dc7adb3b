//! The learner: acts with noise, remembers, learns.

use burn::tensor::Device;
use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
use serde::{Deserialize, Serialize};
use std::string::{String, ToString};
use std::vec::Vec;

use super::Settings;
use super::agent::{Aim, Core, check_bounds, stretched};
use super::compose::Learned;
use super::stochastic::Temperature;
use super::trainer::{SavedNetwork, Trained, Trainer, shapes};
use crate::augmented::Moves;
use crate::deep::model::Batch;
use crate::deep::replay::Replay;
use crate::deep::sample::Heads;
use crate::deep::trainer::check_reward;
use crate::deep::{Error, Relabel, Skill};
use crate::env::{ContinuousEnv, Step, unit};
use crate::episode::{self, Agent, Elapsed, Monitored, Move, Transition};
use crate::mismatch::Mismatch;
use crate::monitor::Monitor;
use crate::network::policy::{NetworkPolicy, NetworkPolicyError, NetworkTraining};
use crate::network::{Features, Network, NetworkError};
use crate::task;

/// An actor-critic learner of one skill.
///
/// [The module](super) has an example. To watch or save it, train in slices; each call runs whole
/// episodes.
pub struct Learner<S, M, F, G> {
    skill: Skill<M, F, G>,
    moves: Moves,
    core: Core<S>,
    rng: Xoshiro256PlusPlus,
    elapsed: Elapsed,
    seed: u64,
}

impl<S, M: Monitor<S>, F, G> core::fmt::Debug for Learner<S, M, F, G> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Learner")
            .field("task", &self.skill.task.name())
            .field("bounds", &self.core.bounds)
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

/// An environment beside the task of a skill. Actions come within ±1.
struct Beside<'a, E, M> {
    env: &'a mut E,
    bounds: &'a [(f32, f32)],
    task: &'a M,
    moves: &'a Moves,
}

impl<S, E: ContinuousEnv<State = S>, M: Monitor<S>> Monitored<Vec<f32>> for Beside<'_, E, M> {
    type State = S;
    type Error = task::Error;

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<S, task::Error> {
        Ok(self.env.reset(rng))
    }

    fn step<R: Rng + ?Sized>(
        &mut self,
        action: Vec<f32>,
        rng: &mut R,
    ) -> Result<Step<S>, task::Error> {
        Ok(self.env.step(&stretched(self.bounds, action), rng))
    }

    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error> {
        self.moves.read(self.task, q, step)
    }
}

impl<S, M, F, G> Agent<Vec<f32>> for Playing<'_, S, M, F, G>
where
    S: Clone,
    M: Monitor<S>,
    F: Features<S>,
    G: Relabel<S>,
{
    type State = S;
    type Error = Error;

    fn start(&mut self, s: &S) {
        self.core.started = Some(s.clone());
        self.core.noise.fill(0.0);
    }

    /// At random at first; then as the actor explores.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        s: &S,
        steps: u64,
        rng: &mut R,
    ) -> Result<Vec<f32>, Error> {
        self.steps = steps + 1;
        let core = &mut *self.core;
        if steps < core.settings.warmup() {
            return Ok(core.bounds.iter().map(|_| 2.0 * unit(rng) as f32 - 1.0).collect());
        }
        core.look(&self.skill.features, s)?;
        core.explore(q, steps, rng)
    }

    /// Remembers the step, and makes an update if it is time for one.
    fn learn<W: Monitored<Vec<f32>, State = S, Error: Into<Error>>, R: Rng + ?Sized>(
        &mut self,
        _: &W,
        transition: &Transition<'_, S, Vec<f32>>,
        rng: &mut R,
    ) -> Result<(), Error> {
        let (core, Transition { q, action, step, .. }) = (&mut *self.core, transition);
        if !step.reward.is_finite() {
            return Err(Error::Reward(self.steps));
        }
        // What cannot be learned from is not remembered.
        core.look(&self.skill.features, &step.state)?;
        core.note_paid(step.reward);
        if let Some(s) = core.started.take() {
            core.replay.start(s);
        }
        core.replay.push(*q, action.clone(), Step { state: step.state.clone(), ..**step });
        let (warmup, between) = (core.settings.warmup(), core.settings.steps_per_update());
        if self.steps < warmup || !self.steps.is_multiple_of(between) {
            return Ok(());
        }
        core.update(self.skill, self.moves, (None, Aim::Improve), rng)
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
    /// If no state of the task's automaton is live, the features are of entities too, or the world has no
    /// component of an action, or a bound that is not finite or not above the other.
    #[track_caller]
    pub fn new(
        skill: Skill<M, F, G>,
        env: &impl ContinuousEnv<State = S>,
        settings: Settings,
        device: &Device,
        seed: u64,
    ) -> Self {
        let moves = Moves::new(&skill.task, settings.rewards());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let actions = (checked_bounds(env), names(env));
        let core = Core::new(&skill, &moves, actions, settings, device, &mut rng);
        Self { skill, moves, core, rng, elapsed: Elapsed::default(), seed }
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it. Gives up early if 100,000 episodes in a row are over at
    /// their very first state.
    ///
    /// # Errors
    /// If the environment has other actions, the reward pays for moves and the automaton has a way back
    /// ([`Error::WayBack`]), or a predicate, a feature, a reward or the loss is not a finite number.
    pub fn train<E: ContinuousEnv<State = S>>(
        &mut self,
        env: &mut E,
        total: u64,
    ) -> Result<(), Error> {
        check_bounds("an environment", &env.bounds(), &self.core.bounds)?;
        check_reward(&self.skill.task, &self.core.settings.rewards())?;
        let Self { skill, moves, core, rng, elapsed, .. } = self;
        let (horizon, bounds) = (core.settings.horizon(), core.bounds.clone());
        let mut world = Beside { env, bounds: &bounds, task: &skill.task, moves };
        let mut agent = Playing { skill, moves, core, steps: elapsed.steps };
        episode::run(&mut world, &mut agent, elapsed, horizon, total, rng)
    }

    /// Adds what another learner saw in the same world, for whatever task: the world does not depend on
    /// it. The oldest is forgotten where that is more than the capacity. With
    /// [`Updates::Current`](crate::learn::Updates::Current) nothing is learned from it, for it was not
    /// taken in a state of this automaton.
    ///
    /// With [`Self::rehearse`] that is how skills become a new one without a step in the world (the last
    /// step of the paper's Algorithm 2; [`Composition`](super::Composition) has all of them):
    ///
    /// ```
    /// use tltl::deep::actor::{Learner, Settings};
    /// use tltl::deep::{Device, Skill};
    /// use tltl::env::{ContinuousEnv, Step};
    /// use tltl::network::Features;
    /// use tltl::prelude::*;
    /// use tltl::rand::Rng;
    /// # struct Cart(f32);
    /// # impl ContinuousEnv for Cart {
    /// #     type State = f32;
    /// #     fn bounds(&self) -> Vec<(f32, f32)> { vec![(-0.2, 0.2)] }
    /// #     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 { self.0 = 0.0; 0.0 }
    /// #     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
    /// #         self.0 = (self.0 + action[0]).clamp(-1.0, 1.0);
    /// #         Step::to(self.0)
    /// #     }
    /// # }
    /// # #[derive(Clone, Copy)]
    /// # struct Place;
    /// # impl Features<f32> for Place {
    /// #     fn inputs(&self) -> usize { 1 }
    /// #     fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) { inputs[0] = *s; }
    /// # }
    ///
    /// // Two skills: to the left end, and to the right one.
    /// let (left, right) = (tltl! { |x: &f32| F ({ *x } < -0.8) }, tltl! { |x: &f32| F ({ *x } > 0.8) });
    /// let settings = Settings::default().with_hidden([32, 32])?.with_warmup(300)?.with_horizon(60)?;
    /// let settings = settings.with_robustness(0.5)?;
    /// let mut cart = Cart(0.0);
    /// let mut first = Learner::new(Skill::new(&left, Place), &cart, settings.clone(), &Device::flex(), 1);
    /// let mut second = Learner::new(Skill::new(&right, Place), &cart, settings.clone(), &Device::flex(), 2);
    /// first.train(&mut cart, 600)?;
    /// second.train(&mut cart, 600)?;
    ///
    /// // Both, in any order, from what the two saw.
    /// let both = Product::conjunction(&[&left, &right]);
    /// let mut composed = Learner::new(Skill::new(&both, Place), &cart, settings, &Device::flex(), 3);
    /// composed.remember(&first)?;
    /// composed.remember(&second)?;
    /// composed.rehearse(4_000)?;
    /// let (mut x, mut q) = (0.0, both.next(0, &0.0)?);
    /// for _ in 0..60 {
    ///     x = (x + composed.act(q, &x)?[0]).clamp(-1.0, 1.0);
    ///     q = both.next(q, &x)?;
    /// }
    /// assert!(both.is_accepting(q) && composed.steps() == 0);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If its world has actions with other bounds.
    pub fn remember<N, H, K>(&mut self, other: &Learner<S, N, H, K>) -> Result<(), Mismatch> {
        check_bounds("an environment", &other.core.bounds, &self.core.bounds)?;
        self.core.remember(&other.core.replay);
        Ok(())
    }

    /// Makes updates from what is remembered, without a step in the world.
    ///
    /// Nothing corrects here what an actor believes of actions that nobody has tried, and where it stands on the
    /// lower of two hills, no noise shows it the other. So it also [imitates](Settings::imitation) what was
    /// taken, where the critics value that more.
    ///
    /// # Errors
    /// If the reward pays for moves and the automaton has a way back, or a predicate, a feature or the
    /// loss is not a finite number.
    ///
    /// # Panics
    /// If no step is remembered.
    #[track_caller]
    pub fn rehearse(&mut self, updates: u64) -> Result<(), Error> {
        check_reward(&self.skill.task, &self.core.settings.rewards())?;
        let Self { skill, moves, core, rng, .. } = self;
        let aim = (None, Aim::Refine);
        (0..updates).try_for_each(|_| core.update(skill, moves, aim, rng))
    }

    /// The actor's action in (s, q), in the units of the world; the middle where the task is decided. Nothing is
    /// drawn: that of a stochastic actor is tanh of the mean.
    ///
    /// # Errors
    /// If a feature is not a finite number, or learning has diverged.
    ///
    /// # Panics
    /// If `q` is not a state of the task's automaton.
    #[track_caller]
    pub fn act(&mut self, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        self.check_state(q);
        self.core.look(&self.skill.features, s)?;
        let action = self.core.act(q, &self.core.single)?;
        Ok(stretched(&self.core.bounds, action))
    }

    /// What the critics say of the actor's action in (s, q), the least of them; 0 where the task is
    /// decided. With [`Settings::robustness`] it is less by the potential of s, and for a
    /// stochastic actor its entropy from there on counts too.
    ///
    /// # Errors
    /// If a feature is not a finite number, or learning has diverged.
    ///
    /// # Panics
    /// If `q` is not a state of the task's automaton.
    #[track_caller]
    pub fn value(&mut self, q: u32, s: &S) -> Result<f32, Error> {
        self.check_state(q);
        let Some(head) = self.core.trainer.heads.of(q) else {
            return Ok(0.0);
        };
        self.core.look(&self.skill.features, s)?;
        let action = self.core.act(q, &self.core.single)?;
        Ok(self.core.trainer.value(head, &self.core.single, &action))
    }

    #[track_caller]
    fn check_state(&self, q: u32) {
        let states = self.skill.task.states();
        assert!(q < states, "automaton state {q}, and there are {states}");
    }

    /// The actor's network; its heads are the automaton's live states, in order.
    ///
    /// # Errors
    /// If learning has diverged so far that a weight is infinite or not a number.
    pub fn network(&self) -> Result<Network, NetworkError> {
        self.core.network(self.skill.features.inputs())
    }

    /// The skill as it was learned, to be composed with others; [`Composition`](super::Composition) shows
    /// its use.
    ///
    /// # Errors
    /// If learning has diverged so far that a weight of the first critic is infinite or not a number.
    pub fn learned(&self) -> Result<Learned<'_, S>, NetworkError>
    where
        M: Sync,
        F: Sync,
    {
        let Skill { task, features, .. } = &self.skill;
        Learned::new(&self.core, task, features, self.training())
    }

    /// The actor so far as a policy that says how it was learned: to be saved, and emitted as Rust.
    ///
    /// ```
    /// use tltl::deep::actor::{Learner, Settings};
    /// use tltl::deep::{Device, Skill};
    /// use tltl::env::{ContinuousEnv, Step};
    /// use tltl::network::Features;
    /// use tltl::rand::Rng;
    /// use tltl::tltl;
    /// # struct Cart(f32);
    /// # impl ContinuousEnv for Cart {
    /// #     type State = f32;
    /// #     fn bounds(&self) -> Vec<(f32, f32)> { vec![(-0.2, 0.2)] }
    /// #     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 { self.0 = 0.0; 0.0 }
    /// #     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
    /// #         self.0 = (self.0 + action[0]).clamp(-1.0, 1.0);
    /// #         Step::to(self.0)
    /// #     }
    /// # }
    /// # struct Place;
    /// # impl Features<f32> for Place {
    /// #     fn inputs(&self) -> usize { 1 }
    /// #     fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) { inputs[0] = *s; }
    /// # }
    ///
    /// let mut cart = Cart(0.0);
    /// let skill = Skill::new(tltl! { |x: &f32| F ({ *x } > 0.8) }, Place);
    /// let settings = Settings::default().with_hidden([8])?.with_warmup(50)?;
    /// let mut learner = Learner::new(skill, &cart, settings, &Device::flex(), 1);
    /// learner.train(&mut cart, 100)?;
    /// // It needs no tensor library from here on.
    /// let policy = learner.policy()?;
    /// let (here, there) = (learner.act(0, &0.3)?, policy.control(0, &[0.3], &[]).expect("an actor's"));
    /// assert!((here[0] - there[0]).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::network`].
    pub fn policy(&self) -> Result<NetworkPolicy, NetworkPolicyError> {
        let Skill { task, features, .. } = &self.skill;
        Ok(self.core.policy(task, features.inputs())?.trained(self.training()))
    }

    /// How the actor was learned so far, as policies say it.
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

    /// What was seen; actions within ±1.
    pub const fn replay(&self) -> &Replay<S, Vec<f32>> {
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

    /// Updates of the critics so far.
    pub const fn updates(&self) -> u64 {
        self.core.trainer.updates
    }

    /// All that learning has changed, to be saved.
    ///
    /// ```
    /// use tltl::deep::actor::{Checkpoint, Learner, Settings};
    /// use tltl::deep::{Device, Skill};
    /// use tltl::env::{ContinuousEnv, Step};
    /// use tltl::network::Features;
    /// use tltl::rand::Rng;
    /// use tltl::tltl;
    /// # #[derive(Clone)]
    /// # struct Cart(f32);
    /// # impl ContinuousEnv for Cart {
    /// #     type State = f32;
    /// #     fn bounds(&self) -> Vec<(f32, f32)> { vec![(-0.2, 0.2)] }
    /// #     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f32 { self.0 = 0.0; 0.0 }
    /// #     fn step<R: Rng + ?Sized>(&mut self, action: &[f32], _: &mut R) -> Step<f32> {
    /// #         self.0 = (self.0 + action[0]).clamp(-1.0, 1.0);
    /// #         Step::to(self.0)
    /// #     }
    /// # }
    /// # #[derive(Clone, Copy)]
    /// # struct Place;
    /// # impl Features<f32> for Place {
    /// #     fn inputs(&self) -> usize { 1 }
    /// #     fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) { inputs[0] = *s; }
    /// # }
    ///
    /// let (mut cart, device) = (Cart(0.0), Device::flex());
    /// let end = tltl! { |x: &f32| F { *x } > 0.8 };
    /// let settings = Settings::default().with_hidden([8])?.with_batch(8)?.with_warmup(50)?;
    /// let mut learner = Learner::new(Skill::new(&end, Place), &cart, settings, &device, 1);
    /// learner.train(&mut cart, 100)?;
    /// let text = serde_json::to_string(&learner.checkpoint())?;
    /// let saved: Checkpoint<f32> = serde_json::from_str(&text)?;
    /// let mut resumed = Learner::resume(Skill::new(&end, Place), &cart, saved, &device)?;
    /// learner.train(&mut cart.clone(), 200)?;
    /// resumed.train(&mut cart, 200)?;
    /// assert_eq!(learner.checkpoint(), resumed.checkpoint());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn checkpoint(&self) -> Checkpoint<S> {
        let Trainer { actor, critics, temperature, updates, .. } = &self.core.trainer;
        Checkpoint {
            task: self.skill.task.name().into(),
            formula: self.skill.task.formula().text().into(),
            settings: self.core.settings.clone(),
            bounds: self.core.bounds.clone(),
            actor: actor.saved(),
            critics: critics.iter().map(Trained::saved).collect(),
            temperature: temperature.clone(),
            updates: *updates,
            paid: self.core.paid,
            noise: self.core.noise.clone(),
            replay: self.core.replay.clone(),
            rng: self.rng.clone(),
            done: self.elapsed,
            seed: self.seed,
        }
    }

    /// A learner of `skill` in the world of `env` that goes on as the one would have that the
    /// checkpoint is of: between episodes, on the same kind of device, with the same numbers.
    ///
    /// # Errors
    /// If the checkpoint is of another task or world, or of networks of another shape.
    pub fn resume(
        skill: Skill<M, F, G>,
        env: &impl ContinuousEnv<State = S>,
        checkpoint: Checkpoint<S>,
        device: &Device,
    ) -> Result<Self, Mismatch> {
        let Checkpoint { settings, bounds, .. } = &checkpoint;
        check_bounds("an environment", &env.bounds(), bounds)?;
        let moves = Moves::new(&skill.task, settings.rewards());
        let heads = Heads::new(&moves, skill.task.states());
        let (inputs, m) = (skill.features.inputs(), bounds.len());
        let [actor, critic] = shapes(inputs, m, heads.states.len(), settings);
        let within = |action: &Vec<f32>| action.len() == m && action.iter().all(|a| a.abs() <= 1.0);
        let same = checkpoint.formula == skill.task.formula().text()
            && checkpoint.critics.len() == settings.critics()
            && checkpoint.temperature.is_some() == settings.entropy().is_some()
            && checkpoint.noise.len() == m
            && checkpoint.replay.steps().all(within);
        let critics: Option<Vec<_>> =
            checkpoint.critics.iter().map(|net| Trained::resume(net, &critic, device)).collect();
        let (true, Some(actor), Some(critics)) =
            (same, Trained::resume(&checkpoint.actor, &actor, device), critics)
        else {
            let layers = |inputs: Option<usize>| {
                let inputs = inputs.map_or("no".into(), |inputs| inputs.to_string());
                std::format!("a network of {inputs} inputs and layers {:?}", settings.hidden())
            };
            let (task, name) = (&checkpoint.task, skill.task.name());
            let (seen, critics) = (checkpoint.actor.inputs(), checkpoint.critics.len());
            let found = std::format!("`{task}` ({}, {critics} critics)", layers(seen));
            let (own, critics) = (layers(Some(inputs)), settings.critics());
            let own = std::format!(
                "`{name}` ({own}, {critics} critics, actions of {m} numbers within ±1)"
            );
            return Err(Mismatch::new("a checkpoint", found, own));
        };
        let core = Core {
            trainer: Trainer::of(
                heads,
                m,
                (actor, checkpoint.temperature),
                critics,
                checkpoint.updates,
            ),
            replay: checkpoint.replay,
            started: None,
            most: moves.most(&skill.task),
            paid: checkpoint.paid,
            settings: checkpoint.settings,
            names: names(env),
            noise: checkpoint.noise,
            bounds: checkpoint.bounds,
            single: Batch::default(),
        };
        let (rng, elapsed, seed) = (checkpoint.rng, checkpoint.done, checkpoint.seed);
        Ok(Self { skill, moves, core, rng, elapsed, seed })
    }
}

/// All that learning changes, and which task it was for; see [`Learner::checkpoint`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Checkpoint<S> {
    task: String,
    formula: String,
    settings: Settings,
    bounds: Vec<(f32, f32)>,
    actor: SavedNetwork,
    critics: Vec<SavedNetwork>,
    temperature: Option<Temperature>,
    updates: u64,
    paid: (f64, f64),
    noise: Vec<f64>,
    replay: Replay<S, Vec<f32>>,
    rng: Xoshiro256PlusPlus,
    done: Elapsed,
    seed: u64,
}

/// What the components of an action are called.
fn names(env: &impl ContinuousEnv) -> Vec<String> {
    (0..env.bounds().len()).map(|i| env.component_name(i)).collect()
}

/// The bounds of a world's actions.
#[track_caller]
fn checked_bounds(env: &impl ContinuousEnv) -> Vec<(f32, f32)> {
    let bounds = env.bounds();
    let sound = |&(low, high): &(f32, f32)| low < high && (high - low).is_finite();
    assert!(
        !bounds.is_empty() && bounds.iter().all(sound),
        "the bounds of actions are pairs of a lesser and a larger number, whose difference is finite: {bounds:?}"
    );
    bounds
}
