//! Composition only improves: each stage against the one before, whatever the operator and the rewards.

mod world;

use tltl::compose::{Operator, Stage, Steps};
use tltl::model::FiniteModel as _;
use tltl::prelude::*;
use tltl::product::Operand;
use tltl::reward::Mode;
use world::{Cell, Grid, avoid, both, eventually};

/// A grid of 20 cells.
const SMALL: Grid = Grid { width: 4, height: 5 };

const OPERATORS: [Operator; 3] = [Operator::Conjunction, Operator::Disjunction, Operator::Sequence];

/// Goal cells a, b, c.
const LAYOUTS: [[(i32, i32); 3]; 3] =
    [[(1, 1), (2, 3), (1, 4)], [(0, 0), (3, 4), (1, 0)], [(2, 2), (0, 4), (1, 2)]];

fn near_one() -> Rewards {
    Rewards::acceptance().with_gamma(0.9999).unwrap()
}

fn label(task: &(impl Monitor<Cell> + ?Sized)) -> Labelled {
    Labelled::of_model(&SMALL, task).unwrap()
}

fn problem(task: &Labelled) -> Problem {
    Problem::new(&Dynamics::new(&SMALL).unwrap(), task).unwrap()
}

/// Two skills on a layout, with traps and without: exact values for some rewards, and what becomes of them.
fn composed(
    skills: [Operand<'_, Cell>; 2],
    operator: Operator,
    rewards: Rewards,
    combine: Combine,
) -> Steps {
    let [one, two] = skills.map(|skill| problem(&label(skill)).optimal_q(&rewards));
    let product = Product::new(operator, &skills);
    let task = label(&product);
    let composition = Composition::new(&product, &task, &[&one, &two], rewards).unwrap();
    composition.run(&Dynamics::new(&SMALL).unwrap(), combine).unwrap()
}

/// All compositions of a kind of rewards, with a name.
fn all(rewards: Rewards, mut visit: impl FnMut(&str, &Steps)) {
    for [a, b, c] in LAYOUTS {
        let [a, b, c] = [a, b, c].map(|(x, y)| Cell { x, y });
        let (ab, fa, fc, ca, cb, ba) =
            (both(a, b), eventually(a), eventually(c), avoid(c, a), avoid(c, b), avoid(b, a));
        let pairs: [[Operand<'_, Cell>; 2]; 4] = [[&ab, &fc], [&ca, &fa], [&ca, &cb], [&ba, &cb]];
        for (i, skills) in pairs.into_iter().enumerate() {
            for operator in OPERATORS {
                for combine in [Combine::Sum, Combine::Max] {
                    let name = format!("pair {i} {operator:?} {combine:?} {a:?}");
                    visit(&name, &composed(skills, operator, rewards, combine));
                }
            }
        }
    }
}

/// Where the task is paid for, no stage is worse than the one before, and the last is the optimum. A step
/// of delay costs 1e-4 of the reward, so that P may fall by what the steps of before have cost.
#[test]
fn no_stage_is_worse_than_the_one_before() {
    let (mut improved, mut count) = (0, 0);
    all(near_one(), |name, steps| {
        let worth: Vec<f64> = steps.all().iter().map(|step| step.certificate.satisfied).collect();
        let [combined, compensated, refined] = worth[..] else { panic!("three stages") };
        let cost = 1e-4 * steps.all()[0].certificate.steps.map_or(0.0, |steps| steps * combined);
        assert!(compensated > combined - cost - 1e-9, "{name}\n{steps}");
        let last = &steps.all()[2].certificate;
        assert!(last.regret_satisfied.abs() < 1e-9, "{name}\n{steps}");
        assert!(last.regret_steps.is_none_or(|more| more.abs() < 1e-6), "{name}\n{steps}");
        assert!(steps.best().certificate.satisfied > refined - 1e-8, "{name}\n{steps}");
        improved += usize::from(compensated > combined + 1e-3);
        count += 1;
    });
    assert!(improved > count / 10, "the sum is often not enough: {improved} of {count}");
}

/// Exact skills, neither of which may meet the other's goal too early: finishing the first is not the task,
/// and a move that loses one skill is not as good as one that finishes it.
#[test]
fn finishing_one_skill_is_not_taken_back() {
    for [a, b, c] in LAYOUTS {
        let [a, b, c] = [a, b, c].map(|(x, y)| Cell { x, y });
        let (one, two) = (avoid(b, a), avoid(c, b));
        let steps = composed([&one, &two], Operator::Conjunction, near_one(), Combine::Sum);
        let regret = |i: usize| steps.all()[i].certificate.regret_satisfied;
        assert!(regret(1) <= regret(0) + 1e-3 && regret(1) < 0.2, "{steps}");
    }
}

/// The paper's rewards are taken at their word, and then the best stage need not be the last.
#[test]
fn the_best_stage_is_kept() {
    let mut earlier = 0;
    all(Rewards::progress(), |name, steps| {
        let best = &steps.best().certificate;
        for step in steps.all() {
            let own = &step.certificate;
            assert!(own.satisfied < best.satisfied + 1e-8, "{name}\n{steps}");
            let slower = own.steps.unwrap_or(f64::INFINITY) > best.steps.unwrap() - 1e-6;
            assert!(own.satisfied < best.satisfied - 1e-10 || slower, "{name}\n{steps}");
        }
        earlier += usize::from(steps.best().stage != Stage::Refined);
        let shown = format!("{steps}");
        assert_eq!((shown.lines().count(), shown.matches("<- best").count()), (3, 1), "{shown}");
    });
    assert!(earlier > 0, "what is best for the rewards is not best for the task");
}

/// Skills compose from their tables alone as they do by a product that was written down.
#[test]
fn tables_are_enough() {
    let [a, b, c] = LAYOUTS[0].map(|(x, y)| Cell { x, y });
    let (first, second, third) = (both(a, b), avoid(c, a), eventually(c));
    let skills: [Operand<'_, Cell>; 3] = [&first, &second, &third];
    for mode in [Mode::Acceptance, Mode::Progress, Mode::Literal] {
        let rewards = Rewards::of(mode);
        let q = skills.map(|skill| problem(&label(skill)).optimal_q(&rewards));
        for operator in OPERATORS {
            let product = Product::new(operator, &skills);
            let task = label(&product);
            let written = Composition::new(&product, &task, &q.each_ref(), rewards).unwrap();
            let found = Composition::of(operator, &q.each_ref(), rewards, 1_000).unwrap();
            assert!(found.task().automaton_states() <= task.automaton_states());
            assert_eq!(found.task().formula(), product.formula().text());
            for combine in [Combine::Sum, Combine::NormalisedSum, Combine::Max] {
                let [one, two] = [&written, &found].map(|of| of.initial(combine));
                for s in 0..20 {
                    let row = |of: &QTable| of.row(of.task().start(s), s).to_vec();
                    assert_eq!(row(&one), row(&two), "{operator:?} {combine:?} {s}");
                }
            }
            let dynamics = Dynamics::new(&SMALL).unwrap();
            let [one, two] = [&written, &found].map(|of| of.run(&dynamics, Combine::Sum).unwrap());
            for (one, two) in one.all().iter().zip(two.all()) {
                let difference = one.certificate.satisfied - two.certificate.satisfied;
                assert!(difference.abs() < 1e-9, "{operator:?} {mode:?}");
            }
            let error = Composition::of(operator, &q.each_ref(), rewards, 2).unwrap_err();
            assert!(error.to_string().starts_with("the 3 parts of the task reach more than 2"));
        }
    }
}

#[test]
fn skills_of_different_worlds_are_refused() {
    let large = Grid { width: 5, height: 5 };
    let [a, _, _] = LAYOUTS[0].map(|(x, y)| Cell { x, y });
    let small = QTable::zeros(&label(&eventually(a)));
    let large = QTable::zeros(&Labelled::of_model(&large, &eventually(a)).unwrap());
    let skills = [&small, &large];
    let error = Composition::of(Operator::Conjunction, &skills, near_one(), 100).unwrap_err();
    assert!(error.to_string().starts_with("a skill of a world of 25 states"), "{error}");
}

/// A factored task is a skill like any other: each stage is worth what it is of the same task in one piece.
#[test]
fn factored_skills_compose_like_others() {
    let cells = || (0..20).map(|s| SMALL.state(s));
    let actions = || (0..5).map(|a| SMALL.action_name(a));
    let whole = tltl! { |s: &Cell|
        F (s.x == 1 && s.y == 1) && F (s.x == 2 && s.y == 3)
            && (!(s.x == 0 && s.y == 4) U (s.x == 3 && s.y == 0))
    };
    let parts = tltl! { #[factored] |s: &Cell|
        F (s.x == 1 && s.y == 1) && F (s.x == 2 && s.y == 3)
            && (!(s.x == 0 && s.y == 4) U (s.x == 3 && s.y == 0))
    };
    let other = label(&avoid(Cell { x: 3, y: 0 }, Cell { x: 2, y: 3 }));
    let skills = [label(&whole), Labelled::of_factored(cells(), actions(), &parts, 1_000).unwrap()];
    for rewards in [near_one(), Rewards::progress()] {
        let second = problem(&other).optimal_q(&rewards);
        for operator in OPERATORS {
            let [one, two] = skills.each_ref().map(|skill| {
                let first = problem(skill).optimal_q(&rewards);
                let composition =
                    Composition::of(operator, &[&first, &second], rewards, 1_000).unwrap();
                composition.run(&Dynamics::new(&SMALL).unwrap(), Combine::Sum).unwrap()
            });
            for (one, two) in one.all().iter().zip(two.all()) {
                let difference = one.certificate.satisfied - two.certificate.satisfied;
                assert!(difference.abs() < 1e-9, "{operator:?} {one:?}");
            }
            assert_eq!(one.best().stage, two.best().stage, "{operator:?}");
        }
    }
}
