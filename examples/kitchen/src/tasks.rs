//! The specifications, compiled from `tasks/kitchen.tltl`.
//!
//! With a drawn goal, `phi_j(object, receptacle)` is the paper's φ2.j; the composition is the
//! [product](tltl::product::Product) of `phi1_3()` and `phi_3(object, receptacle)`. A task is made
//! anew for each goal, which costs nothing: its automaton is static. [`told`] has the same over the
//! goal that the agent is told, for those who want one task for all episodes.

tltl::include_tltl!("tasks/kitchen.tltl", state = crate::known::Known);

pub use kitchen::{hold, inside, open, phi_1, phi_2, phi_3, phi1_1, phi1_2, phi1_3, see};

/// The specifications over the goal that the agent is [told](crate::Known::goal), so without
/// parameters.
///
/// They panic on a state without a goal, which no episode has.
pub mod told {
    use crate::known::Known;

    tltl::tltl! {
        state k: Known;

        predicate see = { k.sees(k.wanted) };
        predicate hold = { k.holds(k.wanted) };
        predicate open = { k.opened(k.target) };
        predicate inside = { k.inside(k.wanted, k.target) };

        /// φ2.1: what is wanted is put where it is wanted, however that comes about.
        task phi_1 = F inside;

        /// φ2.2: it is in hand before.
        task phi_2 = hold T inside;

        /// φ2.3: it is seen, then taken, then the receptacle is open, then the object is in it.
        task phi_3 = see T hold T open T inside;
    }
}
