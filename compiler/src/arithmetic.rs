//! Which letters can occur: what arithmetic knows of the predicates of a task.
//!
//! Two predicates are not free propositions when arithmetic ties them: no state has `x < 3` and
//! `x > 5`. Every comparison is brought into the form *linear form ⋚ threshold*; the thresholds of
//! one form cut the number line into cells, of which a state is in exactly one (integers between
//! two neighbours, and values outside a field's type, are in none). A decision diagram with the
//! propositions above the cuts relates the two; a valuation is possible iff the diagram below it
//! is not empty.
//!
//! Forms that share variables (`x < 1`, `y < 1`, `x + y > 2`) are related by deciding which
//! combinations of their cells have a real point, see [`linear`](crate::linear).
//!
//! Everything is exact rational arithmetic on what the source says. Non-linear terms, and sums of
//! very many, count as variables of their own, and what is too entangled to relate within
//! [`NODE_LIMIT`] nodes or [`CELL_LIMIT`] combinations counts as independent: sound, for it only
//! leaves letters possible that are not.

mod form;
mod relation;

use crate::arena::Memo;
use crate::dfa::{Dfa, Diagram, Target};
use crate::guard::{Guard, Store};
use crate::predicate::{ConditionId, Module, PredicateId, Task};

use relation::Analysis;

/// Diagrams of entangled predicates above this many nodes are given up.
pub const NODE_LIMIT: usize = 1 << 20;
/// Combinations of cells of linear forms above this number are given up.
pub const CELL_LIMIT: usize = 1 << 12;

/// The letters of a task that can occur.
pub struct Possible {
    store: Store,
    letters: Guard,
}

/// The letters that can occur: those valuations of the task's propositions that some state has.
#[must_use]
pub fn possible(module: &Module, task: &Task) -> Possible {
    let condition = |id: &PredicateId| module.predicates[id.0 as usize].condition;
    let roots: Vec<ConditionId> = task.predicates.iter().map(condition).collect();
    possible_conditions(module, &roots)
}

/// The valuations of some conditions, as propositions in this order, that some state has.
#[must_use]
pub fn possible_conditions(module: &Module, roots: &[ConditionId]) -> Possible {
    let analysis = Analysis::new(module);
    let mut possible = Possible { store: Store::default(), letters: Guard::TRUE };
    for component in analysis.components(roots) {
        if let Some(letters) = analysis.relate(roots, &component, &mut possible.store) {
            possible.letters = possible.store.and(possible.letters, letters);
        }
    }
    possible
}

impl Possible {
    /// Whether every letter can occur.
    #[must_use]
    pub fn all(&self) -> bool {
        self.letters == Guard::TRUE
    }

    /// Whether a proposition can be true, and whether it can be false.
    #[must_use]
    pub fn values(&mut self, proposition: u32) -> (bool, bool) {
        let holds = self.store.variable(proposition);
        let yes = self.store.and(self.letters, holds);
        let no = self.store.minus(self.letters, holds);
        (yes != Guard::FALSE, no != Guard::FALSE)
    }

    /// Whether no letter has all of these values.
    #[must_use]
    pub fn excludes(&mut self, literals: &[(u32, bool)]) -> bool {
        let mut letters = self.letters;
        for &(proposition, value) in literals {
            let holds = self.store.variable(proposition);
            letters = match value {
                true => self.store.and(letters, holds),
                false => self.store.minus(letters, holds),
            };
        }
        letters == Guard::FALSE
    }

    /// The automaton without the edges that only impossible letters take. States and the
    /// accepting state stay; [`minimize`](crate::minimize::minimize) then merges what no possible
    /// letter tells apart, and the result is minimal over the possible letters, for the
    /// diagrams of two states are equal iff they are on all of those.
    #[must_use]
    pub fn restrict(&self, dfa: &Dfa) -> Dfa {
        let mut restriction = Restriction {
            possible: self,
            dfa,
            diagram: Diagram::default(),
            known: Memo::default(),
        };
        let restricted: Vec<_> = dfa
            .transitions
            .iter()
            .map(|&target| restriction.target(target, self.letters).unwrap_or(target))
            .collect();
        let mut dfa = Dfa {
            propositions: dfa.propositions.clone(),
            diagram: restriction.diagram,
            transitions: restricted,
            accepting: dfa.accepting,
            trap: dfa.trap,
            possible: None,
        };
        self.settle_initial(&mut dfa);
        dfa
    }

    /// The state before the first letter counts as accepting if every possible letter accepts.
    fn settle_initial(&self, dfa: &mut Dfa) {
        if let Some(accepting) = dfa.accepting
            && dfa.transitions[0] == Target::to_state(accepting)
        {
            dfa.transitions[0] = Target::to_state(0);
            dfa.accepting = Some(0);
        }
    }

    /// Writes the possible letters into an automaton, for its guards.
    pub fn attach(&self, dfa: &mut Dfa) {
        if !self.all() {
            let mut known = Memo::default();
            dfa.possible = Some(self.copy(self.letters, &mut dfa.diagram, &mut known));
        }
    }

    fn copy(&self, f: Guard, diagram: &mut Diagram, known: &mut Memo<Guard, Target>) -> Target {
        if f == Guard::TRUE || f == Guard::FALSE {
            return Target::to_state(u32::from(f == Guard::TRUE));
        }
        if let Some(target) = known.get(f) {
            return target;
        }
        let (low, high) = self.store.branches(f);
        let (low, high) = (self.copy(low, diagram, known), self.copy(high, diagram, known));
        let target = diagram.node(self.store.level(f), low, high);
        known.insert(f, target);
        target
    }
}

struct Restriction<'a> {
    possible: &'a Possible,
    dfa: &'a Dfa,
    diagram: Diagram,
    known: Memo<(Target, Guard), Target>,
}

impl Restriction<'_> {
    /// The target on the letters of `on`; `None` if there are none.
    fn target(&mut self, target: Target, on: Guard) -> Option<Target> {
        if on == Guard::FALSE {
            return None;
        }
        if target.state().is_some() {
            return Some(target);
        }
        if let Some(known) = self.known.get((target, on)) {
            return Some(known);
        }
        let store = &self.possible.store;
        let asked = self.dfa.diagram.proposition(target).unwrap_or(u32::MAX);
        let proposition = asked.min(store.level(on));
        let (low, high) = self.dfa.diagram.split(target, proposition);
        let (on_low, on_high) =
            if store.level(on) == proposition { store.branches(on) } else { (on, on) };
        let (low, high) = (self.target(low, on_low), self.target(high, on_high));
        let restricted = match (low, high) {
            (Some(low), Some(high)) => self.diagram.node(proposition, low, high),
            (one, other) => one.or(other)?,
        };
        self.known.insert((target, on), restricted);
        Some(restricted)
    }
}
