//! Tasks over finite worlds as tables.
//!
//! [`Labelled`] turns a [`Monitor`] and the states of a world into two small tables: a class for each
//! world state, and a next automaton state for each automaton state and class. World states that no
//! automaton state tells apart share a class, as bytes do in a lexer, so the second table stays small
//! however large the world is: on a grid of a million cells, `F a && F b` has at most 4 classes.
//!
//! Predicates are evaluated here once for each world state and automaton state, and never again:
//! learners and solvers read tables only.

use alloc::string::{String, ToString};
use alloc::sync::Arc;
use alloc::vec::Vec;
use core::fmt;

use crate::env::FiniteEnv;
use crate::interner::Interner;
use crate::mismatch::{self, Mismatch};
use crate::model::FiniteModel;
use crate::monitor::Monitor;
use crate::reward::{Arrival, End, Ends, Mode, Rewards};
use crate::task::Error;

/// A task over a finite world, as tables: the class of each world state, and where each automaton
/// state goes on each class. It also knows what the task and the actions are called.
///
/// World states are `0..states()`, actions `0..actions()`, automaton states `0..automaton_states()`.
/// Classes are numbered in the order of the states that show them first, so the same task on the
/// same world always gives the same tables. Cheap to clone: clones share the tables.
///
/// A table is what identifies a task on a world. [`Policy`](crate::policy::Policy),
/// [`QTable`](crate::q::QTable), [`Problem`](crate::solve::Problem) and
/// [`Learner`](crate::learn::Learner) each hold one, and refuse what belongs to another.
///
/// ```
/// use tltl::prelude::*;
///
/// // Five cells in a row; reach the last one.
/// let task = Labelled::new(0..5, ["left", "right"], &tltl! { |x: &i32| F ({ *x } == 4) })?;
/// assert_eq!((task.states(), task.actions(), task.automaton_states()), (5, 2, 2));
/// assert_eq!(task.start(0), 0);
/// assert!(task.end(task.next(0, 4)).is_some());
/// # Ok::<(), tltl::augmented::LabelError>(())
/// ```
#[derive(Clone)]
pub struct Labelled(Arc<LabelTable>);

/// The tables of a [`Labelled`] task.
#[derive(Clone)]
pub(crate) struct LabelTable {
    pub(crate) name: String,
    pub(crate) formula: String,
    pub(crate) actions: Vec<String>,
    pub(crate) classes: usize,
    /// The class of each world state.
    pub(crate) class: Vec<u32>,
    /// The next automaton state, indexed `q * classes + class`.
    pub(crate) next: Vec<u32>,
    /// The automaton state before the first state of the world is read.
    pub(crate) initial: u32,
    pub(crate) ends: Ends,
    /// ρ(s', D_φ^q), indexed `q * states + s`; empty where it is not known.
    pub(crate) robustness: Vec<f64>,
}

/// Why there is no table of a task over a world.
///
/// ```
/// use tltl::prelude::*;
///
/// let fast = |speed: &f64| speed - 1.0;
/// let error = Labelled::new([0.5, f64::NAN, 2.0], ["go"], &tltl! { F fast }).unwrap_err();
/// assert_eq!(error.to_string(), "predicate `fast` is not a number (NaN) at instant 1");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LabelError {
    /// A predicate is not a number at a state of the world, whose number `instant` is.
    NotANumber(Error),
    /// There are no states, no actions, or more than `u32::MAX` states.
    Size {
        /// The number of states.
        states: usize,
        /// The number of actions.
        actions: usize,
    },
    /// Tasks that are to be one are of different worlds.
    Mismatch(Mismatch),
    /// More joint states of several tasks can be reached than the budget allows.
    TooLarge {
        /// The number of parts.
        parts: usize,
        /// The most joint states that were allowed.
        budget: usize,
    },
}

