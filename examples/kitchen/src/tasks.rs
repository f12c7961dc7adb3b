//! The specifications, compiled from `tasks/kitchen.tltl`.
//!
//! With a drawn goal, `phi_j(object, receptacle)` is the paper's φ2.j; the composition is the
//! [product](tltl::product::Product) of `phi1_3()` and `phi_3(object, receptacle)`. A task is made
//! anew for each goal, which costs nothing: its automaton is static. [`told`] reads the goal from the
//! state, for those who want one task for all episodes.

tltl::include_tltl!("tasks/kitchen.tltl", state = crate::known::Known);

pub use kitchen::{hold, inside, open, phi_1, phi_2, phi_3, phi1_1, phi1_2, phi1_3, see};

/// The specifications over the goal that the agent is [told](crate::Known::goal): one task for all
/// episodes.
pub mod told {
    use tltl::Monitor;
    use tltl::task::Parametric;

    use crate::known::Known;

    /// φ2.1: what is wanted is put where it is wanted, however that comes about.
    pub fn phi_1() -> impl Monitor<Known> + Clone + Send + Sync {
        Parametric::new(super::phi_1(0, 0), |k: &Known| super::phi_1(k.wanted, k.target))
    }

    /// φ2.2: it is in hand before.
    pub fn phi_2() -> impl Monitor<Known> + Clone + Send + Sync {
        Parametric::new(super::phi_2(0, 0), |k: &Known| super::phi_2(k.wanted, k.target))
    }

    /// φ2.3: it is seen, then taken, then the receptacle is open, then the object is in it.
    pub fn phi_3() -> impl Monitor<Known> + Clone + Send + Sync {
        Parametric::new(super::phi_3(0, 0), |k: &Known| super::phi_3(k.wanted, k.target))
    }
}
