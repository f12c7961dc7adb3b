//! Network policies as documents: the weights, with all that is needed to run and to judge them.
//!
//! A [`NetworkPolicy`] holds a [`Network`] and says which head belongs to which automaton state. With
//! the feature `serde` it is saved and loaded by any format, and checks itself on loading, so a
//! policy in hand is a valid one; `tltlc policy` turns it into Rust that stands alone. It does not move
//! the automaton, which needs the task's predicates: the task itself does.
//!
//! # Schema, version 2
//! As JSON, every field required unless marked optional, unknown fields refused. Version 1 is the same
//! without `activation`, `scale`, `states` and `controls`, and is read too:
//! ```text
//! {
//!   "format": "tltl-network-policy",   these two first
//!   "version": 2,
//!   "task": "fetch",                   name of the task
//!   "formula": "F a && F b",           its text
//!   "actions": ["wait", "take a", ...],  A names, numbered 0..A
//!   "automaton": {
//!     "states": 4,                     N, numbered 0..N
//!     "initial": 0,                    before the first state is read
//!     "accepting": 3 | null,
//!     "trap": null
//!   },
//!   "inputs": ["x", "y"],              optional: I names of features of the state
//!   "channels": ["near", "held"],      optional: C names of features of an entity
//!   "training": [{                     one for each skill; none for a network that was not learned
//!     "task": "fetch",
//!     "steps": 200000,                 environment steps
//!     "episodes": 3100,
//!     "updates": 199000,               of the weights
//!     "gamma": 0.98,
//!     "seed": 7
//!   }, ...],
//!   "estimate": { ... },               optional: estimate::Estimate, what it was seen to be worth
//!   "network": {
//!     "shape": {
//!       "inputs": 2,                   I
//!       "hidden": [64, 64],            units of each hidden layer
//!       "heads": 3,                    H: N without the accepting state and the trap
//!       "actions": 5,                  A
//!       "entities": 2,                 E, what the last E actions point at
//!       "channels": 2                  C; 0 where E is
//!     },
//!     "activation": "tanh",            optional: of hidden units; relu if left out
//!     "scale": {                       optional: inputs become (x - mean) / deviation, within ±clip
//!       "mean": [0.5, -0.25],
//!       "deviation": [1.0, 2.0],       positive
//!       "clip": 10.0
//!     },
//!     "states": [0.0, ...],            optional: H * (first of hidden), what each live state adds to
//!                                      the first layer; then all share one head
//!     "controls": {                    optional: an action is A numbers; `actions` names each
//!       "squash": "tanh",              or "clip"
//!       "low": [-1.0, ...],            A
//!       "high": [1.0, ...]             A, none below its `low`
//!     },
//!     "layers": [                      the hidden layers, then the heads
//!       {
//!         "weights": [0.1, ...],       indexed input * outputs + output
//!         "bias": [0.0, ...]           one for each output
//!       },
//!       ...
//!     ]
//!   }
//! }
//! ```
//! Layers are `x W + b`, the outputs of the hidden ones as `activation` says. Head h belongs to the h-th
//! automaton state in which the task goes on, and puts out columns `h * w..(h + 1) * w` of the last
//! layer: values of the first A - E actions; where E > 0, one that the others have in common;
//! and C weights, whose product with the features of its entity is added to that. So w is
//! A - E + (1 if E > 0) + C. With `controls` what would be the value of action i is x_i, and number i of
//! the action is low_i + (tanh x_i + 1) / 2 (high_i - low_i), or x_i cut off at low_i and high_i.
//!
//! Numbers are 32-bit floats, written so that they are read back exactly (with serde_json, switch
//! on its feature `float_roundtrip`).
//!
//! Why a document of its own, beside that of tables: nothing in it is counted by states of the world,
//! which are not known, and there is no certificate, only an estimate. What both share (how an
//! automaton is described, that the format and the version come first) is one code.

use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

