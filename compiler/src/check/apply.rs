//! Predicates and tasks with arguments.
//!
//! An argument takes the place of a parameter before the analysis: `near(2)` becomes the condition
//! of `near` with 2 in it, so arithmetic relates `near(2)` to `x < 1`. The call itself is kept for
//! emission and for messages. The substituted condition is checked again for what an argument can
//! break: a division by zero, a number out of range, an element outside an array.
//!
//! ```
//! use tltl_compiler::{check, source::Source};
//!
//! let text = "state Robot { x: f64 }
//! predicate within(d: f64) = 1 / d > x
//! task come = F within(2)
//! task never = F within(0)";
//! let errors = check::file(&Source::new("robot.tltl", text)).unwrap_err();
//! // The predicate is sound, and so is its first use.
//! assert_eq!(errors.iter().count(), 1);
//! assert!(errors.first().span().start > text.find("never").unwrap());
//! ```

use super::atom::{Atom, Atoms};
use crate::ast::{Arithmetic, ItemKind, quoted};
use crate::error::{Error, Kind};
use crate::predicate::{Arguments, Number, Numeric, ParameterType, Scalar, Step, Term, TermId};
use crate::resolve::{Callee, Expression, ExpressionId, Name, Names, Resolved, a_type, elements};

impl Atoms<'_, '_> {
    /// The meaning of the predicate or the task `item` with these arguments.
    pub(super) fn application(
        &mut self,
        id: ExpressionId,
        item: usize,
        arguments: &[ExpressionId],
    ) -> Option<Atom> {
        let resolved = self.resolved;
        let broken = matches!(resolved.item(item).kind, ItemKind::Broken(_));
        if broken || !resolved.scope.unclear(item).is_empty() {
            return None;
        }
        if let Some(error) = miscounted(resolved, id, item, arguments.len()) {
            return self.lowering.refuse(error);
        }
        let parameters = resolved.scope.parameters(item);
        let mut given = Vec::new();
        for (parameter, &argument) in parameters.iter().zip(arguments) {
            given.push(self.argument(argument, parameter.ty));
        }
        let given: Vec<_> = given.into_iter().collect::<Option<_>>()?;
        self.instance(id, item, arguments, &given)
    }

    /// The term of an argument for a parameter of type `ty`.
    fn argument(&mut self, id: ExpressionId, ty: ParameterType) -> Option<TermId> {
        match ty {
            ParameterType::Scalar(scalar @ Scalar::Number(_)) => {
                let term = self.terms[self.roles.position(id)]?;
                self.number_argument(id, term, scalar)
            }
            ParameterType::Scalar(Scalar::Bool) => self.truth_argument(id),
            ParameterType::Scalar(Scalar::Enum { of, optional }) => {
                self.lowering.value_of(id, of, optional)
            }
            ParameterType::Host(_) => self.lowering.value(id, None),
        }
    }

    /// The number `term` as an argument of type `ty`. For an integer type it must be a constant of
    /// that type, or a place or parameter whose type fits into it: nothing is rounded or wrapped. A
    /// Rust expression is left to rustc.
    fn number_argument(&mut self, id: ExpressionId, term: TermId, ty: Scalar) -> Option<TermId> {
        let Some((least, most)) = ty.whole() else { return Some(term) };
        let within = |(low, high): (i128, i128)| least <= low && high <= most;
        let text = self.resolved.quote(id);
        let what = match self.lowering.arena.term(term) {
            Term::Number(Number(value)) if value.fract() != 0.0 => format!("`{text}` is not whole"),
            Term::Number(Number(value)) if within((*value as i128, *value as i128)) => {
                return Some(term);
            }
            Term::Number(_) => format!("`{text}` is beyond it"),
            Term::Place { scalar, .. }
            | Term::Parameter { ty: ParameterType::Scalar(scalar), .. } => {
                if scalar.whole().is_some_and(within) {
                    return Some(term);
                }
                format!("`{text}` is {}", a_type(*scalar))
            }
            Term::Host { .. } => return Some(term),
            _ => format!("`{text}` is calculated"),
        };
        let message = format!("{} is needed here, and {what}", a_type(ty));
        self.lowering.refuse(
            self.lowering
                .resolved
                .type_error(id, message)
                .help(format!("its values are the whole numbers from {least} to {most}")),
        )
    }

