//! How the propositions of a task are related by what they compare.

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use crate::guard::{Guard, Store};
use crate::linear::{Inequality, feasible};
use crate::predicate::{Condition, ConditionId, Module, TermId};

use super::form::{Atom, Cut, Form, Range, Rational, atom, bounds, inequalities, linear_terms};
use super::{CELL_LIMIT, NODE_LIMIT};

/// The comparisons of a module, as cuts.
pub(super) struct Analysis<'a> {
    module: &'a Module,
    /// What each condition compares, if it does.
    atoms: Vec<Atom>,
}

/// What ties predicates together: a variable, or a condition of unknown meaning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Tie {
    Variable(TermId),
    Opaque(ConditionId),
}

impl<'a> Analysis<'a> {
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

    /// The propositions that share ties, as sets of places in `roots`.
    pub(super) fn components(&self, roots: &[ConditionId]) -> Vec<Vec<usize>> {
        let mut components: Vec<(BTreeSet<Tie>, Vec<usize>)> = Vec::new();
        for (place, &root) in roots.iter().enumerate() {
            let mut merged = (self.ties(root), vec![place]);
            let (tied, apart) = components
                .into_iter()
                .partition::<Vec<_>, _>(|(ties, _)| !ties.is_disjoint(&merged.0));
            for (ties, places) in tied {
                merged.0.extend(ties);
                merged.1.extend(places);
            }
            components = apart;
            components.push(merged);
        }
        components
            .into_iter()
            .map(|(_, mut places)| {
                places.sort_unstable();
                places
            })
            .collect()
    }

    fn ties(&self, root: ConditionId) -> BTreeSet<Tie> {
        let tie = |id: ConditionId| match &self.atoms[id.0 as usize] {
            Atom::Below(form, _)
            | Atom::Above(form, _)
            | Atom::At(form, _)
            | Atom::Off(form, _) => form.iter().map(|&(term, _)| Tie::Variable(term)).collect(),
            Atom::Opaque if self.is_opaque(id) => vec![Tie::Opaque(id)],
            Atom::Constant(_) | Atom::Opaque => Vec::new(),
        };
        self.needed(&[root]).into_iter().flat_map(tie).collect()
    }

    fn is_opaque(&self, id: ConditionId) -> bool {
        let condition = self.module.arena.condition(id);
        self.operands(condition).is_empty() && !matches!(condition, Condition::Truth(_))
    }

    fn operands(&self, condition: &Condition) -> Vec<ConditionId> {
        match *condition {
            Condition::Not(a) => vec![a],
            Condition::And(a, b) | Condition::Or(a, b) => vec![a, b],
            Condition::Apply { meaning, .. } => vec![meaning],
            Condition::Is(predicate) => {
                vec![self.module.predicates[predicate.0 as usize].condition]
            }
            _ => Vec::new(),
        }
    }

    /// All conditions that `roots` are made of, in the order of the arena.
    fn needed(&self, roots: &[ConditionId]) -> Vec<ConditionId> {
        let mut seen = BTreeSet::new();
        let mut stack = roots.to_vec();
        while let Some(id) = stack.pop() {
            if seen.insert(id) {
                stack.extend(self.operands(self.module.arena.condition(id)));
            }
        }
        seen.into_iter().collect()
    }

    /// The valuations of the propositions at `places` that some state has, over the levels of
    /// those propositions; `None` if that is too much work.
    pub(super) fn relate(
        &self,
        roots: &[ConditionId],
        places: &[usize],
        result: &mut Store,
    ) -> Option<Guard> {
        let conditions: Vec<ConditionId> = places.iter().map(|&place| roots[place]).collect();
        let needed = self.needed(&conditions);
        let mut relation = Relation::new(self, places.len() as u32, &needed)?;
        let meaning = relation.meanings(&needed);
        let mut related = relation.cells();
        for (level, condition) in (0..places.len() as u32).zip(&conditions).rev() {
            let holds = meaning[condition];
            let low = relation.store.minus(related, holds);
            let high = relation.store.and(related, holds);
            related = relation.store.node(level, low, high);
            if relation.store.len() > NODE_LIMIT {
                return None;
            }
        }
        let mut known = FxHashMap::default();
        Some(relation.project(related, places, result, &mut known))
    }
}

