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

/// A fresh folder with this file in it.
fn fresh(name: &str, file: &str, text: &str) -> std::path::PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    std::fs::write(folder.join(file), text).unwrap();
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[cfg(unix)]
#[test]
fn a_full_disk_costs_nothing() {
    let text = "task t=F  a\npredicate a=x<3\nstate S{x:f64}\n";
    let folder = fresh("full", "t.tltl", text);
    let policy = folder.join("policy.rs");
    std::fs::write(&policy, "// by hand\n").unwrap();
    let network = self::folder().join("network.json");
    for arguments in [
        format!("fmt {}", folder.join("t.tltl").display()),
        format!("policy {} --output {}", network.display(), policy.display()),
    ] {
        // No file may have a byte, and the writer is told, not killed.
        let line =
            format!("trap '' XFSZ; ulimit -f 0; exec {} {arguments}", env!("CARGO_BIN_EXE_tltlc"));
        let output = Command::new("sh").args(["-c", &line]).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{output:?}");
    }
    assert_eq!(names(&folder), ["policy.rs", "t.tltl"]);
    assert_eq!(std::fs::read_to_string(folder.join("t.tltl")).unwrap(), text);
    assert_eq!(std::fs::read_to_string(&policy).unwrap(), "// by hand\n");
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_keeps_what_it_is() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = fresh("kept", "real.tltl", "task t=F  a\npredicate a=x<3\nstate S{x:f64}\n");
    let (real, link) = (folder.join("real.tltl"), folder.join("link.tltl"));
    std::fs::set_permissions(&real, std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink("real.tltl", &link).unwrap();
    // A process of this number has been killed; the other one is alive, and the last is a name of
    // the user's.
    let alive = format!(".real.tltl.{}.tltl.tmp", std::process::id());
    for name in [".real.tltl.4294967294.tltl.tmp", &alive, ".real.tltl.x.tltl.tmp"] {
        std::fs::write(folder.join(name), "half").unwrap();
    }
    assert_eq!(run(&["fmt", link.to_str().unwrap()], b"").status.code(), Some(0));
    assert_eq!(names(&folder), [&alive, ".real.tltl.x.tltl.tmp", "link.tltl", "real.tltl"]);
    assert!(link.is_symlink() && !real.is_symlink());
    assert_eq!(std::fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
    assert!(std::fs::read_to_string(&real).unwrap().starts_with("task t = F a\n"));
    // What is no file is written to.
    let network = self::folder().join("network.json");
    let output = run(&["policy", network.to_str().unwrap(), "-o", "/dev/stdout"], b"");
    assert!(output.stdout.starts_with(b"// Generated by"));
}

#[test]
fn no_terminal_obeys_what_a_file_holds() {
    let hidden = "\x1b[31m\u{7}\u{9b}\u{202e}\u{2028}\u{7f}\r\u{200f}";
    let folder = fresh("hidden", "h.csv", &format!("x,\"y{hidden}\"\n{hidden},1\n"));
    let tasks = format!(
        "//! A {hidden} file.\n\n/// Text {hidden}.\nstate S {{ x: f64 }}\n\n\
         /// Far {hidden}.\npredicate far = x > 2 // {hidden}\n\n\
         /// Go {hidden}.\ntask go = F /* {hidden} */ far\n"
    );
    let wrong = format!("state S {{ x: f64 }}\ntask go = F x > {hidden}1\ntask t = F \"{hidden}\"");
    let policy = format!("{{\"format\": {}}}", serde_json::to_string(hidden).unwrap());
    for (name, text) in [("t.tltl", &tasks), ("w.tltl", &wrong), ("p.json", &policy)] {
        std::fs::write(folder.join(name), text).unwrap();
    }
    let hoa = "HOA: v1\nname: \"NAME\"\nStates: 2\nStart: 1\nAP: 1 \"NAME\"\nAcceptance: 1 Inf(0)\n\
               --BODY--\nState: 0 {0}\n[t] 0\nState: 1\n[0] 0\n[!0] 1\n--END--\n";
    std::fs::write(folder.join("a.hoa"), hoa.replace("NAME", hidden)).unwrap();
    let path = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    let [csv, tasks, wrong, policy, hoa] =
        ["h.csv", "t.tltl", "w.tltl", "p.json", "a.hoa"].map(path);
    let named = format!("none{hidden}.tltl");
    let formats = ["text", "json", "dot", "svg", "mermaid", "hoa", "rust"];
    let mut all: Vec<Vec<&str>> = vec![
        vec!["check", &tasks, &wrong],
        vec!["check", &wrong, "--format", "json"],
        vec!["check", &named],
        vec![hidden],
        vec!["explain", &tasks],
        vec!["explain", &tasks, "--format", "html"],
        vec!["run", &tasks, &csv, "--format", "html"],
        vec!["run", "F y", &csv, "--format", "html"],
        vec!["diff", &tasks, &hoa],
        vec!["diff", &hoa, "F a"],
        vec!["fmt", &wrong],
        vec!["policy", &policy],
        vec!["run", &tasks, &csv],
        vec!["run", "F y", &csv],
        vec!["run", "F x", &csv, "--map", hidden],
        vec!["run", &tasks, &csv, "--task", hidden],
        vec!["automaton", "--formula", hidden, "--format", "json"],
    ];
    all.extend(formats.iter().map(|format| vec!["automaton", &*tasks, "--format", format]));
    for arguments in all {
        let Output { stdout, stderr, .. } = run(&arguments, b"");
        for stream in [stdout, stderr] {
            let text = String::from_utf8(stream).unwrap();
            let found = text.find(|c| c != '\n' && tltl_compiler::source::is_hidden(c));
            assert_eq!(found, None, "{arguments:?}: {text:?}");
        }
    }
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
        (b"x,\x07y\n0,0", "this is no text: its byte 3 is 0x07"),
        (b"x,y\n0,0\n3,\0", "this is no text: its byte 11 is 0x00"),
        (
            b"PAR1\x15\x04",
            if cfg!(feature = "parquet") { "not Parquet" } else { "--features parquet" },
        ),
        (b"PAR1,x,y\n,0,0\n,3,2", satisfied),
        (b"\n# nothing\n", "a trajectory has at least one state, and this has none"),
    ] {
        std::fs::write(&path, bytes).unwrap();
        let Output { status, stdout, stderr } = run(&["run", "F (x > 1 && y > 1)", name], b"");
        let text = String::from_utf8([stdout, stderr].concat()).unwrap();
        assert!(text.contains(shown), "{}: {text}", bytes.escape_ascii());
        assert_eq!(status.code(), Some(if shown == satisfied { 0 } else { 2 }));
    }
}

#[test]
fn a_message_quotes_no_more_of_a_header_than_a_sentence_bears() {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("header.csv");
    let noise: String = (0..100_000_u32).map(|i| ['q', '~', '\u{1b}'][i as usize % 3]).collect();
    let columns = format!("{noise},{}\n", vec![&noise[..50]; 500].join(","));
    let twice = format!("{noise},{noise}\n");
    for (header, formula, map, shown) in [
        (&columns, "F x", "x=x", "and 461 more"),
        (&twice, "F x", &format!("x={noise}"), "two columns are called"),
        (&format!("x\n{noise}"), "F (x > 1)", "x=x", "which `x` is"),
    ] {
        std::fs::write(&path, header).unwrap();
        let arguments = ["run", formula, path.to_str().unwrap(), "--map", map];
        let text = String::from_utf8(run(&arguments, b"").stderr).unwrap();
        assert!(text.contains(shown) && text.len() < 8_000, "{} bytes: {text}", text.len());
    }
}

#[test]
fn a_formula_is_no_file_whatever_characters_it_has() {
    let formula = "\"goal\nroom\" U home";
    for arguments in [vec!["automaton", formula], vec!["explain", formula]] {
        let Output { status, stdout, .. } = run(&arguments, b"");
        assert_eq!(status.code(), Some(0));
        assert!(String::from_utf8(stdout).unwrap().contains("home"));
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
