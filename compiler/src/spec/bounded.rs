//! Operators with bounds, and `ensuring`: how each is written in the operators of a [`Spec`].
//!
//! Four operators carry a bound: [`Formula::Delay`], [`Formula::Within`], [`Formula::Throughout`]
//! and [`Formula::UntilWithin`]. All others are abbreviations of these, and this module is the one
//! place that says of what:
//!
//! ```text
//! F[a,b] φ        =  X[a] F[0,b-a] φ
//! G[a,b] φ        =  X[a] G[0,b-a] φ
//! φ U[a,b] ψ      =  G[0,a-1] φ && X[a] (φ U[0,b-a] ψ)
//! φ T[a,b] ψ      =  F (φ && F[a,b] ψ)
//! ```
//!
//! A bound is a number and never a chain of operators, so that a formula takes as much space with
//! `F[0,1000000]` as with `F[0,1]`.
//!
//! # Laws
//!
//! All constructors accept a bound of 0, where the operator adds nothing. Delays add up and come
//! outermost (`F[0,n] X[m] φ` is `X[m] F[0,n] φ`), bounds of one operator over itself add up, and
//! nothing that asks for more states becomes true: `G[0,n] true` is `X[n] true`.
//!
//! ```
//! use tltl_compiler::{source::Span, spec::Spec};
//!
//! let mut spec = Spec::new(vec!["a".into(), "b".into()]);
//! let at = Span::default();
//! let [a, b] = [0, 1].map(|proposition| spec.literal(proposition, false, at));
//! let soon = spec.within(3, a, at);
//! assert_eq!(spec.within(2, soon, at), spec.within(5, a, at));
//! assert_eq!(spec.within(0, a, at), a);
//! let between = spec.eventually_in(2..=5, a, at);
//! assert_eq!(spec.display(between).to_string(), "F[2,5] a");
//! let until = spec.until_in(1..=4, a, b, at);
//! assert_eq!(spec.display(until).to_string(), "a && X (a U[0,3] b)");
//! ```

use std::ops::RangeInclusive;

use super::{Formula, FormulaId, Spec};
use crate::arena::{self, Memo};
use crate::source::Span;

impl Formula {
    /// The bound of an operator that has one.
    pub(crate) fn bound(self) -> Option<u32> {
        match self {
            Self::Delay(n, _) | Self::Within(n, _) => Some(n),
            Self::Throughout(n, _) | Self::UntilWithin(n, ..) => Some(n),
            _ => None,
        }
    }

    /// The same operator with another bound; itself if it has none.
    pub(crate) fn with_bound(self, n: u32) -> Self {
        match self {
            Self::Delay(_, a) => Self::Delay(n, a),
            Self::Within(_, a) => Self::Within(n, a),
            Self::Throughout(_, a) => Self::Throughout(n, a),
            Self::UntilWithin(_, a, b) => Self::UntilWithin(n, a, b),
            other => other,
        }
    }
}

impl Spec {
    /// X\[n\] φ: φ at the instant `n` steps from now, which must exist.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::{Formula, Spec}};
    ///
    /// let mut spec = Spec::new(vec!["a".into()]);
    /// let at = Span::default();
    /// let a = spec.literal(0, false, at);
    /// let three = spec.delay(3, a, at);
    /// assert_eq!(spec.formula(three), Formula::Delay(3, a));
    /// let five = spec.delay(2, three, at);
    /// assert_eq!(spec.formula(five), Formula::Delay(5, a));
    /// // A delay of one step is `X`.
    /// assert_eq!(spec.delay(1, a, at), spec.next(a, at));
    /// ```
    pub fn delay(&mut self, n: u32, a: FormulaId, span: Span) -> FormulaId {
        let (mut n, mut a) = (n, a);
        while let (1.., (more @ 1.., operand)) = (n, self.delayed(a))
            && let Some(sum) = n.checked_add(more)
        {
            (n, a) = (sum, operand);
        }
        match (n, self.formula(a)) {
            (0, _) | (_, Formula::False) => a,
            (1, _) => self.next(a, span),
            _ => self.intern(Formula::Delay(n, a), span),
        }
    }

