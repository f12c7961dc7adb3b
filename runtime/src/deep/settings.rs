//! The settings of a deep learner.
//!
//! Several defaults are those of the literature: n = 3 as in Rainbow (Hessel et al. 2018), a soft target
//! of 0.005 as in TD3 (Fujimoto et al. 2018), a bound of 10 on the gradient's norm as in dueling networks
//! (Wang et al. 2016).

use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::learn::{Schedule, Updates};
use crate::range::{OutOfRange, checked};
use crate::reward::{self, Mode, Rewards};

/// How to learn with a network.
///
/// All settings are in their ranges: a value of this type is valid. γ is one of the
/// [rewards](Self::rewards), for it says what is optimised: by default acceptance, with potentials that
/// show the way ([`Mode::Shaped`]), and γ 0.97. Where a task can be lost, a γ nearer 1 takes fewer risks.
///
/// ```
/// use tltl::deep::Settings;
///
/// let settings = Settings::default().with_hidden([64, 64])?.with_batch(32)?;
/// assert_eq!((settings.hidden(), settings.steps()), (&[64, 64][..], 3));
/// let error = settings.with_target_rate(0.0).unwrap_err();
/// assert_eq!(error.to_string(), "`target_rate` is 0, not in (0, 1]");
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Saved", into = "Saved")]
pub struct Settings {
    rewards: Rewards,
    horizon: u64,
    hidden: Vec<usize>,
    learning_rate: Schedule,
    gradient_norm: f64,
    batch: usize,
    steps_per_update: u64,
    warmup: u64,
    capacity: usize,
    priority: f64,
    importance: Schedule,
    target_rate: f64,
    steps: usize,
    updates: Updates,
    relabelled: f64,
    normalisation: f64,
    advantage_learning: f64,
    advantage_penalty: f64,
    epsilon: Schedule,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            rewards: Rewards::of(Mode::Shaped).with_known_gamma(0.97),
            horizon: 200,
            hidden: std::vec![128, 128],
            learning_rate: Schedule::known(5e-4),
            gradient_norm: 10.0,
            batch: 128,
            steps_per_update: 2,
            warmup: 1_000,
            capacity: 200_000,
            priority: 0.3,
            importance: Schedule::known_linear(0.4, 1.0, 100_000),
            target_rate: 0.005,
            steps: 3,
            updates: Updates::Counterfactual,
            relabelled: 0.8,
            normalisation: 1e-3,
            advantage_learning: 0.9,
            advantage_penalty: 1.0,
            epsilon: Schedule::known_linear(1.0, 0.05, 20_000),
        }
    }
}

impl Settings {
    /// What is optimised, the discount factor γ included.
    #[must_use]
    pub const fn rewards(&self) -> Rewards {
        self.rewards
    }

    /// The same with other [`rewards`](Self::rewards).
    #[must_use]
    pub fn with_rewards(self, rewards: Rewards) -> Self {
        Self { rewards, ..self }
    }

    /// The units of each hidden layer.
    #[must_use]
    pub fn hidden(&self) -> &[usize] {
        &self.hidden
    }

    /// The same with other [`hidden`](Self::hidden) layers.
    ///
    /// # Errors
    /// Unless each has a unit.
    pub fn with_hidden(self, hidden: impl Into<Vec<usize>>) -> Result<Self, OutOfRange> {
        let hidden = hidden.into();
        let units = hidden.iter().all(|&units| units > 0);
        OutOfRange::check("hidden", 0.0, units, "at least 1 in each layer")?;
        Ok(Self { hidden, ..self })
    }

    /// Adam's step size, at the number of earlier updates.
    ///
    /// ```
    /// use tltl::deep::Settings;
    /// use tltl::learn::{Schedule, Updates};
    ///
    /// // Anneal over 20,000 updates; explore less and less for 5,000 steps; only the head of the step.
    /// let settings = Settings::default()
    ///     .with_learning_rate(Schedule::linear(1e-3, 1e-5, 20_000)?)?
    ///     .with_epsilon(Schedule::linear(1.0, 0.1, 5_000)?)?
    ///     .with_importance(Schedule::constant(1.0)?)?
    ///     .with_updates(Updates::Current);
    /// assert_eq!((settings.learning_rate().at(0), settings.updates()), (1e-3, Updates::Current));
    /// assert!(settings.with_learning_rate(Schedule::constant(0.0)?).is_err());
    /// # Ok::<(), tltl::OutOfRange>(())
    /// ```
    #[must_use]
    pub const fn learning_rate(&self) -> Schedule {
        self.learning_rate
    }

    /// The same with another [`learning_rate`](Self::learning_rate).
    ///
    /// # Errors
    /// Unless all its numbers are positive.
    pub fn with_learning_rate(self, learning_rate: Schedule) -> Result<Self, OutOfRange> {
        learning_rate.check("learning_rate", "a positive number", |rate| rate > 0.0)?;
        Ok(Self { learning_rate, ..self })
    }

    /// How much of the bias of prioritized replay the weights take back, at the number of earlier
    /// updates; 1 is all.
    #[must_use]
    pub const fn importance(&self) -> Schedule {
        self.importance
    }

    /// The same with another [`importance`](Self::importance).
    ///
    /// # Errors
    /// Unless all its numbers are in [0, 1].
    pub fn with_importance(self, importance: Schedule) -> Result<Self, OutOfRange> {
        importance.check("importance", "in [0, 1]", |share| (0.0..=1.0).contains(&share))?;
        Ok(Self { importance, ..self })
    }

    /// The probability of a random action, at the number of earlier environment steps.
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

