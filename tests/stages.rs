//! Every stage of the pipeline on a fixed set of sources, as snapshots: what was parsed, what it
//! means, how large the automata are, the minimal automaton, and the Rust that users get.

use std::fmt::Write as _;

use tltl_compiler::ast::ItemKind;
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::parse;
use tltl_compiler::source::Source;
use tltl_compiler::spec::{Formula, Spec};
use tltl_compiler::translate::{Budget, translate};
use tltlc::emit::{rust, text};

const FORMULAS: [(&str, &str); 6] = [
    ("goal", "F a"),
    ("both", "F a && F b"),
    ("avoid", "!c U a"),
    ("then", "◇(fridge ∧ ○◇sink) ∨ (a T b)"),
    ("next", "X true && (a => X !b)"),
    ("numbers", "F (1 < x < 3 && x + y >= 2) && !(x > 5) U (y == 0)"),
];

const FILES: [(&str, &str); 2] = [
    ("gridworld", include_str!("../examples/tasks/gridworld.tltl")),
    ("arm", include_str!("data/tasks/arm.tltl")),
];

#[test]
fn every_stage_of_a_formula() {
    for (name, formula) in FORMULAS {
        let source = Source::new("formula", formula);
        let ast = parse::formula(&source).unwrap();
        let compiled = compile::formula(&source, Budget::default()).unwrap();
        insta::assert_snapshot!(format!("{name}_stages"), stages(&ast, &compiled));
    }
}

#[test]
fn every_stage_of_a_file() {
    for (name, text) in FILES {
        let source = Source::new(format!("{name}.tltl"), text);
        let ast = parse::file(&source).unwrap();
        let compiled = compile::file(&source, Budget::default()).unwrap();
        insta::assert_snapshot!(format!("{name}_stages"), stages(&ast, &compiled));
    }
}

fn stages(ast: &tltl_compiler::ast::Ast, compiled: &Compiled) -> String {
    let mut out = String::from("== parsed\n");
    for item in ast.items() {
        let root = match item.kind {
            ItemKind::Constant(_, root)
            | ItemKind::Predicate(_, root)
            | ItemKind::Task(_, root) => root,
            _ => continue,
        };
        let name = ast.source().slice(item.name);
        let _ = writeln!(out, "{name}: {}", ast.display(root));
    }
    for (task, automata) in compiled.module.tasks.iter().zip(&compiled.automata) {
        let raw = translate(&task.spec, Budget::default()).unwrap();
        let name = task.name.as_deref().unwrap_or("the formula");
        let _ = writeln!(out, "\n== {name} means\n{}", operators(&task.spec));
        let _ = writeln!(out, "== {name} raw\n{}", text::sizes(raw.size()));
        let title = format!("== {name} minimal, of propositions");
        let _ = writeln!(out, "{}", text::automaton(&title, &automata.propositional));
        if automata.dfa.possible.is_some() {
            let title = format!("== {name} minimal, with arithmetic");
            let _ = writeln!(out, "{}", text::automaton(&title, &automata.dfa));
        }
    }
    let rust = rust::file(compiled);
    let _ = writeln!(out, "== Rust, {} bytes\n{rust}", rust.len());
    out
}

/// The operators of a formula that it depends on, operands first.
fn operators(spec: &Spec) -> String {
    let reachable = spec.reachable();
    let mut out = String::new();
    for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
        let operator = match formula {
            Formula::Literal { proposition, negated } => {
                let not = if negated { "not " } else { "" };
                format!("{not}{}", spec.propositions()[proposition as usize])
            }
            Formula::True => "true".to_owned(),
            Formula::False => "false".to_owned(),
            Formula::And(a, b) => format!("{} and {}", a.0, b.0),
            Formula::Or(a, b) => format!("{} or {}", a.0, b.0),
            Formula::Next(a) => format!("next {}", a.0),
            Formula::Delay(n, a) => format!("next[{n}] {}", a.0),
            Formula::Eventually(a) => format!("eventually {}", a.0),
            Formula::Within(n, a) => format!("eventually[0,{n}] {}", a.0),
            Formula::Throughout(n, a) => format!("always[0,{n}] {}", a.0),
            Formula::UntilWithin(n, a, b) => format!("{} until[0,{n}] {}", a.0, b.0),
            Formula::Until(a, b) => format!("{} until {}", a.0, b.0),
            Formula::Then(a, b) => format!("{} then {}", a.0, b.0),
        };
        let _ = writeln!(out, "{:>3}  {operator}", id.0);
    }
    out
}
