//! A random formula on random traces: the raw and the minimal automaton agree with the semantics
//! at every instant, and so does the sign of the robustness.
use super::BUDGET;
use crate::random::{self, Bytes, Choices, NAMES};
use tltl_compiler::check;
use tltl_compiler::minimize::minimize;
use tltl_compiler::source::Source;
use tltl_compiler::translate::translate;
use tltlc::semantics;

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let mut choices = Bytes(bytes);
    let names = 1 + choices.choose(NAMES.len() as u32);
    let operators = choices.choose(31);
    let text = random::formula(&mut choices, names, operators);
    let module = check::formula(&Source::new("formula", text.as_str())).expect("it is co-safe");
    let spec = &module.tasks[0].spec;
    let Ok(raw) = translate(spec, BUDGET) else { return };
    let minimal = minimize(&raw);
    let places = random::places(spec.propositions());
    for _ in 0..3 {
        let trace = random::trace(&mut choices, 10);
        let rho = |p: u32, t: usize| trace[t][places[p as usize]];
        let (mut q, mut q_minimal) = (0, 0);
        for length in 1..=trace.len() {
            q = raw.next(q, |p| rho(p, length - 1) > 0.0);
            q_minimal = minimal.next(q_minimal, |p| rho(p, length - 1) > 0.0);
            let holds = semantics::satisfied(spec, length, |p, t| rho(p, t) > 0.0);
            assert_eq!(raw.accepting == Some(q), holds, "{text} on {trace:?} up to {length}");
            assert_eq!(minimal.accepting == Some(q_minimal), holds, "{text}, minimal");
            let robust = semantics::robustness(spec, length, rho);
            assert!(robust != 0.0 && (robust > 0.0) == holds, "{text} on {trace:?}: {robust}");
        }
    }
}
