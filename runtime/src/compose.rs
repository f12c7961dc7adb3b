//! Composition of learned skills (paper, Algorithm 2), without a step in the world.
//!
//! Skills are action values over the same world, each for its own task; an [operator](Operator) says what
//! they are to do together. [`Composition::run`] takes all steps, says what each is worth, and keeps the
//! best:
//!
//! - Step 2, [`Composition::initial`]: sum (or maximum) of the skills' values. For two *optimal*
//!   tables the sum is only a start: with the paper's rewards on the paper's grid its greedy policy is
//!   optimal in 91.96 % of the pairs and in 81.25 % of those where both skills are pending.
//! - Steps 3–5, [`Composition::compensated`]: what the sum counts too much is subtracted. That leaves the
//!   values, in the product, of the policy that is greedy in the sum, and acting greedily for those improves
//!   on it: for the rewards, no pair gets worse.
//! - Step 6, [`Composition::refined`]: off-policy updates until nothing changes, which is the
//!   optimum of the product. "Replay" is [`Dynamics`]: of the model, and then it is exact, or of
//!   the remembered [`Experience`](crate::learn::Experience), relabelled with every automaton
//!   state, and then it is what a [`Learner`](crate::learn::Learner) of the product hands out that has
//!   seen the same.
//!
//! Why not Eq. 3C10 to the letter? Eq. 3C8, Q₁ + Q₂ − Q₁₂ = Q of the product, holds for the values of one
//! fixed policy. Where Q₁ and Q₂ are the optimal values, each of its own policy, what is left is the product's
//! value plus what each skill would gain alone by leaving the sum's policy; and after a move that loses one
//! skill the other's value stands, as if it went on. Where acceptance is paid, such a move was then
//! worth 1, as much as the best one, for of that the pay for the first skill had been taken back. On a grid of
//! 4 × 5 cells (slip 0.2, γ 0.999) exact skills `!c U a` and `F b` in sequence so came from a regret of 0.06 %
//! of P(satisfied) to 89 %. So all three values are taken of the same policy, and their combination is
//! computed at once: it stays at 0.06 %.
//!
//! All values are *flat* (they bootstrap at q'), never sub-policy values.
//!
//! Networks are composed in `deep`; [`Compose`] is what the two have in common.

mod steps;

use alloc::string::String;
use alloc::vec::Vec;
use core::convert::Infallible;

use crate::augmented::{Joint, LabelError, Labelled};
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::monitor::Acceptor as _;
pub use crate::product::Operator;
use crate::product::Product;
use crate::q::{QTable, largest};
use crate::reward::Rewards;
use crate::solve::Problem;
pub use steps::{Stage, Step, Steps};

/// How the skills' values are combined.
///
/// Where skills are scaled differently (one pays once, another twice on its way) the plain sum
/// listens to the one with more to gain; [`Self::NormalisedSum`] listens to both alike.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row, and a skill for each end.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let (left, right) = (tltl! { |s: &usize| F ({ *s } == 0) }, tltl! { |s: &usize| F ({ *s } == 4) });
/// let (world, rewards) = (Dynamics::new(&row)?, Rewards::default());
/// let one = Problem::new(&world, &Labelled::of_model(&row, &left)?)?.optimal_q(&rewards);
/// let two = Problem::new(&world, &Labelled::of_model(&row, &right)?)?.optimal_q(&rewards);
/// let product = Product::conjunction(&[&left, &right]);
/// let task = Labelled::of_model(&row, &product)?;
/// let composition = Composition::new(&product, &task, &[&one, &two], rewards)?;
/// let nearer = [Combine::Sum, Combine::NormalisedSum, Combine::Max].map(|combine| {
///     let q = composition.initial(combine);
///     [q.greedy(0, 1), q.greedy(0, 3)]
/// });
/// assert_eq!(nearer, [[0, 1]; 3], "beside an end each of them goes there first");
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Combine {
    /// Their sum (Algorithm 2, step 2).
    Sum,
    /// Their sum, each first divided by its largest value (Section 5.1).
    NormalisedSum,
    /// Their maximum: go for the most promising skill.
    Max,
}

