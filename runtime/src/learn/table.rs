//! Tables as worlds and agents: what [`Learner`](super::Learner) runs episodes with.
//!
//! This is the inner loop of learning, 11 to 40 ns a step in worlds that fit the caches, and what looks odd
//! here is measured. The number of actions and the recipe are known when a loop is compiled ([`Fixed`], [`Recipe`]), which makes it a fifth
//! faster: rows are unrolled, and branches on settings go. Functions are forced inline, for calls
//! would spill the random generator and the table's address at each step.
//!
//! It evaluates no predicate and never looks at the model: the environment may be anything that
//! numbers its states. What it may rely on: [`IndexedWorld`] was checked to have the sizes of the
//! table, so entries are indexed without a second look.

use alloc::vec::Vec;
use core::marker::PhantomData;

use rand::Rng;

use super::coverage::Coverage;
use super::{Experience, Settings, TrainError};
use crate::augmented::{Labelled, Payment};
use crate::env::{FallibleEnv, Step, below, unit};
use crate::episode::{Agent, Monitored, Move, Transition};
use crate::q::{argmax, largest};
use crate::reward::Rewards;

/// A finite environment beside a task, states as numbers: reading one is a single look-up.
///
/// Where the environment terminates, what the task pays may be another amount
/// ([`Mode::Shaped`](crate::reward::Mode::Shaped)); that is looked up apart, for it is rare.
///
/// Moves are by the kind of s', its class, or where the reward depends on more, s' itself. So they stay in
/// the first cache however large the world is, and what all automaton states make of s' stands side by
/// side: a table for each pair of 10,000 states and 16 automaton states has 2.5 MB.
pub(super) struct IndexedWorld<'a, E> {
    env: &'a mut E,
    task: Labelled,
    /// The kind of each state, times the number of automaton states.
    kind: Vec<u32>,
    /// Where each (q, s') leads and what the task pays for it, indexed `kind + q`.
    moves: Vec<Move>,
    /// What the task pays for a move with which the environment ends.
    last: Payment,
    /// The weight of the environment's own reward.
    environment: f64,
}

impl<'a, E> IndexedWorld<'a, E> {
    pub(super) fn new(env: &'a mut E, task: &Labelled, rewards: &Rewards) -> Self {
        let (payment, class) = (task.payment(rewards), &task.tables().class);
        let width = task.automaton_states();
        let (mut kind, mut moves) = (Vec::with_capacity(task.states()), Vec::new());
        let mut first = alloc::vec![u32::MAX; task.tables().classes];
        for (s, &class) in class.iter().enumerate() {
            let known = &mut first[class as usize];
            if *known == u32::MAX || rewards.needs_robustness() {
                *known = moves.len() as u32;
                moves.extend((0..width).map(|q| {
                    let to = task.next(q, s);
                    Move { to, reward: payment.get(q, s, class), over: task.end(to).is_some() }
                }));
            }
            kind.push(*known);
        }
        Self {
            env,
            kind,
            moves,
            last: task.last_payment(rewards),
            environment: rewards.environment(),
            task: task.clone(),
        }
    }

    /// What the task pays on the last step of the environment. Cold, so that the loop does not make room
    /// for it.
    #[cold]
    fn pays_last(&self, q: u32, s: usize) -> f64 {
        self.last.get(q, s, self.task.tables().class[s])
    }
}

