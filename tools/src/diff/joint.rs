//! The predicates of two sources in one module, so that what means the same is the same.
//!
//! A predicate is its definition: conditions of both sources are put into one arena, with names
//! of predicates replaced by what they stand for, so equal definitions get equal ids, and
//! [`arithmetic`](tltl_compiler::arithmetic) ties the others. A name that no source defines, of a
//! bare formula or of an automaton, is what the other source calls so.

use rustc_hash::FxHashMap;

use tltl_compiler::predicate::{
    Binding, Condition, ConditionId, Enum, Module, ParameterType, Predicate, PredicateId, Scalar,
    Step, Task, Term, TermId,
};
use tltl_compiler::source::Span;
use tltl_compiler::spec::Spec;

/// A module that grows by what sources define.
pub(super) struct Joint {
    pub(super) module: Module,
    /// What declared predicates and propositions are called, with their conditions.
    names: FxHashMap<String, ConditionId>,
}

/// What the ids of a source are in the joint module.
#[derive(Default)]
struct Images {
    conditions: FxHashMap<ConditionId, ConditionId>,
    terms: FxHashMap<TermId, TermId>,
}

impl Joint {
    pub(super) fn new() -> Self {
        Self { module: Module::default(), names: FxHashMap::default() }
    }

    /// The condition of each proposition of a task of `module`.
    pub(super) fn task(&mut self, module: &Module, task: &Task) -> Vec<ConditionId> {
        let of_task = task.predicates.iter().map(|id| &module.predicates[id.0 as usize]);
        let declared = module.predicates.iter().filter(|one| one.declared);
        let named: Vec<&Predicate> = of_task.chain(declared).collect();
        let roots: Vec<ConditionId> = named.iter().map(|one| one.condition).collect();
        let conditions = module.conditions_of(roots.clone());
        let mut images = Images::default();
        for id in module.terms_of(&conditions) {
            let term = self.term(module, &images, module.arena.term(id));
            images.terms.insert(id, self.module.arena.add_term(term));
        }
        for id in conditions {
            let image = self.condition(module, &images, module.arena.condition(id));
            images.conditions.insert(id, image);
        }
        let of = |root: &ConditionId| images.conditions[root];
        let names = task.spec.propositions().iter().map(|one| &one.name);
        let names = names.chain(named[task.predicates.len()..].iter().map(|one| &one.name));
        for (name, root) in names.zip(&roots) {
            self.names.entry(name.clone()).or_insert(of(root));
        }
        roots[..task.predicates.len()].iter().map(of).collect()
    }

    /// The condition of a name that is not defined where it stands.
    pub(super) fn free(&mut self, name: &str) -> ConditionId {
        if let Some(&known) = self.names.get(name) {
            return known;
        }
        match self.place(name) {
            Some(id)
                if matches!(
                    self.module.arena.term(id),
                    Term::Place { scalar: Scalar::Bool, .. }
                ) =>
            {
                self.module.arena.add_condition(Condition::Bool(id))
            }
            _ => self.module.arena.add_condition(Condition::Free(name.to_owned())),
        }
    }

    /// The place of a state that is written so.
    fn place(&self, name: &str) -> Option<TermId> {
        let terms = (0..self.module.arena.terms().len() as u32).map(TermId);
        let is_place = |id: &TermId| matches!(self.module.arena.term(*id), Term::Place { .. });
        let mut places = terms.filter(is_place);
        places.find(|id| self.module.display_term(*id).to_string() == name)
    }

    fn condition(
        &mut self,
        module: &Module,
        images: &Images,
        condition: &Condition,
    ) -> ConditionId {
        let of = |id: &ConditionId| images.conditions[id];
        let arena = &mut self.module.arena;
        match condition {
            Condition::Not(a) => arena.not(of(a)),
            Condition::And(a, b) => arena.and(of(a), of(b)),
            Condition::Or(a, b) => arena.or(of(a), of(b)),
            Condition::Is(predicate) => of(&module.predicates[predicate.0 as usize].condition),
            Condition::Apply { meaning, .. } => of(meaning),
            Condition::Compare(comparison, a, b) => {
                let [a, b] = [a, b].map(|id| images.terms[id]);
                arena.add_condition(Condition::Compare(*comparison, a, b))
            }
            Condition::Bool(a) => arena.add_condition(Condition::Bool(images.terms[a])),
            Condition::Truth(value) => arena.add_condition(Condition::Truth(*value)),
            Condition::Free(name) => self.free(name),
            Condition::Value { text, bindings, .. } => {
                let bindings = self.bindings(module, images, bindings);
                let (text, span) = (text.clone(), Span::default());
                self.module.arena.add_condition(Condition::Value { text, span, bindings })
            }
        }
    }

