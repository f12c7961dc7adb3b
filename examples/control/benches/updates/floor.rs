//! The floor: TD3 as one writes it by hand for one task, with arrays that are never made anew.
//!
//! No automaton, one head, transitions that are ready, the fastest products of matrices without
//! `unsafe`. It goes on from a learner's checkpoint with the same random numbers, so that both do the
//! same arithmetic.

use ndarray::linalg::general_mat_mul;
use ndarray::{Array1, Array2, Axis, Slice, Zip};
use serde_json::Value;
use tltl::rand::Rng;
use tltl::rand::rngs::Xoshiro256PlusPlus;

/// The settings that both have; the others are the defaults of a learner.
pub(crate) const GAMMA: f64 = 0.99;
const RATE: f32 = 1e-3;
const TARGET_RATE: f32 = 0.005;
const LONGEST: f32 = 10.0;

/// A transition: what is seen, the action, the reward, what is seen then, and whether more follows.
pub(crate) struct Seen {
    pub(crate) before: Vec<f32>,
    pub(crate) action: Vec<f32>,
    pub(crate) reward: f64,
    pub(crate) after: Vec<f32>,
    pub(crate) goes_on: bool,
}

type Layer = (Array2<f32>, Array1<f32>);

/// A network with its target, Adam's moments, and the arrays of a batch on its way through it.
struct Net {
    layers: Vec<Layer>,
    target: Vec<Layer>,
    first: Vec<Layer>,
    second: Vec<Layer>,
    gradients: Vec<Layer>,
    time: i32,
    /// What enters each layer, and what the last puts out.
    values: Vec<Array2<f32>>,
    /// The gradients of those.
    errors: Vec<Array2<f32>>,
}

fn layers(saved: &Value, inputs: usize) -> Vec<Layer> {
    let numbers = |value: &Value| -> Vec<f32> {
        value.as_array().expect("numbers").iter().map(|x| x.as_f64().expect("one") as f32).collect()
    };
    let mut width = inputs;
    let layer = |layer: &Value| {
        let (weights, bias) = (numbers(&layer["weights"]), numbers(&layer["bias"]));
        let shape = (width, bias.len());
        width = bias.len();
        (Array2::from_shape_vec(shape, weights).expect("as many"), Array1::from_vec(bias))
    };
    saved.as_array().expect("layers").iter().map(layer).collect()
}

/// A batch through the layers.
fn forward(layers: &[Layer], values: &mut [Array2<f32>]) {
    for (i, (weights, bias)) in layers.iter().enumerate() {
        let (before, after) = values.split_at_mut(i + 1);
        let out = &mut after[0];
        out.rows_mut().into_iter().for_each(|mut row| row.assign(bias));
        general_mat_mul(1.0, &before[i], weights, 1.0, out);
        if i + 1 < layers.len() {
            out.mapv_inplace(|x| if x > 0.0 { x } else { 0.0 });
        }
    }
}

impl Net {
    fn of(saved: &Value, inputs: usize, batch: usize) -> Self {
        let (moments, own) = (&saved["moments"], layers(&saved["network"], inputs));
        let widths = [inputs].into_iter().chain(own.iter().map(|(_, bias)| bias.len()));
        let arrays: Vec<_> = widths.map(|width| Array2::zeros((batch, width))).collect();
        Self {
            gradients: own.clone(),
            layers: own,
            target: layers(&saved["target"], inputs),
            first: layers(&moments["first"], inputs),
            second: layers(&moments["second"], inputs),
            time: moments["time"].as_i64().expect("a count") as i32,
            values: arrays.clone(),
            errors: arrays,
        }
    }

    fn forward(&mut self) {
        forward(&self.layers, &mut self.values);
    }

