//! `compiler/src/grammar/rules.rs` is `grammar.pest` as a table, and the compiler's machine reads it
//! as pest would.
//!
//! The table is committed, so that users of the macros build neither pest nor its generator. After a
//! change of the grammar, `UPDATE_GRAMMAR=1 cargo test -p tltl-tests grammar` writes it anew.

#[path = "../compiler/src/grammar/mod.rs"]
mod machine;

use std::collections::BTreeSet;
use std::path::Path;

use machine::{Pairs, Rule};
use pest::Token;
use pest::error::{ErrorVariant, InputLocation};
use pest_meta::ast::RuleType;
use pest_meta::optimizer::{OptimizedExpr, OptimizedRule};
use pest_vm::Vm;
use proc_macro2::{Ident, Literal, TokenStream};
use proptest::prelude::*;
use quote::{format_ident, quote};

const HEADER: &str = "// Generated from grammar.pest by tests/grammar.rs; do not edit.\n\n";

fn folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../compiler/src")
}

/// The rules of the grammar, as pest optimizes them.
fn rules() -> Vec<OptimizedRule> {
    let grammar = std::fs::read_to_string(folder().join("grammar.pest")).unwrap();
    pest_meta::parse_and_optimize(&grammar).unwrap().1
}

#[test]
fn the_committed_table_is_fresh() {
    let generated = generate(&rules());
    let file = folder().join("grammar/rules.rs");
    if std::env::var_os("UPDATE_GRAMMAR").is_some() {
        std::fs::write(&file, &generated).unwrap();
    }
    let committed = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(committed == generated, "run this test with UPDATE_GRAMMAR=1");
}

fn generate(rules: &[OptimizedRule]) -> String {
    let count = Literal::usize_unsuffixed(rules.len() + 1);
    let names = rules.iter().map(|rule| variant(&rule.name));
    let definitions = rules.iter().map(definition);
    let file = quote! {
        use super::Kind::{self, *};
        use super::Peg::{self, *};

        /// The rules of the grammar; `EOI` is the end of the text.
        #[allow(non_camel_case_types, clippy::upper_case_acronyms, reason = "named as in the grammar")]
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub(crate) enum Rule {
            EOI,
            #(#names),*
        }

        /// The definition of each rule, in the same order.
        pub(super) static RULES: [(Kind, Peg); #count] = [
            (Pair, End),
            #(#definitions),*
        ];
    };
    format!("{HEADER}{}", prettyplease::unparse(&syn::parse2(file).unwrap()))
}

