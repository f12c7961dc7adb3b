//! What finishing promises, on worlds that were seen a little: random, risky and slow ones.

use tltl::model;
use tltl::prelude::*;
use tltl::rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};

/// The share of P that all steps may cost.
const PROMISED: f64 = 6e-3;

/// Outcomes by state, then action.
type World = Vec<[Vec<(usize, f64)>; 3]>;

/// States in a row, of which the last is the goal, and the one before it the trap: each action leads to two
/// places, with probability `rare` to the second of them.
fn random(n: usize, rare: f64, rng: &mut impl Rng) -> World {
    let mut row = |s: usize| {
        let (near, far) = (s.saturating_sub(3)..(s + 4).min(n), 0..n);
        [(); 3].map(|()| {
            let to = (rng.random_range(near.clone()), rng.random_range(far.clone()));
            if s + 2 < n { vec![(to.0, 1.0 - rare), (to.1, rare)] } else { vec![(s, 1.0)] }
        })
    };
    (0..n).map(&mut row).collect()
}

/// What was learned in some steps, and the world as it was seen.
fn learned(world: &World, task: &dyn Fn(usize) -> Labelled, steps: u64) -> (Learner, Problem) {
    let world = model::from_fn(world.len(), 3, |s, a| world[s][a].clone());
    let mut env = ModelEnv::new(world).unwrap();
    let task = task(env.dynamics().states());
    let mut learner = Learner::new(&task, Settings::default(), 1);
    learner.train(&mut env, steps).unwrap();
    let seen = Dynamics::new(learner.experience()).unwrap();
    (learner, Problem::new(&seen, &task).unwrap())
}

fn risky(n: usize) -> Labelled {
    let task = tltl! { |s: &usize| ({ *s + 2 != n }) U ({ *s + 1 == n }) };
    Labelled::new(0..n, ["a", "b", "c"], &task).unwrap()
}

fn sure(n: usize) -> Labelled {
    Labelled::new(0..n, ["a", "b", "c"], &tltl! { |s: &usize| F ({ *s + 1 == n }) }).unwrap()
}

/// (rare, environment steps, states)
const CASES: [(f64, u64, usize); 5] =
    [(0.5, 300, 6), (0.1, 3_000, 12), (0.02, 30_000, 20), (1e-3, 100_000, 20), (1e-4, 300_000, 30)];

/// No more than the promised share of the largest P is given away, however hard the world is.
#[test]
fn no_more_than_promised_is_given_away() {
    let (mut possible, mut given) = (0, 0.0_f64);
    for ((rare, steps, n), seed) in
        CASES.into_iter().flat_map(|case| (0..40).map(move |i| (case, i)))
    {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let (learner, seen) = learned(&random(n, rare, &mut rng), &risky, steps);
        let worth = learner.certify(&seen).unwrap();
        let least = (1.0 - PROMISED) * worth.optimal_satisfied;
        assert!(worth.satisfied >= least - 1e-12, "{rare} {seed}: {worth:?}");
        possible += usize::from(worth.optimal_satisfied > 0.2);
        given = given.max(worth.regret_satisfied);
    }
    assert!(possible > 100 && given > 1e-5, "{possible} and {given}");
}

/// Where nothing can be lost for good but by a mistake, it is the fewest steps.
#[test]
fn nothing_but_steps_counts_where_success_is_sure() {
    let mut sure_worlds = 0;
    for ((rare, steps, n), seed) in
        CASES.into_iter().flat_map(|case| (0..40).map(move |i| (case, i)))
    {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut world = random(n, rare, &mut rng);
        // Back to the first place instead of into the trap.
        world[n - 2] = [(); 3].map(|()| vec![(0, 1.0)]);
        let (learner, seen) = learned(&world, &sure, steps);
        let worth = learner.certify(&seen).unwrap();
        if worth.optimal_satisfied == 1.0 {
            sure_worlds += 1;
            assert_eq!(worth.satisfied, 1.0, "{rare} {seed}: {worth:?}");
            assert!(worth.regret_steps.unwrap() < 1e-2, "{rare} {seed}: {worth:?}");
        }
    }
    assert!(sure_worlds > 100, "{sure_worlds}");
}
