//! What a network sees of a kitchen: what the agent has observed, told relative to the goal.
//!
//! Nothing hidden goes in. What goes in beside the observation are the public rules of the layout:
//! what may hold what, which receptacles have doors, and where one must look to see them.

use std::sync::Arc;

use tltl::deep::Relabel;
use tltl::network::Features;
use tltl::rand::Rng;

use crate::known::Known;
use crate::layout::{Goal, HORIZONS, Layout, NONE};

/// The features of a [`Known`] under its own goal, or under a fixed one.
///
/// Of the state: what is in hand, the level of the view, what is focused, and how the goal stands.
/// Of each id, since the actions `navigate(id)` point at ids: what is known of it, and what it is to
/// the goal.
#[derive(Clone, Debug)]
pub struct View {
    layout: Arc<Layout>,
    goal: Option<Goal>,
}

/// The features of one id.
const CHANNELS: usize = 20;

/// The features of the state that are no one-hot codes.
const FACTS: usize = 26;

impl View {
    /// The features under the goal that the state has.
    #[must_use]
    pub const fn new(layout: Arc<Layout>) -> Self {
        Self { layout, goal: None }
    }

    /// The features under `goal`, whatever goal the state has.
    #[must_use]
    pub const fn of(layout: Arc<Layout>, goal: Goal) -> Self {
        Self { layout, goal: Some(goal) }
    }

    /// Steps of the view, down positive, from the level now to the level at which `r` is seen.
    fn levels_to(&self, k: &Known, r: u8) -> f32 {
        self.layout.level(r) as f32 - k.level() as f32
    }

    /// Whether `r` is known to be full.
    fn is_full(&self, k: &Known, r: u8) -> bool {
        k.inspected[r as usize] && k.fullness[r as usize] >= self.layout.capacity(r)
    }

    /// Whether the agent can go to object `o`.
    fn reachable(k: &Known, o: u8) -> bool {
        let place = k.seen_in[o as usize];
        place != NONE && k.hand != o && k.is_open[place as usize]
    }

    /// What `r` is to the goal: features 0 to 11 of an id.
    fn receptacle(&self, k: &Known, goal: Goal, r: u8) -> [f32; 12] {
        let i = r as usize;
        let levels = self.levels_to(k, r).abs() / 3.0;
        let candidate = self.is_candidate(k, goal, r);
        let takes = k.hand != NONE && self.layout.may_hold(r, k.hand) && !self.is_full(k, r);
        let (closed, candidate) = (number(!k.is_open[i]), number(candidate));
        [
            1.0,
            number(k.focused_receptacle(&self.layout) == r),
            number(r == goal.receptacle),
            number(k.seen_in[goal.object as usize] == r && k.hand != goal.object),
            candidate,
            candidate * levels,
            candidate * closed,
            closed,
            levels,
            number(self.is_full(k, r)),
            number(takes),
            number(takes && k.is_open[i]) * (1.0 - levels),
        ]
    }

    /// What `o` is to the goal: features 12 to 19 of an id.
    fn object(k: &Known, goal: Goal, o: u8) -> [f32; 8] {
        let reachable = Self::reachable(k, o);
        let inside = k.seen_in[o as usize] == goal.receptacle && k.hand != o;
        let wanted = o == goal.object;
        [
            1.0,
            number(wanted),
            number(reachable),
            number(wanted && reachable),
            number(k.hand == o),
            number(k.focus == o),
            number(k.in_view[o as usize]),
            number(inside && !wanted && reachable),
        ]
    }

    /// The share of receptacles that must still be looked into, with their doors as `closed` says.
    fn left(&self, k: &Known, goal: Goal, closed: bool) -> f32 {
        let ids = self.layout.receptacle_ids();
        let left =
            ids.filter(|&r| self.is_candidate(k, goal, r) && k.is_open[r as usize] != closed);
        left.count() as f32 / self.layout.receptacles() as f32
    }

    /// Whether what is wanted may be in `r`, for all that is known.
    fn is_candidate(&self, k: &Known, goal: Goal, r: u8) -> bool {
        let o = goal.object;
        let unseen = k.seen_in[o as usize] == NONE && k.hand != o;
        unseen && !k.inspected[r as usize] && self.layout.may_hold(r, o)
    }

