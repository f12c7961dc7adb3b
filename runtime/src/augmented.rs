//! The FSA-augmented MDP (paper, Definition 3): states (s, q) of a world and an automaton.
//!
//! [`Augmented`] runs any environment beside any [`Monitor`]. [`Labelled`] is the same for finite
//! worlds as tables: states that no automaton state tells apart share a class, so that learners
//! and solvers evaluate no predicate in their loops.
//!
//! The automaton reads *every* state, `s_0` included: `q_0' = δ(q_0, s_0)` on reset, which pays
//! nothing and may already be accepted or lost, then `q_{t+1} = δ(q_t, s_{t+1})`. (The paper's
//! Eq. 3A2 moves on `s` and its Eq. 3A3 pays on `s'`; read literally a goal is paid twice.)
//! Reaching the accepting state or the trap terminates, a horizon truncates.
//!
//! What is optimal for a reward need not be what the task wants: `Progress` is paid per edge, and
//! so may prefer longer ways, or a risk. On `!c U a` of the paper's grid the largest possible
//! P(satisfied) is 98.49 %; the `Progress`-optimal policy has 98.13 %, the `Literal` one 50.0 %.
//! Judge policies by [`Problem::certify`](crate::solve::Problem::certify), and where a task has a trap
//! take [`Settings::safe`](crate::learn::Settings::safe): its optimum gives away at most 0.011 % of
//! P(satisfied) on these two tasks and on five more, each on 101 layouts (`docs/studies/rewards.md`).

mod joint;
mod reward;

use alloc::vec::Vec;

use rand::Rng;

pub use joint::JointError;
use reward::Ends;
pub(crate) use reward::Moves;
pub use reward::{End, Reward, Rewards};

use crate::env::{Env, FiniteEnv, Step};
use crate::interner::Interner;
use crate::learn::episode::{Move, World};
use crate::model::FiniteModel;
use crate::monitor::Monitor;
use crate::task::Error;

/// Any environment beside any task: an environment over (s, q).
///
/// A NaN in a state is an error, so its methods are those of [`Env`] with a `Result`.
#[derive(Clone, Debug)]
pub struct Augmented<E, M> {
    env: E,
    monitor: M,
    moves: Moves,
    q: u32,
}

impl<E: Env, M: Monitor<E::State>> Augmented<E, M> {
    /// `env` under the task `monitor`; `gamma` is the learner's discount factor, which only
    /// [`Reward::Shaped`] reads.
    pub fn new(env: E, monitor: M, rewards: Rewards, gamma: f64) -> Self {
        let moves = Moves::new(&monitor, rewards, gamma);
        Self { env, monitor, moves, q: 0 }
    }

    /// Starts an episode: the state s_0 and the automaton state that has read it. The episode may
    /// be over already; see [`Self::end`].
    ///
    /// # Errors
    /// If a predicate is not a number at s_0.
    pub fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<(E::State, u32), Error> {
        let state = self.env.reset(rng);
        self.q = self.monitor.next(0, &state)?;
        Ok((state, self.q))
    }

    /// Takes an action; `terminated` where the task ended or the environment did.
    ///
    /// # Errors
    /// If a predicate is not a number at s'.
    pub fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<(E::State, u32)>, Error> {
        let step = self.env.step(action, rng);
        let Move { to, paid, over } = self.read(self.q, &step.state)?;
        self.q = to;
        Ok(Step {
            state: (step.state, to),
            reward: paid + self.moves.rewards.environment * step.reward,
            terminated: step.terminated || over,
            truncated: step.truncated,
        })
    }

    /// What reading `s` does at any automaton state `q`, not only the current one.
    ///
    /// # Errors
    /// If a predicate is not a number at `s`.
    pub fn read(&self, q: u32, s: &E::State) -> Result<Move, Error> {
        self.moves.read(&self.monitor, q, s)
    }

    /// How the task has ended, if it has.
    pub fn end(&self) -> Option<End> {
        self.moves.end(self.q)
    }