    /// The truth value `id` as an argument. A formula is not one: an argument is evaluated to a
    /// term.
    fn truth_argument(&mut self, id: ExpressionId) -> Option<TermId> {
        let resolved = self.resolved;
        let term = match (&resolved[id].expression, resolved.names) {
            (Expression::Truth(value), _) => {
                Some(self.lowering.arena.add_term(Term::Truth(*value)))
            }
            (Expression::Name(Name::Parameter { ty, .. }), _)
                if *ty == ParameterType::Scalar(Scalar::Bool) =>
            {
                Some(self.lowering.parameter(id, *ty))
            }
            (Expression::Name(Name::Item(..) | Name::Value(_) | Name::Parameter { .. }), _) => None,
            (Expression::Name(_) | Expression::Call(Callee { item: None, .. }, _), Names::Host) => {
                return self.lowering.rust(id, false);
            }
            (Expression::Name(_), Names::Declared) if resolved.is_path(id) => {
                let (term, scalar) = self.lowering.place(id)?;
                (scalar == Scalar::Bool).then_some(term)
            }
            _ => None,
        };
        term.or_else(|| {
            let message = format!("a `bool` is needed here, and `{}` is none", resolved.quote(id));
            let help = "it is `true`, `false`, or a parameter or a field of that type";
            self.lowering.refuse(resolved.type_error(id, message).help(help))
        })
    }

    /// The predicate or the task `item` with the terms `given` in place of its parameters.
    fn instance(
        &mut self,
        id: ExpressionId,
        item: usize,
        arguments: &[ExpressionId],
        given: &[TermId],
    ) -> Option<Atom> {
        let resolved = self.resolved;
        let names = resolved.scope.parameters(item).iter().map(|parameter| parameter.name.clone());
        let bound: Arguments = names.zip(given.iter().copied()).collect();
        let known = self.lowering.arena.terms().len();
        let propositions = &mut *self.propositions;
        let atom = match resolved.item(item).kind {
            ItemKind::Predicate(..) => {
                let predicate = propositions.declared[item]?;
                let condition = propositions.predicate(predicate).condition;
                let meaning = propositions.substituted(self.lowering, condition, &bound, id)?;
                let applied = self.lowering.arena.apply(predicate, given.to_vec(), meaning);
                Atom::Conditions(vec![self.lowering.placed(applied, resolved.span(id))])
            }
            ItemKind::Task(..) => {
                let task = resolved.scope.task_id(item)?;
                if let Some(task) = &self.tasks[task.0 as usize] {
                    propositions.literals(self.lowering, task, &bound, id);
                }
                Atom::Task(task, bound)
            }
            _ => return None,
        };
        let error = self.not_finite(id, known).or_else(|| self.no_element(known, arguments, given));
        match error {
            Some(error) => self.lowering.refuse(error),
            None => Some(atom),
        }
    }

    /// The error if one of the terms added since `known` divides by zero or is not a number.
    fn not_finite(&self, id: ExpressionId, known: usize) -> Option<Error> {
        let arena = &self.lowering.arena;
        let bad = |term: &Term| match term {
            Term::Calculate(Arithmetic::Divide, _, b) if arena.constant(*b) == Some(0.0) => true,
            Term::Negate(_) | Term::Calculate(..) | Term::Call(..) => arena.value(term).is_some(),
            _ => false,
        };
        let term = arena.terms()[known..].iter().position(bad)?;
        let text = arena.display(TermId(u32::try_from(known + term).ok()?));
        let message = format!("with these arguments, `{text}` is not a number");
        Some(Error::new(Kind::Number, message, self.resolved.span(id)))
    }

