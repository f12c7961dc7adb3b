//! The front end: every diagnostic as its reader sees it, refusals of the corpus, deep inputs,
//! and printing.

mod reference;

use std::fmt::Write;

use proptest::prelude::*;
use tltl_compiler::ast::{Ast, ItemKind};
use tltl_compiler::check;
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::error::{Errors, Kind, Style};
use tltl_compiler::parse;
use tltl_compiler::predicate::Module;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::diff::{Difference, diff};
use tltlc::lint;

fn checked(mode: &str, source: &Source) -> Result<Module, Errors> {
    match mode {
        "formula" => check::formula(source),
        "file" => check::file(source),
        "macro" => check::fragment(source),
        other => panic!("no mode {other}"),
    }
}

fn compiled(mode: &str, source: &Source) -> Result<Compiled, Errors> {
    let budget = Budget { states: 1_000, ..Budget::default() };
    match mode {
        "formula" => compile::formula(source, budget),
        "file" => compile::file(source, budget),
        _ => compile::fragment(source, budget),
    }
}

/// The errors of a source, or its warnings.
fn report(mode: &str, source: &Source) -> String {
    match compiled(mode, source) {
        Err(errors) => {
            let parsed = match mode {
                "formula" => parse::recover_formula(source),
                "file" => parse::recover_file(source),
                _ => parse::recover_fragment(source),
            };
            errors.with(lint::written(&parsed)).render(source, Style::Plain)
        }
        Ok(compiled) => {
            let warnings = lint::warnings(source, &compiled);
            let told = warnings.iter().map(|warning| warning.render(source, Style::Plain));
            told.collect::<Vec<_>>().join("\n")
        }
    }
}

/// A mistake of the gallery.
struct Case {
    name: &'static str,
    text: &'static str,
    /// What its author is told.
    report: String,
}

/// The mistakes of the gallery.
fn cases() -> Vec<Case> {
    let cases = include_str!("data/mistakes.txt").split("\n== ").skip(1);
    cases.map(case).collect()
}

fn case(case: &'static str) -> Case {
    let (head, text) = case.split_once('\n').unwrap_or((case, ""));
    let (name, mode) = head.split_once(' ').unwrap();
    let place = if mode == "file" { "task.tltl" } else { "<formula>" };
    let report = report(mode, &Source::new(place, text));
    assert!(!report.is_empty(), "{name} is accepted without a word");
    Case { name, text, report }
}

#[test]
fn every_diagnostic() {
    let mut gallery = String::new();
    for Case { name, text, report } in cases() {
        let _ = writeln!(gallery, "── {name} ──\n\n{}\n{report}", indented(text));
    }
    insta::assert_snapshot!("diagnostics", gallery);
}

/// What a message says to write can be written, and a formula among it is one.
#[test]
fn what_to_write_can_be_read() {
    for Case { name, report, .. } in cases() {
        for advice in report.split("write `").skip(1) {
            let text = advice.split('`').next().unwrap();
            let parts = [format!("{text} a"), format!("a {text} b"), format!("{text} task t = a")];
            let read = |text: &str| {
                let source = Source::new("<advice>", text);
                parse::formula(&source).is_ok() || parse::file(&source).is_ok()
            };
            let is_read = read(text) || parts.iter().any(|text| read(text));
            assert!(is_read || text.contains('…'), "{name}: {text}");
        }
    }
}

fn indented(text: &str) -> String {
    text.lines().fold(String::new(), |out, line| out + "    " + line + "\n")
}

#[test]
fn colours_change_no_word() {
    let source = Source::new("<formula>", "!F a");
    let errors = check::formula(&source).unwrap_err();
    let mut coloured = errors.render(&source, Style::Coloured);
    for code in ["\x1b[1m", "\x1b[1;31m", "\x1b[1;34m", "\x1b[0m"] {
        assert!(coloured.contains(code));
        coloured = coloured.replace(code, "");
    }
    assert_eq!(coloured, errors.render(&source, Style::Plain));
}

#[test]
fn refusals_of_the_corpus() {
    for line in include_str!("data/rejects.jsonl").lines() {
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        let formula = row["formula"].as_str().unwrap();
        let found = match check::formula(&Source::new("<formula>", formula)) {
            Ok(_) => "ok",
            Err(errors) if errors.first().kind().name() == "negated-temporal" => "negated-temporal",
            Err(_) => "syntax",
        };
        assert_eq!(found, row["expect"], "{formula}");
    }
}

