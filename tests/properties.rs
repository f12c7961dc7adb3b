//! What must hold of every formula, on random ones.

use std::collections::BTreeSet;

use proptest::prelude::*;
use tltl::Acceptor;
use tltl_compiler::bdd::Cube;
use tltl_compiler::check;
use tltl_compiler::dfa::{Dfa, Guards, State};
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::spec::Spec;
use tltl_compiler::tables::tables;
use tltl_compiler::translate::{Budget, translate};
use tltlc::emit::text;
use tltlc::online::Online;
use tltlc::product::{Operator, product};
use tltlc::semantics;
use tltlc::tables::automaton;

use crate::emitted::emitted;
use crate::random::{self, Bytes, Choices, NAMES};

fn spec(formula: &str) -> Spec {
    let source = Source::new("formula", formula);
    let module = check::formula(&source).unwrap_or_else(|errors| panic!("{formula}: {errors}"));
    module.tasks[0].spec.clone()
}

fn raw(formula: &str) -> Dfa {
    translate(&spec(formula), Budget::SHOWN).unwrap()
}

/// A formula that some bytes choose.
fn chosen(bytes: &[u8], operators: u32) -> String {
    let mut choices = Bytes(bytes);
    let names = 1 + choices.choose(4);
    let operators = choices.choose(operators + 1);
    random::formula(&mut choices, names, operators)
}

fn bytes() -> impl Strategy<Value = Vec<u8>> {
    prop::collection::vec(any::<u8>(), 0..100)
}

/// The places of a letter's propositions among all names; a letter has a bit for each name.
struct Letters(Vec<usize>);

impl Letters {
    fn of(dfa: &Dfa) -> Self {
        Self(random::places(&dfa.propositions))
    }

    fn next(&self, dfa: &Dfa, q: State, letter: u32) -> State {
        dfa.next(q, |p| letter >> self.0[p as usize] & 1 == 1)
    }

    /// One letter for each valuation of the propositions.
    fn all(&self) -> impl Iterator<Item = u32> {
        let bits = |v: u32| (0..).zip(&self.0).map(move |(i, place)| (v >> i & 1) << place).sum();
        (0..1_u32 << self.0.len()).map(bits)
    }
}

fn letters() -> impl Strategy<Value = Vec<u32>> {
    prop::collection::vec(0..1_u32 << NAMES.len(), 1..9)
}

fn accepts(dfa: &Dfa, trace: &[u32]) -> bool {
    let letters = Letters::of(dfa);
    let q = trace.iter().fold(0, |q, &letter| letters.next(dfa, q, letter));
    dfa.accepting == Some(q)
}

fn agree(formula: &str, trace: &[[f64; 5]]) -> Result<(), TestCaseError> {
    let (spec, raw) = (spec(formula), raw(formula));
    let minimal = minimize(&raw);
    let places = random::places(spec.propositions());
    let rho = |p: u32, t: usize| trace[t][places[p as usize]];
    let (mut states, mut held, mut least) = ([0, 0], false, f64::NEG_INFINITY);
    let budgets = [Budget::SHOWN, Budget { states: 0, ..Budget::SHOWN }];
    let mut online = budgets.map(|budget| Online::new(&spec, budget));
    for length in 1..=trace.len() {
        let holds = semantics::satisfied(&spec, length, |p, t| rho(p, t) > 0.0);
        for (q, dfa) in states.iter_mut().zip([&raw, &minimal]) {
            *q = dfa.next(*q, |p| rho(p, length - 1) > 0.0);
            prop_assert_eq!(dfa.accepting == Some(*q), holds, "{} up to {}", formula, length);
            prop_assert!(!holds || dfa.trap != Some(*q));
        }
        prop_assert!(holds || !held, "{formula}: satisfied, and then no more");
        let robust = semantics::robustness(&spec, length, rho);
        for online in &mut online {
            let row: Vec<f64> = places.iter().map(|&place| trace[length - 1][place]).collect();
            online.step(&row);
            prop_assert_eq!(online.robustness(), robust, "{} up to {}", formula, length);
        }
        prop_assert!(robust <= 0.0 || holds, "{formula}: robustness {robust}");
        prop_assert!(robust >= 0.0 || !holds, "{formula}: robustness {robust}");
        prop_assert!(robust >= least, "{formula}: robustness fell from {least} to {robust}");
        (held, least) = (holds, robust);
    }
    Ok(())
}

/// Whether some trace tells any two states apart: by filling the table of all pairs.
fn all_apart(dfa: &Dfa) -> bool {
    let letters = Letters::of(dfa);
    let states: Vec<State> = dfa.states().collect();
    let mut apart = BTreeSet::new();
    loop {
        let before = apart.len();
        for &p in &states {
            for &q in &states {
                let here = (dfa.accepting == Some(p)) != (dfa.accepting == Some(q));
                let later = letters.all().any(|letter| {
                    apart.contains(&(letters.next(dfa, p, letter), letters.next(dfa, q, letter)))
                });
                if here || later {
                    apart.insert((p, q));
                }
            }
        }
        if apart.len() == before {
            return states
                .iter()
                .all(|&p| states.iter().all(|&q| p == q || apart.contains(&(p, q))));
        }
    }
}

