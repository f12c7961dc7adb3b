//! An automaton that came without a formula as Rust: what `include_tltl!` makes of a HOA file.
//!
//! Nothing is known about its propositions but their names, so the task takes a predicate for each:
//! it is generic in them, as a bare formula is in the values that it names. Its formula is empty,
//! so robustness is that of the best accepting run instead of the formula's.

use proc_macro2::{Ident, TokenStream};
use quote::quote;

use crate::dfa::Dfa;
use crate::emit::declare::{documentation, sizes};
use crate::emit::implementation::{Robust, dense, positional};
use crate::emit::names::{Names, Place, ident};
use crate::emit::tables as emit;
use crate::tables::tables;

/// The automaton as items: a function `task` that takes a predicate for each proposition, in order,
/// and returns the task. `runtime` is the path of the runtime crate.
#[must_use]
pub fn automaton(name: &str, dfa: &Dfa, runtime: &TokenStream, place: Place) -> TokenStream {
    let tables = tables(dfa);
    let table = emit::automaton(&tables, runtime);
    let names = Names::of_ours(place);
    let numbered = |prefix: &str| -> Vec<Ident> {
        (0..dfa.propositions.len()).map(|i| names.local(&format!("{prefix}{i}"))).collect()
    };
    let (types, arguments) = (numbered("P"), numbered("p"));
    let propositions: Vec<_> = dfa.propositions.iter().map(|p| format!("`{p}`")).collect();
    let about =
        format!("The task of the automaton `{name}`, over one predicate for each proposition:");
    let docs = documentation(&[about], &[propositions.join(", "), sizes(dfa)]);
    // Without a formula, robustness is that of the best run, which keeps a cell for each state.
    let robust = Robust::Interpreted([dfa.len(); 2]);
    let implementation =
        positional(&types, &ident("Predicates"), runtime, &names, robust, dense(&tables));
    quote! {
        #docs
        #[must_use]
        pub fn task<#(#types),*>(#(#arguments: #types),*) -> #runtime::Task<Predicates<#(#types),*>> {
            static FORMULA: #runtime::Formula = #runtime::Formula::trusted(
                #runtime::Shared::from_static(#name),
                #runtime::Shared::from_static(&[]),
            );
            static AUTOMATON: #runtime::Automaton = #table;
            #runtime::Task::trusted(
                #runtime::Shared::from_static(#name),
                #runtime::Shared::from_static(&FORMULA),
                #runtime::Shared::from_static(&AUTOMATON),
                Predicates(#(#arguments),*),
            )
        }

        /// One predicate for each proposition.
        #[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug)]
        pub struct Predicates<#(#types),*>(#(#types),*);

        #implementation
    }
}
