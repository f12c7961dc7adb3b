//! Operators with bounds and `ensuring`: random formulas against the definitions of each operator,
//! read window by window.

use std::convert::Infallible;
use std::ops::RangeInclusive;

use proptest::prelude::*;
use tltl::{Acceptor, Monitor, robustness, tltl};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::{Source, Span};
use tltl_compiler::spec::{Formula, FormulaId, Spec};
use tltl_compiler::translate::{Budget, states_of_bound, translate};
use tltl_compiler::{check, compile};
use tltlc::evaluate::{Columns, Evaluator, Scratch};
use tltlc::task;
use tltlc::{semantics, tables};

use crate::corpus;
use crate::random::{self, Bytes, Choices, NAMES, Seeded};

/// The number of propositions.
const COUNT: u32 = 3;

/// A formula as it is written, before anything is rewritten.
#[derive(Clone, Debug)]
enum Tree {
    Truth(bool),
    Literal(u32, bool),
    And(Box<[Tree; 2]>),
    Or(Box<[Tree; 2]>),
    Next(u32, Box<Tree>),
    Eventually(Box<Tree>),
    EventuallyIn(RangeInclusive<u32>, Box<Tree>),
    ThroughoutIn(RangeInclusive<u32>, Box<Tree>),
    Until(Box<[Tree; 2]>),
    UntilIn(RangeInclusive<u32>, Box<[Tree; 2]>),
    Then(Box<[Tree; 2]>),
    ThenIn(RangeInclusive<u32>, Box<[Tree; 2]>),
    /// The second is a state formula.
    Ensuring(Box<[Tree; 2]>),
}

impl Tree {
    /// A formula with at most so many operators.
    fn random(choices: &mut impl Choices, operators: u32, ensuring: bool) -> Self {
        if operators == 0 {
            return match choices.choose(12) {
                10 => Self::Truth(true),
                11 => Self::Truth(false),
                other => Self::Literal(other % COUNT, other % 2 == 1),
            };
        }
        let kind = choices.choose(if ensuring { 13 } else { 12 });
        let rest = operators - 1;
        let left = choices.choose(rest + 1);
        let first = choices.choose(3);
        let steps = first..=first + choices.choose(4);
        let one = |choices: &mut _| Box::new(Self::random(choices, rest, ensuring));
        match kind {
            0 => return Self::Next(first, one(choices)),
            1 => return Self::Eventually(one(choices)),
            2 | 3 => return Self::EventuallyIn(steps, one(choices)),
            4 | 5 => return Self::ThroughoutIn(steps, one(choices)),
            _ => {}
        }
        let a = Self::random(choices, left, ensuring);
        if kind == 12 {
            let p = Self::Literal(choices.choose(COUNT), choices.choose(2) == 1);
            return Self::Ensuring(Box::new([a, p]));
        }
        let pair = Box::new([a, Self::random(choices, rest - left, ensuring)]);
        match kind {
            6 => Self::And(pair),
            7 => Self::Or(pair),
            8 => Self::Until(pair),
            9 => Self::UntilIn(steps, pair),
            10 => Self::Then(pair),
            _ => Self::ThenIn(first + 1..=first + 1 + steps.count() as u32, pair),
        }
    }

    /// The formula in a spec.
    fn build(&self, spec: &mut Spec) -> FormulaId {
        let at = Span::default();
        let pair = |spec: &mut Spec, [a, b]: &[Self; 2]| (a.build(spec), b.build(spec));
        match self {
            Self::Truth(value) => spec.truth(*value, at),
            Self::Literal(p, negated) => spec.literal(*p, *negated, at),
            Self::Next(n, a) => {
                let a = a.build(spec);
                spec.delay(*n, a, at)
            }
            Self::Eventually(a) => {
                let a = a.build(spec);
                spec.eventually(a, at)
            }
            Self::EventuallyIn(steps, a) => {
                let a = a.build(spec);
                spec.eventually_in(steps.clone(), a, at)
            }
            Self::ThroughoutIn(steps, a) => {
                let a = a.build(spec);
                spec.throughout_in(steps.clone(), a, at)
            }
            Self::And(ab) | Self::Or(ab) | Self::Until(ab) | Self::Then(ab) => {
                let (a, b) = pair(spec, ab);
                match self {
                    Self::And(_) => spec.and(a, b, at),
                    Self::Or(_) => spec.or(a, b, at),
                    Self::Until(_) => spec.until(a, b, at),
                    _ => spec.then(a, b, at),
                }
            }
            Self::UntilIn(steps, ab) => {
                let (a, b) = pair(spec, ab);
                spec.until_in(steps.clone(), a, b, at)
            }
            Self::ThenIn(steps, ab) => {
                let (a, b) = pair(spec, ab);
                spec.then_in(steps.clone(), a, b, at)
            }
            Self::Ensuring(ab) => {
                let (a, b) = pair(spec, ab);
                spec.ensuring(a, b, at)
            }
        }
    }

