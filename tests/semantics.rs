//! Every formula of the corpus on every engine: the trace semantics, the raw automaton, the minimal
//! automaton, the automaton after a round through HOA, and the static tables that the macro makes.

use std::collections::HashMap;

use sha2::{Digest, Sha256};
use tltl::robustness::{NotANumber, Predicates};
use tltl::{Acceptor, Task};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::Dfa;
use tltl_compiler::hoa;
use tltl_compiler::proposition::Proposition;
use tltl_compiler::source::Source;
use tltl_compiler::spec::Spec;
use tltl_compiler::translate::{Budget, translate};
use tltlc::emit::hoa as emit_hoa;
use tltlc::{semantics, tables};

use crate::corpus::{Row, Trace, rejects, rows};
use crate::static_corpus::{self, Letter};

fn compiled(formula: &str) -> Compiled {
    compile::formula(&Source::new("formula", formula), Budget::default())
        .unwrap_or_else(|errors| panic!("{formula}: {errors}"))
}

/// Where the row has each proposition of the tool.
fn places(row: &Row, propositions: &[Proposition]) -> Vec<usize> {
    let place = |one: &Proposition| row.aps.iter().position(|ap| *ap == one.name).unwrap();
    propositions.iter().map(place).collect()
}

/// The letters read when `dfa` first accepts a trace.
fn first_accept(dfa: &Dfa, places: &[usize], letters: &[u64]) -> Option<usize> {
    let mut q = 0;
    for (read, letter) in letters.iter().enumerate() {
        if dfa.accepting == Some(q) {
            return Some(read);
        }
        q = dfa.next(q, |p| letter >> places[p as usize] & 1 == 1);
    }
    (dfa.accepting == Some(q)).then_some(letters.len())
}

fn satisfied(spec: &Spec, places: &[usize], letters: &[u64]) -> bool {
    let holds = |p: u32, t: usize| letters[t] >> places[p as usize] & 1 == 1;
    semantics::satisfied(spec, letters.len(), holds)
}

/// The table of all transitions in the corpus's numbering: breadth-first, letters rising.
fn table(dfa: &Dfa, row: &Row, places: &[usize]) -> (Vec<Vec<u32>>, Vec<u32>) {
    let mut order = vec![0];
    let mut number = HashMap::from([(0, 0)]);
    let mut rows = Vec::new();
    while let Some(&q) = order.get(rows.len()) {
        let next = |letter: u64| {
            let to = dfa.next(q, |p| letter >> places[p as usize] & 1 == 1);
            *number.entry(to).or_insert_with(|| {
                order.push(to);
                order.len() as u32 - 1
            })
        };
        rows.push((0..1_u64 << row.aps.len()).map(next).collect());
    }
    (rows, dfa.accepting.iter().map(|q| number[q]).collect())
}

#[test]
fn automata_equal_the_corpus() {
    for row in rows() {
        let compiled = compiled(&row.formula);
        let dfa = &compiled.automata[0].dfa;
        let places = places(&row, &dfa.propositions);
        let size = dfa.size();
        assert_eq!(
            (size.states, size.edges, size.self_loops, size.trap),
            (row.states, row.edges, row.self_loops, row.trap.is_some()),
            "{}: {}",
            row.id,
            row.formula
        );
        let (transitions, accepting) = table(dfa, &row, &places);
        assert_eq!(accepting, row.accepting, "{}: {}", row.id, row.formula);
        if let Some(expected) = &row.transitions {
            assert_eq!(&transitions, expected, "{}: {}", row.id, row.formula);
        }
        let json = serde_json::to_string(&(transitions, accepting)).unwrap();
        let hash = Sha256::digest(json.as_bytes());
        let hash: String = hash.iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(hash, row.sha256, "{}: {}", row.id, row.formula);
    }
}

#[test]
fn every_engine_gives_the_verdicts_of_the_corpus() {
    for row in rows() {
        let compiled = compiled(&row.formula);
        let spec = &compiled.module.tasks[0].spec;
        let minimal = &compiled.automata[0].dfa;
        let raw = translate(spec, Budget::default()).unwrap();
        let written = emit_hoa::automaton(&row.formula, minimal).unwrap().to_string();
        let read = hoa::read(&Source::new("hoa", written)).unwrap();
        let places = places(&row, spec.propositions());
        for Trace { letters, accept, first_accept: expected } in &row.traces {
            let about = format!("{}: {} on {letters:?}", row.id, row.formula);
            assert_eq!(satisfied(spec, &places, letters), *accept, "semantics, {about}");
            for (engine, dfa) in [("raw", &raw), ("minimal", minimal), ("HOA", &read.dfa)] {
                assert_eq!(first_accept(dfa, &places, letters), *expected, "{engine}, {about}");
            }
        }
    }
}

/// The propositions of an owned task, by name.
#[derive(Clone)]
struct Named(Vec<Proposition>);

impl Predicates<Letter> for Named {
    fn robustness(&self, i: usize, letter: &Letter) -> f64 {
        let place = letter.aps.iter().position(|ap| *ap == self.0[i].name).unwrap();
        if letter.bits >> place & 1 == 1 { 1.0 } else { -1.0 }
    }

    fn holds(&self, i: usize, letter: &Letter) -> Result<bool, NotANumber> {
        Ok(self.robustness(i, letter) > 0.0)
    }
}

/// The task that a program owns which compiles the formula while it runs.
fn owned(compiled: &Compiled) -> Task<Named> {
    let task = &compiled.module.tasks[0];
    let automaton = tables::automaton(&compiled.automata[0].dfa).unwrap();
    let formula = tables::formula(&task.spec, &task.text).unwrap();
    let names = Named(task.spec.propositions().to_vec());
    Task::new(task.text.clone(), formula, automaton, names).unwrap()
}

/// The macro's static tables and those of a program that compiles while it runs are the same, and say
/// the same.
#[test]
fn static_and_owned_tables_give_the_verdicts_of_the_corpus() {
    for row in rows() {
        let compiled = compiled(&row.formula);
        let spec = &compiled.module.tasks[0].spec;
        let places = places(&row, spec.propositions());
        let owned = owned(&compiled);
        for Trace { letters, accept, .. } in &row.traces {
            let about = format!("{}: {} on {letters:?}", row.id, row.formula);
            let trace: Vec<Letter> =
                letters.iter().map(|&bits| Letter { aps: row.aps.clone(), bits }).collect();
            let verdict = static_corpus::verdict(&row.id, &trace);
            assert_eq!(verdict.satisfied, *accept, "{about}");
            let rho = |p: u32, t: usize| {
                if letters[t] >> places[p as usize] & 1 == 1 { 1.0 } else { -1.0 }
            };
            let expected = semantics::robustness(spec, letters.len(), rho);
            assert_eq!(verdict.robustness, expected, "robustness, {about}");
            assert_eq!(verdict.automaton.states() as usize, row.states, "{about}");
            assert_eq!(static_corpus::judge(owned.clone(), &trace), verdict, "{about}");
        }
    }
}

#[test]
fn what_is_outside_the_language_is_refused_for_its_reason() {
    for reject in rejects() {
        let result =
            compile::formula(&Source::new("formula", reject.formula.as_str()), Budget::default());
        let kind = result.as_ref().map_or_else(|errors| errors.first().kind().name(), |_| "ok");
        let kind = match kind {
            "negated-temporal" | "ok" => kind,
            _ => "syntax",
        };
        assert_eq!(kind, reject.expect, "{}", reject.formula);
    }
}
