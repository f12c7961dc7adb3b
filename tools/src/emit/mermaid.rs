//! Mermaid, which GitHub and many editors draw inside Markdown.
//!
//! A flowchart, since state diagrams of Mermaid cannot escape what stands in a label: `:` ends
//! it. Labels are quoted, and what would be markup to Mermaid becomes an entity.

use std::fmt::Write as _;

use crate::emit::sum::{Notation, label, quoted};
use tltl_compiler::dfa::{Dfa, State};

/// A flowchart, left to right: the accepting state with two circles, the trap dashed.
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

fn node(dfa: &Dfa, q: State) -> String {
    if dfa.accepting == Some(q) {
        format!("q{q}(((\"{q}\")))")
    } else if dfa.trap == Some(q) {
        format!("q{q}((\"{q}\")):::trap")
    } else {
        format!("q{q}((\"{q}\"))")
    }
}

/// Everything that is not plain text to Mermaid, as its entities `#…;`.
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
