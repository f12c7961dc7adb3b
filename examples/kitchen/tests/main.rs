//! What is claimed of the kitchen.

mod episode;
mod layout;
mod plans;
mod products;
mod rules;
mod starts;
