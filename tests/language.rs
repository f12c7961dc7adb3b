//! Enumerations, parameters and quantifiers, from task file to verdict.

use tltl::robustness::{Predicate, Predicates};
use tltl::{include_tltl, tltl};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::emit::rust;

include_tltl!("data/kitchen.tltl");
include_tltl!("data/kitchen.tltl", state = Mine, mod = own);

include_tltl!("data/known.tltl");
include_tltl!("data/known.tltl", state = Grown, mod = grown);

use kitchen::{Kitchen, Object, Receptacle};
use known::Known;

const START: Kitchen = Kitchen {
    holding: None,
    is_open: [false; 3],
    seen_in: [Some(Receptacle::cabinet), None, None],
    focus: Receptacle::fridge,
    distance: 2.0,
};

fn compiled(text: &str) -> Compiled {
    let source = Source::new("task.tltl", text);
    compile::file(&source, Budget::default())
        .unwrap_or_else(|errors| panic!("{}", errors.render(&source, Default::default())))
}

/// Enumerations and a state for the rows below.
const WORLD: &str = "enum Room { kitchen, hall, attic }
    enum Object { apple, mug }
    state House {
        visited: [bool; Room], room: Room, hand: Object?, x: f64, n: u8, lit: bool,
        open: [bool; 4], level: [i8; 4],
    }
    predicate at(r: Room) = room == r
    predicate near(d: f64) = -d < x < d
    task visit(r: Room) = F at(r)
    task go(a: Room, b: Room) = at(a) T at(b)
    const two = 2
    predicate ready(i: u8, dark: bool) = open[i] && (dark || lit)
    predicate holds(o: Object?) = hand == o
    task raise(i: u8, by: i8) = F ready(i, false) && F level[i] > by
";

/// Formulas and what they mean, in the words of the automaton's propositions.
const MEANINGS: [(&str, &str); 33] = [
    (
        "for all r in Room: F visited[r]",
        "F visited[kitchen] && F visited[hall] && F visited[attic]",
    ),
    ("for some r in {hall, attic}: F at(r)", "F at(hall) || F at(attic)"),
    (
        "for all r in {kitchen, hall}: for all q in {attic, r}: X visited[q]",
        "X visited[attic] && X visited[kitchen] && X visited[attic] && X visited[hall]",
    ),
    ("for all r in Room: r == hall || F at(r)", "F at(kitchen) && F at(attic)"),
    ("for all r in Room: r != hall => F at(r)", "F at(kitchen) && F at(attic)"),
    (
        "!(for some r in {hall, attic}: at(r)) U at(kitchen)",
        "(!at(hall) && !at(attic)) U at(kitchen)",
    ),
    ("visit(hall)", "F at(hall)"),
    ("visit(hall) && visit(attic)", "F at(hall) && F at(attic)"),
    ("visit(hall) && F at(hall)", "F at(hall)"),
    ("go(hall, attic)", "at(hall) T at(attic)"),
    (
        "for all r in {hall, attic}: go(kitchen, r)",
        "(at(kitchen) T at(hall)) && (at(kitchen) T at(attic))",
    ),
    ("F (hand == none) && F (hand != none)", "F (hand == none) && F !(hand == none)"),
    ("F (Object::apple == hand)", "F (hand == apple)"),
    ("F visited[room]", "F visited[room]"),
    ("for all d in {1, 2}: F near(d)", "F near(1) && F near(2)"),
    ("F near(2 * 3)", "F near(6)"),
    ("F ready(two, true)", "F ready(2, true)"),
    ("F ready(two, lit)", "F ready(2, lit)"),
    ("raise(1, -5)", "F ready(1, false) && F (level[1] > -5)"),
    (
        "F level[1] > -5 && raise(two - 1, -5)",
        "F (level[1] > -5) && F ready(1, false) && F (level[1] > -5)",
    ),
    ("for all i in 1..3: F open[i]", "F open[1] && F open[2]"),
    ("for all i in 1..=two: F open[i]", "F open[1] && F open[2]"),
    ("for some i in 0..two: F (x < i)", "F (x < 0) || F (x < 1)"),
    // What a known comparison settles is not asked whether its bounds and indices are in order.
    ("for all i in 0..3: i > 0 => F[1,i] open[i]", "X open[1] && F[1,2] open[2]"),
    ("for some i in 0..3: F lit && (i > 1 && F[2,i] open[i])", "F lit && X[2] open[2]"),
    ("for all i in 2..9: i >= 4 || F open[i]", "F open[2] && F open[3]"),
    ("!(for some i in 3..6: !(i > 3) && open[i]) U lit", "!open[3] U lit"),
    ("for all r in Room: r == hall => (r == attic => X[-1] lit) && F lit", "F lit"),
    ("for all r in {attic}: r == hall => F lit && (r == attic => X[-1] lit) || lit", "true"),
    ("for all i in 2..4: F ready(i, true)", "F ready(2, true) && F ready(3, true)"),
    ("F holds(none) && F holds(Object::mug)", "F holds(none) && F holds(mug)"),
    ("F near(n)", "F near(n)"),
    ("F open[two]", "F open[2]"),
];