    /// F\[0,n\] φ: φ now or at one of the next `n` instants.
    pub fn within(&mut self, n: u32, a: FormulaId, span: Span) -> FormulaId {
        match self.formula(a) {
            _ if n == 0 => a,
            Formula::True | Formula::False | Formula::Eventually(_) | Formula::Then(..) => a,
            Formula::Within(m, b) if n.checked_add(m).is_some() => self.within(n + m, b, span),
            Formula::Next(_) | Formula::Delay(..) => {
                let (m, b) = self.delayed(a);
                let inner = self.within(n, b, span);
                self.delay(m, inner, span)
            }
            _ => self.intern(Formula::Within(n, a), span),
        }
    }

    /// G\[0,n\] φ: φ now and at each of the next `n` instants, all of which must exist.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(Vec::new());
    /// let at = Span::default();
    /// let truth = spec.truth(true, at);
    /// // Not true: it asks for four states.
    /// let four = spec.throughout(3, truth, at);
    /// assert_eq!(spec.display(four).to_string(), "X[3] true");
    /// ```
    pub fn throughout(&mut self, n: u32, a: FormulaId, span: Span) -> FormulaId {
        match self.formula(a) {
            Formula::True => self.delay(n, a, span),
            Formula::False => a,
            _ if n == 0 => a,
            Formula::Throughout(m, b) if n.checked_add(m).is_some() => {
                self.throughout(n + m, b, span)
            }
            Formula::Next(_) | Formula::Delay(..) => {
                let (m, b) = self.delayed(a);
                let inner = self.throughout(n, b, span);
                self.delay(m, inner, span)
            }
            _ => self.intern(Formula::Throughout(n, a), span),
        }
    }

    /// φ U\[0,n\] ψ: ψ now or at one of the next `n` instants, and φ at each instant before that.
    pub fn until_within(&mut self, n: u32, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        match (self.formula(a), self.formula(b)) {
            _ if n == 0 || a == b => b,
            (_, Formula::True | Formula::False) | (Formula::False, _) => b,
            (_, Formula::Eventually(_) | Formula::Then(..)) => b,
            (_, Formula::Until(c, _)) if a == c => b,
            (Formula::True, _) => self.within(n, b, span),
            (_, Formula::UntilWithin(m, c, d)) if a == c && n.checked_add(m).is_some() => {
                self.until_within(n + m, c, d, span)
            }
            _ => self.intern(Formula::UntilWithin(n, a, b), span),
        }
    }

    /// F\[first,last\] φ: φ at an instant so many steps from now.
    pub fn eventually_in(
        &mut self,
        steps: RangeInclusive<u32>,
        a: FormulaId,
        span: Span,
    ) -> FormulaId {
        let (first, length) = split(&steps);
        let inner = self.within(length, a, span);
        self.delay(first, inner, span)
    }

    /// G\[first,last\] φ: φ at every instant so many steps from now, all of which must exist.
    pub fn throughout_in(
        &mut self,
        steps: RangeInclusive<u32>,
        a: FormulaId,
        span: Span,
    ) -> FormulaId {
        let (first, length) = split(&steps);
        let inner = self.throughout(length, a, span);
        self.delay(first, inner, span)
    }

    /// φ U\[first,last\] ψ: ψ at an instant so many steps from now, and φ at each instant before
    /// that.
    pub fn until_in(
        &mut self,
        steps: RangeInclusive<u32>,
        a: FormulaId,
        b: FormulaId,
        span: Span,
    ) -> FormulaId {
        let (first, length) = split(&steps);
        let inner = self.until_within(length, a, b, span);
        self.after_all(first, a, inner, span)
    }

    /// φ T\[first,last\] ψ: φ at some instant, and ψ so many steps after it; `first` is at least 1.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["pick".into(), "place".into()]);
    /// let at = Span::default();
    /// let [pick, place] = [0, 1].map(|proposition| spec.literal(proposition, false, at));
    /// let quick = spec.then_in(1..=10, pick, place, at);
    /// assert_eq!(spec.display(quick).to_string(), "F (pick && F[1,10] place)");
    /// ```
    pub fn then_in(
        &mut self,
        steps: RangeInclusive<u32>,
        a: FormulaId,
        b: FormulaId,
        span: Span,
    ) -> FormulaId {
        let second = self.eventually_in(steps, b, span);
        let both = self.and(a, second, span);
        self.eventually(both, span)
    }

