//! The search for the worst scenarios, against what is known exactly and against a grid.
#![cfg(feature = "falsify")]

use tltl::env::{ContinuousEnv, Step};
use tltl::estimate::Played;
use tltl::falsify::{
    DisturbedEnv, Error, Falsified, Method, MixedStarts, Scenario, Search, falsify, replay,
};
use tltl::prelude::{Acceptor as _, tltl};
use tltl::rand::{Rng, SeedableRng as _, rngs::Xoshiro256PlusPlus};

const STEP: f64 = 0.1;

/// A mass on a line, in metres and seconds; the action is its acceleration. Where it starts, how fast, and what
/// pushes it is searched; it does not start at more than `far`.
#[derive(Clone, Debug)]
struct Mass {
    t: f64,
    x: f64,
    v: f64,
    far: f64,
    bounds: [(f64, f64); 2],
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    t: f64,
    x: f64,
    v: f64,
}

fn mass() -> Mass {
    Mass { t: 0.0, x: 0.0, v: 0.0, far: f64::INFINITY, bounds: [(-1.0, 1.0); 2] }
}

impl Mass {
    fn seen(&self) -> Seen {
        let Self { t, x, v, .. } = *self;
        Seen { t, x, v }
    }
}

impl ContinuousEnv for Mass {
    type State = Seen;

    fn bounds(&self) -> Vec<(f32, f32)> {
        vec![(-1.0, 1.0)]
    }

    fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> Seen {
        (self.t, self.x, self.v) = (0.0, 0.0, 0.0);
        self.seen()
    }

    fn step<R: Rng + ?Sized>(&mut self, action: &[f32], rng: &mut R) -> Step<Seen> {
        self.step_disturbed(action, &[0.0], rng)
    }
}

impl DisturbedEnv for Mass {
    fn start_bounds(&self) -> Vec<(f64, f64)> {
        self.bounds.to_vec()
    }

    fn reset_at(&mut self, start: &[f64]) -> Option<Seen> {
        (self.t, self.x, self.v) = (0.0, start[0], start[1]);
        (self.x.abs() <= self.far).then(|| self.seen())
    }

    fn disturbance_bounds(&self) -> Vec<(f64, f64)> {
        vec![(-0.5, 0.5)]
    }

    fn step_disturbed<R: Rng + ?Sized>(
        &mut self,
        action: &[f32],
        push: &[f64],
        _: &mut R,
    ) -> Step<Seen> {
        self.t += STEP;
        self.v += (f64::from(action[0]) + push[0]) * STEP;
        self.x += self.v * STEP;
        Step::to(self.seen())
    }
}

fn idle(_: u32, _: &Seen) -> Result<Vec<f32>, Error> {
    Ok(vec![0.0])
}

/// A brake that is too weak, and a sensor that is blind between 0.3 and 0.4 m.
fn brake(_: u32, s: &Seen) -> Result<Vec<f32>, Error> {
    let blind = (0.3..0.4).contains(&s.x);
    Ok(vec![if blind { 0.5 } else { (-s.x - s.v).clamp(-1.0, 1.0) as f32 }])
}

fn search() -> Search {
    Search::default().with_evaluations(1_000).and_then(|s| s.with_horizon(20)).expect("in range")
}

/// Two seconds without ever being farther than 5 m to the right: its robustness is by how much it keeps away.
macro_rules! keep_away {
    () => {
        tltl! { |s: &Seen| F (1000 * s.t > 1950) ensuring !(s.x > 5) }
    };
}

#[test]
fn the_worst_start_is_the_one_that_is_known() {
    let found = falsify(&mut mass(), &keep_away!(), &search(), idle).expect("numbers");
    // From 1 m at 1 m/s: after 20 steps at 3 m.
    let worst = &found.worst[0];
    assert!((2.0 - 1e-9..2.02).contains(&found.robustness()), "{}", found.robustness());
    assert!(worst.scenario.start.iter().all(|number| *number > 0.98), "{worst:?}");
    assert!(worst.scenario.disturbance.is_empty() && worst.satisfied);
    assert_eq!((found.episodes, found.refused), (1_000, 0));
}

