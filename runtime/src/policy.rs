//! Policies as documents: what was learned, with all that is needed to run and to judge it.
//!
//! A [`Policy`] holds the greedy actions, the automaton as tables over the world's states, how it
//! was trained and what it is worth. With the feature `serde` it is saved and loaded by any
//! format; [`Policy`] checks itself on loading, so a policy in hand is a valid one. It runs
//! without its task: [`Policy::reset`] and [`Policy::next`] move the automaton by state numbers.
//!
//! # Schema, version 1
//! As JSON, every field required unless marked optional, unknown fields refused:
//! ```text
//! {
//!   "format": "tltl-policy",
//!   "version": 1,
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
//!   "training": {                      null for a policy that was solved, not learned
//!     "settings": { ... },             learn::Settings
//!     "steps": 1000000,                environment steps
//!     "episodes": 35000
//!   } | null,
//!   "seed": 7 | null,
//!   "certificate": {                   null where the world has no model
//!     "kind": "exact",
//!     "satisfied": 1.0,                P(satisfied), mean over the starts with s_0 read
//!     "steps": 12.2003,                E[steps] given success; null: never succeeds
//!     "optimal_satisfied": 1.0,
//!     "optimal_steps": 12.2002,         null: success is impossible
//!     "regret_satisfied": 0.0,
//!     "regret_steps": 0.00001,          null where one of the two is
//!     "worst_regret_satisfied": 0.0,
//!     "fraction_optimal": 0.97
//!   } | null,
//!   "estimate": { ... }                optional: estimate::Estimate, where it was tried instead
//! }
//! ```
//! An episode in state number s: `q = next[initial * C + class[s]]` on reset; then, until q is
//! accepting or the trap, take `action[q * S + s]`, and `q = next[q * C + class[s']]`.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use crate::augmented::{End, Labelled};
use crate::learn::{Learner, Settings};
use crate::solve::Certificate;

/// The automaton of a policy, without its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct States {
    /// The number of states.
    pub states: u32,
    /// The state before the first state of the world is read.
    pub initial: u32,
    /// The accepting state.
    pub accepting: Option<u32>,
    /// The trap.
    pub trap: Option<u32>,
}

/// How a policy was learned.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Training {
    /// The settings.
    pub settings: Settings,
    /// Environment steps.
    pub steps: u64,
    /// Episodes.
    pub episodes: u64,
}

impl Training {
    /// What `learner` has done so far.
    #[must_use]
    pub fn of<R: rand::Rng + Clone>(learner: &Learner<R>) -> Self {
        Self { settings: *learner.settings(), steps: learner.steps(), episodes: learner.episodes() }
    }
}

/// The content of a policy; [`Policy`] is the checked form.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Document {
    /// [`Policy::FORMAT`].
    pub format: String,
    /// [`Policy::VERSION`].
    pub version: u32,
    /// The name of the task.
    pub task: String,
    /// Its formula.
    pub formula: String,
    /// The number of states of the world.
    pub states: usize,
    /// The names of the actions.
    pub actions: Vec<String>,
    /// The automaton.
    pub automaton: States,
    /// The number of classes of states.
    pub classes: usize,
    /// The class of each state.
    pub class: Vec<u32>,
    /// The next automaton state, `q * classes + class`.
    pub next: Vec<u32>,
    /// The action, `q * states + s`.
    pub action: Vec<u32>,
    /// For a product: the operands' states at each of its own.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub components: Vec<Vec<u32>>,
    /// How it was learned.
    pub training: Option<Training>,
    /// The seed it was learned with.
    pub seed: Option<u64>,
    /// What it is worth.
    pub certificate: Option<Certificate>,
    /// What it was seen to be worth, in a world without a model.
    #[cfg(feature = "std")]
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub estimate: Option<crate::estimate::Estimate>,
}

