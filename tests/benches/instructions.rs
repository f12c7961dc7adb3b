//! One thing at a time, for counting its instructions.
//!
//! `valgrind --tool=callgrind target/release/deps/instructions-… F 100000`, then with 200000: the
//! difference is that of 100,000 samples. Without arguments it runs each and compares the answers.
//! `docs/speed.md` has the counts.

use std::hint::black_box;

use tltl::{Acceptor, Task};

mod signals;
use signals::*;

fn main() {
    let mut arguments = std::env::args().skip(1).filter(|argument| !argument.starts_with("--"));
    let what = arguments.next();
    let count = arguments.next().map_or(1000, |count| count.parse().expect("a number of samples"));
    // As many samples are made whatever the count, so that making them does not count.
    let samples = samples(200_000);
    let wide = wide(&samples);
    let (samples, wide) = (&samples[..count], &wide[..count]);
    let is_chosen = |name: &str| what.as_deref().is_none_or(|what| what == name);
    robustness(samples, is_chosen);
    for name in ["step", "run", "batch", "eight"] {
        if is_chosen(name) {
            let last = black_box(steps(samples, wide, name));
            assert!(count != 1000 || last == moved(samples, wide, name), "{name}");
        }
    }
}

/// Robustness, at every instant and online: the same formula gives the same.
fn robustness(samples: &[Sample], is_chosen: impl Fn(&str) -> bool) {
    macro_rules! each {
        ($($name:literal $signal:literal $online:literal $task:ident;)*) => {$(
            if is_chosen($name) {
                black_box($task().robustness(black_box(samples)).unwrap());
            }
            if is_chosen($signal) {
                let mut signal = vec![0.0; samples.len()];
                $task().robustness_signal(black_box(samples), &mut signal).unwrap();
                black_box(signal[0]);
            }
            if is_chosen($online) {
                static TASK: Task<$task> = $task();
                let (mut online, mut all) = (TASK.online(), 0.0);
                for sample in black_box(samples) {
                    let interval = online.step(sample).unwrap();
                    all += interval.lower.max(-9.0) + interval.upper.min(9.0);
                }
                black_box(all);
                if samples.len() == 1000 {
                    assert_eq!(online.interval().lower, $task().robustness(samples).unwrap());
                }
            }
        )*};
    }
    each! {
        "F" "signal-F" "online-F" both;
        "U" "signal-U" "online-U" until;
        "F-F" "signal-F-F" "online-F-F" nested;
        "F1000" "signal-F1000" "online-F1000" soon;
        "U100" "signal-U100" "online-U100" until_soon;
    }
}

fn wide(samples: &[Sample]) -> Vec<Eight> {
    samples.iter().map(|s| [s.x + 0.5, s.y, s.x, s.y, s.x + 0.5, s.y, s.x, s.y]).collect()
}

/// The last state.
fn steps(samples: &[Sample], wide: &[Eight], name: &str) -> u32 {
    static TASK: Task<thrice> = thrice();
    static CHAIN: Task<chain> = chain();
    let task = &TASK;
    match name {
        "step" => {
            let mut q = 0;
            for sample in black_box(samples) {
                q = task.next(q, sample).unwrap();
            }
            q
        }
        "run" => {
            let mut run = task.run();
            for sample in black_box(samples) {
                run.step(sample).unwrap();
            }
            run.state()
        }
        "batch" => {
            let mut q = vec![1; samples.len()];
            let samples = &black_box(samples)[..q.len()];
            task.step_batch_of(&mut q, |i| samples[i]).unwrap();
            q[samples.len() - 1]
        }
        _ => {
            let mut q = 0;
            for s in black_box(wide) {
                q = CHAIN.next(q, s).unwrap();
            }
            q
        }
    }
}

/// The same by the automaton as data.
fn moved(samples: &[Sample], wide: &[Eight], name: &str) -> u32 {
    let (automaton, task) = (thrice(), chain());
    let next = |q, s: &Sample| {
        let holds = |i: usize| Ok::<_, ()>([s.x > 0.999, s.y > 2.999][i]);
        automaton.automaton().next(q, holds).unwrap()
    };
    match name {
        "batch" => next(1, &samples[samples.len() - 1]),
        "eight" => wide.iter().fold(0, |q, s| {
            let holds = |i: usize| Ok::<_, ()>(s[i] > 1.9);
            if task.is_accepting(q) { q } else { task.automaton().next(q, holds).unwrap() }
        }),
        _ => samples.iter().fold(0, next),
    }
}