    /// The robustness at instant `i` of the trajectory that `trace` is, by the definitions.
    fn rho(&self, trace: &[[f64; 5]], i: usize) -> f64 {
        let least = |a: &Self, j, k| (j..k).map(|t| a.rho(trace, t)).fold(f64::INFINITY, f64::min);
        let most = |a: &Self, j, k| (j..k).map(|t| a.rho(trace, t)).fold(-f64::INFINITY, f64::max);
        let until = |a: &Self, b: &Self, j, k| {
            (j..k).map(|t| b.rho(trace, t).min(least(a, i, t))).fold(f64::NEG_INFINITY, f64::max)
        };
        let then = |a: &Self, b: &Self, steps: RangeInclusive<usize>| {
            (i..trace.len())
                .map(|t| {
                    let end = trace.len().min(t + steps.end() + 1);
                    a.rho(trace, t).min(most(b, t + steps.start(), end))
                })
                .fold(f64::NEG_INFINITY, f64::max)
        };
        let window = |steps: &RangeInclusive<u32>| {
            let [first, last] = [*steps.start(), *steps.end()].map(|n| i + n as usize);
            (first, trace.len().min(last + 1), last >= trace.len())
        };
        let end = trace.len();
        match self {
            _ if i >= end => f64::NEG_INFINITY,
            Self::Truth(value) => {
                if *value {
                    f64::INFINITY
                } else {
                    f64::NEG_INFINITY
                }
            }
            Self::Literal(p, negated) => trace[i][*p as usize] * if *negated { -1.0 } else { 1.0 },
            Self::And(ab) => ab[0].rho(trace, i).min(ab[1].rho(trace, i)),
            Self::Or(ab) => ab[0].rho(trace, i).max(ab[1].rho(trace, i)),
            Self::Next(n, a) => a.rho(trace, i + *n as usize),
            Self::Eventually(a) => most(a, i, end),
            Self::EventuallyIn(steps, a) => most(a, window(steps).0, window(steps).1),
            Self::ThroughoutIn(steps, a) => match window(steps) {
                (_, _, true) => f64::NEG_INFINITY,
                (first, last, _) => least(a, first, last),
            },
            Self::Until(ab) => until(&ab[0], &ab[1], i, end),
            Self::UntilIn(steps, ab) => until(&ab[0], &ab[1], window(steps).0, window(steps).1),
            Self::Then(ab) => then(&ab[0], &ab[1], 1..=end),
            Self::ThenIn(steps, ab) => {
                then(&ab[0], &ab[1], *steps.start() as usize..=*steps.end() as usize)
            }
            // Its truth alone is defined: p until the first instant at which the states until then
            // satisfy φ.
            Self::Ensuring(ab) => {
                let done = (i..end).find(|&n| ab[0].rho(&trace[..=n], i) > 0.0);
                let holds = done.is_some_and(|n| least(&ab[1], i, n + 1) > 0.0);
                if holds { 1.0 } else { -1.0 }
            }
        }
    }
}

/// A formula and a spec of it.
fn chosen(bytes: &[u8], ensuring: bool) -> (Tree, Spec) {
    let mut choices = Bytes(bytes);
    let operators = choices.choose(6);
    let tree = Tree::random(&mut choices, operators, ensuring);
    let spec = spec(&tree);
    (tree, spec)
}

