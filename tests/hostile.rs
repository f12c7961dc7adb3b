//! Whatever names a source has: what it is compiled to says what it is evaluated to.
//!
//! Sources with names that hurt are built into one program, each as a module of `include_tltl!`, as
//! text of `tltlc automaton --format rust`, or as items and as an expression of `tltl!` beside
//! constants and variables of the same names. The program prints what each task makes of a
//! trajectory, and no warning of rustc may stand beside it.

mod source;

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

use tltl_compiler::check;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::emit::rust;
use tltlc::evaluate::{Columns, Scratch};
use tltlc::task::{Bound, TaskFile};

use source::{Call, Case};

/// How many sources of each of the two sorts are built.
const COUNT: usize = 16;

/// What the tool makes of a task on the states of a case, as bits.
fn evaluated(case: &Case, file: &TaskFile, call: &Call) -> u64 {
    let arguments: Vec<_> =
        call.arguments.iter().map(|(name, value, _)| (name.as_str(), value.clone())).collect();
    let bound = file.find(Some(&call.task)).unwrap().bind(&arguments).unwrap();
    let (inputs, evaluator) = match &bound {
        Bound::Plain(task) => (task.inputs(), task.evaluator()),
        Bound::Factored(task) => (task.inputs(), task.evaluator()),
    };
    let row = |state: &std::collections::BTreeMap<String, f64>| {
        let held = inputs.iter().map(|input| match state.get(&input.name) {
            Some(value) => *value,
            None => panic!("no place {}:\n{}", input.name, case.file),
        });
        held.collect::<Vec<_>>()
    };
    let numbers = case.states.iter().map(row).collect::<Vec<_>>().concat();
    let columns = Columns::of_rows(case.states.len(), inputs.len(), &numbers).unwrap();
    evaluator.robustness(&columns, &mut Scratch::default()).unwrap().to_bits()
}

/// The first sources that are accepted. Most of the others give one name to two things.
fn accepted(in_program: bool) -> Vec<(Case, TaskFile)> {
    let first = std::env::var("TLTL_SEED").map_or(0, |seed| seed.parse().unwrap());
    let mut tried = 0;
    let accepted: Vec<_> = (first..)
        .map(|seed| Case::new(seed, in_program))
        .inspect(|_| tried += 1)
        .filter(|case| {
            let in_macro = |rust: &source::Rust| {
                check::fragment(&Source::new("tltl!", rust.items.as_str())).is_ok()
            };
            case.rust.as_ref().is_none_or(in_macro)
        })
        .filter_map(|case| {
            let source = Source::new("task.tltl", case.file.as_str());
            let file = TaskFile::new(source, Budget::default());
            if let Err(error) = &file {
                let kind = error.errors().first().kind();
                assert!(
                    ["duplicate-name", "budget", "unsatisfiable"].contains(&kind.name()),
                    "{}\n{error}",
                    case.file
                );
            }
            file.ok().map(|file| (case, file))
        })
        .take(COUNT)
        .collect();
    eprintln!("{COUNT} of {tried} sources are accepted");
    accepted
}

/// The code that prints the robustness of a task.
fn printed(case: &Case, within: &str, states: &str, call: &Call) -> String {
    let arguments: Vec<_> =
        call.arguments.iter().map(|(.., code)| code.replace('§', within)).collect();
    let task = format!("{within}::{}({})", source::rust(&call.task), arguments.join(", "));
    printed_task(case, states, &task)
}

fn printed_task(case: &Case, states: &str, task: &str) -> String {
    let states = case.values(states);
    format!("    println!(\"{{}}\", {task}.robustness(&{states}).unwrap().to_bits());\n")
}

/// A program in the making: its files but the last, that one, and what it has to print.
#[derive(Default)]
struct Program {
    files: Vec<(String, String)>,
    modules: String,
    main: String,
    expected: Vec<(String, u64)>,
}

