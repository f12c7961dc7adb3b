//! Automata of other tools in the place of a formula.

use tltl::{Acceptor, include_tltl, tltl};

include_tltl!("data/avoid.hoa");

#[test]
fn an_automaton_file_is_a_task() {
    let hazard = |s: &(f64, f64)| s.0;
    let goal = |s: &(f64, f64)| s.1;
    let read = avoid::task(hazard, goal);
    let written = tltl! { !hazard U goal };
    assert_eq!(read.name(), "until");
    assert_eq!(read.states(), written.states());
    let values = [-2.0, -0.5, 0.0, 1.0, 3.0];
    for i in 0..625 {
        let value = |k: u32| values[i / 5_usize.pow(k) % 5];
        let trace = [(value(0), value(1)), (value(2), value(3))];
        let satisfied = written.satisfied(&trace).unwrap();
        assert_eq!(read.satisfied(&trace), Ok(satisfied));
        let rho = read.robustness(&trace).unwrap();
        assert!(if satisfied { rho >= 0.0 } else { rho <= 0.0 }, "{trace:?}: {rho}");
    }
    assert_eq!(read.robustness(&[] as &[(f64, f64)]), Ok(f64::NEG_INFINITY));
}
