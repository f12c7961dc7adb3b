//! How the propositions of a task are related by the cuts that they compare with.
//!
//! One decision diagram has a level for each cut and each opaque condition. Being below a cut
//! implies being below all higher ones, so the cuts of a form are a
//! [chain](crate::bdd#chains-of-levels), from the highest down, and an interval is two nodes however
//! many cuts there are. The cells that have a point are a function of these levels, and so is each
//! proposition. The letters that can occur are found by asking one proposition after the other: a
//! node for a proposition leads to the letters of the cells in which it holds, and of those in
//! which it does not.
//!
//! Propositions that share neither a variable nor an opaque condition are related apart, so the
//! diagram stays small however many predicates a task has.
//!
//! ```
//! use tltl_compiler::{arithmetic, check, source::Source};
//!
//! let module = check::formula(&Source::new("formula", "F (x < 1) && F (y < 1) && F (x + y > 3)"))?;
//! let possible = arithmetic::possible(&module, &module.tasks[0]);
//! // No two of the three exclude each other; all three do.
//! assert!(!possible.excludes(&[(0, true), (1, true)]) && !possible.excludes(&[(0, true), (2, true)]));
//! assert!(possible.excludes(&[(0, true), (1, true), (2, true)]));
//! # Ok::<(), tltl_compiler::error::Errors>(())
//! ```

use crate::arena::{self, Memo};
use crate::bdd::{Bdd, Diagram};
use crate::linear::{Form, Inequality, circuits, feasible};
use crate::predicate::{Condition, ConditionId, Module, TermId};

use super::form::{Atom, Cut, LinearTerms, Range, Rational, atom, bounds, inequalities};
use super::{NODE_LIMIT, WORK_LIMIT};

/// The comparisons of some conditions as atoms, computed once. Only of those conditions: a file may
/// have a thousand tasks, and each asks for its own.
pub(super) struct Analysis<'a> {
    module: &'a Module,
    /// The conditions that are needed, rising.
    needed: Vec<ConditionId>,
    /// The atom of each of them; [`Atom::Opaque`] for those that are not comparisons.
    atoms: Vec<Atom>,
}

impl<'a> Analysis<'a> {
    /// The atoms of all conditions that `roots` are made of.
    pub(super) fn new(module: &'a Module, roots: &[ConditionId]) -> Self {
        let needed = module.conditions_of(roots.to_vec());
        let linear = LinearTerms::new(module, module.terms_of(&needed));
        let atom = |id: &ConditionId| match module.arena.condition(*id) {
            Condition::Compare(comparison, a, b) => {
                atom(module, *comparison, linear.of(*a), linear.of(*b)).unwrap_or(Atom::Opaque)
            }
            _ => Atom::Opaque,
        };
        let atoms = needed.iter().map(atom).collect();
        Self { module, needed, atoms }
    }

    /// The atom of a condition that is needed.
    fn atom(&self, id: ConditionId) -> &Atom {
        &self.atoms[self.needed.binary_search(&id).expect("a condition that is needed")]
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
            match self.atom(id) {
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
        let mut relation = Relation::new(self, &needed)?;
        let meanings = relation.meanings(&needed);
        let cells = relation.cells();
        let mut asked = Vec::new();
        for (&place, condition) in places.iter().zip(conditions) {
            let holds = meanings.get(condition).expect("all that is needed has a meaning");
            asked.push(Asked { level: place as u32, holds, last: Vec::new() });
        }
        relation.note_last_uses(&mut asked);
        relation.letters(cells, &asked, result)
    }
}

/// A proposition whose value is asked.
struct Asked {
    /// Its level in the diagram of the result.
    level: u32,
    /// The cells in which it holds.
    holds: Bdd,
    /// The chains and opaque conditions that no later proposition depends on, as ranges of levels.
    last: Vec<(u32, u32)>,
}

/// A relation under construction.
struct Relation<'a> {
    analysis: &'a Analysis<'a>,
    /// Functions of cuts and opaque conditions.
    diagram: Diagram,
    /// How many sets of cells may still be looked at.
    left: usize,
    /// The letters of a set of cells, by the propositions asked before; those are in the diagram of
    /// the result.
    letters: Memo<(u32, Bdd), Bdd>,
    /// The forms that are compared, rising, with their cuts.
    chains: Vec<Chain>,
    /// The opaque conditions, rising; their levels follow on those of the cuts.
    opaque: Vec<ConditionId>,
    first_opaque: u32,
}

