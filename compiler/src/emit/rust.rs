//! A compiled source as Rust: what `tltl!` and `include_tltl!` expand to.
//!
//! For every predicate one typed robustness function, for every task one function that returns the
//! runtime's `Task` with its `static` automaton. The code names the runtime by an absolute path,
//! allocates nothing and parses nothing; the same source gives the same tokens.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::compile::{Compiled, Factored, Part};
use crate::dfa::Dfa;
use crate::emit::implementation::{Implementation, positional};
pub use crate::emit::predicates::ident as identifier;
use crate::emit::predicates::{Reading, Scope};
use crate::emit::tables as emit;
use crate::predicate::{
    Condition, Enum, Parameter, ParameterType, PredicateId, Scalar, State, Struct, Task, Type,
};
use crate::source::Span;
use crate::tables::{operators, tables};
use crate::unit::Unit;

/// How the code is fitted to the place where it stands.
pub struct Options<'a> {
    /// The path of the runtime crate, absolute.
    pub runtime: TokenStream,
    /// A type of the user's that has the fields of the declared state, to be used in its place.
    pub state: Option<TokenStream>,
    /// The Rust tokens at a place of the source.
    pub host: &'a dyn Fn(Span) -> TokenStream,
}

/// A bare formula as an expression: a `Task` over the predicates that are in scope.
#[must_use]
pub fn expression(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
    let emitter = Emitter::new(compiled, options);
    let runtime = &options.runtime;
    let value = quote! { self };
    let (task, made) = match (compiled.module.tasks.as_slice(), compiled.factored.as_slice()) {
        ([task, ..], _) => (task, emitter.made(task, &compiled.automata[0].dfa, &value)),
        ([], [factored, ..]) => (&factored.task, emitter.made_factored(factored, &value)),
        ([], []) => return TokenStream::new(),
    };
    let Made { kind, statics, result } = made;
    let values = task.predicates.iter().map(|&predicate| emitter.value(predicate));
    let types: Vec<Ident> = (0..task.predicates.len()).map(|i| format_ident!("P{}", i)).collect();
    let operators = operators(&task.spec).len();
    let implementation = positional(&types, &identifier("__TltlPredicates"), runtime, operators);
    quote! {{
        #[derive(Clone, Copy)]
        struct __TltlPredicates<#(#types),*>(#(#types),*);
        #implementation
        impl<#(#types),*> __TltlPredicates<#(#types),*> {
            fn __tltl_task(self) -> #kind<Self> {
                #statics
                #result
            }
        }
        __TltlPredicates(#(#values),*).__tltl_task()
    }}
}

/// A source of declarations as items: the state, the predicates and the tasks.
#[must_use]
pub fn items(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
    let emitter = Emitter::new(compiled, options);
    let module = &compiled.module;
    let enums = module.enums.iter().map(|declared| emitter.enumeration(declared));
    let structs = module.structs.iter().map(|declared| emitter.structure(declared));
    let state = match (&module.state, &options.state) {
        (State::Declared(state), None) => Some(emitter.structure(state)),
        _ => None,
    };
    let predicates = (0..).map(PredicateId).take(module.predicates.len());
    let predicates = predicates
        .filter(|id| module.predicates[id.0 as usize].declared)
        .map(|id| emitter.predicate(id));
    let tasks = module.tasks.iter().zip(&compiled.automata);
    let tasks = tasks.map(|(task, automata)| emitter.task(task, &automata.dfa));
    let factored = compiled.factored.iter().map(|factored| emitter.factored(factored));
    quote! { #(#enums)* #(#structs)* #state #(#predicates)* #(#tasks)* #(#factored)* }
}

/// A task in the making: its type, the statics that it needs, and the expression that is it.
struct Made {
    kind: TokenStream,
    statics: TokenStream,
    result: TokenStream,
}

struct Emitter<'a> {
    compiled: &'a Compiled,
    options: &'a Options<'a>,
    runtime: &'a TokenStream,
    /// The runtime's path as text, for the tables.
    path: String,
}