impl fmt::Display for LabelError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotANumber(error) => error.fmt(f),
            Self::Mismatch(error) => error.fmt(f),
            Self::Size { states, actions } => {
                write!(f, "a world needs states and actions, this has {states} and {actions}")
            }
            Self::TooLarge { parts, budget } => write!(
                f,
                "the {parts} parts of the task reach more than {budget} states together; learn them as \
                 skills and compose those, or allow more"
            ),
        }
    }
}

impl core::error::Error for LabelError {}

impl From<Mismatch> for LabelError {
    #[inline]
    fn from(error: Mismatch) -> Self {
        Self::Mismatch(error)
    }
}

impl Labelled {
    /// The table of `monitor` over a world's states, in the order of their numbers; `actions` are
    /// what the world's actions are called.
    ///
    /// Cost: one move of the automaton for each state of the world and of the automaton, so each
    /// predicate is evaluated |Q| times at each state; the table itself is as large as the classes.
    ///
    /// # Errors
    /// If a predicate is not a number at one of the states, or there are no states or actions.
    pub fn new<S>(
        states: impl IntoIterator<Item = S>,
        actions: impl IntoIterator<Item: Into<String>>,
        monitor: &(impl Monitor<S> + ?Sized),
    ) -> Result<Self, LabelError> {
        let ends = Ends::of(monitor);
        let mut columns = ClassBuilder { class: Vec::new(), seen: Interner::new() };
        let mut column = alloc::vec![0; monitor.states() as usize];
        for (i, s) in states.into_iter().enumerate() {
            for (q, to) in column.iter_mut().enumerate() {
                *to = monitor.next(q as u32, &s).map_err(|error| at(i, error))?;
            }
            columns.push(&column);
        }
        let actions = actions.into_iter().map(Into::into).collect();
        let name = (monitor.name().to_string(), monitor.formula().text().to_string());
        columns.into_labelled(name, actions, ends)
    }

