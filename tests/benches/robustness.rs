//! Robustness and steps of compiled tasks against loops written by hand.
//!
//! `cargo bench -p tltl-tests --bench robustness`: nanoseconds a sample, the median of some
//! repetitions, and how many times as much as the loop by hand. The loops know the formula, keep what
//! they carry in several parts so that no comparison waits for another, and do not look for NaN. Every
//! answer is compared with that of the loop before a time is printed.

use std::hint::black_box;
use std::time::Instant;

use regex_automata::Anchored;
use regex_automata::dfa::{Automaton, dense};
use regex_automata::util::syntax;
use tltl::Acceptor;

mod signals;
use signals::*;

const NONE: f64 = f64::NEG_INFINITY;

fn main() {
    println!("{:<34}{:>9}{:>10}{:>10}{:>8}", "", "samples", "by hand", "here", "times");
    for length in [1_000, 100_000, 1_000_000, 10_000_000] {
        let trajectory = samples(length);
        offline(&trajectory);
        at_every_instant(&trajectory);
    }
    many(&samples(1_000_000));
    in_threads(&samples(10_000_000));
    let trajectory = samples(4_000);
    online(&trajectory);
    steps(&trajectory);
}

/// The median nanoseconds a sample of two things, which take turns: what else the machine does meets
/// both.
fn in_turns<T, U>(
    samples: usize,
    mut one: impl FnMut() -> T,
    mut other: impl FnMut() -> U,
) -> [f64; 2] {
    let rounds = (20_000 / samples).max(1);
    let mut times = [Vec::new(), Vec::new()];
    let begin = Instant::now();
    while times[1].len() < 7 || begin.elapsed().as_secs_f64() < 0.3 {
        let start = Instant::now();
        (0..rounds).for_each(|_| drop(black_box(one())));
        let middle = Instant::now();
        (0..rounds).for_each(|_| drop(black_box(other())));
        for (times, time) in times.iter_mut().zip([middle - start, middle.elapsed()]) {
            times.push(time.as_secs_f64() * 1e9 / (rounds * samples) as f64);
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[times.len() / 2]
    })
}

fn print(name: &str, samples: usize, by_hand: f64, here: f64) {
    println!("{name:<34}{samples:>9}{by_hand:>10.2}{here:>10.2}{:>8.2}", here / by_hand);
}

/// Times both, after comparing their answers.
fn compare<T: PartialEq + std::fmt::Debug>(
    name: &str,
    samples: usize,
    mut by_hand: impl FnMut() -> T,
    mut here: impl FnMut() -> T,
) {
    assert_eq!(by_hand(), here(), "{name}");
    let [by_hand, here] = in_turns(samples, by_hand, here);
    print(name, samples, by_hand, here);
}

fn offline(trajectory: &[Sample]) {
    let (n, t) = (trajectory.len(), || black_box(trajectory));
    compare("F (x > 0 && y < 1)", n, || by_hand::both(t()), || both().robustness(t()).unwrap());
    compare("x > 0 U y < 1", n, || by_hand::until(t()), || until().robustness(t()).unwrap());
    compare(
        "F (x > 0 && F y < 1)",
        n,
        || by_hand::nested(t()),
        || nested().robustness(t()).unwrap(),
    );
    compare(
        "F[0,1000] x > 0, beside F x > 0",
        n,
        || by_hand::first(t(), 1001),
        || soon().robustness(t()).unwrap(),
    );
}

fn at_every_instant(trajectory: &[Sample]) {
    let n = trajectory.len();
    let mut signals = [vec![0.0; n], vec![0.0; n]];
    let [expected, found] = &mut signals;
    macro_rules! signal {
        ($name:literal, $task:ident) => {
            let task = $task();
            let [by_hand, here] = in_turns(
                n,
                || by_hand::every::$task(black_box(trajectory), expected),
                || task.robustness_signal(black_box(trajectory), found),
            );
            assert_eq!(expected, found, $name);
            print($name, n, by_hand, here);
        };
    }
    signal!("every t: F (x > 0 && y < 1)", both);
    signal!("every t: x > 0 U y < 1", until);
    signal!("every t: F (x > 0 && F y < 1)", nested);
}

