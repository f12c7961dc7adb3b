//! How the propositions of a task are related by the cuts that they compare with.
//!
//! One decision diagram holds all: the propositions on top, then the cuts of each form from the
//! lowest to the highest, then the opaque conditions. Its function is "this valuation of the
//! propositions is the one that these cuts make, and these cuts are a cell that has a point".
//! Existential quantification of everything below the propositions gives the possible letters;
//! since propositions are on top, that is a walk that replaces each node below by ⊤.
//!
//! Propositions that share neither a variable nor an opaque condition are related apart, so the
//! diagram stays small however many predicates a task has.

use crate::arena::{self, Memo};
use crate::bdd::{Bdd, Diagram, Node};
use crate::linear::{Form, Inequality, feasible};
use crate::predicate::{Condition, ConditionId, Module};

use super::form::{Atom, Cut, Range, Rational, atom, bounds, inequalities, linear_terms};
use super::{CELL_LIMIT, NODE_LIMIT};

/// The comparisons of a module as atoms, computed once.
pub(super) struct Analysis<'a> {
    module: &'a Module,
    /// The atom of each condition of the module; [`Atom::Opaque`] for those that are not
    /// comparisons.
    atoms: Vec<Atom>,
}

impl<'a> Analysis<'a> {
    /// The atoms of all conditions of a module.
    pub(super) fn new(module: &'a Module) -> Self {
        let linear = linear_terms(module);
        let atoms = module.arena.conditions().iter().map(|condition| match condition {
            Condition::Compare(comparison, a, b) => {
                atom(module, *comparison, &linear[a.0 as usize], &linear[b.0 as usize])
                    .unwrap_or(Atom::Opaque)
            }
            _ => Atom::Opaque,
        });
        Self { module, atoms: atoms.collect() }
    }

    /// The groups of propositions that share ties, as sets of places in `roots`.
    pub(super) fn components(&self, roots: &[ConditionId]) -> Vec<Vec<usize>> {
        let ties: Vec<_> = roots.iter().map(|&root| self.ties(root)).collect();
        arena::groups(&ties)
    }

    /// The ties of a predicate to others: variables (even numbers), and opaque conditions (odd
    /// numbers).
    fn ties(&self, root: ConditionId) -> Vec<u32> {
        let mut ties = Vec::new();
        for id in self.module.conditions_of(vec![root]) {
            match &self.atoms[id.0 as usize] {
                Atom::Below(form, _)
                | Atom::Above(form, _)
                | Atom::At(form, _)
                | Atom::Off(form, _) => ties.extend(form.iter().map(|(term, _)| 2 * term.0)),
                Atom::Opaque if self.is_opaque(id) => ties.push(2 * id.0 + 1),
                Atom::Constant(_) | Atom::Opaque => {}
            }
        }
        ties
    }

    /// Whether a condition is a leaf whose value arithmetic does not know: a Boolean place, a Rust
    /// value, or a comparison beyond exact arithmetic.
    fn is_opaque(&self, id: ConditionId) -> bool {
        let condition = self.module.arena.condition(id);
        self.module.operands(condition).is_empty() && !matches!(condition, Condition::Truth(_))
    }

    /// The valuations of the propositions at `places` that some state has, over the levels of those
    /// propositions; `None` if that would exceed a limit.
    pub(super) fn relate(
        &self,
        roots: &[ConditionId],
        places: &[usize],
        result: &mut Diagram,
    ) -> Option<Bdd> {
        let conditions: Vec<ConditionId> = places.iter().map(|&place| roots[place]).collect();
        let needed = self.module.conditions_of(conditions.clone());
        let mut relation = Relation::new(self, places.len() as u32, &needed)?;
        let meaning = relation.meanings(&needed);
        let mut related = relation.cells();
        for (level, condition) in (0..places.len() as u32).zip(&conditions).rev() {
            let holds = meaning.get(*condition).expect("all that is needed has a meaning");
            let low = relation.diagram.minus(related, holds);
            let high = relation.diagram.and(related, holds);
            related = relation.diagram.node(level, low, high);
            if relation.diagram.is_exhausted() {
                return None;
            }
        }
        Some(relation.project(related, places, result))
    }
}

/// A relation under construction: propositions on the upper levels, cuts and opaque conditions
/// below.
struct Relation<'a> {
    analysis: &'a Analysis<'a>,
    diagram: Diagram,
    propositions: u32,
    /// The forms that are compared, rising, with their cuts.
    chains: Vec<Chain>,
    /// The opaque conditions, rising; their levels follow on those of the cuts.
    opaque: Vec<ConditionId>,
    first_opaque: u32,
}

