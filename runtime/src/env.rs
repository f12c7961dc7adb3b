//! Environments: what an agent acts in, as in Gymnasium.
//!
//! [`Env`] is any world; [`FiniteEnv`] is one whose states are numbered; [`ModelEnv`] turns a
//! [`FiniteModel`] into an environment that samples it; [`TimeLimit`] truncates the episodes of
//! another environment; a [`ContinuousEnv`] has vectors as actions. All randomness comes through the `Rng` argument, so a seed fixes a run.
//!
//! `ModelEnv` samples from alias tables (Walker 1977, built as by Vose 1991): a step costs one random
//! word and one look-up, a few nanoseconds, however many outcomes an action has. Probabilities are
//! kept to 2^-32.
//!
//! An environment never knows the task; [`Augmented`](crate::augmented::Augmented) brings the two
//! together.

mod continuous;

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::convert::Infallible;

use rand::Rng;

use crate::model::{Dynamics, FiniteModel, ModelError};
pub use continuous::ContinuousEnv;

/// What one step of an environment gives.
///
/// ```
/// use tltl::env::Step;
///
/// let bump = Step { reward: -1.0, ..Step::to("a wall") };
/// assert!(!bump.terminated && !bump.truncated);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<S> {
    /// The state after the step, s'.
    pub state: S,
    /// What the environment itself pays: a cost of a failed action, say. Tasks pay on top of it.
    pub reward: f64,
    /// The episode is over, and nothing can be had from here on.
    pub terminated: bool,
    /// The episode was cut here; its value goes on.
    pub truncated: bool,
}

impl<S> Step<S> {
    /// A step that pays nothing and ends nothing.
    pub const fn to(state: S) -> Self {
        Self { state, reward: 0.0, terminated: false, truncated: false }
    }
}

/// An environment.
///
/// ```
/// use tltl::prelude::*;
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// /// A lift with floors 0 to 3; every move costs something, and the cellar ends the ride.
/// struct Lift(i32);
///
/// impl Env for Lift {
///     type State = i32;
///     fn actions(&self) -> usize {
///         2
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> i32 {
///         self.0 = (rng.next_u32() % 4) as i32;
///         self.0
///     }
///     fn step<R: Rng + ?Sized>(&mut self, action: usize, _: &mut R) -> Step<i32> {
///         self.0 = (self.0 + [-1, 1][action]).min(3);
///         Step { reward: -0.1, terminated: self.0 < 0, ..Step::to(self.0) }
///     }
///     fn action_name(&self, a: usize) -> String {
///         ["down", "up"][a].into()
///     }
/// }
///
/// let (mut lift, mut rng) = (Lift(0), Xoshiro256PlusPlus::seed_from_u64(1));
/// let floor = lift.reset(&mut rng);
/// let rest = (0..=floor).map(|_| lift.step(0, &mut rng)).last();
/// assert!(rest.is_some_and(|step| step.terminated));
/// ```
pub trait Env {
    /// What an agent observes and predicates read.
    type State;

    /// The number of actions; they are numbered `0..actions()`.
    fn actions(&self) -> usize;

    /// Starts an episode and returns its first state, s_0.
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Self::State;

    /// Takes an action.
    ///
    /// `action` is below [`Self::actions`]; what an implementation does with another number is its own
    /// affair, and to panic is best. After a step that ends the episode nothing is promised until the
    /// next [`Self::reset`].
    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<Self::State>;

    /// What action `a` is called where it is shown.
    fn action_name(&self, a: usize) -> String {
        a.to_string()
    }
}

/// An environment with numbered states: what tabular learners need.
///
/// [`ModelEnv`] is one. An environment of one's own says which state it is in, and what the state of
/// a number is:
///
/// ```
/// use tltl::prelude::*;
/// use tltl::rand::{Rng, SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// /// A dial with ten positions.
/// struct Dial(usize);
///
/// impl Env for Dial {
///     type State = f64;
///     fn actions(&self) -> usize {
///         2
///     }
///     fn reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> f64 {
///         self.0 = 0;
///         self.state(0)
///     }
///     fn step<R: Rng + ?Sized>(&mut self, action: usize, _: &mut R) -> Step<f64> {
///         self.0 = (self.0 + [9, 1][action]) % 10;
///         Step::to(self.state(self.0))
///     }
/// }
///
/// impl FiniteEnv for Dial {
///     fn states(&self) -> usize {
///         10
///     }
///     fn state(&self, s: usize) -> f64 {
///         s as f64 / 10.0
///     }
///     fn state_index(&self) -> usize {
///         self.0
///     }
/// }
///
/// let (mut dial, mut rng) = (Dial(0), Xoshiro256PlusPlus::seed_from_u64(1));
/// dial.reset(&mut rng);
/// assert_eq!(dial.step_index(0, &mut rng).state, 9);
/// ```
///
/// Numbers and states are two names of one thing: `state(state_index())` is what the last `reset`
/// or `step` returned, and the `_index` methods move the environment exactly as the others do.
/// Tables of a task are made from [`Self::state`], so a number must mean the same state for ever.
pub trait FiniteEnv: Env {
    /// The number of states; they are numbered `0..states()`.
    fn states(&self) -> usize;

    /// The state with number `s`.
    fn state(&self, s: usize) -> Self::State;

    /// The number of the state that the environment is in.
    fn state_index(&self) -> usize;

    /// [`Env::reset`], giving the state's number only: what tabular learners read. Override it where
    /// states are costly to make.
    #[inline]
    fn reset_index<R: Rng + ?Sized>(&mut self, rng: &mut R) -> usize {
        self.reset(rng);
        self.state_index()
    }

    /// [`Env::step`], giving the state's number only.
    #[inline]
    fn step_index<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        let Step { reward, terminated, truncated, .. } = self.step(action, rng);
        Step { state: self.state_index(), reward, terminated, truncated }
    }
}

