//! Composition of learned actors (paper, Algorithm 2), without a step in the world.
//!
//! As for [networks of numbered actions](crate::deep::Composition), the sum of the skills' critics stays as
//! it is, and further critics, with a head for each live state of the product, learn what is to be added
//! to it, from what the skills have seen. No maximum over actions can be looked up here, so a
//! policy has to be *fitted*: an actor with a head for each live state of the product climbs the sum in
//! the states that were seen, along its slope in the actions. Where a sum has two hills, an actor climbs
//! the one that it is nearer to; actions that were taken on the other, and are worth more, draw it there
//! ([`Settings::imitation`]).
//!
//! Tables have the promise that no step makes them worse. Here there is none: no model is at hand, what is
//! learned is of actions that were tried, and what an actor is worth is known by
//! [trials](crate::estimate::estimate_continuous()) alone, which are steps in the world.

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use std::string::String;
use std::vec::Vec;

use super::Settings;
use super::agent::{Aim, Core, check_bounds, stretched};
use super::sum::{Part, Sum};
use super::trainer::shapes;
use crate::augmented::Moves;
use crate::compose::{Combine, Compose};
use crate::deep::compose::{check, terms};
use crate::deep::layers::Layers;
use crate::deep::model::Batch;
use crate::deep::replay::Replay;
use crate::deep::sample::Heads;
use crate::deep::trainer::check_reward;
use crate::deep::{Error, Relabel, Skill};
use crate::monitor::{Acceptor, Monitor};
use crate::network::policy::{NetworkPolicy, NetworkPolicyError, NetworkTraining};
use crate::network::{Features, Network, NetworkError};
use crate::product::Product;

/// A skill that was learned: what [`Learner::learned`](super::Learner::learned) gives.
///
/// A skill from a file is one too, of the learner that [goes on](super::Learner::resume) from its
/// checkpoint.
pub struct Learned<'a, S> {
    critic: Network,
    features: &'a (dyn Features<S> + Sync),
    task: &'a (dyn Monitor<S> + Sync),
    experience: &'a Replay<S, Vec<f32>>,
    bounds: &'a [(f32, f32)],
    names: &'a [String],
    training: NetworkTraining,
}

impl<S> core::fmt::Debug for Learned<'_, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Learned")
            .field("task", &self.task.name())
            .field("bounds", &self.bounds)
            .finish_non_exhaustive()
    }
}

impl<'a, S> Learned<'a, S> {
    /// The first critic counts, which is the one that a deterministic actor has followed.
    pub(super) fn new(
        of: &'a Core<S>,
        task: &'a (dyn Monitor<S> + Sync),
        features: &'a (dyn Features<S> + Sync),
        training: NetworkTraining,
    ) -> Result<Self, NetworkError> {
        let Core { trainer, bounds, names, settings, replay, .. } = of;
        let (inputs, heads) = (features.inputs(), trainer.heads.states.len());
        let [_, shape] = shapes(inputs, bounds.len(), heads, settings);
        let critic = Network::new(shape, trainer.critics[0].layers.dense())?;
        Ok(Self { critic, features, task, experience: replay, bounds, names, training })
    }

    fn heads(&self, settings: &Settings) -> Heads {
        Heads::new(&Moves::new(self.task, settings.rewards()), self.task.states())
    }

    fn part(&self, device: &Device) -> Part<'a, S> {
        let (features, heads) = (self.features, self.critic.shape().heads);
        Part { features, critic: Layers::of(self.critic.layers(), device), heads, scale: 1.0 }
    }
}

