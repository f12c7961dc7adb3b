//! Composition of learned skills (paper, Algorithm 2), without a step in the world.
//!
//! Skills are action values over the same world, each for its own task; a [`Product`] of the
//! tasks says what they are to do together.
//!
//! - Step 2, [`Composition::initial`]: sum (or maximum) of the skills' values. For two *optimal*
//!   tables the sum is only a start: on the paper's grid its greedy policy is optimal in 91.96 % of
//!   the pairs and in 81.25 % of those where both skills are pending.
//! - Steps 3–5, [`Composition::compensated`]: what the sum counts too much is subtracted: steps
//!   that pay several skills but the product once, and (which the paper leaves out) steps that pay
//!   one skill while another is lost. Eq. 3C8 is exact for one fixed policy without traps; here
//!   it is that of the sum's greedy policy.
//! - Step 6, [`Composition::refined`]: off-policy updates until nothing changes, which is the
//!   optimum of the product. "Replay" is [`Dynamics`]: of the model, and then it is exact, or of
//!   the remembered [`Experience`](crate::learn::Experience), relabelled with every automaton
//!   state.
//!
//! All values are *flat* (they bootstrap at q'), never sub-policy values.
//!
//! Networks are composed in `deep`; [`Compose`] is what the two have in common.

use alloc::vec::Vec;
use core::convert::Infallible;

use crate::augmented::{Labelled, Payment};
use crate::mismatch::Mismatch;
use crate::model::Dynamics;
use crate::monitor::Acceptor as _;
use crate::product::{Operator, Product};
use crate::q::{QTable, largest};
use crate::reward::Rewards;
use crate::solve::Problem;

/// How the skills' values are combined.
///
/// Where skills are scaled differently (one pays once, another twice on its way) the plain sum
/// listens to the one with more to gain; [`Self::NormalisedSum`] listens to both alike. Only the plain
/// sum can be compensated, for Eq. 3C8 is about values as they are.
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
/// ([`Composition::on`]) or networks (`deep::Composition`). It begins at step 2.
///
/// A study that compares the steps is so written once for both:
///
/// ```
/// use tltl::compose::Compose;
/// use tltl::model;
/// use tltl::prelude::*;
///
/// /// What is done first, after step 2 and after step 6.
/// fn first<C: Compose>(mut skills: C, q: u32, s: &C::State) -> Result<[usize; 2], C::Error> {
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
    /// Why a step can fail.
    type Error;

    /// Steps 3–5, by so many updates; tables need one, of everything.
    ///
    /// # Errors
    /// If a value is not a finite number.
    ///
    /// # Panics
    /// Unless the skills are combined by [`Combine::Sum`].
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
    fn act(&self, q: u32, s: &Self::State) -> Result<usize, Self::Error>;
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
/// let exact = Problem::new(&world, &task)?.optimal_q(&rewards).max(0, 2);
/// // The sum takes the second way to start where the first one does.
/// assert!(sum > exact + 0.01 && (steps.q().max(0, 2) - exact).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stepwise<'a> {
    composition: Composition<'a>,
    problem: Problem,
    combine: Combine,
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
    type Error = Infallible;

    #[track_caller]
    #[inline]
    fn compensate(&mut self, updates: u64) -> Result<(), Infallible> {
        assert_eq!(self.combine, Combine::Sum, "compensation is of the plain sum");
        if updates > 0 {
            self.q = self.composition.compensated_on(&self.problem);
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
    /// For each state of the product the skills' states.
    components: Vec<&'a [u32]>,
    running: Vec<usize>,
}

impl<'a> Composition<'a> {
    /// The composition of `skills`, in the order of the operands of `product`; `task` is the
    /// product on the world, and `rewards` are those that the skills' values are for.
    ///
    /// # Errors
    /// If the skills, the product and the world do not fit together.
    pub fn new<S: ?Sized>(
        product: &'a Product<'_, S>,
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
            components: states.clone().map(|q| product.components(q)).collect(),
            running: states.map(|q| product.running(q)).collect(),
        })
    }

    /// The composition, carried out step by step on `dynamics`.
    ///
    /// # Errors
    /// If they are of another world.
    #[inline]
    pub fn on(self, dynamics: &Dynamics, combine: Combine) -> Result<Stepwise<'a>, Mismatch> {
        let (q, problem) = (self.initial(combine), Problem::new(dynamics, &self.task)?);
        Ok(Stepwise { composition: self, problem, combine, q })
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

    /// Steps 3–5: the plain sum less the compensation Q_{1∧2} of Eq. 3C10, trap-aware.
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
        Ok(self.compensated_on(&Problem::new(dynamics, &self.task)?))
    }

    #[inline]
    fn compensated_on(&self, problem: &Problem) -> QTable {
        let mut sum = self.initial(Combine::Sum);
        let compensation = problem.policy_q(&self.excess(), self.rewards.gamma(), &sum.policy());
        for (q, s, row) in sum.rows_mut() {
            row.iter_mut().zip(compensation.row(q, s)).for_each(|(value, c)| *value -= c);
        }
        sum
    }

    /// Step 6: the optimal values of the product on `dynamics`, starting from `start`.
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
        let payment = self.task.payment(&self.rewards);
        problem.optimal_q_of(&payment, self.rewards.gamma(), Some(start))
    }

    /// The skills that read states at `q`, and where they are.
    #[inline]
    fn active(&self, q: u32) -> impl Iterator<Item = (usize, u32)> {
        let running = self.running[q as usize];
        let only = self.operator == Operator::Sequence;
        let all = self.components[q as usize].iter().copied().enumerate();
        all.filter(move |&(i, _)| !only || i == running)
    }

    /// What the skills are paid together beyond what the product pays.
    ///
    /// It is what Q_{1∧2} discounts: positive where one step is a step of several skills, and where one
    /// skill moves on while another is lost.
    #[inline]
    fn excess(&self) -> Payment {
        let pay = |skill: &&QTable| skill.task().payment(&self.rewards);
        let payments: Vec<Payment> = self.skills.iter().map(pay).collect();
        let whole = self.task.payment(&self.rewards);
        self.task.payment_by_state(&|q, s| {
            if self.task.end(q).is_some() {
                return 0.0;
            }
            let paid = self.active(q).map(|(i, at)| {
                let task = self.skills[i].task();
                let class = task.tables().class[s];
                // A skill that is done, or lost, is paid nothing more.
                if task.end(at).is_some() { 0.0 } else { payments[i].get(at, s, class) }
            });
            paid.sum::<f64>() - whole.get(q, s, self.task.tables().class[s])
        })
    }
}