/// Propositions above, cuts and opaque conditions below.
struct Relation<'a> {
    analysis: &'a Analysis<'a>,
    store: Store,
    propositions: u32,
    cuts: BTreeMap<Form, BTreeMap<Cut, u32>>,
    opaque: BTreeMap<ConditionId, u32>,
}

impl<'a> Relation<'a> {
    fn new(analysis: &'a Analysis<'a>, propositions: u32, needed: &[ConditionId]) -> Option<Self> {
        let mut cuts: BTreeMap<Form, BTreeMap<Cut, u32>> = BTreeMap::new();
        let mut opaque = BTreeMap::new();
        for &id in needed {
            match &analysis.atoms[id.0 as usize] {
                Atom::Below(form, cut) | Atom::Above(form, cut) => {
                    cuts.entry(form.clone()).or_default().insert(*cut, 0);
                }
                Atom::At(form, at) | Atom::Off(form, at) => {
                    let cuts = cuts.entry(form.clone()).or_default();
                    cuts.insert((*at, false), 0);
                    cuts.insert((*at, true), 0);
                }
                Atom::Opaque if analysis.is_opaque(id) => {
                    opaque.insert(id, 0);
                }
                Atom::Constant(_) | Atom::Opaque => {}
            }
        }
        let levels = cuts.values_mut().flat_map(BTreeMap::values_mut).chain(opaque.values_mut());
        let count = levels.zip(propositions..).map(|(level, fresh)| *level = fresh).count();
        let fits = count + (propositions as usize) < Store::MAX_LEVELS as usize;
        fits.then(|| Self { analysis, store: Store::default(), propositions, cuts, opaque })
    }

    /// What each condition says of the cuts.
    fn meanings(&mut self, needed: &[ConditionId]) -> FxHashMap<ConditionId, Guard> {
        let mut meaning: FxHashMap<ConditionId, Guard> = FxHashMap::default();
        let mut pending = needed.to_vec();
        // A predicate may refer to a condition that stands later in the arena.
        while !pending.is_empty() {
            pending.retain(|&id| {
                let condition = self.analysis.module.arena.condition(id);
                let operands = self.analysis.operands(condition);
                let known: Option<Vec<_>> =
                    operands.iter().map(|operand| meaning.get(operand).copied()).collect();
                let Some(operands) = known else { return true };
                let guard = self.meaning(id, condition, &operands);
                meaning.insert(id, guard);
                false
            });
        }
        meaning
    }

    fn meaning(&mut self, id: ConditionId, condition: &Condition, operands: &[Guard]) -> Guard {
        match (condition, operands) {
            (Condition::Truth(true), _) => Guard::TRUE,
            (Condition::Truth(false), _) => Guard::FALSE,
            (Condition::Not(_), &[a]) => self.store.not(a),
            (Condition::And(..), &[a, b]) => self.store.and(a, b),
            (Condition::Or(..), &[a, b]) => self.store.or(a, b),
            (Condition::Is(_) | Condition::Apply { .. }, &[a]) => a,
            _ => self.atom(id),
        }
    }

    fn atom(&mut self, id: ConditionId) -> Guard {
        let analysis = self.analysis;
        match &analysis.atoms[id.0 as usize] {
            Atom::Constant(value) => [Guard::FALSE, Guard::TRUE][usize::from(*value)],
            Atom::Below(form, cut) => self.cut(form, *cut),
            Atom::Above(form, cut) => {
                let below = self.cut(form, *cut);
                self.store.not(below)
            }
            Atom::At(form, at) => self.at(form, *at),
            Atom::Off(form, at) => {
                let at = self.at(form, *at);
                self.store.not(at)
            }
            Atom::Opaque => self.store.variable(self.opaque[&id]),
        }
    }

    fn cut(&mut self, form: &Form, cut: Cut) -> Guard {
        self.store.variable(self.cuts[form][&cut])
    }

    fn at(&mut self, form: &Form, at: Rational) -> Guard {
        let (before, through) = (self.cut(form, (at, false)), self.cut(form, (at, true)));
        self.store.minus(through, before)
    }

    /// The combinations of cells that are not empty: below one cut is below all later ones, a form
    /// of integers or of a bounded type has no value in some cells, and forms that share variables
    /// exclude each other's.
    fn cells(&mut self) -> Guard {
        let mut all = Guard::TRUE;
        for group in self.groups() {
            let module = self.analysis.module;
            let mut system: Vec<_> =
                group.iter().flat_map(|(form, _)| bounds(module, form)).collect();
            let mut left = CELL_LIMIT;
            let cells = match self.joint(&group, &mut system, &mut left) {
                Some(cells) => cells,
                None => self.apart(&group),
            };
            all = self.store.and(all, cells);
        }
        all
    }

