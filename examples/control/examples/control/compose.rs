//! Pairs of skills of the point, composed without a step in the world: all steps of Algorithm 2.

use tltl::compose::Compose as _;
use tltl::deep::actor::{Composition, Learner};
use tltl::deep::{Device, Skill};
use tltl::estimate::{Trials, estimate_continuous};
use tltl::prelude::{Combine, Monitor, Product};
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::robustness::Predicates;
use tltl::{Acceptor as _, Task};
use tltl_control::judge::{HORIZON, STARTS};
use tltl_control::point::{Look, Point, Room, to_a, to_b, to_c};
use tltl_examples::study::mean;

use crate::Failure;
use crate::case::{Method, TRIALS};

/// Environment steps of a skill, and updates of each step of a composition.
const SKILL: u64 = 20_000;

/// What a controller is worth.
struct Row {
    name: String,
    satisfied: f64,
    lost: f64,
    /// The mean steps where the task is satisfied; not a number where it never is.
    steps: f64,
}

/// One pair, from 1, or all of them, with `count` seeds from `seed` on.
pub(crate) fn run(
    method: Method,
    pair: Option<usize>,
    seed: u64,
    count: u64,
) -> Result<(), Failure> {
    let pairs: [&dyn Fn(u64) -> Result<Vec<Row>, Failure>; 3] = [
        &|seed| compose(method, &to_a(), &to_b(), seed),
        &|seed| compose(method, &to_b(), &to_c(), seed),
        &|seed| compose(method, &to_a(), &to_c(), seed),
    ];
    let which = match pair {
        None => 0..pairs.len(),
        Some(pair) if (1..=pairs.len()).contains(&pair) => pair - 1..pair,
        Some(pair) => Err(format!("there is no pair {pair}; there are 1 to {}", pairs.len()))?,
    };
    for pair in &pairs[which] {
        let seeds = (seed..seed.saturating_add(count)).map(pair).collect::<Result<Vec<_>, _>>()?;
        if count > 1 {
            summary(&seeds);
        }
    }
    Ok(())
}

/// The means over the seeds, and the least and the largest P(satisfied).
fn summary(seeds: &[Vec<Row>]) {
    println!(
        "\n| means of {} seeds | P(satisfied) | least, largest | P(lost) | steps |",
        seeds.len()
    );
    println!("| --- | --- | --- | --- | --- |");
    for (i, Row { name, .. }) in seeds[0].iter().enumerate() {
        let each = |of: fn(&Row) -> f64| seeds.iter().map(|rows| of(&rows[i])).collect::<Vec<_>>();
        let satisfied = each(|row| row.satisfied);
        let least = satisfied.iter().copied().fold(f64::INFINITY, f64::min);
        let largest = satisfied.iter().copied().fold(0.0, f64::max);
        let (lost, steps) = (mean(&each(|row| row.lost)), mean(&each(|row| row.steps)));
        let satisfied = mean(&satisfied);
        println!("| {name} | {satisfied:.3} | {least:.3}, {largest:.3} | {lost:.3} | {steps:.1} |");
    }
    println!();
}

/// Learns two skills and makes both at once of what they have learned and seen: by each step of
/// Algorithm 2, and by its last one alone, from nothing, with imitation and without. Then it learns the same from
/// scratch, with as many steps of the world as the two had.
fn compose<P, Q>(
    method: Method,
    first: &Task<P>,
    second: &Task<Q>,
    seed: u64,
) -> Result<Vec<Row>, Failure>
where
    P: Predicates<Point> + Sync,
    Q: Predicates<Point> + Sync,
{
    let (mut room, device) = (Room::default(), Device::flex());
    let learning = method.settings()?;
    let mut one = Learner::new(Skill::new(first, Look), &room, learning.clone(), &device, seed);
    one.train(&mut room, SKILL)?;
    let mut two =
        Learner::new(Skill::new(second, Look), &room, learning.clone(), &device, seed + 100);
    two.train(&mut room, SKILL)?;
    let both = Product::conjunction(&[first, second]);
    println!("{}, seed {seed}", both.formula().text());
    let mut rows = vec![
        row(first.name(), first, |q, s| Ok(one.act(q, s)?))?,
        row(second.name(), second, |q, s| Ok(two.act(q, s)?))?,
    ];
    let skill = || Skill::new(&both, Look);
    for imitation in [learning.imitation(), 0.0] {
        let settings = learning.clone().with_imitation(imitation)?;
        let note = if imitation > 0.0 { "" } else { ", nothing imitated" };
        let (skills, combine) = ([one.learned()?, two.learned()?], Combine::NormalisedSum);
        let own = settings.clone();
        let mut composed = Composition::new(skill(), &skills, combine, own, &device, seed + 400)?;
        let mut note_row = |step: &str, composed: &Composition<'_, _, _, _>| {
            let name = format!("{step}{note}");
            rows.push(row(&name, &both, |q, s| Ok(composed.act(q, s)?))?);
            Ok::<_, Failure>(())
        };
        composed.fit(SKILL)?;
        note_row("step 2: the sum", &composed)?;
        composed.compensate(SKILL)?;
        note_row("steps 3-5: compensated", &composed)?;
        composed.refine(SKILL)?;
        note_row("step 6: refined", &composed)?;
        let mut alone = Learner::new(skill(), &room, settings, &device, seed + 200);
        alone.remember(&one)?;
        alone.remember(&two)?;
        alone.rehearse(SKILL)?;
        let name = format!("step 6 alone{note}");
        rows.push(row(&name, &both, |q, s| Ok(alone.act(q, s)?))?);
    }
    let mut scratch = Learner::new(skill(), &room, learning, &device, seed + 300);
    scratch.train(&mut room, 2 * SKILL)?;
    rows.push(row("from scratch", &both, |q, s| Ok(scratch.act(q, s)?))?);
    Ok(rows)
}

/// How often a controller satisfies and loses a task, and in how many steps.
fn row<M: Monitor<Point>>(
    name: &str,
    task: &M,
    act: impl FnMut(u32, &Point) -> Result<Vec<f32>, Failure>,
) -> Result<Row, Failure> {
    let trials = Trials::default().with_episodes(TRIALS)?.with_horizon(HORIZON)?;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(STARTS);
    let seen = estimate_continuous(&mut Room::default(), task, trials, &mut rng, act)?;
    let (satisfied, lost) = (seen.satisfied.mean, seen.lost.mean);
    let steps = seen.steps.map_or(f64::NAN, |steps| steps.mean);
    println!("{name:<42}{satisfied:>8.3}{lost:>8.3}{steps:>8.1}");
    Ok(Row { name: name.into(), satisfied, lost, steps })
}
