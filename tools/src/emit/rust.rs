//! A compiled source as a formatted Rust file: the code that the macros generate, to be read.
//!
//! The tokens are those of the macros; `prettyplease` lays them out, since it needs no rustfmt at
//! run time. The file compiles in a crate that depends on `tltl`.

use proc_macro2::TokenStream;
use quote::quote;
use tltl_compiler::compile::Compiled;
use tltl_compiler::dfa::Dfa;
use tltl_compiler::emit::foreign as emit_foreign;
use tltl_compiler::emit::rust::{Options, Place, code, is_bare, sizes};
use tltl_compiler::emit::tables as emit;
use tltl_compiler::source::visible;
use tltl_compiler::tables::tables;

/// A compiled source as a Rust file.
///
/// Declarations become the items that a macro would generate. A bare formula has no predicates to
/// generate, because its propositions are free: its file has the formula and the automaton as
/// statics.
///
/// ```
/// use tltl_compiler::{compile, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "F a && F b");
/// let compiled = compile::formula(&source, Budget::default())?;
/// let rust = tltlc::emit::rust::file(&compiled);
/// assert!(rust.starts_with("/// `F a && F b`\npub static FORMULA: ::tltl::Formula ="));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn file(compiled: &Compiled) -> String {
    let host = |_| TokenStream::new();
    let options =
        Options { runtime: quote! { ::tltl }, state: None, host: &host, place: Place::File };
    laid_out(if is_bare(compiled) { statics(compiled) } else { code(compiled, &options) })
}

/// An automaton that came without a formula as a Rust file: what `include_tltl!` makes of it.
///
/// ```
/// use tltl_compiler::translate::Budget;
///
/// let task = tltlc::task::compile("a T b", Budget::default())?;
/// let rust = tltlc::emit::rust::foreign("order", task.dfa());
/// assert!(rust.contains("pub fn task<P0, P1>(p0: P0, p1: P1)"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[must_use]
pub fn foreign(name: &str, dfa: &Dfa) -> String {
    laid_out(emit_foreign::automaton(name, dfa, &quote! { ::tltl }, Place::File))
}

fn laid_out(tokens: TokenStream) -> String {
    match syn::parse2(tokens.clone()) {
        Ok(file) => prettyplease::unparse(&file),
        Err(_) => tokens.to_string(),
    }
}

/// The formula and the automaton of a bare formula.
fn statics(compiled: &Compiled) -> TokenStream {
    let tasks = compiled.module.tasks.iter().zip(&compiled.automata);
    let tasks = tasks.map(|(task, automata)| {
        let runtime = quote! { ::tltl };
        let formula = emit::formula(&task.spec, &task.text, &runtime);
        let automaton = emit::automaton(&tables(&automata.dfa), &runtime);
        let about = format!(" `{}`", visible(&task.text));
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
