//! Tasks that are compiled, used and dropped leave nothing behind.

use tltl::Acceptor;
use tltl_compiler::translate::Budget;
use tltlc::evaluate::{Columns, Scratch};
use tltlc::task::{self, Verdict};

/// The memory that the process holds, in KiB; `None` where there is no /proc.
fn resident() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().trim_end_matches(" kB").parse().ok()
}

/// Compiles and runs so many tasks, no two of them alike.
fn run(numbers: std::ops::Range<u32>, scratch: &mut Scratch) {
    for number in numbers {
        let formula = format!("(x > {number}) T goal_{number} && (!lava U (y < {number}))");
        let task = task::compile(&formula, Budget::default()).unwrap();
        let first = f64::from(number) + 1.0;
        // x, y, goal, lava.
        let rows = [first, -1.0, -1.0, -1.0, 0.0, 1.0, 1.0, -1.0];
        let columns = Columns::of_rows(2, 4, &rows).unwrap();
        let run = task.run(&columns, scratch).unwrap();
        assert_eq!(run.verdict(), Verdict::Satisfied, "{formula}");
        assert!(task.is_accepting(run.states[1]));
    }
}

/// A task is about 18 KiB: to leak ten thousand of them is 180 MiB.
#[test]
fn ten_thousand_tasks_need_the_memory_of_a_few() {
    let mut scratch = Scratch::default();
    run(0..500, &mut scratch);
    let Some(before) = resident() else {
        return println!("skipped: there is no /proc/self/status");
    };
    run(500..10_500, &mut scratch);
    let grown = resident().unwrap().saturating_sub(before);
    assert!(grown < 1024, "{grown} KiB more than after 500");
    println!("{grown} KiB more after 10,500 tasks than after 500");
}
