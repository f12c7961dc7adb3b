//! Learning on the paper's grid at fixed seeds, judged by the exact solver.

mod world;

use std::num::NonZero;

use tltl::augmented::Augmented;
use tltl::compose::Operator;
use tltl::controller::Hierarchy;
use tltl::learn::{Checkpoint, Memory, Schedule, seeds, seeds_on};
use tltl::prelude::*;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::reward::{End, Mode};
use tltl::shield::Shield;
use tltl::solve::Certificate;
use world::{A, B, C, Cell, PAPER, avoid, both, eventually, on_paper, problem, thrice};

fn trained(task: &Labelled, settings: Settings, seed: u64, steps: u64) -> Learner {
    let mut env = ModelEnv::new(PAPER).unwrap();
    let mut learner = Learner::new(task, settings, seed);
    learner.train(&mut env, steps).unwrap();
    assert_eq!(env.steps(), learner.steps());
    learner
}

fn certified(learner: &Learner) -> Certificate {
    learner.certify(&problem(learner.task())).unwrap()
}

#[test]
fn defaults_learn_within_one_percent() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    for task in [on_paper(&phi1), on_paper(&phi2), on_paper(&whole)] {
        for seed in 0..10 {
            let worth = certified(&trained(&task, Settings::default(), seed, 1_000_000));
            assert!(worth.worst_regret_satisfied < 1e-9, "from every start: {worth:?}");
            assert!(worth.regret_steps.unwrap() < 0.003, "{worth:?}");
        }
    }
}

/// Where the automaton has a way back, moves are paid again and again by `Progress`: its optimum goes to
/// and fro, and satisfies the task only by slipping.
#[test]
fn ways_back_are_not_taken_for_their_own_sake() {
    let task = on_paper(&thrice(A));
    let progress = problem(&task).optimum(&Rewards::progress());
    let misled = progress.certify(&progress.q().policy()).unwrap();
    assert!(misled.regret_steps.unwrap() > 100.0, "{misled:?}");
    for seed in 0..5 {
        let worth = certified(&trained(&task, Settings::default(), seed, 1_000_000));
        assert!(worth.regret_satisfied < 1e-9, "{worth:?}");
        assert!(worth.regret_steps.unwrap() < 0.01, "{worth:?}");
    }
}

/// What may be lost: the largest P first, up to a tolerance that only fewer steps are worth.
#[test]
fn defaults_keep_out_of_the_trap() {
    let task = on_paper(&avoid(C, A));
    for seed in 0..5 {
        let worth = certified(&trained(&task, Settings::default(), seed, 6_000_000));
        assert!(worth.regret_satisfied < 1e-3, "{worth:?}");
        assert!(worth.regret_steps.unwrap() < 0.01, "{worth:?}");
    }
}

/// To ask for what was learned changes nothing: twice gives the same, and training goes on alike.
#[test]
fn asking_changes_nothing() {
    let task = on_paper(&avoid(C, A));
    let mut asked = trained(&task, Settings::default(), 3, 5_000);
    let before = asked.clone();
    assert_eq!(asked.q(), asked.q());
    assert_eq!(asked.policy(), asked.policy());
    assert_eq!(asked.policy().trained(asked.training()).training().len(), 2);
    assert!(asked == before);
    asked.train(&mut ModelEnv::new(PAPER).unwrap(), 20_000).unwrap();
    assert!(asked == trained(&task, Settings::default(), 3, 20_000));
}

