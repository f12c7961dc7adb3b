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

use crate::augmented::{Labelled, Payment, Rewards};
use crate::model::Dynamics;
use crate::product::{Operator, Product};
use crate::q::{QTable, largest};
use crate::solve::Problem;

/// A skill: flat action values, and the task that they are for.
#[derive(Clone, Copy, Debug)]
pub struct Skill<'a> {
    /// The values.
    pub q: &'a QTable,
    /// The task on the world.
    pub task: &'a Labelled,
}

/// How the skills' values are combined.
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
#[derive(Clone, Debug)]
pub struct Stepwise<'a> {
    composition: Composition<'a>,
    dynamics: &'a Dynamics,
    rewards: Rewards,
    gamma: f64,
    combine: Combine,
    q: QTable,
}

impl Stepwise<'_> {
    /// The values so far.
    #[must_use]
    pub const fn q(&self) -> &QTable {
        &self.q
    }
}

impl Compose for Stepwise<'_> {
    type State = usize;
    type Error = Infallible;

    fn compensate(&mut self, updates: u64) -> Result<(), Infallible> {
        assert_eq!(self.combine, Combine::Sum, "compensation is of the plain sum");
        if updates > 0 {
            self.q = self.composition.compensated(self.dynamics, &self.rewards, self.gamma);
        }
        Ok(())
    }

    fn refine(&mut self, updates: u64) -> Result<(), Infallible> {
        if updates > 0 {
            let Self { composition, dynamics, rewards, gamma, q, .. } = self;
            *q = composition.refined(dynamics, rewards, *gamma, q);
        }
        Ok(())
    }

    fn act(&self, q: u32, &s: &usize) -> Result<usize, Infallible> {
        Ok(self.q.greedy(q, s) as usize)
    }
}

/// Skills that are to be composed.
#[derive(Clone, Debug)]
pub struct Composition<'a> {
    skills: Vec<Skill<'a>>,
    task: &'a Labelled,
    operator: Operator,
    /// For each state of the product the skills' states.
    components: Vec<&'a [u32]>,
    running: Vec<usize>,
}

impl<'a> Composition<'a> {
    /// The composition of `skills`, in the order of the operands of `product`; `task` is the
    /// product on the world.
    ///
    /// # Panics
    /// If the skills, the product and the world do not fit together.
    #[must_use]
    pub fn new<S: ?Sized>(
        product: &'a Product<'_, S>,
        task: &'a Labelled,
        skills: &[Skill<'a>],
    ) -> Self {
        assert_eq!(skills.len(), product.operands().len(), "a skill for each operand");
        for (skill, operand) in skills.iter().zip(product.operands()) {
            assert_eq!(skill.q.automaton_states(), operand.states(), "a skill for its operand");
            assert_eq!(skill.q.states(), task.states(), "skills in the same world");
            assert_eq!(skill.q.actions(), skills[0].q.actions(), "skills with the same actions");
        }
        let states = 0..task.automaton_states();
        Self {
            skills: skills.to_vec(),
            task,
            operator: product.operator(),
            components: states.clone().map(|q| product.components(q)).collect(),
            running: states.map(|q| product.running(q)).collect(),
        }
    }

    /// The composition, carried out step by step on `dynamics`.
    ///
    /// # Panics
    /// In its steps, as [`Self::compensated`].
    #[must_use]
    pub fn on(
        self,
        dynamics: &'a Dynamics,
        rewards: Rewards,
        gamma: f64,
        combine: Combine,
    ) -> Stepwise<'a> {
        let q = self.initial(combine);
        Stepwise { composition: self, dynamics, rewards, gamma, combine, q }
    }

    /// Step 2: the skills' values at their components of each product state. In a sequence only
    /// the running skill counts.
    #[must_use]
    pub fn initial(&self, combine: Combine) -> QTable {
        let tops = self.skills.iter().map(|skill| largest(skill.q.values()));
        let scales: Vec<f64> = tops.map(|top| if top > 0.0 { 1.0 / top } else { 1.0 }).collect();
        let mut table = QTable::zeros(self.task, self.skills[0].q.actions());
        for (q, s, row) in table.rows_mut() {
            if self.task.end(q).is_some() {
                continue;
            }
            for (a, value) in row.iter_mut().enumerate() {
                let values = self.active(q).map(|(i, at)| {
                    let scale = if combine == Combine::Sum { 1.0 } else { scales[i] };
                    scale * self.skills[i].q.row(at, s)[a]
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
    /// # Panics
    /// Unless 0 ≤ `gamma` < 1, or if `dynamics` is of another world.
    #[must_use]
    pub fn compensated(&self, dynamics: &Dynamics, rewards: &Rewards, gamma: f64) -> QTable {
        let mut sum = self.initial(Combine::Sum);
        let excess = self.excess(rewards, gamma);
        let problem = Problem::new(dynamics, self.task);
        let compensation = problem.policy_q(&excess, gamma, &sum.policy());
        for (q, s, row) in sum.rows_mut() {
            row.iter_mut().zip(compensation.row(q, s)).for_each(|(value, c)| *value -= c);
        }
        sum
    }

    /// Step 6: the optimal values of the product on `dynamics`, starting from `start`.
    ///
    /// # Panics
    /// As [`Self::compensated`].
    #[must_use]
    pub fn refined(
        &self,
        dynamics: &Dynamics,
        rewards: &Rewards,
        gamma: f64,
        start: &QTable,
    ) -> QTable {
        let payment = self.task.payment(rewards, gamma);
        Problem::new(dynamics, self.task).optimal_q_of(&payment, gamma, Some(start))
    }

    /// The skills that read states at `q`, and where they are.
    fn active(&self, q: u32) -> impl Iterator<Item = (usize, u32)> {
        let running = self.running[q as usize];
        let only = self.operator == Operator::Sequence;
        let all = self.components[q as usize].iter().copied().enumerate();
        all.filter(move |&(i, _)| !only || i == running)
    }

    /// What the skills are paid together beyond what the product pays.
    fn excess(&self, rewards: &Rewards, gamma: f64) -> Payment {
        let pay = |skill: &Skill<'_>| skill.task.payment(rewards, gamma);
        let payments: Vec<Payment> = self.skills.iter().map(pay).collect();
        let whole = self.task.payment(rewards, gamma);
        self.task.payment_by_state(&|q, s| {
            if self.task.end(q).is_some() {
                return 0.0;
            }
            let paid = self.active(q).map(|(i, at)| {
                let task = self.skills[i].task;
                if task.end(at).is_some() { 0.0 } else { payments[i].get(at, s, task.class()[s]) }
            });
            paid.sum::<f64>() - whole.get(q, s, self.task.class()[s])
        })
    }
}
