//! Monitors without `std`, without an allocator and without a panic: the object code of a crate that only
//! steps refers to nothing but what copies memory.
//!
//! Object code is read by `readelf`, for the machine of the test and, where its `core` is installed,
//! for a Cortex-M4. Where a tool is missing these tests say so and check nothing.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;

use tltl_compiler::compile;
use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::emit::rust;

const BARE_METAL: &str = "thumbv7em-none-eabihf";

/// Bounds of every kind, eight predicates, and a diagram of twelve.
const SIGNAL: &str = "state Signal { x: f64, y: f64 }
    task in_time = F (x > 0 && y < 1 U[0,100] x > 1) && F[0,50] y > 2
    task held = F (G[0,10] x > 0)
    task after = F (x > 1 && X[3] y > 1) && X[7] F y > 1
    task ordered = x > 0 T y > 0 T x > 1 T y > 1 T x > 2 T y > 2 T x > 3 T y > 3
    task diagram = x > 0 T y > 0 T x > 1 T y > 1 T x > 2 T y > 2 T x > 3 T y > 3 T x > 4 T y > 4
        T x > 5 T y > 5";

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn module(name: &str, text: &str) -> String {
    let compiled = compile::file(&Source::new("task.tltl", text), Budget::EMITTED).unwrap();
    format!("mod {name} {{\n{}\n}}\n", rust::file(&compiled))
}

/// A crate with these monitors.
fn source(monitors: &str) -> String {
    let read = |path: &str| std::fs::read_to_string(root().join(path)).unwrap();
    let tasks = module("grid", &read("examples/tasks/gridworld.tltl")) + &module("signal", SIGNAL);
    format!("#![no_std]\n{tasks}{}{monitors}", read("tests/data/embedded.rs"))
}

/// What `readelf` shows of the object code of some source; `None` if that cannot be had.
fn shown(name: &str, source: &str, target: Option<&str>) -> Option<Object> {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("embedded_{name}"));
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join("steps.rs"), source).unwrap();
    let rustc = std::env::var_os("RUSTC").unwrap_or("rustc".into());
    let compile = |file: &Path, arguments: &[&str]| {
        let mut command = Command::new(&rustc);
        command.current_dir(&folder).arg(file).args(["--edition", "2024", "--cap-lints", "allow"]);
        command.args(["-C", "opt-level=2", "-C", "panic=abort", "-C", "codegen-units=1"]);
        command.args(target.map(|target| format!("--target={target}")));
        let run = command.args(arguments).output().unwrap();
        let errors = String::from_utf8_lossy(&run.stderr).into_owned();
        (run.status.success(), errors)
    };
    let library = root().join("runtime/src/lib.rs");
    let (made, errors) = compile(&library, &["--crate-name", "tltl", "--crate-type", "rlib"]);
    if !made && errors.contains("can't find crate for `core`") {
        println!("skipped: there is no `core` for {target:?}");
        return None;
    }
    assert!(made, "{errors}");
    let arguments = ["--crate-type", "lib", "--emit", "obj", "--extern", "tltl=libtltl.rlib"];
    let (made, errors) = compile(Path::new("steps.rs"), &arguments);
    assert!(made, "{errors}");
    let run = Command::new("readelf").args(["-W", "-S", "-s"]).arg(folder.join("steps.o")).output();
    match run {
        Ok(run) if run.status.success() => Some(Object::new(&String::from_utf8_lossy(&run.stdout))),
        _ => {
            println!("skipped: there is no `readelf` that reads this");
            None
        }
    }
}

/// What an object file has and needs.
struct Object {
    /// The symbols that others have to define.
    undefined: BTreeSet<String>,
    /// The sections with their sizes.
    sections: BTreeMap<String, usize>,
    /// The symbols that it has, with their sizes.
    sizes: BTreeMap<String, usize>,
}