    /// From the errors of what was put out to the gradients, or, without those, to the errors of the inputs.
    fn backward(&mut self, gradients: bool) {
        for i in (0..self.layers.len()).rev() {
            let (before, after) = self.errors.split_at_mut(i + 1);
            let (error, out) = (&mut before[i], &after[0]);
            if gradients {
                let (weights, bias) = &mut self.gradients[i];
                general_mat_mul(1.0, &self.values[i].t(), out, 0.0, weights);
                bias.assign(&out.sum_axis(Axis(0)));
            }
            if i > 0 || !gradients {
                general_mat_mul(1.0, out, &self.layers[i].0.t(), 0.0, error);
            }
            if i > 0 {
                let off = |e: &mut f32, &x: &f32| *e = if x > 0.0 { *e } else { 0.0 };
                Zip::from(error).and(&self.values[i]).for_each(off);
            }
        }
    }

    /// A step of Adam (Kingma and Ba 2015).
    fn descend(&mut self) {
        let squares = |(w, b): &Layer| {
            w.iter().map(|g| g * g).sum::<f32>() + b.iter().map(|g| g * g).sum::<f32>()
        };
        let norm = self.gradients.iter().map(squares).sum::<f32>().sqrt();
        let scale = if norm > LONGEST { LONGEST / norm } else { 1.0 };
        self.time += 1;
        let [one, two] = [0.9_f32, 0.999].map(|beta| 1.0 - beta.powi(self.time));
        let step = |w: &mut f32, &g: &f32, m: &mut f32, v: &mut f32| {
            let g = scale * g;
            *m = 0.9 * *m + 0.1 * g;
            *v = 0.999 * *v + 0.001 * g * g;
            *w -= RATE * (*m / one) / ((*v / two).sqrt() + 1e-8);
        };
        for (i, (weights, bias)) in self.layers.iter_mut().enumerate() {
            let (g, m, v) = (&self.gradients[i], &mut self.first[i], &mut self.second[i]);
            Zip::from(weights).and(&g.0).and(&mut m.0).and(&mut v.0).for_each(step);
            Zip::from(bias).and(&g.1).and(&mut m.1).and(&mut v.1).for_each(step);
        }
    }

    fn follow(&mut self) {
        let near = |to: &mut f32, &from: &f32| *to += TARGET_RATE * (from - *to);
        for (to, from) in self.target.iter_mut().zip(&self.layers) {
            Zip::from(&mut to.0).and(&from.0).for_each(near);
            Zip::from(&mut to.1).and(&from.1).for_each(near);
        }
    }
}

/// An actor and two critics, and what they learn from.
pub(crate) struct Floor {
    actor: Net,
    critics: [Net; 2],
    updates: u64,
    /// A transition for each place of the replay that has one.
    seen: Vec<Option<Seen>>,
    rng: Xoshiro256PlusPlus,
    batch: usize,
    targets: Vec<f32>,
}

impl Floor {
    /// What goes on from a learner's checkpoint.
    pub(crate) fn of(saved: &Value, seen: Vec<Option<Seen>>, batch: usize) -> Self {
        let some = seen.iter().flatten().next().expect("a transition");
        let (inputs, m) = (some.before.len(), some.action.len());
        let critic = |i: usize| Net::of(&saved["critics"][i], inputs + m, batch);
        Self {
            actor: Net::of(&saved["actor"], inputs, batch),
            critics: [critic(0), critic(1)],
            updates: saved["updates"].as_u64().expect("a count"),
            seen,
            rng: serde_json::from_value(saved["rng"].clone()).expect("a generator"),
            batch,
            targets: Vec::new(),
        }
    }

