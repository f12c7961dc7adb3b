//! Where a learned controller does worst, and what becomes of it when it trains there.

use tltl::Acceptor as _;
use tltl::deep::actor::Learner;
use tltl::deep::{Device, Skill};
use tltl::estimate::Played;
use tltl::falsify::{DisturbedEnv, Falsified, Found, Method, MixedStarts, Search, falsify, replay};
use tltl::network::Features;
use tltl::rand::{SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::robustness::Predicates;
use tltl_control::judge::{HORIZON, trials};
use tltl_examples::show::Folder;

use crate::Failure;
use crate::case::{self, Case, TRIALS};
use crate::worlds::{Visitor, visit};

/// Points that each search tries.
const POINTS: u64 = 1_000;

/// The pieces of an episode over which a disturbance is constant.
const PIECES: usize = 4;

/// The share of the episodes that start from the worst, in the training that follows.
const SHARE: f64 = 0.5;

/// Learns `task` by `steps` steps, searches, and trains on by a quarter of them.
pub(crate) fn run(method: case::Method, task: &str, seed: u64, steps: u64) -> Result<(), Failure> {
    visit(task, Falsify { method, seed, steps })
}

struct Falsify {
    method: case::Method,
    seed: u64,
    steps: u64,
}

impl Visitor for Falsify {
    type Output = ();

    fn visit<E, P, F>(self, case: &Case<E, P, F>) -> Result<(), Failure>
    where
        E: DisturbedEnv<State: Clone> + Clone,
        P: Predicates<E::State> + Sync,
        F: Features<E::State> + Copy + Sync,
    {
        println!("{}: {}", case.task.name(), case.task.formula().text());
        println!(
            "{:<28}{:>13}{:>12}{:>16}{:>16}{:>16}",
            "lowest robustness (failed)",
            "P(satisfied)",
            "trials",
            "random",
            "searched",
            "disturbed"
        );
        row(case, "by hand", 1, |q, s| Ok(case.hand_at(q, s)))?;
        let (before, after) = (self.steps, self.steps + self.steps / 4);
        let mut learner = case.learner(self.method, self.seed)?;
        learner.train(&mut case.world.clone(), before)?;
        let worst = row(case, &format!("{before} steps"), 1, |q, s| Ok(learner.act(q, s)?))?;
        let (skill, saved) = (Skill::new(&case.task, case.look), learner.checkpoint());
        let mut same = Learner::resume(skill, &case.world, saved, &Device::flex())?;
        same.train(&mut case.world.clone(), after)?;
        row(case, &format!("{after}, as before"), 2, |q, s| Ok(same.act(q, s)?))?;
        let scenarios = worst.iter().map(|found| found.scenario.clone()).collect();
        let mut mixed = MixedStarts::new(case.world.clone(), scenarios, SHARE, HORIZON)?;
        learner.train(&mut mixed, after)?;
        row(case, &format!("{after}, half from worst"), 2, |q, s| Ok(learner.act(q, s)?))?;
        show(&worst);
        let again = again(case, &worst, |q, s| Ok(learner.act(q, s)?))?;
        let satisfied = again.iter().filter(|played| case.task.is_accepting(played.last()));
        println!("after training {} of these {} are satisfied", satisfied.count(), worst.len());
        let found: Vec<_> = worst.into_iter().map(|found| found.episode).collect();
        draw(case, "worst_before", &found)?;
        draw(case, "worst_after", &again)
    }
}

/// A line of the table: what trials say of a controller, what random starts do, and what the search finds, without
/// disturbances and with them. The worst of the last two.
fn row<E, P, F>(
    case: &Case<E, P, F>,
    name: &str,
    seed: u64,
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, Failure>,
) -> Result<Vec<Found<E::State>>, Failure>
where
    E: DisturbedEnv<State: Clone> + Clone,
    P: Predicates<E::State>,
{
    let mut world = case.world.clone();
    let tried = trials(&mut world, &case.task, TRIALS, &mut act)?;
    let least = tried.robustness.iter().copied().fold(f64::INFINITY, f64::min);
    let search = Search::default().with_evaluations(POINTS)?.with_horizon(HORIZON)?.with_seed(seed);
    let random = search.clone().with_method(Method::Random);
    let disturbed = search.clone().with_pieces(PIECES)?;
    let mut of = |search| falsify(&mut world, &case.task, &search, &mut act);
    let [random, searched, disturbed] = [of(random)?, of(search)?, of(disturbed)?];
    let cell = |of: &Falsified<_>| format!("{:.3} ({})", of.robustness(), of.violations);
    println!(
        "{name:<28}{:>13.3}{least:>12.3}{:>16}{:>16}{:>16}",
        tried.estimate.satisfied.mean,
        cell(&random),
        cell(&searched),
        cell(&disturbed)
    );
    Ok([searched.worst, disturbed.worst].concat())
}

/// The starts of scenarios, what disturbs them, and the robustness.
fn show<S>(worst: &[Found<S>]) {
    let list =
        |numbers: &[f64]| numbers.iter().map(|x| format!("{x:.2}")).collect::<Vec<_>>().join(", ");
    for Found { scenario, robustness, .. } in worst {
        let pieces: Vec<_> = scenario.disturbance.iter().map(|piece| list(piece)).collect();
        println!("{robustness:>8.3}  from {}  {}", list(&scenario.start), pieces.join("; "));
    }
}

/// The episodes of a controller in scenarios that were found.
fn again<E, P, F>(
    case: &Case<E, P, F>,
    worst: &[Found<E::State>],
    mut act: impl FnMut(u32, &E::State) -> Result<Vec<f32>, Failure>,
) -> Result<Vec<Played<E::State>>, Failure>
where
    E: DisturbedEnv + Clone,
    P: Predicates<E::State>,
{
    let mut world = case.world.clone();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let played = worst.iter().map(|found| {
        let scenario = &found.scenario;
        replay(&mut world, &case.task, scenario, HORIZON, &mut rng, &mut act)
    });
    played.filter_map(Result::transpose).collect()
}

/// Writes a picture of episodes.
fn draw<E, P, F>(
    case: &Case<E, P, F>,
    what: &str,
    episodes: &[Played<E::State>],
) -> Result<(), Failure>
where
    E: DisturbedEnv<State: Clone> + Clone,
    P: Predicates<E::State> + Sync,
    F: Features<E::State> + Copy + Sync,
{
    let name = case.task.name();
    let texts = case.meanings();
    let states: Vec<(u32, &str)> = texts.iter().map(|(q, text)| (*q, &**text)).collect();
    let drawn = case.plane.trajectories(name, episodes, case.at, case.loose.as_ref(), &states);
    Folder::at("target/control")?.write(&format!("{name}_{what}.svg"), &drawn)
}