impl Object {
    fn new(readelf: &str) -> Self {
        let (mut undefined, mut sizes) = (BTreeSet::new(), BTreeMap::new());
        let mut sections = BTreeMap::new();
        for line in readelf.lines() {
            // Number, name, type, address, offset, size.
            if let Some((_, section)) = line.split_once("] ") {
                let words: Vec<&str> = section.split_whitespace().collect();
                if let [name, _, _, _, size, ..] = words[..] {
                    let size = usize::from_str_radix(size, 16).unwrap_or_default();
                    *sections.entry(name.to_owned()).or_insert(0) += size;
                }
                continue;
            }
            let words: Vec<&str> = line.split_whitespace().collect();
            // Number, value, size, type, binding, visibility, section, name.
            let [_, _, size, _, _, _, section, name] = words[..] else { continue };
            let Ok(size) = size.parse() else { continue };
            if section == "UND" {
                undefined.insert(name.to_owned());
            } else {
                sizes.insert(name.to_owned(), size);
            }
        }
        Self { undefined, sections, sizes }
    }

    /// The symbols that are not what every compiler may call: to copy memory, or to compute doubles on
    /// a processor that does not.
    fn panics(&self) -> Vec<&str> {
        let is_known = |name: &str| {
            let intrinsic =
                ["memcpy", "memset", "memmove", "memcmp", "bcmp", "_GLOBAL_OFFSET_TABLE_"];
            name.starts_with("__aeabi_") || intrinsic.contains(&name)
        };
        self.undefined.iter().map(|name| &**name).filter(|name| !is_known(name)).collect()
    }

    /// The bytes of all sections with names that begin so.
    fn bytes(&self, of: &[&str]) -> usize {
        let is_one = |name: &str| of.iter().any(|start| name.starts_with(start));
        self.sections.iter().filter(|(name, _)| is_one(name)).map(|(_, size)| size).sum()
    }

    /// The bytes of the symbol with this part in its name.
    fn size(&self, part: &str) -> Option<usize> {
        self.sizes.iter().find(|(name, _)| name.contains(part)).map(|(_, size)| *size)
    }
}

#[test]
fn monitors_that_only_step_have_no_panic() {
    let source = source(
        "run! { a: grid::visit_all, Cell; b: signal::in_time, Signal; c: signal::held, Signal;
            d: signal::after, Signal; e: signal::ordered, Signal; k: signal::diagram, Signal; }
        online! { f: grid::visit_all, Cell; g: signal::in_time, Signal; h: signal::held, Signal;
            i: signal::after, Signal; j: signal::ordered, Signal; l: signal::diagram, Signal; }",
    );
    for (name, target) in [("here", None), ("bare", Some(BARE_METAL))] {
        let Some(object) = shown(name, &source, target) else { continue };
        assert_eq!(object.panics(), [""; 0], "{name}");
        assert!(object.bytes(&[".text"]) > 2000, "the steps are in it");
    }
}

/// The code of the paper's task of three goals on a Cortex-M4, its constants and its memory: up to
/// what the page on firmware says, and a fifth more for other versions of rustc.
#[test]
fn a_monitor_fits_where_the_page_says() {
    for (kind, code, constants, memory) in [("run", 268, 1100, 8), ("online", 1878, 1220, 80)] {
        let source = source(&format!("{kind}! {{ m: grid::visit_all, Cell; }}"));
        let Some(object) = shown(kind, &source, Some(BARE_METAL)) else { return };
        let found = [object.bytes(&[".text"]), object.bytes(&[".rodata", ".data"])];
        println!("{kind}: {found:?}");
        for (found, known) in found.into_iter().zip([code, constants]) {
            assert!(known / 2 < found && found * 5 <= known * 6, "{kind}: {found}, not {known}");
        }
        assert_eq!(object.size("MEMORY"), Some(memory));
    }
}

/// A state that comes from the caller may be none, and that is a panic.
#[test]
fn a_panic_is_found_where_there_is_one() {
    let more = "static TASK: tltl::Task<grid::visit_all> = grid::visit_all();
        pub fn next(q: u32, s: &grid::Cell) -> Option<u32> { TASK.next(q, s).ok() }";
    if let Some(object) = shown("panics", &source(more), None) {
        let found = object.panics();
        assert!(found.iter().any(|name| name.contains("no_state")), "{found:?}");
    }
}
