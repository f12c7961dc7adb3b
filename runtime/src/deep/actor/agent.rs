//! What acts and learns: an actor, its critics, and what they have seen.
//!
//! A [learner](super::Learner) has one that plays in the world, a [composition](super::Composition) one that
//! looks at what others have seen.

use burn::tensor::Device;
use rand::Rng;
use std::string::String;
use std::vec::Vec;

use super::Settings;
use super::stochastic;
use super::sum::Sum;
use super::trainer::{self, Trainer, normal, shapes};
use crate::augmented::Moves;
use crate::deep::layers::numbers;
use crate::deep::model::Batch;
use crate::deep::replay::Replay;
use crate::deep::sample::Heads;
use crate::deep::trainer::bounds;
use crate::deep::{Error, Relabel, Skill};
use crate::env::Step;
use crate::episode::Move;
use crate::mismatch::Mismatch;
use crate::monitor::Monitor;
use crate::network::policy::{NetworkPolicy, NetworkPolicyError};
use crate::network::{Activation, Controls, Features, Form, Network, NetworkError, Shape, Squash};
use crate::task;

/// An automaton state that no task has: of what was seen for another one.
const FOREIGN: u32 = u32::MAX;

/// All that learning changes, but for the random generator.
pub(super) struct Core<S> {
    pub settings: Settings,
    /// The least and the largest value of each component of an action, in the world's units.
    pub bounds: Vec<(f32, f32)>,
    /// What the components are called.
    pub names: Vec<String>,
    /// For each automaton state the most that its task pays from there on.
    pub most: Vec<f64>,
    /// The least and the largest that the environment has paid, 0 included.
    pub paid: (f64, f64),
    pub trainer: Trainer,
    pub replay: Replay<S, Vec<f32>>,
    /// Where an episode has started, until its first step: a start that is decided is not remembered.
    pub started: Option<S>,
    /// The noise of the last step, of deviation 1.
    pub noise: Vec<f64>,
    pub single: Batch,
}

/// An action within ±1 in the units of the world, as policies have it.
pub(super) fn stretched(bounds: &[(f32, f32)], mut action: Vec<f32>) -> Vec<f32> {
    for (a, &(low, high)) in action.iter_mut().zip(bounds) {
        *a = (low + (*a + 1.0) * 0.5 * (high - low)).clamp(low, high);
    }
    action
}

/// `Ok` if the actions of `what` have these bounds.
pub(super) fn check_bounds(
    what: &'static str,
    found: &[(f32, f32)],
    expected: &[(f32, f32)],
) -> Result<(), Mismatch> {
    if found == expected {
        return Ok(());
    }
    let describe = |bounds: &[(f32, f32)]| std::format!("a world with actions within {bounds:?}");
    Err(Mismatch::new(what, describe(found), describe(expected)))
}

/// The task of a skill, as an update asks it.
struct Asked<'a, S, M> {
    task: &'a M,
    moves: &'a Moves,
    /// For each automaton state the least and the most that can be had.
    bounds: &'a [(f64, f64)],
    /// The weight of the potential within automaton states.
    weight: f64,
    /// The robustness at which it is that weight.
    full: f64,
    base: Option<&'a Sum<'a, S>>,
    evaluates: bool,
    imitation: f64,
}

impl<S, M: Monitor<S>> trainer::Task<S> for Asked<'_, S, M> {
    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error> {
        self.moves.read(self.task, q, step)
    }

    fn potential(&self, q: u32, s: &S) -> Result<f64, task::Error> {
        if self.weight == 0.0 {
            return Ok(0.0);
        }
        let near = self.task.progress_robustness(q, s)? / self.full;
        Ok(self.weight * near.clamp(-1.0, 1.0))
    }

    fn bounds(&self, q: u32) -> (f64, f64) {
        let (least, most) = self.bounds[q as usize];
        (least - self.weight, most + self.weight)
    }

    fn base(&self) -> Option<&Sum<'_, S>> {
        self.base
    }

    fn evaluates(&self) -> bool {
        self.evaluates
    }

    fn imitation(&self) -> f64 {
        self.imitation
    }
}

/// What an update is for.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Aim {
    /// Critics learn what the actor is worth, and the actor follows them, which tries it in the world.
    Improve,
    /// The same without a step in the world, so the actor also [imitates](Settings::imitation), as by `Fit`.
    Refine,
    /// Critics learn what the actor is worth, which stays as it is.
    Evaluate,
    /// The actor follows the critics, which stay as they are.
    Fit,
}

impl<S> Core<S> {
    /// One that knows nothing, for the task of `moves`.
    ///
    /// # Panics
    /// If no automaton state is live, or the features are of entities too.
    #[track_caller]
    pub(super) fn new<M: Monitor<S>, F: Features<S>, G, R: Rng + ?Sized>(
        skill: &Skill<M, F, G>,
        moves: &Moves,
        (bounds, names): (Vec<(f32, f32)>, Vec<String>),
        settings: Settings,
        device: &Device,
        rng: &mut R,
    ) -> Self {
        let heads = Heads::new(moves, skill.task.states());
        assert!(!heads.states.is_empty(), "a task that is not decided from the start");
        assert_eq!(skill.features.entities(), 0, "an actor points at no entities");
        let inputs = skill.features.inputs();
        let shapes = shapes(inputs, bounds.len(), heads.states.len(), &settings);
        Self {
            trainer: Trainer::new(shapes, &settings, heads, device, rng),
            replay: Replay::new(settings.capacity()),
            started: None,
            most: moves.most(&skill.task),
            paid: (0.0, 0.0),
            settings,
            names,
            noise: std::vec![0.0; bounds.len()],
            bounds,
            single: Batch::default(),
        }
    }

