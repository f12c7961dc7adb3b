//! The macros of the crate `tltl`, which re-exports and documents them.
//!
//! Everything happens in the compiler; this crate only turns tokens into text and errors back into
//! tokens. It reads no clock, writes no file and runs no program.

mod expand;
mod tokens;

use proc_macro::TokenStream;

/// Compiles a formula, or declarations of predicates and tasks, at build time.
///
/// **A formula** is an expression whose value is a `tltl::Task`. Names in it are anything in scope
/// that is a predicate: a function `Fn(&S) -> f64` that gives the robustness, a
/// `tltl::Boolean`, a value of a type of yours that implements `tltl::Predicate<S>`.
///
/// ```text
/// let task = tltl!{ F a && F b };
/// let task = tltl!{ "◇a ∧ ◇b" };                          // Unicode needs a string literal
/// let task = tltl!{ |s: &Robot| F (1 < s.x < 3) && !a U b };  // a header names the state
/// ```
///
/// **Declarations** are items: for each predicate a function that gives its robustness, for each
/// task a function that returns it.
///
/// ```text
/// tltl!{
///     state s: Robot;
///     predicate dock = 1 < s.x < 3;
///     task visit = F dock;
/// }
/// ```
///
/// `#[factored]` before a formula or a task keeps the parts of a conjunction side by side
/// (`tltl::Factored`), `#[budget(states = …)]` lets its automaton grow, `#![crate = path]` at the
/// very start names the runtime crate if it is not `::tltl`.
///
/// A mistake is underlined where it stands. Procedural macros cannot warn on stable Rust: what
/// `tltlc check` warns of (a formula that always holds, a name that nothing uses, a likely slip in
/// the order of operators) is not reported here.
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
/// The path is relative to the package. The module has the declared types, for each predicate a
/// function that gives its robustness, and for each task a function that returns it; of an
/// automaton in HOA it has one function `task` that takes a predicate for each proposition. It is
/// built anew when the file changes. Mistakes are shown with the file's own line and a caret,
/// inside rustc's message.
#[proc_macro]
pub fn include_tltl(input: TokenStream) -> TokenStream {
    expand::include(input.into()).into()
}
