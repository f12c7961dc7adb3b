//! Exact solutions: the paper's composed task, worlds of many kinds, and one of a million cells.
//!
//! `cargo bench -p tltl-tests --bench solve [-- NAME…]` solves what is named: `paper`, `grid`, `trap`,
//! `unstructured`, `chain`, `dense`, `slow`, `million`; all but the last by default. With `--drn DIR` it
//! also writes each world's augmented MDP there as Storm reads it: `tests/benches/storm.py` compares.

#[path = "../../runtime/tests/world/mod.rs"]
mod world;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use tltl::model::{self, FiniteModel};
use tltl::prelude::{Dynamics, Labelled, Problem, Product, Rewards, tltl};
use tltl::reward::End;
use world::{A, B, C, Cell, Grid, PAPER, both, eventually, problem};

const PROGRESS: Rewards = Rewards::progress();

fn timed<T>(what: &str, work: impl FnOnce() -> T) -> (T, f64) {
    let start = Instant::now();
    let result = work();
    let seconds = start.elapsed().as_secs_f64();
    println!("{what}: {:.3} ms", 1e3 * seconds);
    (result, seconds)
}

/// CPU seconds of this process, where the system says; else those since the epoch.
fn cpu() -> f64 {
    let times = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let nanoseconds = times.split_whitespace().next().and_then(|time| time.parse::<f64>().ok());
    let since =
        || std::time::SystemTime::UNIX_EPOCH.elapsed().map_or(0.0, |time| time.as_secs_f64());
    nanoseconds.map_or_else(since, |time| time / 1e9)
}

