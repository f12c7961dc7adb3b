//! What a policy's file says, and when it is a policy.
//!
//! [`Document`] has the fields of the file, unchecked; [`Policy`] is made of one by `try_from`, which
//! checks every size and every entry, so that nothing in a file can make a policy panic later. The
//! format and the version are looked at where they stand: a file of another format is refused for
//! being that, not for a field that the other format does not have.
//!
//! What is not checked: whether the certificate, the starts and the estimate are *true*. They are what
//! the writer says, and a reader with a model can certify again. Nor is the automaton compared with the
//! formula, for the runtime does not parse: the formula is a text to show.

use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::Policy;
use crate::certificate::{Certificate, Shielded, Start};
use crate::monitor::Acceptor;
use crate::reward::Ends;
use crate::settings::Settings;

/// The automaton of a policy, without its edges.
///
/// ```
/// use tltl::policy::States;
/// use tltl::tltl;
///
/// let states = States::of(&tltl! { |s: &(bool, bool)| !s.0 U s.1 });
/// assert_eq!((states.states, states.initial), (3, 0));
/// assert_eq!((states.accepting, states.trap), (Some(1), Some(2)));
/// ```
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

impl States {
    /// Those of a task; the first accepting state and the first trap, if there are several.
    #[must_use]
    pub fn of(task: &(impl Acceptor + ?Sized)) -> Self {
        let ends = Ends::of(task);
        let (accepting, trap) = (ends.accepting(), ends.trap());
        Self { states: ends.states(), initial: 0, accepting, trap }
    }
}

/// How a policy, or a skill that it was composed from, was learned: all that is needed to learn it
/// again. [`Learner::training`](crate::learn::Learner::training) has it.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let mut env = ModelEnv::new(model::from_fn(2, 1, |s, _| [(1 - s, 1.0)]))?;
/// let task = Labelled::of_env(&env, &tltl! { |s: &usize| F ({ *s } == 1) })?;
/// let mut learner = Learner::new(&task, Settings::default(), 7);
/// learner.train(&mut env, 100)?;
/// let how = learner.policy().training()[0].clone();
/// assert_eq!((how.steps, how.seed), (100, 7));
/// // The same settings, seed and number of steps give the same policy.
/// let mut again = Learner::new(&task, how.settings, how.seed);
/// again.train(&mut env, how.steps)?;
/// assert_eq!(again.policy(), learner.policy());
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Training {
    /// The name of the task that was learned.
    pub task: String,
    /// The settings.
    pub settings: Settings,
    /// Environment steps.
    pub steps: u64,
    /// Episodes.
    pub episodes: u64,
    /// The seed.
    pub seed: u64,
}

/// What a policy is worth from each state in which an episode can start, `s_0` read: columns of
/// the same length.
///
/// ```
/// use tltl::policy::Starts;
/// use tltl::solve::Start;
///
/// let start = Start {
///     state: 3,
///     satisfied: 0.5,
///     steps: Some(7.0),
///     optimal_satisfied: 1.0,
///     optimal_steps: Some(9.0),
/// };
/// let columns = Starts::new(&[start]);
/// assert_eq!((&columns.state[..], &columns.satisfied[..]), (&[3][..], &[0.5][..]));
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Starts {
    /// The states' numbers, ascending.
    pub state: Vec<usize>,
    /// P(satisfied).
    pub satisfied: Vec<f64>,
    /// E\[steps\] given success; `None` where it never succeeds.
    pub steps: Vec<Option<f64>>,
}

impl Starts {
    /// The columns of what [`Optimum::starts`](crate::solve::Optimum::starts) or a
    /// [`Report`](crate::solve::Report) has, in the order of the states.
    #[must_use]
    #[inline]
    pub fn new(starts: &[Start]) -> Self {
        let mut columns = Self { state: Vec::new(), satisfied: Vec::new(), steps: Vec::new() };
        let mut starts = starts.to_vec();
        starts.sort_unstable_by_key(|start| start.state);
        for start in starts {
            columns.state.push(start.state);
            columns.satisfied.push(start.satisfied);
            columns.steps.push(start.steps);
        }
        columns
    }
}