/// Inputs with `n` of something.
fn deep(n: usize) -> Vec<String> {
    vec![
        "!".repeat(n) + "a",
        "F ".repeat(n) + "a",
        "a U ".repeat(n) + "b",
        "(".repeat(n) + "a" + &")".repeat(n),
        "!".repeat(n),
        "(".repeat(n),
        "X ".repeat(n) + "a",
        "!F ".repeat(n) + "a",
        "a T ".repeat(n) + "b",
        "a => ".repeat(n) + "b",
        "a && ".repeat(n),
        "a && ".repeat(n) + "b",
        "!(".repeat(n) + "a" + &")".repeat(n),
        "(".repeat(n) + "a" + &" T b)".repeat(n),
        "abs(".repeat(n) + "x" + &")".repeat(n) + " < 3",
        "-".repeat(n) + "x < 3",
        "x + ".repeat(n) + "1 < 3",
        "1 < ".repeat(n) + "x",
        "a.".repeat(n) + "b",
        "a[".repeat(n),
        "{".repeat(n),
        "f(a, ".repeat(n),
        "for all x in {a}: ".repeat(n) + "F x",
        "for some x in {a, b}: ".repeat(n) + "F x",
        "a".repeat(n),
        "\u{25c7}".repeat(n) + "a",
        "F[0,1] ".repeat(n) + "a",
        "a U[1,2] ".repeat(n) + "b",
        "!G ".repeat(n) + "a",
        "G[".repeat(n),
        "!(a W ".repeat(n) + "b" + &")".repeat(n),
        "a <=> (".repeat(n) + "b" + &")".repeat(n),
        "(".repeat(n) + "F a" + &" ensuring b)".repeat(n),
        "F a && G b".to_owned() + &" && G c".repeat(n),
    ]
}

/// Chains of `n` definitions, each of which has the one before it in it twice.
fn doubling(n: usize) -> Vec<String> {
    let chain = |first: &str, next: &dyn Fn(usize) -> String, last: &str| {
        let next: String = (1..n).map(|i| next(i) + "\n").collect();
        format!("state S {{ x: f64 }}\n{first}\n{next}{last} p{}(x)\n", n - 1)
    };
    let applied = |how: &'static str| {
        let next = move |i| {
            format!("predicate p{i}(v: f64) = {}", how.replace('p', &format!("p{}", i - 1)))
        };
        chain("predicate p0(v: f64) = v < 1", &next, "task t = F")
    };
    let tasks = |how: &'static str| {
        let next =
            move |i| format!("task p{i}(v: f64) = {}", how.replace('p', &format!("p{}", i - 1)));
        chain("task p0(v: f64) = F (v < 1)", &next, "task t =")
    };
    vec![
        applied("p(v + 1) && p(v + 2)"),
        applied("p(v + v)"),
        applied("p(v) || !p(v * v)"),
        tasks("p(v * v + 1)"),
        tasks("p(v) && X p(v)"),
        tasks("p(v) T p(v + v)").replace("task t =", "#[factored]\ntask t = F (x > 3) &&"),
        tasks("p(v) && X p(v)").replace("task t =", "#[factored]\ntask t = F (x > 3) &&"),
    ]
}

/// What stands in many places is shared, or refused before it is written out.
#[test]
fn definitions_that_double_get_an_answer() {
    for text in doubling(40) {
        let source = Source::new("<doubling>", text);
        if let Err(errors) = compiled("file", &source) {
            assert_eq!(
                errors.first().kind(),
                Kind::Budget,
                "{}",
                errors.render(&source, Style::Plain)
            );
            assert!(errors.first().render(&source, Style::Plain).len() < 2_000);
        }
    }
}

/// Of 300 goals, the ones that are too many together; not one try for each.
#[test]
fn what_grows_is_found_by_halving() {
    let text = "state S { x: [f64; 300] }\n\
                task t = F (x[0] > 1) && (X F (x[1] > 1) || for all i in 0..300: F (x[i] > 0))\n";
    let source = Source::new("<growing>", text);
    let errors = compiled("file", &source).unwrap_err();
    assert_eq!(errors.first().kind(), Kind::Budget);
    let span = errors.first().span();
    assert_eq!(source.slice(span), "for all i in 0..300: F (x[i] > 0)");
}

