//! Mermaid, which GitHub and many editors draw inside Markdown.
//!
//! The diagram is a flowchart: labels of Mermaid's own state diagrams end at a `:`, which cannot be
//! escaped there. Labels are quoted, and characters that are markup to Mermaid become entities.

use std::fmt::Write as _;

use crate::emit::labels::{Labelled, Labels, Text, TooLarge};
use crate::emit::sum::{Notation, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A flowchart, from left to right: the accepting state has two circles, the trap and the edges
/// into it are dashed.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let chart = tltlc::emit::mermaid::automaton("order", task.dfa())?.to_string();
/// assert!(chart.contains("flowchart LR\n"));
/// assert!(chart.contains("  q0 -->|\"a\"| q1\n"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// If the guards have more than [`MOST_PRODUCTS`](super::labels::MOST_PRODUCTS).
pub fn automaton<'a>(title: &str, dfa: &'a Dfa) -> Result<Text<'a>, TooLarge> {
    let (head, labels) = (head(title, dfa), Labels::new(dfa, Notation::Ascii, &escape)?);
    Ok(Text::new(move |out| {
        out.write_str(&head)?;
        labels.write(out, &|text, Labelled { to, ends: [from, into], guard, .. }| {
            let arrow = if dfa.trap == Some(to) { " -.->|\"" } else { " -->|\"" };
            for part in ["  q", from, arrow, guard, "\"| q", into, "\n"] {
                text.push_str(part);
            }
        })?;
        out.write_str("  classDef start fill:none,stroke:none\n")?;
        out.write_str("  classDef trap stroke-dasharray:4 3\n")
    }))
}

/// Everything before the edges.
fn head(title: &str, dfa: &Dfa) -> String {
    let mut text = format!("---\ntitle: {}\n---\nflowchart LR\n", quoted(title));
    text.push_str("  start[\" \"]:::start --> q0\n");
    for q in dfa.states() {
        let _ = writeln!(text, "  {}", node(dfa, q));
    }
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
