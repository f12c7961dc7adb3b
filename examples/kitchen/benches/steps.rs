//! Speed of the kitchen under random actions, and of the planner.
//!
//! `cargo bench -p tltl-kitchen --bench steps`: the best of some repetitions counts, on one core; what is
//! measured must give the right answer.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use tltl::env::Env;
use tltl::product::Product;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::planner::Planner;
use tltl_kitchen::tasks::phi_3;
use tltl_kitchen::{Goal, Goals, Kitchen, Layout};

const STEPS: u32 = 10_000_000;
const REPETITIONS: u32 = 5;
const STARTS: u64 = 2000;

/// Takes random actions; returns how many failed.
fn random_actions(kitchen: &mut Kitchen) -> u32 {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut failures, actions) = (0, kitchen.actions() as u64);
    kitchen.reset(&mut rng);
    for _ in 0..STEPS {
        let action = ((u64::from(rng.next_u32()) * actions) >> 32) as usize;
        let step = black_box(kitchen.step(action, &mut rng));
        failures += u32::from(kitchen.failed());
        if step.truncated {
            kitchen.reset(&mut rng);
        }
    }
    failures
}

fn steps(layout: &Arc<Layout>) {
    let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 200).unwrap();
    let mut best = f64::INFINITY;
    let mut failures = Vec::new();
    for _ in 0..REPETITIONS {
        let start = Instant::now();
        failures.push(random_actions(&mut kitchen));
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("random actions: {:.1} M steps/s", f64::from(STEPS) / best / 1e6);
    assert!(failures.iter().all(|&n| n == failures[0]), "same seed, same failures");
    let rate = f64::from(failures[0]) / f64::from(STEPS);
    println!("failed: {rate:.4}");
    assert!((0.1..0.5).contains(&rate), "{rate}");
}

/// Plans from many starts of `goals`; `first` is the goal that is there besides the drawn one.
fn plans(name: &str, layout: &Arc<Layout>, goals: Goals, first: Option<Goal>) {
    let mut kitchen = Kitchen::new(layout.clone(), goals, 200).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut length, mut seconds, mut longest, mut worst) = (0, 0.0, 0, 0.0f64);
    for _ in 0..STARTS {
        let goal = kitchen.reset(&mut rng).goal();
        let goals: Vec<Goal> = first.into_iter().chain([goal]).collect();
        let tasks: Vec<_> = goals.iter().map(|goal| phi_3(goal.object, goal.receptacle)).collect();
        let operands: Vec<_> =
            tasks.iter().map(|task| task as tltl::product::Operand<'_, _>).collect();
        let product = Product::conjunction(&operands);
        let start = Instant::now();
        let plan = Planner::new(layout, &product, &goals).plan(kitchen.truth()).unwrap();
        let took = start.elapsed().as_secs_f64();
        let steps = plan.expect("every start can be solved").len();
        (length, longest) = (length + steps, longest.max(steps));
        (seconds, worst) = (seconds + took, worst.max(took));
    }
    let n = STARTS as f64;
    println!(
        "plans, {name}: {:.3} steps, {longest} at most; {:.2} ms, {:.1} at most",
        length as f64 / n,
        seconds / n * 1e3,
        worst * 1e3
    );
}

fn main() {
    let layout = Arc::new(Layout::floorplan24());
    let (object, receptacle) = (layout.id("apple").unwrap(), layout.id("fridge").unwrap());
    steps(&layout);
    plans("task 1", &layout, Goals::Fixed { object, receptacle }, None);
    plans("task 2", &layout, Goals::Random { except: None }, None);
    let first = Goal { object, receptacle };
    plans("composition", &layout, Goals::Beside { object, receptacle }, Some(first));
}