fn covers(cubes: &[Cube], valuation: u32) -> bool {
    let holds = |&(p, value): &(u32, bool)| (valuation >> p & 1 == 1) == value;
    cubes.iter().any(|cube| cube.iter().all(holds))
}

/// That cubes are what `wanted` says, and that none of them, and no literal, can be left out.
fn exact(cubes: &[Cube], count: usize, wanted: impl Fn(u32) -> bool) -> Result<(), TestCaseError> {
    let all = 0..1_u32 << count;
    prop_assert!(all.clone().all(|v| covers(cubes, v) == wanted(v)), "{cubes:?}");
    for at in 0..cubes.len() {
        let mut fewer = cubes.to_vec();
        let cube = fewer.remove(at);
        prop_assert!(
            all.clone().any(|v| wanted(v) && !covers(&fewer, v)),
            "{cube:?} is not needed"
        );
        for literal in 0..cube.len() {
            let mut wider = cube.clone();
            wider.remove(literal);
            let wider = [wider];
            prop_assert!(
                all.clone().any(|v| covers(&wider, v) && !wanted(v)),
                "{cube:?} is too long"
            );
        }
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 300, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn verdicts_and_robustness(bytes in bytes(), choices in bytes()) {
        let formula = chosen(&bytes, 14);
        agree(&formula, &random::trace(&mut Bytes(&choices), 9))?;
    }

    #[test]
    fn products(first in bytes(), second in bytes(), third in bytes(), traces in prop::collection::vec(letters(), 4)) {
        let formulas = [first, second, third].map(|bytes| chosen(&bytes, 5));
        let operands = formulas.each_ref().map(|formula| minimize(&raw(formula)));
        let operands = [&operands[0], &operands[1], &operands[2]];
        for (operator, symbol) in [(Operator::And, "&&"), (Operator::Or, "||")] {
            let product = product(operator, &operands);
            let [a, b, c] = &formulas;
            let whole = format!("({a}) {symbol} ({b}) {symbol} ({c})");
            for trace in &traces {
                let each = operands.map(|dfa| accepts(dfa, trace));
                let expected = match operator {
                    Operator::And => each.iter().all(|accepts| *accepts),
                    Operator::Or => each.iter().any(|accepts| *accepts),
                };
                prop_assert_eq!(accepts(&product.dfa, trace), expected, "{}", whole);
            }
            let (minimal, direct) = (minimize(&product.dfa), minimize(&raw(&whole)));
            prop_assert_eq!(text::automaton("", &minimal), text::automaton("", &direct), "{}", whole);
            prop_assert_eq!(product.components.len(), product.dfa.len());
        }
    }

    #[test]
    fn minimal_is_minimal(bytes in bytes()) {
        let formula = chosen(&bytes, 9);
        let minimal = minimize(&raw(&formula));
        prop_assume!(minimal.len() <= 24);
        prop_assert!(all_apart(&minimal), "{}", formula);
        let reached: BTreeSet<State> =
            minimal.states().flat_map(|q| minimal.successors(q)).chain([0]).collect();
        prop_assert_eq!(reached.len(), minimal.len());
    }

    #[test]
    fn guards_are_the_edges_and_no_longer_than_needed(bytes in bytes()) {
        let minimal = minimize(&raw(&chosen(&bytes, 10)));
        prop_assume!(minimal.len() <= 40);
        let count = minimal.propositions.len();
        let mut guards = Guards::new(&minimal);
        for q in minimal.states() {
            let moves = |v: u32| minimal.next(q, |p| v >> p & 1 == 1);
            for to in minimal.successors(q) {
                exact(&guards.edge(q, to), count, |v| moves(v) == to)?;
            }
            let on = |v: u32| moves(v) != q && minimal.trap != Some(moves(v));
            exact(&guards.progress(q), count, on)?;
        }
    }

    #[test]
    fn emitted_tables_are_the_automaton(bytes in bytes()) {
        let minimal = minimize(&raw(&chosen(&bytes, 8)));
        prop_assume!(minimal.len() <= 64);
        prop_assert_eq!(emitted(&minimal), tables(&minimal));
        let automaton = automaton(&minimal).unwrap();
        let names: Vec<&str> = automaton.propositions().iter().map(|name| &**name).collect();
        prop_assert_eq!(&minimal.propositions, &names);
        prop_assert_eq!((automaton.states() as usize, automaton.accepting(), automaton.trap()), (minimal.len(), minimal.accepting, minimal.trap));
        let distances = minimal.distances();
        for q in minimal.states() {
            for v in 0..1_u32 << minimal.propositions.len() {
                let next = automaton.next(q, |p| Ok::<_, ()>(v >> p & 1 == 1)).unwrap();
                prop_assert_eq!(next, minimal.next(q, |p| v >> p & 1 == 1));
                let edges = automaton.edges_from(q);
                let taken: Vec<_> = edges.filter(|edge| edge.guard.holds(|p| v >> p & 1 == 1)).map(|edge| edge.to).collect();
                prop_assert_eq!(taken, vec![next]);
                let on = next != q && minimal.trap != Some(next);
                prop_assert_eq!(automaton.progress(q).holds(|p| v >> p & 1 == 1), on);
            }
            prop_assert_eq!(automaton.distance(q), distances[q as usize]);
        }
    }
}