impl<'a> Relation<'a> {
    /// Gives levels to the cuts and opaque conditions of some conditions; `None` if they are more
    /// than a diagram may have.
    fn new(analysis: &'a Analysis<'a>, propositions: u32, needed: &[ConditionId]) -> Option<Self> {
        let mut chains: Vec<Chain> = Vec::new();
        let mut opaque = Vec::new();
        for &id in needed {
            match &analysis.atoms[id.0 as usize] {
                Atom::Below(form, cut) | Atom::Above(form, cut) => add(&mut chains, form, &[*cut]),
                Atom::At(form, at) | Atom::Off(form, at) => {
                    add(&mut chains, form, &[(*at, false), (*at, true)]);
                }
                Atom::Opaque if analysis.is_opaque(id) => opaque.push(id),
                Atom::Constant(_) | Atom::Opaque => {}
            }
        }
        let mut level = propositions;
        for chain in &mut chains {
            chain.level = level;
            level += chain.cuts.len() as u32;
        }
        let fits = level as usize + opaque.len() < Diagram::MAX_LEVELS as usize;
        let first_opaque = level;
        fits.then(|| Self {
            analysis,
            diagram: Diagram::with_limit(NODE_LIMIT),
            propositions,
            chains,
            opaque,
            first_opaque,
        })
    }

    /// The meaning of each condition as a function of cuts and opaque conditions.
    fn meanings(&mut self, needed: &[ConditionId]) -> Memo<ConditionId, Bdd> {
        let mut meaning: Memo<ConditionId, Bdd> = Memo::default();
        let mut pending = needed.to_vec();
        // A predicate may refer to a condition that stands later in the arena.
        while !pending.is_empty() {
            pending.retain(|&id| {
                let condition = self.analysis.module.arena.condition(id);
                let operands = self.analysis.module.operands(condition);
                let known: Option<Vec<_>> =
                    operands.iter().map(|operand| meaning.get(*operand)).collect();
                let Some(operands) = known else { return true };
                let guard = self.meaning(id, condition, &operands);
                meaning.insert(id, guard);
                false
            });
        }
        meaning
    }

    /// The meaning of one condition from those of its operands.
    fn meaning(&mut self, id: ConditionId, condition: &Condition, operands: &[Bdd]) -> Bdd {
        match (condition, operands) {
            (Condition::Truth(true), _) => Bdd::TRUE,
            (Condition::Truth(false), _) => Bdd::FALSE,
            (Condition::Not(_), &[a]) => self.diagram.not(a),
            (Condition::And(..), &[a, b]) => self.diagram.and(a, b),
            (Condition::Or(..), &[a, b]) => self.diagram.or(a, b),
            (Condition::Is(_) | Condition::Apply { .. }, &[a]) => a,
            _ => self.atom(id),
        }
    }

    /// The meaning of a leaf.
    fn atom(&mut self, id: ConditionId) -> Bdd {
        let analysis = self.analysis;
        match &analysis.atoms[id.0 as usize] {
            Atom::Constant(value) => [Bdd::FALSE, Bdd::TRUE][usize::from(*value)],
            Atom::Below(form, cut) => self.cut(form, *cut),
            Atom::Above(form, cut) => {
                let below = self.cut(form, *cut);
                self.diagram.not(below)
            }
            Atom::At(form, at) => self.at(form, *at),
            Atom::Off(form, at) => {
                let at = self.at(form, *at);
                self.diagram.not(at)
            }
            Atom::Opaque => {
                let place = self.opaque.binary_search(&id).expect("an opaque condition");
                self.diagram.variable(self.first_opaque + place as u32)
            }
        }
    }

    /// The variable of a cut: true iff the form is below it.
    fn cut(&mut self, form: &Form, cut: Cut) -> Bdd {
        let chain = &self.chains[find(&self.chains, form).expect("a form that is compared")];
        let place = chain.cuts.binary_search(&cut).expect("a cut of the form");
        self.diagram.variable(chain.level + place as u32)
    }

    /// The function that is true iff the form is equal to a number: below the cut after it, and not
    /// below the cut before.
    fn at(&mut self, form: &Form, at: Rational) -> Bdd {
        let (before, through) = (self.cut(form, (at, false)), self.cut(form, (at, true)));
        self.diagram.minus(through, before)
    }

    /// The combinations of cells that have a point. Being below one cut implies being below all
    /// later ones; a form of integers or of a bounded type has no value in some cells; and forms
    /// that share variables exclude each other's cells.
    fn cells(&mut self) -> Bdd {
        let variables = |chain: &Chain| chain.form.iter().map(|(term, _)| term.0).collect();
        let ties: Vec<Vec<u32>> = self.chains.iter().map(variables).collect();
        let chains = std::mem::take(&mut self.chains);
        let mut all = Bdd::TRUE;
        for group in arena::groups(&ties) {
            let module = self.analysis.module;
            let group: Vec<&Chain> = group.iter().map(|&place| &chains[place]).collect();
            let mut system: Vec<_> =
                group.iter().flat_map(|chain| bounds(module, &chain.form)).collect();
            let mut left = CELL_LIMIT;
            let cells = match self.joint(&group, &mut system, &mut left) {
                Some(cells) => cells,
                None => self.apart(&group),
            };
            all = self.diagram.and(all, cells);
        }
        self.chains = chains;
        all
    }

