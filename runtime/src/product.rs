//! The product of tasks at run time (paper, Definition 4), itself a [`Monitor`].
//!
//! Composition of learned skills needs to know the components, so the states are the *raw*
//! reachable tuples: not minimised, except that all tuples that lose the product are one trap and
//! all that accept it are one state. The tasks are treated as independent (an edge of the product
//! for every combination of edges), which is sound and at worst larger; the compiler's product of
//! formulas is the minimal one.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt;

use crate::monitor::{Acceptor, Monitor};
use crate::robustness;
use crate::shared::Shared;
use crate::task::{Error, Formula};

/// An operand of a product.
pub type Operand<'a, S> = &'a (dyn Monitor<S> + Sync + 'a);

/// How the operands make one task.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// All of them.
    Conjunction,
    /// One of them.
    Disjunction,
    /// One after the other: when the shortest prefix that satisfies the first ends at s_k, the
    /// rest is judged on the trajectory from s_{k+1} on. Of `F a` and `F b` it is `a T b`. (Not
    /// `(F a) T (F b)`, which lets a come after b: `T` asks when a formula *holds*, this when it is
    /// *done*.) What running one skill until it is done, then the next, amounts to.
    Sequence,
}

impl Operator {
    /// What stands between two operands; `;` is what programs write between two steps.
    const fn symbol(self) -> &'static str {
        match self {
            Self::Conjunction => " && ",
            Self::Disjunction => " || ",
            Self::Sequence => "; ",
        }
    }
}

/// A state of the product: the operands' states, and for a sequence which of them is running.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Key {
    running: usize,
    code: u128,
}

/// Where a move of the product leads.
enum Move {
    Accepted,
    Lost,
    To(usize),
}

/// A product of any number of tasks over the same states.
///
/// States are numbered breadth-first from the initial one, 0.
pub struct Product<'a, S: ?Sized> {
    operator: Operator,
    name: String,
    formula: Formula,
    operands: Vec<Operand<'a, S>>,
    strides: Vec<u128>,
    index: BTreeMap<Key, u32>,
    keys: Vec<Key>,
    components: Vec<u32>,
    first: Vec<u32>,
    successors: Vec<u32>,
    distance: Vec<Option<u32>>,
    accepting: Option<u32>,
    trap: Option<u32>,
}

impl<S: ?Sized> fmt::Debug for Product<'_, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut product = f.debug_struct("Product");
        product.field("operator", &self.operator).field("name", &self.name);
        product.field("states", &self.keys.len()).finish_non_exhaustive()
    }
}

