//! The subject of a command: a formula, a task of a file, or an automaton of another tool.
//!
//! One argument can be any of them. A text is a file if such a file exists, or if its name ends as
//! one does; a missing `.tltl` is then reported as missing, not as a bad formula.

use std::path::Path;

use tltl_compiler::dfa::Automata;
use tltl_compiler::predicate::Module;
use tltl_compiler::translate::Budget;

use crate::task::{Entry, NoSuchTask, TaskFile, Unmade};

use super::Streams;
use super::input::{self, Made};

/// Reads `FILE`, `FILE:TASK` or a formula, and reports its mistakes; `None` if it has any. A task
/// that declares a budget has that one.
pub(super) fn read(
    text: &str,
    task: Option<&str>,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Result<Option<Entry>, String> {
    read_any(text, task, budget, streams)?.whole(streams)
}

/// The same where a task will do whose automaton is larger than the budget allows.
pub(super) fn read_any(
    text: &str,
    task: Option<&str>,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Result<Made<Entry>, String> {
    let (path, named) = split(text);
    if looks_like_file(path) || task.is_some() {
        return file(path, once(named, task)?, budget, streams);
    }
    let formula = input::made(TaskFile::of_formula(text, budget), streams)?;
    formula.map(|formula| choose(&formula, None, ""))
}

/// `FILE:TASK` in its two parts; any other text is the first of them. Arguments may follow the task
/// in brackets, and may have a `:` in them.
pub(super) fn split(text: &str) -> (&str, Option<&str>) {
    let named = text.split_once('(').map_or(text, |(named, _)| named);
    match named.rfind(':') {
        Some(colon) if !exists(text) && looks_like_file(&text[..colon]) => {
            (&text[..colon], Some(&text[colon + 1..]))
        }
        _ => (text, None),
    }
}

/// The task that is named behind the file or by `--task`, but not by both.
pub(super) fn once<'t>(
    behind: Option<&'t str>,
    option: Option<&'t str>,
) -> Result<Option<&'t str>, String> {
    match (behind, option) {
        (Some(one), Some(other)) => {
            Err(format!("the task is named twice: `{one}` behind the file, and `--task {other}`"))
        }
        (one, other) => Ok(one.or(other)),
    }
}

/// Whether a path can be read: a file, or `-` for the input.
fn exists(path: &str) -> bool {
    path == "-" || Path::new(path).is_file()
}

/// Whether a text is meant as a path.
pub(super) fn looks_like_file(path: &str) -> bool {
    // A folder or a device is none that can be read, and then the message says so.
    let is_there = path.contains('/') && Path::new(path).exists();
    exists(path) || is_there || path.ends_with(".tltl") || path.ends_with(".hoa")
}

/// Reads a file, and finds the task in it.
fn file(
    path: &str,
    name: Option<&str>,
    budget: Budget,
    streams: &mut Streams<'_>,
) -> Result<Made<Entry>, String> {
    let how = " as FILE:TASK";
    one(input::file(Path::new(path), name, budget, streams)?, name, how)?
        .map(|file| choose(&file, name, how))
}

/// A file of which one task is meant. If the automaton of some task is too large, it must be that
/// one: nobody has asked for the others.
pub(super) fn one<T>(made: Made<T>, name: Option<&str>, how: &str) -> Result<Made<T>, String> {
    if let Made::TooLarge(_, module) = &made {
        Unmade::new(Module::clone(module), name).map_err(|error| missing(&error, how))?;
    }
    Ok(made)
}

/// The task of that name, or the only one if no name is given. `how` tells how to name one.
pub(super) fn choose(file: &TaskFile, name: Option<&str>, how: &str) -> Result<Entry, String> {
    if file.is_automaton() && name.is_some() {
        let path = file.source().name();
        return Err(format!("{path} is an automaton: it has no tasks with names"));
    }
    file.find(name).map_err(|error| missing(&error, how))
}

/// The message for a file without the task that was asked for.
pub(super) fn missing(error: &NoSuchTask, how: &str) -> String {
    match error {
        NoSuchTask::Several(names) => {
            let names = names.join(", ");
            format!("the file has several tasks; choose one{how}: {names}")
        }
        error => error.to_string(),
    }
}

/// The automata of a task, or the reason why a factored one has none.
pub(super) fn automata(entry: &Entry) -> Result<&Automata, String> {
    entry.automata().ok_or_else(|| {
        let name = entry.name().unwrap_or_default();
        format!(
            "task `{name}` is factored: its parts have automata, and it has none of its own; without `#[factored]` it has one, if that is not too large"
        )
    })
}