/// The rewards of the settings are what is optimised; where they pay acceptance alone, whatever γ is.
#[test]
fn what_is_paid_is_finished() {
    let task = on_paper(&both(A, B));
    let learn = |rewards| trained(&task, Settings::default().with_rewards(rewards), 1, 100_000);
    let impatient = Rewards::acceptance().with_gamma(0.5).unwrap();
    let shaped = Rewards::of(Mode::Shaped);
    let learner = learn(Rewards::acceptance());
    for rewards in [impatient, shaped] {
        assert_eq!(learn(rewards).q(), learner.q(), "γ matters only while learning");
    }
    let seen = Problem::new(&Dynamics::new(learner.experience()).unwrap(), &task).unwrap();
    for rewards in [Rewards::progress(), impatient.with_step_penalty(0.1).unwrap()] {
        assert_eq!(learn(rewards).q(), seen.optimal_q(&rewards));
    }
    // Without experience the table is all there is; with it, no value guides an action, and none is learned.
    let settings = Settings::default().with_memory(Memory::None);
    let forgetful = trained(&task, settings, 1, 100_000);
    assert_eq!(&forgetful.q(), forgetful.table());
    assert!(forgetful.table().max(0, 0) > 0.5 && *learner.table() == QTable::zeros(&task));
    assert_eq!(Learner::new(&task, Settings::default(), 1).q(), QTable::zeros(&task));
}

/// The bits of the sum of the values that the paper's recipe learns below.
const PAPERS_SUM: u64 = 0x4070_9012_81a8_555c;

/// The paper's recipe says all that it is: no default changes it.
#[test]
fn the_papers_recipe_is_the_papers() {
    let task = on_paper(&both(A, B));
    let learner = trained(&task, Settings::paper(), 1, 50_000);
    let sum: f64 = learner.q().values().iter().sum();
    assert_eq!(sum.to_bits(), PAPERS_SUM, "{sum} is not what it was");
}

#[test]
fn the_papers_recipe_satisfies() {
    let task = on_paper(&both(A, B));
    let certificate = certified(&trained(&task, Settings::paper(), 1, 340_000));
    assert!(certificate.satisfied > 0.9);
}

#[test]
fn slices_and_checkpoints_change_nothing() {
    let task = on_paper(&both(A, B));
    let epsilon = Schedule::linear(1.0, 0.1, 5_000).unwrap();
    let settings = Settings::default().with_epsilon(epsilon).unwrap();
    let whole = trained(&task, settings, 7, 10_000);
    let part = trained(&task, settings, 7, 3_000);
    let text = serde_json::to_string(&part.checkpoint()).unwrap();
    let mut resumed = Learner::resume(&task, serde_json::from_str(&text).unwrap()).unwrap();
    resumed.train(&mut ModelEnv::new(PAPER).unwrap(), 10_000).unwrap();
    assert!(resumed == whole, "a resumed learner went another way");
}

/// A long call turns the table for its time, so that what is read together stands together; calls of fewer
/// steps than there are states do not.
#[test]
fn how_a_table_is_stored_changes_nothing() {
    let task = on_paper(&Product::conjunction(&[&both(A, B), &eventually(C)]));
    let greedy = Settings::default().with_epsilon(Schedule::constant(0.5).unwrap()).unwrap();
    let whole = trained(&task, greedy, 7, 5_000);
    let known = whole.table().values().iter().filter(|value| **value > 0.0).count();
    assert!(known > 100, "values are learned where actions are chosen for them: {known}");
    let (mut env, mut slices) = (ModelEnv::new(PAPER).unwrap(), Learner::new(&task, greedy, 7));
    while slices.steps() < 5_000 {
        slices.train(&mut env, 5_000.min(slices.steps() + 50)).unwrap();
    }
    assert!(slices == whole, "slices went another way");
}

/// Seeds are learned by as many threads as there are; what each finds depends on the seed alone.
#[test]
fn threads_change_nothing() {
    let task = on_paper(&both(A, B));
    let settings = [Settings::default(), Settings::paper()];
    let learn = |seed| settings.map(|settings| trained(&task, settings, seed, 3_000));
    let alone: Vec<_> = (3..14).map(learn).collect();
    assert!(alone[0] != alone[1], "seeds differ");
    for threads in [1, 2, 3, 8, 40] {
        let found = seeds_on(NonZero::new(threads).unwrap(), 3..14, learn);
        assert!(found == alone, "{threads} threads found something else");
    }
    assert!(seeds(3..14, learn) == alone);
    assert!(seeds(3..3, learn).is_empty());
}