#[test]
fn the_worst_disturbance_is_the_one_that_is_known() {
    let search = search().with_pieces(4).expect("few");
    let found = falsify(&mut mass(), &keep_away!(), &search, idle).expect("numbers");
    // A push of 0.5 m/s² all the time adds 0.5 * 0.01 * (1 + 2 + … + 20) m.
    let worst = &found.worst[0];
    assert!((0.95 - 1e-9..1.1).contains(&found.robustness()), "{}", found.robustness());
    assert_eq!(worst.scenario.disturbance.len(), 4);
    assert!(worst.scenario.disturbance.iter().all(|push| push.len() == 1 && push[0] <= 0.5));
    // Pushes of the first half last longest.
    assert!(worst.scenario.disturbance[..2].iter().all(|push| push[0] > 0.35), "{worst:?}");
}

/// The least robustness of a grid of starts.
fn grid(steps: u32) -> f64 {
    let mut least = f64::INFINITY;
    let number = |i: u32| 2.0 * f64::from(i) / f64::from(steps) - 1.0;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    for (i, j) in (0..=steps).flat_map(|i| (0..=steps).map(move |j| (i, j))) {
        let scenario = Scenario { start: vec![number(i), number(j)], disturbance: vec![] };
        let played = replay(&mut mass(), &keep_away!(), &scenario, 20, &mut rng, brake);
        let played = played.expect("numbers").expect("it starts there");
        least = least.min(keep_away!().robustness(&played.states).expect("numbers"));
    }
    least
}

#[test]
fn evolution_finds_lower_robustness_than_random_points_and_comes_near_to_a_grid() {
    let oracle = grid(200);
    let least = |method, seed| {
        let search = search().with_evaluations(400).expect("some");
        let search = search.with_method(method).with_seed(seed);
        falsify(&mut mass(), &keep_away!(), &search, brake).expect("numbers").robustness()
    };
    let (mut won, mut behind) = (0, [0.0; 2]);
    for seed in 0..10 {
        let [evolved, random] = [Method::Evolution, Method::Random].map(|of| least(of, seed));
        won += u32::from(evolved < random);
        behind[0] += (evolved - oracle) / 10.0;
        behind[1] += (random - oracle) / 10.0;
    }
    assert!(won >= 8, "{won} of 10");
    assert!(behind[0] < 0.02 && behind[0] < 0.5 * behind[1], "{behind:?} above {oracle}");
}

fn found(seed: u64) -> Falsified<Seen> {
    let search = search().with_pieces(2).expect("few").with_seed(seed);
    falsify(&mut mass(), &keep_away!(), &search, brake).expect("numbers")
}

#[test]
fn the_same_seed_finds_the_same() {
    assert_eq!(found(3), found(3));
    assert_ne!(found(3), found(4));
}

#[test]
fn what_is_kept_is_apart_in_order_and_can_be_replayed() {
    let (found, task) = (found(1), keep_away!());
    assert_eq!(found.worst.len(), 10);
    assert!(found.worst.is_sorted_by(|a, b| a.robustness <= b.robustness));
    let numbers = |s: &Scenario| [&s.start[..], &s.disturbance.concat()].concat();
    let ranges = [2.0, 2.0, 1.0, 1.0];
    for (i, one) in found.worst.iter().enumerate() {
        for other in &found.worst[..i] {
            let pairs = numbers(&one.scenario).into_iter().zip(numbers(&other.scenario));
            assert!(pairs.zip(ranges).any(|((a, b), range)| (a - b).abs() > 0.05 * range));
        }
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let again = replay(&mut mass(), &task, &one.scenario, 20, &mut rng, brake);
        assert_eq!(again.expect("numbers").as_ref(), Some(&one.episode));
        assert_eq!(task.robustness(&one.episode.states), Ok(one.robustness));
        assert_eq!(task.is_accepting(one.episode.last()), one.satisfied);
    }
}

#[test]
fn points_where_no_episode_starts_are_passed_over() {
    for method in [Method::Random, Method::Evolution] {
        let mut world = Mass { far: 0.5, ..mass() };
        let search = search().with_method(method);
        let found = falsify(&mut world, &keep_away!(), &search, idle).expect("numbers");
        assert_eq!(found.episodes + found.refused, 1_000);
        assert!(found.refused > 0 && found.worst.iter().all(|w| w.scenario.start[0] <= 0.5));
        world.far = -1.0;
        let none = falsify(&mut world, &keep_away!(), &search, idle);
        assert_eq!(none, Err(Error::NoStart { tried: 1_000 }));
    }
}

