//! The tabular Q-learner.
//!
//! [`Learner`] turns steps of a finite environment into action values for a task. Its inner loop is
//! the one of [`episode`], compiled for the number of actions and for the recipe: it is as fast as flat
//! arrays written by hand for one problem that do the same (`cargo bench -p tltl-tests --bench learn`: 0.9
//! of their speed or more).
//!
//! It never evaluates a predicate, for its task is a table. What it hands out is finished: the world as
//! it was seen, solved ([`Learner::q`]), and not the table that the loop has come to.

use alloc::vec::Vec;
use core::marker::PhantomData;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::coverage::Coverage;
use super::shielding::Shielding;
use super::table::{
    Any, Fixed, IndexedWorld, Layout, Paper, Plan, Recipe, Survey, Tabular, Width, turn,
};
use super::{Checkpoint, Experience, Settings, TrainError};
use crate::augmented::Labelled;
use crate::env::FallibleEnv;
use crate::episode::{self, Agent, Elapsed};
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::policy::{Policy, Training};
use crate::q::QTable;
use crate::reward::Rewards;
use crate::shield::Shield;
use crate::solve::{Certificate, Problem};

/// A tabular Q-learner (Watkins 1989) on the augmented MDP of a finite environment.
///
/// It holds its task and all that learning changes: the table, the visit counts, the random
/// generator, the experience. What it is asked for is finished: [`Self::policy`], [`Self::q`] and
/// [`Self::certify`] solve the world as it was seen. [`Self::train`] runs whole episodes until a total number of steps, so
/// that training in slices (to show progress, to write a [checkpoint](Self::checkpoint)) gives bit
/// for bit what training at once gives.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Visit both ends.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 0) && F ({ *s } == 4) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 1);
/// learner.train(&mut env, 5_000)?;
/// let problem = Problem::new(env.dynamics(), &task)?;
/// assert_eq!(learner.certify(&problem)?.regret_steps, Some(0.0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Learner {
    settings: Settings,
    table: QTable,
    /// Updates of each entry: (s, a) if all automaton states share them, else (q, s, a).
    visits: Vec<u32>,
    experience: Experience,
    coverage: Coverage,
    rng: Xoshiro256PlusPlus,
    elapsed: Elapsed,
    seed: u64,
}

