//! Conditions and terms made of others: constants folded, arguments in place of parameters.
//!
//! Folding uses the operations that generated code uses, in `f64`, so a folded constant is the
//! number that the program would compute. Substitution is a pass over the needed part of the arena,
//! operands first, with a memo by place: a shared subterm is substituted once, and nothing
//! recurses.

use super::{
    Arena, Arguments, Binding, Condition, ConditionId, Number, Scalar, Step, Term, TermId,
};
use super::{Module, ParameterType, PredicateId, Task};
use crate::arena;
use crate::ast::Comparison;

impl Arena {
    /// ¬φ. The negation of a comparison is the opposite comparison: robustness is exact either way.
    ///
    /// ```
    /// use tltl_compiler::ast::Comparison;
    /// use tltl_compiler::predicate::{Arena, Condition, Number, Term};
    ///
    /// let mut arena = Arena::default();
    /// let x = arena.add_term(Term::Variable("x".into()));
    /// let three = arena.add_term(Term::Number(Number(3.0)));
    /// let less = arena.compare(Comparison::Less, x, three);
    /// let not = arena.not(less);
    /// assert_eq!(*arena.condition(not), Condition::Compare(Comparison::AtLeast, x, three));
    /// assert_eq!(arena.not(not), less);
    /// ```
    pub fn not(&mut self, a: ConditionId) -> ConditionId {
        let condition = match *self.condition(a) {
            Condition::Truth(value) => Condition::Truth(!value),
            Condition::Not(inner) => return inner,
            Condition::Compare(op, left, right) => Condition::Compare(op.negated(), left, right),
            _ => Condition::Not(a),
        };
        self.add_condition(condition)
    }

    /// φ ∧ ψ
    pub fn and(&mut self, a: ConditionId, b: ConditionId) -> ConditionId {
        match (self.condition(a), self.condition(b)) {
            (Condition::Truth(true), _) | (_, Condition::Truth(false)) => b,
            (Condition::Truth(false), _) | (_, Condition::Truth(true)) => a,
            _ if a == b => a,
            _ => self.add_condition(Condition::And(a, b)),
        }
    }

    /// φ ∨ ψ
    pub fn or(&mut self, a: ConditionId, b: ConditionId) -> ConditionId {
        match (self.condition(a), self.condition(b)) {
            (Condition::Truth(true), _) | (_, Condition::Truth(false)) => a,
            (Condition::Truth(false), _) | (_, Condition::Truth(true)) => b,
            _ if a == b => a,
            _ => self.add_condition(Condition::Or(a, b)),
        }
    }

    /// One comparison. What varies stands on the left, so that `x < 3` and `3 > x` are one
    /// condition; two constants are compared at once.
    ///
    /// ```
    /// use tltl_compiler::ast::Comparison;
    /// use tltl_compiler::predicate::{Arena, Condition, Number, Term};
    ///
    /// let mut arena = Arena::default();
    /// let x = arena.add_term(Term::Variable("x".into()));
    /// let [three, five] = [3.0, 5.0].map(|value| arena.add_term(Term::Number(Number(value))));
    /// let one = arena.compare(Comparison::Less, x, three);
    /// assert_eq!(arena.compare(Comparison::Greater, three, x), one);
    /// let constant = arena.compare(Comparison::Less, three, five);
    /// assert_eq!(*arena.condition(constant), Condition::Truth(true));
    /// ```
    pub fn compare(&mut self, op: Comparison, left: TermId, right: TermId) -> ConditionId {
        let condition = match (self.fixed(left), self.fixed(right)) {
            (Some(x), Some(y)) => Condition::Truth(op.holds(x, y)),
            (Some(_), None) => Condition::Compare(op.mirrored(), right, left),
            _ => Condition::Compare(op, left, right),
        };
        self.add_condition(condition)
    }

    /// A predicate with arguments; `meaning` is its condition with these arguments. If that is a
    /// constant, the predicate is not called at all.
    pub fn apply(
        &mut self,
        predicate: PredicateId,
        arguments: Vec<TermId>,
        meaning: ConditionId,
    ) -> ConditionId {
        match self.condition(meaning) {
            Condition::Truth(_) => meaning,
            _ => self.add_condition(Condition::Apply { predicate, arguments, meaning }),
        }
    }

    /// The number of a term that depends on nothing: its value, or its index in its enumeration,
    /// with -1 for `none`. Values of different enumerations never meet here; the types are checked
    /// before.
    fn fixed(&self, id: TermId) -> Option<f64> {
        match self.term(id) {
            Term::Number(Number(value)) => Some(*value),
            Term::Variant { number, .. } => Some(f64::from(*number)),
            Term::Absent => Some(-1.0),
            _ => None,
        }
    }

