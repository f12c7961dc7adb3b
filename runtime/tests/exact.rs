//! Exact facts about the paper's grid: solver, product, composition.

mod world;

use tltl::prelude::*;
use tltl::product::{Operand, Operator};
use tltl::reward::Mode;
use world::{A, B, C, Cell, PAPER, avoid, both, dynamics, eventually, next, on_paper, problem};

/// The paper's reward, γ 0.95.
const PROGRESS: Rewards = Rewards::progress();

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() < tolerance, "{value} is not {expected}");
}

fn value_and_steps(task: &Labelled) -> (f64, f64, f64) {
    let optimum = problem(task).optimum(&PROGRESS);
    let best = optimum.best();
    let value = optimum.q().max(task.start(0), 0);
    (value, best.mean_satisfied(), best.mean_steps().unwrap())
}

#[test]
fn optimal_values_and_steps() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let rows = [
        (on_paper(&phi1), 1.375700084, 12.2002),
        (on_paper(&phi2), 0.603321600, 6.7933),
        (on_paper(&whole), 1.832763429, 16.7111),
    ];
    for (labelled, value, steps) in &rows {
        let (v, p, e) = value_and_steps(labelled);
        near(v, *value, 1e-9);
        near(p, 1.0, 1e-9);
        near(e, *steps, 5e-5);
    }
}

#[test]
fn product_sizes() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    assert_eq!(whole.states(), 8);
    assert_eq!((whole.size().edges, whole.size().self_loops), (19, 8));
    // A trap adds edges into it, and no others.
    let trapped = Product::conjunction(&[&avoid(C, A), &eventually(B)]).size();
    let safe = Product::conjunction(&[&eventually(A), &eventually(B)]).size();
    assert_eq!((trapped.edges - trapped.into_trap, trapped.trap), (safe.edges, true));
    assert_eq!((safe.into_trap, safe.trap), (0, false));
}

#[test]
fn reward_modes_with_a_trap() {
    let problem = problem(&on_paper(&avoid(C, A)));
    let p_of = |mode| {
        let policy = problem.optimal_q(&Rewards::of(mode)).policy();
        100.0 * problem.evaluate(&policy).unwrap().mean_satisfied()
    };
    near(100.0 * problem.best().mean_satisfied(), 98.49, 5e-3);
    near(p_of(Mode::Progress), 98.13, 5e-3);
    near(p_of(Mode::Literal), 50.0, 5e-2);
    near(p_of(Mode::Acceptance), p_of(Mode::Shaped), 1e-9);
}

#[test]
fn evaluation_agrees_with_the_optimum() {
    let tasks: [&dyn Monitor<_>; 3] = [&both(A, B), &avoid(C, A), &next(A, A)];
    for task in tasks {
        let task = on_paper(task);
        let problem = problem(&task);
        let best = problem.best();
        let own = problem.evaluate(best.policy()).unwrap();
        for (q, s) in (0..task.automaton_states()).flat_map(|q| (0..80).map(move |s| (q, s))) {
            near(own.satisfied().at(q, s), best.satisfied().at(q, s), 1e-8);
            match (own.steps(q, s), best.steps(q, s)) {
                (Some(own), Some(best)) => near(own, best, 1e-6),
                ends => assert_eq!(ends, (None, None), "at ({q}, {s})"),
            }
        }
    }
}

#[test]
fn a_policy_that_never_arrives() {
    let task = on_paper(&eventually(C));
    // Staying drifts by slips alone: slow, but it arrives; sweeps alone would take thousands.
    let staying = Policy::from_fn(&task, |_, _| 4).unwrap();
    let own = problem(&task).evaluate(&staying).unwrap();
    near(own.mean_satisfied(), 1.0, 1e-9);
    assert!(own.mean_steps().unwrap() > 500.0, "{:?}", own.mean_steps());
}

/// Values and product of φ₁ = ◇a ∧ ◇b and φ₂ = ◇c composed.
#[test]
fn composition_of_exact_skills() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let (one, two, task) = (on_paper(&phi1), on_paper(&phi2), on_paper(&whole));
    let dynamics = dynamics();
    let [q1, q2] = [&one, &two].map(|task| problem(task).optimal_q(&PROGRESS));
    let optimum = problem(&task).optimum(&PROGRESS);
    let composition = Composition::new(&whole, &task, &[&q1, &q2], PROGRESS).unwrap();

    let sum = composition.initial(Combine::NormalisedSum);
    let fraction = optimum.fraction_optimal(&sum.policy()).unwrap();
    near(100.0 * fraction, 91.96, 5e-3);
    let pending: Vec<u32> = task
        .live()
        .filter(|&q| whole.components(q)[0] != 3 && whole.components(q)[1] == 0)
        .collect();
    assert_eq!(pending.len(), 3);
    let fraction = optimum.fraction_optimal_at(pending, &sum.policy()).unwrap();
    near(100.0 * fraction, 81.25, 1e-9);

    let start = composition.compensated(&dynamics).unwrap();
    let refined = composition.refined(&dynamics, &start).unwrap();
    same(&refined, optimum.q());
    near(optimum.fraction_optimal(&refined.policy()).unwrap(), 1.0, 1e-12);
}