impl<E: FallibleEnv> Monitored for IndexedWorld<'_, E> {
    type State = usize;
    type Error = E::Error;

    #[inline(always)]
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<usize, E::Error> {
        self.env.try_reset(rng)
    }

    #[inline(always)]
    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<usize>, E::Error> {
        self.env.try_step(action, rng)
    }

    #[inline(always)]
    fn read(&self, q: u32, step: &Step<usize>) -> Result<Move, E::Error> {
        let Move { to, mut reward, over } = self.moves[(self.kind[step.state] + q) as usize];
        if step.terminated {
            reward = self.pays_last(q, step.state);
        }
        // Most environments pay nothing, which is known when the loop is compiled.
        if step.reward != 0.0 {
            reward += self.environment * step.reward;
        }
        Ok(Move { to, reward, over: over || step.terminated })
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

/// What is known of the settings when a loop is compiled: branches on them go, and what they need need
/// not be kept in registers.
pub(super) trait Recipe {
    /// Whether values are updated, if that is known.
    const UPDATES: Option<bool>;
    /// Whether it is the paper's: random actions, a constant step size, one update a step, no memory.
    const IS_PAPERS: bool;
}

/// The paper's recipe.
pub(super) struct Paper;

/// All actions explore, and all is remembered: no values are needed on the way.
pub(super) struct Survey;

/// Any other: the settings are asked.
pub(super) struct Any;

impl Recipe for Paper {
    const UPDATES: Option<bool> = Some(true);
    const IS_PAPERS: bool = true;
}

impl Recipe for Survey {
    const UPDATES: Option<bool> = Some(false);
    const IS_PAPERS: bool = false;
}

impl Recipe for Any {
    const UPDATES: Option<bool> = None;
    const IS_PAPERS: bool = false;
}

/// How far apart the rows of a table are.
///
/// A table of (q, s) is read as it is stored, by q. Counterfactual updates read all q of a state: then it is
/// [turned](turn) for the time of learning, so that they stand side by side. With 16 automaton states and
/// 10,000 states that takes a fifth off a step.
#[derive(Clone, Copy)]
pub(super) struct Layout {
    q: usize,
    s: usize,
}

impl Layout {
    #[inline]
    pub(super) const fn by_automaton(states: usize) -> Self {
        Self { q: states, s: 1 }
    }

    #[inline]
    pub(super) const fn by_state(automaton: usize) -> Self {
        Self { q: 1, s: automaton }
    }
}

/// Turns rows of `width` values, indexed `outer * inner + i`, into such that are indexed `i * outer + o`.
#[inline]
pub(super) fn turn(values: &mut [f64], outer: usize, width: usize) {
    let inner = values.len() / (outer * width);
    let mut turned = Vec::with_capacity(values.len());
    for i in 0..inner {
        for o in 0..outer {
            turned.extend_from_slice(&values[(o * inner + i) * width..][..width]);
        }
    }
    values.copy_from_slice(&turned);
}

/// What a step does, by the settings: asked once, for a step would ask each time.
#[derive(Clone, Copy)]
pub(super) struct Plan {
    counterfactual: bool,
    remembers: bool,
    covers: bool,
    updates: bool,
    /// ε, if it never changes.
    epsilon: Option<f64>,
    /// The first step size, and whether it is that of all updates.
    alpha: f64,
    same_alpha: bool,
}

impl Plan {
    #[inline]
    pub(super) fn of(settings: &Settings) -> Self {
        Self {
            counterfactual: settings.is_counterfactual(),
            remembers: settings.remembers(),
            covers: settings.covers(),
            updates: settings.updates_values(),
            epsilon: settings.epsilon().fixed(),
            alpha: settings.alpha().at(0),
            same_alpha: settings.alpha().fixed().is_some(),
        }
    }

    /// Whether each step updates all automaton states.
    #[inline]
    pub(super) const fn updates_all(&self) -> bool {
        self.updates && self.counterfactual
    }
}

/// A table and what learning it needs, in a loop for the recipe `C`.
///
/// With counterfactual updates all automaton states share their visits, for each step updates them
/// all: the step size of an entry then depends on (s, a) alone.
///
/// It borrows what the [`Learner`](super::Learner) owns for the time of one call of `train`. Settings
/// are copied, so that they stay in registers.
pub(super) struct Tabular<'a, W, C> {
    pub(super) settings: Settings,
    pub(super) plan: Plan,
    pub(super) recipe: PhantomData<C>,
    pub(super) gamma: f64,
    /// The automaton states that a counterfactual update visits.
    pub(super) live: Vec<u32>,
    pub(super) states: usize,
    pub(super) width: W,
    pub(super) layout: Layout,
    pub(super) values: &'a mut [f64],
    /// Earlier updates, indexed `(q * states + s) * width + a`; without q if all automaton states share
    /// them.
    pub(super) visits: &'a mut [u32],
    pub(super) experience: &'a mut Experience,
    pub(super) coverage: &'a mut Coverage,
}