/// The content of a policy; [`Policy`] is the checked form.
///
/// ```
/// use tltl::policy::Document;
/// use tltl::prelude::*;
///
/// let task = Labelled::new(0..3, ["stay", "go"], &tltl! { |x: &i32| F ({ *x } == 2) })?;
/// let mut document: Document = Policy::from_fn(&task, |_, _| 1)?.document();
/// assert_eq!((document.states, &document.actions[1][..]), (3, "go"));
/// document.next[0] = 9;
/// let error = Policy::try_from(document).unwrap_err();
/// assert_eq!(error.to_string(), "`next`, entry 0: 9 is not less than 2");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct Document {
    /// [`Policy::FORMAT`].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "early::format"))]
    pub format: String,
    /// [`Policy::VERSION`].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "early::version"))]
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
    pub action: Vec<usize>,
    /// For a product: the operands' states at each of its own.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub components: Vec<Vec<u32>>,
    /// How it was learned: one entry, one for each skill of a composition, none if it was solved.
    pub training: Vec<Training>,
    /// What it is worth.
    pub certificate: Option<Certificate>,
    /// What the shield that is laid over it costs and gains.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub shield: Option<Shielded>,
    /// What it is worth from each start.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub starts: Option<Starts>,
    /// What it was seen to be worth, in a world without a model.
    #[cfg(feature = "std")]
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub estimate: Option<crate::estimate::Estimate>,
}

/// Why a document, or a list of actions, is not a policy.
///
/// Each names the field by its path in the document, so that whoever writes the file finds it.
///
/// ```
/// use tltl::policy::{Document, PolicyError};
/// use tltl::prelude::*;
///
/// let task = Labelled::new(0..3, ["stay", "go"], &tltl! { |x: &i32| F ({ *x } == 2) })?;
/// let document: Document = Policy::from_fn(&task, |_, _| 1)?.document();
/// let short = Document { action: vec![1; 5], ..document.clone() };
/// let error = PolicyError::Size { field: "action", found: 5, expected: 6 };
/// assert_eq!(Policy::try_from(short), Err(error));
/// let later = Policy::try_from(Document { version: 3, ..document }).unwrap_err();
/// assert_eq!(later.to_string(), "policy version 3; this library reads 2");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PolicyError {
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
        found: usize,
        /// What it must be less than.
        limit: usize,
    },
    /// The accepting state and the trap are the same, or one of them has a way out.
    Terminal(u32),
    /// A worth is not one: a probability outside of [0, 1], or a negative number of steps.
    Worth {
        /// The field.
        field: &'static str,
        /// Where in it; 0 for a single number.
        at: usize,
    },
    /// The states of `starts` do not ascend.
    Order(usize),
}

impl fmt::Display for PolicyError {
    #[inline]
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
            Self::Worth { field, at } => {
                write!(f, "`{field}`, entry {at}: not a probability, or not a number of steps")
            }
            Self::Order(at) => write!(f, "`starts.state`, entry {at}: the states must ascend"),
        }
    }
}

impl core::error::Error for PolicyError {}

impl Document {
    /// In this order: what kind of document it is, then sizes, then entries, then what the entries mean,
    /// each relying on those before; the first error is reported.
    #[inline]
    pub(super) fn check(&self) -> Result<(), PolicyError> {
        check_format(&self.format)?;
        check_version(&self.version)?;
        self.check_sizes()?;
        let n = self.automaton.states as usize;
        below("class", &self.class, self.classes)?;
        below("next", &self.next, n)?;
        below("action", &self.action, self.actions.len())?;
        let States { initial, accepting, trap, .. } = self.automaton;
        below("automaton.initial", &[initial], n)?;
        below("automaton.accepting", accepting.as_slice(), n)?;
        below("automaton.trap", trap.as_slice(), n)?;
        self.check_terminal(accepting)?;
        self.check_terminal(trap)?;
        self.check_worth()
    }

    #[inline]
    fn check_worth(&self) -> Result<(), PolicyError> {
        if let Some(certificate) = &self.certificate {
            check_certificate(certificate)?;
        }
        if let Some(Shielded { before, after, .. }) = &self.shield {
            check_certificate(before)?;
            check_certificate(after)?;
        }
        let Some(Starts { state, satisfied, steps }) = &self.starts else { return Ok(()) };
        below("starts.state", state, self.states)?;
        size("starts.satisfied", satisfied.len(), Some(state.len()))?;
        size("starts.steps", steps.len(), Some(state.len()))?;
        probabilities("starts.satisfied", satisfied)?;
        durations("starts.steps", steps)?;
        let unsorted = state.windows(2).position(|pair| pair[0] >= pair[1]);
        unsorted.map_or(Ok(()), |at| Err(PolicyError::Order(at + 1)))
    }

