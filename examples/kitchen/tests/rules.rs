//! The rules, row by row, and what holds whatever the agent does.

use std::sync::Arc;

use proptest::prelude::*;
use tltl::Monitor;
use tltl::env::Env;
use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
use tltl_kitchen::tasks::{self, phi_3};
use tltl_kitchen::{Action, Goal, Goals, Kitchen, Known, Layout, NONE, Truth};

/// The action that is written `text`: `pick`, `navigate(mug)`.
fn action(layout: &Layout, text: &str) -> Action {
    let all = (0..layout.actions()).map(Action::from_index);
    all.into_iter().find(|action| action.name(layout) == text).unwrap_or_else(|| panic!("{text}"))
}

/// The small kitchen with apple, mug, bowl and fork in `places` and the doors of `open` open.
fn small(places: [&str; 4], open: &[&str]) -> Kitchen {
    let layout = Arc::new(Layout::small());
    let ids =
        |names: &[&str]| -> Vec<u8> { names.iter().map(|name| layout.id(name).unwrap()).collect() };
    let truth = Truth::start(&layout, &ids(&places), &ids(open)).unwrap();
    let goals = Goals::Random { except: None };
    let mut kitchen = Kitchen::new(layout.clone(), goals, 1000).unwrap();
    kitchen.start_at(truth, layout.feasible_goals().next().unwrap()).unwrap();
    kitchen
}

/// Where apple, mug, bowl and fork are; open doors; actions, `!` before those that fail.
const ROWS: [([&str; 4], &[&str], &str); 18] = [
    // pick
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "!pick navigate(table_top) !pick look_down !pick navigate(apple) pick !pick",
    ),
    (
        ["table_top", "table_top", "fridge", "cabinet"],
        &[],
        "navigate(table_top) look_down navigate(mug) look_up !pick look_down pick navigate(apple) !pick",
    ),
    (
        ["fridge", "sink", "table_top", "cabinet"],
        &[],
        "look_down navigate(fridge) open navigate(apple) close !pick open pick",
    ),
    // put
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "!put look_down navigate(table_top) !put navigate(apple) pick put !put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &["cabinet"],
        "look_down navigate(table_top) navigate(apple) pick navigate(cabinet) look_up look_up !put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(table_top) navigate(apple) pick navigate(fridge) !put open put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &["fridge"],
        "look_down navigate(table_top) navigate(apple) pick navigate(fridge) look_up !put look_down put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(table_top) navigate(apple) pick navigate(sink) !put navigate(table_top) put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(sink) navigate(mug) pick navigate(coffee_machine) !put look_up put",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(sink) navigate(mug) pick navigate(stove_burner) look_up !put",
    ),
    (
        ["table_top", "sink", "table_top", "cabinet"],
        &[],
        "look_down navigate(sink) navigate(mug) pick navigate(table_top) !put navigate(apple) !put",
    ),
    // put into what holds the focused object
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(table_top) navigate(apple) navigate(sink) navigate(mug) pick navigate(apple) put navigate(mug)",
    ),
    // open, close
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "!open !close navigate(fridge) !open look_down !close open !open close !close open",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "navigate(sink) look_down !open !close navigate(table_top) navigate(apple) !open",
    ),
    // look
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_up !look_up look_down look_down look_down !look_down look_up",
    ),
    // navigate
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "!navigate(apple) navigate(fridge) navigate(stove_burner) look_down !navigate(apple) navigate(table_top) navigate(apple) navigate(apple)",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &["fridge"],
        "look_down !navigate(bowl) navigate(fridge) navigate(bowl) close !navigate(bowl) navigate(sink) !navigate(bowl) navigate(fridge) open navigate(bowl)",
    ),
    (
        ["table_top", "sink", "fridge", "cabinet"],
        &[],
        "look_down navigate(table_top) navigate(apple) pick !navigate(apple) put navigate(apple)",
    ),
];