/// A finite environment that may fail: one behind a wire, or in another language.
///
/// [`Learner::train`](crate::learn::Learner::train) takes it as it takes a [`FiniteEnv`], every one of which is one
/// that never fails. Where it fails, training stops, and nothing is learned from the step that was not
/// taken.
///
/// ```
/// use tltl::env::FallibleEnv;
/// use tltl::learn::TrainError;
/// use tltl::prelude::*;
/// use tltl::rand::Rng;
///
/// /// A lamp that is switched by telegraph, while there is a line.
/// struct Lamp { lit: usize, left: u32 }
///
/// struct NoLine;
/// impl From<NoLine> for TrainError {
///     fn from(_: NoLine) -> Self {
///         Self::Environment
///     }
/// }
///
/// impl FallibleEnv for Lamp {
///     type Error = NoLine;
///     fn states(&self) -> usize {
///         2
///     }
///     fn actions(&self) -> usize {
///         2
///     }
///     fn try_reset<R: Rng + ?Sized>(&mut self, _: &mut R) -> Result<usize, NoLine> {
///         Ok(0)
///     }
///     fn try_step<R: Rng + ?Sized>(&mut self, a: usize, _: &mut R) -> Result<Step<usize>, NoLine> {
///         self.left = self.left.checked_sub(1).ok_or(NoLine)?;
///         self.lit = a;
///         Ok(Step::to(self.lit))
///     }
/// }
///
/// let task = Labelled::new(0..2, ["off", "on"], &tltl! { |s: &usize| F ({ *s } == 1) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 1);
/// let error = learner.train(&mut Lamp { lit: 0, left: 50 }, 1_000).unwrap_err();
/// assert_eq!((error, learner.steps()), (TrainError::Environment, 50), "what was learned is kept");
/// assert_eq!(learner.policy().act(0, 0), 1);
/// # Ok::<(), tltl::augmented::LabelError>(())
/// ```
pub trait FallibleEnv {
    /// Why it fails.
    type Error;

    /// The number of states; they are numbered `0..states()`.
    fn states(&self) -> usize;

    /// The number of actions; they are numbered `0..actions()`.
    fn actions(&self) -> usize;

    /// Starts an episode; the number of its first state.
    ///
    /// # Errors
    /// If it cannot start one.
    fn try_reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<usize, Self::Error>;

    /// Takes an action; the number of the new state.
    ///
    /// # Errors
    /// If it cannot take it.
    fn try_step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<usize>, Self::Error>;
}

impl<E: FiniteEnv> FallibleEnv for E {
    type Error = Infallible;

    #[inline(always)]
    fn states(&self) -> usize {
        FiniteEnv::states(self)
    }

    #[inline(always)]
    fn actions(&self) -> usize {
        Env::actions(self)
    }

