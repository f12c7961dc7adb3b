//! An automaton as a table for the terminal.
//!
//! One line an edge, grouped by the state that it leaves. Guards are formulas of the language, so a
//! line can be copied into a task file.

use std::fmt::Write as _;

use crate::emit::labels::{Labelled, Labels};
use crate::emit::sum::Notation;
use tltl_compiler::dfa::{Dfa, Size, State};

/// The most edges of a table, self-loops included. Nobody reads so many.
pub const MOST_EDGES: usize = 10_000;

/// The sizes under both conventions, then each state with its edges and their guards. The initial
/// state is marked `>`, the accepting one `*`, the trap `x`. Beyond [`MOST_EDGES`] only the sizes.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let table = tltlc::emit::text::automaton("order", task.dfa());
/// assert!(table.starts_with("order\n") && table.ends_with("> initial   * accepting\n"));
/// // State 0 stays where it is until it sees a.
/// assert!(table.contains(">     0     0  !a\n            1  a\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn automaton(title: &str, dfa: &Dfa) -> String {
    let size = dfa.size();
    let mut text = format!("{title}\n\n{}\n", sizes(size));
    let labels = match size.edges + size.self_loops {
        ..=MOST_EDGES => Labels::new(dfa, Notation::Ascii, &str::to_owned).ok(),
        _ => None,
    };
    let Some(labels) = labels else {
        text.push_str("its edges are too many to read; JSON and HOA list them\n");
        return text;
    };
    let width = dfa.len().to_string().len().max(4);
    let _ = writeln!(text, "   {:>width$}  {:>width$}  when", "from", "to");
    let _ = labels.write(&mut text, &|text, Labelled { from, ends, guard, is_first, .. }| {
        let [number, to] = ends;
        let (mark, from) = if is_first { (mark(dfa, from), number) } else { ("", "") };
        let _ = writeln!(text, "{mark:<2} {from:>width$}  {to:>width$}  {guard}");
    });
    text.push_str(legend(dfa));
    text
}

/// The numbers of states and edges with the trap and without it, and of edges with self-loops and
/// without: papers count in all four ways.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("!wet U home", Budget::default())?;
/// let sizes = tltlc::emit::text::sizes(task.dfa().size());
/// let numbers: Vec<u32> = sizes.split_whitespace().filter_map(|word| word.parse().ok()).collect();
/// assert_eq!(numbers, [3, 2, 5, 2, 1, 3], "with the trap, then without it");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn sizes(size: Size) -> String {
    let mut text = format!("{:<18}{:>8}{:>8}{:>14}\n", "", "states", "edges", "and loops");
    let mut row = |label: &str, states: usize, edges: usize, loops: usize| {
        let _ = writeln!(text, "{label:<18}{states:>8}{edges:>8}{:>14}", edges + loops);
    };
    let trap = usize::from(size.trap);
    row(
        if size.trap { "with the trap" } else { "no trap" },
        size.states,
        size.edges,
        size.self_loops,
    );
    if size.trap {
        let edges = size.edges - size.into_trap;
        row("without the trap", size.states - trap, edges, size.self_loops - trap);
    }
    text
}

/// The mark of a state: initial, accepting, trap.
fn mark(dfa: &Dfa, q: State) -> &'static str {
    match (q == 0, dfa.accepting == Some(q), dfa.trap == Some(q)) {
        (true, true, _) => ">*",
        (true, _, true) => ">x",
        (true, ..) => ">",
        (_, true, _) => "*",
        (_, _, true) => "x",
        _ => "",
    }
}

/// The meaning of the marks that this automaton has.
fn legend(dfa: &Dfa) -> &'static str {
    match (dfa.accepting, dfa.trap) {
        (Some(_), Some(_)) => "\n> initial   * accepting   x trap\n",
        (Some(_), None) => "\n> initial   * accepting\n",
        (None, _) => "\n> initial   x trap: nothing is ever accepted\n",
    }
}