#[cfg(feature = "serde")]
use serde::{Deserialize, Serialize};

use super::{Network, NetworkError};
use crate::monitor::Acceptor;
use crate::policy::States;
use crate::q::argmax;
use crate::reward::End;

/// How a network, or a skill that it was composed from, was learned.
///
/// Less than [`Training`](crate::policy::Training) says of a table: of the settings only γ, without which
/// nobody can say what the values mean.
///
/// ```
/// use tltl::network::policy::NetworkTraining;
///
/// let how = NetworkTraining {
///     task: "fetch".into(),
///     steps: 200_000,
///     episodes: 3_100,
///     updates: 99_500,
///     gamma: 0.97,
///     seed: 7,
/// };
/// let text = serde_json::to_string(&how)?;
/// assert_eq!(serde_json::from_str::<NetworkTraining>(&text)?, how);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct NetworkTraining {
    /// The name of the task that was learned.
    pub task: String,
    /// Environment steps.
    pub steps: u64,
    /// Episodes.
    pub episodes: u64,
    /// Updates of the weights.
    pub updates: u64,
    /// The discount factor.
    pub gamma: f64,
    /// The seed.
    pub seed: u64,
}

/// The content of a network policy; [`NetworkPolicy`] is the checked form.
///
/// ```
/// use tltl::network::policy::{NetworkDocument, NetworkPolicy};
/// use tltl::network::{Dense, Network, Shape};
/// use tltl::tltl;
///
/// let shape = Shape { inputs: 1, hidden: vec![], heads: 1, actions: 2, entities: 0, channels: 0 };
/// let network = Network::new(shape, vec![Dense { weights: vec![-1.0, 1.0], bias: vec![0.0; 2] }])?;
/// let task = tltl! { |x: &f64| F ({ *x } > 3) };
/// let policy = NetworkPolicy::new(&task, vec!["left".into(), "right".into()], network)?;
/// let document: NetworkDocument = policy.into();
/// assert_eq!((&document.formula[..], document.automaton.states), (task.formula().text(), 2));
/// // What is changed by hand is checked again.
/// let named = NetworkDocument { actions: vec!["right".into()], ..document };
/// let error = NetworkPolicy::try_from(named).unwrap_err();
/// assert_eq!(error.to_string(), "`actions` has 1 names, and the network has 2 actions");
/// # use tltl::Acceptor;
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(deny_unknown_fields))]
pub struct NetworkDocument {
    /// [`NetworkPolicy::FORMAT`].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "early::format"))]
    pub format: String,
    /// [`NetworkPolicy::VERSION`].
    #[cfg_attr(feature = "serde", serde(deserialize_with = "early::version"))]
    pub version: u32,
    /// The name of the task.
    pub task: String,
    /// Its formula.
    pub formula: String,
    /// The names of the actions.
    pub actions: Vec<String>,
    /// The automaton.
    pub automaton: States,
    /// The names of the features of the state; none where they are not known.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub inputs: Vec<String>,
    /// The names of the features of an entity; none where they are not known.
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Vec::is_empty"))]
    pub channels: Vec<String>,
    /// How it was learned; for a composition, how each skill was.
    pub training: Vec<NetworkTraining>,
    /// What it was seen to be worth.
    #[cfg(feature = "std")]
    #[cfg_attr(feature = "serde", serde(default, skip_serializing_if = "Option::is_none"))]
    pub estimate: Option<crate::estimate::Estimate>,
    /// The values.
    pub network: Network,
}

