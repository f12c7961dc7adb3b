//! Policies: an action for each automaton state and world state, with all that is needed to run and
//! to judge them.
//!
//! A [`Policy`] knows its task as tables over the world's states, and may say how it was trained and
//! what it is worth. With the feature `serde` it is saved and loaded by any format, as a
//! [`Document`]; loading checks the document, so a policy in hand is a valid one. A policy runs
//! without its formula: [`Policy::reset`] and [`Policy::next`] move the automaton by state numbers.
//!
//! # Schema, version 2
//! As JSON, every field required unless marked optional, unknown fields refused:
//! ```text
//! {
//!   "format": "tltl-policy",
//!   "version": 2,
//!   "task": "visit_both",              name of the task
//!   "formula": "F a && F b",           its text
//!   "states": 80,                      S, the world's states, numbered 0..S
//!   "actions": ["up", "down", ...],    A names, numbered 0..A
//!   "automaton": {
//!     "states": 4,                     N, numbered 0..N
//!     "initial": 0,                    before the first state is read
//!     "accepting": 3 | null,
//!     "trap": null
//!   },
//!   "classes": 3,                      C, classes of states that the automaton tells apart
//!   "class": [0, 0, 1, ...],           S numbers below C
//!   "next": [0, 1, ...],               N * C numbers below N: next[q * C + class[s]]
//!   "action": [3, 3, 0, ...],          N * S numbers below A: action[q * S + s]
//!   "components": [[0, 0], ...],       optional: N lists, the states of a product's operands
//!   "training": [{                     one for each skill; none for a policy that was computed
//!     "task": "visit_both",
//!     "settings": { ... },             learn::Settings
//!     "steps": 1000000,                environment steps
//!     "episodes": 35000,
//!     "seed": 7
//!   }, ...],
//!   "certificate": {                   null where the world has no model
//!     "kind": "exact",
//!     "satisfied": 1.0,                P(satisfied), mean over the starts with s_0 read
//!     "steps": 12.2003,                E[steps] given success; null: never succeeds
//!     "optimal_satisfied": 1.0,
//!     "optimal_steps": 12.2002,         null: success is impossible
//!     "regret_satisfied": 0.0,
//!     "regret_steps": 0.00001,          null where one of the two is
//!     "worst_regret_satisfied": 0.0,
//!     "fraction_optimal": 0.97,
//!     "within": {                      optional: P(satisfied) within a number of steps
//!       "steps": 100,
//!       "satisfied": 0.99,
//!       "optimal_satisfied": 0.995
//!     }
//!   } | null,
//!   "shield": {                        optional: what a shield laid over it costs and gains
//!     "before": { ... },               a certificate, as above; that after it is `certificate`
//!     "after": { ... },
//!     "lost_before": 0.02,             P(the trap is entered), and the smallest possible
//!     "lost_after": 0.015,
//!     "smallest_lost": 0.015,
//!     "overruled": 0.01,               fraction of live pairs in which it overrules the policy
//!     "allowed": {                     optional: what the allowed actions can come to
//!       "epsilon": 0.001,              what is promised; null: nothing
//!       "fraction": 0.7,               of the actions of live pairs
//!       "lost": 0.016,                 the largest P(the trap is entered)
//!       "satisfied": 0.985,            the largest P(satisfied), and the fewest steps for it
//!       "steps": 11.7
//!     }
//!   },
//!   "starts": {                        optional: the worth from each start, s_0 read
//!     "state": [0, 1, ...],            ascending
//!     "satisfied": [1.0, 1.0, ...],
//!     "steps": [14.4, 13.2, ...]       null: never succeeds
//!   },
//!   "estimate": { ... }                optional: estimate::Estimate, where it was tried instead
//! }
//! ```
//! An episode in state number s: `q = next[initial * C + class[s]]` on reset; then, until q is
//! accepting or the trap, take `action[q * S + s]`, and `q = next[q * C + class[s']]`.

mod document;

use alloc::string::ToString;
use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

#[cfg(feature = "serde")]
pub(crate) use document::checked;
pub use document::{Document, PolicyError, Starts, States, Training};

