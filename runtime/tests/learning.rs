//! Learning on the paper's grid at fixed seeds, judged by the exact solver.

mod world;

use tltl::augmented::{Augmented, Labelled, Reward, Rewards};
use tltl::compose::{Combine, Composition, Skill};
use tltl::env::ModelEnv;
use tltl::learn::{Learner, Settings};
use tltl::model::Dynamics;
use tltl::policy::{Policy, Training};
use tltl::product::Product;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
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
    Policy::new("avoid", "!c U a", &task, learner.q().policy(), names)
        .unwrap()
        .trained(Training::of(&learner), 5)
        .certified(certified(&task, &learner))
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
    assert!(refused("version", 2.into()).contains("version 2"));
    assert!(refused("class", vec![0; 79].into()).contains("79 entries, not 80"));
    assert!(refused("action", vec![5; 240].into()).contains("5 is not less than 5"));
    assert!(refused("states", 0.into()).contains("`states` is empty"));
    assert!(refused("extra", 0.into()).contains("unknown field"));
    let text = good.to_string();
    assert!(serde_json::from_str::<Policy>(&text[..text.len() / 2]).is_err());
}
