//! Pairs of skills of the point, composed without a step in the world.

use tltl::deep::actor::Learner;
use tltl::deep::{Device, Skill};
use tltl::estimate::{Trials, estimate_continuous};
use tltl::prelude::{Monitor, Product};
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::robustness::Predicates;
use tltl::{Acceptor as _, Task};
use tltl_control::judge::{HORIZON, STARTS};
use tltl_control::point::{Look, Point, Room, to_a, to_b, to_c};

use crate::Failure;
use crate::case::{TRIALS, settings};

/// Environment steps of a skill, and updates of a composition.
const SKILL: u64 = 20_000;

/// One pair, from 1, or all of them.
pub(crate) fn run(pair: Option<usize>, seed: u64) -> Result<(), Failure> {
    let pairs: [&dyn Fn() -> Result<(), Failure>; 3] =
        [&|| compose(&to_a(), &to_b(), seed), &|| compose(&to_b(), &to_c(), seed), &|| {
            compose(&to_a(), &to_c(), seed)
        }];
    match pair {
        None => pairs.iter().try_for_each(|pair| pair()),
        Some(which) => {
            let pair = which.checked_sub(1).and_then(|i| pairs.get(i));
            let unknown = || format!("there is no pair {which}; there are 1 to {}", pairs.len());
            pair.ok_or_else(unknown)?()
        }
    }
}

/// Learns two skills, makes both at once of what they saw, and learns the same from scratch with as many
/// steps as the two had.
fn compose<P, Q>(first: &Task<P>, second: &Task<Q>, seed: u64) -> Result<(), Failure>
where
    P: Predicates<Point> + Sync,
    Q: Predicates<Point> + Sync,
{
    let (mut room, settings, device) = (Room::default(), settings()?, Device::flex());
    let mut one = Learner::new(Skill::new(first, Look), &room, settings.clone(), &device, seed);
    one.train(&mut room, SKILL)?;
    let mut two =
        Learner::new(Skill::new(second, Look), &room, settings.clone(), &device, seed + 100);
    two.train(&mut room, SKILL)?;
    let both = Product::conjunction(&[first, second]);
    println!("{}", both.formula().text());
    show(first.name(), first, |q, s| Ok(one.act(q, s)?))?;
    show(second.name(), second, |q, s| Ok(two.act(q, s)?))?;
    let skill = || Skill::new(&both, Look);
    let mut composed = Learner::new(skill(), &room, settings.clone(), &device, seed + 200);
    composed.remember(&one)?;
    composed.remember(&two)?;
    composed.rehearse(SKILL)?;
    show("both, no further step", &both, |q, s| Ok(composed.act(q, s)?))?;
    let mut scratch = Learner::new(skill(), &room, settings, &device, seed + 300);
    scratch.train(&mut room, 2 * SKILL)?;
    show("both, from scratch", &both, |q, s| Ok(scratch.act(q, s)?))
}

/// How often a controller satisfies and loses a task, and in how many steps.
fn show<M: Monitor<Point>>(
    name: &str,
    task: &M,
    act: impl FnMut(u32, &Point) -> Result<Vec<f32>, Failure>,
) -> Result<(), Failure> {
    let trials = Trials::default().with_episodes(TRIALS)?.with_horizon(HORIZON)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(STARTS);
    let seen = estimate_continuous(&mut Room::default(), task, trials, &mut rng, act)?;
    let steps = seen.steps.map_or(f64::NAN, |steps| steps.mean);
    println!("{name:<24}{:>8.3}{:>8.3}{steps:>8.1}", seen.satisfied.mean, seen.lost.mean);
    Ok(())
}