    /// One update, as [`tltl::deep::actor::Learner::rehearse`] makes it.
    pub(crate) fn update(&mut self) {
        let Self { actor, critics, seen, rng, .. } = self;
        let drawn: Vec<&Seen> = (0..self.batch).map(|_| draw(seen, rng)).collect();
        let inputs = drawn[0].before.len();
        // What the targets say of the states after.
        for (mut row, step) in actor.values[0].rows_mut().into_iter().zip(&drawn) {
            row.iter_mut().zip(&step.after).for_each(|(x, after)| *x = *after);
        }
        forward(&actor.target, &mut actor.values);
        let noisy = |out: &f32, rng: &mut Xoshiro256PlusPlus| {
            let noise = (0.2 * normal(rng)).clamp(-0.5, 0.5) as f32;
            (out.tanh() + noise).clamp(-1.0, 1.0)
        };
        let last = actor.values.len() - 1;
        let actions = actor.values[last].map(|out| noisy(out, rng));
        self.targets.clear();
        self.targets.resize(self.batch, f32::INFINITY);
        for critic in critics.iter_mut() {
            critic.values[0]
                .slice_axis_mut(Axis(1), Slice::from(..inputs))
                .assign(&actor.values[0]);
            critic.values[0].slice_axis_mut(Axis(1), Slice::from(inputs..)).assign(&actions);
            forward(&critic.target, &mut critic.values);
            let values = critic.values[last].iter();
            self.targets.iter_mut().zip(values).for_each(|(t, &value)| *t = t.min(value));
        }
        for (target, step) in self.targets.iter_mut().zip(&drawn) {
            let after = if step.goes_on { GAMMA * f64::from(*target).clamp(0.0, 1.0) } else { 0.0 };
            *target = (step.reward + after) as f32;
        }
        // The critics follow the targets.
        let share = 1.0 / self.batch as f32;
        for critic in critics.iter_mut() {
            for (mut row, step) in critic.values[0].rows_mut().into_iter().zip(&drawn) {
                let all = step.before.iter().chain(&step.action);
                row.iter_mut().zip(all).for_each(|(x, y)| *x = *y);
            }
            critic.forward();
            let pairs = critic.errors[last].iter_mut().zip(&critic.values[last]);
            pairs.zip(&self.targets).for_each(|((e, value), t)| *e = share * (value - t));
            critic.backward(true);
            critic.descend();
        }
        self.updates += 1;
        if self.updates.is_multiple_of(2) {
            self.improve(inputs, last, share);
        }
    }

    /// The actor follows the first critic, which still has the features at hand, and the targets all.
    fn improve(&mut self, inputs: usize, last: usize, share: f32) {
        let (actor, critic) = (&mut self.actor, &mut self.critics[0]);
        actor.values[0].assign(&critic.values[0].slice_axis(Axis(1), Slice::from(..inputs)));
        actor.forward();
        actor.values[last].mapv_inplace(f32::tanh);
        critic.values[0].slice_axis_mut(Axis(1), Slice::from(inputs..)).assign(&actor.values[last]);
        critic.forward();
        critic.errors[last].fill(-share);
        critic.backward(false);
        let slopes = critic.errors[0].slice_axis(Axis(1), Slice::from(inputs..));
        let squash = |e: &mut f32, &slope: &f32, &a: &f32| *e = slope * (1.0 - a * a);
        Zip::from(&mut actor.errors[last]).and(slopes).and(&actor.values[last]).for_each(squash);
        actor.backward(true);
        actor.descend();
        actor.follow();
        self.critics.iter_mut().for_each(Net::follow);
    }

    /// The least that the critics say of the actor's action where this is seen.
    pub(crate) fn value(&mut self, seen: &[f32]) -> f32 {
        let row = |values: &mut Array2<f32>, numbers: &[f32]| {
            values.row_mut(0).iter_mut().zip(numbers).for_each(|(x, y)| *x = *y);
        };
        row(&mut self.actor.values[0], seen);
        self.actor.forward();
        let action = self.actor.values.last().expect("layers").row(0).mapv(f32::tanh);
        let all: Vec<f32> = seen.iter().chain(&action).copied().collect();
        let values = self.critics.iter_mut().map(|critic| {
            row(&mut critic.values[0], &all);
            critic.forward();
            critic.values.last().expect("layers")[[0, 0]]
        });
        values.fold(f32::INFINITY, f32::min)
    }
}

/// A transition, each as likely.
fn draw<'a>(seen: &'a [Option<Seen>], rng: &mut Xoshiro256PlusPlus) -> &'a Seen {
    loop {
        let place = (u64::from(rng.next_u32()) * seen.len() as u64) >> 32;
        if let Some(step) = &seen[place as usize] {
            return step;
        }
    }
}

/// A number with the normal distribution (Box and Muller 1958).
fn normal(rng: &mut Xoshiro256PlusPlus) -> f64 {
    let mut unit = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64;
    let (u, angle) = (1.0 - unit(), core::f64::consts::TAU * unit());
    (-2.0 * u.ln()).sqrt() * angle.cos()
}
