//! A task learned with several seeds: what each comes to, and how long it took.

use std::ops::Range;
use std::time::Instant;

use tltl::env::ContinuousEnv;
use tltl::network::Features;
use tltl::robustness::Predicates;

use crate::Failure;
use crate::case::{BETWEEN, Case, FEW, Method, TRIALS};
use crate::worlds::{Visitor, visit};

/// The share of them after which a task counts as learned.
const LEARNED: f64 = 0.95;

/// Learns `task`, by `steps` steps for each of the seeds.
pub(crate) fn run(
    method: Method,
    task: &str,
    seeds: Range<u64>,
    steps: u64,
) -> Result<(), Failure> {
    visit(task, Seeds { method, seeds, steps })
}

struct Seeds {
    method: Method,
    seeds: Range<u64>,
    steps: u64,
}

impl Visitor for Seeds {
    type Output = ();

    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<(), Failure>
    where
        E: ContinuousEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        println!(
            "| seed | P(satisfied) | P(lost) | steps | {LEARNED} of {FEW} after | steps a second |"
        );
        println!("| --- | --- | --- | --- | --- | --- |");
        for seed in self.seeds {
            let mut learner = case.learner(self.method, seed)?;
            let (mut first, mut seconds) = (None, 0.0);
            for look in 1..=self.steps.div_ceil(BETWEEN).max(1) {
                let steps = self.steps.min(look * BETWEEN);
                let start = Instant::now();
                learner.train(&mut case.world.clone(), steps)?;
                seconds += start.elapsed().as_secs_f64();
                if case.tried(&mut learner, FEW)?.estimate.satisfied.mean >= LEARNED {
                    first = first.or(Some(steps));
                }
            }
            let worth = case.tried(&mut learner, TRIALS)?.estimate;
            let (satisfied, lost) = (worth.satisfied.mean, worth.lost.mean);
            let steps = worth.steps.map_or(f64::NAN, |steps| steps.mean);
            let first = first.map_or("never".into(), |steps| steps.to_string());
            let rate = learner.steps() as f64 / seconds;
            println!("| {seed} | {satisfied} | {lost} | {steps:.1} | {first} | {rate:.0} |");
        }
        Ok(())
    }
}
