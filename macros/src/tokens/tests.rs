//! The text of tokens is read like the tokens, and every part of it leads back to them.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use proptest::prelude::*;
use tltl_compiler::ast::{Ast, ItemKind};
use tltl_compiler::parse;
use tltl_compiler::source::{self, Source};

use super::Flat;

fn tokens(text: &str) -> TokenStream {
    text.parse().unwrap()
}

/// The tokens one by one, brackets among them; invisible ones become round where they matter.
fn leaves(stream: TokenStream, out: &mut Vec<String>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) => {
                let (open, close) = super::delimiters(&group);
                out.push(open.to_owned());
                leaves(group.stream(), out);
                out.push(close.to_owned());
            }
            other => out.push(other.to_string()),
        }
    }
    out.retain(|token| !token.is_empty());
}

fn listed(stream: TokenStream) -> Vec<String> {
    let mut list = Vec::new();
    leaves(stream, &mut list);
    list
}

fn printed(ast: &Ast) -> Vec<String> {
    let root = |kind: &ItemKind| match kind {
        ItemKind::Task(_, root) | ItemKind::Predicate(_, root) => Some(*root),
        _ => None,
    };
    let items = ast.items().iter().filter_map(|item| root(&item.kind));
    // Blanks within Rust code are the author's; tokens have lost them.
    items.map(|root| ast.display(root).to_string().replace(' ', "")).collect()
}

fn read(text: &str) -> Vec<String> {
    let source = Source::new("<tokens>", text);
    printed(&parse::fragment(&source).unwrap_or_else(|errors| panic!("{text}: {errors}")))
}

/// Words, symbols and brackets, each of which Rust takes for tokens.
fn stream() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "a", "F", "U", "r#in", "s.x", "1.5e-3", "0.1", "'a", "'b'", "\"◇a\"", "&&", "||", "=>",
        "!", "-", "<", "<=", "<-", "::", "..", ",", ";", ":", "|", "&", "#", "1", "x.0.1",
        "b\"y\"", "=", "->", "^", "^-", "'static", "r\"x\"", "::a", "?", "@", "_",
    ]);
    let leaf = leaf.prop_map(str::to_owned);
    leaf.prop_recursive(4, 40, 6, |inner| {
        let brackets = prop::sample::select(vec![("(", ")"), ("[", "]"), ("{", "}")]);
        let parts = prop::collection::vec((inner, any::<bool>()), 0..6);
        (brackets, parts).prop_map(|((open, close), parts)| {
            let joined =
                |(part, blank): &(String, bool)| part.clone() + ["", " "][usize::from(*blank)];
            format!("{open}{}{close}", parts.iter().map(joined).collect::<String>())
        })
    })
}