/// Skills that are being composed, step by step, whatever holds their values: tables
/// ([`Composition::on`]), networks (`deep::Composition`) or actors (`deep::actor::Composition`). It begins
/// at step 2.
///
/// A study that compares the steps is so written once for both:
///
/// ```
/// use tltl::compose::Compose;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// /// What is done first, after step 2 and after step 6.
/// fn first<C: Compose>(mut skills: C, q: u32, s: &C::State) -> Result<[C::Action; 2], C::Error> {
///     let sum = skills.act(q, s)?;
///     skills.refine(1)?;
///     Ok([sum, skills.act(q, s)?])
/// }
///
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let (left, right) = (tltl! { |s: &usize| F ({ *s } == 0) }, tltl! { |s: &usize| F ({ *s } == 4) });
/// let (world, rewards) = (Dynamics::new(&row)?, Rewards::default());
/// let one = Problem::new(&world, &Labelled::of_model(&row, &left)?)?.optimal_q(&rewards);
/// let two = Problem::new(&world, &Labelled::of_model(&row, &right)?)?.optimal_q(&rewards);
/// let product = Product::conjunction(&[&left, &right]);
/// let task = Labelled::of_model(&row, &product)?;
/// let tables = Composition::new(&product, &task, &[&one, &two], rewards)?;
/// assert_eq!(first(tables.on(&world, Combine::Sum)?, 0, &3)?, [1, 1]);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
pub trait Compose {
    /// A state of the world; of tables, its number.
    type State: ?Sized;
    /// An action: a number, or a vector where actions are continuous.
    type Action;
    /// Why a step can fail.
    type Error;

    /// Steps 3–5, by so many updates; tables need one, of everything.
    ///
    /// # Errors
    /// If a value is not a finite number.
    fn compensate(&mut self, updates: u64) -> Result<(), Self::Error>;

    /// Step 6, by so many updates; tables need one, of everything.
    ///
    /// # Errors
    /// If a value is not a finite number.
    fn refine(&mut self, updates: u64) -> Result<(), Self::Error>;

    /// The greedy action in (s, q), at a state of the product.
    ///
    /// # Errors
    /// If a value is not a finite number.
    fn act(&self, q: u32, s: &Self::State) -> Result<Self::Action, Self::Error>;
}

/// A composition of tables that is carried out step by step.
///
/// [`Composition::on`] makes it; as a [`Compose`] it is what networks are too. A step of tables is
/// exact and done at once, so the number of updates only says whether it is taken.
///
/// ```
/// use tltl::compose::Compose as _;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let (left, right) = (tltl! { |s: &usize| F ({ *s } == 0) }, tltl! { |s: &usize| F ({ *s } == 4) });
/// let (world, rewards) = (Dynamics::new(&row)?, Rewards::default());
/// let one = Problem::new(&world, &Labelled::of_model(&row, &left)?)?.optimal_q(&rewards);
/// let two = Problem::new(&world, &Labelled::of_model(&row, &right)?)?.optimal_q(&rewards);
/// let product = Product::conjunction(&[&left, &right]);
/// let task = Labelled::of_model(&row, &product)?;
/// let composition = Composition::new(&product, &task, &[&one, &two], rewards)?;
/// let mut steps = composition.on(&world, Combine::Sum)?;
/// let sum = steps.q().max(0, 2);
/// steps.compensate(1)?;
/// steps.refine(1)?;
/// // The sum pays for the end of each skill, the product once.
/// assert!(sum > 1.9 && (steps.q().max(0, 2) - 1.0).abs() < 0.01);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stepwise<'a> {
    composition: Composition<'a>,
    problem: Problem,
    q: QTable,
}

impl Stepwise<'_> {
    /// The values so far.
    #[must_use]
    #[inline]
    pub const fn q(&self) -> &QTable {
        &self.q
    }
}