impl<W: Width, C: Recipe> Tabular<'_, W, C> {
    #[inline(always)]
    pub(super) fn row(&self, q: u32, s: usize) -> &[f64] {
        &self.values[self.entry(q, s)..][..self.width.get()]
    }

    /// Where the row of (q, s) begins.
    #[inline(always)]
    fn entry(&self, q: u32, s: usize) -> usize {
        // Where nothing turns the table, its layout is known.
        let Layout { q: of_q, s: of_s } =
            if C::IS_PAPERS { Layout::by_automaton(self.states) } else { self.layout };
        (q as usize * of_q + s * of_s) * self.width.get()
    }

    /// Whether to explore: with probability ε. A constant ε of 1 draws no random number, so that the
    /// paper's recipe costs none.
    #[inline(always)]
    pub(super) fn explores<R: Rng + ?Sized>(&self, steps: u64, rng: &mut R) -> bool {
        if C::IS_PAPERS || C::UPDATES == Some(false) {
            return true;
        }
        let epsilon = match self.plan.epsilon {
            Some(epsilon) => epsilon,
            None => self.settings.epsilon().at(steps),
        };
        epsilon >= 1.0 || unit(rng) < epsilon
    }

    #[inline(always)]
    fn covers(&self) -> bool {
        !C::IS_PAPERS && self.plan.covers
    }

    #[inline(always)]
    fn remembers(&self) -> bool {
        !C::IS_PAPERS && (C::UPDATES == Some(false) || self.plan.remembers)
    }

    #[inline(always)]
    fn is_counterfactual(&self) -> bool {
        !C::IS_PAPERS && self.plan.counterfactual
    }

    /// The step size of this update.
    ///
    /// A constant one counts no visits: the paper's recipe then writes nothing but the value.
    #[inline(always)]
    fn alpha(&mut self, transition: &Transition<'_, usize>) -> f64 {
        if C::IS_PAPERS || self.plan.same_alpha {
            return self.plan.alpha;
        }
        let layer = if self.is_counterfactual() { 0 } else { transition.q as usize * self.states };
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

    /// Q ← Q + α (r + γ max Q' − Q), and nothing is to be had where an episode is over.
    #[inline(always)]
    fn update(&mut self, q: u32, read: Move, transition: &Transition<'_, usize>, alpha: f64) {
        let Transition { s, action, step, .. } = *transition;
        let best = if read.over { 0.0 } else { largest(self.row(read.to, step.state)) };
        let target = read.reward + self.gamma * best;
        let entry = self.entry(q, *s) + action;
        let value = &mut self.values[entry];
        *value += alpha * (target - *value);
    }
}

impl<W: Width, C: Recipe> Agent for Tabular<'_, W, C> {
    type State = usize;
    type Error = TrainError;

    #[inline(always)]
    fn start(&mut self, &s: &usize) {
        if self.remembers() {
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
        if !self.explores(steps, rng) {
            return Ok(argmax(self.row(q, s)));
        }
        Ok(if self.covers() {
            self.coverage.act(s, self.width)
        } else {
            below(self.width.get(), rng)
        })
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
        if self.remembers() {
            self.remember(*s, action, step);
        }
        if self.covers() {
            self.coverage.learn((*s, action), step.state, read.over, self.width);
        }
        if !C::UPDATES.unwrap_or(self.plan.updates) {
            return Ok(());
        }
        let alpha = self.alpha(transition);
        if !self.is_counterfactual() {
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
