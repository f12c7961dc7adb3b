//! Networks learn the small kitchen; what they see of it hides what is hidden.

use std::sync::Arc;

use tltl::Monitor;
use tltl::deep::{Device, Goals as _, Learner, Settings, Skill};
use tltl::env::Env;
use tltl::learn::Schedule;
use tltl::network::Features;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::features::{FeasibleGoals, View, exploration};
use tltl_kitchen::tasks::told;
use tltl_kitchen::{Action, Goals, Kitchen, Known, Layout};

#[test]
fn a_network_learns_to_put_the_apple_into_the_fridge() {
    let layout = Arc::new(Layout::small());
    let id = |name| layout.id(name).unwrap();
    let goals = Goals::Fixed { object: id("apple"), receptacle: id("fridge") };
    let mut kitchen = Kitchen::new(layout.clone(), goals, 100).unwrap();
    let settings = Settings {
        horizon: 100,
        hidden: vec![128, 128],
        relabelled: 0.0,
        learning_rate: Schedule::Linear { from: 5e-4, to: 1e-5, steps: 6_000 },
        epsilon: Schedule::Linear { from: 1.0, to: 0.05, steps: 3_000 },
        ..Settings::default()
    };
    let task = told::phi_3();
    let skill =
        Skill::with_goals(task, View::new(layout.clone()), FeasibleGoals::new(&layout, None));
    let mut learner = Learner::new(skill, kitchen.actions(), settings, &Device::flex(), 1)
        .exploring(exploration(&layout));
    learner.train(&mut kitchen, 12_000).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(2);
    let (mut satisfied, mut steps) = (0, 0);
    for _ in 0..100 {
        let mut s = kitchen.reset(&mut rng);
        let mut q = task.next(0, &s).unwrap();
        let mut over = false;
        while !over {
            let step = kitchen.step(learner.act(q, &s).unwrap(), &mut rng);
            s = step.state;
            q = task.next(q, &s).unwrap();
            over = step.truncated || Monitor::<Known>::is_terminal(&task, q);
        }
        satisfied += u32::from(Monitor::<Known>::is_accepting(&task, q));
        steps += kitchen.steps();
    }
    assert!(satisfied >= 99, "{satisfied} of 100 episodes");
    assert!(steps <= 100 * 10, "{steps} steps in 100 episodes");
}

#[test]
fn features_are_small_numbers_and_goals_can_be_reached() {
    let layout = Arc::new(Layout::floorplan24());
    let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 500).unwrap();
    let (view, goals) = (View::new(layout.clone()), FeasibleGoals::new(&layout, Some(0)));
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let explored = exploration(&layout);
    assert!((0..layout.actions() as u32).all(|a| explored.contains(&a)), "every action is tried");
    for _ in 0..20 {
        let mut known = kitchen.reset(&mut rng);
        for _ in 0..100 {
            let (mut inputs, mut entities) =
                (vec![0.0; view.inputs()], vec![0.0; view.entities() * view.channels()]);
            view.write(&known, &mut inputs, &mut entities);
            assert!(inputs.iter().chain(&entities).all(|x| (-1.0..=1.0).contains(x)));
            let goal = goals.choose(&known, &mut rng).unwrap();
            assert!(layout.feasible(goal.object, goal.receptacle) && goal.object != 0);
            assert_eq!(goals.give(&known, &goal).goal(), goal);
            let action = explored[rng.next_u32() as usize % explored.len()] as usize;
            known = kitchen.act(Action::from_index(action)).state;
        }
    }
}
