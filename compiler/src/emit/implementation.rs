//! The implementation of the runtime's `Predicates` for the predicates of one task.
//!
//! One type answers for all predicates of a task, by number: a `match` with an arm for each, once
//! for the robustness and once for the truth. After inlining, this is the code that an author would
//! write by hand for that task: no function pointer, no call whose target is unknown at compile
//! time.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use crate::emit::names::{Names, Place};
use crate::spec::Spec;
use crate::tables::{cells, operators};

/// The parts of an implementation. For a task of a file the state is one type, and the arms are the
/// code of the predicates; for a bare formula it is any type that all predicates read.
pub(super) struct Implementation<'a> {
    /// The path of the runtime crate.
    pub(super) runtime: &'a TokenStream,
    /// The names of locals.
    pub(super) names: &'a Names,
    /// The attributes in front of it.
    pub(super) lints: TokenStream,
    /// The generic parameters, in their brackets.
    pub(super) generics: TokenStream,
    /// The type of the state.
    pub(super) state: TokenStream,
    /// The state as an argument, as the arms call it.
    pub(super) argument: TokenStream,
    /// The type that implements the trait.
    pub(super) name: TokenStream,
    /// The arms `number => robustness,`.
    pub(super) robustness: TokenStream,
    /// The arms `number => truth,`.
    pub(super) holds: TokenStream,
    /// The cells of the two buffers that the robustness of a trajectory needs. The numbers are known
    /// here, so the buffers are arrays on the stack, unless they are large.
    pub(super) scratch: [usize; 2],
}

/// The cells of the two buffers for a formula.
pub(super) fn scratch(spec: &Spec) -> [usize; 2] {
    let operators = operators(spec);
    [cells(&operators), operators.len()]
}

/// Larger buffers are left to the runtime, which takes them from the heap if there is one: 32 KB, of
/// the 2 MB that the stack of a thread has.
const LARGE: usize = 4096;

impl Implementation<'_> {
    /// The `impl` block.
    pub(super) fn tokens(&self) -> TokenStream {
        let Self { runtime, lints, generics, state, argument: s, name, robustness, holds, .. } =
            self;
        let (i, f) = (self.names.local("i"), self.names.local("f"));
        let (cells, scratch) = self.scratch(&f);
        quote! {
            #lints
            impl #generics #runtime::robustness::Predicates<#state> for #name {
                #[inline]
                fn robustness(&self, #i: ::core::primitive::usize, #s: &#state) -> ::core::primitive::f64 {
                    match #i {
                        #robustness
                        _ => #runtime::private::no_predicate(#i),
                    }
                }
                #[inline]
                fn holds(
                    &self,
                    #i: ::core::primitive::usize,
                    #s: &#state,
                ) -> ::core::result::Result<::core::primitive::bool, #runtime::robustness::NotANumber> {
                    match #i {
                        #holds
                        _ => #runtime::private::no_predicate(#i),
                    }
                }
                #[inline]
                fn with_scratch<__R>(
                    &self,
                    #cells: ::core::primitive::usize,
                    #f: impl ::core::ops::FnOnce(
                        &mut [::core::primitive::f64],
                        &mut [::core::primitive::f64],
                    ) -> __R,
                ) -> __R {
                    #scratch
                }
            }
        }
    }

    /// How `with_scratch` names the number of cells, and calls `f`.
    fn scratch(&self, f: &Ident) -> (TokenStream, TokenStream) {
        let runtime = self.runtime;
        let [now, next] = self.scratch.map(Literal::usize_unsuffixed);
        if self.scratch[0] <= LARGE {
            return (quote! { _ }, quote! { #f(&mut [0.0; #now], &mut [0.0; #next]) });
        }
        let cells = self.names.local("cells");
        let call = quote! { #runtime::private::large_scratch::<#now, #next, __R>(#cells, #f) };
        (quote! { #cells }, call)
    }
}

/// The implementation for a tuple struct `name` of predicates, which have the generic `types`, for
/// every state that all of them read.
pub(super) fn positional(
    types: &[Ident],
    name: &Ident,
    runtime: &TokenStream,
    names: &Names,
    scratch: [usize; 2],
) -> TokenStream {
    let places: Vec<_> = (0..types.len()).map(Literal::usize_unsuffixed).collect();
    let s = names.local("s");
    let arms = |method: &str| {
        let method = Ident::new(method, Span::call_site());
        quote! { #(#places => #runtime::Predicate::#method(&self.#places, #s),)* }
    };
    Implementation {
        runtime,
        names,
        lints: Place::Scope.lints(),
        generics: quote! { <__S: ?::core::marker::Sized, #(#types: #runtime::Predicate<__S>),*> },
        state: quote! { __S },
        argument: quote! { #s },
        name: quote! { #name<#(#types),*> },
        robustness: arms("robustness"),
        holds: arms("holds"),
        scratch,
    }
    .tokens()
}