impl Learner {
    /// A learner of `task`; all that is random comes from `seed`. Same task, settings, seed and
    /// environment: the same table to the last bit.
    #[must_use]
    #[inline]
    pub fn new(task: &Labelled, settings: Settings, seed: u64) -> Self {
        let remembered = if settings.remembers() { task.states() } else { 0 };
        Self {
            table: QTable::filled(task, settings.initial()),
            visits: alloc::vec![0; entries(task, &settings)],
            experience: Experience::new(remembered, task.actions()),
            coverage: Coverage::new(covered(task, &settings), task.actions()),
            rng: Xoshiro256PlusPlus::seed_from_u64(seed),
            elapsed: Elapsed::default(),
            settings,
            seed,
        }
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning;
    /// the last episode may exceed it by less than the horizon. Slices do not matter: `train` to
    /// 1000 and then to 2000 is the same as to 2000.
    ///
    /// Gives up early if 100,000 episodes in a row are over at their very first state.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// for total in [1_000, 2_000, 3_000] {
    ///     learner.train(&mut env, total)?;
    ///     println!("after {} steps: V = {:.3}", learner.steps(), learner.q().max(0, 0));
    /// }
    /// let mut at_once = Learner::new(&task, Settings::default(), 1);
    /// at_once.train(&mut env, 3_000)?;
    /// assert_eq!(learner, at_once);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the environment is of another world, pays what is not a finite number, or fails.
    pub fn train<E: FallibleEnv<Error: Into<TrainError>>>(
        &mut self,
        env: &mut E,
        total: u64,
    ) -> Result<(), TrainError> {
        // Grids have four actions, or five with one that stays; other numbers take the general loop.
        match (self.task().actions(), self.settings.is_papers(), self.settings.updates_values()) {
            (4, _, false) => self.run::<_, _, Survey>(env, Fixed::<4>, total),
            (5, _, false) => self.run::<_, _, Survey>(env, Fixed::<5>, total),
            (actions, _, false) => self.run::<_, _, Survey>(env, actions, total),
            (4, true, _) => self.run::<_, _, Paper>(env, Fixed::<4>, total),
            (5, true, _) => self.run::<_, _, Paper>(env, Fixed::<5>, total),
            (4, false, _) => self.run::<_, _, Any>(env, Fixed::<4>, total),
            (5, false, _) => self.run::<_, _, Any>(env, Fixed::<5>, total),
            (actions, _, _) => self.run::<_, _, Any>(env, actions, total),
        }
    }

    /// Trains in a loop that was made for a number of actions and a recipe: a fifth faster than
    /// one that asks for them at every step.
    fn run<E: FallibleEnv<Error: Into<TrainError>>, W: Width, C: Recipe>(
        &mut self,
        env: &mut E,
        width: W,
        total: u64,
    ) -> Result<(), TrainError> {
        let task = self.task();
        let (states, actions) = (task.states(), task.actions());
        let automaton = task.automaton_states() as usize;
        // Turning costs as much as a step for each row, and brings in rows that are never read.
        let turned = Plan::of(&self.settings).updates_all()
            && task.live().count() >= 4
            && total.saturating_sub(self.elapsed.steps) > states as u64;
        let mut layout = Layout::by_automaton(states);
        if turned {
            turn(self.table.values_mut(), automaton, actions);
            layout = Layout::by_state(automaton);
        }
        let result = self.run_as(env, total, (width, layout), |agent: Tabular<'_, W, C>| agent);
        if turned {
            turn(self.table.values_mut(), states, actions);
        }
        result
    }

    /// [`Self::train`] behind a shield: only actions that it allows are taken, and it is told each step.
    /// The settings say how to choose among them. Slower: actions are looked up at every step.
    ///
    /// On `!c U a` of the paper's grid, a million random steps: 46 % of the episodes end in the trap
    /// without a shield, 19 % behind one that looks one step ahead, and 1.6 % behind the safest one,
    /// none of them by an action that could have been a safer one (c is one of 80 starts).
    ///
    /// What it costs: actions that are barred are not learned about, so a table is worth its
    /// certificate only under the same shield
    /// ([`Optimum::certify_shield`](crate::solve::Optimum::certify_shield)).
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end, and keep off
    /// // the left one until then.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let mut shield = Shield::safest(&Problem::new(env.dynamics(), &task)?, 0.0)?;
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// learner.train_shielded(&mut env, &mut shield, 2_000)?;
    /// assert_eq!(learner.experience().tried(1, 0), 0, "what would be lost is never tried");
    ///
    /// // Without a model the shield learns, and a few accidents are its lesson.
    /// let mut shield = Shield::one_step(&task);
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// learner.train_shielded(&mut env, &mut shield, 2_000)?;
    /// let seen = learner.experience();
    /// assert!(seen.tried(1, 0) > 0 && 20 * seen.tried(1, 0) < seen.tried(1, 1));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::train`], or if the shield is of another task.
    pub fn train_shielded<E: FallibleEnv<Error: Into<TrainError>>>(
        &mut self,
        env: &mut E,
        shield: &mut Shield,
        total: u64,
    ) -> Result<(), TrainError> {
        self.task().check("a shield", shield.task())?;
        let (width, states) = (self.task().actions(), self.task().states());
        let layout = (width, Layout::by_automaton(states));
        self.run_as(env, total, layout, |agent| Shielding { agent, shield, allowed: Vec::new() })
    }

    /// Runs as the agent that `wrap` makes of the table.
    #[inline(always)]
    fn run_as<
        'a,
        E: FallibleEnv<Error: Into<TrainError>>,
        W: Width,
        C: Recipe,
        A: Agent<State = usize, Error = TrainError>,
    >(
        &'a mut self,
        env: &mut E,
        total: u64,
        (width, layout): (W, Layout),
        wrap: impl FnOnce(Tabular<'a, W, C>) -> A,
    ) -> Result<(), TrainError> {
        let task = self.table.task().clone();
        task.check_world("an environment", env.states(), env.actions())?;
        let mut world = IndexedWorld::new(env, &task, &self.settings.rewards());
        // Copies of its own stay in registers.
        let (mut rng, mut elapsed, settings) = (self.rng.clone(), self.elapsed, self.settings);
        let mut agent = wrap(Tabular {
            settings,
            plan: Plan::of(&settings),
            recipe: PhantomData,
            gamma: settings.rewards().gamma(),
            live: task.live().collect(),
            states: task.states(),
            width,
            layout,
            values: self.table.values_mut(),
            visits: &mut self.visits,
            experience: &mut self.experience,
            coverage: &mut self.coverage,
        });
        let horizon = settings.horizon();
        let result = episode::run(&mut world, &mut agent, &mut elapsed, horizon, total, &mut rng);
        (self.rng, self.elapsed) = (rng, elapsed);
        // The agent does not count steps: that would cost a store at each.
        result.map_err(|error| match error {
            TrainError::Reward(_) => TrainError::Reward(elapsed.steps),
            error => error,
        })
    }

    /// The task that is learned, on its world.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        self.table.task()
    }

    /// The action values, finished: those of the world as it was seen, with the frequencies of the
    /// [experience](Self::experience) as probabilities.
    ///
    /// Where acceptance alone is paid, as by default, they are of the largest P(satisfied), and then of
    /// the fewest steps. P comes first up to a tolerance, for it is known up to sampling: the greedy
    /// policy gives away at most 0.6 % of the largest P that the world as it was seen allows, and only
    /// for fewer steps (1 % of the steps is worth 0.006 % of P). γ matters only while learning. For other
    /// [rewards](Settings::rewards) they are the optimal values, at their γ.
    ///
    /// What was never tried counts as staying where one is, so it is never chosen where something that
    /// was tried can succeed. Solving takes about a millisecond on a small world, and no environment
    /// step; training goes on as if nobody had asked. Without experience
    /// ([`Memory::None`](super::Memory::None), or before the first step) this is [`Self::table`].
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// learner.train(&mut env, 200)?;
    /// let q = learner.q();
    /// assert!((q.max(0, 0) - 1.0).abs() < 0.02, "P(satisfied) is 1 from everywhere");
    /// assert!((0..4).all(|s| q.greedy(0, s) == 1), "and the fewest steps go right");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn q(&self) -> QTable {
        let Ok(seen) = Dynamics::new(&self.experience) else { return self.table.clone() };
        Problem::of_own_world(seen, self.task().clone()).finished(&self.rewards())
    }

    /// The table that training updates, as it is: what exploration is greedy in, and all that there is
    /// without experience. Where neither is so, as by default, no step
    /// [updates](super::Updates) it.
    #[must_use]
    #[inline]
    pub const fn table(&self) -> &QTable {
        &self.table
    }

    /// The greedy policy of [`Self::q`], saying how it was learned: finished, as that is. Each call
    /// solves anew.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// learner.train(&mut env, 1_000)?;
    /// let policy = learner.policy();
    /// assert_eq!((policy.act(0, 0), policy.training()[0].steps), (1, learner.steps()));
    /// // What it is worth is for whoever has a model to add.
    /// let certificate = learner.certify(&Problem::new(env.dynamics(), &task)?)?;
    /// let policy = policy.certified(certificate);
    /// assert!(policy.certificate().is_some_and(|worth| worth.satisfied > 0.999));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn policy(&self) -> Policy {
        self.q().policy().trained(self.training())
    }

