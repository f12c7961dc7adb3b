//! The syntax of bounds, `ensuring` and `<=>`: what each spelling means, in terms of formulas whose
//! meaning is tested elsewhere, or the kind of its mistake.

use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::error::Errors;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::diff::{Difference, diff};

fn read(text: &str) -> Result<Compiled, Errors> {
    let budget = Budget { states: 10_000, ..Budget::default() };
    compile::formula(&Source::new("<formula>", text), budget)
}

/// Whether two formulas have the same models, their propositions matched by name.
fn alike(one: &Compiled, two: &Compiled) -> bool {
    let [one, two] = [one, two].map(|compiled| &compiled.automata[0].propositional);
    matches!(diff(one, two), Difference::None)
}

#[test]
fn every_spelling_means_what_it_must() {
    for line in include_str!("data/surface.jsonl").lines() {
        let row: serde_json::Value = serde_json::from_str(line).unwrap();
        let text = row["text"].as_str().unwrap();
        match (read(text), row["means"].as_str()) {
            (Ok(found), Some(means)) => {
                let expected = read(means).unwrap_or_else(|errors| panic!("{means}: {errors}"));
                assert!(alike(&found, &expected), "{text} is not {means}");
                let printed = found.module.tasks[0].spec.to_string();
                assert!(alike(&read(&printed).unwrap(), &expected), "{text} prints as {printed}");
            }
            (Err(errors), None) => {
                assert_eq!(errors.first().kind().name(), row["kind"], "{text}");
            }
            (found, _) => panic!("{text}: {:?}", found.map(drop)),
        }
    }
}
