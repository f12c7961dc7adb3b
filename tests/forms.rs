//! The forms in which automata are shown: snapshots of a few, and what holds of all.

use std::fmt::Write as _;

use tltl_compiler::compile;
use tltl_compiler::dfa::{Dfa, Edge};
use tltl_compiler::minimize;
use tltl_compiler::proposition::{Proposition, Shape};
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::diff;
use tltlc::emit::labels::{Labelled, Labels};
use tltlc::emit::{dot, hoa, json, mermaid, sum, svg, text};
use tltlc::explain::explain;

const FORMULAS: [(&str, &str); 4] =
    [("eventually", "F a"), ("both", "F a && F b"), ("avoid", "!c U a"), ("back", "F(a && X X b)")];

fn compiled(formula: &str) -> compile::Compiled {
    let source = Source::new("formula", formula);
    compile::formula(&source, Budget::default())
        .unwrap_or_else(|errors| panic!("{formula}: {errors}"))
}

fn automaton(formula: &str) -> Dfa {
    compiled(formula).automata[0].propositional.clone()
}

#[test]
fn every_form_of_a_few_automata() {
    for (name, formula) in FORMULAS {
        let dfa = automaton(formula);
        let title = formula;
        insta::assert_snapshot!(format!("{name}_text"), text::automaton(title, &dfa));
        insta::assert_snapshot!(
            format!("{name}_dot"),
            dot::automaton(title, &dfa).unwrap().to_string()
        );
        insta::assert_snapshot!(
            format!("{name}_mermaid"),
            mermaid::automaton(title, &dfa).unwrap().to_string()
        );
        insta::assert_snapshot!(
            format!("{name}_hoa"),
            hoa::automaton(title, &dfa).unwrap().to_string()
        );
        insta::assert_snapshot!(format!("{name}_svg"), svg::automaton(title, &dfa));
    }
}

#[test]
fn explanations() {
    for (name, formula) in [
        ("order", "(!d U a) && (a T b T c)"),
        ("choice", "F(a && (b || !c)) || X X a"),
        ("change", "F (a && X !a) && F b"),
        ("always", "a || !a"),
        ("never", "a && !a"),
    ] {
        let compiled = compiled(formula);
        let spec = &compiled.module.tasks[0].spec;
        let told = explain(spec, &compiled.automata[0].propositional);
        insta::assert_snapshot!(format!("{name}_explained"), told);
    }
}

#[test]
fn differences() {
    for (name, first, second) in [
        ("same", "F a && F b", "F b && F a"),
        ("order", "F a && F b", "a T b"),
        ("other_names", "F a", "F b"),
        ("strict", "F(a && F b)", "a T b"),
        ("second_instant", "true", "X true"),
    ] {
        let found = diff::diff(&automaton(first), &automaton(second));
        insta::assert_snapshot!(format!("{name}_diff"), found);
    }
}

#[test]
fn a_trace_of_a_difference_is_judged_as_told() {
    let formulas =
        ["F a && F b", "a T b", "F(a && F b)", "!b U a", "X a", "a", "F a || F b", "X true"];
    for first in formulas {
        for second in formulas {
            let pair = [automaton(first), automaton(second)];
            let found = diff::diff(&pair[0], &pair[1]);
            let diff::Difference::Trace { trace, first: one, second: two, .. } = found else {
                assert_eq!(first, second);
                continue;
            };
            let verdicts = pair.map(|dfa| accepts(&dfa, &trace));
            assert_eq!(verdicts, [one, two], "{first} / {second}: {trace}");
            assert_ne!(one, two);
        }
    }
}

fn accepts(dfa: &Dfa, trace: &tltlc::trace::Trace) -> bool {
    let place = |one: &Proposition| trace.propositions.iter().position(|other| other == one);
    let places: Vec<_> = dfa.propositions.iter().map(|one| place(one).unwrap()).collect();
    let step = |q, letter: &Vec<bool>| dfa.next(q, |p| letter[places[p as usize]]);
    dfa.accepting == Some(trace.letters.iter().fold(0, step))
}

#[test]
fn guards_parse_back() {
    for formula in ["F a && F b && F c", "(a T b) && F c", "!(a && b) U (c || !d && X a)"] {
        let dfa = automaton(formula);
        for edge in dfa.edges().iter().filter(|edge| !edge.guard.iter().any(Vec::is_empty)) {
            let label = sum::label(&dfa, edge, sum::Notation::Ascii);
            let again = automaton(&label);
            let same = |p: u32| {
                let name = &dfa.propositions[p as usize];
                again.propositions.iter().position(|other| other == name)
            };
            for letter in 0..1_u32 << dfa.propositions.len() {
                let holds = |p: u32| letter >> p & 1 == 1;
                let taken = dfa.next(edge.from, holds) == edge.to;
                let place: Vec<_> = (0..dfa.propositions.len() as u32).map(same).collect();
                let read = again.next(0, |p| {
                    holds(place.iter().position(|at| *at == Some(p as usize)).unwrap() as u32)
                });
                assert_eq!(again.accepting == Some(read), taken, "{label} at {letter:b}");
            }
        }
    }
}

