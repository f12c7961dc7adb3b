//! What policies are worth, what guards them, and what outlives a process.

mod world;

use std::fs;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use tltl::checkpoint;
use tltl::controller::Hierarchy;
use tltl::estimate::{Estimate, Interval, Tally, Trials, estimate, estimate_until};
use tltl::learn::{Observation, TerminalReward, TrajectoryLearner, seeds};
use tltl::prelude::*;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::{End, Mode};
use tltl::shield::Shield;
use tltl::solve::{Basis, Certificate};
use world::{A, B, C, Cell, PAPER, avoid, both, dynamics, eventually, on_paper, problem};

fn rng(seed: u64) -> Xoshiro256PlusPlus {
    Xoshiro256PlusPlus::seed_from_u64(seed)
}

fn index(s: &Cell) -> usize {
    (s.y * 8 + s.x) as usize
}

#[test]
fn estimates_hold_the_exact_value() {
    let task = avoid(C, A);
    let problem = problem(&on_paper(&task));
    let policy = problem.optimal_q(&Rewards::of(Mode::Literal)).policy();
    let own = problem.evaluate(&policy).unwrap();
    let (p, steps) = (own.mean_satisfied(), own.mean_steps().unwrap());
    let trials = Trials::default().with_episodes(20_000).unwrap().with_confidence(0.999).unwrap();
    let act = |q, s: &Cell| Ok::<_, tltl::task::Error>(policy.act(q, index(s)));
    let mut env = ModelEnv::new(PAPER).unwrap();
    let seen = estimate(&mut env, &task, trials, &mut rng(1), act).unwrap();
    let holds = |interval: Interval, value: f64| interval.low < value && value < interval.high;
    assert!(holds(seen.satisfied, p) && holds(seen.steps.unwrap(), steps), "{seen:?}");
    assert!(holds(seen.lost, 1.0 - p), "what is not satisfied is lost here: {seen:?}");
    // Stopped by what is seen: sooner, and it holds still.
    let enough = |tally: &Tally| {
        tally.episodes().is_multiple_of(100) && tally.anytime().satisfied.low > p - 0.05
    };
    let seen = estimate_until(&mut env, &task, trials, &mut rng(2), act, enough).unwrap();
    assert!(seen.episodes < 10_000 && seen.basis == Basis::Anytime, "{seen:?}");
    assert!(holds(seen.satisfied, p) && holds(seen.steps.unwrap(), steps), "{seen:?}");
}

/// Before there were kinds of estimates their intervals were approximate ones.
#[test]
fn estimates_of_yesterday_load() {
    let text = r#"{
        "episodes": 1000, "horizon": 200, "confidence": 0.95,
        "satisfied": {"mean": 0.98, "low": 0.97, "high": 0.99},
        "lost": {"mean": 0.0, "low": 0.0, "high": 0.004},
        "steps": {"mean": 21.5, "low": 20.25, "high": 22.75}
    }"#;
    let old: Estimate = serde_json::from_str(text).unwrap();
    assert_eq!(old.basis, Basis::Approximate);
    assert_eq!(
        old.to_string(),
        "                           this policy     95 % interval\n\
         P(satisfied in 200 steps)        0.980    0.970 to 0.990\n\
         P(lost in 200 steps)            0.0000  0.0000 to 0.0040\n\
         E[steps | satisfied]              21.5      20.2 to 22.8\n\
         Estimated from 1000 episodes; the intervals are approximate."
    );
}

/// An episode in which no action can be chosen ends without a step.
#[test]
fn what_cannot_act_takes_no_step() {
    let mut env = ModelEnv::new(PAPER).unwrap();
    let error = tltl::task::Error { predicate: "p".into(), instant: None };
    let result = estimate(&mut env, &next_to_nothing(), Trials::default(), &mut rng(1), |_, _| {
        Err::<usize, _>(error.clone())
    });
    assert_eq!((result.unwrap_err(), env.steps()), (error, 0));
}

