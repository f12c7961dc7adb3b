//! One update of an actor and its critics from replayed steps.
//!
//! The critics are drawn towards what a step pays and what the target networks say comes after it, at
//! *every* live automaton state: the action of a step is the same for all, so one pass of a critic has
//! the values of all heads. The actor climbs those ([`ascent`](super::ascent)).
//!
//! Actions here are within ±1: tanh of what the actor puts out. A stochastic actor puts out twice as much: a mean
//! for each component, then a spread for each.

use burn::tensor::{Device, Tensor, TensorData};
use rand::Rng;
use std::vec::Vec;

use super::Settings;
use super::ascent::Hill;
use super::stochastic::{Drawn, Temperature};
use super::sum::{Rows, Sum};
use crate::deep::layers::{AdamMoments, Gradient, Layers, Optimiser, numbers};
use crate::deep::model::Batch;
use crate::deep::replay::Replay;
use crate::deep::sample::{Drawing, Heads, Return, Sample};
use crate::deep::{Error, Relabel};
use crate::env::{Step, unit};
use crate::episode::Move;
use crate::network::{Activation, Dense, Features, Network, Shape};
use crate::task;

/// What an update asks of the task.
pub(super) trait Task<S> {
    /// What a step does at `q`, and what it pays there.
    fn read(&self, q: u32, step: &Step<S>) -> Result<Move, task::Error>;

    /// The potential of a state of the world within `q`.
    fn potential(&self, q: u32, s: &S) -> Result<f64, task::Error>;

    /// The least and the most that can be had from an automaton state on.
    fn bounds(&self, q: u32) -> (f64, f64);

    /// What the critics' values are added to, and the actor follows with them; without one they are
    /// all there is.
    fn base(&self) -> Option<&Sum<'_, S>> {
        None
    }

    /// Whether the actor stays as it is: then base and critics *evaluate* it.
    fn evaluates(&self) -> bool {
        false
    }

    /// How much the actor [imitates](Settings::imitation).
    fn imitation(&self) -> f64 {
        0.0
    }
}

/// A network, the slow copy that targets are computed with, and what moves it.
pub(super) struct Trained {
    pub layers: Layers,
    pub target: Layers,
    pub descent: Optimiser,
}

impl Trained {
    fn new(network: &Network, device: &Device) -> Self {
        let layers = Layers::of(network.layers(), device);
        let descent = Optimiser::new(network.layers().len());
        Self { target: layers.clone(), layers, descent }
    }

    pub(super) fn resume(saved: &SavedNetwork, shape: &Shape, device: &Device) -> Option<Self> {
        let fit = |layers: &[Dense]| Network::new(shape.clone(), layers.to_vec()).is_ok();
        let moments = saved.moments.as_ref();
        let fits = fit(&saved.network)
            && fit(&saved.target)
            && moments.is_none_or(|moments| moments.fit(&saved.network));
        fits.then(|| Self {
            layers: Layers::of(&saved.network, device),
            target: Layers::of(&saved.target, device),
            descent: match moments {
                Some(moments) => Optimiser::resume(moments, device),
                None => Optimiser::new(saved.network.len()),
            },
        })
    }

    pub(super) fn saved(&self) -> SavedNetwork {
        SavedNetwork {
            network: self.layers.dense(),
            target: self.target.dense(),
            moments: self.descent.moments(),
        }
    }
}

/// A network as it is saved while it learns.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct SavedNetwork {
    network: Vec<Dense>,
    target: Vec<Dense>,
    moments: Option<AdamMoments>,
}

impl SavedNetwork {
    /// The width of its first layer, if it has one.
    pub(super) fn inputs(&self) -> Option<usize> {
        let first = self.network.first()?;
        first.weights.len().checked_div(first.bias.len())
    }
}

/// An actor and its critics.
///
/// `before` and `after` are buffers of features, kept so that an update allocates none.
pub(super) struct Trainer {
    pub heads: Heads,
    /// The components of an action.
    pub components: usize,
    pub actor: Trained,
    pub critics: Vec<Trained>,
    /// What entropy weighs, where the actor is stochastic.
    pub temperature: Option<Temperature>,
    pub updates: u64,
    pub before: Batch,
    after: Batch,
}

/// The sizes of the actor and of a critic: features, then for each head a number for each component, of a
/// stochastic actor for as many heads again; and features and components, then a value for each head.
pub(super) fn shapes(
    inputs: usize,
    components: usize,
    heads: usize,
    settings: &Settings,
) -> [Shape; 2] {
    let hidden = settings.hidden().to_vec();
    let critic =
        Shape { inputs: inputs + components, hidden, heads, actions: 1, entities: 0, channels: 0 };
    let heads = if settings.entropy().is_some() { 2 * heads } else { heads };
    [Shape { inputs, heads, actions: components, ..critic.clone() }, critic]
}