    /// How the goal stands.
    fn facts(&self, k: &Known, goal: Goal) -> [f32; FACTS] {
        let layout = &self.layout;
        let focused = k.focused_receptacle(layout);
        let at = |f: &dyn Fn(u8) -> bool| number(focused != NONE && f(focused));
        let (o, r) = (goal.object, goal.receptacle);
        let to = if focused == NONE { 0.0 } else { self.levels_to(k, focused) };
        let unseen = k.seen_in[o as usize] == NONE && k.hand != o;
        [
            number(k.hand == NONE),
            number(k.hand == o),
            number(k.hand != NONE && k.hand != o),
            number(k.focus == NONE),
            number(layout.is_object(k.focus)),
            number(k.focus == o),
            at(&|f| f == r),
            at(&|f| k.in_view[f as usize]),
            at(&|f| k.is_open[f as usize]),
            at(&|f| layout.has_door(f)),
            at(&|f| self.is_full(k, f)),
            at(&|f| k.hand != NONE && layout.may_hold(f, k.hand)),
            number(to > 0.0),
            number(to < 0.0),
            at(&|f| self.is_candidate(k, goal, f)),
            at(&|f| k.seen_in[o as usize] == f && k.hand != o),
            number(unseen),
            number(Self::reachable(k, o)),
            number(k.in_view[o as usize]),
            number(k.is_open[r as usize]),
            number(layout.has_door(r)),
            number(self.is_full(k, r)),
            number(k.inspected[r as usize]),
            self.levels_to(k, r).abs() / 3.0,
            self.left(k, goal, false),
            self.left(k, goal, true),
        ]
    }
}

impl Features<Known> for View {
    fn inputs(&self) -> usize {
        FACTS + HORIZONS.len()
    }

    fn entities(&self) -> usize {
        self.layout.ids()
    }

    fn channels(&self) -> usize {
        CHANNELS
    }

    fn write(&self, k: &Known, inputs: &mut [f32], entities: &mut [f32]) {
        let goal = self.goal.unwrap_or(k.goal());
        let (objects, ids) = (self.layout.objects(), self.layout.ids());
        let (facts, codes) = inputs.split_at_mut(FACTS);
        facts.copy_from_slice(&self.facts(k, goal));
        codes[k.level()] = 1.0;
        for id in 0..ids {
            let mut put = |channel: usize, value: f32| entities[channel * ids + id] = value;
            if id < objects {
                let features = Self::object(k, goal, id as u8);
                features.iter().enumerate().for_each(|(i, &f)| put(12 + i, f));
            } else {
                let features = self.receptacle(k, goal, id as u8);
                features.iter().enumerate().for_each(|(i, &f)| put(i, f));
            }
        }
    }
}

fn number(condition: bool) -> f32 {
    f32::from(u8::from(condition))
}

/// The goals that a step of the kitchen can be relabelled with: half of the time for an object that the
/// agent has found, half of the time for the receptacle that it is at.
#[derive(Clone, Debug)]
pub struct FeasibleGoals {
    goals: Vec<Goal>,
}

impl FeasibleGoals {
    /// The goals of a kitchen, without those for the object `except`.
    #[must_use]
    pub fn new(layout: &Layout, except: Option<u8>) -> Self {
        let goals = layout.feasible_goals().filter(|goal| Some(goal.object) != except).collect();
        Self { goals }
    }
}

impl Relabel<Known> for FeasibleGoals {
    type Goal = Goal;

    fn choose<R: Rng + ?Sized>(&self, k: &Known, rng: &mut R) -> Option<Goal> {
        let mut below = |n: usize| ((u64::from(rng.next_u32()) * n as u64) >> 32) as usize;
        let found = |goal: &&Goal| k.hand == goal.object || k.seen_in[goal.object as usize] != NONE;
        let here = |goal: &&Goal| goal.receptacle == k.focus;
        let (only_found, only_here) = (below(2) == 0, below(2) == 0);
        let pool = |goal: &&Goal| (!only_found || found(goal)) && (!only_here || here(goal));
        let count = self.goals.iter().filter(pool).count();
        if count == 0 {
            return Some(self.goals[below(self.goals.len())]);
        }
        self.goals.iter().filter(pool).nth(below(count)).copied()
    }

    fn give(&self, state: &Known, goal: &Goal) -> Known {
        state.with_goal(goal.object, goal.receptacle)
    }
}

/// The actions to explore with: half of the time one without an argument, half of the time a
/// `navigate`. Drawn uniformly, 56 of 62 actions would only walk.
#[must_use]
pub fn exploration(layout: &Layout) -> Vec<usize> {
    let simple = (0..layout.ids()).map(|i| i % 6);
    simple.chain((0..layout.ids()).map(|id| 6 + id)).collect()
}
