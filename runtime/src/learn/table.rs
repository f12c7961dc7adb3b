//! Tables as worlds and agents: what [`Learner`](super::Learner) runs episodes with.

use alloc::vec::Vec;
use core::convert::Infallible;

use rand::Rng;

use super::episode::{Agent, Move, Seen, World};
use super::{Experience, Schedule, Settings};
use crate::augmented::Labelled;
use crate::env::{FiniteEnv, Step, below, unit};
use crate::q::{argmax, largest};

/// A finite environment beside a task, states as numbers: reading one is a single look-up.
pub(super) struct Numbered<'a, E> {
    env: &'a mut E,
    states: usize,
    /// Where each (q, s') leads and what it pays, indexed `q * states + s'`.
    moves: Vec<Move>,
    /// The weight of the environment's own reward.
    environment: f64,
}

impl<'a, E> Numbered<'a, E> {
    pub(super) fn new(env: &'a mut E, task: &Labelled, settings: &Settings) -> Self {
        let payment = task.payment(&settings.rewards, settings.gamma);
        let moves = (0..task.pairs()).map(|pair| {
            let (q, s) = ((pair / task.states()) as u32, pair % task.states());
            let to = task.next(q, s);
            let paid = payment.get(q, s, task.class()[s]);
            Move { to, paid, over: task.end(to).is_some() }
        });
        Self {
            env,
            states: task.states(),
            moves: moves.collect(),
            environment: settings.rewards.environment,
        }
    }
}

impl<E: FiniteEnv> World for Numbered<'_, E> {
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
        let step = self.env.step_index(action, rng);
        Ok(Step { reward: self.environment * step.reward, ..step })
    }

    #[inline(always)]
    fn read(&self, q: u32, &s: &usize) -> Result<Move, Infallible> {
        Ok(self.moves[q as usize * self.states + s])
    }
}

/// How many actions there are: the length of a row.
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
pub(super) struct Tabular<'a, W, const PLAIN: bool> {
    pub(super) settings: Settings,
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

    /// The step size of this update.
    #[inline(always)]
    fn alpha(&mut self, seen: &Seen<'_, usize>) -> f64 {
        if let Schedule::Constant(alpha) = self.settings.alpha {
            return alpha;
        }
        let shared = !PLAIN && self.settings.counterfactual;
        let layer = if shared { 0 } else { seen.q as usize * self.states };
        let visits = &mut self.visits[(layer + seen.s) * self.width.get() + seen.action];
        let before = *visits;
        *visits = before.saturating_add(1);
        self.settings.alpha.at(u64::from(before))
    }

    /// Q ← Q + α (r + γ max Q' − Q); the rows of terminal automaton states are 0.
    #[inline(always)]
    fn update(&mut self, q: u32, read: Move, seen: &Seen<'_, usize>, alpha: f64) {
        let best = if seen.terminated { 0.0 } else { largest(self.row(read.to, *seen.to)) };
        let target = read.paid + seen.paid + self.settings.gamma * best;
        let entry = (q as usize * self.states + seen.s) * self.width.get() + seen.action;
        let value = &mut self.values[entry];
        *value += alpha * (target - *value);
    }
}

impl<W: Width, const PLAIN: bool> Agent for Tabular<'_, W, PLAIN> {
    type State = usize;
    type Error = Infallible;

    fn start(&mut self, &s: &usize) {
        if !PLAIN && self.settings.remember {
            self.experience.start(s);
        }
    }

    /// ε-greedy.
    #[inline(always)]
    fn act<R: Rng + ?Sized>(&mut self, &s: &usize, q: u32, steps: u64, rng: &mut R) -> usize {
        let epsilon = match self.settings.epsilon {
            Schedule::Constant(epsilon) => epsilon,
            schedule => schedule.at(steps),
        };
        if epsilon >= 1.0 || unit(rng) < epsilon {
            below(self.width.get(), rng)
        } else {
            argmax(self.row(q, s)) as usize
        }
    }

    #[inline(always)]
    fn learn<V: World<State = usize, Error: Into<Self::Error>>, R: Rng + ?Sized>(
        &mut self,
        world: &V,
        seen: &Seen<'_, usize>,
        _rng: &mut R,
    ) -> Result<(), Self::Error> {
        if !PLAIN && self.settings.remember {
            self.experience.push(*seen.s, seen.action, *seen.to);
        }
        let alpha = self.alpha(seen);
        if PLAIN || !self.settings.counterfactual {
            self.update(seen.q, seen.read, seen, alpha);
            return Ok(());
        }
        for i in 0..self.live.len() {
            let q = self.live[i];
            self.update(q, world.read(q, seen.to).map_err(Into::into)?, seen, alpha);
        }
        Ok(())
    }
}