    /// The error if one of the terms added since `known` is, or may be, an element outside its
    /// array.
    fn no_element(
        &self,
        known: usize,
        arguments: &[ExpressionId],
        given: &[TermId],
    ) -> Option<Error> {
        let (resolved, arena) = (self.resolved, &self.lowering.arena);
        let made = (known..arena.terms().len()).filter_map(|at| u32::try_from(at).ok());
        for place in made.map(TermId) {
            let Term::Place { steps, .. } = arena.term(place) else { continue };
            for step in steps {
                let Step::At { index, length } = *step else { continue };
                let of = given.iter().position(|term| *term == index).unwrap_or(0);
                let argument = *arguments.get(of)?;
                match arena.term(index) {
                    Term::Number(_) => {
                        let text = arena.display(place);
                        let message = format!("`{text}` is beyond an array of {length} elements");
                        let error = resolved.type_error(argument, message);
                        return Some(error.help(elements(length)));
                    }
                    Term::Place { scalar, .. } => match scalar.whole() {
                        Some((0.., most)) if most < length.into() => {}
                        _ => return Some(resolved.not_an_index(argument, *scalar, length)),
                    },
                    _ => {}
                }
            }
        }
        None
    }

    /// The error for a use of `item` without the arguments that it takes.
    pub(super) fn without_arguments(&self, id: ExpressionId, item: usize) -> Error {
        let resolved = self.resolved;
        let text = resolved.quote(id);
        let message = format!("`{text}` takes {}", takes(resolved, item));
        let names: Vec<_> =
            resolved.scope.parameters(item).iter().map(|known| known.name.as_str()).collect();
        resolved
            .type_error(id, message)
            .related(resolved.item(item).name, "declared here")
            .help(format!("write `{text}({})`", names.join(", ")))
    }
}

/// The error for an item with the wrong number of arguments.
pub(super) fn miscounted(
    resolved: &Resolved<'_>,
    id: ExpressionId,
    item: usize,
    found: usize,
) -> Option<Error> {
    let text = quoted(resolved.item_name(item));
    let entry = resolved.item(item);
    let parameters = resolved.scope.parameters(item);
    let message = match entry.kind {
        ItemKind::Constant(..) => format!("`{text}` is a number and takes no arguments"),
        _ if parameters.is_empty() => format!("`{text}` takes no arguments: write it alone"),
        _ if parameters.len() == found => return None,
        _ => {
            let are = if found == 1 { "is" } else { "are" };
            format!("`{text}` takes {}, and there {are} {found}", takes(resolved, item))
        }
    };
    let error = resolved.type_error(id, message);
    Some(error.related(entry.name, "declared here"))
}

/// The number of arguments that an item takes, with their types.
fn takes(resolved: &Resolved<'_>, item: usize) -> String {
    let parameters = resolved.scope.parameters(item);
    let types: Vec<_> = parameters.iter().map(|known| type_name(resolved, known.ty)).collect();
    let s = if types.len() == 1 { "" } else { "s" };
    format!("{} argument{s} ({})", types.len(), types.join(", "))
}

/// A parameter's type as messages mention it.
fn type_name(resolved: &Resolved<'_>, ty: ParameterType) -> String {
    match ty {
        ParameterType::Scalar(Scalar::Enum { of, optional }) => {
            let name = &resolved.scope.enums[of as usize].name;
            format!("`{name}{}`", if optional { "?" } else { "" })
        }
        ParameterType::Scalar(Scalar::Number(Numeric::F64)) => "a number".to_owned(),
        ParameterType::Scalar(scalar) => format!("`{}`", scalar.name()),
        ParameterType::Host(span) => format!("`{}`", resolved.ast.source().slice(span)),
    }
}
