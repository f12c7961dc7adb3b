//! Finite models: worlds whose transition probabilities are known, compiled into tables.
//!
//! A user describes a world by [`FiniteModel`] (about 20 lines for a grid), or by a function
//! ([`from_fn`]). [`Dynamics`] is the form in which solvers and [`ModelEnv`](crate::env::ModelEnv)
//! read it.
//!
//! Why tables of this form: each state has one list of successors that its actions share, and the
//! matrix of their probabilities is hash-consed, for in most worlds few matrices differ (a grid with
//! slip has 9: inside, edges, corners). So a state costs about 30 bytes, and a backup reads each
//! successor's value once for all actions.
//!
//! A model never pays rewards: they come from the task. Where the world itself ends an episode, the
//! model says so by its [endings](FiniteModel::endings). In the tables an outcome that ends the episode
//! is one of its own: a copy of the state that is entered, from which nothing follows. So only who
//! gathers what arriving is worth needs to know of endings.

use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

use crate::interner::Interner;

/// A finite Markov decision process with known probabilities p(s' | s, a); its rewards come from
/// the task.
///
/// ```
/// use tltl::prelude::*;
///
/// /// A light with a switch that fails one time in ten.
/// struct Light;
///
/// impl FiniteModel for Light {
///     type State = bool;
///     fn states(&self) -> usize {
///         2
///     }
///     fn actions(&self) -> usize {
///         2
///     }
///     fn state(&self, s: usize) -> bool {
///         s == 1
///     }
///     fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
///         outcome(a, 0.9);
///         outcome(s, 0.1);
///     }
///     fn action_name(&self, a: usize) -> String {
///         ["off", "on"][a].into()
///     }
/// }
///
/// let dynamics = Dynamics::new(&Light)?;
/// assert!(dynamics.outcomes(0, 1).eq([(0, 0.1), (1, 0.9)]));
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
pub trait FiniteModel {
    /// What predicates read.
    type State;

    /// The number of states; they are numbered `0..states()`.
    fn states(&self) -> usize;

    /// The number of actions; they are numbered `0..actions()`.
    fn actions(&self) -> usize;

    /// The state with number `s`.
    fn state(&self, s: usize) -> Self::State;

    /// Calls `outcome(s', p)` for the outcomes of action `a` in state `s`. The same `s'` may come
    /// more than once; the probabilities, those of [`endings`](Self::endings) included, sum to one.
    fn transitions(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64));

    /// Calls `outcome(s', p)` for the outcomes of action `a` in state `s` with which the world ends
    /// the episode: the task still reads s', and nothing after it. None unless overridden.
    ///
    /// The same `s'` may be entered both ways. (In Gymnasium's tables `P[s][a]` these are the outcomes
    /// whose last entry, `terminated`, is true.)
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// /// A walk of five cells; at cell 4 the episode is over.
    /// struct Walk;
    ///
    /// impl FiniteModel for Walk {
    ///     type State = usize;
    ///     fn states(&self) -> usize {
    ///         5
    ///     }
    ///     fn actions(&self) -> usize {
    ///         1
    ///     }
    ///     fn state(&self, s: usize) -> usize {
    ///         s
    ///     }
    ///     fn transitions(&self, s: usize, _: usize, mut outcome: impl FnMut(usize, f64)) {
    ///         if s < 3 {
    ///             outcome(s + 1, 1.0);
    ///         }
    ///     }
    ///     fn endings(&self, s: usize, _: usize, mut outcome: impl FnMut(usize, f64)) {
    ///         if s >= 3 {
    ///             outcome(4, 1.0);
    ///         }
    ///     }
    /// }
    ///
    /// // Cell 4 is reached; but no second state can be read there.
    /// let dynamics = Dynamics::new(&Walk)?;
    /// assert!(dynamics.endings(3, 0).eq([(4, 1.0)]));
    /// let once = Labelled::of_model(&Walk, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let twice = Labelled::of_model(&Walk, &tltl! { |s: &usize| F ({ *s } == 4 && X ({ *s } == 4)) })?;
    /// assert_eq!(Problem::new(&dynamics, &once)?.largest_satisfied().at(0, 0), 1.0);
    /// assert_eq!(Problem::new(&dynamics, &twice)?.largest_satisfied().at(0, 0), 0.0);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        let _ = (s, a, outcome);
    }

    /// The weight with which an episode starts in `s`; equal weights unless overridden.
    fn start(&self, s: usize) -> f64 {
        let _ = s;
        1.0
    }

    /// What action `a` is called where it is shown.
    fn action_name(&self, a: usize) -> String {
        a.to_string()
    }
}