    /// The table of `monitor` over the states of `model`, with the names of its actions.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let ring = model::from_fn(6, 1, |s, _| [((s + 1) % 6, 1.0)]);
    /// let task = Labelled::of_model(&ring, &tltl! { |s: &usize| F ({ *s } == 3) })?;
    /// assert_eq!((task.states(), task.action_names()), (6, &["0".to_string()][..]));
    /// # Ok::<(), tltl::augmented::LabelError>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_model<M: FiniteModel>(
        model: &M,
        monitor: &(impl Monitor<M::State> + ?Sized),
    ) -> Result<Self, LabelError> {
        let actions = (0..model.actions()).map(|a| model.action_name(a));
        Self::new((0..model.states()).map(|s| model.state(s)), actions, monitor)
    }

    /// The table of `monitor` over the states of `env`, with the names of its actions.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let ring = ModelEnv::new(model::from_fn(6, 1, |s, _| [((s + 1) % 6, 1.0)]))?;
    /// let task = Labelled::of_env(&ring, &tltl! { |s: &usize| F ({ *s } == 3) })?;
    /// assert_eq!((task.pairs(), task.pair(1, 2)), (2 * 6, 6 + 2));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn of_env<E: FiniteEnv>(
        env: &E,
        monitor: &(impl Monitor<E::State> + ?Sized),
    ) -> Result<Self, LabelError> {
        let actions = (0..env.actions()).map(|a| env.action_name(a));
        Self::new((0..env.states()).map(|s| env.state(s)), actions, monitor)
    }

    /// The table of these parts.
    #[inline]
    pub(crate) fn from_tables(tables: LabelTable) -> Result<Self, LabelError> {
        let (states, actions) = (tables.class.len(), tables.actions.len());
        let sized = states > 0 && actions > 0 && u32::try_from(states).is_ok();
        if sized { Ok(Self(Arc::new(tables))) } else { Err(LabelError::Size { states, actions }) }
    }

    /// The same table with ρ(s, D_φ^q) for all q and s, which
    /// [`Mode::Robustness`](crate::reward::Mode::Robustness) needs: 8 bytes for each pair.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::reward::Mode;
    ///
    /// // Five places on a line; the robustness of being beyond 3 grows with the place.
    /// let line = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let far = tltl! { |s: &usize| F ({ *s } > 3) };
    /// let task = Labelled::of_model(&line, &far)?.with_robustness(0..5, &far)?;
    /// let problem = Problem::new(&Dynamics::new(&line)?, &task)?;
    /// assert_eq!(problem.optimal_q(&Rewards::of(Mode::Robustness)).greedy(0, 2), 1);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If a predicate is not a number at one of the states.
    ///
    /// # Panics
    /// If states or task are not those that the table was made of.
    #[track_caller]
    pub fn with_robustness<S>(
        mut self,
        states: impl IntoIterator<Item = S>,
        monitor: &(impl Monitor<S> + ?Sized),
    ) -> Result<Self, LabelError> {
        assert_eq!(monitor.states(), self.automaton_states(), "the task of the table");
        let (mut robustness, mut count) = (alloc::vec![0.0; self.pairs()], 0);
        for s in states {
            assert!(count < self.states(), "the states of the table, no further ones");
            for q in self.live() {
                let rho = monitor.progress_robustness(q, &s);
                robustness[self.pair(q, count)] = rho.map_err(|error| at(count, error))?;
            }
            count += 1;
        }
        assert_eq!(count, self.states(), "the states of the table, all of them");
        Arc::make_mut(&mut self.0).robustness = robustness;
        Ok(self)
    }

    /// The same table under another name and formula, as documents and errors show them: a product
    /// has the names of its operands until it is given one of its own.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// let task = Labelled::new(0..3, ["go"], &tltl! { |s: &i32| F ({ *s } == 2) })?;
    /// let task = task.named("arrive", "F end");
    /// assert_eq!((task.name(), task.formula()), ("arrive", "F end"));
    /// # Ok::<(), tltl::augmented::LabelError>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn named(mut self, name: &str, formula: &str) -> Self {
        let tables = Arc::make_mut(&mut self.0);
        (tables.name, tables.formula) = (name.to_string(), formula.to_string());
        self
    }

    /// What the task is called; its formula if it has no name.
    #[must_use]
    #[inline]
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The formula as its author wrote it.
    #[must_use]
    #[inline]
    pub fn formula(&self) -> &str {
        &self.0.formula
    }

    /// The number of states of the world.
    #[inline]
    #[must_use]
    pub fn states(&self) -> usize {
        self.0.class.len()
    }

    /// The number of actions of the world.
    #[inline]
    #[must_use]
    pub fn actions(&self) -> usize {
        self.0.actions.len()
    }

    /// What the actions are called, in the order of their numbers.
    #[must_use]
    #[inline]
    pub fn action_names(&self) -> &[String] {
        &self.0.actions
    }

    /// The number of states of the automaton, the trap included.
    #[must_use]
    #[inline]
    pub fn automaton_states(&self) -> u32 {
        self.0.ends.states()
    }

    /// δ(q, s): the automaton state after `q` has read `s`. Two look-ups, no predicate.
    ///
    /// # Panics
    /// If there is no such automaton state or state.
    #[inline]
    #[must_use]
    pub fn next(&self, q: u32, s: usize) -> u32 {
        self.0.next(q, s)
    }

    /// The automaton state in which an episode starts that starts in `s`: the automaton has read `s`
    /// by then, and so an episode may be over at once.
    ///
    /// ```
    /// use tltl::prelude::*;
    /// use tltl::reward::End;
    ///
    /// // Reach cell 2, and keep off cell 0: an episode that starts in 0 is lost before its first step.
    /// let task = Labelled::new(0..3, ["go"], &tltl! { |x: &i32| ({ *x } != 0) U ({ *x } == 2) })?;
    /// let ends = [0, 1, 2].map(|s| task.end(task.start(s)));
    /// assert_eq!(ends, [Some(End::Lost), None, Some(End::Accepted)]);
    /// assert!(task.live().eq([0]), "one automaton state in which there is something to do");
    /// # Ok::<(), tltl::augmented::LabelError>(())
    /// ```
    ///
    /// # Panics
    /// If there is no such state.
    #[inline]
    #[must_use]
    pub fn start(&self, s: usize) -> u32 {
        self.0.next(self.0.initial, s)
    }

    /// Where the task ends, and how far each automaton state is from acceptance.
    #[must_use]
    #[inline]
    pub fn ends(&self) -> &Ends {
        &self.0.ends
    }

    /// How the task has ended at `q`, if it has.
    #[inline]
    #[must_use]
    pub fn end(&self, q: u32) -> Option<End> {
        self.0.ends.end(q)
    }

    /// The automaton states in which the task goes on.
    #[inline]
    pub fn live(&self) -> impl Iterator<Item = u32> + use<> {
        self.0.ends.live()
    }

    /// The number of pairs (q, s), the states of the augmented MDP.
    #[inline]
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.automaton_states() as usize * self.states()
    }

    /// The number of the pair (q, s): `q * states + s`.
    #[inline]
    #[must_use]
    pub fn pair(&self, q: u32, s: usize) -> usize {
        q as usize * self.states() + s
    }

    #[inline]
    pub(crate) fn tables(&self) -> &LabelTable {
        &self.0
    }

    /// What every move pays under `rewards`, the last of an episode included.
    #[track_caller]
    #[inline]
    pub(crate) fn payment(&self, rewards: &Rewards) -> Payment {
        // Only a potential depends on what follows.
        let differs = rewards.mode() == Mode::Shaped;
        let last = if differs { self.last_payment(rewards).table } else { Vec::new() };
        Payment { last, ..self.payment_of(rewards, false) }
    }

    /// What every move pays that is the last one, for the environment terminates.
    #[track_caller]
    #[inline]
    pub(crate) fn last_payment(&self, rewards: &Rewards) -> Payment {
        self.payment_of(rewards, true)
    }

    #[track_caller]
    #[inline]
    fn payment_of(&self, rewards: &Rewards, terminated: bool) -> Payment {
        let pays = |q, to, robustness| {
            let arrival = Arrival { robustness, terminated, ..Arrival::at(q, to) };
            rewards.pay_for_move(self.ends(), &arrival)
        };
        if !rewards.needs_robustness() {
            return self.payment_by(&|q, to| pays(q, to, 0.0));
        }
        let robustness = &self.0.robustness;
        assert!(!robustness.is_empty(), "this reward needs a table `with_robustness`");
        self.payment_by_state(&|q, s| pays(q, self.next(q, s), robustness[self.pair(q, s)]))
    }

    /// A payment for each move, as `pays(q, q')` says.
    #[inline]
    pub(crate) fn payment_by(&self, pays: &dyn Fn(u32, u32) -> f64) -> Payment {
        let LabelTable { next, classes, .. } = &*self.0;
        let mut table = Vec::with_capacity(next.len());
        for (i, &to) in next.iter().enumerate() {
            table.push(pays((i / classes) as u32, to));
        }
        Payment { table, last: Vec::new(), width: *classes, by_state: false }
    }

    /// A payment for each automaton state and state, as `pays(q, s')` says.
    #[inline]
    pub(crate) fn payment_by_state(&self, pays: &dyn Fn(u32, usize) -> f64) -> Payment {
        let mut table = Vec::with_capacity(self.pairs());
        for q in 0..self.automaton_states() {
            for s in 0..self.states() {
                table.push(pays(q, s));
            }
        }
        Payment { table, last: Vec::new(), width: self.states(), by_state: true }
    }

    /// Its name and its sizes, as errors show them.
    #[inline]
    pub(crate) fn describe(&self) -> String {
        let (name, automaton) = (self.name(), self.automaton_states());
        let (states, actions) = (self.states(), self.actions());
        alloc::format!(
            "`{name}` ({automaton} automaton states, {states} states, {actions} actions)"
        )
    }

    /// 64-bit FNV-1a over all that [`Self::check`] compares: the same for tables of the same moves.
    /// A checkpoint keeps it in place of the tables.
    #[inline]
    pub(crate) fn checksum(&self) -> u64 {
        let LabelTable { initial, ends, .. } = self.tables();
        let end = |end: Option<u32>| end.map_or(u32::MAX, |q| q);
        let sizes = [self.states() as u32, self.actions() as u32, ends.states()];
        let heads = [*initial, end(ends.accepting()), end(ends.trap())];
        let moves = (0..self.automaton_states())
            .flat_map(|q| (0..self.states()).map(move |s| self.next(q, s)));
        let words = sizes.into_iter().chain(heads).chain(moves);
        crate::checksum::fnv(words.flat_map(u32::to_le_bytes))
    }

    /// `Ok` if `found`, to which `what` belongs, is this task on this world: if the automaton moves
    /// and ends alike on every world state. Names do not matter, for the same task may be written in
    /// several ways. Clones are known by their address; others cost one pass over the pairs.
    #[inline]
    pub(crate) fn check(&self, what: &'static str, found: &Self) -> Result<(), Mismatch> {
        if Arc::ptr_eq(&self.0, &found.0) {
            return Ok(());
        }
        let difference = match self.difference(found) {
            None => return Ok(()),
            Some(difference) => difference,
        };
        let (found, expected) = (found.describe(), self.describe());
        let alike = found == expected;
        let mismatch = Mismatch::new(what, found, expected);
        Err(if alike { mismatch.in_that(difference) } else { mismatch })
    }

    /// `Ok` if a world of these sizes, to which `what` belongs, can be the one of this table.
    #[inline]
    pub(crate) fn check_world(
        &self,
        what: &'static str,
        states: usize,
        actions: usize,
    ) -> Result<(), Mismatch> {
        if (states, actions) == (self.states(), self.actions()) {
            return Ok(());
        }
        Err(Mismatch::new(what, mismatch::world(states, actions), self.describe()))
    }

    /// In what the moves differ from those of another table, if they do. Classes may be numbered
    /// differently in tables from a file, so what counts is where each state leads.
    ///
    /// It says why two tables are not the same task to readers who see one name and one size twice.
    #[inline]
    fn difference(&self, other: &Self) -> Option<String> {
        let (own, others) = (self.tables(), other.tables());
        let sizes = |t: &LabelTable| (t.class.len(), t.actions.len(), t.ends.states());
        let ends = |t: &LabelTable| (t.initial, t.ends.accepting(), t.ends.trap());
        if sizes(own) != sizes(others) || ends(own) != ends(others) {
            return Some("the automata start or end in different states".to_string());
        }
        if own.class == others.class && own.next == others.next {
            return None;
        }
        let differs =
            |s: usize| (0..own.ends.states()).any(|q| own.next(q, s) != others.next(q, s));
        let s = (0..self.states()).find(|&s| differs(s))?;
        Some(alloc::format!("the automata move differently on state {s} of the world"))
    }
}