    /// `φ ensuring p`: φ, and the state formula `p` at every instant until φ is satisfied, that
    /// instant included.
    ///
    /// `p` moves inward, past one operator of φ after the other; with φ′ for `φ ensuring p`:
    ///
    /// ```text
    /// q′             =  q && p,  q a state formula
    /// (φ && ψ)′      =  φ′ && ψ′
    /// (φ || ψ)′      =  φ′ || ψ′
    /// (X[n] φ)′      =  G[0,n-1] p && X[n] φ′
    /// (F φ)′         =  p U φ′
    /// (F[0,n] φ)′    =  p U[0,n] φ′
    /// (G[0,n] φ)′    =  G[0,n] φ′
    /// (φ U ψ)′       =  φ′ U ψ′
    /// (φ U[0,n] ψ)′  =  φ′ U[0,n] ψ′
    /// (φ T ψ)′       =  p U (φ′ && X (F ψ)′)
    /// ```
    ///
    /// One pass over the arena, each operator once: linear in φ however its parts are shared.
    ///
    /// ```
    /// use tltl_compiler::{source::Span, spec::Spec};
    ///
    /// let mut spec = Spec::new(vec!["home".into(), "wet".into()]);
    /// let at = Span::default();
    /// let home = spec.literal(0, false, at);
    /// let dry = spec.literal(1, true, at);
    /// let goal = spec.eventually(home, at);
    /// let safe = spec.ensuring(goal, dry, at);
    /// assert_eq!(spec.display(safe).to_string(), "!wet U (home && !wet)");
    /// ```
    pub fn ensuring(&mut self, root: FormulaId, p: FormulaId, span: Span) -> FormulaId {
        let parts = arena::needed(vec![root.0], &mut |id, open| {
            open.extend(self.formula(FormulaId(id)).operands().map(|operand| operand.0));
        });
        let mut images: Memo<FormulaId, FormulaId> = Memo::default();
        let mut temporal: Memo<FormulaId, FormulaId> = Memo::default();
        for id in parts.into_iter().map(FormulaId) {
            let formula = self.formula(id);
            let is_state = !formula.is_temporal()
                && formula.operands().all(|operand| temporal.get(operand).is_none());
            let image = if is_state {
                self.and(id, p, span)
            } else {
                temporal.insert(id, id);
                let image = |a| images.get(a).expect("operands stand first");
                self.ensured(formula.over(image), p, span)
            };
            images.insert(id, image);
        }
        images.get(root).expect("the root is one of its parts")
    }

    /// One equation of [`ensuring`](Self::ensuring): the operator, whose operands are their images.
    fn ensured(&mut self, formula: Formula, p: FormulaId, span: Span) -> FormulaId {
        match formula {
            Formula::Next(a) => self.after_all(1, p, a, span),
            Formula::Delay(n, a) => self.after_all(n, p, a, span),
            Formula::Eventually(a) => self.until(p, a, span),
            Formula::Within(n, a) => self.until_within(n, p, a, span),
            Formula::Then(a, b) => {
                let second = self.next(b, span);
                let both = self.and(a, second, span);
                self.until(p, both, span)
            }
            other => self.add(other, span),
        }
    }

    /// G[0,n-1] φ && X[n] ψ: ψ so many steps from now, φ at each instant before that.
    fn after_all(&mut self, n: u32, a: FormulaId, b: FormulaId, span: Span) -> FormulaId {
        let later = self.delay(n, b, span);
        match n.checked_sub(1) {
            None => later,
            Some(before) => {
                let hold = self.throughout(before, a, span);
                self.and(hold, later, span)
            }
        }
    }

    /// The steps and the operand of `X` or `X[n]`; of another formula, no steps and itself.
    fn delayed(&self, id: FormulaId) -> (u32, FormulaId) {
        match self.formula(id) {
            Formula::Next(a) => (1, a),
            Formula::Delay(n, a) => (n, a),
            _ => (0, id),
        }
    }
}

/// The first instant of an interval, and how many more there are.
fn split(steps: &RangeInclusive<u32>) -> (u32, u32) {
    (*steps.start(), steps.end() - steps.start())
}