/// A task that is not satisfied at any start.
fn next_to_nothing() -> impl Monitor<Cell> {
    eventually(Cell { x: 99, y: 99 })
}

#[test]
fn certificates_name_starts_and_mistakes() {
    let task = on_paper(&both(A, B));
    let optimum = problem(&task).optimum(&Rewards::default());
    let right = optimum.q().policy();
    assert!(optimum.mistakes(&right).unwrap().is_empty());
    let stays = |q, s| if (q, s) == (0, 0) { 4 } else { right.act(q, s) };
    let policy = Policy::from_fn(&task, stays).unwrap();
    let mistakes = optimum.mistakes(&policy).unwrap();
    assert_eq!(mistakes.len(), 1);
    assert_eq!((mistakes[0].q, mistakes[0].state, mistakes[0].action), (0, 0, 4));
    let starts = optimum.starts(&policy).unwrap();
    assert_eq!(starts.len(), 80);
    let corner = starts[0];
    assert!(corner.steps.unwrap() > corner.optimal_steps.unwrap() + 1.0, "{corner:?}");
}

/// Of two starts of ten that lose P(satisfied) one loses all, and the others lose steps.
#[test]
fn reports_have_the_worst_starts_first() {
    let task = on_paper(&avoid(C, A));
    let optimum = problem(&task).optimum(&Rewards::default());
    let literal = problem(&task).optimal_q(&Rewards::of(Mode::Literal)).policy();
    let report = optimum.report_within(&literal, 30).unwrap();
    assert_eq!(report.certificate.within, optimum.certify_within(&literal, 30).unwrap().within);
    assert_eq!(report.certificate.satisfied, optimum.certify(&literal).unwrap().satisfied);
    let losses: Vec<_> = report.starts.iter().map(|start| start.losses().0).collect();
    assert!(losses.is_sorted_by(|a, b| *a > b - 1e-9) && losses[0] > 0.5, "{losses:?}");
    // A document has them in the order of the states.
    let saved = serde_json::to_string(&literal.from_starts(&report.starts)).unwrap();
    let loaded: Policy = serde_json::from_str(&saved).unwrap();
    assert!(loaded.starts().unwrap().state.is_sorted());
    let text = report.to_string();
    assert!(text.contains("P(satisfied in 30 steps)"), "{text}");
    assert_eq!(text.lines().filter(|line| line.starts_with("state ")).count(), 5, "{text}");
    assert!(
        text.ends_with("78 of 80 starts lose something: at most 0.999978 of P(satisfied)."),
        "{text}"
    );
    // Where nothing is lost but steps, by how many.
    let task = on_paper(&both(A, B));
    let optimum = problem(&task).optimum(&Rewards::default());
    let best = optimum.best().policy();
    let lazy = |q, s| if (q, s) == (0, 0) { 4 } else { best.act(q, s) };
    let report = optimum.report(&Policy::from_fn(&task, lazy).unwrap()).unwrap();
    let lost = report.starts.iter().filter(|start| start.optimal_steps > Some(0.0));
    let part = lost.map(|start| start.steps.unwrap() / start.optimal_steps.unwrap() - 1.0);
    let end = format!("at most {:.2} % of the steps.", 100.0 * part.fold(0.0, f64::max));
    assert!(report.to_string().ends_with(&end), "{report}{end}");
}

/// A regret below what is shown is not shown as none, and what never succeeds has no steps.
#[test]
fn certificates_print_what_is_small_and_what_is_not_there() {
    let task = on_paper(&both(A, B));
    let optimum = problem(&task).optimum(&Rewards::default());
    let worth = optimum.certify(optimum.best().policy()).unwrap();
    let close = Certificate { satisfied: 1.0 - 2e-8, regret_satisfied: 2e-8, ..worth.clone() };
    let line = |text: &str, i: usize| text.lines().nth(i).unwrap().to_owned();
    let ends = |certificate: &Certificate, i, end: &str| {
        let line = line(&certificate.to_string(), i);
        assert!(line.ends_with(end), "{line}");
    };
    ends(&close, 1, "1.000000       1.000000    2e-8");
    ends(&worth, 1, "1.000000       1.000000       0");
    ends(&worth, 2, "12.2002        12.2002     0 %");
    let slow = Certificate { regret_steps: Some(1.25), ..worth };
    ends(&slow, 2, "12.2002  125.00 %");
    let nowhere = on_paper(&eventually(Cell { x: 99, y: 99 }));
    let optimum = problem(&nowhere).optimum(&Rewards::default());
    let never = optimum.certify(optimum.best().policy()).unwrap();
    ends(&never, 2, "E[steps | satisfied]            -              -       -");
}

