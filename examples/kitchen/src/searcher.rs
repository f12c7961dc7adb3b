//! A scripted policy that knows the rules and sees only what the agent sees.
//!
//! It says what a fair policy can hope for: the [planner](crate::planner) knows where everything
//! is, a learner does not. It fetches what it knows the place of, the nearest first; else it looks
//! for what is wanted, where the chance to find it is largest for the steps that it takes. It knows
//! how starts are drawn, but nothing of the one that it is in beyond [`Known`], and has no memory
//! besides. What it does satisfies φ.3, and so φ.1 and φ.2.
//!
//! It is greedy, so not the best policy: what it sees of one object tells it nothing of the others,
//! and it does not weigh what a way will show besides.

use std::sync::Arc;

use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};

use crate::action::Action;
use crate::known::Known;
use crate::layout::{Goal, HORIZONS, Layout, MAX_IDS, NONE};
use crate::world::arrange;

/// So many arrangements give the chances below.
const SAMPLES: u32 = 20_000;

/// How many steps it costs to find a target full with the object in hand, rather than before:
/// to put it down and to fetch it again. Between 3.5 and 7 it makes no difference of 0.2 steps.
const LATE: f64 = 5.0;

/// How many steps it costs to come to a full receptacle with something to put down.
const MISSED: f64 = 2.0;

/// The policy.
#[derive(Clone, Debug)]
pub struct Searcher {
    layout: Arc<Layout>,
    /// A goal besides the one that the agent is told.
    beside: Option<Goal>,
    /// The chance that an object starts in a receptacle.
    inside: Vec<[f64; MAX_IDS]>,
    /// The chance that a receptacle starts full.
    full: [f64; MAX_IDS],
}

impl Searcher {
    /// A searcher for the goal that the agent is told, and one `beside` it.
    #[must_use]
    pub fn new(layout: Arc<Layout>, beside: Option<Goal>) -> Self {
        let mut inside = vec![[0.0; MAX_IDS]; layout.objects()];
        let mut full = [0.0; MAX_IDS];
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(0);
        let share = 1.0 / f64::from(SAMPLES);
        for truth in (0..SAMPLES).filter_map(|_| arrange(&layout, &mut rng)) {
            let mut held = [0; MAX_IDS];
            for o in layout.object_ids() {
                let r = truth.place(o) as usize;
                inside[o as usize][r] += share;
                held[r] += 1;
                if held[r] == layout.capacity(r as u8) {
                    full[r] += share;
                }
            }
        }
        Self { layout, beside, inside, full }
    }

    /// What to do next; once all is done, nothing of consequence.
    ///
    /// # Panics
    /// If an object can be nowhere: not after a start that the rules allow.
    #[must_use]
    pub fn action(&self, known: &Known) -> Action {
        let now = Now { searcher: self, layout: &self.layout, known, pending: self.pending(known) };
        if known.hand == NONE { now.with_free_hand() } else { now.with_full_hand() }
    }

    /// The goals that are not reached yet.
    fn pending(&self, known: &Known) -> Vec<Goal> {
        let all = self.beside.into_iter().chain([known.goal()]);
        all.filter(|goal| !known.inside(goal.object, goal.receptacle)).collect()
    }
}

/// A moment of decision.
struct Now<'a> {
    searcher: &'a Searcher,
    layout: &'a Layout,
    known: &'a Known,
    pending: Vec<Goal>,
}

