//! Continuous worlds with tasks over numbers, and controllers for them: learned ones, and those that one
//! writes by hand.

pub mod arm;
pub mod judge;
pub mod picture;
pub mod point;
#[cfg(feature = "rapier")]
pub mod rover;