impl<'a, S: ?Sized> Product<'a, S> {
    /// The task of satisfying all `operands`.
    ///
    /// # Panics
    /// If there are no operands, or their state counts multiply to more than 2^128.
    #[must_use]
    pub fn conjunction(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Conjunction, operands)
    }

    /// The task of satisfying one of `operands`.
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn disjunction(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Disjunction, operands)
    }

    /// The task of satisfying `operands` one after the other; see [`Operator::Sequence`].
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn sequence(operands: &[Operand<'a, S>]) -> Self {
        Self::new(Operator::Sequence, operands)
    }

    /// The product of `operands` under `operator`.
    ///
    /// # Panics
    /// As [`Self::conjunction`].
    #[must_use]
    pub fn new(operator: Operator, operands: &[Operand<'a, S>]) -> Self {
        assert!(!operands.is_empty(), "a product needs operands");
        let names: Vec<_> = operands.iter().map(|operand| operand.name()).collect();
        let texts = operands.iter().map(|operand| format!("({})", operand.formula().text()));
        let text = texts.collect::<Vec<_>>().join(operator.symbol());
        let mut product = Self {
            operator,
            name: names.join(operator.symbol()),
            formula: Formula::trusted(text.into(), Shared::from_static(&[])),
            operands: operands.to_vec(),
            strides: strides(operands),
            index: BTreeMap::new(),
            keys: Vec::new(),
            components: Vec::new(),
            first: alloc::vec![0],
            successors: Vec::new(),
            distance: Vec::new(),
            accepting: None,
            trap: None,
        };
        product.explore();
        product.distance = product.distances();
        product
    }

    /// How the operands make one task.
    #[must_use]
    pub const fn operator(&self) -> Operator {
        self.operator
    }

    /// The operands.
    #[must_use]
    pub fn operands(&self) -> &[Operand<'a, S>] {
        &self.operands
    }

    /// The state of each operand at `q`; for the accepting state and the trap, those by which it
    /// was met first. An operand of a sequence that does not run yet is in its state 0.
    #[must_use]
    pub fn components(&self, q: u32) -> &[u32] {
        let n = self.operands.len();
        &self.components[q as usize * n..][..n]
    }

    /// Which operand of a sequence runs at `q`; 0 for the other operators.
    #[must_use]
    pub fn running(&self, q: u32) -> usize {
        self.keys[q as usize].running
    }

    /// The targets of the edges that leave `q`, self-loop included, ascending.
    #[must_use]
    pub fn edges(&self, q: u32) -> &[u32] {
        &self.successors[self.first[q as usize] as usize..self.first[q as usize + 1] as usize]
    }

    /// The number of edges, counted as distinct pairs of states, under both usual conventions:
    /// with self-loops or not, with the trap or not.
    #[must_use]
    pub fn edge_count(&self, self_loops: bool, trap: bool) -> usize {
        let counts = |q: u32, to: u32| {
            (self_loops || q != to) && (trap || self.trap != Some(q) && self.trap != Some(to))
        };
        let states = 0..self.keys.len() as u32;
        states.map(|q| self.edges(q).iter().filter(|&&to| counts(q, to)).count()).sum()
    }

    /// The number of states that are not the trap.
    #[must_use]
    pub fn live_or_accepting(&self) -> usize {
        self.keys.len() - usize::from(self.trap.is_some())
    }

    /// Visits the reachable tuples breadth-first and lists their edges.
    fn explore(&mut self) {
        let start = self.judge(&alloc::vec![0; self.operands.len()], None);
        self.number(Key { running: 0, code: 0 }, &alloc::vec![0; self.operands.len()]);
        match start {
            Move::Accepted => self.accepting = Some(0),
            Move::Lost => self.trap = Some(0),
            Move::To(_) => {}
        }
        let mut q = 0;
        while q < self.keys.len() {
            let mut targets = self.targets(q as u32);
            targets.sort_unstable();
            targets.dedup();
            self.successors.extend(targets);
            self.first.push(self.successors.len() as u32);
            q += 1;
        }
    }

    /// The targets of all combinations of the operands' edges from `q`.
    fn targets(&mut self, q: u32) -> Vec<u32> {
        if self.is_end(q) {
            return alloc::vec![q];
        }
        let running = self.keys[q as usize].running;
        let mut tuples = alloc::vec![Vec::new()];
        for (i, &at) in self.components(q).iter().enumerate() {
            let mut edges = Vec::new();
            if self.moves(i, running) {
                self.operands[i].successors(at, &mut |to| edges.push(to));
            } else {
                edges.push(at);
            }
            tuples = combinations(&tuples, &edges);
        }
        tuples.into_iter().map(|tuple| self.state(tuple, running)).collect()
    }

    /// The number of the state that the operands' states make, found or new.
    fn state(&mut self, tuple: Vec<u32>, running: usize) -> u32 {
        let code = self.code(&tuple);
        match self.judge(&tuple, Some(running)) {
            Move::To(running) => self.number(Key { running, code }, &tuple),
            Move::Accepted => self.accepting.unwrap_or_else(|| {
                let q = self.number(Key { running: usize::MAX, code }, &tuple);
                *self.accepting.insert(q)
            }),
            Move::Lost => self.trap.unwrap_or_else(|| {
                let q = self.number(Key { running: usize::MAX, code }, &tuple);
                *self.trap.insert(q)
            }),
        }
    }

    fn number(&mut self, key: Key, tuple: &[u32]) -> u32 {
        let next = self.keys.len() as u32;
        let q = *self.index.entry(key).or_insert(next);
        if q == next {
            self.keys.push(key);
            self.components.extend_from_slice(tuple);
        }
        q
    }

    fn code(&self, tuple: &[u32]) -> u128 {
        tuple.iter().zip(&self.strides).map(|(&q, stride)| u128::from(q) * stride).sum()
    }

    /// Whether operand `i` reads states while `running` runs.
    fn moves(&self, i: usize, running: usize) -> bool {
        self.operator != Operator::Sequence || i == running
    }

    /// What the product makes of the operands' states. `running` is the operand of a sequence that
    /// has just moved, `None` before the first state is read.
    fn judge(&self, tuple: &[u32], running: Option<usize>) -> Move {
        let accepting = |i: usize| self.operands[i].is_accepting(tuple[i]);
        let lost = |i: usize| self.operands[i].is_trap(tuple[i]);
        let mut all = 0..tuple.len();
        match self.operator {
            Operator::Conjunction if all.clone().any(lost) => Move::Lost,
            Operator::Conjunction if all.all(accepting) => Move::Accepted,
            Operator::Disjunction if all.clone().any(accepting) => Move::Accepted,
            Operator::Disjunction if all.all(lost) => Move::Lost,
            Operator::Sequence => match running {
                None if all.len() == 1 && accepting(0) => Move::Accepted,
                _ if all.any(lost) => Move::Lost,
                Some(i) if accepting(i) && i + 1 == tuple.len() => Move::Accepted,
                Some(i) => Move::To(i + usize::from(accepting(i))),
                None => Move::To(0),
            },
            _ => Move::To(0),
        }
    }

    fn is_end(&self, q: u32) -> bool {
        self.accepting == Some(q) || self.trap == Some(q)
    }

    /// The least number of moves to the accepting state, for all states.
    fn distances(&self) -> Vec<Option<u32>> {
        let mut distance = alloc::vec![None; self.keys.len()];
        let Some(accepting) = self.accepting else { return distance };
        distance[accepting as usize] = Some(0);
        let mut changed = true;
        while changed {
            changed = false;
            for q in (0..self.keys.len()).rev() {
                let next = self.edges(q as u32).iter().filter_map(|&to| distance[to as usize]);
                let through = next.min().map(|nearest| nearest + 1);
                if through.is_some() && distance[q].is_none_or(|known| through < Some(known)) {
                    (distance[q], changed) = (through, true);
                }
            }
        }
        distance
    }

    /// Robustness of losing operand `i` at `s`, ρ(s, τ_i); +∞ if it is lost already.
    fn losing(&self, i: usize, q: u32, s: &S) -> Result<f64, Error> {
        let at = self.components(q)[i];
        let operand = self.operands[i];
        if operand.is_trap(at) { Ok(f64::INFINITY) } else { operand.trap_robustness(at, s) }
    }

    /// Robustness of losing each operand.
    fn losses(&self, q: u32, s: &S) -> impl Iterator<Item = Result<f64, Error>> {
        (0..self.operands.len()).map(move |i| self.losing(i, q, s))
    }

    /// Robustness of progress of each operand.
    fn progresses(&self, q: u32, s: &S) -> impl Iterator<Item = Result<f64, Error>> {
        let operands = self.operands.iter().zip(self.components(q));
        operands.map(move |(operand, &at)| operand.progress_robustness(at, s))
    }

    /// Robustness of progress of a disjunction: an operand moves on, or it is lost while another is
    /// not.
    fn progress_of_any(&self, q: u32, s: &S) -> Result<f64, Error> {
        let mut best = f64::NEG_INFINITY;
        for (i, progress) in self.progresses(q, s).enumerate() {
            // To be lost already is not a move.
            if !self.operands[i].is_trap(self.components(q)[i]) {
                let lost = self.losing(i, q, s)?.min(self.other_alive(i, q, s)?);
                best = best.max(progress?.max(lost));
            }
        }
        Ok(best)
    }

    /// Greatest of −ρ(s, τ_j) over the operands other than `i`: one of them is not lost.
    fn other_alive(&self, i: usize, q: u32, s: &S) -> Result<f64, Error> {
        let mut losses = self.losses(q, s).enumerate().filter(|(j, _)| *j != i);
        losses.try_fold(f64::NEG_INFINITY, |greatest, (_, lost)| Ok(greatest.max(-lost?)))
    }
}

/// Every tuple of `tuples` continued by every one of `edges`.
fn combinations(tuples: &[Vec<u32>], edges: &[u32]) -> Vec<Vec<u32>> {
    let mut longer = Vec::with_capacity(tuples.len() * edges.len());
    for tuple in tuples {
        for &to in edges {
            let mut tuple = tuple.clone();
            tuple.push(to);
            longer.push(tuple);
        }
    }
    longer
}

fn strides<S: ?Sized>(operands: &[Operand<'_, S>]) -> Vec<u128> {
    let mut stride: u128 = 1;
    let mut next = |operand: &Operand<'_, S>| {
        let this = stride;
        let states = u128::from(operand.states());
        stride = stride.checked_mul(states).expect("fewer than 2^128 tuples of states");
        this
    };
    operands.iter().map(&mut next).collect()
}

impl<S: ?Sized> Acceptor for Product<'_, S> {
    fn states(&self) -> u32 {
        self.keys.len() as u32
    }

    fn is_accepting(&self, q: u32) -> bool {
        self.accepting == Some(q)
    }

    fn is_trap(&self, q: u32) -> bool {
        self.trap == Some(q)
    }

    fn distance(&self, q: u32) -> Option<u32> {
        self.distance[q as usize]
    }

    fn successors(&self, q: u32, visit: &mut dyn FnMut(u32)) {
        self.edges(q).iter().for_each(|&to| visit(to));
    }

    fn name(&self) -> &str {
        &self.name
    }

    fn formula(&self) -> &Formula {
        &self.formula
    }
}