impl<'a> Emitter<'a> {
    fn new(compiled: &'a Compiled, options: &'a Options<'a>) -> Self {
        let path = options.runtime.to_string().replace(' ', "");
        Self { compiled, options, runtime: &options.runtime, path }
    }

    fn scope(&self) -> Scope<'_> {
        Scope { module: &self.compiled.module, runtime: self.runtime, host: self.options.host }
    }

    /// The type of the state.
    fn state(&self) -> TokenStream {
        match (&self.options.state, &self.compiled.module.state) {
            (Some(state), _) => state.clone(),
            (None, State::Declared(state)) => {
                let name = identifier(&state.name);
                quote! { #name }
            }
            // A header says `&Type`.
            (None, State::Host { ty, .. }) => (self.options.host)(*ty)
                .into_iter()
                .skip_while(|tree| tree.to_string() == "&")
                .collect(),
            (None, State::Free | State::Inferred) => quote! { () },
        }
    }

    /// A predicate of a bare formula as a value: the user's own, or two closures.
    fn value(&self, id: PredicateId) -> TokenStream {
        let module = &self.compiled.module;
        let condition = module.predicates[id.0 as usize].condition;
        if let Condition::Value { span, .. } = module.arena.condition(condition) {
            return (self.options.host)(*span);
        }
        let runtime = self.runtime;
        let (name, state) = (self.scope().state(), self.state());
        let robustness = self.scope().condition(condition, Reading::Robustness);
        let holds = self.scope().condition(condition, Reading::Truth);
        quote! {
            #runtime::private::Closures(
                |#name: &#state| -> ::core::primitive::f64 { #robustness },
                |#name: &#state| {
                    ::core::result::Result::<_, #runtime::robustness::NotANumber>::Ok({ #holds })
                },
            )
        }
    }

    fn predicate(&self, id: PredicateId) -> TokenStream {
        let predicate = &self.compiled.module.predicates[id.0 as usize];
        let (name, runtime) = (identifier(&predicate.name), self.runtime);
        let (s, state) = (self.scope().state(), self.state());
        let robustness = self.scope().condition(predicate.condition, Reading::Robustness);
        let holds = self.scope().condition(predicate.condition, Reading::Truth);
        let mut about = vec![format!("Robustness of the predicate `{}`.", predicate.name)];
        about.extend(self.measures(&predicate.parameters));
        let docs = documentation(&predicate.docs, &about);
        let implementing = format!("The predicate `{}`.", predicate.name);
        let parameters = self.parameters(&predicate.parameters);
        let (names, types) = (&parameters.names, &parameters.types);
        let structure = parameters.structure(&name, &implementing);
        let unpacked = parameters.unpacked();
        quote! {
            #docs
            #[allow(non_snake_case, unused_variables, clippy::all)]
            #[must_use]
            pub fn #name(#s: &#state #(, #names: #types)*) -> ::core::primitive::f64 { #robustness }

            #structure

            impl #runtime::Predicate<#state> for #name {
                #[inline]
                fn robustness(&self, #s: &#state) -> ::core::primitive::f64 {
                    #name(#s #(, self.#names)*)
                }
                #[inline]
                #[allow(unused_variables, clippy::all)]
                fn holds(
                    &self,
                    #s: &#state,
                ) -> ::core::result::Result<::core::primitive::bool, #runtime::robustness::NotANumber> {
                    #unpacked
                    ::core::result::Result::Ok({ #holds })
                }
            }
        }
    }

    fn task(&self, task: &Task, dfa: &Dfa) -> TokenStream {
        let (function, names) = (self.function(task), self.parameters(&task.parameters).names);
        let made = self.made(task, dfa, &quote! { #function { #(#names),* } });
        self.declaration(task, &[format!("`{}`", task.text), sizes(dfa)], made)
    }

    fn factored(&self, factored: &Factored) -> TokenStream {
        let task = &factored.task;
        let (function, names) = (self.function(task), self.parameters(&task.parameters).names);
        let made = self.made_factored(factored, &quote! { #function { #(#names),* } });
        let states: usize = factored.parts.iter().map(|part| part.automata.dfa.len()).sum();
        let size =
            format!("{} parts side by side, {states} states together.", factored.parts.len());
        self.declaration(task, &[format!("`{}`", task.text), size], made)
    }

    fn function(&self, task: &Task) -> Ident {
        identifier(task.name.as_deref().unwrap_or("task"))
    }

    /// The task whose predicates are `value`.
    fn made(&self, task: &Task, dfa: &Dfa, value: &TokenStream) -> Made {
        let runtime = self.runtime;
        let name = task.name.as_deref().unwrap_or(&task.text);
        let formula = emit::formula(&task.spec, &task.text, &self.path);
        let automaton = emit::automaton(&tables(dfa), &self.path);
        Made {
            kind: quote! { #runtime::Task },
            statics: quote! {
                static __TLTL_FORMULA: #runtime::Formula = #formula;
                static __TLTL_AUTOMATON: #runtime::Automaton = #automaton;
            },
            result: quote! {
                #runtime::Task::trusted(
                    #runtime::Shared::from_static(#name),
                    #runtime::Shared::from_static(&__TLTL_FORMULA),
                    #runtime::Shared::from_static(&__TLTL_AUTOMATON),
                    #value,
                )
            },
        }
    }

    /// The factored task whose predicates are `value`.
    fn made_factored(&self, factored: &Factored, value: &TokenStream) -> Made {
        let (runtime, task) = (self.runtime, &factored.task);
        let (name, text) = (task.name.as_deref().unwrap_or(&task.text), &task.text);
        let joint = if factored.joint {
            quote! { None }
        } else {
            quote! { NotSearched }
        };
        Made {
            kind: quote! { #runtime::Factored },
            statics: self.parts(&factored.parts),
            result: quote! {
                #runtime::Factored::trusted(
                    #runtime::Shared::from_static(#name),
                    #runtime::Shared::from_static(#text),
                    #runtime::Shared::from_static(&__TLTL_PARTS),
                    #runtime::factored::JointDeadEnds::#joint,
                    #value,
                )
            },
        }
    }

    /// The statics of a factored task.
    fn parts(&self, parts: &[Part]) -> TokenStream {
        let runtime = self.runtime;
        let count = Literal::usize_unsuffixed(parts.len());
        let parts = parts.iter().map(|part| {
            let formula = emit::formula(&part.task.spec, &part.task.text, &self.path);
            let automaton = emit::automaton(&tables(&part.automata.dfa), &self.path);
            let predicates = part.propositions.iter().map(|&p| Literal::u32_unsuffixed(p));
            quote! {
                #runtime::factored::Part {
                    formula: #formula,
                    automaton: #automaton,
                    predicates: #runtime::Shared::from_static(&[#(#predicates),*]),
                }
            }
        });
        quote! {
            static __TLTL_PARTS: [#runtime::factored::Part; #count] = [#(#parts),*];
        }
    }

    /// The function that returns a task, and the struct that is its predicates.
    fn declaration(&self, task: &Task, about_it: &[String], made: Made) -> TokenStream {
        let Made { kind, statics, result } = made;
        let name = task.name.as_deref().unwrap_or("task");
        let (function, state) = (identifier(name), self.state());
        let parameters = self.parameters(&task.parameters);
        let unpacked = parameters.unpacked();
        let of = |reading| {
            let unpacked = &unpacked;
            let arms = task.predicates.iter().enumerate().map(move |(i, &id)| {
                let place = Literal::usize_unsuffixed(i);
                let code = self.arm(id, reading);
                match unpacked {
                    Some(unpacked) => quote! { #place => { #unpacked #code } },
                    None => quote! { #place => #code },
                }
            });
            quote! { #(#arms,)* }
        };
        let implementation = Implementation {
            runtime: self.runtime,
            generics: TokenStream::new(),
            state,
            argument: self.scope().state(),
            name: quote! { #function },
            robustness: of(Reading::Robustness),
            holds: of(Reading::Truth),
            scratch: operators(&task.spec).len(),
        }
        .tokens();
        let about_it: Vec<_> =
            about_it.iter().cloned().chain(self.measures(&task.parameters)).collect();
        let docs = documentation(&task.docs, &about_it);
        let about = format!("The predicates of the task `{name}`.");
        let declared = parameters.declared();
        let structure = parameters.structure(&function, &about);
        let (called, checks) = self.indices(task);
        quote! {
            #docs
            #[allow(non_snake_case)]
            #called
            #[must_use]
            pub const fn #function(#declared) -> #kind<#function> {
                #statics
                #checks
                #result
            }

            #structure

            #implementation
        }
    }

    /// The assertions that the parameters of a task are within the arrays that they index, and the
    /// attribute that lets a failure be told where the task is made.
    fn indices(&self, task: &Task) -> (TokenStream, TokenStream) {
        let module = &self.compiled.module;
        let mut checks = TokenStream::new();
        for parameter in &task.parameters {
            let name = &parameter.name;
            let Some((length, place)) = module.shortest_array(task, name) else { continue };
            let place = module.display_term(place);
            let message =
                format!("`{name}` is an index of an array of {length} elements: `{place}`");
            let (name, length) = (identifier(name), Literal::u32_unsuffixed(length));
            checks.extend(quote! {
                ::core::assert!((#name as ::core::primitive::usize) < #length, #message);
            });
        }
        match checks.is_empty() {
            true => (checks.clone(), checks),
            false => (quote! { #[track_caller] }, checks),
        }
    }

    /// A predicate within the `match` of a task.
    fn arm(&self, id: PredicateId, reading: Reading) -> TokenStream {
        let predicate = &self.compiled.module.predicates[id.0 as usize];
        let (runtime, s) = (self.runtime, self.scope().state());
        let robust = reading == Reading::Robustness;
        if predicate.declared {
            let name = identifier(&predicate.name);
            return if robust {
                quote! { #name(#s) }
            } else {
                quote! { #runtime::Predicate::holds(&#name {}, #s) }
            };
        }
        let code = self.scope().condition(predicate.condition, reading);
        if robust {
            quote! { { #code } }
        } else {
            quote! { ::core::result::Result::Ok({ #code }) }
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
    fn measures(&self, parameters: &[Parameter]) -> impl Iterator<Item = String> {
        let units = parameters.iter().filter_map(|known| Some((&known.name, known.unit.as_ref()?)));
        units.map(|(name, unit)| self.measured(&format!("`{name}` is"), unit))
    }

    fn structure(&self, declared: &Struct) -> TokenStream {
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

    fn enumeration(&self, declared: &Enum) -> TokenStream {
        let name = identifier(&declared.name);
        let docs = documentation(&declared.docs, &[]);
        let variants: Vec<_> = declared.variants.iter().map(|name| identifier(name)).collect();
        let count = Literal::usize_unsuffixed(variants.len());
        quote! {
            #docs
            #[allow(missing_docs, non_camel_case_types)]
            #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
            pub enum #name { #(#variants,)* }

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

    /// What a predicate or a task takes, as Rust has it.
    fn parameters(&self, parameters: &[Parameter]) -> Parameters {
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
}

/// The parameters of a predicate or a task.
struct Parameters {
    names: Vec<Ident>,
    types: Vec<TokenStream>,
    /// Whether the types are known to implement `Debug`.
    printable: bool,
}

impl Parameters {
    /// `a: A, b: B`
    fn declared(&self) -> TokenStream {
        let Self { names, types, .. } = self;
        quote! { #(#names: #types),* }
    }

    /// The struct `name` that holds them.
    fn structure(&self, name: &Ident, about: &str) -> TokenStream {
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
    fn unpacked(&self) -> Option<TokenStream> {
        let names = &self.names;
        (!names.is_empty()).then(|| quote! { let Self { #(#names),* } = *self; })
    }
}

/// Doc attributes: the author's lines, then the tool's, each a paragraph.
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
