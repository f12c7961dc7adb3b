//! Any Rust tokens inside `tltl!{ … }`: what comes out is Rust, an error with its place or code. If
//! all tokens are of the language, the answer is the one that the same text gets in a file: blanks
//! that rustc has dropped or the macro has put make no difference.
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use tltl_compiler::compile::{self, Compiled};
use tltl_compiler::emit::rust::{self, Options, Place};
use tltl_compiler::error::Errors;
use tltl_compiler::source::{Source, Span};
use tltl_compiler::translate::Budget;

/// Runs the target.
pub fn run(bytes: &[u8]) {
    let Ok(text) = std::str::from_utf8(bytes) else { return };
    let Ok(input) = text.parse::<TokenStream>() else { return };
    // rustc reads a field of any number, and says that there is none; syn does not read it.
    let long = text.replace('_', "").split(|c: char| !c.is_ascii_digit()).any(|n| n.len() > 9);
    // Nor does syn read a field that is called like half a number, `a.4.`.
    let halves = text.split(|c: char| !c.is_ascii_digit() && c != '.').any(|n| n.ends_with('.'));
    let own_rust = text.contains(['{', '[', '|', '(', ':'])
        || long
        || halves
        || mentions_keyword(input.clone());
    let alike = is_of_the_language(text, input.clone());
    let output = crate::expand::inline(input);
    let shown = output.to_string();
    let written = syn::parse2::<syn::File>(output.clone()).is_ok()
        || syn::parse2::<syn::Expr>(output.clone()).is_ok();
    // Rust of the author's own, and names that Rust has taken, are passed on as they are.
    assert!(written || own_rust, "{shown}");
    if alike {
        // Tokens have no lines, after which the next item is looked for if there is a mistake.
        let text = text.replace(['\n', '\r', '\t'], " ");
        match compile::fragment(&Source::new("tltl!", text.as_str()), Budget::default()) {
            Ok(compiled) => same_code(&text, &compiled, &shown),
            Err(errors) => same_mistakes(&errors, output),
        }
    }
}

/// Without what the text says otherwise than its tokens do: comments, strings, attributes of the
/// macro itself, numbers and names that only Rust has, and blanks that tokens cannot keep.
fn is_of_the_language(text: &str, input: TokenStream) -> bool {
    let apart = ["//", "/*", "\"", "'", "#!", "\u{feff}", "\u{200e}", "\u{200f}"]
        .iter()
        .all(|other| !text.contains(other));
    // Rust knows more blanks.
    let blanks = text.chars().all(|c| !c.is_whitespace() || " \t\r\n".contains(c));
    // A dot and a number are `.5` for tokens, empty brackets `[]`, whatever stood between them.
    let dots = !parted(text, '.', |c| c.is_ascii_digit());
    let brackets = !parted(text, '[', |c| c == ']');
    // `F ::a` is `F::a` for tokens, a name of Rust.
    let paths = !['F', 'X', 'G'].iter().any(|&word| parted(text, word, |c| c == ':'));
    apart && blanks && dots && brackets && paths && input.into_iter().all(|tree| is_token(&tree))
}

/// Whether blanks stand between the two characters somewhere.
fn parted(text: &str, before: char, after: impl Fn(char) -> bool) -> bool {
    text.split(before).skip(1).any(|rest| {
        let next = rest.trim_start();
        next.len() < rest.len() && next.starts_with(&after)
    })
}

fn is_token(tree: &TokenTree) -> bool {
    match tree {
        TokenTree::Group(group) => group.stream().into_iter().all(|tree| is_token(&tree)),
        TokenTree::Ident(_) => true,
        TokenTree::Punct(punct) => "!&|=<>-+*/^.,;:?#".contains(punct.as_char()),
        TokenTree::Literal(literal) => {
            literal.to_string().starts_with(|c: char| c.is_ascii_digit())
        }
    }
}

/// The code is that of the text, blanks aside.
fn same_code(text: &str, compiled: &Compiled, shown: &str) {
    let host = |span: Span| text[span.start..span.end].parse().unwrap_or_default();
    let options =
        Options { runtime: quote! { ::tltl }, state: None, host: &host, place: Place::Scope };
    assert_eq!(solid(&rust::code(compiled, &options).to_string()), solid(shown));
}

/// The mistakes are those of the text, blanks aside.
fn same_mistakes(errors: &Errors, output: TokenStream) {
    let mut told = Vec::new();
    messages(output, &mut told);
    let errors: Vec<_> = errors.iter().filter(|error| !error.is_warning()).collect();
    assert_eq!(errors.len(), told.len(), "{errors:?} {told:?}");
    for (error, told) in errors.iter().zip(told) {
        // A long quotation ends earlier the more blanks it has.
        let [message, told] = [error.message(), &told].map(|text| {
            let text = solid(text);
            text.split('…').next().unwrap_or_default().to_owned()
        });
        let same = told.starts_with(&message) || message.starts_with(&told);
        assert!(same, "{message} {told}");
    }
}

/// All string literals.
fn messages(output: TokenStream, told: &mut Vec<String>) {
    for tree in output {
        match tree {
            TokenTree::Group(group) => messages(group.stream(), told),
            TokenTree::Literal(literal) => {
                told.extend(
                    syn::parse_str::<syn::LitStr>(&literal.to_string()).map(|text| text.value()),
                );
            }
            _ => {}
        }
    }
}

fn solid(text: &str) -> String {
    text.chars().filter(|c| !c.is_whitespace()).collect()
}

fn mentions_keyword(input: TokenStream) -> bool {
    let keyword = |tree: TokenTree| match tree {
        TokenTree::Ident(name) => syn::parse_str::<syn::Ident>(&name.to_string()).is_err(),
        _ => false,
    };
    input.into_iter().any(keyword)
}
