//! The deep learner against exact values.
#![cfg(feature = "deep")]

use tltl::deep::{Device, Learner, Settings, Skill};
use tltl::env::{Env, ModelEnv};
use tltl::learn::Schedule;
use tltl::model::FiniteModel;
use tltl::network::Features;
use tltl::tltl;

/// Six cells in a row, left and right, certain.
struct Row;

impl FiniteModel for Row {
    type State = i32;

    fn states(&self) -> usize {
        6
    }

    fn actions(&self) -> usize {
        2
    }

    fn state(&self, s: usize) -> i32 {
        s as i32
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        outcome(if a == 0 { s.saturating_sub(1) } else { (s + 1).min(5) }, 1.0);
    }
}

struct OneHot;

impl Features<i32> for OneHot {
    fn inputs(&self) -> usize {
        6
    }

    fn write(&self, s: &i32, inputs: &mut [f32], _: &mut [f32]) {
        inputs[*s as usize] = 1.0;
    }
}

#[test]
fn a_chain_is_learned_to_its_exact_values() {
    let task = tltl! { |x: &i32| ({ *x } == 5) T ({ *x } == 0) };
    let mut env = ModelEnv::new(Row).unwrap();
    let settings = Settings {
        gamma: 0.9,
        horizon: 40,
        hidden: vec![32],
        warmup: 100,
        capacity: 2_000,
        epsilon: Schedule::Constant(1.0),
        learning_rate: Schedule::Linear { from: 3e-3, to: 1e-5, steps: 6_000 },
        ..Settings::default()
    };
    let skill = Skill::new(task, OneHot);
    let mut learner = Learner::new(skill, env.actions(), settings, &Device::flex(), 1);
    learner.train(&mut env, 6_000).unwrap();
    for s in 0..6 {
        println!("{s} {:?} {:?}", learner.values(0, &s).unwrap(), learner.values(1, &s).unwrap());
    }
}
