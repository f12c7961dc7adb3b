//! Studies go on where they were.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use std::{env, fs, thread};

use tltl_examples::study::Study;

const CASES: u64 = 60;

fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A result that is not exact in decimal.
fn work(case: u64) -> f64 {
    (case as f64).sqrt()
}

/// What the killed process runs; without its variable it is not one, and does nothing.
#[test]
fn child_of_the_kill_test() {
    if let Some(folder) = env::var_os("TLTL_STUDY") {
        let study = Study::at(folder.into(), "roots", &CASES);
        let slow = |case| {
            thread::sleep(Duration::from_millis(20));
            work(case)
        };
        study.run(CASES, slow).unwrap();
    }
}

#[test]
fn a_killed_study_loses_the_last_interval_only() {
    let folder = folder("killed");
    let study = Study::at(folder.clone(), "roots", &CASES);
    let mut child = Command::new(env::current_exe().unwrap())
        .args(["--exact", "child_of_the_kill_test"])
        .env("TLTL_STUDY", &folder)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    for _ in 0..10_000 {
        if study.checkpoint().exists() {
            break;
        }
        thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let worked = AtomicU64::new(0);
    let results = study.run(CASES, |case| {
        worked.fetch_add(1, Ordering::Relaxed);
        work(case)
    });
    let whole: Vec<f64> = (0..CASES).map(work).collect();
    assert_eq!(results.unwrap(), whole, "bit for bit");
    let worked = worked.into_inner();
    assert!((1..CASES).contains(&worked), "{worked} cases were left to do");
    study.finish().unwrap();
    assert_eq!(fs::read_dir(folder).unwrap().count(), 0);
}

#[test]
fn foreign_and_broken_checkpoints_are_refused() {
    let folder = folder("foreign");
    let study = |name, setup: u64| Study::at(folder.clone(), name, &setup);
    study("one", 1).run(3, work).unwrap();
    let refused = |study: Study| study.run(3, work).unwrap_err().to_string();
    assert!(refused(study("one", 2)).contains("of a study of 1, not of 2; remove it"));
    fs::copy(study("one", 1).checkpoint(), study("two", 1).checkpoint()).unwrap();
    assert!(refused(study("two", 1)).contains("of `study-one`, not of `study-two`"));
    let path = study("one", 1).checkpoint();
    let whole = fs::read(&path).unwrap();
    fs::write(&path, &whole[..whole.len() - 2]).unwrap();
    assert!(refused(study("one", 1)).contains("cut short"));
}
