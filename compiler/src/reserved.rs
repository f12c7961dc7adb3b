//! The words that Rust reserves, which no name in generated code can be as it stands.

use std::borrow::Cow;

/// The letters of a name in generated code, which is a raw identifier if they are a keyword: the
/// source may have written `r#`, and a few words cannot be raw. Names of the source that are one
/// here are one in Rust.
pub(crate) fn rust_name(name: &str) -> Cow<'_, str> {
    let name = name.strip_prefix("r#").unwrap_or(name);
    match name {
        "self" | "Self" | "super" | "crate" | "_" => format!("{name}_").into(),
        _ => name.into(),
    }
}

/// Whether `word` is a keyword of Rust, strict or reserved, that is a name when written `r#word`.
pub(crate) fn is_keyword(word: &str) -> bool {
    KEYWORDS.contains(&word)
}

/// Rust's strict and reserved words that a raw identifier may be.
const KEYWORDS: [&str; 48] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let",
    "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return",
    "static", "struct", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use",
    "virtual", "where", "while", "yield",
];