/// Learned actors that are composed.
///
/// ```
/// use tltl::compose::Compose as _;
/// use tltl::deep::actor::{Composition, Learner, Settings};
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
/// let (mut cart, device) = (Cart(0.0), Device::flex());
/// let mut one = Learner::new(Skill::new(&left, Place), &cart, settings.clone(), &device, 1);
/// let mut two = Learner::new(Skill::new(&right, Place), &cart, settings.clone(), &device, 2);
/// one.train(&mut cart, 600)?;
/// two.train(&mut cart, 600)?;
///
/// // Both, by what the skills have learned and seen.
/// let both = Product::conjunction(&[&left, &right]);
/// let (skill, skills) = (Skill::new(&both, Place), [one.learned()?, two.learned()?]);
/// let mut composed = Composition::new(skill, &skills, Combine::Sum, settings, &device, 3)?;
/// composed.fit(300)?;
/// composed.compensate(300)?;
/// composed.refine(600)?;
/// assert_eq!(composed.updates(), 900, "of the critics, and not a step was taken");
/// let (mut x, mut q) = (0.0, both.next(0, &0.0)?);
/// for _ in 0..60 {
///     x = (x + composed.act(q, &x)?[0]).clamp(-1.0, 1.0);
///     q = both.next(q, &x)?;
/// }
/// assert!(both.is_accepting(q));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Composition<'a, S, F, G> {
    skill: Skill<&'a Product<'a, S>, F, G>,
    moves: Moves,
    sum: Sum<'a, S>,
    core: Core<S>,
    fitted: bool,
    /// How the skills were learned.
    trainings: Vec<NetworkTraining>,
    rng: Xoshiro256PlusPlus,
    seed: u64,
}

impl<S, F, G> core::fmt::Debug for Composition<'_, S, F, G> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Composition")
            .field("task", &self.skill.task.name())
            .field("updates", &self.core.trainer.updates)
            .finish_non_exhaustive()
    }
}

impl<'a, S: Clone, F: Features<S>, G: Relabel<S>> Composition<'a, S, F, G> {
    /// Step 2: the composition of `skills`, in the order of the operands of the product that is the task of
    /// `skill`, on what they have seen. Of `settings` it reads those of updates and rewards; the rewards
    /// must be those that the skills were learned with, whose values are taken as they are. The actor
    /// knows nothing yet: [`Self::fit`]. It is deterministic, for it explores nothing: no [`Settings::entropy`] is
    /// read. It [imitates](Settings::imitation).
    ///
    /// # Errors
    /// If skills and product do not fit together, the skills are of worlds with other actions, the reward pays for
    /// moves and the product has a way back ([`Error::WayBack`]), or a feature is not a finite number in a state
    /// that was seen.
    ///
    /// # Panics
    /// If nothing was seen, the product is decided from the start, or the features are of entities too.
    #[track_caller]
    pub fn new(
        skill: Skill<&'a Product<'a, S>, F, G>,
        skills: &[Learned<'a, S>],
        combine: Combine,
        settings: Settings,
        device: &Device,
        seed: u64,
    ) -> Result<Self, Error> {
        let product = skill.task;
        let size = |skill: &Learned<'a, S>| {
            (skill.task.name(), skill.critic.shape().heads, skill.bounds.len())
        };
        check(product, &skills.iter().map(size).collect::<Vec<_>>())?;
        let Learned { bounds, names, .. } = skills[0];
        skills.iter().try_for_each(|skill| check_bounds("a skill", skill.bounds, bounds))?;
        check_reward(product, &settings.rewards())?;
        let seen: usize = skills.iter().map(|skill| skill.experience.len()).sum();
        assert!(seen > 1, "skills that have seen something");
        let moves = Moves::new(product, settings.rewards());
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let actions = (bounds.to_vec(), names.to_vec());
        let settings = settings.deterministic();
        let mut core = Core::new(&skill, &moves, actions, settings, device, &mut rng);
        core.trainer.silence();
        core.replay = Replay::new(seen);
        skills.iter().for_each(|skill| core.remember(skill.experience));
        let of_skills: Vec<_> = skills.iter().map(|skill| skill.heads(&core.settings)).collect();
        let of_skills: Vec<_> = of_skills.iter().collect();
        let terms = terms(product, &core.trainer.heads, &of_skills);
        let parts = skills.iter().map(|skill| skill.part(device)).collect();
        let mut sum = Sum { parts, terms, combine };
        if combine != Combine::Sum {
            normalise(&mut sum, &core.replay)?;
        }
        let trainings = skills.iter().map(|skill| skill.training.clone()).collect();
        Ok(Self { skill, moves, sum, core, fitted: false, trainings, rng, seed })
    }

    /// Fits the actor to the values as they are, by so many updates of it: before anything else to the
    /// sum of step 2.
    ///
    /// # Errors
    /// If a predicate or a feature is not a finite number.
    pub fn fit(&mut self, updates: u64) -> Result<(), Error> {
        self.learn(updates, Aim::Fit)?;
        self.fitted = true;
        Ok(())
    }

