//! Names in generated code: the source's, as Rust has them, and those of generated locals.
//!
//! A generated local must never capture a name that the author has written, nor the reverse: the
//! code would silently mean something else. In a macro a local is hygienic (`Span::mixed_site`),
//! but that is not enough. A pattern with the name of a constant in scope *is* that constant,
//! hygienic or not, so locals beside the author's code have a prefix. And text has no hygiene at
//! all, so no local has the name of a parameter or a predicate.

use proc_macro2::{Ident, Span, TokenStream};
use quote::{format_ident, quote};
use unicode_ident::{is_xid_continue, is_xid_start};

use crate::compile::Compiled;
use crate::intern::Interner;
use crate::reserved::{is_constructor, is_keyword, rust_name};

/// The place in which generated code stands. It decides how locals are named and which lints are
/// allowed.
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
    /// The attribute in front of generated items. rustc reports lints of style and of unused items
    /// in a file, and not within the macro of another crate; there, an `allow` of them would itself
    /// be an error in a crate that forbids it.
    pub(super) fn lints(self) -> TokenStream {
        match self {
            Self::Scope | Self::Module => quote! { #[allow(clippy::all, clippy::pedantic)] },
            Self::File => quote! {
                #[allow(missing_docs, nonstandard_style, unused, clippy::all, clippy::pedantic)]
            },
        }
    }
}

/// A name of the source as a Rust identifier, raw if it is a keyword.
pub(super) fn ident(name: &str) -> Ident {
    let (name, span) = (rust_name(name), Span::call_site());
    if is_keyword(&name) { Ident::new_raw(&name, span) } else { Ident::new(&name, span) }
}

/// The name of a file as the name of a module: characters that an identifier cannot have become
/// `_`.
///
/// ```
/// use tltl_compiler::emit::rust::module_name;
///
/// assert_eq!(module_name("pick-and-place").to_string(), "pick_and_place");
/// assert_eq!(module_name("7steps").to_string(), "_7steps");
/// assert_eq!(module_name("match").to_string(), "r#match");
/// ```
#[must_use]
pub fn module(stem: &str) -> Ident {
    let mut name = stem.replace(|c| !is_xid_continue(c), "_");
    if !name.starts_with(is_xid_start) {
        name.insert(0, '_');
    }
    ident(&name)
}

/// The names of parameters and locals in generated code.
pub(super) struct Names {
    /// The prefix of locals, which no name of the source beside them has; empty where no code of
    /// the author's stands beside them.
    prefix: String,
    /// The names of the source's parameters and predicates.
    taken: Interner<String>,
    /// The names of its values, which rustc takes for a slip where they are bound.
    values: Interner<String>,
}

impl Names {
    /// The names for code of a compiled source.
    pub(super) fn new(compiled: &Compiled, place: Place) -> Self {
        let module = &compiled.module;
        let factored = compiled.factored.iter().map(|factored| &factored.task);
        let tasks = module.tasks.iter().chain(factored).flat_map(|task| &task.parameters);
        let parameters = module.predicates.iter().flat_map(|known| &known.parameters).chain(tasks);
        let names = parameters.map(|known| &known.name);
        let predicates = module.predicates.iter().filter(|known| known.declared);
        let names = names.chain(predicates.map(|known| &known.name));
        let values = module.enums.iter().flat_map(|known| &known.variants);
        let (mut taken, mut known) = (Interner::default(), Interner::default());
        for name in names {
            taken.intern(rust_name(name).into_owned());
        }
        for name in values {
            known.intern(rust_name(name).into_owned());
        }
        Self::beside(taken, known, place)
    }

    /// The names in code without a source.
    #[cfg(feature = "hoa")]
    pub(super) fn of_ours(place: Place) -> Self {
        Self::beside(Interner::default(), Interner::default(), place)
    }

    /// The names beside those of a source. The prefix is made longer until none of `taken` begins
    /// with it.
    fn beside(taken: Interner<String>, values: Interner<String>, place: Place) -> Self {
        let mut prefix = String::new();
        if place == Place::Scope {
            prefix.push_str("__tltl_");
            while taken.things().iter().any(|name| name.starts_with(&prefix)) {
                prefix.push('_');
            }
        }
        Self { prefix, taken, values }
    }

    /// A generated local.
    pub(super) fn local(&self, name: &str) -> Ident {
        let name = self.free(name.to_owned());
        format_ident!("{}{}", self.prefix, name, span = Span::mixed_site())
    }

    /// The local to which a parameter of the source is bound.
    pub(super) fn parameter(&self, name: &str) -> Ident {
        let known = rust_name(name);
        if !self.prefix.is_empty() {
            return format_ident!("{}{}", self.prefix, known, span = Span::mixed_site());
        }
        if is_constructor(&known) || self.values.find(&*known).is_some() {
            return format_ident!("{}", self.free(known.into_owned()));
        }
        ident(name)
    }

    /// The name, with as many `_` after it as make it different from all names of the source.
    fn free(&self, mut name: String) -> String {
        while [&self.taken, &self.values].iter().any(|names| names.find(&name).is_some()) {
            name.push('_');
        }
        name
    }
}
