//! The way up of an actor: the gradient of its critics' values in its weights.
//!
//! Each head follows the slope of the values in its own actions (Silver et al. 2014). Slopes lead up the hill that
//! an actor is on; what was taken and is worth more leads it to another one ([`Trainer::imitate`]).

use rand::Rng;
use std::vec::Vec;

use super::stochastic::Drawn;
use super::sum::{Rows, Sum};
use super::trainer::{Trained, Trainer, joined, lesser, matrix, squashed};
use crate::deep::Error;
use crate::deep::layers::{Gradient, Pass, numbers};

/// What an actor climbs, in the states whose features are at hand.
pub(super) struct Hill<'a, S> {
    pub states: &'a [S],
    /// The action that was taken in each.
    pub taken: Rows<'a>,
    /// Which heads count, indexed `row * heads + head`.
    pub counts: &'a [bool],
    /// What the critics' values are added to.
    pub base: Option<&'a Sum<'a, S>>,
    pub imitation: f32,
}

impl Trainer {
    /// The gradient of minus the mean value of the actor's actions, summed over the heads, and what a stochastic
    /// one has drawn for it, whose entropy counts too.
    pub(super) fn ascent<S, R: Rng + ?Sized>(
        &self,
        hill: &Hill<'_, S>,
        rng: &mut R,
    ) -> Result<(Vec<Gradient>, Drawn), Error> {
        let layers = &self.actor.layers;
        let Pass { inputs, out } = layers.pass(self.before.tensor(&layers.device()));
        let [rows, width] = out.dims();
        let (drawn, error) = if let Some(temperature) = &self.temperature {
            let drawn = self.drawn(out, rng);
            let error = self.slopes(hill, &drawn.actions)?;
            let weight = temperature.weight() as f32 / rows as f32;
            let counts = |i: usize| if hill.counts[i / self.components] { weight } else { 0.0 };
            let error = drawn.back(&error, counts);
            (drawn, error)
        } else {
            let actions = squashed(out);
            let mut error = self.slopes(hill, &actions)?;
            error.iter_mut().zip(&actions).for_each(|(e, a)| *e *= 1.0 - a * a);
            (Drawn::default(), error)
        };
        Ok((layers.back(&inputs, matrix(error, width, &layers.device())), drawn))
    }

    /// The critics that the actor follows: a deterministic one the first (TD3), a stochastic one the least at
    /// each head (SAC).
    fn followed(&self) -> &[Trained] {
        &self.critics[..if self.temperature.is_some() { self.critics.len() } else { 1 }]
    }

    /// The gradient of minus the mean value of actions, summed over the heads, in the components of each.
    fn slopes<S>(&self, hill: &Hill<'_, S>, actions: &[f32]) -> Result<Vec<f32>, Error> {
        let (heads, m) = (self.heads.states.len(), self.components);
        let mut error = std::vec![0.0; actions.len()];
        let live: Vec<usize> = (0..hill.counts.len()).filter(|&i| hill.counts[i]).collect();
        if live.is_empty() {
            return Ok(error);
        }
        let rows: Vec<_> = live.iter().map(|&i| (i / heads, &actions[i * m..][..m])).collect();
        let own: Vec<usize> = live.iter().map(|i| i % heads).collect();
        let (device, share) = (self.actor.layers.device(), 1.0 / self.before.len() as f32);
        let inputs = joined(&self.before, rows.iter().copied(), m, &device);
        let passes: Vec<_> =
            self.followed().iter().map(|c| c.layers.pass(inputs.clone())).collect();
        let (lowest, mut values) = lowest(&passes, &own, heads);
        let mut slopes = std::vec![0.0; rows.len() * m];
        for (c, (critic, through)) in self.followed().iter().zip(&passes).enumerate() {
            let mut weights = std::vec![0.0; rows.len() * heads];
            for (row, head) in own.iter().enumerate().filter(|&(row, _)| lowest[row] == c) {
                weights[row * heads + head] = -share;
            }
            let (weights, first) = (matrix(weights, heads, &device), self.before.row(0).len());
            let found = numbers(critic.layers.back_to_inputs(&through.inputs, weights, first));
            slopes.iter_mut().zip(found).for_each(|(sum, slope)| *sum += slope);
        }
        if let Some(base) = hill.base {
            let (more, found) = base.slopes(hill.states, &rows, &own)?;
            values.iter_mut().zip(more).for_each(|(value, more)| *value += more);
            slopes.iter_mut().zip(found).for_each(|(sum, slope)| *sum -= share * slope);
        }
        if hill.imitation > 0.0 {
            self.imitate(hill, (&rows, &own), &values, &mut slopes)?;
        }
        for (i, slopes) in live.into_iter().zip(slopes.chunks(m)) {
            error[i * m..][..m].copy_from_slice(slopes);
        }
        Ok(error)
    }

    /// Adds to the slopes of actions, each at its own head and of some value there, what draws them towards those
    /// that were taken where these are worth more.
    fn imitate<S>(
        &self,
        hill: &Hill<'_, S>,
        (rows, own): (Rows<'_>, &[usize]),
        values: &[f32],
        slopes: &mut [f32],
    ) -> Result<(), Error> {
        let (heads, m) = (self.heads.states.len(), self.components);
        let (taken, device) = (hill.taken, self.actor.layers.device());
        let inputs = joined(&self.before, taken.iter().copied(), m, &device);
        let mut others = std::vec![f32::INFINITY; taken.len() * heads];
        for critic in self.followed() {
            let found = numbers(critic.layers.pass(inputs.clone()).out);
            others.iter_mut().zip(found).for_each(|(least, value)| *least = lesser(*least, value));
        }
        if let Some(base) = hill.base {
            let base = base.values(hill.states, taken)?;
            others.iter_mut().zip(base).for_each(|(value, base)| *value += base);
        }
        let weight = hill.imitation / self.before.len() as f32;
        let all = rows.iter().zip(own).zip(values).zip(slopes.chunks_mut(m));
        for (((&(row, action), head), value), slopes) in all {
            if others[row * heads + head] > *value {
                let pairs = action.iter().zip(taken[row].1);
                let both = slopes.iter_mut().zip(pairs);
                both.for_each(|(slope, (action, taken))| *slope += weight * (action - taken));
            }
        }
        Ok(())
    }
}

/// For each row the critic that says the least at the row's own head, and what it says.
fn lowest(passes: &[Pass], own: &[usize], heads: usize) -> (Vec<usize>, Vec<f32>) {
    let values: Vec<_> = passes.iter().map(|pass| numbers(pass.out.clone())).collect();
    let of = |(row, head): (usize, &usize)| {
        let value = |c: usize| values[c][row * heads + head];
        let lowest =
            (1..values.len()).fold(0, |least, c| if value(c) < value(least) { c } else { least });
        (lowest, value(lowest))
    };
    own.iter().enumerate().map(of).unzip()
}
