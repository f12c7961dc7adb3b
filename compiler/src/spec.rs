//! The meaning of a formula: propositions and operators in negation normal form.
//!
//! # Invariants
//!
//! A value of type [`Spec`] is co-safe by construction: only propositions can be negated, and every
//! operator is one that a finite prefix can satisfy for good (Kupferman and Vardi, "Model Checking
//! of Safety Properties", 2001). Release, *always* and weak operators cannot be written. So no
//! later stage asks whether a formula is in the fragment.
//!
//! Formulas live in an arena, operands before the operators that use them, so every pass is a loop,
//! never a recursion, and no input is too deep. The constructors hash-cons: equal formulas have
//! equal ids.
//!
//! # Simplification
//!
//! The constructors apply only laws that hold at every instant of every finite trajectory and for
//! robustness too, such as φ ∧ ⊤ = φ or ◇◇φ = ◇φ. Nothing is ever simplified to ⊤ under ○: `X true`
//! asks for a second state. Laws that shorten a formula but change what is shared (distribution)
//! are left to the automaton, whose minimization finds all of them.
//!
//! ```
//! use tltl_compiler::{source::Span, spec::{Formula, Spec}};
//!
//! let mut spec = Spec::new(vec!["a".into(), "b".into()]);
//! let at = Span::default();
//! let [a, b] = [0, 1].map(|proposition| spec.literal(proposition, false, at));
//! let later = spec.eventually(b, at);
//! // a U F b holds iff F b does.
//! assert_eq!(spec.until(a, later, at), later);
//! let then = spec.then(a, b, at);
//! assert_eq!(spec.formula(then), Formula::Then(a, later));
//! spec.set_root(then);
//! assert_eq!(spec.to_string(), "a T b");
//! ```

mod bounded;
mod print;

pub use print::Printed;

use crate::arena;
use crate::intern::Interner;
use crate::proposition::Proposition;
use crate::source::Span;

/// A formula of a [`Spec`]: an index into its arena. Ids of one spec are equal iff their formulas
/// are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct FormulaId(pub u32);

arena::id! { FormulaId }

/// One operator of a formula in negation normal form, over operands of the same spec.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Formula {
    /// ⊤
    True,
    /// ⊥
    False,
    /// A proposition of the spec, by its position in [`Spec::propositions`], or its negation.
    Literal {
        /// Position in [`Spec::propositions`].
        proposition: u32,
        /// Whether it is negated.
        negated: bool,
    },
    /// φ ∧ ψ
    And(FormulaId, FormulaId),
    /// φ ∨ ψ
    Or(FormulaId, FormulaId),
    /// ○φ, strong: there must be a next state.
    Next(FormulaId),
    /// X\[n\] φ: φ at the instant n steps from now, which must exist; n ≥ 2, for X\[1\] φ is ○φ.
    Delay(u32, FormulaId),
    /// ◇φ
    Eventually(FormulaId),
    /// F\[0,n\] φ: φ now or at one of the next n instants; n ≥ 1.
    Within(u32, FormulaId),
    /// G\[0,n\] φ, strong: φ now and at each of the next n instants, which must exist; n ≥ 1.
    Throughout(u32, FormulaId),
    /// φ U ψ, strong: ψ must come.
    Until(FormulaId, FormulaId),
    /// φ U\[0,n\] ψ: ψ now or at one of the next n instants, φ at each instant before; n ≥ 1.
    UntilWithin(u32, FormulaId, FormulaId),
    /// φ T ψ = ◇(φ ∧ ○◇ψ): the operands are φ and ◇ψ, which is an operator of its own, for it
    /// becomes an obligation of its own.
    Then(FormulaId, FormulaId),
}