    /// What [`Self::policy`] is worth in a world with a model, exactly; whether its actions are optimal
    /// is judged by the rewards that it was trained on.
    ///
    /// # Errors
    /// If `problem` is another task, or another world.
    #[inline]
    pub fn certify(&self, problem: &Problem) -> Result<Certificate, Mismatch> {
        problem.optimum(&self.rewards()).certify(&self.q().policy())
    }

    /// How the table was learned so far, as policies say it.
    #[must_use]
    #[inline]
    pub fn training(&self) -> Training {
        Training {
            task: self.task().name().into(),
            settings: self.settings,
            steps: self.elapsed.steps,
            episodes: self.elapsed.episodes,
            seed: self.seed,
        }
    }

    /// What was seen, if the settings say to keep it.
    #[must_use]
    #[inline]
    pub const fn experience(&self) -> &Experience {
        &self.experience
    }

    /// The settings.
    #[must_use]
    #[inline]
    pub const fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What is optimised: the rewards of the settings.
    #[must_use]
    #[inline]
    pub const fn rewards(&self) -> Rewards {
        self.settings.rewards()
    }

    /// Environment steps so far.
    #[must_use]
    #[inline]
    pub const fn steps(&self) -> u64 {
        self.elapsed.steps
    }

    /// Episodes so far.
    #[must_use]
    #[inline]
    pub const fn episodes(&self) -> u64 {
        self.elapsed.episodes
    }

