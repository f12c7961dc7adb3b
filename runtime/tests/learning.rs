//! Learning on the paper's grid at fixed seeds, judged by the exact solver.

mod world;

use tltl::augmented::{Augmented, Labelled, Reward, Rewards};
use tltl::compose::{Combine, Composition, Skill};
use tltl::controller::Hierarchy;
use tltl::env::ModelEnv;
use tltl::learn::{Learner, Settings};
use tltl::model::Dynamics;
use tltl::policy::{Policy, Training};
use tltl::product::Product;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::shield::Shield;
use tltl::solve::{Certificate, Problem};
use world::{A, B, C, GAMMA, PAPER, avoid, both, dynamics, eventually, on_paper};

fn trained(task: &Labelled, settings: Settings, seed: u64, steps: u64) -> Learner {
    let mut env = ModelEnv::new(PAPER).unwrap();
    let mut learner = Learner::new(task, 5, settings, seed);
    learner.train(&mut env, task, steps);
    assert_eq!(env.steps(), learner.steps());
    learner
}

fn certified(task: &Labelled, learner: &Learner) -> Certificate {
    let dynamics = dynamics();
    let problem = Problem::new(&dynamics, task);
    let exact = problem.optimal_q(&learner.settings().rewards, learner.settings().gamma);
    problem.certify(&learner.q().policy(), &exact)
}

#[test]
fn defaults_learn_within_one_percent() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    for task in [on_paper(&phi1), on_paper(&phi2), on_paper(&whole)] {
        for seed in 0..10 {
            let mut learner = trained(&task, Settings::default(), seed, 1_000_000);
            let online = certified(&task, &learner);
            assert!(online.regret_steps.unwrap() < 0.01, "{online:?}");
            assert!(online.worst_regret_satisfied < 1e-3, "from every start: {online:?}");
            learner.replay(&task).unwrap();
            let replayed = certified(&task, &learner);
            assert!(replayed.worst_regret_satisfied < 1e-3);
            assert!(replayed.regret_steps.unwrap() < 0.003, "{replayed:?}");
        }
    }
}

#[test]
fn the_papers_recipe_satisfies() {
    let task = on_paper(&both(A, B));
    let certificate = certified(&task, &trained(&task, Settings::paper(), 1, 340_000));
    assert!(certificate.satisfied > 0.9);
}

#[test]
fn slices_and_checkpoints_change_nothing() {
    let task = on_paper(&both(A, B));
    let settings = Settings {
        epsilon: tltl::learn::Schedule::Linear { from: 1.0, to: 0.1, steps: 5_000 },
        ..Settings::default()
    };
    let whole = trained(&task, settings, 7, 10_000);
    let part = trained(&task, settings, 7, 3_000);
    let text = serde_json::to_string(&part).unwrap();
    let mut resumed: Learner = serde_json::from_str(&text).unwrap();
    resumed.train(&mut ModelEnv::new(PAPER).unwrap(), &task, 10_000);
    assert!(resumed == whole, "a resumed learner went another way");
}

/// Two skills learned apart, composed from their experience alone.
#[test]
fn composition_of_learned_skills() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let (one, two, task) = (on_paper(&phi1), on_paper(&phi2), on_paper(&whole));
    let (first, second) = (
        trained(&one, Settings::default(), 1, 340_000),
        trained(&two, Settings::default(), 2, 340_000),
    );
    let mut experience = first.experience().clone();
    experience.extend(second.experience());
    let seen = Dynamics::new(&experience).unwrap();
    let skills = [Skill { q: first.q(), task: &one }, Skill { q: second.q(), task: &two }];
    let composition = Composition::new(&whole, &task, &skills);
    let start = composition.initial(Combine::NormalisedSum);
    let refined = composition.refined(&seen, &Rewards::default(), GAMMA, &start);
    let dynamics = dynamics();
    let problem = Problem::new(&dynamics, &task);
    let exact = problem.optimal_q(&Rewards::default(), GAMMA);
    let certificate = problem.certify(&refined.policy(), &exact);
    assert!(certificate.satisfied > 0.999);
    assert!(certificate.regret_steps.unwrap() < 0.01, "{certificate:?}");
}

#[test]
fn augmented_environment_pays_once() {
    let env = ModelEnv::new(PAPER).unwrap();
    let mut augmented = Augmented::new(env, both(A, B), Rewards::of(Reward::Progress), GAMMA);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let (first, mut q) = augmented.reset(&mut rng).unwrap();
    assert_eq!(q != 0, first == A || first == B);
    let (mut paid, mut moves) = (0.0, 0);
    for t in 0.. {
        let step = augmented.step(t % 5, &mut rng).unwrap();
        paid += step.reward;
        moves += usize::from(step.state.1 != q);
        q = step.state.1;
        if step.terminated {
            break;
        }
    }
    assert_eq!(paid, moves as f64);
}

