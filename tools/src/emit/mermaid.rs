//! Mermaid, which GitHub and many editors draw inside Markdown.
//!
//! The diagram is a flowchart: labels of Mermaid's own state diagrams end at a `:`, which cannot be
//! escaped there. Labels are quoted, and characters that are markup to Mermaid become entities.

use std::fmt::Write as _;

use crate::emit::sum::{Labels, Notation, TooLarge, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A flowchart, from left to right: the accepting state has two circles, the trap and the edges
/// into it are dashed.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let chart = tltlc::emit::mermaid::automaton("order", task.dfa())?;
/// assert!(chart.contains("flowchart LR\n"));
/// assert!(chart.contains("  q0 -->|\"a\"| q1\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::sum::MOST_PRODUCTS).
pub fn automaton(title: &str, dfa: &Dfa) -> Result<String, TooLarge> {
    let mut text = format!("---\ntitle: {}\n---\nflowchart LR\n", quoted(title));
    text.push_str("  start[\" \"]:::start --> q0\n");
    for q in dfa.states() {
        let _ = writeln!(text, "  {}", node(dfa, q));
    }
    Labels::new(dfa, Notation::Ascii, &escape)?.visit(&mut |from, to, label| {
        let arrow = if dfa.trap == Some(to) { "-.->" } else { "-->" };
        let _ = writeln!(text, "  q{from} {arrow}|\"{label}\"| q{to}");
    });
    text.push_str("  classDef start fill:none,stroke:none\n");
    text.push_str("  classDef trap stroke-dasharray:4 3\n");
    Ok(text)
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
