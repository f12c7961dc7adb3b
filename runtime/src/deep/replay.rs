//! What was seen, and which of it to learn from: prioritized replay (Schaul et al. 2016).
//!
//! The replay keeps *states* and not transitions, each once, in the order in which they were met: half
//! the memory, and n-step returns and other goals are had by walking on from any place. What a step
//! pays is not kept, but what the environment paid; the rest depends on q and on the goal, and is
//! computed when the step is drawn.

use rand::Rng;
use serde::{Deserialize, Serialize};
use std::vec::Vec;

use crate::env::{Step, below, unit};

/// Non-negative weights in a binary tree of sums: to change one and to draw one in proportion cost
/// log₂ n.
///
/// Schaul et al. call it so. Sums are added up anew along the path to the root at each change and never
/// corrected by differences, so that after any number of changes they are sums of what is there.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct SumTree {
    /// Node i has the children 2i and 2i + 1; the leaves are `leaves..2 * leaves`.
    sums: Vec<f64>,
    leaves: usize,
}

impl SumTree {
    /// `n` weights of 0.
    pub(super) fn new(n: usize) -> Self {
        let leaves = n.next_power_of_two();
        Self { sums: std::vec![0.0; 2 * leaves], leaves }
    }

    /// Whether these are sums, of so many weights.
    fn is_sound(&self, n: usize) -> bool {
        let Self { sums, leaves } = self;
        let sizes = *leaves == n.next_power_of_two() && sums.len() == 2 * leaves;
        sizes
            && sums[*leaves..].iter().all(|weight| weight.is_finite() && *weight >= 0.0)
            && (1..*leaves).all(|node| sums[node] == sums[2 * node] + sums[2 * node + 1])
    }

    /// The weight of `i`.
    pub(super) fn get(&self, i: usize) -> f64 {
        self.sums[self.leaves + i]
    }

    /// The sum of all weights.
    pub(super) fn total(&self) -> f64 {
        self.sums[1]
    }

    /// Sets the weight of `i`.
    ///
    /// # Panics
    /// If it is negative or not finite.
    pub(super) fn set(&mut self, i: usize, weight: f64) {
        assert!(weight.is_finite() && weight >= 0.0, "weights are finite and not negative");
        let mut node = self.leaves + i;
        self.sums[node] = weight;
        while node > 1 {
            node /= 2;
            // Added up anew, so that no error accumulates.
            self.sums[node] = self.sums[2 * node] + self.sums[2 * node + 1];
        }
    }

    /// The number whose share of the sum `mass` falls into, 0 ≤ `mass` < [`Self::total`].
    ///
    /// Rounding may leave a `mass` that no leaf holds; it never leads to a leaf of weight 0.
    pub(super) fn find(&self, mut mass: f64) -> usize {
        let mut node = 1;
        while node < self.leaves {
            node *= 2;
            let left = self.sums[node];
            // A rounded mass must not lead to where there is none.
            if mass >= left && self.sums[node + 1] > 0.0 {
                mass -= left;
                node += 1;
            }
        }
        node - self.leaves
    }
}

/// A state that was met, and what was done there: a number, or a vector of continuous actions.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Visit<S, A = u32> {
    /// The state.
    pub(super) state: S,
    /// The automaton state then, of the task that was being learned; of a last state 0.
    pub(super) q: u32,
    /// The action taken.
    pub(super) action: A,
    /// What the environment paid for it.
    pub(super) reward: f64,
    /// Whether it ended the environment's episode.
    pub(super) terminated: bool,
    /// The place of the episode's last state; meaningless until the episode is over.
    last: u32,
}

/// A ring of the last states that were met, in order, with a priority for each step.
///
/// States are kept once: the step from place i leads to place i + 1. The last state of an episode has
/// no step and the priority 0.
///
/// When the ring is full the oldest state is overwritten. An episode whose beginning is gone is still
/// whole from where it goes on.
///
/// [`Learner::replay`](super::Learner::replay) shows it, and [`Composition`](super::Composition) learns
/// from those of its skills.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Unchecked<S, A>")]
#[serde(bound(deserialize = "S: Deserialize<'de>, A: Deserialize<'de> + Clone + Default"))]
pub struct Replay<S, A = u32> {
    moments: Vec<Visit<S, A>>,
    capacity: usize,
    /// Where the current state is.
    head: usize,
    /// How many states back the current episode began.
    age: usize,
    priorities: SumTree,
    largest: f64,
}

