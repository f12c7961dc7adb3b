//! Composition of learned networks (paper, Algorithm 2), without a step in the world.
//!
//! As for [tables](crate::compose): step 2 adds up the skills' values, steps 3–5 make of that the values of
//! its greedy policy in the product, step 6 makes the result the optimum of the product. What the skills have seen,
//! relabelled with every state of the product's automaton, is all that is learned from. The skills'
//! networks stay as they are; one further network, with a head for each live state of the
//! product, is added to their sum, and it alone is trained: from zero in
//! [`Compose::compensate`], and on from there in [`Compose::refine`].
//!
//! Three things keep the errors of networks from choosing the action, for the values of two actions
//! differ by a few per cent where a network errs by as much. Both steps widen the gaps between actions
//! ([`Settings::advantage_learning`]); what was never seen of an action stays as the skills have it
//! ([`Settings::advantage_penalty`]); and where all skills but one are done, that skill's values
//! are the product's, and nothing is learned.

use burn::tensor::Device;
use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use std::vec::Vec;

use super::model::{Batch, Model};
use super::replay::Replay;
use super::sample::Heads;
use super::settings::Settings;
use super::trainer::{Objective, Trainer, bounds, check_reward};
use super::{Error, Relabel};
use crate::augmented::Moves;
use crate::compose::{Combine, Compose};
use crate::env::Step;
use crate::learn::episode::Move;
use crate::mismatch::Mismatch;
use crate::monitor::{Acceptor, Monitor};
use crate::network::{Features, Network, Shape};
use crate::product::{Operator, Product};
use crate::q::argmax;
use crate::reward::Mode;
use crate::task;

/// A skill that was learned: what [`Learner::learned`](super::Learner::learned) gives.
///
/// A skill from a file is one too: its network is in the document, its experience in the checkpoint.
pub struct Learned<'a, S> {
    /// Its values; the heads are the task's live states in order.
    pub network: Network,
    /// What the network sees.
    pub features: &'a (dyn Features<S> + Sync),
    /// Its task.
    pub task: &'a (dyn Monitor<S> + Sync),
    /// What was seen when it was learned.
    pub experience: &'a Replay<S>,
}

impl<S> core::fmt::Debug for Learned<'_, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Learned")
            .field("task", &self.task.name())
            .field("shape", self.network.shape())
            .finish_non_exhaustive()
    }
}

/// What several skills see, side by side. All must have the same entities.
///
/// A composition's own network sees the state so.
///
/// ```
/// use tltl::deep::Joint;
/// use tltl::network::Features;
///
/// /// How far a place is away.
/// struct Distance(f32);
///
/// impl Features<f32> for Distance {
///     fn inputs(&self) -> usize {
///         1
///     }
///     fn write(&self, s: &f32, inputs: &mut [f32], _: &mut [f32]) {
///         inputs[0] = s - self.0;
///     }
/// }
///
/// let both = Joint(vec![&Distance(1.0), &Distance(4.0)]);
/// let mut inputs = [0.0; 2];
/// both.write(&2.0, &mut inputs, &mut []);
/// assert_eq!(inputs, [1.0, -2.0]);
/// ```
pub struct Joint<'a, S>(pub Vec<&'a (dyn Features<S> + Sync)>);

impl<S> core::fmt::Debug for Joint<'_, S> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Joint").field("skills", &self.0.len()).finish_non_exhaustive()
    }
}

impl<S> Features<S> for Joint<'_, S> {
    fn inputs(&self) -> usize {
        self.0.iter().map(|features| features.inputs()).sum()
    }

    fn entities(&self) -> usize {
        self.0.first().map_or(0, |features| features.entities())
    }

    fn channels(&self) -> usize {
        self.0.iter().map(|features| features.channels()).sum()
    }

    fn write(&self, s: &S, mut inputs: &mut [f32], mut entities: &mut [f32]) {
        for features in &self.0 {
            let (mine, rest) = inputs.split_at_mut(features.inputs());
            let (ours, others) = entities.split_at_mut(features.channels() * features.entities());
            features.write(s, mine, ours);
            (inputs, entities) = (rest, others);
        }
    }
}

/// A skill, ready to be evaluated.
///
/// Its network lies on the device, and what it is scaled by is known.
struct Ready<'a, S> {
    features: &'a (dyn Features<S> + Sync),
    model: Model,
    heads: Heads,
    scale: f32,
}

impl<S> Ready<'_, S> {
    /// All values of some states, `(row * heads + head) * actions + action`.
    fn values(&self, states: &[S]) -> Result<Vec<f32>, Error> {
        let mut batch = Batch::default();
        for s in states {
            batch.push(self.features, s).map_err(Error::Feature)?;
        }
        Ok(self.model.values(&batch))
    }
}

