//! Tables as worlds and agents: what [`Learner`](super::Learner) runs episodes with.
//!
//! This is the inner loop of learning, 12 to 40 ns a step, and what looks odd here is measured. Moves
//! are laid out for every pair, so reading a state is one look-up and not two. The number of actions
//! and the recipe are known when a loop is compiled ([`Fixed`], `PLAIN`), which makes it a fifth
//! faster: rows are unrolled, and branches on settings go. Functions are forced inline, for calls
//! would spill the random generator and the table's address at each step.
//!
//! It evaluates no predicate and never looks at the model: the environment may be anything that
//! numbers its states. What it may rely on: [`IndexedWorld`] was checked to have the sizes of the
//! table, so entries are indexed without a second look.

use alloc::vec::Vec;
use core::convert::Infallible;

use rand::Rng;

use super::{Experience, Settings, TrainError};
use crate::augmented::{Labelled, Payment};
use crate::env::{FiniteEnv, Step, below, unit};
use crate::episode::{Agent, Monitored, Move, Transition};
use crate::q::{argmax, largest};
use crate::reward::Rewards;

/// A finite environment beside a task, states as numbers: reading one is a single look-up.
///
/// Where the environment terminates, what the task pays may be another amount
/// ([`Mode::Shaped`](crate::reward::Mode::Shaped)); that is looked up apart, for it is rare.
///
/// `moves` takes 16 bytes for each pair, more than the two tables it is made of, and spares the inner
/// loop the class of s' and a branch on how the reward is indexed.
pub(super) struct IndexedWorld<'a, E> {
    env: &'a mut E,
    task: Labelled,
    states: usize,
    /// Where each (q, s') leads and what the task pays for it, indexed `q * states + s'`.
    moves: Vec<Move>,
    /// What the task pays for a move with which the environment ends.
    last: Payment,
    /// The weight of the environment's own reward.
    environment: f64,
}

impl<'a, E> IndexedWorld<'a, E> {
    pub(super) fn new(env: &'a mut E, task: &Labelled, rewards: &Rewards) -> Self {
        let (payment, class) = (task.payment(rewards), &task.tables().class);
        let moves = (0..task.pairs()).map(|pair| {
            let (q, s) = ((pair / task.states()) as u32, pair % task.states());
            let to = task.next(q, s);
            Move { to, reward: payment.get(q, s, class[s]), over: task.end(to).is_some() }
        });
        Self {
            env,
            states: task.states(),
            moves: moves.collect(),
            last: task.last_payment(rewards),
            environment: rewards.environment(),
            task: task.clone(),
        }
    }

    /// What the task does on the last step of the environment. Cold, so that the loop does not make
    /// room for it.
    #[cold]
    fn read_last(&self, q: u32, s: usize) -> Move {
        let reward = self.last.get(q, s, self.task.tables().class[s]);
        Move { to: self.task.next(q, s), reward, over: true }
    }
}

impl<E: FiniteEnv> Monitored for IndexedWorld<'_, E> {
    type State = usize;
    type Error = Infallible;

    #[inline(always)]
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<usize, Infallible> {
        Ok(self.env.reset_index(rng))
    }

    #[inline(always)]
    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<usize>, Infallible> {
        Ok(self.env.step_index(action, rng))
    }

    #[inline(always)]
    fn read(&self, q: u32, step: &Step<usize>) -> Result<Move, Infallible> {
        let read = if step.terminated {
            self.read_last(q, step.state)
        } else {
            self.moves[q as usize * self.states + step.state]
        };
        Ok(Move { reward: read.reward + self.environment * step.reward, ..read })
    }
}

/// How many actions there are: the length of a row.
///
/// A trait and not a const generic alone, for most worlds have a number of actions for which no loop
/// was compiled; those go through `usize`.
pub(super) trait Width: Copy {
    fn get(self) -> usize;
}

/// A number of actions that is known when this is compiled: rows are unrolled.
#[derive(Clone, Copy)]
pub(super) struct Fixed<const A: usize>;

impl<const A: usize> Width for Fixed<A> {
    #[inline(always)]
    fn get(self) -> usize {
        A
    }
}

impl Width for usize {
    #[inline(always)]
    fn get(self) -> usize {
        self
    }
}