    /// The forms with their cuts and levels, those together that share variables.
    fn groups(&self) -> Vec<Vec<Chain>> {
        let mut groups: Vec<(BTreeSet<TermId>, Vec<Chain>)> = Vec::new();
        for (form, cuts) in &self.cuts {
            let chain = (form.clone(), cuts.iter().map(|(&cut, &level)| (cut, level)).collect());
            let mut merged =
                (form.iter().map(|&(term, _)| term).collect::<BTreeSet<_>>(), vec![chain]);
            let (tied, apart) = groups
                .into_iter()
                .partition::<Vec<_>, _>(|(terms, _)| !terms.is_disjoint(&merged.0));
            for (terms, chains) in tied {
                merged.0.extend(terms);
                merged.1.extend(chains);
            }
            groups = apart;
            groups.push(merged);
        }
        groups.into_iter().map(|(_, chains)| chains).collect()
    }

    /// The combinations of cells of a group that have a common point, given what `system` says
    /// already; `None` if they are too many.
    fn joint(
        &mut self,
        group: &[Chain],
        system: &mut Vec<Inequality>,
        left: &mut usize,
    ) -> Option<Guard> {
        let Some(((form, cuts), others)) = group.split_first() else { return Some(Guard::TRUE) };
        let range = Range::of(self.analysis.module, form);
        let mut cells = Guard::FALSE;
        for k in 0..=cuts.len() {
            let (after, until) = ends(cuts, k);
            if !range.is_inhabited(after, until) {
                continue;
            }
            let known = system.len();
            system.extend(inequalities(form, after, until));
            *left = left.checked_sub(1)?;
            // A form alone is feasible in every cell that its range inhabits.
            let alone = known == 0 && others.is_empty();
            if alone || feasible(system) != Some(false) {
                let rest = self.joint(others, system, left)?;
                let cell = self.cell(cuts, k);
                let cell = self.store.and(cell, rest);
                cells = self.store.or(cells, cell);
            }
            system.truncate(known);
        }
        Some(cells)
    }

    /// The cells of each form of a group, whatever the others are.
    fn apart(&mut self, group: &[Chain]) -> Guard {
        let mut all = Guard::TRUE;
        for (form, cuts) in group {
            let range = Range::of(self.analysis.module, form);
            let mut cells = Guard::FALSE;
            for k in 0..=cuts.len() {
                let (after, until) = ends(cuts, k);
                if range.is_inhabited(after, until) {
                    let cell = self.cell(cuts, k);
                    cells = self.store.or(cells, cell);
                }
            }
            all = self.store.and(all, cells);
        }
        all
    }

    fn cell(&mut self, cuts: &[(Cut, u32)], k: usize) -> Guard {
        let literals = cuts.iter().enumerate().rev();
        literals.fold(Guard::TRUE, |rest, (i, &(_, level))| {
            let (low, high) = if i >= k { (Guard::FALSE, rest) } else { (rest, Guard::FALSE) };
            self.store.node(level, low, high)
        })
    }

    /// The propositional part: true where anything is left below. Levels become those of the
    /// propositions at `places`.
    fn project(
        &self,
        f: Guard,
        places: &[usize],
        result: &mut Store,
        known: &mut FxHashMap<Guard, Guard>,
    ) -> Guard {
        let level = self.store.level(f);
        if level >= self.propositions {
            return if f == Guard::FALSE { f } else { Guard::TRUE };
        }
        if let Some(&guard) = known.get(&f) {
            return guard;
        }
        let (low, high) = self.store.branches(f);
        let low = self.project(low, places, result, known);
        let high = self.project(high, places, result, known);
        let guard = result.node(places[level as usize] as u32, low, high);
        known.insert(f, guard);
        guard
    }
}

/// A form with its cuts and their levels, rising.
type Chain = (Form, Vec<(Cut, u32)>);

/// Cell k of a chain lies between its cuts k-1 and k.
fn ends(cuts: &[(Cut, u32)], k: usize) -> (Option<Cut>, Option<Cut>) {
    (k.checked_sub(1).map(|k| cuts[k].0), cuts.get(k).map(|cut| cut.0))
}
