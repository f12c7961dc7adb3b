//! A compiled source as Rust: what `tltl!` and `include_tltl!` expand to.
//!
//! A file becomes items: for every type of the source a Rust type, for every predicate a robustness
//! function and a type that implements `Predicate`, for every task a `const fn` that returns the
//! runtime's `Task`. A bare formula becomes one expression, a block that declares what it needs: its
//! predicates are whatever values are in scope, so their types are inferred, as generic parameters.
//!
//! The code names the runtime and `core` by absolute paths, so that no name of the author's can take
//! their place; it allocates nothing and parses nothing. The same source gives the same tokens.

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::compile::{Compiled, Factored, Part};
use crate::dfa::Dfa;
use crate::emit::declare::documentation;
pub use crate::emit::declare::sizes;
use crate::emit::implementation::{Implementation, positional};
pub use crate::emit::predicates::ident as identifier;
use crate::emit::predicates::{Reading, Scope};
use crate::emit::tables as emit;
use crate::predicate::{Condition, PredicateId, State, Task};
use crate::source::Span;
use crate::tables::{operators, tables};

/// How the code fits the place where it stands.
pub struct Options<'a> {
    /// The path of the runtime crate, absolute: `::tltl`, unless a crate re-exports it.
    pub runtime: TokenStream,
    /// A type of the user's that has the fields of the declared state, which is then not emitted.
    pub state: Option<TokenStream>,
    /// The Rust tokens at a place of the source, for what the source takes from Rust as it is.
    pub host: &'a dyn Fn(Span) -> TokenStream,
}

/// A bare formula as an expression: a `Task` over the predicates that are in scope.
///
/// The task's function is a method of its predicates because only so can its result be named: the
/// types of the predicates may be closures, which have no name. Its tables are statics all the same.
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

/// A source of declarations as items: its types, its predicates, its tasks, each in the order of the
/// source.
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

/// The parts of the code of a task.
struct Made {
    /// Its type without the predicates: `Task` or `Factored`.
    kind: TokenStream,
    /// The tables, as statics.
    statics: TokenStream,
    /// The expression that is the task.
    result: TokenStream,
}

/// What all code of one source is written from.
pub(super) struct Emitter<'a> {
    pub(super) compiled: &'a Compiled,
    pub(super) options: &'a Options<'a>,
    runtime: &'a TokenStream,
    /// The runtime's path as text, for the tables.
    path: String,
}

impl<'a> Emitter<'a> {
    fn new(compiled: &'a Compiled, options: &'a Options<'a>) -> Self {
        let path = options.runtime.to_string().replace(' ', "");
        Self { compiled, options, runtime: &options.runtime, path }
    }

    /// What predicates refer to outside themselves.
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

    /// A predicate of a bare formula as a value: the user's own, or two closures. Of the second, all
    /// types are written out, so that a task whose states are never read is typed as well.
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

    /// A declared predicate: a function that gives its robustness, which authors call, and a type of
    /// the same name that implements `Predicate`, which formulas in Rust refer to.
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

    /// A task of a file.
    fn task(&self, task: &Task, dfa: &Dfa) -> TokenStream {
        let (function, names) = (self.function(task), self.parameters(&task.parameters).names);
        let made = self.made(task, dfa, &quote! { #function { #(#names),* } });
        self.declaration(task, &[format!("`{}`", task.text), sizes(dfa)], made)
    }

    /// A factored task of a file.
    fn factored(&self, factored: &Factored) -> TokenStream {
        let task = &factored.task;
        let (function, names) = (self.function(task), self.parameters(&task.parameters).names);
        let made = self.made_factored(factored, &quote! { #function { #(#names),* } });
        let states: usize = factored.parts.iter().map(|part| part.automata.dfa.len()).sum();
        let size =
            format!("{} parts side by side, {states} states together.", factored.parts.len());
        self.declaration(task, &[format!("`{}`", task.text), size], made)
    }

    /// The name of the function that returns a task, and of the type that is its predicates.
    fn function(&self, task: &Task) -> Ident {
        identifier(named(task))
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

    /// The statics of a factored task: one array of its parts, each with its tables by value.
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

    /// The function that returns a task, and the type that is its predicates.
    fn declaration(&self, task: &Task, about_it: &[String], made: Made) -> TokenStream {
        let Made { kind, statics, result } = made;
        let function = self.function(task);
        let parameters = self.parameters(&task.parameters);
        let about_it: Vec<_> =
            about_it.iter().cloned().chain(self.measures(&task.parameters)).collect();
        let docs = documentation(&task.docs, &about_it);
        let about = format!("The predicates of the task `{}`.", named(task));
        let declared = parameters.declared();
        let structure = parameters.structure(&function, &about);
        let implementation = self.predicates(task, parameters.unpacked());
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

    /// The implementation of the runtime's `Predicates` for the predicates of a task; `unpacked`
    /// brings the task's parameters into scope.
    fn predicates(&self, task: &Task, unpacked: Option<TokenStream>) -> TokenStream {
        let of = |reading| {
            let arms = task.predicates.iter().enumerate().map(|(i, &id)| {
                let place = Literal::usize_unsuffixed(i);
                let code = self.arm(id, reading);
                match &unpacked {
                    Some(unpacked) => quote! { #place => { #unpacked #code } },
                    None => quote! { #place => #code },
                }
            });
            quote! { #(#arms,)* }
        };
        let function = self.function(task);
        Implementation {
            runtime: self.runtime,
            generics: TokenStream::new(),
            state: self.state(),
            argument: self.scope().state(),
            name: quote! { #function },
            robustness: of(Reading::Robustness),
            holds: of(Reading::Truth),
            scratch: operators(&task.spec).len(),
        }
        .tokens()
    }

    /// The assertions that the parameters of a task are within the arrays that they index, and the
    /// attribute by which a failure is reported where the task is made. After them no step of the
    /// task can panic.
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

    /// A predicate within the `match` of a task: a call of a declared one, the condition itself of
    /// another.
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
}

/// What a task is called in Rust; one without a name stands alone in its file.
fn named(task: &Task) -> &str {
    task.name.as_deref().unwrap_or("task")
}
