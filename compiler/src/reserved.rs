//! The words that Rust reserves. A source may use them as names; generated code writes them as raw
//! identifiers (`r#match`), except for the few that cannot be raw.

use std::borrow::Cow;

/// The letters of a name in generated code, without `r#`, which the source may have written itself.
/// `self`, `Self`, `super`, `crate` and `_` cannot be raw identifiers and get an underscore.
///
/// Two names of a source that are equal here would be one name in Rust, so declaring both is an
/// error.
pub(crate) fn rust_name(name: &str) -> Cow<'_, str> {
    let name = name.strip_prefix("r#").unwrap_or(name);
    match name {
        "self" | "Self" | "super" | "crate" | "_" => format!("{name}_").into(),
        _ => name.into(),
    }
}

/// Whether generated code must write `word` as `r#word`.
pub(crate) fn is_keyword(word: &str) -> bool {
    KEYWORDS.contains(&word)
}

/// The strict and reserved words of Rust, editions 2015 to 2024, that may be raw identifiers. Those
/// of all editions are here because generated code is compiled in the edition of its user.
const KEYWORDS: [&str; 48] = [
    "abstract", "as", "async", "await", "become", "box", "break", "const", "continue", "do", "dyn",
    "else", "enum", "extern", "false", "final", "fn", "for", "gen", "if", "impl", "in", "let",
    "loop", "macro", "match", "mod", "move", "mut", "override", "priv", "pub", "ref", "return",
    "static", "struct", "trait", "true", "try", "type", "typeof", "unsafe", "unsized", "use",
    "virtual", "where", "while", "yield",
];