#[test]
fn quantifiers_and_arguments_mean_what_they_spell_out() {
    for (formula, meaning) in MEANINGS {
        let compiled = compiled(&format!("{WORLD}task t = {formula}"));
        let task = compiled.module.tasks.last().unwrap();
        assert_eq!(task.spec.to_string(), meaning, "{formula}");
    }
    let high = "predicate high = for all i in 2..9: 0 < i < 4 => level[i] > i";
    let module = compiled(&format!("{WORLD}{high}\ntask t = F high")).module;
    let high = module.predicates.iter().find(|predicate| predicate.name == "high").unwrap();
    let meaning = "level[2] > 2 && level[3] > 3";
    assert_eq!(module.display(high.condition).to_string(), meaning);
}

#[test]
fn quantifiers_over_what_a_formula_has() {
    let spec = |text: &str| {
        let source = Source::new("<formula>", text);
        let compiled = compile::formula(&source, Budget::default()).unwrap();
        compiled.module.tasks[0].spec.to_string()
    };
    assert_eq!(spec("for all x in {a, b}: F x"), "F a && F b");
    assert_eq!(spec("for some v in {1, 2}: X (x < v)"), "X (x < 1) || X (x < 2)");
    let (near, far) = (|x: &f64| 1.0 - x, |x: &f64| x - 5.0);
    let both = tltl! { for all p in {near, far}: F p };
    assert!(both.satisfied(&[0.0, 9.0]).unwrap());
    assert!(!both.satisfied(&[0.0, 2.0]).unwrap());
}

#[test]
fn what_is_written_out_is_bounded() {
    let names: Vec<_> = (0..20).map(|i| format!("for all x{i} in {{a, b}}: ")).collect();
    let source = Source::new("<formula>", names.concat() + "F (x0 && x19)");
    let errors = compile::formula(&source, Budget::default()).unwrap_err();
    assert_eq!(errors.first().kind().name(), "budget");
}

#[test]
fn a_place_has_one_value() {
    let states = |formula: &str| {
        let compiled = compiled(&format!("{WORLD}task t(r: Room) = {formula}"));
        compiled.automata.last().unwrap().dfa.size().states
    };
    assert_eq!(states("F (room == hall || room == attic || room == kitchen || F at(r))"), 1);
    assert_eq!(states("at(r) T at(hall)"), 3);
    assert_eq!(states("X (at(hall) && at(r)) && X X at(r)"), 5);
}

#[test]
fn the_kitchen_as_rust() {
    let file = compiled(include_str!("data/kitchen.tltl"));
    insta::assert_snapshot!(rust::file(&file));
}

#[test]
fn a_delivery_takes_its_arguments_at_run_time() {
    let hold = Kitchen { holding: Some(Object::mug), ..START };
    let open = Kitchen { is_open: [false, true, false], ..hold };
    let done = Kitchen { holding: None, seen_in: [None, None, Some(Receptacle::fridge)], ..open };
    let trajectory = [START, hold, open, done];
    let of = |object, receptacle| {
        let task = kitchen::deliver(object, receptacle);
        let verdict = task.satisfied(&trajectory).unwrap();
        let rho = task.robustness(&trajectory).unwrap();
        assert_eq!(rho > 0.0, verdict);
        let predicates = kitchen::deliver { object, receptacle };
        let all = (0..3).map(|i| Predicates::holds(&predicates, i, &done).unwrap());
        let signs: Vec<bool> =
            (0..3).map(|i| Predicates::robustness(&predicates, i, &done) > 0.0).collect();
        assert_eq!(all.collect::<Vec<_>>(), signs);
        verdict
    };
    assert!(of(Object::mug, Receptacle::fridge));
    assert!(!of(Object::apple, Receptacle::fridge));
    assert!(!of(Object::mug, Receptacle::cabinet));
    assert!(kitchen::either(Receptacle::fridge).satisfied(&[START, done]).unwrap());
    assert!(!kitchen::both().satisfied(&trajectory).unwrap());
    assert!(kitchen::empty_hand().satisfied(&[hold, START]).unwrap());
    assert!(kitchen::look_here().satisfied(&[open]).unwrap());
    assert!(kitchen::come(3.0).satisfied(&[START]).unwrap());
}

