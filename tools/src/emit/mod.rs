//! Automata in the forms that people and other tools read, and saved policies as Rust: one module
//! for each form.
//!
//! | module | form | for |
//! | --- | --- | --- |
//! | [`text`] | a table | a terminal |
//! | [`svg`] | a picture | documents; drawn here, without Graphviz |
//! | [`dot`], [`mermaid`] | graphs in text | Graphviz; Markdown on GitHub and elsewhere |
//! | [`hoa`] | Hanoi Omega-Automata | Spot, Owl and other tools for automata |
//! | [`json`] | JSON | programs and editors |
//! | [`mod@rust`] | Rust | a reader who wants to see what a macro generates |
//! | [`c`] | a C99 header | firmware, and ROS 2 nodes in C++ |
//! | [`policy`], [`network`] | Rust that stands alone | a robot without an allocator |
//!
//! [`sum`] prints the guards for all of them, [`labels`] those of all edges in one go. Every function depends on its arguments alone: the
//! same automaton gives the same bytes. Guards are exact in every form; only the picture moves long
//! ones into a legend.

pub mod c;
pub mod dot;
pub mod hoa;
pub mod json;
pub mod labels;
mod layout;
pub mod mermaid;
pub mod network;
pub mod policy;
pub mod rust;
pub mod sum;
pub mod svg;
pub mod text;