    /// Takes in what the environment paid for a step.
    pub(super) fn note_paid(&mut self, reward: f64) {
        let paid = self.settings.rewards().environment() * reward;
        self.paid = (self.paid.0.min(paid), self.paid.1.max(paid));
    }

    /// Adds what was seen for another task.
    pub(super) fn remember(&mut self, seen: &Replay<S, Vec<f32>>)
    where
        S: Clone,
    {
        seen.moments().iter().for_each(|moment| self.note_paid(moment.reward));
        self.replay.extend(seen, |_| FOREIGN);
    }

    /// Learns from one batch of what was seen; what the critics say is added to `base`.
    pub(super) fn update<M, F, G, R>(
        &mut self,
        skill: &Skill<M, F, G>,
        moves: &Moves,
        (base, aim): (Option<&Sum<'_, S>>, Aim),
        rng: &mut R,
    ) -> Result<(), Error>
    where
        S: Clone,
        M: Monitor<S>,
        F: Features<S>,
        G: Relabel<S>,
        R: Rng + ?Sized,
    {
        let Skill { task, features, goals } = skill;
        let rewards = self.settings.rewards();
        let bounds = bounds(&self.most, &rewards, self.paid);
        let (weight, full) = (self.settings.robustness(), rewards.bound());
        let evaluates = aim == Aim::Evaluate;
        let imitates = matches!(aim, Aim::Refine | Aim::Fit);
        let imitation = if imitates { self.settings.imitation() } else { 0.0 };
        let asked =
            Asked { task, moves, bounds: &bounds, weight, full, base, evaluates, imitation };
        let (trainer, from) = (&mut self.trainer, (features, goals));
        if aim == Aim::Fit {
            return trainer.fit(&self.replay, from, &asked, &self.settings, rng);
        }
        trainer.update(&self.replay, from, &asked, &self.settings, rng).map(|_| ())
    }

    /// The features of a state, as a batch of one.
    pub(super) fn look(&mut self, features: &impl Features<S>, s: &S) -> Result<(), Error> {
        self.single.clear();
        self.single.push(features, s).map_err(Error::Feature)
    }

    /// The actor's action at a state whose features these are, within ±1; zeros where the task is
    /// decided.
    pub(super) fn act(&self, q: u32, seen: &Batch) -> Result<Vec<f32>, Error> {
        self.respond(q, seen, |_, mean, _| Activation::Tanh.of(mean))
    }

    /// The action to learn from at the state that was looked at last, after so many steps: the actor's, and noise; a
    /// stochastic actor draws by the noise.
    pub(super) fn explore<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        steps: u64,
        rng: &mut R,
    ) -> Result<Vec<f32>, Error> {
        let (kept, deviation) =
            (self.settings.noise_correlation(), self.settings.noise().at(steps));
        for noise in &mut self.noise {
            *noise = kept * *noise + (1.0 - kept * kept).sqrt() * normal(rng);
        }
        self.respond(q, &self.single, |i, mean, spread| match spread {
            Some(spread) => stochastic::action(mean, spread, self.noise[i] as f32),
            None => {
                let noise = (deviation * self.noise[i]) as f32;
                (Activation::Tanh.of(mean) + noise).clamp(-1.0, 1.0)
            }
        })
    }

    /// The action of which each component is made of its number, of the mean that the actor puts out, and of the
    /// spread, if it is stochastic.
    fn respond(
        &self,
        q: u32,
        seen: &Batch,
        of: impl Fn(usize, f32, Option<f32>) -> f32,
    ) -> Result<Vec<f32>, Error> {
        let m = self.bounds.len();
        let Trainer { actor, heads, updates, .. } = &self.trainer;
        let Some(head) = heads.of(q) else {
            return Ok((0..m).map(|i| of(i, 0.0, None)).collect());
        };
        let out = numbers(actor.layers.pass(seen.tensor(&actor.layers.device())).out);
        let (means, spreads) = out.split_at(heads.states.len() * m);
        let action = (0..m).map(|i| of(i, means[head * m + i], spreads.get(head * m + i).copied()));
        let action: Vec<f32> = action.collect();
        match action.iter().all(|a| a.is_finite()) {
            true => Ok(action),
            false => Err(Error::Loss(*updates)),
        }
    }

    /// The actor's network.
    pub(super) fn network(&self, inputs: usize) -> Result<Network, NetworkError> {
        let Self { trainer, bounds, settings, .. } = self;
        let heads = trainer.heads.states.len();
        let [shape, _] = shapes(inputs, bounds.len(), heads, settings);
        let (low, high) = bounds.iter().copied().unzip();
        let controls = Some(Controls { squash: Squash::Tanh, low, high });
        let form = Form { controls, ..Form::default() };
        Network::with_form(Shape { heads, ..shape }, trainer.greedy(), form)
    }

    /// The actor as a policy for `task`.
    pub(super) fn policy<M: Monitor<S>>(
        &self,
        task: &M,
        inputs: usize,
    ) -> Result<NetworkPolicy, NetworkPolicyError> {
        NetworkPolicy::new(task, self.names.clone(), self.network(inputs)?)
    }
}
