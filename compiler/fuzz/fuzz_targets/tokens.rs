//! Any Rust tokens inside `tltl!{ … }`: what comes out is Rust, an error with its place or code.
#![no_main]

#[allow(dead_code, reason = "files are included by the macro only")]
#[path = "../../../macros/src/expand.rs"]
mod expand;
#[path = "../../../macros/src/tokens.rs"]
mod tokens;

use libfuzzer_sys::fuzz_target;
use proc_macro2::{TokenStream, TokenTree};

fuzz_target!(|text: &str| {
    let Ok(input) = text.parse::<TokenStream>() else { return };
    let own_rust = text.contains(['{', '[', '|', '(', ':']) || mentions_keyword(input.clone());
    let output = expand::inline(input);
    let shown = output.to_string();
    let written = syn::parse2::<syn::File>(output.clone()).is_ok()
        || syn::parse2::<syn::Expr>(output).is_ok();
    // Rust of the author's own, and names that Rust has taken, are passed on as they are.
    assert!(written || own_rust, "{shown}");
});

fn mentions_keyword(input: TokenStream) -> bool {
    let keyword = |tree: TokenTree| match tree {
        TokenTree::Ident(name) => syn::parse_str::<syn::Ident>(&name.to_string()).is_err(),
        _ => false,
    };
    input.into_iter().any(keyword)
}
