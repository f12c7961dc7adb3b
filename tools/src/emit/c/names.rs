//! Names in C: no keyword, no macro of a header, nothing that a compiler reserves, and no two alike.
//!
//! C has one scope for all files of a program, so everything outside of a struct begins with the
//! name of the task. Letters that C99 compilers need not know become their code points.

use std::collections::{BTreeMap, BTreeSet};

/// The names that are given so far.
pub(super) struct Names {
    /// What everything outside of a struct begins with, without the `_` after it.
    pub(super) prefix: String,
    /// The names outside of structs.
    outer: BTreeSet<String>,
    /// The members of structs. Equal names of the source are equal here, whichever struct they
    /// belong to.
    members: BTreeMap<String, String>,
    taken: BTreeSet<String>,
}

impl Names {
    /// The names of a task's header; `ours` are those of its functions and types, without the prefix.
    pub(super) fn new(task: &str, ours: &[&str]) -> Self {
        let mut prefix = identifier(task);
        if prefix.starts_with(|c: char| c == '_' || c.is_ascii_digit()) {
            prefix.insert(0, 't');
        }
        let outer = ours.iter().map(|name| format!("{prefix}_{name}")).collect();
        Self { prefix, outer, members: BTreeMap::new(), taken: BTreeSet::new() }
    }

    /// A new name outside of structs.
    pub(super) fn outer(&mut self, name: &str) -> String {
        unused(format!("{}_{}", self.prefix, identifier(name)), &mut self.outer)
    }

    /// The member that stands for a name of the source.
    pub(super) fn member(&mut self, name: &str) -> String {
        if let Some(known) = self.members.get(name) {
            return known.clone();
        }
        let mut member = identifier(name);
        if member.starts_with(|c: char| c == '_' || c.is_ascii_digit()) {
            member.insert(0, 'v');
        }
        let is_macro = member.chars().all(|c| !c.is_ascii_lowercase()) && member.len() > 1;
        if is_macro || RESERVED.contains(&&*member) {
            member.push('_');
        }
        let member = unused(member, &mut self.taken);
        self.members.insert(name.to_owned(), member.clone());
        member
    }
}

/// The name with as many `_` behind it as make it a new one.
fn unused(mut name: String, taken: &mut BTreeSet<String>) -> String {
    while !taken.insert(name.clone()) {
        name.push('_');
    }
    name
}

/// The letters, digits and `_` of a name; of other characters the code point, and `_` for those of
/// ASCII.
fn identifier(name: &str) -> String {
    let name = name.strip_prefix("r#").unwrap_or(name).trim_matches('"');
    let mut written = String::new();
    for c in name.chars() {
        match c {
            c if c.is_ascii_alphanumeric() => written.push(c),
            c if c.is_ascii() => written.push('_'),
            c => written.push_str(&format!("u{:x}", u32::from(c))),
        }
    }
    written
}

/// The keywords of C to C23 and of C++, and words in lower case that compilers or system headers
/// define as macros. Of other macros all letters are capitals.
const RESERVED: [&str; 130] = [
    "alignas",
    "alignof",
    "and",
    "and_eq",
    "asm",
    "assert",
    "auto",
    "bitand",
    "bitor",
    "bool",
    "break",
    "case",
    "catch",
    "cdecl",
    "char",
    "char16_t",
    "char32_t",
    "char8_t",
    "class",
    "co_await",
    "co_return",
    "co_yield",
    "compl",
    "complex",
    "concept",
    "const",
    "const_cast",
    "consteval",
    "constexpr",
    "constinit",
    "continue",
    "decltype",
    "default",
    "delete",
    "do",
    "double",
    "dynamic_cast",
    "else",
    "enum",
    "errno",
    "explicit",
    "export",
    "extern",
    "false",
    "far",
    "float",
    "for",
    "fpclassify",
    "friend",
    "goto",
    "huge",
    "i386",
    "if",
    "imaginary",
    "inline",
    "int",
    "interface",
    "isfinite",
    "isgreater",
    "isinf",
    "isless",
    "isnan",
    "isnormal",
    "isunordered",
    "linux",
    "long",
    "math_errhandling",
    "mutable",
    "namespace",
    "near",
    "new",
    "noexcept",
    "noreturn",
    "not",
    "not_eq",
    "nullptr",
    "operator",
    "or",
    "or_eq",
    "pascal",
    "private",
    "protected",
    "public",
    "register",
    "reinterpret_cast",
    "requires",
    "restrict",
    "return",
    "setjmp",
    "short",
    "signbit",
    "signed",
    "sizeof",
    "small",
    "static",
    "static_assert",
    "static_cast",
    "stderr",
    "stdin",
    "stdout",
    "struct",
    "sun",
    "switch",
    "template",
    "this",
    "thread_local",
    "throw",
    "true",
    "try",
    "typedef",
    "typeid",
    "typename",
    "typeof",
    "typeof_unqual",
    "union",
    "unix",
    "unsigned",
    "using",
    "vax",
    "virtual",
    "void",
    "volatile",
    "wchar_t",
    "while",
    "xor",
    "xor_eq",
    "s",
    "p",
    "m",
    "nan",
];

#[cfg(test)]
mod tests {
    use super::Names;

    #[test]
    fn members_are_no_keywords_and_differ() {
        let mut names = Names::new("été", &["state"]);
        assert_eq!(names.prefix, "ue9tue9");
        let members = ["int", "int_", "r#struct", "NAN", "x", "ε", "\"goal room\"", "_q", "__a"];
        let found = members.map(|name| names.member(name));
        let expected =
            ["int_", "int__", "struct_", "NAN_", "x", "u3b5", "goal_room", "v_q", "v__a"];
        assert_eq!(found, expected.map(str::to_owned));
        assert_eq!(names.member("int_"), "int__", "one name, one member");
        assert_eq!(names.outer("state"), "ue9tue9_state_");
    }
}
