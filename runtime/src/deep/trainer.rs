//! One update of a network from replayed steps.
//!
//! An update draws a batch of steps, walks from each up to n steps on, asks the automaton what these do
//! at *every* live state, makes a target of it, and moves the weights: double DQN (the network chooses
//! the next action, its slow target values it), weights against the bias of prioritized replay, and
//! targets normalised for each head.
//!
//! [`Objective`] says what is learned: the optimum of one task ([`TaskObjective`]), or what is to be
//! added to skills that are composed. The trainer knows nothing of either.

use rand::Rng;
use std::string::ToString;
use std::vec::Vec;

use super::layers::Optimiser;
use super::model::{Batch, Model, Target};
use super::popart::PopArt;
use super::replay::Replay;
use super::sample::{Drawing, Heads, Sample};
use super::settings::Settings;
use super::{Error, Relabel};
use crate::augmented::Moves;
use crate::env::Step;
use crate::learn::episode::Move;
use crate::monitor::{Acceptor, Monitor};
use crate::network::{Features, Network, NetworkError};
use crate::q::argmax;
use crate::reward::{Mode, Rewards};
use crate::task;

/// Added to every error before it becomes a priority, so that no step is forgotten. Errors are of
/// normalised values, whose size is 1; a thousandth is well below what learning leaves.
const LEAST_ERROR: f64 = 1e-3;

/// `Ok` unless the reward pays for moves of the automaton, and one can be had again and again: then its
/// optimum need not satisfy the task.
pub(super) fn check_reward(
    task: &(impl Acceptor + ?Sized),
    rewards: &Rewards,
) -> Result<(), Error> {
    let paid = matches!(rewards.mode(), Mode::Progress | Mode::Literal);
    if paid && has_way_back(task) {
        return Err(Error::WayBack(task.name().to_string()));
    }
    Ok(())
}

/// Whether moves among live states can go on for ever, loops at a state left aside.
fn has_way_back(task: &(impl Acceptor + ?Sized)) -> bool {
    let mut ends: Vec<bool> = (0..task.states()).map(|q| task.is_terminal(q)).collect();
    loop {
        let mut found = false;
        // Numbers mostly grow along the moves, so this way round one pass mostly finds all.
        for q in (0..task.states()).rev().filter(|&q| !task.is_terminal(q)) {
            let mut comes_to_an_end = true;
            task.successors(q, &mut |to| comes_to_an_end &= to == q || ends[to as usize]);
            found |= comes_to_an_end && !ends[q as usize];
            ends[q as usize] |= comes_to_an_end;
        }
        if !found {
            return ends.contains(&false);
        }
    }
}

/// What an update is to learn.
///
/// What it does not override is as for a single task: no base, no bounds, everything learned.
pub(super) trait Objective<S> {
    /// What a step does at `q`, and what it pays there.
    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error>;

    /// Values that the network's are added to, indexed `(row * heads + head) * actions + action`; none
    /// are zeros.
    fn base(&self, states: &[S]) -> Result<Option<Vec<f32>>, Error>;

    /// The least and the most that can be had from an automaton state on. Bootstrapped values are kept
    /// between them, so that errors cannot feed on themselves.
    fn bounds(&self, _q: u32) -> (f64, f64) {
        (f64::NEG_INFINITY, f64::INFINITY)
    }

    /// Whether there is anything to learn at an automaton state; where not, the base is right.
    fn learns(&self, _q: u32) -> bool {
        true
    }

    /// α of advantage learning: the share of what an action falls short of the policy's that is taken
    /// off its value again.
    fn advantage_learning(&self) -> f64 {
        0.0
    }

    /// The weight of the squares of what actions add to the values of states.
    fn advantage_penalty(&self) -> f64 {
        0.0
    }

    /// Whether the policy is the greedy one of the base, not of base and network: then the two together
    /// *evaluate* it.
    fn evaluates(&self) -> bool {
        false
    }
}

/// The optimum of one task.
pub(super) struct TaskObjective<'a, M> {
    pub task: &'a M,
    pub moves: &'a Moves,
    /// For each automaton state the least and the most that can be had.
    pub bounds: &'a [(f64, f64)],
}

impl<S, M: Monitor<S>> Objective<S> for TaskObjective<'_, M> {
    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error> {
        self.moves.read(self.task, q, step)
    }

    fn bounds(&self, q: u32) -> (f64, f64) {
        self.bounds[q as usize]
    }

    fn base(&self, _: &[S]) -> Result<Option<Vec<f32>>, Error> {
        Ok(None)
    }
}

