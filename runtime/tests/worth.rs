//! What policies are worth, what guards them, and what outlives a process.

mod world;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tltl::augmented::{End, Labelled, Reward, Rewards};
use tltl::checkpoint;
use tltl::compose::{Combine, Composition, Skill};
use tltl::controller::Hierarchy;
use tltl::env::{Env, FiniteEnv, ModelEnv};
use tltl::estimate::{Interval, Trials, estimate};
use tltl::learn::{Learner, Settings, Terminal, WholeLearner, seeds};
use tltl::model::{Dynamics, FiniteModel};
use tltl::product::Product;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::shield::Shield;
use tltl::solve::Problem;
use world::{A, B, C, Cell, GAMMA, PAPER, avoid, both, dynamics, eventually, on_paper};

fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

fn index(s: &Cell) -> usize {
    (s.y * 8 + s.x) as usize
}

#[test]
fn estimates_hold_the_exact_value() {
    let (task, dynamics) = (avoid(C, A), dynamics());
    let labelled = on_paper(&task);
    let problem = Problem::new(&dynamics, &labelled);
    let policy = problem.optimal_q(&Rewards::of(Reward::Literal), GAMMA).policy();
    let (p, steps) = problem.mean(&problem.evaluate(&policy));
    let trials = Trials { episodes: 20_000, horizon: 1_000, confidence: 0.999 };
    let act = |s: &Cell, q| policy[labelled.pair(q, index(s))] as usize;
    let mut env = ModelEnv::new(PAPER).unwrap();
    let seen = estimate(&mut env, &task, trials, &mut rng(1), act).unwrap();
    let holds = |interval: Interval, value: f64| interval.low < value && value < interval.high;
    assert!(holds(seen.satisfied, p) && holds(seen.steps.unwrap(), steps), "{seen:?}");
    assert!(holds(seen.lost, 1.0 - p), "what is not satisfied is lost here: {seen:?}");
}

#[test]
fn intervals_are_those_of_the_tables() {
    let near = |value: f64, expected: f64| assert!((value - expected).abs() < 2e-3, "{value}");
    let student = |n: u64| {
        // Values of variance 1 and mean 0: the half width is t / √n.
        let interval = Interval::student(n, 0.0, n as f64 - 1.0, 0.95).unwrap();
        interval.high * (n as f64).sqrt()
    };
    near(student(2), 12.706);
    near(student(3), 4.303);
    near(student(11), 2.228);
    near(student(20), 2.093);
    let wilson = Interval::wilson(0, 10, 0.95);
    near(wilson.high, 0.2775);
    assert_eq!(wilson.low, 0.0);
}

#[test]
fn certificates_name_starts_and_mistakes() {
    let (dynamics, labelled) = (dynamics(), on_paper(&both(A, B)));
    let problem = Problem::new(&dynamics, &labelled);
    let exact = problem.optimal_q(&Rewards::default(), GAMMA);
    let mut policy = exact.policy();
    assert!(problem.mistakes(&policy, &exact, 1e-6).is_empty());
    policy[labelled.pair(0, 0)] = 4;
    let mistakes = problem.mistakes(&policy, &exact, 1e-6);
    assert_eq!(mistakes.len(), 1);
    assert_eq!((mistakes[0].q, mistakes[0].state, mistakes[0].action), (0, 0, 4));
    let starts = problem.starts(&policy, &problem.best());
    assert_eq!(starts.len(), 80);
    let corner = starts[0];
    assert!(corner.steps.unwrap() > corner.optimal_steps.unwrap() + 1.0, "{corner:?}");
}

#[test]
fn shields_keep_out_of_the_trap() {
    let (dynamics, labelled) = (dynamics(), on_paper(&avoid(C, A)));
    let problem = Problem::new(&dynamics, &labelled);
    let q = problem.optimal_q(&Rewards::of(Reward::Literal), GAMMA);
    let shield = Shield::of_model(&problem);
    let worth = problem.certify_shield(&shield, &q, &q);
    assert!(worth.lost_before > 0.4 && worth.overruled > 0.0, "{worth:?}");
    assert!((worth.lost_after - worth.smallest_lost).abs() < 1e-6, "{worth:?}");
    // Without a model: the step into the trap itself.
    let mut learner = Learner::new(&labelled, 5, Settings::default(), 1);
    learner.train(&mut ModelEnv::new(PAPER).unwrap(), &labelled, 200_000);
    let shield = Shield::one_step(learner.experience(), &labelled);
    let (beside, up) = (index(&C) - 8, 0);
    assert!(!shield.allows(0, beside, up) && shield.allows(0, 0, up));
}

#[test]
fn the_automaton_chooses_the_controller() {
    let (task, dynamics) = (both(A, B), dynamics());
    let labelled = on_paper(&task);
    let policy = Problem::new(&dynamics, &labelled).best().policy;
    let sub = |q: u32| {
        let layer = policy[labelled.pair(q, 0)..labelled.pair(q + 1, 0)].to_vec();
        move |s: &Cell| layer[index(s)] as usize
    };
    let mut hierarchy = Hierarchy::new(&task, sub(0)).with(1, sub(1)).with(2, sub(2));
    let (mut env, mut random) = (ModelEnv::new(PAPER).unwrap(), rng(2));
    let mut s = env.reset(&mut random);
    while hierarchy.observe(&s).unwrap().is_none() {
        s = env.step(hierarchy.act(&s), &mut random).state;
    }
    assert_eq!(hierarchy.end(), Some(End::Accepted));
    assert!(s == A || s == B);
    hierarchy.reset();
    assert_eq!(hierarchy.q(), None);
}