#[test]
fn predicates_are_functions() {
    let hold = Kitchen { holding: Some(Object::mug), ..START };
    assert_eq!(kitchen::hold(&hold, Object::mug), 1.0);
    assert_eq!(kitchen::inside(&START, Object::apple, Receptacle::cabinet), 1.0);
    assert_eq!(kitchen::within(&START, 0.5), -1.5);
    assert!(kitchen::hold { o: Object::mug }.holds(&hold).unwrap());
    assert_eq!(Object::ALL.map(Object::index), [0, 1, 2]);
    assert_eq!(Object::from_index(2), Some(Object::mug));
    assert_eq!(Object::from_index(3), None);
}

/// A state of the user's own.
#[derive(Clone, Copy)]
struct Mine {
    holding: Option<own::Object>,
    is_open: [bool; 3],
    seen_in: [Option<own::Receptacle>; 3],
    focus: own::Receptacle,
    distance: f64,
    #[allow(dead_code, reason = "what the task file does not know")]
    battery: u8,
}

#[test]
fn a_state_of_ones_own() {
    let start = Mine {
        holding: Some(own::Object::bowl),
        is_open: [true; 3],
        seen_in: [None; 3],
        focus: own::Receptacle::sink,
        distance: 0.0,
        battery: 100,
    };
    assert!(own::inspect().satisfied(&[start]).unwrap());
    assert!(!own::empty_hand().satisfied(&[start]).unwrap());
    assert!(!own::either(own::Receptacle::sink).satisfied(&[start]).unwrap());
    assert!(own::look_here().satisfied(&[start]).unwrap());
    assert!(own::come(1.0).satisfied(&[start]).unwrap());
}

#[derive(Clone, Copy, PartialEq)]
enum Room {
    Kitchen,
    Hall,
}

struct House {
    room: Room,
    s: f64,
}

tltl! {
    state house: House;
    predicate at(r: Room) = { house.room == r };
    predicate is(r: Room) = house.room == r;
    task visit(r: Room) = F at(r) && F is(r);
    task tour = visit(Room::Kitchen) && for all r in {Room::Hall, Room::Kitchen}: F { house.room == r };
    task reach(s: f64) = F house.s >= s;
}

#[test]
fn parameters_of_rust_types() {
    let at = |room| House { room, s: 1.0 };
    assert!(visit(Room::Hall).satisfied(&[at(Room::Kitchen), at(Room::Hall)]).unwrap());
    assert!(!visit(Room::Hall).satisfied(&[at(Room::Kitchen)]).unwrap());
    assert!(tour().satisfied(&[at(Room::Kitchen), at(Room::Hall)]).unwrap());
    assert!(!tour().satisfied(&[at(Room::Kitchen)]).unwrap());
    assert_eq!(reach(0.5).robustness(&[at(Room::Hall)]).unwrap(), 0.5);
}

const NOWHERE: Known =
    Known { hand: 255, in_view: [false; 64], seen_in: [255; 64], joints: [[0.0; 2]; 6], shift: 0 };

fn seen(o: usize, r: u8) -> Known {
    let mut known = NOWHERE;
    known.seen_in[o] = r;
    known.in_view[o] = r == 0;
    known
}