    /// Which heads a replayed step updates.
    #[must_use]
    pub const fn updates(&self) -> Updates {
        self.updates
    }

    /// The same with other [`updates`](Self::updates).
    #[must_use]
    pub fn with_updates(self, updates: Updates) -> Self {
        Self { updates, ..self }
    }
}

checked! { Settings {
    /// Steps after which an episode is truncated.
    horizon, with_horizon: u64, "at least 1", |horizon| horizon > 0;
    /// The largest norm of a gradient; longer ones are shortened to it.
    gradient_norm, with_gradient_norm: f64, "a positive number", |n| n > 0.0 && n.is_finite();
    /// Steps that an update replays.
    batch, with_batch: usize, "at least 1", |batch| batch > 0;
    /// Environment steps between two updates.
    steps_per_update, with_steps_per_update: u64, "at least 1", |steps| steps > 0;
    /// Environment steps before the first update.
    warmup, with_warmup: u64, "a number of steps", |_| true;
    /// States that the replay keeps.
    capacity, with_capacity: usize, "from 2 to 2^32 - 1", |n| n > 1 && u32::try_from(n).is_ok();
    /// How much large errors are replayed more often: priorities are errors to this power. 0 draws
    /// uniformly.
    priority, with_priority: f64, "a number from 0 on", |p| p >= 0.0 && p.is_finite();
    /// How far the target network moves towards the network at each update.
    target_rate, with_target_rate: f64, "in (0, 1]", |rate| rate > 0.0 && rate <= 1.0;
    /// The number of steps whose rewards are added up before the value of the state after them.
    /// Beyond 1 the actions between are those that were taken, not the best ones.
    steps, with_steps: usize, "at least 1", |steps| steps > 0;
    /// The share of replayed steps that get another goal, where tasks have goals.
    relabelled, with_relabelled: f64, "in [0, 1]", |share| (0.0..=1.0).contains(&share);
    /// How fast the normalisation of the targets follows them; 0 is none.
    normalisation, with_normalisation: f64, "in [0, 1]", |rate| (0.0..=1.0).contains(&rate);
    /// In a composition: the share α of what an action falls short of the policy's that is taken off
    /// its value again (advantage learning, Baird 1999; Bellemare et al. 2016). The values of states
    /// and the best actions stay what they are, and all other actions fall behind by 1 / (1 − α)
    /// times as much. Without it that is a few per cent of a value, less than a network errs by, and
    /// the policy goes back and forth between the skills.
    advantage_learning, with_advantage_learning: f64, "in [0, 1)", |a| (0.0..1.0).contains(&a);
    /// In a composition: the weight of the mean square of what is added to the skills' differences
    /// between actions. What was never seen of an action so stays as the skills have it.
    advantage_penalty, with_advantage_penalty: f64, "a number from 0 on",
        |weight| weight >= 0.0 && weight.is_finite();
}}

/// Settings as they are saved.
#[derive(Serialize, Deserialize)]
struct Saved {
    gamma: f64,
    rewards: reward::Saved,
    horizon: u64,
    hidden: Vec<usize>,
    learning_rate: Schedule,
    gradient_norm: f64,
    batch: usize,
    steps_per_update: u64,
    warmup: u64,
    capacity: usize,
    priority: f64,
    importance: Schedule,
    target_rate: f64,
    steps: usize,
    counterfactual: bool,
    relabelled: f64,
    normalisation: f64,
    advantage_learning: f64,
    advantage_penalty: f64,
    epsilon: Schedule,
}

impl From<Settings> for Saved {
    fn from(settings: Settings) -> Self {
        Self {
            gamma: settings.rewards.gamma(),
            rewards: settings.rewards.into(),
            horizon: settings.horizon,
            hidden: settings.hidden,
            learning_rate: settings.learning_rate,
            gradient_norm: settings.gradient_norm,
            batch: settings.batch,
            steps_per_update: settings.steps_per_update,
            warmup: settings.warmup,
            capacity: settings.capacity,
            priority: settings.priority,
            importance: settings.importance,
            target_rate: settings.target_rate,
            steps: settings.steps,
            counterfactual: settings.updates == Updates::Counterfactual,
            relabelled: settings.relabelled,
            normalisation: settings.normalisation,
            advantage_learning: settings.advantage_learning,
            advantage_penalty: settings.advantage_penalty,
            epsilon: settings.epsilon,
        }
    }
}

impl TryFrom<Saved> for Settings {
    type Error = OutOfRange;

    fn try_from(saved: Saved) -> Result<Self, OutOfRange> {
        let updates =
            [Updates::Current, Updates::Counterfactual][usize::from(saved.counterfactual)];
        Self::default()
            .with_rewards(saved.rewards.with_gamma(saved.gamma)?)
            .with_horizon(saved.horizon)?
            .with_hidden(saved.hidden)?
            .with_learning_rate(saved.learning_rate)?
            .with_gradient_norm(saved.gradient_norm)?
            .with_batch(saved.batch)?
            .with_steps_per_update(saved.steps_per_update)?
            .with_warmup(saved.warmup)?
            .with_capacity(saved.capacity)?
            .with_priority(saved.priority)?
            .with_importance(saved.importance)?
            .with_target_rate(saved.target_rate)?
            .with_steps(saved.steps)?
            .with_updates(updates)
            .with_relabelled(saved.relabelled)?
            .with_normalisation(saved.normalisation)?
            .with_advantage_learning(saved.advantage_learning)?
            .with_advantage_penalty(saved.advantage_penalty)?
            .with_epsilon(saved.epsilon)
    }
}
