//! The kitchen as an environment: starts, goals, time limits.
//!
//! A start, in the paper's spirit: the agent focuses nothing and looks straight ahead with an empty
//! hand; the objects, in random order, are put each into a receptacle drawn uniformly among those
//! that may hold it and have room; each door is open with probability 1/2. A start in which a
//! wanted object stands where it is wanted is drawn again.

use std::fmt;
use std::sync::Arc;

use tltl::env::{Env, Step};
use tltl::rand::Rng;

use crate::action::Action;
use crate::known::Known;
use crate::layout::{Goal, Layout, NONE, ids_below, members};
use crate::truth::Truth;

/// What is wanted of an episode, and what starts are drawn for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Goals {
    /// Always the same: task 1, with the apple and the fridge.
    Fixed {
        /// The object.
        object: u8,
        /// The receptacle that it is wanted in.
        receptacle: u8,
    },
    /// One of the feasible goals, all equally likely: task 2.
    Random {
        /// An object that is never the wanted one.
        except: Option<u8>,
    },
    /// As `Random`, with another object than this one, and from starts that suit this goal too:
    /// the composition. What the agent is told is the random goal.
    Beside {
        /// The object of the goal that is always there.
        object: u8,
        /// Its receptacle.
        receptacle: u8,
    },
}

/// A kitchen, and the agent in it.
///
/// A step pays -1 if its action failed and 0 otherwise; what that costs is the learner's to say
/// (`Rewards::environment`). No step terminates: tasks do.
///
/// ```
/// use std::sync::Arc;
/// use tltl::env::Env;
/// use tltl::rand::{SeedableRng, rngs::Xoshiro256PlusPlus};
/// use tltl_kitchen::{Action, Goals, Kitchen, Layout};
///
/// let layout = Arc::new(Layout::floorplan24());
/// let mut kitchen = Kitchen::new(layout.clone(), Goals::Random { except: None }, 200)?;
/// let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
/// let start = kitchen.reset(&mut rng);
/// assert!(layout.feasible(start.wanted, start.target));
///
/// let go = Action::Navigate(start.target).index();
/// assert_eq!(kitchen.step(go, &mut rng).state.focus, start.target);
/// assert_eq!(kitchen.step(Action::Pick.index(), &mut rng).reward, -1.0);
/// # Ok::<(), tltl_kitchen::world::GoalError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Kitchen {
    layout: Arc<Layout>,
    /// The goals that are drawn from.
    drawn: Vec<Goal>,
    /// The goal that starts must suit besides the drawn one.
    beside: Option<Goal>,
    horizon_steps: u32,
    truth: Truth,
    known: Known,
    /// What is in view, as a set of ids.
    view: u64,
    failed: bool,
    steps: u32,
    failures: u32,
}

impl Kitchen {
    /// A kitchen whose episodes are truncated after `horizon_steps` steps. Before the first reset
    /// it is empty.
    ///
    /// # Errors
    /// If there is no goal to draw: the fixed one is not [feasible](Layout::feasible), or no start
    /// suits both goals.
    pub fn new(layout: Arc<Layout>, goals: Goals, horizon_steps: u32) -> Result<Self, GoalError> {
        let beside = match goals {
            Goals::Beside { object, receptacle } => Some(Goal { object, receptacle }),
            _ => None,
        };
        let drawn = drawn(&layout, goals)?;
        let truth = Truth::at_rest(&layout);
        let known = Known::at_start(&layout, &truth, Goal { object: NONE, receptacle: NONE });
        Ok(Self {
            layout,
            drawn,
            beside,
            horizon_steps,
            truth,
            known,
            view: 0,
            failed: false,
            steps: 0,
            failures: 0,
        })
    }

    /// Starts an episode at `truth` with the goal `goal`, whatever the goals that are drawn from:
    /// for tests and replays.
    ///
    /// # Errors
    /// If the goal is not feasible. That the object stands where it is wanted is no error.
    pub fn start_at(&mut self, truth: Truth, goal: Goal) -> Result<Known, GoalError> {
        check(&self.layout, goal)?;
        Ok(self.begin(truth, goal))
    }

    fn begin(&mut self, truth: Truth, goal: Goal) -> Known {
        self.truth = truth;
        self.known = Known::at_start(&self.layout, &truth, goal);
        self.view = truth.view(&self.layout);
        (self.failed, self.steps, self.failures) = (false, 0, 0);
        self.known
    }

    /// Takes an action that the agent chooses; [`Env::step`] without an `Rng`, for nothing here
    /// is random.
    #[inline]
    pub fn act(&mut self, action: Action) -> Step<Known> {
        self.steps += 1;
        self.failed = !self.truth.apply(&self.layout, action);
        if self.failed {
            self.failures += 1;
        } else {
            self.view = self.known.observe(&self.layout, &self.truth, self.view);
        }
        Step {
            reward: if self.failed { -1.0 } else { 0.0 },
            truncated: self.steps >= self.horizon_steps,
            ..Step::to(self.known)
        }
    }

