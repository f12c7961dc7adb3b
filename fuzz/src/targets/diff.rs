//! Two tasks compared, whose names stand for comparisons: if they are equal no trajectory tells them
//! apart; if not, the one shown does, in its states, at its last instant and not before.

use tltl_compiler::source::Source;
use tltlc::diff::{Difference, Side, of_definitions};
use tltlc::task::TaskFile;

use super::BUDGET;
use crate::random::{Bytes, Choices};
use crate::written::{Row, Style, Tree};

/// What a name stands for, given `x` and `y`.
type Meaning = fn(f64, f64) -> bool;

/// What a name may stand for, and whether that holds where x and y have these values.
const MEANINGS: [(&str, Meaning); 10] = [
    ("x < 3", |x, _| x < 3.0),
    ("x > 5", |x, _| x > 5.0),
    ("x <= 3", |x, _| x <= 3.0),
    ("3 > x", |x, _| 3.0 > x),
    ("2 * x < 6", |x, _| 2.0 * x < 6.0),
    ("1 < y <= 2", |_, y| 1.0 < y && y <= 2.0),
    ("y == 1", |_, y| y == 1.0),
    ("x < y", |x, y| x < y),
    ("x + y >= 4", |x, y| x + y >= 4.0),
    ("x == 3 || y > 2", |x, y| x == 3.0 || y > 2.0),
];

/// A task: its formula, and what its four names stand for.
struct Subject {
    tree: Tree,
    meanings: [usize; 4],
    text: String,
}

impl Subject {
    fn new(choices: &mut Bytes<'_>, tree: Tree, meanings: [usize; 4]) -> Self {
        let mut text = "state S { x: f64, y: f64 }\n".to_owned();
        for (name, meaning) in ["a", "b", "c", "d"].iter().zip(meanings) {
            text += &format!("predicate {name} = {}\n", MEANINGS[meaning].0);
        }
        text += &format!("task t = {}\n", Style::file(choices, false).text(&tree));
        Self { tree, meanings, text }
    }

    fn compiled(&self) -> Option<TaskFile> {
        TaskFile::new(Source::new("file", self.text.as_str()), BUDGET).ok()
    }

    fn holds(&self, states: &[(f64, f64)]) -> bool {
        let row = |(x, y): &(f64, f64)| self.meanings.map(|meaning| MEANINGS[meaning].1(*x, *y));
        self.tree.holds(&states.iter().map(row).collect::<Vec<Row>>())
    }
}

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let mut choices = Bytes(bytes);
    let subjects = subjects(&mut choices);
    let [Some(one), Some(two)] = subjects.each_ref().map(Subject::compiled) else { return };
    let texts = subjects.each_ref().map(|subject| &subject.text);
    match of_definitions(side(&one), side(&two)) {
        Difference::Unknown(_) => {}
        Difference::None => {
            let states = states(&mut choices);
            for length in 1..=states.len() {
                let [first, second] = verdicts(&subjects, &states[..length]);
                assert_eq!(first, second, "{texts:?} on {:?}", &states[..length]);
            }
        }
        Difference::Trace { trace, states, first, second } => {
            let state = |t: usize| states.get(t).map(Vec::as_slice).unwrap_or_default();
            let states: Vec<_> = (0..trace.letters.len()).map(|t| numbers(state(t))).collect();
            assert_ne!(first, second, "{texts:?}");
            for length in 1..states.len() {
                let [first, second] = verdicts(&subjects, &states[..length]);
                assert_eq!(first, second, "{texts:?} on {:?}, too long", &states);
            }
            assert_eq!(verdicts(&subjects, &states), [first, second], "{texts:?} on {states:?}");
        }
    }
}

/// Two tasks, which often have much in common.
fn subjects(choices: &mut Bytes<'_>) -> [Subject; 2] {
    let operators = choices.choose(6);
    let meaning = |choices: &mut Bytes<'_>| choices.choose(MEANINGS.len() as u32) as usize;
    let tree = Tree::random(choices, operators);
    let meanings = [(); 4].map(|()| meaning(choices));
    let other_tree = match choices.choose(2) {
        0 => tree.clone(),
        _ => Tree::random(choices, operators),
    };
    let mut other_meanings = meanings;
    for _ in 0..choices.choose(3) {
        other_meanings[choices.choose(4) as usize] = meaning(choices);
    }
    let first = Subject::new(choices, tree, meanings);
    [first, Subject::new(choices, other_tree, other_meanings)]
}

fn side(file: &TaskFile) -> Side<'_> {
    let compiled = file.compiled();
    Side::Task(&compiled.module, &compiled.module.tasks[0], &compiled.automata[0].dfa)
}

fn verdicts(subjects: &[Subject; 2], states: &[(f64, f64)]) -> [bool; 2] {
    subjects.each_ref().map(|subject| subject.holds(states))
}

/// The values of x and y, which are 0 where they do not matter.
fn numbers(state: &[(String, String)]) -> (f64, f64) {
    let value = |name| {
        let found = state.iter().find(|(known, _)| known == name);
        found.map_or(0.0, |(_, value)| value.parse().expect("it is a number"))
    };
    (value("x"), value("y"))
}

/// States at and around the constants of the comparisons.
fn states(choices: &mut Bytes<'_>) -> Vec<(f64, f64)> {
    let length = 1 + choices.choose(12);
    let value = |choices: &mut Bytes<'_>| f64::from(choices.choose(15)) / 2.0 - 0.5;
    (0..length).map(|_| (value(choices), value(choices))).collect()
}
