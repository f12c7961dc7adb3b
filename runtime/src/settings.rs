//! The settings of tabular learners.

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

mod schedule;

pub use schedule::Schedule;

use crate::range::{OutOfRange, checked};
use crate::reward::Rewards;

/// Which automaton states one step of the environment updates.
///
/// Updating all costs as many updates a step as there are live automaton states, and learns from each
/// step what every automaton state would have learned; `docs/studies/curves.md` has the difference.
///
/// None is updated where nobody would read the values: where all actions explore
/// ([ε](Settings::epsilon) is 1) and the [experience](Memory::Experience) is kept, no action is chosen for
/// its value, and what the experience tells replaces them. So there, by default, a step costs the same for
/// any number of automaton states.
///
/// ```
/// use tltl::learn::{Memory, Settings, Updates};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // First the right end of five cells, then the left one.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| ({ *s } == 4) T ({ *s } == 0) })?;
/// let known = [Updates::Current, Updates::Counterfactual].map(|updates| {
///     let settings = Settings::default().with_memory(Memory::None).with_updates(updates);
///     let mut learner = Learner::new(&task, settings, 1);
///     learner.train(&mut env, 30).unwrap();
///     learner.table().values().iter().filter(|value| **value > 0.0).count()
/// });
/// assert!(known[0] < known[1], "the same 30 steps tell more: {known:?}");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Updates {
    /// The one in which the step was taken.
    Current,
    /// Every live one: what a step does in the world does not depend on q (counterfactual updates,
    /// Toro Icarte et al. 2018).
    Counterfactual,
}

/// How an action is chosen where none is chosen for its value: with probability
/// [ε](Settings::epsilon).
///
/// A random walk hardly leaves the place where it starts: after 200 steps it is some ten cells away. From
/// a corner of a grid of 20 × 20 cells, 200,000 random steps give policies that take 7 % more steps than
/// the best one, 50,000 by coverage 1.6 % more, and 200,000 0.7 %. Through four rooms of 10 × 10 cells
/// random walks find no way at all, and coverage one that is 1.1 % longer. Where episodes start everywhere,
/// and in worlds without places that are near, the two learn alike (means of 5 seeds in 10 worlds).
///
/// ```
/// use tltl::learn::{Exploration, Settings};
/// use tltl::model::FiniteModel;
/// use tltl::prelude::*;
///
/// /// A corridor of 60 cells: action 0 goes left, action 1 right. Episodes start at the left end.
/// struct Corridor;
///
/// impl FiniteModel for Corridor {
///     type State = usize;
///     fn states(&self) -> usize {
///         60
///     }
///     fn actions(&self) -> usize {
///         2
///     }
///     fn state(&self, s: usize) -> usize {
///         s
///     }
///     fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
///         outcome([s.saturating_sub(1), (s + 1).min(59)][a], 1.0);
///     }
///     fn start(&self, s: usize) -> f64 {
///         if s == 0 { 1.0 } else { 0.0 }
///     }
/// }
///
/// let mut env = ModelEnv::new(Corridor)?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 59) })?;
/// let found = [Exploration::Random, Exploration::Coverage].map(|exploration| {
///     let mut learner = Learner::new(&task, Settings::default().with_exploration(exploration), 1);
///     learner.train(&mut env, 4_000).unwrap();
///     learner.experience().tried(58, 1) > 0
/// });
/// assert_eq!(found, [false, true]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Exploration {
    /// Any action, with equal probabilities.
    Random,
    /// The one that is nearest to what was tried least. Each (s, a) has a number u, from 0 on; the action
    /// of the smallest u is taken, and then u(s, a) becomes 1 + the smallest u of s', or 1 more where the
    /// episode is over.
    ///
    /// That is real-time search (LRTA*, Korf 1990) whose goal is what is new, with a number for each
    /// action (Koenig and Simmons 1993). No random number is drawn. It costs 4 bytes for each (s, a). Behind
    /// a [shield](crate::shield::Shield) exploration is random all the same.
    Coverage,
}

/// What a learner keeps beside its table.
///
/// [`Learner::policy`](crate::learn::Learner::policy) rests on it: what was seen is solved. Experience is
/// counts, so it grows with the world and not with time: 68 bytes for each (s, a) that was tried, or for
/// each 8 outcomes of it. (The table takes 8 bytes for each (q, s, a).)
///
/// Without it a step is faster, and nothing is finished: the policy is the greedy one of the table, which
/// tells apart only what differs by more than its step size blurs. Where a world is too large for counts,
/// take a γ that the table can learn, 0.99 say: what is lost then is in `docs/studies/tasks.md`.
/// Composition from experience cannot be had either.
///
/// ```
/// use tltl::learn::{Memory, Settings};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let mut env = ModelEnv::new(model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]))?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 1) })?;
/// let mut learner = Learner::new(&task, Settings::default().with_memory(Memory::None), 1);
/// learner.train(&mut env, 100)?;
/// assert_eq!(&learner.q(), learner.table(), "there is nothing to solve");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// Nothing.
    None,
    /// The [`Experience`](crate::learn::Experience), for finishing and composition.
    Experience,
}

