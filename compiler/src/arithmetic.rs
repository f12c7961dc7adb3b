//! Which letters can occur: what arithmetic knows of the predicates of a task.
//!
//! Two predicates are not free propositions when arithmetic ties them: no state has `x < 3` and
//! `x > 5`. Every comparison is brought into the form *linear form ⋚ threshold*; the thresholds of
//! one form cut the number line into cells, of which a state is in exactly one (integers between
//! two neighbours, and values outside a field's type, are in none). A decision diagram with the
//! propositions above the cuts relates the two; a valuation is possible iff the diagram below it
//! is not empty.
//!
//! Everything is exact rational arithmetic on what the source says. Forms that share variables
//! (`x < 1`, `y < 1`, `x + y > 2`) and non-linear terms count as independent of each other: sound,
//! for it only leaves letters possible that are not. So does a set of predicates too entangled to
//! relate within [`NODE_LIMIT`].

use std::collections::{BTreeMap, BTreeSet};

use rustc_hash::FxHashMap;

use crate::ast::{Arithmetic, Comparison};
use crate::dfa::{Dfa, Diagram, Target};
use crate::guard::{Guard, Store};
use crate::predicate::{Condition, ConditionId, Module, Scalar, Task, Term, TermId};

/// Diagrams of entangled predicates above this many nodes are given up.
pub const NODE_LIMIT: usize = 1 << 20;

/// The letters of a task that can occur.
pub struct Possible {
    store: Store,
    letters: Guard,
}