/// Learned skills that are composed.
///
/// ```
/// use tltl::compose::Compose as _;
/// use tltl::deep::{AsGiven, Composition, Device, Learner, Settings, Skill};
/// use tltl::model;
/// use tltl::network::Features;
/// use tltl::prelude::{Combine, ModelEnv, Product, tltl};
/// # #[derive(Clone, Copy)]
/// # struct Place;
/// # impl Features<usize> for Place {
/// #     fn inputs(&self) -> usize { 5 }
/// #     fn write(&self, s: &usize, inputs: &mut [f32], _: &mut [f32]) { inputs[*s] = 1.0; }
/// # }
///
/// // Five cells in a row: action 0 goes left, action 1 right. Two skills: reach an end each.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let mut env = ModelEnv::new(row)?;
/// let (left, right) = (tltl! { |s: &usize| F ({ *s } == 0) }, tltl! { |s: &usize| F ({ *s } == 4) });
/// let settings = Settings::default().with_hidden([16])?.with_batch(16)?.with_warmup(50)?;
/// let device = Device::flex();
/// let mut one = Learner::new(Skill::new(&left, Place), &env, settings.clone(), &device, 1);
/// let mut two = Learner::new(Skill::new(&right, Place), &env, settings.clone(), &device, 2);
/// one.train(&mut env, 1_000)?;
/// two.train(&mut env, 1_000)?;
///
/// // Both, by what the skills have seen. Beside an end the nearer one comes first.
/// let (steps, product) = (env.steps(), Product::conjunction(&[&left, &right]));
/// let skills = [one.learned()?, two.learned()?];
/// let mut both =
///     Composition::new(&product, &skills, AsGiven, Combine::Sum, settings, &device, 3)?;
/// both.refine(300)?;
/// assert_eq!([both.act(0, &1)?, both.act(0, &3)?], [0, 1]);
/// assert_eq!((both.updates(), env.steps()), (300, steps), "and not a step was taken");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Composition<'a, S, G> {
    product: &'a Product<'a, S>,
    settings: Settings,
    goals: G,
    combine: Combine,
    parts: Vec<Ready<'a, S>>,
    /// For each head the skills that count there, and their heads.
    terms: Vec<Vec<(usize, usize)>>,
    features: Joint<'a, S>,
    moves: Moves,
    bounds: Vec<(f64, f64)>,
    trainer: Trainer,
    replay: Replay<S>,
    rng: Xoshiro256PlusPlus,
    actions: usize,
}

impl<S, G> core::fmt::Debug for Composition<'_, S, G> {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Composition")
            .field("task", &self.product.name())
            .field("updates", &self.trainer.updates)
            .finish_non_exhaustive()
    }
}

impl<'a, S: Clone, G: Relabel<S>> Composition<'a, S, G> {
    /// Step 2: the composition of `skills`, in the order of the operands of `product`, on what
    /// they have seen. Of `settings` it reads those of updates and rewards; the rewards must be
    /// those that the skills were learned with, whose values are taken as they are. The goals of
    /// replayed steps are drawn from `goals` by the share [`Settings::relabelled`].
    ///
    /// # Errors
    /// If skills and product do not fit together, the reward pays for moves and the product has a way
    /// back ([`Error::WayBack`]), or a feature is not a finite number in a state that was seen.
    ///
    /// # Panics
    /// If nothing was seen.
    #[track_caller]
    pub fn new(
        product: &'a Product<'a, S>,
        skills: &[Learned<'a, S>],
        goals: G,
        combine: Combine,
        settings: Settings,
        device: &Device,
        seed: u64,
    ) -> Result<Self, Error> {
        let sizes = skills.iter().map(|skill| {
            let shape = skill.network.shape();
            (skill.task.name(), shape.heads, shape.actions)
        });
        check(product, &sizes.collect::<Vec<_>>())?;
        check_reward(product, &settings.rewards())?;
        let actions = skills[0].network.shape().actions;
        let rewards = settings.rewards();
        let moves = Moves::new(product, rewards);
        let heads = Heads::new(&moves, product.states());
        let features = Joint(skills.iter().map(|skill| skill.features).collect());
        let shape = Shape::of(&features, settings.hidden(), heads.states.len(), actions);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let network = Network::random(shape, &mut rng).silent();
        let seen: usize = skills.iter().map(|skill| skill.experience.len()).sum();
        assert!(seen > 1, "skills that have seen something");
        let mut replay = Replay::new(seen);
        skills.iter().for_each(|skill| replay.extend(skill.experience, |q| q));
        let ready = |skill: &Learned<'a, S>| {
            let heads = Heads::new(&Moves::new(skill.task, rewards), skill.task.states());
            let (features, model) = (skill.features, Model::new(&skill.network, device));
            Ready { features, model, heads, scale: 1.0 }
        };
        let paid = worst(&replay, rewards.environment());
        let parts: Vec<_> = skills.iter().map(ready).collect();
        let of_skills: Vec<_> = parts.iter().map(|part| &part.heads).collect();
        let mut composition = Self {
            terms: terms(product, &heads, &of_skills),
            parts,
            bounds: bounds(&moves.most(product), &rewards, paid),
            trainer: Trainer::new(Model::new(&network, device), heads, settings.normalisation()),
            product,
            settings,
            goals,
            combine,
            features,
            moves,
            replay,
            rng,
            actions,
        };
        if combine != Combine::Sum {
            composition.normalise()?;
        }
        Ok(composition)
    }