    /// Whether a term is a value, which can only be equal to another or not, rather than a number.
    #[must_use]
    pub fn is_value(&self, id: TermId) -> bool {
        match self.term(id) {
            Term::Variant { .. } | Term::Absent | Term::Host { value: true, .. } => true,
            Term::Place { scalar, .. } => matches!(scalar, Scalar::Enum { .. }),
            Term::Parameter { ty, .. } => {
                matches!(ty, ParameterType::Host(_) | ParameterType::Scalar(Scalar::Enum { .. }))
            }
            _ => false,
        }
    }

    /// The condition `root` with `arguments` in place of the parameters of these names.
    ///
    /// ```
    /// use tltl_compiler::{check, predicate::{Number, Term}, source::Source};
    ///
    /// let text = "state S { x: f64 }\npredicate near(d: f64) = x < 2 * d\ntask t = F near(1)\n";
    /// let mut module = check::file(&Source::new("s.tltl", text))?;
    /// let three = module.arena.add_term(Term::Number(Number(3.0)));
    /// let near = module.predicates[0].condition;
    /// let instance = module.arena.substitute(near, &vec![("d".into(), three)]);
    /// assert_eq!(module.display(instance).to_string(), "x < 6");
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    pub fn substitute(&mut self, root: ConditionId, arguments: &Arguments) -> ConditionId {
        let needed = self.conditions_of(root);
        let mut done: Vec<ConditionId> = Vec::with_capacity(needed.len());
        for &id in &needed {
            let condition = self.condition(ConditionId(id)).clone();
            let of = |a: ConditionId| done[place(&needed, a.0)];
            done.push(self.substituted(ConditionId(id), condition, of, arguments));
        }
        done[place(&needed, root.0)]
    }

    /// The number of operators and operands of a condition that is written out, shared ones counted
    /// wherever they stand; predicates without parameters count as one. Saturating: sharing can
    /// make it exponential.
    ///
    /// ```
    /// use tltl_compiler::ast::Comparison;
    /// use tltl_compiler::predicate::{Arena, Number, Term};
    ///
    /// let mut arena = Arena::default();
    /// let x = arena.add_term(Term::Variable("x".into()));
    /// let one = arena.add_term(Term::Number(Number(1.0)));
    /// let less = arena.compare(Comparison::Less, x, one);
    /// assert_eq!(arena.written_size(less), 3);
    /// ```
    #[must_use]
    pub fn written_size(&self, root: ConditionId) -> usize {
        let conditions = self.conditions_of(root);
        let read = |id: &u32| self.condition(ConditionId(*id)).terms();
        let terms = self.terms_of(conditions.iter().flat_map(read).collect());
        let mut term_sizes: Vec<usize> = Vec::with_capacity(terms.len());
        for &id in &terms {
            let of = |a: TermId| term_sizes[place(&terms, a.0)];
            let operands = self.term(TermId(id)).operands().into_iter();
            term_sizes.push(operands.map(of).fold(1, usize::saturating_add));
        }
        let mut sizes: Vec<usize> = Vec::with_capacity(conditions.len());
        for &id in &conditions {
            let condition = self.condition(ConditionId(id));
            let terms = condition.terms().into_iter().map(|a| term_sizes[place(&terms, a.0)]);
            let operands = condition.operands().into_iter().map(|a| sizes[place(&conditions, a.0)]);
            sizes.push(operands.chain(terms).fold(1, usize::saturating_add));
        }
        sizes[place(&conditions, root.0)]
    }

    /// The numbers of all conditions that `root` is made of, operands first, without those of other
    /// predicates.
    fn conditions_of(&self, root: ConditionId) -> Vec<u32> {
        arena::needed(vec![root.0], &mut |id, open| {
            open.extend(self.condition(ConditionId(id)).operands().iter().map(|a| a.0));
        })
    }

    /// One condition with arguments, given its operands with arguments.
    fn substituted(
        &mut self,
        id: ConditionId,
        condition: Condition,
        of: impl Fn(ConditionId) -> ConditionId,
        arguments: &Arguments,
    ) -> ConditionId {
        match condition {
            Condition::Truth(_) | Condition::Is(_) | Condition::Free(_) => id,
            Condition::Not(a) => self.not(of(a)),
            Condition::And(a, b) => self.and(of(a), of(b)),
            Condition::Or(a, b) => self.or(of(a), of(b)),
            Condition::Compare(op, a, b) => {
                let (a, b) = (self.replace(a, arguments), self.replace(b, arguments));
                self.compare(op, a, b)
            }
            Condition::Bool(term) => {
                let term = self.replace(term, arguments);
                self.add_condition(match self.term(term) {
                    Term::Truth(value) => Condition::Truth(*value),
                    _ => Condition::Bool(term),
                })
            }
            Condition::Value { text, span, bindings } => {
                let replace =
                    |one: Binding| Binding { term: self.replace(one.term, arguments), ..one };
                let bindings = bindings.into_iter().map(replace).collect();
                self.add_condition(Condition::Value { text, span, bindings })
            }
            Condition::Apply { predicate, arguments: old, meaning } => {
                let new = old.into_iter().map(|term| self.replace(term, arguments)).collect();
                self.apply(predicate, new, of(meaning))
            }
        }
    }