/// Why a document is not a network policy.
///
/// Of several faults the first is reported, in the order in which the document is checked: what it is,
/// its automaton, its names, its worth. The network has been checked by then, as it was read.
///
/// ```
/// use tltl::network::policy::{NetworkPolicy, NetworkPolicyError};
/// use tltl::network::{Dense, Network, Shape};
/// use tltl::tltl;
///
/// // First one place, then another: two live automaton states, and a network with one head.
/// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
/// let shape = Shape { inputs: 0, hidden: vec![], heads: 1, actions: 1, entities: 0, channels: 0 };
/// let network = Network::new(shape, vec![Dense { weights: vec![], bias: vec![0.0] }])?;
/// let error = NetworkPolicy::new(&task, vec!["go".into()], network).unwrap_err();
/// assert_eq!(error, NetworkPolicyError::Heads { found: 1, expected: 2 });
/// # Ok::<(), tltl::network::NetworkError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum NetworkPolicyError {
    /// It is something else.
    Format(String),
    /// It is of another version.
    Version(u32),
    /// It has a field that its version has not.
    Field {
        /// The field.
        field: &'static str,
        /// The version that the document says it is of.
        version: u32,
    },
    /// A state of the automaton is out of range.
    Range {
        /// The field.
        field: &'static str,
        /// What stands there.
        found: u32,
        /// The number of states.
        states: u32,
    },
    /// One state is both accepting and the trap.
    Terminal(u32),
    /// There is not one head for each automaton state in which the task goes on.
    Heads {
        /// How many heads there are.
        found: usize,
        /// How many such states there are.
        expected: usize,
    },
    /// There are not as many names as the network has things to name.
    Names {
        /// The field.
        field: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// The network that was learned is none.
    Network(NetworkError),
    /// A worth is not one: a probability outside of \[0, 1\], or a negative number of steps.
    Worth {
        /// The field.
        field: &'static str,
    },
}

impl fmt::Display for NetworkPolicyError {
    #[inline]
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Format(found) => {
                let format = NetworkPolicy::FORMAT;
                write!(f, "not a network policy: format is `{found}`, not `{format}`")
            }
            Self::Version(found) => {
                let version = NetworkPolicy::VERSION;
                write!(f, "network policy version {found}; this library reads {version}")
            }
            Self::Field { field, version } => {
                write!(f, "`{field}` is not a field of version {version}")
            }
            Self::Range { field, found, states } => {
                write!(f, "`{field}` is {found}, not less than {states}")
            }
            Self::Terminal(q) => write!(f, "automaton state {q} is both accepting and the trap"),
            Self::Heads { found, expected } => write!(
                f,
                "the network has {found} heads, and the task goes on in {expected} automaton states"
            ),
            Self::Names { field, found, expected } => {
                write!(f, "`{field}` has {found} names, and the network has {expected} {field}")
            }
            Self::Network(error) => error.fmt(f),
            Self::Worth { field } => {
                write!(f, "`{field}` is not a probability, or not a number of steps")
            }
        }
    }
}

impl core::error::Error for NetworkPolicyError {}

impl From<NetworkError> for NetworkPolicyError {
    #[inline]
    fn from(error: NetworkError) -> Self {
        Self::Network(error)
    }
}

/// A policy for a task on a world whose states are features: for each automaton state a network of
/// action values.
///
/// It acts by features, which the caller writes, and by q, which the task moves:
///
/// ```
/// use tltl::network::policy::NetworkPolicy;
/// use tltl::network::{Dense, Network, Shape};
/// use tltl::{Acceptor, tltl};
///
/// // One feature, the place on a line; two heads, as two automaton states are live.
/// let shape = Shape { inputs: 1, hidden: vec![], heads: 2, actions: 2, entities: 0, channels: 0 };
/// let layers = vec![Dense { weights: vec![-1.0, 1.0, 1.0, -1.0], bias: vec![0.0; 4] }];
/// let task = tltl! { |x: &f64| ({ *x } > 3) T ({ *x } < 1) };
/// let names = ["left", "right"].map(String::from).to_vec();
/// let policy = NetworkPolicy::new(&task, names, Network::new(shape, layers)?)?;
///
/// let (mut x, mut walk) = (1.5_f32, vec![]);
/// let mut q = task.next(0, &1.5)?;
/// while policy.end(q).is_none() {
///     x += [-1.0, 1.0][policy.act(q, &[x], &[])];
///     q = task.next(q, &f64::from(x))?;
///     walk.push(x);
/// }
/// assert_eq!(walk, [2.5, 3.5, 2.5, 1.5, 0.5]);
/// assert!(task.is_accepting(q));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(Serialize, Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "NetworkDocument", into = "NetworkDocument"))]
pub struct NetworkPolicy(NetworkDocument);