#[test]
fn deep_inputs_get_an_answer() {
    let check_all = || {
        let deepest = deep(100_000).into_iter().take(4).map(|text| ("formula", text));
        let deeper = deep(10_000).into_iter().map(|text| ("formula", text));
        let items = deep(5_000).into_iter().map(|text| ("file", format!("task t = {text}")));
        let tokens = deep(5_000).into_iter().map(|text| ("macro", text));
        for (mode, text) in deepest.chain(deeper).chain(items).chain(tokens) {
            let source = Source::new("<deep>", text);
            if let Err(errors) = checked(mode, &source) {
                assert!(errors.first().render(&source, Style::Plain).len() < 2_000);
            }
        }
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(check_all).unwrap().join().unwrap();
}

#[test]
fn a_call_has_the_brackets_of_its_callee() {
    let source = Source::new("tltl!", "X (near)(s)");
    let module = check::fragment(&source).unwrap();
    assert_eq!(module.tasks[0].spec.propositions(), ["(near)(s)"]);
}

#[test]
fn what_has_fields_keeps_its_brackets() {
    for (text, expected) in [
        ("1 .5 < x", "(1).5 < x"),
        ("0. .6 < x", "(0.).6 < x"),
        ("(a && b).x[1]", "(a && b).x[1]"),
        ("(x + 1)[2] < 3", "(x + 1)[2] < 3"),
        ("s.cells[1].0 < 3", "s.cells[1].0 < 3"),
    ] {
        let ast = parse::formula(&Source::new("<formula>", text)).unwrap();
        assert_eq!(printed(&ast), expected);
        let again = parse::formula(&Source::new("<formula>", expected)).unwrap();
        assert_eq!(printed(&again), expected);
    }
}

fn printed(ast: &Ast) -> String {
    match ast.items()[0].kind {
        ItemKind::Task(_, root) => ast.display(root).to_string(),
        _ => unreachable!("a formula is a task"),
    }
}

/// What a formula means, places aside.
fn meaning(module: &Module) -> String {
    let spec = &module.tasks[0].spec;
    let formulas: Vec<_> = spec.formulas().collect();
    format!("{:?} {:?} {formulas:?} {:?}", spec.propositions(), spec.root(), module.arena.terms())
}

/// Words of the language, which random texts are made of.
const WORDS: &[&str] = &[
    "F",
    "X",
    "G",
    "U",
    "T",
    "R",
    "W",
    "M",
    "ensuring",
    "step",
    "F[0,2]",
    "G[<=1]",
    "X[1]",
    "[1 s]",
    "U[1,2]",
    "T[<=2]",
    "[",
    "]",
    "0",
    "2",
    "1.5",
    "s",
    ",",
    "<=",
    "(",
    ")",
    "(a)",
    "a",
    "x",
    "!",
    "&&",
    "||",
    "<=>",
    "=>",
    "->",
    "==",
    "!=",
    "<",
    "-",
    "\"a b\"",
    "\"a\"",
    "[]",
    "◇",
    "<>",
    "○",
    ".",
    "in",
    "for all i in 0..2:",
    "i",
    "true",
    "#",
    "{",
    "}",
    "until",
    "/\\",
];

fn number() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        Just("x".to_owned()),
        Just("pose.y".to_owned()),
        Just("joints[2]".to_owned()),
        (0..100_u32).prop_map(|n| n.to_string()),
        Just("1.5e2".to_owned()),
    ];
    leaf.prop_recursive(4, 12, 2, |inner| {
        let pair = (inner.clone(), prop::sample::select(vec!["+", "-", "*", "÷"]), inner.clone());
        prop_oneof![
            pair.prop_map(|(a, op, b)| format!("{a} {op} {b}")),
            inner.clone().prop_map(|a| format!("({a})")),
            inner.clone().prop_map(|a| format!("-{a}")),
            (inner.clone(), inner).prop_map(|(a, b)| format!("hypot({a},{b})")),
        ]
    })
}

