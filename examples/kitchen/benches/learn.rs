//! Speed of deep learning: the whole loop in the kitchen, against a floor written by hand.
//!
//! `cargo bench -p tltl-kitchen --bench learn`: task 1, two hidden layers of 64, batches of 64, one
//! update for each environment step. The floor is the arithmetic of the same updates alone, on flat
//! arrays: three forward passes (the network and its target on s', the network on s), one backward
//! pass, Adam; without kitchen, replay, features, heads, pointers or normalisation.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use tltl::deep::{Device, Learner, Settings, Skill};
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::prelude::Rewards;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::features::{FeasibleGoals, View, exploration};
use tltl_kitchen::tasks::phi1_3;
use tltl_kitchen::{Goals, Kitchen, Known, Layout};

const STEPS: u64 = 4_000;
const BATCH: usize = 64;
const HIDDEN: usize = 64;

/// Environment steps a second of the whole loop.
fn learner() -> f64 {
    let layout = Arc::new(Layout::floorplan24());
    let id = |name| layout.id(name).expect("an apple and a fridge");
    let goals = Goals::Fixed { object: id("apple"), receptacle: id("fridge") };
    let mut kitchen = Kitchen::new(layout.clone(), goals, 100).expect("a feasible goal");
    let settings = || {
        Settings::default()
            .with_rewards(Rewards::progress().with_gamma(0.97)?)
            .with_hidden([HIDDEN; 2])?
            .with_batch(BATCH)?
            .with_steps_per_update(1)?
            .with_warmup(0)?
            .with_relabelled(0.0)?
            .with_epsilon(Schedule::constant(0.5)?)
    };
    let settings = settings().expect("in range");
    let skill =
        Skill::with_goals(phi1_3(), View::new(layout.clone()), FeasibleGoals::new(&layout, None));
    let mut learner =
        Learner::new(skill, &kitchen, settings, &Device::flex(), 1).exploring(exploration(&layout));
    let start = Instant::now();
    learner.train(&mut kitchen, STEPS).expect("numbers stay finite");
    assert_eq!(learner.updates(), learner.steps());
    learner.steps() as f64 / start.elapsed().as_secs_f64()
}

/// A dense layer on flat arrays, with its gradient and Adam's moments.
struct Layer {
    inputs: usize,
    outputs: usize,
    weights: Vec<f32>,
    gradient: Vec<f32>,
    moments: [Vec<f32>; 2],
}

impl Layer {
    fn new(inputs: usize, outputs: usize, rng: &mut impl Rng) -> Self {
        let bound = (6.0 / inputs as f32).sqrt();
        let random = |_| (rng.next_u32() as f32 / u32::MAX as f32 * 2.0 - 1.0) * bound;
        let weights: Vec<f32> = (0..inputs * outputs).map(random).collect();
        let zeros = vec![0.0; weights.len()];
        Self { inputs, outputs, weights, gradient: zeros.clone(), moments: [zeros.clone(), zeros] }
    }

    fn forward(&self, x: &[f32], rectify: bool) -> Vec<f32> {
        let mut y = vec![0.0; BATCH * self.outputs];
        for (x, y) in x.chunks(self.inputs).zip(y.chunks_mut(self.outputs)) {
            for (x, row) in x.iter().zip(self.weights.chunks(self.outputs)) {
                y.iter_mut().zip(row).for_each(|(y, w)| *y += x * w);
            }
            if rectify {
                y.iter_mut().for_each(|y| *y = y.max(0.0));
            }
        }
        y
    }

    /// Adds up the gradient; that of the inputs.
    fn backward(&mut self, x: &[f32], dy: &[f32]) -> Vec<f32> {
        self.gradient.fill(0.0);
        let mut dx = vec![0.0; BATCH * self.inputs];
        for ((x, dy), dx) in
            x.chunks(self.inputs).zip(dy.chunks(self.outputs)).zip(dx.chunks_mut(self.inputs))
        {
            let rows =
                self.weights.chunks(self.outputs).zip(self.gradient.chunks_mut(self.outputs));
            for ((x, dx), (row, gradient)) in x.iter().zip(dx).zip(rows) {
                gradient.iter_mut().zip(dy).for_each(|(g, dy)| *g += x * dy);
                *dx = row.iter().zip(dy).map(|(w, dy)| w * dy).sum();
            }
        }
        dx
    }

    fn adam(&mut self, rate: f32) {
        let [first, second] = &mut self.moments;
        let moments = first.iter_mut().zip(second);
        for ((w, g), (m, v)) in self.weights.iter_mut().zip(&self.gradient).zip(moments) {
            *m += 0.1 * (g - *m);
            *v += 0.001 * (g * g - *v);
            *w -= rate * *m / (v.sqrt() + 1e-8);
        }
    }
}

/// Updates a second of the floor, for a network of these widths.
fn floor(widths: [usize; 4]) -> f64 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let layer = |i: usize, rng: &mut _| Layer::new(widths[i], widths[i + 1], rng);
    let mut net: Vec<Layer> = (0..3).map(|i| layer(i, &mut rng)).collect();
    let target: Vec<Layer> = (0..3).map(|i| layer(i, &mut rng)).collect();
    let x: Vec<f32> = (0..BATCH * widths[0]).map(|_| (rng.next_u32() & 1) as f32).collect();
    let run = |net: &[Layer], x: &[f32]| {
        let a = net[0].forward(x, true);
        let b = net[1].forward(&a, true);
        let c = net[2].forward(&b, false);
        (a, b, c)
    };
    let (mut first, mut last) = (None, 0.0);
    let start = Instant::now();
    for _ in 0..STEPS {
        let (chosen, valued) = (run(&net, &x).2, run(&target, &x).2);
        black_box((&chosen, &valued));
        let (a, b, c) = run(&net, &x);
        let error: Vec<f32> = c.iter().map(|v| (v - 1.0) / c.len() as f32).collect();
        last = error.iter().map(|e| e * e).sum::<f32>();
        first.get_or_insert(last);
        let rectified = |mut d: Vec<f32>, y: &[f32]| {
            d.iter_mut().zip(y).for_each(|(d, y)| *d = if *y > 0.0 { *d } else { 0.0 });
            d
        };
        let db = rectified(net[2].backward(&b, &error), &b);
        let da = rectified(net[1].backward(&a, &db), &a);
        net[0].backward(&x, &da);
        net.iter_mut().for_each(|layer| layer.adam(1e-3));
    }
    assert!(last < 0.1 * first.unwrap_or(0.0), "the floor learns");
    STEPS as f64 / start.elapsed().as_secs_f64()
}

fn main() {
    let layout = Arc::new(Layout::floorplan24());
    let view = View::new(layout);
    let inputs = Features::<Known>::inputs(&view);
    // Four heads: the values of states, six plain actions, what pointing has in common, the query.
    let outputs = 4 * (1 + 6 + 1 + Features::<Known>::channels(&view));
    let (ours, hand) = (learner(), floor([inputs, HIDDEN, HIDDEN, outputs]));
    println!("the whole loop, one update a step    {ours:8.0} steps/s");
    println!("the floor by hand, updates alone     {hand:8.0} updates/s");
    println!("ratio                                {:8.2}", ours / hand);
}
