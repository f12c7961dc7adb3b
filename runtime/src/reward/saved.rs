//! Rewards as settings save them.

use serde::{Deserialize, Serialize};

use super::{Mode, Rewards};

/// γ stands beside them, and the bound inside of the mode.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Saved {
    mode: SavedMode,
    trap_penalty: f64,
    step_penalty: f64,
    environment: f64,
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
enum SavedMode {
    Progress,
    Literal,
    Acceptance,
    Robustness { bound: f64 },
    Shaped,
}

impl From<Rewards> for Saved {
    #[inline]
    fn from(rewards: Rewards) -> Self {
        let Rewards { mode, bound, trap_penalty, step_penalty, environment, .. } = rewards;
        let mode = match mode {
            Mode::Progress => SavedMode::Progress,
            Mode::Literal => SavedMode::Literal,
            Mode::Acceptance => SavedMode::Acceptance,
            Mode::Robustness => SavedMode::Robustness { bound },
            Mode::Shaped => SavedMode::Shaped,
        };
        Self { mode, trap_penalty, step_penalty, environment }
    }
}

impl Saved {
    /// The rewards that were saved beside `gamma`.
    #[inline]
    pub(crate) fn with_gamma(self, gamma: f64) -> Result<Rewards, crate::range::OutOfRange> {
        let rewards = match self.mode {
            SavedMode::Progress => Rewards::of(Mode::Progress),
            SavedMode::Literal => Rewards::of(Mode::Literal),
            SavedMode::Acceptance => Rewards::of(Mode::Acceptance),
            SavedMode::Robustness { bound } => Rewards::of(Mode::Robustness).with_bound(bound)?,
            SavedMode::Shaped => Rewards::of(Mode::Shaped),
        };
        rewards
            .with_gamma(gamma)?
            .with_trap_penalty(self.trap_penalty)?
            .with_step_penalty(self.step_penalty)?
            .with_environment(self.environment)
    }
}
