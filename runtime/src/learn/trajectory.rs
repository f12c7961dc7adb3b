//! Baselines without progress: learning from whole trajectories.
//!
//! What the paper improves upon: the reward comes at the end of an episode only, as the robustness
//! of the whole trajectory (Li et al. 2016) or as 1 if it satisfies the task; and the learner
//! observes the state of the world alone, or the automaton state too. `docs/studies/curves.md` shows
//! what that costs: a learner that does not observe the automaton state has no memory of what is done.

use alloc::vec::Vec;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{Rng, SeedableRng};

use super::{Settings, TrainError};
use crate::augmented::Labelled;
use crate::env::{FiniteEnv, Step, below, unit};
use crate::episode::{self, Agent, Elapsed, Monitored, Move, Transition};
use crate::monitor::Monitor;
use crate::policy::Policy;
use crate::q::QTable;
use crate::reward::End;
use crate::task::Error;

/// What the end of an episode pays.
///
/// ```
/// use tltl::learn::{Observation, TerminalReward, TrajectoryLearner};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row, and a robustness that grows with the place: ρ(F far) is the largest x - 3.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let far = tltl! { |s: &usize| F ({ *s } > 3) };
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &far)?;
/// let values = [TerminalReward::Satisfaction, TerminalReward::Robustness].map(|paid| {
///     let settings = Settings::paper().with_rewards(Rewards::default().with_gamma(0.5).unwrap());
///     let mut learner = TrajectoryLearner::new(&task, settings, paid, Observation::World, 1);
///     learner.train(&mut env, &far, 10_000).unwrap();
///     learner.policy()
/// });
/// assert_eq!(values.map(|policy| policy.act(0, 3)), [1, 1], "beside the goal both go there");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TerminalReward {
    /// The robustness of the whole trajectory, clamped to ± the
    /// [bound](crate::reward::Rewards::bound) of the rewards.
    Robustness,
    /// 1 if the task is satisfied.
    Satisfaction,
}

/// What a learner observes.
///
/// What it costs to leave the automaton out: where the same cell asks for different actions before and
/// after something is done, a learner without q has one action for both.
///
/// ```
/// use tltl::learn::{Observation, TerminalReward, TrajectoryLearner};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // First the right end of five cells, then the left one.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let there_and_back = tltl! { |s: &usize| ({ *s } == 4) T ({ *s } == 0) };
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &there_and_back)?;
/// let problem = Problem::new(env.dynamics(), &task)?;
/// let worth = [Observation::World, Observation::WorldAndAutomaton].map(|observation| {
///     let paid = TerminalReward::Satisfaction;
///     let mut learner = TrajectoryLearner::new(&task, Settings::paper(), paid, observation, 1);
///     learner.train(&mut env, &there_and_back, 20_000).unwrap();
///     problem.evaluate(&learner.policy()).unwrap().mean_satisfied()
/// });
/// assert!(worth[0] < 0.5 && worth[1] > 0.999, "{worth:?}");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Observation {
    /// The state of the world alone: every automaton state gets the same values.
    World,
    /// The state of the world and the automaton state.
    WorldAndAutomaton,
}

/// A Q-learner that is paid at the end of episodes.
///
/// Of [`Settings`] it reads γ, the bound, α, ε, the horizon and the initial value. Episodes end where
/// the task is decided, or at the horizon, which for this reward *is* the end and not a cut.
///
/// ```
/// use tltl::learn::{Observation, TerminalReward, TrajectoryLearner};
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let end = tltl! { |s: &usize| F ({ *s } == 4) };
/// let mut env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &end)?;
/// let paid = TerminalReward::Satisfaction;
/// let mut learner =
///     TrajectoryLearner::new(&task, Settings::paper(), paid, Observation::World, 1);
/// learner.train(&mut env, &end, 10_000)?;
/// assert_eq!(learner.policy().act(0, 0), 1);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct TrajectoryLearner {
    settings: Settings,
    terminal: TerminalReward,
    observation: Observation,
    q: QTable,
    visits: Vec<u32>,
    rng: Xoshiro256PlusPlus,
    elapsed: Elapsed,
}

impl TrajectoryLearner {
    /// A learner of `task` that is paid by `terminal`, seeded.
    #[must_use]
    #[inline]
    pub fn new(
        task: &Labelled,
        settings: Settings,
        terminal: TerminalReward,
        observation: Observation,
        seed: u64,
    ) -> Self {
        let rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let q = QTable::filled(task, settings.initial());
        let visits = alloc::vec![0; q.values().len()];
        Self { settings, terminal, observation, q, visits, rng, elapsed: Elapsed::default() }
    }

