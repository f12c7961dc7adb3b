//! `tltlc explain` and `tltlc diff`.

use std::process::ExitCode;

use tltl_compiler::dfa::Dfa;
use tltl_compiler::diff::{Difference, diff};
use tltl_compiler::explain::explain as explanation;

use super::subject::{self, Subject};
use super::{MISTAKEN, Outcome, input, print};

/// Tells what a task asks for.
pub(super) fn explain(text: &str, task: Option<&str>) -> Outcome {
    match subject::read(text, task)? {
        None => Ok(ExitCode::from(MISTAKEN)),
        Some(Subject::Automaton(_)) => {
            Err(format!("{text} is an automaton: it has no formula to explain"))
        }
        Some(Subject::Task(compiled, place)) => {
            let task = &compiled.module.tasks[place];
            let title = match &task.name {
                Some(name) => format!("{name} = {}", task.text),
                None => task.text.clone(),
            };
            let told = explanation(&task.spec, &compiled.automata[place].dfa);
            print(&headed(&format!("{title}\n\n{told}")))
        }
    }
}

/// Tells whether two tasks are the same, or how they differ.
pub(super) fn difference(first: &str, second: &str) -> Outcome {
    let (Some(first), Some(second)) = (subject::read(first, None)?, subject::read(second, None)?)
    else {
        return Ok(ExitCode::from(MISTAKEN));
    };
    let found = diff(automaton(&first), automaton(&second));
    print(&found.to_string())?;
    Ok(ExitCode::from(u8::from(found != Difference::None)))
}

fn automaton(subject: &Subject) -> &Dfa {
    match subject {
        Subject::Task(compiled, place) => &compiled.automata[*place].dfa,
        Subject::Automaton(automaton) => &automaton.dfa,
    }
}

/// The text with its headings, the lines that are not indented, in bold on a terminal.
fn headed(text: &str) -> String {
    if !input::colourful(&std::io::stdout()) {
        return text.to_owned();
    }
    let bold = |line: &str| match line {
        "" => "\n".to_owned(),
        line if line.starts_with(' ') => format!("{line}\n"),
        line => format!("\x1b[1m{line}\x1b[0m\n"),
    };
    text.lines().map(bold).collect()
}