impl Formula {
    /// The operands, left to right.
    ///
    /// ```
    /// use tltl_compiler::spec::{Formula, FormulaId};
    ///
    /// let [a, b] = [0, 1].map(FormulaId);
    /// assert_eq!(Formula::Until(a, b).operands().collect::<Vec<_>>(), [a, b]);
    /// assert_eq!(Formula::True.operands().count(), 0);
    /// ```
    pub fn operands(self) -> impl DoubleEndedIterator<Item = FormulaId> {
        let (first, second) = match self {
            Self::True | Self::False | Self::Literal { .. } => (None, None),
            Self::Next(a) | Self::Delay(_, a) | Self::Eventually(a) => (Some(a), None),
            Self::Within(_, a) | Self::Throughout(_, a) => (Some(a), None),
            Self::And(a, b) | Self::Or(a, b) => (Some(a), Some(b)),
            Self::Until(a, b) | Self::UntilWithin(_, a, b) | Self::Then(a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second)
    }

    /// Whether the operator relates instants.
    ///
    /// ```
    /// use tltl_compiler::spec::{Formula, FormulaId};
    ///
    /// let [a, b] = [0, 1].map(FormulaId);
    /// assert!(Formula::Within(3, a).is_temporal() && !Formula::And(a, b).is_temporal());
    /// ```
    #[must_use]
    pub fn is_temporal(self) -> bool {
        !matches!(
            self,
            Self::True | Self::False | Self::Literal { .. } | Self::And(..) | Self::Or(..)
        )
    }

    /// The same operator over the images of its operands.
    #[must_use]
    fn over(self, mut image: impl FnMut(FormulaId) -> FormulaId) -> Self {
        match self {
            Self::True | Self::False | Self::Literal { .. } => self,
            Self::And(a, b) => Self::And(image(a), image(b)),
            Self::Or(a, b) => Self::Or(image(a), image(b)),
            Self::Next(a) => Self::Next(image(a)),
            Self::Delay(n, a) => Self::Delay(n, image(a)),
            Self::Eventually(a) => Self::Eventually(image(a)),
            Self::Within(n, a) => Self::Within(n, image(a)),
            Self::Throughout(n, a) => Self::Throughout(n, image(a)),
            Self::Until(a, b) => Self::Until(image(a), image(b)),
            Self::UntilWithin(n, a, b) => Self::UntilWithin(n, image(a), image(b)),
            Self::Then(a, b) => Self::Then(image(a), image(b)),
        }
    }
}

/// A formula over propositions: hash-consed, in negation normal form, co-safe.
///
/// Invariants: operands stand before the operators that use them; `spans` has one entry for each.
#[derive(Clone, Debug)]
pub struct Spec {
    propositions: Vec<Proposition>,
    formulas: Interner<Formula>,
    spans: Vec<Span>,
    root: FormulaId,
}

impl Spec {
    /// A spec over `propositions`, all different. Its formula is `true` until
    /// [`set_root`](Self::set_root) sets another.
    #[must_use]
    pub fn new(propositions: Vec<Proposition>) -> Self {
        let mut spec = Self {
            propositions,
            formulas: Interner::default(),
            spans: Vec::new(),
            root: FormulaId(0),
        };
        spec.root = spec.intern(Formula::True, Span::default());
        spec
    }

    /// The propositions, in order of first appearance in the source. Some may not
    /// occur in the formula any more: simplification can remove the last occurrence.
    #[must_use]
    pub fn propositions(&self) -> &[Proposition] {
        &self.propositions
    }

    /// The formula as a whole.
    #[must_use]
    pub fn root(&self) -> FormulaId {
        self.root
    }

    /// Makes `root` the formula as a whole.
    pub fn set_root(&mut self, root: FormulaId) {
        self.root = root;
    }

    /// The operator of `id`.
    #[must_use]
    pub fn formula(&self, id: FormulaId) -> Formula {
        self.formulas.things()[id.0 as usize]
    }

    /// All operators, operands first. Some may not be reachable from the root.
    pub fn formulas(
        &self,
    ) -> impl ExactSizeIterator<Item = (FormulaId, Formula)> + DoubleEndedIterator {
        self.formulas
            .things()
            .iter()
            .enumerate()
            .map(|(i, &formula)| (FormulaId(i as u32), formula))
    }

