//! Possible letters against brute force: every letter that a state shows is possible, and where
//! the analysis claims to be exact, every possible letter is shown by some state.
//!
//! It claims so for boxes of whole numbers, enumerations and truth values, and for linear
//! comparisons of real numbers. Whole numbers that linear comparisons tie to each other are
//! related as if they were real: sound, but not exact.

use std::collections::BTreeSet;

use proptest::prelude::*;
use tltl_compiler::arithmetic;
use tltl_compiler::check;
use tltl_compiler::compile;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Columns, Evaluator, Scratch};

/// A condition of some comparisons, as text.
fn condition(comparison: impl Strategy<Value = String> + 'static) -> impl Strategy<Value = String> {
    let leaf = comparison.boxed();
    leaf.prop_recursive(2, 3, 2, |inner| {
        prop_oneof![
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} && {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("({a} || {b})")),
            inner.prop_map(|a| format!("!({a})")),
        ]
    })
}

fn operator() -> impl Strategy<Value = &'static str> {
    prop::sample::select(vec!["<", "<=", ">", ">=", "==", "!="])
}

/// A linear form of these against a whole number, or half of one.
fn linear(forms: &[&'static str]) -> impl Strategy<Value = String> + use<> {
    let forms = prop::sample::select(forms.to_vec());
    (forms, operator(), -2..=2_i32).prop_map(|(form, op, c)| format!("{form} {op} {c}"))
}

fn boxes() -> impl Strategy<Value = String> {
    let number = (prop::sample::select(vec!["a", "b", "2 * b", "-a"]), operator(), -5..=11_i32)
        .prop_map(|(form, op, half)| format!("{form} {op} {half} / 2"));
    let chain = (0..3, 0..4).prop_map(|(low, high)| format!("{low} < a <= {high}"));
    let other = prop::sample::select(vec![
        "on",
        "kind == red",
        "kind != blue",
        "kind == none",
        "last == red",
        "last == kind",
        "last != kind",
        "255 == a",
        "b == -128",
        "b > 200",
    ]);
    condition(prop_oneof![3 => number, 1 => chain, 2 => other.prop_map(str::to_owned)])
}

/// The letters that are possible, and those that the states of these inputs show.
fn letters(
    state: &str,
    conditions: &[String],
    values: impl Fn(&str) -> Vec<f64>,
) -> [BTreeSet<Vec<bool>>; 2] {
    let mut text = format!("{state}\n");
    for (i, condition) in conditions.iter().enumerate() {
        text += &format!("predicate p{i} = {condition}\n");
    }
    let names: Vec<_> = (0..conditions.len()).map(|i| format!("p{i}")).collect();
    text += &format!("task t = F ({})\n", names.join(" && "));
    let source = Source::new("task.tltl", text.clone());
    let module = check::file(&source).unwrap_or_else(|errors| panic!("{text}{errors}"));
    let task = &module.tasks[0];

    let possible = arithmetic::possible(&module, task);
    let all = (0..1_u32 << conditions.len())
        .map(|bits| (0..conditions.len()).map(|p| bits >> p & 1 == 1).collect::<Vec<_>>());
    let literals = |letter: &[bool]| (0..).zip(letter.iter().copied()).collect::<Vec<_>>();
    let claimed = all.filter(|letter| !possible.excludes(&literals(letter))).collect();

    let evaluator = Evaluator::new(&module, task).unwrap();
    let ranges: Vec<_> = evaluator.inputs().iter().map(|input| values(&input.name)).collect();
    let count: usize = ranges.iter().map(Vec::len).product();
    let mut numbers = Vec::new();
    for mut place in 0..count {
        for range in &ranges {
            numbers.push(range[place % range.len()]);
            place /= range.len();
        }
    }
    let columns = Columns::of_rows(count, ranges.len(), &numbers).unwrap();
    let mut labels = vec![false; count * conditions.len()];
    evaluator.labels(&columns, &mut Scratch::default(), &mut labels).unwrap();
    let shown = labels.chunks(conditions.len()).map(<[bool]>::to_vec).collect();
    [claimed, shown]
}

fn steps(from: i32, to: i32, parts: i32) -> Vec<f64> {
    (from * parts..=to * parts).map(|step| f64::from(step) / f64::from(parts)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn boxes_of_whole_numbers_are_exact(conditions in prop::collection::vec(boxes(), 1..5)) {
        let state = "enum Colour { red, green, blue }
            state Box { a: u8, b: i8, on: bool, kind: Colour?, last: Colour }";
        let [claimed, shown] = letters(state, &conditions, |name| match name {
            "a" => [steps(0, 7, 1), vec![255.0]].concat(),
            "b" => [vec![-128.0], steps(-4, 7, 1), vec![127.0]].concat(),
            "on" => steps(0, 1, 1),
            "kind" => steps(-1, 2, 1),
            _ => steps(0, 2, 1),
        });
        prop_assert_eq!(claimed, shown);
    }

    /// The lines of these forms through whole numbers cut the plane into triangles whose corners are
    /// multiples of 1/2, and each has a point, and each of its sides too, in the grid of quarters.
    #[test]
    fn linear_comparisons_of_real_numbers_are_exact(
        conditions in prop::collection::vec(condition(linear(&["x", "y", "x + y", "x - y", "y - x", "-x - y"])), 1..5),
    ) {
        let state = "state Plane { x: f64, y: f64 }";
        let [claimed, shown] = letters(state, &conditions, |_| steps(-5, 5, 4));
        prop_assert_eq!(claimed, shown);
    }

    /// Differences say nothing about where `z` is, so it may be 0, and the others are a plane.
    #[test]
    fn differences_of_real_numbers_are_exact(
        conditions in prop::collection::vec(condition(linear(&["x - y", "y - z", "x - z", "z - x"])), 1..5),
    ) {
        let state = "state Line { x: f64, y: f64, z: f64 }";
        let [claimed, shown] = letters(state, &conditions, |name| match name {
            "z" => vec![0.0],
            _ => steps(-5, 5, 4),
        });
        prop_assert_eq!(claimed, shown);
    }

    #[test]
    fn what_whole_numbers_show_is_possible(
        conditions in prop::collection::vec(
            condition(linear(&["a", "b", "c", "2 * a + b", "a - 3 * b", "a + b - c", "b - c", "abs(b)"])),
            1..5,
        ),
    ) {
        let state = "state Box { a: u8, b: i8, c: i16 }";
        let [claimed, shown] = letters(state, &conditions, |name| match name {
            "a" => steps(0, 4, 1),
            _ => steps(-4, 4, 1),
        });
        prop_assert!(claimed.is_superset(&shown), "{:?}", shown.difference(&claimed));
    }
}

/// Joins the texts that `part` gives for the numbers from 0 on.
fn joined(count: usize, by: &str, part: impl Fn(usize) -> String) -> String {
    (0..count).map(part).collect::<Vec<_>>().join(by)
}

/// Sources with hundreds of related comparisons: each is answered or refused, in work that does not
/// explode, and says what it says here.
#[test]
fn hundreds_of_related_comparisons_are_answered() {
    let number = "state S { x: f64 }";
    let numbers =
        |count| format!("state S {{ {} }}", joined(count, ", ", |i| format!("x{i}: f64")));
    let mixed = |i: usize| i * 193 % 500;
    let chain = joined(500, " < ", |i| format!("x{i}"));
    let pairs = (0..18).flat_map(|i| (i + 1..18).map(move |j| format!("x{i} < x{j}")));
    let pairs = pairs.collect::<Vec<_>>().join(" && ");
    let entangled = |i: usize| format!("x0 + {i} * x1 + {} * x2 + x3 < {}", i * i, i * i * i);
    let cases = [
        (number.to_owned(), "for all i in 0..500: x < i".to_owned(), "2"),
        (number.to_owned(), joined(500, " && ", |i| format!("x < {}", mixed(i))), "2"),
        (number.to_owned(), joined(500, " && ", |i| format!("x != {}", mixed(i))), "2"),
        (
            number.to_owned(),
            format!("{} && x > 600", joined(500, " && ", |i| format!("x < {}", mixed(i)))),
            "unsatisfiable",
        ),
        (numbers(500), chain.clone(), "2"),
        (numbers(500), format!("{chain} && x499 < x0"), "2"),
        (numbers(18), pairs, "2"),
        (numbers(4), joined(60, " && ", entangled), "2"),
        (numbers(4), joined(60, " || ", |i| format!("({})", entangled(i))), "2"),
        (numbers(3), "x0 < x1 && x1 < x2 && x2 < x0".to_owned(), "unsatisfiable"),
    ];
    for (state, condition, expected) in cases {
        let source = Source::new("t.tltl", format!("{state}\ntask t = F ({condition})\n"));
        let found = match compile::file(&source, Budget::EMITTED) {
            Ok(compiled) => compiled.automata[0].dfa.len().to_string(),
            Err(errors) => errors.first().kind().name().to_owned(),
        };
        assert_eq!(found, expected, "{condition}");
    }
}

/// A file of many tasks over one field: each asks only for its own comparisons.
#[test]
fn a_thousand_tasks_are_answered() {
    let tasks = joined(1000, "\n", |i| format!("task t{i} = F x > {i}"));
    let text = format!("state S {{ x: f64 }}\n{tasks}\n");
    let compiled = compile::file(&Source::new("t.tltl", text), Budget::EMITTED).unwrap();
    assert!(compiled.automata.iter().all(|automata| automata.dfa.len() == 2));
}

/// The search for the reason of a contradiction does not write out guards that are too large.
#[test]
fn a_contradiction_of_large_guards_has_a_reason() {
    let predicates =
        joined(300, "\n", |i| format!("predicate p{} = x < {}", i * 7 % 300, i * 7 % 300));
    let task = joined(150, " || ", |i| format!("(p{} && !p{})", 2 * i, 2 * i + 1));
    let text = format!("state S {{ x: f64 }}\n{predicates}\ntask t = F ({task})\n");
    let errors = compile::file(&Source::new("t.tltl", text), Budget::EMITTED).unwrap_err();
    assert!(errors.to_string().contains("it needs `p0` and `!(p1)`, which exclude each other"));
}

/// Names that nothing declares are reported, the first hundred of them, with suggestions.
#[test]
fn thousands_of_unknown_names_are_reported() {
    let fields = joined(1000, ", ", |i| format!("field{i}: f64"));
    let names = joined(2000, " && ", |i| format!("fiedl{i} < 1"));
    let text = format!("state S {{ {fields} }}\ntask t = F ({names})\n");
    let errors = compile::file(&Source::new("t.tltl", text), Budget::EMITTED).unwrap_err();
    assert_eq!(errors.iter().count(), 100);
    assert!(errors.to_string().contains("did you mean `field1`?"));
}
