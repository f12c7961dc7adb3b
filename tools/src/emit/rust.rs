//! A compiled source as a Rust file, formatted: what the macros generate, to be read.

use proc_macro2::TokenStream;
use quote::quote;
use tltl_compiler::compile::Compiled;
use tltl_compiler::emit::rust::{Options, Place, code, is_bare, sizes};
use tltl_compiler::emit::tables as emit;
use tltl_compiler::tables::tables;

/// A source as a Rust file, as the macros would generate it, formatted.
///
/// Declarations become items; of a bare formula, whose propositions are free, there are only the
/// formula and its automaton.
#[must_use]
pub fn file(compiled: &Compiled) -> String {
    let host = |_| TokenStream::new();
    let options =
        Options { runtime: quote! { ::tltl }, state: None, host: &host, place: Place::File };
    let tokens = if is_bare(compiled) { statics(compiled) } else { code(compiled, &options) };
    match syn::parse2(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        Err(_) => tokens.to_string(),
    }
}

/// The formula and the automaton of a bare formula, whose propositions are free.
fn statics(compiled: &Compiled) -> TokenStream {
    let tasks = compiled.module.tasks.iter().zip(&compiled.automata);
    let tasks = tasks.map(|(task, automata)| {
        let runtime = quote! { ::tltl };
        let formula = emit::formula(&task.spec, &task.text, &runtime);
        let automaton = emit::automaton(&tables(&automata.dfa), &runtime);
        let about = format!(" `{}`", task.text);
        let size = format!(" {}", sizes(&automata.dfa));
        quote! {
            #[doc = #about]
            pub static FORMULA: ::tltl::Formula = #formula;
            #[doc = #size]
            pub static AUTOMATON: ::tltl::Automaton = #automaton;
        }
    });
    quote! { #(#tasks)* }
}