    fn learn(&mut self, updates: u64, aim: Aim) -> Result<(), Error> {
        let Self { skill, moves, sum, core, rng, .. } = self;
        (0..updates).try_for_each(|_| core.update(skill, moves, (Some(&*sum), aim), rng))
    }

    /// What sum and further critics say of the actor's action in (s, q), the least of them; 0 where the
    /// task is decided. With [`Settings::robustness`] it is less by the potential of s.
    ///
    /// # Errors
    /// If a feature is not a finite number, or learning has diverged.
    pub fn value(&self, q: u32, s: &S) -> Result<f32, Error> {
        let Some(head) = self.core.trainer.heads.of(q) else {
            return Ok(0.0);
        };
        let seen = self.look(s)?;
        let action = self.core.act(q, &seen)?;
        let base = self.sum.values(core::slice::from_ref(s), &[(0, &action)])?[head];
        Ok(base + self.core.trainer.value(head, &seen, &action))
    }

    fn look(&self, s: &S) -> Result<Batch, Error> {
        let mut seen = Batch::default();
        seen.push(&self.skill.features, s).map_err(Error::Feature)?;
        Ok(seen)
    }

    /// The actor so far as a policy, to be saved, and emitted as Rust. It says how each skill was learned,
    /// and that the whole took no further step.
    ///
    /// # Errors
    /// If learning has diverged so far that a weight is infinite or not a number.
    pub fn policy(&self) -> Result<NetworkPolicy, NetworkPolicyError> {
        let Skill { task, features, .. } = &self.skill;
        let training = NetworkTraining {
            task: task.name().into(),
            steps: 0,
            episodes: 0,
            updates: self.updates(),
            gamma: self.core.settings.rewards().gamma(),
            seed: self.seed,
        };
        let policy = self.core.policy(task, features.inputs())?;
        let all = self.trainings.iter().cloned().chain([training]);
        Ok(all.fold(policy, NetworkPolicy::trained))
    }

    /// Updates of the further critics so far.
    pub const fn updates(&self) -> u64 {
        self.core.trainer.updates
    }
}

impl<S: Clone, F: Features<S>, G: Relabel<S>> Compose for Composition<'_, S, F, G> {
    type State = S;
    type Action = Vec<f32>;
    type Error = Error;

    /// Steps 3–5: the further critics learn until the whole is what the actor is worth in the product,
    /// which stays as it is meanwhile, by so many updates; then it is [fitted](Composition::fit) anew, by
    /// as many. One that was never fitted is fitted to the sum first.
    fn compensate(&mut self, updates: u64) -> Result<(), Error> {
        if !self.fitted {
            self.fit(updates)?;
        }
        self.core.trainer.settle();
        self.learn(updates, Aim::Evaluate)?;
        self.fit(updates)
    }

    /// Step 6: actor and further critics learn together, until the whole is the optimum of the
    /// product, as far as what was seen tells.
    fn refine(&mut self, updates: u64) -> Result<(), Error> {
        self.core.trainer.settle();
        self.learn(updates, Aim::Refine)
    }

    /// The actor's action, in the units of the world; the middle where the task is decided.
    fn act(&self, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        Ok(stretched(&self.core.bounds, self.core.act(q, &self.look(s)?)?))
    }
}

/// Divides each skill's values by their largest in what was seen.
fn normalise<S: Clone>(sum: &mut Sum<'_, S>, replay: &Replay<S, Vec<f32>>) -> Result<(), Error> {
    // As many as of numbered actions.
    const LOOK: usize = 2_000;
    let step = (replay.len() / LOOK).max(1);
    // Of last states no action was taken.
    let seen = replay.moments().iter().step_by(step).filter(|m| !m.action.is_empty());
    let (states, actions): (Vec<S>, Vec<&[f32]>) =
        seen.map(|m| (m.state.clone(), &m.action[..])).unzip();
    let rows: Vec<_> = actions.into_iter().enumerate().collect();
    if rows.is_empty() {
        return Ok(()); // Last states alone.
    }
    for part in &mut sum.parts {
        let largest = part.largest(&states, &rows)?;
        part.scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
    }
    Ok(())
}
