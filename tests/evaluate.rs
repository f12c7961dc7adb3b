//! Predicates read without Rust agree with the generated code, bit for bit.

use std::sync::LazyLock;

use proptest::prelude::*;
use tltl::robustness::Predicates;
use tltl::{Acceptor, Monitor, Task, tltl};
use tltl_compiler::compile;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Columns, Evaluator, Scratch};
use tltlc::task::{Bound, Task as RunTime, TaskFile, Verdict};

/// The same file as the macro has it.
mod arm {
    tltl::include_tltl!("data/tasks/arm.tltl", mod = tasks);
    pub(crate) use tasks::*;
}

use arm::{Arm, Point};

static FILE: LazyLock<TaskFile> = LazyLock::new(|| {
    let source = Source::new("arm.tltl", include_str!("data/tasks/arm.tltl"));
    TaskFile::new(source, Budget::default()).unwrap()
});

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

/// That the task of the file, without a Rust compiler, says what its generated code does.
fn agree<P: Predicates<Arm>>(file: &TaskFile, generated: &Task<P>, trajectory: &[Arm]) {
    let Bound::Plain(task) = file.find(Some(generated.name())).unwrap().bind(&[]).unwrap() else {
        panic!("{} is factored", generated.name());
    };
    assert_eq!(task.automaton(), generated.automaton());
    let row = |arm: &Arm| -> Vec<f64> {
        task.inputs().iter().map(|input| field(arm, &input.name)).collect()
    };
    let rows: Vec<_> = trajectory.iter().map(row).collect();
    for (arm, row) in trajectory.iter().zip(&rows) {
        for q in 0..generated.states() {
            assert_eq!(task.next(q, row), generated.next(q, arm), "{arm:?}");
            let here = task.progress_robustness(q, row);
            assert_eq!(here, generated.progress_robustness(q, arm), "{arm:?}");
            let here = task.trap_robustness(q, row);
            assert_eq!(here, Monitor::trap_robustness(generated, q, arm), "{arm:?}");
        }
    }
    let whole = task.trajectory_robustness(&rows);
    // Of more than one predicate that is not a number, either may be named.
    assert_eq!(whole.ok(), generated.robustness(trajectory).ok());
    by_columns(&task, generated, trajectory, &rows);
}

fn by_columns<P: Predicates<Arm>>(
    task: &RunTime,
    generated: &Task<P>,
    trajectory: &[Arm],
    rows: &[Vec<f64>],
) {
    let (numbers, width) = (rows.concat(), task.inputs().len());
    let columns = |length| Columns::of_rows(length, width, &numbers[..length * width]).unwrap();
    let mut scratch = Scratch::default();
    let mut length = trajectory.len();
    if let Err(nan) = task.run(&columns(length), &mut scratch) {
        let arm = &trajectory[nan.row];
        let is_number = |p: u32| generated.predicate_robustness(p as usize, arm).is_ok();
        assert!(!is_number(nan.predicate) && (0..nan.predicate).all(is_number), "{arm:?}");
        length = nan.row;
    }
    let trajectory = &trajectory[..length];
    let run = task.run(&columns(length), &mut scratch).unwrap();
    assert_eq!(run.robustness.to_bits(), generated.robustness(trajectory).unwrap().to_bits());
    let predicates = task.evaluator().propositions();
    let mut rho = vec![0.0; length * predicates];
    task.evaluator().rho(&columns(length), &mut scratch, &mut rho).unwrap();
    let mut q = 0;
    for (t, arm) in trajectory.iter().enumerate() {
        for (i, rho) in rho[t * predicates..][..predicates].iter().enumerate() {
            let expected = generated.predicate_robustness(i, arm).unwrap();
            assert_eq!(rho.to_bits(), expected.to_bits(), "{arm:?}");
        }
        assert_eq!(run.progress[t], generated.progress_robustness(q, arm).unwrap(), "{arm:?}");
        q = generated.next(q, arm).unwrap();
        assert_eq!(run.states[t], q, "{arm:?}");
        let ends = [Verdict::Satisfied, Verdict::Lost].map(|end| run.verdicts[t] == end);
        assert_eq!(ends, [generated.is_accepting(q), generated.is_trap(q)], "{arm:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn with_and_without_rust(trajectory in prop::collection::vec(state(), 1..6)) {
        agree(&FILE, &arm::pick(), &trajectory);
        agree(&FILE, &arm::bend(), &trajectory);
        agree(&FILE, &arm::shapes(), &trajectory);
        agree(&FILE, &arm::edges(), &trajectory);
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
