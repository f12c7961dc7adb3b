//! Exact solutions: the paper's composed task, and a world of a million cells.
//!
//! `cargo bench -p tltl-tests --bench solve [-- SIDE]` solves a SIDE × SIDE grid (1000 by default).

#[path = "../../runtime/tests/world/mod.rs"]
mod world;

use std::time::Instant;

use tltl::prelude::{Dynamics, Labelled, Problem, Product, Rewards};
use world::{A, B, C, Cell, Grid, PAPER, both, eventually, problem};

const PROGRESS: Rewards = Rewards::progress();

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    let seconds = start.elapsed().as_secs_f64();
    println!("{what}: {:.3} ms", 1e3 * seconds);
    (result, seconds)
}

/// The least seconds of some repetitions.
fn least(what: &str, repetitions: usize, mut work: impl FnMut()) -> f64 {
    let once = |_| {
        let start = Instant::now();
        work();
        start.elapsed().as_secs_f64()
    };
    let least = (0..repetitions).map(once).fold(f64::INFINITY, f64::min);
    println!("{what}: {:.3} ms", 1e3 * least);
    least
}

fn paper() {
    let (phi1, phi2) = (both(A, B), eventually(C));
    let whole = Product::conjunction(&[&phi1, &phi2]);
    let problem = problem(&Labelled::of_model(&PAPER, &whole).unwrap());
    let q = problem.optimal_q(&PROGRESS);
    assert!((q.max(0, 0) - 1.832763429).abs() < 1e-9);
    let best = problem.best();
    let (p, steps) = (best.mean_satisfied(), best.mean_steps().unwrap());
    assert!((p - 1.0).abs() < 1e-9 && (steps - 16.7111).abs() < 5e-5);
    let solve = least("paper, Q*", 50, || drop(problem.optimal_q(&PROGRESS)));
    let reach = least("paper, P", 50, || drop(problem.largest_satisfied()));
    least("paper, P and steps", 50, || drop(problem.best()));
    assert!(solve + reach < 1e-3, "Q* and P of the composed task take {} s", solve + reach);
}

fn large(side: usize) {
    let grid = Grid { width: side, height: side };
    let near = |x: usize, y: usize| Cell { x: (x * side / 8) as i32, y: (y * side / 8) as i32 };
    let (one, two) = (both(near(1, 2), near(5, 5)), eventually(near(2, 7)));
    let whole = Product::conjunction(&[&one, &two]);
    let (dynamics, _) = timed("tables", || Dynamics::new(&grid).unwrap());
    let (labelled, _) = timed("labels", || Labelled::of_model(&grid, &whole).unwrap());
    let (problem, _) = timed("problem", || Problem::new(&dynamics, &labelled).unwrap());
    let (q, solve) = timed("Q*", || problem.optimal_q(&PROGRESS));
    println!("V(0) = {:.12}", q.max(0, 0));
    drop(q);
    let (best, reach) = timed("P and steps", || problem.best());
    let (p, steps) = (best.mean_satisfied(), best.mean_steps().unwrap());
    println!("P {p:.12}, E[steps] {steps:.9}");
    println!("{side} x {side}: {:.1} s in all, peak memory {} MiB", solve + reach, peak());
}

/// The largest memory of this process, in MiB; 0 where the system does not say.
fn peak() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let kib = line.and_then(|line| line.trim().trim_end_matches(" kB").parse::<u64>().ok());
    kib.unwrap_or(0) / 1024
}

fn main() {
    let side = std::env::args().filter_map(|arg| arg.parse().ok()).next().unwrap_or(1000);
    paper();
    large(side);
}
