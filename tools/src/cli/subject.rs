//! What a command is about: a formula, a task of a file, or an automaton from elsewhere.

use std::path::Path;

use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::dfa::Automata;
use tltl_compiler::error::Errors;
use tltl_compiler::hoa;
use tltl_compiler::predicate::Task;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;

use super::{Report, Streams, input};

/// A subject that has been read.
pub(super) enum Subject {
    /// One task of a compiled source, by its place there.
    Task(Box<Compiled>, usize),
    /// An automaton in HOA.
    Automaton(Box<hoa::Automaton>),
}

/// Reads `FILE`, `FILE:TASK` or a formula, and reports its mistakes; `None` if it has any.
pub(super) fn read(
    text: &str,
    task: Option<&str>,
    streams: &mut Streams<'_>,
) -> Result<Option<Subject>, String> {
    let (path, named) = split(text);
    if exists(path) || looks_like_file(path) || task.is_some() {
        return file(path, named.or(task), streams);
    }
    let source = Source::new("formula", text);
    let compiled = compile::formula(&source, Budget::SHOWN);
    let compiled = input::reported(&source, compiled, Report::Human, streams)?;
    Ok(compiled.map(|compiled| Subject::Task(Box::new(compiled), 0)))
}

/// `FILE:TASK` in its two parts; what is no such thing is the first of them. What a task takes may
/// stand after it in brackets.
pub(super) fn split(text: &str) -> (&str, Option<&str>) {
    let named = text.split_once('(').map_or(text, |(named, _)| named);
    match named.rfind(':') {
        Some(colon) if !exists(text) && looks_like_file(&text[..colon]) => {
            (&text[..colon], Some(&text[colon + 1..]))
        }
        _ => (text, None),
    }
}

fn exists(path: &str) -> bool {
    path == "-" || Path::new(path).is_file()
}

fn looks_like_file(path: &str) -> bool {
    exists(path) || path.ends_with(".tltl") || path.ends_with(".hoa")
}

fn file(
    path: &str,
    name: Option<&str>,
    streams: &mut Streams<'_>,
) -> Result<Option<Subject>, String> {
    let source = Source::new(path, streams.read(Path::new(path))?);
    if source.text().trim_start().starts_with("HOA:") {
        let read = hoa::read(&source).map_err(Errors::from);
        let read = input::judged(&source, read, Report::Human, streams)?;
        return Ok(read.map(|automaton| Subject::Automaton(Box::new(automaton))));
    }
    let compiled = compile::file(&source, Budget::default());
    let Some(compiled) = input::reported(&source, compiled, Report::Human, streams)? else {
        return Ok(None);
    };
    let place = place(&compiled, name)?;
    Ok(Some(Subject::Task(Box::new(compiled), place)))
}

/// The task of that name; the only one if no name is given.
pub(super) fn choose<'a>(
    compiled: &'a Compiled,
    name: Option<&str>,
) -> Result<(&'a Task, &'a Automata), String> {
    let place = place(compiled, name)?;
    Ok((&compiled.module.tasks[place], &compiled.automata[place]))
}

fn place(compiled: &Compiled, name: Option<&str>) -> Result<usize, String> {
    let tasks = &compiled.module.tasks;
    let factored = compiled.factored.iter().find(|part| match name {
        None => tasks.is_empty(),
        Some(_) => part.task.name.as_deref() == name,
    });
    if let Some(Task { name: Some(name), .. }) = factored.map(|part| &part.task) {
        return Err(format!(
            "task `{name}` is factored: its parts have automata, and it has none of its own; without `#[factored]` it has one, if that is not too large"
        ));
    }
    let names: Vec<&str> = tasks.iter().filter_map(|task| task.name.as_deref()).collect();
    let names = names.join(", ");
    match (name, tasks.len()) {
        (_, 0) => Err("the file has no task".to_owned()),
        (None, 1) => Ok(0),
        (None, _) => Err(format!("the file has several tasks; choose one with --task: {names}")),
        (Some(name), _) => tasks
            .iter()
            .position(|task| task.name.as_deref() == Some(name))
            .ok_or_else(|| format!("the file has no task `{name}`; it has: {names}")),
    }
}
