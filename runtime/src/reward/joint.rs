//! Rewards of tasks whose parts run side by side: a state is one automaton state for each part.
//!
//! Such states are too many to be numbered (24 goals have 2^24), so a move is paid from the parts. It
//! leaves its state if a part does; it is satisfied when all parts are, and lost when one is. The potential
//! of [`Mode::Shaped`](super::Mode::Shaped) is the mean of the parts', those that are done counting 1: so
//! each part that comes nearer is paid for, in any order. It is a function of the state and 0 at its
//! ends, so the optimal policies are those of acceptance, as with a single automaton.

use alloc::vec::Vec;

use super::{End, Ends, Rewards};

/// Where the automata of the parts end, and how far each of their states is from acceptance.
///
/// ```
/// use tltl::reward::{End, Ends, JointArrival, JointEnds, Mode, Rewards};
///
/// // `F a && F b`, part by part: each accepts in state 1.
/// let once = Ends::new(vec![None, Some(End::Accepted)], vec![Some(1), Some(0)]);
/// let ends = JointEnds::new(vec![once.clone(), once]);
/// assert_eq!((ends.end(&[1, 0]), ends.end(&[1, 1])), (None, Some(End::Accepted)));
/// let pays = |mode, q: [u32; 2], to: [u32; 2]| {
///     let rewards = Rewards::of(mode).with_gamma(0.5).unwrap();
///     rewards.pay_joint(&ends, &JointArrival::at(&q, &to))
/// };
/// assert_eq!(pays(Mode::Progress, [0, 0], [0, 1]), 1.0);
/// assert_eq!(pays(Mode::Acceptance, [0, 1], [1, 1]), 1.0);
/// // Half of the task is done: the potential goes from 1/2 to 3/4.
/// assert_eq!(pays(Mode::Shaped, [0, 0], [0, 1]), 0.5 * 0.75 - 0.5);
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct JointEnds(Vec<Ends>);

impl JointEnds {
    /// Of these parts.
    #[must_use]
    #[inline]
    pub const fn new(parts: Vec<Ends>) -> Self {
        Self(parts)
    }

    /// How the task has ended where the parts are in `q`, if it has.
    ///
    /// # Panics
    /// If one of `q` is not a state of its part.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn end(&self, q: &[u32]) -> Option<End> {
        let ends = || self.0.iter().zip(q).map(|(part, &q)| part.end(q));
        if ends().any(|end| end == Some(End::Lost)) {
            return Some(End::Lost);
        }
        ends().all(|end| end == Some(End::Accepted)).then_some(End::Accepted)
    }

    /// The fewest moves from `q` to acceptance, if all parts could move at once: the largest of the
    /// parts' distances. `None` if a part has no way.
    ///
    /// # Panics
    /// If one of `q` is not a state of its part.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn distance(&self, q: &[u32]) -> Option<u32> {
        let mut parts = self.0.iter().zip(q);
        parts.try_fold(0, |most, (part, &q)| Some(part.distance[q as usize]?.max(most)))
    }

    #[track_caller]
    #[inline]
    fn potential(&self, q: &[u32]) -> f64 {
        if self.end(q).is_some() {
            return 0.0;
        }
        let of = |(part, &q): (&Ends, &u32)| match part.end(q) {
            Some(End::Accepted) => 1.0,
            _ => part.potential(q),
        };
        self.0.iter().zip(q).map(of).sum::<f64>() / self.0.len() as f64
    }
}

/// One move of all parts, as [`Arrival`](super::Arrival) is one of a single automaton.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointArrival<'a> {
    /// The parts' states before.
    pub q: &'a [u32],
    /// The parts' states after.
    pub to: &'a [u32],
    /// By how much a part moves on and none is lost, where the mode
    /// [needs](Rewards::needs_robustness) it.
    pub robustness: f64,
    /// What the environment itself pays for the step.
    pub reward: f64,
    /// Whether the environment's episode terminates at s'.
    pub terminated: bool,
}

impl<'a> JointArrival<'a> {
    /// A move with nothing beside it.
    #[must_use]
    #[inline]
    pub const fn at(q: &'a [u32], to: &'a [u32]) -> Self {
        Self { q, to, robustness: 0.0, reward: 0.0, terminated: false }
    }
}

impl Rewards {
    /// The reward of one step of a task whose parts run side by side, the environment's own part
    /// included; see [`JointEnds`].
    ///
    /// # Panics
    /// If there is not a state of each part before and after.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn pay_joint(&self, ends: &JointEnds, arrival: &JointArrival<'_>) -> f64 {
        let JointArrival { q, to, robustness, reward, terminated } = *arrival;
        assert_eq!([q.len(), to.len()], [ends.0.len(); 2], "a state of each part");
        let entered = if ends.end(q).is_none() { ends.end(to) } else { None };
        let left = || if terminated { 0.0 } else { ends.potential(to) };
        let paid = self.pay_step(q != to, entered, robustness, || (ends.potential(q), left()));
        paid + self.environment * reward
    }
}
