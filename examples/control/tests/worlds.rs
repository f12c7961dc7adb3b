//! The worlds, by controllers that need no learning.

use std::fmt::Debug;

use tltl::Monitor;
use tltl::env::ContinuousEnv;
use tltl::estimate::{Trials, estimate_continuous};
use tltl::falsify::DisturbedEnv;
use tltl::rand::{RngExt as _, SeedableRng as _, rngs::Xoshiro256PlusPlus};
use tltl::task::Error;
use tltl_control::picture::{Plane, Region};
#[cfg(feature = "rapier")]
use tltl_control::rover;
use tltl_control::{arm, judge, point};

type Place = (f64, f64);

/// The goal of an automaton state: its rank among the live ones.
fn goal<M: Monitor<S>, S>(task: &M, q: u32, goals: &[Place]) -> Place {
    let before = (0..q).filter(|&q| !task.is_terminal(q)).count();
    goals[before.min(goals.len() - 1)]
}

/// A controller that goes to each goal in turn satisfies the task from every start.
fn goes<E: ContinuousEnv>(
    mut env: E,
    task: &impl Monitor<E::State>,
    goals: &[Place],
    steer: fn(&E::State, Place) -> [f32; 2],
) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let trials =
        Trials::default().with_episodes(300).and_then(|t| t.with_horizon(200)).expect("in range");
    let act = |q, s: &E::State| Ok::<_, Error>(steer(s, goal(task, q, goals)).to_vec());
    let seen = estimate_continuous(&mut env, task, trials, &mut rng, act).expect("numbers");
    assert_eq!(seen.satisfied.mean, 1.0, "{}", task.name());
}

#[test]
fn every_task_can_be_done_from_every_start() {
    let [a, b, c] = point::PLACES;
    goes(point::Room::default(), &point::fetch(), &[a, b], point::steer);
    goes(point::Room::default(), &point::tour(), &[a, b, c], point::steer);
    goes(point::Room::default(), &point::park(), &[c], point::steer);
    goes(point::Room::default(), &point::hurry(), &[b], point::steer);
    goes(point::Room::default(), &point::patrol(), &[a, b, c, a], point::steer);
    let [cup, shelf, rest] = arm::PLACES;
    goes(arm::Table::default(), &arm::bring(), &[cup, shelf], arm::steer);
    goes(arm::Table::default(), &arm::bring_and_rest(), &[cup, shelf, rest], arm::steer);
    goes(arm::Table::default(), &arm::shuttle(), &[cup, shelf, rest, cup], arm::steer);
}

#[test]
fn actions_stay_within_the_world() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut room, mut table) = (point::Room::default(), arm::Table::default());
    for _ in 0..50 {
        room.reset(&mut rng);
        table.reset(&mut rng);
        for t in 0..100 {
            let push = if t % 3 == 0 { -1.0 } else { 1.0 };
            let s = room.step(&[push, 1.0], &mut rng).state;
            assert!(s.x.abs() <= point::HALF && s.y.abs() <= point::HALF, "{s:?}");
            let s = table.step(&[6.0 * push, 6.0], &mut rng).state;
            let [_, tip] = arm::joints([s.shoulder, s.elbow]);
            assert_eq!(tip, (s.x, s.y), "the tip is where the joints have it");
            assert!(s.x.hypot(s.y) <= arm::LINKS[0] + arm::LINKS[1] + 1e-12);
        }
    }
}

/// Episodes start within the bounds of starts, some points of them apart; what does not disturb leaves a step as it is,
/// and what disturbs does not.
fn is_disturbed<E: DisturbedEnv<State: Debug> + Clone>(mut world: E) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
    let (starts, pushes) = (world.start_bounds(), world.disturbance_bounds());
    let mut starting = 0;
    for _ in 0..300 {
        let number = |&(low, high): &(f64, f64)| low + (high - low) * rng.random::<f64>();
        let start: Vec<f64> = starts.iter().map(number).collect();
        let Some(_) = world.reset_at(&start) else { continue };
        starting += 1;
        let action: Vec<f32> =
            world.bounds().iter().map(|(low, high)| (low + high) / 2.0).collect();
        let least: Vec<f64> = pushes.iter().map(|(low, _)| *low).collect();
        let after = |push: Option<&[f64]>, rng: &mut Xoshiro256PlusPlus| {
            let mut world = world.clone();
            let step = match push {
                Some(push) => world.step_disturbed(&action, push, rng),
                None => world.step(&action, rng),
            };
            format!("{:?}", step.state)
        };
        let plain = after(None, &mut rng);
        assert_eq!(after(Some(&vec![0.0; pushes.len()]), &mut rng), plain);
        assert_ne!(after(Some(&least), &mut rng), plain);
    }
    assert!((100..300).contains(&starting), "{starting}");
}