#[test]
fn every_precondition() {
    for (places, open, actions) in ROWS {
        let mut kitchen = small(places, open);
        let layout = kitchen.layout().clone();
        let mut failures = 0;
        for word in actions.split_whitespace() {
            let fails = word.starts_with('!');
            let step = kitchen.act(action(&layout, word.trim_start_matches('!')));
            assert_eq!(kitchen.failed(), fails, "{word} of {actions}");
            assert_eq!(step.reward, if fails { -1.0 } else { 0.0 });
            failures += u32::from(fails);
        }
        let steps = actions.split_whitespace().count() as u32;
        assert_eq!((kitchen.steps(), kitchen.failures()), (steps, failures));
    }
}

#[test]
fn what_is_known_follows_what_is_done() {
    let mut kitchen = small(["fridge", "sink", "fridge", "cabinet"], &[]);
    let layout = kitchen.layout().clone();
    let id = |name| layout.id(name).unwrap();
    let (apple, bowl, fridge, table) = (id("apple"), id("bowl"), id("fridge"), id("table_top"));
    let start = *kitchen.known();
    assert_eq!((start.focus, start.horizon, start.hand, start.level()), (NONE, 0, NONE, 2));
    assert!(start.seen_in.iter().all(|&place| place == NONE) && start.in_view == [false; 64]);
    assert!(start.opened(table) && !start.opened(fridge) && !start.opened(id("cabinet")));

    let mut act = |text: &str| kitchen.act(action(&layout, text)).state;
    act("navigate(fridge)");
    let closed = act("look_down");
    assert!(closed.in_view[fridge as usize] && !closed.inspected[fridge as usize]);
    assert_eq!((closed.horizon, closed.level(), closed.seen_in[apple as usize]), (30, 1, NONE));
    let open = act("open");
    assert!(open.sees(apple) && open.sees(bowl) && open.inside(apple, fridge));
    assert_eq!((open.fullness[fridge as usize], open.inspected[fridge as usize]), (2, true));
    act("navigate(apple)");
    let held = act("pick");
    assert!(held.holds(apple) && held.sees(apple) && !held.in_view[apple as usize]);
    assert!(!held.inside(apple, fridge) && held.seen_in[apple as usize] == fridge);
    assert_eq!((held.focus, held.fullness[fridge as usize]), (fridge, 1));
    let away = act("navigate(table_top)");
    assert!(!away.sees(bowl) && away.inside(bowl, fridge) && away.opened(fridge));
    let put = act("put");
    assert!(put.inside(apple, table) && put.hand == NONE && put.focus == table);
    let shut = [act("navigate(fridge)"), act("close")][1];
    assert!(!shut.sees(bowl) && shut.inside(bowl, fridge) && !shut.opened(fridge));
    let other = shut.with_goal(bowl, table);
    assert_eq!(other.goal(), Goal { object: bowl, receptacle: table });
    assert_eq!(Known { wanted: shut.wanted, target: shut.target, ..other }, shut);
}

/// A random number below `n`.
fn below(n: usize, rng: &mut Xoshiro256PlusPlus) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

/// Random actions; those that will fail are drawn again three times out of four, so that things
/// happen.
fn random_action(kitchen: &Kitchen, rng: &mut Xoshiro256PlusPlus) -> Action {
    loop {
        let count = kitchen.actions();
        let index = if below(2, rng) == 0 { below(6, rng) } else { below(count, rng) };
        let action = Action::from_index(index);
        if kitchen.known().foresees(kitchen.layout(), action) || below(4, rng) == 0 {
            return action;
        }
    }
}

/// What must be true of every situation.
fn check(layout: &Layout, truth: &Truth, known: &Known) {
    for o in layout.object_ids() {
        let place = truth.place(o);
        assert_eq!(place == NONE, truth.hand() == o, "in a receptacle or in hand");
        assert!(place == NONE || layout.may_hold(place, o));
        let seen = known.seen_in[o as usize];
        assert!(seen == NONE || seen == place || place == NONE, "memory is knowledge");
        let r = known.focused_receptacle(layout);
        let visible = r != NONE && known.level() == layout.level(r) as usize && truth.is_open(r);
        assert_eq!(known.in_view[o as usize], visible && place == r);
    }
    for r in layout.receptacle_ids() {
        let holds = truth.contents(layout, r).count_ones();
        assert!(holds <= u32::from(layout.capacity(r)));
        assert_eq!(known.is_open[r as usize], truth.is_open(r));
        assert!(truth.is_open(r) || layout.has_door(r));
        let inspected = known.inspected[r as usize];
        let fullness = u32::from(known.fullness[r as usize]);
        assert_eq!(fullness, if inspected { holds } else { 0 });
    }
    assert_eq!(truth.focused_receptacle(layout), known.focused_receptacle(layout));
    let facts = (truth.focus(), truth.horizon(), truth.hand());
    assert_eq!(facts, (known.focus, known.horizon, known.hand));
}

