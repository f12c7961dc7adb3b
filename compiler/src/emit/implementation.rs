//! The implementation of the runtime's `Predicates` for the predicates of one task.
//!
//! One type answers for all predicates of a task, by number: a `match` with an arm for each, once for
//! the robustness and once for the truth. After inlining this is the code that an author would write
//! by hand for that task: no pointer to a function, no call that is not known when it is compiled.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use crate::emit::predicates::ident;

/// What an implementation is made of. For a file's task the state is one type, and the arms are the
/// predicates' code; for a bare formula it is any type that all predicates read.
pub(super) struct Implementation<'a> {
    /// The path of the runtime crate.
    pub(super) runtime: &'a TokenStream,
    /// The generic parameters, in their brackets.
    pub(super) generics: TokenStream,
    /// The type of the state.
    pub(super) state: TokenStream,
    /// What the arms call the state.
    pub(super) argument: Ident,
    /// The type that implements.
    pub(super) name: TokenStream,
    /// The arms `number => robustness,`.
    pub(super) robustness: TokenStream,
    /// The arms `number => truth,`.
    pub(super) holds: TokenStream,
    /// The cells of scratch space that a trajectory's robustness needs, one for each operator. The
    /// number is known here, so the space is an array on the stack.
    pub(super) scratch: usize,
}

impl Implementation<'_> {
    /// The `impl` block.
    pub(super) fn tokens(&self) -> TokenStream {
        let Self { runtime, generics, state, argument: s, name, robustness, holds, scratch } = self;
        let scratch = Literal::usize_unsuffixed(*scratch);
        quote! {
            #[allow(unused_variables, clippy::all)]
            impl #generics #runtime::robustness::Predicates<#state> for #name {
                #[inline]
                fn robustness(&self, i: ::core::primitive::usize, #s: &#state) -> ::core::primitive::f64 {
                    match i {
                        #robustness
                        _ => #runtime::private::no_predicate(i),
                    }
                }
                #[inline]
                fn holds(
                    &self,
                    i: ::core::primitive::usize,
                    #s: &#state,
                ) -> ::core::result::Result<::core::primitive::bool, #runtime::robustness::NotANumber> {
                    match i {
                        #holds
                        _ => #runtime::private::no_predicate(i),
                    }
                }
                #[inline]
                fn with_scratch<__R>(
                    &self,
                    _: ::core::primitive::usize,
                    f: impl ::core::ops::FnOnce(
                        &mut [::core::primitive::f64],
                        &mut [::core::primitive::f64],
                    ) -> __R,
                ) -> __R {
                    f(&mut [0.0; #scratch], &mut [0.0; #scratch])
                }
            }
        }
    }
}

/// The implementation for a tuple struct `name` of predicates, which are of the generic `types`, for
/// every state that all of them read.
pub(super) fn positional(
    types: &[Ident],
    name: &Ident,
    runtime: &TokenStream,
    scratch: usize,
) -> TokenStream {
    let places: Vec<_> = (0..types.len()).map(Literal::usize_unsuffixed).collect();
    let arms = |method: &str| {
        let method = ident(method);
        quote! { #(#places => #runtime::Predicate::#method(&self.#places, s),)* }
    };
    Implementation {
        runtime,
        generics: quote! { <__S: ?Sized, #(#types: #runtime::Predicate<__S>),*> },
        state: quote! { __S },
        argument: ident("s"),
        name: quote! { #name<#(#types),*> },
        robustness: arms("robustness"),
        holds: arms("holds"),
        scratch,
    }
    .tokens()
}