fn formula() -> impl Strategy<Value = String> {
    let comparison =
        (number(), prop::sample::select(vec!["<", "<=", ">", "≥", "==", "!="]), number());
    let leaf = prop_oneof![
        4 => prop::sample::select(vec!["a", "b", "true", "⊥", "InFridge"]).prop_map(str::to_owned),
        1 => comparison.prop_map(|(a, op, b)| format!("{a} {op} {b}")),
        1 => (number(), number(), number()).prop_map(|(a, b, c)| format!("{a} < {b} <= {c}")),
    ];
    leaf.prop_recursive(6, 40, 2, |inner| {
        let infix = vec!["&&", "||", "=>", "U", "T", "∧", "or", "->", "U[<= 2]", "T[1,2]", "R", "W"];
        let prefix = vec!["!", "F ", "X ", "◇", "not ", "F[1,2]", "G [1] ", "X[ 2 ]", "!G "];
        let loose = (inner.clone(), prop::sample::select(vec!["<=>", "ensuring"]), inner.clone());
        prop_oneof![
            1 => loose.prop_map(|(a, op, b)| format!("(({a}) {op} ({b}))")),
            2 => (inner.clone(), prop::sample::select(infix), inner.clone())
                .prop_map(|(a, op, b)| format!("{a} {op} {b}")),
            1 => (prop::sample::select(prefix), inner.clone()).prop_map(|(op, a)| format!("{op}{a}")),
            1 => inner.prop_map(|a| format!("( {a})")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn printing_keeps_the_meaning(text in formula()) {
        let source = Source::new("<formula>", text);
        let ast = parse::formula(&source).unwrap();
        let once = printed(&ast);
        let again = Source::new("<printed>", once.clone());
        let reparsed = parse::formula(&again).unwrap();
        prop_assert_eq!(&once, &printed(&reparsed));
        let laid_out = tltlc::format::format(&format!("task t = {}", source.text())).unwrap();
        prop_assert_eq!(tltlc::format::format(&laid_out), Some(laid_out.clone()));
        let text = laid_out.split_once("t = ").unwrap().1;
        prop_assert_eq!(&once, &printed(&parse::formula(&Source::new("<laid out>", text)).unwrap()));
        match (check::formula(&source), check::formula(&again)) {
            (Ok(a), Ok(b)) => prop_assert_eq!(meaning(&a), meaning(&b)),
            (Err(a), Err(b)) => prop_assert_eq!(a.first().kind(), b.first().kind()),
            (a, b) => prop_assert!(false, "{once}: {:?} {:?}", a.is_ok(), b.is_ok()),
        }
    }

    #[test]
    fn a_spec_prints_as_what_it_means(text in formula()) {
        let budget = Budget { states: 200, ..Budget::default() };
        let read = |text: String| compile::formula(&Source::new("<formula>", text), budget);
        if let Ok(written) = read(text) {
            let printed = written.module.tasks[0].spec.to_string();
            let again = read(printed.clone()).unwrap();
            let difference = diff(&written.automata[0].propositional, &again.automata[0].propositional);
            prop_assert!(matches!(difference, Difference::None), "{printed}: {difference}");
        }
    }

    #[test]
    fn words_in_any_order_get_an_answer(words in prop::collection::vec(prop::sample::select(WORDS), 1..24), blank in "[ ]?") {
        let text = words.join(&blank);
        let source = Source::new("<words>", text.as_str());
        let file = Source::new("<file>", format!("state S {{ a: bool, x: f64 }}\nstep 0.5 s\ntask t = {text}\n"));
        let _ = (report("formula", &source), report("file", &file));
        if let Ok(ast) = parse::formula(&source) {
            let once = printed(&ast);
            let again = parse::formula(&Source::new("<printed>", once.clone())).map(|ast| printed(&ast));
            prop_assert_eq!(again.as_ref(), Ok(&once));
        }
        if parse::file(&file).is_ok() {
            let laid_out = tltlc::format::format(file.text()).unwrap();
            prop_assert_eq!(tltlc::format::format(&laid_out), Some(laid_out.clone()));
            prop_assert!(parse::file(&Source::new("<laid out>", laid_out)).is_ok());
        }
    }

    #[test]
    fn no_text_is_too_strange(text in "[ab1x.,;:{}()\\[\\]|&!<>=*/+'\"\n FXUTGRWM◇∧-]{0,40}", item in "(state|task|predicate|const|struct|enum|step) [a-cF1]? ?") {
        for mode in ["formula", "file", "macro"] {
            for text in [text.clone(), format!("{item}{text}"), format!("{text}\n{item}= {text}")] {
                let source = Source::new("<text>", text);
                let _ = report(mode, &source);
            }
        }
    }
}