/// Why a document is not a policy.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Invalid {
    /// It is something else.
    Format(String),
    /// It is of another version.
    Version(u32),
    /// A table has the wrong size, or there are no states, classes or actions.
    Size {
        /// The field.
        field: &'static str,
        /// How many entries it has.
        found: usize,
        /// How many it should have; 0: at least one.
        expected: usize,
    },
    /// An entry is out of range.
    Range {
        /// The field.
        field: &'static str,
        /// Where in it.
        at: usize,
        /// What stands there.
        found: u32,
        /// What it must be less than.
        limit: usize,
    },
    /// The accepting state and the trap are the same, or one of them has a way out.
    Terminal(u32),
}

impl fmt::Display for Invalid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(found) => {
                write!(f, "not a policy: format is `{found}`, not `{}`", Policy::FORMAT)
            }
            Self::Version(found) => {
                write!(f, "policy version {found}; this library reads {}", Policy::VERSION)
            }
            Self::Size { field, expected: 0, .. } => write!(f, "`{field}` is empty"),
            Self::Size { field, found, expected } => {
                write!(f, "`{field}` has {found} entries, not {expected}")
            }
            Self::Range { field, at, found, limit } => {
                write!(f, "`{field}`, entry {at}: {found} is not less than {limit}")
            }
            Self::Terminal(q) => {
                write!(f, "automaton state {q} is accepting or the trap, and yet not final")
            }
        }
    }
}

impl core::error::Error for Invalid {}

/// A policy for a task on a finite world: for each automaton state and state an action.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "Document", into = "Document"))]
pub struct Policy(Document);

impl TryFrom<Document> for Policy {
    type Error = Invalid;

    fn try_from(document: Document) -> Result<Self, Invalid> {
        document.check()?;
        Ok(Self(document))
    }
}

impl From<Policy> for Document {
    fn from(policy: Policy) -> Self {
        policy.0
    }
}

impl Document {
    fn check(&self) -> Result<(), Invalid> {
        if self.format != Policy::FORMAT {
            return Err(Invalid::Format(self.format.clone()));
        }
        if self.version != Policy::VERSION {
            return Err(Invalid::Version(self.version));
        }
        self.check_sizes()?;
        let n = self.automaton.states as usize;
        below("class", &self.class, self.classes)?;
        below("next", &self.next, n)?;
        below("action", &self.action, self.actions.len())?;
        let States { initial, accepting, trap, .. } = self.automaton;
        below("automaton.initial", &[initial], n)?;
        below("automaton.accepting", accepting.as_slice(), n)?;
        below("automaton.trap", trap.as_slice(), n)?;
        accepting.into_iter().chain(trap).try_for_each(|q| self.check_terminal(q))
    }

    fn check_sizes(&self) -> Result<(), Invalid> {
        let n = self.automaton.states as usize;
        nonempty("states", self.states)?;
        nonempty("actions", self.actions.len())?;
        nonempty("classes", self.classes)?;
        nonempty("automaton.states", n)?;
        size("class", self.class.len(), Some(self.states))?;
        size("next", self.next.len(), n.checked_mul(self.classes))?;
        size("action", self.action.len(), n.checked_mul(self.states))?;
        let components = self.components.len();
        size("components", components, Some(if components == 0 { 0 } else { n }))
    }

    fn check_terminal(&self, q: u32) -> Result<(), Invalid> {
        let row = &self.next[q as usize * self.classes..][..self.classes];
        let both = self.automaton.accepting == self.automaton.trap;
        if both || row.iter().any(|&to| to != q) { Err(Invalid::Terminal(q)) } else { Ok(()) }
    }
}

fn nonempty(field: &'static str, found: usize) -> Result<(), Invalid> {
    if found == 0 { Err(Invalid::Size { field, found, expected: 0 }) } else { Ok(()) }
}

fn size(field: &'static str, found: usize, expected: Option<usize>) -> Result<(), Invalid> {
    match expected {
        Some(expected) if found == expected => Ok(()),
        _ => Err(Invalid::Size { field, found, expected: expected.unwrap_or(usize::MAX) }),
    }
}

fn below(field: &'static str, entries: &[u32], limit: usize) -> Result<(), Invalid> {
    match entries.iter().position(|&entry| entry as usize >= limit) {
        Some(at) => Err(Invalid::Range { field, at, found: entries[at], limit }),
        None => Ok(()),
    }
}

