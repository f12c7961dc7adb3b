//! Baselines without progress: learning from whole trajectories.
//!
//! What the paper improves upon: the reward comes at the end of an episode only, as the robustness
//! of the whole trajectory (Li et al. 2016) or as 1 if it satisfies the task; and the learner sees
//! the state of the world alone, or the automaton too.

use alloc::vec::Vec;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;

use super::Settings;
use crate::augmented::{End, Labelled};
use crate::env::{FiniteEnv, below, unit};
use crate::q::QTable;
use crate::task::{Error, Monitor};

/// What the end of an episode pays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Terminal {
    /// The robustness of the whole trajectory, clamped to `[-bound, bound]`.
    Robustness {
        /// The largest reward or punishment.
        bound: f64,
    },
    /// 1 if the task is satisfied.
    Satisfaction,
}

/// A Q-learner that is paid at the end of episodes.
///
/// Of [`Settings`] it reads γ, α, ε, the horizon and the initial value. Episodes end where the task
/// is decided, or at the horizon, which for this reward *is* the end and not a cut.
#[derive(Clone, Debug)]
pub struct WholeLearner {
    settings: Settings,
    terminal: Terminal,
    /// Whether it sees the automaton state.
    automaton: bool,
    q: QTable,
    visits: Vec<u32>,
    rng: Xoshiro256PlusPlus,
    steps: u64,
}

impl WholeLearner {
    /// A learner of `task` with `actions` actions, seeded. If not `automaton` it sees the state of
    /// the world alone: every automaton state gets the same values.
    #[must_use]
    pub fn new(
        task: &Labelled,
        actions: usize,
        settings: Settings,
        terminal: Terminal,
        automaton: bool,
        seed: u64,
    ) -> Self {
        let rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let visits = alloc::vec![0; task.pairs() * actions];
        let q = QTable::filled(task, actions, settings.initial);
        Self { settings, terminal, automaton, q, visits, rng, steps: 0 }
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning.
    ///
    /// # Errors
    /// If a predicate is not a number at a state that was met.
    ///
    /// # Panics
    /// If the environment, the task and its table are not of the same sizes.
    pub fn train<E: FiniteEnv, M: Monitor<E::State>>(
        &mut self,
        env: &mut E,
        monitor: &M,
        task: &Labelled,
        total: u64,
    ) -> Result<(), Error> {
        assert_eq!(env.states(), task.states(), "a task is labelled on its own world");
        while self.steps < total {
            self.episode(env, monitor, task)?;
        }
        Ok(())
    }

    fn episode<E: FiniteEnv, M: Monitor<E::State>>(
        &mut self,
        env: &mut E,
        monitor: &M,
        task: &Labelled,
    ) -> Result<(), Error> {
        let mut trajectory = alloc::vec![env.reset(&mut self.rng)];
        let mut s = env.state_index();
        let mut q = task.start(s);
        // Episodes that are over at once count, so that training ends whatever the task.
        self.steps += u64::from(task.end(q).is_some());
        for t in 1..=self.settings.horizon {
            if task.end(q).is_some() {
                return Ok(());
            }
            let a = self.act(self.seen(q), s);
            let step = env.step(a, &mut self.rng);
            trajectory.push(step.state);
            let (from, to) = (self.seen(q), env.state_index());
            q = task.next(q, to);
            self.steps += 1;
            let cut = step.terminated || step.truncated || t == self.settings.horizon;
            let last = cut || task.end(q).is_some();
            let target = if last {
                self.pays(monitor, &trajectory, task.end(q))?
            } else {
                self.settings.gamma * self.q.max(self.seen(q), to)
            };
            self.learn(from, s, a, target);
            s = to;
            if last {
                return Ok(());
            }
        }
        Ok(())
    }

    /// The automaton state as the learner sees it.
    const fn seen(&self, q: u32) -> u32 {
        if self.automaton { q } else { 0 }
    }

    fn pays<S, M: Monitor<S>>(
        &self,
        monitor: &M,
        trajectory: &[S],
        end: Option<End>,
    ) -> Result<f64, Error> {
        match self.terminal {
            Terminal::Satisfaction => Ok(f64::from(u8::from(end == Some(End::Accepted)))),
            Terminal::Robustness { bound } => {
                Ok(monitor.trajectory_robustness(trajectory)?.clamp(-bound, bound))
            }
        }
    }

    fn act(&mut self, q: u32, s: usize) -> usize {
        let epsilon = self.settings.epsilon.at(self.steps);
        if epsilon >= 1.0 || unit(&mut self.rng) < epsilon {
            below(self.q.actions(), &mut self.rng)
        } else {
            self.q.greedy(q, s) as usize
        }
    }

    fn learn(&mut self, q: u32, s: usize, a: usize, target: f64) {
        let visits = &mut self.visits[(q as usize * self.q.states() + s) * self.q.actions() + a];
        let alpha = self.settings.alpha.at(u64::from(*visits));
        *visits = visits.saturating_add(1);
        let value = &mut self.q.row_mut(q, s)[a];
        *value += alpha * (target - *value);
    }

    /// The greedy policy, indexed `q * states + s`.
    #[must_use]
    pub fn policy(&self) -> Vec<u32> {
        let states = self.q.states();
        let pairs = 0..self.q.automaton_states() as usize * states;
        pairs.map(|at| self.q.greedy(self.seen((at / states) as u32), at % states)).collect()
    }

    /// Environment steps so far.
    #[must_use]
    pub const fn steps(&self) -> u64 {
        self.steps
    }
}
