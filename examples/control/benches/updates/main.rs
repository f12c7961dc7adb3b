//! Updates of actor and critics for each second of the processor, and beside them those of a loop that
//! is written by hand ([`floor`]), both by TD3; then those by SAC.
//!
//! `cargo bench -p tltl-control --bench updates`; `python3 examples/control/benches/sb3.py` prints the same of
//! Stable-Baselines3's TD3 and SAC in a like world, with networks and batches of the same size.

mod floor;

use std::error::Error;

use floor::{Floor, GAMMA, Seen};
use tltl::deep::actor::{Learner, Settings};
use tltl::deep::{Device, Skill};
use tltl::env::{ContinuousEnv, Step};
use tltl::network::Features;
use tltl::prelude::{Monitor, Rewards, tltl};
use tltl::rand::Rng;
use tltl_control::point::{Look, Point, Room};

/// Times that each is timed, in turn.
const TIMES: usize = 5;

/// The room, its state four numbers, so that what a learner has seen can be written down.
struct Numbers(Room);

type Four = [f64; 4];

impl ContinuousEnv for Numbers {
    type State = Four;

    fn bounds(&self) -> Vec<(f32, f32)> {
        self.0.bounds()
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Four {
        numbers(self.0.reset(rng))
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Four> {
        Step::to(numbers(self.0.step(action, rng).state))
    }
}

fn numbers(s: Point) -> Four {
    [s.x, s.y, s.vx, s.vy]
}

#[derive(Clone, Copy)]
struct Sight;

impl Features<Four> for Sight {
    fn inputs(&self) -> usize {
        5
    }

    fn write(&self, &[x, y, vx, vy]: &Four, inputs: &mut [f32], entities: &mut [f32]) {
        Look.write(&Point { x, y, vx, vy }, inputs, entities);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let at_a = |s: &Four| 0.25 - (s[0] + 0.6).hypot(s[1] - 0.6);
    let at_b = |s: &Four| 0.25 - (s[0] - 0.6).hypot(s[1] - 0.6);
    let hit = |s: &Four| 0.3 - s[0].hypot(s[1]);
    let one = tltl! { F at_a ensuring !hit };
    let two = tltl! { F (at_a && F at_b) ensuring !hit };
    for (units, batch, updates) in [(64, 128, 400), (256, 256, 40)] {
        let settings = Settings::td3()
            .with_rewards(Rewards::acceptance().with_gamma(GAMMA)?)
            .with_hidden([units, units])?
            .with_batch(batch)?
            .with_relabelled(0.0)?
            .with_imitation(0.0)?
            .with_warmup(500)?;
        println!("{units} and {units} units, batches of {batch}; updates a second:");
        let mut own = learned(&one, &settings)?;
        let mut by_hand = floor(&own, batch)?;
        own.rehearse(20)?;
        (0..20).for_each(|_| by_hand.update());
        alike(&mut own, &mut by_hand)?;
        let mut both = learned(&two, &settings)?;
        let mut drawing = learned(&one, &settings.with_entropy(Some(-1.0))?.with_actor_delay(1)?)?;
        let mut timed = [const { Vec::new() }; 4];
        for _ in 0..TIMES {
            timed[0].push(rate(updates, || Ok(own.rehearse(updates)?))?);
            timed[1].push(rate(updates, || Ok(both.rehearse(updates)?))?);
            timed[2].push(rate(updates, || {
                (0..updates).for_each(|_| by_hand.update());
                Ok(())
            })?);
            timed[3].push(rate(updates, || Ok(drawing.rehearse(updates)?))?);
        }
        let [own, both, by_hand, drawing] = timed.map(median);
        println!("  one live automaton state   {own:>7.0}, {:.2} of the floor", own / by_hand);
        println!("  two live automaton states  {both:>7.0}, {:.2} of the floor", both / by_hand);
        println!("  the floor, by hand         {by_hand:>7.0}");
        println!("  one live state, by SAC     {drawing:>7.0}");
    }
    Ok(())
}

type Actor<'a, M> = Learner<Four, &'a M, Sight, tltl::deep::AsGiven>;

/// A learner that has seen 600 steps.
fn learned<'a, M: Monitor<Four>>(
    task: &'a M,
    settings: &Settings,
) -> Result<Actor<'a, M>, Box<dyn Error>> {
    let mut world = Numbers(Room::default());
    let skill = Skill::new(task, Sight);
    let mut learner = Learner::new(skill, &world, settings.clone(), &Device::flex(), 1);
    learner.train(&mut world, 600)?;
    Ok(learner)
}

/// The floor that goes on where a learner is.
fn floor<M: Monitor<Four>>(of: &Actor<'_, M>, batch: usize) -> Result<Floor, Box<dyn Error>> {
    let saved = serde_json::to_value(of.checkpoint())?;
    let moments = saved["replay"]["moments"].as_array().ok_or("no moments")?;
    let state = |i: usize| serde_json::from_value::<Four>(moments[i]["state"].clone());
    let task = of.skill().task;
    let sight = |s: &Four| {
        let mut inputs = vec![0.0; 5];
        Sight.write(s, &mut inputs, &mut []);
        inputs
    };
    let seen = |i: usize| -> Result<Option<Seen>, Box<dyn Error>> {
        let action: Vec<f32> = serde_json::from_value(moments[i]["action"].clone())?;
        if action.is_empty() {
            return Ok(None);
        }
        let (before, after) = (state(i)?, state(i + 1)?);
        let q = task.next(0, &after)?;
        let (reward, goes_on) = (f64::from(u8::from(task.is_accepting(q))), q == 0);
        Ok(Some(Seen { before: sight(&before), action, reward, after: sight(&after), goes_on }))
    };
    let seen = (0..moments.len()).map(seen).collect::<Result<_, _>>()?;
    Ok(Floor::of(&saved, seen, batch))
}

/// Both say the same of states, so they have learned the same.
fn alike<M: Monitor<Four>>(
    own: &mut Actor<'_, M>,
    by_hand: &mut Floor,
) -> Result<(), Box<dyn Error>> {
    for i in 0..100 {
        let place = |n: usize| (i * n % 100) as f64 / 50.0 - 1.0;
        let s = [place(1), place(37), 0.3 * place(11), 0.3 * place(23)];
        let mut inputs = [0.0; 5];
        Sight.write(&s, &mut inputs, &mut []);
        let (ours, theirs) = (own.value(0, &s)?, by_hand.value(&inputs));
        assert!((ours - theirs).abs() < 1e-4, "{ours} and {theirs} at {s:?}");
    }
    Ok(())
}

/// How many of so many updates are made a second.
fn rate(
    updates: u64,
    run: impl FnOnce() -> Result<(), Box<dyn Error>>,
) -> Result<f64, Box<dyn Error>> {
    let begin = seconds()?;
    run()?;
    Ok(updates as f64 / (seconds()? - begin))
}

fn median(mut rates: Vec<f64>) -> f64 {
    rates.sort_by(f64::total_cmp);
    rates[rates.len() / 2]
}

/// What this process has run, in seconds, where the system tells it.
fn seconds() -> Result<f64, Box<dyn Error>> {
    let stat = std::fs::read_to_string("/proc/self/stat")?;
    let fields = stat.rsplit_once(") ").ok_or("no fields")?.1;
    let ticks: Vec<u64> =
        fields.split(' ').skip(11).take(2).map(str::parse).collect::<Result<_, _>>()?;
    Ok(ticks.iter().sum::<u64>() as f64 / 100.0)
}