#[test]
fn tables_beyond_sixteen_propositions_are_refused() {
    let goals = |count: usize| (0..count).map(|i| format!("p{i}")).collect::<Vec<_>>().join(" T ");
    let formula = goals(17);
    let error = json::explicit(&formula, &automaton(&formula)).unwrap_err();
    insta::assert_snapshot!(error.to_string());
    assert!(json::explicit(&goals(3), &automaton(&goals(3))).is_ok());
}

#[test]
fn json_keeps_its_contract() {
    let dfa = automaton("!c U a");
    insta::assert_snapshot!(json::summary("!c U a", &dfa), @r#"{"formula":"!c U a","propositions":["c","a"],"states":3,"initial":0,"accepting":[1],"trap":2,"edges":2,"self_loops":3}"#);
    insta::assert_snapshot!(json::explicit("!c U a", &dfa).unwrap(), @r#"{"formula":"!c U a","propositions":["c","a"],"states":3,"initial":0,"accepting":[1],"trap":2,"edges":2,"self_loops":3,"transitions":[[0,2,1,1],[1,1,1,1],[2,2,2,2]]}"#);
}

/// The labels that are put together on the way through the diagram are those of the edges one by
/// one: where each edge is one path, where one or all of them are several, and where letters cannot
/// occur.
#[test]
fn labels_are_the_guards() {
    for formula in [
        "true",
        "F a && F b && F c",
        "a U b",
        "(!h U a) && (!h U b) && !h U c",
        "(a T b) && !c U d",
        "a && b || !a && c || X (b <=> c)",
        "F (x < 1 || x > 3) && F (x < 0)",
    ] {
        let dfa = automaton(formula);
        for notation in [sum::Notation::Ascii, sum::Notation::Mathematical, sum::Notation::Numbered]
        {
            let labels = Labels::new(&dfa, notation, &str::to_owned).unwrap();
            let (mut written, mut expected) = (String::new(), String::new());
            let line = |text: &mut String, edge: Labelled<'_>| {
                let Labelled { from, to, ends: [number, into], guard, is_first } = edge;
                writeln!(text, "{from}={number} {to}={into} {guard} {is_first}").unwrap();
            };
            labels.write(&mut written, &line).unwrap();
            let mut last = None;
            for edge in dfa.edges() {
                let Edge { from, to, .. } = edge;
                let is_first = last.replace(from) != Some(from);
                let guard = sum::label(&dfa, &edge, notation);
                writeln!(expected, "{from}={from} {to}={to} {guard} {is_first}").unwrap();
            }
            assert_eq!(written, expected, "{formula}");
        }
    }
}

#[test]
fn names_from_elsewhere_are_escaped() {
    let mut dfa = automaton("a U b");
    let named = |(name, shape): (&str, Shape)| Proposition { name: name.to_owned(), shape };
    let names = [("x < 3 \"&\"", Shape::Compound), ("p|1]#;\\", Shape::Foreign)];
    dfa.propositions = names.map(named).to_vec();
    let title = "<a> & \"b\" --> ]]";
    insta::assert_snapshot!("escaped_dot", dot::automaton(title, &dfa).unwrap().to_string());
    insta::assert_snapshot!(
        "escaped_mermaid",
        mermaid::automaton(title, &dfa).unwrap().to_string()
    );
    insta::assert_snapshot!("escaped_hoa", hoa::automaton(title, &dfa).unwrap().to_string());
    let svg = svg::automaton(title, &dfa);
    assert!(!svg.contains("<a>") && svg.contains("&lt;a&gt; &amp; "));
    let read = tltl_compiler::hoa::read(&Source::new(
        "x",
        hoa::automaton(title, &dfa).unwrap().to_string(),
    ))
    .unwrap();
    assert_eq!(read.name.as_deref(), Some(title));
    assert_eq!(read.dfa.propositions, dfa.propositions);
}

#[test]
fn the_smallest_and_large_automata_are_drawn() {
    for formula in ["true", "false", "a", "X true"] {
        assert!(svg::automaton(formula, &automaton(formula)).ends_with("</svg>\n"));
    }
    let shift = "F(a && X X X X X X b)";
    let dfa = automaton(shift);
    assert_eq!(minimize::minimize(&dfa).len(), 65);
    let svg = svg::automaton(shift, &dfa);
    assert_eq!(svg.matches("<circle").count(), 65 + 1);
}
