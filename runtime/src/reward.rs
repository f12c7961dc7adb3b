//! Rewards of the FSA-augmented MDP: what is optimised.
//!
//! [`Rewards`] say what a step is worth and how the future is discounted. What a step pays is a pure
//! function of one move of the automaton, [`Rewards::pay`]: learners, solvers and other languages
//! all ask it, so no reward is computed anywhere else. γ is one of the rewards, for it decides what
//! is optimal as much as the payments do, and [`Mode::Shaped`] needs it.
//!
//! What is optimal for a reward need not be what the task wants: the largest P(satisfied), and then the
//! fewest steps. [`Rewards::acceptance`], the default, is that. [`Mode::Progress`], the paper's reward,
//! pays for every edge, and so prefers longer ways, or a risk; where the automaton has a way back
//! (`F (a && X a && X X a)`: leave, come again, be paid again) its optimal policy need never satisfy
//! the task. On `!c U a` of the paper's grid the largest possible P(satisfied) is 98.49 %; the
//! `Progress`-optimal policy has 98.13 %, the `Literal`-optimal one 50.0 %.
//! [Certificates](crate::solve::Certificate) show the difference.

mod joint;
#[cfg(feature = "serde")]
mod saved;

use alloc::vec::Vec;

use crate::monitor::Acceptor;
use crate::range::checked;

pub use joint::{JointArrival, JointEnds};
#[cfg(feature = "serde")]
pub(crate) use saved::Saved;

/// What a move of the automaton pays.
///
/// ```
/// use tltl::reward::{Arrival, End, Ends, Mode, Rewards};
///
/// // `!c U a`: from state 0, the move to 1 accepts and the move to 2 is lost.
/// let of = vec![None, Some(End::Accepted), Some(End::Lost)];
/// let ends = Ends::new(of, vec![Some(1), Some(0), None]);
/// let pays = |mode, to| Rewards::of(mode).pay(&ends, &Arrival::at(0, to));
/// assert_eq!((pays(Mode::Progress, 1), pays(Mode::Progress, 2)), (1.0, 0.0));
/// assert_eq!((pays(Mode::Literal, 1), pays(Mode::Literal, 2)), (1.0, 1.0)); // paid for losing
/// assert_eq!((pays(Mode::Shaped, 1), pays(Mode::Shaped, 2)), (0.5, -0.5));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Mode {
    /// 1 if the move leaves q, neither by a self-loop nor into the trap (the intent of the paper's
    /// Eq. 3A3).
    Progress,
    /// 1 if the move leaves q, the trap included (Eq. 3A3 to the letter). Unsafe: it pays for
    /// losing. Kept to reproduce the paper.
    Literal,
    /// 1 on entering the accepting state.
    #[default]
    Acceptance,
    /// ρ(s', D_φ^q), clamped to ± [`Rewards::bound`].
    Robustness,
    /// `Acceptance` plus γΦ(q') − Φ(q). The potential Φ falls evenly from nearly 1 beside the
    /// accepting state to nearly 0 at the state farthest from it; it is 0 where the episode
    /// terminates, for the task or for the environment. So the optimal policies are those of
    /// `Acceptance` (Ng et al. 1999).
    Shaped,
}

/// What is optimised: the [`Mode`] of payment, the discount factor, and penalties.
///
/// All numbers are finite and in their ranges: a value of this type is valid.
///
/// ```
/// use tltl::reward::Rewards;
///
/// let rewards = Rewards::acceptance().with_gamma(0.99)?.with_trap_penalty(1.0)?;
/// assert_eq!((rewards.gamma(), rewards.step_penalty()), (0.99, 0.0));
/// assert!(rewards.with_gamma(f64::NAN).is_err());
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rewards {
    mode: Mode,
    gamma: f64,
    bound: f64,
    trap_penalty: f64,
    step_penalty: f64,
    environment: f64,
}

impl Default for Rewards {
    /// [`Rewards::acceptance`]: what the task wants.
    #[inline]
    fn default() -> Self {
        Self::acceptance()
    }
}

impl Rewards {
    /// The same with a γ that is known to be in range.
    #[cfg(feature = "deep")]
    #[inline]
    pub(crate) const fn with_known_gamma(self, gamma: f64) -> Self {
        Self { gamma, ..self }
    }

    /// `mode` alone: γ 0.95, bound 1, no penalties, nothing from the environment. (0.95 is the
    /// paper's γ.)
    #[must_use]
    #[inline]
    pub const fn of(mode: Mode) -> Self {
        let (trap_penalty, step_penalty, environment) = (0.0, 0.0, 0.0);
        Self { mode, gamma: 0.95, bound: 1.0, trap_penalty, step_penalty, environment }
    }