#[test]
fn whole_trajectories_teach_less() {
    let (task, labelled) = (eventually(A), on_paper(&eventually(A)));
    let mut env = ModelEnv::new(PAPER).unwrap();
    let paid = Terminal::Robustness { bound: 10.0 };
    let mut learner = WholeLearner::new(&labelled, 5, Settings::paper(), paid, true, 1);
    learner.train(&mut env, &task, &labelled, 300_000).unwrap();
    let dynamics = dynamics();
    let problem = Problem::new(&dynamics, &labelled);
    let (p, steps) = problem.mean(&problem.evaluate(&learner.policy()));
    assert!(p > 0.9 && steps < 30.0, "one goal can be learned even so: {p}, {steps}");
}

/// Penalties make no difference where they cannot be earned, and keep out of the trap where they can.
#[test]
fn penalties_are_paid() {
    let (dynamics, labelled) = (dynamics(), on_paper(&avoid(C, A)));
    let problem = Problem::new(&dynamics, &labelled);
    let p_of = |rewards: Rewards| {
        problem.mean(&problem.evaluate(&problem.optimal_q(&rewards, GAMMA).policy())).0
    };
    let progress = Rewards::default();
    let punished = p_of(Rewards { trap_penalty: 10.0, ..progress });
    assert!(punished > p_of(progress), "a penalty for the trap makes safer");
    let value = |rewards: Rewards| problem.optimal_q(&rewards, GAMMA).max(0, 0);
    let stepped = value(Rewards { step_penalty: 0.01, ..progress });
    let free = value(progress);
    assert!(stepped < free && free - stepped < 0.01 / (1.0 - GAMMA));
}

#[test]
fn the_safe_setting_is_safe() {
    let (dynamics, labelled) = (dynamics(), on_paper(&avoid(C, A)));
    let problem = Problem::new(&dynamics, &labelled);
    let settings = Settings::safe();
    let exact = problem.optimal_q(&settings.rewards, settings.gamma);
    assert!(problem.certify(&exact.policy(), &exact).regret_satisfied < 1e-3);
}

/// 6 million steps with default settings: fresh seeds, other layouts.
#[test]
fn defaults_learn_within_a_thousandth() {
    let dynamics = dynamics();
    let corners = (Cell { x: 0, y: 0 }, Cell { x: 7, y: 9 });
    for (layout, (a, b)) in [(0, (A, B)), (1, corners)] {
        let task = on_paper(&both(a, b));
        let problem = Problem::new(&dynamics, &task);
        let optimum = problem.mean(&problem.best()).1;
        let excess = seeds(100..102, |seed| {
            let mut learner = Learner::new(&task, 5, Settings::default(), seed);
            learner.train(&mut ModelEnv::new(PAPER).unwrap(), &task, 6_000_000);
            let online = problem.mean(&problem.evaluate(&learner.q().policy())).1;
            learner.replay(&task).unwrap();
            let replayed = problem.mean(&problem.evaluate(&learner.q().policy())).1;
            [online / optimum - 1.0, replayed / optimum - 1.0]
        });
        for [online, replayed] in excess {
            assert!(layout > 0 || online < 1e-3, "{online}");
            assert!(replayed < 1e-3, "{replayed}");
        }
    }
}

/// Learned skills, 340,000 steps each, composed from their experience: fresh seeds.
#[test]
fn composition_of_learned_skills_on_fresh_seeds() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let (one, two, task) = (on_paper(&phi1), on_paper(&phi2), on_paper(&whole));
    let dynamics = dynamics();
    let problem = Problem::new(&dynamics, &task);
    let worst = seeds(200..220, |seed| {
        let mut env = ModelEnv::new(PAPER).unwrap();
        let mut learn = |task: &Labelled, seed| {
            let mut learner = Learner::new(task, 5, Settings::default(), seed);
            learner.train(&mut env, task, 340_000);
            learner
        };
        let (first, second) = (learn(&one, seed), learn(&two, seed + 1_000));
        let taken = env.steps();
        let mut experience = first.experience().clone();
        experience.extend(second.experience());
        let seen = Dynamics::new(&experience).unwrap();
        let skills = [Skill { q: first.q(), task: &one }, Skill { q: second.q(), task: &two }];
        let composition = Composition::new(&whole, &task, &skills);
        let start = composition.initial(Combine::NormalisedSum);
        let refined = composition.refined(&seen, &Rewards::default(), GAMMA, &start);
        assert_eq!(env.steps(), taken, "a composition takes no step in the world");
        let (p, steps) = problem.mean(&problem.evaluate(&refined.policy()));
        assert!(p > 0.999);
        steps / 16.7111 - 1.0
    });
    let worst = worst.into_iter().fold(0.0, f64::max);
    assert!(worst < 0.003, "{worst}");
}