impl<M: FiniteModel> FiniteModel for &M {
    type State = M::State;

    fn states(&self) -> usize {
        (**self).states()
    }

    fn actions(&self) -> usize {
        (**self).actions()
    }

    fn state(&self, s: usize) -> M::State {
        (**self).state(s)
    }

    fn transitions(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        (**self).transitions(s, a, outcome);
    }

    fn endings(&self, s: usize, a: usize, outcome: impl FnMut(usize, f64)) {
        (**self).endings(s, a, outcome);
    }

    fn start(&self, s: usize) -> f64 {
        (**self).start(s)
    }

    fn action_name(&self, a: usize) -> String {
        (**self).action_name(a)
    }
}

/// A model whose states are their own numbers: `outcomes(s, a)` are the pairs (s', p) of action `a` in
/// state `s`. Episodes start in every state with the same probability.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// assert!(Dynamics::new(&row)?.outcomes(4, 0).eq([(3, 1.0)]));
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
pub const fn from_fn<F, I>(states: usize, actions: usize, outcomes: F) -> FromFn<F>
where
    F: Fn(usize, usize) -> I,
    I: IntoIterator<Item = (usize, f64)>,
{
    FromFn { states, actions, outcomes }
}

/// A model that a function describes; see [`from_fn`].
#[derive(Clone, Copy)]
pub struct FromFn<F> {
    states: usize,
    actions: usize,
    outcomes: F,
}

impl<F> fmt::Debug for FromFn<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("FromFn")
            .field("states", &self.states)
            .field("actions", &self.actions)
            .finish_non_exhaustive()
    }
}

impl<F, I> FiniteModel for FromFn<F>
where
    F: Fn(usize, usize) -> I,
    I: IntoIterator<Item = (usize, f64)>,
{
    type State = usize;

    fn states(&self) -> usize {
        self.states
    }

    fn actions(&self) -> usize {
        self.actions
    }

    fn state(&self, s: usize) -> usize {
        s
    }

    fn transitions(&self, s: usize, a: usize, mut outcome: impl FnMut(usize, f64)) {
        (self.outcomes)(s, a).into_iter().for_each(|(to, p)| outcome(to, p));
    }
}

/// Why a [`FiniteModel`] is not one.
///
/// ```
/// use tltl::model::{self, ModelError};
/// use tltl::prelude::*;
///
/// let leaky = model::from_fn(2, 1, |_, _| [(0, 0.5), (1, 0.25)]);
/// let error = Dynamics::new(&leaky).unwrap_err();
/// assert_eq!(error, ModelError::Outcomes { state: 0, action: 0, sum: 0.75 });
/// assert!(error.to_string().starts_with("action 0 in state 0: the outcomes are not a distribution"));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub enum ModelError {
    /// There are no states, no actions, or more than `u32::MAX` states.
    Size {
        /// The number of states.
        states: usize,
        /// The number of actions.
        actions: usize,
    },
    /// The outcomes of an action are not a distribution over the states.
    Outcomes {
        /// The state.
        state: usize,
        /// The action.
        action: usize,
        /// What the probabilities sum to.
        sum: f64,
    },
    /// The start weights are not a distribution: one is negative or not a number, or all are 0.
    Starts,
}

