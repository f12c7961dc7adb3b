//! Any Rust tokens inside `tltl!{ … }`: what comes out is Rust, an error with its place or code.
#![no_main]

#[allow(dead_code, reason = "files are included by the macro only")]
#[path = "../../../macros/src/expand.rs"]
mod expand;
#[path = "../../../macros/src/tokens.rs"]
mod tokens;

use libfuzzer_sys::fuzz_target;
use proc_macro2::TokenStream;

fuzz_target!(|text: &str| {
    let Ok(input) = text.parse::<TokenStream>() else { return };
    let output = expand::inline(input);
    let shown = output.to_string();
    let file = syn::parse2::<syn::File>(output.clone());
    if file.is_err() {
        if let Err(error) = syn::parse2::<syn::Expr>(output) {
            // Rust of the author's own is passed on as it is.
            assert!(text.contains(['{', '(', '[', '|']), "{error}: {shown}");
        }
    }
});
