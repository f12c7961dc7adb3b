//! The macros as rustc shows them: programs that must build and run, and programs that must not,
//! each with the messages that their authors read.
//!
//! After a change of a message, `TRYBUILD=overwrite cargo test -p tltl-tests ui` writes them anew.

use std::path::{Path, PathBuf};

/// They are compiled with the tests: trybuild would build everything once more for them.
#[path = "ui/pass/forms.rs"]
mod forms;
#[path = "ui/pass/hygiene.rs"]
mod hygiene;
#[path = "ui/pass/include.rs"]
mod include;

fn folder(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("ui").join(name)
}

/// trybuild compiles in a package of its own, where relative task files have to be.
fn copy_task_files() {
    let package = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../tests/trybuild/tltl-tests");
    let target = package.join("ui/tasks");
    std::fs::create_dir_all(&target).unwrap();
    for file in std::fs::read_dir(folder("tasks")).unwrap() {
        let file = file.unwrap();
        std::fs::copy(file.path(), target.join(file.file_name())).unwrap();
    }
}

#[test]
fn programs_that_must_build() {
    forms::main();
    hygiene::main();
    include::main();
}

#[test]
fn programs_that_must_not_build() {
    copy_task_files();
    trybuild::TestCases::new().compile_fail("ui/fail/*.rs");
}

/// The lines of a program that are marked as mistakes.
fn marked(text: &str) -> Vec<usize> {
    let lines = (1..).zip(text.lines());
    lines.filter(|(_, line)| line.contains("//~")).map(|(number, _)| number).collect()
}

#[test]
fn one_mistake_is_one_message() {
    for file in std::fs::read_dir(folder("fail")).unwrap() {
        let path = file.unwrap().path();
        if path.extension().is_some_and(|extension| extension == "rs") {
            let program = std::fs::read_to_string(&path).unwrap();
            let messages = std::fs::read_to_string(path.with_extension("stderr")).unwrap();
            let mut places = Vec::new();
            let mut error = false;
            for line in messages.lines() {
                error |= line.starts_with("error");
                let place = line.trim_start().strip_prefix("--> ui/fail/").filter(|_| error);
                if let Some(place) = place {
                    places.push(place.split(':').nth(1).unwrap().parse::<usize>().unwrap());
                    error = false;
                }
            }
            places.sort_unstable();
            assert_eq!(places, marked(&program), "{}", path.display());
        }
    }
}
