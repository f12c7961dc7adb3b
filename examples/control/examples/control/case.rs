//! A task in a world: learned, tried, and beside a controller that is written by hand.

use std::fmt;
use std::str::FromStr;

use tltl::deep::actor::{Learner, Settings};
use tltl::deep::{AsGiven, Device, Skill};
use tltl::env::ContinuousEnv;
use tltl::learn::{Schedule, Updates};
use tltl::network::Features;
use tltl::prelude::Rewards;
use tltl::reward::Mode;
use tltl::robustness::Predicates;
use tltl::{Acceptor as _, OutOfRange, Task};
use tltl_control::judge::{HORIZON, Trialled, trials};
use tltl_control::picture::{Loose, Plane};

use crate::Failure;

/// Environment steps of a training.
pub(crate) const STEPS: u64 = 40_000;

/// Environment steps between two looks at an actor that learns.
pub(crate) const BETWEEN: u64 = 5_000;

/// Trials of each.
pub(crate) const FEW: u64 = 50;

/// Trials of a policy, from starts that no learner has seen.
pub(crate) const TRIALS: u64 = 200;

/// Live automaton states beyond which a step teaches its own alone. A deadline of sixty steps has sixty, and each that
/// learns from a step takes as much time as a task with one; with the six of `settle`, updates of all learned nothing
/// (one seed).
const MANY: usize = 4;

/// A task in a world.
pub(crate) struct Case<E: ContinuousEnv, P, F> {
    pub(crate) world: E,
    pub(crate) task: Task<P>,
    pub(crate) look: F,
    /// The seconds of a step.
    pub(crate) step: f64,
    /// The places that it asks for, in order.
    pub(crate) goals: &'static [(f64, f64)],
    /// The controller written by hand: the state and the goal of the moment.
    pub(crate) by_hand: fn(&E::State, (f64, f64)) -> [f32; 2],
    pub(crate) plane: Plane<'static>,
    /// Where in the plane a state is drawn.
    pub(crate) at: fn(&E::State) -> (f64, f64),
    /// What else moves in it.
    pub(crate) loose: Option<Loose<E::State>>,
}

/// A learner of a case.
pub(crate) type Actor<'a, S, P, F> = Learner<S, &'a Task<P>, F, AsGiven>;

/// A method, by which actors learn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Method {
    Sac,
    Td3,
    Ddpg,
}

impl Method {
    const ALL: [(&'static str, Self); 3] =
        [("sac", Self::Sac), ("td3", Self::Td3), ("ddpg", Self::Ddpg)];

    /// How all actors learn by it.
    pub(crate) fn settings(self) -> Result<Settings, OutOfRange> {
        let own = match self {
            Self::Sac => Settings::sac(),
            Self::Td3 => Settings::td3(),
            Self::Ddpg => Settings::ddpg(),
        };
        own.with_rewards(Rewards::of(Mode::Shaped).with_gamma(0.98)?)
            .with_hidden([64, 64])?
            .with_horizon(HORIZON)?
            .with_steps(3)?
            .with_robustness(1.0)?
            .with_noise(Schedule::constant(0.3)?)?
            .with_noise_correlation(0.8)?
            .with_warmup(2_000)
    }
}

impl FromStr for Method {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        let named = Self::ALL.into_iter().find(|(own, _)| *own == name);
        let names = Self::ALL.map(|(own, _)| own).join(", ");
        let unknown = || format!("there is no method `{name}`; there are {names}");
        named.map(|(_, method)| method).ok_or_else(unknown)
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let own = Self::ALL.into_iter().find(|(_, method)| method == self);
        f.write_str(own.map_or("", |(name, _)| name))
    }
}

impl<E, P, F> Case<E, P, F>
where
    E: ContinuousEnv<State: Clone> + Clone,
    P: Predicates<E::State> + Sync,
    F: Features<E::State> + Copy + Sync,
{
    /// Where one has to go at `q`: the live states are numbered in the order of the goals.
    fn goal(&self, q: u32) -> (f64, f64) {
        let before = (0..q).filter(|&q| !self.task.is_terminal(q)).count();
        self.goals[before.min(self.goals.len() - 1)]
    }

    /// What is there.
    fn towards(&self, q: u32) -> &'static str {
        let goal = self.goal(q);
        let regions = self.plane.regions.iter().map(|region| (region.middle, region.name));
        let blocks = self.plane.blocks.iter().map(|block| (block.middle, block.name));
        regions.chain(blocks).find(|(middle, _)| *middle == goal).map_or("", |(_, name)| name)
    }

    /// What the live automaton states mean.
    pub(crate) fn meanings(&self) -> Vec<(u32, String)> {
        let live = (0..self.task.states()).filter(|&q| !self.task.is_terminal(q));
        live.map(|q| (q, format!("towards {}", self.towards(q)))).collect()
    }

    /// A learner that has learned nothing.
    pub(crate) fn learner(
        &self,
        method: Method,
        seed: u64,
    ) -> Result<Actor<'_, E::State, P, F>, Failure> {
        let skill = Skill::new(&self.task, self.look);
        let live = (0..self.task.states()).filter(|&q| !self.task.is_terminal(q)).count();
        let updates = if live > MANY { Updates::Current } else { Updates::Counterfactual };
        let settings = method.settings()?.with_updates(updates);
        Ok(Learner::new(skill, &self.world, settings, &Device::flex(), seed))
    }

    /// The action of the controller written by hand.
    pub(crate) fn hand_at(&self, q: u32, s: &E::State) -> Vec<f32> {
        (self.by_hand)(s, self.goal(q)).to_vec()
    }

    /// Trials of the controller written by hand.
    pub(crate) fn hand(&self) -> Result<Trialled<E::State>, Failure> {
        let act = |q, s: &E::State| Ok(self.hand_at(q, s));
        trials(&mut self.world.clone(), &self.task, TRIALS, act)
    }

    /// Trials of a learner.
    pub(crate) fn tried(
        &self,
        learner: &mut Actor<'_, E::State, P, F>,
        count: u64,
    ) -> Result<Trialled<E::State>, Failure> {
        let act = |q, s: &E::State| Ok::<_, Failure>(learner.act(q, s)?);
        trials(&mut self.world.clone(), &self.task, count, act)
    }
}
