//! The targets, one a module: what each holds against any bytes.

pub mod compile;
pub mod diff;
pub mod editor;
pub mod grammar;
pub mod hoa;
pub mod layout;
pub mod page;
pub mod policy;
pub mod syntax;
pub mod tokens;
pub mod trajectory;

use std::io::Read;

use tltl_compiler::error::Style;
use tltl_compiler::translate::Budget;
use tltlc::cli::{self, Exit, Output, Streams};

/// What an automaton may take: an input of a fuzzer is small, and there are many.
const BUDGET: Budget = Budget { states: 2_000, nodes: 200_000, ..Budget::EMITTED };

/// The tool, with an input and what it writes: results and messages.
fn tool(arguments: &[&str], mut input: &[u8]) -> (Exit, [String; 2]) {
    let [mut out, mut err] = [Vec::new(), Vec::new()];
    let mut streams = Streams {
        input: &mut input as &mut dyn Read,
        out: Output { stream: &mut out, style: Style::Plain },
        err: Output { stream: &mut err, style: Style::Plain },
    };
    let exit = cli::main(["tltlc"].iter().chain(arguments), &mut streams);
    (exit, [out, err].map(|bytes| String::from_utf8(bytes).expect("it writes text")))
}

/// A target: it panics where a property does not hold.
pub type Target = fn(&[u8]);

/// All targets under the names of their binaries and corpora.
pub const ALL: [(&str, Target); 11] = [
    ("compile", compile::run),
    ("diff", diff::run),
    ("editor", editor::run),
    ("grammar", grammar::run),
    ("hoa", hoa::run),
    ("layout", layout::run),
    ("page", page::run),
    ("policy", policy::run),
    ("syntax", syntax::run),
    ("tokens", tokens::run),
    ("trajectory", trajectory::run),
];
