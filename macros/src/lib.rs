//! The macros of the crate `tltl`, which re-exports them.
//!
//! The compiler does the work; this crate turns tokens into text for it, and its errors back into
//! tokens. Each macro is one line around a function on `proc_macro2` tokens, which tests call
//! without a compiler around it.
//!
//! The macros read no clock, write no file and run no program. `include_tltl!` reads the file that
//! it names, and nothing else.

mod expand;
mod tokens;

use proc_macro::TokenStream;

/// Compiles a formula, or declarations of predicates and tasks, at build time.
///
/// **A formula** is an expression whose value is a `tltl::Task`. A name in it is anything in scope
/// that is a predicate: a function `Fn(&S) -> f64` that returns the robustness, a `tltl::Boolean`,
/// or a value of a type of yours that implements `tltl::Predicate<S>`.
///
/// ```text
/// let task = tltl!{ F a && F b };
/// let task = tltl!{ "◇a ∧ ◇b" };                          // Unicode needs a string literal
/// let task = tltl!{ |s: &Robot| F (1 < s.x < 3) && !a U b };  // a header names the state
/// ```
///
/// **Declarations** become items: a function for each predicate, which returns its robustness, and
/// a function for each task, which returns the task.
///
/// ```text
/// tltl!{
///     state s: Robot;
///     predicate dock = 1 < s.x < 3;
///     task visit = F dock;
/// }
/// ```
///
/// Three attributes stand before a formula, a task, or the whole input:
///
/// - `#[factored]` keeps the parts of a conjunction side by side (`tltl::Factored`) instead of
///   multiplying their states.
/// - `#[budget(states = …)]` allows a larger automaton than the default, 16,384 states.
/// - `#![crate = path]` at the very start names the runtime crate, if it is not `::tltl`.
///
/// The automaton is data: static tables, with no allocation and no work at run time before the
/// first step.
///
/// # Errors
///
/// A mistake is underlined at the tokens that make it, all mistakes in one build. Procedural macros
/// cannot warn on stable Rust: the warnings of `tltlc check` (a formula that always holds, a name
/// that nothing uses, a probable slip in the order of operators) are not reported here.
///
/// A formula with a mistake expands to a value of the right type beside the error, so that one
/// mistake is one message.
#[proc_macro]
pub fn tltl(input: TokenStream) -> TokenStream {
    expand::inline(input.into()).into()
}

/// Compiles a task file into a module at build time.
///
/// ```text
/// include_tltl!("tasks/gridworld.tltl");                        // pub mod gridworld { … }
/// include_tltl!("tasks/gridworld.tltl", state = world::Cell);   // over a type of yours
/// include_tltl!("tasks/gridworld.tltl", mod = tasks, crate = path::to::tltl);
/// include_tltl!("automata/order.hoa");                          // order::task(first, second); feature `hoa`
/// ```
///
/// The path is relative to the package. The module has the declared types, a function for each
/// predicate, which returns its robustness, and a function for each task, which returns the task.
/// The module of an automaton in HOA has one function, `task`, which takes a predicate for each
/// proposition.
///
/// - `state = Type` reads the fields from a type of yours instead of generating one; it has fields
///   of the same names and types.
/// - `mod = name` names the module; without it the name is that of the file.
/// - `crate = path` names the runtime crate.
///
/// Cargo builds the module anew when the file changes.
///
/// # Errors
///
/// Mistakes are shown inside rustc's message at the path, with the file's own lines and carets.
#[proc_macro]
pub fn include_tltl(input: TokenStream) -> TokenStream {
    expand::include(input.into()).into()
}
