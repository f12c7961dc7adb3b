//! Exact shortest plans over the product of kitchen and automaton, by one who sees everything.
//!
//! The agent must still *find* what it is to use: `navigate(o)` succeeds only once `o` has been in
//! view. But the planner knows where to look, so its plans bound from below what any policy needs
//! from the same start.
//!
//! # What is left out, and why nothing is lost
//!
//! The search is A* with the automaton's distance to acceptance. The paper's 62 actions to a depth
//! of 20 are too many, so it runs in a *relaxed* kitchen. Let O be the objects and R the
//! receptacles that the specification mentions, through `see(o)`, `hold(o)`, `open(r)` and
//! `inside(o, r)` alone, none of them negated. A set E of receptacles, empty at first, is *exact*.
//! In the relaxed kitchen
//!
//! 1. receptacles outside E have unlimited room, and the objects in them that are not of O are
//!    gone; those in a receptacle of E stay if its free room may fall short of all that may be
//!    moved, and are fixed there if not;
//! 2. of the receptacles outside E and R that hold nothing to be moved, those are kept that no
//!    other can stand in for: y for x, if it needs the same horizon, may hold what x may hold of
//!    all that may be moved, and is open unless x is closed;
//! 3. nothing is closed;
//! 4. the agent looks up or down only towards the height of what it focuses, and goes on only from
//!    where it sees something (or from the start);
//! 5. of objects outside O that can be exchanged for one another, the one of lowest id is gone to.
//!
//! Every plan that satisfies the specification has one of the same length here that does:
//!
//! - By 1 to 3, let y do for x, and let an action that only moves what is gone, opens what is open
//!   already, or closes something be a wait (going where the agent is changes nothing). Instant by
//!   instant the agent then sees and knows at least as much: what is merged is seen together, and
//!   what is not closed is not hidden. What is in hand, and what of O is in which receptacle of R,
//!   is the same. So every predicate holds wherever it did, and formulas without negation are
//!   monotone.
//! - By 4, a look that shows nothing and is followed by going elsewhere can as well follow it; and
//!   going to where nothing is seen, and on from there, is a wait.
//! - By 5, the kitchen is the same with the two exchanged.
//!
//! So a shortest plan here is no longer than a shortest plan. It is then run in the kitchen itself,
//! where it may fail in one way only: something is put where there is no room. That receptacle
//! joins E, and the search starts anew; else the plan is a shortest one. The tests compare with a
//! search that leaves nothing out.

use rustc_hash::FxHashMap;
use tltl::Monitor;
use tltl::task::Error;

use crate::action::Action;
use crate::known::Known;
use crate::layout::{Goal, Layout, NONE, ids_below, members};
use crate::relaxed::Relaxed;
use crate::truth::Truth;

/// Finds shortest plans for one specification.
#[derive(Clone, Copy)]
pub struct Planner<'a> {
    layout: &'a Layout,
    monitor: &'a dyn Monitor<Known>,
    /// The objects and receptacles that the specification mentions, as sets of ids.
    objects: u64,
    receptacles: u64,
    /// What the agent is told to fetch.
    goal: Goal,
}

impl<'a> Planner<'a> {
    /// A planner for `monitor`, which must speak of nothing but the predicates `see(o)`, `hold(o)`,
    /// `open(r)`, `inside(o, r)` of the objects and receptacles of `goals`, and negate none of
    /// them. The last of `goals` is the one that the agent is told ([`Known::goal`]).
    ///
    /// # Panics
    /// If there is no goal, or an id is not of the kitchen.
    #[must_use]
    pub fn new(layout: &'a Layout, monitor: &'a dyn Monitor<Known>, goals: &[Goal]) -> Self {
        let set = |id: fn(&Goal) -> u8| goals.iter().fold(0, |set, goal| set | 1u64 << id(goal));
        let (objects, receptacles) = (set(|goal| goal.object), set(|goal| goal.receptacle));
        let all = ids_below(layout.objects());
        assert!(objects & !all == 0, "goals are about objects");
        assert!(receptacles & (all | !ids_below(layout.ids())) == 0, "goals are in receptacles");
        let goal = *goals.last().expect("a planner needs a goal");
        Self { layout, monitor, objects, receptacles, goal }
    }

    /// A shortest plan from `truth`, in which the automaton has read nothing yet; `None` if there
    /// is no plan.
    ///
    /// # Errors
    /// If a predicate is not a number.
    pub fn plan(&self, truth: &Truth) -> Result<Option<Vec<Action>>, Error> {
        let q = self.monitor.next(0, &self.known(truth))?;
        self.plan_from(truth, q)
    }

    /// A shortest plan from `truth`, which the automaton has read and is now in state `q`; `None`
    /// if there is no plan.
    ///
    /// # Errors
    /// If a predicate is not a number.
    pub fn plan_from(&self, truth: &Truth, q: u32) -> Result<Option<Vec<Action>>, Error> {
        let mut exact = 0;
        loop {
            let relaxed = Relaxed::new(self.layout, truth, self.objects, self.receptacles, exact);
            let Some(plan) = self.search(&relaxed, q)? else { return Ok(None) };
            match self.overfull(truth, &relaxed, &plan) {
                None => return Ok(Some(plan)),
                Some(r) => exact |= 1 << r,
            }
        }
    }

