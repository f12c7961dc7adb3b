//! Policies as documents: what was learned, with all that is needed to run and to judge it.
//!
//! A [`Policy`] holds the greedy actions, the automaton as tables over the world's states, how it
//! was trained and what it is worth. With the feature `serde` it is saved and loaded by any
//! format; [`Policy`] checks itself on loading, so a policy in hand is a valid one. It runs
//! without its task: [`Policy::reset`] and [`Policy::next`] move the automaton by state numbers.
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
//!   "training": [{                     one for each skill; none for a policy that was solved
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
//!     "fraction_optimal": 0.97
//!   } | null,
//!   "shield": {                        optional: what a shield laid over it costs and gains
//!     "before": { ... },               a certificate, as above; that after it is `certificate`
//!     "after": { ... },
//!     "lost_before": 0.02,             P(the trap is entered), and the smallest possible
//!     "lost_after": 0.015,
//!     "smallest_lost": 0.015,
//!     "overruled": 0.01                fraction of live pairs in which it overrules the policy
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

use alloc::string::{String, ToString};
use alloc::vec::Vec;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

#[cfg(feature = "serde")]
pub(crate) use document::checked;
pub use document::{Document, Invalid, Starts, States, Training};

use crate::augmented::{End, Labelled};
use crate::shield::Shielded;
use crate::solve::{Certificate, Start};

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

impl Policy {
    /// The value of the field `format`.
    pub const FORMAT: &'static str = "tltl-policy";

    /// The version that this library writes and reads.
    pub const VERSION: u32 = 2;

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
            training: Vec::new(),
            certificate: None,
            shield: None,
            starts: None,
            #[cfg(feature = "std")]
            estimate: None,
        };
        Self::try_from(document)
    }

    /// The same policy, saying how it was learned; called once for each skill of a composition.
    #[must_use]
    pub fn trained(mut self, training: Training) -> Self {
        self.0.training.push(training);
        self
    }

    /// The same policy, saying what it is worth.
    #[must_use]
    pub fn certified(mut self, certificate: Certificate) -> Self {
        self.0.certificate = Some(certificate);
        self
    }

    /// The same policy, saying what the shield that its actions are under costs and gains; what it
    /// is worth under it is then its certificate.
    #[must_use]
    pub fn shielded(mut self, worth: Shielded) -> Self {
        self.0.certificate = Some(worth.after.clone());
        self.0.shield = Some(worth);
        self
    }

    /// The same policy, saying what it is worth from each start.
    #[must_use]
    pub fn from_starts(mut self, starts: &[Start]) -> Self {
        self.0.starts = Some(Starts::new(starts));
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
