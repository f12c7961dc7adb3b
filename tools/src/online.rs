//! The robustness of a trajectory while it grows: one step a state, in memory that does not grow
//! with the trajectory.
//!
//! ρ is at least θ iff the trajectory satisfies the formula in which every literal is read as "its
//! robustness is at least θ". As literals are only combined by max and min, this holds for p and
//! for ¬p apart, so both are propositions of their own here, and all of the formula is positive.
//! The automaton of that formula is followed for *all* thresholds at once. A lower threshold makes
//! no literal false, so the states along the thresholds form a chain in which each accepts all that
//! the one above it accepts: [`Online`] holds the few thresholds at which the state changes. For
//! n unordered goals these are at most n + 1, and for one bounded operator the entries of the
//! monotone queue with which a sliding maximum is computed (Lemire, "Streaming maximum-minimum
//! filter", 2006).
//!
//! Why not the recursion of [`evaluate`](crate::evaluate): it runs backwards from the last state,
//! so it needs all of them, and starts anew with every state that arrives.

use std::cell::Cell;
use std::convert::Infallible;
use std::sync::Arc;

use tltl::Automaton;
use tltl::robustness::advance_runs;
use tltl_compiler::dfa::{Dfa, State};
use tltl_compiler::minimize::minimize;
use tltl_compiler::proposition::Proposition;
use tltl_compiler::spec::{Formula, FormulaId, Spec};
use tltl_compiler::translate::{Budget, translate};

use crate::evaluate::{Columns, Evaluator, Scratch};

/// The robustness of a formula on the states that have been read so far.
///
/// ```
/// use tltl_compiler::translate::Budget;
/// use tltlc::{online::Online, task};
///
/// let task = task::compile("!wet U home", Budget::default())?;
/// let mut online = Online::new(&task.entry().task().spec, Budget::default());
/// // Propositions are numbered in order of appearance: `wet` is 0, `home` is 1.
/// let mut after = |rho: [f64; 2]| {
///     online.step(&rho);
///     online.robustness()
/// };
/// assert_eq!(after([-0.5, -2.0]), -2.0);
/// assert_eq!(after([-3.0, 1.5]), 0.5);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Online(Way);

#[derive(Clone, Debug)]
enum Way {
    /// The automaton over literals, 2p for p and 2p + 1 for ¬p. Each threshold is the highest at
    /// which its state is reached, the first one +∞; they fall, and neighbouring states differ.
    Thresholds { dfa: Arc<Dfa>, states: Vec<(f64, State)> },
    /// For an automaton without a formula: the robustness of the best run into each state, before
    /// and after a state is read.
    Runs { automaton: Arc<Automaton>, now: Vec<f64>, next: Vec<f64>, is_begun: bool },
    /// For a formula whose automaton over literals is larger than the budget allows: all that was
    /// read.
    All(Recorded),
}

impl Online {
    /// The formula before any state is read. Without an automaton within the budget, memory grows
    /// with the trajectory, and [`robustness`](Self::robustness) takes a pass over it.
    #[must_use]
    pub fn new(spec: &Spec, budget: Budget) -> Self {
        Self(match translate(&over_literals(spec), budget) {
            Ok(dfa) => {
                let dfa = Arc::new(minimize(&dfa));
                Way::Thresholds { dfa, states: vec![(f64::INFINITY, 0)] }
            }
            Err(_) => Way::All(Recorded::new(spec)),
        })
    }

