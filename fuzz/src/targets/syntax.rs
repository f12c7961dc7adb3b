//! A formula in any spelling of the language, bare or in a file: it is read, every automaton of it
//! accepts what its definition does, and printing it or laying it out changes nothing of that.

use tltl_compiler::ast::ItemKind;
use tltl_compiler::error::{Errors, Style as Report};
use tltl_compiler::minimize::minimize;
use tltl_compiler::predicate::Module;
use tltl_compiler::source::Source;
use tltl_compiler::spec::Spec;
use tltl_compiler::translate::translate;
use tltl_compiler::{check, parse};
use tltlc::format::format;
use tltlc::semantics;

use super::BUDGET;
use crate::random::{Bytes, Choices};
use crate::written::{self, Style, Tree};

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let mut choices = Bytes(bytes);
    let operators = choices.choose(9);
    let tree = Tree::random(&mut choices, operators);
    let (text, spec) = match choices.choose(3) {
        0 => bare(&Style::formula(&mut choices).text(&tree)),
        kind => in_file(&Style::file(&mut choices, kind == 2).text(&tree), kind == 2),
    };
    let raw = translate(&spec, BUDGET).ok();
    let minimal = raw.as_ref().map(minimize);
    for _ in 0..3 {
        let trace = written::trace(&mut choices);
        let names = spec.propositions().iter();
        let places: Vec<usize> = names.map(|one| written::place(&one.name)).collect();
        let holds = |p: u32, t: usize| trace[t][places[p as usize]];
        let (mut q, mut q_minimal) = (0, 0);
        for length in 1..=trace.len() {
            let expected = tree.holds(&trace[..length]);
            let about = || format!("{text} on {:?}", &trace[..length]);
            assert_eq!(semantics::satisfied(&spec, length, holds), expected, "{}", about());
            if let (Some(raw), Some(minimal)) = (&raw, &minimal) {
                q = raw.next(q, |p| holds(p, length - 1));
                q_minimal = minimal.next(q_minimal, |p| holds(p, length - 1));
                assert_eq!(raw.accepting == Some(q), expected, "{}", about());
                assert_eq!(minimal.accepting == Some(q_minimal), expected, "{}", about());
            }
        }
    }
}

/// The only task of a module.
fn only(source: &Source, module: Result<Module, Errors>) -> Spec {
    let refused = |errors: Errors| panic!("{}", errors.render(source, Report::Plain));
    module.unwrap_or_else(refused).tasks.remove(0).spec
}

/// A bare formula. It means the same as it is printed, and prints the same again.
fn bare(text: &str) -> (String, Spec) {
    let source = Source::new("formula", text);
    let spec = only(&source, check::formula(&source));
    let once = printed(&source);
    let again = Source::new("printed", once.as_str());
    assert_eq!(printed(&again), once, "{text}");
    assert_eq!(only(&again, check::formula(&again)).to_string(), spec.to_string(), "{text}");
    (text.to_owned(), spec)
}

fn printed(source: &Source) -> String {
    let refused = |errors: Errors| panic!("{}", errors.render(source, Report::Plain));
    let ast = parse::formula(source).unwrap_or_else(refused);
    let ItemKind::Task(_, root) = ast.items()[0].kind else { panic!("{}", source.text()) };
    ast.display(root).to_string()
}

/// A formula as the task of a file, which means the same when it is laid out, and then stays so.
fn in_file(formula: &str, times: bool) -> (String, Spec) {
    let step = if times { "step 0.5 s\n" } else { "" };
    let fields = "state S { a: bool, b: bool, c: bool, d: bool }";
    let text = format!("{fields}\n{step}task t = {formula}\n");
    let source = Source::new("file", text.as_str());
    let spec = only(&source, check::file(&source));
    let laid_out = format(&text).expect("the tokens stay");
    let again = Source::new("laid out", laid_out.as_str());
    assert_eq!(only(&again, check::file(&again)).to_string(), spec.to_string(), "{text}");
    assert_eq!(format(&laid_out).as_ref(), Some(&laid_out), "{text}");
    (text, spec)
}