/// What belongs to another task or another world is refused, and both are named.
#[test]
fn other_tasks_and_worlds_are_refused() {
    let (task, other) = (on_paper(&both(A, B)), on_paper(&avoid(C, A)));
    let learner = trained(&task, Settings::default(), 1, 1_000);
    let own = "`both` (4 automaton states, 80 states, 5 actions)";
    let foreign = "`avoid` (3 automaton states, 80 states, 5 actions)";
    let refused = format!(" of {own} does not fit {foreign}");
    let error = learner.certify(&problem(&other)).unwrap_err();
    assert_eq!(error.to_string(), format!("a policy{refused}"));
    assert_eq!((error.found(), error.expected()), (own, foreign));
    let error = Learner::resume(&other, learner.checkpoint()).unwrap_err();
    assert_eq!(error.to_string(), format!("a checkpoint{refused}"));
    let shield = Shield::safest(&problem(&other), 0.0).unwrap();
    let error = shield.policy(&learner.q()).unwrap_err();
    assert_eq!(error.to_string(), format!("a table{refused}"));

    // The same task elsewhere: names and sizes agree.
    let moved = on_paper(&both(A, C));
    let error = problem(&moved).evaluate(&learner.policy()).unwrap_err().to_string();
    let expected =
        format!("a policy of {own} does not fit {own}: the automata move differently on");
    assert!(error.starts_with(&expected), "{error}");
    let error = Learner::resume(&moved, learner.checkpoint()).unwrap_err().to_string();
    assert!(error.contains("move differently"), "{error}");

    let small = world::Grid { width: 4, height: 4 };
    let error = learner.clone().train(&mut ModelEnv::new(&small).unwrap(), 2_000).unwrap_err();
    let world = "a world of 16 states and 5 actions";
    assert_eq!(error.to_string(), format!("an environment of {world} does not fit {own}"));
    let error = Problem::new(&Dynamics::new(&small).unwrap(), &task).unwrap_err();
    assert_eq!(error.to_string(), format!("dynamics of {world} does not fit {own}"));
    assert!(Policy::new(&task, [0; 319]).unwrap_err().to_string().contains("319 entries, not 320"));
    assert!(Policy::from_fn(&task, |_, _| 5).unwrap_err().to_string().contains("not less than 5"));
}

/// Files of earlier versions do not say of which task they are; sizes that do not fit are refused.
#[test]
fn earlier_checkpoints_are_read() {
    let task = on_paper(&both(A, B));
    let learner = trained(&task, Settings::default(), 7, 1_000);
    let mut saved = serde_json::to_value(learner.checkpoint()).unwrap();
    saved.as_object_mut().unwrap().remove("task").unwrap();
    let read = || serde_json::from_value::<Checkpoint>(saved.clone()).unwrap();
    assert!(Learner::resume(&task, read()).unwrap() == learner);
    let error = Learner::resume(&on_paper(&avoid(C, A)), read()).unwrap_err().to_string();
    assert!(error.starts_with("a checkpoint of a task (4 automaton states, 80 states"), "{error}");
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
    experience.extend(second.experience()).unwrap();
    let seen = Dynamics::new(&experience).unwrap();
    let skills = [first.q(), second.q()];
    let composition = Composition::new(&whole, &task, &skills.each_ref(), first.rewards()).unwrap();
    let start = composition.initial(Combine::NormalisedSum);
    let refined = composition.refined(&seen, &start).unwrap();
    let certificate = problem(&task).optimum(&first.rewards()).certify(&refined.policy()).unwrap();
    assert!(certificate.satisfied > 0.999);
    assert!(certificate.regret_steps.unwrap() < 0.01, "{certificate:?}");
}