/// How to learn a table.
///
/// All settings are in their ranges: a value of this type is valid. γ is one of the
/// [rewards](Self::rewards), for it says what is optimised.
///
/// ```
/// use tltl::learn::{Schedule, Settings};
/// use tltl::reward::Rewards;
///
/// let settings = Settings::default()
///     .with_rewards(Rewards::acceptance().with_gamma(0.999)?)
///     .with_epsilon(Schedule::linear(1.0, 0.05, 100_000)?)?
///     .with_horizon(500)?;
/// assert_eq!(settings.horizon(), 500);
/// let error = settings.with_alpha(Schedule::constant(1.5)?).unwrap_err();
/// assert_eq!(error.to_string(), "`alpha` is 1.5, not in (0, 1]");
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Saved", into = "Saved"))]
pub struct Settings {
    alpha: Schedule,
    epsilon: Schedule,
    exploration: Exploration,
    horizon: u64,
    updates: Updates,
    initial: f64,
    rewards: Rewards,
    memory: Memory,
}

impl Settings {
    /// The paper's recipe (Section 5.1): [`Rewards::progress`], γ 0.95, α 0.1, horizon 200, random
    /// exploration, and nothing that is not in the paper: each step updates one automaton state, and
    /// the policy is the greedy one of the table.
    ///
    /// ```
    /// use tltl::learn::{Memory, Settings, Updates};
    /// use tltl::reward::Mode;
    ///
    /// let paper = Settings::paper();
    /// assert_eq!((paper.rewards().mode(), paper.rewards().gamma()), (Mode::Progress, 0.95));
    /// assert_eq!((paper.alpha().at(0), paper.epsilon().at(0), paper.horizon()), (0.1, 1.0, 200));
    /// assert_eq!((paper.updates(), paper.memory()), (Updates::Current, Memory::None));
    /// ```
    #[must_use]
    pub const fn paper() -> Self {
        Self {
            alpha: Schedule::known(0.1),
            epsilon: Schedule::known(1.0),
            exploration: Exploration::Random,
            horizon: 200,
            updates: Updates::Current,
            initial: 0.0,
            rewards: Rewards::progress(),
            memory: Memory::None,
        }
    }

    /// What is optimised, the discount factor γ included.
    #[must_use]
    pub const fn rewards(&self) -> Rewards {
        self.rewards
    }

    /// The same with other [`rewards`](Self::rewards).
    #[must_use]
    pub const fn with_rewards(self, rewards: Rewards) -> Self {
        Self { rewards, ..self }
    }

    /// The step size, at the number of earlier updates of the same entry.
    #[must_use]
    pub const fn alpha(&self) -> Schedule {
        self.alpha
    }

    /// The same with another [`alpha`](Self::alpha).
    ///
    /// # Errors
    /// Unless all its numbers are in (0, 1].
    pub fn with_alpha(self, alpha: Schedule) -> Result<Self, OutOfRange> {
        alpha.check("alpha", "in (0, 1]", |alpha| alpha > 0.0 && alpha <= 1.0)?;
        Ok(Self { alpha, ..self })
    }

    /// The probability of an action that [explores](Self::exploration), at the number of earlier
    /// environment steps; others are greedy in the table.
    #[must_use]
    pub const fn epsilon(&self) -> Schedule {
        self.epsilon
    }

    /// The same with another [`epsilon`](Self::epsilon).
    ///
    /// # Errors
    /// Unless all its numbers are in [0, 1].
    pub fn with_epsilon(self, epsilon: Schedule) -> Result<Self, OutOfRange> {
        epsilon.check("epsilon", "in [0, 1]", |epsilon| (0.0..=1.0).contains(&epsilon))?;
        Ok(Self { epsilon, ..self })
    }

    /// How actions explore.
    #[must_use]
    pub const fn exploration(&self) -> Exploration {
        self.exploration
    }

    /// The same with another [`exploration`](Self::exploration).
    #[must_use]
    pub const fn with_exploration(self, exploration: Exploration) -> Self {
        Self { exploration, ..self }
    }

    /// Which automaton states a step updates.
    #[must_use]
    pub const fn updates(&self) -> Updates {
        self.updates
    }

