//! Which actions to allow around a policy, so that no policy of allowed actions loses much more.
//!
//! An action *costs* what its P(lost) exceeds that of the policy's own action by, if the policy is
//! followed from the next step on. Costs add up over a long run, so a bound on each of them promises
//! nothing by itself: a cost of 1e-10 that is paid at each of 10^10 steps is a loss for sure. So the
//! bound is lowered until the *worst* policy of allowed actions, which is solved for, keeps the promise.
//!
//! It goes down by halves, and each try is a solution: with ε 0.01 on the paper's grid there are about ten.
//! What is found is the largest set of this form within a factor of two of its bound, and not the largest
//! set of all: there need be none, for two actions may be harmless each and not together.

use alloc::vec::Vec;

use crate::policy::Policy;
use crate::reward::End;
use crate::solve::{Actions, Objective, Problem};

/// The least ε that values tell from 0: ten times their error.
const LEAST: f64 = 1e-9;

/// How often a policy of the smallest P(lost) is improved at most.
const IMPROVEMENTS: usize = 16;

/// A policy with its P(lost), and what each action costs against it.
pub(super) struct Around<'a> {
    problem: &'a Problem,
    policy: &'a Policy,
    /// By pair.
    lost: Vec<f64>,
    /// Indexed `pair * actions + a`; 0 at ends.
    costs: Vec<f64>,
}

impl<'a> Around<'a> {
    #[inline]
    pub(super) fn new(problem: &'a Problem, policy: &'a Policy) -> Self {
        let lost = lost(problem, policy);
        let actions = problem.task().actions();
        let mut costs = alloc::vec![0.0; lost.len() * actions];
        for (pair, q, s) in live(problem) {
            let row = &mut costs[pair * actions..][..actions];
            row.iter_mut().enumerate().for_each(|(a, cost)| *cost = risk(problem, &lost, q, s, a));
            let own = row[policy.act(q, s)];
            row.iter_mut().for_each(|cost| *cost -= own);
        }
        Self { problem, policy, lost, costs }
    }

    /// The actions with which every policy loses with at most the policy's own probability plus
    /// `epsilon`, from every pair.
    #[inline]
    pub(super) fn within(&self, epsilon: f64) -> Actions {
        let (mut bound, sure) = (epsilon.max(LEAST), epsilon < LEAST);
        // Costs of less are ties that were rounded; without them the policy is left.
        while bound >= f64::EPSILON {
            let actions = self.up_to(bound, sure);
            if self.keeps(&actions, epsilon.max(LEAST)) {
                return actions;
            }
            let next = self.costs.iter().copied().filter(|&cost| cost <= 0.5 * bound);
            let next = next.fold(0.0, f64::max);
            bound = if bound > f64::EPSILON { next.max(f64::EPSILON) } else { 0.0 };
        }
        self.up_to(f64::NEG_INFINITY, sure)
    }

    /// The policy's actions, and all that cost at most `bound`; if `sure`, where the policy is never
    /// lost, only those after which it is not either.
    #[inline]
    fn up_to(&self, bound: f64, sure: bool) -> Actions {
        let task = self.problem.task();
        let mut allowed = Actions::none(task.pairs(), task.actions());
        for (pair, q, s) in live(self.problem) {
            let bound = if sure && self.lost[pair] == 0.0 { bound.min(0.0) } else { bound };
            allowed.insert(pair, self.policy.act(q, s));
            for a in 0..task.actions() {
                if self.costs[pair * task.actions() + a] <= bound {
                    allowed.insert(pair, a);
                }
            }
        }
        allowed
    }

    /// Whether the worst policy of `actions` loses with at most `epsilon` more.
    #[inline]
    fn keeps(&self, actions: &Actions, epsilon: f64) -> bool {
        let worst = self.problem.lost_within(actions, Objective::Largest);
        worst.as_slice().iter().zip(&self.lost).all(|(worst, own)| *worst <= own + epsilon)
    }
}

/// The live pairs: number, automaton state and state.
#[inline]
fn live(problem: &Problem) -> impl Iterator<Item = (usize, u32, usize)> {
    let task = problem.task();
    task.live().flat_map(move |q| (0..task.states()).map(move |s| (task.pair(q, s), q, s)))
}

/// P(lost) of a policy of this problem, by pair.
#[inline]
fn lost(problem: &Problem, policy: &Policy) -> Vec<f64> {
    problem.lost(policy).expect("a policy of this problem").as_slice().to_vec()
}

/// P(lost) if `a` is taken in (q, s), and is then `lost`.
#[inline]
fn risk(problem: &Problem, lost: &[f64], q: u32, s: usize, a: usize) -> f64 {
    let (task, dynamics) = (problem.task(), problem.dynamics());
    let after = dynamics.row(s, a).map(|(arrival, p)| {
        let to = dynamics.arrived(arrival);
        let next = task.next(q, to);
        // Where the world ends the episode, nothing is lost that is not lost by then.
        let over = arrival >= dynamics.states() && task.end(next) != Some(End::Lost);
        if over { 0.0 } else { p * lost[task.pair(next, to)] }
    });
    after.sum()
}

/// A policy of the smallest P(lost).
///
/// Of actions that are equally safe up to the error of values it takes the best policy's: by rounding
/// alone it would wait, 26,700 steps for 12 on `!c U a` of the paper's grid. Where a world is so slow that
/// what is below that error adds up, it is the safest action to the last bit, improved as by Howard
/// (1960).
#[inline]
pub(super) fn safest(problem: &Problem) -> Policy {
    let smallest = problem.smallest_lost().as_slice().to_vec();
    let mut table = problem.best().policy().table().to_vec();
    improve(problem, &smallest, &mut table, 0.1 * LEAST);
    for _ in 0..IMPROVEMENTS {
        let values = lost(problem, &Policy::from_table(problem.task(), table.clone()));
        if values.iter().zip(&smallest).all(|(own, least)| *own <= least + 0.5 * LEAST)
            || !improve(problem, &values, &mut table, 0.0)
        {
            break;
        }
    }
    Policy::from_table(problem.task(), table)
}

/// Takes the safest action for `values` wherever it is safer by more than `error`; whether it took one.
///
/// Where the trap can surely be avoided it avoids it. From everywhere else every policy comes to
/// an end, or to where it can, so that an improvement cannot go round in circles.
#[inline]
fn improve(problem: &Problem, values: &[f64], table: &mut [u32], error: f64) -> bool {
    let mut improved = false;
    for (pair, q, s) in live(problem) {
        let risk = |a| risk(problem, values, q, s, a);
        let own = risk(table[pair] as usize);
        let safer = |least, a| if risk(a) < risk(least) { a } else { least };
        let safest = (0..problem.task().actions()).fold(table[pair] as usize, safer);
        let sure = risk(safest) == 0.0 && own > 0.0;
        if sure || risk(safest) < own * (1.0 - 4.0 * f64::EPSILON) - error {
            (table[pair], improved) = (safest as u32, true);
        }
    }
    improved
}

/// The best policy for the task, and where success is impossible the safest one.
#[inline]
pub(super) fn best(problem: &Problem) -> Policy {
    let (best, mut table) = (problem.best(), safest(problem).table().to_vec());
    for (pair, q, s) in live(problem) {
        if best.satisfied().at(q, s) > 0.0 {
            table[pair] = best.policy().act(q, s) as u32;
        }
    }
    Policy::from_table(problem.task(), table)
}
