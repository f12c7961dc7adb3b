//! A compiled source as Rust: what `tltl!` and `include_tltl!` expand to.
//!
//! A file becomes items: for every type of the source a Rust type, for every predicate a robustness
//! function and a type that implements `Predicate`, for every task a `const fn` that returns the
//! runtime's `Task`. A bare formula becomes one expression that declares what it needs. Its
//! predicates are whatever values are in scope, so their types are inferred, as generic parameters.
//!
//! The code names the runtime and `core` by absolute paths, so that no name of the author's can
//! take their place; it allocates nothing and parses nothing. The same source gives the same
//! tokens.
//!
//! An item has no hygiene: within its block it hides the author's names. So each generated item
//! that the source does not declare stands in a block without code or names of the author's.
//!
//! ```
//! use quote::quote;
//! use tltl_compiler::emit::rust::{Options, Place, code};
//! use tltl_compiler::{compile, source::Source, translate::Budget};
//!
//! let text = "state Cell { x: i32 }\npredicate home = x == 0\ntask back = F home\n";
//! let compiled = compile::file(&Source::new("cell.tltl", text), Budget::EMITTED)?;
//! let options =
//!     Options { runtime: quote! { ::tltl }, state: None, host: &|_| quote! {}, place: Place::File };
//! let rust = code(&compiled, &options).to_string();
//! assert!(rust.contains("pub struct Cell"));
//! assert!(rust.contains("pub const fn back () -> :: tltl :: Task < back >"));
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use crate::compile::{Compiled, Factored, Part};
use crate::dfa::Dfa;
pub use crate::emit::declare::sizes;
use crate::emit::declare::{Parameters, documentation};
use crate::emit::implementation::{Implementation, Robust, TOGETHER, dense, positional};
use crate::emit::names::{Names, ident};
pub use crate::emit::names::{Place, module as module_name};
use crate::emit::predicates::{Compared, Reading, Scope};
use crate::emit::tables as emit;
use crate::predicate::{Condition, Predicate, PredicateId, State, Task};
use crate::source::Span;
use crate::tables::{Tables, tables};

/// Settings that fit the code to its surroundings.
pub struct Options<'a> {
    /// The path of the runtime crate, absolute: `::tltl`, unless a crate re-exports it.
    pub runtime: TokenStream,
    /// A type of the user's with the fields of the declared state, which is then not emitted.
    pub state: Option<TokenStream>,
    /// The Rust tokens at a place of the source, for the parts that the source takes from Rust
    /// verbatim.
    pub host: &'a dyn Fn(Span) -> TokenStream,
    /// The place in which the code stands.
    pub place: Place,
}

/// A compiled source as Rust: a bare formula as an expression, declarations as items.
#[must_use]
pub fn code(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
    if is_bare(compiled) { expression(compiled, options) } else { items(compiled, options) }
}

/// Whether a source is a bare formula: its task has no name.
///
/// ```
/// use tltl_compiler::{compile, emit::rust::is_bare, source::Source, translate::Budget};
///
/// let [bare, declared] = ["F a", "task go = F a"].map(|text| {
///     compile::fragment(&Source::new("macro", text), Budget::EMITTED).unwrap()
/// });
/// assert!(is_bare(&bare) && !is_bare(&declared));
/// ```
#[must_use]
pub fn is_bare(compiled: &Compiled) -> bool {
    let factored = compiled.factored.iter().map(|factored| &factored.task);
    let mut tasks = compiled.module.tasks.iter().chain(factored);
    tasks.next().is_some_and(|task| task.name.is_none())
}

