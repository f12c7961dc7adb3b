//! The implementation of the runtime's `Predicates` for the predicates of one task.
//!
//! One type answers for all predicates of a task, by number: a `match` with an arm for each, once
//! for the robustness and once for the truth. After inlining, this is the code that an author would
//! write by hand for that task: no function pointer, no call whose target is unknown at compile
//! time.

use proc_macro2::{Ident, Literal, Span, TokenStream};
use quote::quote;

use crate::emit::names::{Names, Place};
use crate::emit::typed;
use crate::spec::Spec;
use crate::tables::{Tables, Transitions, cells, operators};

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
    /// Those of them that are types of predicates.
    pub(super) types: &'a [Ident],
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
    /// How the robustness of a trajectory is computed.
    pub(super) robust: Robust,
    /// The number of predicates, if a step reads all of them; otherwise 0.
    pub(super) dense: usize,
    /// Whether they all compare floats, as an expression, if a step reads all of them.
    pub(super) floats: Option<TokenStream>,
}

/// The predicates that the runtime evaluates together for a step: as many as a table has at most.
pub(super) const TOGETHER: usize = 10;

/// The number of predicates, if a step of the automaton reads all of them: it is a table. Otherwise 0.
pub(super) fn dense(tables: &Tables) -> usize {
    match tables.transitions {
        Transitions::Table { .. } => tables.propositions.len(),
        Transitions::Diagram { .. } => 0,
    }
}

/// How the robustness of a trajectory is computed.
pub(super) enum Robust {
    /// In a straight line, by the type of the formula.
    Typed(TokenStream),
    /// Operator by operator, in two buffers of so many cells. The numbers are known here, so the
    /// buffers are arrays on the stack, unless they are large.
    Interpreted([usize; 2]),
}

impl Robust {
    /// For a formula: a type, unless that would be too large.
    pub(super) fn of(spec: &Spec, runtime: &TokenStream) -> Self {
        typed::formula(spec, runtime).map_or_else(|| Self::interpreted(spec), Self::Typed)
    }

    /// For a formula whose parts are read one by one.
    pub(super) fn interpreted(spec: &Spec) -> Self {
        let operators = operators(spec);
        Self::Interpreted([cells(&operators), operators.len()])
    }
}

/// Larger buffers are left to the runtime, which takes them from the heap if there is one: 32 KB, of
/// the 2 MB that the stack of a thread has.
const LARGE: usize = 4096;

impl Implementation<'_> {
    /// The `impl` block.
    pub(super) fn tokens(&self) -> TokenStream {
        let Self { runtime, lints, generics, state, argument: s, name, robustness, holds, .. } =
            self;
        let i = self.names.local("i");
        let dense = (self.dense > 0).then(|| {
            let count = Literal::usize_unsuffixed(self.dense);
            quote! { const DENSE: ::core::primitive::usize = #count; }
        });
        let floats = self.floats.as_ref().map(|floats| {
            quote! {
                #[inline]
                fn floats() -> ::core::primitive::bool {
                    #floats
                }
            }
        });
        let (method, formula) = match &self.robust {
            Robust::Typed(formula) => (self.straight(), self.formula(formula)),
            Robust::Interpreted(cells) => (self.scratch(*cells), TokenStream::new()),
        };
        quote! {
            #lints
            impl #generics #runtime::robustness::Predicates<#state> for #name {
                #dense
                #floats
                #[inline]
                fn robustness(&self, #i: ::core::primitive::usize, #s: &#state) -> ::core::primitive::f64 {
                    match #i {
                        #robustness
                        _ => ::core::primitive::f64::NAN,
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
                        _ => ::core::result::Result::Err(#runtime::robustness::NotANumber),
                    }
                }
                #method
            }
            #formula
        }
    }

    /// The formula as a type that belongs to that of the predicates.
    fn formula(&self, formula: &TokenStream) -> TokenStream {
        let Self { runtime, lints, types, name, .. } = self;
        quote! {
            #lints
            impl<#(#types),*> #runtime::robustness::typed::Typed for #name {
                type Formula = #formula;
            }
        }
    }

    /// The method that computes robustness in a straight line.
    fn straight(&self) -> TokenStream {
        let (runtime, state) = (self.runtime, &self.state);
        let (rows, signal) = (self.names.local("rows"), self.names.local("signal"));
        quote! {
            #[inline]
            fn straight(
                &self,
                #rows: &[#state],
                #signal: &mut [::core::primitive::f64],
            ) -> ::core::option::Option<::core::primitive::f64>
            where
                #state: ::core::marker::Sized,
            {
                #runtime::robustness::typed::straight(self, #rows, #signal)
            }
        }
    }

    /// The method that lends the two buffers.
    fn scratch(&self, [now, next]: [usize; 2]) -> TokenStream {
        let (runtime, f) = (self.runtime, self.names.local("f"));
        let is_large = now > LARGE;
        let [now, next] = [now, next].map(Literal::usize_unsuffixed);
        let (cells, call) = if is_large {
            let cells = self.names.local("cells");
            let call = quote! { #runtime::private::large_scratch::<#now, #next, __R>(#cells, #f) };
            (quote! { #cells }, call)
        } else {
            (quote! { _ }, quote! { #f(&mut [0.0; #now], &mut [0.0; #next]) })
        };
        quote! {
            #[inline]
            fn with_scratch<__R>(
                &self,
                #cells: ::core::primitive::usize,
                #f: impl ::core::ops::FnOnce(
                    &mut [::core::primitive::f64],
                    &mut [::core::primitive::f64],
                ) -> __R,
            ) -> __R {
                #call
            }
        }
    }
}

/// The implementation for a tuple struct `name` of predicates, which have the generic `types`, for
/// every state that all of them read.
pub(super) fn positional(
    types: &[Ident],
    name: &Ident,
    runtime: &TokenStream,
    names: &Names,
    robust: Robust,
    dense: usize,
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
        types,
        generics: quote! { <__S: ?::core::marker::Sized, #(#types: #runtime::Predicate<__S>),*> },
        state: quote! { __S },
        argument: quote! { #s },
        name: quote! { #name<#(#types),*> },
        robustness: arms("robustness"),
        holds: arms("holds"),
        robust,
        dense,
        floats: None,
    }
    .tokens()
}
