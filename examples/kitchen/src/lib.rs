//! The kitchen of the paper's Section 5.2, as an exact symbolic simulator.
//!
//! The paper's kitchen ran in AI2-THOR, whose builds cannot be had without a download at run time.
//! Its problem is the *high-level* one, for navigation is assumed to work; so the decision problem
//! is rebuilt here as rules over objects, receptacles, doors and a view, to be stepped millions of
//! times a second and searched exactly.
//!
//! | module | what it turns into what |
//! | --- | --- |
//! | [`layout`], [`mod@format`] | a TOML file into the static facts of a kitchen |
//! | [`action`] | numbers into actions, and back |
//! | [`truth`] | a situation and an action into the next situation: the rules |
//! | [`known`] | the truth into what the agent has observed, which predicates and learners read |
//! | [`world`] | the rules into an environment with goals, starts and time limits |
//! | [`tasks`] | the task file into specifications |
//! | [`planner`] | a start and a specification into a shortest plan, by one who sees everything |
//! | [`searcher`] | knowledge into an action, by rules of thumb: a fair policy |
//! | [`show`], [`strip`] | an episode into text, and into a strip of pictures |
//!
//! # What is known, and what is reconstructed
//!
//! Known, from the paper and from sources of AI2-THOR of early 2018:
//! 17 objects, 39 receptacles, 62 actions (`pick put open close look_up look_down` and one
//! `navigate` for each id); what may be put where; that pot and pan cannot be picked up; capacities
//! of cabinets, fridge, microwave and coffee machine; the preconditions of `pick`, `put`, `open`,
//! `close`; four levels of the horizon; a failed action changes nothing; starts are random.
//!
//! Reconstructed, and so to be said wherever results are shown: the other capacities; which horizon
//! each receptacle needs; that nothing but what is focused is in view; what `navigate` to an object
//! needs (that the agent remembers where it is, that no closed door is before it, and that it is
//! not in hand); that after `pick` the receptacle is focused that held the object; how starts and
//! goals are drawn; the formulas, for the paper's supplement is lost; the cost of a failed action.

pub mod action;
pub mod features;
pub mod format;
pub mod known;
pub mod layout;
pub mod planner;
mod relaxed;
pub mod searcher;
pub mod show;
pub mod strip;
pub mod tasks;
pub mod truth;
pub mod world;

pub use action::Action;
pub use known::Known;
pub use layout::{Goal, Layout, LayoutError, MAX_IDS, NONE};
pub use truth::Truth;
pub use world::{Goals, Kitchen};
