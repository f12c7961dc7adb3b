//! The worlds of the examples, and the pictures that they draw.

pub mod chart;
pub mod figure;
pub mod grid;
pub mod places;
mod plot;
pub mod show;
pub mod spread;
pub mod study;
pub mod svg;