impl<'a> Relation<'a> {
    /// Gives levels to the cuts and opaque conditions of some conditions; `None` if they are more
    /// than a diagram may have.
    fn new(analysis: &'a Analysis<'a>, needed: &[ConditionId]) -> Option<Self> {
        let mut chains: Vec<Chain> = Vec::new();
        let mut opaque = Vec::new();
        for &id in needed {
            match analysis.atom(id) {
                Atom::Below(form, cut) | Atom::Above(form, cut) => add(&mut chains, form, &[*cut]),
                Atom::At(form, at) | Atom::Off(form, at) => {
                    add(&mut chains, form, &[(*at, false), (*at, true)]);
                }
                Atom::Opaque if analysis.is_opaque(id) => opaque.push(id),
                Atom::Constant(_) | Atom::Opaque => {}
            }
        }
        // The types of variables relate forms too.
        let terms: Vec<TermId> =
            chains.iter().flat_map(|chain| &chain.form).map(|known| known.0).collect();
        for term in terms {
            if bounds(analysis.module, term).is_some() {
                add(&mut chains, &vec![(term, 1)], &[]);
            }
        }
        let (mut level, mut ranges) = (0, Vec::new());
        for chain in chains.iter_mut().filter(|chain| !chain.cuts.is_empty()) {
            chain.level = level;
            level += chain.cuts.len() as u32;
            ranges.push(chain.range());
        }
        let fits = level as usize + opaque.len() < Diagram::MAX_LEVELS as usize;
        let first_opaque = level;
        fits.then(|| Self {
            analysis,
            diagram: Diagram::with_limit(NODE_LIMIT).chained(ranges),
            left: NODE_LIMIT,
            letters: Memo::default(),
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
        match analysis.atom(id) {
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
        self.diagram.variable(chain.level_of(place))
    }

    /// The function that is true iff the form is equal to a number: below the cut after it, and not
    /// below the cut before.
    fn at(&mut self, form: &Form, at: Rational) -> Bdd {
        let (before, through) = (self.cut(form, (at, false)), self.cut(form, (at, true)));
        self.diagram.minus(through, before)
    }

    /// The combinations of cells that have a point: a form of integers or of a bounded type has no
    /// value in some cells, and forms that depend on each other exclude each other's cells.
    fn cells(&mut self) -> Bdd {
        let chains = std::mem::take(&mut self.chains);
        let forms: Vec<&Form> = chains.iter().map(|chain| &chain.form).collect();
        let ties = circuits(&forms).unwrap_or_else(|| vec![vec![0]; forms.len()]);
        let mut all = Bdd::TRUE;
        for group in arena::groups(&ties) {
            let group: Vec<&Chain> = group.iter().map(|&place| &chains[place]).collect();
            let cells = self.related(&group).unwrap_or_else(|| self.apart(&group));
            all = self.diagram.and(all, cells);
        }
        self.chains = chains;
        all
    }

    /// The combinations of cells of a group of forms that have a common point; `None` if finding
    /// them takes more than [`WORK_LIMIT`], or if there is only one form.
    fn related(&mut self, group: &[&Chain]) -> Option<Bdd> {
        let mut system = Vec::new();
        for chain in group {
            if let [(variable, _)] = chain.form[..] {
                system.extend(bounds(self.analysis.module, variable).into_iter().flatten());
            }
        }
        let mut work = WORK_LIMIT;
        (group.len() > 1).then(|| self.joint(group, &mut system, &mut work))?
    }

    /// The combinations of cells of a group of forms that have a common point, given the
    /// inequalities of `system`; `None` if finding them takes more than `work`.
    ///
    /// Depth-first over the forms: an infeasible prefix of cells prunes all of its continuations.
    fn joint(
        &mut self,
        group: &[&Chain],
        system: &mut Vec<Inequality>,
        work: &mut usize,
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
            let feasible = feasible(system, work);
            if *work == 0 {
                return None;
            }
            if feasible != Some(false) {
                let rest = self.joint(others, system, work)?;
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

    /// Cell `k` of a form: below cut `k`, and not below the one before.
    fn cell(&mut self, chain: &Chain, k: usize) -> Bdd {
        let low = match k.checked_sub(1) {
            Some(before) => self.diagram.literal((chain.level_of(before), false)),
            None => Bdd::TRUE,
        };
        match chain.cuts.get(k) {
            Some(_) => self.diagram.node(chain.level_of(k), Bdd::FALSE, low),
            None => low,
        }
    }

    /// Finds for each range of levels, a chain's or that of an opaque condition, the last
    /// proposition that depends on it.
    fn note_last_uses(&self, asked: &mut [Asked]) {
        let chains = self.chains.iter().filter(|chain| !chain.cuts.is_empty());
        let mut ranges: Vec<(u32, u32)> = chains.map(Chain::range).collect();
        let opaque = self.first_opaque..self.first_opaque + self.opaque.len() as u32;
        ranges.extend(opaque.map(|level| (level, level)));
        let mut is_used = vec![false; ranges.len()];
        for asked in asked.iter_mut().rev() {
            for id in self.diagram.postorder(&[asked.holds]) {
                let level = self.diagram.nodes()[id as usize].level;
                let range = ranges.partition_point(|range| range.1 < level);
                if !std::mem::replace(&mut is_used[range], true) {
                    asked.last.push(ranges[range]);
                }
            }
        }
    }

    /// The letters of some cells: the valuations of the propositions in `asked` that they have, over
    /// the levels that are given there. `None` if that exceeds a limit. Recurses once a proposition.
    ///
    /// What no later proposition depends on is quantified away at once: cells that differ only
    /// there are then one question.
    fn letters(&mut self, cells: Bdd, asked: &[Asked], result: &mut Diagram) -> Option<Bdd> {
        if cells == Bdd::FALSE {
            return Some(Bdd::FALSE);
        }
        let Some((next, others)) = asked.split_first() else { return Some(Bdd::TRUE) };
        let key = (asked.len() as u32, cells);
        if let Some(known) = self.letters.get(key) {
            return Some(known);
        }
        self.left = self.left.checked_sub(1)?;
        let mut sides =
            [self.diagram.minus(cells, next.holds), self.diagram.and(cells, next.holds)];
        for side in &mut sides {
            for &(first, last) in &next.last {
                *side = self.diagram.exists(*side, first, last);
            }
            if self.diagram.is_exhausted() {
                return None;
            }
            *side = self.letters(*side, others, result)?;
        }
        let letters = result.node(next.level, sides[0], sides[1]);
        self.letters.insert(key, letters);
        Some(letters)
    }
}

/// A form and its cuts.
struct Chain {
    form: Form,
    /// The cuts, rising, each once.
    cuts: Vec<Cut>,
    /// The level of the last cut; those of the others follow, the first one is the lowest.
    level: u32,
}

impl Chain {
    /// The first and the last level.
    fn range(&self) -> (u32, u32) {
        (self.level, self.level + self.cuts.len() as u32 - 1)
    }

    /// The level of a cut.
    fn level_of(&self, cut: usize) -> u32 {
        self.level + (self.cuts.len() - 1 - cut) as u32
    }

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