impl LabelTable {
    #[inline]
    pub(crate) fn next(&self, q: u32, s: usize) -> u32 {
        self.next[q as usize * self.classes + self.class[s] as usize]
    }

    /// The least number of moves from each automaton state to an accepting one, by the moves that
    /// the world allows: a search backwards. `next` is indexed `q * classes + class`.
    ///
    /// Distances by δ alone may be shorter: an edge of the automaton that no state of the world takes
    /// is not a move here. Cost: O(|Q| × classes).
    #[inline]
    pub(crate) fn distances(of: &[Option<End>], next: &[u32]) -> Vec<Option<u32>> {
        let mut before = alloc::vec![Vec::new(); of.len()];
        for (q, row) in next.chunks((next.len() / of.len()).max(1)).enumerate() {
            row.iter().for_each(|&to| before[to as usize].push(q));
        }
        let accepting = |&q: &usize| of[q] == Some(End::Accepted);
        let mut found: Vec<(usize, u32)> =
            (0..of.len()).filter(accepting).map(|q| (q, 0)).collect();
        let mut distance = alloc::vec![None; of.len()];
        found.iter().for_each(|&(q, moves)| distance[q] = Some(moves));
        let mut at = 0;
        while let Some(&(to, moves)) = found.get(at) {
            for &q in &before[to] {
                if distance[q].is_none() {
                    distance[q] = Some(moves + 1);
                    found.push((q, moves + 1));
                }
            }
            at += 1;
        }
        distance
    }
}