fn formula() -> impl Strategy<Value = String> {
    let leaf = prop::sample::select(vec![
        "a",
        "m::b",
        "s.x < 3",
        "1.0<s.cells[1].0<= -2.5",
        "!a",
        "r#in",
        "s.f(1, x) > 0",
        "true",
        "{ s.ok() }",
    ]);
    leaf.prop_map(str::to_owned).prop_recursive(5, 30, 2, |inner| {
        let infix = prop::sample::select(vec!["&&", "||", "=>", " U ", " T "]);
        prop_oneof![
            (inner.clone(), infix, inner.clone()).prop_map(|(a, op, b)| format!("({a}){op}({b})")),
            inner.clone().prop_map(|a| format!("F({a})")),
            inner.prop_map(|a| format!("X!!({a})")),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn the_text_has_the_same_tokens(text in stream()) {
        let Ok(input) = text.parse::<TokenStream>() else { return Ok(()) };
        let flat = Flat::new(input.clone());
        prop_assume!(!flat.is_literal());
        let again: TokenStream = flat.text.parse().unwrap();
        prop_assert_eq!(listed(again), listed(input.clone()), "{}", flat.text);
        let whole = flat.tokens(source::Span::new(0, flat.text.len()));
        prop_assert_eq!(listed(whole), listed(input));
        for (start, end, tree) in &flat.places {
            let part = flat.tokens(source::Span::new(*start, *end));
            prop_assert_eq!(listed(part), listed(tree.clone().into()));
        }
    }

    #[test]
    fn a_formula_of_tokens_means_what_its_text_does(text in formula()) {
        let flat = Flat::new(tokens(&text));
        prop_assert_eq!(read(&flat.text), read(&text), "{}", flat.text);
        // And so does one that has come through another macro, in invisible brackets.
        let group = Group::new(Delimiter::None, tokens(&text));
        let mut wrapped = tokens("F b &&");
        wrapped.extend([TokenTree::Group(group)]);
        prop_assert_eq!(read(&Flat::new(wrapped).text), read(&format!("F b && ({text})")));
    }
}

#[test]
fn docs_are_comments_again() {
    let flat = Flat::new(tokens(
        "/// The \"state\" \\ of it.\nstate s: Grid<'a, T>; /// One\n/// two.\ntask r#loop = F (s.x < 3.0);",
    ));
    let ast = parse::fragment(&Source::new("<tokens>", flat.text.as_str())).unwrap();
    assert_eq!(ast.items()[0].docs, ["The \"state\" \\ of it."]);
    assert_eq!(ast.items()[1].docs, ["One", "two."]);
    assert_eq!(ast.source().slice(ast.items()[1].name), "r#loop");
    let ItemKind::Host(ty) = ast.items()[0].kind else { panic!() };
    assert_eq!(listed(flat.tokens(ty)), listed(tokens("Grid<'a, T>")));
}

#[test]
fn units_of_tokens_are_those_of_their_text() {
    let units = |text: &str| {
        let ast = parse::fragment(&Source::new("<tokens>", text)).unwrap();
        let written = |kind: &ItemKind| match kind {
            ItemKind::Predicate(takes, _) => takes.iter().map(|one| one.unit.clone()).collect(),
            ItemKind::Constant(unit, _) => vec![unit.clone()],
            _ => Vec::new(),
        };
        let all = ast.items().iter().flat_map(|item| written(&item.kind));
        let slice = |span| ast.source().slice(span).replace(' ', "");
        all.flatten().map(|unit| slice(unit.span)).collect::<Vec<_>>()
    };
    for unit in ["m", "m/s", "kg*m^2/s^2", "s^-1", "1/s", "m ^ - 2", "1 / s ^ -1", "r#in", "F*T"] {
        let text = format!("const c in {unit} = 1; predicate p(d: f64 in {unit}, e: u8) = d < c;");
        let flat = Flat::new(tokens(&text));
        assert_eq!(units(&flat.text), units(&text), "{}", flat.text);
        assert_eq!(units(&text), [(); 2].map(|()| unit.replace(' ', "")));
    }
}

#[test]
fn strings_are_their_content() {
    for (literal, text) in [
        ("\"◇a\"", "◇a"),
        ("r#\"F \"a\"\"#", "F \"a\""),
        ("\"F\\x20a\\t\\u{2227}\\n b\\\\\"", "F a\t∧\n b\\"),
        ("\"F a \\\n      && b\"", "F a && b"),
    ] {
        let flat = Flat::new(tokens(literal));
        assert!(flat.is_literal());
        assert_eq!(flat.text, text);
    }
    assert!(!Flat::new(tokens("\"F a\" && b")).is_literal());
    assert!(!Flat::new(tokens("3")).is_literal());
}

#[test]
fn what_stands_apart_stays_apart() {
    for text in
        ["s: : G", "a ! = b", "a < > b", "a - > b", "0. .6", "1 .5", "1 .!a", "s.0 .1", "x . . y"]
    {
        let flat = Flat::new(tokens(text));
        let solid = |text: &str| text.split_whitespace().map(str::to_owned).collect::<Vec<_>>();
        let again = Flat::new(tokens(&flat.text));
        assert_eq!(listed(tokens(&flat.text)), listed(tokens(text)), "{}", flat.text);
        assert_eq!(solid(&again.text), solid(&flat.text));
    }
    assert_eq!(Flat::new(tokens("s: : G")).text, "s: :G");
    assert_eq!(Flat::new(tokens("3..2 && s.0.1 < .5")).text, "3..2 && s.0.1 < .5");
    assert_eq!(Flat::new(tokens("for all i in 0..=6: !!a")).text, "for all i in 0..= 6: !!a");
}

/// A dot that Rust takes for a field's is a field's in the language too.
#[test]
fn text_and_tokens_have_the_same_dots() {
    for text in ["x < 3.__ e", "x < 3.a e", "x < 3. e"] {
        let message = |text: &str| {
            let errors = parse::fragment(&Source::new("<tokens>", text)).unwrap_err();
            errors.iter().next().unwrap().message().replace(' ', "")
        };
        assert_eq!(message(text), message(&Flat::new(tokens(text)).text));
    }
}
