//! Enumerations, parameters and quantifiers, from task file to verdict.

use tltl::robustness::{Predicate, Predicates};
use tltl::{include_tltl, tltl};
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::emit::rust;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

include_tltl!("data/kitchen.tltl");
include_tltl!("data/kitchen.tltl", state = Mine, mod = own);

use kitchen::{Kitchen, Object, Receptacle};

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
    state House { visited: [bool; Room], room: Room, hand: Object?, x: f64 }
    predicate at(r: Room) = room == r
    predicate near(d: f64) = -d < x < d
    task visit(r: Room) = F at(r)
    task go(a: Room, b: Room) = at(a) T at(b)
";

/// Formulas and what they mean, in the words of the automaton's propositions.
const MEANINGS: [(&str, &str); 16] = [
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
];

#[test]
fn quantifiers_and_arguments_mean_what_they_spell_out() {
    for (formula, meaning) in MEANINGS {
        let compiled = compiled(&format!("{WORLD}task t = {formula}"));
        let task = compiled.module.tasks.last().unwrap();
        assert_eq!(task.spec.to_string(), meaning, "{formula}");
    }
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
