//! The types that a source declares, as Rust: the state, structs, enumerations, and the parameters
//! of predicates and tasks.
//!
//! All of them are `Copy` and plain: public fields, no constructor, so that a program makes a state
//! as it makes any struct of its own. Documentation is the author's, followed by what the source
//! knows beyond the type (the unit of a field, the size of an automaton).
//!
//! ```
//! use quote::quote;
//! use tltl_compiler::emit::rust::{Options, Place, code};
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let text = "enum Room { hall, attic }
//! /// A robot.
//! state Robot { at: Room, speed: f64 in m/s }
//! task up = F at == attic";
//! let compiled = compile::file(&Source::new("robot.tltl", text), Budget::EMITTED)?;
//! let options =
//!     Options { runtime: quote! { ::tltl }, state: None, host: &|_| quote! {}, place: Place::File };
//! let rust = code(&compiled, &options).to_string();
//! assert!(rust.contains("pub enum Room") && rust.contains("pub struct Robot"));
//! assert!(rust.contains("in m/s"), "the unit is in the docs of the field");
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use crate::dfa::Dfa;
use crate::emit::names::{Place, ident};
use crate::emit::rust::Emitter;
use crate::predicate::{Enum, Parameter, ParameterType, Scalar, Struct, Type};
use crate::source::visible;
use crate::unit::Unit;