/// A thousand trajectories of a thousand states, and a long one, by one thread and by several.
fn many(states: &[Sample]) {
    const LENGTH: usize = 1000;
    let (n, task) = (states.len(), both());
    let count = n / LENGTH;
    let by_time: Vec<Sample> = (0..n).map(|at| states[at % count * LENGTH + at / count]).collect();
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let mut found = [vec![0.0; count], vec![0.0; count]];
    let [expected, found] = &mut found;
    let mut compare_many = |name: &str, here: &dyn Fn(&mut [f64])| {
        let by_hand = || {
            let parts = black_box(states).chunks(LENGTH).zip(expected.iter_mut());
            parts.for_each(|(part, rho)| *rho = by_hand::both(part));
        };
        let [by_hand, here] = in_turns(n, by_hand, || here(found));
        assert_eq!(expected, found, "{name}");
        print(name, n, by_hand, here);
    };
    compare_many("many, one after the other", &|found| {
        task.robustness_batch(black_box(states), found).unwrap();
    });
    compare_many(&format!("the same in {threads} threads"), &|found| {
        task.robustness_batch_on(threads, black_box(states), found).unwrap();
    });
    compare_many("many, instant by instant", &|found| {
        task.robustness_batch_by_time(black_box(&by_time), found).unwrap();
    });
    let task = until();
    compare(
        &format!("x > 0 U y < 1 in {threads} threads"),
        n,
        || by_hand::until(black_box(states)),
        || task.robustness_on(threads, black_box(states)).unwrap(),
    );
}

/// What threads gain: the left column is one thread here.
fn in_threads(states: &[Sample]) {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    println!("{:<34}{:>9}{:>10}{:>10}{:>8}", "", "", "1 thread", threads, "gain");
    let gain = |name: &str, [one, several]: [f64; 2]| {
        println!("{name:<34}{:>9}{one:>10.2}{several:>10.2}{:>8.2}", states.len(), one / several);
    };
    let (n, both, until, thrice) = (states.len(), both(), until(), thrice());
    let mut found = [vec![0.0; 1000], vec![0.0; 1000]];
    let [expected, found] = &mut found;
    let times = in_turns(
        n,
        || both.robustness_batch(black_box(states), expected).unwrap(),
        || both.robustness_batch_on(threads, black_box(states), found).unwrap(),
    );
    assert_eq!(expected, found);
    gain("many: F (x > 0 && y < 1)", times);
    let whole = until.robustness(states).unwrap();
    assert_eq!(until.robustness_on(threads, states).unwrap(), whole);
    let times = in_turns(
        n,
        || until.robustness(black_box(states)).unwrap(),
        || until.robustness_on(threads, black_box(states)).unwrap(),
    );
    gain("one long: x > 0 U y < 1", times);
    let mut q = [vec![0; n], vec![0; n]];
    let [expected, found] = &mut q;
    let times = in_turns(
        n,
        || thrice.step_batch(expected, black_box(states)).unwrap(),
        || thrice.step_batch_on(threads, found, black_box(states)).unwrap(),
    );
    expected.fill(0);
    found.fill(0);
    thrice.step_batch(expected, states).unwrap();
    thrice.step_batch_on(threads, found, states).unwrap();
    assert!(expected == found);
    gain("step of many, 2 predicates", times);
}

/// The time of a state, in which the least of the interval is asked for too; by hand, that is the
/// greatest so far of x > 0 && y < 1.
fn online(trajectory: &[Sample]) {
    let n = trajectory.len();
    macro_rules! online {
        ($name:literal, $task:ident) => {
            let task = $task();
            let run = || {
                let (mut online, mut all) = (task.online(), 0.0);
                for sample in black_box(trajectory) {
                    let interval = online.step(sample).unwrap();
                    all += interval.lower.max(-9.0) + interval.upper.min(9.0);
                }
                (online.interval().lower, all)
            };
            assert_eq!(run().0, task.robustness(trajectory).unwrap(), $name);
            let [by_hand, here] = in_turns(n, || by_hand::so_far(black_box(trajectory)), run);
            print($name, n, by_hand, here);
        };
    }
    online!("online: F (x > 0 && y < 1)", both);
    online!("online: x > 0 U y < 1", until);
    online!("online: F (x > 0 && F y < 1)", nested);
    online!("online: F[0,1000] x > 0", soon);
    online!("online: x > 0 U[0,100] y < 1", until_soon);
    online!("online: F (y < 1 && F[0,1000] …)", always_soon);
}