impl<S: ?Sized> Monitor<S> for Product<'_, S> {
    fn next(&self, q: u32, s: &S) -> Result<u32, Error> {
        if self.is_end(q) {
            return Ok(q);
        }
        let running = self.keys[q as usize].running;
        let mut tuple = self.components(q).to_vec();
        for (i, at) in tuple.iter_mut().enumerate() {
            if self.moves(i, running) {
                *at = self.operands[i].next(*at, s)?;
            }
        }
        Ok(match self.judge(&tuple, Some(running)) {
            Move::To(running) => self.index[&Key { running, code: self.code(&tuple) }],
            Move::Accepted => self.accepting.expect("acceptance was reachable"),
            Move::Lost => self.trap.expect("the trap was reachable"),
        })
    }

    /// For a conjunction (D₁ ∧ ¬τ₂) ∨ (D₂ ∧ ¬τ₁), where τᵢ is the guard into trap i: progress of
    /// one operand that loses none of the others.
    fn progress_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_end(q) {
            return Ok(f64::NEG_INFINITY);
        }
        match self.operator {
            Operator::Conjunction => {
                robustness::progress_of_all(self.losses(q, s), self.progresses(q, s))
            }
            Operator::Disjunction => self.progress_of_any(q, s),
            Operator::Sequence => {
                let running = self.running(q);
                self.operands[running].progress_robustness(self.components(q)[running], s)
            }
        }
    }

    fn trap_robustness(&self, q: u32, s: &S) -> Result<f64, Error> {
        if self.is_end(q) {
            return Ok(f64::NEG_INFINITY);
        }
        let mut losses = self.losses(q, s);
        match self.operator {
            Operator::Conjunction => {
                losses.try_fold(f64::NEG_INFINITY, |most, lost| Ok(most.max(lost?)))
            }
            Operator::Disjunction => {
                losses.try_fold(f64::INFINITY, |least, lost| Ok(least.min(lost?)))
            }
            Operator::Sequence => self.losing(self.running(q), q, s),
        }
    }

    /// Min over the operands of a conjunction, max over those of a disjunction. In a sequence each
    /// operand is judged on its own part of the trajectory, and the least counts; so it may fall
    /// where one operand hands over to the next.
    fn trajectory_robustness(&self, trajectory: &[S]) -> Result<f64, Error>
    where
        S: Sized,
    {
        let fold = match self.operator {
            Operator::Sequence => return sequence_robustness(&self.operands, trajectory),
            Operator::Conjunction => f64::min,
            Operator::Disjunction => f64::max,
        };
        let mut all = self.operands.iter().map(|o| o.trajectory_robustness(trajectory));
        let first = all.next().unwrap_or(Ok(f64::NEG_INFINITY))?;
        all.try_fold(first, |sum, next| Ok(fold(sum, next?)))
    }
}

fn sequence_robustness<S>(operands: &[Operand<'_, S>], trajectory: &[S]) -> Result<f64, Error> {
    let (mut least, mut start) = (f64::INFINITY, 0);
    for operand in operands {
        let (mut q, mut end) = (0, start);
        while end < trajectory.len() && (end == start || !operand.is_terminal(q)) {
            q = operand.next(q, &trajectory[end])?;
            end += 1;
        }
        least = least.min(operand.trajectory_robustness(&trajectory[start..end])?);
        if !operand.is_accepting(q) {
            break;
        }
        start = end;
    }
    Ok(least)
}