    /// The same with other [`updates`](Self::updates).
    #[must_use]
    pub const fn with_updates(self, updates: Updates) -> Self {
        Self { updates, ..self }
    }

    /// What the learner keeps beside its table.
    #[must_use]
    pub const fn memory(&self) -> Memory {
        self.memory
    }

    /// The same with another [`memory`](Self::memory).
    #[must_use]
    pub const fn with_memory(self, memory: Memory) -> Self {
        Self { memory, ..self }
    }

    /// Whether each step updates every live automaton state.
    #[inline]
    pub(super) const fn is_counterfactual(&self) -> bool {
        matches!(self.updates, Updates::Counterfactual)
    }

    /// Whether exploration covers the world.
    #[inline]
    pub(super) const fn covers(&self) -> bool {
        matches!(self.exploration, Exploration::Coverage)
    }

    /// Whether all actions explore.
    #[inline]
    pub(super) fn only_explores(&self) -> bool {
        self.epsilon.fixed().is_some_and(|epsilon| epsilon >= 1.0)
    }

    /// Whether steps update values: not where no action is chosen for them, and the experience has all
    /// that they could tell.
    #[inline]
    pub(super) fn updates_values(&self) -> bool {
        !(self.only_explores() && self.remembers())
    }

    /// Whether each step is the paper's: a random action, one update of a constant size, no memory.
    #[inline]
    pub(super) fn is_papers(&self) -> bool {
        let random = self.only_explores() && !self.covers();
        random && self.alpha.fixed().is_some() && !self.is_counterfactual() && !self.remembers()
    }

    /// Whether the experience is kept.
    #[inline]
    pub(super) const fn remembers(&self) -> bool {
        matches!(self.memory, Memory::Experience)
    }
}

checked! { Settings {
    /// Steps after which an episode is truncated.
    horizon, with_horizon: u64, "at least 1", |horizon| horizon > 0;
    /// The value that entries start from; optimistic if no true value exceeds it.
    initial, with_initial: f64, "a finite number", |initial| initial.is_finite();
}}

impl Default for Settings {
    /// Learns what the task wants: [`Rewards::acceptance`], and the experience is kept, so that the
    /// [policy](crate::learn::Learner::policy) has the largest P(satisfied) and then the fewest steps.
    ///
    /// All actions explore, by [coverage](Exploration::Coverage), in episodes of at most 200 steps, so no
    /// step updates a value. With a smaller ε, or without experience, the table learns from each step what
    /// every automaton state would have learned, with a step size that falls with the visits, so that
    /// values converge instead of rattling at the width of α.
    fn default() -> Self {
        Self {
            alpha: Schedule::known_harmonic(1.0, 8.0),
            epsilon: Schedule::known(1.0),
            exploration: Exploration::Coverage,
            horizon: 200,
            updates: Updates::Counterfactual,
            initial: 0.0,
            rewards: Rewards::acceptance(),
            memory: Memory::Experience,
        }
    }
}

/// Settings as they are saved.
#[cfg(feature = "serde")]
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    gamma: f64,
    alpha: Schedule,
    epsilon: Schedule,
    horizon: u64,
    counterfactual: bool,
    initial: f64,
    rewards: crate::reward::Saved,
    remember: bool,
    /// Not there in files of earlier versions, which explored at random.
    #[serde(default)]
    coverage: bool,
}

#[cfg(feature = "serde")]
impl From<Settings> for Saved {
    fn from(settings: Settings) -> Self {
        Self {
            gamma: settings.rewards.gamma(),
            alpha: settings.alpha,
            epsilon: settings.epsilon,
            horizon: settings.horizon,
            counterfactual: settings.is_counterfactual(),
            initial: settings.initial,
            rewards: settings.rewards.into(),
            remember: settings.remembers(),
            coverage: settings.covers(),
        }
    }
}

#[cfg(feature = "serde")]
impl TryFrom<Saved> for Settings {
    type Error = OutOfRange;

    fn try_from(saved: Saved) -> Result<Self, OutOfRange> {
        let updates =
            [Updates::Current, Updates::Counterfactual][usize::from(saved.counterfactual)];
        let memory = [Memory::None, Memory::Experience][usize::from(saved.remember)];
        let exploration = [Exploration::Random, Exploration::Coverage][usize::from(saved.coverage)];
        Self::paper()
            .with_exploration(exploration)
            .with_rewards(saved.rewards.with_gamma(saved.gamma)?)
            .with_updates(updates)
            .with_memory(memory)
            .with_alpha(saved.alpha)?
            .with_epsilon(saved.epsilon)?
            .with_horizon(saved.horizon)?
            .with_initial(saved.initial)
    }
}
