//! Sources and what their names stand for.

use super::{Expression, Name, Names, Resolved, Sort, resolve};
use crate::error::{Error, Errors};
use crate::parse;
use crate::source::Source;

/// What `read` finds in a source without mistakes of form, given its last item; and the mistakes.
pub(crate) fn read<T>(
    names: Names,
    text: &str,
    read: impl FnOnce(&Resolved<'_>, usize, &mut Vec<Error>) -> T,
) -> (T, Vec<Error>) {
    let source = Source::new("source", text);
    let (ast, mut mistakes) = match names {
        Names::Free => parse::recover_formula(&source),
        Names::Host => parse::recover_fragment(&source),
        Names::Declared => parse::recover_file(&source),
    };
    assert!(mistakes.is_empty(), "{text}: {mistakes:?}");
    let resolved = resolve(&ast, names, &mut mistakes);
    let found = read(&resolved, ast.items().len() - 1, &mut mistakes);
    (found, mistakes)
}

/// The messages of mistakes, in the order of the source.
pub(crate) fn messages(mistakes: Vec<Error>) -> Vec<String> {
    let errors = Errors::check(mistakes).err().into_iter().flatten();
    errors.map(|error| error.message().to_owned()).collect()
}

fn name(resolved: &Resolved<'_>, name: &Name) -> String {
    match name {
        Name::Parameter { number, .. } => format!("parameter {number}"),
        Name::Item(item, values) if values.is_empty() => format!("item {item}"),
        Name::Item(item, _) => format!("item {item} or value"),
        Name::Place(place, values) => {
            let or = if values.is_empty() { "" } else { " or value" };
            let unit = place.unit.as_ref().map(|unit| resolved.scope.units.text(unit));
            let unit = unit.map(|unit| format!(" in {unit}")).unwrap_or_default();
            let scalar = place.scalar().map_or("aggregate", |scalar| scalar.name());
            format!("place {} {scalar}{unit}{or}", place.segments.len())
        }
        Name::Values(values) => format!("value of {}", values.len()),
        Name::Value(value) => format!("value {}", value.number),
        Name::Absent => "none".to_owned(),
        Name::Function => "function".to_owned(),
        Name::Free => "free".to_owned(),
        Name::Rust => "rust".to_owned(),
        Name::Unknown(error) => error.message().to_owned(),
    }
}

/// The names and calls of the last item, each with what it stands for, and its value if it has one.
fn answers(names: Names, text: &str) -> String {
    let (answers, _) = read(names, text, |resolved, item, _| {
        let (first, root) = resolved.expressions[item].unwrap();
        let ids = (first.0..=root.0).map(super::ExpressionId);
        let answer = |id| {
            let value = resolved[id].value.map(|value| format!(" = {value}")).unwrap_or_default();
            let what = match &resolved[id].expression {
                Expression::Name(found) => name(resolved, found),
                Expression::Call(callee, _) => {
                    format!("call {:?} {:?}", callee.item, callee.function)
                }
                Expression::Number(_) => "number".to_owned(),
                _ if value.is_empty() => return None,
                _ => "calculated".to_owned(),
            };
            Some(format!("{}: {what}{value}", resolved.text(id)))
        };
        ids.filter_map(answer).collect::<Vec<_>>().join("; ")
    });
    answers
}

const FILE: &str = "enum Room { kitchen, hall } enum Thing { cup, hall }
    struct Pose { x: f64 in m, flags: [bool; 3], at: Room }
    state S { pose: Pose, room: Room?, on: bool, i: u8, t: [[f64; 2]; Room], kitchen: u8 }
    const two = 1 + 1
    predicate near(d: f64, r: Room) = pose.x < d
    task go = F on\n";

#[test]
fn names_of_a_file() {
    for (expression, expected) in [
        ("on", "on: place 1 bool"),
        ("pose.x < two", "pose: place 1 aggregate; pose.x: place 2 f64 in m; two: item 4 = 2"),
        ("q", "q: parameter 0"),
        (
            "near(q, cup)",
            "near: item 5; q: parameter 0; cup: value of 1; near(q, cup): call Some(5) None",
        ),
        ("room == hall", "room: place 1 enum; hall: value of 2"),
        ("room == Thing::hall", "room: place 1 enum; Thing::hall: value of 1"),
        ("room == kitchen", "room: place 1 enum; kitchen: place 1 u8 or value"),
        ("room == none", "room: place 1 enum; none: none"),
        (
            "t[hall][1] < 1",
            "t: place 1 aggregate; hall: value of 2; t[hall]: place 2 aggregate; 1: number = 1; t[hall][1]: place 3 f64; 1: number = 1",
        ),
        (
            "pose.flags[two]",
            "pose: place 1 aggregate; pose.flags: place 2 aggregate; two: item 4 = 2; pose.flags[two]: place 3 bool",
        ),
        (
            "-min(two, 3, 1) < abs",
            "min: function; two: item 4 = 2; 3: number = 3; 1: number = 1; min(two, 3, 1): call None Some(Min) = 1; -min(two, 3, 1): calculated = -1; abs: function",
        ),
        ("go && nosuch", "go: item 6; nosuch: nothing here is called `nosuch`"),
        ("pose.y < 1", "pose: place 1 aggregate; pose.y: there is no field `y`; 1: number = 1"),
        (
            "pose.flags[3]",
            "pose: place 1 aggregate; pose.flags: place 2 aggregate; 3: number = 3; pose.flags[3]: index 3 is beyond an array of 3 elements",
        ),
        (
            "pose.flags[i]",
            "pose: place 1 aggregate; pose.flags: place 2 aggregate; i: place 1 u8; pose.flags[i]: `i` may be beyond an array of 3 elements: it is a `u8`",
        ),
        (
            "sqr(1) < 2",
            "sqr: nothing here is called `sqr`; 1: number = 1; sqr(1): there is no function `sqr`; 2: number = 2",
        ),
        ("{ on }", "{ on }: `{ on }` is a Rust expression, which only the macro can read"),
        (
            "for all r in Room: room == r",
            "room: place 1 enum; r: value 0; room: place 1 enum; r: value 1",
        ),
        (
            "for all r in {q, 2}: i < r",
            "i: place 1 u8; q: parameter 0; i: place 1 u8; 2: number = 2",
        ),
        (
            "for all k in 0..=1: for some j in k..2: i < j",
            "i: place 1 u8; j: number = 0; i: place 1 u8; j: number = 1; i: place 1 u8; j: number = 1",
        ),
    ] {
        let text = format!("{FILE}task last(q: f64) = {expression}");
        assert_eq!(answers(Names::Declared, &text), expected, "{expression}");
    }
}

#[test]
fn other_sources_know_other_names() {
    for (names, text, expected) in [
        (
            Names::Free,
            "F a && x.y < abs(z)",
            "a: free; x: free; x.y: free; abs: free; z: free; abs(z): call None Some(Abs)",
        ),
        (Names::Free, "F f(a)", "f: free; a: free; f(a): there is no function `f`"),
        (
            Names::Host,
            "|s: &S| s.go(a) && near",
            "s: rust; s.go: rust; a: rust; s.go(a): rust; near: rust",
        ),
        (
            Names::Host,
            "enum E { one } task t(k: Kind) = s.kind == k && s.e == one",
            "s: rust; s.kind: rust; k: parameter 0; s: rust; s.e: rust; one: value of 1",
        ),
        (
            Names::Host,
            "3.x < 1",
            "3: number = 3; 3.x: `3` is a number, and has no parts; 1: number = 1",
        ),
    ] {
        assert_eq!(answers(names, text), expected, "{text}");
    }
}

#[test]
fn each_item_comes_after_those_that_it_uses() {
    for (text, order, circles) in [
        ("task a = b\ntask b = c && d\ntask c = x\ntask d = x", &[2, 3, 1, 0][..], 0),
        ("task a = for all k in {c, b}: b && k\ntask b = x\ntask c = x", &[1, 2, 0], 0),
        ("task a = b\ntask b = c\ntask c = a", &[2, 1, 0], 1),
        ("task a = a || b\ntask b = a", &[1, 0], 2),
    ] {
        let (found, mistakes) =
            read(Names::Declared, text, |resolved, _, _| resolved.order.clone());
        assert_eq!((&found[..], mistakes.len()), (order, circles), "{text}");
    }
}

#[test]
fn declarations_and_quantifiers_have_mistakes_of_their_own() {
    for (text, expected) in [
        ("state S { x: f64, x: u8 }", &["`x` is declared twice"][..]),
        (
            &format!("state S {{ x: {}f64{} }}", "[".repeat(65), "; 1]".repeat(65)),
            &["types nest more than 64 deep"],
        ),
        ("state S { x: float }", &["there is no type `float`"]),
        ("state S { x: bool in m }", &["only numbers have units, and `x` is none"]),
        (
            "enum E { } state S { e: [f64; no] }",
            &["the enumeration `E` has no values", "`no` is not a length"],
        ),
        ("state S { x: f64 } predicate p(x: u8) = x < 1", &["`x` is declared twice"]),
        ("state S { r#in: f64, in: f64 }", &["`in` is declared twice"]),
        ("state S { self: f64, self_: f64 }", &["`self_` is declared twice"]),
        ("enum E { Self, a, Self_ }", &["`Self_` is declared twice"]),
        ("predicate type = true task r#type = true", &["`type` is declared twice"]),
        ("state S { in: f64 } predicate p(r#in: u8) = true", &["`in` is declared twice"]),
        ("task crate = for all crate_ in 0..2: crate_ < 1", &["`crate_` is declared twice"]),
        ("task t = for all a in {b}: for all r#a in {c}: a", &["`r#a` is bound twice"]),
        ("task t(a: f32) = a < 1", &["`f32` cannot be the type of a parameter"]),
        ("task t = for all x in No: x", &["`No` is not an enumeration that is declared here"]),
        ("task t = for all i in 2..1: i < 1", &["no number is in `2..1`"]),
        ("task t = for all x in {a}: for all x in {b}: x", &["`x` is bound twice"]),
        ("const k = 1.5 task t = for all i in 0..k: i < 1", &["`k` cannot be the end of a range"]),
    ] {
        let ((), mistakes) = read(Names::Declared, text, |_, _, _| ());
        assert_eq!(messages(mistakes), expected, "{text}");
    }
}

#[test]
fn indices_nest_no_deeper_than_they_are_read() {
    let nested = |depth: usize| "t[".repeat(depth) + "e" + &"]".repeat(depth);
    let sort = |depth| {
        let text =
            format!("enum E {{ a }} state S {{ t: [E; E], e: E }} task p = {}", nested(depth));
        read(Names::Declared, &text, |resolved, item, _| {
            resolved.sort(resolved.expressions[item].unwrap().1)
        })
        .0
    };
    assert_eq!(sort(4), Some(Sort::Enum { of: 0, optional: false }));
    assert_eq!(sort(5), None);
}

#[test]
fn names_in_a_macro_are_names_in_rust() {
    let taken = |name| format!("`{name}` is a word of Rust's own, and cannot be a name in a macro");
    for (text, name) in [
        ("|self: &S| F self.x > 1", "self"),
        ("state _: S; task t = F { true }", "_"),
        ("state s: S; predicate p(Ok: f64) = s.x < Ok", "Ok"),
        ("for all None in 0..2: F near(None)", "None"),
    ] {
        let ((), mistakes) = read(Names::Host, text, |_, _, _| ());
        assert_eq!(messages(mistakes), [taken(name)], "{text}");
    }
}
