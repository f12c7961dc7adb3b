//! Names in generated code: the source's, as Rust has them, and our own, which are none of its.
//!
//! A local of ours must never stand for a name that the author has written, nor the reverse, for
//! then the code means something else and nobody is told. In a macro a local is hygienic
//! (`Span::mixed_site`), but that is not enough: a pattern that is called like a constant in scope
//! *is* that constant, hygienic or not, so beside code of the author's ours have a prefix. And text
//! has no hygiene, so none of ours is called like a parameter or a predicate.

use pest::unicode::{XID_CONTINUE, XID_START};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};
use rustc_hash::FxHashSet;

use crate::compile::Compiled;
use crate::reserved::{is_keyword, rust_name};

/// Where generated code stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// Among items or expressions of the author's, in a macro.
    Scope,
    /// In a module of its own, in a macro.
    Module,
    /// In a file of its own, as text.
    File,
}

impl Place {
    /// What the generated items need in front. Of style and of what is not used rustc says nothing
    /// within a macro of another crate, and must not be told so there: a crate may forbid that.
    pub(super) fn lints(self) -> TokenStream {
        match self {
            Self::Scope | Self::Module => quote! { #[allow(clippy::all, clippy::pedantic)] },
            Self::File => quote! {
                #[allow(missing_docs, nonstandard_style, unused, clippy::all, clippy::pedantic)]
            },
        }
    }
}

/// A name of the source as a Rust identifier, raw if Rust has taken the word.
pub(super) fn ident(name: &str) -> Ident {
    let (name, span) = (rust_name(name), Span::call_site());
    if is_keyword(&name) { Ident::new_raw(&name, span) } else { Ident::new(&name, span) }
}

/// What the name of a file is as that of a module: what no name may have in it is `_`.
#[must_use]
pub fn module(stem: &str) -> Ident {
    let mut name = stem.replace(|c| !XID_CONTINUE(c), "_");
    if !name.starts_with(XID_START) {
        name.insert(0, '_');
    }
    ident(&name)
}

/// What Rust has in every scope that no pattern can be called: it would be a pattern of that.
pub(crate) const CONSTRUCTORS: [&str; 4] = ["Some", "None", "Ok", "Err"];

/// The names of the parameters and locals in generated code.
pub(super) struct Names {
    /// What ours begin with; nothing of the source that stands beside them does.
    prefix: String,
    /// The parameters and the predicates of the source.
    taken: FxHashSet<String>,
}

impl Names {
    pub(super) fn new(compiled: &Compiled, place: Place) -> Self {
        let module = &compiled.module;
        let factored = compiled.factored.iter().map(|factored| &factored.task);
        let tasks = module.tasks.iter().chain(factored).flat_map(|task| &task.parameters);
        let parameters = module.predicates.iter().flat_map(|known| &known.parameters).chain(tasks);
        let names = parameters.map(|known| &known.name);
        let predicates = module.predicates.iter().filter(|known| known.declared);
        let names = names.chain(predicates.map(|known| &known.name));
        let taken = names.map(|name| rust_name(name).into_owned()).collect();
        Self::beside(taken, place)
    }

    /// The names in code that has none of a source.
    #[cfg(feature = "hoa")]
    pub(super) fn of_ours(place: Place) -> Self {
        Self::beside(FxHashSet::default(), place)
    }

    fn beside(taken: FxHashSet<String>, place: Place) -> Self {
        let mut prefix = String::new();
        if place == Place::Scope {
            prefix.push_str("__tltl_");
            while taken.iter().any(|name| name.starts_with(&prefix)) {
                prefix.push('_');
            }
        }
        Self { prefix, taken }
    }

    /// A local of ours.
    pub(super) fn local(&self, name: &str) -> Ident {
        let name = self.free(name.to_owned());
        format_ident!("{}{}", self.prefix, name, span = Span::mixed_site())
    }

    /// What a parameter of the source is bound to.
    pub(super) fn parameter(&self, name: &str) -> Ident {
        let known = rust_name(name);
        if !self.prefix.is_empty() {
            return format_ident!("{}{}", self.prefix, known, span = Span::mixed_site());
        }
        if CONSTRUCTORS.contains(&&*known) {
            return format_ident!("{}", self.free(known.into_owned()));
        }
        ident(name)
    }

    /// The name, with as many `_` after it as it takes to be none of the source's.
    fn free(&self, mut name: String) -> String {
        while self.taken.contains(&name) {
            name.push('_');
        }
        name
    }
}