    /// [`Mode::Progress`] alone, the paper's reward, with its γ.
    #[must_use]
    #[inline]
    pub const fn progress() -> Self {
        Self::of(Mode::Progress)
    }

    /// [`Mode::Acceptance`] alone, with γ 0.99999: what the task wants.
    ///
    /// Each step of delay costs 1 − γ of the reward, so γ must be near 1 for P(satisfied) to come
    /// first: at 0.9999 a dozen steps outweigh 0.1 % of it. In the study of rewards
    /// (`docs/studies/rewards.md`) the optimum gives away at most 0.011 % of P(satisfied).
    ///
    /// ```
    /// use tltl::reward::{Mode, Rewards};
    ///
    /// let rewards = Rewards::acceptance();
    /// assert_eq!((rewards.mode(), rewards.gamma()), (Mode::Acceptance, 0.99999));
    /// assert_eq!(Rewards::default(), rewards);
    /// ```
    #[must_use]
    #[inline]
    pub const fn acceptance() -> Self {
        Self { gamma: 0.99999, ..Self::of(Mode::Acceptance) }
    }

    /// Whether the task alone is paid for, at whatever γ: then what is wanted is known, and γ need
    /// not stand for it.
    #[inline]
    pub(crate) const fn pays_acceptance_alone(&self) -> bool {
        let alone = self.trap_penalty == 0.0 && self.step_penalty == 0.0 && self.environment == 0.0;
        alone && matches!(self.mode, Mode::Acceptance | Mode::Shaped)
    }

    /// What a move of the automaton pays.
    #[must_use]
    #[inline]
    pub const fn mode(&self) -> Mode {
        self.mode
    }

    /// The reward of one step of the augmented MDP, the environment's own part included.
    ///
    /// ```
    /// use tltl::reward::{Arrival, End, Ends, Rewards};
    ///
    /// // `F a`: state 1 accepts, one move from state 0.
    /// let ends = Ends::new(vec![None, Some(End::Accepted)], vec![Some(1), Some(0)]);
    /// let arrival = Arrival { reward: -1.0, ..Arrival::at(0, 1) };
    /// let rewards = Rewards::acceptance().with_environment(0.5)?;
    /// assert_eq!(rewards.pay(&ends, &arrival), 0.5);
    /// # Ok::<(), tltl::OutOfRange>(())
    /// ```
    ///
    /// # Panics
    /// If q or q' is not a state of the automaton.
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn pay(&self, ends: &Ends, arrival: &Arrival) -> f64 {
        self.pay_for_move(ends, arrival) + self.environment * arrival.reward
    }

    /// The same for many steps at once: `out[i]` is the reward of step i.
    ///
    /// ```
    /// use tltl::reward::{Arrivals, End, Ends, Rewards};
    ///
    /// let ends = Ends::new(vec![None, Some(End::Accepted)], vec![Some(1), Some(0)]);
    /// let mut out = [0.0; 3];
    /// let arrivals = Arrivals { q: &[0, 0, 1], to: &[0, 1, 1], ..Arrivals::default() };
    /// Rewards::acceptance().pay_all(&ends, &arrivals, &mut out);
    /// assert_eq!(out, [0.0, 1.0, 0.0]);
    /// ```
    ///
    /// # Panics
    /// If the columns are not of the length of `out` (those that may be empty, if not empty), or as
    /// [`Self::pay`].
    #[track_caller]
    #[inline]
    pub fn pay_all(&self, ends: &Ends, arrivals: &Arrivals<'_>, out: &mut [f64]) {
        arrivals.check(out.len());
        let states = ends.of.len();
        let pairs = states * states;
        if self.needs_robustness() || 2 * pairs > out.len() {
            for (i, paid) in out.iter_mut().enumerate() {
                *paid = self.pay(ends, &arrivals.get(i));
            }
            return;
        }
        // Of many moves each kind is paid once, and what remains is to look it up.
        let kinds = [false, true].into_iter().flat_map(|terminated| {
            (0..pairs).map(move |pair| {
                let (q, to) = ((pair / states) as u32, (pair % states) as u32);
                Arrival { terminated, ..Arrival::at(q, to) }
            })
        });
        let paid: Vec<f64> = kinds.map(|kind| self.pay_for_move(ends, &kind)).collect();
        for (i, out) in out.iter_mut().enumerate() {
            let Arrival { q, to, reward, terminated, .. } = arrivals.get(i);
            assert!(q.max(to) < ends.states(), "there is no state {}", q.max(to));
            let kind = usize::from(terminated) * pairs + q as usize * states + to as usize;
            *out = paid[kind] + self.environment * reward;
        }
    }

