//! Shields keep their word: the worst that allowed actions can do is solved for by other means.

mod world;

use tltl::model;
use tltl::prelude::*;
use tltl::rand::{Rng, RngExt, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::End;
use tltl::shield::Shield;
use tltl::tltl;
use world::{A, B, C, Cell, Grid, PAPER, avoid, both, dynamics, on_paper, problem};

const STEPS: u64 = 1_000_000;
const EPSILONS: [f64; 4] = [0.0, 1e-4, 1e-2, 0.3];

/// P(lost) by pair, by plain sweeps from 0 until nothing changes; `pick` is the better of two values of
/// allowed actions.
fn swept(
    problem: &Problem,
    allowed: impl Fn(u32, usize) -> Vec<usize>,
    pick: fn(f64, f64) -> f64,
) -> Vec<f64> {
    let (task, dynamics) = (problem.task(), problem.dynamics());
    let end = |pair: usize| task.end((pair / task.states()) as u32);
    let lost = |pair| f64::from(u8::from(end(pair) == Some(End::Lost)));
    let mut values: Vec<f64> = (0..task.pairs()).map(lost).collect();
    let mut rows = Vec::new();
    for (q, s) in task.live().flat_map(|q| (0..task.states()).map(move |s| (q, s))) {
        let outcomes =
            |a| dynamics.outcomes(s, a).map(|(to, p)| (task.pair(task.next(q, to), to), p));
        let actions = allowed(q, s).into_iter().map(|a| outcomes(a).collect::<Vec<_>>());
        rows.push((task.pair(q, s), actions.collect::<Vec<_>>()));
    }
    for _ in 0..1_000_000 {
        let mut change: f64 = 0.0;
        for (pair, actions) in &rows {
            let value =
                |outcomes: &Vec<(usize, f64)>| outcomes.iter().map(|&(to, p)| p * values[to]).sum();
            let new = actions.iter().map(value).reduce(pick).unwrap();
            change = change.max((new - values[*pair]).abs());
            values[*pair] = new;
        }
        if change < 1e-14 {
            return values;
        }
    }
    panic!("the world is too slow for plain sweeps");
}

/// The smallest possible P(lost).
fn smallest(problem: &Problem) -> Vec<f64> {
    swept(problem, |_, _| (0..problem.task().actions()).collect(), f64::min)
}

/// By how much the worst policy of allowed actions exceeds a baseline, at the worst pair.
fn excess(problem: &Problem, shield: &Shield, baseline: &[f64]) -> f64 {
    let worst = swept(problem, |q, s| shield.allowed(q, s).collect(), f64::max);
    worst.iter().zip(baseline).map(|(worst, own)| worst - own).fold(f64::NEG_INFINITY, f64::max)
}

/// A grid of 20 cells, small enough for plain sweeps.
const SMALL: Grid = Grid { width: 4, height: 5 };

/// Tasks with traps on random layouts of the small grid; automata of one to five live states.
fn layouts() -> Vec<Problem> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
    let mut cell = || Cell { x: rng.random_range(0..4), y: rng.random_range(0..5) };
    let (mut problems, dynamics) = (Vec::new(), Dynamics::new(&SMALL).unwrap());
    let mut add = |task: &dyn Monitor<Cell>| {
        let task = Labelled::of_model(&SMALL, task).unwrap();
        problems.push(Problem::new(&dynamics, &task).unwrap());
    };
    for _ in 0..2 {
        let [a, b, c] = loop {
            let [a, b, c] = [cell(), cell(), cell()];
            if a != b && b != c && a != c {
                break [a, b, c];
            }
        };
        let (one, two, other) = (avoid(c, a), avoid(b, c), both(a, b));
        add(&one);
        add(&Product::conjunction(&[&one, &other]));
        add(&Product::disjunction(&[&one, &two]));
        add(&Product::conjunction(&[&avoid(b, a), &avoid(c, b)]));
    }
    problems
}

