//! Shortest plans are plans, and shortest; the searcher needs at least as many steps, and no failed
//! ones.

use std::sync::Arc;

use tltl::env::Env;
use tltl::product::{Operand, Product};
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl::{Acceptor, Monitor};
use tltl_kitchen::planner::Planner;
use tltl_kitchen::searcher::Searcher;
use tltl_kitchen::tasks::{phi_1, phi_2, phi_3};
use tltl_kitchen::{Action, Goal, Goals, Kitchen, Known, Layout};

/// Room is scarce: most receptacles are full.
const TIGHT: &str = r#"
[[object]]
type = "mug"
count = 2
fits = ["shelf", "box", "hook"]
[[object]]
type = "jar"
fits = ["shelf", "box"]
[[receptacle]]
type = "shelf"
count = 2
capacity = 1
horizon = 0
[[receptacle]]
type = "box"
door = true
capacity = 1
horizon = -30
[[receptacle]]
type = "hook"
capacity = 1
horizon = 30
"#;

/// Runs `plan` from where `kitchen` is; whether `monitor` accepts at its end, and not before.
fn satisfies(kitchen: &mut Kitchen, monitor: &dyn Monitor<Known>, plan: &[Action]) -> bool {
    let mut q = monitor.next(0, kitchen.known()).unwrap();
    for &action in plan {
        assert!(!monitor.is_terminal(q));
        q = monitor.next(q, &kitchen.act(action).state).unwrap();
    }
    monitor.is_accepting(q)
}

/// Compares the planner with a search that leaves nothing out.
fn compare(layout: &Arc<Layout>, goals: Goals, first: Option<Goal>, starts: u32) -> (u32, usize) {
    let mut kitchen = Kitchen::new(layout.clone(), goals, 200).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
    let (mut compared, mut longest) = (0, 0);
    for _ in 0..starts {
        let goal = kitchen.reset(&mut rng).goal();
        let truth = *kitchen.truth();
        let all: Vec<Goal> = first.into_iter().chain([goal]).collect();
        for j in 1..=3 {
            let of = |goal: &Goal| -> Box<dyn Monitor<Known> + Sync> {
                let (o, r) = (goal.object, goal.receptacle);
                match j {
                    1 => Box::new(phi_1(o, r)),
                    2 => Box::new(phi_2(o, r)),
                    _ => Box::new(phi_3(o, r)),
                }
            };
            let tasks: Vec<_> = all.iter().map(of).collect();
            let operands: Vec<Operand<'_, Known>> = tasks.iter().map(|task| &**task as _).collect();
            let product = Product::conjunction(&operands);
            let planner = Planner::new(layout, &product, &all);
            let plan = planner.plan(&truth).unwrap();
            let exact = planner.plan_unpruned(&truth).unwrap();
            assert_eq!(
                plan.as_ref().map(Vec::len),
                exact.as_ref().map(Vec::len),
                "{all:?} {plan:?} {exact:?}\n{}",
                truth.describe(layout)
            );
            if let Some(plan) = plan {
                kitchen.start_at(truth, goal).unwrap();
                assert!(satisfies(&mut kitchen, &product, &plan));
                (compared, longest) = (compared + 1, longest.max(plan.len()));
            }
        }
    }
    (compared, longest)
}

#[test]
fn nothing_is_lost_by_what_is_left_out() {
    let small = Arc::new(Layout::small());
    let tight = Arc::new(Layout::parse(TIGHT).unwrap());
    assert!(compare(&small, Goals::Random { except: None }, None, 60).0 == 180);
    assert!(compare(&tight, Goals::Random { except: None }, None, 100).0 == 300);
    for (layout, object, receptacle, starts) in
        [(&small, "apple", "fridge", 12), (&tight, "jar", "box", 40), (&tight, "mug_1", "hook", 40)]
    {
        let object = layout.id(object).unwrap();
        let receptacle = layout.id(receptacle).unwrap();
        let goals = Goals::Beside { object, receptacle };
        let (compared, longest) = compare(layout, goals, Some(Goal { object, receptacle }), starts);
        assert!(compared > 2 * starts && longest > 10, "{compared} {longest}");
    }
}

/// Mean lengths over starts, of the planner and of the searcher.
fn lengths(goals: Goals, first: Option<Goal>, limit: u32) -> (f64, f64) {
    const STARTS: u32 = 300;
    let layout = Arc::new(Layout::floorplan24());
    let searcher = Searcher::new(layout.clone(), first);
    let mut kitchen = Kitchen::new(layout.clone(), goals, limit).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let (mut planned, mut searched) = (0, 0);
    for _ in 0..STARTS {
        let goal = kitchen.reset(&mut rng).goal();
        let truth = *kitchen.truth();
        let all: Vec<Goal> = first.into_iter().chain([goal]).collect();
        let tasks: Vec<_> = all.iter().map(|goal| phi_3(goal.object, goal.receptacle)).collect();
        let operands: Vec<Operand<'_, Known>> = tasks.iter().map(|task| task as _).collect();
        let product = Product::conjunction(&operands);
        let plan = Planner::new(&layout, &product, &all).plan(&truth).unwrap().unwrap();
        assert!(satisfies(&mut kitchen, &product, &plan));
        assert_eq!(kitchen.failures(), 0);

        kitchen.start_at(truth, goal).unwrap();
        let mut q = product.next(0, kitchen.known()).unwrap();
        while !product.is_accepting(q) {
            let step = kitchen.act(searcher.action(kitchen.known()));
            q = product.next(q, &step.state).unwrap();
            assert!(!step.truncated || product.is_accepting(q), "{}", truth.describe(&layout));
        }
        assert_eq!(kitchen.failures(), 0);
        assert!(plan.len() as u32 <= kitchen.steps());
        planned += plan.len();
        searched += kitchen.steps();
    }
    (planned as f64 / f64::from(STARTS), f64::from(searched) / f64::from(STARTS))
}

#[test]
fn the_searcher_succeeds_and_is_never_better_than_the_planner() {
    let layout = Layout::floorplan24();
    let (object, receptacle) = (layout.id("apple").unwrap(), layout.id("fridge").unwrap());
    let beside = Some(Goal { object, receptacle });
    let close = |(planned, searched): (f64, f64), to: (f64, f64)| {
        assert!(
            (planned - to.0).abs() < 0.6 && (searched - to.1).abs() < 2.5,
            "{planned} {searched}"
        );
    };
    close(lengths(Goals::Fixed { object, receptacle }, None, 100), (6.51, 10.05));
    close(lengths(Goals::Random { except: None }, None, 200), (9.15, 27.0));
    close(lengths(Goals::Beside { object, receptacle }, beside, 200), (14.79, 32.6));
}

#[test]
fn plans_go_on_from_the_middle_of_an_episode() {
    let layout = Arc::new(Layout::floorplan24());
    let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 200).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
    for _ in 0..30 {
        let goal = kitchen.reset(&mut rng).goal();
        let task = phi_3(goal.object, goal.receptacle);
        let planner = Planner::new(&layout, &task, std::slice::from_ref(&goal));
        let plan = planner.plan(kitchen.truth()).unwrap().unwrap();
        let mut q = task.next(0, kitchen.known()).unwrap();
        for (i, &action) in plan.iter().enumerate() {
            let rest = planner.plan_from(kitchen.truth(), q).unwrap().unwrap();
            assert_eq!(rest.len(), plan.len() - i);
            q = task.next(q, &kitchen.act(action).state).unwrap();
        }
    }
}