    /// What the task pays for the move, the environment's own reward left aside.
    #[track_caller]
    #[inline]
    pub(crate) fn pay_for_move(&self, ends: &Ends, arrival: &Arrival) -> f64 {
        let Arrival { q, to, robustness, terminated, .. } = *arrival;
        let entered = if ends.end(q).is_none() { ends.end(to) } else { None };
        let left = || if terminated { 0.0 } else { ends.potential(to) };
        self.pay_step(q != to, entered, robustness, || (ends.potential(q), left()))
    }

    /// The same, however states are called: for a step that leaves its state or not, the end that it
    /// enters, and the potentials before and after, which only one mode asks for. Penalties come last, so
    /// that they are the same under every mode.
    #[inline]
    fn pay_step(
        &self,
        leaves: bool,
        entered: Option<End>,
        robustness: f64,
        potentials: impl FnOnce() -> (f64, f64),
    ) -> f64 {
        let lost = entered == Some(End::Lost);
        let accepted = f64::from(u8::from(entered == Some(End::Accepted)));
        let paid = match self.mode {
            Mode::Progress => f64::from(u8::from(leaves && !lost)),
            Mode::Literal => f64::from(u8::from(leaves)),
            Mode::Acceptance => accepted,
            Mode::Robustness => robustness.clamp(-self.bound, self.bound),
            Mode::Shaped => {
                let (before, after) = potentials();
                accepted + self.gamma * after - before
            }
        };
        paid - self.step_penalty - if lost { self.trap_penalty } else { 0.0 }
    }

    /// Whether the reward needs ρ(s', D_φ^q): only [`Mode::Robustness`] does.
    ///
    /// ```
    /// use tltl::reward::{Mode, Rewards};
    ///
    /// assert!(Rewards::of(Mode::Robustness).needs_robustness());
    /// assert!(!Rewards::progress().needs_robustness() && !Rewards::acceptance().needs_robustness());
    /// ```
    #[must_use]
    #[inline]
    pub const fn needs_robustness(&self) -> bool {
        matches!(self.mode, Mode::Robustness)
    }
}

checked! { Rewards {
    /// The discount factor γ.
    gamma, with_gamma: f64, "in [0, 1)", |gamma| (0.0..1.0).contains(&gamma);
    /// The largest reward or punishment of one step by [`Mode::Robustness`].
    bound, with_bound: f64, "a positive number", |bound| bound > 0.0 && bound.is_finite();
    /// What is subtracted on entering the trap.
    trap_penalty, with_trap_penalty: f64, "a number from 0 on", |p| p >= 0.0 && p.is_finite();
    /// What is subtracted at every step.
    step_penalty, with_step_penalty: f64, "a number from 0 on", |p| p >= 0.0 && p.is_finite();
    /// The weight of the environment's own reward (a cost of failed actions, say). Solvers leave
    /// that reward out, for models have none.
    environment, with_environment: f64, "a finite number", |weight| weight.is_finite();
}}

/// How an episode ended for the task. Both ends are for ever: the automaton stays where it is.
///
/// There is no third end: an episode that is cut or that the world ends leaves the task where it is,
/// neither satisfied nor lost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// The task is satisfied.
    Accepted,
    /// The task can never be satisfied any more.
    Lost,
}

/// Where the task ends, and how far each automaton state is from acceptance: all that rewards need
/// to know of a task.
///
/// ```
/// use tltl::reward::{End, Ends};
/// use tltl::tltl;
///
/// let ends = Ends::of(&tltl! { |s: &(bool, bool)| !s.0 U s.1 });
/// assert_eq!((ends.accepting(), ends.trap()), (Some(1), Some(2)));
/// assert_eq!(ends.end(2), Some(End::Lost));
/// assert!(ends.live().eq([0]));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ends {
    of: Vec<Option<End>>,
    distance: Vec<Option<u32>>,
    farthest: u32,
}

impl Ends {
    /// An automaton with such an end, or none, at each state, and so many moves from each state to
    /// acceptance at least, if there is a way.
    ///
    /// # Panics
    /// If there is not one of both for each state.
    #[must_use]
    #[track_caller]
    #[inline]
    pub fn new(of: Vec<Option<End>>, distance: Vec<Option<u32>>) -> Self {
        assert_eq!(of.len(), distance.len(), "an end and a distance for each automaton state");
        let farthest = distance.iter().copied().flatten().max().unwrap_or(0);
        Self { of, distance, farthest }
    }

    /// Those of a task. All its states are asked once, so make them once for many moves.
    #[must_use]
    #[inline]
    pub fn of(task: &(impl Acceptor + ?Sized)) -> Self {
        let end = |q| match (task.is_accepting(q), task.is_trap(q)) {
            (true, _) => Some(End::Accepted),
            (_, true) => Some(End::Lost),
            _ => None,
        };
        let states = 0..task.states();
        let distance = states.clone().map(|q| task.distance(q)).collect();
        Self::new(states.map(end).collect(), distance)
    }