impl TryFrom<NetworkDocument> for NetworkPolicy {
    type Error = NetworkPolicyError;

    #[inline]
    fn try_from(document: NetworkDocument) -> Result<Self, NetworkPolicyError> {
        document.check()?;
        Ok(Self(document))
    }
}

impl From<NetworkPolicy> for NetworkDocument {
    #[inline]
    fn from(policy: NetworkPolicy) -> Self {
        policy.0
    }
}

impl NetworkDocument {
    #[inline]
    fn check(&self) -> Result<(), NetworkPolicyError> {
        check_format(&self.format)?;
        check_version(&self.version)?;
        if let (1, Some(field)) = (self.version, self.network.form().later_field()) {
            return Err(NetworkPolicyError::Field { field, version: self.version });
        }
        self.check_automaton()?;
        let shape = self.network.shape();
        let named = |field, names: &[String], expected| match names.len() {
            found if found == expected => Ok(()),
            found => Err(NetworkPolicyError::Names { field, found, expected }),
        };
        named("actions", &self.actions, shape.actions)?;
        if !self.inputs.is_empty() {
            named("inputs", &self.inputs, shape.inputs)?;
        }
        if !self.channels.is_empty() {
            named("channels", &self.channels, shape.channels)?;
        }
        #[cfg(feature = "std")]
        self.check_worth()?;
        Ok(())
    }

    #[cfg(feature = "std")]
    #[inline]
    fn check_worth(&self) -> Result<(), NetworkPolicyError> {
        let Some(estimate) = &self.estimate else { return Ok(()) };
        let probability = |interval: &crate::estimate::Interval| {
            [interval.low, interval.mean, interval.high].iter().all(|p| (0.0..=1.0).contains(p))
        };
        let steps = estimate.steps.is_none_or(|steps| steps.mean >= 0.0);
        let sound =
            |field, sound| if sound { Ok(()) } else { Err(NetworkPolicyError::Worth { field }) };
        sound("estimate.satisfied", probability(&estimate.satisfied))?;
        sound("estimate.lost", probability(&estimate.lost))?;
        sound("estimate.steps", steps)
    }

    #[inline]
    fn check_automaton(&self) -> Result<(), NetworkPolicyError> {
        let States { states, initial, accepting, trap } = self.automaton;
        let below = |field, state| match state {
            Some(found) if found >= states => {
                Err(NetworkPolicyError::Range { field, found, states })
            }
            _ => Ok(()),
        };
        below("automaton.initial", Some(initial))?;
        below("automaton.accepting", accepting)?;
        below("automaton.trap", trap)?;
        if let (Some(q), true) = (accepting, accepting == trap) {
            return Err(NetworkPolicyError::Terminal(q));
        }
        let decided = usize::from(accepting.is_some()) + usize::from(trap.is_some());
        match (self.network.shape().heads, states as usize - decided) {
            (found, expected) if found != expected => {
                Err(NetworkPolicyError::Heads { found, expected })
            }
            _ => Ok(()),
        }
    }
}

impl NetworkPolicy {
    /// The value of the field `format`.
    pub const FORMAT: &'static str = "tltl-network-policy";

    /// The version that this library writes. It reads 1 too.
    pub const VERSION: u32 = 2;