#[test]
fn shields_keep_out_of_the_trap() {
    let task = on_paper(&avoid(C, A));
    let optimum = problem(&task).optimum(&Rewards::of(Mode::Literal));
    let shield = Shield::safest(optimum.problem(), 0.0).unwrap();
    let worth = optimum.certify_shield(&shield, optimum.q()).unwrap();
    assert!(worth.lost_before > 0.4 && worth.overruled > 0.0, "{worth:?}");
    assert!((worth.lost_after - worth.smallest_lost).abs() < 1e-6, "{worth:?}");
    // Without a model: the step into the trap itself.
    let mut learner = Learner::new(&task, Settings::default(), 1);
    learner.train(&mut ModelEnv::new(PAPER).unwrap(), 200_000).unwrap();
    let mut shield = Shield::one_step(&task);
    shield.extend(learner.experience()).unwrap();
    let (beside, up) = (index(&C) - 8, 0);
    assert!(!shield.allows(0, beside, up) && shield.allows(0, 0, up));
}

#[test]
fn the_automaton_chooses_the_controller() {
    let task = both(A, B);
    let best = problem(&on_paper(&task)).best();
    let sub = |q: u32| {
        let layer: Vec<usize> = best.policy().sub_policy(q).collect();
        move |s: &Cell| layer[index(s)]
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
    let (formula, task) = (eventually(A), on_paper(&eventually(A)));
    let mut env = ModelEnv::new(PAPER).unwrap();
    let settings = Settings::paper().with_rewards(Rewards::progress().with_bound(10.0).unwrap());
    let (paid, sees) = (TerminalReward::Robustness, Observation::WorldAndAutomaton);
    let mut learner = TrajectoryLearner::new(&task, settings, paid, sees, 1);
    learner.train(&mut env, &formula, 300_000).unwrap();
    let own = problem(&task).evaluate(&learner.policy()).unwrap();
    let (p, steps) = (own.mean_satisfied(), own.mean_steps().unwrap());
    assert!(p > 0.9 && steps < 30.0, "one goal can be learned even so: {p}, {steps}");
}

/// Penalties make no difference where they cannot be earned, and keep out of the trap where they can.
#[test]
fn penalties_are_paid() {
    let problem = problem(&on_paper(&avoid(C, A)));
    let p_of = |rewards: Rewards| {
        let policy = problem.optimal_q(&rewards).policy();
        problem.evaluate(&policy).unwrap().mean_satisfied()
    };
    let progress = Rewards::progress();
    let punished = p_of(progress.with_trap_penalty(10.0).unwrap());
    assert!(punished > p_of(progress), "a penalty for the trap makes safer");
    let value = |rewards: Rewards| problem.optimal_q(&rewards).max(0, 0);
    let stepped = value(progress.with_step_penalty(0.01).unwrap());
    let free = value(progress);
    assert!(stepped < free && free - stepped < 0.01 / (1.0 - progress.gamma()));
}

#[test]
fn the_default_reward_is_safe() {
    let optimum = problem(&on_paper(&avoid(C, A))).optimum(&Rewards::default());
    let certificate = optimum.certify(&optimum.q().policy()).unwrap();
    assert!(certificate.regret_satisfied < 1e-5, "{certificate:?}");
}

/// 6 million steps with default settings: fresh seeds, other layouts.
#[test]
fn defaults_learn_within_a_thousandth() {
    let corners = (Cell { x: 0, y: 0 }, Cell { x: 7, y: 9 });
    for (a, b) in [(A, B), corners] {
        let task = on_paper(&both(a, b));
        let problem = problem(&task);
        let steps = |policy| problem.evaluate(&policy).unwrap().mean_steps().unwrap();
        let optimum = problem.best().mean_steps().unwrap();
        let excess = seeds(100..102, |seed| {
            let mut learner = Learner::new(&task, Settings::default(), seed);
            learner.train(&mut ModelEnv::new(PAPER).unwrap(), 6_000_000).unwrap();
            steps(learner.policy()) / optimum - 1.0
        });
        assert!(excess.iter().all(|&excess| excess < 1e-3), "{excess:?}");
    }
}

/// Learned skills, 340,000 steps each, composed from their experience: fresh seeds.
#[test]
fn composition_of_learned_skills_on_fresh_seeds() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let (one, two, task) = (on_paper(&phi1), on_paper(&phi2), on_paper(&whole));
    let problem = problem(&task);
    let worst = seeds(200..220, |seed| {
        let mut env = ModelEnv::new(PAPER).unwrap();
        let mut learn = |task: &Labelled, seed| {
            let mut learner = Learner::new(task, Settings::default(), seed);
            learner.train(&mut env, 340_000).unwrap();
            learner
        };
        let (first, second) = (learn(&one, seed), learn(&two, seed + 1_000));
        let taken = env.steps();
        let mut experience = first.experience().clone();
        experience.extend(second.experience()).unwrap();
        let seen = Dynamics::new(&experience).unwrap();
        let skills = [first.q(), second.q()];
        let composition =
            Composition::new(&whole, &task, &skills.each_ref(), first.rewards()).unwrap();
        let start = composition.initial(Combine::NormalisedSum);
        let refined = composition.refined(&seen, &start).unwrap();
        assert_eq!(env.steps(), taken, "a composition takes no step in the world");
        let own = problem.evaluate(&refined.policy()).unwrap();
        let (p, steps) = (own.mean_satisfied(), own.mean_steps().unwrap());
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
    let (dynamics, rewards) = (dynamics(), Rewards::progress());
    let solved = |task: &Labelled| problem(task).optimal_q(&rewards);
    let (q1, q2) = (solved(&on_paper(&phi1)), solved(&on_paper(&phi2)));
    for product in &products {
        let task = on_paper(product);
        let composition = Composition::new(product, &task, &[&q1, &q2], rewards).unwrap();
        let start = composition.compensated(&dynamics).unwrap();
        let refined = composition.refined(&dynamics, &start).unwrap();
        for (a, b) in refined.values().iter().zip(solved(&task).values()) {
            assert!((a - b).abs() < 1e-8);
        }
    }
    // Two of the same task are no skills for these two.
    let task = on_paper(&products[0]);
    let error = Composition::new(&products[0], &task, &[&q1, &q1], rewards).unwrap_err();
    assert_eq!(
        error.to_string(),
        "a skill of `avoid` (3 automaton states, 80 states, 5 actions) does not fit `eventually` \
         (2 automaton states)"
    );
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
    let mut learner = match checkpoint::read(path, "learner").unwrap() {
        Some(content) => Learner::resume(&task, serde_json::from_slice(&content).unwrap()).unwrap(),
        None => Learner::new(&task, Settings::default(), 7),
    };
    let mut env = ModelEnv::new(PAPER).unwrap();
    while learner.steps() < TOTAL {
        learner.train(&mut env, (learner.steps() + SLICE).min(TOTAL)).unwrap();
        let content = serde_json::to_vec(&learner.checkpoint()).unwrap();
        checkpoint::write(path, "learner", &content).unwrap();
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
    let task = on_paper(&both(A, B));
    let left = Learner::resume(&task, serde_json::from_slice(&left).unwrap()).unwrap();
    assert!(left.steps() >= SLICE);
    let mut whole = Learner::new(&task, Settings::default(), 7);
    whole.train(&mut ModelEnv::new(PAPER).unwrap(), TOTAL).unwrap();
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