/// Puts what was never in view elsewhere, among the receptacles that were never inspected, and
/// leaves all else as it was at the start.
fn rearranged(
    layout: &Layout,
    start: &Truth,
    end: &Known,
    rng: &mut Xoshiro256PlusPlus,
) -> Option<Truth> {
    let mut places: Vec<u8> = layout.object_ids().map(|o| start.place(o)).collect();
    let hidden = |&o: &u8| end.seen_in[o as usize] == NONE;
    let hidden: Vec<u8> = layout.object_ids().filter(hidden).collect();
    hidden.iter().for_each(|&o| places[o as usize] = NONE);
    for o in hidden {
        let holds = |r: u8| places.iter().filter(|&&place| place == r).count();
        let room = |&r: &u8| {
            !end.inspected[r as usize]
                && layout.may_hold(r, o)
                && holds(r) < layout.capacity(r) as usize
        };
        let rooms: Vec<u8> = layout.receptacle_ids().filter(room).collect();
        places[o as usize] = *rooms.get(below(rooms.len().max(1), rng))?;
    }
    let open = layout.receptacle_ids().filter(|&r| layout.has_door(r) && start.is_open(r));
    Some(Truth::start(layout, &places, &open.collect::<Vec<_>>()).unwrap())
}

fn layouts() -> impl Strategy<Value = Layout> {
    prop_oneof![Just(Layout::small()), Just(Layout::floorplan24())]
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 150, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn rules_hold_whatever_is_done(layout in layouts(), seed: u64) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let layout = Arc::new(layout);
        let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 100).unwrap();
        kitchen.reset(&mut rng);
        for t in 1..=100 {
            let action = random_action(&kitchen, &mut rng);
            let (truth, known, failures) = (*kitchen.truth(), *kitchen.known(), kitchen.failures());
            let step = kitchen.step(action.index(), &mut rng);
            prop_assert_eq!(kitchen.failed(), !known.foresees(&layout, action));
            prop_assert_eq!(kitchen.failures(), failures + u32::from(kitchen.failed()));
            if kitchen.failed() {
                prop_assert_eq!((&truth, &known), (kitchen.truth(), kitchen.known()));
            }
            prop_assert_eq!(&step.state, kitchen.known());
            prop_assert_eq!((step.truncated, step.terminated), (t == 100, false));
            check(&layout, kitchen.truth(), kitchen.known());
        }
    }

    #[test]
    fn nothing_hidden_leaks(layout in layouts(), seed: u64, length in 1..60) {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let layout = Arc::new(layout);
        let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 100).unwrap();
        let goal = kitchen.reset(&mut rng).goal();
        let start = *kitchen.truth();
        let task = phi_3(goal.object, goal.receptacle);
        let told = tasks::told::phi_3();
        let (mut q, mut known, mut actions) = (vec![0], vec![*kitchen.known()], Vec::new());
        for _ in 0..length {
            let action = random_action(&kitchen, &mut rng);
            actions.push(action);
            q.push(Monitor::next(&task, *q.last().unwrap(), known.last().unwrap()).unwrap());
            known.push(kitchen.act(action).state);
        }
        let Some(other) = rearranged(&layout, &start, known.last().unwrap(), &mut rng) else {
            return Ok(());
        };
        let mut again = vec![kitchen.start_at(other, goal).unwrap()];
        let mut r = 0;
        for (t, &action) in actions.iter().enumerate() {
            r = Monitor::next(&told, r, again.last().unwrap()).unwrap();
            prop_assert_eq!(r, q[t + 1]);
            again.push(kitchen.act(action).state);
        }
        prop_assert_eq!(again, known);
    }
}
