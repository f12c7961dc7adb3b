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

use crate::bdd::{Bdd, Diagram};
use crate::dfa::Dfa;
use crate::predicate::{ConditionId, Module, PredicateId, Task};

use relation::Analysis;

/// Diagrams of entangled predicates above this many nodes are given up.
pub const NODE_LIMIT: usize = 1 << 20;
/// Combinations of cells of linear forms above this number are given up.
pub const CELL_LIMIT: usize = 1 << 12;

/// The letters of a task that can occur.
pub struct Possible {
    diagram: Diagram,
    letters: Bdd,
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
    let mut possible = Possible { diagram: Diagram::default(), letters: Bdd::TRUE };
    for component in analysis.components(roots) {
        if let Some(letters) = analysis.relate(roots, &component, &mut possible.diagram) {
            possible.letters = possible.diagram.and(possible.letters, letters);
        }
    }
    possible
}

impl Possible {
    /// Whether every letter can occur.
    #[must_use]
    pub fn all(&self) -> bool {
        self.letters == Bdd::TRUE
    }

    /// Whether a proposition can be true, and whether it can be false.
    #[must_use]
    pub fn values(&mut self, proposition: u32) -> (bool, bool) {
        let holds = self.diagram.variable(proposition);
        let yes = self.diagram.and(self.letters, holds);
        let no = self.diagram.minus(self.letters, holds);
        (yes != Bdd::FALSE, no != Bdd::FALSE)
    }

    /// Whether no letter has all of these values.
    #[must_use]
    pub fn excludes(&mut self, literals: &[(u32, bool)]) -> bool {
        let mut letters = self.letters;
        for &(proposition, value) in literals {
            let holds = self.diagram.variable(proposition);
            letters = match value {
                true => self.diagram.and(letters, holds),
                false => self.diagram.minus(letters, holds),
            };
        }
        letters == Bdd::FALSE
    }

    /// The automaton without the edges that only impossible letters take. States and the
    /// accepting state stay; [`minimize`](crate::minimize::minimize) then merges what no possible
    /// letter tells apart, and the result is minimal over the possible letters, for the
    /// diagrams of two states are equal iff they are on all of those.
    #[must_use]
    pub fn restrict(&self, dfa: &Dfa) -> Dfa {
        let mut diagram = dfa.diagram.clone();
        let letters = diagram.import(&self.diagram, self.letters);
        let roots: Vec<Bdd> =
            dfa.transitions.iter().map(|&root| diagram.constrain(root, letters)).collect();
        let (diagram, transitions) = diagram.map_leaves(&roots, &Bdd::leaf);
        let mut restricted = Dfa {
            propositions: dfa.propositions.clone(),
            diagram,
            transitions,
            accepting: dfa.accepting,
            trap: dfa.trap,
            possible: None,
        };
        self.settle_initial(&mut restricted);
        restricted
    }

    /// The state before the first letter counts as accepting if every possible letter accepts.
    fn settle_initial(&self, dfa: &mut Dfa) {
        if let Some(accepting) = dfa.accepting
            && dfa.transitions[0] == Bdd::leaf(accepting)
        {
            dfa.transitions[0] = Bdd::leaf(0);
            dfa.accepting = Some(0);
        }
    }

    /// Writes the possible letters into an automaton, for its guards.
    pub fn attach(&self, dfa: &mut Dfa) {
        if !self.all() {
            dfa.possible = Some(dfa.diagram.import(&self.diagram, self.letters));
        }
    }
}