impl Emitter<'_> {
    /// The sentence about a unit; it starts with `subject`.
    fn measured(&self, subject: &str, unit: &Unit) -> String {
        match unit.is_plain() {
            true => format!("{subject} a plain number."),
            false => format!("{subject} in {}.", self.compiled.module.units.text(unit)),
        }
    }

    /// The units of the parameters, a paragraph each.
    pub(super) fn measures(&self, parameters: &[Parameter]) -> impl Iterator<Item = String> {
        let units = parameters.iter().filter_map(|known| Some((&known.name, known.unit.as_ref()?)));
        units.map(|(name, unit)| self.measured(&format!("`{name}` is"), unit))
    }

    /// A struct of the source, or the state: fields with their units in the docs.
    pub(super) fn structure(&self, declared: &Struct) -> TokenStream {
        let (name, lints) = (ident(&declared.name), self.options.place.lints());
        let docs = self.described(&declared.docs, &declared.name, &[]);
        let fields = declared.fields.iter().map(|field| {
            let unit: Vec<_> = field.unit.iter().map(|unit| self.measured("It is", unit)).collect();
            let docs = self.described(&field.docs, &field.name, &unit);
            let (name, ty) = (ident(&field.name), self.ty(&field.ty));
            quote! { #docs pub #name: #ty }
        });
        let derive = derive(&["clone::Clone", "marker::Copy", "fmt::Debug", "cmp::PartialEq"]);
        quote! {
            #docs
            #lints
            #derive
            pub struct #name { #(#fields,)* }
        }
    }

    /// An enumeration of the source. A world needs to number its states, so it has all values and
    /// the index of each. These are `const`, so that an array can be as long as an enumeration.
    pub(super) fn enumeration(&self, declared: &Enum) -> TokenStream {
        let (name, lints) = (ident(&declared.name), self.options.place.lints());
        let docs = self.described(&declared.docs, &declared.name, &[]);
        let variants: Vec<_> = declared.variants.iter().map(|name| ident(name)).collect();
        let values = declared.variants.iter().map(|name| self.described(&[], name, &[]));
        let derive = derive(&[
            "clone::Clone",
            "marker::Copy",
            "fmt::Debug",
            "cmp::PartialEq",
            "cmp::Eq",
            "hash::Hash",
            "cmp::PartialOrd",
            "cmp::Ord",
        ]);
        let methods = self.numbering(declared, &variants);
        quote! {
            #docs
            #lints
            #derive
            pub enum #name { #(#values #variants,)* }

            #lints
            impl #name { #methods }
        }
    }

    /// The constant and the methods that number the values of an enumeration. A value that is
    /// called `ALL` takes the place of the constant.
    fn numbering(&self, declared: &Enum, variants: &[Ident]) -> TokenStream {
        let (count, index) =
            (Literal::usize_unsuffixed(variants.len()), self.scope.names.local("index"));
        let all = quote! { [#(Self::#variants,)*] };
        let listed = (!declared.variants.iter().any(|name| name == "ALL")).then(|| {
            quote! {
                #[doc = " All values, in order."]
                pub const ALL: [Self; #count] = #all;
            }
        });
        quote! {
            #listed

            #[doc = " Which value it is, counted from 0."]
            #[must_use]
            pub const fn index(self) -> ::core::primitive::usize {
                self as ::core::primitive::usize
            }

            #[doc = " The value of this index, if there is one."]
            #[must_use]
            pub const fn from_index(
                #index: ::core::primitive::usize,
            ) -> ::core::option::Option<Self> {
                if #index < #count {
                    ::core::option::Option::Some(#all[#index])
                } else {
                    ::core::option::Option::None
                }
            }
        }
    }

    /// The documentation of something called `name`. In a macro everything gets some, because the
    /// author's crate may deny missing docs.
    fn described(&self, docs: &[String], name: &str, paragraphs: &[String]) -> TokenStream {
        let named = (docs.is_empty() && self.options.place != Place::File)
            .then(|| vec![format!("`{name}`")]);
        documentation(named.as_deref().unwrap_or(docs), paragraphs)
    }

    /// The Rust type of a number, a truth value or a value of an enumeration.
    fn scalar(&self, scalar: Scalar) -> TokenStream {
        match scalar {
            Scalar::Enum { of, optional } => {
                let name = ident(&self.compiled.module.enums[of as usize].name);
                match optional {
                    true => quote! { ::core::option::Option<#name> },
                    false => quote! { #name },
                }
            }
            Scalar::Number(_) | Scalar::Bool => {
                let name = ident(scalar.name());
                quote! { ::core::primitive::#name }
            }
        }
    }

    /// The parameters of a predicate or a task, as names and types of Rust.
    pub(super) fn parameters(&self, parameters: &[Parameter]) -> Parameters {
        let ty = |parameter: &Parameter| match parameter.ty {
            ParameterType::Scalar(scalar) => self.scalar(scalar),
            ParameterType::Host(span) => (self.options.host)(span),
        };
        let of_rust = |parameter: &Parameter| matches!(parameter.ty, ParameterType::Host(_));
        let names = || parameters.iter().map(|parameter| parameter.name.as_str());
        let docs = |parameter: &Parameter| self.described(&[], &parameter.name, &[]);
        Parameters {
            docs: parameters.iter().map(docs).collect(),
            fields: names().map(ident).collect(),
            names: names().map(|name| self.scope.names.parameter(name)).collect(),
            types: parameters.iter().map(ty).collect(),
            printable: !parameters.iter().any(of_rust),
        }
    }

    /// The Rust type of a field. Arrays have the length that the source gives: a state is `Copy`
    /// and lies in one piece.
    fn ty(&self, ty: &Type) -> TokenStream {
        let module = &self.compiled.module;
        match ty {
            Type::Scalar(scalar) => self.scalar(*scalar),
            Type::Table(element, of) => {
                let length = module.enums[*of as usize].variants.len();
                let (element, length) = (self.ty(element), Literal::usize_unsuffixed(length));
                quote! { [#element; #length] }
            }
            Type::Struct(index) => {
                let name = ident(&module.structs[*index as usize].name);
                quote! { #name }
            }
            Type::Array(element, length) => {
                let (element, length) = (self.ty(element), Literal::u32_unsuffixed(*length));
                quote! { [#element; #length] }
            }
        }
    }
}

/// The parameters of a predicate or a task. They are arguments of its function and fields of the
/// struct of the same name.
pub(super) struct Parameters {
    /// The documentation of the fields.
    docs: Vec<TokenStream>,
    /// The names of the fields: the source's own.
    pub(super) fields: Vec<Ident>,
    /// The names of the arguments and of the locals to which the fields are bound.
    names: Vec<Ident>,
    /// The Rust types.
    types: Vec<TokenStream>,
    /// Whether all types are known to implement `Debug`: a type of the host may not.
    printable: bool,
}

impl Parameters {
    /// The arguments of the function: `a: A, b: B`.
    pub(super) fn declared(&self) -> TokenStream {
        let Self { names, types, .. } = self;
        quote! { #(#names: #types),* }
    }

    /// The struct `name` that holds them.
    pub(super) fn structure(&self, name: &Ident, about: &str, lints: &TokenStream) -> TokenStream {
        let Self { docs, fields, types, printable, .. } = self;
        let debug = printable.then_some("fmt::Debug");
        let traits: Vec<_> = ["clone::Clone", "marker::Copy"].into_iter().chain(debug).collect();
        let derive = derive(&traits);
        quote! {
            #[doc = #about]
            #lints
            #derive
            pub struct #name { #(#docs pub #fields: #types),* }
        }
    }

    /// The fields of the struct with their values, in an expression or a pattern: `a, Ok: Ok_`.
    pub(super) fn bound(&self) -> TokenStream {
        let bound = self.fields.iter().zip(&self.names).map(|(field, name)| match field == name {
            true => quote! { #name },
            false => quote! { #field: #name },
        });
        quote! { #(#bound),* }
    }

    /// The statement that brings the fields into scope; `None` if there are none.
    pub(super) fn unpacked(&self) -> Option<TokenStream> {
        let bound = self.bound();
        (!self.names.is_empty()).then(|| quote! { let Self { #bound } = *self; })
    }
}

/// The `derive` attribute for these traits of `core`, by absolute paths.
fn derive(traits: &[&str]) -> TokenStream {
    let paths = traits
        .iter()
        .map(|path| -> TokenStream { format!("::core::{path}").parse().expect("a path") });
    quote! { #[derive(#(#paths),*)] }
}

/// Doc attributes: the author's lines, then what the compiler knows, each a paragraph of its own.
pub(super) fn documentation(lines: &[String], paragraphs: &[String]) -> TokenStream {
    let author = lines.iter().map(|line| format!(" {}", visible(line.trim())));
    let known = |text: &String| [String::new(), format!(" {}", visible(text))];
    let lines = author.chain(paragraphs.iter().flat_map(known));
    let lines = lines.skip_while(String::is_empty);
    quote! { #(#[doc = #lines])* }
}

/// The size of an automaton, as a sentence of its documentation.
///
/// ```
/// use tltl_compiler::{compile, emit::rust::sizes, source::Source, translate::Budget};
///
/// let source = Source::new("formula", "!water U home");
/// let compiled = compile::formula(&source, Budget::EMITTED)?;
/// let text = "Minimal automaton: 3 states, one of them the trap, 2 edges and 3 self-loops.";
/// assert_eq!(sizes(&compiled.automata[0].dfa), text);
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn sizes(dfa: &Dfa) -> String {
    let size = dfa.size();
    let trap = if size.trap { ", one of them the trap" } else { "" };
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let (states, edges) = (count(size.states, "state"), count(size.edges, "edge"));
    let loops = count(size.self_loops, "self-loop");
    format!("Minimal automaton: {states}{trap}, {edges} and {loops}.")
}