    /// An automaton without a formula before any state is read. Its robustness is that of the
    /// [best run](tltl::robustness::best_run), and each state costs a pass over all guards.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::{online::Online, task};
    ///
    /// let task = task::compile("!wet U home", Budget::default())?;
    /// let mut online = Online::of_automaton(task.automaton());
    /// online.step(&[-0.5, 1.5]);
    /// assert_eq!(online.robustness(), 1.5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn of_automaton(automaton: &Automaton) -> Self {
        let next = vec![f64::NEG_INFINITY; automaton.tables().states as usize];
        let mut now = next.clone();
        now[Automaton::INITIAL as usize] = f64::INFINITY;
        Self(Way::Runs { automaton: Arc::new(automaton.clone()), now, next, is_begun: false })
    }

    /// Reads one state: the robustness of each proposition of the formula in it, none of them NaN.
    pub fn step(&mut self, rho: &[f64]) {
        match &mut self.0 {
            Way::Thresholds { dfa, states } => *states = moved(dfa, states, rho),
            Way::Runs { automaton, now, next, is_begun } => {
                *is_begun = true;
                let Ok(()) = advance_runs(automaton, now, next, |i| Ok::<_, Infallible>(rho[i]));
                std::mem::swap(now, next);
            }
            Way::All(recorded) => recorded.step(rho),
        }
    }

    /// The robustness of the states read so far; -∞ before the first.
    #[must_use]
    pub fn robustness(&self) -> f64 {
        match &self.0 {
            Way::Thresholds { dfa, states } => {
                let accepted = states.iter().find(|(_, q)| dfa.accepting == Some(*q));
                accepted.map_or(f64::NEG_INFINITY, |(threshold, _)| *threshold)
            }
            Way::Runs { automaton, now, is_begun, .. } => {
                let accepting = automaton.accepting().filter(|_| *is_begun);
                accepting.map_or(f64::NEG_INFINITY, |q| now[q as usize])
            }
            Way::All(recorded) => recorded.robustness(recorded.rows()),
        }
    }

    /// The robustness of the states read so far, unless it costs a pass over them.
    #[must_use]
    pub(crate) fn at_hand(&self) -> Option<f64> {
        (!matches!(self.0, Way::All(_))).then(|| self.robustness() + 0.0)
    }

    /// The greatest robustness of any trajectory that goes on from the states read so far, if every
    /// literal of later states may have any value; `None` where that is not known, for want of a
    /// formula or of an automaton within the budget.
    ///
    /// It is the highest threshold that is not lost yet: the upper end of the interval of which
    /// [`robustness`](Self::robustness) is the lower one. The monitor of a compiled task
    /// ([`tltl::task::Online`]) gives the same.
    ///
    /// ```
    /// use tltl_compiler::translate::Budget;
    /// use tltlc::{online::Online, task};
    ///
    /// let task = task::compile("!wet U home", Budget::default())?;
    /// let mut online = Online::new(&task.entry().task().spec, Budget::default());
    /// online.step(&[-0.5, -2.0]);
    /// assert_eq!((online.robustness(), online.greatest()), (-2.0, Some(0.5)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn greatest(&self) -> Option<f64> {
        let Way::Thresholds { dfa, states } = &self.0 else { return None };
        let open = states.iter().find(|(_, q)| dfa.trap != Some(*q));
        Some(open.map_or(f64::NEG_INFINITY, |(threshold, _)| *threshold))
    }
}

/// A trajectory as a whole, as the robustness of the propositions of a formula.
#[derive(Clone, Debug)]
pub(crate) struct Recorded {
    formula: Evaluator,
    /// Row after row.
    rho: Vec<f64>,
    rows: usize,
}

impl Recorded {
    /// No states yet.
    pub(crate) fn new(spec: &Spec) -> Self {
        Self { formula: Evaluator::of_formula(spec), rho: Vec::new(), rows: 0 }
    }

    /// Reads one state.
    pub(crate) fn step(&mut self, rho: &[f64]) {
        self.rho.extend_from_slice(rho);
        self.rows += 1;
    }

    /// The number of states that were read.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// The robustness of the first `rows` states, in one pass over them.
    pub(crate) fn robustness(&self, rows: usize) -> f64 {
        let width = self.formula.inputs().len();
        let columns = Columns::of_rows(rows, width, &self.rho[..rows * width]);
        let columns = columns.expect("whole rows were read");
        let robustness = self.formula.robustness(&columns, &mut Scratch::default());
        robustness.expect("there are no predicates")
    }
}

/// The formula with a proposition for each literal: 2p for p, 2p + 1 for ¬p.
fn over_literals(spec: &Spec) -> Spec {
    let literals =
        (0..2 * spec.propositions().len()).map(|literal| Proposition::from(&*literal.to_string()));
    let mut positive = Spec::new(literals.collect());
    let ids: Vec<FormulaId> = spec.formulas().map(|(id, _)| id).collect();
    let images = positive.rebuild(spec, &ids, &mut |positive, id, formula| match formula {
        Formula::Literal { proposition, negated } => {
            positive.literal(2 * proposition + u32::from(negated), false, spec.span(id))
        }
        formula => positive.add(formula, spec.span(id)),
    });
    positive.set_root(images[spec.root().0 as usize]);
    positive
}

/// The states after one more letter.
///
/// From a threshold down, the next state stays the same until the highest robustness below it among
/// the literals that were asked and did not hold: there the walk through the diagram changes.
fn moved(dfa: &Dfa, states: &[(f64, State)], rho: &[f64]) -> Vec<(f64, State)> {
    let mut moved: Vec<(f64, State)> = Vec::with_capacity(states.len());
    for (place, &(top, q)) in states.iter().enumerate() {
        let end = states.get(place + 1).map_or(f64::NEG_INFINITY, |(threshold, _)| *threshold);
        let mut threshold = top;
        while threshold > end {
            let below = Cell::new(end);
            let to = dfa.next(q, |literal| {
                let p = rho[literal as usize / 2];
                let value = if literal % 2 == 0 { p } else { -p };
                if value < threshold {
                    below.set(below.get().max(value));
                }
                value >= threshold
            });
            if moved.last().is_none_or(|&(_, last)| last != to) {
                moved.push((threshold, to));
            }
            threshold = below.get();
        }
    }
    moved
}
