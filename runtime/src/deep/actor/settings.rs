//! The settings of an actor-critic learner.
//!
//! The defaults are those of SAC (Haarnoja et al. 2018), whose actor is stochastic; [`Settings::td3`] are those of TD3
//! (Fujimoto et al. 2018), both but for smaller networks; [`Settings::ddpg`] are those of the method that the paper
//! names, DDPG (Lillicrap et al. 2016), without its batch normalisation.

use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::learn::{Schedule, Updates};
use crate::range::{OutOfRange, checked};
use crate::reward::{self, Mode, Rewards};

/// How to learn with an actor and critics.
///
/// All settings are in their ranges: a value of this type is valid. Actions are meant as the learner has
/// them: each component within ±1, whatever its bounds in the world are.
///
/// ```
/// use tltl::deep::actor::Settings;
///
/// let settings = Settings::default().with_hidden([32, 32])?.with_noise_correlation(0.8)?;
/// assert_eq!((settings.critics(), settings.entropy()), (2, Some(-1.0)));
/// assert_eq!((Settings::td3().critics(), Settings::td3().entropy()), (2, None));
/// assert_eq!((Settings::ddpg().critics(), Settings::ddpg().target_noise()), (1, 0.0));
/// let error = settings.with_critics(3).unwrap_err();
/// assert_eq!(error.to_string(), "`critics` is 3, not 1 or 2");
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Saved", into = "Saved")]
pub struct Settings {
    rewards: Rewards,
    robustness: f64,
    horizon: u64,
    hidden: Vec<usize>,
    actor_rate: Schedule,
    critic_rate: Schedule,
    gradient_norm: f64,
    batch: usize,
    steps_per_update: u64,
    warmup: u64,
    capacity: usize,
    target_rate: f64,
    steps: usize,
    updates: Updates,
    relabelled: f64,
    noise: Schedule,
    noise_correlation: f64,
    critics: usize,
    actor_delay: u64,
    target_noise: f64,
    target_noise_clip: f64,
    entropy: Option<f64>,
    imitation: f64,
}

impl Default for Settings {
    /// [`Settings::sac`], which took fewer steps than TD3 for each of the six tasks in which both were measured.
    fn default() -> Self {
        Self::sac()
    }
}

impl Settings {
    /// TD3: a deterministic actor, noise added to its actions while it learns, and two critics (Fujimoto et
    /// al. 2018).
    #[must_use]
    pub fn td3() -> Self {
        Self {
            rewards: Rewards::of(Mode::Shaped).with_known_gamma(0.99),
            robustness: 0.0,
            horizon: 200,
            hidden: std::vec![128, 128],
            actor_rate: Schedule::known(1e-3),
            critic_rate: Schedule::known(1e-3),
            gradient_norm: 10.0,
            batch: 128,
            steps_per_update: 1,
            warmup: 1_000,
            capacity: 200_000,
            target_rate: 0.005,
            steps: 1,
            updates: Updates::Counterfactual,
            relabelled: 0.8,
            noise: Schedule::known(0.1),
            noise_correlation: 0.0,
            critics: 2,
            actor_delay: 2,
            target_noise: 0.2,
            target_noise_clip: 0.5,
            entropy: None,
            imitation: 1.0,
        }
    }

    /// The recipe of Lillicrap et al. (2016): one critic, no noise in the target, an update of the actor
    /// with each of the critic, noise of an Ornstein–Uhlenbeck process (θ 0.15, σ 0.2), and their
    /// networks and rates.
    #[must_use]
    pub fn ddpg() -> Self {
        Self {
            hidden: std::vec![400, 300],
            actor_rate: Schedule::known(1e-4),
            batch: 64,
            capacity: 1_000_000,
            target_rate: 0.001,
            // Steady deviation of x' = 0.85 x + 0.2 ξ.
            noise: Schedule::known(0.38),
            noise_correlation: 0.85,
            critics: 1,
            actor_delay: 1,
            target_noise: 0.0,
            ..Self::td3()
        }
    }

    /// SAC, with two critics and a temperature that is tuned (Haarnoja et al. 2018): the actor draws its
    /// actions while it learns, and is paid for the entropy that it keeps.
    ///
    /// ```
    /// use tltl::deep::actor::Settings;
    ///
    /// let settings = Settings::sac();
    /// assert_eq!((settings.entropy(), settings.actor_delay()), (Some(-1.0), 1));
    /// assert_eq!(settings.with_entropy(None)?.with_actor_delay(2)?, Settings::td3());
    /// # Ok::<(), tltl::OutOfRange>(())
    /// ```
    #[must_use]
    pub fn sac() -> Self {
        Self { entropy: Some(-1.0), actor_delay: 1, ..Self::td3() }
    }