/// A replay as it comes from a file.
#[derive(Deserialize)]
struct Unchecked<S, A> {
    moments: Vec<Visit<S, A>>,
    capacity: usize,
    head: usize,
    age: usize,
    priorities: SumTree,
    largest: f64,
}

impl<S, A: Clone + Default> TryFrom<Unchecked<S, A>> for Replay<S, A> {
    type Error = &'static str;

    fn try_from(saved: Unchecked<S, A>) -> Result<Self, &'static str> {
        let Unchecked { moments, capacity, head, age, priorities, largest } = saved;
        let replay = Self { moments, capacity, head, age, priorities, largest };
        match replay.is_sound() {
            true => Ok(replay),
            false => Err("a replay whose parts do not fit each other"),
        }
    }
}

impl<S, A: Clone + Default> Replay<S, A> {
    /// Whether places, priorities and episodes fit each other.
    fn is_sound(&self) -> bool {
        let (n, capacity, age) = (self.moments.len(), self.capacity, self.age);
        let sizes = capacity > 1 && u32::try_from(capacity).is_ok() && n <= capacity;
        let largest = self.largest > 0.0 && self.largest.is_finite();
        if !(sizes && largest && self.priorities.is_sound(capacity)) {
            return false;
        }
        let beyond = (n..self.priorities.leaves).all(|place| self.priorities.get(place) == 0.0);
        let rewards = self.moments.iter().all(|moment| moment.reward.is_finite());
        if n == 0 || !beyond || !rewards {
            return n == 0 && beyond && self.head == 0 && age == 0;
        }
        let is_head = if n < capacity { self.head == n - 1 } else { self.head < n };
        if !is_head || self.priorities.get(self.head) > 0.0 {
            return false;
        }
        let has_step = |place: usize| self.priorities.get(place) > 0.0;
        let current = (1..n).take_while(|&back| has_step(self.before(back))).count();
        if current != age.min(n - 1) {
            return false;
        }
        // From the newest to the oldest, each step knows where its episode ends.
        let mut last = self.head;
        (0..n).all(|back| {
            let place = self.before(back);
            if !has_step(place) {
                last = place;
            }
            back <= current || self.moments[place].last as usize == last
        })
    }

    /// The actions of all steps.
    pub(super) fn steps(&self) -> impl Iterator<Item = &A> {
        let steps = self.moments.iter().enumerate();
        steps
            .filter(|(place, _)| self.priorities.get(*place) > 0.0)
            .map(|(_, moment)| &moment.action)
    }

    /// Room for `capacity` states.
    ///
    /// # Panics
    /// If there is room for none, or for more than 2^32.
    pub(super) fn new(capacity: usize) -> Self {
        assert!(capacity > 1 && u32::try_from(capacity).is_ok(), "room for 2 to 2^32 states");
        let priorities = SumTree::new(capacity);
        Self { moments: Vec::new(), capacity, head: 0, age: 0, priorities, largest: 1.0 }
    }

    /// The number of states that are kept.
    #[must_use]
    pub fn len(&self) -> usize {
        self.moments.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.moments.is_empty()
    }

    fn put(&mut self, state: S) {
        let action = A::default();
        let moment = Visit { state, q: 0, action, reward: 0.0, terminated: false, last: 0 };
        self.head = if self.moments.is_empty() { 0 } else { (self.head + 1) % self.capacity };
        if self.head == self.moments.len() {
            self.moments.push(moment);
        } else {
            self.moments[self.head] = moment;
        }
        self.priorities.set(self.head, 0.0);
    }

    /// An episode begins in `state`, and the one before is over.
    pub(super) fn start(&mut self, state: S) {
        self.end();
        self.put(state);
    }