impl Now<'_> {
    fn with_full_hand(&self) -> Action {
        let goal = self.pending.iter().find(|goal| goal.object == self.known.hand);
        match goal {
            Some(goal) if !self.is_full(goal.receptacle) => self.put_into(goal.receptacle),
            _ => self.put_into(self.spot()),
        }
    }

    fn with_free_hand(&self) -> Action {
        let found = |goal: &&Goal| self.known.seen_in[goal.object as usize] != NONE;
        let cost = |goal: &&Goal| {
            let (from, to) = (self.place(goal.object), goal.receptacle);
            self.way(from) + self.looks(from, to)
        };
        let nearest = self.pending.iter().filter(found).min_by(|a, b| cost(a).total_cmp(&cost(b)));
        let Some(goal) = nearest else { return self.search() };
        if self.is_full(goal.receptacle) {
            return self.take(self.victim(goal.receptacle));
        }
        let next = self.place(goal.object);
        self.inspect_target(*goal, next).unwrap_or_else(|| self.take(goal.object))
    }

    /// Goes to where the wanted objects may be.
    fn search(&self) -> Action {
        let next = self.best_place().unwrap_or(self.known.focus);
        let mut targets = self.pending.iter().filter_map(|&goal| self.inspect_target(goal, next));
        let first = targets.next();
        first.or_else(|| self.approach(next)).unwrap_or(Action::Navigate(next))
    }

    /// The receptacle to look into next. All at one height share the looks up or down to it, so
    /// heights compete by the best chance per step of any number of receptacles there.
    fn best_place(&self) -> Option<u8> {
        let mut best = (0.0, None);
        for level in 0..HORIZONS.len() as u8 {
            let here = |&(r, chance): &(u8, f64)| chance > 0.0 && self.layout.level(r) == level;
            let places = self.layout.receptacle_ids().map(|r| (r, self.chance(r)));
            let mut places: Vec<(u8, f64)> = places.filter(here).collect();
            places
                .sort_by(|a, b| (b.1 / self.door_way(b.0)).total_cmp(&(a.1 / self.door_way(a.0))));
            let mut steps = f64::from(level.abs_diff(self.known.level() as u8));
            let mut chance = 0.0;
            for &(r, more) in &places {
                (steps, chance) = (steps + self.door_way(r), chance + more);
                if chance / steps.max(0.5) > best.0 {
                    best = (chance / steps.max(0.5), Some(places[0].0));
                }
            }
        }
        best.1
    }

    /// The chance to find a wanted object in `r`.
    fn chance(&self, r: u8) -> f64 {
        if self.known.inspected[r as usize] {
            return 0.0;
        }
        let missing =
            |goal: &&Goal| self.known.seen_in[goal.object as usize] == NONE && goal.receptacle != r;
        let of = |goal: &Goal| self.searcher.inside[goal.object as usize][r as usize];
        self.pending.iter().filter(missing).map(of).sum()
    }

    /// Looks whether the target of `goal` is full before the object is taken, if that pays on the
    /// way to `next`.
    fn inspect_target(&self, goal: Goal, next: u8) -> Option<Action> {
        let target = goal.receptacle;
        if self.known.inspected[target as usize] {
            return None;
        }
        let direct = self.levels(self.known.level() as u8, self.layout.level(next));
        let to = self.levels(self.known.level() as u8, self.layout.level(target));
        let detour = self.step_to(target) + to + self.looks(target, next) - direct;
        let pays = self.searcher.full[target as usize] * LATE > detour;
        if pays { self.approach(target) } else { None }
    }

    /// Where to put down what is in hand: near, with room, and on the way to what comes next.
    fn spot(&self) -> u8 {
        let hand = self.known.hand;
        let wanted = |r: u8| self.pending.iter().any(|goal| goal.receptacle == r);
        let next =
            self.pending.iter().find(|goal| goal.object == hand || self.is_full(goal.receptacle));
        let cost = |r: u8| {
            let inspected = self.known.inspected[r as usize];
            let missed = if inspected { 0.0 } else { self.searcher.full[r as usize] * MISSED };
            let onward = next.map_or(0.0, |goal| self.looks(r, goal.receptacle));
            let in_the_way = if wanted(r) { 100.0 } else { 0.0 };
            self.way(r) + missed + onward + in_the_way - self.chance(r)
        };
        let fits = |&r: &u8| self.layout.may_hold(r, hand) && !self.is_full(r);
        let spots = self.layout.receptacle_ids().filter(fits);
        spots.min_by(|&a, &b| cost(a).total_cmp(&cost(b))).expect("there is room for every object")
    }

    /// What to take out of the full receptacle `r`: something that is wanted elsewhere, or else
    /// nothing that has been brought there.
    fn victim(&self, r: u8) -> u8 {
        let there = self.layout.object_ids().filter(|&o| self.known.seen_in[o as usize] == r);
        let rank = |&o: &u8| {
            let pending = self.pending.iter().any(|goal| goal.object == o);
            let brought = self.searcher.beside.into_iter().chain([self.known.goal()]);
            let brought = brought.into_iter().any(|goal| goal == Goal { object: o, receptacle: r });
            (brought, !pending)
        };
        there.min_by_key(rank).expect("what is full holds something")
    }

    /// The next step of taking `o`, whose place is known.
    fn take(&self, o: u8) -> Action {
        if self.known.focus != o {
            return Action::Navigate(o);
        }
        self.approach(self.place(o)).unwrap_or(Action::Pick)
    }

    fn put_into(&self, r: u8) -> Action {
        self.approach(r).unwrap_or(Action::Put)
    }

    /// The next step towards seeing what is in `r`; `None` if it is in view.
    fn approach(&self, r: u8) -> Option<Action> {
        let (level, needed) = (self.known.level() as u8, self.layout.level(r));
        if self.step_to(r) > 0.0 {
            return Some(Action::Navigate(r));
        }
        match level.cmp(&needed) {
            std::cmp::Ordering::Less => Some(Action::LookUp),
            std::cmp::Ordering::Greater => Some(Action::LookDown),
            std::cmp::Ordering::Equal => (!self.known.is_open[r as usize]).then_some(Action::Open),
        }
    }

    /// The steps to see what is in `r`.
    fn way(&self, r: u8) -> f64 {
        self.door_way(r) + self.levels(self.known.level() as u8, self.layout.level(r))
    }

    /// The same without looking up or down.
    fn door_way(&self, r: u8) -> f64 {
        self.step_to(r) + f64::from(u8::from(!self.known.is_open[r as usize]))
    }

    /// 1 if the agent is elsewhere.
    fn step_to(&self, r: u8) -> f64 {
        f64::from(u8::from(self.known.focused_receptacle(self.layout) != r))
    }

    /// The looks up or down between two receptacles.
    fn looks(&self, from: u8, to: u8) -> f64 {
        self.levels(self.layout.level(from), self.layout.level(to))
    }

    fn levels(&self, from: u8, to: u8) -> f64 {
        f64::from(from.abs_diff(to))
    }

    fn place(&self, o: u8) -> u8 {
        self.known.seen_in[o as usize]
    }

    /// Whether `r` is known to be full.
    fn is_full(&self, r: u8) -> bool {
        self.known.inspected[r as usize]
            && self.known.fullness[r as usize] >= self.layout.capacity(r)
    }
}
