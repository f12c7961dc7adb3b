//! Any text that is a task file: laying it out keeps its tokens and its meaning, and doing it twice
//! changes nothing more.

use tltl_compiler::source::Source;
use tltl_compiler::{check, parse};
use tltlc::format::format;

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    if parse::file(&Source::new("file", text)).is_err() {
        return;
    }
    let laid_out = format(text).unwrap_or_else(|| panic!("its tokens change: {text:?}"));
    assert_eq!(format(&laid_out).as_ref(), Some(&laid_out), "{text:?}");
    assert_eq!(meaning(&laid_out), meaning(text), "{text:?} as {laid_out:?}");
}

/// The formulas of the tasks; `None` if there are mistakes. Which ones may depend on blanks: `0r#x`
/// is a number and a name only where there is one between them.
fn meaning(text: &str) -> Option<Vec<String>> {
    let module = check::file(&Source::new("file", text)).ok()?;
    Some(module.tasks.iter().map(|task| task.spec.to_string()).collect())
}
