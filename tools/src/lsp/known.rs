//! The words of the language, for completion and hover.

/// A word, the text that stands for it where an editor inserts it, and its meaning.
pub(super) struct Word {
    pub(super) word: &'static str,
    pub(super) means: &'static str,
}

const fn word(word: &'static str, means: &'static str) -> Word {
    Word { word, means }
}

/// Words at the beginning of an item.
pub(super) const ITEMS: [Word; 7] = [
    word("state", "the state that predicates read: `state Name { field: type }`"),
    word("struct", "a type for fields of the state: `struct Name { field: type }`"),
    word("enum", "a finite type: `enum Name { value }`"),
    word("const", "a number: `const name = 0.8`"),
    word("predicate", "a condition on one state: `predicate near = x < 1`"),
    word("task", "a formula over time: `task go = F near`"),
    word("step", "how long a step lasts: `step 0.1 s`"),
];

/// Operators of formulas.
pub(super) const OPERATORS: [Word; 11] = [
    word("F", "`F p`: p at some instant from now on, perhaps now"),
    word("X", "`X p`: there is a next instant, and p holds there"),
    word("U", "`p U q`: q at some instant from now on, and p at each before it"),
    word("T", "`p T q`: p at some instant from now on, and q at a strictly later one"),
    word("G", "`G[a,b] p`: p at every instant a to b steps from now; it needs the bound"),
    word("ensuring", "`p ensuring q`: p is satisfied, and q holds at every instant until then"),
    word("not", "`!p`: p does not hold; p is a condition on one state"),
    word("and", "`p && q`: both hold"),
    word("or", "`p || q`: at least one holds"),
    word("for all", "`for all r in Room: p`: p for every value"),
    word("for some", "`for some r in Room: p`: p for at least one value"),
];

/// Constants of formulas.
pub(super) const VALUES: [Word; 3] = [
    word("true", "holds always"),
    word("false", "holds never"),
    word("none", "the value of a place that may be absent, and is"),
];

/// Types of numbers and truth values.
pub(super) const TYPES: [&str; 11] =
    ["bool", "f32", "f64", "i16", "i32", "i64", "i8", "u16", "u32", "u64", "u8"];