    fn term(&mut self, module: &Module, images: &Images, term: &Term) -> Term {
        let of = |id: &TermId| images.terms[id];
        match term {
            Term::Place { steps, scalar } => {
                let step = |step: &Step| match step {
                    Step::Element(index) => Step::Element(of(index)),
                    Step::At { index, length } => Step::At { index: of(index), length: *length },
                    fixed => fixed.clone(),
                };
                let steps = steps.iter().map(step).collect();
                Term::Place { steps, scalar: self.scalar(module, *scalar) }
            }
            Term::Variable(name) => match self.place(name) {
                Some(place) => self.module.arena.term(place).clone(),
                None => term.clone(),
            },
            Term::Host { text, bindings, value, .. } => Term::Host {
                text: text.clone(),
                span: Span::default(),
                bindings: self.bindings(module, images, bindings),
                value: *value,
            },
            Term::Variant { of, number, name } => {
                let of = self.enumeration(&module.enums[*of as usize]);
                Term::Variant { of, number: *number, name: name.clone() }
            }
            Term::Parameter { name, ty: ParameterType::Scalar(scalar) } => {
                let ty = ParameterType::Scalar(self.scalar(module, *scalar));
                Term::Parameter { name: name.clone(), ty }
            }
            Term::Negate(a) => Term::Negate(of(a)),
            Term::Calculate(operator, a, b) => Term::Calculate(*operator, of(a), of(b)),
            Term::Call(function, a, b) => Term::Call(*function, of(a), b.as_ref().map(of)),
            Term::Number(_) | Term::Truth(_) | Term::Absent | Term::Parameter { .. } => {
                term.clone()
            }
        }
    }

    fn bindings(&mut self, module: &Module, images: &Images, bindings: &[Binding]) -> Vec<Binding> {
        let image = |one: &Binding| Binding {
            name: one.name.clone(),
            scalar: one.scalar.map(|scalar| self.scalar(module, scalar)),
            term: images.terms[&one.term],
        };
        bindings.iter().map(image).collect()
    }

    fn scalar(&mut self, module: &Module, scalar: Scalar) -> Scalar {
        match scalar {
            Scalar::Enum { of, optional } => {
                Scalar::Enum { of: self.enumeration(&module.enums[of as usize]), optional }
            }
            other => other,
        }
    }

    /// The enumeration of this name with these values.
    fn enumeration(&mut self, declared: &Enum) -> u32 {
        let enums = &mut self.module.enums;
        let is_it = |one: &Enum| one.name == declared.name && one.variants == declared.variants;
        let known = enums.iter().position(is_it).unwrap_or_else(|| {
            enums.push(declared.clone());
            enums.len() - 1
        });
        known as u32
    }

    /// A task whose predicates are these conditions, for an evaluator.
    pub(super) fn predicates(&mut self, conditions: &[ConditionId]) -> Task {
        let first = self.module.predicates.len() as u32;
        let predicate = |&condition: &ConditionId| Predicate {
            name: String::new(),
            declared: false,
            parameters: Vec::new(),
            docs: Vec::new(),
            span: Span::default(),
            condition,
        };
        self.module.predicates.extend(conditions.iter().map(predicate));
        let last = self.module.predicates.len() as u32;
        Task {
            name: None,
            docs: Vec::new(),
            span: Span::default(),
            parameters: Vec::new(),
            text: String::new(),
            spec: Spec::new(Vec::new()),
            predicates: (first..last).map(PredicateId).collect(),
            parts: None,
            options: tltl_compiler::predicate::Options::default(),
        }
    }
}
