//! Any bytes as a formula, as a file and as the macro's input: an answer, never a crash; a report
//! that can be shown; a formula that means the same when it is printed.
use tltl_compiler::ast::ItemKind;
use tltl_compiler::error::Style;
use tltl_compiler::source::Source;
use tltl_compiler::{check, parse};

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let source = Source::new("<fuzz>", text);
    for checked in [check::formula(&source), check::file(&source), check::fragment(&source)] {
        if let Err(errors) = checked {
            assert!(!errors.render(&source, Style::Coloured).is_empty());
        }
    }
    printed(&source);
}

fn printed(source: &Source) {
    let Ok(ast) = parse::formula(source) else { return };
    let ItemKind::Task(_, root) = ast.items()[0].kind else { return };
    let once = ast.display(root).to_string();
    let again = Source::new("<printed>", once.as_str());
    match parse::formula(&again) {
        Ok(ast) => match ast.items()[0].kind {
            ItemKind::Task(_, root) => assert_eq!(ast.display(root).to_string(), once),
            _ => panic!("`{once}` is no formula"),
        },
        Err(errors) => panic!("{}", errors.render(&again, Style::Plain)),
    }
}