    #[inline(always)]
    fn try_reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Result<usize, Infallible> {
        Ok(self.reset_index(rng))
    }

    #[inline(always)]
    fn try_step<R: Rng + ?Sized>(
        &mut self,
        action: usize,
        rng: &mut R,
    ) -> Result<Step<usize>, Infallible> {
        Ok(self.step_index(action, rng))
    }
}

/// An environment whose episodes are truncated after a number of steps.
///
/// A learner's own horizon does the same for its training; this is for environments that are run by
/// hand, or that several learners share.
///
/// ```
/// use tltl::env::TimeLimit;
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// let still = ModelEnv::new(model::from_fn(1, 1, |_, _| [(0, 1.0)]))?;
/// let (mut env, mut rng) = (TimeLimit::new(still, 3), Xoshiro256PlusPlus::seed_from_u64(1));
/// env.reset(&mut rng);
/// let truncated = [1, 2, 3].map(|_| env.step(0, &mut rng).truncated);
/// assert_eq!(truncated, [false, false, true]);
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
///
/// The step that reaches the horizon is *truncated* and not terminated: the world goes on after
/// it, so a learner bootstraps from its last state. A step that does both keeps both flags.
#[derive(Clone, Debug)]
pub struct TimeLimit<E> {
    env: E,
    horizon: u64,
    elapsed: u64,
}

impl<E> TimeLimit<E> {
    /// `env`, truncated after `horizon` steps.
    pub const fn new(env: E, horizon: u64) -> Self {
        Self { env, horizon, elapsed: 0 }
    }
}

impl<E: Env> Env for TimeLimit<E> {
    type State = E::State;

    fn actions(&self) -> usize {
        self.env.actions()
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> E::State {
        self.elapsed = 0;
        self.env.reset(rng)
    }

    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<E::State> {
        self.elapsed += 1;
        let step = self.env.step(action, rng);
        Step { truncated: step.truncated || self.elapsed >= self.horizon, ..step }
    }

    fn action_name(&self, a: usize) -> String {
        self.env.action_name(a)
    }
}

impl<E: FiniteEnv> FiniteEnv for TimeLimit<E> {
    fn states(&self) -> usize {
        self.env.states()
    }

    fn state(&self, s: usize) -> E::State {
        self.env.state(s)
    }

    fn state_index(&self) -> usize {
        self.env.state_index()
    }

    fn reset_index<R: Rng + ?Sized>(&mut self, rng: &mut R) -> usize {
        self.elapsed = 0;
        self.env.reset_index(rng)
    }

    fn step_index<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        self.elapsed += 1;
        let step = self.env.step_index(action, rng);
        Step { truncated: step.truncated || self.elapsed >= self.horizon, ..step }
    }
}

/// A number in `0..n`, uniform up to a relative error of `n / 2^32`: a multiplication in place of a
/// division (Lemire 2019), without its rejection step, for actions are few.
#[inline]
pub(crate) fn below(n: usize, rng: &mut (impl Rng + ?Sized)) -> usize {
    ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize
}

