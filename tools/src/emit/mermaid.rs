//! Mermaid, which GitHub and many editors draw inside Markdown.
//!
//! The diagram is a flowchart: labels of Mermaid's own state diagrams end at a `:`, which cannot be
//! escaped there. Labels are quoted, and characters that are markup to Mermaid become entities.

use std::fmt::Write as _;

use crate::emit::sum::{Notation, label, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A flowchart, from left to right: the accepting state has two circles, the trap and the edges
/// into it are dashed.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let chart = tltlc::emit::mermaid::automaton("order", task.dfa());
/// assert!(chart.contains("flowchart LR\n"));
/// assert!(chart.contains("  q0 -->|\"a\"| q1\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn automaton(title: &str, dfa: &Dfa) -> String {
    let mut text = format!("---\ntitle: {}\n---\nflowchart LR\n", quoted(title));
    text.push_str("  start[\" \"]:::start --> q0\n");
    for q in dfa.states() {
        let _ = writeln!(text, "  {}", node(dfa, q));
    }
    for edge in dfa.edges() {
        let label = escape(&label(dfa, &edge, Notation::Ascii));
        let arrow = if dfa.trap == Some(edge.to) { "-.->" } else { "-->" };
        let _ = writeln!(text, "  q{} {arrow}|\"{label}\"| q{}", edge.from, edge.to);
    }
    text.push_str("  classDef start fill:none,stroke:none\n");
    text.push_str("  classDef trap stroke-dasharray:4 3\n");
    text
}

/// A state in the shape of its verdict.
fn node(dfa: &Dfa, q: State) -> String {
    if dfa.accepting == Some(q) {
        format!("q{q}(((\"{q}\")))")
    } else if dfa.trap == Some(q) {
        format!("q{q}((\"{q}\")):::trap")
    } else {
        format!("q{q}((\"{q}\"))")
    }
}

/// Replaces every character that is markup to Mermaid by its entity `#…;`.
fn escape(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '"' => escaped.push_str("#quot;"),
            '<' => escaped.push_str("#lt;"),
            '>' => escaped.push_str("#gt;"),
            '&' => escaped.push_str("#amp;"),
            '#' | ';' | '`' | '|' | '{' | '}' | '\\' | '*' | '_' => {
                let _ = write!(escaped, "#{};", u32::from(c));
            }
            '\n' | '\r' => escaped.push(' '),
            _ => escaped.push(c),
        }
    }
    escaped
}