/// A bare formula as an expression: a `Task` over the predicates that are in scope.
///
/// The function that makes the task is a method of its predicates, because only there can its
/// result be named: the predicates may be closures, whose types have no name. Its tables are
/// statics all the same. The predicates are arguments of the block that declares all this, because
/// inside it they could be hidden.
fn expression(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
    let emitter = Emitter::new(compiled, options);
    let runtime = &options.runtime;
    let value = quote! { self };
    let (task, made) = match (compiled.module.tasks.as_slice(), compiled.factored.as_slice()) {
        ([task, ..], _) => (task, emitter.made(task, &compiled.automata[0].dfa, &value)),
        ([], [factored, ..]) => (&factored.task, emitter.made_factored(factored, &value)),
        ([], []) => return TokenStream::new(),
    };
    let Made { kind, result, robust, dense } = made;
    let values = task.predicates.iter().map(|&predicate| emitter.value(predicate));
    let types: Vec<Ident> = (0..task.predicates.len()).map(|i| format_ident!("__P{}", i)).collect();
    let name = ident("__Predicates");
    let names = &emitter.scope.names;
    let implementation = positional(&types, &name, runtime, names, robust, dense);
    quote! {
        ({
            #[derive(::core::clone::Clone, ::core::marker::Copy)]
            struct #name<#(#types),*>(#(#types),*);
            #implementation
            impl<#(#types),*> #name<#(#types),*> {
                fn task(self) -> #kind<Self> {
                    #result
                }
            }
            #name
        })(#(#values),*).task()
    }
}

/// A source of declarations as items: the state, the predicates and the tasks.
fn items(compiled: &Compiled, options: &Options<'_>) -> TokenStream {
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

/// A task as code.
struct Made {
    /// Its type without the predicates: `Task` or `Factored`.
    kind: TokenStream,
    /// The expression that makes it.
    result: TokenStream,
    /// How the robustness of its trajectories is computed.
    robust: Robust,
    /// The number of predicates, if a step reads all of them; otherwise 0.
    dense: usize,
}

/// The inputs of all code of one source.
pub(super) struct Emitter<'a> {
    pub(super) compiled: &'a Compiled,
    pub(super) options: &'a Options<'a>,
    /// The path of the runtime crate.
    runtime: &'a TokenStream,
    /// The surroundings of the predicates' code.
    pub(super) scope: Scope<'a>,
}

impl<'a> Emitter<'a> {
    /// The emitter of a compiled source.
    fn new(compiled: &'a Compiled, options: &'a Options<'a>) -> Self {
        let names = Names::new(compiled, options.place);
        let scope = Scope::new(&compiled.module, options.runtime.clone(), options.host, names);
        Self { compiled, options, runtime: &options.runtime, scope }
    }

