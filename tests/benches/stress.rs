//! Random formulas on random traces, by the million: the raw and the minimal automaton against the
//! semantics at every instant, and the sign of the robustness.
//!
//! `cargo bench -p tltl-tests --bench stress [-- COUNT [SEED [OPERATORS]]]`, by default 20,000
//! formulas of up to 30 operators. A difference becomes a row of the corpus.

use std::time::Instant;

use tltl_compiler::check;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::spec::Spec;
use tltl_compiler::translate::{Budget, translate};
use tltl_fuzz::random::{self, Choices, NAMES, Seeded};
use tltlc::semantics;

const TRACES: u32 = 6;
const LONGEST: u32 = 12;

#[derive(Default)]
struct Count {
    formulas: u64,
    verdicts: u64,
    states: u64,
    largest: usize,
    beyond_budget: u64,
}

fn main() {
    let mut numbers = std::env::args().filter_map(|arg| arg.parse::<u64>().ok());
    let (formulas, seed) = (numbers.next().unwrap_or(20_000), numbers.next().unwrap_or(1));
    let operators = numbers.next().map_or(30, |operators| operators as u32);
    let mut choices = Seeded(seed);
    let mut count = Count::default();
    let start = Instant::now();
    while count.formulas < formulas {
        one(&mut choices, operators, &mut count);
        count.formulas += 1;
        if count.formulas.is_multiple_of(100_000) {
            eprintln!("{} formulas, {:.0} s", count.formulas, start.elapsed().as_secs_f64());
        }
    }
    let Count { formulas, verdicts, states, largest, beyond_budget } = count;
    println!(
        "{formulas} formulas of up to {operators} operators, seed {seed}: {verdicts} verdicts and no \
         difference; {states} states, {largest} at most, {beyond_budget} beyond the budget; {:.0} s",
        start.elapsed().as_secs_f64()
    );
}

fn one(choices: &mut Seeded, operators: u32, count: &mut Count) {
    let names = 1 + choices.choose(NAMES.len() as u32);
    let operators = 1 + choices.choose(operators);
    let text = random::formula(choices, names, operators);
    let module = check::formula(&Source::new("formula", text.as_str()))
        .unwrap_or_else(|errors| panic!("{text}: {errors}"));
    let spec = &module.tasks[0].spec;
    let Ok(raw) = translate(spec, Budget::default()) else {
        count.beyond_budget += 1;
        return;
    };
    let minimal = minimize(&raw);
    count.states += minimal.len() as u64;
    count.largest = count.largest.max(minimal.len());
    for _ in 0..TRACES {
        let trace = random::trace(choices, LONGEST);
        compare(&text, spec, [&raw, &minimal], &trace);
        count.verdicts += trace.len() as u64;
    }
}

fn compare(text: &str, spec: &Spec, automata: [&Dfa; 2], trace: &[[f64; 5]]) {
    let places = random::places(spec.propositions());
    let rho = |p: u32, t: usize| trace[t][places[p as usize]];
    let mut states = [0, 0];
    for length in 1..=trace.len() {
        let holds = semantics::satisfied(spec, length, |p, t| rho(p, t) > 0.0);
        for (q, dfa) in states.iter_mut().zip(automata) {
            *q = dfa.next(*q, |p| rho(p, length - 1) > 0.0);
            assert_eq!(dfa.accepting == Some(*q), holds, "{text} on {trace:?} up to {length}");
        }
        let robust = semantics::robustness(spec, length, rho);
        assert!(robust != 0.0 && (robust > 0.0) == holds, "{text} on {trace:?}: {robust}");
    }
}