#[test]
fn composition_with_a_trap() {
    let (phi1, phi2) = (avoid(C, A), both(B, C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let (one, two, task) = (on_paper(&phi1), on_paper(&phi2), on_paper(&whole));
    let dynamics = dynamics();
    let [q1, q2] = [&one, &two].map(|task| problem(task).optimal_q(&PROGRESS));
    let optimum = problem(&task).optimum(&PROGRESS);
    let composition = Composition::new(&whole, &task, &[&q1, &q2], PROGRESS).unwrap();
    let start = composition.compensated(&dynamics).unwrap();
    same(&composition.refined(&dynamics, &start).unwrap(), optimum.q());
    let fraction = |q: &QTable| optimum.fraction_optimal(&q.policy()).unwrap();
    assert!(fraction(&start) > fraction(&composition.initial(Combine::Sum)));
}

fn same(one: &QTable, other: &QTable) {
    one.values().iter().zip(other.values()).for_each(|(a, b)| near(*a, *b, 1e-8));
}

#[test]
fn sub_policy_values_differ_from_flat_ones() {
    let problem = problem(&on_paper(&both(A, B)));
    let flat = problem.optimal_q(&PROGRESS);
    let fixed = problem.sub_policy_q(&PROGRESS);
    // At a fixed q a goal is paid again and again.
    assert!(fixed.max(0, 0) > 2.0 * flat.max(0, 0));
}

#[test]
fn sequence_is_one_after_the_other() {
    let (a, b) = (eventually(A), eventually(B));
    let sequence = Product::sequence(&[&a, &b]);
    assert_eq!(sequence.states(), 3);
    assert_eq!(sequence.trajectory_robustness(&[B, A]).unwrap().max(0.0), 0.0);
    let walk = |cells: &[_]| cells.iter().fold(0, |q, s| sequence.next(q, s).unwrap());
    assert!(!sequence.is_accepting(walk(&[B, A])));
    assert!(sequence.is_accepting(walk(&[B, A, B])));
    let same = Product::sequence(&[&a, &a]);
    let walk = |cells: &[_]| cells.iter().fold(0, |q, s| same.next(q, s).unwrap());
    assert!(!same.is_accepting(walk(&[A])) && same.is_accepting(walk(&[A, A])));
}

#[test]
fn disjunction_survives_a_lost_operand() {
    let (phi, b) = (avoid(C, A), eventually(B));
    let either = Product::disjunction(&[&phi, &b]);
    let walk = |cells: &[_]| cells.iter().fold(0, |q, s| either.next(q, s).unwrap());
    assert!(!either.is_terminal(walk(&[C])) && either.is_accepting(walk(&[C, B])));
}

/// What composition with networks relies on: it learns nothing where all operands but one are
/// decided. (Potentials of `Shaped` depend on the whole automaton.)
#[test]
fn where_one_operand_is_left_its_values_are_the_product_s() {
    let (phi1, phi2) = (avoid(C, A), both(B, C));
    let operands: [Operand<'_, Cell>; 2] = [&phi1, &phi2];
    let modes = [Mode::Progress, Mode::Literal, Mode::Acceptance, Mode::Robustness];
    let mut compared = 0;
    for mode in modes {
        let rewards = Rewards::of(mode).with_bound(10.0).unwrap();
        let rewards = rewards.with_trap_penalty(0.5).unwrap().with_step_penalty(0.01).unwrap();
        for operator in [Operator::Conjunction, Operator::Disjunction, Operator::Sequence] {
            let whole = Product::new(operator, &operands);
            let table = |task: Operand<'_, Cell>| {
                let cells = (0..PAPER.states()).map(|s| PAPER.state(s));
                on_paper(task).with_robustness(cells, task).unwrap()
            };
            let task = table(&whole);
            let exact = problem(&task).optimal_q(&rewards);
            let parts = operands.map(table);
            let values = parts.each_ref().map(|part| problem(part).optimal_q(&rewards));
            for q in task.live() {
                let at = whole.components(q);
                let open: Vec<usize> = (0..2).filter(|&i| parts[i].end(at[i]).is_none()).collect();
                if let [i] = open[..] {
                    for s in 0..task.states() {
                        let rows = exact.row(q, s).iter().zip(values[i].row(at[i], s));
                        rows.for_each(|(a, b)| near(*a, *b, 1e-8));
                        compared += 1;
                    }
                }
            }
        }
    }
    assert!(compared > 1_000);
}