    /// The same with a deterministic actor.
    pub(super) fn deterministic(self) -> Self {
        Self { entropy: None, ..self }
    }

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

    /// The units of each hidden layer, of the actor and of the critics.
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

    /// Adam's step size for the actor, at the number of earlier updates.
    #[must_use]
    pub const fn actor_rate(&self) -> Schedule {
        self.actor_rate
    }

    /// The same with another [`actor_rate`](Self::actor_rate).
    ///
    /// # Errors
    /// Unless all its numbers are positive.
    pub fn with_actor_rate(self, actor_rate: Schedule) -> Result<Self, OutOfRange> {
        actor_rate.check("actor_rate", "a positive number", |rate| rate > 0.0)?;
        Ok(Self { actor_rate, ..self })
    }

    /// Adam's step size for the critics, at the number of earlier updates.
    #[must_use]
    pub const fn critic_rate(&self) -> Schedule {
        self.critic_rate
    }

    /// The same with another [`critic_rate`](Self::critic_rate).
    ///
    /// # Errors
    /// Unless all its numbers are positive.
    pub fn with_critic_rate(self, critic_rate: Schedule) -> Result<Self, OutOfRange> {
        critic_rate.check("critic_rate", "a positive number", |rate| rate > 0.0)?;
        Ok(Self { critic_rate, ..self })
    }

    /// The deviation of what is added to each component of an action while learning, at the number of
    /// earlier environment steps.
    ///
    /// ```
    /// use tltl::deep::actor::Settings;
    /// use tltl::learn::{Schedule, Updates};
    ///
    /// let settings = Settings::default()
    ///     .with_noise(Schedule::linear(0.5, 0.1, 10_000)?)?
    ///     .with_updates(Updates::Current);
    /// assert_eq!((settings.noise().at(5_000), settings.updates()), (0.3, Updates::Current));
    /// # Ok::<(), tltl::OutOfRange>(())
    /// ```
    #[must_use]
    pub const fn noise(&self) -> Schedule {
        self.noise
    }

    /// The same with other [`noise`](Self::noise).
    ///
    /// # Errors
    /// Unless all its numbers are from 0 on.
    pub fn with_noise(self, noise: Schedule) -> Result<Self, OutOfRange> {
        noise.check("noise", "a number from 0 on", |noise| noise >= 0.0)?;
        Ok(Self { noise, ..self })
    }

    /// The entropy that a stochastic actor keeps, in nats for each component of an action; `None` is a deterministic
    /// actor, that of TD3 and DDPG.
    ///
    /// -1 is what Haarnoja et al. (2018) took, about that of a normal distribution of deviation 0.09; 0.69 is that
    /// of actions that are all as likely. What a nat weighs is tuned, at [`actor_rate`](Self::actor_rate), until the
    /// actor keeps so much. A stochastic actor does not read [`noise`](Self::noise), for it has its
    /// own, nor [`target_noise`](Self::target_noise).
    #[must_use]
    pub const fn entropy(&self) -> Option<f64> {
        self.entropy
    }

    /// The same with another [`entropy`](Self::entropy).
    ///
    /// # Errors
    /// Unless it is a number below ln 2, the entropy of actions that are all as likely.
    pub fn with_entropy(self, entropy: Option<f64>) -> Result<Self, OutOfRange> {
        let value = entropy.unwrap_or_default();
        let valid = value.is_finite() && value < core::f64::consts::LN_2;
        OutOfRange::check("entropy", value, valid, "a number below ln 2")?;
        Ok(Self { entropy, ..self })
    }

