//! Tabular Q-learning on the FSA-augmented MDP.
//!
//! A [`Learner`] holds all that learning changes: the table, the visit counts, its random
//! generator, the experience. [`Learner::train`] runs whole episodes until a total number of
//! environment steps is reached, so that training in slices (to show progress, to write a
//! checkpoint) gives bit for bit what training at once gives; with serde a learner can be saved
//! between slices and resumed (serde_json reads floats back exactly only with its feature
//! `float_roundtrip`).
//!
//! All learners run in the one loop of [`episode`].
//!
//! [`Settings::paper`] is the paper's recipe. [`Settings::default`] learns better from the same
//! steps: a world's step does not depend on q, so each one updates *every* live automaton state
//! (counterfactual updates, Toro Icarte et al. 2018), and the step size falls with the visits, so
//! that values converge instead of rattling at the width of α. On the paper's grid and φ₁ 6 million
//! steps, 0.4 s, come within 0.06 % of the smallest E\[steps\] at each of 20 seeds that the settings
//! were not chosen on. Where a task has a trap, take [`Settings::safe`].

pub mod episode;
mod experience;
mod guard;
#[cfg(feature = "std")]
mod seeds;
mod table;
mod whole;

use alloc::vec::Vec;
use core::convert::Infallible;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};
#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

pub use experience::Experience;
pub use guard::Guard;
#[cfg(feature = "std")]
pub use seeds::seeds;
pub use whole::{Terminal, WholeLearner};

use self::episode::{Agent, Done};
use self::guard::Guarded;
use self::table::{Fixed, Numbered, Tabular, Width};
use crate::augmented::{Labelled, Reward, Rewards};
use crate::env::FiniteEnv;
use crate::model::{Dynamics, ModelError};
use crate::q::QTable;
use crate::solve::Problem;

/// A number that changes while learning goes on; n counts what its user counts.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "lowercase", deny_unknown_fields))]
pub enum Schedule {
    /// The same for ever.
    Constant(f64),
    /// From one number to another over `steps`, then that.
    Linear {
        /// At n = 0.
        from: f64,
        /// From n = `steps` on.
        to: f64,
        /// How long it takes.
        steps: u64,
    },
    /// `start · half / (half + n)`: half of `start` at n = `half`. As a step size it satisfies the
    /// conditions of Robbins and Monro.
    Harmonic {
        /// At n = 0.
        start: f64,
        /// The n at which half is left.
        half: f64,
    },
}

impl Schedule {
    /// The number at `n`.
    #[inline]
    #[must_use]
    pub fn at(&self, n: u64) -> f64 {
        match *self {
            Self::Constant(value) => value,
            Self::Linear { from, to, steps } => {
                let done = if n < steps { n as f64 / steps as f64 } else { 1.0 };
                from + (to - from) * done
            }
            Self::Harmonic { start, half } => start * half / (half + n as f64),
        }
    }
}

/// How to learn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Settings {
    /// The discount factor, 0 ≤ γ < 1.
    pub gamma: f64,
    /// The step size, at the number of earlier updates of the same entry.
    pub alpha: Schedule,
    /// The probability of a random action, at the number of earlier environment steps.
    pub epsilon: Schedule,
    /// Steps after which an episode is truncated.
    pub horizon: u32,
    /// Whether each step updates every live automaton state, not only the current one.
    pub counterfactual: bool,
    /// The value that entries start from; optimistic if no true value exceeds it.
    pub initial: f64,
    /// What is paid.
    pub rewards: Rewards,
    /// Whether to keep the [`Experience`], for composition.
    pub remember: bool,
}

impl Settings {
    /// For tasks with a trap: [`Reward::Acceptance`] and γ 0.99999, everything else as by default;
    /// train, then [replay](Learner::replay). The optimum for that reward gives away at most 0.011 %
    /// of P(satisfied) in the study of rewards (`docs/studies/rewards.md`); `Progress` with γ 0.95
    /// trades safety for speed, and pays for detours where an automaton has longer ways to
    /// acceptance.
    ///
    /// A γ so close to 1 is for the decisions that are nearly ties: each step of delay costs 1 − γ,
    /// and at 0.9999 a dozen steps outweigh 0.1 % of P(satisfied), a difference that sampling then
    /// decides. What is left is sampling alone: random episodes seldom come to a narrow place beside
    /// a trap, and where two actions there were tried 5,000 times each, a risk of 4 % is known to
    /// ±0.28 %. After 6 million steps and a replay 2 of 707 tasks and layouts give away more than
    /// 0.1 %, the worst 0.19 %; after 100 million, a few seconds, none. Where there is a model, the
    /// certificate tells.
    #[must_use]
    pub fn safe() -> Self {
        Self { gamma: 0.99999, rewards: Rewards::of(Reward::Acceptance), ..Self::default() }
    }

    /// The paper's recipe (Section 5.1): γ 0.95, α 0.1, horizon 200, random exploration.
    #[must_use]
    pub fn paper() -> Self {
        Self {
            gamma: 0.95,
            alpha: Schedule::Constant(0.1),
            epsilon: Schedule::Constant(1.0),
            horizon: 200,
            counterfactual: false,
            initial: 0.0,
            rewards: Rewards::default(),
            remember: false,
        }
    }
}

impl Default for Settings {
    fn default() -> Self {
        let alpha = Schedule::Harmonic { start: 1.0, half: 8.0 };
        Self { alpha, counterfactual: true, remember: true, ..Self::paper() }
    }
}

/// A tabular Q-learner (Watkins 1989) on the augmented MDP of a finite environment.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
pub struct Learner<R = Xoshiro256PlusPlus> {
    settings: Settings,
    q: QTable,
    /// Updates of each entry: (s, a) if all automaton states share them, else (q, s, a).
    visits: Vec<u32>,
    experience: Experience,
    rng: R,
    done: Done,
}

