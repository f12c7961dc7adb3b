//! One task: learned, tried, drawn, emitted.

use std::time::Instant;

use tltl::Acceptor as _;
use tltl::env::ContinuousEnv;
use tltl::network::Features;
use tltl::robustness::Predicates;
use tltl_control::judge::Trialled;
use tltl_examples::show::{self, Folder};

use crate::Failure;
use crate::case::{Case, Method, TRIALS};
use crate::worlds::{Visitor, visit};

/// Learns `task` by `steps` steps.
pub(crate) fn run(method: Method, task: &str, seed: u64, steps: u64) -> Result<(), Failure> {
    visit(task, Run { method, seed, steps })
}

struct Run {
    method: Method,
    seed: u64,
    steps: u64,
}

impl Visitor for Run {
    type Output = ();

    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<(), Failure>
    where
        E: ContinuousEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        let (task, name) = (&case.task, case.task.name());
        println!("{name}: {}", task.formula().text());
        println!(
            "{:<10}{:>13}{:>10}{:>8}{:>12}{:>10}",
            "", "P(satisfied)", "P(lost)", "steps", "robustness", "least"
        );
        row("by hand", &case.hand()?);
        let start = Instant::now();
        let mut learner = case.learner(self.method, self.seed)?;
        let mut world = case.world.clone();
        show::in_slices(name.to_owned(), self.steps, |until| {
            learner.train(&mut world, until).map(|()| learner.steps())
        })?;
        let tried = case.tried(&mut learner, TRIALS)?;
        row("learned", &tried);
        println!("{} steps in {:.0} s", learner.steps(), start.elapsed().as_secs_f64());
        let folder = Folder::at("target/control")?;
        let texts = case.meanings();
        let states: Vec<(u32, &str)> = texts.iter().map(|(q, text)| (*q, &**text)).collect();
        let few = &tried.episodes[..tried.episodes.len().min(12)];
        let drawn = case.plane.trajectories(name, few, case.at, case.loose.as_ref(), &states);
        folder.write(&format!("{name}.svg"), &drawn)?;
        let moving =
            case.plane.moving(name, &few[0], case.at, case.loose.as_ref(), case.step, &states);
        folder.write(&format!("{name}_moving.svg"), &moving)?;
        let policy = learner.policy()?.estimated(tried.estimate);
        folder.write(&format!("{name}.json"), &serde_json::to_string(&policy)?)?;
        folder.write(&format!("{name}.rs"), &tltlc::emit::network::source(&policy))?;
        Ok(())
    }
}

fn row<S>(name: &str, tried: &Trialled<S>) {
    let (estimate, robustness) = (&tried.estimate, &tried.robustness);
    let mean = robustness.iter().sum::<f64>() / robustness.len() as f64;
    let least = robustness.iter().copied().fold(f64::INFINITY, f64::min);
    let steps = estimate.steps.map_or(f64::NAN, |steps| steps.mean);
    println!(
        "{name:<10}{:>13.3}{:>10.3}{steps:>8.1}{mean:>12.3}{least:>10.3}",
        estimate.satisfied.mean, estimate.lost.mean
    );
}