    /// The number of automaton states.
    #[must_use]
    #[inline]
    pub fn states(&self) -> u32 {
        self.of.len() as u32
    }

    /// The accepting state; the first, if there are several.
    #[must_use]
    #[inline]
    pub fn accepting(&self) -> Option<u32> {
        self.first(End::Accepted)
    }

    /// The trap; the first, if there are several.
    #[must_use]
    #[inline]
    pub fn trap(&self) -> Option<u32> {
        self.first(End::Lost)
    }

    #[inline]
    fn first(&self, end: End) -> Option<u32> {
        (0..self.states()).find(|&q| self.end(q) == Some(end))
    }

    /// How the task has ended at `q`, if it has.
    ///
    /// # Panics
    /// If `q` is not a state of the automaton.
    #[inline]
    #[must_use]
    #[track_caller]
    pub fn end(&self, q: u32) -> Option<End> {
        self.of[q as usize]
    }

    /// The automaton states in which the task goes on.
    #[inline]
    pub fn live(&self) -> impl Iterator<Item = u32> + use<> {
        let of = self.of.clone();
        (0..of.len() as u32).filter(move |&q| of[q as usize].is_none())
    }

    /// The potential Φ of [`Mode::Shaped`]. Divided by one more than the largest distance, so that
    /// even the farthest live state has some, and the move into a state without a way loses it.
    #[track_caller]
    #[inline]
    fn potential(&self, q: u32) -> f64 {
        match (self.end(q), self.distance[q as usize]) {
            (None, Some(distance)) => 1.0 - f64::from(distance) / f64::from(self.farthest + 1),
            _ => 0.0,
        }
    }
}

/// One move of the automaton, as rewards see it: q has read s' and moved to q'.
///
/// ```
/// use tltl::reward::{Arrival, Ends, Mode, Rewards};
/// use tltl::tltl;
///
/// // Shaped rewards pay a potential, which is 0 where the environment itself ends the episode.
/// let ends = Ends::of(&tltl! { |x: &i32| ({ *x } == 1) T ({ *x } == 2) });
/// let rewards = Rewards::of(Mode::Shaped).with_gamma(0.9)?;
/// let arrival = Arrival::at(0, 1);
/// let pays = [arrival, Arrival { terminated: true, ..arrival }].map(|a| rewards.pay(&ends, &a));
/// assert!(pays[0] > 0.0 && pays[1] < 0.0, "{pays:?}");
/// # Ok::<(), tltl::OutOfRange>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// The automaton state before.
    pub q: u32,
    /// The automaton state after, q' = δ(q, s').
    pub to: u32,
    /// ρ(s', D_φ^q), where the mode [needs](Rewards::needs_robustness) it.
    pub robustness: f64,
    /// What the environment itself pays for the step.
    pub reward: f64,
    /// Whether the environment's episode terminates at s'.
    pub terminated: bool,
}

impl Arrival {
    /// A move from `q` to `to` with nothing beside it: no robustness, no reward of the environment,
    /// and the episode goes on.
    #[must_use]
    #[inline]
    pub const fn at(q: u32, to: u32) -> Self {
        Self { q, to, robustness: 0.0, reward: 0.0, terminated: false }
    }
}

/// Many moves, column by column. All columns have the same length; `robustness`, `reward` and
/// `terminated` may also be empty, which stands for zeros.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arrivals<'a> {
    /// The automaton states before.
    pub q: &'a [u32],
    /// The automaton states after.
    pub to: &'a [u32],
    /// ρ(s', D_φ^q).
    pub robustness: &'a [f64],
    /// What the environment itself pays.
    pub reward: &'a [f64],
    /// Whether the environment's episode terminates.
    pub terminated: &'a [bool],
}

impl Arrivals<'_> {
    #[track_caller]
    #[inline]
    fn check(&self, length: usize) {
        assert_eq!(self.q.len(), length, "a state before each move");
        assert_eq!(self.to.len(), length, "a state after each move");
        let fits = |n: usize| n == 0 || n == length;
        assert!(fits(self.robustness.len()), "a robustness for each move, or none");
        assert!(fits(self.reward.len()), "a reward of the environment for each move, or none");
        assert!(fits(self.terminated.len()), "an end of the environment for each move, or none");
    }

    #[inline]
    fn get(&self, i: usize) -> Arrival {
        Arrival {
            q: self.q[i],
            to: self.to[i],
            robustness: self.robustness.get(i).copied().unwrap_or_default(),
            reward: self.reward.get(i).copied().unwrap_or_default(),
            terminated: self.terminated.get(i).copied().unwrap_or_default(),
        }
    }
}
