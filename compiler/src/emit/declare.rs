//! The types that a source declares, as Rust: the state, structs, enumerations, and what predicates
//! and tasks take.
//!
//! All of them are `Copy` and plain: public fields, no constructor, so that a program makes a state as
//! it makes any struct of its own. Documentation is the author's, followed by what the source knows
//! beyond the type (the unit of a field, the size of an automaton).

use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;

use crate::dfa::Dfa;
use crate::emit::predicates::ident as identifier;
use crate::emit::rust::Emitter;
use crate::predicate::{Enum, Parameter, ParameterType, Scalar, Struct, Type};
use crate::unit::Unit;

impl Emitter<'_> {
    /// A struct of the source, or the state: fields with their units in the docs.
    pub(super) fn structure(&self, declared: &Struct) -> TokenStream {
        let name = identifier(&declared.name);
        let docs = documentation(&declared.docs, &[]);
        let fields = declared.fields.iter().map(|field| {
            let unit: Vec<_> = field.unit.iter().map(|unit| self.measured("It is", unit)).collect();
            let docs = documentation(&field.docs, &unit);
            let (name, ty) = (identifier(&field.name), self.ty(&field.ty));
            quote! { #docs pub #name: #ty }
        });
        quote! {
            #docs
            #[allow(missing_docs, non_snake_case, non_camel_case_types)]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name { #(#fields,)* }
        }
    }

    /// An enumeration of the source, with what a world needs to number its states: all values, and the
    /// number of each. These are `const`, so that arrays can be as long as an enumeration.
    pub(super) fn enumeration(&self, declared: &Enum) -> TokenStream {
        let name = identifier(&declared.name);
        let docs = documentation(&declared.docs, &[]);
        let variants: Vec<_> = declared.variants.iter().map(|name| identifier(name)).collect();
        let functions = numbers(&name, &variants);
        quote! {
            #docs
            #[allow(missing_docs, non_camel_case_types)]
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub enum #name { #(#variants,)* }

            #functions
        }
    }

    /// The Rust type of a field. Arrays have the length that the source says: a state is `Copy` and lies
    /// in one piece.
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
                let name = identifier(&module.structs[*index as usize].name);
                quote! { #name }
            }
            Type::Array(element, length) => {
                let (element, length) = (self.ty(element), Literal::u32_unsuffixed(*length));
                quote! { [#element; #length] }
            }
        }
    }

    /// The Rust type of a number, a truth value or a value of an enumeration.
    fn scalar(&self, scalar: Scalar) -> TokenStream {
        match scalar {
            Scalar::Enum { of, optional } => {
                let name = identifier(&self.compiled.module.enums[of as usize].name);
                match optional {
                    true => quote! { ::core::option::Option<#name> },
                    false => quote! { #name },
                }
            }
            Scalar::Number(_) | Scalar::Bool => {
                let name = identifier(scalar.name());
                quote! { ::core::primitive::#name }
            }
        }
    }

    /// What a predicate or a task takes, as names and types of Rust.
    pub(super) fn parameters(&self, parameters: &[Parameter]) -> Parameters {
        let ty = |parameter: &Parameter| match parameter.ty {
            ParameterType::Scalar(scalar) => self.scalar(scalar),
            ParameterType::Host(span) => (self.options.host)(span),
        };
        let of_rust = |parameter: &Parameter| matches!(parameter.ty, ParameterType::Host(_));
        Parameters {
            names: parameters.iter().map(|parameter| identifier(&parameter.name)).collect(),
            types: parameters.iter().map(ty).collect(),
            printable: !parameters.iter().any(of_rust),
        }
    }

    /// What something is measured in, as a sentence that starts with `subject`.
    fn measured(&self, subject: &str, unit: &Unit) -> String {
        match unit.is_plain() {
            true => format!("{subject} a plain number."),
            false => format!("{subject} in {}.", self.compiled.module.units.text(unit)),
        }
    }

    /// What the parameters are measured in, a paragraph each.
    pub(super) fn measures(&self, parameters: &[Parameter]) -> impl Iterator<Item = String> {
        let units = parameters.iter().filter_map(|known| Some((&known.name, known.unit.as_ref()?)));
        units.map(|(name, unit)| self.measured(&format!("`{name}` is"), unit))
    }
}

/// The parameters of a predicate or a task: of one, they are arguments of a function and fields of the
/// struct of the same name.
pub(super) struct Parameters {
    pub(super) names: Vec<Ident>,
    pub(super) types: Vec<TokenStream>,
    /// Whether the types are known to implement `Debug`: a type of the host may not.
    printable: bool,
}

impl Parameters {
    /// `a: A, b: B`
    pub(super) fn declared(&self) -> TokenStream {
        let Self { names, types, .. } = self;
        quote! { #(#names: #types),* }
    }

    /// The struct `name` that holds them.
    pub(super) fn structure(&self, name: &Ident, about: &str) -> TokenStream {
        let Self { names, types, printable } = self;
        let derive = match printable {
            true => quote! { #[derive(Clone, Copy, Debug)] },
            false => quote! { #[derive(Clone, Copy)] },
        };
        quote! {
            #[doc = #about]
            #[allow(missing_docs, non_camel_case_types)]
            #derive
            pub struct #name { #(pub #names: #types),* }
        }
    }

    /// The statement that brings the fields into scope; none if there are none.
    pub(super) fn unpacked(&self) -> Option<TokenStream> {
        let names = &self.names;
        (!names.is_empty()).then(|| quote! { let Self { #(#names),* } = *self; })
    }
}

/// The functions of an enumeration from its values to numbers and back.
fn numbers(name: &Ident, variants: &[Ident]) -> TokenStream {
    let count = Literal::usize_unsuffixed(variants.len());
    quote! {
        #[allow(clippy::all)]
        impl #name {
            #[doc = " All values, in order."]
            pub const ALL: [Self; #count] = [#(Self::#variants,)*];

            #[doc = " Which value it is, counted from 0."]
            #[must_use]
            pub const fn index(self) -> ::core::primitive::usize {
                self as ::core::primitive::usize
            }

            #[doc = " The value of this index, if there is one."]
            #[must_use]
            pub const fn from_index(
                index: ::core::primitive::usize,
            ) -> ::core::option::Option<Self> {
                if index < #count {
                    ::core::option::Option::Some(Self::ALL[index])
                } else {
                    ::core::option::Option::None
                }
            }
        }
    }
}

/// Doc attributes: the author's lines, then what the compiler knows, each a paragraph of its own.
pub(super) fn documentation(lines: &[String], paragraphs: &[String]) -> TokenStream {
    let author = lines.iter().map(|line| format!(" {}", line.trim()));
    let lines =
        author.chain(paragraphs.iter().flat_map(|text| [String::new(), format!(" {text}")]));
    let lines = lines.skip_while(String::is_empty);
    quote! { #(#[doc = #lines])* }
}

/// The size of an automaton, as a sentence of its documentation.
#[must_use]
pub fn sizes(dfa: &Dfa) -> String {
    let size = dfa.size();
    let trap = if size.trap { ", one of them the trap" } else { "" };
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    let (states, edges) = (count(size.states, "state"), count(size.edges, "edge"));
    let loops = count(size.self_loops, "self-loop");
    format!("Minimal automaton: {states}{trap}, {edges} and {loops}.")
}