    /// Divides each skill's values by their largest in what was seen.
    fn normalise(&mut self) -> Result<(), Error> {
        // Enough to meet states beside the goals, which are worth the most, at the price of one batch.
        const LOOK: usize = 2_000;
        let step = (self.replay.len() / LOOK).max(1);
        let states = self.replay.moments().iter().step_by(step).map(|m| m.state.clone());
        let states: Vec<S> = states.collect();
        for part in &mut self.parts {
            let largest = part.values(&states)?.into_iter().fold(0.0, f32::max);
            part.scale = if largest > 0.0 { 1.0 / largest } else { 1.0 };
        }
        Ok(())
    }

    fn learn(&mut self, updates: u64, evaluates: bool) -> Result<(), Error> {
        let base = Base {
            product: self.product,
            parts: &self.parts,
            combine: self.combine,
            heads: &self.trainer.heads.clone(),
            terms: &self.terms,
            moves: &self.moves,
            bounds: &self.bounds,
            actions: self.actions,
            evaluates,
            settings: &self.settings,
        };
        for _ in 0..updates {
            let from = (&self.features, &self.goals);
            self.trainer.update(&mut self.replay, from, &base, &self.settings, &mut self.rng)?;
        }
        Ok(())
    }

    /// Q(s, q, ·) at a state of the product; zeros where the task is decided. With
    /// [`Settings::advantage_learning`] actions other than the best are lower than that.
    ///
    /// # Errors
    /// If a feature is not a finite number.
    pub fn values(&self, q: u32, s: &S) -> Result<Vec<f32>, Error> {
        let Some(head) = self.trainer.heads.of(q) else {
            return Ok(std::vec![0.0; self.actions]);
        };
        let states = core::slice::from_ref(s);
        let mut row = std::vec![0.0; self.actions];
        let of =
            self.parts.iter().map(|part| part.values(states)).collect::<Result<Vec<_>, _>>()?;
        combined(&self.parts, &of, self.combine, &self.terms[head], 0, &mut row);
        let mut batch = Batch::default();
        batch.push(&self.features, s).map_err(Error::Feature)?;
        let further = self.trainer.values_of(head, &batch);
        row.iter_mut().zip(further).for_each(|(v, f)| *v += f);
        Ok(row)
    }

    /// Updates so far.
    pub const fn updates(&self) -> u64 {
        self.trainer.updates
    }
}

impl<S: Clone, G: Relabel<S>> Compose for Composition<'_, S, G> {
    type State = S;
    type Action = usize;
    type Error = Error;

    /// Trains the further network until the whole is the values, in the product, of the sum's greedy
    /// policy, as [tables](crate::compose::Composition::compensated) have it.
    fn compensate(&mut self, updates: u64) -> Result<(), Error> {
        self.learn(updates, true)
    }

    /// Trains the further network until the whole is the optimum of the product, as far as what was
    /// seen tells.
    fn refine(&mut self, updates: u64) -> Result<(), Error> {
        self.learn(updates, false)
    }

    fn act(&self, q: u32, s: &S) -> Result<usize, Error> {
        Ok(argmax(&self.values(q, s)?))
    }
}