#[test]
fn no_allowed_policy_loses_more_than_promised() {
    for problem in layouts() {
        let smallest = smallest(&problem);
        for epsilon in EPSILONS {
            let shield = Shield::safest(&problem, epsilon).unwrap();
            let over = excess(&problem, &shield, &smallest);
            assert!(over <= epsilon.max(1e-9) + 1e-10, "{over}, {epsilon}, {problem:?}");
        }
    }
}

/// The shield around the best policy leaves what it can do, and the more the larger ε is.
#[test]
fn the_best_policy_stays_allowed() {
    for problem in layouts().into_iter().take(2) {
        let optimum = problem.optimum(&Rewards::default());
        let own = problem.lost(optimum.best().policy()).unwrap().mean();
        let mut before = 0.0;
        for epsilon in [0.0, 1e-2] {
            let shield = Shield::keeping_best(&problem, epsilon).unwrap();
            let worth = optimum.certify_shield(&shield, optimum.q()).unwrap();
            let (allowed, after) = (worth.allowed.unwrap(), worth.after);
            assert!((allowed.satisfied - after.optimal_satisfied).abs() < 1e-9, "{allowed:?}");
            let steps = allowed.steps.unwrap() / after.optimal_steps.unwrap();
            assert!((steps - 1.0).abs() < 1e-6, "{steps}, {problem:?}");
            assert!(allowed.lost <= own + epsilon.max(1e-9), "{allowed:?}");
            assert!(allowed.fraction >= before, "more risk, more actions: {allowed:?}");
            before = allowed.fraction;
        }
    }
}

/// A small world: state 0 is the goal, 1 the trap, the others have three actions with up to three
/// outcomes, so that some may wait, some are lost, and some can avoid it for ever.
fn small(rng: &mut Xoshiro256PlusPlus) -> Vec<[Vec<(usize, f64)>; 3]> {
    let mut action = |s: usize| {
        if s < 2 {
            return vec![(s, 1.0)];
        }
        let count = rng.random_range(1..4);
        let weights: Vec<f64> = (0..count).map(|_| 0.05 + rng.random::<f64>()).collect();
        let sum: f64 = weights.iter().sum();
        weights.into_iter().map(|w| (rng.random_range(0..6), w / sum)).collect()
    };
    (0..6).map(|s| [action(s), action(s), action(s)]).collect()
}

/// P(lost) of a policy by elimination, over the states from which it can come to the trap.
fn eliminated(outcomes: &[[Vec<(usize, f64)>; 3]], policy: &[usize]) -> Vec<f64> {
    let n = outcomes.len();
    let mut reaches: Vec<bool> = (0..n).map(|s| s == 1).collect();
    for _ in 0..n {
        for s in 0..n {
            reaches[s] |= outcomes[s][policy[s]].iter().any(|&(to, _)| reaches[to]);
        }
    }
    let mut rows = vec![vec![0.0; n + 1]; n];
    for s in 0..n {
        rows[s][s] = 1.0;
        if s == 1 {
            rows[s][n] = 1.0;
        } else if reaches[s] {
            outcomes[s][policy[s]].iter().for_each(|&(to, p)| rows[s][to] -= p);
        }
    }
    for i in 0..n {
        let pivot = (i..n).max_by(|&j, &k| rows[j][i].abs().total_cmp(&rows[k][i].abs())).unwrap();
        rows.swap(i, pivot);
        let above = rows[i].clone();
        for row in rows.iter_mut().enumerate().filter(|&(j, _)| j != i).map(|(_, row)| row) {
            let factor = row[i] / above[i];
            row.iter_mut().zip(&above).for_each(|(x, p)| *x -= factor * p);
        }
    }
    (0..n).map(|s| rows[s][n] / rows[s][s]).collect()
}

