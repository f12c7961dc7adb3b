//! Steps, monitors, batches and robustness of compiled tasks allocate nothing.
//!
//! A test of its own, for its allocator counts.

use allocation_counter::measure;
use tltl::{Acceptor, tltl};

#[derive(Clone, Copy)]
struct Sample {
    x: f64,
    y: f64,
}

tltl! {
    state s: Sample;
    task both = F (s.x > 0 && s.y < 1);
    task timed = F (s.x > 1 && F[0,100] s.y < 0) && s.x > -3 U[2,50] s.y < -1;
    task ordered = s.x > 0 T s.y > 0 T s.x > 1 T s.y > 1 T s.x > 2 T s.y > 2;
    task many = s.x > 0 T s.y > 0 T s.x > 1 T s.y > 1 T s.x > 2 T s.y > 2 T s.x > 3 T s.y > 3
        T s.x > 4 T s.y > 4 T s.x > 5 T s.y > 5;
    #[factored]
    task apart = F s.x > 1 && F s.y > 1 && F s.x > 2;
}

fn samples() -> Vec<Sample> {
    let number = |i: u32| f64::from(i * 7919 % 997) / 200.0 - 2.0;
    (0..1000).map(|i| Sample { x: number(i), y: number(i + 401) }).collect()
}

macro_rules! allocates_nothing {
    ($($task:ident)*) => {$({
        let (task, samples) = ($task(), samples());
        let (mut q, mut signal) = (vec![0; samples.len()], vec![0.0; samples.len()]);
        let mut answers = (0, 0.0, 0.0, None);
        let counted = measure(|| {
            let (mut one, mut run, mut online) = (0, task.run(), task.online());
            for s in &samples {
                one = task.next(one, s).unwrap();
                run.step(s).unwrap();
                answers.1 = online.step(s).unwrap().lower;
                task.progress_robustness(one, s).unwrap();
            }
            task.step_batch(&mut q, &samples).unwrap();
            task.step_batch_of(&mut q, |i| samples[i]).unwrap();
            task.robustness_signal(&samples, &mut signal).unwrap();
            answers.2 = task.robustness(&samples).unwrap();
            answers.0 = one;
            answers.3 = run.verdict();
        });
        assert_eq!(counted.count_total, 0, stringify!($task));
        assert_eq!((answers.1, signal[0]), (answers.2, answers.2));
        assert_eq!(answers.3 == Some(true), task.is_accepting(answers.0));
    })*};
}

#[test]
fn compiled_tasks_allocate_nothing() {
    allocates_nothing! { both timed ordered many }
}

#[test]
fn factored_tasks_step_without_allocation() {
    let (task, samples) = (apart(), samples());
    let mut q = vec![0; task.len()];
    let counted = measure(|| samples.iter().for_each(|s| task.next(&mut q, s).unwrap()));
    assert_eq!(counted.count_total, 0);
    assert!(task.is_accepting(&q));
}

#[test]
fn the_allocator_counts() {
    assert_eq!(measure(|| drop(std::hint::black_box(Box::new(1)))).count_total, 1);
}