    /// The term `root` with `arguments` in place of the parameters of these names.
    pub fn replace(&mut self, root: TermId, arguments: &Arguments) -> TermId {
        let needed = self.terms_of(vec![root]);
        let mut done: Vec<TermId> = Vec::with_capacity(needed.len());
        for &id in &needed {
            let of = |a: TermId| done[place(&needed, a.0)];
            done.push(self.replaced(TermId(id), of, arguments));
        }
        done[place(&needed, root.0)]
    }

    /// The numbers of all terms that `roots` are made of, operands first.
    fn terms_of(&self, roots: Vec<TermId>) -> Vec<u32> {
        let roots = roots.into_iter().map(|root| root.0).collect();
        arena::needed(roots, &mut |id, open| {
            open.extend(self.term(TermId(id)).operands().iter().map(|a| a.0));
        })
    }

    /// One term with arguments, given its operands with arguments.
    fn replaced(
        &mut self,
        id: TermId,
        of: impl Fn(TermId) -> TermId,
        arguments: &Arguments,
    ) -> TermId {
        let term = match self.term(id).clone() {
            Term::Parameter { name, .. } => {
                let argument = arguments.iter().find(|(known, _)| *known == name);
                return argument.map_or(id, |(_, term)| *term);
            }
            Term::Place { mut steps, scalar } => {
                for step in &mut steps {
                    match step {
                        Step::Element(index) => *index = of(*index),
                        Step::At { index, length } => *step = self.at(of(*index), *length),
                        Step::Field(_) | Step::Index(_) => {}
                    }
                }
                Term::Place { steps, scalar }
            }
            Term::Host { text, span, bindings, value } => {
                let bindings =
                    bindings.into_iter().map(|one| Binding { term: of(one.term), ..one });
                Term::Host { text, span, bindings: bindings.collect(), value }
            }
            Term::Negate(a) => return self.folded(Term::Negate(of(a))),
            Term::Calculate(op, a, b) => {
                return self.folded(Term::Calculate(op, of(a), of(b)));
            }
            Term::Call(function, a, b) => {
                return self.folded(Term::Call(function, of(a), b.map(of)));
            }
            _ => return id,
        };
        self.add_term(term)
    }

    /// The value of a calculation whose operands are constants; it may be infinite or NaN. `None`
    /// if an operand is not constant.
    pub(crate) fn value(&self, term: &Term) -> Option<f64> {
        match *term {
            Term::Negate(a) => self.constant(a).map(|value| -value),
            Term::Calculate(op, a, b) => {
                self.constant(a).zip(self.constant(b)).map(|(x, y)| op.value(x, y))
            }
            Term::Call(function, a, b) => {
                let y = b.map_or(Some(0.0), |b| self.constant(b));
                self.constant(a).zip(y).map(|(x, y)| function.value(x, y))
            }
            _ => None,
        }
    }

    /// A calculation, or its value if that is known and finite.
    pub(crate) fn folded(&mut self, term: Term) -> TermId {
        match self.value(&term).filter(|value| value.is_finite()) {
            Some(value) => self.number(value),
            None => self.add_term(term),
        }
    }

    /// A number. There is one zero: its sign is not part of any meaning here.
    pub(crate) fn number(&mut self, value: f64) -> TermId {
        self.add_term(Term::Number(Number(value + 0.0)))
    }

    /// The step to the element of an array of `length` at a number. It stays [`Step::At`] if the
    /// number is not known, or if there is no such element, which is reported where the argument
    /// stands.
    pub fn at(&self, index: TermId, length: u32) -> Step {
        let fits = |value: &f64| value.fract() == 0.0 && 0.0 <= *value && *value < length.into();
        match self.constant(index).filter(fits) {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "it fits")]
            Some(value) => Step::Index(value as u32),
            None => Step::At { index, length },
        }
    }
}

