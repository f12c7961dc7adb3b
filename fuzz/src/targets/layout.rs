//! Any text that is a task file: laying it out keeps its tokens and its meaning, and doing it twice
//! changes nothing more.

use tltl_compiler::error::{Error, Errors, Kind};
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

/// The formulas of the tasks, or the kinds of the mistakes, which quote the text.
fn meaning(text: &str) -> Result<Vec<String>, Vec<Kind>> {
    let module = check::file(&Source::new("file", text));
    let messages = |errors: Errors| errors.iter().map(Error::kind).collect();
    module
        .map_err(messages)
        .map(|module| module.tasks.iter().map(|task| task.spec.to_string()).collect())
}