/// A number in [0, 1) with 53 random bits.
#[inline]
pub(crate) fn unit(rng: &mut (impl Rng + ?Sized)) -> f64 {
    (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
}

/// One column of an alias table (Walker 1977, Vose 1991): itself below the threshold, else the
/// alias.
#[derive(Clone, Copy, Debug)]
struct Alias {
    threshold: u32,
    alias: u32,
}

/// Samples a column from one random word: its high half chooses, its low half decides.
#[inline]
fn sample(columns: &[Alias], word: u64) -> usize {
    let at = (((word >> 32) * columns.len() as u64) >> 32) as usize;
    let column = columns[at];
    if (word as u32) < column.threshold { at } else { column.alias as usize }
}

/// The alias table of a distribution; probabilities are kept to 2^-32.
///
/// n columns of mass 1/n each are filled so that none holds more than two outcomes: one that is
/// too small for its column is topped up from one that is too large, until all are level. So one
/// uniform column and one comparison sample the distribution, and making the table is O(n).
#[inline]
fn alias_table(probabilities: &[f64]) -> Vec<Alias> {
    let n = probabilities.len();
    let (mut mass, mut columns) = (Vec::with_capacity(n), Vec::with_capacity(n));
    let (mut small, mut large) = (Vec::new(), Vec::new());
    for (i, p) in probabilities.iter().enumerate() {
        mass.push(p * n as f64);
        // Columns that rounding leaves in neither list at the end keep this: themselves, always.
        columns.push(Alias { threshold: u32::MAX, alias: i as u32 });
        if mass[i] < 1.0 { small.push(i) } else { large.push(i) }
    }
    while let (Some(i), Some(&j)) = (small.pop(), large.last()) {
        columns[i] = Alias { threshold: (mass[i] * 4_294_967_296.0) as u32, alias: j as u32 };
        mass[j] -= 1.0 - mass[i];
        if mass[j] < 1.0 {
            large.pop();
            small.push(j);
        }
    }
    columns
}

/// One column of an alias table with the states themselves: `state` below the threshold, else
/// `alias`.
#[derive(Clone, Copy, Debug)]
struct Draw {
    threshold: u32,
    state: u32,
    alias: u32,
}

/// The alias tables of all actions in all states, so that a step is a single look-up.
///
/// All rows have the width of the longest one, shorter rows being padded with outcomes of
/// probability 0: then the row of (s, a) is found by a multiplication, without a table of offsets.
#[derive(Clone, Debug)]
struct Outcomes {
    /// `width` columns for each `s * actions + a`.
    columns: Vec<Draw>,
    width: usize,
}

impl Outcomes {
    /// At most this many columns are laid out, 48 MiB. Larger worlds sample from the shared tables,
    /// which costs one look-up more a step.
    const MOST: usize = 1 << 22;

    /// The columns of `dynamics`; none if they are too many.
    ///
    /// `compact` has the tables of the distinct rows; a row that needs no padding is copied from there.
    #[inline]
    fn new(dynamics: &Dynamics, compact: &[Alias]) -> Self {
        let (states, actions) = (dynamics.states(), dynamics.actions());
        let width = (0..states).map(|s| dynamics.successors(s).len()).max().unwrap_or(1);
        if states.saturating_mul(actions).saturating_mul(width) > Self::MOST {
            return Self { columns: Vec::new(), width };
        }
        let mut columns = Vec::with_capacity(states * actions * width);
        for s in 0..states {
            let successors = dynamics.successors(s);
            let offset = dynamics.matrix_offset(s);
            let all = &compact[offset..offset + actions * successors.len()];
            let uniform = successors.len() == width;
            let state = |i: usize| successors.get(i).copied().unwrap_or(successors[0]);
            for (row, p) in
                all.chunks(successors.len()).zip(dynamics.matrix(s).chunks(successors.len()))
            {
                let mut padded = p.to_vec();
                padded.resize(width, 0.0);
                let table = if uniform { row.to_vec() } else { alias_table(&padded) };
                for (i, Alias { threshold, alias }) in table.into_iter().enumerate() {
                    let (state, alias) = (state(i), state(alias as usize));
                    columns.push(Draw { threshold, state, alias });
                }
            }
        }
        Self { columns, width }
    }
}

/// A [`FiniteModel`] as an environment: it samples the model's outcomes, terminates by its
/// [endings](FiniteModel::endings), and pays nothing of its own.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
/// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
///
/// let mut coin = ModelEnv::new(model::from_fn(2, 1, |_, _| [(0, 0.5), (1, 0.5)]))?;
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// coin.reset(&mut rng);
/// let heads: usize = (0..1_000).map(|_| coin.step(0, &mut rng).state).sum();
/// assert!((450..550).contains(&heads));
/// assert_eq!(coin.steps(), 1_000);
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
///
/// It holds the model's tables, so solvers get them without asking the model again:
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let env = ModelEnv::new(row)?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 4) })?;
/// let best = Problem::new(env.dynamics(), &task)?.best();
/// assert_eq!((best.steps(0, 0), env.steps()), (Some(4.0), 0), "solved, and not a step taken");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ModelEnv<M> {
    model: M,
    dynamics: Dynamics,
    outcomes: Outcomes,
    /// Alias tables, parallel to the probabilities of `dynamics`.
    columns: Vec<Alias>,
    starts: Vec<Alias>,
    state: usize,
    steps: u64,
}

