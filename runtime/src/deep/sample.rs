//! Replayed steps, ready to learn from.
//!
//! A batch is drawn, and from each step the trajectory is followed up to n steps on. The automaton is
//! asked what these do at every live state that learns from the step: one return for each such head of a network.
//!
//! An n-step return is of the actions that were taken, for q they were perhaps not taken for. It is
//! therefore biased towards what was done in the automaton state of the time; n = 1 has no such bias and
//! mostly learns slower.

use rand::Rng;
use std::vec::Vec;

use super::replay::Replay;
use super::{Error, Relabel};
use crate::augmented::Moves;
use crate::env::{Step, unit};
use crate::episode::Move;
use crate::learn::Updates;
use crate::task;

/// The heads of a network: one for each automaton state in which the task goes on.
///
/// Decided states have none: nothing can be had there, and their value is 0.
#[derive(Clone, Debug)]
pub(super) struct Heads {
    /// The automaton state of each head.
    pub states: Vec<u32>,
    /// The head of each automaton state.
    of: Vec<Option<usize>>,
}

impl Heads {
    pub(super) fn new(moves: &Moves, automaton_states: u32) -> Self {
        let states: Vec<u32> = moves.ends().live().collect();
        let mut of = std::vec![None; automaton_states as usize];
        states.iter().enumerate().for_each(|(head, &q)| of[q as usize] = Some(head));
        Self { states, of }
    }

    /// The head of `q`; none where the task is decided, or has no such state: what is replayed may have
    /// been seen for another task.
    pub(super) fn of(&self, q: u32) -> Option<usize> {
        self.of.get(q as usize).copied().flatten()
    }

    /// The return of some steps to the automaton state `q`.
    fn return_of<S>(
        &self,
        mut q: u32,
        steps: &[Step<S>],
        read: Read<'_, S>,
        gamma: f64,
    ) -> Result<Return, Error> {
        let mut found = Return { reward: 0.0, discount: 1.0, head: 0 };
        for step in steps {
            let Move { to, reward, .. } = read(q, step)?;
            found.reward += found.discount * reward;
            found.discount *= gamma;
            q = to;
            match self.of(q) {
                Some(head) if !step.terminated => found.head = head,
                _ => {
                    found.discount = 0.0;
                    break;
                }
            }
        }
        Ok(found)
    }
}

/// The n-step return of some replayed steps, up to the value after them.
///
/// Where the task or the episode ends within the steps, nothing follows and the discount is 0.
#[derive(Default)]
pub(super) struct Return {
    /// The discounted rewards of the steps.
    pub reward: f64,
    /// What a value after them is worth now; 0 if there is none.
    pub discount: f64,
    /// The head after them, if the task goes on.
    pub head: usize,
}

/// Replayed steps, ready to learn from.
///
/// Columns of one entry for each step that was drawn, in that order; `counts` and `returns` have one for each
/// step and head, indexed `row * heads + head`.
pub(super) struct Sample<S, A> {
    pub places: Vec<usize>,
    pub weights: Vec<f64>,
    pub actions: Vec<A>,
    pub before: Vec<S>,
    pub after: Vec<S>,
    /// Whether the head learns from the step.
    pub counts: Vec<bool>,
    /// Nothing where it does not.
    pub returns: Vec<Return>,
}

/// How steps are drawn.
pub(super) struct Drawing {
    /// How many.
    pub batch: usize,
    /// How many steps a return adds up.
    pub steps: usize,
    /// The share that gets another goal.
    pub relabelled: f64,
    /// Not 0: in proportion to priorities.
    pub priority: f64,
    /// How much of the bias of priorities the weights take back.
    pub beta: f64,
    /// The discount factor.
    pub gamma: f64,
    /// Which heads learn from a step.
    pub updates: Updates,
}

/// What a step does at an automaton state.
type Read<'a, S> = &'a dyn Fn(u32, &Step<S>) -> Result<Move, task::Error>;

impl<S: Clone, A: Clone + Default> Sample<S, A> {
    /// Draws some steps.
    ///
    /// Weights are probability^-β over the largest of the batch (Schaul et al. 2016), so that they only
    /// shorten steps.
    pub(super) fn draw<G: Relabel<S>, R: Rng + ?Sized>(
        replay: &Replay<S, A>,
        heads: &Heads,
        goals: &G,
        read: Read<'_, S>,
        how: &Drawing,
        rng: &mut R,
    ) -> Result<Self, Error> {
        let mut sample = Self {
            places: Vec::new(),
            weights: Vec::new(),
            actions: Vec::new(),
            before: Vec::new(),
            after: Vec::new(),
            counts: Vec::new(),
            returns: Vec::new(),
        };
        for _ in 0..how.batch {
            let (place, probability) = match how.priority {
                0.0 => (replay.draw_uniformly(rng), 1.0),
                _ => replay.draw(rng),
            };
            let mut steps = relabelled(replay, place, goals, how, rng);
            let moment = replay.moment(place);
            for &q in &heads.states {
                let counts = how.updates == Updates::Counterfactual || moment.q == q;
                let found = counts.then(|| heads.return_of(q, &steps[1..], read, how.gamma));
                sample.counts.push(counts);
                sample.returns.push(found.transpose()?.unwrap_or_default());
            }
            sample.places.push(place);
            sample.weights.push(probability.powf(-how.beta));
            sample.actions.push(moment.action.clone());
            sample.after.push(steps.pop().expect("a step has two states").state);
            sample.before.push(steps.swap_remove(0).state);
        }
        let largest = sample.weights.iter().copied().fold(f64::MIN_POSITIVE, f64::max);
        sample.weights.iter_mut().for_each(|w| *w /= largest);
        Ok(sample)
    }
}

/// A step or several, with one goal; the first one leads to the state before them.
///
/// All of them get one goal, chosen from what is known in the first state.
fn relabelled<S: Clone, A: Clone + Default, G: Relabel<S>, R: Rng + ?Sized>(
    replay: &Replay<S, A>,
    place: usize,
    goals: &G,
    how: &Drawing,
    rng: &mut R,
) -> Vec<Step<S>> {
    let ahead = replay.steps_from(place);
    let count = how.steps.clamp(1, ahead);
    let moment = |i| replay.moment(replay.after(place, i));
    let relabel = how.relabelled > 0.0 && unit(rng) < how.relabelled;
    let goal = relabel.then(|| goals.choose(&moment(0).state, rng)).flatten();
    let given = |state: &S| match &goal {
        Some(goal) => goals.give(state, goal),
        None => state.clone(),
    };
    let first = Step::to(given(&moment(0).state));
    let later = (0..count).map(|i| {
        let (reward, terminated) = (moment(i).reward, moment(i).terminated);
        Step { reward, terminated, ..Step::to(given(&moment(i + 1).state)) }
    });
    core::iter::once(first).chain(later).collect()
}