impl fmt::Display for ModelError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { states, actions } => {
                write!(f, "a model needs states and actions, this has {states} and {actions}")
            }
            Self::Outcomes { state, action, sum } => write!(
                f,
                "action {action} in state {state}: the outcomes are not a distribution over the \
                 states (the probabilities sum to {sum})"
            ),
            Self::Starts => f.write_str("the start weights are not a distribution"),
        }
    }
}

impl core::error::Error for ModelError {}

/// The transition probabilities of a finite model as tables.
///
/// Invariants: successors are sorted and distinct within a state; every row of probabilities sums
/// to one. Cheap to clone: clones share the tables.
///
/// A successor is an *arrival*: a state, or, from [`Self::states`] on, the copy of a state that is
/// entered as the episode ends.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Two cells; action 0 waits, action 1 changes sides, three times out of four.
/// let cells = model::from_fn(2, 2, |s, a| match a {
///     0 => vec![(s, 1.0)],
///     _ => vec![(s, 0.25), (1 - s, 0.75)],
/// });
/// let dynamics = Dynamics::new(&cells)?;
/// assert_eq!((dynamics.states(), dynamics.actions()), (2, 2));
/// assert!(dynamics.outcomes(1, 0).eq([(1, 1.0)]));
/// assert!(dynamics.outcomes(1, 1).eq([(0, 0.75), (1, 0.25)]));
/// assert_eq!(dynamics.starts(), [0.5, 0.5]);
/// # Ok::<(), tltl::model::ModelError>(())
/// ```
#[derive(Clone)]
pub struct Dynamics(Arc<Kernel>);

/// The tables of a [`Dynamics`]: the transition kernel.
#[derive(Default)]
struct Kernel {
    actions: usize,
    /// Where the successors of each state begin in `successors`, and where the last ones end.
    first: Vec<u32>,
    successors: Vec<u32>,
    /// Where the matrix of each state begins in `probabilities`; states share matrices.
    matrix: Vec<u32>,
    /// The distinct matrices, each with a row of as many numbers as successors for each action.
    probabilities: Vec<f64>,
    starts: Vec<f64>,
    /// The states in which an episode can end, ascending: copy i is arrival `states + i`.
    copied: Vec<u32>,
}

impl Dynamics {
    /// The tables of `model`. All its states are asked for all their actions once.
    ///
    /// # Errors
    /// If its outcomes or starts are not distributions, or it has no states or actions.
    pub fn new<M: FiniteModel>(model: &M) -> Result<Self, ModelError> {
        let (states, actions) = (model.states(), model.actions());
        let copied = endings(model);
        if states == 0 || actions == 0 || u32::try_from(states + copied.len()).is_err() {
            return Err(ModelError::Size { states, actions });
        }
        let mut builder = Builder::new(states, actions, copied);
        for s in 0..states {
            builder.push(model, s)?;
        }
        let starts = distribution((0..states).map(|s| model.start(s)).collect())?;
        Ok(Self(Arc::new(Kernel { starts, ..builder.tables })))
    }

    /// The number of states.
    #[inline]
    #[must_use]
    pub fn states(&self) -> usize {
        self.0.matrix.len()
    }

    /// The number of actions.
    #[inline]
    #[must_use]
    pub fn actions(&self) -> usize {
        self.0.actions
    }

    /// The outcomes of action `a` in state `s` with their probabilities: the states that are entered,
    /// ascending, and after them those that are entered as the episode ends.
    ///
    /// # Panics
    /// If there is no such state or action.
    #[inline]
    pub fn outcomes(&self, s: usize, a: usize) -> impl Iterator<Item = (usize, f64)> {
        self.row(s, a).map(|(to, p)| (self.arrived(to), p))
    }

