//! The tables of an automaton and of its formula as Rust: data, not code.
//!
//! A table becomes a constant of the runtime's types over `'static` slices, so a program holds it
//! in its read-only data and does nothing to build it. The runtime trusts tables from here; it
//! checks tables from anywhere else.
//!
//! Tables are written as text and read back by the tokenizer, which in a procedural macro is
//! rustc's own: a token of a table then costs nanoseconds. Built tree by tree in an unoptimized
//! macro it costs microseconds. Few names and flat arrays matter for the same reason: the code of a
//! sequence of 40 steps is 16 KB and 5,600 tokens. With an edge and a guard as a struct each it was
//! 24 KB and 8,300 tokens, and its expansion took half as long again.
//!
//! ```
//! use quote::quote;
//! use tltl_compiler::{compile, emit, source::Source, tables::tables, translate::Budget};
//!
//! let source = Source::new("formula", "F a");
//! let compiled = compile::formula(&source, Budget::EMITTED)?;
//! let code = emit::tables::automaton(&tables(&compiled.automata[0].dfa), &quote! { ::tltl });
//! assert!(code.to_string().contains("states : 2"));
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use std::fmt::{Debug, Write as _};

use proc_macro2::TokenStream;
use quote::quote;

use crate::spec::Spec;
use crate::tables::{Tables, Transitions, operators};

/// The runtime's `Automaton` as an expression; `runtime` is the path of that crate. It is a
/// constant expression: it may stand in a `static`, a `const`, or an array of either.
#[must_use]
pub fn automaton(tables: &Tables, runtime: &TokenStream) -> TokenStream {
    let Tables { states, accepting, trap, .. } = tables;
    let mut text = format!(
        "Tables {{ states: {states}, accepting: ::core::option::Option::{accepting:?}, \
         trap: ::core::option::Option::{trap:?}, "
    );
    names(&mut text, &tables.propositions);
    transitions(&mut text, &tables.transitions);
    table(&mut text, "edges", &tables.edges);
    table(&mut text, "targets", &tables.targets);
    table(&mut text, "guards", &tables.guards);
    table(&mut text, "literals", &tables.literals);
    table(&mut text, "distance", &tables.distance);
    text.push('}');
    let tables = tokens(&text);
    quote! {{
        use #runtime::{Automaton, Shared, automaton::{Tables, Transitions}};
        Automaton::trusted(#tables)
    }}
}

/// The runtime's `Formula` as an expression, with `written` as its text. The operators are those of
/// `spec`, in negation normal form; an [`Operator`](crate::tables::Operator) prints as the
/// runtime's `Op` of the same name.
///
/// ```
/// use quote::quote;
/// use tltl_compiler::{check, emit, source::Source};
///
/// let module = check::formula(&Source::new("formula", "F a"))?;
/// let code = emit::tables::formula(&module.tasks[0].spec, "F a", &quote! { ::tltl }).to_string();
/// assert!(code.contains("Is (0) , Eventually (0)"));
/// # Ok::<(), tltl_compiler::error::Errors>(())
/// ```
#[must_use]
pub fn formula(spec: &Spec, written: &str, runtime: &TokenStream) -> TokenStream {
    let mut text = String::new();
    for operator in operators(spec) {
        let _ = write!(text, "{operator:?}, ");
    }
    let operators = tokens(&text);
    quote! {{
        use #runtime::{Formula, Shared, robustness::Op::*};
        Formula::trusted(Shared::from_static(#written), Shared::from_static(&[#operators]))
    }}
}

/// The names of the propositions.
///
/// A name is a value with a destructor (it could be owned), so a reference to an array of names is
/// promoted to `'static` only inside a constant of its own.
fn names(text: &mut String, names: &[String]) {
    text.push_str("propositions: Shared::from_static(const { &[");
    for name in names {
        let _ = write!(text, "Shared::from_static({name:?}), ");
    }
    text.push_str("] }), ");
}

/// The transition function, as one of the two variants that the runtime has.
fn transitions(text: &mut String, transitions: &Transitions) {
    text.push_str("transitions: Transitions::");
    match transitions {
        Transitions::Table { class, width, next } => {
            let _ = write!(text, "Table {{ width: {width}, ");
            table(text, "class", class);
            table(text, "next", next);
        }
        Transitions::Diagram { nodes, roots } => {
            text.push_str("Diagram { ");
            table(text, "nodes", nodes);
            table(text, "roots", roots);
        }
    }
    text.push_str("}, ");
}

/// One field that is a flat array.
fn table(text: &mut String, field: &str, entries: &[impl Debug]) {
    let _ = write!(text, "{field}: Shared::from_static(&{entries:?}), ");
}

/// The tokens of a text that this module wrote.
fn tokens(text: &str) -> TokenStream {
    text.parse().expect("generated tables are Rust")
}