use crate::augmented::{LabelTable, Labelled};
use crate::certificate::{Certificate, Shielded, Start};
use crate::mismatch::Mismatch;
use crate::monitor::Acceptor as _;
use crate::product::Product;
use crate::reward::{End, Ends};

/// A policy for a task on a finite world: for each automaton state and world state an action.
///
/// It knows its task and its world. What belongs to another task or another world is refused by
/// all that takes a policy.
///
/// ```
/// use tltl::prelude::*;
///
/// // Go to the right end of five cells.
/// let task = Labelled::new(0..5, ["left", "right"], &tltl! { |x: &i32| F ({ *x } == 4) })?;
/// let policy = Policy::from_fn(&task, |_, _| 1)?;
/// let (mut s, mut steps) = (0, 0);
/// let mut q = policy.reset(s);
/// while policy.end(q).is_none() {
///     s += policy.act(q, s);
///     q = policy.next(q, s);
///     steps += 1;
/// }
/// assert_eq!(steps, 4);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
///
/// With serde it is saved as the document above and checked when it is loaded:
///
/// ```
/// use tltl::prelude::*;
///
/// let task = Labelled::new(0..3, ["stay", "go"], &tltl! { |x: &i32| F ({ *x } == 2) })?;
/// let policy = Policy::from_fn(&task, |_, _| 1)?;
/// let text = serde_json::to_string(&policy)?;
/// assert_eq!(serde_json::from_str::<Policy>(&text)?, policy);
/// let forged = text.replace("[1,1,1,1,1,1]", "[1,1,1,1,1,2]");
/// let error = serde_json::from_str::<Policy>(&forged).unwrap_err();
/// assert!(error.to_string().starts_with("`action`, entry 5: 2 is not less than 2"));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Document", into = "Document"))]
pub struct Policy {
    task: Labelled,
    /// The action, indexed `q * states + s`.
    action: Vec<u32>,
    record: Notes,
}

/// What a policy says of itself beside its actions. Nothing of it changes what the policy does.
#[derive(Clone, Debug, Default, PartialEq)]
struct Notes {
    components: Vec<Vec<u32>>,
    training: Vec<Training>,
    certificate: Option<Certificate>,
    shield: Option<Shielded>,
    starts: Option<Starts>,
    #[cfg(feature = "std")]
    estimate: Option<crate::estimate::Estimate>,
}

impl TryFrom<Document> for Policy {
    type Error = PolicyError;

    #[inline]
    fn try_from(document: Document) -> Result<Self, PolicyError> {
        document.check()?;
        let States { states, initial, accepting, trap } = document.automaton;
        let end = |q| match q {
            q if accepting == Some(q) => Some(End::Accepted),
            q if trap == Some(q) => Some(End::Lost),
            _ => None,
        };
        let of: Vec<Option<End>> = (0..states).map(end).collect();
        let distance = LabelTable::distances(&of, &document.next);
        let tables = LabelTable {
            name: document.task,
            formula: document.formula,
            actions: document.actions,
            classes: document.classes,
            class: document.class,
            next: document.next,
            initial,
            ends: Ends::new(of, distance),
            robustness: Vec::new(),
        };
        let record = Notes {
            components: document.components,
            training: document.training,
            certificate: document.certificate,
            shield: document.shield,
            starts: document.starts,
            #[cfg(feature = "std")]
            estimate: document.estimate,
        };
        let action = document.action.into_iter().map(|a| a as u32).collect();
        let (found, limit) = (document.states, u32::MAX as usize);
        let too_many = |_| PolicyError::Range { field: "states", at: 0, found, limit };
        let task = Labelled::from_tables(tables).map_err(too_many)?;
        Ok(Self { task, action, record })
    }
}

