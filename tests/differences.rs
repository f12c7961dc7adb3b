//! Comparing tasks by what their predicates mean: a difference is one of the world, and where there
//! is none, no trajectory shows one.

use tltl::{Acceptor, Monitor};
use tltl_compiler::translate::Budget;
use tltlc::diff::{Difference, Side, of_definitions};
use tltlc::task::{Task, compile};

use crate::random::{self, Choices, NAMES, Seeded};

/// What a name of a random formula stands for.
const MEANINGS: [&str; 12] = [
    "x < 3",
    "x <= 3",
    "3 > x",
    "x > 5",
    "2 * x < 6",
    "x + y < 4",
    "y >= 1",
    "abs(x) > 2",
    "-x > 2",
    "x < y",
    "free",
    "y == 1",
];

/// A random formula over comparisons; no name is a part of another word of it.
fn formula(choices: &mut Seeded) -> String {
    let operators = choices.choose(5);
    let formula = random::formula(choices, 3, operators);
    let mut text = String::new();
    for c in formula.chars() {
        match NAMES.iter().position(|name| name.starts_with(c)) {
            Some(_) if c.is_ascii_lowercase() => {
                let meaning = MEANINGS[choices.choose(MEANINGS.len() as u32) as usize];
                text += &format!("({meaning})");
            }
            _ => text.push(c),
        }
    }
    text
}

/// Whether the task is satisfied by states in which the inputs have these values.
fn satisfied(task: &Task, states: &[Vec<(String, f64)>]) -> bool {
    let mut q = 0;
    for state in states {
        let value = |name: &String| state.iter().find(|(known, _)| known == name).map(|one| one.1);
        let row: Vec<f64> =
            task.inputs().iter().map(|input| value(&input.name).unwrap_or(0.0)).collect();
        q = task.next(q, &row).unwrap();
    }
    task.is_accepting(q)
}

fn side(task: &Task) -> Side<'_> {
    let compiled = task.entry().file().compiled();
    Side::Task(&compiled.module, &compiled.module.tasks[0], &compiled.automata[0].dfa)
}

#[test]
fn differences_are_those_of_the_world() {
    let mut choices = Seeded(11);
    let (mut equal, mut different) = (0, 0);
    for _ in 0..1_000 {
        let first = formula(&mut choices);
        let second = match choices.choose(3) {
            0 => first.replace("(x < 3)", "(!(2 * x >= 6))").replace("(x > 5)", "(5 < x)"),
            _ => formula(&mut choices),
        };
        let formulas = [first, second];
        let compiled = formulas.each_ref().map(|formula| compile(formula, Budget::default()));
        let [Ok(first), Ok(second)] = &compiled else { continue };
        match of_definitions(side(first), side(second)) {
            Difference::Unknown(trace) => panic!("{formulas:?}: no state for {trace}"),
            Difference::Trace { trace, states, first: one, second: two } => {
                let free = trace.propositions.iter().position(|one| *one == "free");
                let state = |(state, letter): (&Vec<(String, String)>, &Vec<bool>)| {
                    let free = free.map(|free| if letter[free] { 1.0 } else { -1.0 });
                    let values =
                        state.iter().map(|(name, value)| (name.clone(), value.parse().unwrap()));
                    values.chain(free.map(|free| ("free".to_owned(), free))).collect()
                };
                let states: Vec<_> = states.iter().zip(&trace.letters).map(state).collect();
                assert_eq!(satisfied(first, &states), one, "{formulas:?}: {trace}");
                assert_eq!(satisfied(second, &states), two, "{formulas:?}: {trace}");
                assert_ne!(one, two, "{formulas:?}");
                different += 1;
            }
            Difference::None => {
                for _ in 0..20 {
                    let mut value =
                        |name: &str| (name.to_owned(), f64::from(choices.choose(29)) / 2.0 - 7.0);
                    let states: Vec<_> =
                        (0..6).map(|_| ["x", "y", "free"].map(&mut value).to_vec()).collect();
                    let verdicts = [first, second].map(|task| satisfied(task, &states));
                    assert_eq!(verdicts[0], verdicts[1], "{formulas:?} on {states:?}");
                }
                equal += 1;
            }
        }
    }
    assert!(equal > 20 && different > 200, "{equal} equal, {different} different");
}
