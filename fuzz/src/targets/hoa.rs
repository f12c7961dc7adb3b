//! Any text as an automaton: an answer, never a crash; what is read is written and read back.
use tltl_compiler::error::Style;
use tltl_compiler::hoa::read;
use tltl_compiler::source::Source;
use tltlc::emit;

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let source = Source::new("<fuzz>", text);
    match read(&source) {
        Err(error) => assert!(!error.render(&source, Style::Plain).is_empty()),
        Ok(automaton) => {
            if automaton.dfa.len() > 1_000 {
                return;
            }
            let written = emit::hoa::automaton("", &automaton.dfa).unwrap().to_string();
            let again = Source::new("<written>", written.as_str());
            match read(&again) {
                Ok(read) => {
                    assert_eq!(emit::hoa::automaton("", &read.dfa).unwrap().to_string(), written)
                }
                Err(error) => panic!("{}\n{written}", error.render(&again, Style::Plain)),
            }
        }
    }
}
