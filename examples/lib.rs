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

/// The programs of the guide run.
#[cfg(doctest)]
mod guide {
    #[doc = include_str!("../docs/guide/compose.md")]
    pub struct Compose;
    #[doc = include_str!("../docs/guide/hierarchy.md")]
    pub struct Hierarchy;
    #[doc = include_str!("../docs/guide/learn.md")]
    pub struct Learn;
    #[doc = include_str!("../docs/guide/monitor.md")]
    pub struct Monitor;
    #[doc = include_str!("../docs/guide/no_model.md")]
    pub struct NoModel;
    #[doc = include_str!("../docs/guide/shields.md")]
    pub struct Shields;
    #[doc = include_str!("../docs/guide/world.md")]
    pub struct World;
}
