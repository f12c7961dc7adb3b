//! Speed of an emitted policy: the committed `examples/generated/visit_all.rs`, as it is.
//!
//! `cargo bench -p tltl-tests --bench act`: nanoseconds of `next` and `act` together, on states that are
//! known beforehand, and along episodes, where each call waits for the one before. The actions must
//! be those of the file, and every episode must accomplish the task.

#[path = "../../examples/generated/visit_all.rs"]
#[allow(dead_code, unreachable_pub, reason = "generated; this bench does not use all of it")]
mod visit_all;

use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 20_000_000;
const REPETITIONS: usize = 7;

/// The median over the repetitions of the nanoseconds of one round of `run`.
fn nanoseconds(run: impl Fn() -> usize, expected: usize) -> f64 {
    let mut times: Vec<f64> = (0..REPETITIONS)
        .map(|_| {
            let start = Instant::now();
            assert_eq!(black_box(run()), expected, "the policy's answers");
            start.elapsed().as_secs_f64() * 1e9 / ROUNDS as f64
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[REPETITIONS / 2]
}

/// Every state in turn, read by the first automaton state: the sum of the actions.
fn in_turn(rounds: usize) -> usize {
    let answer = |i| {
        let s = black_box(i % visit_all::STATES);
        visit_all::act(visit_all::next(0, s), s)
    };
    (0..rounds).map(answer).sum()
}

/// Where an action leads on the paper's grid, if nothing slips.
fn moves() -> [usize; 400] {
    core::array::from_fn(|at| {
        let (s, (dx, dy)) = (at / 5, [(0, 1), (0, -1), (-1, 0), (1, 0), (0, 0)][at % 5]);
        let (x, y) = ((s % 8) as i32 + dx, (s / 8) as i32 + dy);
        if (0..8).contains(&x) && (0..10).contains(&y) { (y * 8 + x) as usize } else { s }
    })
}

/// Episodes from every start in turn, without slips: how many end. The world is one look-up.
fn episodes(moves: &[usize; 400]) -> usize {
    let (mut start, mut ended) = (0, 0);
    let (mut s, mut q) = (0, visit_all::reset(0));
    for _ in 0..ROUNDS {
        if visit_all::is_done(q) {
            ended += 1;
            start = (start + 1) % visit_all::STATES;
            (s, q) = (start, visit_all::reset(start));
        }
        s = moves[s * 5 + visit_all::act(q, s)];
        q = visit_all::next(q, s);
    }
    ended
}

/// How many episodes end in so many steps, from the length of each.
fn ends(moves: &[usize; 400]) -> usize {
    let length = |start: usize| {
        let (mut s, mut q, mut steps) = (start, visit_all::reset(start), 0);
        while !visit_all::is_done(q) {
            s = moves[s * 5 + visit_all::act(q, s)];
            q = visit_all::next(q, s);
            steps += 1;
            assert!(steps < 30, "from {start} the task is done in fewer than 30 steps");
        }
        steps
    };
    let lengths: Vec<usize> = (0..visit_all::STATES).map(length).collect();
    let (mut left, mut ended) = (ROUNDS, 0);
    // An episode that ends with the last round is not seen to end.
    for length in lengths.iter().cycle() {
        if left <= *length {
            return ended;
        }
        (left, ended) = (left - length, ended + 1);
    }
    ended
}

fn main() {
    let moves = moves();
    let expected = ROUNDS / visit_all::STATES * in_turn(visit_all::STATES);
    let each = nanoseconds(|| in_turn(ROUNDS), expected);
    println!("{:34} {each:6.2} ns", "next and act");
    let along = nanoseconds(|| episodes(&moves), ends(&moves));
    println!("{:34} {along:6.2} ns", "next, act and a world of one table");
}