impl From<Policy> for Document {
    #[inline]
    fn from(policy: Policy) -> Self {
        let Policy { task, action, record } = policy;
        let tables = task.tables();
        Self {
            format: Policy::FORMAT.to_string(),
            version: Policy::VERSION,
            task: task.name().to_string(),
            formula: task.formula().to_string(),
            states: task.states(),
            actions: task.action_names().to_vec(),
            automaton: States {
                states: task.automaton_states(),
                initial: tables.initial,
                accepting: tables.ends.accepting(),
                trap: tables.ends.trap(),
            },
            classes: tables.classes,
            class: tables.class.clone(),
            next: tables.next.clone(),
            action: action.into_iter().map(|a| a as usize).collect(),
            components: record.components,
            training: record.training,
            certificate: record.certificate,
            shield: record.shield,
            starts: record.starts,
            #[cfg(feature = "std")]
            estimate: record.estimate,
        }
    }
}

impl Policy {
    /// The value of the field `format`.
    pub const FORMAT: &'static str = "tltl-policy";

    /// The version that this library writes and reads.
    ///
    /// A document of another version is refused, by its number.
    pub const VERSION: u32 = 2;

    /// The policy of these `actions`: for each automaton state in turn, the action in each state of
    /// the world.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// // Two automaton states, three world states.
    /// let task = Labelled::new(0..3, ["stay", "go"], &tltl! { |x: &i32| F ({ *x } == 2) })?;
    /// let policy = Policy::new(&task, [1, 1, 0, 0, 0, 0])?;
    /// assert_eq!((policy.act(0, 1), policy.act(1, 1)), (1, 0));
    /// let error = Policy::new(&task, [1, 1, 2, 0, 0, 0]).unwrap_err();
    /// assert_eq!(error.to_string(), "`action`, entry 2: 2 is not less than 2");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If there is not one action for each (q, s), or one that the world does not have.
    pub fn new(
        task: &Labelled,
        actions: impl IntoIterator<Item = usize>,
    ) -> Result<Self, PolicyError> {
        let mut action = Vec::with_capacity(task.pairs());
        for (at, found) in actions.into_iter().enumerate() {
            if found >= task.actions() {
                let (field, limit) = ("action", task.actions());
                return Err(PolicyError::Range { field, at, found, limit });
            }
            action.push(found as u32);
        }
        match (action.len(), task.pairs()) {
            (found, expected) if found != expected => {
                Err(PolicyError::Size { field: "action", found, expected })
            }
            _ => Ok(Self::from_table(task, action)),
        }
    }

    /// The policy that takes the action `act(q, s)`: a rule, or another policy with exceptions.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// // First the right end of five cells, then the left one: whatever q says is still to be done.
    /// let ends = tltl! { |x: &i32| ({ *x } == 4) T ({ *x } == 0) };
    /// let task = Labelled::new(0..5, ["left", "right"], &ends)?;
    /// let policy = Policy::from_fn(&task, |q, _| usize::from(q == 0))?;
    /// assert_eq!((policy.act(0, 2), policy.act(1, 2)), (1, 0));
    /// // The same with an exception.
    /// let stubborn = Policy::from_fn(&task, |q, s| if s == 2 { 1 } else { policy.act(q, s) })?;
    /// assert!(stubborn.sub_policy(1).eq([0, 0, 1, 0, 0]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If that is not an action of the world for some (q, s).
    pub fn from_fn(
        task: &Labelled,
        mut act: impl FnMut(u32, usize) -> usize,
    ) -> Result<Self, PolicyError> {
        let states = task.states();
        let pairs = 0..task.pairs();
        Self::new(task, pairs.map(|pair| act((pair / states) as u32, pair % states)))
    }

    /// The policy of actions that are the world's, one for each pair.
    #[inline]
    pub(crate) fn from_table(task: &Labelled, action: Vec<u32>) -> Self {
        Self { task: task.clone(), action, record: Notes::default() }
    }

    /// The same policy, saying how it was learned; called once for each skill of a composition.
    /// [`Learner::policy`](crate::learn::Learner::policy) says it already.
    ///
    /// ```
    /// use tltl::learn::Settings;
    /// use tltl::policy::Training;
    /// use tltl::prelude::*;
    ///
    /// let task = Labelled::new(0..3, ["stay", "go"], &tltl! { |x: &i32| F ({ *x } == 2) })?;
    /// let skill = |name: &str, seed| Training {
    ///     task: name.into(),
    ///     settings: Settings::default(),
    ///     steps: 20_000,
    ///     episodes: 900,
    ///     seed,
    /// };
    /// let policy = Policy::from_fn(&task, |_, _| 1)?;
    /// let policy = policy.trained(skill("fetch", 7)).trained(skill("bring", 8));
    /// assert_eq!(policy.training()[1].task, "bring");
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn trained(mut self, training: Training) -> Self {
        self.record.training.push(training);
        self
    }

