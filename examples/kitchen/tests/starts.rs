//! Starts and goals are drawn as the facts have it.

use std::sync::Arc;

use tltl::Monitor;
use tltl::env::Env;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::tasks::{phi_1, phi_2, phi_3};
use tltl_kitchen::{Goal, Goals, Kitchen, Layout, NONE, Truth};

const STARTS: u64 = 3000;

fn paper() -> (Arc<Layout>, Goal) {
    let layout = Arc::new(Layout::floorplan24());
    let (object, receptacle) = (layout.id("apple").unwrap(), layout.id("fridge").unwrap());
    (layout, Goal { object, receptacle })
}

/// Draws many starts and hands each to `see`.
fn starts(layout: &Arc<Layout>, goals: Goals, mut see: impl FnMut(Goal, &Truth)) {
    let mut kitchen = Kitchen::new(layout.clone(), goals, 200).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    for _ in 0..STARTS {
        let known = kitchen.reset(&mut rng);
        let goal = known.goal();
        assert!(layout.feasible(goal.object, goal.receptacle));
        assert_ne!(kitchen.truth().place(goal.object), goal.receptacle);
        assert_eq!((known.focus, known.horizon, known.hand), (NONE, 0, NONE));
        assert_eq!((kitchen.steps(), kitchen.failures(), kitchen.failed()), (0, 0, false));
        let (o, r) = (goal.object, goal.receptacle);
        for task in [&phi_1(o, r) as &dyn Monitor<_>, &phi_2(o, r), &phi_3(o, r)] {
            assert!(!task.is_accepting(task.next(0, &known).unwrap()));
        }
        see(goal, kitchen.truth());
    }
}

#[test]
fn of_task_1() {
    let (layout, Goal { object, receptacle }) = paper();
    let mut places = [0; 64];
    starts(&layout, Goals::Fixed { object, receptacle }, |goal, truth| {
        assert_eq!(goal, Goal { object, receptacle });
        places[truth.place(object) as usize] += 1;
    });
    for r in layout.receptacle_ids() {
        let possible = layout.may_hold(r, object) && r != receptacle;
        assert_eq!(places[r as usize] > 0, possible, "{}", layout.name(r));
    }
}

#[test]
fn of_task_2() {
    let (layout, _) = paper();
    let (mut goals, mut open) = (std::collections::BTreeMap::new(), 0);
    let doors: Vec<u8> = layout.receptacle_ids().filter(|&r| layout.has_door(r)).collect();
    starts(&layout, Goals::Random { except: None }, |goal, truth| {
        *goals.entry(goal).or_insert(0) += 1;
        open += doors.iter().filter(|&&r| truth.is_open(r)).count();
    });
    // Each of 432 goals is expected 6.9 times; 26 doors are open half of the time.
    assert!(goals.len() > 400 && goals.values().all(|&n| n < 25), "{goals:?}");
    let share = open as f64 / (doors.len() as f64 * STARTS as f64);
    assert_eq!(doors.len(), 26);
    assert!((share - 0.5).abs() < 0.01, "{share}");
}

#[test]
fn of_the_composition() {
    let (layout, apple) = paper();
    let Goal { object, receptacle } = apple;
    let mut same_target = 0;
    starts(&layout, Goals::Beside { object, receptacle }, |goal, truth| {
        assert_ne!(goal.object, object);
        assert_ne!(truth.place(object), receptacle);
        same_target += u32::from(goal.receptacle == receptacle);
    });
    assert!(same_target > 0);
    starts(&layout, Goals::Random { except: Some(object) }, |goal, _| {
        assert_ne!(goal.object, object);
    });
}

#[test]
fn starts_depend_on_the_seed_only() {
    let (layout, _) = paper();
    let mut kitchens =
        [0; 2].map(|_| Kitchen::new(layout.clone(), Goals::Random { except: None }, 9).unwrap());
    let mut rngs = [7, 7].map(Xoshiro256PlusPlus::seed_from_u64);
    kitchens[1].reset(&mut Xoshiro256PlusPlus::seed_from_u64(1));
    for _ in 0..20 {
        let known = kitchens[0].reset(&mut rngs[0]);
        assert_eq!(known, kitchens[1].reset(&mut rngs[1]));
        assert_eq!(kitchens[0].truth(), kitchens[1].truth());
    }
}

#[test]
fn impossible_goals_and_truths_are_refused() {
    let (layout, Goal { object, receptacle }) = paper();
    let cabinet = layout.id("cabinet_3").unwrap();
    let told = |goals| Kitchen::new(layout.clone(), goals, 100).unwrap_err().to_string();
    let hidden = Goals::Fixed { object, receptacle: cabinet };
    assert_eq!(told(hidden), "`apple` may not be put into `cabinet_3`");
    let swapped = Goals::Beside { object: receptacle, receptacle: object };
    assert_eq!(told(swapped), "45 in 0 is not an object in a receptacle");

    let mut places: Vec<u8> = vec![layout.id("counter_top_1").unwrap(); 17];
    let told =
        |places: &[u8], open: &[u8]| Truth::start(&layout, places, open).unwrap_err().to_string();
    assert_eq!(told(&places, &[]), "`counter_top_1` holds 17, but has room for 4");
    assert_eq!(told(&places[1..], &[]), "16 places for 17 objects");
    places[0] = cabinet;
    assert_eq!(told(&places, &[]), "`apple` may not be put into `cabinet_3`");
    places[0] = 3;
    assert_eq!(told(&places, &[]), "`apple` is in 3, which is no receptacle");
    let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 9).unwrap();
    kitchen.reset(&mut Xoshiro256PlusPlus::seed_from_u64(1));
    let places: Vec<u8> = layout.object_ids().map(|o| kitchen.truth().place(o)).collect();
    assert_eq!(told(&places, &[3]), "id 3 is no receptacle with a door");
    let sink = layout.id("sink").unwrap();
    assert_eq!(told(&places, &[sink]), "id 47 is no receptacle with a door");
}