/// For each automaton state the least and the most that can be had, from the most that the task
/// pays and the least and the largest reward of the environment.
///
/// Both are generous: a bound that is too wide costs nothing, one that is too narrow would cut true
/// values off.
pub(super) fn bounds(most: &[f64], rewards: &Rewards, environment: (f64, f64)) -> Vec<(f64, f64)> {
    let for_ever = 1.0 / (1.0 - rewards.gamma());
    // Potentials add up to what the last is above the first, which is at least -1.
    let (each, once) = match rewards.mode() {
        Mode::Robustness => (rewards.bound(), 0.0),
        Mode::Shaped => (0.0, 1.0),
        _ => (0.0, 0.0),
    };
    let each = environment.0 - rewards.step_penalty() - each;
    let least = each * for_ever - once - rewards.trap_penalty();
    most.iter().map(|task| (least, (task + environment.1 * for_ever).max(least))).collect()
}

/// A network, its target, and what moves them.
///
/// `before` and `after` are buffers of features, kept so that an update allocates none.
pub(super) struct Trainer {
    pub heads: Heads,
    pub model: Model,
    pub target: Model,
    pub descent: Optimiser,
    pub popart: PopArt,
    pub updates: u64,
    before: Batch,
    after: Batch,
}

impl Trainer {
    pub(super) fn new(model: Model, heads: Heads, rate: f64) -> Self {
        Self {
            target: model.clone(),
            descent: Optimiser::new(model.dense().len()),
            popart: PopArt::new(heads.states.len(), rate),
            updates: 0,
            before: Batch::default(),
            after: Batch::default(),
            heads,
            model,
        }
    }

    /// The network, its normalisation taken back.
    pub(super) fn network(&self) -> Result<Network, NetworkError> {
        let mut model = self.model.clone();
        model.rescale(&self.popart, &PopArt::new(self.heads.states.len(), 0.0));
        model.network()
    }

    /// All values of some states, normalisation taken back.
    pub(super) fn values(&self, model: &Model, batch: &Batch) -> Vec<f32> {
        let mut values = model.values(batch);
        let (actions, heads) = (model.shape().actions, self.heads.states.len());
        for (i, row) in values.chunks_mut(actions).enumerate() {
            let (mean, deviation) = self.popart.scale(i % heads);
            row.iter_mut().for_each(|v| *v = *v * deviation as f32 + mean as f32);
        }
        values
    }

    /// A value of a head, normalisation taken back.
    fn scaled(&self, head: usize, value: f32) -> f32 {
        let (mean, deviation) = self.popart.scale(head);
        value * deviation as f32 + mean as f32
    }

    /// All values of a head in one state, normalisation taken back.
    pub(super) fn values_of(&self, head: usize, state: &Batch) -> Vec<f32> {
        let values = self.model.outputs(state).values(head);
        values.into_iter().map(|value| self.scaled(head, value)).collect()
    }