#[test]
fn worlds_start_where_one_wants_and_are_disturbed() {
    is_disturbed(point::Room::default());
    is_disturbed(arm::Table::default());
}

#[test]
fn trials_and_pictures_are_the_same_on_each_run() {
    let [a, b, _] = point::PLACES;
    let picture = || {
        let task = point::fetch();
        let act = |q, s: &point::Point| {
            Ok::<_, Box<dyn std::error::Error>>(point::steer(s, goal(&task, q, &[a, b])).to_vec())
        };
        let tried = judge::trials(&mut point::Room::default(), &task, 5, act).expect("numbers");
        assert!(tried.robustness.iter().all(|rho| *rho > 0.0), "satisfied, by how much");
        let regions = [Region { middle: a, radius: 0.25, name: "a & b", barred: false }];
        let plane = Plane { range: (-1.0, 1.0), regions: &regions, blocks: &[], edge: Some(-0.9) };
        let meanings = [(0, "towards a"), (2, "towards b"), (3, "towards b")];
        let at = |s: &point::Point| (s.x, s.y);
        plane.trajectories("fetch", &tried.episodes, at, None, &meanings)
            + &plane.moving("fetch", &tried.episodes[0], at, None, point::STEP, &meanings)
    };
    let first = picture();
    assert_eq!(first, picture());
    assert!(first.contains("a &amp; b") && first.contains("<animate"));
    assert_eq!(first.matches("towards b").count(), 2, "one line in the legend of each");
}

#[cfg(feature = "rapier")]
#[test]
fn every_task_of_the_rover_can_be_done_from_every_start() {
    use rover::{CRATE, STORE, Yard, steer};
    let [dock, gate] = rover::PLACES;
    goes(Yard::default(), &rover::push(), &[CRATE, STORE], steer);
    goes(Yard::default(), &rover::push_and_dock(), &[CRATE, STORE, dock], steer);
    goes(Yard::default(), &rover::rounds(), &[gate, dock, CRATE, STORE, dock], steer);
    goes(Yard::default(), &rover::rush(), &[STORE], steer);
    goes(Yard::default(), &rover::settle(), &[STORE, dock], steer);
}

/// What the physics library remembers between steps must not matter: the state is all there is.
#[cfg(feature = "rapier")]
#[test]
fn the_next_state_of_the_rover_follows_from_the_state_and_the_action() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut yard = rover::Yard::default();
    let mut state = yard.reset(&mut rng);
    let mut moved = 0;
    for _ in 0..200 {
        let action = rover::steer(&state, rover::STORE);
        let next = yard.step(&action, &mut rng).state;
        assert_eq!(rover::Yard::with(state).step(&action, &mut rng).state, next);
        moved += u32::from(next.crate_x != state.crate_x);
        state = next;
    }
    assert!(moved > 10, "the rover pushes the crate");
}

#[cfg(feature = "rapier")]
#[test]
fn walls_hold_the_rover_and_its_crate() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    let mut yard = rover::Yard::default();
    for i in 0..40 {
        let start = yard.reset(&mut rng);
        for t in 0..100 {
            // To a corner, with the crate on the way at times.
            let push = if (t / 20) % 2 == 0 { 2.0 } else { -2.0 };
            let s = yard.step(&[push, if i % 2 == 0 { 2.0 } else { -push }], &mut rng).state;
            // A contact is soft: a body gets 2 cm into another at most.
            let within = |at: f64, half: f64| at.abs() < rover::HALF - half + 0.02;
            assert!(within(s.x, 0.12) && within(s.y, 0.12), "{start:?}: {s:?}");
            assert!(within(s.crate_x, 0.1) && within(s.crate_y, 0.1), "{start:?}: {s:?}");
            let apart = (s.x - s.crate_x).hypot(s.y - s.crate_y);
            assert!(apart > 0.2, "{start:?}: {s:?}");
        }
    }
}