    /// The combinations of cells of a group of forms that have a common point, given the
    /// inequalities of `system`; `None` if they are too many (`left` counts down).
    ///
    /// Depth-first over the forms: an infeasible prefix of cells prunes all of its continuations.
    fn joint(
        &mut self,
        group: &[&Chain],
        system: &mut Vec<Inequality>,
        left: &mut usize,
    ) -> Option<Bdd> {
        let Some((chain, others)) = group.split_first() else { return Some(Bdd::TRUE) };
        let range = Range::of(self.analysis.module, &chain.form);
        let mut cells = Bdd::FALSE;
        for k in 0..=chain.cuts.len() {
            let (after, until) = chain.ends(k);
            if !range.is_inhabited(after, until) {
                continue;
            }
            let known = system.len();
            system.extend(inequalities(&chain.form, after, until));
            // Counted before the system is decided: deciding is the expensive part.
            *left = left.checked_sub(1)?;
            // A form alone is feasible in every cell that its range inhabits.
            let alone = known == 0 && others.is_empty();
            if alone || feasible(system) != Some(false) {
                let rest = self.joint(others, system, left)?;
                let cell = self.cell(chain, k);
                let cell = self.diagram.and(cell, rest);
                cells = self.diagram.or(cells, cell);
            }
            system.truncate(known);
        }
        Some(cells)
    }

    /// The cells of each form of a group by itself, as if the forms were independent.
    fn apart(&mut self, group: &[&Chain]) -> Bdd {
        let mut all = Bdd::TRUE;
        for chain in group {
            let range = Range::of(self.analysis.module, &chain.form);
            let mut cells = Bdd::FALSE;
            for k in 0..=chain.cuts.len() {
                let (after, until) = chain.ends(k);
                if range.is_inhabited(after, until) {
                    let cell = self.cell(chain, k);
                    cells = self.diagram.or(cells, cell);
                }
            }
            all = self.diagram.and(all, cells);
        }
        all
    }

    /// Cell `k` of a form: not below the first `k` cuts, below all others.
    fn cell(&mut self, chain: &Chain, k: usize) -> Bdd {
        let mut all = Bdd::TRUE;
        for i in (0..chain.cuts.len()).rev() {
            let (low, high) = if i >= k { (Bdd::FALSE, all) } else { (all, Bdd::FALSE) };
            all = self.diagram.node(chain.level + i as u32, low, high);
        }
        all
    }

    /// Quantifies everything below the propositions away: ⊤ where anything is left. Levels become
    /// those of the propositions at `places`.
    fn project(&self, f: Bdd, places: &[usize], result: &mut Diagram) -> Bdd {
        let order = self.diagram.postorder(&[f]);
        let mut node = |Node { level, low, high }| match level < self.propositions {
            true => result.node(places[level as usize] as u32, low, high),
            // Reduced diagrams have no node that leads to ⊥ only, so any node below is satisfiable.
            false => Bdd::TRUE,
        };
        self.diagram.fold(&order, &Bdd::leaf, &mut node).of(f)
    }
}

/// A form and its cuts.
struct Chain {
    form: Form,
    /// The cuts, rising, each once.
    cuts: Vec<Cut>,
    /// The level of the first cut; those of the others follow.
    level: u32,
}

impl Chain {
    /// The ends of cell `k`, which lies between the cuts k-1 and k; `None` for an end that is
    /// infinite.
    fn ends(&self, k: usize) -> (Option<Cut>, Option<Cut>) {
        (k.checked_sub(1).map(|k| self.cuts[k]), self.cuts.get(k).copied())
    }
}

/// The place of the chain of a form, or the place at which to insert it.
fn find(chains: &[Chain], form: &Form) -> Result<usize, usize> {
    chains.binary_search_by(|chain| chain.form.cmp(form))
}

/// Adds cuts to the chain of a form.
fn add(chains: &mut Vec<Chain>, form: &Form, cuts: &[Cut]) {
    let place = find(chains, form).unwrap_or_else(|place| {
        chains.insert(place, Chain { form: form.clone(), cuts: Vec::new(), level: 0 });
        place
    });
    let known = &mut chains[place].cuts;
    for &cut in cuts {
        if let Err(place) = known.binary_search(&cut) {
            known.insert(place, cut);
        }
    }
}
