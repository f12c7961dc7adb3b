//! The settings of a deep learner.

use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::augmented::Rewards;
use crate::learn::Schedule;

/// How to learn with a network.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Settings {
    /// The discount factor, 0 ≤ γ < 1.
    pub gamma: f64,
    /// What is paid.
    pub rewards: Rewards,
    /// Steps after which an episode is truncated.
    pub horizon: u32,
    /// The units of each hidden layer.
    pub hidden: Vec<usize>,
    /// Adam's step size, at the number of earlier updates.
    pub learning_rate: Schedule,
    /// The largest norm of a gradient; longer ones are shortened to it.
    pub gradient_norm: f64,
    /// Steps that an update replays.
    pub batch: usize,
    /// Environment steps between two updates.
    pub steps_per_update: u64,
    /// Environment steps before the first update.
    pub warmup: u64,
    /// States that the replay keeps.
    pub capacity: usize,
    /// How much large errors are replayed more often: priorities are errors to this power. 0 draws
    /// uniformly.
    pub priority: f64,
    /// How much of the bias of prioritized replay the weights take back, at the number of earlier
    /// updates; 1 is all.
    pub importance: Schedule,
    /// How far the target network moves towards the network at each update.
    pub target_rate: f64,
    /// The number of steps whose rewards are added up before the value of the state after them. Beyond
    /// 1 the actions between are those that were taken, not the best ones.
    pub steps: usize,
    /// Whether each step updates the heads of all automaton states, not only of the one that it was
    /// taken in.
    pub counterfactual: bool,
    /// The share of replayed steps that get another goal, where tasks have goals.
    pub relabelled: f64,
    /// How fast the normalisation of the targets follows them; 0 is none.
    pub normalisation: f64,
    /// In a composition: the share α, 0 ≤ α < 1, of what an action falls short of the policy's that is
    /// taken off its value again (advantage learning, Baird 1999; Bellemare et al. 2016). The values of
    /// states and the best actions stay what they are, and all other actions fall behind by
    /// 1 / (1 − α) times as much. Without it that is a few per cent of a value, less than a network
    /// errs by, and the policy goes back and forth between the skills.
    pub advantage_learning: f64,
    /// In a composition: the weight of the mean square of what is added to the skills' differences
    /// between actions. What was never seen of an action so stays as the skills have it.
    pub advantage_penalty: f64,
    /// The probability of a random action, at the number of earlier environment steps.
    pub epsilon: Schedule,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            gamma: 0.97,
            rewards: Rewards::default(),
            horizon: 200,
            hidden: std::vec![128, 128],
            learning_rate: Schedule::Constant(5e-4),
            gradient_norm: 10.0,
            batch: 128,
            steps_per_update: 2,
            warmup: 1_000,
            capacity: 200_000,
            priority: 0.3,
            importance: Schedule::Linear { from: 0.4, to: 1.0, steps: 100_000 },
            target_rate: 0.005,
            steps: 3,
            counterfactual: true,
            relabelled: 0.8,
            normalisation: 1e-3,
            advantage_learning: 0.9,
            advantage_penalty: 1.0,
            epsilon: Schedule::Linear { from: 1.0, to: 0.05, steps: 20_000 },
        }
    }
}