fn spec(tree: &Tree) -> Spec {
    let names = NAMES[..COUNT as usize].iter().map(|&name| name.into());
    let mut spec = Spec::new(names.collect());
    let root = tree.build(&mut spec);
    spec.set_root(root);
    spec
}

/// The formula with every bound written out in `X`, `&&` and `||`.
fn written_out(spec: &Spec) -> Spec {
    let mut plain = Spec::new(spec.propositions().to_vec());
    let ids: Vec<_> = spec.formulas().map(|(id, _)| id).collect();
    let images = plain.rebuild(spec, &ids, &mut |plain, _, formula| steps(plain, formula));
    plain.set_root(images[spec.root().0 as usize]);
    plain
}

/// One operator, with a step for each of its bound.
fn steps(spec: &mut Spec, formula: Formula) -> FormulaId {
    let at = Span::default();
    let (n, a, last) = match formula {
        Formula::Delay(n, a) | Formula::Within(n, a) | Formula::Throughout(n, a) => (n, a, a),
        Formula::UntilWithin(n, a, b) => (n, a, b),
        other => return spec.add(other, at),
    };
    (0..n).fold(last, |rest, _| {
        let later = spec.next(rest, at);
        match formula {
            Formula::Within(..) => spec.or(a, later, at),
            Formula::Throughout(..) => spec.and(a, later, at),
            Formula::UntilWithin(..) => {
                let hold = spec.and(a, later, at);
                spec.or(last, hold, at)
            }
            _ => later,
        }
    })
}

/// The robustness that the evaluator of columns gives.
fn by_columns(evaluator: &Evaluator, rows: usize, numbers: &[f64]) -> f64 {
    let columns = Columns::of_rows(rows, evaluator.inputs().len(), numbers).unwrap();
    evaluator.robustness(&columns, &mut Scratch::default()).unwrap()
}

fn minimal(spec: &Spec) -> Dfa {
    minimize(&translate(spec, Budget::SHOWN).unwrap())
}

fn bytes() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..60)
}

fn traces() -> impl Strategy<Value = Vec<[f64; 5]>> {
    let value = (0..7_i8).prop_map(|value| f64::from(value) - 2.5);
    prop::collection::vec(prop::array::uniform5(value), 1..12)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn bounds_mean_what_their_definitions_say(bytes in bytes(), trace in traces()) {
        let (tree, spec) = chosen(&bytes, false);
        let rho = |p: u32, t: usize| trace[t][p as usize];
        let found = semantics::robustness(&spec, trace.len(), rho);
        prop_assert_eq!(found, tree.rho(&trace, 0), "{:?} as {}", tree, spec);
    }

    /// Every engine gives the robustness of the definitions on every prefix. It never falls as the
    /// trajectory grows, and its sign is the verdict of the automaton.
    #[test]
    fn engines_give_the_robustness_of_the_definitions(bytes in bytes(), trace in traces()) {
        let (tree, spec) = chosen(&bytes, false);
        let task = task::compile(&spec.to_string(), Budget::SHOWN).unwrap();
        let names: Vec<_> = task.inputs().iter().map(|input| input.name.as_str().into()).collect();
        let places = random::places(&names);
        let rows: Vec<Vec<f64>> =
            trace.iter().map(|row| places.iter().map(|&place| row[place]).collect()).collect();
        let (mut q, mut before) = (0, f64::NEG_INFINITY);
        for length in 1..=trace.len() {
            let expected = tree.rho(&trace[..length], 0);
            let about = format!("{spec} on {:?}", &trace[..length]);
            let columns = by_columns(task.evaluator(), length, &rows[..length].concat());
            prop_assert_eq!(columns, expected, "{}", &about);
            prop_assert_eq!(by_operators(&spec, length, |p, t| trace[t][p]), expected, "{}", &about);
            prop_assert!(expected >= before, "{}", &about);
            q = task.next(q, &rows[length - 1]).unwrap();
            prop_assert_eq!(expected > 0.0, task.is_accepting(q), "{}", &about);
            before = expected;
        }
    }

    /// The automaton of a formula with bounds is that of the same formula without any, written out
    /// in `X`, `&&` and `||`.
    #[test]
    fn automata_are_those_of_bounds_written_out(bytes in bytes()) {
        let (_, spec) = chosen(&bytes, true);
        let [bounded, plain] = [&spec, &written_out(&spec)].map(minimal);
        prop_assert_eq!(&bounded.transitions, &plain.transitions, "{}", spec);
        prop_assert_eq!(bounded.diagram.nodes(), plain.diagram.nodes(), "{}", spec);
        prop_assert_eq!(bounded.accepting, plain.accepting);
        if let Some(states) = states_of_bound(&spec, Budget::SHOWN) {
            prop_assert_eq!(states, plain.len() as u64, "{}", spec);
        }
    }

    #[test]
    fn ensuring_means_what_its_definition_says(bytes in bytes(), trace in traces()) {
        let (tree, spec) = chosen(&bytes, true);
        let holds = |p: u32, t: usize| trace[t][p as usize] > 0.0;
        let found = semantics::satisfied(&spec, trace.len(), holds);
        prop_assert_eq!(found, tree.rho(&trace, 0) > 0.0, "{:?} as {}", tree, spec);
    }
}