    /// The place of `id` in the source; the first one, for equal formulas are one.
    #[must_use]
    pub fn span(&self, id: FormulaId) -> Span {
        self.spans[id.0 as usize]
    }

    /// For each operator whether the root depends on it.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["a".into(), "b".into()]);
    /// let at = Span::default();
    /// let a = spec.literal(0, false, at);
    /// let b = spec.literal(1, false, at);
    /// spec.set_root(a);
    /// let reachable = spec.reachable();
    /// assert!(reachable[a.0 as usize] && !reachable[b.0 as usize]);
    /// ```
    #[must_use]
    pub fn reachable(&self) -> Vec<bool> {
        let mut reachable = vec![false; self.spans.len()];
        reachable[self.root.0 as usize] = true;
        for (id, formula) in self.formulas().rev() {
            if reachable[id.0 as usize] {
                formula.operands().for_each(|operand| reachable[operand.0 as usize] = true);
            }
        }
        reachable
    }

    /// ⊤ or ⊥
    pub fn truth(&mut self, value: bool, span: Span) -> FormulaId {
        self.intern(if value { Formula::True } else { Formula::False }, span)
    }

    /// A proposition or its negation.
    pub fn literal(&mut self, proposition: u32, negated: bool, span: Span) -> FormulaId {
        self.intern(Formula::Literal { proposition, negated }, span)
    }

    /// φ ∧ ψ. A chain keeps the order in which it was written: that order becomes the order of
    /// levels.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["a".into()]);
    /// let at = Span::default();
    /// let a = spec.literal(0, false, at);
    /// let truth = spec.truth(true, at);
    /// assert_eq!(spec.and(truth, a, at), a);
    /// assert_eq!(spec.and(a, a, at), a);
    /// ```
    pub fn and(&mut self, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        match (self.formula(a), self.formula(b)) {
            (Formula::True, _) => b,
            (_, Formula::True) => a,
            (Formula::False, _) => a,
            (_, Formula::False) => b,
            _ if a == b => a,
            _ => self.intern(Formula::And(a, b), span),
        }
    }

    /// φ ∨ ψ
    pub fn or(&mut self, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        match (self.formula(a), self.formula(b)) {
            (Formula::False, _) => b,
            (_, Formula::False) => a,
            (Formula::True, _) => a,
            (_, Formula::True) => b,
            _ if a == b => a,
            _ => self.intern(Formula::Or(a, b), span),
        }
    }

    /// ○φ. `X false` is false; `X true` is not true.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::{Formula, Spec}};
    ///
    /// let mut spec = Spec::new(Vec::new());
    /// let at = Span::default();
    /// let [yes, no] = [true, false].map(|value| spec.truth(value, at));
    /// assert_eq!(spec.next(no, at), no);
    /// // It asks for one more state.
    /// let next = spec.next(yes, at);
    /// assert_eq!(spec.formula(next), Formula::Next(yes));
    /// ```
    pub fn next(&mut self, a: FormulaId, span: Span) -> FormulaId {
        match self.formula(a) {
            Formula::False => a,
            Formula::Delay(n, b) if n < u32::MAX => self.intern(Formula::Delay(n + 1, b), span),
            _ => self.intern(Formula::Next(a), span),
        }
    }

    /// ◇φ. An operator that is satisfied later whenever it is satisfied now, ◇ and T, absorbs it;
    /// it absorbs F\[0,n\].
    pub fn eventually(&mut self, a: FormulaId, span: Span) -> FormulaId {
        match self.formula(a) {
            Formula::True | Formula::False | Formula::Eventually(_) | Formula::Then(..) => a,
            Formula::Within(_, b) => self.eventually(b, span),
            Formula::Delay(n, b) => {
                let later = self.eventually(b, span);
                self.delay(n, later, span)
            }
            _ => self.intern(Formula::Eventually(a), span),
        }
    }