    /// The outcomes with which the episode ends, ascending: see [`FiniteModel::endings`]. They are
    /// among the [outcomes](Self::outcomes), and the last of them.
    ///
    /// # Panics
    /// If there is no such state or action.
    #[inline]
    pub fn endings(&self, s: usize, a: usize) -> impl Iterator<Item = (usize, f64)> {
        let endings = self.row(s, a).filter(|&(to, _)| to >= self.states());
        endings.map(|(to, p)| (self.arrived(to), p))
    }

    /// The arrivals of action `a` in state `s`, with their probabilities.
    #[inline]
    pub(crate) fn row(&self, s: usize, a: usize) -> impl Iterator<Item = (usize, f64)> {
        let successors = self.successors(s);
        let row = &self.matrix(s)[a * successors.len()..][..successors.len()];
        let all = successors.iter().map(|&to| to as usize).zip(row.iter().copied());
        all.filter(|&(_, p)| p > 0.0)
    }

    /// The number of arrivals: of states, and of copies of those in which an episode can end.
    #[inline]
    pub(crate) fn arrivals(&self) -> usize {
        self.states() + self.0.copied.len()
    }

    /// The state that an arrival enters.
    #[inline]
    pub(crate) fn arrived(&self, arrival: usize) -> usize {
        match arrival.checked_sub(self.states()) {
            Some(copy) => self.0.copied[copy] as usize,
            None => arrival,
        }
    }

    /// The arrivals that some action leads to from `s`, ascending.
    #[inline]
    pub(crate) fn successors(&self, s: usize) -> &[u32] {
        &self.0.successors[self.0.first[s] as usize..self.0.first[s + 1] as usize]
    }

    /// The probabilities of the [successors](Self::successors) of `s`, one row for each action.
    #[inline]
    pub(crate) fn matrix(&self, s: usize) -> &[f64] {
        let width = (self.0.first[s + 1] - self.0.first[s]) as usize;
        let start = self.matrix_offset(s);
        &self.0.probabilities[start..start + width * self.0.actions]
    }

    /// The probability of starting in each state.
    #[must_use]
    #[inline]
    pub fn starts(&self) -> &[f64] {
        &self.0.starts
    }

    /// Where the matrix of `s` starts among [all](Self::probabilities).
    #[inline]
    pub(crate) fn matrix_offset(&self, s: usize) -> usize {
        self.0.matrix[s] as usize
    }

    /// The distinct matrices, one after the other.
    #[inline]
    pub(crate) fn probabilities(&self) -> &[f64] {
        &self.0.probabilities
    }

    /// For each arrival the states that some action leads to it from, as (first, list).
    #[inline]
    pub(crate) fn predecessors(&self) -> (Vec<u32>, Vec<u32>) {
        let mut first = alloc::vec![0; self.arrivals() + 2];
        self.0.successors.iter().for_each(|&to| first[to as usize + 2] += 1);
        for s in 2..first.len() {
            first[s] += first[s - 1];
        }
        let mut list = alloc::vec![0; self.0.successors.len()];
        for s in 0..self.states() {
            for &to in self.successors(s) {
                let at = &mut first[to as usize + 1];
                list[*at as usize] = s as u32;
                *at += 1;
            }
        }
        (first, list)
    }
}

impl fmt::Debug for Dynamics {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Dynamics")
            .field("states", &self.states())
            .field("actions", &self.actions())
            .finish_non_exhaustive()
    }
}

/// `weights`, scaled to sum to one: a user gives weights, and solvers need probabilities.
#[inline]
fn distribution(mut weights: Vec<f64>) -> Result<Vec<f64>, ModelError> {
    let sum: f64 = weights.iter().sum();
    if !(sum > 0.0 && sum.is_finite() && weights.iter().all(|&w| w >= 0.0)) {
        return Err(ModelError::Starts);
    }
    weights.iter_mut().for_each(|w| *w /= sum);
    Ok(weights)
}