    /// The type of the state.
    fn state(&self) -> TokenStream {
        match (&self.options.state, &self.compiled.module.state) {
            (Some(state), _) => state.clone(),
            (None, State::Declared(state)) => {
                let name = ident(&state.name);
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

    /// A predicate of a bare formula as a value: the user's own, or two closures. The closures have
    /// all types written out, so that a task whose states are never read is typed as well.
    fn value(&self, id: PredicateId) -> TokenStream {
        let module = &self.compiled.module;
        let condition = module.predicates[id.0 as usize].condition;
        if let Condition::Value { span, .. } = module.arena.condition(condition) {
            return self.scope.rust(*span);
        }
        let runtime = self.runtime;
        let (s, state) = (self.scope.argument(), self.state());
        let robustness = self.scope.condition(condition, Reading::Robustness);
        let holds = self.scope.condition(condition, Reading::Truth);
        quote! {
            #runtime::private::Closures(
                |#s: &#state| -> ::core::primitive::f64 { #robustness },
                |#s: &#state| {
                    ::core::result::Result::<_, #runtime::robustness::NotANumber>::Ok({ #holds })
                },
            )
        }
    }

    /// A declared predicate: a function that gives its robustness, which authors call, and a type
    /// of the same name that implements `Predicate`, which formulas in Rust refer to.
    fn predicate(&self, id: PredicateId) -> TokenStream {
        let predicate = &self.compiled.module.predicates[id.0 as usize];
        let (name, lints) = (ident(&predicate.name), self.options.place.lints());
        let (s, state) = (self.scope.argument(), self.state());
        let robustness = self.scope.condition(predicate.condition, Reading::Robustness);
        let mut about = vec![format!("Robustness of the predicate `{}`.", predicate.name)];
        about.extend(self.measures(&predicate.parameters));
        let docs = documentation(&predicate.docs, &about);
        let parameters = self.parameters(&predicate.parameters);
        let declared = parameters.declared();
        let implementing = format!(" The predicate `{}`.", predicate.name);
        let structure = parameters.structure(&name, &implementing, &lints);
        let implementation = self.implementation(predicate, &parameters);
        quote! {
            #docs
            #lints
            #[must_use]
            pub fn #name(#s: &#state, #declared) -> ::core::primitive::f64 { #robustness }

            #structure

            #implementation
        }
    }

    /// The implementation of the runtime's `Predicate` for the struct of a predicate.
    fn implementation(&self, predicate: &Predicate, parameters: &Parameters) -> TokenStream {
        let (runtime, lints) = (self.runtime, self.options.place.lints());
        let (name, state) = (ident(&predicate.name), self.state());
        let (argument, s) = (self.scope.argument(), &self.scope.state);
        let holds = self.scope.condition(predicate.condition, Reading::Truth);
        let (fields, unpacked) = (&parameters.fields, parameters.unpacked());
        quote! {
            #lints
            impl #runtime::Predicate<#state> for #name {
                #[inline]
                fn robustness(&self, #argument: &#state) -> ::core::primitive::f64 {
                    #name(#s #(, self.#fields)*)
                }
                #[inline]
                fn holds(
                    &self,
                    #argument: &#state,
                ) -> ::core::result::Result<::core::primitive::bool, #runtime::robustness::NotANumber> {
                    #unpacked
                    ::core::result::Result::Ok({ #holds })
                }
            }
        }
    }

    /// A task of a file.
    fn task(&self, task: &Task, dfa: &Dfa) -> TokenStream {
        let made = self.made(task, dfa, &self.packed(task));
        self.declaration(task, &[format!("`{}`", task.text), sizes(dfa)], made)
    }

    /// A factored task of a file.
    fn factored(&self, factored: &Factored) -> TokenStream {
        let task = &factored.task;
        let made = self.made_factored(factored, &self.packed(task));
        let states: usize = factored.parts.iter().map(|part| part.automata.dfa.len()).sum();
        let size =
            format!("{} parts side by side, {states} states together.", factored.parts.len());
        self.declaration(task, &[format!("`{}`", task.text), size], made)
    }

    /// The struct of a task's predicates, made of the arguments of the function.
    fn packed(&self, task: &Task) -> TokenStream {
        let (function, fields) = (function(task), self.parameters(&task.parameters).bound());
        quote! { #function { #fields } }
    }

    /// The task whose predicates are `value`.
    fn made(&self, task: &Task, dfa: &Dfa, value: &TokenStream) -> Made {
        let runtime = self.runtime;
        let name = task.name.as_deref().unwrap_or(&task.text);
        let formula = emit::formula(&task.spec, &task.text, runtime);
        let tables = tables(dfa);
        let automaton = emit::automaton(&tables, runtime);
        Made {
            dense: dense(&tables),
            robust: Robust::of(&task.spec, runtime),
            kind: quote! { #runtime::Task },
            result: quote! {
                #runtime::Task::trusted(
                    #runtime::Shared::from_static(#name),
                    #runtime::Shared::from_static({
                        static FORMULA: #runtime::Formula = #formula;
                        &FORMULA
                    }),
                    #runtime::Shared::from_static({
                        static AUTOMATON: #runtime::Automaton = #automaton;
                        &AUTOMATON
                    }),
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
        let count = Literal::usize_unsuffixed(factored.parts.len());
        let all: Vec<Tables> =
            factored.parts.iter().map(|part| tables(&part.automata.dfa)).collect();
        let parts = factored.parts.iter().zip(&all).map(|(part, tables)| self.part(part, tables));
        let are_tables = all.iter().all(|tables| dense(tables) > 0);
        let is_dense = are_tables && task.predicates.len() <= TOGETHER;
        Made {
            robust: Robust::interpreted(&task.spec),
            dense: if is_dense { task.predicates.len() } else { 0 },
            kind: quote! { #runtime::Factored },
            result: quote! {
                #runtime::Factored::trusted(
                    #runtime::Shared::from_static(#name),
                    #runtime::Shared::from_static(#text),
                    #runtime::Shared::from_static({
                        static PARTS: [#runtime::factored::Part; #count] = [#(#parts),*];
                        &PARTS
                    }),
                    #runtime::factored::JointDeadEnds::#joint,
                    #value,
                )
            },
        }
    }