/// Skills that can be lost, composed from what was seen: P is known up to sampling, and to follow its last
/// digit takes ways that are longer for nothing.
#[test]
fn composition_of_learned_skills_keeps_out_of_the_trap() {
    let (phi1, phi2) = (avoid(C, A), avoid(C, B));
    let (one, two) = (on_paper(&phi1), on_paper(&phi2));
    let worth = seeds(0..10, |seed| {
        let skills = [(&one, seed), (&two, seed + 100)]
            .map(|(task, seed)| trained(task, Settings::default(), seed, 3_000_000));
        let mut seen = skills[0].experience().clone();
        seen.extend(skills[1].experience()).unwrap();
        let (seen, rewards) = (Dynamics::new(&seen).unwrap(), skills[0].rewards());
        let q = skills.each_ref().map(Learner::q);
        let composition =
            Composition::of(Operator::Conjunction, &q.each_ref(), rewards, 100).unwrap();
        let optimum = problem(composition.task()).optimum(&rewards);
        let refined = composition.refined(&seen, &composition.initial(Combine::Sum)).unwrap();
        let steps = composition.run_on_seen(&seen, Combine::Sum).unwrap();
        assert_eq!(steps.policy(), &refined.policy());
        let literal = composition.run(&seen, Combine::Sum).unwrap();
        [steps, literal].map(|steps| optimum.certify(steps.policy()).unwrap())
    });
    let worst = |i: usize| {
        let regrets = worth.iter().map(|worth| &worth[i]);
        regrets.fold([0.0_f64; 2], |[p, steps], worth| {
            [p.max(worth.regret_satisfied), steps.max(worth.regret_steps.unwrap())]
        })
    };
    let [[p, steps], literal] = [worst(0), worst(1)];
    assert!(p < 1e-3 && steps < 1e-2, "{p} {steps}, to the last digit {literal:?}");
    assert!(literal[1] > 1e-2, "to the last digit {literal:?}");
}

#[test]
fn augmented_environment_pays_once() {
    let env = ModelEnv::new(PAPER).unwrap();
    let mut augmented = Augmented::new(env, both(A, B), Rewards::progress());
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
    let optimum = problem(&task).optimum(&learner.rewards());
    let starts = optimum.starts(&learner.policy()).unwrap();
    learner.policy().certified(certified(&learner)).from_starts(&starts)
}

#[test]
fn policies_survive_the_file() {
    let saved = policy();
    let text = serde_json::to_string(&saved).unwrap();
    assert_eq!(serde_json::from_str::<Policy>(&text).unwrap(), saved);
    let (a, c) = (2 * 8 + 2, 7 * 8 + 2);
    assert_eq!(saved.end(saved.reset(a)), Some(End::Accepted));
    assert_eq!(saved.end(saved.reset(c)), Some(End::Lost));
    // A policy that was read is one for the task, as it was before.
    let read: Policy = serde_json::from_str(&text).unwrap();
    assert!(problem(&on_paper(&avoid(C, A))).evaluate(&read).is_ok());
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
    let formula = avoid(C, A);
    let task = on_paper(&formula);
    let optimum = problem(&task).optimum(&Rewards::of(Mode::Literal));
    let q = optimum.q();
    let survives = |policy: Policy| {
        let text = serde_json::to_string(&policy).unwrap();
        assert_eq!(serde_json::from_str::<Policy>(&text).unwrap(), policy);
        policy
    };

    let shield = Shield::safest(optimum.problem(), 0.0).unwrap();
    let worth = optimum.certify_shield(&shield, q).unwrap();
    let policy = survives(shield.policy(q).unwrap().shielded(worth.clone()));
    assert_eq!(policy.certificate(), Some(&worth.after));
    assert_eq!(policy.shield(), Some(&worth));

    let index = |s: &Cell| (s.y * 8 + s.x) as usize;
    let mut hierarchy =
        Hierarchy::new(&formula, |_: &Cell| 4).with(0, |s: &Cell| shield.greedy(q, 0, index(s)));
    let policy = hierarchy.policy(&task, (0..80).map(|s| PAPER.state(s))).unwrap();
    let certificate = optimum.certify(&policy).unwrap();
    assert_eq!(certificate, worth.after, "the controllers do what the shield says");
    let starts = optimum.starts(&policy).unwrap();
    let policy = survives(policy.certified(certificate).from_starts(&starts));
    let saved = policy.starts().unwrap();
    assert_eq!((saved.state.len(), saved.satisfied[58]), (80, 0.0), "c, a lost start");
    assert!(saved.steps[58].is_none() && saved.steps[18] == Some(0.0));
}