/// The states in which an episode of `model` can end, ascending. What is no state is left to the
/// check of the outcomes.
fn endings<M: FiniteModel>(model: &M) -> Vec<u32> {
    let mut ends = alloc::vec![false; model.states()];
    for (s, a) in (0..model.states()).flat_map(|s| (0..model.actions()).map(move |a| (s, a))) {
        model.endings(s, a, |to, p| {
            if let Some(ends) = ends.get_mut(to) {
                *ends |= p > 0.0;
            }
        });
    }
    (0..ends.len()).filter(|&s| ends[s]).map(|s| s as u32).collect()
}

/// Collects the tables state by state.
struct Builder {
    tables: Kernel,
    /// The distinct matrices, as bits: equal numbers of a model are computed alike, so no tolerance is
    /// needed.
    matrices: Interner<u64>,
    /// Where each of them starts.
    offsets: Vec<u32>,
    outcomes: Vec<(usize, u32, f64)>,
}

impl Builder {
    #[inline]
    fn new(states: usize, actions: usize, copied: Vec<u32>) -> Self {
        let mut first = Vec::with_capacity(states + 1);
        first.push(0);
        let matrix = Vec::with_capacity(states);
        let tables = Kernel { actions, first, matrix, copied, ..Kernel::default() };
        Self { tables, matrices: Interner::new(), offsets: Vec::new(), outcomes: Vec::new() }
    }

    fn push<M: FiniteModel>(&mut self, model: &M, s: usize) -> Result<(), ModelError> {
        self.outcomes.clear();
        for a in 0..self.tables.actions {
            self.read(model, s, a)?;
        }
        self.close();
        Ok(())
    }

    /// Adds the state whose outcomes were read.
    #[inline]
    fn close(&mut self) {
        let start = self.tables.successors.len();
        let mut list = Vec::new();
        for &(_, to, _) in &self.outcomes {
            if let Err(at) = list.binary_search(&to) {
                list.insert(at, to);
            }
        }
        self.tables.successors.extend(list);
        let matrix = self.dense(start);
        let offset = self.intern(&matrix);
        self.tables.matrix.push(offset);
        self.tables.first.push(self.tables.successors.len() as u32);
    }

    fn read<M: FiniteModel>(&mut self, model: &M, s: usize, a: usize) -> Result<(), ModelError> {
        let (mut sum, mut valid, states) = (0.0, true, model.states());
        let (outcomes, copied) = (&mut self.outcomes, &self.tables.copied);
        let mut outcome = |to: usize, p: f64, arrival: usize| {
            valid &= to < states && p >= 0.0;
            sum += p;
            if p > 0.0 {
                outcomes.push((a, arrival as u32, p));
            }
        };
        model.transitions(s, a, |to, p| outcome(to, p, to));
        model.endings(s, a, |to, p| {
            let copy = copied.partition_point(|&other| (other as usize) < to);
            outcome(to, p, states + copy);
        });
        // Models compute their probabilities; a sum of a few differs from 1 by some 1e-16 each.
        if valid && f64::abs(sum - 1.0) < 1e-9 {
            Ok(())
        } else {
            Err(ModelError::Outcomes { state: s, action: a, sum })
        }
    }

    /// The outcomes as a matrix over the successors from `start` on.
    #[inline]
    fn dense(&self, start: usize) -> Vec<f64> {
        let list = &self.tables.successors[start..];
        let mut matrix = alloc::vec![0.0; self.tables.actions * list.len()];
        for &(a, to, p) in &self.outcomes {
            let column = list.partition_point(|&other| other < to);
            matrix[a * list.len() + column] += p;
        }
        matrix
    }

    #[inline]
    fn intern(&mut self, matrix: &[f64]) -> u32 {
        let bits: Vec<u64> = matrix.iter().map(|p| p.to_bits()).collect();
        let number = self.matrices.number(&bits) as usize;
        if number == self.offsets.len() {
            self.offsets.push(self.tables.probabilities.len() as u32);
            self.tables.probabilities.extend_from_slice(matrix);
        }
        self.offsets[number]
    }
}