/// Bounds of thousands, within the limits of the macros and beyond: the states, or why not.
#[test]
fn large_bounds_are_answered() {
    for (formula, expected) in [
        ("F[0,10000] a", "10003"),
        ("G[0,10000] a", "10003"),
        ("X[10000] a", "10003"),
        ("a U[0,10000] b", "10003"),
        ("F[2000,12000] a", "12003"),
        ("F[0,1000] a && F[0,1000] b && F[0,1000] c", "7003"),
        ("F[0,10000] a && G[0,5] b", "10008"),
        ("F[0,100] G[0,100] a", "5153"),
        ("G[0,100] F[0,100] a", "5153"),
        ("(a T X[317] F[1771,4440] !a) T a", "4182"),
        ("F[0,100000] a", "the automaton of the formula needs 100003 states, more than 16384"),
        (
            "a U[7,4000000007] b",
            "the automaton of the formula needs more than 16384 states: a bound in it needs 4000000010 \
             alone",
        ),
        (
            "X[50000] G[0,50000] a",
            "the automaton of the formula needs 100003 states, more than 16384",
        ),
        (
            "F[0,4000000000] a && F[0,4000000000] b",
            "the automaton of the formula needs more than 16384 states: a bound in it needs 4000000003 \
             alone",
        ),
        (
            "F[0,1000] (a && F[0,1000] b)",
            "the automaton of the formula needs more than 16384 states",
        ),
        ("G[0,1000] (a || X[1000] b)", "the automaton of the formula needs more than 16384 states"),
        (
            "(F[0,2536] b) T G[26949,34782] a",
            "the automaton of the formula needs more than 1048576 nodes",
        ),
    ] {
        let found = match compile::formula(&Source::new("formula", formula), Budget::EMITTED) {
            Ok(compiled) => compiled.automata[0].dfa.len().to_string(),
            Err(errors) => errors.first().message().to_owned(),
        };
        assert_eq!(found, expected, "{formula}");
    }
}

/// Every engine gives the robustness of the corpus on every prefix of its traces.
#[test]
fn engines_give_the_robustness_of_the_corpus() {
    for row in corpus::robustness() {
        let module = check::formula(&Source::new("formula", row.formula.as_str())).unwrap();
        let (task, about) = (&module.tasks[0], &row.formula);
        let evaluator = Evaluator::new(&module, task).unwrap();
        let place = |name: &str| row.aps.iter().position(|ap| ap == name).unwrap();
        let places: Vec<_> = task.spec.propositions().iter().map(|p| place(&p.name)).collect();
        let inputs: Vec<_> = evaluator.inputs().iter().map(|input| place(&input.name)).collect();
        let rho = |p: usize, t: usize| row.trace[t][places[p]];
        for (length, expected) in (1..).zip(&row.rho_prefixes) {
            let expected = expected.value();
            let rows = row.trace[..length].iter();
            let numbers: Vec<f64> =
                rows.flat_map(|row| inputs.iter().map(|&place| row[place])).collect();
            assert_eq!(by_columns(&evaluator, length, &numbers), expected, "{about}, {length}");
            assert_eq!(by_operators(&task.spec, length, rho), expected, "{about}, {length}");
            let by_definition =
                semantics::robustness(&task.spec, length, |p, t| rho(p as usize, t));
            assert_eq!(by_definition, expected, "{about}, {length}");
        }
    }
}

