//! Renaming against the compiler: a task file whose names were changed one by one still compiles,
//! to the same formulas over the same predicates. A use that was not found would not be declared any more,
//! and one too many would mean something else.

use std::path::{Path, PathBuf};

use tltl_compiler::ast::{ItemKind, Node, NodeId};
use tltl_compiler::check;
use tltl_compiler::parse;
use tltl_compiler::predicate::{Function, Module};
use tltl_compiler::source::Source;
use tltlc::names::{Names, Refused};

/// The task files of the repository, and the examples of the reference.
fn sources() -> Vec<(String, String)> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let folders = [
        "examples/tasks",
        "examples/kitchen/tasks",
        "tests/data",
        "tests/data/tasks",
        "tools/tests/cli",
    ];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(root.join(folder)).unwrap());
    let mut files: Vec<PathBuf> = files.map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "tltl"));
    files.sort();
    let read = |path: PathBuf| {
        let text = std::fs::read_to_string(&path).unwrap();
        (path.display().to_string(), text)
    };
    let reference = std::fs::read_to_string(root.join("docs/language.md")).unwrap();
    let blocks = reference.split("```tltl\n").skip(1).map(|rest| rest.split("```").next().unwrap());
    let blocks = blocks.enumerate().map(|(i, text)| (format!("block {i}"), text.to_owned()));
    files.into_iter().map(read).chain(blocks).collect()
}

/// What a source means, without the names of its own.
fn meaning(module: &Module) -> Vec<String> {
    let task = |task: &tltl_compiler::predicate::Task| {
        let formulas: Vec<_> = task.spec.formulas().map(|(_, formula)| formula).collect();
        // Tasks share predicates whose parameters are called alike, so their numbers may change.
        format!("{formulas:?} {} {}", task.predicates.len(), task.parameters.len())
    };
    module.tasks.iter().map(task).collect()
}

#[test]
fn whatever_is_renamed_means_the_same() {
    let (mut renamed, mut shared) = (0, 0);
    for (name, text) in sources() {
        let source = Source::new(name.as_str(), text.as_str());
        let Ok(module) = check::file(&source) else { continue };
        let names = Names::new(&parse::file(&source).unwrap());
        for (id, symbol) in names.symbols() {
            let old = names.name(id);
            match names.renamed(id, "renamed_0") {
                Ok((text, places)) => {
                    let again = check::file(&Source::new("renamed", text.as_str()));
                    let again = again.unwrap_or_else(|errors| panic!("{name}, {old}: {errors}"));
                    assert_eq!(meaning(&again), meaning(&module), "{name}, {old}");
                    assert!(places.contains(&symbol.name), "{name}, {old}");
                    renamed += 1;
                }
                Err(Refused::Shared(_)) => shared += 1,
                Err(refused) => panic!("{name}, {old}: {refused}"),
            }
        }
    }
    assert!(renamed > 250 && shared * 20 < renamed, "{renamed} renamed, {shared} shared");
}

/// In a source that compiles, every name is declared in it, or is one of the language.
#[test]
fn every_name_is_known() {
    for (name, text) in sources() {
        let source = Source::new(name.as_str(), text.as_str());
        if check::file(&source).is_err() {
            continue;
        }
        let ast = parse::file(&source).unwrap();
        let names = Names::new(&ast);
        let roots = ast.items().iter().filter_map(|item| match item.kind {
            ItemKind::Constant(_, root)
            | ItemKind::Predicate(_, root)
            | ItemKind::Task(_, root) => Some(root),
            _ => None,
        });
        for id in roots.flat_map(|root| (ast.first(root).0..=root.0).map(NodeId)) {
            let at = match ast.node(id) {
                Node::Name => ast.span(id).start,
                Node::Field { field, .. } => field.start,
                _ => continue,
            };
            let word = ast.text(id);
            let is_ours = word == "none" || Function::named(word).is_some();
            assert!(is_ours || !names.at(at).is_empty(), "{name}: {word}");
        }
    }
}
