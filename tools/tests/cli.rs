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
fn recordings_of_other_programs_are_read_or_named() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bytes.csv");
    let name = path.to_str().unwrap();
    let satisfied = "satisfied at row 1";
    for (bytes, shown) in [
        (&b"x,y\r0,0\r3,2\r"[..], satisfied),
        (b"\xef\xbb\xbfx,y\n0,0\n3,2", satisfied),
        (b"\xef\xbb\xbf\n{\"x\":0,\"y\":0}\r\n\r\n# so\n{\"x\":3,\"y\":2}", satisfied),
        (b"x,y,caf\xe9\n0,0,\xe9\n3,2,\"\xe9\n,\"", satisfied),
        (b"x,y\n0,0\n3,2\xe9\n", ":3:3: `y` is not UTF-8"),
        (b"{\"x\":0,\"y\":0,\"z\":\"\xe9\"}\n{\"x\":3,\"y\":2}", satisfied),
        (b"\xff\xfex\0,\0y\0\n\0", "this is UTF-16; save it as UTF-8"),
        (b"\0x\0,\0y\0\n", "this is UTF-16; save it as UTF-8"),
        (b"\n# nothing\n", "a trajectory has at least one state, and this has none"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let Output { status, stdout, stderr } = run(&["run", "F (x > 1 && y > 1)", name], b"");
        let text = String::from_utf8([stdout, stderr].concat()).unwrap();
        assert!(text.contains(shown), "{}: {text}", bytes.escape_ascii());
        assert_eq!(status.code(), Some(if shown == satisfied { 0 } else { 2 }));
    }
}

/// More rows than are read at once: the same as the library gives for all of them together.
#[test]
fn a_long_recording_is_followed_in_pieces() {
    let formula = "!(y > 2.99) U (x > 0.9 && X (x < -0.9 && X F (y < -2.9)))";
    let task = tltlc::task::compile(formula, tltl_compiler::translate::Budget::default()).unwrap();
    let mut seed = 1_u32;
    let mut number = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 8) / f64::from(1 << 22) - 2.0
    };
    let numbers: Vec<f64> = (0..20_000).map(|_| number()).collect();
    let columns = tltlc::evaluate::Columns::of_rows(10_000, 2, &numbers).unwrap();
    let whole = task.run(&columns, &mut tltlc::evaluate::Scratch::default()).unwrap();
    let mut csv = String::from("y,x\n");
    let mut lines = String::from("\n");
    for row in numbers.chunks(2) {
        let _ = writeln!(csv, "{},{}", row[0], row[1]);
        let _ = writeln!(lines, "{{\"y\":{},\"x\":{}}}", row[0], row[1]);
    }
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("long.csv");
    for text in [csv, lines] {
        std::fs::write(&path, text).unwrap();
        let output = run(&["run", formula, path.to_str().unwrap(), "--format", "csv"], b"");
        let shown = String::from_utf8(output.stdout).unwrap();
        assert_eq!(shown.lines().count(), 10_001);
        for (t, line) in shown.lines().skip(1).enumerate() {
            let (state, progress) = (whole.states[t], whole.progress[t] + 0.0);
            let start = format!("{t},{state},{progress},{},", whole.verdicts[t]);
            assert!(line.starts_with(&start), "{line}, not {start}");
        }
        assert!(shown.ends_with(&format!(",{}\n", whole.robustness)), "{}", whole.robustness);
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