/// All policies of `allowed` actions.
fn policies(allowed: impl Fn(usize) -> Vec<usize>) -> Vec<Vec<usize>> {
    (0..6).fold(vec![Vec::new()], |all, s| {
        let with = |policy: &Vec<usize>, a| [policy.clone(), vec![a]].concat();
        all.iter().flat_map(|p| allowed(s).into_iter().map(move |a| with(p, a))).collect()
    })
}

/// All policies of small random worlds, one by one. In most of them little happens in a step: that changes
/// what a step can lose, and nothing in the long run.
#[test]
fn every_allowed_policy_of_a_small_world_keeps_the_promise() {
    let (mut rng, mut free, mut waits) = (Xoshiro256PlusPlus::seed_from_u64(3), 0, 0);
    for rate in [1.0, 1e-3, 1e-6, 1e-9].repeat(10) {
        let outcomes = small(&mut rng);
        let model = model::from_fn(6, 3, |s, a| {
            let slow = outcomes[s][a].iter().map(|&(to, p)| (to, p * rate));
            slow.chain([(s, 1.0 - rate)]).collect::<Vec<_>>()
        });
        let formula = tltl! { |s: &usize| ({ *s } != 1) U ({ *s } == 0) };
        let task = Labelled::of_model(&model, &formula).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let mut smallest = [1.0; 6];
        for policy in policies(|s| if s < 2 { vec![0] } else { vec![0, 1, 2] }) {
            let lost = eliminated(&outcomes, &policy);
            smallest.iter_mut().zip(lost).for_each(|(least, p)| *least = p.min(*least));
        }
        let own = problem.lost(problem.best().policy()).unwrap();
        for epsilon in EPSILONS {
            let safest = Shield::safest(&problem, epsilon).unwrap();
            let best = Shield::keeping_best(&problem, epsilon).unwrap();
            for (shield, baseline) in [(&safest, &smallest[..]), (&best, &own.as_slice()[..6])] {
                let allowed = |s: usize| shield.allowed(0, s).collect::<Vec<_>>();
                for policy in policies(|s| if s < 2 { vec![0] } else { allowed(s) }) {
                    let lost = eliminated(&outcomes, &policy);
                    // Where success is impossible the safest policy is the baseline.
                    let keeps = |s: usize| lost[s] <= baseline[s] + epsilon.max(1e-9) + 1e-10;
                    assert!((2..6).all(keeps), "{lost:?} {baseline:?} {epsilon} {outcomes:?}");
                    let sure = |s: usize| smallest[s] > 0.0 || lost[s] == 0.0;
                    assert!(epsilon > 0.0 || shield == &best || (0..6).all(sure), "{lost:?}");
                }
                free += (2..6).filter(|&s| allowed(s).len() > 1).count();
            }
            waits += usize::from((2..6).any(|s| smallest[s] == 0.0 && own.at(0, s) > 0.0));
        }
    }
    assert!(
        free > 300 && waits > 5,
        "worlds in which there is something to decide: {free}, {waits}"
    );
}

/// Per step the careless way is 6e-4 to 6e-10 more likely to be lost than the careful one, and in the long
/// run 27 times as likely: what is little at each step is not.
#[test]
fn negligible_steps_add_up() {
    let slow = |rate: f64| {
        model::from_fn(3, 2, move |s, a| match (s, a) {
            (2, 0) => vec![(0, 0.976 * rate), (1, 0.024 * rate), (2, 1.0 - rate)],
            (2, 1) => vec![(0, 0.35 * rate), (1, 0.65 * rate), (2, 1.0 - rate)],
            _ => vec![(s, 1.0)],
        })
    };
    for rate in [1e-3, 1e-6, 1e-9] {
        let model = slow(rate);
        let formula = tltl! { |s: &usize| ({ *s } != 1) U ({ *s } == 0) };
        let task = Labelled::of_model(&model, &formula).unwrap();
        let problem = Problem::new(&Dynamics::new(&model).unwrap(), &task).unwrap();
        let allowed = |epsilon| {
            let shields =
                [Shield::safest(&problem, epsilon), Shield::keeping_best(&problem, epsilon)];
            shields.map(|shield| shield.unwrap().allowed(0, 2).collect::<Vec<_>>())
        };
        for epsilon in [0.0, 1e-3, 0.6] {
            assert_eq!(allowed(epsilon), [[0], [0]], "{rate} {epsilon}");
        }
        assert_eq!(allowed(0.63), [[0, 1], [0, 1]], "{rate}");
    }
}