impl Module {
    /// The least length of an array that a parameter of a task indexes, and the place that it is
    /// part of. The generated function asserts that the argument is below it.
    ///
    /// ```
    /// use tltl_compiler::{check, source::Source};
    ///
    /// let text = "state S { a: [bool; 9], b: [bool; 4] }\ntask t(i: u8) = F (a[i] && b[i])\n";
    /// let module = check::file(&Source::new("s.tltl", text))?;
    /// let (length, place) = module.shortest_array(&module.tasks[0], "i").unwrap();
    /// assert_eq!((length, module.display_term(place).to_string().as_str()), (4, "b[i]"));
    /// # Ok::<(), tltl_compiler::error::Errors>(())
    /// ```
    #[must_use]
    pub fn shortest_array(&self, task: &Task, parameter: &str) -> Option<(u32, TermId)> {
        let is_it = |index: TermId| matches!(self.arena.term(index), Term::Parameter { name, .. } if name == parameter);
        let mut shortest: Option<(u32, TermId)> = None;
        for place in self.needed_terms(task) {
            let Term::Place { steps, .. } = self.arena.term(place) else { continue };
            for step in steps {
                if let Step::At { index, length } = *step
                    && is_it(index)
                    && shortest.is_none_or(|(known, _)| length < known)
                {
                    shortest = Some((length, place));
                }
            }
        }
        shortest
    }

    /// An element that the predicates of a task read although the array is too short for it: the
    /// place, and the length.
    #[must_use]
    pub fn missing_element(&self, task: &Task) -> Option<(TermId, u32)> {
        self.needed_terms(task).into_iter().find_map(|place| {
            let Term::Place { steps, .. } = self.arena.term(place) else { return None };
            steps.iter().find_map(|step| match *step {
                Step::At { index, length } => self.arena.constant(index).map(|_| (place, length)),
                _ => None,
            })
        })
    }

    /// All terms that the predicates of a task read.
    fn needed_terms(&self, task: &Task) -> Vec<TermId> {
        let roots = task.predicates.iter().map(|id| self.predicates[id.0 as usize].condition);
        self.terms_of(&self.conditions_of(roots.collect()))
    }

    /// All terms that some conditions compare, and the terms that these are made of, operands
    /// first.
    #[must_use]
    pub fn terms_of(&self, conditions: &[ConditionId]) -> Vec<TermId> {
        let mut terms = Vec::new();
        for &id in conditions {
            match *self.arena.condition(id) {
                Condition::Compare(_, a, b) => terms.extend([a, b]),
                Condition::Bool(place) => terms.push(place),
                _ => {}
            }
        }
        self.arena.terms_of(terms).into_iter().map(TermId).collect()
    }

    /// All conditions that `roots` are made of, those of other predicates included.
    #[must_use]
    pub fn conditions_of(&self, roots: Vec<ConditionId>) -> Vec<ConditionId> {
        let roots = roots.into_iter().map(|root| root.0).collect();
        let needed = arena::needed(roots, &mut |id, open| {
            open.extend(self.operands(self.arena.condition(ConditionId(id))).iter().map(|a| a.0));
        });
        needed.into_iter().map(ConditionId).collect()
    }

    /// The conditions that a condition is made of; for another predicate, its condition.
    pub(crate) fn operands(&self, condition: &Condition) -> Vec<ConditionId> {
        match condition {
            Condition::Is(predicate) => vec![self.predicates[predicate.0 as usize].condition],
            _ => condition.operands(),
        }
    }
}

impl Condition {
    /// The conditions that it is made of.
    #[must_use]
    pub fn operands(&self) -> Vec<ConditionId> {
        match *self {
            Self::Not(a) | Self::Apply { meaning: a, .. } => vec![a],
            Self::And(a, b) | Self::Or(a, b) => vec![a, b],
            _ => Vec::new(),
        }
    }

    /// The terms that it names, without those of its operands.
    #[must_use]
    pub fn terms(&self) -> Vec<TermId> {
        match self {
            Self::Compare(_, a, b) => vec![*a, *b],
            Self::Bool(a) => vec![*a],
            Self::Value { bindings, .. } => bindings.iter().map(|one| one.term).collect(),
            Self::Apply { arguments, .. } => arguments.clone(),
            _ => Vec::new(),
        }
    }
}

/// The place of an id among the needed ones.
fn place(needed: &[u32], id: u32) -> usize {
    needed.binary_search(&id).expect("operands are needed")
}

impl Term {
    /// The terms that it is made of.
    #[must_use]
    pub fn operands(&self) -> Vec<TermId> {
        match self {
            Self::Negate(a) => vec![*a],
            Self::Calculate(_, a, b) => vec![*a, *b],
            Self::Call(_, a, b) => std::iter::once(*a).chain(*b).collect(),
            Self::Host { bindings, .. } => bindings.iter().map(|one| one.term).collect(),
            Self::Place { steps, .. } => {
                let index = |step: &Step| match step {
                    Step::Element(index) | Step::At { index, .. } => Some(*index),
                    Step::Field(_) | Step::Index(_) => None,
                };
                steps.iter().filter_map(index).collect()
            }
            _ => Vec::new(),
        }
    }
}