impl Compose for Stepwise<'_> {
    type State = usize;
    type Action = usize;
    type Error = Infallible;

    #[inline]
    fn compensate(&mut self, updates: u64) -> Result<(), Infallible> {
        if updates > 0 {
            self.q = self.composition.compensated_on(&self.problem, &self.q);
        }
        Ok(())
    }

    #[inline]
    fn refine(&mut self, updates: u64) -> Result<(), Infallible> {
        if updates > 0 {
            self.q = self.composition.refined_on(&self.problem, &self.q);
        }
        Ok(())
    }

    #[inline]
    fn act(&self, q: u32, &s: &usize) -> Result<usize, Infallible> {
        Ok(self.q.greedy(q, s))
    }
}

/// Skills that are to be composed: action values, each for its own task on the same world.
///
/// ```
/// use tltl::model;
/// use tltl::prelude::*;
///
/// // Five cells in a row: action 0 goes left, action 1 right. Two skills: reach an end each.
/// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
/// let left = tltl! { |s: &usize| F ({ *s } == 0) };
/// let right = tltl! { |s: &usize| F ({ *s } == 4) };
/// let (world, rewards) = (Dynamics::new(&row)?, Rewards::default());
/// let one = Problem::new(&world, &Labelled::of_model(&row, &left)?)?.optimal_q(&rewards);
/// let two = Problem::new(&world, &Labelled::of_model(&row, &right)?)?.optimal_q(&rewards);
///
/// // Both, by what the skills have learned alone.
/// let product = Product::conjunction(&[&left, &right]);
/// let task = Labelled::of_model(&row, &product)?;
/// let composition = Composition::new(&product, &task, &[&one, &two], rewards)?;
/// let refined = composition.refined(&world, &composition.initial(Combine::Sum))?;
/// let certificate = Problem::new(&world, &task)?.optimum(&rewards).certify(&refined.policy())?;
/// assert_eq!(certificate.regret_steps, Some(0.0));
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Composition<'a> {
    skills: Vec<&'a QTable>,
    task: Labelled,
    rewards: Rewards,
    operator: Operator,
    /// The skills' states at each state of the product, one after the other.
    components: Vec<u32>,
    running: Vec<usize>,
}

