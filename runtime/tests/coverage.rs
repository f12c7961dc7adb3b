//! Exploration towards what was tried least.

use std::collections::BTreeMap;

use tltl::env::Step;
use tltl::learn::{Exploration, Schedule};
use tltl::prelude::*;
use tltl::rand::Rng;

/// A corridor of cells: action 0 goes left, action 1 right, one time in four the other way, and action 2
/// stays. All starts are in cell 1. It notes its steps.
struct Corridor {
    cells: usize,
    at: usize,
    steps: Vec<(usize, usize, usize)>,
}

fn corridor(cells: usize) -> Corridor {
    Corridor { cells, at: 1, steps: Vec::new() }
}

impl Env for Corridor {
    type State = usize;

    fn actions(&self) -> usize {
        3
    }

    fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> usize {
        self.at = 1;
        1
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        let slips = action < 2 && rng.next_u32().is_multiple_of(4);
        let left = self.at.saturating_sub(1);
        let right = (self.at + 1).min(self.cells - 1);
        let to = [left, right, self.at, right, left][action + if slips { 3 } else { 0 }];
        self.steps.push((self.at, action, to));
        self.at = to;
        Step::to(to)
    }
}

impl FiniteEnv for Corridor {
    fn states(&self) -> usize {
        self.cells
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn state_index(&self) -> usize {
        self.at
    }
}

/// Each action is the one of the smallest number, as the docs say how the numbers come about.
#[test]
fn the_nearest_to_what_is_new_is_tried() {
    let mut env = corridor(12);
    let task =
        Labelled::of_env(&env, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 11) }).unwrap();
    let mut learner = Learner::new(&task, Settings::default(), 1);
    learner.train(&mut env, 3_000).unwrap();
    let mut numbers: BTreeMap<(usize, usize), u32> = BTreeMap::new();
    let number = |numbers: &BTreeMap<_, _>, s, a| numbers.get(&(s, a)).copied().unwrap_or(0);
    for &(s, a, to) in &env.steps {
        let least = |s| (0..3).map(|a| number(&numbers, s, a)).min().unwrap();
        let first = (0..3).find(|&a| number(&numbers, s, a) == least(s)).unwrap();
        assert_eq!(a, first, "at {s}");
        let over = to == 0 || to == 11;
        let from = if over { number(&numbers, s, a) } else { least(to) };
        numbers.insert((s, a), from + 1);
    }
    // A trap beside the start draws nobody: each pair that can be tried was tried, at either end as often.
    let tried = |s: usize| (0..3).map(|a| learner.experience().tried(s, a)).min().unwrap();
    assert!(tried(1) < 4 * tried(10) && tried(10) > 20, "{} and {}", tried(1), tried(10));
}

/// From one end of a corridor to the other, where chance hardly gets.
#[test]
fn exploration_goes_farther_than_chance() {
    let steps_to_the_end = |exploration| {
        let mut env = corridor(40);
        let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 39) }).unwrap();
        let settings = Settings::default().with_exploration(exploration);
        let mut learner = Learner::new(&task, settings, 1);
        learner.train(&mut env, 50_000).unwrap();
        env.steps.iter().position(|&(_, _, to)| to == 39)
    };
    let [random, coverage] = [Exploration::Random, Exploration::Coverage].map(steps_to_the_end);
    let coverage = coverage.expect("it covers the corridor");
    assert!(random.is_none_or(|random| random > 5 * coverage), "{random:?}, {coverage}");
}

/// Where some actions are greedy, those that are not cover, and values are learned.
#[test]
fn some_actions_explore() {
    let mut env = corridor(12);
    let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 11) }).unwrap();
    let settings = Settings::default().with_epsilon(Schedule::constant(0.25).unwrap()).unwrap();
    let settings = settings.with_rewards(Rewards::progress());
    let mut learner = Learner::new(&task, settings, 1);
    learner.train(&mut env, 20_000).unwrap();
    assert!((1..11).all(|s| learner.table().greedy(0, s) == 1), "{:?}", learner.table());
}