/// Staying away is safest and never arrives; what that costs is said, and the other form does not cost it.
#[test]
fn what_a_shield_costs_is_said() {
    // From 2 a bridge to the goal, lost one time in a hundred; 3 is beside the way.
    let bridge = model::from_fn(4, 2, |s, a| match (s, a) {
        (2, 0) => vec![(0, 0.99), (1, 0.01)],
        (2, 1) | (3, 0) => vec![(3, 1.0)],
        (3, 1) => vec![(2, 1.0)],
        _ => vec![(s, 1.0)],
    });
    let formula = tltl! { |s: &usize| ({ *s } != 1) U ({ *s } == 0) };
    let task = Labelled::of_model(&bridge, &formula).unwrap();
    let problem = Problem::new(&Dynamics::new(&bridge).unwrap(), &task).unwrap();
    let optimum = problem.optimum(&Rewards::acceptance());
    let certify = |shield| optimum.certify_shield(&shield, optimum.q()).unwrap().allowed.unwrap();
    let safest = certify(Shield::safest(&problem, 0.0).unwrap());
    // One start of four is the goal, one the trap.
    assert_eq!((safest.satisfied, safest.steps, safest.lost), (0.25, Some(0.0), 0.25));
    let best = certify(Shield::keeping_best(&problem, 0.0).unwrap());
    assert!((best.satisfied - 0.745).abs() < 1e-9 && (best.lost - 0.255).abs() < 1e-9, "{best:?}");
    assert_eq!(best.steps, optimum.best().mean_steps());
}

/// Where the task has ended everything is allowed, and elsewhere something.
#[test]
fn something_is_always_allowed() {
    let problem = layouts().swap_remove(0);
    let task = problem.task();
    let ends = task.live().fold((0..3).collect::<Vec<u32>>(), |all, q| {
        all.into_iter().filter(|&other| other != q).collect()
    });
    let shields = [
        Shield::safest(&problem, 0.0).unwrap(),
        Shield::keeping_best(&problem, 0.0).unwrap(),
        Shield::one_step(task),
    ];
    for shield in shields {
        assert!((0..20).all(|s| shield.allowed(0, s).count() > 0));
        assert!(ends.iter().all(|&q| (0..20).all(|s| shield.allowed(q, s).count() == 5)));
    }
    for epsilon in [-1e-9, 1.5, f64::NAN] {
        let error = Shield::safest(&problem, epsilon).unwrap_err();
        assert_eq!((error.field(), error.range()), ("epsilon", "in [0, 1]"));
    }
}

/// The paper's grid, which counts the episodes that enter the trap: all, and those that do so by an
/// action that is riskier than another.
struct Counting<'a> {
    env: ModelEnv<Grid>,
    task: &'a Labelled,
    shield: &'a Shield,
    q: u32,
    lost: u64,
    avoidably: u64,
}

impl<'a> Counting<'a> {
    fn new(task: &'a Labelled, shield: &'a Shield) -> Self {
        let env = ModelEnv::new(PAPER).unwrap();
        Self { env, task, shield, q: 0, lost: 0, avoidably: 0 }
    }

    fn read(&mut self, avoidable: bool) {
        self.q = self.task.next(self.q, self.env.state_index());
        if self.task.end(self.q) == Some(End::Lost) {
            self.lost += 1;
            self.avoidably += u64::from(avoidable);
        }
    }
}

