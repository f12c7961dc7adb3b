//! Tasks at run time: found by name, bound to arguments, run over rows.

use tltl::factored::JointDeadEnds;
use tltl::{Acceptor, Monitor};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Column, Columns, InputKind, Scratch};
use tltlc::task::{self, Bound, Entry, Factored, Task, TaskFile, Value, Verdict};

use crate::corpus::rows;
use crate::random::{Choices, Seeded};

fn file(name: &str, text: &str) -> TaskFile {
    TaskFile::new(Source::new(name, text), Budget::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn kitchen() -> TaskFile {
    file("kitchen.tltl", include_str!("data/kitchen.tltl"))
}

fn units() -> TaskFile {
    file("units.tltl", include_str!("data/units.tltl"))
}

fn plain(entry: &Entry, arguments: &[(&str, Value)]) -> Task {
    match entry.bind(arguments) {
        Ok(Bound::Plain(task)) => task,
        Ok(Bound::Factored(_)) => panic!("{:?} is factored", entry.name()),
        Err(error) => panic!("{error}"),
    }
}

fn compiled(formula: &str) -> Task {
    task::compile(formula, Budget::default()).unwrap_or_else(|error| panic!("{error}"))
}

/// The names of what a task reads.
fn inputs(task: &Task) -> Vec<&str> {
    task.inputs().iter().map(|input| input.name.as_str()).collect()
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
    let task = plain(&halt, &[("d", 3.0.into())]);
    let inputs = task.inputs().iter().map(|input| (input.name.as_str(), input.unit.as_deref()));
    assert_eq!(
        inputs.collect::<Vec<_>>(),
        [("x", Some("m")), ("speed", Some("m/s")), ("turns[1]", Some("deg")), ("load", None)]
    );
    assert_eq!(text(halt), ["d: f64 in m"]);
}

/// Comparisons that exclude each other leave letters that cannot occur beside the transitions; with
/// more propositions than a dense table takes, both are nodes of one diagram.
#[test]
fn tables_hold_no_nodes_but_those_of_transitions() {
    let twelve = (0..12).map(|i| format!("x == {i}"));
    let any = twelve.clone().collect::<Vec<_>>().join(" || ");
    let all = twelve.collect::<Vec<_>>().join(" && ");
    for (formula, satisfied) in [(format!("F ({all})"), false), (format!("F ({any})"), true)] {
        let task = compiled(&formula);
        let q = [3.5, 7.0].iter().fold(0, |q, &x| task.next(q, &[x]).unwrap());
        assert_eq!(task.is_accepting(q), satisfied, "{formula}");
    }
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
        assert_eq!(inputs(&plain(&deliver, &given)), expected);
    }
    let sink = [("object", "mug".into()), ("receptacle", "sink".into())];
    let task = plain(&deliver, &sink);
    assert_eq!(task.arguments()[0], ("object".to_owned(), Value::from("mug")));
    let [holding, seen] = task.inputs() else { panic!("{:?}", task.inputs()) };
    assert_eq!((&*holding.name, &*seen.name), ("holding", "seen_in[mug]"));
    assert_eq!(holding.values, ["apple", "bowl", "mug"]);
    assert!(matches!(holding.kind, InputKind::Place(_)));
    // In the hand; in the sink.
    let columns = Columns::of_rows(2, 2, &[2.0, -1.0, -1.0, 2.0]).unwrap();
    let mut letters = [0; 2];
    task.evaluator().letters(&columns, &mut Scratch::default(), &mut letters).unwrap();
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
        let bound = task.bind(&given(changed.clone()));
        assert!(bound.is_ok(), "{changed:?}: {bound:?}");
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
        assert_eq!(task.bind(&given(changed)).unwrap_err().to_string(), message);
    }
    let all = given(("d", 0.5.into()));
    let message = |given: &[(&str, Value)]| task.bind(given).unwrap_err().to_string();
    assert_eq!(message(&all[1..]), format!("{takes} `d` is missing"));
    assert_eq!(message(&[("e", true.into())]), format!("{takes} none is called `e`"));
    let twice = [("d", 1.0.into()), ("d", 1.0.into())];
    assert_eq!(message(&twice), format!("{takes} `d` is given twice"));
    let formula = TaskFile::of_formula("F a", Budget::default()).unwrap().find(None).unwrap();
    let message = formula.bind(&twice).unwrap_err().to_string();
    assert_eq!(message, "`the formula` takes no arguments, and none is called `d`");
}

#[test]
fn units_of_constants_are_those_of_the_parameters() {
    let halt = units().find(None).unwrap();
    let message = halt.bind(&[("d", "pause".into())]).unwrap_err().to_string();
    assert_eq!(message, "`halt` takes `d: f64 in m`, and `pause` is in s");
}

#[test]
fn mistakes_are_shown_with_the_source() {
    let error = TaskFile::of_formula("F a && G b", Budget::default()).unwrap_err();
    assert_eq!(error.errors().iter().count(), 1);
    let shown = error.to_string();
    assert!(shown.contains("F a && G b") && shown.contains("^"), "{shown}");
}

/// Rows of small numbers, the same for a seed.
fn numbers(seed: u64, count: usize) -> Vec<f64> {
    let mut choices = Seeded(seed);
    (0..count).map(|_| f64::from(choices.choose(9)) - 4.0).collect()
}

