//! The reference of the language: its examples compile, and the gallery of diagnostics is what the
//! compiler says today. `UPDATE_DOCS=1 cargo test -p tltl-tests reference` writes the gallery anew.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use tltl_compiler::compile;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::cases;

const HEAD: &str = "# Diagnostics

What the compiler says to each mistake, by kind. Written by a test from `tests/data/mistakes.txt`;
do not edit. [The language](language.md) tells what each kind means.
";

fn docs(name: &str) -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs").join(name)
}

fn read(name: &str) -> String {
    std::fs::read_to_string(docs(name)).unwrap_or_default()
}

#[test]
fn the_gallery_is_fresh() {
    let mut kinds: BTreeMap<String, String> = BTreeMap::new();
    for case in cases() {
        let kind = case.report.split(['[', ']']).nth(1).unwrap_or_default().to_owned();
        let text = kinds.entry(kind).or_default();
        let fence = if case.text.contains("```") { "````" } else { "```" };
        let _ = write!(
            text,
            "\n### {}\n\n{fence}text\n{}\n\n{}{fence}\n",
            case.name.replace('_', " "),
            case.text,
            case.report
        );
    }
    let sections = kinds.iter().map(|(kind, text)| format!("\n## {kind}\n{text}"));
    let gallery = HEAD.to_owned() + &sections.collect::<String>();
    if std::env::var_os("UPDATE_DOCS").is_some() {
        std::fs::write(docs("diagnostics.md"), &gallery).unwrap();
    }
    assert!(gallery == read("diagnostics.md"), "run this test with UPDATE_DOCS=1");
}

#[test]
fn every_kind_is_explained() {
    let (reference, gallery) = (read("language.md"), read("diagnostics.md"));
    for line in gallery.lines().filter_map(|line| line.strip_prefix("## ")) {
        let link = format!("| [`{line}`](diagnostics.md#{line}) |");
        assert!(reference.contains(&link), "language.md says nothing of {line}");
    }
}

/// The blocks of code in a language.
fn blocks(text: &str, language: &str) -> Vec<String> {
    let opening = format!("\n```{language}\n");
    let starts = text.split(&opening).skip(1);
    starts.map(|rest| rest.split("\n```").next().unwrap_or_default().to_owned()).collect()
}

#[test]
fn the_examples_compile() {
    let reference = read("language.md");
    for text in blocks(&reference, "tltl") {
        let source = Source::new("language.md", text);
        let compiled = compile::file(&source, Budget::default());
        let compiled = compiled
            .unwrap_or_else(|errors| panic!("{}", errors.render(&source, Default::default())));
        let warnings = tltlc::lint::warnings(&source, &compiled);
        assert!(warnings.is_empty(), "{warnings:?}");
    }
    for text in blocks(&reference, "rust") {
        let inside = text.trim().strip_prefix("tltl! {").and_then(|text| text.strip_suffix('}'));
        let source = Source::new("language.md", inside.unwrap());
        let compiled = compile::fragment(&source, Budget::default());
        assert!(compiled.is_ok(), "{}", compiled.unwrap_err().render(&source, Default::default()));
    }
}

#[test]
fn precedences_are_as_told() {
    let reference = read("language.md");
    let table = reference.split("| written | read |").nth(1).unwrap();
    let rows = table.lines().skip(2).take_while(|line| line.starts_with('|'));
    let meaning = |text: &str| {
        let compiled = compile::formula(&Source::new("row", text), Budget::default()).unwrap();
        compiled.module.tasks[0].spec.to_string()
    };
    for row in rows {
        let code: Vec<&str> = row.split('`').skip(1).step_by(2).collect();
        assert_eq!(meaning(code[0]), meaning(code[1]), "{row}");
    }
}