    /// The automaton state.
    pub const fn q(&self) -> u32 {
        self.q
    }

    /// The environment.
    pub const fn env(&self) -> &E {
        &self.env
    }

    /// The task.
    pub const fn monitor(&self) -> &M {
        &self.monitor
    }
}

/// Its states as they are. The loop of episodes holds q itself: reset before stepping by hand again.
impl<E: Env, M: Monitor<E::State>> World for Augmented<E, M> {
    type State = E::State;
    type Error = Error;

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<E::State, Error> {
        Ok(self.env.reset(rng))
    }

    fn step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<E::State>, Error> {
        let step = self.env.step(action, rng);
        Ok(Step { reward: self.moves.rewards.environment * step.reward, ..step })
    }

    fn read(&self, q: u32, s: &E::State) -> Result<Move, Error> {
        Self::read(self, q, s)
    }
}

/// A task over a finite world, as tables: which class each state is in, and where each automaton
/// state goes on each class.
///
/// Classes are numbered in the order of the states that show them first.
#[derive(Clone, Debug, PartialEq)]
pub struct Labelled {
    class: Vec<u32>,
    classes: usize,
    next: Vec<u32>,
    ends: Ends,
    robustness: Vec<f64>,
}

impl Labelled {
    /// The table of `monitor` over a world's states, in the order of their numbers.
    ///
    /// # Errors
    /// If a predicate is not a number at one of them; `instant` is then the state's number.
    pub fn new<S>(
        states: impl IntoIterator<Item = S>,
        monitor: &(impl Monitor<S> + ?Sized),
    ) -> Result<Self, Error> {
        let mut columns = Columns { class: Vec::new(), seen: Interner::new() };
        let mut column = alloc::vec![0; monitor.states() as usize];
        for (i, s) in states.into_iter().enumerate() {
            for (q, to) in column.iter_mut().enumerate() {
                *to = monitor.next(q as u32, &s).map_err(|e| Error { instant: Some(i), ..e })?;
            }
            columns.push(&column);
        }
        Ok(columns.into_labelled(Ends::new(monitor)))
    }

