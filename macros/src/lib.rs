//! The macros of the crate `tltl`, which re-exports and documents them.
//!
//! Everything happens in the compiler; this crate only turns tokens into text and errors back into
//! tokens. It reads no clock, writes no file and runs no program.

mod expand;
mod tokens;

use proc_macro::TokenStream;

/// Compiles a formula, or declarations of predicates and tasks, at build time.
#[proc_macro]
pub fn tltl(input: TokenStream) -> TokenStream {
    expand::inline(input.into()).into()
}

/// Compiles a task file into a module at build time.
#[proc_macro]
pub fn include_tltl(input: TokenStream) -> TokenStream {
    expand::include(input.into()).into()
}