fn steps(trajectory: &[Sample]) {
    let (n, task) = (trajectory.len(), thrice());
    assert_eq!(task.states(), 5);
    compare(
        "step, 2 predicates",
        n,
        || by_hand::steps(black_box(trajectory)),
        || {
            let (mut q, mut all) = (0, 0);
            for sample in black_box(trajectory) {
                q = task.next(q, sample).unwrap();
                all += u64::from(q);
            }
            all
        },
    );
    compare(
        "run, 2 predicates",
        n,
        || by_hand::steps(black_box(trajectory)),
        || {
            let (mut run, mut all) = (task.run(), 0);
            for sample in black_box(trajectory) {
                run.step(sample).unwrap();
                all += u64::from(run.state());
            }
            all
        },
    );
    beside_bytes(trajectory);
    let (x, y): (Vec<f64>, Vec<f64>) = trajectory.iter().map(|s| (s.x, s.y)).unzip();
    let [mut q, mut r] = [vec![0; n], vec![0; n]];
    compare(
        "step of many, from columns",
        n,
        || {
            by_hand::batch(&mut q, black_box(&x), black_box(&y));
            q[7]
        },
        || {
            let (x, y) = (&black_box(&x)[..n], &black_box(&y)[..n]);
            task.step_batch_of(&mut r, |i| Sample { x: x[i], y: y[i] }).unwrap();
            r[7]
        },
    );
    let wide: Vec<Eight> = trajectory
        .windows(4)
        .map(|four| {
            let [a, b, c, d] = [four[0], four[1], four[2], four[3]];
            [a.x + 0.5, a.y, b.x + 0.5, b.y, c.x + 0.5, c.y, d.x + 0.5, d.y]
        })
        .collect();
    let task = chain();
    let run = || {
        let (mut q, mut all) = (0, 0_u64);
        for s in black_box(&wide) {
            q = task.next(q, s).unwrap();
            all += u64::from(q);
            q = if task.is_accepting(q) { 0 } else { q };
        }
        all
    };
    compare("step, 8 predicates", wide.len(), || by_hand::chain(black_box(&wide)), run);
}

/// A step from a state of the world beside a byte of `regex-automata`, to which somebody has turned
/// the state into a byte before: bit 0 for `x > 0.999`, bit 1 for `y > 2.999`.
fn beside_bytes(trajectory: &[Sample]) {
    let pattern = r"(?s-u).*[\x01\x03][\x02\x03][\x01\x03]";
    let syntax = syntax::Config::new().utf8(false);
    let dfa = dense::Builder::new().syntax(syntax).build(pattern).expect("it is a pattern");
    let start = dfa.universal_start_state(Anchored::Yes).expect("the pattern looks at bytes only");
    let byte = |s: &Sample| u8::from(s.x > 0.999) | u8::from(s.y > 2.999) << 1;
    let task = thrice();

    let long = samples(1_000_000);
    let mut run = task.run();
    let here = long.iter().position(|sample| {
        run.step(sample).expect("no sample is NaN");
        task.is_accepting(run.state())
    });
    let mut q = start;
    let there = long.iter().map(byte).position(|byte| {
        q = dfa.next_state(q, byte);
        dfa.is_match_state(q)
    });
    assert!(here.is_some());
    // Such a machine says so one byte later.
    assert_eq!(here.map(|at| at + 1), there);

    let bytes: Vec<u8> = trajectory.iter().map(byte).collect();
    let regex = || {
        let (mut q, mut all) = (start, 0_u64);
        for &byte in black_box(&bytes) {
            q = dfa.next_state(q, byte);
            all += u64::from(q.as_u32());
        }
        all
    };
    let next = || {
        let (mut q, mut all) = (0, 0_u64);
        for sample in black_box(trajectory) {
            q = task.next(q, sample).unwrap();
            all += u64::from(q);
        }
        all
    };
    let [by_bytes, here] = in_turns(trajectory.len(), regex, next);
    print("step, beside a byte of a regex", trajectory.len(), by_bytes, here);
}

/// The same, as one writes it who knows the formula.
mod by_hand {
    use super::{Eight, NONE, Sample};

    /// The parts in which something is kept.
    const PARTS: usize = 8;

    fn max(a: f64, b: f64) -> f64 {
        if a > b { a } else { b }
    }

    fn min(a: f64, b: f64) -> f64 {
        if a < b { a } else { b }
    }

    fn near(s: &Sample) -> f64 {
        1.0 - s.y
    }

    pub(crate) fn both(trajectory: &[Sample]) -> f64 {
        let (blocks, rest) = trajectory.as_chunks::<PARTS>();
        let mut best = [NONE; PARTS];
        for block in blocks {
            for (best, s) in best.iter_mut().zip(block) {
                *best = max(min(s.x, near(s)), *best);
            }
        }
        let rest = rest.iter().map(|s| min(s.x, near(s)));
        rest.chain(best).fold(NONE, max)
    }

    /// Each part is max(goal, min(hold, what comes after)), for its own goal and hold.
    pub(crate) fn until(trajectory: &[Sample]) -> f64 {
        let n = trajectory.len() / PARTS;
        let (mut goal, mut hold) = ([NONE; PARTS], [f64::INFINITY; PARTS]);
        for i in 0..n {
            for k in 0..PARTS {
                let s = &trajectory[k * n + i];
                goal[k] = max(goal[k], min(near(s), hold[k]));
                hold[k] = min(hold[k], s.x);
            }
        }
        let rest = trajectory[PARTS * n..].iter().rev();
        let rest = rest.fold(NONE, |after, s| max(near(s), min(s.x, after)));
        (0..PARTS).rev().fold(rest, |after, k| max(goal[k], min(hold[k], after)))
    }

