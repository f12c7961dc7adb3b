//! Exploring behind a [`Shield`]: only actions that it allows are taken.

use alloc::vec::Vec;

use rand::Rng;

use super::TrainError;
use super::table::{Any, Tabular};
use crate::env::below;
use crate::episode::{Agent, Monitored, Transition};
use crate::shield::Shield;

/// A table learner that takes allowed actions only.
///
/// `allowed` is a buffer: the list is made anew at every step, and must not allocate there.
pub(super) struct Shielding<'a> {
    pub(super) agent: Tabular<'a, usize, Any>,
    pub(super) shield: &'a mut Shield,
    pub(super) allowed: Vec<usize>,
}

impl Agent for Shielding<'_> {
    type State = usize;
    type Error = TrainError;

    #[inline]
    fn start(&mut self, s: &usize) {
        self.agent.start(s);
    }

    /// ε-greedy among the actions that are allowed. Exploration is random: coverage would be drawn to actions
    /// that are barred, and so never tried.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        &s: &usize,
        steps: u64,
        rng: &mut R,
    ) -> Result<usize, TrainError> {
        let Self { agent, shield, allowed } = self;
        allowed.clear();
        allowed.extend(shield.allowed(q, s));
        if agent.explores(steps, rng) {
            return Ok(allowed[below(allowed.len(), rng)]);
        }
        let row = agent.row(q, s);
        let best = |best, a| if row[a] > row[best] { a } else { best };
        Ok(allowed.iter().copied().reduce(best).unwrap_or_default())
    }

    fn learn<W: Monitored<State = usize, Error: Into<TrainError>>, R: Rng + ?Sized>(
        &mut self,
        world: &W,
        transition: &Transition<'_, usize>,
        rng: &mut R,
    ) -> Result<(), TrainError> {
        self.shield.observe(*transition.s, transition.action, transition.step.state);
        self.agent.learn(world, transition, rng)
    }
}