impl Learner {
    /// A learner of `task` with `actions` actions, seeded.
    #[must_use]
    pub fn new(task: &Labelled, actions: usize, settings: Settings, seed: u64) -> Self {
        Self::with_rng(task, actions, settings, Xoshiro256PlusPlus::seed_from_u64(seed))
    }
}

impl<R: Rng + Clone> Learner<R> {
    /// A learner with a random generator of the user's.
    #[must_use]
    pub fn with_rng(task: &Labelled, actions: usize, settings: Settings, rng: R) -> Self {
        let entries = if settings.counterfactual { task.states() } else { task.pairs() };
        let remembered = if settings.remember { task.states() } else { 0 };
        Self {
            settings,
            q: QTable::filled(task, actions, settings.initial),
            visits: alloc::vec![0; entries * actions],
            experience: Experience::new(remembered, actions),
            rng,
            done: Done::default(),
        }
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it by less than the horizon. Slices do not matter: `train` to
    /// 1000 and then to 2000 is the same as to 2000.
    ///
    /// Gives up early if 100,000 episodes in a row are over at their very first state.
    ///
    /// # Panics
    /// If the environment or the task are not of the sizes the learner was made for.
    pub fn train<E: FiniteEnv>(&mut self, env: &mut E, task: &Labelled, total: u64) {
        self.check(env, task);
        let plain = !self.settings.counterfactual && !self.settings.remember;
        match (self.q.actions(), plain) {
            (4, true) => self.run::<_, _, true>(env, task, Fixed::<4>, total),
            (5, true) => self.run::<_, _, true>(env, task, Fixed::<5>, total),
            (4, false) => self.run::<_, _, false>(env, task, Fixed::<4>, total),
            (5, false) => self.run::<_, _, false>(env, task, Fixed::<5>, total),
            (actions, _) => self.run::<_, _, false>(env, task, actions, total),
        }
    }

    /// Trains in a loop that was made for a number of actions and a recipe: a fifth faster than
    /// one that asks for them at every step.
    fn run<E: FiniteEnv, W: Width, const PLAIN: bool>(
        &mut self,
        env: &mut E,
        task: &Labelled,
        width: W,
        total: u64,
    ) {
        self.run_as(env, task, total, width, |agent: Tabular<'_, W, PLAIN>| agent);
    }

    /// [`Self::train`] behind a guard, which leaves only some actions to explore; the settings say
    /// how to choose among them. Slower: actions are looked up at every step.
    ///
    /// # Panics
    /// As [`Self::train`]; if the guard looks one step ahead and the settings do not remember.
    pub fn train_guarded<E: FiniteEnv>(
        &mut self,
        env: &mut E,
        task: &Labelled,
        guard: Guard<'_>,
        total: u64,
    ) {
        self.check(env, task);
        let remembers = self.settings.remember || matches!(guard, Guard::Shield(_));
        assert!(remembers, "looking one step ahead needs what was seen: `remember`");
        let width = self.q.actions();
        let guarded = |agent| Guarded { agent, task, guard, allowed: Vec::new() };
        self.run_as(env, task, total, width, guarded);
    }

    /// Runs as the agent that `wrap` makes of the table.
    #[inline(always)]
    fn run_as<
        'a,
        E: FiniteEnv,
        W: Width,
        A: Agent<State = usize, Error = Infallible>,
        const PLAIN: bool,
    >(
        &'a mut self,
        env: &mut E,
        task: &Labelled,
        total: u64,
        width: W,
        wrap: impl FnOnce(Tabular<'a, W, PLAIN>) -> A,
    ) {
        let mut world = Numbered::new(env, task, &self.settings);
        // Copies of its own stay in registers.
        let (mut rng, mut done, settings) = (self.rng.clone(), self.done, self.settings);
        let mut agent = wrap(Tabular {
            settings,
            live: task.live().collect(),
            states: self.q.states(),
            width,
            values: self.q.values_mut(),
            visits: &mut self.visits,
            experience: &mut self.experience,
        });
        let horizon = settings.horizon;
        let Ok(()) = episode::run(&mut world, &mut agent, &mut done, horizon, total, &mut rng);
        (self.rng, self.done) = (rng, done);
    }

    fn check<E: FiniteEnv>(&self, env: &E, task: &Labelled) {
        assert_eq!(env.states(), task.states(), "a task is labelled on its own world");
        assert_eq!(
            (env.states(), env.actions(), task.automaton_states()),
            (self.q.states(), self.q.actions(), self.q.automaton_states()),
            "a learner stays with its world and its task"
        );
    }

    /// Replays the remembered experience until nothing changes: the table becomes the optimum of
    /// the world as it was seen. It gets more out of the same steps than any step size does; costs
    /// about a millisecond on a small world, and takes no environment step.
    ///
    /// # Errors
    /// If nothing is remembered.
    pub fn replay(&mut self, task: &Labelled) -> Result<(), ModelError> {
        let world = Dynamics::new(&self.experience)?;
        let Settings { gamma, rewards, .. } = self.settings;
        let payment = task.payment(&rewards, gamma);
        self.q = Problem::new(&world, task).optimal_q_of(&payment, gamma, Some(&self.q));
        Ok(())
    }

    /// The action values so far.
    #[must_use]
    pub const fn q(&self) -> &QTable {
        &self.q
    }

    /// What was seen, if the settings say to remember it.
    #[must_use]
    pub const fn experience(&self) -> &Experience {
        &self.experience
    }

    /// The settings.
    #[must_use]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Environment steps so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.done.steps
    }

    /// Episodes so far.
    #[must_use]
    pub const fn episodes(&self) -> u64 {
        self.done.episodes
    }
}