/// Equal are tables of the same names and moves. Distances and robustness are not compared: a table
/// from a file has other distances, those that the world allows.
impl PartialEq for Labelled {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        let names = |l: &Self| (l.name().to_string(), l.formula().to_string());
        let same = Arc::ptr_eq(&self.0, &other.0) || self.difference(other).is_none();
        same && names(self) == names(other) && self.action_names() == other.action_names()
    }
}

impl fmt::Debug for Labelled {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Labelled")
            .field("name", &self.name())
            .field("formula", &self.formula())
            .field("automaton_states", &self.automaton_states())
            .field("states", &self.states())
            .field("actions", &self.actions())
            .finish_non_exhaustive()
    }
}

/// The error at the state with number `s`.
#[inline]
fn at(s: usize, error: Error) -> LabelError {
    LabelError::NotANumber(Error { instant: Some(s), ..error })
}

/// What every move of a [`Labelled`] task pays: a number for each q and class, or, where the reward
/// depends on more than the class of s', for each q and world state.
///
/// Learners and solvers pay by look-up, so that the inner loop knows no mode of reward. Nearly all
/// rewards depend on the class alone; of ρ there is a number for each pair, which is why there are
/// two widths.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Payment {
    table: Vec<f64>,
    /// What the same moves pay when the world ends the episode with them; empty if they pay the same.
    last: Vec<f64>,
    /// The length of a row: the number of classes, or of world states.
    width: usize,
    by_state: bool,
}