/// A table and what learning it needs. The paper's recipe is `PLAIN`: each step updates the
/// current automaton state alone, and nothing is remembered.
///
/// With counterfactual updates all automaton states share their visits, for each step updates them
/// all: the step size of an entry then depends on (s, a) alone.
///
/// It borrows what the [`Learner`](super::Learner) owns for the time of one call of `train`. Settings
/// are copied, so that they stay in registers.
pub(super) struct Tabular<'a, W, const PLAIN: bool> {
    pub(super) settings: Settings,
    pub(super) gamma: f64,
    /// The automaton states that a counterfactual update visits.
    pub(super) live: Vec<u32>,
    pub(super) states: usize,
    pub(super) width: W,
    /// Values, indexed `(q * states + s) * width + a`.
    pub(super) values: &'a mut [f64],
    /// Earlier updates, indexed alike; without q if all automaton states share them.
    pub(super) visits: &'a mut [u32],
    pub(super) experience: &'a mut Experience,
}

impl<W: Width, const PLAIN: bool> Tabular<'_, W, PLAIN> {
    #[inline(always)]
    pub(super) fn row(&self, q: u32, s: usize) -> &[f64] {
        let width = self.width.get();
        &self.values[(q as usize * self.states + s) * width..][..width]
    }

    /// Whether to explore: with probability ε. A constant ε of 1 draws no random number, so that the
    /// paper's recipe costs none.
    #[inline(always)]
    pub(super) fn explores<R: Rng + ?Sized>(&self, steps: u64, rng: &mut R) -> bool {
        let epsilon = match self.settings.epsilon().fixed() {
            Some(epsilon) => epsilon,
            None => self.settings.epsilon().at(steps),
        };
        epsilon >= 1.0 || unit(rng) < epsilon
    }

    /// The step size of this update.
    ///
    /// A constant one counts no visits: the paper's recipe then writes nothing but the value.
    #[inline(always)]
    fn alpha(&mut self, transition: &Transition<'_, usize>) -> f64 {
        if let Some(alpha) = self.settings.alpha().fixed() {
            return alpha;
        }
        let shared = !PLAIN && self.settings.is_counterfactual();
        let layer = if shared { 0 } else { transition.q as usize * self.states };
        let entry = (layer + transition.s) * self.width.get() + transition.action;
        let visits = &mut self.visits[entry];
        let before = *visits;
        *visits = before.saturating_add(1);
        self.settings.alpha().at(u64::from(before))
    }

    #[inline(always)]
    fn remember(&mut self, s: usize, action: usize, step: &Step<usize>) {
        match step.terminated {
            true => self.experience.push_ending(s, action, step.state),
            false => self.experience.push(s, action, step.state),
        }
    }

    /// Q ← Q + α (r + γ max Q' − Q); the rows of terminal automaton states are 0.
    #[inline(always)]
    fn update(&mut self, q: u32, read: Move, transition: &Transition<'_, usize>, alpha: f64) {
        let Transition { s, action, step, .. } = *transition;
        let best = if step.terminated { 0.0 } else { largest(self.row(read.to, step.state)) };
        let target = read.reward + self.gamma * best;
        let entry = (q as usize * self.states + s) * self.width.get() + action;
        let value = &mut self.values[entry];
        *value += alpha * (target - *value);
    }
}

impl<W: Width, const PLAIN: bool> Agent for Tabular<'_, W, PLAIN> {
    type State = usize;
    type Error = TrainError;

    fn start(&mut self, &s: &usize) {
        if !PLAIN && self.settings.remembers() {
            self.experience.push_start(s);
        }
    }

    /// ε-greedy.
    #[inline(always)]
    fn act<R: Rng + ?Sized>(
        &mut self,
        q: u32,
        &s: &usize,
        steps: u64,
        rng: &mut R,
    ) -> Result<usize, TrainError> {
        let explores = self.explores(steps, rng);
        Ok(if explores { below(self.width.get(), rng) } else { argmax(self.row(q, s)) })
    }

    #[inline(always)]
    fn learn<V: Monitored<State = usize, Error: Into<TrainError>>, R: Rng + ?Sized>(
        &mut self,
        world: &V,
        transition: &Transition<'_, usize>,
        _rng: &mut R,
    ) -> Result<(), TrainError> {
        let Transition { q, s, action, step, read } = *transition;
        if !step.reward.is_finite() {
            // The learner puts the number of the step in: to count here would cost a store each time.
            return Err(TrainError::Reward(0));
        }
        if !PLAIN && self.settings.remembers() {
            self.remember(*s, action, step);
        }
        let alpha = self.alpha(transition);
        if PLAIN || !self.settings.is_counterfactual() {
            self.update(q, read, transition, alpha);
            return Ok(());
        }
        // By index: an iterator would borrow the agent while it is updated.
        for i in 0..self.live.len() {
            let q = self.live[i];
            self.update(q, world.read(q, step).map_err(Into::into)?, transition, alpha);
        }
        Ok(())
    }
}