    /// Runs whole episodes until `total` environment steps have been taken since the beginning.
    /// `monitor` is the task of the learner's table.
    ///
    /// # Errors
    /// If the environment is of another world, or a predicate is not a number at a state that was
    /// met.
    pub fn train<E: FiniteEnv, M: Monitor<E::State>>(
        &mut self,
        env: &mut E,
        monitor: &M,
        total: u64,
    ) -> Result<(), TrainError> {
        let task = self.q.task().clone();
        task.check_world("an environment", env.states(), env.actions())?;
        let (terminal, horizon) = (self.terminal, self.settings.horizon());
        let (bound, trajectory) = (self.settings.rewards().bound(), Vec::new());
        let mut world = Whole { env, monitor, task, terminal, bound, horizon, trajectory, q: 0 };
        let (mut rng, mut elapsed) = (self.rng.clone(), self.elapsed);
        let result = episode::run(&mut world, self, &mut elapsed, horizon, total, &mut rng);
        (self.rng, self.elapsed) = (rng, elapsed);
        result
    }

    /// The automaton state as the learner observes it.
    #[inline]
    const fn seen(&self, q: u32) -> u32 {
        match self.observation {
            Observation::World => 0,
            Observation::WorldAndAutomaton => q,
        }
    }

    /// The greedy policy.
    #[must_use]
    #[inline]
    pub fn policy(&self) -> Policy {
        let (task, states) = (self.q.task(), self.q.task().states());
        let greedy = |pair| self.q.greedy(self.seen((pair / states) as u32), pair % states) as u32;
        Policy::from_table(task, (0..task.pairs()).map(greedy).collect())
    }

    /// Environment steps so far.
    #[must_use]
    #[inline]
    pub const fn steps(&self) -> u64 {
        self.elapsed.steps
    }
}

impl Agent for TrajectoryLearner {
    type State = usize;
    type Error = TrainError;

    /// ε-greedy.
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        &s: &usize,
        steps: u64,
        rng: &mut R,
    ) -> Result<usize, TrainError> {
        let epsilon = self.settings.epsilon().at(steps);
        let explores = epsilon >= 1.0 || unit(rng) < epsilon;
        Ok(if explores {
            below(self.q.task().actions(), rng)
        } else {
            self.q.greedy(self.seen(q), s)
        })
    }

    fn learn<W: Monitored<State = usize, Error: Into<TrainError>>, R: Rng + ?Sized>(
        &mut self,
        _world: &W,
        transition: &Transition<'_, usize>,
        _rng: &mut R,
    ) -> Result<(), TrainError> {
        let Transition { q, s, action, step, read } = *transition;
        let (q, to) = (self.seen(q), self.seen(read.to));
        let best = if step.terminated { 0.0 } else { self.q.max(to, step.state) };
        let target = read.reward + self.settings.rewards().gamma() * best;
        let entry = self.q.task().pair(q, *s) * self.q.task().actions() + action;
        let visits = &mut self.visits[entry];
        let alpha = self.settings.alpha().at(u64::from(*visits));
        *visits = visits.saturating_add(1);
        let value = &mut self.q.row_mut(q, *s)[action];
        *value += alpha * (target - *value);
        Ok(())
    }
}

/// A finite environment that pays for whole trajectories. It keeps them as the environment's own
/// states, for robustness is computed from predicates.
///
/// Robustness is that of the whole trajectory, so it must be kept as states: memory grows with an
/// episode, up to the horizon, and is used again by the next.
struct Whole<'a, E: FiniteEnv, M> {
    env: &'a mut E,
    monitor: &'a M,
    task: Labelled,
    terminal: TerminalReward,
    bound: f64,
    horizon: u64,
    trajectory: Vec<E::State>,
    q: u32,
}

impl<E: FiniteEnv, M: Monitor<E::State>> Whole<'_, E, M> {
    fn pays(&self, end: Option<End>) -> Result<f64, Error> {
        match self.terminal {
            TerminalReward::Satisfaction => Ok(f64::from(u8::from(end == Some(End::Accepted)))),
            TerminalReward::Robustness => {
                let rho = self.monitor.trajectory_robustness(&self.trajectory)?;
                Ok(rho.clamp(-self.bound, self.bound))
            }
        }
    }
}

impl<E: FiniteEnv, M: Monitor<E::State>> Monitored for Whole<'_, E, M> {
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
        // The trajectory has s_0 too, so that it is longer than the horizon after as many steps.
        let cut = terminated || truncated || self.trajectory.len() as u64 > self.horizon;
        let last = cut || end.is_some();
        let reward = if last { self.pays(end)? } else { 0.0 };
        Ok(Step { state: s, reward, terminated: last, truncated: false })
    }

    fn read(&self, q: u32, step: &Step<usize>) -> Result<Move, Error> {
        let to = self.task.next(q, step.state);
        let over = step.terminated || self.task.end(to).is_some();
        Ok(Move { to, reward: step.reward, over })
    }
}