    /// Learns from one batch of steps; the loss.
    ///
    /// On an error nothing has been learned from the batch, and no priority has changed. (The
    /// normalisation has moved, which changes no value.)
    pub(super) fn update<S, F, G, O, R>(
        &mut self,
        replay: &mut Replay<S>,
        (features, goals): (&F, &G),
        objective: &O,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<f64, Error>
    where
        S: Clone,
        F: Features<S>,
        G: Relabel<S>,
        O: Objective<S>,
        R: Rng + ?Sized,
    {
        let how = Drawing {
            batch: settings.batch(),
            steps: settings.steps(),
            relabelled: settings.relabelled(),
            priority: settings.priority(),
            beta: settings.importance().at(self.updates),
            gamma: settings.rewards().gamma(),
            updates: settings.updates(),
        };
        let read = |q, step: &Step<S>| objective.read(q, step);
        let sample = Sample::draw(replay, &self.heads, goals, &read, &how, rng)?;
        self.before.encode(features, &sample.before).map_err(Error::Feature)?;
        self.after.encode(features, &sample.after).map_err(Error::Feature)?;
        let wanted = self.targets(&sample, objective)?;
        let learns: Vec<bool> = self.heads.states.iter().map(|&q| objective.learns(q)).collect();
        let learns = sample.counts.iter().zip(learns.iter().cycle());
        let counts: Vec<bool> = learns.map(|(counts, learns)| *counts && *learns).collect();
        self.normalise(&wanted, &counts);
        let targets = self.weighted(&sample, &wanted, &counts);
        let penalty = objective.advantage_penalty();
        let (loss, values, gradients) =
            self.model.gradients(&self.before, &sample.actions, &targets, penalty);
        if !loss.is_finite() {
            return Err(Error::Loss(self.updates));
        }
        let rate = settings.learning_rate().at(self.updates);
        self.descent.step(&mut self.model.layers, gradients, rate, settings.gradient_norm());
        self.target.follow(&self.model, settings.target_rate());
        self.prioritise(replay, &sample, &targets, &values, settings);
        self.updates += 1;
        Ok(f64::from(loss))
    }

    /// What the network should say of each step, indexed `row * heads + head`.
    ///
    /// With base and network B and f, and Q = B + f, the target of Q is
    /// `r + γ Q(s', π(s')) + α (Q(s, a) − Q(s, π(s)))`; π is greedy for Q, or, if it is evaluated, for B.
    fn targets<S, O: Objective<S>>(
        &self,
        sample: &Sample<S, u32>,
        objective: &O,
    ) -> Result<Vec<f64>, Error> {
        let (heads, actions) = (self.heads.states.len(), self.model.shape().actions);
        // Of a composition two passes through the networks of all skills; of a single task nothing.
        let (base, own) = (objective.base(&sample.after)?, objective.base(&sample.before)?);
        let (base, own) = (base.as_deref(), own.as_deref());
        let fixed = |base| objective.evaluates().then_some(base).flatten();
        let improved;
        let chooses = match fixed(base) {
            Some(base) => base,
            None => {
                improved = sum(self.values(&self.model, &self.after), base);
                &improved
            }
        };
        let target = self.target.outputs(&self.after);
        let share = objective.advantage_learning();
        let before = (share > 0.0).then(|| sum(self.values(&self.target, &self.before), own));
        let wanted = sample.returns.iter().enumerate().map(|(i, found)| {
            let mut wanted = found.reward;
            if found.discount > 0.0 {
                let next = i / heads * heads + found.head;
                let best = argmax(&chooses[next * actions..][..actions]);
                let value = self.scaled(found.head, target.value(next, best))
                    + base.map_or(0.0, |base| base[next * actions + best]);
                let (least, most) = objective.bounds(self.heads.states[found.head]);
                wanted += found.discount * f64::from(value).clamp(least, most);
            }
            let (row, action) = (i * actions, sample.actions[i / heads] as usize);
            if let Some(before) = before.as_deref() {
                let chooses = fixed(own).unwrap_or(before);
                let best = argmax(&chooses[row..row + actions]);
                wanted += share * f64::from(before[row + action] - before[row + best]);
            }
            wanted - own.map_or(0.0, |own| f64::from(own[row + action]))
        });
        Ok(wanted.collect())
    }

    /// Takes the targets into the normalisation.
    ///
    /// Network and target are both rewritten: their values stay what they were.
    fn normalise(&mut self, wanted: &[f64], counts: &[bool]) {
        let old = self.popart.clone();
        let heads = self.heads.states.len();
        for head in 0..heads {
            let rows = wanted.iter().zip(counts).skip(head).step_by(heads);
            self.popart.observe(head, rows.filter(|(_, counts)| **counts).map(|(w, _)| *w));
        }
        self.model.rescale(&old, &self.popart);
        self.target.rescale(&old, &self.popart);
    }

    /// The targets, normalised, each with the weight of its step, or 0 where it is not learned.
    fn weighted<S>(&self, sample: &Sample<S, u32>, wanted: &[f64], counts: &[bool]) -> Vec<Target> {
        let heads = self.heads.states.len();
        let targets = wanted.iter().zip(counts).enumerate().map(|(i, (wanted, counts))| {
            let (mean, deviation) = self.popart.scale(i % heads);
            let weight = if *counts { sample.weights[i / heads] as f32 } else { 0.0 };
            Target { value: ((wanted - mean) / deviation) as f32, weight }
        });
        targets.collect()
    }

    /// A step's priority is the mean error over the heads that learned from it, to the power of the
    /// settings.
    fn prioritise<S>(
        &self,
        replay: &mut Replay<S>,
        sample: &Sample<S, u32>,
        targets: &[Target],
        values: &[f32],
        settings: &Settings,
    ) {
        if settings.priority() == 0.0 {
            return;
        }
        let heads = self.heads.states.len();
        let rows = targets.chunks(heads).zip(values.chunks(heads));
        for (&place, (targets, values)) in sample.places.iter().zip(rows) {
            let counted = targets.iter().zip(values).filter(|(target, _)| target.weight > 0.0);
            let (n, error) = counted.fold((0, 0.0), |(n, sum), (target, value)| {
                (n + 1, sum + f64::from((target.value - value).abs()))
            });
            let error = if n == 0 { 0.0 } else { error / f64::from(n) };
            replay.prioritise(place, (error + LEAST_ERROR).powf(settings.priority()));
        }
    }
}

/// Two tables of values, entry by entry.
fn sum(mut values: Vec<f32>, base: Option<&[f32]>) -> Vec<f32> {
    if let Some(base) = base {
        values.iter_mut().zip(base).for_each(|(v, b)| *v += b);
    }
    values
}
