//! The worlds of the examples, and the pictures that they draw.

pub mod figure;
pub mod grid;
