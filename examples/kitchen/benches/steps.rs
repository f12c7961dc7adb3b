//! Speed of the kitchen under random actions and of the planner; lengths of its plans and of the
//! searcher's episodes.
//!
//! `cargo bench -p tltl-kitchen --bench steps`: the best of some repetitions counts, on one core;
//! what is measured must give the right answer.

use std::hint::black_box;
use std::sync::Arc;
use std::time::Instant;

use tltl::env::Env;
use tltl::product::{Operand, Product};
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::{Acceptor, Monitor};
use tltl_kitchen::planner::Planner;
use tltl_kitchen::searcher::Searcher;
use tltl_kitchen::tasks::phi_3;
use tltl_kitchen::{Goal, Goals, Kitchen, Known, Layout};

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

/// Plans and searches from many starts of `goals`; `first` is the goal that is there besides the
/// drawn one.
fn episodes(name: &str, layout: &Arc<Layout>, goals: Goals, first: Option<Goal>, limit: u32) {
    let mut kitchen = Kitchen::new(layout.clone(), goals, limit).unwrap();
    let searcher = Searcher::new(layout.clone(), first);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let (mut planned, mut searched, mut times) = (Vec::new(), Vec::new(), Vec::new());
    for _ in 0..STARTS {
        let goal = kitchen.reset(&mut rng).goal();
        let goals: Vec<Goal> = first.into_iter().chain([goal]).collect();
        let tasks: Vec<_> = goals.iter().map(|goal| phi_3(goal.object, goal.receptacle)).collect();
        let operands: Vec<Operand<'_, Known>> = tasks.iter().map(|task| task as _).collect();
        let product = Product::conjunction(&operands);
        let start = Instant::now();
        let plan = Planner::new(layout, &product, &goals).plan(kitchen.truth()).unwrap();
        times.push(start.elapsed().as_secs_f64() * 1e3);
        planned.push(plan.expect("every start can be solved").len() as f64);
        searched.push(search(&mut kitchen, &searcher, &product));
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    println!(
        "{name}: planner {:.2} steps (at most {}) in {:.2} ms (at most {:.0}); \
         searcher {:.2} (at most {})",
        mean(&planned),
        most(&planned),
        mean(&times),
        most(&times),
        mean(&searched),
        most(&searched),
    );
    assert!(planned.iter().zip(&searched).all(|(plan, search)| plan <= search));
    assert!(mean(&times) < 50.0);
}

/// The number of steps that the searcher needs from where `kitchen` is.
fn search(kitchen: &mut Kitchen, searcher: &Searcher, task: &Product<'_, Known>) -> f64 {
    let mut q = task.next(0, kitchen.known()).unwrap();
    while !task.is_accepting(q) {
        assert!(kitchen.steps() < kitchen.horizon_steps(), "the searcher always succeeds");
        q = task.next(q, &kitchen.act(searcher.action(kitchen.known())).state).unwrap();
    }
    assert_eq!(kitchen.failures(), 0);
    f64::from(kitchen.steps())
}

fn main() {
    let layout = Arc::new(Layout::floorplan24());
    let (object, receptacle) = (layout.id("apple").unwrap(), layout.id("fridge").unwrap());
    let apple = Goal { object, receptacle };
    steps(&layout);
    episodes("task 1", &layout, Goals::Fixed { object, receptacle }, None, 100);
    episodes("task 2", &layout, Goals::Random { except: None }, None, 200);
    episodes("composition", &layout, Goals::Beside { object, receptacle }, Some(apple), 200);
}