    /// A part of a factored task, as a constant.
    fn part(&self, part: &Part, tables: &Tables) -> TokenStream {
        let runtime = self.runtime;
        let formula = emit::formula(&part.task.spec, &part.task.text, runtime);
        let automaton = emit::automaton(tables, runtime);
        let predicates = part.propositions.iter().map(|&p| Literal::u32_unsuffixed(p));
        quote! {
            #runtime::factored::Part {
                formula: #formula,
                automaton: #automaton,
                predicates: #runtime::Shared::from_static(&[#(#predicates),*]),
            }
        }
    }

    /// The function that returns a task, and the struct of its predicates, which has the same name.
    fn declaration(&self, task: &Task, about_it: &[String], made: Made) -> TokenStream {
        let Made { kind, result, robust, dense } = made;
        let (function, lints) = (function(task), self.options.place.lints());
        let parameters = self.parameters(&task.parameters);
        let about_it: Vec<_> =
            about_it.iter().cloned().chain(self.measures(&task.parameters)).collect();
        let docs = documentation(&task.docs, &about_it);
        let about = format!(" The predicates of the task `{}`.", named(task));
        let declared = parameters.declared();
        let structure = parameters.structure(&function, &about, &lints);
        let implementation = self.predicates(task, (robust, dense), &parameters);
        let (called, checks) = self.indices(task);
        quote! {
            #docs
            #lints
            #called
            #[must_use]
            pub const fn #function(#declared) -> #kind<#function> {
                #checks
                #result
            }

            #structure

            #implementation
        }
    }

    /// The implementation of the runtime's `Predicates` for the predicates of a task.
    fn predicates(
        &self,
        task: &Task,
        (robust, dense): (Robust, usize),
        parameters: &Parameters,
    ) -> TokenStream {
        let (function, unpacked) = (function(task), parameters.unpacked());
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
        let state = self.state();
        let floats = (dense > 0).then(|| self.floats(task, &state)).flatten();
        Implementation {
            runtime: self.runtime,
            names: &self.scope.names,
            lints: self.options.place.lints(),
            generics: TokenStream::new(),
            types: &[],
            state,
            argument: self.scope.argument(),
            name: quote! { #function },
            robustness: of(Reading::Robustness),
            holds: of(Reading::Truth),
            robust,
            dense,
            floats,
        }
        .tokens()
    }

    /// Whether all predicates of a task compare floats, as an expression; `None` if one does not.
    fn floats(&self, task: &Task, state: &TokenStream) -> Option<TokenStream> {
        let mut places = Vec::new();
        for predicate in &task.predicates {
            let condition = self.compiled.module.predicates[predicate.0 as usize].condition;
            match self.scope.compared(condition) {
                Compared::Floats(of_one) => places.extend(of_one),
                Compared::Others => return None,
            }
        }
        places.sort_unstable();
        places.dedup();
        Some(self.scope.are_floats(&places, state))
    }

    /// The assertions that the parameters of a task are within the arrays that they index, and the
    /// attribute by which a failure is reported where the task is made. After them, no step of the
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
            let name = self.scope.names.parameter(name);
            let length = Literal::u32_unsuffixed(length);
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
        let (runtime, s) = (self.runtime, &self.scope.state);
        let robust = reading == Reading::Robustness;
        if predicate.declared {
            let name = ident(&predicate.name);
            return if robust {
                quote! { #name(#s) }
            } else {
                quote! { #runtime::Predicate::holds(&#name {}, #s) }
            };
        }
        let code = self.scope.condition(predicate.condition, reading);
        if robust {
            quote! { { #code } }
        } else {
            quote! { ::core::result::Result::Ok({ #code }) }
        }
    }
}

/// The name of a task in Rust; a task without one stands alone in its file.
fn named(task: &Task) -> &str {
    task.name.as_deref().unwrap_or("task")
}

/// The name of the function that returns a task and of the struct of its predicates.
fn function(task: &Task) -> Ident {
    ident(named(task))
}
