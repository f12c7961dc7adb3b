//! The command line as a process: what is run, what goes in, what comes out.
//!
//! `cli/cases.txt` holds the cases and what they must show. A case is a line `$ tltlc …`, lines
//! `< …` for the standard input, and then, written by this test with `UPDATE_CLI=1`, the standard
//! output, the standard error with `! ` before each line, and the exit code. They run in `cli/`.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cli")
}

#[test]
fn every_case_shows_what_it_must() {
    let file = folder().join("cases.txt");
    let cases = std::fs::read_to_string(&file).unwrap();
    let shown: String = cases.split_inclusive("\n\n$ ").map(trimmed).map(case).collect();
    if std::env::var_os("UPDATE_CLI").is_some() {
        std::fs::write(&file, &shown).unwrap();
    }
    for (line, (expected, found)) in (1..).zip(cases.lines().zip(shown.lines())) {
        assert_eq!(found, expected, "cases.txt, line {line}");
    }
    assert!(shown == cases, "run this test with UPDATE_CLI=1 and read what changed");
}

fn trimmed(text: &str) -> &str {
    text.trim_start_matches("$ ").trim_end_matches("$ ").trim_end_matches('\n')
}

/// Runs a case and writes it anew.
fn case(text: &str) -> String {
    let mut lines = text.lines();
    let command = lines.next().unwrap_or_default();
    let input: Vec<_> = lines.take_while(|line| line.starts_with('<')).collect();
    let stdin: String = input.iter().map(|line| line[1..].trim_start().to_owned() + "\n").collect();
    let Output { status, stdout, stderr } = run(&words(command), stdin.as_bytes());
    let mut shown = format!("$ {command}\n");
    input.iter().for_each(|line| shown.push_str(&format!("{line}\n")));
    for line in String::from_utf8(stdout).unwrap().lines() {
        let _ = writeln!(shown, "{}", format!("  {line}").trim_end());
    }
    for line in String::from_utf8(stderr).unwrap().lines() {
        let _ = writeln!(shown, "{}", format!("! {line}").trim_end());
    }
    let _ = writeln!(shown, "exit {}\n", status.code().unwrap());
    shown
}

/// The words of a command line; single quotes keep blanks.
fn words(command: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (place, part) in command.split('\'').enumerate() {
        if place % 2 == 1 {
            words.last_mut().unwrap().push_str(part);
            continue;
        }
        for (i, word) in part.split(' ').enumerate() {
            if i > 0 {
                words.push(String::new());
            }
            words.last_mut().unwrap().push_str(word);
        }
    }
    assert_eq!(words.remove(0), "tltlc", "{command}");
    words
}

fn run<S: AsRef<std::ffi::OsStr>>(arguments: &[S], stdin: &[u8]) -> Output {
    let mut child = Command::new(env!("CARGO_BIN_EXE_tltlc"))
        .args(arguments)
        .current_dir(folder())
        .env_remove("NO_COLOR")
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that does not read its input closes it.
    let _ = child.stdin.take().unwrap().write_all(stdin);
    child.wait_with_output().unwrap()
}

#[test]
fn files_are_laid_out_in_place() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("layout.tltl");
    let name = path.to_str().unwrap();
    std::fs::write(&path, "// why\ntask t=F  a\npredicate a=x<3\nstate S{x:f64}\n").unwrap();
    assert_eq!(run(&["fmt", "--check", name], b"").status.code(), Some(1));
    assert_eq!(run(&["fmt", name], b"").status.code(), Some(0));
    let laid_out = "// why\ntask t = F a\npredicate a = x < 3\nstate S { x: f64 }\n";
    assert_eq!(std::fs::read_to_string(&path).unwrap(), laid_out);
    assert_eq!(run(&["fmt", "--check", name], b"").status.code(), Some(0));
}

#[test]
fn what_is_no_text_or_too_deep_is_no_crash() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bytes.tltl");
    let name = path.to_str().unwrap();
    for bytes in [&b"\xff\xfe\x00"[..], b"", b"\0", b"state S { x: f64 } task t = \xe2\x97"] {
        std::fs::write(&path, bytes).unwrap();
        for arguments in [
            vec!["check", name],
            vec!["fmt", name],
            vec!["explain", name],
            vec!["automaton", name],
            vec!["policy", name],
            vec!["run", name, name],
            vec!["diff", name, name],
            vec!["automaton", "--formulas", name, "--format", "json"],
        ] {
            let code = run(&arguments, b"").status.code();
            assert!(code.is_some_and(|code| code <= 2), "{arguments:?}: {code:?}");
        }
    }
    for deep in ["(", "!", "F ", "a U "] {
        let list = deep.repeat(100_000) + "a\n";
        let arguments = ["automaton", "--formulas", "-", "--format", "json"];
        let code = run(&arguments, list.as_bytes()).status.code();
        assert!(code.is_some_and(|code| code <= 1), "{deep}: {code:?}");
    }
}

#[test]
fn a_reader_that_goes_away_is_no_crash() {
    let list = "F a\n".repeat(20_000);
    let mut child = Command::new(env!("CARGO_BIN_EXE_tltlc"))
        .args(["automaton", "--formulas", "-", "--format", "json"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let _ = child.stdin.take().unwrap().write_all(list.as_bytes());
    let output = child.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(output.stderr).unwrap(), "");
}
