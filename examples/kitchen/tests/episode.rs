//! Episodes as text and pictures.

use std::sync::Arc;

use tltl::env::Env;
use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::show::{self, Episode};
use tltl_kitchen::tasks::phi_3;
use tltl_kitchen::{Action, Goal, Goals, Kitchen, Layout, Truth, strip};

/// The mug is to be put into the cabinet, with one mistake on the way.
fn recorded() -> (Arc<Layout>, Episode) {
    let layout = Arc::new(Layout::small());
    let id = |name: &str| layout.id(name).unwrap();
    let places = ["table_top", "sink", "fridge", "table_top"].map(id);
    let truth = Truth::start(&layout, &places, &[]).unwrap();
    let goal = Goal { object: id("mug"), receptacle: id("cabinet") };
    let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 50).unwrap();
    kitchen.start_at(truth, goal).unwrap();
    let mut plan = [
        Action::Navigate(id("sink")),
        Action::LookDown,
        Action::Pick,
        Action::Navigate(id("mug")),
        Action::Pick,
        Action::Navigate(id("cabinet")),
        Action::LookUp,
        Action::LookUp,
        Action::Open,
        Action::Put,
    ]
    .into_iter();
    let task = phi_3(goal.object, goal.receptacle);
    let act = |_, _: &_| Ok::<_, tltl::task::Error>(plan.next().unwrap());
    (layout.clone(), Episode::record(&mut kitchen, &task, &[goal], act).unwrap())
}

#[test]
fn as_text() {
    let (layout, episode) = recorded();
    let expected = "\
wanted: mug in cabinet
t   action             in view           hand  q
0   (start)            -                 -     0
1   navigate(sink)     -                 -     0
2   look_down          sink: mug         -     0 -> 1  see(mug)
3   pick  failed       sink: mug         -     1
4   navigate(mug)      sink: mug         -     1
5   pick               sink: nothing     mug   1 -> 2  hold(mug)
6   navigate(cabinet)  -                 mug   2
7   look_up            -                 mug   2
8   look_up            cabinet (closed)  mug   2
9   open               cabinet: nothing  mug   2 -> 3  open(cabinet)
10  put                cabinet: mug      -     3 -> 4  inside(mug, cabinet)
satisfied after 10 steps, 1 failed
";
    assert_eq!(episode.text(&layout), expected);
}

#[test]
fn as_pictures() {
    let (layout, episode) = recorded();
    let svg = strip::svg(&episode, &layout);
    assert_eq!(svg.matches("<g transform").count(), 11);
    assert_eq!(svg.matches("<g").count(), svg.matches("</g>").count());
    for told in ["mug into cabinet", "q3 → q4", "pick ✗", "not in view", "inside(mug, cabinet)"]
    {
        assert!(svg.contains(told), "{told}");
    }
}

#[test]
fn read_back_from_their_text() {
    let (layout, episode) = recorded();
    let actions: Vec<Action> = episode.moments.iter().filter_map(|moment| moment.action).collect();
    assert_eq!(show::actions(&episode.text(&layout), &layout), actions);
    assert_eq!(show::actions("t   action\n0   (start)\n1   fly\n2   pick\n", &layout), []);
}

/// A policy that cannot choose an action ends the episode, and takes no step in the kitchen.
#[test]
fn what_cannot_act_takes_no_step() {
    let layout = Arc::new(Layout::small());
    let mut kitchen = Kitchen::new(layout, Goals::Random { except: None }, 50).unwrap();
    let goal = kitchen.reset(&mut Xoshiro256PlusPlus::seed_from_u64(1)).goal();
    let error = tltl::task::Error { predicate: "see".into(), instant: None };
    let task = phi_3(goal.object, goal.receptacle);
    let act = |_, _: &_| Err(error.clone());
    assert_eq!(Episode::record(&mut kitchen, &task, &[goal], act).unwrap_err(), error);
    assert_eq!(kitchen.steps(), 0);
}