/// The letters that can occur: those valuations of the task's propositions that some state has.
#[must_use]
pub fn possible(module: &Module, task: &Task) -> Possible {
    let analysis = Analysis::new(module);
    let roots: Vec<ConditionId> =
        task.predicates.iter().map(|id| module.predicates[id.0 as usize].condition).collect();
    let mut possible = Possible { store: Store::default(), letters: Guard::TRUE };
    for component in analysis.components(&roots) {
        if let Some(letters) = analysis.relate(&roots, &component, &mut possible.store) {
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
            known: FxHashMap::default(),
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
        if let Some(accepting) = dfa.accepting {
            if dfa.transitions[0] == Target::to_state(accepting) {
                dfa.transitions[0] = Target::to_state(0);
                dfa.accepting = Some(0);
            }
        }
    }

    /// Writes the possible letters into an automaton, for its guards.
    pub fn attach(&self, dfa: &mut Dfa) {
        if !self.all() {
            let mut known = FxHashMap::default();
            dfa.possible = Some(self.copy(self.letters, &mut dfa.diagram, &mut known));
        }
    }

    fn copy(
        &self,
        f: Guard,
        diagram: &mut Diagram,
        known: &mut FxHashMap<Guard, Target>,
    ) -> Target {
        if f == Guard::TRUE || f == Guard::FALSE {
            return Target::to_state(u32::from(f == Guard::TRUE));
        }
        if let Some(&target) = known.get(&f) {
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
    known: FxHashMap<(Target, Guard), Option<Target>>,
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
        if let Some(&known) = self.known.get(&(target, on)) {
            return known;
        }
        let store = &self.possible.store;
        let asked = self.dfa.diagram.proposition(target).unwrap_or(u32::MAX);
        let proposition = asked.min(store.level(on));
        let (low, high) = self.dfa.diagram.split(target, proposition);
        let (on_low, on_high) =
            if store.level(on) == proposition { store.branches(on) } else { (on, on) };
        let (low, high) = (self.target(low, on_low), self.target(high, on_high));
        let restricted = match (low, high) {
            (Some(low), Some(high)) => Some(self.diagram.node(proposition, low, high)),
            (one, other) => one.or(other),
        };
        self.known.insert((target, on), restricted);
        restricted
    }
}

/// A linear form: integer coefficients without a common divisor, the first of them positive, of
/// variables, which are terms that are not linear combinations of others.
type Form = Vec<(TermId, i128)>;

/// A rational number; the denominator is positive.
#[derive(Clone, Copy, Debug)]
struct Rational {
    numerator: i128,
    denominator: i128,
}

impl PartialEq for Rational {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Rational {}

impl PartialOrd for Rational {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Rational {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        let left = self.numerator.div_euclid(self.denominator);
        let right = other.numerator.div_euclid(other.denominator);
        left.cmp(&right).then_with(|| {
            // The remainders are below their denominators, which are below 2^63.
            let left = self.numerator.rem_euclid(self.denominator) * other.denominator;
            left.cmp(&(other.numerator.rem_euclid(other.denominator) * self.denominator))
        })
    }
}

/// A cut of the number line: `(c, false)` is `form < c`, `(c, true)` is `form <= c`.
type Cut = (Rational, bool);

/// A comparison as a condition on cuts.
#[derive(Clone, Debug)]
enum Atom {
    /// Below the cut.
    Below(Form, Cut),
    /// Not below it.
    Above(Form, Cut),
    /// Exactly there.
    At(Form, Rational),
    /// Anywhere else.
    Off(Form, Rational),
    /// Always, or never.
    Constant(bool),
    /// Nothing is known but its name.
    Opaque,
}

struct Analysis<'a> {
    module: &'a Module,
    /// What each condition compares, if it does.
    atoms: Vec<Atom>,
}

/// What ties predicates together: a linear form, or a condition of unknown meaning.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Tie {
    Form(Form),
    Opaque(ConditionId),
}

impl<'a> Analysis<'a> {
    fn new(module: &'a Module) -> Self {
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
    fn components(&self, roots: &[ConditionId]) -> Vec<Vec<usize>> {
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
            | Atom::Off(form, _) => Some(Tie::Form(form.clone())),
            Atom::Constant(_) => None,
            Atom::Opaque => self.is_opaque(id).then_some(Tie::Opaque(id)),
        };
        self.needed(&[root]).into_iter().filter_map(tie).collect()
    }

    fn is_opaque(&self, id: ConditionId) -> bool {
        let condition = self.module.arena.condition(id);
        self.operands(condition).is_empty() && !matches!(condition, Condition::Truth(_))
    }

    fn operands(&self, condition: &Condition) -> Vec<ConditionId> {
        match *condition {
            Condition::Not(a) => vec![a],
            Condition::And(a, b) | Condition::Or(a, b) => vec![a, b],
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
    fn relate(&self, roots: &[ConditionId], places: &[usize], result: &mut Store) -> Option<Guard> {
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
            (Condition::Is(_), &[a]) => a,
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

    /// The cells that are not empty: below one cut is below all later ones, and a form of integers
    /// or of a bounded type has no value in some cells.
    fn cells(&mut self) -> Guard {
        let mut all = Guard::TRUE;
        let forms: Vec<_> =
            self.cuts.iter().map(|(form, cuts)| (form.clone(), cuts.clone())).collect();
        for (form, cuts) in forms {
            let range = Range::of(self.analysis.module, &form);
            let cuts: Vec<_> = cuts.into_iter().collect();
            // Value k of the chain: the form lies between cut k-1 and cut k.
            let mut cells = Guard::FALSE;
            for k in 0..=cuts.len() {
                let after = k.checked_sub(1).map(|k| cuts[k].0);
                let until = cuts.get(k).map(|cut| cut.0);
                if range.is_inhabited(after, until) {
                    let cell = self.cell(&cuts, k);
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

/// The values that a form can take.
struct Range {
    integer: bool,
    least: Option<i128>,
    greatest: Option<i128>,
}

impl Range {
    fn of(module: &Module, form: &Form) -> Self {
        let scalar = |term: &TermId| match module.arena.term(*term) {
            Term::Place { scalar: Scalar::Number(name), .. } => integer_range(name),
            _ => None,
        };
        let integer = form.iter().all(|(term, _)| scalar(term).is_some());
        match form.as_slice() {
            [(term, 1)] if integer => {
                let (least, greatest) = scalar(term).unwrap_or((i128::MIN, i128::MAX));
                Self { integer, least: Some(least), greatest: Some(greatest) }
            }
            _ => Self { integer, least: None, greatest: None },
        }
    }

    /// Whether there is a value not below `after` and below `until`.
    fn is_inhabited(&self, after: Option<Cut>, until: Option<Cut>) -> bool {
        if !self.integer {
            return true;
        }
        // The least integer not below a cut.
        let first = |(at, inclusive): Cut| {
            let floor = at.numerator.div_euclid(at.denominator);
            let whole = floor * at.denominator == at.numerator;
            if whole && !inclusive { floor } else { floor + 1 }
        };
        let least = after.map(first).into_iter().chain(self.least).max();
        let end = until.map(first).into_iter().chain(self.greatest.map(|last| last + 1)).min();
        least.zip(end).is_none_or(|(least, end)| least < end)
    }
}

fn integer_range(name: &str) -> Option<(i128, i128)> {
    Some(match name {
        "i8" => (i8::MIN.into(), i8::MAX.into()),
        "i16" => (i16::MIN.into(), i16::MAX.into()),
        "i32" => (i32::MIN.into(), i32::MAX.into()),
        "i64" => (i64::MIN.into(), i64::MAX.into()),
        "u8" => (0, u8::MAX.into()),
        "u16" => (0, u16::MAX.into()),
        "u32" => (0, u32::MAX.into()),
        "u64" => (0, u64::MAX.into()),
        _ => return None,
    })
}

/// A sum of variables with coefficients, and a constant; all over one denominator.
#[derive(Clone, Debug, Default)]
struct Linear {
    coefficients: BTreeMap<TermId, i128>,
    constant: i128,
    /// A power of two.
    denominator: i128,
}

/// Coefficients stay below this, so that products of two fit.
const SMALL: i128 = 1 << 62;

impl Linear {
    fn number(value: f64) -> Option<Self> {
        let mut denominator = 1_i128;
        let mut scaled = value;
        while scaled.fract() != 0.0 {
            scaled *= 2.0;
            denominator *= 2;
            if denominator >= SMALL {
                return None;
            }
        }
        // 2^62 is exact in both types.
        (scaled.abs() < SMALL as f64).then(|| Self {
            coefficients: BTreeMap::new(),
            constant: scaled as i128,
            denominator,
        })
    }

    fn variable(term: TermId) -> Self {
        Self { coefficients: BTreeMap::from([(term, 1)]), constant: 0, denominator: 1 }
    }

    /// The sum `self + factor × other`.
    fn plus(&self, factor: i128, other: &Self) -> Option<Self> {
        let mut sum = Self {
            denominator: small(self.denominator.checked_mul(other.denominator)?)?,
            ..Self::default()
        };
        let terms = self.coefficients.keys().chain(other.coefficients.keys());
        let combine = |a: i128, b: i128| -> Option<i128> {
            let a = a.checked_mul(other.denominator)?;
            small(a.checked_add(factor.checked_mul(b)?.checked_mul(self.denominator)?)?)
        };
        for &term in terms {
            let of = |linear: &Self| linear.coefficients.get(&term).copied().unwrap_or(0);
            let coefficient = combine(of(self), of(other))?;
            if coefficient != 0 {
                sum.coefficients.insert(term, coefficient);
            }
        }
        sum.constant = combine(self.constant, other.constant)?;
        Some(sum)
    }

    /// The product, if one of the two is a number.
    fn times(&self, other: &Self) -> Option<Self> {
        let (linear, factor) = match (self.coefficients.is_empty(), other.coefficients.is_empty()) {
            (_, true) => (self, other),
            (true, _) => (other, self),
            _ => return None,
        };
        let scale = |value: i128| small(value.checked_mul(factor.constant)?);
        let mut product = Self {
            coefficients: BTreeMap::new(),
            constant: scale(linear.constant)?,
            denominator: small(linear.denominator.checked_mul(factor.denominator)?)?,
        };
        for (&term, &coefficient) in &linear.coefficients {
            let coefficient = scale(coefficient)?;
            if coefficient != 0 {
                product.coefficients.insert(term, coefficient);
            }
        }
        Some(product)
    }

    /// The quotient by a number.
    fn over(&self, other: &Self) -> Option<Self> {
        if !other.coefficients.is_empty() || other.constant == 0 {
            return None;
        }
        let sign = other.constant.signum();
        let inverse = Self {
            coefficients: BTreeMap::new(),
            constant: sign * other.denominator,
            denominator: other.constant.abs(),
        };
        self.times(&inverse)
    }
}

fn small(value: i128) -> Option<i128> {
    (value.abs() < SMALL).then_some(value)
}

/// Every term as a linear combination of terms that are none.
fn linear_terms(module: &Module) -> Vec<Linear> {
    let mut linear: Vec<Linear> = Vec::with_capacity(module.arena.terms().len());
    for (index, term) in module.arena.terms().iter().enumerate() {
        let of = |id: &TermId| &linear[id.0 as usize];
        let combined = match term {
            Term::Number(number) => Linear::number(number.0),
            Term::Negate(a) => Linear::number(0.0).and_then(|zero| zero.plus(-1, of(a))),
            Term::Calculate(Arithmetic::Add, a, b) => of(a).plus(1, of(b)),
            Term::Calculate(Arithmetic::Subtract, a, b) => of(a).plus(-1, of(b)),
            Term::Calculate(Arithmetic::Multiply, a, b) => of(a).times(of(b)),
            Term::Calculate(Arithmetic::Divide, a, b) => of(a).over(of(b)),
            _ => None,
        };
        linear.push(combined.unwrap_or_else(|| Linear::variable(TermId(index as u32))));
    }
    linear
}

/// A comparison of two linear terms; `None` if its numbers are too large for exact arithmetic.
fn atom(module: &Module, comparison: Comparison, a: &Linear, b: &Linear) -> Option<Atom> {
    let difference = a.plus(-1, b)?;
    if difference.coefficients.is_empty() {
        return Some(Atom::Constant(comparison.holds(difference.constant as f64, 0.0)));
    }
    if difference.coefficients.keys().any(|term| module.arena.constant(*term).is_some()) {
        // A number too large or too fine for exact arithmetic.
        return None;
    }
    let divisor = difference.coefficients.values().fold(0, |a, &b| gcd(a, b.abs()));
    let first = *difference.coefficients.values().next()?;
    let divisor = divisor * first.signum();
    let form: Form =
        difference.coefficients.iter().map(|(&term, &c)| (term, c / divisor)).collect();
    let sign = divisor.signum();
    let at = Rational { numerator: -difference.constant * sign, denominator: divisor.abs() };
    let comparison = if sign < 0 { comparison.mirrored() } else { comparison };
    Some(match comparison {
        Comparison::Less => Atom::Below(form, (at, false)),
        Comparison::AtMost => Atom::Below(form, (at, true)),
        Comparison::Greater => Atom::Above(form, (at, true)),
        Comparison::AtLeast => Atom::Above(form, (at, false)),
        Comparison::Equal => Atom::At(form, at),
        Comparison::Unequal => Atom::Off(form, at),
    })
}

fn gcd(a: i128, b: i128) -> i128 {
    if b == 0 { a } else { gcd(b, a % b) }
}