    /// All that learning has changed, to be saved, and taken up again by [`Self::resume`].
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let mut env = ModelEnv::new(row)?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let mut learner = Learner::new(&task, Settings::default(), 1);
    /// learner.train(&mut env, 500)?;
    /// let saved = learner.checkpoint(); // serialise it with any format of serde
    /// let mut resumed = Learner::resume(&task, saved)?;
    /// learner.train(&mut env, 1_000)?;
    /// resumed.train(&mut env, 1_000)?;
    /// assert_eq!(learner, resumed);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn checkpoint(&self) -> Checkpoint {
        let task = self.task();
        Checkpoint {
            settings: self.settings,
            q: super::checkpoint::SavedValues {
                values: self.table.values().to_vec(),
                states: task.states(),
                actions: task.actions(),
            },
            visits: self.visits.clone(),
            experience: self.experience.clone(),
            coverage: self.coverage.distances().to_vec(),
            rng: self.rng.clone(),
            done: self.elapsed,
            task: Some(super::checkpoint::Identity::of(task)),
            seed: self.seed,
        }
    }

    /// A learner of `task` that goes on where the one was that `checkpoint` is of, with the same
    /// numbers.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let mut env = ModelEnv::new(model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]))?;
    /// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 1) })?;
    /// let mut learner = Learner::new(&task, Settings::default(), 7);
    /// learner.train(&mut env, 100)?;
    /// let mut resumed = Learner::resume(&task, learner.checkpoint())?;
    /// resumed.train(&mut env, 200)?;
    /// assert!(resumed.steps() >= 200 && resumed.training().seed == 7);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the checkpoint is of another task or another world.
    #[inline]
    pub fn resume(task: &Labelled, checkpoint: Checkpoint) -> Result<Self, Mismatch> {
        let covered = covered(task, &checkpoint.settings);
        checkpoint.must_be_of(task, entries(task, &checkpoint.settings), covered)?;
        Ok(Self {
            table: QTable::from_values(task, checkpoint.q.values)?,
            settings: checkpoint.settings,
            visits: checkpoint.visits,
            experience: checkpoint.experience,
            coverage: Coverage::of(checkpoint.coverage),
            rng: checkpoint.rng,
            elapsed: checkpoint.done,
            seed: checkpoint.seed,
        })
    }
}

/// The number of entries whose updates are counted.
///
/// Counterfactual updates visit all automaton states together, so they need one count for (s, a).
#[inline]
fn entries(task: &Labelled, settings: &Settings) -> usize {
    let pairs = if settings.is_counterfactual() { task.states() } else { task.pairs() };
    pairs * task.actions()
}

/// The number of states that exploration covers; none if it is random.
#[inline]
fn covered(task: &Labelled, settings: &Settings) -> usize {
    if settings.covers() { task.states() } else { 0 }
}