impl Trainer {
    pub(super) fn new<R: Rng + ?Sized>(
        [actor, critic]: [Shape; 2],
        settings: &Settings,
        heads: Heads,
        device: &Device,
        rng: &mut R,
    ) -> Self {
        let components = actor.actions;
        let mut random = |shape: &Shape| Trained::new(&Network::random(shape.clone(), rng), device);
        let actor = random(&actor);
        let critics = (0..settings.critics()).map(|_| random(&critic)).collect();
        let temperature = settings.entropy().map(|_| Temperature::new());
        Self::of(heads, components, (actor, temperature), critics, 0)
    }

    pub(super) fn of(
        heads: Heads,
        components: usize,
        (actor, temperature): (Trained, Option<Temperature>),
        critics: Vec<Trained>,
        updates: u64,
    ) -> Self {
        let (before, after) = (Batch::default(), Batch::default());
        Self { heads, components, actor, critics, temperature, updates, before, after }
    }

    /// Makes the critics say 0 of everything.
    pub(super) fn silence(&mut self) {
        for critic in &mut self.critics {
            critic.layers.silence();
            critic.target = critic.layers.clone();
        }
    }

    /// Takes the actor itself for targets, as for one that stays as it is.
    pub(super) fn settle(&mut self) {
        self.actor.target = self.actor.layers.clone();
    }

    /// The actions of all heads of a deterministic actor, indexed `(row * heads + head) * components + component`.
    pub(super) fn actions(actor: &Layers, batch: &Batch) -> Vec<f32> {
        squashed(actor.pass(batch.tensor(&actor.device())).out)
    }

    /// The actions that a stochastic actor draws by what it puts out; all heads', as above.
    pub(super) fn drawn<R: Rng + ?Sized>(&self, out: Tensor<2>, rng: &mut R) -> Drawn {
        let width = self.heads.states.len() * self.components;
        Drawn::new(&numbers(out), width, || normal(rng) as f32)
    }

    /// The layers that put out what the actor does where it draws nothing: of a stochastic one the means.
    pub(super) fn greedy(&self) -> Vec<Dense> {
        let mut layers = self.actor.layers.dense();
        let last = layers.last_mut().expect("a network has a layer");
        let (out, width) = (last.bias.len(), self.heads.states.len() * self.components);
        last.weights = last.weights.chunks(out).flat_map(|row| &row[..width]).copied().collect();
        last.bias.truncate(width);
        layers
    }

    /// The least of the critics' values of an action in one state.
    pub(super) fn value(&self, head: usize, state: &Batch, action: &[f32]) -> f32 {
        let critics = self.critics.iter().map(|critic| {
            let inputs = joined(state, [(0, action)], self.components, &critic.layers.device());
            numbers(critic.layers.pass(inputs).out)[head]
        });
        critics.fold(f32::INFINITY, lesser)
    }

