//! Few names are enough: for what strangers read first, those of the prelude and a handful.

use std::fs;
use std::path::Path;

/// The names that the `use` declarations of a source bring in; `*` and `self` as they are.
fn names(source: &str) -> Vec<String> {
    let mut names = Vec::new();
    for declaration in source.split("use ").skip(1) {
        let path = declaration.split(';').next().unwrap_or_default();
        let leaves = path.split(['{', '}', ',', '\n']).map(|leaf| leaf.trim());
        // A group's own path ends with `::`.
        let leaves = leaves.filter(|leaf| !leaf.is_empty() && !leaf.ends_with("::"));
        names.extend(leaves.filter_map(|leaf| leaf.rsplit("::").next()).map(str::to_owned));
    }
    names
}

fn read(file: &str) -> String {
    fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join(file)).unwrap()
}

#[test]
fn the_prelude_has_at_most_twenty_names() {
    let source = read("src/prelude.rs");
    let code: String = source.lines().filter(|line| !line.starts_with("//")).collect();
    let names = names(&code);
    assert!((10..=20).contains(&names.len()), "{names:?}");
    assert!(names.iter().all(|name| name != "*"), "{names:?}");
}

#[test]
fn the_grid_world_needs_at_most_ten_more() {
    let source = read("../examples/gridworld.rs");
    let (uses, _) = source.split_once("include_tltl!").unwrap();
    let (_, uses) = uses.split_once("\nuse ").unwrap();
    let names = names(&format!("use {uses}"));
    assert_eq!(names.iter().filter(|name| *name == "*").count(), 1, "the prelude: {names:?}");
    assert!(names.len() - 1 <= 10, "{names:?}");
}

#[test]
fn the_readme_learns_with_the_prelude_alone() {
    let readme = read("../README.md");
    let example = readme.split("```").find(|block| block.contains("Learner::new")).unwrap();
    let uses: String = example.lines().filter(|line| line.starts_with("use ")).collect();
    assert_eq!(names(&uses), ["*"]);
}
