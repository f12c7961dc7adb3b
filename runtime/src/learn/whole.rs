//! Baselines without progress: learning from whole trajectories.
//!
//! What the paper improves upon: the reward comes at the end of an episode only, as the robustness
//! of the whole trajectory (Li et al. 2016) or as 1 if it satisfies the task; and the learner sees
//! the state of the world alone, or the automaton too.

use alloc::vec::Vec;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};

use super::Settings;
use super::episode::{self, Agent, Done, Move, Seen, World};
use crate::augmented::{End, Labelled};
use crate::env::{FiniteEnv, Step, below, unit};
use crate::monitor::Monitor;
use crate::q::QTable;
use crate::task::Error;

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
    done: Done,
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
        Self { settings, terminal, automaton, q, visits, rng, done: Done::default() }
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
        let Settings { horizon, .. } = self.settings;
        let (terminal, trajectory) = (self.terminal, Vec::new());
        let mut world = Whole { env, monitor, task, terminal, horizon, trajectory, q: 0 };
        let (mut rng, mut done) = (self.rng.clone(), self.done);
        let result = episode::run(&mut world, self, &mut done, horizon, total, &mut rng);
        (self.rng, self.done) = (rng, done);
        result
    }

    /// The automaton state as the learner sees it.
    const fn seen(&self, q: u32) -> u32 {
        if self.automaton { q } else { 0 }
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
        self.done.steps
    }
}

impl Agent for WholeLearner {
    type State = usize;
    type Error = Error;

    /// ε-greedy.
    fn act<R: Rng + ?Sized>(&mut self, &s: &usize, q: u32, steps: u64, rng: &mut R) -> usize {
        let epsilon = self.settings.epsilon.at(steps);
        if epsilon >= 1.0 || unit(rng) < epsilon {
            below(self.q.actions(), rng)
        } else {
            self.q.greedy(self.seen(q), s) as usize
        }
    }

    fn learn<W: World<State = usize, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        _world: &W,
        seen: &Seen<'_, usize>,
        _rng: &mut R,
    ) -> Result<(), Self::Error> {
        let (q, to) = (self.seen(seen.q), self.seen(seen.read.to));
        let best = if seen.terminated { 0.0 } else { self.q.max(to, *seen.to) };
        let target = seen.paid + self.settings.gamma * best;
        let entry = (q as usize * self.q.states() + seen.s) * self.q.actions() + seen.action;
        let visits = &mut self.visits[entry];
        let alpha = self.settings.alpha.at(u64::from(*visits));
        *visits = visits.saturating_add(1);
        let value = &mut self.q.row_mut(q, *seen.s)[seen.action];
        *value += alpha * (target - *value);
        Ok(())
    }
}

/// A finite environment that pays for whole trajectories.
struct Whole<'a, E: FiniteEnv, M> {
    env: &'a mut E,
    monitor: &'a M,
    task: &'a Labelled,
    terminal: Terminal,
    horizon: u32,
    trajectory: Vec<E::State>,
    q: u32,
}

impl<E: FiniteEnv, M: Monitor<E::State>> Whole<'_, E, M> {
    fn pays(&self, end: Option<End>) -> Result<f64, Error> {
        match self.terminal {
            Terminal::Satisfaction => Ok(f64::from(u8::from(end == Some(End::Accepted)))),
            Terminal::Robustness { bound } => {
                Ok(self.monitor.trajectory_robustness(&self.trajectory)?.clamp(-bound, bound))
            }
        }
    }
}

impl<E: FiniteEnv, M: Monitor<E::State>> World for Whole<'_, E, M> {
    type State = usize;
    type Error = Error;

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<usize, Error> {
        self.trajectory.clear();
        self.trajectory.push(self.env.reset(rng));
        let s = self.env.state_index();
        self.q = self.task.start(s);
        Ok(s)
    }

    /// The last step of an episode pays for all of it, and nothing can be had after it.
    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Result<Step<usize>, Error> {
        let Step { state, terminated, truncated, .. } = self.env.step(action, rng);
        self.trajectory.push(state);
        let s = self.env.state_index();
        self.q = self.task.next(self.q, s);
        let end = self.task.end(self.q);
        let cut = terminated || truncated || self.trajectory.len() > self.horizon as usize;
        let last = cut || end.is_some();
        let reward = if last { self.pays(end)? } else { 0.0 };
        Ok(Step { state: s, reward, terminated: last, truncated: false })
    }

    fn read(&self, q: u32, &s: &usize) -> Result<Move, Error> {
        let to = self.task.next(q, s);
        Ok(Move { to, paid: 0.0, over: self.task.end(to).is_some() })
    }
}