    /// The same policy, saying what it is worth: so that whoever loads it need not solve the world
    /// again.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Five cells in a row: action 0 goes left, action 1 right. Reach the right end.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let optimum = problem.optimum(&Rewards::default());
    /// let policy = optimum.q().policy();
    /// let policy = policy.clone().certified(optimum.certify(&policy)?);
    /// assert!(policy.certificate().is_some_and(|worth| worth.regret_steps == Some(0.0)));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn certified(mut self, certificate: Certificate) -> Self {
        self.record.certificate = Some(certificate);
        self
    }

    /// The same policy, saying what the shield that its actions are under costs and gains; what it
    /// is worth under it is then its certificate.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::shield::Shield;
    ///
    /// // Five cells in a row. Reach the right end, and keep off the left one until then.
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| ({ *s } != 0) U ({ *s } == 4) })?;
    /// let problem = Problem::new(&Dynamics::new(&row)?, &task)?;
    /// let (optimum, shield) = (problem.optimum(&Rewards::default()), Shield::safest(&problem, 0.0)?);
    /// let unlearned = QTable::zeros(&task); // ties go to action 0, to the left
    /// let worth = optimum.certify_shield(&shield, &unlearned)?;
    /// let policy = shield.policy(&unlearned)?.shielded(worth);
    /// assert_eq!(policy.shield().map(|worth| worth.before.satisfied), Some(0.2));
    /// assert_eq!(policy.certificate(), policy.shield().map(|worth| &worth.after));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn shielded(mut self, worth: Shielded) -> Self {
        self.record.certificate = Some(worth.after.clone());
        self.record.shield = Some(worth);
        self
    }

    /// The same policy, saying what it is worth from each start.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let task = Labelled::of_model(&row, &tltl! { |s: &usize| F ({ *s } == 4) })?;
    /// let optimum = Problem::new(&Dynamics::new(&row)?, &task)?.optimum(&Rewards::default());
    /// let policy = optimum.best().policy().clone();
    /// let policy = policy.clone().from_starts(&optimum.starts(&policy)?);
    /// let steps = policy.starts().map(|starts| starts.steps.clone());
    /// assert_eq!(steps, Some(vec![Some(4.0), Some(3.0), Some(2.0), Some(1.0), Some(0.0)]));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[must_use]
    #[inline]
    pub fn from_starts(mut self, starts: &[Start]) -> Self {
        self.record.starts = Some(Starts::new(starts));
        self
    }

    /// The same policy, saying what it was seen to be worth, in a world without a model.
    ///
    /// ```
    /// use tltl::estimate::{Trials, estimate};
    /// use tltl::model;
    /// use tltl::prelude::*;
    /// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// let (mut env, end) = (ModelEnv::new(row)?, tltl! { |s: &usize| F ({ *s } == 4) });
    /// let policy = Policy::from_fn(&Labelled::of_env(&env, &end)?, |_, _| 1)?;
    /// let trials = Trials::default().with_episodes(100)?;
    /// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    /// let act = |q, s: &usize| Ok::<_, tltl::task::Error>(policy.act(q, *s));
    /// let seen = estimate(&mut env, &end, trials, &mut rng, act)?;
    /// let policy = policy.estimated(seen);
    /// assert_eq!(policy.estimate().map(|seen| seen.satisfied.mean), Some(1.0));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    #[cfg(feature = "std")]
    #[must_use]
    #[inline]
    pub fn estimated(mut self, estimate: crate::estimate::Estimate) -> Self {
        self.record.estimate = Some(estimate);
        self
    }

    /// The same policy, saying which states of the operands of `product` its own automaton states
    /// are: a reader of the file then knows which skill is done.
    ///
    /// ```
    /// use tltl::prelude::*;
    ///
    /// let (left, right) = (tltl! { |x: &i32| F ({ *x } == 0) }, tltl! { |x: &i32| F ({ *x } == 4) });
    /// let both = Product::conjunction(&[&left, &right]);
    /// let task = Labelled::new(0..5, ["left", "right"], &both)?;
    /// let policy = Policy::from_fn(&task, |q, _| both.components(q)[0] as usize)?; // left end first
    /// let document = policy.composed(&both)?.document();
    /// assert_eq!(document.components.len(), 4);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the product has another number of states.
    pub fn composed<S: ?Sized>(mut self, product: &Product<'_, S>) -> Result<Self, PolicyError> {
        let states = product.states();
        if states != self.task.automaton_states() {
            let expected = self.task.automaton_states() as usize;
            let (field, found) = ("components", states as usize);
            return Err(PolicyError::Size { field, found, expected });
        }
        self.record.components = (0..states).map(|q| product.components(q).to_vec()).collect();
        Ok(self)
    }

    /// The task, on the world that the policy acts in.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// All that the policy says, as it is saved: the fields of the schema above.
    #[must_use]
    #[inline]
    pub fn document(&self) -> Document {
        self.clone().into()
    }

    /// How it was learned: one entry for each skill of a composition.
    #[must_use]
    #[inline]
    pub fn training(&self) -> &[Training] {
        &self.record.training
    }

    /// What it is worth, if it says so.
    #[must_use]
    #[inline]
    pub const fn certificate(&self) -> Option<&Certificate> {
        self.record.certificate.as_ref()
    }

    /// What its shield costs and gains, if it is under one.
    #[must_use]
    #[inline]
    pub const fn shield(&self) -> Option<&Shielded> {
        self.record.shield.as_ref()
    }

    /// What it is worth from each start, if it says so.
    #[must_use]
    #[inline]
    pub const fn starts(&self) -> Option<&Starts> {
        self.record.starts.as_ref()
    }

    /// What it was seen to be worth, if it says so.
    #[cfg(feature = "std")]
    #[must_use]
    #[inline]
    pub const fn estimate(&self) -> Option<&crate::estimate::Estimate> {
        self.record.estimate.as_ref()
    }

    /// The automaton state after reading the first state of an episode. The episode may be over by
    /// then; see [`Self::end`].
    ///
    /// # Panics
    /// If `s` is not a state of the world.
    #[inline]
    #[must_use]
    pub fn reset(&self, s: usize) -> u32 {
        self.task.start(s)
    }

    /// The automaton state after `q` has read `s`.
    ///
    /// # Panics
    /// If `q` or `s` is out of range.
    #[inline]
    #[must_use]
    pub fn next(&self, q: u32, s: usize) -> u32 {
        self.task.next(q, s)
    }

    /// The action in `s` at `q`.
    ///
    /// # Panics
    /// If `q` or `s` is out of range.
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn act(&self, q: u32, s: usize) -> usize {
        assert!(s < self.task.states(), "a state of the world");
        self.action[self.task.pair(q, s)] as usize
    }

    /// The sub-policy of `q`: its action in each state (paper, Eq. 3A5).
    ///
    /// # Panics
    /// If `q` is out of range.
    #[track_caller]
    #[inline]
    pub fn sub_policy(&self, q: u32) -> impl Iterator<Item = usize> {
        let layer = &self.action[self.task.pair(q, 0)..][..self.task.states()];
        layer.iter().map(|&a| a as usize)
    }

    /// How the task has ended at `q`, if it has.
    #[inline]
    #[must_use]
    pub fn end(&self, q: u32) -> Option<End> {
        self.task.end(q)
    }

    /// All actions, indexed `q * states + s`.
    #[inline]
    pub(crate) fn table(&self) -> &[u32] {
        &self.action
    }

    /// `Ok` if it is a policy for `task`.
    #[inline]
    pub(crate) fn must_be_for(&self, task: &Labelled) -> Result<(), Mismatch> {
        task.check("a policy", &self.task)
    }
}