impl<'a> Composition<'a> {
    /// The composition of `skills`, in the order of the operands of `product`; `task` is the
    /// product on the world, and `rewards` are those that the skills' values are for.
    ///
    /// # Errors
    /// If the skills, the product and the world do not fit together.
    pub fn new<S: ?Sized>(
        product: &Product<'_, S>,
        task: &Labelled,
        skills: &[&'a QTable],
        rewards: Rewards,
    ) -> Result<Self, Mismatch> {
        let operands = product.operands();
        let of_product = |states| alloc::format!("a product with {states} automaton states");
        if product.states() != task.automaton_states() {
            let found = of_product(product.states());
            return Err(Mismatch::new("a composition", found, task.describe()));
        }
        if skills.len() != operands.len() {
            let count = |n| alloc::format!("{n} tasks");
            let (found, expected) = (count(skills.len()), count(operands.len()));
            return Err(Mismatch::new("a composition", found, expected));
        }
        for (skill, operand) in skills.iter().zip(operands) {
            let own = skill.task();
            task.check_world("a skill", own.states(), own.actions())?;
            if own.automaton_states() != operand.states() {
                let (name, states) = (operand.name(), operand.states());
                let expected = alloc::format!("`{name}` ({states} automaton states)");
                return Err(Mismatch::new("a skill", own.describe(), expected));
            }
        }
        let states = 0..task.automaton_states();
        Ok(Self {
            skills: skills.to_vec(),
            task: task.clone(),
            rewards,
            operator: product.operator(),
            components: states.clone().flat_map(|q| product.components(q)).copied().collect(),
            running: states.map(|q| product.running(q)).collect(),
        })
    }

    /// The composition of `skills` from their tables alone: their product is found among the states of
    /// the world, and never made as an automaton. So skills compose whose tasks are
    /// [factored](Labelled::of_factored), come from a file, or have a product that is too large to be
    /// written down. `rewards` are those that the skills' values are for.
    ///
    /// States of the product are numbered as the world reaches them, at most `budget`; see
    /// [`Labelled::of_factored`].
    ///
    /// ```
    /// use tltl::compose::Operator;
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// // Eight cells in a row. Two skills, each of three goals that it reaches in any order.
    /// let row = model::from_fn(8, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(7)][a], 1.0)]);
    /// let left = tltl! { #[factored] |s: &usize| F ({ *s } == 0) && F ({ *s } == 1) && F ({ *s } == 2) };
    /// let right = tltl! { #[factored] |s: &usize| F ({ *s } == 5) && F ({ *s } == 6) && F ({ *s } == 7) };
    /// let (world, rewards) = (Dynamics::new(&row)?, Rewards::acceptance());
    /// let left = Labelled::of_factored(0..8, ["left", "right"], &left, 100)?;
    /// let right = Labelled::of_factored(0..8, ["left", "right"], &right, 100)?;
    /// let one = Problem::new(&world, &left)?.optimal_q(&rewards);
    /// let two = Problem::new(&world, &right)?.optimal_q(&rewards);
    ///
    /// let both = Composition::of(Operator::Conjunction, &[&one, &two], rewards, 1_000)?;
    /// let steps = both.run(&world, Combine::Sum)?;
    /// assert_eq!(steps.best().certificate.regret_steps, Some(0.0));
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the skills are of different worlds, or there are more than `budget` states.
    ///
    /// # Panics
    /// If there are no skills.
    #[track_caller]
    #[inline]
    pub fn of(
        operator: Operator,
        skills: &[&'a QTable],
        rewards: Rewards,
        budget: usize,
    ) -> Result<Self, LabelError> {
        assert!(!skills.is_empty(), "a composition needs skills");
        let parts: Vec<Labelled> = skills.iter().map(|skill| skill.task().clone()).collect();
        for part in &parts {
            parts[0].check_world("a skill", part.states(), part.actions())?;
        }
        let names: Vec<&str> = parts.iter().map(Labelled::name).collect();
        let formulas = parts.iter().map(|part| alloc::format!("({})", part.formula()));
        let formulas: Vec<String> = formulas.collect();
        let named = (names.join(operator.symbol()), formulas.join(operator.symbol()));
        let Joint { task, components, running } = Joint::new(operator, &parts, named, budget)?;
        Ok(Self { skills: skills.to_vec(), task, rewards, operator, components, running })
    }

    /// The task of the composition, on its world.
    #[must_use]
    #[inline]
    pub const fn task(&self) -> &Labelled {
        &self.task
    }

    /// The composition, carried out step by step on `dynamics`.
    ///
    /// # Errors
    /// If they are of another world.
    #[inline]
    pub fn on(self, dynamics: &Dynamics, combine: Combine) -> Result<Stepwise<'a>, Mismatch> {
        let (q, problem) = (self.initial(combine), Problem::new(dynamics, &self.task)?);
        Ok(Stepwise { composition: self, problem, q })
    }

    /// Step 2: the skills' values at their components of each product state. In a sequence only
    /// the running skill counts.
    #[must_use]
    #[inline]
    pub fn initial(&self, combine: Combine) -> QTable {
        let tops = self.skills.iter().map(|skill| largest(skill.values()));
        let scales: Vec<f64> = tops.map(|top| if top > 0.0 { 1.0 / top } else { 1.0 }).collect();
        let mut table = QTable::zeros(&self.task);
        for (q, s, row) in table.rows_mut() {
            if self.task.end(q).is_some() {
                continue;
            }
            for (a, value) in row.iter_mut().enumerate() {
                let values = self.active(q).map(|(i, at)| {
                    let scale = if combine == Combine::Sum { 1.0 } else { scales[i] };
                    scale * self.skills[i].row(at, s)[a]
                });
                *value = match combine {
                    Combine::Max => values.fold(f64::NEG_INFINITY, f64::max),
                    Combine::Sum | Combine::NormalisedSum => values.sum(),
                };
            }
        }
        table
    }

    /// Steps 3–5: the values, in the product, of the policy that is greedy in the plain sum. They are the
    /// sum less what it counts too much, all values being of that one policy (Eq. 3C8), and their greedy
    /// policy is worth at least as much as the sum's, for the rewards and from every pair.
    ///
    /// ```
    /// use tltl::model;
    /// use tltl::prelude::*;
    ///
    /// let row = model::from_fn(5, 2, |s, a| [([s.saturating_sub(1), (s + 1).min(4)][a], 1.0)]);
    /// // The mail and the coffee are in the same cell.
    /// let (mail, coffee) = (tltl! { |s: &usize| F ({ *s } == 0) }, tltl! { |s: &usize| F ({ *s } == 0) });
    /// let (world, rewards) = (Dynamics::new(&row)?, Rewards::default());
    /// let one = Problem::new(&world, &Labelled::of_model(&row, &mail)?)?.optimal_q(&rewards);
    /// let two = Problem::new(&world, &Labelled::of_model(&row, &coffee)?)?.optimal_q(&rewards);
    /// let product = Product::conjunction(&[&mail, &coffee]);
    /// let task = Labelled::of_model(&row, &product)?;
    /// let composition = Composition::new(&product, &task, &[&one, &two], rewards)?;
    /// // One step is progress of both, which the product pays once.
    /// let (sum, exact) = (composition.initial(Combine::Sum), composition.compensated(&world)?);
    /// assert!((sum.max(0, 1) - 2.0).abs() < 1e-9 && (exact.max(0, 1) - 1.0).abs() < 1e-9);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If `dynamics` is of another world.
    #[inline]
    pub fn compensated(&self, dynamics: &Dynamics) -> Result<QTable, Mismatch> {
        let problem = Problem::new(dynamics, &self.task)?;
        Ok(self.compensated_on(&problem, &self.initial(Combine::Sum)))
    }

    #[inline]
    fn compensated_on(&self, problem: &Problem, start: &QTable) -> QTable {
        let payment = self.task.payment(&self.rewards);
        problem.policy_q(&payment, self.rewards.gamma(), &start.policy())
    }

    /// Step 6: the optimal values of the product on `dynamics`, starting from `start`.
    ///
    /// Where acceptance alone is paid, they are finished as those of a learner are
    /// ([`Learner::q`](crate::learn::Learner::q)): the largest P(satisfied), up to a tolerance, and then the
    /// fewest steps, whatever γ is.
    ///
    /// # Errors
    /// If `dynamics` is of another world, or `start` of another task.
    #[inline]
    pub fn refined(&self, dynamics: &Dynamics, start: &QTable) -> Result<QTable, Mismatch> {
        self.task.check("a table", start.task())?;
        Ok(self.refined_on(&Problem::new(dynamics, &self.task)?, start))
    }

    #[inline]
    fn refined_on(&self, problem: &Problem, start: &QTable) -> QTable {
        if self.rewards.pays_acceptance_alone() {
            return problem.finished(&self.rewards);
        }
        let payment = self.task.payment(&self.rewards);
        problem.optimal_q_of(&payment, self.rewards.gamma(), start)
    }

    /// The skills that read states at `q`, and where they are.
    #[inline]
    fn active(&self, q: u32) -> impl Iterator<Item = (usize, u32)> {
        let running = self.running[q as usize];
        let only = self.operator == Operator::Sequence;
        let n = self.skills.len();
        let all = self.components[q as usize * n..][..n].iter().copied().enumerate();
        all.filter(move |&(i, _)| !only || i == running)
    }
}