    /// Of each part the greatest x and 1 - y, and the robustness within it.
    pub(crate) fn nested(trajectory: &[Sample]) -> f64 {
        let n = trajectory.len() / PARTS;
        let [mut goal, mut whole, mut most] = [[NONE; PARTS]; 3];
        for i in (0..n).rev() {
            for k in 0..PARTS {
                let s = &trajectory[k * n + i];
                goal[k] = max(near(s), goal[k]);
                whole[k] = max(min(s.x, goal[k]), whole[k]);
                most[k] = max(s.x, most[k]);
            }
        }
        let rest = trajectory[PARTS * n..].iter().rev();
        let after = rest.fold((NONE, NONE), |(later, all), s| {
            let later = max(near(s), later);
            (later, max(min(s.x, later), all))
        });
        let parts = (0..PARTS).rev();
        let one = |(later, all), k: usize| {
            (max(goal[k], later), max(max(whole[k], min(most[k], later)), all))
        };
        parts.fold(after, one).1
    }

    /// The greatest x of the first `count` samples, in a pass over all.
    pub(crate) fn first(trajectory: &[Sample], count: usize) -> f64 {
        let mut best = [[NONE; PARTS]; 2];
        let (blocks, rest) = trajectory.as_chunks::<PARTS>();
        for (i, block) in blocks.iter().enumerate() {
            let best = &mut best[usize::from((i + 1) * PARTS > count)];
            for (best, s) in best.iter_mut().zip(block) {
                *best = max(s.x, *best);
            }
        }
        let whole = count.min(trajectory.len()) / PARTS * PARTS;
        let edge = trajectory.iter().take(count).skip(whole);
        let _ = rest;
        edge.map(|s| s.x).chain(best[0]).fold(NONE, max)
    }

    pub(crate) mod every {
        use super::{NONE, Sample, max, min, near};

        fn backward(trajectory: &[Sample], out: &mut [f64], mut at: impl FnMut(&Sample) -> f64) {
            out.iter_mut().zip(trajectory).rev().for_each(|(out, s)| *out = at(s));
        }

        pub(crate) fn both(trajectory: &[Sample], out: &mut [f64]) {
            let mut best = NONE;
            backward(trajectory, out, |s| {
                best = max(min(s.x, near(s)), best);
                best
            });
        }

        pub(crate) fn until(trajectory: &[Sample], out: &mut [f64]) {
            let mut after = NONE;
            backward(trajectory, out, |s| {
                after = max(near(s), min(s.x, after));
                after
            });
        }

        pub(crate) fn nested(trajectory: &[Sample], out: &mut [f64]) {
            let (mut goal, mut whole) = (NONE, NONE);
            backward(trajectory, out, |s| {
                goal = max(near(s), goal);
                whole = max(min(s.x, goal), whole);
                whole
            });
        }
    }

    /// The sum of the greatest so far.
    pub(crate) fn so_far(trajectory: &[Sample]) -> f64 {
        let (mut best, mut all) = (NONE, 0.0);
        for s in trajectory {
            best = max(min(s.x, near(s)), best);
            all += best;
        }
        all
    }

    /// For each valuation the states after 0 to 4, six bits each: what state they begin at.
    const ROWS: [u64; 4] = {
        let next = [[0, 1, 0, 1], [0, 1, 2, 3], [0, 4, 0, 4], [0, 4, 2, 4], [4; 4]];
        let (mut rows, mut q) = ([0; 4], 0);
        while q < 5 {
            let mut letter = 0;
            while letter < 4 {
                rows[letter] |= (next[q][letter] * 6) << (q * 6);
                letter += 1;
            }
            q += 1;
        }
        rows
    };

    fn letter(x: f64, y: f64) -> usize {
        usize::from(x > 0.999) | usize::from(y > 2.999) << 1
    }

    pub(crate) fn steps(trajectory: &[Sample]) -> u64 {
        let (mut q, mut all) = (0, 0);
        for s in trajectory {
            q = ROWS[letter(s.x, s.y)] >> q & 63;
            all += q;
        }
        all / 6
    }

    pub(crate) fn batch(q: &mut [u32], x: &[f64], y: &[f64]) {
        for ((q, x), y) in q.iter_mut().zip(x).zip(y) {
            *q = (ROWS[letter(*x, *y)] >> (*q * 6) & 63) as u32 / 6;
        }
    }

    /// A branch for each state, which asks for one predicate.
    pub(crate) fn chain(trajectory: &[Eight]) -> u64 {
        let (mut q, mut all) = (0_usize, 0);
        for s in trajectory {
            q += usize::from(s[q] > 1.9);
            all += q as u64;
            q = if q == 8 { 0 } else { q };
        }
        all
    }
}
