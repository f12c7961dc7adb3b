//! Tasks at run time: found by name, bound to arguments, run over rows.

use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Columns, InputKind, Scratch};
use tltlc::task::{Entry, TaskFile, Value};

fn file(name: &str, text: &str) -> TaskFile {
    TaskFile::new(Source::new(name, text), Budget::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn kitchen() -> TaskFile {
    file("kitchen.tltl", include_str!("data/kitchen.tltl"))
}

fn units() -> TaskFile {
    file("units.tltl", include_str!("data/units.tltl"))
}

/// The names of what a task reads with these arguments.
fn inputs(entry: &Entry, arguments: &[(&str, Value)]) -> Vec<String> {
    let evaluator = entry.evaluator(arguments).unwrap_or_else(|error| panic!("{error}"));
    evaluator.inputs().iter().map(|input| input.name.clone()).collect()
}

#[test]
fn a_task_is_found_by_its_name_or_because_it_is_the_only_one() {
    let kitchen = kitchen();
    assert_eq!(kitchen.find(Some("both")).unwrap().name(), Some("both"));
    let several = kitchen.find(None).unwrap_err().to_string();
    assert!(several.starts_with("the file has several tasks: deliver, both"), "{several}");
    let unknown = kitchen.find(Some("eat")).unwrap_err().to_string();
    assert!(unknown.starts_with("the file has no task `eat`; it has: deliver"), "{unknown}");
    assert_eq!(units().find(None).unwrap().name(), Some("halt"));
    let none = file("empty.tltl", "state S { x: f64 }");
    assert_eq!(none.find(Some("a")).unwrap_err().to_string(), "the file has no task");
}

#[test]
fn factored_tasks_are_found_as_others_are() {
    let goals = "state S { x: f64 }
        #[factored] task far = F (x < 1) && F (x > 2)
        #[factored] task near = F (x < 3) && F (x > 4)";
    let mixed = file("goals.tltl", &format!("{goals}\ntask plain = F (x < 0)"));
    assert_eq!(mixed.find(None).unwrap().name(), Some("plain"));
    assert!(mixed.find(Some("near")).unwrap().is_factored());
    let names: Vec<_> = mixed.entries().map(|entry| entry.name().unwrap().to_owned()).collect();
    assert_eq!(names, ["plain", "far", "near"]);
    let several = file("goals.tltl", goals).find(None).unwrap_err();
    assert_eq!(several.to_string(), "the file has several tasks: far, near");
}

#[test]
fn parameters_and_inputs_say_what_they_are() {
    let text =
        |entry: Entry| entry.parameters().iter().map(ToString::to_string).collect::<Vec<_>>();
    let deliver = kitchen().find(Some("deliver")).unwrap();
    assert_eq!(deliver.parameters()[1].values, ["cabinet", "fridge", "sink"]);
    assert_eq!(text(deliver), ["object: Object", "receptacle: Receptacle"]);
    let halt = units().find(None).unwrap();
    let evaluator = halt.evaluator(&[("d", 3.0.into())]).unwrap();
    let inputs = evaluator.inputs().iter();
    let inputs = inputs.map(|input| (input.name.as_str(), input.unit.as_deref()));
    assert_eq!(
        inputs.collect::<Vec<_>>(),
        [("x", Some("m")), ("speed", Some("m/s")), ("turns[1]", Some("deg")), ("load", None)]
    );
    assert_eq!(text(halt), ["d: f64 in m"]);
}

#[test]
fn arguments_are_bound_by_name() {
    let kitchen = kitchen();
    let deliver = kitchen.find(Some("deliver")).unwrap();
    let (mug, fridge) = (Value::from("mug"), Value::from("Receptacle::fridge"));
    let expected = ["holding", "is_open[fridge]", "seen_in[mug]"];
    for given in [
        [("object", mug.clone()), ("receptacle", fridge.clone())],
        [("receptacle", fridge), ("object", mug)],
    ] {
        assert_eq!(inputs(&deliver, &given), expected);
    }
    let sink = [("object", "mug".into()), ("receptacle", "sink".into())];
    let evaluator = deliver.evaluator(&sink).unwrap();
    let [holding, seen] = evaluator.inputs() else { panic!("{:?}", evaluator.inputs()) };
    assert_eq!((&*holding.name, &*seen.name), ("holding", "seen_in[mug]"));
    assert_eq!(holding.values, ["apple", "bowl", "mug"]);
    assert!(matches!(holding.kind, InputKind::Place(_)));
    // In the hand; in the sink.
    let columns = Columns::of_rows(2, 2, &[2.0, -1.0, -1.0, 2.0]).unwrap();
    let mut letters = [0; 2];
    evaluator.letters(&columns, &mut Scratch::default(), &mut letters).unwrap();
    assert_eq!(letters, [0b011, 0b110]);
}

#[test]
fn numbers_truth_values_and_texts_are_arguments() {
    let text = "enum Colour { red, green }
        state S { x: f64, n: u8, on: bool, seen: Colour?, at: [f64; 3] }
        const limit = 7
        predicate near(d: f64, most: u8, lit: bool, c: Colour?, i: u8) =
            x < d && n < most && (on || lit) && seen == c && at[i] > 0
        task t(d: f64, most: u8, lit: bool, c: Colour?, i: u8) = F near(d, most, lit, c, i)";
    let task = file("t.tltl", text).find(None).unwrap();
    let given = |changed: (&'static str, Value)| {
        let all: [(&str, Value); 5] = [
            ("d", 0.5.into()),
            ("most", 9.0.into()),
            ("lit", true.into()),
            ("c", "none".into()),
            ("i", 1.0.into()),
        ];
        all.map(|(name, value)| if name == changed.0 { changed.clone() } else { (name, value) })
    };
    let good: [(&str, Value); 8] = [
        ("d", "limit".into()),
        ("d", "2.5e3".into()),
        ("most", "255".into()),
        ("most", "limit".into()),
        ("lit", "false".into()),
        ("c", "Colour::red".into()),
        ("c", "green".into()),
        ("i", 2.0.into()),
    ];
    for changed in good {
        let evaluator = task.evaluator(&given(changed.clone()));
        assert!(evaluator.is_ok(), "{changed:?}: {evaluator:?}");
    }
    let takes = "`t` takes 5 arguments (d: f64, most: u8, lit: bool, c: Colour?, i: u8), and";
    let bad: [((&str, Value), &str); 9] = [
        (("d", f64::NAN.into()), "`t` takes `d: f64`, and `NaN` is not one of the numbers"),
        (("d", true.into()), "`t` takes `d: f64`, and `true` is not one of the numbers"),
        (("d", "far".into()), "`t` takes `d: f64`, and `far` is not one of the numbers"),
        (
            ("most", 256.0.into()),
            "`t` takes `most: u8`, and `256` is not one of the whole numbers from 0 to 255",
        ),
        (
            ("most", 1.5.into()),
            "`t` takes `most: u8`, and `1.5` is not one of the whole numbers from 0 to 255",
        ),
        (("lit", 1.0.into()), "`t` takes `lit: bool`, and `1` is not one of true, false"),
        (
            ("c", "Color::red".into()),
            "`t` takes `c: Colour?`, and `Color::red` is not one of red, green, none",
        ),
        (("c", 0.0.into()), "`t` takes `c: Colour?`, and `0` is not one of red, green, none"),
        (("i", 3.0.into()), "with these arguments, `at[3]` is beyond an array of 3 elements"),
    ];
    for (changed, message) in bad {
        assert_eq!(task.evaluator(&given(changed)).unwrap_err().to_string(), message);
    }
    let all = given(("d", 0.5.into()));
    let message = |given: &[(&str, Value)]| task.evaluator(given).unwrap_err().to_string();
    assert_eq!(message(&all[1..]), format!("{takes} `d` is missing"));
    assert_eq!(message(&[("e", true.into())]), format!("{takes} none is called `e`"));
    let twice = [("d", 1.0.into()), ("d", 1.0.into())];
    assert_eq!(message(&twice), format!("{takes} `d` is given twice"));
    let formula = TaskFile::of_formula("F a", Budget::default()).unwrap().find(None).unwrap();
    let message = formula.evaluator(&twice).unwrap_err().to_string();
    assert_eq!(message, "`the formula` takes no arguments, and none is called `d`");
}

#[test]
fn units_of_constants_are_those_of_the_parameters() {
    let halt = units().find(None).unwrap();
    let message = halt.evaluator(&[("d", "pause".into())]).unwrap_err().to_string();
    assert_eq!(message, "`halt` takes `d: f64 in m`, and `pause` is in s");
}

#[test]
fn mistakes_are_shown_with_the_source() {
    let error = TaskFile::of_formula("F a && G b", Budget::default()).unwrap_err();
    assert_eq!(error.errors().iter().count(), 1);
    let shown = error.to_string();
    assert!(shown.contains("F a && G b") && shown.contains("^"), "{shown}");
}