impl<M: FiniteModel> ModelEnv<M> {
    /// The environment that samples `model`.
    ///
    /// # Errors
    /// If the model's outcomes or starts are not distributions.
    pub fn new(model: M) -> Result<Self, ModelError> {
        let dynamics = Dynamics::new(&model)?;
        let columns = columns(&dynamics);
        let starts = alias_table(dynamics.starts());
        let outcomes = Outcomes::new(&dynamics, &columns);
        Ok(Self { model, dynamics, outcomes, columns, starts, state: 0, steps: 0 })
    }

    /// The model.
    pub const fn model(&self) -> &M {
        &self.model
    }

    /// The model's tables, as solvers take them.
    pub const fn dynamics(&self) -> &Dynamics {
        &self.dynamics
    }

    /// Takes an action; the number of the new state.
    ///
    /// Which half of a column is drawn nobody can predict, so the choice must not become a branch.
    ///
    /// It and who calls it are forced inline: whether the compiler does so by itself depends on who else
    /// steps such an environment, and a loop of learning that calls a function for it takes a third
    /// longer.
    #[inline(always)]
    #[track_caller]
    fn move_on<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        let Outcomes { columns, width } = &self.outcomes;
        let word = rng.next_u64();
        let at = (((word >> 32) * *width as u64) >> 32) as usize;
        self.steps += 1;
        let arrival = if columns.is_empty() {
            self.compact(action, word)
        } else {
            assert!(action < self.dynamics.actions(), "an action of the model");
            let row = (self.state * self.dynamics.actions() + action) * width;
            let Draw { threshold, state, alias } = columns[row + at];
            let (state, alias) = (state as usize, alias as usize);
            core::hint::select_unpredictable((word as u32) < threshold, state, alias)
        };
        let terminated = arrival >= self.dynamics.states();
        self.state = if terminated { self.dynamics.arrived(arrival) } else { arrival };
        Step { terminated, ..Step::to(self.state) }
    }

    /// The same from the shared tables.
    #[cold]
    fn compact(&self, action: usize, word: u64) -> usize {
        let successors = self.dynamics.successors(self.state);
        let row = self.dynamics.matrix_offset(self.state) + action * successors.len();
        let columns = &self.columns[row..row + successors.len()];
        successors[sample(columns, word)] as usize
    }

    /// How many steps have been taken in this environment, over all episodes.
    pub const fn steps(&self) -> u64 {
        self.steps
    }
}

/// The alias tables of all distinct rows, in place.
///
/// States share matrices, and a matrix is done once, by the first state that has it.
#[inline]
fn columns(dynamics: &Dynamics) -> Vec<Alias> {
    let empty = Alias { threshold: 0, alias: 0 };
    let mut columns = alloc::vec![empty; dynamics.probabilities().len()];
    let mut done = alloc::vec![false; columns.len()];
    for s in 0..dynamics.states() {
        let offset = dynamics.matrix_offset(s);
        if !core::mem::replace(&mut done[offset], true) {
            let (matrix, width) = (dynamics.matrix(s), dynamics.successors(s).len());
            let rows = columns[offset..].chunks_mut(width).zip(matrix.chunks(width));
            rows.for_each(|(row, p)| row.copy_from_slice(&alias_table(p)));
        }
    }
    columns
}

impl<M: FiniteModel> Env for ModelEnv<M> {
    type State = M::State;

    fn actions(&self) -> usize {
        self.dynamics.actions()
    }

    #[inline]
    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> M::State {
        self.state = sample(&self.starts, rng.next_u64());
        self.model.state(self.state)
    }

    #[inline]
    fn step<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<M::State> {
        let Step { state, reward, terminated, truncated } = self.move_on(action, rng);
        Step { state: self.model.state(state), reward, terminated, truncated }
    }

    fn action_name(&self, a: usize) -> String {
        self.model.action_name(a)
    }
}

impl<M: FiniteModel> FiniteEnv for ModelEnv<M> {
    fn states(&self) -> usize {
        self.dynamics.states()
    }

    fn state(&self, s: usize) -> M::State {
        self.model.state(s)
    }

    #[inline]
    fn state_index(&self) -> usize {
        self.state
    }

    #[inline(always)]
    fn reset_index<R: Rng + ?Sized>(&mut self, rng: &mut R) -> usize {
        self.state = sample(&self.starts, rng.next_u64());
        self.state
    }

    #[inline(always)]
    fn step_index<R: Rng + ?Sized>(&mut self, action: usize, rng: &mut R) -> Step<usize> {
        self.move_on(action, rng)
    }
}
