//! What is claimed of the kitchen.

mod episode;
mod layout;
mod learning;
mod plans;
mod products;
mod rules;
mod starts;