#[test]
fn numbers_as_parameters() {
    let way = [NOWHERE, seen(7, 0), seen(7, 45)];
    for (o, r, done) in [(7, 45, true), (8, 45, false), (7, 44, false), (7, 0, false)] {
        let task = known::fetch(o, r);
        assert_eq!(task.satisfied(&way).unwrap(), done, "{o} {r}");
        assert_eq!(task.robustness(&way).unwrap() >= 0.0, done, "{o} {r}");
    }
    assert_eq!(known::fetch(7, 46).robustness(&way).unwrap(), -1.0);
    assert!(!known::fetch_apple().satisfied(&way).unwrap());
    let way = [NOWHERE, seen(0, 0), seen(0, 45)];
    assert!(known::fetch_apple().satisfied(&way).unwrap());
    assert!(known::any().satisfied(&way).unwrap());
    assert!(!known::any().satisfied(&[seen(4, 0), seen(4, 45)]).unwrap());
    assert!(known::see(&Known { hand: 9, ..NOWHERE }, 9) >= 0.0);
    assert!(known::see { o: 9 }.holds(&Known { hand: 9, ..NOWHERE }).unwrap());
    let bent =
        Known { joints: [[0.0; 2], [0.0; 2], [2.0; 2], [0.0; 2], [0.0; 2], [0.0; 2]], ..NOWHERE };
    assert!(known::bend(2, true).satisfied(&[NOWHERE, bent]).unwrap());
    assert!(!known::bend(0, true).satisfied(&[NOWHERE, bent]).unwrap());
    assert_eq!(known::stretch().robustness(&[bent]).unwrap(), -1.0);
    assert!(known::r#move(5).satisfied(&[NOWHERE, Known { shift: 6, ..NOWHERE }]).unwrap());
    assert!(known::same(63).satisfied(&[NOWHERE]).unwrap());
}

/// A state of the user's own, with more room.
struct Grown {
    hand: u8,
    in_view: Vec<bool>,
    seen_in: Vec<u8>,
    joints: [[f64; 2]; 6],
    shift: i64,
}

#[test]
fn numbers_as_indices_of_a_state_of_ones_own() {
    let grown = |o: usize, r: u8| {
        let mut state = Grown {
            hand: 255,
            in_view: vec![true; 64],
            seen_in: vec![0; 64],
            joints: [[0.0; 2]; 6],
            shift: 0,
        };
        state.seen_in[o] = r;
        state
    };
    assert!(grown::fetch(3, 45).satisfied(&[grown(0, 0), grown(3, 45)]).unwrap());
    assert!(!grown::stretch().satisfied(&[grown(0, 0)]).unwrap());
    assert!(!grown::r#move(1).satisfied(&[grown(0, 0)]).unwrap());
}

#[test]
#[should_panic(expected = "`o` is an index of an array of 64 elements: `in_view[o]`")]
fn an_index_beyond_its_array_is_refused_where_the_task_is_made() {
    let _ = known::fetch(64, 45);
}

tltl! {
    state s: Known;
    predicate held(o: u8, wanted: bool) = { (s.hand == o) == wanted };
    predicate near(by: i16) = s.shift > by && { s.shift < 2 * by };
    task take(o: u8) = held(o, false) T held(o, true);
    task take_three = take(3) && for some i in 0..2: F s.joints[i][0] > i && F { s.joints[i][1] > 1.0 };
    task approach(by: i16) = F near(by) && F near(-4);
}

#[test]
fn numbers_as_parameters_of_the_macro() {
    let hold = |hand| Known { hand, ..NOWHERE };
    assert!(take(3).satisfied(&[NOWHERE, hold(3)]).unwrap());
    assert!(!take(4).satisfied(&[NOWHERE, hold(3)]).unwrap());
    assert!(!take_three().satisfied(&[NOWHERE, hold(3)]).unwrap());
    assert!(!approach(3).satisfied(&[Known { shift: 4, ..NOWHERE }]).unwrap());
}

#[test]
fn parameters_are_unknown_to_arithmetic() {
    let states = |formula: &str| {
        let compiled = compiled(&format!("{WORLD}task t(i: u8, j: u8, b: bool) = {formula}"));
        compiled.automata.last().unwrap().dfa.size().states
    };
    // i and j may be the same place, or not.
    assert_eq!(states("X (n == i) && X (n == j)"), 4);
    assert_eq!(states("X (level[i] > 3) && X (level[j] < 3)"), 4);
    // One parameter is one number, and no u8 is above 255.
    assert_eq!(states("F (n == i && n < i || n < 3)"), 2);
    assert_eq!(states("F (i > 254 && i != 255 || n < 3)"), 2);
    assert_eq!(states("F (b && n < 3)"), 2);
}