    /// Learns from one batch of steps; the mean loss of the critics.
    ///
    /// On an error nothing has been learned from the batch.
    pub(super) fn update<S, F, G, R>(
        &mut self,
        replay: &Replay<S, Vec<f32>>,
        (features, goals): (&F, &G),
        task: &impl Task<S>,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<f64, Error>
    where
        S: Clone,
        F: Features<S>,
        G: Relabel<S>,
        R: Rng + ?Sized,
    {
        let sample = self.draw(replay, (features, goals), task, settings, rng)?;
        self.after.encode(features, &sample.after).map_err(Error::Feature)?;
        let mut targets = self.targets(&sample, task, settings, rng)?;
        let rows: Vec<_> = sample.actions.iter().map(Vec::as_slice).enumerate().collect();
        if let Some(base) = task.base() {
            let base = base.values(&sample.before, &rows)?;
            targets.iter_mut().zip(base).for_each(|(target, base)| *target -= base);
        }
        let loss = self.teach_critics(&rows, &targets, &sample.counts, settings)?;
        self.updates += 1;
        if self.updates.is_multiple_of(settings.actor_delay()) {
            if !task.evaluates() {
                self.teach_actor(&sample, task, settings, rng)?;
            }
            let all = self.critics.iter_mut().chain([&mut self.actor]);
            all.for_each(|net| net.target.follow(&net.layers, settings.target_rate()));
        }
        Ok(loss)
    }

    /// Moves the actor alone, for one batch of states.
    pub(super) fn fit<S, F, G, R>(
        &mut self,
        replay: &Replay<S, Vec<f32>>,
        from: (&F, &G),
        task: &impl Task<S>,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<(), Error>
    where
        S: Clone,
        F: Features<S>,
        G: Relabel<S>,
        R: Rng + ?Sized,
    {
        let sample = self.draw(replay, from, task, settings, rng)?;
        self.teach_actor(&sample, task, settings, rng)
    }

    /// A batch of steps, and the features of the states before them.
    fn draw<S, F, G, R>(
        &mut self,
        replay: &Replay<S, Vec<f32>>,
        (features, goals): (&F, &G),
        task: &impl Task<S>,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<Sample<S, Vec<f32>>, Error>
    where
        S: Clone,
        F: Features<S>,
        G: Relabel<S>,
        R: Rng + ?Sized,
    {
        let how = Drawing {
            batch: settings.batch(),
            steps: settings.steps(),
            relabelled: settings.relabelled(),
            priority: 0.0,
            beta: 0.0,
            gamma: settings.rewards().gamma(),
            updates: settings.updates(),
        };
        let read = |q, step: &Step<S>| task.read(q, step);
        let sample = Sample::draw(replay, &self.heads, goals, &read, &how, rng)?;
        self.before.encode(features, &sample.before).map_err(Error::Feature)?;
        Ok(sample)
    }

    /// What the critics should say of each step, indexed `row * heads + head`.
    fn targets<S, R: Rng + ?Sized>(
        &self,
        sample: &Sample<S, Vec<f32>>,
        task: &impl Task<S>,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<Vec<f32>, Error> {
        let (heads, m) = (self.heads.states.len(), self.components);
        let (actions, entropies) = self.next(settings, rng);
        // A row for each return that something follows.
        let follows =
            || sample.returns.iter().enumerate().filter(|(_, found)| found.discount > 0.0);
        let row = |(i, found): (usize, &Return)| {
            let row = i / heads;
            (row, &actions[(row * heads + found.head) * m..][..m])
        };
        let rows: Vec<_> = follows().map(row).collect();
        let mut values = std::vec![f32::INFINITY; rows.len()];
        let device = self.actor.layers.device();
        if !values.is_empty() {
            let inputs = joined(&self.after, rows.iter().copied(), m, &device);
            for critic in &self.critics {
                let found = numbers(critic.target.pass(inputs.clone()).out);
                let rows = values.iter_mut().zip(found.chunks(heads)).zip(follows());
                rows.for_each(|((least, row), (_, next))| *least = lesser(*least, row[next.head]));
            }
        }
        if let Some(base) = task.base() {
            let base = base.values(&sample.after, &rows)?;
            let rows = values.iter_mut().zip(base.chunks(heads)).zip(follows());
            rows.for_each(|((value, row), (_, next))| *value += row[next.head]);
        }
        let mut values = values.into_iter();
        let targets = sample.returns.iter().enumerate().map(|(i, found)| {
            if !sample.counts[i] {
                return Ok(0.0);
            }
            let (row, q) = (i / heads, self.heads.states[i % heads]);
            let mut wanted = found.reward - task.potential(q, &sample.before[row])?;
            if found.discount > 0.0 {
                let q = self.heads.states[found.head];
                let (least, most) = task.bounds(q);
                let value = f64::from(values.next().expect("a value for each"));
                let potential = task.potential(q, &sample.after[row])?;
                // No number stays none, so that the loss shows it; what entropies add up to is not bounded.
                let is_bounded = !value.is_nan() && entropies.is_empty();
                let value = if is_bounded { value.clamp(least, most) } else { value };
                let entropy =
                    entropies.get(row * heads + found.head).map_or(0.0, |e| f64::from(*e));
                wanted += found.discount * (value + entropy + potential);
            }
            Ok(wanted as f32)
        });
        targets.collect::<Result<_, task::Error>>().map_err(Error::from)
    }

    /// The actions that come next, of all heads, as targets take them: the target actor's, and noise; or drawn by a
    /// stochastic actor itself, then with what the entropy of each head's is worth.
    fn next<R: Rng + ?Sized>(&self, settings: &Settings, rng: &mut R) -> (Vec<f32>, Vec<f32>) {
        if let Some(temperature) = &self.temperature {
            let layers = &self.actor.layers;
            let drawn = self.drawn(layers.pass(self.after.tensor(&layers.device())).out, rng);
            let weight = temperature.weight() as f32;
            let entropies = drawn.entropies(self.components).map(|entropy| weight * entropy);
            let entropies = entropies.collect();
            return (drawn.actions, entropies);
        }
        let mut actions = Self::actions(&self.actor.target, &self.after);
        let (deviation, clip) = (settings.target_noise(), settings.target_noise_clip());
        if deviation > 0.0 {
            for a in &mut actions {
                let noise = (deviation * normal(rng)).clamp(-clip, clip);
                *a = (*a + noise as f32).clamp(-1.0, 1.0);
            }
        }
        (actions, Vec::new())
    }

    /// Half the mean square error over the steps, summed over the heads.
    fn teach_critics(
        &mut self,
        rows: Rows<'_>,
        targets: &[f32],
        counts: &[bool],
        settings: &Settings,
    ) -> Result<f64, Error> {
        let (rows, device) = (rows.iter().copied(), self.actor.layers.device());
        let inputs = joined(&self.before, rows, self.components, &device);
        let mut found = Vec::new();
        for critic in &self.critics {
            found.push(critic.gradients(inputs.clone(), targets, counts));
        }
        let loss = found.iter().map(|(loss, _)| f64::from(*loss)).sum::<f64>() / found.len() as f64;
        if !loss.is_finite() {
            return Err(Error::Loss(self.updates));
        }
        let rate = settings.critic_rate().at(self.updates);
        for (critic, (_, gradients)) in self.critics.iter_mut().zip(found) {
            let Trained { layers, descent, .. } = critic;
            descent.step(layers, gradients, rate, settings.gradient_norm());
        }
        Ok(loss)
    }

    /// Moves the actor towards actions that the critics value more, and the temperature towards the entropy that
    /// is wanted.
    fn teach_actor<S, R: Rng + ?Sized>(
        &mut self,
        sample: &Sample<S, Vec<f32>>,
        task: &impl Task<S>,
        settings: &Settings,
        rng: &mut R,
    ) -> Result<(), Error> {
        let taken: Vec<_> = sample.actions.iter().map(Vec::as_slice).enumerate().collect();
        let (counts, imitation) = (&sample.counts[..], task.imitation() as f32);
        let (states, taken, base) = (&sample.before[..], &taken[..], task.base());
        let hill = Hill { states, taken, counts, base, imitation };
        let (gradients, drawn) = self.ascent(&hill, rng)?;
        let rate = settings.actor_rate().at(self.updates);
        let Trained { layers, descent, .. } = &mut self.actor;
        descent.step(layers, gradients, rate, settings.gradient_norm());
        let Some((temperature, wanted)) = self.temperature.as_mut().zip(settings.entropy()) else {
            return Ok(());
        };
        let wanted = self.components as f64 * wanted;
        let counted = drawn.entropies(self.components).zip(counts).filter(|(_, counts)| **counts);
        let (sum, count) = counted.fold((0.0, 0.0), |(sum, count), (entropy, _)| {
            (sum + wanted - f64::from(entropy), count + 1.0)
        });
        // Where nothing counts nothing is lacking.
        temperature.tune(sum / f64::max(count, 1.0), rate);
        Ok(())
    }
}

impl Trained {
    /// The loss of a critic, half the square of the errors that count, and its gradients.
    pub(super) fn gradients(
        &self,
        inputs: Tensor<2>,
        targets: &[f32],
        counts: &[bool],
    ) -> (f32, Vec<Gradient>) {
        let [rows, _] = inputs.dims();
        let pass = self.layers.pass(inputs);
        let share = 1.0 / rows as f32;
        let mut loss = 0.0;
        let slope = |((value, target), counts): ((f32, &f32), &bool)| {
            let error = if *counts { value - target } else { 0.0 };
            loss += 0.5 * share * error * error;
            share * error
        };
        let values = numbers(pass.out).into_iter().zip(targets).zip(counts);
        let slopes: Vec<f32> = values.map(slope).collect();
        let slopes = matrix(slopes, targets.len() / rows, &self.layers.device());
        (loss, self.layers.back(&pass.inputs, slopes))
    }
}

/// The lesser of two numbers; what is no number stays none, so that the loss shows it.
pub(super) fn lesser(a: f32, b: f32) -> f32 {
    if a < b || a.is_nan() { a } else { b }
}

/// Rows of numbers as a tensor.
pub(super) fn matrix(numbers: Vec<f32>, width: usize, device: &Device) -> Tensor<2> {
    let rows = numbers.len() / width;
    Tensor::from_data(TensorData::new(numbers, [rows, width]), device)
}

/// tanh of all numbers, as policies have it where they run.
pub(super) fn squashed(out: Tensor<2>) -> Vec<f32> {
    numbers(out).into_iter().map(|x| Activation::Tanh.of(x)).collect()
}

/// What a critic reads: the features of some rows of a batch, each with an action.
pub(super) fn joined<'a>(
    batch: &Batch,
    rows: impl IntoIterator<Item = (usize, &'a [f32])>,
    components: usize,
    device: &Device,
) -> Tensor<2> {
    let mut inputs = Vec::new();
    for (row, action) in rows {
        inputs.extend_from_slice(batch.row(row));
        inputs.extend_from_slice(action);
    }
    matrix(inputs, batch.row(0).len() + components, device)
}

/// A number with the normal distribution (Box and Muller 1958).
pub(super) fn normal<R: Rng + ?Sized>(rng: &mut R) -> f64 {
    let (u, angle) = (1.0 - unit(rng), core::f64::consts::TAU * unit(rng));
    (-2.0 * u.ln()).sqrt() * angle.cos()
}
