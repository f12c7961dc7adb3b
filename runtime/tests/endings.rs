//! Worlds that end episodes: nothing is read, paid or had after the last state.

use tltl::prelude::*;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::{End, Mode};

/// Outcomes (s', p, whether the episode ends) of each `s * actions + a`, as Gymnasium has them.
struct Table {
    states: usize,
    rows: Vec<Vec<(usize, f64, bool)>>,
}

impl Table {
    fn row(&self, s: usize, a: usize, ends: bool, mut outcome: impl FnMut(usize, f64)) {
        let row = &self.rows[s * self.actions() + a];
        row.iter().filter(|&&(_, _, end)| end == ends).for_each(|&(to, p, _)| outcome(to, p));
    }
}

impl FiniteModel for Table {
    type State = usize;

    fn states(&self) -> usize {
        self.states
    }

    fn actions(&self) -> usize {
        self.rows.len() / self.states
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        self.row(s, a, false, outcome);
    }

    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        self.row(s, a, true, outcome);
    }
}

/// Start, middle, goal in a ring; the goal is entered from the middle, and ends the episode with
/// probability `ends`.
fn ring(ends: f64) -> Table {
    let enter = [(2, 1.0 - ends, false), (2, ends, true)];
    let enter = enter.into_iter().filter(|&(_, p, _)| p > 0.0).collect();
    Table { states: 3, rows: vec![vec![(1, 1.0, false)], enter, vec![(0, 1.0, false)]] }
}

fn largest<M: FiniteModel>(model: &M, task: &impl Monitor<M::State>) -> f64 {
    let task = Labelled::of_model(model, task).unwrap();
    let problem = Problem::new(&Dynamics::new(model).unwrap(), &task).unwrap();
    let own = problem.evaluate(&Policy::from_fn(&task, |_, _| 0).unwrap()).unwrap();
    let largest = problem.largest_satisfied().at(task.start(0), 0);
    assert!((own.satisfied().at(task.start(0), 0) - largest).abs() < 1e-9, "there is one policy");
    largest
}

#[test]
fn nothing_is_read_after_the_last_state() {
    let once = tltl! { |s: &usize| F ({ *s } == 2) };
    let back = tltl! { |s: &usize| ({ *s } == 2) T ({ *s } == 0) };
    let next = tltl! { |s: &usize| F ({ *s } == 2 && X ({ *s } == 0)) };
    let twice = tltl! { |s: &usize| F ({ *s } == 2 && X ({ *s } == 2)) };
    // The goal, the way back from it, and a second look at it, by how often entering it ends.
    for ends in [0.0, 0.25, 1.0] {
        let ring = ring(ends);
        assert_eq!(largest(&ring, &once), 1.0, "the goal itself is read");
        assert!((largest(&ring, &back) - (1.0 - ends)).abs() < 1e-12);
        assert!((largest(&ring, &next) - (1.0 - ends)).abs() < 1e-12);
        assert_eq!(largest(&ring, &twice), 0.0, "nobody stays at the goal");
    }
}

#[test]
fn the_tables_tell_how_a_state_is_entered() {
    let dynamics = Dynamics::new(&ring(0.25)).unwrap();
    assert!(dynamics.outcomes(1, 0).eq([(2, 0.75), (2, 0.25)]));
    assert!(dynamics.endings(1, 0).eq([(2, 0.25)]));
    assert_eq!(dynamics.endings(0, 0).count(), 0);
}

#[test]
fn environments_terminate_by_endings() {
    let mut env = ModelEnv::new(ring(0.25)).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut ended = 0;
    for _ in 0..4_000 {
        while env.reset_index(&mut rng) != 1 {}
        let step = env.step_index(0, &mut rng);
        assert_eq!((step.state, env.state_index(), step.truncated), (2, 2, false));
        ended += u32::from(step.terminated);
    }
    assert!((900..1_100).contains(&ended), "{ended}");
}

/// Six states with two random outcomes for each of three actions, some of which end the episode.
fn random(rng: &mut Xoshiro256PlusPlus) -> Table {
    let mut draw = |n: u32| rng.next_u32() % n;
    let mut row = || {
        let p = f64::from(1 + draw(15)) / 16.0;
        let mut outcome = |p| (draw(6) as usize, p, draw(4) == 0);
        vec![outcome(p), outcome(1.0 - p)]
    };
    Table { states: 6, rows: (0..6 * 3).map(|_| row()).collect() }
}

/// P(satisfied within so many steps) forwards: the distribution over pairs is moved step by step.
fn forwards(model: &Table, task: &Labelled, policy: &Policy, start: usize, steps: u64) -> f64 {
    let mut at = vec![(task.start(start), start, 1.0)];
    for _ in 0..steps {
        let mut next = Vec::new();
        for &(q, s, p) in &at {
            if task.end(q).is_some() {
                next.push((q, s, p));
                continue;
            }
            for &(to, chance, ends) in &model.rows[s * model.actions() + policy.act(q, s)] {
                let q = task.next(q, to);
                if !ends || task.end(q).is_some() {
                    next.push((q, to, p * chance));
                }
            }
        }
        at = next;
    }
    let satisfied = at.iter().filter(|&&(q, ..)| task.end(q) == Some(End::Accepted));
    satisfied.map(|&(_, _, p)| p).sum()
}

#[test]
fn within_a_horizon() {
    let formula = tltl! { |s: &usize| (F ({ *s } == 4) && F ({ *s } == 5)) ensuring ({ *s } != 3) };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    for _ in 0..20 {
        let model = random(&mut rng);
        let task = Labelled::of_model(&model, &formula).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let policy = Policy::from_fn(&task, |q, s| (q as usize + s) % 3).unwrap();
        for steps in [0, 1, 2, 5] {
            let within = problem.satisfied_within(&policy, steps).unwrap();
            let largest = problem.largest_satisfied_within(steps);
            for s in 0..6 {
                let p = within.at(task.start(s), s);
                assert!((p - forwards(&model, &task, &policy, s, steps)).abs() < 1e-12);
                assert!(p <= largest.at(task.start(s), s), "no policy does better");
            }
        }
        let (ever, long) =
            (problem.largest_satisfied(), problem.largest_satisfied_within(1_000_000));
        assert!((ever.mean() - long.mean()).abs() < 1e-9);
    }
}

/// Ng, Harada and Russell 1999: with a potential of 0 where an episode ends, values differ by the
/// potential alone, so that the differences between actions stay.
#[test]
fn shaping_leaves_the_optimal_policies_as_they_are() {
    let formula = tltl! { |s: &usize| (F ({ *s } == 4) && F ({ *s } == 5)) ensuring ({ *s } != 3) };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let mut differing = 0;
    for _ in 0..50 {
        let model = random(&mut rng);
        let task = Labelled::of_model(&model, &formula).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let [plain, shaped] =
            [Mode::Acceptance, Mode::Shaped].map(|mode| problem.optimal_q(&Rewards::of(mode)));
        for (q, s) in task.live().flat_map(|q| (0..6).map(move |s| (q, s))) {
            let (plain, shaped) = (plain.row(q, s), shaped.row(q, s));
            for a in 1..3 {
                let (one, other) = (plain[a] - plain[0], shaped[a] - shaped[0]);
                assert!((one - other).abs() < 1e-9, "{plain:?} {shaped:?}");
                differing += u32::from(one != 0.0);
            }
        }
    }
    assert!(differing > 100, "actions differ in {differing} cases");
}