    /// The static facts.
    #[must_use]
    pub const fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    /// What is true, hidden or not.
    #[must_use]
    pub const fn truth(&self) -> &Truth {
        &self.truth
    }

    /// What the agent knows.
    #[must_use]
    pub const fn known(&self) -> &Known {
        &self.known
    }

    /// Whether the last action failed.
    #[must_use]
    pub const fn failed(&self) -> bool {
        self.failed
    }

    /// The number of steps of this episode.
    #[must_use]
    pub const fn steps(&self) -> u32 {
        self.steps
    }

    /// How many of them failed.
    #[must_use]
    pub const fn failures(&self) -> u32 {
        self.failures
    }

    /// After how many steps an episode is truncated.
    #[must_use]
    pub const fn horizon_steps(&self) -> u32 {
        self.horizon_steps
    }

    /// The goals that are drawn from.
    #[must_use]
    pub fn goals(&self) -> &[Goal] {
        &self.drawn
    }

    /// A start that suits `goal`, and the goal beside it.
    fn arranged<R: Rng + ?Sized>(&self, goal: Goal, rng: &mut R) -> Truth {
        let there =
            |truth: &Truth, goal: Goal| truth.place[goal.object as usize] == goal.receptacle;
        loop {
            let Some(truth) = arrange(&self.layout, rng) else { continue };
            if !there(&truth, goal) && !self.beside.is_some_and(|beside| there(&truth, beside)) {
                return truth;
            }
        }
    }
}

impl Env for Kitchen {
    type State = Known;

    fn actions(&self) -> usize {
        self.layout.actions()
    }

    fn reset<R: Rng + ?Sized>(&mut self, rng: &mut R) -> Known {
        let goal = self.drawn[below(self.drawn.len() as u32, rng) as usize];
        let truth = self.arranged(goal, rng);
        self.begin(truth, goal)
    }

    #[inline]
    fn step<R: Rng + ?Sized>(&mut self, action: usize, _: &mut R) -> Step<Known> {
        self.act(Action::from_index(action))
    }

    fn action_name(&self, a: usize) -> String {
        Action::from_index(a).name(&self.layout)
    }
}

/// The goals that are drawn from.
fn drawn(layout: &Layout, goals: Goals) -> Result<Vec<Goal>, GoalError> {
    let all = layout.feasible_goals();
    let drawn: Vec<Goal> = match goals {
        Goals::Fixed { object, receptacle } => {
            let goal = Goal { object, receptacle };
            check(layout, goal)?;
            vec![goal]
        }
        Goals::Random { except } => all.filter(|goal| Some(goal.object) != except).collect(),
        Goals::Beside { object, receptacle } => {
            let beside = Goal { object, receptacle };
            check(layout, beside)?;
            let other = all.filter(|goal| goal.object != object);
            other.filter(|&goal| layout.has_start(&[beside, goal])).collect()
        }
    };
    if drawn.is_empty() {
        return Err(GoalError("no goal is left to draw".into()));
    }
    Ok(drawn)
}

fn check(layout: &Layout, Goal { object, receptacle }: Goal) -> Result<(), GoalError> {
    if !layout.is_object(object) || !layout.is_receptacle(receptacle) {
        return Err(GoalError(format!(
            "{object} in {receptacle} is not an object in a receptacle"
        )));
    }
    let (o, r) = (layout.name(object), layout.name(receptacle));
    if !layout.may_hold(receptacle, object) {
        return Err(GoalError(format!("`{o}` may not be put into `{r}`")));
    }
    if !layout.feasible(object, receptacle) {
        return Err(GoalError(format!("`{o}` is in `{r}` at every start")));
    }
    Ok(())
}

/// Puts the objects somewhere, and opens doors; `None` if an object was left without room.
pub(crate) fn arrange<R: Rng + ?Sized>(layout: &Layout, rng: &mut R) -> Option<Truth> {
    let mut truth = Truth::at_rest(layout);
    let mut room = ids_below(layout.ids()) & !ids_below(layout.objects());
    let mut held = [0; crate::MAX_IDS];
    let mut left = ids_below(layout.objects());
    while left != 0 {
        let o = nth(left, below(left.count_ones(), rng));
        left &= !(1 << o);
        let places = layout.places(o) & room;
        if places == 0 {
            return None;
        }
        let r = nth(places, below(places.count_ones(), rng));
        truth.place[o as usize] = r;
        held[r as usize] += 1;
        room &= !(u64::from(held[r as usize] == layout.capacity(r)) << r);
    }
    truth.open |= rng.next_u64() & layout.doors();
    Some(truth)
}

/// The `n`-th member of a set of ids, from 0.
fn nth(set: u64, n: u32) -> u8 {
    members(set).nth(n as usize).expect("the set has so many members")
}

/// A number in `0..n`, uniform up to a relative error of `n / 2^32`.
fn below<R: Rng + ?Sized>(n: u32, rng: &mut R) -> u32 {
    ((u64::from(rng.next_u32()) * u64::from(n)) >> 32) as u32
}

/// Why there is no goal, or no start for it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct GoalError(String);

impl fmt::Display for GoalError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for GoalError {}