/// The least CPU seconds of some repetitions.
fn least(what: &str, repetitions: usize, mut work: impl FnMut()) -> f64 {
    // Clocks of processes tick too slowly for the smallest worlds.
    let once = |_| {
        let (start, clock) = (cpu(), Instant::now());
        work();
        let wall = clock.elapsed().as_secs_f64();
        if wall < 0.01 { wall } else { (cpu() - start).min(wall) }
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

/// The cells of a square in which a move slips one time in five.
fn square(side: usize) -> impl FiniteModel<State = usize> {
    let step = move |s: usize, (dx, dy): (isize, isize)| {
        let stay = |at: usize, d| at.saturating_add_signed(d).min(side - 1);
        stay(s / side, dy) * side + stay(s % side, dx)
    };
    let moves = [(0, -1), (1, 0), (0, 1), (-1, 0), (0, 0)];
    model::from_fn(side * side, moves.len(), move |s, a| {
        let slips = [0, 1, 2, 3].map(|slip| (step(s, moves[slip]), 0.05));
        slips.into_iter().chain([(step(s, moves[a]), 0.8)])
    })
}

/// States with a few random successors each.
fn unstructured(states: usize, actions: usize, most: usize) -> impl FiniteModel<State = usize> {
    let mut seed = 88_172_645_463_325_252_u64;
    let mut next = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed as usize
    };
    let mut row = || {
        let outcomes: Vec<_> = (0..most - next() % most.min(3))
            .map(|_| (next() % states, (next() % 1000 + 1) as f64))
            .collect();
        let sum: f64 = outcomes.iter().map(|(_, weight)| weight).sum();
        outcomes.into_iter().map(|(to, weight)| (to, weight / sum)).collect::<Vec<_>>()
    };
    let rows: Vec<_> = (0..states * actions).map(|_| row()).collect();
    model::from_fn(states, actions, move |s, a| rows[s * actions + a].clone())
}

/// A walk between two ends, of which action 0 is drawn to the one and action 1 to the other.
fn walk(states: usize, stays: f64) -> impl FiniteModel<State = usize> {
    model::from_fn(states, 2, move |s, a| {
        let moves = if s == 0 || s == states - 1 { 0.0 } else { 1.0 - stays };
        let left = moves * [0.9, 0.3][a];
        [(s.saturating_sub(1), left), ((s + 1).min(states - 1), moves - left), (s, 1.0 - moves)]
    })
}

/// A world, and the P(satisfied) of its best policy.
fn world(name: &str) -> (Problem, f64) {
    let of = |model: &dyn Fn() -> (Dynamics, Labelled)| {
        let (dynamics, task) = model();
        Problem::new(&dynamics, &task).unwrap()
    };
    macro_rules! problem {
        ($model:expr, $task:expr) => {{
            let model = $model;
            of(&|| (Dynamics::new(&model).unwrap(), Labelled::of_model(&model, &$task).unwrap()))
        }};
    }
    match name {
        "grid" => {
            let task = tltl! { |s: &usize|
            F ({ *s } == 1203) && F ({ *s } == 8710) && F ({ *s } == 4455) && F ({ *s } == 9090) };
            (problem!(square(100), task), 1.0)
        }
        "trap" => {
            let task = tltl! { |s: &usize| ({ *s } != 3050) U ({ *s } == 1203) && F ({ *s } == 8710)
            && F ({ *s } == 4455) && ({ *s } != 3050) U ({ *s } == 9090) };
            (problem!(square(100), task), 0.999_874_918)
        }
        "unstructured" => {
            let task = tltl! { |s: &usize| F ({ *s } == 9000) };
            (problem!(unstructured(20_000, 5, 5), task), 1.0)
        }
        "dense" => {
            let task = tltl! { |s: &usize| ({ *s } > 9) U ({ *s } == 900) };
            (problem!(unstructured(1000, 5, 300), task), f64::NAN)
        }
        "chain" => {
            let task = tltl! { |s: &usize| F ({ *s } == 0) };
            (problem!(walk(1_000_000, 0.0), task), 0.999_998_875)
        }
        "slow" => {
            let task = tltl! { |s: &usize| F ({ *s } == 0) };
            (problem!(walk(10_000, 1.0 - 1e-9), task), 0.999_887_5)
        }
        _ => panic!("no world is called {name}"),
    }
}

fn solve(name: &str, drn: Option<&Path>) {
    let (problem, expected) = world(name);
    let of = |what| format!("{name}, {what}");
    least(&of("P"), 3, || drop(problem.largest_satisfied()));
    least(&of("P and steps"), 3, || drop(problem.best()));
    least(&of("Q*"), 1, || drop(problem.optimal_q(&Rewards::default())));
    let best = problem.best();
    least(&of("a policy"), 3, || drop(problem.evaluate(best.policy()).unwrap()));
    let (p, error) = (best.mean_satisfied(), best.satisfied().error());
    let (steps, steps_error) = (best.mean_steps().unwrap(), best.steps_error());
    println!("{name}: P {p:.12} ± {error:.0e}, E[steps] {steps:.9} ± {steps_error:.0e}");
    assert!(expected.is_nan() || (p - expected).abs() < 1e-8, "{name}: P {p}");
    assert!(error < 1e-7 && steps_error < 1e-5 * steps, "{name}: {error}, {steps_error}");
    if let Some(folder) = drn {
        std::fs::write(folder.join(format!("{name}.drn")), storm(&problem)).unwrap();
    }
}

/// The augmented MDP in Storm's explicit format: the label `goal` is what is to be reached, and the label
/// `init` the first state of the world.
fn storm(problem: &Problem) -> String {
    let (task, dynamics) = (problem.task(), problem.dynamics());
    let pair = |q: u32, s: usize| q as usize * task.states() + s;
    let (pairs, actions) = (task.pairs(), task.actions());
    let mut text =
        format!("@type: MDP\n@parameters\n\n@reward_models\nsteps\n@nr_states\n{pairs}\n");
    write!(text, "@nr_choices\n{}\n@model\n", pairs * actions).unwrap();
    let live: Vec<u32> = task.live().collect();
    for (q, s) in (0..task.automaton_states()).flat_map(|q| (0..task.states()).map(move |s| (q, s)))
    {
        let goal = task.end(q) == Some(End::Accepted);
        let init = (q, s) == (task.start(0), 0);
        let (over, labels) = (!live.contains(&q), [(init, " init"), (goal, " goal")]);
        let labels = labels.iter().filter(|(is, _)| *is).map(|(_, label)| *label);
        let labels: String = labels.collect();
        writeln!(text, "state {} [{}]{labels}", pair(q, s), u8::from(!over)).unwrap();
        for a in 0..actions {
            writeln!(text, "\taction {a} [0]").unwrap();
            if over {
                writeln!(text, "\t\t{} : 1", pair(q, s)).unwrap();
            } else {
                for (to, p) in dynamics.outcomes(s, a) {
                    writeln!(text, "\t\t{} : {p:?}", pair(task.next(q, to), to)).unwrap();
                }
            }
        }
    }
    text
}

fn main() {
    let mut args: Vec<String> = std::env::args().skip(1).filter(|arg| arg != "--bench").collect();
    let mut drn = None;
    if let Some(at) = args.iter().position(|arg| arg == "--drn") {
        drn = args.drain(at..(at + 2).min(args.len())).nth(1).map(PathBuf::from);
    }
    if args.is_empty() {
        let all = ["paper", "grid", "trap", "unstructured", "dense", "chain", "slow"];
        args = all.map(String::from).into();
    }
    for name in &args {
        match name.as_str() {
            "paper" => paper(),
            "million" => large(1000),
            name => solve(name, drn.as_deref()),
        }
    }
}