impl Env for Counting<'_> {
    type State = Cell;

    fn actions(&self) -> usize {
        5
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Cell {
        let cell = self.env.reset(rng);
        self.q = 0;
        self.read(false);
        cell
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<Cell> {
        let barred = !self.shield.allows(self.q, self.env.state_index(), action);
        let step = self.env.step(action, rng);
        self.read(barred);
        step
    }
}

impl FiniteEnv for Counting<'_> {
    fn states(&self) -> usize {
        80
    }

    fn state(&self, s: usize) -> Cell {
        self.env.state(s)
    }

    fn state_index(&self) -> usize {
        self.env.state_index()
    }
}

/// No avoidable trap is entered behind a shield of the model; one step ahead far fewer than without.
/// What is learned behind it is as safe as can be, and costs less than a hundredth of the steps.
#[test]
fn avoidable_traps_are_not_entered() {
    let task = on_paper(&avoid(C, A));
    let problem = problem(&task);
    let exact = Shield::safest(&problem, 0.0).unwrap();
    let train = |shield: Option<Shield>| {
        let mut env = Counting::new(&task, &exact);
        let mut learner = Learner::new(&task, Settings::default(), 1);
        match shield {
            Some(mut shield) => learner.train_shielded(&mut env, &mut shield, STEPS).unwrap(),
            None => learner.train(&mut env, STEPS).unwrap(),
        }
        (learner, env.lost, env.avoidably)
    };
    let (free, lost, avoidably) = train(None);
    let (learner, guarded, never) = train(Some(exact.clone()));
    let (looking, ahead, seldom) = train(Some(Shield::one_step(&task)));
    assert!(never == 0 && avoidably > 5_000, "{never}, {avoidably}");
    let share = |lost: u64, learner: &Learner| lost as f64 / learner.episodes() as f64;
    let shares = [share(lost, &free), share(ahead, &looking), share(guarded, &learner)];
    assert!(shares[0] > 0.4 && shares[1] < 0.25 && shares[2] < 0.02, "{shares:?}");
    assert!(0 < seldom && 4 * seldom < avoidably, "it must see a trap to know it: {seldom}");

    let policy = exact.policy(&learner.q()).unwrap();
    let certificate = problem.optimum(&learner.rewards()).certify(&policy).unwrap();
    assert!(certificate.worst_regret_satisfied < 1e-6, "{certificate:?}");
    assert!(certificate.regret_steps.unwrap() < 1e-2, "{certificate:?}");
}

/// A shield that learns has learned what the experience of the learner behind it says; slices do not
/// matter behind it either.
#[test]
fn a_shield_learns_what_the_learner_sees() {
    let task = on_paper(&avoid(C, A));
    let train = |slices: &[u64]| {
        let mut learner = Learner::new(&task, Settings::default(), 2);
        let mut shield = Shield::one_step(&task);
        for &total in slices {
            let mut env = ModelEnv::new(PAPER).unwrap();
            learner.train_shielded(&mut env, &mut shield, total).unwrap();
        }
        (learner, shield)
    };
    let (learner, shield) = train(&[9_000]);
    let mut told = Shield::one_step(&task);
    told.extend(learner.experience()).unwrap();
    assert!(told == shield && shield != Shield::one_step(&task));
    assert!(train(&[700, 5_000, 9_000]) == (learner, shield));
}

/// What is known of a world of another size is refused.
#[test]
fn experience_of_another_world_is_refused() {
    let seen = tltl::learn::Experience::new(79, 5);
    let error = Shield::one_step(&on_paper(&avoid(C, A))).extend(&seen).unwrap_err();
    assert!(error.to_string().starts_with("experience of a world of 79 states"), "{error}");
    let elsewhere = Problem::new(&dynamics(), &on_paper(&avoid(B, A))).unwrap();
    let error = Shield::one_step(&on_paper(&avoid(C, A))).largest_lost(&elsewhere).unwrap_err();
    assert!(error.to_string().starts_with("a shield of"), "{error}");
}