    /// Which heads a replayed step updates.
    ///
    /// Updating all of them is as much work as so many tasks. The study of continuous control updates the step's
    /// own head alone beyond four live states.
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
    /// The weight of a potential within each automaton state: ρ(s, D_φ^q), how near the state of the
    /// world is to a move that is progress, over [`Rewards::bound`] and clamped to ±1. Like all
    /// potentials it leaves the best policies what they are (Ng et al. 1999).
    robustness, with_robustness: f64, "a number from 0 on", |w| w >= 0.0 && w.is_finite();
    /// Steps after which an episode is truncated.
    horizon, with_horizon: u64, "at least 1", |horizon| horizon > 0;
    /// The largest norm of a gradient; longer ones are shortened to it.
    gradient_norm, with_gradient_norm: f64, "a positive number", |n| n > 0.0 && n.is_finite();
    /// Steps that an update replays.
    batch, with_batch: usize, "at least 1", |batch| batch > 0;
    /// Environment steps between two updates.
    steps_per_update, with_steps_per_update: u64, "at least 1", |steps| steps > 0;
    /// Environment steps with random actions, before the first update.
    warmup, with_warmup: u64, "a number of steps", |_| true;
    /// States that the replay keeps.
    capacity, with_capacity: usize, "from 2 to 2^32 - 1", |n| n > 1 && u32::try_from(n).is_ok();
    /// How far the target networks move towards the networks each time.
    target_rate, with_target_rate: f64, "in (0, 1]", |rate| rate > 0.0 && rate <= 1.0;
    /// The number of steps whose rewards are added up before the value of the state after them.
    /// Beyond 1 the actions between are those that were taken, not the actor's.
    steps, with_steps: usize, "at least 1", |steps| steps > 0;
    /// The share of replayed steps that get another goal, where tasks have goals.
    relabelled, with_relabelled: f64, "in [0, 1]", |share| (0.0..=1.0).contains(&share);
    /// How much of the noise of a step is that of the step before: 0 is white, 0.85 the process that
    /// DDPG took. Correlated noise gets farther in worlds with inertia.
    noise_correlation, with_noise_correlation: f64, "in [0, 1)", |c| (0.0..1.0).contains(&c);
    /// Critics, the least of whose values is believed; two keep values from growing (TD3).
    critics, with_critics: usize, "1 or 2", |n| n == 1 || n == 2;
    /// Updates of the critics for each of the actor and of all targets.
    actor_delay, with_actor_delay: u64, "at least 1", |delay| delay > 0;
    /// The deviation of what is added to the target's actions, so that values are smooth in them.
    target_noise, with_target_noise: f64, "a number from 0 on", |n| n >= 0.0 && n.is_finite();
    /// The largest size of that.
    target_noise_clip, with_target_noise_clip: f64, "a number from 0 on", |n| n >= 0.0 && n.is_finite();
    /// How much the actor imitates where it learns without a step in the world, as a
    /// [`Composition`](super::Composition) does and [`Learner::rehearse`](super::Learner::rehearse): what half
    /// the square of its distance from the action that was taken costs, where the critics value that action
    /// more than its own (Nair et al. 2018). It leads the actor off the lower of two hills; in the world noise does
    /// that, and nothing is imitated.
    imitation, with_imitation: f64, "a number from 0 on", |w| w >= 0.0 && w.is_finite();
}}

/// Settings as they are saved.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Saved {
    gamma: f64,
    rewards: reward::Saved,
    robustness: f64,
    horizon: u64,
    hidden: Vec<usize>,
    actor_rate: Schedule,
    critic_rate: Schedule,
    gradient_norm: f64,
    batch: usize,
    steps_per_update: u64,
    warmup: u64,
    capacity: usize,
    target_rate: f64,
    steps: usize,
    counterfactual: bool,
    relabelled: f64,
    noise: Schedule,
    noise_correlation: f64,
    critics: usize,
    actor_delay: u64,
    target_noise: f64,
    target_noise_clip: f64,
    entropy: Option<f64>,
    imitation: f64,
}

impl From<Settings> for Saved {
    fn from(settings: Settings) -> Self {
        Self {
            gamma: settings.rewards.gamma(),
            rewards: settings.rewards.into(),
            robustness: settings.robustness,
            horizon: settings.horizon,
            hidden: settings.hidden,
            actor_rate: settings.actor_rate,
            critic_rate: settings.critic_rate,
            gradient_norm: settings.gradient_norm,
            batch: settings.batch,
            steps_per_update: settings.steps_per_update,
            warmup: settings.warmup,
            capacity: settings.capacity,
            target_rate: settings.target_rate,
            steps: settings.steps,
            counterfactual: settings.updates == Updates::Counterfactual,
            relabelled: settings.relabelled,
            noise: settings.noise,
            noise_correlation: settings.noise_correlation,
            critics: settings.critics,
            actor_delay: settings.actor_delay,
            target_noise: settings.target_noise,
            target_noise_clip: settings.target_noise_clip,
            entropy: settings.entropy,
            imitation: settings.imitation,
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
            .with_robustness(saved.robustness)?
            .with_horizon(saved.horizon)?
            .with_hidden(saved.hidden)?
            .with_actor_rate(saved.actor_rate)?
            .with_critic_rate(saved.critic_rate)?
            .with_gradient_norm(saved.gradient_norm)?
            .with_batch(saved.batch)?
            .with_steps_per_update(saved.steps_per_update)?
            .with_warmup(saved.warmup)?
            .with_capacity(saved.capacity)?
            .with_target_rate(saved.target_rate)?
            .with_steps(saved.steps)?
            .with_updates(updates)
            .with_relabelled(saved.relabelled)?
            .with_noise(saved.noise)?
            .with_noise_correlation(saved.noise_correlation)?
            .with_critics(saved.critics)?
            .with_actor_delay(saved.actor_delay)?
            .with_target_noise(saved.target_noise)?
            .with_target_noise_clip(saved.target_noise_clip)?
            .with_imitation(saved.imitation)?
            .with_entropy(saved.entropy)
    }
}
