//! Predicates read without Rust agree with the generated code, bit for bit.

use proptest::prelude::*;
use tltl::robustness::Predicates;
use tltl::tltl;
use tltl::{Acceptor, Task};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Columns, Evaluator, Scratch, run};
use tltlc::semantics;

/// The same file as the macro has it.
mod arm {
    tltl::include_tltl!("data/tasks/arm.tltl", mod = tasks);
    pub(crate) use tasks::*;
}

use arm::{Arm, Point};

fn compiled() -> Compiled {
    let source = Source::new("arm.tltl", include_str!("data/tasks/arm.tltl"));
    compile::file(&source, Budget::default()).unwrap()
}

fn number() -> impl Strategy<Value = f64> {
    let corner = vec![0.0, -0.0, 1.0, -1.0, 1.5, 3.0, f64::INFINITY, f64::NEG_INFINITY];
    prop_oneof![1 => prop::sample::select(corner), 2 => -4.0..4.0]
}

fn state() -> impl Strategy<Value = Arm> {
    let point = || (number(), number()).prop_map(|(x, y)| Point { x, y: y as f32 });
    let whole = prop_oneof![-3..3_i64, Just(i64::MAX), Just((1 << 53) + 1)];
    let joints = [number(), number(), number()];
    let parts = (point(), joints, [point(), point()], any::<bool>(), any::<u8>(), whole, number());
    parts.prop_map(|(hand, joints, via, holding, tick, step, entry)| Arm {
        hand,
        joints,
        via,
        holding,
        tick,
        step,
        r#in: entry as f32,
    })
}

/// The input of that name.
fn field(arm: &Arm, name: &str) -> f64 {
    match name {
        "hand.x" => arm.hand.x,
        "hand.y" => arm.hand.y.into(),
        "joints[0]" => arm.joints[0],
        "joints[1]" => arm.joints[1],
        "joints[2]" => arm.joints[2],
        "via[0].x" => arm.via[0].x,
        "via[1].y" => arm.via[1].y.into(),
        "holding" => f64::from(u8::from(arm.holding)),
        "tick" => arm.tick.into(),
        "step" => arm.step as f64,
        "in" => arm.r#in.into(),
        other => panic!("no field {other}"),
    }
}

/// The robustness of each predicate as generated code has it; nothing if one is not a number.
fn generated<P: Predicates<Arm>>(task: &Task<P>, arm: &Arm) -> Option<Vec<u64>> {
    for q in 0..task.states() {
        let numbers = (0..task.automaton().propositions().len())
            .all(|i| task.predicate_robustness(i, arm).is_ok());
        assert_eq!(task.next(q, arm).is_ok(), numbers, "{arm:?}");
    }
    let rho = |i| task.predicate_robustness(i, arm).ok().map(f64::to_bits);
    (0..task.automaton().propositions().len()).map(rho).collect()
}

fn agree<P: Predicates<Arm>>(compiled: &Compiled, task: &Task<P>, trajectory: &[Arm]) {
    let place = |name: Option<&str>| name == Some(task.name());
    let tasks = &compiled.module.tasks;
    let at = tasks.iter().position(|task| place(task.name.as_deref())).unwrap();
    let evaluator = Evaluator::new(&compiled.module, &tasks[at]).unwrap();
    let names: Vec<_> = evaluator.inputs().iter().map(|input| input.name.as_str()).collect();
    let row = |arm| names.iter().map(move |name| field(arm, name));
    let numbers: Vec<f64> = trajectory.iter().flat_map(row).collect();
    let mut scratch = Scratch::default();
    let mut length = trajectory.len();
    let width = evaluator.propositions();
    let mut rho = vec![0.0; length * width];
    let columns =
        |length| Columns::of_rows(length, names.len(), &numbers[..length * names.len()]).unwrap();
    if let Err(nan) = evaluator.rho(&columns(length), &mut scratch, &mut rho) {
        let arm = &trajectory[nan.row];
        assert!(task.predicate_robustness(nan.predicate as usize, arm).is_err(), "{arm:?}");
        assert!((0..nan.predicate).all(|p| task.predicate_robustness(p as usize, arm).is_ok()));
        length = nan.row;
    }
    for (arm, rho) in trajectory[..length].iter().zip(rho.chunks(width)) {
        let rho: Vec<_> = rho.iter().map(|rho| rho.to_bits()).collect();
        assert_eq!(Some(rho), generated(task, arm), "{arm:?}");
    }
    let trajectory = &trajectory[..length];
    let robustness = evaluator.robustness(&columns(length), &mut scratch).unwrap();
    assert_eq!(robustness.to_bits(), task.robustness(trajectory).unwrap().to_bits());
    let of = |p: u32, t: usize| rho[t * width + p as usize];
    assert_eq!(semantics::robustness(&tasks[at].spec, length, of), robustness);
    let mut labels = vec![false; length * width];
    evaluator.labels(&columns(length), &mut scratch, &mut labels).unwrap();
    let mut q = 0;
    for (row, arm) in run(&compiled.automata[at].dfa, length, &labels, &rho).iter().zip(trajectory)
    {
        assert_eq!(row.progress, task.progress_robustness(q, arm).unwrap(), "{arm:?}");
        q = task.next(q, arm).unwrap();
        assert_eq!(row.state, q, "{arm:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn with_and_without_rust(trajectory in prop::collection::vec(state(), 1..6)) {
        let compiled = compiled();
        agree(&compiled, &arm::pick(), &trajectory);
        agree(&compiled, &arm::bend(), &trajectory);
        agree(&compiled, &arm::shapes(), &trajectory);
        agree(&compiled, &arm::edges(), &trajectory);
    }
}

#[test]
fn rust_code_is_refused() {
    for text in ["|s: &Grid| F (s.x < 3)", "F a && F b", "|s: &Grid| F { s.ok() }"] {
        let source = Source::new("tltl!", text);
        let compiled = compile::fragment(&source, Budget::default()).unwrap();
        assert!(Evaluator::new(&compiled.module, &compiled.module.tasks[0]).is_err(), "{text}");
    }
}

#[test]
fn a_bare_formula_reads_propositions_and_variables() {
    let source = Source::new("formula", "a && x < y && (x < 3 || !a)");
    let compiled = compile::formula(&source, Budget::default()).unwrap();
    let evaluator = Evaluator::new(&compiled.module, &compiled.module.tasks[0]).unwrap();
    let names: Vec<_> = evaluator.inputs().iter().map(|input| input.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "a"]);
    let columns = Columns::of_rows(1, 3, &[1.0, 1.0, 0.0]).unwrap();
    let (mut rho, mut labels, mut scratch) = ([0.0; 3], [true; 3], Scratch::default());
    evaluator.rho(&columns, &mut scratch, &mut rho).unwrap();
    assert_eq!(rho, [0.0, 0.0, 2.0]);
    evaluator.labels(&columns, &mut scratch, &mut labels).unwrap();
    assert_eq!(labels, [false, false, true]);
    let phi = tltl! { |s: &[f64; 3]| F (s[0] < s[1]) };
    assert_eq!(phi.robustness(&[[1.0, 1.0, 0.0]]).unwrap(), 0.0);
}