    /// A step from the current state, taken in the automaton state `q`.
    pub(super) fn push(&mut self, q: u32, action: A, step: Step<S>) {
        let moment = &mut self.moments[self.head];
        (moment.q, moment.action) = (q, action);
        (moment.reward, moment.terminated) = (step.reward, step.terminated);
        self.priorities.set(self.head, self.largest);
        self.put(step.state);
        self.age += 1;
    }

    /// Notes where the current episode ended.
    fn end(&mut self) {
        let (head, back) = (self.head, self.age.min(self.moments.len().saturating_sub(1)));
        if self.moments.is_empty() {
            return;
        }
        for i in 0..=back {
            let place = self.before(i);
            self.moments[place].last = head as u32;
        }
        self.age = 0;
    }

    /// The place `n` states before the current one.
    fn before(&self, n: usize) -> usize {
        (self.head + self.capacity - n) % self.capacity
    }

    /// What is at a place.
    pub(super) fn moment(&self, place: usize) -> &Visit<S, A> {
        &self.moments[place]
    }

    /// How many steps of its episode follow the place, itself included.
    ///
    /// A step that has been overwritten is not asked for: its place has another priority by then.
    pub(super) fn steps_from(&self, place: usize) -> usize {
        let since = (self.head + self.capacity - place) % self.capacity;
        if since <= self.age {
            return since;
        }
        (self.moments[place].last as usize + self.capacity - place) % self.capacity
    }

    /// The place `n` steps later.
    pub(super) fn after(&self, place: usize, n: usize) -> usize {
        (place + n) % self.capacity
    }

    /// Draws a step uniformly: its place.
    ///
    /// Drawn again where the place has no step: all but the last states of episodes have one.
    ///
    /// # Panics
    /// If there are no steps.
    #[track_caller]
    pub(super) fn draw_uniformly<R: Rng + ?Sized>(&self, rng: &mut R) -> usize {
        assert!(self.priorities.total() > 0.0, "there are no steps to draw");
        loop {
            let place = below(self.moments.len(), rng);
            if self.priorities.get(place) > 0.0 {
                return place;
            }
        }
    }

    /// Draws a step in proportion to its priority: its place, and its probability times the number
    /// of states kept.
    ///
    /// # Panics
    /// If there are no steps.
    #[track_caller]
    pub(super) fn draw<R: Rng + ?Sized>(&self, rng: &mut R) -> (usize, f64) {
        let total = self.priorities.total();
        assert!(total > 0.0, "there are no steps to draw");
        let place = self.priorities.find(unit(rng) * total);
        (place, self.priorities.get(place) / total * self.moments.len() as f64)
    }

    /// Sets the priority of the step at `place`; it must be positive.
    ///
    /// New steps get the largest priority so far, so that each is drawn soon once.
    pub(super) fn prioritise(&mut self, place: usize, priority: f64) {
        self.largest = self.largest.max(priority);
        self.priorities.set(place, priority);
    }

    /// The states, oldest episode first is not promised; with what was done there.
    pub(super) fn moments(&self) -> &[Visit<S, A>] {
        &self.moments
    }

    /// Adds all of another replay's episodes; `q` says what its automaton states are here.
    ///
    /// Steps that are not whole in a full ring (its oldest state may be in the middle of an episode)
    /// begin an episode of their own.
    pub(super) fn extend(&mut self, other: &Self, q: impl Fn(u32) -> u32)
    where
        S: Clone,
    {
        let (n, oldest) =
            (other.len(), if other.len() < other.capacity { 0 } else { other.head + 1 });
        let mut begun = false;
        for place in (0..n).map(|i| (oldest + i) % n) {
            let moment = &other.moments[place];
            if !begun {
                self.start(moment.state.clone());
            }
            begun = other.priorities.get(place) > 0.0;
            if begun {
                let Visit { reward, terminated, .. } = *moment;
                let state = other.moments[(place + 1) % n].state.clone();
                let step = Step { state, reward, terminated, truncated: false };
                self.push(q(moment.q), moment.action.clone(), step);
            }
        }
    }
}