impl Payment {
    /// What reading `s` in `q` pays; `class` is the class of `s`.
    #[inline]
    pub(crate) fn get(&self, q: u32, s: usize, class: u32) -> f64 {
        self.table[self.at(q, s, class)]
    }

    /// What it pays when the world ends the episode with it.
    #[inline]
    pub(crate) fn get_last(&self, q: u32, s: usize, class: u32) -> f64 {
        let at = self.at(q, s, class);
        self.last.get(at).copied().unwrap_or(self.table[at])
    }

    #[inline]
    fn at(&self, q: u32, s: usize, class: u32) -> usize {
        q as usize * self.width + if self.by_state { s } else { class as usize }
    }
}

/// Collects the columns of the transition table, one for each world state, and numbers them: equal
/// columns are one class.
///
/// A column has the next state of every automaton state; two states of the world with the same
/// column behave alike for ever, whatever their predicates say.
struct ClassBuilder {
    class: Vec<u32>,
    seen: Interner<u32>,
}

impl ClassBuilder {
    #[inline]
    fn push(&mut self, column: &[u32]) {
        self.class.push(self.seen.number(column));
    }

    #[inline]
    fn into_labelled(
        self,
        (name, formula): (String, String),
        actions: Vec<String>,
        ends: Ends,
    ) -> Result<Labelled, LabelError> {
        let classes = self.seen.items().len();
        let mut next = alloc::vec![0; ends.states() as usize * classes];
        for (class, column) in self.seen.items().iter().enumerate() {
            for (q, &to) in column.iter().enumerate() {
                next[q * classes + class] = to;
            }
        }
        let (class, robustness) = (self.class, Vec::new());
        let initial = 0;
        Labelled::from_tables(LabelTable {
            name,
            formula,
            actions,
            classes,
            class,
            next,
            initial,
            ends,
            robustness,
        })
    }
}