    /// φ U ψ. Where ψ may wait by itself (◇ψ, or the same φ U ψ again), the outer until adds
    /// nothing.
    pub fn until(&mut self, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        match (self.formula(a), self.formula(b)) {
            (_, Formula::True | Formula::False) | (Formula::False, _) => b,
            (Formula::True, _) => self.eventually(b, span),
            (_, Formula::Until(c, _)) if a == c => b,
            (_, Formula::UntilWithin(_, c, d)) if a == c => self.until(a, d, span),
            (_, Formula::Eventually(_) | Formula::Then(..)) => b,
            _ if a == b => a,
            _ => self.intern(Formula::Until(a, b), span),
        }
    }

    /// φ T ψ, as the conjunction of φ now and ◇ψ from the next state on, sometime.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["pick".into(), "place".into()]);
    /// let at = Span::default();
    /// let [pick, place] = [0, 1].map(|proposition| spec.literal(proposition, false, at));
    /// let sequence = spec.then(pick, place, at);
    /// // Waiting for a sequence is the sequence itself.
    /// assert_eq!(spec.eventually(sequence, at), sequence);
    /// assert_eq!(spec.display(sequence).to_string(), "pick T place");
    /// ```
    pub fn then(&mut self, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        match (self.formula(a), self.formula(b)) {
            (Formula::False, _) => a,
            (_, Formula::False) => b,
            _ => {
                let b = self.eventually(b, span);
                self.intern(Formula::Then(a, b), span)
            }
        }
    }

    /// An operator over formulas of this spec, simplified as its own constructor simplifies it.
    pub fn add(&mut self, formula: Formula, span: Span) -> FormulaId {
        match formula {
            Formula::True | Formula::False | Formula::Literal { .. } => self.intern(formula, span),
            Formula::And(a, b) => self.and(a, b, span),
            Formula::Or(a, b) => self.or(a, b, span),
            Formula::Next(a) => self.next(a, span),
            Formula::Delay(n, a) => self.delay(n, a, span),
            Formula::Eventually(a) => self.eventually(a, span),
            Formula::Within(n, a) => self.within(n, a, span),
            Formula::Throughout(n, a) => self.throughout(n, a, span),
            Formula::Until(a, b) => self.until(a, b, span),
            Formula::UntilWithin(n, a, b) => self.until_within(n, a, b, span),
            Formula::Then(a, b) => self.then(a, b, span),
        }
    }

    /// Rebuilds formulas of `other` in this spec, and returns the image of each, in order.
    ///
    /// `ids` rise, and hold the operands of every formula among them. `image` makes one formula:
    /// it gets the formula's id in `other`, and its operator over the images of its operands, which
    /// [`add`](Self::add) takes as it is.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::{Formula, Spec}};
    ///
    /// let at = Span::default();
    /// let mut one = Spec::new(vec!["a".into()]);
    /// let a = one.literal(0, false, at);
    /// let goal = one.eventually(a, at);
    /// // The same formula over another proposition.
    /// let mut other = Spec::new(vec!["x".into(), "y".into()]);
    /// let images = other.rebuild(&one, &[a, goal], &mut |other, _, formula| match formula {
    ///     Formula::Literal { negated, .. } => other.literal(1, negated, at),
    ///     formula => other.add(formula, at),
    /// });
    /// assert_eq!(other.display(images[1]).to_string(), "F y");
    /// ```
    ///
    /// # Panics
    /// If `ids` lack an operand.
    pub fn rebuild(
        &mut self,
        other: &Self,
        ids: &[FormulaId],
        image: &mut dyn FnMut(&mut Self, FormulaId, Formula) -> FormulaId,
    ) -> Vec<FormulaId> {
        let mut images = Vec::with_capacity(ids.len());
        for &id in ids {
            let place = |operand| ids.binary_search(&operand).expect("operands are among the ids");
            let formula = other.formula(id).over(|operand| images[place(operand)]);
            images.push(image(self, id, formula));
        }
        images
    }

    /// The id of an operator, which is added if it is new; the first span stays.
    fn intern(&mut self, formula: Formula, span: Span) -> FormulaId {
        let id = self.formulas.intern(formula);
        if id as usize == self.spans.len() {
            self.spans.push(span);
        }
        FormulaId(id)
    }
}