    /// The policy that is greedy in `network`, whose heads are the states in which `task` goes on;
    /// `actions` are what the world's actions are called.
    ///
    /// # Errors
    /// If the network does not fit the task or the names.
    pub fn new(
        task: &(impl Acceptor + ?Sized),
        actions: Vec<String>,
        network: Network,
    ) -> Result<Self, NetworkPolicyError> {
        Self::try_from(NetworkDocument {
            format: Self::FORMAT.to_string(),
            version: Self::VERSION,
            task: task.name().to_string(),
            formula: task.formula().text().to_string(),
            actions,
            automaton: States::of(task),
            inputs: Vec::new(),
            channels: Vec::new(),
            training: Vec::new(),
            #[cfg(feature = "std")]
            estimate: None,
            network,
        })
    }

    /// The same policy, saying what the features of the state and of an entity are.
    ///
    /// ```
    /// use tltl::network::policy::NetworkPolicy;
    /// use tltl::network::{Dense, Network, Shape};
    /// use tltl::tltl;
    ///
    /// let shape = Shape { inputs: 1, hidden: vec![], heads: 1, actions: 2, entities: 0, channels: 0 };
    /// let network = Network::new(shape, vec![Dense { weights: vec![-1.0, 1.0], bias: vec![0.0; 2] }])?;
    /// let task = tltl! { |x: &f64| F ({ *x } > 3) };
    /// let policy = NetworkPolicy::new(&task, vec!["left".into(), "right".into()], network)?;
    /// assert!(policy.clone().described(vec!["x".into(), "y".into()], vec![]).is_err());
    /// let policy = policy.described(vec!["x".into()], vec![])?;
    /// assert_eq!(policy.document().inputs, ["x"]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// Unless there are as many names as features, or none.
    #[inline]
    pub fn described(
        mut self,
        inputs: Vec<String>,
        channels: Vec<String>,
    ) -> Result<Self, NetworkPolicyError> {
        (self.0.inputs, self.0.channels) = (inputs, channels);
        Self::try_from(self.0)
    }

    /// The same policy, saying how it was learned; called once for each skill of a composition.
    ///
    /// `deep::Learner::policy` says it already.
    #[must_use]
    #[inline]
    pub fn trained(mut self, training: NetworkTraining) -> Self {
        self.0.training.push(training);
        self
    }

    /// The same policy, saying what it was seen to be worth.
    #[cfg(feature = "std")]
    #[must_use]
    #[inline]
    pub fn estimated(mut self, estimate: crate::estimate::Estimate) -> Self {
        self.0.estimate = Some(estimate);
        self
    }

    /// All that the policy says.
    #[must_use]
    #[inline]
    pub const fn document(&self) -> &NetworkDocument {
        &self.0
    }

    /// The network.
    #[must_use]
    #[inline]
    pub const fn network(&self) -> &Network {
        &self.0.network
    }

    /// How the task has ended at `q`, if it has.
    #[must_use]
    #[inline]
    pub fn end(&self, q: u32) -> Option<End> {
        match q {
            q if self.0.automaton.accepting == Some(q) => Some(End::Accepted),
            q if self.0.automaton.trap == Some(q) => Some(End::Lost),
            _ => None,
        }
    }

