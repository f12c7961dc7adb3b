//! Updates of actor and critics for each second of the processor, the steps of the world included.
//!
//! `cargo bench -p tltl-control --bench updates`; `python3 examples/control/benches/td3.py` prints the same of
//! Stable-Baselines3's TD3 in a like world, with networks and batches of the same size.

use std::error::Error;

use tltl::Task;
use tltl::deep::actor::{Learner, Settings};
use tltl::deep::{Device, Skill};
use tltl::robustness::Predicates;
use tltl_control::point::{Look, Point, Room, fetch, to_a};

fn main() -> Result<(), Box<dyn Error>> {
    for (units, batch) in [(64, 128), (256, 256)] {
        let settings =
            Settings::default().with_hidden([units, units])?.with_batch(batch)?.with_warmup(500)?;
        measure("one live automaton state", &to_a(), &settings)?;
        measure("two live automaton states", &fetch(), &settings)?;
    }
    Ok(())
}

fn measure<P: Predicates<Point> + Sync>(
    name: &str,
    task: &Task<P>,
    settings: &Settings,
) -> Result<(), Box<dyn Error>> {
    let mut room = Room::default();
    let mut learner =
        Learner::new(Skill::new(task, Look), &room, settings.clone(), &Device::flex(), 1);
    learner.train(&mut room, 600)?;
    let (updates, begin) = (learner.updates(), seconds()?);
    let steps = learner.steps();
    learner.train(&mut room, steps + 1_000)?;
    let (made, taken) = (learner.updates() - updates, seconds()? - begin);
    assert_eq!(made, learner.steps() - steps, "an update for each step");
    println!(
        "{name}, {:?} units, batches of {}: {:.0} updates a second",
        settings.hidden(),
        settings.batch(),
        made as f64 / taken
    );
    Ok(())
}

/// What this process has run, in seconds, where the system tells it.
fn seconds() -> Result<f64, Box<dyn Error>> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let fields = stat.rsplit_once(") ").ok_or("no fields")?.1;
    let ticks: Vec<u64> =
        fields.split(' ').skip(11).take(2).map(str::parse).collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<u64>() as f64 / 100.0)
}
