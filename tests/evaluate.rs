//! Predicates read without Rust agree with the generated code, bit for bit.

use proptest::prelude::*;
use tltl::Task;
use tltl::robustness::Predicates;
use tltl::tltl;
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Evaluator, Reading, run};
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

/// What generated code says of a state; nothing if a predicate is not a number.
fn generated<P: Predicates<Arm>>(task: &Task<P>, arm: &Arm) -> Option<Reading> {
    let mut reading = Reading::default();
    for i in 0..task.automaton().propositions.len() {
        reading.robustness.push(task.predicate_robustness(i, arm).ok()?);
    }
    for q in 0..task.automaton().states {
        task.next(q, arm).unwrap();
    }
    Some(reading)
}

fn agree<P: Predicates<Arm>>(compiled: &Compiled, task: &Task<P>, trajectory: &[Arm]) {
    let place = |name: Option<&str>| name == Some(task.name());
    let tasks = &compiled.module.tasks;
    let at = tasks.iter().position(|task| place(task.name.as_deref())).unwrap();
    let mut evaluator = Evaluator::new(&compiled.module, &tasks[at]).unwrap();
    let names: Vec<_> = evaluator.inputs().iter().map(|input| input.name.clone()).collect();
    let mut readings = Vec::new();
    for arm in trajectory {
        let inputs: Vec<f64> = names.iter().map(|name| field(arm, name)).collect();
        let (read, expected) = (evaluator.read(&inputs).ok(), generated(task, arm));
        let bits = |reading: &Reading| -> Vec<u64> {
            reading.robustness.iter().map(|rho| rho.to_bits()).collect()
        };
        assert_eq!(read.as_ref().map(bits), expected.as_ref().map(bits), "{arm:?}");
        let Some(read) = read else { break };
        readings.push(read);
    }
    let trajectory = &trajectory[..readings.len()];
    let rho = |p: u32, t: usize| readings[t].robustness[p as usize];
    let robustness = semantics::robustness(&tasks[at].spec, readings.len(), rho);
    assert_eq!(robustness, task.robustness(trajectory).unwrap());
    let mut q = 0;
    for (row, arm) in run(&compiled.automata[at].dfa, readings).iter().zip(trajectory) {
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
    let mut evaluator = Evaluator::new(&compiled.module, &compiled.module.tasks[0]).unwrap();
    let names: Vec<_> = evaluator.inputs().iter().map(|input| input.name.as_str()).collect();
    assert_eq!(names, ["x", "y", "a"]);
    let read = evaluator.read(&[1.0, 1.0, 0.0]).unwrap();
    assert_eq!(read.robustness, [0.0, 0.0, 2.0]);
    assert_eq!(read.holds, [false, false, true]);
    let phi = tltl! { |s: &[f64; 3]| F (s[0] < s[1]) };
    assert_eq!(phi.robustness(&[[1.0, 1.0, 0.0]]).unwrap(), 0.0);
}