fn definition(rule: &OptimizedRule) -> TokenStream {
    let kind = match (rule.name.as_str(), rule.ty) {
        ("WHITESPACE" | "COMMENT", _) => quote!(Blank),
        (_, RuleType::Normal) => quote!(Pair),
        (_, RuleType::Atomic) => quote!(Token),
        (_, RuleType::Silent) => quote!(Silent),
        (name, _) => panic!("{name} is of a kind that the machine does not have"),
    };
    let peg = peg(&rule.expr);
    quote!((#kind, #peg))
}

fn peg(expression: &OptimizedExpr) -> TokenStream {
    use OptimizedExpr as E;
    match expression {
        E::Str(text) => quote!(Text(#text)),
        E::Ident(name) => ident(name),
        E::Seq(..) => {
            let parts = parts(expression, &|part| match part {
                E::Seq(first, rest) => Some((first, rest)),
                _ => None,
            });
            quote!(Sequence(&[#(#parts),*]))
        }
        E::Choice(..) => {
            let parts = parts(expression, &|part| match part {
                E::Choice(first, rest) => Some((first, rest)),
                _ => None,
            });
            quote!(Choice(&[#(#parts),*]))
        }
        E::Opt(part) => within(quote!(Optional), part),
        E::Rep(part) => within(quote!(Repeat), part),
        E::PosPred(part) => within(quote!(Ahead), part),
        E::NegPred(part) => within(quote!(Not), part),
        E::Skip(ends) => {
            quote!(Repeat(&Sequence(&[Not(&Choice(&[#(Text(#ends)),*])), Class(|_| true)])))
        }
        other => panic!("the machine has no {other}"),
    }
}

/// The operands of a chain, right-associative as pest has it.
fn parts(
    mut chain: &OptimizedExpr,
    split: &dyn Fn(&OptimizedExpr) -> Option<(&OptimizedExpr, &OptimizedExpr)>,
) -> Vec<TokenStream> {
    let mut parts = Vec::new();
    while let Some((first, rest)) = split(chain) {
        parts.push(peg(first));
        chain = rest;
    }
    parts.push(peg(chain));
    parts
}

fn within(what: TokenStream, part: &OptimizedExpr) -> TokenStream {
    let part = peg(part);
    quote!(#what(&#part))
}

/// What a name stands for: pest's own rules are classes of characters and ends of the text.
fn ident(name: &str) -> TokenStream {
    match name {
        "SOI" => quote!(Start),
        "ANY" => quote!(Class(|_| true)),
        "ASCII_DIGIT" => quote!(Class(|next| next.is_ascii_digit())),
        "XID_START" => quote!(Class(unicode_ident::is_xid_start)),
        "XID_CONTINUE" => quote!(Class(unicode_ident::is_xid_continue)),
        name => {
            let name = variant(name);
            quote!(Call(Rule::#name))
        }
    }
}

/// The name of a rule, raw if it is a keyword of Rust.
fn variant(name: &str) -> Ident {
    syn::parse_str(name).unwrap_or_else(|_| format_ident!("r#{name}"))
}

/// What a reader makes of a text: the pairs with their depths, or where it stopped and the rules
/// that could have gone on there.
type Reading = Result<Vec<(usize, String, String)>, (usize, BTreeSet<String>)>;

fn of_pest(vm: &Vm, rule: &str, text: &str) -> Reading {
    let parsed = vm.parse(rule, text).map_err(|error| match (error.location, error.variant) {
        (InputLocation::Pos(at), ErrorVariant::ParsingError { positives, .. }) => {
            (at, positives.into_iter().map(str::to_owned).collect())
        }
        other => panic!("{other:?}"),
    })?;
    let (mut list, mut open) = (Vec::new(), Vec::new());
    for token in parsed.tokens() {
        match token {
            Token::Start { rule, pos } => {
                open.push(list.len());
                list.push((open.len(), rule.to_owned(), text[pos.pos()..].to_owned()));
            }
            Token::End { pos, .. } => {
                let matched = &mut list[open.pop().unwrap()].2;
                matched.truncate(matched.len() - (text.len() - pos.pos()));
            }
        }
    }
    Ok(list)
}

fn of_the_machine(rule: Rule, text: &str) -> Reading {
    fn add(pairs: Pairs<'_>, depth: usize, list: &mut Vec<(usize, String, String)>) {
        for pair in pairs {
            list.push((depth, format!("{:?}", pair.as_rule()), pair.as_str().to_owned()));
            add(pair.into_inner(), depth + 1, list);
        }
    }
    let name = |rule| format!("{rule:?}");
    let tree = machine::parse(rule, text)
        .map_err(|stopped| (stopped.at, stopped.expected.into_iter().map(name).collect()))?;
    let mut list = Vec::new();
    add(tree.pairs(), 1, &mut list);
    Ok(list)
}

/// The rules by which the compiler reads.
const ENTRIES: [Rule; 5] =
    [Rule::formula, Rule::fragment, Rule::prologue, Rule::next, Rule::heading];

fn assert_read_alike(vm: &Vm, text: &str) {
    for rule in ENTRIES {
        let expected = of_pest(vm, &format!("{rule:?}"), text);
        assert_eq!(of_the_machine(rule, text), expected, "{rule:?}: {text:?}");
    }
}

#[test]
fn the_machine_reads_every_mistake_of_the_gallery_as_pest_does() {
    let vm = Vm::new(rules());
    let gallery = include_str!("data/mistakes.txt").split("\n== ").skip(1);
    gallery.filter_map(|case| case.split_once('\n')).for_each(|(_, text)| {
        assert_read_alike(&vm, text);
        text.char_indices().for_each(|(at, _)| assert_read_alike(&vm, &text[..at]));
    });
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2_000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_machine_reads_as_pest_does(words in prop::collection::vec(prop::sample::select(WORDS), 0..16)) {
        thread_local!(static VM: Vm = Vm::new(rules()));
        VM.with(|vm| assert_read_alike(vm, &words.concat()));
    }
}

/// Whatever the grammar names, whole and in part.
const WORDS: &[&str] = &[
    "a",
    "b1",
    "r#in",
    "F",
    "X ",
    "U",
    " T ",
    "not ",
    "!",
    "¬",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ",",
    ";",
    ":",
    "::",
    ".",
    "..",
    "=",
    "==",
    "=>",
    "<=>",
    "<",
    "<>",
    "&&",
    "|",
    "-",
    "->",
    "−",
    "+",
    "*",
    "/",
    "÷",
    "^",
    "#",
    "?",
    " ",
    "\n",
    "\t",
    "// c\n",
    "/* d */",
    "/*",
    "/// e\n",
    "//! f\n",
    "1",
    "2.5",
    "3e-4",
    ".6f64",
    "_",
    "高",
    "true",
    "⊥",
    "'x'",
    "\"s\"",
    "\\",
    "state ",
    "struct ",
    "enum ",
    "const ",
    "predicate ",
    "task ",
    "p = a",
    "state S { x: f64 in m }\n",
    "enum E { u, v }\n",
    "const n = 2\n",
    "predicate q(d: f64) = x < d\n",
    "task t = F a\n",
    "#[factored]\n",
    "#[budget(states = 1)]",
    "|s: &S| ",
    "for all i in 0..2: ",
    "for some ",
    "in",
    "{f(s)}",
];