#[test]
fn worlds_and_settings_that_cannot_be_searched_are_refused() {
    for bad in [(1.0, -1.0), (f64::NAN, 1.0), (0.0, f64::INFINITY), (-f64::MAX, f64::MAX)] {
        let mut world = Mass { bounds: [(0.0, 0.0), bad], ..mass() };
        let error = falsify(&mut world, &keep_away!(), &search(), idle).expect_err("bad bounds");
        let text = error.to_string();
        assert!(text.starts_with("the bounds of number 1 of a start are"), "{text}");
    }
    // Bounds that are equal fix a number.
    let mut world = Mass { bounds: [(0.25, 0.25); 2], ..mass() };
    let found = falsify(&mut world, &keep_away!(), &search(), idle).expect("one start");
    assert_eq!((found.worst.len(), &found.worst[0].scenario.start[..]), (1, &[0.25; 2][..]));
    for (refused, name) in [
        (search().with_evaluations(0), "evaluations"),
        (search().with_horizon(0), "horizon"),
        (search().with_kept(0), "kept"),
        (search().with_pieces(usize::MAX), "pieces"),
        (search().with_apart(f64::NAN), "apart"),
    ] {
        assert_eq!(refused.expect_err("out of range").field(), name);
    }
    for evaluations in [1, 3, 19, 21] {
        let search = search().with_evaluations(evaluations).expect("some");
        let found = falsify(&mut mass(), &keep_away!(), &search, idle).expect("numbers");
        assert_eq!(found.episodes, evaluations);
    }
}

#[test]
fn errors_of_predicates_and_controllers_are_those_of_the_search() {
    let nan = tltl! { |s: &Seen| F ((s.x - s.x) / (s.x - s.x) > 1) };
    let error = falsify(&mut mass(), &nan, &search(), idle).map(|_| ()).expect_err("no number");
    assert!(matches!(error, Error::Task(_)), "{error}");
    let fails = |_: u32, _: &Seen| Err::<Vec<f32>, _>(Error::Nothing);
    assert_eq!(falsify(&mut mass(), &keep_away!(), &search(), fails), Err(Error::Nothing));
}

#[test]
fn scenarios_of_other_worlds_are_refused() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    for (start, disturbance) in [(vec![0.0], vec![]), (vec![0.0; 2], vec![vec![0.0; 3]])] {
        let other = Scenario { start, disturbance };
        let error = replay(&mut mass(), &keep_away!(), &other, 20, &mut rng, idle);
        let error = error.expect_err("another world").to_string();
        assert!(error.starts_with("a scenario of a world of"), "{error}");
        assert!(MixedStarts::new(mass(), vec![other], 0.5, 20).is_err());
    }
    let error = MixedStarts::new(mass(), vec![], 1.5, 20).expect_err("a share");
    assert_eq!(error.to_string(), "`share` is 1.5, not in [0, 1]");
}

/// Episodes of a mixed world are those of the scenario, its disturbance included.
#[test]
fn mixed_starts_are_disturbed_as_the_scenario_says() {
    let worst = found(1).worst.swap_remove(0);
    let mut world = MixedStarts::new(mass(), vec![worst.scenario], 1.0, 20).expect("fits");
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    for _ in 0..2 {
        let task = keep_away!();
        let played: Played<Seen> =
            tltl::estimate::play(&mut world, &task, 20, &mut rng, brake).expect("numbers");
        assert_eq!(played, worst.episode);
    }
    // Nothing to start from, or nowhere: the world's own start.
    let nowhere = Scenario { start: vec![0.9, 0.0], disturbance: vec![vec![0.5]] };
    for scenarios in [vec![], vec![nowhere]] {
        let world = Mass { far: 0.5, ..mass() };
        let mut world = MixedStarts::new(world, scenarios, 1.0, 20).expect("fits");
        assert_eq!(world.reset(&mut rng), Seen { t: 0.0, x: 0.0, v: 0.0 });
        assert_eq!(world.step(&[0.0], &mut rng).state.v, 0.0);
    }
}