/// Windows that are shorter and longer than a block of rows and than the trajectory.
#[test]
fn long_windows_give_the_robustness_of_their_definitions() {
    let mut choices = Seeded(7);
    let mut number = || f64::from(choices.choose(1000)) - 700.5;
    let trace: Vec<[f64; 5]> = (0..700).map(|_| [(); 5].map(|()| number())).collect();
    let rows: Vec<Vec<f64>> = trace.iter().map(|row| row[..2].to_vec()).collect();
    for (first, last) in [(0, 1), (0, 2), (1, 255), (0, 256), (300, 557), (0, 699), (0, 100_000)] {
        let (steps, a) = (first..=last, Tree::Literal(0, false));
        for tree in [
            Tree::EventuallyIn(steps.clone(), Box::new(a.clone())),
            Tree::ThroughoutIn(steps.clone(), Box::new(a.clone())),
            Tree::Next(last, Box::new(a.clone())),
            Tree::UntilIn(steps, Box::new([a, Tree::Literal(1, true)])),
        ] {
            let spec = spec(&tree);
            let expected = tree.rho(&trace, 0);
            assert_eq!(by_operators(&spec, trace.len(), |p, t| trace[t][p]), expected, "{spec}");
            let module = check::formula(&Source::new("formula", spec.to_string())).unwrap();
            let evaluator = Evaluator::new(&module, &module.tasks[0]).unwrap();
            let width = evaluator.inputs().len();
            let rows = rows.iter().flat_map(|row| &row[..width]).copied().collect::<Vec<_>>();
            assert_eq!(by_columns(&evaluator, trace.len(), &rows), expected, "{spec}");
        }
    }
}

/// The windows of generated code: arrays on the stack, and on the heap where they are large.
#[test]
fn generated_code_has_the_robustness_of_the_definitions() {
    let mut choices = Seeded(8);
    let mut number = || f64::from(choices.choose(1000)) - 500.5;
    let trace: Vec<[f64; 5]> = (0..6000).map(|_| [(); 5].map(|()| number())).collect();
    let (a, b) = (|row: &[f64; 5]| row[0], |row: &[f64; 5]| row[1]);
    let small = tltl! { G[0,5] (a || F[2,7] b) };
    // The automaton has two states, whatever the bound.
    let large = tltl! { F a || F[0,5000] b };
    for length in [1, 7, 12, 13, 14, 100, 4999, 5001, 5002, 6000] {
        let trace = &trace[..length];
        let rho = |p: usize| move |t: usize| trace.get(t).map_or(f64::NEG_INFINITY, |row| row[p]);
        let most = |p: usize, last: usize| (0..=last).map(rho(p)).fold(f64::NEG_INFINITY, f64::max);
        let expected = most(0, length).max(most(1, 5000));
        assert_eq!(large.robustness(trace), Ok(expected), "{length}");
        let soon = |t: usize| (t + 2..=t + 7).map(rho(1)).fold(f64::NEG_INFINITY, f64::max);
        let each = (0..=5).map(|t| rho(0)(t).max(soon(t)));
        let each = if length > 5 { each.fold(f64::INFINITY, f64::min) } else { f64::NEG_INFINITY };
        assert_eq!(small.robustness(trace), Ok(each), "{length}");
    }
}

/// The robustness by the runtime's pass over the operators, in memory of just the size it states.
fn by_operators(spec: &Spec, length: usize, rho: impl Fn(usize, usize) -> f64) -> f64 {
    let formula = tables::formula(spec, "").unwrap();
    let operators = formula.operators();
    // Generated code has the cells of any length.
    let cells = robustness::cells(operators, usize::MAX);
    assert_eq!(tltl_compiler::tables::cells(&tltl_compiler::tables::operators(spec)), cells);
    let mut now = vec![0.0; robustness::cells(operators, length)];
    let mut next = vec![0.0; operators.len()];
    let rho = |p: usize, t: usize| Ok::<f64, Infallible>(rho(p, t));
    let Ok(rho) = robustness::trajectory(operators, length, &mut now, &mut next, rho);
    rho
}
