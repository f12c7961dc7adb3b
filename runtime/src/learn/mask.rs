//! Exploring without entering traps that can be avoided.
//!
//! An action mask leaves a learner some actions in each (q, s); which of them it takes its settings
//! say. With a model the mask is a [`Shield`], which looks at the long run. Without one it looks one
//! step ahead in what was seen so far, by a test on counts.

use alloc::vec::Vec;

use rand::Rng;

use super::table::Tabular;
use super::{Experience, TrainError};
use crate::augmented::Labelled;
use crate::env::below;
use crate::episode::{Agent, Monitored, Transition};
use crate::model::FiniteModel;
use crate::reward::End;
use crate::shield::Shield;

/// An action mask: which actions a learner may explore.
///
/// On `!c U a` of the paper's grid, a million random steps: 46 % of the episodes end in the trap
/// without a mask, 19 % with one that looks one step ahead, and 1.6 % behind the shield of the
/// model, none of them by an action that could have been a safer one (c is one of 80 starts).
///
/// What it costs: actions that are barred are not learned about, so a table is worth its
/// certificate only under the same shield
/// ([`Optimum::certify_shield`](crate::solve::Optimum::certify_shield)). There it is here the
/// largest possible P(satisfied), 98.4865 %, in the fewest steps that allow it, 11.6584: the
/// shield costs nothing, and the sampling that tips near ties beside a trap has no effect. Where a
/// goal lies beside a trap it can cost nearly all: see [`shield`](crate::shield).
///
/// Without a model, the counts are enough:
///
/// ```
/// use tltl::learn::Mask;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row. Reach the right end, and keep off the left one until then.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
/// let mut learner = Learner::new(&task, Settings::safe(), 1);
/// learner.train_masked(&mut env, Mask::OneStep, 2_000)?;
/// let seen = learner.experience();
/// assert!(seen.tried(1, 0) > 0 && 20 * seen.tried(1, 0) < seen.tried(1, 1), "a few accidents");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Mask<'a> {
    /// A [`Shield`]: with that of a known model no trap is ever entered that can be avoided.
    Shield(&'a Shield),
    /// One step ahead, in what was seen so far: all but the actions that entered the trap more often
    /// than another one, by twice the standard error. A trap must have been entered a few times by an
    /// action to be known there, and the way to where every action is dangerous is not barred. For
    /// settings that keep the [`Experience`].
    OneStep,
}

impl Mask<'_> {
    /// Leaves in `allowed` the actions that are allowed in `s` at `q`; all, if none would be: a mask
    /// never stops an episode.
    #[inline]
    fn allow(
        &self,
        (q, s): (u32, usize),
        task: &Labelled,
        seen: &Experience,
        allowed: &mut Vec<usize>,
    ) {
        allowed.clear();
        let all = 0..seen.actions();
        match self {
            Self::Shield(shield) => allowed.extend(all.filter(|&a| shield.allows(q, s, a))),
            Self::OneStep => {
                let risks = all.clone().map(|a| risk((q, s, a), task, seen));
                let least = risks.fold(f64::INFINITY, |least, (risk, _)| least.min(risk));
                allowed.extend(all.filter(|&a| {
                    let (risk, variance) = risk((q, s, a), task, seen);
                    let more = risk - least;
                    more * more <= 4.0 * variance
                }));
            }
        }
        if allowed.is_empty() {
            allowed.extend(0..seen.actions());
        }
    }
}

/// How often the action entered the trap as a fraction of its tries, and the variance of that
/// fraction. One try of each kind is assumed beside (Laplace's rule of succession), so that one
/// accident bars nothing and an action without tries is not thought safe.
#[inline]
fn risk((q, s, a): (u32, usize, usize), task: &Labelled, seen: &Experience) -> (f64, f64) {
    let (tried, mut lost) = (seen.tried(s, a) as f64, 0.0);
    if tried > 0.0 {
        seen.transitions(s, a, |to, p| {
            lost += if task.end(task.next(q, to)) == Some(End::Lost) { p * tried } else { 0.0 };
        });
    }
    let p = (lost + 1.0) / (tried + 2.0);
    (p, p * (1.0 - p) / (tried + 2.0))
}

/// A table learner that acts behind a mask.
///
/// `allowed` is a buffer: the list is made anew at every step, and must not allocate there.
pub(super) struct Masked<'a> {
    pub(super) agent: Tabular<'a, usize, false>,
    pub(super) task: &'a Labelled,
    pub(super) mask: Mask<'a>,
    pub(super) allowed: Vec<usize>,
}

impl Agent for Masked<'_> {
    type State = usize;
    type Error = TrainError;

    #[inline]
    fn start(&mut self, s: &usize) {
        self.agent.start(s);
    }

    /// ε-greedy among the actions that are allowed.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        &s: &usize,
        steps: u64,
        rng: &mut R,
    ) -> Result<usize, TrainError> {
        let Self { agent, task, mask, allowed } = self;
        mask.allow((q, s), task, agent.experience, allowed);
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
        self.agent.learn(world, transition, rng)
    }
}