impl Program {
    /// A file as a module of the macro, and as text.
    fn file(&mut self, number: usize, case: &Case, file: &TaskFile) {
        self.files.push((format!("tasks/{number}.tltl"), case.file.clone()));
        self.files.push((format!("src/text{number}.rs"), rust::file(file.compiled())));
        let _ = writeln!(
            self.modules,
            "tltl::include_tltl!(\"tasks/{number}.tltl\", mod = file{number});\nmod text{number};"
        );
        for call in &case.calls {
            let expected = evaluated(case, file, call);
            for module in [format!("file{number}"), format!("text{number}")] {
                self.main += &printed(case, &module, &module, call);
                self.expected.push((format!("{module}::{}\n{}", call.task, case.file), expected));
            }
        }
    }

    /// Items over a struct of the program, and an expression.
    fn program(&mut self, number: usize, case: &Case, file: &TaskFile) {
        let Some(rust) = &case.rust else { return };
        let (module, world) = (format!("items{number}"), format!("w{number}"));
        let over = |text: &str| text.replace("super::w::", &format!("super::{world}::"));
        let source::Rust { state, constants, items, formula, variables } = rust;
        let _ = writeln!(
            self.modules,
            "mod {world} {{\n    #![allow(nonstandard_style, dead_code)]\n{state}\n}}\n\
             mod {module} {{\n    #![allow(non_upper_case_globals)]\n{constants}\
             ::tltl::tltl! {{ {} }}\n}}\n\
             mod formula{number} {{\n#[allow(non_snake_case)]\npub(crate) fn print() {{\n{variables}\
             let task = ::tltl::tltl! {{ {} }};\n{}}}\n}}",
            over(items),
            over(formula),
            printed_task(case, &format!("super::{world}"), "task"),
        );
        let (last, calls) = case.calls.split_last().unwrap();
        for call in calls {
            self.main += &printed(case, &module, &world, call);
            let what = format!("{module}::{}\n{constants}{items}", call.task);
            self.expected.push((what, evaluated(case, file, call)));
        }
        let _ = writeln!(self.main, "    formula{number}::print();");
        self.expected.push((format!("{variables}{formula}"), evaluated(case, file, last)));
    }

    /// Builds and runs it in a folder of its own, which keeps what it builds.
    fn run(&self) -> String {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("hostile");
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        let manifest = format!(
            "[workspace]\n[package]\nname = \"hostile\"\nversion = \"0.1.0\"\nedition = \"2024\"\n\
             [dependencies.tltl]\npath = {:?}\ndefault-features = false\nfeatures = [\"macros\"]\n",
            root.join("runtime").canonicalize().unwrap()
        );
        let main =
            format!("#![deny(warnings)]\n\n{}\nfn main() {{\n{}}}\n", self.modules, self.main);
        let own = [("Cargo.toml".to_owned(), manifest), ("src/main.rs".to_owned(), main)];
        for (path, text) in own.iter().chain(&self.files) {
            write(&folder.join(path), text);
        }
        std::fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).unwrap();
        let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
        let arguments = ["run", "--quiet", "--offline"];
        let run = Command::new(cargo)
            .args(arguments)
            .env("CARGO_TARGET_DIR", folder.join("target"))
            .current_dir(&folder)
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&run.stderr);
        assert!(run.status.success() && errors.is_empty(), "{}\n{errors}", folder.display());
        String::from_utf8(run.stdout).unwrap()
    }
}

fn write(path: &PathBuf, text: &str) {
    std::fs::create_dir_all(path.parent().unwrap()).unwrap();
    std::fs::write(path, text).unwrap();
}

#[test]
fn no_name_means_anything_else() {
    let mut program = Program::default();
    for (number, (case, file)) in accepted(false).iter().enumerate() {
        program.file(number, case, file);
    }
    for (number, (case, file)) in accepted(true).iter().enumerate() {
        program.program(number, case, file);
    }
    let printed = program.run();
    assert_eq!(printed.lines().count(), program.expected.len());
    for (line, (what, expected)) in printed.lines().zip(&program.expected) {
        let found = f64::from_bits(line.parse().unwrap());
        assert_eq!(
            found.to_bits(),
            *expected,
            "{found} is not {}: {what}",
            f64::from_bits(*expected)
        );
    }
}
