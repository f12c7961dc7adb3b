//! Macros.
use proc_macro::TokenStream;
/// Compiles a formula.
#[proc_macro]
pub fn tltl(_: TokenStream) -> TokenStream {
    TokenStream::new()
}
/// Compiles a file.
#[proc_macro]
pub fn include_tltl(_: TokenStream) -> TokenStream {
    TokenStream::new()
}