impl Policy {
    /// The value of the field `format`.
    pub const FORMAT: &'static str = "tltl-policy";

    /// The version that this library writes and reads.
    pub const VERSION: u32 = 1;

    /// The policy `action`, indexed `q * states + s`, for the task `labelled`; `name` and `formula`
    /// say which task that is, `actions` what the actions are called.
    ///
    /// # Errors
    /// If the actions do not fit the task or the names.
    pub fn new(
        name: &str,
        formula: &str,
        labelled: &Labelled,
        action: Vec<u32>,
        actions: Vec<String>,
    ) -> Result<Self, Invalid> {
        let end = |end| (0..labelled.automaton_states()).find(|&q| labelled.end(q) == Some(end));
        let document = Document {
            format: Self::FORMAT.to_string(),
            version: Self::VERSION,
            task: name.to_string(),
            formula: formula.to_string(),
            states: labelled.states(),
            actions,
            automaton: States {
                states: labelled.automaton_states(),
                initial: 0,
                accepting: end(End::Accepted),
                trap: end(End::Lost),
            },
            classes: labelled.classes(),
            class: labelled.class().to_vec(),
            next: labelled.table().to_vec(),
            action,
            components: Vec::new(),
            training: None,
            seed: None,
            certificate: None,
            #[cfg(feature = "std")]
            estimate: None,
        };
        Self::try_from(document)
    }

    /// The same policy, saying how it was learned.
    #[must_use]
    pub fn trained(mut self, training: Training, seed: u64) -> Self {
        (self.0.training, self.0.seed) = (Some(training), Some(seed));
        self
    }

    /// The same policy, saying what it is worth.
    #[must_use]
    pub fn certified(mut self, certificate: Certificate) -> Self {
        self.0.certificate = Some(certificate);
        self
    }

    /// The same policy, saying what it was seen to be worth.
    #[cfg(feature = "std")]
    #[must_use]
    pub fn estimated(mut self, estimate: crate::estimate::Estimate) -> Self {
        self.0.estimate = Some(estimate);
        self
    }

    /// The same policy, saying which states of a product's operands its own are.
    ///
    /// # Errors
    /// Unless there is a list for each automaton state.
    pub fn composed(mut self, components: Vec<Vec<u32>>) -> Result<Self, Invalid> {
        self.0.components = components;
        Self::try_from(self.0)
    }

    /// All that the policy says.
    #[must_use]
    pub const fn document(&self) -> &Document {
        &self.0
    }

    /// The automaton state after reading the first state of an episode.
    ///
    /// # Panics
    /// If `s` is not a state of the world.
    #[must_use]
    pub fn reset(&self, s: usize) -> u32 {
        self.next(self.0.automaton.initial, s)
    }

    /// The automaton state after `q` has read `s`.
    ///
    /// # Panics
    /// If `q` or `s` are out of range.
    #[must_use]
    pub fn next(&self, q: u32, s: usize) -> u32 {
        self.0.next[q as usize * self.0.classes + self.0.class[s] as usize]
    }

    /// The action in `s` at `q`.
    ///
    /// # Panics
    /// If `q` or `s` are out of range.
    #[must_use]
    pub fn act(&self, q: u32, s: usize) -> u32 {
        assert!(s < self.0.states, "a state of the world");
        self.0.action[q as usize * self.0.states + s]
    }

    /// The sub-policy of `q`: its action in each state (paper, Eq. 3A5).
    ///
    /// # Panics
    /// If `q` is out of range.
    #[must_use]
    pub fn sub_policy(&self, q: u32) -> &[u32] {
        &self.0.action[q as usize * self.0.states..][..self.0.states]
    }

    /// How the task has ended at `q`, if it has.
    #[must_use]
    pub fn end(&self, q: u32) -> Option<End> {
        match q {
            q if self.0.automaton.accepting == Some(q) => Some(End::Accepted),
            q if self.0.automaton.trap == Some(q) => Some(End::Lost),
            _ => None,
        }
    }
}