    #[inline]
    fn check_sizes(&self) -> Result<(), PolicyError> {
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

    /// A policy never acts at an end, so an end with a way out would be a state without a meaning.
    #[inline]
    fn check_terminal(&self, end: Option<u32>) -> Result<(), PolicyError> {
        let Some(q) = end else { return Ok(()) };
        let row = &self.next[q as usize * self.classes..][..self.classes];
        let both = self.automaton.accepting == self.automaton.trap;
        if both || row.iter().any(|&to| to != q) { Err(PolicyError::Terminal(q)) } else { Ok(()) }
    }
}

#[inline]
fn check_format(found: &String) -> Result<(), PolicyError> {
    let known = found == Policy::FORMAT;
    if known { Ok(()) } else { Err(PolicyError::Format(found.clone())) }
}

#[inline]
fn check_version(found: &u32) -> Result<(), PolicyError> {
    let known = *found == Policy::VERSION;
    if known { Ok(()) } else { Err(PolicyError::Version(*found)) }
}

#[inline]
fn check_certificate(certificate: &Certificate) -> Result<(), PolicyError> {
    let Certificate { satisfied, optimal_satisfied, steps, .. } = certificate;
    probabilities("certificate.satisfied", &[*satisfied, *optimal_satisfied])?;
    let within = certificate.within.map(|within| [within.satisfied, within.optimal_satisfied]);
    probabilities("certificate.within", within.as_ref().map_or(&[], |both| both))?;
    durations("certificate.steps", &[*steps])
}

#[inline]
fn nonempty(field: &'static str, found: usize) -> Result<(), PolicyError> {
    if found == 0 { Err(PolicyError::Size { field, found, expected: 0 }) } else { Ok(()) }
}

#[inline]
fn size(field: &'static str, found: usize, expected: Option<usize>) -> Result<(), PolicyError> {
    match expected {
        Some(expected) if found == expected => Ok(()),
        _ => Err(PolicyError::Size { field, found, expected: expected.unwrap_or(usize::MAX) }),
    }
}

fn below<T: Copy + TryInto<usize>>(
    field: &'static str,
    entries: &[T],
    limit: usize,
) -> Result<(), PolicyError> {
    let found = |entry: T| entry.try_into().unwrap_or(usize::MAX);
    match entries.iter().position(|&entry| found(entry) >= limit) {
        Some(at) => Err(PolicyError::Range { field, at, found: found(entries[at]), limit }),
        None => Ok(()),
    }
}

/// Whether all are probabilities, within the error of a sum over all starts: a file may come from
/// another program, which rounds elsewhere.
#[inline]
fn probabilities(field: &'static str, values: &[f64]) -> Result<(), PolicyError> {
    let bad = values.iter().position(|p| !(-1e-9..=1.0 + 1e-9).contains(p));
    bad.map_or(Ok(()), |at| Err(PolicyError::Worth { field, at }))
}

#[inline]
fn durations(field: &'static str, values: &[Option<f64>]) -> Result<(), PolicyError> {
    let bad =
        values.iter().position(|steps| steps.is_some_and(|steps| steps.is_nan() || steps < 0.0));
    bad.map_or(Ok(()), |at| Err(PolicyError::Worth { field, at }))
}

/// What says what a document is, looked at where it stands: before fields that only another format
/// has.
#[cfg(feature = "serde")]
mod early {
    use alloc::string::String;

    use serde::de::Deserializer;

    use super::{check_format, check_version, checked};

    pub(super) fn format<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
        checked(from, check_format)
    }

    pub(super) fn version<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
        checked(from, check_version)
    }
}

/// A field that is refused on reading unless it passes `check`.
#[cfg(feature = "serde")]
pub(crate) fn checked<'de, T: Deserialize<'de>, E: fmt::Display, D: serde::Deserializer<'de>>(
    from: D,
    check: impl FnOnce(&T) -> Result<(), E>,
) -> Result<T, D::Error> {
    let field = T::deserialize(from)?;
    check(&field).map_err(serde::de::Error::custom).map(|()| field)
}
