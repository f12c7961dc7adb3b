//! The words that Rust reserves. A source may use them as names; generated code writes them as raw
//! identifiers (`r#match`), except for the few that cannot be raw.

use std::borrow::Cow;

/// The letters of a name, which the source may have written with `r#`.
pub(crate) fn bare(name: &str) -> &str {
    name.strip_prefix("r#").unwrap_or(name)
}

/// The letters of a name in generated code, without `r#`, which the source may have written itself.
/// `self`, `Self`, `super`, `crate` and `_` cannot be raw identifiers and get an underscore.
///
/// Two names of a source that are equal here would be one name in Rust, so declaring both is an
/// error.
pub(crate) fn rust_name(name: &str) -> Cow<'_, str> {
    let name = bare(name);
    if NEVER_RAW.contains(&name) { format!("{name}_").into() } else { name.into() }
}

/// Whether the author's Rust can have no variable called `name`.
pub(crate) fn is_taken(name: &str) -> bool {
    NEVER_RAW.contains(&name) || is_constructor(name)
}

/// Whether `name` is a constructor that Rust has in every scope: a pattern of that name is one of
/// its values, and no variable.
pub(crate) fn is_constructor(name: &str) -> bool {
    ["Some", "None", "Ok", "Err"].contains(&name)
}

/// Keywords of Rust that no raw identifier may be, and the name of nothing.
const NEVER_RAW: [&str; 5] = ["self", "Self", "super", "crate", "_"];

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