#[test]
fn every_formula_of_the_corpus_runs() {
    let mut scratch = Scratch::default();
    for (seed, row) in (0..).zip(rows()) {
        let task = compiled(&row.formula);
        let width = task.inputs().len();
        let numbers = numbers(seed, 30 * width);
        let columns = Columns::of_rows(30, width, &numbers).unwrap();
        let run = task.run(&columns, &mut scratch).unwrap();
        let mut q = 0;
        for (t, &state) in run.states.iter().enumerate() {
            let here = &numbers[t * width..][..width];
            assert_eq!(run.progress[t], task.progress_robustness(q, here).unwrap(), "{}", row.id);
            q = task.next(q, here).unwrap();
            assert_eq!(state, q, "{}", row.id);
        }
        let trajectory: Vec<_> = (0..30).map(|t| &numbers[t * width..][..width]).collect();
        assert_eq!(run.robustness, task.trajectory_robustness(&trajectory).unwrap(), "{}", row.id);
    }
}

#[test]
fn threads_share_a_task() {
    fn shared<T: Send + Sync + Clone + 'static>() {}
    shared::<Task>();
    shared::<Factored>();
    shared::<TaskFile>();
    let task = compiled("(x < 1) T (y > 2)");
    let y = numbers(3, 5_000);
    let x: Vec<f32> = y.iter().rev().map(|&y| y as f32).collect();
    let run = |task: &Task| {
        let columns = [Column::from(&x[..]), Column::from(&y[..])];
        let columns = Columns::new(y.len(), &columns).unwrap();
        task.run(&columns, &mut Scratch::default()).unwrap()
    };
    let expected = run(&task);
    std::thread::scope(|scope| {
        let threads = [(); 4].map(|()| {
            let task = task.clone();
            scope.spawn(move || run(&task))
        });
        threads.into_iter().for_each(|thread| assert_eq!(thread.join().unwrap(), expected));
    });
}

#[test]
fn fingerprints_are_of_the_numbered_automaton() {
    let print = |formula: &str| compiled(formula).fingerprint();
    assert_eq!(print("F a && F b"), print("F a && (F b || false)"));
    // Pinned: another one is another numbering, and policies that were kept mean something else.
    assert_eq!(print("a T b"), "82d71b0aee93017d");
    let others = ["F a && F b", "F a && F c", "F b && F a", "F a || F b", "a T b", "!a U b", "F a"];
    for (at, formula) in others.iter().enumerate() {
        assert!(others[..at].iter().all(|other| print(other) != print(formula)), "{formula}");
    }
}

#[test]
fn factored_tasks_run_as_the_runtime_runs_them() {
    let text = "state S { x: f64, y: f64, z: f64 }
        predicate wet = z > 3
        #[factored]
        task all(far: f64) = F (x > far) && F (y < -2) && (!wet U (x < -far)) && F (y == z)";
    let all = file("all.tltl", text).find(None).unwrap();
    let Ok(Bound::Factored(all)) = all.bind(&[("far", 2.0.into())]) else { panic!("factored") };
    assert_eq!(inputs(&all.parts()[0]), ["x"]);
    let monitor = all.monitor().clone().numbered().unwrap();
    assert_eq!(monitor.task().joint_dead_ends(), JointDeadEnds::None);
    let (parts, mut scratch, mut seen) = (all.parts().len(), Scratch::default(), [0; 3]);
    for seed in 0..200 {
        let numbers = numbers(seed, 12 * 3);
        let columns = Columns::of_rows(12, 3, &numbers).unwrap();
        let run = all.run(&columns, &mut scratch).unwrap();
        let mut q = 0;
        for (t, row) in numbers.chunks(3).enumerate() {
            assert_eq!(run.progress[t], monitor.progress_robustness(q, row).unwrap());
            q = monitor.next(q, row).unwrap();
            let verdict = run.verdicts[t];
            seen[verdict as usize] += 1;
            assert_eq!(verdict == Verdict::Satisfied, monitor.is_accepting(q));
            assert_eq!(verdict == Verdict::Lost, monitor.is_trap(q));
            // All lost tuples are one number there.
            if verdict != Verdict::Lost {
                assert!(monitor.parts(q).eq(run.states[t * parts..][..parts].iter().copied()));
            }
        }
        let trajectory: Vec<_> = numbers.chunks(3).collect();
        assert_eq!(run.robustness, monitor.task().robustness(&trajectory).unwrap());
    }
    assert!(seen.iter().all(|&seen| seen > 50), "{seen:?}");
}

#[test]
fn a_batch_of_a_factored_task_moves_every_part() {
    let goals = "#[factored] task goals = F a && F b && F c
        state S { x: f64 }
        predicate a = x > 1
        predicate b = x > 2
        predicate c = x > 3";
    let goals = file("goals.tltl", goals).find(None).unwrap();
    let Ok(Bound::Factored(goals)) = goals.bind(&[]) else { panic!("factored") };
    let mut q = [0, 0, 0, 1, 0, 0];
    goals.step_batch(&mut q, &[true, false, true, false, true, false]);
    assert_eq!(q, [1, 0, 1, 1, 1, 0]);
}

#[test]
fn automata_of_many_propositions_run_on_labels() {
    let goals: Vec<_> = (0..70).map(|i| format!("(x > {i})")).collect();
    let task = compiled(&goals.join(" T "));
    let x: Vec<f64> = (0..80).map(f64::from).collect();
    let run = task.run(&Columns::of_rows(80, 1, &x).unwrap(), &mut Scratch::default()).unwrap();
    assert_eq!((run.verdict(), run.since()), (Verdict::Satisfied, Some(70)));
    assert_eq!(run.robustness, 10.0);
}