    /// A shortest plan by a search that leaves nothing out: for tests, on small kitchens.
    ///
    /// # Errors
    /// If a predicate is not a number.
    pub fn plan_unpruned(&self, truth: &Truth) -> Result<Option<Vec<Action>>, Error> {
        let q = self.monitor.next(0, &self.known(truth))?;
        let everything = Relaxed::unchanged(self.layout, truth);
        self.search(&everything, q)
    }

    /// Where `plan` puts something for which there is no room in the kitchen itself.
    fn overfull(&self, truth: &Truth, relaxed: &Relaxed, plan: &[Action]) -> Option<u8> {
        let (mut real, mut easy) = (*truth, relaxed.truth);
        plan.iter().find_map(|&action| {
            let (possible, found) =
                (real.apply(self.layout, action), easy.apply(&relaxed.layout, action));
            (possible != found).then(|| real.focused_receptacle(self.layout))
        })
    }

    /// What the agent knows at `truth` of what is mentioned.
    fn known(&self, truth: &Truth) -> Known {
        let mut known = Known::at_start(self.layout, truth, self.goal);
        self.update(&mut known, self.layout, truth);
        known
    }

    /// Brings `known` up to `truth`, as far as the predicates of what is mentioned read it.
    #[inline]
    fn update(&self, known: &mut Known, layout: &Layout, truth: &Truth) {
        let view = truth.view(layout);
        known.hand = truth.hand();
        for o in members(self.objects) {
            known.in_view[o as usize] = view >> o & 1 == 1;
            let seen = truth.seen >> o & 1 == 1;
            known.seen_in[o as usize] = if seen { truth.place(o) } else { NONE };
        }
        for r in members(self.receptacles) {
            known.is_open[r as usize] = truth.is_open(r);
        }
    }

    /// A* over situations of `relaxed` and automaton states.
    fn search(&self, relaxed: &Relaxed, q: u32) -> Result<Option<Vec<Action>>, Error> {
        let mut frontier = Frontier::default();
        let mut known = self.known(&relaxed.truth);
        self.reach(&mut frontier, relaxed.truth, q, None);
        while let Some(at) = frontier.pop() {
            let Visited { truth, q, .. } = frontier.nodes[at];
            if self.monitor.is_accepting(q) {
                return Ok(Some(frontier.plan(at)));
            }
            self.update(&mut known, &relaxed.layout, &truth);
            let waited = self.monitor.next(q, &known)?;
            if waited != q {
                self.reach(&mut frontier, truth, waited, Some((at, truth.wait())));
            }
            for action in relaxed.actions() {
                let mut next = truth;
                if !relaxed.takes(&truth, action) || !next.apply(&relaxed.layout, action) {
                    continue;
                }
                self.update(&mut known, &relaxed.layout, &next);
                let q = self.monitor.next(q, &known)?;
                self.reach(&mut frontier, next, q, Some((at, action)));
            }
        }
        Ok(None)
    }

    fn reach(&self, frontier: &mut Frontier, truth: Truth, q: u32, by: Option<(usize, Action)>) {
        if let Some(distance) = self.monitor.distance(q) {
            frontier.push(truth, q, by, distance);
        }
    }
}

impl Truth {
    /// An action that changes nothing: going where the agent is, or taking what it has not found.
    const fn wait(&self) -> Action {
        if self.focus == NONE { Action::Pick } else { Action::Navigate(self.focus) }
    }
}

/// A situation and an automaton state that were reached.
#[derive(Clone, Copy)]
struct Visited {
    truth: Truth,
    q: u32,
    /// The number of steps so far.
    steps: u32,
    /// From which node, by which action.
    by: Option<(usize, Action)>,
    done: bool,
}

/// The nodes, and those that wait, by the least possible length of a plan through them.
#[derive(Default)]
struct Frontier {
    nodes: Vec<Visited>,
    index: FxHashMap<(Truth, u32), usize>,
    /// (node, steps at which it was pushed).
    buckets: Vec<Vec<(usize, u32)>>,
    lowest: usize,
}

impl Frontier {
    fn push(&mut self, truth: Truth, q: u32, by: Option<(usize, Action)>, distance: u32) {
        let steps = by.map_or(0, |(from, _)| self.nodes[from].steps + 1);
        let fresh = self.nodes.len();
        let at = *self.index.entry((truth, q)).or_insert(fresh);
        if at == fresh {
            self.nodes.push(Visited { truth, q, steps, by, done: false });
        } else if self.nodes[at].steps > steps {
            (self.nodes[at].steps, self.nodes[at].by) = (steps, by);
        } else {
            return;
        }
        let bucket = (steps + distance) as usize;
        if self.buckets.len() <= bucket {
            self.buckets.resize(bucket + 1, Vec::new());
        }
        self.buckets[bucket].push((at, steps));
    }

    /// The most promising node; of equal ones the latest.
    fn pop(&mut self) -> Option<usize> {
        while self.lowest < self.buckets.len() {
            let Some((at, steps)) = self.buckets[self.lowest].pop() else {
                self.lowest += 1;
                continue;
            };
            let node = &mut self.nodes[at];
            if node.steps == steps && !node.done {
                node.done = true;
                return Some(at);
            }
        }
        None
    }

    /// The actions that led to node `at`.
    fn plan(&self, at: usize) -> Vec<Action> {
        let back = std::iter::successors(self.nodes[at].by, |&(from, _)| self.nodes[from].by);
        let mut plan: Vec<Action> = back.map(|(_, action)| action).collect();
        plan.reverse();
        plan
    }
}
