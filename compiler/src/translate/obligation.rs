//! The levels of obligations: which subformulas can be due at the next state, and where in the
//! diagram each of them stands.
//!
//! A bounded operator has an obligation for each number of steps that it may still wait. They stand
//! next to each other, so the level of one is a sum, and no table knows of all of them: `F[0,n] a`
//! takes the same space here for every n. An operator over the same operands is the same obligation
//! whatever its bound, so `F[0,3] a` and `F[0,9] a` share the range of the larger one.
//!
//! The obligations of F[0,k], G[0,k] and U[0,k] imply each other, and each range is a
//! [chain](crate::bdd) in the diagram, weakest first: F[0,k] φ implies F[0,k+1] φ, and G[0,k+1] φ
//! implies G[0,k] φ. X[k+1] F φ implies X[k] F φ, and so with T; over other operands those of X[k]
//! are free.

use crate::intern::Interner;
use crate::spec::{Formula, FormulaId, Spec};

/// The obligations of a formula: for each formula that can be due at the next state a range of
/// levels, which is a single one if the formula has no bound.
pub(super) struct Obligations {
    /// In the order of their levels.
    ranges: Vec<Range>,
    /// For each formula of the spec the place of its range; `u32::MAX` if it is never due.
    places: Vec<u32>,
    /// The number of levels that are propositions and come first.
    propositions: u32,
}

/// The obligations of one operator over the same operands.
#[derive(Clone, Copy)]
struct Range {
    /// The operator with its largest bound.
    formula: Formula,
    /// A formula with this operator: the only one, if it has no bound.
    id: FormulaId,
    /// The first level.
    first: u32,
    order: Order,
}

/// How the obligations of one operator imply each other.
#[derive(Clone, Copy, PartialEq)]
enum Order {
    /// More steps are weaker, and come first.
    MoreIsWeaker,
    /// Fewer steps are weaker, and come first.
    FewerIsWeaker,
    /// They are free; more steps come first.
    Free,
}

impl Order {
    fn of(spec: &Spec, formula: Formula) -> Self {
        match formula {
            Formula::Within(..) | Formula::UntilWithin(..) => Self::MoreIsWeaker,
            Formula::Throughout(..) => Self::FewerIsWeaker,
            Formula::Delay(_, a) => match spec.formula(a) {
                Formula::Eventually(_) | Formula::Then(..) => Self::FewerIsWeaker,
                _ => Self::Free,
            },
            _ => Self::Free,
        }
    }
}

impl Range {
    /// The last level.
    fn last(self) -> Option<u32> {
        self.first.checked_add(self.formula.bound().unwrap_or(0))
    }

    /// The place in the range of the obligation with `steps` left. It is its own inverse: the steps
    /// of a place.
    fn turned(self, steps: u32) -> u32 {
        match self.order {
            Order::FewerIsWeaker => steps,
            _ => self.formula.bound().unwrap_or(0) - steps,
        }
    }
}

impl Obligations {
    /// Numbers the obligations, inner ones first: a chain of goals then shares the diagrams of the
    /// obligations that it has already met. `None` if there are more than there are levels.
    pub(super) fn new(spec: &Spec) -> Option<Self> {
        let mut ranges: Vec<Range> = Vec::new();
        let mut known = Interner::default();
        let mut places = vec![u32::MAX; spec.formulas().len()];
        let due = due(spec);
        for (id, formula) in spec.formulas().filter(|(id, _)| due[id.0 as usize]) {
            let place = known.intern(formula.with_bound(0));
            places[id.0 as usize] = place;
            match ranges.get_mut(place as usize) {
                Some(range) if range.formula.bound() < formula.bound() => range.formula = formula,
                Some(_) => {}
                None => {
                    let order = Order::of(spec, formula);
                    ranges.push(Range { formula, id, first: 0, order });
                }
            }
        }
        let propositions = spec.propositions().len() as u32;
        let mut first = propositions;
        for range in &mut ranges {
            range.first = first;
            first = range.last()?.checked_add(1)?;
        }
        Some(Self { ranges, places, propositions })
    }

    /// The number of propositions and of operators that can be due, whatever their bounds.
    pub(super) fn operators(&self) -> usize {
        self.propositions as usize + self.ranges.len()
    }

    /// The first and the last level of each range whose obligations imply each other.
    pub(super) fn chains(&self) -> Vec<(u32, u32)> {
        let chains = self.ranges.iter().filter(|range| range.order != Order::Free);
        chains.filter_map(|range| Some((range.first, range.last()?))).collect()
    }

    /// The level of a formula that can be due.
    pub(super) fn level(&self, id: FormulaId, formula: Formula) -> u32 {
        let range = self.ranges[self.places[id.0 as usize] as usize];
        range.first + range.turned(formula.bound().unwrap_or(0))
    }

    /// The formula that is due by the obligation of a level. A bounded operator has the bound of
    /// the obligation, which may be 0; the id is then that of a formula with another bound.
    pub(super) fn due(&self, level: u32) -> (FormulaId, Formula) {
        let after = self.ranges.partition_point(|range| range.first <= level);
        let range = self.ranges[after - 1];
        (range.id, range.formula.with_bound(range.turned(level - range.first)))
    }
}

/// For each formula whether it can be due at the next state.
fn due(spec: &Spec) -> Vec<bool> {
    let reachable = spec.reachable();
    let mut due = vec![false; reachable.len()];
    for (id, formula) in spec.formulas().filter(|(id, _)| reachable[id.0 as usize]) {
        let later = match formula {
            Formula::Next(a) | Formula::Delay(_, a) | Formula::Then(_, a) => Some(a),
            _ => None,
        };
        later.into_iter().for_each(|later| due[later.0 as usize] = true);
        due[id.0 as usize] |= formula.is_temporal() && !matches!(formula, Formula::Next(_));
    }
    due
}