    /// The head of `q`: the number of states before it in which the task goes on. `None` where it is
    /// decided.
    ///
    /// ```
    /// use tltl::network::policy::NetworkPolicy;
    /// use tltl::network::{Dense, Network, Shape};
    /// use tltl::{Acceptor, tltl};
    ///
    /// // Of `!c U a` one state is live: 0. State 1 accepts, and 2 is the trap.
    /// let task = tltl! { |s: &(bool, bool)| !s.0 U s.1 };
    /// let shape = Shape { inputs: 0, hidden: vec![], heads: 1, actions: 1, entities: 0, channels: 0 };
    /// let network = Network::new(shape, vec![Dense { weights: vec![], bias: vec![0.25] }])?;
    /// let policy = NetworkPolicy::new(&task, vec!["go".into()], network)?;
    /// assert_eq!([0, 1, 2].map(|q| policy.head(q)), [Some(0), None, None]);
    /// assert_eq!([0, 1, 2].map(|q| policy.values(q, &[], &[])[0]), [0.25, 0.0, 0.0]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn head(&self, q: u32) -> Option<usize> {
        assert!(q < self.0.automaton.states, "a state of the automaton");
        let live = |&q: &u32| self.end(q).is_none();
        live(&q).then(|| (0..q).filter(live).count())
    }

    /// Q(s, q, ·), from the features of s as [`Network::values`] takes them. Where the task is decided
    /// nothing more can be had: all values are 0, as in a [`QTable`](crate::q::QTable).
    ///
    /// # Panics
    /// If `q` is not a state of the automaton, or the features do not fit the network.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn values(&self, q: u32, inputs: &[f32], entities: &[f32]) -> Vec<f32> {
        let network = self.network();
        match self.head(q) {
            Some(head) => network.values(head, inputs, entities),
            None => alloc::vec![0.0; network.shape().actions],
        }
    }

    /// The action of the largest value at `q`, the lowest of equals: action 0 where the task is
    /// decided. Where an action is numbers, [`Self::control`] says them.
    ///
    /// # Panics
    /// As [`Self::values`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn act(&self, q: u32, inputs: &[f32], entities: &[f32]) -> usize {
        argmax(&self.values(q, inputs, entities))
    }

    /// The numbers that the action at `q` is, each within its bounds: those of outputs of 0 where the
    /// task is decided. `None` if the network chooses among actions.
    ///
    /// ```
    /// use tltl::network::policy::NetworkPolicy;
    /// use tltl::network::{Controls, Dense, Form, Network, Shape, Squash};
    /// use tltl::tltl;
    ///
    /// // A speed between -2 and 2, against the place.
    /// let shape = Shape { inputs: 1, hidden: vec![], heads: 1, actions: 1, entities: 0, channels: 0 };
    /// let controls = Controls { squash: Squash::Clip, low: vec![-2.0], high: vec![2.0] };
    /// let form = Form { controls: Some(controls), ..Form::default() };
    /// let layers = vec![Dense { weights: vec![-0.5], bias: vec![0.0] }];
    /// let network = Network::with_form(shape, layers, form)?;
    /// let task = tltl! { |x: &f64| F (-1 < { *x } < 1) };
    /// let policy = NetworkPolicy::new(&task, vec!["speed".into()], network)?;
    /// let found = [3.0, 9.0].map(|x| policy.control(0, &[x], &[]));
    /// assert_eq!(found, [Some(vec![-1.5]), Some(vec![-2.0])]);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Panics
    /// As [`Self::values`].
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn control(&self, q: u32, inputs: &[f32], entities: &[f32]) -> Option<Vec<f32>> {
        let controls = self.network().form().controls.as_ref()?;
        let values = self.values(q, inputs, entities).into_iter().enumerate();
        Some(values.map(|(i, x)| controls.of(i, x)).collect())
    }
}

#[inline]
fn check_format(found: &String) -> Result<(), NetworkPolicyError> {
    let known = found == NetworkPolicy::FORMAT;
    if known { Ok(()) } else { Err(NetworkPolicyError::Format(found.clone())) }
}

#[inline]
fn check_version(found: &u32) -> Result<(), NetworkPolicyError> {
    let known = (1..=NetworkPolicy::VERSION).contains(found);
    if known { Ok(()) } else { Err(NetworkPolicyError::Version(*found)) }
}

/// What says what a document is, looked at where it stands: before fields that only another format
/// has.
#[cfg(feature = "serde")]
mod early {
    use alloc::string::String;

    use serde::de::Deserializer;

    use super::{check_format, check_version};
    use crate::policy::checked;

    pub(super) fn format<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
        checked(from, check_format)
    }

    pub(super) fn version<'de, D: Deserializer<'de>>(from: D) -> Result<u32, D::Error> {
        checked(from, check_version)
    }
}
