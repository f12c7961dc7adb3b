//! The guide: every command line in it shows what the page says, every task file compiles.
//!
//! In a block of `console`, a line `$ tltlc …` is followed by all that the tool writes;
//! `UPDATE_DOCS=1` writes it anew. A block whose language is `tltl,NAME` or `csv,NAME` is a file that
//! the commands of its page find. The blocks of Rust are run by `cargo test -p tltl-examples --doc`.

use std::path::{Path, PathBuf};
use std::process::Command;

use tltl_compiler::source::Source;
use tltl_compiler::translate::Budget;
use tltlc::task::TaskFile;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The pages of the guide, in order.
fn pages() -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join("docs/guide")).unwrap();
    let mut pages: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    pages
}

/// The words of a command line; single quotes keep blanks.
fn words(line: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (place, part) in line.split('\'').enumerate() {
        for (i, word) in part.split(if place % 2 == 0 { " " } else { "'" }).enumerate() {
            if i > 0 {
                words.push(String::new());
            }
            words.last_mut().unwrap().push_str(word);
        }
    }
    words
}

/// All that a command line shows: the output, then the messages.
fn shown(line: &str, folder: &Path) -> String {
    let words = words(line);
    assert_eq!(words[0], "tltlc", "{line}");
    let output = Command::new(env!("CARGO_BIN_EXE_tltlc"))
        .args(&words[1..])
        .current_dir(folder)
        .output()
        .unwrap();
    assert!(output.status.code().is_some_and(|code| code < 2), "{line}: {output:?}");
    String::from_utf8([output.stdout, output.stderr].concat()).unwrap()
}

/// A page with its console blocks written anew; its files are written to `folder`.
fn anew(page: &str, folder: &Path) -> String {
    let mut written = String::new();
    let mut lines = page.split_inclusive('\n');
    while let Some(line) = lines.next() {
        written.push_str(line);
        let Some(language) = line.trim_end().strip_prefix("```").filter(|text| !text.is_empty())
        else {
            continue;
        };
        let is_inside = |line: &&str| line.trim_end() != "```";
        let block: Vec<&str> = lines.by_ref().take_while(is_inside).collect();
        let text = block.concat();
        if let Some((_, name)) = language.split_once(',') {
            std::fs::write(folder.join(name), &text).unwrap();
        }
        if language == "rust" {
            let long = block.iter().find(|line| line.trim_end().chars().count() > 100);
            assert_eq!(long, None, "a page is not so wide");
        }
        if language.split(',').next() == Some("tltl") {
            let made = TaskFile::new(Source::new("block", text.as_str()), Budget::EMITTED);
            let file = made.unwrap_or_else(|error| panic!("{error}"));
            assert!(file.warnings().is_empty(), "{text}");
        }
        if language == "console" {
            for command in block.iter().filter_map(|line| line.strip_prefix("$ ")) {
                written.push_str(&format!("$ {command}{}", shown(command.trim_end(), folder)));
            }
        } else {
            written.push_str(&text);
        }
        written.push_str("```\n");
    }
    written
}

#[test]
fn every_command_shows_what_the_page_says() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("guide");
    std::fs::create_dir_all(&folder).unwrap();
    let anew = |path: &PathBuf| {
        let page = std::fs::read_to_string(path).unwrap();
        let anew = anew(&page, &folder);
        if std::env::var_os("UPDATE_DOCS").is_some() {
            std::fs::write(path, &anew).unwrap();
        }
        (page, anew)
    };
    let all: Vec<_> = pages().iter().map(anew).collect();
    for (path, (page, anew)) in pages().iter().zip(all) {
        for (line, (expected, found)) in (1..).zip(page.lines().zip(anew.lines())) {
            assert_eq!(found, expected, "{}:{line}", path.display());
        }
        assert_eq!(anew.len(), page.len(), "{}: run this with UPDATE_DOCS=1", path.display());
    }
}

/// The other pages that tell how the tool is called, and show task files.
#[test]
fn the_lines_of_other_pages_run() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("pages");
    std::fs::create_dir_all(&folder).unwrap();
    let mut lines = 0;
    for name in ["README.md", "tools/README.md", "docs/embedded.md", "editors/README.md"] {
        let page = std::fs::read_to_string(root().join(name)).unwrap();
        let files = anew(&page.replace("```console", "```text"), &folder);
        assert_eq!(files.lines().count(), page.lines().count(), "{name}");
        for line in page.lines().filter_map(|line| line.strip_prefix("cargo run -q -p tltlc -- ")) {
            let line = line.split(" > ").next().unwrap();
            assert!(!shown(&format!("tltlc {line}"), &root()).contains("error"), "{line}");
            lines += 1;
        }
    }
    assert_eq!(lines, 5);
}

/// Where the repository will be.
const REPOSITORY: &str = "https://github.com/OWNER/tltl/blob/main/";

/// Every page is in the summary, every link within the repository leads to a file, and every page is
/// run as a doctest.
#[test]
fn every_page_is_found() {
    let summary = std::fs::read_to_string(root().join("docs/SUMMARY.md")).unwrap();
    let doctests = std::fs::read_to_string(root().join("examples/lib.rs")).unwrap();
    for path in pages() {
        let name = path.file_name().unwrap().to_str().unwrap();
        let page = std::fs::read_to_string(&path).unwrap();
        assert!(summary.contains(&format!("](guide/{name})")), "{name}");
        let is_run = doctests.contains(&format!("guide/{name}\""));
        assert!(is_run || !page.contains("```rust"), "{name} is not among the doctests");
        for link in page.split("](").skip(1).map(|rest| rest.split([')', '#']).next().unwrap()) {
            let is_there = match link.strip_prefix(REPOSITORY) {
                Some(file) => root().join(file).exists(),
                None => root().join("docs/guide").join(link).exists(),
            };
            assert!(is_there || link.starts_with("https://docs.rs/"), "{name}: {link}");
        }
    }
}