/// `Ok` if there is a network for each operand, all with the same actions. `skills` are the name of the
/// task, the heads and the actions (or components of an action) of each.
///
/// That a network is *of* the operand cannot be seen, only that it has as many heads as the operand
/// has live states.
pub(super) fn check<S>(
    product: &Product<'_, S>,
    skills: &[(&str, usize, usize)],
) -> Result<(), Mismatch> {
    let operands = product.operands();
    if skills.len() != operands.len() {
        let count = |n| std::format!("{n} tasks");
        let (found, expected) = (count(skills.len()), count(operands.len()));
        return Err(Mismatch::new("a composition", found, expected));
    }
    let first = skills[0].2;
    for (&(name, heads, actions), operand) in skills.iter().zip(operands) {
        let live = (0..operand.states()).filter(|&q| !operand.is_terminal(q)).count();
        if (heads, actions) != (live, first) {
            let size = |name: &str, heads, actions| {
                std::format!("`{name}` ({heads} live automaton states, {actions} actions)")
            };
            let (found, expected) = (size(name, heads, actions), size(operand.name(), live, first));
            return Err(Mismatch::new("a skill", found, expected));
        }
    }
    Ok(())
}

/// The least and the largest reward of the environment that was seen.
///
/// Together with the task's they bound every value.
fn worst<S>(replay: &Replay<S>, environment: f64) -> (f64, f64) {
    let seen = replay.moments().iter().map(|moment| environment * moment.reward);
    seen.fold((0.0, 0.0), |(least, most), r| (f64::min(least, r), f64::max(most, r)))
}

/// For each head of the product the skills that read states there and are not done, and their heads;
/// `skills` are the heads of each.
///
/// In a sequence only the operand that runs.
pub(super) fn terms<S>(
    product: &Product<'_, S>,
    heads: &Heads,
    skills: &[&Heads],
) -> Vec<Vec<(usize, usize)>> {
    let only = product.operator() == Operator::Sequence;
    let active = |&q: &u32| {
        let running = product.running(q);
        let all = product.components(q).iter().zip(skills).enumerate();
        let read = all.filter(|&(i, _)| !only || i == running);
        read.filter_map(|(i, (&at, skill))| Some((i, skill.of(at)?))).collect()
    };
    heads.states.iter().map(active).collect()
}

/// The skills' values of the state in `row` at the head of `terms`, combined.
fn combined<S>(
    parts: &[Ready<'_, S>],
    values: &[Vec<f32>],
    combine: Combine,
    terms: &[(usize, usize)],
    row: usize,
    out: &mut [f32],
) {
    let actions = out.len();
    for (n, &(i, head)) in terms.iter().enumerate() {
        let from = (row * parts[i].heads.states.len() + head) * actions;
        for (out, value) in out.iter_mut().zip(&values[i][from..from + actions]) {
            let value = value * parts[i].scale;
            *out = if combine == Combine::Max && n > 0 { out.max(value) } else { *out + value };
        }
    }
}

/// What the further network is to learn beside the skills.
///
/// Steps 3–5 evaluate the sum's greedy policy, which is fixed; step 6 improves the policy of sum and
/// network together. The two differ in who chooses.
struct Base<'a, S> {
    product: &'a Product<'a, S>,
    parts: &'a [Ready<'a, S>],
    combine: Combine,
    heads: &'a Heads,
    terms: &'a [Vec<(usize, usize)>],
    moves: &'a Moves,
    bounds: &'a [(f64, f64)],
    actions: usize,
    evaluates: bool,
    settings: &'a Settings,
}

impl<S> Objective<S> for Base<'_, S> {
    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error> {
        self.moves.read(self.product, q, step)
    }

    fn bounds(&self, q: u32) -> (f64, f64) {
        self.bounds[q as usize]
    }

    fn base(&self, states: &[S]) -> Result<Option<Vec<f32>>, Error> {
        let of =
            self.parts.iter().map(|part| part.values(states)).collect::<Result<Vec<_>, _>>()?;
        let mut base = std::vec![0.0; states.len() * self.heads.states.len() * self.actions];
        for (i, out) in base.chunks_mut(self.actions).enumerate() {
            let (row, head) = (i / self.heads.states.len(), i % self.heads.states.len());
            combined(self.parts, &of, self.combine, &self.terms[head], row, out);
        }
        Ok(Some(base))
    }

    fn evaluates(&self) -> bool {
        self.evaluates
    }

    /// Where all operands but one are decided, the product's optimum is that operand's, unless potentials
    /// are paid: those depend on the whole automaton.
    fn learns(&self, q: u32) -> bool {
        let exact = self.combine == Combine::Sum && self.settings.rewards().mode() != Mode::Shaped;
        let ends = self.product.components(q).iter().zip(self.parts);
        !exact || ends.filter(|(at, part)| part.heads.of(**at).is_some()).count() > 1
    }

    fn advantage_learning(&self) -> f64 {
        self.settings.advantage_learning()
    }

    fn advantage_penalty(&self) -> f64 {
        self.settings.advantage_penalty()
    }
}