    /// The table of `monitor` over the states of `model`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_model<M: FiniteModel>(
        model: &M,
        monitor: &(impl Monitor<M::State> + ?Sized),
    ) -> Result<Self, Error> {
        Self::new((0..model.states()).map(|s| model.state(s)), monitor)
    }

    /// The table of `monitor` over the states of `env`.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_env<E: FiniteEnv>(
        env: &E,
        monitor: &(impl Monitor<E::State> + ?Sized),
    ) -> Result<Self, Error> {
        Self::new((0..env.states()).map(|s| env.state(s)), monitor)
    }

    /// The same table with ρ(s, D_φ^q) for all q and s, which [`Reward::Robustness`] needs: 8
    /// bytes for each pair.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn with_robustness<S>(
        mut self,
        states: impl IntoIterator<Item = S>,
        monitor: &(impl Monitor<S> + ?Sized),
    ) -> Result<Self, Error> {
        let mut robustness = alloc::vec![0.0; self.pairs()];
        for (i, s) in states.into_iter().enumerate() {
            for q in self.live() {
                let rho = monitor.progress_robustness(q, &s);
                robustness[self.pair(q, i)] = rho.map_err(|e| Error { instant: Some(i), ..e })?;
            }
        }
        self.robustness = robustness;
        Ok(self)
    }

    /// The number of states of the world.
    #[inline]
    #[must_use]
    pub fn states(&self) -> usize {
        self.class.len()
    }

    /// The number of states of the automaton, the trap included.
    #[must_use]
    pub fn automaton_states(&self) -> u32 {
        self.ends.of.len() as u32
    }

    /// The number of classes.
    #[inline]
    #[must_use]
    pub fn classes(&self) -> usize {
        self.classes
    }

    /// The class of each state of the world.
    #[inline]
    #[must_use]
    pub fn class(&self) -> &[u32] {
        &self.class
    }

    /// The next automaton state, indexed `q * classes + class`.
    #[inline]
    #[must_use]
    pub fn table(&self) -> &[u32] {
        &self.next
    }

    /// δ(q, s): the automaton state after `q` has read `s`.
    #[inline]
    #[must_use]
    pub fn next(&self, q: u32, s: usize) -> u32 {
        self.next[q as usize * self.classes + self.class[s] as usize]
    }

    /// The automaton state in which an episode starts that starts in `s`.
    #[inline]
    #[must_use]
    pub fn start(&self, s: usize) -> u32 {
        self.next(0, s)
    }

    /// How the task has ended at `q`, if it has.
    #[inline]
    #[must_use]
    pub fn end(&self, q: u32) -> Option<End> {
        self.ends.of(q)
    }

    /// The automaton states in which the task goes on.
    pub fn live(&self) -> impl Iterator<Item = u32> + use<> {
        let ends = self.ends.of.clone();
        (0..ends.len() as u32).filter(move |&q| ends[q as usize].is_none())
    }

    /// The number of pairs (q, s).
    #[inline]
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.ends.of.len() * self.class.len()
    }

    /// The number of the pair (q, s): `q * states + s`.
    #[inline]
    #[must_use]
    pub fn pair(&self, q: u32, s: usize) -> usize {
        q as usize * self.class.len() + s
    }

    /// What each move pays under `rewards`.
    ///
    /// # Panics
    /// If the mode is [`Reward::Robustness`] and the table was made without
    /// [robustness](Self::with_robustness).
    #[must_use]
    pub fn payment(&self, rewards: &Rewards, gamma: f64) -> Payment {
        let pays = |q, to, rho| rewards.pays(&self.ends, q, to, gamma, rho);
        if !rewards.needs_robustness() {
            return self.payment_by(&|q, to| pays(q, to, 0.0));
        }
        assert!(!self.robustness.is_empty(), "this reward needs a table `with_robustness`");
        self.payment_by_state(&|q, s| pays(q, self.next(q, s), self.robustness[self.pair(q, s)]))
    }

    /// A payment for each move, as `pays(q, q')` says.
    pub(crate) fn payment_by(&self, pays: &dyn Fn(u32, u32) -> f64) -> Payment {
        let mut table = Vec::with_capacity(self.next.len());
        for (i, &to) in self.next.iter().enumerate() {
            table.push(pays((i / self.classes) as u32, to));
        }
        Payment { table, width: self.classes, by_state: false }
    }

    /// A payment for each automaton state and state, as `pays(q, s')` says.
    pub(crate) fn payment_by_state(&self, pays: &dyn Fn(u32, usize) -> f64) -> Payment {
        let mut table = Vec::with_capacity(self.pairs());
        for q in 0..self.automaton_states() {
            for s in 0..self.states() {
                table.push(pays(q, s));
            }
        }
        Payment { table, width: self.states(), by_state: true }
    }
}

/// What every move of a [`Labelled`] task pays.
#[derive(Clone, Debug, PartialEq)]
pub struct Payment {
    table: Vec<f64>,
    width: usize,
    by_state: bool,
}

impl Payment {
    /// What reading `s` in `q` pays; `class` is the class of `s`.
    #[inline]
    #[must_use]
    pub fn get(&self, q: u32, s: usize, class: u32) -> f64 {
        self.table[q as usize * self.width + if self.by_state { s } else { class as usize }]
    }
}

/// Columns of the transition table, hash-consed.
struct Columns {
    class: Vec<u32>,
    seen: Interner<u32>,
}

impl Columns {
    fn push(&mut self, column: &[u32]) {
        self.class.push(self.seen.number(column));
    }

    fn into_labelled(self, ends: Ends) -> Labelled {
        let classes = self.seen.items().len();
        let mut next = alloc::vec![0; ends.of.len() * classes];
        for (class, column) in self.seen.items().iter().enumerate() {
            for (q, &to) in column.iter().enumerate() {
                next[q * classes + class] = to;
            }
        }
        Labelled { class: self.class, classes, next, ends, robustness: Vec::new() }
    }
}
