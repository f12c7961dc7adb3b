//! The augmented MDP of which only some actions are left, as a world of its own.
//!
//! Which actions are allowed depends on (q, s), so here the pairs are the states; an action that is not
//! allowed does what the first allowed one does. The automaton only says how a pair has ended. So the best
//! policy of allowed actions is one that the solver finds without knowing of them.
//!
//! Cost: a list of successors for each pair, where the world itself has one for each state.

use alloc::string::ToString;
use alloc::vec::Vec;

use crate::augmented::{LabelTable, Labelled};
use crate::model::{Dynamics, FiniteModel};
use crate::reward::{End, Ends};
use crate::solve::{Actions, Evaluation, Problem};

/// A problem of which only some actions are left, at least one in each live pair.
pub(super) struct Restricted<'a> {
    pub(super) problem: &'a Problem,
    pub(super) actions: &'a Actions,
}

impl Restricted<'_> {
    /// The best policy of allowed actions: the largest P(satisfied), and the fewest steps for it. Its
    /// states are the pairs.
    #[inline]
    pub(super) fn best(&self) -> Evaluation {
        let task = self.problem.task();
        let class = |pair: usize| match task.end((pair / task.states()) as u32) {
            None => 0,
            Some(End::Accepted) => 1,
            Some(End::Lost) => 2,
        };
        let of = alloc::vec![None, Some(End::Accepted), Some(End::Lost)];
        let task = Labelled::from_tables(LabelTable {
            name: task.name().to_string(),
            formula: task.formula().to_string(),
            actions: task.action_names().to_vec(),
            classes: 3,
            class: (0..task.pairs()).map(class).collect(),
            next: alloc::vec![0, 1, 2, 1, 1, 1, 2, 2, 2],
            initial: 0,
            ends: Ends::new(of, alloc::vec![Some(1), Some(0), None]),
            robustness: Vec::new(),
        });
        let dynamics = Dynamics::new(self).expect("the outcomes of a model that was checked");
        Problem::of_own_world(dynamics, task.expect("fewer than 2^32 pairs")).best()
    }

    /// What `action` does in `pair` under the mask.
    #[inline]
    fn allowed(&self, pair: usize, action: usize) -> usize {
        let allows = |&a: &usize| self.actions.contains(pair, a);
        if allows(&action) { action } else { (0..self.actions()).find(allows).unwrap_or(action) }
    }

    /// The pairs in which an action arrives, as the episode goes on or ends.
    fn arrivals(&self, pair: usize, a: usize, ended: bool, mut outcome: impl FnMut(usize, f64)) {
        let (task, dynamics) = (self.problem.task(), self.problem.dynamics());
        let (q, s) = ((pair / task.states()) as u32, pair % task.states());
        if task.end(q).is_some() {
            let stays = if ended { None } else { Some(pair) };
            return stays.into_iter().for_each(|pair| outcome(pair, 1.0));
        }
        for (arrival, p) in dynamics.row(s, self.allowed(pair, a)) {
            if ended == (arrival >= dynamics.states()) {
                let to = dynamics.arrived(arrival);
                outcome(task.pair(task.next(q, to), to), p);
            }
        }
    }
}

impl FiniteModel for Restricted<'_> {
    type State = usize;

    #[inline]
    fn states(&self) -> usize {
        self.problem.task().pairs()
    }

    #[inline]
    fn actions(&self) -> usize {
        self.problem.task().actions()
    }

    #[inline]
    fn state(&self, pair: usize) -> usize {
        pair
    }

    fn transitions(&self, pair: usize, action: usize, outcome: impl FnMut(usize, f64)) {
        self.arrivals(pair, action, false, outcome);
    }

    fn endings(&self, pair: usize, action: usize, outcome: impl FnMut(usize, f64)) {
        self.arrivals(pair, action, true, outcome);
    }

    #[inline]
    fn start(&self, pair: usize) -> f64 {
        let task = self.problem.task();
        let s = pair % task.states();
        let starts = pair == task.pair(task.start(s), s);
        if starts { self.problem.dynamics().starts()[s] } else { 0.0 }
    }
}