fn policy() -> Policy {
    let task = on_paper(&avoid(C, A));
    let learner = trained(&task, Settings::default(), 5, 20_000);
    let names = (0..5).map(|a| tltl::model::FiniteModel::action_name(&PAPER, a)).collect();
    let dynamics = dynamics();
    let problem = Problem::new(&dynamics, &task);
    let starts = problem.starts(&learner.q().policy(), &problem.best());
    Policy::new("avoid", "!c U a", &task, learner.q().policy(), names)
        .unwrap()
        .trained(Training::of("avoid", &learner, 5))
        .certified(certified(&task, &learner))
        .from_starts(&starts)
}

#[test]
fn policies_survive_the_file() {
    let saved = policy();
    let text = serde_json::to_string(&saved).unwrap();
    assert_eq!(serde_json::from_str::<Policy>(&text).unwrap(), saved);
    let (a, c) = (2 * 8 + 2, 7 * 8 + 2);
    assert_eq!(saved.end(saved.reset(a)), Some(tltl::augmented::End::Accepted));
    assert_eq!(saved.end(saved.reset(c)), Some(tltl::augmented::End::Lost));
}

#[test]
fn foreign_and_broken_policies_are_refused() {
    let good = serde_json::to_value(policy()).unwrap();
    let refused = |field: &str, value: serde_json::Value| {
        let mut bad = good.clone();
        bad[field] = value;
        serde_json::from_value::<Policy>(bad).unwrap_err().to_string()
    };
    assert!(refused("format", "onnx".into()).contains("not a policy"));
    assert!(refused("version", 1.into()).contains("version 1; this library reads 2"));
    assert!(refused("class", vec![0; 79].into()).contains("79 entries, not 80"));
    assert!(refused("action", vec![5; 240].into()).contains("5 is not less than 5"));
    assert!(refused("states", 0.into()).contains("`states` is empty"));
    assert!(refused("extra", 0.into()).contains("unknown field"));
    let starts = |name: &str, value: serde_json::Value| {
        let mut starts = good["starts"].clone();
        starts[name] = value;
        refused("starts", starts)
    };
    assert!(starts("state", vec![80; 80].into()).contains("80 is not less than 80"));
    assert!(starts("state", vec![7; 80].into()).contains("the states must ascend"));
    assert!(starts("satisfied", vec![1.5; 80].into()).contains("`starts.satisfied`, entry 0"));
    assert!(starts("steps", vec![-1.0; 80].into()).contains("`starts.steps`, entry 0"));
    assert!(starts("steps", vec![1.0; 79].into()).contains("79 entries, not 80"));
    assert!(starts("median", vec![1.0; 80].into()).contains("unknown field"));
    let mut certificate = good["certificate"].clone();
    certificate["satisfied"] = 2.into();
    assert!(refused("certificate", certificate).contains("not a probability"));
    let text = good.to_string();
    assert!(serde_json::from_str::<Policy>(&text[..text.len() / 2]).is_err());
}

/// The certificates of a shield and of a hierarchy of controllers travel with the policy.
#[test]
fn certificates_travel() {
    let (formula, dynamics) = (avoid(C, A), dynamics());
    let task = on_paper(&formula);
    let problem = Problem::new(&dynamics, &task);
    let q = problem.optimal_q(&Rewards::of(Reward::Literal), GAMMA);
    let names = || (0..5).map(|a| tltl::model::FiniteModel::action_name(&PAPER, a)).collect();
    let survives = |policy: Policy| {
        let text = serde_json::to_string(&policy).unwrap();
        assert_eq!(serde_json::from_str::<Policy>(&text).unwrap(), policy);
        policy
    };

    let shield = Shield::of_model(&problem);
    let worth = problem.certify_shield(&shield, &q, &q);
    let policy = Policy::new("avoid", "!c U a", &task, shield.policy(&q), names()).unwrap();
    let policy = survives(policy.shielded(worth.clone()));
    assert_eq!(policy.document().certificate.as_ref(), Some(&worth.after));
    assert_eq!(policy.document().shield.as_ref(), Some(&worth));

    let index = |s: &world::Cell| (s.y * 8 + s.x) as usize;
    let mut hierarchy = Hierarchy::new(&formula, |_: &world::Cell| 4)
        .with(0, |s: &world::Cell| shield.greedy(&q, 0, index(s)) as usize);
    let cells = (0..80).map(|s| tltl::model::FiniteModel::state(&PAPER, s));
    let table = hierarchy.policy(cells);
    let certificate = problem.certify(&table, &q);
    assert_eq!(certificate, worth.after, "the controllers do what the shield says");
    let starts = problem.starts(&table, &problem.best());
    let policy = Policy::new("avoid", "!c U a", &task, table, names()).unwrap();
    let policy = survives(policy.certified(certificate).from_starts(&starts));
    let saved = policy.document().starts.as_ref().unwrap();
    assert_eq!((saved.state.len(), saved.satisfied[58]), (80, 0.0), "c, a lost start");
    assert!(saved.steps[58].is_none() && saved.steps[18] == Some(0.0));
}