/// Disjunction and sequence through the composition: refined to the optimum, sums near it.
#[test]
fn other_operators_compose() {
    let (phi1, phi2) = (avoid(C, A), eventually(B));
    let products: [Product<'_, Cell>; 2] =
        [Product::disjunction(&[&phi1, &phi2]), Product::sequence(&[&phi1, &phi2])];
    let (one, two, dynamics) = (on_paper(&phi1), on_paper(&phi2), dynamics());
    let solved =
        |task: &Labelled| Problem::new(&dynamics, task).optimal_q(&Rewards::default(), GAMMA);
    let (q1, q2) = (solved(&one), solved(&two));
    let skills = [Skill { q: &q1, task: &one }, Skill { q: &q2, task: &two }];
    for product in &products {
        let task = on_paper(product);
        let composition = Composition::new(product, &task, &skills);
        let start = composition.compensated(&dynamics, &Rewards::default(), GAMMA);
        let refined = composition.refined(&dynamics, &Rewards::default(), GAMMA, &start);
        for (a, b) in refined.values().iter().zip(solved(&task).values()) {
            assert!((a - b).abs() < 1e-8);
        }
    }
}

fn place(name: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder.join("learner")
}

#[test]
fn broken_checkpoints_are_refused() {
    let path = place("broken");
    assert!(checkpoint::read(&path, "learner").unwrap().is_none());
    checkpoint::write(&path, "learner", b"some content").unwrap();
    assert_eq!(checkpoint::read(&path, "learner").unwrap().unwrap(), b"some content");
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1, "nothing is left over");
    let good = fs::read(&path).unwrap();
    let refused = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        checkpoint::read(&path, "learner").unwrap_err().to_string()
    };
    assert!(refused(&good[..good.len() - 1]).contains("cut short"));
    assert!(refused(&good[..5]).contains("not a checkpoint"));
    assert!(refused(b"{\"format\": \"tltl-policy\"}\n").contains("not a checkpoint"));
    let mut changed = good.clone();
    *changed.last_mut().unwrap() ^= 1;
    assert!(refused(&changed).contains("corrupt"));
    fs::write(&path, &good).unwrap();
    assert!(checkpoint::read(&path, "study").unwrap_err().to_string().contains("not of `study`"));
}

const TOTAL: u64 = 400_000;
const SLICE: u64 = 2_000;

/// Trains from the last checkpoint to the end, one checkpoint a slice.
fn study(path: &std::path::Path) -> Learner {
    let task = on_paper(&both(A, B));
    let mut learner: Learner = match checkpoint::read(path, "learner").unwrap() {
        Some(content) => serde_json::from_slice(&content).unwrap(),
        None => Learner::new(&task, 5, Settings::default(), 7),
    };
    let mut env = ModelEnv::new(PAPER).unwrap();
    while learner.steps() < TOTAL {
        learner.train(&mut env, &task, (learner.steps() + SLICE).min(TOTAL));
        checkpoint::write(path, "learner", &serde_json::to_vec(&learner).unwrap()).unwrap();
    }
    learner
}

/// What the killed process runs; without its variable it is not one, and does nothing.
#[test]
fn child_of_the_kill_test() {
    if let Some(path) = std::env::var_os("TLTL_KILL_TEST") {
        study(&PathBuf::from(path));
    }
}

/// A study that is killed (SIGKILL on Unix) goes on from its last checkpoint and ends bit for bit
/// where one ends that was not.
#[test]
fn a_killed_study_goes_on() {
    let path = place("killed");
    let mut kills = 0;
    for wait in [30, 70, 110] {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "child_of_the_kill_test"])
            .env("TLTL_KILL_TEST", &path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        let start = Instant::now();
        while !path.exists() && start.elapsed() < Duration::from_secs(20) {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(wait));
        kills += u32::from(child.try_wait().unwrap().is_none());
        child.kill().unwrap();
        child.wait().unwrap();
    }
    assert!(kills > 0, "every child was done before it was killed");
    let left = checkpoint::read(&path, "learner").unwrap().expect("a slice was done");
    let left: Learner = serde_json::from_slice(&left).unwrap();
    assert!(left.steps() >= SLICE);
    let task = on_paper(&both(A, B));
    let mut whole = Learner::new(&task, 5, Settings::default(), 7);
    whole.train(&mut ModelEnv::new(PAPER).unwrap(), &task, TOTAL);
    assert!(study(&path) == whole, "a resumed study went another way");
}

#[test]
fn both_ways_of_stepping_agree() {
    let (mut one, mut other) = (ModelEnv::new(PAPER).unwrap(), ModelEnv::new(PAPER).unwrap());
    let (mut first, mut second) = (rng(4), rng(4));
    let s = one.reset(&mut first);
    assert_eq!(index(&s), other.reset_index(&mut second));
    for t in 0..1_000 {
        let s = one.step(t % 5, &mut first).state;
        assert_eq!(index(&s), other.step_index(t % 5, &mut second).state);
    }
    assert_eq!(PAPER.states(), one.states());
}
